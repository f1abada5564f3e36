"""GOAL: models of OpenSees in space: rows, ties, outlines of rigid mats, shells that bend, large models.
SCENE: a building of frames with diaphragms, a core on a mat of shells, a block of bricks.
REFERENCE: OpenSees itself: motions, unit deflections and fixed-base periods of the same models.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import pytest
from test_opensees import HANDLERS, analysis, deflections, deflections_in_opensees

import basemat as bm
from basemat import _opensees_matrices, opensees

try:
    import openseespy.opensees as ops
except (ImportError, RuntimeError):
    # Not there, or without the system's BLAS.
    pytest.skip("no OpenSees", allow_module_level=True)

DIRECTIONS = ("x", "y", "z", "rx", "ry", "rz")
OUTLINE = [(-1.0, -1.5), (5.0, -1.5), (5.0, 4.5), (-1.0, 4.5)]
STEP, STEPS, FORCE = 0.005, 400, 100e3
RECORD = bm.el_centro_1940().resampled(STEP)
NORMAL, ALONG, ACROSS, DASHPOTS = 40e6, 25e6, 15e6, (0.8e6, 0.5e6)


def turned(vector: Sequence[float], up: str = "z") -> list[float]:
    """Components to the right, away and up on the axes of a model with this axis up."""
    x, y, z = vector
    return [x, y, z] if up == "z" else [x, z, -y]


def building(up: str = "z", element: str = "elasticBeamColumn") -> None:
    """Two storeys on a rigid mat: its node 1, columns, and masses of floors 21 and 22 are beside the middle."""
    ops.wipe()
    ops.model("basic", "-ndm", 3, "-ndf", 6)
    ops.node(1, *turned((1.7, 1.1, 0.0), up))
    ops.mass(1, 90e3, 90e3, 90e3, *np.abs(turned((3e5, 2e5, 4e5), up)))
    ops.geomTransf("Linear", 1, *turned((1.0, 0.0, 0.0), up))
    ops.geomTransf("Linear", 2, *turned((0.0, 0.0, 1.0), up))
    for k in range(3):
        for own, (x, y) in enumerate(((0.0, 0.0), (4.0, 0.0), (4.0, 3.0), (0.0, 3.0)), 1):
            tag = 100 * k + 10 + own
            ops.node(tag, *turned((x, y, 3.0 * k), up))
            if k == 0:
                ops.rigidLink("beam", 1, tag)
                continue
            ops.mass(tag, *np.abs(turned((3e3, 3e3, 8e3), up)), 200.0, 200.0, 200.0)
            column = (0.1 + 0.02 * own, 30e9, 12e9, 3e-3, 2e-3, 1e-3 * own, 1)
            ops.element("elasticBeamColumn", tag, tag - 100, tag, *column, "-mass", 400.0)
        for own in range(4 * bool(k)):
            ends = [100 * k + 11 + own, 100 * k + 11 + (own + 1) % 4]
            ops.element("elasticBeamColumn", 1000 + ends[0], *ends, 0.18, 30e9, 12e9, 3e-3, 3e-3, 2e-3, 2)
        if k:
            ops.node(20 + k, *turned((2.3, 1.4, 3.0 * k), up))
            ops.mass(20 + k, *np.abs(turned((20e3, 20e3, 0.0), up)), 0.0, 0.0, 0.0)
            held = np.abs(turned((0, 0, 1), up)).astype(int)
            ops.fix(20 + k, *held.tolist(), *(1 - held).tolist())
            ops.rigidDiaphragm(1 + int(np.argmax(held)), 20 + k, *(100 * k + 11 + own for own in range(4)))
    ops.rayleigh(0.0, 0.0, 0.002, 0.0)


def on_springs(below: float, up: str) -> None:
    """The building on springs and dashpots in the middle of 3 × 3 cells in OpenSees."""
    for k, (i, j) in enumerate((i, j) for i in range(3) for j in range(3)):
        place = turned((OUTLINE[0][0] + 2.0 * i + 1.0, OUTLINE[0][1] + 2.0 * j + 1.0, -below), up)
        tag = 300 + k
        for own in (tag, tag + 100):
            ops.node(own, *place)
        ops.rigidLink("beam", 1, tag)
        ops.fix(tag + 100, 1, 1, 1, 1, 1, 1)
        materials = [10 * k + int(own) for own in np.abs(turned((1, 2, 3), up))]
        for own, stiffness, dashpot in zip((1, 2, 3), (ALONG, ACROSS, NORMAL), (DASHPOTS[1], DASHPOTS[1], DASHPOTS[0])):
            ops.uniaxialMaterial("Elastic", 10 * k + own, 4.0 * stiffness, 4.0 * dashpot)
        ops.element("zeroLength", tag, tag, tag + 100, "-mat", *materials, "-dir", 1, 2, 3, "-doRayleigh", 0)


@pytest.mark.parametrize(("up", "below"), [("z", 0.0), ("z", 0.6), ("y", 0.6)])
def test_a_building_moves_as_in_opensees(up: str, below: float) -> None:
    building(up)
    model = opensees.structure(ops, [1], outline=OUTLINE, below=below, up=up)  # type: ignore[arg-type]
    assert model.dof("22 rz" if up == "z" else "22 ry") == model.row(22, "rz" if up == "z" else "ry")
    ground = bm.SpringGround.under(model, 3, NORMAL, ALONG, across_stiffness=ACROSS, dashpots=DASHPOTS)
    force = turned((0.8 * FORCE, FORCE, 0.3 * FORCE), up)
    probes = [bm.Probe.displacement(name, model.row(212, name)) for name in DIRECTIONS]
    loads = [bm.Load.record(model.row(212, name), RECORD, own) for name, own in zip(DIRECTIONS, force)]
    simulation = bm.Simulation(STEP, model, ground, bm.Bonded(), probes=probes, loads=loads)
    run = simulation.run(STEPS, warn=False)
    building(up)
    on_springs(below, up)
    ops.timeSeries("Path", 1, "-dt", STEP, "-values", *RECORD.accelerations)
    ops.pattern("Plain", 1, 1)
    ops.load(212, *force, 0.0, 0.0, 0.0)
    analysis(HANDLERS["Transformation"], "Newmark")
    found = [[0.0] * 6]
    for _ in range(STEPS):
        assert ops.analyze(1, STEP) == 0
        found.append([ops.nodeDisp(212, k) for k in range(1, 7)])
    for name, expected in zip(DIRECTIONS, np.array(found).T):
        assert np.abs(expected).max() > 1e-5, name
        np.testing.assert_allclose(run[name], expected, rtol=0.0, atol=1e-6 * np.abs(expected).max())


def test_fixed_base_periods_are_those_of_opensees() -> None:
    building()
    model = opensees.structure(ops, [1], outline=OUTLINE)
    soil = bm.Soil.from_shear_wave_speed(250.0, 0.33, 1900.0)
    ground = bm.ElasticGround.under(soil, model, 3)
    simulation = bm.Simulation(STEP, model, ground, bm.Bonded(), motion=bm.triaxial(x=RECORD, y=RECORD))
    found = [mode.fixed_period for mode in simulation.interaction(1.0).modes]
    building()
    ops.fix(1, 1, 1, 1, 1, 1, 1)
    ops.constraints("Transformation")
    ops.numberer("Plain")
    expected = 2.0 * np.pi / np.sqrt(ops.eigen("-fullGenLapack", 6))
    assert found[0] != pytest.approx(found[1], rel=0.01)
    for period in found:
        assert np.abs(expected / period - 1.0).min() < 1e-9


# Ties and the handlers of OpenSees 3.7.1 that hold them, as in the plane.
TIES: dict[str, tuple[tuple[str, ...], list[tuple[object, ...]]]] = {
    "none": (("Plain", "Transformation"), []),
    "one direction": (("Plain", "Transformation"), [("equalDOF", 11, 12, 2)]),
    "all directions": (("Plain", "Transformation"), [("equalDOF", 13, 30, 1, 2, 3, 4, 5, 6)]),
    "beam": (("Transformation", "Lagrange"), [("rigidLink", "beam", 11, 30)]),
    "bar": (("Plain", "Transformation"), [("rigidLink", "bar", 11, 30)]),
    "floor": (("Transformation",), [("rigidDiaphragm", 3, 40, 11, 12, 13)]),
    "wall": (("Transformation",), [("rigidDiaphragm", 1, 40, 30)]),
    "base": (("Transformation", "Lagrange"), [("rigidLink", "beam", 1, 2), ("rigidLink", "beam", 1, 3)]),
    "fixed rotation": (("Plain", "Transformation"), [("fix", 30, 0, 0, 0, 1, 1, 0)]),
}


def tied_frame(commands: list[tuple[object, ...]]) -> None:
    """Three columns on base nodes 1 to 3 with beams and a bracket to 30 and 40; tags in no order."""
    ops.wipe()
    ops.model("basic", "-ndm", 3, "-ndf", 6)
    places = {3: (0.0, 5.0, 0.0), 1: (0.0, 0.0, 0.0), 2: (4.0, 0.5, 0.0)}
    places.update({12: (4.0, 0.5, 3.0), 11: (0.0, 0.0, 3.0), 13: (0.0, 5.0, 3.0), 40: (1.5, 2.0, 3.0), 30: (1.5, 2.5, 4.0)})
    for tag, place in places.items():
        ops.node(tag, *place)
        ops.mass(tag, 8e3, 8e3, 8e3, 2e3, 2e3, 2e3)
    ops.geomTransf("Linear", 1, 0.3, 1.0, 0.2)
    beams = ((1, 2), (2, 3), (1, 11), (2, 12), (3, 13), (11, 12), (12, 13), (30, 13), (30, 40), (40, 12), (40, 11))
    for tag, ends in enumerate(beams, 1):
        ops.element("elasticBeamColumn", tag, *ends, 0.1 + 0.02 * tag, 30e9, 12e9, 3e-3, 2e-3, 1e-3 + 1e-4 * tag, 1)
    for command, *values in commands:
        getattr(ops, str(command))(*values)


@pytest.mark.filterwarnings("ignore:the structure does not rotate")
@pytest.mark.parametrize(("ties", "handler"), [(name, own) for name in TIES for own in TIES[name][0]])
def test_ties_and_fixes_are_those_of_opensees(ties: str, handler: str) -> None:
    tied_frame(TIES[ties][1])
    tags = [int(tag) for tag in ops.getNodeTags()]
    model = opensees.structure(ops, faces=[(1, 2, 3)])
    springs = {own: [4e7, 5e7, 9e7, 2e7, 3e7, 1e7] for own in (1, 2, 3)}
    found = deflections(model, tags, springs, DIRECTIONS)
    expected = deflections_in_opensees(tags, springs, handler)
    assert np.abs(found - expected).max() < 1e-9 * np.abs(expected).max()


def core_on_a_mat(shell: str = "ShellMITC4") -> list[int]:
    """A mat of 4 × 4 shells of 0.6 m under a stiff stick with 300 t on it; tags of the shells."""
    ops.wipe()
    ops.model("basic", "-ndm", 3, "-ndf", 6)
    for k in range(25):
        ops.node(k + 1, 2.25 * (k % 5), 2.25 * (k // 5), 0.0)
    ops.section("ElasticMembranePlateSection", 1, 30e9, 0.2, 0.6, 2500.0)
    for k in range(16):
        first = 5 * (k // 4) + k % 4 + 1
        ops.element(shell, k + 1, first, first + 1, first + 6, first + 5, 1)
    ops.geomTransf("Linear", 1, 1.0, 0.0, 0.0)
    ops.node(100, 4.5, 4.5, 8.0)
    ops.mass(100, 300e3, 300e3, 300e3, 1e5, 1e5, 1e5)
    for tag, foot in enumerate((7, 9, 17, 19), 101):
        ops.node(tag, *ops.nodeCoord(foot)[:2], 8.0)
        ops.rigidLink("beam", 100, tag)
        ops.element("elasticBeamColumn", tag, foot, tag, 0.4, 30e9, 12e9, 2e-2, 1.5e-2, 1.5e-2, 1)
    return list(range(1, 17))


@pytest.mark.parametrize("shell", ["ShellMITC4", "ShellDKGQ"])
def test_a_mat_of_shells_uplifts(shell: str) -> None:
    shells = core_on_a_mat(shell)
    model = opensees.structure(ops, faces=shells)
    base = list(model.base())
    assert len(base) == 16 and [(node.x, node.y) for node in base[0]] == [(0.0, 0.0), (2.25, 0.0), (2.25, 2.25), (0.0, 2.25)]
    # The underside is 0.3 m below the nodes.
    about_y = sum(model.row(tag, "ry").weights(model.dofs) * 0.01 for tag in range(1, 26))
    node = base[0][0]
    moved = [row.value(about_y) for row in (node.horizontal, node.across, node.vertical)]
    assert moved == pytest.approx([-0.3 * 0.01, 0.0, 0.0])
    up = sum(model.row(tag, "z").weights(model.dofs) for tag in [*range(1, 26), 100])
    assert up @ model.mass() @ up == pytest.approx(300e3 + 2500.0 * 0.6 * 81.0, rel=1e-12)
    assert np.abs(model.stiffness() @ up).max() < 1e-12 * np.abs(model.stiffness()).max()
    soil = bm.Soil.from_shear_wave_speed(220.0, 0.33, 1900.0)
    ground = bm.ElasticGround.under(soil, model, 6)
    motion = bm.triaxial(x=RECORD, y=RECORD.scaled(0.7))
    run = bm.Simulation(0.01, model, ground, bm.Coulomb(0.5), motion=motion).run(300, warn=False)
    assert run.energy_error < 1e-9
    assert run.uplifted_fraction.value > 0.05


def test_large_models_are_assembled_by_windows(monkeypatch: pytest.MonkeyPatch) -> None:
    """To the same matrices but for rounding, and the model is left as it was."""
    pytest.importorskip("scipy")
    found: list[opensees.OpenSeesModel] = []
    for most in (_opensees_matrices.DENSE, 60):
        monkeypatch.setattr(_opensees_matrices, "DENSE", most)
        monkeypatch.setattr(_opensees_matrices, "WINDOW", 60)
        building()
        ops.equalDOF(212, 214, 4)
        ops.timeSeries("Constant", 1)
        ops.pattern("Plain", 1, 1)
        ops.sp(213, 5, 0.01)
        with pytest.warns(bm.BasematWarning, match=r"not rotate freely.*node 213 \(ry\) does not follow, by fix of node 213"):
            found.append(opensees.structure(ops, [1], outline=OUTLINE))
    dense, sparse = found
    assert {tag: ops.getFixedDOFs(tag) for tag in ops.getFixedNodes()} == {21: [3, 4, 5], 22: [3, 4, 5], 213: [5]}
    assert sparse.dof_names == dense.dof_names and repr(list(sparse.base())) == repr(list(dense.base()))
    for name in ("mass", "stiffness", "damping"):
        expected, made = getattr(dense, name)(), getattr(sparse, name)()
        np.testing.assert_allclose(made.toarray(), expected, rtol=0.0, atol=1e-15 * np.abs(expected).max())
    runs = []
    for model in found:
        ground = bm.SpringGround.under(model, 3, NORMAL, ALONG)
        simulation = bm.Simulation(STEP, model, ground, bm.Coulomb(0.5), motion=bm.triaxial(x=RECORD))
        runs.append(simulation.run(200, warn=False)["base_shear"])
    np.testing.assert_allclose(runs[1], runs[0], rtol=0.0, atol=1e-9 * np.abs(runs[0]).max())


def test_a_block_of_bricks_stands_on_its_sides() -> None:
    """Nodes of three degrees of freedom, and a mast of six on them."""
    ops.wipe()
    ops.model("basic", "-ndm", 3, "-ndf", 3)
    for k in range(27):
        ops.node(k + 1, 2.0 * (k % 3), 2.0 * (k // 3 % 3), 2.0 * (k // 9))
    ops.nDMaterial("ElasticIsotropic", 1, 30e9, 0.2, 2400.0)
    for k in range(8):
        first = 9 * (k // 4) + 3 * (k // 2 % 2) + k % 2 + 1
        lower = [first, first + 1, first + 4, first + 3]
        ops.element("stdBrick", k + 1, *lower, *(own + 9 for own in lower), 1)
    faces = [(1, 2, 5, 4), (2, 3, 6, 5), (4, 5, 8, 7), (5, 6, 9, 8)]
    model = opensees.structure(ops, faces=faces)
    assert model.dofs == 81 and model.dof_names is not None and model.dof_names[:3] == ["1 x", "1 y", "1 z"]
    # Each side of the cube has four.
    assert len(bm.DeformedShape(model).cells) == 24
    along = sum(model.row(tag, "y").weights(81) for tag in model.nodes)
    assert along @ model.mass() @ along == pytest.approx(2400.0 * 64.0, rel=1e-12)
    with pytest.raises(bm.InputError, match="there is no direction 'rx', only x, y, z"):
        opensees.structure(ops, faces=faces, below=0.1)


@pytest.mark.parametrize("up", ["z", "y"])
def test_shapes_are_nodes_and_elements(up: str) -> None:
    building(up)
    model = opensees.structure(ops, [1], outline=OUTLINE, up=up)
    shape = bm.DeformedShape(model)
    assert shape.in_space and len(shape.points) == len(ops.getNodeTags()) and len(shape.cells) == 16
    node = dict(zip(model.nodes, range(len(model.nodes))))
    assert shape.points[node[213]] == pytest.approx([4.0, 3.0, 6.0])
    assert shape.points[node[1]] == pytest.approx([1.7, 1.1, 0.0])
    u = np.random.default_rng(5).normal(size=model.dofs)
    # A column's foot follows the mat's node; axes of the shape are to the right, away and up.
    moved, own = shape.displacements(u), [model.row(11, name) for name in DIRECTIONS[:3]]
    right, away, up_ = turned([row.value(u) for row in own], "z") if up == "z" else (own[0].value(u), -own[2].value(u), own[1].value(u))
    assert moved[node[11]] == pytest.approx([right, away, up_], rel=1e-12)
    ends = sorted(model.nodes[k] for k in next(cell for cell in shape.cells if node[213] in cell and node[113] in cell))
    assert ends == [113, 213]
