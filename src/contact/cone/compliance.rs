//! W in the form whose products take the least time, chosen when W is read.

use super::lattice::LatticeCompliance;
use super::low_rank::LowRankCompliance;
use super::near_field::NearFieldBlocks;

/// Form of W for products and sweeps.
///
/// The proximal point method adds a number to the diagonal: only [`Self::Entries`] contains it, the other forms do not.
/// Newton's method factors the stored entries in all forms but the last.
#[derive(Default)]
pub(super) enum ComplianceForm {
    /// The stored entries alone.
    #[default]
    Entries,
    /// Elements on a lattice; a force on one moves many others much.
    Lattice(Box<LatticeCompliance>),
    /// Elements on a lattice; a force on one moves few others much.
    NearField(Box<NearFieldBlocks>),
    /// Independent elements under a structure with few modes; no entries are stored.
    LowRank(Box<LowRankCompliance>),
}

impl ComplianceForm {
    /// Blocks of elements that move each other much, if W has this form.
    pub(super) fn near_field(&self) -> Option<&NearFieldBlocks> {
        if let Self::NearField(blocks) = self { Some(blocks) } else { None }
    }

    /// Mutable [`ComplianceForm::near_field`].
    pub(super) fn near_field_mut(&mut self) -> Option<&mut NearFieldBlocks> {
        if let Self::NearField(blocks) = self { Some(blocks) } else { None }
    }

    /// W of low rank, if W has this form.
    pub(super) fn low_rank(&self) -> Option<&LowRankCompliance> {
        if let Self::LowRank(operator) = self { Some(operator) } else { None }
    }
}
