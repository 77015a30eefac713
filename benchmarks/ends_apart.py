# SPDX-License-Identifier: BSD-3-Clause
"""How far apart the ends of time may be: motions of seven mechanisms, from what is known of them at two instants.

    benchmarks/ends_apart.py build/release/livens [--guess 0.9] [--ends xx xp px] [--mechanism NAME ..] [--limit 300] [--jobs 2] [--least N] [--control N] [--newton]

Each motion is marched first, from 0.5 s on. Then places (x) or momenta (p) at its two ends are all that is known, over 0.25 to
4 s, beside rates times `--guess` at the start and none at the end: lobatto(8), 20 elements a second. A motion counts if the
program gives it with exit 0, and a march from the start that it has arrives where it does: within 1e-9 lengths and what both say
of their errors, times what a small change of the start grows by. Several motions may meet the same conditions. Two counts stand beside:
those found by plain guesses (marches from either end, with the rates of the other end, too), without those that ends which are led or
other rates found; and the control, what Newton's iteration finds from its first guess alone, which where no rates are stated at the
known places is the nearer of a march from rest and one with the rates of the other end. Exit status 1 if fewer than --least count,
or fewer than --control more than the control has. With --newton all is the control of plain Newton: each problem is given one guess,
the march from the stated start with the rates as they are guessed (or those of the stated momenta), and counts if the iteration from it
gets there at once, by no other guess, led end or rate.
"""
import argparse
import concurrent.futures
import copy
import json
import pathlib
import subprocess
import sys
import tempfile
import tomllib

EXAMPLES = pathlib.Path(__file__).resolve().parents[1] / "examples"
DURATIONS = (0.25, 0.5, 1.0, 1.5, 2.0, 3.0, 4.0)
ENDS = {"xx": ("positions", "positions"), "xp": ("positions", "momenta"), "px": ("momenta", "positions")}
BEGIN, PER_SECOND, DEGREE = 0.5, 20, 8
EXACT = 1e-9   # lengths of the model, of a march from the start that was found


def written(value):
    """As TOML has it."""
    if isinstance(value, bool):
        return str(value).lower()
    if isinstance(value, dict):
        return "{ " + ", ".join(f"{key} = {written(of)}" for key, of in value.items()) + " }"
    if isinstance(value, list):
        return "[" + ", ".join(map(written, value)) + "]"
    return json.dumps(value)


def scenario(tree):
    """Every value in one line; `format` comes first."""
    return "\n".join(f"{key} = {written(tree[key])}" for key in sorted(tree, key=lambda key: key != "format")) + "\n"


def mechanisms():
    """Scenarios without times and ends: name -> tree."""
    def of(name):
        tree = tomllib.loads((EXAMPLES / f"{name}.toml").read_text())
        return {key: value for key, value in tree.items() if key not in ("method", "time", "start", "end", "sensor")}

    two, free, crank = of("ball_pendulum_two"), of("furuta_pendulum"), of("slider_crank")
    three = copy.deepcopy(two)
    third, wrist = copy.deepcopy(three["body"][1]), copy.deepcopy(three["joint"][1])
    third |= {"name": "third", "position": [1, 1, 0], "directors": [[1, 0, 0], [0, 1, 0], [0, 0, 1]]}
    wrist |= {"name": "wrist", "between": ["lower", "third"], "at": [1, 1, 0]}
    three["body"].append(third)
    three["joint"].append(wrist)
    free.pop("load")
    for key in ("drive", "load"):
        crank.pop(key, None)
    crank |= {"gravity": [0, -9.81, 0], "start": {"initial": "project"}}   # in its plane: else it rests
    return {"double_pendulum_offset": of("double_pendulum_offset"), "ball_pendulum_two": two, "four_bar": of("four_bar"), "chain3": three,
            "furuta_free": free, "furuta_controlled": of("furuta_pendulum"), "slider_free": crank}


class Runs:
    """The program, and where it writes."""

    def __init__(self, program, folder, limit):
        self.program, self.folder, self.limit = str(pathlib.Path(program).resolve()), pathlib.Path(folder), limit

    def solve(self, name, tree, *more):
        """Exit status, the summary and the run; status -1: out of time."""
        file, run = self.folder / f"{name}.toml", self.folder / f"{name}.nc"
        file.write_text(scenario(tree))
        try:
            done = subprocess.run([self.program, "solve", str(file), "-o", str(run), "--json", "--force", *more], capture_output=True, text=True,
                                  timeout=self.limit, cwd=self.folder)
        except subprocess.TimeoutExpired:
            return -1, {}, run
        return done.returncode, json.loads(done.stdout) if done.stdout.startswith("{") else {}, run

    def state(self, run, tree, t):
        """Of all bodies: name -> what `livens sample` says."""
        def of(body):
            done = subprocess.run([self.program, "sample", str(run), "--body", body["name"], "--at", repr(float(t)), "--json"],
                                  capture_output=True, text=True, check=True)
            return json.loads(done.stdout)
        return {body["name"]: of(body) for body in tree["body"]}


def placed(state, rates):
    """A body's place, and its rates times a factor, or none."""
    keys = {"position": state["position"]} | ({"directors": state["directors"]} if state.get("directors") else {})
    moving = ("velocity", "angular_velocity") if state.get("directors") else ("velocity",)
    return keys | ({key: [rates * v for v in state[key]] for key in moving} if rates is not None else {})


def between(tree, first, last, duration, ends, guess):
    """The scenario of what is known at both ends."""
    tree = copy.deepcopy(tree)
    at_start, at_end = ENDS[ends]
    for body in tree["body"]:
        for key in ("velocity", "angular_velocity", "angular_velocity_body"):
            body.pop(key, None)
        body["start"] = placed(first[body["name"]], 1 if at_start == "momenta" else guess)
        body["end"] = placed(last[body["name"]], None if at_end == "positions" else 1)
    return tree | {"time": {"end": duration, "elements": max(2, round(PER_SECOND * duration))}, "method": {"family": "lobatto", "degree": DEGREE},
                   "start": {"given": at_start}, "end": {"given": at_end}}


def march_from(tree):
    """The scenario of a march from the start that it has."""
    march = {key: value for key, value in copy.deepcopy(tree).items() if key != "end"} | {"start": {"initial": "project"}}
    for body in march["body"]:
        body.pop("end")
    return march


def is_confirmed(runs, name, tree, run, summary):
    """Whether a march from the start of a run arrives where it does."""
    end = tree["time"]["end"]
    start, arrival = (runs.state(run, tree, t) for t in (0, end))
    march = march_from(tree)
    march["time"]["elements"] *= 2
    march["method"]["growth"] = True
    for body in march["body"]:
        body["start"] = placed(start[body["name"]], 1)
    status, of_march, other = runs.solve(name + "_march", march)
    if status not in (0, 7):
        return False
    off = max(abs(a - b) for body, state in runs.state(other, march, end).items() for a, b in zip(state["position"], arrival[body]["position"]))
    length, growth = summary["model_length"], max(1, of_march.get("growth") or 1)
    return off / length <= growth * (EXACT + 10 * (summary.get("estimated_error") or 0)) + 10 * (of_march.get("estimated_error") or 0)


def case(runs, name, tree, forward, ends, duration, guess, by_newton):
    """Status, whether a march confirms it, the note on how it was found, and whether that was by the first guess."""
    asked = between(tree, runs.state(forward, tree, BEGIN), runs.state(forward, tree, BEGIN + duration), duration, ends, guess)
    label = f"{name}_{ends}_{guess}_{duration}"
    more = []
    if by_newton:
        status, _, run = runs.solve(label + "_guess", march_from(asked))
        if status not in (0, 7):   # no guess
            return label, status, False, "", False
        more = ["--guess", str(run)]
    status, summary, run = runs.solve(label, asked, *more)
    told = next((note for note in summary.get("notes", []) if note.startswith("found ")), "")
    is_first = summary.get("rescued") == 0 and not told
    counts = status == 0 and (is_first or not by_newton) and is_confirmed(runs, label, asked, run, summary)
    return label, status, counts, told, is_first


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("program")
    parser.add_argument("--guess", type=float, default=0.9)
    parser.add_argument("--ends", nargs="+", choices=list(ENDS), default=list(ENDS))
    parser.add_argument("--mechanism", nargs="+", default=list(mechanisms()))
    parser.add_argument("--limit", type=float, default=300, help="s of one run")
    parser.add_argument("--jobs", type=int, default=2)
    parser.add_argument("--least", type=int, default=0)
    parser.add_argument("--control", type=int, default=0)
    parser.add_argument("--newton", action="store_true")
    options = parser.parse_args()
    counted = plain = first = tried = 0
    with tempfile.TemporaryDirectory() as folder, concurrent.futures.ThreadPoolExecutor(options.jobs) as pool:
        runs, asked = Runs(options.program, folder, options.limit), []
        for name in options.mechanism:
            tree = mechanisms()[name]
            forward = {key: value for key, value in tree.items()} | {"time": {"end": 9, "elements": 540}, "method": {"family": "lobatto", "degree": DEGREE}}
            status, _, run = runs.solve("forward_" + name, forward)
            if status not in (0, 7):
                sys.exit(f"{name}: its march ends with {status}")
            tree.pop("start", None)
            asked += [pool.submit(case, runs, name, tree, run, ends, T, options.guess, options.newton) for ends in options.ends for T in DURATIONS]
        for one in asked:
            label, status, confirmed, told, is_first = one.result()
            tried, counted, plain = tried + 1, counted + confirmed, plain + (confirmed and not told)
            first += confirmed and is_first   # a guess that cannot be begun with is no run
            by = told or ("" if not confirmed or is_first else "found by another plain guess than the first")
            print(f"{label:45s} {'yes' if confirmed else 'no '} {status:3d} {by}", flush=True)
    print(f"{counted} of {tried}, {plain} of them by plain guesses, {first} by the first guess alone")
    return counted < options.least or counted < first + options.control


if __name__ == "__main__":
    sys.exit(main())
