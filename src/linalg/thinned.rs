//! A square matrix whose products leave out what they can.

use std::ops::Deref;

use super::{LatticeProduct, LatticeScratch, SparseMatrix, Triplets, dense_multiply_add};

/// Smallest number of elements on a lattice for which products transform along the surface.
const LATTICE_FROM: usize = 36;

/// A square matrix: all entries, row by row, or a diagonal.
///
/// If most entries are zero, the others are stored as sparse. Three components of many elements on a lattice are
/// multiplied by transforms along the surface. As a slice it is all entries, of a diagonal matrix the diagonal.
#[derive(Debug)]
pub(crate) struct Thinned {
    values: Vec<f64>,
    is_diagonal: bool,
    entries: Option<SparseMatrix>,
    lattice: Option<LatticeProduct>,
}

impl Thinned {
    pub(crate) fn new(values: Vec<f64>, order: usize) -> Self {
        let filled = values.iter().filter(|value| **value != 0.0).count();
        // A product with a sparse entry costs about as much as with four dense ones.
        let entries = (filled <= values.len() / 8)
            .then(|| {
                let mut entries = Triplets::new(order);
                for (place, &value) in values.iter().enumerate().filter(|(_, v)| **v != 0.0) {
                    entries.add(place / order, place % order, value);
                }
                SparseMatrix::new("instantaneous operator of the ground", &entries).ok()
            })
            .flatten();
        Self { entries, ..Self::full(values) }
    }

    /// Matrix of these entries, all of which are multiplied.
    pub(crate) fn full(values: Vec<f64>) -> Self {
        Self { values, is_diagonal: false, entries: None, lattice: None }
    }

    /// Diagonal matrix, of which only the diagonal is stored.
    pub(crate) fn of_diagonal(diagonal: Vec<f64>) -> Self {
        Self { is_diagonal: true, ..Self::full(diagonal) }
    }

    /// The diagonal, if nothing else is stored.
    pub(crate) fn as_diagonal(&self) -> Option<&[f64]> {
        self.is_diagonal.then_some(&self.values)
    }

    /// Entry on the diagonal of this matrix of `order`.
    pub(crate) fn diagonal(&self, order: usize, place: usize) -> f64 {
        self.values[if self.is_diagonal { place } else { place * (order + 1) }]
    }

    /// All entries of this matrix of `order`, row by row.
    pub(crate) fn filled(&self, order: usize) -> Vec<f64> {
        let Some(diagonal) = self.as_diagonal() else { return self.values.clone() };
        let mut all = vec![0.0; order * order];
        all.iter_mut().step_by(order + 1).zip(diagonal).for_each(|(entry, own)| *entry = *own);
        all
    }

    /// Matrix of three components of elements with these `areas` on `cells` of a lattice, component by component.
    ///
    /// Products are as in [`Thinned::new`] unless blocks over the area of their source depend on the offset alone.
    pub(crate) fn on_lattice(values: Vec<f64>, cells: &[[usize; 2]], areas: &[f64]) -> Self {
        let count = areas.len();
        let mut all = Self::new(values, 3 * count);
        if count >= LATTICE_FROM {
            let entry = |row: usize, column: usize| all.values[row * 3 * count + column];
            all.lattice = LatticeProduct::new(cells, areas, |receiver, source| {
                [0, 1, 2].map(|r| {
                    [0, 1, 2]
                        .map(|c| entry(r * count + receiver, c * count + source) / areas[source])
                })
            });
        }
        all
    }

    /// Cells of many elements whose blocks depend on the offset alone.
    pub(crate) fn cells(&self) -> Option<&[[usize; 2]]> {
        self.lattice.as_ref().map(LatticeProduct::cells)
    }

    /// Scratch for [`Thinned::multiply_add_with`].
    pub(crate) fn scratch(&self) -> LatticeScratch {
        self.lattice.as_ref().map(LatticeProduct::scratch).unwrap_or_default()
    }

    /// Number of values that a product reads.
    pub(crate) fn stored(&self) -> usize {
        self.entries.as_ref().map_or(self.values.len(), SparseMatrix::stored)
    }

    /// y ← y + A x.
    pub(crate) fn multiply_add(&self, x: &[f64], y: &mut [f64]) {
        if let Some(diagonal) = self.as_diagonal() {
            y.iter_mut().zip(diagonal).zip(x).for_each(|((y, own), x)| *y += own * x);
            return;
        }
        match &self.entries {
            Some(entries) => entries.multiply_add(1.0, x, y),
            None => dense_multiply_add(&self.values, 1.0, x, y),
        }
    }

    /// y ← y + A x, by transforms along the surface where that is quicker.
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

impl Deref for Thinned {
    type Target = [f64];

    fn deref(&self) -> &[f64] {
        &self.values
    }
}
