// SPDX-License-Identifier: BSD-3-Clause
// Opens reports as a person would: from disk, in headless Chromium, without any network.
//   LIVENS_PROGRAM=build/release/livens node report/test/browser.mjs [NAME]
// Says SKIPPED and why where Chromium or the packages of report/ are missing. tests/system/report_test.py looks at the
// same files without a browser.
import { createHash } from "node:crypto";
import { existsSync, readFileSync, writeFileSync } from "node:fs";
import { join } from "node:path";
import assert from "node:assert/strict";
import { axe, browser, example, focus_name, folder, made, open, picture, run, sample } from "./tools.mjs";

const tests = {
  async "one request, nothing said"() {
    const { page: file } = made("four_bar", example("four_bar"));
    const page = await open(file);
    for (const tab of ["quality", "compare", "about", "motion"]) await page.click(`#tab-${tab}`);
    assert.deepEqual(page.requests, [`file://${file}`]);
    assert.deepEqual(page.problems, []);
    assert.ok(await page.evaluate(() => livensReport.has_picture), "a picture");
    assert.match(await page.title(), /four-bar linkage/);
    assert.match(await page.textContent("#verdict"), /Converged.*good to \d+ digits through/);
  },

  async "opens inside the frame of a notebook, which may keep nothing and ask for nothing"() {
    const { page: file } = made("four_bar", example("four_bar")),
      text = readFileSync(file, "utf8").replaceAll("&", "&amp;").replaceAll('"', "&quot;"),
      book = join(folder, "notebook.html");
    const frame = `<iframe srcdoc="${text}" sandbox="allow-scripts" style="width:100%;height:640px"></iframe>`;
    writeFileSync(book, `<!doctype html><title>notebook</title><p id="title">x</p>${frame}${frame}`);
    const page = await browser.newPage(),
      problems = [],
      requests = [];
    page.on("pageerror", (e) => problems.push(String(e)));
    page.on("request", (r) => requests.push(r.url()));
    await page.goto(`file://${book}`);
    for (const inner of page.frames().slice(1)) {
      await inner.waitForFunction(() => window.livensReport, null, { timeout: 60000 });
      assert.ok(await inner.evaluate(() => livensReport.has_picture));
      assert.match(await inner.textContent("#verdict"), /good to \d+ digits/);
    }
    assert.deepEqual(problems, []);
    assert.deepEqual(
      requests.filter((r) => r.startsWith("http")),
      [],
    );
    console.log(`    ${(text.length / 1e6).toFixed(3)} MB a display`);
    writeFileSync(book, `<!doctype html>${frame.replace("id=&quot;code&quot;>", "id=&quot;code&quot;>!")}`);
    await page.goto(`file://${book}`); // the control: a script that cannot be unpacked is said
    await page.frames()[1].waitForSelector("#verdict .bad");
    assert.match(await page.frames()[1].textContent("#verdict"), /could not be shown/);
  },

  async "poses are those of livens sample at 20 instants"() {
    for (const [name, text] of [
      ["four_bar", example("four_bar")],
      ["backward", example("backward")],
      ["lagrange_top", example("lagrange_top")],
    ]) {
      const { run, page: file } = made(name, text),
        page = await open(file);
      const bodies = await page.evaluate(() => livensReport.bodies),
        [start, end] = await page.evaluate(() => livensReport.range());
      const times = Array.from({ length: 20 }, (_, k) =>
        k === 19 ? end : start + (end - start) * ((k * Math.SQRT2) % 1),
      );
      let worst = 0;
      for (const [b, body] of bodies.entries()) {
        const theirs = sample(run, "--body", body, ...times.flatMap((t) => ["--at", String(t)])).samples;
        for (const [k, t] of times.entries()) {
          const mine = (await page.evaluate((at) => livensReport.poses(at), t)).slice(12 * b, 12 * b + 12);
          [...theirs[k].position, ...theirs[k].directors_raw.flat()].forEach((x, i) => {
            worst = Math.max(worst, Math.abs(x - mine[i]));
          });
        }
      }
      assert.ok(worst < 1e-13, `${name}: ${worst}`);
      console.log(`    ${name}: ${worst}`);
      await page.close();
    }
  },

  async "poses of a large run are rounded to a ten-millionth"() {
    const text = example("lagrange_top").replace(/\[(time|method)\][^[]*/g, ""),
      time = '\n[time]\nend = 10\nelements = 5000\n[method]\nfamily = "lobatto"\ndegree = 6\n',
      { run, page: file } = made("large", text + time),
      page = await open(file);
    assert.match(await page.textContent("#exactness"), /rounded to a ten-millionth/);
    let worst = 0;
    const times = Array.from({ length: 20 }, (_, k) => 10 * ((k * Math.SQRT2) % 1)),
      theirs = sample(run, "--body", "top", ...times.flatMap((t) => ["--at", String(t)])).samples;
    for (const [k, t] of times.entries()) {
      const mine = await page.evaluate((at) => livensReport.poses(at), t);
      [...theirs[k].position, ...theirs[k].directors_raw.flat()].forEach((x, i) => {
        worst = Math.max(worst, Math.abs(x - mine[i]));
      });
    }
    assert.ok(worst < 5e-7 && worst > 1e-12, `${worst}`);
    await page.close();
  },

  async "pixels change in time and repeat"() {
    const { page: file } = made("four_bar", example("four_bar")),
      page = await open(file);
    const [a, b, again] = [await picture(page, 0.3), await picture(page, 1.7), await picture(page, 0.3)];
    assert.notEqual(a, b);
    assert.equal(a, again);
    for (const what of ["trails", "forces", "joints", "names", "frames"]) {
      await page.locator(`#show-${what}`).click();
      assert.notEqual(await picture(page, 0.3), a, `${what} are seen`);
      await page.locator(`#show-${what}`).click();
      assert.equal(await picture(page, 0.3), a, `${what} are put back`);
    }
    for (const view of ["front", "side", "top"]) {
      await page.click(`#view-${view}`);
      assert.notEqual(await picture(page, 0.3), a, view);
    }
    await page.click("#view-fitted");
    assert.equal(await picture(page, 0.3), a);
  },

  async "the mechanism fills the picture"() {
    for (const viewport of [
      { width: 1280, height: 800 },
      { width: 390, height: 844 },
    ])
      for (const name of ["four_bar", "slider_crank", "dzhanibekov"]) {
        const { page: file } = made(name, example(name)),
          page = await open(file, { viewport });
        for (const what of ["names", "forces", "joints"])
          await page.evaluate((id) => {
            const box = document.getElementById(id);
            if (box.checked) box.click();
          }, `show-${what}`);
        // The extent of everything that is not background, over the motion.
        const share = await page.evaluate(() => {
          const [start, end] = livensReport.range(),
            canvas = document.getElementById("stage"),
            flat = document.createElement("canvas");
          [flat.width, flat.height] = [canvas.width / 4, canvas.height / 4];
          const c = flat.getContext("2d", { willReadFrequently: true });
          let l = flat.width,
            r = 0,
            top = flat.height,
            b = 0;
          for (let k = 0; k <= 24; ++k) {
            livensReport.setTime(start + ((end - start) * k) / 24);
            c.clearRect(0, 0, flat.width, flat.height);
            c.drawImage(canvas, 0, 0, flat.width, flat.height);
            const { data } = c.getImageData(0, 0, flat.width, flat.height);
            for (let i = 0; i < flat.width * flat.height; ++i) {
              const [R, G, B, A] = data.subarray(4 * i, 4 * i + 4);
              if (A < 200 || Math.max(R, G, B) - Math.min(R, G, B) < 60) continue; // bodies have colours, the ground has none
              const x = i % flat.width,
                y = Math.floor(i / flat.width);
              l = Math.min(l, x);
              r = Math.max(r, x);
              top = Math.min(top, y);
              b = Math.max(b, y);
            }
          }
          return [(r - l) / flat.width, (b - top) / flat.height, l, top];
        });
        assert.ok(Math.max(share[0], share[1]) > 0.75, `${name} fills ${share}`);
        assert.ok(Math.max(share[0], share[1]) < 0.99, `${name} is all there: ${share}`);
        await page.close();
      }
  },

  async "every control by keyboard"() {
    const { page: file } = made("four_bar", example("four_bar")),
      page = await open(file);
    const now = () => page.evaluate(() => livensReport.now()),
      press = (...keys) => keys.reduce((p, key) => p.then(() => page.keyboard.press(key)), Promise.resolve());
    const [start, end] = await page.evaluate(() => livensReport.range());
    await press("ArrowRight");
    assert.ok(Math.abs((await now()) - (end - start) / 500) < 1e-12);
    await press("Shift+ArrowRight");
    assert.ok(Math.abs((await now()) - (11 * (end - start)) / 500) < 1e-12);
    await press("ArrowLeft", "Home");
    assert.equal(await now(), start);
    await press("PageDown", "PageDown");
    assert.ok(Math.abs((await now()) - 0.1) < 1e-12, "two elements of 0.05 s");
    await press("PageUp");
    assert.ok(Math.abs((await now()) - 0.05) < 1e-12);
    await press("End");
    assert.equal(await now(), end);
    await press("Home", " ");
    await page.waitForFunction(() => livensReport.now() > 0.05);
    await press(" ");
    assert.equal(await page.evaluate(() => livensReport.isPlaying()), false);
    await press("+");
    const zoomed = await page.evaluate(() => livensReport.range());
    assert.ok(zoomed[1] - zoomed[0] < 0.6 * (end - start));
    await press("0");
    assert.deepEqual(await page.evaluate(() => livensReport.range()), [start, end]);
    await press("2");
    assert.ok((await page.isVisible("#quality")) && !(await page.isVisible("#motion")));
    await press("1");
    // All that can be clicked is reached by Tab and shows that it is.
    await page.evaluate(() => document.activeElement.blur());
    const wanted = new Set(
      await page.evaluate(() =>
        [...document.querySelectorAll("button, input, select, summary, canvas[tabindex]")]
          .filter((e) => e.checkVisibility() && e.tabIndex >= 0 && e.type !== "file")
          .map((e) => e.id || e.getAttribute("aria-label")),
      ),
    );
    const seen = new Set();
    for (let k = 0; k < wanted.size + 12; ++k) {
      await press("Tab");
      seen.add(
        await page.evaluate(
          () => document.activeElement.id || document.activeElement.getAttribute("aria-label"),
        ),
      );
      assert.ok(
        await page.evaluate(
          () =>
            document.activeElement === document.body ||
            getComputedStyle(document.activeElement).outlineStyle !== "none",
        ),
        await focus_name(page),
      );
    }
    for (const id of wanted) assert.ok(seen.has(id), `Tab reaches ${id}`);
    for (const id of ["play", "scrub", "speed", "show-trails", "stage", "view-top", "tab-motion", "add"])
      assert.ok(wanted.has(id), id);
    // Each by its own keys.
    await page.focus("#tab-motion");
    await press("ArrowRight", "ArrowRight");
    assert.equal(await focus_name(page), "tab-compare");
    await press("Home");
    await page.focus("#stage");
    const camera = () => page.evaluate(() => livensReport.camera());
    for (const key of ["ArrowLeft", "ArrowUp", "+", "Shift+ArrowLeft"]) {
      const before = await camera();
      await press(key);
      assert.notDeepEqual(await camera(), before, key);
    }
    await page.focus("#scrub");
    const before = await now();
    await press("ArrowRight");
    assert.ok((await now()) > before, "the scrub bar");
    await page.focus("#add");
    const count = await page.locator("#plot-list figure").count();
    await page.selectOption("#add", { index: 3 });
    assert.equal(await page.locator("#plot-list figure").count(), count + 1);
    await page.locator("#plot-list .remove").last().focus();
    await press("Enter");
    assert.equal(await page.locator("#plot-list figure").count(), count);
    await page.focus("#show-trails");
    await press(" ");
    assert.equal(await page.isChecked("#show-trails"), false);
    await page.focus("#play");
    await press("Enter");
    assert.equal(await page.getAttribute("#play", "aria-label"), "stop");
    assert.deepEqual(page.problems, []);
  },

  async "no serious findings of axe"() {
    const { page: file } = made("four_bar", example("four_bar"));
    for (const options of [{}, { colorScheme: "dark" }, { viewport: { width: 390, height: 844 } }]) {
      const page = await open(file, { ...options, bypassCSP: true });
      await page.evaluate(axe);
      for (const tab of ["motion", "quality", "compare", "about"]) {
        await page.click(`#tab-${tab}`);
        const { violations } = await page.evaluate(() => window.axe.run());
        const bad = violations.filter((v) => ["serious", "critical"].includes(v.impact));
        assert.deepEqual(
          bad.map((v) => [tab, v.id, v.nodes.map((n) => n.html.slice(0, 120))]),
          [],
        );
      }
      await page.close();
    }
  },

  async "names are text"() {
    const name = "</script><img src=x onerror=alert(1)>";
    const text = example("four_bar")
      .replaceAll('"coupler"', JSON.stringify(name))
      .replaceAll('"crank"', '"振り子 маятник رقاص 🕰️"')
      .replace('title = "four-bar linkage"', `title = ${JSON.stringify(`<b>${name}`)}`);
    const { page: file } = made("hostile", text),
      page = await open(file);
    for (const tab of ["quality", "compare", "about", "motion"]) await page.click(`#tab-${tab}`);
    assert.deepEqual(page.problems, []);
    assert.equal(await page.locator("img").count(), 0);
    assert.equal(await page.textContent("h1"), `<b>${name}`);
    assert.ok((await page.locator("#labels span").allTextContents()).includes(name));
    assert.ok((await page.locator("#labels span").allTextContents()).includes("振り子 маятник رقاص 🕰️"));
    assert.ok((await page.title()).startsWith("<b></script>"));
  },

  async "the policy stops what is not the page's own"() {
    const { page: file } = made("four_bar", example("four_bar"));
    const foreign = join(folder, "foreign.html");
    writeFileSync(
      foreign,
      readFileSync(file, "utf8").replace("<noscript>", "<script>window.foreign = 1</script><noscript>"),
    );
    const page = await open(foreign);
    assert.equal(await page.evaluate(() => window.foreign), undefined);
    assert.ok(
      page.problems.some((p) => p.includes("Content Security Policy")),
      "and it is said",
    );
  },

  async "runs that are not right open and say so"() {
    const small = example("double_pendulum_spatial");
    const coarse = small.replace(/elements = \d+/, "elements = 3").replace(/^output = .*\n/m, "");
    const stopped = coarse.replace(
      /\[method\][\s\S]*/,
      '[method]\nfamily = "midpoint"\nmax_iterations = 1\n',
    );
    const mixed = example("double_pendulum_blocks");
    const single = `format = 1\ntitle = ""\n[[body]]\nname = "p"\nshape = { point = true }\nmass = 1\n[time]\nend = 1\nelements = 2\n`;
    for (const [name, text, said] of [
      ["coarse", coarse, /Suspect/],
      ["stopped", stopped, /Not converged/],
      ["mixed", mixed, /Converged|Suspect/],
      ["still", single, /Converged/],
    ]) {
      const { page: file } = made(name, text),
        page = await open(file);
      for (const tab of ["quality", "compare", "about", "motion"]) {
        await page.click(`#tab-${tab}`);
        assert.doesNotMatch(await page.innerText("body"), /\bNaN\b|undefined|Infinity/, `${name}, ${tab}`);
      }
      assert.match(await page.textContent("#verdict"), said, name);
      assert.deepEqual(page.problems, [], name);
      await page.close();
    }
  },

  async "two runs, one opened from a file"() {
    const a = made("four_bar", example("four_bar")),
      b = made("rough", example("four_bar").replace("degree = 8", "degree = 4"));
    const both = made("both", example("four_bar"), [b.run]),
      page = await open(both.page, {}, "#tab=compare");
    assert.match(await page.textContent("#compare .lead"), /3 bodies .* at most \d/);
    assert.equal(await page.locator("#compare figure").count(), 2);
    const alone = await open(a.page, {}, "#tab=compare");
    await alone.setInputFiles("#other-file", b.page);
    await alone.waitForSelector("#compare .lead");
    assert.equal(await alone.textContent("#compare .lead"), await page.textContent("#compare .lead"));
    await alone.setInputFiles("#other-file", b.run);
    assert.match(await alone.locator("#compare .bad").textContent(), /cannot be read as a report/);
    assert.deepEqual([...page.problems, ...alone.problems], []);
  },

  async "plots stand without WebGL"() {
    const { page: file } = made("four_bar", example("four_bar"));
    const page = await open(file, {}, "", () => {
      const real = HTMLCanvasElement.prototype.getContext;
      HTMLCanvasElement.prototype.getContext = function (kind, ...rest) {
        return kind.startsWith("webgl") ? null : real.call(this, kind, ...rest);
      };
    });
    assert.match(await page.textContent("#motion .bad"), /no picture in space/);
    assert.equal(await page.locator("#plot-list figure").count(), 4);
    await page.keyboard.press("ArrowRight");
    assert.deepEqual(
      page.problems.filter((p) => !/WebGL/.test(p)),
      [],
    );
  },

  async "paper, and motion that is not wanted"() {
    const { page: file } = made("four_bar", example("four_bar")),
      page = await open(file, { reducedMotion: "reduce", colorScheme: "dark" });
    assert.equal(await page.evaluate(() => livensReport.isPlaying()), false, "nothing moves by itself");
    const pdf = await page.pdf({ format: "A4" });
    assert.ok(pdf.length > 50000);
    assert.equal(await page.locator("#paper canvas").count(), 3);
    assert.deepEqual(page.problems, []);
    // Paper is white, whatever the screen was: the same stills from both, other ones on the screen.
    const stills = async (colorScheme) => {
      const screen = await open(file, { reducedMotion: "reduce", colorScheme });
      const printed = await screen.evaluate(() => {
        const pixels = () => [...document.querySelectorAll("#paper canvas")].map((c) => c.toDataURL());
        const before = document.getElementById("stage").toDataURL();
        dispatchEvent(new Event("beforeprint"));
        const on_paper = pixels();
        dispatchEvent(new Event("afterprint"));
        return { on_paper, before, after: document.getElementById("stage").toDataURL() };
      });
      await screen.close();
      return printed;
    };
    const [light, dark] = [await stills("light"), await stills("dark")];
    assert.deepEqual(dark.on_paper, light.on_paper);
    assert.notEqual(dark.before, light.before, "the control");
    assert.equal(dark.after, dark.before, "the screen is as it was");
  },

  async "gears, slots, bushings and torques are drawn"() {
    const wheel = (name, x) =>
      `[[body]]\nname = "${name}"\nshape = { cylinder = { radius = 0.05, length = 0.02 } }\ndensity = 7850\nposition = [${x}, 0, 0]\n` +
      `[[joint]]\nname = "${name} shaft"\ntype = "revolute"\nbetween = ["world", "${name}"]\nat = [${x}, 0, 0]\naxis = [0, 0, 1]\n`;
    const text =
      'format = 1\ntitle = "glyphs"\n' +
      wheel("a", 0) +
      wheel("b", 0.15) +
      '[[body]]\nname = "bead"\nshape = { sphere = 0.02 }\nmass = 1\nposition = [0, 0.3, 0]\n' +
      '[[body]]\nname = "block"\nshape = { box = [0.1, 0.1, 0.1] }\nmass = 1\nposition = [0.3, 0.3, 0]\nvelocity = [0.2, 0, 0]\n' +
      '[[joint]]\nname = "mesh"\ntype = "gear"\njoints = ["a shaft", "b shaft"]\nratio = -0.5\n' +
      '[[joint]]\nname = "slot"\ntype = "slot"\nbetween = ["world", "bead"]\ncurve = { points = [[-0.1, 0.3, 0], [0, 0.3, 0], [0.1, 0.35, 0]] }\n' +
      '[[load]]\nname = "push"\ntype = "force"\nbody = "bead"\nexpression = ["sin(4*t)", "0", "0"]\n' +
      '[[load]]\nname = "motor"\ntype = "torque"\nbody = "a"\nexpression = ["0", "0", "0.1*cos(5*t)"]\n' +
      '[[load]]\nname = "rubber"\ntype = "bushing"\nbetween = ["world", "block"]\nat = [0.3, 0.3, 0]\nstiffness = [400, 400, 400, 2, 2, 2]\n' +
      "[time]\nend = 1\n";
    const { page: file } = made("glyphs", text),
      page = await open(file);
    const motor = await page.evaluate(() =>
      [0.1, 0.5, 0.9].map((t) => livensReport.curve("load", 1, "torque z", t) - 0.1 * Math.cos(5 * t)),
    );
    assert.ok(Math.max(...motor.map(Math.abs)) < 1e-6, `${motor}`);
    const shown = await picture(page, 0.3);
    for (const what of ["joints", "forces"]) {
      await page.locator(`#show-${what}`).click();
      assert.notEqual(await picture(page, 0.3), shown, what);
      await page.locator(`#show-${what}`).click();
    }
    assert.match(await page.textContent("#caption"), /largest torque 0\.1\sN\sm/);
    assert.ok((await page.evaluate(() => livensReport.frames(2))).calls <= 20);
    assert.deepEqual(page.problems, []);
  },

  async "what is thrown away leaves the picture, and its rod goes"() {
    const { page: file } = made("trebuchet", example("trebuchet")),
      page = await open(file);
    assert.match(await page.textContent("#caption"), /stone goes far/);
    const near = await page.evaluate(() => livensReport.camera());
    await page.click("#view-fitted");
    const whole = await page.evaluate(() => livensReport.camera());
    assert.ok(Math.hypot(...whole) > 2 * Math.hypot(...near), `${near} ${whole}`);
    const rods = await page.evaluate(() => livensReport.seen_bars());
    assert.deepEqual(rods, { at_start: 1, at_end: 0 });
    assert.deepEqual(page.problems, []);
  },

  async "a surface that was thinned says so"() {
    const { page: file } = made("four_bar", example("four_bar")),
      thinned = join(folder, "thinned.html"); // the numbers are what tests/unit/io/report_test.cpp looks at
    writeFileSync(
      thinned,
      readFileSync(file, "utf8").replace('"thinned": null', '"thinned": [1000000, 58311, 0.0021]'),
    );
    const page = await open(thinned);
    assert.match(await page.textContent("#caption"), /surfaces thinned, off by 2\.1e\u22123\sm/);
    await page.click("#tab-about");
    assert.match(
      await page.textContent("#about"),
      /of crank is drawn with 58311 of its 1000000 triangles: corners are at most 2\.1e\u22123\sm/,
    );
    assert.deepEqual(page.problems, []);
    assert.doesNotMatch(await (await open(file)).textContent("#about"), /triangles/, "the control");
  },

  async "long names fit on a phone"() {
    const long = "lever with a rather long name, as catalogues have them: ISO 4014 M16x80-8.8 zinc",
      unbroken = "x".repeat(120);
    const text = example("four_bar")
      .replaceAll('"crank"', JSON.stringify(long))
      .replaceAll('"rocker"', JSON.stringify(unbroken))
      .replace('title = "four-bar linkage"', `title = ${JSON.stringify(`${unbroken} ${long}`)}`);
    const { page: file } = made("long", text),
      page = await open(file, { viewport: { width: 390, height: 844 } });
    for (const tab of ["motion", "quality", "compare", "about"]) {
      await page.click(`#tab-${tab}`);
      const wide = await page.evaluate((id) => {
        const host = document.getElementById(id);
        return [document.documentElement.scrollWidth, host.scrollWidth - host.clientWidth];
      }, tab);
      assert.ok(wide[0] <= 390 && wide[1] <= 1, `${tab} is ${wide} wide`);
    }
    await page.click("#tab-motion");
    const off = await page.evaluate(() =>
      [...document.querySelectorAll(".keys output, #labels span:not([hidden])")]
        .map((e) => [e.textContent, e.getBoundingClientRect()])
        .filter(([, box]) => box.width > 0 && (box.right > 391 || box.left < -1))
        .map(([text, box]) => `${text} ${box.left} ${box.right}`),
    );
    assert.deepEqual(off, [], "values and names that begin in the picture end in it");
    assert.deepEqual(page.problems, []);
  },

  async "a hundred bodies are quick"() {
    const bodies = Array.from(
      { length: 100 },
      (_, n) =>
        `[[body]]\nname = "pendulum ${n}"\nshape = { box = [0.08, 0.08, ${0.5 + 0.003 * n}] }\ndensity = 2000\n` +
        `position = [${Math.floor(n / 10)}, ${n % 10}, 0]\ncenter_of_mass = [0, 0, ${-0.25 - 0.0015 * n}]\nrotation_vector = [0, ${0.4 + 0.02 * n}, 0]\n` +
        `[[joint]]\nname = "pivot ${n}"\ntype = "revolute"\nbetween = ["world", "pendulum ${n}"]\nat = [${Math.floor(n / 10)}, ${n % 10}, 0]\naxis = [0, 1, 0]\n`,
    ).join("");
    const { page: file } = made(
      "hundred",
      `format = 1\ntitle = "a hundred"\ngravity = [0, 0, -9.81]\n${bodies}[time]\nend = 5\nelements = 125\n[method]\nfamily = "lobatto"\ndegree = 8\nestimate = "none"\n`,
    );
    const four = await open(made("four_bar", example("four_bar")).page),
      page = await open(file);
    const client = await page.context().newCDPSession(page);
    await client.send("Performance.enable", { timeDomain: "threadTicks" });
    await page.reload();
    await page.waitForFunction(() => window.livensReport);
    const { metrics } = await client.send("Performance.getMetrics"),
      cpu = metrics.find((m) => m.name === "TaskDuration").value;
    // In turns, so that what other programs take is taken from both.
    const all = [[], []];
    for (let k = 0; k < 8; ++k)
      for (const [i, p] of [four, page].entries())
        all[i].push(await p.evaluate(() => livensReport.frames(6)));
    const [one, many] = all.map((f) => ({ ms: Math.min(...f.map((x) => x.ms)), calls: f[0].calls }));
    console.log(
      `    ready after ${cpu.toFixed(2)} s of CPU; a frame ${many.ms.toFixed(0)} ms in ${many.calls} draw calls, of the four-bar ${one.ms.toFixed(0)} ms in ${one.calls}`,
    );
    assert.ok(cpu < 3, `${cpu} s of CPU`);
    assert.ok(many.calls <= 20 && one.calls <= 20);
    assert.ok(many.ms < 2 * one.ms, `${many.ms} ms a frame, ${one.ms} ms of the four-bar`);
  },
};

await run(tests);
