# SPDX-License-Identifier: BSD-3-Clause
"""Draws a result file into one picture: motion, energy, energy error, constraint violation.

    plot_run.py RUN.nc PICTURE.png

Needs matplotlib and one of netCDF4 and SciPy; the variables are described in docs/results.md.
"""
import sys

import matplotlib
import numpy as np

matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402  (the backend is chosen first)

# On logarithmic axes 0 is drawn here, and so is what lies below: it is rounding and would stretch the axis.
FLOOR = 1e-17


class Run:
    """Variables and attributes of a result file, as NumPy arrays."""

    def __init__(self, path):
        try:
            import netCDF4

            self.file = netCDF4.Dataset(path)
            self.file.set_auto_mask(False)
            self.variables = self.file.variables
            self.attributes = {name: self.file.getncattr(name) for name in self.file.ncattrs()}
        except ModuleNotFoundError:
            from scipy.io import netcdf_file

            self.file = netcdf_file(path, mmap=False)
            self.variables = self.file.variables
            self.attributes = {name: value.decode() if isinstance(value, bytes) else value
                               for name, value in self.file._attributes.items()}

    def __contains__(self, name):
        return name in self.variables

    def __getitem__(self, name):
        return np.asarray(self.variables[name][...])

    def names(self, name):
        values = self[name]
        if values.ndim == 2:   # characters
            values = [b"".join(row).decode("utf-8") for row in values]
        return [str(value).rstrip("\0") for value in values]

    def text(self, name):
        value = self.attributes.get(name, "")
        return value.decode("utf-8") if isinstance(value, bytes) else str(value)


def element_nodes(nodes, ends):
    """Indices of the first and last node of each element of a continuous field."""
    first = np.searchsorted(nodes, ends[:-1])
    return zip(first, np.append(first[1:], len(nodes) - 1))


def dense(nodes, ends, values, per_element=12):
    """The piecewise polynomial through `values` at `nodes`, by the barycentric formula, at many instants."""
    times, curve = [], []
    for first, last in element_nodes(nodes, ends):
        t = nodes[first:last + 1]
        s = np.linspace(t[0], t[-1], per_element, endpoint=False)[1:]
        weights = 1 / np.prod((t[:, None] - t[None, :]) / (t[-1] - t[0]) + np.eye(len(t)), axis=1)
        terms = weights / (s[:, None] - t[None, :] + 1e-300)
        inside = np.tensordot(terms / terms.sum(axis=1, keepdims=True), values[first:last + 1], axes=1)
        times += [t[:1], s]
        curve += [values[first:first + 1], inside]
    return np.concatenate([*times, nodes[-1:]]), np.concatenate([*curve, values[-1:]])


def centres(run):
    """Times and centres of mass, (time, body, xyz), along the elements' polynomials."""
    times, X = dense(run["X_node"], run["element_end"], run["X"])
    theta = np.insert(run["body_center_of_mass"], 0, 1.0, axis=1)
    return times, np.einsum("bc,tbcx->tbx", theta, X)


def draw_motion(figure, place, run):
    _, points = centres(run)
    spread = np.ptp(points, axis=(0, 1))
    flat = [i for i in range(3) if spread[i] < 1e-6 * spread.max()]
    seen = [i for i in range(3) if i not in flat[:1]]
    axes = figure.add_subplot(place, projection=None if flat else "3d")
    for body, name in enumerate(run.names("body")):
        path = points[:, body, seen].T
        line, = axes.plot(*path, linewidth=1.0, label=name)
        axes.plot(*path[:, :1], "o", color=line.get_color(), markersize=7, markerfacecolor="white")
        axes.plot(*path[:, -1:], "s", color=line.get_color(), markersize=7)
    axes.plot(*[[0]] * len(seen), "k+", markersize=10)
    labels = [f"{'xyz'[i]} (m)" for i in seen]
    axes.set(xlabel=labels[0], ylabel=labels[1])
    if flat:
        narrow = np.min(spread[seen]) < 0.3 * np.max(spread[seen])
        axes.set_aspect("equal", adjustable="datalim" if narrow else "box")
        axes.grid(alpha=0.3)
    else:
        axes.set_zlabel(labels[2])
        axes.set_box_aspect(np.maximum(spread, 0.1 * spread.max()), zoom=0.85)
    axes.plot([], [], "o", color="0.4", markerfacecolor="white", label="start")
    axes.plot([], [], "s", color="0.4", label="end")
    axes.plot([], [], "k+", label="origin of the world")
    plane = f" in the plane of {labels[0][0]} and {labels[1][0]}" if flat else ""
    axes.set_title("Paths of the centres of mass" + plane)
    axes.legend(loc="upper center", bbox_to_anchor=(0.5, -0.08), ncols=5, fontsize=8, frameon=False)


def draw_energy(axes, run):
    t = run["balance_time"]
    for name, label in (("kinetic_energy", "kinetic"), ("potential_energy", "potential"), ("energy", "sum")):
        axes.plot(t, run[name], linewidth=1.8 if name == "energy" else 1.0, label=label)
    if np.ptp(run["work"]) > 0:
        axes.plot(t, run["work"], linewidth=1.0, linestyle="--", label="work of loads")
    axes.set(ylabel="energy (J)", title="Energy at the element ends")
    axes.legend(fontsize=8, ncols=4)


def draw_on_logarithmic_axis(axes, t, values, **style):
    axes.semilogy(t, np.maximum(values, FLOOR), ".", markersize=3, **style)
    axes.set_ylim(FLOOR / 3, 10 * max(1e-15, axes.dataLim.y1))


def draw_drift(axes, run):
    scale = float(run.attributes["largest_kinetic_energy"])
    draw_on_logarithmic_axis(axes, run["balance_time"], run["energy_error"])
    axes.set(ylabel="|energy error| (J)",
             title=f"Energy less start and work of loads (largest kinetic energy {scale:.3g} J)")


def draw_violation(axes, run):
    for name, label in (("joint_violation", "joints"), ("rigidity_violation", "rigidity of the bodies")):
        if name in run:
            draw_on_logarithmic_axis(axes, run["X_node"], run[name], label=label)
            axes.legend(fontsize=8, loc="upper right", ncols=2)
    if "joint_violation" not in run and "rigidity_violation" not in run:
        axes.text(0.5, 0.5, "no constraints", transform=axes.transAxes, ha="center")
    axes.set(ylabel="violation (1)", xlabel=f"time (s); zeros are drawn at {FLOOR:.0e}",
             title="Constraint violation at all nodes, relative to each row's length")


def draw(run):
    figure = plt.figure(figsize=(14, 8.5), layout="constrained")
    grid = figure.add_gridspec(3, 2, width_ratios=[1.1, 1])
    draw_motion(figure, grid[:, 0], run)
    first = None
    for row, panel in enumerate((draw_energy, draw_drift, draw_violation)):
        axes = figure.add_subplot(grid[row, 1], sharex=first)
        first = first or axes
        panel(axes, run)
        axes.grid(alpha=0.3)
    title = run.text("title") or "livens"
    title += f" - {run.text('method')}, {int(run.attributes['elements'])} elements"
    if not int(run.attributes["converged"]):
        title += f": {run.text('status')}"
    figure.suptitle(title, fontsize=14)
    return figure


def main():
    if len(sys.argv) != 3:
        sys.exit(__doc__)
    draw(Run(sys.argv[1])).savefig(sys.argv[2], dpi=130)


if __name__ == "__main__":
    main()
