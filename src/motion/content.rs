//! Where in frequency the energy of a motion lies.

use realfft::RealFftPlanner;

use super::Record;
#[cfg(feature = "serde")]
use crate::error::not_negative;
use crate::error::{Error, Result, positive};

/// A record is followed by zeros to at least this many times its length, so that the spectrum is
/// sampled finely enough for a lightly damped response.
const PADDING: usize = 4;

/// Lines of a flat spectrum.
const LINES: usize = 1024;

/// Distribution of ∫ a² dt, a the ground acceleration, over frequency.
///
/// Arias intensity is in proportion to the same integral. By Parseval's theorem the lines of the
/// discrete spectrum add up to it.
///
/// ```
/// use basemat::motion::{FrequencyContent, el_centro_1940};
/// let content = FrequencyContent::of(&el_centro_1940())?;
/// // Half the energy of El Centro lies below 2.34 Hz, 99 % below 14.5 Hz.
/// assert!((content.frequency_below(0.5)? - 2.34).abs() < 0.01);
/// assert!((content.frequency_below(0.99)? - 14.53).abs() < 0.01);
/// # Ok::<(), basemat::Error>(())
/// ```
#[derive(Debug, Clone, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(try_from = "FrequencyContentForm"))]
pub struct FrequencyContent {
    /// Distance of the lines, Hz; the first is at one such distance.
    spacing: f64,
    /// Energies of the lines, m²/s³.
    energy: Vec<f64>,
    /// Of the record, s.
    duration: Option<f64>,
}

validated! {
    FrequencyContent as FrequencyContentForm {
        spacing: f64,
        energy: Vec<f64>,
        duration: Option<f64>,
    }
    => {
        positive("distance of the lines", spacing)?;
        positive("highest frequency", spacing * energy.len() as f64)?;
        energy.iter().try_for_each(|&line| not_negative("energy of a line", line).map(drop))?;
        duration.map_or(Ok(0.0), |duration| positive("duration of the record", duration))?;
        FrequencyContent { spacing, energy, duration }.checked()
    }
}

impl FrequencyContent {
    /// Content of a record up to half its sampling frequency, by a discrete Fourier transform.
    ///
    /// # Errors
    /// [`Error::Input`] for a record that is zero throughout, or whose squares are not finite.
    pub fn of(record: &Record) -> Result<Self> {
        let length = (PADDING * record.len()).next_power_of_two();
        let transform = RealFftPlanner::<f64>::new().plan_fft_forward(length);
        let mut samples = transform.make_input_vec();
        samples[..record.len()].copy_from_slice(record.accelerations());
        let mut lines = transform.make_output_vec();
        // Lengths are right by construction; should they not be, nothing was transformed.
        if transform.process(&mut samples, &mut lines).is_err() {
            lines.clear();
        }
        // Σ a² Δt = (Δt/L) Σ |A|²: all lines but the first and the last stand for two.
        let scale = record.time_step() / length as f64;
        let last = lines.len().saturating_sub(1);
        let energy = lines
            .iter()
            .enumerate()
            .skip(1)
            .map(|(k, line)| (if k == last { 1.0 } else { 2.0 }) * scale * line.norm_sqr());
        let spacing = 1.0 / (length as f64 * record.time_step());
        let duration = Some(record.len() as f64 * record.time_step());
        Self { spacing, energy: energy.collect(), duration }.checked()
    }

    /// The same energy at every frequency up to `highest` (Hz), and none above: for when no more is
    /// known.
    ///
    /// # Errors
    /// [`Error::Input`] unless `highest` is finite and above zero.
    pub fn flat(highest: f64) -> Result<Self> {
        positive("highest frequency", highest)?;
        let spacing = positive("highest frequency", highest / LINES as f64)?;
        Self { spacing, energy: vec![1.0; LINES], duration: None }.checked()
    }

    fn checked(self) -> Result<Self> {
        positive("energy of the ground acceleration", self.energy.iter().sum())?;
        Ok(self)
    }

    /// Frequency (Hz) below which this share of the energy lies.
    ///
    /// # Errors
    /// [`Error::Input`] unless 0 < `share` ≤ 1.
    pub fn frequency_below(&self, share: f64) -> Result<f64> {
        if !(share > 0.0 && share <= 1.0) {
            let needed = "above 0 and at most 1";
            return Err(Error::Input { quantity: "share of the energy", value: share, needed });
        }
        let wanted = share * self.energy.iter().sum::<f64>();
        let mut sum = 0.0;
        for (frequency, energy) in self.lines() {
            sum += energy;
            if sum >= wanted {
                return Ok(frequency);
            }
        }
        Ok(self.energy.len() as f64 * self.spacing)
    }

    /// Duration of the record, s, if it is that of one.
    pub(crate) fn duration(&self) -> Option<f64> {
        self.duration
    }

    /// Frequency (Hz) and energy of each line.
    pub(crate) fn lines(&self) -> impl Iterator<Item = (f64, f64)> + '_ {
        self.energy.iter().enumerate().map(|(k, &e)| ((k + 1) as f64 * self.spacing, e))
    }
}
