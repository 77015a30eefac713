# SPDX-License-Identifier: BSD-3-Clause
"""The program as a user meets it: commands, exit codes, wrong input, full disks, signals.

    LIVENS_PROGRAM=build/release/livens python3 program_test.py [CLASS ...]
"""
import csv
import fcntl
import hashlib
import importlib.util
import json
import math
import os
import pathlib
import pty
import re
import resource
import shutil
import signal
import subprocess
import sys
import tempfile
import time
import unittest

PROGRAM = os.environ.get("LIVENS_PROGRAM", "build/release/livens")
SOURCE = pathlib.Path(os.environ.get("LIVENS_SOURCE_DIR", pathlib.Path(__file__).resolve().parents[2]))
DATA = SOURCE / "tests" / "system" / "data"
SANITIZED = b"__asan_init" in pathlib.Path(PROGRAM).read_bytes()   # which wants address space without limits

USAGE, SCENARIO, NOT_CONVERGED, RESOURCES, IO, SUSPECT = 2, 3, 4, 5, 6, 7

SMALL = """format = 1
title = "a brick on a rod"
gravity = [0, 0, -9.81]

[[body]]
name = "brick"
shape = { box = [0.3, 0.2, 0.1] }
density = 1000
position = [1, 0, 0]
angular_velocity = [0, 0, 2]

[[body]]
name = "bob"
shape = { point = true }
mass = 0.5
position = [1, 0, -1]

[[joint]]
name = "upper"
type = "rod"
between = ["world", "brick"]

[[joint]]
name = "lower"
type = "rod"
between = ["brick", "bob"]

[time]
end = 0.5
elements = 10
output = 0.1

[method]
family = "lobatto"
degree = 4
"""

OLDER = "CDF, cut off behind livens_format"   # what may be replaced
LONG = SMALL.replace("end = 0.5\nelements = 10\noutput = 0.1", "end = 50000\nelements = 1000000\noutput = 1000")


def text_with(old, new, text=SMALL):
    assert text.count(old) >= 1, old
    return text.replace(old, new, 1)


HINGED = """format = 1
gravity = [0, 0, -9.81]
[[body]]
name = "brick"
shape = { box = [0.3, 0.2, 0.1] }
density = 1000
position = [1, 0, 0]
[[joint]]
name = "hinge"
type = "revolute"
between = ["world", "brick"]
at = [0, 0, 0]
axis = [0, 1, 0]
rate = 1
[time]
end = 0.5
elements = 10
"""


class ProgramTest(unittest.TestCase):
    def setUp(self):
        self.folder = pathlib.Path(tempfile.mkdtemp(prefix="livens-system-"))
        self.addCleanup(shutil.rmtree, self.folder, ignore_errors=True)

    def write(self, name, text):
        path = self.folder / name
        path.write_bytes(text.encode() if isinstance(text, str) else text)
        return path

    def run_program(self, *arguments, **options):
        options.setdefault("stdout", subprocess.PIPE)
        options.setdefault("stderr", subprocess.PIPE)
        options.setdefault("cwd", self.folder)
        options.setdefault("timeout", 100)
        done = subprocess.run([PROGRAM, *map(str, arguments)], **options)
        done.out = (done.stdout or b"").decode(errors="replace")
        done.err = (done.stderr or b"").decode(errors="replace")
        return done

    def expect(self, code, *arguments, **options):
        done = self.run_program(*arguments, **options)
        self.assertEqual(done.returncode, code, f"{arguments}\n{done.out}\n{done.err}")
        return done

    def solve(self, text=SMALL, name="small.toml", output="run.nc", code=0):
        self.write(name, text)
        return json.loads(self.expect(code, "solve", name, "-o", output, "--json").out)

    def files(self):
        return sorted(p.name for p in self.folder.iterdir())

    def assert_no_temporaries(self):
        self.assertEqual([name for name in self.files() if name.endswith(".tmp")], [])


class Solve(ProgramTest):
    def test_json_has_what_is_promised(self):
        result = self.solve()
        self.assertIs(result["converged"], True)
        self.assertEqual(result["status"], "converged")
        self.assertEqual(result["method"], "lobatto(4)")
        self.assertEqual(result["elements"], 10)
        self.assertEqual(result["output"], "run.nc")
        for key in ("unknowns", "newton_iterations", "evaluations"):
            self.assertIsInstance(result[key], int, key)
            self.assertGreater(result[key], 0, key)
        self.assertGreater(result["solve_seconds"], 0)
        self.assertLess(result["max_constraint_violation"], 1e-12)
        self.assertLess(result["energy_drift"], 1e-6)
        self.assertLess(result["angular_momentum_drift"], 1e-10)
        self.assertGreaterEqual(result["residual_norm"], 0)
        self.assertEqual(result["errors"], [])

    def test_parameters_are_set_and_kept(self):
        """A run that was solved with --set can be made again from its file alone."""
        text = text_with("end = 0.5", 'end = "T"', SMALL.replace("format = 1", 'format = 1\nparameters = { T = "500 ms" }', 1))
        self.write("small.toml", text)
        self.expect(0, "solve", "small.toml", "-o", "set.nc", "--set", "T=0.4", "-q")
        self.expect(0, "solve", "small.toml", "-o", "also.nc", "--set", " T = 2*200 ms", "-q")
        self.expect(0, "solve", "small.toml", "-o", "own.nc", "-q")
        ends = {name: json.loads(self.expect(0, "info", name + ".nc", "--json").out) for name in ("set", "also", "own")}
        self.assertEqual([ends[name]["end"] for name in ends], [0.4, 0.4, 0.5])
        self.expect(0, "sample", "set.nc", "--body", "brick", "--at", "0.4", "--exact")
        self.assertIn(b'T = "0.4 s"', (self.folder / "set.nc").read_bytes())
        self.expect(SCENARIO, "check", "small.toml", "--set", "U=1")
        self.expect(SCENARIO, "check", "small.toml", "--set", "T=2 kg")
        self.assertIn("did you mean 'T'", self.expect(SCENARIO, "check", "small.toml", "--set", "t=1").err)
        self.assertIn("NAME=VALUE", self.expect(USAGE, "check", "small.toml", "--set", "T").err)

    def test_default_name_is_the_stem_here(self):
        self.write("small.toml", SMALL)
        done = self.expect(0, "solve", "small.toml")
        self.assertEqual(self.files(), ["small.nc", "small.nc.json", "small.toml"])
        self.assertIn("small.nc", done.out)
        self.assertIn("Converged", done.out)
        self.assertEqual(done.err, "")

    def test_several_scenarios_at_a_time(self):
        names = []
        for i in range(5):
            names.append(f"s{i}.toml")
            self.write(names[-1], SMALL.replace("elements = 10", f"elements = {10 + 5 * i}"))
            self.expect(0, "solve", names[-1], "-q", "-o", f"alone{i}.nc")
        alone = [(self.folder / f"alone{i}.nc").read_bytes() for i in range(5)]
        self.assertEqual(len(set(alone)), 5)
        for jobs in ([], ["-j", "1"], ["-j", "3"], ["--jobs", "64"]):
            done = self.expect(0, "solve", *names, *jobs)
            self.assertEqual([(self.folder / f"s{i}.nc").read_bytes() for i in range(5)], alone, jobs)
            shown = [line for line in done.out.splitlines() if line.endswith(".toml")]
            self.assertEqual(shown, names, "in their order")
            self.assertEqual(done.out.count("Converged"), 5)
        folder = self.folder / "results"
        folder.mkdir()
        printed = json.loads(self.expect(0, "solve", *names, "-o", "results", "--json").out)
        self.assertEqual([run["elements"] for run in printed], [10, 15, 20, 25, 30])
        self.assertEqual(len(list(folder.glob("*.nc"))), 5)
        self.assert_no_temporaries()

    def test_the_worst_of_several_is_the_exit_code(self):
        self.write("good.toml", SMALL)
        poor = SMALL.replace("end = 0.5\nelements = 10\noutput = 0.1", "end = 50\nelements = 1")
        self.write("poor.toml", poor.replace('family = "lobatto"\ndegree = 4', 'family = "midpoint"\nmax_iterations = 1'))
        alone = self.run_program("solve", "poor.toml", "--json")
        self.assertNotEqual(alone.returncode, 0)
        done = self.expect(alone.returncode, "solve", "poor.toml", "good.toml", "--json")
        printed = json.loads(done.out)
        self.assertEqual([run["exit_code"] for run in printed], [alone.returncode, 0])
        self.assertIn(json.loads(alone.out)["message"], done.err)

    def test_several_scenarios_lose_nothing(self):
        self.write("small.toml", SMALL)
        other = self.folder / "other"
        other.mkdir()
        shutil.copy(self.folder / "small.toml", other)
        for arguments, words in ((["small.toml", "other/small.toml"], "one file, 'small.nc'"),
                                 (["small.toml", "none.toml"], "none.toml"),
                                 (["small.toml", "other/small.toml", "-o", "x.nc"], "folder"),
                                 (["small.toml", "other/small.toml", "--csv", "x.csv"], "--csv"),
                                 (["small.toml", "-j", "0"], "--jobs")):
            done = self.run_program("solve", *arguments)
            self.assertNotEqual(done.returncode, 0)
            self.assertIn(words, done.err)
            self.assertEqual(self.files(), ["other", "small.toml"], "nothing was solved")

    def test_quiet_says_nothing(self):
        self.write("small.toml", SMALL)
        done = self.expect(0, "solve", "small.toml", "-q")
        self.assertEqual((done.out, done.err), ("", ""))

    def test_same_input_gives_same_bytes(self):
        self.solve(output="first.nc")
        time.sleep(1.05)
        elsewhere = self.folder / "elsewhere"
        elsewhere.mkdir()
        shutil.copy(self.folder / "small.toml", elsewhere / "other.toml")
        self.expect(0, "solve", elsewhere / "other.toml", "-o", elsewhere / "second.nc")
        self.assertEqual((self.folder / "first.nc").read_bytes(), (elsewhere / "second.nc").read_bytes())

    def test_same_bytes_on_processors_that_lack_something(self):
        """glibc takes other code for its functions where there is no AVX2 and FMA; ours must not notice."""
        without = {**os.environ, "GLIBC_TUNABLES": "glibc.cpu.hwcaps=-AVX2,-FMA,-AVX512F,-AVX512VL,-AVX_Fast_Unaligned_Load"}
        sines = "import math; print(hash(tuple(math.sin(k / 7) + math.exp(k / 977) for k in range(9999))))"
        libm = [subprocess.run([sys.executable, "-c", sines], env=env, stdout=subprocess.PIPE).stdout
                for env in (os.environ, without)]
        if libm[0] == libm[1]:
            self.skipTest("glibc has nothing to choose here")   # the control: else it does
        scenarios = [SOURCE / "examples" / f"{name}.toml" for name in
                     ("ball_pendulum_two", "double_pendulum_offset", "lagrange_top", "two_point", "free_box_paper")]
        to_accuracy = SMALL.replace("elements = 10", "accuracy = 1e-7").replace("degree = 4\n", "")
        self.write("accuracy.toml", to_accuracy)
        self.write("radau.toml", to_accuracy.replace('"lobatto"', '"radau"'))
        for scenario in [*scenarios, "accuracy.toml", "radau.toml"]:
            self.run_program("solve", scenario, "-o", "all.nc", "-q")
            self.run_program("solve", scenario, "-o", "less.nc", "-q", env=without)
            self.assertEqual((self.folder / "all.nc").read_bytes(), (self.folder / "less.nc").read_bytes(), scenario)
        self.expect(0, "export", "all.nc", "--gltf", "all.glb")
        self.expect(0, "export", "all.nc", "--gltf", "less.glb", env=without)
        self.assertEqual((self.folder / "all.glb").read_bytes(), (self.folder / "less.glb").read_bytes())

    def test_a_guess_is_read_and_never_replaced(self):
        """The result is not written over the run that it begins with, and a run of something else is refused."""
        two_point = SOURCE / "examples" / "two_point.toml"
        self.expect(0, "solve", two_point, "-o", "first.nc", "-q")
        before = (self.folder / "first.nc").read_bytes()
        self.expect(0, "solve", two_point, "--guess", "first.nc", "-o", "second.nc", "-q")
        self.expect(6, "solve", two_point, "--guess", "first.nc", "-o", "first.nc", "--force")
        self.expect(6, "solve", two_point, "--guess", two_point, "-o", "third.nc")
        self.expect(6, "solve", two_point, "--guess", "none.nc", "-o", "third.nc")
        self.write("small.toml", SMALL)
        self.expect(3, "solve", "small.toml", "--guess", "first.nc", "-o", "third.nc")   # a march
        self.assertEqual((self.folder / "first.nc").read_bytes(), before)
        self.assertFalse((self.folder / "third.nc").exists())

    def test_a_search_that_fails_keeps_its_iterate_and_an_older_motion(self):
        """One step does not find how to throw a bob to the other side of its hook; from there it is near."""
        text = """format = 1
gravity = [0, 0, -9.81]
[[body]]
name = "bob"
shape = { point = true }
mass = 0.2
position = [0.8, 0, -0.6]
end = { position = [0, 0.6, -0.8] }
[[joint]]
name = "string"
type = "rod"
between = ["world", "bob"]
points = [[0, 0, 0], [0, 0, 0]]
[time]
end = 2
elements = 60
[method]
max_iterations = STEPS
[start]
given = "positions"
[end]
given = "positions"
"""
        self.write("bob.toml", text.replace("STEPS", "30"))
        self.write("short.toml", text.replace("STEPS", "1"))
        self.expect(0, "solve", "bob.toml", "-o", "bob.nc", "-q")
        good = (self.folder / "bob.nc").read_bytes()
        done = self.expect(4, "solve", "short.toml", "-o", "bob.nc")
        self.assertIn("the last iterate is kept", done.out)
        self.assertIn("is kept", done.err)
        self.assertEqual((self.folder / "bob.nc").read_bytes(), good)
        self.assertIn("the last iterate is kept", self.expect(0, "info", "bob.failed.nc").out)
        self.expect(0, "solve", "bob.toml", "--guess", "bob.failed.nc", "-o", "again.nc", "-q")
        self.expect(4, "solve", "short.toml", "-o", "bob.nc", "--force", "-q")   # as is asked for
        self.assertNotEqual((self.folder / "bob.nc").read_bytes(), good)

    def test_several_motions_and_their_files(self):
        """A rod that hangs at both ends of a second rests, or swings either way, or turns."""
        self.write("rod.toml", """format = 1
gravity = [0, 0, -9.81]
[[body]]
name = "rod"
shape = { box = [1, 0.05, 0.05] }
density = 1000
position = [0, 0, -0.5]
rotation_vector = [0, "90 deg", 0]
end = { position = [0, 0, -0.5], rotation_vector = [0, "90 deg", 0] }
[[joint]]
name = "hook"
type = "revolute"
between = ["world", "rod"]
at = [0, 0, 0]
axis = [0, 1, 0]
[time]
end = 1
elements = 24
[start]
given = "positions"
[end]
given = "positions"
""")
        told = self.expect(0, "solve", "rod.toml", "-o", "rod.nc", "--roots", "3").out
        for words in ("motion 3 of 3", "effort", "rounds", "rod.2.nc", "rod.3.nc", "off by 1 mm/s"):
            self.assertIn(words, " ".join(told.split()))
        heights = []
        for name in ("rod.nc", "rod.2.nc", "rod.3.nc"):
            done = self.expect(0, "sample", name, "--body", "rod", "--at", "0.5", "--json")
            heights.append(json.loads(done.out)["position"][2])
        self.assertAlmostEqual(heights[0], -0.5, 9)
        self.assertTrue(min(heights[1:]) > -0.4, heights)
        arrival = json.loads(self.expect(0, "info", "rod.nc", "--json").out)["arrival"]
        self.assertGreater(arrival, 0)
        (self.folder / "rod.2.nc").write_text("a file of somebody else")
        self.expect(IO, "solve", "rod.toml", "-o", "rod.nc", "--roots", "3")
        self.assertEqual((self.folder / "rod.2.nc").read_text(), "a file of somebody else")

    def test_instructions_are_pinned_and_named(self):
        self.write("small.toml", SMALL)
        def bytes_of(*arguments, **variables):
            done = self.run_program("solve", "small.toml", "-o", "run.nc", "-q", *arguments, env={**os.environ, **variables})
            self.assertEqual(done.returncode, 0, done.err)
            return (self.folder / "run.nc").read_bytes()
        portable = bytes_of("--simd", "sse2")
        self.assertIn(b'"sse2"', portable)
        self.assertEqual(bytes_of(LIVENS_SIMD="sse2"), portable)
        self.assertEqual(bytes_of("--simd", "sse2", LIVENS_SIMD="avx2"), portable)
        if " avx2 " in pathlib.Path("/proc/cpuinfo").read_text() and b'"sse2"' not in bytes_of():
            self.assertNotEqual(bytes_of("--simd", "avx2"), portable)
        self.expect(2, "solve", "small.toml", "-o", "run.nc", "--simd", "mmx")
        wrong = self.run_program("solve", "small.toml", "-o", "run.nc", env={**os.environ, "LIVENS_SIMD": "mmx"})
        self.assertEqual(wrong.returncode, 2)
        self.assertIn("LIVENS_SIMD", wrong.err)
        wrong = self.run_program("sample", "run.nc", "--body", "bob", "--at", "0.15", "--exact",
                                 env={**os.environ, "LIVENS_SIMD": "mmx"})
        self.assertEqual(wrong.returncode, 2, wrong.out)

    def test_record_beside_the_result(self):
        printed = self.solve()
        record = json.loads((self.folder / "run.nc.json").read_text())
        self.assertRegex(record.pop("date"), r"^\d{4}-\d\d-\d\dT\d\d:\d\d:\d\dZ$")
        self.assertEqual(record, printed)

    def test_record_leaves_strangers_alone(self):
        self.write("small.toml", SMALL)
        self.write("run.nc.json", '{"mine": 1}')
        self.expect(0, "solve", "small.toml", "-o", "run.nc")
        self.assertEqual((self.folder / "run.nc.json").read_text(), '{"mine": 1}')

    def test_json_may_be_redirected_to_the_records_name(self):
        self.write("small.toml", SMALL)
        with open(self.folder / "run.nc.json", "wb") as out:
            self.expect(0, "solve", "small.toml", "-o", "run.nc", "--json", stdout=out)
        self.assertIs(json.loads((self.folder / "run.nc.json").read_text())["converged"], True)

    def test_records_of_a_sweep_do_not_collide(self):
        for name in ("sweep_dt0.01", "sweep_dt0.02", "sweep_dt0.02.nc"):
            self.solve(output=name)
            self.assertEqual(json.loads((self.folder / (name + ".json")).read_text())["output"], name)

    def test_records_are_not_overwritten_by_results(self):
        self.solve()
        record = (self.folder / "run.nc.json").read_bytes()
        for arguments in (("export", "run.nc", "--csv", "run.nc.json"), ("solve", "small.toml", "-o", "run.nc.json"),
                          ("solve", "small.toml", "-o", "x.nc", "--csv", "run.nc.json"),
                          ("solve", "small.toml", "-o", "x.nc", "--csv", "x.nc.json"),
                          ("export", "run.nc", "--csv", "run.nc")):
            self.assertIn("cannot write", self.expect(IO, *arguments).err)
        self.assertEqual((self.folder / "run.nc.json").read_bytes(), record)
        self.assertEqual(self.files(), ["run.nc", "run.nc.json", "small.toml"])

    def test_odd_names(self):
        for name in ("a b.nc", "größe ☃.nc", "with'quote\".nc", "x#mode=zarr.nc", "http:.nc"):
            self.solve(name="szenario mit ü.toml", output=name)
            self.expect(0, "info", name)

    def test_locale_does_not_matter(self):
        self.solve(output="c.nc")
        self.expect(0, "solve", "small.toml", "-o", "de.nc", env={**os.environ, "LC_ALL": "de_DE.UTF-8"})
        self.assertEqual((self.folder / "c.nc").read_bytes(), (self.folder / "de.nc").read_bytes())

    def test_midpoint_and_endpoint(self):
        text = SMALL.replace('family = "lobatto"\ndegree = 4', 'family = "midpoint"')
        text = text.replace("shape = { point = true }\nmass = 0.5", "shape = { sphere = 0.1 }\ndensity = 100")
        self.assertEqual(self.solve(text)["method"], "midpoint")
        # Implicit Euler eats energy: with so few steps the result must say so itself.
        coarse = text.replace("midpoint", "endpoint").replace("end = 0.5", "end = 2")
        result = self.solve(coarse, code=SUSPECT)
        self.assertEqual((result["converged"], result["status"]), (True, "suspect"))
        self.assertIn("estimated error", result["message"])
        self.assertIn(result["message"], result["notes"])
        self.assertNotIn("\n", result["message"])
        info = json.loads(self.expect(0, "info", "run.nc", "--json").out)
        self.assertEqual((info["status"], info["message"]), ("suspect", result["message"]))

    def test_csv(self):
        self.write("small.toml", SMALL)
        self.expect(0, "solve", "small.toml", "-o", "run.nc", "--csv", "run.csv")
        self.expect(0, "export", "run.nc", "--csv", "again.csv")
        self.assertEqual((self.folder / "run.csv").read_bytes(), (self.folder / "again.csv").read_bytes())
        lines = (self.folder / "run.csv").read_text().splitlines()
        self.assertEqual(len(lines), 1 + 6)
        self.assertEqual(lines[0].split(",")[:2], ["t [s]", "brick.position.x [m]"])
        self.assertEqual([line.split(",")[0] for line in lines[1:]], ["0", "0.1", "0.2", "0.3", "0.4", "0.5"])
        of_point = dict(zip(lines[0].split(","), lines[1].split(",")))   # which has no orientation
        turning = [key for key in of_point if key.startswith("bob.quaternion")]
        self.assertEqual([of_point[key] for key in turning], [""] * 4)

    def test_csv_of_joints_and_sensors(self):
        self.write("hinge.toml", """format = 1
gravity = [0, 0, -9.81]
[[body]]
name = "arm"
shape = { box = [1, 0.1, 0.1] }
mass = 2
position = [0.5, 0, 0]
[[joint]]
name = "hinge"
type = "revolute"
between = ["world", "arm"]
at = [0, 0, 0]
axis = [0, 1, 0]
[[load]]
name = "spring"
type = "spring"
joint = "hinge"
stiffness = 3
[[sensor]]
name = "effort"
type = "load"
load = "spring"
[time]
end = 0.5
output = 0.25
""")
        self.expect(0, "solve", "hinge.toml", "-o", "run.nc", "--csv", "run.csv")
        with (self.folder / "run.csv").open(newline="") as file:
            rows = list(csv.DictReader(file))
        self.assertEqual(list(rows[0])[-12:], [
            "hinge.angle [rad]", "hinge.angle_rate [rad/s]", "hinge.angle_acceleration [rad/s^2]", "hinge.force.x [N]", "hinge.force.y [N]", "hinge.force.z [N]",
            "hinge.torque.x [N m]", "hinge.torque.y [N m]", "hinge.torque.z [N m]", "spring.effort [N m]", "effort.effort [N m]", "effort.power [W]"])
        for row in rows:
            at = json.loads(self.expect(0, "sample", "run.nc", "--joint", "hinge", f"--at={row['t [s]']}", "--json").out)
            self.assertEqual(float(row["hinge.angle [rad]"]), at["angle"])
            self.assertEqual(float(row["hinge.angle_rate [rad/s]"]), at["angle_rate"])
            for i, x in enumerate("xyz"):
                self.assertEqual(float(row[f"hinge.force.{x} [N]"]), at["force"][i])
            self.assertAlmostEqual(float(row["effort.effort [N m]"]), -3 * at["angle"], delta=1e-14)
        self.assertGreater(abs(float(rows[-1]["hinge.angle [rad]"])), 0.1)

    def test_not_converged_writes_what_there_is(self):
        one_leap = SMALL.replace("end = 0.5\nelements = 10\noutput = 0.1", "end = 50\nelements = 1")
        spring = ('[[load]]\ntype = "spring"\nbetween = ["world", "brick"]\npoints = [[3, 0, 0], [0, 0, 0]]\n'
                  "stiffness = 1e200\nfree_length = 1\n")
        for text, status, place in (
            (one_leap.replace('family = "lobatto"\ndegree = 4', 'family = "midpoint"\nmax_iterations = 1'), "not converged", "upper"),
            (SMALL + spring, "not converged", "element"),
        ):
            self.write("run.nc", OLDER)
            result = self.solve(text, code=NOT_CONVERGED)
            self.assertIs(result["converged"], False)
            self.assertEqual(result["status"], status)
            self.assertIn(place, result["message"])
            info = json.loads(self.expect(0, "info", "run.nc", "--json").out)
            self.assertEqual((info["converged"], info["status"]), (False, status))
            self.assertEqual(info["elements"], 0)
            s = json.loads(self.expect(0, "sample", "run.nc", "--body", "brick", f"--at={info['end']!r}", "--json").out)
            self.assertIs(s["converged"], False)
            self.expect(0, "export", "run.nc", "--csv", "run.csv")

    def test_blocks_whose_first_one_fails(self):
        blocks = ('family = "mixed"\ndegree = 1\nwindow = 5\ninterfaces = "project"\nmax_iterations = 1')
        result = self.solve(SMALL.replace('family = "lobatto"\ndegree = 4', blocks), code=NOT_CONVERGED)
        self.assertEqual((result["status"], result["elements"]), ("not converged", 0))
        self.assertIn("did not converge in 1 iteration, the limit, in the window of elements 0 to 4", result["message"])
        self.assertEqual(json.loads(self.expect(0, "info", "run.nc", "--json").out)["message"], result["message"])

    def test_mixed_elements_in_blocks(self):
        text = SMALL.replace('family = "lobatto"\ndegree = 4', 'family = "mixed"\nwindow = 4\ncondition = true')
        result = self.solve(text)
        self.assertEqual((result["status"], result["method"]), ("converged", "mixed(lagrange, 2, natural, equal)"))
        self.assertEqual((result["elements"], result["blocks"]), (10, 3))
        self.assertGreater(result["max_constraint_violation"], 1e-12)   # they hold weakly
        self.assertLess(result["max_weak_violation"], result["max_constraint_violation"])
        self.assertLess(result["zigzag_positions"], 0.3)
        self.assertGreater(result["condition_1"], result["scaled_condition"])
        self.assertIsNone(self.solve()["condition_1"])
        self.solve(text, output="mixed.nc")
        info = json.loads(self.expect(0, "info", "mixed.nc", "--json").out)
        for key in ("max_weak_violation", "zigzag_momenta", "condition_2", "scaled_condition"):
            self.assertEqual(info[key], result[key], key)
        end = json.loads(self.expect(0, "sample", "mixed.nc", "--body", "bob", "--at", "0.5", "--json").out)
        exact = self.solve(SMALL.replace("degree = 4", "degree = 8"), output="exact.nc")
        self.assertEqual(exact["status"], "converged")
        right = json.loads(self.expect(0, "sample", "exact.nc", "--body", "bob", "--at", "0.5", "--json").out)
        for a, b in zip(end["position"], right["position"], strict=True):
            self.assertAlmostEqual(a, b, delta=5e-4)
        self.expect(0, "sample", "mixed.nc", "--body", "bob", "--at", "0.49")
        refused = self.run_program("sample", "mixed.nc", "--body", "bob", "--at", "0.49", "--exact")
        self.assertEqual(refused.returncode, USAGE, refused.err)
        self.assertIn("mixed", refused.err)

    def test_same_mixed_input_gives_same_bytes(self):
        text = SMALL.replace('family = "lobatto"\ndegree = 4',
                             'family = "mixed"\nbasis = "bspline"\nwindow = 5\ninterfaces = "project"')
        self.solve(text, output="first.nc")
        self.solve(text, output="second.nc")
        self.assertEqual((self.folder / "first.nc").read_bytes(), (self.folder / "second.nc").read_bytes())

    def test_motions_that_cannot_be_are_never_converged(self):
        # Linear elements on the chaotic pendulum of the paper, 20 s at once, and too few of them.
        pendulum = (SOURCE / "examples" / "double_pendulum_blocks.toml").read_text()
        pendulum = pendulum[:pendulum.index("[time]")]
        for elements in (80, 160, 200, 250):
            text = pendulum + f'[time]\nend = 20\nelements = {elements}\n[method]\nfamily = "mixed"\ndegree = 1\n'
            self.write("window.toml", text)
            done = self.run_program("solve", "window.toml", "-o", "run.nc", "--json")
            self.assertIn(done.returncode, (NOT_CONVERGED, SUSPECT), f"{elements} elements: {done.out}")
            self.assertNotEqual(json.loads(done.out)["status"], "converged")
            self.expect(0, "info", "run.nc")

    def test_backward_is_the_way_back(self):
        self.solve(SMALL.replace("degree = 4", "degree = 8"), output="there.nc")
        ends = {}
        for body in ("brick", "bob"):
            s = json.loads(self.expect(0, "sample", "there.nc", "--body", body, "--at", "0.5", "--json").out)
            keys = ("position", "quaternion", "velocity", "angular_velocity")
            ends[body] = "[body.end]\n" + "".join(f"{k} = {s[k]}\n" for k in keys if s[k] is not None)
        back = SMALL.replace("angular_velocity = [0, 0, 2]\n", ends["brick"])
        back = back.replace("position = [1, 0, -1]\n", "position = [1, 0, -1]\n" + ends["bob"])
        back = back.replace('family = "lobatto"\ndegree = 4', 'family = "mixed"\nbasis = "bspline"\ndegree = 3')
        back += '[start]\ngiven = "nothing"\n[end]\ngiven = "state"\n'
        self.solve(back, output="back.nc")
        start = json.loads(self.expect(0, "sample", "back.nc", "--body", "brick", "--at", "0", "--json").out)
        for a, b in zip(start["position"], [1, 0, 0], strict=True):
            self.assertAlmostEqual(a, b, delta=1e-5)
        self.solve(back.replace('family = "mixed"\nbasis = "bspline"\ndegree = 3', 'family = "lobatto"\ndegree = 8'),
                   output="exact.nc")
        start = json.loads(self.expect(0, "sample", "exact.nc", "--body", "brick", "--at", "0", "--json").out)
        for a, b in zip(start["position"], [1, 0, 0], strict=True):
            self.assertAlmostEqual(a, b, delta=1e-12)
        self.write("wrong.toml", back.replace('family = "mixed"\nbasis = "bspline"\ndegree = 3', 'family = "midpoint"'))
        done = self.expect(SCENARIO, "check", "wrong.toml", "--diagnostics", "gnu")
        self.assertIn("[boundary-method]", done.err)

    def test_examples_check(self):
        examples = sorted((SOURCE / "examples").glob("*.toml"))
        self.assertGreater(len(examples), 0)
        for example in examples:
            done = self.expect(0, "check", example, "--json")
            self.assertIs(json.loads(done.out)["valid"], True, example)


class Reading(ProgramTest):
    """info, sample, export and what they refuse."""

    def sample(self, *arguments):
        return json.loads(self.expect(0, "sample", "run.nc", *arguments, "--json").out)

    def test_sample_of_a_body(self):
        self.solve()
        s = self.sample("--body", "brick", "--at", "0")
        self.assertEqual(s["position"], [1, 0, 0])
        self.assertEqual(s["directors"], [[1, 0, 0], [0, 1, 0], [0, 0, 1]])
        self.assertEqual(s["quaternion"], [1, 0, 0, 0])
        self.assertEqual(s["source"], "element end")
        for a, b in zip(s["angular_velocity"], (0, 0, 2)):
            self.assertAlmostEqual(a, b, delta=1e-14)
        self.assertEqual(s["center_of_mass"], [1, 0, 0])
        self.assertAlmostEqual(s["angular_velocity_body"][2], 2, delta=1e-14)
        self.assertIsNone(self.sample("--body", "bob", "--at", "0")["quaternion"])

    def test_between_ends_exact_beats_the_polynomial(self):
        self.solve()
        truth = SMALL.replace("elements = 10", "elements = 100").replace("output = 0.1", "output = 0.005")
        self.solve(truth, name="fine.toml", output="fine.nc")
        fine = json.loads(self.expect(0, "sample", "fine.nc", "--body", "brick", "--at", "0.225", "--json").out)
        error = {}
        for how in ((), ("--exact",)):
            s = self.sample("--body", "brick", "--at", "0.225", *how)
            error[how] = math.dist(s["velocity"], fine["velocity"])
            self.assertEqual(s["source"], "solved" if how else "polynomial")
        self.assertLess(error[("--exact",)], 0.1 * error[()])

    def test_exact_coordinates_and_readings_beat_the_polynomial(self):
        swing = """format = 1
gravity = [0, 0, -9.81]
[[body]]
name = "rod"
mass = 1
inertia = [1, 1, 1]
center_of_mass = [0.5, 0, 0]
[[joint]]
name = "hinge"
type = "revolute"
between = ["world", "rod"]
at = [0, 0, 0]
axis = [0, 1, 0]
[[sensor]]
name = "turn"
type = "joint"
joint = "hinge"
[time]
end = 1
elements = %d
[method]
degree = 3
"""
        self.solve(swing % 4, name="swing.toml", output="swing.nc")
        self.solve(swing % 200, name="fine.toml", output="fine.nc")
        angle = {}
        for run, how in (("fine.nc", ()), ("swing.nc", ()), ("swing.nc", ("--exact",))):
            of_joint = json.loads(self.expect(0, "sample", run, "--joint", "hinge", "--at", "0.4", *how, "--json").out)
            read = json.loads(self.expect(0, "sample", run, "--sensor", "turn", "--at", "0.4", *how, "--json").out)
            angle[run, how] = of_joint["angle"]
            self.assertEqual(read["samples"][0]["values"], [of_joint["angle"], of_joint["angle_rate"], of_joint["angle_acceleration"]])
        right = angle["fine.nc", ()]
        self.assertLess(abs(angle["swing.nc", ("--exact",)] - right), 0.2 * abs(angle["swing.nc", ()] - right))

    def test_estimated_errors_are_those_of_what_is_printed(self):
        """At element ends, between them by the polynomial, and by a shortened element: against a far finer run."""
        info = self.solve()
        fine = text_with("elements = 10\noutput = 0.1", "elements = 400\noutput = 0.0125")
        self.solve(fine.replace("degree = 4", "degree = 8"), name="fine.toml", output="fine.nc")
        told = {}
        for at, how in (("0.2", ()), ("0.2125", ()), ("0.2125", ("--exact",))):
            s, there = self.sample("--body", "brick", "--at", at, *how), json.loads(
                self.expect(0, "sample", "fine.nc", "--body", "brick", "--at", at, "--json").out)
            error = math.dist(s["center_of_mass"], there["center_of_mass"]) / info["model_length"]
            told[at, how] = s["estimated_position_error"]
            self.assertLess(error, 2 * s["estimated_position_error"], (at, how))
            self.assertGreater(error, s["estimated_position_error"] / 5, (at, how))
            error = math.dist(s["velocity"], there["velocity"])
            self.assertLess(error, 2 * s["estimated_velocity_error"], (at, how))
            s, there = self.sample("--joint", "lower", "--at", at, *how), json.loads(
                self.expect(0, "sample", "fine.nc", "--joint", "lower", "--at", at, "--json").out)
            error = math.dist(s["force"], there["force"]) / info["largest_reaction"]
            self.assertLess(error, 2 * s["estimated_reaction_error"] + 1e-13, (at, how))
            self.assertEqual(s["source"], "solved" if how else
                             "acceleration level" if at == "0.2" else "polynomial")
        self.assertGreater(told["0.2125", ()], 10 * told["0.2125", ("--exact",)])
        header, row = self.expect(0, "sample", "run.nc", "--body", "brick", "--at", "0.2", "--csv").out.splitlines()
        self.assertEqual(float(dict(zip(header.split(","), row.split(",")))["estimated_position_error [1]"]), told["0.2", ()])
        self.solve(SMALL + 'estimate = "none"\n', name="bare.toml", output="run.nc")
        self.assertIsNone(self.sample("--body", "brick", "--at", "0.2")["estimated_position_error"])
        self.assertIsNone(self.sample("--joint", "upper", "--at", "0.2")["estimated_reaction_error"])

    def test_samples_beyond_the_horizon_are_flagged(self):
        """A pendulum of 0.1 m on its head: perturbations grow by exp(sqrt(g / l) t), 1e11 by 2.6 s."""
        upright = """format = 1
gravity = [0, 0, -9.81]
[[body]]
name = "bob"
shape = { point = true }
mass = 1
position = [0, 0, 0.1]
[[joint]]
name = "rod"
type = "rod"
between = ["world", "bob"]
[time]
end = 4
elements = 80
[method]
degree = 6
"""
        run = self.solve(upright + "growth = true\n")
        when = math.log(1e11) / math.sqrt(9.81 / 0.1)
        self.assertLess(abs(run["horizon"] - when), 0.4)
        for at, beyond in (("1", False), ("3.5", True)):
            for of in ("--body", "bob"), ("--joint", "rod"):
                self.assertIs(self.sample(*of, "--at", at)["beyond_horizon"], beyond)
                text = self.expect(0, "sample", "run.nc", *of, "--at", at).out
                self.assertEqual("beyond the horizon" in text, beyond)
                header, row = self.expect(0, "sample", "run.nc", *of, "--at", at, "--csv").out.splitlines()
                self.assertEqual(dict(zip(header.split(","), row.split(",")))["beyond_horizon"], "01"[beyond])
        self.solve(upright)
        self.assertIsNone(self.sample("--body", "bob", "--at", "3.5")["beyond_horizon"])

    def test_reactions_hold_the_weight(self):
        still = SMALL.replace("angular_velocity = [0, 0, 2]\n", "").replace("position = [1, 0, 0]", "position = [0, 0, -1]")
        still = still.replace("position = [1, 0, -1]", "position = [0, 0, -2]")
        self.solve(still)
        mass = 0.3 * 0.2 * 0.1 * 1000
        for t in ("0.1", "0.12"):
            upper, lower = self.sample("--joint", "upper", "--at", t), self.sample("--joint", "lower", "--at", t)
            self.assertAlmostEqual(upper["force"][2], (mass + 0.5) * 9.81, delta=1e-9)
            self.assertAlmostEqual(lower["force"][2], 0.5 * 9.81, delta=1e-9)
            self.assertEqual(upper["source"], "acceleration level" if t == "0.1" else "polynomial")
            text = self.expect(0, "sample", "run.nc", "--joint", "upper", "--at", t).out
            self.assertNotIn("before", text, "where nothing jumps, one side says all")

    def test_reactions_on_both_sides_of_a_jump(self):
        kick = ('[[load]]\nname = "kick"\ntype = "force"\nbody = "bob"\npoint = [0, 0, 0]\nvalue = [0, 0, -3]\n'
                "from = 0.25\n")
        at = SMALL.index("[time]")
        self.solve(SMALL[:at] + kick + SMALL[at:])
        for t, is_there in (("0.25", True), ("0.3", False)):
            text = self.expect(0, "sample", "run.nc", "--joint", "lower", "--at", t).out
            self.assertEqual("force before" in text, is_there, text)

    def test_several_instants(self):
        self.solve()
        one = self.sample("--body", "bob", "--at", "0.3")
        many = self.sample("--body", "bob", "--at", "0.1", "--at", "0.3")
        self.assertEqual([s["t"] for s in many["samples"]], [0.1, 0.3])
        self.assertEqual(many["samples"][1]["position"], one["position"])
        rows = self.expect(0, "sample", "run.nc", "--body", "bob", "--at", "0.1", "0.3", "--csv").out.splitlines()
        self.assertEqual(len(rows), 3)
        self.assertEqual(float(rows[2].split(",")[1]), one["position"][0])

    def test_degrees_and_accelerations(self):
        self.solve(HINGED)
        s, j = self.sample("--body", "brick", "--at", "0.1"), self.sample("--joint", "hinge", "--at", "0.1")
        degree = math.pi / 180

        def table(*arguments):
            header, row = self.expect(0, "sample", "run.nc", *arguments, "--at", "0.1", "--csv").out.splitlines()
            return {name: float(cell or "nan") for name, cell in zip(header.split(","), row.split(","))}
        plain, shown = table("--body", "brick"), table("--body", "brick", "--unit", "deg", "--unit", "mm")
        self.assertEqual([plain[f"a{x} [m/s^2]"] for x in "xyz"], s["acceleration"])
        self.assertEqual([plain[f"alpha{x} [rad/s^2]"] for x in "xyz"], s["angular_acceleration"])
        self.assertTrue(any(s["acceleration"]) and any(s["angular_acceleration"]), "the control")
        for i, x in enumerate("xyz"):
            for name, si, factor in ((f"alpha{x} [deg/s^2]", s["angular_acceleration"], 1 / degree),
                                     (f"w{x} [deg/s]", s["angular_velocity"], 1 / degree), (f"{x} [mm]", s["position"], 1000),
                                     (f"a{x} [mm/s^2]", s["acceleration"], 1000)):
                self.assertAlmostEqual(shown[name], factor * si[i], delta=1e-12 * abs(factor * si[i]))
        joint = table("--joint", "hinge", "--unit", "deg")
        for end, per in (("", ""), ("_rate", "/s"), ("_acceleration", "/s^2")):
            self.assertAlmostEqual(joint[f"angle{end} [deg{per}]"], j["angle" + end] / degree, delta=1e-12 * abs(j["angle" + end] / degree))
        text = self.expect(0, "sample", "run.nc", "--body", "brick", "--at", "0.1", "--unit", "deg").out
        self.assertRegex(text, r"(?m)^  acceleration .* m/s\^2$")
        self.assertRegex(text, r"(?m)^  angular acceleration .* deg/s\^2$")
        self.assertRegex(self.expect(0, "sample", "run.nc", "--joint", "hinge", "--at", "0.1", "--unit", "rpm").out,
                         r"(?m)^  angle rate .* rpm$")
        self.expect(0, "export", "run.nc", "--csv", "deg.csv", "--unit", "deg")
        self.expect(0, "export", "run.nc", "--csv", "rad.csv")
        deg, rad = (list(csv.reader((self.folder / name).read_text().splitlines())) for name in ("deg.csv", "rad.csv"))
        self.assertIn("hinge.angle_acceleration [deg/s^2]", deg[0])
        for head, unit, x, y in zip(rad[0], deg[0], rad[-1], deg[-1]):
            if head != unit:
                self.assertEqual(unit, head.replace("[rad", "[deg"))
                self.assertAlmostEqual(float(y) * degree, float(x), delta=1e-12 * abs(float(x)))
            else:
                self.assertEqual(x, y, head)
        peaks = json.loads(self.expect(0, "peaks", "run.nc", "hinge.angle", "--unit", "deg", "--json").out)["peaks"][0]
        plain = json.loads(self.expect(0, "peaks", "run.nc", "hinge.angle", "--json").out)["peaks"][0]
        self.assertEqual(peaks["unit"], "deg")
        self.assertAlmostEqual(peaks["peak"]["value"] * degree, plain["peak"]["value"], delta=1e-12)

    def test_names_that_are_asked_for(self):
        text = HINGED.replace("[time]", '[[point]]\nname = "tip"\nbody = "brick"\nposition = [1, 0, 0]\n[[point]]\nname = "hook"\nbody = "world"\n'
                              'position = [0, 0, 3]\n[[load]]\nname = "push"\ntype = "spring"\npoints = ["hook", "tip"]\n'
                              'stiffness = 3\nfree_length = 1\n[[sensor]]\nname = "eye"\ntype = "point"\nbody = "brick"\n[time]')
        self.solve(text)
        joint = self.sample("--joint", "hinge", "--at", "0.1")
        directors = self.sample("--body", "brick", "--at", "0.1")["directors"]
        for what in ("force", "torque"):
            self.assertEqual(list(joint[what + "_in"]), ["brick"])
            for d, along in zip(directors, joint[what + "_in"]["brick"]):
                self.assertAlmostEqual(sum(x * y for x, y in zip(d, joint[what])), along, delta=1e-9)
        self.assertGreater(math.dist(joint["force_in"]["brick"], joint["force"]), 1e-3, "the control")
        peaks = json.loads(self.expect(0, "peaks", "run.nc", "hinge.force_in.brick", "hinge.force", "--json").out)["peaks"]
        self.assertAlmostEqual(peaks[0]["peak"]["value"], peaks[1]["peak"]["value"], delta=1e-9 * peaks[1]["peak"]["value"])
        self.assertEqual(self.expect(0, "peaks", "run.nc").out.count("force_in"), 0)
        self.expect(0, "export", "run.nc", "--csv", "all.csv")
        self.assertNotIn("force_in", (self.folder / "all.csv").read_text())
        self.expect(0, "peaks", "run.nc", "tip.acceleration", "tip.velocity.x", "hook.position.z", "push.force")
        load = self.sample("--sensor", "push", "--at", "0.1")
        self.assertEqual((load["type"], load["components"]), ("load", ["force", "length", "power"]))
        self.assertEqual(self.sample("--sensor", "tip", "--at", "0.1")["type"], "point")
        self.assertEqual(self.expect(0, "completion", "--sensors", "run.nc").out.split(), ["eye", "tip", "push"])
        # Of a part that there is, what it has; of another kind, how it is asked for.
        for arguments, words in ((("peaks", "run.nc", "hinge.force_in.brik"), "did you mean 'hinge.force_in.brick'?"),
                                 (("peaks", "run.nc", "hinge.stress"), "there are 'hinge.angle', "),
                                 (("peaks", "run.nc", "eye.acceleration"), "there are 'eye.x', "),
                                 (("peaks", "run.nc", "nothing.at.all"), "parts known here: brick, "),
                                 (("sample", "run.nc", "--sensor", "brick", "--at", "0"), "it is asked for by --body"),
                                 (("sample", "run.nc", "--sensor", "hook", "--at", "0"), "a point of the world"),
                                 (("sample", "run.nc", "--sensor", "hinge", "--at", "0"), "it is asked for by --joint"),
                                 (("sample", "run.nc", "--body", "push", "--at", "0"), "it is asked for by --sensor"),
                                 (("sample", "run.nc", "--joint", "nix", "--at", "0"), "it has 'hinge'")):
            self.assertIn(words, self.expect(2, *arguments).err, arguments)

    def test_peaks_beside_jumps(self):
        """All is driven, and a force turns round with the motion: elements beside that are nanoseconds long, and exact
        solutions begin within rounding of it. The drive bears 500 N and m a at most, just behind the jump."""
        self.write("jump.toml", 'format = 1\nbody = [{ name = "ram", shape = { box = [0.4, 0.08, 0.06] }, mass = 12 }]\n'
                   'time = { end = 2 }\nstart = { initial = "project" }\n[[joint]]\nname = "slide"\ntype = "prismatic"\n'
                   'between = ["world", "ram"]\nat = [0, 0, 0]\naxis = [1, 0, 0]\n[[drive]]\nname = "motor"\ntype = "joint"\n'
                   'joint = "slide"\nharmonic = { amplitude = 0.2, frequency = 1 }\n[[load]]\nname = "cutting"\n'
                   'type = "force"\nbody = "ram"\nexpression = ["-500*step(slide.displacement_rate)", "0", "0"]\n')
        self.expect(0, "solve", "jump.toml", "-o", "jump.nc", "-q")
        peaks = json.loads(self.expect(0, "peaks", "jump.nc", "motor.effort", "--json").out)["peaks"][0]
        inertia = 12 * 0.2 * (2 * math.pi) ** 2
        self.assertAlmostEqual(peaks["max"]["value"], 500 + inertia, delta=1e-4)
        self.assertAlmostEqual(peaks["min"]["value"], -inertia, delta=1e-4)

    def test_usage_errors(self):
        self.solve()
        for arguments in (
            ("sample", "run.nc", "--body", "brick", "--at", "0", "--unit", "furlong"),
            ("sample", "run.nc", "--joint", "upper", "--at", "0", "--unit", "kg"),
            ("sample", "run.nc", "--body", "brick", "--at", "0", "--unit", "deg", "--json"),
            ("export", "run.nc", "--csv", "x.csv", "--unit", "kg"),
            ("peaks", "run.nc", "--unit", "kg"),
            ("sample", "run.nc", "--body", "nobody", "--at", "0"),
            ("sample", "run.nc", "--joint", "brick", "--at", "0"),
            ("sample", "run.nc", "--at", "0"),
            ("sample", "run.nc", "--body", "bob", "--joint", "upper", "--at", "0"),
            ("sample", "run.nc", "--body", "bob"),
            *(("sample", "run.nc", "--body", "bob", "--at=" + t)
              for t in ("-1", "0.6", "nan", "inf", "1e400", "0,1", "0x1", "", "0.1s")),
            (), ("frobnicate",), ("solve",), ("solve", "small.toml", "--nope"), ("check", "small.toml", "more"),
            ("solve", "small.toml", "--diagnostics", "xml"), ("export", "run.nc"), ("explain", "no-such-code"),
            ("schema", "--json", "--md"),
        ):
            done = self.expect(USAGE, *arguments)
            if "--json" not in arguments:
                self.assertEqual(done.out, "", arguments)
            self.assertNotEqual(done.err, "", arguments)

    def test_json_failure_is_one_object(self):
        for arguments, code in ((("solve", "missing.toml"), IO), (("sample", "x.nc", "--body", "b"), USAGE),
                                (("info", "missing.nc"), IO), (("solve",), USAGE)):
            result = json.loads(self.expect(code, *arguments, "--json").out)
            self.assertIs(result["converged"], False)
            self.assertEqual(result["exit_code"], code)
            self.assertEqual(len(result["errors"]), 1)
            self.assertNotEqual(result["message"], "")

    def test_strange_files_are_refused(self):
        self.solve()
        whole = (self.folder / "run.nc").read_bytes()
        self.write("empty.nc", b"")
        self.write("text.nc", SMALL)
        self.write("signature.nc", b"\x89HDF\r\n\x1a\n")
        self.write("garbage.nc", b"\x89HDF\r\n\x1a\n" + hashlib.sha512(b"livens").digest() * 1000)
        for k in range(1, 16):
            self.write(f"cut{k}.nc", whole[: len(whole) * k // 16])
        (self.folder / "folder.nc").mkdir()
        for name in self.files():
            if name.endswith(".nc") and name != "run.nc":
                for command in (("info", name), ("sample", name, "--body", "bob", "--at", "0"),
                                ("export", name, "--csv", "x.csv")):
                    done = self.expect(IO, *command)
                    self.assertIn(name, done.err)
        for name, code in (("empty.nc", "io-truncated"), ("text.nc", "io-foreign"), ("garbage.nc", "io-foreign"),
                           ("cut9.nc", "io-truncated"), ("/dev/zero", "io-not-a-file")):
            errors = json.loads(self.expect(IO, "info", name, "--json").out)["errors"]
            self.assertEqual([e["code"] for e in errors], [code], name)
        self.assertFalse((self.folder / "x.csv").exists())

    def test_flipped_bytes_never_crash(self):
        self.solve(SMALL.replace("elements = 10", "elements = 2").replace("output = 0.1", "output = 0.5"))
        whole = (self.folder / "run.nc").read_bytes()
        outcomes = set()
        for k in range(60):   # a fixed set of places: the header, and all over the file
            place = 8 + 37 * k if k < 40 else (k - 39) * len(whole) // 21
            self.write("flipped.nc", whole[:place] + bytes([whole[place] ^ 0x55]) + whole[place + 1:])
            code = self.run_program("info", "flipped.nc").returncode
            self.assertIn(code, (0, IO), f"byte {place}")
            outcomes.add(code)
            self.expect(IO, "sample", "flipped.nc", "--body", "bob", "--at", "0")
        self.assertEqual(outcomes, {0, IO})

    def test_info_reads_the_header_only(self):
        self.solve()
        whole = (self.folder / "run.nc").read_bytes()
        with open(self.folder / "huge.nc", "wb") as huge:   # sparse: reading it would take an hour
            huge.write(whole)
            huge.truncate(1 << 40)
        self.assertEqual(json.loads(self.expect(0, "info", "huge.nc", "--json", timeout=5).out)["elements"], 10)
        with open(self.folder / "foreign.nc", "wb") as huge:
            huge.write(b"CDF\2" + bytes(60))
            huge.truncate(1 << 40)
        self.expect(IO, "info", "foreign.nc", timeout=5)

    def test_frozen_files_load_for_ever(self):
        frozen = sorted(DATA.glob("format_*.nc"))
        self.assertGreater(len(frozen), 0)
        for file in frozen:
            expected = json.loads(file.with_suffix(".json").read_text())
            info = json.loads(self.expect(0, "info", file, "--json").out)
            for key, value in expected["info"].items():
                self.assertEqual(info[key], value, key)
            for query in expected["samples"]:
                s = json.loads(self.expect(0, "sample", file, *query["arguments"], "--json").out)
                for key, value in query["values"].items():
                    for a, b in zip(s[key], value, strict=True):
                        self.assertAlmostEqual(a, b, delta=1e-12, msg=key)

    def test_netcdf4_python_reads_it(self):
        try:
            import netCDF4
        except ImportError:
            self.skipTest("netCDF4 is not installed")
        self.solve()
        with netCDF4.Dataset(self.folder / "run.nc") as run:
            self.assertEqual(run.data_model, "NETCDF3_64BIT_OFFSET")
            self.assertEqual(run.livens_format, 2)
            self.assertEqual(run["position"].dimensions, ("time", "body", "xyz"))
            self.assertEqual(run["position"].units, "m")
            self.assertEqual(run.newton_iterations, json.loads((self.folder / "run.nc.json").read_text())["newton_iterations"])
            self.assertEqual(run.converged, 1)
            self.assertEqual(run["body"][:].tolist(), ["brick", "bob"])   # `_Encoding` makes strings of characters
            self.assertEqual(str(run["scenario"][:]), SMALL)
            self.assertEqual(json.loads(str(run["options"][:]))["method"]["degree"], 4)
            self.assertEqual(json.loads(str(run["manifest"][:]))["convergence"]["blocks"], 10)
            for name, variable in run.variables.items():
                for attribute in ("units", "long_name", "frame"):
                    self.assertTrue(getattr(variable, attribute), name)
            end = json.loads(self.expect(0, "sample", "run.nc", "--body", "brick", "--at", "0.5", "--json").out)
            self.assertEqual(run["position"][-1, 0].tolist(), end["position"])
            self.assertEqual(run["directors"][-1, 0].tolist(), end["directors"])
            self.assertTrue(all(math.isnan(x) for x in run["quaternion"][-1, 1].data))

    def test_xarray_reads_it(self):
        """With either engine; the one of SciPy needs nothing else."""
        try:
            import xarray
        except ImportError:
            self.skipTest("xarray is not installed")
        self.solve()
        end = json.loads(self.expect(0, "sample", "run.nc", "--body", "bob", "--at", "0.5", "--json").out)
        n_engines = 0
        for engine, module in (("scipy", "scipy"), ("netcdf4", "netCDF4")):
            if importlib.util.find_spec(module) is None:
                continue
            n_engines += 1
            with xarray.open_dataset(self.folder / "run.nc", engine=engine) as run:
                self.assertEqual(run.body.values.tolist(), ["brick", "bob"])
                self.assertEqual(run.joint.values.tolist(), ["upper", "lower"])
                self.assertEqual(run.position.sel(body="bob").isel(time=-1).values.tolist(), end["position"])
                self.assertEqual(run.position.dims, ("time", "body", "xyz"))
                self.assertEqual(run.position.attrs["units"], "m")
                self.assertEqual(run.attrs["status"], "converged")
                self.assertEqual(run.attrs["title"], "a brick on a rod")
                self.assertEqual(str(run.scenario.values), SMALL)
                self.assertEqual(run.X.attrs["degree"], 4)
                self.assertEqual((run.quaternion.attrs["order"], run.directors.shape), ("w, x, y, z", (6, 2, 3, 3)))
        if n_engines == 0:
            self.skipTest("xarray has neither SciPy nor netCDF4")

    def test_ncdump_reads_it(self):
        ncdump = shutil.which("ncdump")
        if ncdump is None:
            self.skipTest("ncdump is not installed")
        self.solve()
        text = subprocess.run([ncdump, self.folder / "run.nc"], check=True, capture_output=True, text=True).stdout
        for line in ("\tdouble position(time, body, xyz) ;", '\t\tposition:units = "m" ;', "\t\t:livens_format = 2 ;",
                     '\t\t:status = "converged" ;', '  "brick",', "\ttime = 6 ;"):
            self.assertIn(line, text.split("\n"))
        kind = subprocess.run([ncdump, "-k", self.folder / "run.nc"], check=True, capture_output=True, text=True)
        self.assertEqual(kind.stdout.strip(), "64-bit offset")

    def test_texts(self):
        self.assertRegex(self.expect(0, "version").out, r"^livens \d+\.\d+\.\d+\n$")
        self.assertEqual(json.loads(self.expect(0, "version", "--json").out)["format"], 2)
        self.assertEqual(json.loads(self.expect(0, "schema", "--json").out)["type"], "object")
        self.assertIn("#", self.expect(0, "schema").out)
        codes = self.expect(0, "explain").out.split()
        self.assertIn("unknown-key", codes)
        headings = re.findall(r"^## (.+)$", (SOURCE / "docs" / "diagnostics.md").read_text(), re.M)
        for code in codes[::10 if SANITIZED else 1]:
            page = self.expect(0, "explain", code).out
            self.assertGreater(len(page), 120, code)
            self.assertTrue(page.endswith(f"\nIn the sources: docs/diagnostics.md#{code}\n\nOn the site: diagnostics/{code}.html\n"), page)
            self.assertIn(code, headings)
        for command in ("solve", "check", "mass", "equilibrium", "modes", "info", "sample", "export", "schema", "explain",
                        "version"):
            self.assertIn(f"livens {command}", self.expect(0, command, "--help").out)
            self.assertIn(f"livens {command}", (SOURCE / "docs" / "program.md").read_text())


class WrongInput(ProgramTest):
    """Every wrong scenario: exit code, place, and an older result that stays as it is."""

    def refuse(self, text, code=SCENARIO, line=None, diagnostic=None):
        """`line`: the text of the line that must be named."""
        path = self.write("wrong.toml", text)
        old = self.write("run.nc", OLDER)
        done = self.expect(code, "solve", path.name, "-o", "run.nc", "--diagnostics", "gnu")
        self.assertEqual(old.read_text(), OLDER)
        self.assertEqual(self.files(), ["run.nc", "wrong.toml"])
        self.assertTrue(any(self.names(finding, text, line, diagnostic) for finding in done.err.splitlines()),
                        f"expected {diagnostic} at {line!r}:\n{done.err}")
        self.expect(code, "check", path.name)
        return done

    def names(self, finding, text, line, diagnostic):
        """Whether this message names the line and the code; columns must lie inside their lines."""
        if diagnostic is not None and f"[{diagnostic}]" not in finding:
            return False
        if line is None:
            return True
        match = re.match(r"wrong\.toml:(\d+):(\d+): error: ", finding)
        if match is None:
            return False
        lines = text.splitlines() + [""]
        self.assertLessEqual(int(match[2]), len(lines[int(match[1]) - 1]) + 1, finding)
        return line in lines[int(match[1]) - 1]

    def test_unknown_key(self):
        done = self.refuse(text_with("density =", "densty ="), line="densty", diagnostic="unknown-key")
        self.assertIn("density", done.err)

    def test_wrong_types(self):
        self.refuse(text_with("density = 1000", 'density = true'), line="density")
        self.refuse(text_with("position = [1, 0, 0]", "position = 1"), line="position")
        self.refuse(text_with("position = [1, 0, 0]", "position = [1, 0]"), line="position")
        self.refuse(text_with("elements = 10", "elements = 10.5"), line="elements")
        self.refuse(text_with("[time]", "time = 3\n[other]"), line="")

    def test_missing_body(self):
        self.refuse(text_with('["brick", "bob"]', '["brick", "bop"]'), line="bop")

    def test_no_body_at_all(self):
        self.refuse("format = 1\n[time]\nend = 1\nelements = 1\n")

    def test_two_bodies_of_one_name(self):
        self.refuse(text_with('name = "bob"', 'name = "brick"'), line='name = "brick"')

    def test_mass(self):
        for mass in ("0", "-1", "nan", "inf", "-0.0", "1e400"):
            self.refuse(text_with("mass = 0.5", f"mass = {mass}"), line="mass")
        self.refuse(text_with("density = 1000", "density = 0"), line="density")
        self.refuse(text_with("density = 1000", "density = -5"), line="density")

    def test_impossible_inertia(self):
        brick = 'shape = { box = [0.3, 0.2, 0.1] }\ndensity = 1000'
        done = self.refuse(text_with(brick, "mass = 1\ninertia = [1, 1, 3]"), line="inertia")
        self.assertIn("triangle", done.err)
        self.refuse(text_with(brick, "mass = 1\ninertia = [-1, 1, 1]"), line="inertia")

    def test_directors_that_are_not_orthonormal(self):
        for directors in ("[[1, 0, 0], [0, 1, 0], [0, 0.1, 1]]", "[[2, 0, 0], [0, 1, 0], [0, 0, 1]]",
                          "[[0, 1, 0], [1, 0, 0], [0, 0, 1]]"):
            self.refuse(text_with("position = [1, 0, 0]", f"position = [1, 0, 0]\ndirectors = {directors}"),
                        line="directors")

    def test_self_joint(self):
        self.refuse(text_with('["brick", "bob"]', '["bob", "bob"]'), line="bob")

    def test_contradictory_joints(self):
        # The same two points held at two distances.
        second = '[[joint]]\nname = "again"\ntype = "rod"\nbetween = ["brick", "bob"]\nlength = 1.5\n\n[time]'
        self.refuse(text_with("[time]", second))

    def test_inconsistent_start(self):
        self.refuse(text_with('type = "rod"\nbetween = ["world", "brick"]',
                              'type = "rod"\nbetween = ["world", "brick"]\nlength = 2'))
        self.refuse(text_with("angular_velocity = [0, 0, 2]", "velocity = [1, 0, 0]"))

    def test_degree_zero_and_beyond(self):
        for degree in ("0", "17", "-1", "99999999999999999999"):
            self.refuse(text_with("degree = 4", f"degree = {degree}"), line="degree")

    def test_mixed_elements(self):
        def mixed(lines, time="end = 0.5\nelements = 10\noutput = 0.1"):
            text = SMALL.replace('family = "lobatto"\ndegree = 4', 'family = "mixed"\n' + lines)
            return text.replace("end = 0.5\nelements = 10\noutput = 0.1", time)

        spline = 'basis = "bspline"\n'
        self.refuse(mixed(spline + "degree = 8", "end = 0.5\nelements = 4"), line="degree",
                    diagnostic="spline-degree")
        self.refuse(mixed(spline + "knots = [0, 0, 0, 0.3, 0.2, 0.5, 0.5, 0.5]", "end = 0.5"), line="knots",
                    diagnostic="knots-decreasing")
        nurbs = 'basis = "nurbs"\nknots = [0, 0, 0, 0.2, 0.5, 0.5, 0.5]\n'
        self.refuse(mixed(nurbs + "weights = [1, 1, 0, 1]", "end = 0.5"), line="weights",
                    diagnostic="weights-not-positive")
        self.refuse(mixed("gauss_points = 1"), line="gauss_points", diagnostic="mixed-pairing")
        self.refuse(mixed("window = 0"), line="window", diagnostic="out-of-range")
        self.refuse(SMALL.replace('family = "lobatto"\ndegree = 4', 'family = "midpoint"\nwindow = 2'), line="window", diagnostic="misplaced-key")
        self.refuse(mixed("") + '[end]\ngiven = "positions"\n', diagnostic="missing-key")
        self.refuse(mixed("degree = 2", "end = 0.5\nelements = 10000000"), code=RESOURCES, line="elements",
                    diagnostic="resource-limit")

    def test_elements(self):
        for elements in ("0", "-1"):
            self.refuse(text_with("elements = 10", f"elements = {elements}"), line="elements")

    def test_end_before_start(self):
        self.refuse(text_with("end = 0.5", "end = -0.5"), line="end")
        self.refuse(text_with("end = 0.5", "end = 0"), line="end")

    def test_nan_and_inf(self):
        for value in ("nan", "inf", "-inf", "+nan"):
            self.refuse(text_with("gravity = [0, 0, -9.81]", f"gravity = [0, 0, {value}]"), line="gravity")
            self.refuse(text_with("end = 0.5", f"end = {value}"), line="end")

    def test_syntax(self):
        self.refuse(text_with("density = 1000", "density = = 1000"), line="density")
        self.refuse(text_with("[time]", "[time"), line="")
        self.refuse(text_with("end = 0.5", "end = 0.5\nend = 0.6"), line="end = 0.6")

    def test_format(self):
        self.refuse(text_with("format = 1\n", ""))
        self.refuse(text_with("format = 1", "format = 2"), line="format")

    def test_files_that_are_no_scenarios(self):
        self.refuse("")
        self.refuse(" \n\n")
        self.refuse(bytes(range(256)) * 10)
        self.refuse(b"\x7fELF" + bytes(1000))
        self.refuse(SMALL.encode("utf-16"))
        self.expect(IO, "solve", self.folder, "-o", "run.nc")
        self.expect(IO, "solve", "missing.toml", "-o", "run.nc")
        self.expect(IO, "solve", "run.nc/missing.toml", "-o", "run.nc")

    def test_file_over_the_limit(self):
        self.refuse(SMALL + "#" * (16 << 20), code=RESOURCES)

    def test_deep_nesting(self):
        for opening, closing in (("[", "]"), ("{ a = ", "}")):
            deep = opening * 100_000 + "1" + closing * 100_000
            self.refuse(SMALL + "\n[deep]\nx = " + deep + "\n", line="x = ")
        self.refuse("x" + ".x" * 100_000 + " = 1\n" + SMALL, line="x.x")

    def test_too_many_elements(self):
        done = self.run_program("check", self.write("many.toml", text_with("elements = 10", "elements = 2000000000")))
        self.assertIn(done.returncode, (SCENARIO, RESOURCES), done.err)

    def test_hostile_names_are_escaped(self):
        done = self.refuse(text_with('["brick", "bob"]', '["brick", "\\u001b[31mred"]'))
        self.assertNotIn("\x1b", done.err)


class Files(ProgramTest):
    """Places that cannot be written, and disks that are full."""

    def setUp(self):
        super().setUp()
        self.write("small.toml", SMALL)
        self.solve()
        self.old = (self.folder / "run.nc").read_bytes()
        # Another scenario, so that an overwritten result would differ.
        self.write("other.toml", SMALL.replace("[1, 0, 0]", "[2, 0, 0]"))
        self.before = self.files()

    def assert_untouched(self):
        self.assertEqual((self.folder / "run.nc").read_bytes(), self.old)
        self.assertEqual(self.files(), self.before)

    def test_places_that_are_refused(self):
        (self.folder / "folder").mkdir()
        self.before = self.files()
        for output in ("missing/run.nc", "folder", "folder/", ".", "..", "small.toml/run.nc", "/dev/null", "",
                       "n" * 300, "other.toml", "./other.toml"):
            for arguments in (("-o", output), ("-o", "x.nc", "--csv", output)):
                if output == "":
                    continue
                done = self.expect(IO, "solve", "other.toml", *arguments)
                self.assertIn("cannot write", done.err)
                self.assert_untouched()
        self.write("long.toml", LONG)   # what would take minutes is refused at once
        for output in ("/dev/stdout", "/dev/stderr", "/dev/fd/1"):
            done = self.expect(IO, "solve", "long.toml", "-o", output, "--json", timeout=10)
            self.assertEqual(json.loads(done.out)["errors"][0]["code"], "io-not-a-file")
        with open(self.folder / "out.nc", "wb") as out:
            self.expect(IO, "solve", "long.toml", "-o", "/dev/stdout", stdout=out, timeout=10)
            self.expect(IO, "solve", "long.toml", "-o", "out.nc", stdout=out, timeout=10)
        os.mkfifo(self.folder / "pipe.nc")
        self.expect(IO, "solve", "long.toml", "-o", "pipe.nc", timeout=10)
        self.assertEqual(list((self.folder / "folder").iterdir()), [])

    def test_the_scenario_is_never_overwritten(self):
        os.link(self.folder / "other.toml", self.folder / "hard.nc")
        os.symlink("other.toml", self.folder / "soft.nc")
        text = (self.folder / "other.toml").read_text()
        for output in ("other.toml", "hard.nc", "soft.nc", str(self.folder / "other.toml")):
            self.expect(IO, "solve", "other.toml", "-o", output)
            self.assertEqual((self.folder / "other.toml").read_text(), text)

    def test_size_limit(self):
        # What a full disk looks like to a process; from 0 bytes to nearly the whole file.
        for limit in (0, 1000, len(self.old) - 4096):
            done = self.expect(IO, "solve", "other.toml", "-o", "run.nc", "--json", preexec_fn=lambda: resource.setrlimit(
                resource.RLIMIT_FSIZE, (limit, limit)))
            self.assertIs(json.loads(done.out)["converged"], False)
            self.assertIn("run.nc", done.err)
            self.assert_untouched()

    def test_full_disk(self):
        disk = self.folder / "disk"
        disk.mkdir()
        size = 3 * len(self.old) // 2 // 4096 * 4096
        try:
            mounted = subprocess.run(["mount", "-t", "tmpfs", "-o", f"size={size}", "tmpfs", disk],
                                     stderr=subprocess.DEVNULL).returncode == 0
        except OSError:
            mounted = False
        if not mounted:
            self.skipTest("mounting is not permitted; test_size_limit covers the program's part")
        self.addCleanup(lambda: subprocess.run(["umount", disk], check=True))
        self.expect(0, "solve", "small.toml", "-o", "disk/run.nc")
        (disk / "run.nc.json").unlink()
        self.assertEqual((disk / "run.nc").read_bytes(), self.old)
        done = self.expect(IO, "solve", "other.toml", "-o", "disk/run.nc")
        self.assertIn("space", done.err)
        self.assertEqual((disk / "run.nc").read_bytes(), self.old)
        self.assertEqual([p.name for p in disk.iterdir()], ["run.nc"])

    def test_no_permission(self):
        options = {}
        if os.geteuid() == 0:   # root may write everywhere: become nobody
            options["preexec_fn"] = lambda: os.setuid(65534)
            try:
                subprocess.run([PROGRAM, "version"], stdout=subprocess.DEVNULL, check=True, **options)
            except (OSError, subprocess.SubprocessError):
                self.skipTest("another user cannot run the program where it lies")
        self.folder.chmod(0o555)
        self.addCleanup(self.folder.chmod, 0o755)
        for output in ("run.nc", "new.nc"):
            self.assertIn("ermission", self.expect(IO, "solve", "other.toml", "-o", output, **options).err)
            self.assert_untouched()

    def test_output_that_cannot_be_printed(self):
        with open("/dev/full", "wb") as full:
            for command in (("info", "run.nc"), ("info", "run.nc", "--json"), ("check", "small.toml"), ("schema",),
                            ("sample", "run.nc", "--body", "bob", "--at", "0"), ("version",), ("--help",)):
                done = self.expect(IO, *command, stdout=full)
                self.assertIn("standard output", done.err)
            # The result is safe by then.
            self.expect(IO, "solve", "other.toml", "-o", "new.nc", "--json", stdout=full)
        self.expect(0, "info", "new.nc")

    def test_closed_pipe(self):
        for command in (("schema",), ("solve", "other.toml", "-o", "new.nc", "--json")):
            reading, writing = os.pipe()
            os.close(reading)
            with os.fdopen(writing, "wb") as pipe:
                self.expect(IO, *command, stdout=pipe)
        self.expect(0, "info", "new.nc")

    def test_closed_streams(self):
        for redirection in (">&-", "2>&-", "<&-", ">&- 2>&- <&-"):
            done = subprocess.run(f'"{PROGRAM}" solve other.toml -o new.nc {redirection}', shell=True, cwd=self.folder,
                                  stdout=subprocess.PIPE, stderr=subprocess.PIPE)
            self.assertEqual(done.returncode, IO if ">&-" in redirection.split() else 0, redirection)
            self.expect(0, "info", "new.nc")

    def test_memory_limit(self):
        many = SMALL.replace("elements = 10", "elements = 3000000").replace("output = 0.1\n", "")
        self.write("many.toml", many.replace("degree = 4", "degree = 1"))
        if SANITIZED:
            self.skipTest("the sanitizer needs address space of its own")
        done = self.expect(RESOURCES, "solve", "many.toml", "-o", "run.nc", "--json", preexec_fn=lambda:
                           resource.setrlimit(resource.RLIMIT_AS, (300 << 20, 300 << 20)))
        self.assertIs(json.loads(done.out)["converged"], False)
        self.before = sorted(self.before + ["many.toml"])
        self.assert_untouched()


    def test_memory_is_checked_before_solving(self):
        many = SMALL.replace("elements = 10", "elements = 3000000").replace("output = 0.1\n", "")
        self.write("many.toml", many.replace("degree = 4", "degree = 1"))
        need = json.loads(self.expect(0, "check", "many.toml", "--json").out)["memory_bytes"]
        self.assertGreater(need, 3e6 * 8 * 2 * 60)   # X, P, V and X'' on both sides, of two bodies
        self.assertRegex(self.expect(0, "check", "many.toml").out, r"at least [\d.]+ GB of memory")
        if SANITIZED:
            self.skipTest("the sanitizer needs address space of its own")
        for command in (("check", "many.toml"), ("solve", "many.toml", "-o", "run.nc")):
            done = self.expect(RESOURCES, *command, "--json", timeout=20, preexec_fn=lambda:
                               resource.setrlimit(resource.RLIMIT_AS, (1 << 30, 1 << 30)))
            error = json.loads(done.out)["errors"][0]
            self.assertEqual(error["code"], "resource-limit")
            self.assertRegex(error["message"], r"at least 3\.. GB of memory, and [\d.]+ [MG]B is available; fewer elements")


def wait_until_it_listens(program):
    """Until the program catches Ctrl-C; how soon depends on the machine and on sanitizers."""
    while program.poll() is None:
        status = pathlib.Path(f"/proc/{program.pid}/status").read_text()
        if int(re.search(r"^SigCgt:\s*(\w+)", status, re.M)[1], 16) & 1 << (signal.SIGINT - 1):
            return
        time.sleep(0.01)


class Signals(ProgramTest):
    def start(self, *arguments):
        return subprocess.Popen([PROGRAM, *map(str, arguments)], cwd=self.folder, stdout=subprocess.PIPE,
                                stderr=subprocess.PIPE)

    def test_interrupt_leaves_a_readable_result(self):
        self.write("long.toml", LONG)
        for number in (signal.SIGINT, signal.SIGTERM):
            old = self.write("run.nc", OLDER)
            program = self.start("solve", "long.toml", "-o", "run.nc", "--json")
            wait_until_it_listens(program)
            time.sleep(0.6)
            self.assertIsNone(program.poll(), "the run must be long enough to be interrupted")
            self.assertEqual(old.read_text(), OLDER)
            program.send_signal(number)
            out, err = program.communicate(timeout=60)
            self.assertEqual(program.returncode, 128 + number, err)
            result = json.loads(out)
            self.assertEqual((result["converged"], result["status"]), (False, "cancelled"))
            info = json.loads(self.expect(0, "info", "run.nc", "--json").out)
            self.assertEqual((info["converged"], info["status"]), (False, "cancelled"))
            self.assertGreater(info["elements"], 0)
            self.assertLess(info["end"], 50000)
            s = json.loads(self.expect(0, "sample", "run.nc", "--body", "bob", f"--at={info['end']!r}", "--json").out)
            self.assertTrue(all(math.isfinite(x) for x in s["position"]))
            self.assert_no_temporaries()

    def test_interrupt_while_reading_touches_nothing(self):
        os.mkfifo(self.folder / "pipe.toml")
        old = self.write("run.nc", OLDER)
        program = self.start("solve", "pipe.toml", "-o", "run.nc")
        time.sleep(0.3)
        program.send_signal(signal.SIGINT)
        program.communicate(timeout=20)
        self.assertIn(program.returncode, (-signal.SIGINT, 130))
        self.assertEqual(old.read_text(), OLDER)

    def test_progress_is_for_terminals(self):
        self.write("long.toml", LONG)
        for options, expected in (((), True), (("-q",), False)):
            try:
                terminal, stderr = pty.openpty()
            except OSError as error:   # a root without /dev/pts
                self.skipTest(f"no pseudo-terminal to be had: {error}")
            program = subprocess.Popen([PROGRAM, "solve", "long.toml", *options], cwd=self.folder, stderr=stderr,
                                       stdout=subprocess.PIPE)
            os.close(stderr)
            wait_until_it_listens(program)
            time.sleep(0.6)
            program.send_signal(signal.SIGINT)
            program.communicate(timeout=60)
            seen = b""
            try:
                while chunk := os.read(terminal, 65536):
                    seen += chunk
            except OSError:   # how Linux says that the other end is closed
                pass
            os.close(terminal)
            self.assertEqual(program.returncode, 130)
            if expected:
                self.assertRegex(seen.decode(), r"\r\x1b\[K +\d+ %  \d+ of 1000000 elements  t = .* s to go")
                self.assertIn("\r\x1b[K", seen.decode().split("to go")[-1], "the line is taken away at the end")
            else:
                self.assertNotIn("to go", seen.decode())

    def test_temporaries_of_the_dead_are_removed_and_no_others(self):
        self.write(".livens-1-0.tmp", "of a run that was killed")
        self.write(".livens-mine.tmp", "a name that livens never gives")
        self.write("x.tmp", "a stranger")
        (self.folder / ".livens-2-0.tmp").mkdir()
        os.symlink("small.toml", self.folder / ".livens-3-0.tmp")
        with open(self.write(".livens-4-0.tmp", "of a run that still writes")) as held:
            fcntl.flock(held, fcntl.LOCK_EX)
            self.solve()
        self.assertEqual(self.files(), [".livens-2-0.tmp", ".livens-3-0.tmp", ".livens-4-0.tmp", ".livens-mine.tmp",
                                        "run.nc", "run.nc.json", "small.toml", "x.tmp"])
        self.solve()
        self.assertNotIn(".livens-4-0.tmp", self.files())
        self.assertEqual((self.folder / "small.toml").read_text(), SMALL)

    def test_writers_to_one_name_leave_one_result(self):
        self.write("small.toml", SMALL)
        writers = [self.start("solve", "small.toml", "-o", "run.nc", "-q") for _ in range(8)]
        for writer in writers:
            _, err = writer.communicate(timeout=60)
            self.assertEqual(writer.returncode, 0, err)
        self.expect(0, "sample", "run.nc", "--body", "bob", "--at", "0")
        self.assert_no_temporaries()

    def test_kill_leaves_old_or_new(self):
        text = SMALL.replace("elements = 10", "elements = 2000").replace("output = 0.1", "output = 0.0005")
        self.solve(text)
        old = (self.folder / "run.nc").read_bytes()
        self.write("other.toml", text.replace("[1, 0, 0]", "[2, 0, 0]"))
        self.expect(0, "solve", "other.toml", "-o", "new.nc")
        new = (self.folder / "new.nc").read_bytes()
        times = []
        for _ in range(3):   # of which one may have shared the machine
            begin = time.monotonic()
            self.expect(0, "solve", "other.toml", "-o", "run.nc")
            times.append(time.monotonic() - begin)
        seen = set()
        for k in range(18):
            (self.folder / "run.nc").write_bytes(old)
            program = self.start("solve", "other.toml", "-o", "run.nc", "-q")
            time.sleep(min(times) * (0.1 + 1.0 * k / 17))
            program.kill()
            program.communicate()
            now = (self.folder / "run.nc").read_bytes()
            self.assertTrue(now in (old, new), f"{k}: neither the old result nor the new one")
            seen.add(now == new)
        self.assertIn(False, seen)
        self.expect(0, "solve", "other.toml", "-o", "run.nc")
        self.assert_no_temporaries()


if __name__ == "__main__":
    unittest.main()
