"""Numbers that are none, and arrays of another shape, are refused and not bent into what would fit."""

from __future__ import annotations

import decimal
import pickle
from collections.abc import Callable

import numpy as np
import pytest
import scipy.sparse

import basemat as bm

BASE = bm.BaseNode.rigid_base(-2.0, 2.0, [0, 1, 2])
BUILDING = bm.ShearBuilding(8.0, 50e3, 4e5, [bm.Storey(3.0, 20e3, 40e6)] * 5)


def model(mass: object = None, stiffness: object = None, damping: object = None) -> bm.MatrixModel:
    return bm.MatrixModel(
        np.eye(3) if mass is None else mass,
        np.zeros((3, 3)) if stiffness is None else stiffness,
        BASE,
        damping=damping,
    )


COMPLEX = np.eye(3) * (1.0 + 0.1j)
TEXTS = [["1", "0", "0"], ["0", "1", "0"], ["0", "0", "1"]]


@pytest.mark.parametrize(
    "call",
    [
        lambda: model(mass=COMPLEX),
        lambda: model(stiffness=COMPLEX),
        lambda: model(damping=COMPLEX),
        lambda: model(mass=scipy.sparse.csr_array(COMPLEX)),
        lambda: model(mass=COMPLEX.astype(object)),
        lambda: model(mass=TEXTS),
        lambda: model(mass=np.array(TEXTS, dtype=object)),
        lambda: bm.Record(0.01, np.exp(1j * np.arange(10.0))),
        lambda: bm.Record(0.01, ["0.0", "1.0"]),
        lambda: bm.Record(0.01, [0.0, None]),
        lambda: bm.Record(0.01, np.arange(3).astype("datetime64[s]")),
        lambda: bm.DofCombination(np.array([1.0 + 1.0j, 0.0])),
        lambda: bm.Load.table(0, [0.0, 1.0], [0.0, 1.0j]),
        lambda: bm.Mesh([["0", "0"], ["1", "0"]]),
        lambda: bm.free_field(displacement=lambda x, t: np.complex128(1j)).displacement(0.0, 1.0),
        lambda: bm.free_field(displacement=lambda x, t: (0.0, 1j)).displacement(0.0, 1.0),
    ],
)
def test_complex_numbers_texts_and_gaps_are_no_real_numbers(call: Callable[[], object]) -> None:
    with pytest.raises(bm.InputError, match="real number|pair of numbers"):
        call()


def test_a_load_is_real(rocking) -> None:
    for value in (np.complex64(1j), "3", None):
        with pytest.raises(bm.InputError, match="a load's function is .*, but must be a real"):
            rocking(loads=[bm.Load(0, lambda time, value=value: value)], motion=None)


def test_what_holds_real_numbers_will_do() -> None:
    expected = bm.Record(0.01, [0.0, 1.0, 2.0]).accelerations
    for values in (
        np.arange(3),
        np.arange(3, dtype=np.uint8),
        np.arange(3, dtype=np.float32),
        np.arange(6.0)[::2] / 2.0,
        [decimal.Decimal(k) for k in range(3)],
        np.array([0, 1.0, np.float32(2.0)], dtype=object),
        (0, 1, 2),
        range(3),
    ):
        np.testing.assert_array_equal(bm.Record(0.01, values).accelerations, expected)
    fortran = np.asfortranarray(np.arange(9.0).reshape(3, 3))
    symmetric = fortran @ fortran.T + np.eye(3)
    assert (model(mass=np.asfortranarray(symmetric)).mass() == symmetric).all()
    assert (model(mass=scipy.sparse.coo_array(np.eye(3, dtype=int))).mass() == np.eye(3)).all()


def test_rows_of_all_weights_belong_to_a_structure_of_as_many_dofs(soil: bm.Soil) -> None:
    ground = bm.ElasticGround.under(soil, BUILDING, 4)

    def simulation(**parts: object) -> bm.Simulation:
        return bm.Simulation(0.01, BUILDING, ground, bm.Bonded(), **parts)

    three, eight = np.array([1.0, 0.0, 0.0]), np.eye(8)[7]
    simulation(probes=[bm.Probe.displacement("roof", eight)], loads=[bm.Load.constant(eight, 1.0)])
    with pytest.raises(bm.InputError, match="probe 'roof' has an array of 3 weights, but .* 8 degrees"):
        simulation(probes=[bm.Probe.displacement("roof", three)])
    section = bm.SectionRows(bm.DofCombination(three), {0: 1.0}, 0)
    for probe in (
        bm.Probe.acceleration("roof", 2.0 * bm.DofCombination(three) - bm.DofCombination(0)),
        bm.Probe.section("roof", section),
        bm.Probe.section("roof", pickle.loads(pickle.dumps(section))),
        bm.Probe.velocity("roof", pickle.loads(pickle.dumps(bm.DofCombination(three)))),
    ):
        with pytest.raises(bm.InputError, match="probe 'roof' has an array of 3 weights"):
            simulation(probes=[probe])
    for load in (
        bm.Load(three, lambda time: 0.0),
        bm.Load.released(three, 1.0),
        bm.Load.record(three, bm.el_centro_1940(), 1.0),
        bm.Load.table(three, [0.0, 1.0], [0.0, 1.0]),
    ):
        with pytest.raises(bm.InputError, match="a load has an array of 3 weights"):
            simulation(loads=[load])
    law = bm.Bilinear(1e6, 1e3, 0.1)
    for refused in (
        lambda: bm.WithSprings(BUILDING, [(three, law)]),
        lambda: bm.DofCombination(three) + eight,
        lambda: bm.StructureGroup([(BUILDING, 0.0)]).row(0, three),
        lambda: bm.ReducedModel(BUILDING, 2).row(three),
        lambda: bm.DofCombination(three).total_drift(BUILDING, 3.0),
        lambda: bm.DofCombination(three).weights(8),
        lambda: bm.DofCombination(eight).value(three),
        lambda: bm.MatrixModel(
            np.eye(3), np.zeros((3, 3)), [bm.BaseNode(0.0, eight, 1), BASE[1]]
        ),
    ):
        with pytest.raises(bm.InputError, match="weights"):
            refused()
    assert bm.DofCombination(three) == bm.DofCombination(0) == pickle.loads(pickle.dumps(bm.DofCombination(three)))


MATRICES = np.ones((2, 3))
STONE = bm.Material(1e9, 0.2, 2000.0)
YIELD = bm.Bilinear(1e6, 1e4, 0.1)


@pytest.mark.parametrize(
    ("text", "call"),
    [
        (
            r"acceleration: an array of shape \(2, 3\), but must be of shape \(n,\)",
            lambda: bm.Record(0.01, MATRICES),
        ),
        (r"acceleration: no array of numbers", lambda: bm.Record(0.01, [[0.0], [1.0, 2.0]])),
        (r"^acceleration has 0 samples, but must have 2 or more", lambda: bm.Record(0.01, [])),
        (
            "duration is 0.0001 s, but must be the time_step",
            lambda: bm.free_field(acceleration=abs, time_step=1e-3, duration=1e-4),
        ),
        (
            r"stiffness: a matrix of shape \(2, 3\), but must be square",
            lambda: bm.MatrixModel(np.eye(3), MATRICES, BASE),
        ),
        (r"damping: an array of shape \(3,\), but must", lambda: model(damping=np.ones(3))),
        (r"nodes: an array of 3 columns, but must be of shape \(n, 2\)", lambda: bm.Mesh(MATRICES)),
        ("count: -1, but must be whole", lambda: bm.Strip(-1.0, 1.0, -1)),
        ("count: 2.5, but must be whole", lambda: bm.Strip(-1.0, 1.0, 2.5)),
        ("order: -4, but must be whole", lambda: bm.el_centro_1940().high_pass(0.2, order=-4)),
        ("degree: -1, but must", lambda: bm.el_centro_1940().with_baseline("none", degree=-1)),
        ("dofs: .*-1.*, but must", lambda: bm.BaseNode.rigid_base(-1.0, 1.0, [0, 1, -1])),
        ("row: -1, but must be whole", lambda: bm.Load.constant(-1, 1.0)),
        ("storey: -1, but must be whole", lambda: BUILDING.drift(-1)),
        ("keep: .*, but must be whole", lambda: bm.ReducedModel(BUILDING, 1, keep=[-3])),
        ("modes: -1, but must be whole", lambda: bm.ReducedModel(BUILDING, -1)),
        ("hourglass_percent: -1, but must", lambda: bm.Layer(1.0, 1, STONE, hourglass_percent=-1)),
        ("hourglass_percent is 300, but", lambda: bm.Layer(1.0, 1, STONE, hourglass_percent=300)),
        ("bytes: -1, but must be whole", lambda: bm.set_memory_limit(-1)),
        ("storey is -1, but must be 0", lambda: bm.ShearBuilding(8.0, 5e4, 4e5, [], laws={-1: YIELD})),
        ("contact: .*-1.*, but must be whole", lambda: bm.FemModel(bm.Mesh(), [-1])),
    ],
)
def test_errors_name_the_argument_and_what_it_should_be(
    text: str, call: Callable[[], object]
) -> None:
    with pytest.raises(bm.InputError, match=text):
        call()


@pytest.mark.parametrize(
    ("text", "call"),
    [
        ("soil: of the type float, but must be a Soil or a SoilProfile", lambda: bm.ElasticGround(80e6, [])),
        ("strips: of the type int, but must be a Strip, a list of them", lambda: bm.SpringGround(3, 1e8, 1e8)),
    ],
)
def test_wrong_types_are_named_in_pythons_words(text: str, call: Callable[[], object]) -> None:
    with pytest.raises(TypeError) as caught:
        call()
    name, _, reason = text.partition(": ")
    assert reason in str(caught.value)
    assert name in str([caught.value, *getattr(caught.value, "__notes__", [name])])


def test_an_observer_says_yes_or_no(rocking) -> None:
    with pytest.raises(bm.InputError, match="observe returned an invalid value"):
        rocking().run(5, observe=lambda state: "on")
    with pytest.raises(bm.InputError, match="observe must be a function"):
        rocking().run(5, observe=3)
    with pytest.raises(bm.InputError, match="element is 8, but must be below 8"):
        rocking().state.state_variables(8)


def test_soil_far_from_any_soil_warns_once(rocking, block) -> None:
    """MPa for Pa, and t/m³ for kg/m³."""
    for soil, number in (
        (bm.Soil(80.0, 0.33, 1900.0), "MPa"),
        (bm.Soil(80e6, 0.33, 1.9), "1.900e0 kg/m³"),
    ):
        ground = bm.ElasticGround.under(soil, block, 4)
        with pytest.warns(bm.BasematWarning) as caught:
            run = rocking(ground=ground).run(20)
        found = [str(own.message) for own in caught if "soil" in str(own.message)]
        assert len(found) == 1 and number in found[0] and found[0] in run.warnings


def test_counts_of_a_run_are_whole_and_not_negative(rocking) -> None:
    simulation = rocking()
    for name in ("steps", "observe_every", "every", "contact_every", "motion_every"):
        with pytest.raises(bm.InputError, match=f"{name}: -1, but must be whole numbers of 0 or more"):
            simulation.run(**{"steps": 1, name: -1})
    with pytest.raises(bm.InputError, match="expected_steps: 1000000000.0, but"):
        rocking(solver=bm.SolverOptions(expected_steps=1e9))
    assert simulation.state.step == 0


class Block:
    """A block from Python, whose methods may be replaced."""

    dofs = 3

    def __init__(self, **others: object) -> None:
        self.block = bm.RigidBlock(6.0, 9.0, 1000.0)
        vars(self).update(others)

    def base(self) -> list[list[bm.BaseNode]] | bm.BaseFaces:
        return self.block.base()

    def mass(self) -> np.ndarray:
        return self.block.mass()

    def stiffness(self) -> np.ndarray:
        return self.block.stiffness()


class Law:
    """Coulomb's law from Python, whose methods may be replaced."""

    modes = ("stick", "slip_left", "slip_right", "open")
    law = bm.Coulomb(0.4)

    def __init__(self, **others: object) -> None:
        vars(self).update(others)

    def conditions(self, mode, start):
        return self.law.conditions(mode, start)

    def next_mode(self, mode, start, trial, tolerance):
        return self.law.next_mode(mode, start, trial, tolerance)


@pytest.mark.parametrize(
    ("text", "parts"),
    [
        (r"mass of the structure returned .* matrix of shape \(2, 3\)", {"mass": lambda: MATRICES}),
        (r"stiffness of the structure returned a .*\(2, 2\)", {"stiffness": lambda: np.eye(2)}),
        ("damping of the structure returned", {"damping": lambda: "none"}),
        ("dofs of the structure returned", {"dofs": "three"}),
        ("dofs of the structure returned .*-3, but must be whole", {"dofs": -3}),
        ("base of the structure returned", {"base": lambda: [1, 2]}),
        (r"load of the structure returned .* \(2,\), .* \(3,\)", {"load": lambda t: [0.0, 1.0]}),
    ],
)
def test_what_a_structures_method_returns_badly_names_the_method(
    rocking, text: str, parts: dict[str, object]
) -> None:
    with pytest.raises(bm.InputError, match=text):
        rocking(structure=Block(**parts)).run(3)


@pytest.mark.parametrize(
    ("text", "parts"),
    [
        ("modes of the interface law returned", {"modes": 3}),
        ("conditions of the interface law returned", {"conditions": lambda *_: None}),
        ("next_mode of the interface law returned", {"next_mode": lambda *_: 3}),
        ("compliance of the interface law returned", {"compliance": lambda *_: 1.0}),
        ("state_variables of the interface law returned", {"state_variables": -1}),
    ],
)
def test_what_a_laws_method_returns_badly_names_the_method(
    rocking, text: str, parts: dict[str, object]
) -> None:
    with pytest.raises(bm.InputError, match=text):
        rocking(interface=Law(**parts)).run(200)


def test_what_a_coefficient_returns_badly_is_named(rocking) -> None:
    with pytest.raises(bm.InputError, match="coefficient's function is 'much', but must be a real"):
        rocking(interface=bm.VariableFriction(lambda start: "much")).run(3)
