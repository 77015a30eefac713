# SPDX-License-Identifier: BSD-3-Clause
"""Writes livens/_generated.py from the schema's own tables: add_<type>, handles, shapes, methods.

    generate.py PACKAGE OUTPUT      PACKAGE: the folder that holds the compiled module
"""
import keyword
import pathlib
import sys
import textwrap

NONE, FLAG, TRUTH, INTEGER, NUMBER, TEXT, CHOICE, NAMES, NAMED_TEXTS, ROW, ROWS, TABLE, TABLES = range(13)
FACTORS, CONDITION = 16, 17
HEAD = '''# SPDX-License-Identifier: BSD-3-Clause
"""Generated from the schema of scenarios; see python/generate.py."""
from __future__ import annotations

import os
from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any, Literal, TypedDict, Union

from ._entries import Entry, Key
from ._meshes import mesh_file
from ._values import Matrix, Method, Number, Shape, Vector, open_keys, three

if TYPE_CHECKING:
    import numpy as np
    import numpy.typing as npt
    from typing_extensions import TypeAlias

    Floats: TypeAlias = npt.NDArray[np.float64]

End: TypeAlias = "Union[str, Entry, tuple[Union[str, Entry], Vector]]"
"""A body by name or handle, or with a point of it: ``("rod", (0.5, 0, 0))``; or a named point."""
'''
MESH_FILE = ("A path from the model's folder on, or any other path: the file is read where it lies, and the result keeps what it "
             "needs of it. STL, OBJ, PLY, DAE (Collada) and Gmsh MSH; others, such as glTF, where the package trimesh is "
             "installed. Mesh coordinates are body coordinates.")
WRITTEN = {FLAG: "bool", TRUTH: "bool", INTEGER: "int", NUMBER: "Number", TEXT: "str", NAMES: "Sequence[str | Entry]",
           NAMED_TEXTS: "Mapping[str, str]", ROW: "Vector", ROWS: "Matrix", TABLE: "Mapping[str, Any]",
           TABLES: "Sequence[Mapping[str, Any]]", FACTORS: "Mapping[str, Number]", CONDITION: "str"}
OF_MESHES = ("unit", "scale", "turn", "densities")
OF_SOLIDS = ("density_field",)
READ = {FLAG: "bool", TRUTH: "bool", INTEGER: "int", NUMBER: "float", TEXT: "str", ROW: "Floats", ROWS: "Floats",
        CHOICE: "str", CONDITION: "str"}
REFERENCES = {"body": "str | Entry", "joint": "str | Entry", "load": "str | Entry"}
NAMED = ("point", "points", "at")   # what may be the name of a point
PAIRS = ("between", "joints")
BODY_EXAMPLE = """
        >>> import livens as lv
        >>> m = lv.Model("pendulum", gravity=(0, 0, -9.81))
        >>> m.add_body("rod", lv.box(1, "5 cm", "5 cm", density=7850), position=(0.5, 0, 0))
        <livens body 'rod': name = "rod", shape = { box = [1, "5 cm", "5 cm"] }, density = 7850, position = [0.5, 0, 0]>"""
SETUP = """
        >>> import livens as lv
        >>> m = lv.Model("two rods", gravity=(0, 0, -9.81))
        >>> a = m.add_body("a", lv.box(1, 0.1, 0.1, mass=2), position=(0.5, 0, 0))
        >>> b = m.add_body("b", lv.box(1, 0.1, 0.1, mass=2), position=(1.5, 0, 0))
"""
EXAMPLES = {   # calls that stand for themselves, after SETUP
    "weld": 'm.add_weld("glue", a, b, at=(1, 0, 0))',
    "revolute": 'm.add_revolute("pivot", "world", a, at=(0, 0, 0), axis=(0, 1, 0))',
    "prismatic": 'm.add_prismatic("slide", "world", a, at=(0, 0, 0), axis=(1, 0, 0))',
    "cylindrical": 'm.add_cylindrical("rail", "world", a, at=(0, 0, 0), axis=(1, 0, 0))',
    "screw": 'm.add_screw("spindle", "world", a, at=(0, 0, 0), axis=(1, 0, 0), pitch="5 mm")',
    "planar": 'm.add_planar("floor", "world", a, at=(0, 0, 0), axis=(0, 0, 1))',
    "universal": 'm.add_universal("cross", a, b, at=(1, 0, 0), axes=[(0, 1, 0), (0, 0, 1)])',
    "constant_velocity": 'm.add_constant_velocity("shafts", a, b, at=(1, 0, 0), axes=[(1, 0, 0), (1, 0, 0)])',
    "spherical": 'm.add_spherical("ball", a, b, at=(1, 0, 0))',
    "point_on_line": 'm.add_point_on_line("rail", "world", a, at=(0, 0, 0), axis=(1, 0, 0))',
    "point_in_plane": 'm.add_point_in_plane("table", "world", a, at=(0, 0, 0), axis=(0, 0, 1))',
    "parallel_axes": 'm.add_parallel_axes("aligned", a, b, axis=(1, 0, 0))',
    "perpendicular_axes": 'm.add_perpendicular_axes("square", a, b, at=(1, 0, 0), axes=[(1, 0, 0), (0, 1, 0)])',
    "constant_angle": 'm.add_constant_angle("bend", a, b, at=(1, 0, 0), axes=[(1, 0, 0), (1, 1, 0)])',
    "rod": 'm.add_rod("strut", a, b)',
    "spring": 'm.add_spring("return", ("world", (0, 0, 1)), (a, (0.5, 0, 0)), stiffness="2 kN/m", damping=3, free_length=1)',
    "force": 'm.add_force("push", a, value=(0, 0, "10 N"), until=0.5)',
    "torque": 'm.add_torque("twist", a, expression=("0", "2*sin(3*t)", "0"))',
    "drag": 'm.add_drag("air", a, quadratic=0.4)',
    "attraction": 'm.add_attraction("planet", a, mu=3.986e14, point=(0, 0, -6.4e6))',
    "bushing": 'm.add_bushing("mount", a, b, at=(1, 0, 0), stiffness=[1e5, 1e5, 1e5, 50, 50, 50])',
    "point": 'm.add_point_sensor("tip", b, point=(0.5, 0, 0))',
    "": 'tip = m.add_point("tip", b, (0.5, 0, 0))',
    "energy": 'm.add_energy_sensor("energy of a", a)',
    "relative": 'm.add_relative_sensor("gap", ("world", (0, 0, 0)), (a, (0.5, 0, 0)))',
    "distance": 'm.add_distance_drive("pull", "world", a, value=0.5)',
}


def name_of(key):
    return key["name"] + ("_" if keyword.iskeyword(key["name"]) else "")


def written(key):
    """Type of what is assigned."""
    forms = [form for form in (key["form"], key["other"]) if form != NONE]
    types = []
    for form in forms:
        if form == CHOICE:
            types.append("Literal[" + ", ".join(f'"{word}"' for word in key["choices"]) + "]")
        elif form == TEXT and key["name"] in REFERENCES:
            types.append(REFERENCES[key["name"]])
        elif form == TEXT and key["name"] in NAMED:
            types.append("str | Entry")
        else:
            types.append(WRITTEN[form])
    if key["name"] == "shape":
        types.append("Shape")
    if key["name"] == "over":
        types = ["Sequence[End | Mapping[str, Any]]"]
    if key["name"] == "visual":
        types = ["Shape", "Mapping[str, Any]", "Sequence[Shape | Mapping[str, Any]]"]
    return " | ".join(dict.fromkeys(types))


def read(key):
    """Type of what is read; Any for what may not be there."""
    known = key["required"] or key["fallback"]
    return READ.get(key["form"], "Any") if known and key["other"] == NONE else "Any"


def meaning(key):
    text = key["type"]
    if key["form"] == CHOICE:
        text = ""
    if key["fallback"]:
        text += ("; " if text else "") + f"default {key['fallback']}"
    if key["required"]:
        text += ("; " if text else "") + "needed"
    doc = " ".join(key["doc"].split())
    return (doc + (" " if doc else "") + (f"({text})" if text else "")).strip()


def wrapped(text, indent, hanging=None):
    return textwrap.fill(text, 116, initial_indent=indent, subsequent_indent=indent if hanging is None else hanging,
                         break_long_words=False, break_on_hyphens=False)


def sentence(text):
    text = text.strip()
    text = text[:1].upper() + text[1:]
    return text if text.endswith(".") else text + "."


def adder_name(kind, word):
    if not word:
        return f"add_{kind}"
    return f"add_{word}" if kind in ("joint", "load") else f"add_{word}_{kind}"


class Writer:
    def __init__(self, tables):
        self.tables = tables
        self.children = {key["name"]: tables[key["child"]] for key in tables[0]["keys"] if key["child"] is not None}
        self.out = [HEAD]

    def line(self, text=""):
        self.out.append(text)

    def text(self):
        return "\n".join(self.out) + "\n"

    def keys(self, table, word):
        """Those that a kind has, without what stands in front."""
        own = [k for kind in table["kinds"] if kind["word"] == word for k in kind["keys"]]
        return [key for key in table["keys"] + own if key["name"] != table["chooser"] and key["form"] != NONE]

    def handles(self):
        for kind in ("body", "point", "joint", "drive", "stop", "load", "sensor", "controller", "event"):
            table = self.children[kind]
            self.line(f"\n\nclass {kind.capitalize()}(Entry):")
            self.line(wrapped(f'"""{"An" if kind == "event" else "A"} {kind} of a model. {table["doc"]}', "    "))
            self.line('\n    Its keys are attributes; see :class:`livens.Section`.\n    """\n')
            self.line("    __slots__ = ()")
            seen = {"name"}
            every = table["keys"] + [key for k in table["kinds"] for key in k["keys"]]
            for key in every:
                if key["name"] in seen or key["form"] == NONE:
                    continue
                seen.add(key["name"])
                same = [k for k in every if k["name"] == key["name"]]
                doc = " / ".join(dict.fromkeys(meaning(k) for k in same))
                reads = {read(k) for k in same}
                writes = " | ".join(dict.fromkeys(t for k in same for t in written(k).split(" | ")))
                if any(k["form"] == CHOICE for k in same):
                    writes = " | ".join(t for t in dict.fromkeys([*writes.split(" | "), "str"])
                                        if not t.startswith("Literal"))
                read_type = reads.pop() if len(reads) == 1 else "Any"
                self.line(f"    {name_of(key)}: Key[{read_type}, {writes} | None] = Key(\n        {doc!r})")

    def adder(self, kind, table, word, doc):
        keys = self.keys(table, word)
        names = [key["name"] for key in keys]
        front = [f"name: str{'' if kind in ('body', 'point', 'sensor', 'controller') else ' | None'}"]
        pair = next((p for p in PAIRS if p in names), None)
        one = next((key for key in keys if key["name"] in REFERENCES and key["required"]), None)
        if kind == "body":
            front.append("shape: Shape | Mapping[str, Any] | None = None")
        elif pair is not None:
            front += ["first: End | None = None", "second: End | None = None"]   # the schema says what is missing
        elif one is not None:
            front.append(f"{one['name']}: {REFERENCES[one['name']]}" + (" | None = None" if one["told_by"] else ""))
        in_front = {"name", "shape" if kind == "body" else "", one["name"] if one is not None and pair is None else ""}
        behind = [key for key in keys if kind == "point" and key["name"] == "position" or kind == "joint" and key["form"] == FACTORS]
        front += [f"{key['name']}: {written(key)} | None = None" for key in behind]
        in_front |= {key["name"] for key in behind}
        rest = [key for key in keys if key["name"] not in in_front]
        method = adder_name(kind, word)
        self.line(f'\n    @open_keys("{kind}", "{word}")')
        self.line(f"    def {method}(self, {', '.join(front)}{', *,' if rest else ''}")
        for i, key in enumerate(rest):
            self.line(f"            {name_of(key)}: {written(key)} | None = None{',' if i + 1 < len(rest) else ''}")
        self.line(f"            ) -> {kind.capitalize()}:")
        called = (word or kind).replace("_", " ") + (f" {kind}" if kind in ("drive", "sensor") else "")
        article = "an" if called[:1] in "aeio" else "a"
        head = "Adds a body. " + table["doc"] if kind == "body" else f"Adds {article} {called}: {doc.strip().rstrip('.')}."
        self.line(wrapped(f'"""{head}', "        "))
        self.line("\n        Args:")
        self.line(wrapped("name: " + meaning(next(k for k in keys if k["name"] == "name")), " " * 12, " " * 16))
        if kind == "body":
            self.line(wrapped("shape: Solid of constant density, for mass and inertia: lv.box(..), ..", " " * 12, " " * 16))
        if pair == "between":
            self.line(wrapped("first: A body or \"world\", or (body, point) with a point (m) in its coordinates, or a named point.",
                              " " * 12, " " * 16))
            self.line(wrapped("second: Likewise.", " " * 12, " " * 16))
        elif pair == "joints":
            self.line(wrapped("first: The driving joint.", " " * 12, " " * 16))
            self.line(wrapped("second: The joint that follows.", " " * 12, " " * 16))
        elif one is not None:
            self.line(wrapped(f"{one['name']}: {meaning(one)}", " " * 12, " " * 16))
        for key in [*behind, *rest]:
            self.line(wrapped(f"{name_of(key)}: {meaning(key)}", " " * 12, " " * 16))
        self.line("\n        Returns:\n            A handle, by which keys can be read and changed.")
        self.line("\n        Raises:\n            InputError: with a code for what is wrong; nothing is added then.")
        example = BODY_EXAMPLE if kind == "body" else None
        if kind != "body" and word in EXAMPLES and method in EXAMPLES[word]:
            example = SETUP + ("        >>> " if " = " in EXAMPLES[word].partition("(")[0] else "        >>> added = ") + EXAMPLES[word]
        if example:
            self.line("\n        Example:" + example.replace("\n        ", "\n            "))
        self.line('        """')
        content = ", ".join(
            ['"name": name'] + (['"first": first, "second": second'] if pair is not None else [])
            + (['"shape": shape'] if kind == "body" else [])
            + ([f'"{one["name"]}": {one["name"]}'] if one is not None and pair is None else [])
            + [f'"{key["name"]}": {name_of(key)}' for key in [*behind, *rest]])
        call = textwrap.fill(f'added: {kind.capitalize()} = self._add("{kind}", "{word}", {{{content}}})',
                             116, initial_indent="        ", subsequent_indent="            ", break_on_hyphens=False,
                             break_long_words=False)
        self.line(call)
        self.line("        return added")

    def adders(self):
        self.line("\n\nclass Adders:")
        self.line('    """What adds to a model: a method for each type that scenarios know."""\n')
        self.line("    def _add(self, kind: str, word: str, content: Mapping[str, Any]) -> Any:")
        self.line("        raise NotImplementedError")
        self.adder("body", self.children["body"], "", "")
        self.adder("point", self.children["point"], "", "a place of a body with a name")
        self.adder("event", self.children["event"], "", "a condition of the motion that is reported, or ends it")
        self.adder("stop", self.children["stop"], "", "a limit that nothing passes")
        self.adder("controller", self.children["controller"], "", "states with rates of their own")
        for kind in ("joint", "drive", "load", "sensor"):
            table = self.children[kind]
            for k in table["kinds"]:
                self.adder(kind, table, k["word"], k["doc"])
            ends = kind == "joint"
            front = "first: End | None = None, second: End | None = None, " if ends else ""
            self.line(f"\n    def add_{kind}(self, name: str | None, type: str, {front}**keys: Any) -> {kind.capitalize()}:")
            self.line(f'        """Adds a {kind} whose type is a string: the same as the method of that type.')
            self.line("\n        Args:")
            self.line("            name: What everything else calls it.")
            words = ", ".join(k["word"] for k in table["kinds"])
            self.line(wrapped(f"type: {words}.", " " * 12, " " * 16))
            if ends:
                self.line("            first: A body or \"world\", or (body, point).")
                self.line("            second: Likewise.")
            self.line(f"            **keys: As ``[[{kind}]]`` has them"
                      + ("." if ends else "; between= instead of first and second."))
            self.line('\n        Raises:\n            InputError: with a code for what is wrong; nothing is added then.')
            self.line('        """')
            pair = '"first": first, "second": second, ' if ends else ""
            self.line(f'        added: {kind.capitalize()} = self._add("{kind}", type, {{"name": name, {pair}**keys}})')
            self.line("        return added")

    def shapes(self):
        shape = next(key for key in self.children["body"]["keys"] if key["name"] == "shape")
        self.shape_names = []
        keys = self.tables[shape["child"]]["keys"]
        # No shapes: they say how a file is meant, and what any one solid weighs.
        beside = [key for key in keys if key["name"] in OF_MESHES]
        weighing = [key for key in keys if key["name"] in OF_SOLIDS]
        for key in keys:
            if key["form"] == NONE or key in beside or key in weighing:
                continue
            name = name_of(key)
            child = None if key["child"] is None else self.tables[key["child"]]
            density = key["form"] not in (FLAG, TABLES)
            parameters, value, docs = [], None, []
            if key["form"] == TABLES:
                parameters = [f"{name}: Sequence[Mapping[str, Any]]"]
                known = ", ".join(f"``{k['name']}``" for k in child["keys"])
                docs, value = [(name, f"One table each, with the keys {known}.")], f"list({name})"
            elif child is not None:
                for inner in child["keys"]:
                    optional = "" if inner["required"] else " | None = None"
                    parameters.append(f"{name_of(inner)}: {written(inner)}{optional}")
                    docs.append((name_of(inner), meaning(inner)))
                pairs = ", ".join(f'"{k["name"]}": {name_of(k)}' for k in child["keys"])
                value = f"{{k: v for k, v in {{{pairs}}}.items() if v is not None}}"
                if child["keys"][0]["required"] and len(child["keys"]) == 1:
                    value = name_of(child["keys"][0])
            elif key["form"] == ROW and key["count"] == 3:
                parameters = ["x: Number | Vector", "y: Number | None = None", "z: Number | None = None"]
                docs = [("x", "Along d1, m; or all three."), ("y", "Along d2, m."), ("z", "Along d3, m.")]
                value = f'three("{name}", x, y, z)'
            elif key["form"] == FLAG:
                value = "True"
            else:
                parameters, docs, value = [f"value: {written(key)}"], [("value", meaning(key))], "value"
                if key["name"] == "mesh":   # a file that the caller names may lie anywhere
                    parameters = ["file: str | os.PathLike[str]"]
                    docs, value = [("file", MESH_FILE)], "mesh_file(file)"
            more = (beside if key["form"] == TEXT else []) + (weighing if density else [])
            docs += [(name_of(k), meaning(k)) for k in more]
            self.shape_names.append(name)
            arguments = parameters + ["*"] + [f"{name_of(k)}: {written(k)} | None = None" for k in more] + (["density: Number | None = None"] if density or key["form"] == TABLES else []) + \
                ["mass: Number | None = None"]
            self.line(f"\n\ndef {name}({', '.join(arguments)}) -> Shape:")
            self.line(wrapped(f'"""A shape of a body: {key["name"]}. {sentence(key["doc"])}', "    "))
            self.line("\n    Args:")
            for parameter, doc in docs:
                self.line(wrapped(f"{parameter}: {doc}", " " * 8, " " * 12))
            if key["form"] == TABLES:
                self.line("        density: kg/m^3, times that of each part; or")
            elif density:
                self.line("        density: kg/m^3; or")
            self.line("        mass: kg.")
            self.line('    """')
            extra = ('"density": density, ' if density or key["form"] == TABLES else "") + '"mass": mass'
            inside = ", ".join([f'"{key["name"]}": {value}'] + [f'"{k["name"]}": {name_of(k)}' for k in more])
            inside = f"{{k: v for k, v in {{{inside}}}.items() if v is not None}}" if more else f"{{{inside}}}"
            self.line(f'    keys = {{"shape": {inside}, {extra}}}')
            self.line("    return Shape({key: given for key, given in keys.items() if given is not None})")

    def methods(self):
        table = self.children["method"]
        self.method_names = []
        self.line("\n\nclass MethodOptions(TypedDict, total=False):")
        self.line('    """Keys of ``[method]`` that all methods have, as keywords of solve()."""\n')
        for key in table["keys"]:
            if key["name"] != table["chooser"] and key["form"] != NONE:
                self.line(f"    {name_of(key)}: {written(key)} | None")
                self.line(wrapped(f'"""{meaning(key)}"""', "    "))
        for kind in table["kinds"]:
            name = "".join(part.capitalize() for part in kind["word"].split("_"))
            self.method_names.append(name)
            keys = [key for key in kind["keys"] if key["form"] != NONE]
            keys.sort(key=lambda key: key["name"] != "degree")
            self.line(f"\n\nclass {name}(Method):")
            self.line(wrapped(f'"""{sentence(kind["doc"])}', "    "))
            if keys:
                self.line("\n    Args:")
                for key in keys:
                    self.line(wrapped(f"{name_of(key)}: {meaning(key)}", " " * 8, " " * 12))
            self.line('    """\n')
            parameters = [f"{name_of(key)}: {written(key)} | None = None" for key in keys]
            if len(parameters) > 1:
                parameters.insert(1, "*")
            self.line("    def __init__(self" + "".join(f", {p}" for p in parameters) + ") -> None:")
            pairs = ", ".join(f'"{key["name"]}": {name_of(key)}' for key in keys)
            self.line(f'        self._set("{kind["word"]}", {{{pairs}}})')


def main():
    package, output = map(pathlib.Path, sys.argv[1:3])
    sys.path.insert(0, str(package))
    import _core   # alone: the package needs what is written here
    writer = Writer(_core.schema())
    writer.handles()
    writer.adders()
    writer.shapes()
    writer.methods()
    names = ", ".join(f'"{name}"' for name in sorted(writer.shape_names + writer.method_names))
    writer.line(f"\n\n__all__ = [{names}]")
    output.write_text(writer.text(), encoding="utf-8")


if __name__ == "__main__":
    main()
