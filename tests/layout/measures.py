# SPDX-License-Identifier: BSD-3-Clause
"""What the house comes to: measures of the source, with their bounds. Standard library and universal-ctags.

    measures.py ROOT             the table, in Markdown
    measures.py ROOT --check     exit status 1 where a bound is passed

Lines count as they stand; a room with folders counts folder by folder. Comments are lines that hold nothing else;
their share leaves the licence's lines out, which say nothing of the code.
"""
import collections
import pathlib
import re
import statistics
import subprocess
import sys

import check_floors
from check_floors import PARTS, Check, runs_up, without_comments

INCLUDE = re.compile(r'^\s*#\s*include\s*"livens/([^"]+)"', re.M)
FOLDERS = {"/".join((parent, part)) for parent, parts in PARTS.items() for part in parts}


def sources(root, folder="src"):
    return sorted(p for p in (root / folder).rglob("*") if p.suffix in (".h", ".cpp") and p.is_file())


def lines(paths):
    return sum(p.read_text(encoding="utf-8").count("\n") for p in paths)


def room_of(relative):
    """The folder that a file below src/livens counts for: a room, or one of its folders."""
    parent = relative.parent
    while str(parent) not in FOLDERS and len(parent.parts) > 1:
        parent = parent.parent
    return str(parent)


def graph_of(root):
    base = root / "src" / "livens"
    return {str(p.relative_to(base)): [name for name in INCLUDE.findall(without_comments(p.read_text(encoding="utf-8")))]
            for p in sources(root)}


def depth(graph):
    """Of includes: the longest way down from a source, in files; circles have none."""
    known = {}

    def of(name):
        if name not in known:
            known[name] = 0   # a circle ends here
            known[name] = 1 + max((of(other) for other in graph.get(name, ())), default=0)
        return known[name]

    return max((of(name), name) for name in graph)


def closure(graph, name):
    seen, todo = set(), [name]
    while todo:
        for other in graph.get(todo.pop(), ()):
            if other not in seen:
                seen.add(other)
                todo.append(other)
    return seen


def up_arrows(graph):
    """Pairs of folders of one room, lower -> upper."""
    return sorted({(room_of(pathlib.Path(name)), up) for name, others in graph.items() for other in others
                   if (up := runs_up(pathlib.Path(name), "livens/" + other))})


def circles(root):
    check = Check(root)
    graph = {}
    for path, room in check_floors.files_with_rooms(root):
        if room in check_floors.FLOOR and root / "tests" not in path.parents:
            graph[path] = check_floors.check_includes(Check(root), path, room, path.read_text(encoding="utf-8"))
    check_floors.check_circles(check, graph)
    return len(check.faults)


def functions(root):
    paths = sources(root)
    listing = check_floors.tags(paths, ["--kinds-C++=f", "--fields=+ne", "--_xformat=%{end}\t%n\t%N\t%F"])
    return None if listing is None else [int(end) - int(start) + 1 for end, start, *_ in listing if end]


def members(root):
    """(members with those of inner classes, class), the most first."""
    found = check_floors.members_of_classes(root)
    return None if found is None else sorted(((len(places), name) for name, places in found.items()), reverse=True)


def comment_share(paths):
    found = total = 0
    for path in paths:
        for line in path.read_text(encoding="utf-8").split("\n"):
            if "SPDX-License-Identifier" in line:
                continue
            total += bool(line.strip())
            found += line.strip().startswith(("//", "/*", "*"))
    return 100 * found / max(total, 1)


def percentile(values, share):
    return sorted(values)[min(len(values) - 1, int(share * len(values)))]


def steering_catches(root):
    """catch (InputError) of the core: where a complaint decides what is done."""
    core = {room for rooms in check_floors.FLOORS[:check_floors.FLOORS.index(["io"])] for room in rooms}
    return sum(len(re.findall(r"catch \((?:const )?InputError\b", without_comments(p.read_text(encoding="utf-8"))))
               for p in sources(root) if p.relative_to(root / "src/livens").parts[0] in core)


def measure(root):
    """Rows: (measure, figure, bound as text, whether it holds)."""
    rows = []

    def row(name, figure, bound="", holds=True):
        rows.append((name, str(figure), bound, holds))

    src = sources(root)
    headers, code = [p for p in src if p.suffix == ".h"], [p for p in src if p.suffix == ".cpp"]
    count = lines(src)
    row("lines of src", f"{count:,}", "<= 51,200", count <= 51200)
    row("lines of apps", f"{lines(sources(root, 'apps')):,}")
    row("lines of tests in C++", f"{lines(sources(root, 'tests')):,}")
    graph = graph_of(root)
    n = circles(root)
    row("circles of includes", n, "0", n == 0)
    up = up_arrows(graph)
    row("arrows that run up inside a room", len(up), "0", not up)
    far, deepest = depth(graph)
    row("include depth", f"{far} ({deepest})", "<= 14", far <= 14)
    wide = max((len(closure(graph, name)), name) for name in graph if name.endswith(".h"))
    row("widest header closure", f"{wide[0]} ({wide[1]})")
    seen = collections.Counter(other for name in graph if name.endswith(".cpp") for other in closure(graph, name))
    row("sources that model.h recompiles", f"{seen['multibody/model.h']} of {len(code)}")
    rooms = collections.Counter()
    for path in src:
        rooms[room_of(path.relative_to(root / "src/livens"))] += path.read_text(encoding="utf-8").count("\n")
    largest, size = rooms.most_common(1)[0]
    row("largest room", f"{size:,} ({largest})", "< 8,000", size < 8000)
    found = functions(root)
    if found is not None:
        short = 100 * sum(n <= 40 for n in found) / len(found)
        row("functions within 40 lines", f"{short:.1f} % of {len(found):,}", ">= 99 %", short >= 99)
        most = members(root)
        row("data members of a class, nested ones counted", ", ".join(f"{n} {name}" for n, name in most[:3]), "<= 15",
            most[0][0] <= 15)
    for name, paths in (("header", headers), ("source", code)):
        sizes = [p.read_text(encoding="utf-8").count("\n") for p in paths]
        row(f"{name}, lines: median, p90, most", f"{statistics.median(sizes):.0f}, {percentile(sizes, 0.9)}, {max(sizes)}")
    share = comment_share(code)
    row("comment lines in sources", f"{share:.1f} %", ">= 6 %", share >= 6)
    row("comment lines in headers", f"{comment_share(headers):.1f} %")
    window = next(p for p in headers if p.name == "window.h" and p.parent.name == "march")
    virtual = len(re.findall(r"\bvirtual (?!~)", re.search(r"class Window \{.*?^\};", window.read_text(encoding="utf-8"),
                                                           re.S | re.M).group(0)))
    row("virtual functions of Window", virtual, "<= 8", virtual <= 8)
    eigen = sum(bool(re.search(r"#include <Eigen", p.read_text(encoding="utf-8"))) for p in src)
    row("sources that include Eigen", eigen, "<= 6", eigen <= 6)
    steer = steering_catches(root)
    row("catches of InputError that steer", steer, "0", steer == 0)
    installed = (root / "cmake/headers.txt").read_text(encoding="utf-8").split()
    row("headers installed", f"{len(installed)} of {len(headers)}")
    return rows


def main():
    root = pathlib.Path(sys.argv[1]).resolve()
    rows = measure(root)
    print("| measure | figure | bound |\n| --- | --- | --- |")
    for name, figure, bound, holds in rows:
        print(f"| {name} | {figure} | {bound}{'' if holds else ' **passed**'} |")
    return int("--check" in sys.argv and not all(holds for *_, holds in rows))


if __name__ == "__main__":
    sys.exit(main())
