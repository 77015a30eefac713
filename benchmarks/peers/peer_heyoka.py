# SPDX-License-Identifier: BSD-3-Clause
"""heyoka: Taylor series of the equations in minimal coordinates (by_hand.py), compiled to instructions of the machine before
anything is timed. Setting: a tolerance."""
import math

import heyoka as hy
import numpy as np

from by_hand import System
from problems import Mechanism
from serve import serve

UNROLLED = 12   # unknowns at most, for which its loops are unrolled
MOST = 40   # ways to move at most, which are compiled in less than a minute
KEPT = {}


def parallelograms():
    """On the branch where all links stay parallel: one angle from the upright, as in peer_hand.cpp."""
    a, w = hy.make_vars("a", "w")
    return [(a, w), (w, 9.81 * 3.5 / 3 * hy.sin(a))], [0.0, 1.0], lambda y: [(k + math.sin(y[0]), math.cos(y[0]), 0) for k in range(3)]


def equations(m):
    if m.name == "parallelograms":
        return parallelograms()
    system = System(m, hy.sin, hy.cos, hy.sqrt)
    numbers = System(m, math.sin, math.cos, math.sqrt)
    if len(system.columns) > MOST:
        raise ValueError("too many equations to be compiled here")
    q0, u0 = numbers.start()
    q, u = [hy.make_vars(f"q{i}") for i in range(len(q0))], [hy.make_vars(f"u{i}") for i in range(len(u0))]
    dq, du = system.rates(q, u, hy.time)

    def points(y):
        numbers.put([float(x) for x in y[:len(q0)]])
        return [numbers.at(body, at) for body, at in m.points]
    return [(name, hy.expression(value) if isinstance(value, float) else value) for name, value in zip(q + u, dq + du)], q0 + u0, points


def compiled(m, tolerance):
    """A problem is known by its name and its joints, and kept: it is asked for again and again."""
    problem = m.name, tuple(kind for kind, *_ in m.joints)
    if problem not in KEPT:
        KEPT[problem] = equations(m)
    system, start, points = KEPT[problem]
    if (problem, tolerance) not in KEPT:
        KEPT[problem, tolerance] = hy.taylor_adaptive(system, start, tol=tolerance, compact_mode=len(start) > UNROLLED)
    return KEPT[problem, tolerance], start, points


def prepare(m: Mechanism, setting):
    integrator, start, points = compiled(m, float(setting[0]))
    integrator.time = 0.0
    integrator.state[:] = start

    def solve():
        outcome = integrator.propagate_until(m.end)[0]
        if outcome != hy.taylor_outcome.time_limit:
            raise RuntimeError(str(outcome))
        end = np.array(integrator.state)
        return lambda: points(end)
    return solve


if __name__ == "__main__":
    serve(prepare)
