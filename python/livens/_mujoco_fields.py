# SPDX-License-Identifier: BSD-3-Clause
"""Fields of MuJoCo's compiled model, whatever its version: names, switches, what older ones do not have."""
from __future__ import annotations

from typing import Any

import numpy as np

from . import _core

FREE, BALL, SLIDE, HINGE = range(4)
WORLD = "world"
TINY = 1e-9   # of the smallest mass: bodies that must have a mass, and have none
_OF_CONSTRAINTS = ("EQUALITY", "FRICTIONLOSS", "LIMIT", "CONTACT")


def is_off(m: Any, what: str) -> bool:
    """Whether ``<option><flag/></option>`` switches it off."""
    import mujoco   # type: ignore[import-not-found,unused-ignore]
    bits = mujoco.mjtDisableBit

    def flag(word: str) -> bool:
        bit = getattr(bits, f"mjDSBL_{word}", None)
        return bit is not None and bool(m.opt.disableflags & int(bit))
    older = what in ("SPRING", "DAMPER") and flag("PASSIVE")
    return flag(what) or older or what in _OF_CONSTRAINTS and flag("CONSTRAINT")


def array(m: Any, field: str, fallback: float = 0.0) -> Any:
    """A field, or that of a model without what it is about."""
    found = getattr(m, field, None)
    if found is not None:
        return np.asarray(found)
    sizes = {"actuator": m.nu, "dof": m.nv, "jnt": m.njnt, "tendon": m.ntendon, "geom": m.ngeom, "body": m.nbody}
    return np.full(sizes[field.partition("_")[0]], fallback)


def original(m: Any, kind: str, i: int) -> str:
    """The name that the file gives; may be empty."""
    begin = int(getattr(m, f"name_{kind}adr")[i])
    content = bytes(m.names)
    return content[begin:content.index(b"\0", begin)].decode("utf-8", "replace")


_WORDS = {"jnt": "joint", "eq": "equality"}


def name_of(m: Any, kind: str, i: int) -> str:
    """A name that a scenario takes: ``"joint 3"`` for what has none."""
    named = original(m, kind, i) or f"{_WORDS.get(kind, kind)} {i}"
    clean = "".join(c if c.isprintable() else " " for c in named)
    while len(clean.encode()) > 160:   # room for what makes it unique
        clean = clean[:-1]
    return clean


def number_of(value: float | str, unit: str) -> float:
    return float(_core.quantity(value, unit)) if isinstance(value, str) else float(value)


class UniqueNames:
    """Bodies, joints and loads are asked for by name, so that each has one of its own."""

    def __init__(self) -> None:
        self._taken = {WORLD}
        self._counts: dict[str, int] = {}

    def of(self, name: str, word: str) -> str:
        """The name, with the word behind it where it is taken."""
        if name in self._taken:
            name = f"{name} {word}"
        stem = name
        while name in self._taken:
            self._counts[stem] = self._counts.get(stem, 1) + 1
            name = f"{stem} {self._counts[stem]}"
        self._taken.add(name)
        return name
