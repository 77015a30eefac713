# SPDX-License-Identifier: BSD-3-Clause
"""Figures that documents state are those that are measured: figures.py ROOT PROGRAM [REFERENCE_TESTS]. Standard library only.

    README.md             errors of the two bricks, kinds of joints, size of a report
    docs/joints.md        kinds of joints
    docs/validation.md    errors of the published problems, as REFERENCE_TESTS (tests/reference) prints them

An error may be off by a factor of three; times depend on the machine and are not looked at. --controls: stale documents must be found.
"""
import json
import pathlib
import re
import subprocess
import sys
import tempfile

TIP = (0.644182606655, -0.291228917392, -1.136547655061)   # docs/examples.md, free end of the second brick at 2 s
WORDS = {"seventeen": 17, "eighteen": 18, "nineteen": 19, "twenty": 20}
FACTOR = 3


def run(program, *words):
    return subprocess.run([str(program), *map(str, words)], capture_output=True, text=True, check=True).stdout


def tip_error(root, program, method, elements):
    text = (root / "examples/ball_pendulum_two.toml").read_text(encoding="utf-8").split("[time]")[0]
    text += f"[time]\nend = 2\nelements = {elements}\noutput = 2\n[method]\n{method}\nestimate = \"none\"\n"
    text += '[[sensor]]\nname = "tip"\ntype = "point"\nbody = "lower"\npoint = [1, 0, 0]\n'
    with tempfile.TemporaryDirectory() as folder:
        scenario, result = pathlib.Path(folder, "s.toml"), pathlib.Path(folder, "s.nc")
        scenario.write_text(text, encoding="utf-8")
        subprocess.run([str(program), "solve", str(scenario), "-o", str(result), "-q"], check=False)   # midpoint may be suspect
        values = json.loads(run(program, "sample", result, "--sensor", "tip", "--at", 2, "--json"))["samples"][0]["values"]
    return sum((a - b) ** 2 for a, b in zip(values, TIP)) ** 0.5


def report_megabytes(root, program):
    with tempfile.TemporaryDirectory() as folder:
        result, page = pathlib.Path(folder, "s.nc"), pathlib.Path(folder, "s.html")
        run(program, "solve", root / "examples/four_bar.toml", "-o", result, "-q")
        run(program, "report", result, "-o", page, "-q")
        return page.stat().st_size / 1e6


def kinds_of_joints(program):
    text = run(program, "schema", "--md")
    row = re.search(r"^\| `type` \| ([^|]*)\|", text[text.index("## [[joint]]"):], re.M).group(1)
    return set(re.findall(r'"(\w+)"', row))


def measured(root, program, reference):
    """Everything that costs time, once."""
    readme = (root / "README.md").read_text(encoding="utf-8")
    rows = re.findall(r"^\| (midpoint rule|lobatto\(\d+\)) \| ([\d,]+) \| (\S+) m \|", readme, re.M)
    errors = {}
    for name, count, _ in rows:
        method = 'family = "midpoint"' if "midpoint" in name else f'family = "lobatto"\ndegree = {name[8:-1]}'
        errors[name, count] = tip_error(root, program, method, int(count.replace(",", "")))
    published = {}
    if reference:
        said = run(reference, "--gtest_filter=Benchmarks.MeetThePublishedDigits")
        published = {name: float(error) for name, error in re.findall(r"^(P\d\d)\s+(\S+)$", said, re.M)}
    return {"errors": errors, "megabytes": report_megabytes(root, program), "joints": kinds_of_joints(program),
            "published": published}


def is_about(stated, error):
    return error / FACTOR <= stated <= error * FACTOR


def faults_of(readme, joints, validation, found):
    rows = re.findall(r"^\| (midpoint rule|lobatto\(\d+\)) \| ([\d,]+) \| (\S+) m \|", readme, re.M)
    if len(rows) < 4:
        yield "README.md: no table of errors of the two bricks"
    for name, count, stated in rows:
        error = found["errors"].get((name, count))
        if error is None or not is_about(float(stated), error):
            yield f"README.md: {name} with {count} states {stated} m, measured {error}"
    size = re.search(r"one file of ([\d.]+) MB", readme)
    if not size or abs(float(size.group(1)) - found["megabytes"]) > 0.05:
        yield f"README.md: a report of {found['megabytes']:.2f} MB"
    word = re.search(r"There are (\w+) joints", readme)
    if not word or WORDS.get(word.group(1)) != len(found["joints"]):
        yield f"README.md: {len(found['joints'])} kinds of joints"
    listed = set(re.findall(r"^\| `(\w+)` \| \d? ?\|", joints, re.M))
    if listed != found["joints"]:
        yield f"docs/joints.md: lists {sorted(listed ^ found['joints'])} too many or too few"
    for name, error in found["published"].items():
        row = re.search(rf"^\| `{name.lower()}_\w+` \|.*\| ([\d.e-]+) \| [\d.e-]+ \|$", validation, re.M)
        if row is None or not (is_about(float(row.group(1)), error) or max(float(row.group(1)), error) < 2e-13):
            yield f"docs/validation.md: {name} states {row and row.group(1)}, measured {error}"


def main():
    words = [word for word in sys.argv[1:] if word != "--controls"]
    root, program = pathlib.Path(words[0]).resolve(), pathlib.Path(words[1]).resolve()
    reference = pathlib.Path(words[2]).resolve() if len(words) > 2 else None
    texts = [(root / name).read_text(encoding="utf-8") for name in ("README.md", "docs/joints.md", "docs/validation.md")]
    found = measured(root, program, reference)
    if not found["joints"] or reference and len(found["published"]) < 5:
        sys.exit("nothing was measured")
    if "--controls" in sys.argv:
        stale = [(0, "| 4e-8 m |", "| 4e-9 m |"), (0, "eighteen joints", "seventeen joints"), (0, "0.8 MB", "0.6 MB"),
                 (1, "| `slot` |", "| `groove` |"), *([(2, "5e-13", "5e-15")] if reference else [])]
        missed = []
        for which, old, new in stale:
            changed = [text.replace(old, new) if number == which else text for number, text in enumerate(texts)]
            if changed == texts or not list(faults_of(*changed, found)):
                missed.append(f"not found: {old} as {new}")
        print("\n".join(missed) or f"all {len(stale)} stale statements were found")
        return bool(missed)
    faults = list(faults_of(*texts, found))
    print("\n".join(faults) or f"{len(found['errors']) + len(found['published']) + 3} statements hold")
    return bool(faults)


if __name__ == "__main__":
    sys.exit(main())
