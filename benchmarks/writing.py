#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Instructions of judging and writing a result against those of solving it, solution and estimate, by example.

    benchmarks/writing.py PROGRAM [EXAMPLE ..]

Counted by callgrind in one process. Exit status 1 if writing takes more than one and a half times as much anywhere
(half while solving was three times as dear), 77 without valgrind.
"""

import pathlib
import re
import shutil
import subprocess
import sys
import tempfile

MOST = 1.5
PARTS = {"both": "solve_scenario(", "judging": "livens::judge(livens::Model const&, livens::Solution&)",
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
    examples = [pathlib.Path(name) for name in given] or sorted(here.glob("*.toml"))
    over = False
    print(f"{'instructions (M)':30s} {'solving':>10s} {'judging':>10s} {'writing':>10s}   writing / solving")
    for example in examples:
        with tempfile.TemporaryDirectory() as folder:
            n = count(program, example, folder)
        solving = n["both"] - n["judging"]
        ratio = n["writing"] / solving
        over |= ratio > MOST
        print(f"{example.stem:30s} {solving / 1e6:10.1f} {n['judging'] / 1e6:10.1f} {n['writing'] / 1e6:10.1f}"
              f"   {ratio:.2f}{'  OVER' if ratio > MOST else ''}", flush=True)
    return over


if __name__ == "__main__":
    sys.exit(main())
