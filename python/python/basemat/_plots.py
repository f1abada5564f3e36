"""Pictures of results with matplotlib: methods of the results."""

from __future__ import annotations

from typing import Any

import numpy as np

from ._core import MODES, Impedances, Run, SoilProfile, Spectrum

_COLORS = ("#d9d9d9", "#fdae6b", "#e6550d", "#3182bd", "#74c476", "#31a354", "#006d2c", "#e6550d", "#006d2c")
"""Of the modes, in their order."""


def _pyplot() -> Any:
    """The module matplotlib.pyplot, or an error that says how to get it."""
    try:
        import matplotlib.pyplot as pyplot
    except ImportError as error:
        raise ImportError("pictures need matplotlib: pip install matplotlib") from error
    return pyplot


def _axes(axes: Any, count: int, **options: Any) -> list[Any]:
    """The axes that were given, or those of a new figure, one below the other."""
    if axes is None:
        size = (8.0, 1.0 + 2.2 * count)
        options = {"sharex": True, "figsize": size, "layout": "constrained", **options}
        axes = _pyplot().subplots(count, **options)[1]
    found = list(np.ravel(axes))
    if len(found) != count:
        raise ValueError(f"axes are {len(found)}, but must be {count}")
    return found


def _label(axes: Any, x: str | None, y: str) -> None:
    if x is not None:
        axes.set_xlabel(x)
    axes.set_ylabel(y)
    axes.grid(alpha=0.3)
    axes.margins(x=0.0)


def plot_run(self: Run, axes: Any = None) -> list[Any]:
    """Draws base shear, contact modes and energies over time; returns the list of axes.

    Contact modes are those of the snapshots, if ``contact_every`` was given to
    :meth:`Simulation.run`. ``axes``: two of matplotlib to draw into, three with snapshots; those of a
    new figure unless given.
    """
    try:
        self.contact
    except ValueError:
        has_modes = False
    else:
        has_modes = True
    own = _axes(axes, 3 if has_modes else 2)
    own[0].plot(self.time, 1e-3 * self["base_shear"], linewidth=0.8, color="black")
    _label(own[0], None, "base shear, kN/m")
    if has_modes:
        plot_modes(self, own[1])
        own[1].set_xlabel("")
    terms = {**self.energy_balances}
    time, total = terms.pop("time"), terms.pop("input")
    own[-1].plot(time, 1e-3 * total, color="black", label="input")
    for name in ("residual", "largest", "relative_input", "soil_error_bound"):
        terms.pop(name, None)
    for name, values in terms.items():
        if np.nanmax(np.abs(values), initial=0.0) > 1e-3 * np.nanmax(np.abs(total), initial=0.0):
            own[-1].plot(time, 1e-3 * values, linewidth=0.8, label=name.replace("_", " "))
    _label(own[-1], "time, s", "energy, kJ/m")
    own[-1].legend(fontsize="small", ncols=2)
    return own


def plot_modes(self: Run, axes: Any = None) -> Any:
    """Draws the contact mode of every element over time; returns the axes.

    It needs snapshots of the contact: ``contact_every`` of :meth:`Simulation.run`. ``axes``: those of
    matplotlib to draw into; those of a new figure unless given.
    """
    [own] = _axes(axes, 1)
    from matplotlib.colors import ListedColormap
    from matplotlib.patches import Patch

    frames = self.contact
    time, modes = frames["time"], frames["mode"]
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
    found = np.unique(modes)
    place = {"loc": "lower right", "bbox_to_anchor": (1.0, 1.0), "borderaxespad": 0.2}
    patches = [Patch(color=_COLORS[mode], label=MODES[mode]) for mode in found]
    own.legend(handles=patches, fontsize="small", ncols=len(patches), **place)
    _label(own, "time, s", "x, m")
    own.grid(visible=False)
    return own


def animate(self: Run, scale: float | None = None) -> Any:
    """Moving picture of the base, its gaps and the pressure under it, element by element.

    It needs snapshots of the contact: ``contact_every`` of :meth:`Simulation.run`. ``scale``: factor
    on gaps; the largest one is a tenth of the base's length unless given. Returns a
    ``matplotlib.animation.FuncAnimation``, whose ``save`` writes a file.
    """
    frames = self.contact
    above, below = _axes(None, 2)
    from matplotlib.animation import FuncAnimation

    left, right = self.envelope["left"], self.envelope["right"]
    largest = float(np.max(frames["gap"], initial=0.0))
    if scale is None:
        scale = 0.1 * float(right[-1] - left[0]) / largest if largest > 0.0 else 1.0
    x = np.column_stack([left, right]).ravel()
    [base] = above.plot([], [], color="black")
    above.axhline(0.0, color="#a6611a")
    above.set_ylim(-0.1 * max(scale * largest, 1e-9), 1.2 * max(scale * largest, 1e-9))
    _label(above, None, f"gap × {scale:.3g}, m")
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


def plot_spectrum(self: Spectrum, axes: Any = None) -> Any:
    """Draws total and pseudo-accelerations over the period; returns the axes.

    ``axes``: those of matplotlib to draw into; those of a new figure unless given.
    """
    [own] = _axes(axes, 1)
    own.semilogx(self.period, self.acceleration, color="black", label="total acceleration")
    own.semilogx(self.period, self.pseudo_acceleration, "--", label="pseudo-acceleration")
    _label(own, "period, s", "acceleration, m/s²")
    own.legend(fontsize="small")
    return own


def plot_profile(self: SoilProfile, axes: Any = None) -> Any:
    """Draws the speed of shear waves over the depth; returns the axes.

    ``axes``: those of matplotlib to draw into; those of a new figure unless given.
    """
    [own] = _axes(axes, 1, figsize=(4.0, 5.0))
    depths, speeds = [0.0], []
    for layer in self.layers:
        depths.append(depths[-1] + layer.thickness)
        speeds.append(layer.soil.shear_wave_speed)
    if self.base is not None:
        depths.append(1.2 * depths[-1] if depths[-1] > 0.0 else 1.0)
        speeds.append(self.base.shear_wave_speed)
    own.plot(np.repeat(speeds, 2), np.repeat(depths, 2)[1:-1], color="black")
    _label(own, "speed of shear waves, m/s", "depth, m")
    if self.base is None:
        own.axhline(depths[-1], color="#a6611a", linewidth=3.0, label="rigid base")
        own.legend(fontsize="small")
    own.set_xlim(0.0, 1.1 * max(speeds, default=1.0))
    own.set_ylim(depths[-1], 0.0)
    return own


def plot_impedances(self: Impedances, axes: Any = None) -> list[Any]:
    """Draws real and imaginary parts over the frequency; returns the list of four axes.

    ``axes``: four of matplotlib to draw into; those of a new figure unless given.
    """
    own = _axes(axes, 4)
    units = {"horizontal": "N/m²", "vertical": "N/m²", "rocking": "N", "coupling": "N/m"}
    for place, (name, unit) in zip(own, units.items()):
        values = getattr(self, name)
        place.plot(self.frequency, values.real, color="black", label="real part")
        place.plot(self.frequency, values.imag, "--", label="imaginary part")
        _label(place, "frequency, Hz" if place is own[-1] else None, f"{name}, {unit}")
    own[0].legend(fontsize="small")
    return own
