# SPDX-License-Identifier: BSD-3-Clause
"""Ropes over points and couplings by a law, against SciPy's DOP853 where the package has no say."""
from __future__ import annotations

import pathlib
from typing import Any

import numpy as np
import pytest

import livens as lv

G = 9.81


def swinging(**keys: Any) -> lv.Model:
    m = lv.Model("swinging", gravity=(0, 0, -G))
    m.add_body("bob", lv.sphere(0.05, mass=1), position=(0.6, 0, -0.8))
    m.add_body("counterweight", lv.sphere(0.07, mass=2.5), position=(-1, 0, -1))
    m.add_rod("rope", over=["bob", ("world", (0, 0, 0)), ("world", (-1, 0, 0)), "counterweight"], **keys)
    return m


def swung(t: float, mass: float = 2.5) -> Any:
    """r, r', angle, angle' of the bob: (1 + M) r'' = r a'^2 + g cos a - M g, r a'' = -2 r' a' - g sin a."""
    integrate = pytest.importorskip("scipy.integrate")

    def slopes(_: float, y: Any) -> list[float]:
        r, v, a, w = y
        return [v, (r * w * w + G * np.cos(a) - mass * G) / (1 + mass), w, (-2 * v * w - G * np.sin(a)) / r]
    start = [1.0, 0.0, np.arctan2(0.6, 0.8), 0.0]
    return integrate.solve_ivp(slopes, (0, t), start, method="DOP853", rtol=1e-13, atol=1e-13).y[:, -1]


def test_the_swinging_atwood_machine_is_that_of_dop853() -> None:
    sol = lv.solve(swinging(), 1.5, accuracy=1e-11)
    r, v, a, w = swung(1.5)
    assert sol["bob"].position[-1] == pytest.approx([r * np.sin(a), 0, -r * np.cos(a)], abs=1e-9)
    assert sol["counterweight"].position[-1, 2] == pytest.approx(-1 + (r - 1), abs=1e-9)
    tension = 2.5 * (G + (r * w * w + G * np.cos(a) - 2.5 * G) / 3.5)
    assert sol["rope"].tension[-1] == pytest.approx(tension, abs=1e-7)
    assert sol["rope"].unit("tension") == "N"
    assert "tension" in sol["rope"].arrays()
    other = swung(1.5, 2.5001)
    assert abs(other[0] - r) > 1e-6   # the comparison tells


def test_a_rope_is_written_and_read_again(tmp_path: pathlib.Path) -> None:
    m = swinging(length="3 m")
    m.add_point("hook", "bob", (0, 0, 0.05))
    m.add_spring("cord", over=["hook", ("world", (1, 0, 0)), ("counterweight", (0, 0, 0.07))], stiffness="2 N/mm", free_length=3)
    text = m.to_toml()
    assert '{ body = "world", point = [-1, 0, 0] }' in text and '{ point = "hook" }' in text
    again = lv.load(text=text)
    assert again.to_toml() == text


def test_bodies_and_points_are_taken_as_everywhere() -> None:
    m = lv.Model("free", gravity=(0, 0, -G))
    a = m.add_body("a", lv.sphere(0.05, mass=1), position=(0, 0, -1))
    hook = m.add_point("hook", "world", (0.5, 0, 0))
    m.add_rod(None, over=[("world", (0, 0, 0)), {"body": a}, hook])
    assert list(m.joints) == ["rod world-a-hook"]
    with pytest.raises(lv.InputError) as caught:
        m.add_rod("one", over=[a])
    assert caught.value.code == "rope-points"
    with pytest.raises(lv.InputError) as caught:
        m.add_rod("none", over=["b", a])
    assert caught.value.code == "body-unknown"


def test_a_tackle_at_rest_tells_its_tension() -> None:
    m = lv.Model("tackle", gravity=(0, 0, -G))
    m.add_body("block", lv.box(0.2, 0.1, 0.1, mass=5), position=(0, 0, -1))
    m.add_body("weight", lv.box(0.1, 0.1, 0.1, mass=2.5), position=(1, 0, -1))
    m.add_rod("rope", over=[("world", (-0.1, 0, 0)), ("block", (-0.1, 0, 0)), ("block", (0.1, 0, 0)), ("world", (0.1, 0, 0)),
                            ("world", (1, 0, 0)), "weight"])
    rest = m.find_equilibrium()
    assert rest["rope"].tension == pytest.approx(2.5 * G, rel=1e-10)
    assert np.isnan(rest["rope"].effort)


def camshaft(law: dict[str, Any]) -> lv.Model:
    m = lv.Model("cam")
    m.add_body("wheel", mass=1, inertia=(0.2, 0.2, 0.2), angular_velocity=(0, 0, 9))
    m.add_body("follower", mass=2, inertia=(1, 1, 1), position=(1, 0, 0))
    m.add_revolute("shaft", "world", "wheel", at=(0, 0, 0), axis=(0, 0, 1))
    m.add_prismatic("slide", "world", "follower", at=(1, 0, 0), axis=(1, 0, 0))
    m.add_coupling("cam", {"slide.displacement": 1}, law=law)
    return m


def test_a_cam_keeps_its_law_over_many_turns() -> None:
    m = camshaft({"of": "shaft.angle", "expression": "0.2*(1 - cos(angle))"})
    sol = lv.solve(m, 5, accuracy=1e-10)
    angle = sol["shaft"].angle
    assert angle[-1] > 4 * 2 * np.pi
    assert sol["slide"].displacement == pytest.approx(0.2 * (1 - np.cos(angle)), abs=1e-9)
    energy = 0.2 * sol["shaft"].angle_rate ** 2 + 2 * sol["slide"].displacement_rate ** 2
    assert energy == pytest.approx(0.2 * 81, rel=1e-9)
    rows = np.linspace(0, 2 * np.pi, 73)
    values = 0.2 * (1 - np.cos(rows))
    values[-1] = values[0]
    table = camshaft({"of": "shaft.angle", "coordinates": rows, "values": values, "periodic": True})
    assert lv.solve(table, 5)["shaft"].angle[-1] == pytest.approx(angle[-1], abs=1e-3)
    assert '"slide.displacement" = 1' in table.to_toml() and "periodic = true" in table.to_toml()


def test_what_is_wrong_with_a_law_is_told_at_once() -> None:
    for law, code in (({"of": "shaft.angle"}, "coupling-law"),
                      ({"of": "slide.displacement", "expression": "displacement"}, "coupling-terms"),
                      ({"of": "shaft.angle", "coordinates": [0, 1, 1], "values": [0, 1, 2]}, "table-order"),
                      ({"of": "shfat.angle", "expression": "angle"}, "joint-unknown")):
        with pytest.raises(lv.InputError) as caught:
            camshaft(law)
        assert caught.value.code == code


def test_a_law_is_judged_at_the_start_that_is_solved() -> None:
    m = camshaft({"of": "shaft.angle", "coordinates": [1, 2, 3], "values": [0, 0.1, 0.3]})
    assert [d.code for d in m.check() if d.severity == "error"] == ["coupling-range"]
    m.start.initial = "project"
    m.start.coordinates = [{"joint": "shaft", "value": 1.5, "rate": 9}]
    sol = lv.solve(m, 0.05)
    assert sol["shaft"].angle[0] == pytest.approx(1.5, abs=1e-12) and sol["shaft"].angle_rate[0] == pytest.approx(9, abs=1e-12)
