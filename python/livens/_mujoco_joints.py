# SPDX-License-Identifier: BSD-3-Clause
"""Joints and what binds them: springs, limits, rotors, loops, joints that follow others."""
from __future__ import annotations

import math
from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

import numpy as np

from ._losses import Loss, lost
from ._mujoco_fields import BALL, HINGE, SLIDE, WORLD, array, is_off, name_of
from ._tree import Table, schema

if TYPE_CHECKING:
    from ._mujoco_parts import Parts

_CONNECT, _WELD, _JOINT, _TENDON = range(4)
_AT_A_LIMIT = 1e-9   # rad or m, as a scenario has it for a start at a limit
_LIMITS = lost("joint", "joint limits are not kept", "limits=\"stop\" keeps them as springs")
_LIMITS_AT_START = lost("joint", "limits are not kept beyond which a joint begins", "state by at= where the joint begins")
_LIMITS_ORDER = lost("joint", "limits are not kept whose lower is not below the upper")
_SOFT_LIMITS = Loss("import-mended", "joint", "joints", "limits are springs here whose stiffness follows from the bodies (solref and solimp are not kept)")
_BALL_LIMITS = lost("joint", "limits of ball joints beyond 170 degrees are not kept")
_FARTHEST = math.radians(170)   # to which ball joints are limited
_BALL_ROTOR = lost("joint", "armature of ball and free joints is not kept")
_FRICTION = lost("joint", "dry friction is not kept", "docs/howto/friction.md has it as an expression")
_BENT = lost("joint", "springs and dampers that are not linear, or yield, are not kept")
_NEGATIVE = lost("joint", "negative stiffness, damping and armature are not kept")
_RIGID = Loss("import-mended", "equality", "equalities", "rigid here (solref and solimp are not kept)")
_CURVED = lost("equality", "couplings are not kept that are not linear", many="equalities")
_OTHER_EQUALITY = lost("equality", "equalities of flexible bodies, spatial tendons and distances are not kept", many="equalities")
_SAME_BODY = Loss("import-lost", "equality", "equalities", "equalities within one body, or between bodies that do not move, are not needed")
_PINION = Loss("import-mended", "equality", "equalities", "couples two slides by two racks on a nearly massless pinion", names_all=True)
_MOST_TEETH = 10000   # less one, with which a ratio is beside the bound
_ROUNDED = Loss("import-mended", "equality", "equalities", "the ratio of angles is rounded to that of whole numbers below 10000", names_all=True)
_TOO_FAR = lost("equality", "couplings of angles are not kept whose factors are more than 10000 apart", many="equalities")
_OFF_TENDON = lost("equality", "couplings of tendons keep the difference that they have at the start", many="equalities")


def add_joint(p: Parts, j: int, name: str, first: str, second: str) -> None:
    """Where the bodies stand, with the coordinate that it has there."""
    m, d = p.m, p.d
    kind = int(m.jnt_type[j])
    content: dict[str, Any] = {"name": name, "type": {HINGE: "revolute", SLIDE: "prismatic", BALL: "spherical"}[kind],
                               "between": (first, second), "at": tuple(float(x) for x in d.xanchor[j])}
    if kind != BALL:
        content["axis"] = tuple(float(x) for x in d.xaxis[j])
        content["coordinate"] = float(d.qpos[m.jnt_qposadr[j]])
        p.coordinates[j] = f"{name}.{'angle' if kind == HINGE else 'displacement'}"
    p.joint_names[j] = name
    table = p.add("joint", content)
    _add_along(p, j, table)


def rotor_of(m: Any, j: int) -> float:
    """Armature along the coordinate, with that of its actuators behind their gears."""
    own = float(m.dof_armature[m.jnt_dofadr[j]])
    inertia, kind = array(m, "actuator_armature"), array(m, "actuator_trntype")
    return own + sum(float(inertia[i] * m.actuator_gear[i][0] ** 2) for i in range(len(kind)) if kind[i] in (0, 1) and m.actuator_trnid[i][0] == j)


def damping_of(m: Any, j: int) -> float:
    """Likewise."""
    own = float(np.ravel(m.dof_damping[m.jnt_dofadr[j]])[0])
    damping, kind = array(m, "actuator_damping"), array(m, "actuator_trntype")
    return own + sum(float(damping[i] * m.actuator_gear[i][0] ** 2) for i in range(len(kind)) if kind[i] in (0, 1) and m.actuator_trnid[i][0] == j)


def _add_along(p: Parts, j: int, table: Table) -> None:
    """Stiffness, damping, rotor, limits."""
    m, dof, is_ball = p.m, p.m.jnt_dofadr[j], p.m.jnt_type[j] == BALL
    stiffness, damping, rotor = float(m.jnt_stiffness[j]), damping_of(m, j), rotor_of(m, j)
    name = table["name"]
    bent = [array(m, "jnt_stiffnesspoly")[j], array(m, "dof_dampingpoly")[dof], array(m, "jnt_springyield")[j]]
    bent += [array(m, "actuator_dampingpoly")[i] for i in range(len(array(m, "actuator_trntype"))) if m.actuator_trnid[i][0] == j]
    if any(np.any(x) for x in bent):
        p.losses.add(_BENT, name)
    if m.dof_frictionloss[dof] > 0 and not is_off(m, "FRICTIONLOSS"):
        p.losses.add(_FRICTION, name)
    if min(stiffness, damping, rotor) < 0:
        p.losses.add(_NEGATIVE, name)
    if damping > 0 and not is_off(m, "DAMPER"):
        table["damping"] = damping
    if stiffness > 0 and not is_ball and not is_off(m, "SPRING"):
        table["stiffness"], table["rest"] = stiffness, float(m.qpos_spring[m.jnt_qposadr[j]])
    if rotor > 0 and is_ball:
        p.losses.add(_BALL_ROTOR, name)
    elif rotor > 0:
        table["rotor_inertia"] = rotor
    if m.jnt_limited[j] and not is_off(m, "LIMIT"):
        _add_limits(p, j, table)


def _add_limits(p: Parts, j: int, table: Table) -> None:
    name = table["name"]
    if not p.stops:
        return p.losses.add(_LIMITS, name)
    if p.m.jnt_type[j] == BALL:
        return _add_ball_limit(p, j, table)
    low, high = (float(x) for x in p.m.jnt_range[j])
    if not low < high:
        return p.losses.add(_LIMITS_ORDER, name)
    q = table["coordinate"]
    kept = (low if q >= low - _AT_A_LIMIT else -math.inf, high if q <= high + _AT_A_LIMIT else math.inf)
    if not all(math.isfinite(x) for x in kept):
        p.losses.add(_LIMITS_AT_START, name)
    if any(math.isfinite(x) for x in kept):
        p.losses.add(_SOFT_LIMITS, name)
        table["limits"], table["limit_law"] = kept, "penalty"


def _add_ball_limit(p: Parts, j: int, table: Table) -> None:
    """Of the angle of its quaternion."""
    name, at, most = table["name"], p.m.jnt_qposadr[j], float(p.m.jnt_range[j][1])
    q = p.d.qpos[at:at + 4]
    turned = 2 * math.atan2(float(np.linalg.norm(q[1:])), abs(float(q[0])))
    if not 0 < most <= _FARTHEST:
        return p.losses.add(_BALL_LIMITS, name)
    if turned > most + _AT_A_LIMIT:
        return p.losses.add(_LIMITS_AT_START, name)
    p.losses.add(_SOFT_LIMITS, name)
    del table["at"]
    table["frames"], table["limit"] = frames_of_ball(p, j, np.eye(3)), most
    return None


def frames_of_ball(p: Parts, j: int, rest: Any) -> list[Table]:
    """One on each body, which coincide where the joint is turned by a matrix."""
    m, d = p.m, p.d
    joint = next(t for t in p.root["joint"] if t["name"] == p.joint_names[j])
    at = m.jnt_qposadr[j]
    turned = matrix_of(d.qpos[at:at + 4])   # axes of the second frame in those of the first
    seen = np.array(d.xmat[m.jnt_bodyid[j]].reshape(3, 3))   # of the second frame, in the world
    return [Table({"point": point_on(p, name, d.xanchor[j]),
                   "directors": tuple(tuple(float(x) for x in row) for row in (axes_of(p, name).T @ F).T)}, p.place)
            for name, F in zip(joint["between"], (seen @ turned.T @ rest, seen))]


def axes_of(p: Parts, body: str) -> Any:
    """Of a body as it is placed, or of the world."""
    if body == WORLD:
        return np.eye(3)
    table = next(t for t in p.root["body"] if t["name"] == body)
    return np.array(table.get("directors", np.eye(3))).T


def point_on(p: Parts, body: str, point: Any) -> tuple[float, ...]:
    """A place in the world in coordinates of a body."""
    if body == WORLD:
        return tuple(float(x) for x in point)
    table = next(t for t in p.root["body"] if t["name"] == body)
    return tuple(float(x) for x in axes_of(p, body).T @ (np.array(point) - np.array(table["position"])))


# What closes loops, and who follows whom.

def add_equalities(p: Parts) -> None:
    m = p.m
    if is_off(m, "EQUALITY"):
        return
    for e in range(m.neq):
        if not m.eq_active0[e]:
            continue
        kind = int(m.eq_type[e])
        if kind in (_CONNECT, _WELD):
            _add_loop(p, e, kind)
        elif kind == _JOINT:
            _add_coupling(p, e, {int(m.eq_obj1id[e]): 1.0}, {int(m.eq_obj2id[e]): 1.0} if m.eq_obj2id[e] >= 0 else {})
        elif kind == _TENDON and (terms := [fixed_terms(m, int(t)) if t >= 0 else {} for t in (m.eq_obj1id[e], m.eq_obj2id[e])])[0] \
                and (terms[1] or m.eq_obj2id[e] < 0):
            _add_coupling(p, e, *terms)
        elif kind == _TENDON and m.eq_obj2id[e] < 0 and (over := rope_over(p, int(m.eq_obj1id[e]))) is not None:
            _add_rope(p, e, over)
        else:
            p.losses.add(_OTHER_EQUALITY, name_of(m, "eq", e))


def fixed_terms(m: Any, t: int) -> dict[int, float]:
    """Of a tendon that is a sum of coordinates: its joints and their factors. Empty for others."""
    terms: dict[int, float] = {}
    for w in range(m.tendon_adr[t], m.tendon_adr[t] + m.tendon_num[t]):
        if m.wrap_type[w] != 1:
            return {}
        joint = int(m.wrap_objid[w])
        terms[joint] = terms.get(joint, 0.0) + float(m.wrap_prm[w])
    return terms


_SITE = 3   # mjWRAP_SITE


def rope_over(p: Parts, t: int) -> list[Table] | None:
    """The sites that a tendon runs over, as points of a rope; None for one that wraps around something, or has no length."""
    m, d = p.m, p.d
    over: list[Table] = []
    ends: list[Any] = []
    for w in range(m.tendon_adr[t], m.tendon_adr[t] + m.tendon_num[t]):
        if m.wrap_type[w] != _SITE:
            return None
        site = int(m.wrap_objid[w])
        body = int(p.owner[m.site_bodyid[site]])
        over.append(Table({"body": p.body_names[body], "point": p.in_body(body, d.site_xpos[site])}, p.place))
        ends.append(np.array(d.site_xpos[site]))
    moves = len({at["body"] for at in over}) > 1
    return over if moves and all(np.linalg.norm(b - a) > 1e-9 for a, b in zip(ends, ends[1:])) else None


def _add_rope(p: Parts, e: int, over: list[Table]) -> None:
    """length = length at qpos0 + a0."""
    m = p.m
    length = float(m.tendon_length0[m.eq_obj1id[e]] + m.eq_data[e][0])
    name = p.named("eq", e, "joint")
    p.add("joint", {"name": name, "type": "rod", "over": over, "length": length})
    p.root["start"] = Table({"initial": "project"}, p.place)   # the pose need not close it
    p.losses.add(_RIGID, name)


def _ends(p: Parts, e: int) -> list[tuple[int, Any, Any]]:
    """Of both sides: the body, a point and axes of the world."""
    m, d = p.m, p.d
    of_sites = int(m.eq_objtype[e]) == 6
    ends = []
    for o, at in ((int(m.eq_obj1id[e]), 0), (int(m.eq_obj2id[e]), 1)):
        if of_sites:
            ends.append((int(p.owner[m.site_bodyid[o]]), np.array(d.site_xpos[o]), d.site_xmat[o].reshape(3, 3)))
            continue
        is_weld = m.eq_type[e] == _WELD   # whose numbers stand the other way round
        first = 3 * (1 - at if is_weld else at)
        R = d.xmat[o].reshape(3, 3)
        axes = R
        if is_weld and at == 0:
            axes = R @ matrix_of(m.eq_data[e][6:10])
        ends.append((int(p.owner[o]), d.xpos[o] + R @ m.eq_data[e][first:first + 3], axes))
    return ends


def matrix_of(quaternion: Any) -> Any:
    w, x, y, z = quaternion / (np.linalg.norm(quaternion) or 1)
    return np.array([[w * w + x * x - y * y - z * z, 2 * (x * y - w * z), 2 * (x * z + w * y)],
                     [2 * (x * y + w * z), w * w - x * x + y * y - z * z, 2 * (y * z - w * x)],
                     [2 * (x * z - w * y), 2 * (y * z + w * x), w * w - x * x - y * y + z * z]])


def _add_loop(p: Parts, e: int, kind: int) -> None:
    ends = _ends(p, e)
    if ends[0][0] == ends[1][0]:
        return p.losses.add(_SAME_BODY, name_of(p.m, "eq", e))
    content: dict[str, Any] = {"name": p.named("eq", e, "joint"), "type": "spherical" if kind == _CONNECT else "weld",
                               "between": tuple(p.body_names[body] for body, _, _ in ends)}
    points = tuple(p.in_body(body, point) for body, point, _ in ends)
    if kind == _CONNECT:
        content["points"] = points
    else:
        content["frames"] = [Table({"point": point, "directors": tuple(tuple(float(x) for x in row) for row in p.axes_in(body, axes).T)}, p.place)
                             for point, (body, _, axes) in zip(points, ends)]
    p.add("joint", content)
    p.root["start"] = Table({"initial": "project"}, p.place)   # the pose need not close it
    p.losses.add(_RIGID, content["name"])
    return None


def _add_coupling(p: Parts, e: int, follows: Mapping[int, float], leads: Mapping[int, float]) -> None:
    """follows - its own at qpos0 = a0 + a1 (leads - its own at qpos0), each a sum of coordinates."""
    m = p.m
    poly = [float(x) for x in m.eq_data[e][:5]]
    name = name_of(m, "eq", e)
    if any(poly[2:]):
        return _add_law(p, e, follows, leads, poly)
    terms = dict(follows)
    for j, factor in leads.items():
        terms[j] = terms.get(j, 0.0) - poly[1] * factor
    terms = {j: factor for j, factor in terms.items() if factor}

    def along(of: Mapping[int, float]) -> float:
        return sum(c * float(p.d.qpos[m.jnt_qposadr[j]] - m.qpos0[m.jnt_qposadr[j]]) for j, c in of.items())
    if abs(along(follows) - poly[0] - poly[1] * along(leads)) > 1e-9:
        p.losses.add(_OFF_TENDON, name)
    if not terms or any(j not in p.coordinates for j in terms):
        return p.losses.add(_SAME_BODY, name)
    name = p.named("eq", e, "coupling")
    p.losses.add(_RIGID, name)
    return couple(p, name, terms)


def _add_law(p: Parts, e: int, follows: Mapping[int, float], leads: Mapping[int, float], poly: list[float]) -> None:
    """follows - its own at qpos0 = a0 + a1 x + a2 x^2 + .., x = leads - its own at qpos0."""
    m = p.m
    if len(follows) != 1 or len(leads) != 1 or any(j not in p.coordinates for j in (*follows, *leads)) or set(follows) == set(leads):
        return p.losses.add(_CURVED, name_of(m, "eq", e))
    (follower, factor), (leader, by) = next(iter(follows.items())), next(iter(leads.items()))
    start, start_of_leader = (float(m.qpos0[m.jnt_qposadr[j]]) for j in (follower, leader))
    word = p.coordinates[leader].rpartition(".")[2]
    x = f"({by!r}*({word} - ({start_of_leader!r})))"
    sum_of = " + ".join([f"{factor * start + poly[0]!r}", *(f"({c!r})*{x}^{k}" for k, c in enumerate(poly) if k and c)])
    name = p.named("eq", e, "coupling")
    p.add("joint", {"name": name, "type": "coupling", "terms": Table({p.coordinates[follower]: factor}, p.place),
                    "law": Table({"of": p.coordinates[leader], "expression": sum_of}, p.place)})
    if m.eq_type[e] != _JOINT:   # followers of joints are put where the law has them
        p.root["start"] = Table({"initial": "project"}, p.place)
    p.losses.add(_RIGID, name)
    return None


def _in_teeth(p: Parts, name: str, terms: Mapping[int, float]) -> dict[int, float]:
    """With angles in a ratio of whole numbers, as a coupling of angles must have them; empty if they are too far apart."""
    angles = [j for j in terms if p.m.jnt_type[j] == HINGE]
    if len(angles) < 2:
        return dict(terms)
    largest = max(abs(terms[j]) for j in angles)
    parts = np.array([terms[j] / largest for j in angles])
    teeth = np.arange(1, _MOST_TEETH)
    off = np.abs(np.round(np.outer(teeth, parts)) / teeth[:, None] - parts).max(axis=1)
    n = int(teeth[np.argmax(off < 1e-12) if (off < 1e-12).any() else np.argmin(off)])
    whole = np.round(n * parts)
    if not whole.all():
        p.losses.add(_TOO_FAR, name)
        return {}
    if off[n - 1] > 1e-12:
        p.losses.add(_ROUNDED, f"{name}, by {off[n - 1]:.1e} of the larger")
    return {**terms, **{j: float(k) / n * largest for j, k in zip(angles, whole)}}


def couple(p: Parts, name: str, terms: Mapping[int, float]) -> None:
    """The sum of factors times coordinates stays what it is at the start."""
    terms = _in_teeth(p, name, terms)
    if not terms:
        return None
    if len(terms) == 1:
        (j,) = terms
        p.add("drive", {"name": name, "type": "joint", "joint": p.coordinates[j].rpartition(".")[0],
                        "value": float(p.d.qpos[p.m.jnt_qposadr[j]])})
        return None
    p.add("joint", {"name": name, "type": "coupling", "terms": Table({p.coordinates[j]: c for j, c in terms.items()}, p.place)})
    return None

