//! W as a diagonal and a low-rank product, under a structure that moves the elements in few modes.
//!
//! A mode is a column of L, a Cholesky factor of the structure's compliance; it is no mode of vibration.
//!
//! | symbol | meaning |
//! |---|---|
//! | W = D + L Lᵀ | compliance of elements on independent springs, under a structure with few modes, m/N |
//! | D | compliance of the soil and of the elastic layers of the contact laws, a diagonal, m/N |
//! | L Lᵀ | compliance of the structure, m/N; one column of L for each mode |
//! | r − r₀ | change of the elements' forces from their static values, N |
//! | q, y | relative displacements of the elements for r = r₀ and for the current r, m |

use crate::contact::OnBed;
use crate::contact::on_bed::MODE_TOLERANCE;
use crate::linalg::pivoted_cholesky;

/// Largest number of modes of a structure on a lattice of elements.
///
/// A rigid body in space has six: these are the modes of four bodies. With more modes, the solution uses all entries
/// of W.
pub(super) const MAX_COMPLIANCE_MODES: usize = 24;

/// W = D + L Lᵀ, and the modal amplitudes of the current forces.
#[derive(Default)]
pub(super) struct LowRankCompliance {
    /// D of each element.
    diagonal: Vec<[f64; 3]>,
    /// L of each element, mode by mode.
    modes: Vec<[f64; 3]>,
    mode_count: usize,
    /// Lᵀ (r − r₀).
    amplitudes: Vec<f64>,
}

impl LowRankCompliance {
    /// Allocates D of `element_count` elements.
    pub(super) fn new(element_count: usize) -> Self {
        Self { diagonal: vec![[0.0; 3]; element_count], ..Self::default() }
    }

    /// Computes D and L of elements with these areas.
    ///
    /// `layer(row)`: compliance of the elastic layer of an element's contact law, m/N.
    pub(super) fn assemble(&mut self, on_bed: &OnBed, areas: &[f64], layer: impl Fn(usize) -> f64) {
        let element_count = areas.len();
        self.mode_count = on_bed.mode_count();
        self.amplitudes.clear();
        self.amplitudes.resize(self.mode_count, 0.0);
        self.modes.clear();
        for (e, diagonal) in self.diagonal.iter_mut().enumerate() {
            let indices = [e, element_count + e, 2 * element_count + e];
            *diagonal = indices.map(|i| on_bed.soil(i) / areas[e] + layer(i));
            let modes = indices.map(|i| on_bed.modes(i));
            self.modes.extend((0..self.mode_count).map(|k| modes.map(|mode| mode[k])));
        }
    }

    /// D of an element.
    #[inline]
    pub(super) fn diagonal(&self, e: usize) -> [f64; 3] {
        self.diagonal[e]
    }

    /// L of an element, mode by mode.
    #[inline]
    pub(super) fn modes(&self, e: usize) -> &[[f64; 3]] {
        &self.modes[e * self.mode_count..][..self.mode_count]
    }

    /// Number of modes.
    pub(super) fn mode_count(&self) -> usize {
        self.mode_count
    }

    /// Block of W between the components of an element.
    pub(super) fn block(&self, e: usize) -> [[f64; 3]; 3] {
        let mut block = [[0.0; 3]; 3];
        for mode in self.modes(e) {
            for (row, entry) in block.iter_mut().zip(mode) {
                row.iter_mut().zip(mode).for_each(|(sum, other)| *sum += entry * other);
            }
        }
        (0..3).for_each(|k| block[k][k] += self.diagonal[e][k]);
        block
    }

    /// Sets the amplitudes to Lᵀ (r − r₀), and `y` to q + (W + `added_diagonal`) (r − r₀).
    ///
    /// `force_change`: r − r₀.
    pub(super) fn update_displacements(
        &mut self,
        force_change: &[f64],
        q: &[f64],
        added_diagonal: f64,
        y: &mut [f64],
    ) {
        let element_count = self.diagonal.len();
        self.amplitudes.fill(0.0);
        for e in 0..element_count {
            let indices = [e, element_count + e, 2 * element_count + e];
            self.add_force(e, indices.map(|i| force_change[i]));
        }
        for e in 0..element_count {
            let indices = [e, element_count + e, 2 * element_count + e];
            let displacement = self.displacement(e, indices.map(|i| force_change[i]));
            for (i, displacement) in indices.into_iter().zip(displacement) {
                y[i] = q[i] + added_diagonal * force_change[i] + displacement;
            }
        }
    }

    /// Displacement W (r − r₀) of an element, from the current amplitudes.
    ///
    /// `force_change`: r − r₀ of this element.
    #[inline]
    pub(super) fn displacement(&self, e: usize, force_change: [f64; 3]) -> [f64; 3] {
        let mut displacement = self.modal_displacement(e, &self.amplitudes);
        (0..3).for_each(|k| displacement[k] += self.diagonal[e][k] * force_change[k]);
        displacement
    }

    /// Displacement L a of an element due to modal amplitudes a.
    #[inline]
    pub(super) fn modal_displacement(&self, e: usize, amplitudes: &[f64]) -> [f64; 3] {
        let mut displacement = [0.0; 3];
        for (amplitude, mode) in amplitudes.iter().zip(self.modes(e)) {
            (0..3).for_each(|k| displacement[k] += amplitude * mode[k]);
        }
        displacement
    }

    /// Adds the modal amplitudes due to an additional `force` on one element.
    #[inline]
    pub(super) fn add_force(&mut self, e: usize, force: [f64; 3]) {
        let modes = &self.modes[e * self.mode_count..][..self.mode_count];
        for (amplitude, mode) in self.amplitudes.iter_mut().zip(modes) {
            *amplitude += mode[0] * force[0] + mode[1] * force[1] + mode[2] * force[2];
        }
    }
}

/// Modes of the structure: columns of the pivoted Cholesky factor L of W − G.
///
/// G is `soil(row, column)`, with `layer(row)` added to its diagonal: the compliance of the soil and of the elastic layers
/// of the contact laws. `None` if W − G has too many modes or is not positive semi-definite.
pub(super) fn compliance_modes(
    w: &[f64],
    order: usize,
    soil: impl Fn(usize, usize) -> f64,
    layer: impl Fn(usize) -> f64,
) -> Option<Vec<Vec<f64>>> {
    let soil_entry = |row: usize, column: usize| {
        soil(row, column) + if row == column { layer(row) } else { 0.0 }
    };
    let diagonal: Vec<f64> = (0..order).map(|i| w[i * (order + 1)]).collect();
    let structure_diagonal =
        diagonal.iter().enumerate().map(|(i, entry)| entry - soil_entry(i, i)).collect();
    let tolerance = diagonal.iter().map(|entry| MODE_TOLERANCE * entry).fold(0.0, f64::max);
    pivoted_cholesky(structure_diagonal, tolerance, MAX_COMPLIANCE_MODES, |pivot, column| {
        for (i, value) in column.iter_mut().enumerate() {
            *value = w[i * order + pivot] - soil_entry(i, pivot);
        }
    })
}
