// SPDX-License-Identifier: BSD-3-Clause
// The page of `livens view --watch`: what is saved is shown, what is wrong is said, and what somebody has chosen stays.
//   LIVENS_PROGRAM=build/release/livens node report/test/live.mjs [NAME]
import { spawn } from "node:child_process";
import { writeFileSync } from "node:fs";
import { join } from "node:path";
import { createInterface } from "node:readline";
import assert from "node:assert/strict";
import { browser, example, folder, made, program, run } from "./tools.mjs";

const text = example("four_bar");

/** A scenario that is watched, and a page that follows it. */
async function watched(name, first) {
  const file = join(folder, `${name}.toml`),
    save = (content) => writeFileSync(file, content);
  save(first);
  const served = spawn(program, ["view", "--watch", file, "--address"], {
    stdio: ["ignore", "pipe", "ignore"],
  });
  const ended = new Promise((done) => served.on("exit", done));
  const address = await new Promise((done) => createInterface(served.stdout).once("line", done));
  const page = await browser.newPage({ viewport: { width: 1280, height: 800 }, colorScheme: "light" });
  page.problems = [];
  page.requests = [];
  page.on("request", (r) => page.requests.push(r.url()));
  page.on("pageerror", (e) => page.problems.push(String(e)));
  page.on("console", (m) => {
    if (m.type() === "error") page.problems.push(m.text());
  });
  await page.goto(address);
  const end = async () => {
    served.kill("SIGINT");
    await ended;
  };
  const title = (wanted) =>
    page.waitForFunction((t) => document.getElementById("title").textContent === t, wanted, {
      timeout: 60000,
    });
  return { page, save, end, title, address };
}

const tests = {
  async "a change, an error and the mend arrive"() {
    const { page, save, end, title, address } = await watched("saved", text);
    await title("four-bar linkage");
    assert.ok(await page.locator("#live").isHidden());
    const before = await page.evaluate(() => livensReport.poses(0.5));
    save(text.replace("four-bar linkage", "another linkage").replace("-9.81", "-3.7"));
    await title("another linkage");
    assert.match(await page.title(), /^another linkage/);
    const after = await page.evaluate(() => livensReport.poses(0.5));
    assert.notDeepEqual(after, before);
    save(text.replace("density", "densty"));
    await page.waitForSelector("#live.bad");
    assert.match(await page.textContent("#live p"), /saved\.toml could not be solved.*version before/);
    const said = await page.textContent("#live pre");
    assert.match(said, /densty/);
    assert.match(said, /saved\.toml:\d+:\d+/);
    assert.match(said, /'density'/);
    assert.equal(await page.textContent("#title"), "another linkage", "the last motion stays");
    assert.deepEqual(await page.evaluate(() => livensReport.poses(0.5)), after);
    save(text);
    await title("four-bar linkage");
    assert.ok(await page.locator("#live").isHidden());
    assert.deepEqual(await page.evaluate(() => livensReport.poses(0.5)), before);
    assert.deepEqual(
      [...new Set(page.requests.map((r) => r.replace(/\?\d+$/, "")))],
      [address, `${address}events`],
    );
    assert.deepEqual(page.problems, []);
    await end();
    await page.waitForSelector("#live.doubtful");
    assert.match(await page.textContent("#live p"), /has ended/);
  },

  async "camera, time, plots and switches stay"() {
    const { page, save, end, title } = await watched("kept", text);
    await title("four-bar linkage");
    await page.waitForFunction(() => window.livensReport);
    await page.click("#view-side");
    await page.focus("#stage");
    await page.keyboard.press("ArrowLeft");
    await page.keyboard.press("+");
    await page.click("#show-frames");
    await page.locator("#plot-list figure .remove").first().click();
    await page.selectOption("#add", { index: 3 });
    await page.locator("#plot-list .keys button").first().click();
    await page.evaluate(() => livensReport.setTime(1.25));
    await page.focus("#scrub");
    await page.keyboard.press("+"); // zooms
    await page.click("#tab-quality");
    const state = () =>
      page.evaluate(() => ({
        camera: livensReport.camera(),
        now: livensReport.now(),
        range: livensReport.range(),
        plots: [...document.querySelectorAll("#plot-list figcaption > span:first-child")].map(
          (e) => e.textContent,
        ),
        pressed: [...document.querySelectorAll("#plot-list .keys button")].map((e) => e.ariaPressed),
        boxes: [...document.querySelectorAll("#show input")].map((e) => e.checked),
        tab: document.querySelector("[role=tab][aria-selected=true]").id,
      }));
    const before = await state();
    assert.ok(before.pressed.includes("false") && before.range[1] < 5, JSON.stringify(before));
    save(text.replace("four-bar linkage", "another linkage").replace("-9.81", "-9.8"));
    await title("another linkage");
    assert.deepEqual(await state(), before);
    assert.equal(await page.locator("canvas#stage").count(), 1);
    // Nothing listens twice: a key moves the time once.
    await page.click("#tab-motion");
    await page.focus("#scrub");
    await page.keyboard.press("ArrowRight");
    const span = await page.evaluate(() => Number(document.getElementById("scrub").max));
    assert.ok(Math.abs((await state()).now - before.now - span / 500) < 1e-9);
    assert.deepEqual(page.problems, []);
    await end();
  },

  async "what plays goes on, and nobody's choice changes with the mechanism"() {
    const { page, save, end, title } = await watched("plays", text);
    await title("four-bar linkage");
    const usual = await page.locator("#plot-list figure").count();
    await page.click("#play");
    save(text.replace("four-bar linkage", "another linkage"));
    await title("another linkage");
    assert.ok(await page.evaluate(() => livensReport.isPlaying()));
    assert.equal(await page.locator("#plot-list figure").count(), usual);
    save(example("dzhanibekov"));
    await page.waitForFunction(() => livensReport.bodies.length === 1, null, { timeout: 60000 });
    assert.ok((await page.locator("#plot-list figure").count()) > 0, "plots of a body without joints");
    assert.equal(
      await page.textContent("#plot-list figure figcaption").then((t) => /reaction/i.test(t)),
      false,
    );
    assert.deepEqual(page.problems, []);
    await end();
  },

  async "a beginning that is wrong waits for the mend"() {
    const { page, save, end, title } = await watched("wrong", "format = 1\n[[body]]\nname = 3\n");
    await page.waitForSelector("#live.bad");
    assert.doesNotMatch(await page.textContent("#live p"), /version before/);
    assert.ok(!(await page.locator("footer").isVisible()));
    save(text);
    await title("four-bar linkage");
    assert.ok(await page.locator("footer").isVisible());
    assert.deepEqual(page.problems, []);
    await page.reload(); // the page holds the run now
    await page.waitForFunction(() => window.livensReport);
    assert.equal(await page.textContent("#title"), "four-bar linkage");
    await end();
  },

  async "a page that is not served does not listen"() {
    const { page: file } = made("alone", text),
      page = await browser.newPage();
    await page.goto(`file://${file}`);
    await page.waitForFunction(() => window.livensReport);
    const refused = await page.evaluate(async () => {
      const violated = new Promise((done) =>
        addEventListener("securitypolicyviolation", (e) => done(e.effectiveDirective)),
      );
      new EventSource("http://127.0.0.1:9/events?0");
      return violated;
    });
    assert.equal(refused, "connect-src", "the policy of a report admits no address");
  },
};

await run(tests);
