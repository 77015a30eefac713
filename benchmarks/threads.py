#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Instructions of the longest of two threads over those of one thread, of windows of 1000 elements.

    benchmarks/threads.py PROGRAM [NAME ..]      PROGRAM: build/release/benchmarks/instructions

    bricks_between      lobatto(4), two bricks on ball joints between two places, half a second apart, rates 0.9 of the true ones
    bricks_true         the same with the true rates
    pendulum_between    the same of the double pendulum on rods with an offset, a second apart
    bricks_window       lobatto(4), the bricks from a known state, all of it as one window
    mixed               linear elements of the double pendulum on rods, all at once

All that a solution is, from what is stated to a motion that is judged, counted by callgrind; what the second thread does is less. Exit
status 1 where the first one takes more than 0.56, 77 without valgrind. Minutes.
"""
import os
import pathlib
import shutil
import sys
import tempfile

import newton_step

NAMES = ("bricks_between", "bricks_true", "pendulum_between", "bricks_window", "mixed")
ALLOWED = 0.56
ROOT = pathlib.Path(__file__).resolve().parents[1]
PENDULUM = """
[[body]]
name = "upper"
shape = { box = [1, 1, 1] }
density = 1.5
position = [2.8284271247461903, 0, 2.8284271247461903]
start = { position = [3.3928509639502837, 0, 2.118622745186512], velocity = [1.8007017714784355, 0, -2.883719036354321] }
end = { position = [1.4726098105195005, 0, -3.71906175613712] }
[[body]]
name = "lower"
shape = { box = [0.8, 0.8, 0.8] }
density = 1.5
center_of_mass = [0.1, 0, 0]
position = [5.656854249492381, 0, 5.656854249492381]
[body.start]
position = [6.178127363336551, 0, 4.989552103255406]
directors = [[0.8733609029824754, 0, -0.48707364242138496], [0, 1, 0], [0.48707364242138496, 0, 0.8733609029824754]]
velocity = [1.627112537498177, 0, -2.7153087634808806]
angular_velocity = [0, 1.6168740236354153, 0]
[body.end]
position = [5.312199091063251, 0, -4.840468977771402]
directors = [[0.9662028295158986, 0, 0.2577830332575658], [0, 1, 0], [-0.2577830332575658, 0, 0.9662028295158986]]
[[joint]]
name = "upper rod"
type = "rod"
between = ["world", "upper"]
[[joint]]
name = "lower rod"
type = "rod"
between = ["upper", "lower"]
"""


def bricks(is_march: bool, method: str, rates: float = 0.9) -> str:
    return (newton_step.scenario(is_march, rates).replace("elements = 10", "elements = 1000")
            .replace('{ family = "lobatto", degree = 8 }', f'{{ family = "lobatto", degree = 4, {method} }}'))


def scenario(name: str, threads: int) -> str:
    method = f"threads = {threads}"
    if name == "bricks_between":
        return bricks(False, method)
    if name == "bricks_true":
        return bricks(False, method, 1)
    if name == "bricks_window":
        return bricks(True, f'window = "all", {method}')
    if name == "pendulum_between":
        return ("format = 1\ngravity = [0, 0, -9.81]\ntime = { end = 1, elements = 1000 }\n"
                f'method = {{ family = "lobatto", degree = 4, {method} }}\n'
                'start = { given = "positions" }\nend = { given = "positions" }\n' + PENDULUM)
    example = (ROOT / "examples" / "double_pendulum_centred.toml").read_text(encoding="utf-8")
    return (example[:example.index("[time]")] + "[time]\nend = 5\nelements = 1000\n"
            f'[method]\nfamily = "mixed"\ndegree = 1\nwindow = "all"\n{method}\n')


def main() -> int:
    names = sys.argv[2:] or NAMES
    if len(sys.argv) < 2 or not set(names) <= set(NAMES):
        sys.exit(__doc__)
    if not shutil.which("valgrind"):
        print("SKIPPED: instructions of threads (valgrind is not installed)")
        return 77
    over = False
    print(f"{'1000 elements':20} {'one thread':>12} {'two, the longest':>17}  share, allowed")
    with tempfile.TemporaryDirectory() as folder:
        for name in names:
            counted = []
            for threads in (1, 2):
                file = pathlib.Path(folder, f"{name}_{threads}.toml")
                file.write_text(scenario(name, threads), encoding="utf-8")
                counted.append(newton_step.counts(sys.argv[1], file, os.environ.get("LIVENS_SIMD", "avx2"))[0])
            share = counted[1] / counted[0]
            over |= share > ALLOWED
            print(f"{name:20} {counted[0] / 1e6:10.0f} M {counted[1] / 1e6:15.0f} M  {share:.3f}, {ALLOWED:g}"
                  + ("  OVER" if share > ALLOWED else ""), flush=True)
    return over


if __name__ == "__main__":
    sys.exit(main())
