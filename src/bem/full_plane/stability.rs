//! Stability of a boundary equation in time: growth of perturbations, before the run.
//!
//! The degrees of freedom x are displacements of traction-free elements, and tractions of elements with
//! prescribed displacement. Prescribed values form the right-hand side b. The equation Σ F^{N−m} xᵐ = bᴺ has the
//! symbol F(ζ) = Σ Fⁿ ζⁿ, with columns of H and −G. Perturbations grow if and only if det F has a zero in |ζ| < 1. The
//! growth factor per step is 1/|ζ| of the smallest zero. Zeros are counted by the argument principle on circles (F has
//! no poles there, because its coefficients do not grow), and the smallest modulus is determined by bisection.

use super::stability_symbol::BoundarySymbol;
use super::stability_zeros::smallest_zero;
use super::{BoundaryCondition, BoundaryKernel};
use crate::error::{Result, require};

/// Growth of the worst perturbation of a boundary equation in time.
#[derive(Debug, Clone, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(deny_unknown_fields))]
#[non_exhaustive]
pub struct Stability {
    /// Growth factor of the worst perturbation per step, minus one; 0 if nothing grows.
    ///
    /// Growth below the smallest growth of the search counts as 0. The error is one per cent if several modes grow at
    /// nearly the same rate.
    pub growth_per_step: f64,
    /// Number of growing modes.
    pub growing_modes: usize,
}

/// Values of the smallest growth: below the range rounding decides, above it the run would end within a few steps.
const GROWTH_RANGE: std::ops::RangeInclusive<f64> = 1e-7..=0.5;

impl Stability {
    /// Assesses `kernel` with one condition for each of its elements.
    ///
    /// `smallest_growth` is the smallest growth per step to search for. The inverse of the number of steps is a good
    /// choice: slower growth is then less than e-fold in the run.
    ///
    /// Late coefficients are interpolated: they become smooth functions of 1/n once the waves have passed, as in
    /// an elastic plane. Structures coupled to the elements are not part of the assessment.
    ///
    /// ```
    /// use basemat::bem::full_plane::{
    ///     BoundaryCondition, ConvolutionQuadrature, CqMethod, Segment, Stability,
    /// };
    /// use basemat::Soil;
    ///
    /// let soil = Soil::new(80.0e6, 1.0 / 3.0, 1900.0)?;
    /// let flat: Vec<_> =
    ///     (0..20).map(f64::from).map(|x| Segment { from: [x, 0.0], to: [x + 1.0, 0.0] }).collect();
    /// let conditions = [BoundaryCondition::TractionFree; 20];
    /// let assess = |beta: f64| {
    ///     let step = beta / soil.pressure_wave_speed();
    ///     let kernel = ConvolutionQuadrature::new(soil, &flat, step, CqMethod::Bdf2)?;
    ///     Stability::assess(&kernel, &conditions, 1e-3)
    /// };
    /// assert!(assess(2.0)?.is_bounded());
    /// assert!((assess(0.1)?.growth_per_step - 7.2e-3).abs() < 5e-5);
    /// # Ok::<(), basemat::Error>(())
    /// ```
    ///
    /// # Errors
    /// [`Error::Size`](crate::Error::Size) unless there is one condition per element,
    /// [`Error::Input`](crate::Error::Input) for a growth outside 1e-7 to 1/2,
    /// [`Error::Singular`](crate::Error::Singular) if the operator of the first lag is singular,
    /// [`Error::Part`](crate::Error::Part) if late coefficients are not smooth, and errors of the kernel.
    pub fn assess(
        kernel: &dyn BoundaryKernel,
        conditions: &[BoundaryCondition],
        smallest_growth: f64,
    ) -> Result<Self> {
        Self::from_symbol(&BoundarySymbol::new(kernel, conditions)?, smallest_growth)
    }

    /// Stability of a boundary equation with this symbol.
    pub(super) fn from_symbol(symbol: &BoundarySymbol, smallest_growth: f64) -> Result<Self> {
        let is_in_range = GROWTH_RANGE.contains(&smallest_growth);
        require("smallest growth", smallest_growth, is_in_range, "between 1e-7 and 0.5 per step")?;
        let zeros = smallest_zero(symbol, smallest_growth)?;
        Ok(Self {
            growth_per_step: zeros.smallest_zero.map_or(0.0, |zero| 1.0 / zero.norm() - 1.0),
            growing_modes: zeros.zero_count,
        })
    }

    /// Whether no mode grows faster than the smallest growth that was searched for.
    pub fn is_bounded(&self) -> bool {
        self.growing_modes == 0
    }
}
