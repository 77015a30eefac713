# SPDX-License-Identifier: BSD-3-Clause
"""Measures the times that documents state, and takes over what the scans have counted: record.py PROGRAM [SCANS [PAPER]]
       record.py --paper PAPER | --accuracies SCANS | --laws SCANS | --reported SCANS | --instructions OUTPUT | --run_time OUTPUT
                 | --work OUTPUT

Writes benchmarks/recorded.json, with machine and date; tests/docs/figures.py holds README.md, docs/validation.md and docs/trust.md
against it. SCANS: the folder in which scripts/scan left its data (build/scan), PAPER: that of scripts/paper (build/paper); without them what
was recorded of them stays. With an option nothing else is taken over: --instructions reads what `scripts/instructions` and
`scripts/instructions chains` have printed to one file, --work what benchmarks/accuracies.py has, whose
table in docs/trust.md is made anew, --run_time what benchmarks/paper has: elements and errors, which no other work changes.
Times are the least of several runs of solve() alone, each on one core; of long ones, which other work on the machine interrupts, the
processor's share. Of scans of laws and of reported cases the rows of tables are printed, as docs/trust.md has them. Standard library only.
"""
import csv
import datetime
import json
import os
import pathlib
import re
import resource
import statistics
import subprocess
import sys
import tempfile
import time

ROOT = pathlib.Path(__file__).resolve().parents[1]
RECORD = ROOT / "benchmarks/recorded.json"
BRICKS = [("midpoint rule", 12800), ("lobatto(2)", 2560), ("lobatto(4)", 320), ("lobatto(8)", 40), ("lobatto(8)", 80)]
ENOUGH = 4.0        # s of repeats, or MOST of them
MOST = 100
LONG = 0.3          # s
COARSE = [("chain_with_spring", 10, 12), ("rocker_in_space", 14, 8)]   # degree, elements: see docs/trust.md
BURSTS = "light_above_heavy"
LEVELS = "fig09_action_integral"


def bricks(method, elements):
    """The scenario of README.md's table."""
    family = 'family = "midpoint"' if "midpoint" in method else f'family = "lobatto"\ndegree = {method[8:-1]}'
    head = (ROOT / "examples/ball_pendulum_two.toml").read_text(encoding="utf-8").split("[time]")[0]
    return head + f'[time]\nend = 2\nelements = {elements}\noutput = 2\n[method]\n{family}\nestimate = "none"\n'


def seconds(program, scenario, keys):
    found, spent = [], 0.0
    processor = lambda: resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime   # noqa: E731
    with tempfile.TemporaryDirectory() as folder:
        while not found or spent < ENOUGH and len(found) < MOST:
            began, used = time.monotonic(), processor()
            done = subprocess.run([program, "solve", scenario, "-o", f"{folder}/run.nc", "--json"], capture_output=True, text=True,
                                  check=False)   # a coarse mesh may be suspect
            figures = json.loads(done.stdout)
            took = time.monotonic() - began
            share = min(1, (processor() - used) / took) if sum(figures[key] for key in keys) > LONG else 1
            found.append(share * sum(figures[key] for key in keys))
            spent += took
    return float(f"{min(found):.3g}")


def times(program):
    record = {"bricks_ms": {}, "published_s": {}}
    with tempfile.TemporaryDirectory() as folder:
        for method, elements in BRICKS:
            scenario = pathlib.Path(folder, "bricks.toml")
            scenario.write_text(bricks(method, elements), encoding="utf-8")
            record["bricks_ms"][f"{method}, {elements}"] = float(f"{1e3 * seconds(program, scenario, ['solve_seconds']):.3g}")
    for file in sorted((ROOT / "examples/benchmarks").glob("*.toml")):
        record["published_s"][file.stem] = seconds(program, file, ["solve_seconds", "estimate_seconds"])
    return record


def rows_of(folder, name):
    verdict = json.loads((folder / name / "verdict.json").read_text(encoding="utf-8"))
    if verdict["short"]:
        sys.exit(f"{folder / name}: a short scan")
    with (folder / name / "data.csv").open(newline="", encoding="utf-8") as file:
        return list(csv.DictReader(file)), {entry["name"]: entry["seen"] for entry in verdict["expectations"]}


def meshes(folder):
    rows, seen = rows_of(folder, "scan_meshes")
    others = seen["examples: runs"]   # the first ones are the seven examples
    record = {}
    for kind, part in (("examples", rows[:others]), ("others", rows[others:])):
        ends = [int(row["exit"]) for row in part]
        record[kind] = {
            "runs": len(part), "converged": ends.count(0), "suspect": ends.count(7), "not converged": ends.count(4),
            "wrong": seen[f"{kind}: called converged, and off by more than ten estimates or 0.02"],
            "false alarms": round(seen[f"{kind}: false alarms, of all runs"] * len(part)),
            "wrong by a thousandth": seen[f"{kind}: wrong ones that would be seen, were estimates a thousandth"],
            "resolved": seen[f"{kind}: resolved"],
            "resolved, in estimates": round(seen[f"{kind}: resolved, the largest error in estimates"], 3)}
    record["pass without an estimate"] = round(seen["wrong runs that would pass without an estimate, of all"], 3)
    record["coarse"] = {row["mechanism"]: [float(f"{float(row[key]):.2g}") for key in ("error", "estimate")] for row in rows
                        if (row["mechanism"], int(row["degree"]), int(row["elements"])) in COARSE}
    return record


def accuracies(folder):
    rows, seen = rows_of(folder, "scan_accuracy")
    record = {"off": seen["off by more than three accuracies before the horizon"],
              "estimates within 5": round(seen["estimate within a factor of 5, share"], 4),
              "not reached": [f"{row['problem']} {row['times']} {float(row['accuracy']):g}" for row in rows if row["exit"] != "0"]}
    for kind in ("without output", "with output"):
        part = [row for row in rows if row["times"] == kind and row["problem"] != BURSTS]
        record[kind] = {"motions": len(part)}
        for key in ("work", "work_in_all"):
            costs = [float(row[key]) for row in part if row["exit"] == "0"]
            tenths = statistics.quantiles(costs, n=10, method="inclusive")
            record[kind][key] = [round(x, 2) for x in (statistics.median(costs), tenths[-1], max(costs))]
    rough = [row for row in rows if row["exit"] == "0" and row["problem"] == BURSTS]
    smooth = [row for row in rows if row["exit"] == "0" and row["problem"] != BURSTS]
    record["refused"] = {name: float(f"{value:.2g}") for name, value in (
        ("largest", max(float(row["refused_share"]) for row in smooth)),
        ("largest with bursts", max(float(row["refused_share"]) for row in rough)),
        ("of all", sum(int(row["refused"]) for row in smooth) / sum(int(row["refused"]) + int(row["elements"]) for row in smooth)))}
    record["second tries"] = sum(int(row["tries"]) > 1 for row in rows)
    record["above six"] = sum(row["exit"] == "0" and row["problem"] != BURSTS and float(row["work_in_all"]) > 6 for row in rows)
    record["bursts"] = sum(row["problem"] == BURSTS for row in rows)
    return record


LAW_SCANS = ("laws", "law_mechanisms")
COUNTS = ("runs", "to an accuracy", "missed", "third", "tenth", "refused", "over", "false alarm", "untold")


def laws(folder):
    """Of both scans of laws: counts by kind or law and of all, with the worst; what is wrong without the looks."""
    record = {}
    for name in LAW_SCANS:
        rows, seen = rows_of(folder, f"scan_{name}")
        with (folder / f"scan_{name}" / "kinds.csv").open(newline="", encoding="utf-8") as file:
            kinds = {row["kind"]: {key: int(row[key]) for key in COUNTS} |
                     {f"worst {key}": float(f"{float(row[key]):.2g}") for key in ("by accuracy", "by second")}
                     for row in csv.DictReader(file)}
        ends = [row["exit"] for row in rows]
        record[name] = {"converged": ends.count("0"),
                        "wrong without the looks": seen["wrong without the looks"], "kinds": kinds}
    return record


def law_rows(record, name):
    """Rows of the table of docs/trust.md: runs, to an accuracy, missed, third, tenth, refused, worst by accuracy, by estimate."""
    for kind, counts in record[name]["kinds"].items():
        cells = [counts[key] for key in ("runs", "to an accuracy", "missed", "third", "tenth", "refused")]
        cells += [f"{counts[key]:.2g}" for key in ("worst by accuracy", "worst by second")]
        yield f"| {kind.replace('_', ' ')} | {' | '.join(map(str, cells))} |"


def law_words(record, name):
    """What the page says of one scan beside its table."""
    whole = record[name]["kinds"]["all"]
    return [f"{record[name]['converged']} of {whole['runs']} runs were called converged",
            f"{whole['over']} took more than 20 s (with an accuracy {'they are' if whole['over'] > 1 else 'it is'} among the refused), "
            f"{whole['untold']} had no sufficiently accurate reference solution, "
            f"{whole['false alarm']} on given meshes were suspect and right to 1e-3",
            f"with `looks` off, {record[name]['wrong without the looks']} are wrong"]


def reported(folder):
    """Cases that were told wrong once, as they stand and to the other accuracies: asked, elements, exit, told, true."""
    rows, seen = rows_of(folder, "scan_reported")
    figure = lambda text: float(f"{float(text):.2g}") if text else None   # noqa: E731
    record = {"runs": seen["runs"], "wrong": seen["off by more than three times what is told, or asked for"],
              "wrong without the looks": seen["wrong without the looks"], "cases": {}}
    for row in rows:
        record["cases"].setdefault(row["case"], [figure(row["asked"]), int(row["exit"]), figure(row["told"]), figure(row["true"])])
    return record


def reported_rows(record):
    """Rows of the table of docs/trust.md: asked, exit, told, true."""
    for name, (asked, left, told, true) in record["reported"]["cases"].items():
        yield f"| {name.replace('_', ' ')} | {asked or 'elements'} | {left} | {told if told is not None else '-'} | {true if true is not None else '-'} |"


def paper(folder):
    """What the experiments of the paper have judged, to five digits: experiment -> expectation -> number.
    Of figure 9 the table of data.csv too: method -> h -> what is in its columns."""
    record = {}
    for file in sorted(folder.glob("*/verdict.json")):
        verdict = json.loads(file.read_text(encoding="utf-8"))
        if verdict["short"] or not verdict["passed"]:
            sys.exit(f"{file}: short, or not as expected")
        record[verdict["experiment"]] = {entry["name"]: float(f"{entry['seen']:.5g}") for entry in verdict["expectations"]
                                         if isinstance(entry["seen"], (int, float)) and not isinstance(entry["seen"], bool)}
        if verdict["experiment"] == LEVELS:
            with file.with_name("data.csv").open(newline="", encoding="utf-8") as table:
                for row in csv.DictReader(table):
                    for column in ("inside", "starts", "ends", "steps"):
                        record[LEVELS][f"{row['method']}, h = {float(row['h']):g}: {column}"] = float(f"{float(row[column]):.5g}")
    return record or sys.exit(f"{folder}: no verdicts; scripts/paper makes them")


def instructions(output):
    """Thousands of instructions: kernel, or chain and bodies -> [counted, steps of an element, if it is a chain]."""
    text = pathlib.Path(output).read_text(encoding="utf-8")
    record = {name.strip(): [float(n) * (1e3 if unit == "M" else 1)]
              for name, n, unit in re.findall(r"(?m)^(\S.*?)  +([\d.]+) ([kM]) +[\d.]+ [kM] +[\d.]+ +\d\S*$", text)}
    chains = re.findall(r"(?m)^(\w+) +(\d+) +(\d+) +([\d.]+) k +[\d.]+ k +[\d.]+$", text)
    record |= {f"{kind} {bodies}": [float(n), int(steps)] for kind, bodies, steps, n in chains}
    return record if len(chains) > 10 and len(record) > len(chains) else sys.exit(f"{output}: kernels or chains are missing, or over")


TRUST, WORK = ROOT / "docs/trust.md", ("<!-- work -->", "<!-- end of work -->")


def work(output):
    """Motion -> millions of instructions: bare, with the accuracy, with all that follows. Writes the table of docs/trust.md."""
    rows = re.findall(r"(?m)^(\w+) +([\d.]+) +([\d.]+) +([\d.]+) +[\d.]+ +[\d.]+ {3}", pathlib.Path(output).read_text(encoding="utf-8"))
    record = {name: [float(f"{float(n):.3g}") for n in numbers] for name, *numbers in rows}
    if len(record) < 8:
        sys.exit(f"{output}: not what benchmarks/accuracies.py prints")
    text = TRUST.read_text(encoding="utf-8")
    before, after = text.partition(WORK[0])[0], text.partition(WORK[1])[2]
    TRUST.write_text(f"{before}{WORK[0]}\n" + "\n".join(work_rows(record)) + f"\n{WORK[1]}{after}", encoding="utf-8")
    return record


def work_rows(record):
    """Of docs/trust.md."""
    yield "| motion | bare, millions | to an accuracy, over bare | with all, over bare |"
    yield "| --- | --- | --- | --- |"
    for name, (bare, accuracy, everything) in record.items():
        yield f"| {name.replace('_', ' ')} | {bare:g} | {accuracy / bare:.1f} | {everything / bare:.1f} |"
    over = [[row[k] / row[0] for row in record.values()] for k in (1, 2)]
    yield f"| median, largest | | {' | '.join(f'{statistics.median(x):.1f}, {max(x):.1f}' for x in over)} |"


def run_time(output):
    """Method -> elements or steps, error (P26)."""
    rows = re.findall(r"(?m)^(\S.*?) {2,}(\d+) +(\S+e-\d+) +\S+e-\d+ +[\d.]+ +\d+$", pathlib.Path(output).read_text(encoding="utf-8"))
    return {name: [int(n), float(error)] for name, n, error in rows} if len(rows) > 4 else sys.exit(f"{output}: not what benchmarks/paper prints")


def machine(program):
    names = [line.partition(":")[2].strip() for line in pathlib.Path("/proc/cpuinfo").read_text(encoding="utf-8").splitlines()
             if line.startswith("model name")]
    version = subprocess.run([program, "version"], capture_output=True, text=True, check=True).stdout.split()[1]
    return {"processor": names[0] if names else "unknown", "cores": os.cpu_count(), "load before": round(os.getloadavg()[0], 1),
            "date": datetime.date.today().isoformat(), "version": version}


def write(record):
    RECORD.write_text(json.dumps(record, indent=1, ensure_ascii=False) + "\n", encoding="utf-8")
    print(f"wrote {RECORD.relative_to(ROOT)}")


def main():
    if sys.argv[1].startswith("--"):
        record, source = json.loads(RECORD.read_text(encoding="utf-8")), pathlib.Path(sys.argv[2])
        if sys.argv[1] == "--accuracies":
            record["scans"]["accuracies"] = accuracies(source)
        elif sys.argv[1] == "--laws":
            record["scans"] |= laws(source)
            for name in LAW_SCANS:
                print("\n".join([*law_rows(record["scans"], name), *law_words(record["scans"], name)]))
        elif sys.argv[1] == "--reported":
            record["scans"]["reported"] = reported(source)
            print("\n".join(reported_rows(record["scans"])))
        else:
            record[sys.argv[1][2:]] = {"--paper": paper, "--instructions": instructions, "--run_time": run_time, "--work": work}[sys.argv[1]](source)
        return write(record)
    program = str(pathlib.Path(sys.argv[1]).resolve())
    record = json.loads(RECORD.read_text(encoding="utf-8")) if RECORD.exists() else {}
    record["machine"] = machine(program)
    record["times"] = times(program)
    if len(sys.argv) > 2:
        folder = pathlib.Path(sys.argv[2])
        record["scans"] = {"date": record["machine"]["date"], "meshes": meshes(folder), "accuracies": accuracies(folder),
                           **laws(folder), "reported": reported(folder)}
    if len(sys.argv) > 3:
        record["paper"] = paper(pathlib.Path(sys.argv[3]))
    return write(record)


if __name__ == "__main__":
    if len(sys.argv) not in (2, 3, 4):
        sys.exit(__doc__)
    main()
