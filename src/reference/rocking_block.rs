//! Free rocking of a rigid block on a rigid base.

use crate::error::{Result, positive, require};

/// Rigid rectangular block that rocks about its corners on a rigid base, without sliding.
///
/// Housner, "The behavior of inverted pendulum structures during earthquakes", Bull. Seism. Soc. Am. 53 (1963), 403–417
/// (free rocking: pp. 404–406). Amplitudes θ are between 0 and the angle α of the diagonal, at which the block
/// overturns.
///
/// ```
/// use basemat::reference::RockingBlock;
/// let block = RockingBlock::new(0.5, 2.0, 9.81)?;
/// assert!((block.slenderness_angle() - 0.25_f64.atan()).abs() < 1e-15);
/// assert!((block.restitution() - 31.0 / 34.0).abs() < 1e-15);
/// let amplitude = block.slenderness_angle() / 2.0;
/// assert!((block.period(amplitude)? - 2.793_372_815_632).abs() < 1e-12);
/// # Ok::<(), basemat::Error>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RockingBlock {
    half_width: f64,
    half_height: f64,
    gravity: f64,
}

/// Largest number of impact times for which memory is reserved in advance, because a larger count may be a mistake.
const MAX_RESERVED_TIMES: usize = 1024;

impl RockingBlock {
    /// Block from half its width b and half its height h (m), under `gravity` (m/s²).
    ///
    /// # Errors
    /// [`Error::Input`](crate::Error::Input) unless all three are finite and above zero.
    pub fn new(half_width: f64, half_height: f64, gravity: f64) -> Result<Self> {
        positive("half width of the block", half_width)?;
        positive("half height of the block", half_height)?;
        positive("gravity", gravity)?;
        Ok(Self { half_width, half_height, gravity })
    }

    /// Tilt α = atan(b/h) at which the centre of gravity is above the corner, rad.
    pub fn slenderness_angle(&self) -> f64 {
        self.half_width.atan2(self.half_height)
    }

    /// Growth rate p = √(3g/(4R)) of the block as an inverted pendulum, R = √(b² + h²), 1/s.
    pub fn frequency_parameter(&self) -> f64 {
        (0.75 * self.gravity / self.half_width.hypot(self.half_height)).sqrt()
    }

    /// Ground acceleration g b/h at which the block starts to rock, m/s².
    pub fn uplift_acceleration(&self) -> f64 {
        self.gravity * self.half_width / self.half_height
    }

    /// Duration (s) of a rectangular pulse of this ground acceleration (m/s²) that just overturns a slender block.
    ///
    /// p t₁ = ln(x/(x − 1)), x = a/(g α), Housner 1963 (constant acceleration), with sin(α − θ) ≈ α − θ. The block uplifts
    /// at the start of the pulse, and reaches the angle α without velocity after the pulse. A longer pulse overturns the
    /// block.
    ///
    /// ```
    /// let block = basemat::reference::RockingBlock::new(0.5, 2.0, 9.81)?;
    /// let acceleration = 2.0 * 9.81 * block.slenderness_angle();
    /// let duration = block.overturning_pulse(acceleration)?;
    /// assert!((block.frequency_parameter() * duration - 2.0_f64.ln()).abs() < 1e-15);
    /// # Ok::<(), basemat::Error>(())
    /// ```
    ///
    /// # Errors
    /// [`Error::Input`](crate::Error::Input) unless the acceleration is finite and above g α, where a slender block starts
    /// to rock.
    pub fn overturning_pulse(&self, acceleration: f64) -> Result<f64> {
        let min_acceleration = self.gravity * self.slenderness_angle();
        let is_sufficient = acceleration > min_acceleration && acceleration < f64::INFINITY;
        require("acceleration of the pulse", acceleration, is_sufficient, "finite and above g α")?;
        // ln(x/(x − 1)) = −ln(1 − 1/x)
        Ok(-(-min_acceleration / acceleration).ln_1p() / self.frequency_parameter())
    }

    /// Velocity V (m/s) of two opposite impulses that just overturn the block.
    ///
    /// The ground's velocity jumps by V, and jumps back by V right after the first impact of the block. By the balance of
    /// angular momentum, each jump adds 3 V cos α/(4 R) to the rate of rotation, and the impact multiplies the rate by the
    /// [`restitution`] η. By the conservation of energy, the block overturns at the rate 2 p sin(α/2). Hence
    /// V = (8/3) p R sin(α/2)/((1 + η) cos α). A second impulse at any other time needs a larger V. The problem is that of
    /// Nabeshima, Taniguchi, Kojima and Takewaki, Frontiers in Built Environment 2 (2016), 9. The formula was derived from
    /// the problem in their abstract, and was not compared with theirs.
    ///
    /// ```
    /// let block = basemat::reference::RockingBlock::new(0.5, 2.0, 9.81)?;
    /// // A block of four times the size needs twice the velocity.
    /// let large_block = basemat::reference::RockingBlock::new(2.0, 8.0, 9.81)?;
    /// let ratio = large_block.overturning_double_impulse()? / block.overturning_double_impulse()?;
    /// assert!((ratio - 2.0).abs() < 1e-14);
    /// # Ok::<(), basemat::Error>(())
    /// ```
    ///
    /// [`restitution`]: RockingBlock::restitution
    ///
    /// # Errors
    /// [`Error::Input`](crate::Error::Input) if the block stops at an impact (η ≤ 0).
    pub fn overturning_double_impulse(&self) -> Result<f64> {
        let restitution = positive("restitution of the block", self.restitution())?;
        let angle = self.slenderness_angle();
        let half_diagonal = self.half_width.hypot(self.half_height);
        let overturning_rate = 2.0 * self.frequency_parameter() * (0.5 * angle).sin();
        Ok(4.0 * half_diagonal * overturning_rate / (3.0 * angle.cos() * (1.0 + restitution)))
    }

    /// Ratio 1 − 1.5 sin²α of the angular velocities after and before an impact.
    ///
    /// The ratio follows from the conservation of angular momentum about the new corner; Housner's r is its square. It is
    /// negative for a block with sin²α > 2/3, which stops at an impact.
    pub fn restitution(&self) -> f64 {
        1.0 - 1.5 * self.slenderness_angle().sin().powi(2)
    }

    /// Full period (s) of rocking with amplitude θ₀ (rad) without energy loss, for slender blocks.
    ///
    /// T = (4/p) arcosh(1/(1 − θ₀/α)), Housner 1963, with sin(α − θ) ≈ α − θ. The time from release to impact
    /// is a quarter of the period.
    ///
    /// # Errors
    /// [`Error::Input`](crate::Error::Input) unless 0 < θ₀ < α.
    pub fn period_slender(&self, amplitude: f64) -> Result<f64> {
        let ratio = self.check_amplitude(amplitude)? / self.slenderness_angle();
        // arcosh(1/(1−r)) = ln((1 + √(r(2−r)))/(1−r)), without cancellation at small r.
        let root = (ratio * (2.0 - ratio)).sqrt();
        Ok(4.0 / self.frequency_parameter() * (root.ln_1p() - (-ratio).ln_1p()))
    }

    /// Full period (s) of rocking with amplitude θ₀ (rad) without energy loss, for any block.
    ///
    /// T = (4/p) (K(k) − F(φ, k)), k = cos((α − θ₀)/2), sin φ = cos(α/2)/k: the pendulum's integral of
    /// θ″ = −p² sin(α − θ). The difference is computed as one integral (NIST DLMF 19.11.7), without
    /// cancellation at small amplitudes.
    ///
    /// # Errors
    /// [`Error::Input`](crate::Error::Input) unless 0 < θ₀ < α.
    pub fn period(&self, amplitude: f64) -> Result<f64> {
        let amplitude = self.check_amplitude(amplitude)?;
        let angle = self.slenderness_angle();
        let cosine = (angle / 2.0).cos();
        // `tangent` is tan ψ and `product` is k' tan ψ, where F(ψ, k) = K(k) − F(φ, k).
        let product = ((angle - amplitude / 2.0).sin() * (amplitude / 2.0).sin()).sqrt() / cosine;
        let tangent = product / ((angle - amplitude) / 2.0).sin();
        let integral = tangent * carlson_rf(1.0, 1.0 + product * product, 1.0 + tangent * tangent);
        Ok(4.0 / self.frequency_parameter() * integral)
    }

    /// Rate of rotation (rad/s) just before the impact after amplitude θ₀ (rad).
    ///
    /// p √(2 (cos(α − θ₀) − cos α)), from the conservation of energy.
    ///
    /// # Errors
    /// [`Error::Input`](crate::Error::Input) unless 0 < θ₀ < α.
    pub fn impact_rate(&self, amplitude: f64) -> Result<f64> {
        let amplitude = self.check_amplitude(amplitude)?;
        let cosine_difference =
            2.0 * (self.slenderness_angle() - amplitude / 2.0).sin() * (amplitude / 2.0).sin();
        Ok(self.frequency_parameter() * (2.0 * cosine_difference).sqrt())
    }

    /// Amplitude θ₁ after one impact, rad.
    ///
    /// cos(α − θ₁) = cos α + η² (cos(α − θ₀) − cos α), with η the restitution.
    ///
    /// # Errors
    /// [`Error::Input`](crate::Error::Input) unless 0 < θ₀ < α.
    pub fn next_peak(&self, amplitude: f64) -> Result<f64> {
        let amplitude = self.check_amplitude(amplitude)?;
        let angle = self.slenderness_angle();
        // The energy after the impact is η² (cos(α − θ₀) − cos α), where the difference of cosines is
        // 2 sin(α − θ₀/2) sin(θ₀/2). With δ = α − θ₁ it follows that sin²(δ/2) = sin²(α/2) − energy/2.
        let energy = 2.0
            * self.restitution().powi(2)
            * (angle - amplitude / 2.0).sin()
            * (amplitude / 2.0).sin();
        let sin_half_angle = (angle / 2.0).sin();
        let sin_half_delta = (sin_half_angle * sin_half_angle - energy / 2.0).max(0.0).sqrt();
        // θ₁/2 = α/2 − δ/2 as one arcsine, without cancellation.
        let cos_half_angle = (1.0 - sin_half_angle * sin_half_angle).sqrt();
        let cos_half_delta = (1.0 - sin_half_delta * sin_half_delta).sqrt();
        let sine =
            (energy / 2.0) / (sin_half_angle * cos_half_delta + cos_half_angle * sin_half_delta);
        Ok(2.0 * sine.asin())
    }

    /// Amplitude θ₁ after one impact, rad, for slender blocks (Housner 1963).
    ///
    /// θ₁/α = 1 − √(1 − η² (1 − (1 − θ₀/α)²)).
    ///
    /// # Errors
    /// [`Error::Input`](crate::Error::Input) unless 0 < θ₀ < α.
    pub fn next_peak_slender(&self, amplitude: f64) -> Result<f64> {
        let angle = self.slenderness_angle();
        let ratio = self.check_amplitude(amplitude)? / angle;
        // Energy after the impact, relative to the energy at overturning.
        let energy_ratio = self.restitution().powi(2) * ratio * (2.0 - ratio);
        Ok(angle * energy_ratio / (1.0 + (1.0 - energy_ratio).sqrt()))
    }

    /// Times (s) of the first `count` impacts after release from amplitude θ₀ (rad).
    ///
    /// The first time is a quarter of the period of θ₀; each interval between impacts is half the period of the amplitude
    /// in this interval.
    ///
    /// ```
    /// let block = basemat::reference::RockingBlock::new(0.5, 2.0, 9.81)?;
    /// let times = block.impact_times(0.6 * block.slenderness_angle(), 3)?;
    /// assert!((times[2] - 3.174_832_315_3).abs() < 1e-10);
    /// # Ok::<(), basemat::Error>(())
    /// ```
    ///
    /// # Errors
    /// [`Error::Input`](crate::Error::Input) unless 0 < θ₀ < α, or if the block stops at an impact (η ≤ 0).
    pub fn impact_times(&self, amplitude: f64, count: usize) -> Result<Vec<f64>> {
        positive("restitution of the block", self.restitution())?;
        let mut amplitude = amplitude;
        let mut time = self.period(amplitude)? / 4.0;
        let mut times = Vec::with_capacity(count.min(MAX_RESERVED_TIMES));
        for _ in 0..count {
            times.push(time);
            amplitude = self.next_peak(amplitude)?;
            time += self.period(amplitude)? / 2.0;
        }
        Ok(times)
    }

    /// Returns `amplitude`, or an error unless it is a possible amplitude of rocking.
    fn check_amplitude(&self, amplitude: f64) -> Result<f64> {
        let is_possible = amplitude > 0.0 && amplitude < self.slenderness_angle();
        let requirement = "above zero and below the slenderness angle of the block";
        require("rocking amplitude", amplitude, is_possible, requirement)
    }
}

/// Largest relative difference of the arguments for which the series is used; it neglects terms of the sixth power.
const MAX_SERIES_DIFFERENCE: f64 = 1e-3;

/// Carlson's symmetric elliptic integral of the first kind, `R_F`(x, y, z).
///
/// The arguments are not negative, and at most one of them is zero.
///
/// Duplication theorem and series to fifth order: Carlson, "Computing elliptic integrals by
/// duplication", Numer. Math. 33 (1979), 1–16; NIST DLMF 19.36.1.
fn carlson_rf(mut x: f64, mut y: f64, mut z: f64) -> f64 {
    loop {
        let mean = (x + y + z) / 3.0;
        let dx = 1.0 - x / mean;
        let dy = 1.0 - y / mean;
        let dz = -(dx + dy);
        if dx.abs().max(dy.abs()).max(dz.abs()) < MAX_SERIES_DIFFERENCE || !mean.is_finite() {
            let e2 = dx * dy - dz * dz;
            let e3 = dx * dy * dz;
            let series = 1.0 - e2 / 10.0 + e3 / 14.0 + e2 * e2 / 24.0 - 3.0 * e2 * e3 / 44.0;
            return series / mean.sqrt();
        }
        let lambda = (x * y).sqrt() + (y * z).sqrt() + (z * x).sqrt();
        x = (x + lambda) / 4.0;
        y = (y + lambda) / 4.0;
        z = (z + lambda) / 4.0;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Values of Carlson, "Numerical computation of real or complex elliptic integrals", Numer.
    /// Algorithms 10 (1995), 13–26, section 3.
    #[test]
    fn elliptic_integrals_have_the_values_of_carlson_1995() {
        assert!((carlson_rf(1.0, 2.0, 0.0) - 1.311_028_777_146_1).abs() < 1e-13);
        assert!((carlson_rf(2.0, 3.0, 4.0) - 0.584_082_841_677_15).abs() < 1e-13);
        assert!((carlson_rf(0.5, 1.0, 0.0) - 1.854_074_677_301_4).abs() < 1e-13);
    }
}
