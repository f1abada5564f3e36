//! A rigid block on two springs without tension, the model of Psycharis and Jennings.
//!
//! The springs have dashpots in some cases. The model has no sideways motion, also without contact.

use basemat::Simulation;
use basemat::bem::SpringGround;
use basemat::coupled::Load;
use basemat::interface::Coulomb;
use basemat::motion::STANDARD_GRAVITY;
use basemat::structure::{BaseNode, MatrixModel, RigidBlock, Triplets};

use super::outcome::{ValidationCase, ValidationCheck, ValidationOutcome, milli_curve};
use crate::AnyError;
use crate::figure::{CURVE_BLUE, CURVE_RED, Figure, FigurePanel};
use basemat_problems::series::{RelativeError, nearest_integer};

pub(crate) const VALIDATION_CASE: ValidationCase = ValidationCase {
    name: "two_springs",
    title: "Block on two springs without tension",
    reference: "separate solution by matrix exponentials from event to event (model of Psycharis and Jennings 1983; parameters ours)",
    settings: "two elements, base guided sideways; uplift at 5 mrad, 1.5 times the moment of the weight for 0.4 s, then free",
    run,
};

/// Half width, half height (m), mass (kg/m).
const B: f64 = 0.5;
const H: f64 = 2.0;
const BLOCK_MASS: f64 = 1e4;
const BLOCK_WEIGHT: f64 = BLOCK_MASS * STANDARD_GRAVITY;
/// Moment of inertia about the middle of the base.
const BASE_INERTIA: f64 = BLOCK_MASS * ((B * B + H * H) / 3.0 + H * H);
/// Stiffness of a spring, N/m; one spring lifts at a tilt of 5 mrad.
const SPRING_STIFFNESS: f64 = BLOCK_WEIGHT / (2.0 * B * 0.005);
/// Moment in units of N b, and its duration, s.
const PUSH_FACTOR: f64 = 1.5;
const PUSH_DURATION: f64 = 0.4;
/// Interval of the samples, s.
const SAMPLE_INTERVAL: f64 = 0.01;

/// Rise of the middle over unloaded springs (m), tilt, their rates, and 1 for the constant part.
type BlockState = [f64; 5];
type StateMatrix = [[f64; 5]; 5];

fn product(a: &StateMatrix, b: &StateMatrix) -> StateMatrix {
    std::array::from_fn(|i| std::array::from_fn(|j| (0..5).map(|k| a[i][k] * b[k][j]).sum()))
}

/// e^(A t) by squaring a Taylor series.
fn exponential(matrix: &StateMatrix, time: f64) -> StateMatrix {
    let halvings = 20;
    let part = time / f64::from(1 << halvings);
    let scaled_matrix: StateMatrix = matrix.map(|row| row.map(|value| value * part));
    let mut sum: StateMatrix =
        std::array::from_fn(|i| std::array::from_fn(|j| if i == j { 1.0 } else { 0.0 }));
    let mut term = sum;
    for n in 1..10 {
        term = product(&term, &scaled_matrix).map(|row| row.map(|value| value / f64::from(n)));
        for i in 0..5 {
            for j in 0..5 {
                sum[i][j] += term[i][j];
            }
        }
    }
    for _ in 0..halvings {
        sum = product(&sum, &sum);
    }
    sum
}

/// Spring that is not in contact.
#[derive(Clone, Copy)]
struct OpenSpring {
    /// Compression at the end of its contact, m.
    compression: f64,
    /// Time since then, s.
    elapsed: f64,
}

/// The block and its springs; `None` for a spring in contact.
struct TwoSprings {
    dashpot: f64,
    state: BlockState,
    open: [Option<OpenSpring>; 2],
}

impl TwoSprings {
    const CORNER_POSITIONS: [f64; 2] = [-B, B];

    fn at_rest(dashpot: f64) -> Self {
        let settlement = -BLOCK_WEIGHT / (2.0 * SPRING_STIFFNESS);
        Self { dashpot, state: [settlement, 0.0, 0.0, 0.0, 1.0], open: [None; 2] }
    }

    /// Derivatives of the state under a moment.
    fn matrix(&self, moment: f64) -> StateMatrix {
        let mut matrix = [[0.0; 5]; 5];
        matrix[0][2] = 1.0;
        matrix[1][3] = 1.0;
        matrix[2][4] = -BLOCK_WEIGHT / BLOCK_MASS;
        matrix[3][4] = moment / BASE_INERTIA;
        matrix[3][1] = BLOCK_WEIGHT * H / BASE_INERTIA;
        let corners = Self::CORNER_POSITIONS.into_iter().zip(self.open);
        for (x, _) in corners.filter(|(_, open)| open.is_none()) {
            let force =
                [-SPRING_STIFFNESS, -SPRING_STIFFNESS * x, -self.dashpot, -self.dashpot * x];
            for (column, value) in force.into_iter().enumerate() {
                matrix[2][column] += value / BLOCK_MASS;
                matrix[3][column] += value * x / BASE_INERTIA;
            }
        }
        matrix
    }

    /// Margins of the corners after `elapsed`; a negative margin is an event.
    ///
    /// They are the force of a spring in contact, and the distance of an open spring from its corner.
    fn margins(&self, state: &BlockState, elapsed_time: f64) -> [f64; 2] {
        std::array::from_fn(|k| {
            let x = Self::CORNER_POSITIONS[k];
            let compression = -(state[0] + x * state[1]);
            let closing_rate = -(state[2] + x * state[3]);
            match self.open[k] {
                None => SPRING_STIFFNESS * compression + self.dashpot * closing_rate,
                Some(spring) => {
                    let creep = -SPRING_STIFFNESS * (spring.elapsed + elapsed_time) / self.dashpot;
                    spring.compression * creep.exp() - compression
                }
            }
        })
    }

    /// State after `elapsed` with derivatives by `matrix`.
    fn after(&self, matrix: &StateMatrix, elapsed_time: f64) -> BlockState {
        let map = exponential(matrix, elapsed_time);
        map.map(|row| row.iter().zip(&self.state).map(|(a, b)| a * b).sum())
    }

    /// Whether an event happens within `elapsed`.
    fn has_event(&self, matrix: &StateMatrix, elapsed_time: f64) -> bool {
        let margins = self.margins(&self.after(matrix, elapsed_time), elapsed_time);
        margins.into_iter().any(|margin| margin < 0.0)
    }

    /// Advances by `step` under a constant moment, from event to event.
    fn advance(&mut self, moment: f64, step: f64) {
        let mut rest = step;
        while rest > 0.0 {
            let matrix = self.matrix(moment);
            let mut low = 0.0;
            let mut elapsed = rest;
            if self.has_event(&matrix, rest) {
                for _ in 0..45 {
                    let middle = f64::midpoint(low, elapsed);
                    if self.has_event(&matrix, middle) { elapsed = middle } else { low = middle }
                }
            }
            let state = self.after(&matrix, elapsed);
            let margins = self.margins(&state, elapsed);
            for (k, open) in self.open.iter_mut().enumerate() {
                let compression = -(state[0] + Self::CORNER_POSITIONS[k] * state[1]);
                *open = match *open {
                    None if margins[k] < 0.0 => Some(OpenSpring { compression, elapsed: 0.0 }),
                    Some(_) if margins[k] < 0.0 => None,
                    Some(spring) => {
                        Some(OpenSpring { elapsed: spring.elapsed + elapsed, ..spring })
                    }
                    None => None,
                };
            }
            self.state = state;
            rest -= elapsed;
        }
    }
}

/// Tilt and rise of the middle from rest, at every sample.
fn reference(dashpot: f64, duration: f64) -> [Vec<f64>; 2] {
    let mut model = TwoSprings::at_rest(dashpot);
    let rest = model.state[0];
    let mut series = [vec![0.0], vec![0.0]];
    // The parts are so short that no event happens twice in one of them.
    let parts = 10;
    for n in 0..nearest_integer(duration / SAMPLE_INTERVAL) {
        let moment = if n < nearest_integer(PUSH_DURATION / SAMPLE_INTERVAL) {
            PUSH_FACTOR * BLOCK_WEIGHT * B
        } else {
            0.0
        };
        for _ in 0..parts {
            model.advance(moment, SAMPLE_INTERVAL / f64::from(parts));
        }
        series[0].push(model.state[1]);
        series[1].push(model.state[0] - rest);
    }
    series
}

/// The block without the mass that couples its sideways motion to its rotation. Base: two elements, each 2b wide.
fn guided() -> Result<MatrixModel, AnyError> {
    let dofs = [RigidBlock::HORIZONTAL_DOF, RigidBlock::VERTICAL_DOF, RigidBlock::ROTATION_DOF];
    let mut mass = Triplets::new(3);
    let mut stiffness = Triplets::new(3);
    for (dof, value) in dofs.into_iter().zip([BLOCK_MASS, BLOCK_MASS, BASE_INERTIA]) {
        mass.add(dof, dof, value);
    }
    stiffness.add(RigidBlock::ROTATION_DOF, RigidBlock::ROTATION_DOF, -BLOCK_WEIGHT * H);
    Ok(MatrixModel::new(mass, stiffness, BaseNode::rigid_base(-2.0 * B, 2.0 * B, dofs))?)
}

/// Tilt and rise of the block on two elements, whose pressures act at ±b.
fn computed(dashpot: f64, time_step: f64, duration: f64) -> Result<[Vec<f64>; 2], AnyError> {
    let width = 2.0 * B;
    let bed = SpringGround::new(-width..width, 2, SPRING_STIFFNESS / width, 1e13)?
        .with_dashpots(dashpot / width, 0.0)?;
    let mut simulation = Simulation::builder(time_step)
        .structure(guided()?)
        .ground(bed)
        .interface(Coulomb::uplift_only())
        .load(Load::new(RigidBlock::ROTATION_DOF, |time: f64| {
            if time > 0.0 && time < PUSH_DURATION { PUSH_FACTOR * BLOCK_WEIGHT * B } else { 0.0 }
        }))
        .build()?;
    let stride = nearest_integer(SAMPLE_INTERVAL / time_step);
    let mut series = [vec![0.0], vec![0.0]];
    let run = simulation.run(nearest_integer(duration / time_step), |state| {
        if state.step % stride == 0 {
            let displacement = state.displacement();
            series[0].push(displacement[RigidBlock::ROTATION_DOF]);
            series[1].push(displacement[RigidBlock::VERTICAL_DOF]);
        }
    })?;
    if run.energy_error > 1e-9 {
        return Err(format!("energy balance open by {:.1e}", run.energy_error).into());
    }
    Ok(series)
}

fn relative(computed: &[f64], reference: &[f64]) -> f64 {
    let mut error = RelativeError::default();
    computed.iter().zip(reference).for_each(|(a, b)| error.add(*a, *b));
    error.relative()
}

fn run(_short: bool) -> Result<ValidationOutcome, AnyError> {
    let duration = 4.0;
    let mut checks = Vec::new();
    let mut panels = Vec::new();
    for (damping, name) in [(0.0, "springs"), (0.02, "damping 2 %"), (0.4, "damping 40 %")] {
        let dashpot = damping * (2.0 * SPRING_STIFFNESS * BLOCK_MASS).sqrt();
        let reference = reference(dashpot, duration);
        let coarse = computed(dashpot, 1e-3, duration)?;
        let middle = computed(dashpot, 2.5e-4, duration)?;
        let fine = computed(dashpot, 6.25e-5, duration)?;
        for (k, quantity) in ["tilt", "rise of the middle"].into_iter().enumerate() {
            let limits = if damping < 0.1 { [1e-2, 1e-3, 1e-4] } else { [1e-3, 5e-5, 5e-6] };
            let series = [(&coarse, "1"), (&middle, "0.25"), (&fine, "0.0625")];
            for ((series, step), limit) in series.into_iter().zip(limits) {
                let error = relative(&series[k], &reference[k]);
                let label = format!("{name}, Δt = {step} ms: {quantity}, relative L2");
                checks.push(ValidationCheck::below(label, error, limit));
            }
        }
        panels.push(
            FigurePanel::new("time, s", &format!("tilt, mrad ({name})"))
                .room(0.05, 0.25)
                .reference(
                    "from event to event",
                    CURVE_RED,
                    milli_curve(SAMPLE_INTERVAL, &reference[0]),
                )
                .line("basemat, Δt = 1 ms", CURVE_BLUE, milli_curve(SAMPLE_INTERVAL, &coarse[0])),
        );
    }
    let title = "Block 1 m × 4 m on two springs without tension, pushed for 0.4 s, then free";
    Ok(ValidationOutcome { checks, figure: Figure::new(title, 3, panels) })
}
