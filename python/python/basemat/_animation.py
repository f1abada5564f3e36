"""Moving pictures of the base and the structure on it."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from ._core import DeformedShape, Run
from ._errors import InputError
from ._figures import COLORS, SURFACE, label_axes, mode_key, pyplot
from ._film import Film, moving
from ._plots import along, contact_plan
from ._shapes import Outline, draw_ground, seen, usual_scale

if TYPE_CHECKING:
    from matplotlib.animation import FuncAnimation
    from matplotlib.artist import Artist
    from matplotlib.axes import Axes

    from ._core import Structure
    from ._protocols import UserStructure

Drawn = Callable[[int], "list[Any]"]
"""A function that draws the snapshot with a number."""


def animate(
    self: Run,
    scale: float | None = None,
    *,
    structure: Structure | UserStructure | DeformedShape | None = None,
    height: float | Sequence[float | None] | None = None,
    frames: int = 200,
    title: str | None = None,
) -> FuncAnimation:
    """Moving picture of gaps, slip, contact modes and pressures of the base, and of the structure.

    It needs snapshots of the contact, and with a structure of its motion: ``contact_every`` and ``motion_every`` of
    `Simulation.run`. Gaps and slips are in mm; in plan the picture is that of `plot_contact_plan`. It plays as fast as the
    run in time, if that is 25 pictures a second at most.

    Args:
        scale: factor on the displacements of the structure. Unless given, a round one that makes the largest a twentieth
            to a tenth of the structure's size.
        structure: the simulation's structure, or its `DeformedShape`, which draws joints as well; none unless given.
        height: height of the box that stands for a rigid block, m, or a list of one for each structure of a group, as for
            `DeformedShape`; None for structures with a shape of their own.
        frames: largest number of pictures; of more snapshots as many are taken at equal distances. 200 by default.
        title: text above the picture; none unless given.

    Returns:
        A ``matplotlib.animation.FuncAnimation``, whose ``save("run.gif")`` or ``save("run.html")`` writes a file; videos such
        as "run.mp4" need the program ffmpeg.
    """
    film = film_of(self, scale, structure, height, frames, title)
    return moving(film)


def film_of(
    run: Run,
    scale: float | None,
    structure: Structure | UserStructure | DeformedShape | None,
    height: float | Sequence[float | None] | None,
    frames: int,
    title: str | None,
) -> Film:
    """The parts of an animation, with a layout that is solved once."""
    if frames < 2:
        raise InputError(f"frames are {frames}, but must be two or more")
    contact = run.contact
    taken = np.unique(np.linspace(0, len(contact["time"]) - 1, frames).round().astype(int))
    times = contact["time"][taken]
    shape = None
    if structure is not None:
        shape = structure if isinstance(structure, DeformedShape) else DeformedShape(structure, height=height)
    figure, parts = (_in_plan if run.in_plan else _in_plane)(run, shape, scale, times)
    if title is not None:
        figure.suptitle(title, fontsize="medium", x=0.01, horizontalalignment="left")

    def draw(number: int) -> list[Artist]:
        return [artist for part in parts for artist in part(int(taken[number]))]

    draw(0)
    figure.draw_without_rendering()
    figure.set_layout_engine("none")
    span = float(times[-1] - times[0]) / max(len(times) - 1, 1)
    return Film(figure, draw, len(taken), max(1e3 * span, 40.0))


def _clock(axes: Axes, times: Any, place: tuple[float, float] = (0.01, 0.97)) -> Drawn:
    """The time of the snapshot."""
    box = {"facecolor": "white", "edgecolor": "none", "alpha": 0.8, "pad": 1.5}
    text = axes.text(*place, "", transform=axes.transAxes, va="top", fontsize="small", bbox=box)

    def draw(frame: int) -> list[Artist]:
        text.set_text(f"{times[frame]:.2f} s")
        return [text]

    return draw


def _structure(run: Run, axes: Axes, shape: DeformedShape, scale: float | None, times: Any) -> Drawn:
    """The moving structure, in axes with room for all snapshots."""
    motion = run.motion
    outline = Outline(shape)
    nearest = {float(time): int(np.argmin(np.abs(motion["time"] - time))) for time in times}
    used = sorted(set(nearest.values()))
    moves = np.stack([shape.displacements(motion["displacement"][frame]) for frame in used])
    if scale is None:
        scale = usual_scale(outline.points, float(np.linalg.norm(moves, axis=2).max(initial=0.0)))
    places = dict(zip(used, seen(outline.points + scale * moves, outline.in_space)))
    outline.draw(axes, seen(outline.points, outline.in_space), edgecolors="#b0b0b0", linewidths=0.6)
    drawn = outline.draw(axes, places[used[0]], edgecolors="C0", linewidths=1.0, zorder=2)
    draw_ground(axes, outline.points, outline.in_space)
    if outline.in_space:
        axes.autoscale_view()
    everything = np.concatenate([*places.values(), axes.dataLim.get_points()])
    (left, low), (right, high) = everything.min(axis=0), everything.max(axis=0)
    margin = 0.04 * max(right - left, high - low)
    axes.set(xlim=(left - margin, right + margin), ylim=(low - margin, high + margin))
    axes.set_title(f"displacements × {scale:g}", fontsize="small", loc="right")
    all_times = run.contact["time"]

    def draw(frame: int) -> list[Artist]:
        drawn.set_verts(outline.polygons(places[nearest[float(all_times[frame])]]))
        return [drawn]

    return draw


def _in_plan(run: Run, shape: DeformedShape | None, scale: float | None, times: Any) -> tuple[Any, list[Drawn]]:
    """Figure of a run in plan, and the functions that draw it."""
    clock = run.contact["time"]
    if shape is None:
        axes, plan = contact_plan(run, None)
        return axes.figure, [plan, _clock(axes, clock)]
    figure, (left, right) = pyplot().subplots(1, 2, figsize=(10.0, 4.8), layout="constrained")
    _, plan = contact_plan(run, right)
    return figure, [_structure(run, left, shape, scale, times), plan, _clock(left, clock)]


def _in_plane(run: Run, shape: DeformedShape | None, scale: float | None, times: Any) -> tuple[Any, list[Drawn]]:
    """Figure of a run in the plane, and the functions that draw it."""
    contact, (left, right) = run.contact, along(run)
    parts: list[Drawn] = []
    if shape is None:
        figure, curves = pyplot().subplots(3, 1, sharex=True, figsize=(8.0, 6.0), layout="constrained")
        first = curves[0]
    else:
        figure, places = pyplot().subplot_mosaic(
            [["shape", "gap"], ["shape", "slip"], ["shape", "pressure"]], figsize=(11.0, 5.5), layout="constrained"
        )
        first, curves = places["shape"], [places[name] for name in ("gap", "slip", "pressure")]
        parts.append(_structure(run, first, shape, scale, times))
    x = np.column_stack([left, right, np.full_like(left, np.nan)]).ravel()
    for axes, name, factor, text in zip(
        curves, ("gap", "slip", "pressure"), (1e3, 1e3, 1e-3), ("gap, mm", "slip, mm", "pressure, kPa")
    ):
        values = factor * contact[name]
        low, high = min(float(values.min()), 0.0), max(float(values.max()), 0.0)
        room = 0.12 * max(high - low, 1e-9)
        axes.set(ylim=(low - room, high + room), xlim=(left[0], right[-1]))
        axes.axhline(0.0, color=SURFACE, linewidth=0.8)
        label_axes(axes, "x, m" if axes is curves[-1] else None, text)
        parts.append(_curve(axes, x, values))
    parts.append(_strip(run, curves[0]))
    parts.append(_clock(first, contact["time"]))
    return figure, parts


def _curve(axes: Axes, x: Any, values: Any) -> Drawn:
    """A value of each element."""
    [line] = axes.plot([], [], color="black", linewidth=1.5)

    def draw(frame: int) -> list[Artist]:
        line.set_data(x, np.repeat(values[frame], 3))
        return [line]

    return draw


def _strip(run: Run, axes: Axes) -> Drawn:
    """Contact modes along the lower edge of the axes, with their key."""
    from matplotlib.collections import LineCollection

    modes, (left, right) = run.contact["mode"], along(run)
    low = axes.get_ylim()[0]
    strip = LineCollection([[(a, low), (b, low)] for a, b in zip(left, right)], linewidths=12.0, capstyle="butt")
    axes.add_collection(strip, autolim=False)
    mode_key(axes, np.unique(modes))

    def draw(frame: int) -> list[Artist]:
        strip.set_color([COLORS[mode] for mode in modes[frame]])
        return [strip]

    return draw
