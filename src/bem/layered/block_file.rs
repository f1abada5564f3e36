//! Blocks of convolution weights, each with twice the lags of the previous block, and their files.

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
/// Number of points of the circle for each lag of a block N+1 … 2N; the first block has half as many.
const POINTS_PER_LAG: usize = 4;

/// Weights of consecutive lags, for all classes.
#[derive(Debug)]
pub(crate) struct LagBlock {
    /// Weights of all lags for each class and component, class by class.
    pub(crate) values: Vec<Vec<f64>>,
}

impl LagBlock {
    /// Index of the block that contains `lag` ≥ 1.
    pub(crate) fn index_of(lag: usize) -> usize {
        let previous_lag = lag - 1;
        if previous_lag < FIRST_BLOCK_LAGS {
            0
        } else {
            (previous_lag / FIRST_BLOCK_LAGS).ilog2() as usize + 1
        }
    }

    /// First lag of a block.
    pub(crate) fn first_lag(block_index: usize) -> usize {
        if block_index == 0 { 1 } else { (FIRST_BLOCK_LAGS << (block_index - 1)) + 1 }
    }

    /// Number of lags of a block.
    pub(crate) fn lag_count(block_index: usize) -> usize {
        FIRST_BLOCK_LAGS << block_index.saturating_sub(1)
    }

    /// Circle for the transform of a block, for a relative accuracy of F.
    pub(crate) fn circle(block_index: usize, tolerance: f64) -> Circle {
        let divisor = if block_index == 0 { 2 } else { 1 };
        Circle::new(POINTS_PER_LAG * Self::lag_count(block_index) / divisor, tolerance)
    }

    /// Last lag of a block.
    pub(crate) fn last_lag(block_index: usize) -> usize {
        FIRST_BLOCK_LAGS << block_index
    }

    /// Weights of one class, all components, from a position in the block to its end.
    pub(crate) fn weights_from<const KINDS: usize>(
        &self,
        class: usize,
        position: usize,
    ) -> [&[f64]; KINDS] {
        std::array::from_fn(|component| &self.values[class * KINDS + component][position..])
    }
}

/// First word of a kernel file.
const FILE_MAGIC: u64 = u64::from_le_bytes(*b"BASEMATK");

/// Version of the format, and of the rule by which circles are sampled.
///
/// A change that changes the bits of weights must increase it.
const FILE_FORMAT: u64 = 6;

/// Number of words before the weights.
const HEADER_WORDS: usize = 5;

/// Reads the blocks of a file, in order.
///
/// The list is empty without a file, and for a file of another kernel or format.
///
/// # Errors
/// [`Error::File`](crate::Error::File) for a file that cannot be read, is not a kernel file, or is damaged.
pub(super) fn read(
    path: &Path,
    fingerprint: u64,
    class_count: usize,
    component_count: usize,
) -> Result<Vec<LagBlock>> {
    match read_contents(path, fingerprint, class_count, component_count) {
        Err(FileFault::Unreadable(std::io::ErrorKind::NotFound)) => Ok(vec![]),
        outcome => outcome.map_err(|fault| fault.of(path.display().to_string(), 0)),
    }
}

/// Reads the blocks of a file, for [`read`], which adds the file's name to a fault.
fn read_contents(
    path: &Path,
    fingerprint: u64,
    class_count: usize,
    component_count: usize,
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
            "convolution weights: the file is not overwritten",
        ));
    }
    if header.get(1).is_some_and(|format| *format != FILE_FORMAT) {
        return Ok(vec![]);
    }
    let [_magic, _format, stored_fingerprint, stored_class_count, block_count] = header[..] else {
        return Err(wrong_length(file_size, None));
    };
    if stored_fingerprint != fingerprint || stored_class_count != class_count as u64 {
        return Ok(vec![]);
    }
    let block_count = usize::try_from(block_count).unwrap_or(usize::MAX);
    let expected_size = (block_count <= MAX_BLOCK_COUNT).then(|| {
        let lag_count: usize = (0..block_count).map(LagBlock::lag_count).sum();
        (HEADER_WORDS + component_count * class_count * lag_count + 1) as u64 * 8
    });
    if expected_size != Some(file_size) {
        return Err(wrong_length(file_size, expected_size));
    }
    let mut bytes = vec![];
    file.read_to_end(&mut bytes).map_err(unreadable)?;
    let words = bytes.as_chunks::<8>().0;
    let Some((stored_check_sum, data)) = words.split_last() else {
        return Err(wrong_length(file_size, expected_size));
    };
    let mut check_sum = CheckSum::default();
    for word in header_bytes.as_chunks().0.iter().chain(data) {
        check_sum.add(u64::from_le_bytes(*word));
    }
    if check_sum.value() != u64::from_le_bytes(*stored_check_sum) {
        return Err(damage_fault());
    }
    let mut numbers = data.iter().map(|word| f64::from_le_bytes(*word));
    if !numbers.clone().all(f64::is_finite) {
        return Err(damage_fault());
    }
    Ok(divide_into_blocks(&mut numbers, block_count, component_count * class_count))
}

/// Divides all weights of a file into blocks, with `function_count` lists of lags in each.
fn divide_into_blocks(
    numbers: &mut impl Iterator<Item = f64>,
    block_count: usize,
    function_count: usize,
) -> Vec<LagBlock> {
    let mut blocks = Vec::with_capacity(block_count);
    for block_index in 0..block_count {
        let lag_count = LagBlock::lag_count(block_index);
        let mut values = Vec::with_capacity(function_count);
        for _ in 0..function_count {
            values.push(numbers.by_ref().take(lag_count).collect());
        }
        blocks.push(LagBlock { values });
    }
    blocks
}

/// Fault of a file that the operating system cannot read.
#[allow(clippy::needless_pass_by_value, reason = "for `map_err`")]
fn unreadable(error: std::io::Error) -> FileFault {
    FileFault::Unreadable(error.kind())
}

/// Fault of a file whose number of bytes differs from its header.
fn wrong_length(found: u64, needed: Option<u64>) -> FileFault {
    let needed_text = needed.map_or_else(|| "more".to_owned(), |needed| needed.to_string());
    let advice = format!("{needed_text} (delete the file: it is then written again)");
    FileFault::value("number of bytes", found.to_string(), advice)
}

/// Fault of a file whose check sum differs.
fn damage_fault() -> FileFault {
    FileFault::Damaged { quantity: "file".into() }
}

/// Replaces the file; another process reads either the complete old file or the complete new file.
pub(super) fn write(
    path: &Path,
    fingerprint: u64,
    class_count: usize,
    blocks: &[&LagBlock],
) -> Result<()> {
    let weights = blocks.iter().flat_map(|block| block.values.iter().flatten());
    let word_count = weights.clone().count() + HEADER_WORDS + 1;
    let mut bytes: Vec<u8> = Vec::with_capacity(8 * word_count);
    let mut check_sum = CheckSum::default();
    let header = [FILE_MAGIC, FILE_FORMAT, fingerprint, class_count as u64, blocks.len() as u64];
    for word in header.into_iter().chain(weights.map(|weight| weight.to_bits())) {
        check_sum.add(word);
        bytes.extend(word.to_le_bytes());
    }
    bytes.extend(check_sum.value().to_le_bytes());
    write_file(path, bytes)
}
