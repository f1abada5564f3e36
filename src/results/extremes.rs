//! Smallest and largest value of a history.

use crate::coupled::Peak;

/// Smallest and largest value, and when they occurred; of equal ones the first. NaN does not count
/// unless there is nothing else.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Extremes {
    /// The smallest value.
    pub lowest: Peak,
    /// The largest value.
    pub highest: Peak,
}

impl Extremes {
    /// Of one value.
    pub(super) fn of(value: f64, time: f64) -> Self {
        let peak = Peak { value, time };
        Self { lowest: peak, highest: peak }
    }

    pub(super) fn see(&mut self, value: f64, time: f64) {
        if value < self.lowest.value || self.lowest.value.is_nan() {
            self.lowest = Peak { value, time };
        }
        if value > self.highest.value || self.highest.value.is_nan() {
            self.highest = Peak { value, time };
        }
    }

    /// The one of larger magnitude, with its sign.
    pub fn largest(&self) -> Peak {
        if self.lowest.value.abs() > self.highest.value.abs() { self.lowest } else { self.highest }
    }
}
