// SPDX-License-Identifier: BSD-3-Clause
// Plots of the page: which come first, what they save, degrees, one quantity against another.
//   LIVENS_PROGRAM=build/release/livens node report/test/plots.mjs [NAME]
import { readFileSync } from "node:fs";
import assert from "node:assert/strict";
import { example, made, open, run, sample } from "./tools.mjs";

const titles = (page) =>
  page
    .locator("#plot-list figcaption > span:first-child")
    .evaluateAll((all) => all.map((e) => e.firstChild.textContent));
const plot = (page, title) => page.locator("#plot-list figure").filter({ hasText: title }).first();
async function saved(page, figure, kind) {
  const waits = page.waitForEvent("download");
  await figure.hover();
  await figure.locator(".out", { hasText: kind }).click();
  const download = await waits;
  return [download.suggestedFilename(), readFileSync(await download.path())];
}
async function table(page, figure) {
  const [, bytes] = await saved(page, figure, "CSV"),
    [head, ...rows] = bytes.toString().trim().split("\r\n");
  return { head: head.split(","), rows: rows.map((row) => row.split(",").map(Number)) };
}
const shaft_and_flap = (sensors = "") =>
  'format = 1\ntitle = "shaft and flap"\ngravity = [0, 0, -9.81]\n' +
  '[[body]]\nname = "rotor"\nshape = { box = [0.4, 0.05, 0.05] }\nmass = 3\nposition = [0.2, 0, 0]\n' +
  '[[joint]]\nname = "shaft"\ntype = "revolute"\nbetween = ["world", "rotor"]\nat = [0, 0, 0]\naxis = [0, 1, 0]\n' +
  '[[drive]]\nname = "motor"\ntype = "joint"\njoint = "shaft"\nrate = 6\n' +
  '[[body]]\nname = "flap"\nshape = { box = [0.05, 0.05, 0.4] }\nmass = 1\nposition = [2, 0, -0.2]\n' +
  '[[joint]]\nname = "hinge"\ntype = "revolute"\nbetween = ["world", "flap"]\nat = [2, 0, 0.01]\naxis = [0, 1, 0]\n' +
  '[[load]]\nname = "push"\ntype = "force"\nbody = "flap"\nexpression = ["0.5*sin(3*t)", "0", "0"]\n' +
  sensors +
  '[start]\ninitial = "project"\n[time]\nend = 2\n';

const tests = {
  async "a long motion is no other motion"() {
    // 0.44 s a swing from rest, 450 of them: more than 900 points tell apart, and more than curves had nodes for.
    const { run: file_of_run, page: file } = made(
        "long",
        'format = 1\ngravity = [0, 0, -9.81]\n[[body]]\nname = "bob"\nshape = { sphere = 0.01 }\nmass = 1\n' +
          'position = [0.04, 0, -0.0473]\n[[joint]]\nname = "pivot"\ntype = "revolute"\nbetween = ["world", "bob"]\n' +
          "at = [0, 0, 0]\naxis = [0, 1, 0]\n[time]\nend = 200\n",
      ),
      page = await open(file),
      angles = plot(page, "Angles of joints");
    /** What part of the height between both turning points is drawn, at places across the plot: the least. */
    const drawn = () =>
      angles.locator("canvas").evaluate((canvas) => {
        const { width, height } = canvas,
          copy = Object.assign(document.createElement("canvas"), { width, height }),
          context = copy.getContext("2d", { willReadFrequently: true }),
          shares = [];
        context.drawImage(canvas, 0, 0);
        for (let k = 0; k < 60; ++k) {
          const x = Math.round(width * (0.3 + (0.6 * k) / 60)),
            { data } = context.getImageData(x, 0, 1, height);
          let n = 0;
          for (let y = 0; y < height; ++y)
            if (data[4 * y + 2] > data[4 * y] + 60 && data[4 * y + 3] > 200) ++n;
          shares.push(n / height);
        }
        return Math.min(...shares);
      });
    assert.ok((await drawn()) > 0.6, "a band from one turning point to the other, everywhere");
    assert.match(await page.locator("#plots .note").first().textContent(), /least and the largest value/);
    const { rows } = await table(page, angles),
      least = Math.min(...rows.map(([, x]) => x)),
      most = Math.max(...rows.map(([, x]) => x)),
      turn = 2 * Math.atan2(0.04, 0.0473);
    assert.ok(Math.abs(least) < 1e-3 && Math.abs(most - turn) < 1e-3, `${least} ${most} of ${turn}`);
    for (const k of [0.1, 0.37, 0.9].map((s) => Math.round(s * (rows.length - 1)))) {
      const [t, angle] = rows[k],
        there = sample(file_of_run, "--joint", "pivot", "--at", String(t)).angle;
      assert.ok(Math.abs(angle - there) < 1e-4, `${angle} for ${there} at ${t} s`);
    }
    // It is not played so fast that frames skip swings, and where one wants that, it is said.
    const speed = Number(await page.locator("#speed").inputValue());
    assert.ok(speed >= 1 && speed <= 5, `${speed}`);
    const words = await page.locator("#speed option").allTextContents();
    assert.match(words.at(-1), /frames skip/);
    assert.doesNotMatch(words[words.length - 7], /skip/);
    // Zoomed in it is a line (the control of the band).
    const box = await angles.locator(".u-over").boundingBox();
    await page.mouse.move(box.x + 100, box.y + 40);
    await page.mouse.down();
    await page.mouse.move(box.x + 106, box.y + 40, { steps: 3 });
    await page.mouse.up();
    assert.ok((await drawn()) < 0.3, "a line");
    assert.deepEqual(page.problems, []);
  },
  async "motors come first, and nothing flat or twice"() {
    const { page: file } = made("shaft", shaft_and_flap()),
      page = await open(file);
    const first = await titles(page);
    assert.deepEqual(first.slice(0, 4), [
      "Torques of motors",
      "Power of motors",
      "Angles of joints",
      "Angles of joints (2)",
    ]);
    for (const figure of await page.locator("#plot-list figure").all())
      if (/joints/.test(await figure.locator("figcaption").textContent()))
        assert.doesNotMatch(await figure.locator(".keys").textContent(), /motor/);
    // Of a rod that is turned evenly: torque against gravity, power by the rate; rounded, and interpolated.
    const torque = await table(page, plot(page, "Torques of motors")),
      power = await table(page, plot(page, "Power of motors"));
    let worst = 0;
    torque.rows.forEach(([t, effort], k) => {
      const truth = -3 * 9.81 * 0.2 * Math.cos(6 * t);
      worst = Math.max(worst, Math.abs(effort - truth), Math.abs(power.rows[k][1] - 6 * truth) / 6);
    });
    assert.ok(worst < 2e-4, `${worst} N m`);
    assert.deepEqual(torque.head, ["t [s]", "motor [N m]"]);
    // An actuator: as its formula says, with the sign of the coordinate, whichever body comes first.
    for (const pair of ['["world", "rotor"]', '["rotor", "arm"]', '["arm", "rotor"]']) {
      const arm =
        '[[body]]\nname = "arm"\nshape = { box = [0.3, 0.05, 0.05] }\nmass = 2\nposition = [0, 0.1, 0]\n';
      const text = shaft_and_flap()
        .replace(
          /\[\[drive\]\][\s\S]*?rate = 6\n/,
          `${pair.includes("arm") ? arm : ""}[[load]]\nname = "motor"\ntype = "actuator"\njoint = "shaft"\nexpression = "0.3*cos(2*t)"\n`,
        )
        .replace('["world", "rotor"]', pair);
      const page = await open(made("actuator", text).page);
      await page.selectOption("#add", {
        label: await page.locator("#add option", { hasText: "Rates of angles" }).first().textContent(),
      });
      assert.equal((await titles(page))[0], "Torques of motors");
      const torque = await table(page, plot(page, "Torques of motors")),
        power = await table(page, plot(page, "Power of motors")),
        rates = await table(page, plot(page, "Rates of angles")),
        shaft = rates.head.indexOf("shaft [rad/s]");
      const off = Math.max(
        ...torque.rows.map(([t, effort], k) =>
          Math.max(
            Math.abs(effort - 0.3 * Math.cos(2 * t)),
            Math.abs(power.rows[k][1] - effort * rates.rows[k][shaft]) / 10,
          ),
        ),
      );
      assert.ok(off < 1e-4, `${pair}: ${off}`);
    }
    // A sensor that reads what the plot of a single body shows.
    const falls = (sensor) =>
      `format = 1\ngravity = [0, 0, -9.81]\n[[body]]\nname = "stone"\nshape = { sphere = 0.1 }\nmass = 1\nvelocity = [1, 0, 2]\nangular_velocity = [0, 0, 1]\n${sensor}[time]\nend = 1\n`;
    const both = '[[sensor]]\nname = "middle"\ntype = "point"\nbody = "stone"\n';
    const one = await open(made("falls", falls(both)).page),
      none = await open(made("falls_bare", falls("")).page);
    const [with_sensor, bare] = [await titles(one), await titles(none)];
    assert.ok(
      with_sensor.some((title) => /Sensor middle/.test(title)) &&
        !with_sensor.some((title) => /centre of mass/.test(title)),
      `${with_sensor}`,
    );
    assert.ok(
      bare.some((title) => /centre of mass/.test(title)),
      "the control",
    );
    assert.deepEqual([...page.problems, ...one.problems, ...none.problems], []);
  },

  async "values are saved as they are seen, at full digits"() {
    const { page: file, run: result } = made("four_bar", example("four_bar")),
      page = await open(file);
    await page.selectOption("#add", { label: "coupler: centre of mass" });
    const figure = plot(page, "coupler: centre of mass"),
      { head, rows } = await table(page, figure);
    assert.deepEqual(head, ["t [s]", "x [m]", "y [m]", "z [m]"]);
    assert.equal(rows.length, 901);
    const times = [0, 7, 450, 893].map((k) => rows[k][0]),
      truth = sample(result, "--body", "coupler", ...times.flatMap((t) => ["--at", String(t)])).samples;
    const centre = await page.evaluate(
      () =>
        JSON.parse(document.querySelector("script.run").textContent).bodies.find((b) => b.name === "coupler")
          .centre,
    );
    [0, 7, 450, 893].forEach((k, i) => {
      const { position, directors_raw: d } = truth[i];
      position.forEach((x, j) => {
        const at = x + d[0][j] * centre[0] + d[1][j] * centre[1] + d[2][j] * centre[2];
        assert.ok(Math.abs(at - rows[k][1 + j]) < 1e-14, `${at} ${rows[k][1 + j]}`);
      });
    });
    // What is hidden is not saved, and what is zoomed into is.
    await figure.locator(".keys button", { hasText: "y" }).click();
    assert.equal(await figure.locator(".keys button[aria-pressed=false]").count(), 1);
    await page.keyboard.press("+");
    const part = await table(page, figure);
    assert.deepEqual(part.head, ["t [s]", "x [m]", "z [m]"]);
    assert.ok(part.rows.at(-1)[0] < 2.6 && part.rows.length === 901);
    assert.ok(await page.isVisible("#zoom-all"));
    await page.click("#zoom-all");
    assert.ok((await page.isVisible("#zoom-hint")) && !(await page.isVisible("#zoom-all")));
    const [name, png] = await saved(page, figure, "PNG");
    assert.equal(name, "coupler_centre_of_mass.png");
    assert.equal(png.readUInt32BE(16), 1600);
    assert.ok(png.length > 20000, `${png.length} bytes`);
    await figure.locator(".keys button", { hasText: "z" }).click();
    assert.ok(
      !png.equals((await saved(page, figure, "PNG"))[1]),
      "without another line it is another picture",
    );
    // The other kind of plot, of values at given times.
    await page.click("#tab-quality");
    const lengths = page.locator("#quality figure").filter({ hasText: "Lengths of time elements" });
    assert.ok((await table(page, lengths)).rows.length > 90);
    assert.deepEqual(page.problems, []);
  },

  async "names in saved tables are no formulas"() {
    const text = shaft_and_flap()
      .replaceAll('"shaft"', '"=cmd, \\"a\\""')
      .replaceAll('"hinge"', '"@b"')
      .replace("rate = 6", "rate = 0.3");
    const page = await open(made("formulas", text).page),
      [, bytes] = await saved(page, plot(page, "Angles of joints"), "CSV");
    assert.equal(bytes.toString().split("\r\n")[0], `t [s],"'=cmd, ""a"" [rad]",'@b [rad]`);
    assert.deepEqual(page.problems, []);
  },

  async "angles in degrees, remembered"() {
    const { page: file } = made("shaft", shaft_and_flap()),
      page = await open(file);
    const in_radians = await table(page, plot(page, "Angles of joints"));
    await page.selectOption("#angles", "deg");
    const in_degrees = await table(page, plot(page, "Angles of joints"));
    assert.deepEqual([in_radians.head[1], in_degrees.head[1]], ["shaft [rad]", "shaft [deg]"]);
    in_degrees.rows.forEach(([, angle], k) =>
      assert.ok(Math.abs(angle - (in_radians.rows[k][1] * 180) / Math.PI) < 1e-9),
    );
    await page.reload();
    await page.waitForFunction(() => window.livensReport);
    assert.equal(await page.inputValue("#angles"), "deg");
    assert.match(await plot(page, "Angles of joints").locator("figcaption").textContent(), /deg/);
    await page.selectOption("#add", { label: "Rates of angles" });
    await page.selectOption("#angles", "rpm");
    const rates = await table(page, plot(page, "Rates of angles"));
    assert.equal(rates.head[1], "shaft [rpm]");
    assert.ok(Math.abs(rates.rows[450][1] - 180 / Math.PI) < 1e-4, `${rates.rows[450]}`);
    await page.selectOption("#angles", "rad");
    assert.deepEqual(page.problems, []);
  },

  async "one quantity against another"() {
    const { page: file } = made("shaft", shaft_and_flap()),
      page = await open(file);
    await page.selectOption("#add", { label: "rotor: path of the centre of mass" });
    const path = plot(page, "rotor: path"),
      { head, rows } = await table(page, path);
    assert.deepEqual(head, ["t [s]", "rotor x [m]", "rotor z [m]"]);
    const off = Math.max(...rows.map(([, x, z]) => Math.abs(Math.hypot(x, z) - 0.2)));
    assert.ok(off < 1e-6, `a circle, but for ${off} m`);
    // A metre is as long upwards as across.
    const dot = async (t) => {
      await page.evaluate((at) => livensReport.setTime(at), t);
      const style = await path.locator(".dot").evaluate((e) => e.style.transform);
      return [...style.matchAll(/-?[\d.]+(?=px)/g)].map(([n]) => Number(n));
    };
    const at = (t) => rows.reduce((best, row) => (Math.abs(row[0] - t) < Math.abs(best[0] - t) ? row : best));
    const [p, q, r] = [0, 0.5, 1.2].map(at),
      [a, b, c] = [await dot(p[0]), await dot(q[0]), await dot(r[0])];
    const across = (b[0] - a[0]) / (q[1] - p[1]),
      up = -(c[1] - b[1]) / (r[2] - q[2]);
    assert.ok(across > 0 && Math.abs(across / up - 1) < 1e-3, `${across} ${up}`);
    // Where the curve is clicked, there the time goes.
    const box = await path.locator("canvas").boundingBox();
    await page.mouse.click(box.x + b[0], box.y + b[1]);
    const now = await page.evaluate(() => livensReport.now());
    const turn = (2 * Math.PI) / 6; // it passes there again
    assert.ok(Math.abs(((now - q[0] + turn / 2 + turn) % turn) - turn / 2) < 0.01, `${now} for ${q[0]}`);
    await page.selectOption("#add", { label: "hinge: phase portrait" });
    assert.deepEqual((await table(page, plot(page, "hinge: phase portrait"))).head.slice(1), [
      "hinge angle [rad]",
      "hinge angle rate [rad/s]",
    ]);
    // Any pair.
    await page.click("#pair summary");
    await page.selectOption("#pair-y", { label: "Power of motors: motor" });
    await page.selectOption("#pair-x", { label: "Torques of motors: motor" });
    await page.click("#pair-add");
    const pair = plot(page, "Power of motors: motor over Torques of motors: motor"),
      values = await table(page, pair);
    const apart = Math.max(...values.rows.map(([, x, y]) => Math.abs(y - 6 * x)));
    assert.ok(apart < 2e-3, `${apart} W of 35: velocities are derivatives of polynomials`);
    assert.ok((await saved(page, pair, "PNG"))[1].length > 10000);
    await pair.locator(".remove").click();
    assert.equal(await page.locator("#plot-list figure").filter({ hasText: "over" }).count(), 0);
    assert.deepEqual(page.problems, []);
  },
  async "events stand on the bar of time and in a table"() {
    // A ball that bounces from 1 m with a restitution of one half: impacts at t1, 2 t1, 2.5 t1, ..
    const text =
        'format = 1\ngravity = [0, 0, -9.81]\n[[body]]\nname = "ball"\nshape = { sphere = 0.1 }\nmass = 2\n' +
        'position = [0, 0, 1]\n[[joint]]\nname = "guide"\ntype = "prismatic"\nbetween = ["world", "ball"]\n' +
        "at = [0, 0, 0]\naxis = [0, 0, 1]\ncoordinate = 1\nlimits = [0, inf]\nlimit_restitution = 0.5\n" +
        '[[event]]\nname = "half"\nwhen = "guide.displacement < 0.5"\n[time]\nend = 2\naccuracy = 1e-9\n',
      first = Math.sqrt(2 / 9.81);
    const page = await open(made("bounces", text).page);
    const marks = page.locator("#marks button"),
      n = await marks.count();
    assert.ok(n > 10, `${n} marks`);
    assert.equal(await marks.nth(0).locator("span").textContent(), "half");
    assert.equal(await marks.nth(1).locator("span").textContent(), "guide.low");
    const shown = await marks.locator("span:visible").count();
    assert.ok(shown > 1 && shown < n, `${shown} of ${n} names: what has no room is left out`);
    await marks.nth(1).click();
    const now = await page.locator("#clock strong").textContent();
    assert.ok(Math.abs(parseFloat(now) - first) < 1e-3, now);
    await page.click("#tab-quality");
    const rows = await page
      .locator("#events tbody tr")
      .evaluateAll((all) => all.map((row) => [...row.children].map((cell) => cell.textContent)));
    assert.ok(rows.length >= n, `${rows.length} rows, ${n} marks`);
    const speed = Math.sqrt(2 * 9.81),
      [name, t, , before, behind, impulse] = rows[1].map((cell, i) => (i ? parseFloat(cell) : cell));
    assert.ok(name.startsWith("guide.low"), name);
    assert.ok(Math.abs(t - first) < 1e-8, `${t}`);
    assert.match(rows[1][2], /e\u2212\d+\u00a0s$/);
    assert.ok(Math.abs(before - speed) < 1e-3 && Math.abs(behind - speed / 2) < 1e-3, `${before} ${behind}`);
    assert.ok(Math.abs(impulse - 3 * speed) < 1e-2, impulse);
    assert.equal(rows[0][3], "", "what is no impact has no speed");
    assert.ok(Math.abs(parseFloat(rows.at(-1)[6]) - 3 * first) < 1e-6, "when it is at rest");
    assert.deepEqual(page.problems, []);
    if (process.env.LIVENS_PICTURES) {
      await page.screenshot({ path: `${process.env.LIVENS_PICTURES}/events_table.png` });
      await page.click("#tab-motion");
      await page.screenshot({ path: `${process.env.LIVENS_PICTURES}/events_bar.png` });
    }
    // The control: no events, no marks.
    const quiet = await open(made("shaft and flap", shaft_and_flap()).page);
    assert.ok(await quiet.locator("#marks").isHidden());
    await quiet.click("#tab-quality");
    assert.equal(await quiet.locator("#events").count(), 0);
  },
};

await run(tests);
