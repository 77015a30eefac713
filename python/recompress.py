# SPDX-License-Identifier: BSD-3-Clause
"""Compresses a wheel once more: the same files and names, deflated by zopfli, which takes longer and a twentieth less.

    python recompress.py WHEEL
"""
from __future__ import annotations

import pathlib
import sys
import zipfile

import zopfli.zipfile


def recompress(wheel: pathlib.Path) -> None:
    packed = wheel.with_suffix(".packed")
    with zipfile.ZipFile(wheel) as old, zopfli.zipfile.ZipFile(packed, "w", zipfile.ZIP_DEFLATED) as new:
        for info in old.infolist():
            new.writestr(info, old.read(info))
    with zipfile.ZipFile(wheel) as old, zipfile.ZipFile(packed) as new:   # read by another than wrote it
        assert old.namelist() == new.namelist()
        assert all(old.read(name) == new.read(name) for name in old.namelist())
        assert [one.external_attr for one in old.infolist()] == [one.external_attr for one in new.infolist()]
    packed.replace(wheel)


if __name__ == "__main__":
    recompress(pathlib.Path(sys.argv[1]))
