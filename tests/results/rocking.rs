//! GOAL: settlement, rocking work and equivalent damping of each foundation are right, in time series and in files.
//! SCENE: blocks on springs under a vertical force, a slow moment or an earthquake, in the plane and in space; two footings.
//! REFERENCE: F/K, ½ k θ², the terms of the energy balance, ½ sin φ; the states of the run.

use std::f64::consts::{PI, TAU};

use basemat::bem::SpringGround;
use basemat::bem::plan::Plan;
use basemat::coupled::{Load, SimulationBuilder, State};
use basemat::interface::{Bonded, Coulomb, InterfaceLaw, Yielding};
use basemat::motion::{AtRest, FreeField, el_centro_1940};
use basemat::results::{Quantity, Recorder, TimeSeries, equivalent_damping};
use basemat::structure::{DofCombination, RigidBlock, RigidBody, StructureGroup};
use basemat::{Error, Simulation};
use basemat_problems::scenes::{RecordedRun, record_run};

/// Width of the block, m, and its number of elements.
const BASE_WIDTH: f64 = 4.0;
const ELEMENT_COUNT: usize = 8;
/// Stiffness of the springs, Pa/m.
const BEDDING_MODULUS: f64 = 4.0e7;
/// Rotation of the block as a degree of freedom.
const ROTATION_DOF: usize = 2;

fn springs() -> SpringGround {
    let half = 0.5 * BASE_WIDTH;
    SpringGround::new(-half..half, ELEMENT_COUNT, BEDDING_MODULUS, BEDDING_MODULUS).unwrap()
}

fn block() -> RigidBlock {
    RigidBlock::new(BASE_WIDTH, 5.0, 2000.0).unwrap()
}

fn on_springs(law: impl InterfaceLaw + 'static) -> SimulationBuilder {
    Simulation::builder(0.01).structure(block()).ground(springs()).interface(law)
}

/// Stiffness of the springs against rotation, N·m/m, by the middles of the elements.
fn rotation_stiffness() -> f64 {
    let side = BASE_WIDTH / ELEMENT_COUNT as f64;
    let arms = (0..ELEMENT_COUNT).map(|e| (e as f64 + 0.5) * side - 0.5 * BASE_WIDTH);
    arms.map(|arm| BEDDING_MODULUS * side * arm * arm).sum()
}

/// Runs and records, with each foundation.
fn recorded(simulation: &mut Simulation, steps: usize) -> RecordedRun {
    record_run(simulation, Recorder::new().foundations(), steps)
}

#[test]
fn settlement_is_the_added_force_over_the_stiffness() {
    let force = 3.0e5;
    let ramp = move |time: f64| -force * (time / 4.0).min(1.0);
    let load = Load::new(DofCombination::from(1), ramp);
    let damped_bed = springs().with_dashpots(4e6, 4e6).unwrap();
    let mut simulation = on_springs(Bonded).ground(damped_bed).load(load).build().unwrap();
    let RecordedRun { time_series, run, .. } = recorded(&mut simulation, 1000);
    let settlement = time_series.series(Quantity::Settlement);
    assert_eq!(settlement[0], 0.0);
    let expected = force / (BEDDING_MODULUS * BASE_WIDTH);
    assert!((settlement[1000] / expected - 1.0).abs() < 1e-9, "{}", settlement[1000]);
    assert_eq!(run.whole.residual_settlement, settlement[1000]);
    assert_eq!(run.whole.settlement.highest.value, settlement.iter().copied().fold(0.0, f64::max));
    let page = run.to_string();
    assert!(page.contains("Settlement\n  up to 1.87"), "{page}");
}

/// Linear springs return the whole work.
#[test]
fn springs_store_half_the_stiffness_times_the_square_of_the_rotation() {
    let moment = |time: f64| 2.0e5 * (TAU * time / 20.0).sin();
    let load = Load::new(DofCombination::from(ROTATION_DOF), moment);
    let mut simulation = on_springs(Bonded).load(load).build().unwrap();
    let RecordedRun { time_series, run, states } = recorded(&mut simulation, 2000);
    let stored: Vec<f64> = states
        .iter()
        .map(|state| 0.5 * rotation_stiffness() * state.base_rotation.powi(2))
        .collect();
    // A quarter of the cycle.
    assert!(stored[500] > 20.0, "{}", stored[500]);
    for (work, stored_now) in time_series.series(Quantity::RockingWork).iter().zip(&stored) {
        assert!((work - stored_now).abs() < 1e-9 * stored[500], "{work} {stored_now}");
    }
    assert!(run.whole.rocking_work.highest.value > 20.0);
    let damping = time_series.rocking(0).unwrap().between(0.0..20.0).unwrap();
    assert!(damping.equivalent_damping().unwrap().abs() < 1e-3);
}

/// Work on the soil of the changes of normal and shear force from the static state, by the motion of the base.
fn work_beside_rocking(states: &[State]) -> f64 {
    let mut work = 0.0;
    for pair in states.windows(2) {
        let [before, after] = [&pair[0], &pair[1]].map(State::displacement);
        work -= (pair[1].normal_force - states[0].normal_force) * (after[1] - before[1]);
        work += pair[1].base_shear * (after[0] - before[0]);
    }
    work
}

#[test]
fn soil_that_yields_dissipates_the_rocking_work() {
    for (bearing_pressure, yields) in [(1.5e5, true), (1e9, false)] {
        let half = 0.5 * BASE_WIDTH;
        let ground = SpringGround::new(-half..half, 40, BEDDING_MODULUS, BEDDING_MODULUS).unwrap();
        let moment = |time: f64| 2.6e5 * (TAU * time / 4.0).sin();
        let mut simulation = on_springs(Yielding::new(bearing_pressure, 10.0).unwrap())
            .ground(ground)
            .load(Load::new(DofCombination::from(ROTATION_DOF), moment))
            .build()
            .unwrap();
        let RecordedRun { time_series, run, states } = recorded(&mut simulation, 1200);
        assert!(run.whole.sliding.path == 0.0 && run.energy_error < 1e-9);
        let energy_balance = run.energy_balance;
        let balance_work =
            energy_balance.soil + energy_balance.contact + energy_balance.static_contact;
        let work = time_series.series(Quantity::RockingWork)[1200];
        let computed = work + work_beside_rocking(&states);
        let largest = run.whole.rocking_work.magnitude();
        assert!((computed - balance_work).abs() < 1e-9 * largest, "{computed} {balance_work}");
        // Soil that does not yield returns the work.
        assert!((work > 0.5 * largest) == yields, "{work} {largest}");
        assert!((energy_balance.contact > work) == yields, "{energy_balance}");
        let settlement = run.whole.residual_settlement;
        assert!((settlement > 3e-3) == yields, "{settlement}");
        let cycle = time_series.rocking(0).unwrap().between(5.0..9.0).unwrap();
        let damping = cycle.equivalent_damping().unwrap();
        assert!(if yields { damping > 0.03 } else { damping.abs() < 1e-4 }, "{damping}");
    }
}

/// A pulse of the ground along x, in the plane too, or along y.
#[derive(Clone, Copy)]
struct Pulse {
    is_across: bool,
}

impl FreeField for Pulse {
    fn displacement(&self, _: f64, time: f64) -> [f64; 2] {
        [0.15 * (-((time - 0.6) / 0.15).powi(2)).exp(), 0.0]
    }

    fn displacement_at(&self, _: [f64; 2], time: f64) -> [f64; 3] {
        let pulse = self.displacement(0.0, time)[0];
        if self.is_across { [0.0, pulse, 0.0] } else { [pulse, 0.0, 0.0] }
    }
}

/// Rocking about either axis and in the plane is the same motion.
#[test]
fn rocking_in_space_equals_rocking_in_the_plane() {
    const BODY_DEPTH: f64 = BASE_WIDTH;
    let half = 0.5 * BASE_WIDTH;
    let law = || Coulomb::new(0.8).unwrap();
    let mut plane = on_springs(law()).motion(Pulse { is_across: false }).build().unwrap();
    let RecordedRun { time_series: plane, run, .. } = recorded(&mut plane, 200);
    assert!(run.whole.uplifted_fraction.highest.value > 0.3);
    for is_across in [false, true] {
        let plan = Plan::rectangle(-half..half, -half..half, ELEMENT_COUNT).unwrap();
        let mut simulation = Simulation::builder(0.01)
            .structure(RigidBody::cuboid([BASE_WIDTH, BODY_DEPTH, 5.0], 2000.0).unwrap())
            .ground(SpringGround::in_plan(plan, [BEDDING_MODULUS; 3]).unwrap())
            .interface(law())
            .motion(Pulse { is_across })
            .build()
            .unwrap();
        let RecordedRun { time_series: series, run, .. } = recorded(&mut simulation, 200);
        let rocking = if is_across { series.rocking_across(0) } else { series.rocking(0) }.unwrap();
        let in_plane = plane.rocking(0).unwrap();
        // A rise to the right is a negative rotation about y, and a rise away a positive one about x.
        let sign = if is_across { 1.0 } else { -1.0 };
        for (found, expected, factor) in [
            (rocking.rotation, in_plane.rotation, sign),
            (rocking.moment, in_plane.moment, sign * BODY_DEPTH),
            (rocking.settlement, in_plane.settlement, 1.0),
            (rocking.work, in_plane.work, BODY_DEPTH),
        ] {
            let scale = expected.iter().fold(0.0_f64, |scale, value| scale.max(value.abs()));
            assert!(scale > 0.0);
            for (found, expected) in found.iter().zip(expected) {
                let error = found - factor * expected;
                assert!(error.abs() < 1e-6 * factor.abs() * scale, "{found} {expected}");
            }
        }
        let other_rocking =
            if is_across { series.rocking(0) } else { series.rocking_across(0) }.unwrap();
        let max_magnitude =
            other_rocking.work.iter().fold(0.0_f64, |max, work| max.max(work.abs()));
        assert!(max_magnitude < 1e-6 * run.whole.extremes(Quantity::Settlement).magnitude());
        let residual = [run.whole.residual_rotation, run.whole.residual_rotation_across];
        assert_eq!(residual[usize::from(is_across)], rocking.rotation[200]);
    }
}

/// Rotations (rad) and moments (N m) of a cycle.
struct MomentLoop {
    rotation: Vec<f64>,
    moment: Vec<f64>,
}

/// An ellipse of `count` points, whose moment leads by `angle`.
fn ellipse(count: usize, angle: f64) -> MomentLoop {
    let phases = (0..=count).map(|k| TAU * k as f64 / count as f64);
    let rotation = phases.clone().map(|phase| 2e-3 * phase.sin()).collect();
    let moment = phases.map(|phase| 3e5 + 7e4 * (phase + angle).sin()).collect();
    MomentLoop { rotation, moment }
}

#[test]
fn ellipses_have_half_the_sine_of_their_angle() {
    for angle in [0.0, 0.1, 0.5, 0.25 * PI, -0.2] {
        let MomentLoop { rotation, moment } = ellipse(8000, angle);
        let damping = equivalent_damping(&rotation, &moment).unwrap();
        assert!((damping - 0.5 * f64::sin(angle)).abs() < 1e-6, "{damping}");
        // A cycle may begin anywhere, and need not be closed to the last bit.
        let damping = equivalent_damping(&rotation[100..8000], &moment[100..8000]).unwrap();
        assert!((damping - 0.5 * f64::sin(angle)).abs() < 1e-3, "{damping}");
    }
}

#[test]
fn springs_and_dashpots_have_the_damping_of_their_ratio() {
    let period = 8.0;
    // Angle by which the moment leads: tan φ = ω c/k.
    let angle = f64::atan(TAU / period * 0.2);
    let damped_bed = springs().with_dashpots(0.2 * BEDDING_MODULUS, 0.2 * BEDDING_MODULUS).unwrap();
    let moment = move |time: f64| 1.5e5 * (TAU * time / period).sin();
    for interval in [1, 10] {
        let mut simulation = on_springs(Bonded)
            .ground(damped_bed.clone())
            .load(Load::new(DofCombination::from(ROTATION_DOF), moment))
            .build()
            .unwrap();
        let mut time_series = Recorder::new().every(interval).start(&simulation).unwrap();
        simulation.run(3200, |state| time_series.record(state)).unwrap();
        let cycle = time_series.rocking(0).unwrap().between(2.0 * period..3.0 * period).unwrap();
        assert_eq!(cycle.times.len(), 800 / interval + 1);
        let damping = cycle.equivalent_damping().unwrap();
        assert!((damping / (0.5 * angle.sin()) - 1.0).abs() < 2e-3, "{damping} {angle}");
    }
}

#[test]
fn series_that_are_no_cycle_are_errors() {
    let MomentLoop { rotation, moment } = ellipse(400, 0.3);
    let cycle_error =
        |rotation: &[f64], moment: &[f64]| equivalent_damping(rotation, moment).unwrap_err();
    assert!(matches!(cycle_error(&rotation[..2], &moment[..2]), Error::Size { found: 2, .. }));
    assert!(matches!(
        cycle_error(&rotation, &moment[1..]),
        Error::Size { found: 400, needed: 401, .. }
    ));
    for end in [120, 200, 340] {
        let error = cycle_error(&rotation[100..end], &moment[100..end]);
        assert!(matches!(error, Error::Input { .. }), "{end}: {error}");
    }
    let repeated = |values: &[f64]| [values, values].concat();
    let error = cycle_error(&repeated(&rotation), &repeated(&moment));
    assert!(error.to_string().contains("number of cycles of the rotation is 2"), "{error}");
    let error = cycle_error(&[1.0; 5], &[0.0, 1.0, 2.0, 1.0, 0.0]);
    assert!(error.to_string().contains("is 0, but must be above zero"), "{error}");
    let mut moment_with_nan = moment.clone();
    moment_with_nan[7] = f64::NAN;
    assert!(matches!(
        cycle_error(&rotation, &moment_with_nan),
        Error::NotFinite { quantity: "moment", index: 7, .. }
    ));
    let mut simulation = on_springs(Bonded).build().unwrap();
    let time_series = recorded(&mut simulation, 10).time_series;
    let rocking = time_series.rocking(0).unwrap();
    for window in [0.05..0.01, 7.0..8.0] {
        let computed = rocking.between(window.clone());
        assert!(matches!(computed, Err(Error::Size { found: 0, .. })), "{window:?}");
    }
    for window in [f64::NAN..1.0, 0.0..f64::NAN, 0.0..f64::INFINITY] {
        let computed = rocking.between(window.clone());
        assert!(matches!(computed, Err(Error::Input { .. })), "{window:?}");
    }
    assert_eq!(rocking.between(0.03..0.05).unwrap().times.len(), 3);
    let mut shortened = rocking;
    shortened.work = &[];
    assert!(shortened.between(0.0..0.1).unwrap().equivalent_damping().is_err());
    assert!(matches!(time_series.rocking_across(0), Err(Error::Scene { .. })));
    assert!(matches!(time_series.rocking(1), Err(Error::Index { index: 1, bound: 1, .. })));
}

fn two_footings() -> Simulation {
    let second = RigidBlock::new(3.0, 9.0, 1800.0).unwrap();
    let group = StructureGroup::new().with(block(), 0.0).unwrap().with(second, 10.0).unwrap();
    let ground = SpringGround::under(&group, ELEMENT_COUNT, 2e7, 1e7).unwrap();
    Simulation::builder(0.005)
        .structure(group)
        .ground(ground.with_dashpots(2e5, 1e5).unwrap())
        .interface(Yielding::new(3e5, 0.5).unwrap())
        .motion(el_centro_1940())
        .build()
        .unwrap()
}

#[test]
fn each_foundation_has_its_series() {
    let RecordedRun { time_series, run, states } = recorded(&mut two_footings(), 1000);
    for k in 0..2 {
        let rocking = time_series.rocking(k).unwrap();
        for (step, state) in states.iter().enumerate() {
            let foundation = &state.foundations[k];
            assert_eq!(rocking.rotation[step], foundation.base_rotation);
            assert_eq!(rocking.moment[step], foundation.base_moment);
            assert_eq!(rocking.settlement[step], foundation.settlement);
            assert_eq!(rocking.work[step], foundation.rocking_work);
        }
        assert_eq!(run.foundations[k].residual_settlement, rocking.settlement[1000]);
        assert_eq!(run.foundations[k].residual_rotation, rocking.rotation[1000]);
        let max_magnitude = rocking.settlement.iter().copied().fold(0.0, f64::max);
        assert_eq!(run.foundations[k].settlement.highest.value, max_magnitude);
    }
    let end = &states[1000];
    let [first, second] = &end.foundations[..] else { panic!("two foundations") };
    assert!(first.settlement != second.settlement && second.rocking_work != 0.0);
    assert_eq!(end.value(Quantity::Settlement), first.settlement.max(second.settlement));
    assert_eq!(end.value(Quantity::RockingWork), first.rocking_work + second.rocking_work);

    let csv = time_series.csv();
    let mut lines = csv.lines();
    let heading: Vec<&str> = lines.next().unwrap().split(',').collect();
    let last_row: Vec<&str> = lines.last().unwrap().split(',').collect();
    assert_eq!(heading.len(), last_row.len());
    for (name, value) in [
        ("settlement_m", end.value(Quantity::Settlement)),
        ("foundation_0_settlement_m", first.settlement),
        ("foundation_1_settlement_m", second.settlement),
        ("foundation_1_rocking_work_j_per_m", second.rocking_work),
        ("foundation_1_base_moment_n_m_per_m", second.base_moment),
    ] {
        let column = heading.iter().position(|heading| *heading == name).expect(name);
        assert_eq!(last_row[column].parse(), Ok(value), "{name}");
    }
    let text = serde_json::to_string(&time_series).unwrap();
    let read_back: TimeSeries = serde_json::from_str(&text).unwrap();
    assert_eq!(read_back.csv(), csv);
    assert_eq!(read_back.rocking(1).unwrap(), time_series.rocking(1).unwrap());
    let damaged_text = text.replace("\"count\":2", "\"count\":3");
    assert!(damaged_text != text && serde_json::from_str::<TimeSeries>(&damaged_text).is_err());
}

/// A single foundation has the series of the whole base, unless moments are about another point.
#[test]
fn series_of_foundations_are_kept_on_request() {
    let two = Recorder::new().start(&two_footings()).unwrap();
    let error = two.rocking(0).unwrap_err();
    assert!(error.to_string().contains("set `foundations` of the recorder"), "{error}");
    let mut shifted_simulation =
        on_springs(Bonded).moment_center(-3.0).motion(AtRest).build().unwrap();
    let time_series = Recorder::new().start(&shifted_simulation).unwrap();
    assert!(matches!(time_series.rocking(0), Err(Error::Scene { .. })));
    let RecordedRun { time_series, states, .. } = recorded(&mut shifted_simulation, 5);
    let moment = time_series.rocking(0).unwrap().moment[5];
    assert_eq!(moment, states[5].foundations[0].base_moment);
    assert!((moment - time_series.series(Quantity::BaseMoment)[5]).abs() > 1e5);
    let series_of_one_foundation =
        Recorder::new().start(&on_springs(Bonded).build().unwrap()).unwrap();
    assert_eq!(
        series_of_one_foundation.rocking(0).unwrap().moment,
        series_of_one_foundation.series(Quantity::BaseMoment)
    );
    assert!(!series_of_one_foundation.csv().contains("foundation_"));
    assert!(series_of_one_foundation.bytes() < time_series.bytes());
}
