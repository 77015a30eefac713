# SPDX-License-Identifier: BSD-3-Clause
"""The model: a scenario's tree that is edited by name."""
from __future__ import annotations

import os
import warnings
from collections.abc import Callable, Mapping
from typing import TYPE_CHECKING, Any

import numpy as np

from . import _core
from ._entries import Entry, Names, RootSection, Section, default_name, unknown_name
from ._errors import (Diagnostic, InputError, ModelWarning, SlowWarning, fault, file_name, raised,
                      stack_level, user_place)
from ._functions import adapted
from ._generated import Adders, Body, Drive, Joint, Load, Sensor
from ._values import Shape
from ._places import arranged, diagnostic_of, faults_in, key_below, of_table, path_at, path_of, some_time, store, words_in
from ._tree import KINDS, Table, diagnostics_of_text, frozen, plain, schema, toml

_TYPES: dict[str, type[Entry]] = {"body": Body, "joint": Joint, "drive": Drive, "load": Load, "sensor": Sensor}
_MISSING = object()
_INSTEAD = {   # keys that say the same in other ways: assigning one takes the others away
    "body": (("mass", "density"), ("directors", "quaternion", "rotation_vector"),
             ("angular_velocity", "angular_velocity_body")),
    "time": (("accuracy", "elements"),)}
_SHOWN_BODIES = 30   # that a part of a model holds beside what it needs, for the sake of suggestions


class Model(Adders):
    """Bodies, joints, drives, loads and sensors: the tree of a scenario file, edited by name.

    Args:
        title: One line for people.
        gravity: Acceleration of free fall, m/s^2, world axes, shape (3,). Default: none.

    Everything is refused where it is written: errors are :class:`InputError` with the line of the call. Models
    can be compared, copied, pickled and hashed (by content, so do not edit a model that is a key of a dict).

    Example:
        >>> import livens as lv
        >>> m = lv.Model("pendulum", gravity=(0, 0, -9.81))
        >>> rod = m.add_body("rod", lv.box(1, "5 cm", "5 cm", density=7850), position=(0.5, 0, 0))
        >>> pivot = m.add_revolute("pivot", "world", rod, at=(0, 0, 0), axis=(0, 1, 0))
        >>> sol = lv.solve(m, 2)
        >>> sol.success
        True
    """

    def __init__(self, title: str = "", *, gravity: Any = None) -> None:
        self._root = Table({"format": 1}, user_place())
        self._file = ""
        self._text: str | None = None   # as it was read, as long as nothing was edited
        self._functions: dict[str, tuple[str, Callable[..., Any]]] = {}
        self._warned = False
        self._forget()
        if title:
            self.title = title
        if gravity is not None:
            self.gravity = gravity

    if not TYPE_CHECKING:   # who checks types knows what there is

        def __setattr__(self, name: str, value: Any) -> None:
            if not name.startswith("_") and not hasattr(type(self), name):
                known = ["title", "gravity"]
                raise AttributeError(f"a model has no '{name}' to set; {_core.suggestion(name, known)}", name=name, obj=self)
            super().__setattr__(name, value)

    # What is there.

    @property
    def title(self) -> str:
        """One line for people."""
        return str(self._root.get("title", ""))

    @title.setter
    def title(self, value: str) -> None:
        self._edit_root("title", value)

    @property
    def gravity(self) -> np.ndarray[Any, np.dtype[np.float64]]:
        """Acceleration of free fall, m/s^2, world axes, shape (3,)."""
        gravity: np.ndarray[Any, np.dtype[np.float64]] = self._root_section().__getattr__("gravity")
        return gravity

    @gravity.setter
    def gravity(self, value: Any) -> None:
        self._edit_root("gravity", value)

    @property
    def bodies(self) -> Names[Body]:
        """All bodies by name."""
        return Names(self, "body", Body)

    @property
    def joints(self) -> Names[Joint]:
        """All joints by name."""
        return Names(self, "joint", Joint)

    @property
    def drives(self) -> Names[Drive]:
        """All drives by name."""
        return Names(self, "drive", Drive)

    @property
    def loads(self) -> Names[Load]:
        """All loads by name; Python functions are not among them."""
        return Names(self, "load", Load)

    @property
    def sensors(self) -> Names[Sensor]:
        """All sensors by name."""
        return Names(self, "sensor", Sensor)

    @property
    def time(self) -> Section:
        """The table ``[time]``: ``m.time.end = 5``. What :func:`livens.solve` is told wins."""
        return self._section("time")

    @property
    def method(self) -> Section:
        """The table ``[method]``."""
        return self._section("method")

    @property
    def start(self) -> Section:
        """The table ``[start]``: ``m.start.initial = "project"``."""
        return self._section("start")

    @property
    def end(self) -> Section:
        """The table ``[end]``."""
        return self._section("end")

    def __getitem__(self, name: str) -> Any:
        """The body, joint, drive, load or sensor of that name."""
        found = self._named(name)
        if len(found) == 1:
            return self._handle(*found[0])
        if found:
            kinds = " and a ".join(kind for kind, _ in found)
            plural = {"body": "bodies"}.get(found[0][0], found[0][0] + "s")
            raise unknown_name("part", name, []) if not isinstance(name, str) else KeyError(
                f"'{name}' is a {kinds}; write m.{plural}['{name}']")
        known = [default_name(kind, table) for kind in KINDS for table in self._root.get(kind, [])]
        raise unknown_name("part of the model", name, known)

    def __contains__(self, name: object) -> bool:
        return isinstance(name, str) and bool(self._named(name))

    def remove(self, part: str | Entry) -> None:
        """Takes a body, joint, drive, load or sensor away. What refers to it is an error on solving.

        Raises:
            KeyError: nothing is called that.
        """
        if isinstance(part, str) and part in self._functions:
            del self._functions[part]
            return self._forget()
        entry = self[part] if isinstance(part, str) else part
        entries = self._root.get(entry._key, [])
        left = [table for table in entries if table is not entry._table]
        if len(left) == len(entries):
            raise unknown_name(entry._key, entry.name, [])
        self._root[entry._key] = left
        self._touch()

    # As a value.

    def copy(self) -> Model:
        """An independent model of the same content."""
        other = object.__new__(type(self))
        other._root = self._root.copy()
        other._file, other._text = self._file, self._text
        other._functions = dict(self._functions)
        other._forget()
        other._built, other._warned = dict(self._built), self._warned   # what is built is never changed
        return other

    __copy__ = copy

    def __deepcopy__(self, memo: object) -> Model:
        return self.copy()

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, Model):
            return NotImplemented
        return dict.__eq__(self._root, other._root) and self._functions == other._functions

    def __hash__(self) -> int:
        return hash(frozen(self._root))

    def __getstate__(self) -> dict[str, Any]:
        self._refuse_functions("pickled")
        return {"root": self._root, "file": self._file, "text": self._text}

    def __setstate__(self, state: dict[str, Any]) -> None:
        self._root, self._file, self._text = state["root"], state["file"], state["text"]
        self._functions = {}
        self._forget()

    def to_toml(self, file: str | os.PathLike[str] | None = None) -> str:
        """The model as a scenario file, which the program reads, too; written if ``file`` is given.

        A model that was loaded and not edited since gives the text that was read, comments included; else the
        text is made anew. ``load(text=m.to_toml()) == m``.

        Raises:
            InputError: ``python-function`` if the model has Python functions as loads.
            OSError: the file cannot be written.
        """
        self._refuse_functions("written to a file")
        text = self._text if self._text is not None else toml(self._root)
        if file is not None:
            with open(file_name(file), "w", encoding="utf-8", newline="") as out:
                out.write(text)
        return text

    def __repr__(self) -> str:
        counts = ", ".join(f"{len(self._root.get(kind, []))} "
                           f"{kind if len(self._root.get(kind, [])) == 1 else {'body': 'bodies'}.get(kind, kind + 's')}"
                           for kind in KINDS if self._root.get(kind) or kind in ("body", "joint"))
        title = f" '{self.title}'" if self.title else ""
        return f"<livens.Model{title}: {counts}>"

    def _repr_html_(self) -> str:
        from html import escape
        rows = "".join(
            f"<tr><td>{kind}</td><td>{escape(default_name(kind, t))}</td><td>{escape(str(t.get('type', '')))}</td></tr>"
            for kind in KINDS for t in self._root.get(kind, [])[:200])
        return (f"<b>{escape(self.title or 'model')}</b><table><tr><th>part</th><th>name</th><th>type</th></tr>"
                f"{rows}</table>")

    # Python functions.

    def add_function(self, name: str, body: str | Body, function: Callable[..., Any]) -> None:
        """A load by a Python function, for trying out: thousands of times slower than an expression.

        Args:
            name: Of the load.
            body: On which it acts.
            function: ``function(t, body)`` returns the force (N, at the body's reference point), or force and
                torque (N m) as six numbers, in world axes. ``body`` has ``position`` (m), ``velocity`` (m/s),
                ``directors`` (rows d1, d2, d3) and ``angular_velocity`` (rad/s), each an array, in world axes.
                It has to be smooth in all of them, and must not remember anything.

        Such a model cannot be pickled, written to a file or given to :func:`livens.solve_many`. What the
        function raises ends the solution. Warns with :class:`SlowWarning`.

        Raises:
            InputError: ``body-unknown``, ``name-duplicate``.
        """
        wanted = body.name if isinstance(body, Entry) else body
        if wanted not in self.bodies:
            raise fault("body-unknown", f"load '{name}' refers to '{wanted}', but there is no such body",
                        f"load[{name}].body", _core.suggestion(str(wanted), list(self.bodies)))
        if not callable(function):
            raise TypeError(f"a function is wanted, not {type(function).__name__}")
        if name in self._functions or name in self.loads:
            raise fault("name-duplicate", f"a load called '{name}' exists already", f"load[{name}].name")
        warnings.warn(f"load '{name}' is a Python function: it works, slowly; "
                      "where a formula says the same, `expression` of add_force or add_torque is fast", SlowWarning,
                      stacklevel=stack_level())
        self._functions[name] = (wanted, function)
        self._forget()

    def _refuse_functions(self, what: str) -> None:
        if self._functions:
            names = ", ".join(f"'{name}'" for name in self._functions)
            raise fault("python-function", f"the load {names} is a Python function, so the model cannot be {what}",
                        help="write it as an expression, or remove it: m.remove(name)")

    # Checking and building.

    def check(self) -> list[Diagnostic]:
        """All that is wrong with the model or worth a look, in its order (20 at most); empty: nothing.

        Never solves. A model without ``[time]`` is looked at as if it had some.
        """
        _, found = self._build({} if "time" in self._root else {"time": some_time(self._root)})
        return found

    @property
    def _folder(self) -> str:
        """Where its meshes are: beside the file that it came from, else where Python is."""
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
                scenario = scenario.with_load(name, body, adapted(function))
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
        """Of a text: the path of what stands there."""
        from dataclasses import replace
        return [replace(d, path=path_at(self._root, d.place)) for d in found]

    # Editing.

    def _forget(self) -> None:
        self._built: dict[Any, tuple[Any, list[Diagnostic]]] = {}
        self._names: dict[str, list[tuple[str, Table]]] | None = None
        self._order: dict[int, int] = {}
        self._warned = False

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
        _, found = _core.build_tree({"format": 1, **{name: self._root[name]}}, "", "", True)
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
        if isinstance(value, Shape):
            return self._reshape(section, value)
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
            of_table(d, top._key, top._table) for d in _core.check_table(top._key, top._table)
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
        given = {"name": name, "type": word or None, **arranged(content)}
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
        part: dict[str, Any] = {key: value for key, value in self._root.items() if key in ("format", "gravity", "start")}
        part["time"] = {"end": 1}
        for part_kind, part_table in sorted(wanted.values(), key=lambda item: self._order[id(item[1])]):
            part.setdefault(part_kind, []).append(part_table)
        n_all = sum(len(self._root.get(k, [])) for k in KINDS)
        return part, len(wanted) == n_all
