// SPDX-License-Identifier: BSD-3-Clause
// The path of one point of each body, and what of it has just been passed.
import { BufferAttribute, BufferGeometry, Color, LineBasicMaterial, LineSegments, Object3D } from "three";
import { Lines } from "./instances";
import type { Run } from "./run";
import { body_colour } from "./theme";

const most_points = 900; // of a body; fewer where there are many, more where there are few
const most_in_all = 24000;
const most_wide = 4000; // as wide lines, which are triangles
const tail = 0.08; // of the whole: what has just been passed
const sharpest = 0.5; // rad, mean between neighbouring pieces: a path that turns more is not seen by them
const recent_points = 400; // of a path that is too long to be shown whole

export class Trails {
  readonly objects: Object3D[];
  private readonly pieces: Float32Array; // from, to; time by time, so that what was just passed lies together
  private readonly all: Object3D;
  private readonly passed: Lines;
  private readonly steps: number;
  private readonly length: number; // of the tail, in steps
  /** s: what is shown of a path that is too long to be shown whole; 0: all of it. */
  readonly window: number;

  constructor(private readonly run: Run) {
    const { motion } = run,
      n = motion.bodies,
      of_each = (most: number) => Math.floor(most / Math.max(n, 1));
    this.steps =
      motion.end > motion.start
        ? Math.max(60, Math.min(Math.max(most_points, of_each(most_wide)), of_each(most_in_all)))
        : 0;
    this.length = Math.max(1, Math.min(Math.round(tail * this.steps), of_each(most_wide / 2)));
    this.pieces = this.find_pieces();
    const palette = run.meta.bodies.map((body, b) => new Color(body.color ?? body_colour(b))),
      colours = new Float32Array(this.pieces.length);
    for (let s = 0; s < n * this.steps; ++s)
      for (const end of [0, 3]) palette[s % n].toArray(colours, 6 * s + end);
    this.all = this.whole(colours);
    this.passed = new Lines(n * this.length, 3, 0.9, colours.subarray(0, 6 * Math.max(n * this.length, 1)));
    this.objects = [this.all, this.passed.object];
    const element = (motion.end - motion.start) / Math.max(motion.ends.length - 1, 1);
    this.window = this.is_too_sharp() ? (Math.min(recent_points, this.length) * element) / 6 : 0;
  }

  /** Pieces that turn by much from one to the next are chords of something else. */
  private is_too_sharp(): boolean {
    const n = this.run.motion.bodies,
      p = this.pieces;
    let sum = 0,
      count = 0;
    for (let s = 0; s + n < n * this.steps; ++s) {
      const way = (k: number) => [0, 1, 2].map((i) => p[6 * k + 3 + i] - p[6 * k + i]),
        a = way(s),
        b = way(s + n);
      const size = Math.hypot(...a) * Math.hypot(...b);
      if (!(size > 1e-12 * this.run.meta.length ** 2)) continue;
      sum += Math.acos(Math.min(1, Math.max(-1, (a[0] * b[0] + a[1] * b[1] + a[2] * b[2]) / size)));
      ++count;
    }
    return count > 0 && sum / count > sharpest;
  }

  private move_recent(t: number) {
    const { motion, tips } = this.run,
      n = motion.bodies,
      points = Math.min(recent_points, this.length),
      X = new Float64Array(12 * n);
    const { positions } = this.passed,
      from = Math.max(motion.start, t - this.window);
    for (let k = 0; k <= points; ++k) {
      motion.at(from + (k / points) * (t - from), X);
      for (let b = 0; b < n; ++b)
        for (let i = 0; i < 3; ++i) {
          const o = 12 * b + i,
            [u, v, w] = tips[b],
            x = X[o] + X[o + 3] * u + X[o + 6] * v + X[o + 9] * w;
          if (k < points) positions[6 * (n * k + b) + i] = x;
          if (k > 0) positions[6 * (n * (k - 1) + b) + 3 + i] = x;
        }
    }
    this.passed.update(t > from ? n * points : 0);
  }

  private find_pieces(): Float32Array {
    const { motion, tips } = this.run,
      n = motion.bodies,
      X = new Float64Array(12 * n);
    const pieces = new Float32Array(6 * Math.max(n * this.steps, 1)),
      last = new Float32Array(3 * n);
    for (let k = 0; k <= this.steps && this.steps > 0; ++k) {
      motion.at(motion.start + (k / this.steps) * (motion.end - motion.start), X);
      for (let b = 0; b < n; ++b)
        for (let i = 0; i < 3; ++i) {
          const o = 12 * b + i,
            [u, v, w] = tips[b],
            x = X[o] + X[o + 3] * u + X[o + 6] * v + X[o + 9] * w;
          if (k > 0) {
            pieces[6 * (n * (k - 1) + b) + i] = last[3 * b + i];
            pieces[6 * (n * (k - 1) + b) + 3 + i] = x;
          }
          last[3 * b + i] = x;
        }
    }
    return pieces;
  }

  private whole(colours: Float32Array): Object3D {
    const count = this.run.motion.bodies * this.steps;
    if (count <= most_wide) {
      const wide = new Lines(count, 1.4, 0.45, colours);
      wide.positions.set(this.pieces);
      wide.update(count);
      return wide.object;
    }
    const geometry = new BufferGeometry();
    geometry
      .setAttribute("position", new BufferAttribute(this.pieces, 3))
      .setAttribute("color", new BufferAttribute(colours, 3));
    return new LineSegments(
      geometry,
      new LineBasicMaterial({ vertexColors: true, transparent: true, opacity: 0.5, depthWrite: false }),
    );
  }

  move(t: number, is_shown: boolean) {
    const { steps, length } = this,
      { start, end, bodies } = this.run.motion;
    this.all.visible = is_shown && steps > 0 && this.window === 0;
    if (is_shown && this.window > 0) return this.move_recent(t);
    if (!this.all.visible) return this.passed.update(0);
    const last = Math.round(((t - start) / (end - start)) * steps),
      first = Math.max(0, last - length);
    this.passed.positions.set(this.pieces.subarray(6 * bodies * first, 6 * bodies * last));
    this.passed.update(bodies * (last - first));
  }
}
