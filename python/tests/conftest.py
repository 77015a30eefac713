# SPDX-License-Identifier: BSD-3-Clause
"""What tests share: models, places in the repository, the program."""
from __future__ import annotations

import os
import pathlib

import pytest

import livens as lv

ROOT = pathlib.Path(__file__).resolve().parents[2]
EXAMPLES = sorted((ROOT / "examples").glob("*.toml"))


@pytest.fixture
def pendulum() -> lv.Model:
    m = lv.Model("pendulum", gravity=(0, 0, -9.81))
    rod = m.add_body("rod", lv.box(1, 0.05, 0.05, density=7850), position=(0.5, 0, 0))
    m.add_revolute("pivot", "world", rod, at=(0, 0, 0), axis=(0, 1, 0))
    return m


@pytest.fixture
def program() -> str:
    name = os.environ.get("LIVENS_PROGRAM", str(ROOT / "build" / "release" / "livens"))
    if not os.access(name, os.X_OK):
        pytest.skip("the program is not built (LIVENS_PROGRAM)")
    return name
