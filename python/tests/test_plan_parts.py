"""GOAL: structures, laws, grounds and motions in plan that users give themselves, and what a run in plan gives back.
SCENE: blocks on springs, on soil, under records and waves.
REFERENCE: Winkler's closed forms, Newton's law for a sliding block, the package's own parts, the same scene turned.
"""

from __future__ import annotations

import math
import pickle
from types import SimpleNamespace

import numpy as np
import pytest

import basemat as bm

SOIL = bm.Soil(80e6, 0.25, 1900.0)
RECORD = bm.el_centro_1940()
BODY = bm.RigidBody.cuboid(6.0, 4.0, 8.0, 500.0)
THREE = bm.triaxial(RECORD, RECORD.scaled(0.8), RECORD.scaled(0.5))
GRAVITY = bm.STANDARD_GRAVITY
FLAT = bm.RigidBlock(6.0, 8.0, 500.0)
PLANE = bm.ElasticGround.under(SOIL, FLAT, 6)


def simulation(structure=BODY, law=None, motion=THREE, **others) -> bm.Simulation:
    ground = bm.SpringGround.under(structure, 4, 30e6, 20e6, dashpots=(4e5, 3e5))
    law = bm.Coulomb(0.25, tensile_strength=2e3) if law is None else law
    return bm.Simulation(0.01, structure, ground, law, motion=motion, **others)


def same(one: bm.Run, other: bm.Run, tolerance: float = 0.0) -> None:
    """All time series agree."""
    for name, values in one.series.items():
        size = np.nanmax(np.abs(values), initial=0.0, where=np.isfinite(values))
        np.testing.assert_allclose(values, other[name], rtol=0.0, atol=tolerance * size, err_msg=name)


@pytest.fixture(scope="module")
def run() -> bm.Run:
    found = simulation().run(400, contact_every=4)
    assert found.extremes("uplifted_area").magnitude > 1.0 and found.largest_slip.value > 1e-3
    return found


def faces(structure: bm.Structure) -> list[list[bm.BaseNode]]:
    base = structure.base()
    assert isinstance(base, bm.BaseFaces) and len(base) == len(list(base))
    return list(base)


class Rigid:
    """BODY by its matrices."""

    dofs = 6

    def base(self):
        corners = [(-3.0, -2.0), (3.0, -2.0), (3.0, 2.0), (-3.0, 2.0)]
        return bm.BaseFaces([bm.BaseNode.rigid_face(corners, (0.0, 0.0), [0, 1, 2, 3, 4, 5])])

    def mass(self):
        return BODY.mass()

    def stiffness(self):
        return np.zeros((6, 6))


@pytest.mark.parametrize("kind", ["faces", "user", "tensor", "reduced"])
def test_a_body_by_its_matrices_is_the_body(run: bm.Run, kind: str) -> None:
    mass, own = 500.0 * 6.0 * 4.0 * 8.0, Rigid()
    squares = np.array([6.0, 4.0, 8.0]) ** 2
    tensor = mass / 12.0 * np.diag(squares.sum() - squares)
    structure = {
        "faces": lambda: bm.MatrixModel(own.mass(), own.stiffness(), own.base()),
        "user": lambda: own,
        "tensor": lambda: bm.RigidBody.from_mass(
            [(-3.0, -2.0), (3.0, -2.0), (3.0, 2.0), (-3.0, 2.0)], mass, tensor.tolist(), (0.0, 0.0, 4.0)
        ),
        "reduced": lambda: bm.ReducedModel(own, 0),
    }[kind]()
    same(run, simulation(structure).run(400), 1e-9)


def test_faces_are_read_back() -> None:
    model = bm.MatrixModel(BODY.mass(), np.zeros((6, 6)), Rigid().base())
    [face], [other] = faces(model), faces(BODY)
    for one, two in zip(face, other):
        assert (one.x, one.y) == (two.x, two.y)
        assert (one.horizontal, one.across, one.vertical) == (two.horizontal, two.across, two.vertical)
    again = pickle.loads(pickle.dumps(face[1]))
    assert repr(again) == repr(face[1]) and again.across.terms == [(1, 1.0), (5, 3.0)]
    with pytest.raises(bm.InputError, match="weights"):
        corner = bm.BaseNode(0.0, np.ones(4), 2, across=1)
        bm.MatrixModel(np.eye(6), np.zeros((6, 6)), bm.BaseFaces([[corner, *face[1:]]]))


class Limited:
    """A law of the package by its limits, in Python."""

    friction_coefficient = 0.25

    def __init__(self, law: bm.InterfaceLaw) -> None:
        self.law = law

    def limits(self, start: bm.PreviousContact) -> bm.Limits:
        return self.law.limits(start)


class Worn(Limited):
    """Friction that falls with the way that an element has slid."""

    state_variables = 1

    def limits(self, start):
        return bm.Limits(0.25 * math.exp(-start.state_variables[0] / 0.01), tension=0.0 if start.has_opened else 2e3)

    def commit(self, start, end, mode):
        way = math.hypot(end.slip - start.slip, end.slip_across - start.slip_across)
        return [start.state_variables[0] + (way if mode == "slip" else 0.0)]


def test_own_laws_in_plan(run: bm.Run) -> None:
    same(run, simulation(law=Limited(bm.Coulomb(0.25, tensile_strength=2e3))).run(400))
    worn = simulation(law=Worn(bm.Bonded()))
    found = worn.run(400)
    assert found.energy_error < 1e-9
    assert found.largest_slip.value > 1.05 * run.largest_slip.value
    assert max(worn.state.state_variables(k)[0] for k in range(24)) > 1e-3


def test_limits_of_the_packages_laws() -> None:
    start = bm.PreviousContact(bm.ContactState(pressure=1e4), "stick", 0.01)
    assert bm.Coulomb(0.4, tensile_strength=3e3).limits(start) == bm.Limits(0.4, attraction=3e3, tension=3e3)
    assert bm.Coulomb(0.4).limits(bm.PreviousContact(bm.ContactState(gap=0.1), "open", 0.01)) == bm.Limits(0.4)
    assert bm.Yielding(2e5, 0.3).limits(start) == bm.Limits(0.3, pressure_cap=2e5)
    glued = bm.PreviousContact(bm.ContactState(pressure=1e4), "stick", 0.01, state_variables=[1.0])
    assert bm.Cohesive(1e3, 2e3, 0.3).limits(glued).shear_strength == 2e3
    bonded = bm.Bonded().limits(start)
    assert bonded.bonded and pickle.loads(pickle.dumps(bm.Limits(0.4))) == bm.Limits(0.4)


@pytest.mark.parametrize(
    ("call", "text"),
    [
        (lambda: bm.Simulation(0.01, FLAT, PLANE, object()), "object is no interface law: it has no method `limits`"),
        (lambda: bm.Simulation(0.01, FLAT, bm.ElasticGround.under(SOIL, BODY, 4), bm.Bonded()), "faces"),
        (lambda: bm.Simulation(0.01, BODY, PLANE, bm.Bonded()), "contact nodes"),
        (lambda: bm.Plan(3.0, 4), "faces: give a list of polygons"),
        (lambda: bm.MatrixModel(np.eye(6), np.eye(6), [1, 2]), "a list of BaseNode, a list of such lists, or"),
        (lambda: BODY.dof("x").relative_to_base(BODY), "not in the plane"),
        (lambda: simulation().state.value("tork"), "no quantity 'tork', only base_shear"),
    ],
)
def test_what_does_not_fit_is_said(call, text: str) -> None:
    with pytest.raises((bm.InputError, TypeError), match=text):
        call()


@pytest.mark.parametrize("entry", [float("nan"), 2, -1, 0.5, "True", None])
def test_a_mask_has_no_other_entries_than_true_and_false(entry: object) -> None:
    with pytest.raises(bm.InputError, match="True and False"):
        bm.Plan.masked((0.0, 0.0), (1.0, 1.0), [[True, entry], [1, 1.0]])
    for mask in (np.array([[True, False], [True, True]]), [[1, 0], [1.0, True]]):
        assert len(bm.Plan.masked((0.0, 0.0), (1.0, 1.0), mask)) == 3


def test_one_face_may_be_given_by_itself() -> None:
    [square] = bm_square(2.0)
    assert len(bm.Plan(square, 4)) == len(bm.Plan([square], 4)) == 16
    assert len(bm.Plan.masked((0.0, 0.0), (1.0, 1.0), np.eye(3, dtype=int))) == 3
    [face] = faces(BODY)
    model = bm.MatrixModel(BODY.mass(), np.zeros((6, 6)), bm.BaseFaces(face))
    assert len(faces(model)) == 1


class Raising(Limited):
    def limits(self, start):
        return 0.3


@pytest.mark.parametrize(
    ("law", "text"),
    [
        (Raising(bm.Bonded()), "limits of the interface law returned"),
        (SimpleNamespace(modes=["stick"], conditions=None, next_mode=None), "no method `limits`"),
        (SimpleNamespace(limits=lambda start: bm.Limits(-0.1)), "friction coefficient is -0.1"),
        (SimpleNamespace(limits=lambda start: 1 / 0), "division"),
    ],
)
def test_bad_laws_say_what_is_wrong(law: object, text: str) -> None:
    with pytest.raises((bm.Error, ZeroDivisionError), match=text):
        simulation(law=law).run(5)


def test_a_block_slides_by_newtons_law() -> None:
    """Constant acceleration along (3, 4) beyond friction on springs so stiff that they hardly show."""
    body = bm.RigidBody.cuboid(20.0, 20.0, 0.1, 2000.0)
    push = bm.Record(0.01, 2.0 * np.ones(101))
    ground = bm.SpringGround(bm.Plan(bm_square(10.0), 2), 1e11, 1e11)
    motion = bm.triaxial(push.scaled(0.6), push.scaled(0.8))
    state = bm.Simulation(0.001, body, ground, bm.Coulomb(0.1), motion=motion)
    run = state.run(1000, series=False)
    expected = -0.5 * (2.0 - 0.1 * GRAVITY)
    assert state.state.value("mean_slip") == pytest.approx(0.6 * expected, rel=1e-3)
    assert run.residual_slip_across == pytest.approx(0.8 * expected, rel=1e-3)
    state = state.state
    assert np.allclose(np.hypot(state.shear, state.shear_across), 0.1 * state.pressure, rtol=1e-9)
    assert state.slip_across == pytest.approx(np.full(4, 0.8 * expected), rel=1e-3)
    [foundation] = state.foundations
    assert foundation.mean_slip_across == pytest.approx(run.residual_slip_across)
    assert foundation.shear_across / foundation.shear == pytest.approx(4.0 / 3.0, rel=1e-6)


def bm_square(half: float) -> list[list[tuple[float, float]]]:
    return [[(half * x, half * y) for x, y in corner] for corner in [[(-1, -1), (1, -1), (1, 1), (-1, 1)]]]


def test_winklers_bed() -> None:
    """Settlement W/(k A); along y its own stiffness under a load on the base: H/(k A)."""
    plan = bm.Plan(bm_square(2.0), 4)
    ground = bm.SpringGround(plan, 40e6, 20e6, across_stiffness=10e6)
    # Its cells end with the mat, those of an elastic ground reach beyond.
    assert ground.elements.min() == -2.0 == ground.depths.min() and len(plan.without_overhang()) == 16
    assert bm.ElasticGround(SOIL, plan).elements.min() < -2.0
    body = bm.RigidBody.cuboid(4.0, 4.0, 2.0, 1000.0)
    loads = [bm.Load.constant(row, 1e4) for row in body.displacement_at(0.0, 0.0, 0.0)[:2]]
    own = bm.Simulation(
        0.01,
        body,
        ground,
        bm.Bonded(),
        loads=loads,
        initial=bm.InitialConditions(gravity_stage="frictional"),
    )
    x, y, z = own.static_displacement[:3]
    assert z == pytest.approx(-32e3 * GRAVITY / (40e6 * 16.0) + 0.0, rel=1e-9)
    assert (x, y) == pytest.approx((1e4 / (20e6 * 16.0), 1e4 / (10e6 * 16.0)), rel=1e-9)


def test_plans() -> None:
    plan = bm.Plan(bm_square(2.0), 8)
    assert plan.middle == [0.0, 0.0] and abs(plan.area_error) < 1e-12
    assert plan.pitch == pytest.approx([4.0 / (8.0 - 0.21)] * 2)
    united = plan.with_unions([1, 3, 3, 1], [1, 3, 3, 1])
    assert len(united) == 64 and len(bm.ElasticGround(SOIL, united).elements) == 16
    assert repr(pickle.loads(pickle.dumps(united))) == repr(united)
    corner = bm.Plan.masked((0.0, 0.0), (1.0, 2.0), [[True, True, True], [True, False, False]])
    assert len(corner) == 4 and corner.middle == [1.5, 2.0]
    with pytest.raises(bm.InputError, match="row"):
        bm.Plan.masked((0.0, 0.0), (1.0, 2.0), [[True, True, True], [True]])


def test_impedances_of_a_ground_in_plan_are_those_of_its_plan() -> None:
    plan = bm.Plan(bm_square(2.0), 4)
    found = bm.ElasticGround(SOIL, plan).impedances([0.0, 2.0])
    assert found.shape == (2, 6, 6) and np.array_equal(found, plan.impedances(SOIL, [0.0, 2.0]))


def test_storeys_are_those_of_a_shear_building() -> None:
    """Along one axis and without eccentricities, per metre of thickness, on springs."""
    storeys = [bm.Storey(3.0, 20e3, 20e6, rotary_inertia=2e5, damping=1e4)] * 2
    plane = bm.ShearBuilding(8.0, 64e3, 64e3 * 64.0 / 12.0, storeys)
    mat = bm.RigidBody.cuboid(8.0, 5.0, 1e-9, 64e3 / 8e-9)
    inertia = (1.0, 5.0 * 2e5, 1.0)
    floors = [bm.PlanStorey(3.0, 5 * 20e3, (8.0, 5.0), (5 * 20e6, 1e8, 1e9), inertia=inertia, damping=(5e4, 0, 0))]
    space = bm.StoreyBuilding(mat, floors * 2)
    assert space.total_mass == pytest.approx(5.0 * plane.total_mass)
    rows = [space.dof("x"), space.dof("z"), -space.dof("ry"), space.dof("floor_0_x"), space.dof("floor_1_x")]
    turn = np.array([row.weights(space.dofs) for row in rows])
    for name in ("mass", "stiffness", "damping"):
        found = turn @ getattr(space, name)() @ turn.T
        np.testing.assert_allclose(found, 5.0 * getattr(plane, name)(), rtol=1e-8, atol=1e-3, err_msg=name)
    assert space.drift(1)[0].terms == [(9, 1.0), (6, -1.0), (4, -3.0)]
    assert space.total_drift(1)[0].terms == [(9, 1.0), (0, -1.0), (4, -6.0)]
    assert space.floor(0, (0.0, 2.0))[0].terms == [(6, 1.0), (8, -2.0)]
    assert space.drift(0, (1.0, 0.0))[1].value(np.arange(12.0)) == 7.0 + 8.0 - 1.0 - 5.0 + 3.0 * 3.0
    assert [own.unit for own in space.shear(0)] == ["N", "N", "N·m"]
    with pytest.raises(bm.InputError, match="twist"):
        bm.StoreyBuilding(mat, floors, laws={(0, "z"): bm.Bilinear(1e7, 1e5, 0.1)})
    again = pickle.loads(pickle.dumps(space))
    assert again.dof_names == space.dof_names and repr(again) == repr(space)


def test_springs_damping_and_shear_in_plan() -> None:
    """The lowest shear by the inertia above is that of the springs below."""
    mat = bm.RigidBody.cuboid(6.0, 4.0, 1.0, 2400.0)
    floor = bm.PlanStorey(3.0, 60e3, (6.0, 4.0), (4e7, 3e7, 4e8), stiffness_center=(-1.0, 0.5))
    building = bm.StoreyBuilding(mat, [floor] * 2)
    probes = [bm.Probe.section(name, own) for name, own in zip(("Vx", "Vy", "T"), building.shear(0))]
    springs = zip(("dx", "dy", "dt"), building.drift(0))
    probes += [bm.Probe.displacement(name, row) for name, row in springs]
    run = simulation(building, bm.Bonded(), probes=probes).run(300, warn=False)
    for force, drift, stiffness in (("Vx", "dx", 4e7), ("Vy", "dy", 3e7), ("T", "dt", 4e8)):
        # With the midpoint rule inertia is that of the middle of the step.
        expected = stiffness * 0.5 * (run[drift][1:] + run[drift][:-1])
        np.testing.assert_allclose(run[force][1:], expected, atol=1e-6 * np.abs(expected).max())
    braced = bm.WithSprings(building, [(building.drift(0)[0], bm.Bilinear(4e7, 1e5, 0.1))])
    damped = bm.WithModalDamping(braced, [0.05], fixed_base=True)
    assert simulation(damped).run(50).energy_error < 1e-9 and len(faces(damped)) == 1


def test_waves_turn_with_their_azimuth(run: bm.Run) -> None:
    along = bm.travelling_wave(bm.triaxial(RECORD), 500.0, -3.0)
    away = bm.travelling_wave(bm.triaxial(RECORD), 500.0, -3.0, azimuth=0.5 * math.pi)
    right = along.displacement_at(1.0, 0.0, 4.0)
    assert right == pytest.approx(along.displacement(1.0, 4.0)[:1] + [0.0, 0.0])
    assert away.displacement_at(0.0, 1.0, 4.0) == pytest.approx([0.0, right[0], 0.0], abs=1e-15)
    wave = bm.PlaneWave.sh(SOIL, 0.5)
    across = wave.field_from_across(RECORD, -3.0, azimuth=0.3)
    x, y, up = across.displacement_at(-3.0 * math.cos(0.3), -3.0 * math.sin(0.3), 4.0)
    assert math.hypot(x, y) == pytest.approx(abs(np.interp(4.0, RECORD.times, RECORD.displacements)), rel=1e-3)
    assert up == 0.0 and x / y == pytest.approx(-math.tan(0.3))
    assert wave.apparent_velocity == pytest.approx(SOIL.shear_wave_speed / math.sin(0.5))
    again = pickle.loads(pickle.dumps([across, THREE]))
    assert again[0].displacement_at(1.0, 2.0, 3.0) == across.displacement_at(1.0, 2.0, 3.0)
    function = bm.free_field(displacement_at=lambda x, y, time: THREE.displacement_at(x, y, time))
    same(run, simulation(motion=function).run(400))
    with pytest.raises(bm.InputError, match="three numbers"):
        bm.free_field(displacement_at=lambda x, y, time: (0.0, 1.0)).displacement_at(0.0, 0.0, 1.0)


def test_sites_in_plan() -> None:
    layer = bm.SoilLayer(bm.Soil(60e6, 0.3, 1800.0), 10.0, bm.DampingLaw.constant_q(0.05))
    profile = bm.SoilProfile([layer], bm.Soil(500e6, 0.25, 2200.0))
    x, y, up = bm.SoilColumn.surface_in_plan(profile, RECORD, up=RECORD.scaled(0.5))
    assert y is None and x is not None and up is not None
    with pytest.warns(bm.BasematWarning):
        single = bm.SoilColumn(profile).to_surface(RECORD)
    np.testing.assert_allclose(x.accelerations[: len(single)], single.accelerations, atol=1e-6)
    assert up.peak_acceleration > 0.5 * RECORD.peak_acceleration


def test_results_in_plan(run: bm.Run) -> None:
    assert run.in_plan and run.units["base_shear"] == "N" and run.units["torque"] == "N·m"
    assert run.contact["slip_across"].shape == run.contact["gap"].shape == (101, 24)
    envelope = run.envelope
    assert set(envelope) > {"front", "back", "shear_across", "slip_across"}
    area = ((envelope["right"] - envelope["left"]) * (envelope["back"] - envelope["front"])).sum()
    assert area == pytest.approx(24.0)
    frame = run.contact_frame()
    assert frame.attrs["units"]["y"] == frame.attrs["units"]["slip_across"] == "m"
    assert len(frame) == 101 * 24 and frame["y"].nunique() == 4 and frame["x"].nunique() == 6
    # Resultants of the snapshots are those of the time series.
    cell = area / 24.0
    last = frame[frame["time"] == frame["time"].max()]
    for column, name in (("shear", "base_shear"), ("shear_across", "shear_across"), ("pressure", "normal_force")):
        assert cell * last[column].sum() == pytest.approx(run[name][-1], rel=1e-9)
    torque = (last["x"] * last["shear_across"] - last["y"] * last["shear"]).sum() * cell
    assert torque == pytest.approx(run["torque"][-1], rel=1e-6)
    whole = run.foundation_frame()
    assert whole.attrs["units"]["torque"] == "N·m" and whole["torque"][0] == run.extremes("torque").largest.value
    assert run.energy_frame().attrs["units"]["input"] == "J"
    assert pickle.loads(pickle.dumps(run)).extremes("twist") == run.extremes("twist")


def test_pictures_in_plan(run: bm.Run, rocking) -> None:
    pytest.importorskip("matplotlib").use("agg")
    axes = run.plot_contact_plan(time=2.0)
    cells, arrows = axes.collections[:2]
    frame = int(np.argmin(np.abs(run.contact["time"] - 2.0)))
    shown, mode = np.ma.asarray(cells.get_array()), run.contact["mode"][frame]
    np.testing.assert_array_equal(np.ma.getmaskarray(shown), mode == bm.MODES.index("open"))
    np.testing.assert_allclose(shown.data, 1e-3 * run.contact["pressure"][frame])
    np.testing.assert_array_equal(~np.broadcast_to(arrows.Umask, mode.shape), mode == bm.MODES.index("slip"))
    sliding = mode == bm.MODES.index("slip")
    shears = [run.contact[name][frame][sliding] for name in ("shear", "shear_across")]
    np.testing.assert_allclose(np.arctan2(*shears), np.arctan2(arrows.U[sliding], arrows.V[sliding]))
    assert axes.get_xlabel() == "x, m" and axes.get_ylabel() == "y, m"
    stack = run.plot_modes()
    top = max(path.vertices[:, 1].max() for own in stack.collections for path in own.get_paths())
    assert top == pytest.approx(24.0) and stack.get_ylabel() == "area of the elements, m²"
    labels = [own.get_ylabel() for own in run.plot()]
    assert labels[0] == "base shear, kN" and labels[-1] == "energy, kJ"
    moving = run.animate()
    moving._func(3)
    moving._draw_was_started = True
    with pytest.raises(bm.InputError, match="plan"):
        rocking().run(20, contact_every=5).plot_contact_plan()
