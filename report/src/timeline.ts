// SPDX-License-Identifier: BSD-3-Clause
// The one instant that everything shows, and the span of time that plots show.

export class Timeline {
  now: number;
  range: [number, number];
  private readonly moved: ((t: number) => void)[] = [];
  private readonly zoomed: (() => void)[] = [];
  readonly span: number;
  constructor(
    readonly start: number,
    readonly end: number,
  ) {
    this.span = end - start;
    this.now = start;
    this.range = this.whole();
  }
  private whole(): [number, number] {
    return this.end > this.start ? [this.start, this.end] : [this.start - 0.5, this.start + 0.5];
  }
  get is_whole() {
    return this.whole().every((t, i) => t === this.range[i]);
  }
  on_move(act: (t: number) => void) {
    this.moved.push(act);
  }
  on_zoom(act: () => void) {
    this.zoomed.push(act);
  }
  set(t: number) {
    if (!Number.isFinite(t)) return;
    this.now = Math.min(Math.max(t, this.start), this.end);
    for (const act of this.moved) act(this.now);
  }
  /** null: everything. */
  zoom(range: [number, number] | null) {
    const [from, to] = range ?? this.whole(),
      least = 1e-9 * (this.end - this.start || 1);
    this.range =
      to - from > least ? [Math.max(from, this.whole()[0]), Math.min(to, this.whole()[1])] : this.range;
    for (const act of this.zoomed) act();
  }
  /** Times the length shown, about the instant. */
  zoom_by(factor: number) {
    const [from, to] = this.range;
    this.zoom([this.now - (this.now - from) * factor, this.now + (to - this.now) * factor]);
  }
}
