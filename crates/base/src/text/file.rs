//! Opens files, and writes them completely or not at all.

use std::fs::File;
use std::hash::{BuildHasher, Hasher, RandomState};
use std::io::Write;
use std::path::Path;

use crate::error::{Error, FileFault, Result};

/// Function that converts a system error to the error for a file that cannot be written.
pub fn write_error(path: &Path) -> impl Fn(std::io::Error) -> Error {
    move |error| FileFault::Unwritable(error.kind()).of(path.display().to_string(), 0)
}

/// Opens a file for reading.
pub fn open_file(path: &Path) -> Result<File> {
    File::open(path)
        .map_err(|error| FileFault::Unreadable(error.kind()).of(path.display().to_string(), 0))
}

/// Replaces the content of a file; if the replacement fails, the file is unchanged.
pub fn replace_file(path: &Path, content: &[u8]) -> std::io::Result<()> {
    // A symbolic link is followed, so that it stays a link. Pipes and terminals cannot be replaced by a renamed file.
    let path = path.canonicalize().unwrap_or_else(|_| path.to_owned());
    if path.exists() && !path.is_file() {
        return std::fs::write(&path, content);
    }
    // Random keys differ between threads and machines; forked processes share keys, but not process numbers.
    let mut hasher = RandomState::new().build_hasher();
    hasher.write_u32(std::process::id());
    let suffix = hasher.finish();
    let mut temporary_path = path.as_os_str().to_owned();
    temporary_path.push(format!(".{suffix:016x}.tmp"));
    let result = write_and_sync(Path::new(&temporary_path), content)
        .and_then(|()| std::fs::rename(&temporary_path, &path));
    if result.is_err() {
        let _ = std::fs::remove_file(&temporary_path);
    }
    result
}

/// Writes a new file, and returns when its content is on the disk.
fn write_and_sync(path: &Path, content: &[u8]) -> std::io::Result<()> {
    let mut file = File::create(path)?;
    file.write_all(content)?;
    file.sync_all()
}

/// Creates the folder of a file if it does not exist.
pub fn make_folder_of(path: &Path) -> Result<()> {
    path.parent().map_or(Ok(()), std::fs::create_dir_all).map_err(write_error(path))
}

/// Writes a file by [`replace_file`], and creates its folder if necessary.
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
    fn errors_of_writing_name_the_file_and_remove_temporary_files() {
        let folder = folder("unwritten");
        let path_below_file = folder.join("file").join("below");
        write_file(&folder.join("file"), "whole").unwrap();
        for path in [path_below_file, folder.clone()] {
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
    fn links_stay_links_and_devices_are_written_to() {
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
