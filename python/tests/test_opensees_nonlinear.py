"""GOAL: elements of OpenSees that yield in a run of basemat, by trial states that OpenSees does not commit.
SCENE: columns with fibres, hinges and braces on springs that uplift, in the plane and in space.
REFERENCE: the same columns on the same springs in OpenSees alone.
"""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from test_report_model import program_of

import basemat as bm
from basemat import opensees

try:
    import openseespy.opensees as ops
except (ImportError, RuntimeError):
    # Not there, or without the system's BLAS.
    pytest.skip("no OpenSees", allow_module_level=True)

import test_opensees_fibers as fibers  # noqa: E402

pytestmark = pytest.mark.filterwarnings("ignore::basemat.BasematWarning")
WIDTH, ELEMENTS, NORMAL, STEP, STEPS = fibers.WIDTH, fibers.ELEMENTS, fibers.NORMAL, fibers.STEP, fibers.STEPS
FORCE, RECORD, MASSES = fibers.FORCE, fibers.RECORD, fibers.MASSES


@pytest.fixture(autouse=True)
def wiped() -> Iterator[None]:
    """No model after a test."""
    yield
    ops.wipe()


def column(kind: str) -> None:
    """A column on the middle of its mat, node 1, with its mass on node 4."""
    ops.wipe()
    ops.model("basic", "-ndm", 2, "-ndf", 3)
    ops.uniaxialMaterial("Concrete02", 1, -35e6, -0.0025, -10e6, -0.01, 0.1, 2.5e6, 2e9)
    ops.uniaxialMaterial("Steel02", 2, 450e6, 200e9, 0.01, 18.0, 0.925, 0.15)
    ops.uniaxialMaterial("Steel02", 3, 7e5, 4e8, 0.02, 18.0, 0.925, 0.15)
    ops.uniaxialMaterial("Elastic", 4, 1e10)
    ops.section("Fiber", 1)
    ops.patch("rect", 1, 12, 1, -0.3, -0.5, 0.3, 0.5)
    for y in (-0.25, 0.25):
        ops.layer("straight", 2, 1, 2.4e-3, y, 0.0, y, 0.0)
    ops.geomTransf("PDelta", 1)
    ops.beamIntegration("Lobatto", 1, 1, 3)
    for tag, mass in MASSES.items():
        ops.node(tag, 0.0, 2.0 * (tag - 1))
        ops.mass(tag, mass, mass, 0.2 * mass)
        if tag == 1:
            continue
        if kind != "hinge":
            ops.element(kind, tag, tag - 1, tag, 1, 1)
        else:
            below = tag - 1
            if tag == 2:
                # A hinge that yields under the lowest beam, tied to the base.
                below = 10
                ops.node(10, 0.0, 0.0)
                ops.equalDOF(1, 10, 1, 2)
                ops.element("zeroLength", 10, 1, 10, "-mat", 3, "-dir", 6)
            ops.element("elasticBeamColumn", tag, below, tag, 0.3, 30e9, 5e-3, 1)
    if kind == "hinge":
        # A brace from the mat's side that yields.
        ops.node(11, 1.5, 0.0)
        ops.rigidLink("beam", 1, 11)
        ops.element("corotTruss", 20, 11, 3, 1e-4, 2)
    ops.rayleigh(0.0, 0.0, 2e-3, 0.0)


@pytest.mark.parametrize("kind", ["dispBeamColumn", "hinge"])
def test_a_column_yields_and_uplifts_as_in_opensees(kind: str) -> None:
    column(kind)
    model = opensees.structure(ops, [1], width=WIDTH)
    linear, _ = fibers.on_springs(model, model, 0.3)
    own, _ = fibers.on_springs(opensees.nonlinear_structure(ops, [1], width=WIDTH), model, 0.3)
    column(kind)
    reference = fibers.motion_of_opensees(fibers.MASSES, 1e-12, 50)
    for one, elastic, other in zip(own, linear, reference):
        np.testing.assert_allclose(one, other, rtol=0.0, atol=1e-9 * np.abs(other).max())
        assert np.abs(elastic - other).max() > 0.2 * np.abs(other).max()


@pytest.mark.filterwarnings("error::basemat.BasematWarning")
def test_no_warning_says_that_the_initial_tangent_stays() -> None:
    column("dispBeamColumn")
    model = opensees.nonlinear_structure(ops, [1], width=WIDTH)
    assert repr(model) == "NonlinearModel(4 nodes, 12 degrees of freedom)" and model.nodes == [1, 2, 3, 4]
    assert model.dof("4 x") == model.row(4) and len(bm.DeformedShape(model).points) == 4


def test_trials_leave_no_trace() -> None:
    column("dispBeamColumn")
    model = opensees.structure(ops, [1], width=WIDTH)
    own = opensees.nonlinear_structure(ops, [1], width=WIDTH)
    pushed = 0.1 * model.row(4).weights(model.dofs)
    first = own.force(pushed)
    assert np.abs(first).max() > 0.2 * np.abs(model.stiffness() @ pushed).max()
    back = own.force(-pushed)
    assert np.array_equal(own.force(pushed), first) and not np.array_equal(back, -first)
    assert np.abs(own.force(0.0 * pushed)).max() < 1e-9
    own.commit(pushed)
    assert np.array_equal(own.force(pushed), first)
    assert np.abs(own.force(0.0 * pushed)).max() > 1e5


def test_elements_without_trials_are_refused() -> None:
    """A force-based element follows increments of its nodes, which a refused step has not."""
    column("forceBeamColumn")
    with pytest.raises(bm.InputError, match="cannot be tried before a commit, or were not tested: ForceBeamColumn2d: 2, 3, 4"):
        opensees.nonlinear_structure(ops, [1], width=WIDTH)
    space_column("Corotational")
    with pytest.raises(bm.InputError, match="DispBeamColumn3d, CorotCrdTransf3d: 2, 3, 4"):
        opensees.nonlinear_structure(ops, [1], outline=OUTLINE)


def test_a_second_simulation_of_a_model_is_refused() -> None:
    column("dispBeamColumn")
    own = opensees.nonlinear_structure(ops, [1], width=WIDTH)
    ground = bm.SpringGround.under(own, 4, NORMAL, NORMAL)
    bm.Simulation(STEP, own, ground, bm.Bonded()).run(2)
    with pytest.raises(bm.Error, match="another simulation"):
        bm.Simulation(STEP, own, ground, bm.Bonded())


def test_a_page_says_that_the_model_is_in_opensees(tmp_path: Path) -> None:
    pytest.importorskip("matplotlib").use("agg")
    column("dispBeamColumn")
    own = opensees.nonlinear_structure(ops, [1], width=WIDTH)
    simulation = bm.Simulation(STEP, own, bm.SpringGround.under(own, 4, NORMAL, NORMAL), bm.Bonded(), motion=RECORD)
    run = simulation.run(20, motion_every=5, contact_every=5)
    run.report(tmp_path / "run.html", simulation)
    page = (tmp_path / "run.html").read_text("utf-8")
    assert "The program needs the model of OpenSees, which basemat.opensees.nonlinear_structure takes" in page
    assert "<td>NonlinearModel(4 nodes, 12 degrees of freedom)</td>" in page and "<h2>Largest deformation</h2>" in page


def test_the_program_of_a_page_has_the_beams_of_fibres(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Those that yield in basemat, whose matrices are not in the stiffness of the model."""
    pytest.importorskip("matplotlib").use("agg")
    fibers.column("dispBeamColumn", "Steel01")
    model = opensees.structure(ops, [1], width=WIDTH)
    ground = bm.SpringGround.under(model, ELEMENTS, NORMAL, NORMAL)
    simulation = bm.Simulation(STEP, model, ground, bm.Coulomb(0.5), motion=bm.el_centro_1940().scaled(4.0))
    run = simulation.run(600, warn=False)
    assert model.fiber_beams and (run.energy_fractions or {})["hysteresis"] > 0.01
    run.report(tmp_path / "run.html", simulation)
    text = program_of((tmp_path / "run.html").read_text("utf-8"), tmp_path)
    monkeypatch.chdir(tmp_path)
    names: dict[str, Any] = {}
    exec(text, names)
    np.testing.assert_array_equal(names["run"]["base_shear"], run["base_shear"])


OUTLINE = [(-2.0, -2.0), (2.0, -2.0), (2.0, 2.0), (-2.0, 2.0)]
CELLS, SPACE_STEPS, SPACE_FORCE = 4, 600, 150e3
RECORDS = RECORD, RECORD.padded(0.4, 0.0).scaled(-0.7).resampled(STEP)
"""Along x and along y."""


def space_column(transformation: str = "PDelta") -> None:
    """A column of fibres in space on the middle of its mat, node 1."""
    ops.wipe()
    ops.model("basic", "-ndm", 3, "-ndf", 6)
    ops.uniaxialMaterial("Concrete02", 1, -35e6, -0.0025, -10e6, -0.01, 0.1, 2.5e6, 2e9)
    ops.uniaxialMaterial("Steel02", 2, 450e6, 200e9, 0.01, 18.0, 0.925, 0.15)
    ops.section("Fiber", 1, "-GJ", 2e8)
    ops.patch("rect", 1, 6, 6, -0.4, -0.5, 0.4, 0.5)
    for y in (-0.35, 0.35):
        for z in (-0.45, 0.45):
            ops.fiber(y, z, 2e-3, 2)
    ops.geomTransf(transformation, 1, 1.0, 0.0, 0.0)
    ops.beamIntegration("Lobatto", 1, 1, 3)
    for tag, mass in MASSES.items():
        ops.node(tag, 0.0, 0.0, 2.0 * (tag - 1))
        ops.mass(tag, mass, mass, mass, 0.2 * mass, 0.3 * mass, 0.3 * mass)
        if tag > 1:
            ops.element("dispBeamColumn", tag, tag - 1, tag, 1, 1)
    ops.rayleigh(0.0, 0.0, 2e-3, 0.0)


ROWS = {"x": (4, "x"), "y": (4, "y"), "rx": (1, "rx"), "ry": (1, "ry")}
"""Probes: displacements of the top and rotations of the base."""


def found_in_space(structure: Any) -> np.ndarray:
    ground = bm.SpringGround.under(structure, CELLS, NORMAL, 1e3, theta=1.0)
    loads = []
    for name, record in zip("xy", RECORDS):
        for tag, force in ((4, SPACE_FORCE), (1, -SPACE_FORCE)):
            loads.append(bm.Load.record(structure.row(tag, name), record, force))
    simulation = bm.Simulation(
        STEP,
        structure,
        ground,
        bm.Coulomb(0.0),
        loads=loads,
        probes=[bm.Probe.displacement(name, structure.row(*row)) for name, row in ROWS.items()],
        solver=bm.SolverOptions(scheme=bm.TimeScheme.newmark()),
    )
    run = simulation.run(SPACE_STEPS, warn=False)
    assert run.uplifted_fraction.value > 0.3
    return np.array([run[name] for name in ROWS])


def expected_in_space() -> np.ndarray:
    """The same by OpenSees alone, on springs without tension in the middle of each cell."""
    length = 4.0 / CELLS
    ops.uniaxialMaterial("ENT", 10, NORMAL * length**2)
    for k, (i, j) in enumerate((i, j) for j in range(CELLS) for i in range(CELLS)):
        place, tag = ((i + 0.5) * length - 2.0, (j + 0.5) * length - 2.0, 0.0), 100 + k
        ops.node(tag, *place)
        ops.rigidLink("beam", 1, tag)
        ops.node(tag + 100, *place)
        ops.fix(tag + 100, 1, 1, 1, 1, 1, 1)
        ops.element("zeroLength", tag, tag + 100, tag, "-mat", 10, "-dir", 3, "-doRayleigh", 0)
    ops.timeSeries("Linear", 1)
    ops.pattern("Plain", 1, 1)
    for tag, mass in MASSES.items():
        ops.load(tag, 0.0, 0.0, -bm.STANDARD_GRAVITY * mass, 0.0, 0.0, 0.0)
    ops.fix(1, 1, 1, 0, 0, 0, 1)
    fibers.analysis(("LoadControl", 1.0), "Static", 1e-12, 50)
    assert ops.analyze(1) == 0
    ops.loadConst("-time", 0.0)
    for k, record in enumerate(RECORDS, 1):
        direction = [float(k == 1), float(k == 2), 0.0, 0.0, 0.0, 0.0]
        ops.timeSeries("Path", 1 + k, "-dt", STEP, "-values", *record.accelerations)
        ops.pattern("Plain", 1 + k, 1 + k, "-fact", SPACE_FORCE)
        ops.load(4, *direction)
        ops.load(1, *(-component for component in direction))
    for k in (1, 2, 6):
        ops.remove("sp", 1, k)
    fibers.analysis(("Newmark", 0.5, 0.25), "Transient", 1e-12, 50)

    def state() -> list[float]:
        return [ops.nodeDisp(4, 1), ops.nodeDisp(4, 2), ops.nodeDisp(1, 4), ops.nodeDisp(1, 5)]

    states = [state()]
    for _ in range(SPACE_STEPS):
        assert ops.analyze(1, STEP) == 0
        states.append(state())
    return (np.array(states) - states[0]).T


def test_a_column_in_space_yields_and_uplifts_as_in_opensees() -> None:
    space_column()
    model = opensees.structure(ops, [1], outline=OUTLINE)
    linear = found_in_space(model)
    own = found_in_space(opensees.nonlinear_structure(ops, [1], outline=OUTLINE))
    space_column()
    reference = expected_in_space()
    for one, elastic, other in zip(own, linear, reference):
        np.testing.assert_allclose(one, other, rtol=0.0, atol=1e-9 * np.abs(other).max())
        assert np.abs(elastic - other).max() > 0.1 * np.abs(other).max()


def test_linear_elements_in_space_have_the_forces_of_their_stiffness() -> None:
    ops.wipe()
    ops.model("basic", "-ndm", 3, "-ndf", 6)
    ops.section("ElasticMembranePlateSection", 1, 30e9, 0.2, 0.5, 2500.0)
    for j in range(3):
        for i in range(3):
            ops.node(10 * j + i + 1, 2.0 * i, 2.0 * j, 0.0)
    shells = []
    for i, j in ((i, j) for j in range(2) for i in range(2)):
        shells.append(100 + 10 * j + i)
        first = 10 * j + i + 1
        ops.element("ShellMITC4", shells[-1], first, first + 1, first + 11, first + 10, 1)
    ops.geomTransf("Linear", 1, 1.0, 0.0, 0.0)
    for tag, height in ((50, 3.0), (51, 3.0), (52, 6.0)):
        ops.node(tag, 2.0, 2.0, height)
        ops.mass(tag, 1e4, 1e4, 1e4, 1e3, 1e3, 1e3)
    ops.uniaxialMaterial("Elastic", 1, 2e8)
    ops.uniaxialMaterial("Elastic", 2, 200e9)
    ops.element("elasticBeamColumn", 1, 12, 50, 0.2, 30e9, 12e9, 5e-3, 4e-3, 3e-3, 1)
    ops.element("zeroLength", 2, 50, 51, "-mat", 1, 1, 1, 1, 1, 1, "-dir", 1, 2, 3, 4, 5, 6)
    ops.element("elasticBeamColumn", 3, 51, 52, 0.2, 30e9, 12e9, 5e-3, 4e-3, 3e-3, 1)
    ops.element("Truss", 4, 1, 52, 1e-3, 2)
    stiffness = np.asarray(opensees.structure(ops, faces=shells).stiffness())
    own = opensees.nonlinear_structure(ops, faces=shells)
    rng = np.random.default_rng(1)
    for _ in range(3):
        u = 1e-3 * rng.normal(size=own.dofs)
        total = own.force(u) + own.stiffness() @ u
        np.testing.assert_allclose(total, stiffness @ u, rtol=0.0, atol=1e-9 * np.abs(stiffness @ u).max())
        np.testing.assert_allclose(own.tangent(u) + own.stiffness(), stiffness, rtol=0.0, atol=1e-9 * np.abs(stiffness).max())
        own.commit(u)
