//! Progress of one part of a call, for its observer.

use crate::error::{Result, Watch};

/// One of the equal parts of a call through a site, for its observer.
pub(super) struct PartProgress<'p, 'w> {
    watch: &'p mut Watch<'w>,
    begin: usize,
}

impl<'p, 'w> PartProgress<'p, 'w> {
    /// Number of steps that the observer counts in each part.
    pub(super) const STEPS_PER_PART: usize = 1000;

    /// A call of one part.
    pub(super) fn whole(watch: &'p mut Watch<'w>) -> Self {
        Self::part(watch, 0)
    }

    /// The part with this number, from 0.
    pub(super) fn part(watch: &'p mut Watch<'w>, number: usize) -> Self {
        Self { watch, begin: number.saturating_mul(Self::STEPS_PER_PART) }
    }

    /// Reports the fraction of the part that is done.
    pub(super) fn reach(&mut self, fraction: f64) -> Result<()> {
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "0 to 1000")]
        let done = (Self::STEPS_PER_PART as f64 * fraction.clamp(0.0, 1.0)) as usize;
        self.watch.reach(self.begin.saturating_add(done))
    }
}
