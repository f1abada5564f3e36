//! Motion computed through a site, and the magnitudes of its lost parts.

use std::fmt;

use super::SiteWarning;
use crate::linalg::{Complex, largest};

/// Ratio to the input motion above which a motion counts as amplified, because it is then mostly noise.
const AMPLIFICATION_LIMIT: f64 = 100.0;

/// Motion computed through a site, and the magnitudes of its lost parts.
///
/// Its samples have the times of the input motion. Motions are zero outside their samples, so that a part that is cut off
/// here is missing in the computation back: [`Record::padded`](crate::motion::Record::padded) adds time for it. A record
/// that is computed through a site and back equals the original within 1e-9 of its peak, at all frequencies, if both
/// motions are whole ([`SiteMotion::is_whole`]).
#[derive(Debug, Clone, PartialEq, Default)]
#[non_exhaustive]
pub struct SiteMotion {
    /// Samples of the motion.
    pub samples: Vec<f64>,
    /// Largest sample cut off before the first one, because motion at depth precedes motion of the surface.
    pub before: f64,
    /// Largest sample cut off after the last one, because waves have not yet reached the surface.
    pub after: f64,
    /// Largest sample of the part with the highest frequencies, the last 2 % below 1/2Δt.
    ///
    /// Layers delay these frequencies by whole time steps, with an error of at most half a step from the surface to any
    /// depth. The error of the motion is between a quarter of this number and four times this number.
    pub near_nyquist: f64,
    /// Estimated rounding error, which is large if deconvolution through damped layers amplifies high frequencies.
    pub rounding: f64,
    /// Lowest frequency (Hz) at which the motion is more than a hundred times the input motion.
    ///
    /// Set if most of the motion's energy is at such frequencies: see [`SiteMotion::warning`].
    pub amplified_from: Option<f64>,
}

impl SiteMotion {
    /// Fraction of the peak below which a motion counts as zero.
    pub const MAX_REST_RATIO: f64 = 1e-9;

    /// Largest sample.
    pub fn peak(&self) -> f64 {
        largest(&self.samples)
    }

    /// Whether all lost parts and rounding errors are at most [`SiteMotion::MAX_REST_RATIO`] of the peak.
    pub fn is_whole(&self) -> bool {
        self.before.max(self.after).max(self.rounding) <= Self::MAX_REST_RATIO * self.peak()
    }

    /// Warning that the motion is mostly amplified noise.
    ///
    /// In deconvolution through soft, damped soil, noise at high frequencies may exceed the motion. Usual remedies are to
    /// remove the noise before ([`Record::low_pass`], usually at 15 to 25 Hz), or to reduce damping or depth of the soil
    /// model.
    ///
    /// [`Record::low_pass`]: crate::motion::Record::low_pass
    ///
    /// ```
    /// use basemat::{Soil, unobserved};
    /// use basemat::motion::el_centro_1940;
    /// use basemat::site::{ControlPoint, SoilColumn, VerticalWave};
    /// use basemat::soil::{GeneralizedMaxwell, SoilProfile};
    /// let rock = Soil::from_shear_wave_speed(760.0, 0.25, 2200.0)?;
    /// let profile = SoilProfile::on_half_plane(rock)
    ///     .with_layer(Soil::from_shear_wave_speed(100.0, 0.4, 1700.0)?, 60.0)?
    ///     .with_damping(GeneralizedMaxwell::constant_q(0.1, [0.2, 30.0], 1.0)?);
    /// let column = SoilColumn::new(profile, VerticalWave::Shear)?;
    /// let record = el_centro_1940().padded(10.0, 20.0)?;
    /// let outcrop_motion = |record: &basemat::motion::Record| {
    ///     column.from_surface(ControlPoint::Outcrop, record.time_step(), record.accelerations(), &mut unobserved)
    /// };
    /// let amplified = outcrop_motion(&record)?;
    /// assert!(amplified.warning().is_some() && amplified.peak() > 100.0);
    /// let smooth = outcrop_motion(&record.low_pass(4.0, 8)?)?;
    /// assert!(smooth.warning().is_none() && smooth.peak() < 20.0);
    /// # Ok::<(), basemat::Error>(())
    /// ```
    pub fn warning(&self) -> Option<SiteWarning> {
        self.amplified_from.map(|frequency| SiteWarning::Amplified { frequency })
    }

    /// Number of samples up to the last one above [`SiteMotion::MAX_REST_RATIO`] of the peak.
    pub(super) fn moving_sample_count(&self) -> usize {
        let rest_limit = Self::MAX_REST_RATIO * self.peak();
        self.samples
            .iter()
            .rposition(|sample| sample.abs() > rest_limit)
            .map_or(0, |index| index + 1)
    }

    /// Truncates the motion after `count` samples, and stores the magnitude of the part cut off.
    pub(super) fn truncate(&mut self, count: usize) {
        let sample_count = count.min(self.samples.len());
        self.after = largest(&self.samples[sample_count..]);
        self.samples.truncate(sample_count);
    }
}

/// Prints the peak, and the lost parts relative to it.
impl fmt::Display for SiteMotion {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let peak = self.peak();
        write!(
            f,
            "peak {peak:.3e}; relative to it: {:.1e} cut off before the first sample, {:.1e} after the last, \
             {:.1e} near the highest frequency, {:.1e} by rounding",
            self.before / peak,
            self.after / peak,
            self.near_nyquist / peak,
            self.rounding / peak
        )
    }
}

/// Sums over the spectrum X of a motion and its product with a function F.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct SpectrumSums {
    /// Σ|F|².
    pub(super) squared_gain: f64,
    /// Σ|FX|².
    pub(super) power: f64,
    /// Part of the power at frequencies with |F| above the limit of amplification.
    pub(super) amplified_power: f64,
    /// Lowest of these frequencies, Hz.
    pub(super) lowest_amplified_frequency: Option<f64>,
}

impl SpectrumSums {
    /// Adds the next frequency, ω in rad/s.
    pub(super) fn add(&mut self, filter: Complex, product: Complex, omega: f64) {
        let squared_gain = filter.squared_modulus();
        let power = product.squared_modulus();
        self.squared_gain += squared_gain;
        self.power += power;
        if squared_gain > AMPLIFICATION_LIMIT * AMPLIFICATION_LIMIT {
            self.amplified_power += power;
            self.lowest_amplified_frequency.get_or_insert(omega / std::f64::consts::TAU);
        }
    }
}

former_constants! {
    SiteMotion { LIMIT: f64 = MAX_REST_RATIO, "use `MAX_REST_RATIO`"; }
}
