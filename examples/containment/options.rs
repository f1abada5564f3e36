//! Command line, with everything in the paper's units.

use std::path::PathBuf;

use basemat::fem::QuadFormulation;
use basemat::motion::{AccelerationUnit, Baseline, ColumnFormat, Record, el_centro_1940};
use basemat::results::Serviceability;
use clap::{Parser, ValueEnum};

use super::AnyError;
use super::containment::Containment;

/// El Centro on a containment that may uplift and slide (Patel & Spyrakos).
///
/// Runs the bonded, the uplift-only and the sliding cases, prints a table, and writes summary.csv,
/// one CSV of histories per case, and SVG plots.
#[derive(Debug, Clone, Parser)]
pub(crate) struct Options {
    /// Folder for the files.
    #[arg(long, default_value = "target/containment")]
    pub(crate) out: PathBuf,
    /// Ground acceleration: a text file with time (s) and acceleration columns. El Centro 1940 NS
    /// unless given.
    #[arg(long)]
    record: Option<PathBuf>,
    /// Unit of the accelerations in --record.
    #[arg(long, value_enum, default_value = "g")]
    unit: Unit,
    /// Baseline treatment of the record.
    #[arg(long, value_enum, default_value = "none")]
    baseline: Treatment,
    /// Seconds to compute; the whole record unless given.
    #[arg(long, value_parser = positive)]
    duration: Option<f64>,
    /// Friction coefficients of the sliding cases.
    #[arg(long, value_delimiter = ',', default_value = "0.4,0.3,0.2")]
    pub(crate) friction: Vec<f64>,
    /// Contact length, ft (the paper's figure is lost: calibrated on Table 1's first two rows).
    #[arg(long = "width", default_value_t = 34.0, value_parser = positive)]
    pub(crate) width_ft: f64,
    /// Height, ft (calibrated as the contact length is).
    #[arg(long = "height", default_value_t = 80.0, value_parser = positive)]
    pub(crate) height_ft: f64,
    /// Layers of elements, the lowest of them the basemat (which of them it is, is an assumption).
    #[arg(long, default_value_t = 13, value_parser = clap::value_parser!(u16).range(2..=200))]
    layers: u16,
    /// Elements along the base.
    #[arg(long, default_value_t = 10, value_parser = clap::value_parser!(u16).range(1..=400))]
    elements: u16,
    /// How the rectangles are integrated.
    #[arg(long, value_enum, default_value = "full")]
    quadrilateral: Quadrilateral,
    /// Hourglass stiffness in percent of full integration's, with --quadrilateral hourglass.
    #[arg(long, default_value_t = 5)]
    hourglass: u8,
    /// Also compute 15 elements along the base: peaks and time series beside those of 10.
    #[arg(long)]
    pub(crate) meshes: bool,
    /// Also compute friction from 0.05 to 0.8: 16 runs, about four times as long.
    #[arg(long)]
    pub(crate) sweep: bool,
    /// Allowable slip of the base, mm.
    #[arg(long, default_value_t = 25.0, value_parser = positive)]
    allowable_slip: f64,
    /// Allowable gap under the base, mm.
    #[arg(long, default_value_t = 10.0, value_parser = positive)]
    allowable_gap: f64,
    /// Allowable uplifted part of the base, percent.
    #[arg(long, default_value_t = 75.0, value_parser = positive)]
    allowable_uplift: f64,
    /// Allowable rotation of the base, mrad.
    #[arg(long, default_value_t = 2.0, value_parser = positive)]
    allowable_rotation: f64,
    /// Shear wave speed of the soil, ft/s.
    #[arg(long = "shear-speed", default_value_t = 650.0, value_parser = positive)]
    pub(crate) shear_speed_fts: f64,
    /// Pressure wave speed of the soil, ft/s.
    #[arg(long = "pressure-speed", default_value_t = 1300.0, value_parser = positive)]
    pub(crate) pressure_speed_fts: f64,
    /// Density of the soil, slug/ft³ (not printed in the paper: assumed).
    #[arg(long = "soil-density", default_value_t = 3.5, value_parser = positive)]
    soil_density: f64,
    /// Damping ratio of the structure at 1 and 10 Hz (Rayleigh).
    #[arg(long, default_value_t = 0.0, value_parser = not_negative)]
    damping: f64,
    /// Time step, ms; half an element's length over the pressure wave speed unless given.
    #[arg(long = "time-step", value_parser = positive)]
    time_step_ms: Option<f64>,
}

#[derive(Debug, Clone, Copy, ValueEnum)]
enum Unit {
    /// Standard gravity.
    G,
    /// m/s².
    Si,
    /// cm/s².
    Gal,
    /// ft/s².
    Ft,
}

#[derive(Debug, Clone, Copy, ValueEnum)]
enum Treatment {
    /// As it is.
    None,
    /// Ends at rest where it began.
    RestToRest,
}

#[derive(Debug, Clone, Copy, ValueEnum)]
enum Quadrilateral {
    /// Two by two Gauss points.
    Full,
    /// With incompatible modes, good in bending.
    Incompatible,
    /// One point, constant strain, as the paper says: without resistance to hourglass patterns.
    OnePoint,
    /// One point and some hourglass stiffness, see --hourglass.
    Hourglass,
}

impl Options {
    /// The record, in m/s².
    pub(crate) fn record(&self) -> Result<Record, AnyError> {
        let record = match &self.record {
            None => el_centro_1940(),
            Some(path) => {
                let unit = match self.unit {
                    Unit::G => AccelerationUnit::StandardGravity,
                    Unit::Si => AccelerationUnit::MetrePerSecondSquared,
                    Unit::Gal => AccelerationUnit::Gal,
                    Unit::Ft => AccelerationUnit::FootPerSecondSquared,
                };
                Record::read(path, &ColumnFormat::new(unit))?
            }
        };
        Ok(match self.baseline {
            Treatment::None => record,
            Treatment::RestToRest => record.with_baseline(Baseline::RestToRest { degree: 5 })?,
        })
    }

    /// What is to be built.
    pub(crate) fn containment(&self) -> Containment {
        Containment {
            width: self.width_ft,
            height: self.height_ft,
            layers: usize::from(self.layers),
            elements: usize::from(self.elements),
            formulation: match self.quadrilateral {
                Quadrilateral::Full => QuadFormulation::Full,
                Quadrilateral::Incompatible => QuadFormulation::IncompatibleModes,
                Quadrilateral::OnePoint => QuadFormulation::OnePoint,
                Quadrilateral::Hourglass => QuadFormulation::Hourglass { percent: self.hourglass },
            },
            damping: self.damping,
            wave_speeds: [self.shear_speed_fts, self.pressure_speed_fts],
            soil_density: self.soil_density,
            ..Containment::default()
        }
    }

    /// Limits of service.
    pub(crate) fn limits(&self) -> basemat::Result<Serviceability> {
        Serviceability::new()
            .with_slip(1e-3 * self.allowable_slip)?
            .with_gap(1e-3 * self.allowable_gap)?
            .with_uplifted_fraction(0.01 * self.allowable_uplift)?
            .with_rotation(1e-3 * self.allowable_rotation)
    }

    /// The same on so many elements along the base.
    pub(crate) fn on_elements(&self, elements: u16) -> Self {
        Self { elements, ..self.clone() }
    }

    /// The paper's step, unless another is given: a P wave crosses half an element.
    pub(crate) fn time_step_s(&self) -> f64 {
        self.time_step_ms.map_or_else(|| self.containment().time_step(0.5), |ms| 1e-3 * ms)
    }

    /// Steps of a run.
    pub(crate) fn steps(&self, record: &Record) -> usize {
        let duration = self.duration.unwrap_or_else(|| record.duration());
        #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "above zero")]
        let steps = (duration / self.time_step_s()).round().max(1.0) as usize;
        steps
    }
}

fn positive(text: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(value) if value.is_finite() && value > 0.0 => Ok(value),
        _ => Err("must be a number above zero".into()),
    }
}

fn not_negative(text: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(value) if value.is_finite() && value >= 0.0 => Ok(value),
        _ => Err("must be a number, zero or more".into()),
    }
}
