//! A rigid block on two springs that bear no tension, with and without dashpots: the model of Psycharis and Jennings.
//!
//! The model has no sideways motion, in flight neither.

use basemat::Simulation;
use basemat::bem::SpringGround;
use basemat::coupled::Load;
use basemat::interface::Coulomb;
use basemat::motion::STANDARD_GRAVITY;
use basemat::structure::{BaseNode, MatrixModel, RigidBlock, Triplets};

use super::outcome::{Case, Check, Outcome};
use crate::AnyError;
use crate::figure::{BLUE, Figure, Panel, RED};
use basemat_problems::series::{Error, whole};

pub(crate) const CASE: Case = Case {
    name: "two_springs",
    title: "Block on two springs without tension",
    reference: "own solution by matrix exponentials from event to event (model of Psycharis and Jennings 1983; parameters ours)",
    settings: "two elements, base guided sideways; uplift at 5 mrad, 1.5 times the moment of the weight for 0.4 s, then free",
    run,
};

/// Half width, half height (m), mass (kg/m).
const B: f64 = 0.5;
const H: f64 = 2.0;
const MASS: f64 = 1e4;
const WEIGHT: f64 = MASS * STANDARD_GRAVITY;
/// About the middle of the base.
const INERTIA: f64 = MASS * ((B * B + H * H) / 3.0 + H * H);
/// Stiffness of a spring, N/m: one lifts at a tilt of 5 mrad.
const STIFFNESS: f64 = WEIGHT / (2.0 * B * 0.005);
/// Moment in units of N b, and its duration, s.
const PUSH: f64 = 1.5;
const PUSHED: f64 = 0.4;
/// Times that are compared, s.
const SAMPLE: f64 = 0.01;

/// Settlement-free rise of the middle (m), tilt, their rates, and one for the constant part.
type State = [f64; 5];
type Matrix = [[f64; 5]; 5];

fn times(a: &Matrix, b: &Matrix) -> Matrix {
    std::array::from_fn(|i| std::array::from_fn(|j| (0..5).map(|k| a[i][k] * b[k][j]).sum()))
}

/// e^(A t) by squaring a Taylor series.
fn exponential(matrix: &Matrix, time: f64) -> Matrix {
    let halvings = 20;
    let part = time / f64::from(1 << halvings);
    let scaled: Matrix = matrix.map(|row| row.map(|value| value * part));
    let one = |i, j| if i == j { 1.0 } else { 0.0 };
    let mut sum: Matrix = std::array::from_fn(|i| std::array::from_fn(|j| one(i, j)));
    let mut term = sum;
    for n in 1..10 {
        term = times(&term, &scaled).map(|row| row.map(|value| value / f64::from(n)));
        for i in 0..5 {
            for j in 0..5 {
                sum[i][j] += term[i][j];
            }
        }
    }
    for _ in 0..halvings {
        sum = times(&sum, &sum);
    }
    sum
}

/// The block, and for each corner either contact or the compression that its spring had when it was left, with the time
/// since.
struct Model {
    dashpot: f64,
    state: State,
    left: [Option<(f64, f64)>; 2],
}

impl Model {
    const CORNERS: [f64; 2] = [-B, B];

    fn at_rest(dashpot: f64) -> Self {
        let settled = -WEIGHT / (2.0 * STIFFNESS);
        Self { dashpot, state: [settled, 0.0, 0.0, 0.0, 1.0], left: [None; 2] }
    }

    /// Derivatives of the state under a moment.
    fn matrix(&self, moment: f64) -> Matrix {
        let mut matrix = [[0.0; 5]; 5];
        matrix[0][2] = 1.0;
        matrix[1][3] = 1.0;
        matrix[2][4] = -WEIGHT / MASS;
        matrix[3][4] = moment / INERTIA;
        matrix[3][1] = WEIGHT * H / INERTIA;
        let corners = Self::CORNERS.into_iter().zip(self.left);
        for (x, _) in corners.filter(|(_, left)| left.is_none()) {
            let force = [-STIFFNESS, -STIFFNESS * x, -self.dashpot, -self.dashpot * x];
            for (column, value) in force.into_iter().enumerate() {
                matrix[2][column] += value / MASS;
                matrix[3][column] += value * x / INERTIA;
            }
        }
        matrix
    }

    /// Margins of the corners after `elapsed`: force of a spring in contact, its distance from the corner otherwise. A
    /// negative one is an event.
    fn margins(&self, state: &State, elapsed: f64) -> [f64; 2] {
        std::array::from_fn(|k| {
            let x = Self::CORNERS[k];
            let (pressed, closing) = (-(state[0] + x * state[1]), -(state[2] + x * state[3]));
            match self.left[k] {
                None => STIFFNESS * pressed + self.dashpot * closing,
                Some((compression, since)) => {
                    let creep = -STIFFNESS * (since + elapsed) / self.dashpot;
                    compression * creep.exp() - pressed
                }
            }
        })
    }

    /// Advances by `step` under a constant moment, from event to event.
    fn advance(&mut self, moment: f64, step: f64) {
        let mut left = step;
        while left > 0.0 {
            let matrix = self.matrix(moment);
            let after = |elapsed: f64| -> State {
                let map = exponential(&matrix, elapsed);
                map.map(|row| row.iter().zip(&self.state).map(|(a, b)| a * b).sum())
            };
            let happens = |elapsed: f64| {
                self.margins(&after(elapsed), elapsed).into_iter().any(|margin| margin < 0.0)
            };
            let (mut low, mut elapsed) = (0.0, left);
            if happens(left) {
                for _ in 0..45 {
                    let middle = f64::midpoint(low, elapsed);
                    if happens(middle) { elapsed = middle } else { low = middle }
                }
            }
            let state = after(elapsed);
            let margins = self.margins(&state, elapsed);
            for (k, left) in self.left.iter_mut().enumerate() {
                let pressed = -(state[0] + Self::CORNERS[k] * state[1]);
                *left = match *left {
                    None if margins[k] < 0.0 => Some((pressed, 0.0)),
                    Some(_) if margins[k] < 0.0 => None,
                    Some((compression, since)) => Some((compression, since + elapsed)),
                    None => None,
                };
            }
            self.state = state;
            left -= elapsed;
        }
    }
}

/// Tilt and rise of the middle from rest, every `SAMPLE`.
fn reference(dashpot: f64, duration: f64) -> [Vec<f64>; 2] {
    let mut model = Model::at_rest(dashpot);
    let rest = model.state[0];
    let mut series = [vec![0.0], vec![0.0]];
    // Short enough for an event not to be passed over twice.
    let parts = 10;
    for n in 0..whole(duration / SAMPLE) {
        let moment = if n < whole(PUSHED / SAMPLE) { PUSH * WEIGHT * B } else { 0.0 };
        for _ in 0..parts {
            model.advance(moment, SAMPLE / f64::from(parts));
        }
        series[0].push(model.state[1]);
        series[1].push(model.state[0] - rest);
    }
    series
}

/// The block without the mass that couples its sideways motion to its rotation. Base: two elements, each 2b wide.
fn guided() -> Result<MatrixModel, AnyError> {
    let dofs = [RigidBlock::HORIZONTAL, RigidBlock::VERTICAL, RigidBlock::ROTATION];
    let (mut mass, mut stiffness) = (Triplets::new(3), Triplets::new(3));
    for (dof, value) in dofs.into_iter().zip([MASS, MASS, INERTIA]) {
        mass.add(dof, dof, value);
    }
    stiffness.add(RigidBlock::ROTATION, RigidBlock::ROTATION, -WEIGHT * H);
    Ok(MatrixModel::new(mass, stiffness, BaseNode::rigid_base(-2.0 * B, 2.0 * B, dofs))?)
}

/// The same on two elements, whose pressures act at ±b.
fn found(dashpot: f64, time_step: f64, duration: f64) -> Result<[Vec<f64>; 2], AnyError> {
    let width = 2.0 * B;
    let bed = SpringGround::new(-width..width, 2, STIFFNESS / width, 1e13)?
        .with_dashpots(dashpot / width, 0.0)?;
    let push = |time: f64| if time > 0.0 && time < PUSHED { PUSH * WEIGHT * B } else { 0.0 };
    let mut simulation = Simulation::builder(time_step)
        .structure(guided()?)
        .ground(bed)
        .interface(Coulomb::uplift_only())
        .load(Load::new(RigidBlock::ROTATION, push))
        .build()?;
    let every = whole(SAMPLE / time_step);
    let mut series = [vec![0.0], vec![0.0]];
    let run = simulation.run(whole(duration / time_step), |state| {
        if state.step % every == 0 {
            let displacement = state.displacement();
            series[0].push(displacement[RigidBlock::ROTATION]);
            series[1].push(displacement[RigidBlock::VERTICAL]);
        }
    })?;
    if run.energy_error > 1e-9 {
        return Err(format!("energy balance open by {:.1e}", run.energy_error).into());
    }
    Ok(series)
}

fn relative(found: &[f64], wanted: &[f64]) -> f64 {
    let mut error = Error::default();
    found.iter().zip(wanted).for_each(|(a, b)| error.add(*a, *b));
    error.relative()
}

fn run(_short: bool) -> Result<Outcome, AnyError> {
    let duration = 4.0;
    let mut checks = Vec::new();
    let mut panels = Vec::new();
    for (damping, name) in [(0.0, "springs"), (0.02, "damping 2 %"), (0.4, "damping 40 %")] {
        let dashpot = damping * (2.0 * STIFFNESS * MASS).sqrt();
        let wanted = reference(dashpot, duration);
        let runs = [1e-3, 2.5e-4, 6.25e-5].map(|step| found(dashpot, step, duration));
        let [coarse, middle, fine] = runs;
        let [coarse, middle, fine] = [coarse?, middle?, fine?];
        for (k, quantity) in ["tilt", "rise of the middle"].into_iter().enumerate() {
            let limits = if damping < 0.1 { [1e-2, 1e-3, 1e-4] } else { [1e-3, 5e-5, 5e-6] };
            let series = [(&coarse, "1"), (&middle, "0.25"), (&fine, "0.0625")];
            for ((series, step), limit) in series.into_iter().zip(limits) {
                let error = relative(&series[k], &wanted[k]);
                let label = format!("{name}, Δt = {step} ms: {quantity}, relative L2");
                checks.push(Check::below(label, error, limit));
            }
        }
        let points = |series: &[f64]| {
            let each = series.iter().enumerate();
            each.map(|(n, value)| (n as f64 * SAMPLE, 1e3 * value)).collect::<Vec<_>>()
        };
        panels.push(
            Panel::new("time, s", &format!("tilt, mrad ({name})"))
                .room(0.05, 0.25)
                .reference("from event to event", RED, points(&wanted[0]))
                .line("basemat, Δt = 1 ms", BLUE, points(&coarse[0])),
        );
    }
    let title = "Block 1 m × 4 m on two springs without tension, pushed for 0.4 s, then free";
    Ok(Outcome { checks, figure: Figure::new(title, 3, panels) })
}
