//! Damping laws of soil: shear moduli that depend on frequency.

use std::any::Any;
use std::fmt::Debug;

use crate::error::{Result, damping_ratio, not_negative, positive};
use crate::linalg::Complex;

/// Shear modulus of a soil as a function of frequency, or of the Laplace variable s.
///
/// `modulus` is μ(s)/μ₀, where μ₀ is the modulus of the [`Soil`](crate::Soil). Poisson's ratio is real and
/// constant, so λ and K are proportional to μ. The law is passive, and with it the ground at every time step,
/// if it is analytic where Re s > 0, real for real s, and
///
/// Re(μ(s)/s) ≥ 0 where Re s > 0,
///
/// which means that the relaxation function is of positive type (Christensen 1982, § 3.3). Grounds check this
/// at every s that they use. Causality makes damped waves disperse: with a damping ratio ξ over a band,
/// c(f)/c(`f_ref`) = 1 + (2ξ/π) ln(f/`f_ref`) there (Aki & Richards 2002, eq. 5.81 for Q = 1/2ξ).
///
/// ```
/// use basemat::Complex;
/// use basemat::soil::Relaxation;
///
/// /// A standard linear solid.
/// #[derive(Debug)]
/// struct Zener {
///     extra_modulus: f64,
///     rate: f64,
/// }
///
/// impl Relaxation for Zener {
///     fn modulus(&self, s: Complex) -> Complex {
///         Complex::real(1.0) + s * self.extra_modulus / (s + Complex::real(self.rate))
///     }
/// }
///
/// let law = Zener { extra_modulus: 0.2, rate: 6.0 };
/// assert_eq!(law.modulus(Complex::real(6.0)), Complex::real(1.1));
/// ```
pub trait Relaxation: Any + Debug + Send + Sync {
    /// μ(s)/μ₀ at the Laplace variable `s`, 1/s; at s = 0, the long-term modulus ratio.
    fn modulus(&self, s: Complex) -> Complex;

    /// Overwrites `moduli` with μ(s)/μ₀ at each of `s`, slices of one length.
    ///
    /// Site response calls this method for many frequencies at once. The default calls [`modulus`](Relaxation::modulus)
    /// for each. A law may compute many moduli in another way, with results equal to those of `modulus` within rounding.
    fn moduli(&self, s: &[Complex], moduli: &mut [Complex]) {
        for (modulus, s) in moduli.iter_mut().zip(s) {
            *modulus = self.modulus(*s);
        }
    }

    /// Description of the law in a few words, for tables.
    fn describe(&self) -> String {
        "user-defined law".into()
    }

    /// Whether the law can be used in the time domain; frequency-domain results need no causality.
    fn is_causal(&self) -> bool {
        true
    }

    /// Numbers that identify the law, so that grounds with equal laws can share convolution weights.
    ///
    /// The first number must differ for each kind of law. `None` (the default) for a law without such numbers.
    fn identity(&self) -> Option<Vec<f64>> {
        None
    }
}

/// Kinds of the crate's laws; the number of a kind comes first in [`Relaxation::identity`] and in files of weights.
#[derive(Clone, Copy)]
pub(super) enum DampingKind {
    Elastic,
    KelvinVoigt,
    Kjartansson,
    Hysteretic,
    GeneralizedMaxwell,
}

impl DampingKind {
    /// Identity of a law of this kind with these parameters.
    pub(super) fn with<'a>(self, parameters: impl IntoIterator<Item = &'a f64>) -> Vec<f64> {
        std::iter::once(f64::from(self as u8))
            .chain(parameters.into_iter().copied())
            .collect()
    }
}

/// No damping: μ(s) = μ₀.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Elastic;

impl Relaxation for Elastic {
    fn modulus(&self, _s: Complex) -> Complex {
        Complex::real(1.0)
    }

    fn describe(&self) -> String {
        "elastic".into()
    }

    fn identity(&self) -> Option<Vec<f64>> {
        Some(DampingKind::Elastic.with(&[]))
    }
}

/// A spring in parallel with a dashpot: μ(s)/μ₀ = 1 + η s.
///
/// The damping ratio η ω/2 grows with frequency. Wave fronts have no finite speed.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(try_from = "KelvinVoigtForm"))]
pub struct KelvinVoigt {
    /// Relaxation time η, s.
    time: f64,
}

validated! {
    KelvinVoigt as KelvinVoigtForm { time: f64 }
    => KelvinVoigt::new(time)
}

impl KelvinVoigt {
    /// Law with the relaxation time η (s).
    ///
    /// # Errors
    /// [`Error::Input`](crate::Error::Input) unless η is finite and not below zero.
    pub fn new(time: f64) -> Result<Self> {
        Ok(Self { time: not_negative("relaxation time of Kelvin–Voigt damping", time)? })
    }

    /// Law with the damping `ratio` at `frequency` (Hz).
    ///
    /// ```
    /// use basemat::Complex;
    /// use basemat::soil::{KelvinVoigt, Relaxation};
    /// let law = KelvinVoigt::with_ratio(0.05, 2.0)?;
    /// let s = Complex::new(0.0, 2.0 * std::f64::consts::TAU);
    /// assert!((law.modulus(s).im - 0.1).abs() < 1e-15); // 2ξ
    /// # Ok::<(), basemat::Error>(())
    /// ```
    ///
    /// # Errors
    /// [`Error::Input`](crate::Error::Input) for a ratio below 0 or not below 1, or a frequency that is not
    /// positive.
    pub fn with_ratio(ratio: f64, frequency: f64) -> Result<Self> {
        damping_ratio("damping ratio of a layer", ratio)?;
        positive("frequency of the damping ratio", frequency)?;
        Self::new(2.0 * ratio / (std::f64::consts::TAU * frequency))
    }
}

impl Relaxation for KelvinVoigt {
    fn modulus(&self, s: Complex) -> Complex {
        Complex::real(1.0) + s.scale(self.time)
    }

    fn describe(&self) -> String {
        format!("Kelvin–Voigt, {} s", rounded_number(self.time))
    }

    fn identity(&self) -> Option<Vec<f64>> {
        Some(DampingKind::KelvinVoigt.with(&[self.time]))
    }
}

/// Exactly constant damping at all frequencies, for comparisons (Kjartansson 1979).
///
/// μ(s)/μ₀ = (s/ω₀)^(2γ) with γ = atan(2ξ)/π, and |μ| = μ₀ at ω₀. The long-term modulus is zero, so the soil
/// has no static stiffness.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(try_from = "KjartanssonForm"))]
pub struct Kjartansson {
    /// Exponent 2γ.
    exponent: f64,
    /// Circular reference frequency ω₀, rad/s.
    reference: f64,
}

validated! {
    Kjartansson as KjartanssonForm { exponent: f64, reference: f64 }
    => Kjartansson::from_parts(exponent, reference)
}

impl Kjartansson {
    /// Law with the damping `ratio` ξ and |μ| = μ₀ at the frequency `reference` (Hz).
    ///
    /// # Errors
    /// [`Error::Input`](crate::Error::Input) for a ratio below 0 or not below 1, or a frequency that is not
    /// positive.
    pub fn new(ratio: f64, reference: f64) -> Result<Self> {
        damping_ratio("damping ratio of a layer", ratio)?;
        positive("reference frequency of a damping law", reference)?;
        let exponent = 2.0 * (2.0 * ratio).atan() / std::f64::consts::PI;
        Ok(Self { exponent, reference: std::f64::consts::TAU * reference })
    }

    /// Law from its serialized numbers: exponent 2γ and circular frequency ω₀ (rad/s).
    #[cfg(feature = "serde")]
    fn from_parts(exponent: f64, reference: f64) -> Result<Self> {
        positive("reference frequency of a damping law", reference)?;
        let is_in_range = (0.0..=1.0).contains(&exponent);
        crate::error::require(
            "exponent of Kjartansson's damping",
            exponent,
            is_in_range,
            "from 0 to 1",
        )?;
        Ok(Self { exponent, reference })
    }
}

impl Relaxation for Kjartansson {
    fn modulus(&self, s: Complex) -> Complex {
        s.scale(1.0 / self.reference).powf(self.exponent)
    }

    fn describe(&self) -> String {
        format!("Kjartansson, exponent {:.4}", self.exponent)
    }

    fn identity(&self) -> Option<Vec<f64>> {
        Some(DampingKind::Kjartansson.with(&[self.exponent, self.reference]))
    }
}

/// Hysteretic damping μ₀(1 + 2iξ sgn ω), the usual damping of the frequency domain.
///
/// The law is not analytic in s, and therefore not causal: grounds in the time domain return an error. A
/// [`GeneralizedMaxwell`](super::GeneralizedMaxwell) body is causal, and close to this law over its band.
/// [Impedances](crate::bem::ElasticGround::impedances) accept it.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(try_from = "HystereticForm"))]
pub struct Hysteretic {
    /// Damping ratio ξ.
    ratio: f64,
}

validated! {
    Hysteretic as HystereticForm { ratio: f64 }
    => Hysteretic::new(ratio)
}

impl Hysteretic {
    /// Law with the damping `ratio` ξ.
    ///
    /// # Errors
    /// [`Error::Input`](crate::Error::Input) unless 0 ≤ ξ < 1.
    pub fn new(ratio: f64) -> Result<Self> {
        Ok(Self { ratio: damping_ratio("damping ratio of a layer", ratio)? })
    }
}

impl Relaxation for Hysteretic {
    fn modulus(&self, s: Complex) -> Complex {
        let sign = if s.im == 0.0 { 0.0 } else { s.im.signum() };
        Complex::new(1.0, 2.0 * self.ratio * sign)
    }

    fn describe(&self) -> String {
        format!("hysteretic, {} %", rounded_number(100.0 * self.ratio))
    }

    fn is_causal(&self) -> bool {
        false
    }

    fn identity(&self) -> Option<Vec<f64>> {
        Some(DampingKind::Hysteretic.with(&[self.ratio]))
    }
}

/// Rounds a number to four digits, for descriptions.
pub(super) fn rounded_number(value: f64) -> f64 {
    format!("{value:.3e}").parse().unwrap_or(value)
}
