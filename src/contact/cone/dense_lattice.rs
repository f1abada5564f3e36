//! W of a lattice whose elements move most others.
//!
//! The soil's part is a table over the offset between two elements; the structure's part consists of its few modes.

#![allow(clippy::inline_always, reason = "to be compiled for the instructions of its caller")]

use super::group::LANE_COUNT;
use super::low_rank::find_modes;
use crate::linalg::{LatticeProduct, LatticeScratch, Simd};

/// W = G + L Lᵀ: soil and structure.
pub(super) struct DenseLattice {
    /// Columns and rows of the lattice.
    counts: [usize; 2],
    /// Columns of the lattice, padded to whole vector registers.
    row_length: usize,
    /// G of all offsets for each direction of displacement and of force, row by row.
    tables: [[Vec<f64>; 3]; 3],
    product: LatticeProduct,
    scratch: LatticeScratch,
    /// Part of the diagonal that is neither soil nor structure, for each component of an element.
    layers: Vec<[f64; 3]>,
    /// L of each element, mode by mode.
    modes: Vec<[f64; 3]>,
    mode_count: usize,
    /// Displacements G r of all cells in each direction, row by row.
    displacements: [Vec<f64>; 3],
    /// Modal amplitudes Lᵀ r.
    amplitudes: Vec<f64>,
}

impl DenseLattice {
    /// W of `cells` (column and row): the row-major `w` with the part `soil(row, column)`.
    ///
    /// `layer(row)`: part of the diagonal that is neither soil nor structure. `None` if blocks of equal offset differ, or
    /// the structure has too many modes.
    pub(super) fn new(
        w: &[f64],
        cells: &[[usize; 2]],
        soil: impl Fn(usize, usize) -> f64,
        layer: impl Fn(usize) -> f64,
    ) -> Option<Self> {
        let count = cells.len();
        let block = |receiver: usize, source: usize| {
            [0, 1, 2].map(|r| [0, 1, 2].map(|c| soil(r * count + receiver, c * count + source)))
        };
        let product = LatticeProduct::new(cells, &vec![1.0; count], block)?;
        let counts = [0, 1].map(|axis| cells.iter().fold(0, |max, cell| max.max(cell[axis] + 1)));
        let row_length = counts[0].next_multiple_of(LANE_COUNT);
        let width = counts[0] + row_length - 1;
        let table_length = width * (2 * counts[1] - 1);
        let mut tables = [(); 3].map(|()| [(); 3].map(|()| vec![0.0; table_length]));
        for (receiver, to) in cells.iter().enumerate() {
            for (source, from) in cells.iter().enumerate() {
                let [i, j] = [0, 1].map(|axis| counts[axis] - 1 + to[axis] - from[axis]);
                for (tables, values) in tables.iter_mut().zip(block(receiver, source)) {
                    tables
                        .iter_mut()
                        .zip(values)
                        .for_each(|(table, value)| table[j * width + i] = value);
                }
            }
        }
        let modes = find_modes(w, 3 * count, &soil, &layer)?;
        let indices = |e: usize| [e, count + e, 2 * count + e];
        Some(Self {
            counts,
            row_length,
            tables,
            scratch: product.scratch(),
            product,
            layers: (0..count).map(|e| indices(e).map(&layer)).collect(),
            modes: (0..count)
                .flat_map(|e| modes.iter().map(move |mode| indices(e).map(|i| mode[i])))
                .collect(),
            mode_count: modes.len(),
            displacements: [(); 3].map(|()| vec![0.0; row_length * counts[1]]),
            amplitudes: vec![0.0; modes.len()],
        })
    }

    /// Sets the displacements to those due to forces r.
    pub(super) fn update_displacements(&mut self, forces: &[f64]) {
        let Self {
            product, scratch, displacements, row_length, amplitudes, modes, mode_count, ..
        } = self;
        let cells = product.cells();
        product.multiply(forces, scratch, |k, e, value| {
            displacements[k][cells[e][1] * *row_length + cells[e][0]] = value;
        });
        amplitudes.fill(0.0);
        let count = cells.len();
        for (e, modes) in modes.chunks_exact((*mode_count).max(1)).enumerate() {
            for (amplitude, [p, x, y]) in amplitudes.iter_mut().zip(modes) {
                *amplitude += p * forces[e] + x * forces[count + e] + y * forces[2 * count + e];
            }
        }
    }

    /// Displacements along each direction, and modal amplitudes; all are linear in the forces.
    pub(super) fn response_mut(&mut self) -> [&mut [f64]; 4] {
        let [p, x, y] = &mut self.displacements;
        [p, x, y, &mut self.amplitudes]
    }

    /// Number of displacements and amplitudes.
    pub(super) fn response_count(&self) -> usize {
        3 * self.displacements[0].len() + self.amplitudes.len()
    }

    /// Displacement of an element under the present forces; `force` is its part of them.
    #[inline(always)]
    pub(super) fn displacement(&self, e: usize, force: [f64; 3]) -> [f64; 3] {
        let [i, j] = self.product.cells()[e];
        let cell_index = j * self.row_length + i;
        let mut displacement = [0.0; 3];
        for k in 0..3 {
            displacement[k] = self.displacements[k][cell_index] + self.layers[e][k] * force[k];
        }
        for (amplitude, mode) in self.amplitudes.iter().zip(&self.modes[e * self.mode_count..]) {
            for k in 0..3 {
                displacement[k] += amplitude * mode[k];
            }
        }
        displacement
    }

    /// Adds the displacements of all elements due to a force on one.
    #[inline(always)]
    pub(super) fn add_force<S: Simd>(&mut self, simd: S, e: usize, force: [f64; 3]) {
        let [columns, rows] = self.counts;
        let [i, j] = self.product.cells()[e];
        let row_length = self.row_length;
        let width = columns + row_length - 1;
        let splatted = force.map(|force| simd.splat_f64s(force));
        for (displacements, [a, b, c]) in self.displacements.iter_mut().zip(&self.tables) {
            for row in 0..rows {
                let begin = (rows - 1 + row - j) * width + columns - 1 - i;
                let sums =
                    S::as_mut_simd_f64s(&mut displacements[row * row_length..][..row_length]).0;
                let a = S::as_simd_f64s(&a[begin..begin + row_length]).0;
                let b = S::as_simd_f64s(&b[begin..begin + row_length]).0;
                let c = S::as_simd_f64s(&c[begin..begin + row_length]).0;
                for (sum, ((a, b), c)) in sums.iter_mut().zip(a.iter().zip(b).zip(c)) {
                    *sum = simd.mul_add_e_f64s(*a, splatted[0], *sum);
                    *sum = simd.mul_add_e_f64s(*b, splatted[1], *sum);
                    *sum = simd.mul_add_e_f64s(*c, splatted[2], *sum);
                }
            }
        }
        for (amplitude, mode) in self.amplitudes.iter_mut().zip(&self.modes[e * self.mode_count..])
        {
            *amplitude += mode[0] * force[0] + mode[1] * force[1] + mode[2] * force[2];
        }
    }
}
