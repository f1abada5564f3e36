"""GOAL: models of OpenSees in space that are wrong or not linear are told so, by element and node; linear ones are not.
SCENE: a core on a mat of shells, with an element, a mass or a support too much.
REFERENCE: the words of the warning or of the error; rigid motions, which no element may resist.
"""

from __future__ import annotations

import warnings

import numpy as np
import pytest
from test_opensees_space import core_on_a_mat

import basemat as bm
from basemat import opensees

try:
    import openseespy.opensees as ops
except (ImportError, RuntimeError):
    # Not there, or without the system's BLAS.
    pytest.skip("no OpenSees", allow_module_level=True)


STEEL = ("Steel01", 2.5e8, 2e11, 0.01)


@pytest.mark.parametrize(
    ("element", "transformation", "text"),
    [
        (("elasticBeamColumn", 0.25, 30e9, 12e9, 1e-2, 5e-3, 5e-3, 2), "PDelta", r"ElasticBeam3d, PDeltaCrdTransf3d"),
        (("forceBeamColumn", 2, 3), "Corotational", r"ForceBeamColumn3d, CorotCrdTransf3d"),
        (("ShellNLDKGQ", 1), "Linear", "ShellNLDKGQ"),
        (("ShellMITC4", 6), "Linear", r"ShellMITC4, section 6 PlateFiber, ndMaterial 3"),
    ],
)
def test_what_is_not_linear_is_named(element: tuple[object, ...], transformation: str, text: str) -> None:
    shells = core_on_a_mat()
    parts(transformation)
    ends = (8, 100) if "Beam" in str(element[0]) else (1, 3, 13, 11)
    ops.element(element[0], 999, *ends, *element[1:])
    with pytest.warns(bm.BasematWarning, match=rf"element 999 \({text}\)\. Their initial tangent"):
        opensees.structure(ops, faces=shells)


@pytest.mark.filterwarnings("error")
def test_what_is_linear_is_not_named() -> None:
    shells = core_on_a_mat()
    parts("Linear")
    beams = (("elasticBeamColumn", 0.2, 30e9, 12e9, 1e-2, 5e-3, 5e-3, 2), ("forceBeamColumn", 2, 3), ("dispBeamColumn", 2, 5))
    for tag, (name, *properties) in enumerate(beams, 999):
        ops.element(name, tag, 8, 100, *properties)
    for tag, (name, count, section) in enumerate((("ShellDKGT", 3, 1), ("ShellMITC4", 4, 5), ("ShellDKGQ", 4, 7)), 1100):
        ops.element(name, tag, *(1, 3, 13, 11)[:count], section)
    opensees.structure(ops, faces=shells)
    # A face with the corners of a shell is that shell, whose layers are 0.9 m thick in all.
    [face] = opensees.structure(ops, faces=[(11, 1, 3, 13)]).base()
    assert dict(face[1].horizontal.terms)[4] == pytest.approx(-0.45)


def parts(transformation: str) -> None:
    """Transformation 2, and sections of beams and shells, linear and not."""
    ops.geomTransf(transformation, 2, 1.0, 0.0, 0.0)
    ops.uniaxialMaterial("Elastic", 1, 30e9)
    ops.uniaxialMaterial(STEEL[0], 2, *STEEL[1:])
    ops.nDMaterial("ElasticIsotropic", 1, 30e9, 0.2, 2400.0)
    ops.nDMaterial("PlateFiber", 2, 1)
    ops.nDMaterial("J2Plasticity", 3, 1e10, 1e10, 1e8, 1e8, 0.0, 0.0)
    ops.nDMaterial("PlateFiber", 4, 3)
    ops.section("Elastic", 3, 30e9, 0.25, 5e-3, 5e-3, 12e9, 1e-2)
    for tag, material in ((4, 2), (8, 1)):
        ops.section("Fiber", tag, "-GJ", 1e9)
        ops.patch("rect", material, 3, 3, -0.2, -0.2, 0.2, 0.2)
    ops.section("PlateFiber", 5, 2, 0.9)
    ops.section("PlateFiber", 6, 4, 0.9)
    ops.section("LayeredShell", 7, 3, 2, 0.3, 2, 0.3, 2, 0.3)
    for tag, section in ((3, 3), (4, 4), (5, 8)):
        ops.beamIntegration("Lobatto", tag, section, 3)


def test_bases_that_are_none_are_refused() -> None:
    shells, square = core_on_a_mat(), [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)]
    ops.element("ShellMITC4", 500, 1, 5, 101, 104, 1)
    for text, base, options in (
        ("is base_nodes, a single one with the outline", None, {}),
        ("is base_nodes, a single one with the outline", [1], {}),
        ("given twice", [1], {"faces": shells}),
        ("2 base nodes with 1 outlines", [1, 5], {"outline": square}),
        ("outline is .*, but must be a list of corners, each of x and y", [1], {"outline": [1.0, 2.0]}),
        ("outline is .*, but must be a list of corners, each of x and y", [1], {"outline": [(1.0, 2.0), (3.0,)]}),
        ("there are no faces", None, {"faces": []}),
        ("width is for a model in the plane", [1], {"width": 3.0}),
        ("there is no node 77", [77], {"outline": square}),
        ("there is no node 77", None, {"faces": [(1, 2, 77)]}),
        ("element 101 of the faces is no shell", None, {"faces": [101]}),
        (r"face \(1, 2\) has 2 nodes, but must have three or four", None, {"faces": [(1, 2)]}),
        ("heights of 0.0 to 8.0 m, but must be at one", None, {"faces": [500]}),
        ("heights of .* along the axis y", None, {"faces": shells, "up": "y"}),
        ("up is 'x', but must be 'z' or 'y'", None, {"faces": shells, "up": "x"}),
        ("below is -1.0 m, but must be zero or more", None, {"faces": shells, "below": -1.0}),
    ):
        with pytest.raises(bm.InputError, match=text):
            opensees.structure(ops, base, **options)  # type: ignore[arg-type]
    pads = [[(x + 4.5, y + 4.5) for x, y in square], [(x, y + 9.0) for x, y in square]]
    assert [[(node.x, node.y) for node in own] for own in opensees.structure(ops, [13, 21], outline=pads).base()] == pads
    ops.fix(25, 0, 0, 1, 0, 0, 0)
    with pytest.raises(bm.InputError, match="node 25 is held in the direction z: it must be free"):
        opensees.structure(ops, faces=shells)
    ops.remove("sp", 25, 3)
    ops.fix(24, 0, 0, 0, 0, 0, 1)
    with pytest.warns(bm.BasematWarning, match=r"does not rotate freely.*fix of node 24 \(rz\)"):
        opensees.structure(ops, faces=shells)
    ops.wipe()
    ops.model("basic", "-ndm", 2, "-ndf", 3)
    ops.node(1, 0.0, 0.0)
    ops.node(2, 0.0, 3.0)
    ops.geomTransf("Linear", 1)
    ops.element("elasticBeamColumn", 1, 1, 2, 0.25, 30e9, 0.005, 1)
    with pytest.raises(bm.InputError, match="are for a model in space"):
        opensees.structure(ops, [1], outline=square)


def test_triangles_at_rest_do_not_resist_rigid_rotations() -> None:
    """OpenSees 3.7.1 gives an initial stiffness of ShellDKGT that does; its tangent at rest is right."""
    core_on_a_mat()
    for tag in range(1, 17):
        nodes = [int(own) for own in ops.eleNodes(tag)]
        ops.remove("element", tag)
        for k, own in enumerate((nodes[:3], [nodes[0], *nodes[2:]])):
            ops.element("ShellDKGT", 100 * k + tag + 200, *own, 1)
    ops.node(200, 5.0, -1.0, 0.3)
    ops.element("ShellDKGT", 400, 2, 200, 3, 1)
    model = opensees.structure(ops, faces=[own for own in ops.getEleTags() if 200 < own < 400])
    stiffness, n = model.stiffness(), model.dofs
    for about, (one, other), (k, j) in (("rx", "yz", (2, 1)), ("ry", "zx", (0, 2)), ("rz", "xy", (1, 0))):
        turned = np.zeros(n)
        for tag in (tag for tag in model.nodes if tag < 101 or tag == 200):
            at = ops.nodeCoord(tag)
            turned += model.row(tag, about).weights(n)  # type: ignore[arg-type]
            turned -= at[k] * model.row(tag, one).weights(n)  # type: ignore[arg-type]
            turned += at[j] * model.row(tag, other).weights(n)  # type: ignore[arg-type]
        assert np.abs(stiffness @ turned).max() < 1e-12 * np.abs(stiffness).max()
    ops.setNodeDisp(100, 1, 0.01, "-commit")
    with pytest.raises(bm.InputError, match=r"analyses have changed the stiffness.*tangent='present'"):
        opensees.structure(ops, faces=[(1, 2, 7)])
    assert np.array_equal(opensees.structure(ops, faces=[(1, 2, 7)], tangent="present").stiffness(), stiffness)


def test_masses_that_differ_by_direction_are_told() -> None:
    """Floors with a mass along x and y only have no weight."""
    shells = core_on_a_mat()
    ops.mass(100, 300e3, 300e3, 0.0, 1e5, 1e5, 1e5)
    with pytest.warns(bm.BasematWarning, match=r"masses of 4.215e\+05 kg along x, 4.215e\+05 kg along y, 1.215e\+05 kg along z"):
        opensees.structure(ops, faces=shells)
    ops.wipe()
    ops.model("basic", "-ndm", 2, "-ndf", 3)
    for tag in (1, 2):
        ops.node(tag, 0.0, 4.0 * (tag - 1))
        ops.mass(tag, 1e4, 1e4 * (2 - tag), 0.0)
    ops.geomTransf("Linear", 1)
    ops.element("elasticBeamColumn", 1, 1, 2, 0.25, 30e9, 0.005, 1)
    with pytest.warns(bm.BasematWarning, match=r"2e\+04 kg/m along x, 1e\+04 kg/m along y: the ground carries"):
        opensees.structure(ops, [1], width=4.0)


def a_floor(offset: float) -> None:
    """Four columns from a mat at node 100 to a floor at node 20; node 13 is off the floor's plane."""
    ops.wipe()
    ops.model("basic", "-ndm", 3, "-ndf", 6)
    for k, (x, y) in enumerate(((0.0, 0.0), (6.0, 0.0), (6.0, 4.0), (0.0, 4.0))):
        ops.node(k + 1, x, y, 0.0)
        ops.node(k + 11, x, y, 3.5 + (offset if k == 2 else 0.0))
        ops.mass(k + 11, 0.0, 0.0, 1e4, 0.0, 0.0, 0.0)
    ops.node(20, 3.4, 2.2, 3.5)
    ops.node(100, 3.0, 2.0, 0.0)
    ops.mass(20, 4e4, 4e4, 0.0, 0.0, 0.0, 4e5)
    ops.mass(100, 3e4, 3e4, 3e4, 4e4, 9e4, 1.2e5)
    ops.geomTransf("Linear", 1, 1.0, 0.0, 0.0)
    ops.geomTransf("Linear", 2, 0.0, 0.0, 1.0)
    for k in range(4):
        ops.element("elasticBeamColumn", k + 1, k + 1, k + 11, 0.16, 30e9, 12.5e9, 3.6e-3, 2.1e-3, 2.1e-3, 1)
        ops.element("elasticBeamColumn", 10 + k, k + 11, (k + 1) % 4 + 11, 0.18, 30e9, 12.5e9, 4e-3, 2e-3, 5e-3, 2)
        ops.rigidLink("beam", 100, k + 1)


OUTLINE = [(-1.0, -1.0), (7.0, -1.0), (7.0, 5.0), (-1.0, 5.0)]


@pytest.mark.parametrize("offset", [0.0, 0.02, -0.1, 1e-9])
def test_a_node_off_the_plane_of_its_diaphragm_is_named_and_tied_as_opensees_ties_it(offset: float) -> None:
    """OpenSees 3.7.1 writes that it ignores node 13, and ties it with the arms of node 12."""
    a_floor(offset)
    ops.rigidDiaphragm(3, 20, 11, 12, 13, 14)
    ops.fix(20, 0, 0, 1, 1, 1, 0)
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        model = opensees.structure(ops, [100], outline=OUTLINE)
    texts = [str(own.message) for own in caught]
    if offset:
        assert len(texts) == 1, texts
        assert texts[0].startswith(f"node 13 is {abs(offset):.3g} m off the plane of node 20, to which rigidDiaphragm ties it")
    else:
        assert texts == []
    ops.fix(100, 1, 1, 1, 1, 1, 1)
    ops.timeSeries("Linear", 1)
    ops.pattern("Plain", 1, 1)
    ops.load(20, 1e5, 3e4, 0.0, 0.0, 0.0, 2e5)
    ops.constraints("Transformation")
    ops.numberer("Plain")
    ops.system("FullGeneral")
    ops.algorithm("Linear")
    ops.integrator("LoadControl", 1.0)
    ops.analysis("Static")
    assert ops.analyze(1) == 0
    where = {"x": 0, "y": 1, "z": 2, "rx": 3, "ry": 4, "rz": 5}
    names = [own.split() for own in model.dof_names]
    moved = [ops.nodeDisp(int(tag))[where[direction]] for tag, direction in names]
    for tag in (11, 12, 13, 14):
        found = [model.row(tag, direction).value(moved) for direction in ("x", "y", "rz")]
        np.testing.assert_allclose(found, [ops.nodeDisp(tag)[k] for k in (0, 1, 5)], rtol=1e-9)
    arm = ops.nodeDisp(13)[0] - ops.nodeDisp(12)[0]
    assert (abs(arm) < 1e-12) == bool(offset)


def test_other_ties_between_heights_are_not_taken_for_diaphragms() -> None:
    a_floor(0.02)
    for tag in (11, 12, 13, 14):
        ops.equalDOF(20, tag, 1, 2, 6)
    ops.fix(20, 0, 0, 1, 1, 1, 0)
    with pytest.warns(bm.BasematWarning) as caught:
        opensees.structure(ops, [100], outline=OUTLINE)
    assert not any("off the plane" in str(own.message) for own in caught)
