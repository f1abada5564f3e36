//! Extremes of a run, with their times.

/// A value of largest magnitude, with its sign and time.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(deny_unknown_fields))]
pub struct Peak {
    /// The value, with its sign.
    #[cfg_attr(feature = "serde", serde(with = "crate::text::forms::number"))]
    pub value: f64,
    /// Time at which it occurs, s.
    #[cfg_attr(feature = "serde", serde(with = "crate::text::forms::number"))]
    pub time: f64,
}

impl Peak {
    /// The value without its sign.
    pub(crate) fn magnitude(&self) -> f64 {
        self.value.abs()
    }

    /// Replaces the peak by a value of larger magnitude, with its time.
    pub(crate) fn update(&mut self, value: f64, time: f64) {
        if value.abs() > self.value.abs() {
            *self = Self { value, time };
        }
    }
}

/// Smallest and largest value, with their times; of equal values, the first.
///
/// NaN is ignored unless there are no other values.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(deny_unknown_fields))]
pub struct Extremes {
    /// The smallest value.
    pub lowest: Peak,
    /// The largest value.
    pub highest: Peak,
}

impl Extremes {
    /// Extremes of a single value.
    pub(crate) fn single(value: f64, time: f64) -> Self {
        let peak = Peak { value, time };
        Self { lowest: peak, highest: peak }
    }

    /// Extends the extremes by a value, with its time.
    pub(crate) fn update(&mut self, value: f64, time: f64) {
        if value < self.lowest.value || self.lowest.value.is_nan() {
            self.lowest = Peak { value, time };
        }
        if value > self.highest.value || self.highest.value.is_nan() {
            self.highest = Peak { value, time };
        }
    }

    /// The peak of larger magnitude, with its sign.
    pub fn largest(&self) -> Peak {
        if self.lowest.value.abs() > self.highest.value.abs() {
            self.lowest
        } else {
            self.highest
        }
    }

    /// Largest magnitude, without its sign.
    pub fn magnitude(&self) -> f64 {
        self.largest().magnitude()
    }
}

/// Smallest and largest value of a probe.
#[derive(Debug, Clone, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(deny_unknown_fields))]
#[non_exhaustive]
pub struct ProbeExtremes {
    /// Name of the probe.
    pub name: String,
    /// Unit of the values.
    pub unit: String,
    /// Extremes of the values.
    pub extremes: Extremes,
}
