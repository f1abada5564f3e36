//! State of a history by transforms in a checkpoint.

use crate::error::{CheckpointError, Result};

/// State of a history by transforms, as its `save` returned it.
pub(super) struct SavedState<'a> {
    /// All inputs that blocks need, step by step.
    pub(super) inputs: &'a [f64],
    /// Largest traction so far, Pa; zero if no lags are neglected.
    pub(super) max_traction: f64,
    /// Last lag that is not neglected; `None` if it was not yet determined.
    pub(super) last_lag: Option<usize>,
}

impl<'a> SavedState<'a> {
    /// Error for values that no history of this kind has saved.
    pub(super) const CORRUPT_STATE: CheckpointError =
        CheckpointError::Corrupt { quantity: "memory of the history" };

    /// Reads saved `values`; a history that `neglects_lags` has two numbers after the inputs.
    pub(super) fn new(values: &'a [f64], neglects_lags: bool) -> Result<Self> {
        if !neglects_lags {
            return Ok(Self { inputs: values, max_traction: 0.0, last_lag: None });
        }
        let [inputs @ .., max_traction, saved_lag] = values else {
            return Err(Self::CORRUPT_STATE.into());
        };
        let mut powers_of_two = (0..usize::BITS - 1).map(|power| 1_usize << power);
        let last_lag = powers_of_two.find(|lag| *lag as f64 == *saved_lag);
        Ok(Self { inputs, max_traction: *max_traction, last_lag })
    }
}
