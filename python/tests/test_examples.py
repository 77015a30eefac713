# SPDX-License-Identifier: BSD-3-Clause
"""Every example: the same model by every way, the same bytes as the program's."""
from __future__ import annotations

import copy
import pathlib
import pickle
import subprocess

import pytest
from conftest import EXAMPLES, ROOT

import livens as lv
from livens._tree import toml


def test_there_are_examples() -> None:
    assert len(EXAMPLES) > 15


@pytest.mark.parametrize("file", EXAMPLES, ids=lambda f: f.stem)
class TestEvery:
    def test_model_round_trips(self, file: pathlib.Path, tmp_path: pathlib.Path) -> None:
        m = lv.load(file)
        assert m.check() == []
        assert m.to_toml().encode() == file.read_bytes(), "a model that was not edited keeps its comments"
        anew = lv.load(text=toml(m._root))   # as edited ones are written
        assert anew == m and hash(anew) == hash(m)
        assert pickle.loads(pickle.dumps(m)) == m and copy.deepcopy(m) == m and copy.copy(m) == m
        m.to_toml(tmp_path / "again.toml")
        assert (tmp_path / "again.toml").read_bytes() == file.read_bytes()
        m.title = "another"
        assert m != anew

    def test_tree_is_read_as_the_text_is(self, file: pathlib.Path) -> None:
        """The same scenario from Python's containers as from the text that these are written as."""
        m = lv.load(file)
        text = toml(m._root)
        from_tree = m._build({"title": m.title} if m.title else {"gravity": tuple(map(float, m.gravity))})[0]
        from_text = lv.load(text=text)._build({})[0]
        assert from_tree.resolved == from_text.resolved


QUICK = ["four_bar", "furuta_pendulum", "slider_crank", "simple_pendulum", "two_point", "torque_free_top",
         "double_pendulum_blocks", "spring_mass"]


@pytest.mark.parametrize("name", QUICK)
def test_saved_bytes_are_the_programs(name: str, program: str, tmp_path: pathlib.Path) -> None:
    file = ROOT / "examples" / f"{name}.toml"
    subprocess.run([program, "solve", str(file), "--output", "theirs.nc", "--quiet"], cwd=tmp_path, check=False,
                   stderr=subprocess.DEVNULL)
    lv.solve(lv.load(file)).save(tmp_path / "ours.nc")
    assert (tmp_path / "ours.nc").read_bytes() == (tmp_path / "theirs.nc").read_bytes()


def test_bytes_of_an_edited_model_are_the_programs(program: str, tmp_path: pathlib.Path) -> None:
    """Of a tree that was built by calls, and of the file that it is written to."""
    m = lv.load(ROOT / "examples" / "four_bar.toml")
    m["crank"].density = "7800 kg/m^3"
    m.add_sensor("tip", "point", body="crank", point=(0.42, 0, 0))
    m.to_toml(tmp_path / "edited.toml")
    subprocess.run([program, "solve", "edited.toml", "--output", "theirs.nc", "--quiet"], cwd=tmp_path, check=True)
    sol = lv.solve(m)
    sol.save(tmp_path / "ours.nc")
    assert (tmp_path / "ours.nc").read_bytes() == (tmp_path / "theirs.nc").read_bytes()
    read = lv.load_solution(tmp_path / "theirs.nc")
    assert read.model == m
    assert (read["tip"].x == sol["tip"].x).all() and (read.t == sol.t).all()
    m["crank"].density = "7801 kg/m^3"   # the control
    lv.solve(m).save(tmp_path / "other.nc")
    assert (tmp_path / "other.nc").read_bytes() != (tmp_path / "theirs.nc").read_bytes()
