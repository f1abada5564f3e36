//! The Delassus operator W, in the form whose product takes the least time.

use std::ops::Deref;
use std::sync::Arc;

use super::on_bed::OnBed;
use crate::linalg::{
    CompressedMatrix, dense_condition, dense_multiply_add, transposed_multiply_add,
};

/// Largest rank of the structure's part for separate products.
///
/// The amplitudes of a product have this fixed size.
pub(crate) const MAX_STRUCTURE_RANK: usize = 64;
/// Factor by which separate products must reduce the entries that are read.
const MIN_ENTRY_REDUCTION: usize = 4;

/// W: the sum of the soil's step compliance G¹ and the compliance of the structure's base.
///
/// As a slice it has all entries, row by row. It is empty on a bed of many springs, where no entries are stored.
#[derive(Debug, Clone)]
pub(crate) struct Delassus {
    values: Vec<f64>,
    /// G¹, if it is available apart from the structure's part.
    soil: Option<Arc<CompressedMatrix>>,
    structure: Option<StructureFactors>,
    on_bed: Option<OnBed>,
}

/// Factors of the structure's part in W = G¹ + B C.
///
/// They are stored for a sparse G¹ and few degrees of freedom.
#[derive(Debug, Clone)]
struct StructureFactors {
    /// B, row by row: displacements of the contact components.
    means: Vec<f64>,
    /// C, column by column.
    columns: Vec<f64>,
}

impl From<Vec<f64>> for Delassus {
    fn from(values: Vec<f64>) -> Self {
        Self { values, soil: None, structure: None, on_bed: None }
    }
}

impl From<OnBed> for Delassus {
    fn from(on_bed: OnBed) -> Self {
        Self { on_bed: Some(on_bed), ..Self::from(vec![]) }
    }
}

impl Deref for Delassus {
    type Target = [f64];

    fn deref(&self) -> &[f64] {
        &self.values
    }
}

impl Delassus {
    /// This operator with its parts `soil` and B C, for products in less time.
    ///
    /// `columns`: C, column by column. `means`: overwrites its second argument with the product of B and its first.
    pub(crate) fn with_parts(
        self,
        soil: &Arc<CompressedMatrix>,
        columns: &[f64],
        means: impl Fn(&[f64], &mut [f64]),
    ) -> Self {
        if self.on_bed.is_some() {
            return self;
        }
        let values = self.values;
        let size = values.len().isqrt();
        let rank = columns.len() / size.max(1);
        let operator = Self { soil: Some(Arc::clone(soil)), ..Self::from(values) };
        // Separate products read the soil's entries and both factors. They must save most of the entries of W.
        let separate_count = soil.entry_count() + 2 * columns.len();
        if rank > MAX_STRUCTURE_RANK || separate_count > operator.len() / MIN_ENTRY_REDUCTION {
            return operator;
        }
        let mut rows = vec![0.0; columns.len()];
        let mut unit = vec![0.0; rank];
        let mut column = vec![0.0; size];
        for j in 0..rank {
            unit[j] = 1.0;
            means(&unit, &mut column);
            unit[j] = 0.0;
            rows.chunks_exact_mut(rank).zip(&column).for_each(|(row, mean)| row[j] = *mean);
        }
        let structure = StructureFactors { means: rows, columns: columns.to_vec() };
        Self { structure: Some(structure), ..operator }
    }

    /// Computes the operator again for other columns C, without allocating.
    ///
    /// `add_structure` adds B C to the entries of `soil`. If the number of `columns` has changed, products use all
    /// entries.
    pub(crate) fn refill(
        &mut self,
        soil: &CompressedMatrix,
        columns: &[f64],
        add_structure: impl FnOnce(&mut [f64]),
    ) {
        let order = self.values.len().isqrt();
        soil.fill(order, &mut self.values);
        add_structure(&mut self.values);
        match &mut self.structure {
            Some(structure) if structure.columns.len() == columns.len() => {
                structure.columns.copy_from_slice(columns);
            }
            structure => *structure = None,
        }
    }

    /// The operator on a bed of many springs, to be computed again.
    pub(crate) fn on_bed_mut(&mut self) -> Option<&mut OnBed> {
        self.on_bed.as_mut()
    }

    /// Replaces all entries, without allocating.
    pub(crate) fn set(&mut self, values: &[f64]) {
        self.values.copy_from_slice(values);
        self.structure = None;
    }

    /// The soil's step compliance G¹, if it is available apart from the structure's part.
    pub(crate) fn soil(&self) -> Option<&CompressedMatrix> {
        self.soil.as_deref()
    }

    /// W on a bed of many springs, where no entries are stored.
    pub(crate) fn on_bed(&self) -> Option<&OnBed> {
        self.on_bed.as_ref()
    }

    /// Entry `i` on the diagonal of W, a matrix of this order.
    pub(crate) fn diagonal(&self, order: usize, i: usize) -> f64 {
        match &self.on_bed {
            Some(on_bed) => on_bed.diagonal(i),
            None => self.values[i * (order + 1)],
        }
    }

    /// Condition number of W, a matrix of this order, scaled by its diagonal.
    pub(crate) fn condition(&self, order: usize) -> f64 {
        match &self.on_bed {
            Some(on_bed) => on_bed.condition(),
            None => dense_condition(&self.values, order),
        }
    }

    /// jump ← jump + W τ.
    pub(crate) fn multiply_add(&self, traction: &[f64], jump: &mut [f64]) {
        if let Some(on_bed) = &self.on_bed {
            return on_bed.multiply_add(traction, jump);
        }
        let (Some(soil), Some(StructureFactors { means, columns })) = (&self.soil, &self.structure)
        else {
            return dense_multiply_add(&self.values, 1.0, traction, jump);
        };
        let mut amplitudes = [0.0; MAX_STRUCTURE_RANK];
        let amplitudes = &mut amplitudes[..columns.len() / traction.len().max(1)];
        soil.multiply_add(traction, jump);
        transposed_multiply_add(columns, 1.0, traction, amplitudes);
        dense_multiply_add(means, 1.0, amplitudes, jump);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn separate_products_agree_with_all_entries() {
        let size = 40;
        let rank = 3;
        let mut soil = vec![0.0; size * size];
        for i in 0..size {
            for j in i.saturating_sub(1)..(i + 2).min(size) {
                soil[i * size + j] = (1 + i + 2 * j) as f64;
            }
        }
        let means: Vec<f64> = (0..size * rank).map(|k| (k as f64).sin()).collect();
        let columns: Vec<f64> = (0..size * rank).map(|k| (2.0 * k as f64).cos()).collect();
        let mut values = soil.clone();
        for i in 0..size {
            for j in 0..size {
                values[i * size + j] +=
                    (0..rank).map(|k| means[i * rank + k] * columns[j * rank + k]).sum::<f64>();
            }
        }
        let entries = Delassus::from(values.clone());
        let soil = Arc::new(CompressedMatrix::new(soil, size));
        let parts = Delassus::from(values).with_parts(&soil, &columns, |x, product| {
            product.fill(0.0);
            dense_multiply_add(&means, 1.0, x, product);
        });
        assert!(parts.structure.is_some());
        let traction: Vec<f64> = (0..size).map(|k| (3.0 * k as f64).sin()).collect();
        let mut expected = vec![1.0; size];
        let mut computed = expected.clone();
        entries.multiply_add(&traction, &mut expected);
        parts.multiply_add(&traction, &mut computed);
        for (expected, computed) in expected.iter().zip(&computed) {
            let tolerance = 1e-12 * expected.abs().max(1.0);
            assert!((expected - computed).abs() < tolerance, "{expected} {computed}");
        }
    }
}
