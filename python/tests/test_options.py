"""Every option reaches the simulation."""

from __future__ import annotations

import pickle
import re

import numpy as np
import pytest
from conftest import same_bits

import basemat as bm

BLOCK = bm.RigidBlock(4.0, 2.0, 2000.0)
MASS = 16.0e3
STIFFNESS = 5.0e7
OMEGA = np.sqrt(4.0 * STIFFNESS / MASS)
UP = bm.RigidBlock.VERTICAL


def bouncing(ground: bm.Ground | None = None, **options: object) -> bm.Simulation:
    """A bonded block on springs; a probe reads its vertical displacement."""
    ground = bm.SpringGround.under(BLOCK, 4, STIFFNESS, STIFFNESS) if ground is None else ground
    options.setdefault("probes", [bm.Probe.displacement("up", UP)])
    return bm.Simulation(1e-4, BLOCK, ground, bm.Bonded(), **options)


def test_initial_velocity_and_dashpots() -> None:
    """e^(−ζωt) sin(ω_d t) v₀/ω_d."""
    ratio, velocity = 0.1, 0.01
    coefficient = 2.0 * ratio * OMEGA * MASS / 4.0
    ground = bm.SpringGround.under(
        BLOCK, 4, STIFFNESS, STIFFNESS, dashpots=(coefficient, coefficient)
    )
    run = bouncing(ground, initial=bm.InitialConditions(velocity=[0.0, velocity, 0.0])).run(2000)
    damped = OMEGA * np.sqrt(1.0 - ratio**2)
    time = run.time
    expected = np.exp(-ratio * OMEGA * time) * np.sin(damped * time) * velocity / damped
    np.testing.assert_allclose(run["up"], expected, rtol=0.0, atol=3e-3 * expected.max())


def test_initial_displacement_unloaded_and_gravity() -> None:
    """Dropped, it swings about its settlement; let go from a height, it falls freely first."""
    fallen = bouncing(initial=bm.InitialConditions(gravity=10.0, gravity_stage="unloaded")).run(2000)
    settlement = MASS * 10.0 / (4.0 * STIFFNESS)
    expected = -settlement * (1.0 - np.cos(OMEGA * fallen.time))
    np.testing.assert_allclose(fallen["up"], expected, rtol=0.0, atol=5e-3 * settlement)
    lifted = bm.Simulation(
        1e-3,
        BLOCK,
        bm.SpringGround.under(BLOCK, 4, STIFFNESS, STIFFNESS),
        bm.Coulomb(0.5),
        initial=bm.InitialConditions(gravity=10.0, gravity_stage="unloaded", displacement=[0.0, 0.02, 0.0]),
        probes=[bm.Probe.displacement("up", UP)],
    ).run(60)
    assert lifted.normal_force.magnitude == 0.0
    np.testing.assert_allclose(lifted["up"], 0.02 - 5.0 * lifted.time**2, rtol=0.0, atol=1e-9)
    standing = bouncing(initial=bm.InitialConditions(gravity=10.0))
    assert standing.static_displacement[UP] == pytest.approx(-settlement)
    assert standing.state.normal_force == pytest.approx(MASS * 10.0)
    assert standing.run(10)["up"] == pytest.approx(0.0, abs=1e-12)


def test_loads() -> None:
    """A table, a record and a function of the same values; a constant load is static."""
    times, forces = [0.0, 0.05, 0.1], [0.0, 2.0e4, 0.0]
    record = bm.Record(0.05, [0.0, 2.0, 0.0])
    loads = [
        bm.Load.table(UP, times, forces),
        bm.Load.record(UP, record, 1.0e4),
        bm.Load(UP, lambda time: float(np.interp(time, times, forces, right=0.0))),
    ]
    runs = [bouncing(loads=[load]).run(1500)["up"] for load in loads]
    for own in runs[1:]:
        np.testing.assert_allclose(own, runs[0], rtol=0.0, atol=1e-9 * runs[0].max())
    assert runs[0].max() > 2.0e4 / (4.0 * STIFFNESS)
    pulled = bouncing(loads=[bm.Load.constant(UP, 4.0e4)])
    assert pulled.state.normal_force == pytest.approx(MASS * bm.STANDARD_GRAVITY - 4.0e4)


def test_schemes_differ_as_they_should() -> None:
    """Numerical damping takes energy, the midpoint rule none."""
    building = bm.ShearBuilding(8.0, 50e3, 4e5, [bm.Storey(3.0, 20e3, 40e6)])
    stiff = bm.SpringGround.under(building, 4, 1e10, 1e10, dashpots=(1e8, 1e8))
    start = [0.0, 0.0, 0.0, 0.1]
    losses = {}
    for name, scheme in {
        "midpoint": bm.TimeScheme.midpoint(),
        "dissipative": bm.TimeScheme.dissipative_midpoint(0.8),
        "newmark": bm.TimeScheme.newmark(0.6, 0.3025),
        "theta": bm.TimeScheme.theta(0.7),
        "hht": bm.TimeScheme.hht_alpha(-0.2),
    }.items():
        simulation = bm.Simulation(
            5e-3,
            building,
            stiff,
            bm.Bonded(),
            solver=bm.SolverOptions(scheme=scheme),
            initial=bm.InitialConditions(velocity=start),
        )
        losses[name] = simulation.run(200).energy_balance.algorithmic
    energy = 0.5 * 20e3 * 0.1**2
    assert abs(losses["midpoint"]) < 1e-12 * energy
    assert all(losses[name] > 0.01 * energy for name in ("newmark", "theta", "hht")), losses
    # It damps what the step does not resolve, and here ωΔt is 0.2.
    assert 1e-4 * energy < losses["dissipative"] < losses["hht"], losses


def test_moment_center_energy_balance_and_safety(rocking) -> None:
    middle, left = rocking().run(200), rocking(results=bm.ResultOptions(moment_center=-3.0)).run(200)
    lever = left["base_moment"] - middle["base_moment"]
    np.testing.assert_allclose(np.abs(lever), 3.0 * middle["normal_force"], rtol=1e-9)
    assert np.isnan(rocking(results=bm.ResultOptions(energy_balance=False)).run(10).energy_error)
    bonded = rocking(interface=bm.Bonded()).run(200)
    assert bonded.least_sliding_safety is None or bonded.least_sliding_safety.value == np.inf
    held = rocking(interface=bm.Bonded(), results=bm.ResultOptions(safety_friction=0.3)).run(200)
    assert held.least_sliding_safety is not None
    expected = 0.3 * held["normal_force"][1:] / np.abs(held["base_shear"][1:])
    assert held.least_sliding_safety.value == pytest.approx(np.nanmin(expected))


def test_serviceability(rocking) -> None:
    run = rocking(
        0.1,
        service_limits=bm.ServiceLimits(slip=5e-3, gap=1.0, uplifted_fraction=0.99, rotation=0.5),
    ).run(1000)
    checks = {check.criterion: check for check in run.serviceability}
    assert set(checks) == {"slip", "gap", "uplifted_fraction", "rotation"}
    slip = checks["slip"]
    assert not slip.is_met and slip.limit == 5e-3 and run.is_serviceable is False
    series = np.abs(run["mean_slip"])
    assert slip.first_excess == run.time[np.argmax(series > 5e-3)]
    assert slip.margin == pytest.approx(1.0 - series.max() / 5e-3)
    assert checks["rotation"].is_met and "rotation" in str(checks["rotation"])
    assert rocking().run(10).is_serviceable is None


def test_coordinates_change_rounding_only(soil: bm.Soil) -> None:
    storeys = [bm.Storey(3.0, 20e3, 40e6)] * 5
    building = bm.ShearBuilding(10.0, 50e3, 4e5, storeys, damping=0.05)
    ground = bm.ElasticGround.under(soil, building, 6)

    def run(**options: object) -> bm.Run:
        law, motion = bm.Coulomb(0.4), bm.el_centro_1940()
        return bm.Simulation(0.005, building, ground, law, motion=motion, **options).run(400)

    dofs, modes = (run(solver=bm.SolverOptions(coordinates=own)) for own in ("physical", "modes"))
    scale = dofs.base_shear.magnitude
    np.testing.assert_allclose(modes["base_shear"], dofs["base_shear"], atol=1e-7 * scale)
    assert not same_bits(modes["base_shear"], dofs["base_shear"])
    reduced = run(solver=bm.SolverOptions(coordinates=1e-6))
    np.testing.assert_allclose(reduced["base_shear"], dofs["base_shear"], atol=1e-4 * scale)
    with pytest.raises(bm.InputError, match="no kind of coordinates 'modal', only auto"):
        run(solver=bm.SolverOptions(coordinates="modal"))


def test_histories_agree_and_say_what_they_are(rocking, soil, block) -> None:
    runs = {}
    names = {"direct": "direct sum", "relaxed_fft": "relaxed transforms", "exponentials": "exponentials"}
    for kind, name in names.items():
        ground = bm.ElasticGround.under(soil, block, 8, history=kind)
        simulation = rocking(ground=ground)
        runs[kind] = simulation.run(400)["base_shear"]
        assert simulation.history_choice is not None and f"history: {name}, 400 steps" in simulation.history_choice
    scale = np.abs(runs["direct"]).max()
    np.testing.assert_allclose(runs["relaxed_fft"], runs["direct"], atol=1e-9 * scale)
    np.testing.assert_allclose(runs["exponentials"], runs["direct"], atol=1e-3 * scale)
    with pytest.raises(bm.InputError, match="no history 'fast', only direct"):
        bm.ElasticGround.under(soil, block, 8, history="fast")


def test_shared_kernels_change_nothing(rocking, soil, block) -> None:
    kernels = bm.SharedKernels()
    expected = rocking().run(200)["base_shear"]
    for _ in range(2):
        ground = bm.ElasticGround.under(soil, block, 8, kernels=kernels)
        assert same_bits(rocking(ground=ground).run(200)["base_shear"], expected)
    assert len(kernels) == 1


def test_strips(soil: bm.Soil) -> None:
    graded = bm.ElasticGround(soil, bm.Strip(-3.0, 3.0, 8)).elements
    uniform = bm.ElasticGround(soil, bm.Strip(-3.0, 3.0, 8, grading="uniform")).elements
    assert graded.shape == (8, 2) and graded[0, 1] - graded[0, 0] < 0.4
    np.testing.assert_allclose(np.diff(uniform), 0.75, rtol=1e-12)
    own = bm.ElasticGround(soil, [bm.Strip.from_nodes([-5, -4, -2]), bm.Strip(1.0, 2.0, 3)])
    assert own.elements[:, 0].tolist()[:2] == [-5.0, -4.0] and len(own.elements) == 5


def test_laws_of_the_interface_bound_its_tractions(rocking, soil) -> None:
    strong = bm.el_centro_1940().scaled(1.5)
    held = rocking(interface=bm.Coulomb(0.4, tensile_strength=1e7), motion=strong).run(300)
    assert held.uplifted_fraction.value == 0.0
    glued = rocking(interface=bm.Cohesive(1e7, 1e7, 0.4), motion=strong).run(300)
    assert glued.uplifted_fraction.value == 0.0
    soft = rocking(interface=bm.Yielding(4.0e5, 0.4), motion=strong).run(300, contact_every=1)
    assert soft.contact["pressure"].max() < 4.0e5 * (1.0 + 1e-9)
    assert any(bm.MODES[mode].startswith("yield") for mode in np.unique(soft.contact["mode"]))
    thin = bm.ThinLayer.from_stiffness(1e10, 1e10, 0.4)
    assert thin.stiffness == [1e10, 1e10]
    assert rocking(interface=thin, motion=strong).run(300).uplifted_fraction.value > 0.1
    assert bm.ThinLayer(soil, 1.0, 0.4, thickness_ratio=0.01).stiffness[0] > 1e9
    with pytest.raises(bm.InputError, match="list of interface laws has length 3"):
        rocking(interface=[bm.Coulomb(0.4)] * 3)


def test_refinement_finds_the_order_and_the_error(soil: bm.Soil) -> None:
    found = bm.refine(8, 0.1, lambda n, step: [5.0 + 3.0 / n**2, 2.0 - 0.5 * step])
    assert found.elements == [8, 8, 8, 16, 32, 16] and found.time_steps[2] == 0.025
    assert abs(found.mesh_order - 2.0) < 1e-6 and abs(found.step_order - 1.0) < 1e-6
    assert np.allclose(found.extrapolated, [5.0, 2.0], rtol=1e-9)
    truth = np.hypot(3.0 / 64, 0.05) / np.hypot(5.0, 2.0)
    assert abs(found.errors[0] - truth) < 1e-6 * truth and found.is_regular
    assert "order of convergence: 2.0" in str(found) and len(found.wall_times) == 6
    with pytest.raises(ZeroDivisionError):
        bm.refine(8, 0.1, lambda n, step: 1 / 0)
    with pytest.raises(bm.InputError, match="number of elements"):
        bm.refine(0, 0.1, lambda n, step: 1.0)


def test_several_peaks_are_refined_in_one_call() -> None:
    found = bm.refine(8, 0.1, lambda n, step: {"a": 5.0 + 3.0 / n**2, "b": 1e6 * (2.0 - 0.5 * step)})
    alone = bm.refine(8, 0.1, lambda n, step: 5.0 + 3.0 / n**2)
    assert found.names == ["a", "b"]
    assert list(found["a"].errors) == list(alone.errors)
    assert found["a"].extrapolated == alone.extrapolated
    assert abs(found["b"].step_order - 1.0) < 1e-6
    page = str(found)
    assert "extrapolated" in page and "b: order of convergence" in page
    with pytest.raises(bm.InputError, match="no peak 'c'"):
        found["c"]
    with pytest.raises(bm.InputError, match="same names"):
        bm.refine(8, 0.1, lambda n, step: {str(n): 1.0})
    with pytest.raises(bm.InputError, match="dict of numbers"):
        bm.refine(8, 0.1, lambda n, step: {"a": 1.0} if n == 8 else 1.0)


def test_twins_tell_the_digits_that_hold() -> None:
    found = bm.sensitivity(9, 0.1, lambda n, step: {"sum": n + step, "same": 2.0})
    own = found["sum"]
    assert (own.value, own.three_quarters, own.half, own.digits) == (9.1, 7.1, 5.1, 0)
    assert abs(own.shorter_step - 9.099) < 1e-12
    assert own.spread == 4.0 and found["same"].digits == 6
    assert [peak.name for peak in found.peaks] == ["sum", "same"]
    assert "½ elements" in str(found)
    with pytest.raises(ZeroDivisionError):
        bm.sensitivity(8, 0.1, lambda n, step: 1 / 0)
    with pytest.raises(bm.InputError, match="list of elements"):
        bm.sensitivity(1, 0.1, lambda n, step: {"a": 1.0})


def test_a_load_is_set_by_a_controller(rocking) -> None:
    block = bm.RigidBlock(6.0, 9.0, 1000.0)
    row = block.horizontal_at(9.0)
    by_function = rocking(structure=block, loads=[bm.Load(row, lambda t: 1e4 if t > 0 else 0.0)])
    by_hand = rocking(structure=block, loads=[bm.Load.constant(row, 0.0)])
    by_hand.set_load(0, 1e4)
    assert by_hand.run(50)["base_shear"].tolist() == by_function.run(50)["base_shear"].tolist()
    by_hand.reset()
    assert by_hand.run(50)["base_shear"].tolist() == rocking(structure=block).run(50)["base_shear"].tolist()
    by_hand.set_load(0, None)
    with pytest.raises(bm.InputError, match="load: index 1"):
        by_hand.set_load(1, 0.0)
    with pytest.raises(bm.InputError, match="not finite"):
        by_hand.set_load(0, float("nan"))


def test_a_fixed_base_and_the_system_on_its_ground(soil: bm.Soil) -> None:
    storeys = [bm.Storey(3.0, 20.0e3, 40.0e6)] * 5
    building = bm.ShearBuilding(10.0, 50.0e3, 4.0e5, storeys, damping=0.05)
    ground = bm.ElasticGround.under(soil, building, 8)
    parts = (0.01, building, ground, bm.Coulomb(0.5))
    given = {"motion": bm.el_centro_1940(), "probes": [bm.Probe.displacement("drift", building.drift(0))]}
    simulation = bm.Simulation(*parts, **given)
    found = simulation.interaction(4.0)
    assert simulation.state.step == 0
    run = simulation.run(duration=4.0)
    held = bm.Simulation(*parts, **given, fixed_base=True).run(duration=4.0)
    assert found.on_ground.base_shear == run.base_shear
    assert found.on_fixed_base.base_shear == held.base_shear
    assert held.base_rotation.magnitude < 1e-7 and not any("pulled" in text for text in held.warnings)
    ratio = run.base_shear.magnitude / held.base_shear.magnitude
    assert found.ratio("base_shear") == ratio
    assert found.probe_ratios["drift"] == run.probes["drift"].magnitude / held.probes["drift"].magnitude
    (mode,) = found.modes
    assert mode.axis is None and abs(mode.fixed_damping - 0.05) < 1e-6
    assert mode.period_ratio == mode.period / mode.fixed_period > 1.05
    assert 0.0 < mode.foundation_damping < mode.damping < 0.2
    assert "T̃/T = " in str(found)
    with pytest.raises(bm.InputError, match="duration"):
        simulation.interaction(-1.0)


def test_words_are_those_of_the_crate_and_those_of_the_docstrings(rocking, soil, block) -> None:
    rocking(initial=bm.InitialConditions(gravity_stage="frictional"))
    for word in ("Frictional", " frictional"):
        with pytest.raises(bm.InputError, match=f"no gravity stage '{word}', only frictional$"):
            bm.InitialConditions(gravity_stage=word)
    bm.ElasticGround.under(soil, block, 8, history="relaxed_fft")
    for word in ("relaxed fft", "relaxed-fft"):
        with pytest.raises(bm.InputError, match=f"no history '{word}', only relaxed_fft$"):
            bm.ElasticGround.under(soil, block, 8, history=word)
    with pytest.raises(bm.InputError, match="formulation is 'one point', but must be 'one_point'$"):
        bm.Mesh().add_quads([[0, 1, 2, 3]], bm.Material(1e9, 0.2, 2000.0), formulation="one point")
    record = bm.el_centro_1940()
    rests = [
        record.with_baseline(word, degree=degree).accelerations
        for word, degree in (("rest_to_rest", 3), ("rest_to_rest(3)", 5))
    ]
    assert same_bits(*rests)
    assert not same_bits(rests[0], record.with_baseline("rest_to_rest", degree=5).accelerations)
    with pytest.raises(bm.InputError, match="no baseline treatment 'rest', only none"):
        record.with_baseline("rest")
    bm.ThinLayer(soil, 1.0, 0.4, friction_limit="lagged", slip_sense="last_velocity")
    with pytest.raises(bm.InputError, match="no gravity stage 'hung', only frictionless"):
        rocking(initial=bm.InitialConditions(gravity_stage="hung"))


def test_all_modes_of_the_crate_have_a_number(rocking) -> None:
    with pytest.raises(bm.InputError) as refused:
        bm.PreviousContact(bm.ContactState(), "glide", 0.01)
    known = str(refused.value).partition(", only ")[2].split(", ")
    assert known == list(bm.MODES)
    with pytest.raises(bm.InputError, match="no contact mode 'slip left', only slip_left$"):
        bm.PreviousContact(bm.ContactState(), "slip left", 0.01)
    for mode in bm.MODES:
        assert bm.PreviousContact(bm.ContactState(), mode, 0.01).mode == mode


def test_options_are_in_groups(soil, block) -> None:
    parts = (0.01, block, bm.ElasticGround.under(soil, block, 4), bm.Bonded())
    for name, given in (
        ("gravity", "initial=InitialConditions(gravity=…)"),
        ("initial_velocity", "initial=InitialConditions(velocity=…)"),
        ("expected_steps", "solver=SolverOptions(expected_steps=…)"),
        ("moment_center", "results=ResultOptions(moment_center=…)"),
        ("allowable_slip", "service_limits=ServiceLimits(slip=…)"),
    ):
        with pytest.raises(TypeError, match=re.escape(f"no argument '{name}': give {given}") + "$"):
            bm.Simulation(*parts, **{name: 1.0})
    with pytest.raises(TypeError, match="no argument 'colour'$"):
        bm.Simulation(*parts, colour=1.0)
    with pytest.raises(TypeError, match=r"seconds: Simulation\(time_step, structure, ground, interface\)$"):
        bm.Simulation(*parts[1:], parts[0])
    for group in (
        bm.InitialConditions(gravity=9.8, gravity_stage="frictional", velocity=[0.0, 0.1, 0.0]),
        bm.SolverOptions(scheme=bm.TimeScheme.theta(0.6), coordinates=1e-6, expected_steps=5),
        bm.ResultOptions(moment_center=1.0, energy_balance=False),
        bm.ServiceLimits(slip=1e-3, rotation=0.1),
    ):
        assert repr(pickle.loads(pickle.dumps(group))) == repr(group)
