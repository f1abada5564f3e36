//! The sink into which structures and elements write their matrices.

/// Square sparse matrix under construction: entries at the same place add up.
///
/// Indices out of range and values that are not finite are remembered and reported as a typed
/// error when the matrix is used, so that filling it never fails.
#[derive(Debug, Clone, PartialEq)]
pub struct Triplets {
    order: usize,
    entries: Vec<(usize, usize, f64)>,
    /// Offset of indices while a member of a group writes its block.
    shift: Option<usize>,
}

impl Triplets {
    /// Empty matrix of `order` rows and columns.
    pub fn new(order: usize) -> Self {
        Self { order, entries: Vec::new(), shift: None }
    }

    /// Number of rows and columns.
    pub fn order(&self) -> usize {
        self.order
    }

    /// Adds `value` at (`row`, `column`).
    pub fn add(&mut self, row: usize, column: usize, value: f64) {
        let place = |index: usize| match self.shift {
            None => index,
            Some(shift) if index < self.order => index + shift,
            // An index beyond the block must not be within the whole.
            Some(_) => usize::MAX,
        };
        self.entries.push((place(row), place(column), value));
    }

    /// Adds a dense block (row-major, `indices.len()` squared) at rows and columns `indices`.
    /// A block that is too short leaves its missing entries out.
    pub fn add_block(&mut self, indices: &[usize], block: &[f64]) {
        for (row, values) in indices.iter().zip(block.chunks(indices.len().max(1))) {
            for (column, &value) in indices.iter().zip(values) {
                self.add(*row, *column, value);
            }
        }
    }

    /// Adds a spring `stiffness` between two unknowns.
    pub fn add_spring(&mut self, first: usize, second: usize, stiffness: f64) {
        self.add(first, first, stiffness);
        self.add(second, second, stiffness);
        self.add(first, second, -stiffness);
        self.add(second, first, -stiffness);
    }

    /// Adds `factor · l lᵀ`, where the row vector l is a [`Row`](super::Row) or a list of (unknown,
    /// weight) terms: the matrix of a spring (or dashpot) that sees the deformation l·u.
    pub fn add_outer(&mut self, row: impl AsRef<[(usize, f64)]>, factor: f64) {
        let terms = row.as_ref();
        for &(i, a) in terms {
            for &(j, b) in terms {
                self.add(i, j, factor * a * b);
            }
        }
    }

    /// The entries so far, in the order they came: (row, column, value).
    pub fn entries(&self) -> &[(usize, usize, f64)] {
        &self.entries
    }

    /// Lets `write` fill the diagonal block of `order` rows that begins at row `first`.
    pub(crate) fn block<T>(
        &mut self,
        first: usize,
        order: usize,
        write: impl FnOnce(&mut Self) -> T,
    ) -> T {
        let outer = (self.order, self.shift);
        (self.order, self.shift) = (order, Some(self.shift.unwrap_or(0) + first));
        let written = write(self);
        (self.order, self.shift) = outer;
        written
    }

    /// Forgets all entries, keeping the memory.
    pub fn clear(&mut self) {
        self.entries.clear();
    }
}
