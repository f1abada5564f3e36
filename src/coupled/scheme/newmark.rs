//! Newmark's method.

use super::{SchemeCoefficients, TimeScheme};
use crate::error::{Error, Result};

/// Newmark's method (1959), equation of motion at the end of the step: **for comparison with papers**.
/// For use take [`Midpoint`](super::Midpoint), which is average acceleration with the step's own
/// traction, or [`DissipativeMidpoint`](super::DissipativeMidpoint).
///
/// u₁ = u₀ + Δt v₀ + Δt² ((½−β) a₀ + β a₁), v₁ = v₀ + Δt ((1−γ) a₀ + γ a₁). Contact tractions of the
/// step enter at its end with their full value, which is how Patel & Spyrakos couple soil and
/// structure. The structure so feels the mean of two steps' tractions, the soil those of one, and the
/// difference makes energy: the default, average acceleration (γ = ½, β = ¼), neither damps nor feeds a
/// linear structure by itself, but with soil it does. Radiation does not always outweigh it; base shears of
/// buildings on the half-plane come out larger by 8 % at 10 ms and 20 % at 20 ms, and light blocks that
/// land fly higher every time. What it makes is the negative of
/// [`EnergyBalance::numerical`](crate::coupled::EnergyBalance), and beyond 2 % of the largest energy a run ends with
/// [`Warning::AlgorithmicEnergy`](crate::coupled::Warning). On springs without dashpots it grows for ever
/// unless they act at the end of the step, too
/// ([`SpringGround::with_theta`](crate::bem::SpringGround::with_theta) of 1). Loads present at t = 0
/// belong to the static state, so that the method starts from zero acceleration; with an initial motion, or
/// a weight that acts from t = 0 on, from that of the structure before the soil has answered.
///
/// ```
/// use basemat::coupled::Newmark;
/// assert_eq!(Newmark::new(0.5, 0.25)?, Newmark::default());
/// assert!(Newmark::new(0.5, 1.0 / 6.0).is_err()); // stable for short steps only
/// # Ok::<(), basemat::Error>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(try_from = "NewmarkForm"))]
pub struct Newmark {
    gamma: f64,
    beta: f64,
}

validated! {
    Newmark as NewmarkForm { gamma: f64, beta: f64 }
    => Newmark::new(gamma, beta)
}

impl Newmark {
    /// Method with γ ≥ ½ and β ≥ γ/2, for which it is stable with steps of any length.
    ///
    /// # Errors
    /// [`Error::Input`] outside this range, and for γ > 2 or β > 10.
    pub fn new(gamma: f64, beta: f64) -> Result<Self> {
        if !(0.5..=2.0).contains(&gamma) {
            return Err(Error::Input { quantity: "gamma", value: gamma, needed: "from 0.5 to 2" });
        }
        if !(0.5 * gamma..=10.0).contains(&beta) {
            let needed = "from gamma/2 (stable for any step) to 10";
            return Err(Error::Input { quantity: "beta", value: beta, needed });
        }
        Ok(Self { gamma, beta })
    }
}

impl Default for Newmark {
    /// Average acceleration: γ = ½, β = ¼.
    fn default() -> Self {
        Self { gamma: 0.5, beta: 0.25 }
    }
}

impl TimeScheme for Newmark {
    fn coefficients(&self, time_step: f64) -> SchemeCoefficients {
        let (acceleration, velocity) = end_of_step(self.gamma, self.beta, time_step);
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

/// a₁ and v₁ from (Δu, v₀, a₀).
pub(super) fn end_of_step(gamma: f64, beta: f64, h: f64) -> ([f64; 3], [f64; 3]) {
    let acceleration = [1.0 / (beta * h * h), -1.0 / (beta * h), 1.0 - 0.5 / beta];
    let velocity = [gamma / (beta * h), 1.0 - gamma / beta, h * (1.0 - 0.5 * gamma / beta)];
    (acceleration, velocity)
}
