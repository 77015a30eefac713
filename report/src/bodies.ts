// SPDX-License-Identifier: BSD-3-Clause
// Bodies by their surfaces, and how far they reach through the motion.
import {
  Box3,
  BufferAttribute,
  BufferGeometry,
  Color,
  DoubleSide,
  EdgesGeometry,
  InstancedBufferAttribute,
  LineBasicMaterial,
  Material,
  Matrix4,
  MeshPhongMaterial,
  Vector3,
} from "three";
import type { Piece } from "./data";
import type { Arrows } from "./forces";
import { Instances, Poses, as_lines, vector } from "./instances";
import type { Run } from "./run";
import { body_colour, theme } from "./theme";

const looks = 1500; // instants that are looked at
const most_looks = 30000; // times bodies
const edge_angle = 28; // degrees between faces

const most_ranks = 12;
const step = 1.5e-6; // of depth, from one rank to the next: some 0.015 % of the distance

/** Where bodies lie in one plane, that of the higher rank is seen, from both sides and at every instant. */
const rank_of = (run: Run, body: number) => body % Math.min(run.meta.bodies.length, most_ranks);

function in_ranks(instances: Instances, ranks: number[]): Instances {
  const { geometry: shared, material } = instances.mesh,
    geometry = new BufferGeometry(); // the same, but for what is its own
  geometry.index = shared.index;
  Object.assign(geometry.attributes, shared.attributes);
  instances.mesh.geometry = geometry;
  geometry.setAttribute("rank", new InstancedBufferAttribute(Float32Array.from(ranks), 1));
  (material as Material).onBeforeCompile = (shader) => {
    shader.vertexShader = `attribute float rank;\n${shader.vertexShader}`.replace(
      "#include <project_vertex>",
      `#include <project_vertex>\n\tgl_Position.z -= ${step.toExponential()} * rank * gl_Position.w;`,
    );
  };
  return instances;
}

/** Forms and their edges; a ghost is what another run is shown as. */
export function make_bodies(run: Run, is_ghost: boolean): Instances[] {
  const layers: Instances[] = [],
    of_bodies = run.meta.bodies.flatMap(({ pieces }, body) => pieces.map((piece) => ({ body, piece }))),
    all = is_ghost ? of_bodies : [...of_bodies, ...run.meta.world.map((piece) => ({ body: -1, piece }))];
  for (let k = 0; k < run.meta.shapes; ++k) {
    const geometry = new BufferGeometry();
    geometry.setAttribute("position", new BufferAttribute(run.array(`points ${k}`) as Float32Array, 3));
    const normals = run.array(`normals ${k}`) as Float32Array;
    geometry.setIndex(new BufferAttribute(run.array(`corners ${k}`) as Uint32Array, 1));
    if (normals.length > 0) geometry.setAttribute("normal", new BufferAttribute(normals, 3));
    else geometry.computeVertexNormals(); // faces that share no corner: each has its own
    const lines = new EdgesGeometry(geometry, edge_angle),
      pieces = all.filter(({ piece }) => piece.shape === k);
    const kind_of = ({ body, piece }: (typeof all)[number]) => `${body < 0} ${piece.opacity}`;
    for (const kind of new Set(pieces.map(kind_of))) {
      const alike = pieces.filter((one) => kind_of(one) === kind),
        { opacity } = alike[0].piece,
        places = alike.map(({ body, piece }) => ({
          body,
          local: place_of(piece),
          colour: new Color(is_ghost ? theme().ghost : (piece.color ?? colour_of(run, body))),
        })),
        ranks = places.map(({ body }) => rank_of(run, body));
      const seen = is_ghost ? 0.4 * opacity : opacity,
        ghostly = seen < 1 ? { transparent: true, opacity: seen, depthWrite: false } : { side: DoubleSide },
        surface = new MeshPhongMaterial({ specular: 0x222222, shininess: 40, ...ghostly }),
        form = in_ranks(new Instances(geometry, surface, places), ranks);
      form.mesh.userData.is_still = places[0].body < 0;
      layers.push(form);
      const edges = new LineBasicMaterial({
        color: theme().edge,
        transparent: true,
        opacity: (is_ghost ? 0.3 : 0.55) * opacity,
      });
      const bare = places.map(({ body, local }) => ({ body, local })),
        above = ranks.map((rank) => rank + 0.5);
      layers.push(as_lines(in_ranks(new Instances(lines, edges, bare), above)));
    }
  }
  return layers;
}

/** From the form between -1 and 1 to where it is on its body. */
function place_of({ middle, half, axes }: Piece): Matrix4 {
  const [x, y, z] = [0, 1, 2].map((i) => new Vector3(...(axes?.slice(3 * i, 3 * i + 3) ?? unit(i))));
  return new Matrix4()
    .makeBasis(x, y, z)
    .setPosition(...middle)
    .scale(vector(half));
}
const unit = (i: number) => [0, 1, 2].map((k) => (k === i ? 1 : 0));

/** Of a body that has none of its own; -1: of the world. */
const colour_of = (run: Run, body: number) =>
  body < 0 ? theme().still : (run.meta.bodies[body].color ?? body_colour(body));

/** Points of a form that reach as far as it does in every direction. */
function corners_of(run: Run, shape: number): Vector3[] {
  const all = run.array(`points ${shape}`),
    points = new Map<string, Vector3>();
  for (let i = 0; i < all.length; i += 3) {
    const p = new Vector3(all[i], all[i + 1], all[i + 2]);
    points.set(
      p
        .toArray()
        .map((x) => x.toFixed(4))
        .join(),
      p,
    );
  }
  if (points.size <= 16) return [...points.values()];
  const far = new Set<Vector3>();
  for (let k = 0; k < 27; ++k) {
    const way = new Vector3((k % 3) - 1, (Math.floor(k / 3) % 3) - 1, Math.floor(k / 9) - 1);
    if (way.lengthSq() > 0)
      far.add([...points.values()].reduce((best, p) => (p.dot(way) > best.dot(way) ? p : best)));
  }
  return [...far];
}

/** What must be seen: x, y, z of points. */
export interface Extent {
  whole: Float32Array;
  near: Float32Array; // without the far flights of some bodies, if there are any
  leaving: string[]; // the names of these bodies
}
const seen_of_path = 24; // points of a curve that moves
const far_away = 3; // times as far from the middle as everything else
const kept_flight = 1.5; // likewise: how much of such a flight is near

/** Goes through the motion in few steps: `poses` are those at each `t`. */
function each_look(run: Run, poses: Poses, act: (t: number) => void) {
  const { meta, motion } = run,
    span = motion.end - motion.start;
  const n = span > 0 ? Math.max(12, Math.min(looks, Math.ceil(most_looks / (meta.bodies.length + 1)))) : 1;
  for (let k = 0; k < n; ++k) {
    const t = motion.start + (n > 1 ? k / (n - 1) : 0) * span;
    motion.at(t, poses.X);
    poses.update();
    act(t);
  }
}

/** The same with room for arrows of forces, but of those on bodies that leave. */
export function with_room(extent: Extent, run: Run, arrows: Arrows): Extent {
  const tips: number[] = [],
    leave = new Set(extent.leaving),
    poses = new Poses(run.motion.bodies);
  each_look(run, poses, (t) =>
    arrows.each_tip(t, poses, (body, tip) => {
      const is_near = body < 0 || !leave.has(run.meta.bodies[body].name);
      if (is_near && Number.isFinite(tip.x + tip.y + tip.z)) tips.push(tip.x, tip.y, tip.z);
    }),
  );
  const with_tips = (points: Float32Array) => Float32Array.from([...points, ...tips]);
  const near = with_tips(extent.near);
  return { ...extent, near, whole: extent.whole === extent.near ? near : with_tips(extent.whole) };
}

/** Corners of bodies through the motion, joints and springs at the world. */
export function extent_of(run: Run): Extent {
  const { meta, motion } = run,
    all: number[] = [],
    owners: number[] = [],
    p = new Vector3(),
    poses = new Poses(motion.bodies);
  const corners = Array.from({ length: meta.shapes }, (_, k) => corners_of(run, k)),
    placed = (piece: Piece) =>
      corners[piece.shape].map((corner) => corner.clone().applyMatrix4(place_of(piece))),
    of_bodies = meta.bodies.map(({ pieces }) => pieces.flatMap(placed));
  const see = (b: number) => {
    if (!Number.isFinite(p.x + p.y + p.z)) return;
    all.push(p.x, p.y, p.z);
    owners.push(b);
  };
  each_look(run, poses, () => {
    meta.bodies.forEach((_, b) => {
      for (const corner of of_bodies[b]) {
        p.copy(corner).applyMatrix4(poses.matrices[b]);
        see(b);
      }
    });
    for (const { body, point } of run.attachments) {
      p.copy(point).applyMatrix4(poses.matrices[body]);
      see(body);
    }
    for (const { first, path } of meta.joints) {
      const step = Math.ceil((path ?? []).length / seen_of_path);
      for (let i = 0; first >= 0 && i < (path ?? []).length; i += step) {
        p.fromArray(path![i]).applyMatrix4(poses.matrices[first]);
        see(first);
      }
    }
  });
  for (const joint of meta.joints) if (joint.first < 0) all.push(...joint.point_first);
  for (const { first, path } of meta.joints)
    if (first < 0) for (const place of path ?? []) all.push(...place);
  for (const { over } of [...meta.joints, ...meta.loads])
    for (const { body, point } of over ?? []) if (body < 0) all.push(...point);
  for (const spring of run.springs) if (spring.second < 0) all.push(...spring.point_second!);
  all.push(...still_points(meta.world.map(placed), all));
  const whole = Float32Array.from(all.length ? all : [-1, -1, -1, 1, 1, 1]);
  return { whole, ...near_of(run, whole, owners) };
}

/** Corners of what stands still, but for what is much larger than all that moves, such as a floor. */
function still_points(pieces: Vector3[][], moving: number[]): number[] {
  const box = new Box3().setFromArray(moving.length ? moving : [-1, -1, -1, 1, 1, 1]),
    size = box.getSize(new Vector3()).length();
  return pieces
    .filter(
      (points) => new Box3().setFromPoints(points).union(box).getSize(new Vector3()).length() < 2 * size,
    )
    .flatMap((points) => points.flatMap((p) => p.toArray()));
}

/** The height of a floor that stands still below everything that moves; null: there is none. */
export function floor_of(run: Run, points: Float32Array): number | null {
  const { up } = run,
    corners = Array.from({ length: run.meta.shapes }, (_, k) => corners_of(run, k)),
    seed = Math.abs(up.y) < 0.9 ? new Vector3(0, 1, 0) : new Vector3(0, 0, 1),
    x = new Vector3().crossVectors(seed, up).normalize(),
    axes = [x, new Vector3().crossVectors(up, x), up],
    moving: Vector3[] = [];
  for (let i = 0; i < points.length; i += 3) moving.push(new Vector3().fromArray(points, i));
  const reach = (all: Vector3[]) =>
    axes.map((axis) =>
      all.reduce(
        ([low, high], p) => [Math.min(low, p.dot(axis)), Math.max(high, p.dot(axis))],
        [Infinity, -Infinity],
      ),
    );
  const of_all = reach(moving),
    sunk = 0.1 * (of_all[2][1] - of_all[2][0]); // what presses itself into it
  const tops = run.meta.world.flatMap((piece) => {
    const own = reach(corners[piece.shape].map((corner) => corner.clone().applyMatrix4(place_of(piece)))),
      is_wide = [0, 1].every((i) => own[i][1] - own[i][0] > 0.5 * (of_all[i][1] - of_all[i][0]));
    return is_wide && own[2][1] <= of_all[2][0] + sunk ? [own[2][1]] : [];
  });
  return tops.length ? Math.max(...tops) : null;
}

/** Bodies that go much farther than all others, such as a stone that was thrown, would make the others dots. */
function near_of(run: Run, whole: Float32Array, owners: number[]): { near: Float32Array; leaving: string[] } {
  const { bodies } = run.meta,
    p = new Vector3(),
    middle = new Vector3(),
    first = owners.findIndex((owner, i) => owner < owners[i - 1]), // points of the first instant
    n = first < 0 ? owners.length : first;
  for (let i = 0; i < n; ++i) middle.addScaledVector(p.fromArray(whole, 3 * i), 1 / Math.max(n, 1));
  const reach = bodies.map(() => 0);
  owners.forEach((owner, i) => {
    reach[owner] = Math.max(reach[owner], p.fromArray(whole, 3 * i).distanceTo(middle));
  });
  const order = bodies.map((_, b) => b).sort((a, b) => reach[a] - reach[b]);
  const cut = order.findIndex((b, k) => k > 0 && reach[b] > far_away * reach[order[k - 1]]);
  if (cut < 0) return { near: whole, leaving: [] };
  const leaving = new Set(order.slice(cut)),
    limit = kept_flight * reach[order[cut - 1]],
    near: number[] = [];
  for (let i = 0; 3 * i < whole.length; ++i) {
    p.fromArray(whole, 3 * i);
    if (!leaving.has(owners[i]) || p.distanceTo(middle) < limit) near.push(p.x, p.y, p.z);
  }
  return {
    near: Float32Array.from(near),
    leaving: bodies.filter((_, b) => leaving.has(b)).map((b) => b.name),
  };
}
