// SPDX-License-Identifier: BSD-3-Clause
// Plots over time that are linked: the instant shown, what is zoomed into. Curves are made again for what is seen.
import uPlot from "uplot";
import { framed, heading, sheet, type Columns, type Figure } from "./figure";
import { element_of } from "./motion";
import { decades, near, padded, power } from "./scales";
import { element, number, steady } from "./text";
import { colour, theme } from "./theme";
import type { Timeline } from "./timeline";
import { shown_in } from "./units";

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
  hidden?: string[]; // names of lines
  grain?: Grain;
  remove?: () => void;
}
/** What a motion is resolved by. */
export interface Grain {
  ends: ArrayLike<number>; // of time elements
  of_each: number; // instants that show all of an element
}

const columns = 900; // of a plot
const most_of_column = 100; // instants
const usual_height = 148; // px
const font = (scale: number) => `${11 * scale}px system-ui, sans-serif`;

/** The least and the largest of a column, the earlier one first; what is no number is left out. */
function extremes(values: (number | null)[]): (number | null)[] {
  let low = -1,
    high = -1;
  values.forEach((v, i) => {
    if (v === null) return;
    if (low < 0 || v < values[low]!) low = i;
    if (high < 0 || v > values[high]!) high = i;
  });
  if (low < 0) return [null, null];
  return low < high ? [values[low], values[high]] : [values[high], values[low]];
}
function reach_of(values: ArrayLike<number | null | undefined>): [number, number] {
  let low = Infinity,
    high = -Infinity;
  for (let k = 0; k < values.length; ++k) {
    const v = values[k];
    if (v == null) continue;
    low = Math.min(low, v);
    high = Math.max(high, v);
  }
  return [low, high];
}

export class Plot implements Figure {
  readonly box: HTMLElement;
  private readonly u: uPlot;
  private readonly line = element("div", { class: "now" });
  private readonly values: HTMLElement[] = [];
  private readonly unit = element("small");
  private readonly is_seen: boolean[];

  constructor(
    host: HTMLElement,
    private readonly o: PlotOptions,
    private readonly time: Timeline,
  ) {
    this.is_seen = o.series.map(({ label }) => !o.hidden?.includes(label));
    const keys = element("p", { class: "keys" }, ...o.series.map((_, i) => this.key(i)));
    this.write_unit();
    const { title, remove } = o;
    const head = heading(
      { title, remove, picture: () => this.picture(), table: () => this.table() },
      this.unit,
    );
    const data = this.data(),
      area = element("div", { class: "area", role: "img", "aria-label": this.described(data) });
    this.box = element("figure", {}, head, area, keys);
    host.append(this.box);
    this.u = new uPlot(this.options(area.clientWidth || 400), data, area);
    this.u.over.append(this.line);
    this.u.over.addEventListener("click", (e) => {
      if (this.u.select.width === 0) this.time.set(this.u.posToVal(e.offsetX, "x"));
    });
    this.u.over.addEventListener("dblclick", () => this.time.zoom(null));
    this.show(time.now);
  }

  /** The name of a line with its value; where there are more, a button that hides the line. */
  private key(i: number): HTMLElement {
    const { series, title } = this.o,
      s = series[i],
      swatch = element("i", {}),
      value = element("output", { "aria-live": "off" });
    swatch.style.background = colour(s.colour);
    this.values.push(value);
    if (series.length === 1)
      return element(
        "span",
        {},
        swatch,
        title.endsWith(s.label) ? null : element("b", { title: s.label }, s.label),
        value,
      );
    const button = element(
      "button",
      {
        "aria-pressed": String(this.is_seen[i]),
        "aria-label": `show ${s.label} in ${title}`,
        title: `${s.label}: hide or show`,
      },
      swatch,
      element("b", {}, s.label),
    );
    button.addEventListener("click", () => {
      const is_seen = (this.is_seen[i] = !this.is_seen[i]);
      button.setAttribute("aria-pressed", String(is_seen));
      this.u.setSeries(i + 1, { show: is_seen });
    });
    return element("span", {}, button, value);
  }
  get hidden(): string[] {
    return this.o.series.filter((_, i) => !this.is_seen[i]).map(({ label }) => label);
  }
  private write_unit() {
    const { unit } = shown_in(this.o.unit);
    this.unit.textContent = unit && ` ${unit}`;
  }

  private described([, ...lines]: uPlot.AlignedData) {
    const { title, series } = this.o,
      { unit } = shown_in(this.o.unit);
    const parts = series.slice(0, 4).map(({ label }, i) => {
      const [low, high] = reach_of(lines[i]);
      return `${label} from ${number(low, 3)} to ${number(high, 3)}`;
    });
    return `${title}${unit ? `, ${unit}` : ""}, over time: ${parts.join("; ")}`;
  }

  /** The instants of each column that is seen: its first, or as many as show all that happens in it. */
  private instants(): number[][] {
    const [from, to] = this.time.range,
      width = (to - from) / columns,
      { grain } = this.o;
    const between = (a: number, b: number) =>
      grain ? (element_of(grain.ends, b) - element_of(grain.ends, a)) * grain.of_each : 0;
    const is_dense = between(from, to) > columns;
    return Array.from({ length: columns }, (_, k) => {
      const t = from + k * width,
        n = is_dense ? Math.min(Math.max(between(t, t + width), 1), most_of_column) : 1;
      return Array.from({ length: n }, (_unused, i) => t + (i / n) * width);
    });
  }
  private value(s: Drawn, t: number): number | null {
    const { factor } = shown_in(this.o.unit),
      v = s.at!(t <= this.time.end ? Math.max(t, this.time.start) : this.time.end);
    return Number.isFinite(v) && !(this.o.log && v <= 0) ? factor * v : null;
  }

  /** What is drawn: of a column with many instants, the least and the largest value, in their order. */
  private data(): uPlot.AlignedData {
    const { series, times, log } = this.o,
      { factor } = shown_in(this.o.unit),
      to = this.time.range[1];
    const shown = (v: number) => (Number.isFinite(v) && !(log && v <= 0) ? factor * v : null);
    if (times) return [Array.from(times), ...series.map((s) => Array.from(s.values!, shown))];
    const all = this.instants(),
      beside = (all[1][0] - all[0][0]) / 4;
    const x = all.flatMap((t) => (t.length === 1 ? t : [t[0] + beside, t[0] + 3 * beside]));
    return [
      [...x, to],
      ...series.map((s) => [
        ...all.flatMap((t) =>
          t.length === 1 ? [this.value(s, t[0])] : extremes(t.map((at) => this.value(s, at))),
        ),
        this.value(s, to),
      ]),
    ];
  }

  /** `scale`: of everything that is written and drawn. */
  private options(width: number, height = this.o.height ?? usual_height, scale = 1): uPlot.Options {
    const { o } = this,
      stroke = () => theme().soft,
      grid = { stroke: () => theme().line, width: scale };
    const axis = { stroke, grid, ticks: { ...grid, size: 4 * scale }, font: font(scale), gap: 5 * scale };
    const tens: uPlot.Scale.Range = (_, low, high) => {
      const all = [low, high, o.bound?.value ?? NaN].filter((v) => Number.isFinite(v) && v > 0);
      if (all.length === 0) return [1e-17, 1e-15];
      const least = Math.floor(Math.log10(Math.min(...all))),
        most = Math.ceil(Math.log10(Math.max(...all)));
      return [10 ** least, 10 ** Math.max(most, least + 1)];
    };
    return {
      width,
      height,
      legend: { show: false },
      padding: [6 * scale, 18 * scale, 0, 0],
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
        {
          ...axis,
          size: 26 * scale,
          space: 50 * scale,
          values: (_, ticks) => ticks.map((v) => number(v, 6)),
        },
        {
          ...axis,
          size: 58 * scale,
          space: 26 * scale,
          ...(o.log && { splits: decades, filter: (_u: uPlot, splits: number[]) => splits }),
          values: (_, ticks) => ticks.map((v) => (v === null ? "" : o.log ? power(v) : number(v, 5))),
        },
      ],
      series: [
        {},
        ...o.series.map(
          (s, i): uPlot.Series => ({
            label: s.label,
            show: this.is_seen[i],
            stroke: () => colour(s.colour),
            width: 1.6 * scale,
            points: { show: false },
            pxAlign: 0, // steep curves are no stairs
            spanGaps: true,
          }),
        ),
      ],
      hooks: {
        draw: [(u) => this.lines(u, scale)],
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
  private lines(u: uPlot, scale: number) {
    const { bound, mark } = this.o,
      c = u.ctx,
      { left, top, width, height } = u.bbox,
      ratio = devicePixelRatio * scale;
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

  /** What is seen of the plot: its time and its lines, at every instant that was looked at. */
  private table(): Columns {
    const { unit } = shown_in(this.o.unit),
      { series, times } = this.o,
      [from, to] = this.time.range,
      x = times ? Array.from(times) : [...this.instants().flat(), to],
      all = times ? this.data().slice(1) : series.map((s) => x.map((t) => this.value(s, t)));
    const in_sight = (column: ArrayLike<number | null | undefined>) =>
      Array.from(column, (v) => v ?? NaN).filter((_, k) => x[k] >= from && x[k] <= to);
    const lines = this.o.series.flatMap((s, i) =>
      this.is_seen[i] ? [{ head: unit ? `${s.label} [${unit}]` : s.label, values: in_sight(all[i]) }] : [],
    );
    return {
      head: ["t [s]", ...lines.map(({ head }) => head)],
      columns: [in_sight(x), ...lines.map(({ values }) => values)],
    };
  }
  /** Drawn anew, as large as slides want it. */
  private async picture(): Promise<HTMLCanvasElement> {
    const { width, height, scale } = sheet,
      host = element("div"),
      ratio = devicePixelRatio,
      options = this.options(width / ratio, height / ratio, scale / ratio);
    const is_drawn = new Promise<void>((done) => options.hooks!.draw!.push(() => done()));
    const plot = new uPlot(options, this.data(), host);
    await is_drawn;
    const keys = this.o.series.flatMap((s, i) =>
      this.is_seen[i] ? [{ label: s.label, colour: colour(s.colour) }] : [],
    );
    const made = framed(plot.ctx.canvas, height, this.o.title, shown_in(this.o.unit).unit, keys, theme());
    plot.destroy();
    return made;
  }

  zoom() {
    this.write_unit();
    this.u.setData(this.data());
    this.show(this.time.now);
  }
  resize() {
    const width = (this.u.root.parentElement as HTMLElement).clientWidth;
    if (width > 0 && width !== this.u.width) this.u.setSize({ width, height: this.o.height ?? usual_height });
    this.show(this.time.now);
  }
  set_width(width: number) {
    this.u.setSize({ width, height: this.o.height ?? usual_height });
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
    const { factor } = shown_in(this.o.unit);
    this.o.series.forEach((s, i) => {
      const v = factor * (s.at ? s.at(t) : s.values![near(this.o.times!, t)]);
      this.values[i].textContent = this.o.log ? number(v, 2) : s.at ? steady(v) : number(v);
    });
  }
  destroy() {
    this.u.destroy();
    this.box.remove();
  }
}
