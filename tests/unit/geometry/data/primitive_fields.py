# SPDX-License-Identifier: BSD-3-Clause
"""Prints primitive_fields.inc: moments of exp(-x^2 - y) (2 + sin(3 z)) over solids by SciPy's adaptive quadrature.

/usr/bin/python3 primitive_fields.py > primitive_fields.inc
"""
import numpy as np
from scipy.integrate import quad

POINTS, WEIGHTS = np.polynomial.legendre.leggauss(48)


def across(z, inside):
    """[mass, first y, second xx, second yz] of the slice at a height; `inside`: half width in x at y."""
    low, high = inside.y_range(z)
    if high <= low:
        return np.zeros(4)
    # y = middle + half sin(u): ends of round slices are smooth in u
    middle, half = (low + high) / 2, (high - low) / 2
    u = np.pi / 2 * POINTS
    y = middle + half * np.sin(u)
    wy = WEIGHTS * np.pi / 2 * half * np.cos(u)
    total = np.zeros(4)
    for yk, wk in zip(y, wy):
        w = inside.x_half(yk, z)
        x = w * POINTS
        f = np.exp(-x * x - yk) * (2 + np.sin(3 * z)) * w * WEIGHTS
        total += wk * np.array([f.sum(), yk * f.sum(), (x * x * f).sum(), yk * z * f.sum()])
    return total


class Box:
    z_range = (-1.5, 1.5)
    breaks = []

    def y_range(self, z):
        return -1, 1

    def x_half(self, y, z):
        return 0.5


class Round:
    """Elliptic slices: radii by height."""

    def __init__(self, z_range, radii, breaks=()):
        self.z_range, self.radii, self.breaks = z_range, radii, list(breaks)

    def y_range(self, z):
        return -self.radii(z)[1], self.radii(z)[1]

    def x_half(self, y, z):
        a, b = self.radii(z)
        return a * np.sqrt(max(0, 1 - (y / b) ** 2))


R, r, L, H = 0.7, 0.3, 1.5, 2


def capsule(z):
    over = max(0, abs(z) - L / 2)
    radius = np.sqrt(max(0, R * R - over * over))
    return radius, radius


def ellipsoid(z):
    s = np.sqrt(max(0, 1 - (z / 0.5) ** 2))
    return s, 2 * s


def cone(z):
    radius = R * (0.75 * H - z) / H
    return radius, radius


def integral(solid):
    ends = [solid.z_range[0], *solid.breaks, solid.z_range[1]]
    return np.array([sum(quad(lambda z: across(z, solid)[k], a, b, epsabs=1e-14, epsrel=1e-13, limit=200)[0]
                         for a, b in zip(ends, ends[1:])) for k in range(4)])


rod, bore = (Round((-L / 2, L / 2), lambda z, a=a: (a, a)) for a in (R, r))
figures = {"box": integral(Box()), "tube": integral(rod) - integral(bore), "rod": integral(rod),
           "ellipsoid": integral(Round((-0.5, 0.5), ellipsoid)),
           "capsule": integral(Round((-L / 2 - R, L / 2 + R), capsule, (-L / 2, L / 2))),
           "cone": integral(Round((-H / 4, 3 * H / 4), cone))}
print("// SPDX-License-Identifier: BSD-3-Clause\n// Printed by primitive_fields.py.")
for name, values in figures.items():
    print(f'{{"{name}", ' + ", ".join(f"{v:.15g}" for v in values) + "},")
