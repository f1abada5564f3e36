//! Square matrix with cheap products.
//!
//! Products use the diagonal, the nonzero entries or Fourier transforms, if these are cheaper.

use std::ops::Deref;

use super::{LatticeProduct, LatticeScratch, SparseMatrix, Triplets, dense_multiply_add};

/// Smallest number of elements on a lattice for products by Fourier transforms.
///
/// For fewer elements, dense products are faster.
const MIN_LATTICE_ELEMENTS: usize = 36;

/// Smallest ratio of all entries to nonzero entries for which a sparse copy is used.
///
/// A product with a sparse entry costs about as much as products with four dense entries, so that the sparse copy takes
/// at most half the time.
const MIN_ENTRIES_PER_NONZERO: usize = 8;

/// Square matrix, stored as all entries row by row, or as a diagonal.
///
/// If most entries are zero, products use a sparse copy of the nonzero entries. For three components of many elements
/// on a lattice, products use Fourier transforms along the surface.
///
/// The matrix dereferences to a slice of all entries, or of the diagonal of a diagonal matrix.
#[derive(Debug)]
pub struct CompressedMatrix {
    values: Vec<f64>,
    is_diagonal: bool,
    /// Copy of the nonzero entries, if there are few.
    sparse_copy: Option<SparseMatrix>,
    /// Product by Fourier transforms, if the matrix has the structure for it.
    lattice_product: Option<LatticeProduct>,
}

impl CompressedMatrix {
    /// Matrix of these entries, row by row.
    ///
    /// Products use a sparse copy if most entries are zero.
    pub fn new(values: Vec<f64>, order: usize) -> Self {
        let nonzeros = values.iter().enumerate().filter(|(_, value)| **value != 0.0);
        let mut sparse_copy = None;
        if nonzeros.clone().count() <= values.len() / MIN_ENTRIES_PER_NONZERO {
            let entries = nonzeros.map(|(index, &value)| (index / order, index % order, value));
            let triplets = Triplets::from_entries(order, entries);
            sparse_copy = SparseMatrix::new("step compliance of the ground", &triplets).ok();
        }
        Self { sparse_copy, ..Self::dense(values) }
    }

    /// Matrix of these entries, row by row; products use all entries.
    pub fn dense(values: Vec<f64>) -> Self {
        Self { values, is_diagonal: false, sparse_copy: None, lattice_product: None }
    }

    /// Diagonal matrix, of which only the diagonal is stored.
    pub fn of_diagonal(diagonal: Vec<f64>) -> Self {
        Self { is_diagonal: true, ..Self::dense(diagonal) }
    }

    /// The diagonal of a matrix that is stored as a diagonal.
    ///
    /// `None` for other matrices.
    #[inline]
    pub fn as_diagonal(&self) -> Option<&[f64]> {
        self.is_diagonal.then_some(&self.values)
    }

    /// Diagonal entry in a row of this matrix of `order`.
    #[inline]
    pub fn diagonal(&self, order: usize, row: usize) -> f64 {
        self.values[if self.is_diagonal { row } else { row * (order + 1) }]
    }

    /// All entries of this matrix of `order`, row by row.
    pub fn filled(&self, order: usize) -> Vec<f64> {
        let mut entries = vec![0.0; order * order];
        self.fill(order, &mut entries);
        entries
    }

    /// Overwrites `entries` with all entries, row by row, of this matrix of `order`.
    pub fn fill(&self, order: usize, entries: &mut [f64]) {
        let Some(diagonal) = self.as_diagonal() else {
            return entries.copy_from_slice(&self.values);
        };
        entries.fill(0.0);
        for (entry, value) in entries.iter_mut().step_by(order + 1).zip(diagonal) {
            *entry = *value;
        }
    }

    /// Matrix of three components of elements on a lattice, component by component.
    ///
    /// `areas`: areas of the elements; `cells`: columns and rows of the elements. Products use Fourier transforms only
    /// if blocks divided by the area of their source depend only on the offset.
    pub fn on_lattice(values: Vec<f64>, cells: &[[usize; 2]], areas: &[f64]) -> Self {
        let count = areas.len();
        let mut matrix = Self::new(values, 3 * count);
        if count >= MIN_LATTICE_ELEMENTS {
            matrix.lattice_product = LatticeProduct::new(cells, areas, |receiver, source| {
                [0, 1, 2].map(|r| {
                    let row = &matrix.values[(r * count + receiver) * 3 * count..];
                    [0, 1, 2].map(|c| row[c * count + source] / areas[source])
                })
            });
        }
        matrix
    }

    /// Columns and rows of the elements, if products use Fourier transforms.
    pub fn cells(&self) -> Option<&[[usize; 2]]> {
        self.lattice_product.as_ref().map(LatticeProduct::cells)
    }

    /// Scratch for [`CompressedMatrix::multiply_add_with`].
    pub fn scratch(&self) -> LatticeScratch {
        self.lattice_product.as_ref().map(LatticeProduct::scratch).unwrap_or_default()
    }

    /// Number of entries that a product without Fourier transforms reads.
    pub fn entry_count(&self) -> usize {
        self.sparse_copy.as_ref().map_or(self.values.len(), SparseMatrix::entry_count)
    }

    /// y ← y + A x.
    pub fn multiply_add(&self, x: &[f64], y: &mut [f64]) {
        if let Some(diagonal) = self.as_diagonal() {
            for ((y, value), x) in y.iter_mut().zip(diagonal).zip(x) {
                *y += value * x;
            }
            return;
        }
        match &self.sparse_copy {
            Some(sparse) => sparse.multiply_add(1.0, x, y),
            None => dense_multiply_add(&self.values, 1.0, x, y),
        }
    }

    /// y ← y + A x, by Fourier transforms along the surface if these are faster.
    pub fn multiply_add_with(&self, scratch: &mut LatticeScratch, x: &[f64], y: &mut [f64]) {
        match &self.lattice_product {
            Some(lattice) if self.sparse_copy.is_none() => {
                let count = x.len() / 3;
                lattice.multiply(x, scratch, |k, e, value| y[k * count + e] += value);
            }
            _ => self.multiply_add(x, y),
        }
    }
}

impl Deref for CompressedMatrix {
    type Target = [f64];

    #[inline]
    fn deref(&self) -> &[f64] {
        &self.values
    }
}
