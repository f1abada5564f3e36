//! The linear system of prescribed statuses for W = D + L Lᵀ.
//!
//! It has three conditions per element, and one per mode.
//!
//! | symbol | meaning |
//! |---|---|
//! | δr, δy | corrections of an element's force and displacement: δy = D δr + L a |
//! | a | corrections of the amplitudes: the sum of Lᵀ δr over all elements |
//! | M | stiffness of an element: δr = δr₀ − M L a by the conditions of its status |
//!
//! The conditions are those of `system.rs`. Elimination of δr gives (1 + Σ Lᵀ M L) a = Σ Lᵀ δr₀ (Woodbury 1950). An element
//! that slides without pressure in a closed gap, the limit of infinite friction, has no M: its shear along the slip is one
//! more unknown, and its gap one more equation.

use super::low_rank::LowRankCompliance;
use super::problem::{Bounds, ConeProblem};
use super::status::{Normal, Status, Tangential};
use crate::linalg::DenseFactor;

/// Corrections of an element's force: δr₀ and M.
#[derive(Clone, Copy)]
struct ElementCorrection {
    force: [f64; 3],
    stiffness: [[f64; 3]; 3],
}

/// Correction of an element's p: δp₀ and the normal entry of M.
struct PressureCorrection {
    force: f64,
    stiffness: f64,
}

impl PressureCorrection {
    /// Correction of the force `p`; `None` if the conditions contradict each other.
    ///
    /// `gap`: present y. `diagonal`: normal entry of D. `is_pressureless`: whether the element slides with infinite
    /// friction.
    fn new(
        status: &Status,
        bounds: &Bounds,
        p: f64,
        gap: f64,
        diagonal: f64,
        is_pressureless: bool,
    ) -> Option<Self> {
        if let Normal::Hardening(hardening) = status.normal {
            // p = cap + hardening (closed gap − gap).
            let difference = hardening * (bounds.closed_gap - gap) + bounds.interval[1] - p;
            let stiffness = hardening / (1.0 + hardening * diagonal);
            let force = difference / (1.0 + hardening * diagonal);
            return (!is_pressureless).then_some(Self { force, stiffness });
        }
        match status.bound(bounds.interval) {
            Some(_) if is_pressureless => None,
            Some(bound) => Some(Self { force: bound - p, stiffness: 0.0 }),
            None if is_pressureless => Some(Self { force: -bounds.attraction - p, stiffness: 0.0 }),
            None => Some(Self {
                force: (bounds.closed_gap - gap) / diagonal,
                stiffness: 1.0 / diagonal,
            }),
        }
    }
}

/// An element that slides without pressure in a closed gap.
struct PressurelessElement {
    element: usize,
    /// Change of its force due to a unit of the unknown shear.
    shear_direction: [f64; 3],
}

/// Corrections of all elements, and the system of the modes.
pub(super) struct LowRankSystem {
    corrections: Vec<ElementCorrection>,
    pressureless: Vec<PressurelessElement>,
    matrix: Vec<f64>,
    rhs: Vec<f64>,
    /// M L of an element, mode by mode.
    products: Vec<[f64; 3]>,
    factor: DenseFactor,
}

impl LowRankSystem {
    /// Allocates for the corrections of `element_count` elements.
    pub(super) fn new(element_count: usize) -> Self {
        Self {
            corrections: Vec::with_capacity(element_count),
            pressureless: Vec::with_capacity(element_count),
            matrix: vec![],
            rhs: vec![],
            products: vec![],
            factor: DenseFactor::with_capacity(0),
        }
    }

    /// Allocates for this number of modes; solves then allocate nothing.
    pub(super) fn reserve(&mut self, mode_count: usize) {
        // A regular system has no more elements that slide without pressure than modes.
        let order = 2 * mode_count;
        if self.products.capacity() < mode_count {
            self.matrix.reserve_exact(order * order);
            self.rhs.reserve_exact(order);
            self.products.reserve_exact(mode_count);
            self.factor = DenseFactor::with_capacity(order);
        }
    }

    /// Corrects r, with its present y, to the solution for `statuses`.
    ///
    /// `false` if the system is singular.
    pub(super) fn solve(&mut self, problem: &mut ConeProblem, statuses: &[Status]) -> bool {
        let form = std::mem::take(&mut problem.form);
        let is_solved =
            form.low_rank().is_some_and(|operator| self.correct(operator, problem, statuses));
        problem.form = form;
        is_solved
    }

    /// As [`LowRankSystem::solve`], with W apart from the problem.
    fn correct(
        &mut self,
        operator: &LowRankCompliance,
        problem: &mut ConeProblem,
        statuses: &[Status],
    ) -> bool {
        self.corrections.clear();
        self.pressureless.clear();
        for (e, status) in statuses.iter().enumerate() {
            if self.add_element(operator, problem, e, status).is_none() {
                return false;
            }
        }
        // Each element without pressure adds an equation for the amplitudes.
        if self.pressureless.len() > operator.mode_count() || !self.assemble(operator, problem) {
            return false;
        }
        self.factor.solve(&mut self.rhs);
        for (e, correction) in self.corrections.iter().enumerate() {
            let displacement = operator.modal_displacement(e, &self.rhs);
            for (k, i) in problem.component_indices(e).into_iter().enumerate() {
                let relief = dot(&correction.stiffness[k], &displacement);
                problem.force_change[i] += correction.force[k] - relief;
            }
        }
        let shears = &self.rhs[operator.mode_count()..];
        for (pressureless, shear) in self.pressureless.iter().zip(shears) {
            let indices = problem.component_indices(pressureless.element);
            for (k, i) in indices.into_iter().enumerate() {
                problem.force_change[i] += pressureless.shear_direction[k] * shear;
            }
        }
        problem.set_prescribed_forces(statuses);
        problem.force_change.iter().all(|change| change.is_finite())
    }

    /// Adds the corrections of an element; `None` if its conditions contradict each other.
    fn add_element(
        &mut self,
        operator: &LowRankCompliance,
        problem: &ConeProblem,
        e: usize,
        status: &Status,
    ) -> Option<()> {
        let indices = problem.component_indices(e);
        let bounds = &problem.bounds[e];
        let [p, tx, ty] = indices.map(|i| problem.force(i));
        let [gap, yx, yy] = indices.map(|i| problem.y[i]);
        let [dn, dx, dy] = operator.diagonal(e).map(|entry| entry + problem.added_diagonal);
        let slope = match status.tangential {
            Tangential::Slip { radius_slope, .. } => radius_slope,
            Tangential::Free | Tangential::Stick => 0.0,
        };
        let is_pressureless = slope == f64::INFINITY;
        let pressure = PressureCorrection::new(status, bounds, p, gap, dn, is_pressureless)?;
        let mut force = [pressure.force, 0.0, 0.0];
        let mut stiffness = [[pressure.stiffness, 0.0, 0.0], [0.0; 3], [0.0; 3]];
        match status.tangential {
            Tangential::Free => (force[1], force[2]) = (-tx, -ty),
            Tangential::Stick => {
                (force[1], force[2]) = (-yx / dx, -yy / dy);
                (stiffness[1][1], stiffness[2][2]) = (1.0 / dx, 1.0 / dy);
            }
            Tangential::Slip { direction: [c, s], radius_ratio, .. } => {
                // Along the slip: t·d = slope (p + attraction) + shear strength.
                let mut slip_shear = 0.0;
                if !is_pressureless {
                    let friction = slope * (p + force[0] + bounds.attraction);
                    slip_shear = friction + bounds.shear_strength - (c * tx + s * ty);
                }
                // Across the slip: κ y + (1 − κ) t / ρ = 0.
                let compliance = (1.0 - radius_ratio) / problem.rho[e][1];
                let coefficient = radius_ratio * (s * s * dx + c * c * dy) + compliance;
                let factor = radius_ratio / coefficient;
                let coupling = c * s * (dy - dx);
                let cross_slip = c * yy - s * yx;
                let present_cross_shear = c * ty - s * tx;
                let cross_shear = -factor * (cross_slip + slip_shear * coupling)
                    - compliance / coefficient * present_cross_shear;
                force[1] = c * slip_shear - s * cross_shear;
                force[2] = s * slip_shear + c * cross_shear;
                let direction = [c + s * factor * coupling, s - c * factor * coupling];
                let slip_stiffness = if is_pressureless { 0.0 } else { slope * pressure.stiffness };
                stiffness[1] = [slip_stiffness * direction[0], factor * s * s, -factor * s * c];
                stiffness[2] = [slip_stiffness * direction[1], -factor * s * c, factor * c * c];
                if is_pressureless {
                    let shear_direction = [0.0, direction[0], direction[1]];
                    self.pressureless.push(PressurelessElement { element: e, shear_direction });
                }
            }
        }
        self.corrections.push(ElementCorrection { force, stiffness });
        Some(())
    }

    /// Factors the system of the modes, and writes its right-hand side.
    ///
    /// `false` if it is singular.
    fn assemble(&mut self, operator: &LowRankCompliance, problem: &ConeProblem) -> bool {
        let mode_count = operator.mode_count();
        let order = mode_count + self.pressureless.len();
        let Self { corrections, pressureless, matrix, rhs, products, factor } = self;
        matrix.clear();
        matrix.resize(order * order, 0.0);
        rhs.clear();
        rhs.resize(order, 0.0);
        matrix.iter_mut().step_by(order + 1).take(mode_count).for_each(|entry| *entry = 1.0);
        for (e, ElementCorrection { force, stiffness }) in corrections.iter().enumerate() {
            let modes = operator.modes(e);
            products.clear();
            products
                .extend(modes.iter().map(|mode| stiffness.each_ref().map(|row| dot(row, mode))));
            let rows = matrix.chunks_exact_mut(order.max(1));
            for ((row, sum), mode) in rows.zip(rhs.iter_mut()).zip(modes) {
                *sum += dot(mode, force);
                row.iter_mut()
                    .zip(&*products)
                    .for_each(|(sum, product)| *sum += dot(mode, product));
            }
        }
        for (row, PressurelessElement { element, shear_direction }) in
            (mode_count..).zip(&*pressureless)
        {
            let e = *element;
            for (k, mode) in operator.modes(e).iter().enumerate() {
                matrix[k * order + row] = -dot(mode, shear_direction);
                matrix[row * order + k] = mode[0];
            }
            let compliance = operator.diagonal(e)[0] + problem.added_diagonal;
            let gap = problem.y[e] + compliance * corrections[e].force[0];
            rhs[row] = problem.bounds[e].closed_gap - gap;
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
