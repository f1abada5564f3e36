"""Results as pandas frames."""

from __future__ import annotations

from typing import Any

import numpy as np

from ._core import MODES


def pandas() -> Any:
    """The module pandas, or an error that says how to get it."""
    try:
        import pandas
    except ImportError as error:
        raise ImportError("frames and sweeps need pandas: pip install pandas") from error
    return pandas


def run(run: Any) -> Any:
    """All time series of a run, indexed by the time."""
    return pandas().DataFrame(run.series).set_index("time")


def contact(run: Any) -> Any:
    """Snapshots of the base, a row per frame and element."""
    columns = run.contact
    frames, elements = columns["gap"].shape
    x = 0.5 * (run.envelope["left"] + run.envelope["right"])
    table = {
        "time": np.repeat(columns["time"], elements),
        "element": np.tile(np.arange(elements), frames),
        "x": np.tile(x, frames),
    }
    table.update({name: columns[name].ravel() for name in ("gap", "slip", "pressure", "shear")})
    modes = pandas().Categorical.from_codes(columns["mode"].ravel(), categories=MODES)
    return pandas().DataFrame({**table, "mode": modes})


def equivalent_linear(site: Any) -> Any:
    """Layers of a site, indexed by the depth of their tops."""
    columns = ("shear_modulus", "modulus_ratio", "damping", "largest_strain", "effective_strain")
    values = {name: getattr(site, name) for name in columns}
    values["peak_acceleration"] = site.peak_acceleration[: len(site.depth)]
    return pandas().DataFrame(values, index=pandas().Index(site.depth, name="depth"))


def spectrum(spectrum: Any) -> Any:
    """A spectrum, indexed by the period."""
    columns = ("displacement", "pseudo_velocity", "pseudo_acceleration", "acceleration")
    values = {name: getattr(spectrum, name) for name in columns}
    return pandas().DataFrame(values, index=pandas().Index(spectrum.period, name="period"))
