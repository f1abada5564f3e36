"""Picture and frame of a push-over: methods of it."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from ._core import PushOver
from ._figures import axes_for, color_for, key, label_axes, named, results_in
from ._frames import pandas, with_units

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from pandas import DataFrame


def plot_push_over(
    self: PushOver,
    axes: Axes | None = None,
    *,
    label: str | None = None,
    color: str | None = None,
    title: str | None = None,
) -> Axes:
    """Draws the load over the displacement, with a mark where the foundation begins to lift off; returns the axes.

    The load factor is in thousands: kN/m, or in plan kN, for a pattern of weight 1. ``axes``: those of matplotlib to draw into;
    unless given, axes of a new figure. For several curves in the same axes: ``label``, a name of the curve, and its
    ``color``. ``title`` stands above the picture; None for none.
    """
    [panel] = axes_for(axes, 1, title, figsize=(6.5, 4.5))
    shown = color_for(color, results_in(panel))
    panel.plot(self.displacement, 1e-3 * self.load_factor, color=shown, linewidth=1.0, label=label)
    is_open = np.flatnonzero(self.uplifted_fraction > 0.0)
    lifts_off = len(is_open) > 0 and is_open[0] > 0
    if lifts_off:
        first = is_open[0]
        mark: dict[str, Any] = {"color": shown, "markersize": 5.0, "label": named(label, "uplift begins")}
        panel.plot(self.displacement[first], 1e-3 * self.load_factor[first], "o", **mark)
    label_axes(panel, "displacement, m or rad", "load factor / 1000")
    if label is not None or lifts_off:
        key(panel)
    return panel


def push_over_frame(self: PushOver) -> DataFrame:
    """The states as a pandas frame: a row per state, with the arrays of `PushOver` as columns."""
    force = "N" if self.in_plan else "N/m"
    moment = "N·m" if self.in_plan else "N·m/m"
    # Units of load factor and displacement are those of the pattern and of the control.
    units = {"base_rotation": "rad", "rotation_across": "rad", "base_shear": force, "base_moment": moment}
    names = ["load_factor", "displacement", "uplifted_fraction", "sliding_fraction", *units]
    table = {name: getattr(self, name) for name in names}
    return with_units(pandas().DataFrame(table).rename_axis("state"), units)
