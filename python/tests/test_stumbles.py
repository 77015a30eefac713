# SPDX-License-Identifier: BSD-3-Clause
"""What new users try, and what they are told."""
from __future__ import annotations

import pickle
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

import livens as lv


@pytest.fixture
def sol(pendulum: lv.Model) -> lv.Solution:
    return lv.solve(pendulum, 1, elements=10)


def test_numbers_of_numpy(pendulum: lv.Model) -> None:
    for value in (np.longdouble(0.5), np.float16(0.5), np.float32(0.5), np.array(0.5)):
        pendulum["rod"].mass = value   # type: ignore[assignment,unused-ignore]
        assert pendulum["rod"].mass == 0.5
    with pytest.raises(lv.InputError) as raised:
        pendulum["rod"].mass = 10 ** 400
    assert raised.value.code == "number-overflow"


def test_bodies_that_are_none(pendulum: lv.Model) -> None:
    for ends, word in (((None, "rod"), "first"), (("rod", None), "second")):
        with pytest.raises(lv.InputError, match=f"the {word} body is None") as raised:
            pendulum.add_revolute("other", *ends, at=(0, 0, 0), axis=(0, 1, 0))
        assert raised.value.code == "missing-key" and "world" in raised.value.help


def test_functions_as_values_are_shown_the_way(pendulum: lv.Model) -> None:
    with pytest.raises(lv.InputError, match="m.add_function"):
        pendulum.add_force("push", "rod", value=lambda t: (0, 0, t))   # type: ignore[arg-type]


def test_an_end_that_says_too_little_is_told_in_python(pendulum: lv.Model) -> None:
    with pytest.raises(lv.InputError, match=r"end=lv.state\(\{'rod'") as raised:
        lv.solve(pendulum, 1, end="state")
    assert raised.value.code == "missing-key" and raised.value.file == __file__


def test_a_class_is_no_method(pendulum: lv.Model) -> None:
    with pytest.raises(TypeError, match="the class Lobatto"):
        lv.solve(pendulum, 1, method=lv.Lobatto)   # type: ignore[arg-type]


def test_handles_go_with_their_model(pendulum: lv.Model) -> None:
    rod, model = pickle.loads(pickle.dumps((pendulum["rod"], pendulum)))
    assert rod == model["rod"] and rod.density == 7850
    assert pickle.loads(pickle.dumps(pendulum["pivot"])).name == "pivot"
    with pytest.raises(TypeError, match="pickle the model"):
        pickle.dumps(pendulum["rod"].shape)


def test_what_is_no_solution_is_told(sol: lv.Solution, pendulum: lv.Model) -> None:
    calls: list[tuple[Callable[[], Any], type[Exception], str]] = [
        (lambda: lv.compare(sol, None), TypeError, "two solutions, not NoneType"),
        (lambda: lv.compare(pendulum, sol), TypeError, "two solutions, not Model"),
        (lambda: lv.compare(sol(0.5), sol), TypeError, "two solutions, not Series"),
        (lambda: pickle.dumps(sol(0.5)), TypeError, "pickle the solution"),
        (lambda: list(sol), TypeError, "not iterable"),   # type: ignore[call-overload]
        (lambda: sol["rod"].pos, AttributeError, "'rod' has no 'pos'.*position"),
        (lambda: sol.plot(3), TypeError, "takes names"),   # type: ignore[arg-type]
        (lambda: sol.plot("rod"), KeyError, "which array of 'rod'.*'rod.position'"),
        (lambda: sol.plot("rod.position.w"), KeyError, "rod.position"),
    ]
    for call, kind, words in calls:
        with pytest.raises(kind, match=words):
            call()
    assert "rod" in sol and "pivot" in sol and "rd" not in sol and pendulum["rod"] in sol and 3 not in sol


def test_instants_in_any_order_and_outside(sol: lv.Solution) -> None:
    t = np.array([0.9, 0.1, 0.55, 0.1, 1, 0])
    for exact in (False, True):
        some = sol(t, exact=exact)
        for i, instant in enumerate(t):
            one = sol(float(instant), exact=exact)
            assert np.array_equal(some["rod"].position[i], one["rod"].position)
            assert some["pivot"].angle[i] == one["pivot"].angle
        for outside in (-0.1, 1.1, float("nan")):
            with pytest.raises(lv.InputError) as raised:
                sol(outside, exact=exact)
            assert raised.value.code == "time-outside" and "0 to 1" in str(raised.value)


def test_plots_of_components_and_triads(sol: lv.Solution) -> None:
    plt = pytest.importorskip("matplotlib.pyplot")
    plt.switch_backend("Agg")
    names = {"rod.directors": "d2.z", "rod.rigidity_stress": "23", "rod.quaternion": "w", "rod.velocity": "z"}
    for what, label in names.items():
        assert label in [text.get_text() for text in sol.plot(what)[0].get_legend().get_texts()]
    for what, array in (("rod.position.z", sol["rod"].position[:, 2]), ("rod.quaternion.x", sol["rod"].quaternion[:, 1])):
        axis, = sol.plot(what, at="ends")
        assert len(axis.lines) == 1 and np.array_equal(axis.lines[0].get_ydata(), array)
    assert sol(0.5).plot("rod.position")[0].lines[0].get_marker() == "o", "one instant is a point"
    plt.close("all")
