//! A reading's runs.

use basemat::bem::HalfPlaneGround;
use basemat::coupled::{ContactSearch, HhtAlpha, Midpoint, Newmark, SimulationBuilder};
use basemat::interface::{Bonded, InterfaceLaw};
use basemat::motion::{STANDARD_GRAVITY, el_centro_1940};
use basemat::{Simulation, StepError};

use super::containment::{FOOT, PAPER_SHEARS, pounds_per_foot};
use super::options::{Law, Reading, Scheme};

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
    fn run(&self, row: usize) -> basemat::Result<Row> {
        let scene = self.containment();
        let (soil, model) = (scene.soil()?, scene.structure()?);
        let base_shear = scene.base_shear(&model)?;
        let time_step = scene.time_step(0.5);
        let record = el_centro_1940();
        let record = if self.record == 1.0 { record } else { record.scaled(self.record)? };
        let builder = Simulation::builder(time_step)
            .structure(model)
            .ground(HalfPlaneGround::uniform_strip(soil, scene.base(), scene.elements)?)
            .motion(record)
            .gravity(self.gravity * STANDARD_GRAVITY)
            .probe(base_shear);
        let friction = [f64::NAN, f64::INFINITY, 0.4, 0.3, 0.2][row] * self.friction_factor;
        let mean_pressure = STANDARD_GRAVITY * scene.mass() / (scene.width * FOOT);
        let law = |_| match row {
            0 => self.glue(&soil),
            _ => self.law(friction, &soil, mean_pressure),
        };
        let builder = if row == 0 && self.law == Law::Hard {
            builder.interface(Bonded)
        } else {
            let laws = (0..scene.elements).map(law);
            builder.interfaces(laws.collect::<basemat::Result<Vec<Box<dyn InterfaceLaw>>>>()?)
        };
        let mut simulation = self.with_scheme(builder)?.build()?;
        #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "above zero")]
        let run = simulation.run((self.duration / time_step).round() as usize, |_| {})?;
        let probe = run.probe("base shear")?.largest().value;
        Ok(Row {
            shear: [probe, run.base_shear.largest().value]
                .map(|force| pounds_per_foot(force.abs())),
            uplift: run.uplifted_fraction.value,
            slip: run.largest_slip.value,
            cycles: run.fallbacks.total(),
        })
    }

    fn with_scheme(&self, builder: SimulationBuilder) -> basemat::Result<SimulationBuilder> {
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

    /// Runs the rows asked for and prints them as one line of a table.
    pub(crate) fn print(&self, name: &str) {
        print!("| {} |", if name.is_empty() { "the paper's parts" } else { name });
        for &row in &self.rows {
            match self.run(row.min(4)) {
                Ok(r) => print!(
                    " {:.0} ({:+.0} %; {:.0}; {:.0} %; {:.0} mm; {}) |",
                    r.shear[0],
                    100.0 * (r.shear[0] / PAPER_SHEARS[row.min(4)] - 1.0),
                    r.shear[1],
                    100.0 * r.uplift,
                    1e3 * r.slip.abs(),
                    r.cycles
                ),
                Err(basemat::Error::Step {
                    step, time, source: StepError::Contact { .. }, ..
                }) => print!(" step {step} (t = {time:.3} s): no modes |"),
                Err(error) => print!(" {error} |"),
            }
        }
        println!();
    }
}
