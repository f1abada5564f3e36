"""A containment of shells on a raft that bends, lifts and slides under three components of an earthquake.

    python examples/containment_in_space.py

Raft, wall and dome are a surface of revolution, from the middle of the raft to the top of the dome. The table compares
a bonded base with one that opens and slides.
"""

from __future__ import annotations

import numpy as np

import basemat as bm

RADIUS, HEIGHT = 20.0, 30.0
"""Of the middle surface of the wall, m."""
ROWS = np.array([5, 5, 4])
THICKNESS = np.array([3.0, 1.2, 1.0])
"""Rows of elements and thickness (m) of raft, wall and dome."""
SECTORS = 24


def containment() -> tuple[bm.FemModel, int]:
    """The structure, and the number of the node at the top of the dome."""
    raft, wall, dome = ROWS
    angles = np.linspace(0.0, np.pi / 2, dome + 1)[:-1]
    meridian = [
        *([radius, 0.0] for radius in np.linspace(0.0, RADIUS, raft + 1)[:-1]),
        *([RADIUS, height] for height in np.linspace(0.0, HEIGHT, wall + 1)[:-1]),
        *([RADIUS * np.cos(angle), HEIGHT + RADIUS * np.sin(angle)] for angle in angles),
        [0.0, HEIGHT + RADIUS],
    ]
    mesh = bm.Mesh.in_space()
    surface = mesh.revolve((0.0, 0.0), meridian, SECTORS)
    concrete = bm.Material(32e9, 0.2, 2450.0)
    mesh.add_shells(surface.cells, concrete, np.repeat(THICKNESS, ROWS)[surface.cell_rows])
    damping = bm.RayleighDamping.from_ratios((4.0, 25.0), (0.05, 0.05))
    return bm.FemModel(mesh, rayleigh=damping), mesh.node_at(0.0, 0.0, HEIGHT + RADIUS)


def main() -> None:
    """Runs both scenes."""
    model, top = containment()
    record = bm.el_centro_1940()
    # One record is in the package: it acts along y with 70 % and half a second later, and upwards with 40 %.
    across, up = record.scaled(0.7).padded(0.5, 0.0), record.scaled(0.4).padded(1.0, 0.0)
    soil = bm.Soil.from_shear_wave_speed(500.0, 1 / 3, 2000.0)
    probe = bm.Probe.acceleration("top", model.row(top, "x"))
    print(f"{model.dofs} degrees of freedom")
    print(f"{'':14}{'base shear, MN':>16}{'top, m/s²':>12}{'uplifted, %':>13}{'slip, mm':>10}")
    for name, law in (("bonded", bm.Bonded()), ("opens, slides", bm.Coulomb(0.5))):
        simulation = bm.Simulation(
            time_step=0.01,
            structure=model,
            ground=bm.ElasticGround.under(soil, model, 8),
            interface=law,
            motion=bm.triaxial(record, across, up),
            probes=[probe],
        )
        run = simulation.run(duration=10.0)
        shear = max(run.extremes(quantity).magnitude for quantity in ("base_shear", "shear_across"))
        values = (1e-6 * shear, np.abs(run["top"]).max(), 100 * run.uplifted_fraction.value)
        print(f"{name:14}{values[0]:16.1f}{values[1]:12.2f}{values[2]:13.1f}{1e3 * run.mean_slip.magnitude:10.2f}")
        assert run.energy_error < 1e-9


if __name__ == "__main__":
    main()
