//! Files that are written whole.

use std::hash::{BuildHasher, Hasher, RandomState};
use std::io::Write;
use std::path::Path;

use crate::error::{Error, Result};

/// The path, printed.
pub(super) fn name(path: &Path) -> String {
    path.display().to_string()
}

/// [`Error::Write`] of `path`.
pub(super) fn unwritten(path: &Path) -> impl Fn(std::io::Error) -> Error {
    let file = name(path);
    move |error| Error::Write { file: file.clone(), reason: error.kind() }
}

/// Replaces a file by one with this content, or leaves it as it was.
pub(super) fn replace(path: &Path, content: &str) -> Result<()> {
    replaced(path, content).map_err(unwritten(path))
}

/// The same, with the system's own error.
pub(super) fn replaced(path: &Path, content: &str) -> std::io::Result<()> {
    // The hash of nothing, under keys that are random: two processes must not share the name.
    let mark = RandomState::new().build_hasher().finish();
    let mut temporary = path.as_os_str().to_owned();
    temporary.push(format!(".{mark:016x}.tmp"));
    let write = || {
        path.parent().map_or(Ok(()), std::fs::create_dir_all)?;
        let mut file = std::fs::File::create(&temporary)?;
        file.write_all(content.as_bytes())?;
        file.sync_all()?;
        std::fs::rename(&temporary, path)
    };
    write().inspect_err(|_| {
        let _ = std::fs::remove_file(&temporary);
    })
}
