# SPDX-License-Identifier: BSD-3-Clause
"""Results: views, shapes, units, other libraries, files."""
from __future__ import annotations

import gc
import gzip
import pathlib
import pickle
import subprocess
import json
from typing import Any

import numpy as np
import pytest
from conftest import ROOT

import livens as lv


@pytest.fixture(scope="module")
def sol() -> lv.Solution:
    m = lv.load(ROOT / "examples" / "four_bar.toml")
    m.add_point_sensor("tip", "crank", point=(0.42, 0, 0))
    m.add_energy_sensor("of crank", "crank")
    m.add_spring("return", ("world", (1, 0, 0.2)), ("rocker", (0.2, 0, 0)), stiffness=800, free_length=0.3)
    return lv.solve(m, 2)


def test_views_copy_nothing_and_keep_their_owner(pendulum: lv.Model) -> None:
    sol = lv.solve(pendulum, 1, elements=10)
    position, velocity, t = sol["rod"].position, sol["rod"].velocity, sol.t
    assert np.shares_memory(position, sol.nodes) and np.shares_memory(position, sol["rod"].position)
    assert not position.flags.writeable and not sol["rod"].quaternion.flags.writeable and not sol.energy.flags.writeable
    for array in (position, sol["rod"].quaternion, sol["pivot"].force, sol.t, sol["rod"].position_error):
        with pytest.raises(ValueError):
            array[0] = 1
    kept = position.copy(), velocity.copy(), t.copy()
    del sol
    gc.collect()
    for _ in range(20):
        lv.solve(pendulum, 1, elements=10)
    assert all((a == b).all() for a, b in zip((position, velocity, t), kept))


def test_views_are_what_is_sampled(sol: lv.Solution) -> None:
    at = sol(sol.t)
    for name in sol.bodies:
        for key in ("position", "velocity", "quaternion", "directors", "angular_velocity", "angular_momentum"):
            assert (getattr(at.bodies[name], key) == getattr(sol.bodies[name], key)).all(), (name, key)
    for name in sol.joints:
        assert (at.joints[name].force == sol.joints[name].force).all()
    assert np.allclose(at.energy, sol.energy, rtol=1e-12) and (at["tip"].x == sol["tip"].x).all()


def test_shapes_and_meanings(sol: lv.Solution) -> None:
    n = len(sol.t)
    crank = sol.bodies["crank"]
    shapes = {"position": (n, 3), "quaternion": (n, 4), "directors": (n, 3, 3), "directors_raw": (n, 3, 3),
              "velocity": (n, 3), "angular_velocity": (n, 3), "angular_velocity_body": (n, 3),
              "linear_momentum": (n, 3), "angular_momentum": (n, 3), "center_of_mass": (n, 3), "position_error": (n,),
              "orientation_error": (n,), "velocity_error": (n,)}
    for name, shape in shapes.items():
        assert getattr(crank, name).shape == shape, name
    R = np.swapaxes(crank.directors, 1, 2)   # columns d1, d2, d3: body to world
    w, x, y, z = crank.quaternion.T
    assert np.allclose(R[:, 0, 0], 1 - 2 * (y * y + z * z)) and np.allclose(R[:, 1, 0], 2 * (x * y + w * z))
    assert np.allclose(np.einsum("nij,nj->ni", R, crank.angular_velocity_body), crank.angular_velocity)
    assert np.allclose(crank.center_of_mass, crank.position + 0.21 * crank.directors[:, 0])
    assert np.allclose(sol["tip"].x, crank.position[:, 0] + 0.42 * crank.directors[:, 0, 0])
    assert (np.sum(crank.quaternion[1:] * crank.quaternion[:-1], axis=1) > 0).all(), "signs are continuous"
    assert sol["crank shaft"].angle.shape == (n,) and sol["crank shaft"].coordinates == {"angle": "rad"}
    assert np.allclose(sol.kinetic + sol.potential, sol.energy) and sol.drift.max() < 1e-6
    assert np.allclose(sum(sol.bodies[b].linear_momentum for b in sol.bodies), sol.linear_momentum)
    assert sol["of crank"].kinetic.shape == (n,)
    length = sol.loads["return"].length
    ends = sol.bodies["rocker"].position + 0.2 * sol.bodies["rocker"].directors[:, 0]
    assert np.allclose(length, np.linalg.norm(ends - [1, 0, 0.2], axis=1))
    assert np.allclose(sol.loads["return"].force, 800 * (length - 0.3))
    assert sol.violation < 1e-10 and sol.error < 1e-6 and sol.growth.shape in ((0,), (n,))


def test_newtons_law_holds_of_reactions(pendulum: lv.Model) -> None:
    """Mass times the acceleration of the centre is weight and reaction; by differences of the exact motion."""
    sol = lv.solve(pendulum, 1, accuracy=1e-9)
    mass, h = 7850 * 0.05**2, 2e-5
    for t in (0.2, 0.5, 0.8):
        before, at, after = (sol(t + s, exact=True) for s in (-h, 0, h))
        acceleration = (after["rod"].velocity - before["rod"].velocity) / (2 * h)
        assert at["pivot"].force == pytest.approx(mass * (acceleration + [0, 0, 9.81]), abs=5e-6)


def test_other_instants(sol: lv.Solution) -> None:
    fine = sol(np.linspace(0, 2, 101))
    assert fine["crank"].position.shape == (101, 3) and len(fine) == 101 and fine["tip"].x.shape == (101,)
    one = sol(0.123)
    assert one["crank"].position.shape == (3,) and one.t == 0.123 and one.energy.shape == ()
    assert (sol([0.123])["crank"].position[0] == one["crank"].position).all()
    assert sol("100 ms").t == 0.1 and sol([1.5, 0.5])["crank"].position.shape == (2, 3)
    assert sol([])["crank"].position.shape == (0, 3)
    exact = sol([0.1234, 0.4321], exact=True)
    assert np.allclose(exact["crank"].position, sol([0.1234, 0.4321])["crank"].position, atol=1e-4)
    assert np.allclose(exact["tip"].x, exact["crank"].position[:, 0] + 0.42 * exact["crank"].directors[:, 0, 0])
    finer = lv.solve(sol.model, 2, accuracy=1e-11)([0.1234, 0.4321], exact=True)
    assert np.allclose(exact["crank"].quaternion, finer["crank"].quaternion, atol=1e-6)
    for wrong in (3, -1, float("nan"), "1 kg", "x", [[1]], None, {"a": 1}):
        with pytest.raises(lv.InputError):
            sol(wrong)
    assert np.isnan(one["crank"].position_error) and not np.isnan(sol(sol.t[3])["crank"].position_error)


def test_exact_is_refused_where_there_is_none(pendulum: lv.Model) -> None:
    mixed = lv.solve(pendulum, 0.5, elements=10, method=lv.Mixed())
    with pytest.raises(lv.InputError) as error:
        mixed(0.123, exact=True)
    assert error.value.code == "sample-exact-method"


def test_names(sol: lv.Solution) -> None:
    assert list(sol.bodies) == ["crank", "coupler", "rocker"] and "crank pin" in sol.joints
    model = sol.model
    assert (sol[model["crank"]].position == sol["crank"].position).all()
    for wrong in ("crnk", "crank.position"):
        with pytest.raises(KeyError):
            sol[wrong]
    with pytest.raises(KeyError, match="did you mean 'crank'"):
        sol["crnk"]
    with pytest.raises(AttributeError, match="its coordinates: angle"):
        sol["crank shaft"].displacement
    with pytest.raises(AttributeError, match="power"):
        sol["return"].nothing
    assert "angle" in dir(sol["crank shaft"]) and "crank" in repr(sol["crank"]) and "crank" in repr(sol.bodies)


def test_point_masses_have_no_orientation() -> None:
    m = lv.Model("point")
    m.add_body("p", lv.point(mass=1), velocity=(1, 0, 0))
    sol = lv.solve(m, 1, elements=2)
    assert np.isnan(sol["p"].quaternion).all() and sol["p"].position[-1] == pytest.approx([1, 0, 0], abs=1e-14)
    assert lv.compare(sol, sol).largest["p"]["orientation"] == 0


def test_files(sol: lv.Solution, tmp_path: pathlib.Path) -> None:
    file = tmp_path / "run.nc"
    sol.save(file)
    again = lv.load_solution(file)
    for other in (again, pickle.loads(pickle.dumps(sol))):
        assert (other.nodes == sol.nodes).all() and other.figures == sol.figures and other.notes == sol.notes
        assert (other["crank pin"].force == sol["crank pin"].force).all() and other.success == sol.success
        assert (other(0.3, exact=True)["crank"].position == sol(0.3, exact=True)["crank"].position).all()
    for ending in ("csv", "npz", "glb"):
        sol.export(tmp_path / f"run.{ending}")
        assert (tmp_path / f"run.{ending}").stat().st_size > 1000
    with pytest.raises(lv.InputError, match="csv"):
        sol.export(tmp_path / "run.xyz")
    with pytest.raises(OSError, match="nowhere"):
        sol.save(tmp_path / "nowhere" / "run.nc")
    with pytest.raises(FileNotFoundError):
        lv.load_solution(tmp_path / "nothing.nc")
    bytes_ = bytearray(file.read_bytes())
    bytes_[len(bytes_) // 2] ^= 1
    file.write_bytes(bytes_)
    with pytest.raises(lv.ResultFileError) as error:
        lv.load_solution(file)
    assert error.value.code == "io-damaged" and pickle.loads(pickle.dumps(error.value)).code == "io-damaged"


def test_nothing_is_lost(sol: lv.Solution, tmp_path: pathlib.Path) -> None:
    writers: dict[str, Any] = {"run.nc": sol.save, "page.html": sol.report, "t.csv": sol.export, "t.npz": sol.export, "t.glb": sol.export,
               "t.pvd": sol.export}
    for name, write in writers.items():
        file = tmp_path / name
        file.write_bytes(b"of somebody else")
        with pytest.raises(FileExistsError, match="force=True"):
            write(file)
        assert file.read_bytes() == b"of somebody else"
        write(file, force=True)
        assert file.read_bytes() != b"of somebody else"
        write(file)   # what is livens' own
        file.write_bytes(b"")
        write(file)
    own = tmp_path / "own.toml"
    model = lv.load(ROOT / "examples" / "four_bar.toml")
    model.to_toml(own)
    model.to_toml(own)   # the same
    with pytest.raises(FileExistsError):
        sol.save(own)
    model.title = "another"
    with pytest.raises(FileExistsError, match="force=True"):
        model.to_toml(own)
    model.to_toml(own, force=True)
    assert lv.load(own).title == "another"


def test_inputs_are_kept_whatever_is_forced(tmp_path: pathlib.Path) -> None:
    mesh = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 3 1 4\n"
    (tmp_path / "part.obj").write_text(mesh)
    (tmp_path / "s.toml").write_text('format = 1\n[[body]]\nname = "b"\ndensity = 1\n'
                                     'shape = { mesh = "part.obj", unit = "m" }\n[time]\nend = 1\nelements = 2\n')
    model = lv.load(tmp_path / "s.toml")
    solution = lv.solve(model)
    writers: list[Any] = [solution.save, model.to_toml]
    for write in writers:
        with pytest.raises(FileExistsError, match="read from"):
            write(tmp_path / "part.obj", force=True)
    with pytest.raises(FileExistsError):
        solution.save(tmp_path / "s.toml")
    assert (tmp_path / "part.obj").read_text() == mesh


def test_crafted_files_are_exceptions(tmp_path: pathlib.Path) -> None:
    folder = ROOT / "tests" / "system" / "data" / "strangers"
    for file in folder.glob("*.nc.gz"):
        crafted = tmp_path / "crafted.nc"
        crafted.write_bytes(gzip.decompress(file.read_bytes()))
        with pytest.raises(lv.ResultFileError) as error:
            lv.load_solution(crafted)
        assert error.value.code == "io-damaged"


def test_samples_are_the_programs(program: str, tmp_path: pathlib.Path, sol: lv.Solution) -> None:
    sol.save(tmp_path / "run.nc")
    for words, part, key in ((["--body", "crank"], sol(0.37)["crank"], "position"),
                             (["--body", "crank", "--exact"], sol(0.37, exact=True)["crank"], "quaternion"),
                             (["--joint", "crank shaft"], sol(0.37)["crank shaft"], "force"),
                             (["--joint", "crank shaft"], sol(0.37)["crank shaft"], "angle_rate")):
        printed = subprocess.run([program, "sample", "run.nc", *words, "--at", "0.37", "--json"], cwd=tmp_path, check=True,
                                 capture_output=True, text=True).stdout
        theirs = np.array(json.loads(printed)[key])
        ours = getattr(part, key)
        assert np.array_equal(theirs, ours) or np.array_equal(theirs, -ours), (words, theirs, ours)


def test_xarray(sol: lv.Solution) -> None:
    pytest.importorskip("xarray")
    data = sol.to_xarray(at="ends")
    assert (data["position"].sel(body="crank", xyz="z").values == sol["crank"].position[:, 2]).all()
    assert data["position"].attrs["units"] == "m" and data["reaction_torque"].attrs["units"] == "N m"
    assert (data["joint_angle"].sel(angle="crank shaft").values == sol["crank shaft"].angle).all()
    assert data.sizes["time"] == len(sol.t) and sol.to_xarray().sizes["time"] == len(sol._result.output)
    assert data["energy"].dims == ("time",) and sol(0.5).to_xarray()["position"].dims == ("body", "xyz")


def test_pandas(sol: lv.Solution) -> None:
    pytest.importorskip("pandas")
    frame = sol.to_dataframe("crank", "crank pin", "tip", at="ends")
    assert (frame["crank.position.z"] == sol["crank"].position[:, 2]).all() and frame.index.name == "t"
    assert (frame["crank pin.force.x"] == sol["crank pin"].force[:, 0]).all()
    assert frame.attrs["units"]["crank pin.torque.y"] == "N m" and "crank.directors.d1.x" in frame
    assert len(sol(0.5).to_dataframe()) == 1


def test_report(sol: lv.Solution, tmp_path: pathlib.Path) -> None:
    sol.report(tmp_path / "one.html")
    sol.report(tmp_path / "two.html", sol)
    one, two = ((tmp_path / name).read_text(encoding="utf-8") for name in ("one.html", "two.html"))
    assert one.startswith("<!doctype html>") and "Content-Security-Policy" in one
    assert len(two) > len(one)


def test_meshes(tmp_path: pathlib.Path) -> None:
    """A mesh lies beside the file, and a result carries what it came to."""
    corners = "".join(f"v {x} {y} {z}\n" for x in (0, 1) for y in (0, 1) for z in (0, 1))
    faces = "f 1 2 4 3\nf 5 7 8 6\nf 1 5 6 2\nf 3 4 8 7\nf 1 3 7 5\nf 2 6 8 4\n"
    (tmp_path / "cube.obj").write_text(corners + faces)
    text = """format = 1
[[body]]
name = "cube"
shape = { mesh = "cube.obj", unit = "m", turn = true }
density = 3
angular_velocity = [0, 0, 1]
[time]
end = 1
elements = 4
"""
    (tmp_path / "cube.toml").write_text(text)
    m = lv.load(tmp_path / "cube.toml")
    sol = lv.solve(m)
    assert sol["cube"].linear_momentum is not None and sol.energy[0] == pytest.approx(0.5 * 3 * (1 / 6 + 0.5))
    m["cube"].density = 6
    assert lv.solve(m).energy[0] == pytest.approx(6 * (1 / 6 + 0.5) / 2)
    sol.save(tmp_path / "cube.nc")
    (tmp_path / "cube.obj").unlink()
    again = lv.load_solution(tmp_path / "cube.nc")
    assert (again(0.3, exact=True)["cube"].position == sol(0.3, exact=True)["cube"].position).all()


def test_plots(sol: lv.Solution) -> None:
    matplotlib = pytest.importorskip("matplotlib")
    matplotlib.use("Agg")
    axes = sol.plot("crank.position", "crank pin.force", "energy", "crank shaft.angle", "tip.x")
    assert [a.get_ylabel().split("\n")[1] for a in axes] == ["[m]", "[N]", "[J]", "[rad]", "[m]"]
    assert axes[-1].get_xlabel() == "t [s]" and len(axes[0].lines) == 3
    line = axes[0].lines[2]
    assert (line.get_ydata() == sol(line.get_xdata())["crank"].position[:, 2]).all() and len(line.get_xdata()) > 600
    ends = sol.plot("crank.position", at="ends")[0].lines[2].get_ydata()
    assert (ends == sol["crank"].position[:, 2]).all()
    assert len(lv.compare(sol, sol).plot("crank.position")[0].lines) == 6
    with pytest.raises(KeyError, match="did you mean 'position'"):
        sol.plot("crank.posision")
    with pytest.raises(KeyError, match="energy"):
        sol.plot("enregy")
    matplotlib.pyplot.close("all")


def test_missing_extras_are_named(sol: lv.Solution, monkeypatch: pytest.MonkeyPatch) -> None:
    import sys
    for module, call, extra in (("xarray", sol.to_xarray, "xarray"), ("pandas", sol.to_dataframe, "pandas"),
                                ("matplotlib.pyplot", sol.plot, "plot")):
        monkeypatch.setitem(sys.modules, module, None)
        with pytest.raises(ImportError, match=rf"pip install 'livens\[{extra}\]'"):
            call()


def test_comparison(sol: lv.Solution) -> None:
    same = lv.compare(sol, lv.solve(sol.model, 2, accuracy=1e-9))
    assert 0 < same.largest["crank"]["position"] + same.largest["crank"]["orientation"] < 1e-5
    assert "crank" in repr(same)
    rod = lv.Model("other")
    rod.add_body("other", lv.sphere(1, mass=1))
    with pytest.raises(lv.InputError):
        lv.compare(sol, lv.solve(rod, 1, elements=1))


def test_what_keeps_bodies_rigid() -> None:
    """E11 w^2 along a rod that spins, by its volume the mean stress; the same along skew directors."""
    m = lv.Model()
    m.add_body("rod", lv.box(2, 0.1, 0.1, mass=3), angular_velocity=(0, 0, 5))
    E = np.diag([1.0, 0.0025, 0.0025])
    C = np.array([[1, 0.5, 0.2], [0, 0.8, -0.1], [0, 0, 1.3]])
    back = np.linalg.inv(C)
    m.add_body("skew", mass=3, first_moment=(0, 0, 0), second_moment=(back @ E @ back.T).tolist(),
               directors=C.T.tolist(), angular_velocity=(0, 0, 5), position=(0, 9, 0))
    sol = lv.solve(m, 1, elements=20, method=lv.Lobatto(degree=8))
    expected = np.diag([25, 0.0625, 0])
    for at in (sol, sol(sol.t), sol(0.123, exact=True)):
        rod, skew = at["rod"], at["skew"]
        assert np.allclose(rod.rigidity_stress, expected, atol=1e-9)
        assert np.allclose(rod.mean_stress, expected / 0.02, atol=1e-7)
        assert np.allclose(skew.rigidity_stress, back @ expected @ back.T, atol=1e-9)
        assert np.isnan(skew.mean_stress).all()
        assert np.allclose(np.swapaxes(skew.directors, -1, -2), np.swapaxes(rod.directors, -1, -2) @ C, atol=1e-12)
    assert sol["rod"].unit("mean_stress") == "Pa" and not sol["rod"].mean_stress.flags.writeable


def test_what_acts_along_a_coordinate_is_its_effort() -> None:
    m = lv.Model("arm", gravity=(0, 0, -9.81))
    arm = m.add_body("arm", lv.box(1, 0.1, 0.1, mass=2), position=(0.5, 0, 0))
    m.add_revolute("hinge", "world", arm, at=(0, 0, 0), axis=(0, 1, 0), damping=0.3, stiffness="4 N m/rad", rest="10 deg",
                   limits=(-np.inf, "40 deg"), limit_law="penalty")
    wheel = m.add_body("wheel", lv.cylinder(0.1, 0.02, mass=1), position=(0, 2, 0))
    m.add_cylindrical("pipe", "world", wheel, at=(0, 2, 0), axis=(0, 0, 1), angle={"damping": 0.1},
                      displacement={"stiffness": 100})
    m.add_actuator("push", "pipe", coordinate="angle", value=0.2)
    lid = m.add_body("lid", lv.box(1, 0.1, 0.1, mass=1), position=(0.5, 4, 0))
    m.add_spherical("ball", "world", lid, at=(0, 4, 0), damping=0.2)
    assert lv.load(text=m.to_toml()) == m and "limits = [-inf, \"40 deg\"]" in m.to_toml()
    sol = lv.solve(m, 1)
    hinge = sol["hinge"]
    assert hinge.angle.max() > np.radians(40), "it reaches its limit"
    inside = hinge.angle < np.radians(40)
    assert np.allclose(hinge.effort[inside], (-4 * (hinge.angle - np.radians(10)) - 0.3 * hinge.angle_rate)[inside], atol=1e-12)
    assert (hinge.effort == sol.loads["hinge"].effort).all() and hinge.unit("effort") == "N m"
    assert sol.loads["hinge"].penetration.max() == pytest.approx(hinge.angle.max() - np.radians(40), abs=1e-12)
    assert any(note.startswith("'hinge' was beyond its limits by ") for note in sol.notes)
    assert np.allclose(sol["pipe"].angle_effort, -0.1 * sol["pipe"].angle_rate, atol=1e-14)
    assert np.allclose(sol["pipe"].displacement_effort, -100 * sol["pipe"].displacement, atol=1e-12)
    assert (sol["push"].effort == 0.2).all()
    w = sol["lid"].angular_velocity
    assert np.allclose(np.linalg.norm(np.stack([sol.loads["ball"][f"torque_{x}"] for x in "xyz"], axis=1), axis=1),
                       0.2 * np.linalg.norm(w, axis=1), atol=1e-12)
    assert not hasattr(sol["ball"], "effort") and "effort" in hinge.arrays()
    assert np.abs(hinge.effort).max() <= -sol.peak("hinge.effort").value < 1.05 * np.abs(hinge.effort).max()


def test_a_drive_holds_with_its_effort_at_rest() -> None:
    m = lv.Model("arm", gravity=(0, 0, -9.81))
    arm = m.add_body("arm", lv.box(1, 0.1, 0.1, mass=2), position=(0.5, 0, 0))
    m.add_revolute("hinge", "world", arm, at=(0, 0, 0), axis=(0, 1, 0))
    m.add_joint_drive("motor", "hinge", value=0)
    rest = m.find_equilibrium()
    assert rest["motor"].effort == pytest.approx(-2 * 9.81 * 0.5, abs=1e-12) and np.isnan(rest["hinge"].effort)
    sol = lv.solve(m, 0.1)
    assert np.allclose(sol["motor"].effort, rest["motor"].effort, atol=1e-9) and sol["motor"].unit("effort") == "N m"
