//! Anderson acceleration: each sweep begins with a combination of the results of earlier sweeps.
//!
//! | symbol | meaning |
//! |---|---|
//! | x, g | forces before and after a sweep |
//! | f = g − x | change by the sweep |
//! | d = f_j − f | difference between the change by an earlier sweep j and the present one |
//! | γ | weights of the combination, which minimise \|f + Σ γ_j d_j\| |
//!
//! The next x is g + Σ γ_j (g_j − g) (Walker & Ni 2011, SIAM J. Numer. Anal. 49, 1715, eq. 2.1). While no element
//! changes its mode, the iteration is GMRES with the sweep as its preconditioner.

use crate::linalg::dot;

/// Largest number of earlier sweeps in a combination.
///
/// The inner products of so many sweeps take less time than a sweep.
const MAX_STORED_SWEEPS: usize = 8;
/// Smallest pivot of the normal equations, relative to their diagonal.
///
/// An earlier sweep with a smaller pivot has no weight.
const MIN_RELATIVE_PIVOT: f64 = 1e-13;

/// Results of earlier sweeps, and scratch of their combination.
pub(super) struct Acceleration {
    /// Change f of each stored sweep.
    changes: [Vec<f64>; MAX_STORED_SWEEPS],
    /// Results of each stored sweep: forces g and the displacements due to them.
    results: [Vec<f64>; MAX_STORED_SWEEPS],
    /// Number of sweeps since the restart.
    sweep_count: usize,
    /// f of the present sweep.
    change: Vec<f64>,
    /// Results of the present sweep.
    result: Vec<f64>,
    /// Differences d, newest sweep first.
    differences: [Vec<f64>; MAX_STORED_SWEEPS],
}

impl Acceleration {
    /// Allocates for `component_count` forces and as many displacements.
    pub(super) fn new(component_count: usize) -> Self {
        let forces = [(); MAX_STORED_SWEEPS].map(|()| vec![0.0; component_count]);
        Self {
            changes: forces.clone(),
            results: [(); MAX_STORED_SWEEPS].map(|()| vec![0.0; 2 * component_count]),
            sweep_count: 0,
            change: vec![0.0; component_count],
            result: vec![0.0; 2 * component_count],
            differences: forces,
        }
    }

    /// Discards the stored sweeps.
    pub(super) fn restart(&mut self) {
        self.sweep_count = 0;
    }

    /// Stores the forces before a sweep.
    pub(super) fn begin_sweep(&mut self, forces: &[f64]) {
        self.change.copy_from_slice(forces);
    }

    /// Overwrites the results of a sweep with their combination with the results of earlier sweeps.
    ///
    /// The displacements are linear in the forces, with a constant part.
    pub(super) fn end_sweep(&mut self, forces: &mut [f64], displacements: &mut [f64]) {
        let force_count = forces.len();
        self.result[..force_count].copy_from_slice(forces);
        self.result[force_count..].copy_from_slice(displacements);
        for (change, force) in self.change.iter_mut().zip(&self.result) {
            *change = force - *change;
        }
        let weights = self.weights();
        for (begin, values) in [(0, forces), (force_count, displacements)] {
            for (age, weight) in weights.iter().enumerate().filter(|(_, weight)| **weight != 0.0) {
                let earlier = &self.results[self.slot(age)][begin..][..values.len()];
                let present = &self.result[begin..][..values.len()];
                for ((value, earlier), present) in values.iter_mut().zip(earlier).zip(present) {
                    *value += weight * (earlier - present);
                }
            }
        }
        let slot = self.sweep_count % MAX_STORED_SWEEPS;
        self.changes[slot].copy_from_slice(&self.change);
        self.results[slot].copy_from_slice(&self.result);
        self.sweep_count += 1;
    }

    /// Index of the stored sweep that is `age` sweeps older than the newest.
    fn slot(&self, age: usize) -> usize {
        (self.sweep_count - 1 - age) % MAX_STORED_SWEEPS
    }

    /// Weights γ of the earlier sweeps, newest first; zero for those that add nothing.
    fn weights(&mut self) -> [f64; MAX_STORED_SWEEPS] {
        let count = self.sweep_count.min(MAX_STORED_SWEEPS);
        for age in 0..count {
            let earlier = &self.changes[self.slot(age)];
            let difference = &mut self.differences[age];
            for ((difference, earlier), present) in
                difference.iter_mut().zip(earlier).zip(&self.change)
            {
                *difference = earlier - present;
            }
        }
        // Cholesky factors of the normal equations, row by row; a sweep with a zero pivot has no weight.
        let mut factor = [[0.0; MAX_STORED_SWEEPS]; MAX_STORED_SWEEPS];
        let mut weights = [0.0; MAX_STORED_SWEEPS];
        for row in 0..count {
            let difference = &self.differences[row];
            let mut right_hand_side = -dot(difference, &self.change);
            for column in 0..row {
                let mut product = dot(difference, &self.differences[column]);
                for k in 0..column {
                    product -= factor[row][k] * factor[column][k];
                }
                let pivot = factor[column][column];
                factor[row][column] = if pivot > 0.0 { product / pivot } else { 0.0 };
                right_hand_side -= factor[row][column] * weights[column];
            }
            let diagonal = dot(difference, difference);
            let square: f64 = factor[row][..row].iter().map(|entry| entry * entry).sum();
            if diagonal - square > MIN_RELATIVE_PIVOT * diagonal {
                factor[row][row] = (diagonal - square).sqrt();
                weights[row] = right_hand_side / factor[row][row];
            }
        }
        for row in (0..count).rev() {
            if factor[row][row] > 0.0 {
                for below in row + 1..count {
                    weights[row] -= factor[below][row] * weights[below];
                }
                weights[row] /= factor[row][row];
            }
        }
        weights
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Number of forces.
    const FORCE_COUNT: usize = 6;
    /// Eigenvalues of the matrix M of sweeps x ← M x + b; plain sweeps diverge because of the largest.
    const SWEEP_EIGENVALUES: [f64; FORCE_COUNT] = [1.3, 0.95, 0.8, 0.5, -0.4, 0.1];

    /// Forces after a sweep.
    fn sweep(forces: &[f64], vectors: &[[f64; FORCE_COUNT]; FORCE_COUNT]) -> Vec<f64> {
        let mut result = vec![1.0; FORCE_COUNT];
        for (vector, eigenvalue) in vectors.iter().zip(SWEEP_EIGENVALUES) {
            let amplitude = eigenvalue * dot(vector, forces);
            for (value, entry) in result.iter_mut().zip(vector) {
                *value += amplitude * entry;
            }
        }
        result
    }

    #[test]
    fn a_linear_problem_needs_one_sweep_more_than_forces_though_plain_sweeps_diverge() {
        // Orthonormal cosines.
        let vectors: [[f64; FORCE_COUNT]; FORCE_COUNT] = std::array::from_fn(|k| {
            std::array::from_fn(|i| {
                let angle = std::f64::consts::PI * k as f64 * (i as f64 + 0.5) / FORCE_COUNT as f64;
                let norm = if k == 0 { FORCE_COUNT as f64 } else { 0.5 * FORCE_COUNT as f64 };
                angle.cos() / norm.sqrt()
            })
        });
        let mut acceleration = Acceleration::new(FORCE_COUNT);
        let mut forces = vec![0.0; FORCE_COUNT];
        for _ in 0..=FORCE_COUNT {
            acceleration.begin_sweep(&forces);
            forces = sweep(&forces, &vectors);
            let mut displacements: Vec<f64> =
                forces.iter().map(|force| 3.0 * force + 2.0).collect();
            acceleration.end_sweep(&mut forces, &mut displacements);
            // Weights whose sum is one preserve linear relations.
            for (force, displacement) in forces.iter().zip(displacements) {
                assert!((displacement - 2.0 - 3.0 * force).abs() < 1e-8);
            }
        }
        for (force, swept_force) in forces.iter().zip(sweep(&forces, &vectors)) {
            assert!((force - swept_force).abs() < 1e-9, "{force} {swept_force}");
        }
    }
}
