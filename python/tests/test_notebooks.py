# SPDX-License-Identifier: BSD-3-Clause
"""The notebooks of examples/notebooks run from their first cell to their last, as Jupyter would."""
from __future__ import annotations

import json
import os
import pathlib
from typing import Any

import pytest
from conftest import ROOT

NOTEBOOKS = sorted((ROOT / "examples" / "notebooks").glob("*.ipynb"))


def test_there_are_notebooks() -> None:
    assert len(NOTEBOOKS) >= 3


@pytest.mark.parametrize("file", NOTEBOOKS, ids=lambda f: f.stem)
def test_notebook_holds_no_outputs(file: pathlib.Path) -> None:
    book = json.loads(file.read_text(encoding="utf-8"))
    for cell in book["cells"]:
        assert cell.get("outputs", []) == [] and cell.get("execution_count") is None
    assert book["cells"][0]["source"][0].startswith("# "), "a title"


def run(book: Any, folder: pathlib.Path) -> list[dict[str, Any]]:
    """All outputs; raises what a cell raises."""
    nbclient = pytest.importorskip("nbclient")
    pytest.importorskip("ipykernel")
    nbclient.NotebookClient(book, timeout=300, kernel_name="python3",
                            resources={"metadata": {"path": str(folder)}}).execute()
    return [output for cell in book["cells"] for output in cell.get("outputs", [])]


@pytest.mark.filterwarnings("ignore")
@pytest.mark.parametrize("file", NOTEBOOKS, ids=lambda f: f.stem)
def test_notebook_runs(file: pathlib.Path, monkeypatch: pytest.MonkeyPatch, tmp_path: pathlib.Path) -> None:
    nbformat = pytest.importorskip("nbformat")
    monkeypatch.setenv("PYTHONWARNINGS", "error::livens.SolveWarning")
    monkeypatch.setenv("IPYTHONDIR", str(tmp_path))
    monkeypatch.setenv("PYTHONPATH", os.environ.get("PYTHONPATH", ""))
    outputs = run(nbformat.read(file, as_version=4), file.parent)
    data = [output.get("data", {}) for output in outputs]
    assert any("image/png" in d for d in data), "a plot"
    assert any("<iframe" in d.get("text/html", "") for d in data), "a report inline"
    assert not any(output.get("name") == "stderr" for output in outputs), outputs


@pytest.mark.filterwarnings("ignore")
def test_wrong_cell_is_told(tmp_path: pathlib.Path) -> None:
    """The control; and what a notebook shows of an error is the line of its cell."""
    nbformat = pytest.importorskip("nbformat")
    v4 = nbformat.v4
    wrong = "import livens as lv\nm = lv.Model()\nm.add_body('rod', lv.box(1, 1, 1),\n           mass='2 s')"
    book = v4.new_notebook(cells=[v4.new_code_cell(wrong)])
    nbclient = pytest.importorskip("nbclient")
    with pytest.raises(nbclient.exceptions.CellExecutionError, match=r"mass='2 s'\)\n +\| +\^\^\^\^\^"):
        run(book, tmp_path)
