//! Progress reports of a site computation that consists of equal parts.

use crate::error::{ProgressReporter, Result};

/// Progress of a part after its spectra are filtered; the inverse transforms take as long.
pub(super) const FILTER_PROGRESS_FRACTION: f64 = 0.5;

/// Progress of a part during its inverse transforms, of which a `fraction` is finished.
pub(super) fn after_filter(fraction: f64) -> f64 {
    FILTER_PROGRESS_FRACTION + (1.0 - FILTER_PROGRESS_FRACTION) * fraction
}

/// Reports the progress of one of the equal parts of a call.
pub(super) struct PartProgress<'p, 'w> {
    reporter: &'p mut ProgressReporter<'w>,
    /// Number of steps of the call before this part.
    first_step: usize,
}

impl<'p, 'w> PartProgress<'p, 'w> {
    /// Number of steps into which each part is divided for the observer.
    pub(super) const STEPS_PER_PART: usize = 1000;

    /// Progress of a call of one part.
    pub(super) fn of_whole_call(reporter: &'p mut ProgressReporter<'w>) -> Self {
        Self::of_part(reporter, 0)
    }

    /// Progress of the part with this index, from 0.
    pub(super) fn of_part(reporter: &'p mut ProgressReporter<'w>, part_index: usize) -> Self {
        Self { reporter, first_step: part_index.saturating_mul(Self::STEPS_PER_PART) }
    }

    /// Reports the finished fraction of the part.
    pub(super) fn report(&mut self, fraction: f64) -> Result<()> {
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "0 to 1000")]
        let finished_steps = (Self::STEPS_PER_PART as f64 * fraction.clamp(0.0, 1.0)) as usize;
        self.reporter.reach(self.first_step.saturating_add(finished_steps))
    }
}
