//! The Delassus operator, with its product computed in the quickest way.

use std::ops::Deref;
use std::sync::Arc;

use super::on_bed::OnBed;
use crate::linalg::{
    CompressedMatrix, dense_condition, dense_multiply_add, transposed_multiply_add,
};

/// Largest rank of the structure's part for which it is multiplied separately from the soil's part.
pub(crate) const MAX_STRUCTURE_RANK: usize = 64;

/// W: the sum of the soil's step compliance G¹ and the compliance of the structure's base.
///
/// As a slice it is all entries, row by row; it is empty on a bed of many springs, whose entries are not stored.
#[derive(Debug, Clone)]
pub(crate) struct Delassus {
    values: Vec<f64>,
    /// G¹, if the values are its sum with another part.
    soil: Option<Arc<CompressedMatrix>>,
    split: Option<Split>,
    on_bed: Option<OnBed>,
}

/// W = G¹ + B C for a mostly zero G¹ and a structure with few degrees of freedom.
#[derive(Debug, Clone)]
struct Split {
    /// B, row-major with one row per contact component; C, column by column.
    means: Vec<f64>,
    columns: Vec<f64>,
}

impl From<Vec<f64>> for Delassus {
    fn from(values: Vec<f64>) -> Self {
        Self { values, soil: None, split: None, on_bed: None }
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
    /// This operator, whose values are `soil` + B C, for quick products.
    ///
    /// `columns` holds C column by column; `means` multiplies a vector by B.
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
        let whole = Self { soil: Some(Arc::clone(soil)), ..Self::from(values) };
        // The split needs two thin products and the soil's; it is used only if it reads far fewer values than
        // W has.
        if rank > MAX_STRUCTURE_RANK || soil.entry_count() + 2 * columns.len() > whole.len() / 4 {
            return whole;
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
        let split = Split { means: rows, columns: columns.to_vec() };
        Self { split: Some(split), ..whole }
    }

    /// Computes the operator again for other columns C, without allocating.
    ///
    /// `add_structure` adds B C to the values, which have `soil`. Without `columns`, products use the values.
    pub(crate) fn refill(
        &mut self,
        soil: &CompressedMatrix,
        columns: &[f64],
        add_structure: impl FnOnce(&mut [f64]),
    ) {
        let order = self.values.len().isqrt();
        soil.fill(order, &mut self.values);
        add_structure(&mut self.values);
        match &mut self.split {
            Some(split) if split.columns.len() == columns.len() => {
                split.columns.copy_from_slice(columns);
            }
            split => *split = None,
        }
    }

    /// Replaces the values by as many others, without allocating.
    pub(crate) fn set(&mut self, values: &[f64]) {
        self.values.copy_from_slice(values);
        self.split = None;
    }

    /// The soil's step compliance G¹; `None` if it is not known.
    pub(crate) fn soil(&self) -> Option<&CompressedMatrix> {
        self.soil.as_deref()
    }

    /// W on a bed of many springs, whose entries are not stored.
    pub(crate) fn on_bed(&self) -> Option<&OnBed> {
        self.on_bed.as_ref()
    }

    /// Entry on the diagonal of W of this order.
    pub(crate) fn diagonal(&self, order: usize, place: usize) -> f64 {
        match &self.on_bed {
            Some(on_bed) => on_bed.diagonal(place),
            None => self.values[place * (order + 1)],
        }
    }

    /// Condition of W of this order, scaled by its diagonal.
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
        let (Some(soil), Some(Split { means, columns })) = (&self.soil, &self.split) else {
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
    fn both_ways_are_one_product() {
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
        let whole = Delassus::from(values.clone());
        let soil = Arc::new(CompressedMatrix::new(soil, size));
        let split = Delassus::from(values).with_parts(&soil, &columns, |x, out| {
            out.fill(0.0);
            dense_multiply_add(&means, 1.0, x, out);
        });
        assert!(split.split.is_some());
        let traction: Vec<f64> = (0..size).map(|k| (3.0 * k as f64).sin()).collect();
        let mut a = vec![1.0; size];
        let mut b = a.clone();
        whole.multiply_add(&traction, &mut a);
        split.multiply_add(&traction, &mut b);
        for (a, b) in a.iter().zip(&b) {
            assert!((a - b).abs() < 1e-12 * a.abs().max(1.0), "{a} {b}");
        }
    }
}
