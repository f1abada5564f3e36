"""A frame from OpenSees on a rigid mat that may uplift and slide: ``pip install openseespy``.

The frame is a model of OpenSees, free of supports at node 1; basemat adds the ground and the contact.
"""

from __future__ import annotations

import openseespy.opensees as ops

import basemat as bm
from basemat import opensees

WIDTH = 7.0  # of the mat, m
STOREYS, STOREY = 4, 3.5
CONCRETE = 30e9


def frame() -> None:
    """Two columns and beams per metre of thickness, held together by node 1 in the mat's middle."""
    ops.wipe()
    ops.model("basic", "-ndm", 2, "-ndf", 3)
    ops.node(1, 0.0, 0.0)
    ops.mass(1, 35e3, 35e3, 35e3 * WIDTH**2 / 12.0)
    ops.geomTransf("Linear", 1)
    for side, x in ((1, -2.5), (2, 2.5)):
        for level in range(STOREYS + 1):
            tag = 10 * level + side + 100
            ops.node(tag, x, level * STOREY)
            if level == 0:
                ops.rigidLink("beam", 1, tag)
            else:
                ops.mass(tag, 9e3, 9e3, 1.0)
                ends = (tag - 10, tag)
                ops.element("elasticBeamColumn", tag, *ends, 0.2, CONCRETE, 2e-3, 1, "-mass", 500.0)
    for level in range(1, STOREYS + 1):
        tag = 10 * level + 101
        ops.element("elasticBeamColumn", tag + 1000, tag, tag + 1, 0.3, CONCRETE, 4e-3, 1)
    ops.rayleigh(0.0, 0.0, 2e-3, 0.0)


def main() -> None:
    """Runs El Centro with and without uplift and sliding."""
    frame()
    model = opensees.structure(ops, [1], width=WIDTH)
    soil = bm.Soil.from_shear_wave_speed(220.0, poisson=0.33, density=1900.0)
    roof = model.row(10 * STOREYS + 101)
    print(f"{model.dofs} degrees of freedom")
    for law in (bm.Bonded(), bm.Coulomb(0.5)):
        simulation = bm.Simulation(
            0.005,
            model,
            bm.ElasticGround.under(soil, model, 10),
            law,
            motion=bm.el_centro_1940(),
            probes=[bm.Probe.displacement("roof", roof)],
        )
        run = simulation.run()
        print(
            f"{law!r:<14} base shear {1e-3 * run.base_shear.magnitude:6.1f} kN/m, "
            f"roof {1e3 * run.probes['roof'].magnitude:5.1f} mm, "
            f"uplift {100.0 * run.uplifted_fraction.value:3.0f} %"
        )


if __name__ == "__main__":
    main()
