//! GOAL: a boxed part behaves as the part itself, and a part made of another hands on every
//! question.
//! SCENE: doubles that answer every method of their trait with something else than its default and
//! write down what they were asked.
//! REFERENCE: the methods listed in the trait's source, so that a new one that nobody forwards is
//! found.
#![allow(clippy::needless_pass_by_value, reason = "parts are given away, as to a builder")]

mod doubles;
mod law;
mod log;
mod structure;

use basemat::bem::full_plane::{BoundaryKernel, IncidentField};
use basemat::bem::{Ground, SpringGround};
use basemat::coupled::TimeScheme;
use basemat::fem::{Element, ElementFace, MassKind};
use basemat::history::ConvolutionHistory;
use basemat::interface::{ContactState, InPlane, InterfaceLaw, Mode};
use basemat::motion::{AtRest, FreeField, RecordFormat};
use basemat::structure::{Hysteresis, RigidBlock, Structure};
use basemat::{Simulation, Soil, unobserved};

use doubles::{CORRECT, Double};
use log::{Log, methods, source};

#[test]
fn boxed_springs() {
    fn ask(mut part: impl Hysteresis) {
        assert_eq!(part.response(2.0).force, 2.0 * CORRECT);
        assert_eq!(part.energy(2.0).stored, 2.0 * CORRECT);
        part.commit(1.0);
        assert_eq!(part.save(), [CORRECT]);
        assert_eq!(part.restore(&[1.0]), Err(doubles::refusal()));
        drop(part.clone_box());
    }
    let log = Log::default();
    let part: Box<dyn Hysteresis> = Box::new(Double::new(&log));
    ask(part);
    assert_eq!(
        log.take(),
        methods(source!("../crates/structures/src/structure/hysteresis/mod.rs"), "Hysteresis")
    );
}

/// Calls all methods of a law but `limits`.
fn ask_law<L: InterfaceLaw + 'static>(make: impl Fn() -> L) {
    let part = make();
    let start = doubles::start();
    let tolerance = doubles::tolerance();
    assert_eq!(part.modes(), [Mode::SlipLeft]);
    assert_eq!(part.conditions(Mode::Open, &start)[1].value, CORRECT);
    let next = part.next_mode(Mode::Open, &start, &ContactState::default(), tolerance);
    assert_eq!(next, Mode::SlipRight);
    assert_eq!(part.compliance(Mode::Open, &start), [CORRECT; 2]);
    let mut memory = [0.0; 3];
    assert_eq!(part.state_variables(), memory.len());
    part.initial_state_variables(&start, &mut memory);
    assert_eq!(memory, [CORRECT; 3]);
    part.commit(&start, &ContactState::default(), Mode::Open, &mut memory);
    assert_eq!(memory, [2.0 * CORRECT; 3]);
    assert_eq!(part.friction_coefficient(), Some(CORRECT));
    assert_eq!(part.bond_overload(&start, &ContactState::default()), Some(CORRECT));
    assert_eq!(part.check_start(&start), Err(doubles::refusal()));
    assert_eq!(part.frictionless().modes(), [Mode::SlipRight]);
    // `check` has an argument that only a simulation can make.
    let ground = SpringGround::new(-2.0..2.0, 4, 1e7, 1e7).unwrap();
    let built = Simulation::builder(0.01)
        .structure(RigidBlock::new(4.0, 4.0, 2000.0).unwrap())
        .ground(ground)
        .interface(make())
        .build();
    assert_eq!(built.err(), Some(doubles::refusal()));
}

#[test]
fn boxed_laws() {
    let log = Log::default();
    let make = || -> Box<dyn InterfaceLaw> { Box::new(Double::new(&log)) };
    ask_law(make);
    assert_eq!(make().limits(&doubles::start()).unwrap().tension, CORRECT);
    assert_eq!(log.take(), methods(source!("interface/mod.rs"), "InterfaceLaw"));
}

#[test]
fn laws_of_the_plane() {
    let log = Log::default();
    let make = || InPlane(Double::new(&log));
    ask_law(make);
    assert_eq!(log.take(), methods(source!("interface/plane_law.rs"), "PlaneLaw"));
    let error = make().limits(&doubles::start()).unwrap_err();
    assert!(matches!(error, basemat::Error::Scene { quantity: "Double", .. }), "{error}");
}

#[test]
fn boxed_grounds() {
    fn ask(mut part: impl Ground) {
        let mut matrix = [0.0; 4];
        assert_eq!(part.elements().len(), 1);
        assert_eq!(part.prepare(CORRECT, None, &mut unobserved), Err(doubles::refusal()));
        part.step_compliance(&mut matrix).unwrap();
        assert_eq!(matrix, [CORRECT; 4]);
        part.history(&mut matrix[..2]).unwrap();
        part.commit(&[1.0, 2.0]);
        part.static_compliance(&mut matrix).unwrap();
        assert_eq!(matrix, [3.0 * CORRECT; 4]);
        assert_eq!(part.diagonal_compliance().unwrap().unwrap().in_step, [CORRECT]);
        assert_eq!(part.finer_compliance(), Ok(Some(vec![CORRECT])));
        assert_eq!(part.description().soils, [doubles::soil()]);
        assert_eq!(part.increment_error_bound(), CORRECT);
        assert_eq!(part.save(), Ok(vec![CORRECT]));
        assert_eq!(part.restore(1, &[1.0]), Err(doubles::refusal()));
        part.free_field(&AtRest, 1.0, &mut matrix[..2]);
        assert_eq!(matrix[..2], [4.0 * CORRECT; 2]);
    }
    let log = Log::default();
    let part: Box<dyn Ground> = Box::new(Double::new(&log));
    ask(part);
    assert_eq!(log.take(), methods(source!("bem/mod.rs"), "Ground"));
}

#[test]
fn boxed_motions() {
    fn ask(part: impl FreeField) {
        assert_eq!(part.displacement(3.0, 1.0), [3.0, CORRECT]);
        assert_eq!(part.displacement_at([3.0, 2.0], 1.0), [3.0, 2.0, CORRECT]);
        let [mut moved, mut impulse] = [[0.0]; 2];
        assert!(part.at_faces(&[], 3.0, &mut moved, &mut impulse));
        assert_eq!([moved, impulse], [[3.0], [CORRECT]]);
        assert_eq!(part.soils(), Some(&[CORRECT][..]));
        assert!(part.moves_across() && part.records().is_empty());
        assert_eq!(part.velocity(3.0, 1.0), [CORRECT, 3.0]);
    }
    let log = Log::default();
    let part: Box<dyn FreeField> = Box::new(Double::new(&log));
    ask(part);
    assert_eq!(log.take(), methods(source!("motion/free_field.rs"), "FreeField"));
}

#[test]
fn boxed_incident_fields() {
    fn ask(part: impl IncidentField) {
        assert_eq!(part.displacement([3.0, 1.0], 1.0), [3.0, CORRECT]);
        assert_eq!(part.stress([3.0, 1.0], 1.0), [CORRECT, 3.0, 1.0]);
    }
    let log = Log::default();
    let part: Box<dyn IncidentField> = Box::new(Double::new(&log));
    ask(part);
    assert_eq!(log.take(), methods(source!("bem/full_plane/incident_field.rs"), "IncidentField"));
}

#[test]
fn boxed_histories() {
    fn ask(mut part: impl ConvolutionHistory) {
        let mut values = [0.0; 2];
        assert_eq!((part.steps(), part.memory()), (7, 5));
        assert_eq!(part.prepare(3, &mut unobserved), Err(doubles::refusal()));
        part.evaluate(&mut values).unwrap();
        assert_eq!(values, [CORRECT; 2]);
        part.push(&values);
        assert_eq!(part.increment_error_bound(), CORRECT);
        assert_eq!(part.save(), Ok(vec![CORRECT]));
        assert_eq!(part.restore(1, &[1.0]), Err(doubles::refusal()));
    }
    let log = Log::default();
    let part: Box<dyn ConvolutionHistory> = Box::new(Double::new(&log));
    ask(part);
    assert_eq!(log.take(), methods(source!("history/convolution.rs"), "ConvolutionHistory"));
}

#[test]
fn boxed_schemes() {
    fn ask(part: impl TimeScheme) {
        assert_eq!(part.coefficients(CORRECT).load_fraction, CORRECT);
    }
    let log = Log::default();
    let part: Box<dyn TimeScheme> = Box::new(Double::new(&log));
    ask(part);
    assert_eq!(log.take(), methods(source!("coupled/scheme/mod.rs"), "TimeScheme"));
}

#[test]
fn boxed_elements() {
    fn ask(part: impl Element) {
        let mut matrix = [0.0];
        assert_eq!(part.nodes(), [5]);
        assert_eq!(part.directions().len(), 2);
        part.stiffness(&[], &mut matrix);
        part.geometric_stiffness(&[], &mut matrix);
        part.mass(&[], MassKind::Lumped, &mut matrix);
        part.damping(&[], &mut matrix);
        assert_eq!(matrix, [10.0 * CORRECT]);
        assert!(part.in_static_state(&[], &[], 9.0).is_some());
        assert_eq!(part.compression(), Some(CORRECT));
        assert_eq!(part.density(), Some(CORRECT));
        assert!(part.with_nodes(&[6]).is_some() && part.with_nodes(&[5]).is_none());
        assert_eq!(part.faces(), [ElementFace::side(&[7])]);
        assert!(!part.is_plane());
        assert_eq!(part.check(&[]), Err(doubles::refusal()));
        assert_eq!(part.order(), 11);
    }
    let log = Log::default();
    let part: Box<dyn Element> = Box::new(Double::new(&log));
    ask(part);
    assert_eq!(log.take(), methods(source!("../crates/structures/src/fem/element.rs"), "Element"));
}

#[test]
fn boxed_kernels() {
    fn ask(part: impl BoundaryKernel) {
        let (mut g, mut h) = ([0.0], [0.0]);
        assert_eq!(part.segments().len(), 0);
        part.coefficients(2, &mut g, &mut h).unwrap();
        assert_eq!((g, h), ([2.0], [CORRECT]));
        assert_eq!(part.symbol([0.0; 2], &mut g, &mut h), Ok(Some([CORRECT; 2])));
    }
    let log = Log::default();
    let part: Box<dyn BoundaryKernel> = Box::new(Double::new(&log));
    ask(part);
    assert_eq!(log.take(), methods(source!("bem/full_plane/mod.rs"), "BoundaryKernel"));
}

#[test]
fn boxed_formats() {
    fn ask(part: impl RecordFormat) {
        assert_eq!(part.parse("", &mut &b""[..]), Err(doubles::refusal()));
        assert_eq!(part.parse_all("", &mut &b""[..]), Err(doubles::refusal()));
    }
    let log = Log::default();
    let part: Box<dyn RecordFormat> = Box::new(Double::new(&log));
    ask(part);
    assert_eq!(log.take(), methods(source!("../crates/records/src/format.rs"), "RecordFormat"));
}

/// GOAL: parts chosen at run time make a simulation, the same one.
#[test]
fn parts_chosen_at_run_time() {
    let soil = Soil::new(40.0e6, 0.3, 1800.0).unwrap();
    let motion = basemat::motion::RickerDisplacement::new(0.05, 0.12, 0.6).unwrap();
    let block = || RigidBlock::new(4.0, 6.0, 2000.0).unwrap();
    let ground = || {
        basemat::bem::ElasticGround::new(soil, basemat::bem::Strip::uniform(-2.0..2.0, 6).unwrap())
            .unwrap()
    };
    let law = || basemat::interface::Coulomb::new(0.4).unwrap();
    let builder = || Simulation::builder(0.005).gravity(9.81);
    let plain = builder().structure(block()).ground(ground()).interface(law()).motion(motion);
    let structure: Box<dyn Structure> = Box::new(block());
    let boxed_ground: Box<dyn Ground> = Box::new(ground());
    let boxed_law: Box<dyn InterfaceLaw> = Box::new(law());
    let boxed_motion: Box<dyn FreeField> = Box::new(motion);
    let boxed_scheme: Box<dyn TimeScheme> = Box::new(basemat::coupled::Midpoint);
    let boxed = builder()
        .structure(structure)
        .ground(boxed_ground)
        .interface(boxed_law)
        .motion(boxed_motion)
        .scheme(boxed_scheme);
    let (mut plain, mut boxed) = (plain.build().unwrap(), boxed.build().unwrap());
    plain.run(200, |_| {}).unwrap();
    boxed.run(200, |_| {}).unwrap();
    assert_eq!(plain.state(), boxed.state());
    assert_eq!(plain.checkpoint(), boxed.checkpoint());
}
