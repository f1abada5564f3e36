//! Sliding in plan against the plane, Newmark's block, a bonded base and a ground that moves in a circle.

use std::f64::consts::PI;

use basemat::bem::ElasticGround;
use basemat::coupled::{GravityStage, Load};
use basemat::coupled::{StabilityError, StepError};
use basemat::interface::{
    Bonded, Cohesive, Condition, ContactState, Coulomb, InPlane, InterfaceLaw, Mode, PlaneLaw,
    PreviousContact, ThinLayer, Tolerance, UnilateralCondition, VariableFriction, Yielding,
};
use basemat::motion::{FreeField, STANDARD_GRAVITY, Triaxial, el_centro_1940};
use basemat::reference::SlidingBlock;
use basemat::structure::RigidBody;
use basemat::{Result, Simulation, Soil};

use basemat_problems::series::{Error, whole};
use basemat_problems::table;

use super::cells::{BED, Bed, Cells, Waves, equal_in_slices, slices};

type Law = Box<dyn InterfaceLaw>;

/// A block of the plane and a slice, pushed and shaken.
fn both(law: impl Fn() -> Law, stage: GravityStage) -> [Simulation; 2] {
    let push = |t: f64| 2.0e4 * (1.0 + (20.0 * t).sin());
    let motion = el_centro_1940().scaled(2.0).unwrap();
    let scenes = slices(law, &motion, 4e-3);
    scenes.map(|scene| scene.gravity_stage(stage).load(Load::new(0, push)).build().unwrap())
}

/// Every law, in a slice that moves along x alone, does what it does in the plane.
#[test]
fn a_slice_lifts_and_slides_as_the_block_of_the_plane() {
    let coulomb = |friction| Box::new(Coulomb::new(friction).unwrap());
    let layer = || ThinLayer::from_stiffness(4e8, 2e8, 0.4).unwrap().with_debonded_ratio(0.0);
    let slowing = |start: &basemat::interface::PreviousContact| {
        0.2 + 0.2 * (-start.slip_rate.abs() / 0.1).exp()
    };
    let velocity = UnilateralCondition::Velocity { closed_below: 1e-6 };
    let laws: [(&str, &dyn Fn() -> Law); 9] = [
        ("friction 0.3", &|| coulomb(0.3)),
        ("friction 2", &|| coulomb(2.0)),
        ("smooth", &|| coulomb(0.0)),
        ("uplift only", &|| coulomb(f64::INFINITY)),
        ("velocity", &|| {
            Box::new(Coulomb::new(0.4).unwrap().with_unilateral_condition(velocity).unwrap())
        }),
        ("tensile strength", &|| {
            Box::new(Coulomb::new(0.5).unwrap().with_tensile_strength(2e4).unwrap())
        }),
        ("variable", &move || Box::new(VariableFriction::new(slowing))),
        ("yielding", &|| Box::new(Yielding::new(2.2e5, 0.4).unwrap())),
        ("thin layer", &move || Box::new(layer().unwrap())),
    ];
    for (name, law) in laws {
        // A base without friction has nothing against the load at t = 0.
        let stage = match name {
            "smooth" => GravityStage::Unloaded,
            _ => GravityStage::Frictionless,
        };
        let [mut plane, mut space] = both(law, stage);
        let (mut largest, mut errors) = ([0.0_f64; 6], [0.0_f64; 6]);
        let (mut open, mut slides, mut yields) = (0, 0, 0);
        for _ in 0..700 {
            let (a, b) = (plane.step().unwrap(), space.step().unwrap());
            let more =
                [[a.mean_slip, b.mean_slip], [a.energy_balance.contact, b.energy_balance.contact]];
            for (k, [plane, space]) in
                equal_in_slices(a, b, 1e-12).into_iter().chain(more).enumerate()
            {
                largest[k] = largest[k].max(plane.abs());
                errors[k] = errors[k].max((plane - space).abs());
            }
            assert!(b.energy_balance.residual() < 1e-9, "{name}");
            open += b.modes.iter().filter(|mode| **mode == Mode::Open).count();
            slides += b.modes.iter().filter(|mode| mode.is_slip()).count();
            yields += b.modes.iter().filter(|mode| mode.to_string().contains("yield")).count();
        }
        println!(
            "{name}: open {open}, slides {slides}, yields {yields}, {errors:?} of {largest:?}"
        );
        assert!(open > 0 || name == "smooth", "{name} opens");
        assert!(slides > 0 || name == "uplift only", "{name} slides");
        assert!((yields > 0) == (name == "yielding"), "{name} yields");
        for (error, largest) in errors.iter().zip(largest) {
            assert!(*error <= 1e-7 * largest.max(1e-6), "{name}: {errors:?} of {largest:?}");
        }
    }
}

const CUBE: [f64; 3] = [6.0, 6.0, 3.0];

fn scene(law: impl InterfaceLaw + 'static, step: f64, scale: f64) -> Result<Simulation> {
    let motion = |factor: f64| Some(el_centro_1940().scaled(factor * scale).unwrap());
    let [k, c] = [BED.stiffness, BED.dashpot].map(|values| [values[0], values[1], values[1]]);
    Simulation::builder(step)
        .structure(RigidBody::cuboid(CUBE, 2000.0)?)
        .ground(Cells::under([6.0; 2], [0.0; 2], [4, 4], Bed { stiffness: k, dashpot: c }))
        .interface(law)
        .motion(Triaxial { x: motion(1.0), y: motion(-0.7), up: motion(0.3) })
        .build()
}

#[test]
fn a_cone_that_sticks_is_bonded() {
    let mut bonded = scene(Bonded, 4e-3, 1.0).unwrap();
    let cohesive = Cohesive::new(1e9, 1e9, 0.5).unwrap();
    let glued = [
        scene(cohesive, 4e-3, 1.0).unwrap(),
        scene(Coulomb::new(50.0).unwrap(), 4e-3, 0.2).unwrap(),
    ];
    let mut weak = scene(Bonded, 4e-3, 0.2).unwrap();
    for (mut other, reference) in glued.into_iter().zip([&mut bonded, &mut weak]) {
        let mut size = [0.0_f64; 2];
        for _ in 0..500 {
            let (a, b) = (reference.step().unwrap(), other.step().unwrap());
            assert!(b.modes.iter().all(|mode| *mode == Mode::Stick));
            for (k, values) in [a.displacement(), a.velocity()].into_iter().enumerate() {
                size[k] = values.iter().fold(size[k], |most, value| most.max(value.abs()));
            }
            let pairs = [(a.displacement(), b.displacement()), (a.velocity(), b.velocity())];
            for ((one, two), size) in pairs.into_iter().zip(size) {
                for (x, y) in one.iter().zip(two) {
                    assert!((x - y).abs() <= 1e-10 * size, "{one:?} {two:?}");
                }
            }
        }
    }
}

/// Strengths that no force reaches change neither results nor their accuracy.
#[test]
fn unlimited_strength_is_a_strength_never_reached() {
    let run = |strength: f64| {
        let law = Coulomb::new(0.0).unwrap().with_tensile_strength(strength).unwrap();
        let mut simulation = scene(law, 4e-3, 1.0).unwrap();
        simulation.run(500, |_| {}).unwrap();
        simulation
    };
    let known = run(1e6);
    assert!(known.state().modes.iter().all(|mode| mode.is_slip()));
    for strength in [1e12, 1e20] {
        let found = run(strength);
        let size = known.state().displacement().iter().fold(0.0_f64, |m, u| m.max(u.abs()));
        for (a, b) in known.state().displacement().iter().zip(found.state().displacement()) {
            assert!((a - b).abs() < 1e-9 * size, "{strength:e}: {a} {b}");
        }
    }
}

/// A motion may begin with numbers that are not normal, as the beginning of a Ricker pulse does.
#[test]
fn bonds_hold_under_motions_that_underflow() {
    let soil = Soil::new(1e8, 0.3, 2000.0).unwrap();
    for scale in [1e-290, 1e-304, 1e-308, 1e-312, 1e-316] {
        let body = RigidBody::cuboid(CUBE, 2000.0).unwrap();
        let motion = || Some(el_centro_1940().scaled(scale).unwrap());
        let mut simulation = Simulation::builder(0.01)
            .ground(ElasticGround::under(soil, &body, 7).unwrap())
            .structure(body)
            .gravity(0.0)
            .interface(Coulomb::new(0.0).unwrap().with_tensile_strength(1e9).unwrap())
            .motion(Triaxial { x: motion(), y: motion(), up: motion() })
            .build()
            .unwrap();
        for _ in 0..50 {
            let found = simulation.step().map(|state| state.trials);
            assert!(found.is_ok(), "{scale:e}: {found:?}");
        }
    }
}

/// GOAL: Newmark's sliding block (1965) in plan, along x, along y and askew.
/// SCENE: low block, 4 m square, on stiff soil under El Centro; the record of the direction of motion is the table's.
/// REFERENCE: `reference::SlidingBlock`, event by event, and `sliding_rigid_block.csv`, as in the plane
/// (`tests/published/analytic.rs`).
#[test]
fn newmarks_block_slides_in_plan() {
    let table = table("sliding_rigid_block.csv");
    let rows = table.rows(["mu", "max_abs_slip_m", "slip_residual_m"]);
    let record = el_centro_1940();
    // The table itself is within 2e-6 m.
    for (friction, limit, [peak, rest]) in
        [(0.1, 2e-2, [8e-6, 4e-4]), (0.2, 4e-3, [2.5e-6, 1.2e-5])]
    {
        let exact = SlidingBlock::new(friction, STANDARD_GRAVITY).unwrap().slide(&record);
        let [_, largest, residual] = *rows.iter().find(|row| row[0] == friction).unwrap();
        for (cos, sin, duration) in [(1.0, 0.0, 31.18), (0.0, 1.0, 7.0), (0.6, -0.8, 7.0)] {
            let soil = Soil::from_wave_speeds(1600.0, 3200.0, 2000.0).unwrap();
            let body = RigidBody::cuboid([4.0, 4.0, 0.4], 2000.0).unwrap();
            let part = |factor: f64| (factor != 0.0).then(|| record.scaled(factor).unwrap());
            let mut simulation = Simulation::builder(0.0025)
                .ground(ElasticGround::under(soil, &body, 4).unwrap())
                .structure(body)
                .interface(Coulomb::new(friction).unwrap())
                .motion(Triaxial { x: part(cos), y: part(sin), up: None })
                .build()
                .unwrap();
            let mut error = Error::default();
            let [mut farthest, mut aside] = [0.0_f64; 2];
            let run = simulation
                .run(whole(duration / 0.0025), |state| {
                    let own = &state.foundations[0];
                    let along = cos * own.mean_slip + sin * own.mean_slip_across;
                    let across = cos * own.mean_slip_across - sin * own.mean_slip;
                    error.add(along, exact.slip(state.time));
                    farthest = farthest.max(along.abs());
                    aside = aside.max(across.abs());
                })
                .unwrap();
            let last = cos * run.whole.residual_slip + sin * run.whole.residual_slip_across;
            let off = [farthest - largest, last - residual].map(f64::abs);
            println!("{friction} {cos}: {:.1e} {off:?} {aside:.1e}", error.relative());
            assert!(error.relative() < limit && aside < 2e-9, "{} {aside}", error.relative());
            assert!(off[0] < peak && (duration < 10.0 || off[1] < rest), "{off:?}");
            assert!(run.energy_error < 1e-9);
        }
    }
}

/// Displacement of a ground that moves in a circle.
struct Circle {
    radius: f64,
    frequency: f64,
}

impl FreeField for Circle {
    fn displacement(&self, _: f64, _: f64) -> [f64; 2] {
        unreachable!("a ground in plan asks for three directions")
    }

    fn displacement_at(&self, _: [f64; 2], time: f64) -> [f64; 3] {
        let angle = self.frequency * time;
        [self.radius * angle.cos(), self.radius * angle.sin(), 0.0]
    }
}

/// A block slides in a circle of its own: its acceleration is friction's, at right angles to what is left of the
/// ground's (relative speed √(A² − (φ g)²)/ω).
#[test]
fn a_block_on_a_ground_that_moves_in_a_circle() {
    let (friction, gravity, frequency) = (0.3, 1e-3, 0.1);
    let acceleration = 2.0 * friction * gravity;
    let body = RigidBody::cuboid([2.0, 2.0, 0.1], 1.0).unwrap();
    let soil = Soil::new(1.0, 1.0 / 3.0, 1.0).unwrap();
    let step = 2.0 * PI / frequency / 200.0;
    let mut simulation = Simulation::builder(step)
        .ground(ElasticGround::under(soil, &body, 4).unwrap())
        .structure(body)
        .interface(Coulomb::new(friction).unwrap())
        .motion(Circle { radius: acceleration / (frequency * frequency), frequency })
        .gravity(gravity)
        .build()
        .unwrap();
    let run = simulation.run(800, |_| {}).unwrap();
    assert!(run.energy_error < 1e-9);
    let exact = (acceleration.powi(2) - (friction * gravity).powi(2)).sqrt() / frequency;
    for _ in 0..200 {
        let before = simulation.state().contact.clone();
        let state = simulation.step().unwrap();
        for (own, last) in state.contact.iter().zip(before) {
            let slip = (own.slip - last.slip).hypot(own.slip_across - last.slip_across);
            let ratio = slip / step / exact;
            assert!((ratio - 1.0).abs() < 5e-3, "{ratio}");
        }
    }
}

#[test]
fn a_run_that_slides_resumes_to_the_last_bit() {
    let cohesive = || Cohesive::new(2e4, 3e4, 0.4).unwrap();
    let laws: [&dyn Fn() -> Law; 3] = [
        &|| Box::new(Coulomb::new(0.3).unwrap()),
        &|| Box::new(Yielding::new(9e4, 0.3).unwrap()),
        &move || Box::new(cohesive()),
    ];
    for law in laws {
        let mut whole = scene(law(), 4e-3, 2.0).unwrap();
        let run = whole.run(450, |_| {}).unwrap();
        assert!(run.energy_error < 1e-9 && run.whole.largest_slip.magnitude() > 1e-3);
        let saved = whole.checkpoint().unwrap();
        whole.run(200, |_| {}).unwrap();
        let mut resumed = scene(law(), 4e-3, 2.0).unwrap();
        resumed.resume(&saved).unwrap();
        resumed.run(200, |_| {}).unwrap();
        assert_eq!(resumed.state(), whole.state());
    }
}

/// Bonds break for good, within a step, and what is left is friction.
#[test]
fn bonds_break_one_after_the_other() {
    let mut simulation = scene(Cohesive::new(2e4, 3e4, 0.4).unwrap(), 2e-3, 2.0).unwrap();
    let glued = |simulation: &Simulation| {
        (0..16).filter(|e| simulation.state().state_variables(*e) == [1.0]).count()
    };
    assert_eq!(glued(&simulation), 16);
    let (mut before, mut stages) = (16, 0);
    for _ in 0..1500 {
        let state = simulation.step().unwrap();
        for own in &state.contact {
            let limit = 3e4 + 0.4 * own.pressure.max(0.0);
            assert!(own.pressure >= -2e4 * (1.0 + 1e-9), "{own:?}");
            assert!(own.shear.hypot(own.shear_across) <= limit * (1.0 + 1e-9), "{own:?}");
        }
        assert!(state.energy_balance.residual() < 1e-9);
        let now = glued(&simulation);
        assert!(now <= before);
        stages += usize::from(now < before);
        before = now;
    }
    assert!(stages > 1 && before < 16, "{stages} {before}");
}

/// A law of the plane alone, and one whose open elements bear something.
#[test]
fn laws_without_limits_are_named() {
    struct Plane;
    impl PlaneLaw for Plane {
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
    let error = scene(InPlane(Plane), 4e-3, 1.0).unwrap_err();
    assert!(matches!(error, basemat::Error::Scene { quantity: "Plane", .. }), "{error}");
    let layer = ThinLayer::from_stiffness(4e8, 2e8, 0.4).unwrap();
    let error = scene(layer, 4e-3, 1.0).unwrap_err();
    assert!(error.to_string().contains("with_debonded_ratio"), "{error}");
    // Friction that becomes NaN at some step is an error.
    let law = VariableFriction::new(|start| if start.slip_rate > 0.05 { f64::NAN } else { 0.2 });
    let mut simulation = scene(law, 4e-3, 2.0).unwrap();
    let error = simulation.run(1000, |_| {}).unwrap_err();
    let basemat::Error::Step { source: StepError::Law(_), .. } = &error else { panic!("{error}") };
    assert!(error.to_string().contains("friction coefficient"), "{error}");
}

/// Loads at t = 0 are carried by friction, and the placed base stays as it is until something moves.
#[test]
fn loads_at_the_start_are_carried_by_friction() {
    let weight = 9.80665 * 2000.0 * CUBE.iter().product::<f64>();
    let build = |share: f64| {
        let load = |dof: usize, part: f64| Load::new(dof, move |_| part * share * weight);
        Simulation::builder(4e-3)
            .structure(RigidBody::cuboid(CUBE, 2000.0).unwrap())
            .ground(Cells::under([6.0; 2], [0.0; 2], [4, 4], BED))
            .interface(Coulomb::new(0.5).unwrap())
            .load(load(0, 0.6))
            .load(load(1, -0.8))
            .build()
    };
    let mut simulation = build(0.4).unwrap();
    let own = simulation.state().foundations[0].clone();
    assert!((own.base_shear - 0.6 * 0.4 * weight).abs() < 1e-9 * weight, "{own:?}");
    assert!((own.shear_across + 0.8 * 0.4 * weight).abs() < 1e-9 * weight, "{own:?}");
    assert!((own.normal_force - weight).abs() < 1e-9 * weight);
    for own in &simulation.state().contact {
        assert!(own.shear.hypot(own.shear_across) <= 0.5 * own.pressure * (1.0 + 1e-9));
    }
    let run = simulation.run(100, |_| {}).unwrap();
    assert!(run.whole.largest_slip.magnitude() < 1e-12 && run.energy_error < 1e-9);
    // More than friction.
    let basemat::Error::Stability(cause) = build(0.6).unwrap_err() else { panic!("another error") };
    let StabilityError::Sliding { ratio, .. } = *cause else { panic!("{cause}") };
    assert!((ratio - 1.2).abs() < 1e-9, "{ratio}");
}

/// A moment about either axis whose resultant passes beside the base.
#[test]
fn moments_overturn_about_either_axis() {
    let weight = 9.80665 * 2000.0 * CUBE.iter().product::<f64>();
    for (dof, sign) in [(3, 1.0), (3, -1.0), (4, 1.0)] {
        let built = Simulation::builder(4e-3)
            .structure(RigidBody::cuboid(CUBE, 2000.0).unwrap())
            .ground(Cells::under([6.0; 2], [0.0; 2], [4, 4], BED))
            .interface(Coulomb::new(0.5).unwrap())
            .load(Load::new(dof, move |_| 3.6 * sign * weight))
            .build();
        let basemat::Error::Stability(cause) = built.unwrap_err() else { panic!("another error") };
        let StabilityError::Overturning { ratio, .. } = *cause else { panic!("{cause}") };
        assert!((ratio - 1.2).abs() < 1e-9, "{ratio}");
    }
}

/// A push across the base, harder than friction; iterations of a late step, which begins with forces that are its own.
fn steady_iterations(law: impl InterfaceLaw + 'static) -> usize {
    let weight = 9.80665 * 2000.0 * CUBE.iter().product::<f64>();
    let load = |dof: usize, part: f64| {
        Load::new(dof, move |time: f64| part * weight * (time / 0.2).min(1.0))
    };
    let mut simulation = Simulation::builder(4e-3)
        .structure(RigidBody::cuboid(CUBE, 2000.0).unwrap())
        .ground(Cells::under([6.0; 2], [0.0; 2], [4, 4], BED))
        .interface(law)
        .load(load(0, 0.4))
        .load(load(1, -0.2))
        .build()
        .unwrap();
    simulation.run(1500, |_| {}).unwrap();
    let state = simulation.step().unwrap();
    let pressures = || state.contact.iter().map(|own| own.pressure);
    let [least, most] =
        [pressures().fold(f64::INFINITY, f64::min), pressures().fold(0.0, f64::max)];
    assert!(state.modes.iter().all(|mode| mode.is_slip()) && most > 1.2 * least, "{least} {most}");
    println!("{} iterations, {:?}", state.trials, state.method);
    state.trials
}

#[test]
fn steady_sliding_takes_next_to_no_iterations() {
    assert!(steady_iterations(Coulomb::new(0.3).unwrap()) <= 4);
}

#[test]
fn steady_sliding_on_a_layer_takes_few_iterations() {
    let layer = ThinLayer::from_stiffness(4e8, 2e8, 0.3).unwrap();
    assert!(steady_iterations(layer.with_debonded_ratio(0.0).unwrap()) <= 4);
}

/// A wave that runs across the mat.
#[test]
fn travelling_waves_slide_a_base() {
    let mut simulation = Simulation::builder(2e-3)
        .structure(RigidBody::cuboid([6.0, 6.0, 9.0], 2000.0).unwrap())
        .ground(Cells::under([6.0; 2], [0.0; 2], [4, 4], BED))
        .interface(Coulomb::new(0.02).unwrap())
        .motion(Waves { quarters: 0 })
        .build()
        .unwrap();
    let run = simulation.run(400, |_| {}).unwrap();
    assert!(run.energy_error < 1e-9 && run.whole.largest_slip.magnitude() > 1e-5);
    // The mat has turned.
    assert!(simulation.state().displacement()[5].abs() > 1e-7);
}
