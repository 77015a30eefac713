// SPDX-License-Identifier: BSD-3-Clause
// Which plots stand beside the picture to begin with.
import type { Run } from "./run";
import { instants, type PlotSpec } from "./specs";

const twins = 40; // instants at which plots are the same
const seen = 5e-3; // of the largest value: no eye tells less apart, and curves are interpolated

function travels(run: Run, b: number): boolean {
  const from = run.centre(b, run.motion.start);
  return instants(run, 49).some((t) => run.centre(b, t).distanceTo(from) > 1e-6 * run.meta.length);
}
/** The same lines under another name. */
function is_twin(run: Run, a: PlotSpec, b: PlotSpec): boolean {
  if (a.unit !== b.unit || a.series.length !== b.series.length) return false;
  return a.series.every(({ at }, i) => {
    const pairs = instants(run, twins).map((t) => [at(t), b.series[i].at(t)]),
      size = Math.max(...pairs.flat().map(Math.abs));
    return pairs.every(([u, v]) => Math.abs(u - v) <= seen * size);
  });
}

/** What a stranger should see first. */
export function default_plots(run: Run): string[] {
  const spec = (id: string) => run.specs.find((s) => s.id === id);
  const motors = ["motor torques", "motor forces", "motor power"],
    joints = ["joints angle", "joints angle 2", "joints displacement"].filter(spec);
  const sensors = run.specs
    .filter((s) => s.id.startsWith("sensor "))
    .slice(0, 2)
    .map((s) => s.id);
  const about_bodies = joints.length
    ? []
    : run.meta.bodies.length === 1
      ? [...(travels(run, 0) ? ["body 0 position"] : []), "body 0 spin"]
      : ["heights", "speeds"];
  const chosen: PlotSpec[] = [];
  for (const id of [
    ...motors,
    ...sensors,
    ...joints,
    ...about_bodies,
    "energy",
    "reactions",
    "loads",
    "load torques",
  ]) {
    const one = spec(id);
    if (one && !chosen.some((other) => is_twin(run, one, other))) chosen.push(one);
  }
  const most = motors.some(spec) ? 5 : 4;
  return chosen.slice(0, most).map((s) => s.id);
}
