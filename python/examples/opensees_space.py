"""A frame building in space from OpenSees on a mat of shells that uplifts and slides: ``pip install openseespy``.

The building is a model of OpenSees (``-ndm 3 -ndf 6``, z up), free of supports; basemat adds the ground and the contact. On a
rigid mat, columns hang on one node by ``rigidLink``: ``opensees.structure(ops, [node], outline=[(x, y), …])``.
"""

from __future__ import annotations

import openseespy.opensees as ops

import basemat as bm
from basemat import opensees

BAYS, BAY = 2, 5.0  # along x and y
STOREYS, STOREY = 4, 3.2
CONCRETE, SHEAR, POISSON = 30e9, 12.5e9, 0.2
GRID = [(i, j) for j in range(BAYS + 1) for i in range(BAYS + 1)]


def node(i: int, j: int, level: int) -> int:
    """Tag of the node of a column at a level."""
    return 1000 * (level + 1) + 10 * j + i


def frame() -> None:
    """Columns, beams and rigid floors, whose masses are at the nodes."""
    ops.geomTransf("Linear", 1, 1.0, 0.0, 0.0)
    ops.geomTransf("Linear", 2, 0.0, 0.0, 1.0)
    for level in range(STOREYS + 1):
        for i, j in GRID:
            ops.node(node(i, j, level), i * BAY, j * BAY, level * STOREY)
        if level == 0:
            continue
        for i, j in GRID:
            tag = node(i, j, level)
            ops.mass(tag, 22e3, 22e3, 22e3, 0.0, 0.0, 0.0)
            ops.element("elasticBeamColumn", tag, tag - 1000, tag, 0.2, CONCRETE, SHEAR, 5e-3, 4e-3, 3e-3, 1)
            for k, end in ((1, (i + 1, j)), (2, (i, j + 1))):
                if end in GRID:
                    beam = (0.18, CONCRETE, SHEAR, 4e-3, 2e-3, 5e-3, 2)
                    ops.element("elasticBeamColumn", 10000 * k + tag, tag, node(*end, level), *beam)
        ops.rigidDiaphragm(3, node(1, 1, level), *(node(*corner, level) for corner in GRID if corner != (1, 1)))


def mat() -> list[int]:
    """Two shells a bay each way, 0.6 m thick, on the columns' feet and nodes between them; their tags."""
    ops.section("ElasticMembranePlateSection", 1, CONCRETE, POISSON, 0.6, 2500.0)
    count, tags, shells = 2 * BAYS + 1, {}, []
    for i, j in ((i, j) for j in range(count) for i in range(count)):
        tags[i, j] = 100 + 10 * j + i
        if i % 2 == j % 2 == 0:
            tags[i, j] = node(i // 2, j // 2, 0)
        else:
            ops.node(tags[i, j], 0.5 * i * BAY, 0.5 * j * BAY, 0.0)
    for i, j in ((i, j) for j in range(count - 1) for i in range(count - 1)):
        shells.append(50000 + 10 * j + i)
        ops.element("ShellMITC4", shells[-1], *(tags[i + a, j + b] for a, b in ((0, 0), (1, 0), (1, 1), (0, 1))), 1)
    return shells


def main() -> None:
    """Runs El Centro, scaled to 0.7 along x and to 0.5 along y, with and without uplift and sliding."""
    ops.wipe()
    ops.model("basic", "-ndm", 3, "-ndf", 6)
    frame()
    shells = mat()
    ops.rayleigh(0.2, 0.0, 2e-3, 0.0)
    model = opensees.structure(ops, faces=shells)
    soil = bm.Soil.from_shear_wave_speed(220.0, poisson=0.33, density=1900.0)
    motion = bm.triaxial(x=bm.el_centro_1940().scaled(0.7), y=bm.el_centro_1940().scaled(0.5))
    roof, ground = bm.Probe.displacement("roof", model.row(node(1, 1, STOREYS))), bm.ElasticGround.under(soil, model, 8)
    print(f"{model.dofs} degrees of freedom")
    for law in (bm.Bonded(), bm.Coulomb(0.5)):
        run = bm.Simulation(0.01, model, ground, law, motion=motion, probes=[roof]).run(duration=10.0)
        shear, top = 1e-3 * run.base_shear.magnitude, 1e3 * run.probes["roof"].magnitude
        print(f"{law!r:<14} base shear {shear:6.0f} kN, roof {top:5.1f} mm, uplift {100.0 * run.uplifted_fraction.value:3.0f} %")


if __name__ == "__main__":
    main()
