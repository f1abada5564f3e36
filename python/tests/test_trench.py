"""GOAL: structures with walls in the ground, in the plane, from Python: input motion, springs, runs, forces on each face.
SCENE: rigid blocks, a shear building and walls that bend in trenches, in a half-plane and in layers, at rest and under
El Centro, vertically and along the surface.
REFERENCE: the crate's table of kinematic motions (finite and boundary elements), K₀ρgd²/2 and cantilevers by hand, mirrored
scenes, the Rust crate bit by bit, the states of the same run.
"""

from __future__ import annotations

import pickle
from pathlib import Path

import numpy as np
import pytest
from conftest import same_bits
from test_bits import rusts

import basemat as bm

SOIL = bm.Soil.from_shear_wave_speed(200.0, 0.33, 1900.0)
TABLE = Path(__file__).parents[2] / "tests" / "data" / "embedded" / "kinematic_embedded_nu0333.csv"
ELEMENTS = bm.Trench(-6.0, 6.0, 5.0).elements(2, 2)
BLOCK = bm.RigidBlock(12.0, 20.0, 900.0)
RECORD = bm.el_centro_1940().padded(0.2, 0.0)
FACES = ("left_wall", "base", "right_wall")


def scene(friction: float = 0.3, ground: bm.TrenchGround | None = None, **others: object) -> bm.Simulation:
    ground = bm.TrenchGround(SOIL, ELEMENTS, pressure_at_rest=0.5) if ground is None else ground
    laws = ELEMENTS.interfaces(bm.Coulomb(0.5), bm.Coulomb(friction))
    motion = bm.TrenchMotion(ground, RECORD)
    parts = {"structure": bm.WithWalls(BLOCK, 5.0), "interface": laws, "motion": motion, **others}
    return bm.Simulation(0.02, ground=ground, **parts)  # type: ignore[arg-type]


@pytest.fixture(scope="module")
def run() -> tuple[bm.Run, list[list[bm.FaceForces]]]:
    """A run, and the forces on the faces at its steps."""
    simulation, states = scene(), []
    states.append([simulation.state.face(name) for name in FACES])  # type: ignore[arg-type]
    found = simulation.run(
        300, contact_every=1, observe=lambda state: states.append([state.face(name) for name in FACES])
    )
    return found, states


@pytest.mark.skipif(not TABLE.is_file(), reason="the files of the crate's tests are not here")
def test_kinematic_motions_match_the_table() -> None:
    rows = np.loadtxt(TABLE, delimiter=",", skiprows=2)
    ground = bm.TrenchGround(bm.Soil(1.0, 1.0 / 3.0, 1.0), bm.Trench(-1.0, 1.0, 1.0).elements(8, 6))
    found = ground.kinematic_motions(rows[:, 1] / (2.0 * np.pi))
    horizontal, rotation = rows[:, 2] + 1j * rows[:, 3], rows[:, 4] + 1j * rows[:, 5]
    # The discretization's error, as in Rust, and at the higher frequencies twice as much.
    limit = np.where(rows[:, 1] <= 2.0, 1.5e-3, 3e-3) * np.abs(horizontal[1])
    assert (np.abs(found.horizontal - horizontal) < limit).all()
    assert (np.abs(found.rotation - rotation) < limit).all()
    # Walls pull the base along with the waves above it.
    assert abs(abs(found.vertical[3]) - np.cos(0.5)) < 0.1
    frame = found.to_frame()
    assert frame.attrs["units"] == {"frequency": "Hz", "horizontal": "", "rotation": "1/m", "vertical": ""}
    again = pickle.loads(pickle.dumps(found))
    assert np.array_equal(again.rotation, found.rotation) and again.horizontal.dtype == complex


def test_walls_stiffen_and_backfill_softens() -> None:
    elements = bm.Trench(-6.0, 6.0, 6.0).elements(4, 3)
    flat = bm.ElasticGround(SOIL, bm.Strip(-6.0, 6.0, 8)).impedances([3.0])
    own = bm.TrenchGround(SOIL, elements).impedances([3.0])
    loose = bm.Soil(SOIL.shear_modulus / 4.0, 0.33, 1900.0)
    filled = bm.TrenchGround(SOIL, elements, backfill=(3.0, loose))
    damped = bm.TrenchGround(SOIL, elements, backfill=(3.0, loose, bm.DampingLaw.constant_q(0.1)))
    same = bm.TrenchGround(SOIL, elements, backfill=(3.0, SOIL))
    assert own.rocking[0].imag > 5.0 * flat.rocking[0].imag and own.horizontal[0].imag > 2.0 * flat.horizontal[0].imag
    softer = filled.impedances([3.0])
    assert softer.rocking[0].real < 0.8 * own.rocking[0].real
    assert damped.impedances([3.0]).rocking[0] != softer.rocking[0]
    assert same.impedances([3.0]).rocking[0] == pytest.approx(own.rocking[0], rel=1e-4)
    with pytest.raises(bm.InputError, match="backfill"):
        filled.kinematic_motions([1.0])
    with pytest.raises(bm.InputError, match="backfill"):
        bm.TrenchMotion(filled, RECORD)


def test_places_of_elements_and_nodes() -> None:
    ground = bm.TrenchGround(SOIL, ELEMENTS)
    assert len(ELEMENTS) == 6 and len(ground.elements) == 6
    assert ground.elements[[0, 1, 4, 5]].tolist() == [[-6.0, -6.0]] * 2 + [[6.0, 6.0]] * 2
    np.testing.assert_allclose(ground.heights, [[-2.5, 0.0], [-5.0, -2.5], [-5.0] * 2, [-5.0] * 2, [-5.0, -2.5], [-2.5, 0.0]])
    assert not bm.ElasticGround(SOIL, bm.Strip(-1.0, 1.0, 2)).heights.any()
    assert bm.Trench(-6.0, 6.0, 5.0).sides == [-6.0, 6.0] and bm.Trench(-6.0, 6.0, 5.0).depth == 5.0
    base, walls = bm.Coulomb(0.5), bm.Coulomb(0.3)
    laws = ELEMENTS.interfaces(base, walls)
    assert [law is base for law in laws] == [False, False, True, True, False, False]
    inside = bm.WithWalls(BLOCK, 5.0)
    [nodes] = inside.base()
    assert [(node.x, node.z) for node in nodes] == [(-6.0, 0.0), (-6.0, -5.0), (6.0, -5.0), (6.0, 0.0)]
    # The upper end of a wall moves by u_x − 5 θ.
    assert nodes[0].horizontal.value([0.0, 0.0, 1.0]) == pytest.approx(-5.0)
    assert inside.dof_names == ["x", "y", "rotation"] and inside.depth == 5.0
    assert repr(bm.BaseNode(1.0, 0, 1, z=-2.0)).endswith("z=-2.0)")
    # The same base by its nodes.
    model = bm.MatrixModel(BLOCK.mass(), np.zeros((3, 3)), [nodes])
    assert scene(structure=model).state.face("left_wall").thrust == scene().state.face("left_wall").thrust
    shape = bm.DeformedShape(inside, height=20.0)
    assert shape.points[:, 1].tolist() == [-5.0, -5.0, 15.0, 15.0]


def test_rest_by_hand() -> None:
    wall = scene().state.face("left_wall")
    assert wall.thrust == pytest.approx(0.5 * 0.5 * 1900.0 * bm.STANDARD_GRAVITY * 25.0, rel=1e-12)
    assert (wall.shear, wall.open_fraction) == (0.0, 0.0)
    # The pressure grows with depth: a third of the height, whatever the elements.
    assert wall.place == pytest.approx(5.0 / 3.0, rel=1e-12)
    base = scene().state.face("base")
    assert base.thrust == pytest.approx(12.0 * 20.0 * 900.0 * bm.STANDARD_GRAVITY, rel=1e-9)
    again = pickle.loads(pickle.dumps(wall))
    assert (again.thrust, again.place) == (wall.thrust, wall.place)
    # Without the ratio each soil has its own ν/(1 − ν).
    own = scene(ground=bm.TrenchGround(SOIL, ELEMENTS)).state.face("right_wall").thrust
    assert own / wall.thrust == pytest.approx(2.0 * 0.33 / 0.67, rel=1e-12)


def test_histories_of_the_faces_are_those_of_the_states(run: tuple[bm.Run, list[list[bm.FaceForces]]]) -> None:
    found, states = run
    assert found.energy_error < 1e-9 and list(found.faces) == list(FACES)
    for number, name in enumerate(FACES):
        face = found.faces[name]
        assert same_bits(face["time"], found.contact["time"])
        for key in ("thrust", "shear", "place", "open_fraction"):
            assert same_bits(face[key], np.array([getattr(own[number], key) for own in states])), (name, key)
    # It shook: walls pressed, opened, and slid.
    left = found.faces["left_wall"]
    assert left["thrust"].max() > 1.5 * left["thrust"][0] and left["open_fraction"].max() > 0.0
    assert np.isnan(left["place"][left["open_fraction"] == 1.0]).all() and np.ptp(left["shear"]) > 0.0
    frame = found.contact_frame()
    assert frame["z"][:6].tolist() == pytest.approx([-1.25, -3.75, -5.0, -5.0, -3.75, -1.25])
    assert np.array_equal(found.heights, bm.TrenchGround(SOIL, ELEMENTS).heights)
    again = pickle.loads(pickle.dumps(found))
    assert same_bits(again.faces["right_wall"]["thrust"], found.faces["right_wall"]["thrust"])


def test_limits_of_wall_pressure() -> None:
    """Rankine's limits by hand; a wall without them is named, a wall with them keeps them."""
    sand = bm.SoilStrength(np.radians(30.0))
    assert sand.pressure_ratios == pytest.approx([1.0 / 3.0, 3.0], rel=1e-12)
    assert sand.pressures(3.0e4) == pytest.approx([1.0e4, 9.0e4], rel=1e-12)
    clay = bm.SoilStrength(np.radians(20.0), cohesion=5.0e3, wall_friction_angle=0.1)
    assert clay.pressures(0.0)[0] < 0.0 and pickle.loads(pickle.dumps(clay)) == clay
    ground = bm.TrenchGround(SOIL, ELEMENTS, pressure_at_rest=0.5)
    laws = ground.interfaces(bm.Coulomb(0.5), sand)
    # Walls of two elements from 0 to 2.5 and 5 m, a base of two.
    unit_weight = 1900.0 * bm.STANDARD_GRAVITY
    for law, depth in zip((laws[0], laws[1], laws[4], laws[5]), (1.25, 3.75, 3.75, 1.25)):
        assert isinstance(law, bm.EarthPressure)
        assert law.pressures == pytest.approx([unit_weight * depth / 3.0, 3.0 * unit_weight * depth], rel=1e-12)
        assert pickle.loads(pickle.dumps(law)).pressures == law.pressures
    assert isinstance(laws[2], bm.Coulomb) and laws[0].modes == ["slip_right", "active_right", "yield_right"]
    strong = bm.TrenchMotion(ground, RECORD.scaled(3.0))
    kept, warned = scene(ground=ground, interface=laws, motion=strong), scene(ground=ground, motion=strong)
    run, other = (own.run(200, contact_every=1) for own in (kept, warned))
    assert run.energy_error < 1e-9
    passive = np.array([law.pressures[1] for law in (laws[0], laws[1], laws[4], laws[5])])
    pressures = run.contact["pressure"][:, [0, 1, 4, 5]]
    assert np.all(pressures <= passive * (1.0 + 1e-9)) and np.any(pressures > passive * (1.0 - 1e-9))
    assert {"active_right", "yield_right"} <= {bm.MODES[mode] for mode in np.unique(run.contact["mode"])}
    assert not any("soil of 45°" in str(own) for own in run.warnings)
    assert any("soil of 45°" in str(own) for own in other.warnings)
    low = bm.TrenchGround(SOIL, ELEMENTS, pressure_at_rest=0.2)
    with pytest.raises(bm.InputError, match="pressure at rest"):
        low.interfaces(bm.Coulomb(0.5), sand)
    with pytest.raises(bm.InputError, match="list of soil strengths"):
        ground.interfaces(bm.Coulomb(0.5), [sand, sand])


def test_a_base_without_walls_has_one_face(rocking) -> None:
    simulation = rocking()
    found = simulation.run(50, contact_every=5)
    assert list(found.faces) == ["base"] and simulation.state.face("left_wall").thrust == 0.0
    np.testing.assert_allclose(found.faces["base"]["thrust"], found["normal_force"][::5], rtol=1e-12)
    np.testing.assert_allclose(found.faces["base"]["shear"], found["base_shear"][::5], rtol=1e-9, atol=1e-3)
    with pytest.raises(bm.InputError, match="contact_every"):
        rocking().run(2).faces
    assert "z" not in found.contact_frame()


@pytest.mark.filterwarnings("ignore::basemat.BasematWarning")
def test_rusts_bits(reference: Path) -> None:
    rust = rusts(reference, "basement", "0.3", "300")
    found = scene().run(300, contact_every=1)
    columns = [*found.series.values()]
    columns += [found.faces[name][key] for name in ("left_wall", "right_wall") for key in ("thrust", "place")]
    columns.append(found.energy_balances["input"])
    assert rust.shape == (301, len(columns))
    for number, column in enumerate(columns):
        assert same_bits(column, np.ascontiguousarray(rust[:, number])), number


@pytest.mark.parametrize("history", ["auto", "direct"])
def test_pickling(history: str) -> None:
    ground = bm.TrenchGround(SOIL, ELEMENTS, pressure_at_rest=0.4, history=history, kernels=bm.SharedKernels())
    parts = (ground, bm.WithWalls(BLOCK, 5.0), bm.TrenchMotion(ground, RECORD), ELEMENTS, bm.Trench(-1.0, 2.0, 3.0))
    for part in parts:
        again = pickle.loads(pickle.dumps(part))
        assert type(again) is type(part) and repr(again) == repr(part)
    copies = pickle.loads(pickle.dumps(parts[:3]))
    laws = pickle.loads(pickle.dumps(ELEMENTS)).interfaces(bm.Coulomb(0.5), bm.Coulomb(0.3))
    runs = [
        bm.Simulation(0.02, structure, own, laws, motion=motion).run(80)["base_shear"]
        for own, structure, motion in (parts[:3], copies)
    ]
    assert same_bits(*runs) and np.abs(runs[0]).max() > 1e3


def test_walls_that_bend_are_cantilevers_at_rest() -> None:
    thickness, young, count, depth = 0.4, 31.0e9, 20, 5.0
    places = [(-6.0, -depth * k / count) for k in range(count)] + [(6.0 * (k / 3 - 1), -depth) for k in range(6)]
    places += [(6.0, -depth * k / count) for k in range(count, -1, -1)]
    mesh = bm.Mesh(places)
    outline = list(range(len(places)))
    stiffness = thickness**3 / 12.0
    mesh.add_beams(np.transpose([outline[:-1], outline[1:]]), young, thickness, stiffness, 2500.0)
    slab = outline[count : count + 7]
    # The slab is rigid.
    model = bm.FemModel(mesh, outline, in_trench=True, rigid_links=[(slab[3], slab[:3] + slab[4:])])
    assert [node.z for node in model.base()[0]][:: count + 3] == [0.0, -depth, 0.0]
    elements = bm.Trench(-6.0, 6.0, depth).elements(4, 8)
    ground = bm.TrenchGround(SOIL, elements, pressure_at_rest=0.5)
    laws = elements.interfaces(bm.Coulomb(0.5), bm.Coulomb(0.3))
    simulation = bm.Simulation(0.02, model, ground, laws, motion=bm.TrenchMotion(ground, RECORD))
    rows = [model.row(node, "x") for node in (outline[0], outline[-1], slab[3])]
    left, right, base = (row.value(simulation.static_displacement) for row in rows)
    # A load q at the height s bends the tip of a cantilever of height h by q s² (3h − s)/(6EI); K₀ ρ g (h − s) on all of it.
    smooth = 0.5 * 1900.0 * bm.STANDARD_GRAVITY * depth**5 / (30.0 * young * stiffness)
    assert left - base == pytest.approx(smooth, rel=0.03) and right - base == pytest.approx(base - left, rel=1e-9)
    run = simulation.run(100)
    assert run.energy_error < 1e-9 and run.extremes("base_shear").magnitude > 1e4
    again = pickle.loads(pickle.dumps(model))
    assert np.array_equal(again.stiffness(), model.stiffness())
    for contact in (None, [outline], outline[::-1]):
        with pytest.raises(bm.InputError, match="outline"):
            bm.FemModel(mesh, contact, in_trench=True)


def test_waves_along_the_surface() -> None:
    ground = bm.TrenchGround(SOIL, ELEMENTS, pressure_at_rest=0.5)
    # Rest on both sides: the fields of waves fade there.
    record = bm.el_centro_1940().padded(1.0, 2.0)
    steps = 300

    def shaken(motion: bm.FreeField) -> bm.Run:
        return scene(ground=ground, motion=motion).run(steps, contact_every=1)

    # A vertical wave has no velocity along the surface.
    plane = bm.PlaneWave.sv(SOIL, 0.0).field_from_horizontal(record, 0.0)
    vertical = shaken(bm.TrenchMotion.travelling(ground, plane))["base_shear"]
    wanted = shaken(bm.TrenchMotion(ground, record))["base_shear"]
    np.testing.assert_allclose(vertical, wanted, rtol=0.0, atol=2e-3 * np.abs(wanted).max())
    # A wave from the other side, that moves the other way, is the mirror image.
    rayleigh = bm.PlaneWave.rayleigh(SOIL)
    right = bm.TrenchMotion.travelling(ground, rayleigh.field_from_horizontal(record, -6.0))
    left = bm.TrenchMotion.travelling(ground, rayleigh.reversed().field_from_horizontal(record.scaled(-1.0), 6.0))
    one, other = shaken(right), shaken(left)
    largest = np.abs(one["base_shear"]).max()
    np.testing.assert_allclose(other["base_shear"], -one["base_shear"], rtol=0.0, atol=1e-6 * largest)
    np.testing.assert_allclose(
        other.faces["left_wall"]["thrust"], one.faces["right_wall"]["thrust"], rtol=0.0, atol=1e-6 * largest
    )
    # It comes later to places on its way, and rocks the block.
    speed = rayleigh.apparent_velocity
    assert right.displacement(4.0, 3.0)[0] == pytest.approx(right.displacement(-6.0, 3.0 - 10.0 / speed)[0], rel=1e-9)
    assert np.abs(one["base_rotation"] - one["base_rotation"][0]).max() > 0.0
    again = pickle.loads(pickle.dumps(right))
    assert again.displacement(0.0, 3.0) == right.displacement(0.0, 3.0)
    assert repr(right).startswith("TrenchMotion.travelling(")
    layered = bm.SoilProfile([bm.SoilLayer(SOIL, 8.0)], bm.Soil.from_shear_wave_speed(600.0, 0.3, 2200.0))
    inclined = bm.InclinedWave.sv(layered, 0.3).field(record, -6.0)
    inside = bm.TrenchMotion.travelling(bm.TrenchGround(layered, ELEMENTS), inclined)
    assert inside.displacement(0.0, 3.0)[1] != 0.0
    for wave in (record, bm.ricker(0.1, 0.2, 1.0), bm.TrenchMotion(ground, record)):
        with pytest.raises(bm.InputError, match="along the surface"):
            bm.TrenchMotion.travelling(ground, wave)
    with pytest.raises(bm.InputError, match="along y"):
        bm.TrenchMotion.travelling(ground, bm.PlaneWave.sh(SOIL, 0.3).field_from_across(record, 0.0))
    with pytest.raises(bm.InputError, match="slower|velocity"):
        bm.TrenchMotion.travelling(ground, bm.travelling_wave(record, 50.0, 0.0))


def test_a_checkpoint_resumes_to_the_same_bits() -> None:
    simulation = scene()
    simulation.run(60)
    checkpoint = pickle.loads(pickle.dumps(simulation.checkpoint()))
    expected = simulation.run(60)["base_moment"]
    other = scene()
    other.resume(checkpoint)
    assert same_bits(other.run(60)["base_moment"], expected)


def test_pictures_of_walls_lie_along_the_base(run: tuple[bm.Run, list[list[bm.FaceForces]]]) -> None:
    pytest.importorskip("matplotlib").use("agg")
    from basemat._plots import along

    left, right = along(run[0])
    np.testing.assert_allclose(left, [-11.0, -8.5, -6.0, 0.0, 6.0, 8.5], atol=1e-12)
    np.testing.assert_allclose(right, [-8.5, -6.0, 0.0, 6.0, 8.5, 11.0], atol=1e-12)
    axes = run[0].plot_modes()
    assert axes.get_ylim() == pytest.approx((-11.0, 11.0))


def test_errors() -> None:
    trench = bm.Trench(-6.0, 6.0, 5.0)
    for refused, words in (
        (lambda: bm.Trench(6.0, -6.0, 5.0), "width of a trench"),
        (lambda: bm.Trench(-6.0, 6.0, -1.0), "depth of a trench"),
        (lambda: trench.elements(3, 2), "base elements of a trench"),
        (lambda: trench.elements(4, 0), "wall elements of a trench"),
        (lambda: bm.TrenchGround(bm.SoilProfile([bm.SoilLayer(SOIL, 4.0)]), ELEMENTS), "above rigid bedrock"),
        (lambda: bm.TrenchGround(SOIL, ELEMENTS, pressure_at_rest=-0.1), "pressure at rest"),
        (lambda: bm.TrenchGround(SOIL, ELEMENTS, backfill=(0.0, SOIL)), "width of the backfill"),
        (lambda: bm.TrenchGround(SOIL, ELEMENTS).impedances([0.0]), "above zero"),
        (lambda: bm.TrenchMotion(bm.TrenchGround(SOIL, ELEMENTS)), "record"),
        (lambda: bm.WithWalls(BLOCK, 0.0), "depth of the base"),
        (lambda: bm.WithWalls(bm.WithWalls(BLOCK, 5.0), 5.0), "on the surface"),
        (lambda: scene(motion=RECORD), "TrenchMotion"),
        (lambda: scene().state.face("roof"), "face is 'roof', but must be 'left_wall' or 'base' or 'right_wall'"),  # type: ignore[arg-type]
    ):
        with pytest.raises(bm.InputError, match=words):
            refused()
    for wrong in (3.0, (1.0,), (1.0, BLOCK), (1.0, SOIL, SOIL)):
        with pytest.raises(TypeError, match="a tuple"):
            bm.TrenchGround(SOIL, ELEMENTS, backfill=wrong)  # type: ignore[arg-type]
