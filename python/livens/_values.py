# SPDX-License-Identifier: BSD-3-Clause
"""Values that models and solve() take: shapes, methods, tables over time, conditions at the ends of time."""
from __future__ import annotations

import functools
import inspect
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any, Protocol, TypeVar, Union

import numpy as np
import numpy.typing as npt

if TYPE_CHECKING:
    from typing_extensions import TypeAlias

_F = TypeVar("_F", bound=Callable[..., Any])


class Quantity(Protocol):
    """Something with a unit that can be converted, as pint has it."""

    def to_base_units(self) -> Any:
        """In base units."""
        ...


Number: TypeAlias = Union[float, str, Quantity, "np.floating[Any]", "np.integer[Any]"]
"""A number in SI units, a string with a unit (``"30 deg"``), or a quantity of pint."""
Vector: TypeAlias = Union[Sequence[Number], npt.NDArray[Any], Quantity]
"""Some numbers."""
Matrix: TypeAlias = Union[Sequence[Vector], npt.NDArray[Any], Quantity]
"""Rows of three numbers."""


def _repr(name: str, keys: Mapping[str, Any]) -> str:
    return f"{name}({', '.join(f'{key}={value!r}' for key, value in keys.items())})"


@dataclass(frozen=True, repr=False)
class Shape:
    """A solid of constant density, for mass and inertia; made by :func:`box`, :func:`sphere`, ..

    Its ``density`` or ``mass`` is passed on to the body.
    """

    keys: Mapping[str, Any] = field(default_factory=dict)
    """The keys of ``[[body]]`` that it sets."""

    def __repr__(self) -> str:
        return _repr("Shape", self.keys)


@dataclass(frozen=True, repr=False)
class Method:
    """An integration method: :class:`Lobatto`, :class:`Radau`, :class:`Mixed`, .."""

    family: str = ""
    """The word of the scenario."""
    keys: Mapping[str, Any] = field(default_factory=dict)
    """Its keys of ``[method]``."""

    def __repr__(self) -> str:
        return _repr(type(self).__name__, self.keys)

    def _set(self, family: str, keys: Mapping[str, Any]) -> None:
        object.__setattr__(self, "family", family)
        object.__setattr__(self, "keys", {key: value for key, value in keys.items() if value is not None})

    def __reduce__(self) -> tuple[Any, ...]:
        return (_restored, (type(self), self.family, dict(self.keys)))


def _restored(kind: type[Method], family: str, keys: Mapping[str, Any]) -> Method:
    method = object.__new__(kind)
    method._set(family, keys)
    return method


@dataclass(frozen=True)
class Condition:
    """What is prescribed at one end of the motion; made by :func:`positions`, :func:`momenta`, :func:`state`."""

    given: str
    """The word of the scenario."""
    bodies: Mapping[str, Mapping[str, Any]] = field(default_factory=dict)
    """Keys of each body there."""
    coordinates: Sequence[Mapping[str, Any]] | None = None
    """Initial values and rates of joint coordinates, instead of those of the model: full turns of joints do not
    follow from the positions of bodies. None: those of the model are applied."""
    states: Mapping[str, float] = field(default_factory=dict)
    """Of controllers, by ``"controller.state"``. What is not there starts as the model has it."""


def positions(bodies: Mapping[str, Mapping[str, Any]] | None = None) -> Condition:
    """Prescribes positions at one end of the motion: ``solve(m, 1, start="positions", end=lv.positions({...}))``.

    Args:
        bodies: For each body by name a table with ``position`` (m, world), one of ``quaternion``,
            ``rotation_vector``, ``directors``, and velocities, which serve as a first guess. At the start they
            replace the values of the bodies.

    Example:
        >>> import livens as lv
        >>> m = lv.Model("throw", gravity=(0, 0, -9.81))
        >>> ball = m.add_body("ball", lv.point(mass=1))
        >>> sol = lv.solve(m, 1, elements=4, start="positions", end=lv.positions({"ball": {"position": (2, 0, 0)}}))
        >>> sol["ball"].velocity[0][2].round(3).item()
        4.905
    """
    return Condition("positions", dict(bodies or {}))


def momenta(bodies: Mapping[str, Mapping[str, Any]] | None = None) -> Condition:
    """Prescribes momenta at one end of the motion, those of the given positions and velocities; see
    :func:`positions`."""
    return Condition("momenta", dict(bodies or {}))


def state(bodies: Mapping[str, Mapping[str, Any]] | None = None) -> Condition:
    """Prescribes positions and velocities at one end of the motion; see :func:`positions`."""
    return Condition("state", dict(bodies or {}))


def unknown(guess: Number, *, low: Number | None = None, high: Number | None = None) -> Any:
    """A number that is found with the motion, in place of a number of the model, a parameter or the end of time.

    Between conditions at both ends of time: :func:`solve` takes one more for each unknown number. What was found
    is in ``sol.unknowns``, and how far it may be off in ``sol.unknown_errors``.

    Args:
        guess: Where to begin, in the unit of the key, or a string with a unit.
        low: Smallest value.
        high: Largest value.

    Example:
        >>> import livens as lv
        >>> m = lv.Model("throw", gravity=(0, 0, -9.81))
        >>> ball = m.add_body("ball", lv.point(mass=1))
        >>> sol = lv.solve(m, lv.unknown(0.5, low=0.1), elements=4, method=lv.Lobatto(3),
        ...                start={"ball.position": (0, 0, 2), "ball.vx": 3},
        ...                end={"ball.x": 3, "ball.y": 0, "ball.z": 0})
        >>> round(sol.unknowns["time.end"], 9)
        1.0
    """
    bounds = {name: value for name, value in (("low", low), ("high", high)) if value is not None}
    return {"unknown": guess, **bounds}


def table(times: Vector, values: Vector | Matrix, interpolation: str | None = None) -> dict[str, Any]:
    """Values over time, for ``table=`` of loads and drives.

    Args:
        times: s, ascending, shape (n,).
        values: One per time, shape (n,), or (n, 3) for forces and torques; in the unit of the load.
        interpolation: ``"linear"`` (default) or ``"spline"``; drives always use splines and do not
            accept this argument.

    Example:
        >>> import livens as lv
        >>> lv.table([0, 1, 2], [0, 5, 0], "spline")["interpolation"]
        'spline'
    """
    made: dict[str, Any] = {"times": times, "values": values}
    if interpolation is not None:
        made["interpolation"] = interpolation
    return made


_LIKELY = ("at", "axis", "axes", "pitch", "ratio", "points", "point", "value", "stiffness", "rate", "expression")


def _of_positional(method: str, front: list[str], keywords: list[str], given: Sequence[Any]) -> str:
    """What to write where more stands in front than a method takes."""
    likely = [name for name in _LIKELY if name in keywords] or keywords
    shown = ", ".join(f"{name}={value!r}" for name, value in zip(likely, given))
    return f"{method}({', '.join(front)}, ..) takes all else by name" + (f": {shown}" if shown else "")


def three(name: str, x: Any, y: Any, z: Any) -> tuple[Any, Any, Any]:
    """Three numbers, or one sequence of three."""
    if y is None and z is None and not isinstance(x, str) and hasattr(x, "__len__") and len(x) == 3:
        return (x[0], x[1], x[2])
    if y is None or z is None:
        raise TypeError(f"{name}() takes three lengths: {name}(x, y, z)")
    return (x, y, z)


def visual(shape: Shape, *, position: Vector | None = None, directors: Matrix | None = None,
           quaternion: Vector | None = None, rotation_vector: Vector | None = None,
           color: str | Vector | None = None, opacity: float | None = None) -> dict[str, Any]:
    """A shape that is only drawn, for ``visual=`` of a body or of :attr:`Model.world`.

    Args:
        shape: Without ``mass`` and ``density``.
        position: Position of its origin in body or world coordinates, m, shape (3,).
        directors: Its axes, one per row, shape (3, 3).
        quaternion: (w, x, y, z) instead.
        rotation_vector: Axis times angle, rad, instead of the two above.
        color: A CSS colour name, ``"#rrggbb"``, or red, green and blue from 0 to 1. Default: that of the body.
        opacity: 1 is opaque.

    Example:
        >>> import livens as lv
        >>> m = lv.Model("arm")
        >>> arm = m.add_body("arm", mass=3, inertia=(0.001, 0.3, 0.3), color="steelblue", visual=[
        ...     lv.box(1, 0.05, 0.05), lv.visual(lv.sphere("6 cm"), position=(0.5, 0, 0), color="#c33")])
        >>> arm.visual[1].color
        '#c33'
        >>> m.world.visual = lv.box(3, 2, 0.02)
    """
    keys = {"position": position, "directors": directors, "quaternion": quaternion, "rotation_vector": rotation_vector,
            "color": color, "opacity": opacity}
    given = {key: value for key, value in keys.items() if value is not None}
    return {**shape.keys["shape"], **{key: shape.keys[key] for key in ("mass", "density") if key in shape.keys}, **given}


def open_keys(kind: str, word: str) -> Callable[[_F], _F]:
    """Lets a generated method hand keywords that it does not know to the reader, who knows what was meant."""
    def decorate(method: _F) -> _F:
        signature = inspect.signature(method)
        known = frozenset(signature.parameters)
        front = [name for name, p in signature.parameters.items() if p.kind is p.POSITIONAL_OR_KEYWORD and name != "self"]
        n_front = len(front)
        keyword_only = [name for name, p in signature.parameters.items() if p.kind is p.KEYWORD_ONLY]

        @functools.wraps(method)
        def call(self: Any, *args: Any, **keywords: Any) -> Any:
            if len(args) > n_front:
                raise TypeError(_of_positional(method.__name__, front, keyword_only, args[n_front:]))
            unknown = {name: value for name, value in keywords.items() if name not in known}
            if not unknown:
                return method(self, *args, **keywords)
            bound = signature.bind_partial(self, *args, **{k: v for k, v in keywords.items() if k in known})
            content = dict(list(bound.arguments.items())[1:])
            chosen = content.pop("type", word)
            return self._add(kind, chosen, {**content, **unknown})
        return call   # type: ignore[return-value]
    return decorate
