# SPDX-License-Identifier: BSD-3-Clause
"""What the two scans of laws share: what is asked for, runs under a limit of processor time, what is counted.

A case has `kind`, `laws`, `number`, `text` (a scenario without [time] and [method]), `end` and truth(), which
gives what scans.errors asks of a true motion and leaves what that is off itself in `error`, in m or rad.

    told        the estimated error of a run that is called converged
    missed      it was asked for an accuracy, and is off by more than three of them
    third       off by more than three times what it tells (errors above LEAST)
    tenth       off by more than ten times that plus SLIP
    refused     asked for an accuracy: not converged, suspect, or not ready after LIMIT s of processor time
    input       refused before it is solved
    untold      the truth is not known to a tenth of what is asked or told: counted apart
"""
import collections
import concurrent.futures
import json
import math
import os
import pathlib
import shutil
import subprocess
import tempfile
import tomllib

import laws
import paper
import scans

LIMIT = 20        # s of processor time
LEAST = 2e-11     # lengths, rad: smaller errors are those of numbers
SLIP = 1e-9
FALSE_ALARM = 1e-3
OVER = "over the limit"
BLIND = "looks = false\n"


def arguments(parser):
    parser.add_argument("--seed", type=int, default=1, help="other laws")
    parser.add_argument("--count", type=int, help="how many, instead of all")
    parser.add_argument("--kind", action="append", help="of this kind alone; may stand again")


def takes_other_families(text):
    """Whether mixed and the classical rules can solve it: rows of joints are quadratic, nothing is driven, no
    body is a lamina."""
    content = tomllib.loads(text)
    flat = any(max(body["inertia"][:3]) >= sum(body["inertia"][:3]) / 2 for body in content["body"]
               if "inertia" in body)
    return not flat and "drive" not in content and not any(
        joint["type"] in ("slot", "screw", "gear", "rack") for joint in content.get("joint", ()))


def asked(c, end, accuracies, text):
    """[time] and [method] of a scenario: to an accuracy, mostly, or on a mesh that is stated."""
    time, method = {"end": end}, {}
    if c.chance(0.12):
        time["output"] = float(f"{end / c.randint(2, 9):.3g}")
    if c.chance(0.65):
        time["accuracy"] = c.log(*accuracies, digits=2)
        if c.chance(0.12):
            method["family"] = "radau"
        elif c.chance(0.2):
            method |= {"family": "lobatto", "degree": c.randint(2, 12)}
    else:
        time["elements"] = int(c.log(5, 61))
        method |= {"family": "radau", "degree": c.randint(2, 8)} if c.chance(0.3) else \
            {"family": "lobatto", "degree": c.randint(2, 12)}
        if c.chance(0.3) and takes_other_families(text):
            method = {"family": c.choice(("midpoint", "endpoint", "mixed"))}   # of low order
            time["elements"] *= int(c.log(1, 40))
    return time, method


def blind(text):
    """The same scenario, its laws taken for smooth."""
    head, method, rest = text.partition("[method]\n")
    return head + (method or "\n[method]\n") + BLIND + rest


def solve(program, text, folder):
    """(exit code, figures, path of the result); under the limit."""
    (folder / "run.toml").write_text(text, encoding="utf-8")
    process = subprocess.run(
        ["sh", "-c", f'ulimit -t {LIMIT}; exec "$@"', "sh",
         program, "solve", "run.toml", "-o", "run.nc", "--json", "-q"],
        cwd=folder, capture_output=True, text=True, check=False)
    if process.returncode in scans.RUNS:
        return process.returncode, json.loads(process.stdout), folder / "run.nc"
    if process.returncode in (-9, -24, 137, 152):
        return OVER, {}, None
    return process.returncode, {"message": process.stderr.partition("\n")[0]}, None


def judged(case, text, code, figures, path, motion):
    """One row."""
    content = tomllib.loads(text)
    time, method = content["time"], content.get("method", {})
    row = {"kind": case.kind, "laws": " ".join(case.laws), "number": case.number,
           "accuracy": time.get("accuracy"), "elements": figures.get("elements"),
           "method": figures.get("method", ""),
           "exit": code, "told": figures.get("estimated_error"),
           "true": math.inf, "truth": math.nan, "seconds": figures.get("solve_seconds", 0) +
           figures.get("estimate_seconds", 0), "message": figures.get("message", OVER)}
    length = figures.get("model_length")
    if motion is None or path is None or not length:   # 4, before there is an estimate
        return row
    run = paper.Run(figures, code, path)
    try:
        times, errors = scans.errors_everywhere(run, motion, length)
    finally:
        run.file.close()
    horizon = figures["horizon"]
    row["true"] = float(errors[times < horizon if horizon is not None else slice(None)].max(initial=0))
    row["truth"] = case.error / min(length, 1)
    return row


def run_all(e, cases, note=100):
    """Rows of (case, text), each text solved while the truth of others is found."""
    rows = []
    with tempfile.TemporaryDirectory(prefix="livens-laws-") as scratch, \
            concurrent.futures.ThreadPoolExecutor(len(os.sched_getaffinity(0))) as pool:
        def launch(item):
            return solve(e.livens, item[1], pathlib.Path(tempfile.mkdtemp(dir=scratch)))
        for (case, text), done in zip(cases, pool.map(launch, cases)):
            if not hasattr(case, "motion"):
                try:
                    case.motion = case.truth()
                except laws.NoTruth as why:
                    case.motion = None
                    e.remark(f"{case.kind} {case.number}: no truth, {why}")
            rows.append(judged(case, text, *done, case.motion))
            if done[2] is not None:
                shutil.rmtree(done[2].parent)
            if note and len(rows) % note == 0:
                scans.so_far(e, f"{len(rows)} of {len(cases)} runs")
    return rows


# ---------------------------------------------------------------- counts

def is_untold(row):
    """Called converged, and the truth does not say whether it is so."""
    if row["exit"] != paper.CONVERGED:
        return False
    need = min(row["accuracy"] or math.inf, max(row["true"], LEAST))
    return not row["truth"] <= need / 10


def is_converged(row):
    return row["exit"] == paper.CONVERGED and not is_untold(row)


def is_missed(row):
    return is_converged(row) and row["accuracy"] is not None and row["true"] > 3 * row["accuracy"]


def is_third(row):
    return is_converged(row) and row["true"] > LEAST and row["true"] > 3 * row["told"]


def is_tenth(row):
    return is_converged(row) and row["true"] > 10 * row["told"] + SLIP


def is_refused(row):
    return row["accuracy"] is not None and row["exit"] != paper.CONVERGED


def is_over(row):
    return row["exit"] == OVER


def is_false_alarm(row):
    return row["accuracy"] is None and row["exit"] != paper.CONVERGED and row["true"] <= FALSE_ALARM


def is_input(row):
    """Refused before it is solved."""
    return row["exit"] not in (*scans.RUNS, OVER)


COUNTS = {"missed": is_missed, "third": is_third, "tenth": is_tenth,
          "refused": is_refused, "over": is_over, "input": is_input, "false alarm": is_false_alarm,
          "untold": is_untold}


def by_kind(rows, kinds_of=lambda row: [row["kind"]]):
    """A line each: how many, and the worst, by what was asked or told; a row may be of several kinds."""
    kinds = collections.defaultdict(list)
    for row in rows:
        for kind in kinds_of(row):
            kinds[kind].append(row)
    table = []
    for kind, mine in kinds.items():
        good = [row for row in mine if is_converged(row)]
        asked = [row["true"] / row["accuracy"] for row in good if row["accuracy"]]
        told = [row["true"] / max(row["told"], 1e-300) for row in good if row["true"] > LEAST]
        table.append({"kind": kind, "runs": len(mine),
                      "to an accuracy": sum(row["accuracy"] is not None for row in mine),
                      **{name: sum(map(test, mine)) for name, test in COUNTS.items()},
                      "by accuracy": max(asked, default=0.0),
                      "by second": max(told, default=0.0),
                      "seconds": sum(row["seconds"] for row in mine)})
    return table


def laws_of(row):
    return row["laws"].split()


def show(table):
    """As text, in columns."""
    lines = [list(table[0])] + [[f"{x:.3g}" if isinstance(x, float) else str(x) for x in row.values()]
                                for row in table]
    widths = [max(len(line[i]) for line in lines) for i in range(len(lines[0]))]
    return "\n".join("  ".join(f"{text:>{width}}" for text, width in zip(line, widths)) for line in lines)


def keep(e, cases, rows, folder="failed"):
    """Scenarios of what failed, each with what was told and is true, beside the data."""
    place = e.output / folder
    shutil.rmtree(place, ignore_errors=True)
    for (case, text), row in zip(cases, rows):
        faults = [name for name, test in COUNTS.items() if test(row)]
        if faults:
            place.mkdir(exist_ok=True)
            head = ("# {}: asked {accuracy}, told {told}, true {true:.3g} (truth to {truth:.1g}), "
                    "exit {exit} {message}\n").format(", ".join(faults), **row)
            name = f"{case.kind}_{case.number}.toml".replace(" ", "_")
            (place / name).write_text(head + text, encoding="utf-8")


def tables(e, rows, name):
    """By kind, and by law where a case has several: printed, and beside the data."""
    kinds = by_kind(rows) + by_kind([row | {"kind": "all"} for row in rows])
    laws_too = by_kind(rows, laws_of) if any(len(laws_of(row)) > 1 for row in rows) else []
    e.table(kinds + laws_too, f"{name}.csv")
    print(show(kinds + laws_too))
    return {count: kinds[-1][count] for count in COUNTS}


def judge(e, cases, rows):
    """Expectations, counted over all; failures kept."""
    e.table(rows)
    keep(e, cases, rows)
    counts = tables(e, rows, "kinds")
    known = [row for row in rows if is_converged(row)]
    e.expect("runs", len(rows))
    e.expect("called converged", sum(row["exit"] == paper.CONVERGED for row in rows))
    e.expect("accuracy missed by more than three", counts["missed"])
    e.expect("told below a tenth of the truth and 1e-9", counts["tenth"])
    e.expect("refused before they are solved", counts["input"])
    if not e.short:   # shares of few say nothing
        e.expect("told below a third of the truth, share", counts["third"] / max(len(known), 1))
        e.expect("refused, of those to an accuracy, share",
                 counts["refused"] / max(sum(row["accuracy"] is not None for row in rows), 1))
    e.expect("false alarms on stated meshes, of all, share", counts["false alarm"] / len(rows))
    e.expect("truth not known well enough, share", counts["untold"] / len(rows))


def scan(e, cases):
    judge(e, cases, run_all(e, cases))
    if e.short:
        return
    # The same with no look at laws inside elements: wrong ones must be seen.
    blinded = [(case, blind(text)) for case, text in cases]
    rows = run_all(e, blinded)
    e.table(rows, "without_looks.csv")
    keep(e, cases, rows, "failed_without_looks")
    tables(e, rows, "kinds_without_looks")
    e.expect("wrong without the looks", sum(is_missed(row) or is_third(row) for row in rows))
