# SPDX-License-Identifier: BSD-3-Clause
"""Minimal coordinates derived by hand, in Python, and SciPy's solvers. Settings: "METHOD:TOLERANCE"."""
from math import cos, pi, sin

import numpy as np
from scipy.integrate import solve_ivp

from serve import serve, turn


def links(rods):
    """Two links in one plane by their angles from +x, as in peer_hand.cpp."""
    m1, m2, length, c, J, g = (1.5, 1.5 * 0.512, 4, 4, 0, 9.81) if rods else (1, 1, 1, 0.5, 1, 10)
    A, B, C = m1 * c * c + J + m2 * length * length, m2 * length * c, m2 * c * c + J
    g1, g2 = g * (m1 * c + m2 * length), g * m2 * c

    def f(_, y):
        k, s = B * cos(y[0] - y[1]), B * sin(y[0] - y[1])
        r1, r2 = -s * y[3] * y[3] - g1 * cos(y[0]), s * y[2] * y[2] - g2 * cos(y[1])
        det = A * C - k * k
        return [y[2], y[3], (C * r1 - k * r2) / det, (A * r2 - k * r1) / det]

    def points(y):
        x, h = length * cos(y[0]), length * sin(y[0])
        x2, h2 = x + length * cos(y[1]), h + length * sin(y[1])
        return [(x, 0, h), (x2, 0, h2)] if rods else [(x, h, 0), (x2, h2, 0)]
    start = pi / 4 if rods else 0.0
    return f, [start, start, 0, 0], points


def parallelograms():
    ratio = 9.81 * 3.5 / 3

    def f(_, y):
        return [y[1], ratio * sin(y[0])]
    return f, [0.0, 1.0], lambda y: [(k + sin(y[0]), cos(y[0]), 0) for k in range(3)]


def skew(a):
    return np.array([[0, -a[2], a[1]], [a[2], 0, -a[0]], [-a[1], a[0], 0]])


def bricks(m):
    """A chain on balls by quaternions and angular velocities in space, as chain_by_hand.h has it."""
    n, g, mass = len(m.bodies), np.array(m.gravity), np.array([b.mass for b in m.bodies])
    beyond = np.append(np.cumsum(mass[:0:-1])[::-1], 0)
    centers, J = np.array([b.center for b in m.bodies]), np.array([b.inertia for b in m.bodies])
    arms = np.array([turn(a.q).T @ (np.array(b.x) - a.x) for a, b in zip(m.bodies, m.bodies[1:])] + [[0, 0, 0]])

    def frames(y):
        q = y[:4 * n].reshape(n, 4)
        return q, [turn(one / np.sqrt(one @ one)) for one in q]

    def f(_, y):
        (q, R), w, M, r = frames(y), y[4 * n:].reshape(n, 3), np.empty((3 * n, 3 * n)), np.empty((n, 3))
        l, c = [A @ a for A, a in zip(R, arms)], [A @ a for A, a in zip(R, centers)]
        d = [mass[i] * c[i] + beyond[i] * l[i] for i in range(n)]
        b, along = [], np.zeros(3)
        for i in range(n):
            W = skew(w[i])
            W2 = W @ W
            b.append(along + W2 @ c[i])
            along = along + W2 @ l[i]
        pulled = np.zeros(3)
        for i in reversed(range(n)):
            inertia, L, C = R[i] * J[i] @ R[i].T, skew(l[i]), skew(c[i])
            r[i] = skew(d[i]) @ g - skew(w[i]) @ inertia @ w[i] - mass[i] * C @ b[i] - L @ pulled
            pulled = pulled + mass[i] * b[i]
            M[3 * i:3 * i + 3, 3 * i:3 * i + 3] = inertia - mass[i] * C @ C - beyond[i] * L @ L
            for k in range(i + 1, n):
                M[3 * i:3 * i + 3, 3 * k:3 * k + 3] = block = -L @ skew(d[k])
                M[3 * k:3 * k + 3, 3 * i:3 * i + 3] = block.T
        dq = [0.5 * np.array([-p[1:] @ v, *(p[0] * v + skew(v) @ p[1:])]) for p, v in zip(q, w)]
        return np.concatenate([*dq, np.linalg.solve(M, r.ravel())])

    def points(y):
        R, x, found = frames(y)[1], np.zeros(3), []
        for i, at in m.points:
            found.append(x + R[i] @ at)
            x = x + R[i] @ arms[i]
        return found
    return f, np.concatenate([*(b.q for b in m.bodies), *(b.w for b in m.bodies)]), points


PROBLEMS = {"rods": lambda m: links(True), "links": lambda m: links(False),
            "parallelograms": lambda m: parallelograms(), "bricks": bricks, "balls2": bricks}


def prepare(m, setting):
    if m.name not in PROBLEMS:
        raise ValueError("not derived")
    f, start, points = PROBLEMS[m.name](m)
    tolerance = float(setting[1])

    def solve():
        found = solve_ivp(f, (0, m.end), start, method=setting[0], rtol=max(tolerance, 2.3e-14), atol=tolerance)
        return lambda: points(found.y[:, -1])
    return solve


if __name__ == "__main__":
    serve(prepare)
