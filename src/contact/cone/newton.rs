//! Newton's method on the semi-smooth equations r = P(r − ρ y).
//!
//! The present r and y give each element a status: open, closed or at its cap; sticking or slipping in a direction. The
//! linear system of all statuses gives the next r.

use std::mem::Discriminant;

use super::low_rank_system::LowRankSystem;
use super::problem::{Endless, Problem};
use super::status::{Normal, Status, Tangential};
use super::system::System;

/// Largest number of iterations.
const ITERATIONS: usize = 15;
/// Number of elements from which a factorization takes longer than several sweeps.
pub(super) const MANY_ELEMENTS: usize = 64;
/// With many elements: factor by which an iteration must reduce the residual, and the number of iterations that may not.
const MIN_REDUCTION: f64 = 0.5;
const MAX_SLOW_ITERATIONS: usize = 2;
/// With many elements: residual, relative to the largest force, below which factors of the same step solve.
const NEAR_RESIDUAL: f64 = 1e-4;
/// Largest number of iterations of an attempt with partial steps, and the smallest part of a step.
const WANDERED: usize = 60;
const LEAST: f64 = 0.2;

/// Newton's method, with its scratch.
pub(super) struct Newton {
    pub(super) statuses: Vec<Status>,
    system: System,
    /// The system on a bed of many springs.
    low_rank: Option<LowRankSystem>,
    /// Kinds of the statuses and changes of force in the previous iteration.
    kinds: Vec<(Normal, Discriminant<Tangential>)>,
    before: Vec<f64>,
}

impl Newton {
    pub(super) fn new(count: usize) -> Self {
        Self {
            statuses: vec![Status::STICK; count],
            system: System::new(count),
            low_rank: None,
            kinds: Vec::with_capacity(count),
            before: vec![0.0; 3 * count],
        }
    }

    /// The method for W of low rank.
    pub(super) fn on_bed(count: usize) -> Self {
        Self {
            statuses: vec![Status::STICK; count],
            low_rank: Some(LowRankSystem::new(count)),
            kinds: Vec::with_capacity(count),
            before: vec![0.0; 3 * count],
            ..Self::new(0)
        }
    }

    /// Allocates for W of this rank, if it is of low rank.
    pub(super) fn reserve(&mut self, rank: usize) {
        if let Some(system) = &mut self.low_rank {
            system.reserve(rank);
        }
    }

    /// Discards the factors; call it when W has changed.
    ///
    /// `lasts`: whether W will stay constant.
    pub(super) fn forget(&mut self, lasts: bool) {
        self.system.forget(lasts);
    }

    /// Discards the results of previous steps that influence the choice of a system.
    pub(super) fn begin_step(&mut self) {
        self.system.begin_step();
    }

    /// Iterates from the present r; returns the number of iterations, and whether they found a solution.
    ///
    /// With `ahead` the radius follows from the trial's p instead of the present p.
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

    /// The same for many elements between sweeps: ends early, at the forces of the smallest residual, if the residual
    /// hardly falls.
    ///
    /// Iterations that start too far from the solution let more and more elements slip, and one of them takes longer
    /// than several sweeps.
    pub(super) fn solve_briefly(&mut self, problem: &mut Problem, ahead: bool) -> (usize, bool) {
        let (mut smallest, mut slow) = (f64::INFINITY, 0);
        self.before.copy_from_slice(&problem.change);
        for iteration in 0..=ITERATIONS {
            let residual = problem.residual();
            if residual <= problem.tolerance() {
                return (iteration, true);
            }
            // False for NaN.
            let falls = residual <= MIN_REDUCTION * smallest;
            if iteration > 0 && !falls {
                slow += 1;
            }
            if residual < smallest {
                smallest = residual;
                self.before.copy_from_slice(&problem.change);
            }
            if slow == MAX_SLOW_ITERATIONS || iteration == ITERATIONS {
                problem.change.copy_from_slice(&self.before);
                return (iteration, false);
            }
            self.classify(problem, ahead);
            let is_near = slow == 0 && residual <= NEAR_RESIDUAL * problem.largest();
            if !self.system.solve(problem, &self.statuses, is_near) {
                problem.change.copy_from_slice(&self.before);
                return (iteration + 1, false);
            }
        }
        (ITERATIONS, false)
    }

    /// Makes `attempts` in turn: from `start`, from zero forces and with all elements sticking.
    ///
    /// Until the statuses stay the same, each element takes a random part of each step, which keeps the iterates
    /// from cycling.
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
                    problem.rest();
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

    /// Makes one attempt, by its number.
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
                // Marsaglia's generator (2003).
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

    /// Solves the system of the statuses; `false` if it is singular.
    pub(super) fn step(&mut self, problem: &mut Problem) -> bool {
        match &mut self.low_rank {
            Some(system) => system.solve(problem, &self.statuses),
            None => self.system.solve(problem, &self.statuses, false),
        }
    }
}
