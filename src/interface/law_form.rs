//! Form in which a ground takes its laws.

use crate::geometry::ContactLayout;

/// Form in which a ground takes its laws.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum LawForm {
    /// Conditions of each mode, where elements slide along one axis.
    Modes,
    /// Limits of the tractions, where elements slide along two axes.
    Limits,
}

impl LawForm {
    /// Form for the elements of a layout.
    pub(crate) fn of(layout: ContactLayout) -> Self {
        if layout.is_plan() { Self::Limits } else { Self::Modes }
    }
}
