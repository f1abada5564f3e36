//! Ring buffers of past steps.

/// Number of steps summed directly; the smallest block has this size.
///
/// With 10 and 14 elements over pairs, a step takes as long with 16 and a fifth longer with 64. Over wavenumbers the
/// times differ little.
pub(crate) const LEAF_STEPS: usize = 32;

/// Number of steps that a row stores before its columns are used again.
#[derive(Debug, Clone, Copy)]
pub(super) struct Ring(pub(super) usize);

impl Ring {
    /// A row that stores all steps.
    pub(super) const ALL_STEPS: Self = Self(usize::MAX);

    /// Column of a step in its row.
    pub(super) fn column(self, step: usize) -> usize {
        if self.is_bounded() { step % self.0 } else { step }
    }

    /// Columns of the block of `block_size` steps that ends before `step`.
    pub(super) fn input_range(self, step: usize, block_size: usize) -> std::ops::Range<usize> {
        let start = self.column(step - block_size);
        start..start + block_size
    }

    /// Whether columns are used again.
    pub(super) fn is_bounded(self) -> bool {
        self.0 < usize::MAX
    }

    /// Index of the level for the block that ends before `step`, a multiple of a leaf.
    pub(super) fn level_index(self, step: usize, level_count: usize) -> usize {
        let index = (step / LEAF_STEPS).trailing_zeros() as usize;
        if self.is_bounded() { index.min(level_count - 1) } else { index }
    }

    /// Columns of old inputs that must be cleared for the outputs from `step` on; `None` unless a half begins.
    pub(super) fn stale_range(self, step: usize) -> Option<std::ops::Range<usize>> {
        let half = self.0 / 2;
        let begins_half = self.is_bounded() && step.is_multiple_of(half);
        begins_half.then(|| self.column(step)..self.column(step) + half)
    }
}

/// Copies `row_count` rows of `stride` values into longer rows of `new_stride` values.
pub(super) fn widened<T: Copy + Default>(
    rows: &[T],
    row_count: usize,
    stride: usize,
    new_stride: usize,
) -> Vec<T> {
    let mut wide_rows = vec![T::default(); row_count * new_stride];
    for (wide_row, row) in
        wide_rows.chunks_exact_mut(new_stride).zip(rows.chunks_exact(stride.max(1)))
    {
        wide_row[..stride].copy_from_slice(row);
    }
    wide_rows
}
