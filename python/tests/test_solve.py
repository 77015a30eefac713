# SPDX-License-Identifier: BSD-3-Clause
"""solve() and solve_many(): words, warnings, interruption, threads."""
from __future__ import annotations

import os
import pathlib
import pickle
import subprocess
import sys
import threading
import time
import warnings
from concurrent.futures import ProcessPoolExecutor, ThreadPoolExecutor
from typing import Any

import numpy as np
import pytest
from conftest import ROOT

import livens as lv


def free_fall() -> lv.Model:
    m = lv.Model("fall", gravity=(0, 0, -9.81))
    m.add_body("ball", lv.point(mass=1), velocity=(1, 0, 0))
    return m


def chain(n: int) -> lv.Model:
    """Rods in a row, swinging: as much work as is wanted."""
    m = lv.Model("chain", gravity=(0, 0, -9.81))
    last = "world"
    for i in range(n):
        m.add_body(f"rod {i}", lv.box(1, 0.1, 0.1, mass=1), position=(0.5 + i, 0, 0))
        m.add_revolute(f"pin {i}", last, f"rod {i}", at=(i, 0, 0), axis=(0, 1, 0))
        last = f"rod {i}"
    return m


def test_scipys_words(pendulum: lv.Model) -> None:
    sol = lv.solve(pendulum, 2)
    assert sol.success is True and sol.status == "converged" and sol.message == ""
    assert sol.nfev > 0 and sol.nit > 0 and sol.n_elements == len(sol.t) - 1 and sol.seconds > 0
    assert sol.error < 1e-6 and sol.figures["accuracy"] == 1e-6 and sol.method.startswith(("lobatto", "radau"))
    assert "converged" in repr(sol) and "lobatto" in repr(sol) and "<table" in sol._repr_html_()
    assert "<iframe srcdoc=" in sol._repr_html_()
    assert sol.options["time"]["accuracy"] == 1e-6


def test_against_the_pendulum_of_scipy(pendulum: lv.Model) -> None:
    """The physical pendulum by another integrator, which shares no code."""
    integrate = pytest.importorskip("scipy.integrate")
    g, b = 9.81, 0.05
    inertia = (1 + b * b) / 12 + 0.25   # of a box about its end, by mass
    other = integrate.solve_ivp(lambda t, y: [y[1], g * 0.5 * np.cos(y[0]) / inertia], (0, 3), [0, 0], rtol=1e-12,
                                atol=1e-13)
    sol = lv.solve(pendulum, 3, accuracy=1e-10)
    assert sol["pivot"].angle[-1] == pytest.approx(other.y[0, -1], abs=1e-9)
    assert sol["pivot"].angle_rate[-1] == pytest.approx(other.y[1, -1], abs=1e-8)


def test_time_and_methods(pendulum: lv.Model) -> None:
    assert lv.solve(pendulum, (1, 2), elements=4).t.tolist() == [1, 1.25, 1.5, 1.75, 2]
    assert lv.solve(pendulum, "500 ms", elements=2).t.tolist() == [0, 0.25, 0.5]
    assert lv.solve(pendulum, 1, elements=2, output=[0.25, 1]).t.tolist() == [0, 0.25, 0.625, 1]
    for method, name in ((lv.Lobatto(6), "lobatto(6)"), (lv.Radau(3), "radau(3)"), ("midpoint", "midpoint"),
                         (lv.Mixed(2, basis="bspline"), "mixed(bspline, 2, natural, equal)"),
                         (lv.Endpoint(), "endpoint"), (None, "lobatto(4)")):
        sol = lv.solve(pendulum, 0.2, elements=200, method=method)
        assert sol.success and sol.method == name
        assert pickle.loads(pickle.dumps(method)) == method
    assert repr(lv.Radau(3)) == "Radau(degree=3)"
    pendulum.time.end, pendulum.time.elements = 1, 10
    pendulum.method.family, pendulum.method.degree, pendulum.method.estimate = "radau", 5, "none"
    assert lv.solve(pendulum).method == "radau(5)" and lv.solve(pendulum).n_elements == 10
    sol = lv.solve(pendulum, accuracy=1e-5, method=lv.Lobatto(), estimate="second")
    assert sol.method.startswith("lobatto") and sol.figures["accuracy"] == 1e-5
    with pytest.raises(lv.InputError, match="end of time is missing"):
        lv.solve(free_fall())


def test_conditions_at_both_ends() -> None:
    m = free_fall()
    there = lv.positions({"ball": {"position": ("2 m", 0, 0)}})
    sol = lv.solve(m, 1, elements=4, start="positions", end=there)
    assert sol["ball"].velocity[0] == pytest.approx([2, 0, 4.905], abs=1e-12)
    back = lv.solve(m, 1, elements=4, start="nothing",
                    end=lv.state({"ball": {"position": sol["ball"].position[-1], "velocity": sol["ball"].velocity[-1]}}))
    assert np.allclose(back["ball"].position, sol["ball"].position, atol=1e-12)
    moved = lv.solve(m, 1, elements=1, start=lv.state({"ball": {"position": (0, 0, 5)}}))
    assert moved["ball"].position[0].tolist() == [0, 0, 5] and m["ball"].position.tolist() == [0, 0, 0]
    with pytest.raises(lv.InputError):
        lv.solve(m, 1, elements=1, start="positions")


def test_a_solution_is_a_guess() -> None:
    """A rod that hangs at both ends of a second may rest or turn once."""
    def hanging(**rates: Any) -> lv.Model:
        m = lv.Model("hanging", gravity=(0, 0, -9.81))
        rod = m.add_body("rod", lv.box(1, 0.05, 0.05, density=1000), position=(0, 0, -0.5),
                         rotation_vector=(0, "90 deg", 0), **rates)
        m.add_revolute("hook", "world", rod, at=(0, 0, 0), axis=(0, 1, 0))
        return m

    there = lv.positions({"rod": {"position": (0, 0, -0.5), "rotation_vector": (0, "90 deg", 0)}})
    ends: dict[str, Any] = dict(start="positions", end=there)
    turn = lv.solve(hanging(velocity=(-4, 0, 0), angular_velocity=(0, 8, 0)), 1, accuracy=1e-9, output=[0.5], **ends)
    assert turn.success and turn(0.5)["rod"].position[2] > 0.4
    assert lv.solve(hanging(), 1, accuracy=1e-9, **ends)(0.5)["rod"].position[2] < -0.49, "the control"
    # compared where an element ends: the polynomial between ends is of a lower order than what is asked for
    guessed = lv.solve(hanging(), 1, accuracy=1e-9, output=[0.5], guess=turn, **ends)
    assert guessed.success and guessed(0.5)["rod"].position[2] == pytest.approx(turn(0.5)["rod"].position[2], abs=1e-9)
    with pytest.raises(lv.InputError, match="goes with conditions at both ends"):
        lv.solve(hanging(), 1, guess=turn)
    with pytest.raises(lv.InputError, match="no time in common"):
        lv.solve(hanging(), (1, 2), guess=turn, **ends)
    with pytest.raises(TypeError, match="a guess is a livens.Solution"):
        lv.solve(hanging(), 1, guess="turn.nc", **ends)   # type: ignore[arg-type]


def test_conditions_by_component() -> None:
    m = lv.Model("throw", gravity=(0, 0, -9.81))
    m.add_body("ball", lv.point(mass=0.4), velocity=(1, 0, 1))
    sol = lv.solve(m, 2, elements=4, start={"ball.position": (0, 0, "200 cm"), "ball.vy": 0},
                   end={"ball.x": 12, "ball.z": np.float64(3)})
    assert sol.success
    np.testing.assert_allclose(sol["ball"].velocity[0], (6, 0, 0.5 + 9.81), atol=1e-11)
    assert "start" not in m.to_toml()   # the model is not changed
    m.add_body("other", lv.point(mass=1))
    with pytest.raises(lv.InputError, match="too few"):
        lv.solve(m, 2, elements=4, start={"ball.position": (0, 0, 2)}, end={"ball.x": 12})
    with pytest.raises(lv.InputError, match="bell.x"):
        lv.solve(m, 2, elements=4, start={"bell.x": 0})


def test_the_arrival_is_told_between_both_ends() -> None:
    """A ball is moved by what it flies; of a march nobody asks."""
    m = lv.Model("throw", gravity=(0, 0, -9.81))
    m.add_body("ball", lv.point(mass=0.4), velocity=(1, 0, 1))
    sol = lv.solve(m, 2, start={"ball.position": (0, 0, 2)}, end={"ball.position": (12, 0, 3)})
    assert sol.success and sol.arrival == pytest.approx(2, abs=1e-12)
    assert "1 mm/s" in repr(sol) and np.isnan(lv.solve(m, 2, elements=4).arrival)
    thrown = lv.solve(m, 2, start={"ball.position": (0, 0, 2), "ball.speed": 12, "ball.vy": 0}, end={"ball.z": 3})
    assert thrown.success and np.linalg.norm(thrown["ball"].velocity[0]) == pytest.approx(12, abs=1e-11)


def test_several_motions() -> None:
    m = lv.Model("hanging", gravity=(0, 0, -9.81))
    rod = m.add_body("rod", lv.box(1, 0.05, 0.05, density=1000), position=(0, 0, -0.5), rotation_vector=(0, "90 deg", 0))
    m.add_revolute("hook", "world", rod, at=(0, 0, 0), axis=(0, 1, 0))
    there = lv.positions({"rod": {"position": (0, 0, -0.5), "rotation_vector": (0, "90 deg", 0)}})
    sol = lv.solve(m, 1, elements=24, method=lv.Lobatto(6), start="positions", end=there, roots=3)
    assert sol.success and len(sol.roots) == 2 and sol(0.5)["rod"].position[2] == pytest.approx(-0.5, abs=1e-9)
    assert all(one.success and one(0.5)["rod"].position[2] > -0.4 for one in sol.roots)
    assert any("effort" in note and "rounds" in note for note in sol.notes)
    with pytest.raises(lv.InputError, match="one motion"):
        lv.solve(m, 1, roots=3)


def test_periodic_motions() -> None:
    m = lv.Model("driven", gravity=(0, 0, -9.81))
    rod = m.add_body("rod", lv.box(1, 0.05, 0.05, density=1000), position=(0, 0, -0.5), rotation_vector=(0, "90 deg", 0))
    pivot = m.add_revolute("pivot", "world", rod, at=(0, 0, 0), axis=(0, 1, 0))
    with pytest.raises(lv.InputError, match="no motion changes its energy"):
        lv.solve(m, 1, elements=24, periodic=True)
    free = lv.solve(m, lv.unknown(1.5), elements=16, method=lv.Lobatto(8), periodic=True,
                    start={"pivot.angle": "90 deg", "pivot.angle_rate": 0})
    inertia, k = (1 + 0.05**2) / 12 + 0.25, 7.416298709205487   # 4 K(1/2)
    assert free.success and free.unknowns["time.end"] == pytest.approx(k * np.sqrt(inertia / (9.81 * 0.5)), abs=1e-12)
    m.add_actuator("motor", pivot, inputs={"w": "pivot.angle_rate"}, expression="5*sin(2*pi*t) - 3*w")
    sol = lv.solve(m, 1, accuracy=1e-9, periodic=True)
    assert sol.success
    np.testing.assert_allclose(sol["rod"].velocity[0], sol["rod"].velocity[-1], atol=1e-8)
    later = lv.solve(m, 20, accuracy=1e-10)
    np.testing.assert_allclose(later["rod"].position[-1], sol["rod"].position[0], atol=1e-7)


def test_periodic_but_for_a_turn() -> None:
    m = lv.Model("string", gravity=(0, 0, -9.81))
    ball = m.add_body("ball", lv.point(mass=1), position=(np.sqrt(0.75), 0, -0.5), velocity=(0, 1.2, 0))
    m.add_rod("string", "world", ball)
    known = {"ball.z": -0.5, "ball.y": 0, "ball.vz": 0, "ball.vy": 1.2}
    sol = lv.solve(m, lv.unknown(1.18), elements=16, method=lv.Lobatto(8), periodic={"turn": lv.unknown(3.3)}, start=known)
    assert sol.success and sol.unknowns["time.end"] == pytest.approx(1.078197607767349, abs=1e-12)
    assert sol.unknowns["time.periodic.turn"] == pytest.approx(3.615084340317049, abs=1e-12)
    with pytest.raises(lv.InputError, match="not alike after a turn"):
        lv.solve(m, lv.unknown(1.18), elements=16, periodic={"turn": 3.3, "axis": (1, 0, 0)}, start=known)


def test_what_is_not_good_is_told(pendulum: lv.Model) -> None:
    coarse: dict[str, Any] = dict(elements=4, method="midpoint")
    with pytest.warns(lv.SolveWarning, match="suspect") as warned:
        sol = lv.solve(pendulum, 10, **coarse)
    assert not sol.success and sol.status == "suspect" and sol.reasons and "because" in repr(sol)
    assert warned[0].filename == __file__
    with pytest.raises(lv.SolveError, match="suspect") as error:
        lv.solve(pendulum, 10, strict=True, **coarse)
    partial = error.value.partial
    assert partial.t[-1] == 10 and not partial.success
    again = pickle.loads(pickle.dumps(error.value))
    assert (again.partial["rod"].position == partial["rod"].position).all()
    assert lv.solve(pendulum, 10, strict=True).success, "the control"


def test_what_ends_early_keeps_what_was_solved() -> None:
    m = lv.Model("fast")
    m.add_body("ball", lv.point(mass=1), position=(1, 0, 0))
    m.add_point_sensor("at", "ball")
    m.add_force("blow up", "ball", inputs={"x": "at.x"}, expression=("10*x^3", "0", "0"))
    with pytest.warns(lv.SolveWarning, match="it ends at"):
        sol = lv.solve(m, 5, elements=50)
    assert not sol.success and 0 < sol.t[-1] < 5 and len(sol["ball"].position) == len(sol.t)


INTERRUPTED = """
import os, signal, sys, threading, time
sys.path.insert(0, sys.argv[1])
signal.signal(signal.SIGINT, signal.default_int_handler)   # in the background it is ignored
import livens as lv
from test_solve import chain
assert signal.getsignal(signal.SIGINT) is signal.default_int_handler   # importing leaves signals alone
m = chain(12)
lv.solve(m, 0.1, elements=1)
sent = []
def press():
    time.sleep(float(sys.argv[2]))
    sent.append(time.perf_counter())
    os.kill(os.getpid(), signal.SIGINT)
threading.Thread(target=press).start()
try:
    WORK
    print("not interrupted")
except KeyboardInterrupt:
    print(time.perf_counter() - sent[0])
print(lv.solve(m, 0.1, elements=1).success)   # nothing is broken
"""


@pytest.mark.parametrize(("work", "after"), [
    ('lv.solve(m, 1000, elements=200000, estimate="none")', 0.5),
    ("lv.solve(chain(1), 10000, accuracy=1e-9)", 0.7),   # the long chain is soon beyond its horizon
    ('lv.solve_many(m, 100, elements=20000, variations=[{}] * 8, estimate="none")', 1.0),
    ('sol = lv.solve(m, 1, elements=200); sol(__import__("numpy").linspace(0, 1, 10**6))["rod 3"].quaternion', 0.7),
], ids=["march", "accuracy", "many", "samples"])
def test_ctrl_c_within_a_fifth_of_a_second(work: str, after: float) -> None:
    """Measured from the signal to KeyboardInterrupt, in a process of its own; the best of three on a busy machine."""
    delays = []
    for _ in range(3):
        done = subprocess.run([sys.executable, "-c", INTERRUPTED.replace("WORK", work), os.path.dirname(__file__),
                               str(after)], capture_output=True, text=True, timeout=120, check=True)
        delay, alive = done.stdout.split()
        assert alive == "True", done.stdout
        delays.append(float(delay))
        if delays[-1] < 0.2:
            break
    assert min(delays) < 0.2, delays


def test_ctrl_c_while_a_motion_is_judged() -> None:
    """The march is done by then: the first of two solutions tells how long it takes."""
    script = INTERRUPTED.replace("time.sleep(float(sys.argv[2]))", "time.sleep(after)").replace("sent = []", """
begin = time.perf_counter()
sol = lv.solve(m, 50, elements=10000, estimate="none")
after = sol.seconds + 0.4 * (time.perf_counter() - begin - sol.seconds)
sent = []""").replace("WORK", 'lv.solve(m, 50, elements=10000, estimate="none")')
    delays = []
    for _ in range(6):
        done = subprocess.run([sys.executable, "-W", "ignore", "-c", script, os.path.dirname(__file__), ""], text=True,
                              capture_output=True, timeout=120, check=False)
        if "not interrupted" in done.stdout:   # other work has slowed the first one alone
            continue
        assert done.returncode == 0, done.stderr   # the process ends in order
        delay, alive = done.stdout.split()
        assert alive == "True", done.stdout
        delays.append(float(delay))
        if delays[-1] < 0.2:
            break
    assert min(delays) < 0.2, delays


def test_ctrl_c_while_a_mesh_is_read(tmp_path: pathlib.Path) -> None:
    """20,000 shells in each other, which take seconds to be refused. The process ends when that is done."""
    corners = np.array([[1, 1, 1], [1, -1, -1], [-1, 1, -1], [-1, -1, 1]])[[[0, 1, 2], [0, 3, 1], [0, 2, 3], [1, 3, 2]]]
    faces = np.zeros((20000, 4), dtype=[("normal", "<f4", 3), ("corners", "<f4", (3, 3)), ("mark", "<u2")])
    faces["corners"] = (1 + np.arange(20000) / 20000)[:, None, None, None] * corners
    (tmp_path / "shells.stl").write_bytes(bytes(80) + (80000).to_bytes(4, "little") + faces.tobytes())
    (tmp_path / "shells.toml").write_text(
        'format = 1\n[[body]]\nname = "b"\ndensity = 1\nshape = { mesh = "shells.stl", unit = "m", turn = true }\n'
        "[time]\nend = 1\nelements = 1\n")
    script = INTERRUPTED.replace("WORK", f"lv.load({str(tmp_path / 'shells.toml')!r}).check()")
    done = subprocess.run([sys.executable, "-c", script, os.path.dirname(__file__), "0.5"], capture_output=True, text=True,
                          timeout=120, check=True)
    delay, alive = done.stdout.split()
    assert alive == "True" and float(delay) < 0.5, done.stdout


def test_progress(pendulum: lv.Model, capsys: pytest.CaptureFixture[str]) -> None:
    calls: list[tuple[int, int, float]] = []
    lv.solve(chain(6), 200, elements=40000, estimate="none", progress=lambda *state: calls.append(state))
    assert calls and all(0 <= done <= n for done, n, _ in calls) and sorted(calls) == calls

    class Stop(Exception):
        pass

    def stop(done: int, n: int, t: float) -> None:
        raise Stop

    with pytest.raises(Stop):
        lv.solve(chain(6), 50, elements=20000, progress=stop)
    lv.solve(chain(6), 200, elements=40000, estimate="none", progress=True)
    assert "elements" in capsys.readouterr().err


def test_other_threads_run_meanwhile() -> None:
    counted = [0]
    stop = threading.Event()

    def count() -> None:
        while not stop.is_set():
            counted[0] += 1
            time.sleep(0.002)

    thread = threading.Thread(target=count)
    thread.start()
    begin, before = time.perf_counter(), counted[0]
    lv.solve(chain(8), 20, elements=4000, estimate="none")
    ran, took = counted[0] - before, time.perf_counter() - begin
    stop.set()
    thread.join()
    assert ran > 0.2 * took / 0.003, (ran, took)


def test_two_threads_solve_the_same() -> None:
    m = chain(4)
    alone = lv.solve(m, 2, elements=200)["rod 3"].position
    with ThreadPoolExecutor(4) as pool:
        for sol in pool.map(lambda _: lv.solve(m, 2, elements=200), range(8)):
            assert (sol["rod 3"].position == alone).all()


def job(mass: float) -> lv.Solution:
    """For another process."""
    m = chain(2)
    m["rod 1"].mass = mass
    return lv.solve(m, 1, elements=20)


def test_models_and_solutions_go_to_other_processes() -> None:
    import multiprocessing
    with ProcessPoolExecutor(2, mp_context=multiprocessing.get_context("spawn")) as pool:
        for sol, mass in zip(pool.map(job, (1.0, 2.0, 3.0)), (1.0, 2.0, 3.0)):
            assert (sol["rod 1"].position == job(mass)["rod 1"].position).all()
            assert sol.model["rod 1"].mass == mass


@pytest.mark.filterwarnings("default")   # what others warn of is not ours
def test_models_and_solutions_go_through_dask() -> None:
    distributed = pytest.importorskip("distributed")
    with distributed.LocalCluster(n_workers=2, threads_per_worker=1, dashboard_address=None) as cluster, \
            distributed.Client(cluster) as client:
        sols = client.gather(client.map(job, (1.0, 2.0, 3.0)))
    for sol, mass in zip(sols, (1.0, 2.0, 3.0)):
        assert (sol["rod 1"].position == job(mass)["rod 1"].position).all()


def test_many() -> None:
    m = chain(2)
    masses = [0.5 + 0.1 * i for i in range(20)]
    many = lv.solve_many(m, 1, elements=20, variations=[{"rod 1.mass": mass} for mass in masses])
    for mass, sol in zip(masses, many):
        m["rod 1"].mass = mass
        alone = lv.solve(m, 1, elements=20)
        assert (sol["rod 1"].position == alone["rod 1"].position).all() and sol.model == alone.model
    one = lv.solve_many(m, 1, elements=20, threads=1, variations=[{"rod 1.mass": mass} for mass in masses])
    assert all((a.nodes == b.nodes).all() for a, b in zip(one, many)), "no bit depends on threads"
    assert [sol.t[-1] for sol in lv.solve_many([m, free_fall()], 1, elements=30)] == [1, 1]
    seen: list[tuple[int, int]] = []
    lv.solve_many(m, 3, elements=3000, variations=[{}] * 8, progress=lambda *at: seen.append(at))
    assert seen and seen[0][1] == 8
    assert lv.solve_many([], 1) == []


def test_many_tell_what_is_wrong() -> None:
    m = chain(1)
    with pytest.raises(lv.InputError, match="unknown key"):
        lv.solve_many(m, 1, variations=[{"rod 0.mas": 1}])
    with pytest.raises(lv.InputError, match="variation 1"):
        lv.solve_many(m, 1, elements=2, variations=[{}, {"pin 0.at": (1, 2, 3), "rod 0.mass": None}])
    with pytest.raises(KeyError, match="rod 0"):
        lv.solve_many(m, 1, variations=[{"rood 0.mass": 1}])
    with pytest.raises(TypeError):
        lv.solve_many(m, 1)
    with pytest.warns(lv.SolveWarning, match="1 of 2"):
        good, bad = lv.solve_many([short(m), m], elements=4, method="midpoint")
    assert good.success and not bad.success


def short(m: lv.Model) -> lv.Model:
    """A copy with little time to solve; the model itself gets much."""
    copy = m.copy()
    copy.time.end = 1e-3
    m.time.end = 10
    return copy


def test_threads_share_the_work() -> None:
    """Work is divided evenly: each of two threads has about half of the CPU time of all."""
    if (os.cpu_count() or 1) < 2:
        pytest.skip("one processor")
    m = chain(3)
    variations = [{"rod 1.mass": 1 + 0.01 * i} for i in range(200)]

    def cpu(threads: int) -> tuple[float, float]:
        own, all_of_them = time.thread_time(), time.process_time()
        lv.solve_many(m, 1, elements=160, variations=variations, threads=threads, estimate="none")
        return time.thread_time() - own, time.process_time() - all_of_them

    cpu(2)
    python, whole = cpu(2)
    assert python < 0.35 * whole, "what Python's thread does alone is little"


def test_second_solve_costs_little(pendulum: lv.Model) -> None:
    """The built model is kept: Python makes a few hundred calls for a second solution, not those of writing and reading."""
    def calls() -> int:
        n = 0

        def count(*_: Any) -> None:
            nonlocal n
            n += 1
        sys.setprofile(count)
        try:
            lv.solve(pendulum, 0.1, elements=1, estimate="none")
        finally:
            sys.setprofile(None)
        return n

    first, second = calls(), calls()
    assert second < 500 < first
    assert pendulum._built
    pendulum["rod"].density *= 2
    assert not pendulum._built, "an edit is seen"
    assert calls() > 2 * second, "a model that is built anew is noticed"


def test_hundreds_of_rounds_without_growth() -> None:
    resource = pytest.importorskip("resource")

    def rounds(n: int) -> int:
        for i in range(n):
            m = lv.Model("one", gravity=(0, 0, -9.81))
            m.add_body("rod", lv.box(1, 0.1, 0.1, mass=1 + i), position=(0.5, 0, 0))
            m.add_revolute("pivot", "world", "rod", at=(0, 0, 0), axis=(0, 1, 0))
            sol = lv.solve(m, 1, elements=20)
            sol["rod"].quaternion, sol["pivot"].force, sol.energy, sol(0.5)["rod"].velocity
            try:
                m.add_weld("x", "world", "y", at=(0, 0, 0))
            except lv.InputError:
                pass
        with open("/proc/self/statm", encoding="ascii") as stream:
            return int(stream.read().split()[1]) * int(resource.getpagesize())

    if not os.path.exists("/proc/self/statm"):
        pytest.skip("no /proc")
    after_100, after_400 = rounds(100), rounds(300)
    assert after_400 - after_100 < 1000 * 300, (after_100, after_400)


def test_examples_of_the_report_of_people() -> None:
    """The four-bar with a motor and a return spring, and what its bearings feel."""
    m = lv.load(ROOT / "examples" / "four_bar.toml")
    t = np.linspace(0, 5, 21)
    m["crank"].density = "7800 kg/m^3"
    m.add_actuator("motor", "crank shaft", table=lv.table(t, 2 * np.sin(t), "spline"))
    m.add_spring("return", ("world", (1, 0, 0.2)), ("rocker", (0.2, 0, 0)), stiffness=800, damping=3, free_length=0.3)
    assert m.check() == []
    sol = lv.solve(m, (0, 2), elements=100)
    peak = max(m.joints, key=lambda j: float(np.linalg.norm(sol[j].force, axis=1).max()))
    assert sol[peak].unique is False and any(peak in note or "unique" in note for note in sol.notes)
    assert sol.loads["return"].readings["length"] == "m" and sol["motor"].power.shape == sol.t.shape
    variant = m.copy()
    variant["coupler"].density *= 0.5
    assert variant != m
    assert lv.compare(sol, lv.solve(variant, (0, 2), elements=100)).largest["coupler"]["position"] > 1e-3


def test_warnings_of_models_are_shown_once(pendulum: lv.Model) -> None:
    pendulum.add_force("never", "rod", value=(1, 0, 0), from_=5, until=6)
    assert [d.code for d in pendulum.check()] in ([], ["load-never-acts"])
    with warnings.catch_warnings(record=True) as seen:
        warnings.simplefilter("always")
        lv.solve(pendulum, 1, elements=10)
        lv.solve(pendulum, 1, elements=10)
    assert [w.category for w in seen] == [lv.ModelWarning] and "load-never-acts" in str(seen[0].message)


def test_a_motor_alone_moves_the_start(pendulum: lv.Model) -> None:
    pendulum.add_joint_drive("motor", "pivot", rate="60 rpm")
    with pytest.warns(lv.ModelWarning, match="start-driven") as seen:
        sol = lv.solve(pendulum, 0.1, elements=4)
    assert len(seen) == 1 and "'motor'" in str(seen[0].message)
    assert abs(sol["pivot"].angle_rate - 2 * np.pi).max() < 1e-12
    asked = pendulum.copy()
    asked.start.initial = "project"
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        assert np.array_equal(lv.solve(asked, 0.1, elements=4)["pivot"].angle, sol["pivot"].angle)
    refused = pendulum.copy()
    refused["rod"].velocity = (0, 0, 0)   # a word on velocities: nothing is guessed
    with pytest.raises(lv.InputError, match="start-velocity"):
        lv.solve(refused, 0.1, elements=4)


def test_a_differential_shares_its_torque() -> None:
    m = lv.Model("differential")
    for name in ("left", "right", "carrier"):
        m.add_body(name, mass=1, inertia=(0.2, 0.2, 0.2))
        m.add_revolute(f"{name} axle", "world", name, at=(0, 0, 0), axis=(0, 0, 1))
    added = m.add_coupling("gears", {"left axle.angle": 1, "right axle.angle": 1, "carrier axle.angle": -2})
    m.add_torque("engine", "carrier", value=(0, 0, 3))
    m.add_torque("brake", "left", value=(0, 0, -1))
    assert added.terms == {"left axle.angle": 1, "right axle.angle": 1, "carrier axle.angle": -2}
    sol = lv.solve(m, 5, accuracy=1e-10)
    # with l = c + d and r = c - d: 3 J c'' = 3 - 1 and 2 J d'' = -1
    mean, half = (3 - 1) / 0.6, -1 / 0.4
    assert sol["carrier axle"].angle[-1] == pytest.approx(mean * 12.5, rel=1e-11)
    assert sol["left axle"].angle[-1] == pytest.approx((mean + half) * 12.5, rel=1e-11)
    assert sol["gears"].torque[-1, 2] == pytest.approx(0.2 * mean - 3, rel=1e-11)   # on the carrier, named last
    with pytest.raises(lv.InputError, match="would lock it") as caught:
        m.add_coupling("one", {"left axle.angle": 1})
    assert caught.value.code == "coupling-terms"
