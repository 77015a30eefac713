# SPDX-License-Identifier: BSD-3-Clause
"""What all experiments share: the paper's problems, running the program, errors and orders, plots, verdicts.

The paper is Hesch, Glas, Schuss, "Space-time rigid multibody dynamics", Multibody System Dynamics (2023);
(P26) is its equation 26. One folder holds one figure: an executable `run` and `expected.json`, the bounds
that it is judged by. A `run` reads

    def main(e):                         # e: Experiment
        rows = e.study(...)              # solves
        e.expect("order midpoint", ...)  # judges, by the entry of that name in expected.json
        e.table(rows)                    # data.csv
        e.draw(picture)                  # plot.svg, plot.png
    paper.run(__file__, main)

and takes --short, --livens PROGRAM, --output FOLDER, --expected FILE. Needs NumPy and netCDF4; without
matplotlib there is data and verdict, but no picture. Exit status: 0 all expectations hold, 1 some do not, 2
it broke.
"""
import argparse
import concurrent.futures
import csv
import functools
import json
import math
import os
import pathlib
import shutil
import subprocess
import sys
import tempfile
import textwrap

import numpy as np

ROOT = pathlib.Path(__file__).resolve().parents[1]
PROGRAM = pathlib.Path(os.environ.get("LIVENS", ROOT / "build" / "release" / "livens"))
CONVERGED, REFUSED, NOT_CONVERGED, SUSPECT = 0, 3, 4, 7   # exit codes of livens, docs/program.md


class Broken(Exception):
    """The experiment could not be made; says nothing about its expectations."""


# ---------------------------------------------------------------- the paper's problems, as scenario texts

BOX_TORQUE = 2.0              # N m along (1, 1, 1); the paper prints [1, 1, 1], see docs/paper.md
BOX_END = {"constant": 1.0, "rectangular": 4.0}
ROD = 4.0                     # m, both rods of the double pendulum


def mixed(basis, degree, momentum="natural", multipliers="equal", **more):
    """[method] of the paper's elements; `more`: gauss_points, block, interfaces, knots, weights, .."""
    return {"family": "mixed", "basis": basis, "degree": degree, "momentum": momentum,
            "multipliers": multipliers, **more}


def lobatto(degree, **more):
    """[method] of the nodal elements on the rotation group, for comparison."""
    return {"family": "lobatto", "degree": degree, **more}


def label(method):
    """A short name: "midpoint", "lobatto(4)", "lagrange 2 natural equal zero"."""
    if method["family"] == "mixed":
        keys = ("basis", "degree", "momentum", "multipliers", "end_multiplier")
        return " ".join(str(method[key]) for key in keys if key in method)
    return method["family"] + (f"({method['degree']})" if "degree" in method else "")


def toml(value):
    """A value as TOML writes it; floats with all their digits."""
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, str):
        return json.dumps(value)
    if isinstance(value, dict):
        return "{ " + ", ".join(f"{key} = {toml(item)}" for key, item in value.items()) + " }"
    if isinstance(value, (list, tuple, np.ndarray)):
        return "[" + ", ".join(toml(item) for item in value) + "]"
    return repr(value.item() if isinstance(value, np.generic) else value)


def table(header, entries):
    return "\n".join([header, *(f"{key} = {toml(value)}" for key, value in entries.items()), ""])


def scenario(title, bodies, joints, loads, time, method, gravity=(0, 0, 0), start=None):
    """Scenario text (docs/scenario.md) of lists of tables."""
    parts = [table("format = 1", {"title": title, "gravity": list(gravity)})]
    for header, entries in (("[[body]]", bodies), ("[[joint]]", joints), ("[[load]]", loads)):
        parts += [table(header, entry) for entry in entries]
    if start:
        parts.append(table("[start]", start))
    return "\n".join(parts + [table("[time]", time), table("[method]", method)])


def free_box(method, elements, load="constant", torque=None, end=None, **time):
    """Section 4.1: a box of 2 x 1 x 1 m, density 1.5 kg/m3, flies with (5, 5, 5) m/s and is set spinning.

    load     "constant", over [0, 1] s, or "rectangular", from 0.5 to 1.5 s of [0, 4] s
    torque   N m, world axes; default: BOX_TORQUE along (1, 1, 1)
    time     further keys of [time]: breaks, output
    """
    torque = [BOX_TORQUE / math.sqrt(3)] * 3 if torque is None else list(torque)
    box = {"name": "box", "shape": {"box": [2, 1, 1]}, "density": 1.5, "velocity": [5, 5, 5]}
    push = {"type": "torque", "body": "box", "value": torque}
    if load == "rectangular":
        push |= {"from": 0.5, "until": 1.5}
    return scenario(f"free box, {load} torque, {label(method)}", [box], [], [push],
                    {"end": end or BOX_END[load], "elements": elements, **time}, method)


def double_pendulum(method, elements, end, kind="centred", start=None, shift=0.0, **time):
    """Section 4.2: cubes with edges 1 and 0.8 m, density 1.5, on rods of 4 m under gravity.

    kind     "centred": rods between the centres; "offset": the second cube hangs 0.1 m off its centre along
             -d1; "spatial": centred, set off sideways with the consistent spin (-1, 0, 0) rad/s;
             "inconsistent": likewise with the director rates that the paper prints, which deform the triads
    start    entries of [start]
    shift    m, added to the second body's start, for sensitivity; a number is added to the first coordinate
    """
    k = ROD / math.sqrt(2)
    upper = {"name": "upper", "shape": {"box": [1, 1, 1]}, "density": 1.5, "position": [k, 0, k]}
    lower = {"name": "lower", "shape": {"box": [0.8, 0.8, 0.8]}, "density": 1.5,
             "position": np.array([2 * k, 0, 2 * k]) + ([shift, 0, 0] if np.isscalar(shift) else shift)}
    if kind == "offset":
        lower["center_of_mass"] = [0.1, 0, 0]
    for body in (upper, lower) if kind in ("spatial", "inconsistent") else ():
        body["velocity"] = [0, 1, 0]
        body |= {"angular_velocity": [-1, 0, 0]} if kind == "spatial" else \
                {"director_rates": [[0, 0, 0], [0, 0, 0], [0, 1, 0]]}
    rods = [{"name": "upper rod", "type": "rod", "between": ["world", "upper"]},
            {"name": "lower rod", "type": "rod", "between": ["upper", "lower"]}]
    return scenario(f"double pendulum, {kind}, {label(method)}", [upper, lower], rods, [],
                    {"end": end, "elements": elements, **time}, method, gravity=(0, 0, -9.81), start=start)


# ---------------------------------------------------------------- results

def lobatto_rule(degree):
    """Gauss-Lobatto points of [0, 1] and weights, (degree + 1) each; the middle for degree 0."""
    if degree == 0:
        return np.array([0.5]), np.array([1.0])
    legendre = np.polynomial.legendre.Legendre.basis(degree)
    points = np.concatenate([[-1], np.sort(np.real(legendre.deriv().roots())), [1]])
    return (1 + points) / 2, 1 / (degree * (degree + 1) * legendre(points) ** 2)


def gauss(n):
    """Points of [0, 1] and weights of the Gauss rule, (n) each."""
    points, weights = np.polynomial.legendre.leggauss(n)
    return (1 + points) / 2, weights / 2


def lagrange_basis(nodes, x):
    """Values at x of the Lagrange polynomials of the nodes, (x, node)."""
    return np.stack([np.prod([(x - b) / (a - b) for b in nodes if b != a] or [np.ones_like(x)], axis=0)
                     for a in nodes], axis=1)


class Field:
    """A piecewise polynomial of a result file (docs/results.md), or a quotient of two.

    values   (element, local node, ...) at the Gauss-Lobatto points of every element
    """

    def __init__(self, run, name):
        variable = run.file.variables[name]
        self.degree = int(variable.degree)
        step = self.degree if int(variable.continuous) else self.degree + 1
        entries = np.arange(run.n_elements)[:, None] * step + np.arange(self.degree + 1)
        self.values = run[name][entries]
        weights = variable.dimensions[0].replace("_node", "_weight")   # of NURBS
        self.weights = run[weights][entries] if weights in run.file.variables else None

    def at(self, s):
        """Values at local coordinates s of [0, 1], (element, s, ...)."""
        nodes, _ = lobatto_rule(self.degree)
        basis = lagrange_basis(nodes, np.atleast_1d(s))
        if self.weights is None:
            return np.einsum("sa,ea...->es...", basis, self.values)
        below = np.einsum("sa,ea->es", basis, self.weights)
        above = np.einsum("sa,ea...->es...", basis, np.einsum("ea,ea...->ea...", self.weights, self.values))
        return np.einsum("es...,es->es...", above, 1 / below)


class Run:
    """A solved scenario: figures of --json, attributes and variables of the result file.

    figures   the JSON object of `livens solve --json`
    code      exit code
    """

    def __init__(self, figures, code, path):
        import netCDF4
        self.figures, self.code = figures, code
        self.file = netCDF4.Dataset(path)
        self.file.set_auto_mask(False)
        self.n_elements = len(self["element_end"]) - 1 if "element_end" in self.file.variables else 0

    def __getitem__(self, name):
        return np.asarray(self.file.variables[name][...])

    def attribute(self, name):
        return self.file.getncattr(name)

    def field(self, name):
        """Field "X" or "P", (body, column, xyz); "multiplier", (row); "rigidity_multiplier", (body, 6)."""
        return Field(self, name)

    @property
    def h(self):
        """Lengths of the elements, s."""
        return np.diff(self["element_end"])

    def final(self, body=0):
        """X at the end, (column, xyz): position of the reference point, m, and the directors as they are."""
        return np.concatenate([self["position"][-1, body, None], self["directors_raw"][-1, body]])

    def multiplier_tensor(self, s, body=0):
        """Rigidity multipliers of the tensor of (P4) at local coordinates s, (element, s, 6), N m.

        The file holds those of the six rows; an off-diagonal row stands twice in (P4), and its multiplier is
        twice the tensor's component.
        """
        return self.field("rigidity_multiplier").at(s)[:, :, body] * [1, 1, 1, 0.5, 0.5, 0.5]


class Reference:
    """The exact motion of the free box, from reference/reference.json (see make_reference.py)."""

    def __init__(self, load):
        self.pieces = reference()["free_box_" + load]["pieces"]
        self.ends = np.array([self.pieces[0]["from"], *(piece["to"] for piece in self.pieces)])
        self.fields = {name: np.array([piece[name] for piece in self.pieces])
                       for name in ("directors", "multipliers")}

    def at(self, name, t):
        """"directors", (t, 3, 3), or "multipliers", (t, 6), at instants t; at a jump the later value."""
        values = self.fields[name]
        n = values.shape[1] - 1
        t = np.atleast_1d(t)
        k = np.clip(np.searchsorted(self.ends, t, side="right") - 1, 0, len(self.pieces) - 1)
        s = (t - self.ends[k]) / (self.ends[k + 1] - self.ends[k])
        chebyshev = (1 - np.cos(np.arange(n + 1) * np.pi / n)) / 2
        return np.einsum("tn,tn...->t...", lagrange_basis(chebyshev, s), values[k])

    def X(self, t):
        """[phi d1 d2 d3] at one instant, (column, xyz)."""
        return np.concatenate([[[5 * t] * 3], self.at("directors", t)[0]])


@functools.lru_cache
def reference():
    """All reference motions, by name."""
    return json.loads((ROOT / "experiments/reference/reference.json").read_text(encoding="utf-8"))


# ---------------------------------------------------------------- errors and orders

def largest(values):
    """Largest absolute value."""
    return float(np.abs(values).max())


def error(X, exact):
    """(P26): distance of the reference points plus distances of the directors; X (column, xyz)."""
    return float(np.linalg.norm(np.asarray(X) - exact, axis=-1).sum())


def order(h, errors, window=(1e-9, 1e-3)):
    """Slope of log(error) over log(h), by least squares inside the window of errors; nan below 3 points.

    The paper's plots are read in the same way: above the window elements are too long, below is rounding.
    """
    h, errors = np.asarray(h, float), np.asarray(errors, float)
    inside = np.isfinite(errors) & (errors >= window[0]) & (errors <= window[1])
    if inside.sum() < 3:
        return math.nan
    return float(np.polyfit(np.log(h[inside]), np.log(errors[inside]), 1)[0])


def trend(h, values):
    """Slope of log(value) over log(h): the median over all pairs of points at least a factor of 4 apart.

    For values that may be estimates: one that is a fifth too low moves the slope of a pair by 0.16 at most,
    and the median by less.
    """
    x, y = np.log(h), np.log(values)
    return float(np.median([(y[a] - y[b]) / (x[a] - x[b]) for a in range(len(x)) for b in range(a)
                            if abs(x[a] - x[b]) > math.log(3.99)] or [math.nan]))


def last_order(h, errors, floor=1e-12):
    """Rate between the two finest meshes whose errors are above `floor`."""
    pairs = [(a, b) for a, b in sorted(zip(h, errors)) if np.isfinite(b) and b > floor]
    if len(pairs) < 2:
        return math.nan
    (h0, e0), (h1, e1) = pairs[:2]
    return math.log(e1 / e0) / math.log(h1 / h0)


# ---------------------------------------------------------------- pictures

# A method looks the same in every picture: colour and marker.
STYLES = {"endpoint": 0, "midpoint": 1, "linear": 2, "quadratic": 3, "quadratic B-spline": 4,
          "quadratic B-spline, lower": 5, "lobatto(2)": 6, "lobatto(4)": 7, "lobatto(6)": 8,
          "linear strong": 2, "quadratic strong": 3}
COLOURS = ["#0b5394", "#cc4125", "#38761d", "#b45f06", "#674ea7",
           "#a64d79", "#45818e", "#7f6000", "#666666", "#000000"]
MARKERS = "osD^vP*X<>"


def plotting():
    """matplotlib.pyplot in the experiments' style, or None where it is missing."""
    try:
        import matplotlib
    except ModuleNotFoundError:
        return None
    matplotlib.use("Agg")
    import matplotlib.pyplot as plt
    plt.rcParams.update({"font.size": 7.5, "axes.grid": True, "grid.alpha": 0.3, "lines.linewidth": 0.9,
                         "lines.markersize": 3, "legend.fontsize": 6.5, "legend.frameon": False,
                         "axes.titlesize": 7.5, "axes.linewidth": 0.6, "axes.titlelocation": "left",
                         "legend.handlelength": 1.6, "legend.labelspacing": 0.3,
                         "svg.hashsalt": "livens", "figure.constrained_layout.use": True,
                         "axes.prop_cycle": matplotlib.cycler(color=COLOURS, marker=list(MARKERS))})
    return plt


WIDTH = 174 / 25.4   # inches: both columns of a journal's page
TICK = 0.36          # inches: what a number at a tick takes


def fit_to_page(figure, stretch):
    """As wide as a page, with letters before the titles of panels, if there are many.

    stretch   of the height, since text takes more of a smaller picture
    """
    wide, high = figure.get_size_inches()
    figure.set_size_inches(WIDTH, stretch * high * WIDTH / wide)
    panels = [axes for axes in figure.axes if axes.axison or axes.name == "3d"]
    for letter, axes in zip("abcdefghijkl", panels if len(panels) > 1 else ()):
        room = axes.get_subplotspec().get_position(figure).width * WIDTH * 72 / 3.9   # letters in a line
        side = "center" if axes.name == "3d" else "left"
        title = f"({letter}) {axes.get_title(side)}"
        axes.set_title(textwrap.fill(title, max(int(room), 20)), loc=side)


def told(name, run):
    """A label that says so where the program calls the run suspect."""
    return f"{name} (suspect)" if run.code == SUSPECT else name


def style_of_method(name):
    """Keywords of plot for a method known by name; a qualified one ("linear, quarter") is dashed."""
    plain = name if name in STYLES else name.split(",")[0]
    look = {"color": COLOURS[STYLES[plain]], "marker": MARKERS[STYLES[plain]]} if plain in STYLES else {}
    return look if plain == name else look | {"linestyle": "--"}


def loglog(axes, rows, y="error", ylabel="Err (P26)", group="method", style=None, beside=False):
    """Curves of y over h on logarithmic axes, one for each value of `group`, in the order of the rows.

    Runs that the program calls suspect have a ring. style(name) gives keywords of plot, its label, too, if it
    is not the name; `beside` puts the legend right
    of the axes, where many need room.
    """
    for name in dict.fromkeys(row[group] for row in rows):
        points = sorted((row["h"], row[y]) for row in rows if row[group] == name and row[y] > 0)
        if points:
            axes.loglog(*zip(*points), **({"label": name} | (style(name) if style else {})))
    suspect = [(row["h"], row[y]) for row in rows if row.get("status") == "suspect" and row[y] > 0]
    if suspect:
        axes.loglog(*zip(*suspect), linestyle="", marker="o", markersize=6, markeredgewidth=0.5,
                    fillstyle="none", color="0.5", label="ringed: suspect", zorder=0)
    axes.set(xlabel="element length h (s)", ylabel=ylabel)
    axes.minorticks_off()
    low, high = axes.get_xlim()
    if high / low < 300:   # powers of ten alone would be too few
        inches = axes.get_subplotspec().get_position(axes.figure).width * WIDTH
        ticks = []
        for t in (a * 10.0**k for k in range(-8, 3) for a in (1, 2, 5)):
            is_apart = not ticks or math.log(t / ticks[-1]) / math.log(high / low) * inches > TICK
            if low <= t <= high and is_apart:
                ticks.append(t)
        axes.set_xticks(ticks, [f"{t:g}" for t in ticks])
    axes.legend(**({"loc": "upper left", "bbox_to_anchor": (1.01, 1)} if beside else {}))


def slope(axes, exponent, h, value):
    """A dashed line of the given slope through (h, value), over a factor of 4, with its number."""
    ends = np.array([h / 2, h * 2])
    axes.plot(ends, value * (ends / h) ** exponent, "--", marker="", color="0.4", linewidth=0.9)
    axes.annotate(f"{exponent:g}", (h, value), textcoords="offset points",
                  xytext=(4, -9 if exponent > 0 else 3), color="0.4", fontsize=6.5,
                  bbox={"facecolor": "white", "edgecolor": "none", "pad": 0.3, "alpha": 0.8})


def cube(centre, directors, edges):
    """The twelve edges of a box in space, (12, 2, 3); directors as rows."""
    corners = np.array([[i, j, k] for i in (-1, 1) for j in (-1, 1) for k in (-1, 1)]) / 2
    points = np.asarray(centre) + corners * edges @ np.asarray(directors)
    return np.array([[points[a], points[b]] for a in range(8) for b in range(a)
                     if np.count_nonzero(corners[a] != corners[b]) == 1])


# ---------------------------------------------------------------- verdicts

def judge(wanted, seen):
    """(holds, what was wanted as text) of one entry of expected.json.

    {"near": x, "within": d}, {"between": [a, b]}, {"below": x}, {"above": x}, {"is": x}; a number that is not
    finite fulfils nothing.
    """
    if "is" in wanted:
        return seen == wanted["is"], f"is {wanted['is']}"
    finite = isinstance(seen, (int, float)) and math.isfinite(seen)
    if "near" in wanted:
        middle, room = wanted["near"], wanted["within"]
        return finite and abs(seen - middle) <= room, f"{middle} +- {room}"
    if "between" in wanted:
        low, high = wanted["between"]
        return finite and low <= seen <= high, f"{low} .. {high}"
    if "below" in wanted:
        return finite and seen < wanted["below"], f"< {wanted['below']}"
    if "above" in wanted:
        return finite and seen > wanted["above"], f"> {wanted['above']}"
    raise Broken(f"an expectation says neither near, between, below, above nor is: {wanted}")


class Experiment:
    """One run of one experiment: solves, collects verdicts, writes data, picture and verdict.json."""

    def __init__(self, script, arguments):
        self.name = pathlib.Path(script).resolve().parent.name
        self.short, self.livens, self.arguments = arguments.short, arguments.livens, arguments
        self.output = pathlib.Path(arguments.output or ROOT / "build" / "paper" / self.name)
        self.output.mkdir(parents=True, exist_ok=True)
        path = arguments.expected or pathlib.Path(script).resolve().parent / "expected.json"
        self.expected = json.loads(pathlib.Path(path).read_text(encoding="utf-8"))
        self.verdicts, self.remarks = [], []
        self.files = {}   # what stands beside each scenario: bytes by name
        self.scratch = tempfile.TemporaryDirectory(prefix="livens-paper-")

    # Solving

    def _launch(self, text):
        folder = pathlib.Path(tempfile.mkdtemp(dir=self.scratch.name))
        (folder / "run.toml").write_text(text, encoding="utf-8")
        for name, content in self.files.items():
            (folder / name).write_bytes(content)
        return folder / "run.nc", subprocess.run(
            [self.livens, "solve", "run.toml", "-o", "run.nc", "--json", "-q"], cwd=folder,
            capture_output=True, text=True, check=False)

    def solve_all(self, texts, allow=(CONVERGED, SUSPECT)):
        """Runs of many scenario texts, as many at a time as there are cores, in the order of the texts.

        Another exit code than those allowed breaks the experiment. Suspect runs are allowed because here the
        error itself is known; callers remark upon them.
        """
        return self.measure_all(texts, None, allow)

    def measure_all(self, texts, measure, allow=(CONVERGED, SUSPECT)):
        """What measure(run) says of each run, for so many that their files are not kept; None: the runs."""
        found = []
        with concurrent.futures.ThreadPoolExecutor(len(os.sched_getaffinity(0))) as pool:
            for text, (path, process) in zip(texts, pool.map(self._launch, texts)):
                if process.returncode not in allow:
                    said = process.stderr + process.stdout
                    raise Broken(f"livens left with {process.returncode}:\n{said}\n{text}")
                # The files are opened here: the NetCDF library is not made for threads.
                run = Run(json.loads(process.stdout), process.returncode, path)
                found.append(measure(run) if measure else run)
                if measure:
                    run.file.close()
                    shutil.rmtree(path.parent)
        return found

    def solve(self, text, allow=(CONVERGED, SUSPECT)):
        """Run of one scenario text."""
        run = self.solve_all([text], allow)[0]
        if run.code != CONVERGED:
            self.remark("{title}: {status}".format(**run.figures))
        return run

    def refusal(self, text):
        """The first error of a scenario that livens must refuse: {code, message, path, ..}."""
        _, process = self._launch(text)
        if process.returncode != REFUSED:
            raise Broken(f"livens left with {process.returncode} where it should refuse:\n{text}")
        return json.loads(process.stdout)["errors"][0]

    def study(self, cases, text, measure):
        """Rows {method, elements, h, ..} of a convergence study.

        Runs that did not converge are remarked upon and left out, suspect ones remarked upon and kept: coarse
        meshes may be either, and an order needs three good meshes anyway.

        cases     (name, method, numbers of elements)
        text      function (method, elements) -> scenario text
        measure   function (run) -> dict of figures
        """
        tasks = [(name, method, n) for name, method, counts in cases for n in counts]
        runs = self.solve_all([text(method, n) for _, method, n in tasks],
                              (CONVERGED, SUSPECT, NOT_CONVERGED))
        rows, doubtful = [], {}
        for (name, _, n), run in zip(tasks, runs):
            if run.code != CONVERGED:
                doubtful.setdefault((name, run.figures["status"]), []).append(str(n))
            if run.code != NOT_CONVERGED:
                rows.append({"method": name, "elements": n, "h": float(run.h.max()),
                             "status": run.figures["status"]} | measure(run))
        for (name, status), numbers in doubtful.items():
            self.remark(f"{name}: {status} with {', '.join(numbers)} elements")
        return rows

    # Judging

    def expect(self, name, seen):
        """Judges one figure by the entry `name` of expected.json."""
        if name not in self.expected["expect"]:
            raise Broken(f"expected.json has no entry \"{name}\"")
        wanted = self.expected["expect"][name]
        seen = seen.item() if isinstance(seen, np.generic) else seen
        holds, text = judge(wanted, seen)
        self.verdicts.append({"name": name, "seen": seen, "wanted": text, "holds": bool(holds),
                              "why": wanted.get("why", "")})

    def expect_order(self, name, rows, method, window=(1e-9, 1e-3), y="error"):
        """Judges the fitted order of one method."""
        mine = [row for row in rows if row["method"] == method]
        self.expect(name, order([row["h"] for row in mine], [row[y] for row in mine], window))

    def remark(self, text):
        """A line for the reader that is no verdict."""
        self.remarks.append(text)

    # Writing

    def table(self, rows, name="data.csv"):
        """Rows (dicts; keys may differ) as CSV; numbers with all their digits."""
        keys = list(dict.fromkeys(key for row in rows for key in row))
        with open(self.output / name, "w", encoding="utf-8", newline="") as file:
            writer = csv.DictWriter(file, keys, lineterminator="\n")
            writer.writeheader()
            writer.writerows(rows)

    def draw(self, picture, stretch=1.2):
        """Writes plot.svg and plot.png of picture(plt) -> figure, see fit_to_page()."""
        plt = plotting()
        if plt is None:
            self.remark("no picture: matplotlib is not installed")
            return
        figure = picture(plt)
        fit_to_page(figure, stretch)
        figure.savefig(self.output / "plot.svg", metadata={"Date": None})
        figure.savefig(self.output / "plot.png", dpi=200)
        plt.close(figure)

    def finish(self):
        """Prints and writes the verdict; whether all is as expected."""
        judged = {verdict["name"] for verdict in self.verdicts}
        for name, wanted in self.expected["expect"].items():
            if name not in judged and not (self.short and wanted.get("full_only")):
                self.verdicts.append({"name": name, "seen": None, "wanted": judge(wanted, None)[1],
                                      "holds": False, "why": "was not measured"})
        passed = bool(self.verdicts) and all(verdict["holds"] for verdict in self.verdicts)
        report = {"experiment": self.name, "paper": self.expected["paper"], "says": self.expected["says"],
                  "short": self.short, "passed": passed, "expectations": self.verdicts,
                  "remarks": self.remarks}
        (self.output / "verdict.json").write_text(json.dumps(report, indent=1) + "\n", encoding="utf-8")
        print(f"{self.name}: {self.expected['paper']}{' (short)' if self.short else ''}")
        for verdict in self.verdicts:
            seen = f"{verdict['seen']:.6g}" if isinstance(verdict["seen"], float) else verdict["seen"]
            mark = "ok  " if verdict["holds"] else "FAIL"
            print(f"  {mark}  {verdict['name']}: {seen}   ({verdict['wanted']})")
        for remark in self.remarks:
            print(f"  note  {remark}")
        print(f"  {'as expected' if passed else 'NOT AS EXPECTED'}; data in {self.output}")
        return passed


def run(script, main, further=None):
    """Runs one experiment as a program and leaves with its exit status; further(parser) adds arguments."""
    parser = argparse.ArgumentParser(description=main.__doc__)
    parser.add_argument("--short", action="store_true", help="fewer refinements, a few seconds")
    parser.add_argument("--livens", default=PROGRAM, help="the program")
    parser.add_argument("--output", type=pathlib.Path, help="folder of the results")
    parser.add_argument("--expected", help="other expectations than those beside the script")
    if further:
        further(parser)
    arguments = parser.parse_args()
    arguments.livens = pathlib.Path(arguments.livens).resolve()
    if not arguments.livens.is_file():
        print(f"{arguments.livens}: no such program; scripts/paper builds it", file=sys.stderr)
        sys.exit(2)
    experiment = Experiment(script, arguments)
    try:
        main(experiment)
        sys.exit(0 if experiment.finish() else 1)
    except Broken as broken:
        print(f"{experiment.name}: BROKEN: {broken}", file=sys.stderr)
        sys.exit(2)
    finally:
        experiment.scratch.cleanup()
