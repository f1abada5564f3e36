//! Records as CSV.

use std::io::{self, Write};
use std::path::Path;

use super::Record;
use crate::error::{Result, write_file};
use crate::text::column::{Cell, line};

impl Record {
    /// Writes the CSV of [`Record::write_csv`] to a file; its folder is made if it is not there.
    ///
    /// # Errors
    /// [`Error::Write`](crate::Error::Write) if that fails.
    pub fn save_csv(&self, path: impl AsRef<Path>) -> Result<()> {
        let mut text = Vec::new();
        // Writing to memory cannot fail.
        let _ = self.write_csv(&mut text);
        write_file(path.as_ref(), text)
    }

    /// Writes time and acceleration as CSV: a heading and a line for every sample, with all digits, so
    /// that [`ColumnFormat`](super::ColumnFormat) reads the same record to the last bit.
    ///
    /// ```
    /// use basemat::motion::{AccelerationUnit, ColumnFormat, Record};
    /// let record = Record::new(1.0 / 3.0, vec![0.0, 0.1, -2.5])?;
    /// let mut text = Vec::new();
    /// record.write_csv(&mut text).unwrap();
    /// assert!(text.starts_with(b"time_s,acceleration_m_per_s2\n0.0,0.0\n0.3333333333333333,0.1\n"));
    /// let format = ColumnFormat::new(AccelerationUnit::MetrePerSecondSquared);
    /// assert_eq!(Record::from_reader("text", &text[..], &format)?, record);
    /// # Ok::<(), basemat::Error>(())
    /// ```
    ///
    /// # Errors
    /// Those of `out`.
    pub fn write_csv(&self, out: &mut dyn Write) -> io::Result<()> {
        writeln!(out, "time_s,acceleration_m_per_s2")?;
        for (k, acceleration) in self.accelerations().iter().enumerate() {
            let time = k as f64 * self.time_step();
            out.write_all(line([time, *acceleration].map(Cell)).as_bytes())?;
        }
        Ok(())
    }
}
