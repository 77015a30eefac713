# SPDX-License-Identifier: BSD-3-Clause
"""The tree of a model: looked up by name, edited and checked, built by the compiled reader."""
from __future__ import annotations

import os
import warnings
from collections.abc import Callable, Mapping
from dataclasses import replace
from typing import TYPE_CHECKING, Any

from . import _core
from ._entries import Entry, Names, RootSection, Section, default_name, unknown_name
from ._errors import Diagnostic, InputError, ModelWarning, fault, raised, stack_level, user_place
from ._functions import adapted
from ._generated import Adders, Body, Controller, Drive, Event, Joint, Load, Point, Sensor, Stop
from ._included import has_point
from ._places import arranged, diagnostic_of, faults_in, key_below, of_table, path_at, path_of, store, words_in
from ._rotations import oriented, with_rotation
from ._state import Coordinates
from ._tree import KINDS, Table, diagnostics_of_text, frozen, plain, schema, toml
from ._values import Shape

_TYPES: dict[str, type[Entry]] = {"body": Body, "point": Point, "joint": Joint, "drive": Drive, "load": Load, "sensor": Sensor,
                                "event": Event, "stop": Stop, "controller": Controller}
_MISSING = object()
_INSTEAD = {   # keys that say the same in other ways: assigning one takes the others away
    "body": (("mass", "density"), ("directors", "quaternion", "rotation_vector"),
             ("angular_velocity", "angular_velocity_body")),
    "time": (("accuracy", "elements"),)}
_SHOWN_BODIES = 30   # that a part of a model holds beside what it needs, for the sake of suggestions


class Tree(Adders):
    """What a model is made of, and what happens to it; :class:`livens.Model` is what people see of it."""

    _root: Table
    _file: str
    _home: str   # of an imported model: where paths of its meshes begin
    _imported: tuple[Diagnostic, ...]
    _text: str | None   # as it was read, as long as nothing was edited
    _functions: dict[str, tuple[str | None, Callable[..., Any]]]   # None: a guard of an event
    _built: dict[Any, tuple[Any, list[Diagnostic]]]
    _counted: dict[tuple[tuple[str, ...], float | None], Coordinates]
    _names: dict[str, list[tuple[str, Table]]] | None
    _order: dict[int, int]
    _warned: bool

    # Building.

    @property
    def _folder(self) -> str:
        """Where its meshes are: beside the file that it came from, else where Python is."""
        if self._home:
            return self._home
        return os.path.dirname(self._file) if os.path.isfile(self._file) else ""

    def _build(self, overrides: Mapping[str, Any]) -> tuple[Any, list[Diagnostic]]:
        """(compiled scenario or None, diagnostics); what was built last is kept."""
        key = frozen(overrides)
        if key in self._built:
            return self._built[key]
        if self._text is not None and not overrides:
            scenario, found = _core.build_text(self._text, self._file, self._folder)
            made = self._with_paths(diagnostics_of_text(found, self._file, self._text))
        else:
            root = self._with(overrides)
            scenario, found = _core.build_tree(root, toml(root), self._folder)
            made = [diagnostic_of(d, root) for d in found]
        if scenario is not None:
            for name, (body, function) in self._functions.items():
                scenario = (scenario.with_guard(name, function) if body is None
                            else scenario.with_load(name, body, adapted(function)))
        if len(self._built) >= 4:
            self._built.pop(next(iter(self._built), None), None)
        self._built[key] = (scenario, made)
        return self._built[key]

    def _scenario(self, overrides: Mapping[str, Any]) -> Any:
        """Compiled; raises what is wrong, and warns once of what is worth a look."""
        scenario, found = self._build(overrides)
        if scenario is None:
            raise raised(found)
        if found and not self._warned:
            self._warned = True
            for d in found:
                warnings.warn(str(d), ModelWarning, stacklevel=stack_level())
        return scenario

    def _with(self, overrides: Mapping[str, Any]) -> Table:
        root = Table(self._root, self._root.place, self._root.places)
        root.update(overrides)
        return root

    def _with_paths(self, found: list[Diagnostic]) -> list[Diagnostic]:
        """Of a scenario that was read: the path of what stands there."""
        return [replace(d, path=path_at(self._root, d.place)) for d in found]

    def _refuse_functions(self, what: str) -> None:
        if self._functions:
            names = ", ".join(f"'{name}'" for name in self._functions)
            raise fault("python-function", f"{names} is a Python function, so the model cannot be {what}",
                        help="write it as an expression, or remove it: m.remove(name)")

    # Editing.

    def _forget(self) -> None:
        self._built, self._names, self._order, self._warned = {}, None, {}, False
        self._counted = {}   # coordinates, by those that were wanted and the time

    def _touch(self) -> None:
        self._text = None
        self._forget()

    def _named(self, name: str) -> list[tuple[str, Table]]:
        if self._names is None:
            self._names, self._order = {}, {}
            for kind in KINDS:
                for table in self._root.get(kind, []):
                    self._names.setdefault(default_name(kind, table), []).append((kind, table))
                    self._order[id(table)] = len(self._order)
        return self._names.get(name, []) if isinstance(name, str) else []

    def _handle(self, kind: str, table: Table) -> Entry:
        return _TYPES[kind](self, table, schema().children[kind], kind)

    def _section(self, name: str) -> Section:
        return RootSection(self, Table(place=user_place()), schema().children[name], name)

    def _root_section(self) -> Section:
        return Section(self, self._root, schema().root, "model")

    def _edit_root(self, name: str, value: Any) -> None:
        key = schema().key(schema().root, {}, name)
        old = self._root.get(name, _MISSING)
        store(self._root, name, plain(value, key, name))
        _, found = _core.build_tree({**{key: self._root[key] for key in ("format", "parameters", name) if key in self._root}},
                                    "", "", True)
        self._raise_or_keep(self._root, name, old,
                            [diagnostic_of(d, self._root) for d in found
                             if d["location"][0] == name and d["severity"] == "error"
                             and not d["code"].startswith("mesh-")])

    def _edit(self, section: Section, name: str, value: Any) -> None:
        top = section
        while top._top is not None:
            top = top._top
        key = schema().key(section._schema, section._table, name)
        path = f"{path_of(top._key, top._table)}.{name}"
        if key is None and value is None:
            raise fault("unknown-key", f"unknown key '{name}' in {section._label()}", path, section._suggestion(name))
        if top._key in KINDS and not any(table is top._table for table in self._root.get(top._key, [])):
            raise unknown_name(top._key, f"{top.name} (which was removed)", list(Names(self, top._key, Entry)))
        if isinstance(value, Shape) and name != "visual":
            return self._reshape(section, value)
        if name == "rotation" and key is None and value is not None:
            name, value = oriented(value)
            name = name or "rotation"
            key = schema().key(section._schema, section._table, name)
            path = f"{path_of(top._key, top._table)}.{name}"
        if name == "name" and isinstance(value, str) and top._key in KINDS and value != section._table.get("name"):
            if any(kind == top._key for kind, _ in self._named(value)):
                raise fault("name-duplicate", f"a {top._key} called '{value}' exists already", path,
                            "names are unique among their kind")
        old = section._table.get(name, _MISSING)
        replaced = {} if value is None or section is not top else {
            other: section._table[other] for group in _INSTEAD.get(top._key, ()) if name in group
            for other in group if other != name and other in section._table}
        for other in replaced:
            del section._table[other]
        if value is None:
            section._table.pop(name, None)
        else:
            store(section._table, name, plain(value, key, path))
        top_key = name if section is top else key_below(section, top)
        if section is not top:
            top._table.places[top_key] = user_place()
        found = [] if value is None else [
            of_table(d, top._key, top._table) for d in _core.check_table(top._key, top._table, self._root.get("parameters", {}))
            if d["severity"] == "error" and d["location"][2] == top_key]
        if found:
            section._table.update(replaced)
        self._raise_or_keep(section._table, name, old, found)
        if top._key not in KINDS and top._key not in self._root:
            self._root[top._key] = top._table

    def _reshape(self, section: Section, shape: Shape) -> None:
        """A shape with the density or mass that it brings, which replaces the other."""
        before = Table(section._table, places=section._table.places)
        try:
            self._edit(section, "shape", shape.keys["shape"])
            for key, other in (("density", "mass"), ("mass", "density")):
                if key in shape.keys:
                    self._edit(section, other, None)
                    self._edit(section, key, shape.keys[key])
        except InputError:
            section._table.clear()
            section._table.update(before)
            section._table.places = before.places
            raise

    def _raise_or_keep(self, table: Table, name: str, old: Any, found: list[Diagnostic]) -> None:
        if not found:
            return self._touch()
        if old is _MISSING:
            table.pop(name, None)
        else:
            table[name] = old
        raise raised(found)

    def _add(self, kind: str, word: str, content: Mapping[str, Any]) -> Any:
        """Appends a table, or raises what is wrong with it."""
        name = content.get("name")
        path = f"{kind}[{name if isinstance(name, str) else len(self._root.get(kind, [])) + 1}]"
        table = Table(place=user_place())
        given = {"name": name, "type": word or None, **with_rotation(arranged(content, word, self._is_point))}
        self._refuse_part_as_type(kind, word, name)
        for key_name, value in given.items():
            if value is None:
                continue
            key = schema().key(schema().children[kind], {"type": word} if word else {}, key_name)
            table[key_name] = plain(value, key, f"{path}.{key_name}")
            table.places[key_name] = table.place
        self._named("")
        names, order = self._names, self._order
        assert names is not None
        called = default_name(kind, table)
        entries = self._root.setdefault(kind, [])
        entries.append(table)
        names.setdefault(called, []).append((kind, table))
        order[id(table)] = len(order)
        try:
            found = self._faults_of(kind, table)
        except BaseException:
            found = []
            is_refused = True
            raise
        else:
            is_refused = bool(found)
        finally:
            if is_refused:
                entries.pop()
                names[called].pop()
                del order[id(table)]
                if not entries:
                    del self._root[kind]
        if found:
            raise raised(found)
        self._text, self._built, self._warned = None, {}, False
        return self._handle(kind, table)

    def _include(self, table: Table) -> None:
        """Appends an ``[[include]]``, or raises what is wrong with it."""
        includes = self._root["include"] = self._root.get("include", [])
        includes.append(table)
        found = faults_in({**self._root, "time": {"end": 1}}, "include", table)
        if found:
            includes.pop()
            if not includes:
                del self._root["include"]
            raise raised(found)
        self._touch()

    def _is_point(self, part: object) -> bool:
        """Whether a part in front is a point: a handle, or the name of one."""
        if isinstance(part, Entry):
            return part._key == "point"
        if not isinstance(part, str):
            return False
        kinds = [kind for kind, _ in self._named(part)]
        return kinds == ["point"] or (not kinds and has_point(self._root, part))

    def _refuse_part_as_type(self, kind: str, word: str, name: object) -> None:
        """add_drive("motor", "pivot", rate=1): the joint stands where the type does."""
        if kind not in ("drive", "sensor", "load") or word in [k["word"] for k in schema().children[kind]["kinds"]]:
            return
        part = next((found for found, _ in self._named(word) if found in ("joint", "body")), "")
        if part:
            method = {"drive": f"m.add_{part}_drive(", "sensor": f"m.add_{'joint' if part == 'joint' else 'point'}_sensor(",
                      "load": "m.add_actuator(" if part == "joint" else "m.add_force("}[kind]
            raise fault("unknown-choice", f"'{word}' is a {part}, and add_{kind}() takes a type there", f"{kind}[{name}].type",
                        f"{method}{name!r}, {word!r}, ..)")

    def _faults_of(self, kind: str, table: Table) -> list[Diagnostic]:
        """Of a table at the end of its kind, by a model of what it refers to and no more."""
        part, is_whole = self._part_around(kind, table)
        found = faults_in(part, kind, table)
        if found and not is_whole:   # in the whole model lengths, and what is allowed, may be other ones
            found = faults_in({**self._root, "time": {"end": 1}}, kind, table)
        return found

    def _part_around(self, kind: str, table: Table) -> tuple[dict[str, Any], bool]:
        wanted: dict[int, tuple[str, Table]] = {}
        open_ends = [(kind, table)]
        for body in self._root.get("body", [])[:_SHOWN_BODIES]:
            open_ends.append(("body", body))
        while open_ends:
            at_kind, at = open_ends.pop()
            if id(at) in wanted:
                continue
            wanted[id(at)] = (at_kind, at)
            words = [default_name(at_kind, at), *(w for name, v in at.items() if name != "name" for w in words_in(v))]
            for word in words:
                for candidate in {word, word.rpartition(".")[0]}:
                    open_ends += self._named(candidate)
        part: dict[str, Any] = {key: value for key, value in self._root.items() 
                                if key in ("format", "parameters", "gravity", "start")}
        part["time"] = {"end": 1}
        if "include" in self._root:
            part["include"] = self._root["include"]
        for part_kind, part_table in sorted(wanted.values(), key=lambda item: self._order[id(item[1])]):
            part.setdefault(part_kind, []).append(part_table)
        n_all = sum(len(self._root.get(k, [])) for k in KINDS)
        return part, len(wanted) == n_all
