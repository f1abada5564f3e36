//! The choices of a reading, as command line.

use basemat::fem::QuadFormulation;
use clap::{Args, ValueEnum};

use basemat_problems::containment::{Containment, METRES_PER_FOOT};

/// One reading.
#[derive(Debug, Clone, PartialEq, Args)]
#[allow(clippy::struct_excessive_bools, reason = "each is a flag of the command line")]
pub(crate) struct PaperReading {
    /// Interface.
    #[arg(long, value_enum, default_value = "layer")]
    pub(crate) law: InterfaceReading,
    /// Time scheme of the structure.
    #[arg(long, value_enum, default_value = "newmark")]
    pub(crate) scheme: SchemeReading,
    /// Pressure that limits friction.
    #[arg(long, value_enum, default_value = "total")]
    pub(crate) limit: LimitReading,
    /// Rule for the sense of slip.
    #[arg(long, value_enum, default_value = "inelastic")]
    pub(crate) sense: SlipSenseReading,
    /// Fraction of the shear stiffness left in slip.
    #[arg(long, default_value_t = 0.0)]
    pub(crate) slip_shear: f64,
    /// Fraction of the normal stiffness left in slip.
    #[arg(long, default_value_t = 1.0)]
    pub(crate) slip_normal: f64,
    /// Fraction of the stiffness left in debonding.
    #[arg(long, default_value_t = 1e-3)]
    pub(crate) debonded: f64,
    /// Thickness of the layer over the height of the element beside it.
    #[arg(long, default_value_t = 0.1)]
    pub(crate) ratio: f64,
    /// Height of the element beside the layer, ft; by default a layer of the mesh.
    #[arg(long)]
    pub(crate) neighbour: Option<f64>,
    /// Fraction of the static pressure that counts for friction, with `--limit lagged`.
    #[arg(long, default_value_t = 1.0)]
    pub(crate) static_share: f64,
    /// Modes by the end of the step before, without iteration.
    #[arg(long)]
    pub(crate) lag_modes: bool,
    /// Gravity over standard gravity: pressures under weight are multiplied, friction is not.
    #[arg(long, default_value_t = 1.0)]
    pub(crate) gravity: f64,
    /// Factor on all friction coefficients, without effect on the weight.
    #[arg(long, default_value_t = 1.0)]
    pub(crate) friction_factor: f64,
    /// Read μσ of eq. 12 as the force at a node, without the element's length in ft.
    #[arg(long)]
    pub(crate) length_left_out: bool,
    /// Kinetic friction relative to static friction.
    #[arg(long, default_value_t = 1.0)]
    pub(crate) kinetic: f64,
    /// Add the free field's `[K]{δ}` to the forces, as eq. 21 is printed.
    #[arg(long)]
    pub(crate) printed_forcing: bool,
    /// Elements along the base.
    #[arg(long, default_value_t = 10)]
    pub(crate) elements: usize,
    /// Contact length, ft (the default is calibrated on Table 1's first two rows).
    #[arg(long, default_value_t = 34.0)]
    pub(crate) width: f64,
    /// Height, ft (also calibrated).
    #[arg(long, default_value_t = 80.0)]
    pub(crate) height: f64,
    /// Factor on the foundation's density.
    #[arg(long, default_value_t = 1.0)]
    pub(crate) foundation_density: f64,
    /// Factor on the record.
    #[arg(long, default_value_t = 1.0)]
    pub(crate) record: f64,
    /// Soil density, slug/ft³ (assumed).
    #[arg(long, default_value_t = 3.5)]
    pub(crate) soil_density: f64,
    /// Damping ratio of the structure at 1 and 10 Hz (Rayleigh).
    #[arg(long, default_value_t = 0.0)]
    pub(crate) damping: f64,
    /// Newmark's gamma; beta = (gamma + 1/2)²/4.
    #[arg(long, default_value_t = 0.5)]
    pub(crate) gamma: f64,
    /// Elements integrated at their centre: constant strain, as the paper says.
    #[arg(long)]
    pub(crate) one_point: bool,
    /// End a case where the paper's flow chart does not converge (instead of counting such steps).
    #[arg(long)]
    pub(crate) flow_chart: bool,
    /// Seconds to compute.
    #[arg(long, default_value_t = 12.0)]
    pub(crate) duration: f64,
    /// Rows of the table: 0 bonded, 1 uplift only, 2 to 4 friction.
    #[arg(long, value_delimiter = ',', default_value = "0,1,2,3,4")]
    pub(crate) rows: Vec<usize>,
}

#[derive(Debug, Clone, Copy, PartialEq, ValueEnum)]
pub(crate) enum InterfaceReading {
    /// Thin layer.
    Layer,
    /// Hard contact.
    Hard,
}

#[derive(Debug, Clone, Copy, PartialEq, ValueEnum)]
pub(crate) enum SchemeReading {
    Newmark,
    Hht,
    Midpoint,
}

#[derive(Debug, Clone, Copy, PartialEq, ValueEnum)]
pub(crate) enum LimitReading {
    Total,
    Lagged,
    Static,
    /// Magnitude of the dynamic pressure, lagged.
    Dynamic,
    /// Dynamic pressure where it compresses, lagged.
    Compression,
    /// Mean static pressure under full gravity.
    Weight,
}

#[derive(Debug, Clone, Copy, PartialEq, ValueEnum)]
pub(crate) enum SlipSenseReading {
    Inelastic,
    Velocity,
    LastVelocity,
}

impl PaperReading {
    /// The model of the reading.
    pub(crate) fn containment(&self) -> Containment {
        let paper = Containment::default();
        Containment {
            width: self.width,
            height: self.height,
            elements: self.elements,
            formulation: if self.one_point {
                QuadFormulation::OnePoint
            } else {
                QuadFormulation::Full
            },
            foundation_density: paper.foundation_density * self.foundation_density,
            damping: self.damping,
            soil_density: self.soil_density,
            ..paper
        }
    }

    /// Factor on the coefficients of friction.
    pub(crate) fn friction_ratio(&self) -> f64 {
        let length = if self.length_left_out { self.width / self.elements as f64 } else { 1.0 };
        self.friction_factor / length
    }

    /// Height of the element beside the thin layer, m.
    pub(crate) fn neighbour_height(&self) -> f64 {
        self.neighbour
            .map_or_else(|| self.containment().layer_height(), |feet| feet * METRES_PER_FOOT)
    }
}
