// SPDX-License-Identifier: BSD-3-Clause
// What is said of a run first: whether it is right, and to how many digits. The words are the program's own.
import type { Run } from "./run";
import { rough } from "./text";

const signs = { good: "\u2713", doubtful: "?", bad: "\u2717" };

/** No number is parted from its unit. */
const unbroken = (text: string) => text.replace(/(\d) s\b/g, "$1\u00a0s");

export function verdict_of(run: Run) {
  const { grade, word, lead, rest, reasons } = run.meta.verdict,
    error = run.figure("estimated_error");
  return {
    grade,
    sign: signs[grade],
    word,
    lead: unbroken(lead),
    rest: [rest && `, ${rest}`, Number.isFinite(error) && ` (estimated error ${rough(error)})`]
      .filter(Boolean)
      .join(""),
    reasons,
  };
}

/** How exact the page itself is. */
export function exactness(run: Run): string {
  const { precision, position_loss, orientation_loss } = run.meta.pose;
  const off = `at most ${rough(position_loss)}\u00a0m and ${rough(orientation_loss)} in directors`;
  if (precision === "double")
    return `Poses are the polynomials of the result itself in double precision, at every instant; what is stored of them differs by ${off}.`;
  if (precision === "rounded")
    return `The run is large: poses are its polynomials, rounded to a ten-millionth of their range, off by ${off}.`;
  return `The run is very large: poses are thinned to fewer elements and rounded, off by ${off} where it was looked at, inside every element.`;
}
