//! What histories of one patch share: spectra of its coefficients, made by the first that needs
//! them.

use std::fmt;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

use super::level::Level;
use super::wave_level::WaveLevel;
use super::waves::Near;

/// Levels of blocks, from the smallest on, for leaves of one length.
pub(crate) struct Levels<L> {
    pub(super) levels: Vec<Arc<L>>,
    pub(super) near: Option<Arc<Near>>,
}

impl<L> Default for Levels<L> {
    fn default() -> Self {
        Self { levels: Vec::new(), near: None }
    }
}

/// Levels of the usual leaves, by pairs and by wavenumbers.
#[derive(Default)]
pub(crate) struct Shelf {
    pairs: Mutex<Levels<Level>>,
    waves: Mutex<Levels<WaveLevel>>,
}

/// Others wait while one makes what it lacks. A panic leaves levels complete or not there at all.
fn lock<L>(levels: &Mutex<Levels<L>>) -> MutexGuard<'_, Levels<L>> {
    levels.lock().unwrap_or_else(PoisonError::into_inner)
}

impl Shelf {
    pub(super) fn pairs(&self) -> MutexGuard<'_, Levels<Level>> {
        lock(&self.pairs)
    }

    pub(super) fn waves(&self) -> MutexGuard<'_, Levels<WaveLevel>> {
        lock(&self.waves)
    }
}

impl fmt::Debug for Shelf {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Shelf").finish_non_exhaustive()
    }
}
