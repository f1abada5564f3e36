//! Sources of step coefficients, of which grounds are made.

use std::any::Any;
use std::sync::Arc;

use crate::error::Result;
use crate::geometry::ContactElement;
use crate::history::LagKernel;

/// A soil that knows its step coefficients and its static compliance: all that
/// [`KernelGround`](super::KernelGround) needs.
pub trait KernelSource: Any + Send {
    /// The coefficients under `elements` (left to right, not overlapping) for steps of `time_step`
    /// seconds. They should be computed when they are asked for, not now: other grounds may be
    /// waiting for the same kernel.
    ///
    /// # Errors
    /// If the soil has none for these elements or this step.
    fn kernel(&self, elements: &[ContactElement], time_step: f64) -> Result<Arc<dyn LagKernel>>;

    /// Overwrites `matrix` (2Q × 2Q, row-major, m/Pa; 2Q numbers as in [`crate::bem`]) with the
    /// mean static displacements of the elements due to unit tractions, up to a rigid settlement.
    ///
    /// # Errors
    /// If the slice has the wrong length.
    fn static_compliance(&self, elements: &[ContactElement], matrix: &mut [f64]) -> Result<()>;

    /// Speed of shear waves near the surface, m/s, as [`Ground::shear_wave_speed`](super::Ground::shear_wave_speed).
    fn shear_wave_speed(&self) -> Option<f64> {
        None
    }

    /// Numbers that say which soil of its type it is, so that equal ones can share kernels
    /// ([`SharedKernels`](super::SharedKernels)): equal numbers must mean equal bits of all
    /// coefficients. `None` (the default) if kernels are not to be shared.
    fn identity(&self) -> Option<Vec<f64>> {
        None
    }
}
