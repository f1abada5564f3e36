"""GOAL: joints between bodies, and soil at rest in a trench, with the results of Rust.
SCENE: blocks on blocks, on a wall that bends, beside each other; boxes of soil with and without a block.
REFERENCE: weights, a block on ground of constant acceleration, a rocking frame, states of the same run; Rust's stresses.
"""

from __future__ import annotations

import pickle
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import basemat as bm
from basemat._program import Program

GRAVITY = bm.STANDARD_GRAVITY
THETA = bm.SolverOptions(scheme=bm.TimeScheme.theta(1.0))
SOIL = bm.Soil(80e6, 0.33, 1900.0)

pytestmark = pytest.mark.filterwarnings("ignore::basemat.BasematWarning")


def stacked(lower_width: float = 6.0) -> tuple[bm.StructureGroup, list[bm.BaseNode], list[bm.BaseNode]]:
    """A block of 2 m × 1 m on another one; the upper and the lower side of their joint."""
    lower, upper = bm.RigidBlock(lower_width, 1.0, 2400.0), bm.RigidBlock(2.0, 1.0, 2400.0)
    group = bm.StructureGroup([(lower, 0.0)], above=[(upper, (0.0, 1.0))])
    top = group.contact_nodes(0, lower.contact_nodes([[-3.0, 1.0], [3.0, 1.0]]))
    return group, group.contact_nodes(1, upper.contact_nodes([[-1.0, 0.0], [1.0, 0.0]])), top


def on_wall(**others: object) -> bm.Simulation:
    """A block on a wall that bends, with a mortar joint of four elements."""
    mesh = bm.Mesh.layered_block(-1.0, 1.0, 4, [bm.Layer(3.0, 4, bm.Material(30e9, 0.2, 2400.0))])
    wall, block = bm.FemModel(mesh), bm.RigidBlock(2.0, 3.0, 2000.0)
    group = bm.StructureGroup([(wall, 0.0)], above=[(block, (0.0, 3.0))])
    top = [wall.node_at(x, 3.0) for x in (-1.0, -0.5, 0.0, 0.5, 1.0)]
    upper = group.contact_nodes(1, block.contact_nodes([[-1.0, 0.0], [1.0, 0.0]]))
    joint = bm.Joint.between(upper, group.contact_nodes(0, wall.contact_nodes(top)), 4, law=bm.Cohesive(20e3, 60e3, 0.4))
    ground = bm.ElasticGround.under(SOIL, group, 6)
    motion = bm.el_centro_1940().scaled(1.5)
    return bm.Simulation(0.005, group, ground, bm.Coulomb(0.6), motion=motion, joints=[joint], **others)  # type: ignore[arg-type]


def test_a_block_slides_on_another_one_as_by_hand() -> None:
    group, upper, lower = stacked()
    friction, acceleration, duration, step = 0.2, 4.0, 0.5, 5e-4
    samples = np.where(np.arange(0.0, 3.0, step) < duration, acceleration, 0.0)
    simulation = bm.Simulation(
        step,
        group,
        bm.SpringGround.under(group, 6, 1e14, 1e14),
        bm.Bonded(),
        motion=bm.Record(step, samples),
        joints=[bm.Joint.between(upper, lower, 8, law=bm.Coulomb(friction))],
        solver=THETA,
    )
    weight = 2.0 * 2400.0 * GRAVITY
    [start] = simulation.state.joints
    assert start.normal_force == pytest.approx(weight, rel=1e-7) and start.moment == pytest.approx(0.0, abs=1e-6 * weight)
    run = simulation.run(duration=3.0)
    # The lower block leaves the upper one behind, to its left.
    lag = acceleration - friction * GRAVITY
    speed = lag * duration
    slip = -0.5 * speed * duration - 0.5 * speed**2 / (friction * GRAVITY)
    assert run.joints[0]["mean_slip"][-1] == pytest.approx(slip, rel=5e-3)
    assert np.abs(run.joints[0]["shear_force"]).max() == pytest.approx(friction * weight, rel=1e-6)
    # All of the loss is friction of the joint, on the distance of the sliding.
    assert run.joints[0]["contact_energy"][-1] == pytest.approx(friction * weight * abs(slip), rel=0.02)
    assert run.energy_error < 1e-9 and simulation.joints[0].count == 8


def test_results_of_a_joint_are_those_of_its_states() -> None:
    simulation = on_wall()
    states = [simulation.state]
    run = simulation.run(600, contact_every=5, observe=lambda state: states.append(state))
    [joint] = run.joints
    contact = joint.contact
    assert contact["gap"].shape == (121, 4) and joint.elements.tolist()[0] == [-1.0, -0.5, 3.0, 3.0]
    for name in ("gap", "slip", "pressure", "shear"):
        expected = np.array([getattr(state.joints[0], name) for state in states])
        assert np.array_equal(contact[name], expected[::5])
        if name != "pressure":
            # Extremes are those of the largest magnitude.
            assert np.array_equal(np.abs(joint.envelope[name]), np.abs(expected).max(axis=0))
    assert np.array_equal(contact["mode"], np.array([state.joints[0].modes for state in states[::5]]))
    assert run.contact["gap"].shape == (121, 6) and contact["gap"].max() > 1e-4
    for name in set(joint.series) - {"time"}:
        assert joint[name].tolist() == [getattr(state.joints[0], name) for state in states]
    assert joint.units["moment"] == "N·m/m" and set(joint.units) == set(joint.series)
    with pytest.raises(KeyError, match="mean_slip"):
        joint["base_shear"]
    opened = sum(len(state.joints[0].transitions) for state in states)
    assert opened > 0 and "\nJoint " in str(run)
    again = pickle.loads(pickle.dumps(joint))
    assert np.array_equal(again["moment"], joint["moment"]) and repr(again) == "JointResults(4 elements)"
    assert np.array_equal(pickle.loads(pickle.dumps(run)).joints[0].contact["slip"], contact["slip"])


def test_frames_of_a_joint(tmp_path: Path) -> None:
    pytest.importorskip("pandas")
    run = on_wall().run(50, contact_every=10)
    [joint] = run.joints
    assert list(joint.to_frame()["shear_force"]) == joint["shear_force"].tolist()
    frame = joint.contact_frame()
    assert len(frame) == 6 * 4 and set(frame["x"]) == {-0.75, -0.25, 0.25, 0.75} and set(frame["z"]) == {3.0}
    assert frame.attrs["units"]["pressure"] == "Pa" and len(joint.envelope_frame()) == 4
    run.save_npz(tmp_path / "run.npz")
    arrays = np.load(tmp_path / "run.npz")
    assert np.array_equal(arrays["joint_0_contact_gap_m"], joint.contact["gap"])
    assert np.array_equal(arrays["joint_0_moment_n_m_per_m"], joint["moment"])


def test_joints_are_refused_where_they_cannot_be() -> None:
    group, upper, lower = stacked()
    with pytest.raises(bm.InputError, match="one sense"):
        bm.Joint.between(upper, lower[::-1], 4)
    with pytest.raises(bm.InputError, match="2"):
        bm.Joint.between(upper[:1], lower, 4)
    with pytest.raises(TypeError, match="BaseNode"):
        bm.Joint.between([1.0, 2.0], lower, 4)  # type: ignore[list-item]
    ground = bm.SpringGround.under(group, 6, 1e9, 1e9)
    with pytest.raises(bm.InputError, match="give another `law`"):
        bm.Simulation(0.01, group, ground, bm.Bonded(), joints=bm.Joint.between(upper, lower, 4, gap=0.02))
    with pytest.raises(bm.InputError, match="no stiffness connects"):
        bm.Simulation(0.01, group, ground, bm.Bonded())
    with pytest.raises(bm.InputError, match="law"):
        laws = [bm.Coulomb(0.3)] * 3
        bm.Simulation(0.01, group, ground, bm.Bonded(), joints=bm.Joint.between(upper, lower, 4, law=laws))
    body = bm.RigidBody.cuboid(4.0, 4.0, 2.0, 2000.0)
    joint = bm.Joint.between(upper, lower, 4)
    with pytest.raises(bm.InputError, match="joint"):
        bm.Simulation(0.01, body, bm.SpringGround.under(body, 4, 1e9, 1e9), bm.Bonded(), joints=[joint])
    with pytest.raises(bm.InputError, match="on the ground"):
        bm.StructureGroup([], above=[(body, (0.0, 1.0))])
    # A block whose middle is beyond the edge of the block under it falls.
    narrow, block = bm.RigidBlock(4.0, 1.0, 2400.0), bm.RigidBlock(2.0, 1.0, 2400.0)
    group = bm.StructureGroup([(narrow, 0.0)], above=[(block, (2.3, 1.0))])
    upper = group.contact_nodes(1, block.contact_nodes([[-1.0, 0.0], [1.0, 0.0]]))
    lower = group.contact_nodes(0, narrow.contact_nodes([[-2.0, 1.0], [2.0, 1.0]]))
    falling = bm.Joint.between(upper, lower, 4, law=bm.Coulomb(0.5))
    with pytest.raises(bm.Error, match="element 0 of joint 0 moves most"):
        bm.Simulation(0.01, group, bm.SpringGround.under(group, 4, 1e9, 1e9), bm.Coulomb(0.5), joints=[falling])


def test_an_expansion_joint_is_open_at_first() -> None:
    towers = [bm.RigidBlock(4.0, 16.0, 400.0), bm.RigidBlock(4.0, 16.0, 250.0)]
    group = bm.StructureGroup([(towers[0], 0.0), (towers[1], 4.02)])
    left = group.contact_nodes(0, towers[0].contact_nodes([[2.0, 12.0], [2.0, 16.0]]))
    right = group.contact_nodes(1, towers[1].contact_nodes([[-2.0, 12.0], [-2.0, 16.0]]))
    joint = bm.Joint.between(left, right, 2, law=bm.Coulomb(0.3), gap=0.02)
    ground = bm.ElasticGround.under(bm.Soil(40e6, 0.33, 1800.0), group, 6)
    motion = bm.el_centro_1940().scaled(1.5)
    scheme = bm.SolverOptions(scheme=bm.TimeScheme.dissipative_midpoint(0.8))
    simulation = bm.Simulation(0.002, group, ground, bm.Coulomb(0.6), motion=motion, joints=[joint], solver=scheme)
    [state] = simulation.state.joints
    assert [bm.MODES[mode] for mode in state.modes] == ["open", "open"] and state.open_fraction == 1.0
    assert np.all(state.gap > 0.0) and np.all(state.gap < 0.02) and joint.gap == 0.02
    run = simulation.run(duration=6.0)
    assert run.joints[0]["normal_force"].max() > 1e4 and run.energy_error < 1e-9


def made_again(simulation: bm.Simulation, file: Path) -> bm.Simulation:
    """The simulation that the program of a simulation makes; ``file``: for its arrays."""
    program = Program(simulation)
    names: dict[str, Any] = {}
    np.savez(file, **program.arrays)
    exec(program.text(str(file)), names)
    assert isinstance(names["simulation"], bm.Simulation)
    return names["simulation"]


def test_a_program_and_a_pickle_make_the_same_joints(tmp_path: Path) -> None:
    simulation = on_wall()
    again = made_again(simulation, tmp_path / "model.npz")
    [joint] = pickle.loads(pickle.dumps(simulation.joints))
    structure = pickle.loads(pickle.dumps(simulation.structure))
    pickled = bm.Simulation(
        0.005, structure, simulation.ground, simulation.interface, motion=simulation.motion, joints=[joint]
    )
    expected = simulation.run(100).joints[0]["moment"]
    for other in (again, pickled):
        assert np.array_equal(other.run(100).joints[0]["moment"], expected)


def test_pictures_draw_joints(tmp_path: Path) -> None:
    pytest.importorskip("matplotlib").use("agg")
    simulation = on_wall()
    run = simulation.run(40, contact_every=10, motion_every=10)
    shape = bm.DeformedShape(simulation.structure, height=[None, 3.0], joints=simulation.joints)
    plain = bm.DeformedShape(simulation.structure, height=3.0)
    # The upper side has two nodes, the lower one five.
    assert len(shape.cells) == len(plain.cells) + 1 + 4 and len(shape.points) == len(plain.points) + 7
    assert [row[1] for row in shape.points[-7:]] == [3.0] * 7
    displacement = run.motion["displacement"][-1]
    moved = shape.displacements(displacement)
    corner = shape.points.tolist().index([-1.0, 3.0, 0.0])
    np.testing.assert_allclose(moved[-5], moved[corner], atol=1e-15)
    axes = shape.plot(displacement)
    widths = axes.collections[-1].get_linewidths()
    assert list(widths[-5:]) == [2.5] * 5 and set(widths[:-5]) == {1.0}
    run.animate(structure=shape).save(tmp_path / "film.gif")
    run.report(tmp_path / "run.html", simulation, height=[None, 3.0])
    assert "Joint" in (tmp_path / "run.html").read_text("utf-8")
    with pytest.raises(bm.InputError, match="2, one for each"):
        bm.DeformedShape(simulation.structure, height=[3.0])


LINES = np.linspace(-4.0, 4.0, 5), np.linspace(-3.0, 0.0, 4)
CLAY = bm.Iwan.hyperbolic(60e6, 60e3, 0.2, 0.3, 1900.0)
ELASTIC = bm.Material(2.0 * 1.3 * 60e6, 0.3, 1900.0)
KERNELS = bm.SharedKernels()
PROFILE = bm.SoilProfile([bm.SoilLayer(bm.Soil(42e6, 0.35, 1600.0), 1.6)], bm.Soil(60e6, 0.3, 1900.0))


def box(material: bm.Material | bm.Iwan) -> bm.Mesh:
    """Soil of the profile at rest in a trench 8 m wide and 3 m deep."""
    return bm.Mesh.quad8_block(*LINES, material).with_stress_at_rest(PROFILE.stress_at_rest(GRAVITY, 0.6))


def in_trench(model: bm.FemModel, **others: object) -> bm.Simulation:
    ground = bm.TrenchGround(PROFILE, bm.Trench(-4.0, 4.0, 3.0).elements(4, 2), kernels=KERNELS)
    options = bm.SolverOptions(expected_steps=4)
    return bm.Simulation(0.02, model, ground, bm.Bonded(), solver=options, **others)  # type: ignore[arg-type]


def test_stresses_at_rest_are_weights() -> None:
    stress = bm.StressAtRest(10.0, 1700.0, 0.5).with_soil_below(2.0, 1900.0, 0.8)
    expected = [[-8.5e3, -17.0e3, -8.5e3, 0.0], [-42.4e3, -53.0e3, -42.4e3, 0.0], [0.0] * 4]
    np.testing.assert_allclose(stress.at([[0.0, -1.0], [0.0, -3.0], [0.0, 1.0]]), expected, rtol=1e-14)
    profile = bm.SoilProfile([bm.SoilLayer(bm.Soil(50e6, 0.4, 1800.0), 2.0)], bm.Soil(100e6, 0.25, 2000.0))
    np.testing.assert_allclose(profile.stress_at_rest(10.0).at([[0.0, -3.0]])[0, :2], [-56e3 / 3.0, -56e3], rtol=1e-14)
    for made in (stress, profile.stress_at_rest(10.0)):
        assert np.array_equal(pickle.loads(pickle.dumps(made)).at([[1.0, -2.5]]), made.at([[1.0, -2.5]]))
    with pytest.raises(bm.InputError, match="below the upper ends"):
        stress.with_soil_below(1.0, 1900.0, 0.8)


@pytest.mark.parametrize("material", [ELASTIC, CLAY], ids=["elastic", "clay"])
def test_soil_at_rest_does_not_move(material: bm.Material | bm.Iwan) -> None:
    simulation = in_trench(bm.FemModel(box(material), on_soil_at_rest=True))
    simulation.run(3)
    # Settlement of a column of this height under its weight is some 1e-3 m.
    for displacement in (simulation.static_displacement, simulation.state.displacement):
        assert np.abs(displacement).max() < 1e-12
    assert np.abs(simulation.state.pressure).max() < 1e-6 * 1900.0 * GRAVITY
    if material is CLAY:
        point = simulation.solid_points(0)
        depth = -point.position[:, 1]
        vertical = -GRAVITY * (1600.0 * np.minimum(depth, 1.6) + 1900.0 * np.maximum(depth - 1.6, 0.0))
        np.testing.assert_allclose(point.stress, np.outer(vertical, [0.6, 1.0, 0.6, 0.0]).reshape(-1, 4), rtol=1e-9, atol=1e-6)


def test_soil_at_rest_carries_what_is_added_later(tmp_path: Path) -> None:
    mesh = box(CLAY)
    mesh.add_mass(mesh.node_at(0.0, 0.0), 20e3)
    simulation = in_trench(bm.FemModel(mesh, on_soil_at_rest=True))
    assert simulation.state.normal_force == pytest.approx(20e3 * GRAVITY, rel=1e-6)
    again = pickle.loads(pickle.dumps(mesh))
    same = in_trench(bm.FemModel(again, on_soil_at_rest=True))
    assert np.array_equal(same.static_displacement, simulation.static_displacement)
    same = made_again(simulation, tmp_path / "model.npz")
    assert np.array_equal(same.static_displacement, simulation.static_displacement)


def test_a_footing_on_a_box_of_clay() -> None:
    clay = bm.Soil.from_shear_wave_speed(150.0, 0.45, 1800.0)
    box = bm.NearField(clay, 3.0, strength_profile=lambda depth: 40e3 + 2e3 * depth)
    mesh = box.mesh()
    # As in Rust: 14 × 4 elements, contact elements of the base and of both walls.
    assert len(mesh.elements) == 14 * 4 and len(box.ground().elements) == 12 + 2 * 4
    nodes = box.foundation_nodes(mesh)
    assert np.array_equal(mesh.nodes[nodes][[0, -1]], [[-3.0, 0.0], [3.0, 0.0]]) and len(nodes) == 13
    wide = bm.NearField(clay, 3.0, size=(9.0, 4.0), foundation_elements=4).ground()
    assert np.min(wide.elements) == -9.0 and np.min(box.ground().elements) == -6.0
    block = bm.RigidBlock(6.0, 2.0, 2000.0)
    soil = bm.FemModel(mesh, on_soil_at_rest=True)
    group = bm.StructureGroup([(soil, 0.0)], above=[(block, (0.0, 0.0))])
    upper = group.contact_nodes(1, block.contact_nodes([[-3.0, 0.0], [3.0, 0.0]]))
    joint = bm.Joint.around_nodes(upper, group.contact_nodes(0, soil.contact_nodes(nodes)), law=bm.Coulomb(0.7))
    assert joint.count is None
    small = bm.TrenchGround(clay, bm.Trench(-6.0, 6.0, 3.0).elements(4, 2), kernels=KERNELS)
    simulation = bm.Simulation(0.02, group, small, bm.Bonded(), joints=[joint], solver=bm.SolverOptions(expected_steps=2))
    weight = 6.0 * 2.0 * 2000.0 * GRAVITY
    assert simulation.state.joints[0].normal_force == pytest.approx(weight, rel=1e-6)
    assert simulation.state.normal_force == pytest.approx(weight, rel=1e-6)
    again = pickle.loads(pickle.dumps(bm.NearField(clay, 3.0).mesh()))
    assert np.array_equal(again.nodes, bm.NearField(clay, 3.0).mesh().nodes)

    def broken(depth: float) -> float:
        raise ZeroDivisionError(f"at {depth} m")

    with pytest.raises(ZeroDivisionError, match="at "):
        bm.NearField(clay, 3.0, strength_profile=broken).mesh()
    with pytest.raises(bm.InputError, match="even"):
        bm.NearField(clay, 3.0, foundation_elements=5)


def test_soil_that_cannot_be_at_rest_is_refused() -> None:
    weak = bm.Iwan.hyperbolic(60e6, 5e3, 0.1, 0.3, 1900.0)
    with pytest.raises(bm.InputError, match="element 0"):
        box(weak).with_stress_at_rest(bm.StressAtRest(GRAVITY, 1900.0, 0.3))
    high = bm.Mesh.quad8_block([0.0, 1.0], [0.0, 1.0], ELASTIC)
    with pytest.raises(bm.InputError, match="surface"):
        high.with_stress_at_rest(bm.StressAtRest(GRAVITY, 1900.0, 0.5))
    with pytest.raises(bm.InputError, match="soil at rest"):
        bm.FemModel(bm.Mesh.quad8_block([0.0, 1.0], [-1.0, 0.0], ELASTIC), on_soil_at_rest=True)
    with pytest.raises(bm.InputError, match="only one"):
        bm.FemModel(box(CLAY), [0, 1], on_soil_at_rest=True)
