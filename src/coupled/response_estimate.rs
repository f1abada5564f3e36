//! Base shear of a sketched structure in the frequency domain: what advice on mesh and step is
//! estimated from.
//!
//! A rigid rectangle (or one of which a part sways as a single oscillator) stands on a rigid strip,
//! bonded. Unknowns are its translation u and rotation θ, u at the depth e below the base where a
//! horizontal force does not turn the strip. With M(ω) the mass matrix about this point, the oscillator
//! condensed into it, and K(ω) = diag(k_h, k_r),
//!
//! ```text
//! (K(ω) − ω² M(ω)) [u, θ] = K(ω) [u_ff, 0],      V = k_h (u_ff − u)
//! ```
//!
//! Steps of Δt, φ = ωΔt/2. The midpoint rule sees (2/Δt) tan φ for ω, and forces act on the mean of the
//! displacements at both ends. Tractions constant over the step have, beside ω, all frequencies
//! ω + 2πn/Δt, at which the soil is a dashpot c; their sum over n makes of a flexibility G(ω)
//!
//! ```text
//! sin φ cos φ (G(ω)/φ + κ (1/sin²φ − 1/φ²) Δt/(2ic)),      κ = c ∫ t² dx / (ρc' K²)
//! ```
//!
//! the second term of which is damping that the steps add, (ωΔt)² being small: what a lightly damped
//! rocking response feels most. κ would be 1 if the tractions t of the strip at low frequency were those of
//! a rigid dashpot; they are singular at the edges, which makes it more.
//!
//! | symbol | meaning | unit here |
//! |---|---|---|
//! | a₀ | ωB/c_S, B half the width | – |
//! | k_h | horizontal stiffness of the strip for rotation about the depth e | μ |
//! | k_r | rocking stiffness of the strip that is free to translate | μB² |
//! | m, s, i | mass, its first and second moment | ρB², ρB³, ρB⁴ |
//! | c, c' | dashpot of the strip at high frequency; wave speed of each traction, c_S or c_P | |

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
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(deny_unknown_fields))]
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
    /// e of the static strip.
    depth: f64,
    mass: f64,
    height: f64,
    /// a₀ of the first mode on a fixed base, and its damping ratio.
    sway: Option<[f64; 2]>,
    /// Rate of decay that stands for the end of the motion.
    decay: f64,
}

/// Steps, and the elements on which they are taken.
#[derive(Debug, Clone, Copy)]
pub(super) struct Steps {
    /// Over B/c_S.
    pub(super) step: f64,
    /// Length of the element at the edge, over B.
    pub(super) edge: f64,
}

impl Sketch {
    /// From mass over ρB², height over B, the a₀ and damping ratio of the sway, and the duration of the
    /// motion over B/c_S, if it has one.
    ///
    /// Errors of a lightly damped response grow from cycle to cycle until it has decayed, or the motion
    /// is over. The transform of V e^(−σt) is V at the frequency ω − iσ; with σ = 0.75/duration the error
    /// of V comes out as that of histories as long as the motion (170 scenes, `docs/validation.md`).
    pub(super) fn new(
        soil: Soil,
        mass: f64,
        height: f64,
        sway: Option<[f64; 2]>,
        duration: Option<f64>,
    ) -> Self {
        let poisson = soil.poisson();
        let oscillation = (3.0 - 4.0 * poisson).ln() / (2.0 * PI);
        Self {
            poisson,
            speeds: soil.speed_ratio_squared().sqrt().recip(),
            rocking: PI / (2.0 * (1.0 - poisson)) * (1.0 + 4.0 * oscillation * oscillation),
            depth: 2.0 * oscillation,
            mass,
            height,
            sway,
            decay: duration.map_or(0.0, |duration| 0.75 / duration),
        }
    }

    /// k_h and k_r: the limits of `reference::RigidStrip`, and in between rational functions near the
    /// bonded strip's tables (Luco & Westmann's problem), see the test.
    fn stiffness(&self, a: f64) -> [C; 2] {
        let real = 1.17 / (1.0 - self.poisson) * a / (a + 0.06);
        let horizontal = C::new(real, 2.0 * a + 0.3 * a / ((a + 0.1) * (1.0 + a)));
        // The dashpot begins with a²: waves of both edges cancel.
        let delay = 0.48 * self.speeds / (1.0 + 0.5 * a);
        let radiated = self.dashpots()[1] * a * a / (a + delay);
        [horizontal, C::new(self.rocking / (1.0 + 0.23 * a), radiated)]
    }

    /// c, horizontal and rocking.
    fn dashpots(&self) -> [f64; 2] {
        [2.0, 2.0 / 3.0 * self.speeds]
    }

    /// e: static limit, and a low-pass of the second order.
    fn depth(&self, a: f64) -> C {
        self.depth / C::new(1.0 - 0.3 * a * a, 1.3 * a)
    }

    /// V/u_ff.
    pub(super) fn shear(&self, a: f64, error: StiffnessError) -> C {
        let [k_h, k_r] = self.stiffness(a);
        let stiffness = [k_h * (1.0 - error.horizontal), k_r * (1.0 - error.rocking)];
        self.response(a, stiffness, self.depth(a))
    }

    /// V/u_ff of steps: mean force of the step over the displacement of the free field.
    pub(super) fn stepped_shear(&self, a: f64, steps: Steps) -> C {
        let Steps { step, edge } = steps;
        // Beyond the step's Nyquist frequency all is lost: the warped one ends there.
        let phase = (0.5 * a * step).min(1.5);
        let [sin, cos] = [phase.sin(), phase.cos()];
        // 1/sin²φ − 1/φ²
        let excess = if phase < 0.05 {
            1.0 / 3.0 + phase * phase / 15.0
        } else {
            1.0 / (sin * sin) - 1.0 / (phase * phase)
        };
        // t of the static strip is k/(π √(B²−x²)) and 2kx/(πB² √(B²−x²)): ∫ t² up to a distance from the
        // edges, and what is beyond as its mean. Waves of a step even out a quarter of what they pass.
        let near = (2.0 / edge.max(0.25 * step).min(2.0)).ln();
        let factors = [2.0 * (near + 4.0), 8.0 / 3.0 * (near + 2.0)].map(|f| f / (PI * PI));
        let stiffness = self.stiffness(a);
        let dashpots = self.dashpots();
        let seen = std::array::from_fn(|k| {
            let added = C::new(0.0, -0.5 * factors[k] * step * excess / dashpots[k]);
            (sin * cos * (stiffness[k].inv() / phase + added)).inv()
        });
        self.response(2.0 / step * (sin / cos), seen, self.depth(a)) * cos
    }

    /// V/u_ff of masses at the frequency a on these stiffnesses.
    fn response(&self, a: f64, [k_h, k_r]: [C; 2], depth: C) -> C {
        let frequency = C::new(a, -self.decay);
        let [m, s, i] = self.moments(frequency);
        let (s, i) = (s + m * depth, i + (2.0 * s + m * depth) * depth);
        let square = frequency * frequency;
        let [d_h, coupling, d_r] = [k_h - m * square, s * square, k_r - i * square];
        // 1 − u/u_ff without cancellation at low frequency.
        let lag = -(m * square * d_r + coupling * coupling) / (d_h * d_r - coupling * coupling);
        k_h * lag
    }

    /// m, s and i about the base, with the oscillator condensed.
    fn moments(&self, a: C) -> [C; 3] {
        let (m, h) = (self.mass, self.height);
        let rigid = [m, 0.5 * m * h, m * (4.0 + h * h) / 12.0 + 0.25 * m * h * h];
        let mut moments = rigid.map(|value| C::new(value, 0.0));
        if let Some([natural, damping]) = self.sway {
            let ratio = a / natural;
            // A trace of damping keeps a line on the frequency itself off the pole.
            let spring = 1.0 + C::new(0.0, 2.0 * damping.max(1e-6)) * ratio;
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

#[cfg(all(test, feature = "reference"))]
mod tests {
    use super::*;
    use crate::reference::RigidStrip;

    fn soil(poisson: f64) -> Soil {
        Soil::new(1.0, poisson, 1.0).unwrap()
    }

    /// Against rows of `tests/data/strip_bonded_nu*_xi00.csv`: `khh`, 1/`crr` and `chr/crr`.
    #[test]
    fn stiffnesses_are_near_the_tables() {
        let third = 1.0 / 3.0;
        for (poisson, a, wanted) in [
            (third, 0.1, [[1.150, 0.527], [2.395, 0.0138], [0.159, -0.024]]),
            (third, 0.5, [[1.586, 1.315], [2.194, 0.2699], [0.114, -0.084]]),
            (third, 1.0, [[1.750, 2.183], [1.968, 0.7812], [0.051, -0.107]]),
            (third, 2.0, [[1.770, 4.001], [1.562, 1.9762], [-0.032, -0.077]]),
            (third, 4.0, [[1.618, 7.922], [0.959, 5.0792], [-0.032, 0.014]]),
            (0.25, 0.1, [[1.055, 0.503], [2.175, 0.0131], [0.216, -0.029]]),
            (0.25, 1.0, [[1.605, 2.138], [1.800, 0.7260], [0.086, -0.126]]),
            (0.0, 0.1, [[0.863, 0.459], [1.743, 0.0130], [0.341, -0.045]]),
            (0.0, 0.5, [[1.217, 1.221], [1.593, 0.2374], [0.253, -0.148]]),
            (0.0, 1.0, [[1.321, 2.074], [1.454, 0.6545], [0.149, -0.177]]),
            (0.0, 4.0, [[1.176, 8.028], [1.126, 3.6952], [0.012, -0.058]]),
        ] {
            let sketch = Sketch::new(soil(poisson), 1.0, 1.0, None, None);
            let [k_h, k_r] = sketch.stiffness(a);
            let wanted = wanted.map(|[re, im]| C::new(re, im));
            for (found, wanted) in [k_h, k_r].into_iter().zip(wanted) {
                let error = (found - wanted).norm() / wanted.norm();
                assert!(error < 0.19, "ν = {poisson}, a₀ = {a}: {found} for {wanted}");
            }
            // Radiation damping in rocking by itself: what limits a slender structure's response.
            let error = k_r.im / wanted[1].im - 1.0;
            assert!(error.abs() < 0.25, "ν = {poisson}, a₀ = {a}: {k_r} for {}", wanted[1]);
            // Where it is more than an eighth of B it moves the centre of rotation.
            let error = (sketch.depth(a) - wanted[2]).norm();
            assert!(
                error < 0.125,
                "ν = {poisson}, a₀ = {a}: {} for {}",
                sketch.depth(a),
                wanted[2]
            );
        }
    }

    /// A rigid mass that does not turn, at frequencies at which the ground is a dashpot: the midpoint
    /// rule on it in closed form.
    #[test]
    fn steps_on_a_dashpot_are_the_midpoint_rule() {
        let sketch = Sketch { depth: 0.0, ..Sketch::new(soil(0.3), 3.0, 1e-6, None, None) };
        // A uniform traction makes the factor of the dashpot 1; this edge makes it as much.
        let edge = 2.0 / (PI * PI / 2.0 - 4.0).exp();
        let (a, step) = (4000.0, 1e-4_f64);
        let warped = 2.0 / step * (0.5 * a * step).tan();
        let [dashpot, inertia] = [C::new(0.0, 2.0 * warped), C::from(3.0 * warped * warped)];
        let wanted = -dashpot * inertia / (dashpot - inertia) * (0.5 * a * step).cos();
        let found = sketch.stepped_shear(a, Steps { step, edge });
        assert!((found / wanted - 1.0).norm() < 2e-3, "{found} for {wanted}");
    }

    #[test]
    fn limits_are_the_strips() {
        let strip = RigidStrip::new(soil(0.3), 1.0).unwrap();
        let sketch = Sketch::new(soil(0.3), 2.0, 3.0, Some([1.0, 0.05]), None);
        let [_, rocking] = sketch.stiffness(1e-9);
        assert!((rocking.re / strip.bonded_rocking_stiffness() - 1.0).abs() < 1e-8);
        let [horizontal, rocking] = sketch.stiffness(1e6).map(|k| k.im / 1e6);
        assert!((horizontal / strip.horizontal_dashpot() - 1.0).abs() < 1e-5);
        assert!((rocking / strip.rocking_dashpot() - 1.0).abs() < 1e-5);
        // Slow motion: everything follows the ground, the base shear is −mass times acceleration.
        let slow = sketch.shear(1e-4, StiffnessError::default());
        assert!((slow.re / (-2.0 * 1e-8) - 1.0).abs() < 1e-2, "{slow}");
        // Fast motion of a rigid mass: the ground pushes against its own dashpot.
        let rigid = Sketch::new(soil(0.3), 2.0, 1e-3, None, None);
        let fast = rigid.shear(1e4, StiffnessError::default());
        assert!((fast.norm() / (strip.horizontal_dashpot() * 1e4) - 1.0).abs() < 1e-2, "{fast}");
    }
}
