# SPDX-License-Identifier: BSD-3-Clause
"""Runs the experiments and prints one table of verdicts.

    all.py [--short] [--livens PROGRAM] [--output FOLDER] [figNN ...]
    all.py --scans [--short] [--livens PROGRAM] [--output FOLDER] [NAME ...]
           [--seed N] [--count N] [--kind KIND ..]
    all.py --list [--scans] [NAME ...]      which would run

An experiment is named by its folder or by the beginning of it: fig02, text; a scan by what is behind scan_.
Seed, count and kinds are for the scans of laws: other laws, fewer, of one kind.
"""
import argparse
import json
import pathlib
import subprocess
import sys
import time

import law_scans
import paper

HERE = pathlib.Path(__file__).resolve().parent
SCAN = "scan_"
STATES = {0: "as expected", 1: "NOT AS EXPECTED"}


def chosen(names, scans):
    """Folders of the experiments, or scans, whose name begins with one of `names`; all without names."""
    folders = sorted(path.parent for path in HERE.glob("*/run") if (path.parent / "expected.json").exists()
                     and path.parent.name.startswith(SCAN) == scans)
    names = [SCAN * scans + name for name in names]
    for name in names:
        if not any(folder.name.startswith(name) for folder in folders):
            known = ", ".join(folder.name for folder in folders)
            sys.exit(f"no experiment is called {name}; there are: {known}")
    return [folder for folder in folders if not names or any(folder.name.startswith(name) for name in names)]


def of_laws(arguments):
    """What is passed on to scans of laws."""
    given = {"--seed": [arguments.seed], "--count": [arguments.count] * (arguments.count is not None)}
    return [str(word) for key, values in given.items() for value in values for word in (key, value)] + [
        word for kind in arguments.kind or () for word in ("--kind", kind)]


def main():
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--short", action="store_true", help="fewer refinements, a few seconds each")
    parser.add_argument("--scans", action="store_true", help="the scans instead of the paper's figures")
    parser.add_argument("--list", action="store_true", help="say which, and run none")
    parser.add_argument("--livens", default=paper.PROGRAM)
    parser.add_argument("--output", type=pathlib.Path, help="default: build/paper or build/scan")
    law_scans.arguments(parser)
    parser.add_argument("names", nargs="*", metavar="figNN", help="which; default: all")
    arguments = parser.parse_args()

    if arguments.list:
        print("\n".join(folder.name for folder in chosen(arguments.names, arguments.scans)))
        return
    lines, failed = [], False
    place = arguments.output or paper.ROOT / "build" / ("scan" if arguments.scans else "paper")
    for folder in chosen(arguments.names, arguments.scans):
        output = place / folder.name
        verdict = output / "verdict.json"
        verdict.unlink(missing_ok=True)   # an old one must not speak for a run that breaks
        began = time.monotonic()
        command = [sys.executable, "-B", folder / "run", "--livens", arguments.livens, "--output", output]
        command += ["--short"] * arguments.short + of_laws(arguments) * ("law" in folder.name)
        status = subprocess.run(command, check=False).returncode
        failed |= status != 0
        held = "-"
        if verdict.exists():
            judged = json.loads(verdict.read_text(encoding="utf-8"))["expectations"]
            held = f"{sum(entry['holds'] for entry in judged)}/{len(judged)}"
        lines.append((folder.name, held, f"{time.monotonic() - began:.0f} s", STATES.get(status, "BROKEN")))

    widths = [max(len(line[i]) for line in lines) for i in range(3)]
    print()
    for name, held, seconds, state in lines:
        print(f"{name:<{widths[0]}}  {held:>{widths[1]}}  {seconds:>{widths[2]}}  {state}")
    sys.exit(1 if failed else 0)


if __name__ == "__main__":
    main()
