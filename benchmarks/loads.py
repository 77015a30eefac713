#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Instructions of a motion with loads over those without, and of an accuracy over the bare motion.

    benchmarks/loads.py PROGRAM [NAME ..]      PROGRAM: build/release/benchmarks/instructions

Ten bricks of 1 kg on hinges, each across the one before, from rest: lobatto(6), 40 elements to 0.5 s, with a load at
every hinge. Two bricks on hinges with loads between points and bodies. Counted by callgrind within solve(). Exit status 1 where
more than what is allowed is counted, 77 without valgrind.
"""

import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile

AT_HINGES = {   # what stands in a load at hinge k; allowed over no load
    "damper": ('type = "spring"\njoint = "j{k}"\ndamping = 0.5', 1.6),
    "spring": ('type = "spring"\njoint = "j{k}"\nstiffness = 20', 2.0),
    "expression": ('type = "actuator"\njoint = "j{k}"\nexpression = "-20*phi - 0.5*w + sin(3*t)"\n'
                   'inputs = {{ phi = "j{k}.angle", w = "j{k}.angle_rate" }}', 2.5),
    "stiff": ('type = "spring"\njoint = "j{k}"\nstiffness = 1e4', 6.0),
}
ON_BODIES = {   # two bricks: loads for body k = 0, 1
    "point_spring": ('type = "spring"\nbetween = ["world", "b{k}"]\npoints = [[0, 1, 1], [0.5, 0.1, 0]]\n'
                     'stiffness = 20\ndamping = 0.1\nfree_length = 0.3', 1.6),
    "bushing": ('type = "bushing"\nbetween = ["world", "b{k}"]\nat = [{k}.5, 0, 0]\n'
                'stiffness = [20, 20, 20, 2, 2, 2]\ndamping = [0.1, 0.1, 0.1, 0.01, 0.01, 0.01]', 1.6),
    "drag": ('type = "drag"\nbody = "b{k}"\npoint = [0.5, 0, 0]\nlinear = 0.1\nquadratic = 0.2', 1.6),
}
METHOD = '[method]\nfamily = "lobatto"\ndegree = 6\nestimate = "none"\n'


def chain(n: int, load: str, end: float, elements: int) -> str:
    text = ['format = 1\ngravity = [0, 0, -9.81]']
    for k in range(n):
        turned = k % 2 == 1   # about its length, so that the hinges cross
        text.append(f'[[body]]\nname = "b{k}"\nmass = 1\ninertia = [{5 / 1200}, {104 / 1200 / 1.03}, {101 / 1200}]\n'
                    f'position = [{k + 0.5}, 0, 0]')
        axis = "[0, 1, 0]" if not turned else "[0, 0.6, 0.8]"
        first = f'"b{k - 1}"' if k else '"world"'
        text.append(f'[[joint]]\nname = "j{k}"\ntype = "revolute"\nbetween = [{first}, "b{k}"]\nat = [{k}, 0, 0]\naxis = {axis}')
        if load:
            text.append("[[load]]\n" + load.format(k=k))
    text.append(f"[time]\nend = {end}\nelements = {elements}\n{METHOD}")
    return "\n".join(text) + "\n"


def count_file(program: str, path: pathlib.Path, *how: str) -> tuple[float, str]:
    """Instructions of solving it, and what the program tells; nan, and why, where it is not solved."""
    run = subprocess.run(["valgrind", "--tool=callgrind", "--callgrind-out-file=/dev/null", "--collect-atstart=no",
                          "--toggle-collect=livens_counted_solve*", program, "scenario", str(path), *how],
                         capture_output=True, text=True, env={"LIVENS_SIMD": "sse2", **os.environ})
    found = re.search(r"Collected : (\d+)", run.stderr)
    if run.returncode or not found:
        return float("nan"), " ".join(line for line in run.stderr.splitlines() if not line.startswith("=="))
    return float(found.group(1)), run.stdout.strip()


def count(program: str, text: str, *how: str) -> tuple[float, str]:
    with tempfile.TemporaryDirectory() as folder:
        path = pathlib.Path(folder, "scenario.toml")
        path.write_text(text)
        return count_file(program, path, *how)


def main() -> int:
    if shutil.which("valgrind") is None:
        print("SKIPPED: instruction counts (valgrind is not installed)")
        return 77
    if len(sys.argv) < 2:
        sys.exit(__doc__)
    program, *names = sys.argv[1:]
    over = False
    for title, n, end, elements, cases in (("ten hinges", 10, 0.5, 40, AT_HINGES), ("two hinges", 2, 1, 40, ON_BODIES)):
        cases = {name: case for name, case in cases.items() if not names or name in names}
        if not cases:
            continue
        bare, told = count(program, chain(n, "", end, elements), "bare")
        print(f"{title:14s} {'no load':14s} {bare / 1e6:9.2f} M   {told}", flush=True)
        for name, (load, allowed) in cases.items():
            counted, told = count(program, chain(n, load, end, elements), "bare")
            is_over = not counted / bare <= allowed
            over |= is_over
            print(f"{title:14s} {name:14s} {counted / 1e6:9.2f} M {counted / bare:7.2f} of {allowed:.1f}"
                  f"{'  OVER' if is_over else ''}   {told}", flush=True)
    return int(over)


if __name__ == "__main__":
    sys.exit(main())
