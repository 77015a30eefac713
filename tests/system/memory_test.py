# SPDX-License-Identifier: BSD-3-Clause
"""Memory that ends: single allocations that fail, and all from one on, at instants over the whole of a command.

    LIVENS_PROGRAM=build/release/livens python3 memory_test.py [CLASS ...]

hard_ends.py tries more of them.
"""
import os
import pathlib
import random
import shutil
import unittest

from program_test import PROGRAM, RESOURCES, SANITIZED, SMALL, SOURCE, SUSPECT, ProgramTest, text_with
from strangers_test import MESH

FAILING = pathlib.Path(PROGRAM).resolve().parent / "tests/failing_allocations.so"   # failing_allocations.cpp
LINKAGE = "tests/fuzz/corpus/every_key_of_mechanisms.toml"   # joints that share what they hold, and events


@unittest.skipIf(SANITIZED, "the sanitizer has allocations of its own")
@unittest.skipUnless(FAILING.exists(), "needs glibc")
class FailingAllocations(ProgramTest):
    """An exit code that is documented, never a signal; an older result, or a whole new one; words of memory."""

    def setUp(self):
        super().setUp()
        for name in ("tests/fuzz/corpus/bricks.msh", LINKAGE):
            shutil.copy(SOURCE / name, self.folder)
        self.write("small.toml", SMALL)
        self.write("steps.toml", text_with('"lobatto"\ndegree = 4', '"midpoint"'))
        self.write("mesh.toml", MESH + "[method]\ncondition = true\n")
        self.expect(0, "solve", "mesh.toml", "-q", "-o", "mesh.nc")
        self.expect(0, "solve", "small.toml", "-q", "-o", "done.nc")

    def run_failing(self, arguments, at, on):
        return self.run_program(*arguments, env={**os.environ, "LD_PRELOAD": str(FAILING), "LIVENS_FAIL_AT": str(at),
                                                 "LIVENS_FAIL_ON": str(on)})

    def count(self, arguments):
        done = self.run_program(*arguments, env={**os.environ, "LD_PRELOAD": str(FAILING),
                                                 "LIVENS_FAIL_COUNT": str(self.folder / "count")})
        n = int((self.folder / "count").read_text())
        self.assertGreater(n, 1000)
        return n, done.returncode

    def try_all(self, arguments, tries, output=None, is_noted=False):
        """`tries` places in each of both ways. `is_noted`: what is not known for want of memory stands in a note."""
        n, code = self.count(arguments)
        whole = (self.folder / output).read_bytes() if output else b""
        old = whole[:len(whole) * 3 // 4]   # a run that was cut off, which may be replaced
        dice, seen = random.Random(str(arguments)), {}
        for on in (0, 1):
            for at in dice.sample(range(1, n + 1), min(tries, n)):
                if output:
                    (self.folder / output).write_bytes(old)
                done = self.run_failing(arguments, at, on)
                what = f"{arguments}, allocation {at} of {n}{' and all behind' if on else ''}: {done.err}"
                self.assertIn(done.returncode, {0, RESOURCES, SUSPECT, code}, what)
                if done.returncode != code:
                    self.assertIn("memory", done.err, what)
                self.assertEqual([f for f in self.files() if f.endswith(".tmp")], [], what)
                seen[done.returncode] = seen.get(done.returncode, 0) + 1
                if not output:
                    continue
                now = (self.folder / output).read_bytes()
                if done.returncode == RESOURCES:
                    self.assertIn(now, (old, whole), what)
                elif done.returncode == code and not is_noted:
                    self.assertEqual(now, whole, what)
                elif now != whole:
                    self.assertIn(b"memory ended", now, what)
        self.assertGreater(seen[RESOURCES], tries / 2)
        return seen

    def try_commands(self, tries):
        for scenario, is_noted in (("small.toml", False), ("mesh.toml", True), ("steps.toml", False),
                                   (pathlib.Path(LINKAGE).name, False)):
            yield scenario, self.try_all(("solve", scenario, "-q", "-o", "run.nc"), tries, "run.nc", is_noted)
        for arguments in (("check", "small.toml"), ("info", "done.nc"), ("diff", "done.nc", "mesh.nc"),
                          ("sample", "done.nc", "--body", "bob", "--at", "0.1"),
                          ("sample", "mesh.nc", "--body", "b", "--at", "0.05"), ("mass", "bricks.msh", "--turn"),
                          ("equilibrium", pathlib.Path(LINKAGE).name), ("modes", "small.toml")):
            yield arguments[0], self.try_all(arguments, tries)
        for arguments in (("report", "done.nc", "-o", "r.html"), ("export", "done.nc", "--csv", "r.csv"),
                          ("export", "done.nc", "--npz", "r.npz"), ("export", "done.nc", "--pvd", "r.pvd")):
            yield arguments[0], self.try_all((*arguments, "--force"), tries, arguments[-1])

    def test_every_command(self):
        for _ in self.try_commands(8):
            pass

    def test_of_joints_that_share_what_they_hold(self):
        """Behind the last element, where reactions are made unique: a matrix that was freed twice."""
        arguments = ("equilibrium", pathlib.Path(LINKAGE).name)
        n, _ = self.count(arguments)
        for at in range(n - 1800, n - 1600, 7):
            self.assertEqual(self.run_failing(arguments, at, 0).returncode, RESOURCES, at)

    def test_of_a_basis_that_is_made_once(self):
        """What is thrown out of std::call_once ends the program where the unwinder cannot be loaded."""
        arguments = ("sample", "mesh.nc", "--body", "b", "--at", "0.05")
        n, _ = self.count(arguments)
        for at in range(n - 400, n, 12):
            self.assertEqual(self.run_failing(arguments, at, 1).returncode, RESOURCES, at)


if __name__ == "__main__":
    unittest.main()
