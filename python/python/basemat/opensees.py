"""Linear structures of OpenSeesPy on basemat's grounds.

A two-dimensional model gives its matrices at its initial tangent; its base is free of supports, as the
ground holds it up.
"""

from __future__ import annotations

import warnings
from collections.abc import Sequence
from typing import Any, Literal

import numpy as np

from . import BasematWarning, BaseNode, DofCombination, InputError, MatrixModel
from ._opensees_linear import Elements
from ._opensees_ties import DIRECTIONS, Ties


class OpenSeesModel:
    """A structure from OpenSees with the names of its nodes; what :func:`structure` returns.

    It is a structure like any other, for a ground, a simulation or a reduction. Its degrees of freedom
    are called "4 x", "4 y" and "4 rotation" by the node's tag, in frames and in errors, too. A degree of
    freedom that a tie or a fix of OpenSees takes away is none of them; :meth:`row` knows it all the same.
    """

    def __init__(self, model: MatrixModel, places: dict[int, list[int]], ties: Ties) -> None:
        self._places, self._ties = places, ties
        self.dofs, self.dof = model.dofs, model.dof
        self.dof_names = model.dof_names
        self.base = model.base
        self.mass = model.mass
        self.stiffness = model.stiffness
        self.damping = model.damping

    def __repr__(self) -> str:
        return f"OpenSeesModel({len(self._places)} nodes, {self.dofs} degrees of freedom)"

    def row(self, node: int, direction: Literal["x", "y", "rotation"] = "x") -> DofCombination:
        """The :class:`DofCombination` of a ``node`` (its tag) in a ``direction``, "x" by default.

        For probes and loads. The row of a tied node is the sum of the degrees of freedom that it follows.
        """
        return _row(self._places, self._ties, node, direction)

    @property
    def nodes(self) -> list[int]:
        """Tags of the nodes."""
        return list(self._places)


def structure(
    ops: Any,
    base_nodes: Sequence[int],
    *,
    width: float | None = None,
    tangent: Literal["initial", "present"] = "initial",
) -> OpenSeesModel:
    """The linear structure that the current model of OpenSees is: its stiffness is the initial tangent.

    Args:
        ops: the module ``openseespy.opensees``, with a model of ``-ndm 2 -ndf 3``. Its elements give
            stiffness, mass and damping per metre of thickness in SI units. Every ``fix``, ``equalDOF``,
            ``rigidLink`` and other constraint holds exactly, whatever constraint handler and numberer
            are set; ties in chains, too, with a :class:`BasematWarning`, as not every handler of OpenSees
            holds them. The analysis that is set up there is wiped; recorders
            write the present state twice more.
        base_nodes: tags of the nodes on the ground at one height, free of supports, two or more; or
            a single one with a ``width``. They may be tied.
        width: length of a rigid base that a single node is the middle of, m; None for several.
        tangent: "initial" takes the stiffness of the elements before any load: yield, gaps, P-Delta and
            other large displacements do not happen in a run. "present" takes the stiffness at the state
            that analyses have left, such as the P-Delta of a gravity analysis.

    Returns:
        The structure at rest, without the loads of OpenSees and without its ``modalDamping``; a
        displacement that a load pattern prescribes (``sp``) is held at zero.

    Elements that are not linear, or are not known to be, give a :class:`BasematWarning` with their tags
    and types. Elements without a tangent at rest are an error: contact, gaps, springs that only push,
    dashpots of a power of the velocity.

    To compare with a ``UniformExcitation`` in OpenSees, give masses to nodes, or to elements other
    than ``elasticBeamColumn``: OpenSees 3.7.1 doubles the excitation of that element's ``-mass``.
    """
    if tangent not in ("initial", "present"):
        raise InputError(f"tangent is '{tangent}', but must be 'initial' or 'present'")
    _check(ops)
    (penalty,), places = _assembled(ops, 1.0, np.zeros((1, 4)))
    (mass, damping, present, initial), _ = _assembled(ops, 0.0, np.eye(4))
    ops.wipeAnalysis()
    elements = Elements(ops)
    if (none := elements.without_tangent()) and tangent == "initial":
        raise InputError(
            f"{_named(none)} without a tangent at rest, which a linear structure needs: leave them out, or "
            "replace them by linear ones"
        )
    if not initial.any():
        raise InputError("the elements of the model of OpenSees have no stiffness")
    change = np.abs(present - initial).max() / np.abs(initial).max()
    if tangent == "initial" and change > 1e-6:
        raise InputError(
            f"analyses have changed the stiffness of the model of OpenSees, by {change:.2g} of its largest entry: "
            "call ops.reset() before for the initial tangent, or give tangent='present'"
        )
    if found := elements.not_linear():
        warnings.warn(
            f"the model of OpenSees is not linear: {_named(found)}. Their {tangent} tangent is taken, and stays in "
            "the run",
            BasematWarning,
            stacklevel=2,
        )
    ties = Ties(ops, places, penalty)
    if ties.chains:
        chains = ", ".join(ties.named(pair) for pair in ties.chains)
        warnings.warn(
            f"ties to nodes that follow others: {chains}. They hold here, but not in OpenSees by its constraint handler "
            "Transformation: tie these nodes to the last of the chain",
            BasematWarning,
            stacklevel=2,
        )
    stiffness = initial if tangent == "initial" else present
    base = _base(ops, places, ties, base_nodes, width)
    _moves(ops, places, ties, np.abs(stiffness).max(axis=1) + np.abs(mass).max(axis=1) > 0.0)
    names = {place: f"{tag} {name}" for tag, own in places.items() for place, name in zip(own, DIRECTIONS)}
    options: dict[str, Any] = {"dof_names": [names[int(place)] for place in ties.kept]}
    kept = [ties.sums.T @ _symmetric(own, names) @ ties.sums for own in (mass, stiffness, damping)]
    if np.abs(damping).max() > 1e-12 * np.abs(stiffness).max():
        options["damping"] = _clean(kept[2])
    return OpenSeesModel(MatrixModel(_clean(kept[0]), _clean(kept[1]), base, **options), places, ties)


def _check(ops: Any) -> None:
    """Refuses a model that is none of the plane, or has no elements."""
    for tag in ops.getNodeTags():
        found = len(ops.nodeCoord(tag)), len(ops.nodeDisp(tag))
        if found != (2, 3):
            counts = "{} coordinates and {} degrees of freedom".format(*found)
            raise InputError(
                f"node {tag} has {counts}, but must have 2 and 3: -ndm 2 -ndf 3. Any other linear model is a "
                "MatrixModel by its matrices (integrator GimmeMCK, then printA), with a base of BaseNode, in "
                "three dimensions of BaseFaces"
            )
    if not ops.getEleTags():
        raise InputError("the model of OpenSees has no elements")


def _assembled(ops: Any, penalty: float, factors: Any) -> tuple[list[Any], dict[int, list[int]]]:
    """Sums of mass, damping, present and initial stiffness by ``factors``, and each node's numbers in them.

    Nothing is solved: a free structure has no static solution. The penalty method keeps all degrees of
    freedom, in the order of the nodes' directions, and adds ``penalty`` GᵀG for constraints G u = 0.
    """
    ops.wipeAnalysis()
    ops.constraints("Penalty", penalty, penalty)
    ops.numberer("Plain")
    ops.system("FullGeneral")
    ops.algorithm("Linear")
    ops.integrator("GimmeMCK", 0.0, 0.0, 0.0, 0.0)
    ops.analysis("Transient")
    ops.initialize()
    order = ops.systemSize()
    found = []
    for own in factors:
        ops.integrator("GimmeMCK", *own.tolist())
        found.append(np.array(ops.printA("-ret")).reshape(order, order))
    return found, {int(tag): [int(own) for own in ops.nodeDOFs(tag)] for tag in ops.getNodeTags()}


def _base(
    ops: Any, places: dict[int, list[int]], ties: Ties, base_nodes: Sequence[int], width: float | None
) -> list[BaseNode]:
    """Nodes of the base."""
    at = {tag: ops.nodeCoord(tag) for tag in base_nodes if tag in places}
    x = {tag: float(own[0]) for tag, own in at.items()}
    rows = {}
    for tag in base_nodes:
        for name in DIRECTIONS if width is not None else DIRECTIONS[:2]:
            rows[tag, name] = _row(places, ties, tag, name, ": it must be free, as the ground holds the structure up")
    heights = sorted({float(own[1]) for own in at.values()})
    if len(heights) > 1:
        raise InputError(f"base nodes are at heights of {heights[0]} to {heights[-1]} m, but must be at one")
    if len(x) < 2 and width is None or len(x) != 1 and width is not None:
        raise InputError(f"{len(x)} base nodes: give several, or a single one with a width")
    if width is None:
        return [BaseNode(x[tag], rows[tag, "x"], rows[tag, "y"]) for tag in sorted(x, key=lambda tag: x[tag])]
    [tag] = x
    ends = (-0.5 * width, 0.5 * width)
    return [
        BaseNode(x[tag] + own, rows[tag, "x"], rows[tag, "y"] + rows[tag, "rotation"] * own) for own in ends
    ]


def _moves(ops: Any, places: dict[int, list[int]], ties: Ties, used: Any) -> None:
    """Refuses constraints that stop a translation of the structure, and warns of those that stop its rotation."""
    at = {tag: ops.nodeCoord(tag) for tag in places}
    size = np.ptp(list(at.values()), axis=0).max()
    for name in DIRECTIONS:
        moved = np.zeros(len(ties.sums))
        for tag, own in places.items():
            x, y = at[tag]
            moved[own] = {"x": (1.0, 0.0, 0.0), "y": (0.0, 1.0, 0.0)}.get(name, (-y, x, 1.0))
        missed = used & (np.abs(ties.sums @ moved[ties.kept] - moved) > 1e-6 * max(size, 1.0))
        for tag, own in places.items():
            for place, direction in zip(own, DIRECTIONS):
                if not missed[place]:
                    continue
                by = f"node {tag} ({direction}) does not follow, by {ties.about(place)}"
                if name != "rotation":
                    raise InputError(f"the structure must translate freely in {name}, as the ground holds it up: {by}")
                text = f"the structure does not rotate freely, as if something beside the ground held it: {by}"
                warnings.warn(text, BasematWarning, stacklevel=3)
                return


def _row(places: dict[int, list[int]], ties: Ties, node: int, direction: str, need: str = "") -> DofCombination:
    """The row of a node's displacement; ``need`` ends the message where constraints hold it at zero."""
    if node not in places:
        raise InputError(f"there is no node {node} in the model of OpenSees")
    if direction not in DIRECTIONS:
        raise InputError(f"there is no direction '{direction}', only {', '.join(DIRECTIONS)}")
    place = places[node][DIRECTIONS.index(direction)]
    terms = ties.terms(place)
    if not terms:
        raise InputError(f"node {node} is held in the direction {direction}{need} (it is held by {ties.about(place)})")
    return DofCombination(terms)


def _named(found: dict[str, list[int]], most: int = 20) -> str:
    """Elements by type, with their tags."""
    parts = []
    for reason, tags in found.items():
        more = f" and {len(tags) - most} more" if len(tags) > most else ""
        parts.append(f"element{'s' * (len(tags) > 1)} {', '.join(map(str, tags[:most]))}{more} ({reason})")
    return ", ".join(parts)


def _symmetric(matrix: Any, names: dict[int, str]) -> Any:
    """The matrix, which must be symmetric but for rounding."""
    odd = np.abs(matrix - matrix.T)
    row, column = np.unravel_index(odd.argmax(), odd.shape)
    if odd[row, column] > 1e-9 * np.abs(matrix).max(initial=0.0):
        pair = f"'{names[int(row)]}' and '{names[int(column)]}'"
        raise InputError(f"a matrix of the model of OpenSees is not symmetric between {pair}: a linear structure must be")
    return matrix


def _clean(matrix: Any) -> Any:
    """Symmetric, without what rounding left of zeros."""
    matrix = 0.5 * (matrix + matrix.T)
    matrix[np.abs(matrix) < 1e-14 * np.abs(matrix).max()] = 0.0
    return matrix
