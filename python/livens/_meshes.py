# SPDX-License-Identifier: BSD-3-Clause
"""Meshes of models, wherever their files lie, and those that the core does not read."""
from __future__ import annotations

import functools
import importlib
import os
import tempfile
import zlib
from collections.abc import Iterator
from typing import Any

from ._errors import fault

_READ = (".stl", ".obj", ".ply", ".msh", ".dae")


class MeshFile(str):
    """What a mesh is called in a model, and the file that the caller has named for it. Names in files of scenarios never
    become one: what a stranger's file names stays below its folder."""

    path: str


def mesh_file(file: str | os.PathLike[str]) -> str:
    """A mesh as a model names it: a path below the model's folder, or a :class:`MeshFile` for all other files."""
    name = os.fspath(file)
    if isinstance(name, MeshFile):
        return name
    stem, ending = os.path.splitext(os.path.basename(name))
    is_read = ending.lower() in _READ
    if is_read and not os.path.isabs(name) and os.pardir not in name.split("/"):
        return name
    path = os.path.abspath(name)
    with open(path, "rb") as stream:   # the same name for the same content, on any machine
        content = stream.read()
    if not is_read:
        path, ending = _converted(path, ending), ".obj"
    made = MeshFile(f"{stem}-{zlib.crc32(content):08x}{ending}")
    made.path = path
    return made


def named_meshes(tree: Any) -> Iterator[MeshFile]:
    """Of all shapes of a tree."""
    items = tree.values() if isinstance(tree, dict) else tree if isinstance(tree, (list, tuple)) else ()
    for item in items:
        if isinstance(item, MeshFile):
            yield item
        else:
            yield from named_meshes(item)


@functools.lru_cache(maxsize=1)
def _folder() -> tempfile.TemporaryDirectory[str]:
    """Of converted meshes; it ends with the process."""
    return tempfile.TemporaryDirectory(prefix="livens-meshes-")


@functools.lru_cache(maxsize=None)
def _converted(path: str, ending: str) -> str:
    """As OBJ, whose numbers are decimal: nothing is rounded."""
    try:
        trimesh: Any = importlib.import_module("trimesh")
    except ImportError:
        raise fault("mesh-format", f"the ending '{ending}' of a mesh is none of {', '.join(_READ)}; others are read by trimesh, "
                    "which is not installed", "mesh", "pip install trimesh, or convert the file") from None
    try:
        mesh = trimesh.load(path, force="mesh")
        points, faces = mesh.vertices, mesh.faces
    except Exception as error:   # whatever its readers raise
        raise fault("mesh-format", f"trimesh cannot read '{path}': {error}", "mesh", "") from error
    if len(faces) == 0:
        raise fault("mesh-format", f"'{path}' has no faces", "mesh", "")
    target = os.path.join(_folder().name, f"{abs(hash((path, ending))):x}.obj")
    with open(target, "w", encoding="ascii") as stream:
        stream.writelines(f"v {x!r} {y!r} {z!r}\n" for x, y, z in points.tolist())
        stream.writelines(f"f {a + 1} {b + 1} {c + 1}\n" for a, b, c in faces.tolist())
    return target
