"""Elements of OpenSees that yield in a run of basemat: trials that OpenSees does not commit."""

from __future__ import annotations

import copy
import os
from typing import TYPE_CHECKING, Any, Literal

import numpy as np

from . import BaseFaces, BaseNode, DeformedShape, DofCombination, Error, InputError
from ._opensees_linear import Elements

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from .opensees import OpenSeesModel

_LONG_STEP = 1e10
"""Time step (s) over whose square masses vanish beside stiffnesses."""
_TRIAL_ELEMENTS = {
    "CorotTruss", "DispBeamColumn2d", "DispBeamColumn3d", "ElasticBeam2d", "ElasticBeam3d", "ShellMITC4", "Truss",
    "ZeroLength",
}  # fmt: skip
"""Elements that follow from the displacements of their nodes, as the tests of the package show."""
_INCREMENTAL = {"CorotCrdTransf3d"}
"""Transformations that turn by increments of the nodes, which a refused step does not have."""
_MAX_DOFS = 2400
"""Degrees of freedom of the whole model in OpenSees, whose tangent is dense."""
_COMMIT_TOLERANCE = 1e-8
"""Change of the forces by a commit, over the largest, beyond which an element does not follow from its displacements."""


class NonlinearModel:
    """A model of OpenSees with the forces of its elements; what `nonlinear_structure` returns.

    It is a nonlinear structure for one `basemat.Simulation`, as OpenSees has one model in a process: no checkpoints, no
    interaction, no threads of a sweep. Degrees of freedom have the names of `OpenSeesModel`.
    """

    _state_outside = "the model of OpenSees, which basemat.opensees.nonlinear_structure takes"
    """What a report's program needs, as it is in another program."""

    def __init__(self, ops: Any, model: OpenSeesModel) -> None:
        _check(ops, Elements(ops))
        self._ops, self._model = ops, model
        self.dofs, self.dof_names, self.dof = model.dofs, model.dof_names, model.dof
        # Half of it: a difference of nearly equal forces would be rounding.
        self._linear: NDArray[np.float64] = 0.5 * np.asarray(model.stiffness())
        # Every failed step prints a message.
        ops.logFile(os.devnull, "-noEcho")
        ops.wipeAnalysis()
        # All degrees of freedom without constraints, which `_sums` has.
        ops.constraints("Penalty", 0.0, 0.0)
        ops.numberer("Plain")
        ops.system("FullGeneral")
        ops.algorithm("ExpressNewton", 0)
        ops.integrator("Newmark", 0.5, 0.25)
        ops.analysis("Transient")
        ops.analyze(1, _LONG_STEP)
        self._time = ops.getTime()
        self._trial_displacement: NDArray[np.float64] | None = None
        self._places: dict[int, tuple[int, int]] = {}
        self._sums = np.zeros((ops.systemSize(), self.dofs))
        directions = ("x", "y", "z", "rx", "ry", "rz") if len(ops.nodeCoord(model.nodes[0])) == 3 else ("x", "y", "rotation")
        for tag in model.nodes:
            for number, name in zip(ops.nodeDOFs(tag), directions):
                self._places[number] = tag, directions.index(name) + 1
                try:
                    self._sums[number] = model.row(tag, name).weights(self.dofs)  # type: ignore[arg-type]
                except InputError:
                    # Held at zero by a fix.
                    continue

    def __deepcopy__(self, memo: Any) -> NonlinearModel:
        # Internal variables are in OpenSees: a simulation's copy differs in the time of its last commit alone.
        return copy.copy(self)

    def __repr__(self) -> str:
        return f"NonlinearModel({len(self._model.nodes)} nodes, {self.dofs} degrees of freedom)"

    def row(self, node: int, direction: Literal["x", "y", "z", "rx", "ry", "rz", "rotation"] = "x") -> DofCombination:
        """The `DofCombination` of a ``node`` (its tag) in a ``direction`` of OpenSees, "x" by default, for probes and loads."""
        return self._model.row(node, direction)

    def deformed_shape(self) -> DeformedShape:
        """Nodes and elements as a `DeformedShape`, for pictures and for ParaView."""
        return self._model.deformed_shape()

    @property
    def nodes(self) -> list[int]:
        """Tags of the nodes."""
        return self._model.nodes

    def base(self) -> list[list[BaseNode]] | BaseFaces:
        """The base on the ground."""
        return self._model.base()

    def mass(self) -> Any:
        """Mass matrix, n × n."""
        return self._model.mass()

    def damping(self) -> Any:
        """Damping matrix, n × n, constant: that of Rayleigh damping is by the initial stiffness."""
        return self._model.damping()

    def stiffness(self) -> NDArray[np.float64]:
        """Linear part of the stiffness, n × n: half of the initial one."""
        return self._linear

    def force(self, u: NDArray[np.float64]) -> NDArray[np.float64]:
        """Forces of the elements at the displacements ``u`` beyond those of `stiffness`: array of shape (n,), N and N·m."""
        return self._trial(u) - self._linear @ u

    def tangent(self, u: NDArray[np.float64]) -> NDArray[np.float64]:
        """Derivative of `force` by ``u``, n × n."""
        self._trial(u)
        tangent = np.array(self._ops.printA("-ret")).reshape(len(self._sums), -1)
        # Forces of elements with P-Delta have tangents that rounding leaves unsymmetric.
        return np.asarray(self._sums.T @ tangent @ self._sums - self._linear, dtype=np.float64)

    def commit(self, u: NDArray[np.float64]) -> None:
        """Stores the state of all elements at the displacements ``u``, the end of a step."""
        before = self._trial(u)
        self._ops.analyze(1, _LONG_STEP)
        self._time, self._trial_displacement = self._ops.getTime(), None
        if abs(self._trial(u) - before).max() > _COMMIT_TOLERANCE * abs(before).max():
            raise Error("an element of OpenSees has another force after its commit than at the trial")

    def _trial(self, u: NDArray[np.float64]) -> NDArray[np.float64]:
        """Forces of all elements at the displacements ``u``, from the last commit."""
        ops = self._ops
        if ops.getTime() != self._time:
            raise Error("another simulation or analysis has moved the model of OpenSees: build it again")
        if self._trial_displacement is None or not np.array_equal(u, self._trial_displacement):
            for number, moved in enumerate((self._sums @ u).tolist()):
                ops.setNodeDisp(*self._places[number], moved, "-commit")
            # A step of no length fails, but first reverts the elements to their commit and updates them at their nodes.
            if ops.analyze(1, 0.0) >= 0:
                raise Error("this version of OpenSees makes steps of length zero, which commit: 3.7.1 does not")
            self._trial_displacement = u.copy()
        forces: NDArray[np.float64] = -np.array(ops.printB("-ret")) @ self._sums
        return forces


def _check(ops: Any, elements: Elements) -> None:
    """Errors for models whose elements do not follow from the displacements of their nodes."""
    others: dict[str, list[int]] = {}
    for tag in ops.getEleTags():
        kind = str(ops.eleType(tag))
        if kind not in _TRIAL_ELEMENTS:
            others.setdefault(kind, []).append(int(tag))
        for transformation in elements.transformations(tag):
            if transformation in _INCREMENTAL:
                others.setdefault(f"{kind}, {transformation}", []).append(int(tag))
    if others:
        named = "; ".join(f"{kind}: {', '.join(map(str, tags[:10]))}{' …' * (len(tags) > 10)}" for kind, tags in others.items())
        raise InputError(
            f"elements of OpenSees that cannot be tried before a commit, or were not tested: {named}. Take more "
            "dispBeamColumn in place of forceBeamColumn, PDelta in place of Corotational in space"
        )
    size = sum(len(ops.nodeDisp(tag)) for tag in ops.getNodeTags())
    if size > _MAX_DOFS:
        raise InputError(f"the model of OpenSees has {size} degrees of freedom, but must have {_MAX_DOFS} at most to yield")
