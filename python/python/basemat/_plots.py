"""Pictures of results with matplotlib: methods of the results."""

from __future__ import annotations

from collections.abc import Callable
from contextlib import suppress
from typing import Any

import numpy as np

from ._core import MODES, Impedances, Run, SoilProfile, Spectrum
from ._errors import InputError

_COLORS = ("#d9d9d9", "#fdae6b", "#e6550d", "#3182bd", "#74c476", "#31a354", "#006d2c", "#e6550d", "#006d2c")
"""Of the modes, in their order."""
_OPEN = "#164878"
"""Of open elements in plan."""


def _pyplot() -> Any:
    """The module matplotlib.pyplot, or an error that says how to get it."""
    try:
        import matplotlib.pyplot as pyplot
    except ImportError as error:
        raise ImportError("pictures need matplotlib: pip install matplotlib") from error
    return pyplot


def _axes(axes: Any, count: int, **options: Any) -> list[Any]:
    """The given axes, or axes of a new figure, one below the other."""
    if axes is None:
        size = (8.0, 1.0 + 2.2 * count)
        options = {"sharex": True, "figsize": size, "layout": "constrained", **options}
        axes = _pyplot().subplots(count, **options)[1]
    found = list(np.ravel(axes))
    if len(found) != count:
        raise InputError(f"axes are {len(found)}, but must be {count}")
    return found


def _label(axes: Any, x: str | None, y: str) -> None:
    if x is not None:
        axes.set_xlabel(x)
    axes.set_ylabel(y)
    axes.grid(alpha=0.3)
    axes.margins(x=0.0)


def _legend(axes: Any, **options: Any) -> None:
    """Key to the curves at the right of the axes, where it hides none."""
    axes.legend(fontsize="small", loc="upper left", bbox_to_anchor=(1.0, 1.0), **options)


def _logarithmic(axes: Any) -> None:
    """A logarithmic x-axis with plain numbers at 1, 2 and 5, at more on a short one."""
    from matplotlib.ticker import FuncFormatter, LogLocator, NullFormatter

    axes.set_xscale("log")
    low, high = axes.get_xlim()
    marks = (1.0, 2.0, 5.0) if high > 10.0 * low else (1.0, 1.5, 2.0, 3.0, 4.0, 5.0, 7.0)
    axes.xaxis.set_major_locator(LogLocator(subs=marks))
    axes.xaxis.set_major_formatter(FuncFormatter(lambda value, _: f"{value:g}"))
    axes.xaxis.set_minor_formatter(NullFormatter())


def _named(label: str | None, name: str) -> str:
    return name if label is None else f"{label}, {name}"


def plot_run(self: Run, axes: Any = None, *, label: str | None = None, color: str | None = None) -> list[Any]:
    """Draws base shear (in plan both), contact modes and energies over time; returns the list of axes.

    Contact modes are those of the snapshots, if ``contact_every`` was given to
    `Simulation.run`. ``axes``: two of matplotlib to draw into, three with snapshots; those of a
    new figure unless given. For several runs in the same axes: ``label``, a name before those of the curves, and
    ``color`` of the base shear.
    """
    has_modes = False
    with suppress(InputError):
        has_modes = bool(self.contact)
    own = _axes(axes, 3 if has_modes else 2)
    names = {"base_shear": "base shear", "shear_across": "across"} if self.in_plan else {"base_shear": "base shear"}
    for name, usual in zip(names, ("black", "#3182bd")):
        shown = _named(label, names[name])
        own[0].plot(self.time, 1e-3 * self[name], linewidth=0.8, color=color or usual, label=shown)
    _label(own[0], None, f"base shear, k{self.units['base_shear']}")
    if self.in_plan or label is not None:
        _legend(own[0])
    if has_modes:
        plot_modes(self, own[1])
        own[1].set_xlabel("")
    terms = {**self.energy_balances}
    time, total = terms.pop("time"), terms.pop("input")
    own[-1].plot(time, 1e-3 * total, color=color or "black", label=_named(label, "input"))
    for name in ("residual", "largest", "relative_input", "soil_error_bound"):
        terms.pop(name, None)
    for name, values in terms.items():
        if np.nanmax(np.abs(values), initial=0.0) > 1e-3 * np.nanmax(np.abs(total), initial=0.0):
            own[-1].plot(time, 1e-3 * values, linewidth=0.8, label=_named(label, name.replace("_", " ")))
    _label(own[-1], "time, s", f"energy, k{self.units['input']}")
    _legend(own[-1])
    return own


def plot_modes(self: Run, axes: Any = None) -> Any:
    """Draws the contact mode of every element over time, in plan the area of each; returns the axes.

    It needs snapshots of the contact: ``contact_every`` of `Simulation.run`. ``axes``: those of
    matplotlib to draw into; unless given, axes of a new figure.
    """
    [own] = _axes(axes, 1)
    from matplotlib.colors import ListedColormap
    from matplotlib.patches import Patch

    frames = self.contact
    time, modes = frames["time"], frames["mode"]
    found = np.unique(modes)
    place = {"loc": "lower right", "bbox_to_anchor": (1.0, 1.0), "borderaxespad": 0.2}
    patches = [Patch(color=_COLORS[mode], label=MODES[mode]) for mode in found]
    own.legend(handles=patches, fontsize="small", ncols=len(patches), **place)
    if self.in_plan:
        area = np.prod([high - low for low, high in _sides(self)], axis=0)
        areas = [(modes == mode) @ area for mode in found]
        own.stackplot(time, areas, colors=[_COLORS[mode] for mode in found])
        _label(own, "time, s", "area of the elements, m²")
        return own
    edges, rows = [self.envelope["left"][0]], []
    for left, right, row in zip(self.envelope["left"], self.envelope["right"], modes.T):
        if left > edges[-1]:
            # Between two foundations.
            edges.append(left)
            rows.append(np.full(len(time), np.nan))
        edges.append(right)
        rows.append(row)
    step = time[1] - time[0] if len(time) > 1 else 1.0
    own.pcolormesh(
        np.append(time, time[-1] + step),
        edges,
        np.array(rows, dtype=float),
        cmap=ListedColormap(_COLORS),
        vmin=-0.5,
        vmax=len(MODES) - 0.5,
        rasterized=True,
    )
    _label(own, "time, s", "x, m")
    own.grid(visible=False)
    return own


def _sides(run: Run) -> list[tuple[Any, Any]]:
    """Ends of the elements along x and along y, of a run in plan."""
    return [(run.envelope[low], run.envelope[high]) for low, high in (("left", "right"), ("front", "back"))]


def plot_contact_plan(self: Run, time: float | None = None, axes: Any = None) -> Any:
    """Draws the base in plan at an instant: pressures, open elements, and where sliding ones move; returns the axes.

    It needs snapshots of the contact on a ground in plan: ``contact_every`` of `Simulation.run`. ``time`` (s): the
    snapshot nearest to it is drawn; that with the most open elements unless given. ``axes``: those of matplotlib to draw
    into; unless given, axes of a new figure.
    """
    times, modes = self.contact["time"], self.contact["mode"]
    open_ones = (modes == MODES.index("open")).sum(axis=1)
    frame = int(np.argmax(open_ones) if time is None else np.argmin(np.abs(times - time)))
    axes, draw = _plan(self, axes)
    draw(frame)
    return axes


def _plan(run: Run, axes: Any) -> tuple[Any, Callable[[int], list[Any]]]:
    """Axes with the base in plan, and the function that draws a snapshot into it."""
    if not run.in_plan:
        raise InputError("the ground is no one in plan: plot_modes draws a base in the plane")
    frames = run.contact
    [own] = _axes(axes, 1, figsize=(6.5, 5.0))
    from matplotlib import colormaps
    from matplotlib.collections import PolyCollection
    from matplotlib.patches import Patch

    (left, right), (front, back) = _sides(run)
    corners = np.stack([[left, right, right, left], [front, front, back, back]], axis=-1).swapaxes(0, 1)
    colors = colormaps["OrRd"].with_extremes(bad=_OPEN)
    cells = PolyCollection(list(corners), cmap=colors, edgecolors="white", linewidths=0.5)
    pressures = 1e-3 * frames["pressure"]
    cells.set_clim(0.0, max(float(pressures.max()), 1e-9))
    own.add_collection(cells)
    x, y, size = 0.5 * (left + right), 0.5 * (front + back), 0.5 * np.minimum(right - left, back - front)
    arrows = own.quiver(x, y, 0.0 * x, 0.0 * y, angles="xy", scale_units="xy", scale=1.0, pivot="mid", width=0.004)
    own.figure.colorbar(cells, ax=own, label="pressure, kPa")
    own.legend(handles=[Patch(color=_OPEN, label="open")], fontsize="small", loc="lower right", bbox_to_anchor=(1.0, 1.0))
    own.set(xlabel="x, m", ylabel="y, m", aspect="equal")
    own.autoscale_view()

    def draw(frame: int) -> list[Any]:
        mode, shears = frames["mode"][frame], [frames[name][frame] for name in ("shear", "shear_across")]
        cells.set_array(np.ma.masked_where(mode == MODES.index("open"), pressures[frame]))
        largest = np.hypot(*shears)
        # Over the soil they move along the shear traction on it.
        slides = np.isin(mode, [MODES.index(name) for name in ("slip", "yield_slip")]) & (largest > 0.0)
        factor = np.ma.masked_where(~slides, size / np.where(slides, largest, 1.0))
        arrows.set_UVC(factor * shears[0], factor * shears[1])
        own.set_title(f"{frames['time'][frame]:.2f} s", fontsize="medium", loc="left")
        return [cells, arrows]

    return own, draw


def animate(self: Run, scale: float | None = None) -> Any:
    """Moving picture of the base, its gaps and the pressure under it, element by element; in plan of what
    `plot_contact_plan` draws.

    It needs snapshots of the contact: ``contact_every`` of `Simulation.run`. ``scale``: factor
    on gaps, which are then drawn in m; in mm, as they are, unless given. Returns a
    ``matplotlib.animation.FuncAnimation``, whose ``save`` writes a file.
    """
    frames = self.contact
    from matplotlib.animation import FuncAnimation

    if self.in_plan:
        axes, show = _plan(self, None)
        return FuncAnimation(axes.figure, show, frames=len(frames["time"]), interval=40, blit=False)
    above, below = _axes(None, 2)

    left, right = self.envelope["left"], self.envelope["right"]
    largest = float(np.max(frames["gap"], initial=0.0))
    name = "gap, mm" if scale is None else f"gap × {scale:g}, m"
    scale = 1e3 if scale is None else scale
    x = np.column_stack([left, right]).ravel()
    [base] = above.plot([], [], color="black")
    above.axhline(0.0, color="#a6611a")
    above.set_ylim(-0.1 * max(scale * largest, 1e-9), 1.2 * max(scale * largest, 1e-9))
    _label(above, None, name)
    pressures = 1e-3 * frames["pressure"]
    [pressure] = below.plot([], [], color="#3182bd")
    below.set_ylim(1.1 * min(float(pressures.min()), 0.0), 1.1 * max(float(pressures.max()), 1e-9))
    _label(below, "x, m", "pressure, kPa")
    below.set_xlim(left[0], right[-1])

    def draw(frame: int) -> list[Any]:
        base.set_data(x, scale * np.repeat(frames["gap"][frame], 2))
        pressure.set_data(x, np.repeat(pressures[frame], 2))
        above.set_title(f"{frames['time'][frame]:.2f} s", fontsize="medium")
        return [base, pressure]

    return FuncAnimation(above.figure, draw, frames=len(frames["time"]), interval=40, blit=False)


def plot_spectrum(
    self: Spectrum, axes: Any = None, *, label: str | None = None, color: str | None = None
) -> Any:
    """Draws total and pseudo-accelerations over the period; returns the axes.

    ``axes``: those of matplotlib to draw into; unless given, axes of a new figure. For several spectra in the same axes:
    ``label``, a name before the names of the curves, and ``color`` of both.
    """
    [own] = _axes(axes, 1)
    total, pseudo = _named(label, "total acceleration"), _named(label, "pseudo-acceleration")
    own.plot(self.period, self.acceleration, color=color or "black", label=total)
    own.plot(self.period, self.pseudo_acceleration, "--", color=color, label=pseudo)
    _logarithmic(own)
    _label(own, "period, s", "acceleration, m/s²")
    _legend(own)
    return own


def plot_profile(self: SoilProfile, axes: Any = None) -> Any:
    """Draws the speed of shear waves over the depth; returns the axes.

    ``axes``: those of matplotlib to draw into; unless given, axes of a new figure.
    """
    [own] = _axes(axes, 1, figsize=(4.0, 5.0))
    depths, speeds = [0.0], []
    for layer in self.layers:
        depths.append(depths[-1] + layer.thickness)
        speeds.append(layer.soil.shear_wave_speed)
    if self.bedrock is not None:
        depths.append(1.2 * depths[-1] if depths[-1] > 0.0 else 1.0)
        speeds.append(self.bedrock.shear_wave_speed)
    own.plot(np.repeat(speeds, 2), np.repeat(depths, 2)[1:-1], color="black")
    _label(own, "speed of shear waves, m/s", "depth, m")
    if self.bedrock is None:
        own.axhline(depths[-1], color="#a6611a", linewidth=3.0, label="rigid bedrock")
        _legend(own)
    own.set_xlim(0.0, 1.1 * max(speeds, default=1.0))
    own.set_ylim(depths[-1], 0.0)
    return own


def plot_impedances(
    self: Impedances, axes: Any = None, *, label: str | None = None, color: str | None = None
) -> list[Any]:
    """Draws real and imaginary parts over the frequency; returns the list of four axes.

    ``axes``: four of matplotlib to draw into; unless given, axes of a new figure. For several grounds in the same axes:
    ``label``, a name before the names of the curves, and ``color`` of both.
    """
    own = _axes(axes, 4)
    units = {"horizontal": "N/m²", "vertical": "N/m²", "rocking": "N", "coupling": "N/m"}
    for place, (name, unit) in zip(own, units.items()):
        values = getattr(self, name)
        place.plot(self.frequency, values.real, color=color or "black", label=_named(label, "real part"))
        place.plot(self.frequency, values.imag, "--", color=color, label=_named(label, "imaginary part"))
        _label(place, "frequency, Hz" if place is own[-1] else None, f"{name}, {unit}")
    _legend(own[0])
    return own
