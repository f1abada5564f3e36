//! W by the few modes in which the structure moves the elements.
//!
//! | symbol | meaning |
//! |---|---|
//! | W = D + L Lᵀ | elements on independent springs, under a structure with few modes |
//! | D | compliance of the soil and of the element's layer, a diagonal, m/N |
//! | L | displacements of the elements in the modes of the structure |
//! | r | forces on the elements, N |

use crate::contact::OnBed;
use crate::contact::on_bed::MODE_TOLERANCE;
use crate::linalg::pivoted_cholesky;

/// Largest number of modes of a structure on a lattice of elements.
///
/// Structures with more modes are solved by all entries of W.
pub(super) const MAX_MODE_COUNT: usize = 24;

/// W = D + L Lᵀ, and the modal amplitudes of the present forces.
#[derive(Default)]
pub(super) struct LowRankCompliance {
    /// D of each element.
    diagonal: Vec<[f64; 3]>,
    /// L of each element, mode by mode.
    modes: Vec<[f64; 3]>,
    mode_count: usize,
    /// Lᵀ r.
    amplitudes: Vec<f64>,
}

impl LowRankCompliance {
    /// Allocates D of `element_count` elements.
    pub(super) fn new(element_count: usize) -> Self {
        Self { diagonal: vec![[0.0; 3]; element_count], ..Self::default() }
    }

    /// Computes D and L of elements with these areas.
    ///
    /// `layer(row)`: part of the diagonal that is neither soil nor structure.
    pub(super) fn set(&mut self, on_bed: &OnBed, areas: &[f64], layer: impl Fn(usize) -> f64) {
        let count = areas.len();
        self.mode_count = on_bed.mode_count();
        self.amplitudes.clear();
        self.amplitudes.resize(self.mode_count, 0.0);
        self.modes.clear();
        for (e, diagonal) in self.diagonal.iter_mut().enumerate() {
            let indices = [e, count + e, 2 * count + e];
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

    /// Sets the amplitudes to Lᵀ r, and `y` to q + (W + `added_diagonal`) r.
    pub(super) fn update_displacements(
        &mut self,
        forces: &[f64],
        q: &[f64],
        added_diagonal: f64,
        y: &mut [f64],
    ) {
        let count = self.diagonal.len();
        self.amplitudes.fill(0.0);
        for e in 0..count {
            self.add_force(e, [forces[e], forces[count + e], forces[2 * count + e]]);
        }
        for e in 0..count {
            let indices = [e, count + e, 2 * count + e];
            let displacement = self.displacement(e, indices.map(|i| forces[i]));
            for (i, displacement) in indices.into_iter().zip(displacement) {
                y[i] = q[i] + added_diagonal * forces[i] + displacement;
            }
        }
    }

    /// Displacement of an element under the present forces; `force` is its part of them.
    #[inline]
    pub(super) fn displacement(&self, e: usize, force: [f64; 3]) -> [f64; 3] {
        let mut displacement = self.modal_displacement(e, &self.amplitudes);
        (0..3).for_each(|k| displacement[k] += self.diagonal[e][k] * force[k]);
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

    /// Adds the modal amplitudes due to a force on one element.
    #[inline]
    pub(super) fn add_force(&mut self, e: usize, force: [f64; 3]) {
        let modes = &self.modes[e * self.mode_count..][..self.mode_count];
        for (amplitude, mode) in self.amplitudes.iter_mut().zip(modes) {
            *amplitude += mode[0] * force[0] + mode[1] * force[1] + mode[2] * force[2];
        }
    }
}

/// Modes of the structure: pivoted Cholesky factors L of W − G, mode by mode.
///
/// G is `soil(row, column)`, with `layer(row)` on its diagonal. `None` if W − G has too many modes or is not positive.
pub(super) fn find_modes(
    w: &[f64],
    size: usize,
    soil: impl Fn(usize, usize) -> f64,
    layer: impl Fn(usize) -> f64,
) -> Option<Vec<Vec<f64>>> {
    let soil_entry = |row: usize, column: usize| {
        soil(row, column) + if row == column { layer(row) } else { 0.0 }
    };
    let diagonal: Vec<f64> = (0..size).map(|i| w[i * (size + 1)]).collect();
    let structure_diagonal =
        diagonal.iter().enumerate().map(|(i, entry)| entry - soil_entry(i, i)).collect();
    let tolerance = diagonal.iter().map(|entry| MODE_TOLERANCE * entry).fold(0.0, f64::max);
    pivoted_cholesky(structure_diagonal, tolerance, MAX_MODE_COUNT, |pivot, column| {
        for (i, value) in column.iter_mut().enumerate() {
            *value = w[i * size + pivot] - soil_entry(i, pivot);
        }
    })
}
