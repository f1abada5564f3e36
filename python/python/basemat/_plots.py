"""Pictures of results with matplotlib: methods of the results."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from typing import TYPE_CHECKING, Any
from weakref import WeakKeyDictionary

import numpy as np

from ._core import MODES, Impedances, Run, SoilProfile, Spectrum
from ._errors import InputError
from ._figures import (
    COLORS,
    ENERGY_COLORS,
    OPEN,
    axes_for,
    color_for,
    key,
    label_axes,
    logarithmic,
    mode_key,
    named,
    results_in,
    was_kept,
)

if TYPE_CHECKING:
    from matplotlib.artist import Artist
    from matplotlib.axes import Axes
    from numpy.typing import ArrayLike

_STYLES = ("-", "--", ":", "-.")
"""Of the energies of several runs in the same axes."""
_STRAIN_FACTORS: WeakKeyDictionary[Axes, float] = WeakKeyDictionary()
"""Factors on the strains in axes: 100 for %, 1000 for 10⁻³."""


def plot_run(
    self: Run,
    axes: Iterable[Axes] | None = None,
    *,
    label: str | None = None,
    color: str | None = None,
    title: str | None = None,
) -> list[Axes]:
    """Draws base shear (in plan both), contact modes and energies over time; returns the list of axes.

    Contact modes need snapshots: ``contact_every`` of `Simulation.run`. ``axes``: two of matplotlib to draw into, three
    with snapshots; unless given, axes of a new figure. For several runs in the same axes:
    ``label``, a name before those of the curves, and ``color`` of the base shear; energies have one colour each, and a
    line style for each run; contact modes are those of the first run. ``title`` stands above the picture; None for none.
    """
    has_modes = was_kept(self, "contact")
    panels = axes_for(axes, 3 if has_modes else 2, title)
    before = results_in(panels[0])
    names = {"base_shear": "base shear", "shear_across": "across"} if self.in_plan else {"base_shear": "base shear"}
    for number, name in enumerate(names):
        line: dict[str, Any] = {"color": color_for(color, before * len(names) + number), "linewidth": 0.8}
        panels[0].plot(self.time, 1e-3 * self[name], label=named(label, names[name]), **line)
    label_axes(panels[0], None, f"base shear, k{self.units['base_shear']}")
    if self.in_plan or label is not None:
        key(panels[0])
    if has_modes and before == 0:
        # Modes of a second run would hide those of the first.
        plot_modes(self, panels[1])
        panels[1].set_xlabel("")
        if label is not None:
            panels[1].set_title(label, fontsize="medium", loc="left")
    terms = {**self.energy_balances}
    time, total = terms.pop("time"), terms.pop("input")
    style = _STYLES[before % len(_STYLES)]
    panels[-1].plot(time, 1e-3 * total, style, color="black", label=named(label, "input"))
    for name in ("residual", "largest", "relative_input", "soil_error_bound"):
        terms.pop(name, None)
    for name, values in terms.items():
        if np.nanmax(np.abs(values), initial=0.0) > 1e-3 * np.nanmax(np.abs(total), initial=0.0):
            line = {"color": ENERGY_COLORS[name], "linewidth": 0.8}
            panels[-1].plot(time, 1e-3 * values, style, label=named(label, name.replace("_", " ")), **line)
    label_axes(panels[-1], "time, s", f"energy, k{self.units['input']}")
    key(panels[-1])
    return panels


def plot_modes(self: Run, axes: Axes | None = None, *, title: str | None = None) -> Axes:
    """Draws the contact mode of every element over time, in plan the area of each; returns the axes.

    It needs snapshots of the contact: ``contact_every`` of `Simulation.run`. ``axes``: axes of matplotlib to draw into; of a
    new figure unless given. ``title`` stands above the picture; None for none.
    """
    [panel] = axes_for(axes, 1, title)
    from matplotlib.colors import ListedColormap

    frames = self.contact
    time, modes = frames["time"], frames["mode"]
    found = np.unique(modes)
    mode_key(panel, found)
    if self.in_plan:
        area = np.prod([high - low for low, high in sides(self)], axis=0)
        areas = [(modes == mode) @ area for mode in found]
        panel.stackplot(time, areas, colors=[COLORS[mode] for mode in found])
        label_axes(panel, "time, s", "area of the elements, m²")
        return panel
    lefts, rights = along(self)
    edges, rows = [lefts[0]], []
    for left, right, row in zip(lefts, rights, modes.T):
        if left - edges[-1] > 1e-6 * (right - left):
            # Between two foundations.
            edges.append(left)
            rows.append(np.full(len(time), np.nan))
        edges.append(right)
        rows.append(row)
    step = time[1] - time[0] if len(time) > 1 else 1.0
    panel.pcolormesh(
        np.append(time, time[-1] + step),
        edges,
        np.array(rows, dtype=float),
        cmap=ListedColormap(COLORS),
        vmin=-0.5,
        vmax=len(MODES) - 0.5,
        rasterized=True,
    )
    label_axes(panel, "time, s", "x, m")
    panel.grid(visible=False)
    return panel


def along(run: Run) -> tuple[Any, Any]:
    """Ends of the elements along the base, of a run in the plane: walls continue it to both sides."""
    left, right = run.envelope["left"], run.envelope["right"]
    above = run.heights - run.heights.min()
    reach = np.diff(above).ravel()
    # The left wall comes before the base.
    side = np.where(np.arange(len(left)) < np.argmax(right > left), -1.0, 1.0)
    near, far = left + side * above[:, 0], right + side * above[:, 1]
    is_wall = reach > 0.0
    return np.where(is_wall, np.minimum(near, far), left), np.where(is_wall, np.maximum(near, far), right)


def sides(run: Run) -> list[tuple[Any, Any]]:
    """Ends of the elements along x and along y, of a run in plan."""
    return [(run.envelope[low], run.envelope[high]) for low, high in (("left", "right"), ("front", "back"))]


def plot_contact_plan(
    self: Run, time: float | None = None, axes: Axes | None = None, *, title: str | None = None
) -> Axes:
    """Draws the base in plan at an instant: pressures, open elements, and where sliding ones move; returns the axes.

    It needs snapshots of the contact on a ground in plan: ``contact_every`` of `Simulation.run`. ``time`` (s): the
    snapshot nearest to it is drawn; that with the most open elements unless given. ``axes``: those of matplotlib to draw
    into; unless given, axes of a new figure. ``title`` stands above the picture; the time of the snapshot unless given.
    """
    times, modes = self.contact["time"], self.contact["mode"]
    open_ones = (modes == MODES.index("open")).sum(axis=1)
    frame = int(np.argmax(open_ones) if time is None else np.argmin(np.abs(times - time)))
    axes, draw = contact_plan(self, axes)
    draw(frame)
    axes.set_title(f"{times[frame]:.2f} s" if title is None else title, fontsize="medium", loc="left")
    return axes


def contact_plan(run: Run, axes: Axes | None) -> tuple[Axes, Callable[[int], list[Artist]]]:
    """Axes with the base in plan, and the function that draws a snapshot into it."""
    if not run.in_plan:
        raise InputError("the ground is no one in plan: plot_modes draws a base in the plane")
    frames = run.contact
    [panel] = axes_for(axes, 1, figsize=(6.5, 5.0))
    from matplotlib import colormaps
    from matplotlib.collections import PolyCollection
    from matplotlib.patches import Patch

    (left, right), (front, back) = sides(run)
    corners = np.stack([[left, right, right, left], [front, front, back, back]], axis=-1).swapaxes(0, 1)
    colors = colormaps["OrRd"].with_extremes(bad=OPEN)
    cells = PolyCollection(list(corners), cmap=colors, edgecolors="white", linewidths=0.5)
    pressures = 1e-3 * frames["pressure"]
    cells.set_clim(0.0, max(float(pressures.max()), 1e-9))
    panel.add_collection(cells)
    x, y, size = 0.5 * (left + right), 0.5 * (front + back), 0.5 * np.minimum(right - left, back - front)
    arrows = panel.quiver(x, y, 0.0 * x, 0.0 * y, angles="xy", scale_units="xy", scale=1.0, pivot="mid", width=0.004)
    panel.figure.colorbar(cells, ax=panel, label="pressure, kPa")
    panel.legend(handles=[Patch(color=OPEN, label="open")], fontsize="small", loc="lower right", bbox_to_anchor=(1.0, 1.0))
    panel.set(xlabel="x, m", ylabel="y, m", aspect="equal")
    panel.autoscale_view()

    def draw(frame: int) -> list[Artist]:
        mode, shears = frames["mode"][frame], [frames[name][frame] for name in ("shear", "shear_across")]
        cells.set_array(np.ma.masked_where(mode == MODES.index("open"), pressures[frame]))
        largest = np.hypot(*shears)
        # Over the soil they move along the shear traction on it.
        slides = np.isin(mode, [MODES.index(name) for name in ("slip", "yield_slip")]) & (largest > 0.0)
        factor = np.ma.masked_where(~slides, size / np.where(slides, largest, 1.0))
        arrows.set_UVC(factor * shears[0], factor * shears[1])
        return [cells, arrows]

    return panel, draw


def plot_moment_rotation(
    self: Run,
    axes: Axes | None = None,
    *,
    foundation: int = 0,
    across: bool = False,
    between: tuple[float, float] | None = None,
    measured: tuple[ArrayLike, ArrayLike] | None = None,
    label: str | None = None,
    color: str | None = None,
    title: str | None = None,
) -> Axes:
    """Draws the moment on the soil over the rotation of a foundation, beside measured points; returns the axes.

    ``foundation`` (the first unless given) and ``across`` (False by default) as for `Run.rocking`; ``between``: first and last
    time of the path, s, the whole run unless given. ``measured``: rotations (rad) and moments (N·m/m, in plan N·m), arrays of
    shape (m,), drawn as points; none unless given. ``axes``: those of matplotlib to draw into; unless given, axes of a new figure.
    For several runs in the same axes: ``label``, a name of the path, and its ``color``. ``title`` stands above the picture; None
    for none.
    """
    panel = _over_rotation(self, "moment", 1e-3, foundation, across, between, measured, axes, label, color, title)
    label_axes(panel, "rotation, mrad", f"moment, k{self.units['base_moment']}")
    return panel


def plot_settlement_rotation(
    self: Run,
    axes: Axes | None = None,
    *,
    foundation: int = 0,
    across: bool = False,
    between: tuple[float, float] | None = None,
    measured: tuple[ArrayLike, ArrayLike] | None = None,
    label: str | None = None,
    color: str | None = None,
    title: str | None = None,
) -> Axes:
    """Draws the settlement over the rotation of a foundation, downwards, beside measured points; returns the axes.

    ``measured``: rotations (rad) and settlements (m), arrays of shape (m,), drawn as points; none unless given. The other
    arguments as for `Run.plot_moment_rotation`: ``foundation`` (the first unless given), ``across`` (False by default),
    ``between`` (s; the whole run unless given), ``axes`` (of a new figure unless given), ``label``, ``color`` and ``title``
    (None for none).
    """
    panel = _over_rotation(self, "settlement", 1e3, foundation, across, between, measured, axes, label, color, title)
    label_axes(panel, "rotation, mrad", "settlement, mm")
    # Limits set by hand would cut off the paths of further runs.
    panel.yaxis.set_inverted(True)
    return panel


def _over_rotation(
    run: Run,
    name: str,
    factor: float,
    foundation: int,
    across: bool,
    between: tuple[float, float] | None,
    measured: tuple[ArrayLike, ArrayLike] | None,
    axes: Axes | None,
    label: str | None,
    color: str | None,
    title: str | None,
) -> Axes:
    """Axes with an array of the rocking over the rotation in mrad."""
    rocking = run.rocking(foundation, across=across)
    shown = np.ones(len(rocking["time"]), dtype=bool)
    if between is not None:
        # Times are whole numbers of steps, with rounding.
        rounding = 1e-9 * max(map(abs, between))
        shown = (rocking["time"] >= between[0] - rounding) & (rocking["time"] <= between[1] + rounding)
    [panel] = axes_for(axes, 1, title, figsize=(6.5, 4.5))
    before = results_in(panel)
    line: dict[str, Any] = {"color": color_for(color, before), "linewidth": 0.8, "label": label}
    panel.plot(1e3 * rocking["rotation"][shown], factor * rocking[name][shown], **line)
    if measured is not None:
        points = [np.asarray(values, dtype=float) for values in measured]
        dots: dict[str, Any] = {"color": f"C{(before + 1) % 10}", "markersize": 3.0, "label": named(label, "measured")}
        panel.plot(1e3 * points[0], factor * points[1], ".", **dots)
    if label is not None or measured is not None:
        key(panel)
    return panel


def plot_stress_strain(
    strain: ArrayLike,
    stress: ArrayLike,
    axes: Axes | None = None,
    *,
    label: str | None = None,
    color: str | None = None,
    title: str | None = None,
) -> Axes:
    """Draws the shear stress over the shear strain at a point of a solid; returns the axes.

    ``strain`` (engineering shear strain, a number without unit) and ``stress`` (Pa): arrays of shape (n,), in the order of time.
    The picture has them in % and kPa; the strain is in 10⁻³ if the first path in the axes stays below 0.1 %. ``axes``:
    those of matplotlib to draw into; unless given, axes of a new figure. For several points in the same axes: ``label``, a
    name of the path, and its ``color``. ``title`` stands above the picture; None for none.
    """
    strains, stresses = np.asarray(strain, dtype=float), np.asarray(stress, dtype=float)
    if strains.ndim != 1 or strains.shape != stresses.shape:
        raise InputError(f"strain and stress have the shapes {strains.shape} and {stresses.shape}, but must both have (n,)")
    if not strains.size:
        raise InputError("strain and stress are empty, but must have one state at least")
    if not (np.isfinite(strains).all() and np.isfinite(stresses).all()):
        raise InputError("strain and stress must be finite")
    [panel] = axes_for(axes, 1, title, figsize=(6.5, 4.5))
    factor = _STRAIN_FACTORS.setdefault(panel, 1e2 if np.abs(strains).max() >= 1e-3 else 1e3)
    shown = color_for(color, results_in(panel))
    panel.plot(factor * strains, 1e-3 * stresses, color=shown, linewidth=0.8, label=label)
    label_axes(panel, "shear strain, %" if factor == 1e2 else "shear strain, 10⁻³", "shear stress, kPa")
    if label is not None:
        key(panel)
    return panel


def plot_spectrum(
    self: Spectrum,
    axes: Axes | None = None,
    *,
    label: str | None = None,
    color: str | None = None,
    title: str | None = None,
) -> Axes:
    """Draws total and pseudo-accelerations over the period; returns the axes.

    ``axes``: those of matplotlib to draw into; unless given, axes of a new figure. For several spectra in the same axes:
    ``label``, a name before the names of the curves, and ``color`` of both. ``title`` stands above the picture; None for
    none.
    """
    [panel] = axes_for(axes, 1, title)
    shown = color_for(color, results_in(panel))
    total, pseudo = named(label, "total acceleration"), named(label, "pseudo-acceleration")
    panel.plot(self.period, self.acceleration, color=shown, label=total)
    panel.plot(self.period, self.pseudo_acceleration, "--", color=shown, linewidth=1.0, label=pseudo)
    logarithmic(panel)
    label_axes(panel, "period, s", "acceleration, m/s²")
    panel.set_ylim(0.0, 1.05 * panel.dataLim.y1)
    key(panel)
    return panel


def plot_profile(
    self: SoilProfile,
    axes: Axes | None = None,
    *,
    label: str | None = None,
    color: str | None = None,
    title: str | None = None,
) -> Axes:
    """Draws the speed of shear waves over the depth; returns the axes.

    ``axes``: those of matplotlib to draw into; unless given, axes of a new figure. For several profiles in the same axes:
    ``label``, a name of the curve, and its ``color``. ``title`` stands above the picture; None for none.
    """
    [panel] = axes_for(axes, 1, title, figsize=(4.0, 5.0))
    shown, depths, speeds = color_for(color, results_in(panel)), [0.0], []
    for layer in self.layers:
        depths.append(depths[-1] + layer.thickness)
        speeds.append(layer.soil.shear_wave_speed)
    if self.bedrock is not None:
        depths.append(1.2 * depths[-1] if depths[-1] > 0.0 else 1.0)
        speeds.append(self.bedrock.shear_wave_speed)
    panel.plot(np.repeat(speeds, 2), np.repeat(depths, 2)[1:-1], color=shown, label=label)
    label_axes(panel, "speed of shear waves, m/s", "depth, m")
    if self.bedrock is None:
        panel.axhline(depths[-1], color=shown, linewidth=3.0, label=named(label, "rigid bedrock"))
    if label is not None or self.bedrock is None:
        panel.legend(fontsize="small", loc="lower left")
    panel.set_xlim(0.0, max(panel.get_xlim()[1], 1.1 * max(speeds, default=1.0)))
    panel.set_ylim(max(depths[-1], panel.dataLim.y1), 0.0)
    return panel


def plot_impedances(
    self: Impedances,
    axes: Iterable[Axes] | None = None,
    *,
    label: str | None = None,
    color: str | None = None,
    title: str | None = None,
) -> list[Axes]:
    """Draws real and imaginary parts over the frequency; returns the list of four axes.

    ``axes``: four of matplotlib to draw into; unless given, axes of a new figure. For several grounds in the same axes:
    ``label``, a name before the names of the curves, and ``color`` of both. ``title`` stands above the picture; None for
    none.
    """
    panels = axes_for(axes, 4, title)
    shown = color_for(color, results_in(panels[0]))
    units = {"horizontal": "N/m²", "vertical": "N/m²", "rocking": "N", "coupling": "N/m"}
    for place, (name, unit) in zip(panels, units.items()):
        values = getattr(self, name)
        place.plot(self.frequency, values.real, color=shown, label=named(label, "real part"))
        place.plot(self.frequency, values.imag, "--", color=shown, linewidth=1.0, label=named(label, "imaginary part"))
        label_axes(place, "frequency, Hz" if place is panels[-1] else None, f"{name}, {unit}")
    key(panels[0])
    return panels
