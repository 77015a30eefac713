// SPDX-License-Identifier: BSD-3-Clause
// One quantity against another: phase portraits, paths of points. Both axes are as long for a metre, where both are lengths.
import { framed, heading, sheet, type Columns, type Figure } from "./figure";
import { padded, ticks } from "./scales";
import { element, number, shortened, steady } from "./text";
import { colour, theme } from "./theme";
import type { Timeline } from "./timeline";
import { shown_in } from "./units";

export interface Quantity {
  label: string;
  unit: string;
  at(t: number): number;
}
export interface PhaseOptions {
  title: string;
  x: Quantity;
  y: Quantity;
  elements: number; // of time, in the whole run
  remove?: () => void;
}

const samples = 1500;
const of_an_element = 12; // samples
const most_samples = 30_000;
const near_enough = 30; // px, from a click
const axis = { left: 76, below: 44, above: 8, right: 14 }; // px around the curve

/** Pixels of values. */
interface Frame {
  x(v: number): number;
  y(v: number): number;
  left: number;
  top: number;
  right: number;
  bottom: number;
  low: [number, number];
  high: [number, number];
}

export class Phase implements Figure {
  readonly box: HTMLElement;
  private readonly canvas = element("canvas");
  private readonly dot = element("div", { class: "dot" });
  private readonly area: HTMLElement;
  private readonly values = [
    element("output", { "aria-live": "off" }),
    element("output", { "aria-live": "off" }),
  ];
  private readonly curve = { t: [] as number[], x: [] as number[], y: [] as number[] };
  private width = 400;

  constructor(
    host: HTMLElement,
    private readonly o: PhaseOptions,
    private readonly time: Timeline,
  ) {
    const { title, remove, x, y } = o;
    const head = heading(
      { title, remove, picture: () => this.picture(), table: () => this.table() },
      element("small"),
    );
    this.area = element(
      "div",
      { class: "area phase", role: "img", "aria-label": `${title}: ${y.label} over ${x.label}` },
      this.canvas,
      this.dot,
    );
    const keys = element(
      "p",
      { class: "keys" },
      ...[x, y].map(({ label }, i) =>
        element("span", {}, element("b", { title: label }, i ? "\u2191" : "\u2192"), this.values[i]),
      ),
    );
    this.box = element("figure", {}, head, this.area, keys);
    host.append(this.box);
    this.area.addEventListener("click", (e) => this.pick(e));
    this.sample();
    this.resize();
  }

  private get height() {
    return Math.round(this.is_even ? Math.min(300, 0.75 * this.width) : 240);
  }
  /** Both are lengths, or both are of one kind of angle. */
  private get is_even() {
    return this.o.x.unit === this.o.y.unit && ["m", "rad"].includes(this.o.x.unit);
  }

  private sample() {
    const { x, y, elements } = this.o,
      { start, end, range, span } = this.time,
      from = Math.max(range[0], start),
      to = Math.min(range[1], end),
      share = span > 0 ? (to - from) / span : 0,
      n = Math.min(most_samples, Math.max(samples, Math.ceil(of_an_element * elements * share))),
      t = Array.from({ length: n + 1 }, (_, k) => from + (k / n) * (to - from)),
      [of_x, of_y] = [x, y].map(({ unit }) => shown_in(unit).factor);
    this.curve.t = t;
    this.curve.x = t.map((at) => of_x * x.at(at));
    this.curve.y = t.map((at) => of_y * y.at(at));
  }

  private frame(width: number, height: number, scale: number): Frame {
    const left = axis.left * scale,
      top = axis.above * scale,
      right = width - axis.right * scale,
      bottom = height - axis.below * scale;
    const limits = (values: number[]) => {
      let low: number | null = null,
        high: number | null = null;
      for (const v of values)
        if (Number.isFinite(v)) {
          low = Math.min(low ?? v, v);
          high = Math.max(high ?? v, v);
        }
      return padded(low, high);
    };
    let [x0, x1] = limits(this.curve.x),
      [y0, y1] = limits(this.curve.y);
    if (this.is_even) {
      const of_pixel = Math.max((x1 - x0) / (right - left), (y1 - y0) / (bottom - top)),
        half_x = (of_pixel * (right - left)) / 2,
        half_y = (of_pixel * (bottom - top)) / 2,
        [mx, my] = [(x0 + x1) / 2, (y0 + y1) / 2];
      [x0, x1, y0, y1] = [mx - half_x, mx + half_x, my - half_y, my + half_y];
    }
    return {
      x: (v) => left + ((v - x0) / (x1 - x0)) * (right - left),
      y: (v) => bottom - ((v - y0) / (y1 - y0)) * (bottom - top),
      left,
      top,
      right,
      bottom,
      low: [x0, y0],
      high: [x1, y1],
    };
  }

  private axes(c: CanvasRenderingContext2D, f: Frame, scale: number) {
    const { low, high, left, right, top, bottom } = f;
    c.font = `${11 * scale}px system-ui, sans-serif`;
    c.lineWidth = scale;
    c.strokeStyle = theme().line;
    c.fillStyle = theme().soft;
    const line = (x0: number, y0: number, x1: number, y1: number) => {
      c.beginPath();
      c.moveTo(x0, y0);
      c.lineTo(x1, y1);
      c.stroke();
    };
    const said = (v: number, size: number) => number(Math.abs(v) < 1e-9 * size ? 0 : v, 5);
    c.textAlign = "center";
    for (const v of ticks(low[0], high[0], (right - left) / (70 * scale))) {
      line(f.x(v), top, f.x(v), bottom);
      c.fillText(said(v, high[0] - low[0]), f.x(v), bottom + 14 * scale);
    }
    c.textAlign = "right";
    for (const v of ticks(low[1], high[1], (bottom - top) / (30 * scale))) {
      line(left, f.y(v), right, f.y(v));
      c.fillText(said(v, high[1] - low[1]), left - 6 * scale, f.y(v) + 4 * scale);
    }
    c.textAlign = "center";
    const [name_x, name_y] = [this.o.x, this.o.y].map(named);
    c.fillText(shortened(c, name_x, right - left), (left + right) / 2, bottom + 32 * scale);
    c.save();
    c.translate(13 * scale, (top + bottom) / 2);
    c.rotate(-Math.PI / 2);
    c.fillText(shortened(c, name_y, bottom - top), 0, 0);
    c.restore();
  }

  private draw(c: CanvasRenderingContext2D, f: Frame, scale: number) {
    const { t, x, y } = this.curve;
    this.axes(c, f, scale);
    c.save();
    c.beginPath();
    c.rect(f.left, f.top, f.right - f.left, f.bottom - f.top);
    c.clip();
    c.strokeStyle = colour(0);
    c.lineJoin = "round";
    c.lineWidth = 1.6 * scale;
    c.beginPath();
    let is_on = false;
    for (let k = 0; k < t.length; ++k) {
      const is_there = Number.isFinite(x[k]) && Number.isFinite(y[k]);
      if (is_there) (is_on ? c.lineTo : c.moveTo).call(c, f.x(x[k]), f.y(y[k]));
      is_on = is_there;
    }
    c.stroke();
    c.restore();
  }

  private seen = { frame: null as Frame | null };
  private redraw() {
    const ratio = devicePixelRatio,
      { width, height, canvas } = this;
    canvas.width = Math.round(width * ratio);
    canvas.height = Math.round(height * ratio);
    canvas.style.width = `${width}px`;
    canvas.style.height = `${height}px`;
    const f = this.frame(canvas.width, canvas.height, ratio);
    this.seen.frame = f;
    this.draw(canvas.getContext("2d")!, f, ratio);
    this.show(this.time.now);
  }

  private pick(e: MouseEvent) {
    const f = this.seen.frame,
      ratio = devicePixelRatio,
      { t, x, y } = this.curve,
      box = this.canvas.getBoundingClientRect(),
      at = [(e.clientX - box.left) * ratio, (e.clientY - box.top) * ratio];
    if (!f) return;
    let best = -1,
      least = near_enough * ratio;
    for (let k = 0; k < t.length; ++k) {
      const d = Math.hypot(f.x(x[k]) - at[0], f.y(y[k]) - at[1]);
      if (d < least) [best, least] = [k, d];
    }
    if (best >= 0) this.time.set(t[best]);
  }

  private table(): Columns {
    const { t, x, y } = this.curve;
    return { head: ["t [s]", ...[this.o.x, this.o.y].map((q) => with_unit(q))], columns: [t, x, y] };
  }
  private picture(): Promise<HTMLCanvasElement> {
    const { width, height, scale } = sheet,
      plain = element("canvas", { width: String(width), height: String(height) });
    this.draw(plain.getContext("2d")!, this.frame(width, height, scale), scale);
    return Promise.resolve(framed(plain, height, this.o.title, "", [], theme()));
  }

  show(t: number) {
    const { x, y } = this.o,
      f = this.seen.frame,
      ratio = devicePixelRatio,
      now = [x, y].map((q) => shown_in(q.unit).factor * q.at(t));
    now.forEach((v, i) => {
      this.values[i].textContent = `${steady(v)} ${shown_in([x, y][i].unit).unit}`;
    });
    const is_seen = f !== null && now.every(Number.isFinite);
    this.dot.hidden = !is_seen;
    if (is_seen) this.dot.style.transform = `translate(${f.x(now[0]) / ratio}px, ${f.y(now[1]) / ratio}px)`;
  }
  zoom() {
    this.sample();
    this.redraw();
  }
  resize() {
    const width = this.area.clientWidth;
    if (width > 0) this.width = width;
    this.redraw();
  }
  set_width(width: number) {
    this.width = width;
    this.redraw();
  }
  recolour() {
    this.redraw();
  }
  destroy() {
    this.box.remove();
  }
}

function with_unit({ label, unit }: Quantity) {
  const shown = shown_in(unit).unit;
  return shown ? `${label} [${shown}]` : label;
}
function named({ label, unit }: Quantity) {
  const shown = shown_in(unit).unit;
  return shown ? `${label} (${shown})` : label;
}
