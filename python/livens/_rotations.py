# SPDX-License-Identifier: BSD-3-Clause
"""Orientations as other packages have them: SciPy's Rotation, rotation matrices, quaternions with the scalar last."""
from __future__ import annotations

import warnings
from collections.abc import Mapping
from typing import Any

import numpy as np

from ._errors import ModelWarning, fault, stack_level

ORIENTATIONS = ("directors", "quaternion", "rotation_vector")


def is_rotation(value: Any) -> bool:
    """A Rotation of SciPy, or what behaves like one."""
    return hasattr(value, "as_quat") and hasattr(value, "as_matrix")


def as_key(value: Any, name: str) -> Any:
    """A Rotation as one of the keys of an orientation has it."""
    matrix = np.asarray(value.as_matrix(), dtype=float)
    if matrix.shape != (3, 3):
        raise fault("wrong-type", "one rotation is wanted, not several", name)
    if name == "directors":
        return matrix.T
    if name == "rotation_vector":
        return np.asarray(value.as_rotvec(), dtype=float)
    x, y, z, w = (float(q) for q in np.asarray(value.as_quat(), dtype=float))
    return (w, x, y, z)


def with_rotation(content: Mapping[str, Any]) -> dict[str, Any]:
    """``rotation=`` as one of the keys of scenarios: a Rotation as quaternion, a matrix as directors."""
    made = dict(content)
    value = made.get("rotation")
    if value is None or isinstance(value, str):
        return made
    given = [name for name in ORIENTATIONS if made.get(name) is not None]
    if given:
        raise fault("orientation-conflict", f"'rotation' and '{given[0]}' exclude each other", "rotation", "keep one of them")
    name, value = oriented(value)
    if name:
        del made["rotation"]
        made[name] = value
    return made


def oriented(value: Any) -> tuple[str, Any]:
    """(key, value) of what ``rotation`` is given; ("", value) for what is no rotation."""
    if is_rotation(value):
        return "quaternion", as_key(value, "quaternion")
    try:
        matrix = np.asarray(value, dtype=float)
    except (TypeError, ValueError):
        return "", value
    return ("directors", matrix.T) if matrix.shape == (3, 3) else ("", value)


def doubt(value: Any) -> None:
    """Warns of an array that is most likely (x, y, z, w): as (w, x, y, z) it would be a half turn about a skew axis."""
    if not isinstance(value, np.ndarray) or value.shape != (4,) or value.dtype.kind != "f" or value[0] != 0:
        return
    is_about_axis = np.count_nonzero(value) == 1
    if value[3] > 0 and (not is_about_axis or value[3] == 1):
        x, y, z = (f"{q:.3g}" for q in value[1:])
        warnings.warn(f"quaternions are (w, x, y, z): this one is a half turn about ({x}, {y}, {z}); SciPy's as_quat() has "
                      "the scalar last: give the Rotation itself, rotation=R", ModelWarning, stacklevel=stack_level())
