# SPDX-License-Identifier: BSD-3-Clause
"""Hard ends: whatever stops a run, there is the old result or the new one, and an exit code that is documented.

    LIVENS_PROGRAM=build/release/livens python3 hard_ends.py [--long] [CLASS ...]

The short form belongs to the slow tests. --long takes minutes and prints what it saw: 216 kills, limits in finer steps.
"""
import collections
import json
import os
import pathlib
import random
import re
import resource
import shutil
import subprocess
import sys
import time
import unittest

import memory_test
from program_test import IO, PROGRAM, RESOURCES, SANITIZED, SMALL, ProgramTest

LONG_FORM = "--long" in sys.argv
MIB = 1 << 20
# Writing takes as long as solving: every element end is an output time.
SCENARIO = SMALL.replace("elements = 10", "elements = 3000").replace("output = 0.1\n", "").replace(
    "degree = 4", 'degree = 2\nestimate = "none"')
ONE_BODY = """format = 1
[[body]]
name = "box"
shape = { box = [0.3, 0.2, 0.1] }
density = 1000
angular_velocity = [0.1, 2, 0.1]
[time]
end = %d
elements = %d
output = %d
[method]
degree = 1
estimate = "none"
"""


# X, P, X' and X'' on both sides, an element end and a count of iterations.
MOTION_BYTES = 61.5 * 8


def one_body(n):
    return ONE_BODY % (n // 1000, n, n // 1000)


def limited(**limits):
    """For preexec_fn: limits in bytes, hard ones too."""
    def set_limits():
        for name, value in limits.items():
            resource.setrlimit(getattr(resource, "RLIMIT_" + name), (value, value))
    return set_limits


def say(text):
    if LONG_FORM:
        print("   ", text, flush=True)


def counts(seen):
    return ", ".join(f"{key}: {n}" for key, n in sorted(seen.items(), key=str))


class HardTest(ProgramTest):
    """An old result, run.nc, and a scenario whose result is another one."""

    def setUp(self):
        super().setUp()
        self.write("old.toml", SCENARIO)
        self.write("new.toml", SCENARIO.replace("[1, 0, 0]", "[2, 0, 0]"))
        self.old = self.result_of("old.toml")
        self.new = self.result_of("new.toml")
        self.assertNotEqual(self.old, self.new)

    def result_of(self, scenario, into="run.nc"):
        self.expect(0, "solve", scenario, "-o", into, "-q")
        data = (self.folder / into).read_bytes()
        (self.folder / into).unlink()
        (self.folder / (into + ".json")).unlink()
        return data

    def put_old(self, path=None):
        (path or self.folder / "run.nc").write_bytes(self.old)

    def now(self, path=None):
        """'old' or 'new': anything else is a failure."""
        found = (path or self.folder / "run.nc").read_bytes()
        self.assertIn(found, (self.old, self.new), f"{len(found)} bytes: neither the old result nor the new one")
        return "old" if found == self.old else "new"

    def temporaries(self, folder=None):
        return [p.name for p in (folder or self.folder).iterdir() if p.name.endswith(".tmp")]


class Kills(HardTest):
    def test_kill_leaves_old_or_new(self):
        begin = time.monotonic()
        self.result_of("new.toml")
        whole = time.monotonic() - begin
        (self.folder / "new.nc").write_bytes(self.new)
        self.expect(0, "export", "new.nc", "--csv", "whole.csv")
        whole_csv = (self.folder / "whole.csv").read_bytes()
        dice = random.Random(8)
        seen, left = collections.Counter(), 0
        for _ in range(216 if LONG_FORM else 40):
            self.put_old()
            program = subprocess.Popen([PROGRAM, "solve", "new.toml", "-o", "run.nc", "--csv", "run.csv", "-q"],
                                       cwd=self.folder, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
            time.sleep(whole * dice.uniform(0, 1.5))
            program.kill()
            program.wait()
            # The record is the old one, the new one or not there yet; never half of one.
            record = self.folder / "run.nc.json"
            if record.exists():
                json.loads(record.read_text())
            csv = self.folder / "run.csv"
            if csv.exists():
                self.assertEqual(csv.read_bytes(), whole_csv, "half of a table")
                csv.unlink()
            left += len(self.temporaries())
            seen[self.now()] += 1
            self.expect(0, "info", "run.nc")
        say(f"kills: {counts(seen)}; temporaries left by them at the time: {left}")
        self.expect(0, "solve", "new.toml", "-o", "run.nc", "-q")
        self.assertEqual((self.now(), self.temporaries()), ("new", []))
        self.assertEqual(len(seen), 2, "all kills came too early, or too late")


class Limits(HardTest):
    def try_at(self, seen, limit, **limits):
        """Runs under a limit: done, or a coded refusal that leaves everything as it was."""
        self.put_old()
        done = self.run_program("solve", "new.toml", "-o", "run.nc", "--json", preexec_fn=limited(**limits))
        self.assertIn(done.returncode, (0, IO, RESOURCES), f"limit {limit}: {done.err}")
        self.assertEqual(self.now(), "new" if done.returncode == 0 else "old", f"limit {limit}")
        self.assertEqual(self.temporaries(), [], f"limit {limit}")
        if done.returncode != 0:
            # Below some limit not even the loader starts a program; that is not ours to word.
            if done.out:
                error = json.loads(done.out)["errors"][0]
                self.assertEqual(error["code"], {IO: "io", RESOURCES: "resource-limit"}[done.returncode], error)
            else:
                self.assertEqual(done.returncode, IO)
                self.assertIn("livens: ", done.err)
        seen[done.returncode] += 1
        return done.returncode

    def test_file_size(self):
        n = 200 if LONG_FORM else 12
        seen = collections.Counter()
        with_room = 0
        for k in range(n + 1):
            limit = len(self.new) * k // n
            code = self.try_at(seen, limit, FSIZE=limit)
            self.assertEqual(code, 0 if limit >= len(self.new) else IO, f"limit {limit}")
            with_room += code == 0
        self.assertEqual(with_room, 1)
        say(f"file size limits from 0 to {len(self.new)} bytes: exits {counts(seen)}")

    def test_memory(self):
        if SANITIZED:
            self.skipTest("the sanitizer needs address space of its own")
        needed, seen = self.least_memory(), collections.Counter()
        n = 150 if LONG_FORM else 15
        for k in range(n + 1):
            limit = needed + (24 * MIB * k) // n
            self.try_at(seen, limit, AS=limit)
        self.assertGreater(min(seen[0], seen[RESOURCES]), 0, seen)
        say(f"address space from {needed / MIB:.1f} to {needed / MIB + 24:.1f} MiB: exits {counts(seen)}")

    def least_memory(self):
        """With which the program starts at all."""
        low, high = MIB, 64 * MIB
        while high - low > MIB // 8:
            middle = (low + high) // 2
            starts = self.run_program("version", preexec_fn=limited(AS=middle)).returncode == 0
            low, high = (low, middle) if starts else (middle, high)
        return high

    def test_a_solved_motion_is_not_lost(self):
        """A motion of 192 MB under 400 MB; and from too little memory to enough: refused at once, or written."""
        if SANITIZED:
            self.skipTest("the sanitizer needs address space of its own")
        n = 390_000 if LONG_FORM else 39_000
        self.write("new.toml", one_body(n))
        self.expect(0, "solve", "new.toml", "-o", "run.nc", "-q",
                    preexec_fn=limited(AS=400_000_000 if LONG_FORM else 64 * MIB))
        self.new = (self.folder / "run.nc").read_bytes()
        # What check says is enough, and from there on all runs are written.
        motion, base = MOTION_BYTES * n, self.least_memory() + 12 * MIB
        seen = collections.Counter()
        steps = 40 if LONG_FORM else 10
        for k in range(steps + 1):
            limit = int(base + motion * (0.5 + 0.8 * k / steps))
            code = self.try_at(seen, limit, AS=limit)
        self.assertEqual(code, 0)
        self.assertGreater(seen[RESOURCES], 0)
        say(f"motion of {motion / 1e6:.0f} MB, {(base + motion / 2) / MIB:.0f} to {(base + 1.3 * motion) / MIB:.0f} MiB: "
            f"exits {counts(seen)}")

    def test_the_peak_is_little_more_than_the_motion(self):
        if SANITIZED:
            self.skipTest("the sanitizer needs memory of its own")
        n = 1_000_000 if LONG_FORM else 200_000
        motion = MOTION_BYTES * n
        for estimate in ("none", "second"):
            self.write("new.toml", one_body(n).replace('"none"', f'"{estimate}"'))
            program = subprocess.Popen([PROGRAM, "solve", "new.toml", "-o", "run.nc", "-v"], cwd=self.folder,
                                       stdout=subprocess.DEVNULL, stderr=subprocess.PIPE)
            log = program.stderr.read().decode()
            _, status, used = os.wait4(program.pid, 0)
            program.returncode = os.waitstatus_to_exitcode(status)
            program.stderr.close()
            self.assertEqual(program.returncode, 0, log)
            peak, size = 1024 * used.ru_maxrss, (self.folder / "run.nc").stat().st_size
            self.assertGreater(peak, motion)
            self.assertLess(peak, 1.3 * motion + 8e6)
            said = json.loads(self.expect(0, "check", "new.toml", "--json").out)["memory_bytes"]
            self.assertLess(abs(said - peak), 0.15 * peak + 8e6, "what check says is not what was taken")
            written = float(re.search(r"written in ([\d.e-]+) s", log).group(1)) if "written in" in log else 0
            say(f"{n} elements, estimate {estimate}: motion {motion / 1e6:.0f} MB, peak {peak / 1e6:.0f} MB "
                f"({peak / motion:.2f}), file {size / 1e6:.0f} MB written in {written:.2f} s"
                f" ({size / 1e6 / max(written, 1e-9):.0f} MB/s); plain writing: {self.plain_rate(size):.0f} MB/s")

    def plain_rate(self, size):
        begin = time.monotonic()
        with open(self.folder / "plain", "wb") as file:
            for _ in range(size // MIB):
                file.write(bytes(MIB))
            file.flush()
            os.fsync(file.fileno())
        return size / 1e6 / (time.monotonic() - begin)


class Allocations(HardTest):
    def test_more_places(self):
        if SANITIZED or not memory_test.FAILING.exists():
            self.skipTest("needs glibc, and allocations without a sanitizer")
        tries = memory_test.FailingAllocations()
        tries.setUp()
        self.addCleanup(tries.doCleanups)
        for what, seen in tries.try_commands(1000 if LONG_FORM else 50):
            say(f"allocations that fail, {what}: exits {counts(seen)}")


class Disks(HardTest):
    def mounted(self, *options):
        disk = self.folder / "disk"
        disk.mkdir(exist_ok=True)
        try:
            done = subprocess.run(["mount", *options, disk], stderr=subprocess.DEVNULL)
        except OSError:
            done = None
        if done is None or done.returncode != 0:
            self.skipTest("mounting is not permitted here; the limits of file size cover the program's part")
        self.addCleanup(lambda: subprocess.run(["umount", disk], stderr=subprocess.DEVNULL))
        return disk

    def test_full_disk(self):
        seen = collections.Counter()
        steps = 24 if LONG_FORM else 5
        for k in range(steps):
            # Room for the old result and a part of the new one; in the last step for both.
            room = len(self.old) + int(len(self.new) * (k + 0.1) / (steps - 1.1)) + 32768
            disk = self.mounted("-t", "tmpfs", "-o", f"size={room // 4096 * 4096}", "tmpfs")
            self.put_old(disk / "run.nc")
            done = self.run_program("solve", "new.toml", "-o", "disk/run.nc", "--json")
            self.assertIn(done.returncode, (0, IO), done.err)
            if done.returncode == IO:
                self.assertIn("No space left on device", json.loads(done.out)["errors"][0]["message"])
            self.assertEqual(self.now(disk / "run.nc"), "new" if done.returncode == 0 else "old")
            self.assertEqual(self.temporaries(disk), [])
            seen[done.returncode] += 1
            subprocess.run(["umount", disk], check=True)
        self.assertGreater(min(seen[0], seen[IO]), 0, seen)
        say(f"full disks: exits {counts(seen)}")

    def test_read_only_disk(self):
        disk = self.mounted("-t", "tmpfs", "-o", "size=64m", "tmpfs")
        self.put_old(disk / "run.nc")
        subprocess.run(["mount", "-o", "remount,ro", disk], check=True)
        done = self.expect(IO, "solve", "new.toml", "-o", "disk/run.nc", "--json")
        self.assertIn("Read-only file system", json.loads(done.out)["errors"][0]["message"])
        self.assertEqual(self.now(disk / "run.nc"), "old")

    def test_read_only_folder(self):
        options = {}
        if os.geteuid() == 0:   # root may write everywhere: become nobody
            options["preexec_fn"] = lambda: os.setuid(65534)
            if subprocess.run(["true"], **options).returncode != 0:
                self.skipTest("cannot become another user")
        self.put_old()
        before = self.files()
        self.folder.chmod(0o555)
        self.addCleanup(self.folder.chmod, 0o755)
        try:
            for output in ("run.nc", "another.nc"):
                done = self.expect(IO, "solve", "new.toml", "-o", output, "--json", **options)
                self.assertIn("ermission", json.loads(done.out)["errors"][0]["message"])
        except PermissionError:
            self.skipTest("another user cannot run the program where it lies")
        self.assertEqual((self.now(), self.files()), ("old", before))


class Pipes(HardTest):
    def commands(self):
        self.put_old()
        return (("solve", "new.toml", "-o", "run.nc", "--json"), ("solve", "new.toml", "-o", "run.nc"),
                ("check", "new.toml"), ("equilibrium", "new.toml"), ("modes", "new.toml"), ("info", "run.nc"), ("schema",), ("schema", "--json"), ("explain",),
                ("sample", "run.nc", "--body", "bob", "--at", "0"), ("diff", "run.nc", "run.nc"), ("man",),
                ("completion", "bash"), ("version",), ("--help",))

    def test_broken_pipes(self):
        """Nobody reads: an exit code, not a signal; and the result is safe."""
        for command in self.commands():
            reading, writing = os.pipe()
            os.close(reading)
            with os.fdopen(writing, "wb") as pipe:
                done = self.expect(IO, *command, stdout=pipe)
            self.assertIn("standard output", done.err)
            self.now()

    def test_pipes_that_break_on_the_way(self):
        for command in self.commands():
            program = subprocess.Popen([PROGRAM, *command], cwd=self.folder, stdout=subprocess.PIPE,
                                       stderr=subprocess.PIPE)
            program.stdout.read(1)
            program.stdout.close()
            program.stderr.read()
            self.assertIn(program.wait(timeout=60), (0, IO), command)
            program.stderr.close()
            self.now()

    def test_closed_streams(self):
        for closed in ((0,), (1,), (2,), (0, 1), (0, 1, 2)):
            def close(closed=closed):
                for number in closed:
                    os.close(number)
            for command in self.commands():
                done = subprocess.run([PROGRAM, *command], cwd=self.folder, preexec_fn=close,
                                      stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.PIPE)
                self.assertEqual(done.returncode, IO if 1 in closed else 0, (closed, command, done.stderr))
                self.now()


class Names(HardTest):
    def test_four_writers(self):
        seen = collections.Counter()
        for _ in range(30 if LONG_FORM else 5):
            writers = [subprocess.Popen([PROGRAM, "solve", name, "-o", "run.nc", "-q"], cwd=self.folder,
                                        stderr=subprocess.PIPE)
                       for name in ("old.toml", "new.toml", "old.toml", "new.toml")]
            for writer in writers:
                _, err = writer.communicate(timeout=60)
                self.assertEqual((writer.returncode, err), (0, b""))
            seen[self.now()] += 1
            self.assertEqual(self.temporaries(), [])
            json.loads((self.folder / "run.nc.json").read_text())
        say(f"four writers to one name: {counts(seen)}")

    def test_symbolic_links(self):
        elsewhere = self.folder / "elsewhere"
        elsewhere.mkdir()
        for target in (elsewhere / "target.nc", pathlib.Path("elsewhere/target.nc")):
            (self.folder / "run.nc").symlink_to(target)
            for is_there in (False, True):   # a link to nothing yet is a place, too
                if is_there:
                    self.put_old(elsewhere / "target.nc")
                self.expect(0, "solve", "new.toml", "-o", "run.nc", "-q")
                self.assertTrue((self.folder / "run.nc").is_symlink())
                self.assertEqual(self.now(elsewhere / "target.nc"), "new")
            self.assertEqual(self.temporaries() + self.temporaries(elsewhere), [])
            (self.folder / "run.nc").unlink()
            (elsewhere / "target.nc").unlink()
        (self.folder / "run.nc").symlink_to("again.nc")
        (self.folder / "again.nc").symlink_to("run.nc")
        self.expect(IO, "solve", "new.toml", "-o", "run.nc", "-q")
        (self.folder / "far.nc").symlink_to("missing/run.nc")
        self.expect(IO, "solve", "new.toml", "-o", "far.nc", "-q")

    def test_hard_links(self):
        """The name is replaced; what else the old file is called stays the old result."""
        self.put_old()
        os.link(self.folder / "run.nc", self.folder / "kept.nc")
        self.expect(0, "solve", "new.toml", "-o", "run.nc", "-q")
        self.assertEqual((self.now(), self.now(self.folder / "kept.nc")), ("new", "old"))


if __name__ == "__main__":
    sys.argv = [argument for argument in sys.argv if argument != "--long"]
    sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent))
    unittest.main(verbosity=2 if LONG_FORM else 1)
