//! The trait of file formats, and records read by it.

use std::io::Read;
use std::path::Path;

use super::{AccelerationUnit, ColumnFormat, Record};
use crate::error::{Error, RecordError, Result};

/// A file format that holds a record; implement it for one of your own.
///
/// The crate's formats are [`ColumnFormat`](super::ColumnFormat), [`PeerFormat`](super::PeerFormat)
/// (`.AT2`), [`CosmosFormat`](super::CosmosFormat) (`.V2`) and
/// [`KNetFormat`](super::KNetFormat).
#[auto_impl::auto_impl(Box)]
pub trait RecordFormat {
    /// Reads the record; `name` is what errors call the file.
    ///
    /// # Errors
    /// [`Error::Record`](crate::Error::Record) with the line and the reason, or
    /// [`Error::part`](crate::Error::part) for a reason of a format of your own.
    fn parse(&self, name: &str, source: &mut dyn Read) -> Result<Record>;
}

impl Record {
    /// Reads a file: [`ColumnFormat`](super::ColumnFormat) for columns of time and acceleration,
    /// [`PeerFormat`](super::PeerFormat) for `.AT2`, or any other [`RecordFormat`].
    ///
    /// # Errors
    /// [`Error::Record`] with the line and the reason.
    pub fn read(path: impl AsRef<Path>, format: &dyn RecordFormat) -> Result<Self> {
        let path = path.as_ref();
        let name = path.display().to_string();
        match std::fs::File::open(path) {
            Ok(file) => Self::from_reader(&name, file, format),
            Err(error) => Err(Error::Record {
                file: name,
                line: 0,
                reason: RecordError::Unreadable(error.kind()),
            }),
        }
    }

    /// Reads the same from any source of bytes; `name` is what errors call it.
    ///
    /// ```
    /// use basemat::motion::{AccelerationUnit, ColumnFormat, Record};
    /// let text = "# station 1\nt,a\n0.00, 0\n0.01, 98.1\n0.02, -49.05\n";
    /// let format = ColumnFormat::new(AccelerationUnit::Gal);
    /// let record = Record::from_reader("text", text.as_bytes(), &format)?;
    /// assert_eq!(record.time_step(), 0.01);
    /// assert!((record.peak_acceleration() - 0.981).abs() < 1e-15);
    /// # Ok::<(), basemat::Error>(())
    /// ```
    ///
    /// # Errors
    /// [`Error::Record`] with the line and the reason.
    pub fn from_reader(
        name: &str,
        mut source: impl Read,
        format: &dyn RecordFormat,
    ) -> Result<Self> {
        format.parse(name, &mut source)
    }
}

const TEXT: &str = include_str!("../../data/elcentro1940_NS_peknold_0319g.csv");

/// El Centro 1940-05-18, component North–South, in the version of textbooks.
///
/// 1560 samples every 0.02 s, peak 0.31882 g at 2.04 s: the digitisation by Peknold, as tabulated
/// in Chopra, *Dynamics of Structures*, Appendix 6. No baseline treatment: it ends with a
/// velocity of 0.0007 m/s and a displacement of −5 mm.
///
/// ```
/// let record = basemat::motion::el_centro_1940();
/// assert_eq!(record.len(), 1560);
/// assert!((record.peak_acceleration() - 0.31882 * 9.80665).abs() < 1e-12);
/// ```
#[expect(clippy::missing_panics_doc, reason = "the embedded text is read by the tests")]
pub fn el_centro_1940() -> Record {
    let format = ColumnFormat::new(AccelerationUnit::StandardGravity).with_samples(1560);
    Record::from_reader("El Centro 1940", TEXT.as_bytes(), &format)
        .expect("the embedded record is valid")
}
