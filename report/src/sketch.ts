// SPDX-License-Identifier: BSD-3-Clause
// The mechanism as engineers sketch it, for slides and blackboards: links as lines and plates, joints by their symbols, flat
// as one looks at it now. SVG.
import { Vector3 } from "three";
import type { Joint, On } from "./data";
import { Poses, acts, vector } from "./instances";
import { spread } from "./labels";
import type { Look, Screen } from "./studio";
import { body_colour, set_scheme, theme } from "./theme";

const full = 640; // px of a side that symbols are made for
const margin = 0.12; // of the sides
const letter = 7.2; // px that one takes of a name, about

type Point = [number, number];
const said = (x: number) => String(Number(x.toFixed(2)));
const at = (p: Point) => `${said(p[0])},${said(p[1])}`;
const escaped = (text: string) =>
  text.replace(/[&<>"]/g, (c) => ({ "&": "&amp;", "<": "&lt;", ">": "&gt;", '"': "&quot;" })[c]!);
/** Characters that no XML admits are left out. */
const plain = (text: string) =>
  escaped(text.replace(/[\u0000-\u0008\u000b\u000c\u000e-\u001f\ufffe\uffff]/g, ""));

const turning = new Set(["revolute", "spherical", "universal", "constant_velocity"]);
const sliding = new Set(["prismatic", "cylindrical", "screw", "point_on_line"]);
/** Joints that couple others, or say only how axes stand, have no place of their own. */
const placeless = new Set([
  "coupling",
  "gear",
  "rack_and_pinion",
  "drive",
  "parallel_axes",
  "perpendicular_axes",
  "constant_angle",
]);

class Sketch {
  private readonly parts: string[] = [];
  private readonly poses: Poses;
  private readonly right = new Vector3();
  private readonly up = new Vector3();
  private readonly into = new Vector3();
  private middle: Point = [0, 0];
  private of_metre = 1; // px
  private readonly unit: number; // px: what symbols are measured by

  constructor(
    private readonly screen: Screen,
    private readonly look: Look,
    private readonly t: number,
  ) {
    const { run } = screen;
    this.look_from();
    this.poses = new Poses(run.motion.bodies);
    this.unit = Math.min(look.width, look.height) / full;
    this.fit();
    run.motion.at(t, this.poses.X);
    this.poses.update();
  }

  /** As one looks now; at a mechanism whose hinges are parallel along these, unless somebody has turned it. */
  private look_from() {
    const { eye } = this.screen.stage!,
      { side } = this.look,
      axis = this.common_axis();
    eye.camera.matrixWorld.extractBasis(this.right, this.up, this.into);
    if (side ? side === "fitted" && axis : eye.is_untouched && axis) {
      const { up } = this.screen.run;
      const sign = axis!.dot(this.into) < 0 ? -1 : 1;
      this.into.copy(axis!).multiplyScalar(sign);
      this.up.copy(Math.abs(up.dot(this.into)) < 0.9 ? up : eye.view_of("top").up);
      this.up.addScaledVector(this.into, -this.up.dot(this.into)).normalize();
      this.right.crossVectors(this.up, this.into);
    } else if (side) {
      const view = eye.view_of(side);
      this.right.copy(view.right);
      this.up.copy(view.up);
    }
  }
  /** Of all hinges in the world, at the start. */
  private common_axis(): Vector3 | null {
    const { meta, motion } = this.screen.run,
      poses = new Poses(motion.bodies);
    motion.at(motion.start, poses.X);
    poses.update();
    const axes = meta.joints
      .filter(({ type }) => type === "revolute")
      .map(({ second, axis_second }) => vector(axis_second).transformDirection(poses.matrices[second]));
    const is_one = axes.every((axis) => Math.abs(axis.dot(axes[0])) > 0.9999);
    return axes.length && is_one ? axes[0] : null;
  }

  private flat(p: Vector3): Point {
    return [p.dot(this.right), -p.dot(this.up)];
  }
  private place(body: number, point: Vector3): Point {
    const [x, y] = this.flat(this.poses.place(body, point)),
      { width, height } = this.look;
    return [
      width / 2 + this.of_metre * (x - this.middle[0]),
      height / 2 + this.of_metre * (y - this.middle[1]),
    ];
  }
  /** So that all of the motion stays in the picture: sketches of several instants fit each other. */
  private fit() {
    const { run, stage } = this.screen,
      { motion } = run,
      { leaving } = stage!,
      low: Point = [Infinity, Infinity],
      high: Point = [-Infinity, -Infinity];
    const see = (p: Point) =>
      [0, 1].forEach((i) => {
        low[i] = Math.min(low[i], p[i]);
        high[i] = Math.max(high[i], p[i]);
      });
    for (let k = 0; k <= 120; ++k) {
      motion.at(motion.start + (k / 120) * (motion.end - motion.start), this.poses.X);
      this.poses.update();
      run.meta.bodies.forEach(({ name }, b) => {
        if (k > 0 && leaving.includes(name)) return; // what is thrown away
        for (const point of this.points_of(b)) see(this.flat(this.poses.place(b, point)));
      });
    }
    for (const joint of run.meta.joints)
      if (joint.first < 0 && !placeless.has(joint.type)) see(this.flat(vector(joint.point_first)));
    for (const { over } of [...run.meta.joints, ...run.meta.loads])
      for (const { body, point } of over ?? []) if (body < 0) see(this.flat(vector(point)));
    for (const spring of run.springs) if (spring.second < 0) see(this.flat(vector(spring.point_second!)));
    const { width, height } = this.look,
      share = 1 - 2 * margin;
    this.of_metre = Math.min(
      (share * width) / Math.max(high[0] - low[0], 1e-9 * run.meta.length),
      (share * height) / Math.max(high[1] - low[1], 1e-9 * run.meta.length),
    );
    this.middle = [(low[0] + high[0]) / 2, (low[1] + high[1]) / 2];
  }

  /** Where a body is held, each place once; of one that is held once or never also what shows how it stands. */
  private points_of(b: number): Vector3[] {
    const { run } = this.screen,
      near = 1e-6 * run.meta.length,
      all: Vector3[] = [];
    const add = (p: Vector3) => {
      if (all.every((q) => q.distanceTo(p) > near)) all.push(p);
    };
    for (const { type, first, second, point_first, point_second } of run.meta.joints) {
      if (placeless.has(type)) continue;
      if (first === b) add(vector(point_first));
      if (second === b) add(vector(point_second));
    }
    for (const { first, second, point_first, point_second } of run.springs) {
      if (first === b) add(vector(point_first!));
      if (second === b) add(vector(point_second!));
    }
    if (all.length < 2) add(vector(run.meta.bodies[b].centre));
    if (all.length < 2) add(vector(run.tips[b]));
    return all;
  }

  private line(points: Point[], colour: string, width: number, rest = "") {
    const d = points.map((p, i) => `${i ? "L" : "M"}${at(p)}`).join("");
    this.parts.push(
      `<path d="${d}" fill="none" stroke="${colour}" stroke-width="${said(width * this.unit)}" stroke-linecap="round" stroke-linejoin="round"${rest}/>`,
    );
  }
  private circle(p: Point, r: number, fill: string, stroke: string) {
    this.parts.push(
      `<circle cx="${said(p[0])}" cy="${said(p[1])}" r="${said(r * this.unit)}" fill="${fill}" stroke="${stroke}" stroke-width="${said(2 * this.unit)}"/>`,
    );
  }
  /** With its longer side along `way`. */
  private box(p: Point, way: Point, half: Point, fill: string, stroke: string) {
    const angle = (Math.atan2(way[1], way[0]) * 180) / Math.PI,
      [w, h] = half.map((x) => x * this.unit);
    this.parts.push(
      `<rect x="${said(-w)}" y="${said(-h)}" width="${said(2 * w)}" height="${said(2 * h)}" transform="translate(${at(p)}) rotate(${said(angle)})" fill="${fill}" stroke="${stroke}" stroke-width="${said(2 * this.unit)}"/>`,
    );
  }
  /** The ground below a place. */
  private ground(p: Point) {
    const u = this.unit,
      { ink } = theme(),
      y = p[1] + 20 * u;
    this.line([[p[0] - 11 * u, y], p, [p[0] + 11 * u, y]], ink, 2);
    this.line(
      [
        [p[0] - 17 * u, y],
        [p[0] + 17 * u, y],
      ],
      ink,
      2,
    );
    for (let k = -2; k <= 2; ++k)
      this.line(
        [
          [p[0] + (7 * k + 3) * u, y],
          [p[0] + (7 * k - 3) * u, y + 7 * u],
        ],
        ink,
        1.2,
      );
  }

  private bodies() {
    this.screen.run.meta.bodies.forEach((body, b) => {
      const colour = body.color ?? body_colour(b),
        points = this.points_of(b).map((p) => this.place(b, p));
      if (body.point || points.length < 2) return this.circle(points[0], 8, colour, colour);
      if (points.length > 2) {
        const hull = hull_of(points);
        this.parts.push(`<path d="M${hull.map(at).join("L")}Z" fill="${colour}" fill-opacity="0.18"/>`);
        this.line([...hull, hull[0]], colour, 5);
      } else this.line(points, colour, 6);
      const held = this.screen.run.attachments.filter((a) => a.body === b).length;
      if (held < 2) this.circle(this.place(b, vector(body.centre)), 6, colour, colour);
    });
  }
  private springs() {
    const turns = 9;
    for (const { first, second, point_first, point_second } of this.screen.run.springs) {
      const [a, b] = [this.place(first, vector(point_first!)), this.place(second, vector(point_second!))],
        length = Math.hypot(b[0] - a[0], b[1] - a[1]) || 1,
        [ux, uy] = [(b[0] - a[0]) / length, (b[1] - a[1]) / length],
        along = (s: number, aside: number): Point => [
          a[0] + s * length * ux - aside * this.unit * uy,
          a[1] + s * length * uy + aside * this.unit * ux,
        ];
      const zigzag = Array.from({ length: 2 * turns }, (_, k) =>
        along(0.15 + (0.7 * (k + 0.5)) / (2 * turns), k % 2 ? 7 : -7),
      );
      this.line([a, along(0.15, 0), ...zigzag, along(0.85, 0), b], theme().spring, 1.8);
      if (second < 0) this.ground(b);
    }
  }

  private axis(joint: Joint): Point {
    const axis =
        joint.first < 0
          ? vector(joint.axis_first)
          : vector(joint.axis_first).transformDirection(this.poses.matrices[joint.first]),
      [x, y] = this.flat(axis);
    return [x, y];
  }
  private joint(joint: Joint) {
    const { ink, card, soft } = theme(),
      { type, first, second } = joint,
      p = this.place(second, vector(joint.point_second)),
      q = this.place(first, vector(joint.point_first));
    if (placeless.has(type) || !acts(joint, this.t)) return;
    if (joint.over?.length) return this.rope(joint.over);
    if (joint.bar) {
      this.line([q, p], ink, 1.6);
      for (const end of [q, p]) this.circle(end, 4, card, ink);
      if (first < 0) this.ground(q);
      return;
    }
    if (joint.path?.length)
      this.line(
        joint.path.map((x) => this.place(first, vector(x))),
        soft,
        2,
      );
    if (sliding.has(type)) {
      const way = this.axis(joint),
        size = Math.hypot(...way);
      if (size < 0.2) return this.circle(p, 6, card, ink); // along the line of sight
      const [ux, uy] = [way[0] / size, way[1] / size],
        gone = (p[0] - q[0]) * ux + (p[1] - q[1]) * uy, // px along the rail
        rail = (s: number): Point => [q[0] + s * ux, q[1] + s * uy],
        reach = 45 * this.unit;
      this.line(
        [rail(Math.min(0, gone) - reach), rail(Math.max(0, gone) + reach)],
        soft,
        2,
        ' stroke-dasharray="6 4"',
      );
      if (first < 0) this.ground(rail(gone >= 0 ? Math.min(0, gone) - reach : reach));
      return this.box(p, way, [14, 9], card, ink);
    }
    if (first < 0 && (turning.has(type) || type === "weld")) this.ground(p);
    if (type === "weld") this.box(p, [1, 0], [6, 6], ink, ink);
    else if (turning.has(type) && Math.hypot(...this.axis(joint)) > 0.8)
      this.box(p, this.axis(joint), [11, 5], card, ink);
    else this.circle(p, type === "spherical" ? 8 : 6, card, ink);
    if (type === "spherical" || type === "constant_velocity") this.circle(p, 3, ink, ink);
  }

  private rope(over: On[]) {
    const { ink, card } = theme(),
      points = over.map(({ body, point }) => this.place(body, vector(point)));
    this.line(points, ink, 1.6);
    points.forEach((p, k) => {
      this.circle(p, 4, card, ink);
      if (over[k].body < 0) this.ground(p);
    });
  }

  private names() {
    const { bodies } = this.screen.run.meta,
      size = 13 * this.unit;
    const labels = bodies.map((body, b) => {
      const points = this.points_of(b).map((p) => this.place(b, p)),
        x = points.reduce((s, p) => s + p[0] / points.length, 0),
        y = points.reduce((s, p) => s + p[1] / points.length, 0);
      return {
        name: body.name,
        x: x + 10 * this.unit,
        y: y - 2 * size,
        width: letter * this.unit * body.name.length,
        height: 1.3 * size,
      };
    });
    spread(labels, this.look.height);
    for (const { name, x, y } of labels)
      this.parts.push(
        `<text x="${said(x)}" y="${said(y + size)}" font-size="${said(size)}" font-family="system-ui, sans-serif" fill="${theme().ink}" stroke="${theme().card}" stroke-width="${said(3 * this.unit)}" stroke-linejoin="round" paint-order="stroke">${plain(name)}</text>`,
      );
  }

  draw(): string {
    const { width, height, is_clear, names } = this.look,
      { run } = this.screen;
    if (!is_clear) this.parts.push(`<rect width="100%" height="100%" fill="${theme().card}"/>`);
    this.springs();
    this.bodies();
    for (const joint of run.meta.joints) this.joint(joint);
    for (const { over } of run.meta.loads) if (over?.length) this.rope(over);
    if (names) this.names();
    return `<svg xmlns="http://www.w3.org/2000/svg" width="${width}" height="${height}" viewBox="0 0 ${width} ${height}"><title>${plain(run.name)}</title>${this.parts.join("")}</svg>\n`;
  }
}

/** Corners of the convex hull, in order.   [Andrew 1979] */
function hull_of(points: Point[]): Point[] {
  const sorted = [...points].sort((a, b) => a[0] - b[0] || a[1] - b[1]);
  const half = (all: Point[]) => {
    const kept: Point[] = [];
    for (const p of all) {
      while (kept.length > 1) {
        const [a, b] = kept.slice(-2);
        if ((b[0] - a[0]) * (p[1] - a[1]) - (b[1] - a[1]) * (p[0] - a[0]) > 0) break;
        kept.pop();
      }
      kept.push(p);
    }
    return kept.slice(0, -1);
  };
  return [...half(sorted), ...half(sorted.reverse())];
}

export function sketch(screen: Screen, look: Look, t: number): Blob {
  if (!screen.stage) throw new Error("there is no picture in space to sketch");
  set_scheme(look.scheme);
  try {
    return new Blob([new Sketch(screen, look, t).draw()], { type: "image/svg+xml" });
  } finally {
    set_scheme(null);
  }
}
