// SPDX-License-Identifier: BSD-3-Clause
// What the page saves, decoded again by the browser and by a reader of this file: stills, videos, GIFs, plots.
//   LIVENS_PROGRAM=build/release/livens node report/test/saved.mjs [NAME]
import { readFileSync, writeFileSync } from "node:fs";
import { join } from "node:path";
import assert from "node:assert/strict";
import { browser, example, folder, made, open, run } from "./tools.mjs";

const wide = { width: 321, height: 203 },
  course = { from: 0.25, to: 1.25, speed: 0.5, rate: 12.5 },
  frames = 26; // 1 s at half the speed is 2 s of 12.5 frames each, and the last
const record = async (page, kind, look = {}, part = {}) =>
  Buffer.from(
    await page.evaluate(([k, l, c]) => livensReport.record(k, l, c), [kind, { ...wide, ...look }, part]),
    "base64",
  );

/** Elements of EBML as [id, start, end], one level deep. */
function* elements(bytes, from, to) {
  for (let at = from; at < to; ) {
    const id_size = Math.clz32(bytes[at]) - 23,
      id = bytes.readUIntBE(at, id_size);
    at += id_size;
    const size = Math.clz32(bytes[at]) - 23,
      length = Number(
        bytes.subarray(at, at + size).reduce((n, b, i) => n * 256n + BigInt(i ? b : b & (0xff >> size)), 0n),
      );
    at += size;
    assert.ok(at + length <= to, `an element ${id.toString(16)} ends in its parent`);
    yield [id, at, at + length];
    at += length;
  }
}
function read_webm(bytes) {
  const told = { times: [], keys: 0, pictures: [] },
    [head, segment, ...rest] = [...elements(bytes, 0, bytes.length)];
  assert.equal(head[0], 0x1a45dfa3);
  assert.equal(segment[0], 0x18538067);
  assert.deepEqual(rest, []);
  const inside = (from, to) =>
    Object.fromEntries([...elements(bytes, from, to)].map(([id, a, b]) => [id, [a, b]]));
  const number = ([a, b]) => bytes.subarray(a, b).reduce((n, byte) => n * 256 + byte, 0);
  const clusters = [];
  for (const [id, from, to] of elements(bytes, segment[1], segment[2])) {
    if (id === 0x1549a966) told.duration = bytes.readDoubleBE(inside(from, to)[0x4489][0]);
    if (id === 0x1654ae6b) {
      const track = inside(...inside(from, to)[0xae]),
        video = inside(...track[0xe0]);
      told.codec = bytes.toString("latin1", ...track[0x86]);
      told.size = [number(video[0xb0]), number(video[0xba])];
      const colour = inside(...video[0x55b0]);
      told.colours = [0x55b1, 0x55ba, 0x55bb, 0x55b9].map((id) => number(colour[id]));
    }
    if (id === 0x1c53bb6b)
      told.cues = [...elements(bytes, from, to)].map(
        ([, a, b]) => segment[1] + number(inside(...inside(a, b)[0xb7])[0xf1]),
      );
    if (id !== 0x1f43b675) continue;
    clusters.push(from - 12); // id of 4 bytes, length of 8
    let start = 0;
    for (const [part, a, b] of elements(bytes, from, to)) {
      if (part === 0xe7) start = number([a, b]);
      if (part !== 0xa3) continue;
      told.times.push(start + bytes.readInt16BE(a + 1));
      told.keys += bytes[a + 3] >> 7;
      told.pictures.push({
        type: bytes[a + 3] >> 7 ? "key" : "delta",
        data: bytes.subarray(a + 4, b).toString("base64"),
      });
    }
  }
  assert.deepEqual(told.cues, clusters, "cues lead to clusters");
  return told;
}
function read_gif(bytes) {
  assert.equal(bytes.toString("latin1", 0, 6), "GIF89a");
  const told = { size: [bytes.readUInt16LE(6), bytes.readUInt16LE(8)], delays: [], parts: [] };
  let at = 13 + 3 * (2 << (bytes[10] & 7));
  const blocks = (from) => {
    while (bytes[from] !== 0) from += bytes[from] + 1;
    return from + 1;
  };
  for (; bytes[at] !== 0x3b; ) {
    if (bytes[at] === 0x21) {
      if (bytes[at + 1] === 0xf9) told.delays.push(bytes.readUInt16LE(at + 4));
      at = blocks(at + 2);
    } else {
      assert.equal(bytes[at], 0x2c);
      told.parts.push([1, 3, 5, 7].map((k) => bytes.readUInt16LE(at + k)));
      at = blocks(at + 11);
    }
  }
  assert.equal(at, bytes.length - 1);
  return told;
}

/**
 * Mean difference of channels between pictures that the browser decodes: stills, frames of a GIF, frames of a video. A
 * video is decoded frame by frame: one that plays may still show the picture before where the machine is busy.
 */
async function differences(pairs) {
  const page = await browser.newPage();
  writeFileSync(join(folder, "decoder.html"), "<!doctype html><title>decoder</title>");
  await page.goto(`file://${join(folder, "decoder.html")}`);
  const plain = ([kind, bytes, at]) =>
    kind === "webm" ? [kind, read_webm(bytes), at] : [kind, bytes.toString("base64"), at];
  const all = await page.evaluate(
    async (wanted) => {
      const bytes_of = (text) => Uint8Array.from(atob(text), (c) => c.charCodeAt(0));
      const pixels = (source, width, height) => {
        const canvas = new OffscreenCanvas(width, height),
          c = canvas.getContext("2d");
        c.drawImage(source, 0, 0);
        return c.getImageData(0, 0, width, height);
      };
      const frame_of = async ({ codec, colours, pictures }, at) => {
        let seen = null,
          fault = null,
          n = 0;
        const decoder = new VideoDecoder({
          output: (frame) => {
            if (n++ === at) seen = pixels(frame, frame.displayWidth, frame.displayHeight);
            frame.close();
          },
          error: (error) => {
            fault = error;
          },
        });
        const names = { 1: "bt709", 6: "smpte170m", 13: "iec61966-2-1" };
        const [matrix, transfer, primaries] = colours.map((n) => names[n]);
        decoder.configure({
          codec: codec === "V_VP8" ? "vp8" : "vp09.00.41.08",
          colorSpace: { matrix, transfer, primaries, fullRange: colours[3] === 2 },
        });
        for (const [k, { type, data }] of pictures.entries())
          decoder.decode(new EncodedVideoChunk({ type, timestamp: k, data: bytes_of(data) }));
        await decoder.flush();
        decoder.close();
        if (fault || !seen) throw fault ?? new Error(`no frame ${at} of ${n}`);
        return seen;
      };
      const decoded = async ([kind, source, at]) => {
        if (kind === "webm") return frame_of(source, at);
        const decoder = new ImageDecoder({ data: bytes_of(source), type: `image/${kind}` }),
          { image } = await decoder.decode({ frameIndex: at });
        return pixels(image, image.displayWidth, image.displayHeight);
      };
      const results = [];
      for (const [a, b] of wanted) {
        const [p, q] = [await decoded(a), await decoded(b)];
        if (p.width !== q.width || p.height !== q.height) results.push(Infinity);
        else results.push(p.data.reduce((sum, v, i) => sum + Math.abs(v - q.data[i]), 0) / p.data.length);
      }
      return results;
    },
    pairs.map((pair) => pair.map(plain)),
  );
  await page.close();
  return all;
}
/** What a browser that plays a video says of it, and that it can jump to an instant. */
async function played(bytes, at) {
  const page = await browser.newPage();
  const told = await page.evaluate(
    async ([text, at]) => {
      const video = document.createElement("video"),
        happens = (name) =>
          new Promise((done, fail) => {
            video[name] = done;
            video.onerror = () => fail(new Error(video.error.message));
          });
      video.src = `data:video/webm;base64,${text}`;
      await happens("onloadeddata");
      video.currentTime = at;
      await happens("onseeked");
      return { size: [video.videoWidth, video.videoHeight], seconds: video.duration, at: video.currentTime };
    },
    [bytes.toString("base64"), at],
  );
  await page.close();
  return told;
}
const stills_of = async (page, look, ks) => {
  const stills = [];
  for (const k of ks)
    stills.push(
      await record(page, "png", look, {
        from: Math.min(course.from + (k * course.speed) / course.rate, course.to),
      }),
    );
  return stills;
};

const tests = {
  async "a still has the size, names and background that were asked for"() {
    const { page: file } = made("four_bar", example("four_bar")),
      page = await open(file);
    // Once nothing is drawn any more: the same in two frames, one after the other.
    const screen = () =>
      page.evaluate(async () => {
        const frame = () => new Promise(requestAnimationFrame),
          stage = document.getElementById("stage");
        let seen = "";
        for (let n = 0; n < 200; ++n) {
          await frame();
          await frame();
          const now = stage.toDataURL();
          if (now === seen) return now;
          seen = now;
        }
        throw new Error("the picture does not come to rest");
      });
    const on_screen = await screen();
    const size = (png) => [png.readUInt32BE(16), png.readUInt32BE(20)];
    const bare = await record(page, "png", {}, { from: 0.7 });
    assert.deepEqual(size(bare), [321, 203]);
    const variants = [bare];
    for (const look of [
      { names: true },
      { clock: true },
      { is_clear: true },
      { scheme: "dark" },
      { side: "top" },
    ])
      variants.push(await record(page, "png", look, { from: 0.7 }));
    variants.push(await record(page, "png", {}, { from: 1.7 }));
    for (const [i, a] of variants.entries())
      for (const b of variants.slice(0, i)) assert.ok(!a.equals(b), `still ${i} is another one`);
    assert.ok(bare.equals(await record(page, "png", {}, { from: 0.7 })), "the same again");
    await page.evaluate(() => livensReport.setTime(0));
    assert.ok((await screen()) === on_screen, "the screen is as it was");
    for (const side of [8, 9000, 100.5])
      await assert.rejects(record(page, "png", { width: side }), /have 16 to 8192 pixels/);
    for (const from of [-0.1, 5.1])
      await assert.rejects(record(page, "png", {}, { from }), /outside the motion/);
    assert.deepEqual(size(await record(page, "png", { width: 3840, height: 2160 })), [3840, 2160]);
    assert.deepEqual(page.problems, []);
  },

  async "a video holds every frame at its instant"() {
    const { page: file } = made("four_bar", example("four_bar")),
      page = await open(file);
    // Odd sides and even ones.
    for (const look of [{}, { width: 640, height: 360 }]) {
      const bytes = await record(page, "webm", look, course),
        told = read_webm(bytes);
      assert.match(told.codec, /^V_VP[89]$/);
      assert.ok(!told.colours.slice(0, 3).includes(2), `players need not guess: ${told.colours}`);
      assert.deepEqual(told.size, [look.width ?? wide.width, look.height ?? wide.height]);
      assert.deepEqual(
        told.times,
        Array.from({ length: frames }, (_, k) => 80 * k),
      );
      assert.ok(Math.abs(told.duration - 80 * frames) < 1e-9);
      assert.ok(told.keys >= 2, "one can jump into it");
      const shown = await played(bytes, 1);
      assert.deepEqual(shown.size, told.size);
      assert.ok(
        Math.abs(shown.seconds - told.duration / 1000) < 1e-3 && shown.at === 1,
        JSON.stringify(shown),
      );
      const ks = [0, 7, 13, 25],
        stills = await stills_of(page, look, ks),
        seen = (k) => ["webm", bytes, k];
      const same = await differences(ks.map((k, i) => [seen(k), ["png", stills[i], 0]])),
        other = await differences(ks.map((k, i) => [seen(k), ["png", stills[(i + 1) % 4], 0]]));
      console.log(
        `    from the stills ${same.map((d) => d.toFixed(2))}, from others ${other.map((d) => d.toFixed(2))}`,
      );
      ks.forEach((k, i) =>
        assert.ok(same[i] < 1.5 && same[i] < 0.5 * other[i], `frame ${k}: ${same[i]}, ${other[i]}`),
      );
    }
    assert.deepEqual(page.problems, []);
  },

  async "a GIF holds every frame, and only what changes of it"() {
    const { page: file } = made("four_bar", example("four_bar")),
      page = await open(file);
    const bytes = await record(page, "gif", { names: true }, course),
      told = read_gif(bytes);
    assert.deepEqual(told.size, [321, 203]);
    assert.equal(told.parts.length, frames);
    assert.deepEqual(told.parts[0], [0, 0, 321, 203]);
    assert.ok(told.parts.slice(1).some(([, , w, h]) => w * h < 0.9 * 321 * 203));
    assert.equal(
      told.delays.reduce((a, b) => a + b),
      Math.round((100 * frames) / 12.5),
    );
    const ks = [0, 7, 13, 25],
      stills = await stills_of(page, { names: true }, ks),
      same = await differences(
        ks.map((k, i) => [
          ["gif", bytes, k],
          ["png", stills[i], 0],
        ]),
      ),
      other = await differences(
        ks.map((k, i) => [
          ["gif", bytes, k],
          ["png", stills[(i + 1) % 4], 0],
        ]),
      );
    console.log(
      `    from the stills ${same.map((d) => d.toFixed(2))}, from others ${other.map((d) => d.toFixed(2))}`,
    );
    ks.forEach((k, i) =>
      assert.ok(same[i] < 1.5 && same[i] < 0.5 * other[i], `frame ${k}: ${same[i]}, ${other[i]}`),
    );
    assert.deepEqual(page.problems, []);
  },

  async "a sketch is flat, true to scale, and text"() {
    const name = '</title>"&<b>';
    const text = example("four_bar").replaceAll('"coupler"', JSON.stringify(name)),
      page = await open(made("sketch", text).page);
    const svg = (
      await record(page, "svg", { width: 800, height: 500, names: true }, { from: 0.7 })
    ).toString();
    const told = await page.evaluate((source) => {
      const root = new DOMParser().parseFromString(source, "image/svg+xml").documentElement,
        number = (e, key) => Number(e.getAttribute(key));
      return {
        name: root.nodeName,
        pins: [...root.querySelectorAll("circle")].map((e) => [number(e, "cx"), number(e, "cy")]),
        links: [...root.querySelectorAll("path")].filter((e) =>
          /^#(0072b2|e69f00|009e73)$/.test(e.getAttribute("stroke")),
        ).length,
        names: [...root.querySelectorAll("text")].map((e) => e.textContent),
      };
    }, svg);
    assert.equal(told.name, "svg");
    assert.ok(told.names.includes(name), `${told.names}`);
    assert.equal(told.links, 3);
    // Distances of pins as in the mechanism, at this instant: all one scale.
    const run = await page.evaluate(() => JSON.parse(document.querySelector("script.run").textContent)),
      poses = await page.evaluate(() => livensReport.poses(0.7));
    const pins = run.joints
      .filter((j) => j.type === "revolute")
      .map(({ second: b, point_second: p }) =>
        [0, 1, 2].map(
          (i) =>
            poses[12 * b + i] + [0, 1, 2].reduce((sum, k) => sum + poses[12 * b + 3 + 3 * k + i] * p[k], 0),
        ),
      );
    assert.equal(told.pins.length, pins.length);
    const apart = (all) =>
      all.flatMap((p, i) => all.slice(0, i).map((q) => Math.hypot(...p.map((x, k) => x - q[k]))));
    const scales = apart(told.pins).map((d, i) => d / apart(pins)[i]);
    assert.ok(Math.max(...scales) / Math.min(...scales) < 1.001, `${scales}`);
    for (const [x, y] of told.pins) assert.ok(x > 0 && x < 800 && y > 0 && y < 500);
    // From a side a hinge is no circle; another instant is another sketch.
    const top = (
      await record(page, "svg", { width: 800, height: 500, side: "top" }, { from: 0.7 })
    ).toString();
    assert.ok(!/<circle/.test(top) && /<rect x/.test(top));
    assert.notEqual(
      (await record(page, "svg", { width: 800, height: 500, names: true }, { from: 1.7 })).toString(),
      svg,
    );
    assert.deepEqual(page.problems, []);
  },

  async "the dialog saves, says what is wrong, and stops"() {
    const { page: file } = made("four_bar", example("four_bar")),
      page = await open(file);
    const saved = async () => {
      const waits = page.waitForEvent("download", { timeout: 120000 });
      await page.click("#save-go");
      const download = await waits;
      return [download.suggestedFilename(), readFileSync(await download.path())];
    };
    const choose = (kind) => page.locator(`#save input[value=${kind}]`).check({ force: true });
    const own = async (width, height) => {
      await page.selectOption("#save-size", "other");
      await page.fill("#save-width", String(width));
      await page.fill("#save-height", String(height));
    };
    await page.evaluate(() => livensReport.setTime(0.7));
    await page.click("#save-open");
    await page.uncheck("#save-names");
    await own(321, 203);
    let [name, bytes] = await saved();
    assert.equal(name, "four_bar_0.700s.png");
    assert.ok(bytes.equals(await record(page, "png", {}, { from: 0.7 })));
    assert.equal(await page.locator("#save[open]").count(), 0, "the dialog is gone");

    await page.click("#save-open");
    await choose("gif");
    await own(160, 100);
    await page.fill("#save-from", "0.5");
    await page.fill("#save-to", "0.25");
    assert.match(await page.textContent("#save-told"), /end must be after the start/);
    assert.ok(await page.isDisabled("#save-go"));
    await page.fill("#save-to", "0.9");
    assert.match(await page.textContent("#save-told"), /^9 frames, 0\.45 s long/);
    [name, bytes] = await saved();
    assert.equal(name, "four_bar.gif");
    assert.equal(read_gif(bytes).parts.length, 9);

    await page.click("#save-open");
    await choose("webm");
    await page.fill("#save-to", "5");
    await page.selectOption("#save-speed", "0.001");
    assert.match(await page.textContent("#save-told"), /more than 20000/);
    await page.selectOption("#save-speed", "0.1");
    let downloads = 0;
    page.on("download", () => ++downloads);
    await page.click("#save-go");
    await page.waitForFunction(() => document.querySelector("#save progress").value > 0);
    await page.click("#save-stop");
    await page.waitForFunction(() => document.querySelector("#save progress").hidden);
    assert.match(await page.textContent("#save-told"), /frames,/, "as before");
    await page.keyboard.press("Escape");
    assert.equal(await page.locator("#save[open]").count(), 0);
    assert.equal(downloads, 0);
    await page.keyboard.press("2");
    assert.ok(await page.isVisible("#quality"), "keys are the page's again");
    assert.deepEqual(page.problems, []);
  },
};

await run(tests);
