//! Weights of a ground's convolution, lag by lag; late weights as exponentials.

use super::exponential_sum::ExponentialSum;
#[cfg(feature = "embedded")]
use super::pair_classes::TRENCH_KINDS;
use super::pair_classes::{PairClasses, STRIP_KINDS};
use super::shared_spectra::SharedSpectra;
use crate::error::{Error, Observer, Result, same_length, unobserved};
use crate::geometry::SERIES_PER_OFFSET;

/// Convolution weights Gⁿ of a laterally homogeneous ground for a patch of elements.
///
/// All steps have one length.
///
/// A traction of 1 Pa on element q during one step displaces element p by the mean Gⁿ at the end of the n-th step:
/// n = 1 is the end of the step itself. The ground may vary with depth, but not along the surface, and must be
/// reciprocal. Then only one pair of each [class](PairClasses) has to be computed. The coefficients of a pair are the
/// coefficients of its class times [`Pair::scale`](super::Pair::scale), the coupling also times
/// [`Pair::sign`](super::Pair::sign):
///
/// | displacement | due to | coefficient |
/// |---|---|---|
/// | down | pressure | scale · normal |
/// | to the right | shear | scale · tangential |
/// | down | shear | sign · scale · coupling |
/// | to the right | pressure | −sign · scale · coupling |
///
/// A history stores tables made from [`ConvolutionWeights::coefficients`], so that a step calls nothing here unless
/// memory has to grow. A lag must always have the same bits, on any thread and after any other calls. Then the division
/// of a run into parts changes nothing.
///
/// The example of [`WeightsGround`](crate::bem::WeightsGround) is a kernel in twenty lines.
pub trait ConvolutionWeights: Send + Sync {
    /// The elements, and the classes of their pairs.
    fn classes(&self) -> &PairClasses;

    /// Computes the lags up to `lags` of all classes; nothing for a closed form (the default).
    ///
    /// This is called often, so it must be cheap where all lags are ready. The bits of a lag must not depend on
    /// `lags`: a kernel that computes lags in blocks takes fixed blocks, such as N + 1 … 2N for powers of two.
    /// A history requests powers of two where the number of steps leaves a choice.
    ///
    /// # Errors
    /// [`Error::Stopped`](crate::Error::Stopped) by the observer; if coefficients cannot be computed.
    fn prepare(&self, _lags: usize, _observer: &mut Observer<'_>) -> Result<()> {
        Ok(())
    }

    /// Overwrites `values` with the coefficients of `class` for the lags from `first_lag` (≥ 1) on.
    ///
    /// The slices have one length, one slice for each kind: normal, tangential, coupling. Coefficients are integrals
    /// over the receiver in m²/Pa: down due to pressure, to the right due to shear, and down due to shear with the
    /// receiver to the right of the source. Lags that were not [prepared](ConvolutionWeights::prepare) are computed
    /// now.
    ///
    /// # Errors
    /// [`Error::Index`](crate::Error::Index) for a class that does not exist,
    /// [`Error::Size`](crate::Error::Size) for slices of different lengths,
    /// [`Error::Input`](crate::Error::Input) for lag 0.
    fn coefficients(
        &self,
        class: usize,
        first_lag: usize,
        values: [&mut [f64]; STRIP_KINDS],
    ) -> Result<()>;

    /// Like [`ConvolutionWeights::coefficients`], for cells of a lattice in plan.
    ///
    /// Kinds are zz, xx, yy, xy, zx and zy, integrals over the receiver in m³/Pa. Of these, zx is down due to shear
    /// along x with the receiver to the right of the source; zy is down due to shear along y with the receiver behind
    /// the source; xy is along one axis due to shear along the other, with the receiver to the right and behind.
    ///
    /// # Errors
    /// [`Error::Scene`] for a kernel of strips (the default); as for [`ConvolutionWeights::coefficients`].
    fn coefficients_in_plan(
        &self,
        _class: usize,
        _first_lag: usize,
        _values: [&mut [f64]; SERIES_PER_OFFSET],
    ) -> Result<()> {
        Err(UNSUPPORTED_KINDS)
    }

    /// Like [`ConvolutionWeights::coefficients`], for elements around a trench.
    ///
    /// Kinds: along the normal due to pressure, along the tangent due to shear, along the normal due to shear, along the
    /// tangent due to pressure.
    ///
    /// # Errors
    /// [`Error::Scene`] for a kernel of another ground (the default); as for [`ConvolutionWeights::coefficients`].
    #[cfg(feature = "embedded")]
    fn coefficients_around_trench(
        &self,
        _class: usize,
        _first_lag: usize,
        _values: [&mut [f64]; TRENCH_KINDS],
    ) -> Result<()> {
        Err(UNSUPPORTED_KINDS)
    }

    /// Last lag at which the coupling of `class` is not zero.
    ///
    /// It is 0 if the coupling is always zero, and `None` (the default) if it never ends. If the coupling ends,
    /// histories need no table of it for later lags.
    ///
    /// # Errors
    /// [`Error::Index`](crate::Error::Index) for a class that does not exist.
    fn last_coupling_lag(&self, _class: usize) -> Result<Option<usize>> {
        Ok(None)
    }

    /// Late lags as sums of exponentials; `None` (the default) if there are none.
    ///
    /// [`ExponentialHistory`](super::ExponentialHistory) needs them.
    fn late_weights(&self) -> Option<&dyn LateWeights> {
        None
    }

    /// Largest sum of the errors of late coefficients, relative to the sum of all coefficients.
    ///
    /// Zero (the default) if they are exact. It is the smallest [tolerance](super::HistoryOptions) at which late
    /// weights are left out.
    fn late_error(&self) -> f64 {
        0.0
    }

    /// Store of the spectra that histories of this kernel share; `None` (the default) for no store.
    ///
    /// Without a store each history makes its spectra anew. A kernel keeps the store with its coefficients, and only its
    /// clones share it.
    fn spectra(&self) -> Option<&SharedSpectra> {
        None
    }

    /// Overwrites `matrix` (square, row-major, m/Pa) with the means of lag 1.
    ///
    /// # Errors
    /// [`Error::Size`](crate::Error::Size) for a slice of the wrong length; as for
    /// [`ConvolutionWeights::coefficients`].
    fn step_compliance(&self, matrix: &mut [f64]) -> Result<()> {
        let classes = self.classes();
        same_length("step compliance", matrix.len(), classes.layout().square())?;
        self.prepare(1, &mut unobserved)?;
        #[cfg(feature = "embedded")]
        if classes.are_around_trench() {
            return scatter_first_lag(
                classes,
                matrix,
                |class, values: [&mut [f64]; TRENCH_KINDS]| {
                    self.coefficients_around_trench(class, 1, values)
                },
            );
        }
        if classes.plan().is_some() {
            scatter_first_lag(classes, matrix, |class, values| {
                self.coefficients_in_plan(class, 1, values)
            })
        } else {
            scatter_first_lag(classes, matrix, |class, values| self.coefficients(class, 1, values))
        }
    }
}

/// Overwrites `matrix` with element means of lag 1.
///
/// `first_lag(class, values)` writes the coefficients of a class at lag 1, kind by kind.
fn scatter_first_lag<const N: usize>(
    classes: &PairClasses,
    matrix: &mut [f64],
    first_lag: impl Fn(usize, [&mut [f64]; N]) -> Result<()>,
) -> Result<()> {
    let mut coefficients = Vec::with_capacity(classes.count());
    for class in 0..classes.count() {
        let mut values = [[0.0]; N];
        first_lag(class, values.each_mut().map(<[f64; 1]>::as_mut_slice))?;
        coefficients.push(values.map(|[value]| value));
    }
    classes.scatter(matrix, |_, pair| coefficients[pair.class].map(|value| value * pair.scale));
    Ok(())
}

/// Overwrites `values`, one slice for each kind, with the coefficients of a class.
pub(super) fn read_coefficients(
    kernel: &dyn ConvolutionWeights,
    class: usize,
    first_lag: usize,
    values: &mut [&mut [f64]],
) -> Result<()> {
    match values {
        [normal, tangential, coupling] => {
            kernel.coefficients(class, first_lag, [normal, tangential, coupling])
        }
        #[cfg(feature = "embedded")]
        [nn, tt, nt, tn] => kernel.coefficients_around_trench(class, first_lag, [nn, tt, nt, tn]),
        [zz, xx, yy, xy, zx, zy] => {
            kernel.coefficients_in_plan(class, first_lag, [zz, xx, yy, xy, zx, zy])
        }
        _ => Err(UNSUPPORTED_KINDS),
    }
}

/// Error for a kind of coefficients that a kernel does not have.
pub(crate) const UNSUPPORTED_KINDS: Error = Error::Scene {
    quantity: "coefficients of a kernel",
    needed: "`coefficients` are those of strips, `coefficients_in_plan` those of mats in plan",
};

/// A kernel whose late lags are sums of decaying exponentials.
///
/// [`ExponentialHistory`](super::ExponentialHistory) compares these exponentials with the coefficients at single lags
/// up to the horizon, and checks that window and exponentials together are passive. Therefore
/// [`ConvolutionWeights::coefficients`] should be fast at any lag of such a kernel.
pub trait LateWeights: Send + Sync {
    /// Last lag that exponentials cannot represent.
    ///
    /// The coupling must have ended by then.
    fn window(&self) -> usize;

    /// Exponentials for the lags from `window` + 1 to `horizon`.
    ///
    /// `window` is at least [`LateWeights::window`]. The error of a coefficient should be about `tolerance` times the
    /// largest coefficient of its lag. The caller measures the error, and calls again with a smaller tolerance if it is
    /// too large.
    ///
    /// # Errors
    /// If there are no such exponentials.
    fn exponentials(&self, window: usize, horizon: usize, tolerance: f64)
    -> Result<ExponentialSum>;
}
