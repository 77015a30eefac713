// SPDX-License-Identifier: BSD-3-Clause
// Forces as arrows, springs as coils, sensors as beads.
import {
  Color,
  ConeGeometry,
  CylinderGeometry,
  DynamicDrawUsage,
  InstancedMesh,
  Matrix4,
  MeshPhongMaterial,
  Object3D,
  Quaternion,
  SphereGeometry,
  TorusGeometry,
  Vector3,
} from "three";
import { Lines, Poses, unit_z, vector } from "./instances";
import type { Run } from "./run";
import { theme } from "./theme";

/** Lengths go by the square root of forces, so that calm phases are seen beside peaks. */
export class Arrows {
  readonly objects: InstancedMesh[];

  /** `longest`: the arrow of the run's largest force, m. */
  constructor(
    private readonly run: Run,
    private readonly longest: number,
  ) {
    const count = Math.max(run.forces.length, 1);
    const material = new MeshPhongMaterial({
      specular: 0x000000,
      depthTest: false,
      depthWrite: false,
      transparent: true,
    });
    const shaft = new CylinderGeometry(1, 1, 1, 12).translate(0, 0.5, 0).rotateX(Math.PI / 2);
    const head = new ConeGeometry(1, 1, 20).translate(0, 0.5, 0).rotateX(Math.PI / 2);
    this.objects = [shaft, head].map((geometry) => new InstancedMesh(geometry, material, count));
    for (const mesh of this.objects) {
      run.forces.forEach((force, i) =>
        mesh.setColorAt(i, new Color(force.kind === "load" ? theme().load : theme().force)),
      );
      mesh.renderOrder = 3; // before what hides where they act
      mesh.frustumCulled = false;
      mesh.instanceMatrix.setUsage(DynamicDrawUsage);
    }
  }

  /** Where each force acts, its direction and the length of its arrow; 0: too small to be drawn. */
  private each(t: number, poses: Poses, act: (i: number, at: Vector3, to: Vector3, length: number) => void) {
    const { forces, largest_force } = this.run,
      f = new Vector3();
    forces.forEach((force, i) => {
      force.at(t, f);
      const size = f.length(),
        length = this.longest * Math.sqrt(size / largest_force);
      if (length > 0.04 * this.longest)
        act(i, poses.place(force.body, force.point), f.divideScalar(size), length);
      else act(i, f, f, 0);
    });
  }

  /** Calls for the ends of all arrows, so that the picture has room for them. */
  each_tip(t: number, poses: Poses, act: (body: number, tip: Vector3) => void) {
    const { forces, largest_force } = this.run;
    if (largest_force > 0)
      this.each(t, poses, (i, at, to, length) => {
        if (length > 0) act(forces[i].body, at.addScaledVector(to, length));
      });
  }

  move(t: number, poses: Poses, is_shown: boolean) {
    const [shaft, head] = this.objects,
      { forces, largest_force } = this.run;
    shaft.visible = head.visible = is_shown && forces.length > 0 && largest_force > 0;
    if (!shaft.visible) return;
    const m = new Matrix4(),
      turn = new Quaternion(),
      r = 0.022 * this.longest,
      none = new Matrix4().makeScale(0, 0, 0);
    this.each(t, poses, (i, at, to, length) => {
      const is_seen = length > 0,
        tip = Math.min(6 * r, 0.5 * length);
      if (is_seen) turn.setFromUnitVectors(unit_z, to);
      shaft.setMatrixAt(i, is_seen ? m.compose(at, turn, new Vector3(r, r, length - tip)) : none);
      at.addScaledVector(to, length - tip);
      head.setMatrixAt(i, is_seen ? m.compose(at, turn, new Vector3(2.6 * r, 2.6 * r, tip)) : none);
    });
    for (const mesh of this.objects) mesh.instanceMatrix.needsUpdate = true;
  }
}

/** Torques: arrows that go round, right-handed, larger by the square root as well. */
export class Torques {
  readonly objects: InstancedMesh[];

  /** `largest`: the radius of the run's largest torque, m. */
  constructor(
    private readonly run: Run,
    private readonly largest: number,
  ) {
    const arc = 1.55 * Math.PI,
      tip = new ConeGeometry(0.17, 0.5, 16).rotateZ(0).translate(1, 0.2, 0).rotateZ(arc),
      material = new MeshPhongMaterial({
        specular: 0x000000,
        color: theme().load,
        depthTest: false,
        depthWrite: false,
        transparent: true,
      });
    const count = run.torques.length;
    this.objects = count
      ? [new TorusGeometry(1, 0.055, 8, 40, arc), tip].map((g) => new InstancedMesh(g, material, count))
      : [];
    for (const mesh of this.objects) {
      mesh.renderOrder = 3;
      mesh.frustumCulled = false;
      mesh.instanceMatrix.setUsage(DynamicDrawUsage);
    }
  }

  move(t: number, poses: Poses, is_shown: boolean) {
    const { torques, largest_torque } = this.run,
      torque = new Vector3(),
      m = new Matrix4(),
      turn = new Quaternion();
    for (const mesh of this.objects) mesh.visible = is_shown && largest_torque > 0;
    if (!this.objects.length || !this.objects[0].visible) return;
    torques.forEach(({ at, body, point }, i) => {
      at(t, torque);
      const size = torque.length(),
        radius = this.largest * Math.sqrt(size / largest_torque),
        is_seen = radius > 0.08 * this.largest;
      if (is_seen) {
        turn.setFromUnitVectors(unit_z, torque.divideScalar(size));
        m.compose(poses.place(body, point), turn, new Vector3(radius, radius, radius));
      } else m.makeScale(0, 0, 0);
      for (const mesh of this.objects) mesh.setMatrixAt(i, m);
    });
    for (const mesh of this.objects) mesh.instanceMatrix.needsUpdate = true;
  }
}

const turns = 14,
  per_turn = 14;

export class Springs {
  readonly objects: Object3D[];
  private readonly lines: Lines;
  constructor(
    private readonly run: Run,
    private readonly radius: number,
  ) {
    this.lines = new Lines(run.springs.length * turns * per_turn, 2.2, 1, new Color(theme().spring));
    this.objects = [this.lines.object];
  }
  move(poses: Poses) {
    const p = new Vector3(),
      last = new Vector3(),
      { positions } = this.lines,
      steps = turns * per_turn;
    let k = 0;
    for (const spring of this.run.springs) {
      const a = poses.place(spring.first, vector(spring.point_first!)),
        along = poses.place(spring.second, vector(spring.point_second!)).sub(a);
      const seed = Math.abs(along.z) < 0.9 * along.length() ? unit_z : new Vector3(1, 0, 0);
      const u = new Vector3().crossVectors(along, seed).normalize(),
        v = new Vector3().crossVectors(along, u).normalize();
      last.copy(a);
      for (let s = 1; s <= steps; ++s, ++k) {
        const share = s / steps,
          angle = (2 * Math.PI * s) / per_turn,
          r = share > 0.1 && share < 0.9 ? this.radius : 0;
        p.copy(a)
          .addScaledVector(along, share)
          .addScaledVector(u, r * Math.cos(angle))
          .addScaledVector(v, r * Math.sin(angle));
        last.toArray(positions, 6 * k);
        p.toArray(positions, 6 * k + 3);
        last.copy(p);
      }
    }
    this.lines.update(k);
  }
}

/** Where sensors at points read. */
export class Beads {
  readonly objects: InstancedMesh[];
  constructor(
    private readonly run: Run,
    radius: number,
  ) {
    const mesh = new InstancedMesh(
      new SphereGeometry(radius, 16, 12),
      new MeshPhongMaterial({ color: theme().sensor }),
      Math.max(run.sensor_points.length, 1),
    );
    mesh.frustumCulled = false;
    this.objects = run.sensor_points.length ? [mesh] : [];
  }
  move(t: number) {
    this.run.sensor_points.forEach(([x, y, z], i) => {
      const at = (channel: number) => this.run.curves.at(channel, t);
      this.objects[0].setMatrixAt(i, new Matrix4().makeTranslation(at(x), at(y), at(z)));
      this.objects[0].instanceMatrix.needsUpdate = true;
    });
  }
}
