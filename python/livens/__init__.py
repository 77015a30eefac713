# SPDX-License-Identifier: BSD-3-Clause
"""livens: rigid multibody dynamics with space-time finite elements.

Build a model from named parts (:class:`Model`, :func:`load`), solve it (:func:`solve`), and read its solution by
name::

    import livens as lv

    m = lv.Model("pendulum", gravity=(0, 0, -9.81))
    rod = m.add_body("rod", lv.box(1, 0.05, 0.05, density=7850), position=(0.5, 0, 0))
    m.add_revolute("pivot", "world", rod, at=(0, 0, 0), axis=(0, 1, 0))
    sol = lv.solve(m, 10)
    sol["rod"].position, sol["pivot"].force, sol.energy

SI units and world axes unless noted otherwise. ``docs/python.md`` is the guide, ``docs/scenario.md`` lists all
keys.
"""
from typing import TYPE_CHECKING

from . import _generated
from ._core import version as __version__
from ._entries import Entry, Names, Section
from ._errors import (Diagnostic, InputError, ModelWarning, Place, ResultFileError, SlowWarning, SolveError,
                      SolveWarning)
from ._explain import explain
from ._export import Comparison, compare
from ._generated import *   # noqa: F403  the shapes and methods that the schema has, see __all__ there
from ._generated import Body, Controller, Drive, Event, Joint, Load, MethodOptions, Point, Sensor, Stop
from ._functions import BodyState
from ._import import from_urdf
from ._mujoco import from_mjcf
from ._included import Added
from ._load import load
from ._model import Model
from ._parameters import Parameters
from ._parts import BodySeries, JointSeries, LoadSeries, Parts, PointSeries, ReadingSeries, SensorSeries
from ._rest import (Equilibrium, EquilibriumError, Linearisation, ModeBody, ModeJoint, Modes, RestBody, RestJoint,
                    StateMatrices)
from ._results import Solution, SolvedEvent, load_solution
from ._series import Series
from ._shown import Extremes, Peak
from ._solve import solve, solve_many
from ._state import Coordinates, MechanismState, PlacedBody, PlacedJoint, PlacedPoint, reach
from ._values import Condition, Method, Shape, momenta, positions, state, table, unknown, visual

__all__ = [
    "Added", "Body", "BodySeries", "BodyState", "Comparison", "Condition", "Controller", "Coordinates", "Diagnostic", "Drive", "Entry", "Equilibrium", "Event",
    "EquilibriumError", "Extremes", "InputError", "Joint", "JointSeries", "Linearisation", "Load", "LoadSeries", "MechanismState", "Method",
    "MethodOptions", "ModeBody", "ModeJoint", "Model", "ModelWarning", "Modes", "Names", "Parameters", "Parts", "Peak",
    "Place", "PlacedBody", "PlacedJoint", "PlacedPoint", "Point", "PointSeries",
    "ReadingSeries", "RestBody", "RestJoint", "ResultFileError", "Section", "Sensor", "SensorSeries", "Series",
    "Shape", "SlowWarning", "Solution", "SolveError", "SolveWarning", "SolvedEvent", "StateMatrices", "Stop", "__version__", "compare",
    "explain", "from_mjcf", "from_urdf", "load", "load_solution", "momenta", "positions", "reach", "solve", "solve_many", "state",
    "table", "unknown", "visual",
]
__all__ += _generated.__all__

if not TYPE_CHECKING:   # who checks types knows what there is

    def __getattr__(name: str) -> object:
        if name.startswith("_"):
            raise AttributeError(f"module 'livens' has no attribute '{name}'", name=name)
        from ._other_names import of_module
        raise of_module(name, __all__)
