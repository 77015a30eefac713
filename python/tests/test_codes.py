# SPDX-License-Identifier: BSD-3-Clause
"""Every code that a scenario leads to is told in Python with the user's file and line, by text and by tree."""
from __future__ import annotations

import pathlib
import re
from collections.abc import Callable

import pytest

import livens as lv
from livens import _core

BODY = '\n[[body]]\nname = "rod"\nshape = { box = [1, 0.1, 0.1] }\nmass = 2\nposition = [0.5, 0, 0]\n'


def examples(label: str) -> list[tuple[str, str]]:
    """(code, scenario) of the pages that have one; completed as the head of docs/diagnostics.md says."""
    found = []
    for code in _core.diagnostic_codes():
        match = re.search(label + r"\n\n```toml( file| bytes)?\n(.*?)```", lv.explain(code), re.S)
        if match is None:
            continue
        kind, text = match[1] or "", match[2].removesuffix("\n")
        if kind == " bytes":
            text = text.replace("\\x00", "\0")
        if kind != " file":
            text = "format = 1\n" + text
            if "[[body]]" not in text:
                text += BODY
            if "[time]" not in text:
                text += "\n[time]\nend = 1\nelements = 10\n"
        found.append((code, text))
    return found


WRONG = examples("Wrong:")


def test_there_are_pages() -> None:
    assert len(WRONG) > 60


@pytest.mark.parametrize(("code", "text"), WRONG, ids=[code for code, _ in WRONG])
def test_wrong_example_is_told_with_its_place(code: str, text: str, tmp_path: object) -> None:
    try:
        m = lv.load(text=text, check=False)
    except lv.InputError as error:   # no TOML
        assert error.code == code and error.file == "<text>"
        return
    of_text = [d for d in m.check() if d.code == code]
    assert of_text, [d.code for d in m.check()]
    if of_text[0].severity == "error":
        with pytest.raises(lv.InputError) as raised:
            lv.load(text=text)
        assert code in [d.code for d in raised.value.diagnostics]
    # The same from Python's containers, where every value knows the line that wrote it.
    m.title = "edited"
    of_tree = [d for d in m.check() if d.code == code]
    if code in ("format-version", "duplicate-key", "empty-file"):   # about the text itself
        return
    assert of_tree, [d.code for d in m.check()]
    assert of_tree[0].message == of_text[0].message and of_tree[0].help == of_text[0].help
    assert of_tree[0].file == "<text>"
    if of_text[0].line:   # the edit is no line of the text
        assert [d.line for d in of_tree] == [d.line for d in of_text] and [d.path for d in of_tree] == [d.path for d in of_text]


@pytest.mark.parametrize(("code", "text"), examples("Right:"), ids=[code for code, _ in examples("Right:")])
def test_right_example_is_right(code: str, text: str) -> None:
    m = lv.load(text=text)
    assert m.check() == []
    m.title = "edited"
    assert m.check() == []


def test_calls_are_told_with_file_and_line() -> None:
    m = lv.Model("errors")
    with pytest.raises(lv.InputError) as raised:
        m.add_body("rod", lv.box(1, 1, 1), mass="2 s")
    error = raised.value
    assert (error.code, error.path) == ("unit", "body[rod].mass") and "kg" in error.help
    assert error.file == __file__
    with open(__file__, encoding="utf-8") as stream:
        assert 'mass="2 s"' in stream.readlines()[error.line - 1]
    assert 'mass="2 s"' in str(error) and "std::" not in str(error)
    assert not m.bodies, "nothing is left of what was refused"


def test_key_of_a_long_call_is_told_with_its_own_line() -> None:
    m = lv.Model("errors")
    with open(__file__, encoding="utf-8") as stream:
        lines = stream.read().split("\n")

    def told(call: Callable[[], object]) -> tuple[str, str, str]:
        """Code, the marked words, the line they stand in."""
        with pytest.raises(lv.InputError) as raised:
            call()
        place = raised.value.diagnostics[0].place
        assert place.file == __file__
        line = lines[place.line - 1]
        assert " " * (place.column - 1) + "^" * place.length in str(raised.value) or not place.column
        return raised.value.code, line[max(place.column - 1, 0):][:place.length], line.strip()

    assert told(lambda: m.add_body(
        "rod",
        lv.box(1, 1, 1),
        position=(0, 0, 0),
        mass="2 s",
        velocity=(1, 0, 0),
    )) == ("unit", '"2 s"', 'mass="2 s",')
    assert told(lambda: m.add_body(
        "rod",
        lv.box(1, 1, 1,
               density="1 kg"),
        position=(0, 0, 0),
    )) == ("unit", '"1 kg"', 'density="1 kg"),')
    m.add_body("rod", lv.box(1, 1, 1), mass=1)
    assert told(lambda: m.add_spring(
        "spring",
        ("wrold", (0, 0, 1)),
        ("rod", (0, 0, 0)),
        stiffness=800,
        free_length=1,
    ))[0::2] == ("body-unknown", '("wrold", (0, 0, 1)),')
    code, words, line = told(lambda: m.add_spring(
        "spring", "world", "rod", points=[(0, 0, 0), (0, 0, 0)],
        stiffness=800, free_length=1,
        dampng=3,   # type: ignore[call-arg,unused-ignore]
    ))
    assert (code, words) == ("unknown-key", "3") and line.startswith("dampng=3")
    keys = {"mass": "2 s"}
    assert told(lambda: m.add_body("other", lv.box(1, 1, 1),
                                   **keys))[0] == "unit", "the line of the call, where no key is written"   # type: ignore[arg-type]
    with pytest.raises(lv.InputError) as raised:
        lv.solve(
            m,
            1,
            accuracy="3 kg",
        )
    assert lines[raised.value.line - 1].strip() == 'accuracy="3 kg",'


def test_key_inside_of_a_table_is_told_with_its_own_line() -> None:
    """In dictionaries, lists of them, functions of the package, variables, and what is assigned later."""
    with open(__file__, encoding="utf-8") as stream:
        lines = stream.read().split("\n")

    def told(call: Callable[[], object]) -> tuple[str, str]:
        """Code, and the line that is marked."""
        with pytest.raises(lv.InputError) as raised:
            call()
        assert raised.value.file == __file__
        return raised.value.code, lines[raised.value.line - 1].strip()

    m = lv.Model("nested")
    assert told(lambda: m.add_body(
        "rod", lv.box(1, 1, 1, mass=1),
        end={
            "position": (0, 0, 0),
            "velocity": (1, "2 kg", 0),
            "angular_velocity": (0, 0, 1),
        },
    )) == ("unit", '"velocity": (1, "2 kg", 0),')
    assert told(lambda: m.add_body(
        "rod", lv.parts([
            {"box": (1, 1, 1), "density": 1},
            {"sphere": {"radius": 0.5},
             "density": "1 kg"},
        ]),
    )) == ("wrong-type", '"density": "1 kg"},')
    assert told(lambda: m.add_body(
        "rod",
        lv.cylinder(
            1,
            "2 s",
            mass=1,
        ),
    )) == ("unit", '"2 s",')
    pieces = [
        dict(box=(1, 1, 1), density=1),
        dict(box=(1, 1, 1),
             densty=1),
    ]
    assert told(lambda: m.add_body("rod", lv.parts(pieces))) == ("unknown-key", "densty=1),")
    m.add_body("rod", lv.box(1, 1, 1, mass=1))
    assert told(lambda: m.add_force(
        "push", "rod",
        table=lv.table(
            [0, 1],
            [("0 N", "0 N", "1 N"), ("0 N", "0 N", "1 m")],
        ),
    )) == ("unit", '[("0 N", "0 N", "1 N"), ("0 N", "0 N", "1 m")],')

    def assign() -> None:
        m["rod"].end = {
            "position": (0, 0, 0),
            "velocity": "fast",
        }
    assert told(assign) == ("wrong-type", '"velocity": "fast",')

    def assign_inside() -> None:
        m["rod"].end = {"position": (0, 0, 0)}
        m["rod"].end.velocity = "fast"
    assert told(assign_inside) == ("wrong-type", 'm["rod"].end.velocity = "fast"')


def test_unknown_names_are_told_with_what_was_meant() -> None:
    m = lv.Model("errors")
    m.add_body("crank", lv.sphere(1, mass=1))
    with pytest.raises(lv.InputError) as raised:
        m.add_revolute("x", "wrold", "crank", at=(0, 0, 0), axis=(0, 1, 0))
    error = raised.value
    assert (error.code, error.path, error.help) == ("body-unknown", "joint[x].between", "did you mean 'world'?")
    with pytest.raises(lv.InputError, match="did you mean 'axis'"):
        m.add_revolute("x", "world", "crank", at=(0, 0, 0), axs=(0, 1, 0))   # type: ignore[call-arg,unused-ignore]
    with pytest.raises(lv.InputError, match="did you mean 'mass'"):
        m["crank"].mas = 3
    with pytest.raises(AttributeError, match="did you mean 'mass'"):
        m["crank"].mas
    with pytest.raises(KeyError, match="did you mean 'crank'"):
        m["crnk"]
    with pytest.raises(KeyError, match="did you mean 'crank'"):
        m.bodies["crnk"]
    with pytest.raises(AttributeError, match="gravity"):
        m.gravty = 3   # type: ignore[attr-defined]


def test_late_errors_point_at_the_edit() -> None:
    """What an edit breaks elsewhere is found on solving, at the line of the edit."""
    m = lv.Model("errors")
    m.add_body("a", lv.sphere(1, mass=1))
    m.add_spherical("ball", "world", "a", points=[(0, 0, 0), (0, 0, 0)])
    m["a"].position = (0, 0, 1)
    with pytest.raises(lv.InputError) as raised:
        lv.solve(m, 1)
    assert raised.value.file == __file__ and "ball" in str(raised.value)
    m["ball"].between = ("world", "b")
    assert "body-unknown" in [d.code for d in m.check()]


def test_codes_of_the_package_have_pages() -> None:
    """What Python itself raises is explained, too."""
    folder = pathlib.Path(lv.__file__).parent
    codes = {code for file in folder.glob("*.py") for code in re.findall(r'fault\(\s*"([a-z-]+)"', file.read_text())}
    assert len(codes) > 8
    for code in codes:
        assert lv.explain(code)
    with pytest.raises(lv.InputError):
        lv.explain("no-such-code")
