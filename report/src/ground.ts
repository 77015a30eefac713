// SPDX-License-Identifier: BSD-3-Clause
// What a place is told by: a grid below everything, and the frames of bodies and world.
import { BufferAttribute, BufferGeometry, Color, LineBasicMaterial, LineSegments, Vector3 } from "three";
import { Poses } from "./instances";
import { nice } from "./text";
import { theme } from "./theme";

/** The ground: its axes, its middle, half of its sides. */
export interface Plane {
  x: Vector3;
  y: Vector3;
  up: Vector3;
  middle: Vector3;
  half: [number, number];
}

/** Cells of a round number of metres under all points; `floor`: a height that it does not lie above;
 *  `stated`: where it lies, if there is a floor. */
export function make_grid(
  points: Float32Array,
  up: Vector3,
  size: number,
  floor: number,
  stated: number | null,
): { object: LineSegments; cell: number; plane: Plane } {
  const cell = nice(size / 2.5),
    seed = Math.abs(up.y) < 0.9 ? new Vector3(0, 1, 0) : new Vector3(0, 0, 1);
  const x = new Vector3().crossVectors(seed, up).normalize(),
    y = new Vector3().crossVectors(up, x),
    p = new Vector3();
  const low = [Infinity, Infinity, floor],
    high = [-Infinity, -Infinity];
  for (let i = 0; i < points.length; i += 3) {
    p.fromArray(points, i);
    [x, y, up].forEach((axis, k) => {
      low[k] = Math.min(low[k], p.dot(axis));
    });
    [x, y].forEach((axis, k) => {
      high[k] = Math.max(high[k], p.dot(axis));
    });
  }
  const from = [0, 1].map((k) => Math.floor(low[k] / cell) - 1),
    to = [0, 1].map((k) => Math.ceil(high[k] / cell) + 1);
  const lines: number[] = [],
    height = stated === null ? low[2] - 0.002 * size : stated + 0.001 * size; // what rests on it does not flicker
  const at = (a: number, b: number) =>
    new Vector3()
      .addScaledVector(x, a * cell)
      .addScaledVector(y, b * cell)
      .addScaledVector(up, height);
  const put = (a: number, b: number) => lines.push(...at(a, b).toArray());
  for (let i = from[0]; i <= to[0]; ++i) for (const j of [from[1], to[1]]) put(i, j);
  for (let j = from[1]; j <= to[1]; ++j) for (const i of [from[0], to[0]]) put(i, j);
  const geometry = new BufferGeometry().setAttribute(
    "position",
    new BufferAttribute(Float32Array.from(lines), 3),
  );
  const middle = at((from[0] + to[0]) / 2, (from[1] + to[1]) / 2),
    half: [number, number] = [((to[0] - from[0]) * cell) / 2, ((to[1] - from[1]) * cell) / 2];
  return {
    object: new LineSegments(geometry, new LineBasicMaterial({ color: theme().grid })),
    cell,
    plane: { x, y, up, middle, half },
  };
}

export class Frames {
  readonly objects: LineSegments[];
  private readonly positions: BufferAttribute;

  /** `length`: of a body's axes, m; those of the world are longer. */
  constructor(
    private readonly n: number,
    private readonly length: number,
  ) {
    const colours = new Float32Array(18 * (n + 1)),
      axes = theme().axes.map((c) => new Color(c));
    for (let i = 0; i < 6 * (n + 1); ++i) axes[Math.floor(i / 2) % 3].toArray(colours, 3 * i);
    this.positions = new BufferAttribute(new Float32Array(18 * (n + 1)), 3);
    const geometry = new BufferGeometry()
      .setAttribute("position", this.positions)
      .setAttribute("color", new BufferAttribute(colours, 3));
    const object = new LineSegments(
      geometry,
      new LineBasicMaterial({ vertexColors: true, depthTest: false }),
    );
    object.frustumCulled = false;
    object.renderOrder = 2;
    this.objects = [object];
  }
  move({ X }: Poses, is_shown: boolean) {
    this.objects[0].visible = is_shown;
    if (!is_shown) return;
    const a = this.positions.array;
    for (let b = 0; b <= this.n; ++b)
      for (let i = 0; i < 3; ++i)
        for (let k = 0; k < 3; ++k) {
          const is_world = b === this.n,
            from = is_world ? 0 : X[12 * b + k],
            way = is_world ? (i === k ? 1.5 : 0) : X[12 * b + 3 + 3 * i + k];
          a[18 * b + 6 * i + k] = from;
          a[18 * b + 6 * i + 3 + k] = from + this.length * way;
        }
    this.positions.needsUpdate = true;
  }
}
