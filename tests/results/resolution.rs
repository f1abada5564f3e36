//! GOAL: time steps and elements that are too coarse for the structure or the ground motion cause warnings.

use std::f64::consts::PI;

use basemat::bem::{ElasticGround, Grading, Strip};
use basemat::coupled::Warning;
use basemat::motion::{FreeFieldFn, RickerDisplacement, TravellingWave};
use basemat::prelude::*;
use basemat::results::{ElementEnvelope, Run};

/// Largest base shear of the three storeys under El Centro with steps of 1 ms, N/m.
const THREE_STOREY_BASE_SHEAR: f64 = 703.6e3;
/// Root-mean-square frequency of El Centro's acceleration, Hz.
const EL_CENTRO_FREQUENCY: f64 = 3.65;
/// Period of the slender block in rocking on its soil, from the same run at 1 ms, s.
const ROCKING_PERIOD: f64 = 0.85;

fn soil(speed: f64) -> Soil {
    Soil::from_shear_wave_speed(speed, 0.33, 1900.0).unwrap()
}

fn three_storeys() -> ShearBuilding {
    let storeys = [Storey::new(3.0, 30e3, 60e6); 3];
    let building = ShearBuilding::new(8.0, 60e3, 4e5, &storeys).unwrap();
    building.with_stiffness_damping(0.05).unwrap()
}

/// Ten seconds of a bonded structure; its warnings are on its page.
pub(super) fn bonded_run(
    structure: impl Structure + 'static,
    motion: impl FreeField + 'static,
    soil: Soil,
    elements: usize,
    time_step: f64,
) -> Run {
    let mut simulation = Simulation::builder(time_step)
        .ground(
            ElasticGround::new(soil, Strip::under(&structure, elements, Grading::Uniform).unwrap())
                .unwrap(),
        )
        .structure(structure)
        .motion(motion)
        .interface(Bonded)
        .build()
        .unwrap();
    let steps = simulation.steps_for(10.0);
    let mut run = simulation.run(steps, |_| {}).unwrap();
    for warning in &run.warnings {
        let line = format!("warning: {warning}");
        assert!(run.to_string().contains(&line));
        assert!(line.chars().count() <= 100, "{line}");
    }
    // These bonded bases are pulled up, but only the warnings of resolution are tested here.
    run.warnings.retain(|warning| !matches!(warning, Warning::Tension { .. }));
    run
}

fn ricker(frequency: f64) -> RickerDisplacement {
    RickerDisplacement::new(0.05, 1.0 / (PI * frequency), 2.0).unwrap()
}

/// Three storeys under El Centro.
fn shaken_storeys(elements: usize, time_step: f64) -> Run {
    bonded_run(three_storeys(), el_centro_1940(), soil(250.0), elements, time_step)
}

/// The warning has the frequency of the record, which none of these steps resolves. The recommended step resolves it.
#[test]
fn steps_that_do_not_resolve_the_record_cause_a_warning() {
    for time_step in [0.1, 0.2, 0.5, 1.0] {
        let run = shaken_storeys(12, time_step);
        let error = (run.whole.base_shear.magnitude() / THREE_STOREY_BASE_SHEAR - 1.0).abs();
        assert!(error > 0.15, "Δt = {time_step}: {error}");
        let [Warning::UnresolvedMotion { frequency, time_step: stated_step, needed, .. }] =
            run.warnings[..]
        else {
            panic!("Δt = {time_step}: {:?}", run.warnings)
        };
        assert!((frequency / EL_CENTRO_FREQUENCY - 1.0).abs() < 0.05, "{frequency}");
        assert_eq!(stated_step, time_step);
        let resolved_run = shaken_storeys(12, needed);
        let error =
            (resolved_run.whole.base_shear.magnitude() / THREE_STOREY_BASE_SHEAR - 1.0).abs();
        assert!(error < 0.06, "Δt = {needed}: {error}");
        assert_eq!(resolved_run.warnings, []);
    }
}

/// A slender block under a pulse of 1 Hz.
fn pushed_slender_block(time_step: f64) -> Run {
    let block = RigidBlock::new(10.0, 25.0, 2000.0).unwrap();
    bonded_run(block, ricker(1.0), soil(200.0), 12, time_step)
}

/// A pulse of 1 Hz is resolved by ten steps a second, but the rocking that follows is not.
#[test]
fn steps_that_do_not_resolve_the_structure_cause_a_warning() {
    let fine = pushed_slender_block(2.5e-3);
    assert_eq!(fine.warnings, []);
    let coarse = pushed_slender_block(0.1);
    assert!(coarse.whole.base_shear.magnitude() < 0.75 * fine.whole.base_shear.magnitude());
    let [Warning::UnresolvedPeriod { period, time_step: 0.1, needed, .. }] = coarse.warnings[..]
    else {
        panic!("{:?}", coarse.warnings)
    };
    assert!((period / ROCKING_PERIOD - 1.0).abs() < 0.2, "{period}");
    let resolved_run = pushed_slender_block(needed);
    let error = resolved_run.whole.base_shear.magnitude() / fine.whole.base_shear.magnitude() - 1.0;
    assert!(error.abs() < 0.1, "{error}");
    assert_eq!(resolved_run.warnings, []);
}

/// After its motion the ground moves with a constant velocity at most: changes of this velocity are rounding and cause no
/// warning. After El Centro the displacement passes through zero.
#[test]
fn rest_after_the_motion_causes_no_warning() {
    let samples = (0..=100).map(|k| f64::sin(f64::from(k))).collect();
    for motion in [Record::new(0.02, samples).unwrap(), el_centro_1940()] {
        let block = RigidBlock::new(6.0, 9.0, 1000.0).unwrap();
        let duration = motion.duration();
        let mut simulation = Simulation::builder(0.01)
            .ground(ElasticGround::under(soil(200.0), &block, 8).unwrap())
            .structure(block)
            .motion(motion)
            .interface(Coulomb::new(0.5).unwrap())
            .build()
            .unwrap();
        let steps = simulation.steps_for(duration);
        simulation.run(steps, |_| {}).unwrap();
        let rest = simulation.run(steps, |_| {}).unwrap();
        assert!(rest.whole.base_shear.magnitude() > 1e-6 * rest.whole.static_normal_force);
        assert!(rest.warnings.is_empty(), "{:?}", rest.warnings);
    }
}

/// Errors of the largest base shear, from halved steps by Richardson's extrapolation.
#[test]
fn large_errors_of_the_time_step_cause_a_warning() {
    type ResolutionCase = (fn() -> Box<dyn Structure>, fn() -> Box<dyn FreeField>, f64);
    let cases: [ResolutionCase; 5] = [
        (|| Box::new(three_storeys()), || Box::new(el_centro_1940()), 250.0),
        (|| Box::new(three_storeys()), || Box::new(el_centro_1940()), 120.0),
        (
            || Box::new(RigidBlock::new(10.0, 15.0, 2000.0).unwrap()),
            || Box::new(el_centro_1940()),
            250.0,
        ),
        (
            || Box::new(RigidBlock::new(6.0, 9.0, 2000.0).unwrap()),
            || Box::new(el_centro_1940()),
            250.0,
        ),
        (
            || Box::new(RigidBlock::new(10.0, 25.0, 2000.0).unwrap()),
            || Box::new(ricker(1.0)),
            200.0,
        ),
    ];
    for (structure, motion, speed) in cases {
        let shake = |step| bonded_run(structure(), motion(), soil(speed), 8, step);
        let finer_shear = shake(6.25e-3).whole.base_shear.magnitude();
        let finest_shear = shake(3.125e-3).whole.base_shear.magnitude();
        let expected = finest_shear + (finest_shear - finer_shear) / 3.0;
        for time_step in [0.05, 0.025] {
            let run = shake(time_step);
            let error = (run.whole.base_shear.magnitude() / expected - 1.0).abs();
            let is_warned = run.warnings.iter().any(|warning| {
                matches!(
                    warning,
                    Warning::UnresolvedPeriod { .. } | Warning::UnresolvedMotion { .. }
                )
            });
            println!("Δt = {time_step}: {error:.3}, warned: {is_warned}");
            assert!(is_warned || error < 0.2, "Δt = {time_step}: {error}");
        }
    }
}

/// A squat block on stiff soil under a pulse of 1 Hz.
fn pushed_squat_block(time_step: f64) -> Run {
    let block = RigidBlock::new(10.0, 5.0, 2000.0).unwrap();
    bonded_run(block, ricker(1.0), soil(1500.0), 8, time_step)
}

/// A squat block on stiff soil vibrates far too fast for the step, and follows the ground.
#[test]
fn stiff_structures_need_no_fine_steps() {
    let fine = pushed_squat_block(2e-3);
    let coarse = pushed_squat_block(0.08);
    let error = coarse.whole.base_shear.magnitude() / fine.whole.base_shear.magnitude() - 1.0;
    assert!(error.abs() < 0.06, "{error}");
    assert_eq!(coarse.warnings, []);
}

/// A run that is recorded step by step has the warnings of the motion at these steps.
#[test]
fn runs_recorded_step_by_step_have_warnings() {
    let structure = three_storeys();
    let mut simulation = Simulation::builder(0.5)
        .ground(
            ElasticGround::new(
                soil(250.0),
                Strip::under(&structure, 12, Grading::Uniform).unwrap(),
            )
            .unwrap(),
        )
        .structure(structure)
        .motion(el_centro_1940())
        .interface(Bonded)
        .build()
        .unwrap();
    let mut run = simulation.begin_run();
    for _ in 0..20 {
        run.record(simulation.step().unwrap());
    }
    let warnings = simulation.end_run(run).warnings;
    assert!(matches!(warnings[..], [Warning::UnresolvedMotion { .. }]), "{warnings:?}");
}

/// Six seconds of a slender block under El Centro times `scale`.
fn shaken_slender_block(law: Box<dyn InterfaceLaw>, scale: f64, gravity: f64) -> Run {
    let block = RigidBlock::new(10.0, 25.0, 2000.0).unwrap();
    let mut simulation = Simulation::builder(0.01)
        .ground(ElasticGround::under(soil(200.0), &block, 12).unwrap())
        .structure(block)
        .motion(el_centro_1940().scaled(scale).unwrap())
        .interface(law)
        .gravity(gravity)
        .build()
        .unwrap();
    simulation.run(600, |_| {}).unwrap()
}

/// Tension, place and time of the warning of a base that is pulled up.
fn tension_warning(run: &Run) -> Option<[f64; 3]> {
    run.warnings.iter().find_map(|warning| match warning {
        Warning::Tension { tension, x, time, .. } => Some([*tension, *x, *time]),
        _ => None,
    })
}

fn lowest_pressure(element: &ElementEnvelope) -> f64 {
    element.pressure.lowest.value
}

/// A bonded base under weight that is pulled up causes a warning with the numbers of its envelope.
#[test]
fn bonded_bases_that_are_pulled_up_cause_a_warning() {
    let run = shaken_slender_block(Box::new(Bonded), 1.0, 9.81);
    let pulled_element = run
        .envelope
        .iter()
        .min_by(|a, b| lowest_pressure(a).total_cmp(&lowest_pressure(b)))
        .unwrap();
    let middle = pulled_element.element.center()[0];
    let expected = [-lowest_pressure(pulled_element), middle, pulled_element.pressure.lowest.time];
    assert_eq!(tension_warning(&run), Some(expected));
    assert!(lowest_pressure(pulled_element) < -1e4);
    // Neither a weak motion, nor a base that opens, nor one without weight.
    let weak_motion_run = shaken_slender_block(Box::new(Bonded), 0.01, 9.81);
    assert_eq!(tension_warning(&weak_motion_run), None);
    let opening = shaken_slender_block(Box::new(Coulomb::new(0.5).unwrap()), 1.0, 9.81);
    assert_eq!(tension_warning(&opening), None);
    let weightless_run = shaken_slender_block(Box::new(Bonded), 1.0, 0.0);
    assert_eq!(tension_warning(&weightless_run), None);
}

/// The warning of a base beyond the elements, of three storeys on a strip of this half width.
fn uncovered_base(half: f64) -> Option<Warning> {
    let elements = Strip::uniform(-half..half, 8).unwrap();
    let mut simulation = Simulation::builder(5e-3)
        .ground(ElasticGround::new(soil(250.0), elements).unwrap())
        .structure(three_storeys())
        .interface(Bonded)
        .motion(el_centro_1940())
        .build()
        .unwrap();
    let run = simulation.run(200, |_| {}).unwrap();
    run.warnings
        .into_iter()
        .find(|warning| matches!(warning, Warning::UncoveredBase { .. }))
}

/// A base of 8 m extends 2 m beyond its elements. A base that extends by less than an element's length causes no warning.
#[test]
fn a_base_beyond_the_elements_causes_a_warning() {
    let half = 4.0;
    let warning = uncovered_base(0.5 * half);
    let Some(Warning::UncoveredBase { foundation: 0, reach, axis: None }) = warning else {
        panic!()
    };
    assert!((reach - 0.5 * half).abs() < 1e-12, "{reach}");
    assert_eq!(uncovered_base(0.9 * half), None);
    assert_eq!(uncovered_base(half), None);
}

/// One element does not resist rocking, and two do not resist it enough.
#[test]
fn too_few_elements_cause_a_warning() {
    let fine = shaken_storeys(12, 5e-3).whole.base_shear.magnitude();
    for elements in [1, 2, 3] {
        let found = shaken_storeys(elements, 5e-3).warnings;
        assert_eq!(
            found,
            [Warning::FewElements { foundation: 0, elements, needed: 4, axis: None }]
        );
    }
    assert!(shaken_storeys(1, 5e-3).whole.base_shear.magnitude() < 0.5 * fine);
    let resolved_run = shaken_storeys(4, 5e-3);
    assert!((resolved_run.whole.base_shear.magnitude() / fine - 1.0).abs() < 0.05);
    assert_eq!(resolved_run.warnings, []);
}

/// A pulse of 8 Hz that runs along a raft of 40 m.
fn raft_under_pulse(elements: usize) -> Run {
    let block = RigidBlock::new(40.0, 5.0, 2000.0).unwrap();
    let pulse = FreeFieldFn::new(|_, t| {
        let a = PI * 8.0 * (t - 1.0);
        [1e-3 * (1.0 - 2.0 * a * a) * (-a * a).exp(), 0.0]
    });
    let wave = TravellingWave::new(pulse, 100.0, -20.0).unwrap();
    bonded_run(block, wave, soil(100.0), elements, 4e-3)
}

/// A pulse of 8 Hz that runs along a raft of 40 m with the soil's shear wave speed.
#[test]
fn elements_longer_than_waves_cause_a_warning() {
    let fine = raft_under_pulse(40);
    assert_eq!(fine.warnings, []);
    let coarse = raft_under_pulse(5);
    let error = coarse.whole.base_shear.magnitude() / fine.whole.base_shear.magnitude() - 1.0;
    assert!(error.abs() > 0.1, "{error}");
    let [Warning::LongElements { element_length, wavelength, needed }] = coarse.warnings[..] else {
        panic!("{:?}", coarse.warnings)
    };
    assert!((element_length - 8.0).abs() < 1e-12 && wavelength < 32.0 && needed < 4.0);
}
