//! Exact lags before the exponentials begin.

use crate::error::{Error, Observer, Result, unobserved};
use crate::history::convolution_weights::{ConvolutionWeights, by_kind};
use crate::history::pair_classes::{COUPLING_KIND, PairClasses, STRIP_KINDS};
use crate::history::shared_spectra::SharedSpectra;

/// Error for a kernel whose coupling does not end within the window.
const COUPLING_OUTLASTS_WINDOW: Error = Error::Scene {
    quantity: "history by exponentials",
    needed: "convolution weights whose coupling ends before the exponentials begin",
};

/// A kernel whose coefficients are zero after its window.
pub(super) struct WindowedWeights<'a> {
    pub(super) kernel: &'a dyn ConvolutionWeights,
    /// Last lag with coefficients.
    pub(super) lags: usize,
    pub(super) spectra: &'a SharedSpectra,
}

impl ConvolutionWeights for WindowedWeights<'_> {
    fn classes(&self) -> &PairClasses {
        self.kernel.classes()
    }

    fn prepare(&self, lags: usize, observer: &mut Observer<'_>) -> Result<()> {
        self.kernel.prepare(lags.min(self.lags), observer)
    }

    fn coefficients(
        &self,
        class: usize,
        first_lag: usize,
        values: &mut [&mut [f64]],
    ) -> Result<()> {
        let values: &mut [_; STRIP_KINDS] = by_kind(values)?;
        let lag_count = (self.lags + 1).saturating_sub(first_lag).min(values[0].len());
        let mut window_values = values.each_mut().map(|values| {
            let (window_values, values_after_window) = values.split_at_mut(lag_count);
            values_after_window.fill(0.0);
            window_values
        });
        self.kernel.coefficients(class, first_lag, &mut window_values)
    }

    fn last_coupling_lag(&self, class: usize) -> Result<Option<usize>> {
        self.kernel.last_coupling_lag(class)
    }

    fn spectra(&self) -> Option<&SharedSpectra> {
        Some(self.spectra)
    }
}

/// Coefficients of lags 1 to W of all classes.
///
/// Lag 1 does not belong to the history, but the check for passivity needs it.
#[derive(Debug, Clone)]
pub(super) struct Lags {
    /// Coefficients of each kind, class by class; the coupling only while it is not zero.
    pub(super) kinds: [Vec<Vec<f64>>; STRIP_KINDS],
}

impl Lags {
    /// Reads lags 1 to `window` of `kernel`.
    pub(super) fn new(kernel: &dyn ConvolutionWeights, window: usize) -> Result<Self> {
        kernel.prepare(window, &mut unobserved)?;
        let mut kinds = [(); STRIP_KINDS].map(|()| Vec::with_capacity(kernel.classes().count()));
        for class in 0..kernel.classes().count() {
            let mut lags = [(); STRIP_KINDS].map(|()| vec![0.0; window]);
            kernel.coefficients(class, 1, &mut lags.each_mut().map(Vec::as_mut_slice))?;
            let coupling_end =
                kernel.last_coupling_lag(class)?.filter(|coupling_end| *coupling_end <= window);
            lags[COUPLING_KIND].truncate(coupling_end.ok_or(COUPLING_OUTLASTS_WINDOW)?);
            lags[COUPLING_KIND].shrink_to_fit();
            kinds.iter_mut().zip(lags).for_each(|(kind, lags)| kind.push(lags));
        }
        Ok(Self { kinds })
    }

    /// Number of lags, W.
    pub(super) fn length(&self) -> usize {
        self.kinds[0].first().map_or(0, Vec::len)
    }
}
