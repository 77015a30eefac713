# SPDX-License-Identifier: BSD-3-Clause
"""Signals in every phase of long runs, memory that is stated, findings that check makes before solve does."""
import json
import os
import resource
import signal
import subprocess
import time
import unittest

from program_test import PROGRAM, SANITIZED, SMALL, ProgramTest

FREE_BODY = """format = 1
[[body]]
name = "a"
shape = { box = [1, 0.5, 0.2] }
mass = 1
angular_velocity = [0.1, 0, 1]
[time]
end = %d
elements = %d
output = 100
[method]
condition = %s
"""
NEEDLE = """format = 1
[[body]]
name = "rod"
shape = { box = [1e9, 0.1, 0.1] }
mass = 2
[time]
end = 1
elements = 2
[method]
family = "%s"
"""


def cpu_seconds(pid):
    with open(f"/proc/{pid}/stat") as file:
        fields = file.read().rsplit(")", 1)[1].split()
    return (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK")


@unittest.skipIf(SANITIZED, "times and sizes are those of the program as it is used")
@unittest.skipUnless(os.path.exists("/proc/self/stat"), "needs /proc")
class Stops(ProgramTest):
    def whole_run(self, scenario):
        """CPU seconds of a run that nobody stops: signals come at parts of it, as fast as the machine and the program are.
        Beside other processes the same run takes up to twice as many, so that parts stay well below a half."""
        program = subprocess.Popen([PROGRAM, "solve", scenario, "-q", "-o", "whole.nc"], cwd=self.folder)
        _, status, used = os.wait4(program.pid, 0)
        program.returncode = os.waitstatus_to_exitcode(status)
        self.assertEqual(program.returncode, 0)
        return used.ru_utime + used.ru_stime

    def assertStopsAtOnce(self, scenario, at, *options):
        """Within 2 s of CPU time, where the motion below takes half a second; elsewhere, and beside other processes, within
        four times of what it takes there and then."""
        self.write("slowness.toml", FREE_BODY % (10000, 100000, "false"))
        used = self.after_signal(scenario, at, *options)
        if used >= 2:
            self.assertLess(used, 4 * self.whole_run("slowness.toml"))

    def after_signal(self, scenario, at, *options):
        """CPU seconds that a run takes after SIGINT, which comes when it has used `at` of them."""
        (self.folder / "run.nc").unlink(missing_ok=True)
        program = subprocess.Popen([PROGRAM, "solve", scenario, "-q", "-o", "run.nc", *options], cwd=self.folder,
                                   stderr=subprocess.DEVNULL)
        while program.poll() is None and cpu_seconds(program.pid) < at:
            time.sleep(0.01)
        self.assertIsNone(program.returncode, "it was done too early")
        before = cpu_seconds(program.pid)
        program.send_signal(signal.SIGINT)
        os.waitid(os.P_PID, program.pid, os.WEXITED | os.WNOWAIT)
        used = cpu_seconds(program.pid) - before
        self.assertEqual(program.wait(), 130)
        return used

    def test_condition_numbers_are_given_up_at_once(self):
        """Unstopped they take 30 s of CPU time and more, and the motion half a second."""
        self.write("run.toml", FREE_BODY % (10000, 100000, "true"))
        for at in (1.2, 3):
            self.assertStopsAtOnce("run.toml", at)
            info = json.loads(self.expect(0, "info", "run.nc", "--json").out)
            self.assertEqual(info["status"], "cancelled")

    def test_long_runs_stop_at_once(self):
        self.write("run.toml", FREE_BODY % (20000, 200000, "false"))
        whole = self.whole_run("run.toml")
        for part in (0.05, 0.15, 0.3):
            self.assertStopsAtOnce("run.toml", part * whole)
            self.expect(0, "info", "run.nc")

    def test_threads_of_one_motion_stop_at_once(self):
        """In the march that all of time begins with, in rows and tangents, in the elimination: of two threads either."""
        self.write("run.toml", FREE_BODY % (1000, 10000, "false") + 'family = "mixed"\ndegree = 1\nestimate = "none"\n')
        whole = self.whole_run("run.toml")
        for part in (0.05, 0.2, 0.35, 0.5):
            self.assertStopsAtOnce("run.toml", part * whole, "--threads", "2")
            self.expect(0, "info", "run.nc")   # whole, if short
            self.assertEqual([file.name for file in self.folder.iterdir() if file.name.endswith(".tmp")], [])

    def test_chains_stop_at_once(self):
        """Large motions are not checked any more; to write this one takes a second."""
        text = "format = 1\ngravity = [0, 0, -9.81]\n"
        for i in range(60):
            text += (f'[[body]]\nname = "b{i}"\nshape = {{ box = [0.9, 0.1, 0.1] }}\nmass = 1\nposition = [{i + 0.5}, 0, 0]\n'
                     f'[[joint]]\nname = "j{i}"\ntype = "revolute"\nat = [{i}, 0, 0]\naxis = [0, 1, 0]\n'
                     f'between = ["{f"b{i - 1}" if i > 0 else "world"}", "b{i}"]\n')
        self.write("run.toml", text + "[time]\nend = 0.3\nelements = 3000\noutput = 0.01\n")
        whole = self.whole_run("run.toml")
        for part in (0.1, 0.3):
            self.assertStopsAtOnce("run.toml", part * whole)
            self.expect(0, "info", "run.nc")

    def test_what_the_caller_ignores_stays_ignored(self):
        self.write("run.toml", FREE_BODY % (4000, 40000, "false"))
        program = subprocess.Popen([PROGRAM, "solve", "run.toml", "-q"], cwd=self.folder,
                                   preexec_fn=lambda: signal.signal(signal.SIGINT, signal.SIG_IGN))
        while program.poll() is None and cpu_seconds(program.pid) < 0.1:
            time.sleep(0.005)
        program.send_signal(signal.SIGINT)
        self.assertEqual(program.wait(), 0)


@unittest.skipIf(SANITIZED, "the sanitizer needs memory of its own")
class MemoryStated(ProgramTest):
    def test_condition_numbers_are_in_what_check_says(self):
        self.expect_as_said(FREE_BODY % (1000, 10000, "true"))

    def test_conditions_at_both_ends_are_in_what_check_says(self):
        """They take a condition number, whether it is asked for or not, and a second solution another one."""
        for text in (FREE_BODY % (1, 3000, "false"), FREE_BODY.replace('"a"', '"b"') % (1, 2000, "true")):
            self.expect_as_said(text.replace("mass = 1", "mass = 1\nend = { position = [0.1, 0.2, 0] }").replace(
                "angular_velocity = [0.1, 0, 1]\n", "").replace("output = 100", "output = 1").replace(
                    "[time]", '[start]\ngiven = "positions"\n[end]\ngiven = "positions"\n[time]'))

    def test_blocks_of_high_degree_are_in_what_check_says(self):
        self.expect_as_said(SMALL.replace("elements = 10", "elements = 25").replace(
            'family = "lobatto"\ndegree = 4', 'family = "mixed"\ndegree = 8'))

    def expect_as_said(self, text):
        self.write("run.toml", text)
        said = json.loads(self.expect(0, "check", "run.toml", "--json").out)["memory_bytes"]
        program = subprocess.Popen([PROGRAM, "solve", "run.toml", "-q"], cwd=self.folder)
        _, status, used = os.wait4(program.pid, 0)
        program.returncode = os.waitstatus_to_exitcode(status)
        self.assertEqual(program.returncode, 0)
        self.assertLess(1024 * used.ru_maxrss, 1.3 * said)
        self.assertGreater(1024 * used.ru_maxrss, said / 1.3)

    @unittest.skipUnless(hasattr(resource, "prlimit"), "needs Linux")
    def test_memory_that_ends_over_condition_numbers_costs_no_motion(self):
        """It is there when the run begins, and is taken away."""
        self.write("run.toml", FREE_BODY % (2000, 20000, "true"))
        program = subprocess.Popen([PROGRAM, "solve", "run.toml", "-q"], cwd=self.folder, stderr=subprocess.DEVNULL)
        pages = [0, 0]
        while program.poll() is None and pages[1] * resource.getpagesize() < 150e6:
            with open(f"/proc/{program.pid}/statm") as file:
                pages = [int(number) for number in file.read().split()[:2]]
        size = pages[0] * resource.getpagesize()
        resource.prlimit(program.pid, resource.RLIMIT_AS, (size, size))
        self.assertEqual(program.wait(), 0)
        info = self.expect(0, "info", "run.nc").out
        self.assertIn("memory ended before condition numbers were computed", info)
        self.assertEqual(json.loads(self.expect(0, "info", "run.nc", "--json").out)["status"], "converged")


class FoundByCheck(ProgramTest):
    def test_singular_masses_have_a_place(self):
        """Whatever solve would refuse, check finds, with its place."""
        for family in ("midpoint", "endpoint", "mixed"):
            self.write("run.toml", NEEDLE % family)
            for command in ("check", "solve"):
                error = json.loads(self.expect(3, command, "run.toml", "--json").out)["errors"][0]
                self.assertEqual((error["code"], error["file"], error["line"]), ("mass-singular", "run.toml", 3))


if __name__ == "__main__":
    unittest.main()
