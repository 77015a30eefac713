# SPDX-License-Identifier: BSD-3-Clause
"""Couples between two bodies: `reaction` of a torque."""
from __future__ import annotations

from typing import Any

import numpy as np
import pytest

import livens as lv


def two_bodies() -> lv.Model:
    """Two boxes in free space that tumble, without a joint."""
    m = lv.Model(gravity=(0, 0, 0))
    m.add_body("ship", shape=lv.box(0.4, 0.3, 0.2), mass=3, angular_velocity=(0.2, -0.4, 0.3))
    m.add_body("wheel", shape=lv.box(0.2, 0.2, 0.05), mass=1, position=(1, 0, 0), angular_velocity=(0.5, 0.1, 2))
    return m


def angular_momentum(sol: lv.Solution, body: str, inertia: np.ndarray) -> np.ndarray:
    """About the body's own centre, (samples, 3), world axes."""
    axes = np.asarray(sol[body].directors)
    w = np.asarray(sol[body].angular_velocity)
    return np.array([a.T @ (inertia * (a @ v)) for a, v in zip(axes, w, strict=True)])


@pytest.mark.parametrize("frame", ["world", "body"])
@pytest.mark.parametrize("reaction", [True, False])
def test_a_couple_leaves_the_sum_of_angular_momenta(frame: Any, reaction: bool) -> None:
    m = two_bodies()
    m.add_torque("drive", "wheel", reaction="ship" if reaction else None, frame=frame, value=(0.05, 0, 0.4))
    sol = lv.solve(m, 2, accuracy=1e-10, output=0.25)
    ship = 3 / 12 * np.array([0.3**2 + 0.2**2, 0.4**2 + 0.2**2, 0.4**2 + 0.3**2])
    wheel = 1 / 12 * np.array([0.2**2 + 0.05**2, 0.2**2 + 0.05**2, 0.2**2 + 0.2**2])
    of_wheel = angular_momentum(sol, "wheel", wheel)
    total = of_wheel + angular_momentum(sol, "ship", ship)
    change = np.abs(total - total[0]).max()
    assert np.abs(of_wheel - of_wheel[0]).max() > 0.05
    assert change < 1e-9 if reaction else change > 0.05
    assert lv.load(text=m.to_toml()) == m


@pytest.mark.parametrize(("other", "code"), [("wheel", "load-self"), ("nobody", "body-unknown")])
def test_what_takes_no_reaction_is_refused(other: str, code: str) -> None:
    m = two_bodies()
    with pytest.raises(lv.InputError) as failed:
        m.add_torque("drive", "wheel", reaction=other, value=(0, 0, 1))
        lv.solve(m, 1)
    assert code in str(failed.value)


def test_a_point_takes_no_couple() -> None:
    m = two_bodies()
    m.add_body("mote", lv.point(mass=1), position=(0, 2, 0))
    with pytest.raises(lv.InputError, match="mote"):
        m.add_torque("drive", "wheel", reaction="mote", value=(0, 0, 1))
        lv.solve(m, 1)


def test_the_world_takes_whatever_it_is_given() -> None:
    to_world, alone = two_bodies(), two_bodies()
    to_world.add_torque("drive", "wheel", reaction="world", value=(0, 0, 1))
    alone.add_torque("drive", "wheel", value=(0, 0, 1))
    ends = [lv.solve(m, 1)["wheel"].angular_velocity[-1] for m in (to_world, alone)]
    assert np.array_equal(*ends)
