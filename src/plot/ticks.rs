//! Where an axis has its marks, and what is written there.

use std::ops::Range;

/// Most letters of a mark: what needs more is written as a difference.
const LETTERS: usize = 9;

/// Marks of an axis: place and name.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Ticks {
    pub(super) marks: Vec<(f64, String)>,
    /// Offset to be added to the names, where it is not zero.
    pub(super) offset: Option<String>,
}

/// 1, 2 or 5 times a power of ten, the next at or above `least`.
fn nice(least: f64) -> f64 {
    let power = 10.0_f64.powf(least.log10().floor());
    // Rounding must not skip a step.
    let steps = [1.0, 2.0, 5.0, 10.0].map(|factor| factor * power);
    steps.into_iter().find(|step| *step >= (1.0 - 1e-9) * least).unwrap_or(10.0 * power)
}

/// Multiples of a nice step in a range, about `count` or fewer.
fn multiples(range: &Range<f64>, count: usize) -> (f64, Vec<f64>) {
    let step = nice((range.end - range.start) / count.max(1) as f64);
    let (first, last) = ((range.start / step - 1e-6).ceil(), (range.end / step + 1e-6).floor());
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "count and less")]
    let number = (last - first).clamp(0.0, 2.0 * count as f64) as usize;
    // Zero without its sign.
    (step, (0..=number).map(|k| (first + k as f64) * step + 0.0).collect())
}

/// Marks at multiples of 1, 2 or 5 times a power of ten, at most about `count`.
pub(super) fn linear(range: &Range<f64>, count: usize) -> Ticks {
    let (step, places) = multiples(range, count);
    let write = |values: &[f64]| values.iter().map(|v| number(*v, step)).collect::<Vec<_>>();
    let (mut names, mut offset) = (write(&places), None);
    if names.iter().any(|name| name.chars().count() > LETTERS) {
        offset = Some(names[0].clone());
        names = write(&places.iter().map(|value| value - places[0]).collect::<Vec<_>>());
    }
    Ticks { marks: places.into_iter().zip(names).collect(), offset }
}

/// Power of ten of a number.
fn exponent(value: f64) -> i32 {
    #[allow(clippy::cast_possible_truncation, reason = "-324 to 308")]
    let exponent = (value.abs().log10() + 1e-9).floor() as i32;
    exponent
}

/// A multiple of `step`, with the digits that tell it from its neighbours.
fn number(value: f64, step: f64) -> String {
    // Multiples that miss zero by rounding.
    if value.abs() < 1e-3 * step {
        return "0".to_owned();
    }
    let digits = |number: i32| usize::try_from(number).unwrap_or(0);
    let plain = format!("{value:.*}", digits(-exponent(step)));
    // As powers of ten what is far from one.
    if value.abs() < 1e6 && (step >= 1e-4 || value.abs() >= 1.0) {
        return plain;
    }
    let short = format!("{value:.*e}", digits(exponent(value) - exponent(step)));
    if plain.len() <= short.len().max(6) { plain } else { short }
}

/// Marks at 1, 2, 5, 10, … of a logarithmic axis; places are powers of ten.
pub(super) fn logarithmic(range: &Range<f64>, count: usize) -> Ticks {
    let (low, high) = (range.start * (1.0 - 1e-9), range.end * (1.0 + 1e-9));
    let within = |factors: &[f64]| -> Vec<f64> {
        let powers = exponent(low)..=exponent(high);
        powers
            .flat_map(|power| factors.iter().map(move |factor| factor * 10.0_f64.powi(power)))
            .filter(|value| (low..=high).contains(value))
            .collect()
    };
    let mut values = within(&[1.0, 2.0, 5.0]);
    if values.len() > count {
        values = within(&[1.0]);
    }
    if values.len() < 3 {
        let marks = linear(range, count.min(5));
        let place = |(value, name): (f64, String)| (value.log10(), name);
        let above = marks.marks.into_iter().filter(|mark| mark.0 > 0.0);
        return Ticks { marks: above.map(place).collect(), ..marks };
    }
    let name = |value: f64| (value.log10(), number(value, 10.0_f64.powi(exponent(value))));
    Ticks { marks: values.into_iter().map(name).collect(), offset: None }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn names(range: Range<f64>) -> (Vec<String>, Option<String>) {
        let ticks = linear(&range, 5);
        for mark in &ticks.marks {
            assert!(range.start - 1e-3 <= mark.0 && mark.0 <= range.end + 1e-3);
            assert!(mark.1.chars().count() <= LETTERS, "{mark:?}");
        }
        (ticks.marks.into_iter().map(|mark| mark.1).collect(), ticks.offset)
    }

    #[test]
    fn no_two_marks_read_the_same() {
        let expected = |range, list: &[&str], offset: Option<&str>| {
            assert_eq!(
                names(range),
                (list.iter().map(|&s| s.to_owned()).collect(), offset.map(Into::into))
            );
        };
        expected(0.0..10.0, &["0", "2", "4", "6", "8", "10"], None);
        expected(-0.1..0.11, &["-0.10", "-0.05", "0", "0.05", "0.10"], None);
        expected(1.0..1.004, &["1.000", "1.001", "1.002", "1.003", "1.004"], None);
        let tiny = ["0", "2e-6", "4e-6", "6e-6", "8e-6", "1.0e-5"];
        expected(
            1.000_01..1.000_02,
            &["1.000010", "1.000012", "1.000014", "1.000016", "1.000018", "1.000020"],
            None,
        );
        expected(100.000_01..100.000_02, &tiny, Some("100.000010"));
        expected(1e6..1e6 + 4.0, &["1000000", "1000001", "1000002", "1000003", "1000004"], None);
        expected(0.0..3e6, &["0", "1e6", "2e6", "3e6"], None);
        expected(-2e-9..2e-9, &["-2e-9", "-1e-9", "0", "1e-9", "2e-9"], None);
        for range in [-1e60..1e60, 1e-60..3e-60, 1e12..1e12 + 2000.0, -1e-300..2e59] {
            let (mut list, _) = names(range.clone());
            let count = list.len();
            assert!((2..=11).contains(&count), "{range:?} {list:?}");
            list.dedup();
            assert_eq!(list.len(), count, "{range:?} {list:?}");
        }
    }

    #[test]
    fn logarithmic_marks() {
        let names = |range| {
            logarithmic(&range, 14).marks.into_iter().map(|mark| mark.1).collect::<Vec<_>>()
        };
        assert_eq!(names(0.05..2.0), ["0.05", "0.1", "0.2", "0.5", "1", "2"]);
        assert_eq!(names(1.1..1.35), ["1.10", "1.15", "1.20", "1.25", "1.30", "1.35"]);
        assert_eq!(names(1e-6..1e6).len(), 13);
    }
}
