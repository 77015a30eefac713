// SPDX-License-Identifier: BSD-3-Clause
// Slots: the whole curve that a point slides along; of files without it, the part that is travelled.
import { Color, Object3D, Vector3 } from "three";
import type { Joint } from "./data";
import { Lines, Poses, vector } from "./instances";
import type { Run } from "./run";
import { theme } from "./theme";

const steps = 240;

export class Slots {
  readonly objects: Object3D[] = [];
  private readonly curves: { body: number; points: Vector3[] }[] = [];
  private readonly lines: Lines | null = null;

  constructor(private readonly run: Run) {
    const slots = run.meta.joints.filter((joint) => joint.type === "slot");
    if (!slots.length) return;
    this.curves = slots.map((slot) => ({
      body: slot.first,
      points: slot.path?.length ? slot.path.map(vector) : this.travelled(slot),
    }));
    const pieces = this.curves.reduce((n, { points }) => n + points.length - 1, 0);
    this.lines = new Lines(pieces, 7, 0.6, new Color(theme().joint));
    this.objects.push(this.lines.object);
  }

  private travelled(slot: Joint): Vector3[] {
    const { motion } = this.run,
      poses = new Poses(motion.bodies);
    return Array.from({ length: steps + 1 }, (_, k) => {
      motion.at(motion.start + (k / steps) * (motion.end - motion.start), poses.X);
      poses.update();
      const at = poses.place(slot.second, vector(slot.point_second));
      return slot.first >= 0 ? at.applyMatrix4(poses.matrices[slot.first].clone().invert()) : at;
    });
  }

  move(poses: Poses, is_shown: boolean) {
    if (!this.lines) return;
    const { positions } = this.lines;
    let k = 0;
    for (const { body, points } of this.curves) {
      const at = points.map((p) => poses.place(body, p));
      for (let s = 0; s + 1 < at.length; ++s, ++k) {
        at[s].toArray(positions, 6 * k);
        at[s + 1].toArray(positions, 6 * k + 3);
      }
    }
    this.lines.update(is_shown ? k : 0);
  }
}
