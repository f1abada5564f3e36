"""Nonlinear parts of an OpenSees model, by the types of its elements, materials, sections and transformations."""

from __future__ import annotations

import re
import tempfile
from collections.abc import Iterator
from pathlib import Path
from typing import Any, NamedTuple

# Elements that are linear if their materials, sections and transformation are.
_ELEMENTS = {
    "ElasticBeam2d", "ElasticTimoshenkoBeam2d", "ModElasticBeam2d", "ElasticForceBeamColumn2d", "DispBeamColumn2d",
    "ForceBeamColumn2d", "ForceBeamColumnCBDI2d", "TimoshenkoBeamColumn2d", "ComponentElement2d", "Truss",
    "TrussSection", "ZeroLength", "ZeroLengthSection", "CoupledZeroLength", "TwoNodeLink", "InertiaTruss",
    "ElasticBeam3d", "ElasticTimoshenkoBeam3d", "ModElasticBeam3d", "ElasticForceBeamColumn3d", "DispBeamColumn3d",
    "ForceBeamColumn3d", "ForceBeamColumnCBDI3d", "TimoshenkoBeamColumn3d",
}  # fmt: skip
_SHELLS = {"ShellMITC4", "ShellMITC9", "ShellDKGQ", "ShellDKGT", "ASDShellQ4", "ASDShellT3"}
_SOLIDS = {"Brick", "BbarBrick", "SSPbrick", "FourNodeTetrahedron", "TenNodeTetrahedron", "Twenty_Node_Brick"}
_KNOWN = _ELEMENTS | _SHELLS | _SOLIDS
_SECTIONS = {
    "ElasticSection2d", "ElasticShearSection2d", "SectionAggregator", "FiberSection2d", "ElasticSection3d",
    "ElasticShearSection3d", "FiberSection3d", "ElasticMembranePlateSection",
}  # fmt: skip
# Sections through the thickness of a shell, of materials in several directions.
_LAYERED = {"PlateFiber", "LayeredShellFiberSection"}
_MATERIALS = {
    "ElasticMaterial", "ParallelMaterial", "SeriesMaterial", "InitStrainMaterial", "InitStressMaterial",
    "ViscousMaterial",
}  # fmt: skip
_SOLID_MATERIALS = {"ElasticIsotropicMaterial", "ElasticOrthotropicMaterial", "PlateFiberMaterial"}
_TRANSFORMATIONS = {"LinearCrdTransf2d", "LinearCrdTransf3d"}

# Materials with one tangent to one side of the state at rest, and another or none to the other side.
_ONE_SIDED = {"ENTMaterial", "EPPGap", "HookGap", "HyperbolicGapMaterial", "ImpactMaterial", "ViscoelasticGap"}
_PLACES = {
    "uniaxialMaterials": "material",
    "ndMaterials": "ndMaterial",
    "sections": "section",
    "crdTransformations": "crdTransformation",
}


class Part(NamedTuple):
    """A part of a model as OpenSees prints it: its type, the rest of its line."""

    type: str
    text: str


class Elements:
    """Elements of a model, and what they are made of.

    Args:
        ops: the module ``openseespy.opensees``.
    """

    def __init__(self, ops: Any) -> None:
        self._ops = ops
        self._parts: dict[tuple[str, str], Part] = {}
        with tempfile.TemporaryDirectory() as folder:
            path = Path(folder, "model.json")
            ops.printModel("-JSON", "-file", str(path))
            lines = path.read_text(encoding="utf-8", errors="replace").splitlines() if path.exists() else []
        # By lines: OpenSees prints some types in words, and the whole is no JSON then.
        kind, last = "", ("", "")
        for line in lines:
            if opening := re.match(r'\s*"(\w+)": \[\s*$', line):
                kind = _PLACES.get(opening[1], opening[1])
            elif found := re.match(r'\s*\{"name": "?(\d+)"?, "type": "(\w+)"(.*)', line):
                last = kind, found[1]
                self._parts[last] = Part(found[2], found[3])
            elif found := re.match(r"Viscous tag: (\d+)", line):
                last = kind, found[1]
                self._parts[last] = Part("ViscousMaterial", "")
            elif last in self._parts:
                # Fibres of a section, numbers of a dashpot.
                self._parts[last] = Part(self._parts[last].type, self._parts[last].text + line)

    def not_linear(self) -> dict[str, list[int]]:
        """Tags of the elements that are not linear, by their type and what makes them so."""
        found: dict[str, list[int]] = {}
        for tag in self._ops.getEleTags():
            reasons = list(dict.fromkeys(self._reasons(tag)))
            if reasons or self._type(tag) not in _KNOWN:
                found.setdefault(", ".join([self._type(tag), *reasons]), []).append(int(tag))
        return found

    def without_tangent(self) -> dict[str, list[int]]:
        """Tags of the elements that have no tangent at rest, by their type and what makes them so."""
        found: dict[str, list[int]] = {}
        for tag in self._ops.getEleTags():
            text = self.part("elements", tag).text if self._type(tag) not in _SOLIDS else ""
            materials = [material for material in self.uses("material", text) if self._one_sided(material)]
            reasons = [self._name("material", material) for material in materials]
            if reasons or "Contact" in self._type(tag):
                found.setdefault(", ".join([self._type(tag), *dict.fromkeys(reasons)]), []).append(int(tag))
        return found

    def shells(self) -> dict[int, tuple[list[int], float | None]]:
        """Nodes and thickness (m; None where it is not printed) of the shells, by their tags."""
        found: dict[int, tuple[list[int], float | None]] = {}
        for tag in self._ops.getEleTags():
            if "Shell" not in self._type(tag):
                continue
            [name] = self.uses("section", self.part("elements", tag).text) or [""]
            printed = re.search(r'"(?:t|totalT)hickness": "?([^",}]+)', self.part("section", name).text)
            nodes = [int(node) for node in self._ops.eleNodes(tag)]
            found[int(tag)] = nodes, float(printed[1]) if printed else None
        return found

    def transformations(self, tag: int) -> list[str]:
        """Types of the geometric transformations of an element."""
        names = self.uses("crdTransformation", self.part("elements", tag).text)
        return [self.part("crdTransformation", name).type for name in names]

    def _type(self, tag: int) -> str:
        return str(self._ops.eleType(tag))

    def part(self, kind: str, name: object) -> Part:
        """A part of a kind by its tag; an empty one where OpenSees prints none."""
        return self._parts.get((kind, str(name)), Part("", ""))

    def _name(self, kind: str, name: str) -> str:
        """Kind, tag and type as a text."""
        found = self.part(kind, name).type
        if not found and kind in ("material", "section"):
            command = "uniaxialMaterial" if kind == "material" else kind
            found = str(self._ops.classType(command, int(name)))
        return f"{kind} {name} {found}".rstrip() if kind != "crdTransformation" else found or f"geomTransf {name}"

    @staticmethod
    def uses(kind: str, text: str) -> list[str]:
        """Tags of this kind in a text."""
        single = re.findall(rf'"{kind}": "?(\d+)"?', text, re.IGNORECASE)
        several = re.findall(rf'"{kind}s": \[([^\]]*)\]', text)
        return list(dict.fromkeys(single + [number for found in several for number in re.findall(r"\d+", found)]))

    def _reasons(self, tag: int) -> Iterator[str]:
        """Reasons why an element is nonlinear, as far as OpenSees prints them."""
        text = self.part("elements", tag).text
        if '"Mratios"' in text:
            yield "P-Delta"
        for name in self.uses("crdTransformation", text):
            if self.part("crdTransformation", name).type not in _TRANSFORMATIONS:
                yield self._name("crdTransformation", name)
        if self._type(tag) in _SOLIDS:
            yield from self._solid(text)
        else:
            yield from self._inside(text)
        if not text and self._type(tag) in _KNOWN:
            yield "unknown properties"

    def _solid(self, text: str) -> Iterator[str]:
        """Materials of a text, in several directions, that are not linear."""
        for name in self.uses("material", text):
            part = self.part("ndMaterial", name)
            if part.type in _SOLID_MATERIALS:
                yield from self._solid(part.text)
            else:
                yield self._name("ndMaterial", name)

    def _inside(self, text: str) -> Iterator[str]:
        """Materials and sections of a text that are not linear."""
        for name in self.uses("material", text):
            part = self.part("material", name)
            if part.type not in _MATERIALS or self._one_sided(name):
                yield self._name("material", name)
            else:
                yield from self._inside(part.text)
        for name in self.uses("section", text):
            part = self.part("section", name)
            if part.type in _SECTIONS | _LAYERED:
                inside = list((self._solid if part.type in _LAYERED else self._inside)(part.text))
                yield from [f"section {name} {part.type}", *inside] if inside else []
            elif name != "0" or part.type:
                # Section 0 is the elastic one that a beam with hinges makes between them.
                yield self._name("section", name)

    def _one_sided(self, name: str) -> bool:
        """Whether a material, or one that it is made of, has no tangent at rest."""
        part = self.part("material", name)
        if part.type in _ONE_SIDED:
            return True
        if part.type == "ElasticMaterial":
            sides = re.findall(r'"E(?:pos|neg)": ([^,}]+)', part.text)
            return len(set(sides)) > 1
        if part.type == "ViscousMaterial":
            power = re.search(r"Alpha: (\S+)", part.text)
            return power is None or float(power[1]) != 1.0
        return any(self._one_sided(material) for material in self.uses("material", part.text))
