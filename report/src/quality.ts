// SPDX-License-Identifier: BSD-3-Clause
// The tab that tells how right a run is: figures against their bounds, and series over time.
import { element_of } from "./motion";
import { Plot, type PlotOptions } from "./plot";
import type { Run } from "./run";
import { element, number, rough, seconds } from "./text";
import type { Timeline } from "./timeline";
import { verdict_of } from "./verdict";

/** Where a value lies between rounding and its bound, both ends of a scale of powers of ten. */
function gauge(value: number, bound: number): HTMLElement {
  const low = -17,
    high = Math.log10(bound) + 2,
    share = (x: number) => Math.min(Math.max((x - low) / (high - low), 0), 1);
  const bar = element("span", { class: "gauge", "aria-hidden": "true" }, element("i", {}), element("b", {}));
  (bar.children[0] as HTMLElement).style.width = `${100 * share(value > 0 ? Math.log10(value) : low)}%`;
  (bar.children[1] as HTMLElement).style.left = `${100 * share(Math.log10(bound))}%`;
  if (!(value <= bound)) bar.classList.add("over");
  return bar;
}

function table(run: Run): HTMLElement {
  const rows = run.meta.verdict.figures.flatMap(({ figure, name, meaning }) => {
    const bound = run.meta.quality.bounds[figure],
      value = run.figure(figure);
    if (bound === undefined || (Number.isNaN(value) && figure !== "estimated_error")) return [];
    const is_known = Number.isFinite(value),
      is_passed = value <= bound;
    return [
      element(
        "tr",
        {},
        element("th", { scope: "row" }, name[0].toUpperCase() + name.slice(1), element("small", {}, meaning)),
        element("td", { class: "n" }, is_known ? rough(value) : "not known"),
        element("td", { class: "n" }, number(bound, 2)),
        element("td", {}, is_known ? gauge(value, bound) : null),
        element(
          "td",
          { class: !is_known ? "" : is_passed ? "passed" : "broken" },
          !is_known ? "" : is_passed ? "\u2713 passed" : "\u2717 exceeded",
        ),
      ),
    ];
  });
  const head = element(
    "tr",
    {},
    ...["check", "measured", "limit", "logarithmic scale", ""].map((h) =>
      element("th", { scope: "col", class: h.startsWith("log") ? "scale" : "" }, h),
    ),
  );
  return element(
    "div",
    { class: "wide" },
    element(
      "table",
      { class: "checks" },
      element("caption", {}, "What the run was judged by"),
      element("thead", {}, head),
      element("tbody", {}, ...rows),
    ),
  );
}

/** What the motion decided, and its impacts; a click goes there. */
function events(run: Run, time: Timeline): HTMLElement[] {
  const all = run.meta.events ?? [],
    most = 1000;
  if (!all.length) return [];
  const known = (x: number | null, unit: string, digits = 5) =>
    x === null || !Number.isFinite(x) ? "" : `${number(x, digits)}\u00a0${unit}`;
  const rows = all.slice(0, most).map((event) => {
    const is_hit = event.speed > 0,
      there = element("button", { type: "button" }, `${number(event.t, 10)}\u00a0s`);
    there.addEventListener("click", () => time.set(event.t));
    return element(
      "tr",
      {},
      element("th", { scope: "row" }, event.name, element("small", {}, event.condition)),
      element("td", { class: "n" }, there),
      element("td", { class: "n" }, event.error === null ? "not known" : `${rough(event.error)}\u00a0s`),
      element("td", { class: "n" }, is_hit ? known(event.speed, event.angle ? "rad/s" : "m/s") : ""),
      element("td", { class: "n" }, is_hit ? known(event.behind, event.angle ? "rad/s" : "m/s") : ""),
      element(
        "td",
        { class: "n" },
        is_hit ? known(event.impulse, event.angle ? "N\u00a0m\u00a0s" : "N\u00a0s") : "",
      ),
      element("td", { class: "n" }, known(event.rests, "s", 8)),
    );
  });
  const head = ["event", "time", "error", "speed before", "behind", "impulse", "at rest from"].map((h) =>
    element("th", { scope: "col" }, h),
  );
  const more = all.length > most ? [element("p", {}, `and ${all.length - most} more`)] : [];
  return [
    element(
      "div",
      { class: "wide" },
      element(
        "table",
        { class: "checks", id: "events" },
        element("caption", {}, "What the motion decided"),
        element("thead", {}, element("tr", {}, ...head)),
        element("tbody", {}, ...rows),
      ),
    ),
    ...more,
  ];
}

function facts(run: Run): HTMLElement {
  const f = (name: string) => run.figure(name),
    list = element("dl", { class: "facts" });
  const add = (label: string, value: string, show = true) => {
    if (show) list.append(element("div", {}, element("dt", {}, label), element("dd", {}, value)));
  };
  add("method", run.meta.method);
  add("elements", number(f("elements"), 9));
  add("order at element ends", number(f("order_at_element_ends")), f("order_at_element_ends") > 0);
  add(
    "Newton iterations",
    `${number(f("newton_iterations"), 9)}, ${number(f("most_iterations"))} at most in one window`,
  );
  add("residual", rough(f("residual_norm")));
  add("smallest pivot", rough(f("smallest_pivot")));
  add("elements divided", number(f("divided")), f("divided") > 0);
  add("accuracy asked for", rough(f("accuracy")), f("accuracy") > 0);
  add("perturbations grow by", rough(f("growth")), Number.isFinite(f("growth")));
  add("horizon", `${number(f("horizon"), 5)}\u00a0s`, Number.isFinite(f("horizon")));
  add("condition number (2-norm)", rough(f("condition_2")), f("condition_2") > 0);
  return list;
}

export function build_quality(host: HTMLElement, run: Run, time: Timeline): Plot[] {
  const v = verdict_of(run),
    { quality } = run.meta,
    plots: Plot[] = [];
  const said = [
    element(
      "p",
      { class: "lead" },
      element("strong", { class: v.grade }, `${v.sign} ${v.word}`),
      `: ${v.lead}${v.rest}.`,
    ),
  ];
  const notes = run.meta.notes.length
    ? [element("ul", { class: "notes" }, ...run.meta.notes.map((n) => element("li", {}, n)))]
    : [];
  const worst = run.meta.bodies[quality.worst_body];
  const where =
    worst && Number.isFinite(run.figure("estimated_error_time"))
      ? [
          element(
            "p",
            {},
            `The largest error is that of \u201c${worst.name}\u201d at ${number(run.figure("estimated_error_time"), 6)}\u00a0s.`,
          ),
        ]
      : [];
  const place = element("p", { id: "where" });
  time.on_move((t) => {
    const { ends } = run.motion,
      word = run.meta.pose.precision === "thinned" ? "Part" : "Element";
    place.textContent =
      ends.length > 1
        ? `${word} ${element_of(ends, t) + 1} of ${ends.length - 1} at ${seconds(t, time.span)}\u00a0s.`
        : "";
  });
  const grid = element("div", { class: "grid" });
  const judged = element(
    "section",
    { class: "card" },
    element("h2", {}, "Is it right?"),
    ...said,
    ...where,
    place,
    ...notes,
    table(run),
    ...events(run, time),
    facts(run),
  );
  host.append(element("div", { class: "columns" }, judged, grid));
  const times = run.array("quality_time");
  const add = (title: string, unit: string, names: string[], options: Partial<PlotOptions> = {}) => {
    const series = names
      .filter((n) => quality.series.includes(n))
      .map((n, i) => ({ label: n, colour: i, values: run.array(`quality ${n}`) }));
    if (series.length && times.length > 1)
      plots.push(new Plot(grid, { title, unit, series, times, log: true, height: 190, ...options }, time));
  };
  const horizon = run.figure("horizon"),
    mark = Number.isFinite(horizon) ? { mark: { t: horizon, label: "horizon" } } : {};
  const bound = (name: string, scale = 1, of = "") => {
    const value = quality.bounds[name] * scale;
    return Number.isFinite(value) && value > 0
      ? { bound: { value, label: `${of}limit ${number(value, 2)}` } }
      : {};
  };
  /** What a relative drift was divided by. */
  const reference = (series: string, figure: string) => {
    const values = quality.series.includes(series) ? run.array(`quality ${series}`) : [];
    let largest = 0;
    for (let i = 0; i < values.length; ++i) largest = Math.max(largest, values[i]);
    return largest / run.figure(figure);
  };
  add(
    "Estimated error at element ends",
    "lengths of the model, rad, largest reaction",
    ["position error", "orientation error", "reaction error"],
    { ...bound("estimated_error", 1, "poses: "), ...mark },
  );
  add(
    "Violation of constraints in elements",
    "",
    ["joint violation", "rigidity violation"],
    bound("max_constraint_violation"),
  );
  add(
    "Energy balance",
    "J",
    ["energy balance"],
    bound("energy_drift", reference("energy balance", "energy_drift")),
  );
  add(
    "Momentum balance",
    "kg m/s",
    ["momentum balance"],
    bound("linear_momentum_drift", reference("momentum balance", "linear_momentum_drift")),
  );
  add(
    "Angular momentum balance",
    "kg m\u00b2/s",
    ["angular momentum balance"],
    bound("angular_momentum_drift", reference("angular momentum balance", "angular_momentum_drift")),
  );
  add("Growth of a small perturbation", "", ["growth"], mark);
  add("Lengths of time elements", "s", ["element length"]);
  add("Newton iterations of each element\u2019s window", "", ["iterations"], { log: false });
  return plots;
}
