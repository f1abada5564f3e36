"""GOAL: pictures of walls, of moments of shells and of modes, and films without ffmpeg.
SCENE: a basement in a trench, a raft with walls, a block that rocks.
REFERENCE: envelopes and resultants behind the pictures; distances of colours by CIE 1976.
"""

from __future__ import annotations

import itertools
import re
from pathlib import Path

import numpy as np
import pytest

import basemat as bm
from basemat import _figures

pytest.importorskip("matplotlib").use("agg")
CONCRETE = bm.Material(30e9, 0.2, 2500.0)


def lab(color: str) -> np.ndarray:
    """Lightness and chromaticity of a colour of the screen, CIE 1976 under D65."""
    rgb = np.array([int(color[k : k + 2], 16) / 255.0 for k in (1, 3, 5)])
    linear = np.where(rgb <= 0.04045, rgb / 12.92, ((rgb + 0.055) / 1.055) ** 2.4)
    matrix = [[0.4124, 0.3576, 0.1805], [0.2126, 0.7152, 0.0722], [0.0193, 0.1192, 0.9505]]
    x, y, z = np.cbrt(np.array(matrix) @ linear / [0.9505, 1.0, 1.089])
    return np.array([116.0 * y - 16.0, 500.0 * (x - y), 200.0 * (y - z)])


@pytest.mark.parametrize(
    "modes",
    [
        ("stick", "slip_left", "slip_right", "open", "yield", "yield_left", "yield_right", "active", "active_left", "active_right"),
        ("stick", "slip", "open", "yield", "yield_slip"),
    ],
)
def test_modes_of_one_picture_can_be_told_apart(modes: tuple[bm.Mode, ...]) -> None:
    colors = {mode: lab(_figures.COLORS[bm.MODES.index(mode)]) for mode in modes}
    for one, other in itertools.combinations(modes, 2):
        assert np.linalg.norm(colors[one] - colors[other]) > 20.0, (one, other)


def test_energies_of_one_picture_can_be_told_apart(rocking) -> None:
    colors = {name: lab(color) for name, color in _figures.ENERGY_COLORS.items()}
    for one, other in itertools.combinations(colors, 2):
        assert np.linalg.norm(colors[one] - colors[other]) > 25.0, (one, other)
    runs = [rocking(friction).run(200, contact_every=10, warn=False) for friction in (0.2, 0.6)]
    left_out = {"input", "relative_input", "soil_error_bound", "largest", "residual"}
    assert set(runs[0].energy_balance.to_dict()) - left_out == colors.keys()
    # The modes of the first run stay, under its label.
    panels = runs[0].plot(label="rough")
    count = len(panels[1].collections)
    runs[1].plot(panels, label="rougher")
    assert len(panels[1].collections) == count == 1 and panels[1].get_title(loc="left") == "rough"


def basement() -> bm.Simulation:
    building = bm.WithWalls(bm.RigidBlock(6.0, 5.0, 1500.0), 3.0)
    elements = bm.Trench(-3.0, 3.0, 3.0).elements(4, 3)
    soil = bm.Soil.from_shear_wave_speed(200.0, poisson=0.35, density=1900.0)
    ground = bm.TrenchGround(soil, elements, pressure_at_rest=0.5)
    strength = bm.SoilStrength(np.radians(30.0), wall_friction_angle=np.radians(8.0))
    record = bm.el_centro_1940().padded(0.2, 0.0)
    laws = ground.interfaces(bm.Coulomb(0.5), [strength])
    return bm.Simulation(0.01, building, ground, laws, motion=bm.TrenchMotion(ground, record))


def test_wall_pressures_have_their_envelopes_and_limits(tmp_path: Path, rocking) -> None:
    simulation = basement()
    run = simulation.run(300, contact_every=75, motion_every=75, warn=False)
    left, right = run.plot_wall_pressures(simulation.interface, title="basement")
    assert left.get_title(loc="left") == "basement" and right.get_title(loc="left") == "right wall"
    for panel, elements in ((left, [2, 1, 0]), (right, [7, 8, 9])):
        lines = {line.get_label(): line for line in panel.lines}
        heights = run.heights[elements]
        assert (np.diff(heights[:, 0]) > 0.0).all()
        for name, text in (("static_pressure", "at rest"), ("lowest_pressure", "lowest"), ("highest_pressure", "highest")):
            np.testing.assert_allclose(lines[text].get_xdata(), 1e-3 * np.repeat(run.envelope[name][elements], 2))
            np.testing.assert_allclose(lines[text].get_ydata(), heights.ravel())
        active = [simulation.interface[element].pressures[0] for element in elements]
        np.testing.assert_allclose(lines["active"].get_xdata(), 1e-3 * np.repeat(active, 2))
    assert len(run.plot_wall_pressures()[0].lines) == 3
    with pytest.raises(bm.InputError, match="the run has no walls"):
        rocking().run(2, warn=False).plot_wall_pressures()
    run.report(tmp_path / "basement.html", simulation, height=5.0)
    assert "<h2>Earth pressures on the walls</h2>" in (tmp_path / "basement.html").read_text("utf-8")


def walled_raft() -> tuple[bm.Mesh, list[int], list[int]]:
    """A mat of 8 m × 8 m with a wall along x through its middle, and the shells of both."""
    mesh, line = bm.Mesh.in_space(), np.linspace(-4.0, 4.0, 5)
    x, y = np.meshgrid(line, line)
    mat = mesh.add_shells(mesh.add_grid(np.stack([x, y, 0.0 * x], axis=2)).cells, CONCRETE, 0.5)
    cells, upper = [], [mesh.add_node(float(place), 0.0, 3.0) for place in line]
    for k in range(4):
        cells.append([mesh.node_at(line[k], 0.0), mesh.node_at(line[k + 1], 0.0), upper[k + 1], upper[k]])
    return mesh, mat, mesh.add_shells(cells, CONCRETE, 0.3)


def test_walls_and_mats_are_drawn_from_the_front_and_in_space(tmp_path: Path) -> None:
    mesh, mat, wall = walled_raft()
    panel = mesh.plot_shells(wall, [1.0, 2.0, 3.0, 4.0], view="front")
    assert panel.get_ylabel() == "height, m" and panel.get_xlabel() == "x, m"
    paths = panel.collections[0].get_paths()
    np.testing.assert_allclose(paths[0].vertices[:4], [[-4.0, 0.0], [-2.0, 0.0], [-2.0, 3.0], [-4.0, 3.0]])
    with pytest.raises(bm.InputError, match="has no area in the view 'side'"):
        mesh.plot_shells(wall, [1.0] * 4, view="side")
    with pytest.raises(bm.InputError, match="stands upright: it has no area in plan, but in the view 'front'"):
        mesh.plot_shells(wall, [1.0] * 4)
    with pytest.raises(bm.InputError, match="view is 'top'"):
        mesh.plot_shells(wall, [1.0] * 4, view="top")  # type: ignore[arg-type]
    model = bm.FemModel(mesh)
    rng = np.random.default_rng(2)
    u = 1e-4 * rng.normal(size=model.dofs)
    space = model.plot_shell_moments(u)
    assert len(space.collections[0].get_paths()) == 20
    drawn = np.asarray(model.plot_shell_moments(u, mat, view="plan").collections[0].get_array())
    for element, value in zip(mat, drawn):
        moments = np.mean([point.moments for point in model.shell_resultants(element, u)], axis=0)
        principal = np.linalg.eigvalsh([[moments[0], moments[2]], [moments[2], moments[1]]])
        assert value == pytest.approx(1e-3 * principal[np.abs(principal).argmax()], rel=1e-9)
    ground = bm.ElasticGround.under(bm.Soil(80e6, 0.33, 1900.0), model, 4)
    motion = bm.triaxial(x=bm.el_centro_1940())
    simulation = bm.Simulation(0.01, model, ground, bm.Coulomb(0.5), motion=motion)
    run = simulation.run(40, motion_every=10, warn=False)
    run.report(tmp_path / "raft.html", simulation)
    assert "<h2>Bending moments of the shells at" in (tmp_path / "raft.html").read_text("utf-8")


def test_a_model_without_shells_says_so() -> None:
    with pytest.raises(bm.InputError, match="the model has no shells"):
        column = bm.FemModel(bm.Mesh.layered_block(0.0, 1.0, 1, [bm.Layer(1.0, 1, CONCRETE)]))
        column.plot_shell_moments(np.zeros(column.dofs))


def test_films_without_ffmpeg_are_gifs_and_pages(rocking, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    from matplotlib.animation import FFMpegWriter, writers

    run = rocking().run(100, contact_every=25, warn=False)
    monkeypatch.setattr(FFMpegWriter, "isAvailable", classmethod(lambda cls: False))
    assert not writers.is_available("ffmpeg")
    with pytest.raises(bm.InputError, match=r"needs the program ffmpeg, which is not installed.*run\.gif or .*run\.html"):
        run.animate().save(tmp_path / "run.mp4")
    assert not (tmp_path / "run.mp4").exists()
    run.animate().save(tmp_path / "run.html", dpi=50)
    page = (tmp_path / "run.html").read_text("utf-8")
    frames = re.search(r"const frames = \[(.*?)\]", page)
    assert frames is not None and frames[1].count('", "') + 1 == len(run.contact["time"])
    run.animate().save(tmp_path / "run.gif")
    assert (tmp_path / "run.gif").read_bytes().startswith(b"GIF8")
