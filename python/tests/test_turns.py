# SPDX-License-Identifier: BSD-3-Clause
"""Universal and ball joints by their own coordinates: against rotations of SciPy, and against equations that were reduced
by hand and integrated by DOP853."""
from __future__ import annotations

from typing import Any

import numpy as np
import pytest

import livens as lv

integrate = pytest.importorskip("scipy.integrate")
Rotation = pytest.importorskip("scipy.spatial.transform").Rotation

J = np.array([0.5, 0.6, 0.7])   # about the joint's point, where the reference point is
MASS, CENTRE = 2.0, np.array([0.0, 0.0, -0.3])
GRAVITY = np.array([0.0, 0.0, -9.81])


def body_on(m: lv.Model, w: Any = (0, 0, 0), gravity: bool = True) -> Any:
    """One that a joint holds in the origin: J is its inertia about that."""
    about_centre = J - MASS * np.array([CENTRE[2] ** 2, CENTRE[2] ** 2, 0]) if gravity else J
    return m.add_body("b", mass=MASS, inertia=tuple(about_centre), center_of_mass=CENTRE if gravity else (0, 0, 0),
                      angular_velocity=w)


def cross(w: Any = (0, 0, 0), gravity: bool = True, **keys: Any) -> lv.Model:
    """On a universal joint: about x of the world, then about y of the body."""
    m = lv.Model("cross", gravity=GRAVITY if gravity else (0, 0, 0))
    body_on(m, w, gravity)
    m.add_universal("u", "world", "b", at=(0, 0, 0), axes=[(1, 0, 0), (0, 1, 0)], **keys)
    return m


def ball(w: Any = (0, 0, 0), gravity: bool = False, **keys: Any) -> lv.Model:
    m = lv.Model("ball", gravity=GRAVITY if gravity else (0, 0, 0))
    body_on(m, w, gravity)
    m.add_spherical("ball", "world", "b", at=(0, 0, 0), **keys)
    return m


def turned(sol: Any, body: str = "b") -> Any:
    w, x, y, z = sol[body].quaternion.T
    return Rotation.from_quat(np.stack([x, y, z, w], axis=1))


def cross_by_hand(q: Any, v: Any, force: Any, weight: bool = True) -> Any:
    """Accelerations of the two angles: w = A q' in axes of the body, A^T (J w' + w x J w - torque) = force."""
    s, c = np.sin(q[1]), np.cos(q[1])
    A = np.array([[c, 0], [0, 1], [s, 0]])
    w, drift = A @ v, np.array([-s, 0, c]) * v[0] * v[1]
    R = Rotation.from_euler("XY", q).as_matrix()
    torque = MASS * np.cross(CENTRE, R.T @ GRAVITY) if weight else np.zeros(3)
    return np.linalg.solve(A.T * J @ A, force + A.T @ (torque - J * drift - np.cross(w, J * w)))


def by_dop853(slope: Any, y: Any, t: float) -> Any:
    return integrate.solve_ivp(lambda t, y: slope(t, y), (0, t), y, method="DOP853", rtol=1e-13, atol=1e-14).y[:, -1]


# --- universal joints

def test_angles_of_a_cross_are_those_of_its_rotation_over_turns() -> None:
    m = cross((9, 7, 0), gravity=False)
    m.add_sensor("s", type="joint", joint="u")
    sol = lv.solve(m, 6, accuracy=1e-10)
    first, second = turned(sol).as_euler("XYZ").T[:2]
    R = turned(sol).as_matrix()   # Rx(a) Ry(b): its second column is (0, cos a, sin a), its first row (cos b, 0, sin b)
    one = np.unwrap(np.arctan2(R[:, 2, 1], R[:, 1, 1]))
    two = np.unwrap(np.arctan2(R[:, 0, 2], R[:, 0, 0]))
    u = sol["u"]
    assert np.abs(u.angle_1 - one).max() < 1e-8 and np.abs(u.angle_2 - two).max() < 1e-8
    assert u.angle_1[-1] > 6 * np.pi or u.angle_2[-1] > 6 * np.pi, "several turns"
    assert np.abs(np.sin(u.angle_1) - np.sin(first)).max() > 0.1 or np.abs(second).max() <= np.pi / 2   # not Euler's
    w = sol["b"].angular_velocity
    s, c = np.sin(u.angle_1), np.cos(u.angle_1)
    assert np.allclose(w, np.stack([u.angle_1_rate, c * u.angle_2_rate, s * u.angle_2_rate], axis=1), atol=1e-9)
    assert np.array_equal(sol.sensors["s"].angle_2, u.angle_2)
    for i in range(len(sol.t)):
        q, v = np.array([u.angle_1[i], u.angle_2[i]]), np.array([u.angle_1_rate[i], u.angle_2_rate[i]])
        expected = cross_by_hand(q, v, np.zeros(2), weight=False)
        assert np.allclose([u.angle_1_acceleration[i], u.angle_2_acceleration[i]], expected, atol=1e-7)


def test_springs_of_a_cross_against_reduced_equations() -> None:
    m = cross((2, 3, 0), angle_1={"stiffness": 8, "rest": "20 deg", "damping": 0.3}, angle_2={"stiffness": 5, "damping": 0.2})

    def slope(t: float, y: Any) -> Any:
        q, v = y[:2], y[2:]
        force = np.array([-8 * (q[0] - np.radians(20)) - 0.3 * v[0], -5 * q[1] - 0.2 * v[1]])
        return np.concatenate([v, cross_by_hand(q, v, force)])
    sol = lv.solve(m, 3, accuracy=1e-11)
    u = sol["u"]
    found = np.array([u.angle_1[-1], u.angle_2[-1], u.angle_1_rate[-1], u.angle_2_rate[-1]])
    expected = by_dop853(slope, np.array([0, 0, 2, 3]), 3)
    assert np.abs(found - expected).max() < 1e-9
    assert np.allclose(u.angle_1_effort, -8 * (u.angle_1 - np.radians(20)) - 0.3 * u.angle_1_rate, atol=1e-11)
    free = lv.solve(cross((2, 3, 0)), 3, accuracy=1e-10)["u"]
    assert abs(free.angle_1[-1] - expected[0]) > 0.1   # would be seen


def test_energy_of_springs_is_kept_and_orders_are_2p() -> None:
    m = cross((2, 3, 0), angle_1={"stiffness": 8}, angle_2={"stiffness": 5})
    sol = lv.solve(m, 3, accuracy=1e-11)
    assert np.abs(sol.energy - sol.energy[0]).max() < 1e-9
    m = ball((1.5, 2, 1), stiffness=6)
    best = lv.solve(m, 1, elements=128, method=lv.Lobatto(4))["b"].directors[-1]
    errors = [np.abs(lv.solve(m, 1, elements=n, method=lv.Lobatto(2))["b"].directors[-1] - best).max() for n in (16, 32, 64)]
    orders = np.log2(np.array(errors[:-1]) / errors[1:])
    assert np.abs(orders - 4).max() < 0.2


def test_a_cross_is_driven_and_its_torque_is_that_of_inverse_dynamics() -> None:
    m = cross()
    m.add_joint_drive("one", "u", coordinate="angle_1", expression="0.4*sin(3*t)")
    m.add_joint_drive("two", "u", coordinate="angle_2", expression="2*t^2")
    m.start.initial = "project"
    sol = lv.solve(m, 2.5, accuracy=1e-10)
    t, u = sol.t, sol["u"]
    assert np.abs(u.angle_1 - 0.4 * np.sin(3 * t)).max() < 1e-12 and np.abs(u.angle_2 - 2 * t * t).max() < 1e-11
    assert u.angle_2[-1] > 2 * np.pi
    for i in range(0, len(t), 7):
        q, v = np.array([u.angle_1[i], u.angle_2[i]]), np.array([1.2 * np.cos(3 * t[i]), 4 * t[i]])
        a = np.array([-3.6 * np.sin(3 * t[i]), 4])
        s, c = np.sin(q[1]), np.cos(q[1])
        A = np.array([[c, 0], [0, 1], [s, 0]])
        force = A.T * J @ A @ (a - cross_by_hand(q, v, np.zeros(2)))
        assert np.allclose([sol["one"].effort[i], sol["two"].effort[i]], force, atol=1e-8)


def test_trees_are_told_by_the_angles_of_their_crosses_and_balls() -> None:
    m = cross()
    assert m.coordinates.q == ("u.angle_1", "u.angle_2")
    q, v = {"u.angle_1": 0.7, "u.angle_2": 8.0}, {"u.angle_1": 2.0, "u.angle_2": -1.0}
    state = m.at(q, v)
    assert state["u"].angle_2 == pytest.approx(8, abs=1e-12) and state["u"].angle_1_rate == pytest.approx(2, abs=1e-12)
    s, c = np.sin(8.0), np.cos(8.0)
    A = np.array([[c, 0], [0, 1], [s, 0]])
    assert np.allclose(state.mass_matrix, A.T * J @ A, atol=1e-12)
    assert np.allclose(state.accelerations(), cross_by_hand(np.array([0.7, 8]), np.array([2, -1]), np.zeros(2)), atol=1e-11)
    sol = lv.solve(m, 0.5, start=state.state)
    assert sol["u"].angle_2[0] == pytest.approx(8, abs=1e-10)
    m = ball(angles="zyx", gravity=True)
    assert m.coordinates.q == ("ball.angle_1", "ball.angle_2", "ball.angle_3")
    state = m.at({"ball.angle_1": 0.5, "ball.angle_2": -1.2, "ball.angle_3": 3.0})
    R = Rotation.from_euler("ZYX", (0.5, -1.2, 3.0)).as_matrix()
    assert np.allclose(Rotation.from_quat(np.roll(state["b"].quaternion, -1)).as_matrix(), R, atol=1e-12)
    assert ball().coordinates.q == ("b.qw", "b.qx", "b.qy", "b.qz")
    reached = lv.reach(m, "b", ((0, 0, 0), Rotation.from_euler("ZYX", (0.3, 0.4, -0.2))))
    assert np.allclose(list(reached.values()), (0.3, 0.4, -0.2), atol=1e-9)


# --- ball joints

def spin_by_hand(y: Any, torque: Any) -> Any:
    """Quaternion (x, y, z, w) and angular velocity in axes of the body."""
    q, w = y[:4], y[4:]
    x = 0.5 * np.concatenate([q[3] * w + np.cross(q[:3], w), [-q[:3] @ w]])
    return np.concatenate([x, (torque - np.cross(w, J * w)) / J])


@pytest.mark.parametrize("frames", [False, True])
def test_the_spring_of_a_ball_against_eulers_equations(frames: bool) -> None:
    k, d = 6.0, 0.3
    where: dict[str, Any] = {"at": (0, 0, 0)}
    rest = Rotation.from_rotvec((0.3, -0.2, 0.5)) if frames else Rotation.identity()
    if frames:
        where = {"frames": [{"rotation_vector": (0.3, -0.2, 0.5)}, {}]}
    m = lv.Model("ball")
    body_on(m, (1.5, 2, 1), gravity=False)
    m.add_spherical("ball", "world", "b", stiffness=k, damping=d, **where)

    def slope(t: float, y: Any) -> Any:
        r = (rest.inv() * Rotation.from_quat(y[:4])).as_rotvec()   # the same in axes of the first frame and of the second
        return spin_by_hand(y, -k * r - d * y[4:])
    sol = lv.solve(m, 3, accuracy=1e-11)
    expected = by_dop853(slope, np.array([0, 0, 0, 1, 1.5, 2, 1]), 3)
    off = Rotation.from_quat(expected[:4]).inv() * turned(sol)[-1]
    assert np.linalg.norm(off.as_rotvec()) < 1e-9
    assert np.abs(sol["b"].angular_velocity_body[-1] - expected[4:]).max() < 1e-8
    free = lv.solve(ball((1.5, 2, 1)), 3, accuracy=1e-10)
    assert np.linalg.norm((Rotation.from_quat(expected[:4]).inv() * turned(free)[-1]).as_rotvec()) > 0.1   # would be seen


def test_what_a_ball_reads_is_what_scipy_says() -> None:
    m = ball((1.5, 1.2, 0.8), gravity=True, angles="yzx")
    m.add_sensor("s", type="joint", joint="ball")
    sol = lv.solve(m, 1.2, accuracy=1e-10)
    angles, vector = turned(sol).as_euler("YZX"), turned(sol).as_rotvec()
    s = sol.sensors["s"]
    for k in range(3):
        assert np.abs(np.unwrap(angles[:, k]) - getattr(sol["ball"], f"angle_{k + 1}")).max() < 1e-8
        assert np.abs(vector[:, k] - s[f"rotation_vector_{'xyz'[k]}"]).max() < 1e-8
    assert np.abs(np.linalg.norm(vector, axis=1) - s.rotation_angle).max() < 1e-8
    spline = pytest.importorskip("scipy.interpolate").CubicSpline(sol.t, s.rotation_vector_x)
    assert np.abs(spline(sol.t, 1) - s.rotation_vector_x_rate)[2:-2].max() < 1e-2
    pytest.importorskip("pandas")
    assert any("angle_3" in str(column) for column in sol.to_dataframe("ball").columns)
    assert sol.peak("ball.angle_2").value == pytest.approx(float(sol["ball"].angle_2[np.abs(sol["ball"].angle_2).argmax()]), abs=0.05)


def test_springs_along_angles_of_a_ball_against_the_integral_by_hand() -> None:
    m = ball((1, 0.7, -0.5), angles="xyz", angle_1={"stiffness": 4}, angle_2={"stiffness": 9, "rest": "-10 deg"},
             angle_3={"stiffness": 3, "damping": 0.2})

    def slope(t: float, y: Any) -> Any:
        a, b, c = Rotation.from_quat(y[:4]).as_euler("XYZ")
        # w = B q' in axes of the body, and a torque T with B^T T = Q
        sb, cb, sc, cc = np.sin(b), np.cos(b), np.sin(c), np.cos(c)
        B = np.array([[cb * cc, sc, 0], [-cb * sc, cc, 0], [sb, 0, 1]])
        rates = np.linalg.solve(B, y[4:])
        Q = np.array([-4 * a, -9 * (b + np.radians(10)), -3 * c - 0.2 * rates[2]])
        return spin_by_hand(y, np.linalg.solve(B.T, Q))
    sol = lv.solve(m, 2.5, accuracy=1e-11)
    expected = by_dop853(slope, np.array([0, 0, 0, 1, 1, 0.7, -0.5]), 2.5)
    off = Rotation.from_quat(expected[:4]).inv() * turned(sol)[-1]
    assert np.linalg.norm(off.as_rotvec()) < 1e-9


def test_three_drives_of_a_ball() -> None:
    m = ball(angles="zyx", gravity=True)
    laws = ("0.5*sin(2*t)", "1.2*sin(t)", "3*t^2")
    m.add_joint_drive("d1", "ball", coordinate="angle_1", expression=laws[0])
    m.add_joint_drive("d2", "ball", coordinate="angle_2", expression=laws[1])
    m.add_joint_drive("d3", "ball", coordinate="angle_3", expression=laws[2])
    m.start.initial = "project"
    sol = lv.solve(m, 2, accuracy=1e-10)
    t = sol.t
    expected = np.stack([0.5 * np.sin(2 * t), 1.2 * np.sin(t), 3 * t * t], axis=1)
    found = np.stack([getattr(sol["ball"], f"angle_{k}") for k in (1, 2, 3)], axis=1)
    assert np.abs(found - expected).max() < 1e-11
    R = Rotation.from_euler("ZYX", expected)
    assert np.linalg.norm((R.inv() * turned(sol)).as_rotvec(), axis=1).max() < 1e-10
    free = ball(angles="zyx", gravity=True)
    rates = np.stack([np.cos(2 * t), 1.2 * np.cos(t), 6 * t], axis=1)
    slopes = np.stack([-2 * np.sin(2 * t), -1.2 * np.sin(t), 6 + 0 * t], axis=1)
    for i in range(0, len(t), 9):
        state = free.at(expected[i], rates[i])
        efforts = [sol[f"d{k}"].effort[i] for k in (1, 2, 3)]
        assert np.allclose(efforts, state.inverse_dynamics(slopes[i]), atol=1e-7)


def test_limits_hold_a_ball_and_a_cross() -> None:
    m = ball((2, 0, 0.5), limit="30 deg")
    m.add_sensor("s", type="joint", joint="ball")
    sol = lv.solve(m, 2)
    most = sol.sensors["s"].rotation_angle.max()
    assert np.radians(30) < most < np.radians(36)
    assert any("beyond its limits" in note for note in sol.notes)
    assert lv.solve(ball((2, 0, 0.5)), 2)["b"].quaternion[:, 0].min() < np.cos(np.radians(40) / 2)   # would be seen
    m = cross((2, 0, 0), gravity=False, angle_1={"limits": ("-20 deg", "20 deg")})
    assert np.radians(20) < np.abs(lv.solve(m, 2)["u"].angle_1).max() < np.radians(25)


def test_angles_are_coupled() -> None:
    m = cross((1, 0, 0), gravity=False)
    m.add_body("c", mass=1, inertia=(0.1, 0.1, 0.1), position=(1, 0, 0))
    m.add_spherical("other", "world", "c", at=(1, 0, 0), angles="xyz")
    m.add_coupling("follow", {"u.angle_1": 1, "other.angle_1": -2})
    m.add_coupling("lean", {"u.angle_2": 1, "other.angle_2": 1})
    m.add_torque("push", "b", value=(0, 0.3, 0))
    m.start.initial = "project"
    sol = lv.solve(m, 1.5)
    u, other = sol["u"], sol["other"]
    assert np.abs(u.angle_1 - 2 * other.angle_1).max() < 1e-10
    assert np.abs(u.angle_2 + other.angle_2).max() < 1e-10 and np.abs(u.angle_2).max() > 0.1


def test_rest_and_modes() -> None:
    m = ball(gravity=True, stiffness=40, angles="xyz")
    m.add_torque("push", "b", value=(3, 0, 0))
    rest = m.find_equilibrium()
    # in the plane of y and z: 40 q + m g l sin(q) = 3
    q = 3 / (40 + MASS * 9.81 * 0.3)
    for _ in range(50):
        q -= (40 * q + MASS * 9.81 * 0.3 * np.sin(q) - 3) / (40 + MASS * 9.81 * 0.3 * np.cos(q))
    assert rest["ball"].angle_1 == pytest.approx(q, abs=1e-9)
    m.remove("push")
    w = np.sort(m.vibration_modes().frequency)
    weight = MASS * 9.81 * 0.3
    expected = np.sort(np.sqrt([(40 + weight) / J[0], (40 + weight) / J[1], 40 / J[2]]))
    assert np.allclose(w, expected, rtol=1e-9)


def test_half_a_turn_and_a_quarter_are_named() -> None:
    m = ball((0, 0, 2))
    m.add_sensor("s", type="joint", joint="ball")
    with pytest.warns(lv.SolveWarning, match="rotation vector of sensor 's' have no value near t = 1.5.*175 degrees"):
        sol = lv.solve(m, 3, output=[1.5, 1.55, 1.6])
    near = np.abs(2 * sol.t - np.pi) < np.pi - 3.05
    assert near.any() and np.isnan(sol.sensors["s"].rotation_angle[near]).all()
    assert np.isfinite(sol.sensors["s"].rotation_angle[~near]).all()   # negative control
    assert lv.solve(m, 1.4).success
    with pytest.warns(lv.SolveWarning, match="angles of joint 'ball' have no value .* second one gets to 90 degrees"):
        lv.solve(ball((0, 2, 0), angles="xyz"), 1.5)
    assert lv.solve(ball((0, 2, 0), angles="yxz"), 1.5).success   # negative control
    with pytest.warns(lv.SolveWarning, match="joint 'ball' reaches half a turn"):
        lv.solve(ball((0, 0, 9), stiffness=1), 3)
    with pytest.warns(lv.SolveWarning, match="end 0.6 degrees before"):
        lv.solve(ball((0, 4, 0), angles="xyz", angle_2={"stiffness": 1}), 3)


def test_round_trip_and_mistakes() -> None:
    m = ball(angles="xyz", stiffness="2 N m/rad", damping=0.1, limit="60 deg", angle_2={"damping": 0.3})
    m.add_body("c", lv.box(1, 1, 1, mass=1))
    m.add_universal("u", "b", "c", at=(1, 0, 0), axes=[(0, 1, 0), (0, 0, 1)], angle_1={"stiffness": 3})
    assert lv.load(text=m.to_toml()) == m
    wrongs: list[tuple[str, Any]] = [
        ("joint-coordinate", lambda m: m.add_joint_drive("d", "ball", value=0)),
        ("joint-coordinate", lambda m: m.add_joint_drive("d", "ball", coordinate="angle", value=0)),
        ("drive-angle", lambda m: m.add_joint_drive("d", "ball", coordinate="angle_2", value="90 deg")),
        ("joint-loads", lambda m: m.add_spherical("o", "world", "c", at=(0, 0, 0), angle_1={"damping": 1})),
        ("joint-loads", lambda m: m.add_spherical("o", "world", "c", at=(0, 0, 0), limit_stiffness=3)),
        ("joint-limits", lambda m: m.add_spherical("o", "world", "c", at=(0, 0, 0), limit="175 deg")),
        ("unknown-choice", lambda m: m.add_spherical("o", "world", "c", at=(0, 0, 0), angles="zxz"))]
    for code, wrong in wrongs:
        bad = m.copy()
        with pytest.raises(lv.InputError, match=code):
            wrong(bad)
            lv.solve(bad, 0.1)
