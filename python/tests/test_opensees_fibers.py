"""GOAL: beams of fibres of OpenSees yield in a run of basemat as in OpenSees.
SCENE: columns of concrete and steel on springs that uplift; laws and elements that stay linear.
REFERENCE: the same columns on the same springs in OpenSees alone; the program of the tables in tests/data/fibers.
"""

from __future__ import annotations

import csv
import importlib.util
import pickle
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import basemat as bm
from basemat import _opensees_matrices, opensees

try:
    import openseespy.opensees as ops
except (ImportError, RuntimeError):
    # Not there, or without the system's BLAS.
    pytest.skip("no OpenSees", allow_module_level=True)

DATA = Path(__file__).parents[2] / "tests" / "data" / "fibers"
WIDTH, ELEMENTS, NORMAL, STEP, STEPS = 4.0, 8, 60e6, 0.005, 1200
FORCE, RECORD = 40e3, bm.el_centro_1940().resampled(STEP)
MASSES = {1: 30e3, 2: 3e3, 3: 3e3, 4: 40e3}
LAWS: dict[str, tuple[object, ...]] = {
    "Steel01": (450e6, 200e9, 0.01),
    "Steel02": (450e6, 200e9, 0.01, 18.0, 0.925, 0.15, 0.02, 8.0, 0.03, 9.0),
    "Concrete01": (-35.123456789e6, -0.0025123456789, -10e6, -0.01),
}


def program() -> Any:
    """The program that wrote the tables."""
    spec = importlib.util.spec_from_file_location("fiber_tables", DATA / "opensees.py")
    assert spec and spec.loader
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def test_tables_are_those_of_this_opensees() -> None:
    made = program()
    with (DATA / "opensees_laws.csv").open() as file:
        laws = [(row["law"], float(row["strain"]), float(row["stress_pa"])) for row in csv.DictReader(file)]
    found = list(made.law_rows())
    assert [row[0] for row in found] == [row[0] for row in laws]
    np.testing.assert_allclose([row[1:] for row in found], [row[1:] for row in laws], rtol=1e-12, atol=1e-6)
    with (DATA / "opensees_cantilevers.csv").open() as file:
        rows = [list(row.values()) for row in csv.DictReader(file)]
    for element, steel in (("dispBeamColumn", "curved"), ("forceBeamColumn", "bilinear")):
        expected = np.array([row[2:] for row in rows if row[:2] == [element, steel]], float)
        computed = np.array(list(made.cantilever_rows(element, steel)))
        scale = np.abs(expected).max(axis=0)
        np.testing.assert_allclose(computed / scale, expected / scale, rtol=0.0, atol=1e-9)


def column(element: str, steel: str, *, offset: float = 0.0, integration: str = "Lobatto") -> None:
    """A column on the middle of its mat, node 1, with its mass on node 4; bars only on one side move its axis."""
    ops.wipe()
    ops.model("basic", "-ndm", 2, "-ndf", 3)
    ops.uniaxialMaterial("Concrete01", 1, *LAWS["Concrete01"])
    ops.uniaxialMaterial(steel, 2, *LAWS[steel])
    ops.uniaxialMaterial("Elastic", 3, 30.123456789e9)
    ops.section("Fiber", 1)
    ops.patch("rect", 1, 12, 1, -0.3, -0.5, 0.3 + offset, 0.5)
    ops.layer("straight", 2, 3, 0.8e-3, -0.25, -0.4, -0.25, 0.4)
    ops.layer("straight", 2, 3, 0.8e-3, 0.25, -0.4, 0.25, 0.4)
    ops.fiber(0.0, 0.0, 1e-3, 3)
    ops.geomTransf("Linear", 1)
    ops.beamIntegration(integration, 1, 1, 4)
    iterations = ("-iter", 60, 1e-18) if element == "forceBeamColumn" else ()
    for tag, mass in MASSES.items():
        ops.node(tag, 0.0, 2.0 * (tag - 1))
        ops.mass(tag, mass, mass, 0.2 * mass)
        if tag > 1:
            ops.element(element, tag, tag - 1, tag, 1, 1, *iterations, "-mass", 1234.5)
    # A linear column beside it, on a rigid arm.
    ops.node(11, 1.5, 0.0)
    ops.rigidLink("beam", 1, 11)
    ops.element("elasticBeamColumn", 20, 11, 2, 0.02, 30e9, 1e-4, 1)
    # By the initial stiffness.
    ops.rayleigh(0.0, 0.0, 2e-3, 0.0)


def on_springs(structure: Any, model: opensees.OpenSeesModel, min_uplift: float) -> tuple[np.ndarray, bm.Simulation]:
    """Displacements of the top and rotations of the base on springs that uplift, a couple of forces apart."""
    strip = bm.Strip(-0.5 * WIDTH, 0.5 * WIDTH, ELEMENTS, grading="uniform")
    # Tractions that end a step belong to its end, as in OpenSees.
    ground = bm.SpringGround(strip, NORMAL, 1e3, theta=1.0)
    loads = [bm.Load.record(model.row(tag), RECORD, force) for tag, force in ((4, FORCE), (1, -FORCE))]
    rows = {"top": model.row(4), "rotation": model.row(1, "rotation")}
    simulation = bm.Simulation(
        STEP,
        structure,
        ground,
        bm.Coulomb(0.0),
        loads=loads,
        probes=[bm.Probe.displacement(name, row) for name, row in rows.items()],
        solver=bm.SolverOptions(scheme=bm.TimeScheme.newmark()),
    )
    run = simulation.run(STEPS, warn=False)
    assert run.uplifted_fraction.value > min_uplift
    return np.array([run[name] for name in rows]), simulation


def analysis(integrator: tuple[object, ...], kind: str, tolerance: float, iterations: int) -> None:
    ops.wipeAnalysis()
    ops.constraints("Transformation")
    ops.numberer("Plain")
    ops.system("FullGeneral")
    ops.test("NormDispIncr", tolerance, iterations, 0)
    ops.algorithm("Newton")
    ops.integrator(*integrator)
    ops.analysis(kind)


def motion_of_opensees(masses: dict[int, float], tolerance: float, iterations: int) -> np.ndarray:
    """The same by OpenSees alone, on springs without tension; ``masses``: of the nodes, for their weights."""
    length = WIDTH / ELEMENTS
    ops.uniaxialMaterial("ENT", 10, NORMAL * length)
    for k in range(ELEMENTS):
        x, tag = (k + 0.5) * length - 0.5 * WIDTH, 100 + k
        ops.node(tag, x, 0.0)
        ops.rigidLink("beam", 1, tag)
        ops.node(tag + 100, x, 0.0)
        ops.fix(tag + 100, 1, 1, 1)
        ops.element("zeroLength", tag, tag + 100, tag, "-mat", 10, "-dir", 2, "-doRayleigh", 0)
    ops.timeSeries("Linear", 1)
    ops.pattern("Plain", 1, 1)
    for tag, mass in masses.items():
        ops.load(tag, 0.0, -bm.STANDARD_GRAVITY * mass, 0.0)
    ops.fix(1, 1, 0, 0)
    # In several steps OpenSees moves a fixed node that others are tied to once more by all that it has moved so far:
    # the hinge of a braced column with P-Delta would begin with a wrong rotation.
    analysis(("LoadControl", 1.0), "Static", tolerance, iterations)
    assert ops.analyze(1) == 0
    ops.loadConst("-time", 0.0)
    ops.remove("sp", 1, 1)
    ops.timeSeries("Path", 2, "-dt", STEP, "-values", *RECORD.accelerations)
    ops.pattern("Plain", 2, 2, "-fact", FORCE)
    ops.load(4, 1.0, 0.0, 0.0)
    ops.load(1, -1.0, 0.0, 0.0)
    analysis(("Newmark", 0.5, 0.25), "Transient", tolerance, iterations)
    rows = [(ops.nodeDisp(4, 1), ops.nodeDisp(1, 3))]
    for _ in range(STEPS):
        assert ops.analyze(1, STEP) == 0
        rows.append((ops.nodeDisp(4, 1), ops.nodeDisp(1, 3)))
    return (np.array(rows) - rows[0]).T


def expected() -> tuple[np.ndarray, np.ndarray]:
    """Motion by OpenSees alone, and moments of the lowest column's sections at the end."""
    # The mass of the elements is in the halves at their nodes.
    masses = {tag: mass + 1234.5 * 2.0 * (1.0 if tag in (2, 3) else 0.5) for tag, mass in MASSES.items()}
    motion = motion_of_opensees(masses, 1e-14, 100)
    return motion, np.array([ops.eleResponse(2, "section", k, "force")[1] for k in range(1, 5)])


@pytest.mark.parametrize("steel", ["Steel01", "Steel02"])
@pytest.mark.parametrize(
    ("element", "integration", "offset", "tolerance"),
    [
        ("dispBeamColumn", "Lobatto", 0.0, 1e-8),
        ("dispBeamColumn", "Legendre", 0.1, 1e-8),
        ("forceBeamColumn", "Lobatto", 0.0, 1e-6),
        ("forceBeamColumn", "Legendre", 0.1, 1e-6),
    ],
)
@pytest.mark.usefixtures("interruptible")
@pytest.mark.filterwarnings("error")
def test_fibres_yield_as_in_opensees(element: str, integration: str, offset: float, tolerance: float, steel: str) -> None:
    column(element, steel, offset=offset, integration=integration)
    model = opensees.structure(ops, [1], width=WIDTH)
    assert model.fiber_beams == {2: 0, 3: 1, 4: 2}
    pickled = pickle.loads(pickle.dumps(model))
    own, simulation = on_springs(pickled, pickled, 0.2)
    with pytest.warns(bm.BasematWarning, match="not linear: elements 2, 3, 4"):
        linear_model = opensees.structure(ops, [1], width=WIDTH, fibers="linear")
    linear, _ = on_springs(linear_model, linear_model, 0.2)
    column(element, steel, offset=offset, integration=integration)
    reference, moments = expected()
    for one, other in zip(own, reference):
        np.testing.assert_allclose(one, other, rtol=0.0, atol=tolerance * np.abs(other).max())
    assert np.abs(linear - reference).max() > 0.05 * np.abs(reference).max()
    sections = simulation.beam_sections(model.fiber_beams[2])
    np.testing.assert_allclose(sections.moment, moments, rtol=0.0, atol=10.0 * tolerance * np.abs(moments).max())


def test_the_stiffness_at_rest_is_that_of_opensees() -> None:
    """What the matrix loses, the beams have."""
    column("dispBeamColumn", "Steel01", offset=0.1)
    model = opensees.structure(ops, [1], width=WIDTH)
    with pytest.warns(bm.BasematWarning, match="not linear"):
        whole = opensees.structure(ops, [1], width=WIDTH, fibers="linear")
    assert np.array_equal(model.mass(), whole.mass())
    taken = whole.stiffness() - model.stiffness()
    rigid = sum(model.row(node).weights(model.dofs) for node in (1, 2, 3, 4))
    assert np.abs(taken @ rigid).max() < 1e-12 * np.abs(taken).max()
    # Only the linear column is left.
    assert np.linalg.matrix_rank(model.stiffness(), tol=1e-3) == 3
    row = model.row(4, "rotation").weights(model.dofs)
    assert not (model.stiffness() @ row).any()


def refused(materials: list[tuple[object, ...]], **options: Any) -> str:
    """The warning about the model of columns of these materials."""
    ops.wipe()
    ops.model("basic", "-ndm", 2, "-ndf", 3)
    for number, (kind, *numbers) in enumerate(materials, 1):
        ops.uniaxialMaterial(kind, number, *numbers)
    ops.section("Fiber", 1)
    for y in (-0.2, 0.2):
        ops.fiber(y, 0.0, 0.01, 1)
        ops.fiber(y, 0.0, 0.01, len(materials))
    ops.section("Elastic", 2, 200e9, 0.04, 0.001)
    ops.geomTransf("Linear", 1)
    ops.geomTransf("PDelta", 2)
    rule = options.get("integration", ("Lobatto", 3))
    ops.beamIntegration(rule[0], 1, 1, *rule[1:])
    for tag in (1, 2):
        ops.node(tag, 0.0, 3.0 * tag)
        ops.mass(tag, 1e4, 1e4, 1e3)
    ops.element(options.get("element", "dispBeamColumn"), 7, 1, 2, options.get("transformation", 1), 1)
    with pytest.warns(bm.BasematWarning, match="not linear") as caught:
        model = opensees.structure(ops, [1], width=WIDTH)
    assert model.fiber_beams == {}
    assert np.abs(model.stiffness()).max() > 1e6
    return str(caught[0].message)


def test_what_stays_linear_is_named_with_its_reason() -> None:
    steel = ("Steel01", 450e6, 200e9, 0.01)
    text = refused([steel, ("Concrete02", -35e6, -0.0025, -10e6, -0.01, 0.1, 2.5e6, 2e9)])
    assert "element 7 (DispBeamColumn2d, section 1 FiberSection2d, material 1 Steel01, material 2 Concrete02)" in text
    assert "initial tangent is taken" in text and "not in element 7 for its section 1, material 2 Concrete02" in text
    for materials, reason in (
        ([("Steel01", 450e6, 200e9, 0.01, 0.02, 8.0, 0.02, 8.0)], "material 1 Steel01: isotropic hardening"),
        ([("Steel02", 450e6, 200e9, 0.01, 18.0, 0.925, 0.15, 0.0, 1.0, 0.0, 1.0, 5e6)], "Steel02: initial stress"),
        ([steel, ("Elastic", 30e9, 1e6)], "material 2 ElasticMaterial: viscous damping"),
        ([("Concrete01", -30e6, -0.002, -40e6, -0.006), ("Elastic", 30e9)], "Concrete01: ultimate stress of the concrete"),
    ):
        assert reason in refused(materials)
    assert "transformation 2 PDeltaCrdTransf2d, not Linear" in refused([steel], transformation=2)
    assert "integration Lobatto with 7 points" in refused([steel], integration=("Lobatto", 7))
    assert "integration NewtonCotes with 3 points" in refused([steel], integration=("NewtonCotes", 3))


def test_fibres_begin_without_stress() -> None:
    column("dispBeamColumn", "Steel01")
    ops.fix(1, 1, 1, 1)
    ops.timeSeries("Linear", 1)
    ops.pattern("Plain", 1, 1)
    ops.load(4, 0.0, -1e4, 0.0)
    analysis(("LoadControl", 1.0), "Static", 1e-14, 100)
    assert ops.analyze(1) == 0
    for direction in (1, 2, 3):
        ops.remove("sp", 1, direction)
    with pytest.raises(bm.InputError, match=r"ops\.reset\(\)"):
        opensees.structure(ops, [1], width=WIDTH)
    with pytest.warns(bm.BasematWarning, match="present tangent"):
        opensees.structure(ops, [1], width=WIDTH, tangent="present")
    ops.reset()
    assert len(opensees.structure(ops, [1], width=WIDTH).fiber_beams) == 3
    with pytest.raises(bm.InputError, match="fibers is 'elastic', but must be 'yielding' or 'linear'"):
        opensees.structure(ops, [1], width=WIDTH, fibers="elastic")  # type: ignore[arg-type]


def test_large_models_are_sparse(monkeypatch: pytest.MonkeyPatch) -> None:
    sparse = pytest.importorskip("scipy.sparse")
    column("dispBeamColumn", "Steel01")
    dense = opensees.structure(ops, [1], width=WIDTH)
    monkeypatch.setattr(_opensees_matrices, "DENSE", 3)
    model = opensees.structure(ops, [1], width=WIDTH)
    assert sparse.issparse(model.stiffness())
    np.testing.assert_allclose(model.stiffness().toarray(), dense.stiffness(), atol=1e-9 * np.abs(dense.stiffness()).max())
    assert np.array_equal(on_springs(model, model, 0.2)[0][0] != 0.0, on_springs(dense, dense, 0.2)[0][0] != 0.0)
