# SPDX-License-Identifier: BSD-3-Clause
"""A motion at instants: what solutions and their samples have in common."""
from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt

from ._entries import Entry, UnknownName, unknown_name
from ._errors import fault
from ._other_names import SOLUTION, unknown
from ._parts import UNITS, BodySeries, Floats, JointSeries, LoadSeries, Part, Parts, PointSeries, SensorSeries

if TYPE_CHECKING:
    from collections.abc import Sequence

    import pandas
    import xarray


class Series:
    """A motion at given times: :class:`Solution` has element ends, ``sol(t)`` any other times.

    Arrays are read-only and stay valid as long as they are used. SI units; world axes unless noted.
    """

    def __init__(self, result: Any, times: Floats | None, is_single: bool = False,
                 exact: dict[str, Floats] | None = None, before: Floats | None = None) -> None:
        self._result = result
        self._before = np.zeros(0) if before is None else before   # 1: the instant is seen from before
        self._times = times
        self._is_single = is_single
        self._groups: dict[str, dict[str, Floats]] = {}
        if exact is not None:
            self._groups = dict.fromkeys(("bodies_at", "joints_at", "scalars_at", "rigidity_at", "accelerations_at",
                                          "drives_at"), self._seen(exact))

    if not TYPE_CHECKING:   # who checks types knows what there is

        def __getattr__(self, name: str) -> Any:
            if name.startswith("_"):
                raise AttributeError(f"'{type(self).__name__}' object has no attribute '{name}'", name=name, obj=self)
            if hasattr(type(self), name):   # a property of ours that failed: its own error
                return object.__getattribute__(self, name)
            if name in self:
                raise AttributeError(f"a solution has no attribute '{name}'; its parts are items: sol['{name}']",
                                     name=name, obj=self)
            raise unknown(self, "a solution", SOLUTION, name)

    # What arrays are made of.

    def _instants(self) -> Floats:
        times: Floats = self._result.t if self._times is None else self._times
        return times

    def _group(self, name: str) -> dict[str, Floats]:
        if name not in self._groups:
            sides = (self._before,) if name in ("scalars_at", "accelerations_at", "drives_at") else ()
            self._groups[name] = self._seen(getattr(self._result, name)(self._instants(), *sides))
        return self._groups[name]

    def _seen(self, group: dict[str, Floats]) -> dict[str, Floats]:
        """Values on both sides of an instant, from the side that it is seen from."""
        if not self._before.any():
            return group
        for name in [name for name in group if name + "_before" in group]:
            mask = (self._before != 0).reshape((-1,) + (1,) * (group[name].ndim - 1))
            group[name] = np.where(mask, group[name + "_before"], group[name])
            group[name].flags.writeable = False
        return group

    def _bodies(self) -> dict[str, Floats]:
        return self._group("bodies_at")

    def _rigidity(self) -> dict[str, Floats]:
        return self._group("rigidity_at")

    def _joints(self) -> dict[str, Floats]:
        return self._group("joints_at")

    def _scalars(self) -> dict[str, Floats]:
        return self._group("scalars_at")

    def _accelerations(self) -> dict[str, Floats]:
        return self._group("accelerations_at")

    def _drives(self) -> dict[str, Floats]:
        return self._group("drives_at")

    def _chosen(self, at: str | None, is_table: bool) -> Series:
        """The instants that are shown; only solutions have a choice."""
        if at is not None:
            raise fault("unknown-choice", "these instants were chosen already: 'at' is for solutions", "at")
        return self

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
        """All joints by name, followed by the drives."""
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

    @property
    def points(self) -> Parts[PointSeries]:
        """All named points by name."""
        points = self._result.points
        bodies = self.bodies

        def make(i: int) -> PointSeries:
            name, body, place = points[i]
            return PointSeries(self, name, i, None if body is None else bodies[body], np.array(place))
        return Parts("point", [name for name, _, _ in points], make)

    def _groups_of_parts(self) -> list[Parts[Any]]:
        return [self.bodies, self.joints, self.loads, self.sensors, self.points]

    def __getitem__(self, name: str | Entry | Part) -> Any:
        """The body, joint, load, sensor or point of that name (or handle)."""
        groups = self._groups_of_parts()
        if isinstance(name, Entry):
            kinds = {"body": 0, "joint": 1, "drive": 1, "load": 2, "sensor": 3, "point": 4}
            return groups[kinds[name._key]][name.name]
        word = name.name if isinstance(name, Part) else name
        found = [group for group in groups if word in group]
        if len(found) == 1:
            return found[0][word]
        if word not in groups[0] and word not in groups[3] and (word, "joint") in [load[:2] for load in self._result.loads]:
            return groups[1][word]   # what the joint states itself is its effort
        if found:
            ways = [f".{kind}['{word}']" for kind, group in zip(("bodies", "joints", "loads", "sensors", "points"), groups)
                    if word in group]
            raise KeyError(f"several parts are called '{word}'; write {' or '.join(ways)}")
        names = [known for group in groups for known in group]
        front, _, attribute = word.rpartition(".") if isinstance(word, str) else ("", "", "")
        if front in names:
            raise UnknownName(f"no part is called '{word}'; write sol['{front}'].{attribute}")
        raise unknown_name("part", word, names)

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

    def to_xarray(self, *, at: str | None = None) -> xarray.Dataset:
        """An ``xarray.Dataset`` with dimensions ``time``, ``body``, ``joint``, ``xyz``; units in ``attrs``.

        Args:
            at: See :meth:`to_dataframe`.

        Needs xarray: ``pip install 'livens[xarray]'``.
        """
        from ._export import to_xarray
        return to_xarray(self._chosen(at, True))

    def to_dataframe(self, *names: str | Entry, at: str | None = None,
                     unit: str | Sequence[str] | None = None) -> pandas.DataFrame:
        """A ``pandas.DataFrame`` of the given parts (default: all bodies), one row per time.

        Columns are ``"rod.position.x"``, the index is ``t``; ``frame.attrs["units"]`` has the units. Needs pandas:
        ``pip install 'livens[pandas]'``.

        Args:
            *names: Names of bodies, joints, loads, sensors.
            at: For a solution: ``"dense"``, enough times in every element for smooth curves (at jumps, one row
                before and one after); ``"output"``, the output times; ``"ends"``, element ends. Default:
                ``"output"`` if the model has output times, else ``"dense"``.
            unit: ``"deg"``, ``"mm"``, or several units, applied to columns of the same dimension.
        """
        from ._export import to_dataframe
        return to_dataframe(self._chosen(at, True), names, unit)

    def plot(self, *what: str, at: str | None = None, unit: str | Sequence[str] | None = None,
             **keywords: Any) -> npt.NDArray[Any]:
        """Plots quantities over time, one axis each, with units; returns the axes.

        Args:
            *what: ``"rod.position"``, ``"pivot.force"``, ``"energy"``; default: energies.
            at: For a solution: ``"dense"`` (default), ``"output"`` or ``"ends"``; see :meth:`to_dataframe`.
            unit: ``"deg"``, ``"rpm"``, ``"mm"``, ``"kN"``, or several units, applied to axes of the same dimension.
            **keywords: For ``Axes.plot``.

        Needs matplotlib: ``pip install 'livens[plot]'``.
        """
        from ._export import plot
        return plot([("", self._chosen(at, False))], what, keywords, unit)

    def _array(self, what: str) -> tuple[Floats, str]:
        """By a name with a dot: (array, unit)."""
        name, _, attribute = what.rpartition(".")
        if attribute in ("w", "x", "y", "z") and "." in name and name not in self:   # as columns of data frames
            array, unit = self._array(name)
            parts = {3: "xyz", 4: "wxyz"}.get(array.shape[-1], "")
            if attribute in parts:
                return array[..., parts.index(attribute)], unit
        if not name:
            if attribute in self:
                raise KeyError(f"which array of '{attribute}'? "
                               + ", ".join(f"'{attribute}.{key}'" for key in self[attribute].arrays()))
            if attribute not in UNITS or not hasattr(type(self), attribute):
                raise unknown_name("series", what, [n for n in UNITS if hasattr(type(self), n)])
            return getattr(self, attribute), UNITS[attribute]
        for way in ("force", "torque"):   # "pin.force_in.crank": in axes of a body
            joint, _, body = what.partition(f".{way}_in.")
            if body and joint in self.joints and body in self.bodies:
                return getattr(self.joints[joint], way + "_in")(body), UNITS[way]
        part = self[name]
        try:
            return getattr(part, attribute), part.unit(attribute)
        except (AttributeError, KeyError):
            raise unknown_name(f"array of '{name}'", attribute, list(part.arrays())) from None

    def __contains__(self, name: object) -> bool:
        """Whether a body, joint, load, sensor or point is called so."""
        return isinstance(name, (str, Entry, Part)) and any(name in group for group in self._groups_of_parts())

    __iter__ = None   # names or instants? Python would try numbers

    def __reduce__(self) -> tuple[Any, ...]:
        raise TypeError("samples are not pickled: pickle the solution, and ask it again; or their arrays")

    def __len__(self) -> int:
        return len(self._instants())

    def __repr__(self) -> str:
        return f"<livens.Series: {self._n_text()} of {', '.join(self.bodies)}>"
