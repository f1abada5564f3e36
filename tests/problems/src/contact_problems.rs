//! Contact problems of single steps: a ground with any compliance matrix under a body too heavy to
//! move. The solution of the simulation is compared with all that brute force finds.

use basemat::bem::{ContactElement, ElasticGround, Ground, Strip};
use basemat::contact::SearchMethod;
use basemat::coupled::State;
use basemat::interface::Coulomb;
use basemat::structure::RigidBlock;
use basemat::{Simulation, Soil, unobserved};

use super::prescribed::Prescribed;
use super::random::Random;

/// Steps of a sequence: problems with the same matrix, each from where the last one ended.
pub const STEPS: usize = 20;
/// Differences of solutions below this, relative to the largest traction, are rounding.
const DISTINCT: f64 = 1e-6;
/// Tolerance of brute force, relative to the largest traction and to the largest jump.
const SLACK: f64 = 1e-10;

/// Delassus operator of a rigid block on a half-plane, and its elements.
fn of_a_scene(count: usize, random: &mut Random) -> (Vec<f64>, Vec<ContactElement>) {
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
    let (mass, height) = (random.log_within(1e3, 1e6), random.within(0.1, 8.0));
    let inertia = mass * (16.0 + 4.0 * height * height) / 12.0;
    let scale = 0.5 * time_step * time_step;
    let elements = ground.elements();
    for (i, j) in (0..size * size).map(|k| (k / size, k % size)) {
        let (x, y) = (elements[i % count].center()[0], elements[j % count].center()[0]);
        let mean = match (i < count, j < count) {
            (true, true) => 1.0 / mass + x * y / inertia,
            (true, false) => -x * height / inertia,
            (false, true) => -y * height / inertia,
            (false, false) => 1.0 / mass + height * height / inertia,
        };
        matrix[i * size + j] += scale * mean * elements[j % count].length();
    }
    (matrix, elements.to_vec())
}

/// Any symmetric positive definite matrix.
fn invented(count: usize, random: &mut Random) -> Vec<f64> {
    let size = 2 * count;
    let root: Vec<f64> = (0..size * size).map(|_| random.within(-1.0, 1.0)).collect();
    let own = random.log_within(1e-3, 1.0);
    let mut matrix = vec![0.0; size * size];
    for (i, j) in (0..size * size).map(|k| (k / size, k % size)) {
        let product: f64 = (0..size).map(|k| root[i * size + k] * root[j * size + k]).sum();
        matrix[i * size + j] = product + if i == j { own } else { 0.0 };
    }
    matrix
}

/// jump = motion + W τ, with Coulomb's conditions on it.
struct Problem<'a> {
    matrix: &'a [f64],
    motion: &'a [f64],
    /// Slips before.
    slip: Vec<f64>,
    friction: f64,
}

/// Largest magnitude.
fn largest(values: &[f64]) -> f64 {
    values.iter().fold(f64::MIN_POSITIVE, |m, x| m.max(x.abs()))
}

impl Problem<'_> {
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
        let (force, length) = (largest(traction), largest(&jump).max(largest(self.motion)));
        (0..count)
            .map(|e| {
                let (pressure, shear) = (traction[e] / force, traction[count + e] / force);
                let gap = jump[e] / length;
                let advance = (-jump[count + e] - self.slip[e]) / length;
                let open = pressure.abs().max(shear.abs()).max(-gap);
                let closed = gap.abs().max(-pressure);
                let stick = advance.abs().max(shear.abs() - self.friction * pressure);
                let slides = |sense: f64| {
                    (shear - sense * self.friction * pressure).abs().max(-sense * advance)
                };
                open.min(closed.max(stick.min(slides(1.0)).min(slides(-1.0))))
            })
            .fold(0.0, f64::max)
    }

    /// All distinct solutions: every mode of every element is tried.
    fn solutions(&self) -> Vec<Vec<f64>> {
        let size = self.motion.len();
        let count = size / 2;
        let mut found: Vec<Vec<f64>> = Vec::new();
        for number in 0..4_usize.pow(u32::try_from(count).unwrap()) {
            let mode = |e: usize| number >> (2 * e) & 3;
            let mut rows = vec![0.0; size * size];
            let mut rhs = vec![0.0; size];
            for e in 0..count {
                let (n, t) = (e, count + e);
                let mut condition = |row: usize, whole: bool, value: f64, own: f64| {
                    let out = &mut rows[row * size..(row + 1) * size];
                    if whole {
                        out.copy_from_slice(&self.matrix[row * size..(row + 1) * size]);
                        rhs[row] = value - self.motion[row];
                    } else {
                        out[row] = 1.0;
                        if row == t {
                            out[n] = own;
                        }
                    }
                };
                match mode(e) {
                    0 => {
                        condition(n, true, 0.0, 0.0);
                        condition(t, true, -self.slip[e], 0.0);
                    }
                    1 => {
                        condition(n, true, 0.0, 0.0);
                        condition(t, false, 0.0, -self.friction);
                    }
                    2 => {
                        condition(n, true, 0.0, 0.0);
                        condition(t, false, 0.0, self.friction);
                    }
                    _ => {
                        condition(n, false, 0.0, 0.0);
                        condition(t, false, 0.0, 0.0);
                    }
                }
            }
            let Some(traction) = solve(rows, rhs) else { continue };
            if self.violation(&traction) > SLACK {
                continue;
            }
            let scale = largest(&traction);
            let new = |known: &Vec<f64>| distance(known, &traction) > DISTINCT * scale;
            if found.iter().all(new) {
                found.push(traction);
            }
        }
        found
    }
}

fn distance(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).fold(0.0, |m, (a, b)| m.max((a - b).abs()))
}

/// Gaussian elimination with row exchanges; `None` if a pivot is zero.
fn solve(mut matrix: Vec<f64>, mut rhs: Vec<f64>) -> Option<Vec<f64>> {
    let n = rhs.len();
    for k in 0..n {
        let by_size =
            |i: &usize, j: &usize| matrix[i * n + k].abs().total_cmp(&matrix[j * n + k].abs());
        let pivot = (k..n).max_by(by_size)?;
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
        let rest: f64 = (k + 1..n).map(|j| matrix[k * n + j] * rhs[j]).sum();
        rhs[k] = (rhs[k] - rest) / matrix[k * n + k];
    }
    rhs.iter().all(|x| x.is_finite()).then_some(rhs)
}

/// Results of a number of problems.
#[derive(Debug, Clone, Copy, Default)]
pub struct Tally {
    pub problems: usize,
    /// Active set, Gauss–Seidel, path.
    pub methods: [usize; 3],
    pub trials: usize,
    pub most_trials: usize,
    /// Problems with several solutions, and most solutions of one.
    pub several: usize,
    pub most_solutions: usize,
    /// Problems in which brute force finds no solution, and steps that failed.
    pub none: usize,
    pub failed: usize,
    /// Largest violation of the conditions, and distance from the nearest solution of brute force.
    pub violation: f64,
    pub distance: f64,
}

impl Tally {
    fn see(&mut self, problem: &Problem<'_>, state: &State) {
        let contact = &state.contact;
        let traction: Vec<f64> =
            contact.iter().map(|c| c.pressure).chain(contact.iter().map(|c| c.shear)).collect();
        // Gaps and slips must be those that the tractions give.
        let jump = problem.jump(&traction);
        let shown = contact.iter().map(|c| c.gap).chain(contact.iter().map(|c| -c.slip));
        let scale = largest(&jump).max(largest(problem.motion));
        let open = shown.zip(&jump).fold(0.0_f64, |m, (a, b)| m.max((a - b).abs())) / scale;
        self.violation = self.violation.max(problem.violation(&traction)).max(open);
        let solutions = problem.solutions();
        self.none += usize::from(solutions.is_empty());
        self.several += usize::from(solutions.len() > 1);
        self.most_solutions = self.most_solutions.max(solutions.len());
        if !solutions.is_empty() {
            let nearest = solutions.iter().map(|s| distance(s, &traction)).fold(f64::MAX, f64::min);
            self.distance = self.distance.max(nearest / largest(&traction));
        }
        self.methods[match state.method {
            SearchMethod::ActiveSet => 0,
            SearchMethod::GaussSeidel => 1,
            SearchMethod::Path => 2,
            other => panic!("{other:?} is not counted"),
        }] += 1;
        self.trials += state.trials;
        self.most_trials = self.most_trials.max(state.trials);
    }

    pub fn add(&mut self, other: &Self) {
        self.problems += other.problems;
        for k in 0..3 {
            self.methods[k] += other.methods[k];
        }
        self.trials += other.trials;
        self.most_trials = self.most_trials.max(other.most_trials);
        self.several += other.several;
        self.most_solutions = self.most_solutions.max(other.most_solutions);
        self.none += other.none;
        self.failed += other.failed;
        self.violation = self.violation.max(other.violation);
        self.distance = self.distance.max(other.distance);
    }
}

/// One sequence of problems with one matrix of `count` elements.
pub fn sequence(count: usize, friction: f64, real: bool, random: &mut Random) -> Tally {
    let (matrix, elements) = if real {
        of_a_scene(count, random)
    } else {
        (invented(count, random), Strip::uniform(0.0..count as f64, count).unwrap().elements())
    };
    let size = 2 * count;
    let (left, right) = (elements[0].left(), elements[count - 1].right());
    let (ground, motion) = Prescribed::new(elements, matrix.clone());
    let body = RigidBlock::from_mass(right - left, 1e60, 1e60, 0.0).unwrap();
    let mut simulation = Simulation::builder(1.0)
        .structure(body.centered_at(0.5 * (left + right)).unwrap())
        .ground(ground)
        .interface(Coulomb::new(friction).unwrap())
        .gravity(0.0)
        .build()
        .unwrap();
    let mut tally = Tally::default();
    for _ in 0..STEPS {
        let before = simulation.state().contact.clone();
        let strength = random.log_within(0.1, 10.0);
        let moving: Vec<f64> = (0..size)
            .map(|i| strength * (random.within(-1.0, 1.0) - if i < count { 0.2 } else { 0.0 }))
            .collect();
        let next: Vec<f64> = (0..size)
            .map(|i| {
                let row = &matrix[i * size..(i + 1) * size];
                let moved: f64 = row.iter().zip(&moving).map(|(w, t)| w * t).sum();
                let start = if i < count { before[i].gap } else { -before[i - count].slip };
                start + moved
            })
            .collect();
        motion.lock().unwrap().copy_from_slice(&next);
        let slip = before.iter().map(|c| c.slip).collect();
        let problem = Problem { matrix: &matrix, motion: &next, slip, friction };
        tally.problems += 1;
        if let Ok(state) = simulation.step() {
            tally.see(&problem, state);
        } else {
            tally.failed += 1;
            tally.none += usize::from(problem.solutions().is_empty());
            break;
        }
    }
    tally
}
