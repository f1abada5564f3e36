//! W of elements on a lattice each of which moves most others: by tables over the offset, and the structure's modes.

#![allow(clippy::inline_always, reason = "to be compiled for the instructions of its caller")]

use super::group::LANE_COUNT;
use super::modes::find_modes;
use crate::linalg::{LatticeProduct, LatticeScratch, Simd};

/// W = G + L Lᵀ: soil and structure.
pub(super) struct DenseLattice {
    /// Columns and rows of the lattice, and its columns with others of no element that complete the lanes.
    counts: [usize; 2],
    row_length: usize,
    /// For each direction of motion and of force, G of all offsets: rows of the columns and the completed columns.
    tables: [[Vec<f64>; 3]; 3],
    product: LatticeProduct,
    scratch: LatticeScratch,
    /// Part of the diagonal that is neither soil nor structure, for each component of an element.
    layers: Vec<[f64; 3]>,
    /// L of each element, mode by mode.
    modes: Vec<[f64; 3]>,
    rank: usize,
    /// Motions of all cells by the soil, row by row; amplitudes Lᵀ r of the modes.
    motions: [Vec<f64>; 3],
    amplitudes: Vec<f64>,
}

impl DenseLattice {
    /// W of `cells` (column and row): the row-major `w` with the part `soil(row, column)`.
    ///
    /// `layer(row)`: part of the diagonal that is neither soil nor structure. `None` if blocks of equal offset differ, or
    /// the rest of W has too many modes.
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
        let places = |e: usize| [e, count + e, 2 * count + e];
        Some(Self {
            counts,
            row_length,
            tables,
            scratch: product.scratch(),
            product,
            layers: (0..count).map(|e| places(e).map(&layer)).collect(),
            modes: (0..count)
                .flat_map(|e| modes.iter().map(move |mode| places(e).map(|i| mode[i])))
                .collect(),
            rank: modes.len(),
            motions: [(); 3].map(|()| vec![0.0; row_length * counts[1]]),
            amplitudes: vec![0.0; modes.len()],
        })
    }

    /// Sets the motions to W r.
    pub(super) fn update_motions(&mut self, forces: &[f64]) {
        let Self { product, scratch, motions, row_length, amplitudes, modes, rank, .. } = self;
        let cells = product.cells();
        product.multiply(forces, scratch, |k, e, value| {
            motions[k][cells[e][1] * *row_length + cells[e][0]] = value;
        });
        amplitudes.fill(0.0);
        let count = cells.len();
        for (e, modes) in modes.chunks_exact((*rank).max(1)).enumerate() {
            for (amplitude, [p, x, y]) in amplitudes.iter_mut().zip(modes) {
                *amplitude += p * forces[e] + x * forces[count + e] + y * forces[2 * count + e];
            }
        }
    }

    /// Motions along each direction and amplitudes of the modes, which are linear in the forces.
    pub(super) fn response_mut(&mut self) -> [&mut [f64]; 4] {
        let [normal, along_x, along_y] = &mut self.motions;
        [normal, along_x, along_y, &mut self.amplitudes]
    }

    /// Number of the motions and amplitudes.
    pub(super) fn response_count(&self) -> usize {
        3 * self.motions[0].len() + self.amplitudes.len()
    }

    /// Motion of an element with the force `change`.
    #[inline(always)]
    pub(super) fn motion(&self, e: usize, change: [f64; 3]) -> [f64; 3] {
        let [i, j] = self.product.cells()[e];
        let place = j * self.row_length + i;
        let mut motion = [0.0; 3];
        for k in 0..3 {
            motion[k] = self.motions[k][place] + self.layers[e][k] * change[k];
        }
        for (amplitude, mode) in self.amplitudes.iter().zip(&self.modes[e * self.rank..]) {
            for k in 0..3 {
                motion[k] += amplitude * mode[k];
            }
        }
        motion
    }

    /// Adds the motion of all elements by a force on one.
    #[inline(always)]
    pub(super) fn push<S: Simd>(&mut self, simd: S, e: usize, force: [f64; 3]) {
        let [columns, rows] = self.counts;
        let [i, j] = self.product.cells()[e];
        let length = self.row_length;
        let width = columns + length - 1;
        let splatted = force.map(|force| simd.splat_f64s(force));
        for (motions, [a, b, c]) in self.motions.iter_mut().zip(&self.tables) {
            for row in 0..rows {
                let begin = (rows - 1 + row - j) * width + columns - 1 - i;
                let sums = S::as_mut_simd_f64s(&mut motions[row * length..][..length]).0;
                let a = S::as_simd_f64s(&a[begin..begin + length]).0;
                let b = S::as_simd_f64s(&b[begin..begin + length]).0;
                let c = S::as_simd_f64s(&c[begin..begin + length]).0;
                for (sum, ((a, b), c)) in sums.iter_mut().zip(a.iter().zip(b).zip(c)) {
                    let first = simd.mul_add_e_f64s(*a, splatted[0], *sum);
                    let second = simd.mul_add_e_f64s(*b, splatted[1], first);
                    *sum = simd.mul_add_e_f64s(*c, splatted[2], second);
                }
            }
        }
        for (amplitude, mode) in self.amplitudes.iter_mut().zip(&self.modes[e * self.rank..]) {
            *amplitude += mode[0] * force[0] + mode[1] * force[1] + mode[2] * force[2];
        }
    }
}
