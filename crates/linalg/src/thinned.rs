//! A square matrix with products by its diagonal, its sparse entries or FFT where that is cheaper.

use std::ops::Deref;

use super::{LatticeProduct, LatticeScratch, SparseMatrix, Triplets, dense_multiply_add};

/// Smallest number of elements on a lattice for which products transform along the surface.
const MIN_LATTICE_ELEMENTS: usize = 36;

/// A square matrix: all entries, row by row, or a diagonal.
///
/// If most entries are zero, products use a sparse copy of the others. For three components of many elements on a
/// lattice, products use Fourier transforms along the surface.
///
/// As a slice it is all entries, or the diagonal of a diagonal matrix.
#[derive(Debug)]
pub struct CompressedMatrix {
    values: Vec<f64>,
    is_diagonal: bool,
    entries: Option<SparseMatrix>,
    lattice: Option<LatticeProduct>,
}

impl CompressedMatrix {
    pub fn new(values: Vec<f64>, order: usize) -> Self {
        let nonzeros = values.iter().filter(|value| **value != 0.0).count();
        // A product with a sparse entry costs about as much as with four dense ones.
        let entries = (nonzeros <= values.len() / 8)
            .then(|| {
                let mut entries = Triplets::new(order);
                for (place, &value) in values.iter().enumerate().filter(|(_, v)| **v != 0.0) {
                    entries.add(place / order, place % order, value);
                }
                SparseMatrix::new("step compliance of the ground", &entries).ok()
            })
            .flatten();
        Self { entries, ..Self::full(values) }
    }

    /// Matrix of these entries, all of which are multiplied.
    pub fn full(values: Vec<f64>) -> Self {
        Self { values, is_diagonal: false, entries: None, lattice: None }
    }

    /// Diagonal matrix, of which only the diagonal is stored.
    pub fn of_diagonal(diagonal: Vec<f64>) -> Self {
        Self { is_diagonal: true, ..Self::full(diagonal) }
    }

    /// The diagonal, if nothing else is stored.
    pub fn as_diagonal(&self) -> Option<&[f64]> {
        self.is_diagonal.then_some(&self.values)
    }

    /// Entry on the diagonal of this matrix of `order`.
    pub fn diagonal(&self, order: usize, place: usize) -> f64 {
        self.values[if self.is_diagonal { place } else { place * (order + 1) }]
    }

    /// All entries of this matrix of `order`, row by row.
    pub fn filled(&self, order: usize) -> Vec<f64> {
        let Some(diagonal) = self.as_diagonal() else { return self.values.clone() };
        let mut all = vec![0.0; order * order];
        all.iter_mut()
            .step_by(order + 1)
            .zip(diagonal)
            .for_each(|(entry, own)| *entry = *own);
        all
    }

    /// Matrix of three components of elements on a lattice, component by component.
    ///
    /// `areas`: of the elements; `cells`: their columns and rows. Products use transforms only if blocks divided by
    /// the area of their source depend on the offset alone.
    pub fn on_lattice(values: Vec<f64>, cells: &[[usize; 2]], areas: &[f64]) -> Self {
        let count = areas.len();
        let mut matrix = Self::new(values, 3 * count);
        if count >= MIN_LATTICE_ELEMENTS {
            matrix.lattice = LatticeProduct::new(cells, areas, |receiver, source| {
                [0, 1, 2].map(|r| {
                    let row = &matrix.values[(r * count + receiver) * 3 * count..];
                    [0, 1, 2].map(|c| row[c * count + source] / areas[source])
                })
            });
        }
        matrix
    }

    /// Cells of many elements whose blocks depend on the offset alone.
    pub fn cells(&self) -> Option<&[[usize; 2]]> {
        self.lattice.as_ref().map(LatticeProduct::cells)
    }

    /// Scratch for [`CompressedMatrix::multiply_add_with`].
    pub fn scratch(&self) -> LatticeScratch {
        self.lattice.as_ref().map(LatticeProduct::scratch).unwrap_or_default()
    }

    /// Number of values that a product reads.
    pub fn stored(&self) -> usize {
        self.entries.as_ref().map_or(self.values.len(), SparseMatrix::stored)
    }

    /// y ← y + A x.
    pub fn multiply_add(&self, x: &[f64], y: &mut [f64]) {
        if let Some(diagonal) = self.as_diagonal() {
            y.iter_mut().zip(diagonal).zip(x).for_each(|((y, own), x)| *y += own * x);
            return;
        }
        match &self.entries {
            Some(entries) => entries.multiply_add(1.0, x, y),
            None => dense_multiply_add(&self.values, 1.0, x, y),
        }
    }

    /// y ← y + A x, by transforms along the surface where that is faster.
    pub fn multiply_add_with(&self, scratch: &mut LatticeScratch, x: &[f64], y: &mut [f64]) {
        match &self.lattice {
            Some(lattice) if self.entries.is_none() => {
                let count = x.len() / 3;
                lattice.multiply(x, scratch, |k, e, value| y[k * count + e] += value);
            }
            _ => self.multiply_add(x, y),
        }
    }
}

impl Deref for CompressedMatrix {
    type Target = [f64];

    fn deref(&self) -> &[f64] {
        &self.values
    }
}
