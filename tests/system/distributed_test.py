# SPDX-License-Identifier: BSD-3-Clause
"""One motion by several processes of mpirun, oversubscribed, against the serial run; and what ends them.
LIVENS_PETSC_PROGRAM is a program that was built with PETSc; without it only what is refused is looked at."""
import json
import math
import os
import pathlib
import re
import signal
import subprocess
import sys
import tempfile
import time
import unittest

PROGRAM = os.environ["LIVENS_PROGRAM"]
HAS_PETSC = os.environ.get("LIVENS_HAS_PETSC") == "1"
ENVIRONMENT = {**os.environ, "OMPI_ALLOW_RUN_AS_ROOT": "1", "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM": "1",
               "OMPI_MCA_rmaps_base_oversubscribe": "1", "OMPI_MCA_btl_vader_single_copy_mechanism": "none"}

LINKS = """format = 1
gravity = [0, 0, -9.81]
[[body]]
name = "upper"
shape = {{ box = [0.1, 0.1, 1] }}
mass = 1
position = [0, 0, -0.5]
{upper}
[[body]]
name = "lower"
shape = {{ box = [0.1, 0.1, 1] }}
mass = 1
position = [0, 0, -1.5]
{lower}
[[joint]]
name = "pivot"
type = "revolute"
between = ["world", "upper"]
at = [0, 0, 0]
axis = [0, 1, 0]
rate = 4
[[joint]]
name = "elbow"
type = "revolute"
between = ["upper", "lower"]
at = [0, 0, -1]
axis = [0, 1, 0]
rate = -3
[time]
end = {end}
elements = {elements}
[method]
family = "mixed"
degree = {degree}
estimate = "none"
{more}
"""


def scenario(end=1, elements=80, degree=1, more="", upper="", lower=""):
    return LINKS.format(upper=upper, lower=lower, end=end, elements=elements, degree=degree, more=more)


def between(at_start, at_end):
    """Between positions or momenta: both links are turned by 0.5 rad about the pivot at the end, and turn."""
    turned = [f"[body.end]\nposition = [{-x * math.sin(0.5)}, 0, {-x * math.cos(0.5)}]\nrotation_vector = [0, 0.5, 0]\n"
              f"angular_velocity = [0, 3, 0]\nvelocity = [{-3 * x * math.cos(0.5)}, 0, {3 * x * math.sin(0.5)}]\n"
              for x in (0.5, 1.5)]
    given = f'[start]\ngiven = "{at_start}"\n[end]\ngiven = "{at_end}"\n'
    return scenario(0.2, 41, 2, given, *turned).replace("rate = -3\n", "")


def by_component(known, elements=41, degree=2, end="0.4", damping="0.3", periodic=""):
    """The same links with a damper, and what `known` says of them in place of their rates."""
    text = scenario(end, f"{elements}\n{periodic}", degree,
                    f'[[load]]\ntype = "spring"\nname = "friction"\njoint = "elbow"\nstiffness = 3\ndamping = {damping}\n'
                    + known)
    return text.replace("rate = 4\n", "").replace("rate = -3\n", "")


START = '[start.known]\n"pivot.angle" = 0.1\n"elbow.angle" = -0.2\n"elbow.angle_rate" = 0.5\n'
BORDERS = {
    "between places": between("positions", "positions"),
    "places, then momenta": between("positions", "momenta"),
    "by component": by_component(START + '[end.known]\n"pivot.angle" = 0.4\n'),
    "linear, by component": by_component(START + '[end.known]\n"pivot.angle" = 0.4\n', 80, 1),
    "an unknown damping": by_component(START + '"pivot.angle_rate" = 0\n[end.known]\n"elbow.angle" = 0.1\n',
                                       damping="{ unknown = 0.2, low = 0 }"),
    "an unknown duration": by_component(START + '"pivot.angle_rate" = 0\n[end.known]\n"elbow.angle" = 0.1\n',
                                        end="{ unknown = 0.5, low = 0.1, high = 1 }"),
    "periodic": by_component('[[load]]\ntype = "actuator"\nname = "motor"\njoint = "pivot"\nexpression = "3*cos(2*pi*t)"\n'
                             '[[load]]\ntype = "spring"\nname = "bearing"\njoint = "pivot"\nstiffness = 0\ndamping = 1\n',
                             60, end="1", periodic="periodic = true"),
}


def by_lobatto(text, degree=3):
    """The same problem by elements of lobatto, all at once."""
    family = re.sub(r'family = "mixed"\ndegree = \d+', f'family = "lobatto"\nwindow = "all"\ndegree = {degree}', text)
    assert family != text
    return family


class Distributed(unittest.TestCase):
    def setUp(self):
        self.place = tempfile.TemporaryDirectory()
        self.folder = pathlib.Path(self.place.name)

    def tearDown(self):
        self.place.cleanup()

    def write(self, text, name="run.toml"):
        (self.folder / name).write_text(text)
        return name

    def serial(self, name, output):
        done = subprocess.run([PROGRAM, "solve", name, "-q", "-o", output], cwd=self.folder, capture_output=True, text=True)
        self.assertIn(done.returncode, (0, 7), done.stderr)
        return done

    def ranks(self, n, name, *options, program=(PROGRAM,), check=True):
        done = subprocess.run(["mpirun", "-n", str(n), *program, "solve", name, "--distributed", *options], cwd=self.folder,
                              env=ENVIRONMENT, capture_output=True, text=True, timeout=300)
        if check:
            self.assertIn(done.returncode, (0, 7), done.stdout + done.stderr)
        return done

    def assert_same(self, one, other, what, bound=1e-12):
        import netCDF4
        with netCDF4.Dataset(self.folder / one) as a, netCDF4.Dataset(self.folder / other) as b:
            for name in ("element_end", "X", "P", "end_momentum", "end_velocity", "energy", "work", "linear_impulse",
                         "action_integral", "joint_violation"):
                if name == "P" and name not in a.variables:   # a field of mixed alone
                    continue
                x, y = a[name][:].data, b[name][:].data
                self.assertEqual(x.shape, y.shape, name)
                scale = max(1.0, abs(x).max())
                self.assertLess(abs(x - y).max() / scale, bound, f"{what}: {name}")


@unittest.skipUnless(HAS_PETSC, "built without PETSc: scripts/setup petsc, then -DLIVENS_PETSC=ON")
class ByMpirun(Distributed):
    def test_states_are_those_of_the_serial_run(self):
        for case, text in {"linear": scenario(), "quadratic": scenario(1, 41, 2),
                           "lower multipliers": scenario(1, 41, 2, 'multipliers = "lower"'),
                           "strong": scenario(1, 41, 2, 'momentum = "strong"')}.items():
            name = self.write(text)
            self.serial(name, "serial.nc")
            for n in (1, 2, 3, 4):
                self.ranks(n, name, "-q", "-o", f"ranks{n}.nc")
                self.assert_same("serial.nc", f"ranks{n}.nc", f"{case}, {n} ranks")
                read = subprocess.run([PROGRAM, "info", f"ranks{n}.nc"], cwd=self.folder, capture_output=True, text=True)
                self.assertEqual(read.returncode, 0, read.stderr)   # which verifies checksums

    def test_conditions_at_both_ends_are_met_as_by_one(self):
        for case, text in BORDERS.items():
            name = self.write(text)
            self.serial(name, "serial.nc")
            for n in (1, 2, 3, 4):
                self.assertEqual(self.ranks(n, name, "-q", "-o", f"ranks{n}.nc").returncode, 0)
                self.assert_same("serial.nc", f"ranks{n}.nc", f"{case}, {n} ranks")
                read = subprocess.run([PROGRAM, "info", f"ranks{n}.nc"], cwd=self.folder, capture_output=True, text=True)
                self.assertEqual(read.returncode, 0, read.stderr)   # which verifies checksums

    def test_windows_of_lobatto_are_those_of_the_serial_run(self):
        cases = {"from a state": scenario(1, 41), **{case: text for case, text in BORDERS.items() if "linear" not in case}}
        for case, text in cases.items():
            name = self.write(by_lobatto(text))
            alone = self.serial(name, "serial.nc")
            self.assertEqual(alone.returncode, 7 if "momenta" in case else 0)   # joints hold some of what is asked for
            for n in (1, 2, 3, 4):
                done = self.ranks(n, name, "-q", "-o", f"ranks{n}.nc")
                self.assertEqual((done.returncode, done.stderr[:120]), (alone.returncode, alone.stderr[:120]))
                self.assert_same("serial.nc", f"ranks{n}.nc", f"lobatto, {case}, {n} ranks")
                read = subprocess.run([PROGRAM, "info", f"ranks{n}.nc"], cwd=self.folder, capture_output=True, text=True)
                self.assertEqual(read.returncode, 0, read.stderr)   # which verifies checksums
        self.serial(self.write(by_lobatto(scenario(1, 41))), "serial.nc")
        other = self.write(by_lobatto(scenario(1, 41)).replace("rate = 4", "rate = 4.00000000001"), "other.toml")
        self.ranks(2, other, "-q", "-o", "other.nc")   # the bound sees a rate that is off by 1e-11
        with self.assertRaises(AssertionError):
            self.assert_same("serial.nc", "other.nc", "negative control")

    def test_what_is_found_stands_in_the_file(self):
        for text in (BORDERS["an unknown damping"], by_lobatto(BORDERS["an unknown damping"])):
            self.look_at_what_is_found(text)

    def look_at_what_is_found(self, text):
        name = self.write(text)
        self.serial(name, "serial.nc")
        self.ranks(3, name, "-q", "-o", "ranks.nc")
        found = [json.loads(subprocess.run([PROGRAM, "info", file, "--json"], cwd=self.folder, capture_output=True,
                                           text=True, check=True).stdout) for file in ("serial.nc", "ranks.nc")]
        self.assertEqual(*(next(note for note in one["notes"] if note.startswith("found: "))[:24] for one in found))

    def test_what_is_sent_is_counted(self):
        name = self.write(scenario(1, 240))
        said = {n: json.loads(self.ranks(n, name, "--json").stdout)["distributed"] for n in (2, 4)}
        self.assertIn("has 120 of 240 elements", said[2])
        self.assertIn("has 70 of 240 elements", said[4])

    def test_memory_of_a_rank_falls(self):
        known = START + '[end.known]\n"pivot.angle" = 0.4\n'
        for case, small, large in (("from a state", scenario(0.02, 8), scenario(4, 6000)),
                                   ("a border", by_component(known, 8, 1), by_component(known, 6000, 1)),
                                   ("lobatto", by_lobatto(scenario(0.02, 8)), by_lobatto(scenario(4, 6000))),
                                   ("lobatto, a border", by_lobatto(by_component(known, 8, 1), 5),
                                    by_lobatto(by_component(known, 6000, 1), 5))):
            self.measure_memory(case, small, large)

    def measure_memory(self, case, small, large):
        wrapper = self.folder / "peak.py"
        wrapper.write_text("import os, sys, resource, subprocess\n"
                           "done = subprocess.run(sys.argv[2:])\n"
                           "peak = resource.getrusage(resource.RUSAGE_CHILDREN).ru_maxrss\n"
                           "open(sys.argv[1] + os.environ['OMPI_COMM_WORLD_RANK'], 'w').write(str(peak))\n"
                           "sys.exit(done.returncode)\n")

        def peak(n, name):
            self.ranks(n, name, "-q", "-o", "peak.nc", program=(sys.executable, str(wrapper), "peak", PROGRAM))
            return max(int((self.folder / f"peak{rank}").read_text()) for rank in range(n))

        small, large = self.write(small, "small.toml"), self.write(large, "large.toml")
        alone = peak(1, large) - peak(1, small)
        four = peak(4, large) - peak(4, small)
        print(f"memory above an empty run, {case}: {alone / 1024:.0f} MiB alone, {four / 1024:.0f} MiB a rank of four")
        self.assertLess(four, 0.35 * alone)

    def children(self, program):
        found = []
        for entry in pathlib.Path("/proc").iterdir():
            try:
                if entry.name.isdigit() and b"large.toml" in (entry / "cmdline").read_bytes() \
                        and os.path.samefile(entry / "exe", PROGRAM):
                    found.append(int(entry.name))
            except OSError:
                pass
        return found

    def test_a_killed_rank_ends_all(self):
        self.kill_one_of(scenario(8, 20000))

    def test_a_killed_rank_ends_a_border(self):
        self.kill_one_of(by_component(START + '[end.known]\n"pivot.angle" = 0.4\n', 20000, 1))

    def test_a_killed_rank_ends_a_window_of_lobatto(self):
        self.kill_one_of(by_lobatto(scenario(8, 20000)))

    def kill_one_of(self, text):
        name = self.write(text, "large.toml")
        with subprocess.Popen(["mpirun", "-n", "3", PROGRAM, "solve", name, "--distributed", "-q", "-o", "killed.nc"],
                              cwd=self.folder, env=ENVIRONMENT, stdout=subprocess.PIPE, stderr=subprocess.PIPE) as job:
            until = time.monotonic() + 60
            while len(ranks := self.children(job)) < 3 and time.monotonic() < until:
                time.sleep(0.05)
            time.sleep(1)
            os.kill(ranks[1], signal.SIGKILL)
            job.wait(60)
            said = job.stderr.read().decode() + job.stdout.read().decode()
        self.assertNotEqual(job.returncode, 0)
        self.assertIn("killed", said.lower())
        self.assertFalse((self.folder / "killed.nc").exists())

    def test_what_cannot_be_divided_is_refused_once(self):
        cases = {"ranks-elements": scenario(1, 2), "ranks-method": scenario(1, 40, 2, "window = 10")}
        cases = {**cases, "ranks-method ": by_lobatto(scenario(1, 40)).replace('window = "all"', "window = 10"),
                 "ranks-elements ": by_lobatto(scenario(1, 2))}
        for code, text in cases.items():
            done = self.ranks(4, self.write(text), "-o", "none.nc", check=False)
            self.assertEqual(done.returncode, 3, done.stderr)
            self.assertEqual(done.stderr.count(f"error[{code.strip()}]"), 1, done.stderr)
            self.assertFalse((self.folder / "none.nc").exists())

    def test_a_number_that_nothing_shows_is_refused_once(self):
        # the mass of a link that nothing but its weight moves
        text = """format = 1
gravity = [0, 0, -9.81]
[[body]]
name = "link"
shape = { box = [0.1, 0.1, 1] }
mass = { unknown = 2, low = 1, high = 3 }
position = [0, 0, -0.5]
[[joint]]
name = "pivot"
type = "revolute"
between = ["world", "link"]
at = [0, 0, 0]
axis = [0, 1, 0]
[start.known]
"pivot.angle" = 0.3
"pivot.angle_rate" = 0
[end.known]
"pivot.angle" = 0.5
[time]
end = 0.4
elements = 40
[method]
family = "mixed"
degree = 2
"""
        done = self.ranks(3, self.write(text), "-o", "none.nc", check=False)
        self.assertEqual(done.returncode, 3, done.stderr)
        self.assertEqual(done.stderr.count("error[unknown-unseen]"), 1, done.stderr)
        self.assertFalse((self.folder / "none.nc").exists())

    def test_a_place_that_is_taken_stays(self):
        (self.folder / "taken.nc").write_text("somebody's")
        done = self.ranks(2, self.write(scenario(1, 8)), "-o", "taken.nc", check=False)
        self.assertNotEqual(done.returncode, 0)
        self.assertEqual((self.folder / "taken.nc").read_text(), "somebody's")

    def test_without_mpirun_it_is_refused(self):
        done = subprocess.run([PROGRAM, "solve", self.write(scenario()), "--distributed"], cwd=self.folder,
                              capture_output=True, text=True)
        self.assertEqual(done.returncode, 2)
        self.assertIn("mpirun", done.stderr)


@unittest.skipIf(HAS_PETSC, "built with PETSc")
class Without(Distributed):
    def test_it_is_refused_by_name(self):
        done = subprocess.run([PROGRAM, "solve", self.write(scenario()), "--distributed"], cwd=self.folder,
                              capture_output=True, text=True)
        self.assertEqual(done.returncode, 2)
        self.assertIn("PETSc", done.stderr)


if __name__ == "__main__":
    result = unittest.main(exit=False, verbosity=2).result
    if not HAS_PETSC:
        print("SKIPPED: distributed (built without PETSc: scripts/setup petsc, then -DLIVENS_PETSC=ON)")
    sys.exit(not result.wasSuccessful())
