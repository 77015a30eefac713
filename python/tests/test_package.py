# SPDX-License-Identifier: BSD-3-Clause
"""What is installed: its size, and what one does first with it."""
from __future__ import annotations

import io
import pathlib
import subprocess
import sys
import zipfile

import pytest
from conftest import ROOT

import livens as lv


def test_wheel_has_not_grown() -> None:
    """The files of the package, compressed as zip does it usually; scripts/wheel does it harder."""
    folder = pathlib.Path(lv.__path__[0])
    files = [file for file in folder.rglob("*") if file.is_file() and file.suffix != ".pyc"]
    assert sum(file.suffix == ".so" for file in files) == 1
    packed = io.BytesIO()
    with zipfile.ZipFile(packed, "w", zipfile.ZIP_DEFLATED) as archive:
        for file in files:
            archive.write(file, file.relative_to(folder.parent))
    sizes = sorted(((info.compress_size, info.filename) for info in archive.infolist()), reverse=True)
    others = 10_000   # metadata and licence
    assert packed.tell() + others < 5_000_000, sizes[:5]
    assert packed.tell() > 500_000, "the engine and the page of reports are in there"


@pytest.mark.parametrize("module", ["", "matplotlib", "xarray"])
def test_first_page_runs(module: str) -> None:
    """With all that is there, and without."""
    hide = f"import sys; sys.modules[{module!r}] = None; " if module else ""
    if module:   # as find_spec() sees it
        hide += ("import importlib.util as u; find = u.find_spec; "
                 f"u.find_spec = lambda name, *rest: None if name == {module!r} else find(name, *rest); ")
    page = ROOT / "python" / "tests" / "first_page.py"
    code = f"{hide}import runpy; runpy.run_path({str(page)!r}, run_name='__main__')"
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    assert done.stdout == (f"left out: {module}\n" if module else "")
