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

use super::problem::Problem;
use crate::linalg::DenseFactor;

/// Iterations.
const ITERATIONS: usize = 15;

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

    /// Statuses by the trials of the present r and y.
    pub(super) fn classify(&mut self, problem: &Problem, ahead: bool) {
        for (e, status) in self.statuses.iter_mut().enumerate() {
            let (bounds, [p, x, y]) = (&problem.bounds[e], problem.trial(e));
            if bounds.bonded {
                *status = Status::STICK;
                continue;
            }
            let [least, most] = bounds.interval;
            let normal = if p <= least {
                Normal::Open
            } else if p >= most {
                Normal::Capped
            } else {
                Normal::Closed
            };
            let pressing = if ahead { bounds.press(p) } else { problem.r[e] };
            let radius = bounds.radius(pressing);
            let size = x.hypot(y);
            let tangential = if radius == 0.0 && (normal == Normal::Open || bounds.friction == 0.0)
            {
                Tangential::Free
            } else if size <= radius {
                Tangential::Stick
            } else {
                let slope = if pressing + bounds.attraction > 0.0 { bounds.slope() } else { 0.0 };
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
            problem.r[i] = *value;
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
                match fixed {
                    Some(value) => problem.r[i] = value,
                    None => {
                        problem.r[i] = 0.0;
                        self.dofs.push(i);
                    }
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
                    // Along the slip; divided by a friction above one.
                    let scale = 1.0 / slope.max(1.0);
                    self.matrix.extend(self.dofs.iter().map(|&j| match j {
                        j if j == n => -slope * scale,
                        j if j == x => scale * direction[0],
                        j if j == y => scale * direction[1],
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
                (1, Tangential::Slip { slope, .. }) => {
                    // Of a p that is known; of an unknown one it is zero here.
                    let force = slope * (problem.r[n] + bounds.attraction) + bounds.strength;
                    force / slope.max(1.0)
                }
                (2, Tangential::Slip { direction: [c, s], turn, .. }) => {
                    -turn * tangential * (c * self.known[y] - s * self.known[x])
                }
                _ => -scale * self.known[i],
            });
        }
    }
}
