# SPDX-License-Identifier: BSD-3-Clause
"""What Python adds to the engine: building, solving again, looking at arrays, many at a time.

    python benchmarks/python_layer.py      in an environment that has livens; times are the least of many, CPU seconds
"""
from __future__ import annotations

import pathlib
import time
from collections.abc import Callable
from typing import Any

import livens as lv
from livens import _core

EXAMPLES = pathlib.Path(__file__).resolve().parents[1] / "examples"


def least(work: Callable[[], Any], n: int = 300) -> float:
    """Microseconds."""
    times = []
    for _ in range(n):
        begin = time.thread_time()
        work()
        times.append(time.thread_time() - begin)
    return 1e6 * min(times)


def pendulum() -> lv.Model:
    m = lv.Model("pendulum", gravity=(0, 0, -9.81))
    m.add_body("rod", lv.box(1, 0.05, 0.05, density=7850), position=(0.5, 0, 0))
    m.add_revolute("pivot", "world", "rod", at=(0, 0, 0), axis=(0, 1, 0))
    return m


def edited(m: lv.Model) -> lv.Solution:
    m["rod"].density = 7850.0
    return lv.solve(m, 0.1, elements=1, estimate="none")


def main() -> None:
    m = pendulum()
    sol = lv.solve(m, 0.1, elements=1, estimate="none")
    scenario = next(iter(m._built.values()))[0]
    bare = least(lambda: _core.solve(scenario, None, 1e9))
    again = least(lambda: lv.solve(m, 0.1, elements=1, estimate="none"))
    print(f"model of a body and a joint      {least(pendulum):8.1f} us")
    print(f"one element by the engine        {bare:8.1f} us")
    print(f"the same by solve(), built       {again:8.1f} us, of which Python's {again - bare:.1f} us")
    print(f"the same after an edit           {least(lambda: edited(m)):8.1f} us")
    print(f"a view of positions              {least(lambda: sol['rod'].position):8.1f} us")
    print(f"reading the four-bar             {least(lambda: lv.load(EXAMPLES / 'four_bar.toml'), 50):8.1f} us")
    four_bar = lv.load(EXAMPLES / "four_bar.toml")
    variations = [{"crank.density": 7000.0 + i} for i in range(1000)]
    own, whole, wall = time.thread_time(), time.process_time(), time.perf_counter()
    lv.solve_many(four_bar, variations=variations, threads=2)
    own, whole = time.thread_time() - own, time.process_time() - whole
    share = (own + (whole - own) / 2) / whole
    print(f"1000 four-bars by two threads    {whole:8.2f} s, the longer way {share:.3f} of it (Python's thread "
          f"{own:.2f} s), wall {time.perf_counter() - wall:.1f} s")


if __name__ == "__main__":
    main()
