//! Rings of past steps: rows whose places are used again.

/// Number of steps summed directly; the smallest block has this size.
///
/// Measured with 10 and 14 elements by pairs, 16 takes as long and 64 a fifth longer; by wavenumbers the times differ
/// little.
pub(crate) const LEAF_STEPS: usize = 32;

/// Number of steps that a row holds before its places are used again.
#[derive(Debug, Clone, Copy)]
pub(super) struct Ring(pub(super) usize);

impl Ring {
    /// A row that holds all steps.
    pub(super) const ALL_STEPS: Self = Self(usize::MAX);

    /// Place of a step in its row.
    pub(super) fn place(self, step: usize) -> usize {
        if self.is_bounded() { step % self.0 } else { step }
    }

    /// Places of the block of `size` steps that ends before `now`.
    pub(super) fn before(self, now: usize, size: usize) -> std::ops::Range<usize> {
        let begin = self.place(now - size);
        begin..begin + size
    }

    /// Whether places are used again.
    pub(super) fn is_bounded(self) -> bool {
        self.0 < usize::MAX
    }

    /// Number of the level for the block that ends before `now`, a multiple of a leaf.
    pub(super) fn level(self, now: usize, levels: usize) -> usize {
        let number = (now / LEAF_STEPS).trailing_zeros() as usize;
        if self.is_bounded() { number.min(levels - 1) } else { number }
    }

    /// Places to be cleared for outputs from `now` on.
    pub(super) fn stale(self, now: usize) -> Option<std::ops::Range<usize>> {
        let half = self.0 / 2;
        let begins = self.is_bounded() && now.is_multiple_of(half);
        begins.then(|| self.place(now)..self.place(now) + half)
    }
}

/// Copies `count` rows of `stride` values into longer rows of `new_stride` values.
pub(super) fn widened<T: Copy + Default>(
    rows: &[T],
    count: usize,
    stride: usize,
    new_stride: usize,
) -> Vec<T> {
    let mut wide = vec![T::default(); count * new_stride];
    for (wide, row) in wide.chunks_exact_mut(new_stride).zip(rows.chunks_exact(stride.max(1))) {
        wide[..stride].copy_from_slice(row);
    }
    wide
}
