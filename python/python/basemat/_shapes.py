"""Pictures of structures: deformed shapes, values of shells in plan and of solids in a section."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any, Literal
from weakref import WeakKeyDictionary

import numpy as np

from ._core import DeformedShape, Mesh
from ._errors import InputError
from ._figures import SOIL, SURFACE, axes_for, color_for, results_in

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.collections import PolyCollection
    from numpy.typing import ArrayLike, NDArray

_COS, _SIN = np.cos(np.pi / 6.0), np.sin(np.pi / 6.0)
_SCALES: WeakKeyDictionary[Axes, float] = WeakKeyDictionary()
"""Scales of the first state in axes."""
_JOINT_WIDTH = 2.5
"""Width of the sides of joints over that of other lines."""
_VIEWS = {
    "plan": ([0, 1], "y, m", "stands upright: it has no area in plan, but in the view 'front', 'side' or 'space'"),
    "front": ([0, 2], "height, m", "has no area in the view 'front': it lies flat or along y"),
    "side": ([1, 2], "height, m", "has no area in the view 'side': it lies flat or along x"),
}
"""Coordinates in each view of shells, the text of its second axis, and what is wrong with a shell that is a line there."""
OUTLINE, BAR = "#969696", "#464646"
"""Colours of elements without a value."""


def seen(places: Any, in_space: bool) -> NDArray[np.float64]:
    """Places in the picture: x and height in the plane; in space isometric, from the front, the right and above."""
    x, y, z = np.moveaxis(np.asarray(places, dtype=float), -1, 0)
    return np.stack([(x + y) * _COS, z + (y - x) * _SIN] if in_space else [x, y], axis=-1)


class Outline:
    """Lines and faces of a shape in the order in which they are drawn: near faces hide far ones."""

    def __init__(self, shape: DeformedShape) -> None:
        self.shape, self.in_space, self.points = shape, shape.in_space, shape.points
        cells = [cell for cell in shape.cells if len(cell) > 1]
        # Sides of joints, which are in the plane and come last.
        self.joints = len(shape.cells) - shape._first_joint_cell
        if self.in_space:
            nearness = self.points @ [1.0, -1.0, 1.0]
            cells.sort(key=lambda cell: float(np.mean(nearness[cell])))
        self.cells = [np.array(cell) for cell in cells]

    def moved(self, displacement: ArrayLike, scale: float) -> NDArray[np.float64]:
        """Places in the picture under magnified displacements."""
        return seen(self.points + scale * self.shape.displacements(displacement), self.in_space)

    def polygons(self, places: NDArray[np.float64]) -> list[NDArray[np.float64]]:
        """Corners of the cells at these places of the points."""
        return [places[cell] for cell in self.cells]

    def draw(self, axes: Axes, places: NDArray[np.float64], **options: Any) -> PolyCollection:
        """Cells of the shape at these places."""
        from matplotlib.collections import PolyCollection

        face = (1.0, 1.0, 1.0, 0.8) if self.in_space else "none"
        if self.joints:
            width = options.get("linewidths", 1.0)
            options["linewidths"] = [width] * (len(self.cells) - self.joints) + [_JOINT_WIDTH * width] * self.joints
        drawn = PolyCollection(self.polygons(places), facecolors=face, **options)
        axes.add_collection(drawn)
        return drawn


def usual_scale(points: NDArray[np.float64], largest: float) -> float:
    """Round factor that makes the largest displacement about a tenth of the size of the points; one if nothing moves."""
    size = float(np.ptp(points, axis=0).max())
    if not largest * 1e9 > size:
        return 1.0
    return _nice(0.05 * size / largest)


def _nice(least: float) -> float:
    """The smallest number of 1, 2 or 5 times a power of ten that is not below a value."""
    power = 10.0 ** np.floor(np.log10(least))
    return float(min(digit for digit in (1.0, 2.0, 5.0, 10.0) if digit * power >= least * (1.0 - 1e-12)) * power)


def draw_ground(axes: Axes, points: NDArray[np.float64], in_space: bool) -> None:
    """Surface of the soil around a shape."""
    (left, right), (front, back) = ((coordinates.min(), coordinates.max()) for coordinates in points.T[:2])
    margin = 0.15 * max(right - left, (back - front) * in_space)
    if in_space:
        x, y = (left - margin, right + margin), (front - margin, back + margin)
        corners = [[x[0], y[0], 0.0], [x[1], y[0], 0.0], [x[1], y[1], 0.0], [x[0], y[1], 0.0]]
        axes.fill(*seen(corners, True).T, facecolor=SOIL, edgecolor=SURFACE, linewidth=0.8, zorder=0)
        axes.set_axis_off()
    else:
        axes.plot([left - margin, right + margin], [0.0, 0.0], color=SURFACE, linewidth=1.0, zorder=0)
        axes.set(xlabel="x, m", ylabel="height, m")
    axes.set_aspect("equal")


def plot_shape(
    self: DeformedShape,
    displacement: ArrayLike | None = None,
    *,
    scale: float | None = None,
    axes: Axes | None = None,
    label: str | None = None,
    color: str | None = None,
    title: str | None = None,
) -> Axes:
    """Draws the structure at rest in grey, and moved by a displacement; returns the axes.

    In space the view is isometric, from the front, the right and above, and near faces hide far ones.

    Args:
        displacement: all n degrees of freedom, array of shape (n,), m and rad: a row of ``run.motion["displacement"]``,
            a static displacement or a vibration mode. Unless given, only the structure at rest is drawn.
        scale: factor on the displacement. Unless given, a round one that makes the largest displacement a twentieth to a
            tenth of the structure's size; of further states in the same axes that of the first.
        axes: axes of matplotlib to draw into; unless given, axes of a new figure. For several states in the same axes give
            each a ``label``.
        label: name of the state in the key, to which the scale is added; the scale alone unless given.
        color: colour of the moved structure; blue, then matplotlib's next, unless given.
        title: text above the picture; none unless given.
    """
    [panel] = axes_for(axes, 1, title, figsize=(6.0, 5.0))
    outline, before = Outline(self), results_in(panel)
    if before == 0:
        draw_ground(panel, outline.points, outline.in_space)
        rest = seen(outline.points, outline.in_space)
        outline.draw(panel, rest, edgecolors="#b0b0b0", linewidths=0.6, zorder=1)
    if displacement is not None:
        largest = float(np.linalg.norm(self.displacements(displacement), axis=1).max(initial=0.0))
        usual = _SCALES.setdefault(panel, usual_scale(outline.points, largest) if scale is None else scale)
        scale = usual if scale is None else scale
        text = f"{'' if label is None else f'{label}, '}displacements × {scale:g}"
        shown = color_for(color, before + 1)
        moved = outline.moved(displacement, scale)
        outline.draw(panel, moved, edgecolors=shown, linewidths=1.0, label=text, zorder=2 + before)
        panel.legend(fontsize="small", loc="upper left", bbox_to_anchor=(0.0, -0.12), frameon=False)
    panel.autoscale_view()
    return panel


def plot_shells(
    self: Mesh,
    elements: Sequence[int],
    values: ArrayLike,
    *,
    quantity: str = "",
    view: Literal["plan", "front", "side", "space"] = "plan",
    axes: Axes | None = None,
    title: str | None = None,
) -> Axes:
    """Draws one value for each shell of a mat, wall or building, such as a bending moment; returns the axes.

    Colours are in classes on both sides of zero. The mean of a moment over the corners of a shell comes from
    `FemModel.shell_resultants`.

    Args:
        elements: numbers of the shells.
        values: array of shape (elements,), in the unit of the quantity.
        quantity: name of the values with their unit for the key, such as "m_x, kN·m/m"; empty by default.
        view: "plan" (by default) draws x and y of a mat; "front" x and height of a wall along x, "side" y and height of one
            along y; "space" all shells from the front, the right and above, near ones over far ones.
        axes: axes of matplotlib to draw into; unless given, axes of a new figure.
        title: text above the picture; none unless given.
    """
    numbers, nodes, connected = checked_values(self, elements, values, "shell"), self.nodes, self.elements
    if view not in (*_VIEWS, "space"):
        raise InputError(f"view is '{view}', but must be 'plan', 'front', 'side' or 'space'")
    corners, nearness = [], []
    for element in elements:
        place = nodes[connected[element]]
        if nodes.shape[1] != 3 or len(place) not in (3, 4):
            raise InputError(f"element {element} is no shell of a mesh in space")
        nearness.append(float(np.mean(place @ [1.0, -1.0, 1.0])))
        if view == "space":
            corners.append(seen(place, True))
            continue
        directions, _, seen_edgewise = _VIEWS[view]
        x, y = place[:, directions].T
        if abs(x @ np.roll(y, -1) - y @ np.roll(x, -1)) < 1e-6 * np.ptp(place, axis=0).max() ** 2:
            raise InputError(f"element {element} {seen_edgewise}")
        corners.append(place[:, directions])
    [panel] = axes_for(axes, 1, title, figsize=(6.5, 5.0))
    if view == "space":
        order = np.argsort(nearness, kind="stable")
        draw_values(panel, [corners[int(k)] for k in order], numbers[order], quantity, 7.0)
        panel.set_axis_off()
        return panel
    draw_values(panel, corners, numbers, quantity, 7.0)
    panel.set_ylabel(_VIEWS[view][1])
    panel.set_xlabel("y, m" if view == "side" else "x, m")
    return panel


def plot_solids(
    self: Mesh,
    elements: Sequence[int],
    values: ArrayLike,
    *,
    quantity: str = "",
    axes: Axes | None = None,
    title: str | None = None,
) -> Axes:
    """Draws one value for each solid of a mesh in the plane, such as a plastic strain; returns the axes.

    Colours are in classes on both sides of zero. Solids without a value are drawn as their outlines, bars as lines.

    Args:
        elements: numbers of the quadrilaterals with a value, each once.
        values: array of shape (elements,), in the unit of the quantity.
        quantity: name of the values with their unit for the key, such as "plastic shear strain, %"; empty by default.
        axes: axes of matplotlib to draw into; unless given, axes of a new figure.
        title: text above the picture; none unless given.
    """
    numbers, nodes, connected = checked_values(self, elements, values, "solid"), self.nodes, self.elements
    with_value = set()
    for element in elements:
        if nodes.shape[1] != 2 or len(connected[element]) not in (4, 8):
            raise InputError(f"element {element} is no solid of a mesh in the plane")
        if element in with_value:
            raise InputError(f"element {element} has two values")
        with_value.add(element)
    rest = [nodes[connected[element][:4]] for element in range(len(connected)) if element not in with_value]
    bars = [corners for corners in rest if len(corners) == 2]
    outlines = [corners for corners in rest if len(corners) > 2]
    [panel] = axes_for(axes, 1, title, figsize=(8.0, 4.0))
    # Sections have steep gradients, and need more classes than a mat.
    draw_values(panel, [nodes[connected[element][:4]] for element in elements], numbers, quantity, 10.0)
    from matplotlib.collections import LineCollection, PolyCollection
    from matplotlib.patches import Patch

    if outlines:
        style: dict[str, Any] = {"facecolors": "none", "edgecolors": OUTLINE, "linewidths": 0.5}
        panel.add_collection(PolyCollection(outlines, **style))
        patch = Patch(facecolor="none", edgecolor=OUTLINE, label="without a value")
        panel.legend(handles=[patch], fontsize="small", loc="lower right", bbox_to_anchor=(1.0, 1.0))
    if bars:
        panel.add_collection(LineCollection(bars, colors=BAR, linewidths=1.2))
    panel.autoscale_view()
    return panel


def checked_values(mesh: Mesh, elements: Sequence[int], values: ArrayLike, kind: str) -> NDArray[np.float64]:
    """Values of elements of the mesh, one for each."""
    numbers, count = np.asarray(values, dtype=float), len(mesh.elements)
    if numbers.shape != (len(elements),):
        raise InputError(f"values have the shape {numbers.shape}, but must have ({len(elements)},): one for each {kind}")
    if not numbers.size:
        raise InputError("elements are none, but must be one at least")
    if not np.isfinite(numbers).all():
        raise InputError(f"values of {kind}s must be finite")
    for element in elements:
        if not 0 <= element < count:
            raise InputError(f"element is {element}, but must be one of the mesh's {count}")
    return numbers


def draw_values(axes: Axes, corners: list[Any], numbers: NDArray[np.float64], quantity: str, count: float) -> None:
    """Cells in the colours of their values, in about ``count`` classes up to the largest, and the key."""
    from matplotlib import colormaps
    from matplotlib.collections import PolyCollection
    from matplotlib.colors import BoundaryNorm

    low, high = min(float(numbers.min()), 0.0), max(float(numbers.max()), 0.0)
    largest = max(high, -low) or 1.0
    step = _nice(largest / count)
    classes = max(1, int(np.ceil(largest / step - 1e-9)))
    # One colour scale on both sides of zero; the key has the part that there is.
    bounds = step * np.arange(-classes, classes + 1)
    cells = PolyCollection(corners, edgecolors="white", linewidths=0.3)
    cells.set(cmap=colormaps["RdBu_r"], norm=BoundaryNorm(bounds, 256), array=numbers)
    axes.add_collection(cells)
    shown = bounds[(bounds >= low - step * (1.0 - 1e-9)) & (bounds <= high + step * (1.0 - 1e-9))]
    bar = axes.figure.colorbar(cells, ax=axes, label=quantity, ticks=shown, spacing="proportional")
    bar.ax.set_ylim(shown[0], shown[-1])
    axes.set(xlabel="x, m", ylabel="y, m", aspect="equal")
    axes.autoscale_view()
