// SPDX-License-Identifier: BSD-3-Clause
// The tab that holds a second run against the first: by another file on the command line, or another report opened here.
import { runs_of } from "./data";
import { Plot } from "./plot";
import { Run } from "./run";
import { by_id, element, number, rough } from "./text";
import type { Timeline } from "./timeline";
import { shown_in } from "./units";
import { verdict_of } from "./verdict";

const looks = 600;

interface Pair {
  a: number;
  b: number;
  name: string;
  distance: Float64Array;
  angle: Float64Array;
  worst: number;
}

/** Bodies of one name, and how far they are apart over the time that both runs have. */
function pairs_of(first: Run, second: Run, times: Float64Array): Pair[] {
  const X = new Float64Array(12),
    Y = new Float64Array(12);
  const point = (P: Float64Array, c: number[], i: number) =>
    P[i] + P[3 + i] * c[0] + P[6 + i] * c[1] + P[9 + i] * c[2];
  const pairs = first.meta.bodies.flatMap((body, a) => {
    const b = second.meta.bodies.findIndex((other) => other.name === body.name);
    if (b < 0) return [];
    const distance = new Float64Array(times.length),
      angle = new Float64Array(times.length);
    times.forEach((t, k) => {
      first.motion.at(t, X, a, a + 1);
      second.motion.at(t, Y, b, b + 1);
      distance[k] = Math.hypot(
        ...[0, 1, 2].map((i) => point(X, body.centre, i) - point(Y, second.meta.bodies[b].centre, i)),
      );
      let sum = 0;
      for (let i = 3; i < 12; ++i) sum += (X[i] - Y[i]) ** 2;
      angle[k] = body.point ? 0 : 2 * Math.asin(Math.min(1, Math.sqrt(sum / 8)));
    });
    return [
      {
        a,
        b,
        name: body.name,
        distance,
        angle,
        worst: Math.max(...distance) / first.meta.length + Math.max(...angle),
      },
    ];
  });
  return pairs.sort((p, q) => q.worst - p.worst);
}

function sides(first: Run, second: Run): HTMLElement {
  const row = (label: string, of: (run: Run) => string) =>
    element(
      "tr",
      {},
      element("th", { scope: "row" }, label),
      element("td", {}, of(first)),
      element("td", {}, of(second)),
    );
  return element(
    "div",
    { class: "wide" },
    element(
      "table",
      { class: "checks" },
      element(
        "thead",
        {},
        element(
          "tr",
          {},
          element("th", { scope: "col" }, ""),
          element("th", { scope: "col" }, "this run"),
          element("th", { scope: "col" }, "the other"),
        ),
      ),
      element(
        "tbody",
        {},
        row("title", (r) => r.meta.title || "\u2013"),
        row("file", (r) => r.meta.name),
        row("verdict", (r) => {
          const v = verdict_of(r);
          return `${v.sign} ${v.word}: ${v.lead}`;
        }),
        row("method", (r) => r.meta.method),
        row("elements", (r) => number(r.figure("elements"), 9)),
        row("estimated error", (r) => rough(r.figure("estimated_error"))),
        row("energy balance", (r) => rough(r.figure("energy_drift"))),
        row("time", (r) => `${number(r.meta.start, 6)}\u00a0s to ${number(r.meta.end, 6)}\u00a0s`),
        row("bodies", (r) => String(r.meta.bodies.length)),
      ),
    ),
  );
}

export class Compare {
  second: Run | null = null;
  plots: Plot[] = [];
  private readonly empty = element("ol", { class: "steps" });
  private readonly result = element("div", { "aria-live": "polite" });

  /** What was found, anew where units change. */
  say = () => {};

  constructor(
    private readonly host: HTMLElement,
    private readonly first: Run,
    private readonly time: Timeline,
    private readonly changed: (second: Run | null) => void,
    signal: AbortSignal,
  ) {
    const input = element("input", {
      type: "file",
      accept: ".html,text/html",
      id: "other-file",
      class: "unseen",
    });
    const steps = [
      "Solve the same mechanism again: with another number in it, another accuracy, another method.",
      "Write a report of that run, too: livens report OTHER.nc",
      "Open it here. Both motions are shown in one picture, and how far they are apart over time.",
    ];
    const section = element(
      "section",
      { class: "card" },
      element("h2", {}, "Compare with another run"),
      this.empty,
      element(
        "p",
        { class: "chooser" },
        element("label", { for: "other-file", class: "button" }, "Open another report\u2026"),
        input,
      ),
      element(
        "p",
        { class: "note" },
        "You may also drop the file anywhere on this page; nothing leaves this machine. Both in one page from the start: ",
        element("code", {}, "livens report A.nc B.nc -o FILE.html"),
      ),
      this.result,
    );
    this.empty.append(...steps.map((step) => element("li", {}, step)));
    host.append(section);
    const read = async (file: File | undefined) => {
      if (!file) return;
      try {
        // A document made so runs no scripts.
        const runs = await runs_of(new DOMParser().parseFromString(await file.text(), "text/html"));
        if (runs.length === 0) throw new Error("it holds no run");
        this.set(new Run(runs[0]));
      } catch (error) {
        this.result.replaceChildren(
          element(
            "p",
            { class: "bad" },
            `${file.name} cannot be read as a report: ${error instanceof Error ? error.message : String(error)}`,
          ),
        );
      }
    };
    input.addEventListener("change", () => void read(input.files?.[0]));
    for (const event of ["dragover", "drop"])
      document.addEventListener(event, (e) => e.preventDefault(), { signal });
    const dropped = (e: Event) => {
      const file = (e as DragEvent).dataTransfer?.files[0];
      if (file) {
        by_id("tab-compare").click();
        void read(file);
      }
    };
    document.addEventListener("drop", dropped, { signal });
  }

  set(second: Run) {
    this.second = second;
    this.empty.hidden = true;
    for (const plot of this.plots) plot.destroy();
    this.plots = [];
    const from = Math.max(this.first.motion.start, second.motion.start),
      to = Math.min(this.first.motion.end, second.motion.end);
    const times = Float64Array.from(
      { length: to > from ? looks + 1 : 1 },
      (_, k) => from + (k / looks) * (to - from),
    );
    const pairs = from <= to ? pairs_of(this.first, second, times) : [],
      grid = element("div", { class: "grid" });
    const largest = (of: (p: Pair) => Float64Array) => Math.max(0, ...pairs.map((p) => Math.max(...of(p))));
    const [apart, turned] = [largest((p) => p.distance), largest((p) => p.angle)],
      lead = element("p", { class: "lead" });
    this.say = () => {
      const { unit, factor } = shown_in("rad");
      lead.textContent =
        pairs.length === 0
          ? "The runs have no body and no time in common."
          : `${pairs.length === 1 ? "The body that both have is" : `The ${pairs.length} bodies that both have are`} at most ${rough(apart)}\u00a0m and ${rough(factor * turned)}\u00a0${unit} apart, looked at ${times.length} times from ${number(from, 6)}\u00a0s to ${number(to, 6)}\u00a0s; \u201c${pairs[0].name}\u201d most. The second is the grey ghost in the picture.`;
    };
    this.say();
    this.result.replaceChildren(lead, sides(this.first, second));
    if (!grid.parentElement) this.host.querySelector(".grid")?.remove();
    this.host.append(grid);
    if (pairs.length && times.length > 1) {
      const some = pairs.slice(0, 6).map((p, i) => ({ ...p, colour: i }));
      const add = (title: string, unit: string, of: (p: Pair) => Float64Array) =>
        this.plots.push(
          new Plot(
            grid,
            {
              title,
              unit,
              log: true,
              height: 210,
              times,
              series: some.map((p) => ({ label: p.name, colour: p.colour, values: of(p) })),
            },
            this.time,
          ),
        );
      add("Distance of centres of mass", "m", (p) => p.distance);
      add("Angle between orientations", "rad", (p) => p.angle);
    }
    this.changed(second);
  }
}
