// SPDX-License-Identifier: BSD-3-Clause
// The picture in space of reports, alone: node stills.mjs FOLDER WIDTH HEIGHT REPORT.html@T[@FRAMES@END][@VIEW] ...
// One PNG each, NAME.png at the instant T; or NAME_000.png ... of FRAMES instants from T until END.
// SCHEME=dark: for dark pages.
import { chromium } from "playwright-core";
import { basename, join, resolve } from "node:path";
import { mkdir } from "node:fs/promises";

const [folder, width, height, ...wanted] = process.argv.slice(2);
await mkdir(folder, { recursive: true });
const browser = await chromium.launch({
  executablePath: process.env.CHROMIUM ?? "/usr/bin/chromium",
  args: ["--no-sandbox"],
});
const page = await browser.newPage({ viewport: { width: +width, height: +height }, colorScheme: process.env.SCHEME ?? "light" });
for (const [file, start, frames = "1", end = start, view = ""] of wanted.map((word) => word.split("@"))) {
  await page.goto(`file://${resolve(file)}#t=${start}`);
  await page.waitForFunction(() => window.livensReport, null, { timeout: 60000 });
  await page.addStyleTag({
    content: "header, footer, #plots, #views, #caption { display: none !important }" +
      "#motion { display: block !important; height: 100vh } #space { height: 100vh; width: 100vw }",
  }).catch(() => page.evaluate(() => {
    // The page's own policy lets no style in but its own; what a script sets passes.
    for (const part of document.querySelectorAll("header, footer, #plots, #views, #caption")) part.style.display = "none";
    document.getElementById("motion").style.cssText = "display: block; height: 100vh";
    document.getElementById("space").style.cssText = "height: 100vh; width: 100vw";
  }));
  await page.evaluate((name) => {
    window.dispatchEvent(new Event("resize"));
    document.getElementById(name ? `view-${name}` : "view-fitted").click();
  }, view);
  await page.waitForTimeout(400);
  for (let k = 0; k < +frames; ++k) {
    const t = +start + (+frames > 1 ? (k * (+end - +start)) / +frames : 0);
    await page.evaluate((at) => window.livensReport.setTime(at), t);
    await page.evaluate(() => new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done))));
    const name = basename(file, ".html") + (+frames > 1 ? `_${String(k).padStart(3, "0")}` : "");
    await page.screenshot({ path: join(folder, `${name}.png`) });
  }
}
await browser.close();
