//! Sweeps over settings.

use basemat::bem::Grading;
use indicatif::ProgressBar;

use super::catalogue::{BLOCK_TABLES, CONTAINMENT_STEP, containment};
use super::force::{Errors, ForceSeries};
use super::scene::PrecisionScene;
use super::settings::{HISTORY_METHODS, OTHER_SCHEMES, Settings};
use crate::AnyError;

/// Longest time of a run that is repeated, s.
const MAX_REPEATED_TIME: f64 = 1.0;

/// A scene, its reference, and its settings.
pub(crate) struct SettingsSweep {
    pub(crate) scene: PrecisionScene,
    pub(crate) reference: SweepReference,
    pub(crate) settings: Vec<Settings>,
    /// Time in which an S wave crosses the base, s.
    pub(crate) crossing: f64,
}

/// Reference of a sweep.
pub(crate) enum SweepReference {
    Table(ForceSeries),
    /// A run with these settings, beside it one with half the elements and twice the step.
    Run(Settings),
}

/// Settings, their errors and time.
pub(crate) struct SweepPoint {
    pub(crate) settings: Settings,
    pub(crate) errors: Errors,
    /// Processor time, s.
    pub(crate) seconds: f64,
    /// Whether no other point is both faster and closer in the time series.
    pub(crate) front: bool,
}

/// Results of a sweep.
pub(crate) struct SweepOutcome {
    pub(crate) scene: &'static str,
    pub(crate) crossing: f64,
    pub(crate) points: Vec<SweepPoint>,
    /// Difference of a coarser run from the reference.
    pub(crate) reference_error: Option<Errors>,
}

impl SettingsSweep {
    fn new(scene: PrecisionScene, reference: SweepReference, settings: Vec<Settings>) -> Self {
        let crossing = scene.width / scene.soil.shear_wave_speed();
        Self { scene, reference, settings, crossing }
    }

    /// All sweeps.
    pub(crate) fn list(short: bool) -> Result<Vec<Self>, AnyError> {
        let mut sweeps = Vec::new();
        let block = &BLOCK_TABLES[0];
        let scene = block.scene()?;
        let force = block.force();
        sweeps.push(Self::new(scene, SweepReference::Table(force), block_settings(short)));
        let duration = if short { 0.5 } else { 5.0 };
        let elements = if short { 16 } else { 40 };
        let factor = if short { 1.0 } else { 0.25 };
        let reference = Settings::new(elements, Grading::Cosine, factor * CONTAINMENT_STEP);
        sweeps.push(Self::new(
            containment("containment, friction 0.4", Some(0.4), duration)?,
            SweepReference::Run(reference),
            containment_settings(short),
        ));
        Ok(sweeps)
    }

    /// Runs all settings; the time is that of the fastest of `repeats` runs.
    pub(crate) fn run(self, repeats: u8, bar: &ProgressBar) -> Result<SweepOutcome, AnyError> {
        let (reference, reference_error) = match self.reference {
            SweepReference::Table(force) => (force, None),
            SweepReference::Run(fine) => {
                let reference = self.scene.run(&fine)?.force;
                let coarse = Settings::new(fine.elements / 2, fine.grading, 2.0 * fine.time_step);
                let difference = self.scene.run(&coarse)?.force.errors(&reference);
                (reference, Some(difference))
            }
        };
        let mut points = Vec::with_capacity(self.settings.len());
        for settings in self.settings {
            let mut run = self.scene.run(&settings)?;
            for _ in 1..repeats {
                if run.seconds > MAX_REPEATED_TIME {
                    break;
                }
                run.seconds = run.seconds.min(self.scene.run(&settings)?.seconds);
            }
            let errors = run.force.errors(&reference);
            points.push(SweepPoint { settings, errors, seconds: run.seconds, front: false });
            bar.inc(1);
        }
        mark_front(&mut points);
        Ok(SweepOutcome {
            scene: self.scene.name,
            crossing: self.crossing,
            points,
            reference_error,
        })
    }
}

/// Pareto's front of time and error of the time series.
fn mark_front(points: &mut [SweepPoint]) {
    let mut order: Vec<usize> = (0..points.len()).collect();
    order.sort_by(|&a, &b| points[a].seconds.total_cmp(&points[b].seconds));
    let mut min_seconds = f64::INFINITY;
    for index in order {
        let point = &mut points[index];
        // Better by a percent at least: results that differ by rounding would all be in the front.
        if point.errors.series < 0.99 * min_seconds {
            min_seconds = point.errors.series;
            point.front = true;
        }
    }
}

/// Elements and steps of the blocks; steps in units of b/c_S, with a base 2 b wide.
fn block_settings(short: bool) -> Vec<Settings> {
    let elements: &[usize] = if short { &[4, 8] } else { &[4, 8, 16, 32, 64] };
    let steps: &[f64] = if short { &[0.4, 0.2] } else { &[0.4, 0.2, 0.1, 0.05, 0.025] };
    let mut list = Vec::new();
    for &count in elements {
        for &step in steps {
            for grading in [Grading::Uniform, Grading::Cosine] {
                let settings = Settings::new(count, grading, step);
                list.extend(HISTORY_METHODS.map(|history| Settings { history, ..settings }));
            }
            if count < 64 {
                let settings = Settings::new(count, Grading::Cosine, step);
                list.extend(OTHER_SCHEMES.map(|scheme| Settings { scheme, ..settings }));
            }
        }
    }
    list
}

/// Elements of the ground and steps of the containment; the structure keeps its ten columns.
fn containment_settings(short: bool) -> Vec<Settings> {
    let uniform_counts: &[usize] = if short { &[10] } else { &[5, 10, 20] };
    let cosine: &[usize] = if short { &[6] } else { &[6, 10, 16, 24] };
    let factors: &[f64] = if short { &[8.0, 4.0] } else { &[16.0, 8.0, 4.0, 2.0, 1.0, 0.5] };
    let mut list = Vec::new();
    for (grading, counts) in [(Grading::Uniform, uniform_counts), (Grading::Cosine, cosine)] {
        for &count in counts {
            for &factor in factors {
                let settings = Settings::new(count, grading, factor * CONTAINMENT_STEP);
                list.push(settings);
                if count == 10 {
                    // The direct sum of many steps takes minutes and gives the same force.
                    let other_methods = HISTORY_METHODS
                        .iter()
                        .skip(1)
                        .filter(|history| factor > 1.0 || history.name != "direct");
                    list.extend(other_methods.map(|&history| Settings { history, ..settings }));
                    list.extend(OTHER_SCHEMES.map(|scheme| Settings { scheme, ..settings }));
                }
            }
        }
    }
    list
}
