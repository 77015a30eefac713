// SPDX-License-Identifier: BSD-3-Clause
// Playing: real time, or the speed at which the motion takes some seconds. Nothing plays unless it is asked to.
import type { Run } from "./run";
import { by_id, element } from "./text";
import type { Timeline } from "./timeline";

const speeds = [0.001, 0.002, 0.005, 0.01, 0.02, 0.05, 0.1, 0.2, 0.5, 1, 2, 5, 10, 20, 50, 100];
const wanted_seconds = 8; // of a motion that is much shorter or longer
const frames = 30; // a second, of videos; screens have more
const looks = 60; // at what happens between frames
const most_bodies = 20;
const bent = 0.25; // off a straight line between frames, as a part of it: a third of a turn

/** Whether bodies turn back between one frame and the next, so that what is seen is another motion. */
export function is_strobed(run: Run, step: number): boolean {
  const { start, end } = run.motion,
    n = Math.min(run.motion.bodies, most_bodies);
  let way = 0,
    off = 0;
  for (let k = 0; k < looks && end - start > step; ++k) {
    const t = start + ((0.5 + k * 0.618034) % 1) * (end - start - step);
    for (let b = 0; b < n; ++b) {
      const [from, between, to] = [0, 0.5, 1].map((s) => run.centre(b, t + s * step));
      way += from.distanceTo(to);
      off += between.distanceTo(from.add(to).multiplyScalar(0.5));
    }
  }
  return off > bent * way && off > 1e-9 * looks * run.meta.length;
}

/** Real time, or what takes some seconds, but no faster than can be seen. */
function natural_speed(run: Run, span: number): number {
  if (span >= 2 && span <= 40) return 1;
  const off = (s: number) => Math.abs(Math.log(span / s / wanted_seconds));
  let best = speeds.reduce((one, s) => (off(s) < off(one) ? s : one), 1);
  while (best > 1 && is_strobed(run, best / frames)) best = speeds[speeds.indexOf(best) - 1];
  return best;
}

export class Playback {
  private frame = 0;
  private readonly button = by_id<HTMLButtonElement>("play");
  private readonly speed = by_id<HTMLSelectElement>("speed");

  constructor(
    run: Run,
    private readonly time: Timeline,
  ) {
    for (const s of speeds) {
      const times = s < 1 ? `1/${Math.round(1 / s)} \u00d7` : `${s} \u00d7`;
      this.speed.append(
        element(
          "option",
          { value: String(s) },
          is_strobed(run, s / frames) ? `${times} (frames skip)` : times,
        ),
      );
    }
    this.speed.value = String(natural_speed(run, time.span));
    this.button.disabled = !(time.span > 0);
    this.button.addEventListener("click", () => this.toggle());
  }
  get is_playing() {
    return this.frame !== 0;
  }

  toggle() {
    if (this.is_playing) this.stop();
    else this.play();
  }
  stop() {
    cancelAnimationFrame(this.frame);
    this.frame = 0;
    this.show();
  }
  play() {
    if (!(this.time.span > 0)) return;
    if (this.time.now >= this.time.end) this.time.set(this.time.start);
    let last = performance.now();
    const step = (at: number) => {
      const next = this.time.now + (Math.max(at - last, 0) / 1000) * Number(this.speed.value);
      last = at;
      this.time.set(next);
      if (next >= this.time.end) this.stop();
      else this.frame = requestAnimationFrame(step);
    };
    this.frame = requestAnimationFrame(step);
    this.show();
  }
  private show() {
    this.button.textContent = this.is_playing ? "\u275a\u275a" : "\u25b6";
    this.button.setAttribute("aria-label", this.is_playing ? "stop" : "play");
  }
}
