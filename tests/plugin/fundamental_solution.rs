//! GOAL: a fundamental solution of a user works behind the trait.
//! SCENE: a displacement with a front that solves no equation.
//! REFERENCE: causality and typed errors.

use basemat::fundamental::{FundamentalSolution, LoadHistory};
use basemat::{Error, Result, Soil};

use super::scene::soil;

/// Constant displacement behind a pressure-wave front.
struct StepFront {
    soil: Soil,
}

impl FundamentalSolution for StepFront {
    fn soil(&self) -> Soil {
        self.soil
    }

    fn displacement(&self, offset: [f64; 2], time: f64, _: LoadHistory) -> Result<[[f64; 2]; 2]> {
        let distance = offset[0].hypot(offset[1]);
        if !(distance > 0.0 && distance.is_finite()) {
            return Err(Error::Input {
                quantity: "distance from the load",
                value: distance,
                needed: "finite and above zero",
            });
        }
        let has_arrived = time * self.soil.pressure_wave_speed() > distance;
        let displacement = if has_arrived { 1.0 / self.soil.shear_modulus() } else { 0.0 };
        Ok([[displacement, 0.0], [0.0, displacement]])
    }

    fn traction(&self, _: [f64; 2], _: [f64; 2], _: f64, _: LoadHistory) -> Result<[[f64; 2]; 2]> {
        Ok([[0.0; 2]; 2])
    }
}

#[test]
fn a_fundamental_solution_of_a_user_is_causal() {
    let solution: Box<dyn FundamentalSolution> = Box::new(StepFront { soil: soil() });
    let arrival = 5.0 / soil().pressure_wave_speed();
    let offset = [3.0, 4.0];
    let before = solution.displacement(offset, 0.98 * arrival, LoadHistory::Step).unwrap();
    assert_eq!(before, [[0.0; 2]; 2], "nothing before the first arrival");
    let after = solution.displacement(offset, 1.02 * arrival, LoadHistory::Step).unwrap();
    assert!(after[0][0] > 0.0);
    assert!(solution.displacement([0.0; 2], 1.0, LoadHistory::Step).is_err());
}
