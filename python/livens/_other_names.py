# SPDX-License-Identifier: BSD-3-Clause
"""What users of other programs type, and what to type instead; words of scenarios are the compiled reader's."""
from __future__ import annotations

import re
from collections.abc import Iterable, Mapping
from typing import Any

from . import _core
from ._tree import KINDS, schema

_PAGE = "sol.report('run.html') writes the motion as a page for any browser; in a notebook, sol alone shows it"
_SOLVE = "lv.solve(m, 10), with the end of time in s"

# Words without case and underscores, and what to type; `@` is the name of the part.
MODEL = {
    "solve simulate run integrate step advance forwarddynamics": _SOLVE,
    "ground world fixedframe origin base": "the fixed frame is named, not made: \"world\", as in "
                                           "m.add_revolute(\"pivot\", \"world\", rod, ..)",
    "addground addworld addfixedbody": "the fixed frame is there: joints name it as \"world\"",
    "addgravity setgravity": "m.gravity = (0, 0, -9.81)",
    "addlink addrigidbody addbodies addpart addlump createbody": "m.add_body(name, lv.box(..), ..)",
    "addmarker addframe addpoint": "points are given to joints, loads and sensors; m.add_point_sensor(name, body, "
                                   "point=..) reads one",
    "addcontact contact": "there is no contact; a stop or a floor is a load whose expression holds max(..)",
    "addcallback addcontroller setcontroller": "m.add_actuator(name, joint, inputs={\"q\": \"pivot.angle\"}, "
                                               "expression=\"-10*q\")",
    "equilibrium static statics staticequilibrium": "m.find_equilibrium()",
    "eigenfrequencies eigenmodes eigenvalues modes modal modalanalysis frequencies": "m.vibration_modes()",
    "linearize linear": "m.linearise()",
    "massmatrix jacobian inertiamatrix coriolis bias gravitytorques gravitycompensation": "these are asked of a state: "
        "m.at({\"elbow.angle\": 0.5}).mass_matrix, .jacobian(\"tool\"), .bias_forces, .gravity_forces",
    "forwardkinematics fk kinematics pose poses": "m.at({\"elbow.angle\": 0.5})[\"tool\"].position",
    "inversedynamics rnea": "m.at(q, v).inverse_dynamics(a)",
    "inversekinematics ik": "lv.reach(m, \"tool\", (0.5, 0, 1)) returns coordinates for m.at(q)",
    "q dof dofs ndof joints coordinates generalizedcoordinates": "m.coordinates lists independent coordinates, m.joints the "
        "joints",
    "save write export totext dump tofile savetoml": "m.to_toml('model.toml')",
    "load read open": "lv.load('model.toml')",
    "validate verify isvalid errors": "m.check()",
    "plot show view draw render visualize visualise animate": "a motion is shown: sol = lv.solve(m, 10), then " + _PAGE,
    "name": "m.title",
    "links": "m.bodies",
    "constraints": "m.joints",
    "forces springs": "m.loads",
    "motors": "m.drives",
}
MODULE = {
    "simulate run integrate solveivp odeint simulation solver": _SOLVE,
    "read open loadtoml fromfile fromtoml loadscenario loadmodel": "lv.load('model.toml')",
    "loadresult loadresults readresult readresults loadrun openresult opensolution loadsol": "lv.load_solution('run.nc')",
    "loadurdf readurdf importurdf parseurdf urdf": "lv.from_urdf('robot.urdf')",
    "loadmjcf readmjcf importmjcf parsemjcf mjcf fromxml frommujoco mujoco": "lv.from_mjcf('robot.xml')",
    "fromsdf fromadams loadsdf": "livens reads its own TOML scenarios only; a page on "
        "each program says how models are carried over (docs/coming_from)",
    "world ground": "the fixed frame is the word \"world\"",
    "system multibody multibodysystem mechanism plant mbs": "lv.Model(\"name\", gravity=(0, 0, -9.81))",
    "rigidbody link part": "m.add_body(name, lv.box(..), ..)",
    "deg rad degrees radians": "a number takes a unit as a string: \"30 deg\"; or np.radians(30)",
    "m mm kg s n rpm hz": "a number takes a unit as a string: \"5 mm\"",
    "pi": "np.pi",
    "g gravity": "lv.Model(\"name\", gravity=(0, 0, -9.81))",
    "plot show animate view": "it is the solution's: sol = lv.solve(m, 10), then sol.plot(\"rod.position\"); " + _PAGE,
    "inversekinematics ik": "lv.reach(m, \"tool\", (0.5, 0, 1))",
    "forwardkinematics fk inversedynamics rnea crba aba jacobian massmatrix": "they are asked of a state: m.at(q, v).mass_matrix, "
        ".jacobian(\"tool\"), .inverse_dynamics(a), .accelerations()",
    "rk45 bdf rungekutta euler hht": "lv.solve(m, 10) chooses the method; method=\"radau\" for stiff models",
    "cube cuboid brick": "lv.box(x, y, z, density=..)",
    "ball": "lv.sphere(radius, density=..)",
    "pointmass": "lv.point(mass=..)",
    "stl obj fromstl": "lv.mesh('part.stl', unit=\"mm\", density=..)",
}
SOLUTION = {
    "time times ts tout": ("t",),
    "y x q u states state qs positions coordinates": "arrays are those of parts: sol['rod'].position, sol['pivot'].angle",
    "animate animation movie video render view show visualize visualise display player gif html": _PAGE,
    "tocsv csv savecsv writecsv": "sol.export('run.csv')",
    "tonpz savenpz": "sol.export('run.npz')",
    "topandas pandas todf df dataframe": ("to_dataframe",),
    "xarray toxr dataset": ("to_xarray",),
    "tonumpy numpy toarray": "arrays are those of parts: sol['rod'].position",
    "kineticenergy ke ekin": ("kinetic",),
    "potentialenergy pe epot": ("potential",),
    "totalenergy mechanicalenergy": ("energy",),
    "momentum": ("linear_momentum",),
    "converged ok issuccess": ("success",),
    "errors estimatederror": ("error",),
    "write dump tonetcdf savenetcdf": "sol.save('run.nc')",
    "interpolate interp sample at evaluate eval sol": "call it with instants: sol(0.5), sol(np.linspace(0, 1, 101))",
    "reactions forces jointforces constraintforces reactionforces": "sol['pivot'].force and .torque, in world axes",
    "links": ("bodies",),
    "nsteps steps n": ("n_elements",),
    "warnings": ("notes",),
    "info summary stats statistics": ("figures",),
}
BODY = {
    "pos x xyz location translation coordinates": ("position",),
    "r": "the position is sol['@'].position, the rotation matrices are sol['@'].rotation",
    "vel v xdot speed linearvelocity": ("velocity",),
    "omega w angvel spin rotationrate": ("angular_velocity",),
    "quat orientation quaternions": ("quaternion",),
    "com cm cog centerofgravity centreofmass": ("center_of_mass",),
    "rotationmatrix dcm matrix attitude rotation rotmat axes": ("rotation", "directors"),
    "euler rpy eulerangles angles rollpitchyaw": ("euler", "from its quaternion (w, x, y, z) by SciPy: Rotation.from_quat(q[:, [1, 2, 3, 0]]).as_euler('ZYX')"),
    "acc accel a xddot acceleration linearacceleration": ("acceleration",),
    "kineticenergy ke energy kinetic potential": "a sensor reads it: m.add_energy_sensor(\"E\", \"@\") before solving; "
                                                 "sol.kinetic is that of all bodies",
    "momentum": ("linear_momentum",),
    "q state": "position and quaternion (w, x, y, z)",
    "force reaction": "reactions are those of joints: sol['pivot'].force",
    "mass inertia": "it is the model's: m['@'].mass",
    "stress": ("mean_stress",),
}
JOINT = {
    "reaction reactions reactionforce constraintforce f forces": "force (N) and torque (N m) of the joint on its second body, "
                                                                 "world axes: sol['@'].force, sol['@'].torque",
    "moment reactiontorque constrainttorque m torques": ("torque",),
    "angularvelocity velocity speed omega w qdot rate dq angvel": ("angle_rate", "displacement_rate"),
    "q position pos theta phi x coordinate value rotation": ("angle", "displacement"),
    "angledeg degrees angledegrees deg": "np.degrees(sol['@'].angle)",
    "acceleration angularacceleration qddot": ("angle_acceleration", "displacement_acceleration"),
    "motortorque drivetorque effort actuatorforce drive_torque": "what a drive or actuator does along the coordinate is read by its own "
                                                                 "name: sol['motor'].effort",
}

_RESULTS = {   # endings of other formats, which save() does not write
    "csv": "export", "npz": "export", "glb": "export", "gltf": "export", "pvd": "export", "html": "report", "htm": "report"}
_FOREIGN = ("mat", "json", "h5", "hdf5", "hdf", "pkl", "pickle", "txt", "dat", "xlsx", "xls", "parquet", "npy", "toml", "png",
            "jpg", "svg", "gif", "mp4", "webm", "avi", "pdf", "vtk", "vtu", "xml", "urdf")


def plain_word(name: str) -> str:
    """Without case and underscores."""
    return name.replace("_", "").lower()


def _answer(table: Mapping[str, Any], name: str, has: Iterable[str], part: str = "") -> str:
    """What the table says of a name; where it lists attributes, the first that there is."""
    known = list(has)
    word = plain_word(name)
    for words, help in table.items():
        if word not in words.split():
            continue
        if isinstance(help, str):
            return help.replace("@", part)
        for candidate in help:
            if " " in candidate:
                return str(candidate)
            if candidate in known:
                extra = ", whose rows are the columns of the rotation matrix" if candidate == "directors" else ""
                return f"did you mean '{candidate}'{extra}?"
    for candidate in known:
        if plain_word(candidate) == word and not candidate.startswith("_"):
            return f"did you mean '{candidate}'?"
    return ""


def _public(owner: object) -> list[str]:
    return [name for name in type(owner).__dict__.keys() | {n for base in type(owner).__mro__[1:-1] for n in base.__dict__}
            if not name.startswith("_")]


def adder_for(name: str) -> str:
    """The method that "add_hinge" means: "m.add_revolute(..)"; empty where nothing is known."""
    word = re.sub(r"^(add|create|make|new)_?", "", name, flags=re.IGNORECASE)
    if word == name or not word:
        return ""
    return method_for(word)


def method_for(word: str) -> str:
    """Likewise of "hinge", "Spring", "rotational motor"."""
    if plain_word(word) in ("motor", "rotationalmotor", "jointmotor", "motion", "servo"):
        return ("m.add_joint_drive(name, joint, rate=..) where its motion is known, "
                "m.add_actuator(name, joint, value=..) where its torque is")
    for kind in [kind for kind in KINDS if schema().children[kind]["kinds"]]:
        choices = [k["word"] for k in schema().children[kind]["kinds"]]
        suffix = "" if kind in ("joint", "load") else f"_{kind}"
        bare = re.sub(rf"_?{kind}$", "", word, flags=re.IGNORECASE) or word
        for tried in (word, bare):
            choice, what = _core.other_word(tried, choices)
            if choice and (not suffix or bare != word):
                return in_python(f"livens calls it m.add_{choice}{suffix}(..){' ' if what else ''}{what}")
    return ""


def unknown(owner: object, what: str, table: Mapping[str, Any], name: str, part: str = "",
            has: Iterable[str] = (), otherwise: str = "") -> AttributeError:
    """For __getattr__: what there is not, and what to type instead."""
    known = sorted({*has} or _public(owner))
    near = str(_core.suggestion(name, known))
    help = _answer(table, name, known, part) or (near if near.startswith("did") or not otherwise else otherwise)
    return AttributeError(f"{what} has no '{name}'; {help}", name=name, obj=owner)


def of_module(name: str, known: list[str]) -> AttributeError:
    """Likewise of the package."""
    help = _answer(MODULE, name, known) or method_for(name)
    if not help:
        near = str(_core.suggestion(name, [word for word in known if not word.startswith("_")]))
        help = near if near.startswith("did you mean") else ""
    return AttributeError(f"livens has no '{name}'" + (f"; {help}" if help else ""), name=name)


def of_model(model: Any, name: str) -> AttributeError:
    """Likewise of a model."""
    if name in model:
        return AttributeError(f"a model has no attribute '{name}'; its parts are items: m['{name}']", name=name, obj=model)
    adder = adder_for(name) if not _answer(MODEL, name, ()) else ""
    if adder:
        return AttributeError(f"a model has no '{name}'; {adder}", name=name, obj=model)
    return unknown(model, "a model", MODEL, name)


def of_keyword(name: str) -> str:
    """What to type instead of a keyword of solve(); empty where nothing is known."""
    for heading in ("[time]", "[method]"):
        help = str(_core.other_key(heading, "", name))
        if help:
            return in_python(help)
    return ""


def refused_ending(name: str) -> str:
    """Why a result is not saved under this name, by its ending; empty where it is."""
    ending = name.rpartition(".")[2].lower()
    if ending in _RESULTS:
        return f"sol.{_RESULTS[ending]}('{name}') writes such a file; save() writes NetCDF: 'run.nc'"
    if ending == "mat":
        return "MATLAB reads NetCDF: save 'run.nc', then ncread('run.nc', ..)"
    if ending in _FOREIGN and "." in name:
        return "save() writes NetCDF: 'run.nc'; sol.export() writes CSV, npz, glTF and PVD"
    return ""


def refused_model(name: str) -> str:
    """Why lv.load() does not read a file, by its ending; empty where it does."""
    ending = name.rpartition(".")[2].lower() if "." in name else ""
    if ending == "urdf":
        return f"a robot is read by lv.from_urdf('{name}')"
    if ending in ("xml", "mjcf"):
        return f"a model of MuJoCo is read by lv.from_mjcf('{name}')"
    if ending in ("sdf", "xacro", "adm", "cmd", "slx", "py", "json", "yaml", "yml"):
        return "livens reads its own TOML scenarios; docs/coming_from says how models of other programs are carried over"
    if ending in ("nc", "cdf"):
        return f"a result is read by lv.load_solution('{name}')"
    if ending in ("stl", "obj", "ply", "msh", "step", "stp", "iges"):
        return f"a mesh is the shape of a body: m.add_body(\"part\", lv.mesh('{name}', unit=\"mm\", density=7850))"
    return ""


def in_python(help: str) -> str:
    """Help of the reader of scenarios, in words of Python."""
    help = re.sub(r'\[\[(?:joint|load)\]\] with type = "(\w+)"', r"m.add_\1(..) with", help)
    help = re.sub(r'\[\[(drive|sensor)\]\] with type = "(\w+)"', r"m.add_\2_\1(..) with", help)
    help = re.sub(r'type = "(spring|actuator)"', r"m.add_\1(..)", help)
    help = help.replace("with,", "with").replace("a [[drive]]", "m.add_joint_drive(..)")
    help = help.replace("leave [method] out", "leave method= out").replace("[[start.coordinates]]", "m.start.coordinates")
    help = help.replace("`accuracy` in [time]", "accuracy=").replace("how it is solved stands in [method]", "it is method=")
    return help.replace("[[body]] with", "m.add_body(..) with")
