# SPDX-License-Identifier: BSD-3-Clause
"""What the experiments of section 4.2 share: true motions of the pendulums, runs by blocks, the energy of
each element, and their pictures.

The true motions (reference/pendulums.json, made by make_pendulums.py) span all 80 s: they are computed with
so many digits that the chaos does not matter. Errors are distances in metres, of the body farther off.
"""
import functools
import json
import math

import numpy as np

import paper

END = 80.0                  # s
INSTANTS = (1, 2, 5, 10)    # s, at which motions are compared
BODIES = ("upper", "lower")
BLOCK = 2.0                 # s, of the centred and of the three-dimensional motion
PRINTED_END = np.array([[0.0585, -0.0002, -3.9996], [-2.3571, 0.0002, -7.1878]])   # printed: -71,878
WITNESS = paper.lobatto(8), 0.025    # method and element length that follow the motion as long as doubles can


# ---------------------------------------------------------------- the true motions

@functools.lru_cache
def truth(kind):
    """(times, positions (time, body, xyz), gap) of "centred", "offset" or "spatial" over 80 s."""
    cases = json.loads((paper.ROOT / "experiments/reference/pendulums.json").read_text(encoding="utf-8"))
    case = cases["double_pendulum_" + kind]
    positions = np.stack([case["position_1"], case["position_2"]], axis=1)
    return np.arange(len(positions)) * case["every"], positions, case["gap"]


@functools.lru_cache
def closest_to_printed_end():
    """{distance, t}: how near the true motion of the offset pendulum comes to the printed end point."""
    cases = json.loads((paper.ROOT / "experiments/reference/pendulums.json").read_text(encoding="utf-8"))
    return cases["double_pendulum_offset"]["closest_to_printed_end"]


def apart(positions, others):
    """Distance of two motions at each of their times, (time)."""
    return np.linalg.norm(np.asarray(positions) - others, axis=2).max(axis=1)


def distance(run, kind):
    """Distance to the true motion at the run's output times, which must be multiples of 0.1 s."""
    times, positions, _ = truth(kind)
    index = np.rint(run["time"] / times[1]).astype(int)
    assert np.abs(times[index] - run["time"]).max() < 1e-9, "output times are not those of the true motion"
    return apart(run["position"], positions[index])


def told_truly(run, kind):
    """Whether the program calls a run suspect that leaves the true motion by 1e-2 of its length.

    None that is three times nearer, since estimates are within a factor of three.
    """
    off = float(distance(run, kind).max()) / (1e-2 * 2 * paper.ROD)
    return off > 1 / 3 if run.code == paper.SUSPECT else off <= 1


def at(run, kind, t):
    """Distance to the true motion at one instant."""
    return float(distance(run, kind)[np.rint(run["time"] * 10).astype(int) == round(10 * t)][0])


def reached(times, distances, bound):
    """First time at which a distance exceeds `bound`; inf if never."""
    above = distances > bound
    return float(times[np.argmax(above)]) if above.any() else math.inf


def growth(times, distances, low=1e-12, high=1e-2):
    """Rate (1/s) of a disturbance: slope of log(distance) over time between `low` and its first `high`."""
    last = np.argmax(distances > high) if (distances > high).any() else len(distances)
    use = (np.arange(len(times)) < last) & (distances > low)
    return float(np.polyfit(times[use], np.log(distances[use]), 1)[0])


# ---------------------------------------------------------------- runs

def by_blocks(degree, kind, n, length, end, output=0.1, momentum="natural", **more):
    """Scenario text: elements of the paper, blocks of `length` s with n elements each."""
    method = paper.mixed("lagrange", degree, momentum, window=n, tolerance=1e-13, **more)
    return paper.double_pendulum(method, n * round(end / length), end, kind, output=output)


def witness(kind, end, output=0.1, **more):
    """Scenario text: lobatto(8), as accurate as doubles can be."""
    method, h = WITNESS
    return paper.double_pendulum(method, round(end / h), end, kind, output=output, **more)


def sideways(run):
    """Largest |y| of both bodies over all nodes of the motion, m."""
    return paper.largest(run["X"][:, :, 0, 1])


# ---------------------------------------------------------------- figures 7 and 8

NAMES = {1: "linear", 2: "quadratic", 3: "cubic"}


def positions_over_time(e, axis):
    """Figures 7 (axis 0) and 8 (axis 2): one coordinate of the centred pendulum, 40 x 100 elements."""
    end = 12.0 if e.short else END
    texts = {NAMES[degree]: by_blocks(degree, "centred", 100, BLOCK, end) for degree in NAMES}
    texts["lobatto(8)"] = witness("centred", end)
    runs = dict(zip(texts, e.solve_all(list(texts.values()))))
    for name, run in runs.items():
        times, far = run["time"], distance(run, "centred")
        e.expect(f"{name}: told truly", told_truly(run, "centred"))
        e.expect(f"{name}: largest |y|", sideways(run))
        e.expect(f"{name}: rods", paper.largest(run["joint_violation"]))
        e.expect(f"{name}: energy", run.figures["energy_drift"])
        for t in INSTANTS:
            here = np.rint(times * 10) == 10 * t
            e.expect(f"{name}: error of the coordinate at {t} s", paper.largest(
                (run["position"][here] - truth("centred")[1][10 * t])[..., axis]))
        if not e.short:
            e.expect(f"{name}: follows the true motion to 0.1 m until", reached(times, far, 0.1))
    columns = [f"{'xyz'[axis]}_{body}" for body in BODIES]
    e.table([{"method": name, "t": t, **dict(zip(columns, positions[:, axis])), "distance_to_true_motion": d}
             for name, run in runs.items()
             for t, positions, d in zip(run["time"], run["position"], distance(run, "centred"))])
    e.draw(lambda plt: draw_positions(plt, runs, axis))


def draw_positions(plt, runs, axis):
    figure, panels = plt.subplots(3, 1, figsize=(12, 8.5), sharex=True, height_ratios=(1, 1, 0.9))
    times, positions, _ = truth("centred")
    shown = times <= runs["quadratic"]["time"][-1] + 1e-9
    for body, (axes, name) in enumerate(zip(panels, BODIES)):
        axes.plot(times[shown], positions[shown, body, axis], color="0.75", marker="", linewidth=4,
                  label="true motion")
        axes.plot(runs["quadratic"]["time"], runs["quadratic"]["position"][:, body, axis], marker="",
                  label="quadratic elements, 100 a block of 2 s")
        axes.set(ylabel=f"{'xyz'[axis]} of the {name} body (m)")
        axes.margins(x=0)
        leaves = reached(runs["quadratic"]["time"], distance(runs["quadratic"], "centred"), 0.1)
        if math.isfinite(leaves):
            axes.axvline(leaves, color="0.3", linewidth=0.9, linestyle="--",
                         label=f"0.1 m apart, {leaves:.1f} s")
    panels[0].legend(loc="lower right", bbox_to_anchor=(1, 1), ncols=3)
    for name, run in runs.items():
        far = distance(run, "centred")
        panels[2].semilogy(run["time"][far > 0], far[far > 0], marker="", label=paper.told(name, run))
    panels[2].set(xlabel="time (s)", ylabel="distance to the true motion (m)", ylim=(1e-16, 1e2))
    panels[2].legend(loc="lower right", bbox_to_anchor=(1, 1), ncols=4)
    return figure


# ---------------------------------------------------------------- figures 9 and 13

def deviation(run):
    """Mean Hamiltonian of every element less the energy at the start, J."""
    return run["hamiltonian_integral"] / run.h - run["energy"][0]


def block_figures(run, n, near=10):
    """How constant the mean Hamiltonian is in blocks of n elements; all in J, the largest over the blocks.

    inside   difference of the extremes, all but 2 `near` elements at both ends of a block
    starts   distance of the first `near` elements of a block from its level, the median; but the first block
    ends     likewise of the last `near` elements of all blocks
    first    like starts, of the first block alone, which begins at a consistent state
    steps    between the levels of neighbouring blocks
    """
    blocks = deviation(run).reshape(-1, n)
    levels = np.median(blocks, axis=1)
    off = np.abs(blocks - levels[:, None])
    return {"inside": float(np.ptp(blocks[:, 2 * near:-2 * near], axis=1).max()),
            "starts": float(off[1:, :near].max()), "ends": float(off[:, -near:].max()),
            "first": float(off[0, :near].max()), "steps": float(np.abs(np.diff(levels)).max()),
            "largest": paper.largest(blocks)}


# Between blocks, and at their ends: the multiplier of the last function, which has no row of its own.
VARIANTS = {"carry": {}, "carry, zero": {"end_multiplier": "zero"}, "project": {"interfaces": "project"}}


def energy_per_element(e, kind):
    """Figures 9 and 13: integrals of L and H over every element, in blocks of 500, 1000 and 2000 elements."""
    end = 4.0 if e.short else 8.0
    counts = {1: (500, 1000), 2: (250, 500)} if e.short else {1: (500, 1000, 2000), 2: (500, 1000, 2000)}
    cases = [(degree, variant, n) for degree in counts for variant in VARIANTS for n in counts[degree]]
    runs = dict(zip(cases, e.solve_all([by_blocks(degree, kind, n, BLOCK, end, end, **VARIANTS[variant])
                                        for degree, variant, n in cases])))
    rows = [{"method": f"{NAMES[degree]}, {variant}", "elements a block": n, "h": BLOCK / n,
             **block_figures(run, n)} for (degree, variant, n), run in runs.items()]
    for degree in counts:
        for variant in VARIANTS:
            name = f"{NAMES[degree]}, {variant}"
            mine = [row for row in rows if row["method"] == name]
            for what in ("inside", "starts", "ends"):
                e.expect(f"{name}: order {what}",
                         paper.last_order([row["h"] for row in mine], [row[what] for row in mine], 0))
        shared = [row for row in rows if row["elements a block"] == counts[degree][1]]
        judge_variants(e, NAMES[degree], shared)
    span = 4.0 if e.short else END
    long = e.solve(by_blocks(1, kind, 1000, BLOCK, span, span))
    e.expect("whole time: told truly", told_truly(long, kind))
    e.expect("whole time: mean Hamiltonian less the energy", paper.largest(deviation(long)))
    e.expect("whole time: mean Lagrangian swings by", float(np.ptp(long["action_integral"] / long.h)))
    e.table(rows)
    means = [long[f"{which}_integral"] / long.h for which in ("action", "hamiltonian")]
    e.table([{"t": t, "mean_lagrangian": L, "mean_hamiltonian": H} for t, L, H in zip(middles(long), *means)],
            "elements.csv")
    e.draw(lambda plt: draw_energy(plt, runs, rows, long, counts))


def judge_variants(e, degree, rows):
    """What projecting changes against carrying, and the first block against the others; rows of one h."""
    carry, project = (next(row for row in rows if row["method"] == f"{degree}, {variant}")
                      for variant in ("carry", "project"))
    e.expect(f"{degree}: what projecting leaves of the disturbance at starts",
             project["starts"] / carry["starts"])
    e.expect(f"{degree}: steps of the level when projecting, by those when carrying",
             project["steps"] / carry["steps"])
    e.expect(f"{degree}: first start by the others", carry["first"] / carry["starts"])
    if not e.short:
        e.expect(f"{degree}: inside a block of 1000 elements", carry["inside"])


def middles(run):
    return (run["element_end"][1:] + run["element_end"][:-1]) / 2


def draw_energy(plt, runs, rows, long, counts):
    figure, ((first, orders), (carry, project)) = plt.subplots(2, 2, figsize=(13, 8.5))
    t = middles(long)
    first.plot(t, long["action_integral"] / long.h, marker="", linewidth=0.8, label="of L = T - V")
    first.plot(t, long["hamiltonian_integral"] / long.h, marker="", linewidth=2, label="of H = T + V")
    first.set(xlabel="time (s)", ylabel="integral over the element / its length (J)",
              title=f"Linear elements, 1000 a block, {long['element_end'][-1]:g} s")
    first.legend(loc="upper right", frameon=True, framealpha=0.9)
    for axes, interfaces in ((carry, "carry"), (project, "project")):
        for n in counts[1]:
            run = runs[1, interfaces, n]
            axes.plot(middles(run), 1e3 * deviation(run), marker="", linewidth=0.9,
                      label=f"{n} elements a block")
        axes.set(xlabel="time (s)", ylabel="mean of H less the energy (mJ)",
                 title=f"Linear elements, interfaces = \"{interfaces}\"")
        axes.legend(loc="upper right")
    low, high = (f(axes.get_ylim()[k] for axes in (carry, project)) for k, f in ((0, min), (1, max)))
    for axes in (carry, project):
        axes.set_ylim(low, high)
    zoom = carry.inset_axes((0.34, 0.08, 0.3, 0.5))
    for n in counts[1]:
        run = runs[1, "carry", n]
        close = np.abs(middles(run) - BLOCK) < 0.05
        zoom.plot(middles(run)[close], 1e3 * deviation(run)[close], marker="", linewidth=0.9)
    zoom.set_title("near 2 s", fontsize=6.5)
    zoom.tick_params(labelsize=5.5)
    paper.loglog(orders, rows, "starts", "disturbance at the starts of blocks (J)")
    for exponent, name in ((2, "linear, carry"), (3, "quadratic, carry")):
        row = next(row for row in rows if row["method"] == name)
        paper.slope(orders, exponent, row["h"] / 1.6, row["starts"] / 12)
    orders.set_ylim(bottom=1e-12)
    orders.legend(loc="lower right", ncols=2)
    orders.set_title("The disturbance vanishes with the length of the elements")
    return figure


# ---------------------------------------------------------------- figures 10 and 14

def moments(run):
    """Mean angular momentum of both bodies about the origin over every element, (element, xyz), N m s."""
    return run["angular_momentum_integral"] / run.h[:, None]


def rigidity_moment(run, points=3):
    """Largest component of d_i x d_j lambda_ij, the last term of (P36), and of a summand of it alone, N m."""
    s = paper.gauss(points)[0]
    d = run.field("X").at(s)[:, :, :, 1:]                     # element, point, body, director, xyz
    rows = run.field("rigidity_multiplier").at(s) * [1, 1, 1, 0.5, 0.5, 0.5]   # the tensor's six components
    tensor = rows[..., [[0, 3, 4], [3, 1, 5], [4, 5, 2]]]
    pull = np.einsum("esbij,esbjx->esbix", tensor, d)
    terms = np.cross(d, pull)
    return paper.largest(terms.sum(axis=3)), paper.largest(terms)


def draw_moments(plt, run):
    figure, panels = plt.subplots(3, 1, figsize=(11, 7), sharex=True)
    for k, (axes, values) in enumerate(zip(panels, moments(run).T)):
        axes.plot(middles(run), values, marker="", linewidth=0.9, color=paper.COLOURS[k])
        axes.set(ylabel=f"$L_{k + 1}$ (kg m²/s)")
        axes.margins(x=0)
        if np.ptp(values) < 1e-3:   # a constant: a scale that does not show rounding as a curve
            axes.set_ylim(values.mean() - 1, values.mean() + 1)
            axes.ticklabel_format(useOffset=False)
    panels[0].set_title("Mean angular momentum of every element about the origin, both bodies; "
                        "linear elements, 1000 a block of 2 s")
    panels[-1].set_xlabel("time (s)")
    return figure
