//! A motion that went through a site.

use std::fmt;

/// A motion that went through a site, at the times of the one that was given, and the sizes of what
/// its samples do not hold.
///
/// Motions are taken to be zero outside their samples, so what is cut off here is missing on the way
/// back: [`Record::padded`](crate::motion::Record::padded) makes room for it. A record with quiet
/// time around it goes through a site and returns to 1e-9 of its peak, whatever its frequencies, if
/// [`SiteMotion::is_whole`] on both ways.
#[derive(Debug, Clone, PartialEq, Default)]
#[non_exhaustive]
pub struct SiteMotion {
    /// The motion.
    pub samples: Vec<f64>,
    /// Largest sample before the first one, cut off: on the way down motion comes earlier.
    pub before: f64,
    /// Largest sample after the last one, cut off: what is still on its way.
    pub after: f64,
    /// Largest sample of the part with the highest frequencies, the last 2 % below 1/2Δt, where layers
    /// delay by whole time steps: the error of that, which is at most half a step from the surface to
    /// any depth, to a factor of four.
    pub near_nyquist: f64,
    /// Rounding, estimated: large if damped layers amplify high frequencies on the way down.
    pub rounding: f64,
}

impl SiteMotion {
    /// Share of the peak that passes for nothing.
    pub const LIMIT: f64 = 1e-9;

    /// Largest sample.
    pub fn peak(&self) -> f64 {
        largest(&self.samples)
    }

    /// Whether nothing above [`SiteMotion::LIMIT`] of the peak is cut off or rounded away.
    pub fn is_whole(&self) -> bool {
        self.before.max(self.after).max(self.rounding) <= Self::LIMIT * self.peak()
    }

    /// Number of samples up to the last one that is something.
    pub(super) fn duration(&self) -> usize {
        let least = Self::LIMIT * self.peak();
        self.samples.iter().rposition(|x| x.abs() > least).map_or(0, |last| last + 1)
    }

    /// Leaves `count` samples.
    pub(super) fn cut(&mut self, count: usize) {
        let count = count.min(self.samples.len());
        self.after = largest(&self.samples[count..]);
        self.samples.truncate(count);
    }
}

fn largest(samples: &[f64]) -> f64 {
    samples.iter().fold(0.0, |most, x| most.max(x.abs()))
}

/// Sizes relative to the peak.
impl fmt::Display for SiteMotion {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let peak = self.peak();
        write!(
            f,
            "peak {peak:.3e}; of that cut off before {:.1e}, after {:.1e}, near the highest frequency \
             {:.1e}, rounding {:.1e}",
            self.before / peak,
            self.after / peak,
            self.near_nyquist / peak,
            self.rounding / peak
        )
    }
}
