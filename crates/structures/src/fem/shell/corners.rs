//! Four or three items of a shell, one for each corner.

/// Nodes of a shell, or their coordinates.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Corners<T> {
    Four([T; 4]),
    Three([T; 3]),
}

impl<T: Copy> Corners<T> {
    /// The `items`, if there are four or three.
    pub(super) fn of(items: &[T]) -> Option<Self> {
        let four = items.try_into().ok().map(Self::Four);
        four.or_else(|| items.try_into().ok().map(Self::Three))
    }

    pub(super) fn as_slice(&self) -> &[T] {
        match self {
            Self::Four(items) => items,
            Self::Three(items) => items,
        }
    }
}
