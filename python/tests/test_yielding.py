"""GOAL: solids that yield, by materials of the package and by materials written in Python.
SCENE: paths of strain through a material; columns of soil on a fixed base.
REFERENCE: Masing's rules on the backbone; the same laws written in numpy; a program of two-node cells.
"""

from __future__ import annotations

import copy
import pickle
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from conftest import same_bits

import basemat as bm
from basemat._program import Program

POINTS = [[1e-4, 2e3], [3e-4, 5e3], [1e-3, 10e3], [5e-3, 20e3], [2e-2, 25e3]]
CLAY = bm.Iwan(POINTS, 0.45, 1800.0)
ELASTIC = bm.Material(60e6, 0.3, 1900.0)
SAND = bm.DruckerPrager(ELASTIC, 1e3, 0.55, 0.55)
K0 = [-30e3, -50e3, -30e3, 0.0]
pytestmark = pytest.mark.filterwarnings("ignore::basemat.BasematWarning")
MOTION = bm.el_centro_1940().scaled(0.4)
DATA = Path(__file__).parents[2] / "tests" / "data" / "yielding"


class VonMises:
    """Von Mises' law: its shear stress √J₂ stays below a limit (Pa)."""

    variable_count = 5
    limit = 10e3
    shear, bulk = 60e6 / 2.6, 60e6 / 1.2
    density = 1900.0
    deviator = np.array([[2.0, -1.0, -1.0], [-1.0, 2.0, -1.0], [-1.0, -1.0, 2.0]]) / 3.0

    def elasticity(self) -> np.ndarray:
        matrix = np.zeros((4, 4))
        matrix[:3, :3] = 2.0 * self.shear * self.deviator + self.bulk
        matrix[3, 3] = self.shear
        return matrix

    def trial(self, strain: np.ndarray, variables: np.ndarray) -> tuple[np.ndarray, float, float]:
        """Deviator of the elastic stress, its √J₂, and the mean stress."""
        stress = self.elasticity() @ (strain - variables[:4])
        mean = stress[:3].mean()
        deviator = stress - mean * np.array([1.0, 1.0, 1.0, 0.0])
        return deviator, float(np.sqrt(0.5 * deviator[:3] @ deviator[:3] + deviator[3] ** 2)), mean

    def stress(self, strain: np.ndarray, variables: np.ndarray) -> np.ndarray:
        deviator, shear, mean = self.trial(strain, variables)
        return deviator * min(1.0, self.limit / max(shear, 1e-300)) + mean * np.array([1.0, 1.0, 1.0, 0.0])

    def tangent(self, strain: np.ndarray, variables: np.ndarray) -> np.ndarray:
        deviator, shear, _ = self.trial(strain, variables)
        matrix = self.elasticity()
        if shear <= self.limit:
            return matrix
        volume = np.zeros((4, 4))
        volume[:3, :3] = self.bulk
        # G s⊗s/J₂ is the derivative along the deviator, which has no stiffness.
        along = self.shear * np.outer(deviator, deviator) / shear**2
        return volume + self.limit / shear * (matrix - volume - along)

    def commit(self, strain: np.ndarray, variables: np.ndarray) -> np.ndarray:
        elastic = np.linalg.solve(self.elasticity(), self.stress(strain, variables))
        return np.append(strain - elastic, self.energy(strain, variables)[1])

    def energy(self, strain: np.ndarray, variables: np.ndarray) -> tuple[float, float]:
        stress = self.stress(strain, variables)
        stored = 0.5 * stress @ np.linalg.solve(self.elasticity(), stress)
        _, shear, _ = self.trial(strain, variables)
        multiplier = max(0.0, shear - self.limit) / self.shear
        return stored, variables[4] + self.limit * multiplier

    def state(self, strain: np.ndarray, variables: np.ndarray) -> tuple[float, float]:
        _, shear, _ = self.trial(strain, variables)
        plastic = self.commit(strain, variables)[:4]
        norm = np.sqrt(2.0 * plastic[:3] @ plastic[:3] + plastic[3] ** 2)
        return norm, min(1.0, shear / self.limit)


class Elastic:
    """The elastic material, without variables."""

    density = 1900.0

    def elasticity(self) -> np.ndarray:
        return VonMises().elasticity()

    def stress(self, strain: np.ndarray, variables: np.ndarray) -> np.ndarray:
        return self.elasticity() @ strain

    def tangent(self, strain: np.ndarray, variables: np.ndarray) -> np.ndarray:
        return self.elasticity()

    def energy(self, strain: np.ndarray, variables: np.ndarray) -> tuple[float, float]:
        return 0.5 * float(strain @ self.elasticity() @ strain), 0.0


MISES = bm.DruckerPrager(ELASTIC, VonMises.limit, 0.0, 0.0)


def block(material: Any, rows: int = 4, height: float = 8.0, **options: Any) -> bm.Mesh:
    """A column of elements 1 m wide up to y = 0."""
    return bm.Mesh.quad8_block([0.0, 1.0], np.linspace(-height, 0.0, rows + 1), material, **options)


def tied(mesh: bm.Mesh, **options: Any) -> bm.FemModel:
    """The column with its sides tied."""
    heights = sorted({y for x, y in mesh.nodes if x == 0.0})
    ties = [(mesh.node_at(0.0, y), [mesh.node_at(1.0, y)]) for y in heights]
    return bm.FemModel(mesh, ties=ties, **options)


def shaken(model: bm.Structure, motion: bm.FreeField = MOTION, time_step: float = 0.01, **options: Any) -> bm.Simulation:
    ground = bm.SpringGround.under(model, 2, 1e12, 1e12)
    without_weight = bm.InitialConditions(gravity=0.0)
    return bm.Simulation(
        time_step, model, ground, bm.Bonded(), motion=motion, initial=without_weight, fixed_base=True, **options
    )


def top(model: bm.FemModel) -> bm.Probe:
    return bm.Probe.displacement("top", model.row(model.node_at(0.0, 0.0), "x"))


def simple_shear(strains: Any) -> np.ndarray:
    return np.outer(strains, [0.0, 0.0, 0.0, 1.0])


def backbone(strain: float) -> float:
    xs, ys = np.vstack([[0.0, 0.0], POINTS]).T
    return float(np.sign(strain) * np.interp(abs(strain), xs, ys))


def test_simple_shear_follows_the_backbone_and_masings_rules() -> None:
    first = np.linspace(0.0, 8e-3, 50)
    stress = bm.stress_path(CLAY, simple_shear(first))
    assert stress.shape == (50, 4)
    np.testing.assert_allclose(stress[:, 3], [backbone(own) for own in first], atol=1e-6)
    np.testing.assert_allclose(stress[:, :3], 0.0, atol=1e-9)
    # Unloading has the backbone at twice the scale, down to the reversed strain and back.
    loop = np.concatenate([first, np.linspace(8e-3, -8e-3, 80), np.linspace(-8e-3, 8e-3, 80)])
    stress = bm.stress_path(CLAY, simple_shear(loop))[:, 3]
    turn = backbone(8e-3)
    down = [turn - 2.0 * backbone(0.5 * (8e-3 - own)) for own in loop[50:130]]
    up = [-turn + 2.0 * backbone(0.5 * (own + 8e-3)) for own in loop[130:]]
    np.testing.assert_allclose(stress[50:], down + up, atol=1e-6)
    # The loop's area is the damping of the curves by Masing's rules.
    area = np.sum(0.5 * (stress[51:] + stress[50:-1]) * np.diff(loop[50:]))
    ratio = area / (2.0 * np.pi * turn * 8e-3)
    reduction, damping = bm.StrainCurves.masing(CLAY.points).at([8e-3])
    assert damping[0] == pytest.approx(ratio, rel=0.02)
    assert reduction[0] == pytest.approx(turn / (20e6 * 8e-3), rel=0.01)
    _, perfectly_plastic = bm.StrainCurves.masing([[1e-3, 20e3]]).at([2e-3])
    assert perfectly_plastic[0] == pytest.approx(1.0 / np.pi, abs=2e-3)


def test_attributes_of_materials() -> None:
    assert (CLAY.shear_modulus, CLAY.strength) == (20e6, 25e3)
    assert CLAY.bulk_modulus == pytest.approx(2.0 * 20e6 * 1.45 / (3.0 * 0.1))
    np.testing.assert_array_equal(CLAY.points, POINTS)
    soft = bm.Iwan.hyperbolic(45.6e6, 40e3, 0.175, 0.49, 1900.0)
    assert soft.points.shape == (12, 2) and soft.points[-1] == pytest.approx([0.175, 40e3])
    curves = bm.StrainCurves.vucetic_dobry(30.0)
    stiff = pickle.loads(pickle.dumps(curves.iwan(45.6e6, 40e3, 0.49, 1900.0)))
    # G/G_max of the curves at 0.1 %.
    assert stiff.points[-2] == pytest.approx([1e-3, 45.6e3 * curves.at([1e-3])[0][0]]) and stiff.strength == 40e3
    assert (SAND.cohesion, SAND.friction_angle, SAND.dilation_angle) == (1e3, 0.55, 0.55)
    assert repr(SAND).startswith("DruckerPrager(") and repr(soft).startswith("Iwan.hyperbolic(")


def test_a_column_follows_a_program_of_two_node_cells() -> None:
    clay = bm.Iwan.hyperbolic(45.6e6, 40e3, 200.0 * 40e3 / 45.6e6, 0.3, 1900.0)
    times = np.arange(0.0, 8.0, 0.01)
    base = 3.0 * np.sin(3.0 * np.pi * times) * np.sin(np.pi * np.minimum(times / 6.0, 1.0)) ** 2
    model = tied(block(clay, 20, 20.0))
    simulation = shaken(model, bm.Record(0.01, base), probes=[top(model)])
    run = simulation.run(duration=7.9)
    table = np.genfromtxt(DATA / "column_iwan.csv", delimiter=",", names=True)
    reference = np.interp(run.time, table["t"], table["top_relative_displacement"])
    scale = np.abs(reference).max()
    assert np.abs(run["top"] - reference).max() < 0.03 * scale
    # Soil dissipates, and the balance closes by formulas of force and energies.
    last = simulation.state.energy_balance
    assert last.hysteresis > 0.0 and last.midstep_remainder > 0.0 and run.energy_error < 1e-9
    points = simulation.solid_points(0)
    assert 0.0 < points.largest_mobilised_strength <= 1.0 and points.mean_plastic_strain > 1e-4


def test_materials_of_ones_own_are_those_of_the_package() -> None:
    steps = np.random.default_rng(3).normal(scale=4e-4, size=(60, 4))
    path = np.cumsum(steps, axis=0)
    path[:, 2] = 0.0
    expected = bm.stress_path(MISES, path)
    np.testing.assert_allclose(bm.stress_path(VonMises(), path), expected, atol=1e-9 * np.abs(expected).max())
    np.testing.assert_allclose(
        bm.stress_path(Elastic(), path), bm.stress_path(ELASTIC, path), atol=1e-9 * np.abs(expected).max()
    )
    for own, package in ((VonMises(), MISES), (Elastic(), ELASTIC)):
        series = []
        for material in (own, package):
            model = tied(block(material))
            run = shaken(model, probes=[top(model)]).run(200)
            assert run.energy_error < 1e-9
            series.append(run["top"])
        np.testing.assert_allclose(series[0], series[1], atol=1e-9 * np.abs(series[1]).max())


def test_states_of_points_of_a_run() -> None:
    own, package = (shaken(tied(block(material))) for material in (VonMises(), MISES))
    for simulation in (own, package):
        simulation.run(300)
    mesh = block(MISES)
    for element in range(4):
        found, expected = own.solid_points(element), package.solid_points(element)
        assert found.element == element and found.area.sum() == pytest.approx(2.0)
        assert np.all(np.abs(found.position - [0.5, -7.0 + 2.0 * element]) < [0.5, 1.0])
        for name in ("position", "area", "strain", "stress", "plastic_strain", "mobilised_strength"):
            values = getattr(expected, name)
            tolerance = max(1e-9 * np.abs(values).max(), 1e-15)
            np.testing.assert_allclose(getattr(found, name), values, rtol=1e-6, atol=tolerance)
        mean = np.average(found.plastic_strain, weights=found.area)
        assert found.mean_plastic_strain == pytest.approx(mean)
        assert found.largest_mobilised_strength == found.mobilised_strength.max()
    elements, strains = package.solid_values("plastic_strain")
    assert elements == [0, 1, 2, 3] == package.structure.inelastic_elements
    assert strains[0] == package.solid_points(0).mean_plastic_strain > 1e-5 > strains[3] >= 0.0
    _, strengths = package.solid_values("mobilised_strength")
    assert strengths[0] == package.solid_points(0).largest_mobilised_strength
    pytest.importorskip("matplotlib").use("agg")
    mesh.plot_solids(elements, strains)
    assert same_bits(pickle.loads(pickle.dumps(package.solid_points(0))).stress, package.solid_points(0).stress)


def test_states_of_points_inside_other_structures() -> None:
    model = tied(block(CLAY))
    row = model.row(model.node_at(0.0, 0.0), "x") - model.row(model.node_at(0.0, -8.0), "x")
    for structure in (
        bm.WithSprings(model, [(row, bm.Bilinear(1e5, 1e3, 0.1))]),
        bm.WithModalDamping(model, [0.02], fixed_base=True),
    ):
        simulation = shaken(structure)
        simulation.run(100)
        assert simulation.solid_points(0).strain[0, 3] != 0.0


def test_simulations_have_separate_variables() -> None:
    model = tied(block(CLAY))
    first, second = shaken(model, probes=[top(model)]), shaken(model, probes=[top(model)])
    shear = first.run(300)["base_shear"]
    assert np.all(model.solid_points(0).strain == 0.0) and np.all(second.solid_points(0).strain == 0.0)
    assert same_bits(second.run(300)["base_shear"], shear)
    saved = pickle.loads(pickle.dumps(first.checkpoint()))
    rest = first.run(100)["base_shear"]
    first.reset()
    assert first.solid_points(0).plastic_strain.max() == 0.0
    assert same_bits(first.run(300)["base_shear"], shear)
    second.resume(saved)
    assert same_bits(second.run(100)["base_shear"], rest)


def test_initial_stresses() -> None:
    lines = np.linspace(-8.0, 0.0, 5)
    depths = 0.5 * (lines[:-1] + lines[1:])
    stresses = np.outer(depths, [10e3, 20e3, 10e3, 0.0])
    model = bm.FemModel(block(SAND, initial_stress=stresses))
    for element, stress in enumerate(stresses):
        np.testing.assert_allclose(model.solid_points(element).stress, np.tile(stress, (4, 1)))
    # The same by elements that are added.
    mesh = block(SAND)
    added = bm.Mesh(mesh.nodes)
    assert added.add_quads(mesh.elements, [SAND] * 4, initial_stress=stresses) == [0, 1, 2, 3]
    np.testing.assert_array_equal(bm.FemModel(added).solid_points(2).stress, model.solid_points(2).stress)
    corners = bm.Mesh([[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]])
    corners.add_quads([[0, 1, 2, 3]], SAND, formulation="mean_dilatation", initial_stress=K0)
    np.testing.assert_allclose(bm.FemModel(corners).solid_points(0).stress, np.tile(K0, (4, 1)))
    np.testing.assert_allclose(bm.stress_path(SAND, [0.0] * 4, initial_stress=K0), [K0])


def test_blocks_by_rows_and_columns() -> None:
    lines, rows = [0.0, 1.0, 3.0], [-2.0, -1.0, 0.0]
    for material in ([ELASTIC, [CLAY, ELASTIC]], np.array([[ELASTIC, ELASTIC], [CLAY, ELASTIC]], dtype=object)):
        mesh = bm.Mesh.quad8_block(lines, rows, material)
        assert bm.FemModel(mesh).inelastic_elements == [2]
        assert len(mesh.elements) == 4 and mesh.elements[0][0] == mesh.node_at(0.0, -2.0)
    assert bm.FemModel(bm.Mesh.quad8_block(lines, rows, [[CLAY, ELASTIC]])).inelastic_elements == [0, 2]


def test_models_pickle() -> None:
    for material in (CLAY, [MISES, [SAND], CLAY, CLAY], VonMises()):
        model = tied(block(material, initial_stress=np.zeros((4, 4))), rayleigh=bm.RayleighDamping(0.1, 1e-4))
        again = pickle.loads(pickle.dumps(model))
        assert same_bits(shaken(again).run(60)["base_shear"], shaken(model).run(60)["base_shear"])
    grid = np.array([[CLAY], [MISES]], dtype=object)
    # The known record needs no file of arrays.
    model = bm.FemModel(bm.Mesh.quad8_block([0.0, 1.0], [0.0, 1.0, 2.0], grid))
    simulation = shaken(model, bm.el_centro_1940())
    names: dict[str, Any] = {}
    exec(Program(simulation).text("arrays.npz"), names)
    assert same_bits(names["simulation"].run(60)["base_shear"], simulation.run(60)["base_shear"])
    curves = bm.StrainCurves.masing(POINTS)
    assert same_bits(pickle.loads(pickle.dumps(curves)).at([1e-3])[1], curves.at([1e-3])[1])


def changed(**members: Any) -> Any:
    return type("Changed", (VonMises,), members)()


REFUSED: list[tuple[str, Callable[[], object]]] = [
    ("point 2 of the backbone", lambda: bm.Iwan([[1e-3, 20e3], [2e-3, 50e3]], 0.4, 1800.0)),
    ("Poisson's ratio of the soil is 0.5", lambda: bm.Iwan(POINTS, 0.5, 1800.0)),
    (r"must be of shape \(n, 2\)", lambda: bm.Iwan([[1e-3, 20e3, 1.0]], 0.4, 1800.0)),
    ("dilation angle of the soil", lambda: bm.DruckerPrager(ELASTIC, 0.0, 0.5, 0.6)),
    ("must be zero", lambda: block(ELASTIC, initial_stress=K0)),
    ("strength of 25000 Pa", lambda: block(CLAY, initial_stress=[0.0, -90e3, 0.0, 0.0])),
    ('formulation must be "mean_dilatation"', lambda: bm.Mesh([[0, 0], [1, 0], [1, 1], [0, 1]]).add_quads([[0, 1, 2, 3]], CLAY, formulation="incompatible_modes")),
    ("material has 3 rows, but must have one, or 4", lambda: block([CLAY] * 3)),
    ("row 1 of material has 2 entries, but must have one, or 1", lambda: block([CLAY, [CLAY, CLAY], CLAY, CLAY])),
    ("initial_stress has 3 entries, but must have one, or 4", lambda: block(CLAY, initial_stress=np.zeros((3, 4)))),
    (r"must be of shape \(4,\) or \(n, 4\)", lambda: block(CLAY, initial_stress=[[0.0, 0.0, 0.0]])),
    ("grid lines of the block", lambda: bm.Mesh.quad8_block([0.0], [0.0, 1.0], CLAY)),
    ("is no material", lambda: block("clay")),
    ("is no material", lambda: block(VonMises)),
    ("the material has no method `energy`", lambda: block(type("Part", (), {"elasticity": 0, "stress": 0, "tangent": 0})())),
    ("but no `variable_count`", lambda: block(changed(variable_count=0))),
    ("variable_count of the material", lambda: block(changed(variable_count=10**9))),
    ("density of the material is -1", lambda: block(changed(density=-1.0))),
    ("elasticity of the material returned an array of shape", lambda: block(changed(elasticity=lambda self: np.eye(3)))),
    (r"stress of the material returned an array of shape \(3,\)", lambda: block(changed(stress=lambda *_: np.zeros(3)))),
    ("stress of the material returned NaN", lambda: block(changed(stress=lambda *_: np.full(4, np.nan)))),
    ("initialize of the material returned an array", lambda: block(changed(initialize=lambda self, _: [0.0]))),
    ("must be the initial stress", lambda: block(VonMises(), initial_stress=K0)),
    ("element 0: it is linear", lambda: bm.FemModel(block(ELASTIC)).solid_points(0)),
    ("must be a FemModel with materials that yield", lambda: shaken(tied(block(ELASTIC))).solid_points(0)),
    ("element", lambda: shaken(tied(block(CLAY))).solid_points(99)),
    ("quantity is 'stress'", lambda: shaken(tied(block(CLAY))).solid_values("stress")),  # type: ignore[arg-type]
    ("structure to be reduced", lambda: bm.ReducedModel(tied(block(CLAY)), 2)),
]


@pytest.mark.parametrize(("message", "call"), REFUSED, ids=[message for message, _ in REFUSED])
def test_what_is_refused(message: str, call: Callable[[], object]) -> None:
    with pytest.raises(bm.InputError, match=message):
        call()


class Failing(VonMises):
    """Raises in a method once the strain is large, or returns what it must not."""

    method, returned = "", None

    def __getattribute__(self, name: str) -> Any:
        found = super().__getattribute__(name)
        if name != super().__getattribute__("method"):
            return found

        def fail(strain: np.ndarray, variables: np.ndarray) -> Any:
            if np.abs(strain).max() < 1e-4:
                return found(strain, variables)
            if self.returned is None:
                raise ArithmeticError(name)
            return self.returned

        return fail


@pytest.mark.parametrize("method", ["stress", "tangent", "energy", "commit"])
def test_exceptions_of_a_material_come_out_of_the_run(method: str) -> None:
    material = Failing()
    material.method = method
    simulation = shaken(tied(block(material)))
    with pytest.raises(ArithmeticError, match=method):
        simulation.run(500)
    assert 0 < simulation.state.step < 500
    if method == "stress":
        # Other methods call it.
        return
    material.returned = np.zeros(3)
    simulation = shaken(tied(block(copy.copy(material))))
    with pytest.raises(bm.InputError, match=f"{method} of the material"):
        simulation.run(500)


def test_exceptions_of_a_state_come_out_of_its_call() -> None:
    material = Failing()
    material.method = "state"
    simulation = shaken(tied(block(material)))
    simulation.run(200)
    with pytest.raises(ArithmeticError, match="state"):
        simulation.solid_points(0)
    assert simulation.run(5).steps == 5
