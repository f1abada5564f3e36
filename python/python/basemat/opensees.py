"""Linear structures of OpenSeesPy on basemat's grounds.

A two-dimensional model gives its matrices; its base is free of supports, as the ground holds it up.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any, Literal

import numpy as np

from . import ContactNode, DofCombination, InputError, MatrixModel

_DIRECTIONS = ("x", "y", "rotation")


class OpenSeesModel:
    """A structure from OpenSees with the names of its nodes; what :func:`structure` returns.

    It is a structure like any other, for a ground, a simulation or a reduction. Its degrees of freedom
    are called "4 x", "4 y" and "4 rotation" by the node's tag, in frames and in errors, too.
    """

    def __init__(self, model: MatrixModel, numbers: dict[int, list[int]]) -> None:
        self._numbers = numbers
        self.dofs, self.dof = model.dofs, model.dof
        self.dof_names = model.dof_names
        self.contact_nodes = model.contact_nodes
        self.mass = model.mass
        self.stiffness = model.stiffness
        self.damping = model.damping

    def __repr__(self) -> str:
        return f"OpenSeesModel({len(self._numbers)} nodes, {self.dofs} degrees of freedom)"

    def row(self, node: int, direction: Literal["x", "y", "rotation"] = "x") -> DofCombination:
        """The :class:`DofCombination` of a ``node`` (its tag) in a ``direction``, "x" by default.

        For probes and loads, whatever numbers OpenSees gives its equations.
        """
        return DofCombination(_number(self._numbers, node, direction))

    @property
    def nodes(self) -> list[int]:
        """Tags of the nodes."""
        return list(self._numbers)


def structure(ops: Any, base_nodes: Sequence[int], *, width: float | None = None) -> OpenSeesModel:
    """The linear structure that the current model of OpenSees is.

    Args:
        ops: the module ``openseespy.opensees``, with a model of ``-ndm 2 -ndf 3``. Its elements give
            stiffness, mass and damping per metre of thickness in SI units; fixed nodes stay fixed.
            The analysis that is set up there is wiped.
        base_nodes: tags of the nodes on the ground at one height, free of supports, two or more; or
            a single one with a ``width``.
        width: length of a rigid base that a single node is the middle of, m; None for several.

    Returns:
        The structure at rest, without the loads of OpenSees.

    To compare with a ``UniformExcitation`` in OpenSees, give masses to nodes, or to elements other
    than ``elasticBeamColumn``: OpenSees 3.7.1 doubles the excitation of that element's ``-mass``.
    """
    for tag in ops.getNodeTags():
        found = len(ops.nodeCoord(tag)), len(ops.nodeDisp(tag))
        if found != (2, 3):
            counts = "{} coordinates and {} degrees of freedom".format(*found)
            raise InputError(f"node {tag} has {counts}, but must have 2 and 3: -ndm 2 -ndf 3")
    if not ops.getEleTags():
        raise InputError("the model of OpenSees has no elements")
    stiffness = _matrix(ops, 0.0, 0.0, 1.0)
    # With a little stiffness, so that nothing without mass is singular there; a power of two rounds
    # nothing.
    scale = 0.5 ** round(math.log2(np.abs(stiffness).max()))
    one = _matrix(ops, 1.0, 0.0, scale)
    mass = one - scale * stiffness
    damping = _matrix(ops, 1.0, 1.0, scale) - one
    # The last analysis knows them.
    numbers = {tag: [int(own) for own in ops.nodeDOFs(tag)] for tag in ops.getNodeTags()}
    ops.wipeAnalysis()
    at = {tag: ops.nodeCoord(tag) for tag in base_nodes if tag in numbers}
    x = {tag: float(own[0]) for tag, own in at.items()}
    dofs = {tag: [_number(numbers, tag, name) for name in _DIRECTIONS] for tag in base_nodes}
    heights = sorted({float(own[1]) for own in at.values()})
    if len(heights) > 1:
        raise InputError(f"base nodes are at heights of {heights[0]} to {heights[-1]} m, but must be at one")
    if len(dofs) < 2 and width is None or len(dofs) != 1 and width is not None:
        raise InputError(f"{len(dofs)} base nodes: give several, or a single one with a width")
    if width is not None:
        [node] = dofs
        half = 0.5 * width
        contact = ContactNode.rigid_base(x[node] - half, x[node] + half, dofs[node])
    else:
        tags = sorted(base_nodes, key=lambda tag: x[tag])
        contact = [ContactNode(x[tag], dofs[tag][0], dofs[tag][1]) for tag in tags]
    options: dict[str, Any] = {"damping": _clean(damping)} if np.abs(damping).max() > 1e-12 * np.abs(one).max() else {}
    names = {own: f"{tag} {name}" for tag in reversed(numbers) for own, name in zip(numbers[tag], _DIRECTIONS)}
    options["dof_names"] = [names.get(own, f"equation {own}") for own in range(len(mass))]
    return OpenSeesModel(MatrixModel(_clean(mass), _clean(stiffness), contact, **options), numbers)


def _matrix(ops: Any, mass: float, damping: float, stiffness: float) -> Any:
    """The sum of the three matrices with these factors."""
    ops.wipeAnalysis()
    ops.constraints("Transformation")
    ops.numberer("Plain")
    ops.system("FullGeneral")
    ops.algorithm("Linear")
    ops.integrator("GimmeMCK", mass, damping, stiffness)
    ops.analysis("Transient")
    ops.analyze(1, 0.0)
    order = ops.systemSize()
    return np.array(ops.printA("-ret")).reshape(order, order)


def _clean(matrix: Any) -> Any:
    """Symmetric, without what rounding left of zeros."""
    matrix = 0.5 * (matrix + matrix.T)
    matrix[np.abs(matrix) < 1e-14 * np.abs(matrix).max()] = 0.0
    return matrix


def _number(numbers: dict[int, list[int]], node: int, direction: str) -> int:
    """Number of a node's degree of freedom."""
    if node not in numbers:
        raise InputError(f"there is no node {node} in the model of OpenSees")
    if direction not in _DIRECTIONS:
        raise InputError(f"there is no direction '{direction}', only {', '.join(_DIRECTIONS)}")
    found = numbers[node][_DIRECTIONS.index(direction)]
    if found < 0:
        raise InputError(
            f"node {node} is held in the direction {direction}: it must be free, as the ground holds the "
            f"structure up (leave its fix out)"
        )
    return found
