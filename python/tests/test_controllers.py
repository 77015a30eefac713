# SPDX-License-Identifier: BSD-3-Clause
"""Controllers: states beside the motion."""

from typing import Any

import numpy as np
import pytest

import livens as lv


def arm(**keys: Any) -> lv.Model:
    m = lv.Model("arm", gravity=(0, 0, -9.81))
    m.add_body("arm", mass=2, inertia=(0.02, 0.02, 0.01), position=(0, 0, -0.4))
    m.add_revolute("pin", "world", "arm", at=(0, 0, 0), axis=(0, 1, 0))
    m.add_controller("pid", inputs={"q": "pin.angle"}, **keys)
    m.add_actuator("shaft", joint="pin", expression="pid.u")
    return m


def test_states_are_read_as_sensors_are() -> None:
    m = arm(states={"i": "0.5 - q"}, outputs={"u": "60*(0.5 - q) + 40*i"}, start={"i": 0.1})
    sol = lv.solve(m, 1, accuracy=1e-9)
    assert sol.success
    assert sol["pid"].i[0] == pytest.approx(0.1, abs=1e-15)
    # The integral is that of the angle, and the output what its formula says.
    integral = 0.1 + np.trapezoid(0.5 - sol(np.linspace(0, 1, 20001))["pin"].angle, np.linspace(0, 1, 20001))
    assert sol["pid"].i[-1] == pytest.approx(integral, abs=1e-6)
    assert sol["pid"].u[-1] == pytest.approx(60*(0.5 - sol["pin"].angle[-1]) + 40*sol["pid"].i[-1], abs=1e-9)
    assert list(sol.bodies) == ["arm"]
    assert m.controllers["pid"].start == {"i": 0.1}


def test_rest_has_states() -> None:
    rest = arm(states={"i": "0.5 - q"}, outputs={"u": "6*(0.5 - q) + 40*i"}).find_equilibrium()
    assert rest.success
    assert rest.states["pid.i"] == pytest.approx(2*9.81*0.4*np.sin(0.5)/40, rel=1e-12)


def test_a_motion_from_rest_stays_there() -> None:
    m = arm(states={"i": "0.5 - q"}, outputs={"u": "60*(0.5 - q) + 40*i"}, start={"i": -0.3})
    rest = m.find_equilibrium()
    sol = lv.solve(m, 2, accuracy=1e-9, start=rest.state)
    assert np.ptp(sol["pid"].i) < 1e-8 and np.ptp(sol["pin"].angle) < 1e-8
    assert np.ptp(lv.solve(m, 2, accuracy=1e-9)["pid"].i) > 0.01   # as the model starts


def test_sampled_values_are_held() -> None:
    m = arm(states={"n": "n + 1"}, outputs={"u": "0*q + n"}, every=0.1)
    sol = lv.solve(m, 1, accuracy=1e-6)
    t = np.array([0.0, 0.05, 0.15, 0.95])
    assert sol(t)["pid"].n == pytest.approx([1, 1, 2, 10], abs=1e-12)
    assert sol(t)["pid"].u == pytest.approx([0, 0, 1, 9], abs=1e-12)


def test_wrong_names_are_told() -> None:
    with pytest.raises(lv.InputError, match="no such state or output"):
        m = arm(states={"i": "0.5 - q"}, outputs={"v": "i"})
        lv.solve(m, 1)
