# SPDX-License-Identifier: BSD-3-Clause
"""Makes docs/performance.md and its pictures of build/peers/results.json, which run.py leaves. What not all problems
were measured for goes to build/peers/."""
import json
import math

import matplotlib

matplotlib.use("Agg")
matplotlib.rcParams.update({"svg.hashsalt": "livens", "svg.fonttype": "none", "font.size": 8, "axes.titlesize": 9})
import matplotlib.pyplot as plt  # noqa: E402  (the backend is chosen first)

import engines  # noqa: E402
import problems  # noqa: E402

HEAD = """# Performance, side by side

livens and other engines on the same problems, in one run on one machine, each in its best settings. This page is made by

```sh
scripts/peers --install    # brings the engines, measures, writes this page: about an hour
scripts/peers --quick      # P16 and one chain, into build/peers/
```

{machine}

**Engines.** {versions}. Each has one thread and writes nothing. What each is, and what is tried:

{engines}
**Settings.** Every engine is swept through its integrators, degrees, tolerances or numbers of steps, and where a
problem can be put in several ways, through these. The cheapest that meet an error (three for each engine and column,
one where it takes more than 20 ms) are timed again, engines taking turns, {rounds} rounds; the least of all repeats
counts. A sweep ends where one solution takes 0.3 s (0.5 s from 10 bodies on, 1.5 s from 50), or where the error gets
no smaller; "best" is how far an engine came. A cell has milliseconds of processor time and the setting. Only the
solution is timed: models are made before, and livens, too, does without its estimate of the error, but for the row
that says otherwise. What livens finds at the first solution of a model (its joints' pattern, its start once closed) others do
when they compile theirs; it is not timed either, and takes up to a quarter of the shortest runs of hinged chains.

**Errors.** The largest distance (m) of the compared points at the end from the reference: minimal coordinates derived on paper
([peer_hand.cpp](../benchmarks/peers/peer_hand.cpp), [chain_by_hand.h](../benchmarks/peers/chain_by_hand.h)), integrated by
extrapolation of order 18 with 64 bits of mantissa. It shares no code with livens, changes by less than 1e-13 with more steps,
and has the published digits where there are some. An error at one instant can be small by luck; the pictures show what no other
setting of an engine beat.

Problems and engines are data: [problems.py](../benchmarks/peers/problems.py), [engines.py](../benchmarks/peers/engines.py).
"""


def best(results, problem, names, level):
    """(seconds, engine, way, setting) of the quickest of the engines at an error, or None."""
    rows = [(row[3], name, row[0], row[1]) for name in names
            for row in results["timed"][problem].get(name, []) if row[2] <= level]
    return min(rows, default=None)


def digits(x):
    return f"{x:.3g}" if x < 1000 else f"{x:.0f}"


def cell(results, problem, name, level, fastest):
    found = best(results, problem, [name], level)
    if not found:
        rows = results["swept"][problem][name]["rows"]
        return "–" if not rows or level > 1e-3 else f"– (best {min(row[2] for row in rows):.0e})"
    seconds, _, way, setting = found
    time = digits(1e3 * seconds)
    how = setting if not way or engines.ENGINES[name].by_name else f"{setting}, {way}"
    return f"**{time}** ({how})" if found == fastest else f"{time} ({how})"


def table(header, rows):
    return "\n".join(["| " + " | ".join(row) + " |" for row in [header, ["---"] * len(header), *rows]]) + "\n"


def problem_table(results, problem):
    names = [n for n in engines.ENGINES if results["swept"][problem].get(n, {}).get("rows")]
    fastest = {level: best(results, problem, names, level) for level in engines.LEVELS}
    rows = [[engines.ENGINES[n].title, *(cell(results, problem, n, level, fastest[level])
                                         for level in engines.LEVELS)] for n in names]
    return table(["ms at an error of at most", *(f"{level:.0e} m" for level in engines.LEVELS)], rows)


def absent(results, problem):
    said = [f"{engines.ENGINES[n].title}: {found['failed'] or 'nothing within 10 m'}"
            for n, found in results["swept"][problem].items() if not found["rows"]]
    return f"\nNot there: {'; '.join(said)}.\n" if said else ""


def target_rows(results):
    for target in engines.TARGETS:
        for problem in target.problems:
            if problem not in results["timed"]:
                continue
            for level in target.levels:
                ours = best(results, problem, target.ours, level)
                theirs = best(results, problem, target.others, level)
                names = ", ".join(engines.ENGINES[n].title for n in target.others)
                asked = f"{target.ratio:.2g}" if target.ratio >= 0.5 else f"1/{1 / target.ratio:.0f}"
                row = [problem, f"{level:.0e}", names if len(target.others) == 1 else f"best of {names}", asked]
                if not ours or not theirs:
                    yield [*row, "–", "", "only livens is there" if ours else "livens is not there"]
                    continue
                ratio = ours[0] / theirs[0]
                close = 0.95 < ratio / target.ratio < 1.05   # a digit more than tells which it was
                word = f"{ratio:.{3 if close else 2}f}" if ratio >= 0.2 else f"1/{1 / ratio:.{2 if close else 0}f}"
                sides = f"{engines.ENGINES[ours[1]].title} {ours[3]}, {engines.ENGINES[theirs[1]].title} {theirs[3]}"
                yield [*row, word, sides, "met" if ratio <= target.ratio else "**missed**"]


def size_rows(sizes):
    rows = []
    for size in sizes:
        for which, title in (("solution", "solution alone"), ("program", "program, with estimate and file")):
            s = size[which]
            rows.append([f"{size['n']:,} {size['title']}", title, f"{digits(s['seconds'])} s", f"{s['memory']:.0f} MiB",
                         f"{s['time_ratio']:.2f}", f"{s['memory_ratio']:.2f}"])
    return rows


def size_table(sizes):
    rows = size_rows(sizes)
    return table(["", "", "time", "peak memory", "time by n, over that of n/10", "memory, likewise"], rows)


def front(rows):
    """What no other setting beats in both error and time."""
    found = []
    for row in sorted(rows, key=lambda r: r[3]):
        if not found or row[2] < found[-1][0]:
            found.append((row[2], 1e3 * row[3]))
    return found


STYLES = {name: {"color": f"C{i % 10}", "marker": "osD^vPX*hd<"[i], "markersize": 3, "linewidth": 1}
          for i, name in enumerate(engines.ENGINES)}


def work_precision(axes, results, problem):
    for name, found in results["swept"][problem].items():
        if found["rows"]:
            errors, times = zip(*front(found["rows"]))
            axes.loglog(errors, times, label=engines.ENGINES[name].title, **STYLES[name])
    axes.invert_xaxis()
    axes.set_title(problems.table()[problem].title)
    axes.set(xlabel="error (m), better to the right", ylabel="ms")
    axes.grid(alpha=0.3)


def finish(figure, grid, path):
    handles = {label: handle for axes in grid for handle, label in zip(*axes.get_legend_handles_labels())}
    spare = [axes for axes in grid if not axes.has_data()]
    for axes in spare:
        axes.axis("off")
    (spare[0] if spare else grid[0]).legend(handles.values(), handles.keys(), fontsize=7)
    figure.savefig(path, metadata={"Date": None})
    plt.close(figure)


def draw_problems(results, names, path):
    columns = min(3, len(names) + 1)
    lines = math.ceil((len(names) + 1) / columns)
    figure, grid = plt.subplots(lines, columns, figsize=(4.2 * columns, 3.4 * lines), squeeze=False,
                                layout="constrained")
    grid = list(grid.flat)
    for axes, name in zip(grid, names):
        work_precision(axes, results, name)
    finish(figure, grid, path)


def draw_chains(results, chains, level, path):
    figure, grid = plt.subplots(1, 3, figsize=(12.6, 3.6), layout="constrained")
    for axes, kind in zip(grid, ("ball", "hinge")):
        for name in engines.ENGINES:
            points = [(n, best(results, chain, [name], level)) for (k, n), chain in chains.items() if k == kind]
            points = [(n, 1e3 * found[0]) for n, found in points if found]
            if points:
                axes.loglog(*zip(*points), label=engines.ENGINES[name].title, **STYLES[name])
        axes.set(xlabel="bodies", ylabel=f"ms at {level:.0e} m", title=f"Chains of {kind}s")
        axes.grid(alpha=0.3)
    finish(figure, list(grid), path)


def machine(results):
    m = results["machine"]
    sets = [engines.ENGINES[n].title.partition(", ")[2] for n in engines.ANY
            if n in next(iter(results["swept"].values()))]
    text = (f"**Machine.** {m['processor']}, {m['cores']} cores seen, on {m['date']}. livens is there with each of its sets of\n"
            f"instructions: {', '.join(sets)}; unless `--simd` says otherwise it takes AVX2. Pinocchio is compiled with AVX2, "
            "what is\nderived by hand for this machine, others as their packages are.")
    if m["load"] > 0.5:
        text += (f"\n\n**Other work was running** (load {m['load']:.1f}): these figures are provisional, "
                 "ratios good to a fifth.")
    return text


def versions(results):
    titles = {**{n: e.title for n, e in engines.ENGINES.items()}, "scipy": "SciPy"}
    return ", ".join(f"{titles[n]} {version}" for n, version in results["versions"].items())


def document(results, figures):
    names = [n for n in problems.table() if n in results["timed"]]
    chains = {problems.table()[n].chain: n for n in names if problems.table()[n].chain}
    single = [n for n in names if n not in chains.values()]
    there = [e for n, e in engines.ENGINES.items() if e.note and any(n in swept for swept in results["swept"].values())]
    notes = {e.title.partition(", AVX")[0].partition(", SSE")[0]: e.note for e in there}
    yield HEAD.format(machine=machine(results), versions=versions(results), rounds=results["rounds"],
                      engines=table(["engine", "what, and its settings"], map(list, notes.items())))
    yield "## What was asked\n"
    yield "Time of livens over that of the other, in its best instruction set where none is named.\n"
    yield table(["problem", "error", "against", "asked", "found", "settings", ""], target_rows(results))
    if single:
        draw_problems(results, single, figures / "performance_problems.svg")
        yield "## Problems\n"
        yield "![Work against error](figures/performance_problems.svg)\n"
    for name in single:
        yield f"### {problems.table()[name].title}\n"
        yield problem_table(results, name) + absent(results, name)
    if chains:
        draw_chains(results, chains, 1e-6, figures / "performance_chains.svg")
        yield "## Chains\n"
        yield "![Time by length of a chain](figures/performance_chains.svg)\n"
    for name in chains.values():
        yield f"### {problems.table()[name].title}\n"
        yield problem_table(results, name) + absent(results, name)
    if "sizes" in results:
        yield "## Much of one thing\n"
        yield ("The last columns say by how much one of n costs more than one of n/10: 1 is linear. The program "
               "also reads, estimates the error by a second solution, checks and writes.\n")
        yield size_table(results["sizes"])


def main():
    results = json.loads((engines.PEERS / "results.json").read_text())
    whole = set(results["timed"]) == set(problems.table()) and "sizes" in results
    folder = engines.ROOT / "docs" if whole else engines.PEERS
    figures = folder / "figures"
    figures.mkdir(exist_ok=True)
    path = folder / "performance.md"
    path.write_text("\n".join(document(results, figures)), encoding="utf-8")
    print(f"wrote {path.relative_to(engines.ROOT)}")
    if whole:   # tests/docs/figures.py holds the page against it
        rows = ",\n ".join(json.dumps(row, ensure_ascii=False) for row in size_rows(results["sizes"]))
        (engines.ROOT / "benchmarks/peers/sizes.json").write_text(f"[\n {rows}\n]\n", encoding="utf-8")


if __name__ == "__main__":
    main()
