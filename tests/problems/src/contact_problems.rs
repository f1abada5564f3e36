//! Contact problems of single steps: a ground with any compliance matrix under a body too heavy to
//! move. The solution of the simulation is compared with all solutions by enumeration.

use basemat::bem::{ContactElement, ElasticGround, Ground, Strip};
use basemat::contact::SearchMethod;
use basemat::coupled::State;
use basemat::interface::Coulomb;
use basemat::structure::RigidBlock;
use basemat::{Simulation, Soil, unobserved};

use super::prescribed::PrescribedGround;
use super::random::Random;

/// Steps of a sequence: problems with the same matrix, each from where the last one ended.
pub const SEQUENCE_STEPS: usize = 20;
/// Differences of solutions below this, relative to the largest traction, are rounding.
const DISTINCTION_TOLERANCE: f64 = 1e-6;
/// Largest violation by a solution of the enumeration, relative to the largest traction and to the largest jump.
const VIOLATION_TOLERANCE: f64 = 1e-10;

/// Delassus operator of a problem, and its elements.
struct ProblemMatrix {
    delassus: Vec<f64>,
    elements: Vec<ContactElement>,
}

/// Delassus operator of a rigid block on a half-plane.
fn rigid_block_matrix(count: usize, random: &mut Random) -> ProblemMatrix {
    let poisson = random.pick(&[0.0, 0.2, 1.0 / 3.0, 0.45, 0.4999]);
    let soil = Soil::new(1e8, poisson, 2000.0).unwrap();
    let strip = if random.chance(0.5) { Strip::graded } else { Strip::uniform };
    let mut ground = ElasticGround::new(soil, strip(-2.0..2.0, count).unwrap()).unwrap();
    let courant = random.log_within(0.05, 20.0);
    let time_step = courant * 4.0 / count as f64 / soil.pressure_wave_speed();
    ground.prepare(time_step, None, &mut unobserved).unwrap();
    let size = 2 * count;
    let mut matrix = vec![0.0; size * size];
    ground.step_compliance(&mut matrix).unwrap();
    // B (2M/Δt²)⁻¹ Bᵀ A of a block with mass m, inertia I and centre of gravity at h.
    let mass = random.log_within(1e3, 1e6);
    let height = random.within(0.1, 8.0);
    let inertia = mass * (16.0 + 4.0 * height * height) / 12.0;
    let scale = 0.5 * time_step * time_step;
    let elements = ground.elements();
    for (i, j) in (0..size * size).map(|k| (k / size, k % size)) {
        let x = elements[i % count].center()[0];
        let y = elements[j % count].center()[0];
        let mobility = match (i < count, j < count) {
            (true, true) => 1.0 / mass + x * y / inertia,
            (true, false) => -x * height / inertia,
            (false, true) => -y * height / inertia,
            (false, false) => 1.0 / mass + height * height / inertia,
        };
        matrix[i * size + j] += scale * mobility * elements[j % count].length();
    }
    ProblemMatrix { delassus: matrix, elements: elements.to_vec() }
}

/// Any symmetric positive definite matrix.
fn random_matrix(count: usize, random: &mut Random) -> ProblemMatrix {
    let size = 2 * count;
    let root: Vec<f64> = (0..size * size).map(|_| random.within(-1.0, 1.0)).collect();
    let diagonal = random.log_within(1e-3, 1.0);
    let mut matrix = vec![0.0; size * size];
    for (i, j) in (0..size * size).map(|k| (k / size, k % size)) {
        let product: f64 = (0..size).map(|k| root[i * size + k] * root[j * size + k]).sum();
        matrix[i * size + j] = product + if i == j { diagonal } else { 0.0 };
    }
    let elements = Strip::uniform(0.0..count as f64, count).unwrap().elements();
    ProblemMatrix { delassus: matrix, elements }
}

/// The problem jump = motion + W τ, with Signorini's and Coulomb's conditions.
struct StepProblem<'a> {
    matrix: &'a [f64],
    motion: &'a [f64],
    /// Slips at the start of the step.
    slip: Vec<f64>,
    friction: f64,
}

/// Largest magnitude.
fn largest(values: &[f64]) -> f64 {
    values.iter().fold(f64::MIN_POSITIVE, |m, x| m.max(x.abs()))
}

impl StepProblem<'_> {
    fn jump(&self, traction: &[f64]) -> Vec<f64> {
        let size = traction.len();
        (0..size)
            .map(|i| {
                let row = &self.matrix[i * size..(i + 1) * size];
                self.motion[i] + row.iter().zip(traction).map(|(w, t)| w * t).sum::<f64>()
            })
            .collect()
    }

    /// Violation of Signorini's and Coulomb's conditions by tractions, in the best mode of each
    /// element: relative to the largest traction and the largest jump.
    fn violation(&self, traction: &[f64]) -> f64 {
        let count = traction.len() / 2;
        let jump = self.jump(traction);
        let force = largest(traction);
        let length = largest(&jump).max(largest(self.motion));
        (0..count)
            .map(|e| {
                let pressure = traction[e] / force;
                let shear = traction[count + e] / force;
                let gap = jump[e] / length;
                let slip_increment = (-jump[count + e] - self.slip[e]) / length;
                let open_violation = pressure.abs().max(shear.abs()).max(-gap);
                let closed_violation = gap.abs().max(-pressure);
                let stick = slip_increment.abs().max(shear.abs() - self.friction * pressure);
                let slip = [1.0, -1.0].map(|sense: f64| {
                    (shear - sense * self.friction * pressure).abs().max(-sense * slip_increment)
                });
                open_violation.min(closed_violation.max(stick.min(slip[0]).min(slip[1])))
            })
            .fold(0.0, f64::max)
    }

    /// All distinct solutions: every mode of every element is tried.
    fn solutions(&self) -> Vec<Vec<f64>> {
        let size = self.motion.len();
        let count = size / 2;
        let mut solutions: Vec<Vec<f64>> = Vec::new();
        for mode_code in 0..4_usize.pow(u32::try_from(count).unwrap()) {
            let mut system = LinearSystem::new(size);
            for e in 0..count {
                let normal_row = e;
                let tangential_row = count + e;
                match mode_code >> (2 * e) & 3 {
                    0 => {
                        self.prescribe_jump(&mut system, normal_row, 0.0);
                        self.prescribe_jump(&mut system, tangential_row, -self.slip[e]);
                    }
                    1 => {
                        self.prescribe_jump(&mut system, normal_row, 0.0);
                        system.relate_tractions(tangential_row, normal_row, -self.friction);
                    }
                    2 => {
                        self.prescribe_jump(&mut system, normal_row, 0.0);
                        system.relate_tractions(tangential_row, normal_row, self.friction);
                    }
                    _ => {
                        system.rows[normal_row * size + normal_row] = 1.0;
                        system.relate_tractions(tangential_row, normal_row, 0.0);
                    }
                }
            }
            let Some(traction) = solve(system.rows, system.right_side) else { continue };
            if self.violation(&traction) > VIOLATION_TOLERANCE {
                continue;
            }
            let tolerance = DISTINCTION_TOLERANCE * largest(&traction);
            if solutions.iter().all(|other| distance(other, &traction) > tolerance) {
                solutions.push(traction);
            }
        }
        solutions
    }

    /// Sets the equation of a jump: motion + W τ = value.
    fn prescribe_jump(&self, system: &mut LinearSystem, row: usize, value: f64) {
        let range = row * system.size..(row + 1) * system.size;
        system.rows[range.clone()].copy_from_slice(&self.matrix[range]);
        system.right_side[row] = value - self.motion[row];
    }
}

/// Equations of the tractions.
struct LinearSystem {
    size: usize,
    rows: Vec<f64>,
    right_side: Vec<f64>,
}

impl LinearSystem {
    fn new(size: usize) -> Self {
        Self { size, rows: vec![0.0; size * size], right_side: vec![0.0; size] }
    }

    /// Sets the equation of a shear traction: shear + factor · pressure = 0.
    fn relate_tractions(&mut self, shear: usize, pressure: usize, factor: f64) {
        self.rows[shear * self.size + shear] = 1.0;
        self.rows[shear * self.size + pressure] = factor;
    }
}

fn distance(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).fold(0.0, |m, (a, b)| m.max((a - b).abs()))
}

/// Gaussian elimination with row exchanges; `None` if a pivot is zero.
fn solve(mut matrix: Vec<f64>, mut rhs: Vec<f64>) -> Option<Vec<f64>> {
    let n = rhs.len();
    for k in 0..n {
        let pivot =
            (k..n).max_by(|&i, &j| matrix[i * n + k].abs().total_cmp(&matrix[j * n + k].abs()))?;
        if matrix[pivot * n + k] == 0.0 {
            return None;
        }
        for j in k..n {
            matrix.swap(k * n + j, pivot * n + j);
        }
        rhs.swap(k, pivot);
        for i in k + 1..n {
            let factor = matrix[i * n + k] / matrix[k * n + k];
            if factor != 0.0 {
                for j in k..n {
                    matrix[i * n + j] -= factor * matrix[k * n + j];
                }
                rhs[i] -= factor * rhs[k];
            }
        }
    }
    for k in (0..n).rev() {
        let remainder: f64 = (k + 1..n).map(|j| matrix[k * n + j] * rhs[j]).sum();
        rhs[k] = (rhs[k] - remainder) / matrix[k * n + k];
    }
    rhs.iter().all(|x| x.is_finite()).then_some(rhs)
}

/// Counts and largest errors over all problems so far.
#[derive(Debug, Clone, Copy, Default)]
pub struct ContactTally {
    pub problems: usize,
    /// Steps solved by the active set, by Gauss–Seidel and by the path.
    pub methods: [usize; 3],
    pub trials: usize,
    /// Largest number of trials in a step.
    pub max_trials: usize,
    pub ambiguous_problems: usize,
    /// Largest number of solutions of a problem.
    pub max_solutions: usize,
    /// Problems without a solution by enumeration.
    pub unsolvable_problems: usize,
    pub failed_steps: usize,
    /// Largest violation of the contact conditions.
    pub max_violation: f64,
    /// Largest distance from the nearest solution by enumeration.
    pub max_distance: f64,
}

impl ContactTally {
    fn add_step(&mut self, problem: &StepProblem<'_>, state: &State) {
        let contact = &state.contact;
        let traction: Vec<f64> =
            contact.iter().map(|c| c.pressure).chain(contact.iter().map(|c| c.shear)).collect();
        // The gaps and slips of the state must follow from its tractions.
        let jump = problem.jump(&traction);
        let state_jump = contact.iter().map(|c| c.gap).chain(contact.iter().map(|c| -c.slip));
        let scale = largest(&jump).max(largest(problem.motion));
        let jump_error =
            state_jump.zip(&jump).fold(0.0_f64, |m, (a, b)| m.max((a - b).abs())) / scale;
        self.max_violation = self.max_violation.max(problem.violation(&traction)).max(jump_error);
        let solutions = problem.solutions();
        self.unsolvable_problems += usize::from(solutions.is_empty());
        self.ambiguous_problems += usize::from(solutions.len() > 1);
        self.max_solutions = self.max_solutions.max(solutions.len());
        if !solutions.is_empty() {
            let min_distance =
                solutions.iter().map(|s| distance(s, &traction)).fold(f64::MAX, f64::min);
            self.max_distance = self.max_distance.max(min_distance / largest(&traction));
        }
        self.methods[match state.method {
            SearchMethod::ActiveSet => 0,
            SearchMethod::GaussSeidel => 1,
            SearchMethod::Path => 2,
            other => panic!("{other:?} is not counted"),
        }] += 1;
        self.trials += state.trials;
        self.max_trials = self.max_trials.max(state.trials);
    }

    pub fn add(&mut self, other: &Self) {
        self.problems += other.problems;
        for k in 0..3 {
            self.methods[k] += other.methods[k];
        }
        self.trials += other.trials;
        self.max_trials = self.max_trials.max(other.max_trials);
        self.ambiguous_problems += other.ambiguous_problems;
        self.max_solutions = self.max_solutions.max(other.max_solutions);
        self.unsolvable_problems += other.unsolvable_problems;
        self.failed_steps += other.failed_steps;
        self.max_violation = self.max_violation.max(other.max_violation);
        self.max_distance = self.max_distance.max(other.max_distance);
    }
}

/// Solves a sequence of problems with one matrix of `count` elements, of a rigid block or random.
pub fn sequence(
    count: usize,
    friction: f64,
    is_rigid_block: bool,
    random: &mut Random,
) -> ContactTally {
    let ProblemMatrix { delassus: matrix, elements } = if is_rigid_block {
        rigid_block_matrix(count, random)
    } else {
        random_matrix(count, random)
    };
    let size = 2 * count;
    let left = elements[0].left();
    let right = elements[count - 1].right();
    let (ground, motion) = PrescribedGround::new(elements, matrix.clone());
    let body = RigidBlock::from_mass(right - left, 1e60, 1e60, 0.0).unwrap();
    let mut simulation = Simulation::builder(1.0)
        .structure(body.centered_at(0.5 * (left + right)).unwrap())
        .ground(ground)
        .interface(Coulomb::new(friction).unwrap())
        .gravity(0.0)
        .build()
        .unwrap();
    let mut tally = ContactTally::default();
    for _ in 0..SEQUENCE_STEPS {
        let previous_contact = simulation.state().contact.clone();
        let strength = random.log_within(0.1, 10.0);
        let driving_traction: Vec<f64> = (0..size)
            .map(|i| strength * (random.within(-1.0, 1.0) - if i < count { 0.2 } else { 0.0 }))
            .collect();
        let next_motion: Vec<f64> = (0..size)
            .map(|i| {
                let row = &matrix[i * size..(i + 1) * size];
                let increment: f64 = row.iter().zip(&driving_traction).map(|(w, t)| w * t).sum();
                let start = if i < count {
                    previous_contact[i].gap
                } else {
                    -previous_contact[i - count].slip
                };
                start + increment
            })
            .collect();
        motion.lock().unwrap().copy_from_slice(&next_motion);
        let slip = previous_contact.iter().map(|c| c.slip).collect();
        let problem = StepProblem { matrix: &matrix, motion: &next_motion, slip, friction };
        tally.problems += 1;
        if let Ok(state) = simulation.step() {
            tally.add_step(&problem, state);
        } else {
            tally.failed_steps += 1;
            tally.unsolvable_problems += usize::from(problem.solutions().is_empty());
            break;
        }
    }
    tally
}
