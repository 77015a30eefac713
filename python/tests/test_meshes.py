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


def test_files_that_a_model_names_go_with_its_scenario(tmp_path: pathlib.Path) -> None:
    """By a folder of their own, from a scenario and out of a URDF; results are the same bytes."""
    near, far = tmp_path / "near", tmp_path / "far"
    (near / "meshes").mkdir(parents=True)
    (near / "meshes/box.obj").write_text(BOX)
    (near / "part.toml").write_text('format = 1\n[[body]]\nname = "p"\nmass = 1\ninertia = [1, 1, 1]\nposition = [9, 0, 0]\n'
                                    'visual = { mesh = "meshes/box.obj", unit = "m" }\n')
    text = ('format = 1\n[[include]]\nfile = "part.toml"\n[[body]]\nname = "b"\nshape = { mesh = "meshes/box.obj", unit = "m" }\n'
            'density = 2\nangular_velocity = [1, 2, 0]\n[time]\nend = 0.1\n')
    (near / "one.toml").write_text(text)
    m = lv.load(near / "one.toml")
    assert m.to_toml(far / "one.toml") == text
    assert sorted(p.name for p in far.rglob("*") if p.is_file()) == ["box.obj", "one.toml", "part.toml"]
    again = lv.load(far / "one.toml")
    lv.solve(m).save(tmp_path / "a.nc")
    lv.solve(again).save(tmp_path / "b.nc")
    assert (tmp_path / "a.nc").read_bytes() == (tmp_path / "b.nc").read_bytes()
    m.to_toml(far / "one.toml")   # all is there
    (far / "meshes/box.obj").write_text("else")
    with pytest.raises(FileExistsError, match="would replace one of other content"):
        m.to_toml(far / "one.toml")
    assert (near / "meshes/box.obj").read_text() == BOX


def test_meshes_of_packages_go_with_the_scenario_of_a_robot(tmp_path: pathlib.Path) -> None:
    package, robot, far = tmp_path / "package", tmp_path / "robot", tmp_path / "far"
    package.mkdir()
    robot.mkdir()
    (package / "box.obj").write_text(BOX)
    (robot / "r.urdf").write_text(
        '<robot name="r"><link name="w"/><link name="a"><inertial><mass value="1"/><inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/>'
        '</inertial><visual><geometry><mesh filename="package://p/box.obj"/></geometry></visual></link>'
        '<joint name="j" type="continuous"><parent link="w"/><child link="a"/></joint></robot>')
    m = lv.from_urdf(robot / "r.urdf", packages={"p": package}, rates={"j": 1})
    m.time.end = 0.1
    m.to_toml(far / "r.toml")
    assert (far / "package/box.obj").read_text() == BOX
    lv.solve(m).save(tmp_path / "a.nc")
    lv.solve(lv.load(far / "r.toml")).save(tmp_path / "b.nc")
    assert (tmp_path / "a.nc").read_bytes() == (tmp_path / "b.nc").read_bytes()
    m.to_toml(tmp_path / "r.toml")   # meshes are where the text has them
    assert sorted(p.name for p in tmp_path.iterdir()) == ["a.nc", "b.nc", "far", "package", "r.toml", "robot"]
