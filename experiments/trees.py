# SPDX-License-Identifier: BSD-3-Clause
"""True motions of trees of bodies under laws that are sharp, bend or jump, in coordinates of their joints.

A formulation that shares nothing with livens, nor with truth.py: every joint is a row of turns and slides
about axes as they stand at the start (products of exponentials), M(q) q'' = Q from twists at the origin,
rods by multipliers on the level of accelerations. Time is cut and solved as in laws.py: steps are
polynomials for q'' on Chebyshev points, by Newton's iteration, in double precision; they end at borders of
switches. `error` of a motion is its distance to a march of lower degree and tolerance, m or rad.

    motion = trees.of(text, end, sharp)   # text of a scenario without [time] and [method]; sharp: see Tree
    centres, triads = motion.at(times)

What it reads: bodies by mass and inertia, or points; revolute, prismatic, cylindrical, universal, spherical
joints by `at`, from bodies that stand above in the file; rods between any; actuators by expressions of
coordinates; springs on joints and between points, linear or by tables; drag; forces that are constant;
bushings about the axis of a joint.
"""
import hashlib
import pathlib
import tomllib

import numpy as np

import laws
from truth import cross


def turned(axis, angle):
    """Matrices (k, 3, 3) of turns about one unit vector."""
    x, y, z = axis
    K = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    s, c = np.sin(angle)[:, None, None], np.cos(angle)[:, None, None]
    return np.eye(3) + s * K + (1 - c) * (K @ K)


class Body:
    def __init__(self, entry):
        self.mass = float(entry["mass"])
        self.is_point = entry.get("shape") == {"point": True}
        inertia = np.array(entry.get("inertia", [0, 0, 0]), float)
        self.inertia = np.diag(inertia) if inertia.ndim == 1 else inertia
        self.R = np.eye(3) if "rotation_vector" not in entry else \
            turned(*unit(entry["rotation_vector"]))[0]
        self.place = np.array(entry.get("position", [0, 0, 0]), float)
        self.centre = self.place + self.R @ entry.get("center_of_mass", [0, 0, 0])
        self.inertia = self.R @ self.inertia @ self.R.T   # in axes of the world at the start
        self.velocity = np.array(entry.get("velocity", [0, 0, 0]), float)
        self.spin = np.array(entry.get("angular_velocity", [0, 0, 0]), float)
        self.chain = []   # numbers of its coordinates, from the world on


def unit(vector):
    size = np.linalg.norm(vector)
    return (np.array(vector) / size, np.array([size])) if size else (np.array([1.0, 0, 0]), np.array([0.0]))


class Tree:
    """q'' of t, q, q'; what laws.March asks of a law.

    sharp   narrow places of laws: (what, centre, width), of "t", "joint.angle", "joint.angle_rate", ..
    """
    WHAT = {"R": "angle", "P": "displacement"}

    def __init__(self, text, sharp=()):
        content = tomllib.loads(text)
        self.gravity = np.array(content.get("gravity", [0, 0, 0]), float)
        self.bodies = [Body(entry) for entry in content["body"]]
        self.index = {"world": None} | {entry["name"]: i for i, entry in enumerate(content["body"])}
        self.kinds, self.axes, self.points = [], [], []   # of coordinates
        self.above = []                                   # the coordinate before each
        self.coordinates, self.rods = {}, []   # "joint.angle" -> (number, value at the start)
        self.switches, self.borders, self.terms = [], [], []
        tied = {entry["between"][1]: entry for entry in content.get("joint", []) if entry["type"] != "rod"}
        for entry in content["body"]:
            self.hang(entry["name"], tied.get(entry["name"]))
        for entry in content.get("joint", []):
            if entry["type"] == "rod":
                self.rods.append(self.two_points(entry))
        self.n = len(self.kinds)
        self.mask = np.array([[i in body.chain for i in range(self.n)] for body in self.bodies], float)
        for entry in content.get("load", []):
            getattr(self, entry["type"])(entry)
        self.breaks = sorted({centre + k * width for what, centre, width in sharp if what == "t"
                              for k in laws.Law.PLACES})
        for what in {what for what, *_ in sharp} - {"t"}:
            read = self.reader(what)
            borders = {centre + k * width for mine, centre, width in sharp if mine == what
                       for k in laws.Law.PLACES}
            self.switch(lambda s, pieces, read=read: read(s), sorted(borders))

    # structure

    def add(self, body, kind, axis, point=(0, 0, 0)):
        chain = self.bodies[body].chain
        self.above.append(chain[-1] if chain else None)
        chain.append(len(self.kinds))
        self.kinds.append(kind)
        self.axes.append(np.array(axis, float) / np.linalg.norm(axis))
        self.points.append(np.array(point, float))

    def hang(self, name, joint):
        """Coordinates of a body."""
        k, x = self.index[name], np.eye(3)
        if joint is None:
            for axis in x:
                self.add(k, "P", axis)
            for axis in x if not self.bodies[k].is_point else ():
                self.add(k, "R", axis, self.bodies[k].centre)
            return
        first, at = self.index[joint["between"][0]], joint["at"]
        self.bodies[k].chain = list(self.bodies[first].chain) if first is not None else []
        rows = {"revolute": "R", "prismatic": "P", "cylindrical": "PR", "universal": "RR", "spherical": "RRR"}
        kinds = rows[joint["type"]]
        axes = [joint["axis"]] * 2 if "axis" in joint else joint.get("axes", x)
        for kind, axis in zip(kinds, axes):
            if joint["type"] not in ("universal", "spherical"):
                what = f"{joint['name']}.{self.WHAT[kind]}"
                self.coordinates[what] = len(self.kinds), joint.get("coordinate", 0.0)
            self.add(k, kind, axis, at)

    def two_points(self, entry):
        """Pairs (body, place at the start)."""
        found = []
        for name, point in zip(entry["between"], entry.get("points", [[0, 0, 0]] * 2)):
            k = self.index[name]
            found.append((k, np.array(point, float) if k is None else
                          self.bodies[k].place + self.bodies[k].R @ point))
        return found

    def switch(self, quantity, borders):
        """quantity: of a state and pieces."""
        self.switches.append(lambda t, q, v, pieces: quantity(State(self, t, q, v), pieces))
        self.borders.append(np.array(borders, float))
        return len(self.switches) - 1

    def reader(self, what):
        """Of a state: "joint.angle" and the like."""
        number, begin = self.coordinates[what.removesuffix("_rate")]
        if what.endswith("_rate"):
            return lambda s: s.v[:, number]
        return lambda s: s.q[:, number] + begin

    # loads: terms (state, pieces) that add to state.Q

    def actuator(self, entry):
        formula, first = laws.Expression(entry["expression"]), len(self.switches)
        last = first + len(formula.switches)
        inputs = {symbol: self.reader(what) for symbol, what in entry.get("inputs", {}).items()}

        def names(s):
            return {"t": s.t} | {symbol: read(s) for symbol, read in inputs.items()}
        for quantity in formula.switches:
            self.switch(lambda s, pieces, q=quantity: q(names(s), pieces[first:last]) + 0 * s.t, [0])
        number = self.coordinates[f"{entry['joint']}.{self.only(entry)}"][0]

        def act(s, pieces):
            s.Q[:, number] += formula.value(names(s), pieces[first:last])
        self.terms.append(act)

    def only(self, entry):
        """The coordinate of a load's joint."""
        return entry.get("coordinate") or next(what for what in self.WHAT.values()
                                               if f"{entry['joint']}.{what}" in self.coordinates)

    def law_of(self, entry, elongation):
        """Force by elongation (state, pieces) of a spring."""
        if entry.get("law") != "table":
            return lambda s, pieces: float(entry["stiffness"]) * elongation(s)
        rows = entry["table"]
        table = laws.Table(rows["elongations"], rows["forces"], rows["interpolation"] == "spline")
        k = self.switch(lambda s, pieces: elongation(s), table.borders)
        return lambda s, pieces: table.at(elongation(s), pieces[k]).astype(float)

    def spring(self, entry):
        damping = float(entry.get("damping", 0))
        if "joint" in entry:
            what = f"{entry['joint']}.{self.only(entry)}"
            number, read, rest = self.coordinates[what][0], self.reader(what), float(entry.get("rest", 0))
            law = self.law_of(entry, lambda s: read(s) - rest)

            def act(s, pieces):
                s.Q[:, number] -= law(s, pieces) + damping * s.v[:, number]
            self.terms.append(act)
            return
        ends, free = self.two_points(entry), float(entry["free_length"])

        def length(s):
            d = s.point(*ends[1]) - s.point(*ends[0])
            return np.sqrt((d * d).sum(-1))
        law = self.law_of(entry, lambda s: length(s) - free)

        def pull(s, pieces):
            d = s.point(*ends[1]) - s.point(*ends[0])
            long = np.sqrt((d * d).sum(-1))
            rate = ((s.velocity(*ends[1]) - s.velocity(*ends[0])) * d).sum(-1) / long
            F = ((law(s, pieces) + damping * rate) / long)[:, None] * d
            s.push(*ends[0], F)
            s.push(*ends[1], -F)
        self.terms.append(pull)

    def drag(self, entry):
        k = self.index[entry["body"]]
        at = self.bodies[k].place + self.bodies[k].R @ entry.get("point", [0, 0, 0])
        linear, quadratic = float(entry.get("linear", 0)), float(entry.get("quadratic", 0))
        medium = np.array(entry.get("medium", [0, 0, 0]), float)
        alone = len(self.bodies[k].chain) == 1 and not medium.any()   # its velocity reverses through zero
        if alone:
            number = self.bodies[k].chain[0]
            switch = self.switch(lambda s, pieces: s.v[:, number], [0])

        def act(s, pieces):
            u = s.velocity(k, at) - medium
            if alone:
                J = s.columns(k, at)[:, number]
                size = (1 if pieces[switch] else -1) * s.v[:, number] * np.sqrt((J * J).sum(-1))
            else:
                size = np.sqrt((u * u).sum(-1))
            s.push(k, at, -(linear + quadratic * size)[:, None] * u)
        self.terms.append(act)

    def force(self, entry):
        k = self.index[entry["body"]]
        at = self.bodies[k].place + self.bodies[k].R @ entry.get("point", [0, 0, 0])
        F = np.array(entry["value"], float)
        self.terms.append(lambda s, pieces: s.push(k, at, F + 0 * s.t[:, None]))

    def bushing(self, entry):
        """Along the one coordinate between its bodies, whose axis is one of the world at the start."""
        number = self.bodies[self.index[entry["between"][1]]].chain[-1]
        i = int(np.argmax(np.abs(self.axes[number]))) + 3 * (self.kinds[number] == "R")
        stiffness, damping, ahead = (float(entry.get(key, [0] * 6)[i])
                                     for key in ("stiffness", "damping", "preload"))

        def act(s, pieces):
            s.Q[:, number] -= stiffness * s.q[:, number] + damping * s.v[:, number] + ahead
        self.terms.append(act)

    # what laws.March asks for

    def acceleration(self, t, q, v, pieces):
        s = State(self, t, q, v, full=True)
        for term in self.terms:
            term(s, pieces)
        if not self.rods:
            return np.linalg.solve(s.M, s.Q[..., None])[..., 0]
        m, n = len(self.rods), self.n
        A, b = np.zeros((len(t), n + m, n + m)), np.zeros((len(t), n + m))
        A[:, :n, :n], b[:, :n] = s.M, s.Q
        for i, (one, other) in enumerate(self.rods):
            d, rate = s.point(*one) - s.point(*other), s.velocity(*one) - s.velocity(*other)
            row = np.einsum("kix,kx->ki", s.columns(*one) - s.columns(*other), d)
            A[:, n + i, :n], A[:, :n, n + i] = row, row
            b[:, n + i] = -(rate * rate).sum(-1) - ((s.bias(*one) - s.bias(*other)) * d).sum(-1)
        return np.linalg.solve(A, b[..., None])[:, :n, 0]

    def pieces(self, t, q, v):
        found = []
        zero = [0] * len(self.switches)
        t = np.array([float(t)])
        for quantity, borders in zip(self.switches, self.borders):
            at, later = (float(quantity(t, (q + 1e-9 * k * v)[None], v[None], zero)[0]) for k in (0, 1))
            found.append(int(np.searchsorted(borders, at + 1e-6 * (later - at))))
        return found

    def start(self):
        """Rates of the coordinates at the start."""
        s = State(self, np.zeros(1), np.zeros((1, self.n)), np.zeros((1, self.n)), full=True)
        rows, right = [], []
        for k, body in enumerate(self.bodies):
            rows.append(s.columns(k, body.place)[0].T)
            right.append(body.velocity)
            if not body.is_point:
                rows.append((s.a[0] * self.mask[k][:, None]).T)
                right.append(body.spin)
        rows, right = np.concatenate(rows), np.concatenate(right)
        rates, *_ = np.linalg.lstsq(rows, right, rcond=None)
        assert np.abs(rows @ rates - right).max() < 1e-12, "velocities break joints"
        return np.zeros(self.n), rates

    def moving(self, rates):
        """Velocities and spins of the bodies at the start for given rates, made to fit rods."""
        s = State(self, np.zeros(1), np.zeros((1, self.n)), np.array(rates, float)[None], full=True)
        if self.rods:
            G = np.array([(s.columns(*p) - s.columns(*q))[0] @ (s.point(*p) - s.point(*q))[0]
                          for p, q in self.rods])
            s.v = s.v - (np.linalg.pinv(G) @ (G @ s.v[0]))[None]
            s = State(self, s.t, s.q, s.v, full=True)
        return [(s.velocity(k, body.place)[0], s.w[k][0]) for k, body in enumerate(self.bodies)]

    def shown(self, q):
        s = State(self, np.zeros(len(q)), q, 0 * q)
        centres = np.stack([s.point(k, body.centre) for k, body in enumerate(self.bodies)], 1)
        return centres, np.stack([s.R[body.chain[-1]] @ body.R for body in self.bodies], 1)


class State:
    """All of many instants (k): where the bodies are, twists, and with `full` masses and forces."""

    def __init__(self, tree, t, q, v, full=False):
        self.tree = tree
        self.t, self.q, self.v = (np.asarray(of, float) for of in (t, q, v))
        K = len(self.q)
        self.R, self.p = {None: np.broadcast_to(np.eye(3), (K, 3, 3))}, {None: np.zeros((K, 3))}
        self.a, self.b = np.zeros((2, K, tree.n, 3))   # columns of twists at the origin
        twist, bias = ({None: (0 * self.p[None], 0 * self.p[None])} for _ in range(2))
        for i, (kind, axis, point, above) in enumerate(zip(tree.kinds, tree.axes, tree.points, tree.above)):
            R, p = self.R[above], self.p[above]
            along = R @ axis
            if kind == "R":
                self.R[i] = R @ turned(axis, self.q[:, i])
                here = R @ point + p
                self.p[i] = here - self.R[i] @ point
                self.a[:, i], self.b[:, i] = along, cross(here, along)
            else:
                self.R[i], self.p[i] = R, p + along * self.q[:, i, None]
                self.b[:, i] = along
            (w, u), (dw, du), rate = twist[above], bias[above], self.v[:, i, None]
            bias[i] = (dw + cross(w, self.a[:, i]) * rate,
                       du + (cross(w, self.b[:, i]) + cross(u, self.a[:, i])) * rate)
            twist[i] = w + self.a[:, i] * rate, u + self.b[:, i] * rate
        last = [body.chain[-1] for body in tree.bodies]
        self.w, self.u = [twist[i][0] for i in last], [twist[i][1] for i in last]
        self.dw, self.du = [bias[i][0] for i in last], [bias[i][1] for i in last]
        if full:
            self.weigh()

    def weigh(self):
        tree = self.tree
        self.M, self.Q = np.zeros((len(self.q), tree.n, tree.n)), np.zeros(self.q.shape)
        for k, body in enumerate(tree.bodies):
            J = self.columns(k, body.centre)
            self.M += body.mass * J @ np.swapaxes(J, 1, 2)
            self.Q += body.mass * (J @ (tree.gravity - self.bias(k, body.centre))[..., None])[..., 0]
            if not body.is_point:
                R = self.R[body.chain[-1]]
                I, w = R @ body.inertia @ np.swapaxes(R, 1, 2), self.w[k]
                J = self.a * tree.mask[k][:, None]
                self.M += J @ I @ np.swapaxes(J, 1, 2)
                turn = (I @ self.dw[k][..., None])[..., 0] + cross(w, (I @ w[..., None])[..., 0])
                self.Q -= (J @ turn[..., None])[..., 0]

    # of points of bodies, by their places at the start

    def point(self, k, at):
        if k is None:
            return np.broadcast_to(at, (len(self.q), 3))
        i = self.tree.bodies[k].chain[-1]
        return self.R[i] @ at + self.p[i]

    def velocity(self, k, at):
        return np.zeros((len(self.q), 3)) if k is None else self.u[k] + cross(self.w[k], self.point(k, at))

    def bias(self, k, at):
        """Acceleration without q''."""
        if k is None:
            return np.zeros((len(self.q), 3))
        x = self.point(k, at)
        return self.du[k] + cross(self.dw[k], x) + cross(self.w[k], self.velocity(k, at))

    def columns(self, k, at):
        """Of its velocity by rates, (k, n, xyz)."""
        if k is None:
            return np.zeros(self.a.shape)
        return (self.b + cross(self.a, self.point(k, at)[:, None] + 0 * self.a)) * self.tree.mask[k][:, None]

    def push(self, k, at, F):
        if k is not None:
            self.Q += (self.columns(k, at) @ F[..., None])[..., 0]


class March(laws.March):
    """Steps of all coordinates, in double precision."""
    POINTS_OF = {n: laws.Points(n, lambda x: np.array(x, float)) for n in (24, 20)}
    MOST_STEPS = 1500
    NEAR = 2.0**-30

    @staticmethod
    def parts(values):
        n = values.shape[-1] // 2
        return (values[:, :n], values[:, n:]) if values.ndim == 2 else (values[None, :n], values[None, n:])

    def step(self, *of):
        try:
            return self.solved(*of)
        except np.linalg.LinAlgError:   # states of an iteration that runs away
            return None

    def solved(self, t, x, v, h, pieces, scales):
        law, P, h = self.law, self.points, float(h)
        x, v = np.ravel(x), np.ravel(v)
        times, m, n = float(t) + h * P.s, P.n + 1, law.n
        a = np.zeros((m, n)) + law.acceleration(times[:1], x[None], v[None], pieces)
        matrix, last, fresh = None, np.inf, False
        for k in range(laws.MOST_ITERATIONS):
            speed = v + h * (P.once @ a)
            place = x + h * P.s[:, None] * v + h * h * (P.twice @ a)
            if matrix is None:
                f, by_x, by_v = self.slopes(times, place, speed, pieces, scales)
                J = (-h * h * P.twice[:, None, :, None] * by_x[:, :, None, :] -
                     h * P.once[:, None, :, None] * by_v[:, :, None, :]).reshape(m * n, m * n)
                if not np.isfinite(J).all():
                    return None
                matrix, fresh = np.linalg.inv(np.eye(m * n) + J), True
            else:
                f = law.acceleration(times, place, speed, pieces)
            correction = (matrix @ (f - a).ravel()).reshape(m, n)
            if not np.isfinite(correction).all():
                return None
            a = a + correction
            change = max(h * np.abs(P.once @ correction).max() / scales[1],
                         h * h * np.abs(P.twice @ correction).max() / scales[0])
            if change < 3e-16 or (change < 1e-13 and change > 0.3 * last):
                break
            if change > 0.2 * last and not fresh:
                matrix = None   # it has changed much
            elif change > 0.8 * last and k > 3:
                return None
            last, fresh = change, False
        else:
            return None
        values = np.concatenate([x + h * P.s[:, None] * v + h * h * (P.twice @ a), v + h * (P.once @ a)], -1)
        return values, *self.reach(values, np.repeat(scales, n))

    def slopes(self, times, x, v, pieces, scales):
        """q'' and its derivatives by q and q', all nodes at once."""
        m, n = x.shape
        d = 1e-7 * scales
        more = np.concatenate([np.zeros((1, 2 * n)), np.diag(np.repeat(d, n))])   # (1 + 2 n, 2 n)
        states = np.concatenate([x, v], -1) + more[:, None]
        states = states.reshape(-1, 2 * n)
        times = np.tile(times, 1 + 2 * n)
        f = self.law.acceleration(times, states[:, :n], states[:, n:], pieces).reshape(-1, m, n)
        by = np.moveaxis(f[1:] - f[0], 0, -1) / np.repeat(d, n)   # (m, n, 2 n)
        return f[0], by[..., :n], by[..., n:]


VERSION = 1   # of motions that are kept: raise it where they change
FINE, ROUGH = (24, 3e-14), (20, 3e-13)


class Shown:
    """What scans.errors asks of a true motion."""

    def __init__(self, tree, motion):
        self.tree, self.motion, self.ends = tree, motion, motion.ends

    def at(self, times):
        return self.tree.shown(self.motion.coordinate(np.minimum(times, float(self.ends[-1]))).astype(float))


def of(text, end, sharp=(), kept_in=None):
    """The motion; kept in a folder, it is made once."""
    tree, path = Tree(text, sharp), None
    if kept_in is not None:
        key = hashlib.sha256((text + repr((end, sharp, FINE, ROUGH, VERSION))).encode()).hexdigest()[:20]
        path = pathlib.Path(kept_in) / f"{key}.npz"
        if path.exists():
            with np.load(path) as kept:
                motion = laws.Motion(March.POINTS_OF[FINE[0]], kept["ends"], kept["lengths"], kept["values"])
                motion.several, shown = True, Shown(tree, motion)
                shown.error = float(kept["error"])
                return shown
    x, v = tree.start()
    fine, rough = (March(tree, *bounds)(x, v, end, end / parts) for bounds, parts in ((FINE, 8), (ROUGH, 11)))
    fine.several = rough.several = True
    shown, other = Shown(tree, fine), Shown(tree, rough)
    times = np.concatenate([np.linspace(0, end, 200), fine.ends[1:-1].astype(float)])
    shown.error = max(float(np.linalg.norm(p - q, axis=-1).max())
                      for p, q in zip(shown.at(times), other.at(times)))
    if path is not None:
        path.parent.mkdir(parents=True, exist_ok=True)
        np.savez(path, ends=fine.ends.astype(float), lengths=np.array(fine.lengths, float),
                 values=np.stack(fine.values), error=shown.error)
    return shown
