//! Spectra of a kernel's coefficients, shared by its histories and made by the first that needs
//! them.

use std::fmt;
use std::sync::{Arc, Mutex, MutexGuard, OnceLock, PoisonError};

use super::level::Level;
use super::tables::Tables;
use super::wave_level::{Near, WaveLevel};
use crate::geometry::ContactElement;
use crate::history::exponentials::tail::Fit;

/// Levels of blocks, from the smallest on, for leaves of one length.
pub(crate) struct Levels<L, N> {
    pub(super) levels: Vec<Arc<L>>,
    /// Coefficients of a leaf.
    pub(super) near: Option<Arc<N>>,
}

impl<L, N> Default for Levels<L, N> {
    fn default() -> Self {
        Self { levels: Vec::new(), near: None }
    }
}

/// Spectra of a kernel's coefficients, and exponentials for its late lags, for all histories of this
/// kernel and of its clones.
///
/// Clones are one and the same store. A [`ConvolutionWeights`](crate::history::ConvolutionWeights) keeps one beside
/// its coefficients and shows it in [`spectra`](crate::history::ConvolutionWeights::spectra).
#[derive(Clone, Default)]
pub struct SharedSpectra {
    stores: Arc<Stores>,
}

/// Levels of the usual leaves, by pairs and by wavenumbers.
#[derive(Default)]
struct Stores {
    /// Whose they are: set by the first history.
    elements: OnceLock<Vec<ContactElement>>,
    pairs: Mutex<Levels<Level, Tables>>,
    waves: Mutex<Levels<WaveLevel, Near>>,
    tails: Mutex<Vec<Windowed>>,
}

/// Tail behind a window, and the spectra of the window alone.
#[derive(Clone)]
pub(crate) struct Windowed {
    pub(crate) fit: Arc<Fit>,
    pub(crate) spectra: SharedSpectra,
}

/// Others wait while one makes what it lacks. A panic leaves levels complete or not there at all.
fn lock<T>(made: &Mutex<T>) -> MutexGuard<'_, T> {
    made.lock().unwrap_or_else(PoisonError::into_inner)
}

impl SharedSpectra {
    /// Whether these are spectra of this patch, or can become so.
    pub(crate) fn are_of(&self, elements: &[ContactElement]) -> bool {
        self.stores.elements.get_or_init(|| elements.to_vec()) == elements
    }

    pub(super) fn pairs(&self) -> MutexGuard<'_, Levels<Level, Tables>> {
        lock(&self.stores.pairs)
    }

    pub(super) fn waves(&self) -> MutexGuard<'_, Levels<WaveLevel, Near>> {
        lock(&self.stores.waves)
    }

    /// The tails made so far.
    pub(crate) fn tails(&self) -> MutexGuard<'_, Vec<Windowed>> {
        lock(&self.stores.tails)
    }

    /// Keeps a tail, unless another thread was first: then that one's is taken. Windows of one
    /// length share their spectra.
    pub(crate) fn keep(&self, fit: Arc<Fit>) -> Windowed {
        let mut tails = self.tails();
        if let Some(known) = tails.iter().find(|known| known.fit.request == fit.request) {
            return known.clone();
        }
        let same = tails.iter().find(|known| known.fit.request.lags == fit.request.lags);
        let spectra = same.map_or_else(Self::default, |known| known.spectra.clone());
        let new = Windowed { fit, spectra };
        tails.push(new.clone());
        new
    }
}

impl fmt::Debug for SharedSpectra {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("SharedSpectra").finish_non_exhaustive()
    }
}
