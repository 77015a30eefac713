// SPDX-License-Identifier: BSD-3-Clause
// Opens pages of the documentation as a reader would, in headless Chromium: node report/test/site.mjs FOLDER
// Nothing but files of FOLDER may be asked for, nothing may be wider than a phone, and a live report opens where its still was.
import { chromium } from "playwright-core";
import assert from "node:assert/strict";
import { existsSync, readdirSync } from "node:fs";
import { resolve } from "node:path";
import { pathToFileURL } from "node:url";

const root = resolve(process.argv[2]);
const executablePath = [process.env.CHROMIUM, "/usr/bin/chromium", "/usr/bin/chromium-browser"].find((f) => f && existsSync(f));
if (!executablePath) {
  console.log("SKIPPED: no Chromium (scripts/setup browser)");
  process.exit(0);
}
const browser = await chromium.launch({
  executablePath,
  args: ["--no-sandbox", "--disable-background-networking", "--disable-component-update", "--host-resolver-rules=MAP * ~NOTFOUND"],
});
const base = pathToFileURL(root).href;
const pages = ["index", "tutorial", "install", "howto/index", "howto/motors", "gallery/index", "gallery/four_bar", "joints", "scenario", "reference/python", "reference/cpp/spacetime", "diagnostics/index", "diagnostics/inertia-triangle",
  "coming_from/adams", "performance", "paper", "notation", "trust", "validation", "results",
  ...readdirSync(`${root}/theory`).filter((file) => file.endsWith(".html")).map((file) => `theory/${file.slice(0, -5)}`)];
for (const name of pages) {
  const page = await browser.newPage({ viewport: { width: 390, height: 844 } });
  const asked = [], said = [];
  page.on("request", (r) => asked.push(r.url()));
  page.on("console", (m) => ["error", "warning"].includes(m.type()) && said.push(m.text()));
  page.on("pageerror", (e) => said.push(String(e)));
  await page.goto(`${base}/${name}.html`, { waitUntil: "load" });
  const foreign = asked.filter((url) => !url.startsWith(`${base}/`) && !/^(data|blob|about):/.test(url));
  assert.deepEqual(foreign, [], `${name} asks for something else`);
  assert.deepEqual(said, [], `${name} complains`);
  const wide = await page.evaluate(() => document.documentElement.scrollWidth - innerWidth);
  assert.ok(wide <= 0, `${name} is ${wide} pixels wider than a phone`);
  await page.close();
}
const page = await browser.newPage({ viewport: { width: 1280, height: 800 } });
await page.goto(`${base}/gallery/four_bar.html`);
await page.click(".report button");
const frame = await (await page.waitForSelector(".report iframe")).contentFrame();
await frame.waitForFunction(() => window.livensReport, null, { timeout: 60000 });
assert.ok((await frame.evaluate(() => window.livensReport.bodies)).includes("crank"));
// The control: a page that does ask is noticed.
const asked = [];
page.on("request", (r) => asked.push(r.url()));
await page.evaluate(() => document.body.append(Object.assign(new Image(), { src: "https://example.org/x.png" })));
await page.waitForTimeout(200);
assert.ok(asked.some((url) => url.startsWith("https://example.org")));
await browser.close();
console.log(`${pages.length} pages ask for nothing else, fit a phone, and the live report opens`);
