// SPDX-License-Identifier: BSD-3-Clause
// The report: reads what lies in the page and ties picture, plots, time, tabs and keys together.
import { build_about } from "./about";
import { Compare } from "./compare";
import { runs_of } from "./data";
import type { Figure } from "./figure";
import { follow } from "./live";
import { Picture, type Seen } from "./picture";
import { Playback } from "./playback";
import { PlotList, type Choices } from "./plot_list";
import { build_quality } from "./quality";
import { record, type Course, type Kind } from "./record";
import { Run } from "./run";
import { Save } from "./save";
import { Scrub } from "./scrub";
import type { Look } from "./studio";
import { Tabs, tab_names } from "./tabs";
import { by_id, element } from "./text";
import { dark_wanted, set_printing } from "./theme";
import { Timeline } from "./timeline";
import { on_angles } from "./units";
import { verdict_of } from "./verdict";

const half_of_a_page = 335; // px, of A4 and of letter

/** What somebody has chosen on this page, which a newer run takes over. */
interface Kept {
  seen: Seen;
  t: number;
  range: [number, number] | null; // null: everything
  is_playing: boolean;
  speed: string;
  choices: Choices;
  second: Run | null;
  tab: string;
  scrolled: number; // px, of the plots
  focus: string;
}

class Report {
  readonly time: Timeline;
  readonly picture: Picture;
  readonly playback: Playback;
  private readonly scrub: Scrub;
  private readonly list: PlotList;
  private readonly compare: Compare;
  private readonly tabs: Tabs;
  private readonly life = new AbortController();
  private quality: Figure[] | null = null;

  constructor(
    readonly run: Run,
    other: Run | null,
    kept: Kept | null = null,
  ) {
    const { motion } = run,
      { signal } = this.life;
    this.time = new Timeline(motion.start, motion.end);
    if (kept?.range) this.time.zoom(kept.range);
    if (kept) this.time.set(kept.t);
    say_verdict(run);
    this.picture = new Picture(run, this.time, signal, kept?.seen ?? null);
    this.list = new PlotList(run, this.time, kept?.choices ?? null);
    this.playback = new Playback(run, this.time);
    this.scrub = new Scrub(this.time, motion.ends, () => this.playback.stop(), run.meta.events);
    new Save(this.picture, this.time, this.playback, run.meta.name);
    const show = (second: Run | null) => this.picture.compare(second);
    this.compare = new Compare(by_id("compare"), run, this.time, show, signal);
    const { version } = JSON.parse(by_id("program").textContent ?? "{}") as { version: string };
    build_about(by_id("about"), run, version, notices());
    this.time.on_move((t) => {
      for (const plot of this.plots()) plot.show(t);
    });
    this.time.on_zoom(() => {
      for (const plot of this.plots()) plot.zoom();
    });
    on_angles(() => {
      this.compare.say();
      for (const plot of this.plots()) plot.zoom();
    }, signal);
    this.tabs = new Tabs((name) => {
      if (name === "quality") this.build_quality();
      this.layout();
    });
    if (other) this.compare.set(other);
    this.tabs.open(kept?.tab ?? "motion");
    this.listen(signal);
    if (kept) this.go_on(kept);
    else this.read_address();
  }

  /** As the page of another run was when it was left. */
  private go_on({ speed, is_playing, scrolled, focus }: Kept) {
    const select = by_id<HTMLSelectElement>("speed");
    if ([...select.options].some(({ value }) => value === speed)) select.value = speed;
    by_id("plots").scrollTop = scrolled;
    if (focus) by_id(focus)?.focus();
    if (is_playing) this.playback.play();
  }
  /** Leaves the page to a newer run. */
  close(): Kept {
    const { time, playback } = this,
      kept: Kept = {
        seen: this.picture.seen(),
        t: time.now,
        range: time.is_whole ? null : time.range,
        is_playing: playback.is_playing,
        speed: by_id<HTMLSelectElement>("speed").value,
        choices: this.list.chosen(),
        second: this.compare.second,
        tab: this.tabs.now,
        scrolled: by_id("plots").scrollTop,
        focus: document.activeElement?.id ?? "",
      };
    playback.stop();
    this.life.abort();
    for (const plot of this.plots()) plot.destroy();
    this.picture.close();
    return kept;
  }

  private plots(): Figure[] {
    return [...this.list.plots, ...(this.quality ?? []), ...this.compare.plots];
  }
  private build_quality() {
    this.quality ??= build_quality(by_id("quality"), this.run, this.time);
  }

  private layout() {
    this.picture.resize();
    this.scrub.draw_ruler();
    for (const plot of this.plots()) plot.resize();
    this.time.set(this.time.now);
  }
  private recolour() {
    for (const plot of this.plots()) plot.recolour();
  }

  private listen(signal: AbortSignal) {
    addEventListener("resize", () => this.layout(), { signal });
    addEventListener("keydown", (e) => this.press(e), { signal });
    addEventListener("hashchange", () => this.read_address(), { signal });
    const recoloured = () => {
      this.picture.build();
      this.recolour();
      this.layout();
    };
    dark_wanted.addEventListener("change", recoloured, { signal });
    const before_print = () => {
      set_printing(true); // paper is white
      by_id("quality").hidden = false;
      this.build_quality();
      this.recolour();
      for (const plot of this.plots()) plot.set_width(half_of_a_page);
      this.picture.print_stills(by_id("paper"));
    };
    addEventListener("beforeprint", before_print, { signal });
    const after_print = () => {
      set_printing(false);
      if (dark_wanted.matches) this.picture.build();
      this.recolour();
      this.tabs.open(this.tabs.now);
    };
    addEventListener("afterprint", after_print, { signal });
  }

  private press(e: KeyboardEvent) {
    const target = e.target as HTMLElement,
      { time, playback, scrub } = this;
    if (e.ctrlKey || e.metaKey || e.altKey || document.querySelector("dialog[open]")) return;
    if (target.matches("input, select, textarea, summary") && !scrub.is(target)) return;
    if (e.key === " " && target.matches("button")) return; // presses it
    const is_scrolling = /^(Home|End|Page)/.test(e.key) && by_id("motion").hidden;
    const step = (time.span / 500) * (e.shiftKey ? 10 : 1);
    const by_hand = (act: () => void) => () => {
      playback.stop();
      act();
    };
    const actions: Record<string, () => void> = {
      " ": () => playback.toggle(),
      ArrowLeft: by_hand(() => time.set(time.now - step)),
      ArrowRight: by_hand(() => time.set(time.now + step)),
      Home: by_hand(() => time.set(time.start)),
      End: by_hand(() => time.set(time.end)),
      PageUp: by_hand(() => scrub.step_element(-1)),
      PageDown: by_hand(() => scrub.step_element(1)),
      "+": () => time.zoom_by(0.5),
      "=": () => time.zoom_by(0.5),
      "-": () => time.zoom_by(2),
      "0": () => {
        time.zoom(null);
        this.picture.stage?.eye.fit_by_hand("fitted");
      },
    };
    tab_names.forEach((tab, i) => {
      actions[String(i + 1)] = () => this.tabs.open(tab);
    });
    if (!actions[e.key] || is_scrolling) return;
    e.preventDefault();
    actions[e.key]();
  }

  /** #t=1.62&tab=quality */
  private read_address() {
    const asked = new URLSearchParams(location.hash.slice(1)),
      t = Number(asked.get("t") ?? NaN),
      tab = asked.get("tab") ?? "";
    if (Number.isFinite(t)) this.time.set(t);
    if (tab_names.includes(tab)) this.tabs.open(tab);
  }
}

function say_verdict(run: Run) {
  const v = verdict_of(run);
  by_id("title").textContent = run.name;
  by_id("verdict").append(
    element("span", { class: `chip ${v.grade}` }, `${v.sign} ${v.word}`),
    element("strong", {}, v.lead),
    element("small", {}, v.rest),
    ...v.reasons.slice(0, 3).map((reason) => element("span", { class: "reason" }, reason)),
  );
}

/** A still or a moving picture as base64, for scripts: report/stills.mjs. */
async function made_of(picture: Picture, kind: Kind, look: Partial<Look>, course: Partial<Course>) {
  const screen = picture.screen(),
    { start, end } = screen.run.motion;
  const data = await record(
    kind,
    screen,
    { width: 1280, height: 720, scheme: null, is_clear: false, names: false, clock: false, ...look },
    { from: start, to: end, speed: 1, rate: 25, ...course },
  );
  const bytes = new Uint8Array(await data.arrayBuffer()),
    part = 0x8000;
  let text = "";
  for (let i = 0; i < bytes.length; i += part) text += String.fromCharCode(...bytes.subarray(i, i + part));
  return btoa(text);
}

/** What tests and scripts ask. */
function open_to_tests(report: Report, timings: Record<string, number>) {
  const { run, time, picture } = report,
    { motion } = run,
    X = new Float64Array(12 * motion.bodies);
  Object.assign(window, {
    livensReport: {
      setTime: (t: number) => time.set(t),
      now: () => time.now,
      isPlaying: () => report.playback.is_playing,
      range: () => time.range,
      poses: (t: number) => Array.from(motion.at(t, X)),
      bodies: run.meta.bodies.map((b) => b.name),
      curve: (kind: string, index: number, name: string, t: number) =>
        run.curves.at(run.channel(kind, index, name), t),
      camera: () => picture.stage?.eye.camera.position.toArray(),
      seen_bars: () => ({
        at_start: picture.stage?.bars_at(time.start),
        at_end: picture.stage?.bars_at(time.end),
      }),
      has_picture: picture.stage !== null,
      record: (kind: Kind, look: Partial<Look>, course: Partial<Course>) =>
        made_of(picture, kind, look, course),
      timings,
      /** Mean milliseconds of a frame, every one waited for, and draw calls of the last. */
      frames(n: number) {
        if (!picture.stage) return null;
        const { renderer } = picture.stage,
          gl = renderer.getContext(),
          pixel = new Uint8Array(4),
          begun = performance.now();
        for (let k = 0; k < n; ++k) {
          picture.stage.show(time.start + (k / n) * time.span);
          gl.readPixels(0, 0, 1, 1, gl.RGBA, gl.UNSIGNED_BYTE, pixel);
        }
        return { ms: (performance.now() - begun) / n, calls: renderer.info.render.calls };
      },
    },
  });
}

/** Of other people's work in the script, which stand at its head. */
function notices(): string {
  const scripts = [...document.querySelectorAll('script[type="module"]')]
    .map((s) => s.textContent)
    .join("\n");
  return /\/\*!([\s\S]*?)\*\//.exec(scripts)?.[1].trim() ?? "";
}

/** What a report fills, as it was before: a page that follows a program is filled again and again. */
const blank = ["header", "main", "footer", "#paper"].map((part) => {
  const found = document.querySelector(part)!;
  return { part, node: found.cloneNode(true) };
});
function clear() {
  for (const { part, node } of blank) document.querySelector(part)!.replaceWith(node.cloneNode(true));
  document.querySelector("dialog")?.remove();
}

async function start() {
  const begun = performance.now(),
    { live } = JSON.parse(by_id("program").textContent ?? "{}") as { live?: number },
    runs = (await runs_of(document)).map((data) => new Run(data)),
    unpacked = performance.now();
  let report = runs.length ? new Report(runs[0], runs[1] ?? null) : null;
  const ready = performance.now(),
    timings = {
      unpack_ms: unpacked - begun,
      build_ms: ready - unpacked,
      since_navigation_ms: ready,
    };
  if (report) open_to_tests(report, timings);
  document.body.classList.toggle("waiting", report === null);
  if (live === undefined) return;
  follow(live, (data) => {
    const run = new Run(data), // throws before anything is left
      kept = report?.close() ?? null;
    clear();
    document.body.classList.remove("waiting");
    document.title = `${run.name} \u00b7 livens`;
    report = new Report(run, kept?.second ?? null, kept);
    open_to_tests(report, timings);
  });
}

start().catch((error: unknown) => {
  const why = error instanceof Error ? error.message : String(error);
  by_id("verdict").append(
    element(
      "strong",
      { class: "bad" },
      `This page could not be shown: ${why}. It needs a browser of 2023 or later.`,
    ),
  );
  throw error;
});
