# SPDX-License-Identifier: BSD-3-Clause
"""All URDFs of example-robot-data and pybullet_data: read, with every loss listed, or refused with file, line and reason.
The table that is printed says which, and what of."""
import collections
import json
import pathlib
import re
import subprocess
import sys
import tempfile
import unittest

import robots

ROBOTS, BULLET = robots.packages()

# Not read, and rightly so: what is wrong with them.
REFUSED = {
    "alex_description/urdf/alex_psyonic_hands.urdf": "urdf-joint",   # mimics joints that are called otherwise
    "bicycle/bike.urdf": "urdf-value",   # commas between numbers
    "biped/biped2d_pybullet.urdf": "urdf-value",   # "-1.57."
    "humanoid/humanoid.urdf": "not-text",   # a control character
    "husky/husky.urdf": "urdf-value",   # $(optenv ..) of xacro
    "quadruped/microtaur/microtaur.urdf": "urdf-value",   # four angles
    "quadruped/spirit40newer.urdf": "urdf-tag",   # two axes of a joint
    "racecar/racecar_differential.urdf": "urdf-value",   # four scales
}
# Links whose inertia belongs to no body. iCub's is negative by rounding alone.
MENDED = {
    "icub_description/robots/icub.urdf": set(),
    "romeo_description/urdf/romeo_laas_small.urdf": {"LShoulderYaw_link", "LHipPitch_link", "RHipPitch_link", "LElbowYaw_link"},
    "romeo_description/urdf/romeo_small.urdf": {"RShoulderYawLink", "RElbowYawLink"},
    "mini_cheetah/mini_cheetah.urdf": {"thigh_fr", "thigh_fl", "thigh_hr", "thigh_hl"},
    "xarm/xarm6_robot.urdf": {"link2", "link3"},
}
MOVES = re.compile(r"""<joint[^>]*type\s*=\s*["'](revolute|continuous|prismatic|spherical|planar|floating)""")


def files():
    """Those in which something moves, by their names below the packages; random_urdfs are a thousand alike."""
    found = {}
    for folder in (ROBOTS, BULLET):
        for file in sorted(folder.rglob("*.urdf")):
            if "random_urdfs" not in file.parts and MOVES.search(file.read_text(errors="replace")):
                found[str(file.relative_to(folder))] = file
    return found


def read(file, folder, *more):
    ran = subprocess.run([robots.PROGRAM, "import", str(file), "-o", "robot.toml", "--force", "--json", "--quiet", "--meshes", "none",
                          *more], cwd=folder, capture_output=True, text=True, check=False)
    return ran.returncode, json.loads(ran.stdout)


class ReadsAll(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)

    def test_each_is_read_or_refused_with_its_line(self):
        told, n_read, refused = collections.Counter(), 0, {}
        for name, file in files().items():
            code, answer = read(file, self.folder)
            for d in answer["errors"] + answer["warnings"]:
                self.assertGreater(d["line"], 0, f"{name}: {d}")
                self.assertEqual(d["file"], str(file))
            if code == 0:
                n_read += 1
                self.assertTrue((self.folder / "robot.toml").read_text().startswith("# From "))
                told.update({(d["code"], re.sub(r": \d+ .*", "", d["message"])) for d in answer["warnings"]})
            else:
                self.assertEqual(code, 3, name)
                first = answer["errors"][0]
                refused[name] = first["code"]
                print(f"refused: {name}:{first['line']}: {first['message']} [{first['code']}]")
        print(f"{n_read} read, {len(refused)} refused")
        for (code, message), n in told.most_common():
            print(f"| {n} | {code} | {message} |")
        self.assertEqual(refused, REFUSED)
        self.assertGreater(n_read, 90)

    def test_what_is_in_a_file_is_in_the_model_or_told(self):
        """Counted by another reader: joints that move, and the mass of all links that can."""
        import xml.etree.ElementTree as ET
        for name, file in files().items():
            code, answer = read(file, self.folder, "--base", "free")
            if code != 0:
                continue
            root = ET.fromstring(file.read_text().strip())
            moving = [j for j in root.findall("joint") if j.get("type") not in ("fixed", "floating")]
            merged = sum(int(re.search(r": (\d+) joint", d["message"])[1]) for d in answer["warnings"]
                         if "mimic a joint that does not move" in d["message"])
            couplings = sum(j.find("mimic") is not None for j in moving) - merged
            with self.subTest(name):
                self.assertEqual(answer["joints"], len(moving) - merged + couplings)
                mass = sum(float(m.get("value")) for m in root.findall("link/inertial/mass"))
                weighed = subprocess.run([robots.PROGRAM, "mass", "robot.toml", "--json"], cwd=self.folder, capture_output=True,
                                         text=True, check=True)
                self.assertAlmostEqual(json.loads(weighed.stdout)["mass"], mass, delta=1e-6 * max(mass, 1))

    def test_mended_inertias_are_named(self):
        for name, links in MENDED.items():
            code, answer = read(files()[name], self.folder)
            self.assertEqual(code, 0, name)
            said = [d["message"] for d in answer["warnings"] if "not physically possible" in d["message"]]
            self.assertEqual(set(re.findall(r"'(\w+)' by [\d.]+ %", "".join(said))), links, name)


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0], *sys.argv[1:]])
