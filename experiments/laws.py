# SPDX-License-Identifier: BSD-3-Clause
"""True motions of one coordinate under laws that are sharp, bend or jump; shares nothing with livens.

x'' = f(t, x, v), where f is analytic piece by piece: abs, max, min, rows of tables, ends of curves are
switches, each a quantity with borders, and on which piece of each the motion is, is a state of its own. A
step is a polynomial for x'' on Chebyshev points in numbers of 64 bits of mantissa, found by Newton's
iteration with the law of the pieces at its start, which goes on analytically beyond them; a step is as long
as the last coefficients are rounding, and ends where it first meets a border, which is found on the
polynomial itself, grazed ones where it comes nearest. Narrow places of a law that is smooth (pulses, steps
of tanh) have borders, too, at which only steps end, so that none is passed over.

    motion = laws.march(law, x, v, end)             # law: see Law
    motion.error              # how far a march of lower degree and tolerance is off, m or rad
    x = motion.coordinate(times)
"""
import ast

import numpy as np

import truth

REAL = truth.REAL
MOST_ITERATIONS = 30


class NoTruth(Exception):
    """The motion could not be found as well as it is needed."""


def real(x):
    return np.array(x, dtype=REAL)


# ---------------------------------------------------------------- laws of expressions

FUNCTIONS = {"sin": np.sin, "cos": np.cos, "tan": np.tan, "tanh": np.tanh, "exp": np.exp, "log": np.log,
             "sqrt": np.sqrt, "atan2": np.arctan2}


class Expression:
    """A formula of livens by names, on one piece of each of its abs, max and min.

    switches   functions (names, pieces) -> quantity, whose only border is 0
    pieces     0 below, 1 above, of each
    A quotient (e)/abs(e) is the sign of the piece, so that it has a value at the border itself.
    """

    def __init__(self, text):
        self.switches, self.known = [], {}
        self.value = self.of(ast.parse(text.replace("^", "**"), mode="eval").body)

    def switch(self, quantity, node):
        """Its number; one that stands twice is one."""
        key = ast.dump(node)
        if key not in self.known:
            self.known[key] = len(self.switches)
            self.switches.append(quantity)
        return self.known[key]

    def of(self, node):
        match node:
            case ast.Constant(value=number):
                number = REAL(number)
                return lambda names, pieces: number
            case ast.Name(id="pi"):
                pi = 4 * np.arctan(REAL(1))
                return lambda names, pieces: pi
            case ast.Name(id=name):
                return lambda names, pieces: names[name]
            case ast.UnaryOp(op=ast.USub(), operand=operand):
                one = self.of(operand)
                return lambda names, pieces: -one(names, pieces)
            case ast.BinOp(left=left, op=ast.Div(), right=ast.Call(func=ast.Name(id="abs"), args=[inner])) \
                    if ast.dump(left) == ast.dump(inner):
                k = self.switch(self.of(inner), inner)
                return lambda names, pieces: REAL(1 if pieces[k] else -1)
            case ast.BinOp(left=left, op=op, right=right):
                return self.binary(op, self.of(left), self.of(right))
            case ast.Call(func=ast.Name(id=name), args=arguments):
                return self.call(name, arguments)
        raise AssertionError(f"not read here: {ast.unparse(node)}")

    def binary(self, op, a, b):
        match op:
            case ast.Add():
                return lambda names, pieces: a(names, pieces) + b(names, pieces)
            case ast.Sub():
                return lambda names, pieces: a(names, pieces) - b(names, pieces)
            case ast.Mult():
                return lambda names, pieces: a(names, pieces) * b(names, pieces)
            case ast.Div():
                return lambda names, pieces: a(names, pieces) / b(names, pieces)
            case ast.Pow():
                return lambda names, pieces: a(names, pieces) ** int(b(names, pieces))
        raise AssertionError("not read here: an operation")

    def call(self, name, arguments):
        parts = [self.of(argument) for argument in arguments]
        a, b = parts[0], parts[-1]
        if name == "abs":
            k = self.switch(a, arguments[0])
            return lambda names, pieces: a(names, pieces) if pieces[k] else -a(names, pieces)
        if name in ("max", "min"):
            k = self.switch(lambda names, pieces: a(names, pieces) - b(names, pieces),
                            ast.BinOp(arguments[0], ast.Sub(), arguments[1]))
            first = 1 if name == "max" else 0
            return lambda names, pieces: (a if pieces[k] == first else b)(names, pieces)
        function = FUNCTIONS[name]
        return lambda names, pieces: function(*(part(names, pieces) for part in parts))


class Table:
    """Rows of one quantity over another, by cubics or straight lines, straight on beyond the ends."""

    def __init__(self, places, values, spline):
        self.borders, values = real(places), real(values)
        h = np.diff(self.borders)
        bends = np.zeros(len(values), REAL)
        if spline:
            bends = truth.Spline(self.borders, values[:, None]).bends[:, 0]
        rise = np.diff(values) / h
        # value, slope, half the bend, a sixth of the third derivative at the beginning of each piece
        cubics = [(values[i], rise[i] - h[i] * (2 * bends[i] + bends[i + 1]) / 6, bends[i] / 2,
                   (bends[i + 1] - bends[i]) / (6 * h[i])) for i in range(len(h))]
        end = cubics[-1][1] + h[-1] * (2 * cubics[-1][2] + 3 * h[-1] * cubics[-1][3])
        zero = REAL(0)
        self.cubics = [(values[0], cubics[0][1], zero, zero), *cubics, (values[-1], end, zero, zero)]
        self.begins = np.concatenate([self.borders[:1], self.borders])

    def at(self, x, piece):
        a, b, c, d = self.cubics[piece]
        s = x - self.begins[piece]
        return a + s * (b + s * (c + s * d))


class Law:
    """x'' of t, x, v.

    terms    functions (t, x, v, pieces) -> force, with the pieces of their own switches
    mass     what x'' is multiplied by
    breaks   instants at which steps end
    sharp    (quantity "t", "x" or "v", centre, width): narrow places of a law that is smooth
    """
    PLACES = (-8, -3, -1, 0, 1, 3, 8)   # widths from the centre, where steps end

    def __init__(self, mass, breaks=(), sharp=()):
        self.mass, self.terms = REAL(mass), []
        self.switches, self.borders = [], []   # functions (t, x, v, pieces); ascending borders of each
        self.breaks = sorted({*breaks, *(centre + k * width for what, centre, width in sharp if what == "t"
                                         for k in self.PLACES)})
        for name, index in (("x", 1), ("v", 2)):
            borders = sorted({REAL(centre) + k * REAL(width) for what, centre, width in sharp if what == name
                              for k in self.PLACES})
            if borders:
                self.switches.append(lambda *state, index=index: state[index])
                self.borders.append(real(borders))

    def add(self, text, **names):
        """A formula of t, x, v; names: numbers, or functions (t, x, v)."""
        formula, first = Expression(text), len(self.switches)
        last = first + len(formula.switches)

        def bound(t, x, v):
            return {"t": t, "x": x, "v": v} | {key: f(t, x, v) for key, f in names.items()}
        for quantity in formula.switches:
            self.switches.append(lambda t, x, v, pieces, q=quantity:
                                 q(bound(t, x, v), pieces[first:last]) + 0 * x)
            self.borders.append(real([0]))
        self.terms.append(lambda t, x, v, pieces: formula.value(bound(t, x, v), pieces[first:last]))
        return self

    def add_table(self, table, elongation=lambda x: x, share=lambda x: -1):
        """A force by a table over an elongation, times what of it acts along x."""
        k = len(self.switches)
        self.switches.append(lambda t, x, v, pieces: elongation(x))
        self.borders.append(table.borders)
        self.terms.append(lambda t, x, v, pieces: share(x) * table.at(elongation(x), pieces[k]))
        return self

    def acceleration(self, t, x, v, pieces):
        return sum(term(t, x, v, pieces) for term in self.terms) / self.mass + 0 * x

    def pieces(self, t, x, v):
        """Of a state; a quantity on a border goes to the side that it moves to, as x does."""
        found = []
        for quantity, borders in zip(self.switches, self.borders):
            at = float(quantity(t, x, v, [0] * len(self.switches)))   # none depends on another's piece
            later = float(quantity(t, x + REAL(1e-9) * np.sign(v), v, [0] * len(self.switches)))
            found.append(int(np.searchsorted(borders, at + REAL(1e-6) * (later - at))))
        return found


class Wire(Law):
    """A bead on a cubic spline by lengths of chords (docs/joints.md), straight on beyond ends of an open one.

    x is the length of the chords until there; weight: acceleration of free fall.
    """
    ROUNDS = 12

    def __init__(self, points, closed=False, weight=(0, 0, 0)):
        super().__init__(1)
        points = real(points)
        self.weight, self.closed, n = real(weight), closed, len(points)
        around = np.concatenate([points, points[:1]]) if closed else points
        chords = np.sqrt((np.diff(around, axis=0) ** 2).sum(-1))
        lengths = np.concatenate([[0], np.cumsum(chords)])
        if closed:
            bends = periodic_bends(points, chords)
            self.components = [(around, np.concatenate([bends, bends[:1]]))]
        else:
            self.components = [(points, truth.Spline(lengths, points).bends)]
        self.knots = lengths
        self.round = lengths[-1]
        borders = np.concatenate([lengths[:-1] + k * self.round for k in range(-self.ROUNDS, self.ROUNDS)]) \
            if closed else lengths
        self.switches, self.borders = [lambda t, x, v, pieces: x], [borders]
        self.terms = [lambda t, x, v, pieces: self.along(x, v, pieces[0])]

    def shape(self, x, piece):
        """Place, first and second derivative on a piece, (..., 3)."""
        (points, bends), = self.components
        n = len(points) - 1
        if self.closed:
            turns, k = divmod(piece - 1, n)
            x = x - (turns - self.ROUNDS) * self.round
        else:
            k = piece - 1
        inside = min(max(k, 0), n - 1)
        h = self.knots[inside + 1] - self.knots[inside]
        at = self.knots[inside]
        s = np.asarray(x - at)[..., None] if 0 <= k < n else (REAL(0) if k < 0 else h)
        p, q, a, b = points[inside], points[inside + 1], bends[inside], bends[inside + 1]
        first = (q - p) / h - h * (2 * a + b) / 6
        place = p + s * (first + s * (a / 2 + s * (b - a) / (6 * h)))
        slope = first + s * (a + s * (b - a) / (2 * h))
        bend = a + s * (b - a) / h
        if not 0 <= k < n:   # straight on
            place = place + np.asarray(x - self.knots[0 if k < 0 else -1])[..., None] * slope
            slope, bend = slope + 0 * place, 0 * place
        return place, slope, bend

    def along(self, x, v, piece):
        _, slope, bend = self.shape(x, piece)
        return (slope @ self.weight - (slope * bend).sum(-1) * v * v) / (slope * slope).sum(-1)

    def places(self, x):
        """Points of the curve, (x, 3)."""
        found = np.searchsorted(self.borders[0], x)
        where = np.empty((len(x), 3), REAL)
        for piece in np.unique(found):
            where[found == piece] = self.shape(x[found == piece], int(piece))[0]
        return where

    def by_length(self, x, speed, times):
        """x at instants for a bead that keeps its speed: the length of the curve by quadrature, inverted."""
        gauss, weights = np.polynomial.legendre.leggauss(60)
        gauss, weights = refined_gauss(real(gauss), real(weights))

        def length(a, b, piece):
            s = a + (b - a) * (1 + gauss[:, None]) / 2
            slope = self.shape(s, piece)[1]
            return (b - a) / 2 * (weights[:, None] * np.sqrt((slope * slope).sum(-1))).sum(0)
        sign = 1 if speed > 0 else -1
        borders = np.array([b for b in self.borders[0] if (b - x) * sign > 0], REAL)[::sign]
        piece = int(np.searchsorted(self.borders[0], x + sign * REAL(1e-9)))
        found, left, at = np.empty(len(times), REAL), abs(REAL(speed)) * real(times), REAL(x)
        todo = np.ones(len(times), bool)
        for border in [*borders, None]:
            if border is not None:
                whole = abs(length(real([at]), real([border]), piece)[0])
                mine = todo & (left <= whole)
            else:
                mine = todo
            u = at + sign * left[mine]
            for _ in range(50 if mine.any() else 0):
                slope = self.shape(u, piece)[1]
                off = (sign * length(at + 0 * u, u, piece) - left[mine]) / np.sqrt((slope * slope).sum(-1))
                u = u - sign * off
                if np.abs(off).max() < 1e-17:
                    break
            found[mine] = u
            todo &= ~mine
            if border is None or not todo.any():
                return found
            left, at, piece = left - whole, border, piece + sign
        return found


def refined_gauss(points, weights):
    """Points and weights of Gauss to the last digit of REAL."""
    n = len(points)
    for _ in range(3):
        below, here = np.ones_like(points), points.copy()
        for k in range(2, n + 1):
            below, here = here, ((2 * k - 1) * points * here - (k - 1) * below) / k
        slope = n * (points * here - below) / (points * points - 1)
        points = points - here / slope
    return points, 2 / ((1 - points * points) * slope * slope)


def periodic_bends(points, chords):
    """Second derivatives of the closed spline through points; chords: to the next."""
    n = len(points)
    A, b = np.zeros((n, n), REAL), np.zeros((n, 3), REAL)
    for i in range(n):
        before, after = chords[i - 1], chords[i]
        A[i, i] += 2 * (before + after)
        A[i, i - 1] += before
        A[i, (i + 1) % n] += after
        b[i] = 6 * ((points[(i + 1) % n] - points[i]) / after - (points[i] - points[i - 1]) / before)
    return truth.solve(A[None], b[None])[0]


# ---------------------------------------------------------------- the march

class Points:
    """Tables of one degree: points of [0, 1], integrals once and twice, coefficients, looks for borders."""

    def __init__(self, n, real=real):
        self.n = n
        self.s, self.weights, self.coefficients, self.once = (table.astype(real([0]).dtype)
                                                              for table in truth.tables_of_pieces(n))
        self.twice = self.once @ self.once
        self.once_rough, self.twice_rough = self.once.astype(float), self.twice.astype(float)
        looks = (1 - np.cos(np.arange(1, 97) * np.pi / 96)) / 2
        self.looks = real(sorted({*(2.0**-k for k in range(12, 46)), *looks}))
        self.at_looks = self.interpolation(self.looks)

    def interpolation(self, s):
        apart = s[:, None] - self.s
        hit = apart == 0
        share = np.where(hit.any(axis=1)[:, None], hit, self.weights / np.where(hit, 1, apart))
        return share / share.sum(axis=1)[:, None]

    def at(self, values, s):
        """Of polynomials by values (node, k), at one s."""
        apart = s - self.s
        if (apart == 0).any():
            return values[int(np.argmax(apart == 0))]
        share = self.weights / apart
        return share @ values / share.sum()


class Motion:
    """Steps: begins (and the end), lengths of polynomials, values (step, node, (x, v)); x may be several."""

    def __init__(self, points, ends, lengths, values):
        self.points, self.ends, self.lengths, self.values = points, real(ends), lengths, values
        self.error = 0.0

    def coordinate(self, times):
        t = real(times)
        step = np.clip(np.searchsorted(self.ends, t, side="left") - 1, 0, len(self.values) - 1)
        n = self.values[0].shape[1] // 2
        found = np.empty((len(t), n), REAL)
        for k in np.unique(step):
            mine = step == k
            s = (t[mine] - self.ends[k]) / self.lengths[k]
            found[mine] = self.points.interpolation(s) @ self.values[k][:, :n]
        return found if self.several else found[:, 0]

    several = False


class March:
    """Steps of one degree to one tolerance."""
    POINTS_OF = {n: Points(n) for n in (32, 22)}
    MOST_STEPS = 12000
    NEAR = 2.0**-43   # of a step: nearer to a border that was just crossed nothing is known

    def __init__(self, law, n, tail):
        self.law, self.points, self.tail = law, self.POINTS_OF[n], tail

    def step(self, t, x, v, h, pieces, scales):
        """Values (node, (x, v)), and what reach() says of them; None: no solution."""
        law, P = self.law, self.points
        times = t + h * P.s
        try:
            a = np.zeros(P.n + 1, REAL) + law.acceleration(times[:1], real([x]), real([v]), pieces)
        except (FloatingPointError, OverflowError):
            return None
        last = np.inf
        for k in range(MOST_ITERATIONS):
            speed = v + h * (P.once @ a)
            place = x + h * v * P.s + h * h * (P.twice @ a)
            f = law.acceleration(times, place, speed, pieces)
            dx, dv = REAL(1e-9) * scales[0], REAL(1e-9) * scales[1]
            if k < 6:
                by_x = ((law.acceleration(times, place + dx, speed, pieces) - f) / dx).astype(float)
                by_v = ((law.acceleration(times, place, speed + dv, pieces) - f) / dv).astype(float)
                matrix = np.eye(P.n + 1) - float(h)**2 * by_x[:, None] * P.twice_rough \
                    - float(h) * by_v[:, None] * P.once_rough
            if not (np.isfinite(f).all() and np.isfinite(matrix).all()):
                return None
            try:
                correction = np.linalg.solve(matrix, (f - a).astype(float))
            except np.linalg.LinAlgError:
                return None
            a = a + correction
            change = max(float(h) * np.abs(P.once_rough @ correction).max() / scales[1],
                         float(h)**2 * np.abs(P.twice_rough @ correction).max() / scales[0])
            if change < 2e-19 or (change < 1e-15 and change > 0.2 * last):
                break
            if k > 5 and change > 0.5 * last:
                return None
            last = change
        else:
            return None
        values = np.stack([x + h * v * P.s + h * h * (P.twice @ a), v + h * (P.once @ a)], -1)
        return values, *self.reach(values, scales)

    def reach(self, values, scales):
        """The last coefficients by their bound, and by how much longer a step could be.

        Coefficients fall as powers of its length; from where on all are below the bound tells.
        """
        P = self.points
        sizes = (np.abs(P.coefficients @ values) / scales).max(axis=1).astype(float) / self.tail
        tail = sizes[-4:].max()
        above = int(np.max(np.nonzero(sizes > 1)[0], initial=2)) + 1
        return tail, 0.9 * self.tail ** (1 / (P.n - 2) - 1 / min(above, P.n - 2))

    @staticmethod
    def parts(values):
        """x and v of values (.., (x, v))."""
        return values[..., 0], values[..., 1]

    def border(self, t, h, values, pieces, crossed=None):
        """(s, switch, piece behind it, border) of the first border that a step meets, or None."""
        law, P, first = self.law, self.points, None
        there = P.at_looks @ values
        first_look = int(np.searchsorted(P.looks, self.NEAR))

        def crossing(number, border, sign, s_low, s_high):
            def beyond(s):
                x, v = self.parts(P.at(values, s))
                return float(sign * (law.switches[number](t + h * s, x, v, pieces) - border))
            return first_root(beyond, s_low, s_high)
        times = t + h * P.looks
        for number, (quantity, borders) in enumerate(zip(law.switches, law.borders)):
            q = quantity(times, *self.parts(there), pieces) + 0 * times
            piece = pieces[number]
            for border, sign, after in ((piece, 1, piece + 1), (piece - 1, -1, piece - 1)):
                if not 0 <= border < len(borders):
                    continue
                # a border that was just crossed is known to rounding alone
                late = first_look if crossed == (number, border) else 0
                def root(a, b, border=borders[border], sign=sign):
                    return crossing(number, border, sign, a, b)
                found = self.met(sign * (q - borders[border])[late:], late, root)
                if found is not None and (first is None or found < first[0]):
                    first = found, number, after, border
        return first

    def met(self, beyond, late, root):
        """First s at which what is below zero comes above it, also between two looks, where it comes near.

        beyond   at looks from number `late` on
        """
        looks = self.points.looks[late:]
        up = int(np.argmax(beyond > 0)) if (beyond > 0).any() else len(beyond)
        peaks = [k for k in range(1, min(up, len(beyond) - 1))
                 if beyond[k] >= beyond[k - 1] and beyond[k] >= beyond[k + 1] and
                 -beyond[k] < max(beyond[k] - beyond[k - 1], beyond[k] - beyond[k + 1])]
        for k in peaks:
            found = root(looks[k - 1], (looks[k], looks[k + 1]))
            if found is not None:
                return found
        if up == len(beyond):
            return None
        return root(looks[up - 1] if up else REAL(0) if not late else looks[0], looks[up])

    def __call__(self, x, v, end, longest):
        law, t = self.law, REAL(0)
        pieces = law.pieces(t, x, v)
        scales, crossed = self.larger(np.full(2, 1e-2), x, v), None
        stops = [REAL(b) for b in law.breaks if 0 < b < end] + [REAL(end)]
        ends, lengths, values, h = [t], [], [], REAL(longest) / 10
        tries = 0
        while t < end:
            tries += 1
            if tries > 4 * self.MOST_STEPS:
                raise NoTruth("too many tries")
            stop = next(b for b in stops if b > t)
            step = min(h, stop - t)
            with np.errstate(all="ignore"):
                found = self.step(t, x, v, step, pieces, scales)
            if found is None or found[1] > 1:
                h = step * REAL(0.4 if found is None else max(0.25, 0.9 * found[1] ** (-1 / self.points.n)))
                if h < 1e-13 * end:
                    raise NoTruth("steps vanish")
                continue
            here, _, longer = found
            met = self.border(t, step, here, pieces, crossed)
            share = REAL(1) if met is None else met[0]
            if share > 0:
                ends.append(stop if met is None and step == stop - t else t + share * step)
                lengths.append(step)
                values.append(here)
                if len(values) > self.MOST_STEPS:
                    raise NoTruth("too many steps")
            x, v = self.parts(here[-1] if met is None else self.points.at(here, share))
            t = ends[-1]
            h = min(step * REAL(min(longer, 2.5)), REAL(longest))
            scales = self.larger(scales, *self.parts(here))
            crossed = None
            if met is not None:
                crossed = met[1], met[3]
                pieces = [met[2] if k == met[1] else piece for k, piece in enumerate(pieces)]
        return Motion(self.points, ends, lengths, values)

    @staticmethod
    def larger(scales, x, v):
        return np.maximum(scales, [float(np.abs(x).max()), float(np.abs(v).max())])


def first_root(beyond, low, high):
    """Where beyond(s) rises above zero in [low, high]; high = (peak, high): None if not even at its peak."""
    if isinstance(high, tuple):
        a, m, b = (float(s) for s in (low, *high))
        for _ in range(60):   # golden section
            left, right = m - 0.381966 * (m - a), m + 0.381966 * (b - m)
            at = {s: beyond(REAL(s)) for s in (left, m, right)}
            best = max(at, key=at.get)
            if at[best] > 0:
                return first_root(beyond, low, REAL(best))
            a, b = (a, m) if best == left else (left, right) if best == m else (m, b)
            m = best
            if b - a < 1e-12:
                return None
        return None
    a, b = REAL(low), REAL(high)
    below, above = beyond(a), beyond(b)
    if below >= 0:
        return a
    for k in range(200):
        s = (a * above - b * below) / (above - below) if k % 3 and above > below else (a + b) / 2
        if not a < s < b:
            s = (a + b) / 2
        if s in (a, b):
            break
        value = beyond(s)
        if value > 0:
            b, above = s, value
        else:
            a, below = s, value
        if b - a < 1e-19 * b:
            break
    return b


FINE, ROUGH = (32, 1e-17), (22, 1e-14)   # degree, last coefficients of steps


def march(law, x, v, end):
    """The motion, with the distance of a rougher one as its error."""
    x, v = REAL(x), REAL(v)
    return compared(March(law, *FINE)(x, v, end, end / 10), March(law, *ROUGH)(x, v, end, end / 13))


def compared(fine, rough):
    """The finer motion, with how far it is off."""
    times = np.concatenate([np.linspace(0, float(fine.ends[-1]), 200), fine.ends[1:].astype(float)])
    fine.error = float(np.abs(fine.coordinate(times) - rough.coordinate(times)).max())
    return fine
