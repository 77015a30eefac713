#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Two carriages with a relay between them: where does the motion slide, and where does it pass?

    experiments/relays.py [N [SEED]]        LIVENS_PROGRAM names the program

The first runs on a rail under D(t) = D0 + D1 sin(w1 t), the second on the first under B sin(w2 t) - c sign(r'), r being how far
it has gone on it. Then r'' = f(t) - k sign(r') with k = c (1/m1 + 1/m2), and f known: between zeros of r' all is a closed form.
At a zero with |f| <= k no classical motion goes on, however soon f grows beyond k. Such a motion has to be refused there, by the
name of the load; any other has to reach its accuracy. Half of them begin with r' = 0. Exit 1 where one is neither.
"""
import json
import math
import os
import pathlib
import random
import subprocess
import sys
import tempfile

PROGRAM = os.environ.get("LIVENS_PROGRAM", str(pathlib.Path(__file__).resolve().parents[1] / "build/release/livens"))
SCENARIO = """format = 1
[[body]]
name = "a"
mass = {m1!r}
inertia = [1, 1, 1]
position = [0, 0, 0]
[[body]]
name = "b"
mass = {m2!r}
inertia = [1, 1, 1]
position = [0, 1, 0]
[[joint]]
name = "p"
type = "prismatic"
between = ["world", "a"]
at = [0, 0, 0]
axis = [1, 0, 0]
[[joint]]
name = "q"
type = "prismatic"
between = ["a", "b"]
at = [0, 1, 0]
axis = [1, 0, 0]
rate = {rate!r}
[[load]]
name = "drive"
type = "actuator"
joint = "p"
expression = "{D0!r} + {D1!r}*sin({w1!r}*t)"
[[load]]
name = "relay"
type = "actuator"
joint = "q"
expression = "{B!r}*sin({w2!r}*t) - {c!r}*sign(q.displacement_rate)"
[time]
end = {end!r}
accuracy = {accuracy!r}
"""


class Relay:
    """r'' = b sin(w2 t) - d0 - d1 sin(w1 t) - k sign(r')."""

    def __init__(self, m1, m2, D0, D1, w1, B, w2, c, **_):
        both = 1 / m1 + 1 / m2
        self.terms = ((B * both, w2), (-D1 / m1, w1))
        self.steady, self.k = -D0 / m1, c * both
        self.step = 1e-2 / max(10, w1, w2)

    def force(self, t):
        return self.steady + sum(a * math.sin(w * t) for a, w in self.terms)

    def go(self, t0, r, v, side, t):
        """Place and rate at t, from those at t0 on one side."""
        h, push = t - t0, self.steady - side * self.k
        r, v = r + v * h + push * h * h / 2, v + push * h
        for a, w in self.terms:
            r += a / w * (math.cos(w * t0) * h - (math.sin(w * t) - math.sin(w * t0)) / w)
            v += a / w * (math.cos(w * t0) - math.cos(w * t))
        return r, v

    def motion(self, v, end):
        """The instant from which it slides, or None; the place at the end; how often the rate was zero."""
        t, r, passages = 0.0, 0.0, 0
        while True:
            if v == 0 and abs(self.force(t)) <= self.k:
                return t, r, passages
            side = math.copysign(1, v or self.force(t))
            before, behind = t, t + 1e-9
            while behind < end and side * self.go(t, r, v, side, behind)[1] > 0:
                before, behind = behind, behind + self.step
            if behind >= end:
                return None, self.go(t, r, v, side, end)[0], passages
            for _ in range(80):
                middle = (before + behind) / 2
                if side * self.go(t, r, v, side, middle)[1] > 0:
                    before = middle
                else:
                    behind = middle
            r, t, v, passages = self.go(t, r, v, side, behind)[0], behind, 0.0, passages + 1


def draw():
    pick = random.uniform
    return {"m1": pick(0.5, 5), "m2": pick(0.5, 5), "rate": random.choice([0.0, pick(-2, 2)]), "D0": pick(-3, 3),
            "D1": pick(-20, 20), "w1": pick(1, 20), "B": pick(-30, 30), "w2": pick(2, 30),
            "c": random.choice([pick(0.5, 4), pick(3, 20)]), "end": pick(1, 6), "accuracy": random.choice([1e-4, 1e-6, 1e-9])}


def solved(folder, numbers):
    """Exit status, message, and the last instant and place."""
    path, file = folder / "relay.toml", str(folder / "relay.nc")
    path.write_text(SCENARIO.format(**numbers))
    run = subprocess.run([PROGRAM, "solve", path, "-o", file, "--force", "--json"], capture_output=True, text=True, timeout=120)
    told = json.loads(run.stdout)
    if run.returncode != 0:
        return run.returncode, told["message"], math.nan
    sample = subprocess.run([PROGRAM, "sample", file, "--joint", "q", "--at", repr(numbers["end"]), "--json"],
                            capture_output=True, text=True, check=True)
    return 0, "", json.loads(sample.stdout)["displacement"]


def main():
    n, seed = (int(sys.argv[i]) if len(sys.argv) > i else default for i, default in ((1, 200), (2, 1)))
    random.seed(seed)
    wrong = slid = passages = 0
    with tempfile.TemporaryDirectory() as folder:
        for i in range(n):
            numbers = draw()
            slides, place, passed = Relay(**numbers).motion(numbers["rate"], numbers["end"])
            code, message, found = solved(pathlib.Path(folder), numbers)
            if slides is None:
                good = code == 0 and abs(found - place) <= 2 * numbers["accuracy"]
            else:
                where = message.partition("sliding mode near t = ")[2].partition(" ")[0]
                # an instant is as good as the rate there
                near = max(1e-4, 100 * numbers["accuracy"]) * max(1, slides)
                good = code != 0 and where != "" and "load 'relay'" in message and abs(float(where) - slides) <= near
            slid, passages, wrong = slid + (slides is not None), passages + passed, wrong + (not good)
            if not good:
                print(f"run {i}: slides {slides}, {passed} passages, accuracy {numbers['accuracy']:.0e}; exit {code}, {message}, "
                      f"off by {abs(found - place):.1e}")
    print(f"{n} motions, {slid} of which slide, {passages} passages; {wrong} are wrong")
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
