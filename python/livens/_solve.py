# SPDX-License-Identifier: BSD-3-Clause
"""solve() and solve_many()."""
from __future__ import annotations

import sys
import time as clock
import warnings
from collections.abc import Callable, Iterable, Mapping, Sequence
from functools import lru_cache
from typing import TYPE_CHECKING, Any, Literal, Union

import numpy as np

from . import _core
from ._entries import default_name
from ._errors import InputError, SolveError, SolveWarning, fault, stack_level, user_place
from ._model import Model
from ._other_names import of_keyword
from ._places import diagnostic_of
from ._results import Solution
from ._tree import Table, plain, schema, toml
from ._values import Condition, Method, Number, Vector

if TYPE_CHECKING:
    from typing_extensions import TypeAlias, Unpack

    from ._generated import MethodOptions

Time: TypeAlias = Union[Number, tuple[Number, Number], Sequence[Number], None]
"""An end (from the start of the model's own ``[time]``, or 0), or (start, end); s, strings with units are taken."""
End: TypeAlias = Union[Condition, Mapping[str, Any], Literal["nothing", "positions", "momenta", "state"], None]
"""What is known at an end of time."""
ProgressArgument: TypeAlias = Union[bool, Callable[[int, int, float], Any]]
"""True: a line on standard error. A function is called with (elements done, elements, t) about 20 times a second;
what it raises ends the solution."""

_ORIENTATIONS = ("directors", "quaternion", "rotation_vector")
_SPINS = ("angular_velocity", "angular_velocity_body")


def solve(model: Model, time: Time = None, *, accuracy: Number | None = None, elements: int | None = None,
          until: str | None = None, output: Number | Vector | None = None, breaks: Literal["from_loads", "ignore"] | None = None,
          method: Method | str | None = None, start: End = None, end: End = None, periodic: bool | Mapping[str, Any] | None = None,
          guess: Solution | None = None, progress: ProgressArgument = False, strict: bool = False, **options: Unpack[MethodOptions]) -> Solution:
    """Solves the motion of a model.

    Arguments that are not given follow from the model's tables ``[time]``, ``[method]``, ``[start]``, ``[end]``, or
    their defaults: accuracy 1e-6, method ``auto``.

    Args:
        model: The model to solve; it is not changed.
        time: Final time, or (start, end), s.
        accuracy: Permitted error of positions, in model lengths, of orientations, in rad, and of unknown numbers,
            by their size. The elements, and the degree unless given, follow from it. Default: 1e-6.
        elements: Number of time elements of equal length, instead of ``accuracy``.
        until: A condition that ends the motion earlier, ``"door.angle > 60 deg"``; see :attr:`Solution.stopped_by`.
        output: Interval between output times, or an ascending list of them, s; they become element ends.
        breaks: Whether elements end where loads jump (``"from_loads"``, default) or not (``"ignore"``).
        method: ``lv.Lobatto(7)``, ``lv.Radau()``, ``lv.Mixed(..)``, .., or a word: ``"radau"``.
        start: What is prescribed at the initial time, by default the state: a word, or ``lv.positions({..})``, ..;
            or single quantities, ``{"pivot.angle": 0}``, as in ``[start.known]``.
        end: What is prescribed at the final time, by default nothing. Two halves must be prescribed in all, or
            twice as many quantities as the joints leave motions free.
        periodic: Whether the motion ends in the state in which it begins, but for whole turns; time is its period then, and
            may be :func:`unknown`. ``{"turn": 0.5, "axis": (0, 0, 1), "at": (0, 0, 0)}``: in that state turned about an axis.
        guess: A motion of the same bodies to begin with, where ``start`` and ``end`` prescribe one half each.
        progress: True for a progress line, or a function.
        strict: Whether to raise :class:`SolveError` with the solution so far instead of issuing a warning.
        **options: Options of all methods: ``tolerance``, ``max_iterations``, ``estimate``, ``growth``,
            ``condition``; ``roots``: how many motions are looked for between both ends; ``threads``: how many share
            elements that are solved together.

    Returns:
        The solution. If it did not converge or is suspect, ``success`` is False and a :class:`SolveWarning` has
        been issued. Ctrl-C raises ``KeyboardInterrupt``. Other threads can run in the meantime.

    Raises:
        InputError: for errors in the model or the arguments.
        SolveError: with ``strict=True``.

    Example:
        >>> import livens as lv
        >>> m = lv.Model("pendulum", gravity=(0, 0, -9.81))
        >>> rod = m.add_body("rod", lv.box(1, 0.05, 0.05, density=7850), position=(0.5, 0, 0))
        >>> pivot = m.add_revolute("pivot", "world", rod, at=(0, 0, 0), axis=(0, 1, 0))
        >>> sol = lv.solve(m, 2, accuracy=1e-9)
        >>> sol["pivot"].force.shape == (len(sol.t), 3)
        True
    """
    if not isinstance(model, Model):
        raise TypeError(f"solve() takes a livens.Model first, not {type(model).__name__}")
    if not (guess is None or isinstance(guess, Solution)):
        raise TypeError(f"a guess is a livens.Solution, not {type(guess).__name__}; lv.load_solution() reads one from a file")
    if callable(until):
        raise TypeError('until= is a condition in words; Model.add_guard(.., action="stop") takes a function')
    of_time = dict(accuracy=accuracy, elements=elements, until=until, output=output, breaks=breaks, periodic=periodic)
    overrides = _overrides(model, time, of_time, method, options, start, end)
    scenario = model._scenario(overrides)
    shown = _Progress(progress)
    try:
        result = _core.solve(scenario, shown.function, _most_bytes(int(clock.monotonic())),
                             None if guess is None else guess._result)
    finally:
        shown.end()
    solution = Solution(result, bool(model._functions))
    if not result.converged:
        _complain(solution, strict)
    return solution


def solve_many(models: Model | Iterable[Model], time: Time = None, *,   # type: ignore[misc]   # threads of all, not of each
               variations: Iterable[Mapping[str, Any]] | None = None, threads: int = 0,
               accuracy: Number | None = None, elements: int | None = None, output: Number | Vector | None = None,
               breaks: Literal["from_loads", "ignore"] | None = None, method: Method | str | None = None,
               start: End = None, end: End = None, progress: bool | Callable[[int, int], Any] = False,
               strict: bool = False, **options: Unpack[MethodOptions]) -> list[Solution]:
    """Solves many models, several at a time; results have the same bits for any number of threads.

    Args:
        models: Models, or one model that ``variations`` modify.
        time: Final time, or (start, end), s; this and other arguments without explanation: see :func:`solve`.
        variations: For each solution, the assignments to make first: ``{"crank.mass": 2.6, "return.stiffness": 800}``;
            ``"gravity"`` and ``"time.end"`` are possible, too.
        threads: Number of threads; 0: one per processor.
        progress: True for a progress line, or a function that is called with (done, all).
        accuracy: Permitted error of each.
        elements: Number of time elements of each, instead of ``accuracy``.
        output: Interval between output times, or a list of them, s.
        breaks: Whether elements end at jumps of loads.
        method: Method for all of them.
        start: What is prescribed at the initial time.
        end: What is prescribed at the final time.
        strict: Whether to raise :class:`SolveError` for the first that fails; otherwise one warning reports their
            number.
        **options: ``tolerance``, ``estimate``, ..

    Returns:
        The solutions, in the order of models or variations.

    Raises:
        InputError: for the first model with an error; nothing is solved if an assignment fails.

    Example:
        >>> import livens as lv
        >>> m = lv.Model("fall", gravity=(0, 0, -9.81))
        >>> ball = m.add_body("ball", lv.point(mass=1))
        >>> speeds = [{"ball.velocity": (v, 0, 0)} for v in (1, 2, 3)]
        >>> [round(sol["ball"].position[-1].item(0), 9) for sol in lv.solve_many(m, 2, variations=speeds, elements=2)]
        [2.0, 4.0, 6.0]
    """
    pairs = []
    of_time = dict(accuracy=accuracy, elements=elements, output=output, breaks=breaks)
    for model in _varied(models, variations):
        model._refuse_functions("solved beside others")
        root = model._with(_overrides(model, time, of_time, method, options, start, end))
        pairs.append((root, toml(root), model._folder))
    if isinstance(threads, bool) or not isinstance(threads, int) or threads < 0:
        raise fault("out-of-range", f"threads must be 0 or more, not {threads!r}", "threads")
    line = _Progress(progress if isinstance(progress, bool) else False, "solutions")
    tell: Callable[[int], Any] | None = None
    if callable(progress):
        function = progress
        tell = lambda done: function(done, len(pairs))   # noqa: E731
    elif line.function is not None:
        show = line.function
        tell = lambda done: show(done, len(pairs), None)   # noqa: E731
    try:
        found = _core.solve_many(pairs, threads, tell, _most_bytes(int(clock.monotonic())))
    finally:
        line.end()
    solutions = []
    for i, (result, diagnostics) in enumerate(found):
        if result is None:
            faults = [diagnostic_of(d, pairs[i][0]) for d in diagnostics if d["severity"] == "error"]
            error = InputError(faults)
            error.args = (f"variation {i}: {error}",)
            raise error
        solutions.append(Solution(result))
    bad = [i for i, solution in enumerate(solutions) if not solution.success]
    if bad:
        message = f"{len(bad)} of {len(solutions)} are not good, the first is {bad[0]}: {_words(solutions[bad[0]])}"
        if strict:
            raise SolveError(message, solutions[bad[0]])
        warnings.warn(message, SolveWarning, stacklevel=stack_level())
    return solutions


def _varied(models: Model | Iterable[Model], variations: Iterable[Mapping[str, Any]] | None) -> Iterable[Model]:
    if not isinstance(models, Model):
        if variations is not None:
            raise TypeError("variations= are of one model; a list of models is solved as it is")
        return models
    if variations is None:
        raise TypeError("solve_many() takes a list of models, or one with variations=")
    return (_with_values(models, values) for values in variations)


def _with_values(model: Model, values: Mapping[str, Any]) -> Model:
    varied = model.copy()
    for path, value in values.items():
        name, _, key = path.rpartition(".")
        if not name and key in ("gravity", "title"):
            setattr(varied, key, value)
        elif name in ("time", "method", "start", "end") and name not in varied:
            setattr(getattr(varied, name), key, value)
        elif not name:
            raise fault("unknown-key", f"'{path}' names no value: write 'part.key'", path)
        else:
            setattr(varied[name], key, value)
    return varied


def _words(solution: Solution) -> str:
    return solution.message or (solution.reasons or [solution.status])[0]


def _complain(solution: Solution, strict: bool) -> None:
    reached = f"; it ends at {solution.t[-1]:.6g} s" if not solution._result.reached_end else ""
    message = f"{solution.status}: {_words(solution)}{reached}"
    if strict:
        raise SolveError(message, solution)
    warnings.warn(message, SolveWarning, stacklevel=stack_level())


def _set(table: Table, kind: str, name: str, value: Any) -> None:
    key = schema().key(schema().children[kind], table, name)
    table[name] = plain(value, key, f"{kind}.{name}")
    table.places[name] = user_place()


def _overrides(model: Model, time: Time, of_time: dict[str, Any], method: Method | str | None,
               options: Mapping[str, Any], start: End, end: End) -> dict[str, Any]:
    """Tables of the root that the arguments replace; empty: none."""
    made: dict[str, Any] = {}
    if time is not None or any(value is not None for value in of_time.values()):
        made["time"] = _time(model, time, of_time)
    elif "time" not in model._root:
        raise fault("missing-key", "the end of time is missing", "time.end",
                    "give it here: lv.solve(model, 10), or in the model: model.time.end = 10")
    if method is not None or options:
        made["method"] = _method(model, method, options)
    if isinstance(start, Mapping):
        made["start"] = _known(model, "start", start)
    elif start is not None:
        condition = _condition(start, "start")
        made["start"] = _given(model, "start", condition.given)
        if condition.coordinates is not None:
            made["start"].pop("coordinates", None)
            if condition.coordinates:
                made["start"]["coordinates"] = [dict(one) for one in condition.coordinates]
            joints = model._root.get("joint", [])
            if any("rate" in joint for joint in joints):
                made["joint"] = [_without(joint, "rate") for joint in joints]
        if condition.bodies:
            made["body"] = _moved(model._root.get("body", []), condition, "start")
        if condition.states:
            made["controller"] = _holding(model._root.get("controller", []), condition.states)
    if isinstance(end, Mapping):
        made["end"] = _known(model, "end", end)
    elif end is not None:
        condition = _condition(end, "end")
        made["end"] = _given(model, "end", condition.given)
        if condition.bodies:
            made["body"] = _moved(made.get("body", model._root.get("body", [])), condition, "end")
        lacking = [default_name("body", body) for body in made.get("body", model._root.get("body", [])) if "end" not in body]
        if lacking and condition.given in ("positions", "momenta", "state"):
            raise fault("missing-key", f"end= says nothing of {', '.join(map(repr, lacking[:5]))}", "end",
                        f"end=lv.{condition.given}({{{lacking[0]!r}: {{'position': (0, 0, 0)}}}})",
                        "what is known at the end concerns every body")
    return made


def _known(model: Model, at: str, given: Mapping[str, Any]) -> Table:
    """The table of an end with conditions by component."""
    table = _without(_base(model, at), "given")
    _set(table, at, "known", dict(given))
    return table


def _without(table: Table, name: str) -> Table:
    return Table({key: value for key, value in table.items() if key != name}, table.place, table.places)


def _base(model: Model, name: str) -> Table:
    table = model._root.get(name)
    return Table(table, table.place, table.places) if isinstance(table, Table) else Table(place=user_place())


def _time(model: Model, time: Time, of_time: dict[str, Any]) -> Table:
    table = _base(model, "time")
    both: tuple[Any, ...] = (None, time)
    if np.ndim(time) == 1 and not hasattr(time, "to_base_units"):   # type: ignore[arg-type]
        both = tuple(time)   # type: ignore[arg-type]
        if len(both) != 2:
            raise fault("wrong-type", f"time is its end, or (start, end), not {len(both)} numbers", "time")
    for name, value in zip(("start", "end"), both):
        if value is not None:
            _set(table, "time", name, value)
    if of_time["elements"] is not None:
        table.pop("accuracy", None)
    if of_time["accuracy"] is not None:
        table.pop("elements", None)
    for name, value in of_time.items():
        if value is not None:
            _set(table, "time", name, value)
    return table


def _method(model: Model, method: Method | str | None, options: Mapping[str, Any]) -> Table:
    table = _base(model, "method")
    known = [key["name"] for key in schema().children["method"]["keys"]]
    if method is not None:
        table = Table({k: v for k, v in table.items() if k in known and k != "family"}, table.place, table.places)
        if isinstance(method, str):
            method = Method(method)
        if not isinstance(method, Method):
            given = f"the class {method.__name__}" if isinstance(method, type) else type(method).__name__
            raise TypeError(f"a method is lv.Lobatto(..), .. or a word, not {given}")
        _set(table, "method", "family", method.family)
        for name, value in method.keys.items():
            _set(table, "method", name, value)
    for name, value in options.items():
        if name not in known or name == "family":
            names = [n for n in known if n != "family"]
            of_solve = ["time", "accuracy", "elements", "until", "output", "breaks", "method", "start", "end", "periodic", "guess", "progress",
                        "strict"]
            raise fault("unknown-key", f"solve() has no keyword '{name}'", name,
                        of_keyword(name) or _core.suggestion(name, names + of_solve)
                        if name not in ("degree", "window", "basis") else f"write method=lv.Lobatto({name}=..)")
        if value is None:
            table.pop(name, None)
        else:
            _set(table, "method", name, value)
    return table


def _condition(given: Any, at: str) -> Condition:
    if isinstance(given, Condition):
        return given
    if isinstance(given, str):
        return Condition(given)
    raise TypeError(f"{at}= takes a word or lv.positions(..), lv.momenta(..), lv.state(..), not {type(given).__name__}")


def _given(model: Model, name: str, word: str) -> Table:
    table = _base(model, name)
    _set(table, name, "given", word)
    return table


def _moved(bodies: list[Table], condition: Condition, at: str) -> list[Table]:
    """States of bodies at the start or end of the motion."""
    names = [str(body.get("name")) for body in bodies]
    for name in condition.bodies:
        if name not in names:
            raise fault("body-unknown", f"{at}= refers to '{name}', but there is no such body", f"{at}.{name}",
                        _core.suggestion(str(name), names))
    moved = []
    for body in bodies:
        keys = condition.bodies.get(str(body.get("name")))
        body = Table(body, body.place, body.places)
        if keys is not None:
            before = body.get("start") if at == "start" else None   # what is left out is as it was
            into = Table(before or {}, user_place(), before.places if isinstance(before, Table) else {})
            for words in (_ORIENTATIONS, _SPINS):
                if any(word in keys for word in words):
                    for word in words:
                        into.pop(word, None)
            child = schema().tables[schema().keys(schema().children["body"])[at]["child"]]
            for word, value in keys.items():
                into[word] = plain(value, schema().keys(child).get(word), f"body[{body.get('name')}].{at}.{word}")
                into.places[word] = user_place()
            body[at] = into
            body.places[at] = into.place
        moved.append(body)
    return moved


def _holding(controllers: list[Table], states: Mapping[str, float]) -> list[Table]:
    """Controllers that start in these states."""
    starting = []
    for controller in controllers:
        controller = Table(controller, controller.place, controller.places)
        name = f"{controller['name']}."
        own = {state[len(name):]: value for state, value in states.items()
               if state.startswith(name) and state[len(name):] in controller.get("states", {})}
        if own:
            _set(controller, "controller", "start", {**controller.get("start", {}), **own})
        starting.append(controller)
    return starting


@lru_cache(maxsize=1)
def _most_bytes(now: int) -> float:
    """Half of what the machine has left, looked up once a second; a march to an accuracy gives up there."""
    try:
        with open("/proc/meminfo", encoding="ascii") as stream:
            for line in stream:
                if line.startswith("MemAvailable:"):
                    return 0.5 * 1024 * float(line.split()[1])
    except (OSError, ValueError, IndexError):
        pass
    return float("inf")


class _Progress:
    """A line on standard error, while it is worth one."""

    def __init__(self, asked: ProgressArgument, what: str = "elements") -> None:
        self._what, self._begin, self._width = what, clock.monotonic(), 0
        self.function: Callable[..., Any] | None = None
        if callable(asked):
            self.function = asked
        elif asked:
            self.function = self._show

    def _show(self, done: int, n: int, t: float | None) -> None:
        share = done / n if n > 0 else 0.0
        bar = "#" * round(24 * share)
        at = f", t = {t:.4g} s" if t is not None else ""
        of = f"{done} of {n}" if n > 0 else f"{done}"
        text = f"\r[{bar:<24}] {of} {self._what}{at}, {clock.monotonic() - self._begin:.0f} s"
        sys.stderr.write(text.ljust(self._width))
        sys.stderr.flush()
        self._width = len(text)

    def end(self) -> None:
        if self._width:
            sys.stderr.write("\r" + " " * self._width + "\r")
            sys.stderr.flush()
