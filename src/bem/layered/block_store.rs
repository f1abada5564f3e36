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
//! The fingerprint is a hash of the mobility at the points of the passivity gate, bit for bit, with step,
//! stages, tolerance and elements. Any change that changes a weight therefore changes it: a layer, a damping
//! law of the user's own, the crate's arithmetic or the machine's. The format number also identifies the rule
//! by which contours are sampled.

use std::ops::Range;
use std::path::PathBuf;
use std::sync::{Mutex, MutexGuard, OnceLock, PoisonError, TryLockError};
use std::time::Duration;

use super::block_file::{read, write};
use super::coefficients::{BLOCKS, Block, FIRST};
use crate::error::{Error, Result, Watch, require, same_length};

/// Time between two checks whether another thread has finished.
const WAIT: Duration = Duration::from_millis(20);

/// Blocks of a kernel computed so far.
#[derive(Debug)]
pub(crate) struct BlockStore {
    /// Fingerprint of the weights after the passivity gate.
    checked: OnceLock<Result<u64>>,
    blocks: [OnceLock<Result<Block>>; BLOCKS],
    /// Locked by the thread that computes.
    making: Mutex<()>,
    file: Option<PathBuf>,
    /// Numbers of classes and of kinds.
    sizes: [usize; 2],
}

impl BlockStore {
    /// Empty store for blocks with these numbers of classes and kinds.
    pub(crate) fn new(sizes: [usize; 2], file: Option<PathBuf>) -> Self {
        let blocks = std::array::from_fn(|_| OnceLock::new());
        Self { checked: OnceLock::new(), blocks, making: Mutex::default(), file, sizes }
    }

    /// Block `number`; computed now if it is not stored.
    pub(crate) fn block(
        &self,
        number: usize,
        watch: &mut Watch,
        make: impl FnOnce(&mut Watch) -> Result<Block>,
    ) -> Result<&Block> {
        self.once(&self.blocks[number], watch, make)
    }

    /// Whether block `number` is stored.
    pub(crate) fn has(&self, number: usize) -> bool {
        self.blocks[number].get().is_some()
    }

    /// Range of `wanted` from the first block that is not stored.
    pub(crate) fn missing(&self, wanted: Range<usize>) -> Range<usize> {
        wanted.start + wanted.clone().take_while(|number| self.has(*number)).count()..wanted.end
    }

    /// Fingerprint from `check`, which runs once; afterwards the blocks of the file are stored.
    pub(crate) fn gate(
        &self,
        watch: &mut Watch,
        check: impl FnOnce(&mut Watch) -> Result<u64>,
    ) -> Result<u64> {
        let checked = self.once(&self.checked, watch, |watch| {
            let fingerprint = check(watch)?;
            if let Some(path) = &self.file {
                for (place, block) in self.blocks.iter().zip(read(path, fingerprint, self.sizes)?) {
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
        write(path, fingerprint, self.sizes[0], &blocks.collect::<Vec<_>>())
    }

    /// Content of `place`; computed now if it is empty.
    ///
    /// A computation that is stopped stores nothing.
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

    /// Waits for the lock; returns early if the observer stops the run.
    fn enter(&self, watch: &mut Watch) -> Result<MutexGuard<'_, ()>> {
        while watch.has_observer() {
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

/// Overwrites `values`, one slice for each kind, with the lags of a class from `first_lag` on.
///
/// `block` returns a block by its number.
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
    require("lag", first_lag as f64, first_lag > 0, "at least 1")?;
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

/// Number of the block that contains `lag`.
pub(crate) fn last_block(lag: usize) -> Result<usize> {
    let most = FIRST << (BLOCKS - 1);
    require("lag of a layered ground", lag as f64, lag <= most, "at most 2147483648")?;
    Ok(Block::place(lag).0)
}
