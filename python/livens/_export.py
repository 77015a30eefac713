# SPDX-License-Identifier: BSD-3-Clause
"""Results for xarray, pandas and matplotlib; comparison of two."""
from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt

from ._errors import fault, need
from ._parts import UNITS, Floats
from ._series import Series
from ._shown import check_units, factor_to

if TYPE_CHECKING:
    import pandas
    import xarray

_XYZ = ["x", "y", "z"]
_TRIAD = [f"d{i + 1}.{c}" for i in range(3) for c in _XYZ]
_COLUMNS = {3: _XYZ, 4: ["w", "x", "y", "z"]}


def to_xarray(series: Series) -> xarray.Dataset:
    """See Series.to_xarray()."""
    xr = need("xarray", "xarray", "to_xarray()")
    bodies, joints = list(series.bodies), list(series.joints)
    time = [] if series._is_single else ["time"]
    variables: dict[str, Any] = {}

    def add(name: str, dims: list[str], array: Floats, unit: str, meaning: str) -> None:
        variables[name] = (time + dims, array, {"units": unit, "long_name": meaning})

    for name, last in (("position", ["xyz"]), ("center_of_mass", ["xyz"]), ("quaternion", ["quaternion_part"]),
                       ("directors", ["director", "xyz"]), ("velocity", ["xyz"]), ("angular_velocity", ["xyz"]),
                       ("angular_velocity_body", ["xyz"]), ("linear_momentum", ["xyz"]), ("angular_momentum", ["xyz"])):
        array = series._shaped(series._bodies()[name])
        add(name, ["body", *last], array, UNITS[name], name.replace("_", " "))
    for name in ("acceleration", "angular_acceleration"):
        add(name, ["body", "xyz"], series._shaped(series._accelerations()[name]), UNITS[name], name.replace("_", " "))
    if joints and series._result.has_multipliers:
        add("reaction_force", ["joint", "xyz"], series._shaped(series._joints()["force"]), "N", "on the second body")
        add("reaction_torque", ["joint", "xyz"], series._shaped(series._joints()["torque"]), "N m",
            "on the second body, about the joint point")
    coordinates: dict[str, Any] = {"body": bodies, "xyz": _XYZ, "quaternion_part": ["w", "x", "y", "z"],
                                   "director": ["d1", "d2", "d3"]}
    for kind in ("angle", "displacement", "angle_1", "angle_2", "angle_3"):
        having = [name for name in joints if kind in series.joints[name].coordinates]
        if having:
            coordinates[kind] = having
            for end in ("", "_rate", "_acceleration"):
                columns = [getattr(series.joints[name], kind + end) for name in having]
                add(f"joint_{kind}{end}", [kind], np.stack(columns, axis=-1), UNITS[kind + end], f"{kind}{end} of the joint")
    for word, parts in (("sensor", series.sensors), ("load", series.loads)):
        for name, part in parts.items():
            for reading, unit in part.readings.items():
                variables[f"{word}:{name}.{reading}"] = (time, part[reading], {"units": unit})
    for name in ("kinetic", "potential", "energy"):
        add(f"{name}_energy" if name != "energy" else name, [], getattr(series, name), "J", f"{name} energy")
    coordinates["time"] = (time, series.t, {"units": "s", "axis": "T"})
    if joints:
        coordinates["joint"] = joints
    dataset: xarray.Dataset = xr.Dataset(variables, coordinates, attrs={"title": series._result.title, "method": series._result.method,
                                                     "livens_version": series._result.version})
    return dataset


def to_dataframe(series: Series, names: tuple[Any, ...], unit: Any = None) -> pandas.DataFrame:
    """See Series.to_dataframe()."""
    pd = need("pandas", "pandas", "to_dataframe()")
    columns: dict[str, Floats] = {}
    units: dict[str, str] = {}
    known: list[str] = []
    for name in names or tuple(series.bodies):
        part = series[name]
        for key, array in part.arrays().items():
            array = np.asarray(array) if not series._is_single else np.asarray(array)[None]
            flat = array.reshape(len(array), -1)
            if array.ndim == 1:
                ends = [""]
            elif array.ndim == 2:
                ends = ["." + c for c in _COLUMNS[array.shape[1]]]
            else:
                ends = ["." + c for c in _TRIAD]
            factor, shown = factor_to(part.unit(key), unit)
            known.append(part.unit(key))
            for i, end in enumerate(ends):
                columns[f"{part.name}.{key}{end}"] = flat[:, i] if factor == 1 else flat[:, i] * factor
                units[f"{part.name}.{key}{end}"] = shown
    check_units(unit, known)
    frame: pandas.DataFrame = pd.DataFrame(columns, index=pd.Index(np.atleast_1d(series.t), name="t"))
    frame.attrs["units"] = units
    return frame


def plot(series: list[tuple[str, Series]], what: tuple[str, ...], keywords: dict[str, Any],
         unit: Any = None) -> npt.NDArray[Any]:
    """See Series.plot(); several are drawn over one another."""
    plt = need("matplotlib.pyplot", "plot", "plot()")
    groups = list(what) or ["energy"]
    if any(not isinstance(name, str) for name in groups):
        raise TypeError("plot() takes names: 'rod.position', 'energy'")
    arrays = [[s._array(name) for _, s in series] for name in groups]
    check_units(unit, [rows[0][1] for rows in arrays])
    _, axes = plt.subplots(len(groups), 1, sharex=True, squeeze=False, layout="constrained",
                           figsize=(7, 1.2 + 2 * len(groups)))
    for axis, name, rows in zip(axes[:, 0], groups, arrays):
        factor, shown = factor_to(rows[0][1], unit)
        for (label, s), (array, _), style in zip(series, rows, ("-", "--", ":")):
            array = array if factor == 1 else array * factor
            flat = np.atleast_1d(array).reshape(len(np.atleast_1d(s.t)), -1)
            ends = _ends_of(name, flat.shape[1])
            for i, end in enumerate(ends):
                words = " ".join(word for word in (end, label) if word)
                axis.plot(np.atleast_1d(s.t), flat[:, i], **{"linestyle": style, "color": f"C{i}", "label": words or "_",
                                                            "marker": "o" if len(flat) == 1 else None, **keywords})
        axis.set_ylabel(f"{name}\n[{shown}]")
        axis.grid(True, alpha=0.3)
        if any(not label.startswith("_") for label in axis.get_legend_handles_labels()[1]):
            axis.legend(loc="best", fontsize="small")
    axes[-1, 0].set_xlabel("t [s]")
    result: npt.NDArray[Any] = axes[:, 0]
    return result


def _ends_of(name: str, n: int) -> list[str]:
    """What the components of an array are called."""
    if n == 9:   # of stresses both directions are the body's
        return [f"{i + 1}{j + 1}" for i in range(3) for j in range(3)] if name.endswith("stress") else _TRIAD
    return _COLUMNS.get(n, [""] * n)


class Comparison:
    """Comparison of two motions, returned by :func:`livens.compare`."""

    def __init__(self, first: Series, second: Series, largest: dict[str, dict[str, float]]) -> None:
        self.first = first
        """The first one, at the instants of the comparison."""
        self.second = second
        """The second one, likewise."""
        self.largest = largest
        """Largest differences of each body: ``position`` (m), ``orientation`` (rad), ``velocity`` (m/s)."""

    def plot(self, *what: str, **keywords: Any) -> npt.NDArray[Any]:
        """Plots both, the second one dashed; for ``unit`` see :meth:`Solution.plot`."""
        unit = keywords.pop("unit", None)
        return plot([("first", self.first), ("second", self.second)], what, keywords, unit)

    def __repr__(self) -> str:
        rows = "".join(f"\n  {name:<18}" + ", ".join(f"{key} {value:.2e} {UNITS.get(key, 'rad')}"
                                                     for key, value in row.items())
                       for name, row in self.largest.items())
        return f"<livens.Comparison at {len(self.first)} instants>{rows}"


def compare(first: Any, second: Any, t: Any = None) -> Comparison:
    """Compares two solutions at common times; their elements may differ.

    Args:
        first: A solution.
        second: Another solution, with the same body names.
        t: Times, s, shape (n,). Default: element ends of the first solution, up to the end of the second.

    Raises:
        InputError: ``time-outside``; ``body-unknown`` if they have no body in common.

    Example:
        >>> import livens as lv
        >>> m = lv.Model("fall", gravity=(0, 0, -9.81))
        >>> ball = m.add_body("ball", lv.point(mass=1))
        >>> c = lv.compare(lv.solve(m, 1, elements=2), lv.solve(m, 1, elements=3))
        >>> c.largest["ball"]["position"] < 1e-14
        True
    """
    for solution in (first, second):
        if not isinstance(solution, Series) or not callable(solution):
            raise TypeError(f"compare() takes two solutions, not {type(solution).__name__}")
    if t is None:
        ends = first.t
        t = ends[(ends >= second.t[0]) & (ends <= second.t[-1])]
        if len(t) == 0:
            raise fault("time-outside", "the two motions have no instant in common")
    a, b = first(t), second(t)
    names = [name for name in a.bodies if name in b.bodies]
    if not names:
        raise fault("body-unknown", "the two motions have no body in common")
    largest = {}
    for name in names:
        p, q = a.bodies[name], b.bodies[name]
        cosine = np.clip(np.abs(np.sum(p.quaternion * q.quaternion, axis=-1)), 0, 1)
        sine = np.minimum(np.linalg.norm(p.quaternion - q.quaternion, axis=-1),
                          np.linalg.norm(p.quaternion + q.quaternion, axis=-1))
        angle = np.where(cosine > 0.9, 4 * np.arcsin(np.minimum(sine / 2, 1)), 2 * np.arccos(cosine))
        largest[name] = {"position": float(np.linalg.norm(p.position - q.position, axis=-1).max()),
                         "orientation": 0.0 if np.isnan(angle).all() else float(angle.max()),
                         "velocity": float(np.linalg.norm(p.velocity - q.velocity, axis=-1).max())}
    return Comparison(a, b, largest)
