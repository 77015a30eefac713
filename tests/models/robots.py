# SPDX-License-Identifier: BSD-3-Clause
"""Robots of the package index, and livens as it is called on them. Run by the Python that `scripts/setup models` makes; the
environment variable LIVENS_PROGRAM names the program."""
import csv
import io
import os
import pathlib
import re
import subprocess
import sys
import xml.etree.ElementTree as ET

SKIPPED = 77
PROGRAM = os.environ.get("LIVENS_PROGRAM", "livens")
MOVING = ("revolute", "continuous", "prismatic")


def packages():
    """Folders of example-robot-data and pybullet_data; ends where they are missing, and says so."""
    try:
        import pinocchio
        import pybullet_data
        import scipy   # noqa: F401
    except ImportError as error:
        print(f"SKIPPED: robots of the package index ({error}); scripts/setup models installs them")
        sys.exit(SKIPPED)
    # Their package is files alone, beside those of Pinocchio.
    above = [folder / "share/example-robot-data/robots" for folder in pathlib.Path(pinocchio.__file__).parents]
    found = [folder for folder in above if folder.is_dir()]
    if not found:
        print("SKIPPED: robots of the package index (no example-robot-data); scripts/setup models installs it")
        sys.exit(SKIPPED)
    return found[0], pathlib.Path(pybullet_data.getDataPath())


def run(*arguments, cwd):
    return subprocess.run([PROGRAM, *map(str, arguments)], cwd=cwd, capture_output=True, text=True, check=False)


def prepared(urdf, damping, to):
    """The same robot with one damping at all joints, without friction, and each joint moving by itself: what both engines
    are given. Names of the joints that move."""
    tree = ET.parse(urdf)
    names = []
    for joint in tree.getroot().findall("joint"):
        for tag in ("dynamics", "mimic"):
            for found in joint.findall(tag):
                joint.remove(found)
        if joint.get("type") in MOVING:
            names.append(joint.get("name"))
            ET.SubElement(joint, "dynamics", damping=str(damping))
    tree.write(to)
    return names


def angles(urdf, at, free, accuracy, folder):
    """Coordinates of joints at 0, 0.1, .. 1 s by name, what the program says of the motion, and the import."""
    pose = [word for name, value in at.items() for word in ("--at", f"{name}={value!r}")]
    made = run("import", urdf, "-o", "robot.toml", "--meshes", "none", "--limits", "ignore", "--base", "free" if free else "fixed", "--force", *pose,
               cwd=folder)
    if made.returncode != 0:
        raise AssertionError(made.stderr)
    scenario = folder / "robot.toml"
    scenario.write_text(scenario.read_text().replace(
        "[time]\nend = 1.0", f"[time]\nend = 1.0\naccuracy = {accuracy}\noutput = 0.1"))
    solved = run("solve", "robot.toml", "-o", "robot.nc", "--json", cwd=folder)
    if solved.returncode != 0:
        raise AssertionError(solved.stderr[-2000:])
    shown = run("export", "robot.nc", "--csv", "robot.csv", "--at", "output", "--force", cwd=folder)
    if shown.returncode != 0:
        raise AssertionError(shown.stderr)
    rows = list(csv.reader(io.StringIO((folder / "robot.csv").read_text())))
    found = {}
    for column, title in enumerate(rows[0]):
        if match := re.fullmatch(r"(.*)\.(angle|displacement) \[.*\]", title):
            found[match[1]] = [float(row[column]) for row in rows[1:]]
    return found, solved.stdout, made.stderr
