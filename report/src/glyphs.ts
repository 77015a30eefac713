// SPDX-License-Identifier: BSD-3-Clause
// Joints by kind, put together from boxes, cylinders and balls. Their own z is the joint's axis; sizes are in units of a
// joint's radius.

export type Part = "box" | "cylinder" | "ball";
export interface Piece {
  part: Part;
  half: [number, number, number]; // of the part from -1 to 1
  at?: [number, number, number];
  on?: "first"; // the body that it is fixed to, with that body's axis; else the second
}

const rail: Piece = { part: "cylinder", half: [0.3, 0.3, 12], on: "first" };
const sheet: Piece = { part: "box", half: [5, 5, 0.12], on: "first" };
const small_ball: Piece = { part: "ball", half: [0.9, 0.9, 0.9] };
const arms: Piece[] = [
  { part: "cylinder", half: [0.5, 0.5, 2.4], on: "first" },
  { part: "cylinder", half: [0.5, 0.5, 2.4] },
];
const disc = (z: number, half: number, radius: number): Piece => ({
  part: "cylinder",
  half: [radius, radius, half],
  at: [0, 0, z],
});

const kinds: Record<string, Piece[]> = {
  revolute: [disc(0, 1.9, 1), disc(-1.9, 0.25, 1.35), disc(1.9, 0.25, 1.35)],
  prismatic: [{ part: "box", half: [1.3, 1.3, 2.2] }, rail],
  cylindrical: [disc(0, 2.2, 1.3), rail],
  screw: [...[-1.6, -0.8, 0, 0.8, 1.6].map((z) => disc(z, 0.25, 1.3)), disc(0, 2.2, 0.9), rail],
  planar: [sheet, disc(0, 0.6, 1)],
  universal: [...arms, small_ball],
  constant_velocity: [disc(0, 0.7, 1.6), { part: "ball", half: [1.2, 1.2, 1.2] }],
  spherical: [{ part: "ball", half: [1.3, 1.3, 1.3] }],
  weld: [{ part: "box", half: [1.1, 1.1, 1.1] }],
  point_on_line: [rail, small_ball],
  point_in_plane: [sheet, small_ball],
  rod: [{ part: "ball", half: [0.8, 0.8, 0.8] }],
  slot: [small_ball],
  parallel_axes: arms,
  perpendicular_axes: arms,
  constant_angle: arms,
  coupling: [], // has no place of its own
  gear: [], // see couplings.ts
  rack_and_pinion: [],
  bushing: [disc(0, 1.3, 2.1), disc(0, 1.6, 1.1)], // a load, drawn as what it is made of
};
/** Joints that stand on a foot where they hold a body to the world. */
const standing = new Set(["revolute", "universal", "spherical", "constant_velocity", "weld"]);

/** A kind that is not known here is a ball. */
export function pieces_of(type: string): Piece[] {
  return Object.hasOwn(kinds, type) ? kinds[type] : [small_ball];
}
export const has_foot = (type: string) => standing.has(type);
