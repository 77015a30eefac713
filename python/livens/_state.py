# SPDX-License-Identifier: BSD-3-Clause
"""States of a mechanism in its own coordinates: what follows from one, and coordinates that bring a body to a place."""
from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from . import _core
from ._entries import Entry, unknown_name
from ._errors import InputError, fault
from ._parts import Floats, Parts
from ._rest import StateMatrices, _Coordinates
from ._rotations import ORIENTATIONS, as_key, doubt, is_rotation
from ._values import Condition

if TYPE_CHECKING:
    from ._generated import Body, Point
    from ._model import Model
    from ._values import Vector

_OTHER = {"velocity": "position", "angular_velocity": "quaternion"}   # of bodies, among rates and among numbers


class Coordinates:
    """Independent coordinates of a model, which tell where all bodies are; see :attr:`Model.coordinates`.

    Iteration yields the names of the numbers in ``q``.

    Example:
        >>> import livens as lv
        >>> m = lv.Model("flight")
        >>> rod = m.add_body("rod", lv.box(1, 0.1, 0.1, mass=1))
        >>> flap = m.add_body("flap", lv.box(0.3, 0.1, 0.1, mass=1), position=(0.65, 0, 0))
        >>> hinge = m.add_revolute("hinge", rod, flap, at=(0.5, 0, 0), axis=(0, 1, 0))
        >>> m.coordinates
        <livens.Coordinates: rod.x, rod.y, rod.z, rod.qw, rod.qx, rod.qy, rod.qz, hinge.angle>
        >>> m.coordinates.v[3:]
        ('rod.wx', 'rod.wy', 'rod.wz', 'hinge.angle_rate')
    """

    def __init__(self, found: Any) -> None:
        self._found = found
        self.q: tuple[str, ...] = tuple(found.names_of_numbers)
        """Names of the numbers of a state: ``"elbow.angle"`` (rad), ``"slide.displacement"`` (m); of a body that joints leave
        free ``"base.x"``, ``.y``, ``.z`` (m) and its quaternion ``"base.qw"`` to ``"base.qz"``."""
        self.v: tuple[str, ...] = tuple(found.names_of_rates)
        """Names of the rates, and of the rows of all forces and matrices: ``"elbow.angle_rate"``, ``"base.x_rate"``; of an
        orientation the angular velocity ``"base.wx"`` to ``"base.wz"`` (rad/s, world axes)."""
        self.placed: Floats = found.placed
        """The numbers where the bodies are placed, shape (len(q),)."""

    def __iter__(self) -> Iterator[str]:
        return iter(self.q)

    def __len__(self) -> int:
        return len(self.q)

    def __repr__(self) -> str:
        return f"<livens.Coordinates: {', '.join(self.q) or 'none'}>"


class PlacedBody(NamedTuple):
    """A body in a state."""

    name: str
    """Its name in the model."""
    position: Floats
    """Of the reference point, m, world, shape (3,)."""
    quaternion: Floats
    """Orientation (w, x, y, z), body to world, shape (4,); nan for a point mass."""
    velocity: Floats
    """Of the reference point, m/s, world, shape (3,)."""
    angular_velocity: Floats
    """rad/s, world axes, shape (3,); nan for a point mass."""


class PlacedPoint(NamedTuple):
    """A named point in a state. It has no axes: an orientation is that of its body."""

    name: str
    """Its name in the model."""
    position: Floats
    """m, world, shape (3,)."""
    velocity: Floats
    """m/s, world, shape (3,)."""


class PlacedJoint(_Coordinates):
    """A joint in a state; its coordinates and their rates (``angle``, rad, ``angle_rate``, rad/s) are attributes."""

    coordinates: Mapping[str, float]
    """By name: ``{"angle": 1.57, "angle_rate": 0.1}``."""

    def __init__(self, name: str, coordinates: Mapping[str, float]) -> None:
        self.name, self.coordinates = name, coordinates

    def __repr__(self) -> str:
        values = ", ".join(f"{name} = {value:.6g}" for name, value in self.coordinates.items())
        return f"<livens joint '{self.name}': {values or 'no coordinates'}>"


class MechanismState:
    """A mechanism in one state, and what follows from it; made by :meth:`Model.at`. Nothing is solved in time.

    Bodies, joints and points by name: ``state["tool"].position``, ``state["elbow"].angle``. Rows and columns of all forces and
    matrices are in the order of ``state.coordinates.v``: n rates, with forces in N along displacements and N m along
    angles.

    Example:
        >>> import livens as lv
        >>> m = lv.Model("pendulum", gravity=(0, 0, -9.81))
        >>> rod = m.add_body("rod", lv.point(mass=2), position=(0.5, 0, 0))
        >>> thread = m.add_body("thread", lv.box(1, 0.1, 0.1, mass=1), position=(0.5, 0, 0))
        >>> pivot = m.add_revolute("pivot", "world", thread, at=(0, 0, 0), axis=(0, 1, 0))
        >>> weld = m.add_spherical("end", thread, rod, at=(0.5, 0, 0))
        >>> state = m.at({"pivot.angle": "90 deg"}, {"pivot.angle": 2})
        >>> state["rod"].position.round(12).tolist(), state["rod"].velocity.round(12)[0].item()
        ([0.0, 0.0, -0.5], -1.0)
        >>> m.at().gravity_forces.round(3).tolist()   # torque that holds it level
        [-14.715]
    """

    def __init__(self, coordinates: Coordinates, state: Any, model: Model) -> None:
        self._state, self._model = state, model
        self.coordinates = coordinates
        """Its coordinates, in the order of all arrays."""

    @property
    def q(self) -> Floats:
        """Numbers of the coordinates, rad, m, or relative of quaternions, shape (len(coordinates.q),); angles with their
        full turns."""
        q: Floats = self._state.q
        return q

    @property
    def v(self) -> Floats:
        """Rates, rad/s, m/s, shape (n,)."""
        v: Floats = self._state.v
        return v

    @property
    def t(self) -> float:
        """The time at which loads are taken, s."""
        return float(self._state.t)

    @property
    def bodies(self) -> Parts[PlacedBody]:
        """All bodies by name."""
        names, rows = list(self._model.bodies), self._state.bodies
        return Parts("body", names, lambda i: PlacedBody(names[i], rows[i, :3], rows[i, 3:7], rows[i, 7:10], rows[i, 10:]))

    @property
    def joints(self) -> Parts[PlacedJoint]:
        """All joints that act, by name, without drives."""
        found = self._state.joints

        def made(i: int) -> PlacedJoint:
            values = {}
            for name, value, rate, _ in found[i][1]:
                values[name], values[f"{name}_rate"] = value, rate
            return PlacedJoint(found[i][0], values)
        return Parts("joint", [name for name, _ in found], made)

    @property
    def points(self) -> Parts[PlacedPoint]:
        """All named points by name."""
        found = self._state.points
        return Parts("point", [name for name, _, _ in found], lambda i: PlacedPoint(*found[i]))

    def __getitem__(self, name: str | Entry) -> Any:
        """The body, joint or point of that name."""
        name = name.name if isinstance(name, Entry) else name
        kinds: dict[str, Parts[Any]] = {"bodies": self.bodies, "joints": self.joints, "points": self.points}
        ways = [kind for kind, parts in kinds.items() if name in list(parts)]
        if len(ways) > 1:
            raise KeyError(f"'{name}' is one of several; write " + " or ".join(f".{kind}['{name}']" for kind in ways))
        if not ways:
            raise unknown_name("body, joint or point", name, [other for parts in kinds.values() for other in parts])
        return kinds[ways[0]][name]

    @property
    def kinetic(self) -> float:
        """Kinetic energy, J."""
        return float(self._state.kinetic)

    @property
    def potential(self) -> float:
        """Potential energy of weight (zero at the world's origin) and loads, J."""
        return float(self._state.potential)

    @property
    def energy(self) -> float:
        """Their sum, J."""
        return self.kinetic + self.potential

    @property
    def mass_matrix(self) -> Floats:
        """M, shape (n, n): symmetric and positive definite; the kinetic energy is v M v / 2."""
        matrix: Floats = self._state.mass_matrix
        return matrix

    @property
    def bias_forces(self) -> Floats:
        """h of M a + h = forces + load_forces, shape (n,): centrifugal and Coriolis forces, and weight."""
        forces: Floats = self._state.bias_forces
        return forces

    @property
    def gravity_forces(self) -> Floats:
        """Forces along the coordinates that hold the mechanism against its weight, shape (n,): the part of ``bias_forces``
        that is there at rest."""
        forces: Floats = self._state.gravity_forces
        return forces

    @property
    def load_forces(self) -> Floats:
        """What the loads of the model do along the coordinates, shape (n,)."""
        forces: Floats = self._state.load_forces
        return forces

    def inverse_dynamics(self, accelerations: Any = None) -> Floats:
        """Forces along the coordinates that give these accelerations, beside weight and the loads of the model.

        Args:
            accelerations: Shape (n,), or a mapping by the names in ``coordinates.v`` or of the coordinates; what is not
                named is zero. None: all zero.

        Returns:
            M a + bias_forces - load_forces, shape (n,).
        """
        forces: Floats = self._state.inverse_dynamics(_rates(self.coordinates, accelerations, "accelerations", False))
        return forces

    def accelerations(self, forces: Any = None) -> Floats:
        """Second derivatives of the coordinates under weight, the loads of the model and forces along the coordinates.

        Args:
            forces: Shape (n,), or a mapping as in :meth:`inverse_dynamics`. None: none.

        Raises:
            InputError: ``coordinates-singular`` where something that can move has no inertia.
        """
        found: Floats = self._state.accelerations(_rates(self.coordinates, forces, "forces", False))
        return found

    def jacobian(self, part: str | Body | Point, point: Vector | None = None) -> Floats:
        """Velocity of a point and angular velocity of its body by the rates, world axes, shape (6, n): linear first.

        Args:
            part: A body, or a point of the model by its name.
            point: In coordinates of the body, m. Default: its reference point.
        """
        body, place = _place(self._model, part, point)
        matrix: Floats = self._state.jacobian(body, place)
        return matrix

    def drift(self, part: str | Body | Point, point: Vector | None = None) -> Floats:
        """Accelerations of a point (m/s^2) and of the orientation of its body (rad/s^2) that rates alone cause, shape (6,):
        the time derivative of :meth:`jacobian` times ``v``."""
        body, place = _place(self._model, part, point)
        found: Floats = self._state.drift(body, place)
        return found

    def state_matrices(self) -> StateMatrices:
        """x' = A x + B u about this state, which need not be at rest or in equilibrium.

        x holds small changes of the coordinates and of their rates (of an orientation a rotation vector, rad, world axes), u
        forces along the coordinates. y is x itself. The accelerations of the state itself are ``accelerations()``.
        """
        A, B = self._state.slopes()
        small = [name[:-5] if name.endswith("_rate") else f"{name[:-2]}r{name[-1]}" for name in self.coordinates.v]
        n = len(self.v)
        return StateMatrices(A, B, np.eye(2 * n), np.zeros((2 * n, n)), tuple(small), (*small, *self.coordinates.v))

    @property
    def state(self) -> Condition:
        """All bodies as they are and move there: ``lv.solve(m, 5, start=m.at(q, v).state)``."""
        def keys(body: PlacedBody) -> dict[str, Any]:
            kept: dict[str, Any] = {"position": tuple(body.position.tolist()), "velocity": tuple(body.velocity.tolist())}
            if not np.isnan(body.quaternion[0]):
                kept.update(quaternion=tuple(body.quaternion.tolist()), angular_velocity=tuple(body.angular_velocity.tolist()))
            return kept
        turned = tuple({"joint": joint, "coordinate": word, "value": value}
                       for joint, values in self._state.joints for word, value, _, placed in values
                       if word.startswith("angle") and abs(value - placed) > 3)   # bodies do not tell turns
        return Condition("state", {name: keys(body) for name, body in self.bodies.items()}, turned)

    def __repr__(self) -> str:
        values = "".join(f"\n  {name:<24}{value:.6g}" for name, value in list(zip(self.coordinates.q, self.q))[:40])
        return f"<livens.MechanismState: {len(self.v)} rates>{values}"


def _number(value: Any, unit: str, path: str) -> float:
    if isinstance(value, str):
        return float(_core.quantity(value, unit))
    try:
        return float(value)
    except (TypeError, ValueError):
        raise fault("wrong-type", f"'{path}' is one number, not {value!r}", path) from None


def _vector(value: Any, n: int, path: str, unit: str = "") -> list[float]:
    """Numbers, each maybe a string with a unit."""
    flat = np.asarray(value, dtype=object).ravel()
    if len(flat) != n:
        raise fault("coordinate-value", f"'{path}' has {n} numbers, not {len(flat)}", path)
    return [_number(x, unit, path) for x in flat]


def _unit(name: str) -> str:
    return "rad" if name.rpartition(".")[2].startswith("angle") else "m"


def _quaternion(model: Model, name: str, value: Any) -> tuple[str, list[float]]:
    """("base.quaternion", numbers) of whatever tells an orientation."""
    body, _, word = name.rpartition(".")
    if is_rotation(value):
        return f"{body}.quaternion", list(as_key(value, "quaternion"))
    if word == "quaternion":
        doubt(value)
        return name, _vector(value, 4, name)
    if word == "rotation_vector":
        return f"{body}.quaternion", list(_core.quaternion(_vector(value, 3, name, "rad")))
    rows = np.reshape(_vector(value, 9, name), (3, 3))
    return f"{body}.quaternion", list(_core.quaternion([float(x) for x in (rows if word == "directors" else rows.T).ravel()]))


def numbers_by_name(model: Model, given: Mapping[str, Any]) -> dict[str, list[float]]:
    """What a mapping states, by the names of coordinates."""
    found: dict[str, list[float]] = {}

    def put(name: str, numbers: list[float]) -> None:
        if name in found:
            raise fault("coordinate-twice", f"coordinate '{name}' is given twice", f"q[{name}]", "give it once")
        found[name] = numbers
    parts: dict[str, dict[str, Any]] = {}   # base.qw .. base.qz
    for name, value in given.items():
        if not isinstance(name, str):
            raise fault("wrong-type", f"coordinates are named by strings, as 'elbow.angle', not by {name!r}", "q")
        body, _, word = name.rpartition(".")
        is_body = body in model.bodies
        if is_body and word == "position":
            for axis, number in zip("xyz", _vector(value, 3, name, "m")):
                put(f"{body}.{axis}", [number])
        elif is_body and (word in ORIENTATIONS or word == "rotation"):
            put(*_quaternion(model, name, value))
        elif is_body and word in ("qw", "qx", "qy", "qz"):
            parts.setdefault(body, {})[word] = _number(value, "", name)
        else:
            put(name, [_number(value, _unit(name), name)])
    for body, four in parts.items():
        if len(four) != 4:
            raise fault("coordinate-value", f"of the quaternion of '{body}' only {', '.join(four)} are given", f"q[{body}.qw]",
                        f"give all four, or '{body}.quaternion'")
        put(f"{body}.quaternion", [four[word] for word in ("qw", "qx", "qy", "qz")])
    return found


def _unknown(coordinates: list[str], name: str, word: str) -> InputError:
    return fault("coordinate-unknown", f"there is no coordinate '{name}'", f"{word}[{name}]",
                 _core.suggestion(name, coordinates) if coordinates else "the model has none")


def coordinates_of(scenario: Any, wanted: tuple[str, ...], t: float | None) -> Coordinates:
    """At an instant, with the wanted ones first; for :class:`Model`, which keeps them."""
    known = _core.coordinate_names(scenario)
    for name in wanted:
        if name not in known:
            raise _unknown(known, name, "q")
    return Coordinates(_core.coordinates(scenario, list(wanted), t))


def _rates(coordinates: Coordinates, given: Any, word: str, is_velocity: bool = True) -> list[float]:
    """In the order of the coordinates; a mapping names some."""
    if given is None:
        return [0.0] * len(coordinates.v)
    if not isinstance(given, Mapping):
        try:
            return [float(x) for x in np.asarray(given, dtype=float).ravel()]
        except (TypeError, ValueError):
            raise fault("wrong-type", f"{word}= are numbers or a mapping, not {given!r}", word) from None
    rates = dict.fromkeys(coordinates.v, 0.0)
    for name, value in given.items():
        body, _, kind = str(name).rpartition(".")
        if kind in _OTHER:
            names = [f"{body}.{axis}_rate" if kind == "velocity" else f"{body}.w{axis}" for axis in "xyz"]
            numbers = _vector(value, 3, name, "m/s" if kind == "velocity" else "rad/s")
        else:
            names = [name if name in rates else f"{name}_rate"]
            numbers = [_number(value, _unit(str(name).removesuffix("_rate")) + ("/s" if is_velocity else ""), name)]
        if names[0] not in rates:
            raise fault("coordinate-unknown", f"'{name}' is no coordinate of this state", f"{word}[{name}]",
                        _core.suggestion(str(name), list(coordinates.v)) if coordinates.v else "nothing moves")
        rates.update(zip(names, numbers))
    return list(rates.values())


def _place(model: Model, part: Any, point: Any) -> tuple[int, list[float]]:
    """Index of a body, and a point on it."""
    name = part.name if isinstance(part, Entry) else part
    bodies = list(model.bodies)
    if name in bodies:
        return bodies.index(name), [0.0] * 3 if point is None else _vector(point, 3, "point", "m")
    if name in model.points:
        if point is not None:
            raise fault("coordinate-value", f"'{name}' is a point itself: point= is of bodies", "point")
        at = model.points[name]
        if at.body in bodies:
            return bodies.index(at.body), _vector(at.position, 3, "point")
    raise unknown_name("body or point of a body", name, [*bodies, *model.points])


def state_of(model: Model, q: Any, v: Any, t: Any = None) -> MechanismState:
    """For :meth:`Model.at`."""
    instant = None if t is None else _number(t, "s", "t")
    if instant is not None and not np.isfinite(instant):
        raise fault("coordinate-value", "the time is not finite", "t")
    stated: dict[str, list[float]] = {}
    if isinstance(q, Mapping):
        stated = numbers_by_name(model, q)
    coordinates = model._coordinates(tuple(stated), instant)
    if q is None or isinstance(q, Mapping):
        numbers: list[float] = []
        placed = list(coordinates.placed)
        for name, _, n, _ in coordinates._found.entries:
            numbers += stated.get(name, placed[:n])
            del placed[:n]
    else:
        try:
            numbers = [float(x) for x in np.asarray(q, dtype=float).ravel()]
        except (TypeError, ValueError):
            raise fault("wrong-type", f"q= is numbers or a mapping, not {q!r}", "q") from None
    rates = _rates(coordinates, v, "v")
    return MechanismState(coordinates, coordinates._found.at(numbers, rates), model)


def reach(m: Model, tool: str | Body | Point, pose: Any, *, point: Vector | None = None, rotation: Any = None,
          start: Any = None) -> dict[str, Any]:
    """Inverse kinematics: coordinates that bring a body, or a point of it, to a place.

    The body is led there straight and in small steps, each the least change of the coordinates, so that the mechanism stays
    on its branch. Limits of joints are not regarded.

    Args:
        m: The model.
        tool: A body, or a point of the model by its name.
        pose: Position, m, world, shape (3,); or a pair (position, rotation).
        point: In coordinates of the body, m. Default: its reference point.
        rotation: Orientation of the body (also where a point is to get there): a Rotation of SciPy, a rotation matrix (3, 3), or a quaternion (w, x, y, z).
            Default: none is wanted.
        start: Where to start from, as ``q`` of :meth:`Model.at`. Default: as the bodies are placed.

    Returns:
        Coordinates by name, for :meth:`Model.at`; a motion starts there with ``lv.solve(m, 5, start=m.at(q).state)``.

    Raises:
        InputError: ``pose-unreachable`` with the distance that is left; and as :meth:`Model.at`.

    Example:
        >>> import livens as lv
        >>> m = lv.Model("arm")
        >>> upper = m.add_body("upper", lv.box(1, 0.1, 0.1, mass=1), position=(0.5, 0, 0))
        >>> lower = m.add_body("lower", lv.box(1, 0.1, 0.1, mass=1), position=(1, 0.5, 0), rotation_vector=(0, 0, "90 deg"))
        >>> shoulder = m.add_revolute("shoulder", "world", upper, at=(0, 0, 0), axis=(0, 0, 1))
        >>> elbow = m.add_revolute("elbow", upper, lower, at=(1, 0, 0), axis=(0, 0, 1))
        >>> q = lv.reach(m, "lower", (0.5, 1.2, 0), point=(0.5, 0, 0))
        >>> {name: round(value, 6) for name, value in q.items()}
        {'shoulder.angle': 0.312793, 'elbow.angle': 0.155627}
    """
    body, place = _place(m, tool, point)
    position, turned = _pose(pose, rotation)
    state = state_of(m, start, None)
    reached = state._state.reaching(body, place, position, turned)
    found: dict[str, Any] = {}
    numbers = reached.q.tolist()
    for name, _, n, _ in state.coordinates._found.entries:
        found[name] = numbers[0] if n == 1 else tuple(numbers[:n])
        del numbers[:n]
    return found


def _pose(pose: Any, rotation: Any) -> tuple[list[float], list[float] | None]:
    if isinstance(pose, (tuple, list)) and len(pose) == 2:
        if rotation is not None:
            raise fault("orientation-conflict", "the pose has a rotation, and rotation= is given", "rotation", "keep one")
        pose, rotation = pose
    position = _vector(pose, 3, "pose", "m")
    if not np.isfinite(position).all():
        raise fault("coordinate-value", "the position of the pose is not finite", "pose")
    if rotation is None:
        return position, None
    matrix = np.asarray(rotation.as_matrix() if is_rotation(rotation) else rotation, dtype=float)
    if matrix.shape == (4,):
        doubt(rotation)
        matrix = np.reshape(_core.directors([float(x) for x in matrix]), (3, 3)).T
    if matrix.shape != (3, 3) or not np.isfinite(matrix).all():
        raise fault("coordinate-value", "a rotation is a Rotation of SciPy, a matrix (3, 3) or a quaternion (w, x, y, z)", "rotation")
    if np.abs(matrix.T @ matrix - np.eye(3)).max() > 1e-6 or np.linalg.det(matrix) < 0:
        raise fault("directors-not-orthonormal", "the rotation matrix of the pose is no rotation", "rotation")
    return position, [float(x) for x in matrix.T.ravel()]
