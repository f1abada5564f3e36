//! Uplift of a base in a run: number and durations of its periods of uplift.

use crate::interface::Mode;

/// Number and durations of the periods of uplift in a run.
///
/// A period of uplift begins with the first step that ends with an open element, and ends with the first step that
/// ends without one.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(deny_unknown_fields))]
#[non_exhaustive]
pub struct Uplift {
    /// Time with any part uplifted, s.
    pub duration: f64,
    /// Time without any contact at all, s.
    pub flight: f64,
    /// Number of periods of uplift.
    pub count: usize,
    /// Longest period of uplift, s.
    pub longest: f64,
    /// Duration of the present period so far, s.
    current: f64,
}

impl Uplift {
    /// Records a step of `step_duration` (s), which ends with this fraction of the area open.
    pub(crate) fn update(&mut self, open_fraction: f64, modes: &[Mode], step_duration: f64) {
        self.advance(open_fraction, step_duration, modes.iter().any(|mode| mode.is_closed()));
    }

    /// Records a step, and whether any element is closed at its end.
    fn advance(&mut self, open_fraction: f64, step_duration: f64, is_any_closed: bool) {
        if open_fraction <= 0.0 {
            self.current = 0.0;
            return;
        }
        if self.current == 0.0 {
            self.count += 1;
        }
        self.duration += step_duration;
        self.current += step_duration;
        self.longest = self.longest.max(self.current);
        if !is_any_closed {
            self.flight += step_duration;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn periods_of_uplift_by_hand() {
        let mut uplift = Uplift::default();
        for fraction in [0.0, 0.2, 0.5, 0.0, 1.0, 1.0, 0.3, 0.0] {
            uplift.advance(fraction, 0.1, fraction < 1.0);
        }
        assert_eq!(uplift.count, 2);
        for (computed, expected) in
            [(uplift.duration, 0.5), (uplift.flight, 0.2), (uplift.longest, 0.3)]
        {
            assert!((computed - expected).abs() < 1e-15);
        }
    }
}
