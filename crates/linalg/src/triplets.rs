//! Container into which structures and elements write their matrices.

use crate::error::{Result, in_bounds, same_length};

/// Square sparse matrix under construction: entries with equal indices are summed.
///
/// Indices out of range and values that are not finite are stored. They give a typed error when the matrix is used, so
/// that adding entries never fails.
#[derive(Debug, Clone, PartialEq)]
pub struct Triplets {
    order: usize,
    entries: Vec<(usize, usize, f64)>,
    /// Offset of indices while a block is written, see [`Triplets::block`].
    index_offset: Option<usize>,
}

impl Triplets {
    /// Empty matrix of `order` rows and columns.
    pub fn new(order: usize) -> Self {
        Self { order, entries: Vec::new(), index_offset: None }
    }

    /// Matrix of `order` rows and columns from its entries (row, column, value).
    ///
    /// ```
    /// use basemat::structure::Triplets;
    /// let matrix = Triplets::from_entries(3, [(0, 0, 2.0), (2, 2, 1.0), (0, 0, 0.5)]);
    /// assert_eq!((matrix.order(), matrix.entries().len()), (3, 3));
    /// // Collected, the matrix ends with the last row or column that has an entry.
    /// let matrix: Triplets = [(0, 4, 1.0)].into_iter().collect();
    /// assert_eq!(matrix.order(), 5);
    /// ```
    pub fn from_entries(
        order: usize,
        entries: impl IntoIterator<Item = (usize, usize, f64)>,
    ) -> Self {
        Self { order, entries: entries.into_iter().collect(), index_offset: None }
    }

    /// Matrix of `order` rows and columns from all its `values`, row-major; zeros are omitted.
    ///
    /// ```
    /// use basemat::structure::Triplets;
    /// let matrix = Triplets::from_dense(2, &[4.0, -1.0, 0.0, 3.0])?;
    /// assert_eq!(matrix.entries(), [(0, 0, 4.0), (0, 1, -1.0), (1, 1, 3.0)]);
    /// # Ok::<(), basemat::Error>(())
    /// ```
    ///
    /// # Errors
    /// [`Error::Size`](crate::Error::Size) unless there are `order` times `order` values.
    pub fn from_dense(order: usize, values: &[f64]) -> Result<Self> {
        same_length("dense matrix", values.len(), order.saturating_mul(order))?;
        let nonzeros = values.iter().enumerate().filter(|(_, value)| **value != 0.0);
        let entries = nonzeros.map(|(index, &value)| (index / order, index % order, value));
        Ok(Self::from_entries(order, entries))
    }

    /// Matrix of `order` rows and columns in compressed sparse rows, as SciPy's `csr_matrix` has them.
    ///
    /// Row i has the entries `pointers[i]..pointers[i + 1]` of `columns` and `values`, in any order. Entries with equal
    /// indices are summed.
    ///
    /// ```
    /// use basemat::structure::Triplets;
    /// let matrix = Triplets::from_csr(2, &[0, 2, 3], &[0, 1, 1], &[4.0, -1.0, 3.0])?;
    /// assert_eq!(matrix, Triplets::from_dense(2, &[4.0, -1.0, 0.0, 3.0])?);
    /// # Ok::<(), basemat::Error>(())
    /// ```
    ///
    /// # Errors
    /// [`Error::Size`](crate::Error::Size) unless there are `order + 1` row pointers, equal numbers of columns and
    /// values, and the last pointer is this number. [`Error::Index`](crate::Error::Index) if the first pointer is not
    /// zero, a pointer is larger than the next one, or a column does not exist.
    pub fn from_csr(
        order: usize,
        pointers: &[usize],
        columns: &[usize],
        values: &[f64],
    ) -> Result<Self> {
        same_length("list of row pointers", pointers.len(), order.saturating_add(1))?;
        same_length("list of columns", columns.len(), values.len())?;
        same_length("list of values", values.len(), pointers[order])?;
        in_bounds("first row pointer", pointers[0], 1)?;
        for pair in pointers.windows(2) {
            in_bounds("row pointer", pair[0], pair[1].saturating_add(1))?;
        }
        for column in columns {
            in_bounds("column of a matrix", *column, order)?;
        }
        let mut entries = Vec::with_capacity(values.len());
        for (row, bounds) in pointers.windows(2).enumerate() {
            entries.extend((bounds[0]..bounds[1]).map(|k| (row, columns[k], values[k])));
        }
        Ok(Self { order, entries, index_offset: None })
    }

    /// Number of rows and columns.
    #[inline]
    pub fn order(&self) -> usize {
        self.order
    }

    /// Adds `value` at (`row`, `column`).
    #[inline]
    pub fn add(&mut self, row: usize, column: usize, value: f64) {
        self.entries.push((self.index_in_matrix(row), self.index_in_matrix(column), value));
    }

    /// Index in the whole matrix of an index in the current block.
    #[inline]
    fn index_in_matrix(&self, index: usize) -> usize {
        match self.index_offset {
            None => index,
            Some(offset) if index < self.order => index + offset,
            // An index outside the block must not become a valid index of the whole matrix.
            Some(_) => usize::MAX,
        }
    }

    /// Adds a dense block (row-major) at rows and columns `indices`.
    ///
    /// A full block has `indices.len()` squared entries; entries missing at the end count as zeros.
    #[inline]
    pub fn add_block(&mut self, indices: &[usize], block: &[f64]) {
        let rows = indices.iter().zip(block.chunks(indices.len().max(1)));
        if self.index_offset.is_none() {
            for (&row, values) in rows {
                let columns = indices.iter().zip(values);
                self.entries.extend(columns.map(|(&column, &value)| (row, column, value)));
            }
            return;
        }
        for (row, values) in rows {
            for (column, &value) in indices.iter().zip(values) {
                self.add(*row, *column, value);
            }
        }
    }

    /// Adds a spring of this `stiffness` between two degrees of freedom.
    #[inline]
    pub fn add_spring(&mut self, first: usize, second: usize, stiffness: f64) {
        self.add(first, first, stiffness);
        self.add(second, second, stiffness);
        self.add(first, second, -stiffness);
        self.add(second, first, -stiffness);
    }

    /// Adds `factor · lᵀ l`, the matrix of a spring or dashpot with the deformation l·u.
    ///
    /// The row vector l is a `DofCombination` or a list of (degree of freedom, weight) terms.
    pub fn add_outer(&mut self, row: impl AsRef<[(usize, f64)]>, factor: f64) {
        let terms = row.as_ref();
        for &(i, a) in terms {
            for &(j, b) in terms {
                self.add(i, j, factor * a * b);
            }
        }
    }

    /// The entries so far, in the order of their addition: (row, column, value).
    #[inline]
    pub fn entries(&self) -> &[(usize, usize, f64)] {
        &self.entries
    }

    /// Calls `write`, whose indices are relative to a diagonal block of `order` rows from `first_row` on.
    #[doc(hidden)]
    pub fn block<T>(
        &mut self,
        first_row: usize,
        order: usize,
        write: impl FnOnce(&mut Self) -> T,
    ) -> T {
        let outer_order = self.order;
        let outer_offset = self.index_offset;
        let block_offset = Some(outer_offset.unwrap_or(0) + first_row);
        self.order = order;
        self.index_offset = block_offset;
        let result = write(self);
        // If `write` has replaced the triplets, their order is kept, and a later check of the order fails.
        if self.order == order && self.index_offset == block_offset {
            self.order = outer_order;
            self.index_offset = outer_offset;
        }
        result
    }

    /// Removes all entries without releasing their memory.
    #[doc(hidden)]
    pub fn clear(&mut self) {
        self.entries.clear();
    }
}

/// Triplets whose order follows from the largest index.
///
/// Empty rows at the end are therefore missing; [`Triplets::from_entries`] includes them.
impl FromIterator<(usize, usize, f64)> for Triplets {
    fn from_iter<I: IntoIterator<Item = (usize, usize, f64)>>(entries: I) -> Self {
        let entries: Vec<_> = entries.into_iter().collect();
        let max_index = entries.iter().map(|&(row, column, _)| row.max(column)).max();
        let order = max_index.map_or(0, |index| index.saturating_add(1));
        Self { order, entries, index_offset: None }
    }
}

/// Adds entries as [`Triplets::add`] does.
impl Extend<(usize, usize, f64)> for Triplets {
    fn extend<I: IntoIterator<Item = (usize, usize, f64)>>(&mut self, entries: I) {
        entries.into_iter().for_each(|(row, column, value)| self.add(row, column, value));
    }
}
