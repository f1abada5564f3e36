//! What the transformed history asks of a patch of elements.

use super::Shelf;
use crate::bem::{ContactElement, Pair, PatchKernel};
use crate::error::Result;

/// Coefficients of pairs of elements over the lags, each kind of pair once.
///
/// At lag n, pressures move receivers down by `normal` and shears move them along by `tangential`,
/// both times [`Pair::scale`]; shears move them down by `coupling` times [`Pair::sign`] and scale,
/// and pressures along by the negative of that.
pub(crate) trait CoefficientSource: Send + Sync {
    /// The elements, from left to right.
    fn elements(&self) -> &[ContactElement];

    /// Receiver by receiver, one pair per source.
    fn pairs(&self) -> &[Pair];

    /// Number of classes of pairs.
    fn classes(&self) -> usize;

    /// Overwrites the slices (of one length) with the lags from `first_lag` on.
    fn coefficients(&self, class: usize, first_lag: usize, values: [&mut [f64]; 3]) -> Result<()>;

    /// Last lag at which the coupling of `class` is not zero; 0 if it always is.
    fn last_coupling_lag(&self, class: usize) -> Result<usize>;

    /// Where histories of these coefficients leave their spectra for others.
    fn shelf(&self) -> Option<&Shelf> {
        None
    }
}

impl CoefficientSource for PatchKernel {
    fn elements(&self) -> &[ContactElement] {
        self.elements()
    }

    fn pairs(&self) -> &[Pair] {
        self.pairs()
    }

    fn classes(&self) -> usize {
        self.classes()
    }

    fn coefficients(&self, class: usize, first_lag: usize, values: [&mut [f64]; 3]) -> Result<()> {
        let [normal, tangential, coupling] = values;
        self.coefficients(class, first_lag, normal, tangential, coupling)
    }

    fn last_coupling_lag(&self, class: usize) -> Result<usize> {
        self.last_coupling_lag(class)
    }

    fn shelf(&self) -> Option<&Shelf> {
        Some(self.shelf())
    }
}
