//! A dense matrix with products by sparse entries or by FFT where that is cheaper.

use std::ops::Deref;

use super::{LatticeProduct, LatticeScratch, SparseMatrix, Triplets, dense_multiply_add};

/// Smallest number of elements on a lattice for which products transform along the surface.
const MIN_LATTICE_ELEMENTS: usize = 36;

/// A dense square matrix, row-major.
///
/// If most entries are zero, products use a sparse copy of the others. For three components of many elements on a
/// lattice, products use Fourier transforms along the surface.
#[derive(Debug)]
pub(crate) struct CompressedMatrix {
    values: Vec<f64>,
    entries: Option<SparseMatrix>,
    lattice: Option<LatticeProduct>,
}

impl CompressedMatrix {
    pub(crate) fn new(values: Vec<f64>, order: usize) -> Self {
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
        Self { values, entries, lattice: None }
    }

    /// Matrix of three components of elements on a lattice, component by component.
    ///
    /// `areas`: of the elements; `cells`: their columns and rows. Products use transforms only if blocks divided by
    /// the area of their source depend on the offset alone.
    pub(crate) fn on_lattice(values: Vec<f64>, cells: &[[usize; 2]], areas: &[f64]) -> Self {
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
    pub(crate) fn cells(&self) -> Option<&[[usize; 2]]> {
        self.lattice.as_ref().map(LatticeProduct::cells)
    }

    /// Scratch for [`CompressedMatrix::multiply_add_with`].
    pub(crate) fn scratch(&self) -> LatticeScratch {
        self.lattice.as_ref().map(LatticeProduct::scratch).unwrap_or_default()
    }

    /// Number of values that a product reads.
    pub(crate) fn stored(&self) -> usize {
        self.entries.as_ref().map_or(self.values.len(), SparseMatrix::stored)
    }

    /// y ← y + A x.
    pub(crate) fn multiply_add(&self, x: &[f64], y: &mut [f64]) {
        match &self.entries {
            Some(entries) => entries.multiply_add(1.0, x, y),
            None => dense_multiply_add(&self.values, 1.0, x, y),
        }
    }

    /// y ← y + A x, by transforms along the surface where that is faster.
    pub(crate) fn multiply_add_with(&self, scratch: &mut LatticeScratch, x: &[f64], y: &mut [f64]) {
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
