# SPDX-License-Identifier: BSD-3-Clause
"""Parameters of a model: names for numbers, from which other numbers are computed."""
from __future__ import annotations

from collections.abc import Iterator, Mapping, MutableMapping
from typing import TYPE_CHECKING, Any

from . import _core
from ._errors import Place, fault, raised, user_place
from ._places import diagnostic_of
from ._tree import Table, plain, tables, toml_lines

if TYPE_CHECKING:
    from ._editing import Tree


def text_of(value: Any, path: str) -> str:
    """What a parameter is set to, as a string."""
    value = plain(value, None, path)
    if isinstance(value, bool) or not isinstance(value, (int, float, str)):
        raise fault("wrong-type", f"a parameter is a number or a string, not {type(value).__name__}", path)
    return value if isinstance(value, str) else repr(float(value))


def _stated(value: Any, path: str) -> Any:
    """A number or a string, or what :func:`unknown` makes of one."""
    if isinstance(value, Mapping) and "unknown" in value:
        return plain(value, None, path)
    return value if isinstance(value, str) else float(text_of(value, path))


def _guess(value: Any) -> Any:
    """What a parameter is computed as: an unknown one is what it is guessed to be."""
    return value["unknown"] if isinstance(value, Mapping) and "unknown" in value else value


class Parameters(MutableMapping[str, float]):
    """Parameters of a model: ``m.parameters["L"]`` is a number in SI units, whatever it was computed from; of an
    unknown one its guess.

    Assigning takes a number, a string with a unit, an expression of others, or :func:`unknown`. A plain number keeps the unit that
    the parameter has. Numbers of the model may then be computed: ``position=("L/2", 0, 0)``.

    Raises:
        InputError: on assigning what is no parameter (``parameter-name``, ``parameter-ring``, ``unit``, ..).
        KeyError: on reading one that there is not.

    Example:
        >>> import livens as lv
        >>> m = lv.Model("arm")
        >>> m.parameters = {"L": "400 mm", "width": "L/10"}
        >>> rod = m.add_body("rod", lv.box("L", "width", "width", density=7850), position=("L/2", 0, 0))
        >>> m.parameters["width"], rod.position.tolist()
        (0.04, [0.2, 0.0, 0.0])
        >>> m.parameters["L"] = 0.5
        >>> rod.position.tolist()
        [0.25, 0.0, 0.0]
    """

    __slots__ = ("_model",)

    def __init__(self, model: Tree) -> None:
        self._model = model

    @property
    def given(self) -> dict[str, Any]:
        """As they were given: numbers and strings."""
        return dict(self._table())

    def __getitem__(self, name: str) -> float:
        if name not in self._table():
            raise KeyError(f"no parameter '{name}'; {_core.suggestion(str(name), list(self._table()))}")
        value: float = _core.parameters(self._table())[0][name]
        return value

    def __setitem__(self, name: str, value: Any) -> None:
        path = f"parameters.{name}"
        table = self._table().copy()
        if isinstance(_guess(table.get(name)), str) and not isinstance(value, (str, Mapping)):
            value = self._in_its_unit(name, text_of(value, path))
        self._keep(table, {name: _stated(value, path)})

    def __delitem__(self, name: str) -> None:
        self[name]
        table = self._table().copy()
        del table[name]
        self._model._root["parameters"] = table
        self._model._touch()

    def __iter__(self) -> Iterator[str]:
        return iter(list(self._table()))

    def __len__(self) -> int:
        return len(self._table())

    def __repr__(self) -> str:
        return f"<livens parameters: {', '.join(toml_lines(self._table()))}>"

    def _table(self) -> Table:
        table = self._model._root.get("parameters")
        return table if isinstance(table, Table) else Table()

    def _replace(self, values: Mapping[str, Any]) -> None:
        if not isinstance(values, Mapping):
            raise fault("wrong-type", f"parameters are a dict, not {type(values).__name__}", "parameters",
                        'm.parameters = {"L": 0.4}')
        self._keep(Table(place=user_place()),
                   {name: _stated(value, f"parameters.{name}") for name, value in values.items()})

    def _keep(self, table: Table, values: Mapping[str, Any]) -> None:
        here = user_place()
        for name, value in values.items():
            table[name] = value
            table.places[name] = here
        _, found = _core.parameters(table)
        if found:
            raise raised([diagnostic_of(d, {"parameters": table}) for d in found])
        self._model._root["parameters"] = table
        self._model._touch()

    def _in_its_unit(self, name: str, value: str) -> Any:
        text = "[parameters]\n" + "\n".join(toml_lines(self._table()))
        made, found = _core.with_parameters(text, [(name, value)])
        if found:
            raise raised([diagnostic_of(d, {"parameters": self._table()}) for d in found])
        parsed, _ = _core.parse(made.encode())
        return _guess(tables(parsed[0], parsed[1], "", Place())["parameters"][name])
