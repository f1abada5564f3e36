"""One case of a sweep, for this process or another."""

from __future__ import annotations

import traceback
from collections.abc import Callable, Mapping
from typing import Any, Optional

from . import _core
from ._core import Run, Simulation

# Results of a case, the texts of its run's warnings, and that of its error.
Outcome = tuple[dict[str, Any], Optional[str], Optional[str]]


def results_of(
    found: Any,
    steps: int | None,
    duration: float | None,
    results: Callable[[Run], Mapping[str, Any]] | None,
    warnings: list[str],
) -> dict[str, Any]:
    """Results of a row from what ``make`` returned; adds to ``warnings``."""
    if isinstance(found, Simulation):
        # A table says it in its column, once for every case.
        found = found.run(steps, duration=duration, series=results is not None, warn=False)
    if isinstance(found, Run):
        # Also if they were not shown.
        warnings.extend(found.warnings)
        return dict(found.summary() if results is None else results(found))
    if isinstance(found, Mapping):
        return dict(found)
    raise TypeError(
        f"make returned {type(found).__name__}, but must return a Simulation, a Run or a mapping"
    )


def run_case(
    make: Callable[..., Any],
    case: dict[str, Any],
    steps: int | None,
    duration: float | None,
    results: Callable[[Run], Mapping[str, Any]] | None,
) -> Outcome:
    """Results of a case, its warnings and the text of its error. Other processes import this function."""
    warnings: list[str] = []
    _core._collect_warnings(True)
    try:
        found, reason = results_of(make(**case), steps, duration, results, warnings), None
    except Exception as error:
        found, reason = {}, described(error)
    finally:
        heard = _core._collect_warnings(False)
    # Each once, as when a run was shown and then returned.
    return found, "; ".join(dict.fromkeys([*heard, *warnings])) or None, reason


def described(error: BaseException) -> str:
    """The error in one line, with its class."""
    return "".join(traceback.format_exception_only(type(error), error)).strip()
