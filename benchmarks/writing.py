#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Instructions of what follows a solution, judging and writing it, against those of the solution and the second one
that tells its error, by example.

    benchmarks/writing.py PROGRAM [FILE ..]      PROGRAM: build/release/livens; default: four examples

Counted by callgrind in one process. Exit status 1 if they take more than is allowed anywhere, 77 without valgrind.
"""

import pathlib
import re
import shutil
import subprocess
import sys
import tempfile

MOST = 0.6
EXAMPLES = ("revolute_double_pendulum", "four_bar", "ball_pendulum_two", "double_pendulum_offset")
PARTS = {"both": "livens::solve_scenario(", "estimate": "livens::estimate(", "judging": "livens::judged_run(",
         "writing": "livens::write_run("}


def count(program: str, example: pathlib.Path, folder: str) -> dict[str, int]:
    """Inclusive instructions of each part."""
    profile = f"{folder}/profile"
    run = subprocess.run(["valgrind", "--tool=callgrind", f"--callgrind-out-file={profile}", program, "solve",
                          str(example), "--output", f"{folder}/run.nc"], capture_output=True, text=True)
    if run.returncode not in (0, 7):   # converged, or suspect, which is written as well
        sys.exit(f"{example}: exit status {run.returncode}\n{run.stderr}")
    listed = subprocess.run(["callgrind_annotate", "--inclusive=yes", "--threshold=100", profile],
                            capture_output=True, text=True, check=True).stdout
    found = {}
    for line in listed.splitlines():
        for part, name in PARTS.items():
            if name in line and part not in found:
                found[part] = int(re.match(r"\s*([\d,]+)", line).group(1).replace(",", ""))
    if missing := PARTS.keys() - found.keys():
        sys.exit(f"{example}: nothing was counted for {', '.join(sorted(missing))}")
    return found


def main() -> int:
    if shutil.which("valgrind") is None:
        print("SKIPPED: instruction counts (valgrind is not installed)")
        return 77
    if len(sys.argv) < 2:
        sys.exit(__doc__)
    program, *given = sys.argv[1:]
    here = pathlib.Path(__file__).resolve().parent.parent / "examples"
    examples = [pathlib.Path(name) for name in given] or [here / f"{name}.toml" for name in EXAMPLES]
    over = False
    print(f"{'instructions (M)':28s} {'march':>8s} {'second':>8s} {'judging':>8s} {'writing':>8s}   both / solving")
    for example in examples:
        with tempfile.TemporaryDirectory() as folder:
            n = count(program, example, folder)
        ratio = (n["judging"] + n["writing"]) / n["both"]
        over |= not ratio <= MOST
        columns = (n["both"] - n["estimate"], n["estimate"], n["judging"], n["writing"])
        print(f"{example.stem:28s} {' '.join(f'{c / 1e6:8.2f}' for c in columns)}   {ratio:.2f} of {MOST}"
              f"{'  OVER' if not ratio <= MOST else ''}", flush=True)
    return int(over)


if __name__ == "__main__":
    sys.exit(main())
