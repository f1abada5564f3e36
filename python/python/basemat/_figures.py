"""Axes, keys and colours that all pictures share."""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING, Any, Literal
from weakref import WeakKeyDictionary

import numpy as np

from ._core import MODES, Run
from ._errors import InputError

if TYPE_CHECKING:
    from matplotlib.axes import Axes

COLORS = (
    "#d9d9d9",
    "#fdae6b",
    "#e6550d",
    "#3182bd",
    "#a1d99b",
    "#41ab5d",
    "#00441b",
    "#fd8d3c",
    "#006d2c",
    "#c994c7",
    "#807dba",
    "#3f007d",
)
"""Of the modes, in their order."""
ENERGY_COLORS = {
    "kinetic": "#1f77b4",
    "strain": "#ff7f0e",
    "hysteresis": "#d62728",
    "damping": "#2ca02c",
    "algorithmic": "#8c564b",
    "midstep_remainder": "#17becf",
    "soil": "#e377c2",
    "contact": "#7f7f7f",
    "interface": "#9467bd",
    "static_contact": "#d4b000",
}
"""Of the energies, by their names."""
OPEN = "#164878"
"""Of open elements in plan."""
SOIL, SURFACE = "#eee5d6", "#7d623e"
_RESULTS: WeakKeyDictionary[Axes, int] = WeakKeyDictionary()
"""Numbers of results in axes."""


def pyplot() -> Any:
    """The module matplotlib.pyplot, or an error that says how to get it."""
    try:
        import matplotlib.pyplot as found
    except ImportError as error:
        raise ImportError("pictures need matplotlib: pip install matplotlib") from error
    return found


def axes_for(axes: Axes | Iterable[Axes] | None, count: int, title: str | None = None, **options: Any) -> list[Axes]:
    """The given axes, or axes of a new figure, one below the other; the title stands above the first."""
    if axes is None:
        size = (8.0, 1.0 + 2.2 * count)
        options = {"sharex": True, "figsize": size, "layout": "constrained", **options}
        options.setdefault("nrows", count)
        axes = pyplot().subplots(ncols=count // options["nrows"], **options)[1]
    found: list[Axes] = list(np.ravel(axes))  # type: ignore[arg-type]
    if len(found) != count:
        raise InputError(f"axes are {len(found)}, but must be {count}")
    if title is not None:
        found[0].set_title(title, fontsize="medium", loc="left")
    return found


def label_axes(axes: Axes, x: str | None, y: str) -> None:
    """Names of the axes with their units, and a grid."""
    if x is not None:
        axes.set_xlabel(x)
    axes.set_ylabel(y)
    axes.grid(alpha=0.3)
    axes.margins(x=0.0)


def key(axes: Axes, **options: Any) -> None:
    """Key to the curves at the right of the axes, where it hides none."""
    axes.legend(fontsize="small", loc="upper left", bbox_to_anchor=(1.0, 1.0), **options)


def mode_key(axes: Axes, modes: Iterable[int]) -> None:
    """Key to these contact modes, by their numbers, above the axes at the right."""
    from matplotlib.patches import Patch

    patches = [Patch(color=COLORS[mode], label=MODES[mode]) for mode in modes]
    place: dict[str, Any] = {"loc": "lower right", "bbox_to_anchor": (1.0, 1.0), "borderaxespad": 0.2}
    axes.legend(handles=patches, fontsize="small", ncols=len(patches), **place)


def was_kept(run: Run, snapshots: Literal["contact", "motion"]) -> bool:
    """Whether a run kept snapshots of this kind."""
    try:
        return bool(getattr(run, snapshots))
    except InputError:
        return False


def named(label: str | None, name: str) -> str:
    """Name of a curve after the name of its result."""
    return name if label is None else f"{label}, {name}"


def color_for(color: str | None, number: int = 0) -> str:
    """The given colour; of the first result black, of further ones in the same axes the next of matplotlib's."""
    if color is not None:
        return color
    return "black" if number == 0 else f"C{(number - 1) % 10}"


def results_in(axes: Axes) -> int:
    """Number of results that were drawn into the axes before; this call draws one more."""
    before = _RESULTS.get(axes, 0)
    _RESULTS[axes] = before + 1
    return before


def logarithmic(axes: Axes) -> None:
    """A logarithmic x-axis with plain numbers at 1, 2 and 5, at more on a short one."""
    from matplotlib.ticker import FuncFormatter, LogLocator, NullFormatter

    axes.set_xscale("log")
    low, high = axes.get_xlim()
    marks = (1.0, 2.0, 5.0) if high > 10.0 * low else (1.0, 1.5, 2.0, 3.0, 4.0, 5.0, 7.0)
    axes.xaxis.set_major_locator(LogLocator(subs=marks))
    axes.xaxis.set_major_formatter(FuncFormatter(lambda value, _: f"{value:g}"))
    axes.xaxis.set_minor_formatter(NullFormatter())
