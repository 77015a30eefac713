// SPDX-License-Identifier: BSD-3-Clause
// Pictures of a report as people see it, to be looked at: node shots.mjs REPORT.html FOLDER [T] [TAB...]
import { chromium } from "playwright-core";
import { mkdir } from "node:fs/promises";

const [file, folder, t = "", ...tabs] = process.argv.slice(2);
await mkdir(folder, { recursive: true });
const browser = await chromium.launch({
  executablePath: process.env.CHROMIUM ?? "/usr/bin/chromium",
  args: ["--no-sandbox"],
});
for (const [name, options] of Object.entries({
  light: { viewport: { width: 1280, height: 800 }, colorScheme: "light" },
  dark: { viewport: { width: 1280, height: 800 }, colorScheme: "dark" },
  phone: { viewport: { width: 390, height: 844 }, deviceScaleFactor: 2, colorScheme: "light" },
  phone_dark: { viewport: { width: 390, height: 844 }, deviceScaleFactor: 2, colorScheme: "dark" },
})) {
  const page = await browser.newPage(options);
  page.on("console", (m) => console.log(name, m.type(), m.text()));
  page.on("pageerror", (e) => console.log(name, String(e)));
  for (const tab of tabs.length ? tabs : ["motion"]) {
    await page.goto(`file://${file}#${t && `t=${t}&`}tab=${tab}`);
    if (page.url().includes("#")) await page.reload();
    await page.waitForFunction(() => window.livensReport, null, { timeout: 30000 });
    await page.screenshot({ path: `${folder}/${name}_${tab}.png`, fullPage: tab !== "motion" });
  }
  await page.close();
}
await browser.close();
