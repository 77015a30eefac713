// SPDX-License-Identifier: BSD-3-Clause
// Axes of plots: what they reach, where their lines stand, how powers of ten are written.
import type uPlot from "uplot";

/** The first of ascending times that is not before t. */
export function near(times: ArrayLike<number>, t: number) {
  let low = 0,
    high = times.length - 1;
  while (low < high) {
    const middle = (low + high) >> 1;
    if (times[middle] < t) low = middle + 1;
    else high = middle;
  }
  return low;
}
/** Powers of ten, some seven of them. */
export function decades(_: uPlot, __: number, low: number, high: number) {
  const from = Math.round(Math.log10(low)),
    to = Math.round(Math.log10(high)),
    step = Math.max(1, Math.ceil((to - from) / 7));
  return Array.from(
    { length: Math.floor((to - from) / step) + 1 },
    (_unused, k) => 10 ** (to - k * step),
  ).reverse();
}
/** Rounding is no signal: a constant is shown as one. */
export function padded(low: number | null, high: number | null): [number, number] {
  if (low === null || high === null) return [-1, 1];
  const middle = (low + high) / 2,
    half = Math.max((high - low) / 2, 1e-6 * Math.abs(middle), 1e-12);
  return [middle - 1.12 * half, middle + 1.12 * half];
}
const digits = "\u2070\u00b9\u00b2\u00b3\u2074\u2075\u2076\u2077\u2078\u2079";
export function power(v: number) {
  const e = Math.round(Math.log10(v));
  if (Math.abs(v / 10 ** e - 1) > 1e-6) return "";
  return "10" + (e < 0 ? "\u207b" : "") + [...String(Math.abs(e))].map((d) => digits[Number(d)]).join("");
}
/** Round numbers from low to high, about `n` of them. */
export function ticks(low: number, high: number, n: number): number[] {
  const least = (high - low) / Math.max(n, 1),
    power_of_ten = 10 ** Math.floor(Math.log10(least)),
    step = power_of_ten * [1, 2, 5, 10].find((m) => m * power_of_ten >= 0.999999 * least)!;
  if (!(step > 0) || !Number.isFinite(step)) return [low];
  const first = Math.ceil(low / step - 1e-9),
    last = Math.floor(high / step + 1e-9);
  return Array.from({ length: Math.max(0, last - first + 1) }, (_, k) => (first + k) * step);
}
