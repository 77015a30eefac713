# SPDX-License-Identifier: BSD-3-Clause
"""Whether the faults of tests/mutants can be made, long before one is built: each old text stands exactly once in its file, a
header names the sources that see it, and those and the tests that must fail are there. check_faults.py ROOT; --controls makes
each of these mistakes and must be told of all of them."""
import pathlib
import re
import sys

FAULT = re.compile(r"^livens_mutant\((.*?)(?=^livens_mutant\(|\Z)", re.M | re.S)
TEXT = re.compile(r"\b(OLD|NEW)\s+\[(=*)\[(.*?)\]\2\]", re.S)
LISTS = re.compile(r"\b(NAME|FILE|TESTS_OF|MUST_FAIL|RECOMPILE)\s+([^()]*?)(?=\s+(?:NAME|FILE|TESTS_OF|MUST_FAIL|RECOMPILE|TEXT)\b|\))")


def source(root, file):
    return root / file if file.startswith("apps/") else root / "src/livens" / file


def mistakes_of(root, block):
    texts = {which: text for which, _, text in TEXT.findall(block)}
    rest = TEXT.sub("TEXT", block)
    parts = {key: value.split() for key, value in LISTS.findall(rest)}
    if "]]" in rest:
        return [f"{parts['NAME'][0]}: a text ends early, at the first ]] in it: [=[ and ]=] may be around it"]
    name, file = parts["NAME"][0], parts["FILE"][0]
    if not texts.get("NEW"):
        return [f"{name}: its new text is empty"]
    if not source(root, file).is_file():
        return [f"{name}: there is no {file}"]
    found = []
    times = source(root, file).read_text().count(texts["OLD"].removeprefix("\n"))
    if times != 1:
        found.append(f"{name}: its old text stands {times} times in {file}")
    again = parts.get("RECOMPILE", [])
    if not again and not file.endswith(".cpp"):
        found.append(f"{name}: no source is named to RECOMPILE with the header {file}")
    found += [f"{name}: there is no {path} to RECOMPILE" for path in again if not source(root, path).is_file()]
    return found


def mistakes(root, text):
    blocks = FAULT.findall(re.sub(r"^\s*#.*\n", "", text, flags=re.M))
    return len(blocks), [mistake for block in blocks for mistake in mistakes_of(root, block)]


def control(root, text):
    """Every kind of mistake is seen."""
    block = next(b for b in FAULT.findall(text) if re.search(r"FILE \S+\.h\s", b) and "RECOMPILE" in b)
    file = re.search(r"FILE (\S+)", block).group(1)
    wrong = {"old text": TEXT.sub("OLD [[no such line anywhere]]", block, count=1),
             "is empty": re.sub(r"NEW \[\[.*?\]\]", "NEW [[]]", block, flags=re.S),
             "ends early": block.replace("OLD [[", "OLD [[a[b[c]] = ", 1),
             "no source": re.sub(r"RECOMPILE [^A-Z]*", "", block),
             "to RECOMPILE": re.sub(r"(RECOMPILE )", r"\1nowhere/gone.cpp ", block),
             "there is no": block.replace(f"FILE {file}", "FILE nowhere/gone.cpp")}
    blind = [words for words, changed in wrong.items() if not any(words in said for said in mistakes_of(root, changed))]
    return [f"control: '{words}' is not seen" for words in blind]


def main():
    arguments = [argument for argument in sys.argv[1:] if argument != "--controls"]
    root = pathlib.Path(arguments[0] if arguments else ".").resolve()
    text = (root / "tests/mutants/faults.cmake").read_text()
    if "--controls" in sys.argv:
        found = control(root, text)
    else:
        n, found = mistakes(root, text)
        if n < 100:
            found.append(f"{n} faults were read: this check no longer reads how they are written")
    for line in found:
        print(line, file=sys.stderr)
    sys.exit(1 if found else 0)


if __name__ == "__main__":
    main()
