# SPDX-License-Identifier: BSD-3-Clause
"""Peaks, accelerations, orientations and units, against closed forms and dense samples."""
from __future__ import annotations

import pathlib
from typing import Any

import livens as lv
import numpy as np
import pytest


@pytest.fixture(scope="module")
def rod() -> lv.Solution:
    m = lv.Model("pendulum", gravity=(0, 0, -9.81))
    body = m.add_body("rod", lv.box(1, "5 cm", "5 cm", density=7850), position=(0.5, 0, 0))
    m.add_revolute("pivot", "world", body, at=(0, 0, 0), axis=(0, 1, 0))
    return lv.solve(m, 10, accuracy=1e-9)


def test_the_peak_of_a_pendulum_is_that_of_its_formula(rod: lv.Solution) -> None:
    weight, ratio = 19.625 * 9.81, 0.25 / ((1 + 0.05**2) / 12 + 0.25)   # m l^2 / J
    value, t = rod.peak("pivot.force")
    assert value == pytest.approx(weight * (1 + 2 * ratio), rel=1e-8)   # 481.12 N
    assert rod(t)["rod"].position[2] == pytest.approx(-0.5, abs=1e-9), "when it hangs"
    ends = np.linalg.norm(rod["pivot"].force, axis=1).max()
    assert ends < value * (1 - 5e-5), "element ends alone are not enough (control)"
    swing = rod.extremes("pivot.angle", unit="deg")
    assert (swing.min, swing.max) == pytest.approx((0, 180), abs=1e-5)
    assert rod.extremes("pivot.force").min == pytest.approx(weight * (1 - ratio), rel=1e-8), "at the very start"


def random_motion(seed: int) -> lv.Solution:
    rng = np.random.default_rng(seed)
    m = lv.Model("random", gravity=tuple(rng.normal(size=3) * 6))
    before: Any = "world"
    place = np.zeros(3)
    for i in range(int(rng.integers(1, 4))):
        arm = rng.normal(size=3)
        body = m.add_body(f"b{i}", lv.box(*rng.uniform(0.1, 0.6, 3), mass=float(rng.uniform(0.5, 3))),
                          position=tuple(place + arm), rotation_vector=tuple(rng.normal(size=3)))
        add = m.add_revolute if rng.random() < 0.6 else m.add_spherical
        axis: dict[str, Any] = {"axis": tuple(rng.normal(size=3))} if add == m.add_revolute else {}
        add(f"j{i}", before, body, at=tuple(place), **axis)
        before, place = body, place + 2 * arm
    m.add_force("push", before, expression=("5*sin(7*t)", "0", "4*cos(3*t)"))
    return lv.solve(m, 2.0, accuracy=1e-8)


@pytest.mark.parametrize("seed", range(6))
def test_peaks_are_those_of_dense_samples(seed: int) -> None:
    sol = random_motion(seed)
    t = np.linspace(0, 2, 20001)
    some = sol(t)
    for name, of in sol.peaks().items():
        array = some._array(name)[0]
        flat = np.linalg.norm(array, axis=-1) if array.ndim > 1 else array
        size = max(abs(flat).max(), 1e-6)
        # The polynomials are off by their own order; nothing may lie beyond the extremes by more than that.
        assert of.max == pytest.approx(flat.max(), abs=3e-3 * size) and of.min == pytest.approx(flat.min(), abs=3e-3 * size), name
        for value, at in ((of.max, of.t_max), (of.min, of.t_min)):
            there = sol(at, exact=True)._array(name)[0]
            assert value == pytest.approx(np.linalg.norm(there), rel=1e-9, abs=1e-7 * size) or \
                value == pytest.approx(float(there) if np.ndim(there) == 0 else np.nan, rel=1e-9, abs=1e-7 * size), name


@pytest.mark.parametrize("seed", range(4))
def test_accelerations_are_slopes_of_velocities(seed: int) -> None:
    sol = random_motion(seed)
    h = 1e-4
    for t in (0.31, 1.234):
        three = sol(np.array([t - h, t, t + h]), exact=True)
        for name in sol.bodies:
            body = three[name]
            point = body.point((0.2, -0.1, 0.3))
            pairs = [(body.velocity, body.acceleration), (body.angular_velocity, body.angular_acceleration),
                     (point.velocity, point.acceleration)]
            pairs += [(three[j].angle_rate, three[j].angle_acceleration) for j in sol.joints if sol[j].coordinates]
            for v, a in pairs:
                slope = (v[2] - v[0]) / (2 * h)
                assert slope == pytest.approx(a[1], abs=2e-4 * (1 + np.abs(a[1]).max()))
                assert not np.allclose(slope, 1.01 * a[1] + 0.01, atol=2e-4 * (1 + np.abs(a[1]).max())), "control"


def test_a_body_accelerates_by_its_forces(rod: lv.Solution) -> None:
    for series in (rod, rod(np.linspace(0, 10, 77), exact=True)):
        force = series["pivot"].force + np.array([0, 0, -9.81 * 19.625])
        assert series["rod"].center_acceleration == pytest.approx(force / 19.625, abs=1e-10)
    along = rod["pivot"].force_in("rod")
    assert np.linalg.norm(along, axis=1) == pytest.approx(np.linalg.norm(rod["pivot"].force, axis=1))
    assert rod["pivot"].force_in("world") == pytest.approx(rod["pivot"].force)
    w = rod["pivot"].angle_rate
    assert along[:, 0] == pytest.approx(-19.625 * (w**2 / 2 + 9.81 * np.sin(rod["pivot"].angle)), abs=1e-4), "on the rod's axis"


def test_sensors_read_accelerations() -> None:
    m = lv.Model("turntable")
    disc = m.add_body("disc", lv.cylinder(0.2, 0.02, mass=1))
    m.add_revolute("shaft", "world", disc, at=(0, 0, 0), axis=(0, 0, 1))
    m.add_joint_drive("motor", "shaft", expression="2*t + 0.5*t^2")
    m.add_point_sensor("rim", disc, point=(0.1, 0, 0))
    m.start.initial = "project"
    sol = lv.solve(m, 1)
    t = np.linspace(0, 1, 41)
    s = sol(t)
    w, angle = 2 + t, 2 * t + t**2 / 2
    expected = 0.1 * np.stack([-w**2 * np.cos(angle) - np.sin(angle), -w**2 * np.sin(angle) + np.cos(angle)], axis=1)
    assert np.stack([s["rim"].ax, s["rim"].ay], axis=1) == pytest.approx(expected, abs=2e-6)
    assert s["shaft"].angle_acceleration == pytest.approx(np.ones(41), abs=1e-9)
    inertia = 0.5 * 0.2**2
    assert s["motor"].effort == pytest.approx(inertia * np.ones(41), abs=1e-7)
    assert s["motor"].power == pytest.approx(inertia * w, abs=1e-6)
    assert sol.peak("shaft.angle_rate", unit="rpm").value == pytest.approx(3 * 30 / np.pi)


def test_dense_instants_show_jumps_from_both_sides() -> None:
    m = lv.Model("pulled")
    m.add_body("ball", lv.point(mass=2))
    when: dict[str, Any] = {"from": 0.5, "until": 1}
    m.add_force("pull", "ball", value=(3, 0, 0), **when)
    sol = lv.solve(m, 2)
    pd = pytest.importorskip("pandas")
    frame = sol.to_dataframe("ball")
    assert isinstance(frame, pd.DataFrame) and len(frame) >= 600
    assert frame.loc[0.5, "ball.acceleration.x"].tolist() == pytest.approx([0, 1.5])
    assert frame.loc[1.0, "ball.acceleration.x"].tolist() == pytest.approx([1.5, 0])
    assert (np.diff(frame.index) >= 0).all() and set(sol.t) <= set(frame.index)
    assert sol.extremes("ball.acceleration.x")[::2] == pytest.approx((0, 1.5))


def test_tables_at_output_times_keep_them(tmp_path: pathlib.Path) -> None:
    m = lv.Model("fall", gravity=(0, 0, -9.81))
    m.add_body("ball", lv.point(mass=1))
    sol = lv.solve(m, 1, elements=20, output=0.05)

    def rows(**keywords: Any) -> int:
        sol.export(tmp_path / "a.csv", force=True, **keywords)
        return len((tmp_path / "a.csv").read_text().splitlines()) - 1
    assert rows() == 21 and rows(at="dense") > 600 and rows(at="ends") == 21
    assert len(lv.solve(m, 1, elements=20).to_dataframe()) > 600 and len(sol.to_dataframe()) == 21
    for call in (sol.to_dataframe, sol.plot, sol.to_xarray):
        with pytest.raises(lv.InputError, match="dense"):
            call(at="densest")
    with pytest.raises(lv.InputError, match="chosen already"):
        sol(0.5).to_dataframe(at="ends")


def test_orientations() -> None:
    rotation = pytest.importorskip("scipy.spatial.transform").Rotation
    sol = random_motion(2)
    some, names = sol(np.linspace(0, 2, 11)), list(sol.bodies)
    for name in names:
        body = some[name]
        there = rotation.from_matrix(body.rotation)
        assert body.rotation == pytest.approx(np.swapaxes(body.directors, 1, 2), abs=1e-12)
        assert body.rotation_vector() == pytest.approx(there.as_rotvec(), abs=1e-9)
        for order in ("zyx", "xyz", "zxz", "yxy", "xzy", "yzx"):
            angles = body.euler(order)
            again = rotation.from_euler(order.upper(), angles).as_matrix()
            assert again == pytest.approx(body.rotation, abs=1e-9), order
        seen = rotation.from_matrix(some[names[0]].rotation).inv() * there
        assert body.angle_to(names[0]) == pytest.approx(seen.magnitude(), abs=1e-7)
    with pytest.raises(lv.InputError, match="yaw"):
        some[names[0]].euler("zzy")


def test_reactions_in_axes_of_bodies_and_points_have_peaks(rod: lv.Solution) -> None:
    t = np.linspace(0, 10, 20001)
    along = rod(t)["pivot"].force_in("rod")
    for i, x in enumerate("xyz"):
        of = rod.extremes(f"pivot.force_in.rod.{x}")
        assert (of.min, of.max) == pytest.approx((along[:, i].min(), along[:, i].max()), abs=0.05), x
        assert np.array_equal(rod(t)._array(f"pivot.force_in.rod.{x}")[0], along[:, i])
    assert rod.peak("pivot.force_in.rod").value == pytest.approx(rod.peak("pivot.force").value)
    assert abs(rod.extremes("pivot.force.x").max - rod.extremes("pivot.force_in.rod.x").max) > 1, "other axes (control)"
    assert not any("_in." in name for name in rod.peaks())
    m = lv.Model(gravity=(0, 0, -9.81))
    top = m.add_body("top", lv.sphere("10 cm", mass=1), angular_velocity=(0, 0, 2))
    m.add_point("rim", top, position=(0.1, 0, 0))
    m.add_point_sensor("eye", "top")
    sol = lv.solve(m, 1)
    assert sol.peak("rim.acceleration").value == pytest.approx(np.hypot(0.4, 9.81))
    with pytest.raises(lv.InputError, match=r"there are 'eye\.x'"):
        sol.peak("eye.acceleration")
    with pytest.raises(lv.InputError, match=r"pivot\.force_in\.rod"):
        rod.peak("pivot.force_in.rdo")


def test_wrong_names_and_units_are_answered(rod: lv.Solution) -> None:
    for name, answer in (("pivot.forc", "did you mean 'pivot.force'"), ("rod", "rod.position"), ("", "parts"),
                         ("rod.quaternion", "component"), ("pivto.angle", "pivot.angle")):
        with pytest.raises(lv.InputError, match=answer):
            rod.peak(name)
    with pytest.raises(lv.InputError, match="is in N"):
        rod.peak("pivot.force", unit="deg")
    with pytest.raises(AttributeError, match="angle_rate"):
        rod["pivot"].angular_velocity
    with pytest.raises(AttributeError, match=r"\.force"):
        rod["pivot"].reaction
    m = lv.Model()
    m.add_body("p", lv.point(mass=1), velocity=(1, 0, 0))
    sol = lv.solve(m, 1)
    with pytest.raises(lv.InputError, match="point masses") as raised:
        sol.peak("p.angular_velocity")
    assert raised.value.code == "quantity-unbounded"
    assert sol.peak("p.velocity").value == pytest.approx(1)
