# SPDX-License-Identifier: BSD-3-Clause
"""Models out of URDFs."""
from __future__ import annotations

import pathlib
import pickle
from typing import Any, Literal

import numpy as np
import pytest

import livens as lv

LINK = '<link name="{}"><inertial><origin xyz="0.1 0 0"/><mass value="1"/><inertia ixx="0.01" iyy="0.02" izz="0.02" ixy="0" ixz="0" iyz="0"/></inertial></link>'
ARM = """<robot name="arm">
  <link name="base"/>
  <link name="rod"><inertial><origin xyz="0.5 0 0"/><mass value="2"/><inertia ixx="0.001" iyy="0.17" izz="0.17" ixy="0" ixz="0" iyz="0"/></inertial></link>
  <joint name="hinge" type="revolute"><parent link="base"/><child link="rod"/><axis xyz="0 1 0"/><dynamics damping="0.1"/>
    <limit lower="-1" upper="1" effort="10" velocity="2"/></joint>
</robot>
"""


STOPS: tuple[Literal["stop"], Literal["ignore"]] = ("stop", "ignore")


def write(folder: pathlib.Path, text: str, name: str = "robot.urdf") -> pathlib.Path:
    file = folder / name
    file.write_text(text)
    return file


def pair(first: str, second: str, mimic: str = "") -> str:
    """Two links at a base, by joints of these types about x and y."""
    return ('<robot name="pair"><link name="base"/>' + LINK.format("one") + LINK.format("two") +
            f'<joint name="lead" type="{first}"><parent link="base"/><child link="one"/></joint>'
            f'<joint name="follow" type="{second}"><parent link="base"/><child link="two"/><axis xyz="0 1 0"/>{mimic}</joint></robot>')


def test_the_motion_is_that_of_the_same_model_by_hand(tmp_path: pathlib.Path) -> None:
    m = lv.from_urdf(write(tmp_path, ARM), at={"hinge": "30 deg"}, rates={"hinge": 2})
    by_hand = lv.Model("arm", gravity=(0, 0, -9.81))
    c, s = np.cos(np.pi / 6), np.sin(np.pi / 6)
    by_hand.add_body("rod", mass=2, center_of_mass=(0.5, 0, 0), inertia=(0.001, 0.17, 0.17),
                     directors=[(c, 0, -s), (0, 1, 0), (s, 0, c)], angular_velocity=(0, 2, 0))
    by_hand.add_revolute("hinge", "world", "rod", at=(0, 0, 0), axis=(0, 1, 0), coordinate=np.pi / 6,
                         damping=0.1, limits=(-1, 1), limit_law="penalty")
    one, other = lv.solve(m, 1, accuracy=1e-9), lv.solve(by_hand, 1, accuracy=1e-9)
    assert one["hinge"].angle[0] == pytest.approx(np.pi / 6, abs=1e-15)
    assert one["hinge"].angle[-1] == pytest.approx(other["hinge"].angle[-1], abs=1e-8)
    assert one.peak("hinge.penetration").value > 1e-4   # it gets to its limit


def test_limits_are_kept_or_left_out(tmp_path: pathlib.Path) -> None:
    file = write(tmp_path, ARM)
    swings = {limits: lv.solve(lv.from_urdf(file, at={"hinge": "30 deg"}, rates={"hinge": 2}, limits=limits), 1)
              for limits in STOPS}
    assert swings["stop"].peak("hinge.angle").value < 1.05 < swings["ignore"].peak("hinge.angle").value
    beyond = lv.from_urdf(file, at={"hinge": 1.5})
    assert [d.line for d in beyond.imported if "beyond which a joint begins: 1 joint ('hinge')" in d.message] == [5]
    with pytest.raises(lv.InputError, match="limits= is 'stop' or 'ignore'"):
        lv.from_urdf(file, limits="none")   # type: ignore[arg-type]


def test_what_is_not_kept_is_listed_with_its_place(tmp_path: pathlib.Path) -> None:
    file = write(tmp_path, ARM)
    m = lv.from_urdf(file, limits="ignore")
    limits = [d for d in m.imported if "joint limits are not kept" in d.message]
    assert [(d.code, d.severity, d.line) for d in limits] == [("import-lost", "warning", 5)]
    assert limits[0].file == str(file) and "<limit" in str(limits[0])
    assert lv.Model().imported == []
    assert pickle.loads(pickle.dumps(m)).imported == m.imported == m.copy().imported
    with pytest.raises(lv.InputError, match="limits are not kept") as caught:
        lv.from_urdf(file, limits="ignore", strict=True)
    assert caught.value.line == 5


@pytest.mark.parametrize("first", ["revolute", "prismatic"])
@pytest.mark.parametrize("second", ["revolute", "prismatic"])
def test_a_joint_that_mimics_follows(tmp_path: pathlib.Path, first: str, second: str) -> None:
    mimic = '<mimic joint="lead" multiplier="-2" offset="0.5"/>'
    m = lv.from_urdf(write(tmp_path, pair(first, second, mimic)), at={"lead": 0.25}, rates={"lead": 1})
    sol = lv.solve(m, 1, accuracy=1e-9, output=0.1)
    lead, follow = (sol[name].angle if kind == "revolute" else sol[name].displacement
                    for name, kind in (("lead", first), ("follow", second)))
    assert np.abs(follow - (0.5 - 2 * lead)).max() < 1e-12
    assert np.ptp(lead) > 0.1   # it moves


def test_merged_links_are_points_of_the_motion_of_states_and_of_inverse_kinematics(tmp_path: pathlib.Path) -> None:
    tool = ('<link name="flange"/><link name="tool"/><joint name="f" type="fixed"><origin xyz="1 0 0" rpy="0 0 1"/><parent link="rod"/>'
            '<child link="flange"/></joint><joint name="t" type="fixed"><origin xyz="0 0 0.2"/><parent link="flange"/><child link="tool"/></joint>')
    file = write(tmp_path, ARM.replace("</robot>", tool + "</robot>"))
    m = lv.from_urdf(file, at={"hinge": 0.3}, rates={"hinge": 2})
    c, s = np.cos(0.3), np.sin(0.3)
    assert list(m.points) == ["base", "flange", "tool"] and m["tool"].body == "rod"
    place = [c + 0.2 * s, 0, -s + 0.2 * c]
    state = m.at(v={"hinge.angle": 2})
    assert state["tool"].position == pytest.approx(place, abs=1e-15)
    assert state["tool"].velocity == pytest.approx([2 * place[2], 0, -2 * place[0]], abs=1e-15)
    assert state["base"].position.tolist() == [0, 0, 0] and state.points["base"].velocity.tolist() == [0, 0, 0]
    assert (state.jacobian("tool") @ state.v)[:3] == pytest.approx(state["tool"].velocity, abs=1e-15)
    sol = lv.solve(m, 0.1)
    assert sol["tool"].position[0] == pytest.approx(place, abs=1e-12)
    assert sol["tool"].velocity[0] == pytest.approx(state["tool"].velocity, abs=1e-12)
    q = lv.reach(m, "tool", (np.cos(0.5) + 0.2 * np.sin(0.5), 0, -np.sin(0.5) + 0.2 * np.cos(0.5)))
    assert q["hinge.angle"] == pytest.approx(0.5, abs=1e-9)
    with pytest.raises(KeyError, match="tool"):
        state["tol"]


def test_a_joint_may_begin_at_its_limit(tmp_path: pathlib.Path) -> None:
    m = lv.from_urdf(write(tmp_path, ARM.replace('lower="-1"', 'lower="0"')), strict=True)
    assert list(m["hinge"].limits) == [0, 1]
    sol = lv.solve(lv.from_urdf(write(tmp_path, ARM.replace('lower="-1" upper="1"', 'lower="-1" upper="0"'))), 1)
    assert sol.success and sol.peak("hinge.angle").value < 0.01   # gravity presses it on


def test_two_slides_are_coupled_without_a_mass_between(tmp_path: pathlib.Path) -> None:
    mimic = '<mimic joint="lead" multiplier="2"/>'
    robot = pair("prismatic", "prismatic", mimic).replace('xyz="0 1 0"', 'xyz="0 0 1"')   # the second falls
    sol = lv.solve(lv.from_urdf(write(tmp_path, robot)), 1, output=0.1)
    # (1 + 4) kg q'' = -2 * 9.81 N
    assert sol["lead"].displacement[-1] == pytest.approx(-0.5 * 2 * 9.81 / 5, rel=1e-13)


def test_a_loop_that_is_stated_holds(tmp_path: pathlib.Path) -> None:
    arms = "".join(LINK.format(name) for name in ("a", "b", "c")) + '<link name="base"/><link name="end"/><link name="top"/>'
    joint = '<joint name="{}" type="{}"><origin xyz="{}"/><parent link="{}"/><child link="{}"/><axis xyz="0 1 0"/></joint>'
    bars = (("j1", "revolute", "0 0 0", "base", "a"), ("j2", "revolute", "0 0 1", "a", "b"), ("j3", "revolute", "2 0 0", "base", "c"),
            ("j4", "fixed", "1.9 0 0", "b", "end"), ("j5", "fixed", "0 0 1", "c", "top"))
    robot = f'<robot name="bars">{arms}{"".join(joint.format(*bar) for bar in bars)}</robot>'
    m = lv.from_urdf(write(tmp_path, robot), loops=[("end", "top", "spherical")])
    sol = lv.solve(m, 0.5, output=0.1)
    end = sol["b"].position + np.einsum("tij,j->ti", np.swapaxes(sol["b"].directors, 1, 2), (1.9, 0, 0))
    top = sol["c"].position + np.einsum("tij,j->ti", np.swapaxes(sol["c"].directors, 1, 2), (0, 0, 1))
    assert np.abs(end - top).max() < 1e-9


def test_a_free_base_falls(tmp_path: pathlib.Path) -> None:
    sol = lv.solve(lv.from_urdf(write(tmp_path, pair("revolute", "revolute").replace('<link name="base"/>', LINK.format("base"))),
                                base="free"), 1, output=0.5)
    assert sol["base"].position[-1, 2] == pytest.approx(-9.81 / 2, abs=1e-7)


def test_the_text_of_a_model_gives_the_same_bytes_of_results(tmp_path: pathlib.Path) -> None:
    m = lv.from_urdf(write(tmp_path, ARM), at={"hinge": 0.3})
    m.time.end = 1
    m.to_toml(tmp_path / "arm.toml")
    lv.solve(m).save(tmp_path / "one.nc")
    lv.solve(lv.load(tmp_path / "arm.toml")).save(tmp_path / "other.nc")
    assert (tmp_path / "one.nc").read_bytes() == (tmp_path / "other.nc").read_bytes()
    assert lv.load(tmp_path / "arm.toml") == m


def test_meshes_are_drawn_from_packages(tmp_path: pathlib.Path) -> None:
    (tmp_path / "shapes").mkdir()
    write(tmp_path / "shapes", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n", "one.obj")
    visual = "<visual><geometry><mesh filename='package://p/one.obj'/></geometry></visual></link>"
    (tmp_path / "robots").mkdir()
    file = write(tmp_path / "robots", ARM.replace("</inertial></link>", "</inertial>" + visual))
    lost = lv.from_urdf(file)
    assert "visual" not in lost["rod"]._table and any("package 'p'" in d.message for d in lost.imported)
    drawn = lv.from_urdf(file, packages={"p": tmp_path / "shapes"})
    assert drawn["rod"].visual[0].mesh == "shapes/one.obj"
    assert lv.solve(drawn, 0.1).success


@pytest.mark.parametrize(("arguments", "code"), [
    ({"at": {"elbow": 1}}, "joint-unknown"), ({"at": {"hinge": "1 m"}}, "unit"), ({"at": {"hinge": "1 s"}}, "unit"),
    ({"base": "loose"}, "unknown-choice"), ({"meshes": "all"}, "unknown-choice"), ({"loops": ["rod"]}, "wrong-type"),
    ({"loops": [("rod", "hand", "weld")]}, "body-unknown"), ({"inertias": "ok"}, "unknown-choice")])
def test_wrong_arguments_are_refused(tmp_path: pathlib.Path, arguments: dict[str, Any], code: str) -> None:
    with pytest.raises(lv.InputError) as caught:
        lv.from_urdf(write(tmp_path, ARM), **arguments)
    assert caught.value.code == code


def test_what_the_engine_refuses_is_told_at_the_line_of_the_urdf(tmp_path: pathlib.Path) -> None:
    broken = ARM.replace('ixx="0.001"', 'ixx="1"')
    with pytest.raises(lv.InputError) as caught:
        lv.from_urdf(write(tmp_path, broken), inertias="strict")
    assert (caught.value.code, caught.value.line) == ("inertia-triangle", 3)
    mended = lv.from_urdf(write(tmp_path, broken))
    assert [d.message for d in mended.imported if d.code == "import-mended"] == [
        "inertia is not physically possible and was changed to the nearest possible one: 1 link ('rod' by 33 %)"]
