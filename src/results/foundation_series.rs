//! Time series of each foundation.

use super::Quantity;
use crate::coupled::State;
use crate::error::{Result, in_bounds, require_part};

/// Distance from the point of the base moment to the middle of a foundation that counts as rounding, over its width.
const SAME_POINT_TOLERANCE: f64 = 1e-12;

/// Scalars of each foundation at the kept steps, if the recorder keeps them.
#[derive(Debug, Clone, Default)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(deny_unknown_fields))]
pub(super) struct FoundationSeries {
    /// Number of foundations.
    count: usize,
    /// Whether the only foundation has the moments of the whole base.
    is_whole_base: bool,
    /// Lists of all quantities of the first foundation, then of the next one; empty unless kept.
    #[cfg_attr(feature = "serde", serde(with = "crate::text::forms::lists"))]
    lists: Vec<Vec<f64>>,
}

impl FoundationSeries {
    /// Empty lists of this number of `quantities`, if these are kept.
    pub(super) fn new(state: &State, quantities: usize, is_kept: bool) -> Self {
        let footings = &state.context.footings;
        let count = footings.len();
        let is_whole_base = count == 1
            && [0, 1].into_iter().all(|axis| {
                let [low, high] = footings[0].ends[axis];
                footings[0].center[axis].abs() <= SAME_POINT_TOLERANCE * (high - low)
            });
        let list_count = if is_kept { count * quantities } else { 0 };
        Self { count, is_whole_base, lists: vec![Vec::new(); list_count] }
    }

    /// Number of foundations whose scalars are kept.
    pub(super) fn kept(&self) -> usize {
        if self.lists.is_empty() { 0 } else { self.count }
    }

    /// Lists of all quantities of the first foundation, then of the next one.
    pub(super) fn lists(&self) -> &[Vec<f64>] {
        &self.lists
    }

    /// Mutable access to the lists.
    pub(super) fn lists_mut(&mut self) -> &mut [Vec<f64>] {
        &mut self.lists
    }

    /// Appends the values of a kept step.
    pub(super) fn store(&mut self, state: &State) {
        let quantities = self.lists.len() / self.count.max(1);
        for (foundation, lists) in self.lists.chunks_mut(quantities.max(1)).enumerate() {
            state.append_values(Some(foundation), lists);
        }
    }

    /// Series of a quantity of a foundation; `None` if the whole base has the same.
    ///
    /// Empty in the plane for quantities of three directions.
    pub(super) fn find(&self, foundation: usize, quantity: Quantity) -> Result<Option<&[f64]>> {
        in_bounds("foundation", foundation, self.count)?;
        let quantities = self.lists.len() / self.count;
        if quantities == 0 {
            let needed = "kept: tell the recorder to keep `foundations`, for there are several or a \
                          moment center is set";
            require_part("time series of a foundation", self.is_whole_base, needed)?;
            return Ok(None);
        }
        let lists = &self.lists[foundation * quantities..(foundation + 1) * quantities];
        Ok(Some(lists.get(quantity as usize).map_or(&[], Vec::as_slice)))
    }

    /// Error unless there are no lists or this number of `quantities` of each foundation.
    #[cfg(feature = "serde")]
    pub(super) fn check(&self, quantities: usize) -> Result<()> {
        let needed = self.kept().saturating_mul(quantities);
        crate::error::same_length("list of scalars of the foundations", self.lists.len(), needed)?;
        Ok(())
    }
}
