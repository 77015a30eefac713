# SPDX-License-Identifier: BSD-3-Clause
"""Runs the code blocks of README.md and of the pages for people, and compares what comes out. Standard library only.

    blocks.py ROOT [--python] [--write] [PAGE...]
    blocks.py ROOT --controls          pages with one fault each, every one of which must be found

Each page is run from top to bottom in a folder of its own, which has copies of the examples and looks like a checkout that was
built: its scripts, presets and build/release are links. HOME is this folder too.

    toml      a first line `# NAME.toml` names the file that it becomes, and `livens check` must like it; one that begins with
              `format` is scenario.toml. With
              `<!-- with: NAME.toml -->` before it, it is a part that is put into that file: tables of the same name give
              way, and the whole is checked.
    sh        runs under `bash -eu`, with the program on the path; `<!-- exit: N -->` before it: ends with N. Stand-ins for what
              takes minutes or is not here: STAND_INS
    console   `$ COMMAND` and what it writes, on a terminal of 100 columns; colours are left out
    python    with --python, in this interpreter, all blocks of a page one after the other. With `<!-- with: NAME.toml -->`
              before it, `m` is the model of that file, and must become the one that the block of TOML above makes of it
    cpp       compiled and run against the build tree; without a main() it is the inside of one. A first line `// NAME.cpp` names
              the file that it becomes for the blocks behind; `# CMakeLists.txt` that of `cmake`
    text      right behind one of these: what came out. Numbers may differ by one in the last digit that is shown, or by 1e-9
              of themselves, those that are rounding (below 1e-10) by a factor of thirty, counts of iterations by a tenth
              (the sums of another processor's vectors round otherwise); seconds of computing are not compared
    `<!-- not run: WHY -->`   before a block that cannot run here; each is told
    `<!-- run by: FILE -->`   before one that FILE, a test, takes out of the page and runs; it names the page
    `<!-- synopsis -->`       before a list of commands: all there are, and each option is one

--write puts what comes out into the text blocks. LIVENS_PROGRAM names the program.
"""
from __future__ import annotations

import argparse
import contextlib
import fcntl
import io
import os
import pathlib
import pty
import re
import shutil
import struct
import subprocess
import sys
import tempfile
import termios
import traceback

BLOCK = re.compile(r"(?:^<!-- (with|exit|not run|run by|synopsis)(?:: (.*?))? -->\n)?^```(\w*)\n(.*?)^```[ \t]*$", re.M | re.S)
RUN = ("toml", "sh", "python", "cpp", "cmake", "console")
CHECKOUT = ("scripts", "examples", "experiments", "CMakePresets.json")
STAND_INS = r"""
livens() {   # a server serves until it is told to stop: here for a moment
    if [ "$1" = view ]; then timeout 3 livens "$@" --address > view.log 2>&1 || [ $? = 124 ]; else command livens "$@"; fi
}
scripts/demo() { LIVENS=$(command -v livens) command scripts/demo "$@" > demo.log 2>&1 || { cat demo.log; return 1; }; }   # builds nothing
scripts/test() { local option; for option; do grep -q "^ *$option) " scripts/test || return 1; done; }   # what runs this
scripts/check() { local room; for room; do grep -q "^rooms=.*[( ]$room[ )]" scripts/check || return 1; done; }   # builds: here only whether there are such rooms
scripts/setup() { [ -x scripts/setup ] && grep -q "^    ${1:-test}) " scripts/setup; }
scripts/paper() { LIVENS=$(command -v livens) command scripts/paper --list "$@" > list.log; }   # minutes: here only whether there is what is named
scripts/scan() { LIVENS=$(command -v livens) command scripts/scan --list "$@" > list.log; }
scripts/peers() {   # an hour, and engines from the network: here only whether there are such options
    local said; said=$(command scripts/peers --help)
    for option; do grep -q -e "^  $option " <<< "$said" || return 1; done
}
preset() { command cmake --list-presets="$1" | grep -q "^  \"$2\""; }
cmake() {   # minutes: here only whether there is such a preset
    case "$1 $2" in
        "--preset "*) preset configure "$2" ;;
        "--build --preset") preset build "$3" ;;
        *) command cmake "$@" > cmake.log 2>&1 || { cat cmake.log; return 1; } ;;
    esac
}
ctest() { [ "$1" = --preset ] && preset test "$2"; }
sbatch() {   # Slurm: each job of --array=A-B here, one after the other
    [[ $1 == --array=* && $2 == --wrap ]] || return 1
    local range=${1#--array=} job
    for job in $(seq "${range%-*}" "${range#*-}"); do SLURM_ARRAY_TASK_ID=$job bash -euo pipefail -c "$3"; done
}
"""
DOCUMENTS = ("tutorial", "install", "joints", "python", "scenario", "program", "results", "performance", "paper", "trust", "theory",
             "examples", "notation", "validation", "architecture")
TYPES = ("joints", "loads", "drives", "sensors")   # a page for each type
ESCAPES = re.compile(r"\x1b\[[0-9;?]*[A-Za-z]|\x1b\][^\x07\x1b]*(?:\x07|\x1b\\)")
NUMBER = re.compile(r"(?<![\w.])[-−]?\d+(?:\.\d*)?(?:e[-+]?\d+)?(?![\w])")
ROUNDING = 1e-10
SECONDS = re.compile(r"(of motion in|in) [0-9.e-]+ s\b")


def pages_of(root: pathlib.Path) -> list[pathlib.Path]:
    return [root / "README.md", root / "CONTRIBUTING.md", *(root / f"docs/{name}.md" for name in DOCUMENTS),
            *(page for folder in ("howto", "coming_from", *TYPES) for page in sorted((root / "docs" / folder).glob("*.md")))]


def same(shown: str, came: str) -> bool:
    """Line by line; `...` alone in a line stands for any lines."""
    clean = lambda text: [SECONDS.sub(r"\1 # s", re.sub(r"\s+", " ", line.strip())) for line in text.strip().split("\n")]   # noqa: E731
    parts, rest = [[]], clean(came)
    for line in clean(shown):
        if line == "...":
            parts.append([])
        else:
            parts[-1].append(line)
    at = 0
    for number, part in enumerate(parts):
        starts = [0] if number == 0 else range(at, len(rest) - len(part) + 1)
        if number == len(parts) - 1 and part:
            starts = [len(rest) - len(part)] if number or len(rest) == len(part) else []
        found = next((k for k in starts if k >= at and len(rest) >= k + len(part)
                      and all(same_line(a, b) for a, b in zip(part, rest[k:k + len(part)]))), None)
        if found is None:
            return False
        at = found + len(part)
    return True


def same_line(shown: str, came: str) -> bool:
    if NUMBER.sub("#", shown) != NUMBER.sub("#", came):
        return False
    part = 0.1 if shown.startswith("iterations") else 1e-9
    return all(same_number(a, b, part) for a, b in zip(NUMBER.findall(shown), NUMBER.findall(came)))


def same_number(shown: str, came: str, part: float) -> bool:
    a, b = (float(text.replace("−", "-")) for text in (shown, came))
    if max(abs(a), abs(b)) < ROUNDING:
        return a == b == 0 or max(abs(a), abs(b)) < 1e-13 or abs(b) <= 30 * abs(a) and abs(a) <= 30 * abs(b)
    mantissa, _, exponent = shown.lower().partition("e")
    unit = 10.0 ** (int(exponent or 0) - len(mantissa.partition(".")[2]))
    return abs(a - b) <= max(1.01 * unit if "." in shown or exponent else 0, part * abs(a))


class Page:
    def __init__(self, root: pathlib.Path, name: str, text: str, program: str, with_python: bool) -> None:
        self.root, self.name, self.text, self.with_python = root, name, text, with_python
        self.faults: list[str] = []
        self.skipped: list[str] = []
        self.n_run = 0
        self.space: dict[str, object] = {"__name__": "page"}
        own = {key: value for key, value in os.environ.items() if key != "PYTHONPATH"}   # is this interpreter's alone
        self.environment = {**own, "NO_COLOR": "1", "LC_ALL": "C.UTF-8",
                            "PATH": os.path.dirname(program) + os.pathsep + os.environ["PATH"]}

    def fault(self, at: int, what: str) -> None:
        self.faults.append(f"{self.name}:{self.text.count(chr(10), 0, at) + 1}: {what}")

    def run(self, folder: pathlib.Path) -> str:
        """Runs all blocks; the text with what came out in it."""
        self.lay_out(folder)
        out, at, came, behind = [], 0, None, 0
        for match in BLOCK.finditer(self.text):
            key, value, language, code = match.groups()
            out.append(self.text[at:match.start()])
            at = match.end()
            if language == "text" and came is not None and not self.text[behind:match.start()].strip():
                if not same(code, came):
                    self.fault(match.start(), f"shown:\n{code.rstrip()}\ncame out:\n{came.rstrip()}")
                    out.append("```text\n" + came.rstrip() + "\n```")
                else:
                    out.append(match.group(0))
                came = None
                continue
            out.append(match.group(0))
            came = None
            if key == "synopsis":
                self.n_run += 1
                self.check_synopsis(folder, code, match.start())
                continue
            if not language and not self.name.endswith("diagnostics.md"):
                self.fault(match.start(), "a block of no language, which nothing runs")
            if language not in RUN:
                continue
            if key == "not run":
                self.skipped.append(f"{self.name}: {value}")
            elif key == "run by":
                self.n_run += 1
                if self.name not in (self.root / value).read_text(encoding="utf-8"):
                    self.fault(match.start(), f"{value} does not run it")
            elif language == "console":
                self.n_run += 1
                said = self.run_console(folder, code, match.start())
                if not same(code, said):
                    self.fault(match.start(), f"shown:\n{code.rstrip()}\ncame out:\n{said.rstrip()}")
                    out[-1] = "```console\n" + said.rstrip() + "\n```"
            elif language != "python" or self.with_python:
                self.n_run += 1
                came = getattr(self, f"run_{language}")(folder, code, match.start(), key, value)
                behind = match.end()
        return "".join([*out, self.text[at:]])

    def lay_out(self, folder: pathlib.Path) -> None:
        for example in (*(self.root / "examples").glob("*.toml"), *(self.root / "tests/docs").glob("*.toml")):
            shutil.copyfile(example, folder / example.name)
        for name in CHECKOUT:
            if (self.root / name).exists():
                (folder / name).symlink_to(self.root / name)
        (folder / "build").mkdir()
        (folder / "build/release").symlink_to(self.environment["PATH"].split(os.pathsep)[0])
        self.environment["HOME"] = str(folder)

    def call(self, folder: pathlib.Path, words: list[str]) -> tuple[int, str]:
        done = subprocess.run(words, cwd=folder, env=self.environment, stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
                              stdin=subprocess.DEVNULL, text=True, timeout=300, check=False)
        return done.returncode, done.stdout

    def run_toml(self, folder: pathlib.Path, code: str, at: int, key: str | None, value: str | None) -> None:
        name = re.match(r"# (\S+\.toml)\b", code) or re.match(r"(format) = ", code)
        if key == "with":
            file = folder / "part.toml"
            base = (folder / value).read_text(encoding="utf-8") if (folder / value).exists() else ""
            for table in re.findall(r"^(\[\w+\])", code, re.M):
                base = re.sub(rf"^{re.escape(table)}\n(?:(?!\[).*\n)*", "", base, flags=re.M)
            for top in re.findall(r"^(\w+) = ", code.partition("[")[0], re.M):
                base = re.sub(rf"^{top} = .*\n", "", base, flags=re.M)
            head, bracket, tables = code.partition("[")
            file.write_text(head + base + "\n" + bracket + tables, encoding="utf-8")
        elif name:
            file = folder / name.group(1).replace("format", "scenario.toml")
            file.write_text(code, encoding="utf-8")
        else:
            self.fault(at, "a scenario without a name: begin it with `# NAME.toml`, or say `with`")
            return
        status, said = self.call(folder, ["livens", "check", str(file)])
        if status != (int(value) if key == "exit" else 0):
            self.fault(at, f"livens check ended with {status}:\n{said}")

    def run_sh(self, folder: pathlib.Path, code: str, at: int, key: str | None, value: str | None) -> str:
        status, said = self.call(folder, ["bash", "-euo", "pipefail", "-c", STAND_INS + code])
        if status != (int(value) if key == "exit" else 0):
            self.fault(at, f"ended with {status}:\n{said}")
        return said

    def run_console(self, folder: pathlib.Path, code: str, at: int) -> str:
        out = []
        environment = {**self.environment, "TERM": "xterm", "COLUMNS": "100"}
        del environment["NO_COLOR"]
        for command in re.findall(r"^\$ (.*)$", code, re.M):
            master, slave = pty.openpty()
            fcntl.ioctl(slave, termios.TIOCSWINSZ, struct.pack("HHHH", 50, 100, 0, 0))
            process = subprocess.Popen(["bash", "-c", command], cwd=folder, env=environment, stdin=subprocess.DEVNULL,
                                       stdout=slave, stderr=slave)
            os.close(slave)
            said = b""
            with contextlib.suppress(OSError):   # the terminal is gone when the command has ended
                while part := os.read(master, 65536):
                    said += part
            os.close(master)
            if process.wait(timeout=300):
                self.fault(at, f"{command} ended with {process.returncode}")
            lines = ESCAPES.sub("", said.decode("utf-8").replace("\r\n", "\n")).split("\n")
            out += [f"$ {command}", *(line.rpartition("\r")[2] for line in lines)]   # progress has been written over
            while out and not out[-1]:
                out.pop()
        return "\n".join(out) + "\n"

    def check_synopsis(self, folder: pathlib.Path, code: str, at: int) -> None:
        known = re.findall(r"^  ([a-z]+)  ", self.call(folder, ["livens", "--help"])[1].partition("Subcommands:")[2].partition("\n\n")[0], re.M)
        listed = list(dict.fromkeys(re.findall(r"^livens ([a-z]+)", code, re.M)))
        if not known or sorted(known) != sorted(listed):
            self.fault(at, f"too many or too few commands: {sorted(set(known) ^ set(listed))}")
        for line in code.splitlines():
            words = line.split()
            told = self.call(folder, ["livens", words[1], "--help"])[1] if words[1:2] else ""
            for option in re.findall(r"(?<![\w-])--?[a-z][a-z-]*\b", line):
                if not re.search(rf"(?<![\w-]){option}(?![\w-])", told):
                    self.fault(at, f"no option {option} of livens {words[1]}")

    def run_cmake(self, folder: pathlib.Path, code: str, at: int, key: str | None, value: str | None) -> None:
        (folder / "CMakeLists.txt").write_text(code, encoding="utf-8")

    def run_python(self, folder: pathlib.Path, code: str, at: int, key: str | None, value: str | None) -> str:
        printed, here = io.StringIO(), os.getcwd()
        try:
            os.chdir(folder)
            os.environ["PATH"] = self.environment["PATH"]
            with contextlib.redirect_stdout(printed):
                if key == "with":
                    exec(f"import livens as lv\nm = lv.load({value!r})", self.space)
                exec(compile(code, self.name, "exec"), self.space)
                if key == "with":
                    exec("assert m == lv.load('part.toml'), 'Python and TOML make different models:\\n' + m.to_toml()", self.space)
        except BaseException:
            self.fault(at, traceback.format_exc(limit=-1))
        finally:
            os.chdir(here)
        return printed.getvalue()

    def run_cpp(self, folder: pathlib.Path, code: str, at: int, key: str | None, value: str | None) -> str:
        if name := re.match(r"// (\w+\.cpp)\n", code):
            (folder / name.group(1)).write_text(code, encoding="utf-8")
        if "int main(" not in code:
            heads = "".join(re.findall(r"^#include.*\n", code, re.M))
            code = heads + "int main()\n{\n" + re.sub(r"^#include.*\n", "", code, flags=re.M) + "}\n"
        (folder / "block.cpp").write_text(code, encoding="utf-8")
        library = pathlib.Path(self.environment["PATH"].split(os.pathsep)[0]) / "liblivens_core.a"
        status, said = self.call(folder, ["c++", "-std=c++20", "-Wall", "-Wextra", f"-I{self.root / 'src'}", "block.cpp", str(library),
                                          "-pthread", "-o", "block"])
        if status:
            self.fault(at, f"does not compile:\n{said}")
            return ""
        status, said = self.call(folder, ["./block"])
        if status:
            self.fault(at, f"ended with {status}:\n{said}")
        return said


GOOD = "# t.toml\nformat = 1\n[[body]]\nname = \"a\"\nshape = { sphere = 1 }\nmass = 1\n[time]\nend = 1\nelements = 2\n"
CONTROLS = {
    "a wrong key": "```toml\n" + GOOD.replace("mass", "mas") + "```\n",
    "a part that does not fit": "```toml\n" + GOOD + "```\n<!-- with: t.toml -->\n```toml\n[[joint]]\ntype = \"rope\"\n```\n",
    "no name": "```toml\nformat = 1\n```\n",
    "a wrong command": "```sh\nlivens sovle x\n```\n",
    "another exit code": "<!-- exit: 3 -->\n```sh\nlivens version\n```\n",
    "a stale figure": "```sh\necho 0.1234\n```\n\n```text\n0.1236\n```\n",
    "a stale word": "```sh\necho yes\n```\n\n```text\nno\n```\n",
    "a line too many": "```sh\necho yes\n```\n\n```text\nyes\n...\nmore\n```\n",
    "rounding that grew": "```sh\necho 1e-13\n```\n\n```text\n4e-15\n```\n".replace("1e-13", "2e-12").replace("4e-15", "5e-14"),
    "a block without a language": "```\nlivens version\n```\n",
    "a stale terminal": "```console\n$ livens version\nlivens 0.0.1\n```\n",
    "a command that is not there": "<!-- synopsis -->\n```text\nlivens solve FILE\nlivens salve FILE\n```\n",
    "a page that nobody runs": "<!-- run by: scripts/demo -->\n```sh\nscripts/packages\n```\n",
    "no such preset": "```sh\ncmake --preset fast\n```\n",
    "no such figure": "```sh\nscripts/paper fig99\n```\n",
    "no such room": "```sh\nscripts/check time kitchen\n```\n",
    "no such option of the tests": "```sh\nscripts/test --everything\n```\n",
    "no such option of peers": "```sh\nscripts/peers --slow\n```\n",
    "an exception": "```python\nassert 1 == 2\n```\n",
    "C++ that is wrong": "```cpp\nint main() { return nothing; }\n```\n",
}
FINE = ("```toml\n" + GOOD + "```\n<!-- with: t.toml -->\n```toml\n[time]\nend = 2\nelements = 4\n```\n"
        "```sh\nlivens solve t.toml -o t.nc -q\necho 0.12345 2e-15\n```\n\n```text\n0.12344 9e-16\n```\n")


def run_page(root: pathlib.Path, name: str, text: str, program: str, with_python: bool) -> tuple[Page, str]:
    page = Page(root, name, text, program, with_python)
    with tempfile.TemporaryDirectory(prefix="livens-page-") as folder:
        return page, page.run(pathlib.Path(folder))


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("root", type=pathlib.Path)
    parser.add_argument("pages", nargs="*", type=pathlib.Path)
    parser.add_argument("--python", action="store_true")
    parser.add_argument("--write", action="store_true")
    parser.add_argument("--controls", action="store_true")
    options = parser.parse_intermixed_args()
    root = options.root.resolve()
    program = os.path.abspath(os.environ.get("LIVENS_PROGRAM", root / "build/release/livens"))
    if options.controls:
        missed = [name for name, text in CONTROLS.items() if not run_page(root, name, text, program, True)[0].faults]
        fine = run_page(root, "fine", FINE, program, True)[0].faults
        print("\n".join([*(f"not found: {name}" for name in missed), *fine]) or f"all {len(CONTROLS)} faults were found")
        return 1 if missed or fine else 0
    n_run, faults, skipped = 0, [], []
    for file in options.pages or pages_of(root):
        text = file.read_text(encoding="utf-8")
        page, text_now = run_page(root, str(file.resolve().relative_to(root)), text, program, options.python)
        if options.write and text_now != text:
            file.write_text(text_now, encoding="utf-8")
        n_run += page.n_run
        faults += page.faults
        skipped += page.skipped
    print("\n".join([*faults, *(f"not run: {why}" for why in skipped)]))
    print(f"{n_run} blocks ran, {len(faults)} faults")
    return 1 if faults or not n_run else 0


if __name__ == "__main__":
    sys.exit(main())
