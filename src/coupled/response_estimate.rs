//! Base shear of a sketched structure in the frequency domain: what advice on mesh and step is
//! estimated from.
//!
//! A rigid rectangle (or one of which a part sways as a single oscillator) stands on a rigid strip,
//! bonded. Unknowns are the base's translation u and rotation θ; with M(ω) the mass matrix, the
//! oscillator condensed into it,
//!
//! ```text
//! (K(ω) − ω² M(ω)) [u, θ] = K(ω) [u_ff, 0],      V = k_h (u_ff − u)
//! ```
//!
//! | symbol | meaning | unit here |
//! |---|---|---|
//! | a₀ | ωB/c_S, B half the width | – |
//! | k_h, k_r | horizontal and rocking stiffness of the strip; their coupling is left out | μ, μB² |
//! | m, s, i | mass, its first and second moment about the base | ρB², ρB³, ρB⁴ |

use std::f64::consts::PI;

use realfft::num_complex::Complex;

use crate::Soil;

type C = Complex<f64>;

/// Share of the mass that sways with the first mode, and its height over the total: a cantilever's
/// first mode has 0.61 and 0.73 in bending, 0.81 and 0.64 in shear.
const SWAYING: f64 = 0.7;
const SWAY_HEIGHT: f64 = 0.7;

/// Relative errors of a strip's stiffnesses.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct StiffnessError {
    /// Of the horizontal one.
    pub horizontal: f64,
    /// Of that in rocking.
    pub rocking: f64,
}

/// A sketch of structure and soil in dimensionless numbers.
#[derive(Debug, Clone, Copy)]
pub(super) struct Sketch {
    poisson: f64,
    /// c_P/c_S.
    speeds: f64,
    /// Static rocking stiffness.
    rocking: f64,
    mass: f64,
    height: f64,
    /// a₀ of the first mode on a fixed base, and its damping ratio.
    sway: Option<[f64; 2]>,
}

impl Sketch {
    /// From mass over ρB², height over B, and the a₀ and damping ratio of the sway.
    pub(super) fn new(soil: Soil, mass: f64, height: f64, sway: Option<[f64; 2]>) -> Self {
        let poisson = soil.poisson();
        let oscillation = (3.0 - 4.0 * poisson).ln() / (2.0 * PI);
        Self {
            poisson,
            speeds: soil.speed_ratio_squared().sqrt().recip(),
            rocking: PI / (2.0 * (1.0 - poisson)) * (1.0 + 4.0 * oscillation * oscillation),
            mass,
            height,
            sway,
        }
    }

    /// k_h and k_r: the limits of `reference::RigidStrip`, and in between rational
    /// functions that stay within 19 % of the bonded strip's tables (Luco & Westmann's problem; for
    /// ν ≥ 1/4 within 16 %) for 0.1 ≤ a₀ ≤ 4 and 0 ≤ ν ≤ 1/3.
    fn stiffness(&self, a: f64) -> [C; 2] {
        let real = 1.17 / (1.0 - self.poisson) * a / (a + 0.06);
        let horizontal = C::new(real, 2.0 * a + 0.3 * a / ((a + 0.1) * (1.0 + a)));
        let radiated = 2.0 / 3.0 * self.speeds * a * a / (a + 0.8);
        [horizontal, C::new(self.rocking / (1.0 + 0.25 * a), radiated)]
    }

    /// V/u_ff.
    pub(super) fn shear(&self, a: f64, error: StiffnessError) -> C {
        let [k_h, k_r] = self.stiffness(a);
        let (k_h, k_r) = (k_h * (1.0 - error.horizontal), k_r * (1.0 - error.rocking));
        let [m, s, i] = self.moments(a);
        let square = a * a;
        let [d_h, coupling, d_r] = [k_h - m * square, s * square, k_r - i * square];
        // 1 − u/u_ff without cancellation at low frequency.
        let lag = -(m * square * d_r + coupling * coupling) / (d_h * d_r - coupling * coupling);
        k_h * lag
    }

    /// m, s and i with the oscillator condensed.
    fn moments(&self, a: f64) -> [C; 3] {
        let (m, h) = (self.mass, self.height);
        let rigid = [m, 0.5 * m * h, m * (4.0 + h * h) / 12.0 + 0.25 * m * h * h];
        let mut moments = rigid.map(|value| C::new(value, 0.0));
        if let Some([natural, damping]) = self.sway {
            let ratio = a / natural;
            // A trace of damping keeps a line on the frequency itself off the pole.
            let spring = C::new(1.0, 2.0 * damping.max(1e-6) * ratio);
            // Swaying mass felt at the base, over the mass itself, less the mass counted above.
            let excess = spring / (spring - ratio * ratio) - 1.0;
            let arm = SWAY_HEIGHT * h;
            for (moment, factor) in moments.iter_mut().zip([1.0, arm, arm * arm]) {
                *moment += excess * (SWAYING * m * factor);
            }
        }
        moments
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::reference::RigidStrip;

    fn soil(poisson: f64) -> Soil {
        Soil::new(1.0, poisson, 1.0).unwrap()
    }

    /// Against rows of `tests/data/strip_bonded_nu*_xi00.csv`.
    #[test]
    fn stiffnesses_are_near_the_tables() {
        let third = 1.0 / 3.0;
        for (poisson, a, k_h, k_r) in [
            (third, 0.1, [1.150, 0.527], [2.427, 0.018]),
            (third, 0.5, [1.586, 1.315], [2.229, 0.247]),
            (third, 1.0, [1.750, 2.183], [1.976, 0.743]),
            (third, 2.0, [1.770, 4.001], [1.533, 1.965]),
            (third, 4.0, [1.618, 7.922], [0.968, 5.084]),
            (0.0, 0.1, [0.863, 0.459], [1.856, 0.039]),
            (0.0, 1.0, [1.321, 2.074], [1.551, 0.566]),
            (0.0, 4.0, [1.176, 8.028], [1.133, 3.668]),
        ] {
            let found = Sketch::new(soil(poisson), 1.0, 1.0, None).stiffness(a);
            for (found, wanted) in found.into_iter().zip([k_h, k_r]) {
                let wanted = C::new(wanted[0], wanted[1]);
                let error = (found - wanted).norm() / wanted.norm();
                assert!(error < 0.19, "ν = {poisson}, a₀ = {a}: {found} for {wanted}");
            }
        }
    }

    #[test]
    fn limits_are_the_strips() {
        let strip = RigidStrip::new(soil(0.3), 1.0).unwrap();
        let sketch = Sketch::new(soil(0.3), 2.0, 3.0, Some([1.0, 0.05]));
        let [_, rocking] = sketch.stiffness(1e-9);
        assert!((rocking.re / strip.bonded_rocking_stiffness() - 1.0).abs() < 1e-8);
        let [horizontal, rocking] = sketch.stiffness(1e6).map(|k| k.im / 1e6);
        assert!((horizontal / strip.horizontal_dashpot() - 1.0).abs() < 1e-5);
        assert!((rocking / strip.rocking_dashpot() - 1.0).abs() < 1e-5);
        // Slow motion: everything follows the ground, the base shear is −mass times acceleration.
        let slow = sketch.shear(1e-4, StiffnessError::default());
        assert!((slow.re / (-2.0 * 1e-8) - 1.0).abs() < 1e-2, "{slow}");
        // Fast motion of a rigid mass: the ground pushes against its own dashpot.
        let rigid = Sketch::new(soil(0.3), 2.0, 1e-3, None);
        let fast = rigid.shear(1e4, StiffnessError::default());
        assert!((fast.norm() / (strip.horizontal_dashpot() * 1e4) - 1.0).abs() < 1e-2, "{fast}");
    }
}
