# SPDX-License-Identifier: BSD-3-Clause
"""What is shown of a motion: units that are asked for, peaks, orientations in words of the field."""
from __future__ import annotations

from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from . import _core
from ._errors import fault

if TYPE_CHECKING:
    from collections.abc import Sequence

    from ._parts import Floats


class Peak(NamedTuple):
    """A value of the motion and its time: ``value, t = sol.peak("pivot.force")``.

    Example:
        >>> import livens as lv
        >>> lv.Peak(481.1, 0.48).value
        481.1
    """

    value: float
    """In SI units, or in the unit requested."""
    t: float
    """s."""


class Extremes(NamedTuple):
    """The smallest and the largest value of a motion, with their times.

    Example:
        >>> import livens as lv
        >>> lv.Extremes(min=-3.0, t_min=1.0, max=2.0, t_max=5.0).peak
        Peak(value=-3.0, t=1.0)
    """

    min: float
    """In SI units, or in the unit requested."""
    t_min: float
    """s."""
    max: float
    """Likewise."""
    t_max: float
    """s."""

    @property
    def peak(self) -> Peak:
        """The one farther from zero, with its sign; the earlier one where rounding alone tells them apart."""
        is_low = self.t_min < self.t_max if abs(self.min + self.max) <= 1e-9 * abs(self.max) else -self.min > self.max
        return Peak(self.min, self.t_min) if is_low else Peak(self.max, self.t_max)


def factor_to(unit: str, wanted: str | Sequence[str] | None) -> tuple[float, str]:
    """What numbers in ``unit`` are multiplied with, and the unit then: as it is where none of the wanted fits."""
    wishes = [wanted] if isinstance(wanted, str) else list(wanted or ())
    for one in wishes:
        if not isinstance(one, str):
            raise TypeError(f"units are strings, as 'deg', not {type(one).__name__}")
    factor, shown = _core.shown_unit(unit, wishes)
    return float(factor), str(shown)


def check_units(wanted: str | Sequence[str] | None, units: Sequence[str]) -> None:
    """An unknown unit, or one that nothing shown has, is a slip."""
    for one in ([wanted] if isinstance(wanted, str) else list(wanted or ())):
        if all(factor_to(unit, one)[1] == unit != one for unit in units):
            kinds = ", ".join(dict.fromkeys(units))
            raise fault("unit", f"'{one}' is no unit of what is shown, which is in {kinds}", "unit",
                        "angles: 'deg', 'rev'; rates: 'deg', 'rpm'; lengths: 'mm'; forces: 'kN'")


def found_extremes(result: Any, names: tuple[str, ...], unit: str | Sequence[str] | None) -> dict[str, Extremes]:
    """See Solution.peaks()."""
    for name in names:
        if not isinstance(name, str):
            raise TypeError(f"names are strings, as 'pivot.force', not {type(name).__name__}")
    found = result.peaks(list(names))
    check_units(unit, [row[1] for row in found])
    all_of_them: dict[str, Extremes] = {}
    for name, of, least, t_least, largest, t_largest, lost_at in found:
        if not np.isnan(lost_at) and names:
            raise fault("quantity-unbounded", f"'{name}' is no number at t = {lost_at:.6g} s", "",
                        "point masses have no orientation; where joints lose rank reactions grow without bound")
        factor = factor_to(of, unit)[0]
        all_of_them[name] = Extremes(least * factor, t_least, largest * factor, t_largest)
    return all_of_them


def rotation_of(quaternion: Floats) -> Floats:
    """R with the body's axes as columns."""
    w, x, y, z = np.moveaxis(quaternion, -1, 0)
    rows = [[1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
            [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
            [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)]]
    matrix: Floats = np.moveaxis(np.array(rows), (0, 1), (-2, -1))
    return matrix


def relative_quaternion(of: Floats, seen_from: Floats) -> Floats:
    """conj(seen_from) * of."""
    w, x, y, z = np.moveaxis(seen_from * np.array([1.0, -1.0, -1.0, -1.0]), -1, 0)
    a, b, c, d = np.moveaxis(of, -1, 0)
    product: Floats = np.stack([w * a - x * b - y * c - z * d, w * b + x * a + y * d - z * c,
                                w * c - x * d + y * a + z * b, w * d + x * c - y * b + z * a], axis=-1)
    return product


def rotation_vector_of(quaternion: Floats) -> Floats:
    """Its rotation vector, at most pi long."""
    q = np.where(quaternion[..., :1] < 0, -quaternion, quaternion)
    length = np.linalg.norm(q[..., 1:], axis=-1, keepdims=True)
    angle = 2 * np.arctan2(length, q[..., :1])
    vector: Floats = q[..., 1:] * np.divide(angle, length, out=np.full_like(length, 2.0), where=length > 0)
    return vector


def euler_of(quaternion: Floats, order: str) -> Floats:
    """Angles of turns about the body's own axes, one after another; in a series without jumps by whole turns."""
    word = order.lower() if isinstance(order, str) else ""
    if len(word) != 3 or set(word) - set("xyz") or word[0] == word[1] or word[1] == word[2]:
        raise fault("unknown-choice", f"'{order}' is no order of Euler angles", "order",
                    "three letters of x, y, z, neighbours not alike: 'zyx' (yaw, pitch, roll), 'xyz', 'zxz', ..")
    R = rotation_of(quaternion)
    i, j, k = ("xyz".index(letter) for letter in word)
    sign = 1.0 if (j - i) % 3 == 1 else -1.0   # of the permutation i, j, other
    if i == k:
        other = 3 - i - j
        middle = np.arctan2(np.hypot(R[..., i, j], R[..., i, other]), R[..., i, i])
        first = np.arctan2(R[..., j, i], -sign * R[..., other, i])
        last = np.arctan2(R[..., i, j], sign * R[..., i, other])
    else:
        middle = np.arctan2(sign * R[..., i, k], np.hypot(R[..., i, i], R[..., i, j]))
        first = np.arctan2(-sign * R[..., j, k], R[..., k, k])
        last = np.arctan2(-sign * R[..., i, j], R[..., i, i])
    angles = np.stack([first, middle, last], axis=-1)
    if angles.ndim == 2 and not np.isnan(angles).any():
        angles[:, 0], angles[:, 2] = np.unwrap(angles[:, 0]), np.unwrap(angles[:, 2])
    return angles


def components_along(vectors: Floats, quaternion: Floats) -> Floats:
    """Of vectors in world axes, along those of a body."""
    along: Floats = np.einsum("...ji,...j->...i", rotation_of(quaternion), vectors)
    return along
