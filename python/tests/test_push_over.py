"""GOAL: static push-over by displacement from Python: curves, hinges and fibres in it, pictures, errors.
SCENE: cantilever, propped beam and portal with hinges, bonded; an I-section in space; blocks that lift off and slide.
REFERENCE: collapse loads in closed form; overturning and sliding of blocks.
"""

from __future__ import annotations

import pickle
from typing import Any

import numpy as np
import pytest
from conftest import same_bits

import basemat as bm

HEIGHT, BAY = 3.0, 6.0
PLASTIC_MOMENT = 300e3
HINGE = bm.BilinearMoment(PLASTIC_MOMENT, 1e9, 1e-9)
YIELD_STRESS = 355e6
STEEL = bm.BilinearSteel(YIELD_STRESS, 210e9, 1e-9)
pytestmark = pytest.mark.filterwarnings("ignore::basemat.BasematWarning")


class Frame:
    """A mesh of elastic members with hinges, on footings 2 m wide."""

    def __init__(self) -> None:
        self.mesh, self.lines = bm.Mesh(), []

    def add_footing(self, x: float) -> int:
        nodes = [self.mesh.add_node(x + distance, 0.0) for distance in (-1.0, 0.0, 1.0)]
        self.mesh.add_beams([nodes[:2], nodes[1:]], 30e9, 1.0, 0.1, 2500.0)
        self.lines.append(nodes)
        return nodes[1]

    def add_node(self, x: float, y: float) -> int:
        node = self.mesh.add_node(x, y)
        self.mesh.add_mass(node, 1e3)
        return node

    def add_member(self, start: int, end: int, *, hinges: tuple[bool, bool]) -> None:
        ends = []
        for node, has_hinge in zip((start, end), hinges):
            beam_node = self.mesh.add_node(*self.mesh.nodes[node]) if has_hinge else node
            if has_hinge:
                self.mesh.add_hinges([[node, beam_node]], HINGE, 1e11)
            ends.append(beam_node)
        self.mesh.add_beams([ends], 210e9, 0.02, 4e-4, 7850.0)

    def model(self) -> bm.FemModel:
        return bm.FemModel(self.mesh, self.lines)


def pushed(model: bm.FemModel, row: bm.DofCombination, displacements: list[float]) -> bm.PushOver:
    ground = bm.SpringGround.under(model, 4, 1e10, 1e10)
    simulation = bm.Simulation(0.01, model, ground, bm.Bonded(), initial=bm.InitialConditions(gravity=0.0))
    curve = simulation.push_over_by_displacement(row, row, displacements)
    assert curve.cause is None and len(curve) == len(displacements) + 1
    np.testing.assert_allclose(curve.displacement, [0.0, *displacements], atol=1e-12)
    return curve


def cantilever() -> tuple[bm.FemModel, bm.DofCombination]:
    frame = Frame()
    foot, top = frame.add_footing(0.0), frame.add_node(0.0, HEIGHT)
    frame.add_member(foot, top, hinges=(True, False))
    model = frame.model()
    return model, model.row(top, "x")


def test_a_cantilever_collapses_at_its_plastic_moment() -> None:
    model, row = cantilever()
    curve = pushed(model, row, [0.01, 0.05, 0.2, 0.0, -0.2])
    assert curve.load_factor[0] == 0.0
    assert curve.load_factor[3] == pytest.approx(PLASTIC_MOMENT / HEIGHT, rel=1e-3)
    assert curve.load_factor[5] == pytest.approx(-PLASTIC_MOMENT / HEIGHT, rel=1e-3)
    np.testing.assert_allclose(curve.base_shear, curve.load_factor, rtol=1e-5, atol=1.0)
    assert not curve.uplifted_fraction.any() and not curve.in_plan
    assert (curve.base_rotation[1:4] < 0.0).all() and not curve.rotation_across.any()


def test_a_propped_beam_collapses_at_six_plastic_moments_over_its_length() -> None:
    frame = Frame()
    feet = [frame.add_footing(0.0), frame.add_footing(BAY)]
    left, middle, right = (frame.add_node(x, 2.0) for x in (0.0, 0.5 * BAY, BAY))
    frame.mesh.add_beams([[feet[0], left]], 210e9, 0.5, 0.1, 100.0)
    frame.mesh.add_trusses([[feet[1], right]], 210e9, 0.5, 100.0)
    frame.add_member(left, middle, hinges=(True, True))
    frame.add_member(middle, right, hinges=(False, False))
    model = frame.model()
    curve = pushed(model, -model.row(middle, "y"), [0.02, 0.1, 0.3])
    assert curve.load_factor[-1] == pytest.approx(6.0 * PLASTIC_MOMENT / BAY, rel=1e-3)


def test_a_portal_collapses_at_four_plastic_moments_over_its_height() -> None:
    frame = Frame()
    feet = [frame.add_footing(x) for x in (0.0, BAY)]
    tops = [frame.add_node(x, HEIGHT) for x in (0.0, BAY)]
    for foot, top in zip(feet, tops):
        frame.add_member(foot, top, hinges=(True, True))
    frame.mesh.add_beams([tops], 210e9, 0.5, 0.1, 100.0)
    model = frame.model()
    curve = pushed(model, model.row(tops[0], "x"), [0.02, 0.1, 0.3])
    assert curve.load_factor[-1] == pytest.approx(4.0 * PLASTIC_MOMENT / HEIGHT, rel=1e-3)


DEPTH, WIDTH, WEB, FLANGE = 0.3, 0.3, 0.011, 0.019


def i_section() -> bm.FiberSection:
    section = bm.FiberSection().with_i_section_in_space([DEPTH, WIDTH], [WEB, FLANGE], [[4, 16], [16, 4]], STEEL)
    return section.with_torsional_stiffness(1.5e5)


def column_in_space(section: bm.FiberSection) -> bm.FemModel:
    mesh = bm.Mesh.in_space([[-2, -2, 0], [2, -2, 0], [2, 2, 0], [-2, 2, 0], [0, 0, 0], [0, 0, HEIGHT]])
    mesh.add_space_fiber_beams([[4, 5]], section, 100.0, [1.0, 0.0, 0.0], formulation="force_based")
    for node, mass in ((0, 1e3), (1, 1e3), (2, 1e3), (3, 1e3), (4, 1e4), (5, 1e3)):
        mesh.add_mass(node, mass, rotary_inertia=[0.2 * mass] * 3)
    return bm.FemModel(mesh, [[0, 1, 2, 3]], rigid_links=[(4, [0, 1, 2, 3])])


def test_an_i_section_in_space_has_its_plastic_moments() -> None:
    section = i_section()
    assert section.fiber_count == 2 * 4 * 16 + 16 * 4
    area = 2.0 * WIDTH * FLANGE + (DEPTH - 2.0 * FLANGE) * WEB
    assert section.axial_stiffness == pytest.approx(210e9 * area, rel=1e-12)
    model = pickle.loads(pickle.dumps(column_in_space(section)))
    web = DEPTH - 2.0 * FLANGE
    # Fibres are lumped at their middles: with even numbers these are plastic moments of the whole area.
    modulus = {"x": WIDTH * FLANGE * (DEPTH - FLANGE) + 0.25 * WEB * web**2, "y": 0.5 * FLANGE * WIDTH**2 + 0.25 * web * WEB**2}
    for direction, plastic_modulus in modulus.items():
        curve = pushed(model, model.row(5, direction), [0.05, 0.2, 0.6, 1.5])  # type: ignore[arg-type]
        assert curve.in_plan
        assert curve.load_factor[-1] == pytest.approx(YIELD_STRESS * plastic_modulus / HEIGHT, rel=1e-3)


def block_on_springs(friction: float) -> bm.Simulation:
    block = bm.RigidBlock(4.0, 6.0, 2000.0)
    return bm.Simulation(0.01, block, bm.SpringGround.under(block, 16, 4e7, 3e7), bm.Coulomb(friction), motion=bm.el_centro_1940())


def test_a_block_lifts_off_or_slides_and_its_simulation_stays_as_it_is() -> None:
    block, weight = bm.RigidBlock(4.0, 6.0, 2000.0), 48e3 * bm.STANDARD_GRAVITY
    simulation, untouched = block_on_springs(0.7), block_on_springs(0.7)
    simulation.run(steps=20)
    top = block.horizontal_at(6.0)
    curve = simulation.push_over_by_displacement(top, top, [0.005, 0.02, 0.08, 0.32])
    overturning = weight * 2.0 / 6.0
    assert curve.uplifted_fraction[0] == 0.0 and curve.uplifted_fraction[-1] > 0.7
    assert 0.8 * overturning < curve.load_factor[-1] < overturning
    untouched.run(steps=20)
    assert same_bits(simulation.run(steps=20)["base_moment"], untouched.run(steps=20)["base_moment"])
    low = block.horizontal_at(0.5)
    sliding = block_on_springs(0.3).push_over_by_displacement(low, low, np.array([0.01, 0.1, 1.0]))
    assert sliding.load_factor[-1] == pytest.approx(0.3 * weight, rel=1e-3) and sliding.sliding_fraction[-1] == 1.0


def test_curves_pickle_and_are_frames_and_pictures() -> None:
    pandas = pytest.importorskip("pandas")
    pytest.importorskip("matplotlib").use("agg")
    block = bm.RigidBlock(4.0, 6.0, 2000.0)
    top = block.horizontal_at(6.0)
    curve = block_on_springs(0.7).push_over_by_displacement(top, top, [0.01, 0.03, 0.1])
    again = pickle.loads(pickle.dumps(curve))
    assert same_bits(again.load_factor, curve.load_factor) and repr(again) == "PushOver(4 states)"
    frame = curve.to_frame()
    assert isinstance(frame, pandas.DataFrame) and frame.index.name == "state"
    np.testing.assert_array_equal(frame["base_moment"], curve.base_moment)
    assert frame.attrs["units"]["base_moment"] == "N·m/m" and len(frame.columns) == 8
    panel = curve.plot(label="block", title="pushed")
    other = block_on_springs(0.3).push_over_by_displacement(top, top, [0.001])
    assert other.plot(panel, label="a little") is panel
    lines = {line.get_label(): line for line in panel.lines}
    assert lines.keys() == {"block", "block, uplift begins", "a little"}
    np.testing.assert_array_equal(lines["block"].get_ydata(), 1e-3 * curve.load_factor)
    first = int(np.flatnonzero(curve.uplifted_fraction)[0])
    assert list(lines["block, uplift begins"].get_xdata()) == [curve.displacement[first]]
    assert panel.get_title(loc="left") == "pushed" and panel.get_ylabel() == "load factor / 1000"


class Tower:
    """A block whose force raises an exception."""

    dofs = 3

    def __init__(self) -> None:
        self.block = bm.RigidBlock(4.0, 6.0, 2000.0)

    def base(self) -> Any:
        return self.block.base()

    def mass(self) -> Any:
        return self.block.mass()

    def stiffness(self) -> Any:
        return np.zeros((3, 3))

    def force(self, displacement: Any) -> Any:
        # A simulation tries rigid motions by 1 m when it is built.
        if 0.05 < abs(displacement[0]) < 0.9:
            raise RuntimeError("too far")
        return np.zeros(3)

    def tangent(self, displacement: Any) -> Any:
        return np.zeros((3, 3))


def test_errors_name_what_is_wrong() -> None:
    simulation = block_on_springs(0.7)
    for arguments, message in (
        ((0, 0, []), "displacements of the push-over"),
        ((0, 0, [np.nan]), "displacements of the push-over"),
        ((0, 7, [0.1]), "degree of freedom"),
        (({}, 0, [0.1]), "pattern"),
        ((np.ones(4), 0, [0.1]), "the pattern has an array of 4 weights, but the structure has 3"),
        ((0, np.ones(2), [0.1]), "the control has an array of 2 weights"),
        (("roof", 0, [0.1]), "a row is the text 'roof'"),
    ):
        with pytest.raises(bm.Error, match=message):
            simulation.push_over_by_displacement(*arguments)  # type: ignore[arg-type]
    body = bm.RigidBody.cuboid(6.0, 6.0, 9.0, 1000.0)
    in_plan = bm.Simulation(0.01, body, bm.SpringGround.under(body, 4, 5e7, 5e7), bm.Coulomb(0.5))
    with pytest.raises(bm.InputError, match="controlled degree of freedom of the push-over: must be the load pattern in plan"):
        in_plan.push_over_by_displacement(0, 4, [0.001])
    tower = Tower()
    of_tower = bm.Simulation(0.01, tower, bm.SpringGround.under(tower.block, 8, 4e7, 3e7), bm.Coulomb(0.7))  # type: ignore[arg-type]
    with pytest.raises(RuntimeError, match="too far"):
        of_tower.push_over_by_displacement(0, 0, [0.5])
