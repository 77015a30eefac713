#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Instructions of a motion to an accuracy over those of the bare solution on the same mesh, with the method it ended with.

    benchmarks/accuracies.py PROGRAM [FILE ..]      PROGRAM: build/release/benchmarks/instructions; default: six examples

Counted by callgrind within solve() and estimate(). Exit status 1 where the largest or the median is above what is allowed,
77 without valgrind.
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
EXAMPLES = ("four_bar", "furuta_pendulum", "slider_crank", "wheel_suspension")
TO_ACCURACY = {"double_pendulum_offset": "1e-6", "ball_pendulum_two": "1e-6"}   # instead of their elements


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
    ratios = []
    with tempfile.TemporaryDirectory() as folder:
        for path in [pathlib.Path(name) for name in names] or examples(pathlib.Path(folder)):
            whole, told = count(program, path)
            bare, _ = count(program, path, "again")
            ratios.append(whole / bare)
            print(f"{path.stem:30s} {whole / 1e6:9.2f} M over {bare / 1e6:8.2f} M: {whole / bare:6.2f}   {told}",
                  flush=True)
    print(f"largest {max(ratios):.2f} of {LARGEST}, median {statistics.median(ratios):.2f} of {MEDIAN}")
    return int(max(ratios) > LARGEST or statistics.median(ratios) > MEDIAN)


if __name__ == "__main__":
    sys.exit(main())
