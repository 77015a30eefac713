// SPDX-License-Identifier: BSD-3-Clause
// Elements and numbers as text. Names of runs are other people's: they become text nodes and nothing else.

type Child = Node | string | null | undefined | false;

/** An element with attributes and children; strings become text. */
export function element<K extends keyof HTMLElementTagNameMap>(
  tag: K,
  attributes: Record<string, string> = {},
  ...children: Child[]
): HTMLElementTagNameMap[K] {
  const made = document.createElement(tag);
  for (const [name, value] of Object.entries(attributes)) made.setAttribute(name, value);
  for (const child of children) if (child) made.append(child);
  return made;
}

export function by_id<T extends HTMLElement = HTMLElement>(id: string): T {
  return document.getElementById(id) as T;
}

const minus = (text: string) => text.replaceAll("-", "\u2212");

/** A few significant digits, for people: 0.0312, 12.4, 3.1e-12. */
export function number(x: number | null | undefined, digits = 4): string {
  if (x === null || x === undefined || Number.isNaN(x)) return "\u2013";
  if (x === 0) return "0";
  const size = Math.abs(x);
  if (!Number.isFinite(x)) return "\u221e";
  if (size >= 1e-3 && size < 1e5) return minus(String(Number(x.toPrecision(digits))));
  return minus(x.toExponential(Math.min(digits - 1, 2)).replace(/\.?0*e\+?/, "e"));
}
/** An error: one or two digits are all that is known of it. */
export function rough(x: number | null | undefined): string {
  return x === null || x === undefined || Number.isNaN(x)
    ? "not known"
    : x === 0
      ? "0"
      : minus(x.toExponential(1).replace("e+", "e").replace(".0e", "e"));
}
/** With a fixed number of digits, so that it does not dance while it runs. */
export function steady(x: number, digits = 5): string {
  if (Number.isNaN(x)) return "\u2013";
  const size = Math.abs(x);
  if (size !== 0 && (size < 1e-4 || size >= 1e6))
    return minus(x.toExponential(digits - 2).replace("e+", "e"));
  const before = size < 1 ? 1 : Math.floor(Math.log10(size)) + 1;
  return minus(x.toFixed(Math.max(0, digits - before)));
}
export function seconds(t: number, span: number): string {
  const digits = Math.min(Math.max(Math.ceil(3 - Math.log10(span || 1)), 0), 9);
  return minus(t.toFixed(digits));
}
/** 1, 2 or 5 times a power of ten, at most x. */
export function nice(x: number): number {
  const power = 10 ** Math.floor(Math.log10(x)),
    m = x / power;
  return (m >= 5 ? 5 : m >= 2 ? 2 : 1) * power;
}
/** Text of a canvas that is not wider than that, with dots where it was cut. */
export function shortened(c: CanvasRenderingContext2D, text: string, width: number): string {
  if (c.measureText(text).width <= width) return text;
  const letters = [...text];
  let low = 0,
    high = letters.length;
  while (low < high) {
    const middle = (low + high + 1) >> 1;
    if (c.measureText(`${letters.slice(0, middle).join("")}\u2026`).width <= width) low = middle;
    else high = middle - 1;
  }
  return `${letters.slice(0, low).join("")}\u2026`;
}
