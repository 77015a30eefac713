// SPDX-License-Identifier: BSD-3-Clause
// The bar of time with the ends of elements below it, marks of events with names, and the clock.
import type { MotionEvent } from "./data";
import { element_of } from "./motion";
import { by_id, element, number, seconds } from "./text";
import { theme } from "./theme";
import type { Timeline } from "./timeline";

export class Scrub {
  private readonly bar = by_id<HTMLInputElement>("scrub");
  private readonly ruler = by_id<HTMLCanvasElement>("ruler");
  private readonly marks: HTMLElement[] = [];

  constructor(
    private readonly time: Timeline,
    private readonly ends: Float64Array,
    moved_by_hand: () => void,
    private readonly events: MotionEvent[] = [],
  ) {
    const row = by_id("marks"),
      most = 400; // more are a grey bar
    row.hidden = events.length === 0 || !(time.span > 0);
    for (const event of events.slice(0, most)) {
      const mark = element(
        "button",
        {
          type: "button",
          title: `${event.name} at ${number(event.t, 9)}\u00a0s`,
          "aria-label": `to ${event.name} at ${number(event.t, 6)} seconds`,
        },
        element("i", {}),
        element("span", {}, event.name),
      );
      if (event.speed > 0) mark.classList.add("hit");
      mark.addEventListener("click", () => {
        moved_by_hand();
        time.set(event.t);
      });
      this.marks.push(mark);
    }
    row.append(...this.marks);
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

  /** Where they are, and names as far as there is room for them. */
  private place_marks() {
    const row = by_id("marks"),
      { span, start } = this.time,
      thumb = 8,
      width = row.clientWidth - 2 * thumb;
    let free = -Infinity;
    this.marks.forEach((mark, k) => {
      const x = thumb + ((this.events[k].t - start) / span) * width,
        name = mark.lastElementChild as HTMLElement;
      mark.style.left = `${x}px`;
      name.hidden = false;
      const wide = name.offsetWidth + 6,
        is_left = x + wide > row.clientWidth;
      mark.classList.toggle("left", is_left);
      name.hidden = (is_left ? x - wide : x) < free;
      if (!name.hidden) free = is_left ? x : x + wide;
    });
  }

  draw_ruler() {
    if (this.marks.length && this.time.span > 0) this.place_marks();
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
