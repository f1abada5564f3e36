"""Ties and supports of an OpenSees model: which degrees of freedom follow others."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

#: Part of a diagonal entry below which a constraint only repeats the ones before it.
_REPEATED = 1e-13

#: Constraints that a message names.
_MOST = 8

DIRECTIONS = ("x", "y", "rotation")


class Ties:
    """Displacements of all nodes as weighted sums of the degrees of freedom that are left.

    Args:
        ops: the module ``openseespy.opensees``.
        places: numbers of the three degrees of freedom of each node (its tag), in rows of ``penalty``.
        penalty: Σ GᵀG (n × n) of the rows G of all constraints, G u = 0. It comes from OpenSees itself,
            whichever command made the constraints.
    """

    def __init__(self, ops: Any, places: dict[int, list[int]], penalty: Any) -> None:
        self._places = places
        self._near = {int(own): np.flatnonzero(penalty[own]).tolist() for own in np.flatnonzero(penalty.diagonal())}
        self._fixed = {int(tag): [int(own) - 1 for own in ops.getFixedDOFs(tag)] for tag in ops.getFixedNodes()}
        #: Nodes that follow, the nodes that they follow, and the directions.
        self._pairs = {
            (int(tag), int(master)): [int(own) - 1 for own in ops.getConstrainedDOFs(tag, master)]
            for tag in ops.getConstrainedNodes()
            for master in ops.getRetainedNodes(tag)
        }
        followed: dict[int, set[int]] = {}
        for (tag, _), directions in self._pairs.items():
            followed.setdefault(tag, set()).update(directions)
        #: Ties in a chain: a node that follows a second one, which follows a third.
        self.chains = [
            pair
            for pair in self._pairs
            if followed.get(pair[1], set()).intersection(int(own) - 1 for own in ops.getRetainedDOFs(pair[1], pair[0]))
        ]
        left, diagonal, sums = penalty.copy(), penalty.diagonal().copy(), np.eye(len(penalty))
        for pivot in self._order():
            if left[pivot, pivot] <= _REPEATED * diagonal[pivot]:
                continue
            # The constraint u[pivot] = −Σ row[j] u[j] goes into all that follows u[pivot].
            row = left[pivot] / left[pivot, pivot]
            others = np.flatnonzero(row)
            followers = np.flatnonzero(sums[:, pivot])
            sums[np.ix_(followers, others)] -= np.outer(sums[followers, pivot], row[others])
            left[np.ix_(others, others)] -= np.outer(left[others, pivot], row[others])
            sums[:, pivot] = left[:, pivot] = left[pivot, :] = 0.0
        # Weights that cancel leave their rounding.
        sums[np.abs(sums) < 1e-14 * np.abs(sums).max(axis=1, initial=1.0, keepdims=True)] = 0.0
        #: Places of the degrees of freedom that are left, ascending.
        self.kept = np.flatnonzero(np.diagonal(sums))
        #: Displacements of all nodes by those (n × kept).
        self.sums = sums[:, self.kept]

    def _order(self) -> list[int]:
        """Places of constrained degrees of freedom: a node before the ones that it follows."""
        pairs, tags = list(self._pairs), []
        while pairs:
            masters = {master for _, master in pairs}
            # In a circle of ties any node will do.
            free = {tag for tag, _ in pairs if tag not in masters} or {pairs[0][0]}
            tags += sorted(free)
            pairs = [pair for pair in pairs if pair[0] not in free]
        found = [place for tag in tags for place in self._places[tag]]
        return list(dict.fromkeys([place for place in found if place in self._near] + list(self._near)))

    def terms(self, place: int) -> list[tuple[int, float]]:
        """Pairs (number of a degree of freedom that is left, weight) that move the one at ``place``."""
        row = self.sums[place]
        return [(int(own), float(row[own])) for own in np.flatnonzero(row)]

    def about(self, place: int) -> str:
        """The constraints of the degree of freedom at ``place`` and of all that are tied to it, for people."""
        seen, edge = {place}, [place]
        while edge:
            edge = [own for far in edge for own in self._near.get(far, ()) if own not in seen]
            seen.update(edge)
        nodes = {tag: [k for k in range(3) if own[k] in seen] for tag, own in self._places.items() if seen & set(own)}
        found = []
        for tag, directions in nodes.items():
            if held := [k for k in directions if k in self._fixed.get(tag, ())]:
                found.append(f"fix of node {tag} ({_listed(held)})")
        found += [self.named(pair, nodes[pair[0]]) for pair in self._pairs if pair[0] in nodes]
        found = [own for own in found if own]
        more = [f"{len(found) - _MOST} more"] if len(found) > _MOST else []
        return ", ".join(found[:_MOST] + more) or "a constraint"

    def named(self, pair: tuple[int, int], directions: Sequence[int] = (0, 1, 2)) -> str:
        """A tie for people, as far as it is one of these directions."""
        held = [k for k in self._pairs[pair] if k in directions]
        return f"{self._command(*pair, held)} of node {pair[0]} ({_listed(held)}) to node {pair[1]}" if held else ""

    def _command(self, tag: int, master: int, held: list[int]) -> str:
        """The commands that make such a tie."""
        own, other = self._places[tag], self._places[master]
        turned = [(k, j) for k in held for j in range(3) if j != k and other[j] in self._near[own[k]]]
        if not turned:
            return "equalDOF, rigidLink 'bar' or rigidDiaphragm"
        return "rigidLink 'beam' or rigidDiaphragm" if all(k < 2 and j == 2 for k, j in turned) else "equalDOF_Mixed"


def _listed(directions: list[int]) -> str:
    return ", ".join(DIRECTIONS[k] for k in dict.fromkeys(directions))
