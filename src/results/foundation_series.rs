//! Time series of each foundation.

use super::Quantity;
use super::item_lists::ItemLists;
use crate::coupled::State;
use crate::error::{Result, in_bounds, require_part};

/// Distance that counts as rounding, over the width of a foundation.
///
/// It is the distance from the point of the base moment to the middle of the foundation.
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
    /// Lists of each foundation; empty unless kept.
    pub(super) lists: ItemLists,
}

impl FoundationSeries {
    /// Makes empty lists of `quantity_count` quantities, if these are kept.
    pub(super) fn new(state: &State, quantity_count: usize, is_kept: bool) -> Self {
        let footings = &state.context.footings;
        let count = footings.len();
        let is_whole_base = count == 1
            && [0, 1].into_iter().all(|axis| {
                let [min_end, max_end] = footings[0].ends[axis];
                footings[0].center[axis].abs() <= SAME_POINT_TOLERANCE * (max_end - min_end)
            });
        let lists = ItemLists::new(if is_kept { count } else { 0 }, quantity_count);
        Self { count, is_whole_base, lists }
    }

    /// Number of foundations whose scalars are kept.
    pub(super) fn kept_count(&self) -> usize {
        if self.lists.all_lists().is_empty() { 0 } else { self.count }
    }

    /// Appends the values of a kept step.
    pub(super) fn store(&mut self, state: &State) {
        for (foundation, lists) in self.lists.items_mut(self.count).enumerate() {
            state.append_values(Some(foundation), lists);
        }
    }

    /// Series of a quantity of a foundation; `None` if the whole base has the same series.
    ///
    /// The series is empty in the plane for quantities that exist only in plan.
    pub(super) fn find(&self, foundation: usize, quantity: Quantity) -> Result<Option<&[f64]>> {
        in_bounds("foundation", foundation, self.count)?;
        let lists = self.lists.of_item(foundation, self.count);
        if lists.is_empty() {
            let needed = "kept: set `foundations` of the recorder, since there are several foundations or a \
                          moment center is set";
            require_part("time series of a foundation", self.is_whole_base, needed)?;
            return Ok(None);
        }
        Ok(Some(lists.get(quantity as usize).map_or(&[], Vec::as_slice)))
    }

    /// Returns an error unless there are no lists, or `quantity_count` lists of each foundation.
    #[cfg(feature = "serde")]
    pub(super) fn check(&self, quantity_count: usize) -> Result<()> {
        let needed_lists = self.kept_count().saturating_mul(quantity_count);
        crate::error::same_length(
            "list of scalars of the foundations",
            self.lists.all_lists().len(),
            needed_lists,
        )?;
        Ok(())
    }
}
