//! W of elements on a lattice, for products by Fourier transforms.
//!
//! | symbol | meaning |
//! |---|---|
//! | W = G + D + L Lᵀ | compliance of the contact elements, m/N |
//! | G | compliance of the soil |
//! | D | compliance of the elements' elastic layers, a diagonal |
//! | L | displacements of the elements in the structure's few modes |
//! | r − r₀ | change of the elements' forces from their static values, N |
//! | q, y | relative displacements of the elements for r = r₀ and for the current r, m |
//!
//! The form suits elements that all move each other much; for others see [`near_field`](super::near_field).

use super::low_rank::{MAX_COMPLIANCE_MODES, compliance_modes};
use crate::linalg::{LatticeProduct, LatticeScratch, dense_multiply_add, transposed_multiply_add};

/// W = G + D + L Lᵀ.
pub(super) struct LatticeCompliance {
    /// G.
    soil: LatticeProduct,
    scratch: LatticeScratch,
    /// D.
    layers: Vec<f64>,
    /// L, mode by mode.
    modes: Vec<f64>,
    mode_count: usize,
}

impl LatticeCompliance {
    /// Splits the row-major `w`.
    ///
    /// `cells`: column and row of each element on the lattice. `soil(row, column)`: entry of G. `layer(row)`: entry of D.
    /// `None` if soil blocks of equal offset differ, G is not symmetric, or the structure has too many modes or a
    /// compliance that is not positive semi-definite.
    pub(super) fn new(
        w: &[f64],
        cells: &[[usize; 2]],
        soil: impl Fn(usize, usize) -> f64,
        layer: impl Fn(usize) -> f64,
    ) -> Option<Self> {
        let count = cells.len();
        let modes = compliance_modes(w, 3 * count, &soil, &layer)?;
        let product = LatticeProduct::new(cells, &vec![1.0; count], |receiver, source| {
            [0, 1, 2].map(|r| [0, 1, 2].map(|c| soil(r * count + receiver, c * count + source)))
        })?;
        Some(Self {
            scratch: product.scratch(),
            soil: product,
            layers: (0..3 * count).map(layer).collect(),
            mode_count: modes.len(),
            modes: modes.concat(),
        })
    }

    /// Sets `y` to q + (W + `added_diagonal`) (r − r₀).
    ///
    /// `force_change`: r − r₀.
    pub(super) fn update_displacements(
        &mut self,
        force_change: &[f64],
        q: &[f64],
        added_diagonal: f64,
        y: &mut [f64],
    ) {
        let Self { soil, scratch, layers, modes, mode_count } = self;
        for (i, y) in y.iter_mut().enumerate() {
            *y = q[i] + (layers[i] + added_diagonal) * force_change[i];
        }
        let mut amplitudes = [0.0; MAX_COMPLIANCE_MODES];
        let amplitudes = &mut amplitudes[..*mode_count];
        dense_multiply_add(modes, 1.0, force_change, amplitudes);
        transposed_multiply_add(modes, 1.0, amplitudes, y);
        let count = soil.cells().len();
        soil.multiply(force_change, scratch, |component, e, displacement| {
            y[component * count + e] += displacement;
        });
    }
}
