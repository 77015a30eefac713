# SPDX-License-Identifier: BSD-3-Clause
"""Points with names, models that are added to models, and files that include files."""
import pathlib
import pickle
from typing import Any

import numpy as np
import pytest

import livens as lv


def leg(gravity: Any = None) -> lv.Model:
    m = lv.Model("leg", gravity=gravity)
    thigh = m.add_body("thigh", lv.box(0.05, 0.05, 0.4, mass=2), position=(0, 0, -0.2))
    shin = m.add_body("shin", lv.box(0.04, 0.04, "40 cm", mass=1), position=(0, 0, -0.6), velocity=(0, 0, 0))
    m.add_point("foot", shin, (0, 0, -0.2))
    m.add_revolute("hip", "world", thigh, at=(0, 0, 0), axis=(0, 1, 0))
    m.add_revolute("knee", thigh, shin, at=(0, 0, -0.4), axis=(0, 1, 0), rate=1)
    m.add_actuator("muscle", "knee", expression="-3*knee.angle - foot.x + sin(3*t)")
    m.add_force("wind", thigh, value=(1, 0.5, 0))
    m.add_point_sensor("tip", point="foot")
    return m


def test_points_stand_for_coordinates() -> None:
    m = lv.Model("two", gravity=(0, 0, -9.81))
    a = m.add_body("a", lv.box(1, 0.1, 0.1, mass=2), position=(0.5, 0, 0))
    hook = m.add_point("hook", "world", (0, 0, "1 m"))
    tip = m.add_point("tip", a, (0.5, 0, 0))
    m.add_spherical("pivot", "world", a, at=(0, 0, 0))
    spring = m.add_spring("spring", hook, tip, stiffness=100, free_length=1)
    assert spring.points == ("hook", "tip") and spring.between is None
    assert m.add_rod(None, points=("hook", "tip")).name == "rod hook-tip"
    m.remove("rod hook-tip")
    assert m.add_force(None, "tip", value=(0, 0, 1)).name == "force on tip"
    assert m.add_force("push", point=tip, value=(0, 0, 1)).point == "tip"
    assert m["tip"].body == "a" and m.points["tip"] == tip and list(m.points) == ["hook", "tip"]
    m.add_force("spring back", a, expression=("0", "-tip.y", "-5*tip.z - tip.vz"))
    sol = lv.solve(m, 0.5, elements=20)
    of_body = sol["a"].point((0.5, 0, 0))
    for name in ("position", "velocity", "acceleration"):
        assert np.array_equal(getattr(sol["tip"], name), getattr(of_body, name))
    assert sol["hook"].position.shape == sol["tip"].position.shape
    assert (sol["hook"].position == (0, 0, 1)).all() and not sol["hook"].velocity.any()
    assert sol(0.25)["tip"].position.shape == (3,)
    assert "tip" in sol and list(sol.points) == ["hook", "tip"]
    assert sol.to_dataframe("tip").columns[0] == "tip.position.x"
    assert lv.load(text=m.to_toml()) == m
    assert "point 'tip'" in repr(sol["tip"])


@pytest.mark.parametrize("call, code", [
    (lambda m: m.add_point("a", "a"), "name-duplicate"),
    (lambda m: m.add_point("tip", "b"), "body-unknown"),
    (lambda m: m.add_force("f", point="tpi", value=(0, 0, 1)), "point-unknown"),
    (lambda m: m.add_force("f", value=(0, 0, 1)), "missing-key"),
])
def test_points_that_are_wrong_are_refused_where_they_are_written(call: Any, code: str) -> None:
    m = lv.Model("one")
    m.add_body("a", lv.sphere(0.1, mass=1))
    m.add_point("top", "a", (0, 0, 0.1))
    before = m.copy()
    with pytest.raises(lv.InputError) as error:
        call(m)
    assert error.value.code == code and m == before
    assert error.value.diagnostics[0].file.endswith("test_parts.py")


def test_a_model_that_is_added_moves_as_it_did() -> None:
    alone = lv.solve(leg(), 1, elements=40)
    turn = (0.3, -0.4, 0.5)
    m = lv.Model("moved")
    part = m.add(leg(), "left ", position=(1, 2, 3), rotation_vector=turn)
    assert list(part) == ["thigh", "shin", "foot", "hip", "knee", "muscle", "wind", "tip"] and part["foot"] == "left foot"
    moved = lv.solve(m, 1, elements=40)
    one = lv.Model()
    one.add_body("b", lv.sphere(1, mass=1), rotation_vector=turn)
    R = lv.solve(one, 1, elements=1)["b"].rotation[0]
    for name in ("thigh", "shin"):
        a, b = alone[name], moved["left " + name]
        assert np.abs(a.position @ R.T + (1, 2, 3) - b.position).max() < 1e-11
        assert np.abs(a.velocity @ R.T - b.velocity).max() < 1e-11
        assert np.abs(R @ a.rotation - b.rotation).max() < 1e-11
    assert np.abs(alone["hip"].force @ R.T - moved["left hip"].force).max() < 1e-9
    assert np.abs(alone["knee"].angle - moved["left knee"].angle).max() < 1e-11
    assert np.abs(alone["tip"].x - moved["left tip"].x).max() < 1e-11, "a sensor reads along the axes of its part"
    assert np.abs(alone["foot"].position @ R.T + (1, 2, 3) - moved["left foot"].position).max() < 1e-11
    unturned = lv.Model("not turned")
    unturned.add(leg(), "left ", position=(1, 2, 3))
    wrong = lv.solve(unturned, 1, elements=40)
    assert np.abs(wrong["left shin"].position - moved["left shin"].position).max() > 0.1


def test_models_are_added_and_written() -> None:
    m = lv.Model("walker", gravity=(0, 0, -9.81))
    left = m.add(leg(), "left ", position=(0, "10 cm", 0))
    right = m.add(leg((0, 0, -9.81)), "right ", position=(0, -0.1, 0), rotation=np.diag((-1.0, -1.0, 1.0)))
    m.add_spring("band", left["foot"], right["foot"], stiffness=20, free_length=0.1)
    m.add_actuator("servo", right["knee"], expression="-2*'left knee'.angle")
    again = lv.load(text=m.to_toml())
    assert again == m and hash(again) == hash(m) and pickle.loads(pickle.dumps(m)) == m
    assert lv.solve(again, 0.5, elements=10)["right shin"].position.tolist() == \
        lv.solve(m, 0.5, elements=10)["right shin"].position.tolist()
    assert not m.check()
    outer = lv.Model("nested", gravity=(0, 0, -9.81))
    names = outer.add(m, "b.", position=(3, 0, 0))
    assert names["left foot"] == "b.left foot" and names["band"] == "b.band"
    assert lv.load(text=outer.to_toml()) == outer
    assert lv.solve(outer, 0.1, elements=4)["b.left foot"].position[0].round(9).tolist() == [3.0, 0.1, -0.8]


def test_what_cannot_be_added_changes_nothing(tmp_path: pathlib.Path) -> None:
    m = lv.Model("m", gravity=(0, 0, -9.81))
    m.add(leg(), "left ")
    before = m.copy()
    with pytest.raises(lv.InputError, match="left (thigh|shin)") as error:
        m.add(leg(), "left ")
    assert error.value.code == "name-duplicate"
    with pytest.raises(lv.InputError) as error:
        m.add(leg((0, 0, -1.62)), "moon ")
    assert error.value.code == "gravity-differs"
    with pytest.raises(lv.InputError) as error:
        m.add(leg(), "x ", rotation=2 * np.eye(3))
    assert error.value.code == "joint-frames"
    slow = leg()
    with pytest.warns(lv.SlowWarning):
        slow.add_function("f", "thigh", lambda t, body: (0, 0, 1))
    with pytest.raises(lv.InputError) as error:
        m.add(slow, "slow ")
    assert error.value.code == "python-function"
    with pytest.raises(KeyError, match="did you mean 'foot'"):
        m.copy().add(leg(), "r ")["fot"]
    with pytest.raises(lv.InputError) as error:
        m.add_rod("bar", "left thigh", "left shn", points=((0, 0, 0), (0, 0, 0)))
    assert error.value.code == "body-unknown" and "left shin" in str(error.value)
    assert m == before


def test_files_include_files(tmp_path: pathlib.Path) -> None:
    (tmp_path / "parts").mkdir()
    leg().to_toml(tmp_path / "parts" / "leg.toml")
    (tmp_path / "parts" / "leg.toml").write_text(leg().to_toml() + "[time]\nend = 1\n")
    whole = 'format = 1\n[[include]]\nfile = "parts/leg.toml"\nprefix = "l."\nposition = [1, 0, 0]\n[time]\nend = 0.5\n'
    (tmp_path / "whole.toml").write_text(whole)
    m = lv.load(tmp_path / "whole.toml")
    sol = lv.solve(m, elements=10)
    assert sol["l.foot"].position[0].round(9).tolist() == [1.0, 0.0, -0.8]
    m.add_point_sensor("watch", point="l.foot")        # edited: the tree is read, with the file in it
    assert lv.solve(m, elements=10)["watch"].x[0] == pytest.approx(1)
    sol.save(tmp_path / "run.nc")
    (tmp_path / "parts" / "leg.toml").unlink()
    assert lv.load_solution(tmp_path / "run.nc")["l.foot"].position[0].round(9).tolist() == [1.0, 0.0, -0.8]
    (tmp_path / "parts" / "leg.toml").write_text(leg().to_toml().replace("mass = 2", "mass = -2") + "[time]\nend = 1\n")
    with pytest.raises(lv.InputError) as error:
        lv.load(tmp_path / "whole.toml")
    fault = error.value.diagnostics[0]
    assert fault.file.endswith("leg.toml") and "mass = -2" in str(error.value) and fault.line > 1
    outer = lv.Model("outer")
    other = lv.load(tmp_path / "whole.toml", check=False)
    with pytest.raises(lv.InputError) as error:
        outer.add(other, "x ")
    assert error.value.code == "include-path"
