"""GOAL: finite elements in three directions from Python: nodes, shells, bricks, beams, links, bases, arrays of other programs.
SCENE: a tank, a block, beams and springs alone; a raft with a tower that lifts and slides under El Centro.
REFERENCE: stiffnesses of beams and bars by hand, Euler's load, masses, rigid motions, the same mesh from generator and arrays.
"""

from __future__ import annotations

import math
import pickle
from typing import NamedTuple

import numpy as np
import pytest
from conftest import same_bits

import basemat as bm

CONCRETE = bm.Material(30e9, 0.2, 2500.0)
SQUARE = bm.BeamSection(0.25, (5.2e-3, 5.2e-3), 8.8e-3)
SIX = ("x", "y", "z", "rotation_x", "rotation_y", "rotation_z")
SOIL = bm.Soil(80e6, 0.25, 1900.0)


class Block(NamedTuple):
    """A block of cells as meshio has it."""

    type: str
    data: np.ndarray


def tank() -> tuple[bm.Mesh, bm.Grid, np.ndarray]:
    """A bottom with a pole and a wall, and the thickness of each cell."""
    mesh = bm.Mesh.in_space()
    meridian = [[0.0, 0.0], [2.5, 0.0], [5.0, 0.0], [5.0, 2.0], [5.0, 4.0]]
    grid = mesh.revolve((1.0, -2.0), meridian, 12)
    return mesh, grid, np.where(grid.cell_rows < 2, 0.5, 0.3)


def raft(**options: object) -> tuple[bm.FemModel, int]:
    """A mat of shells with a tower, and the number of the tower's top."""
    mesh = bm.Mesh.in_space()
    x, y = np.meshgrid(np.linspace(-4.0, 4.0, 5), np.linspace(-4.0, 4.0, 5))
    mesh.add_shells(mesh.add_grid(np.stack([x, y, 0.0 * x], axis=2)).cells, CONCRETE, 0.8)
    foot, top = mesh.node_at(0.0, 0.0), mesh.add_node(0.0, 0.0, 12.0)
    section = bm.BeamSection(1.0, (0.1, 0.1), 0.15)
    mesh.add_space_beams([[foot, top]], CONCRETE, section, (1.0, 0.0, 0.0))
    mesh.add_mass(top, 150e3, rotary_inertia=(3e5, 3e5, 3e5))
    return bm.FemModel(mesh, **options), top  # type: ignore[arg-type]


def copied(value: object) -> object:
    return pickle.loads(pickle.dumps(value))


def stiffness(mesh: bm.Mesh) -> np.ndarray:
    """Of a mesh with a shell of its own to stand on, without the shell's degrees of freedom: nodes 4 and 5."""
    return bm.FemModel(mesh, [0, 1, 2, 3]).stiffness()[24:, 24:]


def pair(length: float = 2.0) -> bm.Mesh:
    """A shell on the nodes 0 to 3 far away, and nodes 4 and 5 along x."""
    mesh = bm.Mesh.in_space([[50.0, 0, 0], [51, 0, 0], [51, 1, 0], [50, 1, 0], [0, 0, 3], [length, 0, 3]])
    mesh.add_shells([[0, 1, 2, 3]], CONCRETE, 0.5)
    return mesh


def test_arrays_and_generators_make_the_same_mesh() -> None:
    mesh, grid, thickness = tank()
    assert mesh.nodes.shape == (49, 3) and len(grid) == 5 and grid.row(0) == [0] and len(grid.row(4)) == 12
    mesh.add_shells(grid.cells, CONCRETE, thickness)
    triangles, quads = np.array(grid.cells[:12]), np.array(grid.cells[12:])
    blocks = [Block("vertex", np.array([[0]])), Block("triangle", triangles), Block("quad", quads)]
    parts = [None, (CONCRETE, 0.5), (CONCRETE, thickness[12:])]
    for cells in (blocks, [tuple(block) for block in blocks]):
        other = bm.Mesh.from_arrays(mesh.nodes, cells, parts)
        one, two = bm.FemModel(mesh), bm.FemModel(other)
        assert same_bits(two.stiffness(), one.stiffness()) and same_bits(two.mass(), one.mass())
    # 24 faces on the ground, and the mass of bottom and wall.
    faces = list(one.base())
    assert len(faces) == 24 and sorted(map(len, faces)) == [3] * 12 + [4] * 12
    up = one.rigid_motion("z")
    chords = 12 * math.sin(math.pi / 12) * 10.0
    volume = 6 * 25.0 * math.sin(math.pi / 6) * 0.5 + chords * 4.0 * 0.3
    assert up @ one.mass() @ up == pytest.approx(2500.0 * volume, rel=1e-12)
    # Triangles match the quadrilaterals beside them: alone they have other matrices.
    alone = bm.Mesh.in_space(mesh.nodes)
    alone.add_shells(triangles, CONCRETE, 0.5)
    alone.add_shells(quads, CONCRETE, thickness[12:])
    assert not np.array_equal(bm.FemModel(alone).stiffness(), one.stiffness())


def test_bricks_beams_and_quadrilaterals_from_arrays() -> None:
    points = [[x, y, z] for z in (0.0, 1.0) for y in (0.0, 1.0) for x in (0.0, 1.0, 2.0)]
    bricks = np.array([[0, 1, 4, 3, 6, 7, 10, 9], [1, 2, 5, 4, 7, 8, 11, 10]])
    beam = (CONCRETE, SQUARE, (0.0, 0.0, 1.0))
    found = bm.Mesh.from_arrays(points, [("hexahedron", bricks), ("line", [[6, 8]])], [CONCRETE, beam])
    mesh = bm.Mesh.in_space()
    x, y = np.meshgrid([0.0, 1.0, 2.0], [0.0, 1.0])
    made = mesh.add_grid(np.stack([x, y, 0.0 * x], axis=2)).extrude(mesh, [1.0])
    assert made == bricks.tolist() and np.array_equal(mesh.nodes, points)
    mesh.add_bricks(made, CONCRETE)
    mesh.add_space_beams([[6, 8]], *beam)
    for own in (mesh, copied(mesh)):
        assert same_bits(bm.FemModel(found).stiffness(), bm.FemModel(own).stiffness())
    assert len(list(bm.FemModel(mesh).base())) == 2
    plane = bm.Mesh.from_arrays([[0, 0], [1, 0], [1, 1], [0, 1]], [("quad", [[0, 1, 2, 3]])], [CONCRETE])
    assert plane.nodes.shape == (4, 2) and bm.FemModel(plane).dofs == 8


def test_nothing_resists_a_rigid_motion() -> None:
    mesh, grid, thickness = tank()
    mesh.add_shells(grid.cells, CONCRETE, thickness)
    upper = mesh.add_nodes([[1.0, -2.0, 6.0], [2.0, -1.0, 7.0]])
    mesh.add_space_beams([[0, upper[0]], upper], CONCRETE, SQUARE, [[1.0, 0, 0], [0, 0, 1.0]], offsets=[[0.1, 0, 0.2], [0, 0.3, 0]])
    mesh.add_trusses([[10, upper[1]]], 200e9, 1e-3, 7850.0)
    mesh.add_springs([[11, upper[1]]], "axial", 1e8)
    model = bm.FemModel(mesh, rigid_links=[(0, [1, 2])], diaphragms=[(grid.row(4)[0], grid.row(4)[1:])])
    matrix = model.stiffness()
    for direction in SIX:
        motion = model.rigid_motion(direction, (0.5, 0.5, 1.0))
        assert np.abs(matrix @ motion).max() < 1e-9 * np.abs(matrix).max(), direction
    # Two nodes follow with six directions, eleven with three; a follower has no number of its own there.
    assert model.dofs == 6 * 51 - 2 * 6 - 11 * 3
    follower = grid.row(4)[3]
    assert model.dof_at(follower, "x") is None and model.dof_at(follower, "z") is not None
    assert [dof for dof, _ in model.row(follower, "y").terms] == [
        model.dof_at(grid.row(4)[0], name) for name in ("y", "rotation_z")
    ]
    assert model.node_at(1.0, -2.0, 6.0) == upper[0]
    assert model.resultant_row(grid.row(4), "z").value(model.rigid_motion("z")) == pytest.approx(1.0)


def test_links_along_lines_and_in_directions() -> None:
    for direction, place in zip(SIX, range(6)):
        mesh = pair()
        mesh.add_springs([[4, 5]], direction, 7.0)
        assert stiffness(mesh).tolist() == [[7.0, -7.0], [-7.0, 7.0]]
        mesh.add_dashpots([[4, 5]], direction, 3.0)
        assert bm.FemModel(mesh, [0, 1, 2, 3]).damping()[24:, 24:].tolist() == [[3.0, -3.0], [-3.0, 3.0]]
        mesh.add_mass(5, 11.0, rotary_inertia=(2.0, 3.0, 4.0))
        mass = np.diag(bm.FemModel(mesh, [0, 1, 2, 3]).mass())[-6:]
        assert mass.tolist() == [11.0, 11.0, 11.0, 2.0, 3.0, 4.0], place
    for add in (
        lambda mesh: mesh.add_springs([[4, 5]], "axial", 5e8),
        lambda mesh: mesh.add_trusses([[4, 5]], 2e11, 5e-3, 0.0),
    ):
        mesh = pair()
        add(mesh)
        matrix = stiffness(mesh)
        assert matrix.shape == (6, 6) and matrix[0, 0] == -matrix[0, 3] == 5e8 and abs(matrix).sum() == 2e9


def test_beams_have_the_stiffness_of_their_section_ends_and_force() -> None:
    def matrix(section: bm.BeamSection = SQUARE, **options: object) -> np.ndarray:
        mesh = pair()
        mesh.add_space_beams([[4, 5]], CONCRETE, section, (0.0, 0.0, 1.0), **options)  # type: ignore[arg-type]
        return stiffness(mesh)

    unequal = bm.BeamSection(0.12, (1.6e-3, 0.9e-3), 1.94e-3)
    found = np.diag(matrix(unequal))
    # The section's y axis points up: deflection along z bends about its z axis.
    modulus, shear = 30e9, 12.5e9
    exact = [0.12 * modulus / 2, 12 * modulus * 1.6e-3 / 8, 12 * modulus * 0.9e-3 / 8]
    assert found[:3] == pytest.approx(exact, rel=1e-12)
    exact = [shear * 1.94e-3 / 2, 4 * modulus * 0.9e-3 / 2, 4 * modulus * 1.6e-3 / 2]
    assert found[3:6] == pytest.approx(exact, rel=1e-12)
    bending = modulus * 5.2e-3
    # Hinged at the second end, in both planes.
    hinged = matrix(releases=([], ["rotation_y", "rotation_z"]))
    assert hinged[1, 1] == pytest.approx(3 * bending / 8) and hinged[2, 2] == pytest.approx(3 * bending / 8)
    # Rigid arms shorten it; shear makes it softer, compression too.
    short = matrix(offsets=[[0.5, 0, 0], [-0.5, 0, 0]])
    assert short[1, 1] == pytest.approx(12 * bending) and short[0, 0] == pytest.approx(0.25 * modulus)
    ratio = 12 * bending / (shear * 0.2 * 4)
    sheared = matrix(bm.BeamSection(0.25, (5.2e-3, 5.2e-3), 8.8e-3, shear_areas=(0.2, 0.2)))
    assert sheared[1, 1] == pytest.approx(12 * bending / 8 / (1 + ratio))
    pressed = matrix(compression=[1e6])
    assert matrix()[1, 1] - pressed[1, 1] == pytest.approx(1.2 * 1e6 / 2, rel=1e-6)


def test_a_mast_buckles_under_eulers_load() -> None:
    mesh = bm.Mesh.in_space()
    x, y = np.meshgrid([-1.0, 0.0, 1.0], [-1.0, 0.0, 1.0])
    floor = mesh.add_grid(np.stack([x, y, 0.0 * x], axis=2))
    mesh.add_shells(floor.cells, CONCRETE, 0.5)
    foot, weightless = mesh.node_at(0.0, 0.0), bm.Material(30e9, 0.2, 0.0)
    mast = [foot, *mesh.add_nodes([[0, 0, 2.5 * k] for k in range(1, 5)])]
    section = bm.BeamSection(0.5, (0.02, 0.01), 0.02)
    mesh.add_space_beams(list(zip(mast, mast[1:])), weightless, section, (1.0, 0.0, 0.0))
    mesh.add_mass(mast[-1], 50e3)
    others = [node for node in range(9) if node != foot]
    model = bm.FemModel(mesh, rigid_links=[(foot, others)], p_delta=9.81)
    euler = math.pi**2 * 30e9 * 0.01 / (4 * 10.0**2)
    assert model.buckling_factor() == pytest.approx(euler / (50e3 * 9.81), rel=2e-3)


def test_a_raft_lifts_slides_and_continues_from_a_checkpoint() -> None:
    model, top = raft(rayleigh=bm.RayleighDamping(0.2, 1e-3))
    record = bm.el_centro_1940().scaled(1.5)
    probes = [
        bm.Probe.acceleration("top", model.row(top, "x")),
        bm.Probe.displacement("corner", model.row(model.node_at(4.0, 4.0), "z")),
        bm.Probe.displacement("drift", model.row(top, "x") - bm.DofCombination.of_base(model, (0.0, 0.0, 12.0))[0]),
    ]

    def simulation(structure: object) -> bm.Simulation:
        ground = bm.ElasticGround.under(SOIL, structure, 4)  # type: ignore[arg-type]
        motion = bm.triaxial(x=record, y=record.scaled(0.7), up=record.scaled(0.4))
        return bm.Simulation(0.01, structure, ground, bm.Coulomb(0.3), motion=motion, probes=probes)  # type: ignore[arg-type]

    whole, cut = simulation(model), simulation(copied(model))
    run = whole.run(400)
    assert run.in_plan and run.energy_error < 1e-9
    assert run.uplifted_fraction.value > 0.0 and run.largest_slip.value > 1e-4
    assert np.abs(run["top"]).max() > 1.0 and np.abs(run["drift"]).max() > 1e-4
    cut.run(120)
    other = simulation(model)
    other.resume(copied(cut.checkpoint()))
    rest = other.run(280)
    for name in ("base_shear", "shear_across", "torque", "top", "corner"):
        assert same_bits(rest[name][1:], run[name][121:]), name


def test_meshes_pickle_with_their_grids() -> None:
    mesh, grid, thickness = tank()
    mesh.add_shells(grid.cells, [CONCRETE] * len(thickness), thickness)
    floor = mesh.add_grid([[[10.0, 0, 0], [11, 0, 0]], [[10, 1, 0], [11, 1, 0]]])
    mesh.add_bricks(floor.extrude(mesh, [0.5, 1.0]), CONCRETE)
    mesh.add_space_beams([[0, 50]], CONCRETE, SQUARE, (0, 0, 1), releases=(["rotation_y"], []))
    again = copied(copied(mesh))
    assert same_bits(again.nodes, mesh.nodes) and repr(again) == repr(mesh)
    one, two = (bm.FemModel(own, [[0, 1, 2], grid.row(2)[:3]]) for own in (mesh, again))
    assert same_bits(two.stiffness(), one.stiffness()) and same_bits(copied(one).mass(), one.mass())
    assert repr(copied(SQUARE)) == repr(SQUARE) and "Mesh(…)" in repr(one)


QUAD, POINTS = [("quad", [[0, 1, 2, 3]])], [[0.0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]]


@pytest.mark.parametrize(
    ("wrong", "message"),
    [
        (lambda mesh: mesh.add_shells([[0, 1, 2, 9]], CONCRETE, 0.3), "node of the element: index 9 must be below 4"),
        (lambda mesh: mesh.add_shells([[0, 1, 2.5]], CONCRETE, 0.3), "node is 2.5"),
        (lambda mesh: mesh.add_shells([[0, -1, 2]], CONCRETE, 0.3), "node is -1"),
        (lambda mesh: mesh.add_shells([[0, 1]], CONCRETE, 0.3), "nodes of a shell"),
        (lambda mesh: mesh.add_shells([[0, 1, 2, 3]], CONCRETE, -0.3), "thickness of a shell"),
        (lambda mesh: mesh.add_shells([[0, 1, 2, 3]], CONCRETE, [0.1, 0.2]), "thickness has 2 entries"),
        (lambda mesh: mesh.add_shells([[0, 1, 2, 3]], [], 0.3), "material has 0 entries"),
        (lambda mesh: mesh.add_bricks([[0, 1, 2, 3]], CONCRETE), "have 4 nodes, but must have 8"),
        (lambda mesh: mesh.add_space_beams([[0, 1]], CONCRETE, SQUARE, (1, 0, 0)), "angle between the beam"),
        (lambda mesh: mesh.add_space_beams([[0, 1]], CONCRETE, SQUARE, (0, 0, 1), offsets=[[0, 0, 0]]), "offsets has 1 rows"),
        (lambda mesh: mesh.add_space_beams([[0, 1]], CONCRETE, SQUARE, (0, 0, 1), releases=(["x"], ["x"])), "releases of the beam"),
        (lambda mesh: mesh.add_springs([[0, 1]], "rotation", 1.0), "direction of the element"),
        (lambda mesh: mesh.add_quads([[0, 1, 2, 3]], CONCRETE), "element of the plane"),
        (lambda mesh: mesh.add_mass(0, 1.0, rotary_inertia=2.0), "rotary_inertia must be three numbers"),
        (lambda mesh: mesh.add_nodes([[0.0, 1.0]]), "must have 3 in space"),
        (lambda mesh: mesh.add_nodes([[0.0, 1.0, math.nan]]), "z of the node"),
        (lambda mesh: mesh.add_grid([[[0.0, 1.0, 2.0]]]), "rows of the grid"),
        (lambda mesh: mesh.add_grid([[0.0, 1.0, 2.0]]), r"\(rows, columns, 3\)"),
        (lambda mesh: mesh.revolve((0, 0), [[0, 0], [-1, 0]], 8), "radius of the meridian"),
        (lambda mesh: bm.Mesh([[0, 0]]).add_node(0.0, 1.0, 2.0), "zero in the plane"),
        (lambda mesh: tank()[1].row(5), "index is 5, but must be below 5"),
        (lambda mesh: tank()[1].extrude(mesh, [1.0]), "corners"),
        (lambda mesh: bm.BeamSection(1.0, (0.1, 0.0), 0.1), "second moment I_z"),
        (lambda mesh: bm.FemModel(mesh, [[0, 1]]), "corners of a face"),
        (lambda mesh: bm.FemModel(mesh, [[0, 1, 7]]), "corner of the base: index 7"),
        (lambda mesh: bm.Mesh.from_arrays(POINTS, QUAD, []), "parts has 0 entries"),
        (lambda mesh: bm.Mesh.from_arrays(POINTS, QUAD, [CONCRETE]), r"must be \(material, thickness\)"),
        (lambda mesh: bm.Mesh.from_arrays(POINTS, QUAD, [(CONCRETE, [1, 2])]), r"block 0 of cells \(quad\) has 2"),
        (lambda mesh: bm.Mesh.from_arrays(POINTS, [("quad", [[0, 1, 2]])], [(CONCRETE, 1)]), "must have 4 columns"),
        (lambda mesh: bm.Mesh.from_arrays(POINTS, [("quad", [[0, 1, 2, 4]])], [(CONCRETE, 1)]), "node of the element: index 4 must be below 4"),
        (lambda mesh: bm.Mesh.from_arrays(POINTS, [("tetra", [[0, 1, 2, 3]])], [CONCRETE]), r"\(tetra\) must be of the type"),
        (lambda mesh: bm.Mesh.from_arrays(POINTS, [3], [None]), "block 0 of cells must be a pair"),
    ],
)
def test_errors_name_the_quantity(wrong, message: str) -> None:
    mesh = bm.Mesh.in_space(POINTS)
    with pytest.raises(bm.InputError, match=message):
        wrong(mesh)
    assert repr(mesh) == "Mesh(4 nodes, 0 elements)"


def test_a_grid_of_another_mesh_is_refused() -> None:
    mesh = bm.Mesh.in_space()
    floor = mesh.add_grid([[[0.0, 0, 0], [1, 0, 0]], [[0, 1, 0], [1, 1, 0]]])
    with pytest.raises(bm.InputError, match="node of the grid: index 0"):
        floor.extrude(bm.Mesh.in_space(), [1.0])
