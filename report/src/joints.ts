// SPDX-License-Identifier: BSD-3-Clause
// Joints by kind along their axes, on feet where they hold to the world; sticks of bodies without a shape.
import {
  BoxGeometry,
  BufferGeometry,
  Color,
  CylinderGeometry,
  InstancedMesh,
  Matrix4,
  MeshPhongMaterial,
  Object3D,
  Quaternion,
  SphereGeometry,
  Vector3,
} from "three";
import { Couplings } from "./couplings";
import type { Joint, On } from "./data";
import { has_foot, pieces_of, type Part, type Piece } from "./glyphs";
import { Instances, Poses, acts, unit_z, vector, type Place } from "./instances";
import type { Run } from "./run";
import { body_colour, theme } from "./theme";

const foot_height = 3.5; // radii
const many = 30; // joints that are drawn with fewer sides

/** Between two points; a rope has one for each of its spans. */
interface Bar {
  joint?: Joint; // none: always there
  first: number;
  second: number;
  a: Vector3;
  b: Vector3;
  thick: number; // radii
}

export class Joints {
  readonly objects: Object3D[] = [];
  private readonly places: Record<Part, Place[]> = { box: [], cylinder: [], ball: [] };
  private readonly layers: Instances[] = [];
  private readonly bars: Bar[] = [];
  private bar_mesh: InstancedMesh | null = null;
  private readonly grey = new Color(theme().joint);
  private readonly fixed = new Color(theme().foot);

  /** `radius`: of a pin, m. */
  constructor(
    private readonly run: Run,
    private readonly radius: number,
  ) {
    this.add_joints();
    this.add_sticks();
    new Couplings(run, radius, (part, place) => this.places[part].push(place));
    const sides = run.meta.joints.length > many ? 10 : 28;
    const forms: Record<Part, BufferGeometry> = {
      box: new BoxGeometry(2, 2, 2),
      cylinder: new CylinderGeometry(1, 1, 2, sides).rotateX(Math.PI / 2),
      ball: new SphereGeometry(1, sides, sides / 2),
    };
    const material = new MeshPhongMaterial({ specular: 0x222222, shininess: 40 });
    for (const part of Object.keys(forms) as Part[])
      if (this.places[part].length) this.layers.push(new Instances(forms[part], material, this.places[part]));
    if (this.bars.length) {
      this.bar_mesh = new InstancedMesh(
        forms.cylinder,
        new MeshPhongMaterial({ color: this.grey }),
        this.bars.length,
      );
      this.bar_mesh.frustumCulled = false;
      this.objects.push(this.bar_mesh);
    }
    this.objects.push(...this.layers.map((layer) => layer.mesh));
  }

  private put(piece: Piece, body: number, at: Vector3, axis: Vector3, colour: Color, joint?: Joint) {
    const turn = new Quaternion().setFromUnitVectors(
      unit_z,
      axis.lengthSq() > 0 ? axis.clone().normalize() : unit_z,
    );
    const aside = new Vector3(...(piece.at ?? [0, 0, 0])).multiplyScalar(this.radius).applyQuaternion(turn);
    const local = new Matrix4().compose(
      at.clone().add(aside),
      turn,
      new Vector3(...piece.half).multiplyScalar(this.radius),
    );
    this.places[piece.part].push({ body, colour, local, joint });
  }

  private add_joints() {
    const { run, grey, fixed } = this;
    for (const joint of run.meta.joints) {
      const first = vector(joint.point_first),
        second = vector(joint.point_second);
      for (const piece of pieces_of(joint.type)) {
        if (piece.on === "first")
          this.put(
            piece,
            joint.first,
            first,
            vector(joint.axis_first),
            joint.first < 0 ? fixed : grey,
            joint,
          );
        else this.put(piece, joint.second, second, vector(joint.axis_second), grey, joint);
      }
      if (joint.first < 0 && has_foot(joint.type)) {
        this.put({ part: "cylinder", half: [0.55, 0.55, 1.5], at: [0, 0, -1.5] }, -1, first, run.up, fixed);
        this.put({ part: "box", half: [2.4, 2.4, 0.3], at: [0, 0, -3.2] }, -1, first, run.up, fixed);
      }
      if (joint.bar)
        this.bars.push({ joint, first: joint.first, second: joint.second, a: first, b: second, thick: 0.6 });
      this.add_rope(joint.over, joint);
    }
    for (const load of run.meta.loads) this.add_rope(load.over);
    for (const load of run.meta.loads)
      if (load.type === "bushing" && load.place)
        for (const piece of pieces_of("bushing"))
          this.put(piece, load.first, vector(load.place), run.up, piece.half[0] > 2 ? fixed : grey);
    for (const spring of run.springs)
      if (spring.second < 0)
        this.put({ part: "box", half: [1.4, 1.4, 1.4] }, -1, vector(spring.point_second!), run.up, fixed);
  }

  /** A thin bar for each span, and an eye where it is held or turns. */
  private add_rope(over: On[] = [], joint?: Joint) {
    over.forEach(({ body, point }, k) => {
      const b = vector(point),
        before = over[k - 1],
        eye: Piece = { part: "ball", half: [0.6, 0.6, 0.6] };
      this.put(eye, body, b, this.run.up, body < 0 ? this.fixed : this.grey, joint);
      if (before)
        this.bars.push({ joint, first: before.body, second: body, a: vector(before.point), b, thick: 0.3 });
    });
  }

  /** From the centre of a body that has no shape to what holds it. */
  private add_sticks() {
    const { bodies, length } = this.run.meta,
      thick = 0.45 * this.radius;
    for (const { body: b, point } of this.run.attachments) {
      const body = bodies[b];
      if (!body.mark || body.point) continue;
      const centre = vector(body.centre),
        arm = point.clone().sub(centre),
        size = arm.length();
      if (size < 1e-9 * length) continue;
      const turn = new Quaternion().setFromUnitVectors(unit_z, arm.clone().normalize());
      const local = new Matrix4().compose(
        centre.addScaledVector(arm, 0.5),
        turn,
        new Vector3(thick, thick, size / 2),
      );
      this.places.cylinder.push({ body: b, colour: new Color(body.color ?? body_colour(b)), local });
    }
  }

  /** The height of what the feet stand on; infinite where there are none. */
  get floor(): number {
    const { meta, up } = this.run,
      standing = meta.joints.filter((joint) => joint.first < 0 && has_foot(joint.type));
    return Math.min(
      ...standing.map((joint) => vector(joint.point_first).dot(up) - foot_height * this.radius),
    );
  }
  /** Bars between points that act. */
  bars_at(t: number) {
    return this.bars.filter(({ joint }) => !joint || acts(joint, t)).length;
  }
  move(poses: Poses, is_shown: boolean, t: number) {
    for (const object of this.objects) object.visible = is_shown;
    if (!is_shown) return;
    for (const layer of this.layers) layer.move(poses, t);
    const m = new Matrix4(),
      r = this.radius;
    this.bars.forEach((bar, i) => {
      const { joint, first, second, a, b } = bar,
        from = poses.place(first, a),
        arm = poses.place(second, b).sub(from),
        thick = !joint || acts(joint, t) ? bar.thick * r : 0,
        length = arm.length();
      const turn = new Quaternion().setFromUnitVectors(
        unit_z,
        length > 0 ? arm.clone().divideScalar(length) : unit_z,
      );
      this.bar_mesh!.setMatrixAt(
        i,
        m.compose(from.addScaledVector(arm, 0.5), turn, new Vector3(thick, thick, thick && length / 2)),
      );
    });
    if (this.bar_mesh) this.bar_mesh.instanceMatrix.needsUpdate = true;
  }
}
