# SPDX-License-Identifier: BSD-3-Clause
"""Limits of stability that docs/theory.md states ("Why two rules"), from the rows of one linear vibration; figures.py calls this.

An element of lobatto(p) from x0 to xp with the momentum at its ends: (k - (h omega)^2 (s G + (1 - s) W)) x = h (-P0, 0, .., Pp), where k is
the integral of products of slopes, G that of products of the functions by the p Gauss points, where loads act, and W the weights of the
p + 1 nodes, where multipliers act; s is the share of the stiffness that loads bring. Inner nodes eliminated leave [[a, b], [b, a]]: the map
from one end to the other has the trace -2 a / b, and its radius exceeds 1 where |a| > |b|. s = 0: loads at nodes, the pair IIIA-IIIB.
Nothing of this is livens' code. Standard library only.
"""
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


STALE = [(PAGE, r"2\.8, 3\.1, 6\.1 \$\(p", "2.8, 3.1, 6.3 $(p"), (PAGE, r"6\.3, 9\.4, 12\.6 on", "6.3, 9.4, 13.6 on"), (PAGE, r"narrower than 0\.01", "narrower than 0.001")]
