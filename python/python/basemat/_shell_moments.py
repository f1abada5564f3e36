"""Bending moments of the shells of a model as a picture: methods of structures."""

from __future__ import annotations

from collections.abc import Sequence
from contextlib import suppress
from typing import TYPE_CHECKING, Any, Literal

import numpy as np

from ._core import FemModel, Mesh
from ._errors import InputError
from ._pickling import _MADE, Made
from ._shapes import plot_shells

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from numpy.typing import ArrayLike, NDArray


def plot_shell_moments(
    self: FemModel,
    displacement: ArrayLike,
    elements: Sequence[int] | None = None,
    *,
    view: Literal["plan", "front", "side", "space"] = "space",
    axes: Axes | None = None,
    title: str | None = None,
) -> Axes:
    """Draws the principal bending moment of larger magnitude of each shell, mat and walls, in kN·m/m; returns the axes.

    It is that of the mean moments over the corners of the shell; it is positive with tension on the side of −n, as
    `ShellResultants.moments`.

    Args:
        displacement: all n degrees of freedom, array of shape (n,), m and rad: ``run.static_displacement`` plus a row of
            ``run.motion["displacement"]``, which alone gives the moments without those of weight and loads.
        elements: numbers of the shells; all of the model unless given.
        view: "space" (by default), "plan", "front" or "side", as for `Mesh.plot_shells`.
        axes: axes of matplotlib to draw into; unless given, axes of a new figure.
        title: text above the picture; none unless given.
    """
    mesh = mesh_of(self)
    shells = shells_of(self) if elements is None else list(elements)
    if not shells:
        raise InputError("the model has no shells: plot_shell_moments is for mats and walls of shells in space")
    moments = governing_moments(self, shells, displacement)
    return plot_shells(
        mesh, shells, 1e-3 * moments, quantity="principal moment, kN·m/m", view=view, axes=axes, title=title
    )


def mesh_of(model: Any) -> Mesh:
    """The mesh of a finite-element model, which remembers its arguments."""
    made = model.__dict__[_MADE]
    mesh = made.keywords["mesh"] if "mesh" in made.keywords else made.arguments[0]
    # A mesh, to which elements may be added later, is stored by how it was made.
    found = mesh.again() if isinstance(mesh, Made) else mesh
    assert isinstance(found, Mesh)
    return found


def shells_of(model: FemModel) -> list[int]:
    """Numbers of the shells of a model."""
    mesh, found, at_rest = mesh_of(model), [], np.zeros(model.dofs)
    if mesh.nodes.shape[1] != 3:
        return []
    for element, nodes in enumerate(mesh.elements):
        with suppress(InputError):
            if len(nodes) in (3, 4) and model.shell_resultants(element, at_rest):
                found.append(element)
    return found


def governing_moments(model: FemModel, shells: Sequence[int], displacement: ArrayLike) -> NDArray[np.float64]:
    """Principal moment of larger magnitude of each shell, N·m/m: array of shape (shells,)."""
    governing = []
    for element in shells:
        m11, m22, m12 = np.mean([point.moments for point in model.shell_resultants(element, displacement)], axis=0)
        radius = float(np.hypot(0.5 * (m11 - m22), m12))
        middle = 0.5 * (m11 + m22)
        governing.append(middle + np.copysign(radius, middle))
    return np.array(governing)
