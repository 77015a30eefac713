# SPDX-License-Identifier: BSD-3-Clause
"""End states and condition numbers of the mixed elements, made without any code of livens.

Fields q, pi, lambda over one time basis, assembled for the whole interval; full Newton steps from two guesses
(exact motion, constant velocity): `gap_X`, `gap_P` are the largest differences between the two.
Test functions M_A (L_A for multipliers); constraints: rigidity 11 22 33 12 13 23 of each body, then rods, all
with the factor 1/2 of (4) and (27). Rows:
    delta pi      int M_A (q' - m^-1 pi) = 0
    delta q       strong   int M_A (pi' + G^T lambda - F) = 0
                  natural  int -M_A' pi + M_A (G^T lambda - F) = P(0) at node 0, -P(T) at node n, 0 between
    delta lambda  int L_A Phi = 0
Natural: q is unknown unless X is given at that end; row delta q of an end is solved if P is given there, else
it defines P; pi, delta pi at all nodes; lambda where delta q is solved, delta lambda where q is unknown.
Strong: pi is unknown unless P is given at that end; all else where q is unknown; a multiplier that is not
keeps the value `lambda_0` (zero, or that of the acceleration-level equations).
Lower: multipliers of degree p - 1, discontinuous (Lagrange) or of maximal smoothness (splines), in all rows.
Where P is given and X is not, the data are linear momentum and moment about the reference point (`WT`), and
P = [v, w x d_i] m at the X of that node, with the v and w that have them. The torque of (21) is no polynomial
where directors are skew: the number of Gauss points matters. SI units.
Numbers of X and P: position (momentum), d1, d2, d3 of each body. Run: python3 make_mixed.py (numpy, scipy).
"""
import json
import math
import pathlib
import re
from itertools import product

import numpy as np
import scipy.sparse as sp
from scipy.integrate import solve_ivp
from scipy.interpolate import BSpline
from scipy.sparse.linalg import splu

EYE3, G = np.eye(3), 9.81


def cross_matrix(a):
    return np.array([[0, -a[2], a[1]], [a[2], 0, -a[0]], [-a[1], a[0], 0]])


def complex_step(f, q):
    """df/dq at every row of q; f must be analytic and work row by row."""
    return np.stack([f(q + 1e-40j * e).imag * 1e40 for e in np.eye(q.shape[1])], axis=-1)


def brick(size, density, centre=(0, 0, 0)):
    """m of (7) for a box whose centre lies at `centre` from the reference point."""
    mass, c = density * np.prod(size), np.asarray(centre, float)
    euler = mass * (np.diag(np.square(size)) / 12 + np.outer(c, c))
    return np.block([[mass, mass * c], [mass * c[:, None], euler]])


def half_couple(moment, d):
    """1/2 moment x d^i of (21), contravariant directors; d holds nine numbers a row."""
    rows = d.reshape(-1, 3, 3)
    dual = np.linalg.solve(np.einsum("pia,pja->pij", rows, rows), rows)
    return 0.5 * np.einsum("ab,pib->pia", cross_matrix(moment), dual).reshape(-1, 9)


class Model:
    """Bodies, rods between their reference points, and one torque on all bodies or gravity."""

    def __init__(self, masses, torque=None, gravity=None, rods=()):
        self.n_bodies, self.nd, self.torque = len(masses), 12 * len(masses), torque
        m = np.zeros((4 * self.n_bodies, 4 * self.n_bodies))
        for b, mb in enumerate(masses):
            m[4 * b:4 * b + 4, 4 * b:4 * b + 4] = mb
        self.mass, self.inverse = np.kron(m, EYE3), np.kron(np.linalg.inv(m), EYE3)
        self.weight = np.zeros(self.nd) if gravity is None else np.kron(m[:, 0::4].sum(axis=1), gravity)
        forms, constants = [], []
        for b in range(self.n_bodies):
            for i, j in ((1, 1), (2, 2), (3, 3), (1, 2), (1, 3), (2, 3)):
                pick = np.eye(len(m))[[4 * b + i, 4 * b + j]]
                forms.append(0.5 * (np.outer(*pick) + np.outer(*pick[::-1])))
                constants.append(-0.5 if i == j else 0.0)
        for first, second, length in rods:             # first = -1: the origin of space
            a = np.eye(len(m))[4 * second] - (np.eye(len(m))[4 * first] if first >= 0 else 0)
            forms.append(np.outer(a, a))
            constants.append(-0.5 * length**2)
        self.nc, self.k, self.c = len(forms), np.array([np.kron(f, EYE3) for f in forms]), np.array(constants)

    def constraints(self, q):
        return 0.5 * np.einsum("pi,kij,pj->pk", q, self.k, q, optimize=True) + self.c

    def jacobian(self, q):
        return np.einsum("kij,pj->pki", self.k, q, optimize=True)

    def force(self, q):
        f = np.tile(self.weight.astype(q.dtype), (len(q), 1))
        for b in range(self.n_bodies if self.torque is not None else 0):
            f[:, 12 * b + 3:12 * b + 12] += half_couple(self.torque, q[:, 12 * b + 3:12 * b + 12])
        return f

    def multipliers(self, q, v):
        """lambda of the acceleration-level equations."""
        g = self.jacobian(q[None])[0]
        a = np.block([[self.mass, g.T], [g, np.zeros((self.nc, self.nc))]])
        bend = np.einsum("i,kij,j->k", v, self.k, v)
        return np.linalg.solve(a, np.append(self.force(q[None])[0], -bend))[self.nd:]

    def momentum(self, wrench, q):
        """P = [v, w x d_i] m at q, from linear momentum and moment about the reference point of each body."""
        out = []
        for b in range(self.n_bodies):
            body = slice(12 * b, 12 * b + 12)
            n = np.zeros((12, 6), dtype=q.dtype)       # dX = N (dphi, w)
            n[:3, :3] = EYE3
            for i in (3, 6, 9):
                n[i:i + 3, 3:] = -cross_matrix(q[body][i:i + 3])
            mn = self.mass[body, body] @ n
            out.append(mn @ np.linalg.solve(n.T @ mn, wrench[6 * b:6 * b + 6].astype(q.dtype)))
        return np.concatenate(out)

    def wrench(self, q, p):
        """Linear momentum and moment sum d_i x P_i of each body."""
        out = []
        for d, pd in zip(q.reshape(-1, 4, 3), p.reshape(-1, 4, 3)):
            out += [pd[0], np.cross(d[1:], pd[1:]).sum(axis=0)]
        return np.concatenate(out)


def lagrange(p, ends, s, broken):
    """Equidistant Lagrange functions, continuous or broken at the element ends."""
    nodes = np.arange(p + 1) / max(p, 1)
    shapes = [np.poly1d(np.delete(nodes, a), r=True) for a in range(p + 1)] if p else [np.poly1d([1.0])]
    shapes = [f / f(x) for f, x in zip(shapes, nodes)]
    n_elements, stride = len(ends) - 1, p + 1 if broken else p
    value = np.zeros((n_elements, len(s), n_elements * stride + (0 if broken else 1)))
    slope = np.zeros_like(value)
    for e, h in enumerate(np.diff(ends)):
        for a, f in enumerate(shapes):
            value[e, :, e * stride + a], slope[e, :, e * stride + a] = f(s), f.deriv()(s) / h
    return value.reshape(-1, value.shape[2]), slope.reshape(-1, value.shape[2])


def functions(basis, p, ends, s, weights=None, broken=False):
    """Values and derivatives (points x functions, sparse) at the points s of every element."""
    if basis == "lagrange":
        return tuple(sp.csr_matrix(x) for x in lagrange(p, ends, s, broken))
    points = (ends[:-1, None] + np.diff(ends)[:, None] * s).ravel()
    knots = np.concatenate([[ends[0]] * p, ends, [ends[-1]] * p])
    splines = [BSpline(knots, row, p) for row in np.eye(len(ends) - 1 + p)]
    value = np.array([f(points) for f in splines]).T
    slope = np.array([f.derivative()(points) for f in splines]).T if p else np.zeros_like(value)
    if basis == "nurbs":
        value, slope = value * weights, slope * weights
        total, change = value.sum(axis=1)[:, None], slope.sum(axis=1)[:, None]
        value, slope = value / total, (slope * total - value * change) / total**2
    return sp.csr_matrix(value), sp.csr_matrix(slope)


def places(basis, p, ends):
    """Nodes, or Greville points of splines: where a coefficient of a guess may be taken from a motion."""
    if basis == "lagrange":
        return np.append(ends[:-1, None] + np.diff(ends)[:, None] * np.arange(p) / p, ends[-1])
    knots = np.concatenate([[ends[0]] * p, ends, [ends[-1]] * p])
    return np.array([knots[i + 1:i + p + 1].mean() for i in range(len(ends) - 1 + p)])


class Problem:
    """One discretisation and its end conditions: `given` holds two of X0, P0 (start), XT, PT (end)."""

    def __init__(self, case, elements, basis, degree, start, multipliers, given=("X0", "P0"),
                 gauss_points=None, weights=None):
        self.case, self.model, self.natural, self.given = case, case.model, start == "natural", given
        self.weights = None if weights is None else np.asarray(weights, float)
        self.ends = np.linspace(0, case.duration, elements + 1)
        self.gauss_points = gauss_points or math.ceil((3 * degree + 1) / 2)
        x, w = np.polynomial.legendre.leggauss(self.gauss_points)
        s = (x + 1) / 2
        self.w = (np.diff(self.ends)[:, None] * w / 2).ravel()
        self.value, self.slope = functions(basis, degree, self.ends, s, self.weights)
        self.times = places(basis, degree, self.ends)
        lower = "lagrange" if basis == "lagrange" else "bspline"
        self.lambda_value = self.value if multipliers == "equal" else \
            functions(lower, degree - 1, self.ends, s, broken=True)[0]
        self.n = self.value.shape[1] - 1
        self.choose_unknowns(multipliers == "equal")

    def choose_unknowns(self, equal):
        """Unknown coefficients and active rows of q, pi, lambda; the rules are at the top."""
        nodes, node_of = np.arange(self.n + 1), {"0": 0, "T": self.n}
        x_given, p_given = ([node_of[key[1]] for key in self.given if key[0] == what] for what in "XP")
        q, not_p = np.setdiff1d(nodes, x_given), np.setdiff1d(nodes, p_given)
        dq, pi = (np.union1d(nodes[1:-1], p_given).astype(int), nodes) if self.natural else (q, not_p)
        every = np.arange(self.lambda_value.shape[1])
        self.trial, self.test = (q, pi, dq if equal else every), (dq, pi, q if equal else every)
        nd, nc = self.model.nd, self.model.nc
        wide = lambda a, width: (np.asarray(a)[:, None] * width + np.arange(width)).ravel()
        self.columns, self.rows = ([wide(i, k) for i, k in zip(sets, (nd, nd, nc))]
                                   for sets in (self.trial, self.test))
        self.p_ends = [(node_of[key[1]], -1 if key == "P0" else 1) for key in self.given if key[0] == "P"]

    def end_momentum(self, node, q):
        """P at an end where it is given, and its derivative by X of that node (None where X is given too)."""
        name, data = ("0", "T")[node > 0], self.case.data
        if "X" + name in self.given:
            return data["P" + name], None
        p = lambda z: np.array([self.model.momentum(data["W" + name], row) for row in z])
        return p(q[node][None])[0], complex_step(p, q[node][None])[0]

    def equations(self, q, pi, lam):
        """Rows of all functions without the end momenta, and the blocks of their derivative."""
        m, v, d, lv = self.model, self.value, self.slope, self.lambda_value
        x, at_points = v @ q, lv @ lam
        g = m.jacobian(x)
        vw, lw = (v.T @ sp.diags(self.w)).tocsr(), (lv.T @ sp.diags(self.w)).tocsr()
        kinetic = -(d.T @ sp.diags(self.w) @ v) if self.natural else vw @ d
        residual = (kinetic @ pi + vw @ (np.einsum("pki,pk->pi", g, at_points) - m.force(x)),
                    vw @ (d @ q - v @ pi @ m.inverse.T), lw @ m.constraints(x))
        each = lambda a: sp.kron(a, sp.identity(m.nd)).tocsr()
        vi, li, point = each(v), sp.kron(lv, sp.identity(m.nc)).tocsr(), np.arange(len(x) + 1)
        blocks = lambda b: sp.bsr_matrix((b * self.w[:, None, None], point[:-1], point)).tocsr()
        stiffness = np.einsum("pk,kij->pij", at_points, m.k) - complex_step(m.force, x)
        g_transposed = vi.T @ blocks(g.transpose(0, 2, 1)) @ li
        return residual, [[vi.T @ blocks(stiffness) @ vi, each(kinetic), g_transposed],
                          [each(vw @ d), sp.kron(-(vw @ v), m.inverse), None],
                          [g_transposed.T, None, None]]

    def system(self, q, pi, lam):
        """Residual and matrix of the active rows in the unknowns."""
        residual, matrix = self.equations(q, pi, lam)
        for node, sign in self.p_ends:
            p, slope = self.end_momentum(node, q)
            spot = sp.csr_matrix(([1.0], ([node], [node])), (self.n + 1, self.n + 1))
            if self.natural:
                residual[0][node] += sign * p
                if slope is not None:
                    matrix[0][0] = matrix[0][0] + sp.kron(spot, sign * slope)
            elif slope is not None:                    # this pi is no unknown, but a function of q
                for row in (0, 1):
                    matrix[row][0] = matrix[row][0] + matrix[row][1] @ sp.kron(spot, slope)
        cut = [[None if b is None else sp.csr_matrix(b)[r][:, c] for b, c in zip(line, self.columns)]
               for line, r in zip(matrix, self.rows)]
        cut[2][2] = sp.csr_matrix((len(self.rows[2]), len(self.columns[2])))
        picked = np.concatenate([f.ravel()[r] for f, r in zip(residual, self.rows)])
        return picked, sp.bmat(cut, format="csc")

    def impose(self, fields):
        q, pi, lam = (f.copy() for f in fields)
        for key, node in (("X0", 0), ("XT", self.n)):
            q[node] = self.case.data[key] if key in self.given else q[node]
        for node, _ in () if self.natural else self.p_ends:
            pi[node] = self.end_momentum(node, q)[0]
        return q, pi, lam

    def newton(self, fields):
        """Full steps, until the increments of q and pi are at their rounding level. None: no convergence."""
        fields, last = self.impose(fields), np.inf
        for _ in range(25):
            residual, matrix = self.system(*fields)
            lu = splu(matrix)
            step = lu.solve(-residual)
            step += lu.solve(-residual - matrix @ step)
            parts = np.split(step, np.cumsum([len(c) for c in self.columns])[:2])
            for field, c, increment in zip(fields, self.columns, parts):
                field.reshape(-1)[c] += increment
            fields = self.impose(fields)
            size = max(np.abs(increment).max() for increment in parts[:2])
            if size < 1e-14 or (size < 1e-9 and size >= 0.5 * last):
                return fields
            last = size
        return None

    def end_state(self, fields):
        """X and P at start and end; natural: P from the rows that define it (or hold it)."""
        q, pi, lam = fields
        row = self.equations(q, pi, lam)[0][0]
        return np.array([q[0], q[-1]] + ([row[0], -row[-1]] if self.natural else [pi[0], pi[-1]]))

    def guesses(self, lambda_0="zero"):
        """Fields from the exact motion and from one of constant velocity."""
        data, m, t = self.case.data, self.model, self.times
        v0 = m.inverse @ data["P0"]
        lam = np.zeros((self.lambda_value.shape[1], m.nc))
        if lambda_0 == "acceleration":
            lam[0] = m.multipliers(data["X0"], v0)
        x, v = self.case.motion(t)
        return [(x, v @ m.mass, lam), (data["X0"] + t[:, None] * v0, np.tile(data["P0"], (len(t), 1)), lam)]


class Case:
    """A model and its motion, integrated in angles or rotation matrices; `motion` maps times to (X, X')."""

    def __init__(self, name, model, duration, rhs, y0, state):
        self.name, self.model, self.duration = name, model, duration
        y = solve_ivp(rhs, (0, duration), y0, method="DOP853", rtol=2.3e-14, atol=2.3e-14, max_step=0.01,
                      dense_output=True).sol
        self.motion = lambda t: tuple(np.array(part) for part in zip(*(state(a, y(a)) for a in t)))
        (x0, xt), (v0, vt) = self.motion([0.0, duration])
        self.data = {"X0": x0, "P0": model.mass @ v0, "XT": xt, "PT": model.mass @ vt}
        for end in "0T":
            self.data["W" + end] = model.wrench(self.data["X" + end], self.data["P" + end])


def free_box():
    """Box 2 x 1 x 1, density 1.5, torque of magnitude 2 along (1, 1, 1), 5 m/s along each axis, no spin."""
    inertia, torque = np.array([0.5, 1.25, 1.25]), 2 / np.sqrt(3) * np.ones(3)

    def turning(y):
        r = y[:9].reshape(3, 3)
        return cross_matrix(r @ (r.T @ y[9:] / inertia)) @ r

    return Case("free_box", Model([brick([2, 1, 1], 1.5)], torque=torque), 1.0,
                lambda t, y: np.append(turning(y), torque), np.append(EYE3, np.zeros(3)),
                lambda t, y: (np.append([5 * t] * 3, y[:9].reshape(3, 3).T),
                              np.append([5] * 3, turning(y).T)))


def double_pendulum(name, offset):
    """Cubes of 1 m and 0.8 m, density 1.5, on rods of 4 m; the second hangs `offset` from its centre."""
    rod, m1, m2 = 4.0, 1.5, 0.768
    model = Model([brick([1, 1, 1], 1.5), brick([0.8, 0.8, 0.8], 1.5, [offset, 0, 0])],
                  gravity=[0, 0, -G], rods=[(-1, 0, rod), (0, 1, rod)])
    inertia = np.array([[(m1 + m2) * rod**2, m2 * rod**2, m2 * rod * offset],
                        [m2 * rod**2, m2 * rod**2, m2 * rod * offset],
                        [m2 * rod * offset, m2 * rod * offset, m2 * (1.28 / 12 + offset**2)]])
    lever = np.array([(m1 + m2) * rod, m2 * rod, m2 * offset])
    along = lambda a: np.array([np.cos(a), 0, np.sin(a)])
    across = lambda a: np.array([-np.sin(a), 0, np.cos(a)])

    def rhs(_, y):
        """Lagrange's equations in the angles a_i of both rods and of the second body."""
        difference = y[:3, None] - y[:3]
        load = lever * -G * np.cos(y[:3]) - inertia * np.sin(difference) @ y[3:]**2
        return np.append(y[3:], np.linalg.solve(inertia * np.cos(difference), load))

    def state(_, y):
        (a, b, c), (wa, wb, wc) = y[:3], y[3:]
        x1, v1 = rod * along(a), rod * wa * across(a)
        x2, v2 = x1 + rod * along(b), v1 + rod * wb * across(b)
        return (np.concatenate([x1, EYE3.ravel(), x2, along(c), [0, 1, 0], across(c)]),
                np.concatenate([v1, np.zeros(9), v2, wc * across(c), np.zeros(3), -wc * along(c)]))

    return Case(name, model, 0.5, rhs, [np.pi / 4, np.pi / 4, 0, 0, 0, 0], state)


def solved(case, elements, basis, degree, start, multipliers, lambda_0="zero", **options):
    """One record in a list, or none where the two guesses do not lead to the same root."""
    problem = Problem(case, elements, basis, degree, start, multipliers, **options)
    runs = [problem.newton(guess) for guess in problem.guesses(lambda_0)]
    if None in runs:
        return []
    first, second = (problem.end_state(run) for run in runs)
    gap = np.abs(first - second).max(axis=1).reshape(2, 2).max(axis=1)
    if gap[0] > 1e-11 or gap[1] > 1e-10:
        return []
    record = {"case": case.name, "duration": case.duration, "elements": elements, "basis": basis,
              "degree": degree, "start": start, "multipliers": multipliers, "given": problem.given,
              "gauss_points": problem.gauss_points, **options}
    if start == "strong" and multipliers == "equal":
        record["lambda_0"] = lambda_0
    record |= {key: value.tolist() for key, value in zip(("X0", "XT", "P0", "PT"), first)}
    return [record | {"gap_X": gap[0], "gap_P": gap[1]}]


def solutions(box, centred, offset):
    out, lines, parabolas = [], ("lagrange", 1), (("lagrange", 2), ("bspline", 2))
    every = [(start, multipliers) for start in ("natural", "strong") for multipliers in ("equal", "lower")]
    for basis, degree, pairing in product(("lagrange", "bspline"), (1, 2, 3), every):
        out += solved(box, 8, basis, degree, *pairing)
        if pairing == ("strong", "equal"):
            out += solved(box, 8, basis, degree, *pairing, "acceleration")
    for weights, start in product(([1, 1.2, 0.9], [1, 1.02, 0.99]), ("natural", "strong")):
        out += solved(box, 8, "nurbs", 2, start, "equal", weights=[weights[i % 3] for i in range(10)])
    for degree in (1, 2):                              # collapses to Gauss collocation
        out += solved(box, 8, "lagrange", degree, "strong", "equal", gauss_points=degree)
    for case, basis, pairing in product((centred, offset), (lines, *parabolas), every):
        out += solved(case, 50, *basis, *pairing)
    ends = (("XT", "PT"), ("X0", "XT"), ("X0", "PT"), ("P0", "XT"))
    for case, basis, given in product((box, offset), parabolas, ends):
        out += solved(case, 8, *basis, "natural", "equal", given=given)
        if given != ("X0", "XT"):                      # singular: more multipliers than inner nodes can carry
            out += solved(case, 8, *basis, "natural", "lower", given=given)
    return out


def condition_numbers(box):
    """Of the whole matrix, unscaled, at the solution; linear Lagrange functions, equal multipliers; with the strong
    start the first of them, which is no unknown, is that of the acceleration level."""
    for start, elements in product(("strong", "natural"), (4, 8, 16, 32, 64)):
        problem = Problem(box, elements, "lagrange", 1, start, "equal")
        guess = problem.guesses("acceleration" if start == "strong" else "zero")[0]
        matrix = problem.system(*problem.newton(guess))[1].toarray()
        yield {"start": start, "elements": elements, "size": len(matrix),
               "norm_1": float(np.linalg.cond(matrix, 1)), "norm_2": float(np.linalg.cond(matrix, 2))}


def main():
    cases = free_box(), double_pendulum("pendulum_centred", 0.0), double_pendulum("pendulum_offset", 0.1)
    text = json.dumps({
        "made_by": "make_mixed.py, which shares no code with livens; its head says what is solved, and how",
        "exact": {case.name: {key: value.tolist() for key, value in case.data.items()} for case in cases},
        "solutions": solutions(*cases), "condition_numbers": list(condition_numbers(cases[0]))}, indent=1)
    flat = lambda found: re.sub(r"\s+", " ", found.group(0)).replace("[ ", "[").replace(" ]", "]")
    text = re.sub(r"\[[^\[\]{}]*\]", flat, text)       # a vector to a line
    pathlib.Path(__file__).with_name("mixed.json").write_text(text + "\n")


if __name__ == "__main__":
    main()
