# SPDX-License-Identifier: BSD-3-Clause
"""Light handles of what a model holds: they know the model and the table, and store nothing."""
from __future__ import annotations

import keyword
from collections.abc import Iterator, Mapping
from typing import TYPE_CHECKING, Any, Generic, TypeVar, cast, overload

from . import _core
from ._errors import fault
from ._tree import Table, schema, si, toml_lines

if TYPE_CHECKING:
    from typing_extensions import Self

    from ._editing import Tree

_T = TypeVar("_T")
_R = TypeVar("_R")
_W = TypeVar("_W")


def spelled(name: str) -> str:
    """``from_`` of Python is ``from`` of the scenario."""
    return name[:-1] if name.endswith("_") and keyword.iskeyword(name[:-1]) else name


class Section:
    """A table of a model. Its keys are attributes: reading gives SI units, assigning takes strings with units, too.

    Keys that are not set read as their default, or as ``None``; assigning ``None``, or ``del``, removes a key. If
    several keys exclude each other, assigning one removes the others: the ``mass`` of a body removes its
    ``density``, a ``quaternion`` its ``directors`` or ``rotation_vector``, ``elements`` of time an ``accuracy``.
    ``docs/scenario.md`` explains all keys; :meth:`keys` lists them.

    Raises:
        InputError: on assigning an invalid value (``unit``, ``wrong-type``, ``out-of-range``, ..).
        AttributeError: on reading a key that this table does not have.

    Example:
        >>> import livens as lv
        >>> m = lv.Model("one")
        >>> rod = m.add_body("rod", lv.box(1, 0.1, 0.1), mass="2600 g")
        >>> rod.mass
        2.6
        >>> m["rod"].mass *= 2
        >>> m["rod"].mass
        5.2
    """

    __slots__ = ("_model", "_schema", "_table", "_top", "_key")
    _model: Tree
    _schema: dict[str, Any]
    _table: Table
    _top: Section | None   # that this one is inside of
    _key: str              # its own in there, or the kind

    def __init__(self, model: Tree, table: Table, schema_table: dict[str, Any], key: str,
                 top: Section | None = None) -> None:
        for name, value in (("_model", model), ("_schema", schema_table), ("_top", top), ("_key", key),
                            ("_table", table)):
            object.__setattr__(self, name, value)

    def keys(self) -> list[str]:
        """All keys that this table can have; :attr:`given` contains those that are set."""
        kind = self._table.get(self._schema["chooser"])
        return list(schema().keys(self._schema, kind))

    @property
    def given(self) -> dict[str, Any]:
        """A copy of the keys that are set, with the values as assigned: strings with their units."""
        return dict(self._table.copy())

    def __getattr__(self, name: str) -> Any:
        key = schema().key(self._schema, self._table, spelled(name))
        if key is None:
            raise AttributeError(f"{self._label()} has no key '{name}'; {self._suggestion(name)}", name=name, obj=self)
        if key["name"] in self._table:
            value = self._table[key["name"]]
            child = schema().child(key)
            if isinstance(value, Table) and child is not None:
                return Section(self._model, value, child, key["name"], self)
            if isinstance(value, list) and child is not None:
                return tuple(Section(self._model, item, child, key["name"], self) for item in value)
            return si(value.copy() if isinstance(value, Table) else value, key, self._model._root.get("parameters", {}))
        return _fallback(key)

    def __setattr__(self, name: str, value: Any) -> None:
        self._model._edit(self, spelled(name), value)

    def __delattr__(self, name: str) -> None:
        self._model._edit(self, spelled(name), None)

    def __dir__(self) -> list[str]:
        return [*super().__dir__(), *self.keys()]

    def __reduce__(self) -> tuple[Any, ...]:
        raise TypeError(f"{self._label()} cannot be pickled alone: pickle the model")

    def __eq__(self, other: object) -> bool:
        return isinstance(other, Section) and self._table is other._table

    def __hash__(self) -> int:
        return id(self._table)

    def __repr__(self) -> str:
        return f"<livens {self._label()}: {', '.join(toml_lines(self._table))}>"

    def _label(self) -> str:
        return f"[{self._key}]" if self._top is None else f"{self._key} of {self._top._label()}"

    def _suggestion(self, name: str) -> str:
        kind = str(self._table.get(self._schema["chooser"]) or "")
        called = str(self._table.get("name") or "")
        other = _core.other_key(self._schema["heading"], kind, spelled(name), called)
        return str(other or _core.suggestion(spelled(name), self.keys()))


class RootSection(Section):
    """[time], [method], [start] or [end]: whatever the model has under that name now; nothing before its first key."""

    __slots__ = ("_own",)
    _own: Table

    @property
    def _table(self) -> Table:
        table = self._model._root.get(self._key)
        return table if isinstance(table, Table) else self._own

    @_table.setter
    def _table(self, table: Table) -> None:
        object.__setattr__(self, "_own", table)


class Entry(Section):
    """A named part of a model: a body, joint, drive, load or sensor."""

    __slots__ = ()

    @property
    def name(self) -> str:
        """Its name; for joints, drives and loads without a name, a default made of type and bodies."""
        return default_name(self._key, self._table)

    @name.setter
    def name(self, value: str) -> None:
        self._model._edit(self, "name", value)

    def __copy__(self) -> Self:
        return self

    def __reduce__(self) -> tuple[Any, ...]:
        return (_restored, (self._model, self._key, self.name))

    def __deepcopy__(self, memo: object) -> Self:
        raise fault("unknown-key", f"{self._label()} cannot be copied alone", help="copy the model: m.copy()")

    def _label(self) -> str:
        return f"{self._key} '{self.name}'"


def _restored(model: Tree, kind: str, name: str) -> Entry:
    found: Entry = next(model._handle(at, table) for at, table in model._named(name) if at == kind)
    return found


def _fallback(key: dict[str, Any]) -> Any:
    text = key["fallback"]
    if not text or key["choices"]:
        return text or None
    if text in ("true", "false"):
        return text == "true"
    numbers = [float(word) for word in text.strip("[]").split(",")]
    return si(tuple(numbers), None) if text.startswith("[") else numbers[0]


def default_name(kind: str, table: Mapping[str, Any]) -> str:
    """As the reader of scenarios calls what has no name."""
    if isinstance(table.get("name"), str):
        return str(table["name"])
    word = str(table.get("type", kind))
    two = table.get("points")
    if isinstance(two, tuple) and len(two) == 2 and all(isinstance(point, str) for point in two):
        return f"drive {two[0]}-{two[1]}" if kind == "drive" else f"{word} {two[0]}-{two[1]}"
    if "body" not in table and isinstance(table.get("point"), str) and "between" not in table:
        return f"drive of {table['point']}" if kind == "drive" else f"{word} on {table['point']}"
    for key in ("between", "joints"):
        if isinstance(table.get(key), tuple) and len(table[key]) == 2:
            return f"{word} {table[key][0]}-{table[key][1]}"
    if isinstance(table.get("over"), (list, tuple)):
        return f"{word} {'-'.join(str(at.get('body', at.get('point'))) for at in table['over'])}"
    if isinstance(table.get("terms"), Mapping):
        return f"{word} {'-'.join(table['terms'])}"
    for key in ("body", "joint"):
        if key in table:
            return f"drive of {table[key]}" if kind == "drive" else f"{word} on {table[key]}"
    return f"drive of {table['type']}" if kind == "drive" else word


class Key(Generic[_R, _W]):
    """A key as an attribute with a type and a meaning."""

    def __init__(self, doc: str) -> None:
        self.__doc__ = doc

    def __set_name__(self, owner: type, name: str) -> None:
        self._name = name

    @overload
    def __get__(self, section: None, owner: type) -> Self: ...
    @overload
    def __get__(self, section: Section, owner: type) -> _R: ...

    def __get__(self, section: Section | None, owner: type) -> Self | _R:
        if section is None:
            return self
        value: _R = Section.__getattr__(section, self._name)
        return value

    def __set__(self, section: Section, value: _W) -> None:
        section._model._edit(section, spelled(self._name), value)

    def __delete__(self, section: Section) -> None:
        section._model._edit(section, spelled(self._name), None)


class Names(Mapping[str, _T]):
    """All bodies (joints, drives, loads, sensors) of a model by name, in their order.

    Iteration yields names, indexing returns handles. An unknown name is a ``KeyError`` that suggests the nearest
    name.
    """

    __slots__ = ("_model", "_kind", "_type")

    def __init__(self, model: Tree, kind: str, entry_type: type[_T]) -> None:
        self._model, self._kind, self._type = model, kind, entry_type

    def _tables(self) -> dict[str, Table]:
        return {default_name(self._kind, table): table for table in self._model._root.get(self._kind, [])}

    def __getitem__(self, name: str) -> _T:
        for kind, table in self._model._named(name):
            if kind == self._kind:
                entry: Any = self._model._handle(kind, table)
                return cast(_T, entry)
        raise unknown_name(self._kind, name, list(self._tables()))

    def __iter__(self) -> Iterator[str]:
        return iter(self._tables())

    def __len__(self) -> int:
        return len(self._model._root.get(self._kind, []))

    def __repr__(self) -> str:
        plural = "bodies" if self._kind == "body" else self._kind + "s"
        return f"<{plural}: {', '.join(self) or 'none'}>"


class UnknownName(KeyError):
    """A ``KeyError`` whose message is a sentence."""

    def __str__(self) -> str:
        return str(self.args[0])


def unknown_name(kind: str, name: object, known: list[str]) -> KeyError:
    """For indexing by a name that nothing has."""
    if not isinstance(name, str):
        raise TypeError(f"parts are found by name, a string, not by {type(name).__name__}"
                        + (f": ['{known[0]}']; list() gives all names" if known else ""))
    suggestion = _core.suggestion(name, known) if known else f"there is no {kind} at all"
    return UnknownName(f"no {kind} is called '{name}'; {suggestion}")
