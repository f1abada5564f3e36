"""One case of a sweep, for this process or another."""

from __future__ import annotations

import traceback
from collections.abc import Callable, Mapping
from typing import Any, Optional

from ._core import Run, Simulation

# Results of a case, the texts of its run's warnings, and that of its error.
Outcome = tuple[dict[str, Any], Optional[str], Optional[str]]


def results_of(
    found: Any,
    steps: int | None,
    duration: float | None,
    results: Callable[[Run], Mapping[str, Any]] | None,
) -> Outcome:
    """Columns of a row from what ``make`` returned."""
    if isinstance(found, Simulation):
        # A table says it in its column, once for every case.
        found = found.run(steps, duration=duration, series=results is not None, warn=False)
    if isinstance(found, Run):
        warnings = "; ".join(found.warnings) or None
        return dict(found.summary() if results is None else results(found)), warnings, None
    if isinstance(found, Mapping):
        return dict(found), None, None
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
    """Results of a case and the text of its error; importable, for other processes."""
    try:
        return results_of(make(**case), steps, duration, results)
    except Exception as error:
        return {}, None, described(error)


def described(error: BaseException) -> str:
    """The error in one line, with its class."""
    return "".join(traceback.format_exception_only(type(error), error)).strip()
