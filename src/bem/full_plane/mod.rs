//! The full-plane boundary element method of Patel & Spyrakos: boundaries of any polygonal shape.
//!
//! # Boundary equation
//!
//! Collocation at the midpoints of E straight elements, values constant over each, gives for the
//! step N
//!
//! ```text
//! Σ_{m≤N} H^{N−m} u^m = Σ_{m≤N} G^{N−m} t^m ,   H⁰ with the free term ½ on its diagonal,
//! ```
//!
//! with displacements u and tractions t on the soil. Vectors have 2E entries: first the E
//! x-components (to the right), then the E z-components (**down**). What makes G and H out of the
//! fundamental solution, in time or by convolution quadrature, is a [`BoundaryKernel`].
//!
//! # What may grow
//!
//! Marched in time, this formulation is not stable for every step, and which steps are does not
//! follow from β = c₁Δt/l alone: Poisson's ratio, the number of traction-free elements and the
//! shape of the boundary matter. Ten elements under pressures for five steps, 800 steps, growth per
//! step with 5 (20) traction-free elements on either side:
//!
//! | β | ν = 0 | ν = 1/4 | ν = 1/3 |
//! |---|---|---|---|
//! | 0.5 | none (1.005) | 1.04 (1.06) | 1.07 (1.08) |
//! | 1 | none (1.03) | none (1.02) | 1.10 (1.12) |
//! | 2 | 1.10 (1.20) | 1.05 (1.12) | none (1.09) |
//! | 5 | 1.02 (1.45) | none (1.23) | none (1.27) |
//!
//! A structure bonded to the elements steadies them; a longer free surface unsettles them, and is
//! not needed: errors hardly change from five elements on either side. Narrow trenches with square
//! corners were unstable for all steps tried.

mod block;
mod boundary;
mod convolution;
mod convolution_quadrature;
mod ground;
mod ground_stability;
mod incident;
mod laplace;
mod laplace_bessel;
mod laplace_element;
mod laplace_late;
mod march;
mod pairs;
mod segment;
mod smooth_integrals;
mod stability;
mod stability_passivity;
mod stability_symbol;
mod stability_zeros;
mod static_limit;
mod step_integrals;
mod time_kernel;

pub use boundary::Boundary;
pub use convolution_quadrature::{ConvolutionQuadrature, CqMethod};
pub use ground::FullPlaneGround;
pub use ground_stability::GroundStability;
pub use incident::{IncidentField, VerticalWaves};
pub use march::{BoundaryMarch, Given};
pub use segment::Segment;
pub use stability::{BoundaryCondition, Stability};
pub use time_kernel::TimeKernel;

use crate::error::Result;

/// The coefficients G^n and H^n of a boundary equation marched in time.
pub trait BoundaryKernel: Send + Sync {
    /// The elements.
    fn segments(&self) -> &[Segment];

    /// Overwrites `g` and `h` (each 2E × 2E, row-major: m/Pa, and pure numbers) with the
    /// coefficients of `lag`: the answer at the end of a step to values held during the step that
    /// ended `lag` steps before. `h` of lag 0 includes the free term ½.
    ///
    /// # Errors
    /// For slices of the wrong length.
    fn coefficients(&self, lag: usize, g: &mut [f64], h: &mut [f64]) -> Result<()>;

    /// Overwrites `g` and `h` (each 2E × 2E complex numbers, row-major, real and imaginary part by
    /// turns) with the power series Σ Gⁿζⁿ and Σ Hⁿζⁿ at `zeta`, |ζ| ≤ 1 and ζ ≠ 1, if they are
    /// known as transforms at some s, and returns that s (1/s, real and imaginary part). The
    /// default knows none.
    ///
    /// # Errors
    /// For slices of the wrong length.
    fn symbol(&self, _zeta: [f64; 2], _g: &mut [f64], _h: &mut [f64]) -> Result<Option<[f64; 2]>> {
        Ok(None)
    }
}
