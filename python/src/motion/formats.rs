//! Formats of files with records, and names of units and baselines.

use std::path::PathBuf;

use basemat::motion::{
    AccelerationUnit, Baseline, ColumnFormat, CosmosFormat, KNetFormat, PeerFormat, Record,
    RecordFormat,
};
use pyo3::prelude::*;

use crate::error::{OrRaise, refuse};

/// A unit of acceleration by its symbol.
pub(super) fn unit(symbol: &str) -> PyResult<AccelerationUnit> {
    symbol.parse().or_raise()
}

/// A treatment of the baseline by its name, which may hold a degree of its own.
pub(super) fn baseline(name: &str, degree: usize) -> PyResult<Baseline> {
    let alone = name.parse::<Baseline>();
    alone.or_else(|error| format!("{name}({degree})").parse().map_err(|_| error)).or_raise()
}

/// Reads a file; the arguments are those of `Record.read`.
pub(super) fn read(
    path: PathBuf,
    format: &str,
    unit_symbol: Option<&str>,
    time_step: Option<f64>,
    columns: Option<[usize; 2]>,
    channel: Option<usize>,
) -> PyResult<Record> {
    let needs_unit =
        || unit(unit_symbol.ok_or_else(|| refuse("a file of columns has no unit: give `unit`"))?);
    let reader: Box<dyn RecordFormat> = match format {
        "columns" => {
            let columns = columns.unwrap_or([1, 2]);
            Box::new(match time_step {
                Some(step) => {
                    let format = ColumnFormat::equally_spaced(needs_unit()?, step);
                    let other = (columns != [1, 2]).then_some(columns[1]);
                    ColumnFormat { acceleration_column: other, ..format }
                }
                None => ColumnFormat {
                    time_column: columns[0],
                    acceleration_column: Some(columns[1]),
                    ..ColumnFormat::new(needs_unit()?)
                },
            })
        }
        "peer" => Box::new(PeerFormat),
        "cosmos" => {
            let mut format = CosmosFormat::default();
            if let Some(channel) = channel {
                format.channel = channel;
            }
            if let Some(symbol) = unit_symbol {
                format.unit = Some(unit(symbol)?);
            }
            Box::new(format)
        }
        "k-net" => Box::new(KNetFormat),
        _ => {
            return Err(refuse(format!(
                "format is '{format}', but must be 'columns', 'peer', 'cosmos' or 'k-net'"
            )));
        }
    };
    Record::read(path, reader.as_ref()).or_raise()
}
