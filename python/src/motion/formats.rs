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
    Ok(match symbol {
        "m/s²" | "m/s2" | "m/s^2" => AccelerationUnit::MetrePerSecondSquared,
        "mm/s²" | "mm/s2" | "mm/s^2" => AccelerationUnit::MillimetrePerSecondSquared,
        "g" => AccelerationUnit::StandardGravity,
        "gal" | "Gal" | "cm/s²" | "cm/s2" | "cm/s^2" => AccelerationUnit::Gal,
        "ft/s²" | "ft/s2" | "ft/s^2" => AccelerationUnit::FootPerSecondSquared,
        "in/s²" | "in/s2" | "in/s^2" => AccelerationUnit::InchPerSecondSquared,
        _ => {
            return Err(refuse(format!(
                "unit is '{symbol}', but must be 'm/s²', 'mm/s²', 'g', 'gal', 'ft/s²' or 'in/s²'"
            )));
        }
    })
}

/// A treatment of the baseline by its name.
pub(super) fn baseline(name: &str, degree: usize) -> PyResult<Baseline> {
    Ok(match name {
        "none" => Baseline::None,
        "remove mean" => Baseline::RemoveMean,
        "newmark parabola" => Baseline::NewmarkParabola,
        "velocity polynomial" => Baseline::VelocityPolynomial { degree },
        "displacement polynomial" => Baseline::DisplacementPolynomial { degree },
        "rest to rest" => Baseline::RestToRest { degree },
        _ => {
            return Err(refuse(format!(
                "baseline is '{name}', but must be 'none', 'remove mean', 'newmark parabola', \
                 'velocity polynomial', 'displacement polynomial' or 'rest to rest'"
            )));
        }
    })
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
                    if columns == [1, 2] {
                        format
                    } else {
                        format.with_acceleration_column(columns[1])
                    }
                }
                None => ColumnFormat::new(needs_unit()?).with_columns(columns[0], columns[1]),
            })
        }
        "peer" => Box::new(PeerFormat),
        "cosmos" => {
            let mut format = CosmosFormat::default();
            if let Some(channel) = channel {
                format = format.with_channel(channel);
            }
            if let Some(symbol) = unit_symbol {
                format = format.with_unit(unit(symbol)?);
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
