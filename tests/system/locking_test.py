# SPDX-License-Identifier: BSD-3-Clause
"""Mechanisms that are driven further than they can go: the program says what locks, where, and what to try.

    LIVENS_PROGRAM=build/release/livens python3 locking_test.py [CLASS ...]
"""
import json
import math
import re
import unittest

from program_test import ProgramTest

FOUR_BAR = """format = 1
gravity = [0, -9.81, 0]
[[body]]
name = "crank"
shape = { box = [1, 0.05, 0.05] }
mass = 1
position = [0, 0.5, 0]
rotation_vector = [0, 0, "90 deg"]
[[body]]
name = "coupler"
shape = { box = [1, 0.05, 0.05] }
mass = 1
position = [0.5, 1, 0]
[[body]]
name = "rocker"
shape = { box = [1.4142135623730951, 0.05, 0.05] }
mass = 1
position = [1.5, 0.5, 0]
rotation_vector = [0, 0, "-45 deg"]
[[joint]]
name = "A"
type = "revolute"
between = ["world", "crank"]
at = [0, 0, 0]
axis = [0, 0, 1]
[[joint]]
name = "B"
type = "revolute"
between = ["crank", "coupler"]
at = [0, 1, 0]
axis = [0, 0, 1]
[[joint]]
name = "C"
type = "revolute"
between = ["coupler", "rocker"]
at = [1, 1, 0]
axis = [0, 0, 1]
[[joint]]
name = "D"
type = "revolute"
between = ["rocker", "world"]
at = [2, 0, 0]
axis = [0, 0, 1]
[[drive]]
name = "motor"
type = "joint"
joint = "A"
expression = "t^2"
"""
TIMES = ("end = 3", "end = 3\nelements = 300", "end = 3\naccuracy = 1e-9\noutput = 0.01", "end = 0.46\naccuracy = 1e-4")
# coupler and rocker on one line: |(cos a, sin a) - (2, 0)| = 1 + sqrt 2, a = 90 deg + t^2
DEAD = math.sqrt(math.acos((5 - (1 + math.sqrt(2)) ** 2) / 4) - math.pi / 2)

# Held where it stands, it makes a five-bar of the four-bar.
POST = """[[body]]
name = "post"
shape = { box = [1, 0.05, 0.05] }
mass = 1
position = [2, -0.5, 0]
rotation_vector = [0, 0, "90 deg"]
[[joint]]
name = "E"
type = "revolute"
between = ["world", "post"]
at = [2, -1, 0]
axis = [0, 0, 1]
[[drive]]
name = "mover"
type = "joint"
joint = "A"
expression = "t^2"
[[drive]]
name = "holder"
type = "joint"
joint = "E"
expression = "0"
"""

# A slot on the crank, a pin on the yoke: x = 0.1 / cos(12 t).
YOKE = """format = 1
[[body]]
name = "crank"
shape = { cylinder = { radius = 0.15, length = 0.02 } }
mass = 2
[[body]]
name = "yoke"
shape = { box = [0.04, 0.3, 0.02] }
mass = 1.5
position = [0.1, 0, 0]
[[joint]]
name = "shaft"
type = "revolute"
between = ["world", "crank"]
at = [0, 0, 0]
axis = [0, 0, 1]
rate = 12
[[joint]]
name = "guide"
type = "prismatic"
between = ["world", "yoke"]
at = [0, 0, 0]
axis = [1, 0, 0]
[[joint]]
name = "pin"
type = "point_on_line"
between = ["crank", "yoke"]
at = [0.1, 0, 0]
axis = [0, 1, 0]
[[drive]]
name = "motor"
type = "joint"
joint = "shaft"
rate = 12
"""

# Nothing holds this one but a slide, which holds it everywhere.
RUNS_AWAY = """format = 1
[[body]]
name = "slider"
shape = { box = [0.1, 0.1, 0.1] }
mass = 1
position = [1, 0, 0]
[[joint]]
name = "slide"
type = "prismatic"
between = ["world", "slider"]
at = [0, 0, 0]
axis = [1, 0, 0]
coordinate = 1
[[load]]
name = "push"
type = "actuator"
joint = "slide"
inputs = { x = "slide.displacement" }
expression = "6*x^2"
[time]
end = 3
"""


class Locking(ProgramTest):
    def why(self, text, code=4):
        self.write("locks.toml", text)
        result = json.loads(self.expect(code, "solve", "locks.toml", "-o", "run.nc", "--json").out)
        return result["message"]

    def test_a_drive_beyond_a_dead_position_is_told_with_the_joints(self):
        for time in TIMES:
            for family in ("lobatto", "radau"):
                with self.subTest(time=time, family=family):
                    message = self.why(f'{FOUR_BAR}[time]\n{time}\n[method]\nfamily = "{family}"\n')
                    self.assertIn("the mechanism locks near t = 0.4567", message)
                    self.assertAlmostEqual(float(re.search(r"t = ([0-9.]+) s", message)[1]), DEAD, delta=2e-6)
                    self.assertIn("drive 'motor' asks for", message)
                    self.assertIn("joints 'A', 'B', 'C' and 'D' lose rank there", message)
                    self.expect(0, "sample", "run.nc", "--joint", "D", "--at", "0.4")   # nothing is lost

    def test_one_that_runs_away_is_told(self):
        for time in ("end = 2", "end = 2\noutput = 0.01"):
            message = self.why(f"{YOKE}[time]\n{time}\n")
            # elements vanish before it, the sooner the less they may lose: 2e-5 s before, the pin is 400 m away
            self.assertAlmostEqual(float(re.search(r"locks near t = ([0-9.]+) s", message)[1]), math.pi / 24, delta=2e-5)
            self.assertIn("'pin'", message)

    def test_one_that_turns_back_shortly_before_stays_on_its_branch(self):
        """Down to a millionth of the way: the four-bar has no freedom, so it ends where it began."""
        for gap in (1e-3, 1e-5, 1e-6):
            for method in ("", '[method]\nfamily = "radau"\n', "output = 0.05\n"):
                with self.subTest(gap=gap, method=method):
                    law = f"{0.5 * (1 - gap) * DEAD ** 2!r}*(1 - cos(2*pi*t/3))"
                    self.why(FOUR_BAR.replace('"t^2"', f'"{law}"') + f"[time]\nend = 3\n{method}", code=0)
                    for body in ("coupler", "rocker"):
                        at = [json.loads(self.expect(0, "sample", "run.nc", "--body", body, "--at", t, "--json").out)
                              ["position"] for t in ("0", "3")]
                        self.assertLess(math.dist(*at), 1e-6)

    def comes_home(self, others):
        """The four-bar turns back a hundred-thousandth before it locks, beside others."""
        law = f"{0.5 * (1 - 1e-5) * DEAD ** 2!r}*(1 - cos(2*pi*t/3))"
        self.why(FOUR_BAR.replace('"t^2"', f'"{law}"') + others.replace('"t^2"', f'"{law}"') + "[time]\nend = 3\n", code=0)
        at = [json.loads(self.expect(0, "sample", "run.nc", "--body", "rocker", "--at", t, "--json").out)["position"]
              for t in ("0", "3")]
        self.assertLess(math.dist(*at), 1e-6)

    def test_other_bodies_hide_nothing_of_a_mechanism(self):
        free = "".join(f"""[[body]]
name = "free {i}"
shape = {{ sphere = 0.1 }}
mass = 1
position = [{3 + i}, 0, 0]
[body.start]
velocity = [0.1, 0, 0]
""" for i in range(3))
        welded = "".join(f"""[[body]]
name = "post {i}"
shape = {{ sphere = 0.1 }}
mass = 1
position = [{3 + i}, 0, 0]
[[joint]]
name = "foot {i}"
type = "weld"
between = ["world", "post {i}"]
at = [{3 + i}, 0, 0]
""" for i in range(12))
        twin = FOUR_BAR[FOUR_BAR.index("[[body]]"):]
        for name in ("crank", "coupler", "rocker", "A", "B", "C", "D", "motor"):
            twin = twin.replace(f'"{name}"', f'"{name}2"')
        for others in (free, welded, twin):
            with self.subTest(others=others[:40]):
                self.comes_home(others)

    def test_marches_against_time_tell_locks(self):
        """The same way, as it is at the end: from 3 s back until the links are on one line."""
        placed = re.sub(r"(?m)^(position = .*\n(?:rotation_vector = .*\n)?)(?=\[\[)", r"\1[body.end]\n\1", FOUR_BAR)
        message = self.why(f"""{placed.replace('"t^2"', '"(3 - t)^2"')}[time]
end = 3
elements = 30
[start]
given = "nothing"
[end]
given = "state"
""")
        self.assertIn("the mechanism locks near t = ", message)
        self.assertAlmostEqual(float(re.search(r"t = ([0-9.]+) s", message)[1]), 3 - DEAD, delta=1e-5)
        self.assertIn("drive 'motor' asks for", message)

    def test_a_drive_that_rests_is_not_to_blame(self):
        """A five-bar, one crank held, the other turned until the distal links are on one line."""
        five = FOUR_BAR[:FOUR_BAR.index("[[drive]]")].replace('between = ["rocker", "world"]', 'between = ["rocker", "post"]')
        message = self.why(f"{five}{POST}[time]\nend = 3\n")
        self.assertIn("what drive 'mover' asks for", message)
        self.assertNotIn("holder", message)

    def test_others_are_not_blamed_on_their_joints(self):
        self.why(FOUR_BAR.replace('"t^2"', '"0.1*t^2"') + "[time]\nend = 1\n", code=0)
        message = self.why(RUNS_AWAY)   # x'' = 6 x^2, to infinity by 1.3 s
        self.assertNotIn("locks", message)
        self.assertNotIn("lose rank", message)


if __name__ == "__main__":
    unittest.main()
