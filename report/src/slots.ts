// SPDX-License-Identifier: BSD-3-Clause
// Slots: of the curve that a point slides along, the part that it travels.
import { Color, Object3D, Vector3 } from "three";
import { Lines, Poses, vector } from "./instances";
import type { Run } from "./run";
import { theme } from "./theme";

const steps = 240;

export class Slots {
  readonly objects: Object3D[] = [];
  private readonly curves: { body: number; points: Vector3[] }[] = [];
  private readonly lines: Lines | null = null;

  constructor(run: Run) {
    const slots = run.meta.joints.filter((joint) => joint.type === "slot");
    if (!slots.length) return;
    const { motion } = run,
      poses = new Poses(motion.bodies);
    this.curves = slots.map((slot) => ({ body: slot.first, points: [] }));
    for (let k = 0; k <= steps; ++k) {
      motion.at(motion.start + (k / steps) * (motion.end - motion.start), poses.X);
      poses.update();
      slots.forEach((slot, i) => {
        const at = poses.place(slot.second, vector(slot.point_second));
        if (slot.first >= 0) at.applyMatrix4(poses.matrices[slot.first].clone().invert());
        this.curves[i].points.push(at);
      });
    }
    this.lines = new Lines(slots.length * steps, 7, 0.6, new Color(theme().joint));
    this.objects.push(this.lines.object);
  }

  move(poses: Poses, is_shown: boolean) {
    if (!this.lines) return;
    const { positions } = this.lines;
    let k = 0;
    for (const { body, points } of this.curves) {
      const at = points.map((p) => poses.place(body, p));
      for (let s = 0; s < steps; ++s, ++k) {
        at[s].toArray(positions, 6 * k);
        at[s + 1].toArray(positions, 6 * k + 3);
      }
    }
    this.lines.update(is_shown ? k : 0);
  }
}
