//! Newton's method on the semi-smooth equations r = P(r − ρ y).
//!
//! The present r says of each element whether it is open, closed or at its cap, and whether it sticks or slips and which way.
//! Forces that follow from that alone leave the system. The rows of the others:
//!
//! | | |
//! |---|---|
//! | closed | y = offset |
//! | sticks | y = 0, both |
//! | slips along d | t·d = friction (p + attraction) + strength |
//! | across d | (1 − κ) t + κ ρ y = 0, κ = R/\|t − ρ y\|: the direction turns with the slip (Alart & Curnier 1991) |

use super::problem::{Endless, Problem};
use crate::linalg::DenseFactor;

/// Iterations.
const ITERATIONS: usize = 15;
/// Iterations with parts of steps, and the least part.
const WANDERED: usize = 60;
const LEAST: f64 = 0.2;

/// What an element does by its trial.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Status {
    pub(super) normal: Normal,
    pub(super) tangential: Tangential,
}

/// Along the normal.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Normal {
    /// Nothing presses, or the bond is at its strength.
    Open,
    Closed,
    /// The pressure is at its cap.
    Capped,
}

/// Along the base.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Tangential {
    /// There is no friction.
    Free,
    Stick,
    /// In this direction, with κ and the growth of the radius with p.
    Slip {
        direction: [f64; 2],
        turn: f64,
        slope: f64,
    },
}

impl Status {
    /// What it is without its numbers.
    fn kind(&self) -> (Normal, u8) {
        let tangential = match self.tangential {
            Tangential::Free => 0,
            Tangential::Stick => 1,
            Tangential::Slip { .. } => 2,
        };
        (self.normal, tangential)
    }

    /// Whether friction that is less than this lets it slip.
    pub(super) fn is_held_by(&self, friction: f64) -> bool {
        matches!(self.tangential, Tangential::Slip { slope, .. } if slope > 0.0 && slope < friction)
    }

    /// Closed without slip.
    pub(super) const STICK: Self = Self { normal: Normal::Closed, tangential: Tangential::Stick };
    /// Without any force.
    pub(super) const OPEN: Self = Self { normal: Normal::Open, tangential: Tangential::Free };
}

/// Scratch of the method, and factors.
pub(super) struct Newton {
    pub(super) statuses: Vec<Status>,
    /// Components that are unknown.
    dofs: Vec<usize>,
    matrix: Vec<f64>,
    rhs: Vec<f64>,
    known: Vec<f64>,
    factor: DenseFactor,
    /// Statuses whose factors are held, if they are: without slip.
    held: Vec<Status>,
    is_held: bool,
    /// Kinds of the statuses and changes of force, an iteration before.
    kinds: Vec<(Normal, u8)>,
    before: Vec<f64>,
}

impl Newton {
    pub(super) fn new(count: usize) -> Self {
        let size = 3 * count;
        Self {
            statuses: vec![Status::STICK; count],
            dofs: Vec::with_capacity(size),
            matrix: Vec::with_capacity(size * size),
            rhs: Vec::with_capacity(size),
            known: vec![0.0; size],
            factor: DenseFactor::with_capacity(size),
            held: vec![Status::STICK; count],
            is_held: false,
            kinds: Vec::with_capacity(count),
            before: vec![0.0; size],
        }
    }

    /// Forgets the factors: to be called when W has changed.
    pub(super) fn forget(&mut self) {
        self.is_held = false;
    }

    /// Iterates from the present r; iterations made, and whether they found the solution. With `ahead` the radius is
    /// that of the trial's p.
    pub(super) fn solve(&mut self, problem: &mut Problem, ahead: bool) -> (usize, bool) {
        for iteration in 0..ITERATIONS {
            if problem.is_solved() {
                return (iteration, true);
            }
            self.classify(problem, ahead);
            if !self.step(problem) {
                return (iteration + 1, false);
            }
        }
        (ITERATIONS, problem.is_solved())
    }

    /// Makes so many attempts, from `start`, from nothing, and from where all elements stick. Until the statuses stay,
    /// each element takes a part of its own of every step: iterates that come back in a circle do not.
    pub(super) fn wander(
        &mut self,
        problem: &mut Problem,
        start: &[f64],
        attempts: u64,
    ) -> (usize, bool) {
        let mut all = 0;
        for attempt in 0..attempts {
            match attempt % 3 {
                0 => problem.change.copy_from_slice(start),
                1 => (0..problem.size()).for_each(|i| problem.set(i, 0.0)),
                _ => {
                    self.statuses.fill(Status::STICK);
                    self.step(problem);
                }
            }
            let (iterations, found) = self.attempt(problem, attempt);
            all += iterations;
            if found {
                return (all, true);
            }
        }
        (all, false)
    }

    /// One attempt, by its number.
    fn attempt(&mut self, problem: &mut Problem, number: u64) -> (usize, bool) {
        let mut state = number.wrapping_mul(0x9E37_79B9_7F4A_7C15) | 1;
        self.kinds.clear();
        for iteration in 0..WANDERED {
            if problem.is_solved() {
                return (iteration, true);
            }
            self.before.copy_from_slice(&problem.change);
            self.classify(problem, number % 2 == 1);
            let stays = self.kinds.iter().copied().eq(self.statuses.iter().map(Status::kind));
            self.kinds.clear();
            self.kinds.extend(self.statuses.iter().map(Status::kind));
            if !self.step(problem) {
                return (iteration + 1, false);
            }
            if stays {
                continue;
            }
            for e in 0..problem.count {
                // A generator of Marsaglia's (2003).
                state ^= state << 13;
                state ^= state >> 7;
                state ^= state << 17;
                let part = LEAST + (1.0 - LEAST) * (state >> 11) as f64 / (1_u64 << 53) as f64;
                for i in problem.places(e) {
                    let (old, new) = (self.before[i], problem.change[i]);
                    problem.change[i] = old + part * (new - old);
                }
            }
        }
        (WANDERED, problem.is_solved())
    }

    /// Statuses by the trials of the present r and y.
    pub(super) fn classify(&mut self, problem: &Problem, ahead: bool) {
        for (e, status) in self.statuses.iter_mut().enumerate() {
            let (bounds, [p, x, y]) = (&problem.bounds[e], problem.trial(e));
            if bounds.bonded {
                *status = Status::STICK;
                continue;
            }
            let [least, most] = bounds.interval;
            if bounds.is_endless() {
                *status = match problem.endless(e) {
                    Endless::Open => Status::OPEN,
                    Endless::Stick if p >= most => {
                        Status { normal: Normal::Capped, tangential: Tangential::Stick }
                    }
                    Endless::Stick => Status::STICK,
                    Endless::Slip(direction) => {
                        let [_, i, j] = problem.places(e);
                        let along =
                            direction[0] * problem.force(i) + direction[1] * problem.force(j);
                        let turn = (along / x.hypot(y)).clamp(0.0, 1.0);
                        let slope = f64::INFINITY;
                        let tangential = Tangential::Slip { direction, turn, slope };
                        Status { normal: Normal::Closed, tangential }
                    }
                };
                continue;
            }
            let normal = if p <= least {
                Normal::Open
            } else if p >= most {
                Normal::Capped
            } else {
                Normal::Closed
            };
            let pressing = if ahead { bounds.press(p) } else { problem.force(e) };
            let radius = bounds.radius(pressing);
            let size = x.hypot(y);
            let tangential = if radius == 0.0 && (normal == Normal::Open || bounds.friction == 0.0)
            {
                Tangential::Free
            } else if size <= radius {
                Tangential::Stick
            } else {
                let slope = if pressing + bounds.attraction > 0.0 { bounds.taken() } else { 0.0 };
                Tangential::Slip { direction: [x / size, y / size], turn: radius / size, slope }
            };
            *status = Status { normal, tangential };
        }
    }

    /// Solves the system of the statuses; false if it is singular.
    pub(super) fn step(&mut self, problem: &mut Problem) -> bool {
        self.gather(problem);
        let slips = |status: &Status| matches!(status.tangential, Tangential::Slip { .. });
        let sticks = !self.statuses.iter().any(slips);
        let known = sticks && self.is_held && self.held == self.statuses;
        if !known {
            self.assemble(problem);
            self.is_held = false;
            if !self.factor.factor(&self.matrix, self.dofs.len()) {
                return false;
            }
            self.is_held = sticks;
            self.held.copy_from_slice(&self.statuses);
        }
        self.balance(problem);
        self.factor.solve(&mut self.rhs);
        for (&i, value) in self.dofs.iter().zip(&self.rhs) {
            problem.change[i] = *value;
        }
        self.rhs.iter().all(|value| value.is_finite())
    }

    /// Sorts components into unknown ones and those that their status gives, which go into r.
    fn gather(&mut self, problem: &mut Problem) {
        self.dofs.clear();
        for component in 0..3 {
            for (e, status) in self.statuses.iter().enumerate() {
                let i = component * problem.count + e;
                let [least, most] = problem.bounds[e].interval;
                let fixed = match (component, status.normal, status.tangential) {
                    (0, Normal::Open, _) => Some(least),
                    (0, Normal::Capped, _) => Some(most),
                    (1 | 2, _, Tangential::Free) => Some(0.0),
                    _ => None,
                };
                if let Some(value) = fixed {
                    problem.set(i, value);
                } else {
                    problem.change[i] = 0.0;
                    self.dofs.push(i);
                }
            }
        }
    }

    /// The matrix of the unknown components, rows scaled to entries of about one.
    fn assemble(&mut self, problem: &Problem) {
        let count = problem.count;
        self.matrix.clear();
        for &i in &self.dofs {
            let (component, e) = (i / count, i % count);
            let ([n, x, y], [_, tangential]) = (problem.places(e), problem.rho[e]);
            match (component, self.statuses[e].tangential) {
                (1, Tangential::Slip { direction, slope, .. }) => {
                    let [sheared, pressed] = along_slip(slope);
                    self.matrix.extend(self.dofs.iter().map(|&j| match j {
                        j if j == n => -pressed,
                        j if j == x => sheared * direction[0],
                        j if j == y => sheared * direction[1],
                        _ => 0.0,
                    }));
                }
                (2, Tangential::Slip { direction: [c, s], turn, .. }) => {
                    let (rows, factor) = ([problem.row(x), problem.row(y)], turn * tangential);
                    self.matrix.extend(self.dofs.iter().map(|&j| {
                        let own = match j {
                            j if j == x => -s,
                            j if j == y => c,
                            _ => 0.0,
                        };
                        (1.0 - turn) * own + factor * (c * rows[1][j] - s * rows[0][j])
                    }));
                }
                _ => {
                    let (row, scale) = (problem.row(i), problem.rho[e][component.min(1)]);
                    self.matrix.extend(self.dofs.iter().map(|&j| scale * row[j]));
                }
            }
        }
    }

    /// The right-hand side, for the components in r that are known.
    fn balance(&mut self, problem: &mut Problem) {
        problem.respond();
        let count = problem.count;
        self.known.copy_from_slice(&problem.y);
        self.rhs.clear();
        for &i in &self.dofs {
            let (component, e) = (i / count, i % count);
            let (bounds, [_, tangential]) = (&problem.bounds[e], problem.rho[e]);
            let [n, x, y] = problem.places(e);
            let scale = problem.rho[e][component.min(1)];
            self.rhs.push(match (component, self.statuses[e].tangential) {
                (0, _) => scale * (bounds.offset - self.known[i]),
                (1, Tangential::Slip { direction, slope, .. }) => {
                    // Forces as they are without changes, and p where it is known.
                    let along = direction[0] * problem.anchor[x] + direction[1] * problem.anchor[y];
                    let [sheared, pressed] = along_slip(slope);
                    pressed * (problem.force(n) + bounds.attraction)
                        + sheared * (bounds.strength - along)
                }
                (2, Tangential::Slip { direction: [c, s], turn, .. }) => {
                    let across = |values: &[f64]| c * values[y] - s * values[x];
                    (turn - 1.0) * across(&problem.anchor) - turn * tangential * across(&self.known)
                }
                _ => -scale * self.known[i],
            });
        }
    }
}

/// Factors of the shear and of the pressure in the row along a slip: one divided by a friction above one, so that an
/// endless one has its limit.
fn along_slip(friction: f64) -> [f64; 2] {
    if friction > 1.0 { [1.0 / friction, 1.0] } else { [1.0, friction] }
}
