//! Static steps of a yielding structure under loads and prescribed displacements.
//!
//! Newton's method with a line search along the increment. The incremental potential of the materials is convex: along an
//! increment, the work of the out-of-balance force changes its sign once, and bisection finds this point.

use basemat::structure::{FemModel, Structure, Triplets};
use basemat_linalg::{Elimination, SparseFactor, SparseMatrix};

/// Out-of-balance force at which a step ends, relative to the largest force.
const RESIDUAL_TOLERANCE: f64 = 1e-10;
/// Work of the out-of-balance force on an increment at which a line search ends, relative to that at its start.
const SEARCH_TOLERANCE: f64 = 0.1;
const MAX_ITERATIONS: usize = 60;
const MAX_BISECTIONS: usize = 40;

/// A model with its present displacement, forces and loads.
#[derive(Debug)]
pub struct StaticSteps {
    model: FemModel,
    stiffness: SparseMatrix,
    /// Index of each degree of freedom among those that are free; `None` for a prescribed one.
    free_index: Vec<Option<usize>>,
    free_count: usize,
    /// Displacement at the end of the last step, m.
    pub displacement: Vec<f64>,
    /// Forces of the structure at the end of the last step, N.
    pub force: Vec<f64>,
    /// Loads, N.
    pub load: Vec<f64>,
}

impl StaticSteps {
    /// The undeformed model with these fixed degrees of freedom.
    pub fn new(model: &FemModel, fixed: &[usize]) -> Self {
        let n = model.dofs();
        let mut entries = Triplets::new(n);
        model.stiffness(&mut entries).unwrap();
        let mut steps = Self {
            model: model.clone(),
            stiffness: SparseMatrix::new("stiffness", &entries).unwrap(),
            free_index: Vec::new(),
            free_count: 0,
            displacement: vec![0.0; n],
            force: vec![0.0; n],
            load: vec![0.0; n],
        };
        steps.fix(fixed);
        steps
    }

    /// Replaces the degrees of freedom that are not free.
    pub fn fix(&mut self, fixed: &[usize]) {
        let mut is_free = vec![true; self.model.dofs()];
        for &dof in fixed {
            is_free[dof] = false;
        }
        self.free_count = 0;
        self.free_index.clear();
        for is_free in is_free {
            self.free_index.push(is_free.then_some(self.free_count));
            self.free_count += usize::from(is_free);
        }
    }

    /// Advances to the present load and moves fixed degrees of freedom; returns the number of iterations.
    ///
    /// `motion`: pairs of a degree of freedom and the increment of its displacement.
    pub fn advance(&mut self, motion: &[(usize, f64)]) -> usize {
        let mut trial = self.displacement.clone();
        let mut increment = vec![0.0; trial.len()];
        for &(dof, displacement) in motion {
            increment[dof] = displacement;
        }
        for iteration in 1..=MAX_ITERATIONS {
            self.solve_increment(&trial, &mut increment);
            let factor =
                if iteration == 1 { 1.0 } else { self.line_search_factor(&trial, &increment) };
            trial.iter_mut().zip(&increment).for_each(|(u, du)| *u += factor * du);
            increment.fill(0.0);
            self.force = self.internal_force(&trial);
            let largest_force = largest(&self.force);
            if largest(&self.free_residual(&self.force)) <= RESIDUAL_TOLERANCE * largest_force {
                self.model.nonlinear_mut().unwrap().commit(&trial);
                self.displacement = trial;
                return iteration;
            }
        }
        panic!("a static step does not converge");
    }

    /// Overwrites the free entries of `increment` by the solution with the tangent at `trial`.
    fn solve_increment(&self, trial: &[f64], increment: &mut [f64]) {
        let n = trial.len();
        let mut entries = Triplets::new(n);
        self.model.nonlinear().unwrap().tangent(trial, &mut entries).unwrap();
        self.stiffness.add_to(1.0, &mut entries);
        let mut right_hand_side = self.free_residual(&self.internal_force(trial));
        for entry in &mut right_hand_side {
            *entry = -*entry;
        }
        let mut free_entries = Triplets::new(self.free_count);
        for &(row, column, value) in entries.entries() {
            match (self.free_index[row], self.free_index[column]) {
                (Some(i), Some(j)) => free_entries.add(i, j, value),
                (Some(i), None) => right_hand_side[i] -= value * increment[column],
                _ => {}
            }
        }
        let matrix = SparseMatrix::new("tangent", &free_entries).unwrap();
        let elimination = Elimination::default();
        let mut factor = SparseFactor::with_elimination("tangent", &matrix, &elimination).unwrap();
        factor.solve(&mut right_hand_side);
        for (entry, free_index) in increment.iter_mut().zip(&self.free_index) {
            if let Some(index) = free_index {
                *entry = right_hand_side[*index];
            }
        }
    }

    /// Factor on an increment at which the out-of-balance force does little work on it.
    fn line_search_factor(&self, trial: &[f64], increment: &[f64]) -> f64 {
        let work = |factor: f64| {
            let displacement: Vec<f64> =
                trial.iter().zip(increment).map(|(u, du)| u + factor * du).collect();
            let force = self.internal_force(&displacement);
            let residual = force.iter().zip(&self.load).map(|(force, load)| force - load);
            let works = residual.zip(increment).map(|(residual, du)| residual * du);
            works.sum::<f64>()
        };
        let tolerance = SEARCH_TOLERANCE * work(0.0).abs();
        if work(1.0) <= tolerance {
            return 1.0;
        }
        let mut lower = 0.0;
        let mut upper = 1.0;
        for _ in 0..MAX_BISECTIONS {
            let middle = 0.5 * (lower + upper);
            let middle_work = work(middle);
            if middle_work.abs() <= tolerance {
                return middle;
            }
            if middle_work > 0.0 {
                upper = middle;
            } else {
                lower = middle;
            }
        }
        0.5 * (lower + upper)
    }

    /// Forces of the linear and of the other elements.
    fn internal_force(&self, displacement: &[f64]) -> Vec<f64> {
        let mut force = vec![0.0; displacement.len()];
        self.stiffness.multiply_add(1.0, displacement, &mut force);
        self.model.nonlinear().unwrap().force(displacement, &mut force).unwrap();
        force
    }

    /// Out-of-balance forces at the free degrees of freedom.
    fn free_residual(&self, force: &[f64]) -> Vec<f64> {
        let mut residual = vec![0.0; self.free_count];
        for ((force, load), free_index) in force.iter().zip(&self.load).zip(&self.free_index) {
            if let Some(index) = free_index {
                residual[*index] = force - load;
            }
        }
        residual
    }
}

fn largest(values: &[f64]) -> f64 {
    values.iter().fold(0.0, |max: f64, value| max.max(value.abs()))
}
