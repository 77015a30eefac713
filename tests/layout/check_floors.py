# SPDX-License-Identifier: BSD-3-Clause
"""The table of floors (docs/architecture.md) and the sizes, checked on the sources. Standard library only.

    check_floors.py ROOT               licences, includes, names and sizes of files
    check_floors.py ROOT --functions   lengths of functions, by universal-ctags (exit 77 where it is missing)
    check_floors.py ROOT --classes     data members of classes, likewise
    ... --controls                     small trees with one fault each, every one of which must be refused

A size may be exceeded for a reason given in the file: `// layout allows long-file: <reason>`; likewise
long-function and long-line (for the whole file). Floors have no such exception.
"""
import argparse
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile

# Lowest first. Rooms on one floor do not see each other, unless an arrow is drawn below.
FLOORS = [
    ["base"],
    ["time", "solvers", "geometry"],
    ["multibody"],
    ["dynamics"],
    ["statics", "stepping"],
    ["diagnostics"],
    ["spacetime"],
    ["io"],
    ["apps"],
]
# Elements in space are integrated by the rules of time, and loops over them are shared by the threads of solvers.
# Witnesses know nothing of what they are compared with.
ARROWS = {("geometry", "time"), ("geometry", "solvers")}
APART = {("diagnostics", "stepping")}
# Folders of a room, lowest first: none sees one that comes later. A room's own files are its face, which its folders and
# their users may see, and which may see them. Folders that are not named here stand beside each other.
PARTS = {
    "multibody": ["joints", "loads"],
    "dynamics": ["rows", "lanes", "instant", "start", "coordinates"],
    "solvers": ["ranks"],
    "spacetime": ["march", "elements", "nodal", "mixed", "accuracy"],
    "spacetime/nodal": ["kernel", "condensed", "laws"],
    "io": ["results", "exports", "report", "scenario", "import"],
    "io/scenario": ["text", "schema", "bodies", "joints", "loads", "events", "run"],
}
# Folders that other rooms do not see into, but for what is named.
INSIDES = {"detail", "scenario", "import", "march", "elements", "nodal", "mixed", "accuracy"}
SEEN_INSIDE = {"livens/spacetime/mixed/bases.h"}   # words of a table, for the reader of scenarios

FLOOR = {room: number for number, rooms in enumerate(FLOORS) for room in rooms}

# What is not the standard library: where it comes from, and the rooms whose sources may include it.
FOREIGN = [
    (r"Eigen/", {"solvers"}),   # whose target renames its namespace, see cmake/rooms.cmake
    (r"suitesparse/|umfpack|metis", {"solvers"}),
    (r"petsc|mpi\.h", {"solvers"}),
    (r"toml\+\+/|toml\.hpp", {"io"}),
    (r"netcdf|hdf5|H5", set()),   # io reads and writes it itself
    (r"fmt/", {"io", "apps"}),
    (r"zlib", {"io"}),
    (r"tinyxml2", {"io"}),
    (r"CLI/", {"apps"}),
    (r"spdlog/", set()),
    (r"gtest/|gmock/|benchmark/", set()),
    (r"iostream$|print$", {"apps"}),   # the library prints nothing
]
FOREIGN_HEADERS = {"src/livens/solvers/detail/eigen_views.h"}   # for the sources behind the door of Eigen

# Rooms whose messages name concepts: files of scenarios are io's, and other callers never see them.
CORE = {room for rooms in FLOORS[:FLOORS.index(["io"])] for room in rooms}
# `key = "choice"` and `[table]`; the place `body[world]` of a complaint is none.
TOML = re.compile(r'''\w\s*=\s*\\?["'] | (?<!\w)\[\[?(?!world\])[a-z_.]{3,}\]''', re.X)

LINE, HEADER, SOURCE, TEST, FUNCTION, BASE = 110, 300, 400, 600, 60, 300
DEPTH = 14   # files one above the other by what they include, the source among them
# Data members of a class, with those of its inner classes, static ones not counted; more is two classes.
MEMBERS = 15
BAD_NAMES = {"util", "utils", "utility", "utilities", "common", "misc", "helper", "helpers"}
LICENCE = "SPDX-License-Identifier: BSD-3-Clause"
LICENSED_FOLDERS = ("src", "apps", "tests", "benchmarks", "experiments", "cmake", "scripts", "python", ".ci")
LICENSED_SUFFIXES = {".h", ".cpp", ".py", ".cmake", ".map"}
ALLOWANCE = re.compile(r"//\s*layout allows (long-file|long-function|long-line): \S.{9,}")


TOKEN = re.compile(r'''R"([^(\s]*)\(.*?\)\1" | "(?:\\.|[^"\\\n])*" | '(?:\\.|[^'\\\n])+'
                       | //[^\n]* | /\*.*?\*/''', re.S | re.X)


def without_comments(text):
    """The text with comments blanked; lines stay where they are, strings are kept."""
    def blank(match):
        found = match.group(0)
        return re.sub(r"[^\n]", " ", found) if found.startswith("/") else found

    # Digit separators (1'000) would start a character literal.
    return TOKEN.sub(blank, re.sub(r"(?<=\d)'(?=\d)", "_", text))


class Check:
    def __init__(self, root):
        self.root = root
        self.faults = []
        self.allowed = {}   # path -> what its allowance comments let pass

    def fault(self, path, line, rule, message):
        if rule not in self.allowed.get(path, ()):
            self.faults.append(f"{path.relative_to(self.root)}:{line}: {message} [{rule}]")

    def read(self, path):
        text = path.read_text(encoding="utf-8")
        self.allowed[path] = {match.group(1) for match in ALLOWANCE.finditer(text)}
        return text


def files_with_rooms(root):
    """(path, room, may be seen by others) of every C++ file that has a floor."""
    for folder in ("src", "apps"):
        for path in sorted((root / folder).rglob("*")):
            if path.suffix in (".h", ".hpp", ".cpp", ".cc", ".cxx", ".inl") and path.is_file():
                parts = path.relative_to(root).parts
                if folder == "apps":
                    yield path, "apps"
                else:
                    yield path, parts[2] if parts[1] == "livens" and len(parts) > 3 else ""
    # A room's unit tests live on its floor.
    for path in sorted((root / "tests" / "unit").glob("*/**/*.cpp")):
        yield path, path.relative_to(root / "tests" / "unit").parts[0]


def may_see(room, other):
    return other == room or (FLOOR[other] < FLOOR[room] and (room, other) not in APART) or (room, other) in ARROWS


def runs_up(path, name):
    """The folder of its own room, in which a file includes what stands above its own folder; else None."""
    mine, other = path.parts[:-1], pathlib.PurePath(name).parts[1:-1]
    for depth in range(1, min(len(mine), len(other))):
        if mine[:depth] == other[:depth] and mine[depth] != other[depth]:
            order = PARTS.get("/".join(mine[:depth]), ())
            if mine[depth] in order and other[depth] in order and order.index(mine[depth]) < order.index(other[depth]):
                return "/".join(other[:depth + 1])
    return None


def check_includes(check, path, room, text):
    """Checks every include of a file; returns the files of this project that it includes."""
    seen = []
    is_test = check.root / "tests" in path.parents
    for number, line in enumerate(without_comments(text).split("\n"), 1):
        match = re.match(r"\s*#\s*include(?:_next)?\s*(.*?)\s*$", line)
        if not match:
            continue
        target = re.match(r'(["<])([^">]+)[">]', match.group(1))
        if not target:
            check.fault(path, number, "include", f"include of a macro, {match.group(1)}")
            continue
        quoted, name = target.group(1) == '"', target.group(2)
        if room == "apps" and quoted and (check.root / "apps" / name).is_file() and ".." not in name:
            seen.append((number, check.root / "apps" / name))
        elif name.startswith("livens/"):
            parts = name.split("/")
            other = parts[1]
            if ".." in parts or "." in parts:
                check.fault(path, number, "relative", f"include leaves its room by a relative path, {name}")
            elif other not in FLOOR or other == "apps" or len(parts) < 3:
                check.fault(path, number, "room", f"include of an unknown room, {name}")
            elif not may_see(room, other):
                way = "upward" if FLOOR[other] > FLOOR[room] else "sideways" if FLOOR[other] == FLOOR[room] else "apart"
                check.fault(path, number, way, f"{room} (F{FLOOR[room]}) includes {name} (F{FLOOR[other]})")
            elif INSIDES & set(parts[2:-1]) and other != room and not is_test and name not in SEEN_INSIDE:
                check.fault(path, number, "detail", f"{room} includes the inside of another room, {name}")
            elif not is_test and room != "apps" and runs_up(path.relative_to(check.root / "src" / "livens"), name):
                check.fault(path, number, "part", f"{name} stands above the folder of this file")
            elif not quoted:
                check.fault(path, number, "include", f'write "{name}", not <{name}>')
            elif not (check.root / "src" / name).is_file():
                check.fault(path, number, "include", f"no such file, src/{name}")
            seen.append((number, check.root / "src" / name))
        elif quoted and (is_test or (room == "apps" and "/" not in name)):
            # Tests include what lies beside them; the program is one folder.
            if "../" in name:
                check.fault(path, number, "relative", f"include by a relative path, {name}")
            seen.append((number, path.parent / name))
        elif quoted:
            rule = "relative" if (path.parent / name).exists() or "../" in name else "include"
            check.fault(path, number, rule, f'only "livens/<room>/<file>.h" is quoted, not "{name}"')
        elif not is_test:
            check_foreign(check, path, number, room, name)
    return seen


def check_foreign(check, path, number, room, name):
    for pattern, rooms in FOREIGN:
        if re.match(pattern, name):
            if room not in rooms:
                check.fault(path, number, "foreign", f"{room} may not use <{name}>")
            elif path.suffix != ".cpp" and room != "apps" and path.relative_to(check.root).as_posix() not in FOREIGN_HEADERS:
                check.fault(path, number, "foreign", f"<{name}> in a header: keep it in sources")


def check_names(check, path, room):
    parts = path.relative_to(check.root).with_suffix("").parts
    if BAD_NAMES & {word for part in parts for word in [part.lower(), *part.lower().split("_")]}:
        check.fault(path, 1, "name", "name it after what it is for: no utils, common, misc, helpers")
    if path.suffix not in (".h", ".cpp"):
        check.fault(path, 1, "name", "headers end in .h, sources in .cpp")
    if room not in FLOOR:
        check.fault(path, 1, "room", f"'{room}' is no room of the table of floors")


def check_sizes(check, path, text, source_limit):
    lines = text.split("\n")
    if lines and not lines[-1]:
        lines.pop()
    for number, line in enumerate(lines, 1):
        if len(line) > LINE:
            check.fault(path, number, "long-line", f"{len(line)} columns, {LINE} are allowed")
    limit = HEADER if path.suffix == ".h" else source_limit
    if len(lines) > limit:
        check.fault(path, limit, "long-file", f"{len(lines)} lines, {limit} are allowed")
    if path.suffix == ".h":
        if not re.search(r"^#pragma once$", text, re.M):
            check.fault(path, 1, "header", "no #pragma once")
        if re.search(r"^\s*using namespace\b", without_comments(text), re.M):
            check.fault(path, 1, "header", "using namespace in a header")
    return len(lines)


def check_wording(check, path, text):
    bare = without_comments(text)
    for match in TOKEN.finditer(bare):
        literal = match.group(0)
        found = TOML.search(literal[literal.index('"') + 1:-1]) if '"' in literal[:2] else None
        if found:
            line = bare.count("\n", 0, match.start()) + 1
            check.fault(path, line, "wording", f"{literal} speaks TOML: name the concept, io adds the key")


def check_licences(check):
    """Every source names its licence in its first line, or after that of its interpreter."""
    for path in sorted(p for folder in LICENSED_FOLDERS for p in (check.root / folder).rglob("*") if p.is_file()):
        with path.open("rb") as file:
            head = [file.readline().decode("utf-8", "replace") for _ in range(2)]
        is_script = head[0].startswith("#!")
        if is_script or path.suffix in LICENSED_SUFFIXES or path.name == "CMakeLists.txt":
            if LICENCE not in head[int(is_script)]:
                check.fault(path, 1, "licence", f"its first line does not say {LICENCE}")


def check_circles(check, graph):
    """graph: file -> [(line, included file)]. Reports each circle once, at its first edge found."""
    state = {}

    def visit(path, trail):
        state[path] = "open"
        for number, other in graph.get(path, ()):
            if state.get(other) == "open":
                circle = [*trail[trail.index(other):], other]
                names = " -> ".join(p.name for p in circle)
                check.fault(path, number, "circle", f"includes form a circle: {names}")
            elif other in graph and other not in state:
                visit(other, [*trail, other])
        state[path] = "done"

    for path in graph:
        if path not in state:
            visit(path, [path])


def check_depth(check, graph):
    """graph as above, without circles. Reports the first edge of the longest way down from a source."""
    known = {}

    def depth(path):
        if path not in known:
            known[path] = 0   # a circle ends here
            known[path] = 1 + max((depth(other) for _, other in graph.get(path, ())), default=0)
        return known[path]

    sources = [path for path in graph if check.root / "src" in path.parents]
    deepest = max(sources, key=depth, default=None)
    if deepest is not None and depth(deepest) > DEPTH:
        number, below = max(graph[deepest], key=lambda edge: depth(edge[1]))
        check.fault(deepest, number, "deep", f"{depth(deepest)} files one above the other, {DEPTH} are allowed: "
                    f"declare what {below.name} has, where no more is needed of it")


def check_catches(check, path, text):
    """Where a complaint decides what is done: the core returns what else may come (try_ functions)."""
    for match in re.finditer(r"catch \((?:const )?InputError\b", without_comments(text)):
        check.fault(path, text.count("\n", 0, match.start()) + 1, "steer",
                    "a caught InputError decides what is done: let a function return why not")


def check_namespace(check, path, room, text, installed):
    """Names that users have stand in livens, those inside of a room in an inline namespace of its own: two rooms may then use
    one word without being one type. What a header adds to a public class stays in livens."""
    adds = re.search(r"^(struct|class) \w+::\w+ (final )?[:{]", text, re.M)
    is_public = str(path.relative_to(check.root / "src")) in installed
    for i, line in enumerate(text.splitlines(), 1):
        inner = re.match(r"namespace livens::inline (\w+) \{", line)
        if inner and is_public:
            check.fault(path, i, "namespace", "an installed header declares in livens")
        elif inner and inner[1] != f"{room}_internal" and not is_forward(text, i):
            check.fault(path, i, "namespace", f"inside of this room is {room}_internal")
        elif re.match(r"namespace (\[\[.*\]\] )?livens \{", line) and not is_public and not adds and not is_forward(text, i):
            check.fault(path, i, "namespace", f"what is not installed stands in namespace livens::inline {room}_internal")


def is_forward(text, line):
    """Whether a namespace that opens in this line holds nothing but names of classes."""
    body = text.splitlines()[line:]
    end = next((i for i, other in enumerate(body) if other.startswith("}")), 0)
    return all(re.match(r"(struct|class) \w+;|$", other) for other in body[:end])


def check_floors(root):
    check = Check(root)
    check_licences(check)
    listing = root / "cmake/headers.txt"
    installed = set(listing.read_text(encoding="utf-8").split()) if listing.exists() else set()
    graph = {}
    base_lines = 0
    for path, room in files_with_rooms(root):
        text = check.read(path)
        is_test = root / "tests" in path.parents
        check_names(check, path, room)
        if room not in FLOOR:
            continue
        graph[path] = check_includes(check, path, room, text)
        lines = check_sizes(check, path, text, TEST if is_test else SOURCE)
        if room in CORE and not is_test:
            check_wording(check, path, text)
            check_catches(check, path, text)
        if path.suffix == ".h" and root / "src" in path.parents:
            check_namespace(check, path, room, text, installed)
        if room == "base" and not is_test:
            base_lines += lines
    if base_lines > BASE:
        check.faults.append(f"src/livens/base: {base_lines} lines in all, {BASE} are allowed for ever [base]")
    if not graph:
        check.faults.append(f"{root}: no sources found [room]")
    check_circles(check, graph)
    check_depth(check, graph)
    return check.faults


def tags(paths, options):
    """Lines of universal-ctags, split at tabs, equal ones once; None where it is missing."""
    ctags = shutil.which("ctags")
    if not ctags:
        return None
    version = subprocess.run([ctags, "--version"], capture_output=True, text=True)
    if "Universal Ctags" not in version.stdout:
        return None
    command = [ctags, "--language-force=C++", *options, "-x", "-L", "-"]
    with tempfile.TemporaryDirectory() as folder:
        names, own = {}, {}
        for i, path in enumerate(paths):
            path = pathlib.Path(path)
            text = path.read_text(encoding="utf-8")
            plain = text.replace("namespace livens::inline ", "namespace livens::")   # which ctags does not know
            seen = path
            if plain != text:
                seen = pathlib.Path(folder, f"{i}{path.suffix}")
                seen.write_text(plain, encoding="utf-8")
                own[str(seen)] = str(path)
            names[str(seen)] = None
        listing = subprocess.run(command, input="\n".join(names), capture_output=True, text=True, check=True)
    lines = [line.split("\t") for line in listing.stdout.splitlines()]
    return [[*fields[:-1], own.get(fields[-1], fields[-1])] for fields in lines]


def check_functions(root):
    """None where universal-ctags is missing."""
    check = Check(root)
    paths = [path for path, _ in files_with_rooms(root)]
    for path in paths:
        check.read(path)
    listing = tags(paths, ["--kinds-C++=f", "--fields=+ne", "--_xformat=%{end}\t%n\t%N\t%F"])
    if listing is None:
        return None
    for end, start, name, file in listing:
        if end and int(end) - int(start) + 1 > FUNCTION:
            length = int(end) - int(start) + 1
            check.fault(pathlib.Path(file), int(start), "long-function",
                        f"{name} has {length} lines, {FUNCTION} are allowed")
    return check.faults


def members_of_classes(root):
    """Class -> (file, line) of its data members, those of its inner classes too, wherever these stand; None where
    universal-ctags is missing. Members of a union or struct without a name are its owner's."""
    paths = [path for path, _ in files_with_rooms(root) if root / "src" in path.parents]
    listing = tags(paths, ["--kinds-C++=m", "--fields=+nZs", "--fields-C++=+{properties}",
                           "--_xformat=%{scope}\t%{C++.properties}\t%n\t%N\t%F"])
    if listing is None:
        return None
    kinds = tags(paths, ["--kinds-C++=cs", "--fields=+sZ", "--_xformat=%{scope}\t%n\t%N\t%F"])
    classes = {"::".join(filter(None, (scope, name))) for scope, _, name, _ in kinds}
    members = {}
    for scope, properties, line, _, file in listing:
        if "static" in properties.split(","):
            continue
        inner = re.sub(r"(::__anon\w+)+$", "", scope)
        outer = inner.split("::")
        for n in range(1, len(outer) + 1):
            name = "::".join(outer[:n])
            if name == inner or name in classes:
                members.setdefault(name, []).append((file, int(line)))
    return members


def check_classes(root):
    """None where universal-ctags is missing."""
    members = members_of_classes(root)
    if members is None:
        return None
    check = Check(root)
    for name, places in members.items():
        if len(places) > MEMBERS:
            check.fault(pathlib.Path(places[0][0]), places[0][1], "wide-class",
                        f"{name} has {len(places)} data members, {MEMBERS} are allowed")
    return check.faults


# Negative controls: one fault a tree, and the rule that must name it.

GOOD = {
    "cmake/headers.txt": "@livens/multibody/model.h\n",
    "src/livens/time/inside.h": "#pragma once\nnamespace livens::inline solvers_internal {\nclass Newton;\n}\n\n"
                                "namespace livens::inline time_internal {\nint f();\n}\n",
    "src/livens/multibody/outside.h": "#pragma once\n#include \"livens/multibody/model.h\"\nnamespace livens {\n\n"
                                      "struct Model::Parts {\n};\n}\n",
    "src/livens/base/error.h": "#pragma once\n#include <string>\n",
    "src/livens/time/mesh.h": '#pragma once\n#include "livens/base/error.h"\n',
    "src/livens/solvers/newton.h": "#pragma once\n",
    "src/livens/multibody/model.h": '#pragma once\n#include "livens/time/mesh.h"\n',
    "src/livens/multibody/model.cpp": '#include "livens/multibody/model.h"\n',
    "src/livens/stepping/rule.h": '#pragma once\n#include "livens/multibody/model.h"\n',
    "src/livens/spacetime/solve.h": '#pragma once\n#include "livens/multibody/model.h"\n',
    "src/livens/spacetime/solve.cpp": '#include "livens/spacetime/solve.h"\n'
                                      '#include "livens/stepping/rule.h"\n'
                                      '#include "livens/diagnostics/energy.h"\n',
    "src/livens/diagnostics/energy.h": '#pragma once\n// #include "livens/io/file.h" is only a remark\n',
    "src/livens/io/file.h": '#pragma once\n#include "livens/spacetime/solve.h"\n',
    "src/livens/multibody/talk.cpp": '// start = "project"\n'
                                     'const char* path = "body[world].mass", *say = "[world]";\n'
                                     'const char* more = "d(v)/dt = ", *unit = "x [m], in [0, 1]";\n',
    "src/livens/io/talk.cpp": 'const char* help = R"(initial = "project" in [start])";\n',
    "src/livens/io/file.cpp": '#include "livens/io/file.h"\n#include <toml++/toml.h>\n',
    "apps/livens/main.cpp": '#include "livens/io/file.h"\n#include "parts.h"\n#include "livens/parts.h"\n'
                            '#include <CLI/CLI.hpp>\n',
    "apps/livens/parts.h": "#pragma once\n",
    "src/livens/io/steer.cpp": "int f() { try { g(); } catch (const InputError& why) { return 1; } }\n",
    **{f"src/livens/time/d{i}.h": "#pragma once\n" + (f'#include "livens/time/d{i + 1}.h"\n' if i < DEPTH - 1 else "")
       for i in range(DEPTH)},
    "tests/unit/time/mesh_test.cpp": '#include "livens/time/mesh.h"\n#include <gtest/gtest.h>\n',
}

NO_LICENCE = "@"   # stands in a control's text; all others get the licence's line in front of them

CONTROLS = [
    ("licence", {"src/livens/time/free.cpp": "@int free;\n"}),
    ("licence", {"cmake/late.cmake": f"@# rooms\n# {LICENCE}\n"}),
    ("licence", {"tests/mutants/script": "@#!/usr/bin/env python3\nprint()\n"}),
    ("licence", {"benchmarks/CMakeLists.txt": "@# SPDX-License-Identifier: MIT\n"}),
    ("namespace", {"src/livens/time/inside.h": "#pragma once\nnamespace livens {\nint f();\n}\n"}),
    ("namespace", {"src/livens/time/inside.h": "#pragma once\nnamespace livens::inline solvers_internal {\nint f();\n}\n"}),
    ("namespace", {"src/livens/multibody/model.h": "#pragma once\nnamespace livens::inline multibody_internal {\nint f();\n}\n"}),
    ("namespace", {"src/livens/time/inside.h": '#pragma once\nnamespace [[gnu::visibility("default")]] livens {\nint f();\n}\n'}),
    ("upward", {"src/livens/base/up.h": '#pragma once\n#include "livens/time/mesh.h"\n'}),
    ("upward", {"src/livens/multibody/up.cpp": '#  include   "livens/diagnostics/energy.h"\n'}),
    ("upward", {"src/livens/time/up.cpp": 'const char* s = "/*";\n#include "livens/io/file.h"\n'}),
    ("upward", {"tests/unit/time/up_test.cpp": '#include "livens/multibody/model.h"\n'}),
    ("upward", {"src/livens/stepping/side.cpp": '#include "livens/spacetime/solve.h"\n'}),
    ("upward", {"src/livens/diagnostics/side.cpp": '#include "livens/spacetime/solve.h"\n'}),
    ("upward", {"src/livens/stepping/side.cpp": '#include "livens/diagnostics/energy.h"\n'}),
    ("sideways", {"src/livens/time/side.cpp": '#include "livens/solvers/newton.h"\n'}),
    ("circle", {"src/livens/time/a.h": '#pragma once\n#include "livens/time/b.h"\n',
                "src/livens/time/b.h": '#pragma once\n#include "livens/time/a.h"\n'}),
    ("circle", {"src/livens/time/self.h": '#pragma once\n#include "livens/time/self.h"\n'}),
    ("deep", {f"src/livens/time/d{i}.h": "#pragma once\n" + (f'#include "livens/time/d{i + 1}.h"\n' if i < DEPTH else "")
              for i in range(DEPTH + 1)}),
    ("steer", {"src/livens/spacetime/steer.cpp": "int f() { try { g(); } catch (const InputError& why) { return 1; } }\n"}),
    ("relative", {"src/livens/multibody/rel.cpp": '#include "../time/mesh.h"\n'}),
    ("relative", {"src/livens/multibody/rel.cpp": '#include "model.h"\n'}),
    ("relative", {"src/livens/multibody/rel.cpp": '#include "livens/multibody/../io/file.h"\n'}),
    ("include", {"src/livens/multibody/angle.cpp": "#include <livens/time/mesh.h>\n"}),
    ("include", {"src/livens/multibody/gone.cpp": '#include "livens/time/gone.h"\n'}),
    ("include", {"src/livens/multibody/macro.cpp": "#include CONFIG_HEADER\n"}),
    ("room", {"src/livens/attic/box.cpp": "int box;\n"}),
    ("room", {"src/livens/loose.cpp": "int loose;\n"}),
    ("room", {"src/livens/io/attic.cpp": '#include "livens/attic/box.h"\n'}),
    ("detail", {"src/livens/time/detail/inner.h": "#pragma once\n",
                "src/livens/io/peek.cpp": '#include "livens/time/detail/inner.h"\n'}),
    ("detail", {"src/livens/spacetime/nodal/inner.h": "#pragma once\n",
                "src/livens/io/peek.cpp": '#include "livens/spacetime/nodal/inner.h"\n'}),
    ("part", {"src/livens/spacetime/nodal/inner.h": "#pragma once\n",
              "src/livens/spacetime/march/up.cpp": '#include "livens/spacetime/nodal/inner.h"\n'}),
    ("part", {"src/livens/io/scenario/run/inner.h": "#pragma once\n",
              "src/livens/io/scenario/text/deep/up.cpp": '#include "livens/io/scenario/run/inner.h"\n'}),
    ("sideways", {"src/livens/statics/rest.h": "#pragma once\n",
                  "src/livens/stepping/side.cpp": '#include "livens/statics/rest.h"\n'}),
    ("apart", {"src/livens/diagnostics/side.cpp": '#include "livens/stepping/rule.h"\n'}),
    ("detail", {"src/livens/io/scenario/inner.h": "#pragma once\n",
                "apps/livens/peek.cpp": '#include "livens/io/scenario/inner.h"\n'}),
    ("name", {"src/livens/time/utils.h": "#pragma once\n"}),
    ("name", {"src/livens/time/string_helpers.cpp": "int x;\n"}),
    ("name", {"src/livens/io/common/x.h": "#pragma once\n"}),
    ("name", {"src/livens/time/odd.hpp": "#pragma once\n"}),
    ("long-line", {"src/livens/time/wide.cpp": "// " + "x" * 108 + "\n"}),
    ("long-file", {"src/livens/time/tall.h": "#pragma once\n" + "//\n" * 299}),
    ("long-file", {"src/livens/time/tall.cpp": "//\n" * 400}),
    ("long-file", {"src/livens/time/tall.cpp": "//\n" * 400 + "// layout allows long-file: no\n"}),
    ("long-file", {"tests/unit/time/tall_test.cpp": "//\n" * 600}),
    ("base", {"src/livens/base/a.h": "#pragma once\n" + "//\n" * 160, "src/livens/base/b.cpp": "//\n" * 160}),
    ("header", {"src/livens/time/twice.h": "int twice();\n"}),
    ("header", {"src/livens/time/open.h": "#pragma once\nusing namespace std;\n"}),
    *[("wording", {"src/livens/spacetime/talk.cpp": f"// [table]\nconst char* help = {literal};\n"})
      for literal in [r'''"use momentum = \"natural\""''', r'''"momentum='strong'"''',
                      '''R"(multipliers = "equal")"''', '''"a key of [method]"''', '''"of a [[body]]"''',
                      '''"good, " "see [body.end]"''']],
    ("foreign", {"src/livens/solvers/eigen.h": "#pragma once\n#include <Eigen/Core>\n"}),
    ("foreign", {"src/livens/multibody/eigen.cpp": "#include <Eigen/Core>\n"}),
    ("foreign", {"src/livens/statics/eigen.cpp": "#include <Eigen/Dense>\n"}),
    ("foreign", {"src/livens/spacetime/eigen.cpp": "#include <Eigen/Core>\n"}),
    ("foreign", {"src/livens/io/public.h": "#pragma once\n#include <fmt/format.h>\n"}),
    ("foreign", {"src/livens/io/public.h": "#pragma once\n#include <toml++/toml.h>\n"}),
    ("foreign", {"src/livens/io/public.h": "#pragma once\n#include <netcdf.h>\n"}),
    ("foreign", {"src/livens/multibody/sparse.cpp": "#include <suitesparse/umfpack.h>\n"}),
    ("foreign", {"src/livens/solvers/sparse.h": "#pragma once\n#include <suitesparse/umfpack.h>\n"}),
    ("foreign", {"src/livens/io/log.cpp": "#include <spdlog/spdlog.h>\n"}),
    ("foreign", {"src/livens/time/print.cpp": "#include <iostream>\n"}),
]

LONG_FUNCTION = "int f()\n{\n" + "    // line\n" * 56 + "    return 0;\n}\n"   # 60 lines
FUNCTION_CONTROLS = [
    ("long-function", {"src/livens/time/long.cpp": LONG_FUNCTION.replace("{\n", "{\n    // one more\n")}),
    ("long-function", {"src/livens/time/long.h": "#pragma once\ntemplate <int N>\nstruct S {\n"
                       "    int g() const\n    {\n" + "        // line\n" * 60
                       + "        return N;\n    }\n};\n"}),
]

# 15 members of each kind of spelling, an inner class's among them, and what is none: static, local, a function.
WIDE_CLASS = """#pragma once
class Wide : public Base {
public:
    explicit Wide(int a, int b) : first_(a), second_(b) { int local = 0; }
    std::function<void(int, int)> report = [](int, int) {};
    static constexpr int limit = 3;
    struct Inner { int one, two; };
    struct Later;
    int count() const { return count_; }
private:
    const double *from_ = nullptr, *to_ = nullptr;
    std::vector<double> values_ = {1, 2}, work_{};
    union { int whole_; float part_; };
    double sums_[2][2] = {};
    mutable int count_ = 0;
    Inner inner_;
    bool done_;
    unsigned first_ : 3, second_ : 3;
};
"""
CLASS_CONTROLS = [
    *[("wide-class", {"src/livens/spacetime/wide.h": WIDE_CLASS.replace(was, becomes)})
      for was, becomes in [("done_", "done_, other_"), ("to_ =", "to_ = nullptr, *last_ ="), ("one, two", "one, two, three"),
                           ("struct Inner { int", "struct Inner { struct { int x; }; int"),
                           ("int whole_;", "int whole_; int more_;"), ("static constexpr", "const")]],
    ("wide-class", {"src/livens/spacetime/wide.cpp": "struct Wide::Later {\n    int late;\n};\n"}),
    *[("wide-class", {f"src/livens/{room}/wide.cpp": "namespace {\ntemplate <int N>\nstruct Wider {\n"
                      + "".join(f"    double x{i}[N];\n" for i in range(16)) + "};\n}\n"})
      for room in ("base", "dynamics/rows", "spacetime/mixed", "io/results")],
]


def faults_of(check, tree):
    with tempfile.TemporaryDirectory() as folder:
        root = pathlib.Path(folder)
        for name, text in tree.items():
            (root / name).parent.mkdir(parents=True, exist_ok=True)
            text = text.replace(NO_LICENCE, "") if NO_LICENCE in text else f"// {LICENCE}\n{text}"
            (root / name).write_text(text, encoding="utf-8")
        return check(root)


def run_controls(check, controls, good_trees):
    """Every made-up fault must be refused by its own rule alone, and the good trees must pass."""
    wrong = []
    for tree in good_trees:
        faults = faults_of(check, tree)
        if faults is None:
            return None
        if faults:
            wrong.append("the good tree was refused: " + "; ".join(faults))
    for rule, change in controls:
        faults = faults_of(check, {**good_trees[0], **change})
        if not faults or any(not fault.endswith(f"[{rule}]") for fault in faults):
            wrong.append(f"{sorted(change)} should be refused by [{rule}] alone, but: {faults or 'accepted'}")
    return wrong


def report(faults, what):
    if faults is None:
        print(f"SKIPPED: {what} (universal-ctags is not installed)")
        return 77
    for fault in faults:
        print(fault)
    print(f"{what}: {len(faults)} faults" if faults else f"{what}: good")
    return 1 if faults else 0


def main():
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("root", type=pathlib.Path)
    parser.add_argument("--functions", action="store_true")
    parser.add_argument("--classes", action="store_true")
    parser.add_argument("--controls", action="store_true")
    options = parser.parse_args()
    root = options.root.resolve()
    if options.controls and options.functions:
        good = [GOOD, {**GOOD, "src/livens/time/long.cpp": LONG_FUNCTION}]
        wrong = run_controls(check_functions, FUNCTION_CONTROLS, good)
        return report(wrong, "negative controls of functions")
    if options.controls and options.classes:
        good = [{**GOOD, "src/livens/spacetime/wide.h": WIDE_CLASS,
                 "tests/unit/time/wide.cpp": WIDE_CLASS.replace("done_", "done_, other_")}]
        wrong = run_controls(check_classes, CLASS_CONTROLS, good)
        return report(wrong, "negative controls of classes")
    if options.controls:
        reasoned = "//\n" * 600 + "// layout allows long-file: a table of points that belongs together\n"
        good = [GOOD, {**GOOD, "src/livens/time/tall.cpp": reasoned,
                       "tests/unit/time/tall_test.cpp": "//\n" * 599}]
        return report(run_controls(check_floors, CONTROLS, good), "negative controls of floors")
    if options.functions:
        return report(check_functions(root), "lengths of functions")
    if options.classes:
        return report(check_classes(root), "members of classes")
    return report(check_floors(root), "floors")


if __name__ == "__main__":
    sys.exit(main())
