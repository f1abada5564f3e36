//! How much of the base left the ground, and for how long.

use crate::coupled::Peak;

/// Uplift of a run. A stretch begins with the first step that ends with an open element, and ends
/// with the first one that ends without.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
#[non_exhaustive]
pub struct Uplift {
    /// Largest uplifted fraction of the base.
    pub peak: Peak,
    /// Time with any part uplifted, s.
    pub duration: f64,
    /// Time without any contact at all, s.
    pub flight: f64,
    /// Number of stretches.
    pub count: usize,
    /// Longest stretch, s.
    pub longest: f64,
    current: f64,
}

impl Uplift {
    /// Before the first step.
    pub(super) fn start(fraction: f64, time: f64) -> Self {
        Self { peak: Peak { value: fraction, time }, ..Self::default() }
    }

    /// A step of length `step` that ended at `time`; `open` of `count` elements are open.
    pub(super) fn see(&mut self, fraction: f64, time: f64, step: f64, closed: bool) {
        self.peak.see(fraction, time);
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
        let mut uplift = Uplift::start(0.0, 0.0);
        for (k, fraction) in [0.0, 0.2, 0.5, 0.0, 1.0, 1.0, 0.3, 0.0].into_iter().enumerate() {
            uplift.see(fraction, 0.1 * (k + 1) as f64, 0.1, fraction < 1.0);
        }
        assert_eq!((uplift.count, uplift.peak.value, uplift.peak.time), (2, 1.0, 0.5));
        for (found, known) in [(uplift.duration, 0.5), (uplift.flight, 0.2), (uplift.longest, 0.3)]
        {
            assert!((found - known).abs() < 1e-15);
        }
    }
}
