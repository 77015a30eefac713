# SPDX-License-Identifier: BSD-3-Clause
"""What a motion looks like elsewhere: in notebooks, and as videos and stills that a browser draws."""
from __future__ import annotations

import base64
import html
import os
import pathlib
import re
import shutil
import struct
import zlib

import livens as lv
import numpy as np
import pytest

BROWSERS = ("chromium", "chromium-browser", "google-chrome", "google-chrome-stable")
LEFT_OUT = "browser" in os.environ.get("LIVENS_LEFT_OUT", "")   # by scripts/test: nothing of it has changed
needs_browser = pytest.mark.skipif(LEFT_OUT or ("CHROMIUM" not in os.environ and not any(map(shutil.which, BROWSERS))),
                                   reason="no change in what draws" if LEFT_OUT else "no Chromium")


@pytest.fixture(scope="module")
def rod() -> lv.Solution:
    m = lv.Model("pendulum", gravity=(0, 0, -9.81))
    body = m.add_body("rod", lv.box(1, "5 cm", "5 cm", density=7850), position=(0.5, 0, 0))
    m.add_revolute("pivot", "world", body, at=(0, 0, 0), axis=(0, 1, 0))
    return lv.solve(m, 2)


def test_a_display_is_light_and_whole(rod: lv.Solution) -> None:
    shown = rod._repr_html_()
    found = re.search(r'<iframe srcdoc="([^"]*)" sandbox="allow-scripts"', shown)
    assert found
    page = html.unescape(found[1])
    script = re.search(r'id="code">([A-Za-z0-9+/=]+)</script>', page)
    assert script
    code = zlib.decompress(base64.b64decode(script[1]))
    assert len(code) > 600_000 > 400_000 > len(shown.encode()), "the script alone would be more (control)"
    assert b"livensReport" in code and "connect-src" not in page and not re.search(r'(src|href)="http', page)


def test_the_verdict_is_the_programs(rod: lv.Solution) -> None:
    assert re.search(r"verdict +Converged: good to \d+ digits through 2 s, constraints hold to rounding\n", repr(rod))
    assert "relative to peak kinetic or stored energy" in repr(rod)
    assert '"lead": "good to' in rod._page("x").replace('"lead":"', '"lead": "')


@needs_browser
def test_videos_and_stills(rod: lv.Solution, tmp_path: pathlib.Path) -> None:
    still, later = tmp_path / "still.png", tmp_path / "later.png"
    rod.export(still, size=(160, 100))
    rod.export(later, size=(160, 100), start=0.5, names=True)
    assert struct.unpack_from(">II", still.read_bytes(), 16) == (160, 100) and still.read_bytes() != later.read_bytes()
    with pytest.warns(UserWarning, match="frames are 0.4 s of the motion apart"):
        rod.export(tmp_path / "x.gif", size=(96, 64), fps=5, duration=1)
    assert struct.unpack_from("<HH", (tmp_path / "x.gif").read_bytes(), 6) == (96, 64)
    rod.export(tmp_path / "motion.webm", size=(160, 100), fps=5, duration=1, end=0.5, view="front", dark=True)
    assert (tmp_path / "motion.webm").read_bytes()[:4] == b"\x1a\x45\xdf\xa3"
    rod.export(still, size=(160, 100))   # what is livens' own
    later.write_bytes(b"of somebody else")
    with pytest.raises(FileExistsError, match="force=True"):
        rod.export(later)


def test_what_cannot_be_drawn_is_told(rod: lv.Solution, tmp_path: pathlib.Path, monkeypatch: pytest.MonkeyPatch) -> None:
    for wrong in ({"size": (8, 8)}, {"fps": 1000}, {"start": 9}, {"start": 1, "end": 0.5}, {"duration": -1}):
        with pytest.raises(lv.InputError) as error:
            rod.export(tmp_path / "x.webm", **wrong)
        assert error.value.code == "picture"
    with pytest.raises(lv.InputError, match="no view"):
        rod.export(tmp_path / "x.png", view="back")
    monkeypatch.setenv("CHROMIUM", "/nonexistent/chromium")
    with pytest.raises(OSError, match="install Chromium") as failure:
        rod.export(tmp_path / "x.png")
    assert getattr(failure.value, "code", "browser-missing") == "browser-missing" and not list(tmp_path.iterdir())


def test_tables_in_degrees(rod: lv.Solution, tmp_path: pathlib.Path) -> None:
    file = tmp_path / "deg.csv"
    rod.export(file, unit="deg")
    head = file.read_text().splitlines()[0].split(",")
    table = np.genfromtxt(file, delimiter=",", skip_header=1)
    angle = table[:, head.index("pivot.angle [deg]")]
    rod.export(file)
    plain = file.read_text().splitlines()[0].split(",")
    assert "pivot.angle_rate [deg/s]" in head and "pivot.angle_acceleration [deg/s^2]" in head and "pivot.angle [rad]" in plain
    radians = np.genfromtxt(file, delimiter=",", skip_header=1)[:, plain.index("pivot.angle [rad]")]
    assert np.allclose(angle, np.degrees(radians), rtol=1e-14)
    with pytest.raises(lv.InputError) as error:
        rod.export(file, unit="kg")
    assert error.value.code == "unit"
    pytest.importorskip("pandas")
    frame = rod.to_dataframe("pivot", unit="deg")
    assert frame.attrs["units"]["pivot.angle"] == "deg"
