"""Pictures of the earth pressures on walls: methods of the results."""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING, Any

import numpy as np

from ._core import Run
from ._errors import InputError
from ._figures import axes_for, key, label_axes

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from numpy.typing import NDArray

_CURVES = (
    ("static_pressure", "at rest", "black", "-"),
    ("lowest_pressure", "lowest", "C0", "-"),
    ("highest_pressure", "highest", "C1", "-"),
)
"""Pressures of the envelope, their names in the key, colours and lines."""
_LIMITS = (("active", "C2", "--"), ("passive", "C3", "--"))
"""Limits of the soil, their colours and lines."""


def plot_wall_pressures(
    self: Run, interface: Any = None, axes: Iterable[Axes] | None = None, *, title: str | None = None
) -> list[Axes]:
    """Draws pressures at rest, lowest and highest pressures over the height of both walls; returns the list of two axes.

    Pressures are means over the elements of a ground in a trench. ``interface``: the laws of the simulation,
    ``simulation.interface``, whose active and passive pressures (`EarthPressure`) are drawn as dashed lines, the passive ones
    where they are below 1.5 times the largest pressure; none unless given. ``axes``: two of matplotlib to draw into; unless
    given, axes of a new figure. ``title`` stands above the picture; None for none.
    """
    walls = walls_of(self)
    if not len(walls[0]):
        raise InputError("the run has no walls: plot_wall_pressures is for a ground in a trench")
    panels = axes_for(axes, 2, title, figsize=(9.0, 4.2), nrows=1, sharey=True, sharex=False)
    for number, (panel, elements) in enumerate(zip(panels, walls)):
        heights = self.heights[elements]
        largest = float(np.abs(self.envelope["highest_pressure"][elements]).max(initial=0.0))
        for name, text, color, line in _CURVES:
            _draw(panel, heights, self.envelope[name][elements], text, color, line)
        for place, (text, color, line) in enumerate(_LIMITS):
            limits = np.array([_limit(interface, int(element), place) for element in elements])
            if np.isfinite(limits).any():
                limits[limits > 1.5 * largest] = np.nan
                _draw(panel, heights, limits, text, color, line)
        label_axes(panel, "pressure, kPa", "height, m" if number == 0 else "")
        wall = ("left wall", "right wall")[number]
        panel.set_title(wall if title is None or number else title, fontsize="medium", loc="left")
        panel.margins(x=0.05, y=0.0)
        panel.set_xlim(left=0.0)
    key(panels[1])
    return panels


def walls_of(run: Run) -> tuple[NDArray[np.intp], NDArray[np.intp]]:
    """Numbers of the elements of the left and the right wall; empty arrays without walls."""
    is_wall = np.diff(run.heights).ravel() > 0.0
    if run.in_plan or not is_wall.any():
        return np.empty(0, dtype=np.intp), np.empty(0, dtype=np.intp)
    numbers = np.arange(len(is_wall))
    # The left wall comes before the base.
    is_left = numbers < int(np.argmin(is_wall))
    return numbers[is_wall & is_left], numbers[is_wall & ~is_left]


def _limit(interface: Any, element: int, place: int) -> float:
    """Active (0) or passive (1) pressure of the law of an element, Pa; NaN for a law without."""
    law = interface[element] if isinstance(interface, (list, tuple)) else interface
    pressures = getattr(law, "pressures", None)
    return float(pressures[place]) if isinstance(pressures, (list, tuple)) else np.nan


def _draw(panel: Axes, heights: NDArray[np.float64], pressures: NDArray[np.float64], text: str, color: str, line: str) -> None:
    """A pressure that is constant over each element."""
    order = np.argsort(heights[:, 0])
    panel.plot(1e-3 * np.repeat(pressures[order], 2), heights[order].ravel(), line, color=color, label=text, linewidth=1.2)
