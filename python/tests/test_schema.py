# SPDX-License-Identifier: BSD-3-Clause
"""The JSON Schema in the hands of editors: what is right passes, and a slip is one error that names it."""
from __future__ import annotations

import json
import os
import pathlib
import shutil
import subprocess
import sys
from typing import Any

import pytest

if sys.version_info < (3, 11):
    pytest.skip("tomllib is of Python 3.11", allow_module_level=True)
import tomllib

ROOT = pathlib.Path(__file__).resolve().parents[2]
PROGRAM = os.environ.get("LIVENS_PROGRAM", "")
TAPLO = shutil.which("taplo", path=str(pathlib.Path(sys.executable).parent))
GOOD = [*sorted((ROOT / "examples").glob("*.toml")), *sorted((ROOT / "tests" / "fuzz" / "corpus").glob("every_key*.toml"))]
ARM = """#:schema ./livens.schema.json
format = 1
[[body]]
name = "arm"
shape = { box = [1, "5 cm", 0.05] }
mass = "3 kg"
position = [0.5, 0, 0]
[[joint]]
name = "shaft"
type = "revolute"
between = ["world", "arm"]
at = [0, 0, 0]
axis = [0, 1, 0]
[[load]]
type = "actuator"
joint = "shaft"
value = 1
[time]
end = 2
"""
SLIPS = [("mass =", "masss =", "masss"), ("revolute", "hinge", "hinge"), ("value = 1", "value = [1]", "value"),
         ("axis = [0, 1, 0]", "axis = [0, 1, 0]\npitch = 1", "pitch"), ("at = [0, 0, 0]", "at = 1", "at"),
         ("end = 2", "end = 2\nstep = 1", "step"), ("box =", "boks =", "boks"), ('"3 kg"', '"3 kg?"', "3 kg?"), ('"3 kg"', '"3"', "3"),
         ('["world", "arm"]', '["arm"]', "between"), ("end = 2", "end = 2\n[[repeat]]\ncount = 2\nbodies = []", "bodies"), ("format = 1", "format = 2", "format")]


@pytest.fixture(scope="module")
def schema() -> Any:
    if not PROGRAM or not os.path.exists(PROGRAM):
        pytest.skip("the program is not built")
    return json.loads(subprocess.run([PROGRAM, "schema", "--json"], capture_output=True, check=True).stdout)


@pytest.fixture(scope="module")
def validator(schema: Any) -> Any:
    return pytest.importorskip("jsonschema").Draft202012Validator(schema)


def test_what_is_right_passes(validator: Any) -> None:
    assert len(GOOD) > 20
    for text in [*(file.read_text() for file in GOOD), ARM]:
        assert [error.message for error in validator.iter_errors(tomllib.loads(text))] == []


@pytest.mark.parametrize("text", ["2*L", "L", "-L", "-(L + 30 mm)/2", "sqrt(2)*L", "2*0.5 m", "L/2 + 30 mm", "7850 kg/m^3",
                                  "5\u00a0mm", "30\u00b0", "2\u00b73 m", "(i-0.5)*L", "{i}*L", "3 1/s", "1.5e-3 kN/mm", "\u22125 mm",
                                  "2 N m^-1", "atan2(a, -b)", "kg/(m s)*2", "3 kg/(m s)"])
def test_computed_numbers_pass(validator: Any, text: str) -> None:
    for key, value in (("mass", text), ("position", [text, 0, 0])):
        assert not list(validator.iter_errors(tomllib.loads(ARM) | {"body": [{"name": "arm", key: value}]}))


@pytest.mark.parametrize("right, wrong, named", SLIPS)
def test_a_slip_is_one_error_at_its_place(validator: Any, right: str, wrong: str, named: str) -> None:
    assert right in ARM
    errors = list(validator.iter_errors(tomllib.loads(ARM.replace(right, wrong))))
    assert len(errors) == 1
    assert named in f"{list(errors[0].absolute_path)} {errors[0].message}"


def taplo(folder: pathlib.Path, text: str) -> list[str]:
    """Its errors, a line each, and the line of the file below."""
    assert TAPLO is not None
    (folder / "arm.toml").write_text(text)
    done = subprocess.run([TAPLO, "check", "--colors", "never", "arm.toml"], cwd=folder, capture_output=True, text=True, check=False)
    found = done.stderr.split("error: ")[1:]
    assert (done.returncode == 0) == (not found), done.stderr
    return found


@pytest.mark.skipif(TAPLO is None, reason="taplo is not installed")
def test_taplo_names_slips_once(schema: Any, tmp_path: pathlib.Path) -> None:
    (tmp_path / "livens.schema.json").write_text(json.dumps(schema))
    assert taplo(tmp_path, ARM) == []
    both = taplo(tmp_path, ARM.replace("mass =", "masss =").replace("revolute", "hinge"))
    assert len(both) == 2 and "masss" in both[0] and "hinge" in both[1], both
    for right, wrong, named in SLIPS:
        found = taplo(tmp_path, ARM.replace(right, wrong))
        # It repeats an error at each item of a list.
        assert 1 <= len(found) <= 5 and any(named in part for part in found), (wrong, found)
