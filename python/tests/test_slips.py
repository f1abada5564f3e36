"""GOAL: slips that users make are answered by what to do, in a whole sentence that names the cause.
SCENE: a dict of probes, a matrix that is not symmetric, a modulus in GPa, a mesh without a base, a count that is raised.
REFERENCE: the words of the message; numbers of elements as the ground has them.
"""

from __future__ import annotations

import numpy as np
import pytest

import basemat as bm

SOIL = bm.Soil.from_shear_wave_speed(200.0, 0.33, 1900.0)
BLOCK = bm.RigidBlock(6.0, 9.0, 1000.0)


def test_a_dict_of_probes_is_answered_by_the_list_of_its_values() -> None:
    probes = {"roof": bm.Probe.acceleration("roof", BLOCK.horizontal_at(9.0))}
    ground = bm.ElasticGround.under(SOIL, BLOCK, 4)
    with pytest.raises(TypeError, match=r"of the type dict, but must be a list of Probe without keys: list\(….values\(\)\)"):
        bm.Simulation(0.01, BLOCK, ground, bm.Coulomb(0.5), probes=probes)  # type: ignore[arg-type]
    assert bm.Simulation(0.01, BLOCK, ground, bm.Coulomb(0.5), probes=list(probes.values())).probe_names == ["roof"]


def test_the_matrix_that_is_not_symmetric_is_named() -> None:
    mass, rows = np.diag([50e3, 50e3, 4e5, 2e4]), np.array([[-1.0, 0.0, 3.0, 1.0]])
    stiffness, base = 4e7 * rows.T @ rows, bm.BaseNode.rigid_base(-3.0, 3.0, [0, 1, 2])
    odd = stiffness.copy()
    odd[0, 3] *= 1.1
    for damping in (None, 0.004 * odd):
        with pytest.raises(bm.InputError, match=r"^stiffness matrix must be symmetric: entry \(0, 3\)"):
            model = bm.MatrixModel(mass, odd, base, damping=damping)
            bm.Simulation(0.01, model, bm.ElasticGround.under(SOIL, model, 4), bm.Coulomb(0.5))
    with pytest.raises(bm.InputError, match=r"^damping matrix must be symmetric: entry \(0, 3\)"):
        bm.MatrixModel(mass, stiffness, base, damping=0.004 * odd)
    with pytest.raises(bm.InputError, match=r"^damping matrix must be symmetric: entry \(0, 3\)"):
        bm.MatrixModel(mass, odd, base, damping=0.004 * odd, active_stiffness=True)


def raft(modulus: float) -> bm.FemModel:
    mesh, line = bm.Mesh.in_space(), np.linspace(-4.0, 4.0, 9)
    x, y = np.meshgrid(line, line)
    mesh.add_shells(mesh.add_grid(np.stack([x, y, 0.0 * x], axis=2)).cells, bm.Material(modulus, 0.2, 2500.0), 0.5)
    return bm.FemModel(mesh)


def test_a_modulus_in_gpa_is_a_question_of_units() -> None:
    model = raft(30.0)
    with pytest.raises(bm.InputError, match=r"its flexible base needs (about )?\d+.*check the units \(moduli in Pa, lengths in m"):
        simulation = bm.Simulation(0.01, model, bm.ElasticGround.under(SOIL, model, 8), bm.Coulomb(0.5))
        raise bm.InputError("; ".join(simulation.run(1, warn=False).warnings))
    model = raft(30e9)
    run = bm.Simulation(0.01, model, bm.ElasticGround.under(SOIL, model, 8), bm.Coulomb(0.5)).run(1, warn=False)
    assert not any("units" in text for text in run.warnings)


def test_a_mesh_without_a_base_is_told_what_a_base_is() -> None:
    mesh = bm.Mesh.in_space()
    nodes = [mesh.add_node(0.0, 0.0, 3.0 * k) for k in range(2)]
    mesh.add_space_beams([nodes], bm.Material(30e9, 0.2, 2500.0), bm.BeamSection(0.1, (1e-3, 1e-3), 2e-3), (1.0, 0.0, 0.0))
    with pytest.raises(bm.InputError, match="must have shells or sides of solids at the lowest height .*: add them there, or name"):
        bm.FemModel(mesh)


def test_a_ground_prints_the_number_of_its_elements() -> None:
    line = np.linspace(-3.0, 3.0, 13)
    mesh = bm.Mesh.in_space()
    x, y = np.meshgrid(line, line)
    mesh.add_shells(mesh.add_grid(np.stack([x, y, 0.0 * x], axis=2)).cells, bm.Material(30e9, 0.2, 2500.0), 0.5)
    ground = bm.ElasticGround.under(SOIL, bm.FemModel(mesh), 4)
    assert len(ground.elements) >= 144
    assert repr(ground).endswith(f", 4)  # {len(ground.elements)} elements")
    assert repr(bm.ElasticGround.under(SOIL, BLOCK, 4)).endswith("4)  # 4 elements")
