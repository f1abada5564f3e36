//! The linear system of prescribed statuses, for corrections that satisfy y = q + W (r − r₀).
//!
//! Each component of an element has a condition on its force or on its displacement; the other quantity is unknown.
//! There are two systems with the same solution; the one of lower cost is solved:
//!
//! | | unknown forces, by W | unknown displacements, by W⁻¹ |
//! |---|---|---|
//! | closed | p, with the shear that it adds along the slip: y = closed gap | |
//! | open or capped | | y: p = its bound |
//! | hardens by k | p, as if closed: y + (p − cap)/k = closed gap | y: p + k y = cap + k (closed gap) |
//! | sticks | both: y = 0 | |
//! | free | | both: t = 0 |
//! | slips along d | | y·d: t·d = friction (p + attraction) + shear strength |
//! | across d | t: (1 − κ) t + κ ρ y = 0 | y: the same |
//!
//! κ = R/\|t − ρ y\| is the radius ratio: the direction turns with the slip (Alart & Curnier 1991).
//!
//! Solutions by factors are equal up to rounding, those by iterations up to their tolerance. A resumed run must make the
//! same choice as the uninterrupted one: by the statuses, and whether iterations may solve, if W is constant; otherwise also
//! by those of earlier systems of the same step. If all elements stick, the factors of W itself solve.

use super::problem::ConeProblem;
use super::status::{Status, Tangential};
use super::unknowns::{ComponentSum, Unknown, Unknowns};
use crate::linalg::{
    DenseFactor, GaussSeidelGmres, dense_multiply_add, dot, transposed_multiply_add,
};

/// Number of columns of W⁻¹ that are solved together.
const INVERSE_BLOCK_COLUMNS: usize = 32;
/// Smallest order at which iterations take less time than factors.
const MIN_ITERATIVE_ORDER: usize = 32;
/// Typical number of products in a solution by iterations, with the assembly of its matrix.
const ITERATION_COUNT: f64 = 7.0;
/// Cost of W⁻¹, relative to a factorization of the same order.
const INVERSE_COST_FACTOR: f64 = 4.0;

/// The system, its factors and W⁻¹.
#[allow(clippy::struct_excessive_bools, reason = "each says whether one matrix is valid")]
pub(super) struct System {
    unknowns: Unknowns,
    /// Component of each condition that has a single one.
    single_rows: Vec<usize>,
    /// Sums of components of the other conditions.
    mixed_rows: Vec<ComponentSum>,
    rhs: Vec<f64>,
    factor: DenseFactor,
    /// Iterations in place of factors; without memory unless soil hardens.
    iterations: GaussSeidelGmres,
    /// Whether the last matrix is that of the iterations, and has no factors.
    is_iterative: bool,
    /// Whether the unknowns of the last matrix are displacements.
    has_displacement_factors: bool,
    /// Factors of W, if `has_w_factor`.
    w_factor: DenseFactor,
    has_w_factor: bool,
    /// W⁻¹; empty until it has been computed.
    inverse: Vec<f64>,
    /// Whether W is constant for the whole run.
    is_constant: bool,
    /// Cost that W⁻¹ would have saved in the solutions since it was discarded.
    saved_cost: f64,
    /// Statuses of the present factors.
    factored_statuses: Vec<Status>,
    /// Whether factors, not iterations, belong to `factored_statuses`, all without slip.
    is_reusable: bool,
    /// Whether factors or iterations for `factored_statuses` have solved in this step.
    is_recent: bool,
    /// Scratch: columns of the matrix, or quantities that are not unknown.
    ///
    /// These are displacements if forces are unknown, and forces if displacements are unknown.
    products: Vec<f64>,
}

/// Cost of a solution of this order by factors, or by iterations if these are possible.
fn solution_cost(order: usize, can_iterate: bool) -> f64 {
    let iterates = can_iterate && order >= MIN_ITERATIVE_ORDER;
    (order as f64).powi(2) * if iterates { ITERATION_COUNT } else { order as f64 }
}

impl System {
    /// Allocates for the components of `element_count` elements.
    pub(super) fn new(element_count: usize) -> Self {
        let size = 3 * element_count;
        Self {
            unknowns: Unknowns::with_capacity(size),
            single_rows: Vec::with_capacity(size),
            mixed_rows: Vec::with_capacity(size),
            rhs: Vec::with_capacity(size),
            factor: DenseFactor::with_capacity(size),
            iterations: GaussSeidelGmres::default(),
            is_iterative: false,
            has_displacement_factors: false,
            w_factor: DenseFactor::with_columns(size, INVERSE_BLOCK_COLUMNS),
            has_w_factor: false,
            inverse: Vec::with_capacity(size * size),
            is_constant: false,
            saved_cost: 0.0,
            factored_statuses: vec![Status::CLOSED_STICKING; element_count],
            is_reusable: false,
            is_recent: false,
            products: vec![0.0; size],
        }
    }

    /// Discards factors and W⁻¹; call this when W has changed.
    ///
    /// `is_constant`: whether W will stay constant.
    pub(super) fn invalidate(&mut self, is_constant: bool) {
        self.is_reusable = false;
        self.has_w_factor = false;
        self.is_constant = is_constant;
        self.is_recent = false;
        self.inverse.clear();
        self.saved_cost = 0.0;
    }

    /// Makes the choice of unknowns independent of previous time steps.
    ///
    /// It discards stored data by which a step would choose forces or displacements as unknowns. With hardening it
    /// allocates the memory of iterations, once.
    pub(super) fn begin_step(&mut self, has_hardening: bool) {
        if has_hardening {
            self.iterations.reserve(self.products.len());
        }
        self.is_recent = false;
        if !self.is_constant {
            self.is_reusable &= !self.has_displacement_factors;
            self.inverse.clear();
            self.saved_cost = 0.0;
        }
    }

    /// Corrects r, with its present y, to the solution for `statuses`.
    ///
    /// `false` if the system is singular.
    ///
    /// `accepts_recent_factors`: whether factors of the same step, for statuses of the same kinds, solve nearly enough.
    /// `linear_tolerance`: residual that iterations may leave, relative to the present one; zero for factors.
    pub(super) fn solve(
        &mut self,
        problem: &mut ConeProblem,
        statuses: &[Status],
        accepts_recent_factors: bool,
        linear_tolerance: f64,
    ) -> bool {
        if statuses.iter().all(|status| *status == Status::CLOSED_STICKING) {
            return self.solve_sticking(problem);
        }
        let has_no_slip =
            !statuses.iter().any(|status| matches!(status.tangential, Tangential::Slip { .. }));
        let can_iterate = linear_tolerance > 0.0 && problem.has_hardening();
        let are_displacements = self.prefers_displacements(problem, statuses, can_iterate);
        self.unknowns.are_displacements = are_displacements;
        self.unknowns.gather(problem, statuses);
        let is_iterative = can_iterate && self.unknowns.list.len() >= MIN_ITERATIVE_ORDER;
        // Iterations have other rounding errors than factors of an earlier step.
        let is_reusable = has_no_slip
            && self.is_reusable
            && (self.is_recent || !is_iterative)
            && self.factored_statuses == statuses;
        let accepts_recent = accepts_recent_factors && self.is_recent;
        let is_factored = self.has_displacement_factors == are_displacements
            && (is_reusable || accepts_recent && self.has_factors_of_same_kinds(statuses));
        if !is_factored {
            self.is_reusable = false;
            self.is_recent = false;
            if !self.assemble(problem, is_iterative) {
                return false;
            }
            self.has_displacement_factors = are_displacements;
            self.is_reusable = has_no_slip && !is_iterative;
            self.factored_statuses.copy_from_slice(statuses);
        }
        // Reused factors count as those of this step, which a resumed run computes.
        self.is_recent = true;
        if !self.correct(problem, linear_tolerance) {
            self.is_reusable = false;
            self.is_recent = false;
            return false;
        }
        problem.set_prescribed_forces(statuses);
        problem.force_change.iter().all(|change| change.is_finite())
    }

    /// Whether the present factors belong to statuses of the same kinds.
    fn has_factors_of_same_kinds(&self, statuses: &[Status]) -> bool {
        self.factored_statuses.iter().map(Status::kind).eq(statuses.iter().map(Status::kind))
    }

    /// Corrects r so that all gaps are closed without slip.
    ///
    /// `false` if W is singular.
    fn solve_sticking(&mut self, problem: &mut ConeProblem) -> bool {
        if !self.factor_w(problem) {
            return false;
        }
        let Self { w_factor, products, .. } = self;
        for (value, y) in products.iter_mut().zip(&problem.y) {
            *value = -y;
        }
        // Normal components precede tangential ones.
        for (value, bounds) in products.iter_mut().zip(&problem.bounds) {
            *value += bounds.closed_gap;
        }
        w_factor.solve(products);
        for (change, correction) in problem.force_change.iter_mut().zip(products) {
            *change += *correction;
        }
        problem.force_change.iter().all(|change| change.is_finite())
    }

    /// Factors W if it has not been factored; `false` if it is singular.
    fn factor_w(&mut self, problem: &ConeProblem) -> bool {
        self.has_w_factor =
            self.has_w_factor || self.w_factor.factor(&problem.w, problem.component_count());
        self.has_w_factor
    }

    /// Whether unknown displacements cost less than unknown forces, and W⁻¹ is available.
    ///
    /// `can_iterate`: whether iterations solve systems of sufficient order.
    ///
    /// W⁻¹ of a constant W is computed at once; that of another W as soon as it would have saved its cost in this step.
    fn prefers_displacements(
        &mut self,
        problem: &ConeProblem,
        statuses: &[Status],
        can_iterate: bool,
    ) -> bool {
        let force_count: usize = statuses.iter().map(Status::unknown_force_count).sum();
        let displacement_count: usize =
            statuses.iter().map(Status::unknown_displacement_count).sum();
        let size = problem.component_count();
        // Iterations for displacements need two more products, with all and with some columns of W⁻¹.
        let product_cost = if can_iterate { size * (size + displacement_count) } else { 0 };
        let saved_cost = solution_cost(force_count, can_iterate)
            - solution_cost(displacement_count, can_iterate)
            - product_cost as f64;
        if saved_cost <= 0.0 {
            return false;
        }
        self.saved_cost += saved_cost;
        if self.inverse.is_empty()
            && (self.is_constant
                || self.saved_cost > INVERSE_COST_FACTOR * solution_cost(size, false))
        {
            if !self.factor_w(problem) {
                return false;
            }
            self.inverse.resize(size * size, 0.0);
            for i in 0..size {
                self.inverse[i * (size + 1)] = 1.0;
            }
            self.inverse
                .chunks_mut(INVERSE_BLOCK_COLUMNS * size)
                .for_each(|rows| self.w_factor.solve(rows));
        }
        !self.inverse.is_empty()
    }

    /// Factors the matrix of the unknowns, or stores it for iterations; `false` if it is singular.
    fn assemble(&mut self, problem: &ConeProblem, is_iterative: bool) -> bool {
        let size = problem.component_count();
        let Self {
            unknowns, factor, iterations, inverse, products, single_rows, mixed_rows, ..
        } = self;
        let matrix = if unknowns.are_displacements { inverse } else { &problem.w };
        let unknowns = &unknowns.list;
        let single_count = unknowns.partition_point(|unknown| unknown.row.is_single());
        // Compact lists, since each column reads them.
        single_rows.clear();
        single_rows.extend(unknowns[..single_count].iter().map(|unknown| unknown.row.indices[0]));
        mixed_rows.clear();
        mixed_rows.extend(unknowns[single_count..].iter().map(|unknown| unknown.row));
        let mut append_column = |j: usize, values: &mut Vec<f64>| {
            let ComponentSum { indices, weights } = &unknowns[j].column;
            // The matrix is symmetric: its rows are its columns.
            let [first, second, third] = indices.map(|i| &matrix[i * size..][..size]);
            let column = if unknowns[j].column.is_single() {
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
            values.extend(single_rows.iter().map(|i| column[*i]));
            values.extend(mixed_rows.iter().map(|row| row.sum(column)));
            values[begin + j] += unknowns[j].diagonal();
        };
        self.is_iterative =
            is_iterative && iterations.set_columns(unknowns.len(), &mut append_column);
        self.is_iterative || factor.factor_columns(unknowns.len(), append_column)
    }

    /// Solves, and adds the corrections to r.
    ///
    /// Unknown displacements determine the forces; the next product with W updates the displacements themselves.
    ///
    /// `false` if iterations do not converge, and the matrix is singular.
    fn correct(&mut self, problem: &mut ConeProblem, linear_tolerance: f64) -> bool {
        self.prescribe(problem);
        let is_converged =
            self.is_iterative && self.iterations.solve(&mut self.rhs, linear_tolerance).is_some();
        if !is_converged {
            if self.is_iterative && !self.assemble(problem, false) {
                return false;
            }
            self.factor.solve(&mut self.rhs);
        }
        let Self { unknowns, rhs, inverse, .. } = self;
        let Unknowns { list, are_displacements, prescribed } = unknowns;
        let ConeProblem { force_change, y, .. } = problem;
        let (solved, other) =
            if *are_displacements { (y, force_change) } else { (force_change, y) };
        let corrected = if *are_displacements { &mut *prescribed } else { solved };
        list.iter().zip(rhs).for_each(|(unknown, x)| unknown.column.add_to(corrected, *x));
        if *are_displacements {
            dense_multiply_add(inverse, 1.0, prescribed, other);
        }
        true
    }

    /// Adds the prescribed corrections to r or y, and computes the right-hand side.
    fn prescribe(&mut self, problem: &mut ConeProblem) {
        let Self { unknowns, rhs, inverse, products, .. } = self;
        let Unknowns { list, are_displacements, prescribed } = unknowns;
        let ConeProblem { w, force_change, y, .. } = problem;
        let matrix = if *are_displacements { inverse } else { w };
        // Quantities of the unknowns' kind, and of the other kind.
        let (solved, other) =
            if *are_displacements { (y, force_change) } else { (force_change, y) };
        for (value, correction) in solved.iter_mut().zip(prescribed.iter()) {
            *value += correction;
        }
        products.copy_from_slice(other);
        let prescribed_count = prescribed.iter().filter(|correction| **correction != 0.0).count();
        if prescribed_count <= list.len() {
            // The matrix is symmetric: its rows are its columns.
            let columns = matrix.chunks_exact(prescribed.len()).zip(&*prescribed);
            for (column, correction) in columns.filter(|(_, correction)| **correction != 0.0) {
                transposed_multiply_add(column, 1.0, &[*correction], products);
            }
        } else {
            // Only the rows of conditions; NaN marks the others.
            products.fill(f64::NAN);
            for i in list.iter().flat_map(|unknown| unknown.row.indices) {
                if products[i].is_nan() {
                    products[i] = other[i] + dot(&matrix[i * prescribed.len()..], prescribed);
                }
            }
        }
        rhs.clear();
        rhs.extend(list.iter().map(|unknown| {
            let Unknown { row, coefficient, weighted_sum, goal, .. } = unknown;
            goal - row.sum(products) - coefficient * weighted_sum.sum(solved)
        }));
    }
}
