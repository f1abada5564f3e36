//! Store of tables computed from convolution weights, which all histories of these weights share.

use std::any::{Any, TypeId};
use std::sync::{Arc, Mutex, MutexGuard, OnceLock, PoisonError};

use crate::geometry::ContactElement;

/// Store of spectra and exponentials that all histories of the same weights share.
///
/// All clones refer to one store. A [`ConvolutionWeights`](crate::history::ConvolutionWeights) contains the store with
/// its coefficients and returns it from [`spectra`](crate::history::ConvolutionWeights::spectra).
#[derive(Clone, Default)]
pub struct SharedSpectra {
    stores: Arc<Stores>,
}

#[derive(Default)]
struct Stores {
    /// Elements of the weights; the first history sets them.
    elements: OnceLock<Vec<ContactElement>>,
    /// One store for each type of table.
    tables: Mutex<Vec<(TypeId, Arc<dyn Any + Send + Sync>)>>,
}

/// Tables of one type, in a store.
pub(super) type Shared<T> = Arc<Mutex<T>>;

/// Locks tables; other threads wait while one thread computes.
///
/// A lock that was poisoned by a panic is usable, because every table is complete or absent.
pub(super) fn lock<T: ?Sized>(tables: &Mutex<T>) -> MutexGuard<'_, T> {
    tables.lock().unwrap_or_else(PoisonError::into_inner)
}

impl SharedSpectra {
    /// Whether the store belongs to these elements.
    ///
    /// If the store is empty, this call assigns it to these elements.
    pub(super) fn belong_to(&self, elements: &[ContactElement]) -> bool {
        self.stores.elements.get_or_init(|| elements.to_vec()) == elements
    }

    /// Returns the tables of type `T`, empty at first.
    pub(super) fn tables<T: Default + Send + 'static>(&self) -> Shared<T> {
        let mut tables = lock(&self.stores.tables);
        let stored = tables.iter().find(|(id, _)| *id == TypeId::of::<T>());
        if let Some(stored) = stored.and_then(|(_, table)| Arc::clone(table).downcast().ok()) {
            return stored;
        }
        let new_tables = Shared::<T>::default();
        tables.push((TypeId::of::<T>(), new_tables.clone()));
        new_tables
    }
}

short_debug! { SharedSpectra; self; }
