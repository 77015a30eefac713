# SPDX-License-Identifier: BSD-3-Clause
"""Files of strangers, and files that must not be lost.

    LIVENS_PROGRAM=build/release/livens python3 strangers_test.py [CLASS ...]
"""
import gzip
import json
import os
import re
import shutil
import struct
import subprocess
import time
import unittest

from program_test import DATA, IO, PROGRAM, SANITIZED, SCENARIO, SMALL, SOURCE, USAGE, ProgramTest, text_with

# With checksums that fit. Today's readers: a second dimension of one name divides by zero or counts up by it for ever,
# a variable of rank 100,000 with names of 400,000 bytes copies 40 GB.
CRAFTED = sorted((DATA / "strangers").glob("*.nc.gz"))
MESH = ('format = 1\n[[body]]\nname = "b"\nshape = { mesh = "bricks.msh", unit = "m" }\ndensity = 1000\n'
        "[time]\nend = 0.1\nelements = 1\n")


def checksum(data):
    """As docs/results.md has it."""
    s = 0xcbf29ce484222325
    for i in range(0, len(data), 8):
        s = (s ^ int.from_bytes(data[i:i + 8].ljust(8, b"\0"), "little")) * 0x100000001b3 % 2**64
        s ^= s >> 29
    return f"{s:016x}".encode()


def with_numbers(file, variable, numbers):
    """A result (CDF-2) with other numbers in a variable; checksums fit."""
    data, at = bytearray(file), 8

    def word():
        nonlocal at
        at += 4
        return int.from_bytes(data[at - 4:at], "big")

    def skip(n):
        nonlocal at
        at += (n + 3) // 4 * 4
        return at - (n + 3) // 4 * 4

    def attributes():
        word()
        found = {}
        for _ in range(word()):
            n = word()
            start = skip(n)
            kind = word()
            found[bytes(data[start:start + n]).decode()] = skip(word() * {2: 1, 4: 4, 6: 8}[kind])
        return found

    word()
    for _ in range(word()):
        skip(word())
        word()
    whole = attributes()["livens_checksum"]
    word()
    places = {}
    for _ in range(word()):
        n = word()
        start = skip(n)
        skip(4 * word())
        sums = attributes()
        word()
        size = word()
        at += 8
        places[bytes(data[start:start + n]).decode()] = (sums["checksum"], size, int.from_bytes(data[at - 8:at], "big"))
    own, size, begin = places[variable]
    assert len(numbers) * 8 == size
    data[begin:begin + size] = struct.pack(f">{len(numbers)}d", *numbers)
    data[own:own + 16] = checksum(data[begin:begin + size])
    data[whole:whole + 16] = b"0" * 16
    data[whole:whole + 16] = checksum(data[:at])
    return bytes(data)


class CraftedResults(ProgramTest):
    """Each ends in exit 6 or 3, in next to no time and memory, in every command."""

    def expect_refused(self, file):
        for arguments in (("info", file), ("info", file, "--json"), ("sample", file, "--body", "a", "--at", "0.1"),
                          ("report", file, "-o", "x.html"), ("view", file, "--address"), ("diff", file, file),
                          ("export", file, "--csv", "x.csv"), ("export", file, "--npz", "x.npz"),
                          ("export", file, "--gltf", "x.glb"), ("export", file, "--pvd", "x.pvd"),
                          ("completion", "bash", "--bodies", file)):
            process = subprocess.Popen([PROGRAM, *arguments], cwd=self.folder, stdout=subprocess.PIPE,
                                       stderr=subprocess.PIPE)
            output = process.stdout.read() + process.stderr.read()
            process.stdout.close()
            process.stderr.close()
            _, status, usage = os.wait4(process.pid, 0)
            process.returncode = os.waitstatus_to_exitcode(status)
            if arguments[0] != "completion":   # which is silent
                self.assertIn(process.returncode, (IO, SCENARIO), (arguments, output))
            self.assertGreaterEqual(process.returncode, 0, arguments)
            if not SANITIZED:
                self.assertLess(usage.ru_utime + usage.ru_stime, 0.1, arguments)
                self.assertLess(usage.ru_maxrss, 50_000, arguments)
        self.assertEqual([name for name in self.files() if name.startswith("x")], [])

    def test_files_by_hand(self):
        self.assertEqual(len(CRAFTED), 4)
        for file in CRAFTED:
            self.write("crafted.nc", gzip.decompress(file.read_bytes()))
            self.expect_refused("crafted.nc")

    def test_instants_that_are_next_to_infinite(self):
        failed = (SOURCE / "tests/fuzz/corpus_results/failed.nc").read_bytes()
        self.write("far.nc", with_numbers(failed, "element_end", [1e308]))
        self.write("failed.nc", with_numbers(failed, "element_end", [0.0]))
        self.expect(0, "info", "far.nc")
        self.expect(0, "diff", "failed.nc", "failed.nc")
        for pair in (("far.nc", "far.nc"), ("far.nc", "failed.nc"), ("failed.nc", "far.nc")):
            self.assertIn(self.run_program("diff", *pair, "--json").returncode, (0, 1, USAGE, IO), pair)
        whole = (SOURCE / "tests/fuzz/corpus_results/midpoint.nc").read_bytes()
        self.write("whole.nc", whole)
        n = json.loads(self.expect(0, "info", "whole.nc", "--json").out)["elements"] + 1
        for ends in ([1e308 * (1 + 1e-10 * i) for i in range(n)], [1e-308 * (i + 1) for i in range(n)],
                     [-1e308 + 1e307 * i for i in range(n)], [0.0] * n, [float("nan")] * n):
            self.write("odd.nc", with_numbers(whole, "element_end", ends))
            for arguments in (("diff", "odd.nc", "odd.nc"), ("diff", "odd.nc", "whole.nc"), ("export", "odd.nc", "--csv", "o.csv"),
                              ("export", "odd.nc", "--gltf", "o.glb"), ("export", "odd.nc", "--pvd", "o.pvd"),
                              ("report", "odd.nc", "-o", "o.html"), ("info", "odd.nc")):
                self.assertIn(self.run_program(*arguments).returncode, (0, 1, USAGE, IO), (ends[:2], arguments))

    def test_a_sparse_file_of_a_terabyte(self):
        self.write("sparse.nc", gzip.decompress(CRAFTED[0].read_bytes()))
        os.truncate(self.folder / "sparse.nc", 1 << 40)
        self.expect_refused("sparse.nc")

    def test_titles_and_names_steer_no_terminal(self):
        marks = "\\u202e\\u2028\\u2066\\u200b\\ufeff\\u0085"
        self.solve(text_with("a brick on a rod", f"a{marks}b"))
        for arguments in (("info", "run.nc"), ("info", "run.nc", "--json"), ("solve", "small.toml", "-o", "run.nc"),
                          ("check", "small.toml", "--json")):
            out = self.expect(0, *arguments).out
            self.assertEqual([c for c in marks.encode().decode("unicode_escape") if c in out], [], arguments)
        self.assertEqual(json.loads(self.expect(0, "info", "run.nc", "--json").out)["title"],
                         f"a{marks}b".encode().decode("unicode_escape"))

    def test_meshes_with_breaks_of_lines_in_their_names(self):
        broken = text_with("bricks.msh", "a\\nmesh 0 1.msh", MESH)
        shutil.copy(SOURCE / "tests/fuzz/corpus/bricks.msh", self.folder / "a\nmesh 0 1.msh")
        self.write("m.toml", broken)
        done = self.expect(SCENARIO, "solve", "m.toml", "--json")
        error = json.loads(done.out)["errors"][0]
        self.assertEqual((error["code"], error["line"]), ("mesh-path", 4))
        self.assertIn("U+000A", error["message"])


class NothingIsLost(ProgramTest):
    """No output replaces an input of its run, or a file that livens did not write, unless it is told to."""

    def setUp(self):
        super().setUp()
        self.solve()
        self.result = (self.folder / "run.nc").read_bytes()

    def expect_kept(self, name, content, *arguments):
        """Refused before anything is solved, with what to do; written by force."""
        self.write(name, content)
        start = time.monotonic()
        done = self.expect(IO, *arguments)
        self.assertLess(time.monotonic() - start, 10)
        self.assertRegex(done.err, re.compile("choose another name.*'?--force'?|another name, or", re.DOTALL))
        self.assertEqual((self.folder / name).read_bytes(), content)
        self.expect(0, *arguments, "--force")
        self.assertNotEqual((self.folder / name).read_bytes(), content)
        self.expect(0, *arguments)   # over what is livens' own now

    def test_results(self):
        for name, content in (("b.toml", SMALL.encode()), ("part.msh", b"$MeshFormat\n"), ("x.nc", b"CDF\1 not of livens"),
                              ("notes", b"x"), ("x.csv", b"a,b\n")):
            self.expect_kept(name, content, "solve", "small.toml", "-o", name)
        self.write("empty.nc", b"")
        self.write("cut.nc", self.result[:5000])   # a run by its content
        for name in ("empty.nc", "cut.nc", "run.nc"):
            self.expect(0, "solve", "small.toml", "-o", name)
            self.assertEqual((self.folder / name).read_bytes(), self.result)

    def test_exports_and_pages(self):
        for option, ending, content in (("--csv", ".csv", b"a,b\n1,2\n"), ("--npz", ".npz", b"PK\3\4\x14\0\0\0\0\0\0\0"),
                                        ("--gltf", ".glb", b"glTF\2\0\0\0 of somebody"),
                                        ("--pvd", ".pvd", b'<?xml version="1.0"?>\n<VTKFile type="Collection">')):
            self.expect_kept("mine" + ending, content, "export", "run.nc", option, "mine" + ending)
        self.expect_kept("mine.html", b"<!doctype html>\n<p>mine", "report", "run.nc", "-o", "mine.html")
        self.expect_kept("two.csv", b"a,b\n", "solve", "small.toml", "-o", "run.nc", "--csv", "two.csv")

    def test_pieces_of_a_list(self):
        self.expect(0, "export", "run.nc", "--pvd", "p.pvd")
        whole = (self.folder / "p" / "p_000003.vtp").read_bytes()
        self.write("p/p_000003.vtp", b"mine")
        before = {path: path.read_bytes() for path in (self.folder / "p").iterdir()}
        self.assertIn("p_000003.vtp", self.expect(IO, "export", "run.nc", "--pvd", "p.pvd").err)
        self.assertEqual({path: path.read_bytes() for path in (self.folder / "p").iterdir()}, before)
        self.expect(0, "export", "run.nc", "--pvd", "p.pvd", "--force")
        self.assertEqual((self.folder / "p" / "p_000003.vtp").read_bytes(), whole)

    def test_inputs_whatever_is_forced(self):
        shutil.copy(SOURCE / "tests/fuzz/corpus/bricks.msh", self.folder / "bricks.msh")
        mesh = (self.folder / "bricks.msh").read_bytes()
        self.write("m.toml", MESH)
        os.symlink("bricks.msh", self.folder / "soft.nc")
        os.link(self.folder / "bricks.msh", self.folder / "hard.nc")
        os.link(self.folder / "m.toml", self.folder / "scenario.nc")
        (self.folder / "sub").mkdir()
        for force in ((), ("--force",)):
            for output in ("bricks.msh", "./bricks.msh", "sub/../bricks.msh", "soft.nc", "hard.nc", "m.toml", "scenario.nc"):
                done = self.expect(IO, "solve", "m.toml", "-o", output, *force)
                self.assertRegex(done.err, "is a mesh of the scenario|is the scenario itself")
            self.expect(IO, "export", "run.nc", "--csv", "run.nc", *force)
            self.expect(IO, "report", "run.nc", "-o", "run.nc.json", *force)
        self.assertEqual((self.folder / "bricks.msh").read_bytes(), mesh)
        self.assertEqual((self.folder / "m.toml").read_text(), MESH)
        # an input of another scenario of the same call
        self.write("sub/small.nc", SMALL)
        self.write("sub/other.toml", SMALL)
        for scenarios in (("small.toml", "sub/small.nc"), ("sub/small.nc", "sub/other.toml")):
            self.expect(IO, "solve", *scenarios, "-o", "sub", "--force")
        self.assertEqual((self.folder / "sub" / "small.nc").read_text(), SMALL)

    def test_files_that_come_while_it_is_solved(self):
        """Neither they nor the motion are lost; older results that come meanwhile are replaced."""
        self.write("long.toml", text_with("elements = 10", "elements = 5000"))
        for force in ((), ("--force",)):
            for content in (b"mine", self.result):
                (self.folder / "long.nc").unlink(missing_ok=True)
                program = subprocess.Popen([PROGRAM, "solve", "long.toml", "-v", *force], cwd=self.folder,
                                           stderr=subprocess.PIPE, stdout=subprocess.DEVNULL)
                read = program.stderr.readline()   # "read and checked the scenario": its place was looked at
                self.assertIn(b"read and checked", read)
                self.write("long.nc", content)
                err = program.communicate(timeout=100)[1].decode()
                if force or content != b"mine":
                    self.assertEqual(program.returncode, 0, err)
                    self.expect(0, "info", "long.nc")
                    self.assertNotEqual((self.folder / "long.nc").read_bytes(), content)
                else:
                    self.assertEqual(program.returncode, IO, err)
                    self.assertIn("the motion is in 'long-1.nc'", err)
                    self.assertEqual((self.folder / "long.nc").read_bytes(), content)
                    self.expect(0, "info", "long-1.nc")
        self.assert_no_temporaries()

    def test_names_that_are_empty(self):
        for arguments in (("solve", "small.toml", "-o", ""), ("solve", "small.toml", "--csv", ""), ("init", ""),
                          ("export", "run.nc", "--csv", ""), ("report", "run.nc", "-o", "")):
            self.assertIn("empty", self.expect(USAGE, *arguments).err)
        self.assertEqual(self.files(), ["run.nc", "run.nc.json", "small.toml"])

    def test_rights_that_are_kept_and_not(self):
        (self.folder / "run.nc").chmod(0o6750)
        self.expect(0, "solve", "small.toml", "-o", "run.nc")
        self.assertEqual((self.folder / "run.nc").stat().st_mode & 0o7777, 0o750)


class Figures(ProgramTest):
    """Numbers that overflow, and places that were missing."""

    def test_mass_beyond_all_numbers(self):
        shutil.copy(SOURCE / "tests/fuzz/corpus/bricks.msh", self.folder)
        for density in ("1e308", "1e-320", "5e-324", "1e307"):
            done = self.run_program("mass", "bricks.msh", "--density", density, "--json")
            found = json.loads(done.out)
            if done.returncode == 0:
                self.assertNotIn("null", done.out)
            else:
                self.assertEqual(done.returncode, USAGE)
                self.assertIn("--density", found["message"])
        self.expect(USAGE, "mass", "bricks.msh", "--density", "1e308")
        self.expect(0, "mass", "bricks.msh", "--density", "7850")

    def test_every_syntax_error_has_a_place(self):
        for text, line, column in (("r=[}", 1, 4), ("format = 1\nr=[}\n", 2, 4), ("[[[a", 1, 3), ("", 1, 1), ("\n \n", 1, 1),
                                   ("a = [1,\u0085 2]", 1, 8), ("x = 1\na = [\u2028]", 2, 6), ("a = {]", 1, 6),
                                   ("\n" * 400 + "a = 1 # a comment\nr=[}", 402, 4)):
            self.write("bad.toml", text)
            error = json.loads(self.expect(SCENARIO, "check", "bad.toml", "--json").out)["errors"][0]
            self.assertEqual((error["line"], error["column"]), (line, column), (text[-20:], error))
            self.assertNotIn("cannot explain", error["message"])


if __name__ == "__main__":
    unittest.main(verbosity=1)
