"""Laws of fibres and cantilevers of fibres by OpenSees: python3 opensees.py (openseespy 3.7.1.2, numpy)

Writes opensees_laws.csv and opensees_cantilevers.csv beside this file.

Laws: each row is a strain and the stress of one law, committed row by row.

Cantilevers: a column of 3 m with 400 kN on its top, whose top moves to and fro. The section is a rectangle of concrete with two
layers of bars; its area is symmetric about the axis of the column, as OpenSees takes positions of fibres from the centroid of
their areas. Each row is a state in equilibrium: displacements of the top, its lateral force, and the deformations, moment and
two stresses of the section at the foot.
"""

from __future__ import annotations

import csv
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import openseespy.opensees as ops

FOLDER = Path(__file__).parent

STEEL = 420e6, 200e9, 0.015
CURVED_STEEL = *STEEL, 18.0, 0.925, 0.15
CONCRETE = -28e6, -0.0021, -5.6e6, -0.007
LAWS = {
    "bilinear": ("Steel01", *STEEL),
    "curved": ("Steel02", *CURVED_STEEL),
    "hardening": ("Steel02", *CURVED_STEEL, 0.05, 8.0, 0.04, 9.0),
    "concrete": ("Concrete01", *CONCRETE),
}

HEIGHT, WEIGHT = 3.0, 400e3
DEPTH, WIDTH, LAYERS = 0.5, 0.4, 20
BAR_AREA, BAR_COUNT, BAR_POSITION = 491e-6, 3, 0.2
"""Area of a bar, bars of a layer, distance of a layer from the axis."""
ELEMENTS = {"dispBeamColumn": 4, "forceBeamColumn": 1}
STEP = 1.5e-3
"""Change of the displacement of the top in a step, m."""
PEAKS = 0.012, -0.015, 0.03, -0.03, 0.045, -0.021, 0.0
"""Displacements of the top at which it turns, m."""


def law_strains(name: str) -> list[float]:
    """Ends of ramps of random lengths in ten steps each."""
    random = np.random.default_rng(7)
    low, high = (-0.009, 0.002) if name == "concrete" else (-0.02, 0.02)
    ends = random.uniform(low, high, 25) * np.linspace(0.2, 1.0, 25)
    return [float(entry) for one, other in zip([0.0, *ends], ends) for entry in np.linspace(one, other, 11)[1:]]


def law_rows() -> Iterator[tuple[str, float, float]]:
    for name, law in LAWS.items():
        ops.wipe()
        ops.uniaxialMaterial(law[0], 1, *law[1:])
        ops.testUniaxialMaterial(1)
        for strain in law_strains(name):
            ops.setStrain(strain)
            yield name, strain, float(ops.getStress())


def build(element: str, steel: str) -> int:
    """The column, fixed at its foot; the tag of its top."""
    ops.wipe()
    ops.model("basic", "-ndm", 2, "-ndf", 3)
    for tag, name in ((1, "concrete"), (2, steel)):
        ops.uniaxialMaterial(LAWS[name][0], tag, *LAWS[name][1:])
    ops.section("Fiber", 1)
    ops.patch("rect", 1, LAYERS, 1, -0.5 * DEPTH, -0.5 * WIDTH, 0.5 * DEPTH, 0.5 * WIDTH)
    for y in (-BAR_POSITION, BAR_POSITION):
        ops.layer("straight", 2, BAR_COUNT, BAR_AREA, y, -0.15, y, 0.15)
    ops.geomTransf("Linear", 1)
    ops.beamIntegration("Lobatto", 1, 1, 5)
    count = ELEMENTS[element]
    iterations = ("-iter", 100, 1e-18) if element == "forceBeamColumn" else ()
    for tag in range(1, count + 2):
        ops.node(tag, 0.0, HEIGHT * (tag - 1) / count)
        if tag > 1:
            ops.element(element, tag - 1, tag - 1, tag, 1, 1, *iterations)
    ops.fix(1, 1, 1, 1)
    return count + 1


def analysis(integrator: tuple[object, ...]) -> None:
    ops.wipeAnalysis()
    ops.constraints("Plain")
    ops.numberer("Plain")
    ops.system("FullGeneral")
    ops.test("NormDispIncr", 1e-15, 100, 0)
    ops.algorithm("Newton")
    ops.integrator(*integrator)
    ops.analysis("Static")


def state(top: int, factor: float) -> list[float]:
    """Displacements of the top, its lateral force, and the section at the foot."""
    strain, curvature = ops.eleResponse(1, "section", 1, "deformation")
    moment = ops.eleResponse(1, "section", 1, "force")[1]
    # Position, area, stress and strain of each fibre, those of concrete first.
    fibers = np.array(ops.eleResponse(1, "section", 1, "fiberData")).reshape(-1, 5)
    stresses = fibers[0, 3], fibers[LAYERS, 3]
    return [*ops.nodeDisp(top), factor, strain, curvature, moment, *stresses]


def cantilever_rows(element: str, steel: str) -> Iterator[list[float]]:
    top = build(element, steel)
    ops.timeSeries("Linear", 1)
    ops.pattern("Plain", 1, 1)
    ops.load(top, 0.0, -WEIGHT, 0.0)
    analysis(("LoadControl", 1.0))
    assert ops.analyze(1) == 0
    ops.loadConst("-time", 0.0)
    yield state(top, 0.0)
    ops.timeSeries("Linear", 2)
    ops.pattern("Plain", 2, 2)
    ops.load(top, 1.0, 0.0, 0.0)
    at = 0.0
    for peak in PEAKS:
        count = round(abs(peak - at) / STEP)
        analysis(("DisplacementControl", top, 1, (peak - at) / count))
        for _ in range(count):
            assert ops.analyze(1) == 0, (element, steel, ops.nodeDisp(top, 1))
            yield state(top, ops.getTime())
        at = peak


def main() -> None:
    """Writes both tables."""
    with (FOLDER / "opensees_laws.csv").open("w", newline="") as file:
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow(["law", "strain", "stress_pa"])
        for name, strain, stress in law_rows():
            writer.writerow([name, f"{strain:.15g}", f"{stress:.15g}"])
    with (FOLDER / "opensees_cantilevers.csv").open("w", newline="") as file:
        writer = csv.writer(file, lineterminator="\n")
        section = ["axial_strain", "curvature_per_m", "moment_n_m", "concrete_stress_pa", "bar_stress_pa"]
        writer.writerow(["element", "steel", "x_m", "y_m", "rotation", "force_n", *section])
        for element in ELEMENTS:
            for steel in ("bilinear", "curved"):
                for row in cantilever_rows(element, steel):
                    writer.writerow([element, steel, *(f"{entry:.15g}" for entry in row)])


if __name__ == "__main__":
    main()
