//! Late convolution weights as a sum of decaying exponentials.

use crate::error::{Error, Result, finite, in_bounds, not_negative, same_length};

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
pub struct ExponentialSum {
    /// Rates per step.
    pub(super) rates: Vec<f64>,
    /// Per function: its means over the elements.
    pub(super) functions: Vec<Vec<f64>>,
    pub(super) products: Vec<TailProduct>,
}

/// Product of a function of the traction with a function of the displacement, and the other way
/// round.
#[derive(Debug, Clone, PartialEq)]
pub struct TailProduct {
    /// i and j of [`ExponentialSum`]; a product of different functions stands for both orders.
    pub functions: [usize; 2],
    /// Weights of the normal components, 1/(m Pa), for the first few rates.
    pub normal: Vec<f64>,
    /// Weights of the tangential components, as many.
    pub tangential: Vec<f64>,
}

impl ExponentialSum {
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
            for index in pair {
                in_bounds("function of a product", *index, functions.len())?;
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
}
