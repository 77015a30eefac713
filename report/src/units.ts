// SPDX-License-Identifier: BSD-3-Clause
// Units as people want to read them: angles in radians, degrees, or revolutions a minute. What was chosen is remembered.

export type Angles = "rad" | "deg" | "rpm";
export interface Unit {
  unit: string;
  factor: number; // what a value is multiplied by
}

const degrees = 180 / Math.PI;
const place = "livens.angles"; // in what the browser keeps of this page
const followers = new Set<() => void>();

function remembered(): Angles {
  try {
    const kept = localStorage.getItem(place);
    return kept === "deg" || kept === "rpm" ? kept : "rad";
  } catch {
    return "rad"; // in a frame that may keep nothing
  }
}
let angles: Angles = remembered();

export const angles_now = () => angles;
export function set_angles(wanted: Angles) {
  angles = wanted;
  try {
    localStorage.setItem(place, wanted);
  } catch {
    // until the page is closed
  }
  for (const act of followers) act();
}
export function on_angles(act: () => void, signal: AbortSignal) {
  followers.add(act);
  signal.addEventListener("abort", () => followers.delete(act));
}

/** m s-2 as m/s², and angles as wanted. */
export function shown_in(unit: string): Unit {
  const plain = unit
    .replace(/ s-(\d)/, (_, n: string) => (n === "1" ? "/s" : `/s${n}`))
    .replace(/\^2|(?<=s)2$/, "\u00b2");
  if (angles === "rad" || !/^rad(?![a-z])/.test(plain)) return { unit: plain, factor: 1 };
  if (angles === "rpm" && plain === "rad/s") return { unit: "rpm", factor: 30 / Math.PI };
  return { unit: plain.replace(/^rad/, "deg"), factor: degrees };
}
export const is_angular = (unit: string) => /^rad(?![a-z])/.test(unit);
