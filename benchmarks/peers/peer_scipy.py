# SPDX-License-Identifier: BSD-3-Clause
"""Minimal coordinates derived by hand, in Python, and SciPy's solvers. Settings: "METHOD:TOLERANCE"."""
from math import cos, pi, sin

from scipy.integrate import solve_ivp

from serve import serve


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


PROBLEMS = {"rods": lambda: links(True), "links": lambda: links(False), "parallelograms": parallelograms}


def prepare(m, setting):
    if m.name not in PROBLEMS:
        raise ValueError("not derived")
    f, start, points = PROBLEMS[m.name]()
    tolerance = float(setting[1])

    def solve():
        found = solve_ivp(f, (0, m.end), start, method=setting[0], rtol=max(tolerance, 2.3e-14), atol=tolerance)
        return lambda: points(found.y[:, -1])
    return solve


if __name__ == "__main__":
    serve(prepare)
