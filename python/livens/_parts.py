# SPDX-License-Identifier: BSD-3-Clause
"""Bodies, joints, loads and sensors of a result: read-only arrays by name."""
from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from typing import TYPE_CHECKING, Any, Generic, TypeVar

import numpy as np
import numpy.typing as npt

from . import _core
from ._entries import Entry, unknown_name
from ._errors import fault
from ._other_names import BODY, JOINT, unknown
from ._shown import components_along, euler_of, relative_quaternion, rotation_of, rotation_vector_of

if TYPE_CHECKING:
    from typing_extensions import TypeAlias

    from ._series import Series

Floats: TypeAlias = "npt.NDArray[np.float64]"
_T = TypeVar("_T")

UNITS = {
    "position": "m", "center_of_mass": "m", "directors": "1", "directors_raw": "1", "quaternion": "1",
    "velocity": "m/s", "angular_velocity": "rad/s", "angular_velocity_body": "rad/s", "linear_momentum": "kg m/s",
    "angular_momentum": "kg m^2/s", "force": "N", "torque": "N m", "force_before": "N", "torque_before": "N m",
    "angle": "rad", "angle_rate": "rad/s", "displacement": "m", "displacement_rate": "m/s", "kinetic": "J",
    "potential": "J", "energy": "J", "work": "J", "drift": "J", "position_error": "m", "orientation_error": "rad",
    "velocity_error": "m/s", "rigidity_stress": "N m", "mean_stress": "Pa", "reaction_error": "1", "growth": "1", "t": "s", "power": "W",
    "acceleration": "m/s^2", "angular_acceleration": "rad/s^2", "center_acceleration": "m/s^2",
    "angle_acceleration": "rad/s^2", "displacement_acceleration": "m/s^2",
    **{f"angle_{k}{end}": unit for k in (1, 2, 3) for end, unit in (("", "rad"), ("_rate", "rad/s"), ("_acceleration", "rad/s^2"))}}
_BODY_ARRAYS = ("position", "center_of_mass", "quaternion", "directors", "velocity", "angular_velocity",
                "angular_velocity_body", "acceleration", "angular_acceleration", "linear_momentum", "angular_momentum")


class Part:
    """One body, joint, load or sensor of a result."""

    def __init__(self, series: Series, name: str, index: int) -> None:
        self._series, self._name, self._index = series, name, index

    @property
    def name(self) -> str:
        """Its name in the model."""
        return self._name

    @property
    def t(self) -> Floats:
        """Instants, s, shape (n,)."""
        return self._series.t

    def arrays(self) -> dict[str, Floats]:
        """All arrays by name; :meth:`unit` returns their units."""
        raise NotImplementedError

    def unit(self, name: str) -> str:
        """The unit of an attribute: ``"N m"``."""
        return UNITS[name]

    def __dir__(self) -> list[str]:
        return [*super().__dir__(), *self.arrays()]

    if not TYPE_CHECKING:
        def __getattr__(self, name: str) -> Any:
            if name.startswith("_"):
                raise AttributeError(name)
            has = [key for key in dir(type(self)) if not key.startswith("_")]
            if name in has:   # a property of ours that failed: its own error
                return object.__getattribute__(self, name)
            raise unknown(self, f"'{self._name}'", BODY, name, self._name, [*has, *self.arrays()])

    def __repr__(self) -> str:
        kind = type(self).__name__.replace("Series", "").lower()
        return f"<livens {kind} '{self.name}' at {self._series._n_text()}: {', '.join(self.arrays())}>"


class BodySeries(Part):
    """A body along a motion. World axes unless noted; the first dimension is time (absent for a single time).

    For point masses, which have no orientation, arrays of orientation are nan.
    """

    def _get(self, name: str) -> Floats:
        return self._series._shaped(self._series._bodies()[name][:, self._index])

    def arrays(self) -> dict[str, Floats]:
        return {name: getattr(self, name) for name in _BODY_ARRAYS}

    @property
    def position(self) -> Floats:
        """Position of the reference point, m, world, shape (n, 3). At element ends a view of the motion."""
        view = self._series._end_view("end_configurations")
        return self._get("position") if view is None else view[:, self._index, 0]

    @property
    def velocity(self) -> Floats:
        """Velocity of the reference point, m/s, world, shape (n, 3). At element ends a view of the motion."""
        view = self._series._end_view("end_velocities")
        return self._get("velocity") if view is None else view[:, self._index, 0]

    @property
    def center_of_mass(self) -> Floats:
        """m, world, shape (n, 3)."""
        return self._get("center_of_mass")

    @property
    def quaternion(self) -> Floats:
        """Orientation (w, x, y, z), body to world, sign continuous, shape (n, 4). SciPy's has w last.

        For oblique directors, the quaternion of the nearest orthonormal triad."""
        return self._get("quaternion")

    @property
    def directors(self) -> Floats:
        """Rows d1, d2, d3 in world axes, shape (n, 3, 3): the transpose of the rotation matrix.

        Orthonormal, unless the model gives oblique directors."""
        return self._get("directors")

    @property
    def directors_raw(self) -> Floats:
        """The directors as solved, including their rigidity violation, shape (n, 3, 3)."""
        return self._get("directors_raw")

    @property
    def angular_velocity(self) -> Floats:
        """rad/s, world axes, shape (n, 3)."""
        return self._get("angular_velocity")

    @property
    def angular_velocity_body(self) -> Floats:
        """rad/s, components along the directors, shape (n, 3)."""
        return self._get("angular_velocity_body")

    @property
    def acceleration(self) -> Floats:
        """Acceleration of the reference point, m/s^2, world, shape (n, 3).

        Computed from the equations of motion at each time, not from differences; nan where joints lose rank. At a
        jump of a load, the value just after it."""
        return self._series._shaped(self._series._accelerations()["acceleration"][:, self._index])

    @property
    def angular_acceleration(self) -> Floats:
        """rad/s^2, world axes, shape (n, 3). Computed like :attr:`acceleration`."""
        return self._series._shaped(self._series._accelerations()["angular_acceleration"][:, self._index])

    @property
    def center_acceleration(self) -> Floats:
        """Acceleration of the centre of mass, m/s^2, world, shape (n, 3): total force divided by mass."""
        return self._moved(self.acceleration, self.center_of_mass - self.position)

    def _moved(self, acceleration: Floats, arm: Floats) -> Floats:
        w = self.angular_velocity
        if np.isnan(w).all():   # a point mass
            return acceleration
        moved: Floats = acceleration + np.cross(self.angular_acceleration, arm) + np.cross(w, np.cross(w, arm))
        return moved

    @property
    def rotation(self) -> Floats:
        """Rotation matrix R from body to world; its columns are the body axes, shape (n, 3, 3)."""
        return rotation_of(self.quaternion)

    def rotation_vector(self, seen_from: str | Entry | Part = "world") -> Floats:
        """Rotation vector of the body relative to another body (or the world), rad, in the axes of the latter,
        shape (n, 3).

        Its length is at most pi; the ``angle`` of a joint counts full turns."""
        return rotation_vector_of(self._quaternion_from(seen_from))

    def angle_to(self, other: str | Entry | Part = "world") -> Floats:
        """Angle of the rotation between two bodies, rad, from 0 to pi, shape (n,)."""
        angle: Floats = np.linalg.norm(self.rotation_vector(other), axis=-1)
        return angle

    def euler(self, order: str, seen_from: str | Entry | Part = "world") -> Floats:
        """Euler angles, rad, in the order of rotation, shape (n, 3).

        Args:
            order: ``"zyx"`` (yaw, pitch, roll), ``"zxz"``, ..: successive rotations about body axes, so that
                ``R = R_z(a) R_y(b) R_x(c)``; SciPy writes it ``"ZYX"``. The first and last angle are continuous.
            seen_from: Body relative to which the angles are computed; default: the world.
        """
        return euler_of(self._quaternion_from(seen_from), order)

    def _quaternion_from(self, other: str | Entry | Part) -> Floats:
        if isinstance(other, str) and other == "world":
            return self.quaternion
        body = self._series.bodies[other]   # type: ignore[index]   # handles are names, too
        return relative_quaternion(self.quaternion, body.quaternion)

    def point(self, at: Any) -> PointSeries:
        """Position, velocity and acceleration of a point of the body, given in body coordinates, m."""
        from ._tree import plain
        given = plain(at, {"unit": "m", "other_unit": "", "child": None}, "at")
        if not isinstance(given, (tuple, list)) or len(given) != 3:
            raise fault("wrong-type", "a point has three coordinates, as in (0.5, 0, 0)", "at")
        numbers = [_core.quantity(item, "m", "") if isinstance(item, str) else float(item) for item in given]
        return PointSeries(self._series, f"point of {self.name}", 0, self, np.array(numbers))

    @property
    def linear_momentum(self) -> Floats:
        """kg m/s, world, shape (n, 3)."""
        return self._get("linear_momentum")

    @property
    def angular_momentum(self) -> Floats:
        """kg m^2/s about the world's origin, world axes, shape (n, 3)."""
        return self._get("angular_momentum")

    @property
    def rigidity_stress(self) -> Floats:
        """Volume integral of the stress that keeps the body rigid, N m, along its directors, shape (n, 3, 3);
        tension positive.

        Second Piola-Kirchhoff stress integrated over the body, from the equations of motion; just after a jump of a
        load; zero for point masses, nan where joints lose rank. In closed loops with redundant joints it is not
        unique; it belongs to the smallest reactions."""
        return self._series._shaped(self._series._rigidity()["rigidity"][:, self._index])

    @property
    def mean_stress(self) -> Floats:
        """:attr:`rigidity_stress` divided by the volume of the body's shape, Pa, shape (n, 3, 3); nan without a shape."""
        stress: Floats = self.rigidity_stress / self._series._result.body_volumes()[self._index]
        stress.flags.writeable = False
        return stress

    @property
    def position_error(self) -> Floats:
        """Estimated error of the centre of mass, m, shape (n,). nan between element ends and without an estimate."""
        return self._series._estimate("position", self._index, self._series._length())

    @property
    def orientation_error(self) -> Floats:
        """Estimated orientation error, rad, shape (n,); 0 for point masses, nan like :attr:`position_error`."""
        return self._series._estimate("orientation", self._index)

    @property
    def velocity_error(self) -> Floats:
        """Estimated velocity error of the centre of mass, m/s, shape (n,); nan like :attr:`position_error`."""
        return self._series._estimate("velocity", self._index)


class PointSeries(Part):
    """A point along a motion, world axes: a named one of the model, or one of a body; see :meth:`BodySeries.point`.

    Example:
        >>> import livens as lv
        >>> m = lv.Model()
        >>> top = m.add_body("top", lv.sphere("10 cm", mass=1), angular_velocity=(0, 0, 2))
        >>> rim = m.add_point("rim", top, position=("10 cm", 0, 0))
        >>> sol = lv.solve(m, 1)
        >>> (sol["rim"].acceleration[0] + 0.0).round(9).tolist()
        [-0.4, 0.0, 0.0]
        >>> (sol["top"].point(("10 cm", 0, 0)).acceleration[0] + 0.0).round(9).tolist()
        [-0.4, 0.0, 0.0]
    """

    def __init__(self, series: Series, name: str, index: int, body: BodySeries | None, at: Floats) -> None:
        super().__init__(series, name, index)
        self._body = body   # None: the world
        shape = (3,) if series._is_single else (len(series._instants()), 3)
        self._still: Floats = np.zeros(shape)
        self._arm: Floats = self._still + at if body is None else (
            self._still if not at.any() else np.asarray(at @ body.directors))

    @property
    def position(self) -> Floats:
        """m, shape (n, 3)."""
        return self._arm if self._body is None else self._body.position + self._arm

    @property
    def velocity(self) -> Floats:
        """m/s, shape (n, 3)."""
        if self._body is None:
            return self._still
        velocity: Floats = self._body.velocity + (np.cross(self._body.angular_velocity, self._arm) if self._arm.any() else 0)
        return velocity

    @property
    def acceleration(self) -> Floats:
        """m/s^2, shape (n, 3); see :attr:`BodySeries.acceleration`."""
        return self._still if self._body is None else self._body._moved(self._body.acceleration, self._arm)

    def arrays(self) -> dict[str, Floats]:
        return {name: getattr(self, name) for name in ("position", "velocity", "acceleration")}


class JointSeries(Part):
    """A joint or drive along a motion; its coordinates (``angle``, ``displacement``, ``angle_1``, rates) are attributes, too."""

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
            if name == known + "_acceleration":
                return self._series._shaped(
                    self._series._accelerations()["coordinate_acceleration"][:, self._first + i])
            if name in (known, known + "_rate"):
                column = "coordinate" if name == known else "coordinate_rate"
                return self._series._shaped(self._series._scalars()[column][:, self._first + i])
        if name in ("effort", "power", "tension"):
            column = f"{name} {self._index}"
            if column in self._series._result.drive_columns:
                return self._series._shaped(self._series._drives()[column][:, 0])
        effort = self._efforts().get(name)
        if effort is not None:
            return effort["effort"]
        if name.startswith("_"):
            raise AttributeError(name)
        has = [key for key in dir(type(self)) if not key.startswith("_")]
        if name in has:   # a property of ours that failed: its own error
            return object.__getattribute__(self, name)
        raise unknown(self, f"joint '{self._name}'", JOINT, name, self._name,
                      [*has, *self._names()],
                      f"its coordinates: {', '.join(coordinates) or 'none'}; beside them force and torque")

    def _names(self) -> list[str]:
        names = [name + end for name in self.coordinates for end in ("", "_rate", "_acceleration")]
        drives = [key for key in ("effort", "power", "tension") if f"{key} {self._index}" in self._series._result.drive_columns]
        return [*names, "force", "torque", *drives, *self._efforts()]

    def _efforts(self) -> dict[str, LoadSeries]:
        """The loads that the joint states itself: "effort" along its coordinate, of several "angle_effort" and the others;
        "limit_effort" of a ball joint."""
        ends = {"": "effort", " limit": "limit_effort", **{f" {name}": f"{name}_effort" for name in self.coordinates}}
        own = [name for name, type, told in self._series._result.loads if type == "joint" and told[0][0] == "effort"]
        return {word: self._series.loads[self._name + end] for end, word in ends.items() if self._name + end in own}

    def unit(self, name: str) -> str:
        """The unit of an attribute: ``"N m"``."""
        if name in self._efforts():
            return self._efforts()[name].unit("effort")
        if name in ("effort", "tension"):
            return str(self._series._result.drive_columns[f"{name} {self._index}"])
        return super().unit(name)

    def force_in(self, body: str | Entry | Part) -> Floats:
        """:attr:`force` in components along the axes of a body, N, shape (n, 3)."""
        return components_along(self.force, self._axes_of(body))

    def torque_in(self, body: str | Entry | Part) -> Floats:
        """:attr:`torque` in components along the axes of a body, N m, shape (n, 3)."""
        return components_along(self.torque, self._axes_of(body))

    def _axes_of(self, body: str | Entry | Part) -> Floats:
        if isinstance(body, str) and body == "world":
            return np.array([1.0, 0.0, 0.0, 0.0])
        axes = self._series.bodies[body]   # type: ignore[index]   # handles are names, too
        if np.isnan(axes.quaternion).any():
            raise fault("wrong-type", f"'{axes.name}' is a point mass, which has no axes", "body")
        return axes.quaternion

    def arrays(self) -> dict[str, Floats]:
        return {name: getattr(self, name) for name in self._names()}

    @property
    def force(self) -> Floats:
        """Reaction force on the second body, N, world axes, shape (n, 3). At a jump of a load, the value just after
        it."""
        return self._get("force")

    @property
    def torque(self) -> Floats:
        """Reaction torque on the second body about the joint point, N m, world axes, shape (n, 3); at jumps like
        :attr:`force`."""
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
        """False if other joints of a closed loop could carry part of the reactions; the smallest ones are given."""
        return bool(np.all(self._series._joints()["is_unique"][:, self._index] != 0))

    @property
    def bounded(self) -> bool:
        """False if the joints lose rank at some time; reactions are nan there."""
        return bool(np.all(self._series._joints()["is_bounded"][:, self._index] != 0))

    @property
    def reaction_error(self) -> Floats:
        """Estimated reaction error, relative to the largest reaction of the run, shape (n,). nan where it is not
        known."""
        return self._series._estimate("reaction", self._index)


class ReadingSeries(Part):
    """Readings of a load or a sensor along a motion, as attributes and as items."""

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
        if name.startswith("_"):
            raise AttributeError(name)
        known = ", ".join(self.__dict__.get("readings", {}))
        raise AttributeError(f"'{self.__dict__.get('_name')}' has no '{name}'; it tells {known}", name=name, obj=self)

    def arrays(self) -> dict[str, Floats]:
        return {name: self[name] for name in self.readings}


class LoadSeries(ReadingSeries):
    """A load along a motion: its readings, and its ``power`` (W) on the bodies."""


class SensorSeries(ReadingSeries):
    """A sensor along a motion."""


def _spaced(unit: str) -> str:
    """"rad s-1" as "rad/s"."""
    import re
    return re.sub(r" (\w+)-(\d)", lambda m: "/" + m[1] + ("" if m[2] == "1" else "^" + m[2]), unit)


class Parts(Mapping[str, _T], Generic[_T]):
    """Bodies (joints, loads, sensors) of a result by name. Iteration yields names."""

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
