# SPDX-License-Identifier: BSD-3-Clause
"""The equations of a tree of hinges, slides and balls with loads, gears and plane loops in minimal coordinates, of whatever
numbers are given: floats, or expressions of which a program is made. As tree_by_hand.h has them, but apart from it.

All is told about the origin of space: a motion is six numbers (turning, velocity of what passes the origin), a force
(moment, force). Zeros that are known to be zero are left out, so that a plane mechanism has plane equations.
"""
import numpy as np

from serve import inside, of_kind, tree, turn_of

ZERO = (0.0, 0.0, 0.0)


def is_zero(x):
    return isinstance(x, float) and x == 0


def plus(x, y):
    return y if is_zero(x) else x if is_zero(y) else x + y


def minus(x, y):
    return x if is_zero(y) else -1.0 * y if is_zero(x) else x - y


def times(x, y):
    if is_zero(x) or is_zero(y):
        return 0.0
    return y if isinstance(x, float) and x == 1 else x if isinstance(y, float) and y == 1 else x * y


def total(terms):
    sum_ = 0.0
    for term in terms:
        sum_ = plus(sum_, term)
    return sum_


def add(a, b):
    return tuple(map(plus, a, b))


def sub(a, b):
    return tuple(map(minus, a, b))


def scaled(s, a):
    return tuple(times(s, x) for x in a)


def dot(a, b):
    return total(map(times, a, b))


def cross(a, b):
    return tuple(minus(times(a[i], b[j]), times(a[j], b[i])) for i, j in ((1, 2), (2, 0), (0, 1)))


def apply(R, a):
    return tuple(dot(row, a) for row in R)


def product(R, S):
    columns = list(zip(*S))
    return tuple(tuple(dot(row, column) for column in columns) for row in R)


def floats(a):
    return tuple(map(float, a))


def rows(R):
    """Entries that miss a whole number by rounding are that number: many are zeros."""
    return tuple(tuple(float(round(x)) if abs(x - round(x)) < 1e-15 else float(x) for x in row) for row in R)


def of_quaternion(w, x, y, z):
    def twice(a, b, c, d, sign):
        return times(2.0, plus(times(a, b), times(sign, times(c, d))))
    square = [minus(1.0, times(2.0, plus(times(a, a), times(b, b)))) for a, b in ((y, z), (x, z), (x, y))]
    return ((square[0], twice(x, y, w, z, -1.0), twice(x, z, w, y, 1.0)),
            (twice(x, y, w, z, 1.0), square[1], twice(y, z, w, x, -1.0)),
            (twice(x, z, w, y, -1.0), twice(y, z, w, x, 1.0), square[2]))


def motion_cross(a, b):
    return (*cross(a[:3], b[:3]), *add(cross(a[:3], b[3:]), cross(a[3:], b[:3])))


def force_cross(a, b):
    return (*add(cross(a[:3], b[:3]), cross(a[3:], b[3:])), *cross(a[:3], b[3:]))


def velocity_at(V, x):
    return add(V[3:], cross(V[:3], x))


class Inertia:
    """Mass, mass times centre, second moments about the origin."""

    def __init__(self, m, mc, J):
        self.m, self.mc, self.J = m, mc, J

    @classmethod
    def of(cls, b, x, R):
        m, c = float(b.mass), add(x, apply(R, floats(b.center)))
        columns, cc = list(zip(*R)), times(float(b.mass), dot(c, c))
        J = [[total([times(times(float(b.inertia[k]), columns[k][i]), columns[k][j]) for k in range(3)]
                    + [cc if i == j else 0.0, times(-m, times(c[i], c[j]))]) for j in range(3)] for i in range(3)]
        return cls(m, scaled(m, c), J)

    def plus(self, other):
        return Inertia(self.m + other.m, add(self.mc, other.mc), [add(a, b) for a, b in zip(self.J, other.J)])

    def __call__(self, V):
        return (*add(apply(self.J, V[:3]), cross(self.mc, V[3:])), *add(scaled(self.m, V[3:]), cross(V[:3], self.mc)))


class Column:
    """One way to move: of a body, a motion; `number` in q of a coordinate, None of a ball."""

    def __init__(self, body, number, load):
        self.body, self.number, self.load, self.s = body, number, load, None


class System:
    """q: coordinates, and four numbers of a ball's quaternion (what it has turned since the start); u: rates, and a ball's
    angular velocity against its parent, in space."""

    def __init__(self, m, sin, cos, sqrt):
        self.m, self.sin, self.cos, self.sqrt = m, sin, cos, sqrt
        self.branches, self.closing = tree(m)
        if any(b.parent is None or b.parent >= i for i, b in enumerate(self.branches)) or of_kind(m, "bushing"):
            raise ValueError("not derived")
        self.columns, self.first, self.q0, self.u0 = [], [], [], []
        for i, b in enumerate(self.branches):
            self.first.append(len(self.q0))
            if b.kind == "ball":
                self.columns += [Column(i, None, None) for _ in range(3)]
                self.q0 += [1.0, 0.0, 0.0, 0.0]
                w = np.array(b.body.w, float)
                self.u0 += floats(w if b.parent < 0 else w - np.array(m.bodies[b.parent].w))
            else:
                self.columns.append(Column(i, len(self.q0), b.load))
                self.q0.append(0.0)
                self.u0.append(float(b.rate @ b.axis) if b.kind == "hinge" else 0.0)

    def at(self, body, x):
        return floats(x) if body < 0 else add(self.x[body], apply(self.R[body], floats(x)))

    def put(self, q):
        self.x, self.R, columns = [], [], iter(self.columns)
        for i, b in enumerate(self.branches):
            R = rows(b.R) if b.parent < 0 else product(self.R[b.parent], rows(b.R))
            x = self.at(b.parent, b.place)
            if b.kind == "ball":
                R = product(of_quaternion(*q[self.first[i]:self.first[i] + 4]), rows(turn_of(self.m, i)))
                for e in ((1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0)):
                    next(columns).s = (*e, *cross(x, e))
            else:
                axis, value = apply(R, rows([b.axis])[0]), q[self.first[i]]
                if b.kind == "slide":
                    x = add(x, scaled(value, axis))
                    next(columns).s = (*ZERO, *axis)
                else:
                    next(columns).s = (*axis, *cross(x, axis))
                    R = product(R, self.about(rows([b.axis])[0], value))
            self.x.append(x)
            self.R.append(R)

    def about(self, a, angle):
        c, s = self.cos(angle), self.sin(angle)
        K = ((0.0, -a[2], a[1]), (a[2], 0.0, -a[0]), (-a[1], a[0], 0.0))
        return tuple(tuple(total([times(c, (1.0 if i == j else 0.0) - a[i] * a[j]), a[i] * a[j], times(s, K[i][j] + 0.0)])
                           for j in range(3)) for i in range(3))

    def own(self, i, u):
        return total_of(scaled(u[k], c.s) for k, c in enumerate(self.columns) if c.body == i)

    def move(self, u):
        fall = (*ZERO, *(-float(g) for g in self.m.gravity))
        self.V, self.A = [], []
        for i, b in enumerate(self.branches):
            own = self.own(i, u)
            V, A = (own, fall) if b.parent < 0 else (add(self.V[b.parent], own), self.A[b.parent])
            turning = (*ZERO, *cross(velocity_at(V, self.x[i]), own[:3])) if b.kind == "ball" else motion_cross(V, own)
            self.V.append(V)
            self.A.append(add(A, turning))

    def bias(self, body, x):
        V = self.V[body]
        return add(velocity_at(self.A[body], x), cross(V[:3], velocity_at(V, x)))

    def balance(self, q, u, t):
        """M, by its lower half, and r."""
        I = [Inertia.of(b.body, x, R) for b, x, R in zip(self.branches, self.x, self.R)]
        F = [add(one(A), force_cross(V, one(V))) for one, A, V in zip(I, self.A, self.V)]
        for spring in of_kind(self.m, "spring"):
            for body, wrench in self.pull(spring, t):
                F[body] = add(F[body], wrench)
        for i in reversed(range(len(I))):
            parent = self.branches[i].parent
            if parent >= 0:
                I[parent], F[parent] = I[parent].plus(I[i]), add(F[parent], F[i])
        M, r = {}, []
        for k, c in enumerate(self.columns):
            r.append(minus(0.0 if c.number is None else self.pushed(c, q, u[k]), dot(c.s, F[c.body])))
            momentum, over = I[c.body](c.s), self.ancestors(c.body)
            for j, d in enumerate(self.columns[:k + 1]):
                if d.body in over:
                    M[k, j] = dot(d.s, momentum)
        return M, r

    def ancestors(self, i):
        found = set()
        while i >= 0:
            found.add(i)
            i = self.branches[i].parent
        return found

    @staticmethod
    def pushed(c, q, rate):
        load = c.load
        return total([load.push + 0.0, times(-load.stiffness + 0.0, q[c.number]), times(-load.damping + 0.0, rate)])

    def pull(self, spring, t):
        first, second = int(spring[0]), int(spring[1])
        k, c, length0, amplitude, omega = map(float, spring[8:13])
        x1, x2, v1 = self.at(first, spring[2:5]), self.at(second, spring[5:8]), ZERO
        if first >= 0:
            v1 = velocity_at(self.V[first], x1)
        elif amplitude:
            x1 = add(x1, (0.0, 0.0, amplitude * self.sin(omega * t)))
            v1 = (0.0, 0.0, amplitude * omega * self.cos(omega * t))
        way = sub(x2, x1)
        length = self.sqrt(dot(way, way))
        rate = dot(way, sub(velocity_at(self.V[second], x2), v1)) / length
        f = scaled((k * (length - length0) + c * rate) / length, way)
        yield second, (*cross(x2, f), *f)
        if first >= 0:
            yield first, (*cross(f, x1), *scaled(-1.0, f))

    def dependence(self):
        """G and g: u' of all columns by those that are free."""
        n = len(self.columns)
        of, ratio, g = list(range(n)), [1.0] * n, [0.0] * n
        column_of = {self.branches[c.body].joint: k for k, c in enumerate(self.columns)}
        for first, second, value in of_kind(self.m, "gear"):
            a, b = column_of[int(first)], column_of[int(second)]
            of[b], ratio[b] = of[a], ratio[a] * float(value)
        G = {(k, of[k]): ratio[k] for k in range(n)}
        for kind, first, second, numbers in self.closing:
            self.close(first, second, inside(self.m, first, numbers[:3]), G, g)
        free = [k for k in range(n) if (k, k) in G]
        return free, G, g

    def close(self, first, second, place, G, g):
        """A plane loop: the last two columns that only one side has follow."""
        x = self.at(first, place)
        sides = [self.ancestors(first), self.ancestors(second)]
        apart = [k for k, c in enumerate(self.columns) if (c.body in sides[0]) != (c.body in sides[1])]
        plane = [i for i in range(3) if not all(is_zero(velocity_at(self.columns[k].s, x)[i]) for k in apart)]
        lever = {k: [velocity_at(self.columns[k].s, x)[i] for i in plane] for k in apart}
        for k in apart:
            if self.columns[k].body in sides[1]:
                lever[k] = [times(-1.0, y) for y in lever[k]]
        more = [sub(self.bias(first, x), self.bias(second, x))[i] for i in plane]
        a, b = apart[-2:]

        def det(p, q):
            return minus(times(p[0], q[1]), times(p[1], q[0]))
        whole = det(lever[a], lever[b])
        for k in apart[:-2]:
            G[a, k] = -1.0 * det(lever[k], lever[b]) / whole
            G[b, k] = -1.0 * det(lever[a], lever[k]) / whole
        g[a], g[b] = -1.0 * det(more, lever[b]) / whole, -1.0 * det(lever[a], more) / whole
        del G[a, a], G[b, b]

    def rates(self, q, free_u, t):
        """q' of all of q, and u' of what is free."""
        self.put(q)
        self.move([0.0] * len(self.columns))
        free, G, _ = self.dependence()
        u = [total(times(G.get((k, f), 0.0), v) for f, v in zip(free, free_u)) for k in range(len(self.columns))]
        self.move(u)
        free, G, g = self.dependence()
        M, r = self.balance(q, u, t)
        return self.turned(q, u), solved(*reduced(M, r, free, G, g))

    def turned(self, q, u):
        found, w, k = [], [], 0
        for i, b in enumerate(self.branches):
            if b.kind == "ball":
                w.append(u[k:k + 3] if b.parent < 0 else add(w[b.parent], u[k:k + 3]))
                p, v = q[self.first[i]:self.first[i] + 4], w[i]
                found.append(times(-0.5, dot(p[1:], v)))
                found += scaled(0.5, add(scaled(p[0], v), cross(v, p[1:])))
                k += 3
            else:
                w.append(self.V[i][:3])
                found.append(u[k])
                k += 1
        return found

    def start(self):
        self.put(self.q0)
        self.move(self.u0)
        return self.q0, [self.u0[k] for k in self.dependence()[0]]


def total_of(motions):
    sum_ = (0.0,) * 6
    for motion in motions:
        sum_ = add(sum_, motion)
    return sum_


def reduced(M, r, free, G, g):
    """G^T M G and G^T (r - M g)."""
    if len(free) == len(r):
        return M, r
    n = range(len(r))

    def of(i, j):
        return M.get((max(i, j), min(i, j)), 0.0)
    left = [minus(r[i], total(times(of(i, j), g[j]) for j in n)) for i in n]
    MG = [[total(times(of(i, j), G.get((j, f), 0.0)) for j in n) for f in free] for i in n]
    return ({(a, b): total(times(G.get((i, free[a]), 0.0), MG[i][b]) for i in n) for a in range(len(free)) for b in range(a + 1)},
            [total(times(G.get((i, f), 0.0), left[i]) for i in n) for f in free])


def solved(M, r):
    """From the last to the first, which fills no zeros of a tree."""
    n, M, r = len(r), dict(M), list(r)
    shares = {}
    for k in reversed(range(n)):
        entries = [j for j in range(k) if not is_zero(M.get((k, j), 0.0))]
        for j in entries:
            shares[k, j] = M[k, j] / M[k, k]
        for j in entries:
            r[j] = minus(r[j], times(shares[k, j], r[k]))
            for i in entries:
                if i <= j:
                    M[j, i] = minus(M.get((j, i), 0.0), times(shares[k, j], M[k, i]))
    for k in range(n):
        r[k] = minus(r[k] / M[k, k], total(times(shares[k, j], r[j]) for j in range(k) if (k, j) in shares))
    return r
