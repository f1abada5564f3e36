"""Descriptions travel to other processes."""

from __future__ import annotations

import array
import collections
import inspect
import pickle
import sys

import numpy as np
import pytest
import scipy.sparse
from conftest import same_bits

import basemat as bm
from basemat import _pickling

SOIL = bm.Soil(80.0e6, 0.33, 1900.0)
STOREYS = [bm.Storey(3.0, 20e3, 40e6)] * 3
BUILDING = bm.ShearBuilding(8.0, 50e3, 4e5, STOREYS, damping=0.05)
RECORD = bm.el_centro_1940()


def matrices() -> bm.MatrixModel:
    stiffness = scipy.sparse.csr_array(BUILDING.stiffness())
    damping = BUILDING.damping()
    model = bm.MatrixModel(BUILDING.mass(), stiffness, BUILDING.base(), damping=damping)
    # The model stays what it was.
    damping[:] = 0.0
    stiffness.data[:] = 0.0
    return model


def finite_elements() -> bm.FemModel:
    mesh = bm.Mesh([[-1.0, 0.0], [1.0, 0.0], [0.0, 0.0]])
    top = mesh.add_node(0.0, 5.0)
    mesh.add_beams([[0, 2], [2, 1], [2, top]], 30e9, [0.5, 0.5, 0.3], 0.01, 2400.0)
    mesh.add_mass(top, 1e4)
    model = bm.FemModel(mesh, [0, 2, 1], rayleigh=bm.RayleighDamping(0.1, 1e-3))
    mesh.add_mass(top, 5e4)
    return model


def yielding(laws: object) -> bm.ShearBuilding:
    return bm.ShearBuilding(8.0, 50e3, 4e5, STOREYS, damping=0.05, laws=laws)  # type: ignore[arg-type]


def isolated() -> bm.ShearBuilding:
    law = bm.LeadRubber.from_strength(2e6, 30e3)
    return bm.ShearBuilding.isolated(BUILDING, law, height=0.5, slab_mass=30e3)


STRUCTURES = {
    "block": lambda: bm.RigidBlock(6.0, 9.0, 1000.0, center=1.0),
    "block of mass": lambda: bm.RigidBlock.from_mass(6.0, 5e4, 5e5, center_height=4.0),
    "building": lambda: BUILDING,
    "yielding": lambda: yielding({0: bm.Bilinear(40e6, 1e5, 0.05)}),
    "isolated": isolated,
    "matrices": matrices,
    "finite elements": finite_elements,
    "reduced": lambda: bm.ReducedModel(finite_elements(), 1),
    "group": lambda: bm.StructureGroup([(BUILDING, -10.0), (BUILDING, 10.0)]),
    "modal": lambda: bm.WithModalDamping(BUILDING, [0.05, 0.03]),
    "springs": lambda: bm.WithSprings(BUILDING, [(BUILDING.drift(0), bm.BoucWen(5e6, 2e4, 0.0))]),
}


def shaken(structure: object, ground: bm.Ground, motion: object, law: object) -> np.ndarray:
    simulation = bm.Simulation(0.005, structure, ground, law, motion=motion)  # type: ignore[arg-type]
    return simulation.run(150)["base_shear"]


def copied(value: object) -> object:
    return pickle.loads(pickle.dumps(value))


@pytest.mark.parametrize("name", STRUCTURES)
def test_structures(name: str) -> None:
    structure = STRUCTURES[name]()
    copy = copied(structure)
    assert type(copy) is type(structure)
    assert same_bits(copy.mass(), structure.mass())
    assert same_bits(copy.stiffness(), structure.stiffness())
    assert same_bits(copy.damping(), structure.damping())
    ground = bm.ElasticGround.under(SOIL, structure, 4)
    expected = shaken(structure, ground, RECORD, bm.Coulomb(0.4))
    assert same_bits(
        shaken(copy, copied(ground), copied(RECORD), copied(bm.Coulomb(0.4))), expected
    )
    assert same_bits(copied(copy).mass(), structure.mass())


def test_meshes() -> None:
    mesh = bm.Mesh.layered_block(0.0, 2.0, 2, [bm.Layer(1.0, 2, bm.Material(1e9, 0.2, 2000.0))])
    mesh.add_node(1.0, 5.0)
    assert same_bits(copied(mesh).nodes, mesh.nodes) and repr(copied(mesh)) == repr(mesh)


LAW = bm.DampingLaw.constant_q(0.05)
PROFILE = bm.SoilProfile([bm.SoilLayer(SOIL, 6.0, LAW)], SOIL, bedrock_damping=LAW)


def test_grounds() -> None:
    strip = bm.Strip.from_nodes([-4.0, -3.0, 0.0, 3.0, 4.0])
    for ground in (
        bm.ElasticGround(SOIL, [strip], history="exponentials"),
        bm.ElasticGround(SOIL, bm.Strip(-4.0, 4.0, 4), kernels=bm.SharedKernels()),
        bm.SpringGround([strip], 1e8, 5e7, dashpots=(1e6, 1e6)),
        bm.ElasticGround.under(PROFILE, BUILDING, 4),
    ):
        expected = shaken(BUILDING, ground, RECORD, bm.Coulomb(0.3))
        assert same_bits(shaken(BUILDING, copied(ground), RECORD, bm.Coulomb(0.3)), expected)


def test_motions_laws_loads_and_probes() -> None:
    wave = bm.PlaneWave.sv(SOIL, 0.3)
    for field in (
        bm.vertical_incidence(RECORD, RECORD.scaled(0.5)),
        bm.travelling_wave(bm.ricker(0.1, 0.05, 0.5), 800.0, -5.0),
        wave.reversed().field_from_horizontal(RECORD, 5.0),
        bm.InclinedWave.sv(PROFILE, 0.2).field(RECORD, -5.0),
    ):
        assert copied(field).displacement(1.0, 0.7) == field.displacement(1.0, 0.7) != [0.0, 0.0]
    load = copied(bm.Load.table(3, [0.0, 1.0], [0.0, 1e4]))
    probe = copied(bm.Probe.section("shear", BUILDING.shear(0), unit="N/m"))
    assert (probe.name, probe.unit) == ("shear", "N/m")
    ground = bm.ElasticGround.under(SOIL, BUILDING, 4)
    for law in (bm.Bonded(), bm.Cohesive(1e5, 1e5, 0.4), bm.ThinLayer(SOIL, 1.0, 0.4)):
        runs = [
            bm.Simulation(0.005, BUILDING, ground, own, loads=[load], probes=[probe]).run(50)[
                "shear"
            ]
            for own in (law, copied(law))
        ]
        assert same_bits(*runs) and np.abs(runs[0]).max() > 0.0


def test_layers_of_a_profile() -> None:
    for profile in (PROFILE, copied(PROFILE)):
        [layer] = profile.layers
        assert repr(layer).startswith("SoilLayer(soil=Soil(") and repr(copied(layer)) == repr(layer)
        again = bm.SoilProfile([copied(layer)], SOIL, bedrock_damping=LAW)
        assert str(again) == str(PROFILE)


def test_what_laws_are_told() -> None:
    start = bm.PreviousContact(bm.ContactState(slip=1e-3, shear_across=5.0), "slip_left", 0.005)
    assert isinstance(start, bm.ContactState) and (start.slip, start.shear_across) == (1e-3, 5.0)
    condition = bm.Condition.slip_is(0.25)
    assert (condition.slip, condition.gap, condition.value) == (1.0, 0.0, 0.25)
    for own in (condition, bm.Tolerance(1e-9, 2.0), bm.Limits(0.4, pressure_cap=1e5, bonded=True)):
        assert repr(copied(own)) == repr(own)
    # They are of one step, and go nowhere.
    with pytest.raises(TypeError, match="PreviousContact"):
        pickle.dumps(start)


def test_conditions_of_any_origin() -> None:
    start = bm.PreviousContact(bm.ContactState(pressure=1e5), "stick", 0.005)
    for own in (bm.Condition(gap=1.0, value=0.5), bm.Condition.shear_is(2.0), *bm.Coulomb(0.4).conditions("slip_left", start)):
        assert repr(copied(own)) == repr(own)


def test_descriptions_show_how_they_were_made() -> None:
    for value in (
        bm.RigidBlock(6.0, 9.0, 1000.0, center=1.0),
        bm.Coulomb(0.4),
        bm.Bilinear(40e6, 1e5, 0.05),
        bm.TimeScheme.newmark(0.6, beta=0.3025),
        SOIL,
    ):
        text = repr(value)
        assert text.startswith(type(value).__name__)
        assert repr(eval(text, {}, {**vars(bm)})) == text
    assert repr(matrices()).startswith("MatrixModel(<array of shape (6, 6)>, <array of shape (6, 6)>")
    assert "Mesh(…)" in repr(finite_elements())
    wave = bm.PlaneWave.sv(SOIL, 0.3).reversed()
    assert repr(wave) == "PlaneWave.reversed()"
    assert repr(bm.ricker(0.1, 0.05, center=0.5)) == "ricker(0.1, 0.05, center=0.5)"
    state = bm.ContactState(gap=0.5, shear=-2.0)
    across = "slip_across=0.0, shear_across=0.0"
    assert repr(state) == f"ContactState(gap=0.5, slip=0.0, pressure=0.0, shear=-2.0, {across})"
    bases = {"FreeField", "Ground", "Hysteresis", "InterfaceLaw", "Structure"}
    classes = [getattr(bm, name) for name in bm.__all__ if not name.startswith("User")]
    classes = [own for own in classes if isinstance(own, type)]
    plain = {own.__name__ for own in classes if own.__repr__ is object.__repr__}
    assert plain <= bases


def test_soils_are_equal_by_their_numbers() -> None:
    assert bm.Soil(80.0e6, 0.33, 1900.0) == SOIL != bm.Soil(80.0e6, 0.33, 1901.0)
    assert len({SOIL, bm.Soil(80.0e6, 0.33, 1900.0), copied(SOIL)}) == 1


def test_what_cannot_pickle_says_so() -> None:
    with pytest.raises((pickle.PicklingError, AttributeError), match="lambda"):
        pickle.dumps(bm.VariableFriction(lambda start: 0.3))


def test_signatures_stay_readable() -> None:
    # Python 3.9 knows no signatures of compiled classes.
    assert sys.version_info < (3, 10) or str(inspect.signature(bm.RigidBlock)) == (
        "(width, height, density, *, center=0.0, p_delta=None, carried_weights=None)"
    )
    assert "grading='cosine'" in str(inspect.signature(bm.ElasticGround.under))
    assert "of ``count`` elements" in bm.ElasticGround.under.__doc__


def test_what_changes_later_was_copied() -> None:
    pandas = pytest.importorskip("pandas")
    weights = pandas.Series([0.0, 2.0])
    nodes = array.array("d", [-4.0, 0.0, 4.0])
    laws = collections.OrderedDict({0: bm.Bilinear(40e6, 1e5, 0.05)})
    row = bm.Load.table(3, pandas.Series([0.0, 1.0]), weights)
    strip = bm.Strip.from_nodes(nodes)
    building = yielding(laws)
    expected = shaken(building, bm.ElasticGround.under(SOIL, building, 4), RECORD, bm.Bonded())
    weights[:] = 7.0
    nodes[2] = 9.0
    laws[1] = laws.pop(0)
    assert copied(strip).nodes == strip.nodes
    copy = copied(building)
    found = shaken(copy, bm.ElasticGround.under(SOIL, copy, 4), RECORD, bm.Bonded())
    assert same_bits(found, expected)
    pushed = [
        bm.Simulation(
            0.01,
            BUILDING,
            bm.ElasticGround.under(SOIL, BUILDING, 4),
            bm.Bonded(),
            loads=[load],
        ).run(20)["base_shear"]
        for load in (row, copied(row))
    ]
    assert same_bits(*pushed) and pushed[0].any()


class LawByName(dict):
    """A law that is a mapping, too."""

    modes = bm.Coulomb(0.3).modes

    def conditions(self, mode, start):
        return bm.Coulomb(0.3).conditions(mode, start)


def test_parts_of_the_user_stay_what_they_are() -> None:
    law, numbers = LawByName(), np.float64(3.0)
    assert _pickling._kept([law, numbers])[0] is law
    assert type(_pickling._kept(numbers)) is np.float64


def test_a_refused_addition_leaves_the_mesh_as_it_was() -> None:
    wall = bm.Material(30e9, 0.2, 2400.0)
    mesh = bm.Mesh([[0, 0], [1, 0], [1, 1], [0, 1], [2, 0], [2, 1]])
    mesh.add_beams([[0, 1]], 30e9, 0.5, 0.01, 2400.0)
    before = repr(mesh)
    for refused in (
        lambda: mesh.add_beams([[1, 2], [2, 9]], 30e9, 0.5, 0.01, 2400.0),
        lambda: mesh.add_beams([[1, 2], [2, 3]], 30e9, [0.5, -1.0], 0.01, 2400.0),
        lambda: mesh.add_trusses([[1, 2], [2, 9]], 30e9, 0.5, 2400.0),
        lambda: mesh.add_springs([[1, 2], [2, 9]], "x", 1e6),
        lambda: mesh.add_dashpots([[1, 2], [2, 9]], "x", 1e6),
        lambda: mesh.add_quads([[0, 1, 2, 3], [0, 1, 2, 3]], wall),
        lambda: mesh.add_mass(9, 1.0),
    ):
        with pytest.raises(bm.InputError):
            refused()
        assert repr(mesh) == before
    mesh.add_quads([[0, 1, 2, 3], [1, 4, 5, 2]], wall)
    assert repr(copied(mesh)) == repr(mesh) == "Mesh(6 nodes, 3 elements)"
