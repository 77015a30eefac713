# SPDX-License-Identifier: BSD-3-Clause
"""examples/python/many_runs.py by local processes: 10,000 runs, of which one fails, while a worker is killed."""
from __future__ import annotations

import importlib
import os
import pathlib
import signal
from types import ModuleType
from typing import Any

import numpy as np
import pytest

SCRIPT = pathlib.Path(__file__).parents[2] / "examples" / "python" / "many_runs.py"
pytestmark = pytest.mark.filterwarnings("default")   # what others warn of is not ours


@pytest.fixture
def script(monkeypatch: pytest.MonkeyPatch) -> ModuleType:
    pytest.importorskip("distributed")
    monkeypatch.syspath_prepend(str(SCRIPT.parent))   # workers are given this path, too
    module = importlib.import_module("many_runs")
    return module


def die_once(marker: str) -> str:
    """Takes its worker down, with all that it has, the first time."""
    if os.path.exists(marker):
        return "alive"
    pathlib.Path(marker).touch()
    os.kill(os.getpid(), signal.SIGKILL)
    return "dead"


def test_nothing_is_lost(script: ModuleType, tmp_path: pathlib.Path) -> None:
    distributed: Any = pytest.importorskip("distributed")
    folder = tmp_path / "runs"
    with distributed.LocalCluster(n_workers=2, threads_per_worker=1, dashboard_address=None) as cluster, \
            distributed.Client(cluster) as client:
        death = client.submit(die_once, str(tmp_path / "died"))
        files = script.sweep(client, folder)
        assert death.result() == "alive"
    assert (tmp_path / "died").exists()
    assert len(files) == script.RUNS // script.AT_ONCE
    angles, failed = script.read(folder)
    assert angles.size == script.RUNS
    assert list(np.flatnonzero(np.isnan(angles))) == [4321]
    assert len(failed) == 1 and failed[0].startswith("run 4321:") and "mass" in failed[0]
    assert not list(folder.glob("*.tmp")) or len(list(folder.glob("*.npz"))) == len(files)
    for run in (0, 4320, 9999):   # the same bits, wherever they come from
        assert angles[run] == script.one_run(run)[0]
    assert len(np.unique(angles[np.isfinite(angles)])) > 9990   # they differ


def test_what_is_there_is_not_done_again(script: ModuleType, tmp_path: pathlib.Path) -> None:
    distributed: Any = pytest.importorskip("distributed")
    kept = tmp_path / "00000.npz"
    np.savez(kept, angle=np.zeros(script.AT_ONCE), error=np.full(script.AT_ONCE, ""))
    with distributed.LocalCluster(n_workers=1, threads_per_worker=1, dashboard_address=None) as cluster, \
            distributed.Client(cluster) as client:
        script.sweep(client, tmp_path, 2)
    assert (script.read(tmp_path)[0][:script.AT_ONCE] == 0).all()
    assert len(list(tmp_path.glob("*.npz"))) == 2
