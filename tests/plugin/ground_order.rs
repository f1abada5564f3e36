//! GOAL: springs of one's own keep their energy and converge at second order in the mid-step form; a run warns of the other.
//! SCENE: a bonded block that starts upwards on springs; the shaken block of the other tests.
//! REFERENCE: the oscillator's motion and energy in closed form; `SpringGround`.

use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering};

use basemat::bem::{ContactElement, Ground, GroundDescription, SpringGround, Strip};
use basemat::coupled::{Mistake, Warning};
use basemat::interface::{Bonded, Coulomb};
use basemat::{Observer, Result, Simulation};

use super::scene::{STEP, run, shaken};
use basemat_problems::block_on_springs::block;
use basemat_problems::wrapped::BareGround;

const STIFFNESS: [f64; 2] = [4.0e7, 2.0e7];
/// Velocity at the start, m/s.
const SPEED: f64 = 0.1;

fn elements() -> Vec<ContactElement> {
    Strip::uniform(-2.0..2.0, 4).unwrap().elements()
}

/// Stiffness of each number of a contact vector.
fn each_stiffness() -> Vec<f64> {
    STIFFNESS.iter().flat_map(|stiffness| [*stiffness; 4]).collect()
}

/// Springs with s₁ = multiple · C τ − (multiple − 1) s₀: the mid-step form for 2, s₁ = C τ for 1.
struct Springs {
    elements: Vec<ContactElement>,
    multiple: f64,
    displacement: Vec<f64>,
    /// Calls of `description`.
    descriptions: Arc<AtomicUsize>,
}

impl Springs {
    fn new(multiple: f64) -> Self {
        let descriptions = Arc::default();
        Self { elements: elements(), multiple, displacement: vec![0.0; 8], descriptions }
    }

    fn fill(matrix: &mut [f64], multiple: f64) {
        matrix.fill(0.0);
        for (i, stiffness) in each_stiffness().iter().enumerate() {
            matrix[9 * i] = multiple / stiffness;
        }
    }
}

impl Ground for Springs {
    fn elements(&self) -> &[ContactElement] {
        &self.elements
    }

    fn prepare(&mut self, _: f64, _: Option<usize>, _: &mut Observer<'_>) -> Result<()> {
        self.displacement.fill(0.0);
        Ok(())
    }

    fn step_compliance(&self, matrix: &mut [f64]) -> Result<()> {
        Self::fill(matrix, self.multiple);
        Ok(())
    }

    fn history(&mut self, displacement: &mut [f64]) -> Result<()> {
        for (past, last) in displacement.iter_mut().zip(&self.displacement) {
            *past = (1.0 - self.multiple) * last;
        }
        Ok(())
    }

    fn commit(&mut self, traction: &[f64]) {
        for ((last, stiffness), traction) in
            self.displacement.iter_mut().zip(each_stiffness()).zip(traction)
        {
            *last = self.multiple * traction / stiffness + (1.0 - self.multiple) * *last;
        }
    }

    fn static_compliance(&self, matrix: &mut [f64]) -> Result<()> {
        Self::fill(matrix, 1.0);
        Ok(())
    }

    fn description(&self) -> GroundDescription {
        self.descriptions.fetch_add(1, Ordering::Relaxed);
        GroundDescription::default()
    }
}

/// A bed with dashpots that relax in `relaxation` seconds.
fn relaxing(relaxation: f64) -> SpringGround {
    let stiffness = each_stiffness();
    let dashpot: Vec<f64> = stiffness.iter().map(|stiffness| relaxation * stiffness).collect();
    SpringGround::of_elements(elements(), &stiffness, &dashpot).unwrap()
}

/// The block that starts upwards with [`SPEED`], bonded and without weight.
fn oscillator(ground: impl Ground, time_step: f64) -> Simulation {
    Simulation::builder(time_step)
        .structure(block())
        .ground(ground)
        .interface(Bonded)
        .gravity(0.0)
        .initial_velocity([0.0, SPEED, 0.0])
        .build()
        .unwrap()
}

/// Circular frequency of its vertical vibration.
fn frequency() -> f64 {
    (STIFFNESS[0] * 4.0 / block().total_mass()).sqrt()
}

#[test]
fn springs_of_one_s_own_are_the_spring_ground_s() {
    let scene = || shaken().structure(block()).interface(Coulomb::new(0.4).unwrap());
    let bed = || SpringGround::new(-2.0..2.0, 4, STIFFNESS[0], STIFFNESS[1]).unwrap();
    let (whole, expected) = run(scene().ground(bed()));
    assert!(whole.whole.largest_slip.magnitude() > 1e-3, "{whole}");
    let (_, own) = run(scene().ground(Springs::new(2.0)));
    assert_eq!(own.state().displacement(), expected.state().displacement());
    let damped = bed().with_dashpots(1e-2 * STIFFNESS[0], 1e-2 * STIFFNESS[1]).unwrap();
    let (_, expected) = run(scene().ground(damped));
    let (_, own) = run(scene().ground(BareGround(relaxing(1e-2))));
    assert_eq!(own.state().displacement(), expected.state().displacement());
}

#[test]
fn the_mid_step_form_converges_at_second_order() {
    let error = |multiple: f64, steps: usize| {
        let end = 0.1;
        let mut simulation = oscillator(Springs::new(multiple), end / steps as f64);
        simulation.run(steps, |_| {}).unwrap();
        let exact = SPEED / frequency() * (frequency() * end).sin();
        (simulation.state().displacement()[1] - exact).abs() / (SPEED / frequency())
    };
    for (multiple, order) in [(2.0, 2.0), (1.0, 1.0)] {
        let errors = [50, 100, 200, 400].map(|steps| error(multiple, steps));
        let orders: Vec<f64> = errors.windows(2).map(|pair| (pair[0] / pair[1]).log2()).collect();
        println!("multiple {multiple}: errors {errors:?}, orders {orders:?}");
        assert!(orders.iter().all(|found| (found - order).abs() < 0.25), "{orders:?}");
    }
}

#[test]
fn the_energy_of_springs_returns_in_the_mid_step_form_alone() {
    let energy = 0.5 * block().total_mass() * SPEED * SPEED;
    let soil_in_the_end = |multiple: f64| {
        let mut simulation = oscillator(Springs::new(multiple), STEP);
        let mut soil = Vec::new();
        let run =
            simulation.run(600, |state| soil.push(state.energy_balance.soil / energy)).unwrap();
        assert!(run.energy_error < 1e-9, "{run}");
        // The last period.
        #[expect(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            reason = "some hundred steps"
        )]
        let period = (std::f64::consts::TAU / frequency() / STEP).ceil() as usize;
        let last = &soil[soil.len() - period..];
        last.iter().fold([f64::INFINITY, 0.0_f64], |[low, high], value| {
            [low.min(*value), high.max(*value)]
        })
    };
    let [low, high] = soil_in_the_end(2.0);
    println!("mid-step form: {low:.4} to {high:.4} of the energy in the soil");
    assert!(low < 0.02 && (high - 1.0).abs() < 0.01, "{low} {high}");
    let [low, high] = soil_in_the_end(1.0);
    println!("s = C τ: {low:.4} to {high:.4} of the energy in the soil");
    assert!(low > 0.95, "{low} {high}");
}

#[test]
fn a_run_warns_of_the_form_of_first_order_alone() {
    let warns = |ground: Box<dyn Ground>| {
        let mut simulation = oscillator(ground, STEP);
        let run = simulation.run(10, |_| {}).unwrap();
        run.warnings.contains(&Warning::Mistake(Mistake::FirstOrderGround))
    };
    assert!(warns(Box::new(Springs::new(1.0))));
    assert!(!warns(Box::new(Springs::new(2.0))));
    // The same rule by choice, in the crate's bed and in one's own.
    let implicit = || relaxing(0.0).with_theta(1.0).unwrap();
    assert!(!warns(Box::new(implicit())));
    assert!(!warns(Box::new(Box::new(implicit()) as Box<dyn Ground>)));
    assert!(warns(Box::new(BareGround(implicit()))));
    // In a step of twice the relaxation time a bed forgets its displacement, as springs of the wrong form do.
    for steps in [0.0, 1e-3, 0.1, 0.3, 0.45, 0.5, 0.55, 1.0, 10.0, 64.0, 1e3] {
        assert!(!warns(Box::new(BareGround(relaxing(steps * STEP)))), "{steps}");
    }
}

/// A base that is held does not stand on its ground.
#[test]
fn a_build_describes_a_ground_once() {
    for (is_held, count) in [(false, 1), (true, 0)] {
        let ground = Springs::new(2.0);
        let descriptions = Arc::clone(&ground.descriptions);
        let builder = Simulation::builder(STEP).structure(block()).ground(ground).interface(Bonded);
        let builder = if is_held { builder.on_fixed_base() } else { builder };
        builder.build().unwrap();
        assert_eq!(descriptions.load(Ordering::Relaxed), count, "held {is_held}");
    }
}
