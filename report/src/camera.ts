// SPDX-License-Identifier: BSD-3-Clause
// Where the picture is seen from: chosen so that the whole motion fills it, then turned by hand or by keys.
import { PerspectiveCamera, Vector3 } from "three";
import type { Extent } from "./bodies";

/** Unit vectors of a view: right, up in the picture, and into it. */
interface View {
  right: Vector3;
  up: Vector3;
  into: Vector3;
}

export type Side = "fitted" | "front" | "side" | "top";

function view_from(up: Vector3, across: Vector3, turn: number, height: number): View {
  const depth = new Vector3().crossVectors(up, across); // away from the eye where nothing is turned
  const into = across
    .clone()
    .multiplyScalar(-Math.sin(turn))
    .addScaledVector(depth, Math.cos(turn))
    .multiplyScalar(Math.cos(height))
    .addScaledVector(up, -Math.sin(height))
    .normalize();
  const right = new Vector3().crossVectors(into, up).normalize();
  return { right, up: new Vector3().crossVectors(right, into), into };
}

const most_growth = 1.3, // of the distance, and of it sideways, by which a picture still fits
  most_shift = 0.1;

export class Eye {
  readonly camera = new PerspectiveCamera(28, 1, 0.01, 1000);
  readonly target = new Vector3();
  private moved = false;
  private held = NaN; // the form of the picture in which this eye stays as another one
  private side: Side = "fitted";
  private room = { above: 0.05, below: 0.05 };
  private readonly across = new Vector3(); // level, where the motion is widest

  private points: Float32Array;

  constructor(
    private readonly extent: Extent,
    readonly up: Vector3,
    private readonly redraw: () => void,
  ) {
    this.camera.up.copy(up);
    this.points = extent.near;
    this.find_width();
  }

  private each(act: (p: Vector3) => void) {
    const p = new Vector3();
    for (let i = 0; i < this.points.length; i += 3) act(p.fromArray(this.points, i));
  }

  /** Level directions are tried; the one along which points are spread most lies across the picture. */
  private flat = false;
  private find_width() {
    const seed = Math.abs(this.up.y) < 0.9 ? new Vector3(0, 1, 0) : new Vector3(0, 0, 1);
    const x = new Vector3().crossVectors(seed, this.up).normalize(),
      y = new Vector3().crossVectors(this.up, x);
    const mean = new Vector3();
    let n = 0;
    this.each((p) => {
      mean.add(p);
      ++n;
    });
    mean.multiplyScalar(1 / Math.max(n, 1));
    let xx = 0,
      xy = 0,
      yy = 0,
      uu = 0;
    this.each((p) => {
      p.sub(mean);
      const a = p.dot(x),
        b = p.dot(y),
        c = p.dot(this.up);
      xx += a * a;
      xy += a * b;
      yy += b * b;
      uu += c * c;
    });
    const angle = Math.abs(xx - yy) + Math.abs(xy) > 0.15 * (xx + yy) ? 0.5 * Math.atan2(2 * xy, xx - yy) : 0;
    this.across.copy(x).multiplyScalar(Math.cos(angle)).addScaledVector(y, Math.sin(angle));
    this.flat = uu < 0.01 * (xx + yy);
  }

  /** Looks at everything from a side, as near as the picture allows. */
  fit(side: Side = this.side) {
    this.side = side;
    this.fit_points();
  }
  /** Of a mechanism that throws something: the mechanism; once more, the whole flight. */
  fit_by_hand(side: Side) {
    const is_again = side === this.side && !this.moved && this.points === this.extent.near;
    this.points = is_again ? this.extent.whole : this.extent.near;
    this.fit(side);
  }
  view_of(side: Side): View {
    const rise = side === "top" ? 1.5 : side !== "fitted" ? 0 : this.flat ? 0.85 : 0.3;
    const turn = side === "side" ? Math.PI / 2 : side === "fitted" ? -0.42 : 0;
    return view_from(this.up, this.across, turn, rise);
  }
  /** Nobody has chosen from where to look. */
  get is_untouched() {
    return this.side === "fitted" && !this.moved;
  }
  private fit_points() {
    this.moved = false;
    this.held = NaN;
    const v = this.view_of(this.side);
    const tangent = Math.tan((this.camera.fov * Math.PI) / 360),
      tx = 0.9 * tangent * this.camera.aspect,
      t_up = tangent * (1 - 2 * this.room.above),
      t_down = tangent * (1 - 2 * this.room.below);
    let l = -Infinity,
      r = -Infinity,
      d = -Infinity,
      u = -Infinity,
      near = Infinity,
      far = -Infinity;
    this.each((p) => {
      const a = p.dot(v.right),
        b = p.dot(v.up),
        c = p.dot(v.into);
      l = Math.max(l, -a / tx - c);
      r = Math.max(r, a / tx - c);
      d = Math.max(d, -b - t_down * c);
      u = Math.max(u, b - t_up * c);
      near = Math.min(near, c);
      far = Math.max(far, c);
    });
    const back = Math.max((l + r) / 2, (d + u) / (t_down + t_up)),
      middle = (near + far) / 2;
    const at = (depth: number) =>
      v.right
        .clone()
        .multiplyScalar((tx * (r - l)) / 2)
        .addScaledVector(v.up, (u - d + (t_down - t_up) * back) / 2)
        .addScaledVector(v.into, depth);
    this.camera.position.copy(at(-back));
    this.target.copy(at(middle));
    this.aim();
  }
  /** From where another eye looks, in a picture of another form. */
  see_as(other: Eye) {
    this.points = other.points === other.extent.near ? this.extent.near : this.extent.whole;
    this.fit(other.side);
    if (!other.moved) return;
    this.moved = true;
    this.camera.position.copy(other.camera.position);
    this.target.copy(other.target);
    this.aim();
  }
  /** As the eye of a run before, so that what has changed is seen; but all is fitted anew where nobody has chosen from where
   * to look and the whole has become much larger, much smaller, or has gone elsewhere. */
  stay_as(other: Eye) {
    this.room = other.room;
    this.camera.aspect = other.camera.aspect;
    this.see_as(other);
    if (other.moved) return;
    const far = (eye: Eye) => eye.camera.position.distanceTo(eye.target),
      ratio = far(this) / far(other),
      apart = this.target.distanceTo(other.target) / far(other);
    if (Math.max(ratio, 1 / ratio) > most_growth || apart > most_shift) return;
    this.camera.position.copy(other.camera.position);
    this.target.copy(other.target);
    this.held = other.camera.aspect;
    this.aim();
  }
  /** `above`, `below`: shares of the height that are left to what is written there. */
  resize(aspect: number, above: number, below: number) {
    this.room = { above, below };
    this.camera.aspect = aspect;
    this.camera.updateProjectionMatrix();
    if (!this.moved && this.held !== aspect) this.fit();
  }
  private aim() {
    const distance = this.camera.position.distanceTo(this.target);
    this.camera.near = distance / 200;
    this.camera.far = distance * 50;
    this.camera.lookAt(this.target);
    this.camera.updateProjectionMatrix();
    this.camera.updateMatrixWorld();
    this.redraw();
  }
  /** About the target, by angles. */
  turn(about_up: number, over: number) {
    const arm = this.camera.position.clone().sub(this.target),
      length = arm.length();
    arm.normalize().applyAxisAngle(this.up, about_up);
    const side = new Vector3().crossVectors(this.up, arm).normalize(),
      now = arm.angleTo(this.up);
    const change = Math.min(Math.max(now + over, 0.02), Math.PI - 0.02) - now;
    arm.applyAxisAngle(side, change);
    this.camera.position.copy(this.target).addScaledVector(arm, length);
    this.moved = true;
    this.aim();
  }
  near(factor: number) {
    this.camera.position.sub(this.target).multiplyScalar(factor).add(this.target);
    this.moved = true;
    this.aim();
  }
  /** By shares of the picture's height. */
  shift(dx: number, dy: number) {
    const size =
      2 * this.camera.position.distanceTo(this.target) * Math.tan((this.camera.fov * Math.PI) / 360);
    const right = new Vector3().setFromMatrixColumn(this.camera.matrixWorld, 0),
      up = new Vector3().setFromMatrixColumn(this.camera.matrixWorld, 1);
    const step = right.multiplyScalar(-dx * size).addScaledVector(up, dy * size);
    this.camera.position.add(step);
    this.target.add(step);
    this.moved = true;
    this.aim();
  }

  /** Pointers turn, with Shift or another button they move; wheel and two fingers come nearer; keys do all of it. */
  listen(canvas: HTMLElement) {
    const held = new Map<number, PointerEvent>();
    const gap = () => {
      const [a, b] = [...held.values()];
      return Math.hypot(a.clientX - b.clientX, a.clientY - b.clientY);
    };
    canvas.addEventListener("pointerdown", (e) => {
      canvas.setPointerCapture(e.pointerId);
      held.set(e.pointerId, e);
    });
    for (const end of ["pointerup", "pointercancel"] as const)
      canvas.addEventListener(end, (e) => held.delete(e.pointerId));
    canvas.addEventListener("pointermove", (e) => {
      const last = held.get(e.pointerId);
      if (!last) return;
      const dx = (e.clientX - last.clientX) / canvas.clientHeight,
        dy = (e.clientY - last.clientY) / canvas.clientHeight;
      const before = held.size === 2 ? gap() : 0;
      held.set(e.pointerId, e);
      if (held.size === 2) {
        this.near(before / Math.max(gap(), 1));
        this.shift(dx / 2, dy / 2);
      } else if (e.shiftKey || e.buttons > 1) this.shift(dx, dy);
      else this.turn(-4 * dx, -3 * dy);
    });
    canvas.addEventListener("contextmenu", (e) => e.preventDefault());
    canvas.addEventListener(
      "wheel",
      (e) => {
        e.preventDefault();
        this.near(Math.exp(Math.max(-60, Math.min(60, e.deltaY)) * 0.003));
      },
      { passive: false },
    );
    canvas.addEventListener("keydown", (e) => {
      const step = 0.12,
        moves: Record<string, () => void> = {
          ArrowLeft: () => (e.shiftKey ? this.shift(-0.05, 0) : this.turn(-step, 0)),
          ArrowRight: () => (e.shiftKey ? this.shift(0.05, 0) : this.turn(step, 0)),
          ArrowUp: () => (e.shiftKey ? this.shift(0, -0.05) : this.turn(0, -step)),
          ArrowDown: () => (e.shiftKey ? this.shift(0, 0.05) : this.turn(0, step)),
          "+": () => this.near(0.9),
          "=": () => this.near(0.9),
          "-": () => this.near(1 / 0.9),
          "0": () => this.fit("fitted"),
        };
      if (!moves[e.key] || e.ctrlKey || e.metaKey || e.altKey) return;
      e.preventDefault();
      e.stopPropagation();
      moves[e.key]();
    });
  }
}
