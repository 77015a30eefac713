#!/usr/bin/python3 -B
# SPDX-License-Identifier: BSD-3-Clause
"""Makes pendulums.json: the double pendulums over their whole 80 s, in decimal arithmetic of 70 digits.

    make_pendulums.py        writes pendulums.json beside this file (about five minutes)

All three motions are chaotic: an error at the start grows by ten every two to five seconds, so neither
double nor 80-bit numbers know where the bodies are after 80 s. With 70 digits the loss does not matter.
Taylor series of order 82, their coefficients by recurrence, steps as long as the last coefficients allow; the
equations are those of angles (planar) and of point masses with tensions (spatial). Every motion is computed
twice, with 70 and with 60 digits; `gap` is the largest difference of the samples, before they are rounded.

Nothing is shared with livens, and nothing with make_reference.py but the equations on paper.
"""
import decimal
import json
import math
import operator
import pathlib
from decimal import Decimal

PENDULUM_MASSES = Decimal("1.5"), Decimal("0.768")   # kg: cubes with edges 1 and 0.8 m, density 1.5
ROD, EDGE, GRAVITY = 4, Decimal("0.8"), Decimal("9.81")
END, EVERY = 80, Decimal("0.1")   # s
# End point of the offset pendulum as printed; the last number is misprinted there as -71,878.
PRINTED = (0.0585, -0.0002, -3.9996), (-2.3571, 0.0002, -7.1878)


def product(a, b, k):
    """Coefficient k of the product of two series, of which k + 1 coefficients are known."""
    return sum(map(operator.mul, a[:k + 1], b[k::-1]), Decimal(0))


def planar(offset):
    """(start, series) of the pendulum in the x-z plane; state: sine, cosine and rate of three angles.

    The second cube hangs `offset` off its centre, towards -d1. Lagrange's equations:
    A_ij cos(a_i - a_j) a_j'' + A_ij sin(a_i - a_j) a_j'^2 + g_i cos a_i = 0.
    """
    m1, m2 = PENDULUM_MASSES
    arms = [[(m1 + m2) * ROD**2, m2 * ROD**2, m2 * ROD * offset],
            [m2 * ROD**2, m2 * ROD**2, m2 * ROD * offset],
            [m2 * ROD * offset, m2 * ROD * offset, m2 * EDGE**2 / 6 + m2 * offset**2]]
    weights = [GRAVITY * (m1 + m2) * ROD, GRAVITY * m2 * ROD, GRAVITY * m2 * offset]
    half = Decimal("0.5").sqrt()
    pairs = [(0, 1), (0, 2), (1, 2)]

    def series(state, order):
        s, c, w = ([[y] for y in state[3 * k:3 * k + 3]] for k in range(3))
        squares = [[] for _ in range(3)]
        sines, cosines = {pair: [] for pair in pairs}, {pair: [] for pair in pairs}
        accelerations = [[] for _ in range(3)]
        inverse = None
        for k in range(order):
            for i in range(3):
                squares[i].append(product(w[i], w[i], k))
            for i, j in pairs:
                sines[i, j].append(product(s[i], c[j], k) - product(c[i], s[j], k))
                cosines[i, j].append(product(c[i], c[j], k) + product(s[i], s[j], k))
            right = [-weights[i] * c[i][k] for i in range(3)]
            for i, j in pairs:
                right[i] -= arms[i][j] * product(sines[i, j], squares[j], k)
                right[j] += arms[i][j] * product(sines[i, j], squares[i], k)
                if k:   # of the matrix, all but its first coefficient
                    right[i] -= arms[i][j] * product(cosines[i, j][1:], accelerations[j], k - 1)
                    right[j] -= arms[i][j] * product(cosines[i, j][1:], accelerations[i], k - 1)
            if inverse is None:
                inverse = inverse3([[arms[i][j] * (1 if i == j else cosines[min(i, j), max(i, j)][0])
                                     for j in range(3)] for i in range(3)])
            for i in range(3):
                accelerations[i].append(sum(inverse[i][j] * right[j] for j in range(3)))
            for i in range(3):
                s[i].append(product(c[i], w[i], k) / (k + 1))
                c[i].append(-product(s[i][:k + 1], w[i], k) / (k + 1))
                w[i].append(accelerations[i][k] / (k + 1))
        return s + c + w

    def positions(state):
        s, c = state[0:3], state[3:6]
        return [ROD * c[0], 0, ROD * s[0], ROD * (c[0] + c[1]), 0, ROD * (s[0] + s[1])]

    return [half, half, Decimal(0), half, half, Decimal(1)] + [Decimal(0)] * 3, series, positions


def inverse3(A):
    """Inverse of a symmetric 3 x 3 matrix by cofactors."""
    cofactor = [[A[(i + 1) % 3][(j + 1) % 3] * A[(i + 2) % 3][(j + 2) % 3]
                 - A[(i + 1) % 3][(j + 2) % 3] * A[(i + 2) % 3][(j + 1) % 3] for j in range(3)]
                for i in range(3)]
    determinant = sum(A[0][j] * cofactor[0][j] for j in range(3))
    return [[cofactor[j][i] / determinant for j in range(3)] for i in range(3)]


def spatial():
    """(start, series) of two point masses on rods, set off sideways with (0, 1, 0); state: x1, x2, v1, v2.

    With tensions s of the upper and u of the lower rod by length: x1'' = g - s x1 / m1 + u r / m1,
    x2'' = g - u r / m2, r = x2 - x1, and x1 . x1'' + v1^2 = 0, r . r'' + (v2 - v1)^2 = 0. The squares of the
    lengths are constants.
    """
    m1, m2 = PENDULUM_MASSES
    a, c = ROD**2 / m1, ROD**2 * (1 / m1 + 1 / m2)
    k0 = ROD * Decimal("0.5").sqrt()

    def series(state, order):
        x, v = [[y] for y in state[:6]], [[y] for y in state[6:]]
        r, w = [[] for _ in range(3)], [[] for _ in range(3)]
        b, f1, f2, determinant, s, u = [], [], [], [], [], []
        for k in range(order):
            for i in range(3):
                r[i].append(x[i + 3][k] - x[i][k])
                w[i].append(v[i + 3][k] - v[i][k])
            b.append(sum(product(x[i], r[i], k) for i in range(3)) / m1)
            f1.append(sum(product(v[i], v[i], k) for i in range(3)) - GRAVITY * x[2][k])
            f2.append(sum(product(w[i], w[i], k) for i in range(3)))
            determinant.append((a * c if k == 0 else 0) - product(b, b, k))
            # s det = f1 c + f2 b,  u det = f2 a + f1 b
            for quotient, above in ((s, f1[k] * c + product(f2, b, k)), (u, f2[k] * a + product(f1, b, k))):
                if k:
                    above -= product(determinant[1:], quotient, k - 1)
                quotient.append(above / determinant[0])
            for i in range(3):
                fall = -GRAVITY if i == 2 and k == 0 else 0
                pull = product(u, r[i], k)
                upper = fall + (pull - product(s, x[i], k)) / m1
                lower = fall - pull / m2
                x[i].append(v[i][k] / (k + 1))
                x[i + 3].append(v[i + 3][k] / (k + 1))
                v[i].append(upper / (k + 1))
                v[i + 3].append(lower / (k + 1))
        return x + v

    start = [k0, 0, k0, 2 * k0, 0, 2 * k0, 0, 1, 0, 0, 1, 0]
    return [Decimal(y) for y in start], series, lambda state: state[:6]


def value(coefficients, t):
    """Horner's rule."""
    total = coefficients[-1]
    for coefficient in reversed(coefficients[:-1]):
        total = total * t + coefficient
    return total


def closest(series, positions, length, target):
    """(distance, t in the step) of the samples, every ms, where the two bodies come closest to `target`.

    The distance is that of the body which is farther off. Done in doubles, which is enough for a distance.
    """
    rows = [[float(y) for y in row] for row in series]
    best = (float("inf"), 0.0)
    n = max(1, round(float(length) * 1000))
    for j in range(n):
        t = float(length) * j / n
        x = [float(y) for y in positions([value(row, t) for row in rows])]
        distance = max(math.dist(x[3 * k:3 * k + 3], target[k]) for k in range(2))
        best = min(best, (distance, t))
    return best


def integrate(problem, digits, order, target=None):
    """(positions at 0, EVERY, .., END; closest approach to `target` as (distance, t))."""
    with decimal.localcontext() as context:
        context.prec = digits
        accuracy = Decimal(10) ** (3 - digits)   # of a step; the last three digits are left to rounding
        state, series, positions = problem()
        t, samples, wanted, best = Decimal(0), [positions(state)], EVERY, (float("inf"), 0.0)
        while t < END:
            rows = series(state, order)
            tails = {k: max(abs(row[k]) for row in rows) for k in (order - 1, order)}
            step = min((accuracy / tail) ** (1 / Decimal(k)) for k, tail in tails.items() if tail)
            step = min(step, END - t)
            while wanted <= t + step:
                samples.append(positions([value(row, wanted - t) for row in rows]))
                wanted += EVERY
            if target:
                distance, inside = closest(rows, positions, step, target)
                best = min(best, (distance, float(t) + inside))
            state = [value(row, step) for row in rows]
            t += step
        return samples, best


def case(problem, target=None):
    """One motion as it is written."""
    samples, best = integrate(problem, 70, 82, target)
    other, _ = integrate(problem, 60, 70)
    gap = max(abs(x - y) for row, row2 in zip(samples, other) for x, y in zip(row, row2))
    entry = {"gap": float(gap), "every": float(EVERY)}
    if target:
        entry |= {"closest_to_printed_end": {"distance": round(best[0], 6), "t": round(best[1], 3)}}
    for name, columns in (("position_1", slice(0, 3)), ("position_2", slice(3, 6))):
        entry[name] = [[round(float(x), 13) for x in row[columns]] for row in samples]
    return entry


def main():
    cases = {"double_pendulum_centred": case(lambda: planar(Decimal(0))),
             "double_pendulum_offset": case(lambda: planar(Decimal("0.1")), PRINTED),
             "double_pendulum_spatial": case(spatial)}
    text = ",\n".join(f' "{name}": {json.dumps(entry)}' for name, entry in cases.items())
    path = pathlib.Path(__file__).with_name("pendulums.json")
    made_by = "make_pendulums.py: Taylor series in decimal arithmetic of 70 digits"
    path.write_text(f'{{\n "made_by": "{made_by}",\n{text}\n}}\n', encoding="utf-8")
    for name, entry in cases.items():
        print(name, {key: item for key, item in entry.items() if not key.startswith("position")})


if __name__ == "__main__":
    main()
