# SPDX-License-Identifier: BSD-3-Clause
"""The commands about states of rest, equilibrium and modes, as a user meets them.

    LIVENS_PROGRAM=build/release/livens python3 rest_test.py [CLASS ...]
"""
import json
import math
import unittest

from program_test import NOT_CONVERGED, SCENARIO, USAGE, ProgramTest
from terminal_test import Transcripts as TerminalTranscripts

# A rod of 1 m and 2 kg on a hinge with a damper, stated horizontally.
PENDULUM = """format = 1
title = "a damped pendulum"
gravity = [0, 0, -9.81]

[[body]]
name = "rod"
shape = { box = [1, 0.1, 0.1] }
mass = 2
center_of_mass = [0.5, 0, 0]

[[joint]]
name = "pivot"
type = "revolute"
between = ["world", "rod"]
at = [0, 0, 0]
axis = [0, 1, 0]

[[load]]
name = "friction"
type = "spring"
joint = "pivot"
stiffness = 0
damping = 0.3

[time]
end = 1
elements = 10
"""
INERTIA = 2 * (1 + 0.01) / 12 + 2 * 0.25
STIFFNESS = 2 * 9.81 * 0.5
UPRIGHT = PENDULUM.replace("center_of_mass", "directors = [[0, 0, 1], [0, 1, 0], [-1, 0, 0]]\ncenter_of_mass")
FALLING = PENDULUM.replace('between = ["world", "rod"]', 'between = ["other", "rod"]').replace(
    "[[joint]]", '[[body]]\nname = "other"\nshape = { sphere = 0.1 }\nmass = 1\n\n[[joint]]', 1)


class Equilibrium(ProgramTest):
    def equilibrium(self, text, code=0):
        self.write("rest.toml", text)
        return json.loads(self.expect(code, "equilibrium", "rest.toml", "--json").out)

    def test_a_pendulum_hangs(self):
        found = self.equilibrium(PENDULUM)
        self.assertEqual((found["status"], found["exit_code"], found["degrees_of_freedom"]), ("stable", 0, 1))
        body, joint = found["bodies"][0], found["joints"][0]
        self.assertAlmostEqual(body["rotation_vector"][1], math.pi / 2, delta=1e-14)
        self.assertAlmostEqual(joint["angle"], math.pi / 2, delta=1e-14)
        self.assertAlmostEqual(joint["force"][2], 2 * 9.81, delta=1e-12)
        self.assertLess(found["residual"], 1e-14)
        self.assertIs(joint["unique"], True)

    def test_upright_is_unstable_and_an_answer(self):
        found = self.equilibrium(UPRIGHT)
        self.assertEqual((found["status"], found["iterations"], found["unstable_directions"]), ("unstable", 0, 1))
        self.assertIn("start slightly off it", self.expect(0, "equilibrium", "rest.toml").out)

    def test_what_falls_has_none(self):
        found = self.equilibrium(FALLING, NOT_CONVERGED)
        self.assertEqual((found["converged"], found["status"]), (False, "no equilibrium"))
        self.assertIn("still accelerates by 9.81 m/s^2", found["message"])
        done = self.expect(NOT_CONVERGED, "modes", "rest.toml")
        self.assertIn("no equilibrium was found: body", done.err)

    def test_quiet_says_nothing(self):
        self.write("rest.toml", PENDULUM)
        self.assertEqual(self.expect(0, "equilibrium", "rest.toml", "-q").out, "")
        self.assertEqual(self.expect(0, "modes", "rest.toml", "-q").out, "")


class Modes(ProgramTest):
    def modes(self, *arguments, text=PENDULUM):
        self.write("rest.toml", text)
        return json.loads(self.expect(0, "modes", "rest.toml", "--json", *arguments).out)

    def test_a_damped_pendulum(self):
        found = self.modes()
        (mode,) = found["modes"]
        w = math.sqrt(STIFFNESS / INERTIA)
        self.assertAlmostEqual(mode["frequency"], w, delta=1e-12)
        self.assertAlmostEqual(mode["hertz"], w / (2 * math.pi), delta=1e-12)
        self.assertAlmostEqual(mode["damping_ratio"], 0.3 / (2 * INERTIA * w), delta=1e-13)
        self.assertAlmostEqual(abs(mode["joints"][0]["angle"]), 1, delta=1e-13)
        self.assertIsNone(found["state_matrices"])

    def test_state_matrices(self):
        s = self.modes("--input", "pivot.angle", "--output", "pivot.angle", "--output", "rod.x")["state_matrices"]
        self.assertEqual((s["inputs"], s["outputs"]), (["pivot.angle"], ["pivot.angle", "rod.x"]))
        self.assertAlmostEqual(s["A"][1][0], -STIFFNESS / INERTIA, delta=1e-12)
        self.assertAlmostEqual(s["C"][0][0] * s["B"][1][0], 1 / INERTIA, delta=1e-13)
        self.assertEqual(s["D"], [[0], [0]])
        self.assertAlmostEqual(s["C"][1][0], 0, delta=1e-15)   # the reference point is the pivot

    def test_the_start_must_be_balanced(self):
        self.write("rest.toml", PENDULUM)
        done = self.expect(SCENARIO, "modes", "rest.toml", "--at", "start", "--diagnostics", "gnu")
        self.assertIn("[not-in-equilibrium]", done.err)
        self.assertEqual(self.modes("--at", "start", text=UPRIGHT)["status"], "unstable")
        self.write("rest.toml", UPRIGHT.replace("mass = 2", "mass = 2\nangular_velocity = [0, 1, 0]"))
        done = self.expect(SCENARIO, "modes", "rest.toml", "--at", "start", "--diagnostics", "gnu")
        self.assertIn("[not-at-rest]", done.err)

    def test_ports_that_are_not_there(self):
        self.write("rest.toml", PENDULUM)
        for name in ("pivot", "pivot.displacement", "nothing.x", "rod.angle_rate"):
            done = self.expect(SCENARIO, "modes", "rest.toml", "--input", name, "--diagnostics", "gnu")
            self.assertIn("[no-such-port]", done.err)
        self.expect(USAGE, "modes", "rest.toml", "--at", "nowhere")
        self.expect(USAGE, "modes")


class RestTranscripts(ProgramTest):
    """Like Transcripts of terminal_test, which has none of its tests here."""

    transcript, masked, compare = (TerminalTranscripts.transcript, TerminalTranscripts.masked,
                                   TerminalTranscripts.compare)

    def test_equilibrium(self):
        self.write("rest.toml", PENDULUM)
        self.transcript("equilibrium", 0, "equilibrium", "rest.toml")

    def test_no_equilibrium(self):
        self.write("rest.toml", FALLING)
        self.transcript("no_equilibrium", NOT_CONVERGED, "equilibrium", "rest.toml")

    def test_modes(self):
        self.write("rest.toml", PENDULUM)
        self.transcript("modes", 0, "modes", "rest.toml")


del TerminalTranscripts   # else its tests would run here again

if __name__ == "__main__":
    unittest.main(verbosity=2)
