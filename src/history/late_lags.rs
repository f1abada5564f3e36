//! Late lags as data: decaying exponentials in time, a few functions over the patch in space.

use crate::error::{Error, Result, finite, not_negative, same_length};

/// A kernel whose late lags are sums of decaying exponentials.
///
/// [`ExponentialHistory`](super::ExponentialHistory) compares what [`LateLags::exponentials`] gives
/// with the coefficients themselves, at single lags up to the horizon, and looks whether window and
/// exponentials together are passive. So [`LagKernel::coefficients`](super::LagKernel::coefficients)
/// should be quick at any lag here.
pub trait LateLags: Send + Sync {
    /// The last lag that no exponentials can stand for. The coupling must have ended by then.
    fn window(&self) -> usize;

    /// Exponentials for the lags from `window` + 1 to `horizon`, `window` at least
    /// [`LateLags::window`], each within about `tolerance` of the largest of its lag. What they
    /// reach is measured, and a smaller tolerance asked for where it is not enough.
    ///
    /// # Errors
    /// If there are none.
    fn exponentials(
        &self,
        window: usize,
        horizon: usize,
        tolerance: f64,
    ) -> Result<ExponentialTail>;
}

/// Coefficients behind a window of W lags: at lag W + 1 + a, a = 0, 1, …, those of receiver p and
/// source q (means, m/Pa) are
///
/// ```math
/// G_{pq} = l_q \sum_{ij} \varphi_i(p)\, \varphi_j(q) \sum_k w_{ijk}\, e^{-r_k a}
/// ```
///
/// with `φ_i(p)` the mean of function i over element p, one sum for the normal components and one for the
/// tangential ones. There is no coupling between them.
#[derive(Debug, Clone, PartialEq)]
pub struct ExponentialTail {
    rates: Vec<f64>,
    functions: Vec<Vec<f64>>,
    products: Vec<TailProduct>,
}

/// Product of a function of the traction with a function of the displacement, and the other way
/// round.
#[derive(Debug, Clone, PartialEq)]
pub struct TailProduct {
    /// i and j of [`ExponentialTail`]; a product of different functions stands for both orders.
    pub functions: [usize; 2],
    /// Weights of the normal components, 1/(m Pa), for the first few rates.
    pub normal: Vec<f64>,
    /// Weights of the tangential components, as many.
    pub tangential: Vec<f64>,
}

impl ExponentialTail {
    /// A tail of `rates` (per step, not negative), `functions` (their means over all elements) and
    /// `products`.
    ///
    /// # Errors
    /// [`Error::Input`] for negative rates or numbers that are not finite, [`Error::Index`] for
    /// functions that do not exist, [`Error::Size`] for functions or weights of different lengths,
    /// or more weights than rates.
    pub fn new(
        rates: Vec<f64>,
        functions: Vec<Vec<f64>>,
        products: Vec<TailProduct>,
    ) -> Result<Self> {
        for rate in &rates {
            not_negative("rate of an exponential", *rate)?;
        }
        for means in &functions {
            same_length("means of a function", means.len(), functions[0].len())?;
            for mean in means {
                finite("mean of a function over an element", *mean)?;
            }
        }
        for TailProduct { functions: pair, normal, tangential } in &products {
            if let Some(&index) = pair.iter().find(|&&index| index >= functions.len()) {
                let (quantity, bound) = ("function of a product", functions.len());
                return Err(Error::Index { quantity, index, bound });
            }
            same_length("tangential weights", tangential.len(), normal.len())?;
            if normal.len() > rates.len() {
                let (found, needed) = (normal.len(), rates.len());
                return Err(Error::Size { quantity: "weights of a product", found, needed });
            }
            for weight in normal.iter().chain(tangential) {
                finite("weight of an exponential", *weight)?;
            }
        }
        Ok(Self { rates, functions, products })
    }

    /// Rates per step.
    pub fn rates(&self) -> &[f64] {
        &self.rates
    }

    /// Per function: its means over the elements.
    pub fn functions(&self) -> &[Vec<f64>] {
        &self.functions
    }

    /// Products of functions, and their weights.
    pub fn products(&self) -> &[TailProduct] {
        &self.products
    }
}
