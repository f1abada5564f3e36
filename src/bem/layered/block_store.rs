//! Blocks of lags: computed once, by one thread at a time, and stored in a file.
//!
//! A file has words of eight bytes, little-endian:
//!
//! | word | meaning |
//! |---|---|
//! | 0, 1 | "BASEMATK", format |
//! | 2 | fingerprint of the kernel |
//! | 3, 4 | classes of pairs, blocks of lags |
//! | then | convolution weights: by block, class, kind (zz, xx, zx), lag |
//! | last | check sum of all words before |
//!
//! The fingerprint is a hash of the mobility at the points of the passivity check, bit for bit, with step,
//! stages, tolerance and elements. Any change that changes a weight therefore changes it: a layer, a damping
//! law of the user's own, the crate's arithmetic or the machine's. The format number also identifies the rule
//! by which contours are sampled.

use std::ops::Range;
use std::path::PathBuf;
use std::sync::{Mutex, MutexGuard, OnceLock, PoisonError, TryLockError};
use std::time::Duration;

use super::block_file::{FIRST_BLOCK_LAGS, LagBlock, MAX_BLOCK_COUNT};
use super::block_file::{read, write};
use crate::error::{Error, ProgressReporter, Result, require, same_length};

/// Time between two checks whether another thread has finished.
const LOCK_POLL_INTERVAL: Duration = Duration::from_millis(20);

/// Blocks of a kernel computed so far.
#[derive(Debug)]
pub(crate) struct BlockStore {
    /// Fingerprint of the weights, after the passivity check.
    fingerprint: OnceLock<Result<u64>>,
    blocks: [OnceLock<Result<LagBlock>>; MAX_BLOCK_COUNT],
    /// Locked by the thread that computes.
    computing: Mutex<()>,
    file: Option<PathBuf>,
    /// Number of classes of pairs of elements.
    classes: usize,
    /// Number of kinds of weights for each class.
    kinds: usize,
}

impl BlockStore {
    /// Empty store for blocks with these numbers of classes and kinds.
    pub(crate) fn new(classes: usize, kinds: usize, file: Option<PathBuf>) -> Self {
        let blocks = std::array::from_fn(|_| OnceLock::new());
        let fingerprint = OnceLock::new();
        Self { fingerprint, blocks, computing: Mutex::default(), file, classes, kinds }
    }

    /// Block `number`; computed now if it is not stored.
    pub(crate) fn block(
        &self,
        number: usize,
        watch: &mut ProgressReporter,
        compute: impl FnOnce(&mut ProgressReporter) -> Result<LagBlock>,
    ) -> Result<&LagBlock> {
        self.once(&self.blocks[number], watch, compute)
    }

    /// Whether block `number` is stored.
    pub(crate) fn has(&self, number: usize) -> bool {
        self.blocks[number].get().is_some()
    }

    /// Part of a range of blocks from the first one that is not stored.
    pub(crate) fn missing(&self, range: Range<usize>) -> Range<usize> {
        let stored = range.clone().take_while(|number| self.has(*number)).count();
        range.start + stored..range.end
    }

    /// Fingerprint from `check`, which runs once; afterwards the blocks of the file are stored.
    pub(crate) fn fingerprint(
        &self,
        watch: &mut ProgressReporter,
        check: impl FnOnce(&mut ProgressReporter) -> Result<u64>,
    ) -> Result<u64> {
        let outcome = self.once(&self.fingerprint, watch, |watch| {
            let fingerprint = check(watch)?;
            if let Some(path) = &self.file {
                let stored = read(path, fingerprint, self.classes, self.kinds)?;
                for (place, block) in self.blocks.iter().zip(stored) {
                    let _ = place.set(Ok(block));
                }
            }
            Ok(fingerprint)
        });
        outcome.copied()
    }

    /// Writes all blocks to the file, if there is one.
    pub(crate) fn write(&self, fingerprint: u64) -> Result<()> {
        let Some(path) = &self.file else { return Ok(()) };
        let blocks = self.blocks.iter().map_while(|block| block.get()?.as_ref().ok());
        write(path, fingerprint, self.classes, &blocks.collect::<Vec<_>>())
    }

    /// Content of `place`; computed now if it is empty.
    ///
    /// A computation that is stopped stores nothing.
    pub(crate) fn once<'a, T>(
        &self,
        place: &'a OnceLock<Result<T>>,
        watch: &mut ProgressReporter,
        compute: impl FnOnce(&mut ProgressReporter) -> Result<T>,
    ) -> Result<&'a T> {
        if let Some(stored) = place.get() {
            return stored.as_ref().map_err(Clone::clone);
        }
        let _guard = self.lock(watch)?;
        // Another thread may have computed the content while this one waited.
        if let Some(stored) = place.get() {
            return stored.as_ref().map_err(Clone::clone);
        }
        match compute(watch) {
            Err(stopped @ Error::Stopped(_)) => Err(stopped),
            outcome => place.get_or_init(|| outcome).as_ref().map_err(Clone::clone),
        }
    }

    /// Waits for the lock; returns early if the observer stops the run.
    fn lock(&self, watch: &mut ProgressReporter) -> Result<MutexGuard<'_, ()>> {
        while watch.has_observer() {
            match self.computing.try_lock() {
                Ok(guard) => return Ok(guard),
                Err(TryLockError::Poisoned(poisoned)) => return Ok(poisoned.into_inner()),
                Err(TryLockError::WouldBlock) => {
                    watch.reach(0)?;
                    std::thread::sleep(LOCK_POLL_INTERVAL);
                }
            }
        }
        Ok(self.computing.lock().unwrap_or_else(PoisonError::into_inner))
    }
}

/// Overwrites `values`, one slice for each kind, with the lags of a class from `first_lag` on.
///
/// `block` returns a block by its number.
pub(crate) fn copy_lags<'a, const KINDS: usize>(
    class: usize,
    first_lag: usize,
    values: &mut [&mut [f64]; KINDS],
    mut block: impl FnMut(usize) -> Result<&'a LagBlock>,
) -> Result<()> {
    let lags = values[0].len();
    for others in &values[1..] {
        same_length("coefficients of a kind", others.len(), lags)?;
    }
    require("lag", first_lag as f64, first_lag > 0, "at least 1")?;
    last_block(first_lag.saturating_add(lags))?;
    let mut done = 0;
    while done < lags {
        let lag = first_lag + done;
        let number = LagBlock::number_of(lag);
        let position = lag - LagBlock::first_lag(number);
        let stored = block(number)?.lags_from::<KINDS>(class, position);
        let count = stored[0].len().min(lags - done);
        for (values, stored) in values.iter_mut().zip(stored) {
            values[done..done + count].copy_from_slice(&stored[..count]);
        }
        done += count;
    }
    Ok(())
}

/// Number of the block that contains `lag`.
pub(crate) fn last_block(lag: usize) -> Result<usize> {
    let max_lag = FIRST_BLOCK_LAGS << (MAX_BLOCK_COUNT - 1);
    require("lag of a layered ground", lag as f64, lag <= max_lag, "at most 2147483648")?;
    Ok(LagBlock::number_of(lag))
}
