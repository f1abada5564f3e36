//! GOAL: springs of a user conserve energy and are of second order in the mid-step form; a run warns of other forms.
//! SCENE: a bonded block that starts upwards on springs; the shaken block of the other tests.
//! REFERENCE: the oscillator's motion and energy in closed form; `SpringGround`.

use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering};

use basemat::bem::{ContactElement, Ground, GroundDescription, SpringGround, Strip};
use basemat::coupled::{Mistake, Warning};
use basemat::interface::{Bonded, Coulomb};
use basemat::{Observer, Result, Simulation};

use super::scene::{CompletedRun, TIME_STEP, complete_run, shaken};
use basemat_problems::block_on_springs::block;
use basemat_problems::wrapped::MinimalGround;

/// Normal and tangential stiffness of the springs, Pa/m.
const SPRING_STIFFNESS: [f64; 2] = [4.0e7, 2.0e7];
/// Upward velocity of the oscillator at the start, m/s.
const INITIAL_VELOCITY: f64 = 0.1;

fn elements() -> Vec<ContactElement> {
    Strip::uniform(-2.0..2.0, 4).unwrap().elements()
}

/// Stiffness of each component of a contact vector.
fn stiffness_by_component() -> Vec<f64> {
    SPRING_STIFFNESS.iter().flat_map(|stiffness| [*stiffness; 4]).collect()
}

/// Springs with s₁ = multiple · C τ − (multiple − 1) s₀.
///
/// For 2 this is the mid-step form; for 1 it is s₁ = C τ.
struct CompliantSprings {
    elements: Vec<ContactElement>,
    multiple: f64,
    displacement: Vec<f64>,
    /// Number of calls of `description`.
    descriptions: Arc<AtomicUsize>,
}

impl CompliantSprings {
    fn new(multiple: f64) -> Self {
        let descriptions = Arc::default();
        Self { elements: elements(), multiple, displacement: vec![0.0; 8], descriptions }
    }

    fn fill_diagonal(matrix: &mut [f64], multiple: f64) {
        matrix.fill(0.0);
        for (i, stiffness) in stiffness_by_component().iter().enumerate() {
            matrix[9 * i] = multiple / stiffness;
        }
    }
}

impl Ground for CompliantSprings {
    fn elements(&self) -> &[ContactElement] {
        &self.elements
    }

    fn prepare(&mut self, _: f64, _: Option<usize>, _: &mut Observer<'_>) -> Result<()> {
        self.displacement.fill(0.0);
        Ok(())
    }

    fn step_compliance(&self, matrix: &mut [f64]) -> Result<()> {
        Self::fill_diagonal(matrix, self.multiple);
        Ok(())
    }

    fn history(&mut self, displacement: &mut [f64]) -> Result<()> {
        for (history, previous) in displacement.iter_mut().zip(&self.displacement) {
            *history = (1.0 - self.multiple) * previous;
        }
        Ok(())
    }

    fn commit(&mut self, traction: &[f64]) {
        let stiffnesses = stiffness_by_component();
        for ((displacement, stiffness), traction) in
            self.displacement.iter_mut().zip(stiffnesses).zip(traction)
        {
            *displacement =
                self.multiple * traction / stiffness + (1.0 - self.multiple) * *displacement;
        }
    }

    fn static_compliance(&self, matrix: &mut [f64]) -> Result<()> {
        Self::fill_diagonal(matrix, 1.0);
        Ok(())
    }

    fn description(&self) -> GroundDescription {
        self.descriptions.fetch_add(1, Ordering::Relaxed);
        GroundDescription::default()
    }
}

/// A spring ground whose dashpots have this relaxation time, s.
fn damped_springs(relaxation_time: f64) -> SpringGround {
    let stiffness = stiffness_by_component();
    let dashpots: Vec<f64> =
        stiffness.iter().map(|stiffness| relaxation_time * stiffness).collect();
    SpringGround::of_elements(elements(), &stiffness, &dashpots).unwrap()
}

/// The bonded block without weight that starts upwards.
fn oscillator(ground: impl Ground, time_step: f64) -> Simulation {
    Simulation::builder(time_step)
        .structure(block())
        .ground(ground)
        .interface(Bonded)
        .gravity(0.0)
        .initial_velocity([0.0, INITIAL_VELOCITY, 0.0])
        .build()
        .unwrap()
}

/// Circular frequency of the block's vertical vibration.
fn circular_frequency() -> f64 {
    (SPRING_STIFFNESS[0] * 4.0 / block().total_mass()).sqrt()
}

/// Run of a sliding block on this ground.
fn sliding_block(ground: impl Ground + 'static) -> CompletedRun {
    let law = Coulomb::new(0.4).unwrap();
    complete_run(shaken().structure(block()).interface(law).ground(ground))
}

#[test]
fn springs_of_a_user_move_as_the_spring_ground() {
    let normal = SPRING_STIFFNESS[0];
    let tangential = SPRING_STIFFNESS[1];
    let springs = SpringGround::new(-2.0..2.0, 4, normal, tangential).unwrap();
    let damped_bed = springs.clone().with_dashpots(1e-2 * normal, 1e-2 * tangential).unwrap();
    let expected = sliding_block(springs);
    assert!(expected.run.whole.largest_slip.magnitude() > 1e-3, "{}", expected.run);
    let computed = sliding_block(CompliantSprings::new(2.0));
    let expected_displacement = expected.simulation.state().displacement();
    assert_eq!(computed.simulation.state().displacement(), expected_displacement);
    let expected = sliding_block(damped_bed).simulation;
    let computed = sliding_block(MinimalGround(damped_springs(1e-2))).simulation;
    assert_eq!(computed.state().displacement(), expected.state().displacement());
}

/// Error of the displacement after 0.1 s over the amplitude.
fn displacement_error(multiple: f64, steps: usize) -> f64 {
    let end = 0.1;
    let mut simulation = oscillator(CompliantSprings::new(multiple), end / steps as f64);
    simulation.run(steps, |_| {}).unwrap();
    let amplitude = INITIAL_VELOCITY / circular_frequency();
    let expected = amplitude * (circular_frequency() * end).sin();
    (simulation.state().displacement()[1] - expected).abs() / amplitude
}

#[test]
fn the_mid_step_form_converges_at_second_order() {
    for (multiple, expected_order) in [(2.0, 2.0), (1.0, 1.0)] {
        let errors = [50, 100, 200, 400].map(|steps| displacement_error(multiple, steps));
        let orders: Vec<f64> = errors.windows(2).map(|pair| (pair[0] / pair[1]).log2()).collect();
        println!("multiple {multiple}: errors {errors:?}, orders {orders:?}");
        assert!(orders.iter().all(|order| (order - expected_order).abs() < 0.25), "{orders:?}");
    }
}

/// Range of the energy of the soil in the last period, over the initial kinetic energy.
#[derive(Debug)]
struct EnergyRange {
    min_energy: f64,
    max_energy: f64,
}

fn soil_energy_in_last_period(multiple: f64) -> EnergyRange {
    let energy = 0.5 * block().total_mass() * INITIAL_VELOCITY * INITIAL_VELOCITY;
    let mut simulation = oscillator(CompliantSprings::new(multiple), TIME_STEP);
    let mut soil = Vec::new();
    let run = simulation.run(600, |state| soil.push(state.energy_balance.soil / energy)).unwrap();
    assert!(run.energy_error < 1e-9, "{run}");
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "some hundred steps"
    )]
    let period_steps = (std::f64::consts::TAU / circular_frequency() / TIME_STEP).ceil() as usize;
    let last_period = &soil[soil.len() - period_steps..];
    EnergyRange {
        min_energy: last_period.iter().copied().fold(f64::INFINITY, f64::min),
        max_energy: last_period.iter().copied().fold(0.0, f64::max),
    }
}

#[test]
fn the_energy_of_springs_returns_in_the_mid_step_form_only() {
    let mid_step = soil_energy_in_last_period(2.0);
    println!("mid-step form: {mid_step:.4?} of the energy in the soil");
    assert!(mid_step.min_energy < 0.02 && (mid_step.max_energy - 1.0).abs() < 0.01, "{mid_step:?}");
    let first_order = soil_energy_in_last_period(1.0);
    println!("s = C τ: {first_order:.4?} of the energy in the soil");
    assert!(first_order.min_energy > 0.95, "{first_order:?}");
}

/// Whether a run warns that its ground is of first order.
fn warns_of_first_order(ground: impl Ground + 'static) -> bool {
    let mut simulation = oscillator(ground, TIME_STEP);
    let run = simulation.run(10, |_| {}).unwrap();
    run.warnings.contains(&Warning::Mistake(Mistake::FirstOrderGround))
}

#[test]
fn a_run_warns_of_the_form_of_first_order_only() {
    assert!(warns_of_first_order(CompliantSprings::new(1.0)));
    assert!(!warns_of_first_order(CompliantSprings::new(2.0)));
    // The implicit rule by choice in the spring ground, and in a ground of a user.
    let implicit = damped_springs(0.0).with_theta(1.0).unwrap();
    assert!(!warns_of_first_order(implicit.clone()));
    assert!(!warns_of_first_order(Box::new(implicit.clone()) as Box<dyn Ground>));
    assert!(warns_of_first_order(MinimalGround(implicit)));
    // In a step of twice the relaxation time springs lose their displacement, as springs of the wrong form do.
    for steps in [0.0, 1e-3, 0.1, 0.3, 0.45, 0.5, 0.55, 1.0, 10.0, 64.0, 1e3] {
        assert!(!warns_of_first_order(MinimalGround(damped_springs(steps * TIME_STEP))), "{steps}");
    }
}

/// A fixed base does not rest on its ground, which is then not described.
#[test]
fn a_build_describes_a_ground_once() {
    for (is_fixed, count) in [(false, 1), (true, 0)] {
        let ground = CompliantSprings::new(2.0);
        let descriptions = Arc::clone(&ground.descriptions);
        let builder =
            Simulation::builder(TIME_STEP).structure(block()).ground(ground).interface(Bonded);
        let builder = if is_fixed { builder.on_fixed_base() } else { builder };
        builder.build().unwrap();
        assert_eq!(descriptions.load(Ordering::Relaxed), count, "fixed {is_fixed}");
    }
}
