//! Generalised Maxwell body: nearly constant damping over a band of frequencies.

use super::nonnegative_least_squares::nonnegative_least_squares;
use super::relaxation::{DampingKind, Relaxation, rounded_number};
use crate::error::{Error, Result, damping_ratio, not_negative, positive, require, same_length};
use crate::linalg::{Complex, ComplexArithmetic, Lanes, Simd, WithSimd, vectorized};

/// Nearly constant damping over a band: a generalised Maxwell body.
///
/// The body is a spring in parallel with mechanisms, each a spring in series with a dashpot: μ(s)/μ₀ = m (1 + Σ yᵢ
/// s/(s + ωᵢ)). It is causal, and passive for yᵢ ≥ 0 (Emmerich & Korn 1987).
///
/// It is the usual choice for soil in the time domain. The long-term modulus ratio m of a fitted body is below 1: the
/// static response is softer than waves at the reference frequency.
#[derive(Debug, Clone, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(try_from = "GeneralizedMaxwellForm"))]
pub struct GeneralizedMaxwell {
    /// Long-term modulus ratio m.
    long_term: f64,
    /// Ratios yᵢ of the mechanisms.
    ratios: Vec<f64>,
    /// Relaxation rates ωᵢ of the mechanisms, 1/s.
    rates: Vec<f64>,
    /// Damping ratio, and lowest and highest frequency (Hz), to which the body was fitted; `None` for other bodies.
    fitted: Option<[f64; 3]>,
}

validated! {
    GeneralizedMaxwell as GeneralizedMaxwellForm {
        long_term: f64,
        ratios: Vec<f64>,
        rates: Vec<f64>,
        #[serde(default)]
        fitted: Option<[f64; 3]>,
    }
    => GeneralizedMaxwell::new(long_term, ratios, rates).map(|body| Self { fitted: fitted.filter(is_band), ..body })
}

/// Whether the three numbers are a damping ratio and an ascending band of frequencies.
#[cfg(feature = "serde")]
fn is_band([ratio, low, high]: &[f64; 3]) -> bool {
    *ratio >= 0.0 && *low > 0.0 && low < high && (ratio + high).is_finite()
}

/// Number of frequencies of the fit: several for each of at most 14 mechanisms.
const FIT_FREQUENCIES: usize = 120;
/// Number of mechanisms per decade of frequency.
///
/// Two keep the damping ratio within 5 % of its target in the bands that the tests below try.
const MECHANISMS_PER_DECADE: f64 = 2.0;
/// Factor by which the relaxation rates extend beyond the band at both ends.
const BAND_EXTENSION_FACTOR: f64 = 1.8;
/// Largest relative deviation from the damping ratio in the band with which a fit is accepted.
const MAX_DAMPING_DEVIATION: f64 = 0.15;
/// Largest ratio of the band's frequencies: soil needs no more, and the number of mechanisms is at most 14.
const MAX_BAND_RATIO: f64 = 1e6;

impl GeneralizedMaxwell {
    /// Body with the long-term modulus ratio m, the ratios yᵢ and the relaxation rates ωᵢ (1/s).
    ///
    /// # Errors
    /// [`Error::Input`](crate::Error::Input) unless m and all ωᵢ are positive and no yᵢ is negative;
    /// [`Error::Size`](crate::Error::Size) for lists of different lengths.
    pub fn new(long_term: f64, ratios: Vec<f64>, rates: Vec<f64>) -> Result<Self> {
        positive("long-term modulus ratio of a layer", long_term)?;
        same_length("rates of a generalised Maxwell body", rates.len(), ratios.len())?;
        for (&ratio, &rate) in ratios.iter().zip(&rates) {
            not_negative("ratio of a Maxwell mechanism", ratio)?;
            positive("rate of a Maxwell mechanism", rate)?;
        }
        Ok(Self { long_term, ratios, rates, fitted: None })
    }

    /// Body with the damping `ratio` ξ over `band` (lowest and highest frequency, Hz).
    ///
    /// Re μ = μ₀ at the frequency `reference` (Hz). Im μ = 2ξ Re μ is fitted by nonnegative least squares,
    /// with two mechanisms per decade and two more. The damping ratio is usually within a few per cent of ξ; a fit with
    /// an error above 15 % is not returned.
    ///
    /// ```
    /// use basemat::soil::GeneralizedMaxwell;
    /// let law = GeneralizedMaxwell::constant_q(0.05, [0.1, 30.0], 1.0)?;
    /// for frequency in [0.1, 0.5, 3.0, 30.0] {
    ///     assert!((law.damping_ratio(frequency) - 0.05).abs() < 0.003);
    /// }
    /// # Ok::<(), basemat::Error>(())
    /// ```
    ///
    /// # Errors
    /// [`Error::Input`](crate::Error::Input) for a ratio below 0 or not below 1, for frequencies that are not
    /// positive, and for a band that does not increase or spans more than a factor of 1e6.
    /// [`Error::Accuracy`] for a ratio that no body reaches.
    pub fn constant_q(ratio: f64, band: [f64; 2], reference: f64) -> Result<Self> {
        damping_ratio("damping ratio of a layer", ratio)?;
        positive("lowest frequency of the damping band", band[0])?;
        positive("reference frequency of a damping law", reference)?;
        let band_ratio = band[1] / band[0];
        let quantity = "highest frequency of the damping band over the lowest";
        require(
            quantity,
            band_ratio,
            band_ratio > 1.0 && band_ratio <= MAX_BAND_RATIO,
            "above 1 and at most 1e6",
        )?;
        if ratio == 0.0 {
            return Ok(Self {
                fitted: Some([0.0, band[0], band[1]]),
                ..Self::new(1.0, vec![], vec![])?
            });
        }
        #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "at most 14")]
        let mechanism_count = (MECHANISMS_PER_DECADE * band_ratio.log10()).ceil() as usize + 2;
        let min_omega = std::f64::consts::TAU * band[0];
        let rates = relaxation_rates(min_omega, band_ratio, mechanism_count);
        let mut omegas = Vec::with_capacity(FIT_FREQUENCIES);
        for i in 0..FIT_FREQUENCIES {
            omegas.push(min_omega * band_ratio.powf(i as f64 / (FIT_FREQUENCIES - 1) as f64));
        }
        let mut matrix = Vec::with_capacity(FIT_FREQUENCIES * mechanism_count);
        for omega in &omegas {
            for rate in &rates {
                let denominator = omega * omega + rate * rate;
                matrix
                    .push(0.5 * omega * rate / (ratio * denominator) - omega * omega / denominator);
            }
        }
        let mechanism_ratios =
            nonnegative_least_squares(&matrix, mechanism_count, &[1.0; FIT_FREQUENCIES]);
        let body = Self::new(1.0, mechanism_ratios, rates)?;
        let reference_modulus =
            body.modulus(Complex::new(0.0, std::f64::consts::TAU * reference)).re;
        let body = Self {
            long_term: 1.0 / reference_modulus,
            fitted: Some([ratio, band[0], band[1]]),
            ..body
        };
        let max_deviation = omegas
            .iter()
            .map(|omega| (body.damping_ratio(omega / std::f64::consts::TAU) / ratio - 1.0).abs())
            .fold(0.0, f64::max);
        if max_deviation <= MAX_DAMPING_DEVIATION {
            return Ok(body);
        }
        let remedy =
            "by a generalised Maxwell body; take a narrower band or a smaller damping ratio";
        Err(Error::Accuracy {
            quantity: "damping ratio over the band",
            reached: max_deviation,
            tolerance: MAX_DAMPING_DEVIATION,
            remedy: remedy.to_owned(),
        })
    }

    /// Damping ratio Im μ/(2 Re μ) at `frequency` (Hz).
    pub fn damping_ratio(&self, frequency: f64) -> f64 {
        let modulus = self.modulus(Complex::new(0.0, std::f64::consts::TAU * frequency));
        0.5 * modulus.im / modulus.re
    }
}

/// Relaxation rates of a fit (1/s), with equal ratios from below the band to above it.
///
/// `min_omega`: lowest circular frequency of the band, 1/s; `band_ratio`: highest frequency over the lowest.
fn relaxation_rates(min_omega: f64, band_ratio: f64, mechanism_count: usize) -> Vec<f64> {
    let mut rates = Vec::with_capacity(mechanism_count);
    for i in 0..mechanism_count {
        let extended_band_ratio = band_ratio * BAND_EXTENSION_FACTOR * BAND_EXTENSION_FACTOR;
        let fraction = i as f64 / (mechanism_count - 1) as f64;
        rates.push(min_omega / BAND_EXTENSION_FACTOR * extended_band_ratio.powf(fraction));
    }
    rates
}

impl Relaxation for GeneralizedMaxwell {
    fn modulus(&self, s: Complex) -> Complex {
        let mut sum = Complex::real(1.0);
        for (ratio, rate) in self.ratios.iter().zip(&self.rates) {
            sum += s.scale(*ratio) / (s + Complex::real(*rate));
        }
        sum.scale(self.long_term)
    }

    fn moduli(&self, s: &[Complex], moduli: &mut [Complex]) {
        vectorized(ModuliAtMany { body: self, s, moduli });
    }

    fn describe(&self) -> String {
        match self.fitted {
            Some([ratio, low, high]) => {
                let percent = rounded_number(100.0 * ratio);
                format!("{percent} % from {} to {} Hz", rounded_number(low), rounded_number(high))
            }
            None => format!("{} Maxwell mechanisms", self.rates.len()),
        }
    }

    fn identity(&self) -> Option<Vec<f64>> {
        let leading_numbers = [self.long_term, self.rates.len() as f64];
        Some(
            DampingKind::GeneralizedMaxwell
                .with(leading_numbers.iter().chain(&self.ratios).chain(&self.rates)),
        )
    }
}

/// Moduli of a body at many Laplace variables.
struct ModuliAtMany<'a> {
    body: &'a GeneralizedMaxwell,
    s: &'a [Complex],
    moduli: &'a mut [Complex],
}

impl WithSimd for ModuliAtMany<'_> {
    type Output = ();

    #[allow(clippy::inline_always, reason = "to be compiled for the instructions of its caller")]
    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        let Self { body, s, moduli } = self;
        let lane_count = Lanes::<S>::LANE_COUNT;
        for (s, moduli) in s.chunks(lane_count).zip(moduli.chunks_mut(lane_count)) {
            let s = Lanes::load(simd, s);
            // y s/(s + ω) = y − y ω/(s + ω).
            let mut sum = s.like_real(1.0 + body.ratios.iter().sum::<f64>());
            for (ratio, rate) in body.ratios.iter().zip(&body.rates) {
                sum = sum - (s + s.like_real(*rate)).inverse().scale(ratio * rate);
            }
            sum.scale(body.long_term).store(moduli);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Error;

    /// Speed of shear waves at a frequency (Hz), relative to √(μ₀/ρ).
    fn wave_speed(body: &GeneralizedMaxwell, frequency: f64) -> f64 {
        let modulus = body.modulus(Complex::new(0.0, std::f64::consts::TAU * frequency));
        1.0 / modulus.sqrt().inverse().re
    }

    #[test]
    fn damping_is_constant_over_the_band_and_waves_disperse_by_causality() {
        for (ratio, band) in
            [(0.01, [0.1, 30.0]), (0.05, [0.1, 30.0]), (0.1, [0.05, 50.0]), (0.2, [0.5, 20.0])]
        {
            let body = GeneralizedMaxwell::constant_q(ratio, band, 1.0).unwrap();
            let mut max_deviation: f64 = 0.0;
            for i in 0..=200 {
                let frequency = band[0] * (band[1] / band[0]).powf(f64::from(i) / 200.0);
                max_deviation =
                    max_deviation.max((body.damping_ratio(frequency) / ratio - 1.0).abs());
            }
            println!("{ratio} {band:?}: {max_deviation:.4}, long term {:.4}", body.long_term);
            assert!(max_deviation < 0.05, "{ratio} {max_deviation}");
            let at_reference = body.modulus(Complex::new(0.0, std::f64::consts::TAU));
            assert!((at_reference.re - 1.0).abs() < 1e-14);
            assert!(body.ratios.iter().all(|y| *y >= 0.0));
            let growth = (wave_speed(&body, 4.0) / wave_speed(&body, 1.0) - 1.0)
                / (2.0 * ratio / std::f64::consts::PI * 4.0_f64.ln());
            assert!((growth - 1.0).abs() < 0.25, "{ratio} {growth}");
        }
    }

    #[test]
    fn bad_bands_and_bodies_are_errors() {
        for (ratio, band, reference) in [
            (-0.1, [0.1, 10.0], 1.0),
            (f64::NAN, [0.1, 10.0], 1.0),
            (0.05, [10.0, 0.1], 1.0),
            (0.05, [0.0, 10.0], 1.0),
            (0.05, [0.1, f64::INFINITY], 1.0),
            (0.05, [0.1, 10.0], 0.0),
        ] {
            let result = GeneralizedMaxwell::constant_q(ratio, band, reference);
            assert!(matches!(result, Err(Error::Input { .. })), "{result:?}");
        }
        let result = GeneralizedMaxwell::constant_q(0.99, [0.1, 10.0], 1.0);
        assert!(matches!(result, Err(Error::Accuracy { .. })), "{result:?}");
        assert!(GeneralizedMaxwell::new(1.0, vec![-0.1], vec![1.0]).is_err());
        assert!(GeneralizedMaxwell::new(1.0, vec![0.1], vec![]).is_err());
    }
}
