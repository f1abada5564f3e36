//! GOAL: a fundamental solution of one's own.
//! SCENE: a toy with a front, behind the trait.
//! REFERENCE: causality and typed errors.

use basemat::fundamental::{FundamentalSolution, LoadHistory};
use basemat::{Error, Result, Soil};

use super::scene::soil;

/// Kelvin's plane in antiplane disguise: not a solution of anything, but it has the shape of one.
struct Toy(Soil);

impl FundamentalSolution for Toy {
    fn soil(&self) -> Soil {
        self.0
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
        let arrived = time * self.0.pressure_wave_speed() > distance;
        let u = if arrived { 1.0 / self.0.shear_modulus() } else { 0.0 };
        Ok([[u, 0.0], [0.0, u]])
    }

    fn traction(&self, _: [f64; 2], _: [f64; 2], _: f64, _: LoadHistory) -> Result<[[f64; 2]; 2]> {
        Ok([[0.0; 2]; 2])
    }
}

#[test]
fn own_fundamental_solution() {
    let solutions: Vec<Box<dyn FundamentalSolution>> = vec![Box::new(Toy(soil()))];
    let speed = soil().pressure_wave_speed();
    for solution in &solutions {
        let at = |time| solution.displacement([3.0, 4.0], time, LoadHistory::Step).unwrap();
        assert_eq!(at(4.9 / speed), [[0.0; 2]; 2], "nothing before the first arrival");
        assert!(at(5.1 / speed)[0][0] > 0.0);
        assert!(solution.displacement([0.0; 2], 1.0, LoadHistory::Step).is_err());
    }
}
