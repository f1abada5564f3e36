//! GOAL: a boxed part behaves as the part itself, and a part that wraps another forwards every method.
//! SCENE: parts whose methods return other values than the defaults of their trait, and record that they were called.
//! REFERENCE: the methods in the trait's source, so that a new one that is not forwarded is found.
#![allow(clippy::needless_pass_by_value, reason = "parts are passed by value, as to a builder")]

mod law;
mod log;
mod recording_fields;
mod recording_part;
mod structure;

use basemat::bem::full_plane::{BoundaryKernel, IncidentField};
use basemat::bem::{ElasticGround, Ground, SpringGround, Strip};
use basemat::coupled::{Midpoint, TimeScheme};
use basemat::fem::{Element, ElementFace, MassKind, StressAtRest};
use basemat::history::ConvolutionHistory;
use basemat::interface::{ContactState, Coulomb, InPlane, InterfaceLaw, Mode};
use basemat::motion::{AtRest, FreeField, RecordFormat, RickerDisplacement};
use basemat::structure::{Hysteresis, RigidBlock, Structure};
use basemat::{Error, Simulation, Soil, unobserved};

use log::{CallLog, methods, source};
use recording_part::{MARKER_VALUE, RecordingPart};

#[test]
fn boxed_springs_forward_all_methods() {
    fn call_methods(mut part: impl Hysteresis) {
        assert_eq!(part.response(2.0).force, 2.0 * MARKER_VALUE);
        assert_eq!(part.energy(2.0).stored, 2.0 * MARKER_VALUE);
        part.commit(1.0);
        assert_eq!(part.save(), [MARKER_VALUE]);
        assert_eq!(part.restore(&[1.0]), Err(recording_part::part_error()));
        drop(part.clone_box());
    }
    let log = CallLog::default();
    let part: Box<dyn Hysteresis> = Box::new(RecordingPart::new(&log));
    call_methods(part);
    assert_eq!(
        log.take(),
        methods(source!("../crates/structures/src/structure/hysteresis/mod.rs"), "Hysteresis")
    );
}

/// Calls all methods of a law but `limits`.
fn call_law_methods<L: InterfaceLaw + 'static>(new_law: impl Fn() -> L) {
    let law = new_law();
    let start = recording_part::previous_contact();
    let tolerance = recording_part::tolerance();
    assert_eq!(law.modes(), [Mode::SlipLeft]);
    assert_eq!(law.conditions(Mode::Open, &start)[1].value, MARKER_VALUE);
    let next_mode = law.next_mode(Mode::Open, &start, &ContactState::default(), tolerance);
    assert_eq!(next_mode, Mode::SlipRight);
    assert_eq!(law.compliance(Mode::Open, &start), [MARKER_VALUE; 2]);
    let mut variables = [0.0; 3];
    assert_eq!(law.state_variables(), variables.len());
    law.initial_state_variables(&start, &mut variables);
    assert_eq!(variables, [MARKER_VALUE; 3]);
    law.commit(&start, &ContactState::default(), Mode::Open, &mut variables);
    assert_eq!(variables, [2.0 * MARKER_VALUE; 3]);
    assert_eq!(law.friction_coefficient(), Some(MARKER_VALUE));
    assert_eq!(law.bond_overload(&start, &ContactState::default()), Some(MARKER_VALUE));
    assert_eq!(law.check_start(&start), Err(recording_part::part_error()));
    assert_eq!(law.frictionless().modes(), [Mode::SlipRight]);
    // Only a simulation can make the argument of `check`.
    let ground = SpringGround::new(-2.0..2.0, 4, 1e7, 1e7).unwrap();
    let result = Simulation::builder(0.01)
        .structure(RigidBlock::new(4.0, 4.0, 2000.0).unwrap())
        .ground(ground)
        .interface(new_law())
        .build();
    assert_eq!(result.err(), Some(recording_part::part_error()));
}

#[test]
fn boxed_laws_forward_all_methods() {
    let log = CallLog::default();
    let law: Box<dyn InterfaceLaw> = Box::new(RecordingPart::new(&log));
    let limits = law.limits(&recording_part::previous_contact()).unwrap();
    assert_eq!(limits.tension, MARKER_VALUE);
    call_law_methods(|| -> Box<dyn InterfaceLaw> { Box::new(RecordingPart::new(&log)) });
    assert_eq!(log.take(), methods(source!("interface/mod.rs"), "InterfaceLaw"));
}

#[test]
fn laws_of_the_plane_forward_all_methods() {
    let log = CallLog::default();
    call_law_methods(|| InPlane(RecordingPart::new(&log)));
    assert_eq!(log.take(), methods(source!("interface/plane_law.rs"), "PlaneLaw"));
    let law = InPlane(RecordingPart::new(&log));
    let error = law.limits(&recording_part::previous_contact()).unwrap_err();
    assert!(matches!(error, Error::Scene { quantity: "RecordingPart", .. }), "{error}");
}

#[test]
fn boxed_grounds_forward_all_methods() {
    fn call_methods(mut part: impl Ground) {
        let mut matrix = [0.0; 4];
        assert_eq!(part.elements().len(), 1);
        assert_eq!(
            part.prepare(MARKER_VALUE, None, &mut unobserved),
            Err(recording_part::part_error())
        );
        part.step_compliance(&mut matrix).unwrap();
        assert_eq!(matrix, [MARKER_VALUE; 4]);
        part.history(&mut matrix[..2]).unwrap();
        part.commit(&[1.0, 2.0]);
        part.static_compliance(&mut matrix).unwrap();
        assert_eq!(matrix, [3.0 * MARKER_VALUE; 4]);
        assert_eq!(part.diagonal_compliance().unwrap().unwrap().in_step, [MARKER_VALUE]);
        assert_eq!(part.finer_compliance(), Ok(Some(vec![MARKER_VALUE])));
        assert_eq!(part.description().soils, [recording_part::soil()]);
        assert_eq!(part.increment_error_bound(), MARKER_VALUE);
        assert_eq!(part.save(), Ok(vec![MARKER_VALUE]));
        assert_eq!(part.restore(1, &[1.0]), Err(recording_part::part_error()));
        part.free_field(&AtRest, 1.0, &mut matrix[..2]);
        assert_eq!(matrix[..2], [4.0 * MARKER_VALUE; 2]);
    }
    let log = CallLog::default();
    let part: Box<dyn Ground> = Box::new(RecordingPart::new(&log));
    call_methods(part);
    assert_eq!(log.take(), methods(source!("bem/mod.rs"), "Ground"));
}

#[test]
fn boxed_motions_forward_all_methods() {
    fn call_methods(part: impl FreeField) {
        assert_eq!(part.displacement(3.0, 1.0), [3.0, MARKER_VALUE]);
        assert_eq!(part.displacement_at([3.0, 2.0], 1.0), [3.0, 2.0, MARKER_VALUE]);
        let mut displacement = [0.0];
        let mut impulse = [0.0];
        assert!(part.at_faces(&[], 3.0, &mut displacement, &mut impulse));
        assert_eq!([displacement, impulse], [[3.0], [MARKER_VALUE]]);
        assert_eq!(part.soils(), Some(&[MARKER_VALUE][..]));
        assert_eq!(part.elements(), Some(&[][..]));
        assert!(part.moves_across() && part.records().is_empty());
        assert_eq!(part.velocity(3.0, 1.0), [MARKER_VALUE, 3.0]);
    }
    let log = CallLog::default();
    let part: Box<dyn FreeField> = Box::new(RecordingPart::new(&log));
    call_methods(part);
    assert_eq!(log.take(), methods(source!("motion/free_field.rs"), "FreeField"));
}

#[test]
fn boxed_incident_fields_forward_all_methods() {
    fn call_methods(part: impl IncidentField) {
        assert_eq!(part.displacement([3.0, 1.0], 1.0), [3.0, MARKER_VALUE]);
        assert_eq!(part.stress([3.0, 1.0], 1.0), [MARKER_VALUE, 3.0, 1.0]);
    }
    let log = CallLog::default();
    let part: Box<dyn IncidentField> = Box::new(RecordingPart::new(&log));
    call_methods(part);
    assert_eq!(log.take(), methods(source!("bem/full_plane/incident_field.rs"), "IncidentField"));
}

#[test]
fn boxed_histories_forward_all_methods() {
    fn call_methods(mut part: impl ConvolutionHistory) {
        let mut values = [0.0; 2];
        assert_eq!((part.steps(), part.memory()), (7, 5));
        assert_eq!(part.prepare(3, &mut unobserved), Err(recording_part::part_error()));
        part.evaluate(&mut values).unwrap();
        assert_eq!(values, [MARKER_VALUE; 2]);
        part.push(&values);
        assert_eq!(part.increment_error_bound(), MARKER_VALUE);
        assert_eq!(part.save(), Ok(vec![MARKER_VALUE]));
        assert_eq!(part.restore(1, &[1.0]), Err(recording_part::part_error()));
    }
    let log = CallLog::default();
    let part: Box<dyn ConvolutionHistory> = Box::new(RecordingPart::new(&log));
    call_methods(part);
    assert_eq!(log.take(), methods(source!("history/convolution.rs"), "ConvolutionHistory"));
}

#[test]
fn boxed_schemes_forward_all_methods() {
    fn call_methods(part: impl TimeScheme) {
        assert_eq!(part.coefficients(MARKER_VALUE).load_fraction, MARKER_VALUE);
    }
    let log = CallLog::default();
    let part: Box<dyn TimeScheme> = Box::new(RecordingPart::new(&log));
    call_methods(part);
    assert_eq!(log.take(), methods(source!("coupled/scheme/mod.rs"), "TimeScheme"));
}

#[test]
fn boxed_elements_forward_all_methods() {
    fn call_methods(part: impl Element) {
        let mut matrix = [0.0];
        assert_eq!(part.nodes(), [5]);
        assert_eq!(part.directions().len(), 2);
        part.stiffness(&[], &mut matrix);
        part.geometric_stiffness(&[], &mut matrix);
        part.mass(&[], MassKind::Lumped, &mut matrix);
        part.damping(&[], &mut matrix);
        assert_eq!(matrix, [10.0 * MARKER_VALUE]);
        assert!(part.in_static_state(&[], &[], 9.0).is_some());
        assert!(part.inelastic().is_none() && !part.has_stiffness_damping());
        let stress = StressAtRest::new(9.81, 1900.0, 0.5).unwrap();
        assert!(part.with_stress_at_rest(&stress).is_some() && part.is_at_rest());
        assert_eq!(part.compression(), Some(MARKER_VALUE));
        assert_eq!(part.density(), Some(MARKER_VALUE));
        assert!(part.with_nodes(&[6]).is_some() && part.with_nodes(&[5]).is_none());
        assert_eq!(part.faces(), [ElementFace::side(&[7])]);
        assert!(!part.is_plane());
        assert_eq!(part.check(&[]), Err(recording_part::part_error()));
        assert_eq!(part.order(), 11);
    }
    let log = CallLog::default();
    let part: Box<dyn Element> = Box::new(RecordingPart::new(&log));
    call_methods(part);
    assert_eq!(log.take(), methods(source!("../crates/structures/src/fem/element.rs"), "Element"));
}

#[test]
fn boxed_kernels_forward_all_methods() {
    fn call_methods(part: impl BoundaryKernel) {
        let mut g = [0.0];
        let mut h = [0.0];
        assert_eq!(part.segments().len(), 0);
        part.coefficients(2, &mut g, &mut h).unwrap();
        assert_eq!((g, h), ([2.0], [MARKER_VALUE]));
        assert_eq!(part.symbol([0.0; 2], &mut g, &mut h), Ok(Some([MARKER_VALUE; 2])));
    }
    let log = CallLog::default();
    let part: Box<dyn BoundaryKernel> = Box::new(RecordingPart::new(&log));
    call_methods(part);
    assert_eq!(log.take(), methods(source!("bem/full_plane/mod.rs"), "BoundaryKernel"));
}

#[test]
fn boxed_formats_forward_all_methods() {
    fn call_methods(part: impl RecordFormat) {
        assert_eq!(part.parse("", &mut &b""[..]), Err(recording_part::part_error()));
        assert_eq!(part.parse_all("", &mut &b""[..]), Err(recording_part::part_error()));
    }
    let log = CallLog::default();
    let part: Box<dyn RecordFormat> = Box::new(RecordingPart::new(&log));
    call_methods(part);
    assert_eq!(log.take(), methods(source!("../crates/records/src/format.rs"), "RecordFormat"));
}

fn half_plane() -> ElasticGround {
    let soil = Soil::new(40.0e6, 0.3, 1800.0).unwrap();
    ElasticGround::new(soil, Strip::uniform(-2.0..2.0, 6).unwrap()).unwrap()
}

/// GOAL: a simulation of boxed parts is that of the parts themselves.
#[test]
fn parts_chosen_at_run_time_make_the_same_simulation() {
    let block = RigidBlock::new(4.0, 6.0, 2000.0).unwrap();
    let law = Coulomb::new(0.4).unwrap();
    let motion = RickerDisplacement::new(0.05, 0.12, 0.6).unwrap();
    let boxed_structure: Box<dyn Structure> = Box::new(block.clone());
    let boxed_ground: Box<dyn Ground> = Box::new(half_plane());
    let boxed_law: Box<dyn InterfaceLaw> = Box::new(law);
    let boxed_motion: Box<dyn FreeField> = Box::new(motion);
    let boxed_scheme: Box<dyn TimeScheme> = Box::new(Midpoint);
    let mut plain_simulation = Simulation::builder(0.005)
        .gravity(9.81)
        .structure(block)
        .ground(half_plane())
        .interface(law)
        .motion(motion)
        .build()
        .unwrap();
    let mut boxed = Simulation::builder(0.005)
        .gravity(9.81)
        .structure(boxed_structure)
        .ground(boxed_ground)
        .interface(boxed_law)
        .motion(boxed_motion)
        .scheme(boxed_scheme)
        .build()
        .unwrap();
    plain_simulation.run(200, |_| {}).unwrap();
    boxed.run(200, |_| {}).unwrap();
    assert_eq!(plain_simulation.state(), boxed.state());
    assert_eq!(plain_simulation.checkpoint(), boxed.checkpoint());
}
