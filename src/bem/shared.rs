//! Coefficients that the grounds of many simulations share.

use std::any::{Any, TypeId};
use std::fmt;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

use super::kernel_source::KernelSource;
use crate::contact_element::ContactElement;
use crate::error::Result;
use crate::history::LagKernel;

/// Kernels kept, at most: the latest.
const KEPT: usize = 8;

/// Coefficients, and spectra made of them, that grounds of one soil, mesh and time step share.
///
/// Grounds with clones of one and the same store ([`HalfPlaneGround::with_shared_kernels`],
/// [`KernelGround::with_shared_kernels`](super::KernelGround::with_shared_kernels)) compute and hold
/// them once. The store keeps those of the last eight different soils, meshes and steps. Results are the
/// same to the last bit. What one soil is says [`KernelSource::identity`].
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
///     |_, result| assert_eq!(result, Ok(())),
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

/// A kernel and all that determines it.
struct Entry {
    source: TypeId,
    identity: Vec<f64>,
    time_step: f64,
    kernel: Arc<dyn LagKernel>,
}

impl fmt::Debug for Entry {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Entry")
            .field("identity", &self.identity)
            .field("time_step", &self.time_step)
            .finish_non_exhaustive()
    }
}

impl SharedKernels {
    /// Number of kernels held.
    pub fn len(&self) -> usize {
        self.entries().len()
    }

    /// Whether none is held.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    fn entries(&self) -> MutexGuard<'_, Vec<Entry>> {
        self.kernels.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// The kernel of these elements, made now if it is not there or `source` has no identity.
    pub(super) fn kernel(
        &self,
        source: &dyn KernelSource,
        elements: &[ContactElement],
        time_step: f64,
    ) -> Result<Arc<dyn LagKernel>> {
        let Some(identity) = source.identity() else { return source.kernel(elements, time_step) };
        let (any, mut kernels): (&dyn Any, _) = (source, self.entries());
        let same = |entry: &Entry| {
            entry.source == any.type_id()
                && entry.identity == identity
                && entry.time_step == time_step
                && entry.kernel.classes().elements() == elements
        };
        if let Some(place) = kernels.iter().position(same) {
            // The latest used is the last to go.
            let entry = kernels.remove(place);
            let kernel = Arc::clone(&entry.kernel);
            kernels.push(entry);
            return Ok(kernel);
        }
        let kernel = source.kernel(elements, time_step)?;
        if kernels.len() == KEPT {
            kernels.remove(0);
        }
        let (source, kept) = (any.type_id(), Arc::clone(&kernel));
        kernels.push(Entry { source, identity, time_step, kernel: kept });
        Ok(kernel)
    }
}
