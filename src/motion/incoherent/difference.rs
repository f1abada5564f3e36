//! Difference between the motion of each element and that at the reference point.
//!
//! The transfer function h − 1 of an element multiplies the spectrum of the record's velocity. Between the frequencies at
//! which [`Factor`](super::random_part::Factor) gives h, means and standard deviations are interpolated by cubics. Random parts
//! of variance 1 have the weights cos and sin of one angle, so that their variance stays 1. The angle is (π/2) sin²(πs/2) on
//! the fraction s of the interval: it is so smooth that the random part of a short pulse stays within two periods of the interval.

use std::f64::consts::{FRAC_PI_2, TAU};

use basemat_fourier::RealPlanner;
use basemat_fourier::num_complex::Complex64;

use super::super::Record;
use super::super::out_of_phase::{check_rest_at_end, cubic_at};
use crate::error::{Error, Result, require};
use crate::linalg::next_smooth_even;

/// Time by which random motion precedes and follows the record, in periods of the bandwidth.
const SPREAD_PERIODS: f64 = 2.0;
/// Amplitude of a spectrum of acceleration, relative to its largest, below which no random motion is computed.
const NEGLIGIBLE_AMPLITUDE: f64 = 1e-6;
/// Largest velocity of the differences before t = 0, relative to the peak of the record.
const MAX_EARLY_VELOCITY_RATIO: f64 = 0.01;

/// Spectrum of a record's velocity, with room for the motion around the record.
pub(super) struct VelocitySpectrum {
    /// Time step, s.
    time_step: f64,
    /// Number of samples of the transform.
    length: usize,
    /// Number of samples that are stored: those of the record and of the motion after it.
    sample_count: usize,
    /// Largest velocity of the record, m/s.
    peak: f64,
    /// Fourier coefficients.
    values: Vec<Complex64>,
}

impl VelocitySpectrum {
    /// Spectrum of a record that ends at rest.
    pub(super) fn new(record: &Record, bandwidth: f64) -> Result<Self> {
        check_rest_at_end(record, "at most 1 % of its peak for incoherent motion (see Baseline)")?;
        let time_step = record.time_step();
        let spread_ratio = (SPREAD_PERIODS / (bandwidth * time_step)).ceil();
        let quantity = "bandwidth of the random motion";
        let is_resolved = spread_ratio < record.len() as f64 * MAX_SPREAD_RATIO;
        require(
            quantity,
            bandwidth,
            is_resolved,
            "higher: motion would be spread beyond the record",
        )?;
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "checked")]
        let spread_count = spread_ratio as usize;
        let sample_count = record.len() + spread_count;
        let length = next_smooth_even(sample_count + spread_count);
        let transform = RealPlanner::new().plan_fft_forward(length);
        let mut signal = transform.make_input_vec();
        signal[..record.len()].copy_from_slice(record.velocities());
        let mut values = transform.make_output_vec();
        transform.process(&mut signal, &mut values).map_err(|_| failed_transform(length))?;
        Ok(Self { time_step, length, sample_count, peak: record.peaks().velocity, values })
    }

    /// Number of samples that are stored for each element.
    pub(super) fn sample_count(&self) -> usize {
        self.sample_count
    }

    /// Frequency (Hz) of a coefficient.
    fn frequency(&self, index: usize) -> f64 {
        index as f64 / (self.length as f64 * self.time_step)
    }

    /// Number of knots, a bandwidth apart, that interpolation needs up to the highest frequency.
    pub(super) fn knot_count(&self, bandwidth: f64) -> usize {
        knot_below(self.frequency(self.values.len() - 1), bandwidth) + 3
    }

    /// Whether the record has motion within a bandwidth around each knot.
    pub(super) fn significant_knots(&self, bandwidth: f64) -> Vec<bool> {
        let mut amplitudes = vec![0.0_f64; self.knot_count(bandwidth)];
        for (index, value) in self.values.iter().enumerate() {
            let frequency = self.frequency(index);
            let knot = knot_below(frequency, bandwidth);
            let amplitude = frequency * value.norm();
            amplitudes[knot] = amplitudes[knot].max(amplitude);
            amplitudes[knot + 1] = amplitudes[knot + 1].max(amplitude);
        }
        let peak = amplitudes.iter().copied().fold(0.0, f64::max);
        amplitudes.iter().map(|amplitude| *amplitude > NEGLIGIBLE_AMPLITUDE * peak).collect()
    }
}

/// Longest spread of the random motion, as a multiple of the record.
const MAX_SPREAD_RATIO: f64 = 4.0;

/// Knot at or below a frequency, Hz.
#[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "not negative")]
fn knot_below(frequency: f64, bandwidth: f64) -> usize {
    (frequency / bandwidth) as usize
}

/// Motion of the elements relative to the reference point, at knots a bandwidth apart from 0 Hz on.
pub(super) struct Knots {
    /// Bandwidth, Hz.
    pub(super) bandwidth: f64,
    /// Mean of each element's relative motion, for each knot.
    pub(super) means: Vec<Vec<f64>>,
    /// Standard deviation of each element's random part, for each knot.
    pub(super) deviations: Vec<Vec<f64>>,
    /// Random part of each element's relative motion, of variance 1, for each knot.
    pub(super) random_parts: Vec<Vec<Complex64>>,
}

impl Knots {
    /// Transfer function h − 1 of an element at the frequencies of a spectrum.
    fn transfer(&self, element: usize, spectrum: &VelocitySpectrum) -> Vec<Complex64> {
        let means: Vec<f64> = self.means.iter().map(|means| means[element]).collect();
        let deviations: Vec<f64> = self.deviations.iter().map(|values| values[element]).collect();
        let mut transfer = Vec::with_capacity(spectrum.values.len());
        for index in 0..spectrum.values.len() {
            let frequency = spectrum.frequency(index);
            let knot = knot_below(frequency, self.bandwidth);
            let fraction = frequency / self.bandwidth - knot as f64;
            // Means are even functions of the frequency, and deviations grow with it from zero.
            let mean = cubic_between(&means, 1.0, knot, fraction);
            let deviation = cubic_between(&deviations, -1.0, knot, fraction);
            let angle = FRAC_PI_2 * (FRAC_PI_2 * fraction).sin().powi(2);
            let random_part = self.random_parts[knot][element] * angle.cos()
                + self.random_parts[knot + 1][element] * angle.sin();
            transfer.push(random_part * deviation + (mean - 1.0));
        }
        transfer
    }
}

/// Cubic between two knots with the slopes of their neighbours (Catmull and Rom), at a fraction of the interval.
///
/// Values at negative frequencies are `parity` times those at positive ones.
fn cubic_between(values: &[f64], parity: f64, knot: usize, fraction: f64) -> f64 {
    let previous_value = if knot == 0 { parity * values[1] } else { values[knot - 1] };
    let value = values[knot];
    let next_value = values[knot + 1];
    let slope = 0.5 * (next_value - previous_value);
    let next_slope = 0.5 * (values[knot + 2] - value);
    let difference = next_value - value;
    let quadratic = 3.0 * difference - 2.0 * slope - next_slope;
    let cubic = slope + next_slope - 2.0 * difference;
    value + fraction * (slope + fraction * (quadratic + fraction * cubic))
}

/// Displacement and velocity of each element minus those of the reference point, at equal time steps.
#[derive(Debug, Clone)]
pub(super) struct DifferenceSeries {
    /// Time step, s.
    time_step: f64,
    /// Number of samples of each element.
    sample_count: usize,
    /// Displacements, element by element, m; zero at t = 0.
    displacements: Vec<f64>,
    /// Velocities, m/s.
    velocities: Vec<f64>,
}

impl DifferenceSeries {
    /// Differences of `element_count` elements.
    pub(super) fn new(
        spectrum: &VelocitySpectrum,
        knots: &Knots,
        element_count: usize,
    ) -> Result<Self> {
        let VelocitySpectrum { time_step, length, sample_count, peak, .. } = *spectrum;
        let transform = RealPlanner::new().plan_fft_inverse(length);
        let mut coefficients = transform.make_input_vec();
        let mut signal = transform.make_output_vec();
        let value_count = element_count * sample_count;
        let mut series = Self {
            time_step,
            sample_count,
            displacements: Vec::with_capacity(value_count),
            velocities: Vec::with_capacity(value_count),
        };
        let scale = 1.0 / length as f64;
        let last_index = coefficients.len() - 1;
        for element in 0..element_count {
            let transfer = knots.transfer(element, spectrum);
            for is_displacement in [false, true] {
                for (index, coefficient) in coefficients.iter_mut().enumerate() {
                    *coefficient = scale * transfer[index] * spectrum.values[index];
                    if is_displacement && index > 0 {
                        *coefficient /= Complex64::new(0.0, TAU * spectrum.frequency(index));
                    }
                }
                // A real signal has real coefficients there; the mean is chosen below.
                coefficients[0] = Complex64::default();
                coefficients[last_index].im = 0.0;
                transform
                    .process(&mut coefficients, &mut signal)
                    .map_err(|_| failed_transform(length))?;
                if is_displacement {
                    let start = signal[0];
                    let values = signal[..sample_count].iter().map(|value| value - start);
                    series.displacements.extend(values);
                } else {
                    // The end of the period is the time before t = 0.
                    check_start(&signal[sample_count..], peak)?;
                    series.velocities.extend_from_slice(&signal[..sample_count]);
                }
            }
        }
        Ok(series)
    }

    /// Difference of an element's displacement at a time (s), m.
    ///
    /// Zero before t = 0, and constant after the samples.
    pub(super) fn at(&self, element: usize, time: f64) -> f64 {
        let position = time / self.time_step;
        if position.is_nan() || position <= 0.0 {
            return 0.0;
        }
        let range = element * self.sample_count..(element + 1) * self.sample_count;
        let displacements = &self.displacements[range.clone()];
        let velocities = &self.velocities[range];
        let last_index = self.sample_count - 1;
        if position >= last_index as f64 {
            return displacements[last_index];
        }
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "0..last")]
        let k = position as usize;
        let ends = [k, k + 1].map(|sample| [displacements[sample], velocities[sample]]);
        cubic_at(self.time_step, ends, position - k as f64)[0]
    }
}

/// Checks the velocities of an element's difference before t = 0, m/s.
fn check_start(early_velocities: &[f64], peak: f64) -> Result<()> {
    let quantity = "velocity of the incoherent motion before t = 0 over the record's peak";
    let needed = "at most 0.01: put quiet time before the record (`Record::padded`)";
    let max_velocity =
        early_velocities.iter().fold(0.0_f64, |max_velocity, v| max_velocity.max(v.abs()));
    let ratio = if peak == 0.0 { 0.0 } else { max_velocity / peak };
    require(quantity, ratio, ratio <= MAX_EARLY_VELOCITY_RATIO, needed).map(drop)
}

/// Error of a length that the Fourier transform does not accept.
fn failed_transform(length: usize) -> Error {
    let quantity = "number of samples of a Fourier transform";
    Error::Input { quantity, value: length as f64, needed: "one that can be transformed" }
}
