# SPDX-License-Identifier: BSD-3-Clause
"""Problems of the comparison as scenarios of livens: what a user would write, expressions of controllers and all."""
import pathlib

from problems import GROUND

KINDS = {"ball": "spherical", "hinge": "revolute", "slide": "prismatic", "rod": "rod"}


def values(v):
    return "[" + ", ".join(repr(float(c)) for c in v) + "]"


def names(first, second):
    return "[" + ", ".join('"world"' if i == GROUND else f'"b{i}"' for i in (first, second)) + "]"


def body(i, b):
    if not b.mass:
        raise ValueError("livens has no bodies without mass")
    if not any(b.inertia):
        return ["[[body]]", f'name = "b{i}"', "shape = { point = true }", f"mass = {b.mass}", f"position = {values(b.x)}",
                f"velocity = {values(b.v)}"]
    return ["[[body]]", f'name = "b{i}"', f"mass = {b.mass}", f"center_of_mass = {values(b.center)}",
            f"inertia = {values(b.inertia)}", f"position = {values(b.x)}", f"quaternion = {values(b.q)}",
            f"velocity = {values(b.v)}", f"angular_velocity = {values(b.w)}"]


def joint(j, kind, first, second, *numbers):
    lines = ["[[joint]]", f'name = "j{j}"', f'type = "{KINDS[kind]}"', f"between = {names(first, second)}"]
    if kind == "rod":
        return [*lines, f"points = [{values(numbers[0])}, {values(numbers[1])}]", f"length = {numbers[2]}"]
    return [*lines, f"at = {values(numbers[0])}", *(f"axis = {values(axis)}" for axis in numbers[1:])]


def spring(l, first, second, p, q, stiffness, damping, length, amplitude, omega):
    """The ground's end is led by a body, as a road is."""
    ends, lines = names(first, second), []
    if amplitude:
        lines = ["[[body]]", f'name = "road{l}"', "mass = 1", "inertia = [1, 1, 1]", f"position = {values(p)}",
                 "[[drive]]", f'name = "lead{l}"', 'type = "body"', f'body = "road{l}"',
                 f'expression = ["0", "0", "{amplitude}*sin({omega!r}*t)"]']
        ends, p = f'["road{l}", "b{second}"]', (0, 0, 0)
    return [*lines, "[[load]]", f'name = "l{l}"', 'type = "spring"', f"between = {ends}", f"points = [{values(p)}, {values(q)}]",
            f"stiffness = {stiffness}", f"damping = {damping}", f"free_length = {length}"]


def load(m, l, kind, *numbers):
    head = ["[[load]]", f'name = "l{l}"']
    if kind == "gear":
        first, second, ratio = numbers
        return ["[[joint]]", f'name = "g{l}"', 'type = "gear"', f'joints = ["j{first}", "j{second}"]', f"ratio = {ratio}"]
    if kind == "spring":
        return spring(l, *numbers)
    if kind == "bushing":
        first, second, at, stiffness, damping = numbers
        return [*head, 'type = "bushing"', f"between = {names(first, second)}", f"at = {values(at)}",
                f"stiffness = {values(stiffness)}", f"damping = {values(damping)}"]
    k, stiffness, damping, rest = numbers
    if kind == "torsion":
        return [*head, 'type = "spring"', f'joint = "j{k}"', f"stiffness = {stiffness}", f"damping = {damping}", f"rest = {rest}"]
    q = "displacement" if m.joints[k][0] == "slide" else "angle"
    return [*head, 'type = "actuator"', f'joint = "j{k}"', f'expression = "{stiffness}*({rest} - q) - {damping}*w"',
            f'inputs = {{ q = "j{k}.{q}", w = "j{k}.{q}_rate" }}']


def text(m, time="", method=""):
    """`time`: lines of [time] beside its end, `method`: those of [method]."""
    lines = ["format = 1", f"gravity = {values(m.gravity)}"]
    for i, b in enumerate(m.bodies):
        lines += body(i, b)
    for j, entry in enumerate(m.joints):
        lines += joint(j, *entry)
    for l, entry in enumerate(m.loads):
        lines += load(m, l, *entry)
    if any(line == "[[drive]]" for line in lines):   # what it leads moves with it from the start
        lines += ["[start]", 'initial = "project"']
    return "\n".join([*lines, "[time]", f"end = {m.end}", time, *(["[method]", method] if method else []), ""])


def write(m, folder):
    """For peer_livens: mechanisms with loads are files of their own."""
    if not m.loads:
        return
    folder = pathlib.Path(folder)
    folder.mkdir(parents=True, exist_ok=True)
    path = folder / f"{m.name}.toml"
    try:
        path.write_text(text(m, "accuracy = 1e-6"), encoding="utf-8")
    except ValueError:
        return   # a way to put it that is not livens'
    m.scenario = str(path)
