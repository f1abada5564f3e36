//! Convolution weights shared by the grounds of many simulations.

use std::any::{Any, TypeId};
use std::sync::{Arc, Condvar, Mutex, MutexGuard, PoisonError};
use std::thread::{self, ThreadId};

use super::WeightsSource;
use crate::error::{Error, Result};
use crate::geometry::ContactElement;
use crate::history::ConvolutionWeights;

/// Largest number of stored kernels, because more would fill the memory in long sweeps.
const MAX_STORED_KERNELS: usize = 8;

/// Store of weights and spectra for grounds of one soil, mesh and time step.
///
/// Grounds with clones of one store ([`ElasticGround::with_shared_kernels`],
/// [`WeightsGround::with_shared_kernels`](super::WeightsGround::with_shared_kernels)) compute and store them once. The
/// store keeps the eight combinations of soil, mesh and step used last. Results with and without it are bitwise
/// identical. [`WeightsSource::identity`] decides whether two soils are the same. A thread waits for weights that another
/// thread is computing. A source may request the weights of other sources from the same store during its computation.
/// Sources on several threads that request each other's weights end in a deadlock.
///
/// ```
/// use basemat::bem::{ElasticGround, Ground, SharedKernels, Strip};
/// use basemat::sweep::Sweep;
/// use basemat::{Error, Soil, unobserved};
/// let kernels = SharedKernels::default();
/// Sweep::new(3).run(
///     |case| {
///         let soil = Soil::new(80.0e6, 0.33, 1900.0)?;
///         let ground = ElasticGround::new(soil, Strip::graded(-5.0..5.0, 10)?)?;
///         let mut ground = ground.with_shared_kernels(&kernels);
///         ground.prepare(2.0e-3, Some(100 * case.index), &mut unobserved)
///     },
///     |_, result| assert_eq!(result, Ok(())),
/// );
/// assert_eq!(kernels.count(), 1);
/// # Ok::<(), Error>(())
/// ```
///
/// [`ElasticGround::with_shared_kernels`]: super::ElasticGround::with_shared_kernels
#[derive(Debug, Clone, Default)]
pub struct SharedKernels {
    store: Arc<Store>,
}

/// Table of kernels behind a lock, and the signal to waiting threads.
#[derive(Debug, Default)]
struct Store {
    table: Mutex<WeightsTable>,
    /// Signals waiting threads that a computation has ended, with a kernel or with an error.
    computation_ended: Condvar,
}

/// Stored kernels, and the kernels in computation.
#[derive(Debug, Default)]
struct WeightsTable {
    /// Stored kernels, the last used one at the end.
    entries: Vec<StoredWeights>,
    /// Kernels that are being computed, each with its thread.
    in_progress: Vec<(Arc<WeightsKey>, ThreadId)>,
}

/// Soil, time step and elements that determine a kernel.
#[derive(Debug, PartialEq)]
struct WeightsKey {
    source_type: TypeId,
    identity: Vec<f64>,
    time_step: f64,
    elements: Vec<ContactElement>,
}

/// A stored kernel.
struct StoredWeights {
    key: Arc<WeightsKey>,
    kernel: Arc<dyn ConvolutionWeights>,
}

short_debug! { StoredWeights; self; identity: self.key.identity, time_step: self.key.time_step }

impl WeightsTable {
    /// Thread that is computing the kernel of `key`.
    fn computing_thread(&self, key: &WeightsKey) -> Option<ThreadId> {
        self.in_progress
            .iter()
            .find(|(computed_key, _)| **computed_key == *key)
            .map(|(_, thread)| *thread)
    }
}

/// Kernel in computation; when the value is dropped, other threads no longer wait for the kernel.
struct KernelInProgress<'a> {
    shared_kernels: &'a SharedKernels,
    key: &'a Arc<WeightsKey>,
}

impl Drop for KernelInProgress<'_> {
    fn drop(&mut self) {
        self.shared_kernels
            .lock_table()
            .in_progress
            .retain(|(key, _)| !Arc::ptr_eq(key, self.key));
        self.shared_kernels.store.computation_ended.notify_all();
    }
}

impl SharedKernels {
    /// Number of kernels stored.
    pub fn count(&self) -> usize {
        self.lock_table().entries.len()
    }

    fn lock_table(&self) -> MutexGuard<'_, WeightsTable> {
        self.store.table.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Stored kernel of these elements, or else a new one, which is then stored.
    ///
    /// A kernel of a `source` without identity is not stored.
    pub(super) fn kernel(
        &self,
        source: &dyn WeightsSource,
        elements: &[ContactElement],
        time_step: f64,
    ) -> Result<Arc<dyn ConvolutionWeights>> {
        let Some(identity) = source.identity() else {
            return source.kernel(elements, time_step);
        };
        let source_as_any: &dyn Any = source;
        let key = Arc::new(WeightsKey {
            source_type: source_as_any.type_id(),
            identity,
            time_step,
            elements: elements.to_vec(),
        });
        if let Some(kernel) = self.stored_kernel_or_reserve(&key)? {
            return Ok(kernel);
        }
        // The store is not locked while the kernel is computed, because the source may request other kernels.
        let in_progress = KernelInProgress { shared_kernels: self, key: &key };
        let kernel = source.kernel(elements, time_step)?;
        let mut table = self.lock_table();
        if table.entries.len() == MAX_STORED_KERNELS {
            table.entries.remove(0);
        }
        table
            .entries
            .push(StoredWeights { key: Arc::clone(&key), kernel: Arc::clone(&kernel) });
        drop(table);
        drop(in_progress);
        Ok(kernel)
    }

    /// Returns the stored kernel, or reserves its computation.
    ///
    /// `None` means that the caller has to compute the kernel of `key`. While another thread is computing the kernel, the
    /// function waits.
    fn stored_kernel_or_reserve(
        &self,
        key: &Arc<WeightsKey>,
    ) -> Result<Option<Arc<dyn ConvolutionWeights>>> {
        let this_thread = thread::current().id();
        let mut table = self.lock_table();
        loop {
            if let Some(index) = table.entries.iter().position(|entry| entry.key == *key) {
                // The kernel used last moves to the end, because the first one is removed first.
                let entry = table.entries.remove(index);
                let kernel = Arc::clone(&entry.kernel);
                table.entries.push(entry);
                return Ok(Some(kernel));
            }
            let Some(computing_thread) = table.computing_thread(key) else {
                table.in_progress.push((Arc::clone(key), this_thread));
                return Ok(None);
            };
            if computing_thread == this_thread {
                return Err(Error::Scene {
                    quantity: "kernel source",
                    needed: "must not request the kernel that it is computing from the shared kernels",
                });
            }
            table =
                self.store.computation_ended.wait(table).unwrap_or_else(PoisonError::into_inner);
        }
    }
}
