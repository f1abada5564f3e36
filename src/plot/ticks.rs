//! Marks of axes at round numbers, and their texts.

use std::ops::Range;

/// Largest number of letters of a mark; longer marks are written as differences from an offset.
const MAX_MARK_LETTERS: usize = 9;

/// Marks of an axis: values and names.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Ticks {
    pub(super) marks: Vec<(f64, String)>,
    /// Offset to be added to the names; `None` if it is zero.
    pub(super) offset: Option<String>,
}

/// Relative difference of steps and powers of ten that is due to rounding.
const STEP_ROUNDING: f64 = 1e-9;
/// Distance of an end of a range from a multiple of the step that is due to rounding, relative to the step.
const MULTIPLE_ROUNDING: f64 = 1e-6;
/// Largest multiple of the step that is zero apart from rounding, relative to the step.
const ZERO_ROUNDING: f64 = 1e-3;
/// Smallest magnitude that is written with a power of ten because it is large.
const MIN_LARGE_VALUE: f64 = 1e6;
/// Smallest step between values below one that are written without a power of ten.
const MIN_DECIMAL_STEP: f64 = 1e-4;
/// Number of letters up to which a decimal number is written, although a power of ten would be shorter.
const SHORT_DECIMAL_LETTERS: usize = 6;

/// The next number at or above `value` that is 1, 2 or 5 times a power of ten.
pub(super) fn rounded_step(value: f64) -> f64 {
    let power = 10.0_f64.powf(value.log10().floor());
    let steps = [1.0, 2.0, 5.0, 10.0].map(|factor| factor * power);
    // A step that is below `value` only by rounding counts as equal.
    steps
        .into_iter()
        .find(|step| *step >= (1.0 - STEP_ROUNDING) * value)
        .unwrap_or(10.0 * power)
}

/// The largest number at or below `value` that is 1, 2 or 5 times a power of ten.
pub(super) fn round_down(value: f64) -> f64 {
    let power = 10.0_f64.powf(value.log10().floor());
    let factor = [5.0, 2.0, 1.0].into_iter().find(|factor| factor * power <= value);
    factor.unwrap_or(1.0) * power
}

/// Multiples of a rounded step in a range.
struct Multiples {
    step: f64,
    values: Vec<f64>,
}

/// Multiples of a rounded step in a range, about `max_count` or fewer.
fn multiples(range: &Range<f64>, max_count: usize) -> Multiples {
    let step = rounded_step((range.end - range.start) / max_count.max(1) as f64);
    let first_multiple = (range.start / step - MULTIPLE_ROUNDING).ceil();
    let last_multiple = (range.end / step + MULTIPLE_ROUNDING).floor();
    #[allow(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "at most 2 max_count"
    )]
    let interval_count =
        (last_multiple - first_multiple).clamp(0.0, 2.0 * max_count as f64) as usize;
    // Adding zero removes a negative sign of zero.
    let values = (0..=interval_count).map(|k| (first_multiple + k as f64) * step + 0.0).collect();
    Multiples { step, values }
}

/// Marks at multiples of 1, 2 or 5 times a power of ten, about `count` or fewer.
pub(super) fn linear_ticks(range: &Range<f64>, count: usize) -> Ticks {
    let mut multiples_in_range = multiples(range, count);
    if multiples_in_range.values.len() < 2 {
        // One mark alone shows no scale.
        multiples_in_range = multiples(range, 3 * count);
    }
    let Multiples { step, values } = multiples_in_range;
    let mut names: Vec<String> = values.iter().map(|value| mark_text(*value, step)).collect();
    let mut offset = None;
    if names.iter().any(|name| name.chars().count() > MAX_MARK_LETTERS) {
        offset = Some(names[0].clone());
        names = values.iter().map(|value| mark_text(value - values[0], step)).collect();
    }
    Ticks { marks: values.into_iter().zip(names).collect(), offset }
}

/// Exponent of the power of ten at or below a number.
fn exponent(value: f64) -> i32 {
    #[allow(clippy::cast_possible_truncation, reason = "-324 to 308")]
    let exponent = (value.abs().log10() + STEP_ROUNDING).floor() as i32;
    exponent
}

/// Text of a multiple of `step`, with the digits that distinguish it from its neighbours.
pub(super) fn mark_text(value: f64, step: f64) -> String {
    // This multiple differs from zero by rounding only.
    if value.abs() < ZERO_ROUNDING * step {
        return "0".to_owned();
    }
    let decimals = usize::try_from(-exponent(step)).unwrap_or(0);
    let decimal_text = format!("{value:.decimals$}");
    // Numbers far from one are written with powers of ten.
    if value.abs() < MIN_LARGE_VALUE && (step >= MIN_DECIMAL_STEP || value.abs() >= 1.0) {
        return decimal_text;
    }
    let digits = usize::try_from(exponent(value) - exponent(step)).unwrap_or(0);
    let exponent_text = format!("{value:.digits$e}");
    let is_short = decimal_text.len() <= exponent_text.len().max(SHORT_DECIMAL_LETTERS);
    if is_short { decimal_text } else { exponent_text }
}

/// Marks at 1, 2, 5, 10, … of a logarithmic axis, at the logarithms of these values.
pub(super) fn logarithmic_ticks(range: &Range<f64>, count: usize) -> Ticks {
    let factors = [&[1.0, 2.0, 5.0][..], &[1.0, 3.0], &[1.0]];
    let candidates = factors.map(|factors| factors_of_ten(range, factors));
    let fitting = candidates.iter().find(|values| values.len() <= count && values.len() > 1);
    // If none fits, `ChartAxis::layout` omits marks that overlap; powers of ten alone would be too few.
    let chosen_values = fitting.or(candidates.iter().find(|values| values.len() > 1));
    let values = chosen_values.cloned().unwrap_or_default();
    if values.len() < 3 && range.end < 10.0 * range.start {
        let Ticks { mut marks, offset } = linear_ticks(range, count.min(5));
        marks.retain(|(value, _)| *value > 0.0);
        for (value, _) in &mut marks {
            *value = value.log10();
        }
        return Ticks { marks, offset };
    }
    let mut marks = Vec::with_capacity(values.len());
    for value in values {
        marks.push((value.log10(), mark_text(value, 10.0_f64.powi(exponent(value)))));
    }
    Ticks { marks, offset: None }
}

/// The `factors` times powers of ten within a range.
fn factors_of_ten(range: &Range<f64>, factors: &[f64]) -> Vec<f64> {
    let low = range.start * (1.0 - STEP_ROUNDING);
    let high = range.end * (1.0 + STEP_ROUNDING);
    let mut values = Vec::new();
    for power in exponent(low)..=exponent(high) {
        for factor in factors {
            let value = factor * 10.0_f64.powi(power);
            if (low..=high).contains(&value) {
                values.push(value);
            }
        }
    }
    values
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Names of the marks of a linear axis, and their offset.
    fn linear_names(range: Range<f64>) -> (Vec<String>, Option<String>) {
        let ticks = linear_ticks(&range, 5);
        for mark in &ticks.marks {
            assert!(range.start - 1e-3 <= mark.0 && mark.0 <= range.end + 1e-3);
            assert!(mark.1.chars().count() <= MAX_MARK_LETTERS, "{mark:?}");
        }
        (ticks.marks.into_iter().map(|mark| mark.1).collect(), ticks.offset)
    }

    fn assert_linear(range: Range<f64>, names: &[&str], offset: Option<&str>) {
        let names = names.iter().map(|&name| name.to_owned()).collect();
        assert_eq!(linear_names(range), (names, offset.map(Into::into)));
    }

    fn logarithmic_names(range: Range<f64>, count: usize) -> Vec<String> {
        logarithmic_ticks(&range, count).marks.into_iter().map(|mark| mark.1).collect()
    }

    #[test]
    fn no_two_marks_read_the_same() {
        assert_linear(0.0..10.0, &["0", "2", "4", "6", "8", "10"], None);
        assert_linear(-0.1..0.11, &["-0.10", "-0.05", "0", "0.05", "0.10"], None);
        assert_linear(1.0..1.004, &["1.000", "1.001", "1.002", "1.003", "1.004"], None);
        let tiny_marks = ["0", "2e-6", "4e-6", "6e-6", "8e-6", "1.0e-5"];
        assert_linear(
            1.000_01..1.000_02,
            &["1.000010", "1.000012", "1.000014", "1.000016", "1.000018", "1.000020"],
            None,
        );
        assert_linear(100.000_01..100.000_02, &tiny_marks, Some("100.000010"));
        let millions = ["1000000", "1000001", "1000002", "1000003", "1000004"];
        assert_linear(1e6..1e6 + 4.0, &millions, None);
        assert_linear(0.0..3e6, &["0", "1e6", "2e6", "3e6"], None);
        // Steps of five would leave one mark.
        let fine_marks = linear_ticks(&(-4.8..4.8), 4).marks;
        assert_eq!(
            fine_marks.iter().map(|mark| mark.0).collect::<Vec<_>>(),
            [-4.0, -3.0, -2.0, -1.0, 0.0, 1.0, 2.0, 3.0, 4.0]
        );
        assert_linear(-2e-9..2e-9, &["-2e-9", "-1e-9", "0", "1e-9", "2e-9"], None);
        for range in [-1e60..1e60, 1e-60..3e-60, 1e12..1e12 + 2000.0, -1e-300..2e59] {
            let mut names = linear_names(range.clone()).0;
            let count = names.len();
            assert!((2..=11).contains(&count), "{range:?} {names:?}");
            names.dedup();
            assert_eq!(names.len(), count, "{range:?} {names:?}");
        }
    }

    #[test]
    fn logarithmic_marks() {
        assert_eq!(logarithmic_names(0.05..2.0, 14), ["0.05", "0.1", "0.2", "0.5", "1", "2"]);
        assert_eq!(
            logarithmic_names(1.1..1.35, 14),
            ["1.10", "1.15", "1.20", "1.25", "1.30", "1.35"]
        );
        assert_eq!(logarithmic_names(1e-6..1e6, 14).len(), 13);
        // A narrow picture has space for few marks, and one mark alone shows no scale.
        assert_eq!(logarithmic_names(0.05..3.0, 3), ["0.1", "1"]);
        assert_eq!(logarithmic_names(0.2..3.0, 3), ["0.3", "1", "3"]);
        assert_eq!(logarithmic_names(0.05..1.1, 3), ["0.1", "0.3", "1"]);
    }
}
