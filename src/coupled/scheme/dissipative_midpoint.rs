//! Midpoint rule with algorithmic damping of high frequencies.

use super::newmark::{EndMotion, end_of_step};
use crate::coupled::scheme::{Midpoint, SchemeCoefficients, TimeScheme};
use crate::error::{Result, require};

/// Midpoint rule that damps high frequencies: second order, and passive together with the soil.
///
/// It uses Newmark's formulas for displacement and velocity, with the equation of motion in the middle of the step
/// and the step's own traction:
///
/// ```text
/// M Δv/Δt + C Δu/Δt + K (u₀ + u₁)/2 + f(ū) = p(t_½) − Bᵀ A τ,      β = (γ + ½)²/4
/// Δu = Δt (v₀ + v₁)/2 + Δt² (β − γ/2) Δa,      Δv = Δt (a₀ + γ Δa)
/// ```
///
/// This is the generalised-α method (Chung & Hulbert 1993) with α_f = ½ and α_m = 1 − γ. For any step the work of the
/// tractions on the structure equals the work that the soil loses. The scheme itself only dissipates energy,
/// Δt² (β − γ/2)(γ − ½) Δa·M Δa in a step, and stores ½ Δt² (β − γ/2) a·M a. The sum of both is
/// [`EnergyBalance::algorithmic`](crate::coupled::EnergyBalance) (proof in `docs/theory.md`, section 8). γ = ½ is
/// [`Midpoint`].
///
/// Spectral radius, the factor per step of a free vibration of circular frequency ω:
///
/// | ωΔt | 0.1 | 1 | 3 | 10 | 30 |
/// |---|---|---|---|---|---|
/// | γ = 0.6 | 1.0000 | 0.9999 | 0.9972 | 0.9766 | 0.9443 |
/// | γ = 0.8 | 1.0000 | 0.9976 | 0.9570 | 0.8478 | 0.9306 |
/// | γ = 1 | 1.0000 | 0.9907 | 0.8873 | 0.7082 | 0.9630 |
///
/// It returns to 1 for ωΔt → ∞, where displacements alternate with a bounded amplitude. Use it if accelerations
/// contain frequencies that the step does not resolve: after impacts on fine elements, or in a structure with
/// vibrations much faster than the response. Accelerations of the state belong to the time (γ − ½) Δt before the end of
/// the step. An initial motion needs accelerations at t = 0, and so a mass matrix that is not singular.
///
/// ```
/// use basemat::coupled::DissipativeMidpoint;
/// assert_eq!(DissipativeMidpoint::new(0.8)?, DissipativeMidpoint::default());
/// assert!(DissipativeMidpoint::new(0.4).is_err() && DissipativeMidpoint::new(1.1).is_err());
/// # Ok::<(), basemat::Error>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(try_from = "DissipativeMidpointForm"))]
pub struct DissipativeMidpoint {
    gamma: f64,
}

validated! {
    DissipativeMidpoint as DissipativeMidpointForm { gamma: f64 }
    => DissipativeMidpoint::new(gamma)
}

impl DissipativeMidpoint {
    /// Method with ½ ≤ γ ≤ 1; damping grows with γ from zero.
    ///
    /// # Errors
    /// [`Error::Input`](crate::Error::Input) outside this range.
    pub fn new(gamma: f64) -> Result<Self> {
        require("gamma", gamma, (0.5..=1.0).contains(&gamma), "from 0.5 to 1")?;
        Ok(Self { gamma })
    }
}

impl Default for DissipativeMidpoint {
    /// γ = 0.8.
    fn default() -> Self {
        Self { gamma: 0.8 }
    }
}

impl TimeScheme for DissipativeMidpoint {
    fn coefficients(&self, time_step: f64) -> SchemeCoefficients {
        // For γ = ½ the accelerations at the ends of steps are not needed. They would alternate without damping.
        if self.gamma == 0.5 {
            return Midpoint.coefficients(time_step);
        }
        let beta = 0.25 * (self.gamma + 0.5).powi(2);
        let EndMotion { acceleration: new_acceleration, velocity: new_velocity } =
            end_of_step(self.gamma, beta, time_step);
        SchemeCoefficients {
            displacement: [0.5, 0.0, 0.0],
            velocity: [1.0 / time_step, 0.0, 0.0],
            acceleration: [
                new_velocity[0] / time_step,
                (new_velocity[1] - 1.0) / time_step,
                new_velocity[2] / time_step,
            ],
            new_velocity,
            new_acceleration,
            load_fraction: 0.5,
        }
    }
}
