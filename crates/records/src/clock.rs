//! Columns of times: seconds or times of day, and their common time step.

use super::fault::unequal_time_step;
use crate::error::FileFault;
use crate::text::bounded_line::LineResult;
use crate::text::decimal::finite;

/// Number that the seconds of a time of day do not reach.
///
/// A leap second has the number 60.
const SECONDS_LIMIT: f64 = 61.0;
/// Minutes in a day.
const MINUTES_PER_DAY: i64 = 1440;
/// Smallest number of decimals of a second whose last digit binary rounding hides.
const UNRESOLVED_TIME_DECIMALS: i32 = 12;

/// Reads a column of times: seconds as printed, or times of day.
///
/// Times of day become seconds since the start of the first time's minute.
#[derive(Default)]
pub(super) struct Clock {
    /// Minute of the day of the first time.
    first_minute: Option<i64>,
    /// Minute of the day of the previous time.
    previous_minute: i64,
    /// Minutes of all days that have ended since the first time.
    past_day_minutes: i64,
    /// Largest number of decimals of a second so far.
    max_decimals: usize,
    /// Whether a time had an exponent, so that its decimals do not show its last digit.
    has_exponent: bool,
}

impl Clock {
    /// The time (s) in a field: `12.5`, `12:00:15.01`, or a date and a time of day.
    pub(super) fn read(&mut self, field: &str) -> Option<f64> {
        let time = finite(field).or_else(|| self.time_of_day(field))?;
        self.has_exponent |= field.contains(['e', 'E', 'd', 'D']);
        let decimals = field.rsplit_once('.').map_or(0, |(_, decimals)| decimals.len());
        self.max_decimals = self.max_decimals.max(decimals);
        Some(time)
    }

    /// Seconds from the start of the first time's minute to a time of day.
    fn time_of_day(&mut self, field: &str) -> Option<f64> {
        // Minutes are counted as whole numbers, so that the seconds keep their digits.
        let time_text = field.rsplit([' ', 'T']).next()?;
        let (hour_and_minute, second_text) = time_text.rsplit_once(':')?;
        let (hour_text, minute_text) = hour_and_minute.split_once(':')?;
        let second = finite(second_text).filter(|second| (0.0..SECONDS_LIMIT).contains(second))?;
        let minute = 60 * two_digits(hour_text)? + two_digits(minute_text)?;
        let first_minute = *self.first_minute.get_or_insert(minute);
        let has_passed_midnight = minute + MINUTES_PER_DAY / 2 < self.previous_minute;
        if has_passed_midnight {
            self.past_day_minutes += MINUTES_PER_DAY;
        }
        self.previous_minute = minute;
        Some((minute + self.past_day_minutes - first_minute) as f64 * 60.0 + second)
    }

    /// Unit of the last digit of the times, s.
    pub(super) fn resolution(&self) -> Option<f64> {
        let decimals = i32::try_from(self.max_decimals)
            .ok()
            .filter(|&decimals| decimals < UNRESOLVED_TIME_DECIMALS)?;
        (!self.has_exponent).then(|| 10.0_f64.powi(-decimals))
    }
}

/// A whole number of one or two digits.
fn two_digits(text: &str) -> Option<i64> {
    let is_number = matches!(text.len(), 1 | 2) && text.bytes().all(|byte| byte.is_ascii_digit());
    if is_number { text.parse().ok() } else { None }
}

/// Largest difference of a time from equal steps, relative to the step.
///
/// Wide enough for times printed with three digits of the step.
const TIME_STEP_TOLERANCE: f64 = 0.01;
/// Smallest step, in units of the times' last digit, whose inequality rounding explains.
const MIN_STEP_IN_LAST_DIGITS: f64 = 3.0;
/// Relative tolerance of a comparison with the unit of the last digit.
const DIGIT_COMPARISON_TOLERANCE: f64 = 1e-6;

/// Times of the lines of a file.
#[derive(Default)]
pub(super) struct TimeColumn {
    /// Times, s.
    times: Vec<f64>,
    /// Reads the times.
    pub(super) clock: Clock,
}

impl TimeColumn {
    pub(super) fn push(&mut self, time: f64) {
        self.times.push(time);
    }

    /// The common time step (s), or an error at the line that differs.
    ///
    /// `line_numbers`: for each time, the number of its line in the file.
    pub(super) fn equal_step(&self, line_numbers: &[usize]) -> LineResult<f64> {
        let times = &self.times;
        let first_step = times[1] - times[0];
        let last_index = times.len() - 1;
        let mean_step = (times[last_index] - times[0]) / last_index as f64;
        for k in 1..=last_index {
            let step = times[k] - times[k - 1];
            // The difference of huge times may be infinite.
            if !(step > 0.0 && step < f64::INFINITY) {
                let fault = wrong_step(step, "above zero".into());
                let is_repeated = step == 0.0;
                return Err(if is_repeated {
                    (line_numbers[k], self.unequal_steps(mean_step, fault))
                } else {
                    (line_numbers[k], fault)
                });
            }
            if (step - first_step).abs() > TIME_STEP_TOLERANCE * first_step {
                let needed = format!("{} s, as before", rounded_decimal(first_step));
                return Err((
                    line_numbers[k],
                    self.unequal_steps(mean_step, wrong_step(step, needed)),
                ));
            }
        }
        if times.iter().enumerate().all(|(k, &time)| time == k as f64 * first_step) {
            return Ok(first_step);
        }
        // Steps that drift slowly pass the test above.
        for (k, &time) in times.iter().enumerate() {
            let expected = times[0] + k as f64 * mean_step;
            if (time - expected).abs() > TIME_STEP_TOLERANCE * mean_step {
                let fault = unequal_time_step(rounded_decimal(time), rounded_decimal(expected));
                return Err((line_numbers[k], self.unequal_steps(mean_step, fault)));
            }
        }
        Ok(rounded_decimal(mean_step))
    }

    /// The error for a step that differs from the others.
    ///
    /// `fault`: the error unless rounding of the times explains the difference.
    fn unequal_steps(&self, mean_step: f64, fault: FileFault) -> FileFault {
        self.rounding_fault(mean_step).unwrap_or(fault)
    }

    /// The error for times with equal steps up to rounding; `None` for other times.
    fn rounding_fault(&self, mean_step: f64) -> Option<FileFault> {
        let resolution = self.clock.resolution()?;
        let tolerance = (1.0 + DIGIT_COMPARISON_TOLERANCE) * resolution;
        let mut min_step = f64::MAX;
        let mut max_step = 0.0_f64;
        for pair in self.times.windows(2) {
            min_step = min_step.min(pair[1] - pair[0]);
            max_step = max_step.max(pair[1] - pair[0]);
        }
        // Either two successive times are equal, or each step has several units of the last digit.
        let has_equal_times = mean_step > 0.0 && min_step == 0.0 && resolution < 1.0;
        let has_coarse_steps = mean_step > MIN_STEP_IN_LAST_DIGITS * resolution;
        if !(has_equal_times || has_coarse_steps) || max_step - min_step > tolerance {
            return None;
        }
        for (k, time) in self.times.iter().enumerate() {
            if (time - self.times[0] - k as f64 * mean_step).abs() > tolerance {
                return None;
            }
        }
        let needed =
            format!("stated (`time_step`): times rounded to {resolution} s do not show it");
        let mean_step_text = format!("near {} s", rounded_decimal(mean_step));
        Some(FileFault::value("time step", mean_step_text, needed))
    }
}

/// Fault of a time step (s) that violates the requirement `needed`.
fn wrong_step(time_step: f64, needed: String) -> FileFault {
    FileFault::value("time step", format!("{} s", rounded_decimal(time_step)), needed)
}

/// Rounds to twelve digits, which removes the binary rounding of differences between printed numbers.
fn rounded_decimal(value: f64) -> f64 {
    format!("{value:.11e}").parse().unwrap_or(value)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn times_of_day_become_seconds() {
        let mut clock = Clock::default();
        let times = ["23:59:59.99", "00:00:00.00", "0:00:00.01", "2024/01/01 00:00:00.02"];
        let seconds: Vec<f64> = times.iter().map(|time| clock.read(time).unwrap()).collect();
        for (time, expected) in seconds.iter().zip([59.99, 60.0, 60.01, 60.02]) {
            assert!((time - expected).abs() < 1e-12, "{time} {expected}");
        }
        assert_eq!(clock.resolution(), Some(0.01));
        for invalid_field in
            ["12:00", "1:2:3:4", "12:00:x", "12:00:-1", "12:+1:10", "12:00:99", ":", "a:b:c"]
        {
            assert_eq!(Clock::default().read(invalid_field), None, "{invalid_field}");
        }
    }
}
