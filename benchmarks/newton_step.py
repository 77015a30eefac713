#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Instructions of a Newton step of all elements at once over those of a bare march on the same mesh.

    benchmarks/newton_step.py PROGRAM      PROGRAM: build/release/benchmarks/instructions

Two bricks on ball joints between their places 0.5 and 1 s after they were let go, with rates 0.9 of the true ones as a guess:
ten elements of lobatto(8). The march begins with the true rates; it has neither estimate nor growth. A step is what one takes
that makes new factors: factors, an increment by them, the move and the rows there, each on the average of the iteration's own,
counted by callgrind for each set of instructions. Then of chains from a known state, stretched out at rest, whose elements are
condensed along their joints where they are long enough. Exit status 1 where a step takes more than what is allowed, 77 without
valgrind.
"""
import collections
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile

ALLOWED = {"sse2": 4.0, "avx2": 4.0}   # marches
CHAINS = (("revolute", 10, 4.4), ("revolute", 30, 9.6), ("spherical", 10, 17.5), ("spherical", 30, 43))   # bricks, marches
PARTS = ("factorise", "solve", "move", "residual")
BODIES = {   # directors at both ends, angular velocity
    "upper": ("[[0.26354355221153770, 0.26037919819550037, -0.9288420044522065], [-0.17915318672817876, 0.9593422858365159, "
              "0.21809748804400997], [0.94786546079750310, 0.10892681833707024, 0.2994762369105436]]",
              "[[-0.8725726158355315, -0.3654751224708711, -0.3241064099163111], [-0.18668449946513416, 0.8626266686245805, "
              "-0.47013203277070004], [0.45140439492033140, -0.34971869471413736, -0.8209329490366736]]",
              (2.0491793315175473, 1.805314264530639, 1.6995943738811745)),
    "lower": ("[[0.85846427095315400, 0.25002357242405170, -0.4478027565002083], [-0.26686863996575960, 0.9633744792709679, "
              "0.02628196515136208], [0.43797285817696010, 0.09694238454724854, 0.8937460207344130]]",
              "[[-0.5193762242231155, -0.017738080529546008, -0.8543615734634062], [-0.64787083701102290, -0.6437702779115093, "
              "0.40721395829265794], [-0.55723578157040190, 0.76501319581878160, 0.32286699112909956]]",
              (-3.243185093171152, 6.71477162620708, -6.920064651590305)),
}
PLACES = {"upper": ("[0, 0, 0]", "[0, 0, 0]", (0, 0, 0)),   # of the upper end, and its velocity
          "lower": ("[0.26354355221153766, 0.26037919819550037, -0.9288420044522065]",
                    "[-0.8725726158355315, -0.3654751224708711, -0.3241064099163111]",
                    (-2.119390740461563, 2.3512809763801803, 0.05778473716676569))}


def scenario(is_march: bool, share: float = 0.9) -> str:
    text = ["format = 1\ngravity = [0, 0, -9.81]\ntime = { end = 0.5, elements = 10 }",
            'method = { family = "lobatto", degree = 8 }']
    text += ['start = { initial = "project" }'] if is_march else ['start = { given = "positions" }', 'end = { given = "positions" }']
    for name, (first, last, spin) in BODIES.items():
        place, place_at_end, velocity = PLACES[name]
        rates = [[v * (1 if is_march else share) for v in values] for values in (velocity, spin)]
        text.append(f'[[body]]\nname = "{name}"\nshape = {{ box = [1, 0.2, 0.1] }}\nmass = 1\ncenter_of_mass = [0.5, 0, 0]\n'
                    + ("position = [0, 0, 0]" if name == "upper" else
                       "position = [1, 0, 0]\ndirectors = [[0, 1, 0], [-1, 0, 0], [0, 0, 1]]")
                    + f"\nstart = {{ position = {place}, directors = {first}, velocity = {rates[0]}, angular_velocity = {rates[1]} }}"
                    + ("" if is_march else f"\nend = {{ position = {place_at_end}, directors = {last} }}"))
    text.append('[[joint]]\nname = "shoulder"\ntype = "spherical"\nbetween = ["world", "upper"]\nat = [0, 0, 0]\n'
                '[[joint]]\nname = "elbow"\ntype = "spherical"\nbetween = ["upper", "lower"]\nat = [1, 0, 0]')
    return "\n".join(text) + "\n"


def chain(joint: str, n: int, is_march: bool) -> str:
    window = "" if is_march else ', window = "all"'
    text = ["format = 1\ngravity = [0, 0, -9.81]\ntime = { end = 0.5, elements = 10 }",
            f'method = {{ family = "lobatto", degree = 8{window} }}']
    for i in range(n):
        text.append(f'[[body]]\nname = "b{i}"\nshape = {{ box = [1, 0.2, 0.1] }}\nmass = 1\nposition = [{i + 0.5}, 0, 0]\n'
                    f'[[joint]]\nname = "j{i}"\ntype = "{joint}"\nat = [{i}, 0, 0]\n'
                    + ("axis = [0, 1, 0]\n" if joint == "revolute" else "")
                    + f'between = ["{f"b{i - 1}" if i else "world"}", "b{i}"]')
    return "\n".join(text) + "\n"


def counts(program: str, file: pathlib.Path, simd: str) -> tuple[int, dict]:
    """Instructions in all; of what each function calls, with it, and how often it is called."""
    out = file.with_suffix(".callgrind")
    run = subprocess.run(["valgrind", "--tool=callgrind", f"--callgrind-out-file={out}", "--collect-atstart=no",
                          "--toggle-collect=livens_counted_solve*", program, "scenario", str(file), "bare"],
                         capture_output=True, text=True, env=os.environ | {"LIVENS_SIMD": simd})
    collected = re.search(r"Collected : (\d+)", run.stderr)
    if run.returncode or not collected:
        sys.exit(run.stderr)
    names, inclusive, calls, called = {}, collections.Counter(), collections.Counter(), None
    for line in out.read_text().splitlines():
        if match := re.match(r"(c?)fn=\((\d+)\)(?: (.*))?$", line):
            name = names.setdefault(match[2], match[3])
            called = name if match[1] else None
        elif line.startswith("calls="):
            calls[called] += int(line[6:].split()[0])
        elif called and line[:1] in "0123456789+-*":
            inclusive[called] += int(line.split()[1])
            called = None
    return int(collected[1]), {name: (inclusive[name], calls[name]) for name in inclusive}


def step(of: dict) -> list[float]:
    """Instructions of each part of a step."""
    each = []
    for part in PARTS:
        instructions, n = next(v for name, v in of.items() if re.search(rf"NodalSystem::{part}\(", name))
        each.append(instructions / n)
    return each


def tell(name: str, bare: int, each: list[float], allowed: float) -> bool:
    ratio = sum(each) / bare
    print(f"{name:20} {bare / 1e6:10.2f} M " + " ".join(f"{v / 1e6:8.2f} M" for v in each)
          + f"   {ratio:.2f}, {allowed:g}" + ("  OVER" if ratio > allowed else ""), flush=True)
    return ratio > allowed


def main() -> int:
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    if not shutil.which("valgrind"):
        print("SKIPPED: instructions of a Newton step (valgrind is not installed)")
        return 77
    over = False
    with tempfile.TemporaryDirectory() as folder:
        march, between = pathlib.Path(folder, "march.toml"), pathlib.Path(folder, "between.toml")
        march.write_text(scenario(True), encoding="utf-8")
        between.write_text(scenario(False), encoding="utf-8")
        print(f"{'all elements at once':12} {'bare march':>12} " + " ".join(f"{part:>10}" for part in PARTS) + "   a step over a march, allowed")
        for simd, allowed in ALLOWED.items():
            bare, _ = counts(sys.argv[1], march, simd)
            _, of = counts(sys.argv[1], between, simd)
            over |= tell(simd, bare, step(of), allowed)
        for joint, n, allowed in CHAINS:
            march.write_text(chain(joint, n, True), encoding="utf-8")
            between.write_text(chain(joint, n, False), encoding="utf-8")
            bare, _ = counts(sys.argv[1], march, "avx2")
            _, of = counts(sys.argv[1], between, "avx2")
            over |= tell(f"{n} {joint}", bare, step(of), allowed)
    return over


if __name__ == "__main__":
    sys.exit(main())
