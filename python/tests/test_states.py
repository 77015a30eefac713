# SPDX-License-Identifier: BSD-3-Clause
"""States in coordinates: against reductions of a four-bar linkage and of a Stewart platform in NumPy, which share nothing
with the engine, and against motions; what is no state is refused."""
from __future__ import annotations

from typing import Any

import numpy as np
import pytest

import livens as lv

GRAVITY = np.array([0.0, 0.0, -9.81])
TINY = 1e-40   # of complex steps


def relative(found: Any, expected: Any) -> float:
    found, expected = np.asarray(found), np.asarray(expected)
    assert found.shape == expected.shape
    return float(np.abs(found - expected).max() / np.abs(expected).max())


# A four-bar linkage in the plane of x and z; angles from x towards z, which are turns about -y.

BARS = {"crank": (0.4, 1.5, 0.03), "coupler": (1.1, 2.0, 0.2), "rocker": (0.9, 1.2, 0.1)}   # length, mass, inertia
GROUND, FIRST = 1.2, 1.0   # its length, and the angle of the crank as it is placed


def along(angle: float) -> Any:
    return np.array([np.cos(angle), np.sin(angle)])


def other_angles(crank: float, guess: tuple[float, float]) -> Any:
    """Of coupler and rocker, by Newton's iteration."""
    (a, *_), (b, *_), (c, *_) = BARS.values()
    x = np.array(guess)
    for _ in range(50):
        open_by = a * along(crank) + b * along(x[0]) - c * along(x[1]) - np.array([GROUND, 0])
        across = np.array([[-b * np.sin(x[0]), c * np.sin(x[1])], [b * np.cos(x[0]), -c * np.cos(x[1])]])
        x = x - np.linalg.solve(across, open_by)
    return x


def four_bar() -> lv.Model:
    m = lv.Model("four-bar", gravity=GRAVITY)
    coupler, rocker = other_angles(FIRST, (0.2, 1.4))
    ends = {"crank": (np.zeros(2), FIRST), "coupler": (0.4 * along(FIRST), coupler), "rocker": (np.array([GROUND, 0]), rocker)}
    for name, (at, angle) in ends.items():
        length, mass, inertia = BARS[name]
        x, z = at + 0.5 * length * along(angle)
        m.add_body(name, mass=mass, inertia=(inertia / 3, inertia, inertia), position=(x, 0, z), rotation_vector=(0, -angle, 0))
    for name, first, second, (x, z) in (("A", "world", "crank", (0, 0)), ("B", "crank", "coupler", ends["coupler"][0]),
                                        ("C", "coupler", "rocker", ends["rocker"][0] + 0.9 * along(rocker)),
                                        ("D", "world", "rocker", (GROUND, 0))):
        m.add_revolute(name, first, second, at=(x, 0, z), axis=(0, -1, 0))
    return m


def four_bar_by_hand(crank: float, rate: float) -> dict[str, Any]:
    """Mass, bias and gravity by three angles, two of which follow."""
    start = other_angles(FIRST, (0.2, 1.4))
    for part in np.linspace(0, 1, 50):
        start = other_angles(FIRST + part * (crank - FIRST), start)
    angles = np.array([crank, *start])
    (a, *_), (b, *_), (c, *_) = BARS.values()

    def rates(angles: Any) -> Any:
        """Of the angles by that of the crank."""
        across = np.array([[-b * np.sin(angles[1]), c * np.sin(angles[2])], [b * np.cos(angles[1]), -c * np.cos(angles[2])]])
        others = np.linalg.solve(across, -a * np.array([-np.sin(angles[0]), np.cos(angles[0])]))
        return np.array([1, others[0], others[1]])

    def moved(angles: Any) -> Any:
        """x, z, angle of the three centres by the rate of the crank, shape (3, 3)."""
        w = rates(angles)
        turned = [np.array([-np.sin(x), np.cos(x)]) for x in angles]
        pin = a * w[0] * turned[0]
        places = [0.5 * pin, pin + 0.5 * b * w[1] * turned[1], 0.5 * c * w[2] * turned[2]]
        return np.array([[*places[i], w[i]] for i in range(3)])
    J = moved(angles)
    drift = moved(angles + 1j * TINY * rates(angles) * rate).imag / TINY * rate
    weigh = np.array([[mass, mass, inertia] for _, mass, inertia in BARS.values()])
    held = 9.81 * weigh[:, 0] @ J[:, 1]
    return {"mass": np.array([[(J * weigh * J).sum()]]), "gravity": np.array([held]),
            "bias": np.array([(J * weigh * drift).sum() + held]), "angles": angles, "J": J}


@pytest.mark.parametrize("crank, rate", [(0.3, 1.5), (2.5, -2.0), (-2.0, 0.7), (8.0, 1.0)])
def test_four_bar_as_reduced_by_hand(crank: float, rate: float) -> None:
    m, expected = four_bar(), four_bar_by_hand(crank, rate)
    state = m.at({"A.angle": crank - FIRST}, {"A.angle": rate})
    assert state.coordinates.v == ("A.angle_rate",)
    assert relative(state.mass_matrix, expected["mass"]) < 1e-12
    assert relative(state.bias_forces, expected["bias"]) < 1e-12
    assert relative(state.gravity_forces, expected["gravity"]) < 1e-12
    a = 3.0
    assert relative(state.inverse_dynamics([a]), expected["mass"][0] * a + expected["bias"]) < 1e-12
    for i, name in enumerate(BARS):
        x, z, turn = expected["J"][i]
        assert relative(state.jacobian(name)[:, 0], (x, 0, z, 0, -turn, 0)) < 1e-12
    assert abs(four_bar_by_hand(crank, 1.001 * rate)["bias"] - expected["bias"])[0] > 1e-6   # would be seen


# A Stewart platform: six legs, each on a universal joint, with a slider, under a ball of the platform.

UPRIGHT = np.array([0.0, 1.0, 0.0])   # axis of the universal joints in the ground


def unit(v: Any) -> Any:
    return v / np.sqrt((v * v).sum())


def feet_and_balls() -> tuple[Any, Any]:
    angles = np.radians([10, 110, 130, 230, 250, 350])
    feet = np.array([(np.cos(x), np.sin(x), 0) for x in angles]) * 1.1
    balls = np.array([(0.6 * np.cos(x), 0.6 * np.sin(x), 0) for x in np.radians([50, 70, 170, 190, 290, 310])])
    return feet, balls


def leg_triad(s: Any) -> Any:
    across = unit(np.cross(UPRIGHT, s))
    return np.array([across, np.cross(unit(s), across), unit(s)]).T


LOWER, UPPER, PLATFORM = (2.0, (0.06, 0.06, 0.004)), (1.0, (0.03, 0.03, 0.002)), (8.0, (0.7, 0.8, 1.3))
FROM_FOOT, FROM_BALL = 0.35, 0.3   # of the legs' centres of mass, along the leg


def stewart() -> lv.Model:
    m = lv.Model("Stewart platform", gravity=GRAVITY)
    feet, balls = feet_and_balls()
    centre = np.array([0.05, -0.02, 1.1])
    m.add_body("platform", mass=PLATFORM[0], inertia=PLATFORM[1], position=centre)
    for i in range(6):
        s = centre + balls[i] - feet[i]
        triad = leg_triad(s)
        m.add_body(f"lower {i}", mass=LOWER[0], inertia=LOWER[1], position=feet[i] + FROM_FOOT * unit(s), directors=triad.T)
        m.add_body(f"upper {i}", mass=UPPER[0], inertia=UPPER[1], position=centre + balls[i] - FROM_BALL * unit(s),
                   directors=triad.T)
        m.add_universal(f"foot {i}", "world", f"lower {i}", at=feet[i], axes=[UPRIGHT, triad[:, 0]])
        m.add_prismatic(f"leg {i}", f"lower {i}", f"upper {i}", at=feet[i], axis=s)
        m.add_spherical(f"ball {i}", f"upper {i}", "platform", at=centre + balls[i])
    return m


def rotation(q: Any) -> Any:
    w, x, y, z = q
    return np.array([[1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
                     [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
                     [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)]])


def stewart_twists(position: Any, R: Any) -> tuple[Any, Any]:
    """Lengths by the platform's twist, shape (6, 6); and twists of all centres of mass by it, shape (13, 6, 6)."""
    feet, balls = feet_and_balls()
    lengths, twists = [], [np.eye(6, dtype=complex)]
    for i in range(6):
        arm = R @ balls[i]
        s = position + arm - feet[i]
        length = np.sqrt((s * s).sum())
        along_leg = s / length
        lower, upper, longer = [], [], []
        for k in range(6):
            v, w = (np.eye(3)[k], np.zeros(3)) if k < 3 else (np.zeros(3), np.eye(3)[k - 3])
            ds = v + np.cross(w, arm)
            dl = (along_leg * ds).sum()
            turn = np.cross(s, ds) / length**2
            n, dn = np.cross(UPRIGHT, s), np.cross(UPRIGHT, ds)
            across = unit(n)
            size = np.sqrt((n * n).sum())
            d_across = dn / size - across * (across * dn).sum() / size
            turn = turn + along_leg * (d_across * np.cross(along_leg, across)).sum()
            longer.append(dl)
            lower.append([*(FROM_FOOT * np.cross(turn, along_leg)), *turn])
            upper.append([*(ds - FROM_BALL * np.cross(turn, along_leg)), *turn])
        lengths.append(longer)
        twists += [np.array(lower).T, np.array(upper).T]
    return np.array(lengths), np.array(twists)


def test_stewart_platform_as_reduced_by_hand() -> None:
    m = stewart()
    assert m.coordinates.q == tuple(f"leg {i}.displacement" for i in range(6))
    rng = np.random.default_rng(4)
    q, v, a = rng.uniform(-0.15, 0.15, 6), rng.uniform(-1, 1, 6), rng.uniform(-2, 2, 6)
    state = m.at(q, v)
    placed, at = m.at()["platform"].position, state["platform"]
    R = rotation(at.quaternion)
    feet, balls = feet_and_balls()
    longer = [np.linalg.norm(at.position + R @ b - f) - np.linalg.norm(placed + b - f) for f, b in zip(feet, balls)]
    assert np.abs(longer - q).max() < 1e-13

    def by_rates(position: Any, R: Any) -> Any:
        lengths, twists = stewart_twists(position, R)
        return twists @ np.linalg.inv(lengths)
    J = by_rates(at.position, R).real
    assert relative(state.jacobian("platform"), J[0]) < 1e-12
    twist = J[0] @ v
    skew = np.array([np.cross(twist[3:], e) for e in np.eye(3)]).T
    drift = by_rates(at.position + 1j * TINY * twist[:3], R + 1j * TINY * skew @ R).imag / TINY @ v
    inertias = [(PLATFORM, R)]
    for i in range(6):
        triad = leg_triad(at.position + R @ balls[i] - feet[i])
        inertias += [(LOWER, triad), (UPPER, triad)]
    M, bias, held = np.zeros((6, 6)), np.zeros(6), np.zeros(6)
    for of_body, moved, ((mass, moments), axes) in zip(J, drift, inertias):
        inertia, w = axes @ np.diag(moments) @ axes.T, of_body[3:] @ v
        M += mass * of_body[:3].T @ of_body[:3] + of_body[3:].T @ inertia @ of_body[3:]
        held -= mass * of_body[:3].T @ GRAVITY
        bias += mass * of_body[:3].T @ moved[:3] + of_body[3:].T @ (inertia @ moved[3:] + np.cross(w, inertia @ w))
    assert relative(state.mass_matrix, M) < 1e-12
    assert relative(state.gravity_forces, held) < 1e-12
    assert relative(state.bias_forces, bias + held) < 1e-12
    assert relative(state.inverse_dynamics(a), M @ a + bias + held) < 1e-12
    assert relative(state.accelerations(state.inverse_dynamics(a)), a) < 1e-11


def test_stewart_platform_is_led_to_a_pose() -> None:
    """Legs are as long as the pose makes them."""
    m = stewart()
    placed = m.at()["platform"].position
    goal, turned = placed + (0.1, -0.15, 0.2), (np.cos(0.15), 0.6 * np.sin(0.15), 0, 0.8 * np.sin(0.15))
    q = lv.reach(m, "platform", (goal, turned))
    feet, balls = feet_and_balls()
    for i in range(6):
        longer = np.linalg.norm(goal + rotation(turned) @ balls[i] - feet[i]) - np.linalg.norm(placed + balls[i] - feet[i])
        assert q[f"leg {i}.displacement"] == pytest.approx(longer, abs=1e-12)
    with pytest.raises(lv.InputError, match="coordinates-singular|loop-open|pose-unreachable"):
        lv.reach(m, "platform", (placed + (0, 0, -1.1), turned))


def robot() -> lv.Model:
    """A floating body with an arm of two links, a damper and a spring."""
    m = lv.Model("floating arm", gravity=GRAVITY)
    m.add_body("base", lv.box(0.4, 0.3, 0.2, mass=3), position=(0, 0, 1))
    m.add_body("upper", lv.box(0.5, 0.1, 0.1, mass=1), position=(0.45, 0, 1))
    m.add_body("lower", lv.box(0.4, 0.1, 0.1, mass=0.5), position=(0.9, 0, 1))
    m.add_revolute("shoulder", "base", "upper", at=(0.2, 0, 1), axis=(0, 1, 0), damping=0.3)
    m.add_revolute("elbow", "upper", "lower", at=(0.7, 0, 1), axis=(0, 0, 1), stiffness=2, rest=0.1)
    m.add_point("tip", "lower", position=(0.2, 0, 0))
    return m


STATED = {"base.position": (1, 2, 3), "base.rotation_vector": (0.1, "-0.4 rad", 0.7), "shoulder.angle": "40 deg", "elbow.angle": -0.8}
MOVING = {"base.velocity": (0.2, 0.1, -0.3), "base.angular_velocity": (0.5, -0.2, 0.9), "shoulder.angle": 0.7,
          "elbow.angle_rate": -1.1}


def test_a_free_body_is_stated_by_position_and_quaternion() -> None:
    m = robot()
    assert m.coordinates.q == ("base.x", "base.y", "base.z", "base.qw", "base.qx", "base.qy", "base.qz", "shoulder.angle",
                               "elbow.angle")
    assert m.coordinates.v == ("base.x_rate", "base.y_rate", "base.z_rate", "base.wx", "base.wy", "base.wz",
                               "shoulder.angle_rate", "elbow.angle_rate")
    state = m.at(STATED, MOVING)
    again = m.at(state.q, state.v)
    assert np.allclose(state["base"].position, (1, 2, 3), atol=1e-15)
    assert np.abs(again.mass_matrix - state.mass_matrix).max() < 1e-14
    assert state["shoulder"].angle == pytest.approx(np.radians(40), abs=1e-15)
    assert state["elbow"].angle_rate == pytest.approx(-1.1, abs=1e-14)
    assert state["base"].angular_velocity == pytest.approx((0.5, -0.2, 0.9), abs=1e-15)
    assert 0.5 * state.v @ state.mass_matrix @ state.v == pytest.approx(state.kinetic, rel=1e-14)
    assert state.load_forces[6:] == pytest.approx((-0.3 * 0.7, -2 * (-0.8 - 0.1)), rel=1e-13)
    tip = state.jacobian("tip") @ state.v
    assert tip == pytest.approx(state.jacobian("lower", (0.2, 0, 0)) @ state.v, abs=1e-15)


def test_accelerations_are_those_at_the_start_of_a_motion() -> None:
    m = robot()
    state = m.at(STATED, MOVING)
    motion = lv.solve(m, 0.01, accuracy=1e-10, start=state.state)
    for name in m.bodies:
        found = state.jacobian(name) @ state.accelerations() + state.drift(name)
        assert motion[name].acceleration[0] == pytest.approx(found[:3], abs=1e-9)
        assert motion[name].angular_acceleration[0] == pytest.approx(found[3:], abs=1e-9)


def test_a_motion_starts_at_a_state_with_its_turns() -> None:
    m = four_bar()
    state = m.at({"A.angle": 9.0}, {"A.angle": 1.0})
    motion = lv.solve(m, 0.1, accuracy=1e-8, start=state.state)
    assert motion["A"].angle[0] == pytest.approx(9.0, abs=1e-12)
    assert motion["A"].angle_rate[0] == pytest.approx(1.0, abs=1e-9)
    assert motion.energy[0] == pytest.approx(state.energy, rel=1e-12)


def test_turns_of_what_follows_are_counted() -> None:
    m = lv.Model("gears")
    m.add_body("small", lv.cylinder(0.1, 0.05, mass=1))
    m.add_body("large", lv.cylinder(0.2, 0.05, mass=2), position=(0.3, 0, 0))
    m.add_revolute("a", "world", "small", at=(0, 0, 0), axis=(0, 0, 1))
    m.add_revolute("b", "world", "large", at=(0.3, 0, 0), axis=(0, 0, 1))
    m.add_gear("mesh", joints=["a", "b"], ratio=-0.5)
    state = m.at({"a.angle": 50.0})
    assert state["b"].angle == pytest.approx(-25, abs=1e-12)
    assert m.at({"b.angle": -25.0})["a"].angle == pytest.approx(50, abs=1e-12)
    assert lv.solve(m, 0.1, start=state.state)["b"].angle[0] == pytest.approx(-25, abs=1e-12)
    linkage = four_bar()
    turns = linkage.at({"A.angle": 0.5 + 4 * np.pi}), linkage.at({"A.angle": 0.5})
    assert turns[0]["D"].angle == pytest.approx(turns[1]["D"].angle, abs=1e-9)   # it swings
    assert turns[0]["B"].angle == pytest.approx(turns[1]["B"].angle - 4 * np.pi, abs=1e-9)


def test_state_matrices_foretell_a_small_change() -> None:
    m = robot()
    state = m.at(STATED, MOVING)
    A, B, *_, inputs, outputs = state.state_matrices()
    assert inputs[3:] == ("base.rx", "base.ry", "base.rz", "shoulder.angle", "elbow.angle") and len(outputs) == 16
    h = 1e-4
    for k, name in ((6, "shoulder.angle"), (7, "elbow.angle"), (0, "base.x")):
        number = m.coordinates.q.index(name)
        q = [state.q + by * h * np.eye(9)[number] for by in (-1, 1)]
        slope = (m.at(q[1], state.v).accelerations() - m.at(q[0], state.v).accelerations()) / (2 * h)
        assert A[8:, k] == pytest.approx(slope, abs=1e-5)
    assert B[8:] == pytest.approx(np.linalg.inv(state.mass_matrix), abs=1e-12)
    assert A[3:6, 3:6] == pytest.approx(np.cross(state.v[3:6], np.eye(3)).T, abs=1e-15)


def test_drives_are_released_and_joints_that_do_not_act_are_left_out() -> None:
    m = four_bar()
    m.add_joint_drive("motor", joint="A", value=0)
    m.add_force("push", "rocker", expression=("0", "0", "3*t"))
    assert list(m.coordinates) == ["A.angle"]
    held = m.at().load_forces
    assert held == pytest.approx([0], abs=1e-15)
    assert m.at(t="500 ms").load_forces == pytest.approx(m.at().jacobian("rocker")[2] * 1.5, rel=1e-13)
    m.joints["C"].until = 0.4
    m.time.end = 1
    assert list(m.coordinates) == ["A.angle"]
    assert list(m.at(t=0.5).coordinates) == ["A.angle", "B.angle", "D.angle"]


def test_reach_brings_a_tool_to_a_pose() -> None:
    m = robot()
    goal = m.at({"shoulder.angle": 0.5, "elbow.angle": 0.9})
    tip = goal["lower"].position
    q = lv.reach(m, "lower", (tip, goal["lower"].quaternion))
    found = m.at(q)["lower"]
    assert found.position == pytest.approx(tip, abs=1e-12)
    assert abs(found.quaternion @ goal["lower"].quaternion) == pytest.approx(1, abs=1e-12)
    assert m.at(lv.reach(m, "tip", (2, 0, 1)))["lower"].position[0] > 1.5
    linkage = four_bar()
    target = linkage.at({"A.angle": 0.7})["rocker"].position
    assert lv.reach(linkage, "rocker", target)["A.angle"] == pytest.approx(0.7, abs=1e-9)
    with pytest.raises(lv.InputError, match="pose-unreachable") as caught:
        lv.reach(linkage, "crank", (5, 0, 0))
    assert "within 4.8 m" in str(caught.value)


@pytest.mark.parametrize("q, v, code, words", [
    ({"A.angle": 1, "D.angle": 1}, None, "coordinates-dependent", "'D.angle'"),
    ({"D.angle": 2.5}, None, "loop-open", "stays open"),
    ({"A.angel": 1}, None, "coordinate-unknown", "did you mean 'A.angle'"),
    ({"crank.velocity": 1}, None, "coordinate-unknown", "crank.velocity"),
    ([1, 2], None, "coordinate-value", "A.angle"),
    ([float("nan")], None, "coordinate-value", "not finite"),
    ({"A.angle": float("inf")}, None, "coordinate-value", "not finite"),
    ({"A.angle": "1 m"}, None, "unit", "rad"),
    ({"A.angle": "fast"}, None, "expression-name", "fast"),
    ({"A.angle": None}, None, "wrong-type", "one number"),
    ("A.angle", None, "wrong-type", "mapping"),
    (None, {"B.angle": 1}, "coordinate-unknown", "A.angle_rate"),
    (None, [1, 2], "coordinate-value", "A.angle_rate"),
    (None, [float("nan")], "coordinate-value", "not finite"),
    ({"crank.quaternion": (1, 0, 0)}, None, "coordinate-value", "4 numbers"),
    ({"crank.position": (1, 0)}, None, "coordinate-value", "3 numbers"),
    ({"crank.rotation_vector": (1, "2 m", 0)}, None, "unit", "rad"),
    ({"crank.position": (1, None, 0)}, None, "wrong-type", "one number"),
    (None, {"crank.velocity": (1, 0, 0)}, "coordinate-unknown", "crank.velocity"),
])
def test_what_is_no_state_is_refused(q: Any, v: Any, code: str, words: str) -> None:
    with pytest.raises(lv.InputError) as caught:
        four_bar().at(q, v)
    assert caught.value.diagnostics[0].code == code
    assert words in str(caught.value)
    assert "test_states.py" in str(caught.value)


def test_shafts_of_constant_velocity_are_told_by_their_bodies() -> None:
    m = lv.Model("shafts")
    m.add_body("rod", lv.box(0.1, 0.1, 1, mass=1), position=(0, 0, -0.5))
    m.add_constant_velocity("shafts", "world", "rod", at=(0, 0, 0), axes=[(0, 0, 1), (0, 0, 1)])
    assert m.coordinates.q == ("rod.x", "rod.y")
    m.remove("rod")
    m.remove("shafts")
    m.add_body("rod", lv.box(0.1, 0.1, 1, mass=1))
    m.add_constant_velocity("shafts", "world", "rod", at=(0, 0, 0), axes=[(0, 0, 1), (0, 0, 1)])
    with pytest.raises(lv.InputError, match="coordinates-missing") as caught:
        m.at()
    assert "'rod'" in str(caught.value)


def test_angles_of_a_ball_joint_take_units_and_say_where_they_end() -> None:
    m = lv.Model("ball")
    m.add_body("a", mass=1, inertia=(0.1, 0.1, 0.1))
    m.add_spherical("b", "world", "a", at=(0, 0, 0), angles="zyx")
    state = m.at({"b.angle_2": "30 deg"}, {"b.angle_2": "10 deg/s"})
    assert state["b"].coordinates["angle_2"] == pytest.approx(np.pi / 6) and state["b"].coordinates["angle_2_rate"] == pytest.approx(np.pi / 18)
    with pytest.raises(lv.InputError, match="three angles of a ball joint"):
        m.at({"b.angle_2": "90 deg"})
