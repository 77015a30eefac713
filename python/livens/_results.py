# SPDX-License-Identifier: BSD-3-Clause
"""Solutions: a solved motion, its verdict, its files."""
from __future__ import annotations

import json
import math
import os
import warnings
from dataclasses import dataclass
from html import escape
from typing import TYPE_CHECKING, Any

import numpy as np

from . import _core
from ._errors import fault, file_name, make_way, stack_level
from ._other_names import refused_ending
from ._parts import Floats
from ._series import Series
from ._shown import Extremes, Peak, found_extremes
from ._tree import plain

if TYPE_CHECKING:
    from collections.abc import Sequence

    from ._model import Model

_LARGEST_INLINE = 4_000_000   # characters of a page inside a notebook


@dataclass(frozen=True)
class SolvedEvent:
    """A condition that became true: its name, the instant (s), and the estimated error of that (s; nan: not known).

    Of an impact also the impulse along the row of the stop (N s, or N m s of an angle) and the speed with which bodies met
    (m/s or rad/s), else 0; of a stop that closes the time at which it rests (s), else nan: bodies bounce.
    """

    name: str
    t: float
    error: float
    impulse: float = 0.0
    speed: float = 0.0
    rests_at: float = math.nan


class Solution(Series):
    """A solved motion at element ends, where it is most accurate; ``sol(t)`` evaluates it at any time.

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
        super().__init__(result, None, before=_last_from_before(result.t, result.t))
        self._dense: Series | None = None
        self._has_functions = has_functions

    def __call__(self, t: Any, *, exact: bool = False) -> Series:
        """The motion at other instants.

        Args:
            t: An instant or several, s, any order, shape (n,); strings with units are taken.
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
        return Series(self._result, times, is_single, found, _last_from_before(times, self._result.t))

    def _chosen(self, at: str | None, is_table: bool) -> Series:
        chosen = at or ("output" if is_table and self._result.lists_output else "dense")
        if chosen == "ends":
            return self
        if chosen == "output":
            return self(self.output[(self.output >= self.t[0]) & (self.output <= self.t[-1])])
        if chosen != "dense":
            raise fault("unknown-choice", f"'{at}' is no choice of instants", "at",
                        "there are 'dense', 'output' and 'ends'; sol(t) has those that you give")
        if self._dense is None:
            times, before = self._result.dense()
            self._dense = Series(self._result, times, before=before)
        return self._dense

    # Peaks.

    def peak(self, name: str, *, unit: str | Sequence[str] | None = None) -> Peak:
        """The value farthest from zero and its time, searched on the motion, not among samples.

        The polynomials of every element are searched, and each candidate is refined by solving shortened elements,
        to the full order of the method. Both sides of every jump are considered.

        Args:
            name: ``"pivot.force"`` (the magnitude of a vector), ``"rod.position.z"``, ``"pivot.angle"``, ``"energy"``.
            unit: ``"deg"``, ``"kN"``, ..; default SI.

        Raises:
            InputError: ``quantity-unknown``, ``quantity-unbounded``, ``unit``.

        Example:
            >>> import livens as lv
            >>> m = lv.Model("pendulum", gravity=(0, 0, -9.81))
            >>> bob = m.add_body("bob", lv.point(mass=1), position=(1, 0, 0))
            >>> rod = m.add_rod("rod", "world", bob, points=[(0, 0, 0), (0, 0, 0)])
            >>> value, t = lv.solve(m, 2).peak("rod.force")
            >>> f"{value:.4f} N, three times the weight, at {t:.4f} s"
            '29.4300 N, three times the weight, at 0.5920 s'
        """
        return self.extremes(name, unit=unit).peak

    def extremes(self, name: str, *, unit: str | Sequence[str] | None = None) -> Extremes:
        """The smallest and the largest value and their times; see :meth:`peak`."""
        return next(iter(found_extremes(self._result, (name,), unit).values()))

    def peaks(self, *names: str, unit: str | Sequence[str] | None = None) -> dict[str, Extremes]:
        """Extremes of the arrays named, or of all joints, loads, sensors and energies, as ``livens peaks`` prints them.

        If a quantity does not exist at some time, all four are nan.
        """
        return found_extremes(self._result, names, unit)

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
        """One sentence on the outcome; may be empty."""
        return str(self._result.message)

    @property
    def reasons(self) -> list[str]:
        """Reasons why the motion is suspect."""
        return list(self._result.reasons)

    @property
    def notes(self) -> list[str]:
        """Notes, such as redundant constraints or divided elements."""
        return list(self._result.notes)

    @property
    def title(self) -> str:
        """Title of the model."""
        return str(self._result.title)

    @property
    def method(self) -> str:
        """The method used, such as ``"lobatto(7)"``."""
        return str(self._result.method)

    @property
    def figures(self) -> dict[str, float | int | None]:
        """All figures of the run, with the names of the result file; ``None``: not known. See docs/results.md."""
        return dict(self._result.figures)

    @property
    def options(self) -> dict[str, Any]:
        """All options including defaults: time, method, conditions."""
        return dict(json.loads(self._result.resolved))

    @property
    def unknowns(self) -> dict[str, float]:
        """What was found of unknown numbers, in SI units, by their names: ``"friction.damping"``, ``"time.end"``; of
        a parameter its own."""
        return dict(self.options.get("found", {}))

    @property
    def unknown_errors(self) -> dict[str, float]:
        """Estimated errors of what was found of unknown numbers, by their names; nan: not known."""
        return dict(self._result.unknown_errors)

    @property
    def events(self) -> list[SolvedEvent]:
        """What the motion decided, in its order: events of the model, ``from`` and ``until`` that are conditions."""
        return [SolvedEvent(*one) for one in self._result.events]

    @property
    def stopped_by(self) -> str | None:
        """Name of the event that ended the motion; ``None``: it went on to the end of time."""
        return self._result.stopped_by or None

    @property
    def n_elements(self) -> int:
        """Number of time elements."""
        return len(self._result.t) - 1

    @property
    def nfev(self) -> int:
        """Number of evaluations of the equations at a node, in the final motion."""
        return int(self.figures["evaluations"] or 0)

    @property
    def nit(self) -> int:
        """Number of Newton iterations."""
        return int(self.figures["newton_iterations"] or 0)

    @property
    def nlu(self) -> int:
        """Number of factorisations of tangent matrices."""
        return int(self.figures["factorisations"] or 0)

    @property
    def seconds(self) -> float:
        """Wall time of the solution, s, without the error estimate; 0 for a loaded solution."""
        return float(self._result.solve_seconds)

    # Beside the series.

    @property
    def output(self) -> Floats:
        """The output times of the model, s, shape (m,)."""
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
        """Work of drives and of loads without potential since the start, J, shape (n,)."""
        return self._balance("work")

    @property
    def drift(self) -> Floats:
        """Energy error: abs(energy - work - initial energy), J, shape (n,)."""
        return self._balance("energy_drift")

    @property
    def linear_momentum(self) -> Floats:
        """Linear momentum of all bodies, kg m/s, world, shape (n, 3)."""
        return self._balance("linear_momentum")

    @property
    def angular_momentum(self) -> Floats:
        """Angular momentum of all bodies about the world origin, kg m^2/s, world, shape (n, 3)."""
        return self._balance("angular_momentum")

    @property
    def violation(self) -> float:
        """Largest constraint violation at nodes, each relative to its scale."""
        value = self.figures["max_constraint_violation"]
        return float("nan") if value is None else float(value)

    @property
    def error(self) -> float:
        """Largest estimated error of positions (in model lengths) and orientations (rad); nan: not known."""
        value = self.figures["estimated_error"]
        return float("nan") if value is None else float(value)

    @property
    def growth(self) -> Floats:
        """Growth factor of an initial perturbation, shape (n,); shape (0,) if it was not measured."""
        growth: Floats = self._result.growth
        return growth

    @property
    def arrival(self) -> float:
        """What the arrival is to the start, of motions between both ends of time, s.

        By how many m a rate that is off by 1 m/s at the start moves the motion at its end, at most: of free
        velocities at the start, the one that moves bodies most (turns count by the model length). It is found with the
        factors of all elements at once. nan: the state is given at one end, or it is not known.
        """
        value = self.figures["arrival"]
        return float("nan") if value is None else float(value)

    @property
    def roots(self) -> list[Solution]:
        """The other motions that ``solve(.., roots=4)`` found, by their effort; this one has the least.

        Their effort (the kinetic energy over all of time, J s) and the turns of joints are in :attr:`notes`. There may
        be more than were found. A solution that is saved and read again has none.
        """
        return [Solution(one) for one in self._result.roots]

    @property
    def nodes(self) -> Floats:
        """[r, d1, d2, d3] of all bodies at all nodes of all elements, shape (nodes, bodies, 4, 3); a view."""
        nodes: Floats = self._result.nodes
        return nodes

    @property
    def model(self) -> Model:
        """The model that was solved, with its time and method, read from the scenario text in the result."""
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

    def save(self, file: str | os.PathLike[str], *, force: bool = False) -> None:
        """Writes a result file, the same bytes as the program: classic NetCDF with scenario and checksums.

        The file is replaced as a whole: it is either the old or the new one. ``livens info``, xarray and MATLAB
        read it.

        Args:
            file: Its name.
            force: Whether to replace files other than older results; never the file that the model was read from.

        Raises:
            OSError: it cannot be written; ``FileExistsError`` if another file would be lost.
            InputError: ``python-function``.
        """
        self._refuse_functions("saved")
        name = file_name(file)
        make_way(name, "run", self._result.inputs(), force)
        if instead := refused_ending(name):
            raise fault("unknown-choice", f"'{name}' does not end like a result", "file", instead)
        self._result.save(name)

    def report(self, file: str | os.PathLike[str], other: Solution | None = None, *, force: bool = False) -> None:
        """Writes one HTML page: the motion in 3D, linked plots, and quality figures.

        The page needs neither network nor livens to be opened; ``livens report`` writes the same page.

        Args:
            file: ends in ``.html``.
            other: a second solution, shown beside this one.
            force: Whether to replace files other than older pages.

        Raises:
            OSError: it cannot be written; ``FileExistsError`` if another file would be lost.
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
        make_way(name, "report", self._result.inputs(), force)
        page = self._page(os.path.splitext(os.path.basename(name))[0], other)
        _core.write_file(name, page.encode())

    def _page(self, name: str, other: Solution | None = None) -> str:
        self._refuse_functions("shown on a page")
        if other is not None:
            other._refuse_functions("shown on a page")
        page: str = self._result.report(name, None if other is None else other._result, "other")
        return page

    def export(self, file: str | os.PathLike[str], format: str | None = None, *, at: str | None = None,
               unit: str | Sequence[str] | None = None, size: tuple[int, int] | None = None, fps: float | None = None,
               duration: float | None = None, start: float | None = None, end: float | None = None,
               view: str = "fitted", dark: bool = False, names: bool = False, clock: bool = False,
               force: bool = False) -> None:
        """Exports the motion for other programs, or as a picture or video, in the format given by the file ending or by ``format``.

        Videos and pictures need Chromium or Chrome on this machine, which draws them without a window.

        Args:
            file: Its name.
            format: ``"csv"``, ``"npz"``, ``"gltf"``, ``"pvd"``, ``"webm"``, ``"gif"``, ``"png"``, ``"svg"``, as for
                ``livens export``.
            at: Times of CSV rows; see :meth:`to_dataframe`.
            unit: Units of CSV columns, such as ``"deg"``; see :meth:`to_dataframe`.
            size: Width and height of pictures and videos in pixels.
            fps: Frames per second of a video; default 30, for a GIF 20.
            duration: Duration of a video, s; default: that of the motion, or 8 s if that is under 2 s or over 40 s.
            start: Time of a still, or first time of a video, s; default: the start of the motion.
            end: Last time of a video, s.
            view: ``"fitted"``, ``"front"``, ``"side"`` or ``"top"``.
            dark: Whether to use dark colours.
            names: Whether to label bodies with their names.
            clock: Whether to show the time.
            force: Whether to replace files other than older exports.

        Raises:
            OSError: it cannot be written; ``FileExistsError`` if another file would be lost; no browser is found.
            InputError: ``unit``, ``picture``.
        """
        name = file_name(file)
        known = {word: ending for word, ending, _ in _core.export_formats()}
        chosen = format or next((word for word, ending in known.items() if name.endswith(ending)), None)
        if chosen not in known:
            endings = ", ".join(f"{word} ({ending})" for word, ending in known.items())
            raise fault("unknown-choice", f"no format fits '{chosen or name}'", "format",
                        f"there are {endings}; sol.save('run.nc') writes all, sol.report('run.html') shows the motion")
        words = ("auto", "dense", "output", "ends")
        if (at or "auto") not in words:
            raise fault("unknown-choice", f"'{at}' is no choice of instants", "at", "there are 'dense', 'output', 'ends'")
        if view not in ("fitted", "front", "side", "top"):
            raise fault("unknown-choice", f"'{view}' is no view", "view", "there are 'fitted', 'front', 'side', 'top'")
        width, height = (0, 0) if size is None else (int(n) for n in size)
        given = {"fps": fps, "duration": duration, "start": start, "end": end}
        picture = {"width": width, "height": height, "view": view, "dark": bool(dark), "names": bool(names),
                   "clock": bool(clock), **{key: float(value) for key, value in given.items() if value is not None}}
        units = [unit] if isinstance(unit, str) else list(unit or ())
        make_way(name, str(chosen), self._result.inputs(), force)
        options = (name, force, words.index(at or "auto"), units, picture)
        if chosen == "npz":
            import tempfile
            with tempfile.TemporaryDirectory() as folder:   # it copies the variables of a result
                self.save(result := os.path.join(folder, "run.nc"))
                self._result.export_to(chosen, result, *options)
        elif doubt := self._result.export_to(chosen, "", *options):
            warnings.warn(doubt, UserWarning, stacklevel=stack_level())

    def __reduce__(self) -> tuple[Any, ...]:
        self._refuse_functions("pickled")
        return (_unpickled, (self._result.to_bytes(),))

    # For people.

    def _summary(self) -> list[tuple[str, str]]:
        f = self.figures
        rows = [("verdict", str(self._result.headline))]
        rows += [("title", self.title)] if self.title else []
        if self.reasons or not self.success:
            rows.append(("because", "; ".join(self.reasons) or self.message))
        span = f"{self.t[0]:.6g} s to {self.t[-1]:.6g} s"
        rows.append(("method", f"{self.method}, {self.n_elements} elements, {span}"
                     + (f", in {self.seconds:.3g} s" if self.seconds else "")))
        for figure, name, meaning in _core.judged_figures():
            if figure in ("estimated_error", "max_constraint_violation", "energy_drift", "angular_momentum_drift") \
                    and f[figure] is not None:
                rows.append((name, f"{f[figure]:.1e} ({meaning})"))
        if f["arrival"] is not None:
            rows.append(("arrival", f"a rate at the start that is off by 1 mm/s moves it by {f['arrival']:.3g} mm at most"))
        if f["horizon"] is not None:
            rows.append(("horizon", f"{f['horizon']:.3g} s: beyond it rounding decides"))
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


def _last_from_before(times: Floats, ends: Floats) -> Floats:
    """Nothing follows the end of a motion: values there are those just before it."""
    return np.where(times == ends[-1], 1.0, 0.0) if len(ends) > 1 else np.zeros(len(times))


def _unpickled(content: bytes) -> Solution:
    return Solution(_core.from_bytes(content))


def load_solution(file: str | os.PathLike[str]) -> Solution:
    """Reads a result file, written by :meth:`Solution.save` or the program.

    Raises:
        OSError: it cannot be read (``FileNotFoundError``), is no livens result, or is damaged; see ``e.code``.
    """
    name = file_name(file)
    with open(name, "rb"):   # Python's own words for what is not there
        pass
    return Solution(_core.load_result(name))
