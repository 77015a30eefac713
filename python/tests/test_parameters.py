# SPDX-License-Identifier: BSD-3-Clause
"""Parameters: numbers with names, and what is computed from them, in models and in scenarios."""
from __future__ import annotations

import copy
import pathlib
import pickle
import warnings

import numpy as np
import pytest

import livens as lv

SWING = """format = 1
gravity = [0, 0, "-g"]

[parameters]
L = "400 mm"   # its length
g = 9.81
n = 2

[[body]]
name = "arm"
shape = { box = ["L", "L/10", "L/10"] }
mass = "n*1 kg"
position = ["L/2", 0, 0]

[[repeat]]
count = "n"
[[repeat.body]]
name = "ball {i}"
shape = { sphere = "L/10" }
mass = "i"
position = [0, "i*L", 0]

[[joint]]
name = "shaft"
type = "revolute"
between = ["world", "arm"]
at = [0, 0, 0]
axis = [0, 1, 0]

[time]
end = "L*1 s/(400 mm)"
elements = "5*n"
"""


def test_numbers_of_a_model_are_computed() -> None:
    m = lv.Model("arm", gravity=(0, 0, -9.81))
    m.parameters = {"width": "L/10", "L": "400 mm", "mass": "2 kg"}
    rod = m.add_body("rod", lv.box("L", "width", "width", mass="2*mass"), position=("L/2", 0, 0))
    pivot = m.add_revolute("pivot", "world", rod, at=(0, 0, 0), axis=(0, 1, 0))
    spring = m.add_spring("spring", joint=pivot, stiffness="mass*L^2*3 1/s^2")
    assert dict(m.parameters) == {"width": 0.04, "L": 0.4, "mass": 2}
    assert m.parameters.given == {"width": "L/10", "L": "400 mm", "mass": "2 kg"}
    assert rod.mass == 4 and rod.position.tolist() == [0.2, 0, 0]
    assert spring.stiffness == pytest.approx(2 * 0.16 * 3)
    m.parameters["L"] = 0.5
    assert m.parameters.given["L"] == "0.5 m", "a plain number keeps the unit"
    assert rod.position.tolist() == [0.25, 0, 0]
    by_hand = lv.Model("arm", gravity=(0, 0, -9.81))
    own = by_hand.add_body("rod", lv.box(0.5, 0.05, 0.05, mass=4), position=(0.25, 0, 0))
    joint = by_hand.add_revolute("pivot", "world", own, at=(0, 0, 0), axis=(0, 1, 0))
    by_hand.add_spring("spring", joint=joint, stiffness=2 * 0.25 * 3)
    a, b = lv.solve(m, 1, elements=8), lv.solve(by_hand, 1, elements=8)
    np.testing.assert_allclose(a["pivot"].angle, b["pivot"].angle, rtol=0, atol=1e-14)


def test_models_with_parameters_are_values() -> None:
    m = lv.load(text=SWING)
    for other in (m.copy(), copy.deepcopy(m), pickle.loads(pickle.dumps(m)), lv.load(text=m.to_toml())):
        assert other == m and dict(other.parameters) == dict(m.parameters)
    assert m.to_toml() == SWING
    m.parameters["g"] = 1.62
    assert "[parameters]\n" in m.to_toml() and lv.load(text=m.to_toml()).gravity.tolist() == [0, 0, -1.62]
    changed = m.copy()
    changed.parameters["L"] = 1
    assert m.parameters["L"] == 0.4 and changed.parameters["L"] == 1
    del changed.parameters["n"]
    assert list(changed.parameters) == ["L", "g"]
    assert any("no parameter 'n'" in d.message for d in changed.check())


def test_load_sets_parameters(tmp_path: pathlib.Path) -> None:
    file = tmp_path / "swing.toml"
    file.write_text(SWING)
    m = lv.load(file, parameters={"L": 0.2, "n": 3})
    assert dict(m.parameters) == {"L": 0.2, "g": 9.81, "n": 3}
    assert list(m.bodies) == ["arm", "ball 1", "ball 2", "ball 3"]
    assert m["ball 3"].mass == 3 and m["ball 3"].position.tolist() == [0, pytest.approx(0.6), 0]
    assert m.time.end == 0.5 and m.time.elements == 15
    sol = lv.solve(m)
    assert sol.t[-1] == 0.5
    sol.save(tmp_path / "run.nc")
    assert "L = \"0.2 m\"   # its length" in lv.load_solution(tmp_path / "run.nc").model.to_toml()
    assert lv.load(file, parameters={"L": "1 m/4"}).parameters["L"] == 0.25
    for wrong, code in ({"l": 1}, "parameter-set"), ({"L": "2 kg"}, "unit"), ({"L": "2*L"}, "parameter-ring"):
        with pytest.raises(lv.InputError) as raised:
            lv.load(file, parameters=wrong)
        assert raised.value.code == code
    with pytest.raises(lv.InputError, match="a number or a string"):
        lv.load(file, parameters={"L": [1]})


@pytest.mark.parametrize("name, value, code", [("t", 1, "parameter-name"), ("a b", 1, "parameter-name"), ("a", "2*a", "parameter-ring"),
                                               ("a", "2*b", "expression-name"), ("a", "1 m + 1 s", "unit"), ("a", "1/0", "expression-value"),
                                               ("a", (1, 2), "wrong-type"), ("a", True, "wrong-type")])
def test_what_is_no_parameter_is_refused_where_it_is_written(name: str, value: object, code: str) -> None:
    m = lv.Model("one")
    m.parameters = {"L": 1}
    with pytest.raises(lv.InputError) as raised:
        m.parameters[name] = value   # type: ignore[assignment]
    assert raised.value.code == code
    assert dict(m.parameters) == {"L": 1}
    with pytest.raises(KeyError, match="did you mean 'L'"):
        m.parameters["l"]


def test_wrong_expressions_are_refused_where_they_are_written() -> None:
    m = lv.Model("one")
    m.parameters = {"L": "1 m"}
    with pytest.raises(lv.InputError, match="it is a length .m., and a mass .kg. is wanted"):
        m.add_body("rod", lv.box("L", "L", "L", mass="L"))
    rod = m.add_body("rod", lv.box("L", "L", "L", mass=1))
    with pytest.raises(lv.InputError, match="no parameter 'l'"):
        rod.position = ("l", 0, 0)
    rod.position = ("L/4", 0, 0)
    assert rod.position.tolist() == [0.25, 0, 0]
    m.parameters["unused"] = 3
    with warnings.catch_warnings(record=True) as told:
        warnings.simplefilter("always")
        lv.solve(m, 1)
    assert any("parameter-unused" in str(w.message) for w in told)


def test_faults_of_copies_say_which() -> None:
    with pytest.raises(lv.InputError, match="i = 1"):
        lv.load(text=SWING.replace('"ball {i}"', '"ball {i/2}"'))
    with pytest.raises(lv.InputError, match="not closed"):
        lv.load(text=SWING.replace('"ball {i}"', '"ball {i"'))
