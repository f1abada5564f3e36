//! Files of blocks of coefficients.

use std::fs::File;
use std::io::Read;
use std::path::Path;

use super::coefficients::{BLOCKS, Block};
use crate::error::{FileFault, Result};
use crate::text::check_sum::CheckSum;
use crate::text::file::write_file;

const MAGIC: u64 = u64::from_le_bytes(*b"BASEMATK");

/// Version of the rule by which contours are sampled.
///
/// 1: every point of the circles; 2: panels; 3: panels divided by powers of z; 4: only panels predicted as resolved; 5:
/// integrals more accurate than the weights; 6: also in plan.
const FORMAT: u64 = 6;

const HEADER: usize = 5;

/// The blocks of a file, in order; none without a file, or for another kernel or format.
///
/// # Errors
/// [`Error::File`](crate::Error::File) for a file that cannot be read, is not a kernel file, or is damaged.
pub(super) fn read(
    path: &Path,
    fingerprint: u64,
    [classes, kinds]: [usize; 2],
) -> Result<Vec<Block>> {
    match contents(path, fingerprint, [classes, kinds]) {
        Err(FileFault::Unreadable(std::io::ErrorKind::NotFound)) => Ok(vec![]),
        found => found.map_err(|fault| fault.of(path.display().to_string(), 0)),
    }
}

fn contents(
    path: &Path,
    fingerprint: u64,
    [classes, kinds]: [usize; 2],
) -> std::result::Result<Vec<Block>, FileFault> {
    let unreadable = |error: std::io::Error| FileFault::Unreadable(error.kind());
    let mut file = File::open(path).map_err(unreadable)?;
    let found = file.metadata().map_err(unreadable)?.len();
    let mut begin = vec![];
    file.by_ref().take(8 * HEADER as u64).read_to_end(&mut begin).map_err(unreadable)?;
    let header: Vec<u64> =
        begin.as_chunks().0.iter().map(|word| u64::from_le_bytes(*word)).collect();
    if header.first() != Some(&MAGIC) {
        return Err(FileFault::format(
            "other data",
            "convolution weights: the file is not written over",
        ));
    }
    if header.get(1).is_some_and(|format| *format != FORMAT) {
        return Ok(vec![]);
    }
    let [_, _, whose, found_classes, blocks] = header[..] else {
        return Err(wrong_length(found, None));
    };
    if whose != fingerprint || found_classes != classes as u64 {
        return Ok(vec![]);
    }
    let blocks = usize::try_from(blocks).unwrap_or(usize::MAX);
    let size = |blocks: usize| {
        let lags: usize = (0..blocks).map(Block::lags).sum();
        (HEADER + kinds * classes * lags + 1) as u64 * 8
    };
    let needed = (blocks <= BLOCKS).then(|| size(blocks));
    if needed != Some(found) {
        return Err(wrong_length(found, needed));
    }
    let mut bytes = vec![];
    file.read_to_end(&mut bytes).map_err(unreadable)?;
    let (words, _) = bytes.as_chunks::<8>();
    let Some((stored, data)) = words.split_last() else {
        return Err(wrong_length(found, needed));
    };
    let mut sum = CheckSum::default();
    for word in begin.as_chunks().0.iter().chain(data) {
        sum.add(u64::from_le_bytes(*word));
    }
    if sum.value() != u64::from_le_bytes(*stored) {
        return Err(damaged());
    }
    let mut numbers = data.iter().map(|word| f64::from_le_bytes(*word));
    if !numbers.clone().all(f64::is_finite) {
        return Err(damaged());
    }
    let mut list = |lags: usize| numbers.by_ref().take(lags).collect::<Vec<_>>();
    let mut block = |number: usize| {
        let lags = Block::lags(number);
        Block { values: (0..kinds * classes).map(|_| list(lags)).collect() }
    };
    Ok((0..blocks).map(&mut block).collect())
}

/// Fault of a file that is shorter or longer than its header states, in bytes.
fn wrong_length(found: u64, needed: Option<u64>) -> FileFault {
    let stated = needed.map_or_else(|| "more".to_owned(), |needed| needed.to_string());
    let needed = format!("{stated} (delete the file to have it made anew)");
    FileFault::value("number of bytes", found.to_string(), needed)
}

fn damaged() -> FileFault {
    FileFault::Damaged { quantity: "file".into() }
}

/// Replaces the file; another process finds either the old file or the new one, complete.
pub(super) fn write(
    path: &Path,
    fingerprint: u64,
    classes: usize,
    blocks: &[&Block],
) -> Result<()> {
    let lists = || blocks.iter().flat_map(|block| &block.values);
    let count = lists().map(Vec::len).sum::<usize>() + HEADER + 1;
    let mut bytes: Vec<u8> = Vec::with_capacity(8 * count);
    let mut sum = CheckSum::default();
    let header = [MAGIC, FORMAT, fingerprint, classes as u64, blocks.len() as u64];
    for word in header.into_iter().chain(lists().flatten().map(|number| number.to_bits())) {
        sum.add(word);
        bytes.extend(word.to_le_bytes());
    }
    bytes.extend(sum.value().to_le_bytes());
    write_file(path, bytes)
}
