//! Problems of FCLIB and of the tests of Siconos: residual and time of the step that solves each.

use std::fmt::Write as _;
use std::path::Path;

use basemat::Simulation;
use basemat::bem::Strip;
use basemat::bem::plan::Plan;
use basemat::interface::{Coulomb, InterfaceLaw};
use basemat::structure::{RigidBlock, RigidBody};
use basemat_problems::prescribed::PrescribedGround;
use cpu_time::ProcessTime;

use crate::AnyError;
use crate::document::splice;
use crate::figure::{CURVE_BLUE, CURVE_RED, Figure, FigurePanel};

/// Largest residual of a problem with a definite W, and with a singular W.
const RESIDUAL_LIMITS: [f64; 2] = [1e-11, 1e-7];
/// Ratio of the smallest to the largest eigenvalue of W below which W is singular.
const SINGULAR_EIGENVALUE_RATIO: f64 = 1e-12;
/// Compliance of a layer on the diagonal of a singular W, over its largest entry. Residuals are without it.
const LAYER_COMPLIANCE_RATIO: f64 = 1e-9;

/// u = W r + q for some contacts: normal components first, then those along x, in space along y.
struct PublishedProblem {
    dimension: usize,
    /// Smallest over largest eigenvalue of W.
    ratio: f64,
    friction: Vec<f64>,
    velocity: Vec<f64>,
    matrix: Vec<f64>,
}

/// Solution of a problem.
struct PublishedSolution {
    method: String,
    iterations: usize,
    /// Processor time, s.
    seconds: f64,
    residual: f64,
}

impl PublishedProblem {
    /// The problem of a file of export.py.
    fn read(text: &str) -> Result<Self, AnyError> {
        let numbers: Vec<f64> =
            text.split_whitespace().map(str::parse).collect::<Result<_, _>>()?;
        let [dimension, contacts, ratio, ref rest @ ..] = numbers[..] else {
            return Err("a problem begins with three numbers".into());
        };
        let count = basemat_problems::series::nearest_integer(contacts);
        let dimension = basemat_problems::series::nearest_integer(dimension);
        let size = dimension * count;
        if rest.len() != count + size + size * size {
            return Err(format!("{} numbers for {count} contacts", rest.len()).into());
        }
        let friction = &rest[..count];
        let velocity = &rest[count..count + size];
        let matrix = &rest[count + size..];
        Ok(Self {
            dimension,
            ratio,
            friction: friction.to_vec(),
            velocity: velocity.to_vec(),
            matrix: matrix.to_vec(),
        })
    }

    /// Solves the problem in one step of a body too heavy to move, on contact elements of 1 m².
    fn solve(&self) -> Result<PublishedSolution, AnyError> {
        let count = self.friction.len();
        let size = self.velocity.len();
        let mut matrix = self.matrix.clone();
        if self.ratio < SINGULAR_EIGENVALUE_RATIO {
            let layer = LAYER_COMPLIANCE_RATIO
                * matrix.iter().fold(0.0_f64, |largest, value| largest.max(value.abs()));
            (0..size).for_each(|i| matrix[i * (size + 1)] += layer);
        }
        let mut laws: Vec<Box<dyn InterfaceLaw>> = Vec::new();
        for friction in &self.friction {
            laws.push(Box::new(Coulomb::new(*friction)?));
        }
        let builder = Simulation::builder(1.0).interfaces(laws).gravity(0.0);
        let heavy = 1e60;
        let middle = 0.5 * count as f64;
        let (builder, motion) = if self.dimension == 3 {
            let plan = Plan::masked([0.0; 2], [1.0; 2], count, &vec![true; count])?;
            let outline = [[-middle, -0.5], [middle, -0.5], [middle, 0.5], [-middle, 0.5]];
            let inertia = [[heavy, 0.0, 0.0], [0.0, heavy, 0.0], [0.0, 0.0, heavy]];
            let body = RigidBody::from_mass(outline.to_vec(), heavy, inertia, [0.0; 3])?;
            let (ground, motion) = PrescribedGround::new(plan.elements(), matrix);
            (builder.structure(body.centered_at([middle, 0.5])?).ground(ground), motion)
        } else {
            let strip = Strip::uniform(0.0..2.0 * middle, count)?;
            let body = RigidBlock::from_mass(2.0 * middle, heavy, heavy, 0.0)?;
            let (ground, motion) = PrescribedGround::new(strip.elements(), matrix);
            (builder.structure(body.centered_at(middle)?).ground(ground), motion)
        };
        let mut simulation = builder.build()?;
        motion.lock().map_err(|_| "poisoned")?.copy_from_slice(&self.velocity);
        let start_time = ProcessTime::try_now()?;
        let state = simulation.step()?;
        let seconds = start_time.try_elapsed()?.as_secs_f64();
        let contact = &state.contact;
        let force: Vec<f64> = contact
            .iter()
            .map(|element| element.pressure)
            .chain(contact.iter().map(|element| element.shear))
            .chain(contact.iter().map(|element| element.shear_across))
            .take(size)
            .collect();
        Ok(PublishedSolution {
            method: state.method.to_string(),
            iterations: state.trials,
            seconds,
            residual: self.residual(&force),
        })
    }

    /// ‖r − P(r − u − μ‖u_T‖ n)‖ over the largest of ‖q‖, ‖r‖ and ‖u‖, with P the projection on Coulomb's cones: the error
    /// by which Siconos accepts a solution (`fc3d_compute_error`, `fc2d_compute_error`).
    fn residual(&self, force: &[f64]) -> f64 {
        let count = self.friction.len();
        let size = force.len();
        let rows = self.matrix.chunks_exact(size).zip(&self.velocity);
        let velocity: Vec<f64> = rows
            .map(|(row, prescribed)| {
                prescribed + row.iter().zip(force).map(|(w, r)| w * r).sum::<f64>()
            })
            .collect();
        let scale = norm(&self.velocity).max(norm(force)).max(norm(&velocity));
        let mut squares = 0.0;
        for e in 0..count {
            let tangential: Vec<usize> = (1..self.dimension).map(|k| k * count + e).collect();
            let friction = self.friction[e];
            let slip = norm(&tangential.iter().map(|&k| velocity[k]).collect::<Vec<_>>());
            let normal = force[e] - velocity[e] - friction * slip;
            let trial: Vec<f64> = tangential.iter().map(|&k| force[k] - velocity[k]).collect();
            let shear = norm(&trial);
            let (pressure, factor) = if friction * shear <= -normal {
                (0.0, 0.0)
            } else if shear <= friction * normal {
                (normal, 1.0)
            } else {
                let pressure = (normal + friction * shear) / (1.0 + friction * friction);
                (pressure, friction * pressure / shear)
            };
            let across = tangential.iter().zip(&trial);
            let across = across.map(|(&k, shear)| (force[k] - factor * shear).powi(2));
            squares += (force[e] - pressure).powi(2) + across.sum::<f64>();
        }
        squares.sqrt() / scale.max(f64::MIN_POSITIVE)
    }
}

fn norm(values: &[f64]) -> f64 {
    values.iter().map(|value| value * value).sum::<f64>().sqrt()
}

/// Solves the problems of a folder; prints a table, and writes it and a picture into the documents.
pub(super) fn run(folder: &Path, docs: Option<&Path>) -> Result<(), AnyError> {
    let mut paths: Vec<_> = std::fs::read_dir(folder)?
        .map(|entry| Ok(entry?.path()))
        .collect::<Result<_, std::io::Error>>()?;
    paths.retain(|path| path.extension().is_some_and(|extension| extension == "txt"));
    paths.sort();
    let mut text = "| problem | directions | contacts | friction | least over greatest eigenvalue of W | method | iterations | ms | residual |\n|---|---|---|---|---|---|---|---|---|\n".to_owned();
    let mut points = [vec![], vec![]];
    let mut failed_problems = vec![];
    for path in &paths {
        let name = path.file_stem().unwrap_or_default().to_string_lossy().into_owned();
        let problem = PublishedProblem::read(&std::fs::read_to_string(path)?)?;
        let PublishedProblem { dimension, ratio, friction, .. } = &problem;
        let kind = usize::from(*ratio < SINGULAR_EIGENVALUE_RATIO);
        let eigenvalue_ratio = if kind == 1 { "0".to_owned() } else { format!("{ratio:.0e}") };
        let smallest_friction = friction.iter().copied().fold(f64::INFINITY, f64::min);
        write!(
            text,
            "| {name} | {dimension} | {} | {smallest_friction} | {eigenvalue_ratio} |",
            friction.len()
        )?;
        match problem.solve() {
            Ok(PublishedSolution { method, iterations, seconds, residual }) => {
                writeln!(
                    text,
                    " {method} | {iterations} | {:.2} | {residual:.0e} |",
                    1e3 * seconds
                )?;
                points[kind].push((1e3 * seconds, residual.max(1e-17)));
                if residual.is_nan() || residual > RESIDUAL_LIMITS[kind] {
                    failed_problems.push(name);
                }
            }
            Err(error) => {
                let message = error.to_string();
                let cause = message.strip_prefix("step 1 (t = 1 s): ").unwrap_or(&message);
                // The text without elements and values.
                let cause = cause.split([':', ',']).next().unwrap_or_default();
                writeln!(text, " {cause} | | | |")?;
                if kind == 0 {
                    failed_problems.push(name);
                }
            }
        }
    }
    println!("{text}");
    let [definite_point, singular_point] = points;
    let panel = FigurePanel::new("time of the step, ms", "residual by the measure of Siconos")
        .double_logarithmic()
        .circles("W definite", CURVE_BLUE, definite_point)
        .crosses("W singular, soft layer", CURVE_RED, singular_point);
    let figure = Figure::new("Problems of FCLIB and of the tests of Siconos", 1, vec![panel]);
    if let Some(docs) = docs {
        splice("contact_problems.md", "published problems", &text)?;
        figure.draw(&docs.join("images/published_problems.svg"))?;
    }
    if failed_problems.is_empty() {
        Ok(())
    } else {
        Err(format!("beyond the limit: {}", failed_problems.join(", ")).into())
    }
}
