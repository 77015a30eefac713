# SPDX-License-Identifier: BSD-3-Clause
"""Loads: what bodies carry, springs along tendons, actuators with their controls."""
from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from ._errors import fault
from ._losses import Loss, lost
from ._mujoco_fields import BALL, FREE, WORLD, array, is_off, name_of, original
from ._mujoco_joints import fixed_terms, frames_of_ball, matrix_of, rope_over
from ._tree import Table

if TYPE_CHECKING:
    from ._mujoco_parts import Parts

_FREE_SPRING = lost("joint", "stiffness and armature of free joints are not kept")
_SPATIAL = lost("tendon", "spatial tendons that wrap around bodies, or run over pulleys, are not kept")
_TENDON = lost("tendon", "limits, friction and armature of tendons, and what is not linear in them, are not kept")
_ACTUATOR = lost("actuator", "muscles, actuators with states of their own, plugins and delays are not kept")
_TRANSMISSION = lost("actuator", "actuators are not kept that act on sites, bodies, cranks, ball and free joints, or spatial tendons")
_SHARED_LIMIT = lost("joint", "limits of the actuator force on a joint are not kept where several actuators share it")
_IDLE = Loss("import-merged", "actuator", "actuators", "loads of value 0, for their control is 0 (control= states others)")
_OFF = Loss("import-lost", "actuator", "actuators", "actuators are not kept that the model switches off")


# Bodies.

def add_loads_of_body(p: Parts, b: int, gravity: Any) -> None:
    """Weight that is compensated, springs of ball joints, dampers of free bodies."""
    m, d = p.m, p.d
    for c in p.parts_of[b]:
        if array(m, "body_gravcomp")[c] and m.body_mass[c] > 0 and np.any(gravity):
            force = -m.body_gravcomp[c] * m.body_mass[c] * gravity
            p.add("load", {"name": p.names.of(f"weight of {name_of(m, 'body', c)}", "load"), "type": "force", "body": p.body_names[b],
                           "point": p.in_body(b, d.xipos[c]), "value": tuple(float(x) for x in force)})
    j = int(m.body_jntadr[b])
    if m.jnt_type[j] == FREE:
        dof = m.jnt_dofadr[j]
        if m.jnt_stiffness[j] or np.any(m.dof_armature[dof:dof + 6]):
            p.losses.add(_FREE_SPRING, name_of(m, "jnt", j))
        damping = float(np.ravel(m.dof_damping[dof])[0])
        if damping > 0 and not is_off(m, "DAMPER"):
            name = p.body_names[b]
            p.add("load", {"name": p.names.of(f"drag of {name}", "load"), "type": "drag", "body": name, "linear": damping})
            p.add("load", {"name": p.names.of(f"damping of {name}", "load"), "type": "rotational_damper", "between": (WORLD, name),
                           "damping": damping})
    for k in range(j, j + int(m.body_jntnum[b])):
        if m.jnt_type[k] == BALL and m.jnt_stiffness[k] > 0 and not is_off(m, "SPRING"):
            _add_ball_spring(p, k)


def _add_ball_spring(p: Parts, j: int) -> None:
    """A torque along the rotation from where it is at rest, as long as the angle."""
    joint = next(t for t in p.root["joint"] if t["name"] == p.joint_names[j])
    at = p.m.jnt_qposadr[j]
    k = float(p.m.jnt_stiffness[j])
    p.add("load", {"name": p.names.of(f"spring of {joint['name']}", "load"), "type": "bushing", "between": joint["between"],
                   "frames": frames_of_ball(p, j, matrix_of(p.m.qpos_spring[at:at + 4])), "stiffness": (0.0, 0.0, 0.0, k, k, k)})


# Along coordinates.

class _Symbols:
    """q1, w1, ..: coordinates and rates in a formula."""

    def __init__(self, p: Parts) -> None:
        self._p, self.inputs = p, Table({}, p.place)

    def sum(self, terms: Mapping[int, float], letter: str) -> str:
        found = []
        for j, factor in terms.items():
            end = "_rate" if letter == "w" else ""
            source = self._p.coordinates[j] + end
            symbol = next((s for s, of in self.inputs.items() if of == source), f"{letter}{len(self.inputs) + 1}")
            self.inputs[symbol] = source
            found.append(f"({factor!r})*{symbol}")
        return " + ".join(found)


def _add_force(p: Parts, name: str, joint: int, factor: float, force: str, inputs: Table) -> None:
    content: dict[str, Any] = {"name": name, "type": "actuator", "joint": p.coordinates[joint].rpartition(".")[0]}
    if inputs:
        content["inputs"] = Table(inputs, p.place)
    p.add("load", {**content, "expression": f"({factor!r})*({force})"})


def _check(p: Parts, what: str, *numbers: Any) -> None:
    if not all(np.isfinite(x).all() for x in numbers):
        raise fault("not-finite", f"{what} has numbers that are not finite", place=p.place)


def _usable(p: Parts, terms: Mapping[int, float]) -> bool:
    return bool(terms) and all(j in p.coordinates for j in terms)


def _add_rope(p: Parts, t: int, name: str, over: list[Table], stiffness: float, damping: float) -> None:
    """A spring along a tendon over sites: none between two lengths, and linear beyond them."""
    low, high = (float(x) for x in p.m.tendon_lengthspring[t])
    _check(p, f"tendon '{name}'", stiffness, damping, low, high)
    content: dict[str, Any] = {"name": p.names.of(name, "tendon"), "type": "spring", "over": over}
    if damping:
        content["damping"] = damping
    if stiffness and low == high:
        content.update(stiffness=stiffness, free_length=low)
    elif stiffness:
        content.update(law="table", free_length=low, table=Table(
            {"elongations": (-1.0, 0.0, high - low, high - low + 1), "forces": (-stiffness, 0.0, 0.0, stiffness)}, p.place))
    p.add("load", content)


def add_tendons(p: Parts) -> None:
    """Springs and dampers of tendons that are sums of coordinates, or run over sites."""
    m = p.m
    for t in range(m.ntendon):
        name, terms = name_of(m, "tendon", t), fixed_terms(m, t)
        limited = m.tendon_limited[t] and not is_off(m, "LIMIT")
        friction = m.tendon_frictionloss[t] > 0 and not is_off(m, "FRICTIONLOSS")
        bent = [array(m, field)[t] for field in ("tendon_stiffnesspoly", "tendon_dampingpoly", "tendon_springyield", "tendon_armature")]
        over = None if terms else rope_over(p, t)
        if over is None and not _usable(p, terms):
            p.losses.add(_SPATIAL, name)
            continue
        if limited or friction or any(np.any(x) for x in bent):
            p.losses.add(_TENDON, name)
        stiffness = 0.0 if is_off(m, "SPRING") else float(m.tendon_stiffness[t])
        damping = 0.0 if is_off(m, "DAMPER") else float(np.ravel(m.tendon_damping[t])[0])
        if not stiffness and not damping:
            continue
        if over is not None:
            _add_rope(p, t, name, over, stiffness, damping)
            continue
        _check(p, f"tendon '{name}'", stiffness, damping, m.tendon_lengthspring[t], list(terms.values()))
        symbols, parts = _Symbols(p), []
        if stiffness:
            low, high = (float(x) for x in m.tendon_lengthspring[t])
            length = symbols.sum(terms, "q")
            parts.append(f"({-stiffness!r})*({length} - ({low!r}))" if low == high else
                         f"({stiffness!r})*(max(0, ({low!r}) - ({length})) - max(0, {length} - ({high!r})))")
        if damping:
            parts.append(f"({-damping!r})*({symbols.sum(terms, 'w')})")
        for joint, factor in terms.items():
            called = p.names.of(f"{name} on {p.coordinates[joint].rpartition('.')[0]}" if len(terms) > 1 else name, "tendon")
            _add_force(p, called, joint, factor, " + ".join(parts), symbols.inputs)


# Actuators.

def add_actuators(p: Parts, controls: Sequence[float | str]) -> None:
    m = p.m
    for i in range(len(array(m, "actuator_trntype"))):
        name = original(m, "actuator", i)
        if is_off(m, "ACTUATION") or m.opt.disableactuator >> max(0, int(m.actuator_group[i])) & 1:
            p.losses.add(_OFF, name)
        elif not _has_plain_law(m, i):
            p.losses.add(_ACTUATOR, name)
        else:
            terms = _acts_on(m, i)
            if _usable(p, terms):
                address = array(m, "actuator_ctrladr")[i] if hasattr(m, "actuator_ctrladr") else i
                _add_actuator(p, i, terms, controls[int(address)])
            else:
                p.losses.add(_TRANSMISSION, name)


def _has_plain_law(m: Any, i: int) -> bool:
    """A force that follows from the control, the length and its rate alone."""
    fields = {"actuator_ctrlnum": 1, "actuator_outnum": 1, "actuator_plugin": -1, "actuator_delay": 0}
    same = all(array(m, field, value)[i] == value for field, value in fields.items())
    return bool(same and m.actuator_dyntype[i] == 0 and m.actuator_gaintype[i] in (0, 1) and m.actuator_biastype[i] in (0, 1))


def _acts_on(m: Any, i: int) -> dict[int, float]:
    """Its length as a sum of coordinates: joints and factors."""
    kind, on, gear = int(m.actuator_trntype[i]), int(m.actuator_trnid[i][0]), float(m.actuator_gear[i][0])
    if kind in (0, 1):
        return {on: gear}
    return {j: gear * factor for j, factor in fixed_terms(m, on).items()} if kind == 3 else {}


def _add_actuator(p: Parts, i: int, terms: Mapping[int, float], control: float | str) -> None:
    m, name = p.m, name_of(p.m, "actuator", i)
    _check(p, f"actuator '{name}'", m.actuator_ctrlrange[i], m.actuator_forcerange[i], m.actuator_gainprm[i], m.actuator_biasprm[i],
           list(terms.values()))
    if m.actuator_ctrllimited[i] and not is_off(m, "CLAMPCTRL"):
        low, high = (float(x) for x in m.actuator_ctrlrange[i])
        control = f"min(max({control}, {low!r}), {high!r})" if isinstance(control, str) else min(max(control, low), high)
    gain = [float(x) for x in m.actuator_gainprm[i][:3]]
    bias = [float(x) for x in m.actuator_biasprm[i][:3]]
    if m.actuator_gaintype[i] == 0:
        gain[1:] = [0.0, 0.0]
    if m.actuator_biastype[i] == 0:
        bias = [0.0] * 3
    symbols, parts = _Symbols(p), []
    if isinstance(control, str):
        law = [(bias[k], gain[k]) for k in range(3)]
        numbers = [f"{b!r} + ({g!r})*({control})" if g else repr(b) if b else "" for b, g in law]
    else:
        numbers = [repr(b + g * control) if b + g * control else "" for b, g in zip(bias, gain)]
    for number, letter in zip(numbers, ("", "q", "w")):
        if number:
            parts.append(f"({number})*({symbols.sum(terms, letter)})" if letter else f"({number})")
    force = " + ".join(parts) or "0.0"
    if m.actuator_forcelimited[i]:
        low, high = (float(x) for x in m.actuator_forcerange[i])
        force = f"min(max({force}, {low!r}), {high!r})"
    for joint, factor in terms.items():
        called = p.names.of(name if len(terms) == 1 else f"{name} on {p.coordinates[joint].rpartition('.')[0]}", "motor")
        if not symbols.inputs and not isinstance(control, str):
            _add_constant(p, i, called, joint, factor, gain[0] * control + bias[0])
        else:
            _add_force(p, called, joint, *_limited(p, joint, factor, force), symbols.inputs)


def _add_constant(p: Parts, i: int, name: str, joint: int, factor: float, force: float) -> None:
    m = p.m
    if m.actuator_forcelimited[i]:
        force = min(max(force, float(m.actuator_forcerange[i][0])), float(m.actuator_forcerange[i][1]))
    value = factor * force
    if _has_own_limit(p, joint):
        low, high = (float(x) for x in m.jnt_actfrcrange[joint])
        value = min(max(value, low), high)
    if value == 0:
        p.losses.add(_IDLE, name)
    p.add("load", {"name": name, "type": "actuator", "joint": p.coordinates[joint].rpartition(".")[0], "value": value})


def _has_own_limit(p: Parts, joint: int) -> bool:
    """Whether the joint limits the force of its actuator; of several the sum is limited, which is reported as lost."""
    m = p.m
    if not np.any(array(m, "jnt_actfrclimited")[joint]):
        return False
    acting = sum(joint in _acts_on(m, i) for i in range(len(array(m, "actuator_trntype"))))
    if acting > 1:
        p.losses.add(_SHARED_LIMIT, p.coordinates[joint].rpartition(".")[0])
    return acting == 1


def _limited(p: Parts, joint: int, factor: float, force: str) -> tuple[float, str]:
    if not _has_own_limit(p, joint):
        return factor, force
    low, high = (float(x) for x in p.m.jnt_actfrcrange[joint])
    return 1.0, f"min(max(({factor!r})*({force}), {low!r}), {high!r})"
