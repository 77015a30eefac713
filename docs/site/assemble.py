# SPDX-License-Identifier: BSD-3-Clause
"""Lays out the pages of the site from what the project has: assemble.py ROOT PROGRAM FOLDER

    documents     docs/*.md, docs/howto, docs/coming_from: links are turned to where things lie on the site
    types         docs/joints, docs/loads, docs/drives, docs/sensors: a page a type, with an index of pictures
    theory        docs/theory.md, one page a section
    diagnostics   docs/diagnostics.md, one page a code
    gallery       every example, solved by PROGRAM, with its report; scripts and notebooks of Python
    reference     what PROGRAM says of itself, one page a public header

Between `<!-- tabs -->` and `<!-- /tabs -->` each line that is bold alone begins a tab. Standard library only.
"""
from __future__ import annotations

import base64
import json
import os
import pathlib
import re
import shutil
import subprocess
import sys

FENCE = re.compile(r"^(`{3,})[^\n]*\n.*?^\1[ \t]*$", re.M | re.S)


def slug(heading: str) -> str:
    """The anchor that GitHub and MyST make of a heading."""
    return re.sub(r"[^\w\- ]", "", re.sub(r"[`*]", "", heading).lower()).strip().replace(" ", "-")


def outside_fences(text: str, change) -> str:
    """`change` of all text but fenced code."""
    out, at = [], 0
    for fence in FENCE.finditer(text):
        out += [change(text[at:fence.start()]), fence.group(0)]
        at = fence.end()
    return "".join([*out, change(text[at:])])


def sections(text: str, level: int = 2) -> tuple[str, list[tuple[str, str]]]:
    """What stands before the first heading of this level, and (heading, text) of each; fenced text has none."""
    hidden = FENCE.sub(lambda m: re.sub(r"[^\n]", " ", m.group(0)), text)
    heads = list(re.finditer(rf"^{'#' * level} (.+)$", hidden, re.M))
    ends = [head.start() for head in heads[1:]] + [len(text)]
    first = heads[0].start() if heads else len(text)
    return text[:first], [(head.group(1).strip(), text[head.end():end]) for head, end in zip(heads, ends)]


def formulas(text: str) -> str:
    """Formulas within sentences as MyST has them. GitHub is given $`x`$ where Markdown would take `_`, `~`,
    or a backslash before anything but a letter out of $x$."""
    return outside_fences(text, lambda part: re.sub(r"\$`([^`\n]+)`\$", r"$\1$", part))


UNITS = r"(?:m|mm|cm|km|kg|g|s|ms|Hz|N|kN|N m|J|W|kW|rad|deg|rpm|Pa|MPa|GPa|MB|kB|h|min)"


def unbroken(text: str) -> str:
    """No line ends between a number and its unit. Headings stay as they are: anchors are made of them."""
    spans = re.compile(r"(^#.*$|`+[^`\n]*`+|\$[^$\n]*\$|\]\([^)\n]*\))", re.M)

    def change(part: str) -> str:
        pieces = spans.split(part)
        pieces[::2] = [re.sub(rf"(?<=[0-9]) (?={UNITS}(?![\w-]))", "\u00a0", piece) for piece in pieces[::2]]
        return "".join(pieces)

    return outside_fences(text, change)


def raised(text: str) -> str:
    """All headings one level up."""
    return outside_fences(text, lambda part: re.sub(r"^##", "#", part, flags=re.M))


class Site:
    def __init__(self, root: pathlib.Path, program: pathlib.Path, folder: pathlib.Path) -> None:
        self.root, self.program, self.folder = root, program, folder
        self.where: dict[tuple[str, str], tuple[str, str]] = {}   # (file, anchor) -> (page, anchor)
        self.pages: dict[str, tuple[str, str]] = {}   # page -> (file that it is from, text)
        self.copies: dict[str, pathlib.Path] = {}

    def run(self, *words: str) -> str:
        environment = {**os.environ, "NO_COLOR": "1", "COLUMNS": "100"}
        done = subprocess.run([str(self.program), *words], capture_output=True, text=True, env=environment,
                              check=False)
        if done.returncode:
            sys.exit(f"livens {' '.join(words)}: {done.stderr}")
        return done.stdout

    def add(self, page: str, text: str, source: str = "") -> None:
        self.pages[page] = (source, text)
        if source:
            self.where.setdefault((source, ""), (page, ""))

    def known_anchors(self, source: str, text: str, page: str, is_top: bool) -> None:
        """Headings of a part of `source` lie on `page`; the first one is the page itself, if it is at the top."""
        hidden = FENCE.sub("", text)
        for number, heading in enumerate(re.findall(r"^#{1,6} (.+?)\s*$", hidden, re.M)):
            self.where[source, slug(heading)] = (page, "" if is_top and number == 0 else slug(heading))

    # ---- links

    def target(self, source: str, page: str, link: str) -> str | None:
        """Where a link of the repository leads on the site; None: nowhere."""
        path, _, anchor = link.partition("#")
        base = pathlib.PurePosixPath(source).parent
        file = os.path.normpath(str(base / path)) if path else source
        here = os.path.dirname(page)
        if (file, anchor) in self.where:
            to, mark = self.where[file, anchor]
            return os.path.relpath(f"{to}.md", here or ".") + (f"#{mark}" if mark else "")
        if anchor and (file, "") in self.where:
            sys.exit(f"{source}: nothing on the site for {link}")
        if file in self.copies or (self.root / file).is_file() and file.startswith("docs/figures/"):
            copy = file.removeprefix("docs/")
            self.copies[copy] = self.root / file
            return os.path.relpath(copy, here or ".")
        if (self.root / file).exists():
            return None
        sys.exit(f"{source}: no such file, {link}")

    def relinked(self, source: str, page: str, text: str) -> str:
        def of_link(match: re.Match[str]) -> str:
            bang, words, link = match.groups()
            if re.match(r"[a-z]+:", link):
                return match.group(0)
            to = self.target(source, page, link)
            if to is not None:
                file = link.partition("#")[0].rpartition("/")[2]
                is_name = not bang and words in (file, f"docs/{file}")
                return f"{bang}[{'' if is_name else words}]({to})"   # without words: the title of the page
            name = os.path.normpath(str(pathlib.PurePosixPath(source).parent / link.partition("#")[0]))
            return f"{words} (`{name}` of the sources)" if name not in words else words

        spans = re.compile(r"(`+[^`\n]*`+)")

        def change(part: str) -> str:
            # Links may have code as their words, and code may look like a link: only whole links are touched.
            hidden = spans.sub(lambda m: "\x00" * len(m.group(0)), part)
            out, at = [], 0
            for match in re.finditer(r"(!?)\[((?:[^\[\]]|\[[^\]]*\])*)\]\(\s*<?([^)\s>]+)>?\s*\)", hidden):
                whole = re.match(r"(!?)\[((?:[^\[\]]|\[[^\]]*\])*)\]\(\s*<?([^)\s>]+)>?\s*\)$",
                                 part[match.start():match.end()], re.S)
                if whole is None or "\x00" in match.group(3):
                    continue
                out += [part[at:match.start()], of_link(whole)]
                at = match.end()
            return "".join([*out, part[at:]])

        return outside_fences(text, change)

    def write(self) -> None:
        wanted = set()
        for page, (source, text) in self.pages.items():
            file = self.folder / f"{page}.md"
            wanted.add(file)
            if source:
                text = self.relinked(source, page, text)
            put(file, tabs(re.sub(r"^```math$", "```{math}", unbroken(formulas(text)), flags=re.M)))
        for copy, source in self.copies.items():
            file = self.folder / copy
            wanted.add(file)
            if not file.exists() or file.read_bytes() != source.read_bytes():
                file.parent.mkdir(parents=True, exist_ok=True)
                shutil.copyfile(source, file)
        for file in list(self.folder.rglob("*")):   # pages of documents that are gone
            if file.is_file() and file not in wanted and "_reports" not in file.parts:
                file.unlink()


def put(file: pathlib.Path, text: str) -> None:
    """Only what changed is written, so that Sphinx reads only that again."""
    if not file.exists() or file.read_text(encoding="utf-8") != text:
        file.parent.mkdir(parents=True, exist_ok=True)
        file.write_text(text, encoding="utf-8")


def tabs(text: str) -> str:
    def of_block(match: re.Match[str]) -> str:
        parts = re.split(r"^\*\*([^*\n]+)\*\*[ \t]*$", match.group(1), flags=re.M)
        items = [f":::{{tab-item}} {name}\n:sync: {slug(name)}\n\n{body.strip()}\n:::\n"
                 for name, body in zip(parts[1::2], parts[2::2])]
        return "::::{tab-set}\n" + "\n".join(items) + "::::\n"

    return re.sub(r"^<!-- tabs -->\n(.*?)^<!-- /tabs -->$", of_block, text, flags=re.M | re.S)


def toctree(entries: list[str], caption: str = "", hidden: bool = False, depth: int = 1) -> str:
    options = (f":caption: {caption}\n" if caption else "") + (":hidden:\n" if hidden else "")
    return "```{toctree}\n" + options + f":maxdepth: {depth}\n\n" + "\n".join(entries) + "\n```\n"


# ---- documents

PLAIN = ["tutorial", "install", "joints", "python", "scenario", "program", "results", "notation", "architecture", "validation",
         "performance", "paper", "trust"]


def add_documents(site: Site) -> None:
    for name in PLAIN:
        text = (site.root / "docs" / f"{name}.md").read_text(encoding="utf-8")
        site.known_anchors(f"docs/{name}.md", text, name, True)
        site.add(name, text, f"docs/{name}.md")
    for folder in ("howto", "coming_from"):
        files = sorted((site.root / "docs" / folder).glob("*.md"))
        for file in files:
            text = file.read_text(encoding="utf-8")
            page = f"{folder}/{'index' if file.stem == 'README' else file.stem}"
            source = f"docs/{folder}/{file.name}"
            site.known_anchors(source, text, page, True)
            if file.stem == "README":
                site.where[f"docs/{folder}", ""] = (page, "")
                named = list(dict.fromkeys(re.findall(r"\]\(([\w-]+)\.md\)", text)))
                missing = {f.stem for f in files} - {"README", *named}
                if missing:
                    sys.exit(f"{source} does not name {', '.join(sorted(missing))}")
                text += "\n" + toctree(named, hidden=True)
            site.add(page, text, source)


TYPES = {"joints": "Joint types", "drives": "Drive types", "loads": "Load types", "sensors": "Sensor types"}


def add_types(site: Site) -> None:
    """In the order of the table on docs/scenario.md."""
    text = (site.root / "docs/scenario.md").read_text(encoding="utf-8")
    for folder, title in TYPES.items():
        names = re.findall(rf"^\| \[`\w+`\]\({folder}/(\w+)\.md\)", text, re.M)
        cards = []
        for name in names:
            source, page = f"docs/{folder}/{name}.md", f"{folder}/{name}"
            words = (site.root / source).read_text(encoding="utf-8")
            site.known_anchors(source, words, page, True)
            site.add(page, words, source)
            site.copies[f"figures/{folder}/{name}.svg"] = site.root / f"docs/figures/{folder}/{name}.svg"
            lead = " ".join(words.split("\n\n")[2].split())
            cards.append(f"::::{{grid-item-card}} {name}\n:link: {name}\n:link-type: doc\n:img-top: ../figures/{folder}/{name}.svg\n\n{lead}\n::::\n")
        if not names:
            sys.exit(f"docs/scenario.md lists no {folder}")
        key = f"../scenario.md#{folder.removesuffix('s')}"
        site.add(f"{folder}/index", f"# {title}\n\nKeys that all of them have are in [scenario files]({key}).\n\n:::::{{grid}} 1 2 3 3\n:gutter: 3\n\n"
                 + "".join(cards) + ":::::\n\n" + toctree(names, hidden=True))


def add_theory(site: Site) -> None:
    source = "docs/theory.md"
    head, parts = sections((site.root / source).read_text(encoding="utf-8"))
    names = []
    for heading, text in parts:
        name = slug(heading)
        names.append(name)
        page = f"theory/{name}"
        whole = f"## {heading}{text}"
        site.known_anchors(source, whole, page, True)
        site.add(page, raised(whole), source)
    site.where[source, ""] = ("theory/index", "")
    site.pages["theory/index"] = (source, head + "\n" + toctree(names, depth=2))


def add_diagnostics(site: Site) -> None:
    source = "docs/diagnostics.md"
    head, parts = sections((site.root / source).read_text(encoding="utf-8"))
    for code, text in parts:
        page = f"diagnostics/{code}"
        site.known_anchors(source, f"## {code}\n{text}", page, True)
        # Out of the tree at the side, which every page has: two hundred lines would bury the rest, and take a minute to make.
        site.add(page, f"---\norphan: true\n---\n\n# {code}\n{text}\n`livens explain {code}` shows this page in the terminal.\n", source)
    site.where[source, ""] = ("diagnostics/index", "")
    listed = "\n".join(f"- [{code}]({code}.md): {first_sentence(text)}" for code, text in parts)
    site.pages["diagnostics/index"] = ("", head + "\n" + listed + "\n")


def first_sentence(text: str) -> str:
    paragraph = " ".join(text.strip().split("\n\n")[0].split())
    return re.split(r"(?<=[.:])\s", paragraph)[0].rstrip(":.") + "."


# ---- gallery

def rows_of_examples(site: Site) -> dict[str, list[str]]:
    text = (site.root / "docs/examples.md").read_text(encoding="utf-8")
    lines = [[cell.strip() for cell in line.strip("|").split("|")] for line in text.split("\n") if line.startswith("| `examples/")]
    rows = {re.sub(r"`examples/(\w+)\.toml`", r"\1", first): rest for first, *rest in lines}
    if set(rows) != {file.stem for file in (site.root / "examples").glob("*.toml")}:
        sys.exit("docs/examples.md does not have a row for each examples/*.toml")
    return rows


def groups_of_examples(site: Site) -> dict[str, str]:
    """Headings of docs/examples.md by the first example below each."""
    text = (site.root / "docs/examples.md").read_text(encoding="utf-8")
    found = re.findall(r"^## (.*)$|^\| `examples/(\w+)\.toml`", text, re.M)
    return {after[1]: before[0] for before, after in zip(found, found[1:]) if before[0] and after[1]}


def add_gallery(site: Site) -> None:
    rows = rows_of_examples(site)
    groups = groups_of_examples(site)
    cards: list[str] = []
    sections = []
    for name, (shows, witness, allowed) in rows.items():
        if name in groups:
            cards = []
            sections.append((groups[name], cards))
        scenario = site.root / "examples" / f"{name}.toml"
        site.copies[f"gallery/{name}.toml"] = scenario
        report = solved_report(site, scenario)
        site.where[f"examples/{name}.toml", ""] = (f"gallery/{name}", "")
        text = scenario.read_text(encoding="utf-8")
        title = re.search(r'^title = "(.*)"', text, re.M)
        still = f"docs/figures/gallery/{name}.webp"
        if not (site.root / still).is_file():
            sys.exit(f"{still} is missing: scripts/pictures makes it")
        dark = still.replace(".webp", "_dark.webp")
        site.copies[f"gallery/{name}.webp"], site.copies[f"gallery/{name}_dark.webp"] = site.root / still, site.root / dark
        heading = title.group(1) if title else name.replace("_", " ")
        cards.append(f"::::{{grid-item-card}} {heading}\n:link: {name}\n:link-type: doc\n:class-card: still\n\n:::{{card-header}}\n"
                     f"![{heading}]({name}.webp){{.only-light}}\n![]({name}_dark.webp){{.only-dark}}\n:::\n\n{shows[0].upper()}{shows[1:]}.\n::::\n")
        kept = f"Compared in the tests with {witness or 'a closed form'}" + (f", to {allowed}." if allowed else ".")
        site.add(f"gallery/{name}", f"# {heading}\n\n{shows[0].upper()}{shows[1:]}. {kept}\n\n"
                 "```{raw} html\n"
                 f'<div class="report" data-page="../_reports/{report.name}">'
                 '<button type="button" class="still">'
                 f'<img class="only-light" src="../_stills/{name}.webp" alt="{heading}, a still" width="960" height="600">'
                 f'<img class="only-dark" src="../_stills/{name}_dark.webp" alt="" width="960" height="600"><span>Open the live report</span></button></div>\n'
                 f'<p class="aside"><a href="../_reports/{report.name}">The report on a page of its own</a>: '
                 "space plays, the arrow keys step.</p>\n```\n\n"
                 f"```sh\nlivens solve {name}.toml -o {name}.nc\nlivens view {name}.nc\n```\n\n"
                 f"{{download}}`{name}.toml`:\n\n```{{literalinclude}} {name}.toml\n:language: toml\n```\n")
    pages = [*rows]
    cards = []
    sections.append(("Python", cards))
    for file in sorted((site.root / "examples/python").glob("*.py")):
        add_script(site, file, pages, cards)
    for file in sorted((site.root / "examples/notebooks").glob("*.ipynb")):
        add_notebook(site, file, pages, cards)
    site.where["docs/examples.md", ""] = ("gallery/index", "")
    site.add("gallery/index", "# Gallery\n\nEvery example of the sources, solved while these pages were made. Each has its live report: the "
             "mechanism in space at any instant, plots that follow, and whether the answer is right. Each runs in the tests "
             "and is compared there with a reference.\n\n" +
             "".join(f"## {heading}\n\n:::::{{grid}} 1 2 2 3\n:gutter: 3\n\n" + "\n".join(some) + ":::::\n\n" for heading, some in sections) + toctree(pages, hidden=True))


def solved_report(site: Site, scenario: pathlib.Path) -> pathlib.Path:
    page = site.folder.parent / "extra" / "_reports" / f"{scenario.stem}.html"
    run = site.folder.parent / "runs" / f"{scenario.stem}.nc"
    newest = max(scenario.stat().st_mtime, site.program.stat().st_mtime)
    if not page.exists() or page.stat().st_mtime < newest:
        page.parent.mkdir(parents=True, exist_ok=True)
        run.parent.mkdir(parents=True, exist_ok=True)
        site.run("solve", str(scenario), "-o", str(run), "--quiet")
        site.run("report", str(run), "-o", str(page), "--quiet")
    stills = page.parent.parent / "_stills"
    stills.mkdir(exist_ok=True)
    for still in (site.root / "docs/figures/gallery").glob(f"{scenario.stem}*.webp"):
        shutil.copyfile(still, stills / still.name)
    return page


def add_script(site: Site, file: pathlib.Path, pages: list[str], cards: list[str]) -> None:
    name = f"python_{file.stem}"
    source = file.read_text(encoding="utf-8")
    doc = re.search(r'"""(.*?)"""', source, re.S)
    words = doc.group(1).strip() if doc else ""
    first = words.split("\n\n")[0].replace("\n", " ")
    site.copies[f"gallery/{file.name}"] = file
    site.where[f"examples/python/{file.name}", ""] = (f"gallery/{name}", "")
    site.add(f"gallery/{name}", f"# {file.name}\n\n{words}\n\n```{{literalinclude}} {file.name}\n:language: python\n```\n")
    pages.append(name)
    cards.append(f":::{{grid-item-card}} {file.name}\n:link: {name}\n:link-type: doc\n\n{first}\n:::\n")


def add_notebook(site: Site, file: pathlib.Path, pages: list[str], cards: list[str]) -> None:
    """Cells with the outputs that are stored in the notebook: text and pictures."""
    cells = json.loads(file.read_text(encoding="utf-8"))["cells"]
    joined = lambda value: value if isinstance(value, str) else "".join(value)   # noqa: E731
    name, parts, first = f"notebook_{file.stem}", [], ""
    for number, cell in enumerate(cells):
        text = joined(cell["source"]).strip()
        if cell["cell_type"] == "markdown":
            first = first or next((line for line in text.split("\n") if line and not line.startswith("#")), "")
            parts.append(text)
            continue
        if text:
            parts.append(f"```python\n{text}\n```")
        for order, output in enumerate(cell.get("outputs", [])):
            data = output.get("data", {})
            if "image/png" in data:
                picture = site.folder.parent / "runs" / f"{name}_{number}_{order}.png"
                picture.parent.mkdir(parents=True, exist_ok=True)
                picture.write_bytes(base64.b64decode(joined(data["image/png"])))
                site.copies[f"gallery/{picture.name}"] = picture
                parts.append(f"![output of the cell above]({picture.name})")
            elif "text" in output or "text/plain" in data:
                parts.append("```text\n" + joined(output.get("text", data.get("text/plain", ""))).rstrip() + "\n```")
    if not parts or not parts[0].startswith("# "):
        parts.insert(0, f"# {file.stem.replace('_', ' ').capitalize()}")
    site.copies[f"gallery/{file.name}"] = file
    site.where[f"examples/notebooks/{file.name}", ""] = (f"gallery/{name}", "")
    site.add(f"gallery/{name}", "\n\n".join([*parts, f"The notebook: {{download}}`{file.name}`."]) + "\n")
    pages.append(name)
    heading = parts[0].split("\n")[0].removeprefix("# ")
    cards.append(f":::{{grid-item-card}} {heading}\n:link: {name}\n:link-type: doc\n\n{first}\n:::\n")


# ---- reference

ROOMS = {"base": "Errors, small matrices, version", "time": "Time: elements, bases, quadrature, functions, expressions",
         "solvers": "Solvers", "geometry": "Meshes and their moments", "multibody": "Bodies, joints, loads, sensors",
         "dynamics": "Starts and reactions", "statics": "States of rest, small motions", "spacetime": "The engine", "diagnostics": "What is said of a motion", "io": "Files"}


def add_reference(site: Site) -> None:
    about = site.run("--help")
    commands = re.findall(r"^  (\w+)\s{2,}\S", about.split("Subcommands:")[1].split("\n\n")[0], re.M)
    text = "# Commands\n\nAs `livens COMMAND --help` prints them; `man livens` shows the same. What they do stands in [The program](../program.md).\n\n"
    text += f"```text\n{about.rstrip()}\n```\n"
    for command in commands:
        text += f"\n## {command}\n\n```text\n{site.run(command, '--help').rstrip()}\n```\n"
    site.add("reference/commands", text)
    add_python(site)
    headers = (site.root / "cmake/headers.txt").read_text(encoding="utf-8").split()
    pages = []
    for room, title in ROOMS.items():
        own = [header for header in headers if header.split("/")[1] == room]
        if not own:
            sys.exit(f"no headers of {room}")
        pages.append(room)
        text = f"# {title}\n"
        for header in own:
            words = header_words(site.root / "src" / header)
            copied = header.replace("/", "_")   # as scripts/docs calls it for Doxygen
            text += (f"\n## {header}\n\n{words}\n\n```{{doxygenfile}} {copied}\n:project: livens\n"
                     ":sections: innerclass innernamespace define func enum typedef var public-attrib public-func public-static-func\n```\n")
        site.add(f"reference/cpp/{room}", text)
    if set(ROOMS) != {header.split("/")[1] for header in headers}:
        sys.exit("a room of public headers has no page: ROOMS in assemble.py")
    site.add("reference/cpp/index", "# C++\n\nThe public headers, room by room; [architecture](../../architecture.md) says what a room is. "
             "`#include <livens/spacetime/solve.h>` is enough for most programs.\n\n" + toctree(pages))


PYTHON = {
    "Models": ["Model", "Added", "load", "from_urdf", "from_mjcf", "Body", "Point", "Joint", "Drive", "Stop", "Event", "Controller", "Load", "Sensor", "Section", "Entry", "Names",
               "Parameters"],
    "Shapes and tables": ["Shape", "box", "sphere", "cylinder", "capsule", "cone", "ellipsoid", "mesh", "parts", "point",
                          "tube", "table", "visual"],
    "Solving": ["solve", "solve_many", "Condition", "state", "positions", "momenta", "unknown"],
    "Methods": ["Method", "Auto", "Lobatto", "Radau", "Mixed", "Midpoint", "Endpoint", "MethodOptions"],
    "Solutions": ["Solution", "SolvedEvent", "load_solution", "Series", "BodySeries", "JointSeries", "LoadSeries", "PointSeries", "SensorSeries",
                  "ReadingSeries", "Parts", "Peak", "Extremes", "compare", "Comparison", "BodyState"],
    "States": ["Coordinates", "MechanismState", "PlacedBody", "PlacedJoint", "PlacedPoint", "reach"],
    "Rest and small motions": ["Equilibrium", "RestBody", "RestJoint", "Linearisation", "StateMatrices", "Modes",
                               "ModeBody", "ModeJoint"],
    "What is wrong": ["EquilibriumError", "InputError", "SolveError", "ResultFileError", "SolveWarning", "ModelWarning", "SlowWarning",
                      "Diagnostic", "Place", "explain"],
}


def add_python(site: Site) -> None:
    import inspect

    import livens
    names = {name for name in livens.__all__ if not name.startswith("_")}
    text = ("# Python\n\nEverything that `import livens as lv` has; the [guide](../python.md) tells how it is meant. Units are SI and "
            "axes those of the world unless said; shapes stand with every array.\n")
    for title, members in PYTHON.items():
        text += f"\n## {title}\n\n"
        for name in members:
            if name not in names:
                continue
            names.remove(name)
            kind = "autoclass" if inspect.isclass(getattr(livens, name)) or name == "MethodOptions" else "autofunction"
            text += f"```{{eval-rst}}\n.. {kind}:: livens.{name}\n```\n\n"
    if names:
        sys.exit(f"assemble.py: PYTHON does not say where {', '.join(sorted(names))} belong")
    site.add("reference/python", text)


def header_words(file: pathlib.Path) -> str:
    """The comment at the head of a header, after the licence."""
    lines = []
    for line in file.read_text(encoding="utf-8").split("\n")[1:]:
        if not line.startswith("//"):
            break
        lines.append(line.lstrip("/ "))
    return " ".join(lines)


def main() -> None:
    root, program, folder = (pathlib.Path(word).resolve() for word in sys.argv[1:])
    site = Site(root, program, folder)
    for file in sorted((root / "docs/site/pages").rglob("*.md")):
        page = str(file.relative_to(root / "docs/site/pages").with_suffix(""))
        site.add(page, file.read_text(encoding="utf-8"), str(file.relative_to(root)))
    for name in ("CHANGELOG", "THIRD_PARTY"):
        text = (root / f"{name}.md").read_text(encoding="utf-8")
        site.known_anchors(f"{name}.md", text, name.lower(), True)
        site.add(name.lower(), text, f"{name}.md")
    add_gallery(site)
    add_documents(site)
    add_types(site)
    add_theory(site)
    add_diagnostics(site)
    add_reference(site)
    site.write()
    print(f"{len(site.pages)} pages laid out")


if __name__ == "__main__":
    main()
