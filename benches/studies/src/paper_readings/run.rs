//! A reading's runs.

use basemat::Simulation;
use basemat::bem::{ElasticGround, Strip};
use basemat::contact::ContactSearch;
use basemat::coupled::{HhtAlpha, Midpoint, Newmark, SimulationBuilder};
use basemat::interface::{Bonded, InterfaceLaw};
use basemat::motion::{STANDARD_GRAVITY, el_centro_1940};

use super::forcing::PrintedForcing;
use super::options::{InterfaceReading, PaperReading, SchemeReading};
use basemat_problems::containment::{METRES_PER_FOOT, TABLE_1_ROWS, pounds_per_foot};

/// Results of a case.
pub(crate) struct ReadingResults {
    /// Peak shears between foundation and superstructure, and under the base, lb/ft.
    pub(crate) shear: [f64; 2],
    /// Largest uplifted fraction.
    pub(crate) uplift: f64,
    /// Largest slip of an element, m.
    pub(crate) slip: f64,
    /// Largest absolute motion of A to a side, and upwards, m.
    pub(crate) roof: [f64; 2],
    /// Steps in which the flow chart did not converge.
    pub(crate) cycles: usize,
}

impl PaperReading {
    pub(crate) fn run(&self, row: usize) -> basemat::Result<ReadingResults> {
        let scene = self.containment();
        let soil = scene.soil()?;
        let model = scene.structure()?;
        let probes = scene.probes(&model)?;
        let time_step = scene.time_step(0.5);
        let record = el_centro_1940();
        let record = if self.record == 1.0 { record } else { record.scaled(self.record)? };
        let builder = Simulation::builder(time_step);
        let builder = if self.printed_forcing {
            builder.structure(PrintedForcing::new(model, record.clone())?)
        } else {
            builder.structure(model)
        };
        let builder = builder
            .ground(ElasticGround::new(soil, Strip::uniform(scene.base(), scene.elements)?)?)
            .motion(record)
            .gravity(self.gravity * STANDARD_GRAVITY)
            .probes(probes);
        let friction = TABLE_1_ROWS[row].1.unwrap_or(f64::NAN) * self.friction_ratio();
        let mean_pressure = STANDARD_GRAVITY * scene.mass() / (scene.width * METRES_PER_FOOT);
        let builder = if row == 0 && self.law == InterfaceReading::Hard {
            builder.interface(Bonded)
        } else {
            let mut laws: Vec<Box<dyn InterfaceLaw>> = Vec::new();
            for _ in 0..scene.elements {
                laws.push(match row {
                    0 => self.glue(&soil)?,
                    _ => self.law(friction, &soil, mean_pressure)?,
                });
            }
            builder.interfaces(laws)
        };
        let mut simulation = self.with_scheme(builder)?.build()?;
        #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "above zero")]
        let run = simulation.run((self.duration / time_step).round() as usize, |_| {})?;
        let superstructure_shear = run.probe("base shear")?.largest().value;
        Ok(ReadingResults {
            shear: [superstructure_shear, run.whole.base_shear.largest().value]
                .map(|force| pounds_per_foot(force.abs())),
            uplift: run.whole.uplifted_fraction.largest().value,
            slip: run.whole.largest_slip.largest().value,
            roof: [run.probe("roof x")?.magnitude(), run.probe("roof y")?.highest.value],
            cycles: run.fallbacks.total(),
        })
    }

    fn with_scheme(&self, builder: SimulationBuilder) -> basemat::Result<SimulationBuilder> {
        let builder = match self.scheme {
            SchemeReading::Newmark => {
                let beta = 0.25 * (self.gamma + 0.5).powi(2);
                builder.scheme(Newmark::new(self.gamma, beta)?)
            }
            SchemeReading::Hht => builder.scheme(HhtAlpha::new(-0.1)?),
            SchemeReading::Midpoint => builder.scheme(Midpoint),
        };
        Ok(if self.flow_chart {
            builder.contact_search(ContactSearch::FlowChart { iterations: 100 })
        } else {
            builder
        })
    }
}

/// √(Σ x²/n).
pub(crate) fn root_mean_square(values: &[f64]) -> f64 {
    (values.iter().map(|x| x * x).sum::<f64>() / values.len() as f64).sqrt()
}
