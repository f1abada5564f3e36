"""GOAL: sections, forces in shells, and meshes of Gmsh in three directions, from Python.
SCENE: a raft with a wall at rest on elastic ground and in a short run; two storeys; a file that Gmsh wrote.
REFERENCE: weights and arms by hand, the law of a plate under uniform strains, resultants shell by shell, volumes of the file's parts.
"""

from __future__ import annotations

import pickle

import numpy as np
import pytest
from conftest import CRATE, same_bits

import basemat as bm

CONCRETE = bm.Material(30e9, 0.2, 2500.0)
FILE = CRATE.parent / "tests" / "data" / "gmsh" / "space.msh"
X, Y, Z = (1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0)


def raft() -> tuple[bm.FemModel, bm.Mesh, list[int]]:
    """A mat of 8 m × 8 m with a wall 3 m high along y = 2 m, and the numbers of the mat's shells."""
    mesh, line = bm.Mesh.in_space(), np.linspace(-4.0, 4.0, 5)
    x, y = np.meshgrid(line, line)
    mat = mesh.add_shells(mesh.add_grid(np.stack([x, y, 0.0 * x], axis=2)).cells, CONCRETE, 0.8)
    feet = [mesh.node_at(own, 2.0) for own in line]
    heads = mesh.add_nodes([[own, 2.0, 3.0] for own in line])
    mesh.add_shells([[*feet[k : k + 2], heads[k + 1], heads[k]] for k in range(4)], CONCRETE, 0.3)
    return bm.FemModel(mesh), mesh, mat


def test_a_section_carries_the_weight_above_and_is_a_probe() -> None:
    model, _, mat = raft()
    rows = model.section_in_space(0.0)
    assert [own.unit for own in rows] == ["N", "N", "N", "N·m", "N·m", "N·m"]
    shell = model.shell_rows(mat, (X, Z))[12]
    probes = [bm.Probe.section(f"section {k}", own) for k, own in enumerate(rows)]
    probes += [bm.Probe.section("m_11", shell.moments[0]), bm.Probe.section("q_2", shell.shears[1])]
    ground = bm.ElasticGround.under(bm.Soil(80e6, 0.25, 1900.0), model, 4)
    motion = bm.triaxial(x=bm.el_centro_1940())
    simulation = bm.Simulation(0.01, model, ground, bm.Coulomb(0.5), motion=motion, probes=probes)
    # At rest the wall hangs on nothing else; its centre lies 2 m along y.
    static, gravity = simulation.static_displacement, bm.STANDARD_GRAVITY * model.rigid_motion("z")
    found = [own.displacement.value(static) + own.acceleration.value(gravity) for own in rows]
    weight = 8.0 * 3.0 * 0.3 * 2500.0 * bm.STANDARD_GRAVITY
    assert found == pytest.approx([0.0, 0.0, weight, -2.0 * weight, 0.0, 0.0], rel=1e-6, abs=1e-6 * weight)
    moved = model.section_in_space(0.0, (0.0, 2.0))[3]
    assert abs(moved.displacement.value(static) + moved.acceleration.value(gravity)) < 1e-6 * weight
    run = simulation.run(50)
    assert run.units["section 0"] == "N" and run.units["m_11"] == "N·m/m" and run.units["q_2"] == "N/m"
    assert np.abs(run["section 0"]).max() > 0.0 and np.abs(run["m_11"]).max() > 0.0


def test_sections_of_storeys() -> None:
    mat = bm.RigidBody.cuboid(18.0, 12.0, 1.0, 2500.0)
    storey = bm.PlanStorey(3.0, 250e3, (18.0, 12.0), (4e8, 3e8, 2e10))
    building = bm.StoreyBuilding(mat, [storey, storey])
    acceleration = np.zeros(building.dofs)
    acceleration[[6, 9]] = 1.0
    found = [own.acceleration.value(acceleration) for own in building.section(0)]
    assert found == pytest.approx([-500e3, 0.0, 0.0, 0.0, -250e3 * 9.0, 0.0])
    found = [own.acceleration.value(acceleration) for own in building.section(1, reference=(0.0, 1.0))]
    assert found == pytest.approx([-250e3, 0.0, 0.0, 0.0, -250e3 * 3.0, -250e3])


def test_rows_of_shells_are_means_of_their_resultants() -> None:
    model, mesh, mat = raft()
    displacement = np.random.default_rng(7).normal(size=model.dofs)
    rows = model.shell_rows(mat, (X, Z))
    assert [own.node for own in rows] == list(range(25))
    own = {element: model.shell_resultants(element, displacement) for element in mat}
    nodes = mesh.elements
    for row in rows:
        value = row.value(displacement)
        at = [(element, nodes[element].index(row.node)) for element in mat if row.node in nodes[element]]
        each = [own[element][corner].in_axes(X, Z) for element, corner in at]
        for name in ("membrane", "moments", "shears"):
            exact = np.mean([getattr(one, name) for one in each], axis=0)
            scale = np.abs(exact).max()
            assert getattr(value, name) == pytest.approx(exact, rel=1e-9, abs=1e-9 * scale), name
            single = [part.displacement.value(displacement) for part in getattr(row, name)]
            assert single == pytest.approx(list(getattr(value, name)), rel=1e-12)
        assert row.axes == pytest.approx(np.eye(3), abs=1e-12) and value.axes == pytest.approx(row.axes)
        m_11, m_22, m_12 = value.moments
        radius = np.hypot(0.5 * (m_11 - m_22), m_12)
        assert value.principal_moments == pytest.approx([0.5 * (m_11 + m_22) + radius, 0.5 * (m_11 + m_22) - radius])


def test_uniform_strains_and_axes_by_a_function() -> None:
    model, mesh, mat = raft()
    # Stretched along x by 1e-4 and bent about y by 1e-3 1/m, with tension below.
    displacement = np.zeros(model.dofs)
    for node, (x, _, z) in enumerate(mesh.nodes):
        if z == 0.0:
            for direction, value in (("x", 1e-4 * x), ("z", 0.5e-3 * x * x), ("rotation_y", -1e-3 * x)):
                dof = model.dof_at(node, direction)  # type: ignore[arg-type]
                assert dof is not None
                displacement[dof] = value
    force, moment = 30e9 * 0.8 / 0.96 * 1e-4, 30e9 * 0.8**3 / 12 / 0.96 * 1e-3
    places = []

    def turned(x: float, y: float, z: float) -> tuple[tuple[float, ...], tuple[float, ...]]:
        places.append((x, y, z))
        return Y, Z

    for axes, order in (((X, Z), [0, 1]), (np.array([X, Z]), [0, 1]), (turned, [1, 0])):
        for row in model.shell_rows(mat, axes):
            value = row.value(displacement)
            assert value.membrane[order] == pytest.approx([force, 0.2 * force], rel=1e-6)
            assert value.moments[order] == pytest.approx([moment, 0.2 * moment], rel=1e-6)
            assert value.shears == pytest.approx([0.0, 0.0], abs=1e-6 * moment)
    assert sorted(places) == sorted(map(tuple, mesh.nodes[:25]))


@pytest.mark.parametrize(
    ("wrong", "error", "message"),
    [
        (lambda model, mat: model.section_in_space(1.0), bm.InputError, "height of the section"),
        (lambda model, mat: model.section(0.0), bm.Error, "section"),
        (lambda model, mat: model.shell_rows([99], (X, Z)), bm.InputError, "index 99"),
        (lambda model, mat: model.shell_rows(mat, (Z, Z)), bm.InputError, "direction of a shell's axis"),
        (lambda model, mat: model.shell_rows(mat, lambda x, y, z: 1.0), bm.InputError, "axes returned"),
        (lambda model, mat: model.shell_rows(mat, lambda x, y, z: 1 / 0), ZeroDivisionError, "division"),
        (lambda model, mat: model.shell_resultants(0, [0.0]), bm.InputError, "displacement of the model"),
        (lambda model, mat: model.shell_rows(mat, (X, Z))[3].value([0.0]), bm.InputError, "displacement has 1"),
        (lambda model, mat: bm.GmshSpaceMesh(FILE).mesh({"wall": CONCRETE}), bm.FileError, "volume 'wall'"),
        (lambda model, mat: bm.GmshSpaceMesh(FILE).mesh({"wall": (CONCRETE, 0.2)}), bm.FileError, "part for"),
        (lambda model, mat: bm.GmshSpaceMesh(FILE).mesh({"wall": 0.2}), TypeError, "must be a Material"),  # type: ignore[dict-item]
        (lambda model, mat: bm.GmshSpaceMesh(FILE).cells(3, "wall"), bm.FileError, "volume 'wall'"),
    ],
)
def test_errors_name_the_quantity(wrong, error: type[Exception], message: str) -> None:
    model, _, mat = raft()
    with pytest.raises(error, match=message):
        wrong(model, mat)


def test_a_mesh_of_gmsh_has_the_mass_of_its_parts() -> None:
    read = bm.GmshSpaceMesh(FILE)
    groups = [["head"], ["beam", "column", "edge"], ["base", "wall"], ["block"]]
    assert [read.groups(dimension) for dimension in range(4)] == groups
    [[head]] = read.cells(0, "head")
    assert read.nodes[head].tolist() == [4.0, 0.0, 3.0] and len(read.cells(2, "base")) == 16
    section = bm.BeamSection(0.2, (0.002, 0.004), 0.003)
    mesh = read.mesh(
        {
            "block": bm.Material(1e9, 0.3, 2000.0),
            "wall": (CONCRETE, 0.25),
            "column": (CONCRETE, section, X),
            "beam": (CONCRETE, section, Z),
        }
    )
    assert same_bits(mesh.nodes, read.nodes)
    model = bm.FemModel(mesh, read.cells(2, "base"))
    exact = 2000.0 * 4.0 * 3.0 * 0.8 + 2500.0 * 3.0 * 3.0 * 0.25 + 2500.0 * 0.2 * (3.0 + 4.0)
    for direction in ("x", "y", "z"):
        motion = model.rigid_motion(direction)
        assert motion @ model.mass() @ motion == pytest.approx(exact, rel=1e-9)
    wall = {tuple(own) for own in read.cells(2, "wall")}
    shells = [number for number, own in enumerate(mesh.elements) if tuple(own) in wall]
    rows = model.shell_rows(shells, (Y, X))
    assert len(shells) == len(wall) == 64 and {own.node for own in rows} == set().union(*wall)
    left_out = read.mesh({"block": bm.Material(1e9, 0.3, 2000.0), "wall": None, "column": None, "beam": None})
    assert len(left_out.elements) == 32
    again = pickle.loads(pickle.dumps(mesh))
    assert same_bits(again.nodes, mesh.nodes) and again.elements == mesh.elements
    assert same_bits(bm.FemModel(again).mass(), bm.FemModel(mesh).mass())
