// SPDX-License-Identifier: BSD-3-Clause
// Stills, sketches (SVG), videos and GIFs of reports without a hand on the page, by a headless browser (scripts/setup browser):
//   node report/record.mjs REPORT.html OUT.png|OUT.svg|OUT.webm|OUT.gif [KEY=VALUE...]
//   at=0.7                    the instant of a still [s]; without it the start
//   from=0 to=2               of a moving picture [s]; without them all of the motion
//   speed=0.5 fps=30          seconds of motion in one of the picture; pictures a second
//   size=1280x720             pixels
//   view=fitted|front|side|top   colours=light|dark
//   names=on clock=on background=off     what else is drawn, off or on
//   trails=off forces=off joints=off frames=on   what the page's switches are set to
import { chromium } from "playwright-core";
import { writeFileSync } from "node:fs";
import { extname, resolve } from "node:path";
import { pathToFileURL } from "node:url";

const usual = {
  view: "fitted",
  colours: "light",
  names: "off",
  clock: "off",
  background: "on",
  size: "1280x720",
};
const switches = ["trails", "forces", "joints", "frames"];
const numbers = { at: "from", from: "from", to: "to", speed: "speed", fps: "rate" };

/** What the words KEY=VALUE ask for. */
export function asked(words) {
  const values = { ...usual };
  for (const word of words) {
    const [key, value] = word.split(/=(.*)/s);
    const is_known = key in usual || key in numbers || switches.includes(key);
    if (!is_known || value === undefined)
      throw new Error(`'${word}' is none of KEY=VALUE that record.mjs knows`);
    if (key in numbers && !Number.isFinite(Number(value || NaN)))
      throw new Error(`'${word}': a number is needed`);
    values[key] = value;
  }
  const size = /^(\d+)x(\d+)$/.exec(values.size);
  if (!size) throw new Error(`'size=${values.size}': two numbers are needed, such as 1280x720`);
  const course = Object.fromEntries(
    Object.entries(numbers).flatMap(([key, name]) => (key in values ? [[name, Number(values[key])]] : [])),
  );
  const look = {
    width: Number(size[1]),
    height: Number(size[2]),
    side: values.view,
    scheme: values.colours,
    names: values.names === "on",
    clock: values.clock === "on",
    is_clear: values.background === "off",
  };
  const shown = Object.fromEntries(
    switches.flatMap((key) => (key in values ? [[key, values[key] === "on"]] : [])),
  );
  return { look, course, shown };
}

export async function launch() {
  return chromium.launch({
    executablePath: process.env.CHROMIUM ?? "/usr/bin/chromium",
    args: ["--no-sandbox", "--disable-background-networking", "--disable-component-update"],
  });
}
export async function opened(browser, file) {
  const page = await browser.newPage({ viewport: { width: 1280, height: 800 } });
  await page.goto(pathToFileURL(resolve(file)).href);
  await page.waitForFunction(() => window.livensReport, null, { timeout: 60000 });
  return page;
}
export async function recorded(page, kind, { look, course, shown = {} }) {
  for (const [what, is_on] of Object.entries(shown)) await page.setChecked(`#show-${what}`, is_on);
  const text = await page.evaluate(([k, l, c]) => window.livensReport.record(k, l, c), [kind, look, course]);
  return Buffer.from(text, "base64");
}

if (process.argv[1] && import.meta.url === pathToFileURL(resolve(process.argv[1])).href) {
  const [file, out, ...words] = process.argv.slice(2),
    kind = extname(out ?? "").slice(1);
  if (!["png", "svg", "webm", "gif"].includes(kind)) {
    console.error("usage: node report/record.mjs REPORT.html OUT.png|OUT.svg|OUT.webm|OUT.gif [KEY=VALUE...]");
    process.exit(2);
  }
  const browser = await launch();
  try {
    writeFileSync(out, await recorded(await opened(browser, file), kind, asked(words)));
  } catch (error) {
    console.error(`record: ${error.message}`);
    process.exitCode = 1;
  }
  await browser.close();
}
