# SPDX-License-Identifier: BSD-3-Clause
"""Python functions as conditions of events."""
from __future__ import annotations

from typing import Any

import numpy as np
import pytest

import livens as lv


def pendulum() -> lv.Model:
    m = lv.Model("pendulum", gravity=(0, 0, -9.81))
    rod = m.add_body("rod", lv.box(1, 0.05, 0.05, mass=2), position=(0.5, 0, 0))
    m.add_revolute("pin", "world", rod, at=(0, 0, 0), axis=(0, 1, 0))
    m.add_point_sensor("tip", rod, point=(0.5, 0, 0))
    return m


def test_a_function_is_found_where_its_formula_is() -> None:
    by_formula, by_function = pendulum(), pendulum()
    by_formula.add_event("low", when="tip.z < -0.5 and pin.angle_rate > 0")
    by_function.add_guard("low", lambda t, z, w: min(-0.5 - z, w), of=["tip.z", "pin.angle_rate"])
    one, other = lv.solve(by_formula, 1, accuracy=1e-10), lv.solve(by_function, 1, accuracy=1e-10)
    assert [e.name for e in other.events] == ["low"]
    assert other.events[0].t == pytest.approx(one.events[0].t, abs=1e-12)
    assert other.events[0].error < 1e-9


def test_it_ends_the_motion_by_time_alone_too() -> None:
    m = pendulum()
    m.add_guard("late", lambda t: np.float64(t - 0.25), action="stop")
    sol = lv.solve(m, 1)
    assert sol.stopped_by == "late" and sol.t[-1] == pytest.approx(0.25, abs=1e-14)
    other = m.copy()
    other.remove("late")
    assert lv.solve(other, 1).t[-1] == 1 and len(m.events) == 1


def test_what_it_raises_is_raised() -> None:
    for at in (-1.0, 0.3):   # where the motion begins, and on the way
        def guard(t: float, angle: float, at: float = at) -> float:
            if angle > at:
                raise KeyError("mine")
            return -1

        m = pendulum()
        m.add_guard("bad", guard, of=["pin.angle"])
        with pytest.raises(KeyError, match="mine"):
            lv.solve(m, 1)


def test_what_is_no_number_is_refused() -> None:
    m = pendulum()
    m.add_guard("nan", lambda t: float("nan"))
    with pytest.raises(lv.InputError, match="no number where the motion begins") as refused:
        lv.solve(m, 1)
    assert refused.value.code == "event-not-finite"
    later = pendulum()
    later.add_guard("nan", lambda t: -1.0 if t < 0.5 else float("inf"))
    with pytest.warns(lv.SolveWarning, match="is no number between"):
        lv.solve(later, 1)
    text: Any = "pin.angle"
    with pytest.raises(TypeError, match="list of names"):
        pendulum().add_guard("g", lambda t, x: x, of=text)
    not_callable: Any = 3
    with pytest.raises(TypeError, match="a function is wanted"):
        pendulum().add_guard("g", not_callable)
    with pytest.raises(lv.InputError, match="is a Python function, so the model cannot be written"):
        later.to_toml()


def test_the_end_of_time_takes_words_and_names_guards() -> None:
    until: Any = abs
    with pytest.raises(TypeError, match="add_guard"):
        lv.solve(pendulum(), 1, until=until)
