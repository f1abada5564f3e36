//! Structures of 300 to 30 000 degrees of freedom: which settings give which error, in which time.

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

use super::force::Force;
use crate::AnyError;
use crate::document::write_csv;

/// Elements under the base and time steps (s) that go together: errors of both are alike.
pub(crate) const LADDER: [(usize, f64); 4] =
    [(6, 0.0256), (12, 0.0128), (25, 0.0064), (50, 0.0032)];

/// Half the width of the base and height, m.
const HALF: f64 = 6.0;
const HEIGHT: f64 = 24.0;

/// Seconds that are computed.
const DURATION: f64 = 5.0;

/// A case, without its numerical settings.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Case {
    /// Columns and rows of quadrilaterals.
    mesh: [usize; 2],
    near_fault: bool,
    layered: bool,
    friction: Option<f64>,
}

/// A line of the picture.
pub(crate) struct Family {
    pub(crate) name: &'static str,
    /// The scene's name, whatever the settings.
    pub(crate) group: &'static str,
    case: Case,
    pub(crate) grading: Grading,
    pub(crate) coordinates: Coordinates,
    /// Number of rungs of the ladder.
    points: usize,
}

/// A point of it.
pub(crate) struct Point {
    pub(crate) elements: usize,
    pub(crate) time_step: f64,
    /// The larger of the errors of history and peak.
    pub(crate) error: f64,
    /// Processor time of building and running, s.
    pub(crate) seconds: f64,
}

/// A line that has run.
pub(crate) struct Line {
    pub(crate) family: Family,
    pub(crate) points: Vec<Point>,
}

const SMALL: Case = Case { mesh: [10, 13], near_fault: false, layered: false, friction: None };
const MEDIUM: Case = Case { mesh: [36, 40], ..SMALL };
const LARGE: Case = Case { mesh: [122, 122], ..SMALL };

fn families(short: bool) -> Vec<Family> {
    let few = |tolerance| Coordinates::Reduced { tolerance };
    let line = |name, case: Case, coordinates, points| Family {
        name,
        group: case.name(),
        case,
        grading: Grading::Cosine,
        coordinates,
        points,
    };
    if short {
        return vec![
            line("300 degrees of freedom", SMALL, Coordinates::Physical, 2),
            line("300, reduced 1e-4", SMALL, few(1e-4), 2),
        ];
    }
    let uniform = line("3 000, reduced 1e-4, uniform", MEDIUM, few(1e-4), 4);
    vec![
        line("300 degrees of freedom", SMALL, Coordinates::Physical, 4),
        line("300, modes", SMALL, Coordinates::Modes, 4),
        line("300, reduced 1e-4", SMALL, few(1e-4), 4),
        line("3 000 degrees of freedom", MEDIUM, Coordinates::Physical, 4),
        line("3 000, reduced 1e-2", MEDIUM, few(1e-2), 4),
        line("3 000, reduced 1e-4", MEDIUM, few(1e-4), 4),
        line("3 000, reduced 1e-6", MEDIUM, few(1e-6), 4),
        Family { grading: Grading::Uniform, ..uniform },
        line("3 000, near-fault pulse", Case { near_fault: true, ..MEDIUM }, few(1e-4), 4),
        line("3 000, friction 0.4", Case { friction: Some(0.4), ..MEDIUM }, few(1e-4), 4),
        line("3 000, layer on rock", Case { layered: true, ..MEDIUM }, few(1e-4), 3),
        line("30 000 degrees of freedom", LARGE, Coordinates::Physical, 3),
        line("30 000, reduced 1e-4", LARGE, few(1e-4), 4),
    ]
}

impl Case {
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
        // Twelve metres of the half-plane's soil with 3 % of damping on rock with 1 %.
        let law = |ratio| GeneralizedMaxwell::constant_q(ratio, [0.2, 25.0], 2.0);
        let rock = Soil::from_shear_wave_speed(800.0, 0.25, 2300.0)?;
        let profile = SoilProfile::on_half_plane(rock)
            .with_bedrock_damping(law(0.01)?)
            .with_layer(Self::soil()?, 12.0)?
            .with_damping(law(0.03)?);
        Ok(Box::new(ElasticGround::new(profile, strip)?))
    }

    fn motion(&self) -> Result<Record> {
        if self.near_fault { near_fault(1.0, 2.0, 0.8) } else { el_centro(DURATION) }
    }

    fn run(
        &self,
        grading: Grading,
        coordinates: Coordinates,
        (elements, time_step): (usize, f64),
    ) -> std::result::Result<(Force, f64), AnyError> {
        let [columns, rows] = self.mesh;
        let motion = self.motion()?;
        #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "above zero")]
        let steps = (DURATION / time_step).round() as usize;
        let begin = ThreadTime::try_now()?;
        let layer = Layer::new(HEIGHT, rows, Material::new(6e8, 0.2, 600.0)?);
        let model = FemModel::on_base(Mesh::layered_block(-HALF..HALF, columns, &[layer])?)?
            .with_rayleigh(RayleighDamping::from_ratios([1.0, 10.0], [0.05; 2])?);
        let builder = Simulation::builder(time_step)
            .structure(model)
            .ground(self.ground(Strip::new(-HALF..HALF, elements, grading)?)?)
            .motion(motion)
            .coordinates(coordinates)
            .expected_steps(steps);
        let builder = match self.friction {
            None => builder.interface(Bonded),
            Some(friction) => builder.interface(Coulomb::new(friction)?),
        };
        let (mut simulation, mut means) = (builder.build()?, Vec::with_capacity(steps));
        simulation.run(steps, |state| means.push(state.base_shear))?;
        let seconds = begin.try_elapsed()?.as_secs_f64();
        Ok((Force::new(time_step, means), seconds))
    }

    /// Reference of its lines, in reduced coordinates of 1e-8.
    fn reference(&self, points: usize) -> std::result::Result<Force, AnyError> {
        let (elements, time_step) = reference_settings(points);
        let coordinates = Coordinates::Reduced { tolerance: 1e-8 };
        Ok(self.run(Grading::Cosine, coordinates, (elements, time_step))?.0)
    }
}

/// Twice the elements and half the step of the last rung: the step of every rung is a whole number
/// of its steps, so that means are compared without interpolation.
fn reference_settings(points: usize) -> (usize, f64) {
    let (elements, time_step) = LADDER[points.clamp(1, LADDER.len()) - 1];
    (2 * elements, 0.5 * time_step)
}

/// Runs all lines.
pub(crate) fn run(
    short: bool,
    repeats: u8,
    bar: &ProgressBar,
) -> std::result::Result<Vec<Line>, AnyError> {
    let families = families(short);
    bar.inc_length(families.iter().map(|family| family.points as u64).sum());
    let mut references: Vec<(Case, Force)> = Vec::new();
    let mut lines: Vec<Line> = Vec::new();
    let lengths: Vec<(Case, usize)> = families.iter().map(|f| (f.case, f.points)).collect();
    let longest = |case: Case| {
        let same = lengths.iter().filter(|(other, _)| *other == case);
        same.map(|(_, points)| *points).max().unwrap_or(1)
    };
    for &(case, _) in &lengths {
        if references.iter().all(|(other, _)| *other != case) {
            references.push((case, case.reference(longest(case))?));
        }
    }
    for family in families {
        let Some((_, reference)) = references.iter().find(|(case, _)| *case == family.case) else {
            continue;
        };
        let mut points = Vec::with_capacity(family.points);
        for &(elements, time_step) in &LADDER[..family.points] {
            let once =
                || family.case.run(family.grading, family.coordinates, (elements, time_step));
            let (force, mut seconds) = once()?;
            for _ in 1..repeats {
                if seconds > 1.0 {
                    break;
                }
                seconds = seconds.min(once()?.1);
            }
            let errors = force.errors(reference);
            // Of the second order: the reference has this share of it, too.
            let share = (reference_settings(longest(family.case)).1 / time_step).powi(2);
            let error = errors.history.max(errors.peak) / (1.0 - share);
            points.push(Point { elements, time_step, error, seconds });
            bar.inc(1);
        }
        lines.push(Line { family, points });
    }
    Ok(lines)
}

/// Every point.
pub(crate) fn write(path: &Path, lines: &[Line]) -> std::result::Result<(), AnyError> {
    let points = lines.iter().flat_map(|line| line.points.iter().map(move |point| (line, point)));
    write_csv(
        path,
        ["line", "elements", "time_step_s", "error", "processor_s"],
        points.map(|(line, p)| {
            [
                line.family.name.to_owned(),
                p.elements.to_string(),
                p.time_step.to_string(),
                format!("{:.3e}", p.error),
                format!("{:.3e}", p.seconds),
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

/// Velocity pulse ½ (1 + cos(2πt/γT)) cos(2πt/T + φ), |t| ≤ γT/2, of G. P. Mavroeidis and A. S.
/// Papageorgiou, Bull. Seism. Soc. Am. 93 (2003), 1099–1131; and rest as long again.
fn near_fault(period: f64, cycles: f64, phase: f64) -> basemat::Result<Record> {
    let step = 0.005 * period;
    let half = 0.5 * cycles * period;
    let velocity = |time: f64| {
        let t = time - half;
        if t.abs() > half {
            return 0.0;
        }
        0.5 * (1.0 + (PI * t / half).cos()) * (TAU * t / period + phase).cos()
    };
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a small number")]
    let samples = (4.0 * half / step) as usize;
    // Means over a sample either way, which add up to a velocity that ends at zero.
    let acceleration =
        |k: usize| (velocity((k as f64 + 0.5) * step) - velocity((k as f64 - 0.5) * step)) / step;
    Record::new(step, (0..=samples).map(acceleration).collect())
}
