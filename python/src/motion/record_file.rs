//! Options of a file of a record, and its reader.

use basemat::motion::{
    AccelerationUnit, AfadFormat, AlongLinesFormat, ColumnFormat, CosmosFormat, EsmFormat,
    GeoNetFormat, KNetCsvFormat, KNetFormat, PeerFormat, RecordFormat, SlistFormat, SmcFormat,
};
use pyo3::prelude::*;

use crate::error::{OrRaise, input_error};

/// Options of `Record.read` other than path and format; `None` for options that are not given.
#[derive(Default)]
pub(super) struct FileOptions<'a> {
    pub(super) unit: Option<&'a str>,
    pub(super) time_step: Option<f64>,
    pub(super) columns: Option<[usize; 2]>,
    pub(super) channel: Option<usize>,
    pub(super) header_lines: Option<usize>,
    pub(super) samples: Option<usize>,
    pub(super) layout: Option<&'a str>,
}

impl FileOptions<'_> {
    /// The reader of the format with this name; an error for options that the format does not have.
    pub(super) fn reader(&self, format: &str) -> PyResult<Box<dyn RecordFormat>> {
        use AccelerationUnit::{Gal, MillimetrePerSecondSquared, StandardGravity};
        let component = self.channel.unwrap_or(1);
        Ok(match format {
            "columns" => Box::new(self.column_format()?),
            "along_lines" => Box::new(self.along_lines_format()?),
            "slist" => {
                self.check_options(format, None, true)?;
                let unit = self.unit.map(unit_of).transpose()?;
                Box::new(SlistFormat { component, unit })
            }
            "cosmos" => {
                self.check_options(format, None, true)?;
                let unit = self.unit.map(unit_of).transpose()?;
                Box::new(CosmosFormat { channel: component, unit })
            }
            "peer" => self.fixed_unit_reader(format, StandardGravity, false, PeerFormat)?,
            "k_net" => self.fixed_unit_reader(format, Gal, false, KNetFormat)?,
            "k_net_csv" => {
                self.fixed_unit_reader(format, Gal, true, KNetCsvFormat { component })?
            }
            "esm" => self.fixed_unit_reader(format, Gal, false, EsmFormat)?,
            "afad" => self.fixed_unit_reader(format, Gal, true, AfadFormat { component })?,
            "smc" => self.fixed_unit_reader(format, Gal, false, SmcFormat)?,
            "geonet" => {
                let reader = GeoNetFormat { component };
                self.fixed_unit_reader(format, MillimetrePerSecondSquared, true, reader)?
            }
            _ => {
                return Err(input_error(format!(
                    "format is '{format}', but must be 'columns', 'along_lines', 'peer', 'cosmos', \
                     'k_net', 'k_net_csv', 'esm', 'afad', 'slist', 'smc' or 'geonet'"
                )));
            }
        })
    }

    /// Reader of a file of columns.
    fn column_format(&self) -> PyResult<ColumnFormat> {
        if self.channel.is_some() {
            return Err(input_error("a file of columns has no `channel`: give `columns`"));
        }
        if self.layout.is_some() {
            return Err(input_error(
                "a file of columns takes no `layout`: read format=\"along_lines\"",
            ));
        }
        let unit =
            self.unit.ok_or_else(|| input_error("a file of columns (the default format) has no unit: give `unit`, or the `format` of the file"))?;
        let format = ColumnFormat {
            header_lines: self.header_lines.unwrap_or(0),
            samples: self.samples,
            ..ColumnFormat::new(unit_of(unit)?)
        };
        Ok(match (self.time_step, self.columns) {
            (Some(time_step), columns) => ColumnFormat {
                time_step: Some(time_step),
                acceleration_column: columns.map(|[_, acceleration_column]| acceleration_column),
                ..format
            },
            (None, Some([time_column, acceleration_column])) => ColumnFormat {
                time_column,
                acceleration_column: Some(acceleration_column),
                ..format
            },
            (None, None) => format,
        })
    }

    /// Reader of a file with several values on a line.
    fn along_lines_format(&self) -> PyResult<AlongLinesFormat> {
        let option_presence =
            [("columns", self.columns.is_some()), ("channel", self.channel.is_some())];
        if let Some((name, _)) = option_presence.iter().find(|(_, is_present)| *is_present) {
            return Err(input_error(format!("values along lines have no `{name}`")));
        }
        let unit = self
            .unit
            .ok_or_else(|| input_error("a file of values along lines has no unit: give `unit`"))?;
        let time_step = self.time_step.ok_or_else(|| {
            input_error("a file of values along lines has no times: give `time_step`")
        })?;
        Ok(AlongLinesFormat {
            layout: self.layout.map(str::parse).transpose().or_raise()?,
            samples: self.samples,
            header_lines: self.header_lines.unwrap_or(0),
            ..AlongLinesFormat::new(unit_of(unit)?, time_step)
        })
    }

    /// The `reader` of a format whose files are in a fixed `unit`; an error for options that the format does not have.
    fn fixed_unit_reader(
        &self,
        format: &str,
        unit: AccelerationUnit,
        has_components: bool,
        reader: impl RecordFormat + 'static,
    ) -> PyResult<Box<dyn RecordFormat>> {
        self.check_options(format, Some(unit), has_components)?;
        Ok(Box::new(reader))
    }

    /// Error for options that files of a format do not take.
    ///
    /// `file_unit`: unit of all files of the format; `None` if files name it. `has_components`: whether a file may
    /// have several components.
    fn check_options(
        &self,
        format: &str,
        file_unit: Option<AccelerationUnit>,
        has_components: bool,
    ) -> PyResult<()> {
        let option_presence = [
            ("columns", self.columns.is_some()),
            ("time_step", self.time_step.is_some()),
            ("header_lines", self.header_lines.is_some()),
            ("samples", self.samples.is_some()),
            ("layout", self.layout.is_some()),
            ("channel", self.channel.is_some_and(|channel| !has_components && channel != 1)),
        ];
        if let Some((name, _)) = option_presence.iter().find(|(_, is_present)| *is_present) {
            return Err(input_error(format!("files of the format '{format}' take no `{name}`")));
        }
        match (self.unit, file_unit) {
            (Some(name), Some(file_unit)) if unit_of(name)? != file_unit => {
                Err(input_error(format!(
                    "unit is '{name}', but files of the format '{format}' are in {file_unit}: leave it out"
                )))
            }
            _ => Ok(()),
        }
    }
}

/// The unit of acceleration with this symbol.
pub(super) fn unit_of(symbol: &str) -> PyResult<AccelerationUnit> {
    symbol.parse().or_raise()
}
