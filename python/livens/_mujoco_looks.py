# SPDX-License-Identifier: BSD-3-Clause
"""What is drawn: geoms as visuals of bodies, meshes as files."""
from __future__ import annotations

import errno
import os
import re
from typing import TYPE_CHECKING, Any

import numpy as np

from . import _core
from ._losses import unseen
from ._mujoco_fields import name_of, original
from ._tree import Table

if TYPE_CHECKING:
    from ._mujoco_parts import Parts

_PLANE, _FIELD, _SPHERE, _CAPSULE, _ELLIPSOID, _CYLINDER, _BOX, _MESH = range(8)
_LAST_GROUP = 2   # higher ones are hidden where MuJoCo draws
_PLAIN = np.array([0.5, 0.5, 0.5, 1], dtype=np.float32)   # a geom without a colour of its own
_UNDRAWN = unseen("geom", "meshes are not drawn", "meshes=\"FOLDER\" writes them there, and the model belongs there")
_ENDLESS = unseen("geom", "planes without end are not drawn")
_FIELDS = unseen("geom", "height fields, distance fields and empty meshes are not drawn")


class Looks:
    """Visuals of bodies; meshes are written once, when they are first needed."""

    def __init__(self, p: Parts, folder: str | None) -> None:
        self._p, self._folder = p, folder
        self._files: dict[int, str] = {}
        self._geoms: dict[int, list[int]] = {}
        for g in range(p.m.ngeom):
            self._geoms.setdefault(int(p.owner[p.m.geom_bodyid[g]]), []).append(g)

    def of(self, body: int) -> list[Table]:
        """0: of the world. Where a mesh that touches nothing is drawn, shapes of the same body that touch are not."""
        m, geoms = self._p.m, self._geoms.get(body, [])
        touches = (m.geom_contype | m.geom_conaffinity) != 0
        dressed = {m.geom_bodyid[g] for g in geoms if self._folder is not None and m.geom_type[g] == _MESH and not touches[g]
                   and m.geom_group[g] <= _LAST_GROUP}
        made = (self._visual(body, g) for g in geoms if not (touches[g] and m.geom_bodyid[g] in dressed))
        return [table for table in made if table is not None]

    def _visual(self, body: int, g: int) -> Table | None:
        p, m = self._p, self._p.m
        color = m.geom_rgba[g]
        if m.geom_matid[g] >= 0 and np.array_equal(color, _PLAIN):
            color = m.mat_rgba[m.geom_matid[g]]
        if m.geom_group[g] > _LAST_GROUP or not color[3] > 0:
            return None
        shape = self._shape(g)
        if shape is None:
            return None
        axes = p.d.geom_xmat[g].reshape(3, 3)
        at = np.array(p.d.geom_xpos[g])
        if m.geom_type[g] == _PLANE:
            at = at - axes[:, 2] * shape["box"][2] / 2   # its upper side
        content = {**shape, "position": p.in_body(body, at), "color": tuple(min(max(round(float(x), 6), 0.0), 1.0) for x in color[:3])}
        turned = p.axes_in(body, axes)
        if not np.array_equal(turned, np.eye(3)):
            content["directors"] = tuple(tuple(float(x) for x in row) for row in turned.T)
        if color[3] < 1:
            content["opacity"] = round(float(color[3]), 6)
        return Table(content, p.place)

    def _shape(self, g: int) -> dict[str, Any] | None:
        p, m = self._p, self._p.m
        kind, (x, y, z) = int(m.geom_type[g]), (float(s) for s in m.geom_size[g])
        round_ = Table({"radius": x, "length": 2 * y}, p.place)
        if kind == _MESH:
            return self._mesh(g)
        if kind == _PLANE:
            if x > 0 and y > 0:
                return {"box": (2 * x, 2 * y, 1e-3 * (x + y))}
            p.losses.add(_ENDLESS, original(m, "geom", g))
        elif kind == _FIELD or kind > _MESH:
            p.losses.add(_FIELDS, original(m, "geom", g))
        else:
            shapes: dict[int, dict[str, Any]] = {
                _SPHERE: {"sphere": x}, _CAPSULE: {"capsule": round_}, _ELLIPSOID: {"ellipsoid": (x, y, z)},
                _CYLINDER: {"cylinder": round_}, _BOX: {"box": (2 * x, 2 * y, 2 * z)}}
            return shapes.get(kind)
        return None

    def _mesh(self, g: int) -> dict[str, Any] | None:
        p, mesh = self._p, int(self._p.m.geom_dataid[g])
        name = original(p.m, "geom", g) or name_of(p.m, "mesh", mesh)
        if self._folder is None:
            p.losses.add(_UNDRAWN, name)
            return None
        if mesh not in self._files:
            self._files[mesh] = self._written(mesh)
        if not self._files[mesh]:
            p.losses.add(_FIELDS, name)
            return None
        return {"mesh": self._files[mesh], "unit": "m"}

    def _written(self, mesh: int) -> str:
        """Its file in the folder; empty without triangles."""
        m = self._p.m
        begin, n = int(m.mesh_faceadr[mesh]), int(m.mesh_facenum[mesh])
        corners = np.asarray(m.mesh_vert[int(m.mesh_vertadr[mesh]):][m.mesh_face[begin:begin + n]], dtype="<f4")
        normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
        length = np.linalg.norm(normals, axis=1)
        kept = length > 0
        if not kept.any():
            return ""
        triangles = np.zeros(int(kept.sum()), dtype=[("normal", "<f4", 3), ("corners", "<f4", (3, 3)), ("attribute", "<u2")])
        triangles["normal"], triangles["corners"] = normals[kept] / length[kept, None], corners[kept]
        content = b"livens".ljust(80) + np.uint32(len(triangles)).astype("<u4").tobytes() + triangles.tobytes()
        stem = re.sub(r"[^A-Za-z0-9_-]", "_", name_of(m, "mesh", mesh))[:80]
        taken = {name.lower() for name in self._files.values()}
        file, k = f"{stem}.stl", 2
        while file.lower() in taken:
            file, k = f"{stem}_{k}.stl", k + 1
        _write(os.path.join(self._folder or "", file), content)
        return file


def _write(path: str, content: bytes) -> None:
    """A file of other content is not replaced."""
    os.makedirs(os.path.dirname(path) or ".", exist_ok=True)
    if os.path.lexists(path):
        if os.path.isfile(path):
            with open(path, "rb") as stream:
                if stream.read(len(content) + 1) == content:
                    return
        raise FileExistsError(errno.EEXIST, "a mesh of the model would replace a file of other content", path)
    _core.write_file(path, content)
