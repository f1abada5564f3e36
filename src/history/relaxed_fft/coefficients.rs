//! Coefficients of short lags, and their direct sums for all pairs of elements.

#![allow(clippy::inline_always, reason = "to be compiled for the instructions of their caller")]

use std::sync::Arc;

use super::ring::LEAF_STEPS;
use crate::error::Result;
use crate::geometry::COMPONENTS_IN_PLANE;
use crate::history::convolution_weights::ConvolutionWeights;
use crate::history::pair_classes::{MAX_PLANE_KINDS, Pair, PairClasses};
use crate::linalg::{Simd, WithSimd, add_row, add_rows};

/// Coefficients d = 0 … of one class, kind by kind; empty for kinds that the ground does not have.
///
/// The index d counts the steps after the step of the traction. It is the lag d + 1 of the convolution weights.
pub(super) type ClassCoefficients = [Vec<f64>; MAX_PLANE_KINDS];

/// Coefficients that are summed directly: kind by kind and class by class, d = 0 … leaf − 1.
///
/// The coefficient of d = 0 is zero. The coupling is stored as long as it is not zero.
pub(crate) type ShortLagTables = [Vec<Vec<f64>>; MAX_PLANE_KINDS];

/// Pairs of a patch, with their coefficients of short lags.
pub(super) struct Coefficients {
    pub(super) classes: PairClasses,
    /// Last d at which the coupling of each class is not zero; `usize::MAX` if it never ends.
    class_reaches: Vec<usize>,
    /// Last d at which the coupling of any class is not zero.
    pub(super) coupling_reach: usize,
    /// Whether blocks have to include the coupling.
    pub(super) blocks_have_coupling: bool,
    /// Last d at which the coupling is summed directly.
    pub(super) direct_coupling_reach: usize,
    /// Tables of short lags, empty until they are needed.
    pub(super) short_lags: Arc<ShortLagTables>,
}

impl Coefficients {
    /// Coefficients of `kernel`, without tables.
    ///
    /// A coupling that ends at d = `max_direct` or before is summed directly.
    pub(super) fn new(kernel: &dyn ConvolutionWeights, max_direct: usize) -> Result<Self> {
        let classes = kernel.classes().clone();
        let mut class_reaches = Vec::with_capacity(classes.count());
        for class in 0..classes.count() {
            let last_lag = kernel.last_coupling_lag(class)?;
            class_reaches.push(last_lag.map_or(usize::MAX, |lag| lag.saturating_sub(1)));
        }
        let coupling_reach = class_reaches.iter().copied().max().unwrap_or(0);
        let blocks_have_coupling = coupling_reach > max_direct;
        let direct_coupling_reach =
            if blocks_have_coupling { LEAF_STEPS - 1 } else { coupling_reach };
        Ok(Self {
            classes,
            class_reaches,
            coupling_reach,
            blocks_have_coupling,
            direct_coupling_reach,
            short_lags: Arc::default(),
        })
    }

    /// Number of values of d in the tables.
    pub(super) fn length(&self) -> usize {
        LEAF_STEPS.max(self.direct_coupling_reach + 1)
    }

    /// Adds the next class to `tables`; `values` may be longer than [`Coefficients::length`].
    pub(super) fn add_class(&self, values: &ClassCoefficients, tables: &mut ShortLagTables) {
        let reach = self.class_reaches[tables[0].len()].min(self.direct_coupling_reach);
        for (kind, (table, values)) in tables.iter_mut().zip(values).enumerate() {
            let end = if kind < COMPONENTS_IN_PLANE { LEAF_STEPS } else { reach + 1 };
            table.push(values[..end.min(values.len())].to_vec());
        }
    }
}

/// Adds the effect of the input in `column` to the outputs after it.
///
/// The diagonal components act on the remaining `output_count` outputs of the leaf, the coupling on
/// `coupled_output_count` outputs.
pub(super) struct Scatter<'a> {
    pub(super) coefficients: &'a Coefficients,
    pub(super) rows: &'a mut [f64],
    pub(super) stride: usize,
    pub(super) column: usize,
    pub(super) output_count: usize,
    pub(super) coupled_output_count: usize,
}

impl WithSimd for Scatter<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        let Self { coefficients, rows, stride, column, output_count, coupled_output_count } = self;
        let Coefficients { classes, short_lags, .. } = coefficients;
        let element_count = classes.elements().len();
        let [normal, tangential, couplings, second_couplings] = &**short_lags;
        let has_two_couplings = classes.has_two_couplings();
        for (p, pairs) in classes.pairs().chunks_exact(element_count).enumerate() {
            let scale = pairs[p].scale;
            for (first_row, table) in [(0, normal), (element_count, tangential)] {
                let row = first_row + p;
                let mut q = 0;
                let mut groups = pairs.chunks_exact(4);
                for group in groups.by_ref() {
                    let values: [f64; 4] = std::array::from_fn(|k| {
                        scale * rows[(first_row + q + k) * stride + column]
                    });
                    let lags: [&[f64]; 4] =
                        std::array::from_fn(|k| &table[group[k].class][1..=output_count]);
                    let output = &mut rows[row * stride + column + 1..][..output_count];
                    add_rows(simd, values, lags, output);
                    q += 4;
                }
                for pair in groups.remainder() {
                    let value = scale * rows[(first_row + q) * stride + column];
                    let output = &mut rows[row * stride + column + 1..][..output_count];
                    add_row(simd, value, &table[pair.class][1..=output_count], output);
                    q += 1;
                }
            }
            for (q, &Pair { class, sign, .. }) in pairs.iter().enumerate() {
                let coupling = &couplings[class];
                let reach = coupled_output_count.min(coupling.len() - 1);
                if sign == 0.0 || reach == 0 {
                    continue;
                }
                // Of the normal displacement due to shear, and of the tangential displacement due to pressure.
                let mut shear_lags = &coupling[1..=reach];
                let mut pressure_lags = shear_lags;
                let mut pressure_sign = -sign;
                if has_two_couplings {
                    pressure_lags = &second_couplings[class][1..=reach];
                    pressure_sign = sign;
                    if classes.is_exchanged(p * element_count + q) {
                        std::mem::swap(&mut shear_lags, &mut pressure_lags);
                    }
                }
                for (row, source, sign, lags) in [
                    (p, element_count + q, sign, shear_lags),
                    (element_count + p, q, pressure_sign, pressure_lags),
                ] {
                    let value = sign * scale * rows[source * stride + column];
                    let output = &mut rows[row * stride + column + 1..][..reach];
                    add_row(simd, value, lags, output);
                }
            }
        }
    }
}
