# SPDX-License-Identifier: BSD-3-Clause
"""Models out of other programs' files."""
from __future__ import annotations

import os
from collections.abc import Iterable, Mapping
from typing import Literal

from . import _core
from ._errors import InputError, Place, fault, file_name, raised
from ._model import Model
from ._tree import diagnostics_of_text, tables

_TURNS = "revolute"   # the joints of a URDF that have a coordinate are of this type or slide


def from_urdf(file: str | os.PathLike[str], *, at: Mapping[str, float | str] | None = None,
              rates: Mapping[str, float | str] | None = None, base: Literal["fixed", "free"] = "fixed",
              packages: Mapping[str, str | os.PathLike[str]] | None = None,
              meshes: Literal["draw", "none"] = "draw", limits: Literal["stop", "ignore"] = "stop",
              inertias: Literal["mend", "strict"] = "mend", loops: Iterable[tuple[str, str, str]] = (),
              strict: bool = False) -> Model:
    """Reads a robot out of a URDF, strictly: each tag is taken, refused, or listed in :attr:`Model.imported`.

    Bodies are called as links, joints as joints, and coordinates are those of the file. Links that fixed joints hold
    together are one body, and stay as named points (``sol["tool0"].position``; points have no axes: an orientation is that
    of the body). Gravity is 9.81 m/s^2 down z.

    Args:
        file: Its name.
        at: Coordinates of joints at the start, rad or m, or with units: ``{"elbow": "30 deg"}``. Others: 0.
        rates: Likewise, rad/s or m/s.
        base: Whether the first link stands still in the world.
        packages: Where ``package://NAME/..`` is: ``{"ur_description": "/opt/ur_description"}``.
        meshes: Whether visuals are drawn: boxes, cylinders, spheres, and meshes (STL, OBJ, PLY, DAE, MSH) that lie at or
            below the file's folder or in a stated package.
        limits: What becomes of limits of joints: ``"stop"`` makes them ``limits`` of the joints, by ``limit_law="penalty"`` springs that
            act beyond them; limits beyond which a joint begins are listed instead.
        inertias: What becomes of inertias that belong to no body: mended by the least change, or an error.
        loops: Pairs of links that the file leaves apart, and how their frames are held together:
            ``("left", "right", "weld")``, ``"spherical"`` (by their origins) or ``"revolute"`` (about their z axes).
            The start is projected onto them.
        strict: Whether what is lost and changes the motion (limits, friction, collisions, mended inertias) is an error.

    Raises:
        InputError: with the line of the file; what is no URDF, what the model would be solved wrongly without.
        OSError: the file cannot be read.

    Example:
        >>> import livens as lv
        >>> robot = '''<robot name="arm"><link name="base"/>
        ...   <link name="rod"><inertial><origin xyz="0.5 0 0"/><mass value="2"/>
        ...     <inertia ixx="0.001" iyy="0.17" izz="0.17" ixy="0" ixz="0" iyz="0"/></inertial></link>
        ...   <joint name="hinge" type="revolute"><parent link="base"/><child link="rod"/><axis xyz="0 1 0"/>
        ...     <limit lower="-1" upper="1" effort="10" velocity="2"/><dynamics damping="0.1"/></joint></robot>'''
        >>> import pathlib, tempfile
        >>> folder = tempfile.TemporaryDirectory()
        >>> file = pathlib.Path(folder.name, "arm.urdf")
        >>> n = file.write_text(robot)
        >>> m = lv.from_urdf(file, at={"hinge": "30 deg"})
        >>> m
        <livens.Model 'arm': 1 body, 1 point, 1 joint>
        >>> [d.code for d in m.imported]
        ['import-merged', 'import-lost']
        >>> lv.solve(m, 1).success
        True
        >>> folder.cleanup()
    """
    choices = {"base": (base, ["fixed", "free"]), "meshes": (meshes, ["draw", "none"]),
               "limits": (limits, ["stop", "ignore"]), "inertias": (inertias, ["mend", "strict"])}
    for word, (value, known) in choices.items():
        if value not in known:
            raise fault("unknown-choice", f"{word}= is '{known[0]}' or '{known[1]}', not {value!r}", word,
                        _core.suggestion(str(value), known))
    name = file_name(file)
    with open(name, "rb") as stream:
        content = stream.read(1 + (16 << 20))
    units: dict[str, str] = {}
    parsed, found, folder = _core.read_urdf(
        content, name, _numbers(at, "at", "", units), _numbers(rates, "rates", "/s", units), base == "free",
        {package: file_name(path) for package, path in (packages or {}).items()}, meshes == "draw", limits == "stop",
        inertias == "mend", [_loop(loop) for loop in loops], bool(strict))
    listed = diagnostics_of_text(found, name, content.decode("utf-8", "replace"))
    if parsed is None:
        raise raised(listed)
    model = Model()
    model._root = tables(parsed[0], parsed[1], name, Place(name, 1))
    model._file, model._home, model._imported = name, folder, tuple(listed)
    _check_units(model, units)
    return model


def _numbers(given: Mapping[str, float | str] | None, word: str, per: str, units: dict[str, str]) -> dict[str, float]:
    """In SI units; of strings, whether they are angles or lengths goes to ``units``."""
    numbers = {}
    for joint, value in (given or {}).items():
        if not isinstance(value, str):
            numbers[joint] = float(value)
            continue
        try:
            numbers[joint], units[joint] = _core.quantity(value, "rad" + per), "angle"
        except InputError:
            numbers[joint], units[joint] = _core.quantity(value, "m" + per), "length"
    return numbers


def _loop(loop: tuple[str, str, str]) -> tuple[str, str, str]:
    if isinstance(loop, str) or len(tuple(loop)) != 3:
        raise fault("wrong-type", f"a loop is two links and a type, (\"left\", \"right\", \"weld\"), not {loop!r}", "loops")
    first, second, kind = loop
    return first, second, kind


def _check_units(model: Model, units: dict[str, str]) -> None:
    for joint, unit in units.items():
        key = joint if joint in model.joints else f"{joint} joint"
        if (model.joints[key].type == _TURNS) != (unit == "angle"):
            raise fault("unit", f"the coordinate of joint '{joint}' is no {unit}", f"joint[{joint}]")
