//! Stability of a boundary equation in time: growth factors and passivity, before the run.
//!
//! The degrees of freedom x are displacements of traction-free elements, and tractions of elements with
//! prescribed displacement. The equation Σ F^{N−m} xᵐ = known has the symbol F(ζ) = Σ Fⁿ ζⁿ, with columns of
//! H and −G. Perturbations grow if and only if det F has a zero in |ζ| < 1. The smallest zero gives the
//! growth factor 1/|ζ| per step. Zeros are counted by the argument principle on circles (F has no poles
//! there, since its coefficients do not grow), and the smallest modulus is found by bisection.

use std::fmt;

use super::passivity::passivity;
use super::stability_symbol::Symbol;
use super::stability_zeros::smallest_zero;
use super::{BoundaryCondition, BoundaryKernel};
use crate::error::{GroundError, Result, require};

/// Error unless this growth can be searched for.
pub(super) fn check_growth(smallest: f64) -> Result<()> {
    let fits = (1e-7..=0.5).contains(&smallest);
    require("growth looked for", smallest, fits, "between 1e-7 and 0.5 per step").map(drop)
}

/// Assessment of the stability of a boundary equation in time.
#[derive(Debug, Clone, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(deny_unknown_fields))]
#[non_exhaustive]
pub struct Stability {
    /// Growth factor of the worst perturbation per step, minus one; 0 if nothing grows.
    ///
    /// Growth slower than [`Stability::smallest_growth`] counts as 0. The error is one percent if several
    /// modes grow alike.
    pub growth_per_step: f64,
    /// Phase change of the growing perturbation per step, rad, from 0 (monotonic) to π (alternating).
    pub turn_per_step: f64,
    /// Number of growing modes.
    pub growing_modes: usize,
    /// Smallest growth that was searched for; slower growth is not found.
    pub smallest_growth: f64,
    /// Smallest eigenvalue of the Hermitian part of (1−ζ) L C(ζ) over |ζ| = 1, relative.
    ///
    /// It is relative to the largest magnitude of any eigenvalue. C is the compliance of the elements with
    /// prescribed displacement (the others are traction-free), L the matrix of their lengths. If the figure
    /// is negative, some motion draws energy from the soil, measured by Σ t·Δu. `None` without such elements,
    /// or where H is singular on the circle.
    ///
    /// If modes grow in the traction-free problem, C is not the transform of a causal response, and the
    /// figure means little.
    pub passivity: Option<f64>,
    /// Smallest eigenvalue of the Hermitian part of s L C, relative to the largest magnitude of any
    /// eigenvalue.
    ///
    /// s = δ(ζ)/Δt is the Laplace variable of the kernel. `None` for kernels that do not return s.
    pub passivity_of_rate: Option<f64>,
    /// Angle of ζ at the worst [`Stability::passivity`], rad.
    pub passivity_angle: Option<f64>,
    /// Number of lags that were summed directly; later lags are interpolated in 1/n.
    pub summed_lags: usize,
    /// Largest relative error of the interpolation at late lags that were checked.
    pub tail_error: f64,
}

impl Stability {
    /// Assesses `kernel` with one condition for each of its elements.
    ///
    /// `smallest_growth` is the smallest growth per step to search for. The inverse of the number of steps is
    /// a good choice: slower growth is then less than e-fold.
    ///
    /// The method assumes that coefficients become smooth functions of 1/n once the waves have passed, as in
    /// an elastic plane; [`Stability::tail_error`] checks this for the late lags. Structures coupled to the
    /// elements are not part of the assessment.
    ///
    /// ```
    /// use basemat::bem::full_plane::{
    ///     BoundaryCondition, ConvolutionQuadrature, CqMethod, Segment, Stability,
    /// };
    /// use basemat::{Error, Soil, bem::GroundError};
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
    /// assert!(assess(2.0)?.require_bounded().is_ok());
    /// assert!(matches!(assess(0.1)?.require_bounded(), Err(Error::Ground(GroundError::Unstable { .. }))));
    /// # Ok::<(), Error>(())
    /// ```
    ///
    /// # Errors
    /// [`Error::Size`](crate::Error::Size) unless there is one condition per element,
    /// [`Error::Input`](crate::Error::Input) for a growth outside 1e-7 to 1/2,
    /// [`Error::Singular`](crate::Error::Singular) if the operator of the first lag is singular, and errors of the
    /// kernel.
    pub fn assess(
        kernel: &dyn BoundaryKernel,
        conditions: &[BoundaryCondition],
        smallest_growth: f64,
    ) -> Result<Self> {
        check_growth(smallest_growth)?;
        Self::from_symbol(&Symbol::new(kernel, conditions)?, smallest_growth)
    }

    /// Stability of a given symbol.
    pub(super) fn from_symbol(symbol: &Symbol, smallest_growth: f64) -> Result<Self> {
        let found = smallest_zero(symbol, smallest_growth)?;
        let passivity = passivity(symbol)?;
        Ok(Self {
            growth_per_step: found.zero.map_or(0.0, |zero| 1.0 / zero.norm() - 1.0),
            turn_per_step: found.zero.map_or(0.0, |zero| zero.arg().abs()),
            growing_modes: found.count,
            smallest_growth,
            passivity: passivity.as_ref().map(|found| found.work),
            passivity_of_rate: passivity.as_ref().and_then(|found| found.rate),
            passivity_angle: passivity.as_ref().map(|found| found.angle),
            summed_lags: symbol.summed_lags(),
            tail_error: symbol.tail_error(),
        })
    }

    /// Whether no mode grows faster than [`Stability::smallest_growth`].
    pub fn is_bounded(&self) -> bool {
        self.growing_modes == 0
    }

    /// Returns `Ok` if no perturbation grows.
    ///
    /// # Errors
    /// [`GroundError::Unstable`](crate::bem::GroundError::Unstable) if perturbations grow.
    pub fn require_bounded(&self) -> Result<()> {
        if self.is_bounded() {
            Ok(())
        } else {
            Err(GroundError::Unstable {
                growth_per_step: self.growth_per_step,
                growing_modes: self.growing_modes,
            }
            .into())
        }
    }
}

impl fmt::Display for Stability {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if self.is_bounded() {
            write!(f, "bounded (no growth above {:.0e} per step", self.smallest_growth)?;
        } else {
            write!(
                f,
                "grows {:.2e} per step ({} modes, turning {:.2} rad per step",
                self.growth_per_step, self.growing_modes, self.turn_per_step
            )?;
        }
        write!(f, "; {} lags, tail to {:.0e})", self.summed_lags, self.tail_error)?;
        match self.passivity {
            Some(figure) if figure < -1e-9 => write!(f, ", active: passivity {figure:.1e}"),
            Some(_) => write!(f, ", passive"),
            None => Ok(()),
        }
    }
}
