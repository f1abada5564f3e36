//! Which history a half-plane keeps.

use std::sync::Arc;

use super::PatchKernel;
use crate::history::{ConvolutionHistory, DirectHistory, RelaxedFftHistory};

/// How the half-plane sums what all past tractions give. Both ways are exact to rounding.
///
/// | | multiply–adds in N steps, Q elements | memory |
/// |---|---|---|
/// | direct | Q² N² | least |
/// | relaxed transforms | about 2Q² N (32 + 2 log₂(N/64)), and transforms | about 3 to 5 times as much |
///
/// See [`RelaxedFftHistory`] for the model in full.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Hash)]
#[non_exhaustive]
pub enum History {
    /// The sum as it is, [`DirectHistory`]: for checks, and where memory counts most.
    Direct,
    /// Transforms of blocks, [`RelaxedFftHistory`].
    RelaxedFft,
    /// The relaxed transforms, whatever the number of steps, which is not known in advance: they
    /// sum the first 64 steps directly too, and are no slower than the direct sum from there on.
    #[default]
    Auto,
}

impl History {
    /// An empty history of this kind.
    pub(super) fn make(self, kernel: Arc<PatchKernel>) -> Box<dyn ConvolutionHistory> {
        match self {
            Self::Direct => Box::new(DirectHistory::new(kernel)),
            Self::RelaxedFft | Self::Auto => Box::new(RelaxedFftHistory::new(kernel)),
        }
    }
}
