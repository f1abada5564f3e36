//! Whether a boundary equation can march: growth factors and passivity, before the run.
//!
//! With degrees of freedom x (displacements of traction-free elements, tractions of those with prescribed
//! displacement), the march Σ F^{N−m} xᵐ = known has the symbol F(ζ) = Σ Fⁿ ζⁿ, columns of H and −G.
//! Perturbations grow if and only if det F has a zero in |ζ| < 1, by the factor 1/|ζ| per step for
//! the smallest one. Zeros are counted by the argument principle on circles (F has no poles
//! there, since its coefficients do not grow) and the smallest modulus is bisected.

use std::fmt;

use crate::error::{Error, Result, positive};

use super::stability_passivity::passivity;
use super::stability_symbol::Symbol;
use super::stability_zeros::smallest_zero;
use super::{BoundaryCondition, BoundaryKernel};

/// Growth that can be looked for.
pub(super) fn check_growth(smallest: f64) -> Result<()> {
    positive("growth looked for", smallest)?;
    if (1e-7..=0.5).contains(&smallest) {
        return Ok(());
    }
    Err(Error::Input {
        quantity: "growth looked for",
        value: smallest,
        needed: "between 1e-7 and 0.5 per step",
    })
}

/// Assessment of a boundary equation that is to be marched.
#[derive(Debug, Clone, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(deny_unknown_fields))]
#[non_exhaustive]
pub struct Stability {
    /// Factor minus one by which the worst perturbation grows in a step, if any grows faster than
    /// [`Stability::smallest_growth`]; else 0. To one percent where several modes grow alike.
    pub growth_per_step: f64,
    /// Turn of the growing perturbation in a step, rad, from 0 (monotonic) to π (alternating).
    pub turn_per_step: f64,
    /// Number of modes that grow.
    pub growing_modes: usize,
    /// Growth that was looked for: slower growth is not seen.
    pub smallest_growth: f64,
    /// Smallest eigenvalue of the Hermitian part of (1−ζ) L C(ζ) over |ζ| = 1, over the largest
    /// magnitude of any: C the compliance of the elements with prescribed displacement (the others
    /// traction-free), L their lengths. If negative, some motion draws energy from the soil, as
    /// Σ t·Δu sees it. `None` without such elements, or where H is singular on the circle.
    ///
    /// If modes grow in the traction-free problem, C is not the transform of a causal march, and
    /// the figure says little.
    pub passivity: Option<f64>,
    /// The same of s L C at the transform's s = δ(ζ)/Δt, for kernels that know it.
    pub passivity_of_rate: Option<f64>,
    /// Angle of ζ where [`Stability::passivity`] is worst, rad.
    pub passivity_angle: Option<f64>,
    /// Lags that were summed as they are; later ones by interpolation in 1/n.
    pub summed_lags: usize,
    /// Largest departure of checked late coefficients from that interpolation, relative.
    pub tail_error: f64,
}

impl Stability {
    /// Assesses `kernel` with one condition for each of its elements.
    ///
    /// `smallest_growth` is the growth per step that is looked for, best the inverse of the
    /// number of steps to be marched: what grows slower than that grows less than e-fold.
    ///
    /// Assumed, and for the late lags checked by [`Stability::tail_error`]: coefficients tend to
    /// smooth functions of 1/n once the waves have passed, as those of an elastic plane do.
    /// Structures coupled to the elements are not part of the assessment.
    ///
    /// ```
    /// use basemat::bem::full_plane::{
    ///     BoundaryCondition, ConvolutionQuadrature, CqMethod, Segment, Stability,
    /// };
    /// use basemat::{Error, Soil};
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
    /// assert!(matches!(assess(0.1)?.require_bounded(), Err(Error::Unstable { .. })));
    /// # Ok::<(), Error>(())
    /// ```
    ///
    /// # Errors
    /// [`Error::Size`] unless there is one condition per element, [`Error::Input`] for a growth
    /// not between 1e-7 and 1/2, [`Error::Singular`] if the operator of the first lag is, and
    /// errors of the kernel.
    pub fn assess(
        kernel: &dyn BoundaryKernel,
        conditions: &[BoundaryCondition],
        smallest_growth: f64,
    ) -> Result<Self> {
        check_growth(smallest_growth)?;
        Self::of(&Symbol::new(kernel, conditions)?, smallest_growth)
    }

    /// As [`Stability::assess`], of a symbol that is there.
    pub(super) fn of(symbol: &Symbol, smallest_growth: f64) -> Result<Self> {
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

    /// Whether nothing grows faster than [`Stability::smallest_growth`].
    pub fn is_bounded(&self) -> bool {
        self.growing_modes == 0
    }

    /// Nothing if the march is bounded.
    ///
    /// # Errors
    /// [`Error::Unstable`] if perturbations grow.
    pub fn require_bounded(&self) -> Result<()> {
        if self.is_bounded() {
            Ok(())
        } else {
            Err(Error::Unstable {
                growth_per_step: self.growth_per_step,
                growing_modes: self.growing_modes,
            })
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
