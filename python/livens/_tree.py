# SPDX-License-Identifier: BSD-3-Clause
"""The tree of a scenario: tables that know where their values were written, their schema and their text."""
from __future__ import annotations

import math
import os
import re
from collections.abc import Iterable, Iterator, Mapping
from functools import lru_cache
from typing import Any

import numpy as np

from . import _core
from ._errors import Diagnostic, InputError, Place, fault, user_place
from ._rotations import ORIENTATIONS, as_key, doubt, is_rotation
from ._values import Shape

INTEGER, ROW, TABLE, TABLES = 3, 9, 11, 12   # of Form in schema.h
NUMERIC = (INTEGER, 4, ROW, 10)
KINDS = ("body", "point", "joint", "drive", "stop", "load", "sensor", "controller", "event")   # arrays of tables in the root


class Table(dict[str, Any]):
    """A table of the scenario; ``places`` tells where each of its values was written, ``place`` where it was."""

    __slots__ = ("place", "places")

    def __init__(self, content: Mapping[str, Any] = {}, place: Place = Place(),
                 places: Mapping[str, Place] = {}) -> None:
        super().__init__(content)
        self.place = place
        self.places: dict[str, Place] = dict(places)

    def __reduce__(self) -> tuple[Any, ...]:
        return (Table, (dict(self), self.place, self.places))

    def copy(self) -> Table:
        """All the way down."""
        return Table({key: _copy(value) for key, value in self.items()}, self.place, self.places)


def _copy(value: Any) -> Any:
    if isinstance(value, Table):
        return value.copy()
    return [item.copy() for item in value] if isinstance(value, list) else value


def frozen(value: Any) -> Any:
    """Something that can be hashed, equal for equal tables."""
    if isinstance(value, dict):
        return frozenset((key, frozen(v)) for key, v in value.items())
    return tuple(frozen(v) for v in value) if isinstance(value, (list, tuple)) else value


class Schema:
    """The tables of all that a scenario may say, as the compiled reader has them."""

    def __init__(self) -> None:
        self.tables: list[dict[str, Any]] = _core.schema()
        self.root = self.tables[0]
        self.children = {key["name"]: self.tables[key["child"]] for key in self.root["keys"]
                         if key["child"] is not None}

    def keys(self, table: dict[str, Any], kind: object = None) -> dict[str, dict[str, Any]]:
        """Those of all kinds and, of a kind that is known, its own; else those of any kind."""
        found = {key["name"]: key for key in table["keys"]}
        for k in table["kinds"]:
            if k["word"] == kind or not isinstance(kind, str):
                for key in k["keys"]:
                    found.setdefault(key["name"], key)
        return found

    def key(self, table: dict[str, Any], content: Mapping[str, Any], name: str) -> dict[str, Any] | None:
        """The key that a name is in a table with this content."""
        kind = content.get(table["chooser"]) if table["chooser"] else None
        if kind is None and table["chooser"]:
            kind = {key["name"]: key for key in table["keys"]}[table["chooser"]]["fallback"] or None
        return self.keys(table, kind).get(name)

    def child(self, key: dict[str, Any] | None) -> dict[str, Any] | None:
        return None if key is None or key["child"] is None else self.tables[key["child"]]


@lru_cache(maxsize=1)
def schema() -> Schema:
    """Read once."""
    return Schema()


# Values of Python as values of a tree.

def plain(value: Any, key: dict[str, Any] | None, path: str) -> Any:
    """A value as trees hold it: truth, whole number, number, text, tuple, Table or list of Tables."""
    if isinstance(value, (bool, str)) or type(value) in (int, float):
        return value
    if isinstance(value, np.longdouble):   # its own item()
        return float(value)
    if isinstance(value, np.generic):
        return plain(value.item(), key, path)
    if hasattr(value, "to_base_units"):
        return _magnitude(value, key, path)
    if key is not None and key.get("name") in ORIENTATIONS and is_rotation(value):
        return plain(as_key(value, key["name"]), key, path)
    if key is not None and key.get("name") == "quaternion":
        doubt(value)
    if isinstance(value, np.ndarray):
        if value.dtype.kind not in "fiub":
            raise fault("wrong-type", f"an array of {value.dtype} holds no numbers", path)
        if value.ndim == 2 and 1 in value.shape and key is not None and (key.get("form"), key.get("other")) == (ROW, 0):
            value = value.ravel()   # a column of three numbers
        return plain(value.tolist(), key, path)
    if isinstance(value, os.PathLike):
        return plain(os.fspath(value), key, path)
    if isinstance(value, Shape) and key is not None and key["name"] == "visual":
        value = _seen(value, path)
    if isinstance(value, Mapping):
        return _plain_table(value, schema().child(key), path)
    if isinstance(value, (int, float)):   # subclasses
        return int(value) if isinstance(value, int) else float(value)
    if hasattr(value, "name") and isinstance(value.name, str) and hasattr(value, "_table"):
        return value.name   # a body or joint stands for its name
    if isinstance(value, Iterable) and not isinstance(value, (bytes, set, frozenset)):
        items = [plain(item, key, path) for item in value]
        return items if items and all(isinstance(item, Table) for item in items) else tuple(items)
    raise fault("wrong-type", f"{_article(type(value).__name__)} is no value of a model", path,
                _of_function(path) if callable(value)
                else "numbers, strings with units, lists and arrays are")


def _of_function(path: str) -> str:
    """What to do with a Python function."""
    expression = "an expression is a string, a formula of t: \"0.5*sin(2*t)\""
    if path.startswith("drive["):
        return expression + "; values over time: table=lv.table(times, values)"
    return expression + "; m.add_function(name, body, function) takes a Python function"


def _seen(shape: Shape, path: str) -> Mapping[str, Any]:
    """A shape that is looked at alone."""
    for key in ("mass", "density"):
        if key in shape.keys:
            raise fault("wrong-type", f"what is looked at alone has no {key}", path, f"leave {key}= out of the shape")
    inside: Mapping[str, Any] = shape.keys["shape"]
    return inside


def _article(word: str) -> str:
    return ("an " if word[:1].lower() in "aeiou" else "a ") + word


def _plain_table(value: Mapping[Any, Any], child: dict[str, Any] | None, path: str) -> Table:
    table = Table(place=user_place())
    for name, item in value.items():
        if not isinstance(name, str):
            raise fault("wrong-type", f"keys are strings, not {type(name).__name__}", path)
        key = None if child is None else schema().key(child, value, name)
        table[name] = plain(item, key, f"{path}.{name}")
        table.places[name] = table.place
    return table


def _magnitude(value: Any, key: dict[str, Any] | None, path: str) -> Any:
    """Of a quantity of pint, in the unit of its key."""
    units = [key["unit"], key["other_unit"]] if key is not None else [""]
    for unit in units:
        try:
            return plain(np.asarray(value.to(unit or "dimensionless").magnitude, dtype=float), None, path)
        except Exception:   # pint's own DimensionalityError, which cannot be imported here
            continue
    wanted = " or ".join(f'"{unit}"' for unit in units if unit) or "a plain number"
    raise fault("unit", f"{value} is not in {wanted}", path)


def _key_of_number(key: dict[str, Any] | None, i: int, n: int) -> dict[str, Any] | None:
    """The key with the unit of number i of n, where each has its own (Key::unit_of)."""
    units = key.get("units") if key is not None else None
    if key is None or not units or n * n != len(units) and n != len(units):
        return key
    return {**key, "unit": units[i if n == len(units) else i * (n + 1)]}


def si(value: Any, key: dict[str, Any] | None, parameters: Mapping[str, Any] = {}, in_list: bool = False) -> Any:
    """A value of the tree as users read it: numbers and arrays in SI units."""
    if isinstance(value, str):
        is_number = key is not None and (key["form"] in NUMERIC or in_list and key["other"] in NUMERIC)
        if key is None or not is_number or value in key["choices"]:
            return value
        try:
            number = _core.quantity(value, key["unit"], key["other_unit"], dict(parameters))
            return round(number) if key["form"] == INTEGER else number
        except InputError:
            return value   # check() tells
    if isinstance(value, tuple):
        items = [si(item, _key_of_number(key, i, len(value)), parameters, True) for i, item in enumerate(value)]
        try:
            return Numbers(items)
        except (TypeError, ValueError):
            return tuple(items)
    return value


class Numbers(np.ndarray[Any, np.dtype[np.float64]]):
    """Numbers of a model, read-only: ``m["rod"].position += (1, 0, 0)`` makes new ones and stores them."""

    def __new__(cls, items: Any) -> Numbers:
        if any(isinstance(item, (str, bool)) for item in items):
            raise TypeError
        array = np.array(items, dtype=float).view(cls)
        array.flags.writeable = False
        return array

    def __iadd__(self, other: Any) -> Any:   # type: ignore[misc]
        return np.asarray(self) + other

    def __isub__(self, other: Any) -> Any:   # type: ignore[misc]
        return np.asarray(self) - other

    def __imul__(self, other: Any) -> Any:   # type: ignore[misc]
        return np.asarray(self) * other

    def __itruediv__(self, other: Any) -> Any:   # type: ignore[misc]
        return np.asarray(self) / other

    def __repr__(self) -> str:
        return repr(np.asarray(self))


# Trees as text.

_BARE = re.compile(r"[A-Za-z0-9_-]+\Z")
_ESCAPES = {"\b": "\\b", "\t": "\\t", "\n": "\\n", "\f": "\\f", "\r": "\\r", '"': '\\"', "\\": "\\\\"}


def _text(value: str) -> str:
    out = []
    for c in value:
        code = ord(c)
        if c in _ESCAPES:
            out.append(_ESCAPES[c])
        elif code < 0x20 or code == 0x7F:
            out.append(f"\\u{code:04X}")
        elif 0xD800 <= code < 0xE000:
            raise fault("not-text", "this string holds surrogates, which are not characters")
        else:
            out.append(c)
    return '"' + "".join(out) + '"'


def _key(name: str) -> str:
    return name if _BARE.match(name) else _text(name)


def toml_value(value: Any) -> str:
    """On one line."""
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, float):
        return repr(value) if math.isfinite(value) else str(value)   # shortest that reads back
    if isinstance(value, int):
        return str(value)
    if isinstance(value, str):
        return _text(value)
    if isinstance(value, dict):
        inside = ", ".join(f"{_key(name)} = {toml_value(item)}" for name, item in value.items())
        return "{ " + inside + " }" if inside else "{}"
    return "[" + ", ".join(toml_value(item) for item in value) + "]"


def toml_lines(table: Mapping[str, Any]) -> Iterator[str]:
    """Keys and values, a line each."""
    for name, value in table.items():
        yield f"{_key(name)} = {toml_value(value)}"


def toml(root: Mapping[str, Any]) -> str:
    """A scenario as text: what has no header first, ``format`` before all, then tables in the schema's order."""
    return "\n".join(_scenario_lines(root, "")) + "\n"


def _scenario_lines(root: Mapping[str, Any], path: str) -> list[str]:
    """``path``: of a model inside, ``include.model.``."""
    order = [key["name"] for key in schema().root["keys"]]
    names = sorted(root, key=lambda name: order.index(name) if name in order else len(order))
    headed = {key["name"] for key in schema().root["keys"] if key["child"] is not None} | {"parameters"}
    lines = [line for name in names for line in toml_lines({name: root[name]})
             if name not in headed or not isinstance(root[name], (dict, list))]
    for name in names:
        value, header = root[name], path + _key(name)
        if name not in headed:
            continue
        if isinstance(value, dict):
            lines += ["", f"[{header}]", *toml_lines(value)]
        elif isinstance(value, list):
            for item in value:
                inside = item.get("model") if name == "include" else None
                own = {key: of for key, of in item.items() if not (isinstance(inside, dict) and key == "model")}
                lines += ["", f"[[{header}]]", *toml_lines(own)]
                if isinstance(inside, dict):
                    lines += ["", f"[{header}.model]", *_scenario_lines(inside, f"{header}.model.")]
    return lines


# Texts as trees.

def tables(content: Any, places: Any, file: str, place: Place) -> Table:
    """What the compiled parser found, as Tables."""
    table = Table(place=place)
    for name, value in content.items():
        line, column, length, nested = places[name]
        here = Place(file, line, column, length)
        table.places[name] = here
        if isinstance(value, dict):
            value = tables(value, nested, file, here)
        elif isinstance(value, list):
            value = [tables(item, inner, file, Place(file, *where))
                     for item, (*where, inner) in zip(value, nested)]
        elif name in KINDS and value == ():
            value = []
        table[name] = value
    return table


def diagnostics_of_text(found: list[dict[str, Any]], file: str, text: str) -> list[Diagnostic]:
    """With lines of the text."""
    lines = text.split("\n")
    made = []
    for d in found:
        line = d["line"]
        is_included = d["file"] not in ("", file)
        source = d["source_line"] or (lines[line - 1].rstrip("\r") if 0 < line <= len(lines) and not is_included else "")
        place = Place(d["file"] if is_included else file or "<text>", line, d["column"] if line else 0, d["length"])
        made.append(Diagnostic(d["severity"], d["code"], d["message"], "", d["note"], d["help"], place, source))
    return made
