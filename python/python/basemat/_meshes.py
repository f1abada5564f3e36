"""Meshes from arrays of points and blocks of cells, as meshio reads them from files of many programs."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from ._core import Material, Mesh
from ._errors import InputError

_SHELLS = {"triangle": 3, "quad": 4}
"""Types of cells that are shells in space, and their numbers of nodes."""


def from_arrays(points: ArrayLike, cells: Sequence[Any], parts: Sequence[Any]) -> Mesh:
    """Mesh from ``points`` and blocks of ``cells``; in space if the points have three coordinates.

    ``points``: array of shape (nodes, 3), or (nodes, 2) in the plane, m. ``cells``: list of pairs (type, array of node
    numbers, one row per cell), or of objects with these as ``type`` and ``data``, such as the blocks of a mesh of meshio.
    ``parts``: list with an entry for each block; None leaves the block out.

    In space the part of "triangle" and "quad" is ``(material, thickness)`` of shells, with one thickness (m) or an array
    of one per cell; of "hexahedron" it is a `Material`; of "line" it is ``(material, section, orientation)`` as in
    `Mesh.add_space_beams`. In the plane the part of "quad" and "quad8" is a `Material`, of "quad8" also another material of
    `Mesh.add_quads`. Triangles match the
    sides that they share with quadrilaterals. Elements are numbered block by block, shells first. Other elements are
    added by the methods of the mesh.
    """
    blocks = [_block(number, block) for number, block in enumerate(cells)]
    if len(parts) != len(blocks):
        raise InputError(f"parts has {len(parts)} entries, but must have {len(blocks)}: one for each block of cells")
    places = np.asarray(points)
    in_space = places.ndim == 2 and places.shape[1] == 3
    mesh = Mesh.in_space(places) if in_space else Mesh(places)
    given = [
        (f"block {number} of cells ({kind})", kind, nodes, part)
        for number, ((kind, nodes), part) in enumerate(zip(blocks, parts))
        if part is not None
    ]
    if in_space:
        _add_shells(mesh, [part for part in given if part[1] in _SHELLS])
    for name, kind, nodes, part in given:
        if in_space and kind == "hexahedron":
            mesh.add_bricks(nodes, part)
        elif in_space and kind == "line":
            material, section, orientation = _entries(name, part, "material", "section", "orientation")
            mesh.add_space_beams(nodes, material, section, orientation)
        elif not in_space and kind in ("quad", "quad8"):
            mesh.add_quads(nodes, part)
        elif not (in_space and kind in _SHELLS):
            known = "'triangle', 'quad', 'hexahedron' or 'line' in space" if in_space else "'quad' or 'quad8' in the plane"
            raise InputError(f"{name} must be of the type {known}, or its part None")
    return mesh


def _add_shells(mesh: Mesh, blocks: list[tuple[str, str, Any, Any]]) -> None:
    """Adds the shells of all blocks at once, so that triangles match the quadrilaterals beside them."""
    shells: list[list[int]] = []
    materials: list[Material] = []
    thicknesses: list[float] = []
    for name, kind, nodes, part in blocks:
        if nodes.ndim != 2 or nodes.shape[1] != _SHELLS[kind]:
            raise InputError(f"{name} has the shape {nodes.shape}, but must have {_SHELLS[kind]} columns")
        material, thickness = _entries(name, part, "material", "thickness")
        each = np.asarray(thickness, float).ravel()
        if each.size not in (1, len(nodes)):
            raise InputError(f"thickness of {name} has {each.size} entries, but must have 1 or {len(nodes)}")
        shells += nodes.tolist()
        materials += [material] * len(nodes)
        thicknesses += np.broadcast_to(each, len(nodes)).tolist()
    if shells:
        mesh.add_shells(shells, materials, thicknesses)


def _block(number: int, block: Any) -> tuple[str, Any]:
    """Type and node numbers of a block."""
    if hasattr(block, "type") and hasattr(block, "data"):
        return block.type, np.asarray(block.data)
    try:
        kind, nodes = block
    except (TypeError, ValueError):
        raise InputError(f"block {number} of cells must be a pair (type, array of node numbers)") from None
    return str(kind), np.asarray(nodes)


def _entries(name: str, part: Any, *entries: str) -> tuple[Any, ...]:
    """Entries of the part of a block."""
    if not isinstance(part, (tuple, list)) or len(part) != len(entries):
        raise InputError(f"the part of {name} must be ({', '.join(entries)})")
    return tuple(part)
