# SPDX-License-Identifier: BSD-3-Clause
"""True motions of the reported cases: closed forms, quadratures, laws.py, truth.py, DOP853; by none livens is asked.

Each is a function (content of the scenario, end) -> motion with at(times), as scans.errors asks of it, and
`error`, what it is off itself, m or rad; or a function (run) -> motion, where the start is the run's to choose.
"""
import math

import numpy as np
from scipy.integrate import solve_ivp

import laws
import paper
import truth

REAL = laws.REAL


class Motion:
    """Of one body: centre(times) (time, 3) and triad(times) (time, xyz, director)."""

    def __init__(self, centre, triad, end, error):
        self.centre, self.triad, self.ends, self.error = centre, triad, [0, end], error

    def at(self, times):
        times = np.minimum(times, self.ends[-1])
        return (np.asarray(self.centre(times), float)[:, None], np.asarray(self.triad(times), float)[:, None])


def upright(times):
    return np.broadcast_to(np.eye(3), (len(times), 3, 3))


def turned(axis, angle):
    """Rotations about an axis of the world."""
    k = np.array([[0, -axis[2], axis[1]], [axis[2], 0, -axis[0]], [-axis[1], axis[0], 0]])
    angle = np.asarray(angle, REAL)[:, None, None]
    return np.eye(3) + np.sin(angle) * k + (1 - np.cos(angle)) * (k @ k)


def sliding(law, x, v, end, begins):
    """A body on a slide along the x axis, whose coordinate is x where the body stands at `begins`."""
    motion = laws.march(law, x, v, end)

    def centre(times):
        return np.outer(motion.coordinate(times) - REAL(x), [1, 0, 0]) + np.array([begins, 0, 0])
    return Motion(centre, upright, end, motion.error)


def turning(law, x, v, end, axis, arm):
    """A body on a hinge at the origin; arm: its centre where the angle is zero."""
    motion = laws.march(law, x, v, end)
    return Motion(lambda times: turned(axis, motion.coordinate(times)) @ np.array(arm),
                  lambda times: turned(axis, motion.coordinate(times)), end, motion.error)


def formula(content):
    return content["load"][0]["expression"]


# ---------------------------------------------------------------- one coordinate

def drag_at_reversal(content, end):
    return sliding(laws.Law(1).add("-12.9*x - 2.93*v*abs(v)"), 0.22, -1.27, end, 0)


def smooth_friction(content, end):
    return sliding(laws.Law(1, sharp=[("v", 0, 1 / 251)]).add(formula(content)), 0.46, -1.25, end, 0)


def steep_law(content, end):
    return sliding(laws.Law(1, sharp=[("x", 0, 1 / 3676)]).add(formula(content)), -0.2, -1.07, end, 0)


def spline_spring(content, end):
    rows = content["load"][0]["table"]
    return sliding(laws.Law(1).add_table(laws.Table(rows["elongations"], rows["forces"], True)), 0.0, 6.0, end, 0)


def spring_through_anchor(content, end):
    return sliding(laws.Law(1).add("-4*(abs(x) - 0.5)*(x/abs(x))"), 1.0, -4.0, end, 1)


def narrow_pulse(content, end):
    law = laws.Law(1, sharp=[("x", 2, 0.01)]).add(formula(content).replace("q", "x"))
    return turning(law, 0, 5.0, end, (0, 0, 1), (0, 0, 0))


def friction_from_rest(content, end):
    law = laws.Law(1, sharp=[("v", 0, 1 / 3000)]).add("20 - 5*tanh(3000*v)")
    return turning(law, 0, 0, end, (0, 0, 1), (0, 0, 0))


def joint_friction(content, end):
    law = laws.Law(REAL(0.02) + REAL(0.25), sharp=[("v", 0, 1 / 1000)]).add("0.5*9.81*cos(x) - 0.6*tanh(1000*v)")
    return turning(law, 0, 0, end, (0, 1, 0), (0.5, 0, 0))


def rod(text, start, end):
    """Of 2 kg and 1 m on a hinge at its upper end."""
    square = REAL(0.05) ** 2
    law = laws.Law(2 * ((1 + square) / 12 + REAL(0.25))).add("-9.81*sin(x)").add(text)
    return turning(law, start, 0, end, (0, 1, 0), (0, 0, -0.5))


def grazed_stop(content, end):
    return rod("-1e5*max(0, x - 0.4)", -0.40001, end)


def jumping_torque(content, end):
    return rod("-6*(x/abs(x))", -1.1, end)


def slot_end(content, end):
    points = content["joint"][0]["curve"]["points"]
    wire, velocity = laws.Wire(points), laws.real(content["body"][0]["velocity"])
    speed = np.sqrt((velocity * velocity).sum())
    return Motion(lambda times: wire.places(wire.by_length(wire.knots[1], speed, times)), upright, end, 1e-15)


# ---------------------------------------------------------------- in space

def attraction_skew(content, end):
    """A straight fall without a turn, of the triad that the run has chosen for skew directors: see from_run()."""
    start, there = np.array([0.3, 0.1, -0.2]), np.array([2.0, 1.0, 0.0])
    body = content["body"][0]
    assert np.allclose(np.array(body["position"]) + np.array(body["first_moment"]) / body["mass"] @
                       np.array(body["directors"]), start, atol=1e-9)
    far = np.linalg.norm(there - start)
    found = marched(lambda t, y: [y[1], -content["load"][0]["mu"] / y[0] ** 2], [far, 0.0], end)

    def from_run(run):
        triad = run["X"][0, 0, 1:].T
        assert np.abs(triad.T @ triad - np.eye(3)).max() < 1e-14
        return Motion(lambda times: there + np.outer(found(times)[0] / far, start - there),
                      lambda times: np.broadcast_to(triad, (len(times), 3, 3)), end, 1e-13)
    return from_run


def marched(rate, start, end, absolute=1e-16):
    return solve_ivp(rate, (0, end), start, "DOP853", rtol=3e-14, atol=absolute, dense_output=True,
                     max_step=end / 2000).sol


def drive_atan2(content, end):
    def angle(times):
        y = REAL(0.1) * np.sin(10 * np.asarray(times, REAL))
        return np.arctan2(y, np.sqrt(1 - y * y))
    return Motion(lambda times: np.zeros((len(times), 3)), lambda times: turned((0, 0, 1), angle(times)), end, 1e-16)


def start_at_rest(content, end):
    inertia = 0.4 * 0.1**2
    return Motion(lambda times: np.zeros((len(times), 3)),
                  lambda times: turned((1, 0, 0), 0.1 / inertia * np.asarray(times, REAL) ** 2 / 2), end, 1e-15)


def drive_at_90_projected(content, end):
    def triad(times): return turned((0, 0, 1), np.asarray(times, REAL) - 2 * np.arctan(REAL(1)))
    return Motion(lambda times: triad(times) @ np.array([0.5, 0, 0]), triad, end, 1e-16)


def flip(content, end):
    motion = truth.march(truth.Mechanism({key: content[key] for key in ("format", "gravity", "body")}), end)
    motion.error = 5.5e4 * 1e-16   # of numbers of 64 bits; growth as reported
    return motion


def gravity_gradient(content, end):
    """In the plane: place and turn under MacCullagh's potential."""
    mu, mass, (a, b, c) = content["load"][0]["mu"], 500.0, (100.0, 1250.0, 1300.0)

    def rate(_, y):
        px, py, turn, vx, vy, spin = y
        r2 = px * px + py * py
        r = math.sqrt(r2)
        nx, ny = px / r, py / r
        s, k = math.sin(turn), math.cos(turn)
        u, w = nx * k + ny * s, -nx * s + ny * k     # towards the body, in its axes
        along = a * u * u + b * w * w
        # gradient of -mu (m/r + (a + b + c - 3 along)/2r^3) over places: radial, and across through u and w
        radial = mu * (mass / r2 + 1.5 * (a + b + c - 3 * along) / r2**2)
        across = mu * 3 * (b - a) * u * w / r2**2    # of the force, along the turned radius
        torque = 3 * mu * (b - a) * u * w / r**3
        fx, fy = -radial * nx - -across * ny, -radial * ny + -across * nx
        return [vx, vy, spin, fx / mass, fy / mass, torque / c]
    body = content["body"][0]
    start = [*body["position"][:2], math.radians(20), *body["velocity"][:2], body["angular_velocity"][2]]
    found = marched(rate, start, end)
    return Motion(lambda times: np.stack([*found(times)[:2], 0 * np.asarray(times)], -1),
                  lambda times: turned((0, 0, 1), found(times)[2]), end, 1e-12)


def bushing_damper(content, end):
    """A ball: torque minus c times what of the rate of the rotation vector turns it."""
    def rate(_, y):
        r, w = y[:3], y[3:]
        angle = math.sqrt(r @ r)
        share = 1 / 12 if angle < 1e-4 else 1 / angle**2 - (1 + math.cos(angle)) / (2 * angle * math.sin(angle))
        k = np.array([[0, -r[2], r[1]], [r[2], 0, -r[0]], [-r[1], r[0], 0]])
        by_spin = np.eye(3) - k / 2 + share * k @ k   # r' of the spin in the world
        return np.concatenate([by_spin @ w, (content["load"][1]["value"] - 0.02 * by_spin.T @ (by_spin @ w)) / 0.01])
    found = marched(rate, [0.0, 0, 0, 2, 0, 0], end)

    def triad(times):
        r = found(times)[:3].T
        angle = np.linalg.norm(r, axis=1)
        axis = r / np.where(angle, angle, 1)[:, None]
        return np.stack([turned(one, [by])[0] for one, by in zip(axis, angle)])
    return Motion(lambda times: np.zeros((len(times), 3)), triad, end, 1e-12)


def assembly_at_origin(content, end):
    """From where the run itself has closed the loop: see from_run()."""
    links, joints = content["body"], content["joint"]

    def from_run(run):
        begin = run["X"][0]
        assert np.abs(run["X_node"][0]) == 0
        bodies = [link | {"position": x[0], "directors": x[1:]} for link, x in zip(links, begin)]
        for body in bodies:
            body.pop("rotation_vector")
            body["directors"] = truth.rotation(truth.quaternion(laws.real(body["directors"]).T)).T
        place = {"world": (np.zeros(3), np.eye(3))} | {body["name"]: (x[0], x[1:]) for body, x in zip(links, begin)}
        pins = []
        for joint in joints:
            at = [place[name][0] + np.array(point) @ place[name][1]
                  for name, point in zip(joint["between"], joint["points"])]
            assert np.abs(at[0] - at[1]).max() < 1e-12, f"{joint['name']} is open"
            pins.append({"name": joint["name"], "type": "revolute", "between": joint["between"], "at": at[0], "axis": [0, 1, 0]})
        mechanism = {"format": 1, "gravity": content["gravity"], "body": bodies, "joint": pins}
        motion = truth.march(truth.Mechanism(mechanism), end)
        motion.error = 1e-12
        return motion
    return from_run


TRUTHS = {f.__name__: f for f in (
    attraction_skew, drive_atan2, drag_at_reversal, slot_end, smooth_friction, spline_spring, start_at_rest,
    steep_law, grazed_stop, jumping_torque, narrow_pulse, friction_from_rest, joint_friction, flip,
    gravity_gradient, spring_through_anchor, drive_at_90_projected, assembly_at_origin, bushing_damper)}
TRUTHS["drive_at_90_stated"] = drive_at_90_projected

# What has to be refused, or called suspect: exit code, and words that what is said has to hold.
REFUSED = {"turning_springs": (4, ["load 's", "radau"]), "drive_at_90": (3, ["'motor'", "rad"]),
           "ball_joint_spring": (3, ["joint 'ball' (spherical) has no coordinate"]),
           "bushing_as_damper": (7, ["bushing 'damper'", "half a turn"]),
           # rounding decides whether tries run out (4) or one is within the accuracy, and suspect for the half turn (7)
           "bushing_half_turn": ((4, 7), ["bushing 'bush'", "half a turn"])}
