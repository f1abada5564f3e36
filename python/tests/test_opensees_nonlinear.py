"""GOAL: elements of OpenSees that yield in a run of basemat, by trial states that OpenSees does not commit.
SCENE: columns with fibres, hinges and braces on springs that uplift; the class of the page opensees_nonlinear.
REFERENCE: the same columns on the same springs in OpenSees alone.
"""

from __future__ import annotations

import sys
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import basemat as bm
from basemat import opensees

try:
    import openseespy.opensees as ops
except (ImportError, RuntimeError):
    # Not there, or without the system's BLAS.
    pytest.skip("no OpenSees", allow_module_level=True)

sys.path.insert(0, str(Path(__file__).parents[1] / "tools"))
import pages  # noqa: E402

pytestmark = pytest.mark.filterwarnings("ignore::basemat.BasematWarning")
WIDTH, ELEMENTS, NORMAL, STEP, STEPS = 4.0, 8, 60e6, 0.005, 1200
FORCE, RECORD = 40e3, bm.el_centro_1940().resampled(STEP)
MASSES = {1: 30e3, 2: 3e3, 3: 3e3, 4: 40e3}


@pytest.fixture(scope="module")
def of_page() -> Iterator[Any]:
    """The class of the page."""
    names: dict[str, Any] = {"__name__": "__main__"}
    exec(pages.programs(pages.DOCS / "gallery" / "opensees_nonlinear.md")[0], names)
    yield names["NonlinearModel"]
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


def found(structure: Any, model: opensees.OpenSeesModel) -> np.ndarray:
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
    assert run.uplifted_fraction.value > 0.3
    return np.array([run[name] for name in rows])


def analysis(integrator: tuple[object, ...], kind: str) -> None:
    ops.wipeAnalysis()
    ops.constraints("Transformation")
    ops.numberer("Plain")
    ops.system("FullGeneral")
    ops.test("NormDispIncr", 1e-12, 50, 0)
    ops.algorithm("Newton")
    ops.integrator(*integrator)
    ops.analysis(kind)


def expected() -> np.ndarray:
    """The same by OpenSees alone, on springs without tension."""
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
    for tag, mass in MASSES.items():
        ops.load(tag, 0.0, -bm.STANDARD_GRAVITY * mass, 0.0)
    ops.fix(1, 1, 0, 0)
    # In several steps OpenSees moves a fixed node that others are tied to once more by all that it has moved so far:
    # the hinge of a braced column with P-Delta would begin with a wrong rotation.
    analysis(("LoadControl", 1.0), "Static")
    assert ops.analyze(1) == 0
    ops.loadConst("-time", 0.0)
    ops.remove("sp", 1, 1)
    ops.timeSeries("Path", 2, "-dt", STEP, "-values", *RECORD.accelerations)
    ops.pattern("Plain", 2, 2, "-fact", FORCE)
    ops.load(4, 1.0, 0.0, 0.0)
    ops.load(1, -1.0, 0.0, 0.0)
    analysis(("Newmark", 0.5, 0.25), "Transient")
    rows = [(ops.nodeDisp(4, 1), ops.nodeDisp(1, 3))]
    for _ in range(STEPS):
        assert ops.analyze(1, STEP) == 0
        rows.append((ops.nodeDisp(4, 1), ops.nodeDisp(1, 3)))
    return (np.array(rows) - rows[0]).T


@pytest.mark.parametrize("kind", ["dispBeamColumn", "hinge"])
def test_a_column_yields_and_uplifts_as_in_opensees(of_page: Any, kind: str) -> None:
    column(kind)
    model = opensees.structure(ops, [1], width=WIDTH)
    own = found(of_page(model), model)
    linear = found(model, model)
    column(kind)
    reference = expected()
    for one, elastic, other in zip(own, linear, reference):
        np.testing.assert_allclose(one, other, rtol=0.0, atol=1e-9 * np.abs(other).max())
        assert np.abs(elastic - other).max() > 0.2 * np.abs(other).max()


def test_trials_leave_no_trace(of_page: Any) -> None:
    column("dispBeamColumn")
    model = opensees.structure(ops, [1], width=WIDTH)
    own = of_page(model)
    pushed = 0.1 * model.row(4).weights(model.dofs)
    first = own.force(pushed)
    assert np.abs(first).max() > 0.2 * np.abs(model.stiffness() @ pushed).max()
    back = own.force(-pushed)
    assert np.array_equal(own.force(pushed), first) and not np.array_equal(back, -first)
    assert np.abs(own.force(0.0 * pushed)).max() < 1e-9
    own.commit(pushed)
    assert np.array_equal(own.force(pushed), first)
    assert np.abs(own.force(0.0 * pushed)).max() > 1e5


def test_elements_without_trials_are_refused(of_page: Any) -> None:
    """A force-based element follows increments of its nodes, which a refused step has not."""
    column("forceBeamColumn")
    with pytest.raises(ValueError, match="ForceBeamColumn2d"):
        of_page(opensees.structure(ops, [1], width=WIDTH))


def test_a_second_simulation_of_a_model_is_refused(of_page: Any) -> None:
    column("dispBeamColumn")
    model = opensees.structure(ops, [1], width=WIDTH)
    own = of_page(model)
    ground = bm.SpringGround.under(own, 4, NORMAL, NORMAL)
    bm.Simulation(STEP, own, ground, bm.Bonded()).run(2)
    with pytest.raises(RuntimeError, match="another simulation"):
        bm.Simulation(STEP, own, ground, bm.Bonded())
