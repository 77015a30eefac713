# SPDX-License-Identifier: BSD-3-Clause
"""What has no counterpart, told once for each kind."""
from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from ._losses import lost, unseen
from ._mujoco_fields import is_off, original

if TYPE_CHECKING:
    from ._mujoco_parts import Parts

_CONTACT = lost("geom", "contacts are not kept (bodies do not touch)")
_FLUID = lost("body", "forces of the medium (density, viscosity) are not kept", many="bodies")
_MOCAP = lost("body", "bodies that are moved from outside (mocap) stand still", many="bodies")
_PLUGIN = lost("plugin", "plugins are not kept")
_FLEX = lost("body", "flexible bodies are not kept", many="bodies")
_UNSEEN = {"ncam": unseen("camera", "cameras are not kept"), "nlight": unseen("light", "lights are not kept"),
           "nsensor": unseen("sensor", "sensors are not kept"), "nskin": unseen("skin", "skins are not drawn"),
           "ntex": unseen("texture", "textures are not drawn"),
           "ntuple": unseen("field", "fields of users are not kept"), "nnumeric": unseen("field", "fields of users are not kept"),
           "ntext": unseen("field", "fields of users are not kept")}
_KINDS = {"ncam": "cam", "nlight": "light", "nsensor": "sensor", "nskin": "skin", "ntex": "tex", "ntuple": "tuple",
          "nnumeric": "numeric", "ntext": "text"}
_MOST_PAIRED = 2000   # geoms, of which each is looked at with each


def tell_others(p: Parts) -> None:
    m, losses = p.m, p.losses
    for g in _touching(p):
        losses.add(_CONTACT, original(m, "geom", g))
    if m.opt.density > 0 or m.opt.viscosity > 0:
        losses.add(_FLUID, count=len(p.moving))
    for b in range(1, m.nbody):
        if m.body_mocapid[b] >= 0:
            losses.add(_MOCAP, original(m, "body", b))
    for b in range(m.nplugin):
        losses.add(_PLUGIN, original(m, "plugin", b))
    for b in range(getattr(m, "nflex", 0)):
        losses.add(_FLEX, original(m, "flex", b))
    for count, kind in _UNSEEN.items():
        for i in range(getattr(m, count)):
            losses.add(kind, original(m, _KINDS[count], i))


def _touching(p: Parts) -> list[int]:
    """Geoms that may touch one of another body."""
    m = p.m
    if is_off(m, "CONTACT"):
        return []
    pairs = {int(g) for g in np.concatenate([m.pair_geom1, m.pair_geom2])} if m.npair else set()
    kinds, masks = np.asarray(m.geom_contype, np.int64), np.asarray(m.geom_conaffinity, np.int64)
    may = (kinds | masks) != 0
    if m.ngeom <= _MOST_PAIRED:
        owner = p.owner[m.geom_bodyid]
        meets = (kinds[:, None] & masks[None, :]) != 0
        may = ((meets | meets.T) & (owner[:, None] != owner[None, :])).any(axis=1)
    return sorted(pairs | {int(g) for g in np.flatnonzero(may)})
