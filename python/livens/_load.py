# SPDX-License-Identifier: BSD-3-Clause
"""Scenarios as models."""
from __future__ import annotations

import os
from collections.abc import Mapping
from typing import Any

from . import _core
from ._errors import InputError, Place, fault, file_name, raised
from ._model import Model
from ._other_names import refused_model
from ._parameters import text_of
from ._places import some_time
from ._tree import diagnostics_of_text, tables


def load(file: str | os.PathLike[str] | None = None, *, text: str | None = None, check: bool = True,
         parameters: Mapping[str, Any] | None = None) -> Model:
    """Reads a scenario, from a file or from a string.

    Args:
        file: Its name.
        text: The scenario as a string, instead of ``file``.
        check: Whether errors are raised at once; otherwise by :func:`solve`, and listed by :meth:`Model.check`.
            TOML syntax errors are always raised.
        parameters: Values of parameters that replace those of the scenario: numbers (in SI units) or strings, as in
            ``{"L": 0.4, "width": "30 mm"}``.

    Raises:
        InputError: with line and column of all errors.
        OSError: the file cannot be read.

    Example:
        >>> import livens as lv
        >>> m = lv.load(text='''
        ... format = 1
        ... [[body]]
        ... name = "ball"
        ... shape = { sphere = "10 cm" }
        ... mass = 1
        ... [time]
        ... end = 1
        ... ''')
        >>> m["ball"].shape.sphere
        0.1
    """
    if (file is None) == (text is None):
        raise TypeError("load() takes a file's name or text=, one of them")
    if text is not None and not isinstance(text, str):
        raise TypeError(f"text= of load() is the scenario itself, a str, not {type(text).__name__}")
    name = "" if file is None else file_name(file)
    if instead := refused_model(name):
        raise fault("unknown-choice", f"'{name}' is no scenario", "file", instead)
    if file is not None:
        with open(name, "rb") as stream:
            content = stream.read(1 + (16 << 20))
    else:
        assert text is not None
        try:
            content = text.encode()
        except UnicodeEncodeError:
            raise fault("not-text", "this string holds surrogates, which are not characters") from None
    parsed, found = _core.parse(content)
    shown = content.decode("utf-8", "replace")
    if parsed is None:
        raise InputError(diagnostics_of_text(found, name, shown))
    if parameters is not None:
        values = [(key, text_of(value, f"parameters.{key}")) for key, value in parameters.items()]
        shown, found = _core.with_parameters(shown, values)
        if found:
            raise InputError(diagnostics_of_text(found, name, shown))
        parsed, _ = _core.parse(shown.encode())
    model = Model()
    model._root = tables(parsed[0], parsed[1], name or "<text>", Place(name or "<text>", 1))
    model._file, model._text = name or "<text>", shown
    if check:
        scenario, listed = model._build({} if "time" in model._root else {"time": some_time(model._root)})
        if scenario is None:
            raise raised(listed)
    return model
