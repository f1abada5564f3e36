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

/// GOAL: (λ+μ) ∇(∇·u) + μ ∇²u = ρ ü away from the load, for both load directions and all load
/// histories. SCENE: points between the P and the S front, and behind both. REFERENCE: differences
/// of fourth order; each term is compared with the largest one.
#[test]
fn full_plane_obeys_naviers_equation() {
    let h = 2e-3;
    for poisson in [-0.3, 0.0, 0.25, 0.45] {
        let soil = Soil::new(1.7, poisson, 1.3).unwrap();
        let plane = FullPlane::new(soil);
        let lambda = 2.0 * soil.shear_modulus() * poisson / (1.0 - 2.0 * poisson);
        let sum = lambda + soil.shear_modulus();
        let (slow, fast) = (soil.shear_wave_speed(), soil.pressure_wave_speed());
        let [x, z] = [0.55, -0.35];
        let distance = f64::hypot(x, z);
        let between = 0.5 * (distance / slow + distance / fast);
        for time in [between, 1.3 * distance / slow, 4.0 * distance / slow] {
            for load in [LoadHistory::Impulse, LoadHistory::Step, LoadHistory::Ramp] {
                for j in 0..2 {
                    let u = |i: usize, dx: f64, dz: f64, dt: f64| {
                        plane.displacement([x + dx, z + dz], time + dt, load).unwrap()[i][j]
                    };
                    let second = |i: usize| {
                        [
                            difference(2, h, |s| u(i, s, 0.0, 0.0)),
                            difference(2, h, |s| u(i, 0.0, s, 0.0)),
                            difference(2, h, |s| u(i, 0.0, 0.0, s)),
                        ]
                    };
                    let mixed =
                        |i: usize| difference(1, h, |a| difference(1, h, |b| u(i, a, b, 0.0)));
                    let (ux, uz) = (second(0), second(1));
                    for (own, divergence) in [(ux, ux[0] + mixed(1)), (uz, mixed(0) + uz[1])] {
                        let stiffness = sum * divergence + soil.shear_modulus() * (own[0] + own[1]);
                        let inertia = soil.density() * own[2];
                        let scale =
                            [ux, uz].iter().flatten().fold(0.0_f64, |m, value| m.max(value.abs()))
                                * (sum + soil.shear_modulus());
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
