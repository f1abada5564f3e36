//! The window: lags that are used as they are.

use crate::error::{Error, Result};
use crate::history::lag_kernel::LagKernel;
use crate::history::pair_classes::PairClasses;
use crate::history::relaxed_fft::SharedSpectra;

const COUPLING_LASTS: Error =
    Error::NoExponentials { needed: "a coupling that ends before the exponentials begin" };

/// A kernel without the lags behind its window.
pub(super) struct Cut<'a> {
    pub(super) kernel: &'a dyn LagKernel,
    /// The last lag that is left.
    pub(super) lags: usize,
    pub(super) spectra: &'a SharedSpectra,
}

impl LagKernel for Cut<'_> {
    fn classes(&self) -> &PairClasses {
        self.kernel.classes()
    }

    fn prepare(&self, lags: usize) -> Result<()> {
        self.kernel.prepare(lags.min(self.lags))
    }

    fn coefficients(
        &self,
        class: usize,
        first_lag: usize,
        normal: &mut [f64],
        tangential: &mut [f64],
        coupling: &mut [f64],
    ) -> Result<()> {
        let left = (self.lags + 1).saturating_sub(first_lag).min(normal.len());
        let [(normal, zz), (tangential, xx), (coupling, zx)] =
            [normal, tangential, coupling].map(|values| values.split_at_mut(left));
        for cut in [zz, xx, zx] {
            cut.fill(0.0);
        }
        self.kernel.coefficients(class, first_lag, normal, tangential, coupling)
    }

    fn last_coupling_lag(&self, class: usize) -> Result<Option<usize>> {
        self.kernel.last_coupling_lag(class)
    }

    fn spectra(&self) -> Option<&SharedSpectra> {
        Some(self.spectra)
    }
}

/// Coefficients of lags 1 to W (those of lag 1 are no part of the history, but of the check for
/// passivity), per kind (normal, tangential, coupling) and class; the coupling's as long as it is not zero.
#[derive(Debug, Clone, Default)]
pub(super) struct Lags(pub(super) [Vec<Vec<f64>>; 3]);

impl Lags {
    /// Lags 1 to `window`.
    pub(super) fn new(kernel: &dyn LagKernel, window: usize) -> Result<Self> {
        kernel.prepare(window)?;
        let mut lags = Self::default();
        for class in 0..kernel.classes().count() {
            let [mut zz, mut xx, mut zx] = [(); 3].map(|()| vec![0.0; window]);
            kernel.coefficients(class, 1, &mut zz, &mut xx, &mut zx)?;
            let last = kernel.last_coupling_lag(class)?.filter(|last| *last <= window);
            zx.truncate(last.ok_or(COUPLING_LASTS)?);
            zx.shrink_to_fit();
            lags.0.iter_mut().zip([zz, xx, zx]).for_each(|(kind, values)| kind.push(values));
        }
        Ok(lags)
    }
}
