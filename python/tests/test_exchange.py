"""GOAL: runs as datasets of xarray, shapes and meshes as grids of PyVista, with their units.
SCENE: a block that rocks, a raft of shells, a column of soil, a brick.
REFERENCE: the arrays of the results themselves; sizes and areas by hand.
"""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

import basemat as bm

CONCRETE = bm.Material(30e9, 0.2, 2500.0)


def test_a_run_is_a_dataset_with_units(rocking, tmp_path: Path) -> None:
    xarray = pytest.importorskip("xarray")
    run = rocking().run(300, contact_every=10, motion_every=20, warn=False)
    data = run.to_xarray()
    assert isinstance(data, xarray.Dataset) and data.attrs["ground_motion"] == run.to_frame().attrs["ground_motion"]
    for name, values in run.series.items():
        assert np.array_equal(data[name], values) and (name == "time" or data[name].dims == ("time",))
    assert data["base_shear"].attrs == {"units": "N/m"} and data["roof"].attrs["units"] == "m/s²"
    assert data["base_shear"].sel(time=1.0, method="nearest") == run["base_shear"][100]
    for name in ("gap", "slip", "pressure", "shear", "mode"):
        assert data[f"contact_{name}"].dims == ("contact_time", "element")
        assert np.array_equal(data[f"contact_{name}"], run.contact[name])
    assert data["contact_mode"].attrs["modes"] == bm.MODES and data["contact_pressure"].attrs["units"] == "Pa"
    assert np.array_equal(data["displacement"], run.motion["displacement"]) and data["displacement"].dims == ("motion_time", "dof")
    assert np.array_equal(data["envelope_gap"], run.envelope["gap"]) and data["envelope_gap_time"].attrs["units"] == "s"
    assert np.array_equal(data["left"], run.envelope["left"]) and data["bottom"].attrs["units"] == "m"
    assert np.array_equal(data["energy_soil"], run.energy_balances["soil"]) and data["energy_soil"].attrs["units"] == "J/m"
    bare = rocking(probes=[]).run(20, warn=False).to_xarray()
    assert "contact_gap" not in bare and "displacement" not in bare


def test_a_run_in_plan_is_a_dataset() -> None:
    pytest.importorskip("xarray")
    body = bm.RigidBody.cuboid(4.0, 3.0, 2.0, 2e3)
    ground = bm.SpringGround.under(body, 3, 1e8, 5e7)
    run = bm.Simulation(0.01, body, ground, bm.Coulomb(0.3), motion=bm.el_centro_1940()).run(100, contact_every=10, warn=False)
    data = run.to_xarray()
    assert {"left", "right", "front", "back", "bottom", "top"} <= set(data.coords) and data["torque"].attrs["units"] == "N·m"
    assert np.array_equal(data["contact_slip_across"], run.contact["slip_across"])


def raft() -> tuple[bm.Mesh, list[int]]:
    mesh, line = bm.Mesh.in_space(), np.linspace(-4.0, 4.0, 5)
    x, y = np.meshgrid(line, line)
    shells = mesh.add_shells(mesh.add_grid(np.stack([x, y, 0.0 * x], axis=2)).cells, CONCRETE, 0.5)
    top = mesh.add_node(0.0, 0.0, 6.0)
    mesh.add_space_beams([[mesh.node_at(0.0, 0.0), top]], CONCRETE, bm.BeamSection(1.0, (0.1, 0.1), 0.1), (1.0, 0.0, 0.0))
    return mesh, shells


def test_shapes_and_meshes_are_grids() -> None:
    pytest.importorskip("pyvista")
    mesh, shells = raft()
    model = bm.FemModel(mesh)
    shape = bm.DeformedShape(model)
    u = model.rigid_motion("z", [0.0, 0.0, 0.0])
    grid = shape.to_pyvista(u, scale=2.0)
    np.testing.assert_allclose(grid.points, shape.points + [0.0, 0.0, 2.0], atol=1e-12)
    assert np.array_equal(grid.point_data["displacement"], shape.displacements(u)) and grid.field_data["scale"][0] == 2.0
    assert list(grid.field_data["units"]) == ["points: m", "displacement: m"]
    assert grid.n_cells == len(shape.cells) and np.array_equal(shape.to_pyvista().points, shape.points)
    values = np.arange(16.0)
    plate = mesh.to_pyvista({"moment": values}, elements=shells, units={"moment": "N·m/m"})
    assert np.array_equal(plate.cell_data["moment"], values) and list(plate.cell_data["element"]) == shells
    assert plate.compute_cell_sizes()["Area"].sum() == pytest.approx(64.0) and "moment: N m/m" in list(plate.field_data["units"])
    assert mesh.to_pyvista().n_cells == 17
    with pytest.raises(bm.InputError, match=r"values 'moment' have the shape \(3,\)"):
        mesh.to_pyvista({"moment": values[:3]}, elements=shells)
    with pytest.raises(bm.InputError, match="element is 99, but must be one of the mesh's 17"):
        mesh.to_pyvista(elements=[99])


def test_bricks_and_quadrilaterals_of_eight_nodes_have_their_volumes() -> None:
    pytest.importorskip("pyvista")
    block = bm.Mesh.quad8_block([0.0, 1.0, 3.0], [0.0, 2.0], CONCRETE).to_pyvista()
    assert set(block.celltypes) == {23}
    # Each node in the middle of a side is the mean of that side's ends.
    for cell in range(block.n_cells):
        points = block.get_cell(cell).points
        np.testing.assert_allclose(points[4:], 0.5 * (points[:4] + np.roll(points[:4], -1, axis=0)), atol=1e-12)
    mesh = bm.Mesh.in_space()
    corners = [(0, 0), (2, 0), (2, 3), (0, 3)]
    nodes = [mesh.add_node(float(x), float(y), z) for z in (0.0, 1.5) for x, y in corners]
    mesh.add_bricks([nodes], CONCRETE)
    grid = mesh.to_pyvista()
    assert list(grid.celltypes) == [12] and grid.volume == pytest.approx(9.0)
