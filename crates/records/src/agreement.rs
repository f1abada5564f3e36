//! Quantities that a file states in two places, which must agree.

use crate::error::FileFault;

/// Largest difference of a stated duration, or of a stated time, that counts as rounding, relative to it.
const DURATION_TOLERANCE: f64 = 0.03;
/// Largest ratio of a stated peak and the samples' peak that a change of the baseline explains.
///
/// The closest two units differ by a factor of 2.54.
const MAX_PEAK_RATIO: f64 = 2.0;
/// Largest relative difference of two printed numbers that counts as rounding.
const PRINTED_NUMBER_TOLERANCE: f64 = 1e-3;

/// Error unless `points` samples every `step` (s) last as long as the file states.
///
/// `stated` (s) is rounded to `rounding` (s).
pub(super) fn duration(
    points: usize,
    step: f64,
    stated: f64,
    rounding: f64,
) -> Result<(), FileFault> {
    let found = points as f64 * step;
    // Some agencies count the samples, others the intervals between them.
    let agrees =
        (found - stated).abs() <= DURATION_TOLERANCE * stated.abs() + rounding + 2.0 * step;
    let quantity = "number of samples times the time step (s)";
    if agrees { Ok(()) } else { Err(contradiction(quantity, found, stated)) }
}

/// Error unless two places state the same number, up to its last printed digit.
pub(super) fn number(quantity: &'static str, found: f64, stated: f64) -> Result<(), FileFault> {
    let agrees = (found - stated).abs() <= PRINTED_NUMBER_TOLERANCE * found.abs();
    if agrees { Ok(()) } else { Err(contradiction(quantity, found, stated)) }
}

/// Error if the peak that a file states differs from the samples' peak, for example by its unit.
///
/// Both in m/s². A stated peak of zero is not checked.
pub(super) fn peak(samples: &[f64], stated: f64) -> Result<(), FileFault> {
    let mean = samples.iter().sum::<f64>() / samples.len() as f64;
    let found = largest_deviation(samples, 0.0);
    // The stated peak may refer to the samples before or after removal of the mean.
    if stated == 0.0
        || is_same_peak(found, stated)
        || is_same_peak(largest_deviation(samples, mean), stated)
    {
        return Ok(());
    }
    Err(contradiction("peak acceleration (m/s²)", found, stated))
}

/// Largest magnitude of the differences of the samples from `mean`.
fn largest_deviation(samples: &[f64], mean: f64) -> f64 {
    samples.iter().fold(0.0_f64, |largest, sample| largest.max((sample - mean).abs()))
}

/// Whether a peak of the samples may be the stated one; a peak of zero may be any.
fn is_same_peak(found: f64, stated: f64) -> bool {
    let ratio = found / stated.abs();
    ratio == 0.0 || (1.0 / MAX_PEAK_RATIO..=MAX_PEAK_RATIO).contains(&ratio)
}

/// Error unless the samples have the stated extreme at the stated time.
///
/// `time` in s, `stated` in m/s². If no sample has that value, only its size is checked.
pub(super) fn extreme(samples: &[f64], step: f64, time: f64, stated: f64) -> Result<(), FileFault> {
    peak(samples, stated)?;
    let mut first_time = None;
    for (index, sample) in samples.iter().enumerate() {
        if (sample - stated).abs() <= PRINTED_NUMBER_TOLERANCE * stated.abs() {
            let found = index as f64 * step;
            if (found - time).abs() <= DURATION_TOLERANCE * time.abs() + 2.0 * step {
                return Ok(());
            }
            first_time.get_or_insert(found);
        }
    }
    match first_time {
        None => Ok(()),
        Some(found) => Err(contradiction("time of the peak acceleration (s)", found, time)),
    }
}

fn contradiction(quantity: &'static str, found: f64, stated: f64) -> FileFault {
    FileFault::value(quantity, found.to_string(), format!("{stated}, as the file states elsewhere"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn durations_are_rounded_and_no_more() {
        for (points, step, stated, rounding) in [
            (400, 0.005, 2.0, 0.0),
            (401, 0.005, 2.0, 0.0),
            (7000, 0.01, 70.0, 1.0),
            (13_399, 0.005, 67.0, 0.0),
            (10, 0.005, 0.0, 1.0),
            (1560, 0.02, 31.0, 1.0),
        ] {
            assert_eq!(duration(points, step, stated, rounding), Ok(()), "{points} {step}");
        }
        for (points, step, stated, rounding) in [
            (400, 5e-6, 2.0, 1.0),
            (400, 5.0, 2.0, 1.0),
            (7000, 0.005, 70.0, 1.0),
            (400, 0.005, 2.5, 0.0),
        ] {
            assert!(duration(points, step, stated, rounding).is_err(), "{points} {step}");
        }
    }

    #[test]
    fn peaks_tell_units() {
        let samples = [0.1, -0.4, 0.2];
        for stated in [0.4, -0.4, 0.0, 0.37, 0.25] {
            assert_eq!(peak(&samples, stated), Ok(()), "{stated}");
        }
        for stated in [0.04, 3.92, 0.4 / 2.54, 1.01] {
            assert!(peak(&samples, stated).is_err(), "{stated}");
        }
        assert_eq!(peak(&[10.1, 10.0, 9.9], 0.1), Ok(()));
        assert_eq!(peak(&[0.0, 0.0], 3.0), Ok(()));
    }
}
