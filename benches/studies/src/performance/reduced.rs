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

const STEP_COUNT: usize = 1000;
/// Steps of the runs that the table estimates.
const ESTIMATED_STEPS: f64 = 4000.0;

/// A tower of 8 × 24 m on ten elements, 2.5 Hz on a fixed base.
#[derive(Clone, Copy)]
struct ReducedTower {
    /// Columns and rows of quadrilaterals.
    columns: usize,
    rows: usize,
    /// Damping ratio at 1 and 10 Hz.
    damping: f64,
    bonded: bool,
    /// Whether there is a probe of the roof's acceleration.
    acceleration: bool,
}

/// Times (s) and results of a tower.
struct ReducedRun {
    build: f64,
    step: f64,
    /// Base shear and probes of every step.
    series: Vec<Vec<f64>>,
}

impl ReducedTower {
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
        let base = model.row(model.mesh().node_at(-4.0, 0.0)?, Direction::X)?;
        let roof = model.row(model.mesh().node_at(-4.0, 24.0)?, Direction::X)?;
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
        let builder = builder.coordinates(coordinates).expected_steps(STEP_COUNT);
        if self.bonded {
            builder.interface(Bonded)
        } else {
            builder.interface(Coulomb::new(0.4)?)
        }
        .build()
    }

    /// The smallest times of a few runs.
    fn run(self, coordinates: Coordinates, repeats: usize) -> Result<ReducedRun> {
        let mut run = ReducedRun { build: f64::INFINITY, step: f64::INFINITY, series: Vec::new() };
        for _ in 0..repeats {
            let build = timed(|| self.build(coordinates));
            let mut simulation = build.result?;
            run.series.clear();
            let march = timed(|| {
                for _ in 0..STEP_COUNT {
                    let state = simulation.step()?;
                    let shear = std::iter::once(state.base_shear);
                    run.series.push(shear.chain(state.probes.iter().copied()).collect());
                }
                Ok::<(), basemat::Error>(())
            });
            march.result?;
            run.build = run.build.min(build.seconds);
            run.step = run.step.min(march.seconds / STEP_COUNT as f64);
        }
        Ok(run)
    }
}

impl ReducedRun {
    fn estimated_time(&self) -> f64 {
        self.build + ESTIMATED_STEPS * self.step
    }

    /// Largest error of a quantity relative to its largest value.
    fn error(&self, reference: &Self, quantity: usize) -> Option<f64> {
        let mut max_magnitude = 0.0_f64;
        let mut difference = 0.0_f64;
        for (values, references) in self.series.iter().zip(&reference.series) {
            let expected = references.get(quantity)?;
            max_magnitude = max_magnitude.max(expected.abs());
            difference = difference.max((values.get(quantity)? - expected).abs());
        }
        Some(difference / max_magnitude)
    }
}

/// Adds the table of times and errors.
pub(crate) fn table(report: &mut Report, short: bool) -> std::result::Result<(), AnyError> {
    let small_tower =
        ReducedTower { columns: 20, rows: 26, damping: 0.05, bonded: false, acceleration: true };
    let medium = ReducedTower { columns: 40, rows: 40, ..small_tower };
    let mut towers = vec![
        ReducedTower { bonded: true, ..small_tower },
        small_tower,
        ReducedTower { damping: 0.02, ..small_tower },
        ReducedTower { damping: 0.0, ..small_tower },
    ];
    if !short {
        towers.extend([
            ReducedTower { acceleration: false, ..medium },
            medium,
            ReducedTower { damping: 0.02, ..medium },
            ReducedTower { columns: 80, rows: 80, acceleration: false, ..small_tower },
        ]);
    }
    let mut rows = Vec::new();
    for tower in towers {
        let dofs = tower.model()?.dofs();
        let repeats = if short || dofs > 10_000 { 1 } else { 3 };
        let full_run = tower.run(Coordinates::Physical, repeats)?;
        for tolerance in [1e-4, 1e-6] {
            let mut row = vec![
                dofs.to_string(),
                format!("{:.0} %", 100.0 * tower.damping),
                if tower.bonded { "bonded" } else { "friction 0.4" }.into(),
                format!("{tolerance:.0e}"),
            ];
            match tower.run(Coordinates::Reduced { tolerance }, repeats) {
                Ok(reduced) => {
                    row.extend([
                        format!("{:.2} / {:.2}", full_run.build, reduced.build),
                        format!("{:.0} / {:.0}", 1e6 * full_run.step, 1e6 * reduced.step),
                        format!("{:.0}", full_run.step / reduced.step),
                        format!("{:.1}", full_run.estimated_time() / reduced.estimated_time()),
                    ]);
                    row.extend((0..4).map(|quantity| {
                        reduced
                            .error(&full_run, quantity)
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
