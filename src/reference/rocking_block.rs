//! Free rocking of a rigid block on a rigid base.

use super::elliptic_integral::carlson_rf;
use crate::error::{Result, positive, require};

/// Rigid rectangular block that rocks about its corners on a rigid base, without sliding.
///
/// Housner, "The behavior of inverted pendulum structures during earthquakes", Bull. Seism. Soc. Am. 53 (1963), 403–417
/// (free rocking: pp. 404–406). Amplitudes θ are between 0 and the angle α of the diagonal, at which the block
/// overturns; their sign does not matter.
///
/// ```
/// use basemat::reference::RockingBlock;
/// let block = RockingBlock::new(0.5, 2.0, 9.81)?;
/// assert!((block.slenderness_angle() - 0.25_f64.atan()).abs() < 1e-15);
/// assert!((block.restitution() - 31.0 / 34.0).abs() < 1e-15);
/// let half_way = block.slenderness_angle() / 2.0;
/// assert!((block.period(half_way)? - 2.793_372_815_632).abs() < 1e-12);
/// # Ok::<(), basemat::Error>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RockingBlock {
    half_width: f64,
    half_height: f64,
    gravity: f64,
}

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

    /// Rate of the inverted pendulum p = √(3g/(4R)), R = √(b² + h²), 1/s.
    pub fn frequency_parameter(&self) -> f64 {
        (0.75 * self.gravity / self.half_width.hypot(self.half_height)).sqrt()
    }

    /// Ground acceleration g b/h at which the block starts to rock, m/s².
    pub fn uplift_acceleration(&self) -> f64 {
        self.gravity * self.half_width / self.half_height
    }

    /// Duration (s) of a rectangular pulse of this ground acceleration (m/s²) that just overturns a slender block.
    ///
    /// p t₁ = ln(x/(x − 1)), x = a/(g α), Housner 1963 (constant acceleration), with sin(α − θ) ≈ α − θ: the block at
    /// rest lifts at the begin of the pulse, and reaches α without velocity after it. A longer pulse overturns it.
    ///
    /// ```
    /// let block = basemat::reference::RockingBlock::new(0.5, 2.0, 9.81)?;
    /// let twice = 2.0 * 9.81 * block.slenderness_angle();
    /// let duration = block.overturning_pulse(twice)?;
    /// assert!((block.frequency_parameter() * duration - 2.0_f64.ln()).abs() < 1e-15);
    /// # Ok::<(), basemat::Error>(())
    /// ```
    ///
    /// # Errors
    /// [`Error::Input`](crate::Error::Input) unless the acceleration is finite and above g α, where a slender block starts
    /// to rock.
    pub fn overturning_pulse(&self, acceleration: f64) -> Result<f64> {
        let least = self.gravity * self.slenderness_angle();
        let rocks = acceleration > least && acceleration < f64::INFINITY;
        require("acceleration of the pulse", acceleration, rocks, "finite and above g α")?;
        // ln(x/(x − 1)) = −ln(1 − 1/x)
        Ok(-(-least / acceleration).ln_1p() / self.frequency_parameter())
    }

    /// Velocity V (m/s) at which two opposite impulses just overturn the block, the second one right after an impact.
    ///
    /// The ground's velocity jumps by V, and back by V when the block has fallen onto its other corner. From the moment of
    /// momentum, each jump adds 3 V cos α/(4 R) to the rate of rotation, and the impact keeps [`restitution`] η of it;
    /// from the energy, the block overturns at the rate 2 p sin(α/2), so that
    /// V = (8/3) p R sin(α/2)/((1 + η) cos α). No other time of the second impulse overturns it at a lower V.
    /// Nabeshima, Taniguchi, Kojima and Takewaki pose the problem in Frontiers in Built Environment 2 (2016), 9; their
    /// abstract was read, not their formula.
    ///
    /// ```
    /// let block = basemat::reference::RockingBlock::new(0.5, 2.0, 9.81)?;
    /// // Four times as large: twice the velocity.
    /// let large = basemat::reference::RockingBlock::new(2.0, 8.0, 9.81)?;
    /// let ratio = large.overturning_double_impulse()? / block.overturning_double_impulse()?;
    /// assert!((ratio - 2.0).abs() < 1e-14);
    /// # Ok::<(), basemat::Error>(())
    /// ```
    ///
    /// [`restitution`]: RockingBlock::restitution
    ///
    /// # Errors
    /// [`Error::Input`](crate::Error::Input) if the motion ends in an impact (η ≤ 0).
    pub fn overturning_double_impulse(&self) -> Result<f64> {
        let kept = positive("restitution of the block", self.restitution())?;
        let (angle, size) = (self.slenderness_angle(), self.half_width.hypot(self.half_height));
        let rate = 2.0 * self.frequency_parameter() * (0.5 * angle).sin();
        Ok(4.0 * size * rate / (3.0 * angle.cos() * (1.0 + kept)))
    }

    /// Ratio 1 − 1.5 sin²α of the angular velocities after and before an impact.
    ///
    /// It follows from the moment of momentum about the new corner. Housner's r is the square of this ratio.
    /// It is negative for a block with sin²α > 2/3, which stops at an impact.
    pub fn restitution(&self) -> f64 {
        1.0 - 1.5 * self.slenderness_angle().sin().powi(2)
    }

    /// Full period of rocking from amplitude θ₀ (rad) without loss, s, for slender blocks.
    ///
    /// T = (4/p) arcosh(1/(1 − θ₀/α)), Housner 1963, with sin(α − θ) ≈ α − θ. The time from release to impact
    /// is a quarter of the period.
    ///
    /// # Errors
    /// [`Error::Input`](crate::Error::Input) unless 0 < θ₀ < α.
    pub fn period_slender(&self, amplitude: f64) -> Result<f64> {
        let ratio = self.check(amplitude)? / self.slenderness_angle();
        // arcosh(1/(1−r)) = ln((1 + √(r(2−r)))/(1−r)), without cancellation at small r
        let root = (ratio * (2.0 - ratio)).sqrt();
        Ok(4.0 / self.frequency_parameter() * (root.ln_1p() - (-ratio).ln_1p()))
    }

    /// Full period of rocking from amplitude θ₀ (rad) without loss, s, for any block.
    ///
    /// T = (4/p) (K(k) − F(φ, k)), k = cos((α − θ₀)/2), sin φ = cos(α/2)/k: the pendulum's integral of
    /// θ″ = −p² sin(α − θ). The difference is computed as one integral (NIST DLMF 19.11.7), so that small
    /// amplitudes keep their digits.
    ///
    /// # Errors
    /// [`Error::Input`](crate::Error::Input) unless 0 < θ₀ < α.
    pub fn period(&self, amplitude: f64) -> Result<f64> {
        let amplitude = self.check(amplitude)?;
        let angle = self.slenderness_angle();
        let cosine = (angle / 2.0).cos();
        // k' tan ψ, where F(ψ, k) = K − F(φ, k), and k' itself
        let product = ((angle - amplitude / 2.0).sin() * (amplitude / 2.0).sin()).sqrt() / cosine;
        let tangent = product / ((angle - amplitude) / 2.0).sin();
        let integral = tangent * carlson_rf(1.0, 1.0 + product * product, 1.0 + tangent * tangent);
        Ok(4.0 / self.frequency_parameter() * integral)
    }

    /// Rate of rotation (rad/s) just before the impact that follows amplitude θ₀ (rad).
    ///
    /// p √(2 (cos(α − θ₀) − cos α)), from the conservation of energy.
    ///
    /// # Errors
    /// [`Error::Input`](crate::Error::Input) unless 0 < θ₀ < α.
    pub fn impact_rate(&self, amplitude: f64) -> Result<f64> {
        let amplitude = self.check(amplitude)?;
        let half_square =
            2.0 * (self.slenderness_angle() - amplitude / 2.0).sin() * (amplitude / 2.0).sin();
        Ok(self.frequency_parameter() * (2.0 * half_square).sqrt())
    }

    /// Amplitude θ₁ after one impact, rad.
    ///
    /// cos(α − θ₁) = cos α + η² (cos(α − θ₀) − cos α), with η the restitution.
    ///
    /// # Errors
    /// [`Error::Input`](crate::Error::Input) unless 0 < θ₀ < α.
    pub fn next_peak(&self, amplitude: f64) -> Result<f64> {
        let amplitude = self.check(amplitude)?;
        let angle = self.slenderness_angle();
        // 2 sin(α − θ/2) sin(θ/2) = cos(α − θ) − cos α on both sides, solved for θ₁ by
        // δ = α − θ₁: sin²(δ/2) = sin²(α/2) − drop/2
        let drop = 2.0
            * self.restitution().powi(2)
            * (angle - amplitude / 2.0).sin()
            * (amplitude / 2.0).sin();
        let half = (angle / 2.0).sin();
        let other = (half * half - drop / 2.0).max(0.0).sqrt();
        // θ₁/2 = asin(half) − asin(other), as one arcsine without cancellation
        let (cos_half, cos_other) = ((1.0 - half * half).sqrt(), (1.0 - other * other).sqrt());
        let sine = (drop / 2.0) / (half * cos_other + cos_half * other);
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
        let ratio = self.check(amplitude)? / angle;
        let drop = self.restitution().powi(2) * ratio * (2.0 - ratio);
        Ok(angle * drop / (1.0 + (1.0 - drop).sqrt()))
    }

    /// Times (s) of the first `count` impacts after release from amplitude θ₀ (rad).
    ///
    /// A quarter of the period of θ₀, then half the period of each following amplitude.
    ///
    /// ```
    /// let block = basemat::reference::RockingBlock::new(0.5, 2.0, 9.81)?;
    /// let times = block.impact_times(0.6 * block.slenderness_angle(), 3)?;
    /// assert!((times[2] - 3.174_832_315_3).abs() < 1e-10);
    /// # Ok::<(), basemat::Error>(())
    /// ```
    ///
    /// # Errors
    /// [`Error::Input`](crate::Error::Input) unless 0 < θ₀ < α, or if the motion ends in an impact (η ≤ 0).
    pub fn impact_times(&self, amplitude: f64, count: usize) -> Result<Vec<f64>> {
        positive("restitution of the block", self.restitution())?;
        let mut amplitude = amplitude;
        let mut time = self.period(amplitude)? / 4.0;
        let mut times = Vec::with_capacity(count.min(1024));
        for _ in 0..count {
            times.push(time);
            amplitude = self.next_peak(amplitude)?;
            time += self.period(amplitude)? / 2.0;
        }
        Ok(times)
    }

    fn check(&self, amplitude: f64) -> Result<f64> {
        let rocks = amplitude > 0.0 && amplitude < self.slenderness_angle();
        let needed = "above zero and below the slenderness angle of the block";
        require("rocking amplitude", amplitude, rocks, needed)
    }
}
