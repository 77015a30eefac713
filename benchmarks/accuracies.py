#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Instructions of a motion to an accuracy over those of the bare solution on the same mesh, with the method it ended with.

    benchmarks/accuracies.py PROGRAM [FILE ..]      PROGRAM: build/release/benchmarks/instructions
    benchmarks/accuracies.py PROGRAM examples | loaded

Default: seven examples, and the problems with loads of benchmarks/peers to 1e-6. Counted by callgrind: the bare solution;
solve() and estimate(), with the growth of errors; these with judging and writing. Exit status 1 where the largest or the
median of the second over the first is above what is allowed for the examples, 77 without valgrind.
"""

import pathlib
import re
import shutil
import statistics
import sys
import tempfile

import loads

LARGEST, MEDIAN = 4, 3
ROOT = pathlib.Path(__file__).resolve().parent.parent
EXAMPLES = ("four_bar", "furuta_pendulum", "slider_crank", "trebuchet", "wheel_suspension")
TO_ACCURACY = {"double_pendulum_offset": "1e-6", "ball_pendulum_two": "1e-6"}   # instead of their elements
sys.path.append(str(ROOT / "benchmarks/peers"))


def loaded_problems(folder: pathlib.Path) -> list[pathlib.Path]:
    """Files of what people have; of several ways to put a problem that without massless bodies."""
    import problems
    import scenarios
    paths = []
    for name, problem in problems.table().items():
        if problem.loaded:
            way = next(m for m in problem.ways.values() if all(body.mass for body in m.bodies))
            paths.append(folder / f"{name}.toml")
            paths[-1].write_text(scenarios.text(way, "accuracy = 1e-6"), encoding="utf-8")
    return paths


def count(program: str, path: pathlib.Path, *how: str) -> tuple[float, str]:
    counted, told = loads.count_file(program, path, *how)
    if counted != counted:   # nan
        sys.exit(f"{path}: {told}")
    return counted, told


def examples(folder: pathlib.Path) -> list[pathlib.Path]:
    paths = [ROOT / "examples" / f"{name}.toml" for name in EXAMPLES]
    for name, accuracy in TO_ACCURACY.items():
        head, time = (ROOT / "examples" / f"{name}.toml").read_text().split("[time]")
        kept = "\n".join(re.findall(r"^(?:end|output) = .*$", time, re.MULTILINE))
        path = folder / f"{name}.toml"
        path.write_text(f"{head}[time]\n{kept}\naccuracy = {accuracy}\n")
        paths.append(path)
    return paths


def main() -> int:
    if shutil.which("valgrind") is None:
        print("SKIPPED: instruction counts (valgrind is not installed)")
        return 77
    if len(sys.argv) < 2:
        sys.exit(__doc__)
    program, *names = sys.argv[1:]
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        ours = examples(folder)
        paths = {(): lambda: ours + loaded_problems(folder), ("examples",): lambda: ours,
                 ("loaded",): lambda: loaded_problems(folder)}.get(tuple(names), lambda: [pathlib.Path(name) for name in names])()
        ratios = []
        print(f"{'instructions (M)':22s} {'bare':>9s} {'accuracy':>9s} {'all':>9s}  over bare", flush=True)
        for path in paths:
            bare, _ = count(program, path, "again")
            whole, told = count(program, path)
            everything, _ = count(program, path, "all", str(folder / "run.nc"))
            if path in ours or names:
                ratios.append(whole / bare)
            print(f"{path.stem:22s} {bare / 1e6:9.2f} {whole / 1e6:9.2f} {everything / 1e6:9.2f}  {whole / bare:6.2f} {everything / bare:6.2f}"
                  f"   {told}", flush=True)
    print(f"largest {max(ratios):.2f} of {LARGEST}, median {statistics.median(ratios):.2f} of {MEDIAN}")
    return int(max(ratios) > LARGEST or statistics.median(ratios) > MEDIAN)


if __name__ == "__main__":
    sys.exit(main())
