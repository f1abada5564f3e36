//! LU factors of unsymmetric matrices with a symmetric pattern.
//!
//! The order of elimination is that of a Cholesky factor. The method is multifrontal (Duff & Reid 1983, ACM Trans.
//! Math. Softw. 9, 302–325). Columns with one pattern form a front, a dense matrix of the pivots and of the rows below
//! them:
//!
//! ```text
//! | F11 F12 |      P F11 = L11 U11,  U12 = L11⁻¹ P F12,  L21 = F21 U11⁻¹
//! | F21 F22 |      F22 − L21 U12 is added to the front of the parent
//! ```
//!
//! Pivots are exchanged within a front only. A tangent stiffness with inertia needs no more; the caller checks the accuracy.

use faer::dyn_stack::{DynArray, MemBuffer, MemStack, StackReq};
use faer::linalg::lu::partial_pivoting::factor::{lu_in_place, lu_in_place_scratch};
use faer::linalg::matmul::matmul;
use faer::linalg::triangular_solve::{
    solve_lower_triangular_in_place, solve_unit_lower_triangular_in_place,
};
use faer::prelude::{Reborrow, ReborrowMut};
use faer::sparse::linalg::cholesky::{SymbolicCholesky, SymbolicCholeskyRaw};
use faer::{Accum, MatMut, Par, Spec};

use crate::{SparseMatrix, dot};

/// Columns that are eliminated together.
struct LuFront {
    /// Position of the first pivot in the order of elimination.
    first_position: usize,
    pivot_count: usize,
    /// Positions of the rows below the pivots.
    rows_below: Vec<usize>,
    /// Index of the front's first value.
    first_value: usize,
    /// Entries of the matrix: index among its values, and index in the front.
    entries: Vec<[usize; 2]>,
    /// Fronts whose remaining matrices are added to this front.
    ///
    /// Each has the place in this front of each of its rows below.
    children: Vec<(usize, Vec<usize>)>,
}

impl LuFront {
    /// Number of rows of the front.
    fn order(&self) -> usize {
        self.pivot_count + self.rows_below.len()
    }
}

/// LU factors by fronts.
pub(crate) struct BlockLu {
    fronts: Vec<LuFront>,
    /// Row at each position in the order of elimination.
    rows: Vec<usize>,
    /// The fronts, one after the other, each column by column.
    values: Vec<f64>,
    /// For each pivot, the row of its front's pivots that is exchanged to it.
    pivot_rows: Vec<usize>,
    /// Buffers of the pivots of a front.
    inverse_pivot_rows: Vec<usize>,
    pivot_values: Vec<f64>,
    /// Workspace of the factorization of a front.
    workspace: MemBuffer,
    max_order: usize,
}

impl BlockLu {
    /// Fronts of a pattern.
    ///
    /// `None` unless the pattern is symmetric and the symbolic factor has dense blocks.
    pub(crate) fn new(symbolic: &SymbolicCholesky<usize>, pattern: &SparseMatrix) -> Option<Self> {
        let SymbolicCholeskyRaw::Supernodal(blocks) = symbolic.raw() else {
            return None;
        };
        let order_of_elimination = symbolic.perm()?;
        let rows = order_of_elimination.arrays().0;
        let positions = order_of_elimination.arrays().1;
        let mut fronts = Vec::<LuFront>::with_capacity(blocks.n_supernodes());
        let mut front_of_position = vec![0; rows.len()];
        let mut value_count = 0;
        for k in 0..blocks.n_supernodes() {
            let first_position = blocks.supernode_begin()[k];
            let end_position = blocks.supernode_end()[k];
            let front = LuFront {
                first_position,
                pivot_count: end_position - first_position,
                rows_below: blocks.supernode(k).pattern().to_vec(),
                first_value: value_count,
                entries: Vec::new(),
                children: Vec::new(),
            };
            front_of_position[first_position..end_position].fill(k);
            value_count += front.order() * front.order();
            fronts.push(front);
        }
        let max_order = fronts.iter().map(LuFront::order).max().unwrap_or(0);
        let max_pivots = fronts.iter().map(|front| front.pivot_count).max().unwrap_or(0);
        let mut lu = Self {
            fronts,
            rows: rows.to_vec(),
            values: vec![0.0; value_count],
            pivot_rows: vec![0; rows.len()],
            inverse_pivot_rows: vec![0; max_pivots],
            pivot_values: vec![0.0; max_pivots],
            workspace: MemBuffer::new(lu_in_place_scratch::<usize, f64>(
                max_pivots,
                max_pivots,
                Par::Seq,
                Spec::default(),
            )),
            max_order,
        };
        lu.place_entries(pattern, positions, &front_of_position)?;
        lu.place_children(&front_of_position)?;
        Some(lu)
    }

    /// Finds the place of each entry of the matrix; `None` for an entry outside the fronts.
    fn place_entries(
        &mut self,
        pattern: &SparseMatrix,
        positions: &[usize],
        front_of_position: &[usize],
    ) -> Option<()> {
        for (index, (row, column, _)) in pattern.entries().enumerate() {
            let row_position = positions[row];
            let column_position = positions[column];
            let first_position = row_position.min(column_position);
            let front = &mut self.fronts[front_of_position[first_position]];
            let order = front.order();
            let place = front.place(row_position)? + order * front.place(column_position)?;
            front.entries.push([index, place]);
        }
        Some(())
    }

    /// Finds the parent of each front; `None` if a row below is not in the parent.
    fn place_children(&mut self, front_of_position: &[usize]) -> Option<()> {
        for k in 0..self.fronts.len() {
            let Some(next) = self.fronts[k].rows_below.iter().min() else { continue };
            let parent = front_of_position[*next];
            let mut places = Vec::with_capacity(self.fronts[k].rows_below.len());
            for row in &self.fronts[k].rows_below {
                places.push(self.fronts[parent].place(*row)?);
            }
            self.fronts[parent].children.push((k, places));
        }
        Some(())
    }

    /// Factors a matrix of the pattern.
    ///
    /// A matrix without such factors gives values that are not finite.
    pub(crate) fn factor(&mut self, matrix_values: &[f64]) {
        let Self {
            fronts, values, pivot_rows, inverse_pivot_rows, pivot_values, workspace, ..
        } = self;
        for front in &*fronts {
            let order = front.order();
            let (earlier_values, later_values) = values.split_at_mut(front.first_value);
            let front_values = &mut later_values[..order * order];
            front_values.fill(0.0);
            for [index, place] in &front.entries {
                front_values[*place] += matrix_values[*index];
            }
            for (child, places) in &front.children {
                fronts[*child].add_remaining_to(earlier_values, places, front_values, order);
            }
            let pivots = front.first_position..front.first_position + front.pivot_count;
            eliminate(
                front_values,
                order,
                [&mut pivot_rows[pivots], &mut inverse_pivot_rows[..front.pivot_count]],
                &mut pivot_values[..front.pivot_count],
                MemStack::new(workspace),
            );
        }
    }

    /// Whether these rows are the last in the order of elimination.
    pub(crate) fn ends_with(&self, last_rows: &[usize]) -> bool {
        self.rows.ends_with(last_rows)
    }

    /// Number of values of the fronts.
    pub(crate) fn value_count(&self) -> usize {
        self.values.len()
    }

    /// Workspace of a solve.
    pub(crate) fn solve_scratch(&self) -> StackReq {
        StackReq::new::<f64>(self.rows.len() + 2 * self.max_order)
    }

    /// Overwrites `rhs` with A⁻¹ rhs, or with A⁻ᵀ rhs if `is_transposed`.
    pub(crate) fn solve(&self, rhs: &mut [f64], is_transposed: bool, stack: &mut MemStack) {
        let value_at = |position: usize| rhs[self.rows[position]];
        let mut memory = self.solve_memory(value_at, stack);
        let mut vectors = self.vectors_in(&mut memory);
        if is_transposed {
            self.solve_transposed(&mut vectors);
        } else {
            self.solve_fronts(&self.fronts, &mut vectors);
        }
        for (row, value) in self.rows.iter().zip(&*vectors.ordered_values) {
            rhs[*row] = *value;
        }
    }

    /// Overwrites a right-hand side on the last positions, zero elsewhere, with the solution there.
    ///
    /// `rhs` is as long as the number of last positions.
    pub(crate) fn solve_on_last_positions(&self, rhs: &mut [f64], stack: &mut MemStack) {
        let first_position = self.rows.len() - rhs.len();
        let first_front = self
            .fronts
            .partition_point(|front| front.first_position + front.pivot_count <= first_position);
        let value_at =
            |position: usize| position.checked_sub(first_position).map_or(0.0, |index| rhs[index]);
        let mut memory = self.solve_memory(value_at, stack);
        let mut vectors = self.vectors_in(&mut memory);
        self.solve_fronts(&self.fronts[first_front..], &mut vectors);
        rhs.copy_from_slice(&vectors.ordered_values[first_position..]);
    }

    /// Memory of a solve, which begins with the right-hand side in the order of elimination.
    fn solve_memory<'a>(
        &self,
        value_at: impl Fn(usize) -> f64,
        stack: &'a mut MemStack,
    ) -> DynArray<'a, f64> {
        let count = self.rows.len();
        let value = |k: usize| if k < count { value_at(k) } else { 0.0 };
        stack.make_with(count + 2 * self.max_order, value).0
    }

    /// The vectors in the memory of a solve.
    fn vectors_in<'a>(&self, memory: &'a mut [f64]) -> SolveVectors<'a> {
        let (ordered_values, scratch) = memory.split_at_mut(self.rows.len());
        let (pivot_values, values_below) = scratch.split_at_mut(self.max_order);
        SolveVectors { ordered_values, pivot_values, values_below }
    }

    /// Solves with these last fronts, in the order of elimination.
    fn solve_fronts(&self, fronts: &[LuFront], vectors: &mut SolveVectors<'_>) {
        let x = &mut *vectors.ordered_values;
        for front in fronts {
            let pivots = &mut vectors.pivot_values[..front.pivot_count];
            let values_below = &mut vectors.values_below[..front.rows_below.len()];
            values_below.fill(0.0);
            for (k, pivot) in pivots.iter_mut().enumerate() {
                *pivot = x[front.first_position + self.pivot_rows[front.first_position + k]];
            }
            for k in 0..front.pivot_count {
                let column = self.column(front, k);
                let pivot_value = pivots[k];
                add_multiple(-pivot_value, &column.pivot_entries[k + 1..], &mut pivots[k + 1..]);
                add_multiple(pivot_value, column.entries_below, values_below);
            }
            x[front.first_position..][..front.pivot_count].copy_from_slice(pivots);
            front.rows_below.iter().zip(&*values_below).for_each(|(row, value)| x[*row] -= value);
        }
        for front in fronts.iter().rev() {
            let pivots = &mut vectors.pivot_values[..front.pivot_count];
            pivots.copy_from_slice(&x[front.first_position..][..front.pivot_count]);
            for (k, row) in front.rows_below.iter().enumerate() {
                let column = self.column(front, front.pivot_count + k);
                add_multiple(-x[*row], column.pivot_entries, pivots);
            }
            for k in (0..front.pivot_count).rev() {
                let column = self.column(front, k).pivot_entries;
                pivots[k] /= column[k];
                let pivot_value = pivots[k];
                add_multiple(-pivot_value, &column[..k], &mut pivots[..k]);
            }
            x[front.first_position..][..front.pivot_count].copy_from_slice(pivots);
        }
    }

    /// Solves with the transposed matrix, in the order of elimination.
    fn solve_transposed(&self, vectors: &mut SolveVectors<'_>) {
        let x = &mut *vectors.ordered_values;
        for front in &self.fronts {
            let pivots = &mut vectors.pivot_values[..front.pivot_count];
            pivots.copy_from_slice(&x[front.first_position..][..front.pivot_count]);
            for k in 0..front.pivot_count {
                let column = self.column(front, k).pivot_entries;
                pivots[k] = (pivots[k] - dot(&column[..k], &pivots[..k])) / column[k];
            }
            for (k, row) in front.rows_below.iter().enumerate() {
                x[*row] -= dot(self.column(front, front.pivot_count + k).pivot_entries, pivots);
            }
            x[front.first_position..][..front.pivot_count].copy_from_slice(pivots);
        }
        for front in self.fronts.iter().rev() {
            let pivots = &mut vectors.pivot_values[..front.pivot_count];
            let values_below = &mut vectors.values_below[..front.rows_below.len()];
            pivots.copy_from_slice(&x[front.first_position..][..front.pivot_count]);
            for (row, value) in front.rows_below.iter().zip(&mut *values_below) {
                *value = x[*row];
            }
            for k in (0..front.pivot_count).rev() {
                let column = self.column(front, k);
                pivots[k] -= dot(&column.pivot_entries[k + 1..], &pivots[k + 1..]);
                pivots[k] -= dot(column.entries_below, values_below);
            }
            for (k, pivot) in pivots.iter().enumerate() {
                x[front.first_position + self.pivot_rows[front.first_position + k]] = *pivot;
            }
        }
    }

    /// A column of a front.
    fn column(&self, front: &LuFront, index: usize) -> FrontColumn<'_> {
        let order = front.order();
        let column = &self.values[front.first_value + index * order..][..order];
        let count = front.pivot_count;
        FrontColumn { pivot_entries: &column[..count], entries_below: &column[count..] }
    }
}

/// Column of a front: entries in the rows of its pivots, and in the rows below.
struct FrontColumn<'a> {
    pivot_entries: &'a [f64],
    entries_below: &'a [f64],
}

/// Vectors of a solve.
struct SolveVectors<'a> {
    /// Right-hand side and solution in the order of elimination.
    ordered_values: &'a mut [f64],
    /// Buffers of a front: values at its pivots, and at its rows below.
    pivot_values: &'a mut [f64],
    values_below: &'a mut [f64],
}

impl LuFront {
    /// Place of a position among the rows of the front, or `None`.
    fn place(&self, position: usize) -> Option<usize> {
        let pivot_place = position.checked_sub(self.first_position)?;
        if pivot_place < self.pivot_count {
            return Some(pivot_place);
        }
        let index = self.rows_below.binary_search(&position).ok()?;
        Some(self.pivot_count + index)
    }

    /// Adds what remains of this front after its elimination to the front of its parent.
    ///
    /// `places`: place in the parent's front of each row below. `parent_order`: number of its rows.
    fn add_remaining_to(
        &self,
        values: &[f64],
        places: &[usize],
        parent_values: &mut [f64],
        parent_order: usize,
    ) {
        let order = self.order();
        let columns = values[self.first_value..][..order * order].chunks_exact(order);
        for (column, column_place) in columns.skip(self.pivot_count).zip(places) {
            let parent_column = &mut parent_values[column_place * parent_order..][..parent_order];
            for (value, place) in column[self.pivot_count..].iter().zip(places) {
                parent_column[*place] += value;
            }
        }
    }
}

/// Eliminates the pivots of a front.
///
/// `pivot_rows` and `inverse_pivot_rows` are overwritten; `pivot_values` is a buffer.
fn eliminate(
    values: &mut [f64],
    order: usize,
    [pivot_rows, inverse_pivot_rows]: [&mut [usize]; 2],
    pivot_values: &mut [f64],
    stack: &mut MemStack,
) {
    let pivot_count = pivot_rows.len();
    let front = MatMut::from_column_major_slice_mut(values, order, order);
    let f11 = front.submatrix_mut(0, 0, pivot_count, pivot_count);
    lu_in_place(f11, pivot_rows, inverse_pivot_rows, Par::Seq, stack, Spec::default());
    for column in values.chunks_exact_mut(order).skip(pivot_count) {
        for (value, row) in pivot_values.iter_mut().zip(&*pivot_rows) {
            *value = column[*row];
        }
        column[..pivot_count].copy_from_slice(pivot_values);
    }
    let front = MatMut::from_column_major_slice_mut(values, order, order);
    let (f11, mut f12, mut f21, f22) = front.split_at_mut(pivot_count, pivot_count);
    let f11 = f11.rb();
    solve_unit_lower_triangular_in_place(f11, f12.rb_mut(), Par::Seq);
    solve_lower_triangular_in_place(f11.transpose(), f21.rb_mut().transpose_mut(), Par::Seq);
    matmul(f22, Accum::Add, f21.rb(), f12.rb(), -1.0, Par::Seq);
}

/// Adds `factor` times `addends` to `sums`.
fn add_multiple(factor: f64, addends: &[f64], sums: &mut [f64]) {
    sums.iter_mut().zip(addends).for_each(|(sum, addend)| *sum += factor * addend);
}
