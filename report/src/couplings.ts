// SPDX-License-Identifier: BSD-3-Clause
// Gears and racks: wheels and bars with teeth, of the sizes that their ratio and the distance of their axes make them.
import { Color, Matrix4, Vector3 } from "three";
import type { Joint } from "./data";
import type { Part } from "./glyphs";
import { Poses, vector, type Place } from "./instances";
import type { Run } from "./run";
import { body_colour } from "./theme";

const looks = 200; // instants
const least_rate = 1e-9; // rad/s: what turns slower tells no ratio
const fewest_teeth = 12,
  most_teeth = 48;

/** A joint that a coupling is of, with its place and axis at the start. */
interface Shaft {
  joint: Joint;
  index: number;
  body: number;
  at: Vector3;
  axis: Vector3;
}
type Put = (part: Part, place: Place) => void;

export class Couplings {
  private readonly poses: Poses;

  constructor(
    private readonly run: Run,
    private readonly radius: number,
    private readonly put: Put,
  ) {
    this.poses = new Poses(run.motion.bodies);
    run.motion.at(run.motion.start, this.poses.X);
    this.poses.update();
    for (const joint of run.meta.joints) {
      if (joint.type === "gear") this.add_gear(joint);
      if (joint.type === "rack_and_pinion") this.add_rack(joint);
    }
  }

  private shaft(coupling: Joint, body: number, point: Joint["point_first"], what: string): Shaft | null {
    const index = this.run.meta.joints.findIndex(
      (j, i) =>
        j !== coupling &&
        j.second === body &&
        j.point_second.every((x, k) => x === point[k]) &&
        this.run.channel("joint", i, what) >= 0,
    );
    if (index < 0) return null;
    const joint = this.run.meta.joints[index],
      axis = vector(joint.axis_second).transformDirection(this.poses.matrices[body]);
    return { joint, index, body, at: this.poses.place(body, vector(joint.point_second)), axis };
  }

  /** How fast the second goes, over the first; NaN where nothing moves. */
  private ratio(first: Shaft, second: Shaft, what: string): number {
    const { run } = this,
      a = run.channel("joint", first.index, "angle rate"),
      b = run.channel("joint", second.index, `${what} rate`);
    let best = least_rate,
      ratio = NaN;
    for (let k = 0; k <= looks; ++k) {
      const t = run.motion.start + (k / looks) * (run.motion.end - run.motion.start),
        rate = run.curves.at(a, t);
      if (Math.abs(rate) > best) {
        best = Math.abs(rate);
        ratio = run.curves.at(b, t) / rate;
      }
    }
    return ratio;
  }

  private add_gear(gear: Joint) {
    const first = this.shaft(gear, gear.first, gear.point_first, "angle"),
      second = this.shaft(gear, gear.second, gear.point_second, "angle");
    if (!first || !second || first.body === second.body) return;
    const same = first.axis.dot(second.axis),
      ratio = this.ratio(first, second, "angle") * (same < 0 ? -1 : 1),
      size = Math.abs(ratio);
    if (!(size > 0.02 && size < 50)) return;
    const across = second.at.clone().sub(first.at);
    across.addScaledVector(first.axis, -across.dot(first.axis));
    const distance = across.length();
    if (Math.abs(same) < 0.999 || distance < 0.1 * this.radius) {
      // Bevel wheels and the like: sizes in proportion only.
      const towards = across.lengthSq() > 0 ? across : new Vector3().crossVectors(first.axis, second.axis);
      this.wheel(first, towards, 4 * this.radius * Math.sqrt(size), 24, 0);
      this.wheel(second, towards.clone().negate(), (4 * this.radius) / Math.sqrt(size), 24, 0.5);
      return;
    }
    if (ratio > 0 && Math.abs(ratio - 1) < 1e-3) return; // a belt
    const r2 = ratio < 0 ? distance / (1 + size) : distance / Math.abs(size - 1),
      r1 = size * r2,
      teeth = this.teeth(Math.min(r1, r2)),
      n1 = r1 < r2 ? teeth : Math.round((teeth * r1) / r2),
      n2 = r2 <= r1 ? teeth : Math.round((teeth * r2) / r1);
    const to_first = ratio < 0 ? across : across.clone().multiplyScalar(r1 > r2 ? 1 : -1),
      to_second = ratio < 0 ? across.clone().negate() : to_first;
    this.wheel(first, to_first, r1, n1, 0, ratio > 0 && r1 > r2);
    this.wheel(second, to_second, r2, n2, 0.5, ratio > 0 && r2 > r1);
  }

  private teeth(r: number) {
    return Math.min(most_teeth, Math.max(fewest_teeth, Math.round((2 * Math.PI * r) / (1.8 * this.radius))));
  }

  /** Half of its thickness: that of the body, where the body is as large as the wheel. */
  private thickness({ body, joint }: Shaft, r: number) {
    const { half, mark } = this.run.meta.bodies[body],
      along = joint.axis_second.reduce((sum, a, i) => sum + Math.abs(a) * half[i], 0);
    const widest = Math.max(...half);
    return !mark && widest > 0.6 * r && along < 0.9 * r
      ? 1.04 * along
      : Math.min(0.7 * this.radius, 0.25 * r);
  }

  /** `towards`: where a tooth is at the start, or, by `phase`, a part of the pitch beside it. `is_ring`: teeth inside. */
  private wheel(shaft: Shaft, towards: Vector3, r: number, n: number, phase: number, is_ring = false) {
    const { body } = shaft,
      back = this.poses.matrices[body].clone().invert(),
      axis = shaft.axis.clone().transformDirection(back),
      e1 = towards.clone().transformDirection(back);
    e1.addScaledVector(axis, -e1.dot(axis)).normalize();
    const e2 = new Vector3().crossVectors(axis, e1),
      centre = shaft.at.clone().applyMatrix4(back),
      colour = new Color(this.run.meta.bodies[body].color ?? body_colour(body)),
      pitch = (2 * Math.PI * r) / n,
      height = 0.3 * pitch,
      thick = this.thickness(shaft, r);
    for (let k = 0; k < n; ++k) {
      const angle = (2 * Math.PI * (k + phase)) / n,
        out = e1.clone().multiplyScalar(Math.cos(angle)).addScaledVector(e2, Math.sin(angle));
      this.block(body, colour, centre, out, axis, r, [height, 0.23 * pitch, thick]);
      if (is_ring) this.block(body, colour, centre, out, axis, r + 2 * height, [height, 0.53 * pitch, thick]);
    }
    if (is_ring) return;
    const local = new Matrix4()
      .makeBasis(e1, e2, axis)
      .setPosition(centre)
      .scale(new Vector3(r - 0.6 * height, r - 0.6 * height, 0.8 * thick));
    this.put("cylinder", { body, colour, local });
  }

  /** A box at a distance from a centre, with its sides along `out`, across, and along the axis. */
  private block(
    body: number,
    colour: Color,
    centre: Vector3,
    out: Vector3,
    axis: Vector3,
    distance: number,
    half: [number, number, number],
  ) {
    const local = new Matrix4()
      .makeBasis(out, new Vector3().crossVectors(axis, out), axis)
      .setPosition(centre.clone().addScaledVector(out, distance))
      .scale(new Vector3(...half));
    this.put("box", { body, colour, local });
  }

  private add_rack(joint: Joint) {
    const pinion = this.shaft(joint, joint.first, joint.point_first, "angle"),
      rack = this.shaft(joint, joint.second, joint.point_second, "displacement");
    if (!pinion || !rack || pinion.body === rack.body) return;
    const ratio = this.ratio(pinion, rack, "displacement"),
      r = Math.abs(ratio);
    const out = new Vector3().crossVectors(rack.axis, pinion.axis).multiplyScalar(Math.sign(ratio));
    if (!(r > 0) || !Number.isFinite(r) || out.lengthSq() < 0.9) return;
    out.normalize();
    const n = this.teeth(r),
      pitch = (2 * Math.PI * r) / n,
      height = 0.3 * pitch,
      thick = this.thickness(pinion, r);
    this.wheel(pinion, out, r, n, 0);
    // How far the rack goes, so that there is always a part of it at the wheel.
    const channel = this.run.channel("joint", rack.index, "displacement"),
      { motion, curves } = this.run,
      from = curves.at(channel, motion.start);
    let low = 0,
      high = 0;
    for (let k = 0; k <= looks; ++k) {
      const gone = curves.at(channel, motion.start + (k / looks) * (motion.end - motion.start)) - from;
      low = Math.min(low, gone);
      high = Math.max(high, gone);
    }
    const back = this.poses.matrices[rack.body].clone().invert(),
      contact = pinion.at.clone().addScaledVector(out, r).applyMatrix4(back),
      along = rack.axis.clone().transformDirection(back),
      outwards = out.clone().transformDirection(back),
      axis = new Vector3().crossVectors(along, outwards),
      colour = new Color(this.run.meta.bodies[rack.body].color ?? body_colour(rack.body)),
      first = Math.floor(-high / pitch) - 4,
      last = Math.ceil(-low / pitch) + 4;
    if (last - first > 400) return;
    for (let k = first; k < last; ++k)
      this.block(
        rack.body,
        colour,
        contact.clone().addScaledVector(along, (k + 0.5) * pitch),
        outwards,
        axis,
        0,
        [height, 0.23 * pitch, thick],
      );
    const middle = contact.addScaledVector(along, 0.5 * (first + last) * pitch);
    this.block(rack.body, colour, middle, outwards, axis, 2 * height, [
      height,
      0.5 * (last - first) * pitch,
      thick,
    ]);
  }
}
