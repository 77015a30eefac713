# SPDX-License-Identifier: BSD-3-Clause
"""Messages, summaries, help, docstrings and the pages where users look first, in the words of the field: the left
column of "Words of messages" in docs/notation.md stands in no string of the sources and of the package, and in no page of
PAGES outside of code.

    check_words.py ROOT
    check_words.py ROOT --controls     small trees with one fault each, every one of which must be refused
"""
import ast
import pathlib
import re
import sys
import tempfile

HEADING = "## Words of messages"
LITERAL = re.compile(r'"((?:[^"\\\n]|\\.)*)"')
FENCE = re.compile(r"^```.*?^```|`[^`\n]*`", re.M | re.S)
PAGES = ("scenario", "results", "program", "trust")
FOLDERS = ("joints", "loads", "drives", "sensors")
RAW = re.compile(r'R"(\w*)\((.*?)\)\1"', re.S)


def glossary(root):
    """(phrase, what to write) of the table: all that is in backticks in its left column."""
    text = (root / "docs/notation.md").read_text(encoding="utf-8")
    section = text.partition(HEADING)[2].partition("\n## ")[0]
    rows = [line.split("|")[1:3] for line in section.splitlines() if line.startswith("| `")]
    return [(phrase, instead.strip()) for words, instead in rows for phrase in re.findall(r"`([^`]+)`", words)]


def of_cpp(text):
    """(line, sentence): literals that follow one another are one."""
    plain = RAW.sub(lambda m: "\n" * m[0].count("\n"), text)
    plain = "\n".join("" if line.lstrip().startswith(("//", "#include")) else line for line in plain.split("\n"))
    for m in re.finditer(r'"(?:[^"\\\n]|\\.)*"(?:\s*"(?:[^"\\\n]|\\.)*")*', plain):
        yield plain.count("\n", 0, m.start()) + 1, "".join(LITERAL.findall(m[0])).replace('\\"', '"')
    for m in RAW.finditer(text):
        yield text.count("\n", 0, m.start()) + 1, m[2]


def of_python(text):
    for node in ast.walk(ast.parse(text)):
        if isinstance(node, ast.Constant) and isinstance(node.value, str):
            yield node.lineno, " ".join(node.value.split())


def of_page(text):
    """Paragraphs and rows of tables, without code."""
    plain = FENCE.sub(lambda m: re.sub(r"[^\n]", " ", m[0]), text)
    at = 1
    for part in re.split(r"(\n\n+)", plain):
        yield at, " ".join(part.split())
        at += part.count("\n")


def check(root):
    phrases = glossary(root)
    faults = [] if phrases else ["docs/notation.md: no words of messages [glossary]"]
    found = [(re.compile(r"(?<!\w)" + re.escape(phrase) + r"(?!\w)"), phrase, instead) for phrase, instead in phrases]
    files = [(of_cpp, path) for folder in ("src/livens", "apps") for end in ("cpp", "h")
             for path in sorted((root / folder).rglob(f"*.{end}"))]
    files += [(of_python, path) for path in sorted((root / "python").rglob("*.py")) if "tests" not in path.parts]
    pages = [root / f"docs/{name}.md" for name in PAGES]
    pages += [path for name in FOLDERS for path in sorted((root / "docs" / name).glob("*.md"))]
    files += [(of_page, path) for path in pages if path.exists()]
    for strings, path in files:
        for line, sentence in strings(path.read_text(encoding="utf-8")):
            faults += [f"{path.relative_to(root)}:{line}: \"{phrase}\": {instead} [wording]"
                       for pattern, phrase, instead in found if pattern.search(sentence)]
    return faults


TABLE = f"# N\n\n{HEADING}\n\n| not | but |\n| --- | --- |\n| `a text`, `off its balance` | string; energy error |\n\n## More\n\n| `fine` | x |\n"
GOOD = {"docs/notation.md": TABLE, "src/livens/io/a.cpp": '// a text\nconst char* a = "a string";\nint a_text = fine;\n',
        "python/livens/a.py": "# a text\nA = 'context, a texture, fine'\n",
        "docs/results.md": "# R\n\nA string, `a text`.\n\n```sh\na text\n```\n", "docs/theory.md": "a text\n"}
CONTROLS = [{"src/livens/io/b.cpp": 'const char* b = "must be a text";\n'},
            {"src/livens/io/b.h": 'const char* b = "is off "\n    "its balance by";\n'},
            {"apps/livens/b.cpp": 'const char* b = R"(off its balance)";\n'},
            {"python/livens/b.py": 'def f():\n    """Takes a\n    text."""\n'},
            {"python/livens/b.py": "raise TypeError(f'{x} is no number but a text')\n"},
            {"docs/program.md": "# P\n\nIt is off\nits balance.\n"}, {"docs/joints/a.md": "| `k` | must be a text |\n"},
            {"docs/notation.md": TABLE.replace(HEADING, "## Other words")}]


def run_controls():
    missed = []
    for i, control in enumerate([{}, *CONTROLS]):
        with tempfile.TemporaryDirectory() as folder:
            for name, text in {**GOOD, **control}.items():
                path = pathlib.Path(folder) / name
                path.parent.mkdir(parents=True, exist_ok=True)
                path.write_text(text, encoding="utf-8")
            faults = check(pathlib.Path(folder))
        if len(faults) != (1 if control else 0):
            missed.append(f"control {i} has {len(faults)} faults: {control} {faults}")
    return missed


def main():
    is_control = "--controls" in sys.argv
    faults = run_controls() if is_control else check(pathlib.Path(sys.argv[1]).resolve())
    print("\n".join(faults) or ("negative controls of words: good" if is_control else "words of messages: good"))
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())
