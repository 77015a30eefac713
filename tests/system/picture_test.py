# SPDX-License-Identifier: BSD-3-Clause
"""`livens export` of stills and videos, by the browser that is on the machine; read back without any code of livens.

    LIVENS_PROGRAM=build/release/livens python3 picture_test.py [CLASS ...]

Skipped where no Chromium is found, but for what is said then.
"""
import os
import pathlib
import re
import shutil
import signal
import struct
import subprocess
import time
import unittest
import zlib

from program_test import IO, PROGRAM, USAGE, ProgramTest

NAMES = ("chromium", "chromium-browser", "google-chrome", "google-chrome-stable")
HAS_BROWSER = "CHROMIUM" in os.environ or any(shutil.which(name) for name in NAMES)


def png(data):
    """Width, height and all bytes of the pixels."""
    assert data[:8] == b"\x89PNG\r\n\x1a\n"
    at, packed, kinds = 8, b"", []
    while at < len(data):
        size, kind = struct.unpack_from(">I4s", data, at)
        body = data[at + 8:at + 8 + size]
        assert zlib.crc32(kind + body) == struct.unpack_from(">I", data, at + 8 + size)[0], kind
        kinds.append(kind)
        if kind == b"IHDR":
            width, height, depth, colours = struct.unpack_from(">IIBB", body)
        if kind == b"IDAT":
            packed += body
        at += size + 12
    assert depth == 8 and b"tEXt" in kinds and kinds[-1] == b"IEND"
    return width, height, unfiltered(zlib.decompress(packed), width * {2: 3, 6: 4}[colours], {2: 3, 6: 4}[colours])


def unfiltered(rows, stride, step):
    """[PNG, section 9]"""
    before, pixels = bytes(stride), bytearray()
    for first in range(0, len(rows), stride + 1):
        kind, line = rows[first], bytearray(rows[first + 1:first + 1 + stride])
        for i in range(stride):
            a, b, c = (line[i - step], before[i], before[i - step]) if i >= step else (0, before[i], 0)
            nearest = min((abs(b - c), 0, a), (abs(a - c), 1, b), (abs(a + b - 2 * c), 2, c))[2]
            line[i] = line[i] + (0, a, b, (a + b) // 2, nearest)[kind] & 255
        pixels += line
        before = line
    return pixels


def element(data, identity):
    """The content of the first element of EBML of this kind, whose length has eight bytes as the page writes it."""
    at = data.index(identity + b"\x01") + len(identity)
    size = int.from_bytes(data[at + 1:at + 8], "big")
    return data[at + 8:at + 8 + size]


def gif_frames(data):
    """Delays of the frames, s."""
    return [struct.unpack("<H", delay)[0] / 100 for delay in re.findall(rb"\x21\xf9\x04.(..)[\x00-\xff]\x00\x2c", data, re.S)]


class WithoutABrowser(ProgramTest):
    def setUp(self):
        super().setUp()
        self.solve()

    def test_no_browser(self):
        for variables in ({"PATH": str(self.folder), "CHROMIUM": ""}, {"CHROMIUM": "/nonexistent/chromium"}):
            done = subprocess.run([str(pathlib.Path(PROGRAM).resolve()), "export", "run.nc", "-o", "a.png"], cwd=self.folder,
                                  env={**os.environ, **variables}, capture_output=True, text=True, check=False)
            self.assertEqual(done.returncode, IO, done.stderr)
            self.assertRegex(done.stderr, r"(?s)install Chromium.*livens view RUN\.nc.*Save")
            self.assertNotIn("a.png", self.files())
        broken = self.write("broken", "#!/bin/sh\necho it cannot >&2\nexit 1\n")
        broken.chmod(0o755)
        done = subprocess.run([str(pathlib.Path(PROGRAM).resolve()), "export", "run.nc", "-o", "a.png"], cwd=self.folder,
                              env={**os.environ, "CHROMIUM": str(broken)}, capture_output=True, text=True, check=False)
        self.assertEqual(done.returncode, IO)
        self.assertIn("(it cannot)", done.stderr, "its last words")

    def test_usage(self):
        for option, told in ((("--size", "12"), "1280x720"), (("--size", "8x8"), "16"), (("--size", "99999x10"), "8192"),
                             (("--from", "9"), "from"), (("--from", "nan9"), "--from")):
            self.assertIn(told, self.expect(USAGE, "export", "run.nc", "-o", "a.png", *option).err, option)
        for option in (("--fps", "1000"), ("--fps", "-1"), ("--duration", "-2"), ("--from", "0.3", "--to", "0.2"), ("--duration", "86000")):
            self.expect(USAGE, "export", "run.nc", "-o", "a.webm", *option)
        self.assertIn(".webm", self.expect(USAGE, "export", "run.nc", "-o", "a.mp4").err)
        self.expect(USAGE, "export", "run.nc", "-o", "a.png", "--png", "b.png")


@unittest.skipUnless(HAS_BROWSER, "no Chromium")
class Pictures(ProgramTest):
    def setUp(self):
        super().setUp()
        self.solve()

    def made(self, name, *options):
        self.expect(0, "export", "run.nc", "-o", name, *options)
        self.assert_no_temporaries()
        return (self.folder / name).read_bytes()

    def test_stills(self):
        start = self.made("start.png", "--size", "320x200")
        self.assertEqual(png(start)[:2], (320, 200))
        self.assertEqual(self.made("start.png", "--size", "320x200"), start, "again, over an older one")
        self.assertNotEqual(self.made("later.png", "--size", "320x200", "--from", "0.3"), start)
        dark, light = (sum(png(self.made("x.png", "--size", "320x200", *option))[2]) for option in (["--dark"], []))
        self.assertLess(dark, 0.7 * light)
        drawn = self.made("sketch.svg").decode()
        self.assertRegex(drawn, r"^<svg [^>]*><!-- livens -->")

    def test_videos(self):
        video = self.made("motion.webm", "--size", "320x200", "--duration", "2", "--fps", "10", "--names", "--clock")
        self.assertEqual(video[:4], b"\x1a\x45\xdf\xa3")
        self.assertEqual(struct.unpack(">d", element(video, b"\x44\x89"))[0], 2100, "ms: 21 frames")
        self.assertEqual([int.from_bytes(element(video, side), "big") for side in (b"\xb0", b"\xba")], [320, 200])
        moving = self.made("motion.gif", "--size", "160x100", "--duration", "1", "--fps", "5", "--to", "0.25")
        self.assertEqual(struct.unpack_from("<HH", moving, 6), (160, 100))
        self.assertEqual(gif_frames(moving), [0.2] * 6)
        both = self.expect(0, "export", "run.nc", "-o", "motion.gif", "--csv", "a.csv", "--size", "64x64", "--fps", "2", "--json")
        self.assertRegex(both.out, r'"csv": "a.csv",\s*"gif": "motion.gif"')

    def test_what_is_not_ours_stays(self):
        other = b"\x89PNG\r\n\x1a\nof somebody else"
        (self.folder / "a.png").write_bytes(other)
        self.expect(IO, "export", "run.nc", "-o", "a.png")
        self.assertEqual((self.folder / "a.png").read_bytes(), other)
        self.made("a.png", "--size", "64x64", "--force")

    def test_a_signal_leaves_nothing_behind(self):
        temporary = self.folder / "temporary"
        temporary.mkdir()
        process = subprocess.Popen([PROGRAM, "export", "run.nc", "-o", "a.webm", "--duration", "600"], cwd=self.folder,
                                   env={**os.environ, "TMPDIR": str(temporary)}, stdout=subprocess.PIPE, stderr=subprocess.STDOUT)
        self.addCleanup(process.communicate)
        self.addCleanup(process.kill)
        for _ in range(600):   # the page is written before the browser starts
            if self.of_browsers(temporary):
                break
            time.sleep(0.1)
        self.assertNotEqual(self.of_browsers(temporary), [], "the control")
        process.send_signal(signal.SIGINT)
        self.assertEqual(process.wait(120), 130)
        self.assertEqual((list(temporary.iterdir()), "a.webm" in self.files()), ([], False))
        self.assertEqual(self.of_browsers(temporary), [])

    @staticmethod
    def of_browsers(folder):
        """Processes that name the folder."""
        found = []
        for entry in pathlib.Path("/proc").glob("[0-9]*/cmdline"):
            try:
                found += [entry.parent.name] if str(folder).encode() in entry.read_bytes() else []
            except OSError:
                pass   # it has just ended
        return found


if __name__ == "__main__":
    unittest.main()
