//! A reading's runs.

use basemat::bem::HalfPlaneGround;
use basemat::coupled::{ContactSearch, HhtAlpha, Midpoint, Newmark, Probe, SimulationBuilder};
use basemat::fem::Direction;
use basemat::interface::{Bonded, InterfaceLaw};
use basemat::motion::{STANDARD_GRAVITY, el_centro_1940};
use basemat::{Simulation, StepError};

use super::containment::{FOOT, PAPER_SHEARS, pounds_per_foot};
use super::forcing::PrintedForcing;
use super::options::{Law, Reading, Scheme};

/// Results of a case.
pub(crate) struct Row {
    /// Peak shears between foundation and superstructure, and under the base, lb/ft.
    pub(crate) shear: [f64; 2],
    /// Largest uplifted fraction.
    pub(crate) uplift: f64,
    /// Largest slip of an element, m.
    slip: f64,
    /// Largest absolute motion of A to a side, and upwards, m.
    pub(crate) roof: [f64; 2],
    /// Steps in which the flow chart did not settle.
    cycles: usize,
}

impl Reading {
    pub(crate) fn run(&self, row: usize) -> basemat::Result<Row> {
        let scene = self.containment();
        let (soil, model) = (scene.soil()?, scene.structure()?);
        let base_shear = scene.base_shear(&model)?;
        let [left, top] = scene.corner();
        let corner = model.node_at(left, top)?;
        let roof = [("roof x", Direction::X), ("roof y", Direction::Y)].map(|(name, direction)| {
            Ok(Probe::absolute_displacement(name, model.row(corner, direction)?))
        });
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
            .ground(HalfPlaneGround::uniform_strip(soil, scene.base(), scene.elements)?)
            .motion(record)
            .gravity(self.gravity * STANDARD_GRAVITY)
            .probe(base_shear)
            .probes(roof.into_iter().collect::<basemat::Result<Vec<_>>>()?);
        let friction = [f64::NAN, f64::INFINITY, 0.4, 0.3, 0.2][row] * self.friction_share();
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
            shear: [probe, run.whole.base_shear.largest().value]
                .map(|force| pounds_per_foot(force.abs())),
            uplift: run.whole.uplifted_fraction.largest().value,
            slip: run.whole.largest_slip.largest().value,
            roof: [run.probe("roof x")?.magnitude(), run.probe("roof y")?.highest.value],
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

    /// Runs the rows asked for and prints them as one line of a table, with the root mean square of
    /// ln(peak/paper's) over all of them and over those that slide.
    pub(crate) fn print(&self, name: &str) {
        print!("| {} |", if name.is_empty() { "the paper's parts" } else { name });
        let mut logarithms = Vec::new();
        for &row in &self.rows {
            let row = row.min(4);
            match self.run(row) {
                Ok(r) => {
                    let ratio = r.shear[0] / PAPER_SHEARS[row];
                    logarithms.push((row, ratio.ln()));
                    print!(
                        " {:.0} ({:+.0} %; {:.0}; {:.0} %; {:.0} mm; {}) |",
                        r.shear[0],
                        100.0 * (ratio - 1.0),
                        r.shear[1],
                        100.0 * r.uplift,
                        1e3 * r.slip.abs(),
                        r.cycles
                    );
                }
                Err(basemat::Error::Step {
                    step, time, source: StepError::Contact { .. }, ..
                }) => print!(" step {step} (t = {time:.3} s): no modes |"),
                Err(error) => print!(" {error} |"),
            }
        }
        for first in [0, 2] {
            let wanted = self.rows.iter().filter(|row| **row >= first).count();
            let found = logarithms.iter().filter(|(row, _)| *row >= first).map(|(_, l)| *l);
            let found: Vec<f64> = found.collect();
            // A reading that some row does not survive has none.
            if found.len() == wanted && wanted > 0 {
                print!(" {:.2} |", root_mean_square(&found));
            } else {
                print!(" – |");
            }
        }
        println!();
    }
}

/// √(Σ x²/n).
pub(crate) fn root_mean_square(values: &[f64]) -> f64 {
    (values.iter().map(|x| x * x).sum::<f64>() / values.len() as f64).sqrt()
}
