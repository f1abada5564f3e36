//! Readings of the slip mode of Patel & Spyrakos, one at a time: which of them gives the paper's
//! peak base shears?
//!
//! ```text
//! cargo run --release --example paper_readings                     # a table of many
//! cargo run --release --example paper_readings -- --limit lagged   # one reading
//! ```
//!
//! The structure, the soil and the record are those of the example `containment`; law, time scheme,
//! and contact iteration are the paper's, as far as the options do not say otherwise.

use basemat::bem::HalfPlaneGround;
use basemat::coupled::{ContactSearch, HhtAlpha, Midpoint, Newmark, Probe, SimulationBuilder};
use basemat::fem::{Layer, Material, Mesh, QuadFormulation};
use basemat::interface::{
    Bonded, Condition, ContactState, Coulomb, FrictionLimit, InterfaceLaw, Mode, SlipSense,
    StepStart, ThinLayer, Tolerance,
};
use basemat::motion::{STANDARD_GRAVITY, el_centro_1940};
use basemat::structure::{FemModel, RayleighDamping};
use basemat::{Simulation, Soil};
use clap::{Parser, ValueEnum};

type AnyError = Box<dyn std::error::Error + Send + Sync>;

const FOOT: f64 = 0.3048;
const POUND_FORCE_PER_FOOT: f64 = 14.593_902_937_206_364;
const PSF: f64 = 47.880_258_980_335_84;
const SLUG_PER_CUBIC_FOOT: f64 = 515.378_818_393_229_5;

/// Peak base shears of the paper's Table 1, lb/ft: bonded, uplift only, friction 0.4, 0.3, 0.2.
const PAPER: [f64; 5] = [28_970.0, 20_130.0, 10_233.0, 6_415.0, 5_958.0];

/// One reading; without options, the table of all that were tried.
#[derive(Debug, Clone, Parser)]
struct Reading {
    /// Interface.
    #[arg(long, value_enum, default_value = "layer")]
    law: Law,
    /// Time scheme of the structure.
    #[arg(long, value_enum, default_value = "newmark")]
    scheme: Scheme,
    /// Pressure that limits friction.
    #[arg(long, value_enum, default_value = "total")]
    limit: Limit,
    /// What tells the sense of slip.
    #[arg(long, value_enum, default_value = "inelastic")]
    sense: Sense,
    /// Share of the shear stiffness left in slip.
    #[arg(long, default_value_t = 0.0)]
    slip_shear: f64,
    /// Share of the normal stiffness left in slip.
    #[arg(long, default_value_t = 1.0)]
    slip_normal: f64,
    /// Share of the stiffness left in debonding.
    #[arg(long, default_value_t = 1e-3)]
    debonded: f64,
    /// Thickness of the layer over the height of the element beside it.
    #[arg(long, default_value_t = 0.1)]
    ratio: f64,
    /// Height of the element beside the layer, ft; a layer of the mesh unless given.
    #[arg(long)]
    neighbour: Option<f64>,
    /// Share of the static pressure that friction feels, with `--limit lagged`.
    #[arg(long, default_value_t = 1.0)]
    static_share: f64,
    /// Change modes by what the step before ended with, without iteration.
    #[arg(long)]
    lag_modes: bool,
    /// Gravity over standard gravity.
    #[arg(long, default_value_t = 1.0)]
    gravity: f64,
    /// Factor on all friction coefficients.
    #[arg(long, default_value_t = 1.0)]
    friction_factor: f64,
    /// Contact length, ft.
    #[arg(long, default_value_t = 34.0)]
    width: f64,
    /// Height, ft.
    #[arg(long, default_value_t = 80.0)]
    height: f64,
    /// Factor on the foundation's density.
    #[arg(long, default_value_t = 1.0)]
    foundation_density: f64,
    /// Factor on the record.
    #[arg(long, default_value_t = 1.0)]
    record: f64,
    /// Soil density, slug/ft³.
    #[arg(long, default_value_t = 3.5)]
    soil_density: f64,
    /// Damping ratio of the structure at 1 and 10 Hz (Rayleigh).
    #[arg(long, default_value_t = 0.0)]
    damping: f64,
    /// Newmark's gamma; beta = (gamma + 1/2)²/4.
    #[arg(long, default_value_t = 0.5)]
    gamma: f64,
    /// Elements integrated at their centre, as the paper's are.
    #[arg(long)]
    one_point: bool,
    /// End a case where the paper's flow chart does not settle (instead of counting such steps).
    #[arg(long)]
    flow_chart: bool,
    /// Seconds to compute.
    #[arg(long, default_value_t = 12.0)]
    duration: f64,
    /// Rows of the table: 0 bonded, 1 uplift only, 2 to 4 friction.
    #[arg(long, value_delimiter = ',', default_value = "0,1,2,3,4")]
    rows: Vec<usize>,
}

#[derive(Debug, Clone, Copy, PartialEq, ValueEnum)]
enum Law {
    /// Thin layer.
    Layer,
    /// Hard contact.
    Hard,
}

#[derive(Debug, Clone, Copy, ValueEnum)]
enum Scheme {
    Newmark,
    Hht,
    Midpoint,
}

#[derive(Debug, Clone, Copy, PartialEq, ValueEnum)]
enum Limit {
    Total,
    Lagged,
    Static,
    /// Magnitude of the dynamic pressure, lagged.
    Dynamic,
    /// Dynamic pressure where it compresses, lagged.
    Compression,
    /// Mean static pressure, whatever gravity does elsewhere.
    Weight,
}

#[derive(Debug, Clone, Copy, ValueEnum)]
enum Sense {
    Inelastic,
    Velocity,
    LastVelocity,
}

/// A thin layer with what the library's does not offer.
struct Read {
    layer: ThinLayer,
    limit: Limit,
    slip_normal: f64,
    mean_pressure: f64,
    static_share: f64,
    lag_modes: bool,
}

impl Read {
    fn seen(&self, start: &StepStart) -> StepStart {
        let mut start = *start;
        match self.limit {
            Limit::Compression => start.state.pressure -= start.static_pressure,
            Limit::Lagged => {
                start.state.pressure -= (1.0 - self.static_share) * start.static_pressure;
            }
            Limit::Weight => start.static_pressure = self.mean_pressure,
            _ => {}
        }
        start
    }

    /// The mode that the end of the step before asks for.
    fn lagged_mode(&self, start: &StepStart) -> Mode {
        let mut before = self.seen(start);
        before.state.slip -= start.slip_rate * start.time_step;
        let tolerance = Tolerance { length: 1e-12, traction: 1e-6 };
        self.layer.next_mode(start.mode, &before, &start.state, tolerance)
    }
}

impl InterfaceLaw for Read {
    fn modes(&self) -> &[Mode] {
        self.layer.modes()
    }

    fn conditions(&self, mode: Mode, start: &StepStart) -> [Condition; 2] {
        let mode = if self.lag_modes { self.lagged_mode(start) } else { mode };
        let mut conditions = self.layer.conditions(mode, &self.seen(start));
        if mode.is_slip() {
            conditions[0].gap *= self.slip_normal;
        }
        conditions
    }

    fn next_mode(
        &self,
        mode: Mode,
        start: &StepStart,
        trial: &ContactState,
        tolerance: Tolerance,
    ) -> Mode {
        if self.lag_modes {
            return self.lagged_mode(start);
        }
        self.layer.next_mode(mode, &self.seen(start), trial, tolerance)
    }

    fn compliance(&self, mode: Mode) -> [f64; 2] {
        let [normal, shear] = self.layer.compliance(mode);
        [if mode.is_slip() { normal / self.slip_normal } else { normal }, shear]
    }

    fn smooth(&self) -> Box<dyn InterfaceLaw> {
        self.layer.smooth()
    }
}

/// What a case leaves.
struct Row {
    /// Peak shears between foundation and superstructure, and under the base, lb/ft.
    shear: [f64; 2],
    uplift: f64,
    slip: f64,
    /// Steps in which the flow chart did not settle.
    cycles: usize,
}

impl Reading {
    fn law(
        &self,
        friction: f64,
        soil: &Soil,
        weight: f64,
    ) -> Result<Box<dyn InterfaceLaw>, AnyError> {
        if self.law == Law::Hard {
            return Ok(Box::new(Coulomb::new(friction)?));
        }
        let neighbour = self.neighbour.unwrap_or(self.height / 13.0) * FOOT;
        let limit = match self.limit {
            Limit::Total => FrictionLimit::Total,
            Limit::Lagged | Limit::Compression => FrictionLimit::Lagged,
            Limit::Static | Limit::Weight => FrictionLimit::Static,
            Limit::Dynamic => FrictionLimit::Dynamic,
        };
        let sense = match self.sense {
            Sense::Inelastic => SlipSense::Inelastic,
            Sense::Velocity => SlipSense::Velocity,
            Sense::LastVelocity => SlipSense::LastVelocity,
        };
        let layer = ThinLayer::new(soil, neighbour, friction)?
            .with_thickness_ratio(self.ratio)?
            .with_debonded_share(self.debonded)?
            .with_friction_limit(limit)
            .with_slip_sense(sense)
            .with_slip_stiffness_share(self.slip_shear)?;
        let mean_pressure = weight / (self.width * FOOT);
        Ok(Box::new(Read {
            layer,
            limit: self.limit,
            slip_normal: self.slip_normal,
            mean_pressure,
            static_share: self.static_share,
            lag_modes: self.lag_modes,
        }))
    }

    fn run(&self, row: usize) -> Result<Row, AnyError> {
        let (fast, slow) = (1300.0 * FOOT, 650.0 * FOOT);
        let soil = Soil::from_wave_speeds(slow, fast, self.soil_density * SLUG_PER_CUBIC_FOOT)?;
        let solid = |young: f64, density: f64| {
            Material::new(young * PSF, 1.0 / 3.0, density * SLUG_PER_CUBIC_FOOT)
        };
        let foundation = solid(106_560_369.0, 3.043_48 * self.foundation_density)?;
        let superstructure = solid(106_577_648.0, 0.590_06)?;
        let formulation =
            if self.one_point { QuadFormulation::OnePoint } else { QuadFormulation::Full };
        let (half, layer) = (0.5 * self.width * FOOT, self.height * FOOT / 13.0);
        let mesh = Mesh::layered_block(
            -half..half,
            10,
            &[
                Layer::new(layer, 1, foundation).with_formulation(formulation),
                Layer::new(12.0 * layer, 12, superstructure).with_formulation(formulation),
            ],
        )?;
        let model = FemModel::on_base(mesh)?;
        let ratios = [self.damping; 2];
        let model = if self.damping > 0.0 {
            model.with_damping(RayleighDamping::from_ratios([1.0, 10.0], ratios)?)
        } else {
            model
        };
        let section = model.section(layer, 0.0)?;
        let mass = 2.0 * half * layer * (foundation.density() + 12.0 * superstructure.density());
        let time_step = 0.1 * half / fast;
        let scale = self.record;
        let record = el_centro_1940();
        let record = if scale == 1.0 { record } else { record.scaled(scale)? };
        let builder = Simulation::builder(time_step)
            .structure(model)
            .ground(HalfPlaneGround::strip(soil, -half..half, 10)?)
            .motion(record)
            .gravity(self.gravity * STANDARD_GRAVITY)
            .probe(Probe::section("base shear", &section.shear));
        let friction = [f64::NAN, f64::INFINITY, 0.4, 0.3, 0.2][row] * self.friction_factor;
        let builder = if row == 0 && self.law == Law::Hard {
            builder.interface(Bonded)
        } else if row == 0 {
            // A layer that never lets go.
            builder.interfaces((0..10).map(|_| self.glue(&soil)).collect::<Result<_, _>>()?)
        } else {
            let weight = STANDARD_GRAVITY * mass;
            let laws = (0..10).map(|_| self.law(friction, &soil, weight));
            builder.interfaces(laws.collect::<Result<_, _>>()?)
        };
        let mut simulation = self.with_scheme(builder)?.build()?;
        #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "above zero")]
        let run = simulation.run((self.duration / time_step).round() as usize, |_| {})?;
        let pounds = |force: f64| force.abs() / POUND_FORCE_PER_FOOT;
        Ok(Row {
            shear: [
                pounds(run.probe("base shear").map_or(0.0, |peak| peak.value)),
                pounds(run.base_shear.value),
            ],
            uplift: run.uplifted_fraction.value,
            slip: run.slip.value,
            cycles: run.fallbacks.iter().sum(),
        })
    }

    fn glue(&self, soil: &Soil) -> Result<Box<dyn InterfaceLaw>, AnyError> {
        let neighbour = self.neighbour.unwrap_or(self.height / 13.0) * FOOT;
        let layer = ThinLayer::new(soil, neighbour, f64::INFINITY)?;
        Ok(Box::new(Glue(layer.with_thickness_ratio(self.ratio)?)))
    }

    fn with_scheme(&self, builder: SimulationBuilder) -> Result<SimulationBuilder, AnyError> {
        let builder = match self.scheme {
            Scheme::Newmark => {
                let beta = 0.25 * (self.gamma + 0.5).powi(2);
                builder.scheme(Newmark::new(self.gamma, beta)?)
            }
            Scheme::Hht => builder.scheme(HhtAlpha::new(-0.1)?),
            Scheme::Midpoint => builder.scheme(Midpoint),
        };
        Ok(if self.flow_chart {
            builder.contact_search(ContactSearch::FlowChart { iterations: 100 })
        } else {
            builder
        })
    }

    fn print(&self, name: &str) {
        print!("| {} |", if name.is_empty() { "the paper's parts" } else { name });
        for &row in &self.rows {
            match self.run(row.min(4)) {
                Ok(r) => print!(
                    " {:.0} ({:+.0} %; {:.0}; {:.0} %; {:.0} mm; {}) |",
                    r.shear[0],
                    100.0 * (r.shear[0] / PAPER[row.min(4)] - 1.0),
                    r.shear[1],
                    100.0 * r.uplift,
                    1e3 * r.slip.abs(),
                    r.cycles
                ),
                Err(error) => {
                    let text: String = error.to_string().chars().take(60).collect();
                    print!(" {text} |");
                }
            }
        }
        println!();
    }
}

/// The stick mode of a thin layer, for good.
struct Glue(ThinLayer);

impl InterfaceLaw for Glue {
    fn modes(&self) -> &[Mode] {
        &[Mode::Stick]
    }

    fn conditions(&self, mode: Mode, start: &StepStart) -> [Condition; 2] {
        self.0.conditions(mode, start)
    }

    fn next_mode(&self, _: Mode, _: &StepStart, _: &ContactState, _: Tolerance) -> Mode {
        Mode::Stick
    }

    fn compliance(&self, mode: Mode) -> [f64; 2] {
        self.0.compliance(mode)
    }
}

/// Every reading of the table, as command lines.
const READINGS: &[&str] = &[
    "",
    "--law hard --scheme midpoint",
    "--law hard",
    "--law hard --scheme hht",
    "--scheme midpoint",
    "--scheme hht",
    "--flow-chart",
    "--debonded 0",
    "--ratio 0.001",
    "--ratio 0.001 --debonded 0",
    "--ratio 0.01",
    "--ratio 1",
    "--ratio 1 --debonded 0",
    "--one-point",
    "--limit lagged",
    "--limit dynamic",
    "--limit compression",
    "--limit static",
    "--limit static --lag-modes",
    "--limit weight --lag-modes",
    "--sense velocity",
    "--sense last-velocity",
    "--lag-modes",
    "--slip-shear 0.001 --debonded 0",
    "--slip-normal 0.001",
    "--gravity 0",
    "--gravity 0 --limit weight --lag-modes",
    "--gravity 0.3",
    "--gravity 0.5",
    "--friction-factor 0.5",
    "--friction-factor 0.3333",
    "--friction-factor 0.31",
    "--friction-factor 0.25",
    "--friction-factor 0.31 --law hard --scheme midpoint",
    "--friction-factor 0.3 --limit weight --lag-modes",
    "--limit lagged --static-share 0.25",
    "--foundation-density 0.3333",
    "--damping 0.05",
    "--gamma 0.6",
    "--gamma 1",
    "--record 0.5",
    "--width 28 --height 80.6",
    "--width 40 --height 79.2",
];

fn main() -> Result<(), AnyError> {
    println!(
        "peak shear between foundation and superstructure, lb/ft (against the paper; shear under \
         the base; uplift; slip; steps in which the flow chart cycles)\n"
    );
    println!("| reading | bonded | uplift only | 0.4 | 0.3 | 0.2 |\n|---|---|---|---|---|---|");
    if std::env::args().len() > 1 {
        let words: Vec<_> = std::env::args().skip(1).collect();
        Reading::parse().print(&words.join(" "));
        return Ok(());
    }
    for line in READINGS {
        let words = line.split(' ').filter(|word| !word.is_empty());
        Reading::try_parse_from(std::iter::once("").chain(words))?.print(line);
    }
    Ok(())
}
