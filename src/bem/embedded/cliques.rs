//! Elimination of degrees of freedom from a sum of small symmetric matrices.
//!
//! Each matrix couples a few degrees of freedom with each other. A front is the sum of all matrices that contain some
//! degrees of freedom. These are eliminated, and the rest of the front replaces the matrices of the sum. A matrix is
//! called a clique, since in the graph of couplings it connects all its degrees of freedom with each other. The next
//! front is always the one that leaves the smallest matrix (minimum degree; Duff & Reid 1983). The order depends only
//! on which degrees of freedom the matrices contain, and is the same at all Laplace variables.

use std::collections::BTreeMap;

use crate::error::Result;
use crate::linalg::ComplexBlock;

/// Order in which degrees of freedom are eliminated from a sum of matrices.
#[derive(Debug)]
pub(super) struct EliminationPlan {
    fronts: Vec<EliminationFront>,
    /// Sum of all matrices that remain.
    remainder: EliminationFront,
}

/// Sum of matrices, from which the first degrees of freedom are eliminated.
#[derive(Debug)]
struct EliminationFront {
    /// Number of degrees of freedom that are eliminated.
    pivot_order: usize,
    /// Number of degrees of freedom that remain.
    order: usize,
    terms: Vec<FrontTerm>,
}

/// Matrix in the sum of a front.
#[derive(Debug)]
struct FrontTerm {
    /// Index of the matrix; results of fronts follow the matrices of the sum.
    matrix: usize,
    /// Rows of the free degrees of freedom of the matrix, in the order of the front.
    places: Vec<Place>,
    /// Number of these rows that are eliminated; they come first.
    eliminated_count: usize,
}

/// Degree of freedom in a term of a front.
#[derive(Debug, Clone, Copy)]
struct Place {
    /// Row in the front: among those that are eliminated, or among those that remain.
    front_row: usize,
    /// Row in the matrix of the term.
    row: usize,
}

impl EliminationFront {
    /// Matrix of the degrees of freedom that remain, in its lower triangle.
    ///
    /// The matrices of the terms are taken from `matrices`.
    fn remaining_matrix(&self, matrices: &mut [ComplexBlock]) -> Result<ComplexBlock> {
        let Self { pivot_order, order, terms } = self;
        let mut pivot = ComplexBlock::zeros(*pivot_order, *pivot_order);
        let mut coupling = ComplexBlock::zeros(*pivot_order, *order);
        let mut remaining = ComplexBlock::zeros(*order, *order);
        for FrontTerm { matrix, places, eliminated_count } in terms {
            let matrix = std::mem::replace(&mut matrices[*matrix], ComplexBlock::zeros(0, 0));
            let eliminated = &places[..*eliminated_count];
            let remaining_places = &places[*eliminated_count..];
            for (k, column) in eliminated.iter().enumerate() {
                let values = matrix.column(column.row);
                for place in &eliminated[k..] {
                    pivot[(place.front_row, column.front_row)] += values[place.row];
                }
                for place in remaining_places {
                    coupling[(column.front_row, place.front_row)] += values[place.row];
                }
            }
            for (k, column) in remaining_places.iter().enumerate() {
                let values = matrix.column(column.row);
                let sums = remaining.column_mut(column.front_row);
                for place in &remaining_places[k..] {
                    sums[place.front_row] += values[place.row];
                }
            }
        }
        pivot.mirror_lower();
        remaining.eliminate_in_lower(&pivot, &coupling)?;
        Ok(remaining)
    }
}

impl EliminationPlan {
    /// Plan for matrices with these degrees of freedom.
    ///
    /// One list for each matrix, with `None` for fixed degrees of freedom. All are eliminated, except those in `retained`.
    pub(super) fn new(matrix_dofs: &[Vec<Option<usize>>], retained: &[usize]) -> Self {
        let mut graph = CliqueGraph::new(matrix_dofs, retained);
        let mut steps = vec![];
        while let Some(step) = graph.step() {
            steps.push(step);
        }
        // Rows of all matrices follow the order of elimination, so that lower triangles are added to lower triangles.
        let eliminated = steps.iter().flat_map(|step| graph.dofs(&step.eliminated));
        let ranks: BTreeMap<usize, usize> = eliminated
            .chain(retained.iter().copied())
            .enumerate()
            .map(|(rank, dof)| (dof, rank))
            .collect();
        let mut dofs_by_matrix = matrix_dofs.to_vec();
        let mut fronts = vec![];
        for Step { cliques, eliminated, remaining } in &steps {
            let eliminated_dofs = graph.dofs(eliminated);
            let mut remaining_dofs = graph.dofs(remaining);
            remaining_dofs.sort_unstable_by_key(|dof| ranks[dof]);
            fronts.push(EliminationFront::new(
                cliques,
                &dofs_by_matrix,
                &eliminated_dofs,
                &remaining_dofs,
            ));
            dofs_by_matrix.push(remaining_dofs.into_iter().map(Some).collect());
        }
        let cliques: Vec<usize> =
            (0..dofs_by_matrix.len()).filter(|clique| graph.is_present[*clique]).collect();
        let remainder = EliminationFront::new(&cliques, &dofs_by_matrix, &[], retained);
        Self { fronts, remainder }
    }

    /// Matrix of the retained degrees of freedom, in their order.
    ///
    /// `matrices`: in the order of their lists of degrees of freedom.
    ///
    /// # Errors
    /// [`Error::Singular`](crate::Error::Singular).
    pub(super) fn retained_matrix(&self, mut matrices: Vec<ComplexBlock>) -> Result<ComplexBlock> {
        for front in &self.fronts {
            let remaining = front.remaining_matrix(&mut matrices)?;
            matrices.push(remaining);
        }
        let mut matrix = self.remainder.remaining_matrix(&mut matrices)?;
        matrix.mirror_lower();
        Ok(matrix)
    }
}

impl EliminationFront {
    /// Sum of `cliques`, with the eliminated and the remaining degrees of freedom.
    fn new(
        cliques: &[usize],
        dofs_by_matrix: &[Vec<Option<usize>>],
        eliminated_dofs: &[usize],
        remaining_dofs: &[usize],
    ) -> Self {
        let mut front_rows = BTreeMap::new();
        for (is_remaining, dofs) in [(false, eliminated_dofs), (true, remaining_dofs)] {
            for (row, dof) in dofs.iter().enumerate() {
                front_rows.insert(*dof, (is_remaining, row));
            }
        }
        let mut terms = Vec::with_capacity(cliques.len());
        for clique in cliques {
            let mut rows = vec![];
            for (row, dof) in dofs_by_matrix[*clique].iter().enumerate() {
                let front_row = dof.and_then(|dof| front_rows.get(&dof).copied());
                rows.extend(front_row.map(|front_row| (front_row, row)));
            }
            rows.sort_unstable();
            let eliminated_count =
                rows.iter().filter(|((is_remaining, _), _)| !is_remaining).count();
            let places = rows.into_iter().map(|((_, front_row), row)| Place { front_row, row });
            terms.push(FrontTerm { matrix: *clique, places: places.collect(), eliminated_count });
        }
        Self { pivot_order: eliminated_dofs.len(), order: remaining_dofs.len(), terms }
    }
}

/// State of the elimination: which groups of degrees of freedom each matrix contains.
struct CliqueGraph {
    groups: Vec<DofGroup>,
    /// Groups in each matrix, in ascending order.
    cliques: Vec<Vec<usize>>,
    /// Whether each matrix is still in the sum.
    is_present: Vec<bool>,
    /// Order of the matrix that the elimination of each group would leave.
    ///
    /// `None` for groups that are eliminated or retained.
    degrees: Vec<Option<usize>>,
}

/// Degrees of freedom that the same matrices contain.
struct DofGroup {
    dofs: Vec<usize>,
    is_retained: bool,
    /// Matrices that contain the group, in ascending order.
    cliques: Vec<usize>,
}

/// Elimination of groups of degrees of freedom from the sum of some cliques.
struct Step {
    cliques: Vec<usize>,
    eliminated: Vec<usize>,
    remaining: Vec<usize>,
}

impl CliqueGraph {
    fn new(matrix_dofs: &[Vec<Option<usize>>], retained: &[usize]) -> Self {
        let mut cliques_of_dofs: BTreeMap<usize, Vec<usize>> = BTreeMap::new();
        for (matrix, dofs) in matrix_dofs.iter().enumerate() {
            for dof in dofs.iter().flatten() {
                cliques_of_dofs.entry(*dof).or_default().push(matrix);
            }
        }
        let mut dofs_of_cliques: BTreeMap<(bool, Vec<usize>), Vec<usize>> = BTreeMap::new();
        for (dof, cliques) in cliques_of_dofs {
            dofs_of_cliques.entry((retained.contains(&dof), cliques)).or_default().push(dof);
        }
        let mut groups = vec![];
        let mut cliques = vec![vec![]; matrix_dofs.len()];
        for ((is_retained, group_cliques), dofs) in dofs_of_cliques {
            for clique in &group_cliques {
                cliques[*clique].push(groups.len());
            }
            groups.push(DofGroup { dofs, is_retained, cliques: group_cliques });
        }
        let is_present = vec![true; cliques.len()];
        let mut graph = Self { cliques, is_present, degrees: vec![None; groups.len()], groups };
        (0..graph.groups.len()).for_each(|group| graph.update_degree(group));
        graph
    }

    /// All degrees of freedom of some groups.
    fn dofs(&self, groups: &[usize]) -> Vec<usize> {
        groups.iter().flat_map(|group| self.groups[*group].dofs.iter().copied()).collect()
    }

    /// Elimination of a group, and of all groups that only its matrices contain.
    fn elimination(&self, group: usize) -> Step {
        let cliques = self.groups[group].cliques.clone();
        let mut front: Vec<usize> =
            cliques.iter().flat_map(|clique| self.cliques[*clique].iter().copied()).collect();
        front.sort_unstable();
        front.dedup();
        let (eliminated, remaining) = front.into_iter().partition(|member| {
            let DofGroup { is_retained, cliques: member_cliques, .. } = &self.groups[*member];
            !is_retained && member_cliques.iter().all(|clique| cliques.contains(clique))
        });
        Step { cliques, eliminated, remaining }
    }

    /// Computes the order of the matrix that the elimination of a group would leave.
    fn update_degree(&mut self, group: usize) {
        if !self.groups[group].is_retained {
            let remaining = self.elimination(group).remaining;
            let order = remaining.iter().map(|member| self.groups[*member].dofs.len()).sum();
            self.degrees[group] = Some(order);
        }
    }

    /// Eliminates the groups that leave the smallest matrix; `None` if all are eliminated.
    fn step(&mut self) -> Option<Step> {
        let candidates = self.degrees.iter().enumerate();
        let candidates = candidates.filter_map(|(group, degree)| Some((degree.as_ref()?, group)));
        let group = candidates.min()?.1;
        let step = self.elimination(group);
        for group in &step.eliminated {
            self.degrees[*group] = None;
        }
        for clique in &step.cliques {
            self.is_present[*clique] = false;
        }
        let result = self.cliques.len();
        for group in &step.remaining {
            let cliques = &mut self.groups[*group].cliques;
            cliques.retain(|clique| !step.cliques.contains(clique));
            cliques.push(result);
        }
        self.cliques.push(step.remaining.clone());
        self.is_present.push(true);
        for group in &step.remaining {
            self.update_degree(*group);
        }
        Some(step)
    }
}

#[cfg(test)]
mod tests {
    use basemat_fourier::num_complex::Complex64;
    use basemat_testkit::random::Random;

    use super::*;

    /// Random matrices of a grid of cells with four corners each, the lowest of them fixed.
    #[test]
    fn elimination_front_by_front_is_elimination_at_once() {
        let mut random = Random(7);
        let columns = 6;
        let rows = 5;
        let order = (columns + 1) * (rows + 1);
        let corner = |i: usize, j: usize| (j > 0).then_some(i * (rows + 1) + j);
        let mut matrix_dofs = vec![];
        let mut matrices = vec![];
        let mut sum = ComplexBlock::zeros(order, order);
        for cell in 0..columns * rows {
            let i = cell / rows;
            let j = cell % rows;
            let dofs = [corner(i + 1, j + 1), corner(i, j), corner(i + 1, j), corner(i, j + 1)];
            let mut matrix = ComplexBlock::zeros(4, 4);
            for b in 0..4 {
                for a in b..4 {
                    let diagonal = if a == b { 3.0 } else { 0.0 };
                    let re = diagonal + random.within(-1.0, 1.0);
                    matrix[(a, b)] = Complex64::new(re, random.within(-1.0, 1.0));
                }
            }
            matrix.mirror_lower();
            for (b, column) in dofs.iter().enumerate() {
                for (a, row) in dofs.iter().enumerate() {
                    if let (Some(row), Some(column)) = (row, column) {
                        sum[(*row, *column)] += matrix[(a, b)];
                    }
                }
            }
            matrix_dofs.push(dofs.to_vec());
            matrices.push(matrix);
        }
        let retained = [7, 1, order - 1, 20];
        let plan = EliminationPlan::new(&matrix_dofs, &retained);
        assert!(plan.fronts.len() > 5);
        let computed = plan.retained_matrix(matrices).unwrap();
        let is_eliminated = |dof: &usize| !dof.is_multiple_of(rows + 1) && !retained.contains(dof);
        let eliminated: Vec<usize> = (0..order).filter(is_eliminated).collect();
        let part = |row_dofs: &[usize], column_dofs: &[usize]| {
            let mut values = vec![];
            for column in column_dofs {
                values.extend(row_dofs.iter().map(|row| sum[(*row, *column)]));
            }
            ComplexBlock::from_columns(row_dofs.len(), values)
        };
        let mut expected = part(&retained, &retained);
        let pivot = part(&eliminated, &eliminated);
        expected.eliminate(&pivot, &part(&eliminated, &retained)).unwrap();
        for (computed, expected) in computed.values().iter().zip(expected.values()) {
            assert!((computed - expected).norm() < 1e-12, "{computed} {expected}");
        }
    }
}
