# SPDX-License-Identifier: BSD-3-Clause
"""Where things stand in a tree: paths, places of diagnostics, what refers to what."""
from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any

from . import _core
from ._code import written
from ._entries import Section, default_name
from ._errors import Diagnostic, Place, fault, user_place
from ._other_names import in_python
from ._tree import KINDS, Table
from ._values import Shape


def store(table: Table, name: str, value: Any) -> None:
    table[name] = value
    table.places[name] = user_place()


def key_below(section: Section, top: Section) -> str:
    while section._top is not top:
        assert section._top is not None
        section = section._top
    return section._key


def words_in(value: Any) -> list[str]:
    if isinstance(value, str):
        return [value]
    if isinstance(value, dict):
        return [word for item in value.values() for word in words_in(item)]
    if isinstance(value, (list, tuple)) and value and not isinstance(value[0], (int, float)):
        return [word for item in value for word in words_in(item)]
    return []


def _no_point(part: object) -> bool:
    return False


def _on_rope(end: Any, is_point: Callable[[object], bool]) -> Any:
    """A body, a point, or (body, point) as a table of ``over``; what is one stays."""
    if isinstance(end, Mapping):
        return end
    if is_point(end):
        return {"point": end}
    if isinstance(end, (tuple, list)) and len(end) == 2:
        return {"body": end[0]} if end[1] is None else {"body": end[0], "point": end[1]}
    return {"body": end}


def arranged(content: Mapping[str, Any], kind: str = "",
             is_point: Callable[[object], bool] = _no_point) -> dict[str, Any]:
    """first, second -> between (or joints), and points where they are (body, point) or points."""
    shape = content.get("shape")
    made: dict[str, Any] = {"shape": None} if shape is not None else {}
    made.update({key: value for key, value in content.items() if key not in ("first", "second", "name", "shape")})
    if isinstance(shape, Shape):
        for key, value in shape.keys.items():
            if made.get(key) is not None:
                raise fault("wrong-type", f"'{key}' is given to the body and to its shape")
            made[key] = value
    elif shape is not None:
        made["shape"] = shape
    if is_point(content.get("body")) and content.get("point") is None and "point" in content:
        made["body"], made["point"] = None, content["body"]   # which tells its body
    if isinstance(made.get("over"), (tuple, list)):
        made["over"] = [_on_rope(end, is_point) for end in made["over"]]
    both = [content[key] for key in ("first", "second") if content.get(key) is not None]
    if not both:
        return made
    if len(both) == 1 and "first" in content and "second" in content:
        lacking = "second" if content["first"] is not None else "first"
        is_joint = "joints" in content and "between" not in content
        raise fault("missing-key", f"the {lacking} {'joint' if is_joint else 'body'} is None",
                    help="" if is_joint else "its own name comes first, then two bodies: (\"pivot\", \"world\", rod, ..); "
                    "the fixed frame is called \"world\"")
    if all(is_point(end) for end in both) and content.get("points") is None and "points" in content and len(both) == 2:
        made["points"] = tuple(both)
        return made
    pairs = [end if isinstance(end, (tuple, list)) and len(end) == 2 else (end, None) for end in both]
    points = [point for _, point in pairs if point is not None]
    if points and kind in ("rod", "spring"):   # whose ends are the reference points where nothing is said
        points = [(0.0, 0.0, 0.0) if point is None else point for _, point in pairs]
    into = "joints" if "joints" in content and "between" not in content else "between"
    if made.get(into) is not None:
        raise fault("wrong-type", f"'{into}' is given twice: in front, and by its name")
    made[into] = tuple(end for end, _ in pairs)
    if points:
        if len(points) < len(pairs):
            raise fault("wrong-type", "a point is given on one side only; write both as (body, point)")
        if made.get("points") is not None:
            raise fault("wrong-type", "'points' are given twice: with the bodies, and by their name")
        made["points"] = tuple(points)
    return made


def path_of(kind: str, table: Mapping[str, Any], index: int = -1) -> str:
    if kind not in KINDS:
        return f"{kind}[{index + 1}]" if index >= 0 else kind
    return f"{kind}[{table.get('name') or (default_name(kind, table) if index < 0 else index + 1)}]"


def _place_inside(value: Any, steps: list[str]) -> Place:
    """Of what stands there from a table inwards, as far as that is known: lists of numbers have one place."""
    place: Place = value.place
    for step in steps:
        if isinstance(value, Table):
            place = value.places.get(step, value.place)
            value = value.get(step)
        elif isinstance(value, (list, tuple)) and int(step) < len(value):
            value = value[int(step)]
            place = value.place if isinstance(value, Table) else place
        else:
            break
    return place


def of_table(d: dict[str, Any], kind: str, table: Table) -> Diagnostic:
    _, _, key, inner = d["location"]
    path = path_of(kind, table) + (f".{key}" if key else "")
    place = _place_inside(table, [key, *inner]) if key else table.place
    is_of_file = place.column > 0
    if key and place.line and not is_of_file:   # of Python's code, where a call may have many lines
        place = written(place, key, table.get("name"), inner)
    help = d["help"] if is_of_file else in_python(d["help"])
    return Diagnostic(d["severity"], d["code"], d["message"], path, d["note"], help, place)


def diagnostic_of(d: dict[str, Any], root: Mapping[str, Any]) -> Diagnostic:
    """Of the compiled reader, with the place in the user's file."""
    if d["file"]:   # which the model includes
        place = Place(d["file"], d["line"], d["column"], d["length"])
        return Diagnostic(d["severity"], d["code"], d["message"], "include", d["note"], d["help"], place, d["source_line"])
    kind, index, _, _ = d["location"]
    value = root.get(kind)
    if isinstance(value, list) and 0 <= index < len(value) and isinstance(value[index], Table):
        return of_table(d, kind, value[index])
    if isinstance(value, Table):
        return of_table(d, kind, value)
    place = root.places.get(kind, root.place) if isinstance(root, Table) else Place()
    return Diagnostic(d["severity"], d["code"], d["message"], kind, d["note"], d["help"], place or user_place())


def faults_in(part: Mapping[str, Any], kind: str, table: Table) -> list[Diagnostic]:
    _, found = _core.build_tree(dict(part), "", "", True)   # of meshes nothing: they are looked at by check()
    index = next(i for i, item in enumerate(part[kind]) if item is table)
    return [diagnostic_of(d, part) for d in found
            if d["severity"] == "error" and d["location"][:2] == (kind, index) and not d["code"].startswith("mesh-")]


def _inside(value: Any) -> list[Place]:
    """Of all that stands in a table of a key, and in tables in there."""
    if not isinstance(value, Table):
        return []
    return [spot for key, own in value.places.items() for spot in (own, *_inside(value[key]))]


def path_at(root: Table, place: Place) -> str:
    """Of the value that stands there, or else of the first one on the line, whose key it is."""
    best, path = (0, 0), ""
    least, first = (0, 0), ""
    for kind, value in root.items():
        entries = value if isinstance(value, list) else [value] if isinstance(value, Table) else []
        spots = [(root.places.get(kind, Place()), kind)] if not entries else []
        for table in entries:
            spots.append((table.place, path_of(kind, table)))
            spots += [(spot, f"{path_of(kind, table)}.{key}") for key, own in table.places.items()
                      for spot in (own, *_inside(table.get(key)))]
        for spot, found in spots:
            at = (spot.line, spot.column)
            if spot.line == place.line and (not first or at < least):
                least, first = at, found
            if best <= at <= (place.line, place.column) and spot.line == place.line or best == (0, 0) == at:
                best, path = at, found
    return first if first and best[0] != place.line else path


def some_time(root: Mapping[str, Any]) -> Table:
    method = root.get("method")
    knots = method.get("knots") if isinstance(method, Table) else None
    if isinstance(knots, tuple) and len(knots) > 1:
        return Table({"start": knots[0], "end": knots[-1]})
    return Table({"end": 1})
