# SPDX-License-Identifier: BSD-3-Clause
"""Meshes whose files lie anywhere, and those that the core does not read."""
import pathlib
import pickle

import livens as lv
import pytest

BOX = """v 0 0 0
v 1 0 0
v 0 2 0
v 1 2 0
v 0 0 3
v 1 0 3
v 0 2 3
v 1 2 3
f 1 3 4 2
f 5 6 8 7
f 1 2 6 5
f 3 7 8 4
f 1 5 7 3
f 2 4 8 6
"""


@pytest.fixture
def box(tmp_path: pathlib.Path) -> pathlib.Path:
    file = tmp_path / "far" / "box.obj"
    file.parent.mkdir()
    file.write_text(BOX)
    return file


def of(mesh: lv.Shape) -> lv.Model:
    m = lv.Model("one")
    m.add_body("b", mesh, velocity=(1, 0, 0))
    return m


def mass(m: lv.Model) -> float:
    return float(lv.solve(m, 0.1)["b"].linear_momentum[0, 0])


def test_lie_anywhere_and_the_result_keeps_them(box: pathlib.Path, tmp_path: pathlib.Path, monkeypatch: pytest.MonkeyPatch) -> None:
    m = of(lv.mesh(box, unit="m", density=1))
    assert mass(m) == pytest.approx(6, rel=1e-14)
    sol = lv.solve(m, 0.1)
    sol.save(tmp_path / "run.nc")
    box.unlink()
    again = lv.load_solution(tmp_path / "run.nc")
    assert again["b"].position.tolist() == sol["b"].position.tolist()
    sol.report(tmp_path / "run.html")
    # A path below the model's folder stays one.
    monkeypatch.chdir(tmp_path)
    box.write_text(BOX)
    inside = of(lv.mesh("far/box.obj", unit="m", density=1))
    assert 'mesh = "far/box.obj"' in inside.to_toml()
    assert lv.solve(inside, 0.1)["b"].position.tolist() == sol["b"].position.tolist()
    assert lv.solve(of(lv.mesh("../" + tmp_path.name + "/far/box.obj", unit="m", density=1)), 0.1).success


def test_are_drawn_copied_pickled_and_solved_many_times(box: pathlib.Path) -> None:
    m = lv.Model("one")
    m.add_body("b", mass=1, inertia=(1, 1, 1), visual=[lv.visual(lv.mesh(box, unit="m"), color="red")])
    m.world.visual = lv.mesh(box, unit="mm")
    for other in (m.copy(), pickle.loads(pickle.dumps(m))):
        assert other == m
        assert lv.solve(other, 0.1).success
    assert all(sol.success for sol in lv.solve_many([m, m.copy()], 0.1))
    whole = lv.Model("whole")
    whole.add(m, "left ")
    assert lv.solve(whole, 0.1).success


def test_are_written_beside_a_scenario(box: pathlib.Path, tmp_path: pathlib.Path) -> None:
    m = of(lv.mesh(box, unit="m", density=1))
    target = tmp_path / "out"
    target.mkdir()
    m.to_toml(target / "one.toml")
    assert sorted(f.name for f in target.iterdir())[0].startswith("box-")
    assert mass(lv.load(target / "one.toml")) == pytest.approx(6, rel=1e-14)
    copied = next(f for f in target.iterdir() if f.suffix == ".obj")
    copied.write_text("v 0 0 0\n")
    with pytest.raises(FileExistsError):
        m.to_toml(target / "two.toml")


def test_of_strangers_stay_below_their_folder(box: pathlib.Path, tmp_path: pathlib.Path) -> None:
    m = of(lv.mesh(box, unit="m", density=1))
    with pytest.raises(lv.InputError, match="mesh-file"):
        lv.load(text=m.to_toml())
    for path in (str(box), "../box.obj"):
        text = m.to_toml().replace([line for line in m.to_toml().split('"') if line.startswith("box-")][0], path)
        with pytest.raises(lv.InputError, match="mesh-path"):
            lv.load(text=text)


def test_that_do_not_exist_or_are_of_no_kind_are_told(box: pathlib.Path, tmp_path: pathlib.Path) -> None:
    with pytest.raises(FileNotFoundError):
        lv.mesh(tmp_path / "none.stl", unit="m")
    other = tmp_path / "box.xyzzy"
    other.write_text("nothing")
    with pytest.raises(lv.InputError, match="trimesh"):
        lv.mesh(other, unit="m")


def test_of_other_formats_are_read_by_trimesh(box: pathlib.Path, tmp_path: pathlib.Path) -> None:
    trimesh = pytest.importorskip("trimesh")
    file = tmp_path / "box.glb"
    trimesh.load(box, force="mesh").export(file)
    m = of(lv.mesh(file, unit="m", density=1))
    assert mass(m) == pytest.approx(6, rel=1e-7)
