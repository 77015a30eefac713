// SPDX-License-Identifier: BSD-3-Clause
// A run as picture and plots want it: its motion, and everything that can be plotted.
import { Vector3 } from "three";
import type { Data, Load, Meta, Numbers } from "./data";
import { Curves, Motion } from "./motion";
import type { Grain } from "./plot";
import { phases_of, specs_of, type PhaseSpec, type PlotSpec } from "./specs";

/** A force that is drawn, at a point of a body (-1: the world). */
export interface Force {
  kind: "reaction" | "load";
  name: string;
  body: number;
  point: Vector3;
  largest: number;
  at(t: number, out: Vector3): void;
}

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
  readonly phases: PhaseSpec[];
  private readonly one = new Float64Array(12);

  constructor(private readonly data: Data) {
    this.meta = data.meta;
    this.motion = new Motion(data);
    this.curves = new Curves(data);
    const g = new Vector3(...this.meta.gravity);
    this.up = g.length() > 0 ? g.negate().normalize() : new Vector3(0, 0, 1);
    this.springs = this.meta.loads.filter(
      (l) => l.type.includes("spring") && l.point_first && l.point_second && !l.over?.length,
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
    this.specs = specs_of(this);
    this.phases = phases_of(this);
  }
  array(name: string): Numbers {
    return this.data.arrays.get(name)!;
  }
  figure(name: string): number {
    return this.meta.figures[name] ?? NaN;
  }
  /** Elements that are drawn may be several of the run's. */
  get grain(): Grain {
    const { ends } = this.motion,
      { degree, elements } = this.meta.pose,
      merged = Math.ceil(elements / Math.max(ends.length - 1, 1));
    return { ends, of_each: (degree + 1) * merged };
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
}
