//! Blocks of lags: made once, by one thread at a time, and kept in a file.

use std::ops::Range;
use std::path::PathBuf;
use std::sync::{Mutex, MutexGuard, OnceLock, PoisonError, TryLockError};
use std::time::Duration;

use super::coefficients::{BLOCKS, Block, FIRST};
use super::file;
use crate::error::{Error, Result, Watch, same_length};

/// Between two looks whether another thread has ended.
const WAIT: Duration = Duration::from_millis(20);

/// Blocks of a kernel as far as they have been made.
#[derive(Debug)]
pub(crate) struct KeptBlocks {
    /// Fingerprint of what has passed the gate.
    checked: OnceLock<Result<u64>>,
    blocks: [OnceLock<Result<Block>>; BLOCKS],
    /// Held by the thread that computes.
    making: Mutex<()>,
    pub(crate) file: Option<PathBuf>,
    /// Numbers of classes and kinds.
    sizes: [usize; 2],
}

impl KeptBlocks {
    /// No blocks, of so many classes and kinds.
    pub(crate) fn new(sizes: [usize; 2], file: Option<PathBuf>) -> Self {
        let blocks = std::array::from_fn(|_| OnceLock::new());
        Self { checked: OnceLock::new(), blocks, making: Mutex::default(), file, sizes }
    }

    /// Block `number`, made now if it has not been.
    pub(crate) fn block(
        &self,
        number: usize,
        watch: &mut Watch,
        make: impl FnOnce(&mut Watch) -> Result<Block>,
    ) -> Result<&Block> {
        self.once(&self.blocks[number], watch, make)
    }

    /// Whether block `number` is there.
    pub(crate) fn has(&self, number: usize) -> bool {
        self.blocks[number].get().is_some()
    }

    /// Those of the blocks of `wanted` from the first on that is not there.
    pub(crate) fn missing(&self, wanted: Range<usize>) -> Range<usize> {
        wanted.start + wanted.clone().take_while(|number| self.has(*number)).count()..wanted.end
    }

    /// Whether the gate has been passed, or not.
    pub(crate) fn is_checked(&self) -> bool {
        self.checked.get().is_some()
    }

    /// Fingerprint by `check`, once; then the blocks of the file are in place.
    pub(crate) fn gate(
        &self,
        watch: &mut Watch,
        check: impl FnOnce(&mut Watch) -> Result<u64>,
    ) -> Result<u64> {
        let checked = self.once(&self.checked, watch, |watch| {
            let fingerprint = check(watch)?;
            if let Some(path) = &self.file {
                for (place, block) in
                    self.blocks.iter().zip(file::read(path, fingerprint, self.sizes)?)
                {
                    let _ = place.set(Ok(block));
                }
            }
            Ok(fingerprint)
        });
        checked.copied()
    }

    /// Writes all blocks to the file, if there is one.
    pub(crate) fn write(&self, fingerprint: u64) -> Result<()> {
        let Some(path) = &self.file else { return Ok(()) };
        let blocks = self.blocks.iter().map_while(|block| block.get()?.as_ref().ok());
        file::write(path, fingerprint, self.sizes[0], &blocks.collect::<Vec<_>>())
    }

    /// What is in `place`, made now if nothing is; what was stopped leaves nothing.
    pub(crate) fn once<'a, T>(
        &self,
        place: &'a OnceLock<Result<T>>,
        watch: &mut Watch,
        make: impl FnOnce(&mut Watch) -> Result<T>,
    ) -> Result<&'a T> {
        let found = |made: &'a Result<T>| made.as_ref().map_err(Clone::clone);
        if let Some(made) = place.get() {
            return found(made);
        }
        let _making = self.enter(watch)?;
        if let Some(made) = place.get() {
            return found(made);
        }
        match make(watch) {
            Err(stopped @ Error::Stopped(_)) => Err(stopped),
            made => found(place.get_or_init(|| made)),
        }
    }

    /// Waits until no other thread computes, with an open ear for the observer.
    fn enter(&self, watch: &mut Watch) -> Result<MutexGuard<'_, ()>> {
        while watch.is_observed() {
            match self.making.try_lock() {
                Ok(making) => return Ok(making),
                Err(TryLockError::Poisoned(poisoned)) => return Ok(poisoned.into_inner()),
                Err(TryLockError::WouldBlock) => {
                    watch.reach(0)?;
                    std::thread::sleep(WAIT);
                }
            }
        }
        Ok(self.making.lock().unwrap_or_else(PoisonError::into_inner))
    }
}

/// Overwrites `values`, one slice for each kind, with the lags of a class from `first_lag` on, out of `block`.
pub(crate) fn copy_lags<'a, const KINDS: usize>(
    class: usize,
    first_lag: usize,
    mut values: [&mut [f64]; KINDS],
    mut block: impl FnMut(usize) -> Result<&'a Block>,
) -> Result<()> {
    let lags = values[0].len();
    for others in &values[1..] {
        same_length("coefficients of a kind", others.len(), lags)?;
    }
    if first_lag == 0 {
        return Err(Error::Input { quantity: "lag", value: 0.0, needed: "at least 1" });
    }
    last_block(first_lag.saturating_add(lags))?;
    let mut done = 0;
    while done < lags {
        let (number, place) = Block::place(first_lag + done);
        let found = block(number)?.from::<KINDS>(class, place);
        let count = found[0].len().min(lags - done);
        for (values, found) in values.iter_mut().zip(found) {
            values[done..done + count].copy_from_slice(&found[..count]);
        }
        done += count;
    }
    Ok(())
}

/// Number of the block with lag `lag`.
pub(crate) fn last_block(lag: usize) -> Result<usize> {
    let most = FIRST << (BLOCKS - 1);
    if lag > most {
        return Err(Error::Input {
            quantity: "lag of a layered ground",
            value: lag as f64,
            needed: "at most 2147483648",
        });
    }
    Ok(Block::place(lag).0)
}

/// Threads for one block.
pub(crate) fn threads() -> usize {
    #[cfg(feature = "rayon")]
    return rayon::current_num_threads();
    #[cfg(not(feature = "rayon"))]
    1
}
