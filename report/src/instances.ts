// SPDX-License-Identifier: BSD-3-Clause
// What everything in the picture is drawn with: many of one form in one call.
import { BufferGeometry, Color, DynamicDrawUsage, InstancedMesh, Material, Matrix4, Vector3 } from "three";
import { LineMaterial } from "three/examples/jsm/lines/LineMaterial.js";
import { LineSegments2 } from "three/examples/jsm/lines/LineSegments2.js";
import { LineSegmentsGeometry } from "three/examples/jsm/lines/LineSegmentsGeometry.js";
import type { Joint, Vector } from "./data";

export const unit_z = new Vector3(0, 0, 1);
export const vector = (v: Vector) => new Vector3(...v);

/** A form on a body (-1: the world), at a place in its coordinates. */
export interface Place {
  body: number;
  local: Matrix4;
  colour?: Color;
  joint?: Joint; // whose part it is: it is seen while that acts
}

/** Where everything is at an instant. */
export class Poses {
  readonly matrices: Matrix4[];
  readonly X: Float64Array;
  constructor(n: number) {
    this.matrices = Array.from({ length: n }, () => new Matrix4());
    this.X = new Float64Array(12 * n);
  }
  /** After X has been filled in. */
  update() {
    this.matrices.forEach((m, b) => pose_of(this.X, b, m));
  }
  place(body: number, point: Vector3) {
    return body < 0 ? point.clone() : point.clone().applyMatrix4(this.matrices[body]);
  }
}

export function pose_of(X: Float64Array, b: number, into: Matrix4) {
  const x = X.subarray(12 * b, 12 * b + 12);
  // prettier-ignore
  return into.set(x[3], x[6], x[9], x[0], x[4], x[7], x[10], x[1], x[5], x[8], x[11], x[2], 0, 0, 0, 1);
}

export const acts = ({ from, until }: Joint, t: number) =>
  (from ?? -Infinity) <= t && t < (until ?? Infinity);
const nothing = new Matrix4().makeScale(0, 0, 0);

export class Instances {
  readonly mesh: InstancedMesh;
  private readonly now = new Matrix4();
  constructor(
    geometry: BufferGeometry,
    material: Material,
    private readonly places: Place[],
  ) {
    this.mesh = new InstancedMesh(geometry, material, places.length);
    this.mesh.instanceMatrix.setUsage(DynamicDrawUsage);
    this.mesh.frustumCulled = false;
    places.forEach(({ local, colour }, i) => {
      this.mesh.setMatrixAt(i, local);
      if (colour) this.mesh.setColorAt(i, colour);
    });
  }
  move({ matrices }: Poses, t = NaN) {
    this.places.forEach(({ body, local, joint }, i) => {
      const is_timed = joint && ((joint.from ?? null) !== null || (joint.until ?? null) !== null);
      if (is_timed && !acts(joint, t)) this.mesh.setMatrixAt(i, nothing);
      else if (is_timed && body < 0) this.mesh.setMatrixAt(i, local);
      else if (body >= 0) this.mesh.setMatrixAt(i, this.now.multiplyMatrices(matrices[body], local));
    });
    this.mesh.instanceMatrix.needsUpdate = true;
  }
}

/** Lines instead of triangles: three has no instanced lines, but draws whatever says that it is both. */
export function as_lines(instances: Instances) {
  Object.assign(instances.mesh, { isMesh: false, isLine: true, isLineSegments: true });
  return instances;
}

/** Wide lines whose points may change from frame to frame. */
export class Lines {
  readonly object: LineSegments2;
  readonly positions: Float32Array; // from, to
  private readonly geometry = new LineSegmentsGeometry();
  private readonly buffer: { array: Float32Array; needsUpdate: boolean };

  constructor(count: number, width: number, opacity: number, colours: Float32Array | Color) {
    this.geometry.setPositions(new Float32Array(6 * Math.max(count, 1)));
    const is_one = colours instanceof Color;
    if (!is_one) this.geometry.setColors(colours);
    const material = new LineMaterial({
      linewidth: width,
      transparent: true,
      opacity,
      vertexColors: !is_one,
      depthWrite: false,
    });
    if (is_one) material.color = colours;
    this.object = new LineSegments2(this.geometry, material);
    this.object.frustumCulled = false;
    this.buffer = (this.geometry.attributes.instanceStart as unknown as { data: Lines["buffer"] }).data;
    this.positions = this.buffer.array;
  }
  update(count: number) {
    this.buffer.needsUpdate = true;
    this.geometry.instanceCount = count;
    this.object.visible = count > 0;
  }
}
