"""Ties and supports of an OpenSees model: which degrees of freedom follow others."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import Any

import numpy as np

#: Part of a diagonal entry below which a constraint only repeats the ones before it.
_REPEATED = 1e-13

#: Directions that a rigid diaphragm ties, by the axis across its plane.
_DIAPHRAGM = {0: [1, 2, 3], 1: [0, 2, 4], 2: [0, 1, 5]}

#: Constraints that a message names.
_MOST = 8


def fixes(ops: Any) -> dict[int, set[int]]:
    """Numbers of the directions that supports restrain, by the tag of the node."""
    return {int(tag): {int(direction) - 1 for direction in ops.getFixedDOFs(tag)} for tag in ops.getFixedNodes()}


def tied(ops: Any) -> Iterator[tuple[int, int]]:
    """Pairs of a node that follows and the node that it follows, by their tags."""
    for tag in ops.getConstrainedNodes():
        for master in ops.getRetainedNodes(tag):
            yield int(tag), int(master)


class Ties:
    """Displacements of all nodes as weighted sums of the degrees of freedom that are left.

    Args:
        ops: the module ``openseespy.opensees``.
        places: numbers of the degrees of freedom of each node (its tag), in rows of ``penalty``.
        directions: names of a node's degrees of freedom, translations first; a node may have the first ones only.
        penalty: Σ GᵀG (n × n, dense or sparse) of the rows G of all constraints, G u = 0. It comes from OpenSees
            itself, whichever command made the constraints.
    """

    def __init__(self, ops: Any, places: dict[int, list[int]], directions: tuple[str, ...], penalty: Any) -> None:
        self._places, self.directions = places, directions
        self._near = {int(place): _nonzero(penalty, int(place)) for place in np.flatnonzero(penalty.diagonal())}
        self._fixed = fixes(ops)
        #: Tied directions of a node that follows, by the pair of nodes; ``retained``: of the other node.
        self._pairs = {pair: [int(direction) - 1 for direction in ops.getConstrainedDOFs(*pair)] for pair in tied(ops)}
        retained = {pair: [int(direction) - 1 for direction in ops.getRetainedDOFs(*pair[::-1])] for pair in self._pairs}
        self._has_arms = {pair: self._turns(pair, held, penalty) for pair, held in self._pairs.items()}
        # Sparse matrices leave out what a fixed degree of freedom is tied to.
        for (tag, master), held in self._pairs.items():
            for k, j in zip(held, retained[tag, master]):
                ends = places[tag][k], places[master][j]
                for one, other in (ends, ends[::-1]):
                    if other not in self._near.setdefault(one, [one]):
                        self._near[one] = sorted([*self._near[one], other])
        followed: dict[int, set[int]] = {}
        for (tag, _), held in self._pairs.items():
            followed.setdefault(tag, set()).update(held)
        #: Ties in a chain: a node that follows a second one, which follows a third.
        self.chains = [
            pair for pair, directions in retained.items() if followed.get(pair[1], set()).intersection(directions)
        ]
        #: Displacements of constrained places as (places, weights) of such as are left.
        self._followed: dict[int, tuple[Any, Any]] = {}
        for part in self._parts():
            self._eliminate(part, penalty)
        order = penalty.shape[0]
        #: Places of the degrees of freedom that are left, ascending.
        self.kept = np.array([k for k in range(order) if k not in self._followed or k in self._followed[k][0]], dtype=int)
        self._number = {int(place): k for k, place in enumerate(self.kept)}
        #: Displacements of all nodes by those (n × kept), dense or sparse like ``penalty``.
        self.sums = self._summed(order, not isinstance(penalty, np.ndarray))

    def _parts(self) -> list[list[int]]:
        """Constrained places, a list for all that hang together, each in the order of their elimination."""
        part: dict[int, int] = {}
        for first in self._near:
            if first not in part:
                part.update(dict.fromkeys(self._hanging(first), first))
        found: dict[int, list[int]] = {}
        for place in self._order():
            found.setdefault(part[place], []).append(place)
        return list(found.values())

    def _eliminate(self, part: list[int], penalty: Any) -> None:
        """Expresses places that hang together by such of them as are left."""
        places = np.sort(part)
        left = penalty[np.ix_(places, places)]
        left = left if isinstance(left, np.ndarray) else left.toarray()
        diagonal, sums = left.diagonal().copy(), np.eye(len(places))
        for pivot in np.searchsorted(places, part):
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
        for place, row in zip(places.tolist(), sums):
            self._followed[place] = places[np.flatnonzero(row)], row[row != 0.0]

    def _summed(self, order: int, is_sparse: bool) -> Any:
        terms = [(place, *term) for place in range(order) for term in self.terms(place)]
        row, column, weights = np.array(terms).reshape(-1, 3).T
        if is_sparse:
            from scipy import sparse

            return sparse.csr_matrix((weights, (row.astype(int), column.astype(int))), shape=(order, len(self.kept)))
        sums = np.zeros((order, len(self.kept)))
        sums[row.astype(int), column.astype(int)] = weights
        return sums

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
        places, weights = self._followed.get(place, ((place,), (1.0,)))
        return [(self._number[int(place)], float(weight)) for place, weight in zip(places, weights)]

    def _hanging(self, place: int) -> set[int]:
        """A place and all that constraints tie to it, one by another."""
        seen, edge = {place}, {place}
        while edge:
            edge = {neighbour for far in edge for neighbour in self._near.get(far, ())} - seen
            seen |= edge
        return seen

    def _turns(self, pair: tuple[int, int], held: list[int], penalty: Any) -> bool:
        """Whether a rotation of the other node moves the one that follows in its tied translations."""
        places, other = (self._places[tag] for tag in pair)
        lines = len(self.directions) // 2 + len(self.directions) % 2
        return any(penalty[places[k], place] != 0.0 for k in held if k < lines for place in other[lines:])

    def off_plane(self, at: dict[int, tuple[float, ...]]) -> str:
        """Words for nodes beside the plane of their diaphragm; ``at``: coordinates of each node (its tag), m.

        ``rigidDiaphragm`` of OpenSees 3.7.1 writes that it ignores such a node. It makes the constraint all the same,
        with the arms of the node before it in the list.
        """
        found: dict[int, list[str]] = {}
        for (tag, master), held in self._pairs.items():
            for across, tied_directions in _DIAPHRAGM.items():
                if held != tied_directions or len(self.directions) < 6:
                    continue
                offset = abs(at[tag][across] - at[master][across])
                # An equalDOF of the same directions has no arms, nor have others to this master.
                beside = (pair for pair, directions in self._pairs.items() if pair[1] == master and directions == held)
                if offset and any(self._has_arms[pair] for pair in beside):
                    found.setdefault(master, []).append(f"node {tag} is {offset:.3g} m")
        return "; ".join(
            f"{', '.join(nodes[:_MOST])} off the plane of node {master}, to which rigidDiaphragm ties it: OpenSees writes "
            "that it ignores such a node, but ties it as if it stood at the place of the node before it in the list. Move it "
            "into the plane, or leave it out of rigidDiaphragm"
            for master, nodes in found.items()
        )

    def about(self, place: int) -> str:
        """Text about the constraints of the degree of freedom at ``place`` and of all that are tied to it."""
        seen = self._hanging(place)
        nodes = {}
        for tag, places in self._places.items():
            if seen & set(places):
                nodes[tag] = [k for k in range(len(places)) if places[k] in seen]
        found = []
        for tag, directions in nodes.items():
            if held := [k for k in directions if k in self._fixed.get(tag, ())]:
                found.append(f"fix of node {tag} ({self._listed(held)})")
        found += [self.named(pair, nodes[pair[0]]) for pair in self._pairs if pair[0] in nodes]
        found = [entry for entry in found if entry]
        more = [f"{len(found) - _MOST} more"] if len(found) > _MOST else []
        return ", ".join(found[:_MOST] + more) or "a constraint"

    def named(self, pair: tuple[int, int], directions: Sequence[int] | None = None) -> str:
        """A tie as a text, restricted to these directions; all of them unless given."""
        held = [k for k in self._pairs[pair] if directions is None or k in directions]
        return f"{self._command(*pair, held)} of node {pair[0]} ({self._listed(held)}) to node {pair[1]}" if held else ""

    def _command(self, tag: int, master: int, held: list[int]) -> str:
        """The commands that make such a tie."""
        places, other = self._places[tag], self._places[master]
        lines = len(self.directions) // 2 + len(self.directions) % 2  # translations
        turned = [(k, j) for k in held for j in range(len(other)) if j != k and other[j] in self._near[places[k]]]
        if not turned:
            return "equalDOF, rigidLink 'bar' or rigidDiaphragm"
        is_rigid = all(k < lines <= j for k, j in turned)
        return "rigidLink 'beam' or rigidDiaphragm" if is_rigid else "equalDOF_Mixed"

    def _listed(self, held: list[int]) -> str:
        return ", ".join(self.directions[k] for k in dict.fromkeys(held))


def _nonzero(matrix: Any, row: int) -> list[int]:
    """Columns of the entries of a row that are not zero, ascending."""
    if isinstance(matrix, np.ndarray):
        return [int(column) for column in np.flatnonzero(matrix[row])]
    return sorted(matrix.indices[matrix.indptr[row] : matrix.indptr[row + 1]].tolist())
