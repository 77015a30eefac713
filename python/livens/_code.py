# SPDX-License-Identifier: BSD-3-Clause
"""Where in Python's code a key of a call was written: looked up when there is something to say of it."""
from __future__ import annotations

import ast
import inspect
import linecache
import sys
from collections.abc import Iterator, Sequence

from ._errors import Place

_POSITIONS = {"name": 0, "between": 1, "joints": 1, "terms": 1, "points": 1, "shape": 1, "body": 1, "joint": 1, "type": 1}


def written(place: Place, key: str, name: object = None, inner: Sequence[str] = ()) -> Place:
    """The value of a key in what is being executed at a place; the place itself if that is not clear.

    Args:
        place: A line of a call, or of an assignment to an attribute.
        key: As the scenario calls it.
        name: The first argument of the call, if it is known.
        inner: From the value inwards: keys, and numbers from 0 in lists.
    """
    lines = linecache.getlines(place.file)
    try:
        tree = ast.parse("".join(lines))
    except (SyntaxError, ValueError):   # edited since
        return place
    here = [node for node in ast.walk(tree) if isinstance(node, (ast.Call, ast.Assign))
            and node.lineno <= place.line <= (node.end_lineno or 0) and _may_be_of(node, name)]
    here.sort(key=lambda node: (node.end_lineno or 0) - node.lineno)
    for node in here:
        for value in _values(node, key):
            return _place_of(_inside(value, inner, tree), place.file, lines)
    return place


def _inside(value: ast.expr, steps: Sequence[str], tree: ast.Module) -> ast.expr:
    """The value that stands there, or else what it stands in."""
    for i, step in enumerate(steps):
        found: list[ast.expr] = []
        if isinstance(value, ast.Dict):
            found = [item for at, item in zip(value.keys, value.values)
                     if isinstance(at, ast.Constant) and at.value == step]
        elif isinstance(value, ast.Call):   # dict(..), lv.table(..), lv.cylinder(..)
            found = _argument(value, step)
        elif isinstance(value, (ast.List, ast.Tuple)) and step.isdigit():
            is_clear = not any(isinstance(item, ast.Starred) for item in value.elts)
            found = value.elts[int(step):][:1] if is_clear else []
        elif isinstance(value, ast.Name):   # of a variable that the file assigns once
            found = [node.value for node in ast.walk(tree) if isinstance(node, ast.Assign)
                     and any(isinstance(target, ast.Name) and target.id == value.id for target in node.targets)]
            found = [_inside(found[0], steps[i:], tree)] if len(found) == 1 and _is_open(found[0]) else []
            return found[0] if found else value
        if not found:
            break
        value = found[-1]
    return value


def _argument(call: ast.Call, name: str) -> list[ast.expr]:
    """Of a function of this package also by its place; the call itself if that is what is named."""
    function = call.func.attr if isinstance(call.func, ast.Attribute) else getattr(call.func, "id", "")
    found = [keyword.value for keyword in call.keywords if keyword.arg == name]
    known = getattr(sys.modules[__package__], function, None)
    if found or not inspect.isfunction(known):
        return found
    names = list(inspect.signature(known).parameters)
    if name in names:
        return call.args[names.index(name):][:1]
    return [call] if function == name else []


def _is_open(value: ast.expr) -> bool:
    return isinstance(value, (ast.Dict, ast.Call, ast.List, ast.Tuple))


def _may_be_of(call: ast.Call | ast.Assign, name: object) -> bool:
    if isinstance(call, ast.Assign):
        return True
    first = call.args[0] if call.args else None
    is_other = isinstance(first, ast.Constant) and isinstance(first.value, str) and first.value != name
    return not is_other or not isinstance(name, str)


def _values(call: ast.Call | ast.Assign, key: str) -> Iterator[ast.expr]:
    """By its name, by its place among the arguments, or inside of a shape; of an assignment what is assigned."""
    words = (key, key + "_")
    if isinstance(call, ast.Assign):
        if any(isinstance(target, ast.Attribute) and target.attr in words for target in call.targets):
            yield call.value
        return
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
