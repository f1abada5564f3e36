"""GOAL: beams of fibres of OpenSees in space yield in a run of basemat as in OpenSees.
SCENE: a column of concrete and steel with an inclined orientation on a fixed base, loaded along x and y at once.
REFERENCE: the same column in OpenSees alone.
"""

from __future__ import annotations

import numpy as np
import pytest

import basemat as bm
from basemat import opensees

try:
    import openseespy.opensees as ops
except (ImportError, RuntimeError):
    # Not there, or without the system's BLAS.
    pytest.skip("no OpenSees", allow_module_level=True)

STEP, STEPS = 0.005, 600
RECORD = bm.el_centro_1940().resampled(STEP)
FORCES = {1: 70e3, 2: 55e3}
"""Largest forces on the top along x and y per m/s² of the record, N."""
MASSES = {1: 30e3, 2: 3e3, 3: 3e3, 4: 40e3}
OUTLINE = [(-2.0, -2.0), (2.0, -2.0), (2.0, 2.0), (-2.0, 2.0)]


def column(element: str) -> None:
    """A column on the middle of its mat, node 1, with its mass on node 4; more bars on one side move its axis."""
    ops.wipe()
    ops.model("basic", "-ndm", 3, "-ndf", 6)
    ops.uniaxialMaterial("Concrete01", 1, -35e6, -0.0025, -10e6, -0.01)
    ops.uniaxialMaterial("Steel02", 2, 450e6, 200e9, 0.01, 18.0, 0.925, 0.15)
    ops.section("Fiber", 1, "-GJ", 1.23456789e8)
    ops.patch("rect", 1, 8, 6, -0.3, -0.25, 0.3, 0.25)
    ops.layer("straight", 2, 4, 0.8e-3, -0.25, -0.2, -0.25, 0.2)
    ops.layer("straight", 2, 3, 0.8e-3, 0.25, -0.2, 0.25, 0.2)
    ops.geomTransf("Linear", 1, 0.9, 0.3, 0.1)
    ops.beamIntegration("Lobatto", 1, 1, 4)
    iterations = ("-iter", 60, 1e-18) if element == "forceBeamColumn" else ()
    for tag, mass in MASSES.items():
        ops.node(tag, 0.0, 0.0, 2.0 * (tag - 1))
        ops.mass(tag, *[mass] * 3, *[0.2 * mass] * 3)
        if tag > 1:
            ops.element(element, tag, tag - 1, tag, 1, 1, *iterations)


def found(model: opensees.OpenSeesModel) -> tuple[np.ndarray, bm.Simulation]:
    """Displacements of the top along x, along y and about z on a fixed base."""
    loads = [bm.Load.record(model.row(4, name), RECORD, force) for name, force in zip("xy", FORCES.values())]
    simulation = bm.Simulation(
        STEP,
        model,
        bm.SpringGround.under(model, 2, 1e9, 1e9),
        bm.Bonded(),
        loads=loads,
        probes=[bm.Probe.displacement(name, model.row(4, name)) for name in ("x", "y", "rz")],
        solver=bm.SolverOptions(scheme=bm.TimeScheme.newmark()),
        fixed_base=True,
    )
    run = simulation.run(STEPS, warn=False)
    return np.array([run[name] for name in ("x", "y", "rz")]), simulation


def analysis(integrator: tuple[object, ...], kind: str) -> None:
    ops.wipeAnalysis()
    ops.constraints("Transformation")
    ops.numberer("Plain")
    ops.system("FullGeneral")
    ops.test("NormDispIncr", 1e-14, 100, 0)
    ops.algorithm("Newton")
    ops.integrator(*integrator)
    ops.analysis(kind)


def expected() -> tuple[np.ndarray, np.ndarray]:
    """The same by OpenSees alone; also axial forces, moments about z and y of the lowest sections at the end."""
    ops.fix(1, 1, 1, 1, 1, 1, 1)
    ops.timeSeries("Linear", 1)
    ops.pattern("Plain", 1, 1)
    for tag, mass in MASSES.items():
        ops.load(tag, 0.0, 0.0, -bm.STANDARD_GRAVITY * mass, 0.0, 0.0, 0.0)
    analysis(("LoadControl", 1.0), "Static")
    assert ops.analyze(1) == 0
    ops.loadConst("-time", 0.0)
    ops.timeSeries("Path", 2, "-dt", STEP, "-values", *RECORD.accelerations)
    ops.pattern("Plain", 2, 2)
    ops.load(4, *FORCES.values(), 0.0, 0.0, 0.0, 0.0)
    analysis(("Newmark", 0.5, 0.25), "Transient")
    rows = []
    for step in range(STEPS + 1):
        assert step == 0 or ops.analyze(1, STEP) == 0
        rows.append([ops.nodeDisp(4, direction) for direction in (1, 2, 6)])
    sections = [ops.eleResponse(2, "section", k, "force")[:3] for k in range(1, 5)]
    return (np.array(rows) - rows[0]).T, np.array(sections)


@pytest.mark.parametrize(("element", "tolerance"), [("dispBeamColumn", 1e-8), ("forceBeamColumn", 1e-6)])
def test_fibres_in_space_yield_as_in_opensees(element: str, tolerance: float) -> None:
    column(element)
    model = opensees.structure(ops, [1], outline=OUTLINE)
    assert model.fiber_beams == {2: 0, 3: 1, 4: 2}
    own, simulation = found(model)
    reference, sections = expected()
    for one, other in zip(own[:2], reference[:2]):
        np.testing.assert_allclose(one, other, rtol=0.0, atol=tolerance * np.abs(other).max())
    state = simulation.beam_sections(0)
    resultants = np.array([state.axial_force, state.moment, state.moment_about_y]).T
    np.testing.assert_allclose(resultants, sections, rtol=0.0, atol=10.0 * tolerance * np.abs(sections).max())
    # Both moments act together, and fibres have yielded.
    assert np.abs(sections[:, 1:]).min(axis=1).max() > 1e4 and np.abs(state.fiber_strain).max() > 2.3e-3


def test_beams_in_space_that_stay_linear() -> None:
    column("dispBeamColumn")
    for tag in (2, 3, 4):
        ops.remove("element", tag)
    ops.geomTransf("PDelta", 2, 1.0, 0.0, 0.0)
    ops.geomTransf("Linear", 3, 1.0, 0.0, 0.0, "-jntOffset", 0.0, 0.0, 0.1, 0.0, 0.0, -0.1)
    for tag, transformation in ((2, 2), (3, 3), (4, 2)):
        ops.element("dispBeamColumn", tag, tag - 1, tag, transformation, 1)
    with pytest.warns(bm.BasematWarning, match="not linear") as caught:
        model = opensees.structure(ops, [1], outline=OUTLINE)
    assert model.fiber_beams == {}
    message = str(caught[0].message)
    assert "element 2 for its transformation 2 PDeltaCrdTransf3d, not Linear" in message
    assert "element 3 for its transformation 3 with joint offsets" in message
