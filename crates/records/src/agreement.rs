//! Quantities that a file states in two places, which must agree.

use crate::error::FileFault;

/// Largest accepted difference from a stated duration or time, relative to the stated value.
///
/// Some stated durations are approximate; a wrong unit or time step causes a larger difference.
const DURATION_TOLERANCE: f64 = 0.03;
/// Largest ratio of a stated peak and the samples' peak.
///
/// A change of the baseline may explain a ratio up to this one. The closest two units differ by a factor of 2.54.
const MAX_PEAK_RATIO: f64 = 2.0;
/// Largest relative difference of two printed numbers that counts as rounding.
const PRINTED_NUMBER_TOLERANCE: f64 = 1e-3;

/// Returns an error unless the samples last as long as the file states.
///
/// `time_step`: s. `stated_duration` (s) is rounded to `stated_rounding` (s).
pub(super) fn check_duration(
    sample_count: usize,
    time_step: f64,
    stated_duration: f64,
    stated_rounding: f64,
) -> Result<(), FileFault> {
    let computed_duration = sample_count as f64 * time_step;
    // Some agencies count the samples, others the intervals between them.
    let agrees = (computed_duration - stated_duration).abs()
        <= DURATION_TOLERANCE * stated_duration.abs() + stated_rounding + 2.0 * time_step;
    let quantity = "number of samples times the time step (s)";
    if agrees {
        Ok(())
    } else {
        Err(contradiction(quantity, computed_duration, stated_duration))
    }
}

/// Returns an error unless two places state the same number, up to [`PRINTED_NUMBER_TOLERANCE`].
pub(super) fn check_number(
    quantity: &'static str,
    value: f64,
    stated_value: f64,
) -> Result<(), FileFault> {
    let agrees = (value - stated_value).abs() <= PRINTED_NUMBER_TOLERANCE * value.abs();
    if agrees { Ok(()) } else { Err(contradiction(quantity, value, stated_value)) }
}

/// Returns an error if the stated peak is in another unit than the samples.
///
/// Both in m/s²; the stated peak may have either sign. A stated peak of zero is not checked.
pub(super) fn check_peak(samples: &[f64], stated_peak: f64) -> Result<(), FileFault> {
    let mean = samples.iter().sum::<f64>() / samples.len() as f64;
    let computed_peak = max_deviation(samples, 0.0);
    // An agency may state the peak of the samples with or without their mean.
    if stated_peak == 0.0
        || may_be_same_peak(computed_peak, stated_peak)
        || may_be_same_peak(max_deviation(samples, mean), stated_peak)
    {
        return Ok(());
    }
    Err(contradiction("peak acceleration (m/s²)", computed_peak, stated_peak))
}

/// Largest magnitude of the differences of the samples from `reference`.
fn max_deviation(samples: &[f64], reference: f64) -> f64 {
    samples
        .iter()
        .fold(0.0_f64, |max_magnitude, sample| max_magnitude.max((sample - reference).abs()))
}

/// Whether the stated peak may be that of the samples.
///
/// Samples of zero agree with any stated peak.
fn may_be_same_peak(computed_peak: f64, stated_peak: f64) -> bool {
    let ratio = computed_peak / stated_peak.abs();
    ratio == 0.0 || (1.0 / MAX_PEAK_RATIO..=MAX_PEAK_RATIO).contains(&ratio)
}

/// Returns an error unless the samples have the stated extreme at the stated time.
///
/// `stated_time`: s. `stated_value`: m/s². If no sample has that value, only its unit is checked.
pub(super) fn check_extreme(
    samples: &[f64],
    time_step: f64,
    stated_time: f64,
    stated_value: f64,
) -> Result<(), FileFault> {
    check_peak(samples, stated_value)?;
    let mut first_match_time = None;
    for (index, sample) in samples.iter().enumerate() {
        if (sample - stated_value).abs() <= PRINTED_NUMBER_TOLERANCE * stated_value.abs() {
            let sample_time = index as f64 * time_step;
            if (sample_time - stated_time).abs()
                <= DURATION_TOLERANCE * stated_time.abs() + 2.0 * time_step
            {
                return Ok(());
            }
            first_match_time.get_or_insert(sample_time);
        }
    }
    match first_match_time {
        None => Ok(()),
        Some(match_time) => {
            Err(contradiction("time of the peak acceleration (s)", match_time, stated_time))
        }
    }
}

fn contradiction(quantity: &'static str, value: f64, stated_value: f64) -> FileFault {
    FileFault::value(
        quantity,
        value.to_string(),
        format!("{stated_value}, as the file states elsewhere"),
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn durations_agree_up_to_rounding() {
        for (sample_count, time_step, stated_duration, stated_rounding) in [
            (400, 0.005, 2.0, 0.0),
            (401, 0.005, 2.0, 0.0),
            (7000, 0.01, 70.0, 1.0),
            (13_399, 0.005, 67.0, 0.0),
            (10, 0.005, 0.0, 1.0),
            (1560, 0.02, 31.0, 1.0),
        ] {
            assert_eq!(
                check_duration(sample_count, time_step, stated_duration, stated_rounding),
                Ok(()),
                "{sample_count} {time_step}"
            );
        }
        for (sample_count, time_step, stated_duration, stated_rounding) in [
            (400, 5e-6, 2.0, 1.0),
            (400, 5.0, 2.0, 1.0),
            (7000, 0.005, 70.0, 1.0),
            (400, 0.005, 2.5, 0.0),
        ] {
            assert!(
                check_duration(sample_count, time_step, stated_duration, stated_rounding).is_err(),
                "{sample_count} {time_step}"
            );
        }
    }

    #[test]
    fn peak_in_another_unit_is_an_error() {
        let samples = [0.1, -0.4, 0.2];
        for stated_peak in [0.4, -0.4, 0.0, 0.37, 0.25] {
            assert_eq!(check_peak(&samples, stated_peak), Ok(()), "{stated_peak}");
        }
        for stated_peak in [0.04, 3.92, 0.4 / 2.54, 1.01] {
            assert!(check_peak(&samples, stated_peak).is_err(), "{stated_peak}");
        }
        assert_eq!(check_peak(&[10.1, 10.0, 9.9], 0.1), Ok(()));
        assert_eq!(check_peak(&[0.0, 0.0], 3.0), Ok(()));
    }
}
