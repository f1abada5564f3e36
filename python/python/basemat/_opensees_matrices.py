"""Matrices of an OpenSees model, free of its constraints: dense, or window by window without a dense whole."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import Any, NamedTuple

import numpy as np

from ._opensees_ties import fixes, tied

#: Degrees of freedom up to which matrices are dense.
DENSE = 2400

#: Most degrees of freedom of a window, and of a node.
WINDOW, _DIRECTIONS = 1200, 6


class Matrices(NamedTuple):
    """Matrices of all degrees of freedom (n × n), and each node's numbers in them."""

    mass: Any
    damping: Any
    #: Stiffness at the present state.
    present: Any
    #: Stiffness at the initial tangent.
    initial: Any
    #: Σ GᵀG of the rows G of all constraints, G u = 0.
    penalty: Any
    places: dict[int, list[int]]


def matrices(ops: Any) -> Matrices:
    """Matrices of the current model; of ``scipy.sparse`` for a large one where SciPy is installed."""
    counts = {int(tag): len(ops.nodeDisp(tag)) for tag in ops.getNodeTags()}
    if sum(counts.values()) > DENSE:
        try:
            import scipy.sparse  # noqa: F401
        except ImportError:
            pass
        else:
            return _windows(ops, counts)
    (penalty,) = _assembled(ops, ("Penalty", 1.0, 1.0), np.zeros((1, 4)))
    mass, damping, present, initial = _assembled(ops, ("Penalty", 0.0, 0.0), np.eye(4))
    places = {tag: [int(number) for number in ops.nodeDOFs(tag)] for tag in counts}
    ops.wipeAnalysis()
    return Matrices(mass, damping, present, initial, penalty, places)


def largest_entries(matrix: Any) -> Any:
    """Largest entry of each row, without its sign."""
    found = abs(matrix).max(axis=1)
    return found if isinstance(found, np.ndarray) else found.toarray().ravel()


def _assembled(ops: Any, handler: tuple[Any, ...], factors: Any, system: str = "FullGeneral") -> list[Any]:
    """Sums of mass, damping, present and initial stiffness by ``factors``, under a constraint handler; of the system
    "Diagonal" their diagonals.

    Nothing is solved: a free structure has no static solution. The penalty method keeps all degrees of
    freedom, in the order of the nodes' directions, and adds its factor times GᵀG for constraints G u = 0.
    """
    ops.wipeAnalysis()
    ops.constraints(*handler)
    ops.numberer("Plain")
    ops.system(system)
    ops.algorithm("Linear")
    ops.integrator("GimmeMCK", 0.0, 0.0, 0.0, 0.0)
    ops.analysis("Transient")
    ops.initialize()
    order = ops.systemSize()
    found = []
    for row in factors:
        ops.integrator("GimmeMCK", *row.tolist())
        made = np.array(ops.printA("-ret"))
        found.append(made.reshape(order, order) if system == "FullGeneral" else made)
    return found


def _windows(ops: Any, counts: dict[int, int]) -> Matrices:
    """Sparse matrices from dense ones of two groups of nodes at a time, while all other nodes are fixed.

    The handler "Auto" leaves fixed degrees of freedom out of the system, and adds a penalty of the ties. Entries
    between a fixed degree of freedom and others are zero here: no structure needs them.
    """
    from scipy import sparse

    tags = list(counts)
    ends = np.cumsum([0, *counts.values()])
    places = {tag: list(range(int(ends[k]), int(ends[k + 1]))) for k, tag in enumerate(tags)}
    order = int(ends[-1])
    held = fixes(ops)
    groups, pairs = _groups(ops, tags)
    in_ties = {tag for pair in tied(ops) for tag in pair}
    parts: list[list[Any]] = [[] for _ in range(5)]
    closed = _Fixes(ops, counts, held)
    done: set[int] = set()
    try:
        for pair in pairs:
            pair_tags = [tag for group in pair for tag in groups[group]]
            if all(len(held.get(tag, ())) == counts[tag] for tag in pair_tags):
                continue
            closed.but(pair_tags)
            found = _assembled(ops, ("Auto", "-userPenalty", 0.0), np.eye(4))
            if in_ties.intersection(pair_tags):
                found += _assembled(ops, ("Auto", "-userPenalty", 1.0), np.zeros((1, 4)))
            numbers = [
                (place, group, int(number))
                for group in pair
                for tag in groups[group]
                for place, number in zip(places[tag], ops.nodeDOFs(tag))
                if number >= 0
            ]
            at, of, rows = np.array(numbers, dtype=int).reshape(-1, 3).T
            # A group's own entries come with the first pair of it.
            new = (of[:, None] != of) | ~np.isin(of, list(done))[:, None]
            for part, matrix in zip(parts, found):
                block = np.where(new, matrix[np.ix_(rows, rows)], 0.0)
                row, column = np.nonzero(block)
                part.append((block[row, column], at[row], at[column]))
            done.update(pair)
    finally:
        ops.wipeAnalysis()
        closed.but(tags)
    diagonals = _assembled(ops, ("Penalty", 0.0, 0.0), np.eye(4), "Diagonal")
    fixed = [(places[tag][k], int(ops.nodeDOFs(tag)[k])) for tag, directions in held.items() for k in directions]
    ops.wipeAnalysis()
    at, rows = np.array(fixed, dtype=int).reshape(-1, 2).T
    for part, diagonal in zip(parts, [*diagonals, np.ones(order)]):
        part.append((diagonal[rows], at, at))
    made = []
    for part in parts:
        values, row, column = (np.concatenate(column_values) for column_values in zip(*part))
        made.append(sparse.csr_matrix((values, (row, column)), shape=(order, order)))
    mass, damping, present, initial, penalty = made
    return Matrices(mass, damping, present, initial, penalty, places)


class _Fixes:
    """Temporary supports in addition to those of a model."""

    def __init__(self, ops: Any, counts: dict[int, int], held: dict[int, set[int]]) -> None:
        self._ops, self._counts = ops, counts
        self._free = {tag: [k for k in range(count) if k not in held.get(tag, ())] for tag, count in counts.items()}
        self._fixed: set[int] = set()

    def but(self, tags: Sequence[int]) -> None:
        """Fixes all nodes but these."""
        free = set(tags)
        for tag in self._fixed & free:
            for k in self._free[tag]:
                self._ops.remove("sp", tag, k + 1)
            self._fixed.remove(tag)
        for tag, directions in self._free.items():
            if directions and tag not in free and tag not in self._fixed:
                self._fixed.add(tag)
                self._ops.fix(tag, *(int(k in directions) for k in range(self._counts[tag])))


def _groups(ops: Any, tags: list[int]) -> tuple[list[list[int]], list[tuple[int, ...]]]:
    """Groups of neighbouring nodes, half a window each, and the pairs of groups that elements or ties connect."""
    from scipy import sparse
    from scipy.sparse.csgraph import reverse_cuthill_mckee

    index = {tag: k for k, tag in enumerate(tags)}
    edges = {(index[one], index[other]) for one, other in _neighbours(ops)}
    row, column = (np.array(numbers, dtype=int) for numbers in zip(*edges))
    graph = sparse.csr_matrix((np.ones(len(row)), (row, column)), shape=(len(tags),) * 2)
    order = reverse_cuthill_mckee((graph + graph.T).tocsr(), symmetric_mode=True)
    size = max(WINDOW // (2 * _DIRECTIONS), 1)
    group = np.empty(len(tags), dtype=int)
    group[order] = np.arange(len(tags)) // size
    groups = [[tags[int(k)] for k in order[start : start + size]] for start in range(0, len(tags), size)]
    pairs: set[tuple[int, ...]] = {
        (min(one, other), max(one, other)) for one, other in zip(group[row].tolist(), group[column].tolist()) if one != other
    }
    met = {group for pair in pairs for group in pair}
    return groups, sorted(pairs | {(group,) for group in range(len(groups)) if group not in met})


def _neighbours(ops: Any) -> Iterator[tuple[int, int]]:
    """Pairs of nodes of one element or one tie."""
    for element in ops.getEleTags():
        nodes = [int(tag) for tag in ops.eleNodes(element)]
        yield from ((one, other) for one in nodes for other in nodes if one <= other)
    yield from tied(ops)
