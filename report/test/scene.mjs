// SPDX-License-Identifier: BSD-3-Clause
// The picture in space: what lies in one plane, names that stand close, shadows, slots; and pictures made by record.mjs.
//   LIVENS_PROGRAM=build/release/livens node report/test/scene.mjs [NAME]
import { execFileSync } from "node:child_process";
import { existsSync, readFileSync, writeFileSync } from "node:fs";
import { join } from "node:path";
import assert from "node:assert/strict";
import { asked } from "../record.mjs";
import { example, folder, made, open, run, source, with_script } from "./tools.mjs";

const switched = async (page, shown) => {
  for (const what of ["trails", "forces", "joints", "names", "frames"])
    await page.setChecked(`#show-${what}`, shown.includes(what));
};
const slab = (name, size, rest = "") =>
  `[[body]]\nname = "${name}"\nshape = { box = [${size}] }\nmass = 1\n${rest}` +
  `[[joint]]\nname = "${name} weld"\ntype = "weld"\nbetween = ["world", "${name}"]\nat = [0, 0, 0]\n`;
/** Of pixels about the middle of the picture: how many are of the first body's colour, of the second's. */
const colours = (page, half) =>
  page.evaluate((reach) => {
    const canvas = document.getElementById("stage"),
      flat = document.createElement("canvas");
    [flat.width, flat.height] = [canvas.width, canvas.height];
    const c = flat.getContext("2d");
    c.drawImage(canvas, 0, 0);
    const { data } = c.getImageData(
      canvas.width / 2 - reach,
      canvas.height / 2 - reach,
      2 * reach,
      2 * reach,
    );
    let [blue, orange] = [0, 0];
    for (let i = 0; i < data.length; i += 4)
      if (data[i + 2] > data[i] + 40) ++blue;
      else if (data[i] > data[i + 2] + 40) ++orange;
    return [blue, orange];
  }, half);

const tests = {
  async "bodies in one plane do not flicker"() {
    // A cross of two slabs of one thickness.
    const text = `format = 1\n${slab("along", "1, 0.4, 0.02")}${slab("across", "0.4, 1, 0.02")}[time]\nend = 1\n`,
      { page: file } = made("cross", text),
      bare = join(folder, "cross_bare.html");
    const seen = async (page) => {
      await switched(page, []);
      const all = [];
      await page.focus("#stage");
      for (let k = 0; k < 6; ++k) {
        all.push(await colours(page, 25));
        await page.keyboard.press(k % 2 ? "ArrowLeft" : "ArrowDown");
      }
      return all;
    };
    const page = await open(file);
    for (const [blue, orange] of await seen(page))
      assert.ok(blue === 0 && orange > 2000, `${blue} pixels of ${orange} are of the other`);
    // The control: without ranks both are mixed.
    const flat = (script) => script.replace("rank * gl_Position.w", "0.0 * gl_Position.w");
    writeFileSync(bare, with_script(readFileSync(file, "utf8"), flat));
    const without = await open(bare, { bypassCSP: true });
    assert.ok(
      (await seen(without)).some(([blue]) => blue > 20),
      "the control",
    );
    assert.deepEqual(page.problems, []);
  },

  async "names do not cover each other"() {
    const bodies = ["block", "lever", "a third", "another"]
      .map(
        (name, k) =>
          `[[body]]\nname = "${name}"\nshape = { sphere = 0.05 }\nmass = 1\nposition = [${0.01 * k}, 0, 0]\nvelocity = [${0.2 - 0.1 * k}, 0.1, ${0.05 * k}]\n`,
      )
      .join("");
    const page = await open(made("close", `format = 1\n${bodies}[time]\nend = 1\n`).page);
    for (let k = 0; k <= 10; ++k) {
      const boxes = await page.evaluate((t) => {
        livensReport.setTime(t);
        return [...document.querySelectorAll("#labels span:not([hidden])")].map((e) =>
          e.getBoundingClientRect().toJSON(),
        );
      }, k / 10);
      assert.equal(boxes.length, 4);
      for (const [i, a] of boxes.entries())
        for (const b of boxes.slice(0, i))
          assert.ok(
            a.right <= b.left + 0.5 ||
              b.right <= a.left + 0.5 ||
              a.bottom <= b.top + 0.5 ||
              b.bottom <= a.top + 0.5,
            `at ${k / 10} s`,
          );
    }
    assert.deepEqual(page.problems, []);
  },

  async "a shadow goes with its body"() {
    const text =
      'format = 1\n[[body]]\nname = "ball"\nshape = { sphere = 0.1 }\nmass = 1\nvelocity = [1, 0, 0]\nposition = [0, 0, 0.5]\n' +
      '[[body]]\nname = "rest"\nshape = { box = [0.1, 0.1, 0.01] }\nmass = 1\n[time]\nend = 1\n';
    const page = await open(made("ball", text).page);
    await switched(page, []);
    /** Where it is dark, but not covered: in shares of the width; and how many pixels. */
    const dark = (t) =>
      page.evaluate((at) => {
        livensReport.setTime(at);
        const canvas = document.getElementById("stage"),
          flat = document.createElement("canvas");
        [flat.width, flat.height] = [canvas.width, canvas.height];
        const c = flat.getContext("2d");
        c.drawImage(canvas, 0, 0);
        const { data } = c.getImageData(0, 0, flat.width, flat.height);
        let [n, sum] = [0, 0];
        for (let i = 3; i < data.length; i += 4)
          if (data[i] > 12 && data[i] < 120) {
            ++n;
            sum += ((i >> 2) % flat.width) / flat.width;
          }
        return [n, sum / n];
      }, t);
    const [first, middle, last] = [await dark(0), await dark(0.5), await dark(1)];
    for (const [n] of [first, middle, last]) assert.ok(n > 300, `${n} pixels`);
    assert.ok(
      Math.abs(first[1] - last[1]) > 0.2 && (middle[1] - first[1]) * (last[1] - middle[1]) > 0,
      `${[first, middle, last]}`,
    );
    assert.deepEqual(page.problems, []);
  },

  async "all of a slot is drawn"() {
    const text =
      'format = 1\ngravity = [0.1, 0, 0]\n[[body]]\nname = "bead"\nshape = { sphere = 0.02 }\nmass = 1\nposition = [0, 0.3, 0]\n' +
      '[[joint]]\nname = "slot"\ntype = "slot"\nbetween = ["world", "bead"]\ncurve = { points = [[-0.3, 0.3, 0], [0, 0.3, 0], [0.3, 0.45, 0]] }\n[time]\nend = 0.5\n';
    const { page: file } = made("slot", text),
      page = await open(file);
    const path = await page.evaluate(
      () => JSON.parse(document.querySelector("script.run").textContent).joints[0].path,
    );
    for (const [end, place] of [
      [path[0], [-0.3, 0.3, 0]],
      [path.at(-1), [0.3, 0.45, 0]],
    ])
      assert.ok(Math.hypot(...end.map((x, i) => x - place[i])) < 1e-12, `${end}`);
    // A page of an older program, without the curve: what the bead travels.
    const older = join(folder, "older.html");
    writeFileSync(older, readFileSync(file, "utf8").replace(/"path": ?\[\[.*?\]\]/s, '"path": []'));
    const part = await open(older),
      camera = (p) => p.evaluate(() => Math.hypot(...livensReport.camera()));
    assert.ok((await camera(part)) < 0.7 * (await camera(page)), "so little of it fills the picture");
    assert.deepEqual([...page.problems, ...part.problems], []);
  },

  async "record.mjs makes files, and says what it cannot"() {
    const { page } = made("four_bar", example("four_bar")),
      script = join(source, "report/record.mjs");
    const record = (out, ...words) => {
      try {
        execFileSync(process.execPath, [script, page, join(folder, out), ...words], {
          stdio: ["ignore", "ignore", "pipe"],
        });
        return "";
      } catch (error) {
        return error.stderr.toString();
      }
    };
    assert.equal(record("a.png", "at=0.7", "size=320x200", "names=on", "view=front", "forces=off"), "");
    const png = readFileSync(join(folder, "a.png"));
    assert.deepEqual([png.readUInt32BE(16), png.readUInt32BE(20)], [320, 200]);
    assert.equal(record("a.gif", "from=0", "to=0.5", "fps=10", "size=160x100"), "");
    assert.equal(readFileSync(join(folder, "a.gif")).toString("latin1", 0, 6), "GIF89a");
    assert.equal(record("a.webm", "from=0", "to=0.2", "fps=25", "size=160x100", "speed=0.5"), "");
    assert.equal(readFileSync(join(folder, "a.webm")).readUInt32BE(0), 0x1a45dfa3);
    assert.match(record("b.png", "colour=dark"), /'colour=dark' is none of/);
    assert.match(record("b.mp4"), /usage: /);
    assert.match(record("b.webm", "from=2", "to=1"), /end must be after the start/);
    assert.ok(!existsSync(join(folder, "b.png")) && !existsSync(join(folder, "b.webm")));
    assert.throws(() => asked(["at=soon"]), /a number is needed/);
    assert.throws(() => asked(["size=big"]), /two numbers/);
  },
};

await run(tests);
