"""GOAL: loops of stress and strain, and values of solids in a section, as pictures.
SCENE: a loop by hand; a block of quadrilaterals with a bar, a mass and an eight-node quadrilateral.
REFERENCE: the data behind each picture.
"""

from __future__ import annotations

import numpy as np
import pytest

import basemat as bm

SOIL = bm.Material(60e6, 0.3, 1800.0)
STRAIN = np.array([0.0, 4e-3, 2e-3, -4e-3, -2e-3])
STRESS = np.array([0.0, 30e3, -5e3, -30e3, 5e3])


def section() -> bm.Mesh:
    """Six quadrilaterals of 4 m by 2 m (0 to 5), a bar (6), a mass (7), and an eight-node quadrilateral (8)."""
    mesh = bm.Mesh.layered_block(-6.0, 6.0, 3, [bm.Layer(4.0, 2, SOIL)])
    top = mesh.add_node(-2.0, 7.0)
    mesh.add_beams([[mesh.node_at(-2.0, 4.0), top]], 3e10, 0.4, 0.01, 2400.0)
    mesh.add_mass(top, 5000.0)
    corners = [[6.0, 4.0], [8.0, 4.0], [8.0, 6.0], [6.0, 6.0]]
    middles = [[7.0, 4.0], [8.0, 5.0], [7.0, 6.0], [6.0, 5.0]]
    mesh.add_quads([mesh.add_nodes(corners + middles)], SOIL)
    return mesh


def test_loops_of_stress_and_strain() -> None:
    pytest.importorskip("matplotlib").use("agg")
    from matplotlib import pyplot

    axes = bm.plot_stress_strain(STRAIN, STRESS, label="3 m deep", title="sand")
    assert (axes.get_xlabel(), axes.get_ylabel()) == ("shear strain, %", "shear stress, kPa")
    np.testing.assert_allclose(axes.get_lines()[0].get_xydata(), np.stack([100.0 * STRAIN, 1e-3 * STRESS], axis=1))
    # A further path in the same axes has the unit of the first.
    assert bm.plot_stress_strain(0.1 * STRAIN, STRESS, axes, label="10 m deep") is axes
    second = axes.get_lines()[1]
    assert second.get_xdata().max() == pytest.approx(0.04) and second.get_color() != axes.get_lines()[0].get_color()
    assert [text.get_text() for text in axes.get_legend().get_texts()] == ["3 m deep", "10 m deep"]
    small = bm.plot_stress_strain(0.1 * STRAIN, STRESS)
    assert small.get_xlabel() == "shear strain, 10⁻³" and small.get_legend() is None
    assert small.get_lines()[0].get_xdata().max() == pytest.approx(0.4)
    for strain, stress, message in (
        (STRAIN, STRESS[1:], r"shapes \(5,\) and \(4,\)"),
        ([STRAIN], [STRESS], r"must both have \(n,\)"),
        ([], [], "are empty"),
        ([0.0, np.nan], [0.0, 1.0], "must be finite"),
        ([0.0, 1.0], [0.0, np.inf], "must be finite"),
    ):
        with pytest.raises(bm.InputError, match=message):
            bm.plot_stress_strain(strain, stress)
    pyplot.close("all")


def test_values_of_solids_in_a_section() -> None:
    pytest.importorskip("matplotlib").use("agg")
    from matplotlib import pyplot

    mesh = section()
    values = [0.0, 0.31, 0.7, 1.0]
    axes = mesh.plot_solids([3, 4, 5, 8], values, quantity="mobilised strength", title="sand")
    cells, outlines, bars = axes.collections
    assert cells.get_array().tolist() == values
    middles = [path.vertices[:4].mean(axis=0) for path in cells.get_paths()]
    np.testing.assert_allclose(middles, [[-4.0, 3.0], [0.0, 3.0], [4.0, 3.0], [7.0, 5.0]])
    # The lower row has no values; the mass is not drawn.
    middles = [path.vertices[:4].mean(axis=0) for path in outlines.get_paths()]
    np.testing.assert_allclose(middles, [[-4.0, 1.0], [0.0, 1.0], [4.0, 1.0]])
    [bar] = bars.get_paths()
    np.testing.assert_allclose(bar.vertices, [[-2.0, 4.0], [-2.0, 7.0]])
    assert [text.get_text() for text in axes.get_legend().get_texts()] == ["without a value"]
    key = axes.figure.axes[1]
    assert key.get_ylabel() == "mobilised strength" and key.get_ylim() == (0.0, 1.0)
    every = mesh.plot_solids([0, 1, 2, 3, 4, 5, 8], np.linspace(-30.0, 45.0, 7))
    assert every.get_legend() is None and every.figure.axes[1].get_ylim() == (-30.0, 45.0)
    in_space = bm.Mesh.in_space()
    shell = in_space.add_nodes([[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 0.0]])
    in_space.add_shells([shell], SOIL, 0.5)
    for scene, elements, given, message in (
        (mesh, [0, 1], [1.0], r"shape \(1,\), but must have \(2,\): one for each solid"),
        (mesh, [6], [1.0], "element 6 is no solid"),
        (mesh, [7], [1.0], "element 7 is no solid"),
        (in_space, [0], [1.0], "element 0 is no solid of a mesh in the plane"),
        (mesh, [2, 3, 2], [1.0, 2.0, 3.0], "element 2 has two values"),
        (mesh, [9], [1.0], "element is 9, but must be one of the mesh's 9"),
        (mesh, [-1], [1.0], "element is -1"),
        (mesh, [0], [np.nan], "values of solids must be finite"),
        (mesh, [], [], "at least"),
    ):
        with pytest.raises(bm.InputError, match=message):
            scene.plot_solids(elements, given)
    pyplot.close("all")
