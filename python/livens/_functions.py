# SPDX-License-Identifier: BSD-3-Clause
"""Functions of Python as loads."""
from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np


class BodyState:
    """The state of a body, passed to a Python function that acts as a load; see :meth:`Model.add_function`."""

    __slots__ = ("position", "directors", "velocity", "angular_velocity")

    def __init__(self, position: Any, directors: Any, velocity: Any, angular_velocity: Any) -> None:
        self.position = np.array(position)
        """Reference point, m, world axes, shape (3,)."""
        self.directors = np.array(directors)
        """Rows d1, d2, d3 in world axes, shape (3, 3)."""
        self.velocity = np.array(velocity)
        """Of the reference point, m/s, world axes, shape (3,)."""
        self.angular_velocity = np.array(angular_velocity)
        """rad/s, world axes, shape (3,)."""


def adapted(function: Callable[..., Any]) -> Callable[..., tuple[float, ...]]:
    def call(t: float, *state: Any) -> tuple[float, ...]:
        given = np.asarray(function(t, BodyState(*state)), dtype=float).ravel()
        if given.size not in (3, 6):
            raise ValueError(f"a load has three numbers (force) or six (force, torque), not {given.size}")
        return tuple(given.tolist()) + (0.0,) * (6 - given.size)
    return call
