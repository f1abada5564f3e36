//! Rows whose places are used again.

/// Where in its row a step is, and how many steps a row holds before its places are used again.
#[derive(Debug, Clone, Copy)]
pub(super) struct Ring(pub(super) usize);

impl Ring {
    /// Rows that hold all steps.
    pub(super) const ENDLESS: Self = Self(usize::MAX);

    /// Place of a step.
    pub(super) fn place(self, step: usize) -> usize {
        if self.is_bounded() { step % self.0 } else { step }
    }

    /// Places of the `size` steps before `now`, which are a block of their size.
    pub(super) fn before(self, now: usize, size: usize) -> std::ops::Range<usize> {
        let begin = self.place(now - size);
        begin..begin + size
    }

    /// Whether places are used again.
    pub(super) fn is_bounded(self) -> bool {
        self.0 < usize::MAX
    }

    /// Number of the level for the block that ends before `now`, a multiple of `leaf`.
    pub(super) fn level(self, now: usize, leaf: usize, levels: usize) -> usize {
        let number = (now / leaf).trailing_zeros() as usize;
        if self.is_bounded() { number.min(levels - 1) } else { number }
    }

    /// Places whose old inputs have to make room for outputs at `now`.
    pub(super) fn stale(self, now: usize) -> Option<std::ops::Range<usize>> {
        let half = self.0 / 2;
        let begins = self.is_bounded() && now.is_multiple_of(half);
        begins.then(|| self.place(now)..self.place(now) + half)
    }
}
