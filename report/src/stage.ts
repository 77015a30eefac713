// SPDX-License-Identifier: BSD-3-Clause
// The picture in space. Few draw calls, however many bodies there are.
import { DirectionalLight, HemisphereLight, Object3D, Scene, Vector3, WebGLRenderer } from "three";
import { extent_of, floor_of, make_bodies, with_room } from "./bodies";
import { Eye } from "./camera";
import { Arrows, Beads, Springs, Torques } from "./forces";
import { Frames, make_grid } from "./ground";
import { Poses, vector, type Instances } from "./instances";
import { Joints } from "./joints";
import type { Run } from "./run";
import { Shadow, casts } from "./shadow";
import { Slots } from "./slots";
import { Trails } from "./trails";

const few = 4; // bodies, with which details go by the size of everything

export interface Shown {
  trails: boolean;
  forces: boolean;
  joints: boolean;
  frames: boolean;
  names: boolean;
  other: boolean;
}

export class Stage {
  readonly renderer: WebGLRenderer;
  readonly eye: Eye;
  readonly cell: number; // of the grid, m
  readonly leaving: string[]; // bodies that go out of the picture
  shown: Shown = { trails: true, forces: true, joints: true, frames: false, names: true, other: true };
  after_draw = () => {};
  private readonly scene = new Scene();
  private readonly poses: Poses;
  private readonly bodies: Instances[];
  private readonly shadow: Shadow;
  private readonly joints: Joints;
  private readonly trails: Trails;
  private readonly arrows: Arrows;
  private readonly springs: Springs;
  private readonly torques: Torques;
  private readonly slots: Slots;
  private readonly frames: Frames;
  private readonly beads: Beads;
  private other: { layers: Instances[]; run: Run; poses: Poses } | null = null;
  private now = NaN;

  /** Throws where there is no WebGL. */
  constructor(
    private readonly canvas: HTMLCanvasElement,
    private readonly run: Run,
  ) {
    this.renderer = new WebGLRenderer({ canvas, antialias: true, alpha: true, preserveDrawingBuffer: true });
    const extent = extent_of(run),
      points = extent.near,
      size = half_diagonal(points),
      { bodies } = run.meta;
    const halves = bodies.map((b) => Math.hypot(...b.half)).sort((a, b) => a - b);
    const detail = bodies.length < few ? size : Math.min(size, 2.25 * halves[halves.length >> 1]);
    this.poses = new Poses(bodies.length);
    this.leaving = extent.leaving;
    this.bodies = make_bodies(run, false);
    this.joints = new Joints(run, 0.02 * detail);
    this.trails = new Trails(run);
    this.arrows = new Arrows(run, 0.5 * detail);
    this.eye = new Eye(with_room(extent, run, this.arrows), run.up, () => this.draw());
    this.eye.listen(canvas);
    this.springs = new Springs(run, 0.045 * detail);
    this.torques = new Torques(run, 0.17 * detail);
    this.slots = new Slots(run);
    this.frames = new Frames(bodies.length, 0.16 * detail);
    this.beads = new Beads(run, 0.022 * detail);
    const grid = make_grid(points, run.up, size, this.joints.floor, floor_of(run, points));
    this.cell = grid.cell;
    this.shadow = new Shadow(grid.plane, 2.5 * size + grid.cell);
    for (const { mesh } of this.bodies) if (mesh.isMesh && !mesh.userData.is_still) mesh.layers.enable(casts);
    this.scene.add(
      grid.object,
      this.shadow.object,
      ...lights(run.up),
      ...this.bodies.map((layer) => layer.mesh),
    );
    for (const part of [
      this.joints,
      this.trails,
      this.arrows,
      this.torques,
      this.springs,
      this.slots,
      this.frames,
      this.beads,
    ]) {
      const objects: Object3D[] = part.objects;
      if (objects.length) this.scene.add(...objects);
    }
  }

  /** Another run, as a ghost. */
  compare(run: Run | null) {
    for (const layer of this.other?.layers ?? []) this.scene.remove(layer.mesh);
    this.other = run && { layers: make_bodies(run, true), run, poses: new Poses(run.motion.bodies) };
    for (const layer of this.other?.layers ?? []) this.scene.add(layer.mesh);
    if (Number.isFinite(this.now)) this.show(this.now);
  }

  /** `above`, `below`: pixels for what is written over the picture. */
  resize(width: number, height: number, above: number, below: number) {
    const share = (pixels: number) => Math.min(Math.max(pixels / Math.max(height, 1), 0.05), 0.22);
    this.renderer.setPixelRatio(Math.min(devicePixelRatio, 2));
    this.renderer.setSize(width, height, false);
    this.eye.resize(width / Math.max(height, 1), share(above), share(below));
  }

  /** To so many pixels, `scale` of them for one of a screen. */
  size_exactly(width: number, height: number, scale: number) {
    const room = 1e-6; // three rounds down
    this.renderer.setPixelRatio(scale);
    this.renderer.setSize((width + room) / scale, (height + room) / scale, false);
    this.eye.resize(width / height, 0.06, 0.06);
    return this.renderer.getContext();
  }

  show(t: number) {
    const { shown, poses, run } = this;
    this.now = t;
    run.motion.at(t, poses.X);
    poses.update();
    for (const layer of this.bodies) layer.move(poses);
    this.joints.move(poses, shown.joints, t);
    this.trails.move(t, shown.trails);
    this.arrows.move(t, poses, shown.forces);
    this.torques.move(t, poses, shown.forces);
    this.springs.move(poses);
    this.slots.move(poses, shown.joints);
    this.frames.move(poses, shown.frames);
    this.beads.move(t);
    if (this.other) {
      this.other.run.motion.at(this.other.run.motion.clamp(t), this.other.poses.X);
      this.other.poses.update();
      for (const layer of this.other.layers) {
        layer.move(this.other.poses);
        layer.mesh.visible = shown.other;
      }
    }
    this.draw();
  }
  /** s: how much of the paths is shown; 0: all. */
  get path_window() {
    return this.trails.window;
  }
  draw() {
    if (!Number.isFinite(this.now)) return;
    this.shadow.draw(this.renderer, this.scene);
    this.renderer.render(this.scene, this.eye.camera);
    this.after_draw();
  }

  bars_at(t: number) {
    return this.joints.bars_at(t);
  }
  /** Where the middle of a body is in a picture of that size; null behind the eye. */
  screen(
    b: number,
    width = this.canvas.clientWidth,
    height = this.canvas.clientHeight,
  ): [number, number] | null {
    const p = this.poses.place(b, vector(this.run.meta.bodies[b].middle)).project(this.eye.camera);
    return p.z > 1 ? null : [((p.x + 1) / 2) * width, ((1 - p.y) / 2) * height];
  }
}

function half_diagonal(points: Float32Array): number {
  const low = new Vector3(Infinity, Infinity, Infinity),
    high = low.clone().negate(),
    p = new Vector3();
  for (let i = 0; i < points.length; i += 3) {
    low.min(p.fromArray(points, i));
    high.max(p);
  }
  return Math.max(low.distanceTo(high) / 2, 1e-12);
}

function lights(up: Vector3): Object3D[] {
  const sun = new DirectionalLight(0xffffff, 2.2),
    fill = new DirectionalLight(0xffffff, 0.6);
  sun.position
    .copy(up)
    .multiplyScalar(2)
    .add(new Vector3(0.8, -1.4, 0.3));
  fill.position.set(-1, 1, 0.2);
  return [new HemisphereLight(0xffffff, 0xc8ccd2, 2.3), sun, fill];
}
