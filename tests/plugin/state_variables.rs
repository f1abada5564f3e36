//! GOAL: interface laws may have state variables for each element.
//! SCENE: blocks on friction that decreases with the distance slid, on a bond that breaks once, and on pads that soften.
//! REFERENCE: the rigid block integrated here with small steps; Coulomb's law with a tensile strength, which ends at the
//! first opening; the energy ½ c t² of every pad.

use basemat::Simulation;
use basemat::bem::{ContactElement, SpringGround};
use basemat::coupled::State;
use basemat::interface::{Coulomb, InPlane, InterfaceLaw};
use basemat::motion::FreeFieldFn;
use basemat::structure::RigidBlock;

use super::scene::{complete_run, shaken};
use basemat_problems::block_on_springs::{bed, block};
use basemat_problems::laws_with_memory::{BreakingBond, SlipWeakening, SofteningPads};

const GRAVITY_ACCELERATION: f64 = 9.81;
/// Circular frequency of the shaking, rad/s.
const SHAKING_FREQUENCY: f64 = 2.0 * std::f64::consts::PI;
/// Largest acceleration of the shaking, m/s².
const PEAK_ACCELERATION: f64 = 5.0;
/// Duration of the shaking, s.
const SHAKING_DURATION: f64 = 3.0;
/// Pressure of the block's weight, Pa.
const BLOCK_PRESSURE: f64 = 3.0 * 2000.0 * GRAVITY_ACCELERATION;

const SLIP_WEAKENING: SlipWeakening = SlipWeakening { first: 0.4, residual: 0.15, distance: 0.3 };

/// Slip and sliding distance at the end of the shaking.
#[derive(Debug)]
struct SlideDistances {
    slip: f64,
    distance: f64,
}

/// Slip and sliding distance of a rigid block on rigid ground, by explicit steps of a microsecond.
fn slide_of_rigid_block(friction: impl Fn(f64) -> f64) -> SlideDistances {
    let step = 1e-6;
    let mut slip = 0.0;
    let mut distance = 0.0;
    let mut velocity = 0.0_f64;
    let mut time = 0.0;
    while time < SHAKING_DURATION {
        let ground = PEAK_ACCELERATION * (SHAKING_FREQUENCY * (time + 0.5 * step)).sin();
        let limit = friction(distance) * GRAVITY_ACCELERATION;
        let previous_velocity = velocity;
        if velocity == 0.0 {
            // The block moves with the ground as long as friction can accelerate it.
            velocity -= step * (ground - ground.clamp(-limit, limit));
        } else {
            velocity -= step * (ground + limit * velocity.signum());
            if velocity * previous_velocity < 0.0 {
                velocity = 0.0;
            }
        }
        let increment = 0.5 * step * (previous_velocity + velocity);
        slip += increment;
        distance += increment.abs();
        time += step;
    }
    SlideDistances { slip, distance }
}

/// A low block on very stiff springs after the shaking.
fn block_on_stiff_springs(law: impl InterfaceLaw + 'static, time_step: f64) -> Simulation {
    let motion = FreeFieldFn::new(|_, time: f64| {
        let angle = SHAKING_FREQUENCY * time;
        [PEAK_ACCELERATION / SHAKING_FREQUENCY.powi(2) * (angle - angle.sin()), 0.0]
    });
    let springs = SpringGround::new(-2.0..2.0, 4, 2e11, 2e11).unwrap();
    let mut simulation = Simulation::builder(time_step)
        .structure(RigidBlock::new(4.0, 0.5, 2000.0).unwrap())
        .ground(springs.with_dashpots(4e7, 4e7).unwrap())
        .interface(law)
        .motion(motion)
        .gravity(GRAVITY_ACCELERATION)
        .build()
        .unwrap();
    let run = simulation.run(simulation.steps_for(SHAKING_DURATION), |_| {}).unwrap();
    assert!(run.energy_error < 1e-9, "{run}");
    assert_eq!(run.debondings, 0);
    simulation
}

#[test]
fn friction_falls_with_the_distance_slid() {
    let expected = slide_of_rigid_block(|distance| SLIP_WEAKENING.friction(distance));
    for coefficient in [SLIP_WEAKENING.first, SLIP_WEAKENING.residual] {
        let constant = slide_of_rigid_block(|_| coefficient);
        println!("friction {coefficient}: {constant:?}");
        assert!((constant.distance / expected.distance - 1.0).abs() > 0.1, "{constant:?}");
    }
    let mut errors = Vec::new();
    for time_step in [2e-3, 2.5e-4] {
        let simulation = block_on_stiff_springs(SLIP_WEAKENING, time_step);
        let state = simulation.state();
        let computed =
            SlideDistances { slip: state.mean_slip, distance: state.state_variables(1)[0] };
        println!("step {time_step}: {computed:?}, expected {expected:?}");
        let slip_error = (computed.slip - expected.slip).abs();
        let distance_error = (computed.distance - expected.distance).abs();
        errors.push(distance_error.max(slip_error) / expected.distance);
        for e in 0..4 {
            let distance = state.state_variables(e)[0];
            assert!((distance / computed.distance - 1.0).abs() < 1e-3, "a rigid base");
        }
        assert!(state.state_variables(4).is_empty());
    }
    println!("errors {errors:?}");
    assert!(errors[1] < 5e-4 && errors[1] < 0.25 * errors[0], "{errors:?}");
}

/// Numbers of steps in which the bond of some elements is broken.
#[derive(Debug)]
struct BrokenBondSteps {
    /// One to five of the six elements are broken.
    partly_broken: usize,
    /// A broken element is closed again.
    closed_again: usize,
}

/// Checks a bond that breaks once beside Coulomb's law in every step.
fn compare_breaking_bond(friction: f64, strength: f64) -> BrokenBondSteps {
    let bond = BreakingBond { friction, strength, breaks_by_sliding: false };
    let coulomb = Coulomb::new(friction).unwrap().with_tensile_strength(strength).unwrap();
    let builder = shaken().structure(block()).ground(bed(6)).interface(bond);
    let mut bonded = builder.build().unwrap();
    let builder = shaken().structure(block()).ground(bed(6)).interface(coulomb);
    let mut reference = builder.build().unwrap();
    let static_pressure: Vec<f64> =
        bonded.state().contact.iter().map(|contact| contact.pressure).collect();
    let mut is_broken = [false; 6];
    let mut steps = BrokenBondSteps { partly_broken: 0, closed_again: 0 };
    for _ in 0..600 {
        let computed = bonded.step().unwrap();
        let expected = reference.step().unwrap();
        assert_eq!((&computed.contact, &computed.modes), (&expected.contact, &expected.modes));
        assert_eq!(computed.energy_balance, expected.energy_balance);
        for (e, is_broken) in is_broken.iter_mut().enumerate() {
            *is_broken |= !computed.modes[e].is_closed();
            let remaining_strength = if *is_broken { 0.0 } else { strength };
            let variables = [remaining_strength, static_pressure[e]];
            assert_eq!(computed.state_variables(e), variables);
        }
        let count = is_broken.iter().filter(|is_broken| **is_broken).count();
        steps.partly_broken += usize::from((1..6).contains(&count));
        let is_closed_again = (0..6).any(|e| is_broken[e] && computed.modes[e].is_closed());
        steps.closed_again += usize::from(is_closed_again);
    }
    assert!(bonded.state().energy_balance.residual() < 1e-9);
    steps
}

#[test]
fn a_bond_that_breaks_once_is_the_tensile_strength_of_coulomb() {
    for strength in [3e4, 1e5, 3e5] {
        let steps = compare_breaking_bond(0.4, strength);
        println!("{strength:e} Pa: {steps:?}");
        assert!(steps.partly_broken > 0 && steps.closed_again > 0, "{steps:?}");
    }
}

#[test]
fn laws_with_and_without_state_variables_work_side_by_side() {
    let coulomb = Coulomb::new(0.3).unwrap();
    let bond = BreakingBond { friction: 0.3, strength: 1e3, breaks_by_sliding: true };
    let laws: Vec<Box<dyn InterfaceLaw>> =
        vec![Box::new(SLIP_WEAKENING), Box::new(coulomb), Box::new(bond), Box::new(coulomb)];
    let builder = shaken().structure(block()).ground(bed(4)).interfaces(laws);
    let simulation = complete_run(builder).simulation;
    let state = simulation.state();
    let counts: Vec<_> = (0..5).map(|e| state.state_variables(e).len()).collect();
    assert_eq!(counts, [1, 0, 2, 0, 0]);
    assert!(state.state_variables(0)[0] > 0.0);
    assert!((state.state_variables(2)[1] / BLOCK_PRESSURE - 1.0).abs() < 1e-6);
}

const SOFTENING_PADS: SofteningPads = SofteningPads { stiffness: [6e7, 3e7], softening: 2e5 };

/// Largest pressures that the pads have carried.
fn largest_pressures(state: &State) -> [f64; 4] {
    std::array::from_fn(|e| state.state_variables(e)[0])
}

/// Energy ½ c t² of all pads with the largest pressures at the beginning of the step.
fn pad_energy(state: &State, elements: &[ContactElement], largest_pressures: &[f64]) -> f64 {
    let mut energy = 0.0;
    for e in 0..4 {
        let [normal, shear] = SOFTENING_PADS.compliance_after(largest_pressures[e]);
        let contact = &state.contact[e];
        let density = normal * contact.pressure.powi(2) + shear * contact.shear.powi(2);
        energy += 0.5 * elements[e].length() * density;
    }
    energy
}

#[test]
fn pads_that_soften_store_half_c_t_squared() {
    let builder = shaken().structure(block()).ground(bed(4)).interface(InPlane(SOFTENING_PADS));
    let mut simulation = builder.build().unwrap();
    let elements = simulation.ground().elements().to_vec();
    // The pads have carried the weight before the run begins.
    let mut pressures = largest_pressures(simulation.state());
    assert!(pressures.iter().all(|pressure| (pressure / BLOCK_PRESSURE - 1.0).abs() < 1e-6));
    let static_energy = pad_energy(simulation.state(), &elements, &pressures);
    let mut damage = 0.0;
    for _ in 0..600 {
        let state = simulation.step().unwrap();
        let balance = state.energy_balance;
        let expected = pad_energy(state, &elements, &pressures) - static_energy;
        let error = (balance.interface - expected).abs();
        assert!(error < 1e-9 * static_energy, "step {}", state.step);
        // Before the pulse all energies are rounding.
        assert!(state.time < 0.2 || balance.residual() < 1e-9, "{balance}");
        assert!(balance.contact >= damage - 1e-9 * static_energy, "damage never returns energy");
        damage = balance.contact;
        pressures = largest_pressures(state);
    }
    println!(
        "pads stored {static_energy:.0} J/m at first; damage dissipated {damage:.0} J/m; largest \
         pressures {pressures:?} Pa"
    );
    assert!(damage > 0.1 * static_energy);
    assert!(pressures.iter().all(|pressure| *pressure > BLOCK_PRESSURE));
}
