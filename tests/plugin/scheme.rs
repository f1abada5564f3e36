//! GOAL: a time scheme of one's own.
//! SCENE: average acceleration, on a bonded structure.
//! REFERENCE: the midpoint rule and the θ-method.

use std::sync::Arc;

use basemat::coupled::{Midpoint, SchemeCoefficients, Theta, TimeScheme};
use basemat::interface::Bonded;

use super::scene::{assert_same_motion, run, shaken};
use crate::plugin::structure::Hardening;
use basemat_problems::block_on_springs::bed;
use basemat_problems::wrapped::Bare;

/// Newmark's average acceleration, not one of the crate's.
pub(crate) struct AverageAcceleration;

impl TimeScheme for AverageAcceleration {
    fn coefficients(&self, time_step: f64) -> SchemeCoefficients {
        let h = time_step;
        // Everything at the end of the step: a₁ = 4Δu/h² − 4v₀/h − a₀, v₁ = 2Δu/h − v₀.
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

#[test]
fn own_time_scheme() {
    let scene = || {
        let structure = Bare(Hardening { cubic: 0.0, commits: Arc::default() });
        shaken().structure(structure).ground(bed(4)).interface(Bonded)
    };
    let (_, midpoint) = run(scene().scheme(Midpoint));
    let (_, newmark) = run(scene().scheme(AverageAcceleration));
    let (_, theta) = run(scene().scheme(Theta::new(0.52).unwrap()));
    assert!(theta.state().energy_balance.algorithmic > 0.0);
    assert_eq!(midpoint.state().energy_balance.algorithmic, 0.0);
    // Different second-order rules of one problem.
    assert_same_motion(&midpoint, &newmark, 0.05);
}
