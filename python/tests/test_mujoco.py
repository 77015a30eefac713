# SPDX-License-Identifier: BSD-3-Clause
"""What lv.from_mjcf says where MuJoCo is not installed; tests/models has the rest."""
from __future__ import annotations

import importlib.util
import sys

import pytest

import livens as lv


def test_without_mujoco_it_says_what_to_install(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "mujoco", None)
    with pytest.raises(ImportError, match=r"from_mjcf needs mujoco: pip install 'livens\[mujoco\]'"):
        lv.from_mjcf("robot.xml")


@pytest.mark.skipif(importlib.util.find_spec("mujoco") is None, reason="mujoco is not installed; scripts/models tries more")
def test_a_pendulum_swings() -> None:
    m = lv.from_mjcf("<mujoco><worldbody><body name='rod'><joint name='hinge' axis='0 1 0'/><geom size='.1' pos='.5 0 0'/>"
                     "</body></worldbody></mujoco>")
    assert lv.solve(m, 1).success
