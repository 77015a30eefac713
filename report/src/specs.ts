// SPDX-License-Identifier: BSD-3-Clause
// Everything that can be plotted of a run, over time or against each other, and what a stranger should see first.
import { Vector3 } from "three";
import { motors_of } from "./motors";
import type { Quantity } from "./phase";
import type { Run } from "./run";

export interface Series {
  label: string;
  at(t: number): number;
  colour: number;
}
export interface PlotSpec {
  id: string;
  group: string;
  title: string;
  unit: string;
  series: Series[];
}
export interface PhaseSpec {
  id: string;
  title: string;
  x: Quantity;
  y: Quantity;
}

const most_series = 7; // which colours tell apart
const looks = 240; // instants at which series are looked at
const flattened = 10; // times the range of a line that stands beside another
const most_groups = 3; // plots that one is split into
const rounding = 2e-6; // of a value: curves are rounded to a ten-millionth
const no_signal = 1e-9; // of the largest value: rounding
const xyz = ["x", "y", "z"];

type Bare = Omit<Series, "colour">;

export function instants({ motion: { start, end } }: Run, n = looks): number[] {
  return Array.from({ length: n + 1 }, (_, k) => start + (k / n) * (end - start));
}
/** The least and the largest value; one of both where there is nothing but rounding between them. */
function reach_of(run: Run, { at }: Pick<Series, "at">): [number, number] {
  let low = Infinity,
    high = -Infinity;
  for (const t of instants(run)) {
    const v = at(t);
    if (!Number.isFinite(v)) continue;
    low = Math.min(low, v);
    high = Math.max(high, v);
  }
  if (!(high >= low)) return [0, 0];
  return high - low > rounding * Math.max(Math.abs(low), Math.abs(high)) ? [low, high] : [high, high];
}
const range_of = (run: Run, series: Pick<Series, "at">) => {
  const [low, high] = reach_of(run, series);
  return high - low;
};

/** Lines that do not flatten each other share a plot: what moves by 12 stands apart from what moves by 0.3. */
function split(run: Run, spec: PlotSpec): PlotSpec[] {
  const lines = spec.series.map((series) => {
    const [low, high] = reach_of(run, series);
    return { series, low, high, least: high > low ? high - low : Infinity };
  });
  const groups: { low: number; high: number; least: number; all: Set<Series> }[] = [];
  // Those that move most first, those that do not move last.
  const size = ({ low, high }: { low: number; high: number }) => high - low;
  for (const line of [...lines].sort((a, b) => size(b) - size(a))) {
    const fits = (group: (typeof groups)[number]) =>
      Math.max(group.high, line.high) - Math.min(group.low, line.low) <=
      flattened * Math.min(group.least, line.least);
    let group = groups.find(fits);
    if (!group && groups.length < most_groups) groups.push((group = { ...line, all: new Set() }));
    group ??= groups[groups.length - 1];
    group.low = Math.min(group.low, line.low);
    group.high = Math.max(group.high, line.high);
    group.least = Math.min(group.least, line.least);
    group.all.add(line.series);
  }
  return groups.map(({ all }, g) => ({
    ...spec,
    id: g ? `${spec.id} ${g + 1}` : spec.id,
    title: g ? `${spec.title} (${g + 1})` : spec.title,
    series: spec.series.filter((s) => all.has(s)),
  }));
}

class Specs {
  readonly all: PlotSpec[] = [];

  constructor(private readonly run: Run) {}

  add(id: string, group: string, title: string, unit: string, series: Bare[], colours?: number[]) {
    const { run } = this,
      { meta } = run,
      of_more =
        Math.max(meta.bodies.length, meta.joints.length) > most_series && series.length === most_series;
    if (!series.length) return;
    const spec = {
      id,
      group,
      title: of_more ? `${title}, the first ${most_series}` : title,
      unit,
      series: series.map((s, i) => ({ ...s, colour: colours ? colours[i] : i })),
    };
    this.all.push(...(/^(All|Loads|Motors)/.test(group) ? split(run, spec) : [spec]));
  }
  private of(kind: string, index: number, name: string, label: string): Bare[] {
    const { run } = this,
      c = run.channel(kind, index, name);
    return c < 0 ? [] : [{ label, at: (t) => run.curves.at(c, t) }];
  }
  /** Lengths of vectors, of those that are ever other than nothing: a torque has a force that is zero. */
  private sizes(kind: string, what: string, of: { name: string; i: number }[]): Bare[] {
    const { run } = this,
      scale = run.largest_force * (what === "force" ? 1 : run.meta.length);
    const all = of.flatMap(({ name, i }) => {
      const c = xyz.map((x) => run.channel(kind, i, `${what} ${x}`)),
        at = (t: number) => Math.hypot(...c.map((k) => run.curves.at(k, t)));
      if (c.some((k) => k < 0)) return [];
      return [{ label: name, at, most: Math.max(0, ...instants(run, 400).map((t) => at(t) || 0)) }];
    });
    const largest = Math.max(scale, ...all.map(({ most }) => most));
    return all.filter(({ most }) => most > no_signal * largest).slice(0, most_series);
  }

  motors() {
    const motors = motors_of(this.run),
      some = (turns: boolean) => motors.filter((m) => m.turns === turns).slice(0, most_series);
    const add = (id: string, title: string, unit: string, of: typeof motors, what: "effort" | "power") =>
      this.add(
        id,
        "Motors",
        title,
        unit,
        of.map((m) => ({ label: m.label, at: (t) => m[what](t) })),
      );
    add("motor torques", "Torques of motors", "N m", some(true), "effort");
    add("motor forces", "Forces of drives", "N", some(false), "effort");
    add(
      "motor power",
      motors.every((m) => m.turns) ? "Power of motors" : "Power of drives",
      "W",
      motors.slice(0, most_series),
      "power",
    );
  }
  /** Of a joint's coordinate, and of its angles by number. */
  private of_joint(index: number, name: string): Bare[] {
    const { name: joint } = this.run.meta.joints[index],
      numbers = name.startsWith("angle") ? [" 1", " 2", " 3"] : [];
    return [
      ...this.of("joint", index, name, joint),
      ...numbers.flatMap((n) =>
        this.of("joint", index, name.replace("angle", `angle${n}`), `${joint} angle${n}`),
      ),
    ];
  }
  joints() {
    const { meta } = this.run,
      many = (series: Bare[]) => series.slice(0, most_series);
    for (const [name, title, unit] of [
      ["angle", "Angles of joints", "rad"],
      ["displacement", "Displacements of joints", "m"],
      ["angle rate", "Rates of angles", "rad/s"],
      ["displacement rate", "Rates of displacements", "m/s"],
      ["angle acceleration", "Accelerations of angles", "rad/s^2"],
      ["displacement acceleration", "Accelerations of displacements", "m/s^2"],
    ])
      this.add(
        `joints ${name}`,
        "All joints",
        title,
        unit,
        many(meta.joints.flatMap((_, i) => this.of_joint(i, name))),
      );
    const kept = meta.joints.flatMap((j, i) => (j.type === "drive" ? [] : [{ name: j.name, i }]));
    for (const [id, what, title, unit] of [
      ["reactions", "force", "Forces of joints", "N"],
      ["torques", "torque", "Torques of joints", "N m"],
    ])
      this.add(id, "All joints", title, unit, this.sizes("reaction", what, kept));
    this.add(
      "tensions",
      "All joints",
      "Tensions of ropes",
      "N",
      many(meta.joints.flatMap((j, i) => this.of("drive", i, "tension", j.name))),
    );
    for (const [id, what, title, unit] of [
      ["loads", "force", "Forces of loads", "N"],
      ["load torques", "torque", "Torques of loads", "N m"],
    ])
      this.add(
        id,
        "Loads",
        title,
        unit,
        this.sizes(
          "load",
          what,
          meta.loads.map(({ name }, i) => ({ name, i })),
        ),
      );
  }
  energy() {
    // from that at the start, or what is exchanged would be a ripple far from zero
    const { run } = this,
      of_start = run.curves.at(run.channel("energy", 0, "potential"), run.motion.start);
    const sum = [
      ...this.of("energy", 0, "kinetic", "kinetic"),
      ...this.of("energy", 0, "potential", "").map((s) => ({
        label: "potential since the start",
        at: (t: number) => s.at(t) - of_start,
      })),
    ];
    this.add("energy", "Energy", "Energy", "J", [
      ...sum,
      { label: "sum", at: (t) => sum[0].at(t) + sum[1].at(t) },
    ]);
  }
  sensors() {
    const { meta } = this.run;
    meta.sensors.forEach((sensor, s) => {
      const units = new Map<string, string[]>();
      for (const c of meta.channels)
        if (c.kind === "sensor" && c.index === s) units.set(c.unit, [...(units.get(c.unit) ?? []), c.name]);
      for (const [unit, names] of units)
        this.add(
          `sensor ${s} ${unit}`,
          "Sensors",
          `Sensor ${sensor.name}`,
          unit,
          names.flatMap((name) => this.of("sensor", s, name, name)),
        );
    });
  }
  bodies() {
    const { run } = this,
      { meta } = run,
      chosen = meta.bodies.map((_, b) => b).slice(0, most_series),
      turning = chosen.filter((b) => !meta.bodies[b].point);
    const add = (
      id: string,
      title: string,
      unit: string,
      of: number[],
      at: (b: number, t: number) => number,
    ) =>
      this.add(
        id,
        "All bodies",
        title,
        unit,
        of.map((b) => ({ label: meta.bodies[b].name, at: (t) => at(b, t) })),
        of,
      );
    add("heights", "Heights of centres of mass", "m", chosen, (b, t) => run.centre(b, t).dot(run.up));
    add("speeds", "Speeds of centres of mass", "m/s", chosen, (b, t) => run.velocity(b, t).length());
    add("spins", "Angular speeds", "rad/s", turning, (b, t) => run.spin(b, t).length());
    const parts = (get: (t: number) => Vector3) =>
      xyz.map((label, i) => ({ label, at: (t: number) => get(t).getComponent(i) }));
    meta.bodies.forEach(({ name, point }, b) => {
      this.add(
        `body ${b} position`,
        name,
        `${name}: centre of mass`,
        "m",
        parts((t) => run.centre(b, t)),
      );
      this.add(
        `body ${b} velocity`,
        name,
        `${name}: velocity`,
        "m/s",
        parts((t) => run.velocity(b, t)),
      );
      for (const [what, unit] of [
        ["acceleration", "m/s^2"],
        ["angular acceleration", "rad/s^2"],
      ])
        if (!point || what === "acceleration")
          this.add(
            `body ${b} ${what}`,
            name,
            `${name}: ${what}${what === "acceleration" ? " of the reference point" : ""}`,
            unit,
            xyz.flatMap((x) => this.of("body", b, `${what} ${x}`, x)),
          );
      if (!point)
        this.add(
          `body ${b} spin`,
          name,
          `${name}: angular velocity`,
          "rad/s",
          parts((t) => run.spin(b, t)),
        );
    });
  }
  reactions() {
    this.run.meta.joints.forEach(({ name }, i) => {
      for (const [what, unit] of [
        ["force", "N"],
        ["torque", "N m"],
      ])
        this.add(
          `joint ${i} ${what}`,
          `Joint ${name}`,
          `${name}: ${what}`,
          unit,
          xyz.flatMap((x) => this.of("reaction", i, `${what} ${x}`, x)),
        );
    });
  }
}

export function specs_of(run: Run): PlotSpec[] {
  const specs = new Specs(run);
  specs.motors();
  specs.joints();
  specs.energy();
  specs.sensors();
  specs.bodies();
  specs.reactions();
  return specs.all;
}

/** Portraits of coordinates of joints, and paths in the plane where most of them is seen. */
export function phases_of(run: Run): PhaseSpec[] {
  const { meta } = run,
    all: PhaseSpec[] = [];
  const of = (channel: number, label: string): Quantity => ({
    label,
    unit: meta.channels[channel].unit,
    at: (t) => run.curves.at(channel, t),
  });
  meta.channels.forEach(({ kind, index, name }, c) => {
    if (kind !== "joint" || !/^(angle( \d)?|displacement)$/.test(name)) return;
    const rate = run.channel(kind, index, `${name} rate`),
      joint = meta.joints[index].name;
    if (rate < 0) return;
    const title = `${joint}: phase portrait${name === "angle" ? "" : ` of the ${name}`}`;
    all.push({ id: `phase ${c}`, title, x: of(c, `${joint} ${name}`), y: of(rate, `${joint} ${name} rate`) });
  });
  const path = (id: string, title: string, axes: Quantity[]) => {
    const ranges = axes.map((axis) => range_of(run, axis)),
      least = ranges.indexOf(Math.min(...ranges)),
      kept = [0, 1, 2].filter((i) => i !== least),
      upright = run.up.toArray().map(Math.abs);
    if (!(Math.max(...ranges) > no_signal * meta.length)) return;
    if (upright[kept[0]] > upright[kept[1]]) kept.reverse();
    all.push({ id, title, x: axes[kept[0]], y: axes[kept[1]] });
  };
  run.sensor_points.forEach((channels, i) => {
    const name = meta.sensors[meta.channels[channels[0]].index].name;
    path(
      `sensor path ${i}`,
      `${name}: path`,
      channels.map((c, k) => of(c, `${name} ${xyz[k]}`)),
    );
  });
  meta.bodies.slice(0, 60).forEach(({ name }, b) =>
    path(
      `path ${b}`,
      `${name}: path of the centre of mass`,
      xyz.map((x, k) => ({ label: `${name} ${x}`, unit: "m", at: (t) => run.centre(b, t).getComponent(k) })),
    ),
  );
  return all;
}

/** All lines of all plots, once each, as what one may be plotted against. */
export function quantities_of(run: Run): { id: string; group: string; quantity: Quantity }[] {
  return run.specs.flatMap(({ id, title, unit, series }) =>
    series.map((s, i) => ({
      id: `${id}/${i}`,
      group: title,
      quantity: {
        label: series.length > 1 || !title.endsWith(s.label) ? `${title}: ${s.label}` : title,
        unit,
        at: s.at,
      },
    })),
  );
}
