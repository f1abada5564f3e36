//! Time schemes of the structure.

mod dissipative_midpoint;
mod hht_alpha;
mod newmark;

pub use crate::coupled::scheme::dissipative_midpoint::DissipativeMidpoint;
pub use crate::coupled::scheme::hht_alpha::HhtAlpha;
pub use crate::coupled::scheme::newmark::Newmark;

use crate::error::{Result, finite, require};

/// Relative difference of two coefficients that counts as rounding.
const COEFFICIENT_ROUNDING_TOLERANCE: f64 = 1e-12;

/// Coefficients of a time scheme.
///
/// They define the time of the equation of motion in the step, and the motion at the end of the step.
///
/// Each array has the coefficients of (Δu, v₀, a₀): the displacement increment of the step, and the velocity and
/// acceleration at its start. The equation of motion `M a* + C v* + K u* + f(u*) + BᵀA τ = p(t*)` has
/// `u* = u₀ + displacement·(Δu, v₀, a₀)`, and so on. Contact tractions τ are constant over the step.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SchemeCoefficients {
    /// Displacement u* − u₀.
    pub displacement: [f64; 3],
    /// Velocity v*.
    pub velocity: [f64; 3],
    /// Acceleration a*.
    pub acceleration: [f64; 3],
    /// Velocity v₁ at the end of the step.
    pub new_velocity: [f64; 3],
    /// Acceleration a₁ at the end of the step.
    pub new_acceleration: [f64; 3],
    /// Time (t* − t₀)/Δt of the external load.
    pub load_fraction: f64,
}

/// Time stepping of the structure's equation of motion.
///
/// Contact and soil do not depend on the scheme. They use displacements at the ends of steps and tractions that are constant
/// within steps. The work τ·Δu of the tractions on the structure equals the work that the soil loses. A scheme in which
/// Δu·(M a* + K u*) is not the change of energy plus a loss adds energy to the run.
///
/// | scheme | order | energy with the soil | use |
/// |---|---|---|---|
/// | [`Midpoint`] | 2 | conserved | general: the default |
/// | [`DissipativeMidpoint`] | 2 | reduced | general, with high frequencies damped |
/// | [`Theta`] | 1 | reduced | strong damping |
/// | [`Newmark`], [`HhtAlpha`] | 1, with the soil | may grow | comparison with papers |
#[auto_impl::auto_impl(Box)]
pub trait TimeScheme: Send {
    /// The coefficients for steps of `time_step` seconds.
    fn coefficients(&self, time_step: f64) -> SchemeCoefficients;
}

/// Implicit midpoint rule (the default): second order, conserves energy exactly, also with soil.
///
/// It is Newmark's average acceleration with the traction of the step itself. If impacts excite frequencies that the time
/// step does not resolve, [`DissipativeMidpoint`] damps these frequencies.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Midpoint;

impl TimeScheme for Midpoint {
    fn coefficients(&self, time_step: f64) -> SchemeCoefficients {
        theta_coefficients(0.5, time_step)
    }
}

/// θ-method: dissipative at high frequencies for θ > ½, and passive together with the soil.
///
/// For θ = ½ it is the midpoint rule. For θ > ½ it is of first order. [`DissipativeMidpoint`] is dissipative and of second
/// order.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(try_from = "ThetaForm"))]
pub struct Theta {
    theta: f64,
}

validated! {
    Theta as ThetaForm { theta: f64 }
    => Theta::new(theta)
}

impl Theta {
    /// Method with ½ ≤ θ ≤ 1.
    ///
    /// # Errors
    /// [`Error::Input`](crate::Error::Input) outside this range.
    pub fn new(theta: f64) -> Result<Self> {
        require("theta", theta, (0.5..=1.0).contains(&theta), "from 0.5 to 1")?;
        Ok(Self { theta })
    }
}

impl TimeScheme for Theta {
    fn coefficients(&self, time_step: f64) -> SchemeCoefficients {
        theta_coefficients(self.theta, time_step)
    }
}

/// Coefficients of the θ-method: u₁ − u₀ = Δt (θ v₁ + (1−θ) v₀).
///
/// The equation of motion has the same weights.
fn theta_coefficients(theta: f64, time_step: f64) -> SchemeCoefficients {
    let acceleration = [1.0 / (theta * time_step * time_step), -1.0 / (theta * time_step), 0.0];
    SchemeCoefficients {
        displacement: [theta, 0.0, 0.0],
        velocity: [1.0 / time_step, 0.0, 0.0],
        acceleration,
        new_velocity: [1.0 / (theta * time_step), -(1.0 - theta) / theta, 0.0],
        new_acceleration: acceleration,
        load_fraction: theta,
    }
}

impl SchemeCoefficients {
    /// Returns an error for coefficients that are not finite.
    pub(crate) fn check(&self) -> Result<()> {
        let motion = [self.displacement, self.velocity, self.acceleration];
        let end_motion = [self.new_velocity, self.new_acceleration, [self.load_fraction; 3]];
        motion
            .into_iter()
            .chain(end_motion)
            .flatten()
            .try_for_each(|value| finite("coefficient of the time scheme", value).map(|_| ()))
    }

    /// Whether the scheme conserves kinetic and linear strain energy.
    ///
    /// It does if Δu = Δt (v₀+v₁)/2, a* = (v₁−v₀)/Δt and u* = u₀ + Δu/2.
    pub(crate) fn conserves_energy(&self, time_step: f64) -> bool {
        let h = time_step;
        let v1 = self.new_velocity;
        let is_equal =
            |a: f64, b: f64, scale: f64| (a - b).abs() <= COEFFICIENT_ROUNDING_TOLERANCE * scale;
        let mean_acceleration = [v1[0] / h, (v1[1] - 1.0) / h, v1[2] / h];
        let mean_velocity_increment = [0.5 * h * v1[0], 0.5 * h * (v1[1] + 1.0), 0.5 * h * v1[2]];
        // Scales of Δu, v₀ and a₀ in a displacement.
        let scales = [1.0, h, h * h];
        (0..3).all(|k| {
            let increment = if k == 0 { 1.0 } else { 0.0 };
            is_equal(self.acceleration[k], mean_acceleration[k], scales[k] / (h * h))
                && is_equal(mean_velocity_increment[k], increment, scales[k])
                && is_equal(self.displacement[k], 0.5 * increment, scales[k])
        })
    }

    /// Sum of the coefficients times (Δu, v₀, a₀).
    pub(crate) fn apply(
        coefficients: [f64; 3],
        increment: f64,
        velocity: f64,
        acceleration: f64,
    ) -> f64 {
        coefficients[0] * increment + coefficients[1] * velocity + coefficients[2] * acceleration
    }

    /// Writes the sums of the coefficients times the vectors (Δu, v₀, a₀) to `sums`.
    pub(crate) fn combine(
        coefficients: [f64; 3],
        increment: &[f64],
        velocity: &[f64],
        acceleration: &[f64],
        sums: &mut [f64],
    ) {
        let terms = increment.iter().zip(velocity).zip(acceleration);
        for (sum, ((du, v), a)) in sums.iter_mut().zip(terms) {
            *sum = Self::apply(coefficients, *du, *v, *a);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Error of the free vibration u'' = −ω² u after one period.
    fn error_after_a_period(scheme: &dyn TimeScheme, steps: usize) -> f64 {
        let omega = 3.0_f64;
        let time_step = std::f64::consts::TAU / omega / steps as f64;
        let c = scheme.coefficients(time_step);
        let mut u = 1.0_f64;
        let mut v = 0.0;
        let mut a = -omega * omega;
        for _ in 0..steps {
            let stiffness = c.acceleration[0] + omega * omega * c.displacement[0];
            let residual = SchemeCoefficients::apply(c.acceleration, 0.0, v, a)
                + omega * omega * (u + SchemeCoefficients::apply(c.displacement, 0.0, v, a));
            let du = -residual / stiffness;
            let next_velocity = SchemeCoefficients::apply(c.new_velocity, du, v, a);
            a = SchemeCoefficients::apply(c.new_acceleration, du, v, a);
            v = next_velocity;
            u += du;
        }
        ((u - 1.0).powi(2) + (v / omega).powi(2)).sqrt()
    }

    #[test]
    fn midpoint_is_second_order_and_theta_first() {
        let order = |scheme: &dyn TimeScheme| {
            (error_after_a_period(scheme, 100) / error_after_a_period(scheme, 200)).log2()
        };
        assert!((order(&Midpoint) - 2.0).abs() < 0.05);
        assert!((order(&Theta::new(0.6).unwrap()) - 1.0).abs() < 0.1);
    }

    #[test]
    fn only_the_midpoint_rule_conserves() {
        assert!(Midpoint.coefficients(1e-3).conserves_energy(1e-3));
        assert!(!Theta::new(0.5001).unwrap().coefficients(1e-3).conserves_energy(1e-3));
    }

    #[test]
    fn theta_out_of_range_is_an_error() {
        for theta in [0.49, 1.01, f64::NAN] {
            assert!(Theta::new(theta).is_err());
        }
    }
}
