//! Towers in reduced coordinates beside their degrees of freedom.

use basemat::bem::{ElasticGround, Strip};
use basemat::coupled::{Coordinates, Probe};
use basemat::fem::{Direction, Layer, Material, Mesh};
use basemat::interface::{Bonded, Coulomb};
use basemat::motion::el_centro_1940;
use basemat::structure::{FemModel, RayleighDamping, Structure};
use basemat::{Result, Simulation, Soil};

use super::report::{Report, timed};
use crate::AnyError;

const STEPS: usize = 1000;
/// Steps of the whole runs that the table tells of.
const WHOLE: f64 = 4000.0;

/// A tower of 8 × 24 m on ten elements, 2.5 Hz with its base held.
#[derive(Clone, Copy)]
struct Tower {
    /// Of quadrilaterals.
    columns: usize,
    rows: usize,
    /// Damping ratio at 1 and 10 Hz.
    damping: f64,
    bonded: bool,
    /// Whether a probe reads the roof's acceleration.
    acceleration: bool,
}

/// A run of it.
struct Run {
    build: f64,
    /// Of a step.
    step: f64,
    /// Base shear and probes of every step.
    history: Vec<Vec<f64>>,
}

impl Tower {
    fn model(self) -> Result<FemModel> {
        let material = Material::new(6e8, 0.2, 1500.0)?;
        let layer = Layer::new(24.0, self.rows, material);
        let model = FemModel::on_base(Mesh::layered_block(-4.0..4.0, self.columns, &[layer])?)?;
        if self.damping == 0.0 {
            return Ok(model);
        }
        Ok(model.with_rayleigh(RayleighDamping::from_ratios([1.0, 10.0], [self.damping; 2])?))
    }

    fn build(self, coordinates: Coordinates) -> Result<Simulation> {
        let model = self.model()?;
        let row = |y| model.row(model.mesh().node_at(-4.0, y)?, Direction::X);
        let (base, roof) = (row(0.0)?, row(24.0)?);
        let ground =
            ElasticGround::new(Soil::new(80e6, 0.33, 1900.0)?, Strip::uniform(-4.0..4.0, 10)?)?;
        let mut builder = Simulation::builder(5e-3)
            .ground(ground)
            .motion(el_centro_1940())
            .structure(model)
            .probe(Probe::displacement("base", base))
            .probe(Probe::displacement("roof", roof.clone()));
        if self.acceleration {
            builder = builder.probe(Probe::acceleration("acceleration", roof));
        }
        let builder = builder.coordinates(coordinates).expected_steps(STEPS);
        if self.bonded { builder.interface(Bonded) } else { builder.interface(Coulomb::new(0.4)?) }
            .build()
    }

    /// The least times of a few runs.
    fn run(self, coordinates: Coordinates, repeats: usize) -> Result<Run> {
        let mut run = Run { build: f64::INFINITY, step: f64::INFINITY, history: Vec::new() };
        for _ in 0..repeats {
            let (simulation, build) = timed(|| self.build(coordinates));
            let mut simulation = simulation?;
            run.history.clear();
            let (marched, seconds) = timed(|| {
                for _ in 0..STEPS {
                    let state = simulation.step()?;
                    let shear = std::iter::once(state.base_shear);
                    run.history.push(shear.chain(state.probes.iter().copied()).collect());
                }
                Ok::<(), basemat::Error>(())
            });
            marched?;
            run.build = run.build.min(build);
            run.step = run.step.min(seconds / STEPS as f64);
        }
        Ok(run)
    }
}

impl Run {
    fn whole(&self) -> f64 {
        self.build + WHOLE * self.step
    }

    /// Largest error of a quantity relative to its largest value.
    fn error(&self, exact: &Self, quantity: usize) -> Option<f64> {
        let (mut top, mut apart) = (0.0_f64, 0.0_f64);
        for (own, exact) in self.history.iter().zip(&exact.history) {
            let (own, exact) = (own.get(quantity)?, exact.get(quantity)?);
            top = top.max(exact.abs());
            apart = apart.max((own - exact).abs());
        }
        Some(apart / top)
    }
}

/// Times and errors.
pub(crate) fn table(report: &mut Report, short: bool) -> std::result::Result<(), AnyError> {
    let tower = |columns, rows, damping, bonded, acceleration| Tower {
        columns,
        rows,
        damping,
        bonded,
        acceleration,
    };
    let mut towers = vec![
        tower(20, 26, 0.05, true, true),
        tower(20, 26, 0.05, false, true),
        tower(20, 26, 0.02, false, true),
        tower(20, 26, 0.0, false, true),
    ];
    if !short {
        towers.extend([
            tower(40, 40, 0.05, false, false),
            tower(40, 40, 0.05, false, true),
            tower(40, 40, 0.02, false, true),
            tower(80, 80, 0.05, false, false),
        ]);
    }
    let mut rows = Vec::new();
    for tower in towers {
        let dofs = tower.model()?.dofs();
        let repeats = if short || dofs > 10_000 { 1 } else { 3 };
        let full = tower.run(Coordinates::Physical, repeats)?;
        for tolerance in [1e-4, 1e-6] {
            let mut row = vec![
                dofs.to_string(),
                format!("{:.0} %", 100.0 * tower.damping),
                if tower.bonded { "bonded" } else { "friction 0.4" }.into(),
                format!("{tolerance:.0e}"),
            ];
            match tower.run(Coordinates::Reduced { tolerance }, repeats) {
                Ok(few) => {
                    row.extend([
                        format!("{:.2} / {:.2}", full.build, few.build),
                        format!("{:.0} / {:.0}", 1e6 * full.step, 1e6 * few.step),
                        format!("{:.0}", full.step / few.step),
                        format!("{:.1}", full.whole() / few.whole()),
                    ]);
                    row.extend((0..4).map(|quantity| {
                        few.error(&full, quantity)
                            .map_or("–".into(), |error| format!("{error:.0e}"))
                    }));
                }
                Err(error) if error.to_string().contains("reduced coordinates") => {
                    row.push("refused".into());
                    row.extend(std::iter::repeat_n("–".into(), 7));
                }
                Err(error) => return Err(error.into()),
            }
            rows.push(row);
        }
    }
    report.table(
        "Reduced coordinates: towers on ten elements under El Centro, 1 000 steps of 5 ms",
        &[
            "dofs",
            "damping",
            "interface",
            "tolerance",
            "build, s: degrees of freedom / reduced",
            "step, µs",
            "ratio of steps",
            "of 4 000 steps with build",
            "error of base shear",
            "base",
            "roof",
            "roof acceleration",
        ],
        &rows,
    );
    Ok(())
}
