"""A frame from OpenSees on basemat's springs against the same frame on springs in OpenSees."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import pytest

import basemat as bm
from basemat import opensees

try:
    import openseespy.opensees as ops
except (ImportError, RuntimeError):
    # Not there, or without the system's BLAS.
    pytest.skip("no OpenSees", allow_module_level=True)

WIDTH, ELEMENTS, STEP, STEPS = 6.0, 4, 0.005, 1200
NORMAL, TANGENTIAL, DASHPOTS = 40e6, 25e6, (0.8e6, 0.5e6)
# A force rather than a motion, which OpenSees integrates by its time scheme and basemat exactly.
FORCE, RECORD = 100e3, bm.el_centro_1940().resampled(STEP)


def frame(element: str = "elasticBeamColumn") -> None:
    """An unsymmetric frame on a rigid base, whose middle is node 1."""
    ops.wipe()
    ops.model("basic", "-ndm", 2, "-ndf", 3)
    ops.node(1, 0.0, 0.0)
    ops.mass(1, 40e3, 40e3, 150e3)
    for tag, x, y in ((2, 0.0, 4.0), (3, 0.0, 8.0), (4, 2.5, 8.0), (5, 2.5, 4.0)):
        ops.node(tag, x, y)
        ops.mass(tag, 12e3, 12e3, 100.0 * tag)
    ops.geomTransf("Linear", 1)
    ops.section("Elastic", 1, 30e9, 0.25, 0.005)
    ops.beamIntegration("Legendre", 1, 1, 2)
    section = (0.25, 30e9, 0.005, 1) if element == "elasticBeamColumn" else (1, 1)
    for tag, ends in enumerate(((1, 2), (2, 3), (3, 4), (4, 5), (5, 2)), 1):
        ops.element(element, tag, *ends, *section, "-mass", 500.0)
    # Of the stiffness: the base has no dashpot to the ground's outside.
    ops.region(1, "-eleRange", 1, 5, "-rayleigh", 0.0, 0.0, 0.002, 0.0)


def on_springs() -> None:
    """The frame on springs and dashpots in OpenSees."""
    length = WIDTH / ELEMENTS
    for k in range(ELEMENTS):
        x, tag = (k + 0.5) * length - 0.5 * WIDTH, 100 + k
        ops.node(tag, x, 0.0)
        ops.rigidLink("beam", 1, tag)
        ops.node(tag + 100, x, 0.0)
        ops.fix(tag + 100, 1, 1, 1)
        materials = (10 * k + 1, 10 * k + 2)
        for own, stiffness, dashpot in zip(materials, (TANGENTIAL, NORMAL), DASHPOTS[::-1]):
            ops.uniaxialMaterial("Elastic", own, stiffness * length, dashpot * length)
        ops.element("zeroLength", tag, tag, tag + 100, "-mat", *materials, "-dir", 1, 2, "-doRayleigh", 0)


def marched() -> np.ndarray:
    """Displacement of node 4 to the right under the pattern that is set up, by OpenSees alone."""
    analysis(HANDLERS["Transformation"], "Newmark")
    found = [0.0]
    for _ in range(STEPS):
        assert ops.analyze(1, STEP) == 0
        found.append(ops.nodeDisp(4, 1))
    return np.array(found)


def simulation(model: opensees.OpenSeesModel, **excitation: object) -> bm.Simulation:
    """The frame on basemat's springs."""
    strip = bm.Strip(-0.5 * WIDTH, 0.5 * WIDTH, ELEMENTS, grading="uniform")
    ground = bm.SpringGround(strip, NORMAL, TANGENTIAL, dashpots=DASHPOTS)
    probe = bm.Probe.displacement("top", model.row(4))
    return bm.Simulation(STEP, model, ground, bm.Bonded(), probes=[probe], **excitation)


def test_a_frame_moves_as_in_opensees() -> None:
    frame()
    model = opensees.structure(ops, [1], width=WIDTH)
    assert model.dofs == 15 and model.nodes == [1, 2, 3, 4, 5]
    assert len(set(model.dof_names)) == 15 and model.dof("4 rotation") == model.row(4, "rotation")
    rigid = sum(model.row(node, "x").weights(15) for node in model.nodes)
    assert np.abs(model.stiffness() @ rigid).max() < 1e-13 * np.abs(model.stiffness()).max()
    total = 40e3 + 4 * 12e3 + 500.0 * (4.0 + 4.0 + 2.5 + 4.0 + 2.5)
    assert rigid @ model.mass() @ rigid == pytest.approx(total, rel=1e-12)
    damping = 0.002 * model.stiffness()
    assert np.abs(model.damping() - damping).max() < 1e-12 * damping.max()
    load = bm.Load.record(model.row(4), RECORD, FORCE)
    found = simulation(model, loads=[load]).run(STEPS)["top"]
    frame()
    on_springs()
    ops.timeSeries("Path", 1, "-dt", STEP, "-values", *RECORD.accelerations)
    ops.pattern("Plain", 1, 1, "-fact", FORCE)
    ops.load(4, 1.0, 0.0, 0.0)
    expected = marched()
    assert np.abs(expected).max() > 5e-3
    np.testing.assert_allclose(found, expected, rtol=0.0, atol=1e-6 * np.abs(expected).max())


def test_a_frame_is_shaken_as_in_opensees() -> None:
    """With the mass of elements; OpenSees takes the motion's acceleration at the ends of steps."""
    frame("dispBeamColumn")
    model = opensees.structure(ops, [1], width=WIDTH)
    found = simulation(model, motion=RECORD).run(STEPS, warn=False)["top"]
    frame("dispBeamColumn")
    on_springs()
    ops.timeSeries("Path", 1, "-dt", STEP, "-values", *RECORD.accelerations)
    ops.pattern("UniformExcitation", 1, 1, "-accel", 1)
    expected = marched()
    assert np.abs(expected).max() > 0.05
    np.testing.assert_allclose(found, expected, rtol=0.0, atol=3e-4 * np.abs(expected).max())


def test_nodes_of_a_flexible_base_and_what_is_held() -> None:
    ops.wipe()
    ops.model("basic", "-ndm", 2, "-ndf", 3)
    for tag, x in ((7, 2.0), (3, -2.0), (5, 0.0)):
        ops.node(tag, x, 0.0)
    ops.node(9, 0.0, 3.0)
    ops.mass(9, 1e4, 1e4, 0.0)
    ops.geomTransf("Linear", 1)
    for tag, ends in enumerate(((3, 5), (5, 7), (5, 9)), 1):
        ops.element("elasticBeamColumn", tag, *ends, 0.3, 30e9, 0.01, 1, "-mass", 700.0)
    model = opensees.structure(ops, [7, 3, 5])
    [nodes] = model.base()
    assert [node.x for node in nodes] == [-2.0, 0.0, 2.0]
    assert nodes[0].vertical == model.row(3, "y")
    assert not model.damping().any()
    soil = bm.Soil.from_shear_wave_speed(250.0, 0.33, 1900.0)
    ground = bm.ElasticGround.under(soil, model, 6)
    run = bm.Simulation(0.002, model, ground, bm.Coulomb(0.4), motion=bm.el_centro_1940()).run(200)
    assert run.energy_error < 1e-9
    with pytest.raises(bm.InputError, match="no node 8"):
        model.row(8)
    with pytest.raises(bm.InputError, match="no direction 'z', only x, y, rotation"):
        model.row(9, "z")  # type: ignore[arg-type]
    ops.fix(3, 0, 1, 0)
    with pytest.raises(bm.InputError, match="node 3 is held in the direction y: it must be free"):
        opensees.structure(ops, [7, 3, 5])


def test_models_that_are_none_are_refused() -> None:
    for dimensions, needed in (((3, 4), "3 coordinates and 4 degrees"), ((2, 2), "2 coordinates and 2 degrees")):
        ops.wipe()
        ops.model("basic", "-ndm", dimensions[0], "-ndf", dimensions[1])
        ops.node(4, *[0.0] * dimensions[0])
        with pytest.raises(bm.InputError, match=f"node 4 has {needed} of freedom, but must have 2 and 3"):
            opensees.structure(ops, [4], width=1.0)
    frame()
    assert repr(opensees.structure(ops, [1], width=WIDTH)) == "OpenSeesModel(5 nodes, 15 degrees of freedom)"
    for nodes, width, text in (
        ([1], None, "1 base nodes: give several, or a single one with a width"),
        ([1, 5], WIDTH, "heights of 0.0 to 4.0 m, but must be at one"),
        ([2, 5], WIDTH, "2 base nodes: give several"),
        ([8], WIDTH, "no node 8"),
    ):
        with pytest.raises(bm.InputError, match=text):
            opensees.structure(ops, nodes, width=width)
    ops.wipe()
    with pytest.raises(bm.InputError, match="no elements"):
        opensees.structure(ops, [1], width=1.0)


# Ties, fixes and numbers: unit deflections against OpenSees' own static analysis.

BASE, NAMES = (1, 2, 3), ("x", "y", "rotation")
HANDLERS = {
    "Plain": ("Plain",),
    "Transformation": ("Transformation",),
    "Lagrange": ("Lagrange",),
    # Its own error: the stiffness over the penalty, and the penalty's rounding over the stiffness.
    "Penalty": ("Penalty", 1e14, 1e14),
}
EACH, IDENTITY = tuple(HANDLERS), ("Plain", "Transformation", "Penalty")
# Ties, and the handlers of OpenSees 3.7.1 that hold them: Plain holds equal directions only, Transformation no chains;
# Lagrange ends the process where a tie has fewer directions than its node.
TIES: dict[str, tuple[tuple[str, ...], list[tuple[object, ...]]]] = {
    "none": (EACH, []),
    "one direction": (IDENTITY, [("equalDOF", 11, 12, 1)]),
    "from a higher tag": (IDENTITY, [("equalDOF", 22, 11, 1, 3)]),
    "all directions": (EACH, [("equalDOF", 15, 31, 1, 2, 3)]),
    "mixed": (EACH, [("equalDOF_Mixed", 15, 31, 3, 1, 1, 2, 2, 3, 3)]),
    "two that hold each other's rest": (IDENTITY, [("equalDOF", 21, 22, 1), ("equalDOF", 11, 12, 2)]),
    "beam": (("Transformation", "Lagrange", "Penalty"), [("rigidLink", "beam", 11, 30)]),
    "beam, bar": (("Transformation", "Penalty"), [("rigidLink", "beam", 11, 30), ("rigidLink", "bar", 12, 15)]),
    "bar": (IDENTITY, [("rigidLink", "bar", 11, 30)]),
    "diaphragm": (IDENTITY, [("rigidDiaphragm", 1, 11, 12, 15)]),
    "rigid plane": (("Transformation", "Lagrange", "Penalty"), [("rigidDiaphragm", 3, 21, 30, 31)]),
    "fixed rotation": (EACH, [("fix", 30, 0, 0, 1)]),
    "fixed follower": (("Penalty",), [("equalDOF", 12, 30, 1, 3), ("fix", 30, 0, 0, 1)]),
    "fixed master": (("Transformation", "Lagrange", "Penalty"), [("rigidLink", "beam", 12, 30), ("fix", 12, 0, 0, 1)]),
    "base, equal": (IDENTITY, [("equalDOF", 1, 3, 1)]),
    "base, rigid": (("Transformation", "Lagrange", "Penalty"), [("rigidLink", "beam", 2, 1), ("rigidLink", "beam", 2, 3)]),
    "base follows": (IDENTITY, [("equalDOF", 11, 1, 3)]),
    "two masters": (("Penalty",), [("equalDOF", 11, 30, 1), ("equalDOF", 12, 30, 2)]),
    "repeated": (IDENTITY, [("equalDOF", 15, 31, 1, 2), ("equalDOF", 15, 31, 1)]),
    "chain": (("Penalty",), [("equalDOF", 21, 22, 1), ("equalDOF", 22, 15, 1), ("rigidLink", "beam", 15, 31)]),
    "chain of beams": (("Lagrange", "Penalty"), [("rigidLink", "beam", 30, 11), ("rigidLink", "beam", 12, 30)]),
    "chain of equal directions": (("Plain", "Penalty"), [("equalDOF", 12, 11, 1, 3), ("equalDOF", 11, 30, 1, 2, 3)]),
    "circle": (("Penalty",), [("equalDOF", 11, 12, 1), ("equalDOF", 12, 15, 1), ("equalDOF", 15, 11, 1)]),
}
CHAINS = {name for name in TIES if name.startswith("chain")} | {"circle"}


def tied_frame(commands: list[tuple[object, ...]]) -> None:
    """Two storeys on three base nodes with a brace over 30 and 31; tags in no order."""
    ops.wipe()
    ops.model("basic", "-ndm", 2, "-ndf", 3)
    places = {3: (3.0, 0.0), 1: (-3.0, 0.0), 2: (0.5, 0.0), 22: (3.0, 7.0), 12: (3.0, 4.0), 11: (-3.0, 4.0)}
    for tag, place in {**places, 21: (-3.0, 7.0), 15: (1.0, 4.0), 30: (-2.0, 5.0), 31: (-1.5, 5.5)}.items():
        ops.node(tag, *place)
        ops.mass(tag, 8e3, 8e3, 2e3)
    ops.geomTransf("Linear", 1)
    beams = ((1, 2), (2, 3), (1, 11), (3, 12), (11, 15), (15, 12), (11, 21), (12, 22), (21, 22), (30, 31), (31, 22))
    for tag, ends in enumerate((*beams, (30, 21)), 1):
        ops.element("elasticBeamColumn", tag, *ends, 0.1 + 0.02 * tag, 30e9, 2e-3, 1)
    for command, *values in commands:
        getattr(ops, str(command))(*values)


def deflections_in_opensees(tags: list[int], springs: dict[int, list[float]], handler: str) -> np.ndarray:
    """Of all nodes, under 1 MN or MN·m on each, with springs of these stiffnesses under the base nodes."""
    [count] = {len(own) for own in springs.values()}
    directions = range(1, count + 1)
    for own, stiffnesses in springs.items():
        ops.node(100 + own, *ops.nodeCoord(own))
        ops.fix(100 + own, *[1] * count)
        materials = [10 * own + k for k in directions]
        for material, stiffness in zip(materials, stiffnesses):
            ops.uniaxialMaterial("Elastic", material, stiffness)
        ops.element("zeroLength", 100 + own, own, 100 + own, "-mat", *materials, "-dir", *directions)
    ops.timeSeries("Constant", 1)
    found = []
    for tag, k in ((tag, k) for tag in tags for k in range(count)):
        ops.pattern("Plain", 1, 1)
        ops.load(tag, *(1e6 * np.eye(count)[k]).tolist())
        analysis(HANDLERS[handler], "LoadControl")
        assert ops.analyze(1) == 0
        found.append([ops.nodeDisp(own, j) for own in tags for j in directions])
        ops.remove("loadPattern", 1)
        ops.reset()
    return np.array(found)


def analysis(handler: tuple[object, ...], integrator: str) -> None:
    ops.wipeAnalysis()
    ops.constraints(*handler)
    ops.numberer("RCM")
    ops.system("FullGeneral")
    ops.algorithm("Linear")
    ops.integrator(integrator, *((1.0,) if integrator == "LoadControl" else (0.5, 0.25)))
    ops.analysis("Static" if integrator == "LoadControl" else "Transient")


def row(model: opensees.OpenSeesModel, tag: int, name: str) -> np.ndarray:
    """Weights of a displacement; zero where the model says that it is held."""
    try:
        return model.row(tag, name).weights(model.dofs)  # type: ignore[arg-type]
    except bm.InputError as error:
        assert f"node {tag} is held in the direction {name}" in str(error) and "fix of node" in str(error)
        return np.zeros(model.dofs)


def deflections(
    model: opensees.OpenSeesModel, tags: list[int], springs: dict[int, list[float]], names: Sequence[str]
) -> np.ndarray:
    """Of all nodes under the same loads: by the structure that basemat took, on these springs."""
    rows = np.array([row(model, tag, name) for tag in tags for name in names])
    stiffness = model.stiffness()
    for own, stiffnesses in springs.items():
        for name, spring in zip(names, stiffnesses):
            weights = row(model, own, name)
            stiffness = stiffness + spring * np.outer(weights, weights)
    return 1e6 * rows @ np.linalg.solve(stiffness, rows.T)


@pytest.mark.filterwarnings("ignore:the structure does not rotate")
@pytest.mark.parametrize(("ties", "handler"), [(name, own) for name in TIES for own in TIES[name][0]])
def test_ties_fixes_and_numbers_are_those_of_opensees(ties: str, handler: str) -> None:
    tied_frame(TIES[ties][1])
    tags = [int(tag) for tag in ops.getNodeTags()]
    # An analysis of the user's has numbered the model before.
    analysis(HANDLERS[handler], "Newmark")
    assert ops.analyze(1, 0.01) == 0
    if ties in CHAINS:
        with pytest.warns(bm.BasematWarning, match="ties to nodes that follow others.*of node .* to node .*Transformation"):
            model = opensees.structure(ops, BASE)
    else:
        model = opensees.structure(ops, BASE)
    springs = {own: [stiffness * (1 + 0.1 * own) for stiffness in (4e7, 9e7, 2e7)] for own in BASE}
    found = deflections(model, tags, springs, NAMES)
    expected = deflections_in_opensees(tags, springs, handler)
    error = np.abs(found - expected).max() / np.abs(expected).max()
    assert error < (1e-5 if handler == "Penalty" else 1e-9)
    [nodes] = model.base()
    for node, own in zip(nodes, BASE):
        assert node.x == ops.nodeCoord(own)[0]
        assert (node.horizontal, node.vertical) == (model.row(own, "x"), model.row(own, "y"))


@pytest.mark.parametrize(
    ("commands", "text"),
    [
        ([("fix", 12, 1, 0, 0)], r"translate freely in x.*node 12 \(x\) does not follow, by fix of node 12 \(x\)"),
        ([("fix", 2, 0, 1, 0)], r"node 2 is held in the direction y: it must be free.*by fix of node 2 \(y\)"),
        (
            [("equalDOF", 22, 1, 1), ("fix", 22, 1, 0, 0)],
            r"node 1 is held in the direction x.*fix of node 22 \(x\), equalDOF.* of node 1 \(x\) to node 22",
        ),
        ([("equalDOF_Mixed", 11, 30, 1, 2, 1)], r"translate freely in x.*equalDOF_Mixed of node 30 \(x\) to node 11"),
    ],
)
def test_ties_and_fixes_that_hold_the_structure_are_named(commands: list[tuple[object, ...]], text: str) -> None:
    tied_frame(commands)
    with pytest.raises(bm.InputError, match=text):
        opensees.structure(ops, BASE)


def test_ties_that_hold_a_rotation_are_named() -> None:
    tied_frame([("equalDOF", 11, 12, 2)])
    with pytest.warns(bm.BasematWarning, match=r"does not rotate freely.*equalDOF.* of node 12 \(y\) to node 11"):
        opensees.structure(ops, BASE)


def test_a_free_column_prints_nothing(capfd: pytest.CaptureFixture[str]) -> None:
    ops.wipe()
    ops.model("basic", "-ndm", 2, "-ndf", 3)
    for tag in (1, 2):
        ops.node(tag, 0.0, 4.0 * (tag - 1))
        ops.mass(tag, 1e4, 1e4, 0.0)
    ops.geomTransf("Linear", 1)
    ops.element("elasticBeamColumn", 1, 1, 2, 0.25, 30e9, 0.005, 1)
    assert opensees.structure(ops, [1], width=4.0).dofs == 6
    assert capfd.readouterr() == ("", "")
