// SPDX-License-Identifier: BSD-3-Clause
// The bar of time with the ends of elements below it, and the clock.
import { element_of } from "./motion";
import { by_id, number, seconds } from "./text";
import { theme } from "./theme";
import type { Timeline } from "./timeline";

export class Scrub {
  private readonly bar = by_id<HTMLInputElement>("scrub");
  private readonly ruler = by_id<HTMLCanvasElement>("ruler");

  constructor(
    private readonly time: Timeline,
    private readonly ends: Float64Array,
    moved_by_hand: () => void,
  ) {
    this.bar.min = String(time.start);
    this.bar.max = String(time.span > 0 ? time.end : time.start + 1);
    this.bar.disabled = !(time.span > 0);
    this.bar.addEventListener("input", () => {
      moved_by_hand();
      time.set(Number(this.bar.value));
    });
    time.on_move((t) => this.show(t));
  }
  is(target: EventTarget | null) {
    return target === this.bar;
  }

  private show(t: number) {
    const { span, start, end } = this.time;
    const [clock, whole] = by_id("clock").children;
    this.bar.value = String(t);
    clock.textContent = `${seconds(t, span)}\u00a0s`;
    whole.textContent = span > 0 ? `of ${number(end, 6)}\u00a0s` : "only the start";
    this.bar.setAttribute(
      "aria-valuetext",
      `${seconds(t, span)} seconds of ${seconds(start, span)} to ${seconds(end, span)}`,
    );
  }

  draw_ruler() {
    const { ruler, ends } = this,
      { span, start } = this.time,
      ratio = devicePixelRatio,
      thumb = 8 * ratio;
    const c = ruler.getContext("2d")!;
    ruler.width = ruler.clientWidth * ratio;
    ruler.height = 8 * ratio;
    const width = ruler.width - 2 * thumb;
    c.fillStyle = theme().soft;
    c.globalAlpha = ends.length * 3 * ratio > width ? 0.35 : 0.8;
    for (let k = 0; k < ends.length && span > 0; ++k)
      c.fillRect(
        Math.round(thumb + ((ends[k] - start) / span) * width),
        0,
        Math.max(1, ratio * 0.75),
        (k % 10 ? 5 : 8) * ratio,
      );
  }

  /** To an end of an element: back (-1) or on (1). */
  step_element(by: -1 | 1) {
    const { ends } = this,
      e = element_of(ends, this.time.now);
    const k = ends[e] === this.time.now || by > 0 ? e + by : e;
    this.time.set(ends[Math.min(Math.max(k, 0), ends.length - 1)]);
  }
}
