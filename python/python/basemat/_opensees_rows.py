"""Rows of displacements of an OpenSees model's nodes in the degrees of freedom that its ties leave."""

from __future__ import annotations

from typing import Any

import numpy as np

from . import DofCombination, InputError
from ._opensees_ties import Ties


class Rows:
    """Nodes of a model, and the rows of their displacements.

    Args:
        at: coordinates of each node (its tag), m.
        places: numbers of the degrees of freedom of each node in all of them.
        ties: which of them follow others.
    """

    def __init__(self, at: dict[int, tuple[float, ...]], places: dict[int, list[int]], ties: Ties) -> None:
        self.at, self.places, self.ties = at, places, ties
        self.directions = ties.directions
        #: Largest distance of two nodes along an axis, m.
        self.size = float(np.ptp(list(at.values()), axis=0).max())

    def row(self, node: int, direction: str, need: str = "") -> DofCombination:
        """The row of a node's displacement; ``need`` ends the message where constraints hold it at zero."""
        if node not in self.places:
            raise InputError(f"there is no node {node} in the model of OpenSees")
        numbers = self.places[node]
        if direction not in self.directions[: len(numbers)]:
            known = ", ".join(self.directions[: len(numbers)])
            raise InputError(f"there is no direction '{direction}', only {known}")
        place = numbers[self.directions.index(direction)]
        terms = self.ties.terms(place)
        if not terms:
            by = self.ties.about(place)
            raise InputError(f"node {node} is held in the direction {direction}{need} (it is held by {by})")
        return DofCombination(terms)

    def rigid(self, direction: str) -> Any:
        """Displacements of all nodes by a unit motion of the whole in a direction, or about the origin's axis."""
        k, moved = self.directions.index(direction), np.zeros(self.ties.sums.shape[0])
        for node, numbers in self.places.items():
            moved[numbers] = _rigid(k, self.at[node])[: len(numbers)]
        return moved


def _rigid(k: int, at: tuple[float, ...]) -> list[float]:
    """Displacements of a place, in all directions, by a unit motion of the whole in the direction ``k``."""
    if len(at) == 2:
        x, y = at
        return [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [-y, x, 1.0]][k]
    moved = [0.0] * 6
    moved[k] = 1.0
    if k >= 3:
        # The unit rotation across the place.
        one, other = (k + 1) % 3, (k + 2) % 3
        moved[one], moved[other] = -at[other], at[one]
    return moved
