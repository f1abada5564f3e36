//! Files of step coefficients.
//!
//! Words of eight bytes, little-endian:
//!
//! | word | meaning |
//! |---|---|
//! | 0, 1 | "BASEMATK", format |
//! | 2 | fingerprint of the kernel |
//! | 3, 4 | classes of pairs, blocks of lags |
//! | then | coefficients: by block, class, kind (zz, xx, zx), lag |
//! | last | check sum of all before |
//!
//! The fingerprint is that of the mobility at the points of the passivity gate, bit for bit, with step,
//! stages, tolerance and elements: whatever changes a coefficient changes it, be it a layer, a damping law of
//! one's own, the crate's arithmetic or the machine's. The format stands for the rule by which contours are
//! sampled as well.

use std::fs::File;
use std::io::Read;
use std::path::Path;
use std::sync::atomic::{AtomicU64, Ordering};

use super::coefficients::{BLOCKS, Block};
use crate::error::{Error, KernelFileError, LayeredError, Result, write_file};
use crate::text::check_sum::CheckSum;

const MAGIC: u64 = u64::from_le_bytes(*b"BASEMATK");
/// 1: of coefficients sampled at every point of their circles; 2: on panels; 3: over powers of z there; 4: where they
/// look resolved.
const FORMAT: u64 = 5;
const HEADER: usize = 5;

/// The blocks of a file, in order; none if there is no file, or one of another kernel or format.
///
/// # Errors
/// [`LayeredError::File`] for a file that cannot be read, is no kernel's, or is damaged.
pub(crate) fn read(
    path: &Path,
    fingerprint: u64,
    [classes, kinds]: [usize; 2],
) -> Result<Vec<Block>> {
    match contents(path, fingerprint, [classes, kinds]) {
        Err(KernelFileError::Unreadable(std::io::ErrorKind::NotFound)) => Ok(vec![]),
        found => found.map_err(|reason| {
            Error::from(LayeredError::File { file: path.display().to_string(), reason })
        }),
    }
}

fn contents(
    path: &Path,
    fingerprint: u64,
    [classes, kinds]: [usize; 2],
) -> std::result::Result<Vec<Block>, KernelFileError> {
    let unreadable = |error: std::io::Error| KernelFileError::Unreadable(error.kind());
    let mut file = File::open(path).map_err(unreadable)?;
    let found = file.metadata().map_err(unreadable)?.len();
    let mut begin = vec![];
    file.by_ref().take(8 * HEADER as u64).read_to_end(&mut begin).map_err(unreadable)?;
    let header: Vec<u64> =
        begin.as_chunks().0.iter().map(|word| u64::from_le_bytes(*word)).collect();
    if header.first() != Some(&MAGIC) {
        return Err(KernelFileError::NotAKernel);
    }
    if header.get(1).is_some_and(|format| *format != FORMAT) {
        return Ok(vec![]);
    }
    let [_, _, whose, found_classes, blocks] = header[..] else {
        return Err(KernelFileError::Length { found, needed: None });
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
        return Err(KernelFileError::Length { found, needed });
    }
    let mut bytes = vec![];
    file.read_to_end(&mut bytes).map_err(unreadable)?;
    let (words, _) = bytes.as_chunks::<8>();
    let Some((stored, data)) = words.split_last() else {
        return Err(KernelFileError::Length { found, needed });
    };
    let mut sum = CheckSum::default();
    for word in begin.as_chunks().0.iter().chain(data) {
        sum.add(u64::from_le_bytes(*word));
    }
    if sum.value() != u64::from_le_bytes(*stored) {
        return Err(KernelFileError::Damaged);
    }
    let mut numbers = data.iter().map(|word| f64::from_le_bytes(*word));
    if !numbers.clone().all(f64::is_finite) {
        return Err(KernelFileError::Damaged);
    }
    let mut list = |lags: usize| numbers.by_ref().take(lags).collect::<Vec<_>>();
    let mut block = |number: usize| {
        let lags = Block::lags(number);
        Block { values: (0..kinds * classes).map(|_| list(lags)).collect() }
    };
    Ok((0..blocks).map(&mut block).collect())
}

/// Writes the file anew; another process finds the old one or the new, whole.
pub(crate) fn write(
    path: &Path,
    fingerprint: u64,
    classes: usize,
    blocks: &[&Block],
) -> Result<()> {
    static WRITTEN: AtomicU64 = AtomicU64::new(0);
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
    let mut name = path.as_os_str().to_owned();
    let number = WRITTEN.fetch_add(1, Ordering::Relaxed);
    name.push(format!(".{}-{number}", std::process::id()));
    let beside = Path::new(&name);
    write_file(beside, bytes)?;
    std::fs::rename(beside, path).map_err(|error| {
        let _ = std::fs::remove_file(beside);
        Error::Write { file: path.display().to_string(), reason: error.kind() }
    })
}
