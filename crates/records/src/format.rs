//! The trait of file formats, and records read by it.

use std::io::Read;
use std::path::Path;

use super::Record;
use crate::error::Result;
use crate::text::file::open_file;

/// A file format of records; implement it for other formats.
///
/// The crate's formats are [`ColumnFormat`](super::ColumnFormat),
/// [`AlongLinesFormat`](super::AlongLinesFormat) (SHAKE), [`PeerFormat`](super::PeerFormat) (`.AT2`),
/// [`SlistFormat`](super::SlistFormat) (ObsPy), [`CosmosFormat`](super::CosmosFormat) (`.V2`, COSMOS and CSMIP),
/// [`KNetFormat`](super::KNetFormat), [`KNetCsvFormat`](super::KNetCsvFormat),
/// [`EsmFormat`](super::EsmFormat), [`AfadFormat`](super::AfadFormat),
/// [`SmcFormat`](super::SmcFormat) and [`GeoNetFormat`](super::GeoNetFormat).
#[auto_impl::auto_impl(Box)]
pub trait RecordFormat {
    /// Reads the record; errors call the file `name`.
    ///
    /// # Errors
    /// [`Error::File`](crate::Error::File) with the line and the reason, or
    /// [`Error::part`](crate::Error::part) for another reason.
    fn parse(&self, name: &str, source: &mut dyn Read) -> Result<Record>;

    /// Reads all components of a file with their names.
    ///
    /// Default: the record of [`parse`](Self::parse), without a name.
    ///
    /// # Errors
    /// As for [`parse`](Self::parse).
    fn parse_all(&self, name: &str, source: &mut dyn Read) -> Result<Vec<(String, Record)>> {
        Ok(vec![(String::new(), self.parse(name, source)?)])
    }
}

/// Implements [`RecordFormat`] by the module's `read(lines)`, which returns the one component of a file.
macro_rules! read_one_component {
    ($format:ty) => {
        impl crate::RecordFormat for $format {
            fn parse(
                &self,
                name: &str,
                source: &mut dyn std::io::Read,
            ) -> crate::Result<crate::Record> {
                crate::series::to_record(name, read(&mut crate::lines::Lines::new(source)))
            }

            fn parse_all(
                &self,
                name: &str,
                source: &mut dyn std::io::Read,
            ) -> crate::Result<Vec<(String, crate::Record)>> {
                let component = read(&mut crate::lines::Lines::new(source));
                crate::series::to_records(name, component.map(|series| vec![series]))
            }
        }
    };
}

/// Implements [`RecordFormat`] by the module's `read(lines)`, which returns all components of a file.
///
/// The format's field `component` is the number, counted from 1, of the component that `parse` returns.
macro_rules! read_components {
    ($format:ty) => {
        impl crate::RecordFormat for $format {
            fn parse(
                &self,
                name: &str,
                source: &mut dyn std::io::Read,
            ) -> crate::Result<crate::Record> {
                let components = read(&mut crate::lines::Lines::new(source));
                let component = crate::series::select_component(self.component, components);
                crate::series::to_record(name, component)
            }

            fn parse_all(
                &self,
                name: &str,
                source: &mut dyn std::io::Read,
            ) -> crate::Result<Vec<(String, crate::Record)>> {
                crate::series::to_records(name, read(&mut crate::lines::Lines::new(source)))
            }
        }
    };
}

pub(super) use {read_components, read_one_component};

impl Record {
    /// Reads a record from a file.
    ///
    /// Formats: [`ColumnFormat`](super::ColumnFormat) for columns of time and acceleration,
    /// [`AlongLinesFormat`](super::AlongLinesFormat) for several values on a line,
    /// [`PeerFormat`](super::PeerFormat) for `.AT2`, or any other [`RecordFormat`].
    ///
    /// # Errors
    /// [`Error::File`](crate::Error::File) with the line and the reason.
    pub fn read(path: impl AsRef<Path>, format: &dyn RecordFormat) -> Result<Self> {
        let path = path.as_ref();
        format.parse(&path.display().to_string(), &mut open_file(path)?)
    }

    /// Reads all components of a file with their names, such as `N-S`, `E-W` and `U-D`.
    ///
    /// For formats that hold several components.
    ///
    /// ```
    /// use basemat::motion::{AccelerationUnit, ColumnFormat, Record};
    /// # let path = std::env::temp_dir().join("basemat_read_all.txt");
    /// # std::fs::write(&path, "t NS EW UD\n0.00 1 2 3\n0.01 4 5 6\n").unwrap();
    /// let format = ColumnFormat::new(AccelerationUnit::Gal);
    /// let station = Record::read_all(&path, &format)?;
    /// assert_eq!(station[1].0, "EW");
    /// assert_eq!(station[1].1.accelerations(), [0.02, 0.05]);
    /// # Ok::<(), basemat::Error>(())
    /// ```
    ///
    /// # Errors
    /// [`Error::File`](crate::Error::File) with the line and the reason.
    pub fn read_all(
        path: impl AsRef<Path>,
        format: &dyn RecordFormat,
    ) -> Result<Vec<(String, Self)>> {
        let path = path.as_ref();
        format.parse_all(&path.display().to_string(), &mut open_file(path)?)
    }

    /// Reads a record from any source of bytes; errors call it `name`.
    ///
    /// ```
    /// use basemat::motion::{AccelerationUnit, ColumnFormat, Record};
    /// let text = "# station 1\nt,a\n0.00, 0\n0.01, 98.1\n0.02, -49.05\n";
    /// let format = ColumnFormat::new(AccelerationUnit::Gal);
    /// let record = Record::from_reader("text", text.as_bytes(), &format)?;
    /// assert_eq!(record.time_step(), 0.01);
    /// assert!((record.peaks().acceleration - 0.981).abs() < 1e-15);
    /// # Ok::<(), basemat::Error>(())
    /// ```
    ///
    /// # Errors
    /// [`Error::File`](crate::Error::File) with the line and the reason.
    pub fn from_reader(
        name: &str,
        mut source: impl Read,
        format: &dyn RecordFormat,
    ) -> Result<Self> {
        format.parse(name, &mut source)
    }
}
