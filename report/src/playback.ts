// SPDX-License-Identifier: BSD-3-Clause
// Playing: real time, or the speed at which the motion takes some seconds. Nothing plays unless it is asked to.
import { by_id, element } from "./text";
import type { Timeline } from "./timeline";

const speeds = [0.001, 0.002, 0.005, 0.01, 0.02, 0.05, 0.1, 0.2, 0.5, 1, 2, 5, 10, 20, 50, 100];
const wanted_seconds = 8; // of a motion that is much shorter or longer

function natural_speed(span: number): number {
  if (span >= 2 && span <= 40) return 1;
  const off = (s: number) => Math.abs(Math.log(span / s / wanted_seconds));
  return speeds.reduce((best, s) => (off(s) < off(best) ? s : best), 1);
}

export class Playback {
  private frame = 0;
  private readonly button = by_id<HTMLButtonElement>("play");
  private readonly speed = by_id<HTMLSelectElement>("speed");

  constructor(private readonly time: Timeline) {
    for (const s of speeds)
      this.speed.append(
        element("option", { value: String(s) }, s < 1 ? `1/${Math.round(1 / s)} \u00d7` : `${s} \u00d7`),
      );
    this.speed.value = String(natural_speed(time.span));
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
