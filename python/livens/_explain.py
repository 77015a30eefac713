# SPDX-License-Identifier: BSD-3-Clause
"""The pages of codes."""
from __future__ import annotations

from . import _core
from ._errors import fault


def explain(code: str) -> str:
    """The page of a diagnostic code, as printed by ``livens explain CODE``: meaning, a wrong and a right example.

    Raises:
        InputError: ``unknown-choice`` for an unknown code.

    Example:
        >>> import livens as lv
        >>> "no such body" in lv.explain("body-unknown") or "body" in lv.explain("body-unknown")
        True
    """
    if not isinstance(code, str):
        raise TypeError(f"a code is a string, not {type(code).__name__}")
    page: str = _core.explain(code)
    if not page:
        raise fault("unknown-choice", f"there is no code '{code}'", help=_core.suggestion(code, _core.diagnostic_codes()))
    return page
