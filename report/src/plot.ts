// SPDX-License-Identifier: BSD-3-Clause
// Plots over time that are linked: the instant shown, what is zoomed into. Curves are made again for what is seen.
import uPlot from "uplot";
import { element, number, seconds, steady } from "./text";
import { colour, theme } from "./theme";
import type { Timeline } from "./timeline";

/** A series is a function of time, or values at given times. */
export interface Drawn {
  label: string;
  colour: number;
  at?(t: number): number;
  values?: ArrayLike<number>;
}
export interface PlotOptions {
  title: string;
  unit: string;
  series: Drawn[];
  times?: ArrayLike<number>; // of all `values`
  log?: boolean;
  bound?: { value: number; label: string }; // a level line
  mark?: { t: number; label: string }; // an upright line
  height?: number;
  remove?: () => void;
}

const samples = 900;
const font = "11px system-ui, sans-serif";

export class Plot {
  readonly box: HTMLElement;
  private readonly u: uPlot;
  private readonly line = element("div", { class: "now" });
  private readonly values: HTMLElement[] = [];

  constructor(
    host: HTMLElement,
    private readonly o: PlotOptions,
    private readonly time: Timeline,
  ) {
    const keys = element("p", { class: "keys" });
    o.series.forEach((s) => {
      const value = element("output", { "aria-live": "off" });
      const swatch = element("i", {});
      swatch.style.background = colour(s.colour);
      const is_said = o.series.length === 1 && o.title.endsWith(s.label);
      keys.append(
        element("span", {}, swatch, is_said ? null : element("b", { title: s.label }, s.label), value),
      );
      this.values.push(value);
    });
    const title = element(
      "span",
      {},
      o.title,
      element(
        "small",
        {},
        o.unit === ""
          ? ""
          : ` ${o.unit.replace(/ s-(\d)/, (_, n: string) => `/s${n === "1" ? "" : "\u00b2"}`)}`,
      ),
    );
    const close =
      o.remove &&
      element(
        "button",
        { class: "remove", "aria-label": `remove the plot: ${o.title}`, title: "remove this plot" },
        "\u00d7",
      );
    if (close) close.addEventListener("click", o.remove!);
    const area = element("div", { class: "area", role: "img", "aria-label": this.described() });
    this.box = element("figure", {}, element("figcaption", {}, title, close), area, keys);
    host.append(this.box);
    this.u = new uPlot(this.options(area.clientWidth || 400), this.data(), area);
    this.u.over.append(this.line);
    this.u.over.addEventListener("click", (e) => {
      if (this.u.select.width === 0) this.time.set(this.u.posToVal(e.offsetX, "x"));
    });
    this.u.over.addEventListener("dblclick", () => this.time.zoom(null));
    this.show(time.now);
  }

  private described() {
    const { title, unit, series } = this.o,
      [from, to] = [this.time.start, this.time.end];
    const parts = series.slice(0, 4).map((s) => {
      let low = Infinity,
        high = -Infinity;
      const see = (v: number) => {
        if (Number.isFinite(v)) {
          low = Math.min(low, v);
          high = Math.max(high, v);
        }
      };
      if (s.at) for (let k = 0; k <= 60; ++k) see(s.at(from + (k / 60) * (to - from)));
      else for (let k = 0; k < s.values!.length; ++k) see(s.values![k]);
      return `${s.label} from ${number(low, 3)} to ${number(high, 3)}`;
    });
    return `${title}${unit ? `, ${unit}` : ""}, over time: ${parts.join("; ")}`;
  }

  private data(): uPlot.AlignedData {
    const { series, times, log } = this.o,
      [from, to] = this.time.range;
    const shown = (v: number) => (Number.isFinite(v) && !(log && v <= 0) ? v : null);
    if (times) return [Array.from(times), ...series.map((s) => Array.from(s.values!, shown))];
    const x = Array.from({ length: samples + 1 }, (_, k) => from + (k / samples) * (to - from));
    return [
      x,
      ...series.map((s) =>
        x.map((t) => shown(s.at!(t <= this.time.end ? Math.max(t, this.time.start) : this.time.end))),
      ),
    ];
  }

  private options(width: number): uPlot.Options {
    const { o } = this,
      stroke = () => theme().soft,
      grid = { stroke: () => theme().line, width: 1 };
    const axis = { stroke, grid, ticks: { ...grid, size: 4 }, font };
    const tens: uPlot.Scale.Range = (_, low, high) => {
      const all = [low, high, o.bound?.value ?? NaN].filter((v) => Number.isFinite(v) && v > 0);
      if (all.length === 0) return [1e-17, 1e-15];
      const least = Math.floor(Math.log10(Math.min(...all))),
        most = Math.ceil(Math.log10(Math.max(...all)));
      return [10 ** least, 10 ** Math.max(most, least + 1)];
    };
    return {
      width,
      height: o.height ?? 148,
      legend: { show: false },
      padding: [6, 10, 0, 0],
      cursor: {
        drag: { x: true, y: false, setScale: false },
        points: { show: false },
        y: false,
        sync: { key: "livens" },
        bind: { dblclick: () => null },
      },
      scales: {
        x: { time: false, auto: false, range: () => this.time.range },
        y: o.log ? { distr: 3, range: tens } : { range: (_, low, high) => padded(low, high) },
      },
      axes: [
        { ...axis, size: 26, values: (_, ticks) => ticks.map((v) => number(v, 6)) },
        {
          ...axis,
          size: 58,
          space: 26,
          ...(o.log && { splits: decades, filter: (_u: uPlot, splits: number[]) => splits }),
          values: (_, ticks) => ticks.map((v) => (v === null ? "" : o.log ? power(v) : number(v, 5))),
        },
      ],
      series: [
        {},
        ...o.series.map(
          (s): uPlot.Series => ({
            label: s.label,
            stroke: () => colour(s.colour),
            width: 1.6,
            points: { show: false },
            pxAlign: 0, // steep curves are no stairs
            spanGaps: true,
          }),
        ),
      ],
      hooks: {
        draw: [(u) => this.lines(u)],
        setSelect: [
          (u) => {
            if (u.select.width < 4) return;
            const range: [number, number] = [
              u.posToVal(u.select.left, "x"),
              u.posToVal(u.select.left + u.select.width, "x"),
            ];
            u.setSelect({ left: 0, top: 0, width: 0, height: 0 }, false);
            this.time.zoom(range);
          },
        ],
      },
    };
  }

  /** Bounds and marks. */
  private lines(u: uPlot) {
    const { bound, mark } = this.o,
      c = u.ctx,
      { left, top, width, height } = u.bbox,
      ratio = devicePixelRatio;
    c.save();
    c.beginPath();
    c.rect(left, top, width, height);
    c.clip();
    c.strokeStyle = c.fillStyle = theme().bad;
    c.lineWidth = 1.5 * ratio;
    c.setLineDash([6 * ratio, 4 * ratio]);
    c.font = `${11 * ratio}px system-ui, sans-serif`;
    const draw = (x0: number, y0: number, x1: number, y1: number) => {
      c.beginPath();
      c.moveTo(x0, y0);
      c.lineTo(x1, y1);
      c.stroke();
    };
    if (bound) {
      const y = u.valToPos(bound.value, "y", true);
      draw(left, y, left + width, y);
      const x = left + width - 4 * ratio,
        base = y + (y < top + 20 * ratio ? 13 : -4) * ratio,
        wide = c.measureText(bound.label).width;
      c.textAlign = "right";
      c.fillStyle = theme().card; // over curves
      c.fillRect(x - wide - 3 * ratio, base - 10 * ratio, wide + 6 * ratio, 13 * ratio);
      c.fillStyle = theme().bad;
      c.fillText(bound.label, x, base);
    }
    if (mark) {
      const x = u.valToPos(mark.t, "x", true);
      draw(x, top, x, top + height);
      c.textAlign = x > left + width / 2 ? "right" : "left";
      c.fillText(mark.label, x + (x > left + width / 2 ? -4 : 4) * ratio, top + 12 * ratio);
    }
    c.restore();
  }

  zoom() {
    this.u.setData(this.data());
    this.show(this.time.now);
  }
  resize() {
    const width = (this.u.root.parentElement as HTMLElement).clientWidth;
    if (width > 0 && width !== this.u.width) this.u.setSize({ width, height: this.o.height ?? 148 });
    this.show(this.time.now);
  }
  /** For paper, which nothing tells the width of. */
  set_width(width: number) {
    this.u.setSize({ width, height: this.o.height ?? 148 });
  }
  recolour() {
    this.u.redraw();
    this.box.querySelectorAll<HTMLElement>(".keys i").forEach((swatch, i) => {
      swatch.style.background = colour(this.o.series[i].colour);
    });
  }
  show(t: number) {
    const [from, to] = this.time.range,
      share = (t - from) / (to - from);
    this.line.style.left = `${100 * share}%`;
    this.line.hidden = !(share >= -1e-9 && share <= 1 + 1e-9);
    this.o.series.forEach((s, i) => {
      const v = s.at ? s.at(t) : s.values![near(this.o.times!, t)];
      this.values[i].textContent = this.o.log ? number(v, 2) : s.at ? steady(v) : number(v);
    });
  }
  destroy() {
    this.u.destroy();
    this.box.remove();
  }
}

/** The first of ascending times that is not before t. */
function near(times: ArrayLike<number>, t: number) {
  let low = 0,
    high = times.length - 1;
  while (low < high) {
    const middle = (low + high) >> 1;
    if (times[middle] < t) low = middle + 1;
    else high = middle;
  }
  return low;
}
/** Powers of ten, some seven of them. */
function decades(_: uPlot, __: number, low: number, high: number) {
  const from = Math.round(Math.log10(low)),
    to = Math.round(Math.log10(high)),
    step = Math.max(1, Math.ceil((to - from) / 7));
  return Array.from(
    { length: Math.floor((to - from) / step) + 1 },
    (_unused, k) => 10 ** (to - k * step),
  ).reverse();
}
/** Rounding is no signal: a constant is shown as one. */
function padded(low: number | null, high: number | null): [number, number] {
  if (low === null || high === null) return [-1, 1];
  const middle = (low + high) / 2,
    half = Math.max((high - low) / 2, 1e-6 * Math.abs(middle), 1e-12);
  return [middle - 1.12 * half, middle + 1.12 * half];
}
const digits = "\u2070\u00b9\u00b2\u00b3\u2074\u2075\u2076\u2077\u2078\u2079";
function power(v: number) {
  const e = Math.round(Math.log10(v));
  if (Math.abs(v / 10 ** e - 1) > 1e-6) return "";
  return "10" + (e < 0 ? "\u207b" : "") + [...String(Math.abs(e))].map((d) => digits[Number(d)]).join("");
}
export const at_time = (t: number, span: number) => `${seconds(t, span)} s`;
