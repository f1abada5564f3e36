//! Traits of a ground's convolution weights: all lags, and late lags as exponentials.

use super::exponential_sum::ExponentialSum;
use super::pair_classes::PairClasses;
use super::shared_spectra::SharedSpectra;
use crate::error::{Error, Observer, Result, same_length, unobserved};
use crate::geometry::COMPLIANCES_PER_OFFSET;

/// Convolution weights Gⁿ of a laterally homogeneous ground for a patch of elements.
///
/// All steps have one length.
///
/// A traction of 1 Pa on element q during one step displaces element p by the mean Gⁿ at the end of the n-th step. The
/// lag n = 1 is the end of the step itself. The ground may vary with depth, but not along the surface, and must be
/// reciprocal. Then only one pair of each [class](PairClasses) has to be computed. The *coefficients* of a class are its
/// weights, integrated over the receiver. The weights of a pair are the coefficients of its class times
/// [`Pair::scale`](super::Pair::scale), the coupling also times [`Pair::sign`](super::Pair::sign):
///
/// | displacement | due to | weight |
/// |---|---|---|
/// | down | pressure | scale · normal |
/// | to the right | shear | scale · tangential |
/// | down | shear | sign · scale · coupling |
/// | to the right | pressure | −sign · scale · coupling |
///
/// A history stores tables made from [`ConvolutionWeights::coefficients`], so that a step calls none of these methods
/// unless memory has to grow. A lag must always have the same bits, on any thread and after any other calls. Then the
/// division of a run into parts does not change the results.
///
/// The example of [`WeightsGround`](crate::bem::WeightsGround) implements this trait in some thirty lines.
pub trait ConvolutionWeights: Send + Sync {
    /// The elements, and the classes of their pairs.
    fn classes(&self) -> &PairClasses;

    /// Computes the lags up to `lags` of all classes; nothing for a closed form (the default).
    ///
    /// Histories call this method often, so it must be cheap where all lags are ready. The bits of a lag must not depend on
    /// `lags`: a kernel that computes lags in blocks uses fixed blocks, such as N + 1 … 2N for powers of two.
    /// A history requests powers of two where the number of steps leaves a choice.
    ///
    /// # Errors
    /// [`Error::Stopped`](crate::Error::Stopped) by the observer; an error if coefficients cannot be computed.
    fn prepare(&self, _lags: usize, _observer: &mut Observer<'_>) -> Result<()> {
        Ok(())
    }

    /// Overwrites `values` with the coefficients of `class` for the lags from `first_lag` (≥ 1) on.
    ///
    /// The slices have one length, one slice for each of the [kinds](PairClasses::kinds) ([`by_kind`] separates them).
    /// Coefficients are integrals over the receiver, in m²/Pa, in plan in m³/Pa:
    ///
    /// | elements | kinds |
    /// |---|---|
    /// | strips | normal: down due to pressure; tangential: to the right due to shear; coupling: down due to shear, with the receiver to the right of the source |
    /// | cells in plan | zz, xx, yy, xy, zx, zy; zx: down due to shear along x, with the receiver to the right of the source; zy: down due to shear along y, with the receiver behind the source; xy: along one axis due to shear along the other, with the receiver to the right and behind |
    /// | around a trench | along the normal due to pressure, along the tangent due to shear, along the normal due to shear, along the tangent due to pressure |
    ///
    /// Lags that were not [prepared](ConvolutionWeights::prepare) are computed now.
    ///
    /// # Errors
    /// [`Error::Index`](crate::Error::Index) for a class that does not exist,
    /// [`Error::Size`](crate::Error::Size) for another number of slices, or slices of different lengths,
    /// [`Error::Input`](crate::Error::Input) for lag 0.
    fn coefficients(&self, class: usize, first_lag: usize, values: &mut [&mut [f64]])
    -> Result<()>;

    /// Last lag at which the coupling of `class` is not zero.
    ///
    /// The lag is 0 if the coupling is always zero, and `None` (the default) if the coupling never ends. Histories store
    /// the coupling only up to this lag.
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
    /// Zero (the default) if the late coefficients are exact. Histories in plan neglect late coefficients up to this
    /// fraction, or 1e-8 if that is larger, unless a [tolerance](super::HistoryOptions) is set.
    fn late_error(&self) -> f64 {
        0.0
    }

    /// Store of the spectra that histories of this kernel share; `None` (the default) for no store.
    ///
    /// Without a store each history computes its spectra again. A kernel stores the spectra with its coefficients, and
    /// shares them only with its clones.
    fn spectra(&self) -> Option<&SharedSpectra> {
        None
    }

    /// Overwrites `matrix` with the compliance of one step, the weights of lag 1.
    ///
    /// `matrix`: square and row-major, m/Pa.
    ///
    /// # Errors
    /// [`Error::Size`](crate::Error::Size) for a slice of the wrong length; as for
    /// [`ConvolutionWeights::coefficients`].
    fn step_compliance(&self, matrix: &mut [f64]) -> Result<()> {
        let classes = self.classes();
        same_length("step compliance", matrix.len(), classes.layout().matrix_len())?;
        self.prepare(1, &mut unobserved)?;
        // Coefficients of each class, kind by kind; zero for kinds that the elements do not have.
        let mut class_coefficients = vec![[0.0; COMPLIANCES_PER_OFFSET]; classes.count()];
        for (class, coefficients) in class_coefficients.iter_mut().enumerate() {
            let mut values: Vec<_> = coefficients.chunks_mut(1).take(classes.kinds()).collect();
            self.coefficients(class, 1, &mut values)?;
        }
        classes.scatter(matrix, |_, pair| {
            class_coefficients[pair.class].map(|coefficient| coefficient * pair.scale)
        });
        Ok(())
    }
}

/// Converts the slices of [`ConvolutionWeights::coefficients`] to an array of N kinds.
///
/// ```
/// use basemat::history::by_kind;
/// let mut lags = [[0.0; 5]; 3];
/// let mut values = lags.each_mut().map(|kind| &mut kind[..]);
/// let [normal, tangential, coupling] = by_kind(&mut values)?;
/// normal[0] = 1.0;
/// # assert!(tangential == coupling);
/// # Ok::<(), basemat::Error>(())
/// ```
///
/// # Errors
/// [`Error::Size`](crate::Error::Size) for another number of slices.
pub fn by_kind<'a, 'b, const N: usize>(
    values: &'a mut [&'b mut [f64]],
) -> Result<&'a mut [&'b mut [f64]; N]> {
    let value_count = values.len();
    let quantity = "kinds of coefficients";
    values
        .try_into()
        .map_err(|_| Error::Size { quantity, found: value_count, needed: N })
}

/// Late convolution weights that are sums of decaying exponentials.
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
    /// An error if there are no such exponentials.
    fn exponentials(&self, window: usize, horizon: usize, tolerance: f64)
    -> Result<ExponentialSum>;
}
