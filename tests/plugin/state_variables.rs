//! GOAL: interface laws that remember something of each element.
//! SCENE: friction that falls with the distance slid, glue that breaks once, pads that soften; under
//! blocks.
//! REFERENCE: the rigid block integrated here with small steps; Coulomb's law with a tensile
//! strength, which the crate itself ends at the first opening; the energy ½ c t² of every pad.

use basemat::Simulation;
use basemat::bem::{ContactElement, SpringGround};
use basemat::coupled::State;
use basemat::interface::{Coulomb, InPlane, InterfaceLaw};
use basemat::motion::FreeFieldFn;
use basemat::structure::RigidBlock;

use super::scene::{run, shaken};
use basemat_problems::block_on_springs::{bed, block};
use basemat_problems::laws_with_memory::{Adhesion, SlipWeakening, SofteningPads};

const GRAVITY: f64 = 9.81;
/// Circular frequency of the shaking, and its largest acceleration.
const FREQUENCY: f64 = 2.0 * std::f64::consts::PI;
const ACCELERATION: f64 = 5.0;
const DURATION: f64 = 3.0;

const LAW: SlipWeakening = SlipWeakening { first: 0.4, residual: 0.15, distance: 0.3 };

/// Slip and distance slid of a rigid block on rigid ground with acceleration
/// `ACCELERATION` sin(`FREQUENCY` t), explicitly with steps of a microsecond.
fn rigid_block(friction: impl Fn(f64) -> f64) -> [f64; 2] {
    let step = 1e-6;
    let (mut slip, mut slid, mut velocity, mut time) = (0.0, 0.0, 0.0_f64, 0.0);
    while time < DURATION {
        let ground = ACCELERATION * (FREQUENCY * (time + 0.5 * step)).sin();
        let limit = friction(slid) * GRAVITY;
        let before = velocity;
        if velocity == 0.0 {
            // At rest while friction can drag it along.
            velocity -= step * (ground - ground.clamp(-limit, limit));
        } else {
            velocity -= step * (ground + limit * velocity.signum());
            if velocity * before < 0.0 {
                velocity = 0.0;
            }
        }
        let moved = 0.5 * step * (before + velocity);
        slip += moved;
        slid += moved.abs();
        time += step;
    }
    [slip, slid]
}

/// The same of a low block on very stiff springs.
fn by_simulation(law: impl InterfaceLaw + 'static, step: f64) -> Simulation {
    let displacement = |t: f64| {
        let angle = FREQUENCY * t;
        ACCELERATION / FREQUENCY.powi(2) * (angle - angle.sin())
    };
    let bed = SpringGround::new(-2.0..2.0, 4, 2e11, 2e11).unwrap();
    let mut simulation = Simulation::builder(step)
        .structure(RigidBlock::new(4.0, 0.5, 2000.0).unwrap())
        .ground(bed.with_dashpots(4e7, 4e7).unwrap())
        .interface(law)
        .motion(FreeFieldFn::new(move |_, t| [displacement(t), 0.0]))
        .gravity(GRAVITY)
        .build()
        .unwrap();
    let run = simulation.run(simulation.steps_for(DURATION), |_| {}).unwrap();
    assert!(run.energy_error < 1e-9, "{run}");
    assert_eq!(run.debondings, 0);
    simulation
}

#[test]
fn friction_that_falls_with_the_distance_slid() {
    let wanted = rigid_block(|slid| LAW.friction(slid));
    for constant in [LAW.first, LAW.residual] {
        let [slip, slid] = rigid_block(|_| constant);
        println!("friction {constant}: slip {slip:.4} m, slid {slid:.4} m");
        assert!((slid / wanted[1] - 1.0).abs() > 0.1, "constant friction is something else");
    }
    let mut errors = Vec::new();
    for step in [2e-3, 2.5e-4] {
        let simulation = by_simulation(LAW, step);
        let state = simulation.state();
        let found = [state.mean_slip, state.state_variables(1)[0]];
        println!("step {step}: slip and distance {found:?}, wanted {wanted:?}");
        errors.push((found[1] - wanted[1]).abs().max((found[0] - wanted[0]).abs()) / wanted[1]);
        for e in 0..4 {
            assert!((state.state_variables(e)[0] / found[1] - 1.0).abs() < 1e-3, "a rigid base");
        }
        assert!(state.state_variables(4).is_empty());
    }
    println!("errors {errors:?}");
    assert!(errors[1] < 5e-4 && errors[1] < 0.25 * errors[0], "{errors:?}");
}

/// Marches both and returns the number of steps with some of the six elements broken, and of those
/// with a broken one closed again.
fn broken_glue(friction: f64, strength: f64) -> [usize; 2] {
    let glue = Adhesion { friction, strength, breaks_by_sliding: false };
    let coulomb = Coulomb::new(friction).unwrap().with_tensile_strength(strength).unwrap();
    let scene = || shaken().structure(block()).ground(bed(6));
    let mut own = scene().interface(glue).build().unwrap();
    let mut reference = scene().interface(coulomb).build().unwrap();
    let pressure: Vec<f64> = own.state().contact.iter().map(|c| c.pressure).collect();
    let (mut opened, mut steps) = ([false; 6], [0; 2]);
    for _ in 0..600 {
        let (own, reference) = (own.step().unwrap(), reference.step().unwrap());
        assert_eq!((&own.contact, &own.modes), (&reference.contact, &reference.modes));
        assert_eq!(own.energy_balance, reference.energy_balance);
        for (e, opened) in opened.iter_mut().enumerate() {
            *opened |= !own.modes[e].is_closed();
            let left = if *opened { 0.0 } else { strength };
            assert_eq!(own.state_variables(e), [left, pressure[e]]);
        }
        let broken = opened.iter().filter(|opened| **opened).count();
        steps[0] += usize::from((1..6).contains(&broken));
        steps[1] += usize::from((0..6).any(|e| opened[e] && own.modes[e].is_closed()));
    }
    assert!(own.state().energy_balance.residual() < 1e-9);
    steps
}

#[test]
fn glue_that_breaks_once_is_the_tensile_strength_of_coulomb() {
    for strength in [3e4, 1e5, 3e5] {
        let steps = broken_glue(0.4, strength);
        println!("{strength:e} Pa: steps {steps:?}");
        assert!(steps.iter().all(|steps| *steps > 0), "{steps:?}");
    }
}

#[test]
fn laws_with_and_without_memory_stand_side_by_side() {
    let law = |e: usize| -> Box<dyn InterfaceLaw> {
        match e {
            0 => Box::new(LAW),
            1 | 3 => Box::new(Coulomb::new(0.3).unwrap()),
            _ => Box::new(Adhesion { friction: 0.3, strength: 1e3, breaks_by_sliding: true }),
        }
    };
    let laws = (0..4).map(law).collect();
    let (_, simulation) = run(shaken().structure(block()).ground(bed(4)).interfaces(laws));
    let state = simulation.state();
    let memories: Vec<_> = (0..5).map(|e| state.state_variables(e).len()).collect();
    assert_eq!(memories, [1, 0, 2, 0, 0]);
    assert!(state.state_variables(0)[0] > 0.0);
    assert!((state.state_variables(2)[1] / (3.0 * 2000.0 * GRAVITY) - 1.0).abs() < 1e-6);
}

#[test]
fn pads_that_soften_store_half_c_t_squared() {
    let pads = SofteningPads { stiffness: [6e7, 3e7], softening: 2e5 };
    let mut simulation =
        shaken().structure(block()).ground(bed(4)).interface(InPlane(pads)).build().unwrap();
    let lengths: Vec<f64> =
        simulation.ground().elements().iter().map(ContactElement::length).collect();
    // With what the pads remembered when the step began.
    let stored = |state: &State, borne: &[f64]| -> f64 {
        let pad = |e: usize| {
            let [normal, shear] = pads.compliance_after(borne[e]);
            let contact = &state.contact[e];
            0.5 * lengths[e] * (normal * contact.pressure.powi(2) + shear * contact.shear.powi(2))
        };
        (0..4).map(pad).sum()
    };
    // They have borne the weight before the run begins.
    let mut borne: [f64; 4] = std::array::from_fn(|e| simulation.state().state_variables(e)[0]);
    assert!(borne.iter().all(|borne| (borne / (3.0 * 2000.0 * GRAVITY) - 1.0).abs() < 1e-6));
    let at_rest = stored(simulation.state(), &borne);
    let mut lost = 0.0;
    for _ in 0..600 {
        let state = simulation.step().unwrap();
        let wanted = stored(state, &borne) - at_rest;
        assert!(
            (state.energy_balance.interface - wanted).abs() < 1e-9 * at_rest,
            "step {}",
            state.step
        );
        // Before the push there is nothing but rounding.
        assert!(
            state.time < 0.2 || state.energy_balance.residual() < 1e-9,
            "{}",
            state.energy_balance
        );
        assert!(state.energy_balance.contact >= lost - 1e-9 * at_rest, "damage gives nothing back");
        lost = state.energy_balance.contact;
        borne = std::array::from_fn(|e| state.state_variables(e)[0]);
    }
    println!(
        "pads stored {at_rest:.0} J/m at first; damage took {lost:.0} J/m; borne {borne:?} Pa"
    );
    assert!(lost > 0.1 * at_rest);
    assert!(borne.iter().all(|borne| *borne > 3.0 * 2000.0 * GRAVITY));
}
