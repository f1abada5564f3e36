//! Uplift of a base in a run: how often and how long it left the ground.

use crate::interface::Mode;

/// Uplift of a run.
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
    current: f64,
}

impl Uplift {
    /// Records a step of this duration; `fraction`: uplifted part of the area.
    pub(crate) fn update(&mut self, fraction: f64, modes: &[Mode], step: f64) {
        self.advance(fraction, step, modes.iter().any(|mode| mode.is_closed()));
    }

    /// Records a step of duration `step`, and whether any element is closed at its end.
    fn advance(&mut self, fraction: f64, step: f64, closed: bool) {
        if fraction <= 0.0 {
            self.current = 0.0;
            return;
        }
        if self.current == 0.0 {
            self.count += 1;
        }
        self.duration += step;
        self.current += step;
        self.longest = self.longest.max(self.current);
        if !closed {
            self.flight += step;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn by_hand() {
        let mut uplift = Uplift::default();
        for fraction in [0.0, 0.2, 0.5, 0.0, 1.0, 1.0, 0.3, 0.0] {
            uplift.advance(fraction, 0.1, fraction < 1.0);
        }
        assert_eq!(uplift.count, 2);
        for (computed, by_hand) in
            [(uplift.duration, 0.5), (uplift.flight, 0.2), (uplift.longest, 0.3)]
        {
            assert!((computed - by_hand).abs() < 1e-15);
        }
    }
}
