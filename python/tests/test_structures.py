"""Structures against each other, and what they are built from."""

from __future__ import annotations

import functools
import pickle
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
import scipy.sparse
from conftest import same_bits

import basemat as bm

STOREYS = [bm.Storey(3.0, 20e3, 40e6)] * 3


def shaken(structure: object, soil: bm.Soil, **others: object) -> bm.Run:
    ground = bm.ElasticGround.under(soil, structure, 6)
    simulation = bm.Simulation(0.005, structure, ground, bm.Coulomb(0.4), motion=bm.el_centro_1940(), **others)
    return simulation.run(600)


def test_matrices_of_a_building_give_its_response(soil: bm.Soil) -> None:
    building = bm.ShearBuilding(8.0, 50e3, 4e5, STOREYS, damping=0.05)
    model = bm.MatrixModel(
        building.mass(), building.stiffness(), building.base(), damping=building.damping()
    )
    expected, found = shaken(building, soil), shaken(model, soil)
    assert expected.uplifted_fraction.value > 0.1
    scale = expected.base_shear.magnitude
    np.testing.assert_allclose(found["base_shear"], expected["base_shear"], atol=1e-9 * scale)


def test_rayleigh_damping_is_a_sum_of_the_matrices() -> None:
    building = bm.ShearBuilding(8.0, 50e3, 4e5, STOREYS)
    damping = bm.RayleighDamping.from_ratios([1.0, 10.0], [0.05, 0.05])
    model = bm.MatrixModel(
        building.mass(), building.stiffness(), building.base(), rayleigh=damping
    )
    expected = damping.mass * building.mass() + damping.stiffness * building.stiffness()
    np.testing.assert_allclose(model.damping(), expected, rtol=1e-14)
    assert damping.ratio(1.0) == pytest.approx(0.05)
    with pytest.raises(bm.InputError, match="not both"):
        matrices = building.mass(), building.stiffness(), building.base()
        bm.MatrixModel(*matrices, damping=expected, rayleigh=damping)


def test_a_frequency_is_in_hertz() -> None:
    building = bm.ShearBuilding(8.0, 50e3, 4e5, [bm.Storey(3.0, 1e3, 4e6)])
    expected = np.sqrt(4e6 / 1e3) / (2.0 * np.pi)
    assert building.fixed_base_frequency == pytest.approx(expected, rel=1e-12)
    assert bm.ShearBuilding.fixed_base_frequency.__doc__.endswith("Hz.")


def test_a_law_that_never_yields_is_a_linear_storey(soil: bm.Soil) -> None:
    make = functools.partial(bm.ShearBuilding, 8.0, 50e3, 4e5, STOREYS, damping=0.05)
    building = make()
    strong = make(laws={storey: bm.Bilinear(40e6, 1e12, 0.05) for storey in range(3)})
    assert same_bits(strong.damping(), building.damping())
    scale = shaken(building, soil).base_shear.magnitude
    np.testing.assert_allclose(
        shaken(strong, soil)["base_shear"], shaken(building, soil)["base_shear"], atol=1e-9 * scale
    )
    weak = make(laws={0: bm.Bilinear(40e6, 100e3, 0.05)})
    assert shaken(weak, soil).base_shear.magnitude < 0.8 * scale
    # The structure is a description: a second simulation starts from new columns.
    assert same_bits(shaken(weak, soil)["base_moment"], shaken(weak, soil)["base_moment"])


def test_isolators_cut_the_base_shear(soil: bm.Soil) -> None:
    building = bm.ShearBuilding(10.0, 50e3, 4e5, STOREYS, damping=0.02)
    weight = (60e3 + 30e3) * bm.STANDARD_GRAVITY
    pendulum = bm.FrictionPendulum(weight, 2.0, 0.06)
    isolated = bm.ShearBuilding.isolated(building, pendulum, height=0.5, slab_mass=30e3)
    fixed = shaken(building, soil)
    run = shaken(isolated, soil, probes=[bm.Probe.displacement("bearing", isolated.drift(0))])
    assert run.base_shear.magnitude < 0.6 * fixed.base_shear.magnitude
    assert run.probes["bearing"].magnitude > 0.01
    assert run.energy_balance.hysteresis > 0.2 * run.energy_balance.relative_input
    assert pendulum.sliding_period(9.80665) == pytest.approx(2 * np.pi * np.sqrt(2.0 / 9.80665))


def test_laws_of_springs_by_hand() -> None:
    law = bm.Bilinear(10e6, 100e3, 0.1)
    forces = law.path([0.005, 0.03, 0.025, 0.018])
    assert forces == pytest.approx([50e3, 120e3, 70e3, 0.0], abs=1e-6)
    assert law.path([0.005]) == [50e3], "a path begins with a new spring"
    bearing = bm.LeadRubber.from_strength(1.0e6, 50e3)
    assert (bearing.stiffness, bearing.strength) == (1.0e6, pytest.approx(50e3))


def test_springs_on_a_structure_are_those_of_the_law(soil: bm.Soil) -> None:
    building = bm.ShearBuilding(8.0, 50e3, 4e5, STOREYS)
    soft = bm.ShearBuilding(8.0, 50e3, 4e5, [bm.Storey(3.0, 20e3, 30e6), *STOREYS[1:]])
    braced = bm.WithSprings(soft, [(soft.drift(0), bm.Bilinear(10e6, 1e12, 0.0))])
    scale = shaken(building, soil).base_shear.magnitude
    np.testing.assert_allclose(
        shaken(braced, soil)["base_shear"], shaken(building, soil)["base_shear"], atol=1e-6 * scale
    )


def test_a_group_of_one_is_that_one_and_two_far_apart_are_two(soil: bm.Soil) -> None:
    one = bm.RigidBlock(6.0, 9.0, 1000.0)
    two = bm.StructureGroup([(one, -50.0), (one, 50.0)])
    assert two.dofs == 6
    assert two.row(1, one.horizontal_at(9.0)).terms == [(3, 1.0), (5, -9.0)]
    run, alone = shaken(two, soil), shaken(one, soil)
    # Until P waves have come from one to the other.
    first = int(94.0 / soil.pressure_wave_speed / 0.005)
    both, twice = run["base_shear"], 2.0 * alone["base_shear"]
    np.testing.assert_allclose(both[:first], twice[:first], rtol=1e-9, atol=1e-3)
    assert np.abs(both - twice)[first + 10 :].max() > 100.0
    left, right = run.foundations
    assert left.ends == [-53.0, -47.0] and right.ends == [47.0, 53.0]


def test_reduction_keeps_the_response() -> None:
    concrete = bm.Material(30e9, 0.2, 2400.0)
    mesh = bm.Mesh.layered_block(-3.0, 3.0, 6, [bm.Layer(12.0, 12, concrete)])
    rayleigh = bm.RayleighDamping.from_ratios([2.0, 20.0], [0.03, 0.03])
    full = bm.FemModel(mesh, rayleigh=rayleigh)
    reduced = bm.ReducedModel(full, 12)
    assert reduced.dofs == 14 + 12 < full.dofs
    roof = full.row(full.node_at(3.0, 12.0), "x")
    soil = bm.Soil(200e6, 0.33, 2000.0)
    runs = [
        shaken(structure, soil, probes=[bm.Probe.displacement("roof", row)])
        for structure, row in ((full, roof), (reduced, reduced.row(roof)))
    ]
    exact, found = (run["roof"] for run in runs)
    assert np.abs(found - exact).max() < 0.01 * np.abs(exact).max()
    assert np.all(np.diff(reduced.frequencies) >= 0.0)


GMSH = """$MeshFormat
4.1 0 8
$EndMeshFormat
$PhysicalNames
2
1 7 "base"
2 9 "wall"
$EndPhysicalNames
$Entities
0 1 1 0
1 0 0 0 2 0 0 1 7 0
1 0 0 0 2 1 0 1 9 0
$EndEntities
$Nodes
1 6 1 6
2 1 0 6
1
2
3
4
5
6
0. 0. 0.
1. 0. 0.
1. 1. 0.
0. 1. 0.
2. 0. 0.
2. 1. 0.
$EndNodes
$Elements
2 4 1 4
1 1 1 2
1 1 2
2 2 5
2 1 3 2
3 1 2 3 4
4 2 5 6 3
$EndElements
"""


def test_gmsh_and_arrays_give_the_same_model(tmp_path: Path) -> None:
    (tmp_path / "wall.msh").write_text(GMSH)
    read = bm.GmshMesh(tmp_path / "wall.msh")
    assert (read.surfaces, read.lines) == (["wall"], ["base"])
    wall = bm.Material(30e9, 0.2, 2400.0)
    model = bm.FemModel(read.mesh({"wall": wall}), read.line("base"))

    mesh = bm.Mesh([[0, 0], [1, 0], [1, 1], [0, 1], [2, 0], [2, 1]])
    mesh.add_quads([[0, 1, 2, 3], [1, 4, 5, 2]], wall)
    own = bm.FemModel(mesh, [0, 1, 4])
    assert same_bits(model.stiffness(), own.stiffness())
    assert same_bits(model.mass(), own.mass())
    # Two cubic metres of concrete, and no resistance to a translation.
    ones = np.tile([1.0, 0.0], 6)
    assert ones @ own.mass() @ ones == pytest.approx(4800.0)
    assert np.abs(own.stiffness() @ ones).max() < 1e-6 * own.stiffness().max()
    with pytest.raises(bm.InputError, match="would count twice"):
        mesh.add_quads([[0, 1, 2, 3]], wall)
    with pytest.raises(bm.FileError, match="wall.msh"):
        read.mesh({"roof": wall})


def test_layers_over_a_half_plane_of_the_same_soil_are_the_half_plane(soil: bm.Soil) -> None:
    block = bm.RigidBlock(6.0, 9.0, 1000.0)
    frequencies = [1.0, 4.0, 10.0]
    profile = bm.SoilProfile([bm.SoilLayer(soil, 5.0)], soil)
    layered = bm.ElasticGround.under(profile, block, 8)
    half_plane = bm.ElasticGround.under(soil, block, 8)
    one, other = layered.impedances(frequencies), half_plane.impedances(frequencies)
    for name in ("horizontal", "vertical", "rocking"):
        np.testing.assert_allclose(getattr(one, name), getattr(other, name), rtol=1e-4)
    # And in time, with friction, to the error of the convolution quadrature.
    motion = bm.el_centro_1940().scaled(0.5)
    runs = [
        bm.Simulation(0.005, block, ground, bm.Coulomb(0.4), motion=motion).run(600)
        for ground in (layered, half_plane)
    ]
    first, second = (run["base_shear"] for run in runs)
    assert np.abs(first - second).max() < 0.03 * np.abs(second).max()


def test_rows_add_and_scale(block: bm.RigidBlock) -> None:
    row = 2.0 * bm.DofCombination(0) - bm.DofCombination({2: 3.0}) + [(0, 1.0)]
    assert row.terms == [(0, 3.0), (2, -3.0)]
    assert row.value(np.array([1.0, 0.0, 2.0])) == -3.0
    assert list(row.weights(4)) == [3.0, 0.0, -3.0, 0.0]
    assert bm.DofCombination(np.array([0.0, 2.0])) == bm.DofCombination([(1, 2.0)])
    assert bm.DofCombination(np.int64(3)) == bm.DofCombination(3)
    assert block.horizontal_at(9.0).relative_to_base(block).value(
        np.array([0.5, 0, 0.01])
    ) == pytest.approx(-0.09)
    with pytest.raises(bm.InputError, match=r"structure\.dof\('roof'\) returns the row of this name"):
        bm.Probe.acceleration("roof", "roof")
    with pytest.raises(bm.InputError, match="a row must be"):
        bm.DofCombination(1.5)


def test_arrays_of_any_type_are_weights() -> None:
    for kind in (np.float64, np.float32, np.int64, np.uint8):
        assert bm.DofCombination(np.array([0, 2], dtype=kind)).terms == [(1, 2.0)]
        assert bm.DofCombination([(1, 2.0)]).value(np.array([5, 3], dtype=kind)) == 6.0
    assert bm.DofCombination(np.arange(6.0)[::2]).terms == [(1, 2.0), (2, 4.0)]
    assert bm.DofCombination(np.array(3)) == bm.DofCombination(3)


def test_arrays_that_do_not_fit_are_refused() -> None:
    with pytest.raises(MemoryError, match="1000000000000000000 weights"):
        bm.DofCombination(0).weights(10**18)
    count = 20_001
    mass = scipy.sparse.diags_array(np.ones(count)).tocsr()
    base = bm.BaseNode.rigid_base(-1.0, 1.0, [0, 1, 2])
    model = bm.MatrixModel(mass, mass, base)
    for matrix in (model.mass, model.stiffness, model.damping):
        with pytest.raises(bm.InputError, match="has 20001 degrees of freedom"):
            matrix()


SHORT_OF_MEMORY = """
import resource
import numpy, scipy.sparse, basemat as bm
mass = scipy.sparse.diags_array(numpy.ones(15_000)).tocsr()
model = bm.MatrixModel(mass, mass, bm.BaseNode.rigid_base(-1.0, 1.0, [0, 1, 2]))
resource.setrlimit(resource.RLIMIT_AS, (1 << 30, 1 << 30))
try:
    model.mass()
except MemoryError as error:
    print("refused")
"""


def test_a_matrix_without_memory_is_a_memory_error() -> None:
    pytest.importorskip("resource")
    command = [sys.executable, "-c", SHORT_OF_MEMORY]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    assert done.stdout == "refused\n", done.stderr


@pytest.mark.parametrize("node", [1.7, -1, float("nan"), float("inf")])
def test_node_numbers_are_whole(node: float) -> None:
    mesh = bm.Mesh([[0, 0], [1, 0], [1, 1]])
    with pytest.raises(bm.InputError, match="node is .* but must be a whole number"):
        mesh.add_springs([[0, node]], "x", 1e6)
    mesh.add_springs(np.array([[0.0, 1.0]]), "x", 1e6)
    assert repr(mesh) == "Mesh(3 nodes, 1 elements)"


NAMES = ["base_x", "base_y", "base_rotation", "roof"]


def named(names: object = NAMES, factor: float = 1.0) -> bm.MatrixModel:
    """A building of one storey by its matrices."""
    own = bm.ShearBuilding(8.0, 50e3, 4e5, [bm.Storey(3.0, 20e3, 40e6)])
    return bm.MatrixModel(own.mass(), factor * own.stiffness(), own.base(), dof_names=names)  # type: ignore[arg-type]


def test_names_of_degrees_of_freedom_reach_probes_frames_and_errors(soil: bm.Soil) -> None:
    model = named()
    assert model.dof_names == NAMES and model.dof("roof") == bm.DofCombination(3)
    ground = bm.ElasticGround.under(soil, model, 4)
    probe = bm.Probe.velocity("v", model.dof("roof"))
    run = bm.Simulation(0.01, model, ground, bm.Bonded(), motion=bm.el_centro_1940(), probes=[probe]).run(
        100, motion_every=10
    )
    frame = run.motion_frame()
    assert [*frame.columns] == NAMES and frame.index.name == "time"
    assert same_bits(frame.to_numpy(), run.motion["displacement"])
    assert same_bits(run.motion_frame("velocity")["base_y"].to_numpy(), run.motion["velocity"][:, 1].copy())
    assert pickle.loads(pickle.dumps(run)).dof_names == NAMES
    damped = bm.WithModalDamping(pickle.loads(pickle.dumps(model)), [0.05])
    assert damped.dof_names == NAMES
    # Five equal storeys on a fixed base: 2 sqrt(k/m) sin(pi/22) is the lowest circular frequency.
    storeys = [bm.Storey(3.0, 30.0e3, 60.0e6)] * 5
    building = bm.ShearBuilding(8.0, 60.0e3, 4.0e5, storeys)
    held = bm.WithModalDamping(building, [0.05], fixed_base=True)
    lowest = 2.0 * np.sqrt(60.0e6 / 30.0e3) * np.sin(np.pi / 22.0) / (2.0 * np.pi)
    assert held.frequencies[0] == pytest.approx(lowest, rel=1e-5)
    assert bm.WithModalDamping(building, [0.05]).frequencies[0] > 3.0 * lowest
    with pytest.raises(bm.InputError, match="quantity is 'force', but must be 'displacement' or"):
        run.motion_frame("force")  # type: ignore[arg-type]
    loose = named(factor=0.0)
    with pytest.raises(bm.InputError, match="'roof'"):
        bm.Simulation(0.01, loose, bm.ElasticGround.under(soil, loose, 4), bm.Bonded())
    for names, text in ((NAMES[:3], "3 names, but must have 4"), ([*NAMES[:3], "base_x"], "'base_x' twice")):
        with pytest.raises(bm.InputError, match=f"dof_names has {text}"):
            named(names)
    with pytest.raises(bm.InputError, match="no degree of freedom 'attic', only 'base_x', 'base_y'"):
        model.dof("attic")


def test_structures_name_what_they_can(soil: bm.Soil, block: bm.RigidBlock) -> None:
    building = bm.ShearBuilding(8.0, 50e3, 4e5, STOREYS)
    assert building.dof("floor_2") == bm.DofCombination(building.roof)
    assert building.dof("floor_0") == bm.DofCombination(building.floor(0))
    assert block.dof_names == ["x", "y", "rotation"]
    group = bm.StructureGroup([(block, 0.0)])
    assert group.dof_names is None
    with pytest.raises(bm.InputError, match="the structure has no dof_names"):
        group.dof("x")
    ground = bm.ElasticGround.under(soil, group, 4)
    run = bm.Simulation(0.01, group, ground, bm.Bonded()).run(5, motion_every=1)
    assert [*run.motion_frame().columns] == [0, 1, 2]


def test_contact_nodes_of_older_programs_are_base_nodes() -> None:
    with pytest.warns(DeprecationWarning, match="called BaseNode"):
        assert bm.ContactNode is bm.BaseNode  # type: ignore[attr-defined]
    assert "ContactNode" not in bm.__all__
    with pytest.raises(AttributeError, match="no attribute 'FaceNode'"):
        bm.FaceNode  # type: ignore[attr-defined]  # noqa: B018


def test_ends_of_beams_are_rows() -> None:
    mesh = bm.Mesh([[-2.0, 0.0], [0.0, 0.0], [2.0, 0.0], [0.0, 6.0]])
    beams = mesh.add_beams([[0, 1], [1, 2], [1, 3]], 30e9, 0.5, 0.01, 2400.0)
    model = bm.FemModel(mesh, [0, 1, 2])
    rows = model.beam_rows(beams[2])
    np.testing.assert_allclose(rows.axes, [[0.0, 1.0, 0.0], [-1.0, 0.0, 0.0], [0.0, 0.0, 1.0]], atol=1e-15)
    foot, head = rows.ends
    assert (foot.node, head.node) == (1, 3)
    # The head moves by 1 mm and does not turn: 12 E I u/L³ and 6 E I u/L².
    displacement = np.zeros(12)
    displacement[model.dof_at(head.node, "x")] = 1e-3
    value = lambda rows: rows.displacement.value(displacement)  # noqa: E731
    assert value(head.shears[0]) == pytest.approx(-12.0 * 3e8 * 1e-3 / 216.0)
    assert value(foot.moments[1]) == pytest.approx(-6.0 * 3e8 * 1e-3 / 36.0)
    assert value(head.moments[1]) == pytest.approx(6.0 * 3e8 * 1e-3 / 36.0)
    assert bm.Probe.section("moment", foot.moments[1]).unit == "N·m/m"
    with pytest.raises(bm.InputError, match="index 7"):
        model.beam_rows(7)


def test_nodes_are_merged(tmp_path: Path) -> None:
    mesh = bm.Mesh([[0.0, 0.0], [3.0, 0.0], [3.0, 1e-7], [6.0, 0.0]])
    mesh.add_beams([[0, 1], [2, 3]], 30e9, 0.5, 0.01, 2400.0)
    assert mesh.merge_nodes(1e-4) == (1, [0, 1, 1, 2])
    assert mesh.elements == [[0, 1], [1, 2]]
    with pytest.raises(bm.InputError, match="nodes 0 and 2: .* the ends are not"):
        mesh.merge_nodes(4.0)
    one = bm.Mesh([[0.0, 0.0], [3.0, 0.0]])
    one.add_beams([[0, 1]], 30e9, 0.5, 0.01, 2400.0)
    with pytest.raises(bm.InputError, match="element 0 on nodes"):
        one.merge_nodes(4.0)
    assert len(one.nodes) == 2
    path = tmp_path / "squares.msh"
    path.write_text(
        "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n8\n1 0 0 0\n2 1 0 0\n3 1 1 0\n4 0 1 0\n5 1 0 0\n6 2 0 0\n"
        "7 2 1 0\n8 1 1 0\n$EndNodes\n$Elements\n2\n1 3 2 9 1 1 2 3 4\n2 3 2 9 2 5 6 7 8\n$EndElements\n"
    )
    assert len(bm.GmshSpaceMesh(path).nodes) == 8
    assert len(bm.GmshSpaceMesh(path, merge_within=1e-4).nodes) == 6
    concrete = bm.Material(30e9, 0.2, 2400.0)
    assert len(bm.GmshMesh(path, merge_within=1e-4).mesh({"9": concrete}).nodes) == 6
