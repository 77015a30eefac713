// SPDX-License-Identifier: BSD-3-Clause
// The picture in space of reports, alone: node stills.mjs FOLDER WIDTH HEIGHT REPORT.html@T[@FRAMES@END][@VIEW] ...
// One PNG each, NAME.png at the instant T; or NAME_000.png ... of FRAMES instants from T until END.
// SCHEME=dark: for dark pages. NAMES=1: with the names of bodies, which small pictures are not legible with.
import { mkdir, writeFile } from "node:fs/promises";
import { basename, join } from "node:path";
import { launch, opened, recorded } from "./record.mjs";

const [folder, width, height, ...wanted] = process.argv.slice(2);
const look = {
  width: Number(width),
  height: Number(height),
  scheme: process.env.SCHEME ?? "light",
  names: process.env.NAMES === "1",
};
await mkdir(folder, { recursive: true });
const browser = await launch();
for (const [file, start, frames = "1", end = start, view = ""] of wanted.map((word) => word.split("@"))) {
  const page = await opened(browser, file),
    n = Number(frames);
  for (let k = 0; k < n; ++k) {
    const from = Number(start) + (n > 1 ? (k * (end - start)) / n : 0),
      name = basename(file, ".html") + (n > 1 ? `_${String(k).padStart(3, "0")}` : "");
    const picture = await recorded(page, "png", {
      look: { ...look, side: view || "fitted" },
      course: { from },
    });
    await writeFile(join(folder, `${name}.png`), picture);
  }
  await page.close();
}
await browser.close();
