//! An element of the contact surface, and the order in which elements come.

use crate::error::{Error, Result, finite, positive};

/// One boundary element of the base: the interval from `left` to `right` of the flat surface, m.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(deny_unknown_fields))]
pub struct ContactElement {
    /// Left end, m.
    pub left: f64,
    /// Right end, m.
    pub right: f64,
}

impl ContactElement {
    /// Length, m.
    pub fn length(&self) -> f64 {
        self.right - self.left
    }

    /// Midpoint, m.
    pub fn center(&self) -> f64 {
        0.5 * (self.left + self.right)
    }
}

/// Error unless the elements have positive length, in order, without overlap.
pub(crate) fn check_order(elements: &[ContactElement]) -> Result<()> {
    if elements.is_empty() {
        return Err(Error::Size { quantity: "list of contact elements", found: 0, needed: 1 });
    }
    for element in elements {
        finite("left end of a contact element", element.left)?;
        finite("right end of a contact element", element.right)?;
        positive("length of a contact element", element.length())?;
    }
    for pair in elements.windows(2) {
        // Neighbours may differ by rounding of a common node.
        let overlap = pair[0].right - pair[1].left;
        if overlap > 1e-9 * pair[0].length().min(pair[1].length()) {
            return Err(Error::Input {
                quantity: "left end of a contact element",
                value: pair[1].left,
                needed: "at or right of the end of the element before it",
            });
        }
    }
    Ok(())
}
