# SPDX-License-Identifier: BSD-3-Clause
"""A Furuta pendulum held upright by a PD controller: its energy, a sweep over gains, the best gains by SciPy.

A motor turns an arm about the vertical; at its end a pendulum swings freely. Needs SciPy and matplotlib.
"""
from __future__ import annotations

import time

import numpy as np
import numpy.typing as npt
from scipy.integrate import trapezoid
from scipy.optimize import minimize

import livens as lv

TILT = np.arctan2(0.01, 0.15)   # rad, at the start


def furuta(kp: float, kd: float) -> lv.Model:
    """The pendulum with gains on its angle (N m/rad) and on its rate (N m s/rad)."""
    m = lv.Model("Furuta pendulum", gravity=(0, 0, -9.81))
    arm = m.add_body("arm", lv.cylinder("1 cm", "20 cm", mass="200 g"), position=(0.1, 0, 0),
                     rotation_vector=(0, "90 deg", 0))
    rod = m.add_body("pendulum", lv.cylinder("5 mm", "30 cm", mass="100 g"), position=(0.2, 0.01, 0.15),
                     rotation_vector=(-TILT, 0, 0))
    m.add_revolute("motor", "world", arm, at=(0, 0, 0), axis=(0, 0, 1))
    m.add_revolute("pivot", arm, rod, at=(0.2, 0, 0), axis=(1, 0, 0), coordinate=-TILT)
    m.add_actuator("controller", "motor", expression=law(kp, kd),
                   inputs={"phi": "pivot.angle", "w": "pivot.angle_rate",
                           "psi": "motor.angle", "v": "motor.angle_rate"})
    return m


def law(kp: float, kd: float) -> str:
    """Torque of the motor; the arm is brought back gently."""
    return f"{-kp!r}*phi - {kd!r}*w + 0.3*psi + 0.35*v"


def cost(sol: lv.Solution) -> float:
    """Squares of tilt (rad) and torque (N m), by the trapezoidal rule over instants 10 ms apart."""
    at = sol(np.arange(0, sol.t[-1], 0.01))
    if sol.t[-1] < 3:   # it did not come to the end
        return 1e3
    return float(trapezoid(at["pivot"].angle ** 2 + 0.1 * at["controller"].effort ** 2, at.t))


def main() -> None:
    begin = time.perf_counter()
    sol = lv.solve(furuta(6, 0.8), 3, accuracy=1e-8)
    print(sol)
    print(f"the tilt falls from {sol['pivot'].angle[0]:.3f} to {sol['pivot'].angle[-1]:.1e} rad")
    sol.plot("energy", "pivot.angle", "controller.effort")[0].figure.savefig("furuta.png")

    # A sweep: every pair of gains, on all cores.
    m = furuta(6, 0.8)
    gains = [(kp, kd) for kp in np.linspace(4, 8, 5) for kd in np.linspace(0.6, 1.2, 4)]
    sols = lv.solve_many(m, 3, variations=[{"controller.expression": law(float(p), float(d))} for p, d in gains])
    costs = [cost(s) for s in sols]
    first = gains[int(np.argmin(costs))]
    print(f"of {len(gains)} pairs of gains kp = {first[0]:.3g}, kd = {first[1]:.3g} are best: {min(costs):.3e}")

    # From there on SciPy's simplex; the model is edited and solved again.
    def cost_of(x: npt.NDArray[np.float64]) -> float:
        m["controller"].expression = law(float(x[0]), float(x[1]))
        return cost(lv.solve(m, 3))

    best = minimize(cost_of, first, method="Nelder-Mead", options={"xatol": 1e-2, "fatol": 1e-6, "maxfev": 60})
    print(f"the best gains are kp = {best.x[0]:.3f}, kd = {best.x[1]:.3f}: {best.fun:.3e}, after {best.nfev} solutions")
    assert best.fun <= min(costs) and sol.success
    print(f"all of it in {time.perf_counter() - begin:.1f} s")


if __name__ == "__main__":
    main()
