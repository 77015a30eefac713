// SPDX-License-Identifier: BSD-3-Clause
// What stands in the page: one JSON text and one block of numbers a run. src/livens/io/report writes both.
import { unpacked } from "./unpacked";

export type Vector = [number, number, number];

/** A form at a place and in axes (columns) of its body or of the world; null: those of the body, its colour. */
export interface Piece {
  shape: number;
  middle: Vector;
  half: Vector;
  axes: number[] | null;
  color: string | null;
  opacity: number;
}
export interface Body {
  name: string;
  point: boolean;
  mark: boolean;
  mass: number;
  color: string | null;
  pieces: Piece[];
  middle: Vector;
  half: Vector;
  centre: Vector;
  thinned: [number, number, number] | null; // triangles, those drawn, m that corners are moved by at most
}
export interface Joint {
  name: string;
  type: string;
  bar: boolean; // it holds the distance of two points
  first: number;
  second: number;
  point_first: Vector;
  point_second: Vector;
  axis_first: Vector;
  axis_second: Vector;
  from: number | null; // s, when it begins and ends to act; null: always
  until: number | null;
  path?: Vector[]; // of a slot: its whole curve, on the first body
  over?: On[]; // of a rope: what it runs over
}
/** A point of a body, or of the world. */
export interface On {
  body: number;
  point: Vector;
}
export interface Load {
  name: string;
  type: string;
  first: number;
  second: number;
  point_first: Vector | null;
  point_second: Vector | null;
  place: Vector | null; // where force and torque are told, if there are no points
  over?: On[]; // of a rope: what it runs over
}
export interface Sensor {
  name: string;
  type: string;
  components: string[];
}
export interface Channel {
  kind: string;
  index: number;
  name: string;
  unit: string;
}

/** What the motion decided; numbers that are not known are null. */
export interface MotionEvent {
  name: string;
  condition: string;
  t: number;
  error: number | null;
  impulse: number; // of an impact, N s or N m s; else 0
  speed: number; // with which bodies meet there, m/s or rad/s; else 0
  behind: number | null; // with which they go apart
  rests: number | null; // when a stop that closes is at rest
  angle: boolean;
}
export interface Meta {
  name: string;
  title: string;
  status: string;
  message: string;
  converged: boolean;
  verdict: {
    grade: "good" | "doubtful" | "bad";
    word: string;
    lead: string;
    rest: string;
    reasons: string[];
    figures: { figure: string; name: string; meaning: string }[]; // that it was judged by
  };
  notes: string[];
  events?: MotionEvent[]; // pages of other versions have none
  method: string;
  version: string;
  constraints_hold_at: string;
  scenario: string;
  options: unknown;
  figures: Record<string, number | null>;
  start: number;
  end: number;
  pose: {
    precision: "double" | "rounded" | "thinned";
    position_loss: number | null;
    orientation_loss: number | null;
    elements: number;
    degree: number;
    continuous: boolean;
    nodes: number[];
    forms: number[];
  };
  bodies: Body[];
  world: Piece[];
  joints: Joint[];
  loads: Load[];
  sensors: Sensor[];
  shapes: number;
  gravity: Vector;
  length: number;
  curves: { every: boolean; loss?: number; nodes: number[] }; // loss: between nodes, of the range of a series
  channels: Channel[];
  quality: { bounds: Record<string, number>; worst_body: number; every: boolean; series: string[] };
  arrays: Record<string, ["f8" | "f4" | "u4" | "d1" | "d2", number]>;
}

export type Numbers = Float64Array | Float32Array | Uint32Array;
export interface Data {
  meta: Meta;
  arrays: Map<string, Numbers>;
}

/** Bytes of one significance lie together. */
function unshuffled(bytes: Uint8Array, at: number, size: number, count: number): ArrayBuffer {
  const plain = new Uint8Array(size * count);
  for (let k = 0; k < size; ++k)
    for (let i = 0, from = at + k * count, to = k; i < count; ++i, to += size) plain[to] = bytes[from + i];
  return plain.buffer;
}

/** Sums of differences along each channel, times its step: see Payload of src/livens/io/report. */
function from_steps(
  differences: Uint32Array,
  lows: Float64Array,
  steps: Float64Array,
  order: number,
): Float64Array {
  const n = differences.length / (lows.length || 1),
    whole = Int32Array.from(differences, (x) => (x >>> 1) ^ -(x & 1)),
    numbers = new Float64Array(whole.length);
  for (let channel = 0; channel < lows.length; ++channel) {
    const one = whole.subarray(channel * n, (channel + 1) * n);
    for (let round = 0; round < order; ++round) for (let i = 1; i < n; ++i) one[i] += one[i - 1];
    for (let i = 0; i < n; ++i)
      numbers[channel * n + i] = one[i] < 0 ? NaN : lows[channel] + one[i] * steps[channel];
  }
  return numbers;
}

export async function data_of(meta: Meta, base64: string): Promise<Data> {
  const bytes = await unpacked(base64),
    arrays = new Map<string, Numbers>();
  let at = 0;
  for (const [name, [kind, count]] of Object.entries(meta.arrays)) {
    const size = kind === "f8" ? 8 : 4,
      plain = unshuffled(bytes, at, size, count),
      of = (what: string) => arrays.get(`${name}_${what}`) as Float64Array;
    arrays.set(
      name,
      kind === "f8"
        ? new Float64Array(plain)
        : kind === "f4"
          ? new Float32Array(plain)
          : kind === "u4"
            ? new Uint32Array(plain)
            : from_steps(new Uint32Array(plain), of("low"), of("step"), kind === "d1" ? 1 : 2),
    );
    at += size * count;
  }
  return { meta, arrays };
}

/** All runs that a page holds: this one, or another report that was read from a file. */
export async function runs_of(page: ParentNode): Promise<Data[]> {
  const blocks = [...page.querySelectorAll("script.numbers")];
  return Promise.all(
    [...page.querySelectorAll("script.run")].map((text, i) =>
      data_of(JSON.parse(text.textContent ?? "") as Meta, (blocks[i].textContent ?? "").trim()),
    ),
  );
}
