//! Late convolution weights as a sum of decaying exponentials.

use crate::error::{Error, Result, finite, in_bounds, not_negative, same_length};

/// Coefficients of the lags after a window of W lags, as a sum of exponentials.
///
/// At lag W + 1 + a, a = 0, 1, …, the coefficient of receiver p and source q (a mean, m/Pa) is
///
/// ```math
/// G_{pq} = l_q \sum_{ij} \varphi_i(p)\, \varphi_j(q) \sum_k w_{ijk}\, e^{-r_k a}
/// ```
///
/// where `φ_i(p)` is the mean of function i over element p. There is one sum for the normal components and one for the
/// tangential components, and no coupling between them.
#[derive(Debug, Clone, PartialEq)]
pub struct ExponentialSum {
    /// Decay rates, per step.
    pub(super) rates: Vec<f64>,
    /// Means of each function over the elements.
    pub(super) functions: Vec<Vec<f64>>,
    pub(super) products: Vec<TailProduct>,
}

/// Product of a function of the traction and a function of the displacement, with its weights.
///
/// It applies to both orders of the two functions.
#[derive(Debug, Clone, PartialEq)]
pub struct TailProduct {
    /// Indices i and j of the functions in [`ExponentialSum`].
    pub functions: [usize; 2],
    /// Weights of the normal components, 1/(m Pa), for the first few rates.
    pub normal: Vec<f64>,
    /// Weights of the tangential components, 1/(m Pa), as many as of the normal components.
    pub tangential: Vec<f64>,
}

impl ExponentialSum {
    /// Creates a sum of exponentials from its `rates`, `functions` and `products`.
    ///
    /// Rates are per step and not negative. The values of a function are its means over all elements.
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
        for TailProduct { functions: function_pair, normal, tangential } in &products {
            for index in function_pair {
                in_bounds("function of a product", *index, functions.len())?;
            }
            same_length("tangential weights", tangential.len(), normal.len())?;
            if normal.len() > rates.len() {
                return Err(Error::Size {
                    quantity: "weights of a product",
                    found: normal.len(),
                    needed: rates.len(),
                });
            }
            for weight in normal.iter().chain(tangential) {
                finite("weight of an exponential", *weight)?;
            }
        }
        Ok(Self { rates, functions, products })
    }
}
