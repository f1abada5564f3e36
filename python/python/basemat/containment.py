"""El Centro on a containment that may uplift and slide: ``python -m basemat.containment``.

The problem of Patel & Spyrakos, "Uplifting-sliding response of flexible structures to seismic
loads": bonded, uplift only, friction 0.4, 0.3 and 0.2. Contact length and height are calibrated on
the first two rows of the paper's Table 1; what else is not printed is assumed: see docs/paper.md of
the repository.
"""

from __future__ import annotations

import argparse
import math
from pathlib import Path
from typing import NamedTuple

import basemat as bm

FOOT = 0.3048
"""m."""
PSF = 47.88025898033584
"""Pa."""
SLUG_PER_CUBIC_FOOT = 515.3788183932295
"""kg/m³."""
WIDTH, HEIGHT = 34.0, 80.0
"""Contact length and height, ft; calibrated."""
LAYERS, ELEMENTS = 13, 10
"""Layers of rectangles, the lowest of them (assumed) the basemat, and elements along the base."""
SHEAR_SPEED, PRESSURE_SPEED, SOIL_DENSITY = 650.0, 1300.0, 3.5
"""Wave speeds of the soil, ft/s, and its density (assumed), slug/ft³."""
PAPER_SHEARS = {None: 28970.0, math.inf: 20130.0, 0.4: 10233.0, 0.3: 6415.0, 0.2: 5958.0}
"""Peak base shears of the paper's Table 1, printed in lb, by friction (None: bonded)."""

NOTE = (
    "ratio: shear over that of the bonded case; paper: the same ratio of the printed Table 1. The\n"
    "length and height are calibrated on its bonded and uplift-only rows: only the sliding rows can\n"
    "be judged by it"
)
"""What the columns ratio and paper mean."""


class Scene(NamedTuple):
    """A case, ready to run: to the end of the record in ``steps`` steps."""

    simulation: bm.Simulation
    steps: int


def time_step() -> float:
    """The time in which a P wave crosses half an element, s."""
    return 0.5 * (WIDTH / ELEMENTS) / PRESSURE_SPEED


def structure() -> bm.FemModel:
    """The finite elements: a basemat and the superstructure on it, fully integrated."""
    height = HEIGHT * FOOT / LAYERS
    half = 0.5 * WIDTH * FOOT
    basemat = bm.Material(106_560_369.0 * PSF, 1.0 / 3.0, 3.04348 * SLUG_PER_CUBIC_FOOT)
    above = bm.Material(106_577_648.0 * PSF, 1.0 / 3.0, 0.59006 * SLUG_PER_CUBIC_FOOT)
    layers = [
        bm.Layer(height, 1, basemat, formulation="full"),
        bm.Layer(height * (LAYERS - 1), LAYERS - 1, above, formulation="full"),
    ]
    return bm.FemModel(bm.Mesh.layered_block(-half, half, ELEMENTS, layers))


def probes(model: bm.FemModel) -> list[bm.Probe]:
    """Motion of a roof corner, and the shear of the superstructure on the basemat."""
    height = HEIGHT * FOOT / LAYERS
    corner = model.node_at(-0.5 * WIDTH * FOOT, height + height * (LAYERS - 1))
    feet = bm.DofCombination([])
    for line in model.base():
        for node in line:
            feet = feet + node.horizontal
    sway = model.row(corner, "x") - (1.0 / len(feet.terms)) * feet
    shear, _, _ = model.section(height)
    return [
        bm.Probe.absolute_displacement("roof x", model.row(corner, "x")),
        bm.Probe.absolute_displacement("roof y", model.row(corner, "y")),
        bm.Probe.section("base shear", shear),
        bm.Probe.displacement("sway", sway),
    ]


def scene(friction: float | None, record: bm.Record | None = None, steps: int | None = None) -> Scene:
    """A case: bonded for None, opening but never sliding for infinite friction."""
    record = bm.el_centro_1940() if record is None else record
    if steps is None:
        steps = max(1, math.floor(record.duration / time_step() + 0.5))
    half = 0.5 * WIDTH * FOOT
    soil = bm.Soil.from_wave_speeds(
        SHEAR_SPEED * FOOT, PRESSURE_SPEED * FOOT, SOIL_DENSITY * SLUG_PER_CUBIC_FOOT
    )
    model = structure()
    law: bm.InterfaceLaw = bm.Bonded() if friction is None else bm.Coulomb(friction)
    simulation = bm.Simulation(
        time_step(),
        model,
        # Equal elements, as in the paper.
        bm.ElasticGround(soil, bm.Strip(-half, half, ELEMENTS, grading="uniform")),
        law,
        motion=record,
        solver=bm.SolverOptions(expected_steps=steps),
        probes=probes(model),
    )
    return Scene(simulation, steps)


def name(friction: float | None) -> str:
    """Name of a case."""
    if friction is None:
        return "bonded"
    return "uplift only" if math.isinf(friction) else f"friction {friction:g}"


def row(friction: float | None, run: bm.Run, bonded: float) -> str:
    """A line of the table."""
    shear = run.probes["base shear"].magnitude
    paper = PAPER_SHEARS.get(friction)
    ratio = "–" if paper is None else f"{paper / PAPER_SHEARS[None]:.3f}"
    return (
        f"{name(friction):<13}{1e-3 * shear:>10.1f}{shear / bonded:>8.3f}{ratio:>8}"
        f"{100.0 * run.uplifted_fraction.value:>9.0f}{1e3 * abs(run.largest_slip.value):>9.3f}"
        f"{1e3 * run.residual_slip + 0.0:>10.3f}{1e3 * run.probes['roof x'].magnitude:>9.2f}"
        f"{run.energy_error:>9.0e}{run.wall:>7.2f}"
    )


def main(arguments: list[str] | None = None) -> None:
    """Runs the cases and prints their table."""
    parser = argparse.ArgumentParser(prog="python -m basemat.containment", description=__doc__)
    parser.add_argument("--friction", type=float, nargs="*", default=[0.4, 0.3, 0.2])
    parser.add_argument("--duration", type=float, help="seconds; the whole record unless given")
    parser.add_argument("--csv", type=Path, help="folder for the time series (needs pandas)")
    parser.add_argument("--progress", action="store_true", help="a line of progress on stderr")
    options = parser.parse_args(arguments)
    steps = None if options.duration is None else max(1, round(options.duration / time_step()))
    cases: list[float | None] = [None, math.inf, *options.friction]
    print(
        f"{'':<13}{'shear':>10}{'ratio':>8}{'paper':>8}{'uplift':>9}{'slip':>9}{'residual':>10}"
        f"{'roof x':>9}{'energy':>9}{'run':>7}\n"
        f"{'case':<13}{'kN/m':>10}{'':>16}{'%':>9}{'mm':>9}{'mm':>10}{'mm':>9}{'error':>9}{'s':>7}"
    )
    bonded = 1.0
    for friction in cases:
        simulation, count = scene(friction, steps=steps)
        run = simulation.run(count, progress=options.progress)
        if friction is None:
            bonded = run.probes["base shear"].magnitude
        print(row(friction, run, bonded), flush=True)
        if options.csv is not None:
            options.csv.mkdir(parents=True, exist_ok=True)
            run.to_frame().to_csv(options.csv / f"{name(friction).replace(' ', '_')}.csv")
    print(NOTE)


if __name__ == "__main__":
    main()
