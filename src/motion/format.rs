//! What a reader of a file format has to do.

use std::io::Read;

use super::Record;
use crate::error::Result;

/// A file format that holds a record; implement it for one of your own.
///
/// The crate's formats are [`ColumnFormat`](super::ColumnFormat), [`PeerFormat`](super::PeerFormat)
/// (`.AT2`), [`CosmosFormat`](super::CosmosFormat) (`.V2`) and
/// [`KNetFormat`](super::KNetFormat).
pub trait RecordFormat {
    /// Reads the record; `name` is what errors call the file.
    ///
    /// # Errors
    /// [`Error::Record`](crate::Error::Record) with the line and the reason, or
    /// [`Error::part`](crate::Error::part) for a reason of a format of your own.
    fn parse(&self, name: &str, source: &mut dyn Read) -> Result<Record>;
}

impl<T: RecordFormat + ?Sized> RecordFormat for Box<T> {
    forward! {
        (**self);
        fn parse(&self, name: &str, source: &mut dyn Read) -> Result<Record>;
    }
}
