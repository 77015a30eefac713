# SPDX-License-Identifier: BSD-3-Clause
"""What an import does not keep as it is: each kind is reported once, with how often it happened and to what."""
from __future__ import annotations

from dataclasses import dataclass

from ._errors import Diagnostic, InputError, Place

_MOST_NAMED = 6


@dataclass(frozen=True)
class Loss:
    """Its message stands before the count: "contacts are not kept: 6 geoms ('floor', ..)"."""

    code: str   # import-lost, import-mended or import-merged
    one: str
    many: str
    message: str
    changes_motion: bool = False   # a strict import refuses it
    help: str = ""
    names_all: bool = False


def lost(one: str, message: str, help: str = "", many: str = "") -> Loss:
    """Of what changes the motion."""
    return Loss("import-lost", one, many or one + "s", message, True, help)


def unseen(one: str, message: str, help: str = "", many: str = "") -> Loss:
    """Of what does not change the motion."""
    return Loss("import-lost", one, many or one + "s", message, False, help)


class Losses:
    """In the order in which kinds were found."""

    def __init__(self) -> None:
        self._all: dict[Loss, list[str]] = {}

    def add(self, kind: Loss, name: str = "", count: int = 1) -> None:
        """``name`` may be empty."""
        self._all.setdefault(kind, []).extend([name] * count)

    def report(self, is_strict: bool, place: Place) -> tuple[Diagnostic, ...]:
        """All of them, as warnings; if strict, those that change the motion are raised as errors."""
        told = tuple(self._told(kind, names, is_strict, place) for kind, names in self._all.items())
        errors = [d for d in told if d.severity == "error"]
        if errors:
            raise InputError(errors)
        return told

    @staticmethod
    def _told(kind: Loss, names: list[str], is_strict: bool, place: Place) -> Diagnostic:
        shown = [f"'{name}'" for name in dict.fromkeys(names) if name]
        left = 0 if kind.names_all else max(0, len(shown) - _MOST_NAMED)
        text = ", ".join(shown[:len(shown) - left]) + (f" and {left} more" if left else "")
        message = f"{kind.message}: {len(names)} {kind.one if len(names) == 1 else kind.many}" + (f" ({text})" if text else "")
        severity = "error" if is_strict and kind.changes_motion else "warning"
        return Diagnostic(severity, kind.code, message, "", "", kind.help, place)
