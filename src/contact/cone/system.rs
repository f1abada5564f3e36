//! The linear system of given statuses, for corrections that satisfy y = q + W (r − r₀).
//!
//! Each component of an element has a condition on its force or on its motion; the other quantity is unknown.
//! There are two systems with the same solution; the smaller one is solved:
//!
//! | | unknown forces, by W | unknown motions, by W⁻¹ |
//! |---|---|---|
//! | closed | p, with the shear that it lets slip: y = offset | |
//! | open or capped | | y: p = its bound |
//! | sticks | both: y = 0 | |
//! | free | | both: t = 0 |
//! | slips along d | | y·d: t·d = friction (p + attraction) + strength |
//! | across d | t: (1 − κ) t + κ ρ y = 0 | y: the same |
//!
//! κ = R/\|t − ρ y\|: the direction turns with the slip (Alart & Curnier 1991).
//!
//! Both solutions are equal up to rounding. A resumed run must choose as the uninterrupted one does: by the
//! statuses alone if W is constant, otherwise by the statuses of the same step. If all elements stick, the factors
//! of W itself solve.

use super::problem::Problem;
use super::status::{Status, Tangential};
use crate::linalg::{DenseFactor, dense_multiply_add, dot};

/// Number of columns of W⁻¹ that are solved for together.
const BLOCK: usize = 32;
/// Cost of W⁻¹, relative to a factorization of the same order.
const INVERSE: f64 = 4.0;
/// Cost of a product with W⁻¹ of many elements: operations of a factorization for each entry, which memory delivers.
const OPERATIONS_PER_ENTRY: f64 = 24.0;

/// A weighted sum of components: one with weight 1, or the three of an element.
#[derive(Clone, Copy)]
struct Mix {
    places: [usize; 3],
    weights: [f64; 3],
}

impl Mix {
    fn single(place: usize) -> Self {
        Self { places: [place; 3], weights: [1.0, 0.0, 0.0] }
    }

    fn is_single(&self) -> bool {
        self.places[1] == self.places[0]
    }

    fn sum(&self, values: &[f64]) -> f64 {
        let [a, b, c] = self.places.map(|place| values[place]);
        self.weights[0] * a + self.weights[1] * b + self.weights[2] * c
    }

    fn add_to(&self, values: &mut [f64], factor: f64) {
        for (place, weight) in self.places.into_iter().zip(self.weights) {
            values[place] += factor * weight;
        }
    }
}

/// An unknown and its condition. x are the unknown forces or motions, A x the quantities of the other kind. The
/// unknown adds multiples of `column` to x, and row · A x + own column · x = goal.
struct Unknown {
    row: Mix,
    column: Mix,
    own: f64,
    goal: f64,
}

/// The system, its factors and W⁻¹.
#[allow(clippy::struct_excessive_bools, reason = "each says of one matrix whether it is there")]
pub(super) struct System {
    dofs: Vec<Unknown>,
    /// Rows of the conditions with a single component, and the others.
    rows: Vec<usize>,
    mixed_rows: Vec<Mix>,
    rhs: Vec<f64>,
    factor: DenseFactor,
    /// Factors of W, if `is_whole`.
    whole: DenseFactor,
    is_whole: bool,
    /// W⁻¹; empty until it has been computed.
    inverse: Vec<f64>,
    /// Whether W is constant for the whole run.
    lasts: bool,
    /// Cost of the solutions of this step that W⁻¹ would have saved, if W changes.
    spent: f64,
    /// Statuses of the present factors.
    held: Vec<Status>,
    /// Whether the factors belong to `held`, all without slip.
    is_held: bool,
    /// Whether the factors belong to `held`, computed in this step.
    is_recent: bool,
    /// Whether the present factors belong to unknown motions.
    by_motions: bool,
    /// Corrections that follow from the statuses alone, of the same kind as the unknown quantities.
    given: Vec<f64>,
    /// Quantities of the other kind after the given corrections, where a condition has them; also scratch.
    answer: Vec<f64>,
}

impl Problem {
    /// Sets the forces that statuses prescribe, to the last bit.
    pub(super) fn prescribe(&mut self, statuses: &[Status]) {
        for (e, status) in statuses.iter().enumerate() {
            let [n, x, y] = self.places(e);
            if let Some(bound) = status.bound(self.bounds[e].interval) {
                self.set(n, bound);
            }
            if status.tangential == Tangential::Free {
                self.set(x, 0.0);
                self.set(y, 0.0);
            }
        }
    }
}

impl System {
    pub(super) fn new(count: usize) -> Self {
        let size = 3 * count;
        Self {
            dofs: Vec::with_capacity(size),
            rows: Vec::with_capacity(size),
            mixed_rows: Vec::with_capacity(size),
            rhs: Vec::with_capacity(size),
            factor: DenseFactor::with_capacity(size),
            whole: DenseFactor::with_columns(size, BLOCK),
            is_whole: false,
            inverse: Vec::with_capacity(size * size),
            lasts: false,
            spent: 0.0,
            held: vec![Status::STICK; count],
            is_held: false,
            is_recent: false,
            by_motions: false,
            given: vec![0.0; size],
            answer: vec![0.0; size],
        }
    }

    /// Discards factors and W⁻¹; call it when W has changed. `lasts`: whether W will stay constant.
    pub(super) fn forget(&mut self, lasts: bool) {
        (self.is_held, self.is_whole, self.lasts) = (false, false, lasts);
        self.is_recent = false;
        self.inverse.clear();
        self.spent = 0.0;
    }

    /// Discards the results of previous steps that influence the choice of a system.
    pub(super) fn begin_step(&mut self) {
        self.is_recent = false;
        if !self.lasts {
            self.is_held &= !self.by_motions;
            self.inverse.clear();
            self.spent = 0.0;
        }
    }

    /// Corrects r, with its present y, to the solution for `statuses`; `false` if the system is singular.
    ///
    /// With `is_near` factors of the same step for statuses of the same kinds are near enough.
    pub(super) fn solve(
        &mut self,
        problem: &mut Problem,
        statuses: &[Status],
        is_near: bool,
    ) -> bool {
        if statuses.iter().all(|status| *status == Status::STICK) {
            return self.stick(problem);
        }
        let slips = |status: &Status| matches!(status.tangential, Tangential::Slip { .. });
        let sticks = !statuses.iter().any(slips);
        let by_motions = self.prefers_motions(problem, statuses);
        let same_kinds =
            || self.held.iter().map(Status::kind).eq(statuses.iter().map(Status::kind));
        let known = self.by_motions == by_motions
            && (sticks && self.is_held && self.held == statuses
                || is_near && self.is_recent && same_kinds());
        if !known {
            (self.is_held, self.is_recent, self.by_motions) = (false, false, by_motions);
        }
        self.gather(problem, statuses);
        if !known {
            if !self.assemble(problem) {
                return false;
            }
            (self.is_held, self.is_recent) = (sticks, true);
            self.held.copy_from_slice(statuses);
        }
        self.correct(problem);
        problem.prescribe(statuses);
        problem.change.iter().all(|change| change.is_finite())
    }

    /// Corrects r so that nothing moves and all gaps are at their offsets; `false` if W is singular.
    fn stick(&mut self, problem: &mut Problem) -> bool {
        if !self.factor_whole(problem) {
            return false;
        }
        let Self { whole, answer, .. } = self;
        answer.iter_mut().zip(&problem.y).for_each(|(answer, y)| *answer = -y);
        // Normal components are the first.
        answer.iter_mut().zip(&problem.bounds).for_each(|(answer, own)| *answer += own.offset);
        whole.solve(answer);
        problem.change.iter_mut().zip(answer).for_each(|(change, more)| *change += *more);
        problem.change.iter().all(|change| change.is_finite())
    }

    /// Factors W if it has not been factored; `false` if it is singular.
    fn factor_whole(&mut self, problem: &Problem) -> bool {
        self.is_whole = self.is_whole || self.whole.factor(&problem.w, problem.size());
        self.is_whole
    }

    /// Whether fewer motions than forces are unknown, and W⁻¹ is available. W⁻¹ of a constant W is computed at
    /// once, otherwise when it would have saved its own cost in this step.
    fn prefers_motions(&mut self, problem: &Problem, statuses: &[Status]) -> bool {
        let dofs = statuses.iter().map(Status::dofs);
        let [forces, motions] = dofs.fold([0; 2], |[a, b], [c, d]| [a + c, b + d]);
        if motions >= forces {
            return false;
        }
        let size = problem.size();
        let cube = |order: usize| (order as f64).powi(3);
        let gain = cube(forces) - cube(motions);
        if problem.acceleration.is_some() && gain < OPERATIONS_PER_ENTRY * (size * size) as f64 {
            return false;
        }
        self.spent += gain;
        if self.inverse.is_empty() && (self.lasts || self.spent > INVERSE * cube(size)) {
            if !self.factor_whole(problem) {
                return false;
            }
            self.inverse.resize(size * size, 0.0);
            for i in 0..size {
                self.inverse[i * (size + 1)] = 1.0;
            }
            self.inverse.chunks_mut(BLOCK * size).for_each(|rows| self.whole.solve(rows));
        }
        !self.inverse.is_empty()
    }

    /// Lists the unknown quantities, and the known part of the corrections.
    fn gather(&mut self, problem: &Problem, statuses: &[Status]) {
        self.dofs.clear();
        self.given.fill(0.0);
        for (e, status) in statuses.iter().enumerate() {
            self.gather_element(problem, e, status);
        }
        self.dofs.sort_unstable_by_key(|unknown| !unknown.row.is_single());
    }

    /// Lists the unknown quantities of one element, and the known part of its corrections.
    fn gather_element(&mut self, problem: &Problem, e: usize, status: &Status) {
        let motions = self.by_motions;
        let (given, dofs) = (&mut self.given, &mut self.dofs);
        let mut add = |row, column, own, goal| dofs.push(Unknown { row, column, own, goal });
        let places = problem.places(e);
        let ([n, x, y], bounds) = (places, &problem.bounds[e]);
        let [p, tx, ty] = places.map(|i| problem.force(i));
        let [p_0, x_0, y_0] = places.map(|i| problem.anchor[i]);
        let bound = status.bound(bounds.interval);
        match bound {
            Some(bound) if motions => add(Mix::single(n), Mix::single(n), 0.0, bound - p_0),
            Some(bound) => given[n] = bound - p,
            None if motions => given[n] = bounds.offset - problem.y[n],
            None => {}
        }
        // The force p, and the shear that p allows in slip.
        let mut pressing = Mix::single(n);
        match status.tangential {
            Tangential::Free | Tangential::Stick => {
                let sticks = status.tangential == Tangential::Stick;
                for i in [x, y] {
                    let (own, goal) = (Mix::single(i), -problem.anchor[i]);
                    match (motions, sticks) {
                        (false, true) => add(own, own, 0.0, 0.0),
                        (true, false) => add(own, own, 0.0, goal),
                        (false, false) => given[i] = -problem.force(i),
                        (true, true) => given[i] = -problem.y[i],
                    }
                }
            }
            Tangential::Slip { direction: [c, s], turn, slope } => {
                let mix = |weights| Mix { places, weights };
                // Along the slip: shear and pressure are divided by a friction above one, so that infinite friction
                // has its limit.
                let [sheared, pressed] =
                    if slope > 1.0 { [1.0 / slope, 1.0] } else { [1.0, slope] };
                let goal = sheared * bounds.strength + pressed * bounds.attraction;
                if motions {
                    let goal = goal + pressed * p_0 - sheared * (c * x_0 + s * y_0);
                    let row = mix([-pressed, sheared * c, sheared * s]);
                    add(row, mix([0.0, c, s]), 0.0, goal);
                } else {
                    let left = goal + pressed * (p + given[n]) - sheared * (c * tx + s * ty);
                    if bound.is_none() && sheared < 1.0 {
                        given[n] -= left;
                    } else {
                        mix([0.0, c, s]).add_to(given, left / sheared);
                    }
                    pressing = mix([sheared, pressed * c, pressed * s]);
                }
                // Across the slip.
                let (factor, own) = if motions {
                    (1.0 - turn, turn * problem.rho[e][1])
                } else {
                    (turn, (1.0 - turn) / problem.rho[e][1])
                };
                let goal = -if motions { factor } else { own } * (c * y_0 - s * x_0);
                add(mix([0.0, -s * factor, c * factor]), mix([0.0, -s, c]), own, goal);
            }
        }
        if bound.is_none() && !motions {
            add(Mix::single(n), pressing, 0.0, bounds.offset);
        }
    }

    /// Factors the matrix of the unknown quantities; `false` if it is singular.
    fn assemble(&mut self, problem: &Problem) -> bool {
        let (size, motions) = (problem.size(), self.by_motions);
        let Self { dofs, factor, inverse, answer, rows, mixed_rows, .. } = self;
        let matrix = if motions { inverse.as_slice() } else { problem.w.as_slice() };
        let singles = dofs.partition_point(|unknown| unknown.row.is_single());
        let (single, mixed) = dofs.split_at(singles);
        // Compact lists: each column reads them.
        rows.clear();
        rows.extend(single.iter().map(|unknown| unknown.row.places[0]));
        mixed_rows.clear();
        mixed_rows.extend(mixed.iter().map(|unknown| unknown.row));
        factor.factor_columns(dofs.len(), |j, values| {
            let Unknown { column: Mix { places, weights }, own, .. } = &dofs[j];
            // It is symmetric: its rows are its columns.
            let [first, second, third] = places.map(|place| &matrix[place * size..][..size]);
            let column = if dofs[j].column.is_single() {
                first
            } else {
                let [a, b, c] = *weights;
                let others = second.iter().zip(third);
                for ((answer, first), (second, third)) in answer.iter_mut().zip(first).zip(others) {
                    *answer = a * first + b * second + c * third;
                }
                &answer[..]
            };
            let begin = values.len();
            values.extend(rows.iter().map(|place| column[*place]));
            values.extend(mixed_rows.iter().map(|row| row.sum(column)));
            values[begin + j] += own;
        })
    }

    /// Solves, and adds the corrections to r.
    ///
    /// By motions the forces follow from all corrections; motions themselves are left to the next product with W.
    fn correct(&mut self, problem: &mut Problem) {
        let Self { dofs, rhs, factor, inverse, given, answer, .. } = self;
        let Problem { w, change, y, .. } = problem;
        let (matrix, own, other) =
            if self.by_motions { (inverse, y, change) } else { (w, change, y) };
        own.iter_mut().zip(given.iter()).for_each(|(own, given)| *own += given);
        answer.copy_from_slice(other);
        if given.iter().any(|given| *given != 0.0) {
            // Only the rows of conditions; NaN marks the others.
            answer.fill(f64::NAN);
            for place in dofs.iter().flat_map(|unknown| unknown.row.places) {
                if answer[place].is_nan() {
                    answer[place] = other[place] + dot(&matrix[place * given.len()..], given);
                }
            }
        }
        rhs.clear();
        rhs.extend(dofs.iter().map(|unknown| {
            let Unknown { row, column, own: weight, goal } = unknown;
            goal - row.sum(answer) - weight * column.sum(own)
        }));
        factor.solve(rhs);
        let sum = if self.by_motions { &mut *given } else { own };
        dofs.iter().zip(rhs).for_each(|(unknown, x)| unknown.column.add_to(sum, *x));
        if self.by_motions {
            dense_multiply_add(matrix, 1.0, given, other);
        }
    }
}
