# SPDX-License-Identifier: BSD-3-Clause
"""States of rest: against closed forms, SciPy and the program."""
from __future__ import annotations

import json
import pathlib
import pickle
import subprocess
from typing import Any

import numpy as np
import pytest
from conftest import ROOT

import livens as lv

DAMPING = 0.3
INERTIA = 2 * (1 + 0.01) / 12 + 2 * 0.25   # of the rod about its pivot, kg m^2
STIFFNESS = 2 * 9.81 * 0.5                 # of the weight about it, N m/rad


@pytest.fixture
def rod() -> lv.Model:
    """1 m and 2 kg on a hinge with a damper, stated horizontally."""
    m = lv.Model("a damped pendulum", gravity=(0, 0, -9.81))
    m.add_body("rod", lv.box(1, 0.1, 0.1, mass=2), position=(0.5, 0, 0))
    m.add_revolute("pivot", "world", "rod", at=(0, 0, 0), axis=(0, 1, 0))
    m.add_spring("friction", joint="pivot", stiffness=0, damping=DAMPING)
    return m


def test_a_pendulum_hangs(rod: lv.Model) -> None:
    rest = rod.find_equilibrium()
    assert rest.success and rest.status == "stable" and rest.degrees_of_freedom == 1 and rest.message == ""
    assert (rest.n_unstable, rest.n_neutral) == (0, 0) and rest.nit > 0 and rest.residual < 1e-14
    assert rest["rod"].position == pytest.approx([0, 0, -0.5], abs=1e-14)
    assert rest["rod"].quaternion == pytest.approx([np.sqrt(0.5), 0, np.sqrt(0.5), 0], abs=1e-14)
    assert rest["pivot"].angle == pytest.approx(np.pi / 2, abs=1e-14)
    assert rest["pivot"].force == pytest.approx([0, 0, 2 * 9.81], abs=1e-12) and rest["pivot"].unique
    assert rest[rod["rod"]].name == "rod" and list(rest.bodies) == ["rod"] and list(rest.joints) == ["pivot"]
    assert not rest["rod"].position.flags.writeable
    with pytest.raises(KeyError, match="did you mean 'rod'"):
        rest["rood"]
    with pytest.raises(AttributeError, match="its coordinates: angle"):
        rest["pivot"].displacement
    again = pickle.loads(pickle.dumps(rest))
    assert (again["rod"].position == rest["rod"].position).all() and "stable" in repr(again)


def test_what_starts_there_stays_there(rod: lv.Model) -> None:
    sol = lv.solve(rod, 2, start=rod.find_equilibrium().state, elements=5)
    assert abs(sol["rod"].velocity).max() < 1e-12
    sol = lv.solve(rod, 2, elements=20)   # the control
    assert abs(sol["rod"].velocity).max() > 1


def test_what_starts_there_is_the_same_mechanism() -> None:
    m = lv.Model("two", gravity=(0, 0, -9.81))   # joints by `at`: places in the world where bodies are stated
    a = m.add_body("a", lv.box(1, 0.1, 0.1, mass=1), position=(0.5, 0, 0))
    b = m.add_body("b", lv.box(1, 0.1, 0.1, mass=1), position=(1.5, 0, 0))
    m.add_revolute("h", "world", a, at=(0, 0, 0), axis=(0, 1, 0))
    m.add_revolute("k", a, b, at=(1, 0, 0), axis=(0, 1, 0))
    for angle in (0.5, 6.5, -9):   # where the spring has no torque, also behind whole turns
        spring = m.add_spring("s", joint="h", stiffness=400, damping=50, rest=angle)
        m.add_spring("t", joint="k", stiffness=400, damping=50)
        rest = m.find_equilibrium()
        assert rest.success and abs(rest["h"].angle - angle) < 0.1
        sol = lv.solve(m, 1, start=rest.state, elements=5)
        assert abs(sol["h"].angle - rest["h"].angle).max() < 1e-9 and abs(sol["b"].velocity).max() < 1e-9
        m.remove(spring)
        m.remove("t")
    m["h"].rate = 3   # of the stated start, not of that rest
    sol = lv.solve(m, 1, start=m.find_equilibrium().state, elements=5)
    assert abs(sol["b"].velocity).max() < 1e-9
    m["h"].rate = None
    m.start.coordinates = [{"joint": "h", "value": 0.25}]
    sol = lv.solve(m, 0.1, start=lv.state({"b": {"velocity": (0, 0, 0)}}), elements=2)   # the model's own lead on
    assert sol["h"].angle[0] == 0.25
    m.start.coordinates = None
    sol = lv.solve(m, 1, start=lv.state({"b": {"velocity": (0, 0, 0)}}), elements=20)   # what is left out is as stated
    assert sol["a"].position[0].tolist() == [0.5, 0, 0]


def test_modes_of_a_damped_pendulum(rod: lv.Model) -> None:
    modes = rod.vibration_modes()
    s = np.roots([INERTIA, DAMPING, STIFFNESS])[:1]
    assert len(modes) == 1 and modes.s == pytest.approx(s[s.imag > 0], rel=1e-12)
    assert modes.frequency == pytest.approx([np.sqrt(STIFFNESS / INERTIA)], rel=1e-12)
    assert modes.hertz == pytest.approx(modes.frequency / (2 * np.pi))
    assert modes.damping_ratio == pytest.approx([DAMPING / (2 * np.sqrt(STIFFNESS * INERTIA))], rel=1e-12)
    assert abs(modes["pivot"].angle) == pytest.approx([1], rel=1e-12)   # rad is more than a length of the model
    assert modes["rod"].displacement.shape == (1, 3) and modes["rod"].rotation.dtype == np.complex128
    assert abs(modes["rod"].displacement[0, 0]) == pytest.approx(0.5, rel=1e-12) and "damping ratio" in repr(modes)


def test_state_matrices_are_those_of_the_equation(rod: lv.Model) -> None:
    linear = rod.linearise()
    assert (linear.n, linear.status, linear.n_unstable, linear.n_neutral) == (1, "stable", 0, 0)
    assert linear.M == pytest.approx(np.eye(1))
    assert linear.C == pytest.approx(np.array([[DAMPING / INERTIA]])) and linear.C.shape == (1, 1)
    assert linear.K == pytest.approx(np.array([[STIFFNESS / INERTIA]]))
    found = linear.state_matrices(["pivot.angle"], ["pivot.angle", "pivot.angle_rate", "rod.x"])
    assert found.inputs == ("pivot.angle",) and found.outputs[2] == "rod.x"
    omega = np.array([0.3, 2.0, 7.0])
    response = [(found.C[0] @ np.linalg.solve(1j * w * np.eye(2) - found.A, found.B)).item() for w in omega]
    assert response == pytest.approx(1 / (STIFFNESS + 1j * omega * DAMPING - omega**2 * INERTIA), rel=1e-12)
    with pytest.raises(lv.InputError) as raised:
        linear.state_matrices(["pivot.angel"], [])
    assert raised.value.code == "no-such-port"
    with pytest.raises(TypeError, match="lists of names"):
        linear.state_matrices("pivot.angle", [])


def test_upright_is_unstable_and_an_answer() -> None:
    m = lv.Model("upright", gravity=(0, 0, -9.81))
    m.add_body("rod", lv.box(0.1, 0.1, 1, mass=2), position=(0, 0, 0.5))
    m.add_revolute("pivot", "world", "rod", at=(0, 0, 0), axis=(0, 1, 0))
    rest = m.find_equilibrium()
    assert (rest.success, rest.status, rest.nit, rest.n_unstable) == (True, "unstable", 0, 1)
    modes = m.vibration_modes(at="start")
    assert modes.s == pytest.approx([np.sqrt(STIFFNESS / INERTIA)], rel=1e-12)
    assert m.linearise("start").status == "unstable"
    m["rod"].angular_velocity = (0, 1, 0)
    m["rod"].velocity = (0.5, 0, 0)
    with pytest.raises(lv.InputError) as raised:
        m.linearise(at="start")
    assert raised.value.code == "not-at-rest"
    with pytest.raises(lv.InputError, match="did you mean 'start'"):
        m.linearise(at="stat")   # type: ignore[arg-type]


def test_what_falls_has_none() -> None:
    m = lv.Model("fall", gravity=(0, 0, -9.81))
    m.add_body("ball", lv.point(mass=1))
    with pytest.warns(lv.SolveWarning, match="still accelerates by 9.81"):
        rest = m.find_equilibrium()
    assert not rest.success and rest.status == "no equilibrium" and np.isnan(rest["ball"].quaternion).all()
    with pytest.raises(lv.EquilibriumError, match="no equilibrium was found") as raised:
        m.vibration_modes()
    assert not pickle.loads(pickle.dumps(raised.value)).partial.success


def test_functions_of_python_count() -> None:
    m = lv.Model("spring")
    m.add_body("bob", lv.point(mass=2), position=(1, 0, 0))
    with pytest.warns(lv.SlowWarning):
        m.add_function("pull", "bob", lambda t, body: -8 * (body.position - (1, 2, 3)))
    assert m.find_equilibrium()["bob"].position == pytest.approx([1, 2, 3], abs=1e-9)
    assert m.vibration_modes().frequency == pytest.approx([2, 2, 2], rel=1e-7)
    m.remove("pull")

    def fails(t: float, body: lv.BodyState) -> Any:
        raise ZeroDivisionError("the user's own")
    with pytest.warns(lv.SlowWarning):
        m.add_function("pull", "bob", fails)
    with pytest.raises(ZeroDivisionError, match="the user's own"):
        m.find_equilibrium()


def _theirs(program: str, command: str, file: pathlib.Path, *more: str) -> Any:
    done = subprocess.run([program, command, str(file), "--json", *more], capture_output=True, text=True, check=False)
    return json.loads(done.stdout)


@pytest.mark.parametrize("name", ["four_bar", "slider_crank", "wheel_suspension", "simple_pendulum", "revolute_double_pendulum"])
def test_numbers_are_the_programs(name: str, program: str) -> None:
    file = ROOT / "examples" / f"{name}.toml"
    m = lv.load(file)
    theirs = _theirs(program, "equilibrium", file)
    rest = m.find_equilibrium()
    assert (rest.status, rest.nit, rest.residual) == (theirs["status"], theirs["iterations"], theirs["residual"])
    for body in theirs["bodies"]:
        assert rest.bodies[body["name"]].position.tolist() == body["position"]
        if "quaternion" in body:
            assert rest.bodies[body["name"]].quaternion.tolist() == body["quaternion"]
    for joint in theirs["joints"]:
        mine = rest.joints[joint["name"]]
        assert (mine.force.tolist(), mine.torque.tolist(), mine.unique) == (joint["force"], joint["torque"], joint["unique"])
        assert all(joint[word] == value for word, value in mine.coordinates.items())
    theirs = _theirs(program, "modes", file)
    modes = m.vibration_modes()
    assert modes.s.real.tolist() == [mode["real"] for mode in theirs["modes"]]
    assert modes.s.imag.tolist() == [mode["imaginary"] for mode in theirs["modes"]]
    for i, mode in enumerate(theirs["modes"]):
        assert modes.frequency[i] == pytest.approx(mode["frequency"]) and modes.hertz[i] == pytest.approx(mode["hertz"])
        assert modes.damping_ratio[i] == pytest.approx(mode["damping_ratio"], abs=1e-15)
        for body in mode["bodies"]:
            shape = modes.bodies[body["name"]].displacement[i]
            assert (shape.real.tolist(), shape.imag.tolist()) == (body["displacement"], body["displacement_imaginary"])
        for joint in mode["joints"]:
            for word, values in modes.joints[joint["name"]].coordinates.items():
                assert (values[i].real, values[i].imag) == (joint[word], joint[f"{word}_imaginary"])
