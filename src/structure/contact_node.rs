//! Points of a structure's base.

use std::ops::Range;

use super::DofCombination;
use crate::error::{Error, Result, finite};

/// A point of the base: where it is, and how the degrees of freedom move it.
#[derive(Debug, Clone, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(deny_unknown_fields))]
pub struct ContactNode {
    /// Coordinate along the surface, m.
    pub x: f64,
    /// Horizontal displacement (to the right) as a weighted sum of degrees of freedom.
    pub horizontal: DofCombination,
    /// Vertical displacement (up) as a weighted sum of degrees of freedom.
    pub vertical: DofCombination,
}

impl ContactNode {
    /// A node with a horizontal and a vertical unknown of its own.
    pub fn free(x: f64, horizontal: usize, vertical: usize) -> Self {
        Self { x, horizontal: horizontal.into(), vertical: vertical.into() }
    }

    /// A point of a rigid flat base with degrees of freedom `[horizontal, vertical, rotation]` at `center`.
    pub fn rigid(x: f64, center: f64, dofs: [usize; 3]) -> Self {
        let [horizontal, vertical, rotation] = dofs;
        Self {
            x,
            horizontal: horizontal.into(),
            vertical: [(vertical, 1.0), (rotation, x - center)].into(),
        }
    }

    /// The degrees of freedom that move it.
    pub(crate) fn dofs(&self) -> impl Iterator<Item = usize> {
        let terms = self.horizontal.iter().chain(self.vertical.iter());
        terms.filter(|(_, weight)| *weight != 0.0).map(|(unknown, _)| *unknown)
    }

    /// The two ends of a rigid flat base from `left` to `right`, degrees of freedom at its middle.
    pub fn rigid_base(left: f64, right: f64, dofs: [usize; 3]) -> Vec<Self> {
        let center = 0.5 * (left + right);
        vec![Self::rigid(left, center, dofs), Self::rigid(right, center, dofs)]
    }
}

/// Refuses too few nodes, places and weights that are not finite, and degrees of freedom that there are not.
pub(crate) fn check_contact_nodes(nodes: &[ContactNode], dofs: usize) -> Result<()> {
    if nodes.len() < 2 {
        let quantity = "list of contact nodes";
        return Err(Error::Size { quantity, found: nodes.len(), needed: 2 });
    }
    for node in nodes {
        finite("coordinate of a contact node", node.x)?;
        for &(index, weight) in (&node.horizontal).into_iter().chain(&node.vertical) {
            finite("weight of a contact node", weight)?;
            if index >= dofs {
                let quantity = "unknown of a contact node";
                return Err(Error::Index { quantity, index, bound: dofs });
            }
        }
    }
    Ok(())
}

/// Contact nodes of each foundation, for `count` nodes in all and those that are the last of a
/// foundation, the very last excepted; two or more each.
pub(crate) fn foundation_nodes(count: usize, ends: &[usize]) -> Result<Vec<Range<usize>>> {
    let mut first = 0;
    let mut all = Vec::with_capacity(ends.len() + 1);
    for last in ends.iter().copied().chain([count.saturating_sub(1)]) {
        if last >= count.max(1) {
            let quantity = "last contact node of a foundation";
            return Err(Error::Index { quantity, index: last, bound: count });
        }
        if last <= first {
            let quantity = "list of contact nodes of a foundation";
            let found = (last + 1).saturating_sub(first).min(count);
            return Err(Error::Size { quantity, found, needed: 2 });
        }
        all.push(first..last + 1);
        first = last + 1;
    }
    Ok(all)
}
