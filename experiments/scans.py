# SPDX-License-Identifier: BSD-3-Clause
"""What the scans share: scenarios without their mesh, true motions, errors as livens states them, counts.

A scan solves many meshes, or to many accuracies, and counts how often what the program says of its own answer
is untrue. Errors are those that `estimated_error` stands for (docs/program.md): the larger of the distance of
centres of mass in lengths of the model and of the angle between orientations, over bodies and element ends.
"""
import math
import resource
import sys

import numpy as np

import paper
import truth

# Where links lie on one line again and again, joints by accelerations say nothing.
REDUCED = {"p02_four_bars_2": truth.Parallelograms, "p02_four_bars_40": truth.Parallelograms}
RUNS = (paper.CONVERGED, paper.SUSPECT, paper.NOT_CONVERGED)   # exit codes that a scan counts


def mechanism(name):
    """Text of a scenario: an example of the program, or one of mechanisms/."""
    for folder in ("examples", "examples/benchmarks", "experiments/mechanisms"):
        path = paper.ROOT / folder / f"{name}.toml"
        if path.exists():
            return path.read_text(encoding="utf-8")
    raise paper.Broken(f"no mechanism is called {name}")


def scenario(name, time, method):
    """That mechanism with another [time] and [method]."""
    return mechanism(name).split("[time]")[0] + paper.table("[time]", time) + paper.table("[method]", method)


def true_motion(name, end):
    """Kept in build/truth, since it hangs on nothing but the mechanism."""
    return truth.of(scenario(name, {"end": end}, {}), end, paper.ROOT / "build" / "truth",
                    REDUCED.get(name, truth.Mechanism))


def length_of(e, name):
    """What the program divides errors of positions by, m; it is told with estimates alone."""
    short = scenario(name, {"end": 1e-3, "elements": 1}, paper.lobatto(4))
    return e.measure_all([short], lambda run: run.attribute("model_length"))[0]


def distances(run, motion, length, t, centres, triads):
    """At each instant, (time); triads (time, body, director, xyz)."""
    there, turned = motion.at(np.minimum(t, float(motion.ends[-1])))
    far = np.linalg.norm(centres - there, axis=2) / length
    apart = np.linalg.norm(np.swapaxes(triads, 2, 3) - turned, axis=(2, 3)) / math.sqrt(8)
    return np.maximum(far, np.where(run["is_point_mass"], 0, 2 * np.arcsin(np.minimum(apart, 1)))).max(axis=1)


def errors(run, motion, length):
    """At each output time of a run, (time); one infinite number if it has none."""
    if "time" not in run.file.variables:
        return np.array([math.inf])
    centres = run["center_of_mass"]
    triads = run["directors"] if "directors" in run.file.variables else np.zeros((*centres.shape, 3))
    return distances(run, motion, length, run["time"], centres, np.nan_to_num(triads))   # nan: points have none


def errors_at_ends(run, motion, length):
    """Instants and errors at all ends of elements."""
    if "X" not in run.file.variables:
        return np.zeros(1), np.array([math.inf])
    ends = run["element_end"]
    X = run["X"][np.searchsorted(run["X_node"], ends)]
    triads = X[:, :, 1:]
    mass = run["body_mass_matrix"]   # in the axes of X, also where directors are skew
    centres = X[:, :, 0] + ((mass[:, 0, 1:] / mass[:, 0, :1])[None, :, :, None] * triads).sum(axis=2)
    return ends, distances(run, motion, length, ends, centres, triads)


def errors_everywhere(run, motion, length):
    """Instants and errors at output times and at all ends of elements, of which `accuracy` and `estimated_error`
    speak. Nearly all of the former are among the latter: not those on singular positions of the joints."""
    ends, there = errors_at_ends(run, motion, length)
    if "X" not in run.file.variables or "time" not in run.file.variables:
        return ends, there
    return np.concatenate([ends, run["time"]]), np.concatenate([there, errors(run, motion, length)])


def so_far(e, text):
    """A remark that is seen at once, with the work done until then."""
    e.remark(f"{text}; {cpu_minutes():.1f} CPU minutes so far")
    print("  " + e.remarks[-1], file=sys.stderr)


def cpu_minutes():
    """Of this process and all that it waited for."""
    return sum(usage.ru_utime + usage.ru_stime for usage in
               map(resource.getrusage, (resource.RUSAGE_SELF, resource.RUSAGE_CHILDREN))) / 60


def share(part, whole):
    return len(part) / max(len(whole), 1)
