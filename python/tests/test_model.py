# SPDX-License-Identifier: BSD-3-Clause
"""Models: editing by name, values, copies."""
from __future__ import annotations

import copy
import pickle
import random
import warnings
from typing import Any

import numpy as np
import pytest

import livens as lv
from livens._entries import default_name


def test_edits_by_name(pendulum: lv.Model) -> None:
    m = pendulum
    rod = m.bodies["rod"]
    assert m["rod"] == rod and m["rod"].density == 7850
    m["rod"].density = "7.8 t/m^3"
    assert rod.density == 7800 and rod.given["density"] == "7.8 t/m^3"
    rod.density *= 2
    assert m["rod"].density == 15600
    rod.position += (0.25, 0, 0)
    assert rod.position.tolist() == [0.75, 0, 0]
    with pytest.raises(ValueError, match="read-only"):
        rod.position[0] = 5
    assert rod.mass is None and rod.velocity.tolist() == [0, 0, 0]
    rod.mass = 2
    rod.density = None
    assert "density" not in rod.given
    m["rod"].shape.box = ("1 m", 0.1, 0.1)
    assert rod.shape.box.tolist() == [1, 0.1, 0.1]
    with pytest.raises(lv.InputError) as error:
        m["rod"].shape.box = (1, 2)
    assert error.value.path == "body[rod].box" or error.value.path == "body[rod].shape"
    assert rod.shape.box.tolist() == [1, 0.1, 0.1]
    m.time.end = 2
    m.start.initial = "project"
    assert 'initial = "project"' in m.to_toml() and m.time.end == 2


def test_refused_edit_changes_nothing(pendulum: lv.Model) -> None:
    before = pendulum.copy()
    for change in (lambda: setattr(pendulum["rod"], "density", -1), lambda: setattr(pendulum, "gravity", (1, 2)),
                   lambda: pendulum.add_body("rod", lv.sphere(1, mass=1)), lambda: setattr(pendulum.time, "end", "1 kg"),
                   lambda: setattr(pendulum["rod"], "position", object()), lambda: pendulum.add_weld("w", "world", "x"),
                   lambda: pendulum.add_force("f", "rod", value="1 N"),
                   lambda: pendulum.add_joint("x", "nix", between=("world", "rod"))):
        with pytest.raises(lv.InputError):
            change()
        assert pendulum == before and hash(pendulum) == hash(before) and pendulum.to_toml() == before.to_toml()


def test_numbers_of_all_kinds(pendulum: lv.Model) -> None:
    m = pendulum
    for value in (np.float32(0.5), np.int64(1), np.array([1, 2, 3])[0], True + 1, 2.5):
        m["rod"].density = value
        assert m["rod"].density == float(value)
    m["rod"].position = np.array([1, 2, 3])
    assert m["rod"].position.tolist() == [1, 2, 3]
    m["rod"].directors = np.eye(3)
    assert np.array_equal(m["rod"].directors, np.eye(3))
    wrong: list[Any] = [{1, 2}, b"1 kg", 1j, None.__class__, np.array(["a"]), 10**30, float("nan"), "nan",
                        "1e999", [[]]]
    for bad in wrong:
        with pytest.raises(lv.InputError):
            m["rod"].density = bad


def test_quantities_of_pint(pendulum: lv.Model) -> None:
    pint = pytest.importorskip("pint")
    u = pint.UnitRegistry()
    pendulum["rod"].density = 2.7 * u.g / u.cm**3
    assert pendulum["rod"].density == pytest.approx(2700, rel=1e-15)
    pendulum["rod"].position = np.array([50, 0, 0]) * u.cm
    assert pendulum["rod"].position.tolist() == [0.5, 0, 0]
    pendulum["rod"].rotation_vector = (0, 90, 0) * u.deg
    assert pendulum["rod"].rotation_vector[1] == pytest.approx(np.pi / 2)
    with pytest.raises(lv.InputError) as error:
        pendulum["rod"].density = 3 * u.kg
    assert error.value.code == "unit" and "kg/m^3" in str(error.value)
    assert lv.solve(pendulum, 1 * u.s, elements=4).t[-1] == 1


def test_values_and_identity(pendulum: lv.Model) -> None:
    other = pendulum.copy()
    assert other == pendulum and other is not pendulum and len({other, pendulum}) == 1
    other["rod"].density *= 0.5
    assert other != pendulum and len({other, pendulum}) == 2
    assert pendulum["rod"].density == 7850
    assert pickle.loads(pickle.dumps(other)) == other
    assert copy.deepcopy(other)["rod"].density == 3925
    assert pendulum != 3
    assert "rod" in pendulum and "pivot" in pendulum and "x" not in pendulum and 3 not in pendulum
    assert list(pendulum.bodies) == ["rod"] and len(pendulum.joints) == 1
    assert "rod" in repr(pendulum.bodies) and "1 body" in repr(pendulum) and "rod" in pendulum._repr_html_()


def test_shapes_bring_their_density(pendulum: lv.Model) -> None:
    rod = pendulum.bodies["rod"]
    rod.shape = lv.sphere(0.1, mass="2 kg")
    assert rod.mass == 2 and rod.density is None and pendulum["rod"].shape.sphere == 0.1
    before = pendulum.copy()
    with pytest.raises(lv.InputError):
        rod.shape = lv.sphere(0.1, density=-1)
    assert pendulum == before
    rod.shape = lv.box(1, 1, 1)
    assert rod.mass == 2


def test_keys_that_say_the_same_replace_each_other(pendulum: lv.Model) -> None:
    rod = pendulum["rod"]
    rod.mass = "20 kg"
    assert rod.density is None and rod.mass == 20 and pendulum.check() == []
    rod.rotation_vector = (0, 0, 0)
    rod.quaternion = (1, 0, 0, 0)
    assert rod.rotation_vector is None and pendulum.check() == []
    with pytest.raises(lv.InputError):
        rod.density = "x"
    assert rod.mass == 20, "what is refused replaces nothing"
    pendulum.time.end, pendulum.time.accuracy = 1, 1e-5
    pendulum.time.elements = 10
    assert pendulum.time.given == {"end": 1, "elements": 10} and lv.solve(pendulum).n_elements == 10


def test_handles_of_tables_that_come_and_go(pendulum: lv.Model) -> None:
    first, second = pendulum.time, pendulum.time
    assert "time" not in pendulum.to_toml()
    first.end = 1
    second.elements = 5
    assert first.elements == 5 and second.end == 1 and "end = 1\nelements = 5" in pendulum.to_toml()
    rod = pendulum["rod"]
    pendulum.remove("pivot")
    pendulum.remove(rod)
    with pytest.raises(KeyError, match="removed"):
        rod.density = 3


def test_removing_and_renaming(pendulum: lv.Model) -> None:
    pendulum.remove("pivot")
    assert not pendulum.joints and lv.solve(pendulum, 0.1, elements=1).success
    pendulum["rod"].name = "bar"
    assert list(pendulum.bodies) == ["bar"]
    with pytest.raises(KeyError):
        pendulum.remove("rod")
    pendulum.add_body("second", lv.sphere(1, mass=1))
    with pytest.raises(lv.InputError) as error:
        pendulum["bar"].name = "second"
    assert error.value.code == "name-duplicate"


def test_same_name_twice_among_kinds(pendulum: lv.Model) -> None:
    pendulum.add_energy_sensor("rod", "rod")
    with pytest.raises(KeyError, match="m.bodies"):
        pendulum["rod"]
    sol = lv.solve(pendulum, 0.1, elements=1)
    with pytest.raises(KeyError, match="bodies"):
        sol["rod"]
    assert sol.bodies["rod"].position.shape == (2, 3) and sol.sensors["rod"].kinetic[0] == 0


def test_every_default_name_is_the_readers() -> None:
    """What Python calls parts without names is what the compiled reader calls them."""
    m = lv.Model("names")
    a, b = m.add_body("a", lv.sphere(1, mass=1)), m.add_body("b", lv.sphere(1, mass=1), position=(2, 0, 0))
    m.add_revolute(None, "world", a, at=(0, 0, 0), axis=(0, 0, 1))
    m.add_rod(None, a, b)
    m.add_spring(None, a, b, stiffness=1, free_length=1)
    m.add_force(None, a, value=(0, 0, 0))
    m.add_joint_drive(None, "revolute world-a", value=0)
    m.add_point_drive(None, b, value=(0, 0, 0))
    assert list(m.joints) == ["revolute world-a", "rod a-b"]
    sol = lv.solve(m, 0.1, elements=1, estimate="none")
    names = [default_name(kind, t) for kind in ("joint", "drive") for t in m._root[kind]]
    assert list(sol.joints) == names
    assert list(sol.loads) == list(m.loads)


def test_points_with_bodies() -> None:
    m = lv.Model("spring")
    m.add_body("a", lv.point(mass=1), position=(0, 0, -1))
    s = m.add_spring("s", ("world", (0, 0, 1)), ("a", (0, 0, 0)), stiffness="2 kN/m", free_length=1)
    assert s.between == ("world", "a") and s.points.tolist() == [[0, 0, 1], [0, 0, 0]] and s.stiffness == 2000


def test_a_point_on_one_side_of_what_ends_at_reference_points() -> None:
    m = lv.Model("one")
    a = m.add_body("a", lv.box(1, 0.1, 0.1, mass=1))
    b = m.add_body("b", lv.point(mass=1), position=(0.5, 0, -1))
    assert m.add_rod("rod", (a, (0.5, 0, 0)), b).points.tolist() == [[0.5, 0, 0], [0, 0, 0]]
    spring = m.add_spring("spring", "world", (a, (0.5, 0, 0)), stiffness=1, free_length=1)
    assert spring.points.tolist() == [[0, 0, 0], [0.5, 0, 0]]
    with pytest.raises(lv.InputError, match="on one side only"):   # a hinge would be where nobody meant it
        m.add_revolute("hinge", "world", (a, (0.5, 0, 0)), axes=[(0, 0, 1), (0, 0, 1)])


def test_hostile_trees_are_refused() -> None:
    m = lv.Model("deep")
    deep: dict[str, object] = {}
    for _ in range(200):
        deep = {"a": deep}
    for value in (deep, [[[[1]]]], {"box": {"a": 1}}, {3: 4}, "\ud800", "\0", "", [], (), {}, float("inf"), -0.0):
        with pytest.raises(lv.InputError):
            m.add_body("a", value, mass=1)   # type: ignore[arg-type]
    for name in ("", "world", "a\nb", "\u202e", "x" * 300, 3, None):
        with pytest.raises(lv.InputError):
            m.add_body(name, lv.sphere(1, mass=1))   # type: ignore[arg-type]
    loop: list[object] = []
    loop.append(loop)
    with pytest.raises((lv.InputError, RecursionError)):
        m.add_body("a", loop, mass=1)   # type: ignore[arg-type]
    assert m == lv.Model("deep")


def test_random_edits_never_crash() -> None:
    """Hundreds of edits with nonsense: refused or taken, and the text always reads back to the same model."""
    pick = random.Random(1)
    m = lv.Model("random")
    rod = m.add_body("rod", lv.box(1, 1, 1, mass=1))
    m.add_revolute("pivot", "world", rod, at=(0, 0, 0), axis=(0, 1, 0))
    m.add_spring("s", "world", rod, stiffness=1, free_length=1)
    values = [1, -1, 0.5, "2 kg", "1 m", "rod", "world", (1, 2, 3), (0, 0, 1), [(1, 0, 0), (0, 1, 0)], {}, {"box": (1, 1, 1)},
              True, None, "", 1e308, np.zeros(3), np.eye(3), ("world", "rod"), {"times": (0, 1), "values": (1, 2)}]
    for _ in range(700):
        section = m[pick.choice(["rod", "pivot", "s"])] if pick.random() < 0.8 else pick.choice([m.time, m.method, m.start])
        key = pick.choice([key for key in section.keys() if key != "name"])
        try:
            setattr(section, key, pick.choice(values))
        except lv.InputError:
            pass
    m.check()
    assert lv.load(text=m.to_toml(), check=False) == m


def test_python_functions() -> None:
    m = lv.Model("driven")
    m.add_body("ball", lv.sphere(0.1, mass=2))
    with pytest.warns(lv.SlowWarning, match="slow"):
        m.add_function("hand", "ball", lambda t, body: (4.0, 0, -3 * body.velocity[2]))
    sol = lv.solve(m, 1, elements=4)
    assert sol.success and sol["ball"].position[-1] == pytest.approx([1, 0, 0], abs=1e-12)
    for refused in (lambda: pickle.dumps(m), m.to_toml, lambda: sol.save("x.nc"), lambda: pickle.dumps(sol),
                    lambda: lv.solve_many([m], 1), lambda: sol.model):
        with pytest.raises(lv.InputError) as error:
            refused()
        assert error.value.code == "python-function" and "add_function" in lv.explain("python-function")
    assert m.copy() == m
    m.remove("hand")
    assert pickle.loads(pickle.dumps(m)) == m


def test_python_functions_agree_with_expressions() -> None:
    """A spring to the origin with friction and a torque, by Python and by expressions."""
    def made() -> lv.Model:
        m = lv.Model("bob")
        m.add_body("bob", lv.box(0.1, 0.2, 0.3, mass=2), position=(1, 0, 0), velocity=(0, 1, 0))
        m.add_point_sensor("bob at", "bob")
        return m
    slow, fast = made(), made()
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", lv.SlowWarning)
        slow.add_function("pull", "bob", lambda t, b: [*(-3 * b.position - 0.1 * b.velocity), 0, 0, 0.01 * np.sin(t)])
    names = {f"{c}{i}": f"bob at.{c}{i}" for c in ("", "v") for i in "xyz"}
    fast.add_force("pull", "bob", inputs=names, expression=[f"-3*{i} - 0.1*v{i}" for i in "xyz"])
    fast.add_torque("turn", "bob", expression=("0", "0", "0.01*sin(t)"))
    a, b = lv.solve(slow, 2, elements=20), lv.solve(fast, 2, elements=20)
    assert a.success and b.success
    for name, size in lv.compare(a, b).largest["bob"].items():
        assert size < 1e-9, name


def test_what_functions_raise_ends_the_solution() -> None:
    m = lv.Model("broken")
    m.add_body("ball", lv.sphere(0.1, mass=2))
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", lv.SlowWarning)
        m.add_function("hand", "ball", lambda t, body: 1 / 0)
    with pytest.raises(ZeroDivisionError):
        lv.solve(m, 1, elements=4)
    m.remove("hand")
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", lv.SlowWarning)
        m.add_function("hand", "ball", lambda t, body: (1, 2))
    with pytest.raises(ValueError, match="three numbers"):
        lv.solve(m, 1, elements=4)


def test_a_density_of_a_mesh_is_no_shape_of_its_own() -> None:
    m = lv.Model()
    m.add_body("part", lv.mesh("part.stl", unit="mm", density_field="7850 + 10*z"))
    assert 'density_field = "7850 + 10*z"' in m.to_toml() and not hasattr(lv, "density_field")
    m.add_body("block", lv.box(1, 1, 1, density_field="1 + x"))
    assert 'density_field = "1 + x"' in m.to_toml()
    with pytest.raises(TypeError):
        lv.parts([{"box": [1, 1, 1]}], density_field="1")   # type: ignore[call-arg]


def test_the_text_of_a_scenario_is_a_text() -> None:
    for text in (5, b"format = 1", ["format = 1"]):
        with pytest.raises(TypeError, match="text= of load"):
            lv.load(text=text)   # type: ignore[arg-type]


def test_looks_are_apart_from_mass_and_are_kept(tmp_path: Any) -> None:
    m = lv.Model("arm")
    arm = m.add_body("arm", mass=3, inertia=(0.001, 0.3, 0.3), color="steelblue", opacity=0.5, visual=[
        lv.box(1, 0.05, 0.05), lv.visual(lv.sphere("6 cm"), position=(0.5, 0, 0), color=(0.8, 0.2, 0.2))])
    m.world.visual = lv.box(3, 2, 0.02)
    m.to_toml(tmp_path / "arm.toml")
    again = lv.load(tmp_path / "arm.toml")
    assert again == m and again["arm"].mass == 3
    assert again["arm"].visual[1].sphere == 0.06 and again.world.visual.box.tolist() == [3, 2, 0.02]
    arm.visual[1].color = "#c33"
    assert m["arm"].visual[1].color == "#c33"
    arm.visual = lv.sphere(0.1)
    assert m["arm"].visual.sphere == 0.1 and m["arm"].mass == 3
    with pytest.raises(lv.InputError, match="looked at alone has no mass"):
        arm.visual = lv.sphere(0.1, mass=2)
    with pytest.raises(lv.InputError, match="cannot be \"stelblue\""):
        m.add_body("bad", lv.sphere(0.1, mass=2), color="stelblue")
        m.check()
