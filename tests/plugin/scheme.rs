//! GOAL: a time scheme of a user works as one of the crate.
//! SCENE: average acceleration, on a bonded structure.
//! REFERENCE: the midpoint rule and the θ-method.

use std::sync::Arc;

use basemat::Simulation;
use basemat::coupled::{Midpoint, SchemeCoefficients, Theta, TimeScheme};
use basemat::interface::Bonded;

use super::scene::{assert_same_motion, complete_run, shaken};
use super::structure::HardeningOscillator;
use basemat_problems::block_on_springs::bed;
use basemat_problems::wrapped::MinimalStructure;

/// Newmark's average acceleration, with equilibrium at the end of the step.
pub(crate) struct AverageAcceleration;

impl TimeScheme for AverageAcceleration {
    fn coefficients(&self, time_step: f64) -> SchemeCoefficients {
        let h = time_step;
        // a₁ = 4Δu/h² − 4v₀/h − a₀, v₁ = 2Δu/h − v₀.
        let acceleration = [4.0 / (h * h), -4.0 / h, -1.0];
        let velocity = [2.0 / h, -1.0, 0.0];
        SchemeCoefficients {
            displacement: [1.0, 0.0, 0.0],
            velocity,
            acceleration,
            new_velocity: velocity,
            new_acceleration: acceleration,
            load_fraction: 1.0,
        }
    }
}

/// Motion of a bonded linear structure by this scheme.
fn run_with(scheme: impl TimeScheme + 'static) -> Simulation {
    let linear_oscillator = HardeningOscillator { cubic_stiffness: 0.0, commits: Arc::default() };
    let builder = shaken()
        .structure(MinimalStructure(linear_oscillator))
        .ground(bed(4))
        .interface(Bonded);
    complete_run(builder.scheme(scheme)).simulation
}

#[test]
fn a_scheme_of_a_user_moves_as_the_midpoint_rule() {
    let midpoint = run_with(Midpoint);
    let newmark = run_with(AverageAcceleration);
    let theta = run_with(Theta::new(0.52).unwrap());
    assert!(theta.state().energy_balance.algorithmic > 0.0);
    assert_eq!(midpoint.state().energy_balance.algorithmic, 0.0);
    // The two rules are of second order, but different.
    assert_same_motion(&midpoint, &newmark, 0.05);
}
