# SPDX-License-Identifier: BSD-3-Clause
"""Makes docs/performance.md and its pictures of build/peers/results.json, which run.py leaves: of a run of all problems the
whole page, of one of what is asked for an accuracy (--loaded) that part. What less was measured for goes to build/peers/."""
import json
import math
import re

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
scripts/peers --loaded     # what is asked for an accuracy, and its part of this page: ten minutes
scripts/peers --quick      # P16 and one chain, into build/peers/
```

{machine}

**Engines.** {versions}. Each has one thread and writes nothing. What each is, and what is tried:

{engines}
**Settings.** Every engine is swept through its integrators, degrees, tolerances or numbers of steps, and where a
problem can be put in several ways, through these. The cheapest that meet an error (three for each engine and column,
one where it takes more than 20 ms) are timed again, engines taking turns, {rounds} rounds; the median of the repeats
counts. A sweep ends where one solution takes 0.3 s (0.5 s from 10 bodies on, 1.5 s from 50), or where the error gets
no smaller; "best" is how far an engine came. A cell has milliseconds of processor time and the setting. Only the
solution is timed: models are made before, and livens, too, does without its estimate of the error, but for the rows
that say otherwise: there accuracies are those of the columns. What livens finds at the first solution of a model (its joints' pattern, its start once closed) others do
when they compile theirs; it is not timed either, and takes up to a quarter of the shortest runs of hinged chains.

**Errors.** The largest distance (m) of the compared points at the end from the reference: minimal coordinates derived on paper
([peer_hand.cpp](../benchmarks/peers/peer_hand.cpp), [chain_by_hand.h](../benchmarks/peers/chain_by_hand.h)), integrated by
extrapolation of order 18 with 64 bits of mantissa. It shares no code with livens, changes by less than 1e-13 with more steps,
and has the published digits where there are some; with loads they are those of
[equations_by_hand.h](../benchmarks/peers/equations_by_hand.h). An error at one instant can be small by luck; the pictures show what no other
setting of an engine beat.

Problems and engines are data: [problems.py](../benchmarks/peers/problems.py), [engines.py](../benchmarks/peers/engines.py).
"""


BEGIN, END = "<!-- asked for an accuracy -->", "<!-- end of that -->"
SMALLEST = 4e-13   # m; a sweep looks for no smaller errors
ASKED_HEAD = """What people have on their joints, and livens as people ask it: for an accuracy, nothing else, so that it finds family, degree
and elements, solves a second time for its estimate, and is done when that says so. Others do not tell their error: of them stand
the quickest of all settings that were tried, chosen by the true error that no user knows.

Milliseconds, medians of the repeats; of others two, at the same true error at the end as livens has and at the accuracy that was asked, there in m (an accuracy
is in lengths of the model and holds for all of the motion). *Judged*: with the growth of errors
and all checks, as its program and its Python package have it. heyoka and DOP853 by hand solve equations that are derived on paper: a limit. Springs
and dampers are each engine's own, Pinocchio's are torques by hand; controllers are expressions for livens, springs for others.

{machine} {versions}.
"""


def best(results, problem, names, level):
    """(seconds, engine, way, setting) of the quickest of the engines at an error, or None."""
    rows = [(row[3], name, row[0], row[1]) for name in names
            for row in results["timed"][problem].get(name, []) if row[2] <= level]
    return min(rows, default=None)


def asked(results, problem, name, level):
    """(seconds, engine, way, setting, error) of livens asked for just that accuracy, the quicker way to put it; or None."""
    rows = [(row[3], name, row[0], row[1], row[2]) for row in results["timed"][problem].get(name, [])
            if float(row[1].partition(":")[2]) == level]
    return min(rows, default=None)


def digits(x):
    return f"{x:.3g}" if x < 1000 else f"{x:.0f}"


def cell(results, problem, name, level, fastest):
    if engines.ENGINES[name].asked:
        found = asked(results, problem, name, level)
        return f"{digits(1e3 * found[0])} ({found[3]}, off {found[4]:.0e})" if found else "–"
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
    tuned = [n for n in names if not engines.ENGINES[n].asked]
    fastest = {level: best(results, problem, tuned, level) for level in engines.LEVELS}
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
                word = ratio_word(ratio, target.ratio)
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


# Ten of matplotlib and others that none of them is taken for: each engine has a colour of its own.
COLOURS = [f"C{k}" for k in range(10)] + ["#111111", "#a6761d", "#66a61e", "#7570b3", "#e7298a"]
STYLES = {name: {"color": COLOURS[i], "marker": "osD^vPX*hd<>p8"[i], "markersize": 3, "linewidth": 1,
                 "linestyle": "-" if i < 10 else "--"}
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
    kernels = (f"livens is there with each of its sets of\ninstructions: {', '.join(sets)}; unless `--simd` says otherwise it takes AVX2."
               if len(sets) > 1 else "livens takes AVX2.")
    text = (f"**Machine.** {m['processor']}, {m['cores']} cores seen, on {m['date']}. {kernels} Pinocchio is compiled with AVX2, "
            "what is\nderived by hand for this machine, others as their packages are.")
    if m["load"] > 0.5:
        text += (f"\n\n**Other work was running** (load {m['load']:.1f}): these figures are provisional, "
                 "ratios good to a fifth.")
    return text


def versions(results):
    titles = {**{n: e.title for n, e in engines.ENGINES.items()}, "scipy": "SciPy"}
    there = {name for swept in results["swept"].values() for name in swept}
    return ", ".join(f"{titles[n]} {version}" for n, version in results["versions"].items() if n in there)


def ratio_word(ratio, bound):
    close = 0.95 < ratio / bound < 1.05   # a digit more than tells which it was
    return f"{ratio:.{3 if close else 2}f}" if ratio >= 0.2 else f"1/{1 / ratio:.{2 if close else 0}f}"


def asked_problems(results):
    return [n for n, p in problems.table().items() if p.asked and n in results["timed"]]


def asked_rows(results):
    """Times (ms) of livens and, at the same true error and at the accuracy itself, of all others in their best settings."""
    others = [*engines.LIMITS, *engines.ASKED]
    yield ["problem", "asked", "true", "**livens**", "and judged", *(engines.ENGINES[n].title for n in others)]
    yield ["---"] * (5 + len(others))
    for problem in asked_problems(results):
        for level in engines.ASKED_LEVELS:
            ours, judged = (asked(results, problem, n, level) for n in ("livens_accuracy", "livens_all"))
            row = [problem, f"{level:.0e}", f"{ours[4]:.0e}" if ours else "–", *(digits(1e3 * x[0]) if x else "–" for x in (ours, judged))]
            for name in others:
                same, enough = (best(results, problem, [name], error) for error in (max(ours[4] if ours else level, SMALLEST), level))
                row.append(f"{digits(1e3 * same[0]) if same else '–'}, {digits(1e3 * enough[0]) if enough else '–'}")
            yield row


def verdict_rows(results):
    yield ["problem", "asked", "against", "at most", "at the same error", "at the accuracy", "judged, at the same error", ""]
    yield ["---"] * 8
    for problem in asked_problems(results):
        for level in engines.ASKED_LEVELS:
            ours, judged = (asked(results, problem, n, level) for n in ("livens_accuracy", "livens_all"))
            for name, bound in engines.ASKED.items():
                allowed = f"{bound:.2g}" if bound >= 0.5 else f"1/{1 / bound:.0f}"
                row = [problem, f"{level:.0e}", engines.ENGINES[name].title, allowed]
                if not ours or name not in results["timed"][problem]:
                    yield [*row, "–", "–", "–", "not there" if ours else "**livens is not there**"]
                    continue
                same, enough = (best(results, problem, [name], error) for error in (max(ours[4], SMALLEST), level))
                words = [ratio_word(a[0] / b[0], bound) if a and b else "–" for a, b in ((ours, same), (ours, enough), (judged, same))]
                met = not same or ours[0] / same[0] <= bound
                yield [*row, *words, "met" if same and met else "only livens is there" if met else "**missed**"]


def plain_table(rows):
    return "\n".join("| " + " | ".join(row) + " |" for row in rows) + "\n"


def asked_section(results, figures):
    """What is compared first; also what a run of these problems alone replaces on the page."""
    yield BEGIN
    yield "## Asked for an accuracy\n"
    yield ASKED_HEAD.format(machine=machine(results), versions=versions(results))
    yield plain_table(asked_rows(results))
    yield ("Its time over theirs, and what was asked of it. *At the same error*: theirs in the quickest setting whose true error is at most "
           "that of livens; *at the accuracy*: at most what was asked for.\n")
    yield plain_table(verdict_rows(results))
    if results.get("corners"):
        yield "What was slow once, CPU time of the whole program with the default accuracy:\n"
        yield table(["", "at most", "found", ""], [[c["title"], f"{c['allowed']} s", f"{c['seconds']:.3f} s",
                                                    "met" if c["seconds"] <= c["allowed"] else "**missed**"] for c in results["corners"]])
    names = [n for n in asked_problems(results) if problems.table()[n].loaded]
    draw_problems(results, names, figures / "performance_loaded.svg")
    yield "## With loads\n"
    yield "![Work against error](figures/performance_loaded.svg)\n"
    for name in names:
        yield f"### {problems.table()[name].title}\n"
        yield problem_table(results, name) + absent(results, name)
    yield END


def document(results, figures):
    names = [n for n in problems.table() if n in results["timed"] and not problems.table()[n].loaded]
    chains = {problems.table()[n].chain: n for n in names if problems.table()[n].chain}
    single = [n for n in names if n not in chains.values()]
    there = [e for n, e in engines.ENGINES.items() if e.note and any(n in swept for swept in results["swept"].values())]
    notes = {e.title.partition(", AVX")[0].partition(", SSE")[0]: e.note for e in there}
    yield HEAD.format(machine=machine(results), versions=versions(results), rounds=results["rounds"],
                      engines=table(["engine", "what, and its settings"], map(list, notes.items())))
    if asked_problems(results):
        yield from asked_section(results, figures)
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


def replace_part(path, results, figures):
    """The part of the page that is asked for an accuracy, where it stands or before all others."""
    text, part = path.read_text(encoding="utf-8"), "\n".join(asked_section(results, figures))
    if BEGIN in text:
        return re.sub(f"{BEGIN}.*?{END}", lambda _: part, text, flags=re.S)
    return text.replace("## What was asked", f"{part}\n## What was asked", 1)


def main():
    results = json.loads((engines.PEERS / "results.json").read_text())
    table_, there = problems.table(), set(results["timed"])
    whole = there == set(table_) and "sizes" in results
    part = not whole and there == {n for n, p in table_.items() if p.asked}
    folder = engines.ROOT / "docs" if whole or part else engines.PEERS
    figures = folder / "figures"
    figures.mkdir(exist_ok=True)
    path = folder / "performance.md"
    path.write_text(replace_part(path, results, figures) if part else "\n".join(document(results, figures)), encoding="utf-8")
    print(f"wrote {path.relative_to(engines.ROOT)}")
    if whole:   # tests/docs/figures.py holds the page against it
        rows = ",\n ".join(json.dumps(row, ensure_ascii=False) for row in size_rows(results["sizes"]))
        (engines.ROOT / "benchmarks/peers/sizes.json").write_text(f"[\n {rows}\n]\n", encoding="utf-8")


if __name__ == "__main__":
    main()
