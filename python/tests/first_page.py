# SPDX-License-Identifier: BSD-3-Clause
"""What one does first: a pendulum looked at, a four-bar edited. For any environment that has the package:

    python first_page.py [FOUR_BAR.TOML]      what is not installed beside NumPy is left out, and said
"""
from __future__ import annotations

import importlib.util
import pathlib
import sys
import tempfile
import warnings

import numpy as np

import livens as lv

FOUR_BAR = pathlib.Path(__file__).resolve().parents[2] / "examples" / "four_bar.toml"


def has(module: str) -> bool:
    is_there = importlib.util.find_spec(module) is not None
    if not is_there:
        print(f"left out: {module}")
    return is_there


def pendulum() -> None:
    m = lv.Model("pendulum", gravity=(0, 0, -9.81))
    rod = m.add_body("rod", lv.box(1, 0.05, 0.05, density=7850), position=(0.5, 0, 0))
    m.add_revolute("pivot", "world", rod, at=(0, 0, 0), axis=(0, 1, 0))
    sol = lv.solve(m, 10, elements=100)
    assert (sol.success, sol.status, sol.message) == (True, "converged", "") and "converged" in repr(sol)
    assert sol.t.shape == (101,) and sol["rod"].position.shape == (101, 3) and sol["rod"].quaternion.shape == (101, 4)
    part = 0.25 / (0.25 + (1 + 0.05 ** 2) / 12)   # of a fall: the square of the arm by that of gyration, a level rod let go
    force = 7850 * 0.05 * 0.05 * 9.81 * (1 - part)
    assert np.allclose(sol["pivot"].force[0], (0, 0, force), rtol=1e-9, atol=1e-6), sol["pivot"].force[0]
    for motion, largest in ((sol, 1e-5), (sol(np.linspace(0, 10, 2001)), 5e-3)):   # between the ends of a lower order
        speed = np.linalg.norm(motion["rod"].velocity, axis=1)
        fall = -motion["rod"].position[:, 2]
        assert np.abs(speed ** 2 - 2 * 9.81 * fall * part).max() < largest
    assert sol.energy.shape == (101,) and np.abs(sol.drift).max() < 1e-6 and sol.violation is not None
    with tempfile.TemporaryDirectory() as folder:
        sol.save(f"{folder}/run.nc")
        sol.report(f"{folder}/run.html")
        again = lv.load_solution(f"{folder}/run.nc")
        assert np.array_equal(again["rod"].position, sol["rod"].position)
    if has("matplotlib"):
        import matplotlib
        matplotlib.use("Agg")
        assert len(sol.plot("rod.position", "pivot.force", "energy")) == 3
    if has("xarray"):
        data = sol.to_xarray()
        assert data["position"].sel(body="rod", xyz="z").attrs["units"] == "m" and data["position"].dims[0] == "time"
    if has("pandas"):
        assert "rod.position.z" in sol.to_dataframe("rod")


def four_bar(file: pathlib.Path) -> None:
    t = np.linspace(0, 5, 21)
    m = lv.load(file)
    m["crank"].mass = "2.6 kg"
    m.add_actuator("motor", "crank shaft", table=lv.table(t, 2 * np.sin(t), "spline"))
    m.add_spring("return", ("world", (1, 0, 0.2)), ("rocker", (0.2, 0, 0)), stiffness=800, damping=3, free_length=0.3)
    assert m.check() == []
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", lv.SolveWarning)   # 200 elements are few for this spring
        sol = lv.solve(m, (0, 5), elements=200, progress=True)
        peak = max(m.joints, key=lambda j: float(np.linalg.norm(sol[j].force, axis=1).max()))
        assert sol[peak].unique is False and sol.notes
        m2 = m.copy()
        m2["coupler"].density *= 0.5
        assert m2 != m
        other = lv.compare(sol, lv.solve(m2, (0, 5), elements=200))
    assert other.largest["coupler"]["position"] > 1e-3
    try:
        m.add_revolute("x", "wrold", "crank", at=(0, 0, 0), axis=(0, 1, 0))
    except lv.InputError as e:
        assert (e.code, e.path, e.help) == ("body-unknown", "joint[x].between", "did you mean 'world'?")
    else:
        raise AssertionError("a body that is not there was taken")


if __name__ == "__main__":
    pendulum()
    four_bar(pathlib.Path(sys.argv[1]) if len(sys.argv) > 1 else FOUR_BAR)
