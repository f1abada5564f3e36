//! GOAL: ground-motion records, their files, baselines, spectra and free fields.
//! SCENE: El Centro 1940, pulses, and any samples.
//! REFERENCE: published values, closed forms, independent integrations.

mod agency_files;
mod along_lines;
mod baselines;
mod filters;
mod free_fields;
mod fuzz;
mod inclined_waves;
mod motion_formats;
mod motion_reader;
mod odd_columns;
mod odd_files;
mod odd_headers;
mod odd_titles;
mod parts_and_files;
mod records;
mod response_spectrum;
mod stated_twice;

use basemat::motion::{Record, RecordFormat};
use basemat::{Error, FileError, FileFault};

/// Line and reason of a text's refusal.
#[track_caller]
fn refusal(text: &(impl AsRef<[u8]> + ?Sized), format: &dyn RecordFormat) -> (usize, FileFault) {
    match Record::from_reader("text", text.as_ref(), format) {
        Err(Error::File(FileError { file, line, fault })) => {
            assert_eq!(file, "text");
            (line, fault)
        }
        other => panic!("{other:?}"),
    }
}
