//! The full-plane boundary element method of Patel & Spyrakos: boundaries of any polygonal shape.
//!
//! # Boundary equation
//!
//! Collocation at the midpoints of E straight elements, with values constant over each element, gives for
//! step N
//!
//! ```text
//! Σ_{m≤N} H^{N−m} u^m = Σ_{m≤N} G^{N−m} t^m ,   H⁰ with the free term ½ on its diagonal,
//! ```
//!
//! with displacements u and tractions t on the soil. Vectors have 2E entries: first the E x-components (to
//! the right), then the E z-components (**down**). A [`BoundaryKernel`] computes G and H from the fundamental
//! solution, in time or by convolution quadrature.
//!
//! # Growth of perturbations
//!
//! In time, the equation is not stable for every step. [`Stability`] assesses it before the run. The table
//! shows the growth per step of the fastest perturbation of twenty elements of a flat surface, ν = 1/3, all
//! free of traction or all bonded (displacement prescribed), and the passivity figure (0 or more: passive),
//! over β = c₁Δt/l:
//!
//! | | β = 0.1 | 0.25 | 0.5 | 1 | 2 | 5 |
//! |---|---|---|---|---|---|---|
//! | [`TimeKernel`], free | 1.0e-2 | 2.9e-2 | 6.8e-2 | 1.0e-1 | none | none |
//! | bonded | 5.2e-2 | 1.1e-1 | 2.3e-2 | none | none | none |
//! | passivity | −0.46 | −0.58 | −0.40 | −1.0 | −0.41 | −0.035 |
//! | [`ConvolutionQuadrature`], BDF2, free | 7.2e-3 | 8.3e-3 | none | none | none | none |
//! | bonded | 3.4e-2 | none | none | none | none | none |
//! | passivity | −0.47 | −1.0 | −1.1e-3 | −1.6e-3 | −1.8e-3 | −1.8e-3 |
//! | BDF1, free and bonded | none | none | none | none | none | none |
//! | passivity | −2.4e-2 | −2.3e-3 | −2.5e-3 | −2.4e-3 | −2.2e-3 | −1.8e-3 |
//!
//! β alone does not decide stability. Ten elements with five free ones on either side, time kernel, uplifted
//! (growth of the bonded base in brackets):
//!
//! | β | ν = 0 | ν = 1/4 | ν = 1/3 |
//! |---|---|---|---|
//! | 0.5 | none | 4.0e-2 (1.4e-2) | 6.8e-2 (1.4e-2) |
//! | 1 | none | none | 1.0e-1 |
//! | 2 | 1.0e-1 | 4.6e-2 | none |
//! | 5 | 1.7e-2 | none | none |
//!
//! A longer surface may grow where a shorter one does not. Six free elements are bounded with BDF2 at β = 0.1
//! and with the time kernel at β = 1/2; twenty are not. At ν = 1/4 and β = 1, the ten elements of this table
//! grow by 0.02 per step with twenty free elements on either side. A narrow trench with square corners grows
//! with the time kernel for every β from 0.25 to 5, and with convolution quadrature for none of them.
//!
//! # Error of the truncated surface
//!
//! The direct impedances of a strip have the error of its mesh, with or without free elements.
//! The coupling of sliding and rocking comes only from the free surface and from H. With 5, 20
//! and 80 elements beside a strip of 8 elements, its error is 0.32, 0.23 and 0.13. The error falls with about the
//! root of the surface's length, because surface waves do not decay along it. Convolution quadrature
//! permits so long a surface.

mod block;
mod boundary;
mod convolution;
mod convolution_quadrature;
mod ground;
mod laplace;
mod laplace_element;
mod stability;
mod stability_symbol;
mod stability_zeros;
mod step_integrals;
mod time_kernel;

pub use boundary::{Boundary, Segment};
pub use convolution_quadrature::ConvolutionQuadrature;
pub use ground::FullPlaneGround;
pub use laplace_element::CqMethod;
pub use stability::{BoundaryMarch, Given, GroundStability, Stability};
pub use time_kernel::TimeKernel;

use crate::error::{Result, not_negative};
use crate::motion::FreeField;
use crate::soil::Soil;

/// The coefficients G^n and H^n of a boundary equation in time.
#[auto_impl::auto_impl(Box)]
pub trait BoundaryKernel: Send + Sync {
    /// The elements.
    fn segments(&self) -> &[Segment];

    /// Overwrites `g` and `h` with the coefficients of `lag` (each 2E × 2E, row-major: m/Pa, and pure
    /// numbers).
    ///
    /// The coefficients are the response at the end of a step to values that were constant during an earlier
    /// step, which ended `lag` steps before. `h` of lag 0 includes the free term ½.
    ///
    /// # Errors
    /// [`crate::Error::Size`] for slices of the wrong length.
    fn coefficients(&self, lag: usize, g: &mut [f64], h: &mut [f64]) -> Result<()>;

    /// Overwrites `g` and `h` with the power series Σ Gⁿζⁿ and Σ Hⁿζⁿ at `zeta`, if they are known.
    ///
    /// `g` and `h` are 2E × 2E complex numbers each, row-major, real and imaginary part alternating; |ζ| ≤ 1
    /// and ζ ≠ 1. The series must be known as transforms at some s; the method then returns this s (1/s, real
    /// and imaginary part). The default returns `None`.
    ///
    /// # Errors
    /// [`crate::Error::Size`] for slices of the wrong length.
    fn symbol(&self, _zeta: [f64; 2], _g: &mut [f64], _h: &mut [f64]) -> Result<Option<[f64; 2]>> {
        Ok(None)
    }
}

/// Boundary condition of an element: the prescribed quantity.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum BoundaryCondition {
    /// The traction is known (zero on a free surface); the displacement is computed.
    TractionFree,
    /// The displacement is known (contact that sticks); the traction is computed.
    PrescribedDisplacement,
}

// Waves from below, at depth.

/// Motion and stress of the half-plane without trench, canyon or foundation, at any depth.
///
/// Components are (x, z) with **z down**; the flat surface z = 0 is free of traction.
#[auto_impl::auto_impl(Box)]
pub trait IncidentField: Send {
    /// Displacement `[x, z]` (m) at the point (x, z), m, and `time`, s; zero at and before t = 0.
    fn displacement(&self, point: [f64; 2], time: f64) -> [f64; 2];

    /// Stress `[xx, zz, xz]` at the same point and time, Pa, tension positive.
    fn stress(&self, point: [f64; 2], time: f64) -> [f64; 3];
}

/// Vertically incident S and P waves and their reflections from the flat surface.
///
/// They follow from the motion s of the surface: u(z,t) = ½[s(t−t₀+z/c) + s(t−t₀−z/c)], with c = c₂ for the
/// horizontal and c₁ for the vertical component. The surface moves t₀ later than its record, so that down to
/// the depth c₂t₀ nothing moves at t = 0.
///
/// ```
/// use basemat::Soil;
/// use basemat::bem::full_plane::{IncidentField, VerticalWaves};
/// use basemat::motion::RickerDisplacement;
/// let soil = Soil::new(80.0e6, 0.25, 2000.0)?;
/// let pulse = RickerDisplacement::new(0.1, 0.2, 1.0)?;
/// // At a depth of 20 m the wave arrives 0.1 s before it reaches the surface.
/// let waves = VerticalWaves::new(soil, pulse, 20.0)?;
/// let surface = waves.displacement([3.0, 0.0], 1.1);
/// assert!((surface[0] - 0.1).abs() < 1e-8);
/// assert_eq!(waves.stress([3.0, 0.0], 1.1), [0.0; 3]);
/// # Ok::<(), basemat::Error>(())
/// ```
pub struct VerticalWaves {
    soil: Soil,
    surface: Box<dyn FreeField>,
    delay: f64,
}

short_debug! { VerticalWaves; self; soil: self.soil, delay: self.delay }

impl VerticalWaves {
    /// Waves whose `surface` motion (at x = 0) is given, for points down to `depth` (m).
    ///
    /// # Errors
    /// [`crate::Error::Input`] unless the depth is finite and not below zero.
    pub fn new(soil: Soil, surface: impl FreeField + 'static, depth: f64) -> Result<Self> {
        let delay = not_negative("depth of the incident waves", depth)? / soil.shear_wave_speed();
        Ok(Self { soil, surface: Box::new(surface), delay })
    }

    /// Delay of the surface relative to its record, s.
    pub fn delay(&self) -> f64 {
        self.delay
    }

    fn speeds(&self) -> [f64; 2] {
        [self.soil.shear_wave_speed(), self.soil.pressure_wave_speed()]
    }
}

impl IncidentField for VerticalWaves {
    fn displacement(&self, point: [f64; 2], time: f64) -> [f64; 2] {
        let now = time - self.delay;
        let at = |k: usize| {
            let lag = point[1] / self.speeds()[k];
            let s = |t: f64| self.surface.displacement(0.0, t)[k];
            0.5 * (s(now + lag) + s(now - lag))
        };
        // The record is positive up, z is positive down.
        [at(0), -at(1)]
    }

    fn stress(&self, point: [f64; 2], time: f64) -> [f64; 3] {
        let now = time - self.delay;
        let slope = |k: usize| {
            let c = self.speeds()[k];
            let lag = point[1] / c;
            let v = |t: f64| self.surface.velocity(0.0, t)[k];
            0.5 * (v(now + lag) - v(now - lag)) / c
        };
        let (mu, nu) = (self.soil.shear_modulus(), self.soil.poisson());
        let lame = 2.0 * mu * nu / (1.0 - 2.0 * nu);
        let strain = -slope(1);
        [lame * strain, (lame + 2.0 * mu) * strain, mu * slope(0)]
    }
}
