"""GOAL: concentrated hinges from Python: laws, surfaces, states.
SCENE: a column on a mat that lifts off, with a hinge at its foot, shaken; a mast in space.
REFERENCE: closed forms; the same moment–rotation law by another class.
"""

from __future__ import annotations

import pickle
from typing import Any

import numpy as np
import pytest
from conftest import same_bits

import basemat as bm

MOMENT = 400e3
STIFFNESS = 200.0 * MOMENT
LAW = bm.BilinearMoment(MOMENT, STIFFNESS, 0.01)
pytestmark = pytest.mark.filterwarnings("ignore::basemat.BasematWarning")


def column(law: Any = LAW, surface: Any = None) -> bm.Mesh:
    """A mat of 4 m with a column in the middle, a hinge at its foot (element 2) and a mass on its top."""
    mesh = bm.Mesh([[-2.0, 0.0], [0.0, 0.0], [2.0, 0.0], [0.0, 0.0], [0.0, 6.0]])
    mesh.add_beams([[0, 1], [1, 2]], 30e9, 1.0, 0.1, 2500.0)
    if surface is None:
        assert mesh.add_hinges([[1, 3]], law, 1e11) == [2]
    else:
        stiffness = [1e10, 1e11]
        mesh.add_interaction_hinges([[1, 3]], [0.0, 1.0], stiffness, STIFFNESS, surface, hardening_ratio=0.01)
    mesh.add_beams([[3, 4]], 30e9, 0.5, 0.02, 2500.0)
    mesh.add_mass(4, 40e3)
    return mesh


def shaken(mesh: bm.Mesh) -> tuple[bm.Run, bm.HingeState]:
    model = bm.FemModel(mesh, [0, 1, 2])
    ground = bm.SpringGround.under(model, 8, 2e8, 2e8)
    motion = bm.el_centro_1940().scaled(2.0)
    simulation = bm.Simulation(0.005, model, ground, bm.Coulomb(0.6), motion=motion)
    run = simulation.run(1000)
    return run, simulation.hinge_state(2)


def test_a_column_yields_at_its_foot() -> None:
    run, state = shaken(column())
    assert run.energy_error < 1e-9
    assert run.energy_balance.hysteresis > 0.0
    assert abs(state.moment[2]) < 1.1 * MOMENT
    plastic = state.rotation[2] - state.moment[2] / STIFFNESS
    np.testing.assert_allclose(state.plastic_rotation[2], plastic, rtol=1e-9)
    # No moment beside that about z, and the weight of column and mass as compression along y.
    assert state.moment[0] == state.moment[1] == 0.0
    assert state.force[1] < 0.0
    np.testing.assert_array_equal(state.axes, np.eye(3))
    again = pickle.loads(pickle.dumps(state))
    assert same_bits(again.moment, state.moment)


def test_a_law_of_fibres_is_a_law_of_moments() -> None:
    expected = shaken(column())[1]
    computed = shaken(column(bm.BilinearSteel(MOMENT, STIFFNESS, 0.01)))[1]
    assert same_bits(expected.moment, computed.moment)
    curved = shaken(column(bm.MenegottoPinto(MOMENT, STIFFNESS, 0.01)))[0]
    assert curved.energy_error < 1e-9


def test_surfaces_have_their_closed_forms() -> None:
    corners = [[1e6, 0.0], [0.0, 5e5], [-2.5e6, 9e5], [-6e6, 0.0], [-2.5e6, -9e5], [0.0, -5e5]]
    for surface, force, moment in (
        (bm.AxialMomentSurface.rectangle(2e6, 3e5), -1e6, 0.75 * 3e5),
        (bm.AxialMomentSurface.ellipse(2e6, 3e5), 1.2e6, 0.8 * 3e5),
        (bm.AxialMomentSurface.polygon(np.array(corners)), -1.25e6, 7e5),
    ):
        np.testing.assert_allclose(surface.moments_at(force), [-moment, moment], rtol=1e-12)
        assert surface.moments_at(7e6) is None
        again = pickle.loads(pickle.dumps(surface))
        assert again.moments_at(force) == surface.moments_at(force)
    run, state = shaken(column(surface=bm.AxialMomentSurface.rectangle(3e6, MOMENT)))
    assert run.energy_error < 1e-9
    assert abs(state.moment[2]) < 1.1 * MOMENT


def test_meshes_with_hinges_pickle() -> None:
    mesh = column()
    again = pickle.loads(pickle.dumps(mesh))
    assert same_bits(shaken(again)[1].moment, shaken(mesh)[1].moment)


def test_hinges_in_space() -> None:
    mesh = bm.Mesh.in_space([[0.0, 0.0, 0.0], [0.0, 0.0, 0.0]])
    hinge = mesh.add_space_hinges(
        [[0, 1]], [0, 0, 1], [1, 0, 0], 1e10, [1e8, 5e7, 5e7], [3e5, 3e5], hardening_ratio=0.01
    )
    assert hinge == [0]


def test_errors_name_what_is_wrong() -> None:
    with pytest.raises(bm.Error, match="plastic moment of the hinge"):
        bm.BilinearMoment(-1.0, 1.0, 0.0)
    with pytest.raises(bm.Error, match="corners of the yield surface"):
        bm.AxialMomentSurface.polygon([[1.0, 0.0], [0.0, 1.0]])
    mesh = bm.Mesh([[0.0, 0.0], [0.0, 1.0]])
    with pytest.raises(bm.Error, match="distance of the nodes"):
        mesh.add_hinges([[0, 1]], LAW, 1e11)
    mesh.add_hinges([[0, 1]], LAW, 1e11, rigid_arm=True)
    with pytest.raises(bm.Error, match="rigid links or ties"):
        bm.FemModel(column(surface=bm.AxialMomentSurface.ellipse(3e6, MOMENT)), [0, 1, 2], ties=[(1, [3])])
