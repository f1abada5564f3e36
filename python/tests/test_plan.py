"""GOAL: three directions from Python: bodies, grounds in plan, records along x, y and up, impedances.
SCENE: blocks and a cylinder on soil, bonded or with friction; waves through layers.
REFERENCE: volumes, a square punch's stiffness, the same scene turned by a right angle or mirrored, factors of safety by hand.
"""

from __future__ import annotations

import pickle

import numpy as np
import pytest

import basemat as bm

SOIL = bm.Soil(80e6, 0.25, 1900.0)
RECORD = bm.el_centro_1940()


def shaken(motion: bm.FreeField) -> bm.Run:
    body = bm.RigidBody.cuboid(8.0, 8.0, 10.0, 400.0)
    probes = [bm.Probe.displacement(name, body.dof(name)) for name in ("x", "y", "rx", "ry")]
    simulation = bm.Simulation(
        time_step=0.01,
        structure=body,
        ground=bm.ElasticGround.under(SOIL, body, 3),
        interface=bm.Bonded(),
        motion=motion,
        probes=probes,
    )
    return simulation.run(300)


def test_bodies_have_their_mass() -> None:
    assert bm.RigidBody.cuboid(2.0, 3.0, 4.0, 500.0).total_mass == pytest.approx(12e3)
    assert bm.RigidBody.cylinder(2.0, 3.0, 500.0).total_mass == pytest.approx(500.0 * 12.0 * np.pi)
    with pytest.raises(bm.InputError, match="must be"):
        bm.RigidBody.cylinder(-2.0, 3.0, 500.0)


def test_a_square_block_answers_alike_along_x_and_y() -> None:
    along, across = shaken(bm.triaxial(x=RECORD)), shaken(bm.triaxial(y=RECORD))
    assert along.energy_error < 1e-9
    largest = np.abs(along["x"]).max()
    assert largest > 1e-4
    np.testing.assert_allclose(along["x"], across["y"], rtol=0.0, atol=1e-9 * largest)
    np.testing.assert_allclose(along["ry"], -across["rx"], rtol=0.0, atol=1e-9 * largest)
    assert np.abs(along["y"]).max() < 1e-9 * largest
    for run, end, moment in ((along, "", "base_moment"), (across, "_across", "moment_across")):
        # N times the half width, over the moment.
        safety = run["overturning_safety" + end]
        np.testing.assert_allclose(1.0 / safety, np.abs(run[moment]) / (4.0 * run["normal_force"]), rtol=1e-9, atol=1e-12)
        assert run.least_overturning_safety.value == safety.min() < 100.0
        assert run.extremes("overturning_safety" + end).lowest == run.least_overturning_safety


def test_bodies_beside_each_other_answer_like_mirrored_ones() -> None:
    body, other = (bm.RigidBody.cuboid(6.0, 6.0, 8.0, 400.0, center=(0.0, y)) for y in (-6.0, 6.0))
    pair = bm.StructureGroup([(body, 1.0), (other, 1.0)])
    assert pair.row(1, other.dof("y")).terms == [(7, 1.0)]
    ground = bm.ElasticGround.under(SOIL, pair, 3)
    simulation = bm.Simulation(0.01, pair, ground, bm.Coulomb(0.3), motion=bm.triaxial(x=RECORD))
    run = simulation.run(300, motion_every=100)
    front, back = run.foundations
    assert front.ends == back.ends == [-2.0, 4.0] and (front.depth, back.depth) == ([-9.0, -3.0], [3.0, 9.0])
    assert run.foundation_frame()["back"].tolist() == [-3.0, 9.0]
    # Each feels the other through the soil.
    for name, sign in (("base_shear", 1.0), ("shear_across", -1.0), ("torque", -1.0)):
        one, two = front.extremes(name), back.extremes(name)
        assert one.magnitude > 1.0 and one.highest.value > 0.0
        mirrored = two.highest if sign > 0.0 else two.lowest
        assert one.highest.value == pytest.approx(sign * mirrored.value, rel=1e-6)
    assert run.motion["free_field_across"].tolist() == [0.0] * 4


def test_the_base_carries_what_stands_on_it() -> None:
    """Rows of a rigid body are the motions of its base."""
    body = bm.RigidBody.cuboid(8.0, 6.0, 10.0, 400.0, center=(3.0, -2.0))
    moved = np.array([0.3, 0.1, 0.2, 0.01, 0.02, 0.03])
    for place in ((0.0, 0.0, 0.0), (4.0, 3.0, 10.0)):
        carried = bm.DofCombination.of_base(body, place)
        found = [row.value(moved) for row in carried]
        assert found == pytest.approx([row.value(moved) for row in body.displacement_at(*place)], rel=1e-12)
    block = bm.RigidBlock(6.0, 9.0, 400.0)
    right, away, up = bm.DofCombination.of_base(block, (2.0, 5.0, 9.0))
    assert away.terms == [] and up.value([0.3, 0.1, 0.02]) == pytest.approx(0.1 + 2.0 * 0.02)
    assert (block.horizontal_at(9.0) - right).value([0.3, 0.1, 0.02]) == pytest.approx(0.0, abs=1e-15)


def test_sh_waves_through_layers_of_the_same_soil_are_plane_waves_from_deeper() -> None:
    profile = bm.SoilProfile([bm.SoilLayer(SOIL, 7.0), bm.SoilLayer(SOIL, 5.0)], SOIL)
    wave, plane = bm.InclinedWave.sh(profile, 0.5), bm.PlaneWave.sh(SOIL, 0.5)
    assert wave.apparent_velocity == pytest.approx(plane.apparent_velocity)
    layered, bare = wave.field(RECORD, -5.0, azimuth=0.3), plane.field_from_across(RECORD, -5.0, azimuth=0.3)
    later = 12.0 * np.cos(0.5) / SOIL.shear_wave_speed
    for time in (1.0, 2.5, 6.0):
        x, y, up = bare.displacement_at(2.0, 1.0, time - later)
        assert layered.displacement_at(2.0, 1.0, time) == pytest.approx([x, y, up], rel=1e-3, abs=3e-5)
        assert abs(x) + abs(y) > 1e-3 and up == 0.0
    with pytest.raises(bm.InputError, match="vertical"):
        wave.field(RECORD, -5.0, control="outcrop_vertical")


def test_impedances_are_those_of_a_square_punch() -> None:
    square = [[(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)]]
    plan = bm.Plan(square, 8)
    assert len(plan) == 64
    found = plan.impedances(SOIL, [0.0, 1.0], contact="relaxed")
    assert found.shape == (2, 6, 6) and found.dtype == complex
    # 4.6092 μ/(1 − ν) for a side of 2 m.
    assert found[0, 2, 2].real * 0.75 / 80e6 == pytest.approx(4.6092, rel=2e-3)
    assert np.allclose(found[1], found[1].T, rtol=1e-9, atol=1.0)


def test_pickles() -> None:
    for made in (bm.RigidBody.cylinder(2.0, 3.0, 500.0), bm.Plan.disc((0.0, 1.0), 2.0, 6)):
        again = pickle.loads(pickle.dumps(made))
        assert type(again) is type(made) and repr(again) == repr(made)
    with pytest.raises(bm.InputError, match="record"):
        bm.triaxial()
