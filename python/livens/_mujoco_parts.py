# SPDX-License-Identifier: BSD-3-Clause
"""Bodies and points out of MuJoCo's compiled model at a pose, and the tables that all parts go to."""
from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from ._errors import Place, fault
from ._losses import Loss, Losses, unseen
from ._mujoco_fields import FREE, TINY, WORLD, UniqueNames, is_off, name_of, original
from ._mujoco_joints import add_equalities, add_joint
from ._mujoco_loads import add_actuators, add_loads_of_body, add_tendons
from ._mujoco_looks import Looks
from ._mujoco_others import tell_others
from ._tree import Table

_MERGED = Loss("import-merged", "body", "bodies", "merged into the body of the parent (no joints between)")
_MASSLESS = Loss("import-mended", "body", "bodies", f"massless, and given {TINY:g} of the smallest mass", names_all=True)
_FREE = Loss("import-merged", "joint", "joints", "free joints are not needed (the body is free)")
_RENAMED = Loss("import-merged", "name", "names", "changed, because names are unique and have no control characters")
_BETWEEN = Loss("import-mended", "joint", "joints",
                f"followed by another joint of the same body, with a body of {TINY:g} of the smallest mass between them", names_all=True)
_SITE = unseen("site", "sites without names are not kept")


def numbers(values: Any) -> tuple[float, ...]:
    return tuple(float(x) + 0.0 for x in values)   # no -0.0


def rows(matrix: Any) -> tuple[tuple[float, ...], ...]:
    return tuple(numbers(row) for row in matrix)


class Parts:
    """The scenario's tree as it grows."""

    def __init__(self, m: Any, data: Any, losses: Losses, stops: bool, meshes: str | None, place: Place) -> None:
        self.m, self.d, self.losses, self.stops, self.place = m, data, losses, stops, place
        self.root = Table({"format": 1}, place)
        self.names = UniqueNames()
        self.owner = np.zeros(m.nbody, int)   # the body that this one is part of; 0: the world
        for b in range(1, m.nbody):
            self.owner[b] = b if m.body_jntnum[b] else self.owner[m.body_parentid[b]]
        self.moving = [b for b in range(1, m.nbody) if self.owner[b] == b]
        self.parts_of: dict[int, list[int]] = {}   # bodies of the file that make up one here
        for b in range(1, m.nbody):
            self.parts_of.setdefault(int(self.owner[b]), []).append(b)
        self.body_names = {0: WORLD}
        self.joint_names: dict[int, str] = {}
        self.coordinates: dict[int, str] = {}   # of hinges and slides: "knee.angle"
        self.looks = Looks(self, meshes)
        self.smallest, self.radius = 0.0, 1.0   # mass, and largest square of a radius of gyration

    def add(self, kind: str, content: Mapping[str, Any]) -> Table:
        table = Table(content, self.place)
        self.root.setdefault(kind, []).append(table)
        return table

    def named(self, kind: str, i: int, word: str) -> str:
        """A name of its own for a part of the file."""
        name = self.names.of(name_of(self.m, kind, i), word)
        if original(self.m, kind, i) not in ("", name):
            self.losses.add(_RENAMED, name)
        return name

    def dot(self) -> list[Table]:
        """What is drawn of a body that is there for computing alone: next to nothing."""
        return [Table({"sphere": 1e-3 * self.radius ** 0.5}, self.place)]

    def in_body(self, body: int, point: Any) -> tuple[float, ...]:
        """A point of the world in coordinates of a body that moves, or of the world."""
        if body == 0:
            return numbers(point)
        return numbers(self.d.xmat[body].reshape(3, 3).T @ (point - self.d.xpos[body]))

    def axes_in(self, body: int, axes: Any) -> Any:
        """Likewise of axes, which stand in columns."""
        return axes if body == 0 else self.d.xmat[body].reshape(3, 3).T @ axes

    def add_all(self, controls: Sequence[float | str]) -> None:
        title = bytes(self.m.names).split(b"\0", 1)[0].decode("utf-8", "replace")
        clean = "".join(c if c.isprintable() else " " for c in title)[:200]
        if clean:
            self.root["title"] = clean
        gravity = np.zeros(3) if is_off(self.m, "GRAVITY") else np.array(self.m.opt.gravity)
        self.root["gravity"] = numbers(gravity)
        if not self.moving:
            raise fault("mass-missing", "nothing in this model moves: no body has a joint", place=self.place)
        for b in self.moving:
            self.body_names[b] = self.named("body", b, "body")
        self._add_bodies()
        for b in self.moving:
            self._add_joints(b)
        add_equalities(self)
        for b in self.moving:
            add_loads_of_body(self, b, gravity)
        add_tendons(self)
        add_actuators(self, controls)
        self._add_points()
        tell_others(self)

    # Bodies.

    def _add_bodies(self) -> None:
        found = {b: self._mass_of(b) for b in self.moving}
        masses = [mass for mass, _, _ in found.values() if mass > 0]
        if not masses:
            raise fault("mass-missing", "no body that moves has a mass", place=self.place)
        self.smallest = min(masses)
        self.radius = max(float(np.trace(J)) / mass for mass, _, J in found.values() if mass > 0) or 1.0
        for b, (mass, center, inertia) in found.items():
            if not mass > 0 or not np.trace(inertia) > 0:
                self.losses.add(_MASSLESS, self.body_names[b])
                mass = mass if mass > 0 else TINY * self.smallest
                inertia = inertia if np.trace(inertia) > 0 else np.eye(3) * TINY * self.smallest * self.radius
            velocity, spin = self.velocity(self.d.cvel[b], b, self.d.xpos[b])
            content = {"name": self.body_names[b], "mass": float(mass), "center_of_mass": numbers(center),
                       "inertia": _least(inertia), **self._placed(self.d.xpos[b], self.d.xmat[b].reshape(3, 3), velocity, spin)}
            if visual := self.looks.of(b):
                content["visual"] = visual
            self.add("body", content)
        if visual := self.looks.of(0):
            self.root["world"] = Table({"visual": visual}, self.place)

    def _mass_of(self, b: int) -> tuple[float, Any, Any]:
        """Mass, centre of mass and inertia about it, in axes of the body, of all that is part of it."""
        m, d = self.m, self.d
        parts = self.parts_of[b]
        for c in parts:
            if c != b:
                self.losses.add(_MERGED, name_of(m, "body", c))
        mass = float(sum(m.body_mass[c] for c in parts))
        if not mass > 0:
            return 0.0, np.zeros(3), np.zeros((3, 3))
        R, p = d.xmat[b].reshape(3, 3), d.xpos[b]
        center = sum(m.body_mass[c] * (d.xipos[c] - p) for c in parts) / mass
        J = np.zeros((3, 3))
        for c in parts:
            A, r = R.T @ d.ximat[c].reshape(3, 3), R.T @ (d.xipos[c] - p - center)
            J += A @ np.diag(m.body_inertia[c]) @ A.T + m.body_mass[c] * (r @ r * np.eye(3) - np.outer(r, r))
        return mass, R.T @ center, (J + J.T) / 2

    def velocity(self, spatial: Any, b: int, point: Any) -> tuple[Any, Any]:
        """Velocity of a point and angular velocity, of a spatial velocity as MuJoCo has them for body b."""
        spin = np.array(spatial[:3])
        return spatial[3:] + np.cross(spin, point - self.d.subtree_com[self.m.body_rootid[b]]), spin

    @staticmethod
    def _placed(position: Any, axes: Any, velocity: Any, spin: Any) -> dict[str, Any]:
        keys: dict[str, Any] = {"position": numbers(position)}
        if not np.array_equal(axes, np.eye(3)):
            keys["directors"] = rows(axes.T)
        if np.any(velocity):
            keys["velocity"] = numbers(velocity)
        if np.any(spin):
            keys["angular_velocity"] = numbers(spin)
        return keys

    # Joints.

    def _add_joints(self, b: int) -> None:
        """Those of one body, with nearly massless bodies between where there are several."""
        m, d = self.m, self.d
        joints = range(m.body_jntadr[b], m.body_jntadr[b] + m.body_jntnum[b])
        if [int(m.jnt_type[j]) for j in joints] == [FREE]:
            self.losses.add(_FREE, name_of(m, "jnt", joints[0]))
            return
        parent = m.body_parentid[b]
        spatial, last = np.array(d.cvel[parent]), self.body_names[self.owner[parent]]
        for j in joints:
            name = self.named("jnt", j, "joint")
            second = self.body_names[b]
            if j != joints[-1]:
                n = 3 if m.jnt_type[j] == 1 else 1
                for dof in range(m.jnt_dofadr[j], m.jnt_dofadr[j] + n):
                    spatial = spatial + d.cdof[dof] * d.qvel[dof]
                second = self._add_between(b, j, name, spatial)
            add_joint(self, j, name, last, second)
            last = second

    def _add_between(self, b: int, j: int, joint: str, spatial: Any) -> str:
        name = self.names.of(f"behind {joint}", "body")
        mass = TINY * self.smallest
        at = np.array(self.d.xanchor[j])
        velocity, spin = self.velocity(spatial, b, at)
        self.add("body", {"name": name, "mass": mass, "inertia": numbers([mass * self.radius] * 3),
                          **self._placed(at, np.eye(3), velocity, spin), "visual": self.dot()})
        self.losses.add(_BETWEEN, joint)
        return name

    # Points.

    def _add_points(self) -> None:
        m, d = self.m, self.d
        for b in range(1, m.nbody):
            if self.owner[b] != b and original(m, "body", b):
                self.add("point", {"name": self.named("body", b, "body"), "body": self.body_names[self.owner[b]],
                                   "position": self.in_body(self.owner[b], d.xpos[b])})
        for s in range(m.nsite):
            if not original(m, "site", s):
                self.losses.add(_SITE)
                continue
            owner = self.owner[m.site_bodyid[s]]
            self.add("point", {"name": self.named("site", s, "site"), "body": self.body_names[owner],
                               "position": self.in_body(owner, d.site_xpos[s])})


def _least(inertia: Any) -> Any:
    """Three numbers where the axes are those of the body."""
    off = np.abs(inertia - np.diag(np.diag(inertia))).max()
    return numbers(np.diag(inertia)) if off <= 1e-15 * np.trace(inertia) else rows(inertia)
