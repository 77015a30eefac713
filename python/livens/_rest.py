# SPDX-License-Identifier: BSD-3-Clause
"""States of rest: where a mechanism rests, its small motions about that, and its state matrices."""
from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
import numpy.typing as npt

from ._entries import Entry, unknown_name
from ._parts import Floats, Parts
from ._values import Condition

if TYPE_CHECKING:
    from typing_extensions import TypeAlias

Complexes: TypeAlias = "npt.NDArray[np.complex128]"


class RestBody(NamedTuple):
    """A body in equilibrium."""

    name: str
    """Its name in the model."""
    position: Floats
    """Of the reference point, m, world, shape (3,)."""
    quaternion: Floats
    """Orientation (w, x, y, z), body to world, shape (4,); nan for a point mass."""


class _Coordinates:
    """A joint whose coordinates are attributes."""

    name: str
    """Its name in the model."""
    coordinates: Mapping[str, Any]
    """By name."""

    def __getattr__(self, name: str) -> Any:
        coordinates = self.__dict__.get("coordinates", {})
        if name in coordinates:
            return coordinates[name]
        have = ", ".join(coordinates) or "none"
        raise AttributeError(f"joint '{self.__dict__.get('name')}' has no '{name}'; its coordinates: {have}", name=name,
                             obj=self)

    def __dir__(self) -> list[str]:
        return [*super().__dir__(), *self.coordinates]


class RestJoint(_Coordinates):
    """A joint in equilibrium; its coordinates (``angle``, rad, ``displacement``, m) are attributes, too."""

    coordinates: Mapping[str, float]
    """By name: ``{"angle": 1.57}``."""
    force: Floats
    """Of the joint on its second body, N, world axes, shape (3,)."""
    torque: Floats
    """Of the joint on its second body about the joint point, N m, world axes, shape (3,)."""
    unique: bool
    """False if other joints of a closed loop could carry part of the reactions; the smallest ones are given."""
    effort: float
    """For a drive along a coordinate: its force or torque along it, N or N m; nan otherwise."""
    tension: float
    """For a rope, a rod over several points: how much it pulls, N; nan otherwise."""

    def __init__(self, name: str, coordinates: Mapping[str, float], force: Floats, torque: Floats, unique: bool,
                 effort: float, tension: float) -> None:
        self.name, self.coordinates, self.force, self.torque, self.unique = name, coordinates, force, torque, unique
        self.effort, self.tension = effort, tension

    def __repr__(self) -> str:
        values = "".join(f"{name} = {value:.6g}, " for name, value in self.coordinates.items())
        return f"<livens joint '{self.name}' at rest: {values}force = {self.force}, torque = {self.torque}>"


class _ByName:
    """What has bodies and joints by name."""

    _found: Mapping[str, Any]

    def __getitem__(self, name: str | Entry) -> Any:
        """The body or joint of that name."""
        name = name.name if isinstance(name, Entry) else name
        parts: list[Mapping[str, Any]] = [self.bodies, self.joints]   # type: ignore[attr-defined]
        holding = [part for part in parts if name in part]
        if len(holding) == 2:
            raise KeyError(f"'{name}' is a body and a joint; write .bodies['{name}'] or .joints['{name}']")
        if not holding:
            raise unknown_name("body or joint", name, [*parts[0], *parts[1]])
        return holding[0][name]

    def _columns(self) -> Iterator[tuple[str, dict[str, int]]]:
        """Of each joint its name, and the place of each coordinate among all."""
        n = 0
        for name, coordinates in self._found["joints"]:
            yield name, {word: n + i for i, word in enumerate(coordinates)}
            n += len(coordinates)


class Equilibrium(_ByName):
    """Static equilibrium, returned by :meth:`Model.find_equilibrium`. Bodies and joints by name: ``rest["rod"]``.

    Example:
        >>> import livens as lv
        >>> m = lv.Model("pendulum", gravity=(0, 0, -9.81))
        >>> rod = m.add_body("rod", lv.box(1, 0.05, 0.05, mass=2), position=(0.5, 0, 0))
        >>> pivot = m.add_revolute("pivot", "world", rod, at=(0, 0, 0), axis=(0, 1, 0))
        >>> rest = m.find_equilibrium()
        >>> rest.status, rest["rod"].position[2].round(9).item(), rest["pivot"].force[2].round(9).item()
        ('stable', -0.5, 19.62)
    """

    def __init__(self, found: Mapping[str, Any]) -> None:
        self._found = found

    @property
    def success(self) -> bool:
        """An equilibrium was found, stable or not."""
        return bool(self._found["success"])

    @property
    def status(self) -> str:
        """``stable``, ``neutral`` (no restoring force in some directions), ``unstable`` or ``no equilibrium``."""
        return str(self._found["status"])

    @property
    def message(self) -> str:
        """Reason why no equilibrium was found; empty otherwise."""
        return str(self._found["message"])

    @property
    def notes(self) -> list[str]:
        """Notes, such as redundant constraints."""
        return list(self._found["notes"])

    @property
    def t(self) -> float:
        """The time at which loads and drives are held, s: the initial time."""
        return float(self._found["t"])

    @property
    def degrees_of_freedom(self) -> int:
        """Number of degrees of freedom."""
        return int(self._found["degrees_of_freedom"])

    @property
    def n_unstable(self) -> int:
        """Number of directions in which small motions grow."""
        return int(self._found["n_unstable"])

    @property
    def n_neutral(self) -> int:
        """Number of directions without a restoring force."""
        return int(self._found["n_neutral"])

    @property
    def nit(self) -> int:
        """Number of steps of the search."""
        return int(self._found["iterations"])

    @property
    def residual(self) -> float:
        """Largest unbalanced force on a body, relative to the largest forces on one."""
        return float(self._found["residual"])

    @property
    def states(self) -> dict[str, float]:
        """States of controllers by ``"controller.state"``."""
        return dict(self._found["states"])

    @property
    def bodies(self) -> Parts[RestBody]:
        """All bodies by name."""
        names = self._found["bodies"]
        return Parts("body", names, lambda i: RestBody(names[i], self._found["position"][i], self._found["quaternion"][i]))

    @property
    def joints(self) -> Parts[RestJoint]:
        """All joints by name."""
        columns = list(self._columns())

        def made(i: int) -> RestJoint:
            values = {word: float(self._found["coordinate"][at]) for word, at in columns[i][1].items()}
            return RestJoint(columns[i][0], values, self._found["force"][i], self._found["torque"][i],
                             bool(self._found["unique"][i]), float(self._found["effort"][i]),
                             float(self._found["tension"][i]))
        return Parts("joint", [name for name, _ in columns], made)

    @property
    def state(self) -> Condition:
        """All bodies at rest there, and states of controllers: ``lv.solve(m, 5, start=rest.state)``."""
        def keys(body: RestBody) -> dict[str, Any]:
            kept: dict[str, Any] = {"position": tuple(body.position.tolist()), "velocity": (0, 0, 0)}
            if not np.isnan(body.quaternion[0]):
                kept.update(quaternion=tuple(body.quaternion.tolist()), angular_velocity=(0, 0, 0))
            return kept
        turned = tuple({"joint": joint, "coordinate": word, "value": value}
                       for joint, word, value in self._found["turned"])
        return Condition("state", {name: keys(body) for name, body in self.bodies.items()}, turned, self.states)

    def __repr__(self) -> str:
        rows = [f"\n  {name:<18}at {np.array2string(body.position, precision=6, suppress_small=True)} m"
                for name, body in list(self.bodies.items())[:20]]
        why = f": {self.message}" if self.message else ""
        return f"<livens.Equilibrium: {self.status}{why}>{''.join(rows)}"


class EquilibriumError(RuntimeError):
    """Linearisation of a mechanism that has no equilibrium.

    Example:
        >>> import livens as lv
        >>> m = lv.Model("fall", gravity=(0, 0, -9.81))
        >>> ball = m.add_body("ball", lv.point(mass=1))
        >>> try:
        ...     m.vibration_modes()
        ... except lv.EquilibriumError as e:
        ...     print(e.partial.status)
        no equilibrium
    """

    partial: Equilibrium
    """Where the search ended."""

    def __init__(self, message: str, partial: Equilibrium) -> None:
        super().__init__(message)
        self.partial = partial

    def __reduce__(self) -> tuple[Any, ...]:
        return (type(self), (str(self), self.partial))


class ModeBody(NamedTuple):
    """Motion of a body in each mode; complex, since components may differ in phase."""

    name: str
    """Its name in the model."""
    displacement: Complexes
    """Of the reference point, m, world axes, shape (n, 3)."""
    rotation: Complexes
    """Rotation vector, rad, world axes, shape (n, 3); 0 for a point mass."""


class ModeJoint(_Coordinates):
    """Motion of a joint in each mode; its coordinates are attributes, complex, shape (n,)."""

    coordinates: Mapping[str, Complexes]
    """By name: amplitudes, rad or m, shape (n,)."""

    def __init__(self, name: str, coordinates: Mapping[str, Complexes]) -> None:
        self.name, self.coordinates = name, coordinates

    def __repr__(self) -> str:
        return f"<livens joint '{self.name}' in modes: {', '.join(self.coordinates) or 'no coordinates'}>"


def _complex(pairs: Floats) -> Complexes:
    return np.ascontiguousarray(pairs).view(np.complex128)[..., 0]


class Modes(_ByName):
    """Small motions e^(s t) about an equilibrium, by ascending ``|s|``; see :meth:`Model.vibration_modes`.

    Of a conjugate pair, only the root with the positive imaginary part is listed. Shapes are scaled so that the
    largest rotation of a body, or displacement divided by the model length, is 1, real and positive. Bodies and
    joints by name: ``modes["rod"].displacement[0]`` belongs to the slowest mode.
    """

    def __init__(self, found: Mapping[str, Any]) -> None:
        self._found = found

    @property
    def s(self) -> Complexes:
        """1/s, complex, shape (n,)."""
        return _complex(self._found["s"])

    @property
    def frequency(self) -> Floats:
        """``|s|``, rad/s, shape (n,): without damping the frequency itself."""
        return np.asarray(np.abs(self.s))

    @property
    def hertz(self) -> Floats:
        """``frequency`` over 2 pi, 1/s, shape (n,)."""
        return np.asarray(self.frequency / (2 * np.pi))

    @property
    def damping_ratio(self) -> Floats:
        """``-Re s`` over ``|s|``, relative, shape (n,): 0 undamped, 1 for decay without vibration, negative if it
        grows."""
        size = self.frequency
        return np.asarray(np.where(size > 0, -self.s.real / np.where(size > 0, size, 1), 0) + 0.0)

    @property
    def bodies(self) -> Parts[ModeBody]:
        """All bodies by name."""
        names = self._found["bodies"]
        moved, turned = _complex(self._found["displacement"]), _complex(self._found["rotation"])
        return Parts("body", names, lambda i: ModeBody(names[i], moved[:, i], turned[:, i]))

    @property
    def joints(self) -> Parts[ModeJoint]:
        """All joints by name."""
        columns, values = list(self._columns()), _complex(self._found["coordinate"])
        return Parts("joint", [name for name, _ in columns],
                     lambda i: ModeJoint(columns[i][0], {word: values[:, at] for word, at in columns[i][1].items()}))

    def __len__(self) -> int:
        return len(self.s)

    def __repr__(self) -> str:
        rows = [f"\n  {i}: {f:.6g} rad/s ({h:.6g} Hz)" + (f", damping ratio {d:.4g}" if d else "")
                for i, (f, h, d) in enumerate(zip(self.frequency, self.hertz, self.damping_ratio))][:40]
        return f"<livens.Modes: {len(self)}>{''.join(rows)}"


class StateMatrices(NamedTuple):
    """x' = A x + B u, y = C x + D u about an equilibrium; x holds the n amplitudes of small motions and their
    rates; of a :class:`MechanismState` small changes of its coordinates and their rates.

    ``scipy.signal.StateSpace(*matrices[:4])`` and ``control.ss(*matrices[:4])`` accept them.
    """

    A: Floats
    """1/s and 1/s^2, shape (2 n, 2 n)."""
    B: Floats
    """By inputs, N or N m, shape (2 n, inputs)."""
    C: Floats
    """By outputs, shape (outputs, 2 n)."""
    D: Floats
    """Shape (outputs, inputs)."""
    inputs: tuple[str, ...]
    """Their names."""
    outputs: tuple[str, ...]
    """Their names."""


class Linearisation:
    """M q'' + C q' + K q = forces along q, about an equilibrium; returned by :meth:`Model.linearise`.

    q are the amplitudes of the n small motions that all joints allow, orthonormal in the mass metric (M = 1
    unless an inertia is singular). Drives and loads that depend on time are held at their current values.
    """

    def __init__(self, linear: Any) -> None:
        self._linear = linear
        self._stability: dict[str, Any] = linear.stability

    @property
    def n(self) -> int:
        """Degrees of freedom."""
        return int(self._linear.n)

    @property
    def status(self) -> str:
        """``stable``, ``neutral`` or ``unstable``."""
        return str(self._stability["status"])

    @property
    def n_unstable(self) -> int:
        """Number of directions in which small motions grow."""
        return int(self._stability["n_unstable"])

    @property
    def n_neutral(self) -> int:
        """Number of directions without a restoring force."""
        return int(self._stability["n_neutral"])

    @property
    def M(self) -> Floats:
        """Masses, relative to the mass metric, shape (n, n)."""
        mass: Floats = self._linear.mass
        return mass

    @property
    def C(self) -> Floats:
        """Damping, in the mass metric (1/s), shape (n, n)."""
        damping: Floats = self._linear.damping
        return damping

    @property
    def K(self) -> Floats:
        """Stiffness, in the mass metric (1/s^2), shape (n, n); symmetric unless forces turn with bodies."""
        stiffness: Floats = self._linear.stiffness
        return stiffness

    def vibration_modes(self) -> Modes:
        """All n modes; a damped system has more if pairs of real s replace vibrations."""
        return Modes(self._linear.modes())

    def state_matrices(self, inputs: Sequence[str], outputs: Sequence[str]) -> StateMatrices:
        """State matrices for controller design.

        Args:
            inputs: ``"JOINT.angle"`` and ``"JOINT.displacement"``, a generalised force along the coordinate
                (N m or N), and ``"BODY.x"``, ``"BODY.y"``, ``"BODY.z"``, a force at the reference point (N).
            outputs: the same names: the coordinate (rad or m), the position of the reference point (m), as
                deviations from the equilibrium; append ``_rate`` for their rates.

        Raises:
            InputError: ``no-such-port``.
        """
        for names in (inputs, outputs):
            if isinstance(names, str):
                raise TypeError(f"inputs and outputs are lists of names: ['{names}']")
        A, B, C, D = self._linear.matrices(list(inputs), list(outputs))
        return StateMatrices(A, B, C, D, tuple(inputs), tuple(outputs))

    def __repr__(self) -> str:
        return f"<livens.Linearisation: {self.status}, {self.n} degree{'' if self.n == 1 else 's'} of freedom>"
