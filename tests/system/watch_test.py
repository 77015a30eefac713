# SPDX-License-Identifier: BSD-3-Clause
"""`livens view --watch`: what it tells a page when its files are saved, one way or another, and what it tells nobody.

    LIVENS_PROGRAM=build/release/livens python3 watch_test.py [CLASS ...]

report/test/live.mjs looks at the page itself.
"""
import json
import re
import select
import signal
import socket
import subprocess
import time
import unittest
import urllib.parse

from program_test import IO, LONG, PROGRAM, SMALL, SOURCE, USAGE, ProgramTest

PATIENCE = 120   # s, on a machine that does much else


class Follower:
    """What a page hears: events of the server."""

    def __init__(self, address, number=0, path=None, host=None):
        parts = urllib.parse.urlsplit(address)
        self.socket = socket.create_connection(("127.0.0.1", parts.port), timeout=PATIENCE)
        target = path or f"{parts.path}events?{number}"
        self.socket.sendall(f"GET {target} HTTP/1.1\r\nHost: {host or parts.netloc}\r\n\r\n".encode())
        self.stream = self.socket.makefile("rb")
        self.head = b""
        while not self.head.endswith(b"\r\n\r\n"):
            self.head += self.stream.readline()

    def hear(self, *kinds):
        """The next event, or the next of these kinds, as (kind, data)."""
        while True:
            lines = []
            while (line := self.stream.readline()) not in (b"\n", b""):
                lines.append(line.decode().rstrip("\n"))
            assert lines, "the server has hung up"
            kind = lines[0].removeprefix("event: ")
            data = json.loads("\n".join(line.removeprefix("data: ") for line in lines[1:]))
            if not kinds or kind in kinds:
                return kind, data

    def close(self):
        self.stream.close()
        self.socket.close()


class Watching(ProgramTest):
    def serve(self, name="small.toml", *arguments):
        self.errors = open(self.folder / "told", "w+", encoding="utf-8")
        self.addCleanup(self.errors.close)
        process = subprocess.Popen([PROGRAM, "view", "--watch", name, "--address", *arguments], cwd=self.folder, text=True,
                                   stdout=subprocess.PIPE, stderr=self.errors)
        self.addCleanup(process.communicate)
        self.addCleanup(process.kill)
        self.assertTrue(select.select([process.stdout], [], [], PATIENCE)[0], "no address")
        return process, process.stdout.readline().strip()

    def follow(self, address, number=0):
        follower = Follower(address, number)
        self.addCleanup(follower.close)
        return follower

    def begin(self, text=SMALL):
        """A scenario that is watched, and a page that has seen it."""
        self.write("small.toml", text)
        process, address = self.serve()
        follower = self.follow(address)
        kind, data = follower.hear("run", "fault")
        return process, address, follower, kind, data

    def test_what_is_saved_is_told(self):
        process, address, follower, kind, first = self.begin()
        self.assertEqual((kind, first["run"]["status"], first["file"], first["said"]), ("run", "converged", "small.toml", ""))
        self.write("small.toml", SMALL.replace("position = [1, 0, 0]", "position = [2, 0, 0]"))
        kind, second = follower.hear("run", "fault")
        self.assertEqual(kind, "run")
        self.assertGreater(second["number"], first["number"])
        self.assertIn("position = [2, 0, 0]", second["run"]["scenario"])
        self.assertNotEqual(second["numbers"], first["numbers"])
        late = self.follow(address, second["number"] - 1)   # a page that was loaded before
        self.assertEqual(late.hear("run")[1]["number"], second["number"])
        process.send_signal(signal.SIGINT)
        self.assertEqual(process.wait(PATIENCE), 0)
        self.assertEqual(len(re.findall(r"Converged: good to \d+ digits", (self.folder / "told").read_text())), 2)

    def test_errors_are_told_and_the_mend(self):
        _, address, follower, _, first = self.begin()
        self.write("small.toml", SMALL.replace("density", "densty"))
        kind, fault = follower.hear("run", "fault")
        self.assertEqual((kind, fault["file"]), ("fault", "small.toml"))
        self.assertRegex(fault["said"], r"small\.toml:8:1.*\n(.*\n)*.*densty(.*\n)*.*'density'")
        self.assertNotIn("\x1b", fault["said"])
        self.assertIn("'density'", (self.folder / "told").read_text(), "on the terminal, too")
        page = Follower(address, path=urllib.parse.urlsplit(address).path)   # as a page that is loaded now has it
        text = page.stream.read().decode()
        page.close()
        self.assertIn(f'"live":{first["number"]}' + "}", text, "the last run that was right")
        self.write("small.toml", SMALL)
        self.assertEqual(follower.hear("run", "fault")[0], "run")

    def test_a_beginning_that_is_wrong(self):
        _, _, follower, kind, fault = self.begin("format = 1\nnonsense = 2\n")
        self.assertEqual(kind, "fault")
        self.assertIn("nonsense", fault["said"])
        self.write("small.toml", SMALL)
        self.assertEqual(follower.hear("run", "fault")[0], "run")

    def test_editors_that_save_by_rename_or_leave_a_gap(self):
        _, _, follower, _, _ = self.begin()
        other = SMALL.replace("angular_velocity = [0, 0, 2]", "angular_velocity = [0, 0, 3]")
        self.write("small.toml~", other)
        (self.folder / "small.toml~").rename(self.folder / "small.toml")
        kind, data = follower.hear("run", "fault")
        self.assertEqual((kind, "0, 0, 3" in data["run"]["scenario"]), ("run", True))
        (self.folder / "small.toml").rename(self.folder / "away")
        time.sleep(0.3)   # less than it waits for a file that is gone
        self.write("small.toml", SMALL)
        kind, data = follower.hear("run", "fault")
        self.assertEqual((kind, "0, 0, 2" in data["run"]["scenario"]), ("run", True))
        (self.folder / "small.toml").unlink()   # the control: a file that does not come back is told
        kind, data = follower.hear("run", "fault")
        self.assertEqual((kind, "no such file" in data["said"]), ("fault", True))
        self.write("small.toml", SMALL)
        self.assertEqual(follower.hear("run", "fault")[0], "run")

    def test_many_saves_are_few_solutions(self):
        _, _, follower, _, first = self.begin()
        for k in range(40):
            self.write("small.toml", SMALL.replace("[0, 0, 2]", f"[0, 0, {3 + k}]"))
            time.sleep(0.005)
        n = 0
        while "[0, 0, 42]" not in (data := follower.hear("run")[1])["run"]["scenario"]:
            n += 1
        self.assertLess(n, 20)
        self.assertGreater(data["number"], first["number"])

    def test_a_long_solution_is_broken_off(self):
        _, _, follower, _, _ = self.begin()
        self.write("small.toml", LONG)
        self.assertEqual(follower.hear()[0], "solving")
        self.write("small.toml", SMALL)
        kind, data = follower.hear("run", "fault")
        self.assertEqual(kind, "run", data["said"])
        self.assertEqual(data["run"]["end"], 0.5)

    def test_ends_while_it_solves(self):
        self.write("small.toml", LONG)
        process, address = self.serve()
        self.assertEqual(self.follow(address).hear()[0], "solving")
        process.send_signal(signal.SIGTERM)
        self.assertEqual(process.wait(PATIENCE), 0)

    def test_meshes_are_watched(self):
        bracket = SOURCE / "tests/unit/geometry/data/bracket.stl"
        text = SMALL.replace("shape = { box = [0.3, 0.2, 0.1] }", 'shape = { mesh = "part.stl", unit = "mm" }')
        _, _, follower, kind, fault = self.begin(text)
        self.assertEqual((kind, "part.stl" in fault["said"]), ("fault", True), "a mesh that is not there yet")
        (self.folder / "part.stl").write_bytes(bracket.read_bytes())
        kind, data = follower.hear("run", "fault")
        self.assertEqual(kind, "run", data["said"])

    def test_nobody_else_hears(self):
        _, address, _, _, _ = self.begin()
        parts = urllib.parse.urlsplit(address)
        for path, host in (("/events?0", None), (parts.path + "events", None), (None, "evil.example"), (parts.path + "other", None)):
            stranger = Follower(address, path=path, host=host)
            self.assertIn(b" 404 ", stranger.head, (path, host))
            stranger.close()
        self.assertIn(b" 200 ", self.follow(address).head, "the control")

    def test_who_hears_nothing_blocks_nobody(self):
        _, address, follower, _, _ = self.begin()
        deaf = [self.follow(address) for _ in range(3)]
        for k in range(5):
            self.write("small.toml", SMALL.replace("[0, 0, 2]", f"[0, 0, {5 + k}]"))
            while f"[0, 0, {5 + k}]" not in follower.hear("run")[1]["run"]["scenario"]:
                pass
        for one in deaf:   # the newest is there in the end
            while "[0, 0, 9]" not in one.hear("run")[1]["run"]["scenario"]:
                pass

    def test_usage(self):
        self.write("small.toml", SMALL)
        self.expect(IO, "view", "--watch", "missing.toml", "--address")
        self.expect(USAGE, "view")
        self.expect(USAGE, "view", "run.nc", "--watch", "small.toml")
        self.assertIn("livens view --watch small.toml", self.expect(USAGE, "view", "small.toml").err)


if __name__ == "__main__":
    unittest.main()
