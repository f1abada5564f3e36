"""The base of an OpenSees model: nodes in the plane, outlines or faces in space, and whether it moves freely."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import Any, Literal

import numpy as np

from . import BaseFaces, BaseNode, DofCombination, InputError
from ._opensees_linear import Elements
from ._opensees_rows import Rows

Up = Literal["z", "y"]

_FREE = ": it must be free, as the ground holds the structure up"

#: Axes to the right, away and up, by number and sign, of a model with that axis up.
AXES: dict[str, tuple[tuple[int, float], ...]] = {
    "z": ((0, 1.0), (1, 1.0), (2, 1.0)),
    "y": ((0, 1.0), (2, -1.0), (1, 1.0)),
}


def line_of(rows: Rows, base_nodes: Sequence[int], width: float | None) -> list[BaseNode]:
    """Nodes of the base in the plane."""
    at = {tag: rows.at[tag] for tag in base_nodes if tag in rows.at}
    x = {tag: float(point[0]) for tag, point in at.items()}
    found = {}
    for tag in base_nodes:
        for name in rows.directions if width is not None else rows.directions[:2]:
            found[tag, name] = rows.row(tag, name, _FREE)
    heights = sorted({float(point[1]) for point in at.values()})
    if len(heights) > 1:
        raise InputError(f"base nodes are at heights of {heights[0]} to {heights[-1]} m, but must be at one")
    if len(x) < 2 and width is None or len(x) != 1 and width is not None:
        raise InputError(f"{len(x)} base nodes: give several, or a single one with a width")
    if width is None:
        return [BaseNode(x[tag], found[tag, "x"], found[tag, "y"]) for tag in sorted(x, key=lambda tag: x[tag])]
    [tag] = x
    ends = (-0.5 * width, 0.5 * width)
    return [
        BaseNode(x[tag] + offset, found[tag, "x"], found[tag, "y"] + found[tag, "rotation"] * offset) for offset in ends
    ]


def faces_of(
    rows: Rows,
    elements: Elements,
    base_nodes: Sequence[int] | None,
    outline: Sequence[Any] | None,
    faces: Sequence[int | Sequence[int]] | None,
    below: float | None,
    up: str,
) -> BaseFaces:
    """Faces of the base in space: outlines of rigid mats, or faces between nodes."""
    if up not in AXES:
        raise InputError(f"up is '{up}', but must be 'z' or 'y'")
    if below is not None and not (np.isfinite(below) and below >= 0.0):
        raise InputError(f"below is {below} m, but must be zero or more")
    base = _Base(rows, AXES[up])
    if faces is not None:
        if base_nodes is not None or outline is not None:
            raise InputError("the base is given twice: give faces, or base_nodes with an outline")
        parts = list(_faces(elements, faces, below))
        base.check_heights([tag for nodes, _ in parts for tag in nodes], up)
        return BaseFaces([[base.node(tag, base.place(tag)[:2], depth) for tag in nodes] for nodes, depth in parts])
    if outline is None or base_nodes is None or not len(base_nodes):
        raise InputError(
            "the base of a model in space is base_nodes, a single one with the outline of a rigid mat or several with "
            "an outline each, or the faces of a flexible one"
        )
    outlines = _outlines(outline)
    if len(outlines) != len(base_nodes):
        raise InputError(f"{len(base_nodes)} base nodes with {len(outlines)} outlines: give one for each")
    base.check_heights(base_nodes, up)
    depth = below or 0.0
    return BaseFaces(
        [[base.node(tag, corner, depth, True) for corner in outline] for tag, outline in zip(base_nodes, outlines)]
    )


def _outlines(outline: Sequence[Any]) -> list[Any]:
    """A list of outlines, or a single one, as arrays of corners."""
    try:
        found = [np.asarray(corners, dtype=float) for corners in outline]
        if found and all(corners.ndim == 1 for corners in found):
            found = [np.asarray(found, dtype=float)]
    except (TypeError, ValueError):
        found = [np.zeros(0)]
    if any(corners.ndim != 2 or corners.shape[1] != 2 for corners in found):
        raise InputError(f"outline is {outline!r}, but must be a list of corners, each of x and y in m, or a list of such lists")
    return found


def _faces(
    elements: Elements, faces: Sequence[int | Sequence[int]], below: float | None
) -> Iterator[tuple[list[int], float]]:
    """Corners of each face, and the ground's distance below them, m."""
    shells = elements.shells()
    thickness: dict[tuple[int, ...], float] = {}
    for nodes, shell_thickness in shells.values():
        # Of several shells on the same nodes the thickest; one that is not printed must be given.
        key = tuple(sorted(nodes))
        thickness[key] = max(thickness.get(key, 0.0), np.inf if shell_thickness is None else shell_thickness)
    if not len(faces):
        raise InputError("there are no faces: give the elements or the nodes of the base")
    for face in faces:
        nodes = [int(tag) for tag in np.ravel(face)]
        if np.ndim(face) == 0:
            if nodes[0] not in shells:
                raise InputError(f"element {face} of the faces is no shell in the model of OpenSees")
            nodes = shells[nodes[0]][0]
        if len(nodes) not in (3, 4):
            raise InputError(f"face {face} has {len(nodes)} nodes, but must have three or four: give those at its corners")
        depth = 0.5 * thickness.get(tuple(sorted(nodes)), 0.0) if below is None else below
        if not np.isfinite(depth):
            raise InputError(f"OpenSees does not tell the thickness of the shell {face}: give below, half of it")
        yield nodes, depth


class _Base:
    """Nodes of a base in space, with axes to the right, away and up."""

    def __init__(self, rows: Rows, axes: tuple[tuple[int, float], ...]) -> None:
        self._rows, self._axes = rows, axes

    def place(self, tag: int) -> list[float]:
        """Coordinates of a node to the right, away and up, m."""
        if tag not in self._rows.at:
            raise InputError(f"there is no node {tag} in the model of OpenSees")
        return [sign * float(self._rows.at[tag][k]) for k, sign in self._axes]

    def check_heights(self, tags: Sequence[int], up: str) -> None:
        """An error for base nodes that are not at one height."""
        heights = [self.place(tag)[2] for tag in tags]
        if heights and max(heights) - min(heights) > 1e-6 * self._rows.size:
            raise InputError(
                f"base nodes are at heights of {min(heights)} to {max(heights)} m, but must be at one: heights are along "
                f"the axis {up}, by the argument up"
            )

    def node(self, tag: int, corner: Sequence[float], depth: float, is_rigid: bool = False) -> BaseNode:
        """A point that moves with a node, at (x, y) of the plan and a depth below the node."""
        here = self.place(tag)
        dx, dy = float(corner[0]) - here[0], float(corner[1]) - here[1]
        right, away, up = (self._row(tag, k) for k in range(3))
        if is_rigid:
            rx, ry, rz = (self._row(tag, 3 + k) for k in range(3))
            right, away, up = _sum(right, (rz, -dy)), _sum(away, (rz, dx)), _sum(up, (rx, dy), (ry, -dx))
        elif depth:
            rx, ry = (self._row(tag, 3 + k) for k in range(2))
        if depth:
            right, away = _sum(right, (ry, -depth)), _sum(away, (rx, depth))
        return BaseNode(float(corner[0]), right, up, y=float(corner[1]), across=away)

    def _row(self, tag: int, k: int) -> DofCombination:
        """Displacement, or rotation, of a node along an axis of the plan or up."""
        axis, sign = self._axes[k % 3]
        directions = self._rows.directions
        row = self._rows.row(tag, directions[axis + k // 3 * 3], _FREE)
        return row if sign > 0.0 else row * sign


def _sum(row: DofCombination, *terms: tuple[DofCombination, float]) -> DofCombination:
    """A row and others by their weights; a weight of zero adds no term."""
    for other, weight in terms:
        row = row + other * weight if weight else row
    return row


def moves(rows: Rows, used: Any) -> str:
    """An error for constraints that stop a translation of the structure; words for those that stop its rotation.

    ``used``: whether a degree of freedom has stiffness or mass.
    """
    ties = rows.ties
    for name in rows.directions:
        moved = rows.rigid(name)
        missed = used & (np.abs(ties.sums @ moved[ties.kept] - moved) > 1e-6 * max(rows.size, 1.0))
        for tag, numbers in rows.places.items():
            for place, direction in zip(numbers, rows.directions):
                if not missed[place]:
                    continue
                by = f"node {tag} ({direction}) does not follow, by {ties.about(place)}"
                if name in ("x", "y", "z"):
                    raise InputError(f"the structure must translate freely in {name}, as the ground holds it up: {by}")
                return f"the structure does not rotate freely, as if something beside the ground held it: {by}"
    return ""


def masses(rows: Rows, mass: Any, up: str) -> str:
    """Text about masses that differ by direction; the vertical one gives the weight."""
    names = [name for name in rows.directions if name in ("x", "y", "z")]
    found = {}
    for name in names:
        moved = rows.rigid(name)
        found[name] = float(moved @ (mass @ moved))
    if max(found.values()) - min(found.values()) <= 1e-3 * max(found.values()):
        return ""
    up = up if len(names) == 3 else "y"
    listed = ", ".join(f"{mass:.4g} {'kg' if len(names) == 3 else 'kg/m'} along {name}" for name, mass in found.items())
    return f"the model of OpenSees has masses of {listed}: the ground carries the weight of those along {up}, the axis up"
