//! Writes files completely, or leaves them unchanged.

use std::fs::File;
use std::hash::{BuildHasher, Hasher, RandomState};
use std::io::Write;
use std::path::Path;

use crate::error::{Error, FileFault, Result};

/// Makes the error for a file that cannot be written.
pub fn write_error(path: &Path) -> impl Fn(std::io::Error) -> Error {
    move |error| FileFault::Unwritable(error.kind()).of(path.display().to_string(), 0)
}

/// Opens a file to be read.
pub fn open_file(path: &Path) -> Result<File> {
    File::open(path)
        .map_err(|error| FileFault::Unreadable(error.kind()).of(path.display().to_string(), 0))
}

/// Replaces a file by one with this content; if that fails, the file is unchanged.
pub fn replace_file(path: &Path, content: &[u8]) -> std::io::Result<()> {
    // A symbolic link stays a link; to a pipe or a terminal the content is written directly.
    let path = path.canonicalize().unwrap_or_else(|_| path.to_owned());
    if path.exists() && !path.is_file() {
        return std::fs::write(&path, content);
    }
    // Threads and machines have different random keys; forks inherit them, but have different process numbers.
    let mut hasher = RandomState::new().build_hasher();
    hasher.write_u32(std::process::id());
    let suffix = hasher.finish();
    let mut temporary = path.as_os_str().to_owned();
    temporary.push(format!(".{suffix:016x}.tmp"));
    let written = write_and_sync(Path::new(&temporary), content)
        .and_then(|()| std::fs::rename(&temporary, &path));
    if written.is_err() {
        let _ = std::fs::remove_file(&temporary);
    }
    written
}

/// Writes a new file; when this returns, its content is on the disk.
fn write_and_sync(path: &Path, content: &[u8]) -> std::io::Result<()> {
    let mut file = File::create(path)?;
    file.write_all(content)?;
    file.sync_all()
}

/// Makes the folder of a file if it is not there.
pub fn make_folder_of(path: &Path) -> Result<()> {
    path.parent().map_or(Ok(()), std::fs::create_dir_all).map_err(write_error(path))
}

/// Writes a file by [`replace_file`], and makes its folder if it does not exist.
pub fn write_file(path: &Path, content: impl AsRef<[u8]>) -> Result<()> {
    make_folder_of(path)?;
    replace_file(path, content.as_ref()).map_err(write_error(path))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn folder(name: &str) -> std::path::PathBuf {
        let folder = std::env::temp_dir().join(format!("basemat-{name}-{}", std::process::id()));
        std::fs::create_dir_all(&folder).unwrap();
        folder
    }

    #[test]
    fn a_write_that_fails_names_its_file_and_leaves_nothing() {
        let folder = folder("unwritten");
        let below_a_file = folder.join("file").join("below");
        write_file(&folder.join("file"), "whole").unwrap();
        for path in [below_a_file, folder.clone()] {
            let message = write_file(&path, "content").unwrap_err().to_string();
            assert!(message.starts_with(&format!("{} cannot be written", path.display())));
        }
        let files: Vec<_> = std::fs::read_dir(&folder).unwrap().collect();
        assert_eq!(files.len(), 1, "{files:?}");
        assert_eq!(std::fs::read(folder.join("file")).unwrap(), b"whole");
        std::fs::remove_dir_all(&folder).unwrap();
    }

    #[cfg(unix)]
    #[test]
    fn a_link_stays_one_and_a_device_is_written_to() {
        let folder = folder("link");
        let file = folder.join("file");
        let link = folder.join("link");
        write_file(&file, "one").unwrap();
        std::os::unix::fs::symlink(&file, &link).unwrap();
        write_file(&link, "another").unwrap();
        assert!(link.is_symlink());
        assert_eq!(std::fs::read(&file).unwrap(), b"another");
        write_file(Path::new("/dev/null"), "nothing").unwrap();
        assert!(!Path::new("/dev/null").is_file());
        std::fs::remove_dir_all(&folder).unwrap();
    }
}
