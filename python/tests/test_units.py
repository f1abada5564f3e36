"""What a run says of its ground motion and of numbers in another unit, and where it ends."""

from __future__ import annotations

import math

import numpy as np
import pytest

import basemat as bm

SOIL = bm.Soil.from_shear_wave_speed(250.0, poisson=0.33, density=1900.0)


def built(motion: bm.FreeField, *, friction: float = 0.5, **options: object) -> bm.Simulation:
    storeys = [bm.Storey(3.0, 20e3, 40e6)] * 3
    building = bm.ShearBuilding(10.0, 50e3, 4e5, storeys, damping=0.05)
    ground = bm.ElasticGround.under(SOIL, building, 10)
    return bm.Simulation(0.01, building, ground, bm.Coulomb(friction), motion=motion, **options)  # type: ignore[arg-type]


def told(simulation: bm.Simulation, steps: int = 20) -> str:
    return "; ".join(simulation.run(steps, warn=False).warnings)


def test_pages_and_frames_state_the_motion() -> None:
    run = built(bm.el_centro_1940()).run(1000, warn=False)
    line = str(run).splitlines()[1]
    assert line.startswith("Ground motion: peak 3.127 m/s² (0.31882 g), record of 31.18 s in steps of 0.02 s")
    assert run.ground_motion["peak"] == pytest.approx(3.1266, rel=1e-4)
    assert (run.ground_motion["duration"], run.ground_motion["time_step"]) == pytest.approx((31.18, 0.02))
    assert run.ground_motion["passed"] == pytest.approx(0.676, abs=1e-3)
    assert run.time_step == 0.01 and not run.is_overturned
    pytest.importorskip("pandas")
    for frame in (run.to_frame(), run.envelope_frame(), run.foundation_frame(), run.energy_frame()):
        assert frame.attrs["ground_motion"] == line


def test_units_are_told() -> None:
    record = bm.el_centro_1940()
    assert "motion in g?" in told(built(record.scaled_to_peak(0.3)))
    assert "record in steps of 2.00e1 s" in told(built(bm.Record(20.0, record.accelerations)))
    assert "friction coefficient of 30" in told(built(record, friction=30.0))
    assert "gravity of 981" in told(built(record, initial=bm.InitialConditions(gravity=981.0)))
    assert "run ends at 5.00 s" in told(built(record), 500)


def test_a_run_ends_when_a_block_has_overturned() -> None:
    block = bm.RigidBlock(1.0, 10.0, 2000.0, p_delta=9.81)

    def falling(**options: bm.SolverOptions) -> bm.Simulation:
        ground = bm.SpringGround.under(block, 8, 2e9, 1e9, dashpots=(1e6, 1e6))
        motion = bm.el_centro_1940().scaled(2.0)
        return bm.Simulation(0.01, block, ground, bm.Coulomb(0.6), motion=motion, **options)  # type: ignore[arg-type]

    simulation = falling()
    run = simulation.run(2000, warn=False)
    assert run.is_overturned and run.steps < 2000 and abs(run["base_rotation"][-1]) > 1.0
    assert any("base turned by more than 1 rad" in text for text in run.warnings)
    assert simulation.run(5, warn=False).steps == 5
    endless = falling(solver=bm.SolverOptions(rotation_limit=math.inf)).run(2000, warn=False)
    assert endless.steps == 2000 and not endless.is_overturned
    with pytest.raises(bm.InputError, match="rotation limit"):
        falling(solver=bm.SolverOptions(rotation_limit=0.0))


def test_unsymmetric_stiffness_is_refused_unless_active() -> None:
    mass = np.diag([4e5, 4e5, 1e8, 1e4])
    mass[0, 3] = mass[3, 0] = 1e3
    stiffness = np.diag([0.0, 0.0, 0.0, 1e6])
    stiffness[2, 3] = 1e5
    contact = bm.BaseNode.rigid_base(-5.0, 5.0, [0, 1, 2])
    model = bm.MatrixModel(mass, stiffness, contact)
    ground = bm.ElasticGround.under(SOIL, model, 8)
    with pytest.raises(bm.InputError, match=r"entry \(2, 3\) is 1e5, entry \(3, 2\) 0e0"):
        bm.Simulation(0.01, model, ground, bm.Coulomb(0.5))
    active = bm.MatrixModel(mass, stiffness, contact, active_stiffness=True)
    bm.Simulation(0.01, active, ground, bm.Coulomb(0.5))


def test_moments_are_vectors_by_the_right_hand_rule() -> None:
    body = bm.RigidBody.cuboid(8.0, 6.0, 4.0, 2000.0)
    push = bm.Load.constant(body.dof("x"), 1e5)
    ground = bm.ElasticGround.under(SOIL, body, 4)
    state = bm.Simulation(0.01, body, ground, bm.Bonded(), loads=[push]).state
    assert state.force_vector[0] == pytest.approx(1e5) and state.force_vector[2] == pytest.approx(-state.normal_force)
    assert state.moment_vector[1] == state.base_moment == pytest.approx(0.0, abs=1.0)
    assert state.foundations[0].rotation_vector[1] == state.base_rotation
