"""Results as pandas frames."""

from __future__ import annotations

from typing import Any


def pandas() -> Any:
    """The module pandas, or an error that says how to get it."""
    try:
        import pandas
    except ImportError as error:
        raise ImportError("frames need pandas: pip install 'basemat[pandas]'") from error
    return pandas


def run(run: Any) -> Any:
    """All time series of a run, indexed by the time."""
    return pandas().DataFrame(run.series).set_index("time")


def spectrum(spectrum: Any) -> Any:
    """A spectrum, indexed by the period."""
    columns = ("displacement", "pseudo_velocity", "pseudo_acceleration", "acceleration")
    values = {name: getattr(spectrum, name) for name in columns}
    return pandas().DataFrame(values, index=pandas().Index(spectrum.period, name="period"))
