"""Numbers that are none, and arrays of another shape, are refused and not bent into what would fit."""

from __future__ import annotations

import decimal
import pickle
from collections.abc import Callable

import numpy as np
import pytest
import scipy.sparse

import basemat as bm

BASE = bm.ContactNode.rigid_base(-2.0, 2.0, [0, 1, 2])
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
        lambda: bm.Row(np.array([1.0 + 1.0j, 0.0])),
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


def test_rows_of_all_weights_belong_to_a_structure_of_as_many_unknowns(soil: bm.Soil) -> None:
    ground = bm.HalfPlaneGround.under(soil, BUILDING, 4)

    def simulation(**parts: object) -> bm.Simulation:
        return bm.Simulation(0.01, BUILDING, ground, bm.Bonded(), **parts)

    three, eight = np.array([1.0, 0.0, 0.0]), np.eye(8)[7]
    simulation(probes=[bm.Probe.displacement("roof", eight)], loads=[bm.Load.constant(eight, 1.0)])
    with pytest.raises(bm.InputError, match="probe 'roof' has an array of 3 weights, but .* 8 unk"):
        simulation(probes=[bm.Probe.displacement("roof", three)])
    section = bm.SectionRows(bm.Row(three), {0: 1.0}, 0)
    for probe in (
        bm.Probe.acceleration("roof", 2.0 * bm.Row(three) - bm.Row(0)),
        bm.Probe.section("roof", section),
        bm.Probe.section("roof", pickle.loads(pickle.dumps(section))),
        bm.Probe.velocity("roof", pickle.loads(pickle.dumps(bm.Row(three)))),
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
        lambda: bm.Row(three) + eight,
        lambda: bm.StructureGroup([(BUILDING, 0.0)]).row(0, three),
        lambda: bm.ReducedModel(BUILDING, 2).row(three),
        lambda: bm.Row(three).sway(BUILDING, 3.0),
        lambda: bm.Row(three).weights(8),
        lambda: bm.Row(eight).value(three),
        lambda: bm.MatrixModel(
            np.eye(3), np.zeros((3, 3)), [bm.ContactNode(0.0, eight, 1), BASE[1]]
        ),
    ):
        with pytest.raises(bm.InputError, match="weights"):
            refused()
    assert bm.Row(three) == bm.Row(0) == pickle.loads(pickle.dumps(bm.Row(three)))
