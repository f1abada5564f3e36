//! GOAL: the full-plane fundamental solution obeys Navier's equation.
//! SCENE: points between and behind the fronts, all loads.
//! REFERENCE: differences of fourth order.

use basemat::Soil;
use basemat::fundamental::{FullPlane, FundamentalSolution, LoadHistory};

/// Fourth-order difference of `f` for the first or second derivative along one variable.
fn difference(order: usize, h: f64, f: impl Fn(f64) -> f64) -> f64 {
    if order == 1 {
        (f(-2.0 * h) - 8.0 * f(-h) + 8.0 * f(h) - f(2.0 * h)) / (12.0 * h)
    } else {
        (16.0 * (f(-h) + f(h)) - f(-2.0 * h) - f(2.0 * h) - 30.0 * f(0.0)) / (12.0 * h * h)
    }
}

/// Step of the differences, in space and time.
const DIFFERENCE_STEP: f64 = 2e-3;

/// Displacements around a point and a time, due to a load in direction `j`.
struct DisplacementField {
    plane: FullPlane,
    point: [f64; 2],
    time: f64,
    load: LoadHistory,
    j: usize,
}

impl DisplacementField {
    /// Component i at an offset in x, z and time.
    fn at(&self, i: usize, dx: f64, dz: f64, dt: f64) -> f64 {
        let point = [self.point[0] + dx, self.point[1] + dz];
        self.plane.displacement(point, self.time + dt, self.load).unwrap()[i][self.j]
    }

    /// ∂²/∂x², ∂²/∂z² and ∂²/∂t² of component i.
    fn second_derivatives(&self, i: usize) -> [f64; 3] {
        [
            difference(2, DIFFERENCE_STEP, |dx| self.at(i, dx, 0.0, 0.0)),
            difference(2, DIFFERENCE_STEP, |dz| self.at(i, 0.0, dz, 0.0)),
            difference(2, DIFFERENCE_STEP, |dt| self.at(i, 0.0, 0.0, dt)),
        ]
    }

    /// ∂²/∂x∂z of component i.
    fn mixed_derivative(&self, i: usize) -> f64 {
        difference(1, DIFFERENCE_STEP, |dx| {
            difference(1, DIFFERENCE_STEP, |dz| self.at(i, dx, dz, 0.0))
        })
    }
}

/// GOAL: (λ+μ) ∇(∇·u) + μ ∇²u = ρ ü away from the load, for both load directions and all load histories.
/// SCENE: points between the P and the S front, and behind both.
/// REFERENCE: differences of fourth order; each term is compared with the largest one.
#[test]
fn full_plane_obeys_naviers_equation() {
    for poisson in [-0.3, 0.0, 0.25, 0.45] {
        let soil = Soil::new(1.7, poisson, 1.3).unwrap();
        let plane = FullPlane::new(soil);
        let lambda = 2.0 * soil.shear_modulus() * poisson / (1.0 - 2.0 * poisson);
        let sum = lambda + soil.shear_modulus();
        let point = [0.55, -0.35];
        let distance = f64::hypot(point[0], point[1]);
        let shear_arrival = distance / soil.shear_wave_speed();
        let pressure_arrival = distance / soil.pressure_wave_speed();
        let between_fronts = 0.5 * (shear_arrival + pressure_arrival);
        let behind_fronts = [1.3, 4.0].map(|ratio| ratio * distance / soil.shear_wave_speed());
        for time in [between_fronts, behind_fronts[0], behind_fronts[1]] {
            for load in [LoadHistory::Impulse, LoadHistory::Step, LoadHistory::Ramp] {
                for j in 0..2 {
                    let field = DisplacementField { plane, point, time, load, j };
                    let ux = field.second_derivatives(0);
                    let uz = field.second_derivatives(1);
                    let max_magnitude =
                        [ux, uz].iter().flatten().fold(0.0_f64, |m, value| m.max(value.abs()));
                    let scale = max_magnitude * (sum + soil.shear_modulus());
                    for (second, divergence) in [
                        (ux, ux[0] + field.mixed_derivative(1)),
                        (uz, field.mixed_derivative(0) + uz[1]),
                    ] {
                        let stiffness =
                            sum * divergence + soil.shear_modulus() * (second[0] + second[1]);
                        let inertia = soil.density() * second[2];
                        assert!(
                            (stiffness - inertia).abs() < 2e-6 * scale,
                            "ν = {poisson}, t = {time}, {load:?}, j = {j}: {stiffness:e} {inertia:e}"
                        );
                    }
                }
            }
        }
    }
}
