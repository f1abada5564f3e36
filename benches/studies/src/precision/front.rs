//! Error against time of structures of 300 to 30 000 degrees of freedom.

use std::f64::consts::{PI, TAU};
use std::path::Path;

use basemat::Simulation;
use basemat::bem::{ElasticGround, Grading, Ground, Strip};
use basemat::coupled::Coordinates;
use basemat::fem::{Layer, Material, Mesh};
use basemat::interface::{Bonded, Coulomb};
use basemat::motion::{Record, el_centro_1940};
use basemat::soil::{GeneralizedMaxwell, SoilProfile};
use basemat::structure::{FemModel, RayleighDamping};
use basemat::{Result, Soil};
use cpu_time::ThreadTime;
use indicatif::ProgressBar;

use super::force::ForceSeries;
use crate::AnyError;
use crate::document::write_csv;

/// Elements under the base and time steps (s) whose errors are similar.
pub(crate) const SETTING_LADDER: [(usize, f64); 4] =
    [(6, 0.0256), (12, 0.0128), (25, 0.0064), (50, 0.0032)];

/// Half the width of the base and height of the tower, m.
const HALF_WIDTH: f64 = 6.0;
const TOWER_HEIGHT: f64 = 24.0;

/// Computed time, s.
const RUN_DURATION: f64 = 5.0;

/// A case, without its numerical settings.
#[derive(Debug, Clone, Copy, PartialEq)]
struct TowerCase {
    /// Columns and rows of quadrilaterals.
    mesh: [usize; 2],
    near_fault: bool,
    layered: bool,
    friction: Option<f64>,
}

/// A line of the picture.
pub(crate) struct LineFamily {
    pub(crate) name: &'static str,
    /// Name of the scene for all settings.
    pub(crate) group: &'static str,
    case: TowerCase,
    pub(crate) grading: Grading,
    pub(crate) coordinates: Coordinates,
    /// Number of rungs of the ladder.
    points: usize,
}

/// A point of a line.
pub(crate) struct FrontPoint {
    pub(crate) elements: usize,
    pub(crate) time_step: f64,
    /// The larger of the errors of time series and peak.
    pub(crate) error: f64,
    /// Processor time of build and run, s.
    pub(crate) seconds: f64,
}

/// Results of a line.
pub(crate) struct FrontLine {
    pub(crate) family: LineFamily,
    pub(crate) points: Vec<FrontPoint>,
}

const SMALL_CASE: TowerCase =
    TowerCase { mesh: [10, 13], near_fault: false, layered: false, friction: None };
const MEDIUM_CASE: TowerCase = TowerCase { mesh: [36, 40], ..SMALL_CASE };
const LARGE_CASE: TowerCase = TowerCase { mesh: [122, 122], ..SMALL_CASE };

fn families(short: bool) -> Vec<LineFamily> {
    let physical = Coordinates::Physical;
    let reduced = Coordinates::Reduced { tolerance: 1e-4 };
    if short {
        return vec![
            LineFamily::new("300 degrees of freedom", SMALL_CASE, physical, 2),
            LineFamily::new("300, reduced 1e-4", SMALL_CASE, reduced, 2),
        ];
    }
    let coarsely_reduced = Coordinates::Reduced { tolerance: 1e-2 };
    let finely_reduced = Coordinates::Reduced { tolerance: 1e-6 };
    let near_fault = TowerCase { near_fault: true, ..MEDIUM_CASE };
    let sliding = TowerCase { friction: Some(0.4), ..MEDIUM_CASE };
    let layered = TowerCase { layered: true, ..MEDIUM_CASE };
    let uniform = LineFamily::new("3 000, reduced 1e-4, uniform", MEDIUM_CASE, reduced, 4);
    vec![
        LineFamily::new("300 degrees of freedom", SMALL_CASE, physical, 4),
        LineFamily::new("300, modes", SMALL_CASE, Coordinates::Modes, 4),
        LineFamily::new("300, reduced 1e-4", SMALL_CASE, reduced, 4),
        LineFamily::new("3 000 degrees of freedom", MEDIUM_CASE, physical, 4),
        LineFamily::new("3 000, reduced 1e-2", MEDIUM_CASE, coarsely_reduced, 4),
        LineFamily::new("3 000, reduced 1e-4", MEDIUM_CASE, reduced, 4),
        LineFamily::new("3 000, reduced 1e-6", MEDIUM_CASE, finely_reduced, 4),
        LineFamily { grading: Grading::Uniform, ..uniform },
        LineFamily::new("3 000, near-fault pulse", near_fault, reduced, 4),
        LineFamily::new("3 000, friction 0.4", sliding, reduced, 4),
        LineFamily::new("3 000, layer on rock", layered, reduced, 3),
        LineFamily::new("30 000 degrees of freedom", LARGE_CASE, physical, 3),
        LineFamily::new("30 000, reduced 1e-4", LARGE_CASE, reduced, 4),
    ]
}

impl LineFamily {
    fn run(&self, elements: usize, time_step: f64) -> std::result::Result<TowerRun, AnyError> {
        self.case.run(self.grading, self.coordinates, elements, time_step)
    }

    fn new(name: &'static str, case: TowerCase, coordinates: Coordinates, points: usize) -> Self {
        Self { name, group: case.name(), case, grading: Grading::Cosine, coordinates, points }
    }
}

fn constant_damping(ratio: f64) -> Result<GeneralizedMaxwell> {
    GeneralizedMaxwell::constant_q(ratio, [0.2, 25.0], 2.0)
}

/// Base shear of a run, and its processor time, s.
struct TowerRun {
    force: ForceSeries,
    seconds: f64,
}

impl TowerCase {
    fn name(&self) -> &'static str {
        match (self.mesh[0], self.near_fault, self.layered, self.friction) {
            (_, true, _, _) => "3 000, near-fault pulse",
            (_, _, true, _) => "3 000, layer on rock",
            (_, _, _, Some(_)) => "3 000, friction 0.4",
            (10, ..) => "300 degrees of freedom",
            (36, ..) => "3 000 degrees of freedom",
            _ => "30 000 degrees of freedom",
        }
    }

    fn soil() -> Result<Soil> {
        Soil::new(80.0e6, 0.33, 1900.0)
    }

    fn ground(&self, strip: Strip) -> Result<Box<dyn Ground>> {
        if !self.layered {
            return Ok(Box::new(ElasticGround::new(Self::soil()?, strip)?));
        }
        // Twelve metres of the soil of the half-plane with 3 % damping on rock with 1 %.
        let rock = Soil::from_shear_wave_speed(800.0, 0.25, 2300.0)?;
        let profile = SoilProfile::on_half_plane(rock)
            .with_bedrock_damping(constant_damping(0.01)?)
            .with_layer(Self::soil()?, 12.0)?
            .with_damping(constant_damping(0.03)?);
        Ok(Box::new(ElasticGround::new(profile, strip)?))
    }

    fn motion(&self) -> Result<Record> {
        if self.near_fault { near_fault(1.0, 2.0, 0.8) } else { el_centro(RUN_DURATION) }
    }

    fn run(
        &self,
        grading: Grading,
        coordinates: Coordinates,
        elements: usize,
        time_step: f64,
    ) -> std::result::Result<TowerRun, AnyError> {
        let motion = self.motion()?;
        #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "above zero")]
        let steps = (RUN_DURATION / time_step).round() as usize;
        let start_time = ThreadTime::try_now()?;
        let layer = Layer::new(TOWER_HEIGHT, self.mesh[1], Material::new(6e8, 0.2, 600.0)?);
        let model = FemModel::on_base(Mesh::layered_block(
            -HALF_WIDTH..HALF_WIDTH,
            self.mesh[0],
            &[layer],
        )?)?
        .with_rayleigh(RayleighDamping::from_ratios([1.0, 10.0], [0.05; 2])?);
        let builder = Simulation::builder(time_step)
            .structure(model)
            .ground(self.ground(Strip::new(-HALF_WIDTH..HALF_WIDTH, elements, grading)?)?)
            .motion(motion)
            .coordinates(coordinates)
            .expected_steps(steps);
        let builder = match self.friction {
            None => builder.interface(Bonded),
            Some(friction) => builder.interface(Coulomb::new(friction)?),
        };
        let mut simulation = builder.build()?;
        let mut mean_shears = Vec::with_capacity(steps);
        simulation.run(steps, |state| mean_shears.push(state.base_shear))?;
        let seconds = start_time.try_elapsed()?.as_secs_f64();
        Ok(TowerRun { force: ForceSeries::new(time_step, mean_shears), seconds })
    }

    /// Reference of the case, in reduced coordinates of 1e-8.
    fn reference(&self, points: usize) -> std::result::Result<ForceSeries, AnyError> {
        let (elements, time_step) = reference_settings(points);
        let coordinates = Coordinates::Reduced { tolerance: 1e-8 };
        Ok(self.run(Grading::Cosine, coordinates, elements, time_step)?.force)
    }
}

/// Twice the elements and half the step of the last rung.
///
/// The step of every rung is a whole number of these steps, so that means are compared without interpolation.
fn reference_settings(points: usize) -> (usize, f64) {
    let (elements, time_step) = SETTING_LADDER[points.clamp(1, SETTING_LADDER.len()) - 1];
    (2 * elements, 0.5 * time_step)
}

/// The reference of a case whose longest line has this number of points.
struct CaseReference {
    case: TowerCase,
    points: usize,
    force: ForceSeries,
}

fn largest_points(families: &[LineFamily], case: TowerCase) -> usize {
    let same_case = families.iter().filter(|family| family.case == case);
    same_case.map(|family| family.points).max().unwrap_or(1)
}

/// Runs all lines.
pub(crate) fn run(
    short: bool,
    repeats: u8,
    bar: &ProgressBar,
) -> std::result::Result<Vec<FrontLine>, AnyError> {
    let families = families(short);
    bar.inc_length(families.iter().map(|family| family.points as u64).sum());
    let mut references: Vec<CaseReference> = Vec::new();
    let mut lines: Vec<FrontLine> = Vec::new();
    for family in &families {
        if references.iter().all(|reference| reference.case != family.case) {
            let points = largest_points(&families, family.case);
            let force = family.case.reference(points)?;
            references.push(CaseReference { case: family.case, points, force });
        }
    }
    for family in families {
        let Some(reference) = references.iter().find(|reference| reference.case == family.case)
        else {
            continue;
        };
        let mut points = Vec::with_capacity(family.points);
        for &(elements, time_step) in &SETTING_LADDER[..family.points] {
            let first = family.run(elements, time_step)?;
            let mut seconds = first.seconds;
            for _ in 1..repeats {
                if seconds > 1.0 {
                    break;
                }
                seconds = seconds.min(family.run(elements, time_step)?.seconds);
            }
            let errors = first.force.errors(&reference.force);
            // The error is of second order, and the reference has this fraction of it.
            let fraction = (reference_settings(reference.points).1 / time_step).powi(2);
            let error = errors.series.max(errors.peak) / (1.0 - fraction);
            points.push(FrontPoint { elements, time_step, error, seconds });
            bar.inc(1);
        }
        lines.push(FrontLine { family, points });
    }
    Ok(lines)
}

/// Writes every point.
pub(crate) fn write(path: &Path, lines: &[FrontLine]) -> std::result::Result<(), AnyError> {
    let points = lines.iter().flat_map(|line| line.points.iter().map(move |point| (line, point)));
    write_csv(
        path,
        ["line", "elements", "time_step_s", "error", "processor_s"],
        points.map(|(line, point)| {
            [
                line.family.name.to_owned(),
                point.elements.to_string(),
                point.time_step.to_string(),
                format!("{:.3e}", point.error),
                format!("{:.3e}", point.seconds),
            ]
        }),
    )
}

fn el_centro(seconds: f64) -> basemat::Result<Record> {
    let record = el_centro_1940();
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a small number")]
    let samples = (seconds / record.time_step()).round() as usize + 1;
    Record::new(record.time_step(), record.accelerations()[..samples].to_vec())
}

/// Near-fault pulse, followed by rest of the same duration.
///
/// Its velocity is ½ (1 + cos(2πt/γT)) cos(2πt/T + φ), |t| ≤ γT/2, of G. P. Mavroeidis and A. S.
/// Papageorgiou, Bull. Seism. Soc. Am. 93 (2003), 1099–1131.
fn near_fault(period: f64, cycles: f64, phase: f64) -> basemat::Result<Record> {
    let step = 0.005 * period;
    let half_duration = 0.5 * cycles * period;
    let velocity = |time: f64| {
        let t = time - half_duration;
        if t.abs() > half_duration {
            return 0.0;
        }
        0.5 * (1.0 + (PI * t / half_duration).cos()) * (TAU * t / period + phase).cos()
    };
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a small number")]
    let samples = (4.0 * half_duration / step) as usize;
    // Mean accelerations around each sample; their sum is a velocity that ends at zero.
    let mut accelerations = Vec::new();
    for k in 0..=samples {
        let before = velocity((k as f64 - 0.5) * step);
        let after = velocity((k as f64 + 0.5) * step);
        accelerations.push((after - before) / step);
    }
    Record::new(step, accelerations)
}
