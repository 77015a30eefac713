// SPDX-License-Identifier: BSD-3-Clause
// A run as picture and plots want it: its motion, and everything that can be plotted.
import { Vector3 } from "three";
import type { Data, Load, Meta, Numbers } from "./data";
import { Curves, Motion } from "./motion";

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
/** A force that is drawn, at a point of a body (-1: the world). */
export interface Force {
  kind: "reaction" | "load";
  name: string;
  body: number;
  point: Vector3;
  largest: number;
  at(t: number, out: Vector3): void;
}

const most_series = 7; // which colours tell apart
const xyz = ["x", "y", "z"];

export class Run {
  readonly meta: Meta;
  readonly motion: Motion;
  readonly curves: Curves;
  readonly up: Vector3;
  readonly forces: Force[] = [];
  readonly torques: Force[] = [];
  readonly springs: Load[];
  readonly attachments: { body: number; point: Vector3 }[] = []; // of joints and springs, in coordinates of bodies
  readonly sensor_points: [number, number, number][] = [];
  readonly tips: [number, number, number][];
  readonly largest_force: number;
  readonly largest_torque: number;
  readonly specs: PlotSpec[];
  private readonly one = new Float64Array(12);

  constructor(private readonly data: Data) {
    this.meta = data.meta;
    this.motion = new Motion(data);
    this.curves = new Curves(data);
    const g = new Vector3(...this.meta.gravity);
    this.up = g.length() > 0 ? g.negate().normalize() : new Vector3(0, 0, 1);
    this.springs = this.meta.loads.filter(
      (l) => l.type.includes("spring") && l.point_first && l.point_second,
    );
    for (const { first, second, point_first, point_second } of [...this.meta.joints, ...this.springs])
      for (const [body, point] of [
        [first, point_first],
        [second, point_second],
      ] as const)
        if (body >= 0) this.attachments.push({ body, point: new Vector3(...point!) });
    this.find_forces();
    this.largest_force = this.find_largest(this.forces);
    this.largest_torque = this.find_largest(this.torques);
    this.meta.sensors.forEach((sensor, s) => {
      const at = xyz.map((name) => this.channel("sensor", s, name));
      if (sensor.type === "point" && at.every((c) => c >= 0))
        this.sensor_points.push(at as [number, number, number]);
    });
    this.tips = this.find_tips();
    this.specs = this.all_specs();
  }
  array(name: string): Numbers {
    return this.data.arrays.get(name)!;
  }
  figure(name: string): number {
    return this.meta.figures[name] ?? NaN;
  }
  get name() {
    return this.meta.title || this.meta.name;
  }

  channel(kind: string, index: number, name: string): number {
    return this.meta.channels.findIndex((c) => c.kind === kind && c.index === index && c.name === name);
  }

  private find_forces() {
    const add = (
      kind: Force["kind"],
      index: number,
      name: string,
      body: number,
      point: [number, number, number],
      what = "force",
    ) => {
      const channels = xyz.map((x) => this.channel(kind, index, `${what} ${x}`));
      if (channels.some((c) => c < 0)) return;
      (what === "force" ? this.forces : this.torques).push({
        kind,
        name,
        body,
        point: new Vector3(...point),
        largest: 0,
        at: (t, out) => {
          out.set(
            this.curves.at(channels[0], t),
            this.curves.at(channels[1], t),
            this.curves.at(channels[2], t),
          );
        },
      });
    };
    this.meta.joints.forEach((j, i) => add("reaction", i, j.name, j.second, j.point_second));
    this.meta.loads.forEach((l, i) => {
      const point = l.point_first ?? l.place;
      if (point && !this.springs.includes(l)) add("load", i, l.name, l.first, point);
      if (l.place) add("load", i, l.name, l.first, l.place, "torque");
    });
  }
  private find_largest(forces: Force[]): number {
    const { start, end } = this.motion,
      f = new Vector3();
    const n = Math.max(400, Math.min(4000, Math.ceil(40000 / Math.max(forces.length, 1))));
    for (const force of forces)
      for (let k = 0; k <= n; ++k) {
        force.at(start + (k / n) * (end - start), f);
        force.largest = Math.max(force.largest, f.length() || 0);
      }
    return forces.reduce((most, force) => Math.max(most, force.largest), 0);
  }

  /** Of each body the point whose path says most: its centre, or an end that goes farther. No two the same. */
  private find_tips(): [number, number, number][] {
    const { motion, meta } = this,
      n = 48,
      X = new Float64Array(12 * motion.bodies),
      taken: string[] = [];
    const poses: Float64Array[] = [];
    for (let k = 0; k < n; ++k)
      poses.push(Float64Array.from(motion.at(motion.start + (k / (n - 1)) * (motion.end - motion.start), X)));
    return meta.bodies.map((body, b) => {
      const longest = body.half.indexOf(Math.max(...body.half)),
        candidates = [body.centre];
      if (!body.point)
        for (const sign of [1, -1])
          candidates.push(
            body.middle.map((m, i) => m + (i === longest ? sign * body.half[i] : 0)) as typeof body.centre,
          );
      const paths = candidates.map((c) =>
        poses.map((P) =>
          [0, 1, 2].map(
            (i) =>
              P[12 * b + i] + P[12 * b + 3 + i] * c[0] + P[12 * b + 6 + i] * c[1] + P[12 * b + 9 + i] * c[2],
          ),
        ),
      );
      const sizes = paths.map((path) =>
        Math.hypot(
          ...[0, 1, 2].map((i) => Math.max(...path.map((p) => p[i])) - Math.min(...path.map((p) => p[i]))),
        ),
      );
      const keys = paths.map((path) =>
        path.map((p) => p.map((x) => (x / this.meta.length).toFixed(3)).join()).join(),
      );
      const largest = Math.max(...sizes);
      const order = [0, 1, 2]
        .filter((i) => i < candidates.length)
        .sort((i, k) => sizes[k] * (k ? 0.6 : 1) - sizes[i] * (i ? 0.6 : 1));
      const chosen = order.find((i) => sizes[i] > 0.2 * largest && !taken.includes(keys[i])) ?? 0;
      taken.push(keys[chosen]);
      return candidates[chosen];
    });
  }

  /** Position or velocity of the centre of mass, angular velocity, all in world axes. */
  centre(b: number, t: number): Vector3 {
    return this.point(this.motion.at(t, this.one, b, b + 1), b);
  }
  velocity(b: number, t: number): Vector3 {
    return this.point(this.motion.rates(t, this.one, b, b + 1), b);
  }
  private point(X: Float64Array, b: number): Vector3 {
    const c = this.meta.bodies[b].centre,
      at = (i: number) => X[i] + X[3 + i] * c[0] + X[6 + i] * c[1] + X[9 + i] * c[2];
    return new Vector3(at(0), at(1), at(2));
  }
  /** 1/2 sum d_i x d_i'. */
  spin(b: number, t: number): Vector3 {
    const D = Float64Array.from(this.motion.at(t, this.one, b, b + 1)),
      R = this.motion.rates(t, this.one, b, b + 1);
    const w = new Vector3();
    for (let i = 3; i < 12; i += 3) w.add(new Vector3().fromArray(D, i).cross(new Vector3().fromArray(R, i)));
    return w.multiplyScalar(0.5);
  }

  private all_specs(): PlotSpec[] {
    const { meta } = this,
      specs: PlotSpec[] = [];
    const add = (
      id: string,
      group: string,
      title: string,
      unit: string,
      series: Omit<Series, "colour">[],
      colours?: number[],
    ) => {
      const of_more =
        Math.max(meta.bodies.length, meta.joints.length) > most_series && series.length === most_series;
      if (series.length)
        specs.push({
          id,
          group,
          title: of_more ? `${title}, the first ${most_series}` : title,
          unit,
          series: series.map((s, i) => ({ ...s, colour: colours ? colours[i] : i })),
        });
    };
    const of = (kind: string, index: number, name: string, label: string) => {
      const c = this.channel(kind, index, name);
      return c < 0 ? [] : [{ label, at: (t: number) => this.curves.at(c, t) }];
    };
    const many = <T>(all: T[]) => all.slice(0, most_series);
    const size = (kind: string, i: number, what: string, label: string) => {
      const c = xyz.map((x) => this.channel(kind, i, `${what} ${x}`));
      return c.some((k) => k < 0)
        ? []
        : [{ label, at: (t: number) => Math.hypot(...c.map((k) => this.curves.at(k, t))) }];
    };
    const { start, end } = this.motion;
    // a torque has a force that is zero, which would be a flat line
    const is_ever = (series: { at(t: number): number }) =>
      Array.from({ length: 401 }, (_, k) => start + (k / 400) * (end - start)).some((t) => series.at(t) > 0);
    const coordinates = (name: string) => meta.joints.flatMap((j, i) => of("joint", i, name, j.name));
    for (const [name, title, unit] of [
      ["angle", "Angles of joints", "rad"],
      ["displacement", "Displacements of joints", "m"],
      ["angle rate", "Rates of angles", "rad/s"],
      ["displacement rate", "Rates of displacements", "m/s"],
      ["angle acceleration", "Accelerations of angles", "rad/s^2"],
      ["displacement acceleration", "Accelerations of displacements", "m/s^2"],
    ])
      add(`joints ${name}`, "All joints", title, unit, many(coordinates(name)));
    // from that at the start, or what is exchanged would be a ripple far from zero
    const of_start = this.curves.at(this.channel("energy", 0, "potential"), start);
    const sum = [
      ...of("energy", 0, "kinetic", "kinetic"),
      ...of("energy", 0, "potential", "").map((s) => ({
        label: "potential since the start",
        at: (t: number) => s.at(t) - of_start,
      })),
    ];
    add("energy", "Energy", "Energy", "J", [
      ...sum,
      { label: "sum", at: (t) => sum[0].at(t) + sum[1].at(t) },
    ]);
    for (const [name, title, unit] of [
      ["torque", "Torques of drives", "N m"],
      ["force", "Forces of drives", "N"],
      ["power", "Power of drives", "W"],
    ])
      add(`drives ${name}`, "Drives", title, unit, many(meta.joints.flatMap((j, i) => of("drive", i, name, j.name))));
    add(
      "reactions",
      "All joints",
      "Forces of joints",
      "N",
      many(meta.joints.flatMap((j, i) => size("reaction", i, "force", j.name))),
    );
    add(
      "torques",
      "All joints",
      "Torques of joints",
      "N m",
      many(meta.joints.flatMap((j, i) => size("reaction", i, "torque", j.name))),
    );
    add(
      "loads",
      "Loads",
      "Forces of loads",
      "N",
      many(meta.loads.flatMap((l, i) => size("load", i, "force", l.name).filter(is_ever))),
    );
    add(
      "load torques",
      "Loads",
      "Torques of loads",
      "N m",
      many(meta.loads.flatMap((l, i) => size("load", i, "torque", l.name).filter(is_ever))),
    );
    meta.sensors.forEach((sensor, s) => {
      const units = new Map<string, string[]>();
      for (const c of meta.channels)
        if (c.kind === "sensor" && c.index === s) units.set(c.unit, [...(units.get(c.unit) ?? []), c.name]);
      for (const [unit, names] of units)
        add(
          `sensor ${s} ${unit}`,
          "Sensors",
          `Sensor ${sensor.name}`,
          unit,
          names.flatMap((name) => of("sensor", s, name, name)),
        );
    });
    const indices = meta.bodies.map((_, b) => b),
      chosen = indices.slice(0, most_series);
    add(
      "heights",
      "All bodies",
      "Heights of centres of mass",
      "m",
      chosen.map((b) => ({ label: meta.bodies[b].name, at: (t) => this.centre(b, t).dot(this.up) })),
    );
    add(
      "speeds",
      "All bodies",
      "Speeds of centres of mass",
      "m/s",
      chosen.map((b) => ({ label: meta.bodies[b].name, at: (t) => this.velocity(b, t).length() })),
    );
    add(
      "spins",
      "All bodies",
      "Angular speeds",
      "rad/s",
      chosen
        .filter((b) => !meta.bodies[b].point)
        .map((b) => ({ label: meta.bodies[b].name, at: (t) => this.spin(b, t).length() })),
      chosen.filter((b) => !meta.bodies[b].point),
    );
    const parts = (get: (t: number) => Vector3) =>
      xyz.map((label, i) => ({ label, at: (t: number) => get(t).getComponent(i) }));
    meta.bodies.forEach((body, b) => {
      add(
        `body ${b} position`,
        body.name,
        `${body.name}: centre of mass`,
        "m",
        parts((t) => this.centre(b, t)),
      );
      add(
        `body ${b} velocity`,
        body.name,
        `${body.name}: velocity`,
        "m/s",
        parts((t) => this.velocity(b, t)),
      );
      for (const [what, unit] of [
        ["acceleration", "m/s^2"],
        ["angular acceleration", "rad/s^2"],
      ])
        if (!body.point || what === "acceleration")
          add(
            `body ${b} ${what}`,
            body.name,
            `${body.name}: ${what}${what === "acceleration" ? " of the reference point" : ""}`,
            unit,
            xyz.flatMap((x) => of("body", b, `${what} ${x}`, x)),
          );
      if (!body.point)
        add(
          `body ${b} spin`,
          body.name,
          `${body.name}: angular velocity`,
          "rad/s",
          parts((t) => this.spin(b, t)),
        );
    });
    meta.joints.forEach((j, i) => {
      for (const [what, unit] of [
        ["force", "N"],
        ["torque", "N m"],
      ])
        add(
          `joint ${i} ${what}`,
          `Joint ${j.name}`,
          `${j.name}: ${what}`,
          unit,
          xyz.flatMap((x) => of("reaction", i, `${what} ${x}`, x)),
        );
    });
    return specs;
  }
  private travels(b: number): boolean {
    const { start, end } = this.motion,
      from = this.centre(b, start);
    return Array.from({ length: 50 }, (_, k) =>
      this.centre(b, start + (k / 49) * (end - start)).distanceTo(from),
    ).some((d) => d > 1e-6 * this.meta.length);
  }
  /** What a stranger should see first. */
  default_plots(): string[] {
    const has = (id: string) => this.specs.some((s) => s.id === id);
    const first = ["joints angle", "joints displacement"].filter(has);
    const sensors = this.specs
      .filter((s) => s.id.startsWith("sensor "))
      .slice(0, 2)
      .map((s) => s.id);
    const about_bodies = first.length
      ? []
      : this.meta.bodies.length === 1
        ? [...(this.travels(0) ? ["body 0 position"] : []), "body 0 spin"]
        : ["heights", "speeds"];
    const drives = ["drives torque", "drives force", "drives power"].filter(has).slice(0, 2);
    return [
      ...drives,
      ...sensors.slice(0, 2 - Math.min(drives.length, 1)),
      ...first.slice(0, drives.length ? 1 : 2),
      ...about_bodies,
      "energy",
      "reactions",
      "loads",
      "load torques",
    ]
      .filter(has)
      .slice(0, 4);
  }
}
