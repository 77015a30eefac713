# SPDX-License-Identifier: BSD-3-Clause
"""True motions of scenarios, by a formulation that shares nothing with livens.

Newton's and Euler's equations of the bodies (centre of mass, quaternion, velocity, spin in body axes), joints
as second derivatives of their conditions, in numbers of 64 bits of mantissa. Time is cut into pieces, on each
of which the motion is a Chebyshev polynomial, found by Picard's iteration y <- y0 + int f(y) at all its nodes
at once, so that any instant can be had from it without loss. A piece is halved until the iteration comes to
rest and the last coefficients are rounding.

    motion = truth.of(scenario)            # text of a scenario, docs/scenario.md
    centres, triads = motion.at(times)     # (time, body, xyz) m; (time, body, xyz, director)

What it reads of scenarios: boxes, cylinders and points, or mass and inertia; revolute, universal, spherical,
cylindrical, prismatic joints and rods, also until an instant; angles that turn at a rate and bodies that are
led by expressions; forces by value or spline, torques, springs between points, actuators by expressions of
angles; velocities that are projected at the start; nothing else, which it says.

Where links lie on one line, joints by accelerations say nothing: Parallelograms is one angle of such a set.
"""
import ast
import hashlib
import pathlib
import tomllib

import numpy as np

REAL = np.longdouble
N = 40                      # degree of a piece
MOST_ITERATIONS = 60
REST = REAL(4e-19)          # of the largest number: where the iteration has come to rest
TAIL = REAL(2e-17)          # of the largest number: the last coefficients of a piece


def real(x):
    return np.array(x, dtype=REAL)


def radians(angle):
    """Of a number, or of "90 deg" as the program reads it: in double precision."""
    return float(angle.removesuffix(" deg")) * (np.pi / 180) if isinstance(angle, str) else angle


# ---------------------------------------------------------------- polynomials on Chebyshev points of [0, 1]

def tables_of_pieces(n):
    """Points, weights of the barycentric formula; from values: coefficients, and integrals from 0."""
    k = np.arange(n + 1)
    angles = k * (4 * np.arctan(REAL(1))) / n
    weights = (-REAL(1)) ** k
    weights[[0, -1]] /= 2
    share = np.where((k == 0) | (k == n), REAL(0.5), REAL(1))
    coefficients = 2 / REAL(n) * share[:, None] * np.cos(np.outer(k, angles)) * share   # of T_k(-x)
    # int T_k(cos a) sin a da, term by term; T_k as a polynomial in cos a at x = cos(angles) from 1 to -1
    def antiderivative(j, a):
        c = np.cos(a)
        if j == 0:
            return c
        if j == 1:
            return c * c / 2
        return np.cos((j + 1) * a) / (2 * (j + 1)) - np.cos((j - 1) * a) / (2 * (j - 1))
    integrals = np.stack([antiderivative(j, angles[:1]) - antiderivative(j, angles) for j in range(n + 1)],
                         axis=1)
    return (1 - np.cos(angles)) / 2, weights, coefficients, integrals @ coefficients / 2


POINTS, WEIGHTS, COEFFICIENTS, INTEGRALS = tables_of_pieces(N)


def interpolate(values, s):
    """Polynomials through values (node, ...) at s of [0, 1]."""
    apart = s[:, None] - POINTS
    hit = apart == 0
    share = np.where(hit.any(axis=1)[:, None], hit, WEIGHTS / np.where(hit, 1, apart))
    return np.tensordot(share, values, 1) / share.sum(axis=1).reshape(-1, *[1] * (values.ndim - 1))


# ---------------------------------------------------------------- rotations

def rotation(q):
    """Matrices whose columns are the directors, of quaternions (w, x, y, z)."""
    w, x, y, z = np.moveaxis(q, -1, 0)
    return np.stack([np.stack([1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)], -1),
                     np.stack([2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)], -1),
                     np.stack([2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)], -1)], -2)


def quaternion(R):
    """Of a rotation matrix; by the largest of its four parts."""
    squares = real([1 + R[0, 0] + R[1, 1] + R[2, 2], 1 + R[0, 0] - R[1, 1] - R[2, 2],
                    1 - R[0, 0] + R[1, 1] - R[2, 2], 1 - R[0, 0] - R[1, 1] + R[2, 2]])
    pairs = [[R[2, 1] - R[1, 2], R[0, 2] - R[2, 0], R[1, 0] - R[0, 1]],
             [R[2, 1] - R[1, 2], R[0, 1] + R[1, 0], R[0, 2] + R[2, 0]],
             [R[0, 2] - R[2, 0], R[0, 1] + R[1, 0], R[1, 2] + R[2, 1]],
             [R[1, 0] - R[0, 1], R[0, 2] + R[2, 0], R[1, 2] + R[2, 1]]]
    most = int(np.argmax(squares))
    q = np.insert(real(pairs[most]), most, squares[most])
    return q / np.sqrt((q * q).sum())


def cross(a, b):
    """Vector product along the last axis; numpy.cross is slow, and so are its functions that move axes and stack."""
    a0, a1, a2, b0, b1, b2 = a[..., 0], a[..., 1], a[..., 2], b[..., 0], b[..., 1], b[..., 2]
    first = a1 * b2 - a2 * b1
    found = np.empty((*first.shape, 3), dtype=first.dtype)
    found[..., 0] = first
    found[..., 1] = a2 * b0 - a0 * b2
    found[..., 2] = a0 * b1 - a1 * b0
    return found


def times(R, a):
    return (R * a[..., None, :]).sum(-1)


def back(R, a):
    return (R * a[..., :, None]).sum(-2)


def dot(a, b):
    return (a * b).sum(-1)


# ---------------------------------------------------------------- laws

def expression(text):
    """A function of jets by name, (value, rate, second rate); of numbers, + - * / and sin."""
    def of(node, names):
        match node:
            case ast.Constant(value=number):
                return REAL(number), 0, 0
            case ast.Name(id="pi"):
                return 4 * np.arctan(REAL(1)), 0, 0
            case ast.Name(id=name):
                return names[name]
            case ast.UnaryOp(op=ast.USub(), operand=operand):
                return tuple(-x for x in of(operand, names))
            case ast.BinOp(left=left, op=ast.Add() | ast.Sub() as op, right=right):
                sign = 1 if isinstance(op, ast.Add) else -1
                return tuple(x + sign * y for x, y in zip(of(left, names), of(right, names)))
            case ast.BinOp(left=left, op=ast.Mult() | ast.Div() as op, right=right):
                (x, dx, ddx), (y, dy, ddy) = of(left, names), of(right, names)
                if isinstance(op, ast.Div):
                    y, dy, ddy = 1 / y, -dy / y**2, 2 * dy * dy / y**3 - ddy / y**2
                return x * y, dx * y + x * dy, ddx * y + 2 * dx * dy + x * ddy
            case ast.Call(func=ast.Name(id="sin"), args=[argument]):
                x, dx, ddx = of(argument, names)
                return np.sin(x), np.cos(x) * dx, np.cos(x) * ddx - np.sin(x) * dx * dx
        raise AssertionError(f"not read here: {ast.unparse(node)}")
    tree = ast.parse(text, mode="eval").body
    return lambda names: of(tree, names)


class Spline:
    """Cubic between rows, constant outside; two continuous derivatives, three next to the ends."""

    def __init__(self, times, values):
        self.times, self.values = real(times), real(values)
        h, n = np.diff(self.times), len(times)
        assert n >= 4, "not read here: short splines"
        A, b = np.zeros((n, n), REAL), np.zeros(self.values.shape, REAL)
        slopes = np.diff(self.values, axis=0) / h[:, None]
        for i in range(1, n - 1):
            A[i, i - 1:i + 2] = h[i - 1], 2 * (h[i - 1] + h[i]), h[i]
            b[i] = 6 * (slopes[i] - slopes[i - 1])
        A[0, :3] = h[1], -h[0] - h[1], h[0]
        A[-1, -3:] = h[-1], -h[-1] - h[-2], h[-2]
        self.bends = solve(A[None], b[None])[0]

    def at(self, t):
        """At instants of which none is on the other side of a row."""
        middle = (t[0] + t[-1]) / 2
        if not self.times[0] <= middle <= self.times[-1]:
            end = self.values[0 if middle < self.times[0] else -1]
            return np.broadcast_to(end, (len(t), *end.shape))
        i = int(np.searchsorted(self.times, middle)) - 1 if middle > self.times[0] else 0
        h = self.times[i + 1] - self.times[i]
        s = ((t - self.times[i]) / h)[:, None]
        return (1 - s) * self.values[i] + s * self.values[i + 1] - h * h / 6 * s * (1 - s) * (
            (2 - s) * self.bends[i] + (1 + s) * self.bends[i + 1])


# ---------------------------------------------------------------- the mechanism

class Body:
    """Mass, inertia about the centre of mass in body axes, and the start."""

    def __init__(self, entry):
        known = {"name", "shape", "density", "mass", "center_of_mass", "inertia", "position", "directors",
                 "rotation_vector", "velocity", "angular_velocity", "angular_velocity_body",
                 "visual", "color", "opacity"}   # looks, which nothing follows from
        assert set(entry) <= known, f"not read here: {set(entry) - known}"
        shape = entry.get("shape", {})
        assert set(shape) <= {"box", "point", "cylinder"}, f"not read here: {shape}"
        self.is_point = "point" in shape
        edges = real(shape.get("box", [0, 0, 0]))
        self.mass = real(entry["mass"]) if "mass" in entry else real(entry["density"]) * edges.prod()
        square = edges * edges
        if "cylinder" in shape:
            assert set(shape["cylinder"]) == {"radius", "length"} and "mass" in entry, "not read here: tubes"
            radius, length = real(shape["cylinder"]["radius"]), real(shape["cylinder"]["length"])
            square = real([3 * radius**2, 3 * radius**2, length**2])   # of the box that turns alike
        self.inertia = np.diag(self.mass * (square.sum() - square) / 12)
        if "inertia" in entry:
            given = real(entry["inertia"])
            self.inertia = np.diag(given) if given.ndim == 1 else given
        if self.is_point:
            self.inertia = np.eye(3, dtype=REAL)   # of a body that nothing turns
        self.inverse = solve(self.inertia[None], np.eye(3, dtype=REAL)[None])[0]
        self.centre = real(entry.get("center_of_mass", [0, 0, 0]))
        if "rotation_vector" in entry:
            vector = real([radians(angle) for angle in entry["rotation_vector"]])
            angle = np.sqrt(dot(vector, vector))
            self.q = np.concatenate([[np.cos(angle / 2)], vector / angle * np.sin(angle / 2)])
        else:
            R = real(entry.get("directors", np.eye(3))).T
            assert np.abs(R.T @ R - np.eye(3)).max() < 1e-14, "directors are no rotation"
            self.q = quaternion(R)
        R = rotation(self.q)
        self.place = real(entry.get("position", [0, 0, 0]))
        spin = real(entry["angular_velocity_body"]) if "angular_velocity_body" in entry else \
            back(R, real(entry.get("angular_velocity", [0, 0, 0])))
        self.start = np.concatenate([self.place + times(R, self.centre), self.q,
                                     real(entry.get("velocity", [0, 0, 0])) +
                                     times(R, cross(spin, self.centre)), spin])

    def seen_from(self, point):
        """A point of the world at the start, from the centre of mass in body axes."""
        return back(rotation(self.q), real(point) - self.start[:3])


def solve(A, b):
    """Solutions of many small systems, (k, n, n) and (k, n, m); without exchange, A is positive definite."""
    A, b = A.copy(), b.copy()
    n = A.shape[1]
    for i in range(n):
        share = A[:, i + 1:, i] / A[:, i, i, None]
        A[:, i + 1:, i:] -= share[..., None] * A[:, i, None, i:]
        b[:, i + 1:] -= share[..., None] * b[:, i, None]
    for i in reversed(range(n)):
        b[:, i] = (b[:, i] - (A[:, i, i + 1:, None] * b[:, i + 1:]).sum(1)) / A[:, i, i, None]
    return b


class Mechanism:
    """f of y' = f(t, y), y = (centre 3, quaternion 4, velocity 3, spin 3) of each body."""

    def __init__(self, scenario):
        known = {"format", "title", "gravity", "body", "world", "joint", "drive", "load", "sensor", "start"}
        assert set(scenario) <= known, f"not read here: {set(scenario) - known}"
        assert scenario.get("start", {}) in ({}, {"initial": "project"}), "not read here: [start]"
        self.gravity = real(scenario.get("gravity", [0, 0, 0]))
        self.bodies = [Body(entry) for entry in scenario["body"]]
        self.index = {"world": -1} | {entry["name"]: i for i, entry in enumerate(scenario["body"])}
        self.rows = []     # (kind, what it ties, until)
        self.angles = {}   # of hinges by name: what they are at the start, and directions that tell them
        for entry in scenario.get("joint", []):
            self.rows += [(*row, entry.get("until", np.inf)) for row in self.joint(entry)]
        self.rows += [(*self.drive(entry), np.inf) for entry in scenario.get("drive", [])]
        self.loads = [self.load(entry) for entry in scenario.get("load", [])]
        self.breaks = sorted({t for load in self.loads for t in (load.get("from"), load.get("until"))
                              if t is not None} |
                             {t for load in self.loads if "table" in load for t in load["table"].times} |
                             {until for *_, until in self.rows if until < np.inf})
        self.mass = real([body.mass for body in self.bodies])
        self.inertia = np.stack([body.inertia for body in self.bodies])
        self.inverse = np.stack([body.inverse for body in self.bodies])
        self.start = np.stack([body.start for body in self.bodies])
        self.independent = {}   # rows by what acts
        if "start" in scenario:
            self.start = self.projected(self.start)

    # a point or a direction of a body: (index, vector from the centre of mass in body axes)

    def points(self, entry, key="points"):
        given = entry.get(key, [[0, 0, 0]] * 2)
        return [(self.index[name],
                 real(point) - (self.bodies[self.index[name]].centre if name != "world" else 0))
                for name, point in zip(entry["between"], given)]

    def direction(self, name, axis):
        axis = real(axis)
        body = self.index[name]
        axis = axis / np.sqrt(dot(axis, axis))
        return body, axis if body < 0 else back(rotation(self.bodies[body].q), axis)

    def joint(self, entry):
        """Rows (kind, what they tie); directions of pairs stay perpendicular."""
        known = {"name", "type", "between", "at", "axis", "axes", "points", "length", "coordinate", "until"}
        assert set(entry) <= known, f"not read here: {set(entry) - known}"
        assert "points" not in entry or entry["type"] == "rod", "joints are placed by at"
        if entry["type"] == "rod":
            p, q = (self.bodies[b].start[:3] + times(rotation(self.bodies[b].q), r) if b >= 0 else r
                    for b, r in self.points(entry))
            length = np.sqrt(dot(p - q, p - q))
            assert abs(entry.get("length", length) - length) < 1e-12, "not read here: a rod that does not fit"
            return [("rod", self.points(entry))]
        first, second = entry["between"]
        at = [(self.index[name], real(entry["at"]) if name == "world" else
               self.bodies[self.index[name]].seen_from(entry["at"])) for name in (first, second)]
        if entry["type"] == "spherical":
            return [("point", at)]
        if entry["type"] == "universal":
            axes = entry["axes"]
            pair = self.direction(first, axes[0]), self.direction(second, axes[1])
            return [("point", at), ("pair", pair)]
        assert entry["type"] in ("revolute", "cylindrical", "prismatic"), f"not read here: {entry['type']}"
        axis = real(entry["axis"])
        across = cross(axis, np.eye(3, dtype=REAL)[np.argmin(np.abs(axis))])
        both = across, cross(axis, across)
        pairs = [("pair", (self.direction(first, axis), self.direction(second, other))) for other in both]
        if entry["type"] == "revolute":
            tell = (first, axis), (first, both[0]), (first, both[1]), (second, both[0])
            begin = REAL(entry.get("coordinate", 0))
            self.angles[entry.get("name")] = begin, [self.direction(*of) for of in tell]
            return [("point", at), *pairs]
        if entry["type"] == "prismatic":
            pairs.append(("pair", (self.direction(first, both[0]), self.direction(second, both[1]))))
        return pairs + [("across", (self.direction(first, other), *at)) for other in both]

    def drive(self, entry):
        """(kind, what follows and its law: a function of t that gives jets)."""
        if entry["type"] == "joint":
            assert set(entry) <= {"name", "type", "joint", "rate"}, f"not read here: {entry}"
            rate = REAL(entry["rate"])
            return "angle", (self.angles[entry["joint"]], lambda t: (rate * t, rate, 0))
        assert set(entry) <= {"name", "type", "body", "expression"} and entry["type"] == "body", \
            f"not read here: {entry}"
        laws = [expression(text) for text in entry["expression"]]

        def path(t):
            jets = [law({"t": (t, 1, 0)}) for law in laws]
            return [np.stack([np.zeros_like(t) + jet[k] for jet in jets], -1) for k in range(3)]
        assert not path(real([0]))[0].any(), "the path does not begin where the body stands"
        body = self.index[entry["body"]]
        return "led", ((body, -self.bodies[body].centre), path)

    def load(self, entry):
        known = {"name", "type", "body", "value", "point", "from", "until", "between", "points", "stiffness",
                 "damping", "free_length", "frame", "table", "joint", "inputs", "expression"}
        assert set(entry) <= known, f"not read here: {set(entry) - known}"
        load = dict(entry)
        if entry["type"] == "spring":
            load["ends"] = self.points(entry)
        elif entry["type"] == "actuator":
            load["law"] = expression(entry["expression"])
            load["angle"] = self.angles[entry["joint"]]
            load["inputs"] = {symbol: what.rpartition(".") for symbol, what in entry["inputs"].items()}
            assert {what for *_, what in load["inputs"].values()} <= {"angle", "angle_rate"}, "other inputs"
        else:
            assert entry["type"] in ("force", "torque") and "expression" not in entry, "not read here: a load"
            load["index"] = self.index[entry["body"]]
            load["arm"] = real(entry.get("point", [0, 0, 0])) - self.bodies[load["index"]].centre
            if "table" in entry:
                assert entry["table"].get("interpolation") == "spline", "not read here: straight lines"
                load["table"] = Spline(entry["table"]["times"], entry["table"]["values"])
            else:
                load["value"] = real(entry["value"])
        return load

    def of_point(self, at, y, R, is_direction=False):
        """Value, rate, acceleration by spin alone of a point or direction, and its body's triad."""
        body, r = at
        if body < 0:
            zero = np.zeros((len(y), 3), REAL)
            return zero + r, zero, zero, None
        Rb, w = R[:, body], y[:, body, 10:]
        turned = cross(w, np.broadcast_to(r, w.shape))
        value, rate = times(Rb, np.broadcast_to(r, w.shape)), times(Rb, turned)
        if not is_direction:
            value, rate = value + y[:, body, :3], rate + y[:, body, 7:10]
        return value, rate, times(Rb, cross(w, turned)), Rb

    def spin(self, body, y, R):
        return times(R[:, body], y[:, body, 10:]) if body >= 0 else np.zeros((len(y), 3), REAL)

    def angle(self, of, y, R):
        """Angle of a hinge, its rate and its axis. Turns are not counted: beyond 3 rad it is no number."""
        begin, (axis, u, v, other) = of
        a, u1, v1, u2 = (self.of_point(d, y, R, True)[0] for d in (axis, u, v, other))
        turned = np.arctan2(dot(v1, u2) * np.sqrt(dot(u1, u1)[0] / dot(v1, v1)[0]), dot(u1, u2))
        turned[np.abs(turned) > 3] = np.nan
        return begin + turned, dot(a, self.spin(other[0], y, R) - self.spin(axis[0], y, R)), a

    def conditions(self, t, y):
        """G (k, row, body, 6) of what acts at t, c with G (a, alpha) = c, and r with G (v, w) = r."""
        R = rotation(y[..., 3:7])
        G, c, r = [], [], []
        zero = np.zeros((len(y), len(self.bodies), 6), REAL)

        def row(sides, right, rate=0):
            g = zero.copy()
            for (body, arm), n, is_direction in sides:
                if body < 0:
                    continue
                if not is_direction:
                    g[:, body, :3] += n
                # n . R (alpha x arm)
                g[:, body, 3:] += cross(np.broadcast_to(arm, n.shape), back(R[:, body], n))
            G.append(g)
            c.append(right)
            r.append(np.zeros(len(y), REAL) + rate)

        def turning(sides, right, rate=0):
            row([], right, rate)
            for body, n in sides:
                if body >= 0:
                    G[-1][:, body, 3:] += back(R[:, body], n)

        middle = (t[0] + t[-1]) / 2
        acting = tuple(middle < until for *_, until in self.rows)
        axes = [np.broadcast_to(e, (len(y), 3)) for e in np.eye(3, dtype=REAL)]
        for (kind, what, _), acts in zip(self.rows, acting):
            if not acts:
                continue
            if kind in ("rod", "point"):
                p, q = what
                (x, v, a, _), (xq, vq, aq, _) = self.of_point(p, y, R), self.of_point(q, y, R)
                if kind == "rod":
                    d, rate = x - xq, v - vq
                    row([(p, d, False), (q, -d, False)], -dot(rate, rate) - dot(d, a - aq))
                    continue
                for n in axes:
                    row([(p, n, False), (q, -n, False)], -dot(n, a - aq))
            elif kind == "pair":
                e, n = what
                (x, v, a, _), (xn, vn, an, _) = self.of_point(e, y, R, True), self.of_point(n, y, R, True)
                row([(e, xn, True), (n, x, True)], -dot(a, xn) - dot(x, an) - 2 * dot(v, vn))
            elif kind == "across":
                u, p, q = what
                (x, v, a, _), (xq, vq, aq, _) = self.of_point(p, y, R), self.of_point(q, y, R)
                n, rate, bend, _ = self.of_point(u, y, R, True)
                row([(q, n, False), (p, -n, False), (u, xq - x, True)],
                    -dot(n, aq - a) - 2 * dot(rate, vq - v) - dot(bend, xq - x))
            elif kind == "angle":
                (_, (axis, _, _, other)), law = what
                n, rate, _, _ = self.of_point(axis, y, R, True)
                _, speed, faster = law(t)
                turning([(other[0], n), (axis[0], -n)], faster - dot(rate, self.spin(other[0], y, R)), speed)
            else:
                point, path = what
                _, rate, bend = path(t)
                a = self.of_point(point, y, R)[2]
                for n in axes:
                    row([(point, n, False)], dot(n, bend - a), dot(n, rate))
                    turning([(point[0], n)], np.zeros(len(y), REAL))
        if not G:
            return np.zeros((len(y), 0, len(self.bodies), 6), REAL), *2 * [np.zeros((len(y), 0), REAL)]
        G, c, r = np.stack(G, 1), np.stack(c, 1), np.stack(r, 1)
        if acting not in self.independent:
            self.independent[acting] = independent(G[0].reshape(-1, 6 * len(self.bodies)))
        kept = self.independent[acting]
        return G[:, kept], c[:, kept], r[:, kept]

    def changed(self, G, free, right):
        """`free` (k, body, 6) plus the least in the metric of the masses with which G gives `right`."""
        by_mass = np.concatenate([G[..., :3] / self.mass[:, None],
                                  times(self.inverse, G[..., 3:])], -1).reshape(len(G), G.shape[1], -1)
        flat = G.reshape(by_mass.shape)
        A = np.einsum("kri,ksi->krs", flat, by_mass)
        scale = np.sqrt(np.einsum("krr->kr", A))
        right = (right - np.einsum("kri,ki->kr", flat, free.reshape(len(G), -1))) / scale
        reactions = solve(A / scale[:, :, None] / scale[:, None], right[..., None])[..., 0] / scale
        return free + np.einsum("kri,kr->ki", by_mass, reactions).reshape(free.shape)

    def projected(self, start):
        """A start whose joints are closed, with the nearest velocities that follow joints and drives."""
        G, _, r = self.conditions(real([0]), start[None])
        return np.concatenate([start[:, :7], self.changed(G, start[None, :, 7:], r)[0]], -1)

    def accelerations(self, t, y):
        """(k, body, 6): of centres, and spin rates in body axes; t: instants between the same breaks."""
        R, w = rotation(y[..., 3:7]), y[..., 10:]
        force = np.zeros(w.shape, REAL) + self.mass[:, None] * self.gravity
        torque = -cross(w, times(self.inertia, w))
        middle = (t[0] + t[-1]) / 2

        def push(body, arm, F):
            if body >= 0:
                force[:, body] += F
                torque[:, body] += cross(np.broadcast_to(arm, F.shape), back(R[:, body], F))

        for load in self.loads:
            if not load.get("from", -np.inf) <= middle <= load.get("until", np.inf):
                continue
            if load["type"] == "spring":
                (x, v, _, _), (xq, vq, _, _) = (self.of_point(end, y, R) for end in load["ends"])
                d = xq - x
                length = np.sqrt(dot(d, d))
                pull = load["stiffness"] * (length - REAL(load["free_length"])) + \
                    REAL(load.get("damping", 0)) * dot(d, vq - v) / length
                F = (pull / length)[:, None] * d
                push(*load["ends"][0], F)
                push(*load["ends"][1], -F)
                continue
            if load["type"] == "actuator":
                names = {"t": (t, 1, 0)}
                for symbol, (joint, _, what) in load["inputs"].items():
                    names[symbol] = self.angle(self.angles[joint], y, R)[what == "angle_rate"], 0, 0
                T = load["law"](names)[0][:, None] * self.angle(load["angle"], y, R)[2]
                (first, _), _, _, (second, _) = load["angle"][1]
                for body, turn in ((first, -T), (second, T)):
                    if body >= 0:
                        torque[:, body] += back(R[:, body], turn)
                continue
            b = load["index"]
            value = load["table"].at(t) if "table" in load else np.broadcast_to(load["value"], w[:, b].shape)
            value = times(R[:, b], value) if load.get("frame") == "body" else value
            if load["type"] == "force":
                push(b, load["arm"], value)
            else:
                torque[:, b] += back(R[:, b], value)
        free = np.concatenate([force / self.mass[:, None], times(self.inverse, torque)], -1)
        G, c, _ = self.conditions(t, y)
        return self.changed(G, free, c) if G.shape[1] else free

    def rate(self, t, y):
        q, w = y[..., 3:7], y[..., 10:]
        spin = np.concatenate([-dot(q[..., 1:], w)[..., None], q[..., :1] * w + cross(q[..., 1:], w)], -1) / 2
        a = self.accelerations(t, y)
        return np.concatenate([y[..., 7:10], spin, a], -1)

    @staticmethod
    def shown(y):
        """Centres and quaternions of the bodies."""
        return y[..., :3], y[..., 3:7]


class Parallelograms:
    """y = (angle, rate) of links that turn alike about fixed axes, and of bars between them that do not turn.

    With S the sum of masses times arms, of links to their centres and of bars to the tips, and J that of their
    inertias: J angle'' = gravity . (axis x S). Where all links lie on one line, other branches begin: the motion
    stays on this one.
    """
    breaks = ()

    def __init__(self, scenario):
        whole = Mechanism(scenario)
        assert not whole.loads and {kind for kind, *_ in whole.rows} == {"point", "pair"}, "not read here"
        joints = [(*entry["between"], real(entry["at"]), real(entry["axis"])) for entry in scenario["joint"]]
        axis = joints[0][3]
        pivots = {whole.index[second]: at for first, second, at, _ in joints if first == "world"}
        tips = [at - pivots[whole.index[first]] for first, _, at, _ in joints if first != "world"]
        arm = tips[0]
        speed = dot(axis, times(rotation(whole.start[:, 3:7]), whole.start[:, 10:])[min(pivots)])
        for _, _, _, one in joints:
            assert (one == axis).all() and dot(axis, axis) == 1, "axes are not one"
        assert all((tip == arm).all() for tip in tips), "no parallelograms"
        self.axis, self.places, self.quaternions = axis, whole.start[:, :3], whole.start[:, 3:7]
        every = range(len(whole.bodies))
        self.arms = real([self.places[i] - pivots[i] if i in pivots else arm for i in every])
        self.turns = np.array([i in pivots for i in every])
        for i, body in enumerate(whole.bodies):
            spin = times(rotation(body.q), body.start[10:]) - self.turns[i] * speed * axis
            slip = body.start[7:10] - speed * cross(axis, self.arms[i])
            assert max(np.abs(spin).max(), np.abs(slip).max()) < 1e-15, "velocities do not fit"
        about = real([dot(axis, times(rotation(body.q), times(body.inertia, back(rotation(body.q), axis))))
                      for body in whole.bodies])
        self.inertia = (whole.mass * dot(self.arms, self.arms)).sum() + about[self.turns].sum()
        self.moment = (whole.mass[:, None] * self.arms).sum(0)
        self.gravity = whole.gravity
        self.start = real([0, speed])

    def turned(self, angle, arms):
        """Arms, which are across the axis, and across them."""
        c, s = np.cos(angle)[..., None, None], np.sin(angle)[..., None, None]
        across = cross(self.axis + 0 * arms, arms)
        return c * arms + s * across, c * across - s * arms

    def rate(self, _, y):
        across = self.turned(y[..., 0], self.moment[None])[1][..., 0, :]
        return np.stack([y[..., 1], dot(across, self.gravity) / self.inertia], -1)

    def shown(self, y):
        centres = self.places + self.turned(y[..., 0], self.arms)[0] - self.arms
        half = (y[..., 0] / 2)[..., None, None]
        w, v = np.cos(half), np.sin(half) * self.axis
        q0, qv = self.quaternions[..., :1], self.quaternions[..., 1:]
        v = np.broadcast_to(v, (*half.shape[:-2], *qv.shape))
        turned = np.concatenate([w * q0 - dot(v, qv)[..., None], w * qv + q0 * v + cross(v, qv + 0 * v)], -1)
        return centres, np.where(self.turns[:, None], turned, self.quaternions)


def independent(G):
    """Rows of G that span all, by elimination; of a closed loop in space some follow from others."""
    G = np.array(G, float)
    G /= np.maximum(np.linalg.norm(G, axis=1), 1e-300)[:, None]
    chosen = []
    left = G.copy()
    while len(chosen) < len(G):
        size = np.linalg.norm(left, axis=1)
        best = int(np.argmax(size))
        if size[best] < 1e-6:
            break
        chosen.append(best)
        direction = left[best] / size[best]
        left = left - np.outer(left @ direction, direction)
    return sorted(chosen)


# ---------------------------------------------------------------- its motion

class Motion:
    """Pieces of polynomials: ends (piece + 1), values (piece, node, ...), and what they show of the bodies."""

    def __init__(self, ends, values, shown):
        self.ends, self.values, self.shown = ends, values, shown

    def at(self, t):
        """Centres of mass (time, body, xyz) and triads (time, body, xyz, director) at instants t."""
        t = np.atleast_1d(np.asarray(t, REAL))
        assert self.ends[0] <= t.min() and t.max() <= self.ends[-1] + 1e-12, "outside the motion"
        piece = np.clip(np.searchsorted(self.ends, t, side="left") - 1, 0, len(self.values) - 1)
        y = np.empty((len(t), *self.values.shape[2:]), REAL)
        for k in np.unique(piece):
            mine = piece == k
            s = (t[mine] - self.ends[k]) / (self.ends[k + 1] - self.ends[k])
            y[mine] = interpolate(self.values[k], s)
        centres, q = self.shown(y)
        q = q / np.sqrt(dot(q, q))[..., None]
        return centres.astype(float), rotation(q).astype(float)


def piece_of(mechanism, t, h, y0):
    """Values at the nodes and the iterations of one piece; None where it is too long."""
    y = np.broadcast_to(y0, (N + 1, *y0.shape))
    scale, last = np.abs(y0).max(), np.inf
    for k in range(MOST_ITERATIONS):
        with np.errstate(all="ignore"):   # a piece that is too long runs away
            f = mechanism.rate(t + h * POINTS, y)
        new = y0 + h * np.tensordot(INTEGRALS, f, 1)
        change = np.abs(new - y).max()
        y = new
        scale = max(scale, np.abs(y).max())
        if not np.isfinite(change) or change > 1e6 * scale:
            return None, k
        if change <= REST * scale or (k > 8 and change < 1e-17 * scale and change >= last):
            break
        last = change
    else:
        return None, k
    tail = np.abs(np.tensordot(COEFFICIENTS[-4:], y, 1)).max()
    return (y, k) if tail <= TAIL * scale else (None, k)


def march(mechanism, end, first=0.1):
    """The motion from 0 to `end`."""
    stops = [t for t in mechanism.breaks if 0 < t < end] + [end]
    ends, values, h, y = [REAL(0)], [], REAL(first), mechanism.start
    for stop in map(REAL, stops):
        while ends[-1] < stop:
            left = stop - ends[-1]
            step = left / np.ceil(left / h)
            found, k = piece_of(mechanism, ends[-1], step, y)
            if found is None:
                h = step / 2
                assert h > 1e-6, f"no motion behind {float(ends[-1])} s"
                continue
            values.append(found)
            ends.append(stop if step == left else ends[-1] + step)
            y = found[-1]
            h = step * REAL(1.25 if k < 40 else 1)
    return Motion(real(ends), np.stack(values), mechanism.shown)


def of(scenario, end=None, kept_in=None, kind=Mechanism):
    """The motion of a scenario's text up to `end` (default: its own); kept in a folder, it is made once."""
    content = tomllib.loads(scenario)
    end = end or content["time"]["end"]
    for key in ("time", "method", "title"):
        content.pop(key, None)
    mechanism = kind(content)
    if kept_in is None:
        return march(mechanism, end)
    mine = hashlib.sha256((repr(content) + repr(end) + kind.__name__ +
                           pathlib.Path(__file__).read_text("utf-8")).encode())
    path = pathlib.Path(kept_in) / f"{mine.hexdigest()[:20]}.npz"
    if not path.exists():
        motion = march(mechanism, end)
        path.parent.mkdir(parents=True, exist_ok=True)
        np.savez(path, ends=motion.ends, values=motion.values)
    with np.load(path) as kept:
        return Motion(kept["ends"], kept["values"], mechanism.shown)
