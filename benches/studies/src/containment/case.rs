//! A case of the containment, and its results.

use basemat::Simulation;
use basemat::bem::{ElasticGround, Strip};
use basemat::coupled::Probe;
use basemat::interface::{Bonded, Coulomb};
use basemat::motion::el_centro_1940;
use basemat::results::Run;
use basemat::results::{Recorder, Serviceability, TimeSeries};
use basemat_problems::containment::{Containment, PAPER_SHEARS, TABLE_1_ROWS};

/// A name and a friction coefficient; `None` is bonded, infinity uplift only.
#[derive(Debug, Clone)]
pub(crate) struct ContainmentCase {
    pub(crate) name: String,
    pub(crate) friction: Option<f64>,
}

/// Results of a case.
pub(crate) struct ContainmentOutcome {
    pub(crate) case: ContainmentCase,
    pub(crate) run: Run,
    /// With the probes of [`Containment::probes`], and "foundation", the acceleration of the foundation's top.
    pub(crate) time_series: TimeSeries,
    /// Mass of the superstructure, kg/m.
    pub(crate) superstructure_mass: f64,
    /// Largest base shear at the foundation–superstructure interface, N/m.
    pub(crate) peak_shear: f64,
    /// Largest displacement of the roof corner to a side, relative to the start of the free field, and upwards, m.
    pub(crate) peak_roof: f64,
    pub(crate) peak_lift: f64,
    /// Largest horizontal displacement of the roof corner relative to the base, m.
    pub(crate) peak_sway: f64,
}

impl ContainmentCase {
    /// Bonded, uplift only, then one case per friction coefficient.
    pub(crate) fn list(friction: &[f64]) -> Vec<Self> {
        let without_sliding =
            TABLE_1_ROWS[..2].iter().map(|(name, friction)| ((*name).to_owned(), *friction));
        let sliding =
            friction.iter().map(|friction| (format!("friction {friction}"), Some(*friction)));
        without_sliding
            .chain(sliding)
            .map(|(name, friction)| Self { name, friction })
            .collect()
    }

    /// Peak base shear of the paper's Table 1, lb/ft, where it has this case.
    pub(crate) fn printed_shear(&self) -> Option<f64> {
        let row = TABLE_1_ROWS.iter().position(|(_, friction)| *friction == self.friction)?;
        Some(PAPER_SHEARS[row])
    }

    /// Runs El Centro for `duration`, s.
    pub(crate) fn run(
        &self,
        scene: Containment,
        duration: f64,
    ) -> basemat::Result<ContainmentOutcome> {
        let model = scene.structure()?;
        let probes = scene.probes(&model)?;
        let top = scene.foundation_top(&model)?;
        let builder = Simulation::builder(scene.time_step(0.5))
            .structure(model)
            // Equal elements, as in the paper.
            .ground(ElasticGround::new(
                scene.soil()?,
                Strip::uniform(scene.base(), scene.elements)?,
            )?)
            .motion(el_centro_1940())
            .probes(probes)
            .probe(Probe::acceleration("foundation", top))
            .serviceability(Serviceability {
                slip: Some(25e-3),
                gap: Some(10e-3),
                uplifted_fraction: Some(0.75),
                rotation: Some(2e-3),
                ..Serviceability::default()
            });
        #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "above zero")]
        let steps = (duration / scene.time_step(0.5)).round() as usize;
        let builder = builder.expected_steps(steps);
        let mut simulation = match self.friction {
            None => builder.interface(Bonded),
            Some(friction) => builder.interface(Coulomb::new(friction)?),
        }
        .build()?;
        let mut time_series = Recorder::new().start(&simulation)?;
        time_series.reserve(steps)?;
        let run = simulation.run(steps, |state| time_series.record(state))?;
        Ok(ContainmentOutcome {
            case: self.clone(),
            superstructure_mass: scene.superstructure_mass(),
            peak_shear: run.probe("base shear")?.magnitude(),
            peak_roof: run.probe("roof x")?.magnitude(),
            peak_lift: run.probe("roof y")?.highest.value,
            peak_sway: run.probe("sway")?.magnitude(),
            run,
            time_series,
        })
    }
}

impl ContainmentOutcome {
    /// Times and values of a probe, multiplied by a factor.
    pub(crate) fn curve(&self, probe: &str, factor: f64) -> basemat::Result<Vec<(f64, f64)>> {
        let values = self.time_series.probe(probe)?.iter().map(|value| factor * value);
        Ok(self.time_series.times().iter().copied().zip(values).collect())
    }
}
