"""GOAL: deformed shapes of any structure, values of shells in plan, and animations, as arrays and as pictures.
SCENE: blocks, a building, a raft of shells, reduced, damped, sprung and grouped; points by hand.
REFERENCE: rows of the structures themselves, rigid rotations by hand, the data behind each picture.
"""

from __future__ import annotations

import io
import pickle
from pathlib import Path

import numpy as np
import pytest

import basemat as bm

SOIL = bm.Soil(80e6, 0.33, 1900.0)
STOREYS = [bm.Storey(3.0, 20e3, 20e6)] * 2
BUILDING = bm.ShearBuilding(8.0, 50e3, 4e5, STOREYS)
CONCRETE = bm.Material(30e9, 0.2, 2500.0)


def raft() -> tuple[bm.Mesh, list[int]]:
    """A mat of 8 m × 8 m with a pole, and its shells."""
    mesh, line = bm.Mesh.in_space(), np.linspace(-4.0, 4.0, 5)
    x, y = np.meshgrid(line, line)
    shells = mesh.add_shells(mesh.add_grid(np.stack([x, y, 0.0 * x], axis=2)).cells, CONCRETE, 0.5)
    top = mesh.add_node(0.0, 0.0, 6.0)
    mesh.add_space_beams([[mesh.node_at(0.0, 0.0), top]], CONCRETE, bm.BeamSection(1.0, (0.1, 0.1), 0.1), (1.0, 0.0, 0.0))
    return mesh, shells


def test_a_block_turns_as_a_box() -> None:
    block = bm.RigidBlock(4.0, 10.0, 2000.0)
    with pytest.raises(bm.InputError, match="height"):
        bm.DeformedShape(block)
    shape = bm.DeformedShape(block, height=10.0)
    assert not shape.in_space and shape.cells == [[0, 1, 2, 3]]
    assert shape.points.tolist() == [[-2.0, 0.0, 0.0], [2.0, 0.0, 0.0], [2.0, 10.0, 0.0], [-2.0, 10.0, 0.0]]
    moved = shape.displacements([0.1, 0.0, 0.01])
    np.testing.assert_allclose(moved[2], [0.1 - 0.1, 0.02, 0.0], atol=1e-15)
    with pytest.raises(bm.InputError, match="deformed shape"):
        shape.displacements([0.0])


def test_structures_made_of_others_have_the_shapes_of_those() -> None:
    rng = np.random.default_rng(3)
    own, u = bm.DeformedShape(BUILDING), rng.normal(size=BUILDING.dofs)
    springs = bm.WithSprings(BUILDING, [(BUILDING.drift(0), bm.Bilinear(1e6, 1e3, 0.1))])
    for same in (springs, bm.WithModalDamping(springs, [0.05], fixed_base=True)):
        shape = bm.DeformedShape(same)
        assert shape.cells == own.cells and np.array_equal(shape.points, own.points)
        assert np.array_equal(shape.displacements(u), own.displacements(u))
    reduced = bm.ReducedModel(BUILDING, 1)
    v = rng.normal(size=reduced.dofs)
    expected = own.displacements(reduced.full(v))
    np.testing.assert_allclose(bm.DeformedShape(reduced).displacements(v), expected, rtol=1e-12, atol=1e-14)
    pair = bm.StructureGroup([(BUILDING, -10.0), (bm.RigidBlock(4.0, 5.0, 2e3), 10.0)])
    both = bm.DeformedShape(pair, height=5.0)
    count, w = len(own.points), rng.normal(size=pair.dofs)
    np.testing.assert_allclose(both.points[:count, 0], own.points[:, 0] - 10.0)
    assert both.points[count:, 0].tolist() == [8.0, 12.0, 12.0, 8.0] and both.cells[-1] == [count + k for k in range(4)]
    roof = pair.row(0, BUILDING.roof).value(w)
    assert both.displacements(w)[count - 1, 0] == pytest.approx(roof, rel=1e-12)
    again = pickle.loads(pickle.dumps(both))
    assert np.array_equal(again.displacements(w), both.displacements(w))


def test_points_of_your_own_and_a_structure_that_has_them() -> None:
    shape = bm.DeformedShape.of_points([[0.0, 0.0, 0.0], [0.0, 1.0, 4.0]], [[0, 1, 2], [{3: 2.0}, 4, []]], [[0, 1]])
    assert shape.in_space and shape.points.tolist() == [[0.0, 0.0, 0.0], [0.0, 1.0, 4.0]]
    assert shape.displacements([1.0, 2.0, 3.0, 4.0, 5.0]).tolist() == [[1.0, 2.0, 3.0], [8.0, 5.0, 0.0]]
    for points, rows, message in (
        ([[0.0, 0.0]], [], "rows has 0 entries, but must have 1"),
        ([[0.0, 0.0]], [[0, 1, 2]], "a point has 3 rows, but must have 2"),
    ):
        with pytest.raises(bm.InputError, match=message):
            bm.DeformedShape.of_points(points, rows, [])

    class Own:
        def deformed_shape(self) -> object:
            return shape

    assert bm.DeformedShape(Own()).cells == [[0, 1]]  # type: ignore[arg-type]


def test_a_state_for_paraview_is_the_shape_in_a_file(tmp_path: Path) -> None:
    mesh, _ = raft()
    model = bm.FemModel(mesh)
    ground = bm.ElasticGround.under(SOIL, model, 4)
    motion = bm.triaxial(x=bm.el_centro_1940())
    simulation = bm.Simulation(0.01, model, ground, bm.Coulomb(0.5), motion=motion)
    run = simulation.run(20, motion_every=10)
    static = run.static_displacement
    assert np.array_equal(static, simulation.static_displacement) and np.abs(static).max() > 1e-5
    with pytest.raises(bm.InputError, match="motion_every"):
        simulation.run(1).static_displacement  # noqa: B018
    shape = bm.DeformedShape(model)
    shape.save_paraview_state(tmp_path / "rest.vtu", static)
    text = (tmp_path / "rest.vtu").read_text("utf-8")
    # All elements of the mesh are cells: 16 shells and a beam.
    assert 'NumberOfPoints="26" NumberOfCells="17"' in text
    numbers = text.split('Name="displacement"')[1].split(">")[1].split("<")[0].split()
    np.testing.assert_allclose(np.array(numbers, dtype=float).reshape(-1, 3), shape.displacements(static), rtol=1e-12)
    assert run.save_paraview(tmp_path, "raft", shape) == run.save_paraview(tmp_path, "again", model) == 3
    assert (tmp_path / "raft_0001.vtu").read_bytes() == (tmp_path / "again_0001.vtu").read_bytes()


def test_a_picture_shows_the_moved_points() -> None:
    pytest.importorskip("matplotlib").use("agg")
    from matplotlib import pyplot

    u = np.zeros(BUILDING.dofs)
    u[-1] = 0.01
    shape = bm.DeformedShape(BUILDING)
    axes = shape.plot(u, scale=50.0, title="push")
    rest, moved = axes.collections
    assert axes.get_title(loc="left") == "push" and axes.get_xlabel() == "x, m"
    corners = np.concatenate([path.vertices for path in moved.get_paths()])
    assert corners[:, 0].max() == pytest.approx(4.0 + 50.0 * 0.01)
    [text] = axes.get_legend().get_texts()
    assert text.get_text() == "displacements × 50"
    # Further states have the scale of the first.
    shape.plot(u, axes=axes, label="again")
    assert axes.get_legend().get_texts()[1].get_text() == "again, displacements × 50"
    assert len(axes.collections) == 3 and len({tuple(own.get_edgecolor()[0]) for own in axes.collections}) == 3
    # A round scale of its own, by which the roof moves a twentieth to a tenth of the width of 8 m.
    assert shape.plot(u).get_legend().get_texts()[0].get_text() == "displacements × 50"
    mesh, _ = raft()
    model = bm.FemModel(mesh)
    lifted = bm.DeformedShape(model).plot(model.rigid_motion("z"), scale=1.0)
    first, second = (own.get_paths()[0].vertices for own in lifted.collections)
    np.testing.assert_allclose(second - first, np.broadcast_to([0.0, 1.0], first.shape), atol=1e-12)
    pyplot.close("all")


def test_values_of_shells_in_plan() -> None:
    pytest.importorskip("matplotlib").use("agg")
    from matplotlib import pyplot

    mesh, shells = raft()
    values = np.linspace(-30.0, 45.0, 16)
    axes = mesh.plot_shells(shells, values, quantity="m_x, kN·m/m")
    [cells] = axes.collections
    assert np.array_equal(cells.get_array(), values)
    x, y = np.mean(mesh.nodes[mesh.elements[shells[5]]][:, :2], axis=0)
    np.testing.assert_allclose(cells.get_paths()[5].vertices[:4].mean(axis=0), [x, y])
    bar = axes.figure.axes[1]
    assert bar.get_ylabel() == "m_x, kN·m/m" and bar.get_ylim() == (-30.0, 50.0)
    wall = mesh.add_shells([[0, 1, *mesh.add_nodes([[-2.0, -4.0, 3.0], [-4.0, -4.0, 3.0]])]], CONCRETE, 0.3)
    for elements, given, message in (
        (shells, values[1:], r"shape \(15,\), but must have \(16,\)"),
        ([16], [1.0], "element 16 is no shell"),
        (wall, [1.0], "stands upright"),
        ([99], [1.0], "element is 99"),
        ([0], [np.nan], "finite"),
        ([], [], "at least"),
    ):
        with pytest.raises(bm.InputError, match=message):
            mesh.plot_shells(elements, given)
    pyplot.close("all")


def test_animations_draw_only_what_moves() -> None:
    pytest.importorskip("matplotlib").use("agg")
    from matplotlib import pyplot

    ground = bm.ElasticGround.under(SOIL, BUILDING, 8)
    motion = bm.el_centro_1940().scaled(1.5)
    run = bm.Simulation(0.005, BUILDING, ground, bm.Coulomb(0.3), motion=motion).run(600, contact_every=2, motion_every=2)
    with pytest.raises(bm.InputError, match="frames are 1"):
        run.animate(frames=1)
    moving = run.animate(structure=BUILDING, scale=30.0, title="three seconds")
    moving._draw_was_started = True
    # 301 snapshots are too many; a frame takes the time of those that it stands for.
    assert moving._save_count == 200 and moving._blit
    assert moving._interval == pytest.approx(40.0)
    figure = moving._fig
    assert figure.get_layout_engine() is None or not figure.get_layout_engine().adjust_compatible
    artists = moving._func(199)
    contact, last = run.contact, run.contact["time"][-1]
    structure, gap, slip, pressure, strip, clock = artists
    assert clock.get_text() == f"{last:.2f} s"
    for line, factor, name in ((gap, 1e3, "gap"), (slip, 1e3, "slip"), (pressure, 1e-3, "pressure")):
        np.testing.assert_allclose(line.get_ydata()[::3], factor * contact[name][-1], rtol=1e-12)
    colors = {tuple(own) for own in strip.get_colors()}
    assert len(colors) == len(np.unique(contact["mode"][-1]))
    shape = bm.DeformedShape(BUILDING)
    places = shape.points + 30.0 * shape.displacements(run.motion["displacement"][-1])
    found = np.concatenate([path.vertices for path in structure.get_paths()])
    assert found[:, 0].max() == pytest.approx(places[:, 0].max(), rel=1e-9)
    pyplot.close("all")


def test_saved_frames_are_full_drawings(tmp_path: Path) -> None:
    pytest.importorskip("matplotlib").use("agg")
    from matplotlib import pyplot
    from PIL import Image

    ground = bm.ElasticGround.under(SOIL, BUILDING, 8)
    simulation = bm.Simulation(0.01, BUILDING, ground, bm.Coulomb(0.3), motion=bm.el_centro_1940().scaled(1.5))
    moving = simulation.run(250, contact_every=50, motion_every=50).animate(structure=BUILDING, frames=3, title="three")
    figure = moving._fig

    def drawn(frame: int) -> np.ndarray:
        moving._func(frame)
        file = io.BytesIO()
        figure.savefig(file, format="rgba")
        width, height = figure.canvas.get_width_height()
        return np.frombuffer(file.getvalue(), np.uint8).reshape(height, width, 4)[..., :3].astype(float)

    def changed(one: np.ndarray, other: np.ndarray) -> float:
        """Fraction of the pixels that differ by more than the palette of a GIF makes."""
        return float((np.abs(one - other).max(axis=2) > 80.0).mean())

    before = [drawn(frame) for frame in range(3)]
    assert changed(before[0], before[2]) > 5e-3
    moving.save(tmp_path / "moving.gif")
    with Image.open(tmp_path / "moving.gif") as file:
        assert file.n_frames == 3  # type: ignore[attr-defined]
        for frame, whole in enumerate(before):
            file.seek(frame)
            saved = np.asarray(file.convert("RGB"), dtype=float)
            assert saved.shape == whole.shape and changed(saved, whole) < 2e-4
    # The figure is as it was.
    assert np.array_equal(drawn(1), before[1])
    pyplot.close("all")
