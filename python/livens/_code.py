# SPDX-License-Identifier: BSD-3-Clause
"""Where in Python's code a key of a call was written: looked up when there is something to say of it."""
from __future__ import annotations

import ast
import linecache
from collections.abc import Iterator

from ._errors import Place

_POSITIONS = {"name": 0, "between": 1, "joints": 1, "points": 1, "shape": 1, "body": 1, "joint": 1, "type": 1}


def written(place: Place, key: str, name: object = None) -> Place:
    """The value of a key in the call that is being executed at a place; the place itself if that is not clear.

    Args:
        place: A line of the call.
        key: As the scenario calls it.
        name: The first argument of the call, if it is known.
    """
    lines = linecache.getlines(place.file)
    try:
        tree = ast.parse("".join(lines))
    except (SyntaxError, ValueError):   # edited since
        return place
    calls = [node for node in ast.walk(tree) if isinstance(node, ast.Call)
             and node.lineno <= place.line <= (node.end_lineno or 0) and _may_be_of(node, name)]
    calls.sort(key=lambda call: (call.end_lineno or 0) - call.lineno)
    for call in calls:
        for value in _values(call, key):
            return _place_of(value, place.file, lines)
    return place


def _may_be_of(call: ast.Call, name: object) -> bool:
    first = call.args[0] if call.args else None
    is_other = isinstance(first, ast.Constant) and isinstance(first.value, str) and first.value != name
    return not is_other or not isinstance(name, str)


def _values(call: ast.Call, key: str) -> Iterator[ast.expr]:
    """By its name, by its place among the arguments, or inside of a shape."""
    words = (key, key + "_")
    yield from (keyword.value for keyword in call.keywords if keyword.arg in words)
    is_adding = isinstance(call.func, ast.Attribute) and call.func.attr.startswith("add_")
    if is_adding and _POSITIONS.get(key, len(call.args)) < len(call.args):
        yield call.args[_POSITIONS[key]]
    for argument in call.args:
        if isinstance(argument, ast.Call):
            yield from (keyword.value for keyword in argument.keywords if keyword.arg in words)


def _place_of(value: ast.expr, file: str, lines: list[str]) -> Place:
    line = lines[value.lineno - 1]
    before = line.encode()[:value.col_offset].decode(errors="replace").expandtabs(4)
    rest = len(line.rstrip().expandtabs(4)) - len(before)
    whole = line.encode()[value.col_offset:value.end_col_offset].decode(errors="replace")
    length = len(whole.expandtabs(4)) if value.end_lineno == value.lineno else rest
    return Place(file, value.lineno, len(before) + 1, max(1, length))
