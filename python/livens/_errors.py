# SPDX-License-Identifier: BSD-3-Clause
"""What can go wrong, and where: diagnostics, exceptions and warnings."""
from __future__ import annotations

import errno
import linecache
import os
import sys
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any, NamedTuple

if TYPE_CHECKING:
    from ._results import Solution

_PACKAGE = __name__.rpartition(".")[0]


class Place(NamedTuple):
    """A source location: file, line and column, counted from 1 (0: not known)."""

    file: str = ""
    line: int = 0
    column: int = 0
    length: int = 1


def user_place() -> Place:
    """The line outside of this package that is being executed."""
    frame = sys._getframe(1)
    while frame.f_back is not None:
        name = frame.f_globals.get("__name__", "")
        if name != _PACKAGE and not name.startswith(_PACKAGE + "."):
            break
        frame = frame.f_back
    return Place(frame.f_code.co_filename, frame.f_lineno)


def stack_level() -> int:
    """For warnings.warn() of the caller: the user's line."""
    frame, level = sys._getframe(1), 1
    while frame.f_back is not None:
        name = frame.f_globals.get("__name__", "")
        if name != _PACKAGE and not name.startswith(_PACKAGE + "."):
            break
        frame, level = frame.f_back, level + 1
    return level


def _shown(text: str) -> str:
    """A line of a file without what moves a terminal's cursor."""
    return "".join(c if c.isprintable() else "\N{REPLACEMENT CHARACTER}" for c in text.expandtabs(4))


@dataclass(frozen=True)
class Diagnostic:
    """One finding in a model, as :meth:`livens.Model.check` lists them.

    ``str(d)`` formats it with the source line that it refers to, as the program does.

    Example:
        >>> import livens as lv
        >>> m = lv.Model("empty")
        >>> [d.code for d in m.check()]
        ['missing-key']
    """

    severity: str
    """``"error"`` or ``"warning"``."""
    code: str
    """Stable code, explained by :func:`livens.explain`: ``"body-unknown"``."""
    message: str
    """The message, one sentence."""
    path: str = ""
    """The place in the model: ``"joint[pivot].between"``."""
    note: str = ""
    """The rule that is violated; may be empty."""
    help: str = ""
    """The likely fix; may be empty."""
    place: Place = field(default=Place(), compare=False)
    """File and line where it was written: a scenario file, or Python code."""
    source: str = field(default="", compare=False, repr=False)
    """The text of this line, if known."""

    @property
    def file(self) -> str:
        """Name of the file; empty if not known."""
        return self.place.file

    @property
    def line(self) -> int:
        """Line in the file, from 1; 0: the whole file, or not known."""
        return self.place.line

    def __str__(self) -> str:
        lines = [f"{self.message} [{self.code}]"]
        if self.place.file:
            where = _shown(self.place.file)
            if self.place.line:
                where += f":{self.place.line}"
            if self.place.column:
                where += f":{self.place.column}"
            lines.append(f"  --> {where}")
            text = self.source or linecache.getline(self.place.file, self.place.line)
            if text.strip() and self.place.line:
                cut = _shown(text.rstrip())
                indent = 0 if self.place.column else len(cut) - len(cut.lstrip())
                lines.append(f"   | {cut[indent:][:120]}")
                if 0 < self.place.column <= 120:
                    marks = "^" * max(1, min(self.place.length, 120 - self.place.column))
                    lines.append("   | " + " " * (self.place.column - 1) + marks)
        elif self.path:
            lines.append(f"  --> {_shown(self.path)}")
        if self.note:
            lines.append(f"  note: {self.note}")
        if self.help:
            lines.append(f"  help: {self.help}")
        return "\n".join(lines)


class InputError(ValueError):
    """An error in a model or in the arguments of a call; a ``ValueError``.

    The call that raised it has changed nothing.

    Example:
        >>> import livens as lv
        >>> m = lv.Model("pendulum")
        >>> try:
        ...     m.add_body("rod", lv.box(1, 0.1, 0.1), mass="2 s")
        ... except lv.InputError as e:
        ...     print(e.code, e.path)
        unit body[rod].mass
    """

    diagnostics: list[Diagnostic]
    """All findings; the other attributes refer to the first of them."""

    def __init__(self, diagnostics: list[Diagnostic]) -> None:
        more = len(diagnostics) - 1
        text = str(diagnostics[0])
        if more > 0:
            text += f"\n({more} more in .diagnostics)"
        super().__init__(text)
        self.diagnostics = diagnostics

    def __reduce__(self) -> tuple[Any, ...]:
        return (type(self), (self.diagnostics,))

    @property
    def code(self) -> str:
        """Stable code, explained by :func:`livens.explain`."""
        return self.diagnostics[0].code

    @property
    def path(self) -> str:
        """The place in the model: ``"joint[pivot].between"``; may be empty."""
        return self.diagnostics[0].path

    @property
    def help(self) -> str:
        """The likely fix; may be empty."""
        return self.diagnostics[0].help

    @property
    def note(self) -> str:
        """The rule that is violated; may be empty."""
        return self.diagnostics[0].note

    @property
    def file(self) -> str:
        """The file that contains the error: a scenario, or Python code."""
        return self.diagnostics[0].file

    @property
    def line(self) -> int:
        """Its line, from 1; 0 if not known."""
        return self.diagnostics[0].line


class ResultFileError(OSError):
    """A file that cannot be read or written, or has the wrong content; an ``OSError``."""

    code: str
    """Explained by :func:`livens.explain`."""

    def __init__(self, message: str, code: str = "io") -> None:
        super().__init__(message)
        self.code = code

    def __reduce__(self) -> tuple[Any, ...]:
        return (type(self), (str(self), self.code))


class SolveError(RuntimeError):
    """Raised by ``livens.solve(..., strict=True)`` where only a warning would be issued otherwise.

    Example:
        >>> import livens as lv
        >>> m = lv.Model("pendulum", gravity=(0, 0, -9.81))
        >>> rod = m.add_body("rod", lv.box(1, 0.05, 0.05, density=7850), position=(0.5, 0, 0))
        >>> pivot = m.add_revolute("pivot", "world", rod, at=(0, 0, 0), axis=(0, 1, 0))
        >>> try:
        ...     sol = lv.solve(m, 10, elements=4, method="midpoint", strict=True)
        ... except lv.SolveError as e:
        ...     print(e.partial.status)
        suspect
    """

    partial: Solution
    """The solution: up to the time of failure, or the whole motion if it is suspect."""

    def __init__(self, message: str, partial: Solution) -> None:
        super().__init__(message)
        self.partial = partial

    def __reduce__(self) -> tuple[Any, ...]:
        return (type(self), (str(self), self.partial))


class SolveWarning(UserWarning):
    """The motion did not converge, or fails the acceptance checks."""


class ModelWarning(UserWarning):
    """The model can be solved, but is unusual or possibly wrong."""


class SlowWarning(UserWarning):
    """A Python function as a load is called at every evaluation: thousands of times slower than an expression."""


def fault(code: str, message: str, path: str = "", help: str = "", note: str = "",
          place: Place | None = None) -> InputError:
    """An error that this package finds itself, by default at the user's line."""
    return InputError([Diagnostic("error", code, message, path, note, help, place or user_place())])


def raised(found: list[Diagnostic]) -> InputError:
    """Of several errors those first that explain the others: a misspelt key is also a missing one."""
    first = ("unknown-key", "misplaced-key", "wrong-type", "unit")
    return InputError(sorted(found, key=lambda d: (d.severity != "error", d.code not in first)))


def from_engine(code: str, path: str, message: str, note: str, help: str) -> InputError:
    """For the compiled part."""
    return fault(code, message, path, help, note)


def from_files(code: str, message: str) -> OSError:
    """For the compiled part."""
    return ResultFileError(message, code)


def need(module: str, extra: str, what: str) -> Any:
    """Imports an optional module, or says how to get it."""
    import importlib
    try:
        return importlib.import_module(module)
    except ImportError as error:
        raise ImportError(f"{what} needs {module.partition('.')[0]}: "
                          f"pip install 'livens[{extra}]'") from error


def make_way(name: str, kind: str, inputs: list[str], force: bool) -> None:
    """Raises FileExistsError if what stands at ``name`` is not to be replaced by a file of this kind."""
    from . import _core
    why = _core.objection(name, kind, inputs, force)
    if why:
        raise FileExistsError(errno.EEXIST, why, name)


def file_name(file: str | os.PathLike[str]) -> str:
    """A path as a string; anything else is refused by its type."""
    name = os.fspath(file)
    if not isinstance(name, str):
        raise TypeError(f"a file name is a string or a path, not {type(file).__name__}")
    if "\0" in name:
        raise fault("io-not-found", "a file name has no zero bytes")
    return name
