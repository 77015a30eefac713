// SPDX-License-Identifier: BSD-3-Clause
// What drives and actuators give: force or torque along what they drive, and power.
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

/** What acts on a body at a point of it, and the opposite on another. */
interface Wrench {
  label: string;
  kind: "reaction" | "load";
  index: number;
  body: number;
  other: number;
  point: [number, number, number];
}

/** Drives are constraints, actuators are loads. */
function wrenches_of({ meta }: Run): Wrench[] {
  const drives = meta.joints.flatMap((j, index): Wrench[] =>
    j.type === "drive"
      ? [{ label: j.name, kind: "reaction", index, body: j.second, other: j.first, point: j.point_second }]
      : [],
  );
  const actuators = meta.loads.flatMap((l, index): Wrench[] => {
    const point = l.place ?? l.point_first;
    return l.type === "actuator" && point
      ? [{ label: l.name, kind: "load", index, body: l.first, other: l.second, point }]
      : [];
  });
  return [...drives, ...actuators];
}

/** The axis of the joint whose coordinate is driven, on the body, towards greater coordinates; null: not known. */
function axis_of(run: Run, { kind, body, other, point }: Wrench): Vector3 | null {
  const near = 1e-9 * run.meta.length,
    joints = run.meta.joints.filter((j) => {
      const is_pair = (j.first === other && j.second === body) || (j.first === body && j.second === other),
        is_there = kind === "load" || j.point_second.every((x, i) => Math.abs(x - point[i]) < near);
      return j.type !== "drive" && is_pair && is_there && Math.hypot(...j.axis_second) > 0.5;
    });
  if (joints.length !== 1) return null;
  const [joint] = joints;
  return joint.second === body
    ? new Vector3(...joint.axis_second)
    : new Vector3(...joint.axis_first).negate();
}

export function motors_of(run: Run): Motor[] {
  const { start, end } = run.motion;
  return wrenches_of(run).flatMap((wrench) => {
    const { label, kind, index, body, other } = wrench,
      point = new Vector3(...wrench.point);
    const vector = (what: string) => {
      const channels = ["x", "y", "z"].map((x) => run.channel(kind, index, `${what} ${x}`));
      if (channels.some((c) => c < 0)) return null;
      return (t: number) => new Vector3(...channels.map((c) => run.curves.at(c, t)));
    };
    const force = vector("force"),
      torque = vector("torque");
    if (!force || !torque) return [];
    // Of drives the program tells it, where it is not older than that.
    const told = (what: string) => {
      const channel = kind === "reaction" ? run.channel("drive", index, what) : -1;
      return channel < 0 ? null : (t: number) => run.curves.at(channel, t);
    };
    const told_power = told("power"),
      told_effort = told("torque") ?? told("force");
    if (told_power && told_effort)
      return [{ label, turns: told("torque") !== null, effort: told_effort, power: told_power }];
    let largest = [0, 0];
    for (let k = 0; k <= looks; ++k) {
      const t = start + (k / looks) * (end - start);
      largest = [force, torque].map((of, i) => Math.max(largest[i], of(t).length() || 0));
    }
    const turns = largest[1] * 1e6 > largest[0] * run.meta.length && largest[1] > 0,
      of = turns ? torque : force,
      axis = axis_of(run, wrench);
    return [
      {
        label,
        turns,
        effort: (t: number) => (axis ? of(t).dot(axis_at(run, body, axis, t)) : of(t).length()),
        power: (t: number) => {
          const place = place_at(run, body, point, t),
            v = velocity_at(run, body, place, t).sub(velocity_at(run, other, place, t)),
            w = spin_of(run, body, t).sub(spin_of(run, other, t));
          return force(t).dot(v) + torque(t).dot(w);
        },
      },
    ];
  });
}
