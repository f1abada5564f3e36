"""GOAL: beams of fibres from Python: sections, laws, states, and laws written in Python.
SCENE: paths of strain; a column on a mat that lifts off, shaken.
REFERENCE: tables of OpenSees; linear beams; the laws of the package; structures by matrices.
"""

from __future__ import annotations

import copy
import csv
import pickle
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from conftest import same_bits

import basemat as bm
from basemat._program import Program

DATA = Path(__file__).parents[2] / "tests" / "data" / "fibers"
STEEL = bm.BilinearSteel(420e6, 200e9, 0.015)
CURVED = bm.MenegottoPinto(420e6, 200e9, 0.015, transition=(18.0, 0.925, 0.15))
HARDENING = bm.MenegottoPinto(
    420e6, 200e9, 0.015, transition=[18.0, 0.925, 0.15], isotropic_hardening=[0.05, 8.0, 0.04, 9.0]
)
CONCRETE = bm.Concrete(28e6, 0.0021, 5.6e6, 0.007)
ELASTIC = bm.Material(30e9, 0.2, 2500.0)
MOTION = bm.el_centro_1940().scaled(1.5)
pytestmark = pytest.mark.filterwarnings("ignore::basemat.BasematWarning")


class Steel:
    """The law of `BilinearSteel`; its variables are the plastic strain and the dissipated energy."""

    variable_count = 2
    strength, modulus, ratio = 420e6, 200e9, 0.015

    def part(self, strain: float, plastic: float) -> tuple[float, float, bool]:
        """Stress of the part that yields, its plastic strain, and whether it yields."""
        stiffness, limit = (1.0 - self.ratio) * self.modulus, (1.0 - self.ratio) * self.strength
        trial = stiffness * (strain - plastic)
        stress = min(max(trial, -limit), limit)
        return stress, plastic if stress == trial else strain - stress / stiffness, stress != trial

    def response(self, strain: float, variables: np.ndarray) -> tuple[float, float]:
        stress, _, yields = self.part(strain, variables[0])
        hardening = self.ratio * self.modulus
        return hardening * strain + stress, hardening if yields else self.modulus

    def energy(self, strain: float, variables: np.ndarray) -> tuple[float, float]:
        stress, plastic, _ = self.part(strain, variables[0])
        stored = 0.5 * self.ratio * self.modulus * strain**2 + 0.5 * stress**2 / ((1.0 - self.ratio) * self.modulus)
        return stored, variables[1] + stress * (plastic - variables[0])

    def commit(self, strain: float, variables: np.ndarray) -> list[float]:
        return [self.part(strain, variables[0])[1], self.energy(strain, variables)[1]]


def section(concrete: Any = CONCRETE, steel: Any = STEEL) -> bm.FiberSection:
    whole = bm.FiberSection().with_rectangle([[-0.3, -0.5], [0.3, 0.5]], [12, 1], concrete)
    for y in (-0.25, 0.25):
        whole = whole.with_bars([[y, -0.4], [y, 0.4]], 3, 800e-6, steel)
    return whole


def mesh_of(column: Callable[[bm.Mesh, list[list[int]]], object] | None) -> bm.Mesh:
    """A mat of 4 m with a column in the middle, a mass on its top."""
    mesh = bm.Mesh([[-2.0, 0.0], [0.0, 0.0], [2.0, 0.0], [0.0, 3.0], [0.0, 6.0]])
    mesh.add_beams([[0, 1], [1, 2]], 30e9, 1.0, 0.1, 2500.0)
    mesh.add_mass(3, 2e3, rotary_inertia=10.0)
    mesh.add_mass(4, 50e3, rotary_inertia=1e3)
    if column:
        column(mesh, [[1, 3], [3, 4]])
    return mesh


def fibers(made: Any = None, **options: Any) -> Callable[[bm.Mesh, list[list[int]]], object]:
    return lambda mesh, nodes: mesh.add_fiber_beams(nodes, made or section(), 1500.0, **options)


def model_of(column: Callable[[bm.Mesh, list[list[int]]], object], **options: Any) -> bm.FemModel:
    return bm.FemModel(mesh_of(column), [0, 1, 2], **options)


def shaken(model: Any, motion: bm.Record = MOTION) -> bm.Simulation:
    ground = bm.SpringGround.under(model, 8, 60e6, 60e6)
    drift = bm.Probe.displacement("top", model_of(fibers()).row(4, "x"))
    return bm.Simulation(0.005, model, ground, bm.Coulomb(0.6), motion=motion, probes=[drift])


def test_laws_have_the_stresses_of_opensees() -> None:
    with (DATA / "opensees_laws.csv").open() as file:
        rows = list(csv.DictReader(file))
    laws = {"bilinear": STEEL, "curved": CURVED, "hardening": HARDENING, "concrete": CONCRETE}
    for name, law in laws.items():
        strains, stresses = np.array([[row["strain"], row["stress_pa"]] for row in rows if row["law"] == name], float).T
        found = bm.fiber_stress_path(law, strains)
        assert found.shape == strains.shape
        np.testing.assert_allclose(found, stresses, atol=1e-11 * np.abs(stresses).max())
    np.testing.assert_allclose(bm.fiber_stress_path(ELASTIC, [1e-3, -2e-3]), [30e6, -60e6])
    path = np.sin(np.linspace(0.0, 20.0, 300)) * np.linspace(0.0, 0.02, 300)
    np.testing.assert_allclose(bm.fiber_stress_path(Steel(), path), bm.fiber_stress_path(STEEL, path), atol=1e-3)


def test_sections_have_their_fibres() -> None:
    whole = section()
    assert whole.fiber_count == 12 + 6
    assert whole.axial_stiffness == pytest.approx(0.6 * 2 * 28e6 / 0.0021 + 6 * 800e-6 * 200e9, rel=1e-12)
    positions = np.stack([(np.arange(12) + 0.5) * 0.05 - 0.3, np.zeros(12)], axis=1)
    cut = bm.FiberSection().with_fibers(positions, 0.05, CONCRETE).with_fibers([[0.1, 0.2], [0.1, -0.2]], [1e-3, 2e-3], STEEL)
    assert cut.fiber_count == 14
    assert cut.axial_stiffness == pytest.approx(0.6 * 2 * 28e6 / 0.0021 + 3e-3 * 200e9, rel=1e-12)
    ring = bm.FiberSection().with_ring([0.0, 0.0], [0.0, 0.5], [4, 16], ELASTIC)
    assert ring.fiber_count == 64
    assert ring.axial_stiffness == pytest.approx(30e9 * np.pi * 0.25, rel=1e-12)
    beam = bm.FiberSection().with_i_section([0.3, 0.15], [7.1e-3, 10.7e-3], [2, 8], STEEL)
    assert beam.fiber_count == 12
    assert beam.axial_stiffness == pytest.approx(200e9 * (2 * 0.15 * 10.7e-3 + (0.3 - 2 * 10.7e-3) * 7.1e-3), rel=1e-12)
    assert bm.FiberSection().with_fiber([0.1, 0.0], 0.01, STEEL).with_fiber([-0.1, 0.0], 0.01, STEEL).fiber_count == 2


@pytest.mark.parametrize("formulation", ["displacement_based", "force_based"])
def test_elastic_fibres_are_linear_beams(formulation: str) -> None:
    layers = 40
    elastic = bm.FiberSection().with_rectangle([[-0.3, -0.5], [0.3, 0.5]], [layers, 1], ELASTIC)
    second_moment = 0.6**3 / 12.0 * (1.0 - 1.0 / layers**2)
    linear = model_of(lambda mesh, nodes: mesh.add_beams(nodes, 30e9, 0.6, second_moment, 2500.0))
    yielding = model_of(fibers(elastic, formulation=formulation, quadrature="legendre", points=3))
    expected, found = shaken(linear).run(400)["top"], shaken(yielding).run(400)["top"]
    np.testing.assert_allclose(found, expected, atol=1e-9 * np.abs(expected).max())


@pytest.mark.parametrize("formulation", ["displacement_based", "force_based"])
def test_states_of_sections_of_a_run(formulation: str) -> None:
    model = model_of(fibers(formulation=formulation))
    assert model.inelastic_elements == [4, 5]
    simulation = shaken(model)
    run = simulation.run(600)
    assert run.energy_error < 1e-9 and run.uplifted_fraction.value > 0.0
    sections = simulation.beam_sections(4)
    assert sections.element == 4 and repr(sections) == "BeamSections(element 4, 5 sections of 18 fibres)"
    assert sections.position.shape == (5, 3) and sections.fiber_position.shape == (18, 2)
    np.testing.assert_allclose(sections.position[:, 1], 1.5 + 1.5 * np.array([-1, -np.sqrt(3 / 7), 0, np.sqrt(3 / 7), 1]))
    assert sections.length.sum() == pytest.approx(3.0)
    y, area = sections.fiber_position[:, 0], sections.fiber_area
    assert sections.fiber_strain.shape == sections.fiber_stress.shape == (5, 18)
    strains = sections.axial_strain[:, None] - sections.curvature[:, None] * y
    np.testing.assert_allclose(sections.fiber_strain, strains, atol=1e-15)
    np.testing.assert_allclose(sections.axial_force, sections.fiber_stress @ area, rtol=1e-6)
    np.testing.assert_allclose(sections.moment, -sections.fiber_stress @ (area * y), rtol=1e-6, atol=1.0)
    assert sections.axial_force @ sections.length < 0.0 and np.abs(sections.fiber_strain).max() > 1e-3
    for name in ("curvature", "fiber_stress"):
        assert same_bits(getattr(pickle.loads(pickle.dumps(sections)), name), getattr(sections, name))
    assert model.beam_sections(4).moment.tolist() == [0.0] * 5
    saved = pickle.loads(pickle.dumps(simulation.checkpoint()))
    rest = simulation.run(100)["top"]
    again = shaken(model)
    again.resume(saved)
    assert same_bits(again.run(100)["top"], rest)


def test_frames_of_sections() -> None:
    pytest.importorskip("pandas")
    simulation = shaken(model_of(fibers()))
    simulation.run(200)
    sections = simulation.beam_sections(4)
    frame = sections.to_frame()
    assert list(frame.columns) == ["x", "y", "z", "length", "axial_strain", "curvature", "axial_force", "moment", "shear"]
    assert frame.attrs["units"]["shear"] == "N"
    assert len(frame) == 5 and frame["moment"].to_numpy().tolist() == sections.moment.tolist()
    assert frame.attrs["units"]["curvature"] == "1/m" and frame.attrs["units"]["moment"] == "N·m"
    fiber_frame = sections.fiber_frame()
    assert len(fiber_frame) == 5 * 18 and fiber_frame.attrs["units"]["stress"] == "Pa"
    row = fiber_frame[(fiber_frame["section"] == 2) & (fiber_frame["fiber"] == 7)].iloc[0]
    assert row["stress"] == sections.fiber_stress[2, 7] and row["fiber_y"] == sections.fiber_position[7, 0]


def test_laws_of_ones_own_are_those_of_the_package() -> None:
    expected = shaken(model_of(fibers(bars(STEEL)))).run(600)
    simulation = shaken(model_of(fibers(bars(Steel()))))
    found = simulation.run(600)
    np.testing.assert_allclose(found["top"], expected["top"], atol=1e-9 * np.abs(expected["top"]).max())
    assert found.energy_error < 1e-9
    assert np.abs(simulation.beam_sections(4).fiber_strain[:, 12:]).max() > 2.1e-3


def bars(steel: Any) -> bm.FiberSection:
    """A section with two fibres of steel only."""
    concrete = bm.FiberSection().with_rectangle([[-0.3, -0.5], [0.3, 0.5]], [12, 1], CONCRETE)
    return concrete.with_bars([[-0.25, 0.0], [0.25, 0.0]], 2, 2400e-6, steel)


class Failing(Steel):
    """Raises in a method, or returns what it must not, once the strain is large."""

    def __init__(self, method: str, returned: object = None) -> None:
        self.method, self.returned = method, returned

    def __getattribute__(self, name: str) -> Any:
        found = super().__getattribute__(name)
        if name != super().__getattribute__("__dict__")["method"]:
            return found

        def fail(strain: float, variables: np.ndarray) -> Any:
            if abs(strain) < 3e-4:
                return found(strain, variables)
            if self.returned is None:
                raise ArithmeticError(name)
            return self.returned

        return fail


@pytest.mark.parametrize("method", ["response", "energy", "commit"])
def test_exceptions_of_a_law_come_out_of_the_run(method: str) -> None:
    simulation = shaken(model_of(fibers(bars(Failing(method)), points=2)))
    with pytest.raises(ArithmeticError, match=method):
        simulation.run(800)
    assert 0 < simulation.state.step < 800
    for returned in ([0.0, 1.0, 2.0], [0.0, np.nan]):
        simulation = shaken(model_of(fibers(bars(Failing(method, returned)), points=2)))
        with pytest.raises(bm.InputError, match=f"{method} of the law of a fibre returned"):
            simulation.run(800)


def test_models_pickle() -> None:
    for made in (section(), section(steel=Steel()), section(steel=HARDENING)):
        model = model_of(fibers(made, formulation="force_based", points=4))
        again = pickle.loads(pickle.dumps(model))
        assert same_bits(shaken(again).run(60)["top"], shaken(model).run(60)["top"])
    # The known record needs no file of arrays.
    simulation = shaken(model_of(fibers()), bm.el_centro_1940())
    names: dict[str, Any] = {}
    exec(Program(simulation).text("arrays.npz"), names)
    assert same_bits(names["simulation"].run(60)["top"], simulation.run(60)["top"])
    assert repr(section()).startswith("FiberSection().with_rectangle([[-0.3, -0.5], [0.3, 0.5]], [12, 1], Concrete(")
    assert repr(section()).count(".with_bars(") == 2
    assert repr(STEEL) == "BilinearSteel(420000000.0, 200000000000.0, 0.015)"


def test_fibres_on_matrices_move_as_in_a_finite_element_model() -> None:
    whole = model_of(fibers())
    linear = model_of(lambda mesh, nodes: None)
    assert whole.dofs == linear.dofs
    matrices = bm.MatrixModel(linear.mass(), linear.stiffness(), whole.base())
    mesh = bm.Mesh([[0.0, 0.0], [0.0, 3.0], [0.0, 6.0]])
    fibers()(mesh, [[0, 1], [1, 2]])
    rows = [[whole.row(node, direction) for direction in ("x", "y", "rotation")] for node in (1, 3, 4)]
    parts = bm.WithElements(matrices, mesh, rows)
    expected, simulation = shaken(whole).run(400)["top"], shaken(pickle.loads(pickle.dumps(parts)))
    found = simulation.run(400)["top"]
    np.testing.assert_allclose(found, expected, atol=1e-9 * np.abs(expected).max())
    assert np.abs(simulation.beam_sections(0).curvature).max() > 1e-4
    assert simulation.solid_values("plastic_strain")[0] == []
    # Springs and groups are around it.
    around = bm.WithSprings(parts, [(whole.row(4, "x") - whole.row(1, "x"), bm.Bilinear(1e3, 1e3, 0.1))])
    group = shaken(around)
    group.run(5)
    assert group.beam_sections(1).element == 1


def in_space(torsion: float | None = 1e8) -> bm.FiberSection:
    whole = bm.FiberSection().with_rectangle([[-0.3, -0.2], [0.3, 0.2]], [8, 6], CONCRETE)
    whole = whole.with_bars([[-0.25, -0.15], [-0.25, 0.15]], 3, 8e-4, STEEL).with_bars([[0.25, -0.15], [0.25, 0.15]], 3, 8e-4, STEEL)
    return whole if torsion is None else whole.with_torsional_stiffness(torsion)


@pytest.mark.parametrize("formulation", ["displacement_based", "force_based"])
def test_a_column_in_space(formulation: str) -> None:
    mesh = bm.Mesh.in_space([[-2, -2, 0], [2, -2, 0], [2, 2, 0], [-2, 2, 0], [0, 0, 0], [0, 0, 3], [0, 0, 6]])
    numbers = mesh.add_space_fiber_beams([[4, 5], [5, 6]], in_space(), 600.0, [1.0, 0.2, 0.0], formulation=formulation)  # type: ignore[arg-type]
    for node, mass in ((0, 1e3), (1, 1e3), (2, 1e3), (3, 1e3), (4, 40e3), (5, 2e3), (6, 40e3)):
        mesh.add_mass(node, mass, rotary_inertia=[0.2 * mass] * 3)
    model = bm.FemModel(mesh, [[0, 1, 2, 3]], rigid_links=[(4, [0, 1, 2, 3])])
    model = pickle.loads(pickle.dumps(model))
    ground = bm.SpringGround.under(model, 4, 60e6, 60e6)
    motion = bm.triaxial(bm.el_centro_1940().scaled(1.5), bm.el_centro_1940().scaled(1.2))
    simulation = bm.Simulation(0.005, model, ground, bm.Coulomb(0.6), motion=motion)
    run = simulation.run(400)
    assert run.energy_error < 1e-9
    sections = simulation.beam_sections(numbers[0])
    strains = (
        sections.axial_strain[:, None]
        - sections.curvature[:, None] * sections.fiber_position[:, 0]
        + sections.curvature_about_y[:, None] * sections.fiber_position[:, 1]
    )
    np.testing.assert_allclose(sections.fiber_strain, strains, atol=1e-15)
    forces = sections.fiber_stress * sections.fiber_area
    np.testing.assert_allclose(sections.moment_about_y, forces @ sections.fiber_position[:, 1], rtol=1e-6, atol=1.0)
    np.testing.assert_allclose(sections.torque, 1e8 * sections.twist_rate, rtol=1e-9, atol=1e-6)
    assert np.abs(sections.moment_about_y).max() > 1e4 and np.abs(sections.moment).max() > 1e4
    pytest.importorskip("pandas")
    assert sections.to_frame().attrs["units"]["torque"] == "N·m"


def test_an_elements_stiffness() -> None:
    mesh = bm.Mesh([[0.0, 0.0], [0.0, 5.0]])
    mesh.add_beams([[0, 1]], 30e9, 0.4, 0.02, 0.0)
    matrix = mesh.element_stiffness(0)
    assert matrix.shape == (6, 6)
    assert matrix[3, 3] == pytest.approx(12 * 30e9 * 0.02 / 5.0**3) and matrix[4, 4] == pytest.approx(30e9 * 0.4 / 5.0)
    with pytest.raises(bm.InputError, match="there is no element 1 among 1"):
        mesh.element_stiffness(1)


LINE = bm.Mesh([[0.0, 0.0], [0.0, 1.0]])
NODES = [[0, 1]]
REFUSED: list[tuple[str, Callable[[], object]]] = [
    ("yield stress of the steel is 0", lambda: bm.BilinearSteel(0.0, 200e9, 0.01)),
    ("hardening ratio of the steel is 1", lambda: bm.MenegottoPinto(400e6, 200e9, 1.0)),
    ("c₁ of the steel's transition", lambda: bm.MenegottoPinto(400e6, 200e9, 0.0, transition=[20.0, 1.0, 0.15])),
    ("ultimate stress of the concrete", lambda: bm.Concrete(30e6, 0.002, 31e6, 0.006)),
    ("fibres of a section", lambda: LINE.add_fiber_beams(NODES, bm.FiberSection(), 0.0)),
    ("area of a fibre", lambda: bm.FiberSection().with_fiber([0.0, 0.0], 0.0, STEEL)),
    ("areas has 2 entries, but must have one, or 3", lambda: bm.FiberSection().with_fibers(np.zeros((3, 2)), [0.1, 0.1], STEEL)),
    ("corners has 1 rows, but must have 2", lambda: bm.FiberSection().with_rectangle([[0.0, 1.0]], [1, 1], STEEL)),
    ("fibres along a side", lambda: bm.FiberSection().with_rectangle([[0.0, 0.0], [1.0, 1.0]], [1, 0], STEEL)),
    ("sectors of fibres", lambda: bm.FiberSection().with_ring([0.0, 0.0], [0.0, 1.0], [1, 2], STEEL)),
    ("number of sections along a beam is 6", lambda: LINE.add_fiber_beams(NODES, section(), 0.0, points=6)),
    ("quadrature is 'gauss', but must be 'lobatto' or 'legendre'", lambda: LINE.add_fiber_beams(NODES, section(), 0.0, quadrature="gauss")),  # type: ignore[arg-type]
    ("formulation is 'Force-based', but must be 'force_based'", lambda: LINE.add_fiber_beams(NODES, section(), 0.0, formulation="Force-based")),  # type: ignore[arg-type]
    ("section has 2 entries, but must have one, or 1", lambda: LINE.add_fiber_beams(NODES, [section()] * 2, 0.0)),
    ("must be a FemModel|is linear", lambda: shaken(model_of(fibers())).beam_sections(0)),
    ("must be in the plane", lambda: bm.Mesh.in_space([[0.0, 0.0, 0.0], [0.0, 0.0, 1.0]]).add_fiber_beams(NODES, section(), 0.0)),
    ("must be in space", lambda: LINE.add_space_fiber_beams(NODES, section(), 0.0, [1.0, 0.0, 0.0])),
    ("torsional stiffness", lambda: bm.Mesh.in_space([[0.0, 0.0, 0.0], [0.0, 0.0, 1.0]]).add_space_fiber_beams(NODES, in_space(None), 0.0, [1.0, 0.0, 0.0])),
    ("torsional stiffness of a section of fibres is 0", lambda: in_space(0.0)),
    ("is no law of a fibre", lambda: section(steel="steel")),
    ("is no law of a fibre", lambda: section(steel=Steel)),
    ("the law of a fibre has no method `energy`", lambda: section(steel=type("Part", (), {"response": 0})())),
    ("but no `variable_count`", lambda: section(steel=changed(variable_count=0))),
    ("variable_count of the law of a fibre is 1000000000", lambda: section(steel=changed(variable_count=10**9))),
    ("modulus of a fibre is -1", lambda: section(steel=changed(modulus=-1.0))),
    (r"initialize of the law of a fibre returned an array of shape \(1,\)", lambda: section(steel=changed(initialize=lambda self: [0.0]))),
    ("rows has 1 entries, but must have 2", lambda: bm.WithElements(bm.RigidBlock(4.0, 4.0, 2e3), LINE, [[0, 1, 2]])),
    ("rows of node 1 are 2, but must be 3", lambda: bm.WithElements(bm.RigidBlock(4.0, 4.0, 2e3), LINE, [[0, 1, 2], [0, 1]])),
    ("elements on a structure", lambda: bm.WithElements(bm.RigidBlock(4.0, 4.0, 2e3), LINE, [[0, 1, 2], [0, 1, 2]])),
]


def changed(**members: Any) -> Any:
    return type("Changed", (Steel,), members)()


@pytest.mark.parametrize(("message", "call"), REFUSED, ids=[message for message, _ in REFUSED])
def test_what_is_refused(message: str, call: Callable[[], object]) -> None:
    with pytest.raises((bm.InputError, TypeError), match=message):
        call()
    assert LINE.elements == []


def test_a_failed_call_adds_no_beam() -> None:
    mesh = copy.copy(bm.Mesh([[0.0, 0.0], [0.0, 1.0], [0.0, 2.0]]))
    with pytest.raises(bm.InputError, match="mass per length of the beam"):
        mesh.add_fiber_beams([[0, 1], [1, 2]], section(), [0.0, -1.0])
    assert mesh.elements == []
    assert mesh.add_fiber_beams([[0, 1], [1, 2]], [section(), section(steel=CURVED)], 0.0, compression=[1e5, 2e5]) == [0, 1]
