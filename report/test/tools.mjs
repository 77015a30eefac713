// SPDX-License-Identifier: BSD-3-Clause
// What tests of reports share: solved examples, pages opened from disk in headless Chromium, and their runner. Says SKIPPED
// and why where Chromium or the packages of report/ are missing.
import { execFileSync } from "node:child_process";
import { createHash } from "node:crypto";
import { existsSync, mkdtempSync, readFileSync, rmSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { dirname, join } from "node:path";
import { fileURLToPath } from "node:url";
import { deflateSync, inflateSync } from "node:zlib";

export const source = join(dirname(fileURLToPath(import.meta.url)), "../..");
export const program = process.env.LIVENS_PROGRAM ?? join(source, "build/release/livens");
const executablePath = [
  process.env.CHROMIUM,
  "/usr/bin/chromium",
  "/usr/bin/chromium-browser",
  "/usr/bin/google-chrome",
].find((file) => file && existsSync(file));
const skip = (why) => {
  console.log(`SKIPPED: ${why}`);
  process.exit(0);
};
if (!executablePath) skip("no Chromium (Debian: chromium, or scripts/setup browser)");
const { chromium } = await import("playwright-core").catch(() =>
  skip("the packages of report/ are not installed (npm ci in report, or scripts/setup browser)"),
);
export const axe = readFileSync(join(source, "report/node_modules/axe-core/axe.min.js"), "utf8");

export const folder = mkdtempSync(join(tmpdir(), "livens-report-"));
export const example = (name) => readFileSync(join(source, "examples", `${name}.toml`), "utf8");

/** Solves a scenario and writes its page; returns the files. */
export function made(name, text, other = []) {
  const [scenario, run, page] = [".toml", ".nc", ".html"].map((end) => join(folder, name + end));
  writeFileSync(scenario, text);
  try {
    execFileSync(program, ["solve", scenario, "-o", run, "--quiet"], { stdio: "ignore" });
  } catch (error) {
    if (![4, 7].includes(error.status)) throw error;
  }
  execFileSync(program, ["report", run, ...other, "-o", page], { stdio: "ignore" });
  return { run, page };
}
/** A page whose script is another one: it is unpacked, changed and packed again. Its policy no longer admits it. */
export function with_script(page, change) {
  const place = /(id="code">)([A-Za-z0-9+/=]+)/,
    script = inflateSync(Buffer.from(place.exec(page)[2], "base64")).toString(),
    changed = change(script);
  if (changed === script) throw new Error("the script is the same");
  return page.replace(place, (_, before) => before + deflateSync(changed).toString("base64"));
}
export const sample = (run, ...args) =>
  JSON.parse(
    execFileSync(program, ["sample", run, ...args, "--json"], { stdio: ["ignore", "pipe", "ignore"] }),
  );

export const browser = await chromium.launch({
  executablePath,
  args: ["--no-sandbox", "--disable-background-networking", "--disable-component-update"],
});
const driver = /GPU stall due to ReadPixels/; // what reading pixels makes the driver say

/** A page with what it asked for and what it complained of. */
export async function open(file, options = {}, hash = "", before = null) {
  const page = await browser.newPage({
    viewport: { width: 1280, height: 800 },
    colorScheme: "light",
    ...options,
  });
  page.requests = [];
  page.problems = [];
  page.on("request", (r) => page.requests.push(r.url()));
  page.on("console", (m) => {
    if (!driver.test(m.text())) page.problems.push(`${m.type()}: ${m.text()}`);
  });
  page.on("pageerror", (e) => page.problems.push(String(e)));
  page.on("dialog", (d) => {
    page.problems.push(`dialog: ${d.message()}`);
    void d.dismiss();
  });
  if (before) await page.addInitScript(before);
  await page.goto(`file://${file}${hash}`);
  await page.waitForFunction(() => window.livensReport, null, { timeout: 60000 });
  return page;
}
export const picture = async (page, t) => {
  await page.evaluate((at) => livensReport.setTime(at), t);
  await page.mouse.move(5, 5); // off the buttons in the picture
  return createHash("sha256")
    .update(await page.locator("#space").screenshot())
    .digest("hex");
};
export const focus_name = (page) =>
  page.evaluate(
    () => document.activeElement.id || document.activeElement.className || document.activeElement.tagName,
  );

/**
 * Runs those tests whose names have all words of the command line. A browser on a busy machine may take longer than a test
 * waits, so one that fails is tried once more, and both are told: a fault of the page fails twice.
 */
export async function run(tests) {
  let failed = 0;
  const chosen = Object.entries(tests).filter(([name]) =>
    process.argv.slice(2).every((word) => name.includes(word)),
  );
  const passes = async (name, test) => {
    const begun = performance.now();
    try {
      await test();
      console.log(`ok      ${name} (${((performance.now() - begun) / 1000).toFixed(1)} s)`);
      return true;
    } catch (error) {
      console.log(`FAILED  ${name}\n${error.stack}`);
      return false;
    } finally {
      for (const context of browser.contexts()) await context.close();
    }
  };
  for (const [name, test] of chosen)
    if (!(await passes(name, test)) && !(await passes(`${name}, once more`, test))) ++failed;
  await browser.close();
  rmSync(folder, { recursive: true, force: true });
  console.log(`${chosen.length - failed} passed, ${failed} failed`);
  process.exit(failed || chosen.length === 0 ? 1 : 0);
}
