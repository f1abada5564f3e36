//! Collections of grids: `.pvd` files.

use std::fmt::Write;
use std::path::Path;

use crate::error::{Result, require_part};
use crate::text::file::{write_error, write_file};

/// Makes the folder of a series; returns an error for a name that a file cannot have.
pub(super) fn prepare_folder(folder: &Path, name: &str) -> Result<()> {
    let is_valid_name = !name.is_empty() && name.chars().all(is_allowed_in_name);
    require_part("name of a series", is_valid_name, "letters, digits, - and _ only, one at least")?;
    std::fs::create_dir_all(folder).map_err(write_error(folder))
}

/// Whether the name of a series may contain a character.
fn is_allowed_in_name(character: char) -> bool {
    character.is_alphanumeric() || character == '-' || character == '_'
}

/// Entry of a grid in a collection.
#[derive(Debug)]
pub(super) struct CollectionEntry {
    /// Time of the grid, s.
    pub(super) time: f64,
    /// 0 for the structure, 1 for the base.
    pub(super) part: usize,
    /// Name of the grid's file.
    pub(super) file_name: String,
}

/// Text of a `.pvd` file with these grids.
fn collection_text(entries: &[CollectionEntry]) -> String {
    let mut xml_text = String::from(
        "<?xml version=\"1.0\"?>\n\
         <VTKFile type=\"Collection\" version=\"0.1\" byte_order=\"LittleEndian\">\n<Collection>\n",
    );
    for CollectionEntry { time, part, file_name } in entries {
        // Writing to a string does not fail.
        let _ = writeln!(
            xml_text,
            "<DataSet timestep=\"{time}\" group=\"\" part=\"{part}\" file=\"{file_name}\"/>"
        );
    }
    xml_text + "</Collection>\n</VTKFile>\n"
}

/// Writes the collection of a series.
pub(super) fn write_collection(
    folder: &Path,
    name: &str,
    entries: &[CollectionEntry],
) -> Result<()> {
    write_file(&folder.join(format!("{name}.pvd")), collection_text(entries))
}
