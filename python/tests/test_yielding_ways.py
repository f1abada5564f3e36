"""GOAL: every way into a mesh takes materials that yield, and every way out of a simulation their states.
SCENE: layers of blocks, groups of Gmsh files, members of groups of structures; parts that are linear.
REFERENCE: quadrilaterals added one by one; members alone; errors that name the reason.
"""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from conftest import same_bits
from test_yielding import CLAY, ELASTIC, MISES, VonMises, block, shaken, tied

import basemat as bm

pytestmark = pytest.mark.filterwarnings("ignore::basemat.BasematWarning")


def test_states_of_points_of_members() -> None:
    clay, sand = tied(block(CLAY)), tied(block(MISES))
    block_between = bm.RigidBlock(2.0, 3.0, 2000.0)
    # On springs every member moves as if it stood alone.
    group = bm.StructureGroup([(clay, 0.0), (block_between, 10.0), (sand, 20.0)])
    together = shaken(group)
    together.run(200)
    for member, model in ((0, clay), (2, sand)):
        alone = shaken(model)
        alone.run(200)
        for element in range(4):
            found, expected = together.solid_points(element, member=member), alone.solid_points(element)
            for name in ("strain", "stress"):
                values = getattr(expected, name)
                assert np.abs(values).max() > 0.0
                np.testing.assert_allclose(getattr(found, name), values, atol=1e-6 * np.abs(values).max())
        elements, strains = together.solid_values("plastic_strain", member=member)
        assert elements == [0, 1, 2, 3] and strains.max() > 1e-6
        np.testing.assert_allclose(strains, alone.solid_values("plastic_strain")[1], rtol=1e-5, atol=1e-12)
    with pytest.raises(bm.InputError, match="member must be the number of one of its structures"):
        together.solid_points(0)
    with pytest.raises(bm.InputError, match="must be a FemModel with materials that yield"):
        together.solid_points(0, member=1)
    with pytest.raises(bm.InputError, match="structure of the group"):
        together.solid_points(0, member=3)
    with pytest.raises(bm.InputError, match="the simulation has none"):
        shaken(clay).solid_points(0, member=0)


def test_layers_and_groups_of_gmsh_take_any_material(tmp_path: Path) -> None:
    by_layers = bm.Mesh.layered_block(-1.0, 1.0, 2, [bm.Layer(2.0, 2, CLAY), bm.Layer(1.0, 1, ELASTIC)])
    by_quads = bm.Mesh([[x, y] for y in (0.0, 1.0, 2.0, 3.0) for x in (-1.0, 0.0, 1.0)])
    rows = [[3 * j + i, 3 * j + i + 1, 3 * j + i + 4, 3 * j + i + 3] for j in range(3) for i in range(2)]
    by_quads.add_quads(rows, [CLAY] * 4 + [ELASTIC] * 2)
    lines = ["$MeshFormat", "2.2 0 8", "$EndMeshFormat", "$PhysicalNames", "2", '2 1 "soil"', '2 2 "fill"', "$EndPhysicalNames"]
    lines += ["$Nodes", "12"] + [f"{k + 1} {k % 3 - 1} {k // 3} 0" for k in range(12)] + ["$EndNodes", "$Elements", "6"]
    for number, row in enumerate(rows):
        tag = 1 if number < 4 else 2
        lines.append(" ".join(map(str, [number + 1, 3, 2, tag, tag, *(node + 1 for node in row)])))
    path = tmp_path / "soil.msh"
    path.write_text("\n".join([*lines, "$EndElements", ""]))
    gmsh = bm.GmshMesh(path)
    from_file = gmsh.mesh({"soil": CLAY, "fill": ELASTIC})
    series = []
    for mesh in (by_layers, by_quads, from_file):
        model = bm.FemModel(mesh)
        assert model.inelastic_elements == [0, 1, 2, 3]
        series.append(shaken(model).run(100)["base_shear"])
    assert same_bits(series[0], series[1]) and same_bits(series[0], series[2])
    own = gmsh.mesh({"soil": VonMises(), "fill": ELASTIC})
    package = gmsh.mesh({"soil": MISES, "fill": ELASTIC})
    results = [shaken(bm.FemModel(mesh)).run(100)["base_shear"] for mesh in (own, package)]
    np.testing.assert_allclose(results[0], results[1], atol=1e-9 * np.abs(results[1]).max())
    with pytest.raises(bm.FileError, match='formulation must be "mean_dilatation"'):
        gmsh.mesh({"soil": CLAY, "fill": ELASTIC}, formulation="incompatible_modes")


def test_linear_parts_refuse_materials_that_yield(tmp_path: Path) -> None:
    mesh = bm.Mesh.in_space([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0], [0, 0, 1], [1, 0, 1], [1, 1, 1], [0, 1, 1]])
    section = bm.BeamSection(0.1, [1e-3, 1e-3], 1e-3)
    reason = "of the type Iwan, but must be a Material: bricks, shells and beams do not yield"
    for add in (
        lambda: mesh.add_bricks([range(8)], CLAY),
        lambda: mesh.add_shells([[0, 1, 2, 3]], CLAY, 0.2),
        lambda: mesh.add_shells([[0, 1, 2, 3]], [CLAY], 0.2),
        lambda: mesh.add_space_beams([[0, 4]], CLAY, section, [1, 0, 0]),
    ):
        with pytest.raises(TypeError, match=reason):
            add()
    with pytest.raises(TypeError, match="must be a Soil: the far field is linear"):
        bm.SoilLayer(CLAY, 5.0)
