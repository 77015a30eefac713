// SPDX-License-Identifier: BSD-3-Clause
// The motion as the file holds it: polynomials in time elements, by the barycentric formula, so that any instant is as
// exact as `livens sample`.
import type { Data } from "./data";

/** Polynomials on nodes in [0, 1]. */
class Basis {
  readonly values: Float64Array;
  private readonly weights: number[];
  constructor(readonly nodes: number[]) {
    this.values = new Float64Array(nodes.length);
    this.weights = nodes.map((x, a) => 1 / nodes.reduce((w, y, b) => (a === b ? w : w * 4 * (x - y)), 1));
  }
  /** M_a(s), exactly 0 and 1 at nodes. */
  at(s: number): Float64Array {
    const { values, nodes } = this,
      hit = nodes.indexOf(s);
    if (hit >= 0) {
      values.fill(0);
      values[hit] = 1;
      return values;
    }
    let sum = 0;
    for (let a = 0; a < nodes.length; ++a) sum += values[a] = this.weights[a] / (s - nodes[a]);
    for (let a = 0; a < nodes.length; ++a) values[a] /= sum;
    return values;
  }
  /** M_a'(s) by products: as good at nodes as between. */
  rates(s: number): Float64Array {
    const { values, nodes } = this,
      n = nodes.length;
    for (let a = 0; a < n; ++a) {
      values[a] = 0;
      for (let b = 0; b < n; ++b) {
        if (a === b) continue;
        let product = 1 / (nodes[a] - nodes[b]);
        for (let c = 0; c < n; ++c) if (c !== a && c !== b) product *= (s - nodes[c]) / (nodes[a] - nodes[c]);
        values[a] += product;
      }
    }
    return values;
  }
}

/** The element of t, the later one at an end between two. */
export function element_of(ends: ArrayLike<number>, t: number): number {
  let low = 0,
    high = Math.max(ends.length - 2, 0);
  while (low < high) {
    const middle = (low + high + 1) >> 1;
    if (ends[middle] <= t) low = middle;
    else high = middle - 1;
  }
  return low;
}

export class Motion {
  readonly ends: Float64Array;
  readonly bodies: number;
  private readonly X: Float64Array; // node by node, 12 numbers a body: position, d1, d2, d3
  private readonly weights: Float64Array;
  private readonly basis: Basis;
  private readonly stride: number; // nodes from one element to the next

  constructor({ meta, arrays }: Data) {
    const pose = meta.pose,
      stored = arrays.get("pose")!;
    this.ends = arrays.get("pose_end") as Float64Array;
    this.weights = arrays.get("pose_weight") as Float64Array;
    this.bodies = meta.bodies.length;
    this.basis = new Basis(pose.nodes);
    this.stride = pose.continuous ? pose.degree : pose.degree + 1;
    const channels = pose.forms.reduce((a, b) => a + b, 0),
      nodes = channels ? stored.length / channels : 0;
    this.X = new Float64Array(12 * this.bodies * nodes);
    let channel = 0;
    pose.forms.forEach((form, body) => {
      for (let n = 0; n < nodes; ++n) {
        const o = 12 * (this.bodies * n + body),
          read = (i: number) => stored[(channel + i) * nodes + n];
        const kept = form === 7 ? 3 : form;
        for (let i = 0; i < kept; ++i) this.X[o + i] = read(i);
        if (form === 7) rotate(this.X, o + 3, read(3), read(4), read(5), read(6));
        if (form === 3) {
          this.X[o + 3] = this.X[o + 7] = this.X[o + 11] = 1;
        }
      }
      channel += form;
    });
  }
  get start() {
    return this.ends[0];
  }
  get end() {
    return this.ends[this.ends.length - 1];
  }
  clamp(t: number) {
    return Math.min(Math.max(t, this.start), this.end);
  }

  /** [position, d1, d2, d3] of the bodies `first` to `last` - 1 at t. */
  at(t: number, out: Float64Array, first = 0, last = this.bodies): Float64Array {
    return this.sum(t, false, out, first, last);
  }
  /** Their rates. */
  rates(t: number, out: Float64Array, first = 0, last = this.bodies): Float64Array {
    return this.sum(t, true, out, first, last);
  }

  private sum(t: number, is_rate: boolean, out: Float64Array, first: number, last: number) {
    const e = element_of(this.ends, t),
      h = this.ends[e + 1] - this.ends[e],
      n = 12 * this.bodies;
    out.fill(0);
    if (!(h > 0)) {
      if (!is_rate) out.set(this.X.subarray(12 * first, 12 * last));
      return out;
    }
    const s = (t - this.ends[e]) / h,
      node = e * this.stride;
    const basis = this.weights.length
      ? this.rational(node, s, is_rate)
      : is_rate
        ? this.basis.rates(s)
        : this.basis.at(s);
    for (let a = 0; a < basis.length; ++a) {
      const m = is_rate ? basis[a] / h : basis[a],
        from = (node + a) * n;
      if (m !== 0) for (let i = 12 * first, k = 0; i < 12 * last; ++i, ++k) out[k] += m * this.X[from + i];
    }
    return out;
  }
  /** M_a W_a / sum M_b W_b, or its derivative. */
  private rational(node: number, s: number, is_rate: boolean): Float64Array {
    const W = this.weights,
      M = Float64Array.from(this.basis.at(s));
    let sum = 0,
      rate = 0;
    M.forEach((m, a) => {
      sum += m * W[node + a];
    });
    if (!is_rate) return M.map((m, a) => (m * W[node + a]) / sum);
    const dM = this.basis.rates(s);
    dM.forEach((m, a) => {
      rate += m * W[node + a];
    });
    return M.map((m, a) => (W[node + a] * (dM[a] - (m * rate) / sum)) / sum);
  }
}

/** Directors of a quaternion of any length. */
function rotate(X: Float64Array, o: number, w: number, x: number, y: number, z: number) {
  const s = 2 / (w * w + x * x + y * y + z * z);
  X[o] = 1 - s * (y * y + z * z);
  X[o + 1] = s * (x * y + w * z);
  X[o + 2] = s * (x * z - w * y);
  X[o + 3] = s * (x * y - w * z);
  X[o + 4] = 1 - s * (x * x + z * z);
  X[o + 5] = s * (y * z + w * x);
  X[o + 6] = s * (x * z + w * y);
  X[o + 7] = s * (y * z - w * x);
  X[o + 8] = 1 - s * (x * x + y * y);
}

/** Series that the program has taken at nodes of elements, both ends of each. */
export class Curves {
  private readonly ends: Float64Array;
  private readonly values: Float32Array;
  private readonly basis: Basis;
  private readonly count: number; // numbers of one series
  constructor({ meta, arrays }: Data) {
    this.ends = arrays.get("curve_end") as Float64Array;
    this.values = arrays.get("curve") as Float32Array;
    this.basis = new Basis(meta.curves.nodes);
    this.count = Math.max(this.ends.length - 1, 1) * meta.curves.nodes.length;
  }
  /** s, between neighbouring instants in the mean. */
  get step(): number {
    const n = this.ends.length - 1;
    return (this.ends[n] - this.ends[0]) / (n * Math.max(this.basis.nodes.length - 1, 1));
  }
  at(channel: number, t: number): number {
    const e = element_of(this.ends, t),
      h = this.ends[e + 1] - this.ends[e],
      n = this.basis.nodes.length;
    const from = channel * this.count + e * n;
    if (!(h > 0)) return this.values[from];
    const M = this.basis.at(Math.min(Math.max((t - this.ends[e]) / h, 0), 1));
    let sum = 0;
    for (let a = 0; a < n; ++a) if (M[a] !== 0) sum += M[a] * this.values[from + a];
    return sum;
  }
}
