//! Unknowns of the linear system of statuses, and the corrections that the statuses prescribe.

use super::problem::ConeProblem;
use super::status::{Normal, Status, Tangential};

/// A weighted sum of components: one with weight 1, or the three of an element.
#[derive(Clone, Copy)]
pub(super) struct ComponentSum {
    pub(super) indices: [usize; 3],
    pub(super) weights: [f64; 3],
}

impl ComponentSum {
    /// Sum of a single component.
    fn single(index: usize) -> Self {
        Self { indices: [index; 3], weights: [1.0, 0.0, 0.0] }
    }

    /// Whether the sum has a single component.
    pub(super) fn is_single(&self) -> bool {
        self.indices[1] == self.indices[0]
    }

    /// Weighted sum of these components of a vector.
    pub(super) fn sum(&self, values: &[f64]) -> f64 {
        self.weights[0] * values[self.indices[0]]
            + self.weights[1] * values[self.indices[1]]
            + self.weights[2] * values[self.indices[2]]
    }

    /// Adds multiples of the weights to these components of a vector.
    pub(super) fn add_to(&self, values: &mut [f64], factor: f64) {
        for (index, weight) in self.indices.into_iter().zip(self.weights) {
            values[index] += factor * weight;
        }
    }
}

/// An unknown and its condition: row · A x + coefficient (weighted sum of x) = goal.
///
/// x are the unknown forces or displacements, A x the quantities of the other kind. The unknown adds multiples of
/// `column` to x.
pub(super) struct Unknown {
    pub(super) row: ComponentSum,
    pub(super) column: ComponentSum,
    pub(super) coefficient: f64,
    /// Sum of x in the condition.
    ///
    /// It is the column, except on soil that hardens: there it is p without shear.
    pub(super) weighted_sum: ComponentSum,
    pub(super) goal: f64,
}

impl Unknown {
    /// Number that the coefficient adds to the diagonal; a column is a vector of length one.
    pub(super) fn diagonal(&self) -> f64 {
        if self.weighted_sum.is_single() {
            self.coefficient * self.column.weights[0]
        } else {
            self.coefficient
        }
    }
}

/// Factors of shear and pressure in the condition along the slip d.
///
/// The condition is t·d = friction (p + attraction) + shear strength.
///
/// A friction above one divides both sides, so that the condition has a limit for infinite friction.
fn slip_factors(friction: f64) -> [f64; 2] {
    if friction > 1.0 { [1.0 / friction, 1.0] } else { [1.0, friction] }
}

/// The unknowns of all elements: forces or displacements.
pub(super) struct Unknowns {
    /// Unknowns whose condition has a single component, then the others.
    pub(super) list: Vec<Unknown>,
    /// Whether the unknowns are displacements; otherwise they are forces.
    pub(super) are_displacements: bool,
    /// Corrections of forces or displacements that follow from the statuses alone.
    pub(super) prescribed: Vec<f64>,
}

impl Unknowns {
    /// Allocates for the components of all elements.
    pub(super) fn with_capacity(component_count: usize) -> Self {
        Self {
            list: Vec::with_capacity(component_count),
            are_displacements: false,
            prescribed: vec![0.0; component_count],
        }
    }

    /// Lists the unknowns, and the prescribed corrections.
    pub(super) fn gather(&mut self, problem: &ConeProblem, statuses: &[Status]) {
        self.list.clear();
        self.prescribed.fill(0.0);
        for (e, status) in statuses.iter().enumerate() {
            if self.are_displacements {
                self.add_displacements(problem, e, status);
            } else {
                self.add_forces(problem, e, status);
            }
        }
        self.list.sort_unstable_by_key(|unknown| !unknown.row.is_single());
    }

    /// Adds an unknown whose weighted sum is its column.
    fn add(&mut self, row: ComponentSum, column: ComponentSum, coefficient: f64, goal: f64) {
        self.list.push(Unknown { row, column, coefficient, weighted_sum: column, goal });
    }

    /// Adds the unknown forces of an element.
    fn add_forces(&mut self, problem: &ConeProblem, e: usize, status: &Status) {
        let indices = problem.component_indices(e);
        let [n, x, y] = indices;
        let bounds = &problem.bounds[e];
        let bound = status.bound(bounds.interval);
        if let Some(bound) = bound {
            self.prescribed[n] = bound - problem.force(n);
        }
        let row = ComponentSum::single(n);
        // The force p, and the shear that p adds along the slip.
        let mut column = row;
        match status.tangential {
            Tangential::Free => {
                for i in [x, y] {
                    self.prescribed[i] = -problem.force(i);
                }
            }
            Tangential::Stick => {
                for shear in [x, y].map(ComponentSum::single) {
                    self.add(shear, shear, 0.0, 0.0);
                }
            }
            Tangential::Slip { direction: [c, s], radius_ratio, radius_slope } => {
                let [shear_factor, pressure_factor] = slip_factors(radius_slope);
                let pressure = problem.force(n) + self.prescribed[n];
                let shear = c * problem.force(x) + s * problem.force(y);
                let excess = shear_factor * bounds.shear_strength
                    + pressure_factor * bounds.attraction
                    + pressure_factor * pressure
                    - shear_factor * shear;
                if bound.is_none() && shear_factor < 1.0 {
                    self.prescribed[n] -= excess;
                } else {
                    let slip_shear = ComponentSum { indices, weights: [0.0, c, s] };
                    slip_shear.add_to(&mut self.prescribed, excess / shear_factor);
                }
                let weights = [shear_factor, pressure_factor * c, pressure_factor * s];
                column = ComponentSum { indices, weights };
                // Across the slip.
                let coefficient = (1.0 - radius_ratio) / problem.rho[e][1];
                let goal =
                    -coefficient * (c * problem.static_force[y] - s * problem.static_force[x]);
                let weights = [0.0, -s * radius_ratio, c * radius_ratio];
                let cross_shear = ComponentSum { indices, weights: [0.0, -s, c] };
                self.add(ComponentSum { indices, weights }, cross_shear, coefficient, goal);
            }
        }
        if bound.is_none() {
            self.add(row, column, 0.0, bounds.closed_gap);
        }
        if let Normal::Hardening(stiffness) = status.normal
            && let Some(pressure) = self.list.last_mut()
        {
            pressure.coefficient = stiffness.recip();
            pressure.weighted_sum = row;
            pressure.goal += (bounds.interval[1] - problem.static_force[n]) * pressure.coefficient;
        }
    }

    /// Adds the unknown displacements of an element.
    fn add_displacements(&mut self, problem: &ConeProblem, e: usize, status: &Status) {
        let indices = problem.component_indices(e);
        let [n, x, y] = indices;
        let static_force = indices.map(|i| problem.static_force[i]);
        let bounds = &problem.bounds[e];
        let normal = ComponentSum::single(n);
        match (status.bound(bounds.interval), status.normal) {
            (Some(bound), _) => self.add(normal, normal, 0.0, bound - static_force[0]),
            (None, Normal::Hardening(stiffness)) => {
                let goal = bounds.interval[1] + stiffness * bounds.closed_gap - static_force[0];
                self.add(normal, normal, stiffness, goal);
            }
            (None, _) => self.prescribed[n] = bounds.closed_gap - problem.y[n],
        }
        match status.tangential {
            Tangential::Free => {
                for i in [x, y] {
                    let component = ComponentSum::single(i);
                    self.add(component, component, 0.0, -problem.static_force[i]);
                }
            }
            Tangential::Stick => {
                for i in [x, y] {
                    self.prescribed[i] = -problem.y[i];
                }
            }
            Tangential::Slip { direction: [c, s], radius_ratio, radius_slope } => {
                let [shear_factor, pressure_factor] = slip_factors(radius_slope);
                let goal = shear_factor * bounds.shear_strength
                    + pressure_factor * bounds.attraction
                    + pressure_factor * static_force[0]
                    - shear_factor * (c * static_force[1] + s * static_force[2]);
                let weights = [-pressure_factor, shear_factor * c, shear_factor * s];
                let slip = ComponentSum { indices, weights: [0.0, c, s] };
                self.add(ComponentSum { indices, weights }, slip, 0.0, goal);
                // Across the slip.
                let factor = 1.0 - radius_ratio;
                let goal = -factor * (c * static_force[2] - s * static_force[1]);
                let weights = [0.0, -s * factor, c * factor];
                let cross_slip = ComponentSum { indices, weights: [0.0, -s, c] };
                let coefficient = radius_ratio * problem.rho[e][1];
                self.add(ComponentSum { indices, weights }, cross_slip, coefficient, goal);
            }
        }
    }
}
