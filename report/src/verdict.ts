// SPDX-License-Identifier: BSD-3-Clause
// What is said of a run first: whether it is right, and to how many digits.
import type { Run } from "./run";
import { number, rough } from "./text";

export interface Verdict {
  grade: "good" | "doubtful" | "bad";
  sign: string;
  word: string;
  digits: string;
  rest: string;
  reasons: string[];
}

const times = (n: number) => `${n} ${n === 1 ? "digit" : "digits"}`;

export function verdict_of(run: Run): Verdict {
  const { meta } = run,
    good = run.figure("good_digits"),
    until = run.figure("good_until"),
    all = Math.floor(run.figure("estimated_digits"));
  const reasons =
    meta.status === "converged"
      ? []
      : [meta.message, ...meta.notes.filter((n) => n !== meta.message)].filter((s) => s !== "");
  const end = number(meta.end, 6),
    error = run.figure("estimated_error");
  let digits = "",
    rest = "";
  if (Number.isFinite(good) && good >= 1) {
    digits =
      until < meta.end
        ? `right to ${times(good)} until ${number(until, 6)}\u00a0s`
        : `right to ${times(good)}`;
    rest = until < meta.end ? `, to ${times(all)} until ${end}\u00a0s` : ` throughout ${end}\u00a0s`;
  } else if (Number.isFinite(error)) {
    digits = `right to ${times(Math.max(all, 0))}`;
    rest = ` throughout ${end}\u00a0s`;
  } else {
    rest = "its error was not estimated";
  }
  if (Number.isFinite(error)) rest += ` (estimated error ${rough(error)})`;
  if (meta.status === "converged")
    return { grade: "good", sign: "\u2713", word: "Converged", digits, rest, reasons };
  if (meta.status === "suspect")
    return {
      grade: "doubtful",
      sign: "?",
      word: "Suspect",
      digits: "do not trust it",
      rest: ": the solver converged, but the motion fails its checks",
      reasons,
    };
  const far =
    run.figure("elements") > 0
      ? `ends at ${end}\u00a0s of ${number(meta.wanted_end, 6)}\u00a0s`
      : "nothing was solved; this is the start";
  return {
    grade: "bad",
    sign: "\u2717",
    word:
      meta.status === "cancelled"
        ? "Cancelled"
        : `Not converged${meta.status === "not converged" ? "" : ` (${meta.status})`}`,
    digits: far,
    rest: "",
    reasons,
  };
}

/** How exact the page itself is. */
export function exactness(run: Run): string {
  const { precision, position_loss, orientation_loss } = run.meta.pose;
  const off = `at most ${rough(position_loss)}\u00a0m and ${rough(orientation_loss)} in directors`;
  if (precision === "double")
    return `Poses are the polynomials of the result itself in double precision, at every instant; what is stored of them differs by ${off}.`;
  if (precision === "single")
    return `The run is large: poses are its polynomials in single precision, off by ${off}.`;
  return `The run is very large: poses are thinned to fewer elements in single precision, off by ${off} where it was looked at, inside every element.`;
}
