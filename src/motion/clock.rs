//! Times of day in a column of times.

use crate::text::decimal::finite;

/// Minutes in a day.
const MINUTES_PER_DAY: i64 = 1440;

/// Seconds since the first time of a column of seconds or times of day.
#[derive(Default)]
pub(super) struct Clock {
    /// Minute of the day of the first time.
    first_minute: Option<i64>,
    /// Minute of the day of the previous time.
    previous_minute: i64,
    /// Minutes of the days that have ended since the first time.
    minutes_of_past_days: i64,
    /// Largest number of decimals of a second so far.
    decimals: usize,
    /// Whether a time had an exponent, so that its decimals do not show its last digit.
    has_exponent: bool,
}

impl Clock {
    /// The time (s) in a field: `12.5`, `12:00:15.01`, or a date and a time of day.
    pub(super) fn read(&mut self, field: &str) -> Option<f64> {
        let time = finite(field).or_else(|| self.time_of_day(field))?;
        self.has_exponent |= field.contains(['e', 'E', 'd', 'D']);
        let decimals = field.rsplit_once('.').map_or(0, |(_, decimals)| decimals.len());
        self.decimals = self.decimals.max(decimals);
        Some(time)
    }

    /// Seconds since the first time, for a time of day.
    fn time_of_day(&mut self, field: &str) -> Option<f64> {
        // The minutes are whole numbers, so that the seconds keep their digits.
        let time = field.rsplit([' ', 'T']).next()?;
        let (hour_and_minute, second) = time.rsplit_once(':')?;
        let (hour, minute) = hour_and_minute.split_once(':')?;
        let second = finite(second).filter(|second| (0.0..61.0).contains(second))?;
        let minute = 60 * two_digits(hour)? + two_digits(minute)?;
        let first_minute = *self.first_minute.get_or_insert(minute);
        let passed_midnight = minute + MINUTES_PER_DAY / 2 < self.previous_minute;
        if passed_midnight {
            self.minutes_of_past_days += MINUTES_PER_DAY;
        }
        self.previous_minute = minute;
        Some((minute + self.minutes_of_past_days - first_minute) as f64 * 60.0 + second)
    }

    /// Unit of the last digit of the times, s.
    pub(super) fn resolution(&self) -> Option<f64> {
        let decimals = i32::try_from(self.decimals).ok().filter(|&decimals| decimals < 12)?;
        (!self.has_exponent).then(|| 10.0_f64.powi(-decimals))
    }
}

/// A whole number of one or two digits.
fn two_digits(text: &str) -> Option<i64> {
    let is_number = matches!(text.len(), 1 | 2) && text.bytes().all(|byte| byte.is_ascii_digit());
    if is_number { text.parse().ok() } else { None }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn times_of_day_become_seconds() {
        let mut clock = Clock::default();
        let times = ["23:59:59.99", "00:00:00.00", "0:00:00.01", "2024/01/01 00:00:00.02"];
        let read: Vec<f64> = times.iter().map(|time| clock.read(time).unwrap()).collect();
        for (found, wanted) in read.iter().zip([59.99, 60.0, 60.01, 60.02]) {
            assert!((found - wanted).abs() < 1e-12, "{found} {wanted}");
        }
        assert_eq!(clock.resolution(), Some(0.01));
        for bad in ["12:00", "1:2:3:4", "12:00:x", "12:00:-1", "12:+1:10", "12:00:99", ":", "a:b:c"]
        {
            assert_eq!(Clock::default().read(bad), None, "{bad}");
        }
    }
}
