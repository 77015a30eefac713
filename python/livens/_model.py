# SPDX-License-Identifier: BSD-3-Clause
"""The model: a scenario's tree that is edited by name."""
from __future__ import annotations

import errno
import os
import warnings
from collections.abc import Callable, Mapping, Sequence
from typing import TYPE_CHECKING, Any, Literal

import numpy as np

from . import _core
from ._editing import Tree
from ._entries import Entry, Names, Section, default_name, unknown_name
from ._errors import Diagnostic, SlowWarning, SolveWarning, fault, file_name, make_way, stack_level, user_place
from ._generated import Body, Controller, Drive, Event, Joint, Load, Point, Sensor, Stop
from ._included import Added, as_part, files_below, files_of
from ._meshes import MeshFile, named_meshes
from ._other_names import of_model
from ._parameters import Parameters
from ._places import some_time
from ._rest import Equilibrium, EquilibriumError, Linearisation, Modes
from ._state import Coordinates, MechanismState, coordinates_of, state_of
from ._tree import KINDS, Table, frozen, toml

if TYPE_CHECKING:
    from ._values import Matrix, Vector


def _put_beside(name: str, path: str, source: str) -> None:
    """A file that a scenario names, below that scenario's own folder."""
    target = os.path.join(os.path.dirname(name), path)
    if os.path.exists(target) and os.path.samefile(target, source):
        return
    with open(source, "rb") as stream:
        content = stream.read()
    if _holds(target, content):
        return
    if os.path.exists(target):
        raise FileExistsError(errno.EEXIST, "a file that the model names would replace one of other content", target)
    os.makedirs(os.path.dirname(target) or ".", exist_ok=True)
    _core.write_file(target, content)


def _holds(name: str, content: bytes) -> bool:
    """Whether a file is this already."""
    if not os.path.isfile(name):
        return False
    with open(name, "rb") as stream:
        return stream.read(len(content) + 1) == content


class Model(Tree):
    """Bodies, joints, drives, loads and sensors: the tree of a scenario file, edited by name.

    Args:
        title: A title; copied to the result.
        gravity: Gravitational acceleration, m/s^2, world axes, shape (3,). Default: none.

    Errors are raised by the call that contains them: :class:`InputError` with the line of this call. Models can be
    compared, copied, pickled and hashed (by content, so do not edit a model that is a key of a dict).

    Example:
        >>> import livens as lv
        >>> m = lv.Model("pendulum", gravity=(0, 0, -9.81))
        >>> rod = m.add_body("rod", lv.box(1, "5 cm", "5 cm", density=7850), position=(0.5, 0, 0))
        >>> pivot = m.add_revolute("pivot", "world", rod, at=(0, 0, 0), axis=(0, 1, 0))
        >>> sol = lv.solve(m, 2)
        >>> sol.success
        True
    """

    def __init__(self, title: str = "", *, gravity: Any = None) -> None:
        self._root = Table({"format": 1}, user_place())
        self._file, self._home = "", ""
        self._text = None
        self._imported = ()
        self._functions = {}
        self._forget()
        if title:
            self.title = title
        if gravity is not None:
            self.gravity = gravity

    if not TYPE_CHECKING:   # who checks types knows what there is

        def __setattr__(self, name: str, value: Any) -> None:
            if not name.startswith("_") and not hasattr(type(self), name):
                known = ["title", "gravity", "parameters"]
                help = _core.other_key("top of the file", "", name) or _core.suggestion(name, known)
                raise AttributeError(f"a model has no '{name}' to set; {help}", name=name, obj=self)
            super().__setattr__(name, value)

        def __getattr__(self, name: str) -> Any:
            if name.startswith("_"):
                raise AttributeError(f"'Model' object has no attribute '{name}'", name=name, obj=self)
            if hasattr(type(self), name):   # a property of ours that failed: its own error
                return object.__getattribute__(self, name)
            raise of_model(self, name)

    # What is there.

    @property
    def title(self) -> str:
        """Title; copied to the result."""
        return str(self._root.get("title", ""))

    @title.setter
    def title(self, value: str) -> None:
        self._edit_root("title", value)

    @property
    def gravity(self) -> np.ndarray[Any, np.dtype[np.float64]]:
        """Gravitational acceleration, m/s^2, world axes, shape (3,)."""
        gravity: np.ndarray[Any, np.dtype[np.float64]] = self._root_section().__getattr__("gravity")
        return gravity

    @gravity.setter
    def gravity(self, value: Any) -> None:
        self._edit_root("gravity", value)

    @property
    def parameters(self) -> Parameters:
        """Names for numbers, as in ``m.parameters = {"L": "400 mm"}``: ``"L/2"`` is a number of the model then."""
        return Parameters(self)

    @parameters.setter
    def parameters(self, values: Mapping[str, Any]) -> None:
        Parameters(self)._replace(values)

    @property
    def bodies(self) -> Names[Body]:
        """All bodies by name."""
        return Names(self, "body", Body)

    @property
    def points(self) -> Names[Point]:
        """All points by name."""
        return Names(self, "point", Point)

    @property
    def joints(self) -> Names[Joint]:
        """All joints by name."""
        return Names(self, "joint", Joint)

    @property
    def stops(self) -> Names[Stop]:
        """All stops by name: limits that nothing passes."""
        return Names(self, "stop", Stop)

    @property
    def drives(self) -> Names[Drive]:
        """All drives by name."""
        return Names(self, "drive", Drive)

    @property
    def loads(self) -> Names[Load]:
        """All loads by name, except Python functions."""
        return Names(self, "load", Load)

    @property
    def sensors(self) -> Names[Sensor]:
        """All sensors by name."""
        return Names(self, "sensor", Sensor)

    @property
    def controllers(self) -> Names[Controller]:
        """All controllers by name: states with rates of their own."""
        return Names(self, "controller", Controller)

    @property
    def events(self) -> Names[Event]:
        """All events by name; conditions in ``from`` and ``until`` are those of their joints and loads."""
        return Names(self, "event", Event)

    @property
    def world(self) -> Section:
        """The table ``[world]``: ``m.world.visual = lv.box(4, 2, 0.1)`` draws a floor."""
        return self._section("world")

    @property
    def time(self) -> Section:
        """The table ``[time]``: ``m.time.end = 5``. Arguments of :func:`livens.solve` take precedence."""
        return self._section("time")

    @property
    def method(self) -> Section:
        """The table ``[method]``."""
        return self._section("method")

    @property
    def start(self) -> Section:
        """The table ``[start]``: ``m.start.initial = "project"``."""
        return self._section("start")

    @property
    def end(self) -> Section:
        """The table ``[end]``."""
        return self._section("end")

    @property
    def imported(self) -> list[Diagnostic]:
        """What :func:`from_urdf` or :func:`from_mjcf` did not keep as it was, once for each kind; empty for other models.

        Codes: ``import-lost`` is not kept, ``import-mended`` was changed so that it can be solved, ``import-merged`` is
        kept as part of something else. Not carried along in files.
        """
        return list(self._imported)

    def __getitem__(self, name: str) -> Any:
        """The body, point, joint, drive, load or sensor of that name."""
        found = self._named(name)
        if len(found) == 1:
            return self._handle(*found[0])
        if found:
            kinds = " and a ".join(kind for kind, _ in found)
            plural = {"body": "bodies"}.get(found[0][0], found[0][0] + "s")
            raise unknown_name("part", name, []) if not isinstance(name, str) else KeyError(
                f"'{name}' is a {kinds}; write m.{plural}['{name}']")
        known = [default_name(kind, table) for kind in KINDS for table in self._root.get(kind, [])]
        raise unknown_name("part of the model", name, known)

    def __contains__(self, name: object) -> bool:
        return isinstance(name, str) and bool(self._named(name))

    def remove(self, part: str | Entry) -> None:
        """Removes a body, point, joint, drive, load or sensor. Parts that still refer to it are an error in :func:`solve`.

        Raises:
            KeyError: no part has this name.
        """
        if isinstance(part, str) and part in self._functions:
            body, _ = self._functions.pop(part)
            if body is not None:
                return self._forget()
        entry = self[part] if isinstance(part, str) else part
        entries = self._root.get(entry._key, [])
        left = [table for table in entries if table is not entry._table]
        if len(left) == len(entries):
            raise unknown_name(entry._key, entry.name, [])
        self._root[entry._key] = left
        self._touch()

    # As a value.

    def copy(self) -> Model:
        """An independent copy of the model."""
        other = object.__new__(type(self))
        other._root = self._root.copy()
        other._file, other._home, other._text = self._file, self._home, self._text
        other._imported = self._imported
        other._functions = dict(self._functions)
        other._forget()
        other._built, other._warned = dict(self._built), self._warned   # what is built is never changed
        return other

    __copy__ = copy

    def __deepcopy__(self, memo: object) -> Model:
        return self.copy()

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, Model):
            return NotImplemented
        return dict.__eq__(self._root, other._root) and self._functions == other._functions

    def __hash__(self) -> int:
        return hash(frozen(self._root))

    def __getstate__(self) -> dict[str, Any]:
        self._refuse_functions("pickled")
        return {"root": self._root, "file": self._file, "home": self._home, "text": self._text,
                "imported": self._imported}

    def __setstate__(self, state: dict[str, Any]) -> None:
        self._root, self._file, self._text = state["root"], state["file"], state["text"]
        self._home, self._imported = state["home"], state["imported"]
        self._functions = {}
        self._forget()

    def to_toml(self, file: str | os.PathLike[str] | None = None, *, force: bool = False) -> str:
        """The model as the text of a scenario file, also readable by the program; written to ``file`` if given.

        A model that was loaded and not edited returns the original text, including comments; otherwise the text is
        generated. ``load(text=m.to_toml()) == m``.

        Args:
            file: Its name. Meshes and included files that are in another folder are copied to where the text has them:
                below the folder of ``file``, by the same paths.
            force: Whether to replace an existing file with other content; never a mesh of the model.

        Raises:
            InputError: ``python-function`` if the model has Python functions as loads.
            OSError: the file cannot be written; ``FileExistsError`` if another file would be lost.
        """
        self._refuse_functions("written to a file")
        text = self._text if self._text is not None else toml(self._root)
        if file is not None:
            name = file_name(file)
            beside = {str(mesh): mesh.path for mesh in named_meshes(self._root)} | files_below(self._root, self._folder)
            is_there = _holds(name, text.encode())
            if not is_there:
                make_way(name, "scenario", [os.path.join(self._folder, path) for path in files_of(self._root)]
                         + list(beside.values()), force)
            for path, source in beside.items():
                _put_beside(name, path, source)
            if not is_there:
                _core.write_file(name, text.encode())
        return text

    def __repr__(self) -> str:
        counts = ", ".join(f"{len(self._root.get(kind, []))} "
                           f"{kind if len(self._root.get(kind, [])) == 1 else {'body': 'bodies'}.get(kind, kind + 's')}"
                           for kind in KINDS if self._root.get(kind) or kind in ("body", "joint"))
        title = f" '{self.title}'" if self.title else ""
        return f"<livens.Model{title}: {counts}>"

    def _repr_html_(self) -> str:
        from html import escape
        rows = "".join(
            f"<tr><td>{kind}</td><td>{escape(default_name(kind, t))}</td><td>{escape(str(t.get('type', '')))}</td></tr>"
            for kind in KINDS for t in self._root.get(kind, [])[:200])
        return (f"<b>{escape(self.title or 'model')}</b><table><tr><th>part</th><th>name</th><th>type</th></tr>"
                f"{rows}</table>")

    # Models inside.

    def add(self, other: Model, prefix: str = "", *, position: Vector | None = None, rotation: Any = None,
            directors: Matrix | None = None, quaternion: Vector | None = None,
            rotation_vector: Vector | None = None, parameters: Mapping[str, Any] | None = None) -> Added:
        """Adds all of another model, as it is now: bodies, points, joints, drives, loads and sensors.

        It is displaced and rotated as a whole. Whatever it states in the world is displaced with it: points and axes,
        forces in world axes, prescribed paths, and the axes of its sensors. Its ``title``, ``time`` and ``method`` are
        not used; its gravity equals that of this model or is not stated: gravity is not rotated.

        Args:
            other: The model that is added; later changes of it have no effect here.
            prefix: Prefix of all names: with ``"left "``, ``knee`` becomes ``left knee``.
            position: Position of its origin, m.
            rotation: A Rotation of SciPy or a matrix; or ``directors``, ``quaternion``, ``rotation_vector``, one of
                them, as bodies have it.
            directors: Likewise.
            quaternion: Likewise, (w, x, y, z).
            rotation_vector: Likewise, rad.
            parameters: Values for its parameters: numbers, or expressions of parameters of this model.

        Returns:
            Its names here, by those that it has itself.

        Raises:
            InputError: ``name-duplicate``, naming the part; ``gravity-differs``; what is wrong with it.

        Example:
            >>> import livens as lv
            >>> leg = lv.Model("leg")
            >>> shin = leg.add_body("shin", lv.box(0.05, 0.05, 0.4, mass=1), position=(0, 0, -0.2))
            >>> hip = leg.add_revolute("hip", "world", shin, at=(0, 0, 0), axis=(0, 1, 0))
            >>> m = lv.Model("two legs", gravity=(0, 0, -9.81))
            >>> left = m.add(leg, "left ", position=(0, 0.1, 0))
            >>> right = m.add(leg, "right ", position=(0, -0.1, 0), rotation_vector=(0, "20 deg", 0))
            >>> bar = m.add_rod("bar", left["shin"], right["shin"])
            >>> sol = lv.solve(m, 1)
            >>> sol["right shin"].position[0].round(4).tolist()
            [-0.0684, -0.1, -0.1879]
        """
        placement = {"position": position, "rotation": rotation, "directors": directors, "quaternion": quaternion,
                     "rotation_vector": rotation_vector, "parameters": parameters}
        table, names = as_part(self, other, prefix, placement)
        self._include(table)
        return names

    # Python functions.

    def add_function(self, name: str, body: str | Body, function: Callable[..., Any]) -> None:
        """Adds a load given by a Python function, for experiments: thousands of times slower than an expression.

        Args:
            name: Name of the load.
            body: The body on which it acts.
            function: ``function(t, body)`` returns the force (N, at the body's reference point), or force and
                torque (N m) as six numbers, in world axes. ``body`` has ``position`` (m), ``velocity`` (m/s),
                ``directors`` (rows d1, d2, d3) and ``angular_velocity`` (rad/s), each an array, in world axes.
                It must be smooth in all of these and must not depend on earlier calls.

        A model with functions cannot be pickled, written to a file or passed to :func:`livens.solve_many`. An
        exception raised by the function ends the solution. Issues a :class:`SlowWarning`.

        Raises:
            InputError: ``body-unknown``, ``name-duplicate``.
        """
        wanted = body.name if isinstance(body, Entry) else body
        if wanted not in self.bodies:
            raise fault("body-unknown", f"load '{name}' refers to '{wanted}', but there is no such body",
                        f"load[{name}].body", _core.suggestion(str(wanted), list(self.bodies)))
        if not callable(function):
            raise TypeError(f"a function is wanted, not {type(function).__name__}")
        if name in self._functions or name in self.loads:
            raise fault("name-duplicate", f"a load called '{name}' exists already", f"load[{name}].name")
        warnings.warn(f"load '{name}' is a Python function: it works, slowly; "
                      "where a formula says the same, `expression` of add_force or add_torque is fast", SlowWarning,
                      stacklevel=stack_level())
        self._functions[name] = (wanted, function)
        self._forget()

    def add_guard(self, name: str, function: Callable[..., float], of: Sequence[str] = (), *,
                  action: Literal["note", "stop"] = "note") -> None:
        """Adds an event whose condition is a Python function, for experiments: formulas are found with more care.

        The event is where the function becomes positive. It is known by looks alone: of a function that only touches
        zero between two of them nothing is seen that its values do not show.

        Args:
            name: Name of the event.
            function: ``function(t, *values)`` returns a finite number. It must not depend on earlier calls.
            of: Names of what is passed, as conditions have them: ``"pin.angle"``, ``"tip.z"``, ``"latch.force"``.
            action: ``"note"``: the event is reported; ``"stop"``: the motion ends there.

        A model with functions cannot be pickled, written to a file or passed to :func:`livens.solve_many`. An
        exception raised by the function ends the solution, a number that is not finite is an error.

        Raises:
            InputError: ``name-duplicate``; ``event-not-finite`` where the motion begins, from :func:`solve`.

        Example:
            >>> import livens as lv
            >>> m = lv.Model("pendulum", gravity=(0, 0, -9.81))
            >>> rod = m.add_body("rod", lv.box(1, 0.05, 0.05, mass=2), position=(0.5, 0, 0))
            >>> pin = m.add_revolute("pin", "world", rod, at=(0, 0, 0), axis=(0, 1, 0))
            >>> m.add_guard("half way", lambda t, angle: angle - 0.5, of=["pin.angle"], action="stop")
            >>> sol = lv.solve(m, 5)
            >>> sol.stopped_by, sol["pin"].angle[-1].round(9).item()
            ('half way', 0.5)
        """
        if not callable(function):
            raise TypeError(f"a function is wanted, not {type(function).__name__}")
        if isinstance(of, str):
            raise TypeError("of= is a list of names")
        if name in self._functions:
            raise fault("name-duplicate", f"an event called '{name}' exists already", f"event[{name}].name")
        self.add_event(name, when=" and ".join(f"{one} > 0" for one in of) or "t > 0", action=action)
        self._functions[name] = (None, function if of else lambda t, _: function(t))
        self._forget()

    # Checking and building.

    def check(self) -> list[Diagnostic]:
        """Errors and warnings of the model, in its order, 20 at most; empty if there are none.

        Does not solve anything. A model without ``[time]`` is checked with a default one.
        """
        _, found = self._build({} if "time" in self._root else {"time": some_time(self._root)})
        return found

    # States.

    @property
    def coordinates(self) -> Coordinates:
        """Independent coordinates that tell where all bodies are: their order is that of arrays for :meth:`at`.

        Taken are coordinates of joints in the order of the model, those of universal and ball joints last (in a loop the
        first ones that are independent), and of bodies that these leave free the position and quaternion: of a body on a
        ball joint without ``angles`` the quaternion. Drives do not count.

        Raises:
            InputError: ``coordinates-missing`` where something can move that no coordinate tells, such as the turns that a
                joint of constant velocity leaves; for errors in the model.
        """
        return self._coordinates((), None)

    def at(self, q: Any = None, v: Any = None, *, t: float | str | None = None) -> MechanismState:
        """The mechanism in a state: poses, velocities, energies, Jacobians, mass matrix, forces, linearisation.

        Bodies are led from where they are placed to the stated coordinates: at once where joints form trees, else in small
        steps along the loops, so that the mechanism stays on its branch. Drives are released: the coordinates take their
        place; joints that do not act at ``t`` are left out, and loads are taken then. Limits of joints act as the springs
        that they are.

        Args:
            q: A mapping: ``{"elbow.angle": "30 deg"}`` of joints, ``"base.position"``, ``"base.quaternion"`` (or
                ``rotation_vector``, ``directors``, ``rotation``), ``"base.x"`` of bodies. The coordinates that are named become
                those of the state; others that are independent of them stay as the bodies are placed. Or an array in the
                order of ``coordinates.q``. None: as the bodies are placed.
            v: Rates: a mapping by the same names (``"elbow.angle"`` or ``"elbow.angle_rate"``, ``"base.velocity"``,
                ``"base.angular_velocity"``), others zero, or an array in the order of ``coordinates.v``. None: at rest.
            t: The time, s. Default: the initial time.

        Raises:
            InputError: ``coordinate-unknown``, ``coordinate-value``, ``coordinate-twice``; ``coordinates-dependent`` for one
                that joints or others determine; ``loop-open`` with the joint that stays open and by how much;
                ``coordinates-singular`` at a dead centre; ``coordinates-missing``; for errors in the model.

        Example:
            >>> import livens as lv
            >>> m = lv.Model("pendulum", gravity=(0, 0, -9.81))
            >>> rod = m.add_body("rod", lv.box(1, 0.05, 0.05, mass=2), position=(0.5, 0, 0))
            >>> pivot = m.add_revolute("pivot", "world", rod, at=(0, 0, 0), axis=(0, 1, 0))
            >>> state = m.at({"pivot.angle": "90 deg"}, {"pivot.angle": 2})
            >>> state["rod"].position.round(12).tolist(), round(state.kinetic, 6)
            ([0.0, 0.0, -0.5], 1.334167)
            >>> m.at().gravity_forces.round(6).tolist(), m.at().jacobian("rod")[2].round(6).tolist()
            ([-9.81], [-0.5])
        """
        return state_of(self, q, v, t)

    def _coordinates(self, wanted: tuple[str, ...], t: float | None) -> Coordinates:
        if (wanted, t) not in self._counted:
            if len(self._counted) >= 16:
                self._counted.pop(next(iter(self._counted)))
            self._counted[wanted, t] = coordinates_of(self._as_it_starts(), wanted, t)
        return self._counted[wanted, t]

    # Rest.

    def find_equilibrium(self) -> Equilibrium:
        """Finds a static equilibrium under gravity and loads, starting from the initial (or known final) state.

        Velocities are ignored; drives and loads are held at their values at the initial time. The potential energy
        decreases during the search, so that the equilibrium is stable, unless the start itself is balanced; this
        equilibrium is then returned, stable or not.

        Returns:
            The equilibrium. If none was found, ``success`` is False and a :class:`SolveWarning` has been issued.

        Raises:
            InputError: for errors in the model.

        Example:
            >>> import livens as lv
            >>> m = lv.Model("spring", gravity=(0, 0, -9.81))
            >>> bob = m.add_body("bob", lv.point(mass=1))
            >>> rail = m.add_point_on_line("rail", "world", bob, at=(0, 0, 0), axis=(0, 0, 1))
            >>> spring = m.add_spring("spring", ("world", (0, 0, 1)), (bob, (0, 0, 0)), stiffness=981, free_length=1)
            >>> rest = m.find_equilibrium()
            >>> rest.status, rest["bob"].position.round(9).tolist()
            ('stable', [0.0, 0.0, -0.01])
            >>> m.vibration_modes().frequency.round(6).tolist()
            [31.32092]
        """
        rest = Equilibrium(_core.equilibrium(self._as_it_starts()))
        if not rest.success:
            warnings.warn(f"no equilibrium: {rest.message}", SolveWarning, stacklevel=stack_level())
        return rest

    def linearise(self, at: Literal["equilibrium", "start"] = "equilibrium") -> Linearisation:
        """Linearises about an equilibrium: mass, damping and stiffness matrices, modes, and state matrices.

        Args:
            at: State to linearise about: the result of :meth:`find_equilibrium`, or the start, which must be an
                equilibrium.

        Raises:
            EquilibriumError: no equilibrium was found.
            InputError: ``not-at-rest``, ``not-in-equilibrium`` with ``at="start"``; for errors in the model.

        Example:
            >>> import livens as lv
            >>> m = lv.Model("upright", gravity=(0, 0, -9.81))
            >>> rod = m.add_body("rod", lv.box(0.05, 0.05, 1, mass=2), position=(0, 0, 0.5))
            >>> pivot = m.add_revolute("pivot", "world", rod, at=(0, 0, 0), axis=(0, 1, 0))
            >>> linear = m.linearise(at="start")
            >>> linear.status
            'unstable'
            >>> A, B, C, D, *names = linear.state_matrices(["pivot.angle"], ["pivot.angle"])
            >>> A.shape, B.shape, C.shape, D.shape
            ((2, 2), (2, 1), (1, 2), (1, 1))
        """
        if at not in ("equilibrium", "start"):
            raise fault("unknown-choice", f"at= is 'equilibrium' or 'start', not {at!r}", "at",
                        _core.suggestion(str(at), ["equilibrium", "start"]))
        linear, found = _core.linearised(self._as_it_starts(), at == "start")
        if linear is None:
            rest = Equilibrium(found)
            raise EquilibriumError(f"no equilibrium was found: {rest.message}", rest)
        return Linearisation(linear)

    def vibration_modes(self, at: Literal["equilibrium", "start"] = "equilibrium") -> Modes:
        """Natural frequencies, damping ratios and mode shapes about an equilibrium.

        Args:
            at: See :meth:`linearise`, which also returns matrices.

        Raises:
            EquilibriumError: no equilibrium was found.
            InputError: as :meth:`linearise`.

        Example:
            >>> import livens as lv
            >>> m = lv.Model("pendulum", gravity=(0, 0, -9.81))
            >>> bob = m.add_body("bob", lv.point(mass=1), position=(0, 0, -1))
            >>> thread = m.add_rod("thread", "world", bob, points=[(0, 0, 0), (0, 0, 0)])
            >>> m.vibration_modes().frequency.round(6).tolist()   # in two directions sqrt(g/l)
            [3.132092, 3.132092]
        """
        return self.linearise(at).vibration_modes()

    def _as_it_starts(self) -> Any:
        return self._scenario({} if "time" in self._root else {"time": some_time(self._root)})
