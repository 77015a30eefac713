# SPDX-License-Identifier: BSD-3-Clause
"""Models that are parts of other models."""
from __future__ import annotations

import os
from collections.abc import Iterator, Mapping
from typing import TYPE_CHECKING, Any

from . import _core
from ._entries import default_name, unknown_name
from ._errors import fault, user_place
from ._meshes import MeshFile
from ._rotations import with_rotation
from ._tree import KINDS, Table, plain, schema

if TYPE_CHECKING:
    from ._editing import Tree

PLACEMENT = ("position", "rotation", "directors", "quaternion", "rotation_vector")


class Added(Mapping[str, str]):
    """What :meth:`Model.add` has brought in: names there by names in the model that was added.

    ``left["knee"]`` is ``"left knee"``, which stands wherever a name does; an unknown name is a ``KeyError`` that says
    which one was probably meant. To change a part, change the model before it is added.

    Example:
        >>> import livens as lv
        >>> wheel = lv.Model("wheel")
        >>> rim = wheel.add_body("rim", lv.cylinder(radius=0.3, length=0.05, mass=8))
        >>> m = lv.Model("cart")
        >>> front = m.add(wheel, "front ", position=(1, 0, 0))
        >>> front["rim"]
        'front rim'
    """

    def __init__(self, prefix: str, names: list[str]) -> None:
        self.prefix = prefix
        """What stands before all names."""
        self._names = dict.fromkeys(names)

    def __getitem__(self, name: Any) -> str:
        plain: str = name.name if hasattr(name, "_table") else name
        if plain not in self._names:
            raise unknown_name("part", plain, list(self._names))
        return self.prefix + plain

    def __iter__(self) -> Iterator[str]:
        return iter(self._names)

    def __len__(self) -> int:
        return len(self._names)

    def __repr__(self) -> str:
        return f"<livens.Added '{self.prefix}': {', '.join(self._names)}>"


def names_of(root: Mapping[str, Any]) -> list[str]:
    """All names of a model, also of models in it, but for those of files that it includes."""
    names = [default_name(kind, table) for kind in KINDS for table in root.get(kind, [])]
    for include in root.get("include", []):
        names += [include.get("prefix", "") + name for name in names_of(include.get("model", {}))]
    return names


def has_point(root: Mapping[str, Any], name: str) -> bool:
    """Whether a model in a model has a point that is called so there; of files that are included nothing is known."""
    for include in root.get("include", []):
        prefix, inside = include.get("prefix", ""), include.get("model", {})
        own = name[len(prefix):]
        if name.startswith(prefix) and (any(p.get("name") == own for p in inside.get("point", []))
                                        or has_point(inside, own)):
            return True
    return False


def files_of(tree: Any) -> list[str]:
    """Paths of all files below its folder that a tree names: meshes, and what it includes."""
    items = tree.items() if isinstance(tree, dict) else enumerate(tree) if isinstance(tree, (list, tuple)) else ()
    return [path for key, item in items if not isinstance(item, MeshFile)
            for path in ([item] if key in ("mesh", "file") and isinstance(item, str) else files_of(item))]


def files_below(tree: Any, folder: str) -> dict[str, str]:
    """The same that are there, by paths below the folder, and those that files of scenarios among them name."""
    found: dict[str, str] = {}
    left = [(tree, "")]
    while left:
        one, begin = left.pop()
        for named in files_of(one):
            path = os.path.normpath(os.path.join(begin, named))
            source = os.path.join(folder, path)
            outside = os.path.isabs(path) or path.split(os.sep)[0] == os.pardir   # which no scenario may name
            if outside or path in found or not os.path.isfile(source):
                continue
            found[path] = source
            if path.endswith(".toml"):
                from ._load import load
                left.append((load(source, check=False)._root, os.path.dirname(path)))
    return found


def _moved_files(tree: Any, folder: str) -> None:
    """Paths that began elsewhere begin there."""
    for key, item in tree.items():
        if key in ("mesh", "file") and isinstance(item, str) and not isinstance(item, MeshFile):
            tree[key] = f"{folder}/{item}"
        for inside in item if isinstance(item, list) else [item]:
            if isinstance(inside, dict):
                _moved_files(inside, folder)


def as_part(model: Tree, other: Tree, prefix: str, placement: Mapping[str, Any]) -> tuple[Table, Added]:
    """The table ``[[include]]`` of a model, and its names."""
    if not isinstance(prefix, str):
        raise TypeError(f"prefix= is a string, not {type(prefix).__name__}")
    other._refuse_functions("added to another one")
    inside = other._root.copy()
    for key in ("format", "title", "time", "method"):   # how it is solved alone
        inside.pop(key, None)
        inside.places.pop(key, None)
    if files_of(inside):
        folder = os.path.relpath(os.path.abspath(other._folder), os.path.abspath(model._folder)).replace(os.sep, "/")
        if folder.startswith(".."):
            raise fault("include-path", f"files of the model that is added lie in '{folder}', outside of the folder of this one",
                        "include.model", "put them beside the file of this model, or below it")
        if folder != ".":
            _moved_files(inside, folder)
    table = Table(place=user_place())
    table["model"] = inside
    given = with_rotation({key: value for key, value in placement.items() if value is not None})
    for key, value in {"prefix": prefix or None, **given}.items():
        if value is not None:
            known = schema().key(schema().children["include"], {}, key)
            table[key] = plain(value, known, f"include.{key}")
    table.places.update(dict.fromkeys(table, table.place))
    return table, Added(prefix, names_of(inside))
