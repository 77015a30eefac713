# SPDX-License-Identifier: BSD-3-Clause
"""livens and the references move alike: smoke.py FOLDER_OF_PROGRAMS. Standard library only."""
import dataclasses
import json
import math
import pathlib
import subprocess
import sys

import problems

# Degree and elements, steps of the reference, distance (m) that is allowed.
SETTINGS = {"bricks": ("8:60", 60, 1e-10), "rods": ("8:200", 200, 1e-9), "links": ("8:80", 200, 1e-10),
            "four_bar": ("8:100", 300, 1e-8), "parallelograms": ("8:80", 200, 1e-10),
            "balls2": ("8:40", 40, 1e-10), "balls10": ("8:60", 60, 1e-10), "hinges10": ("8:40", 30, 1e-10)}


def ends(program, mechanism, setting):
    said = subprocess.run([program], input=f"{mechanism.text()}solve {setting} 1\n", capture_output=True, text=True,
                          check=True).stdout
    return json.loads(said)["points"]


def main(folder):
    programs = [pathlib.Path(folder) / name for name in ("peer_livens", "peer_hand")]
    table, far = problems.table(), []
    for name, (setting, steps, allowed) in SETTINGS.items():
        reference = ends(programs[1], list(table[name].ways.values())[0], f"reference:{steps}")
        for way, mechanism in table[name].ways.items():
            if way == "hinged masses":   # levers without inertia are no bodies of livens
                continue
            error = max(map(math.dist, ends(programs[0], mechanism, setting), reference))
            print(f"{name} {way}: {error:.1e} m, {allowed:.0e} is allowed")
            if not error <= allowed:
                far.append(name)
    heavier = dataclasses.replace(table["bricks"].ways[""], gravity=(0, 0, -9.81 * (1 + 1e-8)))
    control = max(map(math.dist, ends(programs[0], heavier, "8:60"),
                      ends(programs[1], table["bricks"].ways[""], "reference:60")))
    if control <= SETTINGS["bricks"][2]:
        far.append("a wrong gravity is not seen")
    return "; ".join(far) or 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1]))
