# SPDX-License-Identifier: BSD-3-Clause
"""The program on a terminal: what people see at which width, what is proposed to them, what shells complete.

    LIVENS_PROGRAM=build/release/livens python3 terminal_test.py [CLASS ...]

Transcripts are compared with tests/system/transcripts; LIVENS_WRITE_TRANSCRIPTS=1 writes them anew.
"""
import fcntl
import json
import math
import os
import pty
import re
import shutil
import signal
import struct
import subprocess
import termios
import time
import unittest

from program_test import (IO, LONG, NOT_CONVERGED, PROGRAM, SCENARIO, SMALL, SOURCE, SUSPECT, USAGE, ProgramTest,
                          text_with)

TRANSCRIPTS = SOURCE / "tests" / "system" / "transcripts"

BAD = SMALL.replace("density = 1000", "densty = 1000").replace("mass = 0.5", "mass = -1").replace(
    '["brick", "bob"]', '["brick", "bop"]')
COARSE = SMALL.replace("end = 0.5", "end = 2").replace('family = "lobatto"\ndegree = 4', 'family = "endpoint"').replace(
    "shape = { point = true }\nmass = 0.5", "shape = { sphere = 0.1 }\ndensity = 100")
FAILING = SMALL.replace("end = 0.5\nelements = 10\noutput = 0.1", "end = 50\nelements = 1").replace(
    'family = "lobatto"\ndegree = 4', 'family = "midpoint"\nmax_iterations = 1')
ESCAPE = re.compile(r"\x1b\[[0-9;]*m")


def on_terminal(test, columns, *arguments, interrupt_after=None, **variables):
    """What a terminal of this width shows, and the exit code; Ctrl-C is pressed after so many lines of progress."""
    try:
        terminal, inner = pty.openpty()
    except OSError as error:   # a root without /dev/pts
        test.skipTest(f"no pseudo-terminal to be had: {error}")
    fcntl.ioctl(inner, termios.TIOCSWINSZ, struct.pack("HHHH", 24, columns, 0, 0))
    kept = {k: v for k, v in os.environ.items() if k not in ("NO_COLOR", "COLUMNS", "LC_CTYPE", "LANG")}
    program = subprocess.Popen([PROGRAM, *map(str, arguments)], cwd=test.folder, stdin=inner, stdout=inner, stderr=inner,
                               env={**kept, "LC_ALL": "C.UTF-8", "TERM": "xterm", **variables})
    os.close(inner)
    seen = b""
    try:
        while chunk := os.read(terminal, 65536):
            seen += chunk
            if interrupt_after is not None and seen.count(b"\r\x1b[K") >= interrupt_after:
                program.send_signal(signal.SIGINT)
                interrupt_after = None
    except OSError:   # how Linux says that the other end is closed
        pass
    os.close(terminal)
    return seen.decode().replace("\r\n", "\n"), program.wait(60)


class Transcripts(ProgramTest):
    """Stored as seen with colours, at three widths; without colours it is the same without escapes."""

    def transcript(self, name, code, *arguments):
        shown = ""
        for columns in (40, 80, 120):
            coloured, status = on_terminal(self, columns, *arguments)
            self.assertEqual(status, code, coloured)
            text = self.masked(coloured)
            for option in ({"NO_COLOR": "1"}, {"TERM": "dumb"}):
                plain, status = on_terminal(self, columns, *arguments, **option)
                self.assertEqual((self.masked(plain), status), (ESCAPE.sub("", text), code))
            plain, status = on_terminal(self, columns, *arguments, "--color", "never")
            self.assertEqual(self.masked(plain), ESCAPE.sub("", text))
            shown += f"=== {columns} columns\n" + text.replace("\x1b", "\\e")
        self.compare(name, shown)

    def masked(self, text):
        """Seconds and figures that are rounding differ from machine to machine, but not in width.

        Progress, which only a run longer than a tenth of a second shows, is wiped away as a terminal would.
        """
        text = re.sub(r"(\r\x1b\[K[^\r]*)*\r\x1b\[K", "", text)
        text = re.sub(r"motion in [0-9.e-]+(\s+)s", r"motion in #\1s", text)
        text = re.sub(r"(iterations\s*(?:\x1b\[0m)?\s*)(\d+(?: \([0-9.]+)?)",
                      lambda m: m[1] + re.sub(r"\d", "#", m[2]), text)
        text = re.sub(r"\d+(\s+factorisations?)", r"#\1", text)
        return re.sub(r"\d\.\de[-+]\d\d", "#.#e-##", text)

    def compare(self, name, shown):
        file = TRANSCRIPTS / f"{name}.txt"
        if os.environ.get("LIVENS_WRITE_TRANSCRIPTS"):
            TRANSCRIPTS.mkdir(exist_ok=True)
            file.write_text(shown)
        self.assertEqual(shown, file.read_text())

    def test_solve(self):
        self.write("small.toml", SMALL)
        self.transcript("solve", 0, "solve", "small.toml")

    def test_suspect(self):
        self.write("coarse.toml", COARSE)
        self.transcript("suspect", SUSPECT, "solve", "coarse.toml")

    def test_not_converged(self):
        self.write("failing.toml", FAILING)
        self.transcript("not_converged", NOT_CONVERGED, "solve", "failing.toml")

    def test_errors(self):
        self.write("bad.toml", BAD)
        self.transcript("errors", SCENARIO, "check", "bad.toml")

    def test_usage(self):
        self.transcript("usage", USAGE, "sovle", "small.toml")

    def test_explain(self):
        self.transcript("explain", 0, "explain", "inertia-triangle")

    def test_info(self):
        self.solve(SMALL)
        self.transcript("info", 0, "info", "run.nc", "-v")

    def test_diff(self):
        self.solve(SMALL, output="a.nc")
        self.solve(SMALL.replace("-9.81", "-9.9"), output="b.nc")
        self.transcript("diff", 1, "diff", "a.nc", "b.nc")


class Looks(ProgramTest):
    def test_files_and_pipes_get_plain_words(self):
        self.write("small.toml", SMALL)
        self.write("bad.toml", BAD)
        for colour in ("auto", "never"):
            done = self.expect(0, "solve", "small.toml", "--color", colour)
            self.assertTrue(done.out.isascii() and "\x1b" not in done.out)
            self.assertTrue(done.out.startswith("+ Converged: "))
            self.assertNotIn("\x1b", self.expect(SCENARIO, "check", "bad.toml", "--color", colour).err)
        self.assertIn("\x1b", self.expect(0, "solve", "small.toml", "--color", "always").out)
        self.assertIn("\x1b", self.expect(0, "solve", "small.toml", "--color=always",
                                          env={**os.environ, "NO_COLOR": "1"}).out)
        self.assertIn("\x1b", self.expect(SCENARIO, "check", "bad.toml", "--color", "always").err)
        self.expect(USAGE, "solve", "small.toml", "--color", "sometimes")

    def test_signs_follow_the_locale(self):
        self.write("small.toml", SMALL)
        for locale, sign in (("C.UTF-8", "\u2713"), ("de_DE.utf8", "\u2713"), ("C", "+"), ("POSIX", "+")):
            text, _ = on_terminal(self, 80, "solve", "small.toml", "--color", "never", LC_ALL=locale)
            self.assertTrue(text.startswith(sign + " Converged"), text)

    def test_columns_wins_over_the_terminal(self):
        self.write("small.toml", SMALL)
        text, _ = on_terminal(self, 120, "solve", "small.toml", COLUMNS="50")
        self.assertLessEqual(max(len(ESCAPE.sub("", line)) for line in text.splitlines()), 50)
        wide = self.expect(0, "solve", "small.toml").out
        narrow = self.expect(0, "solve", "small.toml", env={**os.environ, "COLUMNS": "50"}).out
        self.assertGreater(len(narrow.splitlines()), len(wide.splitlines()))

    def test_progress_never_wraps(self):
        self.write("long.toml", LONG)
        for columns in (20, 40, 70, 120):
            text, code = on_terminal(self, columns, "solve", "long.toml", interrupt_after=5)
            self.assertEqual(code, 130, text)
            lines = [part for part in text.split("\r\x1b[K") if " %" in part]
            self.assertGreater(len(lines), 3)
            for line in lines[1:-1]:   # the first may come before any element is done
                self.assertLess(len(line), columns)
                self.assertNotIn("\n", line)
                self.assertEqual("residual" in line, columns == 120, line)
                self.assertEqual("to go" in line, columns > 15, line)

    def test_digits_are_said_until_they_are_lost(self):
        """A motion that grows errors: what is said first agrees with the errors in the file, and with a finer run."""
        text = (SOURCE / "examples" / "double_pendulum_offset.toml").read_text()
        text = re.sub(r"^output.*\n", "", text, flags=re.M)
        for name, elements in (("run", 480), ("fine", 720)):
            time = f"end = 24\nelements = {elements}"
            self.write(f"{name}.toml", re.sub(r"^end = .*\nelements = .*", time, text, flags=re.M))
        first = self.expect(0, "solve", "run.toml").out.split("\n")[0]
        found = re.search(r"good to (\d+) digits through ([0-9.]+) s, then (\d+)", first)
        self.assertIsNotNone(found, first)
        self.assertIn(found[0], self.expect(0, "info", "run.nc").out)
        digits, until, last = int(found[1]), float(found[2]), int(found[3])
        figures = json.loads(self.expect(0, "info", "run.nc", "--json").out)
        self.assertEqual((figures["good_digits"], figures["good_until"]), (digits, until))
        self.assertGreater(digits, last)
        self.run_program("solve", "fine.toml")
        worst = {}
        for t in (until, 24.0):
            query = ("--body", "lower", "--at", str(t), "--json")
            run, fine = (json.loads(self.expect(0, "sample", f"{name}.nc", *query).out) for name in ("run", "fine"))
            worst[t] = math.dist(run["center_of_mass"], fine["center_of_mass"]) / figures["model_length"]
            self.assertLess(run["estimated_position_error"], 10.0 ** -(digits if t == until else last))
        self.assertLess(worst[until], 3 * 10.0**-digits)   # estimates are within a factor of three
        self.assertGreater(worst[24.0], 10.0**-digits)

    def test_more_with_verbose(self):
        self.write("small.toml", SMALL)
        short, long = (self.expect(0, "solve", "small.toml", *v).out for v in ((), ("-v",)))
        for word in ("zig-zag", "residual"):
            self.assertNotIn(word, short)
            self.assertIn(word, long)

    def test_reasons_stand_in_one_place(self):
        self.write("coarse.toml", COARSE)
        piped = self.expect(SUSPECT, "solve", "coarse.toml")
        self.assertIn("livens: error: ", piped.err)
        self.assertTrue(piped.out.startswith("? Suspect: "))
        text, _ = on_terminal(self, 120, "solve", "coarse.toml", "--color", "never")
        self.assertNotIn("livens: error", text)
        self.assertIn("because", text)

    def test_last_lines(self):
        self.write("bad.toml", BAD)
        last = self.expect(SCENARIO, "check", "bad.toml").err.splitlines()[-1]
        self.assertRegex(last, r"^bad\.toml: \d errors; for more: livens explain [a-z-]+$")
        self.assertNotIn("for more", self.expect(SCENARIO, "check", "bad.toml", "--diagnostics", "gnu").err)
        self.write("one.toml", text_with("density =", "# density ="))
        self.assertIn("one.toml: 1 error; ", self.expect(SCENARIO, "check", "one.toml").err)
        self.write("a b.toml", SMALL)
        step = self.expect(0, "solve", "a b.toml").out.splitlines()[-1]
        self.assertTrue(step.startswith("next: livens "))
        done = subprocess.run(step.replace("next: livens", f"'{PROGRAM}'", 1), shell=True, cwd=self.folder,
                              stdout=subprocess.DEVNULL, stderr=subprocess.PIPE)
        self.assertEqual((done.returncode, done.stderr), (0, b""), step)


class Meant(ProgramTest):
    def test_proposals(self):
        for arguments, proposal in (
            (("sovle", "x"), "no command 'sovle'; did you mean 'solve'?"),
            (("chekc",), "did you mean 'check'?"),
            (("solve", "small.toml", "--jsn"), "'livens solve' has no option '--jsn'; did you mean '--json'?"),
            (("solve", "small.toml", "--ouput=x.nc"), "did you mean '--output'?"),
            (("solve", "--quite"), "did you mean '--quiet'?"),
            (("sample", "run.nc", "--boddy", "bob", "--at", "0"), "did you mean '--body'?"),
            (("--versoin",), "did you mean '--version'?"),
            (("--json", "info", "run.nc"), "follows the command 'info'"),
            (("frobnicate",), "no command 'frobnicate'; 'livens --help' lists them"),
            (("check", "a.toml", "b.toml"), "cannot use 'b.toml'"),
            (("explain", "unknown-kye"), "did you mean 'unknown-key'?"),
        ):
            self.assertIn(proposal, self.expect(USAGE, *arguments).err, arguments)

    def test_a_file_may_be_called_like_a_command(self):
        self.write("info", SMALL)
        self.expect(0, "check", "info")


class Begin(ProgramTest):
    def test_init_solves_at_once_and_overwrites_nothing(self):
        self.assertIn("livens solve pendulum.toml", self.expect(0, "init").out)
        self.expect(0, "check", "pendulum.toml")
        self.assertEqual(json.loads(self.expect(0, "solve", "pendulum.toml", "--json").out)["status"], "converged")
        text = self.write("pendulum.toml", "mine").read_text()
        self.assertIn("it is there already", self.expect(IO, "init").err)
        os.symlink("nowhere.toml", self.folder / "link.toml")
        self.expect(IO, "init", "link.toml")
        self.assertEqual((self.folder / "pendulum.toml").read_text(), text)
        made = json.loads(self.expect(0, "init", "a b", "--json").out)["scenario"]
        self.assertEqual(made, "a b.toml")
        self.expect(0, "solve", made, "-q")
        self.assertIn("cannot write", self.expect(IO, "init", "missing/x").err)
        self.assertEqual(self.expect(0, "init", "other", "-q").out, "")

    def test_diff(self):
        self.solve(output="a.nc")
        self.solve(SMALL.replace("degree = 4", "degree = 8"), output="fine.nc")
        self.solve(SMALL.replace("[1, 0, -1]", "[1, 0, -1.25]").replace("output = 0.1", "output = 0.25"), output="other.nc")
        same = json.loads(self.expect(0, "diff", "a.nc", "a.nc", "--json", "--rtol", "0", "--atol", "0").out)
        self.assertEqual((same["same"], same["output_times"], same["only_in_one"]), (True, 6, []))
        self.expect(0, "diff", "a.nc", "fine.nc", "--rtol", "1e-3")
        self.expect(1, "diff", "a.nc", "fine.nc", "--rtol", "0", "--atol", "0")
        different = json.loads(self.expect(1, "diff", "a.nc", "other.nc", "--json").out)
        self.assertEqual((different["output_times"], different["exit_code"]), (2, 1))   # 0 and 0.5
        bob = next(b for b in different["bodies"] if b["name"] == "bob")
        self.assertEqual(bob["position"]["unit"], "m")
        self.assertGreaterEqual(bob["position"]["difference"], 0.25)
        ends = [json.loads(self.expect(0, "sample", run, "--body", "bob", "--at", str(bob["position"]["time"]),
                                       "--json").out)["position"] for run in ("a.nc", "other.nc")]
        self.assertAlmostEqual(bob["position"]["difference"], sum((a - b) ** 2 for a, b in zip(*ends)) ** 0.5)
        self.assertEqual(bob["orientation"]["difference"], 0)   # a point has none

    def test_angles_are_those_of_the_rotation(self):
        turned = SMALL.replace("position = [1, 0, 0]\n", 'position = [1, 0, 0]\nrotation_vector = [0, 0, "30 deg"]\n')
        self.solve(output="a.nc")
        self.solve(turned.replace("angular_velocity = [0, 0, 2]\n", "angular_velocity = [0, 0, 2]\n"), output="b.nc")
        result = json.loads(self.expect(1, "diff", "a.nc", "b.nc", "--json").out)
        brick = result["bodies"][0]
        self.assertGreaterEqual(brick["orientation"]["difference"], 0.5235987)
        self.assertEqual(brick["orientation"]["unit"], "rad")

    def test_diff_of_strangers(self):
        self.solve(output="a.nc")
        self.solve(SMALL.replace('"bob"', '"rob"'), output="b.nc")
        result = json.loads(self.expect(1, "diff", "a.nc", "b.nc", "--json").out)
        self.assertEqual(result["only_in_one"], ["bob", "rob"])
        self.solve(SMALL.replace("end = 0.5", "start = 1\nend = 1.5"), output="later.nc")
        self.assertIn("no output time in common", self.expect(USAGE, "diff", "a.nc", "later.nc").err)
        for tolerance in ("-1", "nan", "x"):
            self.expect(USAGE, "diff", "a.nc", "a.nc", "--rtol=" + tolerance)
        self.expect(IO, "diff", "a.nc", "missing.nc")


class Completion(ProgramTest):
    def complete(self, *words):
        script = ('source <("$0" completion bash); COMP_WORDS=("$@"); COMP_CWORD=$(($# - 1)); _livens; '
                  'printf "%s\\n" "${COMPREPLY[@]}"')
        done = subprocess.run(["bash", "--norc", "-c", script, PROGRAM, PROGRAM, *words], cwd=self.folder,
                              stdout=subprocess.PIPE, stderr=subprocess.PIPE, check=True)
        self.assertEqual(done.stderr, b"")
        return done.stdout.decode().split("\n")[:-1]

    def setUp(self):
        super().setUp()
        if shutil.which("bash") is None:
            self.skipTest("bash is not installed")

    def test_bash(self):
        self.solve(SMALL.replace('"bob"', '"small bob"'))
        (self.folder / "sub").mkdir()
        for words, expected in (
            (("so",), ["solve"]),
            (("solve", "--col"), ["--color"]),
            (("solve", "--color", ""), ["auto", "always", "never"]),
            (("solve", "--color", "=", "al"), ["always"]),
            (("solve", "--diagnostics", "="), ["human", "json", "gnu"]),
            (("solve", ""), ["sub", "small.toml"]),
            (("info", ""), ["sub", "run.nc"]),
            (("solve", "small.toml", "-o", "r"), ["run.nc"]),
            (("sample", "run.nc", "--body", ""), ["brick", "small\\ bob"]),
            (("sample", "run.nc", "--body", "b"), ["brick"]),
            (("sample", "run.nc", "--joint", ""), ["upper", "lower"]),
            (("sample", "missing.nc", "--body", ""), [""]),
            (("explain", "inertia-t"), ["inertia-triangle"]),
            (("completion", ""), ["bash", "zsh", "fish"]),
            (("sample", "run.nc", "--at", ""), [""]),
        ):
            self.assertEqual(self.complete(*words), expected, words)
        commands = self.complete("")
        listed = re.findall(r"^  ([a-z]+) {3,}", self.expect(0, "--help").out.split("Subcommands:")[1], re.M)
        self.assertEqual(commands, listed)
        for command in commands:   # the same options as --help
            in_help = set(re.findall(r"--[a-z]+", self.expect(0, command, "--help").out.split("Options:")[1]))
            offered = {word for word in self.complete(command, "--") if word.startswith("--")}
            self.assertLessEqual(offered, in_help)
            self.assertGreaterEqual(len(offered), 2)

    def check_syntax(self, shell):
        if shutil.which(shell) is None:
            self.skipTest(f"{shell} is not installed")
        script = self.write("script", self.expect(0, "completion", shell).out)
        done = subprocess.run([shell, "-n", script], stdout=subprocess.PIPE, stderr=subprocess.STDOUT)
        self.assertEqual((done.returncode, done.stdout), (0, b""))

    def test_bash_syntax(self):
        self.check_syntax("bash")

    def test_zsh_syntax(self):
        self.check_syntax("zsh")

    def test_fish_syntax(self):
        self.check_syntax("fish")

    def test_a_shell_is_needed(self):
        self.expect(USAGE, "completion")
        self.expect(USAGE, "completion", "tcsh")

    def test_manual_page(self):
        page = self.write("livens.1", self.expect(0, "man").out)
        self.assertTrue(page.read_text().isascii())
        ways = [way for way in (["man", "--warnings", "-E", "UTF-8", "-l"], ["groff", "-man", "-Tutf8", "-ww"],
                                ["mandoc", "-T", "lint"]) if shutil.which(way[0])]
        if not ways:
            self.skipTest("neither man, groff nor mandoc is installed")
        for way in ways:
            done = subprocess.run([*way, str(page)], stdout=subprocess.PIPE, stderr=subprocess.PIPE,
                                  env={**os.environ, "MANWIDTH": "100", "MANPAGER": "cat", "LC_ALL": "C.UTF-8"})
            self.assertEqual((done.returncode, done.stderr), (0, b""), way)
            if way[0] == "man":
                text = done.stdout.decode()
                for word in ("livens solve", "--diagnostics", "NO_COLOR", "EXIT STATUS", "130, 143"):
                    self.assertIn(word, text)


class HardEnds(ProgramTest):
    def test_tolerance_below_rounding(self):
        for family in ("lobatto", "mixed"):
            text = SMALL.replace('family = "lobatto"\ndegree = 4', f'family = "{family}"')
            self.assertEqual(self.solve(text)["notes"], [])
            notes = self.solve(text + "tolerance = 1e-30\n")["notes"]
            self.assertTrue(any("1e-30 is below rounding" in note for note in notes), notes)

    def test_limits_of_iterations_are_named(self):
        for limit, words in ((1, "in 1 iteration, the limit"), (2, "in 2 iterations, the limit")):
            text = FAILING.replace("max_iterations = 1", f"max_iterations = {limit}")
            text = text.replace("shape = { point = true }\nmass = 0.5", "shape = { sphere = 0.1 }\ndensity = 100")
            self.assertIn(words, self.solve(text, code=NOT_CONVERGED)["message"])
        spring = ('[[load]]\ntype = "spring"\nbetween = ["world", "brick"]\npoints = [[3, 0, 0], [0, 0, 0]]\n'
                  "stiffness = 1e7\nfree_length = 1\n")
        leap = SMALL[:SMALL.index('[[body]]\nname = "bob"')] + spring + "[time]\nend = 50\nelements = 1\n"
        for limit, is_diverging in ((2, True), (3, False)):
            text = leap + f'[method]\nfamily = "midpoint"\nmax_iterations = {limit}\n'
            message = self.solve(text, code=NOT_CONVERGED)["message"]
            self.assertEqual("still diverging" in message, is_diverging, message)

    def test_ctrl_c_is_heard_while_condition_numbers_are_computed(self):
        text = SMALL.replace("end = 0.5\nelements = 10\noutput = 0.1", "end = 50\nelements = 30000")
        self.write("long.toml", text + "condition = true\n")
        for seconds in (1, 2, 4, 8, 16):   # solving must be over by then
            program = subprocess.Popen([PROGRAM, "solve", "long.toml", "-o", "run.nc", "--json"], cwd=self.folder,
                                       stdout=subprocess.PIPE, stderr=subprocess.PIPE)
            time.sleep(seconds)
            program.send_signal(signal.SIGINT)
            out, err = program.communicate(timeout=100)
            result = json.loads(out)
            if "condition numbers" in result["message"]:
                break
        self.assertEqual(program.returncode, 130, err)
        self.assertIn("the motion is complete", result["message"])
        self.assertEqual((result["status"], result["end"], result["condition_1"]), ("cancelled", 50, None))
        self.expect(0, "info", "run.nc")

    def test_ctrl_c_ends_all_of_several(self):
        text = SMALL.replace("end = 0.5\nelements = 10\noutput = 0.1", "end = 1000\nelements = 600000")
        for name in ("one.toml", "two.toml"):
            self.write(name, text)
        for seconds in (0.5, 1, 2, 4):   # the first must be begun, and not done yet
            (self.folder / "one.nc").unlink(missing_ok=True)
            program = subprocess.Popen([PROGRAM, "solve", "one.toml", "two.toml", "-j", "1", "--json", "-v"],
                                       cwd=self.folder, stdout=subprocess.PIPE, stderr=subprocess.PIPE)
            time.sleep(seconds)
            program.send_signal(signal.SIGINT)
            out, _ = program.communicate(timeout=100)
            one, two = json.loads(out) if out else ({"status": None}, {"status": None})
            if one["status"] == "cancelled" and "begun" not in one["message"]:
                break
        self.assertEqual(program.returncode, 130)
        self.assertEqual((one["status"], two["status"]), ("cancelled", "cancelled"))
        self.assertIn("before it was begun", two["errors"][0]["message"])
        self.assertTrue((self.folder / "one.nc").exists())
        self.assertFalse((self.folder / "two.nc").exists())

    def test_signals_after_solving_change_the_exit_code_alone(self):
        for number in (signal.SIGINT, signal.SIGTERM):
            for elements in (2000, 8000, 30000, 100000):   # checks must not end before the signal, nor outlast what they are given then
                self.write("long.toml", SMALL.replace("end = 0.5\nelements = 10\noutput = 0.1", f"end = 50\nelements = {elements}")
                           .replace("degree = 4", "degree = 4\nestimate = \"none\""))
                program = subprocess.Popen([PROGRAM, "solve", "long.toml", "-o", "run.nc", "--json", "-v"], cwd=self.folder,
                                           stdout=subprocess.PIPE, stderr=subprocess.PIPE)
                while b"solved in" not in program.stderr.readline():   # it is being checked now
                    self.assertIsNone(program.poll())
                program.send_signal(number)
                out, _ = program.communicate(timeout=100)
                result = json.loads(out)
                if result["exit_code"] != 0:   # else it came when that was said
                    break
            self.assertEqual(program.returncode, 128 + number)
            self.assertEqual((result["status"], result["exit_code"], result["end"]), ("converged", 128 + number, 50))
            self.assertEqual(json.loads(self.expect(0, "info", "run.nc", "--json").out)["status"], "converged")


if __name__ == "__main__":
    unittest.main()
