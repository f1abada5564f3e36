//! Blocks of convolution weights, each with twice the lags of the one before, and their files.

use std::fs::File;
use std::io::Read;
use std::path::Path;

use super::contour::Circle;
use crate::error::{FileFault, Result};
use crate::text::check_sum::CheckSum;
use crate::text::file::write_file;

/// Number of lags of the first block.
pub(crate) const FIRST_BLOCK_LAGS: usize = 128;
/// Largest number of blocks: lags up to 2³¹.
pub(crate) const MAX_BLOCK_COUNT: usize = 25;
/// Number of points of the circle per N, for lags N+1 … 2N; the first block has 2N points.
const POINTS_PER_LAG: usize = 4;

/// Weights of consecutive lags, for all classes.
#[derive(Debug)]
pub(crate) struct LagBlock {
    /// One list of lags for each class and kind, class by class.
    pub(crate) values: Vec<Vec<f64>>,
}

impl LagBlock {
    /// Number of the block that contains `lag` ≥ 1.
    pub(crate) fn number_of(lag: usize) -> usize {
        let index = lag - 1;
        if index < FIRST_BLOCK_LAGS {
            0
        } else {
            (index / FIRST_BLOCK_LAGS).ilog2() as usize + 1
        }
    }

    /// The first lag in block `number`.
    pub(crate) fn first_lag(number: usize) -> usize {
        if number == 0 { 1 } else { (FIRST_BLOCK_LAGS << (number - 1)) + 1 }
    }

    /// Number of lags in block `number`.
    pub(crate) fn lags(number: usize) -> usize {
        FIRST_BLOCK_LAGS << number.saturating_sub(1)
    }

    /// Circle for the transform of block `number`, for a relative accuracy of F.
    pub(crate) fn circle(number: usize, tolerance: f64) -> Circle {
        let length = POINTS_PER_LAG * Self::lags(number) / if number == 0 { 2 } else { 1 };
        Circle::new(length, tolerance)
    }

    /// The last lag in block `number`.
    pub(crate) fn last_lag(number: usize) -> usize {
        FIRST_BLOCK_LAGS << number
    }

    /// Weights of one class from a position in the block to its end.
    pub(crate) fn lags_from<const KINDS: usize>(
        &self,
        class: usize,
        position: usize,
    ) -> [&[f64]; KINDS] {
        std::array::from_fn(|kind| &self.values[class * KINDS + kind][position..])
    }
}

/// First word of a kernel file.
const FILE_MAGIC: u64 = u64::from_le_bytes(*b"BASEMATK");

/// Version of the rule by which contours are sampled.
///
/// 1: every point of the circles; 2: panels; 3: panels divided by powers of z; 4: only panels predicted as resolved; 5:
/// integrals more accurate than the weights; 6: also in plan.
const FILE_FORMAT: u64 = 6;

/// Number of words before the weights.
const HEADER_WORDS: usize = 5;

/// The blocks of a file, in order; none without a file, or for another kernel or format.
///
/// # Errors
/// [`Error::File`](crate::Error::File) for a file that cannot be read, is not a kernel file, or is damaged.
pub(super) fn read(
    path: &Path,
    fingerprint: u64,
    classes: usize,
    kinds: usize,
) -> Result<Vec<LagBlock>> {
    match contents(path, fingerprint, classes, kinds) {
        Err(FileFault::Unreadable(std::io::ErrorKind::NotFound)) => Ok(vec![]),
        outcome => outcome.map_err(|fault| fault.of(path.display().to_string(), 0)),
    }
}

/// Reads as [`read`], with faults that do not yet name the file.
fn contents(
    path: &Path,
    fingerprint: u64,
    classes: usize,
    kinds: usize,
) -> std::result::Result<Vec<LagBlock>, FileFault> {
    let mut file = File::open(path).map_err(unreadable)?;
    let file_size = file.metadata().map_err(unreadable)?.len();
    let mut header_bytes = vec![];
    file.by_ref()
        .take(8 * HEADER_WORDS as u64)
        .read_to_end(&mut header_bytes)
        .map_err(unreadable)?;
    let header: Vec<u64> =
        header_bytes.as_chunks().0.iter().map(|word| u64::from_le_bytes(*word)).collect();
    if header.first() != Some(&FILE_MAGIC) {
        return Err(FileFault::format(
            "other data",
            "convolution weights: the file is not written over",
        ));
    }
    if header.get(1).is_some_and(|format| *format != FILE_FORMAT) {
        return Ok(vec![]);
    }
    let [_magic, _format, stored_fingerprint, stored_classes, block_count] = header[..] else {
        return Err(wrong_length(file_size, None));
    };
    if stored_fingerprint != fingerprint || stored_classes != classes as u64 {
        return Ok(vec![]);
    }
    let block_count = usize::try_from(block_count).unwrap_or(usize::MAX);
    let needed_size = (block_count <= MAX_BLOCK_COUNT).then(|| {
        let lags: usize = (0..block_count).map(LagBlock::lags).sum();
        (HEADER_WORDS + kinds * classes * lags + 1) as u64 * 8
    });
    if needed_size != Some(file_size) {
        return Err(wrong_length(file_size, needed_size));
    }
    let mut bytes = vec![];
    file.read_to_end(&mut bytes).map_err(unreadable)?;
    let words = bytes.as_chunks::<8>().0;
    let Some((stored_sum, data)) = words.split_last() else {
        return Err(wrong_length(file_size, needed_size));
    };
    let mut sum = CheckSum::default();
    for word in header_bytes.as_chunks().0.iter().chain(data) {
        sum.add(u64::from_le_bytes(*word));
    }
    if sum.value() != u64::from_le_bytes(*stored_sum) {
        return Err(damaged());
    }
    let mut numbers = data.iter().map(|word| f64::from_le_bytes(*word));
    if !numbers.clone().all(f64::is_finite) {
        return Err(damaged());
    }
    let mut blocks = Vec::with_capacity(block_count);
    for number in 0..block_count {
        let lags = LagBlock::lags(number);
        let mut values = Vec::with_capacity(kinds * classes);
        for _ in 0..kinds * classes {
            values.push(numbers.by_ref().take(lags).collect());
        }
        blocks.push(LagBlock { values });
    }
    Ok(blocks)
}

/// Fault of a file that the system does not read.
#[allow(clippy::needless_pass_by_value, reason = "for `map_err`")]
fn unreadable(error: std::io::Error) -> FileFault {
    FileFault::Unreadable(error.kind())
}

/// Fault of a file that is shorter or longer than its header states, in bytes.
fn wrong_length(found: u64, needed: Option<u64>) -> FileFault {
    let stated = needed.map_or_else(|| "more".to_owned(), |needed| needed.to_string());
    let needed = format!("{stated} (delete the file to have it made anew)");
    FileFault::value("number of bytes", found.to_string(), needed)
}

/// Fault of a file whose check sum differs.
fn damaged() -> FileFault {
    FileFault::Damaged { quantity: "file".into() }
}

/// Replaces the file; another process finds either the old file or the new one, complete.
pub(super) fn write(
    path: &Path,
    fingerprint: u64,
    classes: usize,
    blocks: &[&LagBlock],
) -> Result<()> {
    let weights = blocks.iter().flat_map(|block| block.values.iter().flatten());
    let count = weights.clone().count() + HEADER_WORDS + 1;
    let mut bytes: Vec<u8> = Vec::with_capacity(8 * count);
    let mut sum = CheckSum::default();
    let header = [FILE_MAGIC, FILE_FORMAT, fingerprint, classes as u64, blocks.len() as u64];
    for word in header.into_iter().chain(weights.map(|weight| weight.to_bits())) {
        sum.add(word);
        bytes.extend(word.to_le_bytes());
    }
    bytes.extend(sum.value().to_le_bytes());
    write_file(path, bytes)
}
