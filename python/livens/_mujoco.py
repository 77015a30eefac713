# SPDX-License-Identifier: BSD-3-Clause
"""Models out of MuJoCo's files, by MuJoCo's own compiled model: what is read, and the state in which it starts."""
from __future__ import annotations

import os
import re
from collections.abc import Iterator, Mapping, Sequence
from typing import TYPE_CHECKING, Any, Literal

import numpy as np

from . import _core
from ._errors import Diagnostic, InputError, Place, fault, file_name, need, raised, user_place
from ._losses import Loss, Losses
from ._model import Model
from ._mujoco_fields import HINGE, SLIDE, array, is_off, name_of, number_of, original
from ._mujoco_parts import Parts
from ._places import some_time
from ._tree import Table

if TYPE_CHECKING:
    from ._values import Vector

_MOST_BYTES = 16 << 20   # as of scenarios
_MOVED = 1e-9   # rad or m, of a coordinate that was rounded
_COUPLED = Loss("import-mended", "joint", "joints", "moved to where its coupling has it", names_all=True)


def from_mjcf(file: Any, *, keyframe: int | str | None = None, qpos: Vector | None = None, qvel: Vector | None = None,
              at: Mapping[str, float | str] | None = None, rates: Mapping[str, float | str] | None = None,
              control: Mapping[str, float | str] | None = None, limits: Literal["stop", "ignore"] = "stop",
              meshes: str | os.PathLike[str] | None = None, strict: bool = False) -> Model:
    """Makes a model of MuJoCo's compiled model: of a file or string of MJCF, or of an ``MjModel`` or ``MjSpec``.

    Needs MuJoCo (``pip install 'livens[mujoco]'``), which reads the file and all that it names. Bodies are called as
    there, joints as joints, and coordinates are those of ``qpos``. Bodies without joints are part of their parent, and
    stay as named points; so do named sites. What is not kept is listed in :attr:`Model.imported`.

    Args:
        file: Name of a file, a string that begins with ``<``, or what ``mujoco`` made of it.
        keyframe: Number or name of the keyframe at which it starts, with its controls. Default: ``qpos0``, at rest.
        qpos: State at the start instead, as MuJoCo counts it.
        qvel: Likewise.
        at: Coordinates of hinges and slides at the start, rad or m, or with units: ``{"knee": "-30 deg"}``.
        rates: Likewise, rad/s or m/s.
        control: Controls of actuators: numbers, or formulas of the time: ``{"hip": "0.4*sin(6*t)"}``. Others: those of
            the keyframe, else 0.
        limits: What becomes of limits of joints: ``"stop"`` makes them ``limits`` of the joints, by ``limit_law="penalty"`` springs that
            act beyond them; limits beyond which a joint begins are listed instead.
        meshes: Folder into which meshes that are drawn are written, as STL; the model and its scenario file belong there.
            Default: meshes are not drawn.
        strict: Whether what is lost and changes the motion (contacts, friction, muscles, spatial tendons) is an error.

    Raises:
        ImportError: MuJoCo is not installed.
        InputError: ``mjcf-read`` where MuJoCo does not read it; what the model would be solved wrongly without.
        OSError: the file cannot be read, or a mesh cannot be written.

    Example:
        >>> import livens as lv
        >>> pendulum = '''<mujoco model="pendulum"><worldbody><body name="rod">
        ...   <joint name="hinge" axis="0 1 0" damping="0.1" armature="0.01"/>
        ...   <geom type="capsule" fromto="0 0 0 0.5 0 0" size="0.02" contype="0" conaffinity="0"/>
        ... </body></worldbody></mujoco>'''
        >>> m = lv.from_mjcf(pendulum, at={"hinge": "30 deg"})   # doctest: +SKIP
        >>> lv.solve(m, 1)["hinge"].angle[-1].round(4)   # doctest: +SKIP
    """
    if limits not in ("stop", "ignore"):
        raise fault("unknown-choice", f"limits= is 'stop' or 'ignore', not {limits!r}", "limits",
                    _core.suggestion(str(limits), ["stop", "ignore"]))
    mujoco = need("mujoco", "mujoco", "from_mjcf")
    m, place = _compiled(mujoco, file)
    _check_numbers(m, place)
    losses = Losses()
    data, of_keyframe = _state(mujoco, m, keyframe, qpos, qvel, at, rates, losses)
    parts = Parts(m, data, losses, limits == "stop", file_name(meshes) if meshes is not None else None, place)
    parts.add_all(_controls(m, of_keyframe, control))
    told = losses.report(bool(strict), place)
    model = Model()
    model._root, model._file, model._imported = parts.root, place.file, told
    if meshes is not None:
        model._home = file_name(meshes)
    _, found = model._build({"time": some_time(model._root)})
    errors = [d for d in found if d.severity == "error"]
    if errors:
        raise raised(errors)
    return model


# What MuJoCo reads.

def _compiled(mujoco: Any, given: Any) -> tuple[Any, Place]:
    """The compiled model, and the place that errors name."""
    if isinstance(given, mujoco.MjModel):
        return given, user_place()
    if hasattr(mujoco, "MjSpec") and isinstance(given, mujoco.MjSpec):
        return _read(given.compile, user_place()), user_place()
    if isinstance(given, str) and given.lstrip("\ufeff \t\r\n").startswith("<"):
        _refuse_others(given.encode("utf-8", "replace"), Place("<text>"))
        return _read(lambda: mujoco.MjModel.from_xml_string(given), Place("<text>")), Place("<text>")
    if not isinstance(given, (str, os.PathLike)):
        raise TypeError(f"from_mjcf() takes a file, a string of MJCF, an MjModel or an MjSpec, not {type(given).__name__}")
    name = file_name(given)
    with open(name, "rb") as stream:   # what cannot be read is an OSError here, not MuJoCo's
        head = stream.read(1 + _MOST_BYTES)
    _refuse_others(head, Place(name))
    return _read(lambda: mujoco.MjModel.from_xml_path(name), Place(name)), Place(name)


def _refuse_others(content: bytes, place: Place) -> None:
    if len(content) > _MOST_BYTES:
        raise fault("resource-limit", f"the file has more than {_MOST_BYTES} bytes", place=place)
    first = re.search(rb"<\s*([A-Za-z_][\w.:-]*)", re.sub(rb"<!--.*?-->", b"", content[:1 << 16], flags=re.S))
    if first is not None and first.group(1) == b"robot":
        raise fault("mjcf-read", "this is a URDF, of which MuJoCo takes a part only", help="lv.from_urdf(file) reads it",
                    place=place)
    if first is None or first.group(1) != b"mujoco":   # MuJoCo ends the process for some of them
        raise fault("mjcf-read", "this is no MJCF: it does not begin with <mujoco>", place=place)


def _read(read: Any, place: Place) -> Any:
    try:
        return read()
    except (ValueError, RuntimeError, MemoryError, mujoco_errors()) as error:
        text = " ".join(str(error).split())
        line = re.search(r"[Ll]ine(?: number)?[ =]+(\d+)", text)
        where = Place(place.file, int(line[1])) if line and place.file != "<text>" else place
        raise fault("mjcf-read", f"MuJoCo does not read it: {text[:400]}", place=where) from error


def mujoco_errors() -> type[BaseException]:
    """What MuJoCo raises where its library stops."""
    import mujoco   # type: ignore[import-not-found,unused-ignore]
    error: type[BaseException] = getattr(mujoco, "FatalError", RuntimeError)
    return error


_NUMBERS = ("body_mass", "body_inertia", "body_gravcomp", "jnt_stiffness", "jnt_range", "jnt_actfrcrange", "dof_damping",
            "dof_armature", "qpos0", "qpos_spring", "eq_data", "geom_size", "geom_rgba")


def _check_numbers(m: Any, place: Place) -> None:
    """MuJoCo has looked at those of a file, but an MjModel may be changed by hand."""
    for field in _NUMBERS:
        if hasattr(m, field) and not np.isfinite(getattr(m, field)).all():
            raise fault("not-finite", f"'{field}' of the compiled model has numbers that are not finite", place=place)
    for field in ("body_mass", "body_inertia"):
        if np.any(getattr(m, field) < 0):
            raise fault("mass-not-positive", f"'{field}' of the compiled model has negative numbers", place=place)
    if not np.isfinite(m.opt.gravity).all():
        raise fault("not-finite", "gravity of the compiled model is not finite", place=place)


# Its state.

def _state(mujoco: Any, m: Any, keyframe: int | str | None, qpos: Any, qvel: Any, at: Mapping[str, float | str] | None,
           rates: Mapping[str, float | str] | None, losses: Losses) -> tuple[Any, Any]:
    """Positions and velocities of all bodies at the start, and the controls of the keyframe or None."""
    data = mujoco.MjData(m)
    control = None
    if keyframe is not None:
        k = _keyframe(m, keyframe)
        data.qpos[:], data.qvel[:], control = m.key_qpos[k], m.key_qvel[k], np.array(m.key_ctrl[k])
        if m.nmocap:
            data.mocap_pos[:], data.mocap_quat[:] = m.key_mpos[k].reshape(-1, 3), m.key_mquat[k].reshape(-1, 4)
    for word, given, into in (("qpos", qpos, data.qpos), ("qvel", qvel, data.qvel)):
        if given is not None:
            into[:] = _numbers(word, given, len(into))
    for word, stated, into, address in (("at", at, data.qpos, m.jnt_qposadr), ("rates", rates, data.qvel, m.jnt_dofadr)):
        for joint, value in _of_joints(m, word, stated):
            into[address[joint]] = value
    _couple(m, data, losses)
    mujoco.mj_normalizeQuat(m, data.qpos)
    mujoco.mj_kinematics(m, data)
    mujoco.mj_comPos(m, data)
    mujoco.mj_comVel(m, data)
    if not all(np.isfinite(x).all() for x in (data.xpos, data.xmat, data.cvel)):
        raise fault("not-finite", "bodies are not at finite places with finite velocities at the start", "qpos")
    return data, control


def _keyframe(m: Any, wanted: int | str) -> int:
    names = [original(m, "key", k) for k in range(m.nkey)]
    if isinstance(wanted, str) and wanted in names:
        return names.index(wanted)
    if not isinstance(wanted, (str, bool)) and 0 <= wanted < m.nkey:
        return int(wanted)
    known = [name for name in names if name]
    raise fault("unknown-choice", f"there is no keyframe {wanted!r}; the model has {m.nkey}", "keyframe",
                (_core.suggestion(str(wanted), known) if known else "") or f"they are counted from 0 to {m.nkey - 1}" * (m.nkey > 0))


def _numbers(word: str, given: Any, n: int) -> Any:
    try:
        numbers = np.asarray(given, dtype=float).ravel()
    except (TypeError, ValueError):
        raise fault("wrong-type", f"{word} is {n} numbers", word) from None
    if len(numbers) != n:
        raise fault("wrong-type", f"{word} has {n} numbers in this model, not {len(numbers)}", word)
    if not np.isfinite(numbers).all():
        raise fault("not-finite", f"{word} has numbers that are not finite", word)
    return numbers


def _of_joints(m: Any, word: str, stated: Mapping[str, float | str] | None) -> Iterator[tuple[int, float]]:
    known = {original(m, "jnt", j): j for j in range(m.njnt) if m.jnt_type[j] in (SLIDE, HINGE)}
    for name, value in (stated or {}).items():
        if name not in known:
            raise fault("joint-unknown", f"{word} names '{name}', and there is no hinge or slide of that name", word,
                        _core.suggestion(str(name), [k for k in known if k]))
        unit = ("rad" if m.jnt_type[known[name]] == HINGE else "m") + ("/s" if word == "rates" else "")
        number = number_of(value, unit)
        if not np.isfinite(number):
            raise fault("not-finite", f"{word} of '{name}' is not finite", word)
        yield known[name], number


def _couple(m: Any, data: Any, losses: Losses) -> None:
    """Joints that follow others are put where these have them: rigid couplings keep what they find."""
    if is_off(m, "EQUALITY"):
        return
    wanted = np.array(data.qpos)
    equalities = [e for e in range(m.neq) if m.eq_active0[e] and m.eq_type[e] == 2]
    moved = set()
    for _ in range(min(len(equalities), 100)):   # a joint may follow one that follows
        changed = False
        for e in equalities:
            follows, leads, poly = int(m.eq_obj1id[e]), int(m.eq_obj2id[e]), m.eq_data[e][:5]
            a = m.jnt_qposadr[follows]
            x = wanted[m.jnt_qposadr[leads]] - m.qpos0[m.jnt_qposadr[leads]] if leads >= 0 else 0.0
            rate = data.qvel[m.jnt_dofadr[leads]] if leads >= 0 else 0.0
            place = m.qpos0[a] + np.polynomial.polynomial.polyval(x, poly)
            data.qvel[m.jnt_dofadr[follows]] = rate * np.polynomial.polynomial.polyval(x, np.arange(1, 5) * poly[1:])
            if abs(place - wanted[a]) > _MOVED * (1 + abs(place)):
                moved.add(follows)
            changed |= bool(place != wanted[a])
            wanted[a] = place
        if not changed:
            break
    data.qpos[:] = wanted
    for joint in sorted(moved):
        losses.add(_COUPLED, name_of(m, "jnt", joint))


def _controls(m: Any, of_keyframe: Any, control: Mapping[str, float | str] | None) -> Sequence[float | str]:
    """Of each actuator a number or a formula."""
    given: list[float | str] = [0.0] * m.nu if of_keyframe is None else [float(x) for x in of_keyframe]
    known = {original(m, "actuator", i): i for i in range(len(array(m, "actuator_trntype")))}
    for name, value in (control or {}).items():
        if name not in known:
            raise fault("load-unknown", f"control names '{name}', and there is no actuator of that name", "control",
                        _core.suggestion(str(name), [k for k in known if k]))
        if not isinstance(value, str):
            value = float(value)
            if not np.isfinite(value):
                raise fault("not-finite", f"control of '{name}' is not finite", "control")
        given[int(array(m, "actuator_ctrladr")[known[name]]) if hasattr(m, "actuator_ctrladr") else known[name]] = value
    return given
