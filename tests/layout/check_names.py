# SPDX-License-Identifier: BSD-3-Clause
"""One name, one definition: two types (or functions) of one name and namespace in two files are undefined behaviour,
of which no linker tells. By universal-ctags (exit 77 where it is missing).

    check_names.py ROOT
    check_names.py ROOT --controls     small trees with one fault each, every one of which must be refused
"""
import pathlib
import re
import sys

import check_floors

ANONYMOUS = "__anon"


def parameters(signature):
    """Types alone: what parameters are called makes no other function."""
    depth, parts = 0, [""]
    for c in signature.strip()[1:].rpartition(")")[0]:
        depth += (c in "(<[{") - (c in ")>]}")
        if c == "," and depth == 0:
            parts.append("")
        else:
            parts[-1] += c
    bare = [part.partition("=")[0] for part in parts]
    typed = [re.sub(r"(?<=[\w>&*\]]) *(?<![\w:])\b[a-z_]\w*\s*$", "", part) if re.search(r"[ &*]\w+\s*$", part) else part
             for part in bare]
    return tuple(re.sub(r"\s+", "", part) for part in typed)


def check_names(root):
    """None where universal-ctags is missing."""
    check = check_floors.Check(root)
    paths = [path for path, _ in check_floors.files_with_rooms(root) if root / "tests" not in path.parents]
    for path in paths:
        check.read(path)
    listing = check_floors.tags(paths, ["--kinds-C++=csguf", "--fields=+nsSKZ",
                                        "--_xformat=%{kind}\t%{scope}\t%{signature}\t%n\t%N\t%F"])
    if listing is None:
        return None
    found = {}
    for kind, scope, signature, line, name, file in listing:
        if ANONYMOUS in scope or ANONYMOUS in name or "apps" in pathlib.Path(file).relative_to(root).parts[:1]:
            continue
        scope = re.sub(r"^livens::\w+_internal", "livens", scope)   # of one name in two rooms users of both would be asked
        is_function = kind == "function"
        if is_function and not (scope.startswith("livens") and scope.islower()):
            continue   # of a class
        what = parameters(signature) if is_function else "type"
        found.setdefault((scope, name, what), []).append((file, int(line)))
    for (scope, name, _), places in found.items():
        files = {file for file, _ in places}
        if len(files) > 1:
            file, line = places[-1]
            others = ", ".join(sorted(str(pathlib.Path(other).relative_to(root)) for other in files - {file}))
            check.fault(pathlib.Path(file), line, "two-definitions",
                        f"{scope + '::' if scope else ''}{name} is defined in {others}, too")
    return check.faults


def check_hidden(root):
    """Names that are hidden in a source: one of a room is one, so that its sources compile in groups (LIVENS_UNITY), and a
    reader who finds a name has found it. An alias may stand in several."""
    check = check_floors.Check(root)
    paths = [path for path, room in check_floors.files_with_rooms(root)
             if path.suffix == ".cpp" and root / "src" in path.parents]
    for path in paths:
        check.read(path)
    listing = check_floors.tags(paths, ["--kinds-C++=csgufv", "--fields=+nsSKZ",
                                        "--_xformat=%{kind}\t%{scope}\t%{signature}\t%n\t%N\t%F"])
    if listing is None:
        return None
    found = {}
    for kind, scope, signature, line, name, file in listing:
        if re.fullmatch(rf"livens(::\w+_internal)?::{ANONYMOUS}\w+", scope):
            room = pathlib.Path(file).relative_to(root / "src/livens").parts[0]
            what = parameters(signature) if kind == "function" else "thing"
            found.setdefault((room, name, what), {})[file] = int(line)
    for (room, name, _), places in found.items():
        if len(places) > 1:
            (file, line), *others = places.items()
            check.fault(pathlib.Path(file), line, "two-hidden", f"{name} stands in {pathlib.Path(others[0][0]).name}, too")
    return check.faults


TYPE = "#pragma once\nnamespace livens {\nstruct Place {\n    int line = 0;\n};\n}\n"
INLINE = "#pragma once\nnamespace livens {\ninline double twice(const double* a, int n) { return 2 * a[n]; }\n}\n"
HIDDEN = "namespace livens {\nnamespace {\nstruct Place {\n    double t = 0;\n};\ndouble twice(const double* b, int m) { return b[m]; }\n}\n}\n"
OTHER = "#pragma once\nnamespace livens {\nstruct Outer {\n    struct Place { int a; };\n};\nstruct Place;\ninline double twice(const float* a, int n) { return 2 * a[n]; }\n}\n"
CONTROLS = [
    ("two-definitions", {"src/livens/time/place.h": TYPE, "src/livens/solvers/place.h": TYPE}),
    ("two-definitions", {"src/livens/time/place.h": TYPE, "src/livens/time/place.cpp": TYPE.replace("#pragma once\n", "")}),
    ("two-definitions", {"src/livens/time/place.h": TYPE, "src/livens/solvers/place.h": TYPE.replace("struct", "enum class").replace("int line = 0;", "line")}),
    ("two-definitions", {"src/livens/time/place.h": TYPE, "src/livens/solvers/place.h": TYPE.replace("livens", "livens::inline solvers_internal")}),
    ("two-definitions", {"src/livens/time/twice.h": INLINE, "src/livens/solvers/twice.h": INLINE.replace("* a", "* values").replace("a[n]", "values[n]")}),
]


def main():
    root = pathlib.Path(sys.argv[1]).resolve()
    if "--controls" not in sys.argv:
        faults = check_names(root)
        return check_floors.report(faults if faults is None else faults + check_hidden(root), "names with one definition")
    good = [{**check_floors.GOOD, "src/livens/time/place.h": TYPE, "src/livens/solvers/hidden.cpp": HIDDEN,
             "src/livens/solvers/other.h": OTHER}]
    wrong = check_floors.run_controls(check_names, CONTROLS, good)
    hidden = [("two-hidden", {"src/livens/solvers/hidden.cpp": "", "src/livens/time/one.cpp": HIDDEN, "src/livens/time/two.cpp": text})
              for text in (HIDDEN.split("double twice")[0] + "}\n}\n", "namespace livens {\nnamespace {\nconst int Place = 1;\n}\n}\n")]
    apart = [{**check_floors.GOOD, "src/livens/time/one.cpp": HIDDEN, "src/livens/geometry/two.cpp": HIDDEN}]
    return check_floors.report(wrong if wrong is None else wrong + check_floors.run_controls(check_hidden, hidden, apart),
                               "negative controls of names")


if __name__ == "__main__":
    sys.exit(main())
