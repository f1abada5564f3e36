"""Structures of OpenSeesPy on basemat's grounds.

A model in the plane or in space gives its matrices at its initial tangent, and its beams of fibres, which yield in a run; its
base is free of supports, as the ground holds it up.
"""

from __future__ import annotations

import warnings
from collections.abc import Sequence
from typing import Any, Literal

import numpy as np

from . import BaseFaces, BasematWarning, BaseNode, DeformedShape, DofCombination, InputError, MatrixModel, WithElements
from ._opensees_base import Up, faces_of, line_of, masses, moves
from ._opensees_fibers import LAWS, FiberBeams, rows_of, without_fibers
from ._opensees_linear import Elements
from ._opensees_matrices import largest_entries, matrices
from ._opensees_nonlinear import NonlinearModel as NonlinearModel
from ._opensees_rows import Rows
from ._opensees_shape import base_nodes_of, shape_of
from ._opensees_ties import Ties

_Direction = Literal["x", "y", "z", "rx", "ry", "rz", "rotation"]


class OpenSeesModel:
    """A structure from OpenSees with the names of its nodes; what `structure` returns.

    It is a structure like any other, for a ground, a simulation or a reduction. Its degrees of freedom
    are called "4 x", "4 y" and "4 rotation" by the node's tag, in space "4 x", "4 y", "4 z", "4 rx", "4 ry" and "4 rz",
    in frames and in errors, too. A degree of freedom that a tie or a fix of OpenSees takes away has no such
    name; `row` gives the sum that a tied one follows. Matrices of more than 2400 degrees of freedom are sparse
    (``scipy.sparse``) where SciPy is installed.

    With beams of fibres that yield, ``stiffness`` is the matrix of all other elements. The model passes them to a simulation.
    """

    def __init__(
        self,
        model: MatrixModel,
        rows: Rows,
        shape: DeformedShape,
        sparse: tuple[Any, Any, Any] | None,
        fibers: tuple[WithElements, dict[int, int]] | None = None,
    ) -> None:
        self._rows, self._shape, self._model = rows, shape, model
        # A simulation takes this in place of the object.
        self.__basemat_structure__: WithElements | None = fibers[0] if fibers else None
        self._fiber_beams: dict[int, int] = fibers[1] if fibers else {}
        self.dofs, self.dof = model.dofs, model.dof
        self.dof_names = model.dof_names
        self.base = model.base
        self.mass, self.stiffness, self.damping = model.mass, model.stiffness, model.damping
        if sparse:
            self.mass, self.stiffness, self.damping = (matrix.copy for matrix in sparse)

    def __repr__(self) -> str:
        return f"OpenSeesModel({len(self.nodes)} nodes, {self.dofs} degrees of freedom)"

    def row(self, node: int, direction: _Direction = "x") -> DofCombination:
        """The `DofCombination` of a ``node`` (its tag) in a ``direction`` of OpenSees, "x" by default.

        For probes and loads. Directions are "x", "y" and "rotation"; in space "x", "y", "z" and, about these axes, "rx",
        "ry" and "rz". The row of a tied node is the sum of the degrees of freedom that it follows.
        """
        return self._rows.row(node, direction)

    def deformed_shape(self) -> DeformedShape:
        """Nodes and elements as a `DeformedShape`, for pictures and for ParaView; heights are above the base's nodes."""
        return self._shape

    @property
    def fiber_beams(self) -> dict[int, int]:
        """Numbers of the beams of fibres that yield, for `Simulation.beam_sections`, by the tags of their elements."""
        return dict(self._fiber_beams)

    @property
    def nodes(self) -> list[int]:
        """Tags of the nodes."""
        return list(self._rows.places)


def structure(
    ops: Any,
    base_nodes: Sequence[int] | None = None,
    *,
    width: float | None = None,
    outline: Sequence[Any] | None = None,
    faces: Sequence[int | Sequence[int]] | None = None,
    below: float | None = None,
    up: Up = "z",
    tangent: Literal["initial", "present"] = "initial",
    fibers: Literal["yielding", "linear"] = "yielding",
) -> OpenSeesModel:
    """The structure that the current model of OpenSees is: the initial tangent, with beams of fibres that yield.

    Args:
        ops: the module ``openseespy.opensees``, with a model of ``-ndm 2 -ndf 3`` or, in space, ``-ndm 3 -ndf 6``
            (nodes of solids may have 3). Its elements give stiffness, mass and damping in SI units, per metre of
            thickness in the plane, of the whole body in space. Every ``fix``, ``equalDOF``,
            ``rigidLink`` and other constraint holds exactly, whatever constraint handler and numberer
            are set; ties in chains, too, with a `BasematWarning`, as not every handler of OpenSees
            holds them. The analysis that is set up there is wiped; recorders
            write the present state twice more, of large models more often.
        base_nodes: tags of the nodes on the ground at one height, free of supports. In the plane two or more, or
            a single one with a ``width``. In space a single one with the ``outline`` of the rigid mat
            that it moves, or several with an outline each. They may be tied.
        width: length of a rigid base in the plane that a single node is the middle of, m; None for several.
        outline: corners of a rigid base in space, convex: list of their coordinates in plan, (x, y) of the model or, with
            ``up="y"``, (x, −z), m; for several base nodes a list of such lists. Columns on the mat hang on the
            base node by ``rigidLink("beam", …)``.
        faces: a flexible base in space: list of shell elements (their tags), or of the tags of the three
            or four nodes around a face, free of supports and at one height. A shell touches the ground with its
            underside, half its thickness below its nodes.
        below: distance of the ground's surface below the nodes of the base or of the faces, m. Unless given, zero
            under an outline, half the thickness of its section under a shell.
        up: axis of the model in space that points up, "z" or "y". The ground's and the motion's x, y and z are the
            model's x, y and z, or with "y" its x, −z and y. Weight acts downwards. In the plane y points up.
        tangent: "initial" takes the stiffness of the elements before any load: yield, gaps, P-Delta and
            other large displacements do not happen in a run, but for beams of fibres. "present" takes the stiffness
            at the state that analyses have left, such as the P-Delta of a gravity analysis; no fibres yield then.
        fibers: "yielding" takes ``dispBeamColumn`` and ``forceBeamColumn`` with their fibres, which
            yield in a run: with a Linear transformation, one Fiber section, Lobatto or Legendre integration of 2 to 5
            points, and fibres of Elastic, Steel01 (without isotropic hardening), Steel02 (without initial stress) and
            Concrete01. Others stay linear, with a `BasematWarning` that names element, material and reason. Fibres must be
            without stress. Rayleigh damping is constant, by their initial stiffness. "linear" takes the tangent of all.

    Returns:
        The structure at rest, without the loads of OpenSees and without its ``modalDamping``; a
        displacement that a load pattern prescribes (``sp``) is held at zero.

    Elements that are not linear, or are not known to be, give a `BasematWarning` with their tags
    and types. Elements without a tangent at rest are an error: contact, gaps, springs that only push,
    dashpots of a power of the velocity. Masses in total that differ by direction give a `BasematWarning`: floors
    whose mass acts along x and y only have no weight. So does a node of ``rigidDiaphragm`` off its plane, which OpenSees
    ties wrongly (and so does this) while it writes that it ignores it. OpenSees does not tell whether an ``ASDShellQ4`` or ``ASDShellT3`` is
    ``-corotational``: it counts as linear.

    Beyond 2400 degrees of freedom, SciPy makes the matrices sparse: nodes are fixed for a while to assemble window by
    window (10 000 take about a minute, 20 000 three). Without SciPy they are dense, with all n² numbers.

    To compare with a ``UniformExcitation`` in OpenSees, give masses to nodes, or to elements other
    than ``elasticBeamColumn``: OpenSees 3.7.1 doubles the excitation of that element's ``-mass``.
    """
    return _structure(ops, base_nodes, width, outline, faces, below, up, tangent, fibers, warn_of_nonlinear=True)


def _structure(
    ops: Any,
    base_nodes: Sequence[int] | None,
    width: float | None,
    outline: Sequence[Any] | None,
    faces: Sequence[int | Sequence[int]] | None,
    below: float | None,
    up: Up,
    tangent: Literal["initial", "present"],
    fibers: Literal["yielding", "linear"],
    *,
    warn_of_nonlinear: bool,
) -> OpenSeesModel:
    """The structure with masses, damping and stiffness of the model; warnings are for the caller's caller."""
    if tangent not in ("initial", "present"):
        raise InputError(f"tangent is '{tangent}', but must be 'initial' or 'present'")
    if fibers not in ("yielding", "linear"):
        raise InputError(f"fibers is '{fibers}', but must be 'yielding' or 'linear'")
    directions = _directions(ops)
    mass, damping, present, initial, penalty, places = matrices(ops)
    elements = Elements(ops)
    if (none := elements.without_tangent()) and tangent == "initial":
        raise InputError(
            f"{_named(none)} without a tangent at rest, which a linear structure needs: leave them out, or "
            "replace them by linear ones"
        )
    if not (largest := abs(initial).max()):
        raise InputError("the elements of the model of OpenSees have no stiffness")
    change = abs(present - initial).max() / largest
    if tangent == "initial" and change > 1e-6:
        if any(any(ops.nodeDisp(tag)) for tag in places):
            raise InputError(
                f"analyses have changed the stiffness of the model of OpenSees, by {change:.2g} of its largest entry: "
                "call ops.reset() before for the initial tangent, or give tangent='present'"
            )
        # At rest, the present tangent is the initial one. OpenSees 3.7.1 gives another initial stiffness of ShellDKGT
        # and ShellNLDKGT, which resists rigid rotations.
        initial = present
    with_fibers = FiberBeams(ops, elements) if fibers == "yielding" and tangent == "initial" else None
    yielding = {beam.tag for beam in with_fibers.beams} if with_fibers else set()
    rest = {kind: [tag for tag in tags if tag not in yielding] for kind, tags in elements.not_linear().items()}
    if warn_of_nonlinear and (found := {kind: tags for kind, tags in rest.items() if tags}):
        warnings.warn(
            f"the model of OpenSees is not linear: {_named(found)}. Their {tangent} tangent is taken, and stays in "
            f"the run{_refused(with_fibers.refused) if with_fibers else ''}",
            BasematWarning,
            stacklevel=3,
        )
    ties = Ties(ops, places, directions, penalty)
    if ties.chains:
        chains = ", ".join(ties.named(pair) for pair in ties.chains)
        warnings.warn(
            f"ties to nodes that follow others: {chains}. They hold here, but not in OpenSees by its constraint handler "
            "Transformation: tie these nodes to the last of the chain",
            BasematWarning,
            stacklevel=3,
        )
    stiffness = initial if tangent == "initial" else present
    linear_stiffness = stiffness
    rows = Rows({tag: tuple(ops.nodeCoord(tag)) for tag in places}, places, ties)
    base: list[BaseNode] | BaseFaces
    if directions[-1] == "rotation":
        if outline is not None or faces is not None or below is not None:
            raise InputError("an outline, faces and below are for a model in space: give base_nodes in the plane")
        base = line_of(rows, () if base_nodes is None else base_nodes, width)
    else:
        if width is not None:
            raise InputError("a width is for a model in the plane: give an outline or faces in space")
        base = faces_of(rows, elements, base_nodes, outline, faces, below, up)
    held = moves(rows, largest_entries(stiffness) + largest_entries(mass) > 0.0)
    # A node off its plane is why the structure does not rotate freely.
    if text := ties.off_plane(rows.at) or held:
        warnings.warn(text, BasematWarning, stacklevel=3)
    if uneven := masses(rows, mass, up):
        warnings.warn(uneven, BasematWarning, stacklevel=3)
    mesh, fiber_nodes, fiber_beams = with_fibers.mesh(rows.at) if with_fibers and yielding else (None, [], {})
    if mesh is not None:
        linear_stiffness = without_fibers(stiffness, mesh, fiber_nodes, places)
    names = {place: f"{tag} {name}" for tag, numbers in places.items() for place, name in zip(numbers, directions)}
    options: dict[str, Any] = {"dof_names": [names[int(place)] for place in ties.kept]}
    kept = [_clean(ties.sums.T @ _symmetric(matrix, names) @ ties.sums) for matrix in (mass, linear_stiffness, damping)]
    if abs(damping).max() > 1e-12 * abs(stiffness).max():
        options["damping"] = kept[2]
    model = MatrixModel(kept[0], kept[1], base, **options)
    shape = shape_of(ops, rows, base_nodes_of(ops, base_nodes, faces), up)
    inelastic = (WithElements(model, mesh, rows_of(rows, fiber_nodes)), fiber_beams) if mesh is not None else None
    sparse = None if isinstance(kept[0], np.ndarray) else (kept[0], kept[1], kept[2])
    return OpenSeesModel(model, rows, shape, sparse, inelastic)


def nonlinear_structure(
    ops: Any,
    base_nodes: Sequence[int] | None = None,
    *,
    width: float | None = None,
    outline: Sequence[Any] | None = None,
    faces: Sequence[int | Sequence[int]] | None = None,
    below: float | None = None,
    up: Up = "z",
) -> NonlinearModel:
    """The structure that the current model of OpenSees is, with elements that yield in a run.

    Beams of fibres whose laws basemat has yield in `structure`, too, without OpenSees in the run. Forces and tangents are
    those of OpenSees at trial displacements; the end of a step commits them. So one simulation moves the model: build it
    again for the next one. Elements are ``elasticBeamColumn``, ``dispBeamColumn`` (with
    sections of fibres), ``zeroLength``, ``Truss``, ``corotTruss`` and ``ShellMITC4``, with the transformations Linear and
    PDelta, in the plane Corotational, too; others raise an `InputError` that names them. Dashpots act by the damping
    matrix of `structure`; Rayleigh damping is constant, by the initial stiffness. OpenSees writes no more messages
    afterwards, as each trial would write one.

    Args:
        ops: the module ``openseespy.opensees`` with its model at rest, as for `structure`: 2400 degrees of freedom at most.
        base_nodes: tags of the nodes on the ground; None for ``faces``.
        width: length of a rigid base in the plane, m; None for several nodes.
        outline: corners of a rigid base in space; None in the plane and for ``faces``.
        faces: a flexible base in space; None for a rigid one.
        below: distance of the ground's surface below the base, m; as in `structure` unless given.
        up: axis of the model in space that points up, "z" or "y".
    """
    model = _structure(ops, base_nodes, width, outline, faces, below, up, "initial", "linear", warn_of_nonlinear=False)
    return NonlinearModel(ops, model)


def _directions(ops: Any) -> tuple[str, ...]:
    """Names of a node's degrees of freedom; an error for a model of another kind, or without elements."""
    sizes = {len(ops.nodeCoord(tag)) for tag in ops.getNodeTags()}
    known = {2: (3,), 3: (3, 6)}.get(min(sizes, default=2), ())
    for tag in ops.getNodeTags():
        found = len(ops.nodeCoord(tag)), len(ops.nodeDisp(tag))
        if len(sizes) > 1 or found[1] not in known:
            counts = "{} coordinates and {} degrees of freedom".format(*found)
            raise InputError(
                f"node {tag} has {counts}, but must have 2 and 3: -ndm 2 -ndf 3, or 3 and 6: -ndm 3 -ndf 6. Any other "
                "linear model is a MatrixModel by its matrices (integrator GimmeMCK, then printA), with a base of "
                "BaseNode, in three dimensions of BaseFaces"
            )
    if not ops.getEleTags():
        raise InputError("the model of OpenSees has no elements")
    return ("x", "y", "rotation") if sizes == {2} else ("x", "y", "z", "rx", "ry", "rz")


def _named(found: dict[str, list[int]], most: int = 20) -> str:
    """Elements by type, with their tags."""
    parts = []
    for reason, tags in found.items():
        more = f" and {len(tags) - most} more" if len(tags) > most else ""
        parts.append(f"element{'s' * (len(tags) > 1)} {', '.join(map(str, tags[:most]))}{more} ({reason})")
    return ", ".join(parts)


def _refused(reasons: dict[int, str], most: int = 20) -> str:
    """Why beams of fibres stay linear."""
    if not reasons:
        return ""
    listed = [f"element {tag} for its {reason}" for tag, reason in list(reasons.items())[:most]]
    more = f" and {len(reasons) - most} more" if len(reasons) > most else ""
    return f". Fibres yield with a Linear transformation and {LAWS}; not in {', '.join(listed)}{more}"


def _symmetric(matrix: Any, names: dict[int, str]) -> Any:
    """The matrix, which must be symmetric but for rounding."""
    odd = abs(matrix - matrix.T)
    row, column = np.unravel_index(int(odd.argmax()), odd.shape)
    if odd[row, column] > 1e-9 * abs(matrix).max():
        pair = f"'{names[int(row)]}' and '{names[int(column)]}'"
        raise InputError(f"a matrix of the model of OpenSees is not symmetric between {pair}: a linear structure must be")
    return matrix


def _clean(matrix: Any) -> Any:
    """Symmetric, without what rounding left of zeros."""
    matrix = 0.5 * (matrix + matrix.T)
    values = matrix if isinstance(matrix, np.ndarray) else matrix.data
    values[abs(values) < 1e-14 * abs(values).max(initial=0.0)] = 0.0
    if values is not matrix:
        matrix.eliminate_zeros()
    return matrix
