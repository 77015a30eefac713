#!/usr/bin/python3 -B
# SPDX-License-Identifier: BSD-3-Clause
"""Makes reference.json: the exact motions that the experiments are judged by.

    make_reference.py        writes reference.json beside this file (about a quarter of a minute)

Nothing here is shared with livens: bodies turn by quaternions, pendulums by angles or by accelerations, and
the ordinary differential equations are solved by extrapolation of the modified midpoint rule (Gragg,
Bulirsch, Stoer) in 80-bit arithmetic. Every case is solved with two step sizes; `gap` is
their largest difference, and what the reference is good for. Where SciPy is installed its DOP853 looks at the
same equations, too (`gap_to_dop853`).

Units: SI. Directors are listed [d1, d2, d3], world axes. Multipliers of rigidity are the components 11, 22,
33, 12, 13, 23 of the symmetric tensor of (P4), in N m: P'_a = F_a - sum_b lambda_ab d_b.
"""
import json
import math
import pathlib

import numpy as np

Real = np.longdouble
assert np.finfo(Real).nmant >= 63, "needs the 80-bit numbers of x86"

GRAVITY = Real("9.81")
STAGES = 9   # midpoint sequences of 2, 4, .. 18 substeps: order 18


def extrapolated_step(rhs, t, y, H):
    """One step of length H: modified midpoint rules with ever more substeps, extrapolated to length zero."""
    table = []
    for k in range(1, STAGES + 1):
        n = 2 * k
        h = H / n
        before, now = y, y + h * rhs(t, y)
        for i in range(1, n):
            before, now = now, before + 2 * h * rhs(t + i * h, now)
        row = [(before + now + h * rhs(t + H, now)) / 2]
        for j, last in enumerate(table[-1] if table else [], 1):
            ratio = (Real(n) / (2 * (k - j))) ** 2
            row.append(row[-1] + (row[-1] - last) / (ratio - 1))
        table.append(row)
    return table[-1][-1]


def integrate(rhs, y, t0, times, largest_step):
    """States at the ascending `times`, from state y at t0."""
    states, t = [], Real(t0)
    y = np.array(y, dtype=Real)
    for end in times:
        n = max(1, math.ceil(float((Real(end) - t) / Real(largest_step)) - 1e-9))
        H = (Real(end) - t) / n
        for i in range(n):
            y = extrapolated_step(rhs, t + i * H, y, H)
        t = Real(end)
        states.append(y)
    return np.array(states)


def twice(rhs, y, t0, times, largest_step):
    """States at `times` and, for each, the largest difference between two step sizes."""
    fine = integrate(rhs, y, t0, times, largest_step)
    gaps = np.abs(fine - integrate(rhs, y, t0, times, 1.5 * largest_step)).max(axis=1)
    return fine, [float(gap) for gap in gaps]


def gap_to_dop853(rhs, y, t0, times, states):
    """Largest difference to SciPy's DOP853, or None without SciPy."""
    try:
        from scipy.integrate import solve_ivp
    except ModuleNotFoundError:
        return None
    plain = solve_ivp(lambda t, y: rhs(t, y).astype(float), (float(t0), float(times[-1])), np.array(y, float),
                      method="DOP853", rtol=2.3e-14, atol=1e-14, t_eval=[float(t) for t in times])
    return float(np.abs(plain.y.T - states).max())


# The free box: edges 2, 1, 1, density 1.5; a torque fixed in the world, so its angular momentum is known.

INERTIA = np.array([0.5, 1.25, 1.25], dtype=Real)             # M (b^2 + c^2) / 12 with M = 3
EULER_TENSOR = INERTIA.sum() / 2 - INERTIA                    # integral of rho theta_i theta_i
TORQUE = np.full(3, 2 / np.sqrt(Real(3)))                     # magnitude 2 along (1, 1, 1)


def cross(a, b):
    """a x b; NumPy's own takes most of the time otherwise."""
    return np.array([a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]])


def rotation(q):
    """Matrix whose columns are the directors, of the quaternion (w, x, y, z) of any norm."""
    w, x, y, z = q / np.sqrt(q @ q)
    return np.array([[1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
                     [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
                     [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)]])


def turning(spin, torque):
    """q' = 1/2 (0, w) q with w from the angular momentum spin(t)."""
    def rhs(t, q):
        R = rotation(q)
        w = R @ ((spin(t) @ R) / INERTIA)
        return np.concatenate([[-(w @ q[1:])], w * q[0] + cross(w, q[1:])]) / 2
    return rhs


def multipliers(q, spin, torque):
    """Rigidity multipliers from d_a'' = alpha x d_a + w x (w x d_a) and the forces 1/2 mu x d_a (P21)."""
    R = rotation(q)
    w_body = (spin @ R) / INERTIA
    alpha = R @ ((torque @ R - cross(w_body, INERTIA * w_body)) / INERTIA)
    w = R @ w_body
    columns = []
    for a in range(3):
        d = R[:, a]
        acceleration = cross(alpha, d) + cross(w, cross(w, d))
        columns.append(R.T @ (cross(torque, d) / 2 - EULER_TENSOR[a] * acceleration))
    tensor = np.array(columns)
    assert np.abs(tensor - tensor.T).max() < 1e-15, "the tensor is symmetric where the law of spin holds"
    return [tensor[a, b] for a, b in ((0, 0), (1, 1), (2, 2), (0, 1), (0, 2), (1, 2))]


def chebyshev(t0, t1, n):
    """n + 1 Chebyshev points of the second kind in [t0, t1], ascending; the ends exactly."""
    s = (1 - np.cos(np.arange(n + 1) * Real(np.pi) / n)) / 2
    s[-1] = 1
    return Real(t0) + (Real(t1) - Real(t0)) * s


def free_box(phases):
    """Directors and multipliers as piecewise polynomials: values at Chebyshev points of intervals of 1/4 s.

    phases: (from, to, torque acts); position is 5 t in all three components.
    """
    q, spin = np.array([1, 0, 0, 0], dtype=Real), np.zeros(3, dtype=Real)
    pieces, gap, other = [], 0.0, 0.0
    for t0, t1, acts in phases:
        torque = TORQUE * (1 if acts else 0)
        rhs = turning(lambda t, l=spin, s=Real(t0), mu=torque: l + (t - s) * mu, torque)
        count = round((t1 - t0) / 0.25)
        for k in range(count):
            times = chebyshev(t0 + 0.25 * k, t0 + 0.25 * (k + 1), 16)
            states, gaps = twice(rhs, q, times[0], times[1:], 0.01)
            other = max(other, gap_to_dop853(rhs, q, times[0], times[1:], states) or 0.0)
            states = np.vstack([q, states])
            gap, q = gap + max(gaps), states[-1]
            pieces.append({
                "from": float(times[0]), "to": float(times[-1]),
                "directors": [rotation(y).T.astype(float).tolist() for y in states],
                "multipliers": [[float(v) for v in multipliers(y, spin + (t - Real(t0)) * torque, torque)]
                                for t, y in zip(times, states)]})
        spin = spin + (t1 - t0) * torque
    return {"gap": gap, "gap_to_dop853_a_piece": other, "pieces": pieces,
            "angular_momentum_about_centre": [float(v) for v in spin]}


# The double pendulums: rods of 4 m, masses 1.5 and 0.768 (cubes with edges 1 and 0.8, density 1.5).

MASSES = np.array([Real("1.5"), Real("0.768")])
ROD = Real(4)


def solve3(A, b):
    """Cramer's rule for three equations (NumPy solves in double precision only)."""
    c = [cross(A[1], A[2]), cross(A[2], A[0]), cross(A[0], A[1])]   # A^-1 = [c0 c1 c2] / det
    return (c[0] * b[0] + c[1] * b[1] + c[2] * b[2]) / (A[0] @ c[0])


def planar_pendulum(offset, times):
    """Angles of both rods and of the lower cube in the x-z plane; the cube hangs `offset` off its centre.

    The hinge lies at -offset d1 from the centre. Lagrange's equations with the kinetic energy of arms
    (cos, sin): their moments are (m1 + m2) L^2, m2 L^2 and J + m2 offset^2, coupled by the cosines of angle
    differences.
    """
    m1, m2 = MASSES
    edge = Real("0.8")
    arms = np.array([[(m1 + m2) * ROD**2, m2 * ROD**2, m2 * ROD * offset],
                     [m2 * ROD**2, m2 * ROD**2, m2 * ROD * offset],
                     [m2 * ROD * offset, m2 * ROD * offset, m2 * edge**2 / 6 + m2 * offset**2]])
    weights = GRAVITY * np.array([(m1 + m2) * ROD, m2 * ROD, m2 * offset])

    def rhs(_, y):
        angles, rates = y[:3], y[3:]
        difference = angles[:, None] - angles[None, :]
        right = -(arms * np.sin(difference)) @ (rates * rates) - weights * np.cos(angles)
        return np.concatenate([rates, solve3(arms * np.cos(difference), right)])

    quarter = np.arctan(Real(1))   # pi / 4; np.pi is a double
    start = [quarter, quarter, 0, 0, 0, 0]
    states, gaps = twice(rhs, start, 0, times, 0.005)
    rows = []
    for t, y, gap in zip(times, states, gaps):
        unit = [np.array([np.cos(a), 0, np.sin(a)]) for a in y[:3]]
        rate = [w * np.array([-np.sin(a), 0, np.cos(a)]) for a, w in zip(y[:3], y[3:])]
        rows.append({"t": float(t), "gap": gap, "position_1": as_list(ROD * unit[0]),
                     "position_2": as_list(ROD * (unit[0] + unit[1])),
                     "velocity_1": as_list(ROD * rate[0]), "velocity_2": as_list(ROD * (rate[0] + rate[1])),
                     "d1_of_body_2": as_list(unit[2])})
    return {"gap_to_dop853": gap_to_dop853(rhs, start, 0, times, states), "rows": rows}


def spatial_pendulum(times):
    """The centred pendulum set off sideways: both centres with velocity (0, 1, 0).

    Rods at the centres exert no torque and cubes have no axes of their own, so each turns as it began and its
    centre moves like a point mass. Tensions follow from the second derivatives of both lengths.
    """
    m1, m2 = MASSES
    g = np.array([0, 0, -GRAVITY], dtype=Real)

    def rhs(_, y):
        x1, x2, v1, v2 = y.reshape(4, 3)
        r, v = x2 - x1, v2 - v1
        # x1'' = g - s x1 / m1 + u r / m1,  x2'' = g - u r / m2;  x1 . x1'' + v1^2 = 0,  r . r'' + v^2 = 0
        a, b, c = x1 @ x1 / m1, x1 @ r / m1, (r @ r) * (1 / m1 + 1 / m2)
        right = v1 @ v1 + x1 @ g, v @ v
        determinant = a * c - b * b
        s, u = (right[0] * c + right[1] * b) / determinant, (right[1] * a + right[0] * b) / determinant
        return np.concatenate([v1, v2, g + (u * r - s * x1) / m1, g - u * r / m2])

    k = ROD / np.sqrt(Real(2))
    start = [k, 0, k, 2 * k, 0, 2 * k, 0, 1, 0, 0, 1, 0]
    states, gaps = twice(rhs, start, 0, times, 0.005)
    return {"gap_to_dop853": gap_to_dop853(rhs, start, 0, times, states),
            "rows": [{"t": float(t), "gap": gap, "position_1": as_list(y[:3]), "position_2": as_list(y[3:6]),
                      "velocity_1": as_list(y[6:9]), "velocity_2": as_list(y[9:])}
                     for t, y, gap in zip(times, states, gaps)]}


def as_list(vector):
    return [float(v) for v in vector]


def main():
    cases = {
        "free_box_constant": free_box([(0, 1, True)]),
        "free_box_rectangular": free_box([(0, 0.5, False), (0.5, 1.5, True), (1.5, 4, False)]),
        "double_pendulum_centred": planar_pendulum(Real(0), [1, 2, 5, 10]),
        "double_pendulum_offset": planar_pendulum(Real("0.1"), [1, 2, 5, 10]),
        "double_pendulum_spatial": spatial_pendulum([1, 2, 5, 10]),
    }
    made_by = "make_reference.py: extrapolated midpoint rules in 80-bit arithmetic, minimal coordinates"
    text = ",\n".join(f' "{name}": {json.dumps(case)}' for name, case in cases.items())
    path = pathlib.Path(__file__).with_name("reference.json")
    path.write_text('{\n "made_by": ' + json.dumps(made_by) + ",\n" + text + "\n}\n", encoding="utf-8")
    for name, case in cases.items():
        gaps = {key: value for key, value in case.items() if key.startswith("gap")}
        print(name, gaps, [(row["t"], row["gap"]) for row in case.get("rows", [])])


if __name__ == "__main__":
    main()
