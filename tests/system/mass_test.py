# SPDX-License-Identifier: BSD-3-Clause
"""The command mass and scenarios with meshes, as a user meets them.

    LIVENS_PROGRAM=build/release/livens python3 mass_test.py [CLASS ...]
"""
import json
import shutil
import struct
import unittest

from program_test import IO, SCENARIO, SOURCE, USAGE, ProgramTest
from terminal_test import Transcripts as TerminalTranscripts

MESHES = SOURCE / "tests" / "unit" / "geometry" / "data"


def box_stl(x, y, z):
    """A binary STL of a box from the origin on."""
    corners = [(i & 1) * x for i in range(8)], [(i >> 1 & 1) * y for i in range(8)], [(i >> 2) * z for i in range(8)]
    faces = [(0, 2, 3, 1), (4, 5, 7, 6), (0, 1, 5, 4), (2, 6, 7, 3), (0, 4, 6, 2), (1, 3, 7, 5)]
    data = b""
    for a, b, c, d in faces:
        for triangle in ((a, b, c), (a, c, d)):
            data += struct.pack("<3f", 0, 0, 0)
            for k in triangle:
                data += struct.pack("<3f", *(axis[k] for axis in corners))
            data += struct.pack("<H", 0)
    return b" " * 80 + struct.pack("<I", 12) + data


BODIES = """format = 1
title = "a box and a bob"

[[body]]
name = "box"
shape = { mesh = "box.stl", unit = "mm" }
density = 7850

[[body]]
name = "bob"
shape = { point = true }
mass = 0.5
position = [1, 0, 0]

[time]
end = 1
elements = 4
"""


class Mass(ProgramTest):
    def setUp(self):
        super().setUp()
        (self.folder / "box.stl").write_bytes(box_stl(100, 200, 400))

    def mass(self, *arguments):
        return json.loads(self.expect(0, "mass", *arguments, "--json").out)

    def test_of_a_box(self):
        found = self.mass("box.stl", "--unit", "mm", "--density", "7850")
        self.assertEqual((found["points"], found["faces"], found["elements"], found["pieces"]), (8, 12, 0, 1))
        m = 7850 * 0.1 * 0.2 * 0.4
        self.assertAlmostEqual(found["volume"], 0.008, delta=1e-17)
        self.assertAlmostEqual(found["mass"], m, delta=1e-14 * m)
        for got, edge in zip(found["center_of_mass"], (0.1, 0.2, 0.4)):
            self.assertAlmostEqual(got, edge / 2, delta=1e-16)
        self.assertAlmostEqual(found["inertia"][0][0], m * (0.04 + 0.16) / 12, delta=1e-13)
        self.assertAlmostEqual(found["first_moment"][2], m * 0.2, delta=1e-13)
        self.assertAlmostEqual(found["second_moment"][2][2], m * 0.16 / 3, delta=1e-13)
        self.assertAlmostEqual(found["second_moment"][0][1], m * 0.05 * 0.1, delta=1e-13)
        self.assertAlmostEqual(found["triangle_ratio"], (0.04 + 0.16) / (0.01 + 0.04 + 0.01 + 0.16), delta=1e-13)
        self.assertEqual(found["principal_moments"], sorted(found["principal_moments"]))

    def test_of_regions(self):
        found = self.mass(MESHES / "two_bricks_22.msh")
        self.assertEqual([(r["name"], round(r["volume"], 12)) for r in found["regions"]], [("light", 1), ("heavy", 2)])

    def test_of_a_scenario(self):
        self.write("bodies.toml", BODIES)
        found = self.mass("bodies.toml")
        self.assertAlmostEqual(found["mass"], 63.3, delta=1e-12)
        box, bob = found["bodies"]
        self.assertEqual((bob["mass"], bob["point"]), (0.5, True))
        alone = self.mass("box.stl", "--unit", "mm", "--density", "7850")
        for i in range(3):
            self.assertAlmostEqual(box["inertia"][i][i], alone["inertia"][i][i], delta=1e-14)
        self.assertIn("bob, a point mass", self.expect(0, "mass", "bodies.toml").out)
        self.assertEqual(self.expect(0, "mass", "bodies.toml", "-q").out, "")

    def test_faults_are_all_told(self):
        data = (self.folder / "box.stl").read_bytes()
        (self.folder / "open.stl").write_bytes(data[:80] + struct.pack("<I", 11) + data[84:-50])
        done = self.expect(SCENARIO, "mass", "open.stl", "--json")
        (error,) = json.loads(done.out)["errors"]
        self.assertEqual(error["code"], "mesh-open")
        self.assertIn("the edge from", error["message"])
        turned = bytearray(data)
        for k in range(12):
            at = 84 + 50 * k + 12
            turned[at:at + 24] = turned[at + 12:at + 24] + turned[at:at + 12]
        (self.folder / "inside.stl").write_bytes(turned)
        self.assertIn("inside out", self.expect(SCENARIO, "mass", "inside.stl").err)
        self.assertEqual(self.mass("inside.stl", "--turn")["volume"], self.mass("box.stl")["volume"])

    def test_wrong_usage(self):
        self.expect(IO, "mass", "none.stl")
        self.expect(USAGE, "mass", "box.stl", "--unit", "kg")
        self.expect(USAGE, "mass", "box.stl", "--density", "-1")
        self.expect(USAGE, "mass", "box.stl", "--density", "heavy")
        self.expect(USAGE, "mass")

    def test_a_run_needs_no_mesh(self):
        self.write("bodies.toml", BODIES)
        self.expect(0, "solve", "bodies.toml", "-o", "run.nc")
        (self.folder / "elsewhere").mkdir()
        shutil.move(self.folder / "run.nc", self.folder / "elsewhere" / "run.nc")
        (self.folder / "box.stl").unlink()
        sample = json.loads(self.expect(0, "sample", "elsewhere/run.nc", "--body", "box", "--at", "0.3", "--exact", "--json").out)
        self.assertAlmostEqual(sample["center_of_mass"][1], 0.1, delta=1e-12)
        self.expect(0, "export", "elsewhere/run.nc", "--gltf", "run.glb")
        head = (self.folder / "run.glb").read_bytes()
        scene = json.loads(head[20:20 + struct.unpack("<I", head[12:16])[0]])
        heights = [a["max"][2] for a in scene["accessors"] if a.get("type") == "VEC3" and "max" in a]
        self.assertTrue(any(abs(h - 0.4) < 1e-6 for h in heights), heights)   # the mesh itself, not a mark
        self.expect(SCENARIO, "check", "bodies.toml")

    def test_meshes_do_not_leave_the_folder(self):
        self.write("bodies.toml", BODIES.replace('"box.stl"', '"../box.stl"'))
        self.assertIn("mesh-path", self.expect(SCENARIO, "check", "bodies.toml").err)


class MassTranscripts(ProgramTest):
    transcript, masked, compare = (TerminalTranscripts.transcript, TerminalTranscripts.masked,
                                   TerminalTranscripts.compare)

    def test_mass(self):
        (self.folder / "box.stl").write_bytes(box_stl(100, 200, 400))
        self.transcript("mass", 0, "mass", "box.stl", "--unit", "mm", "--density", "7850")


del TerminalTranscripts   # else its tests would run here again

if __name__ == "__main__":
    unittest.main(verbosity=2)
