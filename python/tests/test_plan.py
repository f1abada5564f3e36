"""GOAL: three directions from Python: bodies, grounds in plan, records along x, y and up, impedances.
SCENE: a square block and a cylinder on soil, bonded.
REFERENCE: volumes, a square punch's stiffness, the same scene turned by a right angle.
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
