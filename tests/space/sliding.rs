//! Sliding in space against the plane and a bonded base; bonds that break; loads at the start.

use basemat::bem::ElasticGround;
use basemat::coupled::{GravityStage, Load, SimulationBuilder, StabilityError, State, StepError};
use basemat::interface::{
    Bonded, Cohesive, Condition, ContactState, Coulomb, InPlane, InterfaceLaw, Mode, PlaneLaw,
    PreviousContact, ThinLayer, Tolerance, UnilateralCondition, VariableFriction, Yielding,
};
use basemat::motion::{Record, Triaxial, el_centro_1940};
use basemat::structure::RigidBody;
use basemat::{Error, Result, Simulation, Soil};

use super::cells::{BED_PROPERTIES, CrossingPulses, SpringCells, equal_in_slices, plane_and_slice};

pub(super) type BoxedLaw = Box<dyn InterfaceLaw>;

fn coulomb(friction: f64) -> BoxedLaw {
    Box::new(Coulomb::new(friction).unwrap())
}

/// Friction with unilateral contact enforced on the rate of the gap.
fn coulomb_by_velocity() -> BoxedLaw {
    let condition = UnilateralCondition::Velocity { closed_below: 1e-6 };
    Box::new(Coulomb::new(0.4).unwrap().with_unilateral_condition(condition).unwrap())
}

/// Friction that falls with the slip rate.
fn slowing_friction() -> BoxedLaw {
    Box::new(VariableFriction::new(|start: &PreviousContact| {
        0.2 + 0.2 * (-start.slip_rate.abs() / 0.1).exp()
    }))
}

/// A layer with friction.
pub(super) fn thin_layer(friction: f64) -> BoxedLaw {
    let layer = ThinLayer::from_stiffness(4e8, 2e8, friction).unwrap();
    Box::new(layer.with_debonded_ratio(0.0).unwrap())
}

/// A scene pushed along x.
fn build_pushed(scene: SimulationBuilder, stage: GravityStage) -> Simulation {
    let push = Load::new(0, |time: f64| 2.0e4 * (1.0 + (20.0 * time).sin()));
    scene.gravity_stage(stage).load(push).build().unwrap()
}

/// Numbers of open, sliding and yielding elements, over all steps.
#[derive(Debug, Default)]
struct ModeCounts {
    open_count: usize,
    slip: usize,
    yielding_count: usize,
}

impl ModeCounts {
    fn add(&mut self, state: &State) {
        for mode in &state.modes {
            self.open_count += usize::from(*mode == Mode::Open);
            self.slip += usize::from(mode.is_slip());
            self.yielding_count += usize::from(mode.to_string().contains("yield"));
        }
    }
}

/// With every law, a slice that moves along x moves as the block of the plane.
#[test]
fn a_slice_lifts_and_slides_as_the_block_of_the_plane() {
    let laws: [(&str, &dyn Fn() -> BoxedLaw); 9] = [
        ("friction 0.3", &|| coulomb(0.3)),
        ("friction 2", &|| coulomb(2.0)),
        ("frictionless", &|| coulomb(0.0)),
        ("uplift only", &|| coulomb(f64::INFINITY)),
        ("velocity", &coulomb_by_velocity),
        ("tensile strength", &|| {
            Box::new(Coulomb::new(0.5).unwrap().with_tensile_strength(2e4).unwrap())
        }),
        ("variable", &slowing_friction),
        ("yielding", &|| Box::new(Yielding::new(2.2e5, 0.4).unwrap())),
        ("thin layer", &|| thin_layer(0.4)),
    ];
    for (name, law) in laws {
        // A base without friction does not resist the load at t = 0.
        let stage = match name {
            "frictionless" => GravityStage::Unloaded,
            _ => GravityStage::Frictionless,
        };
        let motion = el_centro_1940().scaled(2.0).unwrap();
        let scenes = plane_and_slice(law, &motion, 4e-3);
        let mut plane = build_pushed(scenes.plane, stage);
        let mut slice = build_pushed(scenes.slice, stage);
        let mut max_values = [0.0_f64; 6];
        let mut max_errors = [0.0_f64; 6];
        let mut counts = ModeCounts::default();
        for _ in 0..700 {
            let expected = plane.step().unwrap();
            let computed = slice.step().unwrap();
            let mut pairs = equal_in_slices(expected, computed, 1e-12).to_vec();
            pairs.push([expected.mean_slip, computed.mean_slip]);
            pairs.push([expected.energy_balance.contact, computed.energy_balance.contact]);
            for (k, [expected, computed]) in pairs.into_iter().enumerate() {
                max_values[k] = max_values[k].max(expected.abs());
                max_errors[k] = max_errors[k].max((expected - computed).abs());
            }
            assert!(computed.energy_balance.residual() < 1e-9, "{name}");
            counts.add(computed);
        }
        println!("{name}: {counts:?}, {max_errors:?} of {max_values:?}");
        assert!(counts.open_count > 0 || name == "frictionless", "{name} opens");
        assert!(counts.slip > 0 || name == "uplift only", "{name} slides");
        assert!((counts.yielding_count > 0) == (name == "yielding"), "{name} yields");
        for (error, value) in max_errors.iter().zip(max_values) {
            assert!(*error <= 1e-7 * value.max(1e-6), "{name}: {max_errors:?} of {max_values:?}");
        }
    }
}

const BODY_SIDES: [f64; 3] = [6.0, 6.0, 3.0];
pub(super) const BODY_WEIGHT: f64 = 9.80665 * 2000.0 * (6.0 * 6.0 * 3.0);

pub(super) fn body() -> RigidBody {
    RigidBody::cuboid(BODY_SIDES, 2000.0).unwrap()
}

/// Cells under the body.
pub(super) fn cells() -> SpringCells {
    SpringCells::under([6.0; 2], [0.0; 2], [4, 4], BED_PROPERTIES)
}

fn scaled_record(factor: f64) -> Record {
    el_centro_1940().scaled(factor).unwrap()
}

/// The body on an isotropic bed, shaken in three directions.
fn scene(law: impl InterfaceLaw + 'static, time_step: f64, scale: f64) -> Result<Simulation> {
    let motion = Triaxial {
        x: Some(scaled_record(1.0 * scale)),
        y: Some(scaled_record(-0.7 * scale)),
        up: Some(scaled_record(0.3 * scale)),
    };
    Simulation::builder(time_step)
        .structure(body())
        .ground(SpringCells::under([6.0; 2], [0.0; 2], [4, 4], BED_PROPERTIES.isotropic()))
        .interface(law)
        .motion(motion)
        .build()
}

/// Steps a scene whose elements stick, and the same scene bonded.
fn assert_moves_as_bonded(mut bonded: Simulation, mut sticking: Simulation) {
    let mut max_displacement = 0.0_f64;
    let mut max_velocity = 0.0_f64;
    for _ in 0..500 {
        let expected = bonded.step().unwrap();
        let computed = sticking.step().unwrap();
        assert!(computed.modes.iter().all(|mode| *mode == Mode::Stick));
        max_displacement =
            expected.displacement().iter().fold(max_displacement, |max, u| max.max(u.abs()));
        max_velocity = expected.velocity().iter().fold(max_velocity, |max, v| max.max(v.abs()));
        for (x, y) in expected.displacement().iter().zip(computed.displacement()) {
            assert!((x - y).abs() <= 1e-10 * max_displacement, "{x} {y}");
        }
        for (x, y) in expected.velocity().iter().zip(computed.velocity()) {
            assert!((x - y).abs() <= 1e-10 * max_velocity, "{x} {y}");
        }
    }
}

#[test]
fn a_cone_that_sticks_is_bonded() {
    let cohesive = Cohesive::new(1e9, 1e9, 0.5).unwrap();
    let sticking = scene(cohesive, 4e-3, 1.0).unwrap();
    assert_moves_as_bonded(scene(Bonded, 4e-3, 1.0).unwrap(), sticking);
    let sticking = scene(Coulomb::new(50.0).unwrap(), 4e-3, 0.2).unwrap();
    assert_moves_as_bonded(scene(Bonded, 4e-3, 0.2).unwrap(), sticking);
}

/// Displacement after 500 steps on a contact without friction that never opens.
fn displacement_with_strength(tensile_strength: f64) -> Vec<f64> {
    let law = Coulomb::new(0.0).unwrap().with_tensile_strength(tensile_strength).unwrap();
    let mut simulation = scene(law, 4e-3, 1.0).unwrap();
    simulation.run(500, |_| {}).unwrap();
    assert!(simulation.state().modes.iter().all(|mode| mode.is_slip()));
    simulation.state().displacement().to_vec()
}

/// Strengths that no force reaches change neither results nor their accuracy.
#[test]
fn unlimited_strength_is_a_strength_never_reached() {
    let expected = displacement_with_strength(1e6);
    let size = expected.iter().fold(0.0_f64, |max, u| max.max(u.abs()));
    for strength in [1e12, 1e20] {
        let computed = displacement_with_strength(strength);
        for (a, b) in expected.iter().zip(&computed) {
            assert!((a - b).abs() < 1e-9 * size, "{strength:e}: {a} {b}");
        }
    }
}

/// A motion may begin with subnormal numbers, as a Ricker pulse does.
#[test]
fn bonds_hold_under_motions_that_underflow() {
    let soil = Soil::new(1e8, 0.3, 2000.0).unwrap();
    for scale in [1e-290, 1e-304, 1e-308, 1e-312, 1e-316] {
        let motion = Triaxial {
            x: Some(scaled_record(scale)),
            y: Some(scaled_record(scale)),
            up: Some(scaled_record(scale)),
        };
        let mut simulation = Simulation::builder(0.01)
            .ground(ElasticGround::under(soil, &body(), 7).unwrap())
            .structure(body())
            .gravity(0.0)
            .interface(Coulomb::new(0.0).unwrap().with_tensile_strength(1e9).unwrap())
            .motion(motion)
            .build()
            .unwrap();
        for _ in 0..50 {
            let trials = simulation.step().map(|state| state.trials);
            assert!(trials.is_ok(), "{scale:e}: {trials:?}");
        }
    }
}

#[test]
fn a_run_that_slides_resumes_to_the_last_bit() {
    let laws: [&dyn Fn() -> BoxedLaw; 3] =
        [&|| coulomb(0.3), &|| Box::new(Yielding::new(9e4, 0.3).unwrap()), &|| {
            Box::new(Cohesive::new(2e4, 3e4, 0.4).unwrap())
        }];
    for law in laws {
        let mut uninterrupted_simulation = scene(law(), 4e-3, 2.0).unwrap();
        let run = uninterrupted_simulation.run(450, |_| {}).unwrap();
        assert!(run.energy_error < 1e-9 && run.whole.largest_slip.magnitude() > 1e-3);
        let checkpoint = uninterrupted_simulation.checkpoint().unwrap();
        uninterrupted_simulation.run(200, |_| {}).unwrap();
        let mut resumed_simulation = scene(law(), 4e-3, 2.0).unwrap();
        resumed_simulation.resume(&checkpoint).unwrap();
        resumed_simulation.run(200, |_| {}).unwrap();
        assert_eq!(resumed_simulation.state(), uninterrupted_simulation.state());
    }
}

/// Number of elements whose bond has not broken.
fn bonded_count(state: &State) -> usize {
    (0..16).filter(|element| state.state_variables(*element) == [1.0]).count()
}

/// Bonds break for good, within a step; friction remains.
#[test]
fn bonds_break_one_after_the_other() {
    const TENSILE_STRENGTH: f64 = 2e4;
    const SHEAR_COHESION: f64 = 3e4;
    let law = Cohesive::new(TENSILE_STRENGTH, SHEAR_COHESION, 0.4).unwrap();
    let mut simulation = scene(law, 2e-3, 2.0).unwrap();
    assert_eq!(bonded_count(simulation.state()), 16);
    let mut bonded = 16;
    let mut breaking_steps = 0;
    for _ in 0..1500 {
        let state = simulation.step().unwrap();
        for contact in &state.contact {
            let shear_limit = SHEAR_COHESION + 0.4 * contact.pressure.max(0.0);
            let shear = contact.shear.hypot(contact.shear_across);
            assert!(contact.pressure >= -TENSILE_STRENGTH * (1.0 + 1e-9), "{contact:?}");
            assert!(shear <= shear_limit * (1.0 + 1e-9), "{contact:?}");
        }
        assert!(state.energy_balance.residual() < 1e-9);
        let still_bonded = bonded_count(state);
        assert!(still_bonded <= bonded);
        breaking_steps += usize::from(still_bonded < bonded);
        bonded = still_bonded;
    }
    assert!(breaking_steps > 1 && bonded < 16, "{breaking_steps} {bonded}");
}

/// A law without limits.
struct PlaneOnlyLaw;

impl PlaneLaw for PlaneOnlyLaw {
    fn modes(&self) -> &[Mode] {
        &[Mode::Stick]
    }

    fn conditions(&self, mode: Mode, start: &PreviousContact) -> [Condition; 2] {
        Bonded.conditions(mode, start)
    }

    fn next_mode(&self, _: Mode, _: &PreviousContact, _: &ContactState, _: Tolerance) -> Mode {
        Mode::Stick
    }
}

/// A law of the plane alone, and one whose open elements transmit pressure.
#[test]
fn laws_without_limits_in_space_are_named_in_their_error() {
    let error = scene(InPlane(PlaneOnlyLaw), 4e-3, 1.0).unwrap_err();
    assert!(matches!(error, Error::Scene { quantity: "PlaneOnlyLaw", .. }), "{error}");
    let layer = ThinLayer::from_stiffness(4e8, 2e8, 0.4).unwrap();
    let error = scene(layer, 4e-3, 1.0).unwrap_err();
    assert!(error.to_string().contains("with_debonded_ratio"), "{error}");
    // Friction that becomes NaN at some step is an error.
    let law = VariableFriction::new(|start| if start.slip_rate > 0.05 { f64::NAN } else { 0.2 });
    let mut simulation = scene(law, 4e-3, 2.0).unwrap();
    let error = simulation.run(1000, |_| {}).unwrap_err();
    let Error::Step { source: StepError::Law(_), .. } = &error else {
        panic!("{error}")
    };
    assert!(error.to_string().contains("friction coefficient"), "{error}");
}

/// The body under an oblique load from t = 0, of `weights` times its weight.
fn build_with_load(weights: f64) -> Result<Simulation> {
    Simulation::builder(4e-3)
        .structure(body())
        .ground(cells())
        .interface(Coulomb::new(0.5).unwrap())
        .load(Load::new(0, move |_| 0.6 * weights * BODY_WEIGHT))
        .load(Load::new(1, move |_| -0.8 * weights * BODY_WEIGHT))
        .build()
}

/// The stability error of a scene.
fn stability_error(result: Result<Simulation>) -> StabilityError {
    let Error::Stability(cause) = result.unwrap_err() else {
        panic!("another error")
    };
    *cause
}

/// Loads at t = 0 are carried by friction, and the base stays at rest until the loads change.
#[test]
fn loads_at_the_start_are_carried_by_friction() {
    let mut simulation = build_with_load(0.4).unwrap();
    let foundation = &simulation.state().foundations[0];
    let tolerance = 1e-9 * BODY_WEIGHT;
    let along = 0.6 * 0.4 * BODY_WEIGHT;
    let across = 0.8 * 0.4 * BODY_WEIGHT;
    assert!((foundation.base_shear - along).abs() < tolerance, "{foundation:?}");
    assert!((foundation.shear_across + across).abs() < tolerance, "{foundation:?}");
    assert!((foundation.normal_force - BODY_WEIGHT).abs() < tolerance);
    for contact in &simulation.state().contact {
        let shear = contact.shear.hypot(contact.shear_across);
        assert!(shear <= 0.5 * contact.pressure * (1.0 + 1e-9));
    }
    let run = simulation.run(100, |_| {}).unwrap();
    assert!(run.whole.largest_slip.magnitude() < 1e-12 && run.energy_error < 1e-9);
    // A load beyond friction.
    let cause = stability_error(build_with_load(0.6));
    let StabilityError::Sliding { ratio, .. } = cause else { panic!("{cause}") };
    assert!((ratio - 1.2).abs() < 1e-9, "{ratio}");
}

/// A moment about either axis, whose resultant with the weight is outside the base.
#[test]
fn moments_overturn_about_either_axis() {
    for (dof, sign) in [(3, 1.0), (3, -1.0), (4, 1.0)] {
        let result = Simulation::builder(4e-3)
            .structure(body())
            .ground(cells())
            .interface(Coulomb::new(0.5).unwrap())
            .load(Load::new(dof, move |_| 3.6 * sign * BODY_WEIGHT))
            .build();
        let cause = stability_error(result);
        let StabilityError::Overturning { ratio, .. } = cause else {
            panic!("{cause}")
        };
        assert!((ratio - 1.2).abs() < 1e-9, "{ratio}");
    }
}

/// A wave that runs across the mat.
#[test]
fn travelling_waves_slide_a_base() {
    let mut simulation = Simulation::builder(2e-3)
        .structure(RigidBody::cuboid([6.0, 6.0, 9.0], 2000.0).unwrap())
        .ground(cells())
        .interface(Coulomb::new(0.02).unwrap())
        .motion(CrossingPulses { quarter_turns: 0 })
        .build()
        .unwrap();
    let run = simulation.run(400, |_| {}).unwrap();
    assert!(run.energy_error < 1e-9 && run.whole.largest_slip.magnitude() > 1e-5);
    // The mat has turned.
    assert!(simulation.state().displacement()[5].abs() > 1e-7);
}
