//! Coefficients that the grounds of many simulations share.

use std::sync::{Arc, Mutex, PoisonError};

use super::{ContactElement, PatchKernel};
use crate::error::Result;
use crate::soil::Soil;

/// Kernels kept, at most: the latest.
const KEPT: usize = 8;

/// Coefficients, and spectra made of them, that half-planes of one soil, mesh and time step share.
///
/// Grounds with clones of one and the same store ([`HalfPlaneGround::with_shared_kernels`]) compute
/// and hold them once. The store keeps those of the last eight different soils, meshes and steps. Results are the
/// same to the last bit.
///
/// ```
/// use basemat::bem::{Ground, HalfPlaneGround, SharedKernels};
/// use basemat::{Error, Soil, Sweep};
/// let kernels = SharedKernels::default();
/// Sweep::new(3).run(
///     |case| {
///         let soil = Soil::new(80.0e6, 0.33, 1900.0)?;
///         let ground = HalfPlaneGround::strip(soil, -5.0..5.0, 10)?;
///         let mut ground = ground.with_shared_kernels(&kernels);
///         ground.prepare(2.0e-3)?;
///         ground.reserve(100 * case.index())
///     },
///     |_, result: Result<(), Error>| assert!(result.is_ok()),
/// );
/// assert_eq!(kernels.len(), 1);
/// # Ok::<(), Error>(())
/// ```
///
/// [`HalfPlaneGround::with_shared_kernels`]: super::HalfPlaneGround::with_shared_kernels
#[derive(Debug, Clone, Default)]
pub struct SharedKernels {
    kernels: Arc<Mutex<Vec<Entry>>>,
}

#[derive(Debug)]
struct Entry {
    soil: Soil,
    time_step: f64,
    kernel: Arc<PatchKernel>,
}

impl SharedKernels {
    /// Number of kernels held.
    pub fn len(&self) -> usize {
        self.kernels.lock().unwrap_or_else(PoisonError::into_inner).len()
    }

    /// Whether none is held.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// The kernel of these elements, made now if it is not there.
    pub(super) fn kernel(
        &self,
        soil: Soil,
        elements: &[ContactElement],
        time_step: f64,
    ) -> Result<Arc<PatchKernel>> {
        let mut kernels = self.kernels.lock().unwrap_or_else(PoisonError::into_inner);
        let same = |entry: &Entry| {
            entry.soil == soil
                && entry.time_step == time_step
                && entry.kernel.elements() == elements
        };
        if let Some(place) = kernels.iter().position(same) {
            // The latest used is the last to go.
            let entry = kernels.remove(place);
            let kernel = Arc::clone(&entry.kernel);
            kernels.push(entry);
            return Ok(kernel);
        }
        let kernel = Arc::new(PatchKernel::new(soil, elements.to_vec(), time_step)?);
        if kernels.len() == KEPT {
            kernels.remove(0);
        }
        kernels.push(Entry { soil, time_step, kernel: Arc::clone(&kernel) });
        Ok(kernel)
    }
}
