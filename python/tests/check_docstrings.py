# SPDX-License-Identifier: BSD-3-Clause
"""Every public name of the installed package has a docstring that says what it must; exits with 1 otherwise.

A function says Args for what it takes (each parameter by name); an array says its shape and its unit; what can be
raised, an example for what stands in the package itself. Tables of examples run as doctests elsewhere.
"""
from __future__ import annotations

import inspect
import re
import sys
from collections.abc import Iterator
from typing import Any

import livens

ARRAY = re.compile(r"Floats|ndarray")
UNIT = re.compile(r"\b(m|s|N|J|kg|rad|W)(/s(\^2)?| m| m/s| m\^2/s)?,|\(m,|quaternion|w, x, y, z|axes|relative|nan|"
                  r"orthonormal|violation|perturbation|lengths|views?\.", re.I)
WITHOUT_EXAMPLE = {   # shown by that of another
    "Body", "BodySeries", "BodyState", "Comparison", "Condition", "Controller", "Drive", "Event", "SolvedEvent", "Stop", "Entry", "Joint", "JointSeries", "Load",
    "Linearisation", "LoadSeries", "Method", "MethodOptions", "ModeBody", "ModeJoint", "ModelWarning", "Modes", "Names", "Parts", "Place", "PlacedBody", "PlacedJoint", "PlacedPoint", "Point", "RestBody", "RestJoint", "ReadingSeries",
    "ResultFileError", "Sensor", "SensorSeries", "Series", "Shape", "SlowWarning", "SolveWarning", "load_solution",
    "StateMatrices", "momenta", "state", *livens._generated.__all__}


def members(name: str, thing: Any) -> Iterator[tuple[str, Any]]:
    """The public names of a class that are its own."""
    for key, member in vars(thing).items():
        if not key.startswith("_") and not (key in ("args", "with_traceback")):
            yield f"{name}.{key}", member


def faults_of(name: str, thing: Any) -> Iterator[str]:
    if isinstance(thing, (str, bool)) or thing is None:
        return
    is_data = not callable(thing) and not isinstance(thing, (property, classmethod, staticmethod))
    doc = inspect.getdoc(thing) or ""
    if is_data and not type(thing).__name__ == "Key":
        return   # fields of dataclasses have texts below them
    if len(doc) < 10:
        yield f"{name} has no docstring"
        return
    function = thing.fget if isinstance(thing, property) else thing
    if inspect.isfunction(function):
        try:
            signature = inspect.signature(function)
        except ValueError:
            return
        parameters = [p for p in signature.parameters if p not in ("self", "cls")]
        if len(parameters) > 1 and "Args:" in doc:
            for parameter in parameters:
                if not re.search(rf"^\s*\**{parameter}: ", doc, re.M):
                    yield f"{name} does not say what {parameter} is"
        elif len(parameters) > 2:
            yield f"{name} has no Args"
        if isinstance(thing, property) and ARRAY.search(str(signature.return_annotation)):
            if "shape" not in doc:
                yield f"{name} does not say its shape"
            if not UNIT.search(doc):
                yield f"{name} does not say its unit"


def main() -> int:
    found: list[str] = []
    n = 0
    for name in livens.__all__:
        thing = getattr(livens, name)
        own = [(name, thing)]
        if inspect.isclass(thing):
            own += list(members(name, thing))
        for path, member in own:
            n += 1
            found += faults_of(path, member)
        if name not in WITHOUT_EXAMPLE and callable(thing) and ">>>" not in (inspect.getdoc(thing) or ""):
            found.append(f"{name} has no example")
    for fault in found:
        print(fault)
    print(f"{n} public names, {len(found)} faults")
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
