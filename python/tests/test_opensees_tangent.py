"""What of an OpenSees model is not linear: named, refused, or taken at its present tangent."""

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


def column(material: tuple[object, ...], element: str, transformation: str) -> None:
    """A column whose upper half is the element 7 of this material and transformation."""
    ops.wipe()
    ops.model("basic", "-ndm", 2, "-ndf", 3)
    for tag in (1, 2, 3):
        ops.node(tag, 0.0, 4.0 * (tag - 1))
        ops.mass(tag, 1e4, 1e4, 1e3)
    ops.geomTransf("Linear", 1)
    ops.geomTransf(transformation, 2)
    ops.uniaxialMaterial("Elastic", 1, 30e9)
    ops.uniaxialMaterial(material[0], 2, *material[1:])
    ops.uniaxialMaterial("Parallel", 3, 1, 2)
    ops.section("Fiber", 1)
    ops.patch("rect", 3, 10, 1, -0.2, -0.5, 0.2, 0.5)
    ops.beamIntegration("Lobatto", 1, 1, 3)
    ops.element("elasticBeamColumn", 1, 1, 2, 0.25, 30e9, 0.005, 1)
    properties = {
        "elasticBeamColumn": (0.25, 30e9, 0.005, 2),
        "dispBeamColumn": (2, 1),
        "forceBeamColumn": (2, 1),
        "corotTruss": (0.25, 1),
        "Truss": (0.25, 3),
        "twoNodeLink": ("-mat", 2, 1, 1, "-dir", 1, 2, 3),
    }
    ops.element(element, 7, 2, 3, *properties[element])
    if element in ("corotTruss", "Truss"):
        ops.element("elasticBeamColumn", 2, 2, 3, 0.25, 30e9, 0.005, 1)


STEEL, ELASTIC = ("Steel01", 2.5e8, 2e11, 0.01), ("Elastic", 2e11)


@pytest.mark.parametrize(
    ("material", "element", "transformation", "text"),
    [
        (STEEL, "dispBeamColumn", "Linear", r"7 \(DispBeamColumn2d, section 1 FiberSection2d, material 2 Steel01\)"),
        (STEEL, "forceBeamColumn", "Linear", r"7 \(ForceBeamColumn2d, section 1 FiberSection2d, material 2 Steel01\)"),
        (ELASTIC, "elasticBeamColumn", "PDelta", r"element 7 \(ElasticBeam2d, PDeltaCrdTransf2d\)"),
        (ELASTIC, "forceBeamColumn", "Corotational", r"element 7 \(ForceBeamColumn2d, CorotCrdTransf2d\)"),
        (ELASTIC, "corotTruss", "Linear", r"element 7 \(CorotTruss\)"),
        (STEEL, "Truss", "Linear", r"element 7 \(Truss, material 2 Steel01\)"),
        (("Concrete01", -30e6, -0.002, -20e6, -0.004), "twoNodeLink", "Linear", r"TwoNodeLink, material 2 Concrete01"),
    ],
)
def test_what_is_not_linear_is_named(material: tuple[object, ...], element: str, transformation: str, text: str) -> None:
    column(material, element, transformation)
    with pytest.warns(bm.BasematWarning, match=text + ".*initial tangent"):
        opensees.structure(ops, [1], width=4.0)


@pytest.mark.filterwarnings("error")
@pytest.mark.parametrize("element", ["elasticBeamColumn", "dispBeamColumn", "forceBeamColumn", "Truss", "twoNodeLink"])
@pytest.mark.parametrize("material", [ELASTIC, ("Elastic", 2e11, 1e6), ("Viscous", 1e6, 1.0)])
def test_what_is_linear_is_not_named(material: tuple[object, ...], element: str) -> None:
    column(material, element, "Linear")
    opensees.structure(ops, [1], width=4.0)


@pytest.mark.parametrize(
    ("material", "text"),
    [
        (("ENT", 2e11), "material 2 ENTMaterial"),
        (("Elastic", 2e11, 0.0, 1e11), "material 2 ElasticMaterial"),
        (("Viscous", 1e6, 0.5), "material 2 ViscousMaterial"),
        (("ElasticPPGap", 1e9, 1e6, 0.01), "material 2 EPPGap"),
    ],
)
def test_what_has_no_tangent_is_an_error(material: tuple[object, ...], text: str) -> None:
    column(material, "twoNodeLink", "Linear")
    with pytest.raises(bm.InputError, match=rf"element 7 \(TwoNodeLink, {text}\) without a tangent at rest"):
        opensees.structure(ops, [1], width=4.0)


def test_the_present_tangent_is_taken_if_told() -> None:
    """P-Delta of a gravity analysis takes W/L from the lateral stiffness of the chord."""
    column(ELASTIC, "elasticBeamColumn", "PDelta")
    weight = 2e6
    with pytest.warns(bm.BasematWarning, match="PDelta"):
        fresh = opensees.structure(ops, [1], width=4.0).stiffness()
    ops.fix(1, 1, 1, 1)
    ops.timeSeries("Linear", 1)
    ops.pattern("Plain", 1, 1)
    ops.load(3, 0.0, -weight, 0.0)
    ops.constraints("Plain")
    ops.numberer("Plain")
    ops.system("FullGeneral")
    ops.algorithm("Linear")
    ops.integrator("LoadControl", 1.0)
    ops.analysis("Static")
    assert ops.analyze(1) == 0
    for k in (1, 2, 3):
        ops.remove("sp", 1, k)
    with pytest.raises(bm.InputError, match=r"analyses have changed the stiffness.*ops\.reset\(\).*tangent='present'"):
        opensees.structure(ops, [1], width=4.0)
    with pytest.warns(bm.BasematWarning, match="present tangent"):
        model = opensees.structure(ops, [1], width=4.0, tangent="present")
    top = model.row(3).weights(model.dofs)
    assert top @ (fresh - model.stiffness()) @ top == pytest.approx(weight / 4.0, rel=1e-6)
    ops.reset()
    with pytest.warns(bm.BasematWarning, match="initial tangent"):
        assert np.array_equal(opensees.structure(ops, [1], width=4.0).stiffness(), fresh)
    with pytest.raises(bm.InputError, match="tangent is 'secant', but must be 'initial' or 'present'"):
        opensees.structure(ops, [1], width=4.0, tangent="secant")  # type: ignore[arg-type]
