# SPDX-License-Identifier: BSD-3-Clause
"""The documents agree with the sources. Standard library only.

    check_docs.py ROOT              code names, links and examples
    check_docs.py ROOT --controls   small trees with one fault each, every one of which must be refused

Code names: in docs/notation.md, what stands in backticks in a table's column "code". `Type::member` is looked
up inside the declaration of Type, a plain name anywhere in src/livens or apps; comments and strings do not
count.
Links: relative ones of every .md file, with their #anchors.
Examples: every examples/*.toml and *.cpp is named in README.md or docs/examples.md, and those name no other.
Version: that of src/livens/base/version.h is the one that README.md, docs/install.md, CITATION.cff and packaging/ name.
"""
import argparse
import pathlib
import re
import sys

from check_floors import report, run_controls, without_comments


def code_without_strings(root):
    texts = []
    for folder in ("src/livens", "apps"):
        for path in sorted((root / folder).rglob("*")):
            if path.suffix in (".h", ".cpp"):
                text = without_comments(path.read_text(encoding="utf-8"))
                texts.append(re.sub(r'^\s*#.*$|"(?:\\.|[^"\\\n])*"', "", text, flags=re.M))
    return "\n".join(texts)


def declarations(code, name):
    """The bodies {...} of class, struct, enum or namespace `name`."""
    for match in re.finditer(rf"\b(?:class|struct|enum(?:\s+class)?|namespace)\s+{name}\b[^;{{()]*\{{", code):
        depth, end = 1, match.end()
        while depth and end < len(code):
            depth += {"{": 1, "}": -1}.get(code[end], 0)
            end += 1
        yield code[match.end():end]


def exists(code, name):
    """Whether `A::B::c` is in the code, each part inside the one before; <...> and () are left out."""
    parts = re.sub(r"<.*>|\(.*\)", "", name).split("::")
    if not all(re.fullmatch(r"[A-Za-z_]\w*", part) for part in parts):
        return False
    scopes = [code]
    for part in parts[:-1]:
        scopes = [body for scope in scopes for body in declarations(scope, part)]
    return any(re.search(rf"\b{parts[-1]}\b", scope) for scope in scopes)


def code_names(text):
    """(line, name) of everything in backticks in the columns headed `code`."""
    column = None
    for number, line in enumerate(text.split("\n"), 1):
        cells = [cell.strip() for cell in re.split(r"(?<!\\)\|", line.strip().strip("|"))]
        if not line.lstrip().startswith("|"):
            column = None
        elif column is None:
            column = next((i for i, cell in enumerate(cells) if cell.lower() in ("code", "code name")), -1)
        elif 0 <= column < len(cells):
            for name in re.findall(r"`([^`]+)`", cells[column]):
                yield number, name


def check_notation(root):
    path = root / "docs" / "notation.md"
    if not path.is_file():
        return ["docs/notation.md: missing [notation]"]
    code = code_without_strings(root)
    names = list(code_names(path.read_text(encoding="utf-8")))
    faults = [f"docs/notation.md:{line}: no `{name}` in the sources [notation]"
              for line, name in names if not exists(code, name)]
    return faults or ([] if names else ["docs/notation.md: no column of code names [notation]"])


def documents(root):
    """The project's own: nothing below a build folder, a hidden one or packages of others."""
    for path in sorted(root.rglob("*.md")):
        parts = path.relative_to(root).parts
        if not any(part.startswith(".") or part == "node_modules" for part in parts) and parts[0] != "build":
            yield path


def prose(text):
    """The text without code, in which nothing is a link."""
    return re.sub(r"```.*?```|`[^`\n]*`", lambda m: re.sub(r"[^\n]", " ", m.group(0)), text, flags=re.S)


def anchors(path):
    """As GitHub makes them of headings."""
    found = set()
    text = re.sub(r"```.*?```", "", path.read_text(encoding="utf-8"), flags=re.S)
    for heading in re.findall(r"^#{1,6}\s+(.+?)\s*#*$", text, re.M):
        words = re.sub(r"[^\w\- ]", "", heading.lower())
        found.add(words.replace(" ", "-"))
    return found


def check_links(root):
    faults = []
    for path in documents(root):
        text = prose(path.read_text(encoding="utf-8"))
        for match in re.finditer(r"\]\(\s*<?([^)\s>]+)>?[^)]*\)|\bsrc(?:set)?=\"([^\"]+)\"", text):
            target, _, anchor = (match.group(1) or match.group(2)).partition("#")
            if re.match(r"[a-z]+:", target):
                continue
            where = f"{path.relative_to(root)}:{text.count(chr(10), 0, match.start()) + 1}"
            file = (path.parent / target).resolve() if target else path
            if not file.exists() or root not in [file, *file.parents]:
                faults.append(f"{where}: no such file, {target} [link]")
            elif anchor and file.suffix == ".md" and anchor not in anchors(file):
                faults.append(f"{where}: no heading #{anchor} in {file.name} [link]")
    return faults


def check_examples(root):
    there = {path.name for suffix in ("*.toml", "*.cpp") for path in (root / "examples").glob(suffix)}
    named = set()
    for document in ("README.md", "docs/examples.md"):
        if (root / document).is_file():
            text = (root / document).read_text(encoding="utf-8")
            named |= set(re.findall(r"examples/([\w.-]+\.(?:toml|cpp))\b", text))
    return [*(f"examples/{name}: not named in README.md or docs/examples.md [example]"
              for name in sorted(there - named)),
            *(f"examples/{name}: named in the documents, but missing [example]"
              for name in sorted(named - there))]


VERSIONS = {"README.md": r"Version (\d+\.\d+\.\d+)", "docs/install.md": r"livens(?:-dev)?[_-](\d+\.\d+\.\d+)",
            "CITATION.cff": r"^version: (.*)$", "packaging/debian/changelog": r"^livens \(([\d.]+)\) ",
            "packaging/vcpkg/vcpkg.json": r'"version": "(.*)"', "packaging/conda/meta.yaml": r'set version = "(.*)"'}


def check_version(root):
    version = re.search(r'version = "(.*)"', (root / "src/livens/base/version.h").read_text(encoding="utf-8")).group(1)
    faults = []
    for name, pattern in VERSIONS.items():
        if not (root / name).is_file():
            faults.append(f"{name}: missing [version]")
            continue
        named = re.findall(pattern, (root / name).read_text(encoding="utf-8"), re.M)
        if name.endswith("changelog"):   # older ones follow
            del named[1:]
        faults += [f"{name}: names version {other}, not {version} [version]" for other in named if other != version]
        if not named:
            faults.append(f"{name}: names no version [version]")
    return faults


def check_docs(root):
    root = root.resolve()
    return check_notation(root) + check_links(root) + check_examples(root) + check_version(root)


GOOD = {
    "src/livens/multibody/body.h": "struct Body {\n    Matrix4 mass{};   // inertia\n"
                                   "    struct In { int deep; };\n};\ndouble norm();\n"
                                   "enum class Side { left, right };\n",
    "src/livens/multibody/other.h": 'class Other {\n    int size() const { return 1; }\n    int last;\n};\n'
                                    '"quoted";\n',
    "docs/notation.md": "# Notation\n\n| symbol | code | unit |\n| --- | --- | --- |\n"
                        "| m | `Body::mass`, `norm` | `kg` |\n"
                        "| n | `Other::last`, `Body::In::deep`, `Side::left` | |\n\n"
                        "`loose` [up](../README.md#first-steps-2)\n",
    "README.md": "# First steps: 2\n\n[n](docs/notation.md) `[no](link)` [w](https://example.org)\n"
                 "examples/one.toml\nVersion 1.2.3\n",
    "examples/one.toml": "",
    "src/livens/base/version.h": 'const char* version = "1.2.3";\n',
    "docs/install.md": "livens_1.2.3_amd64.deb\n",
    "CITATION.cff": "version: 1.2.3\n",
    "packaging/debian/changelog": "livens (1.2.3) unstable\n",
    "packaging/vcpkg/vcpkg.json": '"version": "1.2.3"\n',
    "packaging/conda/meta.yaml": '{% set version = "1.2.3" %}\n',
}

CONTROLS = [
    ("notation", {"docs/notation.md": "| code |\n|---|\n| `Body::weight` |\n"}),
    ("notation", {"docs/notation.md": "| code |\n|---|\n| `Body::last` |\n"}),
    ("notation", {"docs/notation.md": "| a | code |\n|---|---|\n| | `inertia` |\n"}),
    ("notation", {"docs/notation.md": "| code |\n|---|\n| `quoted` |\n"}),
    ("notation", {"docs/notation.md": "| code |\n|---|\n| `m[0]` |\n"}),
    ("notation", {"docs/notation.md": "no table\n"}),
    ("link", {"docs/more.md": "[gone](gone.md)\n"}),
    ("link", {"docs/more.md": '<picture><source srcset="gone.webp"></picture>\n'}),
    ("link", {"docs/more.md": "![picture](../gone.png)\n"}),
    ("link", {"docs/more.md": "[gone](notation.md#gone)\n"}),
    ("link", {"docs/more.md": "[out](../../../)\n"}),
    ("example", {"examples/two.toml": ""}),
    ("example", {"docs/examples.md": "examples/three.toml\n"}),
    ("version", {"CITATION.cff": "version: 1.2.4\n"}),
    ("version", {"docs/install.md": "liblivens-dev_1.2.2_amd64.deb\n"}),
    ("version", {"src/livens/base/version.h": 'const char* version = "1.3.0";\n'}),
]


def main():
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("root", type=pathlib.Path)
    parser.add_argument("--controls", action="store_true")
    options = parser.parse_args()
    if options.controls:
        return report(run_controls(check_docs, CONTROLS, [GOOD]), "negative controls of the documents")
    return report(check_docs(options.root), "documents")


if __name__ == "__main__":
    sys.exit(main())
