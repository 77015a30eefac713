# SPDX-License-Identifier: BSD-3-Clause
"""What users of other programs type, and that each answer says what to type instead."""
from __future__ import annotations

import copy
import pickle
import warnings
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import livens as lv


@pytest.fixture
def sol(pendulum: lv.Model) -> lv.Solution:
    return lv.solve(pendulum, 1, elements=10)


def answer(call: Callable[[], Any]) -> str:
    with pytest.raises(Exception) as raised:
        call()
    assert isinstance(raised.value, (AttributeError, KeyError, TypeError, ValueError))
    return str(raised.value)


MODEL = {
    "add_hinge": "m.add_revolute(..)", "add_Hinge": "m.add_revolute(..)", "addHinge": "m.add_revolute(..)",
    "add_ball_joint": "m.add_spherical(..)", "add_slider": "m.add_prismatic(..)", "add_fixed_joint": "m.add_weld(..)",
    "add_damper": "m.add_spring(..) with 'damping'", "add_torsion_spring": "'joint'", "add_motor": "m.add_joint_drive",
    "add_moment": "m.add_torque(..)", "add_ground": "\"world\"", "add_gravity": "m.gravity = (0, 0, -9.81)",
    "add_marker_sensor": "m.add_point_sensor(..)", "ground": "\"world\"", "solve": "lv.solve(m, 10)", "simulate": "lv.solve(m, 10)",
    "rod": "m['rod']", "static_equilibrium": "m.find_equilibrium()", "save": "m.to_toml", "eigenfrequencies": "m.vibration_modes()",
    "bodys": "did you mean 'bodies'?", "add_revolut": "did you mean 'add_revolute'?"}
MODULE = {
    "Box": "'box'", "simulate": "lv.solve", "Simulation": "lv.solve", "Hinge": "m.add_revolute(..)", "load_urdf": "lv.from_urdf", "from_sdf": "docs/coming_from", "load_mjcf": "lv.from_mjcf",
    "deg": "\"30 deg\"", "open": "lv.load", "load_result": "lv.load_solution", "slove": "did you mean 'solve'?"}
SOLUTION = {
    "time": "'t'", "y": "sol['rod'].position", "rod": "sol['rod']", "animate": "sol.report", "show": "sol.report", "view": "sol.report",
    "to_csv": "sol.export('run.csv')", "to_pandas": "'to_dataframe'", "kinetic_energy": "'kinetic'", "converged": "'success'",
    "reactions": ".force", "sample": "sol(0.5)", "enrgy": "did you mean 'energy'?"}
BODY = {
    "pos": "'position'", "x": "'position'", "vel": "'velocity'", "omega": "'angular_velocity'", "com": "'center_of_mass'",
    "quat": "'quaternion'", "kinetic_energy": "m.add_energy_sensor(\"E\", \"rod\")", "positon": "'position'"}
JOINT = {
    "reaction": "sol['pivot'].force", "reaction_force": "sol['pivot'].force", "angular_velocity": "'angle_rate'", "speed": "'angle_rate'",
    "q": "'angle'", "angle_deg": "np.degrees(sol['pivot'].angle)", "forc": "'force'"}


def test_attributes_of_other_programs(pendulum: lv.Model, sol: lv.Solution) -> None:
    for owner, table in ((pendulum, MODEL), (lv, MODULE), (sol, SOLUTION), (sol(0.5), {"time": "'t'", "rod": "sol['rod']"}), (sol["rod"], BODY), (sol["pivot"], JOINT)):
        for name, wanted in table.items():
            assert wanted in answer(lambda: getattr(owner, name)), name
            assert not hasattr(owner, name) and getattr(owner, name, 7) == 7


def test_calls_of_other_programs(pendulum: lv.Model, sol: lv.Solution) -> None:
    m: Any = pendulum
    solve: Any = lv.solve
    for call, wanted in (
            (lambda: m.add_drive("m", "pivot", rate=1), "m.add_joint_drive('m', 'pivot', ..)"),
            (lambda: m.add_load("f", "rod", value=(0, 0, 1)), "m.add_force('f', 'rod', ..)"),
            (lambda: m.add_revolute("x", "world", "rod", (0, 0, 0), (0, 1, 0)), "at=(0, 0, 0), axis=(0, 1, 0)"),
            (lambda: m.add_revolute("world", "rod", at=(0, 0, 0), axis=(0, 1, 0)), "its own name comes first"),
            (lambda: m.add_revolute("x", "world", "rod", at=(0, 0, 0), axis=(0, 1, 0), friction=1), "m.add_actuator(..)"),
            (lambda: m.add_revolute("x", "world", "rod", at=(0, 0, 0), axis=(0, 1, 0), viscous_damping=1), "'damping'"),
            (lambda: m.add_revolute("x", "ground", "rod", at=(0, 0, 0), axis=(0, 1, 0)), "\"world\""),
            (lambda: m.add_joint_drive("m", "pivot", expression=lambda t: t), "is a string"),
            (lambda: m.add_body("b", lv.box(1, 1, 1, mass=1), euler=(0, 0, 1)), "quaternion = [w, x, y, z]"),
            (lambda: m.add_body("b", lv.box(1, 1, 1, mass=1), position=(1, 2)), "[1, 2, 0]"),
            (lambda: solve(m, 1, dt=0.01), "no step size is needed"),
            (lambda: solve(m, 1, rtol=1e-9), "accuracy = "),
            (lambda: solve(m, 1, t_eval=[0, 1]), "output = "),
            (lambda: lv.solve(m, 1, method="RK45"), "leave method= out"),
            (lambda: m.bodies[0], "['rod']"),
            (lambda: m["rod"].pos, "'position'"),
            (lambda: setattr(m, "accuracy", 1e-8), "[time]"),
            (lambda: sol["rod.position"], "sol['rod'].position"),
            (lambda: sol.save("x.mat"), "ncread"), (lambda: sol.save("x.csv"), "sol.export('x.csv')"),
            (lambda: sol.export("x.mp4"), "webm (.webm)"), (lambda: lv.load("x.urdf"), "lv.from_urdf('x.urdf')"), (lambda: lv.load("x.xml"), "lv.from_mjcf('x.xml')"), (lambda: lv.load("x.sdf"), "TOML"), (lambda: lv.load("run.nc"), "load_solution"),
            (lambda: lv.box(1), "box(x, y, z)")):
        assert wanted in answer(call), wanted
    assert len(m.joints) == 1 and len(m.bodies) == 1 and len(m.drives) == 0


def test_scenarios_are_answered_in_their_own_words(pendulum: lv.Model) -> None:
    text = pendulum.to_toml() + "\n[[joint]]\nname = \"x\"\ntype = \"revolute\"\nbetween = [\"world\", \"rod\"]\nfriction = 1\n"
    for text in (text, text + "[time]\nend = 1\n"):
        assert "[[load]] with type = \"actuator\", joint = \"x\"" in answer(lambda: lv.load(text=text))


def test_files_of_results_may_have_any_other_name(sol: lv.Solution, tmp_path: Path) -> None:
    for name in ("run", "run.nc", "run.cdf", "run.v2", "a.b.nc"):
        sol.save(tmp_path / name)
        assert lv.load_solution(tmp_path / name).success


def test_shapes_and_values_of_numpy_are_taken(pendulum: lv.Model) -> None:
    assert lv.box((1, 2, 3), density=1).keys["shape"] == {"box": (1, 2, 3)}
    assert lv.box(np.array([1.0, 2.0, 3.0]), density=1) == lv.box(1.0, 2.0, 3.0, density=1)
    assert pendulum.add_force("f", "rod", value=np.zeros((3, 1))).value.tolist() == [0, 0, 0]
    assert pendulum.add_joint("again", "weld", "world", "rod", at=(0, 0, 0)).name == "again"


def test_rotations_of_scipy_are_taken(pendulum: lv.Model) -> None:
    rotation = pytest.importorskip("scipy.spatial.transform").Rotation.from_euler("xyz", (10, 20, 30), degrees=True)
    m: Any = pendulum
    shape = lv.box(1, 2, 3, mass=1)
    for name, value in (("a", rotation), ("b", rotation.as_matrix()), ("c", rotation.as_matrix().tolist())):
        m.add_body(name, shape, rotation=value)
    for key in ("quaternion", "rotation_vector", "directors"):
        m.add_body(key, shape, **{key: rotation})
    m.add_body("set", shape).rotation = rotation
    sol = lv.solve(m, 0.01, elements=1)
    for name in ("a", "b", "c", "quaternion", "rotation_vector", "directors", "set"):
        np.testing.assert_allclose(sol[name].directors[0].T, rotation.as_matrix(), atol=1e-15)
    with pytest.raises(lv.InputError, match="exclude each other"):
        m.add_body("two", shape, rotation=rotation, quaternion=(1, 0, 0, 0))
    with pytest.raises(lv.InputError, match="quaternion = "):
        m.add_body("angles", shape, rotation=(10, 20, 30))


def test_a_scalar_that_comes_last_is_doubted(pendulum: lv.Model) -> None:
    half = np.sqrt(0.5)
    for doubted in ([0, 0.25881904510252074, 0, 0.9659258262890683], [0, 0, half, half], [0, 0, 0, 1]):
        with pytest.warns(lv.ModelWarning, match="rotation=R"):
            pendulum["rod"].quaternion = np.array(doubted, dtype=float)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        for good in (np.array([1.0, 0, 0, 0]), np.array([half, 0, 0, half]), np.array([0, 1.0, 0, 0]), np.array([0, 0, 0, -1.0]),
                     (0, 0, half, half), (0, 0, 0, 1)):
            pendulum["rod"].quaternion = good


def test_protocols_are_those_of_plain_objects(pendulum: lv.Model, sol: lv.Solution) -> None:
    for thing in (pendulum, sol, sol(0.5), sol["rod"], sol["pivot"], pendulum["rod"], lv):
        for name in ("__array__", "__fspath__", "__len_hint__", "_ipython_canary_method_should_not_exist_", "_repr_png_", "__wrapped__"):
            assert not hasattr(thing, name)
        assert all(isinstance(name, str) for name in dir(thing)) and repr(thing)
    assert copy.copy(pendulum) == copy.deepcopy(pendulum) == pickle.loads(pickle.dumps(pendulum)) == pendulum
    assert copy.deepcopy(sol["rod"]).position.shape == sol["rod"].position.shape
    assert pickle.loads(pickle.dumps(sol))["rod"].position.tolist() == sol["rod"].position.tolist()
    empty = object.__new__(lv.Model)
    with pytest.raises(AttributeError, match="_root"):
        len(empty.bodies)
    with pytest.raises(ImportError):
        exec("from livens import Hinge")
