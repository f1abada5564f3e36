//! Schemes of Newmark's family: Newmark's method, HHT-α, and a scheme that dissipates at high frequencies.

use crate::coupled::scheme::{Midpoint, SchemeCoefficients, TimeScheme};
use crate::error::{Result, require};

/// Newmark's method (1959), for comparison with papers.
///
/// For other purposes use [`Midpoint`](super::Midpoint), which is average acceleration with the step's own
/// traction, or [`DissipativeMidpoint`](super::DissipativeMidpoint).
///
/// The equation of motion holds at the end of the step: u₁ = u₀ + Δt v₀ + Δt² ((½−β) a₀ + β a₁), v₁ = v₀ + Δt
/// ((1−γ) a₀ + γ a₁). Contact tractions of the step act at its end with their full value, as in Patel & Spyrakos.
/// The structure thus receives the mean of two steps' tractions, the soil the tractions of one step, and the
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
pub(crate) fn end_of_step(gamma: f64, beta: f64, h: f64) -> ([f64; 3], [f64; 3]) {
    let acceleration = [1.0 / (beta * h * h), -1.0 / (beta * h), 1.0 - 0.5 / beta];
    let velocity = [gamma / (beta * h), 1.0 - gamma / beta, h * (1.0 - 0.5 * gamma / beta)];
    (acceleration, velocity)
}

// The method of Hilber, Hughes & Taylor.

/// HHT-α (Hilber, Hughes & Taylor 1977), for comparison with papers.
///
/// Second order; it damps high frequencies of the structure alone. For other purposes use
/// [`DissipativeMidpoint`](super::DissipativeMidpoint), which is passive together with the soil.
///
/// Newmark's method with γ = ½ − α and β = (1−α)²/4, with damping and stiffness forces and loads at t₁ + α Δt and
/// inertia at t₁. Contact tractions are constant over the step and act in full: the coupling creates energy as in
/// [`Newmark`](super::Newmark), reduced by the dissipation of α. α = 0 is average acceleration; α = −⅓ damps most:
/// the spectral radius tends to (1+α)/(1−α) for steps much longer than the period, ½ at α = −⅓.
///
/// ```
/// use basemat::coupled::HhtAlpha;
/// assert!(HhtAlpha::new(-0.1).is_ok());
/// assert!(HhtAlpha::new(0.1).is_err() && HhtAlpha::new(-0.4).is_err());
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(try_from = "HhtAlphaForm"))]
pub struct HhtAlpha {
    alpha: f64,
}

validated! {
    HhtAlpha as HhtAlphaForm { alpha: f64 }
    => HhtAlpha::new(alpha)
}

impl HhtAlpha {
    /// Method with −⅓ ≤ α ≤ 0.
    ///
    /// # Errors
    /// [`Error::Input`](crate::Error::Input) outside this range.
    pub fn new(alpha: f64) -> Result<Self> {
        require("alpha", alpha, (-1.0 / 3.0..=0.0).contains(&alpha), "from -1/3 to 0")?;
        Ok(Self { alpha })
    }
}

impl TimeScheme for HhtAlpha {
    fn coefficients(&self, time_step: f64) -> SchemeCoefficients {
        let share = 1.0 + self.alpha;
        let (gamma, beta) = (0.5 - self.alpha, 0.25 * (1.0 - self.alpha).powi(2));
        let (acceleration, velocity) = end_of_step(gamma, beta, time_step);
        let [dv, v, a] = velocity;
        SchemeCoefficients {
            displacement: [share, 0.0, 0.0],
            velocity: [share * dv, share * v - self.alpha, share * a],
            acceleration,
            new_velocity: velocity,
            new_acceleration: acceleration,
            load_fraction: share,
        }
    }
}

// The midpoint rule with algorithmic damping of high frequencies.

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
/// This is the generalised-α method (Chung & Hulbert 1993) with α_f = ½ and α_m = 1 − γ. Tractions do the work on
/// the structure that they take from the soil, for any step. The scheme itself only dissipates energy, Δt² (β −
/// γ/2)(γ − ½) Δa·M Δa in a step, and stores ½ Δt² (β − γ/2) a·M a. Both together are
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
        // For γ = ½ accelerations at the ends of steps are not needed, and would alternate undamped.
        if self.gamma == 0.5 {
            return Midpoint.coefficients(time_step);
        }
        let beta = 0.25 * (self.gamma + 0.5).powi(2);
        let (new_acceleration, new_velocity) = end_of_step(self.gamma, beta, time_step);
        let [du, v, a] = new_velocity;
        SchemeCoefficients {
            displacement: [0.5, 0.0, 0.0],
            velocity: [1.0 / time_step, 0.0, 0.0],
            acceleration: [du / time_step, (v - 1.0) / time_step, a / time_step],
            new_velocity,
            new_acceleration,
            load_fraction: 0.5,
        }
    }
}
