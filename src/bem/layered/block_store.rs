//! Store of blocks of convolution weights: each is computed once, by one thread at a time.
//!
//! The file of a store has words of eight bytes, little-endian:
//!
//! | word | meaning |
//! |---|---|
//! | 0, 1 | "BASEMATK", format |
//! | 2 | fingerprint of the convolution weights |
//! | 3, 4 | numbers of classes of pairs and of blocks |
//! | from 5 | convolution weights: by block, class, component, lag |
//! | last | check sum of all previous words |
//!
//! The fingerprint is a hash of all bits of the mobility at the points of the passivity check, of time step, stages,
//! tolerance and elements. Any difference that changes a weight therefore changes the fingerprint: another layer, another
//! damping law of the user, other arithmetic of the crate or of the machine. The format number also identifies the rule by
//! which circles are sampled.

use std::ops::Range;
use std::path::PathBuf;
use std::sync::{Mutex, MutexGuard, OnceLock, PoisonError, TryLockError};
use std::time::Duration;

use super::block_file::{FIRST_BLOCK_LAGS, LagBlock, MAX_BLOCK_COUNT};
use super::block_file::{read, write};
use crate::error::{Error, ProgressReporter, Result, require, same_length};

/// Time between two attempts to lock the store; it is short beside the computation of a block.
const LOCK_POLL_INTERVAL: Duration = Duration::from_millis(20);

/// Computed blocks of convolution weights, and their file.
#[derive(Debug)]
pub(crate) struct BlockStore {
    /// Fingerprint of the weights, after the passivity check.
    fingerprint: OnceLock<Result<u64>>,
    blocks: [OnceLock<Result<LagBlock>>; MAX_BLOCK_COUNT],
    /// Lock of the thread that computes a block.
    computation_lock: Mutex<()>,
    file: Option<PathBuf>,
    /// Number of classes of pairs of elements.
    class_count: usize,
    /// Number of components of weights for each class.
    component_count: usize,
}

impl BlockStore {
    /// Empty store for blocks with these numbers of classes and of components.
    pub(crate) fn new(class_count: usize, component_count: usize, file: Option<PathBuf>) -> Self {
        Self {
            fingerprint: OnceLock::new(),
            blocks: std::array::from_fn(|_| OnceLock::new()),
            computation_lock: Mutex::default(),
            file,
            class_count,
            component_count,
        }
    }

    /// Stored or newly computed block.
    pub(crate) fn block(
        &self,
        block_index: usize,
        progress: &mut ProgressReporter,
        compute: impl FnOnce(&mut ProgressReporter) -> Result<LagBlock>,
    ) -> Result<&LagBlock> {
        self.compute_once(&self.blocks[block_index], progress, compute)
    }

    /// Whether a block is stored.
    pub(crate) fn has_block(&self, block_index: usize) -> bool {
        self.blocks[block_index].get().is_some()
    }

    /// Part of a range of blocks from the first missing block on.
    pub(crate) fn missing_blocks(&self, range: Range<usize>) -> Range<usize> {
        let stored_count =
            range.clone().take_while(|block_index| self.has_block(*block_index)).count();
        range.start + stored_count..range.end
    }

    /// Fingerprint of the weights from `check`, which is called once.
    ///
    /// After the check, the blocks of the file are stored.
    pub(crate) fn fingerprint(
        &self,
        progress: &mut ProgressReporter,
        check: impl FnOnce(&mut ProgressReporter) -> Result<u64>,
    ) -> Result<u64> {
        let outcome = self.compute_once(&self.fingerprint, progress, |progress| {
            let fingerprint = check(progress)?;
            if let Some(path) = &self.file {
                let file_blocks = read(path, fingerprint, self.class_count, self.component_count)?;
                for (cell, block) in self.blocks.iter().zip(file_blocks) {
                    let _ = cell.set(Ok(block));
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
        write(path, fingerprint, self.class_count, &blocks.collect::<Vec<_>>())
    }

    /// Stored or newly computed content of `cell`.
    ///
    /// A computation that the observer stops stores nothing.
    pub(crate) fn compute_once<'a, T>(
        &self,
        cell: &'a OnceLock<Result<T>>,
        progress: &mut ProgressReporter,
        compute: impl FnOnce(&mut ProgressReporter) -> Result<T>,
    ) -> Result<&'a T> {
        if let Some(stored_result) = cell.get() {
            return stored_result.as_ref().map_err(Clone::clone);
        }
        let _guard = self.lock(progress)?;
        // Another thread may have computed the content while this thread waited.
        if let Some(stored_result) = cell.get() {
            return stored_result.as_ref().map_err(Clone::clone);
        }
        match compute(progress) {
            Err(stopped @ Error::Stopped(_)) => Err(stopped),
            outcome => cell.get_or_init(|| outcome).as_ref().map_err(Clone::clone),
        }
    }

    /// Waits for the lock; returns early if the observer stops the run.
    fn lock(&self, progress: &mut ProgressReporter) -> Result<MutexGuard<'_, ()>> {
        while progress.has_observer() {
            match self.computation_lock.try_lock() {
                Ok(guard) => return Ok(guard),
                Err(TryLockError::Poisoned(poisoned)) => return Ok(poisoned.into_inner()),
                Err(TryLockError::WouldBlock) => {
                    progress.reach(0)?;
                    std::thread::sleep(LOCK_POLL_INTERVAL);
                }
            }
        }
        Ok(self.computation_lock.lock().unwrap_or_else(PoisonError::into_inner))
    }
}

/// Overwrites `values`, one slice for each component, with the weights of a class from `first_lag` on.
///
/// `block_at` returns a block by its index.
pub(crate) fn copy_weights<'a, const KINDS: usize>(
    class: usize,
    first_lag: usize,
    values: &mut [&mut [f64]; KINDS],
    mut block_at: impl FnMut(usize) -> Result<&'a LagBlock>,
) -> Result<()> {
    let lag_count = values[0].len();
    for component_values in &values[1..] {
        same_length("coefficients of a component", component_values.len(), lag_count)?;
    }
    require("lag", first_lag as f64, first_lag > 0, "at least 1")?;
    block_index(first_lag.saturating_add(lag_count))?;
    let mut copied_count = 0;
    while copied_count < lag_count {
        let lag = first_lag + copied_count;
        let index = LagBlock::index_of(lag);
        let position = lag - LagBlock::first_lag(index);
        let block_weights = block_at(index)?.weights_from::<KINDS>(class, position);
        let count = block_weights[0].len().min(lag_count - copied_count);
        for (component_values, weights) in values.iter_mut().zip(block_weights) {
            component_values[copied_count..copied_count + count].copy_from_slice(&weights[..count]);
        }
        copied_count += count;
    }
    Ok(())
}

/// Index of the block that contains `lag`, or an error for a lag beyond the last block.
pub(crate) fn block_index(lag: usize) -> Result<usize> {
    let max_lag = FIRST_BLOCK_LAGS << (MAX_BLOCK_COUNT - 1);
    require("lag of a layered ground", lag as f64, lag <= max_lag, "at most 2147483648")?;
    Ok(LagBlock::index_of(lag))
}
