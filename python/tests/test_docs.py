# SPDX-License-Identifier: BSD-3-Clause
"""Docstrings: complete, and their examples run; so do the guide's and the scripts of examples/python."""
from __future__ import annotations

import doctest
import importlib
import pathlib
import pkgutil
import re
import runpy
import subprocess
import sys
import warnings

import pytest
from conftest import ROOT

import livens as lv

MODULES = [name for _, name, _ in pkgutil.iter_modules(lv.__path__) if name not in ("_core",)]
SCRIPTS = sorted(file for file in (ROOT / "examples" / "python").glob("*.py") if file.stem != "many_runs")   # test_many_runs.py


@pytest.mark.parametrize("name", MODULES)
def test_examples_of_docstrings_run(name: str) -> None:
    module = importlib.import_module(f"livens.{name}")
    finder = doctest.DocTestFinder(exclude_empty=True)
    runner = doctest.DocTestRunner()
    for test in finder.find(module, f"livens.{name}"):
        runner.run(test)
    assert runner.failures == 0


def test_docstrings_are_complete() -> None:
    script = ROOT / "python" / "tests" / "check_docstrings.py"
    done = subprocess.run([sys.executable, str(script)], capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stdout + done.stderr


def test_incomplete_docstrings_are_found(monkeypatch: pytest.MonkeyPatch) -> None:
    """The control."""
    check = runpy.run_path(str(ROOT / "python" / "tests" / "check_docstrings.py"))

    def bare(model: object, time: object, other: object) -> None: ...

    def poor(model: object, time: object, other: object) -> None:
        """Says little of it.

        Args:
            model: What.
        """
    assert list(check["faults_of"]("bare", bare)) and len(list(check["faults_of"]("poor", poor))) == 2
    assert not list(check["faults_of"]("solve", lv.solve))


def test_blocks_of_the_guide_run(monkeypatch: pytest.MonkeyPatch, tmp_path: pathlib.Path) -> None:
    """All of them one after the other, in the folder of the examples' copies."""
    matplotlib = pytest.importorskip("matplotlib")
    pytest.importorskip("pandas")
    pytest.importorskip("xarray")
    matplotlib.use("Agg")
    for file in (ROOT / "examples").glob("*.toml"):
        (tmp_path / file.name).write_bytes(file.read_bytes())
    monkeypatch.chdir(tmp_path)
    guide = (ROOT / "docs" / "python.md").read_text(encoding="utf-8")
    blocks = re.findall(r"```python\n(.*?)```", guide, re.S)
    assert len(blocks) > 5
    space: dict[str, object] = {"__name__": "guide"}
    for block in blocks:
        exec(compile(block, "docs/python.md", "exec"), space)


@pytest.mark.parametrize("script", SCRIPTS, ids=lambda f: f.stem)
def test_scripts_run(script: pathlib.Path, monkeypatch: pytest.MonkeyPatch, tmp_path: pathlib.Path) -> None:
    pytest.importorskip("scipy")
    matplotlib = pytest.importorskip("matplotlib")
    matplotlib.use("Agg")
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr(sys, "argv", [str(script)])
    runpy.run_path(str(script), run_name="__main__")


def test_no_message_shows_a_type_of_cpp() -> None:
    """Wrong arguments of every public function: Python's words, or livens' own."""
    m = lv.Model("x")
    m.add_body("a", lv.sphere(1, mass=1))
    sol = lv.solve(m, 1, elements=1)
    calls = [lambda bad=bad, f=f: f(bad) for bad in (None, object(), b"", [], {}, 3.5, "x\0y")
             for f in (lv.solve, lv.load, lv.load_solution, lv.explain, lv.solve_many, sol.save, sol.export, m.add_body,
                       m.remove, sol, sol.to_dataframe, sol.plot, lv.compare, m.to_toml, lv.table)]
    seen = 0
    for call in calls:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            try:
                call()   # type: ignore[no-untyped-call]
            except Exception as error:
                seen += 1
                text = str(error)
                assert not re.search(r"std::|nanobind|livens::|_core\.|incompatible function arg", text), text
    assert seen > 60
