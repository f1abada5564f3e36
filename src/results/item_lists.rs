//! Time series of each foundation or joint, in one list of lists.

/// Time series of several quantities of each of several items, such as foundations or joints.
#[derive(Debug, Clone, Default)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(transparent))]
pub(super) struct ItemLists {
    /// Lists of all quantities of the first item, then of the next one.
    #[cfg_attr(feature = "serde", serde(with = "crate::text::forms::lists"))]
    lists: Vec<Vec<f64>>,
}

impl ItemLists {
    /// Empty lists of so many quantities of each item.
    pub(super) fn new(item_count: usize, quantity_count: usize) -> Self {
        Self { lists: vec![Vec::new(); item_count * quantity_count] }
    }

    /// Lists of all quantities of the first item, then of the next one.
    pub(super) fn all_lists(&self) -> &[Vec<f64>] {
        &self.lists
    }

    /// Mutable access to the lists.
    pub(super) fn all_lists_mut(&mut self) -> &mut [Vec<f64>] {
        &mut self.lists
    }

    /// Lists of each of `item_count` items; none if nothing is kept.
    pub(super) fn items_mut(&mut self, item_count: usize) -> impl Iterator<Item = &mut [Vec<f64>]> {
        let quantity_count = self.lists.len() / item_count.max(1);
        self.lists.chunks_mut(quantity_count.max(1))
    }

    /// Lists of an item out of `item_count`; empty if nothing is kept.
    pub(super) fn of_item(&self, item: usize, item_count: usize) -> &[Vec<f64>] {
        let quantity_count = self.lists.len() / item_count.max(1);
        &self.lists[item * quantity_count..(item + 1) * quantity_count]
    }
}
