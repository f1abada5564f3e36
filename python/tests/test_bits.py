"""Results are Rust's, bit for bit."""

from __future__ import annotations

import math
import subprocess
from pathlib import Path

import numpy as np
import pytest
from conftest import same_bits

import basemat as bm
from basemat import containment

SERIES = [
    "time",
    "base_shear",
    "base_moment",
    "normal_force",
    "uplifted_fraction",
    "mean_slip",
    "largest_slip",
    "base_rotation",
    "settlement",
    "rocking_work",
    "free_field_horizontal",
    "free_field_vertical",
    "sliding_safety",
    "overturning_safety",
    "roof x",
    "roof y",
    "base shear",
    "sway",
]


def rusts(reference: Path, *arguments: str) -> np.ndarray:
    """Time series as Rust has them, a column each."""
    command = [str(reference), *arguments]
    text = subprocess.run(command, check=True, capture_output=True, text=True).stdout
    bits = [[int(word, 16) for word in line.split()] for line in text.splitlines()]
    return np.array(bits, np.uint64).view(np.float64)


@pytest.mark.parametrize("friction", [None, math.inf, 0.2])
def test_containment(reference: Path, friction: float | None) -> None:
    steps = 5000
    name = "bonded" if friction is None else repr(friction)
    rust = rusts(reference, "containment", name, str(steps))
    run = containment.scene(friction, steps=steps).simulation.run(steps)
    assert rust.shape == (steps + 1, len(SERIES) + 1)
    for column, key in enumerate(SERIES):
        assert same_bits(run[key], np.ascontiguousarray(rust[:, column])), key
    assert same_bits(run.energy_balances["input"], np.ascontiguousarray(rust[:, -1]))
    # It shook, and where it may it opened: zeros would be equal, too.
    assert run.base_shear.magnitude > 1.0e5
    assert (run.uplifted_fraction.value > 0.0) == (friction is not None)


def block(friction: float) -> bm.Simulation:
    body, record = bm.RigidBody.cuboid(8.0, 8.0, 10.0, 400.0), bm.el_centro_1940()
    motion = bm.triaxial(record, record.scaled(0.8), record.scaled(0.5))
    ground = bm.ElasticGround.under(bm.Soil(80e6, 0.25, 1900.0), body, 4)
    return bm.Simulation(0.01, body, ground, bm.Coulomb(friction), motion=motion)


def storeys(friction: float) -> bm.Simulation:
    mat = bm.RigidBody.cuboid(18.0, 12.0, 1.0, 2500.0)
    storey = bm.PlanStorey(3.2, 250e3, (18.0, 12.0), (4e8, 3e8, 2e10), stiffness_center=(-4.0, 0.0))
    law = bm.Bilinear(3e8, 1e6, 0.1)
    building = bm.StoreyBuilding(mat, [storey] * 3, laws={(0, "y"): law})
    wave = bm.PlaneWave.sh(bm.Soil(80e6, 0.25, 1900.0), 0.5)
    motion = wave.field_from_across(bm.el_centro_1940(), -12.0, azimuth=0.6)
    ground = bm.SpringGround.under(building, 4, 30e6, 20e6, dashpots=(4e5, 3e5))
    return bm.Simulation(0.01, building, ground, bm.Coulomb(friction), motion=motion)


def raft(friction: float) -> bm.Simulation:
    concrete, record = bm.Material(30e9, 0.2, 2500.0), bm.el_centro_1940()
    mesh = bm.Mesh.in_space()
    x, y = np.meshgrid(2.0 * np.arange(7) - 6.0, 2.0 * np.arange(5) - 4.0)
    mesh.add_shells(mesh.add_grid(np.stack([x, y, 0.0 * x], axis=2)).cells, concrete, 0.8)
    tower = [mesh.node_at(0.0, 0.0), *mesh.add_nodes([[0.0, 0.0, z] for z in (4.0, 8.0, 12.0)])]
    section = bm.BeamSection(1.5, (0.2, 0.25), 0.3, shear_areas=(1.2, 1.25))
    mesh.add_space_beams(list(zip(tower, tower[1:])), concrete, section, (1.0, 0.0, 0.0))
    mesh.add_mass(tower[-1], 200e3, rotary_inertia=(4e5, 5e5, 6e5))
    model = bm.FemModel(mesh, rayleigh=bm.RayleighDamping(0.2, 1e-3))
    motion = bm.triaxial(record, record.scaled(0.8), record.scaled(0.5))
    ground = bm.ElasticGround.under(bm.Soil(80e6, 0.25, 1900.0), model, 4)
    return bm.Simulation(0.01, model, ground, bm.Coulomb(friction), motion=motion)


@pytest.mark.parametrize(("scene", "steps"), [(block, 400), (storeys, 400), (raft, 300)])
def test_scenes_in_plan(reference: Path, scene, steps: int) -> None:
    rust = rusts(reference, scene.__name__, "0.15", str(steps))
    run = scene(0.15).run(steps)
    names = list(run.series)
    assert len(names) == 25 and rust.shape == (steps + 1, len(names) + 1)
    for column, key in enumerate(names):
        assert same_bits(run[key], np.ascontiguousarray(rust[:, column])), key
    # It twisted, lifted and slid.
    assert abs(run.extremes("twist").magnitude) > 0.0 and run.largest_slip.value > 1e-4
    assert run.energy_error < 1e-9


def test_steps_and_runs_are_the_same(rocking) -> None:
    whole = rocking(solver=bm.SolverOptions(expected_steps=300))
    run = whole.run(300, motion_every=1)
    parts = rocking(solver=bm.SolverOptions(expected_steps=300))
    shears = [parts.state.base_shear]
    shears += [state.base_shear for state in parts.steps(100)]
    shears += list(parts.run(120)["base_shear"][1:])
    shears += [parts.step().base_shear for _ in range(80)]
    assert same_bits(np.array(shears), run["base_shear"])
    assert same_bits(parts.state.displacement, run.motion["displacement"][-1])


def test_python_structure_and_law_give_the_same_bits(soil: bm.Soil, rocking, block) -> None:
    class Own:
        dofs = 3

        def base(self):
            return block.base()

        def mass(self):
            return block.mass()

        def stiffness(self):
            return np.zeros((3, 3))

    class Friction:
        modes = ("stick", "slip_left", "slip_right", "open")
        friction_coefficient = 0.4
        law = bm.Coulomb(0.4)

        def conditions(self, mode, start):
            return self.law.conditions(mode, start)

        def next_mode(self, mode, start, trial, tolerance):
            return self.law.next_mode(mode, start, trial, tolerance)

    own = Own()
    expected = rocking(0.4).run(400)
    assert expected.uplifted_fraction.value > 0.2
    for parts in (
        {"structure": own},
        {"ground": bm.ElasticGround.under(soil, own, 8)},
        {"interface": Friction()},
        {"interface": [Friction()] * 8},
        {"interface": bm.VariableFriction(lambda start: 0.4)},
    ):
        run = rocking(0.4, **parts).run(400)
        for key in ("base_shear", "base_moment", "largest_slip", "roof"):
            assert same_bits(run[key], expected[key]), (parts, key)
