//! Stability of a boundary equation in time: growth factors and passivity, before the run.
//!
//! The degrees of freedom x are displacements of traction-free elements, and tractions of elements with
//! prescribed displacement. The equation Σ F^{N−m} xᵐ = known has the symbol F(ζ) = Σ Fⁿ ζⁿ, with columns of
//! H and −G. Perturbations grow if and only if det F has a zero in |ζ| < 1. The smallest zero gives the
//! growth factor 1/|ζ| per step. Zeros are counted by the argument principle on circles (F has no poles
//! there, since its coefficients do not grow), and the smallest modulus is found by bisection.

use std::fmt;

use super::convolution::BoundaryHistory;
use super::stability_symbol::Symbol;
use super::stability_zeros::{passivity, smallest_zero};
use super::{Boundary, BoundaryCondition, BoundaryKernel};
use crate::error::{Error, GroundError, Result, require, same_length};
use crate::geometry::{ContactLayout, PLANE};
use crate::linalg::{DenseFactor, dense_multiply_add, largest};

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
    /// assert!(matches!(assess(0.1)?.require_bounded(), Err(GroundError::Unstable { .. })));
    /// # Ok::<(), Error>(())
    /// ```
    ///
    /// # Errors
    /// [`Error::Size`] unless there is one condition per element, [`Error::Input`] for a growth outside 1e-7
    /// to 1/2, [`Error::Singular`] if the operator of the first lag is singular, and errors of the kernel.
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

// Stability of a full-plane ground, assessed before the run.

/// Stability of a boundary in the two limit states of its contact: all open, and all bonded.
///
/// A partly open base, and the structure on it, are not assessed. A structure stabilises the elements in
/// contact with it.
#[derive(Debug, Clone, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(deny_unknown_fields))]
#[non_exhaustive]
pub struct GroundStability {
    /// All elements free of traction, as under an uplifted base.
    pub uplifted: Stability,
    /// State with prescribed displacements of the contact elements, as under a base that sticks.
    ///
    /// This state has the passivity figures.
    pub bonded: Stability,
}

impl GroundStability {
    /// Assesses `kernel` on `boundary` for growth beyond `smallest_growth` per step.
    pub(super) fn assess(
        kernel: &dyn BoundaryKernel,
        boundary: &Boundary,
        smallest_growth: f64,
    ) -> Result<Self> {
        let mut conditions = vec![BoundaryCondition::TractionFree; boundary.segments().len()];
        let mut symbol = Symbol::new(kernel, &conditions)?;
        let uplifted = Stability::from_symbol(&symbol, smallest_growth)?;
        for &element in boundary.contact() {
            conditions[element] = BoundaryCondition::PrescribedDisplacement;
        }
        symbol.prescribe(&conditions)?;
        let bonded = Stability::from_symbol(&symbol, smallest_growth)?;
        Ok(Self { uplifted, bonded })
    }

    /// The state that grows faster; the uplifted state if neither grows.
    pub fn worst(&self) -> &Stability {
        if self.bonded.growth_per_step > self.uplifted.growth_per_step {
            &self.bonded
        } else {
            &self.uplifted
        }
    }

    /// Whether neither state grows faster than the smallest growth searched for.
    pub fn is_bounded(&self) -> bool {
        self.uplifted.is_bounded() && self.bonded.is_bounded()
    }

    /// Returns `Ok` if no perturbation grows in either state.
    ///
    /// # Errors
    /// [`GroundError::Unstable`](crate::bem::GroundError::Unstable) with the faster growth.
    pub fn require_bounded(&self) -> Result<()> {
        self.worst().require_bounded()
    }
}

impl fmt::Display for GroundStability {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "uplifted: {}\nbonded: {}", self.uplifted, self.bonded)
    }
}

// Boundary-value problems in time: tractions or displacements prescribed on any polygon.

/// Quantity that is prescribed for a component of an element.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Given {
    /// The traction, Pa: constant over the step.
    Traction,
    /// The displacement, m.
    Displacement,
}

/// Solves a boundary equation in time with prescribed tractions or displacements.
///
/// Vectors have 2E entries, x-components first, then z (down), as in [the module](super).
///
/// ```
/// use basemat::Soil;
/// use basemat::bem::full_plane::{BoundaryMarch, Given, Segment, TimeKernel};
/// // A single free element pushed down: before waves reach its ends, as on a half-plane.
/// let soil = Soil::new(80.0e6, 0.25, 2000.0)?;
/// let element = Segment { from: [-0.5, 0.0], to: [0.5, 0.0] };
/// let kernel = TimeKernel::new(soil, &[element], 1.0e-4)?;
/// let mut march = BoundaryMarch::new(Box::new(kernel), &[Given::Traction; 2])?;
/// march.step(&[0.0, 1.0e3])?;
/// let plane_wave = 1.0e3 * 1.0e-4 / (2000.0 * soil.pressure_wave_speed());
/// assert!((march.displacement()[1] / plane_wave - 1.0).abs() < 1e-12);
/// # Ok::<(), basemat::Error>(())
/// ```
pub struct BoundaryMarch {
    history: BoundaryHistory,
    given: Vec<Given>,
    /// Columns of H⁰ for unknown displacements, and of −G⁰ for unknown tractions, which are in `unit`.
    factor: DenseFactor,
    /// Columns of G⁰ for prescribed tractions, and of −H⁰ for prescribed displacements.
    known: Vec<f64>,
    /// Pa per m.
    unit: f64,
    rhs: Vec<f64>,
    displacement: Vec<f64>,
    traction: Vec<f64>,
}

short_debug! { BoundaryMarch; self; components: self.given.len() }

impl BoundaryMarch {
    /// Boundary at rest; `given` has 2E entries.
    ///
    /// # Errors
    /// [`Error::Size`] for the wrong number of entries, [`Error::Singular`] if the boundary values do not
    /// determine the others, and errors of the kernel.
    pub fn new(kernel: Box<dyn BoundaryKernel>, given: &[Given]) -> Result<Self> {
        let size = ContactLayout::new(PLANE, kernel.segments().len()).len();
        same_length("list of given components", given.len(), size)?;
        let (mut g, mut h) = (vec![0.0; size * size], vec![0.0; size * size]);
        kernel.coefficients(0, &mut g, &mut h)?;
        let unit = 1.0 / largest(&g).max(f64::MIN_POSITIVE);
        let (mut matrix, mut known) = (vec![0.0; size * size], vec![0.0; size * size]);
        for (k, (g, h)) in g.iter().zip(&h).enumerate() {
            match given[k % size] {
                Given::Traction => (matrix[k], known[k]) = (*h, *g),
                Given::Displacement => (matrix[k], known[k]) = (-g * unit, -h),
            }
        }
        let mut factor = DenseFactor::with_capacity(size);
        if !factor.factor(&matrix, size) {
            return Err(Error::Singular { matrix: "boundary operator", order: size });
        }
        Ok(Self {
            history: BoundaryHistory::new(kernel, &vec![true; size]),
            given: given.to_vec(),
            factor,
            known,
            unit,
            rhs: vec![0.0; size],
            displacement: vec![0.0; size],
            traction: vec![0.0; size],
        })
    }

    /// Allocates for about `steps` further steps.
    ///
    /// # Errors
    /// The errors of the kernel.
    pub fn prepare(&mut self, steps: usize) -> Result<()> {
        self.history.prepare(steps)
    }

    /// Makes one step with the given values: tractions during the step, displacements at its end.
    ///
    /// # Errors
    /// [`Error::Size`] for the wrong number of values, and errors of the kernel.
    pub fn step(&mut self, values: &[f64]) -> Result<()> {
        same_length("boundary values", values.len(), self.given.len())?;
        self.history.evaluate(&mut self.rhs)?;
        dense_multiply_add(&self.known, 1.0, values, &mut self.rhs);
        self.factor.solve(&mut self.rhs);
        for (k, (given, found)) in self.given.iter().zip(&self.rhs).enumerate() {
            (self.displacement[k], self.traction[k]) = match given {
                Given::Traction => (*found, values[k]),
                Given::Displacement => (values[k], *found * self.unit),
            };
        }
        self.history.push(&self.displacement, &self.traction);
        Ok(())
    }

    /// Number of steps done.
    pub fn steps(&self) -> usize {
        self.history.steps()
    }

    /// Displacements (2E, m) at the end of the last step.
    pub fn displacement(&self) -> &[f64] {
        &self.displacement
    }

    /// Tractions (2E, Pa) during the last step.
    pub fn traction(&self) -> &[f64] {
        &self.traction
    }
}
