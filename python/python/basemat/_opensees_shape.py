"""Shape of an OpenSees model for pictures: its nodes and elements."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from . import DeformedShape
from ._opensees_base import AXES
from ._opensees_rows import Rows

_SIDES = ((0, 3, 2, 1), (4, 5, 6, 7), (0, 1, 5, 4), (1, 2, 6, 5), (2, 3, 7, 6), (3, 0, 4, 7))
"""Corners of the sides of a brick."""


def shape_of(ops: Any, rows: Rows, base: Sequence[int], up: str) -> DeformedShape:
    """Shape with heights above the ``base`` nodes; ``up`` is the axis that points up in space.

    Sides between two bricks are left out.
    """
    in_space = len(rows.directions) == 6
    # Directions of the model along the axes of the shape, with their signs.
    axes = AXES[up] if in_space else ((0, 1.0), (1, 1.0))
    height = rows.at[base[0]][axes[-1][0]]
    number = {tag: k for k, tag in enumerate(rows.places)}
    points, moves = [], []
    for tag, numbers in rows.places.items():
        points.append([sign * rows.at[tag][k] - height * (k == axes[-1][0]) for k, sign in axes])
        moves.append([[(dof, sign * weight) for dof, weight in rows.ties.terms(numbers[k])] for k, sign in axes])
    cells: dict[frozenset[int], list[int]] = {}
    inner = set()
    for element in ops.getEleTags():
        nodes = [number[tag] for tag in ops.eleNodes(element) if tag in number]
        for side in [[nodes[k] for k in side] for side in _SIDES] if len(nodes) == 8 and in_space else [nodes]:
            found = frozenset(side)
            if len(nodes) == 8 and found in cells:
                inner.add(found)
            if len(found) > 1:
                cells[found] = side
    return DeformedShape.of_points(points, moves, [side for found, side in cells.items() if found not in inner])


def base_nodes_of(ops: Any, base_nodes: Sequence[int] | None, faces: Sequence[Any] | None) -> list[int]:
    """Nodes of the base, or of its first face."""
    if faces is None:
        return list(base_nodes or ())
    first = faces[0]
    return list(ops.eleNodes(first)) if isinstance(first, int) else list(first)
