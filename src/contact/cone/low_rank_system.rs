//! The linear system of fixed statuses for W = D + L Lᵀ: three conditions per element, and one per mode.
//!
//! | symbol | meaning |
//! |---|---|
//! | δr, δy | corrections of an element's force and motion: δy = D δr + L a |
//! | a | corrections of the amplitudes: the sum of Lᵀ δr over all elements |
//! | M | change of δr by a motion L a: δr = δr₀ − M L a by the conditions of the element's status |
//!
//! The conditions are as in `system.rs`. They leave (1 + Σ Lᵀ M L) a = Σ Lᵀ δr₀ (Woodbury 1950). An element that slides
//! without pressure in a closed gap, the limit of infinite friction, has no M: its shear along the slip is one more unknown,
//! and its gap one more equation.

use super::low_rank::LowRank;
use super::problem::{Bounds, ConeProblem};
use super::status::{Normal, Status, Tangential};
use crate::linalg::DenseFactor;

/// Corrections of an element: δr₀ and M.
#[derive(Clone, Copy)]
struct Response {
    force: [f64; 3],
    by_motion: [[f64; 3]; 3],
}

/// Correction of an element's p: δp₀ and its part of M.
struct PressureResponse {
    change: f64,
    by_gap: f64,
}

impl PressureResponse {
    /// Correction of the force `p` with this `gap` and entry `diagonal` of D; `None` if the conditions contradict each other.
    ///
    /// `is_unpressed`: whether the element slides with infinite friction.
    fn new(
        status: &Status,
        bounds: &Bounds,
        p: f64,
        gap: f64,
        diagonal: f64,
        is_unpressed: bool,
    ) -> Option<Self> {
        if let Normal::Hardening(stiffness) = status.normal {
            // p = cap + stiffness (offset − gap).
            let difference = stiffness * (bounds.offset - gap) + bounds.interval[1] - p;
            let by_gap = stiffness / (1.0 + stiffness * diagonal);
            let change = difference / (1.0 + stiffness * diagonal);
            return (!is_unpressed).then_some(Self { change, by_gap });
        }
        match status.bound(bounds.interval) {
            Some(_) if is_unpressed => None,
            Some(bound) => Some(Self { change: bound - p, by_gap: 0.0 }),
            None if is_unpressed => Some(Self { change: -bounds.attraction - p, by_gap: 0.0 }),
            None => Some(Self { change: (bounds.offset - gap) / diagonal, by_gap: 1.0 / diagonal }),
        }
    }
}

/// An element that slides without pressure in a closed gap.
struct Unpressed {
    element: usize,
    /// Change of its force by a unit of the unknown shear.
    along: [f64; 3],
}

/// Corrections of all elements, and the system of the modes.
pub(super) struct LowRankSystem {
    responses: Vec<Response>,
    unpressed: Vec<Unpressed>,
    matrix: Vec<f64>,
    rhs: Vec<f64>,
    /// M L of an element, mode by mode.
    products: Vec<[f64; 3]>,
    factor: DenseFactor,
}

impl LowRankSystem {
    pub(super) fn new(count: usize) -> Self {
        Self {
            responses: Vec::with_capacity(count),
            unpressed: Vec::with_capacity(count),
            matrix: vec![],
            rhs: vec![],
            products: vec![],
            factor: DenseFactor::with_capacity(0),
        }
    }

    /// Allocates for this number of modes; solves then allocate nothing.
    pub(super) fn reserve(&mut self, rank: usize) {
        // No more elements slide without pressure than there are modes.
        let order = 2 * rank;
        if self.products.capacity() < rank {
            self.matrix.reserve_exact(order * order);
            self.rhs.reserve_exact(order);
            self.products.reserve_exact(rank);
            self.factor = DenseFactor::with_capacity(order);
        }
    }

    /// Corrects r, with its present y, to the solution for `statuses`; `false` if the system is singular.
    pub(super) fn solve(&mut self, problem: &mut ConeProblem, statuses: &[Status]) -> bool {
        let Some(operator) = problem.low_rank.take() else { return false };
        let is_solved = self.correct(&operator, problem, statuses);
        problem.low_rank = Some(operator);
        is_solved
    }

    fn correct(
        &mut self,
        operator: &LowRank,
        problem: &mut ConeProblem,
        statuses: &[Status],
    ) -> bool {
        self.responses.clear();
        self.unpressed.clear();
        for (e, status) in statuses.iter().enumerate() {
            if !self.add_element(operator, problem, e, status) {
                return false;
            }
        }
        // Each of these elements ties the amplitudes.
        if self.unpressed.len() > operator.rank() || !self.assemble(operator, problem) {
            return false;
        }
        self.factor.solve(&mut self.rhs);
        for (e, response) in self.responses.iter().enumerate() {
            let motion = operator.motion_by_modes(e, &self.rhs);
            for (k, i) in problem.places(e).into_iter().enumerate() {
                let moved = dot(&response.by_motion[k], &motion);
                problem.change[i] += response.force[k] - moved;
            }
        }
        for (unpressed, shear) in self.unpressed.iter().zip(&self.rhs[operator.rank()..]) {
            for (k, i) in problem.places(unpressed.element).into_iter().enumerate() {
                problem.change[i] += unpressed.along[k] * shear;
            }
        }
        problem.prescribe(statuses);
        problem.change.iter().all(|change| change.is_finite())
    }

    /// Adds the corrections of an element; `false` if its conditions contradict each other.
    fn add_element(
        &mut self,
        operator: &LowRank,
        problem: &ConeProblem,
        e: usize,
        status: &Status,
    ) -> bool {
        let places = problem.places(e);
        let bounds = &problem.bounds[e];
        let [p, tx, ty] = places.map(|i| problem.force(i));
        let [gap, mx, my] = places.map(|i| problem.y[i]);
        let [dn, dx, dy] = operator.diagonal(e).map(|entry| entry + problem.added);
        let slope = match status.tangential {
            Tangential::Slip { slope, .. } => slope,
            Tangential::Free | Tangential::Stick => 0.0,
        };
        let is_unpressed = slope == f64::INFINITY;
        let Some(pressure) = PressureResponse::new(status, bounds, p, gap, dn, is_unpressed) else {
            return false;
        };
        let mut force = [pressure.change, 0.0, 0.0];
        let mut by_motion = [[pressure.by_gap, 0.0, 0.0], [0.0; 3], [0.0; 3]];
        match status.tangential {
            Tangential::Free => (force[1], force[2]) = (-tx, -ty),
            Tangential::Stick => {
                (force[1], force[2]) = (-mx / dx, -my / dy);
                (by_motion[1][1], by_motion[2][2]) = (1.0 / dx, 1.0 / dy);
            }
            Tangential::Slip { direction: [c, s], turn, .. } => {
                // Along the slip: t·d = slope (p + attraction) + strength.
                let mut along = 0.0;
                if !is_unpressed {
                    let pressing = slope * (p + force[0] + bounds.attraction);
                    along = pressing + bounds.strength - (c * tx + s * ty);
                }
                // Across: turn · y + (1 − turn) t / ρ = 0.
                let stiffness = (1.0 - turn) / problem.rho[e][1];
                let coefficient = turn * (s * s * dx + c * c * dy) + stiffness;
                let factor = turn / coefficient;
                let coupling = c * s * (dy - dx);
                let moved = c * my - s * mx;
                let sheared = c * ty - s * tx;
                let across =
                    -factor * (moved + along * coupling) - stiffness / coefficient * sheared;
                (force[1], force[2]) = (c * along - s * across, s * along + c * across);
                let follows = [c + s * factor * coupling, s - c * factor * coupling];
                let by_gap = if is_unpressed { 0.0 } else { slope * pressure.by_gap };
                by_motion[1] = [by_gap * follows[0], factor * s * s, -factor * s * c];
                by_motion[2] = [by_gap * follows[1], -factor * s * c, factor * c * c];
                if is_unpressed {
                    let along = [0.0, follows[0], follows[1]];
                    self.unpressed.push(Unpressed { element: e, along });
                }
            }
        }
        self.responses.push(Response { force, by_motion });
        true
    }

    /// Factors the system of the modes, and writes its right-hand side; `false` if it is singular.
    fn assemble(&mut self, operator: &LowRank, problem: &ConeProblem) -> bool {
        let rank = operator.rank();
        let order = rank + self.unpressed.len();
        let Self { responses, unpressed, matrix, rhs, products, factor } = self;
        matrix.clear();
        matrix.resize(order * order, 0.0);
        rhs.clear();
        rhs.resize(order, 0.0);
        matrix.iter_mut().step_by(order + 1).take(rank).for_each(|entry| *entry = 1.0);
        for (e, Response { force, by_motion }) in responses.iter().enumerate() {
            let modes = operator.modes(e);
            products.clear();
            products
                .extend(modes.iter().map(|mode| by_motion.each_ref().map(|row| dot(row, mode))));
            let rows = matrix.chunks_exact_mut(order.max(1));
            for ((row, sum), mode) in rows.zip(rhs.iter_mut()).zip(modes) {
                *sum += dot(mode, force);
                row.iter_mut()
                    .zip(&*products)
                    .for_each(|(sum, product)| *sum += dot(mode, product));
            }
        }
        for (number, unpressed) in unpressed.iter().enumerate() {
            let place = rank + number;
            let e = unpressed.element;
            for (k, mode) in operator.modes(e).iter().enumerate() {
                matrix[k * order + place] = -dot(mode, &unpressed.along);
                matrix[place * order + k] = mode[0];
            }
            let gap_by_force = (operator.diagonal(e)[0] + problem.added) * responses[e].force[0];
            let gap = problem.y[e] + gap_by_force;
            rhs[place] = problem.bounds[e].offset - gap;
        }
        factor.factor(matrix, order)
    }
}

/// Scalar product of two vectors.
fn dot(a: &[f64; 3], b: &[f64; 3]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

#[cfg(test)]
mod tests;
