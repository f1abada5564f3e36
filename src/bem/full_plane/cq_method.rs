//! Backward-differentiation formulas of convolution quadrature.

use super::bessel::Complex64;

/// Backward-differentiation formula of a convolution quadrature.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(rename_all = "snake_case"))]
#[non_exhaustive]
pub enum CqMethod {
    /// δ = 1 − ζ: first order, strongly damped.
    Bdf1,
    /// δ = (1 − ζ) + (1 − ζ)²/2: second order.
    #[default]
    Bdf2,
}

impl CqMethod {
    /// Generating function δ of the formula at ζ.
    pub(super) fn symbol(self, zeta: Complex64) -> Complex64 {
        let difference = 1.0 - zeta;
        match self {
            Self::Bdf1 => difference,
            Self::Bdf2 => difference * (1.0 + 0.5 * difference),
        }
    }
}
