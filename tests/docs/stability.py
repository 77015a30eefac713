# SPDX-License-Identifier: BSD-3-Clause
"""Limits of stability that docs/theory.md states ("Why two rules"), from the rows of one linear vibration; figures.py calls this.

An element of lobatto(p) from x0 to xp with the momentum at its ends: (k - (h omega)^2 (s G + (1 - s) W)) x = h (-P0, 0, .., Pp), where k is
the integral of products of slopes, G that of products of the functions by the p Gauss points, where loads act, and W the weights of the
p + 1 nodes, where multipliers act; s is the share of the stiffness that loads bring. Inner nodes eliminated leave [[a, b], [b, a]]: the map
from one end to the other has the trace -2 a / b, and its radius exceeds 1 where |a| > |b|. s = 0: loads at nodes, the pair IIIA-IIIB.
Nothing of this is livens' code. Standard library only.

"Springs that turn" of the same page: collocation of x'' = -(omega^2 d d^T + beta^2 t t^T) x in a plane, d and t at right angles and
turned by a = spin h within an element, where beta keeps a steady turning of the elements' own (R(i beta h) = exp(i a)). In axes that turn along an
element is one 4 x 4 matrix, of which the spectral radius is taken. "python3 stability.py" prints what is found of it.
"""
import cmath
import functools
import functools
import math
import re

PAGE = "docs/theory.md"
STEP, LAST = 5e-4, 13.0    # of h omega
FAST = 1e-2                # growth an element from which a vibration is called unstable
STATED = [(0.0, r"exceeds 1.01 from $h \omega = («»)$, («»), («»), («») $(p = 1, 2, 3, 4)$"),
          (0.5, r"a hundredth an element from $h \omega = («»)$, («»), («»), («»), («»), («») on for $p = 1$, 2, 3, 4, 6, 8")]
DEGREES = (1, 2, 3, 4, 6, 8)
RESONANCES = "From $p = 4$ on there are resonances before, at multiples of $\\pi$: intervals of $h \\omega$ narrower than («»), in which they " \
             "grow by less than («») an element"


def legendre(n, x):
    """P_n and its derivative; |x| < 1."""
    before, now = 1.0, x
    for k in range(2, n + 1):
        before, now = now, ((2 * k - 1) * x * now - (k - 1) * before) / k
    return now, n * (x * now - before) / (x * x - 1)


def root(f, low, high):
    for _ in range(200):
        middle = (low + high) / 2
        low, high = (middle, high) if f(low) * f(middle) > 0 else (low, middle)
    return (low + high) / 2


def roots(f, n):
    """n roots in (-1, 1), none two of which are nearer than a grid."""
    grid = [-math.cos(math.pi * (k + 0.5) / (40 * n)) for k in range(40 * n)]
    found = [root(f, a, b) for a, b in zip(grid, grid[1:]) if f(a) * f(b) <= 0]
    assert len(found) == n
    return found


def rules(p):
    """Nodes and weights on [0, 1]: Gauss-Lobatto with p + 1 points, Gauss with p."""
    inner = roots(lambda x: legendre(p, x)[1], p - 1) if p > 1 else []
    ends = [2 / (p * (p + 1))]
    weights = ends + [2 / (p * (p + 1) * legendre(p, x)[0] ** 2) for x in inner] + ends
    gauss = roots(lambda x: legendre(p, x)[0], p) if p > 1 else [0.0]
    gauss_weights = [2 / ((1 - x * x) * legendre(p, x)[1] ** 2) if p > 1 else 2.0 for x in gauss]
    half = lambda xs: [(x + 1) / 2 for x in xs]   # noqa: E731
    return half([-1.0, *inner, 1.0]), [w / 2 for w in weights], half(gauss), [w / 2 for w in gauss_weights]


def functions(nodes, x):
    """Values and slopes at x of the Lagrange functions of the nodes."""
    values, slopes = [], []
    for a, s in enumerate(nodes):
        others = [t for b, t in enumerate(nodes) if b != a]
        values.append(math.prod((x - t) / (s - t) for t in others))
        slopes.append(sum(math.prod((x - t) / (s - t) for j, t in enumerate(others) if j != i) / (s - u)
                          for i, u in enumerate(others)))
    return values, slopes


def matrices(p):
    nodes, weights, gauss, gauss_weights = rules(p)
    at = [(w, *functions(nodes, x)) for x, w in zip(gauss, gauss_weights)]
    every = range(p + 1)
    k = [[sum(w * D[a] * D[b] for w, _, D in at) for b in every] for a in every]
    loads = [[sum(w * N[a] * N[b] for w, N, _ in at) for b in every] for a in every]
    return k, loads, [[weights[a] if a == b else 0.0 for b in every] for a in every]


def growth(k, loads, joints, share, z):
    """An element, of the faster of both solutions; 0 where both keep their size."""
    p = len(k) - 1
    order = [*range(1, p), 0, p]   # inner nodes first: what is left of elimination is the rest
    S = [[k[a][b] - z * z * (share * loads[a][b] + (1 - share) * joints[a][b]) for b in order] for a in order]
    for i in range(p - 1):
        for r in range(i + 1, p + 1):
            part = S[r][i] / S[i][i]
            S[r] = [x - part * y for x, y in zip(S[r], S[i])]
    half = abs((S[p - 1][p - 1] + S[p][p]) / 2 / S[p - 1][p])
    return half + math.sqrt(half * half - 1) - 1 if half > 1 + 1e-10 else 0.0


@functools.cache
def unstable(share, p):
    """Intervals of h omega below LAST that grow, up to the first fast one: (from where, how long, growth)."""
    parts, found, last = matrices(p), [], None
    for n in range(1, int(LAST / STEP)):
        z = n * STEP
        rate = growth(*parts, share, z)
        if rate == 0:
            last = None
            continue
        if last is None:
            last = [z, 0.0, rate]
            found.append(last)
        last[1:] = z - last[0] + STEP, max(last[2], rate)
        if rate > FAST:
            break
    return found


def check_stability(d):
    text = " ".join(d.texts[PAGE].split())
    for share, words in STATED:
        found = re.search(re.escape(words).replace(re.escape("(«»)"), r"(\d+\.\d)"), text)
        d.holds(found is not None, f"{PAGE} should say: {words}")
        for p, stated in zip(DEGREES, found.groups() if found else ()):
            *slow, fast = unstable(share, p)
            limit = next(z for z in (fast[0] + n * STEP for n in range(1000)) if growth(*matrices(p), share, z) > FAST)
            d.holds(abs(float(stated) - limit) <= 0.0501, f"{PAGE}: stable up to {stated} with degree {p}, by its rows {limit:.3f}")
            d.holds(p < 4 or slow or share == 0, f"{PAGE}: no resonance before {stated} with degree {p}")
    found = re.search(re.escape(RESONANCES).replace(re.escape("(«»)"), r"([\d.]*\d)"), text)
    d.holds(found is not None, f"{PAGE} should say: {RESONANCES}")
    width, rate = map(float, found.groups()) if found else (0, 0)
    for p in DEGREES:
        for z, long, fast in unstable(0.5, p)[:-1]:
            away = abs(z / math.pi - round(z / math.pi)) * math.pi
            d.holds(p >= 4 and long < width and fast < rate and away < width, f"{PAGE}: a resonance at {z:.4f} with degree {p}, {long:.4f} long, growth {fast:.4f}")


TURNING = {1: 4.0, 2: 12.0, 3: 21.9, 4: 33.5, 5: 46.5, 6: 60.8, 7: 76.3, 8: 93.0}
TURNING_WORDS = "more than $\\sqrt{8 p (p + 1)(2p - 1)} = 4.0$, 12.0, 21.9, 33.5, 46.5, 60.8, 76.3, 93.0 $(p = 1 \\dots 8)$"
TURNING_LAW = "\\sqrt{\\frac{p (p + 1)}{2 (2p - 1)}\\, \\alpha^2 - \\Bigl( \\frac{2 p (p + 1)}{h \\omega} \\Bigr)^2}"
TURNING_RADAU = "radau's do not, by more than («») an element for spins up to $h$ spin $= 0.3$ from $p = 3$ on"


def solved(A, B):
    """A^-1 B, by elimination with row exchanges."""
    n, rows = len(A), [[*a, *b] for a, b in zip(A, B)]
    for i in range(n):
        k = max(range(i, n), key=lambda r: abs(rows[r][i]))
        rows[i], rows[k] = rows[k], rows[i]
        rows[i] = [x / rows[i][i] for x in rows[i]]
        for r in range(n):
            if r != i and rows[r][i] != 0:
                rows[r] = [x - rows[r][i] * y for x, y in zip(rows[r], rows[i])]
    return [row[n:] for row in rows]


def product(A, B):
    return [[sum(a * b for a, b in zip(row, column)) for column in zip(*B)] for row in A]


@functools.cache
def collocation(p, points):
    """Points and the integrals of their Lagrange functions up to each of them and up to 1."""
    if points == "gauss":
        c = rules(p)[2]
    else:
        c = [(x + 1) / 2 for x in roots(lambda x: legendre(p, x)[0] - (legendre(p - 1, x)[0] if p > 1 else 1.0), p - 1)] + [1.0] if p > 1 else [1.0]
    at, weights = rules(p)[2:]
    upto = lambda end: [end * sum(w * functions(c, end * x)[0][j] for x, w in zip(at, weights)) for j in range(p)]   # noqa: E731
    return c, [upto(x) for x in c], upto(1.0)


def quotient_phase(p, y):
    """Of Gauss collocation: R(i y) = exp(i phase)."""
    c, A, b = collocation(p, "gauss")
    k = solved([[(i == j) - 1j * y * A[i][j] for j in range(p)] for i in range(p)], [[1.0]] * p)
    return cmath.phase(1 + 1j * y * sum(w * x[0] for w, x in zip(b, k)))


def turning_map(p, points, a, z):
    """An element on (x, h x'), in axes that turn by a."""
    c, A, b = collocation(p, points)
    beta = root(lambda y: quotient_phase(p, y) - a, 0.0, min(2 * a, 2.5)) if points == "gauss" else a
    stiffness = []
    for x in c:
        d, t = (math.cos(a * x), math.sin(a * x)), (-math.sin(a * x), math.cos(a * x))
        stiffness.append([[z * z * d[i] * d[j] + beta * beta * t[i] * t[j] for j in (0, 1)] for i in (0, 1)])
    AA, bA = product(A, A), product([b], A)[0]
    system = [[float(m == n) + AA[m // 2][n // 2] * stiffness[n // 2][m % 2][n % 2] for n in range(2 * p)] for m in range(2 * p)]
    right = [[float(m % 2 == n) for n in (0, 1)] + [c[m // 2] * (m % 2 == n) for n in (0, 1)] for m in range(2 * p)]
    Y = solved(system, right)
    f = [[-sum(stiffness[i][k][l] * Y[2 * i + l][n] for l in (0, 1)) for n in range(4)] for i in range(p) for k in (0, 1)]
    end = [[float(k == n) + float(k + 2 == n) + sum(bA[i] * f[2 * i + k][n] for i in range(p)) for n in range(4)] for k in (0, 1)] \
        + [[float(k + 2 == n) + sum(b[i] * f[2 * i + k][n] for i in range(p)) for n in range(4)] for k in (0, 1)]
    back = [[math.cos(a), math.sin(a)], [-math.sin(a), math.cos(a)]]
    return [[sum(back[m % 2][k] * end[2 * (m // 2) + k][n] for k in (0, 1)) for n in range(4)] for m in range(4)]


@functools.lru_cache(maxsize=None)
def turning_growth(p, a, z, points="gauss"):
    """An element; of Gauss points, whose map is symplectic, from its two invariants, else by squaring."""
    M = turning_map(p, points, a, z)
    if points != "gauss":
        size = 0.0
        for k in range(24):   # M^(2^k), scaled
            largest = max(abs(x) for row in M for x in row)
            size += math.log(largest) / 2 ** k
            M = [[x / largest for x in row] for row in M]
            M = product(M, M)
        return math.exp(size + math.log(max(abs(x) for row in M for x in row)) / 2 ** 24) - 1
    trace, squares = sum(M[i][i] for i in range(4)), sum(M[i][k] * M[k][i] for i in range(4) for k in range(4))
    spread = cmath.sqrt(trace * trace / 4 - ((trace * trace - squares) / 2 - 2))
    largest = 0.0
    for s in (trace / 2 + spread, trace / 2 - spread):   # s = l + 1 / l
        r = cmath.sqrt(s * s / 4 - 1)
        largest = max(largest, abs(s / 2 + r), abs(s / 2 - r))
    return largest - 1


def law(p, a, z):
    square = p * (p + 1) / (2 * (2 * p - 1)) * a * a - (2 * p * (p + 1) / z) ** 2
    return math.sqrt(square) if square > 0 else 0.0


def bound(p):
    return math.sqrt(8 * p * (p + 1) * (2 * p - 1))


def check_turning(d):
    text = " ".join(d.texts[PAGE].split())
    for words in (TURNING_WORDS, TURNING_LAW):
        d.holds(words in text, f"{PAGE} should say: {words}")
    found = re.search(re.escape(TURNING_RADAU).replace(re.escape("(«»)"), r"([\d.]*\d)"), text)
    d.holds(found is not None, f"{PAGE} should say: {TURNING_RADAU}")
    for p, stated in TURNING.items():
        d.holds(abs(stated - bound(p)) <= 0.0501, f"{PAGE}: the bound of degree {p} is {bound(p):.2f}")
        for a in (0.03, 0.1, 0.3):
            for times in (1.1, 1.5, 3.0, 10.0):
                z = times * bound(p) / a
                ratio = turning_growth(p, a, z) / law(p, a, z)
                d.holds(0.9 < ratio < 1.4, f"{PAGE}: degree {p}, turn {a}, h omega {z:.1f}: growth is {ratio:.3f} times the law's")
            for times in (0.4, 0.7, 0.9):
                grown = turning_growth(p, a, times * bound(p) / a)
                d.holds(grown < 1e-4, f"{PAGE}: degree {p}, turn {a}: grows by {grown:.1e} an element at {times} of the bound")
            for z in (3.0, 30.0, 300.0, 3000.0) if p >= 3 and found else ():
                grown = turning_growth(p, a, z, "radau")
                d.holds(grown < float(found[1]), f"{PAGE}: radau({p}) grows by {grown:.1e} an element, turn {a}, h omega {z}")


STALE = [(PAGE, r"2\.8, 3\.1, 6\.1 \$\(p", "2.8, 3.1, 6.3 $(p"), (PAGE, r"6\.3, 9\.4, 12\.6 on", "6.3, 9.4, 13.6 on"), (PAGE, r"narrower than 0\.01", "narrower than 0.001"),
         (PAGE, r"21\.9, 33\.5", "21.9, 34.5"), (PAGE, r"by more than 0\.001 an element for spins", "by more than 0.00001 an element for spins")]


if __name__ == "__main__":
    for p in TURNING:
        print(f"degree {p}: bound {bound(p):.2f}")
        for a in (0.03, 0.1, 0.3):
            print(f"  turn {a}: " + ", ".join(f"{times} of it {turning_growth(p, a, times * bound(p) / a):.1e} (law {law(p, a, times * bound(p) / a):.1e}; "
                                             f"radau {turning_growth(p, a, times * bound(p) / a, 'radau'):.1e})" for times in (0.7, 0.9, 1.1, 3.0, 10.0)))
