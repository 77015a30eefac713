// SPDX-License-Identifier: BSD-3-Clause
// Stills and moving pictures, picture by picture: how long one takes to draw changes nothing of them.
import { png_of } from "./files";
import { Gif, Palette } from "./gif";
import { sketch } from "./sketch";
import { Studio, type Look, type Screen } from "./studio";
import { webm_of, type Chunk, type Colours } from "./webm";

/** Instants of a moving picture: from, to [s] of the motion, seconds of motion in one of the picture, pictures a second. */
export interface Course {
  from: number;
  to: number;
  speed: number;
  rate: number;
}
export type Kind = "png" | "svg" | "webm" | "gif";
export const is_still = (kind: Kind) => kind === "png" || kind === "svg";

export const most_frames = 20_000;
const looks = 12; // pictures that the colours of a GIF are chosen by
const queue = 4; // pictures that wait to be encoded
const key_every = 2; // s
const bits_of_a_pixel = 0.16;

export function instants_of({ from, to, speed, rate }: Course): number[] {
  if (![from, to, speed, rate].every(Number.isFinite))
    throw new Error("from, to, speed and rate must be numbers");
  if (!(speed > 0) || !(rate > 0)) throw new Error("speed and frames a second must be positive");
  if (!(to > from)) throw new Error("the end must be after the start");
  const n = Math.floor(((to - from) / speed) * rate + 1e-6) + 1;
  if (n > most_frames)
    throw new Error(
      `${n} frames are more than ${most_frames}: choose a higher speed or fewer frames a second`,
    );
  return Array.from({ length: n }, (_, k) => Math.min(from + (k * speed) / rate, to));
}

/** Lets the page live, also where timers are slowed since nobody looks. */
function breath(): Promise<void> {
  return new Promise((done) => {
    const { port1, port2 } = new MessageChannel();
    port2.onmessage = () => {
      port1.close();
      done();
    };
    port1.postMessage(0);
  });
}

type Told = (share: number) => void;

export async function still(screen: Screen, look: Look, t: number): Promise<Blob> {
  const studio = new Studio(screen, look);
  try {
    return await png_of(studio.draw(t));
  } finally {
    studio.close();
  }
}

export const can_encode = () => typeof VideoEncoder !== "undefined";

async function codec_of(width: number, height: number, rate: number): Promise<VideoEncoderConfig> {
  const bitrate = Math.round(Math.min(Math.max(bits_of_a_pixel * width * height * rate, 2e6), 1.2e8));
  for (const codec of ["vp09.00.41.08", "vp09.00.51.08", "vp09.00.61.08", "vp8"]) {
    const config: VideoEncoderConfig = {
      codec,
      width,
      height,
      framerate: rate,
      bitrate,
      latencyMode: "quality",
    };
    if ((await VideoEncoder.isConfigSupported(config)).supported) return config;
  }
  throw new Error(`this browser encodes no WebM of ${width} \u00d7 ${height} pixels`);
}

async function video(
  screen: Screen,
  look: Look,
  course: Course,
  told: Told,
  signal: AbortSignal,
): Promise<Blob> {
  if (!can_encode()) throw new Error("this browser cannot encode video (no WebCodecs): choose GIF");
  const instants = instants_of(course),
    { width, height } = look,
    { rate } = course,
    config = await codec_of(width, height, rate),
    studio = new Studio(screen, look),
    chunks: Chunk[] = [];
  let fault: Error | null = null,
    colours: Colours = {};
  const encoder = new VideoEncoder({
    output: (chunk, told) => {
      colours = told?.decoderConfig?.colorSpace ?? colours;
      const data = new Uint8Array(chunk.byteLength);
      chunk.copyTo(data);
      chunks.push({ data, timestamp: chunk.timestamp, is_key: chunk.type === "key" });
    },
    error: (error) => {
      fault = error;
    },
  });
  const check = () => {
    signal.throwIfAborted();
    if (fault) throw fault;
  };
  try {
    encoder.configure(config);
    let last_key = -Infinity;
    for (const [k, t] of instants.entries()) {
      const frame = new VideoFrame(studio.draw(t), {
        timestamp: Math.round((1e6 * k) / rate),
        duration: Math.round(1e6 / rate),
      });
      const is_key = k / rate - last_key >= key_every;
      if (is_key) last_key = k / rate;
      encoder.encode(frame, { keyFrame: is_key });
      frame.close();
      told((k + 1) / instants.length);
      do {
        await breath();
        check();
      } while (encoder.encodeQueueSize > queue);
    }
    await encoder.flush();
    check();
  } finally {
    if (encoder.state !== "closed") encoder.close();
    studio.close();
  }
  return webm_of(
    chunks,
    config.codec === "vp8" ? "V_VP8" : "V_VP9",
    width,
    height,
    rate,
    instants.length / rate,
    colours,
  );
}

async function gif(
  screen: Screen,
  look: Look,
  course: Course,
  told: Told,
  signal: AbortSignal,
): Promise<Blob> {
  if (course.rate > 50) throw new Error("a GIF shows 50 pictures a second at most");
  const instants = instants_of(course),
    { width, height } = look,
    studio = new Studio(screen, { ...look, is_clear: false }),
    palette = new Palette();
  const pixels = (t: number) => studio.draw(t).getContext("2d")!.getImageData(0, 0, width, height).data;
  try {
    const n = Math.min(looks, instants.length);
    for (let k = 0; k < n; ++k) {
      palette.see(pixels(instants[Math.floor((k * (instants.length - 1)) / Math.max(n - 1, 1))]));
      await breath();
      signal.throwIfAborted();
    }
    palette.choose();
    const made = new Gif(width, height, course.rate, palette);
    for (const [k, t] of instants.entries()) {
      made.add(pixels(t));
      told((k + 1) / instants.length);
      await breath();
      signal.throwIfAborted();
    }
    return made.end();
  } finally {
    studio.close();
  }
}

/** Beyond its ends polynomials of a motion mean nothing. */
function check_inside({ run: { motion } }: Screen, instants: number[]) {
  for (const t of instants)
    if (motion.clamp(t) !== t)
      throw new Error(`${t} s is outside the motion, which is from ${motion.start} s to ${motion.end} s`);
}

export async function record(
  kind: Kind,
  screen: Screen,
  look: Look,
  course: Course,
  told: Told = () => {},
  signal: AbortSignal = new AbortController().signal,
): Promise<Blob> {
  check_inside(screen, is_still(kind) ? [course.from] : [course.from, course.to]);
  if (kind === "png") return still(screen, look, course.from);
  if (kind === "svg") return sketch(screen, look, course.from);
  return kind === "gif" ? gif(screen, look, course, told, signal) : video(screen, look, course, told, signal);
}
