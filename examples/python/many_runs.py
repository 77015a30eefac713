# SPDX-License-Identifier: BSD-3-Clause
"""10,000 runs by Dask: workers write the results, a run that fails is told, a worker that dies loses nothing.

python many_runs.py [FOLDER] [SCHEDULER]: without the address of a scheduler, processes of this machine. Needs
`pip install distributed`. What is in FOLDER already is not done again.
"""
from __future__ import annotations

import os
import pathlib
import sys

import numpy as np
import numpy.typing as npt
from distributed import Client, LocalCluster, as_completed, progress

import livens as lv

RUNS, AT_ONCE = 10_000, 100   # a task is worth its messages from some hundred milliseconds on


def pendulum(mass: float) -> lv.Model:
    """A rod that swings against a damper; what is swept is its mass, kg."""
    m = lv.Model("rod", gravity=(0, 0, -9.81))
    rod = m.add_body("rod", lv.box(0.02, 0.02, 0.4, mass=mass), position=(0, 0, -0.2))
    m.add_revolute("pivot", "world", rod, at=(0, 0, 0), axis=(0, 1, 0), rate=3)
    m.add_actuator("damper", "pivot", expression="-0.02*w", inputs={"w": "pivot.angle_rate"})
    return m


def mass_of(run: int) -> float:
    """kg, from 0.1 to 1.1; run 4321 is wrong, as one of many may be."""
    return -1.0 if run == 4321 else 0.1 + run / RUNS


def one_run(run: int) -> tuple[float, str]:
    """The angle after a second, rad; or why there is none."""
    try:
        return float(lv.solve(pendulum(mass_of(run)), 1, elements=10, estimate="none")["pivot"].angle[-1]), ""
    except (lv.InputError, lv.SolveError) as error:
        return float("nan"), str(error)


def batch(number: int, folder: str) -> str:
    """Solves some runs and writes them: under another name first, so that a file is whole or absent. What is there
    is left, since Dask gives a batch of a worker that died to another one."""
    file = pathlib.Path(folder, f"{number:05}.npz")
    if not file.exists():
        runs = range(number * AT_ONCE, (number + 1) * AT_ONCE)
        angles, errors = zip(*(one_run(run) for run in runs))
        beside = file.with_suffix(f".{os.getpid()}.tmp")
        with beside.open("wb") as out:
            np.savez(out, angle=np.array(angles), error=np.array(errors))
        beside.rename(file)
    return str(file)


def sweep(client: Client, folder: pathlib.Path, n_batches: int = RUNS // AT_ONCE) -> list[str]:
    """The files, as they are ready. Only their names go through Dask."""
    folder.mkdir(parents=True, exist_ok=True)
    futures = client.map(batch, range(n_batches), folder=str(folder), retries=3)
    if sys.stdout.isatty():
        progress(futures)  # type: ignore[no-untyped-call]   # a bar
    return [future.result() for future in as_completed(futures)]  # type: ignore[no-untyped-call]


def read(folder: pathlib.Path) -> tuple[npt.NDArray[np.float64], list[str]]:
    """Of all runs, in their order: angles, and what failed."""
    parts = [np.load(file) for file in sorted(folder.glob("*.npz"))]
    errors = np.concatenate([part["error"] for part in parts])
    return np.concatenate([part["angle"] for part in parts]), [f"run {i}: {errors[i]}" for i in np.flatnonzero(errors != "")]


def main() -> None:
    """Sweeps, and says what came out."""
    folder = pathlib.Path(sys.argv[1] if len(sys.argv) > 1 else "runs")
    cluster = sys.argv[2] if len(sys.argv) > 2 \
        else LocalCluster(threads_per_worker=1, dashboard_address=None)  # type: ignore[no-untyped-call]
    with Client(cluster) as client:  # type: ignore[no-untyped-call]
        sweep(client, folder)
    angles, failed = read(folder)
    print(f"{np.isfinite(angles).sum()} of {angles.size} runs, from {np.nanmin(angles):.4f} to {np.nanmax(angles):.4f} rad")
    print(*failed, sep="\n")


if __name__ == "__main__":
    main()
