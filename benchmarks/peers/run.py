# SPDX-License-Identifier: BSD-3-Clause
"""Sweeps the settings of every engine on every problem, times the best again side by side, and leaves all in
results.json, from which write.py makes the document: run.py [--quick | --loaded] [--fresh] [--engines a,b] [PROBLEM ...]

Every figure is processor time of one thread, the median of several repeats, of the solution alone: models are made
before. An error is the largest distance of the compared points from the reference at the end. Sweeps are kept in
sweep.json and go on where they ended; the figures that are compared come from one run, engines taking turns.
"""
import argparse
import datetime
import json
import math
import os
import pathlib
import platform
import re
import select
import signal
import statistics
import subprocess
import sys

import engines
import problems
import scenarios
import sizes

FLOOR = 4e-13        # m; a sweep needs no better
PLATEAU = 1e-3       # m; above, more work need not mean a smaller error
DIGITS = 5e-12       # to which published digits are met
ROUNDS = 3           # of the last timing
SLOW = 0.02          # s; what takes longer is timed less often


def variables(extra):
    """One thread; and numpy's kernels as they come, whatever this shell says."""
    kept = {k: v for k, v in os.environ.items() if not k.startswith(("OPENBLAS_", "LIVENS_"))}
    return {**kept, "OMP_NUM_THREADS": "1", "OPENBLAS_NUM_THREADS": "1", **extra}


class Process:
    """An engine at work, started when it is first asked and again after it was ended."""

    def __init__(self, engine):
        self.command, self.extra, self.patience = engine.command(), engine.variables, engine.patience
        self.child = self.told = None

    def ask(self, mechanism, setting, repeats):
        if self.child is None:
            self.child = subprocess.Popen(self.command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True,
                                          stderr=subprocess.DEVNULL, env=variables(self.extra), cwd=engines.PEERS)
        try:
            if self.told is not mechanism:
                self.child.stdin.write(mechanism.text())
                self.told = mechanism
            self.child.stdin.write(f"solve {setting} {repeats}\n")
            self.child.stdin.flush()
            answer = self.answer(300 if setting.startswith("reference") else self.patience)
        except BrokenPipeError:
            answer = {"failed": "it died"}
        if "points" not in answer and answer["failed"] in ("it died", "no answer"):
            self.end()
        return answer

    def answer(self, patience):
        if not select.select([self.child.stdout], [], [], patience)[0]:
            return {"failed": "no answer"}
        line = self.child.stdout.readline()
        return json.loads(line) if line else {"failed": "it died"}

    def end(self):
        if self.child:
            self.child.kill()
            self.child.wait()
        self.child = self.told = None


def error_of(answer, reference):
    return max(math.dist(a, b) for a, b in zip(answer["points"], reference)) if "points" in answer else math.inf


class Sweep:
    def __init__(self, store, chosen, fresh, share=1.0):
        """`share`: of the time after which the sweep of another engine ends."""
        self.store, self.share = store, share
        self.kept = json.loads(store.read_text()) if store.exists() and not fresh else {}
        self.engines = {name: e for name, e in engines.ENGINES.items()
                        if e.command() and (not chosen or name in chosen)}
        self.processes = {name: Process(e) for name, e in self.engines.items()}

    def reference(self, name, problem):
        key = f"{name} reference"
        if key not in self.kept:
            hand = Process(engines.ENGINES["hand"])
            way = list(problem.ways.values())[0]
            answer = hand.ask(way, f"reference:{problem.steps}", 1)
            hand.end()
            points = answer.get("points") or sys.exit(f"{name}: no reference, {answer['failed']}")
            if problem.digits and math.dist(points[-1], problem.digits) > DIGITS:
                sys.exit(f"{name}: the reference is not what was published")
            self.kept[key] = points
        return self.kept[key]

    def family(self, process, mechanism, reference, settings, cap, goal=(math.inf, 0)):
        """[(setting, error, seconds)] up to where it is good enough, too slow or no better any more; `goal`: an error, up to
        which it may take so many seconds."""
        found, best, idle, failure = [], math.inf, 0, ""
        for setting in settings:
            answer = process.ask(mechanism, setting, 2 if not found or found[-1][2] < SLOW else 1)
            error = error_of(answer, reference)
            if not error < 10:
                failure = answer.get("failed", failure)
                idle += 1
                if idle > 8 or failure == "no answer":
                    break
                continue
            found.append((setting, error, answer["seconds"]))
            idle = 0 if error < 0.8 * best or best > PLATEAU else idle + 1
            best = min(best, error)
            slower = len(found) > 1 and answer["seconds"] > found[-2][2]   # coarse elements can be slow, too
            most = cap if best <= goal[0] else max(cap, goal[1])
            if error < FLOOR or answer["seconds"] > most and slower or idle > 8:
                break
        return found, failure

    def engine(self, name, problem_name, problem):
        """All that was found: rows, and words where an engine has none."""
        key = f"{problem_name} {name}"
        if key in self.kept:
            return self.kept[key]
        engine, rows, failure = self.engines[name], [], ""
        goal = self.goal(problem_name) if name in engines.ASKED else (math.inf, 0)
        reference = self.reference(problem_name, problem)
        for way, mechanism in list(problem.ways.items())[:1 if engine.by_name else None]:
            n = len(mechanism.bodies)
            families = engine.families(n)
            if engine.like in self.engines:
                near = self.engine(engine.like, problem_name, problem)["rows"]
                families = [[row[1]] for row in near_best(near) if row[0] == way]
            for settings in families:
                found, words = self.family(self.processes[name], mechanism, reference, settings,
                                           (self.share if name in engines.ASKED else 1) *
                                           (0.3 if n < 10 else 0.5 if n < 50 else 1.5), goal)
                rows += [(way, *row) for row in found]
                failure = words or failure
            if engine.asked and problem.asked:
                rows += self.asked(name, way, mechanism, reference, {row[1] for row in rows if row[0] == way})
        if engine.refine and not engine.like:
            for way, setting, *_ in near_best(rows):
                for finer in engine.refine(setting):
                    found, _ = self.family(self.processes[name], problem.ways[way], reference, [finer], 0)
                    rows += [(way, *row) for row in found]
        self.kept[key] = {"rows": rows, "failed": "" if rows else failure}
        self.store.write_text(json.dumps(self.kept))
        return self.kept[key]

    def goal(self, problem_name):
        """What others are compared with: the error of livens where it is asked for an accuracy, and four times its time."""
        rows = [row for name in self.engines if self.engines[name].asked
                for row in self.kept.get(f"{problem_name} {name}", {"rows": []})["rows"]
                if float(row[1].partition(":")[2]) in engines.ASKED_LEVELS]
        return (max(FLOOR, min(row[2] for row in rows)), min(2.0, 4 * max(row[3] for row in rows))) if rows else (math.inf, 0)

    def asked(self, name, way, mechanism, reference, there):
        """What a sweep that was good enough, or slow, before did not come to."""
        found = []
        for setting in {f"{self.engines[name].asked}:{level:.0e}".replace("e-0", "e-") for level in engines.LEVELS} - there:
            answer = self.processes[name].ask(mechanism, setting, 1)
            if error_of(answer, reference) < 10:
                found.append((way, setting, error_of(answer, reference), answer["seconds"]))
        return found

    def end(self):
        for process in self.processes.values():
            process.end()


def best_at(rows, level, how_many):
    return sorted((row for row in rows if row[2] <= level), key=lambda row: row[3])[:how_many]


def near_best(rows):
    """Those of one of the levels, and of each half decade, that narrower instructions may favour."""
    levels = [10 ** (-k / 2) for k in range(4, 26)]
    chosen = {tuple(row) for level in levels for row in best_at(rows, level, 6)}
    return sorted(chosen)


def to_be_timed(rows, engine, errors):
    """The best few of every level, and at the errors of what livens was asked for; of that itself all that was asked."""
    if engine.asked:
        return {tuple(row) for row in rows if float(row[1].partition(":")[2]) in engines.LEVELS}
    few = {tuple(row) for level in engines.LEVELS for row in best_at(rows, level, 3)
           if row[3] < SLOW or row == best_at(rows, level, 1)[0]}
    return few | {tuple(row) for error in errors for row in best_at(rows, error, 2)}


def asked_errors(sweep, name, problem):
    """Of what livens was asked for, no smaller than a sweep looks for."""
    return {max(row[2], FLOOR) for engine in sweep.engines if engines.ENGINES[engine].asked
            for row in sweep.engine(engine, name, problem)["rows"]
            if float(row[1].partition(":")[2]) in engines.ASKED_LEVELS}


def timed(sweep, chosen, names):
    """The best few settings of every level once more, engines taking turns: {problem: {engine: rows}}."""
    again = {name: {} for name in names}
    for _ in range(ROUNDS):
        for name in names:
            reference, errors = sweep.reference(name, chosen[name]), asked_errors(sweep, name, chosen[name])
            for engine, process in sweep.processes.items():
                table = again[name].setdefault(engine, {})
                rows = sweep.engine(engine, name, chosen[name])["rows"]
                for way, setting, error, seconds in sorted(to_be_timed(rows, engines.ENGINES[engine], errors)):
                    if seconds > 10 * SLOW and (way, setting) in table:
                        continue
                    answer = process.ask(chosen[name].ways[way], setting, 15 if seconds < SLOW / 4 else 5 if seconds < SLOW else 2)
                    if "seconds" in answer:
                        table.setdefault((way, setting), []).append((error_of(answer, reference), answer["seconds"]))
    return {name: {engine: [(*key, values[-1][0], statistics.median(seconds for _, seconds in values))
                            for key, values in table.items()] for engine, table in tables.items()}
            for name, tables in again.items()}


def machine():
    model = re.search(r"^model name\s*:\s*(.*)$", pathlib.Path("/proc/cpuinfo").read_text(), re.M)
    return {"processor": model.group(1) if model else platform.processor(), "cores": os.cpu_count(),
            "date": datetime.date.today().isoformat(),
            "load": max(0, os.getloadavg()[0] - 1)}   # of others, once the sweeps are over


def versions():
    ask = "import importlib.metadata as m, sys; print(m.version(sys.argv[1]))"
    found = {}
    for name, engine in engines.ENGINES.items():
        for module in engine.modules:
            said = subprocess.run([str(engines.PYTHON), "-c", ask, module], capture_output=True, text=True)
            if said.returncode == 0:
                found[name] = said.stdout.strip()
    said = subprocess.run(["dpkg-query", "-W", "-f", "${Version}", "libsimbody-dev"], capture_output=True, text=True)
    if said.returncode == 0 and said.stdout:
        found["simbody"] = said.stdout.split("+")[0]
    return found


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("problems", nargs="*", metavar="PROBLEM")
    parser.add_argument("--quick", action="store_true", help="P16 and one chain")
    parser.add_argument("--loaded", action="store_true", help="what people have, and what is asked for an accuracy")
    parser.add_argument("--fresh", action="store_true", help="forget earlier sweeps")
    parser.add_argument("--engines", default="", help="only these, by comma")
    parser.add_argument("--no-sizes", action="store_true", help="without the rows of time and memory")
    options = parser.parse_args()
    table = problems.table()
    names = options.problems or [n for n, p in table.items() if (p.asked if options.loaded else p.quick or not options.quick)]
    unknown = set(names) - set(table)
    if unknown:
        parser.error(f"no problem {', '.join(sorted(unknown))}; there are {', '.join(table)}")
    engines.PEERS.mkdir(parents=True, exist_ok=True)
    for name in names:
        for mechanism in table[name].ways.values():
            scenarios.write(mechanism, engines.PEERS / "scenarios")
    few = [n for n, e in engines.ENGINES.items() if e.for_loaded] if options.loaded else []
    sweep = Sweep(engines.PEERS / ("loaded.json" if options.loaded else "sweep.json"),
                  [e for e in options.engines.split(",") if e] or few, options.fresh, 0.3 if options.loaded else 1.0)
    signal.signal(signal.SIGTERM, lambda *_: sys.exit(1))
    try:
        for name in names:
            for engine in sweep.engines:
                found = sweep.engine(engine, name, table[name])
                print(f"{name}: {engine}, {len(found['rows'])} settings {found['failed']}", flush=True)
        results = {"machine": machine(), "versions": versions(), "rounds": ROUNDS, "timed": timed(sweep, table, names),
                   "swept": {n: {e: sweep.engine(e, n, table[n]) for e in sweep.engines} for n in names}}
    finally:
        sweep.end()   # some would work on for long
    results["corners"] = sizes.corners()
    if not options.no_sizes and not options.loaded:
        results["sizes"] = sizes.measured()
    (engines.PEERS / "results.json").write_text(json.dumps(results, indent=1))
    print(f"wrote {(engines.PEERS / 'results.json').relative_to(engines.ROOT)}")


if __name__ == "__main__":
    main()
