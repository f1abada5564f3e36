//! The linear system of known statuses, for corrections that satisfy y = q + W (r − r₀).
//!
//! Each component of an element has a condition on its force or on its motion; the other quantity is unknown.
//! There are two systems with the same solution; the smaller one is solved:
//!
//! | | unknown forces, by W | unknown motions, by W⁻¹ |
//! |---|---|---|
//! | closed | p, with the shear that it lets slip: y = offset | |
//! | open or capped | | y: p = its bound |
//! | hardens by k | p, as if closed: y + (p − cap)/k = offset | y: p + k y = cap + k offset |
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

use super::problem::ConeProblem;
use super::status::{Normal, Status, Tangential};
use super::unknown::{Mix, Unknown};
use crate::linalg::{DenseFactor, dense_multiply_add, dot};

/// Number of columns of W⁻¹ that are solved together.
const INVERSE_BLOCK_COLUMNS: usize = 32;
/// Cost of W⁻¹, relative to a factorization of the same order.
const INVERSE_COST_FACTOR: f64 = 4.0;

/// The system, its factors and W⁻¹.
#[allow(clippy::struct_excessive_bools, reason = "each says of one matrix whether it is there")]
pub(super) struct System {
    dofs: Vec<Unknown>,
    /// Rows of the conditions with a single component, and the others.
    rows: Vec<usize>,
    mixed_rows: Vec<Mix>,
    rhs: Vec<f64>,
    factor: DenseFactor,
    /// Factors of W, if `has_whole_factor`.
    whole_factor: DenseFactor,
    has_whole_factor: bool,
    /// W⁻¹; empty until it has been computed.
    inverse: Vec<f64>,
    /// Whether W is constant for the whole run.
    is_constant: bool,
    /// Cost of the solutions of this step that W⁻¹ would have saved, if W changes.
    saved_cost: f64,
    /// Statuses of the present factors.
    factored_statuses: Vec<Status>,
    /// Whether the factors belong to `factored_statuses`, all without slip.
    is_reusable: bool,
    /// Whether the factors belong to `factored_statuses`, computed in this step.
    is_recent: bool,
    /// Whether the present factors belong to unknown motions.
    by_motions: bool,
    /// Corrections that follow from the statuses alone, of the same kind as the unknown quantities.
    known: Vec<f64>,
    /// Quantities of the other kind after the known corrections, where a condition has them; also scratch.
    products: Vec<f64>,
}

/// Cost of a factorization of this order.
fn cube(order: usize) -> f64 {
    (order as f64).powi(3)
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
            whole_factor: DenseFactor::with_columns(size, INVERSE_BLOCK_COLUMNS),
            has_whole_factor: false,
            inverse: Vec::with_capacity(size * size),
            is_constant: false,
            saved_cost: 0.0,
            factored_statuses: vec![Status::CLOSED_STICKING; count],
            is_reusable: false,
            is_recent: false,
            by_motions: false,
            known: vec![0.0; size],
            products: vec![0.0; size],
        }
    }

    /// Discards factors and W⁻¹; call it when W has changed. `is_constant`: whether W will stay constant.
    pub(super) fn forget(&mut self, is_constant: bool) {
        self.is_reusable = false;
        self.has_whole_factor = false;
        self.is_constant = is_constant;
        self.is_recent = false;
        self.inverse.clear();
        self.saved_cost = 0.0;
    }

    /// Discards the results of previous steps that influence the choice of a system.
    pub(super) fn begin_step(&mut self) {
        self.is_recent = false;
        if !self.is_constant {
            self.is_reusable &= !self.by_motions;
            self.inverse.clear();
            self.saved_cost = 0.0;
        }
    }

    /// Corrects r, with its present y, to the solution for `statuses`; `false` if the system is singular.
    ///
    /// With `is_near` factors of the same step for statuses of the same kinds are near enough.
    pub(super) fn solve(
        &mut self,
        problem: &mut ConeProblem,
        statuses: &[Status],
        is_near: bool,
    ) -> bool {
        if statuses.iter().all(|status| *status == Status::CLOSED_STICKING) {
            return self.solve_sticking(problem);
        }
        let has_no_slip =
            !statuses.iter().any(|status| matches!(status.tangential, Tangential::Slip { .. }));
        let by_motions = self.prefers_motions(problem, statuses);
        let is_factored = self.by_motions == by_motions
            && (has_no_slip && self.is_reusable && self.factored_statuses == statuses
                || is_near && self.is_recent && self.has_factors_of_kinds(statuses));
        if !is_factored {
            self.is_reusable = false;
            self.is_recent = false;
            self.by_motions = by_motions;
        }
        self.gather(problem, statuses);
        if !is_factored {
            if !self.assemble(problem) {
                return false;
            }
            self.is_reusable = has_no_slip;
            self.is_recent = true;
            self.factored_statuses.copy_from_slice(statuses);
        }
        self.correct(problem);
        problem.prescribe(statuses);
        problem.change.iter().all(|change| change.is_finite())
    }

    /// Whether the present factors belong to statuses of the same kinds.
    fn has_factors_of_kinds(&self, statuses: &[Status]) -> bool {
        self.factored_statuses.iter().map(Status::kind).eq(statuses.iter().map(Status::kind))
    }

    /// Corrects r so that nothing moves and all gaps are at their offsets; `false` if W is singular.
    fn solve_sticking(&mut self, problem: &mut ConeProblem) -> bool {
        if !self.factor_whole(problem) {
            return false;
        }
        let Self { whole_factor, products, .. } = self;
        for (value, y) in products.iter_mut().zip(&problem.y) {
            *value = -y;
        }
        // Normal components are the first.
        for (value, bounds) in products.iter_mut().zip(&problem.bounds) {
            *value += bounds.offset;
        }
        whole_factor.solve(products);
        for (change, correction) in problem.change.iter_mut().zip(products) {
            *change += *correction;
        }
        problem.change.iter().all(|change| change.is_finite())
    }

    /// Factors W if it has not been factored; `false` if it is singular.
    fn factor_whole(&mut self, problem: &ConeProblem) -> bool {
        self.has_whole_factor =
            self.has_whole_factor || self.whole_factor.factor(&problem.w, problem.size());
        self.has_whole_factor
    }

    /// Whether fewer motions than forces are unknown, and W⁻¹ is available. W⁻¹ of a constant W is computed at
    /// once, otherwise when it would have saved its own cost in this step.
    fn prefers_motions(&mut self, problem: &ConeProblem, statuses: &[Status]) -> bool {
        let forces: usize = statuses.iter().map(|status| status.unknown_counts()[0]).sum();
        let motions: usize = statuses.iter().map(|status| status.unknown_counts()[1]).sum();
        if motions >= forces {
            return false;
        }
        let size = problem.size();
        let gain = cube(forces) - cube(motions);
        self.saved_cost += gain;
        if self.inverse.is_empty()
            && (self.is_constant || self.saved_cost > INVERSE_COST_FACTOR * cube(size))
        {
            if !self.factor_whole(problem) {
                return false;
            }
            self.inverse.resize(size * size, 0.0);
            for i in 0..size {
                self.inverse[i * (size + 1)] = 1.0;
            }
            self.inverse
                .chunks_mut(INVERSE_BLOCK_COLUMNS * size)
                .for_each(|rows| self.whole_factor.solve(rows));
        }
        !self.inverse.is_empty()
    }

    /// Lists the unknown quantities, and the known part of the corrections.
    fn gather(&mut self, problem: &ConeProblem, statuses: &[Status]) {
        self.dofs.clear();
        self.known.fill(0.0);
        for (e, status) in statuses.iter().enumerate() {
            self.gather_element(problem, e, status);
        }
        self.dofs.sort_unstable_by_key(|unknown| !unknown.row.is_single());
    }

    /// Lists the unknown quantities of one element, and the known part of its corrections.
    fn gather_element(&mut self, problem: &ConeProblem, e: usize, status: &Status) {
        let motions = self.by_motions;
        let known = &mut self.known;
        let dofs = &mut self.dofs;
        let mut add = |row, column, coefficient, goal| {
            dofs.push(Unknown::new(row, column, coefficient, goal));
        };
        let places = problem.places(e);
        let [n, x, y] = places;
        let bounds = &problem.bounds[e];
        let [p, tx, ty] = places.map(|i| problem.force(i));
        let [p_0, x_0, y_0] = places.map(|i| problem.anchor[i]);
        let bound = status.bound(bounds.interval);
        match bound {
            Some(bound) if motions => add(Mix::single(n), Mix::single(n), 0.0, bound - p_0),
            Some(bound) => known[n] = bound - p,
            None if !motions => {}
            None => match status.normal {
                Normal::Hardening(stiffness) => {
                    let goal = bounds.interval[1] + stiffness * bounds.offset - p_0;
                    add(Mix::single(n), Mix::single(n), stiffness, goal);
                }
                _ => known[n] = bounds.offset - problem.y[n],
            },
        }
        // The force p, and the shear that p allows in slip.
        let mut pressing = Mix::single(n);
        match status.tangential {
            Tangential::Free | Tangential::Stick => {
                let sticks = status.tangential == Tangential::Stick;
                for i in [x, y] {
                    let component = Mix::single(i);
                    match (motions, sticks) {
                        (false, true) => add(component, component, 0.0, 0.0),
                        (true, false) => add(component, component, 0.0, -problem.anchor[i]),
                        (false, false) => known[i] = -problem.force(i),
                        (true, true) => known[i] = -problem.y[i],
                    }
                }
            }
            Tangential::Slip { direction: [c, s], turn, slope } => {
                let mix = |weights| Mix { places, weights };
                // Along the slip: shear and pressure are divided by a friction above one, so that infinite friction
                // has its limit.
                let sheared = if slope > 1.0 { 1.0 / slope } else { 1.0 };
                let pressed = if slope > 1.0 { 1.0 } else { slope };
                let goal = sheared * bounds.strength + pressed * bounds.attraction;
                if motions {
                    let goal = goal + pressed * p_0 - sheared * (c * x_0 + s * y_0);
                    let row = mix([-pressed, sheared * c, sheared * s]);
                    add(row, mix([0.0, c, s]), 0.0, goal);
                } else {
                    let excess = goal + pressed * (p + known[n]) - sheared * (c * tx + s * ty);
                    if bound.is_none() && sheared < 1.0 {
                        known[n] -= excess;
                    } else {
                        mix([0.0, c, s]).add_to(known, excess / sheared);
                    }
                    pressing = mix([sheared, pressed * c, pressed * s]);
                }
                // Across the slip.
                let factor = if motions { 1.0 - turn } else { turn };
                let coefficient = if motions {
                    turn * problem.rho[e][1]
                } else {
                    (1.0 - turn) / problem.rho[e][1]
                };
                let goal = -if motions { factor } else { coefficient } * (c * y_0 - s * x_0);
                add(mix([0.0, -s * factor, c * factor]), mix([0.0, -s, c]), coefficient, goal);
            }
        }
        if bound.is_none() && !motions {
            let mut pressed = Unknown::new(Mix::single(n), pressing, 0.0, bounds.offset);
            if let Normal::Hardening(stiffness) = status.normal {
                pressed.coefficient = stiffness.recip();
                pressed.weighted = Mix::single(n);
                pressed.goal += (bounds.interval[1] - p_0) * pressed.coefficient;
            }
            dofs.push(pressed);
        }
    }

    /// Factors the matrix of the unknown quantities; `false` if it is singular.
    fn assemble(&mut self, problem: &ConeProblem) -> bool {
        let size = problem.size();
        let motions = self.by_motions;
        let Self { dofs, factor, inverse, products, rows, mixed_rows, .. } = self;
        let matrix = if motions { inverse.as_slice() } else { problem.w.as_slice() };
        let single_count = dofs.partition_point(|unknown| unknown.row.is_single());
        // Compact lists: each column reads them.
        rows.clear();
        rows.extend(dofs[..single_count].iter().map(|unknown| unknown.row.places[0]));
        mixed_rows.clear();
        mixed_rows.extend(dofs[single_count..].iter().map(|unknown| unknown.row));
        factor.factor_columns(dofs.len(), |j, values| {
            let Mix { places, weights } = &dofs[j].column;
            // It is symmetric: its rows are its columns.
            let [first, second, third] = places.map(|place| &matrix[place * size..][..size]);
            let column = if dofs[j].column.is_single() {
                first
            } else {
                let others = second.iter().zip(third);
                for ((value, first), (second, third)) in products.iter_mut().zip(first).zip(others)
                {
                    *value = weights[0] * first + weights[1] * second + weights[2] * third;
                }
                &products[..]
            };
            let begin = values.len();
            values.extend(rows.iter().map(|place| column[*place]));
            values.extend(mixed_rows.iter().map(|row| row.sum(column)));
            values[begin + j] += dofs[j].diagonal();
        })
    }

    /// Solves, and adds the corrections to r.
    ///
    /// By motions the forces follow from all corrections; motions themselves are left to the next product with W.
    fn correct(&mut self, problem: &mut ConeProblem) {
        let Self { dofs, rhs, factor, inverse, known, products, .. } = self;
        let ConeProblem { w, change, y, .. } = problem;
        let matrix = if self.by_motions { inverse } else { w };
        // Quantities of the kind of the unknown, and of the other kind.
        let (solved, other) = if self.by_motions { (y, change) } else { (change, y) };
        for (value, known) in solved.iter_mut().zip(known.iter()) {
            *value += known;
        }
        products.copy_from_slice(other);
        if known.iter().any(|known| *known != 0.0) {
            // Only the rows of conditions; NaN marks the others.
            products.fill(f64::NAN);
            for place in dofs.iter().flat_map(|unknown| unknown.row.places) {
                if products[place].is_nan() {
                    products[place] = other[place] + dot(&matrix[place * known.len()..], known);
                }
            }
        }
        rhs.clear();
        rhs.extend(dofs.iter().map(|unknown| {
            let Unknown { row, coefficient, weighted, goal, .. } = unknown;
            goal - row.sum(products) - coefficient * weighted.sum(solved)
        }));
        factor.solve(rhs);
        let sum = if self.by_motions { &mut *known } else { solved };
        dofs.iter().zip(rhs).for_each(|(unknown, x)| unknown.column.add_to(sum, *x));
        if self.by_motions {
            dense_multiply_add(matrix, 1.0, known, other);
        }
    }
}
