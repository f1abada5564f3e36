"""Beams of fibres of an OpenSees model as beams of basemat, whose fibres yield in a run."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator
from typing import Any, NamedTuple

import numpy as np

from . import BilinearSteel, Concrete, DofCombination, FiberSection, InputError, Material, MenegottoPinto, Mesh
from ._opensees_linear import Elements
from ._opensees_rows import Rows

_FORMULATIONS = {
    "DispBeamColumn2d": "displacement_based",
    "ForceBeamColumn2d": "force_based",
    "DispBeamColumn3d": "displacement_based",
    "ForceBeamColumn3d": "force_based",
}
_TRANSFORMATIONS = ("LinearCrdTransf2d", "LinearCrdTransf3d")
_SECTIONS = ("FiberSection2d", "FiberSection3d")
_QUADRATURES = {"Lobatto": "lobatto", "Legendre": "legendre"}
#: Largest difference of stiffnesses that counts as rounding, relative to the largest entry.
_ROUNDING = 1e-9
#: Part of the stiffness of fibres below which the rest of an entry is rounding of the whole.
_CANCELLED = 1e-11

LAWS = "Elastic, Steel01 without isotropic hardening, Steel02 without initial stress, and Concrete01"


class _Unsuitable(Exception):
    """Why a beam stays linear."""


class FiberBeam(NamedTuple):
    """A beam of an OpenSees model whose fibres yield."""

    tag: int
    nodes: tuple[int, int]
    section: FiberSection
    points: int
    quadrature: str
    formulation: str
    #: Direction of the section's y axis in space; None in the plane.
    orientation: tuple[float, ...] | None

    def add_to(self, mesh: Mesh, ends: list[int]) -> int:
        """Adds the beam to a mesh, without mass; its number there."""
        options: Any = {"points": self.points, "quadrature": self.quadrature, "formulation": self.formulation}
        if self.orientation is None:
            return mesh.add_fiber_beams([ends], self.section, 0.0, **options)[0]
        return mesh.add_space_fiber_beams([ends], self.section, 0.0, self.orientation, **options)[0]


def _mesh(places: Any) -> Mesh:
    """Nodes at places in the plane or in space (array of shape (n, 2) or (n, 3), m)."""
    return Mesh(places) if places.shape[1] == 2 else Mesh.in_space(places)


class FiberBeams:
    """Beams of fibres of a model at rest: those that yield in a run, and why others do not.

    Args:
        ops: the module ``openseespy.opensees``.
        elements: the elements of its model.
    """

    def __init__(self, ops: Any, elements: Elements) -> None:
        self._ops, self._elements = ops, elements
        self.beams: list[FiberBeam] = []
        #: Reason why a beam of fibres stays linear, by its tag.
        self.refused: dict[int, str] = {}
        for found in elements.not_linear().values():
            for tag in found:
                if str(ops.eleType(tag)) not in _FORMULATIONS:
                    continue
                try:
                    self.beams.append(self._beam(tag))
                except _Unsuitable as reason:
                    self.refused[tag] = str(reason)

    def mesh(self, at: dict[int, tuple[float, ...]]) -> tuple[Mesh, list[int], dict[int, int]]:
        """Mesh of the beams, tags of its nodes, and numbers of its elements by their tags; ``at``: places of nodes, m."""
        tags = list(dict.fromkeys(tag for beam in self.beams for tag in beam.nodes))
        mesh = _mesh(np.array([at[tag] for tag in tags]))
        number = {tag: k for k, tag in enumerate(tags)}
        return mesh, tags, {beam.tag: beam.add_to(mesh, [number[tag] for tag in beam.nodes]) for beam in self.beams}

    def _beam(self, tag: int) -> FiberBeam:
        text = self._elements.part("elements", tag).text
        for name in self._elements.uses("crdTransformation", text):
            part = self._elements.part("crdTransformation", name)
            if part.type not in _TRANSFORMATIONS:
                raise _Unsuitable(f"transformation {name} {part.type}, not Linear")
            if "Offset" in part.text:
                raise _Unsuitable(f"transformation {name} with joint offsets")
        sections = self._elements.uses("section", text)
        if len(sections) != 1:
            raise _Unsuitable(f"sections {', '.join(sections)}, not one")
        kind = self._elements.part("section", sections[0]).type
        if kind not in _SECTIONS:
            raise _Unsuitable(f"section {sections[0]} {kind}, not Fiber")
        rule = re.search(r'"integration": \{"type": "(\w+)"', text)
        points = len(self._ops.eleResponse(tag, "integrationPoints"))
        if rule is None or rule[1] not in _QUADRATURES or not 2 <= points <= 5:
            name = f"{rule[1]} with {points} points" if rule else "unknown"
            raise _Unsuitable(f"integration {name}, not Lobatto or Legendre with 2 to 5 points")
        one, other = (int(node) for node in self._ops.eleNodes(tag))
        in_space = kind == "FiberSection3d"
        section = self._section(tag, int(sections[0]))
        if in_space:
            length = float(np.linalg.norm(np.subtract(self._ops.nodeCoord(other), self._ops.nodeCoord(one))))
            # Of twists of both ends; a printed model has six digits.
            torsion = self._ops.eleResponse(tag, "basicStiffness")[-1] * length
            if not torsion > 0.0:
                raise _Unsuitable(f"section {sections[0]} without torsional stiffness")
            section = section.with_torsional_stiffness(torsion)
        beam = FiberBeam(
            tag,
            (one, other),
            section,
            points,
            _QUADRATURES[rule[1]],
            _FORMULATIONS[str(self._ops.eleType(tag))],
            tuple(self._ops.eleResponse(tag, "yaxis")) if in_space else None,
        )
        self._check_stiffness(beam)
        return beam

    def _section(self, tag: int, section: int) -> FiberSection:
        """Section of an element; positions are from the centroid of the areas, as in OpenSees."""
        fibers = np.array(self._ops.eleResponse(tag, "section", 1, "fiberData2")).reshape(-1, 6)
        y, z, area, material = fibers[:, :4].T
        laws = {name: self._law(tag, section, int(name)) for name in dict.fromkeys(material.tolist())}
        if fibers[:, 4:].any():
            raise InputError(
                f"analyses have left stresses in the fibres of element {tag}: call ops.reset() before, as a run begins with "
                "the unloaded structure, or give fibers='linear'"
            )
        y, z = y - area @ y / area.sum(), z - area @ z / area.sum()
        found = FiberSection()
        # Neighbours of one material at once.
        for group in np.split(np.arange(len(y)), np.flatnonzero(np.diff(material)) + 1):
            found = found.with_fibers(np.stack([y[group], z[group]], axis=1), area[group], laws[material[group[0]]])
        return found

    def _law(self, tag: int, section: int, material: int) -> Any:
        """Law of the fibres of a material (its tag) in an element."""
        part = self._elements.part("material", material)
        make = _LAWS.get(part.type)
        name = f"material {material} {part.type}"
        if make is None:
            raise _Unsuitable(f"section {section}, {name}")

        def value(word: str) -> float:
            return self._parameter(tag, material, word)

        printed = dict(re.findall(r'"(\w+)": ([^,}]+)', part.text))
        try:
            return make(value, printed)
        except (_Unsuitable, InputError) as error:
            raise _Unsuitable(f"section {section}, {name}: {error}") from None

    def _parameter(self, tag: int, material: int, word: str) -> float:
        """A number of a material in all its digits, of which a printed model has six."""
        number = max([0, *self._ops.getParamTags()]) + 1
        self._ops.parameter(number, "element", tag, "section", 1, "material", material, word)
        try:
            return float(self._ops.getParamValue(number))
        finally:
            self._ops.remove("parameter", number)

    def _check_stiffness(self, beam: FiberBeam) -> None:
        """A reason against the beam unless it has the stiffness of OpenSees' element at rest."""
        places = np.array([self._ops.nodeCoord(tag) for tag in beam.nodes])
        mesh = _mesh(places)
        found = mesh.element_stiffness(beam.add_to(mesh, [0, 1]))
        basic = _basic_rows(places, beam.orientation)
        expected = np.array(self._ops.eleResponse(beam.tag, "basicStiffness")).reshape(len(basic), len(basic))
        if np.abs(basic.T @ expected @ basic - found).max() > _ROUNDING * np.abs(found).max():
            raise _Unsuitable("another stiffness at rest than that of its fibres")


def _basic_rows(places: Any, orientation: tuple[float, ...] | None) -> Any:
    """Rows of OpenSees' basic deformations by displacements of both ends, between two places (m).

    They are elongation and rotations of both ends relative to the chord, in space about z, then about y, and the twist.
    """
    along = places[1] - places[0]
    length = float(np.linalg.norm(along))
    if orientation is None:
        cosine, sine = along / length
        x, y = sine / length, cosine / length
        return np.array([[-cosine, -sine, 0, cosine, sine, 0], [-x, y, 1, x, -y, 0], [-x, y, 0, x, -y, 1]])
    axes = np.array([along / length, orientation, np.cross(along / length, orientation)])
    # Rows by displacements and rotations of both ends in the axes of the beam.
    local = np.zeros((6, 12))
    local[0, [0, 6]] = -1.0, 1.0
    for end, (about_z, about_y) in enumerate(((1, 3), (2, 4))):
        local[about_z, [5 + 6 * end, 1, 7]] = 1.0, 1.0 / length, -1.0 / length
        local[about_y, [4 + 6 * end, 2, 8]] = 1.0, -1.0 / length, 1.0 / length
    local[5, [3, 9]] = -1.0, 1.0
    return local @ np.kron(np.eye(4), axes)


def _elastic(value: Callable[[str], float], printed: dict[str, str]) -> Material:
    if float(printed["Epos"]) != float(printed["Eneg"]):
        raise _Unsuitable("two moduli")
    if float(printed["eta"]):
        raise _Unsuitable("viscous damping")
    return Material(value("E"), 0.0, 0.0)


def _bilinear_steel(value: Callable[[str], float], printed: dict[str, str]) -> BilinearSteel:
    if value("a1") or value("a3"):
        raise _Unsuitable("isotropic hardening")
    return BilinearSteel(value("Fy"), value("E"), value("b"))


def _menegotto_pinto(value: Callable[[str], float], printed: dict[str, str]) -> MenegottoPinto:
    if float(printed["sigini"]):
        raise _Unsuitable("initial stress")
    return MenegottoPinto(
        value("Fy"),
        value("E"),
        value("b"),
        transition=[value(word) for word in ("R0", "cR1", "cR2")],
        isotropic_hardening=[value(word) for word in ("a1", "a2", "a3", "a4")],
    )


def _concrete(value: Callable[[str], float], printed: dict[str, str]) -> Concrete:
    return Concrete(*(-value(word) for word in ("fc", "epsco", "fcu", "epscu")))


#: Laws of basemat by OpenSees' types of the same definition, from parameters in all digits and as printed.
_LAWS: dict[str, Callable[[Callable[[str], float], dict[str, str]], Any]] = {
    "ElasticMaterial": _elastic,
    "Steel01": _bilinear_steel,
    "Steel02": _menegotto_pinto,
    "Concrete01": _concrete,
}


def without_fibers(stiffness: Any, mesh: Mesh, tags: list[int], places: dict[int, list[int]]) -> Any:
    """A stiffness of all nodes without that of the beams of a mesh; ``tags``: its nodes, ``places``: rows of each node.

    Entries to which nothing but these beams contributes are exactly zero.
    """
    terms = np.array(list(_terms(mesh, tags, places)))
    row, column = terms[:, :2].astype(int).T
    pairs, position = np.unique(row * stiffness.shape[0] + column, return_inverse=True)
    row, column = np.divmod(pairs, stiffness.shape[0])
    position = position.ravel()
    fibers = np.bincount(position, terms[:, 2])
    # Forces of a stiff direction leave rounding in entries of softer ones.
    diagonal = np.zeros(stiffness.shape[0])
    diagonal[row[row == column]] = fibers[row == column]
    scale = np.sqrt(diagonal[row] * diagonal[column])
    whole = np.asarray(stiffness[row, column], dtype=float).ravel()
    rest = np.where(np.abs(whole - fibers) <= _CANCELLED * scale, 0.0, whole - fibers)
    if isinstance(stiffness, np.ndarray):
        found = stiffness.copy()
        found[row, column] = rest
        return found
    from scipy import sparse

    return stiffness + sparse.csr_matrix((rest - whole, (row, column)), shape=stiffness.shape)


def _terms(mesh: Mesh, tags: list[int], places: dict[int, list[int]]) -> Iterator[tuple[int, int, float]]:
    """Row, column and value of the entries of all elements' stiffnesses."""
    for element, nodes in enumerate(mesh.elements):
        at = [place for node in nodes for place in places[tags[node]]]
        matrix = mesh.element_stiffness(element)
        yield from ((one, other, matrix[k, j]) for k, one in enumerate(at) for j, other in enumerate(at))


def rows_of(rows: Rows, tags: list[int]) -> list[list[DofCombination]]:
    """Rows of the displacements of nodes in all directions."""
    return [[DofCombination(rows.ties.terms(place)) for place in rows.places[tag]] for tag in tags]
