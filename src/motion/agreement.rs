//! Quantities that a file states in two places, which must agree.

use crate::error::FileFault;

/// Difference of a stated and the samples' duration that counts as rounding, relative to the duration.
const DURATION: f64 = 0.03;
/// Largest factor between a stated and the samples' peak that a change of the baseline explains.
///
/// The closest two units differ by a factor of 2.54.
const PEAK: f64 = 2.0;
/// Relative difference of a stated extreme and a sample that counts as rounding.
const NEAR: f64 = 1e-3;

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
    let agrees = (found - stated).abs() <= DURATION * stated.abs() + rounding + 2.0 * step;
    let quantity = "number of samples times the time step (s)";
    if agrees { Ok(()) } else { Err(contradiction(quantity, found, stated)) }
}

/// Error unless two places state the same number, up to its last printed digit.
pub(super) fn number(quantity: &'static str, found: f64, stated: f64) -> Result<(), FileFault> {
    let agrees = (found - stated).abs() <= 1e-3 * found.abs();
    if agrees { Ok(()) } else { Err(contradiction(quantity, found, stated)) }
}

/// Error if the peak that a file states differs from the samples' peak, for example by its unit.
///
/// Both in m/s². A stated peak of zero is not checked.
pub(super) fn peak(samples: &[f64], stated: f64) -> Result<(), FileFault> {
    let largest = |mean: f64| samples.iter().fold(0.0_f64, |most, a| most.max((a - mean).abs()));
    let mean = samples.iter().sum::<f64>() / samples.len() as f64;
    // The stated peak may refer to the samples before or after removal of the mean.
    let near = |found: f64| {
        let ratio = found / stated.abs();
        ratio == 0.0 || (1.0 / PEAK..=PEAK).contains(&ratio)
    };
    let found = largest(0.0);
    if stated == 0.0 || near(found) || near(largest(mean)) {
        return Ok(());
    }
    Err(contradiction("peak acceleration (m/s²)", found, stated))
}

/// Error unless the samples have the extreme that a file states (m/s², at a time in s), in time and size.
pub(super) fn extreme(samples: &[f64], step: f64, time: f64, stated: f64) -> Result<(), FileFault> {
    peak(samples, stated)?;
    let close = |a: f64| (a - stated).abs() <= NEAR * stated.abs();
    let mut times = (0..samples.len()).filter(|&k| close(samples[k])).map(|k| k as f64 * step);
    let Some(first) = times.next() else { return Ok(()) };
    let agrees = |found: f64| (found - time).abs() <= DURATION * time.abs() + 2.0 * step;
    if agrees(first) || times.any(agrees) {
        return Ok(());
    }
    Err(contradiction("time of the peak acceleration (s)", first, time))
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
