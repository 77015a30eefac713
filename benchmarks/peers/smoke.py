# SPDX-License-Identifier: BSD-3-Clause
"""livens and the references move alike: smoke.py FOLDER_OF_PROGRAMS. Standard library only."""
import dataclasses
import json
import math
import pathlib
import subprocess
import sys
import tempfile

import problems
import scenarios

# Degree and elements, steps of the reference, distance (m) that is allowed.
SETTINGS = {"bricks": ("8:60", 60, 1e-10), "rods": ("8:200", 200, 1e-9), "links": ("8:80", 200, 1e-10),
            "four_bar": ("8:100", 300, 1e-8), "parallelograms": ("8:80", 200, 1e-10),
            "balls2": ("8:40", 40, 1e-10), "balls10": ("8:60", 60, 1e-10), "hinges10": ("8:40", 30, 1e-10),
            "damped10": ("8:40", 30, 1e-12), "arm": ("8:40", 200, 1e-12), "suspension": ("8:150", 400, 1e-12),
            "figure": ("8:40", 100, 1e-9), "bushing": ("8:100", 200, 1e-12), "gears": ("8:30", 100, 1e-12)}


def ends(program, mechanism, setting):
    said = subprocess.run([program], input=f"{mechanism.text()}solve {setting} 1\n", capture_output=True, text=True,
                          check=True).stdout
    return json.loads(said)["points"]


def is_livens(mechanism, way):
    """Levers and bodies without inertia are no bodies of livens."""
    return way != "hinged masses" and all(body.mass for body in mechanism.bodies)


def spoilt(mechanism):
    """With a load that is off by a millionth, or the wrong gravity."""
    if not mechanism.loads:
        return dataclasses.replace(mechanism, gravity=tuple((1 + 1e-8) * g for g in mechanism.gravity))
    which = max((load[0] == "control", i) for i, load in enumerate(mechanism.loads))[1]   # controllers first
    kind, *numbers = mechanism.loads[which]
    k = max(i for i, number in enumerate(numbers) if isinstance(number, tuple) or isinstance(number, float) and number)
    numbers[k] = tuple((1 + 1e-6) * x for x in numbers[k]) if isinstance(numbers[k], tuple) else (1 + 1e-6) * numbers[k]
    return dataclasses.replace(mechanism, loads=[*mechanism.loads[:which], (kind, *numbers), *mechanism.loads[which + 1:]])


def main(folder):
    programs = [pathlib.Path(folder) / name for name in ("peer_livens", "peer_hand")]
    table, far = problems.table(), []
    with tempfile.TemporaryDirectory() as files:
        for name, (setting, steps, allowed) in SETTINGS.items():
            reference = ends(programs[1], list(table[name].ways.values())[0], f"reference:{steps}")
            for way, mechanism in table[name].ways.items():
                if not is_livens(mechanism, way):
                    continue
                scenarios.write(mechanism, files)
                error = max(map(math.dist, ends(programs[0], mechanism, setting), reference))
                print(f"{name} {way}: {error:.1e} m, {allowed:.0e} is allowed")
                if not error <= allowed:
                    far.append(name)
        for name in ("bricks", "damped10", "arm", "suspension", "bushing", "gears"):
            setting, steps, allowed = SETTINGS[name]
            way = list(table[name].ways.values())[-1]
            wrong = spoilt(way)
            scenarios.write(wrong, files)
            reference = ends(programs[1], list(table[name].ways.values())[0], f"reference:{steps}")
            off = max(map(math.dist, ends(programs[0], wrong, setting), reference))
            print(f"{name}, wrong by a millionth: {off:.1e} m")
            if off <= 10 * allowed:
                far.append(f"{name}: what is wrong by a millionth is not seen")
    return "; ".join(far) or 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1]))
