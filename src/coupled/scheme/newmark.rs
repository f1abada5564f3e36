//! Newmark's method.

use crate::coupled::scheme::{SchemeCoefficients, TimeScheme};
use crate::error::{Result, require};

/// Newmark's method (1959), for comparison with papers.
///
/// For other purposes use [`Midpoint`](super::Midpoint), which is average acceleration with the step's own
/// traction, or [`DissipativeMidpoint`](super::DissipativeMidpoint).
///
/// The equation of motion holds at the end of the step: u₁ = u₀ + Δt v₀ + Δt² ((½−β) a₀ + β a₁), v₁ = v₀ + Δt
/// ((1−γ) a₀ + γ a₁). Contact tractions of the step act at its end with their full value, as in Patel & Spyrakos.
/// The structure thus receives the mean of the tractions of two steps, but the soil the tractions of one step. This
/// difference creates energy. The default, average acceleration (γ = ½, β = ¼), conserves the energy of a linear
/// structure alone, but not with soil. Radiation does not always outweigh the created energy: base shears of
/// buildings on the half-plane are too large by 8 % at 10 ms and 20 % at 20 ms, and light blocks rebound higher at
/// every impact. The created energy is the negative of
/// [`EnergyBalance::algorithmic`](crate::coupled::EnergyBalance); beyond 2 % of the largest energy a run ends with
/// [`Warning::AlgorithmicEnergy`](crate::coupled::Warning). On springs without dashpots it grows without limit,
/// unless the springs also act at the end of the step
/// ([`SpringGround::with_theta`](crate::bem::SpringGround::with_theta) of 1). Loads present at t = 0 belong to the
/// static state, so the method starts from zero acceleration. With an initial motion, or a weight that acts from t
/// = 0 on, it starts from the structure's acceleration before the soil has responded.
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
    /// Method with γ ≥ ½ and β ≥ γ/2, stable for steps of any length.
    ///
    /// # Errors
    /// [`Error::Input`](crate::Error::Input) outside this range, and for γ > 2 or β > 10.
    pub fn new(gamma: f64, beta: f64) -> Result<Self> {
        require("gamma", gamma, (0.5..=2.0).contains(&gamma), "from 0.5 to 2")?;
        let needed = "from gamma/2 (stable for any step) to 10";
        require("beta", beta, (0.5 * gamma..=10.0).contains(&beta), needed)?;
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
        let EndMotion { acceleration, velocity } = end_of_step(self.gamma, self.beta, time_step);
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

/// Coefficients of acceleration a₁ and velocity v₁ at the end of a step of Newmark's formulas.
pub(crate) struct EndMotion {
    pub(crate) acceleration: [f64; 3],
    pub(crate) velocity: [f64; 3],
}

/// Motion at the end of a step of `h` seconds, from (Δu, v₀, a₀).
pub(crate) fn end_of_step(gamma: f64, beta: f64, h: f64) -> EndMotion {
    let acceleration = [1.0 / (beta * h * h), -1.0 / (beta * h), 1.0 - 0.5 / beta];
    let velocity = [gamma / (beta * h), 1.0 - gamma / beta, h * (1.0 - 0.5 * gamma / beta)];
    EndMotion { acceleration, velocity }
}
