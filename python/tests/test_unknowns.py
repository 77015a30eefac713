# SPDX-License-Identifier: BSD-3-Clause
"""Numbers that are found with the motion, from Python."""
from __future__ import annotations

import math
from pathlib import Path
from typing import Any

import pytest

import livens as lv

G = 9.81


def pendulum(damping: Any = 0.0, length: float = 1.0) -> lv.Model:
    """A point on a massless rod, level at the start."""
    m = lv.Model(gravity=(0, 0, -G))
    m.add_body("bob", lv.point(mass=1), position=(length, 0, 0))
    m.add_rod("rod", ("world", (0, 0, 0)), ("bob", (0, 0, 0)), length=length)
    m.add_drag("air", "bob", linear=damping)
    return m


def test_a_release_is_found_from_a_known_state() -> None:
    """A stone that turns with 2 rad/s on a rod of 1 m, without weight, leaves along the tangent."""
    m = lv.Model(gravity=(0, 0, 0))
    m.add_body("stone", lv.point(mass=1), position=(1, 0, 0), velocity=(0, 0, 2))
    m.add_rod("sling", ("world", (0, 0, 0)), ("stone", (0, 0, 0)), length=1, until=lv.unknown(0.2, low=0.05, high=0.45))
    t = 0.3
    x = math.cos(2 * t) - 2 * math.sin(2 * t) * (0.5 - t)
    sol = lv.solve(m, 0.5, elements=10, method=lv.Lobatto(8), start="state", end={"stone.x": x})
    assert sol.unknowns["sling.until"] == pytest.approx(t, abs=1e-11)


def test_a_throw_finds_its_duration() -> None:
    """Thrown at 45 degrees with 10 m/s: back at its height after 2 v sin / g."""
    m = lv.Model(gravity=(0, 0, -G))
    m.add_body("ball", lv.point(mass=0.3))
    v = 10 * math.sqrt(0.5)
    sol = lv.solve(m, lv.unknown(1.0, low=0.2, high=3), elements=6,
                   start={"ball.x": 0, "ball.y": 0, "ball.z": 0, "ball.vx": v, "ball.vy": 0, "ball.vz": v}, end={"ball.z": 0})
    found = sol.unknowns["time.end"]
    assert found == pytest.approx(2 * v / G, rel=1e-11)
    assert sol.t[-1] == pytest.approx(found, rel=1e-14)
    assert sol["ball"].position[-1][0] == pytest.approx(v * found, rel=1e-11)


def test_damping_is_found_and_a_march_confirms_it() -> None:
    there = {"bob.z": -math.sqrt(3) / 2}
    begin = {"bob.y": 0, "bob.z": 0, "bob.vy": 0, "bob.vz": 0}
    sol = lv.solve(pendulum(lv.unknown(0.4, low=0, high=3)), 2, elements=20, method=lv.Lobatto(8), start=begin, end=there)
    c = sol.unknowns["air.linear"]
    march = lv.solve(pendulum(c), 2, elements=40, method=lv.Lobatto(8))
    assert march["bob"].position[-1][2] == pytest.approx(there["bob.z"], abs=1e-9)
    assert 0.1 < c < 3


@pytest.mark.parametrize("accuracy", [1e-4, 1e-7, 1e-10])
def test_an_accuracy_is_one_of_the_number_too(tmp_path: Path, accuracy: float) -> None:
    """The damping that brings it to 30 degrees off the vertical after 2 s, by DOP853 and a root finder."""
    begin = {"bob.y": 0, "bob.z": 0, "bob.vy": 0, "bob.vz": 0}
    sol = lv.solve(pendulum(lv.unknown(0.3, low=0, high=3)), 2, accuracy=accuracy, start=begin, end={"bob.x": 0.5})
    off, told = abs(sol.unknowns["air.linear"] - 0.763693631412843), sol.unknown_errors["air.linear"]
    assert off <= accuracy
    assert off / 3 <= told + 1e-14 and told <= 30 * max(off, 1e-14)
    assert any(note.startswith("found: air.linear = 0.763") and ", within " in note for note in sol.notes)
    sol.save(tmp_path / "found.nc")
    assert lv.load_solution(tmp_path / "found.nc").unknown_errors == sol.unknown_errors
    assert lv.solve(pendulum(0.3), 0.1).unknown_errors == {}


def test_a_march_has_no_unknowns() -> None:
    with pytest.raises(lv.InputError, match="unknown-march|conditions"):
        lv.solve(pendulum(lv.unknown(0.4)), 2)


@pytest.mark.parametrize("degree", [2, 3])
def test_the_error_is_told_where_the_duration_is_found(degree: int) -> None:
    """Two solutions have two durations: their elements are compared. Held against a fine march."""
    begin, there = {"bob.y": 0, "bob.z": 0, "bob.vy": 0, "bob.vz": 0}, {"bob.z": -math.sqrt(3) / 2}
    sol = lv.solve(pendulum(0.4), lv.unknown(2.0, low=0.1), elements=20, method=lv.Lobatto(degree), start=begin, end=there)
    fine = lv.solve(pendulum(0.4), sol.unknowns["time.end"], accuracy=1e-12)
    true = abs(fine["bob"].position[-1] - sol["bob"].position[-1]).max()
    assert true > 1e-9
    assert true / 10 < sol.error < 100 * true


def test_parameters_may_be_unknown() -> None:
    m = lv.Model(gravity=(0, 0, -G))
    m.parameters = {"L": lv.unknown("80 cm", low="50 cm", high="2 m"), "half": "L/2"}
    assert m.parameters["L"] == 0.8 and m.parameters["half"] == 0.4
    m.add_body("arm", lv.box("L", 0.05, 0.05, mass=2), position=("half", 0, 0))
    assert m["arm"].position[0] == 0.4
    m.add_revolute("pivot", "world", "arm", at=(0, 0, 0), axis=(0, 1, 0))
    sol = lv.solve(m, 0.5, elements=10, method=lv.Lobatto(6), start={"pivot.angle": 0, "pivot.angle_rate": 0},
                   end={"pivot.angle": 1.5})
    length = sol.unknowns["L"]
    m.parameters["L"] = 0.7
    assert m.parameters.given["L"] == "0.7 m", "a plain number keeps the unit"
    m.parameters["L"] = length
    march = lv.solve(m, 0.5, elements=20, method=lv.Lobatto(8))
    assert march["pivot"].angle[-1] == pytest.approx(1.5, abs=1e-8)


@pytest.mark.parametrize(("value", "code"), [
    ({"guess": 3}, "wrong-type"),
    ({"unknown": 3, "lwo": 2}, "unknown-key"),
    ({"unknown": 3, "low": "3 kg"}, "unit"),
    ({"unknown": [3]}, "wrong-type"),
    ({"unknown": "3 kgx"}, "expression-syntax"),
])
def test_wrong_unknown_parameters_are_refused_once(value: Any, code: str) -> None:
    m = lv.Model()
    m.parameters = {"L": "1 m"}
    with pytest.raises(lv.InputError) as told:
        m.parameters["L"] = value
    assert [d.code for d in told.value.diagnostics] == [code]
    assert m.parameters["L"] == 1
