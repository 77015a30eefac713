# SPDX-License-Identifier: BSD-3-Clause
"""What Python adds to the engine: building, solving again, looking at arrays, many at a time.

    python benchmarks/python_layer.py      in an environment that has livens; times are the least of many, CPU seconds
"""
from __future__ import annotations

import pathlib
import threading
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


class Threads:
    """The CPU time of each thread of this process, s, looked at every few milliseconds: those that end are kept."""

    def __init__(self) -> None:
        self.seconds: dict[str, float] = {}
        self._ends = threading.Event()
        self._thread = threading.Thread(target=self._watch)

    def _look(self) -> None:
        for task in pathlib.Path("/proc/self/task").iterdir():
            try:
                self.seconds[task.name] = int((task / "schedstat").read_text().split()[0]) * 1e-9
            except (FileNotFoundError, ProcessLookupError):   # it has just ended
                pass

    def _watch(self) -> None:
        while not self._ends.wait(0.003):
            self._look()

    def __enter__(self) -> Threads:
        self._look()
        self._before = dict(self.seconds)
        self._thread.start()
        return self

    def __exit__(self, *_: object) -> None:
        self._look()
        self._ends.set()
        self._thread.join()
        self.seconds.pop(str(self._thread.native_id), None)
        for name, before in self._before.items():
            self.seconds[name] -= before


def threads_of(work: Callable[[int], Any]) -> tuple[float, float]:
    """CPU time of what is done by one thread, and the longest way through it by two: Python's own part, which is
    before and after, and the thread that works more; s."""
    begin = time.process_time()
    work(1)
    serial = time.process_time() - begin
    with Threads() as threads:
        work(2)
    own = threads.seconds.pop(str(threading.get_native_id()))
    return serial, own + max(threads.seconds.values())


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
    serial, longest = threads_of(lambda n: lv.solve_many(four_bar, variations=variations, threads=n))
    print(f"1000 four-bars one by one        {serial:8.2f} s, by two threads the longer one {longest:.2f} s: "
          f"{longest / serial:.3f} of it (at most 0.56 is wanted)")
    if longest > 0.56 * serial:
        raise SystemExit("two threads take too long")


if __name__ == "__main__":
    main()
