// SPDX-License-Identifier: BSD-3-Clause
// What drives give: force or torque along what they drive, and power.
import { Vector3 } from "three";
import type { Run } from "./run";

export interface Motor {
  label: string;
  turns: boolean; // torque, or else force
  effort(t: number): number; // N m or N, positive where it drives towards greater coordinates
  power(t: number): number; // W
}

/** A point of a body in the world. */
function place_at(run: Run, body: number, point: Vector3, t: number): Vector3 {
  if (body < 0) return point.clone();
  const X = run.motion.at(t, new Float64Array(12), body, body + 1);
  return new Vector3(X[0], X[1], X[2]).add(axis_at(run, body, point, t));
}
/** Velocity of what is of a body at a place of the world, in world axes. */
function velocity_at(run: Run, body: number, place: Vector3, t: number): Vector3 {
  if (body < 0) return new Vector3();
  const X = run.motion.at(t, new Float64Array(12), body, body + 1),
    arm = place.clone().sub(new Vector3(X[0], X[1], X[2])),
    along = (i: number) => arm.dot(new Vector3(X[i], X[i + 1], X[i + 2])),
    point = new Vector3(along(3), along(6), along(9));
  const rates = run.motion.rates(t, new Float64Array(12), body, body + 1),
    at = (i: number) => rates[i] + rates[3 + i] * point.x + rates[6 + i] * point.y + rates[9 + i] * point.z;
  return new Vector3(at(0), at(1), at(2));
}
const spin_of = (run: Run, body: number, t: number) => (body < 0 ? new Vector3() : run.spin(body, t));
/** An axis of a body in world axes. */
function axis_at(run: Run, body: number, axis: Vector3, t: number): Vector3 {
  if (body < 0) return axis.clone();
  const X = run.motion.at(t, new Float64Array(12), body, body + 1),
    at = (i: number) => X[3 + i] * axis.x + X[6 + i] * axis.y + X[9 + i] * axis.z;
  return new Vector3(at(0), at(1), at(2));
}

const looks = 60;

export function motors_of(run: Run): Motor[] {
  const { joints } = run.meta,
    { start, end } = run.motion;
  return joints.flatMap((drive, d) => {
    if (drive.type !== "drive") return [];
    const reaction = (what: string) => {
      const channels = ["x", "y", "z"].map((x) => run.channel("reaction", d, `${what} ${x}`));
      if (channels.some((c) => c < 0)) return null;
      return (t: number) => new Vector3(...channels.map((c) => run.curves.at(c, t)));
    };
    const force = reaction("force"),
      torque = reaction("torque");
    if (!force || !torque) return [];
    let largest = [0, 0];
    for (let k = 0; k <= looks; ++k) {
      const t = start + (k / looks) * (end - start);
      largest = [force, torque].map((of, i) => Math.max(largest[i], of(t).length() || 0));
    }
    const turns = largest[1] * 1e6 > largest[0] * run.meta.length && largest[1] > 0,
      of = turns ? torque : force;
    const same = (p: number[], q: number[]) => p.every((v, i) => Math.abs(v - q[i]) < 1e-9 * run.meta.length);
    // The joint whose coordinate it drives; without one, its size is told.
    const axes = joints.filter(
      (j) =>
        j.type !== "drive" &&
        j.first === drive.first &&
        j.second === drive.second &&
        same(j.point_second, drive.point_second) &&
        Math.hypot(...j.axis_second) > 0.5,
    );
    const axis = axes.length === 1 ? new Vector3(...axes[0].axis_second) : null,
      point = new Vector3(...drive.point_second);
    return [
      {
        label: drive.name,
        turns,
        effort: (t: number) => (axis ? of(t).dot(axis_at(run, drive.second, axis, t)) : of(t).length()),
        power: (t: number) => {
          const place = place_at(run, drive.second, point, t),
            v = velocity_at(run, drive.second, place, t).sub(velocity_at(run, drive.first, place, t)),
            w = spin_of(run, drive.second, t).sub(spin_of(run, drive.first, t));
          return force(t).dot(v) + torque(t).dot(w);
        },
      },
    ];
  });
}
