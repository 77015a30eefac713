# SPDX-License-Identifier: BSD-3-Clause
"""Results by name: read-only arrays of the motion."""
from __future__ import annotations

import json
import os
from collections.abc import Callable, Iterator, Mapping
from html import escape
from typing import TYPE_CHECKING, Any, Generic, TypeVar

import numpy as np
import numpy.typing as npt

from . import _core
from ._entries import Entry, unknown_name
from ._errors import fault, file_name
from ._tree import plain

if TYPE_CHECKING:
    import pandas
    import xarray
    from typing_extensions import TypeAlias

    from ._model import Model

Floats: TypeAlias = "npt.NDArray[np.float64]"
_T = TypeVar("_T")

UNITS = {
    "position": "m", "center_of_mass": "m", "directors": "1", "directors_raw": "1", "quaternion": "1",
    "velocity": "m/s", "angular_velocity": "rad/s", "angular_velocity_body": "rad/s", "linear_momentum": "kg m/s",
    "angular_momentum": "kg m^2/s", "force": "N", "torque": "N m", "force_before": "N", "torque_before": "N m",
    "angle": "rad", "angle_rate": "rad/s", "displacement": "m", "displacement_rate": "m/s", "kinetic": "J",
    "potential": "J", "energy": "J", "work": "J", "drift": "J", "position_error": "m", "orientation_error": "rad",
    "velocity_error": "m/s", "reaction_error": "1", "growth": "1", "t": "s", "power": "W"}
_LARGEST_INLINE = 4_000_000   # characters of a page inside a notebook
_BODY_ARRAYS = ("position", "center_of_mass", "quaternion", "directors", "velocity", "angular_velocity",
                "angular_velocity_body", "linear_momentum", "angular_momentum")


class Part:
    """One body, joint, load or sensor of a result."""

    def __init__(self, series: Series, name: str, index: int) -> None:
        self._series, self._name, self._index = series, name, index

    @property
    def name(self) -> str:
        """What the model calls it."""
        return self._name

    @property
    def t(self) -> Floats:
        """Instants, s, shape (n,)."""
        return self._series.t

    def arrays(self) -> dict[str, Floats]:
        """All that there is, by name; units are those of :meth:`unit`."""
        raise NotImplementedError

    def unit(self, name: str) -> str:
        """The unit of an attribute: ``"N m"``."""
        return UNITS[name]

    def __dir__(self) -> list[str]:
        return [*super().__dir__(), *self.arrays()]

    def __repr__(self) -> str:
        kind = type(self).__name__.replace("Series", "").lower()
        return f"<livens {kind} '{self.name}' at {self._series._n_text()}: {', '.join(self.arrays())}>"


class BodySeries(Part):
    """A body along a motion. World axes unless said; the first dimension is time (none for a single instant).

    Point masses have no orientation: what tells of it is nan.
    """

    def _get(self, name: str) -> Floats:
        return self._series._shaped(self._series._bodies()[name][:, self._index])

    def arrays(self) -> dict[str, Floats]:
        return {name: getattr(self, name) for name in _BODY_ARRAYS}

    @property
    def position(self) -> Floats:
        """Of the reference point, m, world, shape (n, 3). At element ends a view of the motion."""
        view = self._series._end_view("end_configurations")
        return self._get("position") if view is None else view[:, self._index, 0]

    @property
    def velocity(self) -> Floats:
        """Of the reference point, m/s, world, shape (n, 3). At element ends a view of the motion."""
        view = self._series._end_view("end_velocities")
        return self._get("velocity") if view is None else view[:, self._index, 0]

    @property
    def center_of_mass(self) -> Floats:
        """m, world, shape (n, 3)."""
        return self._get("center_of_mass")

    @property
    def quaternion(self) -> Floats:
        """Orientation (w, x, y, z), body to world, sign continuous, shape (n, 4). SciPy's has w last."""
        return self._get("quaternion")

    @property
    def directors(self) -> Floats:
        """Rows d1, d2, d3 in world axes, orthonormal, shape (n, 3, 3): the transpose of the rotation matrix."""
        return self._get("directors")

    @property
    def directors_raw(self) -> Floats:
        """The same of the motion itself, with its violation of rigidity, shape (n, 3, 3)."""
        return self._get("directors_raw")

    @property
    def angular_velocity(self) -> Floats:
        """rad/s, world axes, shape (n, 3)."""
        return self._get("angular_velocity")

    @property
    def angular_velocity_body(self) -> Floats:
        """rad/s, body axes, shape (n, 3)."""
        return self._get("angular_velocity_body")

    @property
    def linear_momentum(self) -> Floats:
        """kg m/s, world, shape (n, 3)."""
        return self._get("linear_momentum")

    @property
    def angular_momentum(self) -> Floats:
        """kg m^2/s about the world's origin, world axes, shape (n, 3)."""
        return self._get("angular_momentum")

    @property
    def position_error(self) -> Floats:
        """Estimated, of the centre of mass, m, shape (n,). nan between element ends and without an estimate."""
        return self._series._estimate("position", self._index, self._series._length())

    @property
    def orientation_error(self) -> Floats:
        """Estimated, rad, shape (n,); 0 for point masses. nan likewise."""
        return self._series._estimate("orientation", self._index)

    @property
    def velocity_error(self) -> Floats:
        """Estimated, of the centre of mass, m/s, shape (n,). nan likewise."""
        return self._series._estimate("velocity", self._index)


class JointSeries(Part):
    """A joint or drive along a motion; its coordinates (``angle``, ``displacement``, rates) are attributes, too."""

    def __init__(self, series: Series, name: str, index: int, first: int, coordinates: list[tuple[str, str]]) -> None:
        super().__init__(series, name, index)
        self._first = first
        self.coordinates: dict[str, str] = dict(coordinates)
        """Names and units of its coordinates: ``{"angle": "rad"}``."""

    def _get(self, name: str) -> Floats:
        return self._series._shaped(self._series._joints()[name][:, self._index])

    def __getattr__(self, name: str) -> Any:
        coordinates = self.__dict__.get("coordinates", {})
        for i, known in enumerate(coordinates):
            if name in (known, known + "_rate"):
                column = "coordinate" if name == known else "coordinate_rate"
                return self._series._shaped(self._series._scalars()[column][:, self._first + i])
        have = ", ".join(coordinates) or "none"
        raise AttributeError(f"joint '{self._name}' has no '{name}'; its coordinates: {have}", name=name, obj=self)

    def arrays(self) -> dict[str, Floats]:
        names = [name + end for name in self.coordinates for end in ("", "_rate")]
        return {name: getattr(self, name) for name in [*names, "force", "torque"]}

    @property
    def force(self) -> Floats:
        """Of the joint on its second body, N, world axes, shape (n, 3). Where a load jumps, afterwards."""
        return self._get("force")

    @property
    def torque(self) -> Floats:
        """Of the joint on its second body about the joint point, N m, world axes, shape (n, 3). Likewise."""
        return self._get("torque")

    @property
    def force_before(self) -> Floats:
        """The force just before each instant, N, world axes, shape (n, 3)."""
        return self._get("force_before")

    @property
    def torque_before(self) -> Floats:
        """The torque just before each instant, N m, world axes, shape (n, 3)."""
        return self._get("torque_before")

    @property
    def unique(self) -> bool:
        """False: other joints of a closed loop could carry part of the reactions; these are the least."""
        return bool(np.all(self._series._joints()["is_unique"][:, self._index] != 0))

    @property
    def bounded(self) -> bool:
        """False: the joints lose rank at some instant; reactions are nan there."""
        return bool(np.all(self._series._joints()["is_bounded"][:, self._index] != 0))

    @property
    def reaction_error(self) -> Floats:
        """Estimated, relative to the largest reaction of the run, shape (n,). nan where it is not known."""
        return self._series._estimate("reaction", self._index)


class ReadingSeries(Part):
    """What a load or a sensor tells along a motion: its readings are attributes, and items."""

    def __init__(self, series: Series, name: str, index: int, first: int, readings: list[tuple[str, str]]) -> None:
        super().__init__(series, name, index)
        self._first = first
        self.readings: dict[str, str] = {name: _spaced(unit) for name, unit in readings}
        """Names and units: ``{"force": "N", "length": "m", "power": "W"}``."""

    def unit(self, name: str) -> str:
        return self.readings[name]

    def __getitem__(self, name: str) -> Floats:
        """A reading by name, shape (n,)."""
        if name not in self.readings:
            raise unknown_name("reading", name, list(self.readings))
        column = self._first + list(self.readings).index(name)
        return self._series._shaped(self._series._scalars()["reading"][:, column])

    def __getattr__(self, name: str) -> Any:
        if name in self.__dict__.get("readings", {}):
            return self[name]
        known = ", ".join(self.__dict__.get("readings", {}))
        raise AttributeError(f"'{self.__dict__.get('_name')}' has no '{name}'; it tells {known}", name=name, obj=self)

    def arrays(self) -> dict[str, Floats]:
        return {name: self[name] for name in self.readings}


class LoadSeries(ReadingSeries):
    """A load along a motion: what it does, and its ``power`` (W) on the bodies."""


class SensorSeries(ReadingSeries):
    """A sensor along a motion."""


def _spaced(unit: str) -> str:
    """"rad s-1" as "rad/s"."""
    import re
    return re.sub(r" (\w+)-(\d)", lambda m: "/" + m[1] + ("" if m[2] == "1" else "^" + m[2]), unit)


class Parts(Mapping[str, _T], Generic[_T]):
    """Bodies (joints, loads, sensors) of a result by name. Iterating gives names."""

    def __init__(self, kind: str, names: list[str], make: Callable[[int], _T]) -> None:
        self._kind, self._names, self._make = kind, names, make

    def __getitem__(self, name: str) -> _T:
        name = name.name if isinstance(name, (Entry, Part)) else name
        if name not in self._names:
            raise unknown_name(self._kind, name, self._names)
        return self._make(self._names.index(name))

    def __iter__(self) -> Iterator[str]:
        return iter(self._names)

    def __len__(self) -> int:
        return len(self._names)

    def __repr__(self) -> str:
        plural = "bodies" if self._kind == "body" else self._kind + "s"
        return f"<{plural}: {', '.join(self._names) or 'none'}>"


class Series:
    """A motion at instants: what :class:`Solution` is at element ends, and ``sol(t)`` at others.

    Arrays are read-only and stay valid as long as they are used. SI units; world axes unless said.
    """

    def __init__(self, result: Any, times: Floats | None, is_single: bool = False,
                 exact: dict[str, Floats] | None = None) -> None:
        self._result = result
        self._times = times
        self._is_single = is_single
        self._groups: dict[str, dict[str, Floats]] = {}
        if exact is not None:
            self._groups = {"bodies_at": exact, "joints_at": exact, "scalars_at": exact}

    # What arrays are made of.

    def _instants(self) -> Floats:
        times: Floats = self._result.t if self._times is None else self._times
        return times

    def _group(self, name: str) -> dict[str, Floats]:
        if name not in self._groups:
            self._groups[name] = getattr(self._result, name)(self._instants())
        return self._groups[name]

    def _bodies(self) -> dict[str, Floats]:
        return self._group("bodies_at")

    def _joints(self) -> dict[str, Floats]:
        return self._group("joints_at")

    def _scalars(self) -> dict[str, Floats]:
        return self._group("scalars_at")

    def _end_view(self, name: str) -> Floats | None:
        return None if self._times is not None else getattr(self._result, name)

    def _shaped(self, array: Floats) -> Floats:
        return array[0] if self._is_single else array

    def _length(self) -> float:
        return float(self._result.figures["model_length"] or np.nan)

    def _estimate(self, name: str, index: int, scale: float = 1.0) -> Floats:
        ends, known = self._result.t, self._result.estimates.get(name)
        values: npt.NDArray[Any]
        if known is None:
            values = np.full(len(self._instants()), np.nan)
        elif self._times is None:
            values = known[:, index] * scale
        else:
            at = np.minimum(np.searchsorted(ends, self._times), len(ends) - 1)
            values = np.where(ends[at] == self._times, known[at, index] * scale, np.nan)
        values.flags.writeable = False
        return self._shaped(values)

    def _n_text(self) -> str:
        return "one instant" if self._is_single else f"{len(self._instants())} instants"

    # What there is.

    @property
    def t(self) -> Floats:
        """The instants, s, shape (n,)."""
        return self._shaped(self._instants())

    @property
    def bodies(self) -> Parts[BodySeries]:
        """All bodies by name."""
        names = self._result.body_names
        return Parts("body", names, lambda i: BodySeries(self, names[i], i))

    @property
    def joints(self) -> Parts[JointSeries]:
        """All joints by name, and the drives behind them."""
        joints = self._result.joints

        def make(i: int) -> JointSeries:
            first = sum(len(coordinates) for _, _, coordinates in joints[:i])
            return JointSeries(self, joints[i][0], i, first, joints[i][2])
        return Parts("joint", [name for name, _, _ in joints], make)

    @property
    def sensors(self) -> Parts[SensorSeries]:
        """All sensors by name."""
        sensors = self._result.sensors

        def make(i: int) -> SensorSeries:
            first = sum(len(readings) for _, _, readings in sensors[:i])
            return SensorSeries(self, sensors[i][0], i, first, sensors[i][2])
        return Parts("sensor", [name for name, _, _ in sensors], make)

    @property
    def loads(self) -> Parts[LoadSeries]:
        """All loads by name."""
        loads, of_sensors = self._result.loads, sum(len(readings) for _, _, readings in self._result.sensors)

        def make(i: int) -> LoadSeries:
            first = of_sensors + sum(len(readings) for _, _, readings in loads[:i])
            return LoadSeries(self, loads[i][0], i, first, loads[i][2])
        return Parts("load", [name for name, _, _ in loads], make)

    def __getitem__(self, name: str | Entry | Part) -> Any:
        """The body, joint, load or sensor of that name (or handle)."""
        groups: list[Parts[Any]] = [self.bodies, self.joints, self.loads, self.sensors]
        if isinstance(name, Entry):
            kinds = {"body": 0, "joint": 1, "drive": 1, "load": 2, "sensor": 3}
            return groups[kinds[name._key]][name.name]
        word = name.name if isinstance(name, Part) else name
        found = [group for group in groups if word in group]
        if len(found) == 1:
            return found[0][word]
        if found:
            raise KeyError(f"several parts are called '{word}'; write .bodies['{word}'], .joints['{word}'], ..")
        raise unknown_name("part", word, [known for group in groups for known in group])

    @property
    def kinetic(self) -> Floats:
        """Kinetic energy, J, shape (n,)."""
        return self._shaped(self._scalars()["kinetic"])

    @property
    def potential(self) -> Floats:
        """Potential energy of gravity and loads, J, shape (n,)."""
        return self._shaped(self._scalars()["potential"])

    @property
    def energy(self) -> Floats:
        """Kinetic and potential energy, J, shape (n,)."""
        return self.kinetic + self.potential

    # Elsewhere.

    def to_xarray(self) -> xarray.Dataset:
        """An ``xarray.Dataset`` with dimensions ``time``, ``body``, ``joint``, ``xyz``; units in ``attrs``.

        Needs xarray: ``pip install 'livens[xarray]'``.
        """
        from ._export import to_xarray
        return to_xarray(self)

    def to_dataframe(self, *names: str | Entry) -> pandas.DataFrame:
        """A ``pandas.DataFrame`` of the parts named (default: all bodies), a row an instant.

        Columns are ``"rod.position.x"``, the index is ``t``; ``frame.attrs["units"]`` has the units. Needs pandas:
        ``pip install 'livens[pandas]'``.
        """
        from ._export import to_dataframe
        return to_dataframe(self, names)

    def plot(self, *what: str, **keywords: Any) -> npt.NDArray[Any]:
        """Draws arrays over time, one axis each, with units; returns the axes.

        Args:
            *what: ``"rod.position"``, ``"pivot.force"``, ``"energy"``; default: energies.
            **keywords: For ``Axes.plot``.

        Needs matplotlib: ``pip install 'livens[plot]'``.
        """
        from ._export import plot
        return plot([("", self)], what, keywords)

    def _array(self, what: str) -> tuple[Floats, str]:
        """By a name with a dot: (array, unit)."""
        name, _, attribute = what.rpartition(".")
        if not name:
            if attribute not in UNITS or not hasattr(type(self), attribute):
                raise unknown_name("series", what, [n for n in UNITS if hasattr(type(self), n)])
            return getattr(self, attribute), UNITS[attribute]
        part = self[name]
        try:
            return getattr(part, attribute), part.unit(attribute)
        except (AttributeError, KeyError):
            raise unknown_name(f"array of '{name}'", attribute, list(part.arrays())) from None

    def __len__(self) -> int:
        return len(self._instants())

    def __repr__(self) -> str:
        return f"<livens.Series: {self._n_text()} of {', '.join(self.bodies)}>"


class Solution(Series):
    """A solved motion, at element ends, where it is most accurate; ``sol(t)`` has it at any instant.

    Example:
        >>> import livens as lv
        >>> m = lv.Model("fall", gravity=(0, 0, -9.81))
        >>> ball = m.add_body("ball", lv.point(mass=1))
        >>> sol = lv.solve(m, 2, elements=4)
        >>> sol.success, sol.status
        (True, 'converged')
        >>> sol.t.tolist()
        [0.0, 0.5, 1.0, 1.5, 2.0]
        >>> sol(0.25)["ball"].position.round(4).tolist()
        [0.0, 0.0, -0.3066]
    """

    def __init__(self, result: Any, has_functions: bool = False) -> None:
        super().__init__(result, None)
        self._has_functions = has_functions

    def __call__(self, t: Any, *, exact: bool = False) -> Series:
        """The motion at other instants.

        Args:
            t: An instant or several, s, any order, shape (n,); texts with units are taken.
            exact: False: the polynomials that were solved for, of the order ``dense_order_of_X`` of
                :attr:`figures` between element ends. True: one shortened element is solved for each instant, in
                the full order of the method (Lobatto and Radau).

        Raises:
            InputError: ``time-outside``; ``sample-exact-method`` for methods without.
        """
        given = plain(t, {"unit": "s", "other_unit": "", "child": None}, "t")
        is_single = not isinstance(given, (tuple, list))
        items = (given,) if is_single else given
        if any(isinstance(item, (tuple, list, dict)) for item in items):
            raise fault("wrong-type", "instants are one number, or one row of numbers", "t")
        numbers = [_core.quantity(item, "s", "") if isinstance(item, str) else item for item in items]
        times = self._result.snapped(np.array(numbers, dtype=float))
        found = self._result.exact_at(times) if exact else None
        return Series(self._result, times, is_single, found)

    # How it went.

    @property
    def success(self) -> bool:
        """The iteration converged, and the motion passed all checks."""
        return bool(self._result.converged)

    @property
    def status(self) -> str:
        """``converged``, ``suspect``, ``not_converged``, ``singular``, ``not_finite``, ``inaccurate``, .."""
        return str(self._result.status)

    @property
    def message(self) -> str:
        """One sentence for people; empty where there is nothing to say."""
        return str(self._result.message)

    @property
    def reasons(self) -> list[str]:
        """Why a motion is suspect."""
        return list(self._result.reasons)

    @property
    def notes(self) -> list[str]:
        """What is worth knowing: redundant rows, divided elements, .."""
        return list(self._result.notes)

    @property
    def title(self) -> str:
        """Of the model."""
        return str(self._result.title)

    @property
    def method(self) -> str:
        """What was taken: ``"lobatto(7)"``."""
        return str(self._result.method)

    @property
    def figures(self) -> dict[str, float | int | None]:
        """All single numbers of the run, as files have them; ``None``: not known. See docs/results.md."""
        return dict(self._result.figures)

    @property
    def options(self) -> dict[str, Any]:
        """What was solved, with all defaults: time, method, conditions."""
        return dict(json.loads(self._result.resolved))

    @property
    def n_elements(self) -> int:
        """Time elements solved."""
        return len(self._result.t) - 1

    @property
    def nfev(self) -> int:
        """Evaluations of the equations at a node, in the motion."""
        return int(self.figures["evaluations"] or 0)

    @property
    def nit(self) -> int:
        """Newton iterations."""
        return int(self.figures["newton_iterations"] or 0)

    @property
    def nlu(self) -> int:
        """Factorisations of tangents."""
        return int(self.figures["factorisations"] or 0)

    @property
    def seconds(self) -> float:
        """Wall time of the solution, s; that of the estimate of its error is not counted. 0 if it was loaded."""
        return float(self._result.solve_seconds)

    # Beside the series.

    @property
    def output(self) -> Floats:
        """The output times that were asked for, s, shape (m,)."""
        output: Floats = self._result.output
        return output

    @property
    def kinetic(self) -> Floats:
        """Kinetic energy, J, shape (n,)."""
        return self._balance("kinetic")

    @property
    def potential(self) -> Floats:
        """Potential energy of gravity and loads, J, shape (n,)."""
        return self._balance("potential")

    @property
    def energy(self) -> Floats:
        """Kinetic and potential energy, J, shape (n,)."""
        return self._balance("energy")

    @property
    def work(self) -> Floats:
        """Of loads without potential and of drives, since the start, J, shape (n,)."""
        return self._balance("work")

    @property
    def drift(self) -> Floats:
        """Energy less work less what it was at the start, absolute, J, shape (n,)."""
        return self._balance("energy_drift")

    @property
    def linear_momentum(self) -> Floats:
        """Of all bodies, kg m/s, world, shape (n, 3)."""
        return self._balance("linear_momentum")

    @property
    def angular_momentum(self) -> Floats:
        """Of all bodies about the world's origin, kg m^2/s, world, shape (n, 3)."""
        return self._balance("angular_momentum")

    @property
    def violation(self) -> float:
        """Largest violation of a constraint at nodes, each by its length."""
        value = self.figures["max_constraint_violation"]
        return float("nan") if value is None else float(value)

    @property
    def error(self) -> float:
        """Largest estimated error of positions (in lengths of the model) and orientations (rad); nan: not known."""
        value = self.figures["estimated_error"]
        return float("nan") if value is None else float(value)

    @property
    def growth(self) -> Floats:
        """By how much a perturbation of the start has grown, shape (n,) or (0,) where it was not asked for."""
        growth: Floats = self._result.growth
        return growth

    @property
    def nodes(self) -> Floats:
        """[r, d1, d2, d3] of all bodies at all nodes of all elements, shape (nodes, bodies, 4, 3); a view."""
        nodes: Floats = self._result.nodes
        return nodes

    @property
    def model(self) -> Model:
        """The model that was solved, with its time and method, read again from the text in the result."""
        from ._load import load
        self._refuse_functions("read again")
        return load(text=self._result.scenario_text, check=False)

    def _balance(self, name: str) -> Floats:
        if "balance" not in self._groups:
            self._groups["balance"] = self._result.balance()
        return self._groups["balance"][name]

    # Files.

    def _refuse_functions(self, what: str) -> None:
        if self._has_functions:
            raise fault("python-function", f"the model has a Python function as a load, so it cannot be {what}",
                        help="take arrays or to_xarray() of the result")

    def save(self, file: str | os.PathLike[str]) -> None:
        """Writes a result file, the program's bytes: classic NetCDF with scenario and checksums.

        Whatever happens, the file is the old one or the new one. ``livens info``, xarray and MATLAB read it.

        Raises:
            OSError: it cannot be written.
            InputError: ``python-function``.
        """
        self._refuse_functions("saved")
        self._result.save(file_name(file))

    def report(self, file: str | os.PathLike[str], other: Solution | None = None) -> None:
        """Writes one page for any browser: the motion in space, linked plots, and whether it is right.

        The page needs no network and no livens where it is opened; the program's ``livens report`` writes the same.

        Args:
            file: ends in ``.html``.
            other: a second solution, shown beside this one.

        Raises:
            OSError: it cannot be written.
            InputError: ``python-function``.

        Example:
            >>> import livens as lv, tempfile, pathlib
            >>> m = lv.Model(gravity=(0, 0, -9.81))
            >>> ball = m.add_body("ball", lv.point(mass=1))
            >>> page = pathlib.Path(tempfile.mkdtemp()) / "ball.html"
            >>> lv.solve(m, 1).report(page)
            >>> page.read_text(encoding="utf-8")[:15]
            '<!doctype html>'
        """
        name = file_name(file)
        page = self._page(os.path.splitext(os.path.basename(name))[0], other)
        with open(name, "w", encoding="utf-8", newline="\n") as to:
            to.write(page)

    def _page(self, name: str, other: Solution | None = None) -> str:
        self._refuse_functions("shown on a page")
        if other is not None:
            other._refuse_functions("shown on a page")
        page: str = self._result.report(name, None if other is None else other._result, "other")
        return page

    def export(self, file: str | os.PathLike[str], format: str | None = None) -> None:
        """Writes the motion for other programs, by the ending of the name or by ``format``.

        Args:
            file: Its name.
            format: ``"csv"``, ``"npz"``, ``"gltf"`` or ``"pvd"``, as ``livens export`` has them.
        """
        name = file_name(file)
        known = {word: ending for word, ending, _ in _core.export_formats()}
        chosen = format or next((word for word, ending in known.items() if name.endswith(ending)), None)
        if chosen not in known:
            endings = ", ".join(f"{word} ({ending})" for word, ending in known.items())
            raise fault("unknown-choice", f"no format fits '{chosen or name}'", "format", f"there are {endings}")
        if chosen == "npz":
            import tempfile
            with tempfile.TemporaryDirectory() as folder:   # it copies the variables of a result
                self.save(result := os.path.join(folder, "run.nc"))
                self._result.export_to(chosen, result, name)
        else:
            self._result.export_to(chosen, "", name)

    def __reduce__(self) -> tuple[Any, ...]:
        self._refuse_functions("pickled")
        return (_unpickled, (self._result.to_bytes(),))

    # For people.

    def _summary(self) -> list[tuple[str, str]]:
        f = self.figures
        rows = [("title", self.title)] if self.title else []
        if self.reasons or not self.success:
            rows.append(("because", "; ".join(self.reasons) or self.message))
        span = f"{self.t[0]:.6g} s to {self.t[-1]:.6g} s"
        rows.append(("method", f"{self.method}, {self.n_elements} elements, {span}"
                     + (f", in {self.seconds:.3g} s" if self.seconds else "")))
        words = (("estimated_error", "estimated error", "of the model's length, or rad"),
                 ("max_constraint_violation", "constraints", "violated at most, relative"),
                 ("energy_drift", "energy", "off its balance, relative"),
                 ("angular_momentum_drift", "angular momentum", "off its balance, relative"),
                 ("horizon", "horizon", "s: beyond it rounding decides"))
        rows += [(name, f"{f[key]:.1e} {meaning}" if key != "horizon" else f"{f[key]:.3g} {meaning}")
                 for key, name, meaning in words if f[key] is not None]
        return rows + [("note", note) for note in self.notes if note not in self.reasons]

    def __repr__(self) -> str:
        rows = "".join(f"\n  {name:<18}{text}" for name, text in self._summary())
        return f"<livens.Solution: {self.status}>{rows}"

    def _repr_html_(self) -> str:
        rows = "".join(f"<tr><th style='text-align:left'>{escape(name)}</th>"
                       f"<td style='text-align:left'>{escape(text)}</td></tr>" for name, text in self._summary())
        table = f"<b>livens: {escape(self.status)}</b><table>{rows}</table>"
        if self._has_functions:
            return table
        page = self._page("solution")
        if len(page) > _LARGEST_INLINE:
            return table + "<p>sol.report(\"run.html\") shows the motion; for a notebook its page is too large.</p>"
        return (f'{table}<iframe srcdoc="{escape(page)}" sandbox="allow-scripts" title="livens report" '
                'style="width:100%;height:640px;border:1px solid #8888"></iframe>')


def _unpickled(content: bytes) -> Solution:
    return Solution(_core.from_bytes(content))


def load_solution(file: str | os.PathLike[str]) -> Solution:
    """Reads a result file, written by :meth:`Solution.save` or the program.

    Raises:
        OSError: it cannot be read (``FileNotFoundError``), or is no result of livens, or damaged: ``e.code``.
    """
    name = file_name(file)
    with open(name, "rb"):   # Python's own words for what is not there
        pass
    return Solution(_core.load_result(name))
