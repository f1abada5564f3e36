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
//! # Passivity is not proved
//!
//! The soil of this method is not passive in general: the table below shows where it creates energy. The method is for
//! boundaries that are not flat, such as hills and valleys. For walls below a flat surface, the weights around a trench
#![cfg_attr(feature = "embedded", doc = "([`TrenchGround`](crate::bem::embedded::TrenchGround))")]
//! are passive at every time step and mesh, by proof.
//!
//! # Growth of perturbations
//!
//! In time, the equation is not stable for every step. [`Stability`] assesses it before the run. The table
//! shows the growth per step of the fastest perturbation of twenty elements of a flat surface, ν = 1/3, all
//! free of traction or all bonded (displacement prescribed), over β = c₁Δt/l. The passivity figure is the smallest
//! eigenvalue of the work of all histories, relative to the largest magnitude; it is 0 or more for a passive soil
//! (`cargo study paper-scheme --stability`):
//!
//! | | β = 0.1 | 0.25 | 0.5 | 1 | 2 | 5 |
//! |---|---|---|---|---|---|---|
//! | [`TimeKernel`], free | 1.0e-2 | 2.9e-2 | 6.8e-2 | 1.0e-1 | none | none |
//! | bonded | 5.2e-2 | 1.1e-1 | 2.3e-2 | none | none | none |
//! | passivity | −0.42 | −0.38 | −0.38 | −1.0 | −0.40 | −0.032 |
//! | [`ConvolutionQuadrature`], BDF2, free | 7.2e-3 | 8.3e-3 | none | none | none | none |
//! | bonded | 3.4e-2 | none | none | none | none | none |
//! | passivity | −0.45 | −1.0 | −1.1e-3 | −1.6e-3 | −1.8e-3 | −1.8e-3 |
//! | BDF1, free and bonded | none | none | none | none | none | none |
//! | passivity | −2.0e-2 | −2.3e-3 | −2.5e-3 | −2.4e-3 | −2.2e-3 | −1.8e-3 |
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
//! and 80 elements beside a strip of 8 elements, its error is 0.32, 0.23 and 0.13. The error is about proportional to
//! the inverse square root of the surface's length, because surface waves do not decay along the surface. With
//! convolution quadrature such long surfaces are possible.

mod bessel;
mod block;
mod boundary;
mod boundary_march;
mod convolution;
mod convolution_quadrature;
mod cq_method;
mod ground;
mod ground_state;
mod incident_field;
mod laplace;
mod laplace_element;
mod late_weights;
mod pair_classes;
mod segment;
mod smooth_integrals;
mod stability;
mod stability_symbol;
mod stability_tail;
mod stability_zeros;
mod static_limit;
mod step_integrals;
mod time_kernel;

pub use boundary::Boundary;
pub use boundary_march::{BoundaryMarch, Given};
pub use convolution_quadrature::ConvolutionQuadrature;
pub use cq_method::CqMethod;
pub use ground::FullPlaneGround;
pub use incident_field::{IncidentField, VerticalWaves};
pub use segment::Segment;
pub use stability::Stability;
pub use time_kernel::TimeKernel;

use crate::error::Result;

/// Coefficients G^n and H^n of a boundary equation in time.
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

    /// Overwrites `g` and `h` with the power series Σ Gⁿζⁿ and Σ Hⁿζⁿ at `zeta`.
    ///
    /// `g` and `h` are 2E × 2E complex numbers each, row-major, real and imaginary part alternating; |ζ| ≤ 1
    /// and ζ ≠ 1. If the series are transforms at some s, the method returns this s (1/s, real and imaginary part).
    /// Otherwise it returns `None`, as the default does.
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
    /// The traction is prescribed (zero on a free surface); the displacement is computed.
    TractionFree,
    /// The displacement is prescribed (bonded contact); the traction is computed.
    PrescribedDisplacement,
}
