#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Random faults in the sources: how many does the fast suite notice?

    random_mutants.py FOLDER [--count 60] [--seed 8] [--jobs 2]      works in FOLDER, which may be new
    random_mutants.py FOLDER --show N                                the diff of mutant N

FOLDER/source is a copy of the last commit with a release build of its own. A mutant is one change of one line of a .cpp
file under src/livens or apps/livens, drawn by lines: an operator, a constant, a condition, a statement left out. What
does not compile is drawn again. ninja rebuilds what the file is part of; the programs of the fast suite run one after
the other, those of the file's room first, until one fails. A crash or ten times the usual time is a failure.

FOLDER/results.jsonl holds a line a mutant; a stopped trial goes on where it was. At the end: the share of mutants that
were noticed, and the diffs of all others. Headers are left out: each would rebuild everything.
"""
import argparse
import collections
import difflib
import json
import os
import pathlib
import random
import re
import signal
import subprocess
import sys
import time

ROOT = pathlib.Path(__file__).resolve().parents[2]
NOT_CODE = re.compile(r'''R"([^(\s]*)\(.*?\)\1" | "(?:\\.|[^"\\\n])*" | '(?:\\.|[^'\\\n])+' | //[^\n]*
                          | /\*.*?\*/ | ^[ \t]*\#[^\n]*''', re.S | re.X | re.M)
SWAPS = {" + ": " - ", " - ": " + ", " * ": " / ", " / ": " * ", " += ": " -= ", " -= ": " += ", " < ": " <= ",
         " <= ": " < ", " > ": " >= ", " >= ": " > ", " == ": " != ", " != ": " == ", " && ": " || ", " || ": " && ",
         "++": "--", "true": "false", "false": "true"}
SWAP = re.compile("|".join(r"\b%s\b" % s if s.isalpha() else re.escape(s) for s in SWAPS))
NUMBER = re.compile(r"(?<![\w.'])(\d+(?:\.\d*)?(?:e[-+]?\d+)?)(?![\w.'])")
CONDITION = re.compile(r"\b(?:if|while) \((.+)\)(?= [\w{*(]|$)")
# An assignment or a call for its effect; no declaration and no return.
STATEMENT = re.compile(r"^\s+(?!return\b|throw\b|const\b|auto\b|using\b|break\b|continue\b|case\b|else\b|struct\b)"
                       r"[\w.:>\[\]()*&-]+(?:\(.*\)| [-+*/]?= .*);$")


def code_of(text):
    """The text with strings, comments and directives blanked, lines and columns as they were."""
    text = re.sub(r"(?<=\d)'(?=\d)", "_", text)
    return NOT_CODE.sub(lambda m: re.sub(r"[^\n]", " ", m.group(0)), text)


def changes_of(line, code):
    """All that can be done to a line: (what, the new line)."""
    def put(begin, end, new):
        return line[:begin] + new + line[end:]

    for m in SWAP.finditer(code):
        yield "operator", put(*m.span(), SWAPS[m.group(0)])
    for m in NUMBER.finditer(code):
        old = m.group(1)
        yield "constant", put(*m.span(), str(int(old) + 1) if old.isdigit() else f"2 * {old}" if float(old) else "1.0")
    for m in CONDITION.finditer(code):
        yield "condition", put(*m.span(1), f"!({line[m.start(1):m.end(1)]})")
    if STATEMENT.match(code.rstrip()) and code.count("(") == code.count(")"):
        yield "statement", line[:len(line) - len(line.lstrip())] + ";"


def draw(root, seed, number, attempt):
    """(file, line number from 0, what, old line, new line); the same for the same numbers and sources."""
    dice = random.Random(f"{seed} {number} {attempt}")
    files = sorted(p for folder in ("src/livens", "apps/livens") for p in (root / folder).rglob("*.cpp"))
    texts = {p: p.read_text() for p in files}
    weights = [texts[p].count("\n") for p in files]
    while True:
        path = dice.choices(files, weights)[0]
        lines, codes = texts[path].split("\n"), code_of(texts[path]).split("\n")
        at = dice.randrange(len(lines))
        is_dead = not codes[at].strip() or "assert(" in codes[at]   # a release build has none
        changes = [] if is_dead else list(changes_of(lines[at], codes[at]))
        if not changes:
            continue
        kinds = sorted({what for what, _ in changes})
        kind = dice.choice(kinds)
        what, new = dice.choice([c for c in changes if c[0] == kind])
        return path, at, what, lines[at], new


class Trial:
    def __init__(self, folder, jobs):
        self.folder, self.jobs = folder, jobs
        self.source, self.build = folder / "source", folder / "source" / "build" / "mutants"

    def run(self, command, seconds=None, **options):
        """Exit status and output; a time-out ends the whole group of processes and counts as 1."""
        process = subprocess.Popen([str(c) for c in command], stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
                                   start_new_session=True, cwd=self.source, **options)
        try:
            out, _ = process.communicate(timeout=seconds)
            return process.returncode, out.decode(errors="replace")
        except subprocess.TimeoutExpired:
            os.killpg(process.pid, signal.SIGKILL)
            process.communicate()
            return 1, "time-out"

    def prepare(self):
        if not self.source.exists():
            self.source.mkdir(parents=True)
            archive = subprocess.Popen(["git", "-C", ROOT, "archive", "HEAD"], stdout=subprocess.PIPE)
            subprocess.run(["tar", "x", "-C", self.source], stdin=archive.stdout, check=True)
            archive.wait()
        status, out = self.run(["cmake", "-S", ".", "-B", self.build, "-G", "Ninja", "-DCMAKE_BUILD_TYPE=Release",
                                "-DLIVENS_SLOW_TESTS=OFF"])
        if status == 0:
            status, out = self.make()
        if status != 0:
            sys.exit(out)
        self.tests = self.fast_tests()

    def make(self):
        return self.run(["cmake", "--build", self.build, "-j", self.jobs])

    def fast_tests(self):
        """{name: (command, environment, usual seconds)}; all tests of a GoogleTest program are run at once."""
        _, out = self.run(["ctest", "--test-dir", self.build, "-L", "fast", "--show-only=json-v1"])
        tests = {}
        for test in json.loads(out[out.index("{"):])["tests"]:
            command = test["command"]
            if any(part.startswith("--gtest_filter") for part in command):
                command = command[:1]
            properties = {p["name"]: p["value"] for p in test["properties"]}
            environment = dict(v.split("=", 1) for v in properties.get("ENVIRONMENT", []))
            name = pathlib.Path(command[0]).name if len(command) == 1 else test["name"]
            if not name.startswith("layout."):   # they look at the text, and would notice any
                tests[name] = (command, environment)
        usual = {}
        known = self.folder / "usual.json"
        if known.exists():
            usual = json.loads(known.read_text())
        for name, (command, environment) in tests.items():
            if name not in usual:
                begin = time.monotonic()
                status, out = self.run(command, env={**os.environ, **environment})
                if status not in (0, 77):
                    sys.exit(f"{name} fails without any fault:\n{out}")
                usual[name] = time.monotonic() - begin
                known.write_text(json.dumps(usual))
        return {name: (*test, usual[name]) for name, test in tests.items()}

    def order(self, path):
        """The room's own tests first, then by time."""
        room = path.parts[2] if path.parts[0] == "src" else "program"
        near = {"stepping": "convergence", "diagnostics": "unit_spacetime", "program": "system."}.get(room, room)
        return sorted(self.tests, key=lambda n: (not n.startswith(f"unit_{room}"), near not in n, self.tests[n][2]))

    def judge(self, path, at, new):
        """('uncompilable' | 'killed' | 'survived', by what)."""
        whole = self.source / path
        text = whole.read_text()
        lines = text.split("\n")
        lines[at] = new
        try:
            whole.write_text("\n".join(lines))
            if self.make()[0] != 0:
                return "uncompilable", ""
            for name in self.order(path):
                command, environment, usual = self.tests[name]
                if "gtest" in " ".join(command) or len(command) == 1:
                    command = [*command, "--gtest_fail_fast"]
                status, _ = self.run(command, 20 + 10 * usual, env={**os.environ, **environment})
                if status not in (0, 77):
                    return "killed", name
            return "survived", ""
        finally:
            whole.write_text(text)


def diff(path, at, old, new, source):
    lines = (source / path).read_text().split("\n")
    changed = [*lines[:at], new, *lines[at + 1:]]
    return "\n".join(difflib.unified_diff(lines, changed, str(path), str(path), n=2, lineterm=""))


def report(results, source):
    kinds = collections.Counter(r["verdict"] for r in results)
    survivors = [r for r in results if r["verdict"] == "survived"]
    for r in survivors:
        print(f"\nmutant {r['number']}, {r['what']}:")
        print(diff(r["file"], r["line"], r["old"], r["new"], source))
    n = kinds["killed"] + kinds["survived"]
    print(f"\n{kinds['killed']} of {n} noticed ({100 * kinds['killed'] / max(1, n):.0f} %)")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folder", type=pathlib.Path)
    parser.add_argument("--count", type=int, default=60)
    parser.add_argument("--seed", type=int, default=8)
    parser.add_argument("--jobs", type=int, default=2)
    parser.add_argument("--show", type=int)
    parser.add_argument("--draw", action="store_true", help="the diffs of all mutants, without a trial")
    options = parser.parse_args()
    signal.signal(signal.SIGINT, signal.default_int_handler)   # a shell's background would hand on that it is ignored
    trial = Trial(options.folder.resolve(), options.jobs)
    if options.draw or options.show is not None:
        for number in range(options.count) if options.draw else [options.show]:
            path, at, what, old, new = draw(ROOT, options.seed, number, 0)
            print(f"\nmutant {number}, {what}:\n{diff(path.relative_to(ROOT), at, old, new, ROOT)}")
        return
    trial.prepare()
    log = trial.folder / "results.jsonl"
    results = [json.loads(line) for line in log.read_text().splitlines()] if log.exists() else []
    done = {r["number"] for r in results}
    for number in (n for n in range(options.count) if n not in done):
        verdict, attempt = "uncompilable", 0
        while verdict == "uncompilable":
            path, at, what, old, new = draw(trial.source, options.seed, number, attempt)
            path = path.relative_to(trial.source)
            verdict, by = trial.judge(path, at, new)
            attempt += 1
        results.append({"number": number, "verdict": verdict, "by": by, "what": what, "file": str(path), "line": at,
                        "old": old, "new": new})
        with log.open("a") as file:
            file.write(json.dumps(results[-1]) + "\n")
        print(f"{number}: {path}:{at + 1} {what}: {verdict} {by}", flush=True)
    report(results, trial.source)


if __name__ == "__main__":
    main()
