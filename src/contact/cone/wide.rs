//! W of elements on a lattice each of which moves most others: by tables over the offset, and the structure's modes.

#![allow(clippy::inline_always, reason = "to be compiled for the instructions of its caller")]

use super::modes::find_modes;
use crate::linalg::{LatticeProduct, LatticeScratch, Simd};

/// W = G + L Lᵀ: soil and structure.
pub(super) struct Wide {
    /// Columns and rows of the lattice.
    counts: [usize; 2],
    /// For each direction of motion and of force, G of all offsets: rows of twice the columns less one.
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

impl Wide {
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
        let counts = [0, 1].map(|axis| cells.iter().fold(0, |most, cell| most.max(cell[axis] + 1)));
        let width = 2 * counts[0] - 1;
        let table = || vec![0.0; width * (2 * counts[1] - 1)];
        let mut tables = [(); 3].map(|()| [(); 3].map(|()| table()));
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
        let own = |e: usize| [e, count + e, 2 * count + e];
        Some(Self {
            counts,
            tables,
            scratch: product.scratch(),
            product,
            layers: (0..count).map(|e| own(e).map(&layer)).collect(),
            modes: (0..count)
                .flat_map(|e| modes.iter().map(move |mode| own(e).map(|i| mode[i])))
                .collect(),
            rank: modes.len(),
            motions: [(); 3].map(|()| vec![0.0; counts[0] * counts[1]]),
            amplitudes: vec![0.0; modes.len()],
        })
    }

    /// Sets the motions to W r.
    pub(super) fn respond(&mut self, forces: &[f64]) {
        let Self { product, scratch, motions, counts, amplitudes, modes, rank, .. } = self;
        let cells = product.cells();
        product.multiply(forces, scratch, |k, e, value| {
            motions[k][cells[e][1] * counts[0] + cells[e][0]] = value;
        });
        amplitudes.fill(0.0);
        let count = cells.len();
        for (e, modes) in modes.chunks_exact((*rank).max(1)).enumerate() {
            for (amplitude, [p, x, y]) in amplitudes.iter_mut().zip(modes) {
                *amplitude += p * forces[e] + x * forces[count + e] + y * forces[2 * count + e];
            }
        }
    }

    /// Motion of an element with the force `change`.
    #[inline(always)]
    pub(super) fn motion(&self, e: usize, change: [f64; 3]) -> [f64; 3] {
        let [i, j] = self.product.cells()[e];
        let place = j * self.counts[0] + i;
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
        let ([columns, rows], [i, j]) = (self.counts, self.product.cells()[e]);
        let width = 2 * columns - 1;
        for (motions, tables) in self.motions.iter_mut().zip(&self.tables) {
            for row in 0..rows {
                let begin = (rows - 1 + row - j) * width + columns - 1 - i;
                let (sums, tail) = S::as_mut_simd_f64s(&mut motions[row * columns..][..columns]);
                let [a, b, c] = tables;
                let (a, a_tail) = S::as_simd_f64s(&a[begin..begin + columns]);
                let (b, b_tail) = S::as_simd_f64s(&b[begin..begin + columns]);
                let (c, c_tail) = S::as_simd_f64s(&c[begin..begin + columns]);
                let wide = [
                    simd.splat_f64s(force[0]),
                    simd.splat_f64s(force[1]),
                    simd.splat_f64s(force[2]),
                ];
                for (sum, ((a, b), c)) in sums.iter_mut().zip(a.iter().zip(b).zip(c)) {
                    let first = simd.mul_add_e_f64s(*a, wide[0], *sum);
                    let second = simd.mul_add_e_f64s(*b, wide[1], first);
                    *sum = simd.mul_add_e_f64s(*c, wide[2], second);
                }
                for (sum, ((a, b), c)) in tail.iter_mut().zip(a_tail.iter().zip(b_tail).zip(c_tail))
                {
                    *sum += a * force[0] + b * force[1] + c * force[2];
                }
            }
        }
        for (amplitude, mode) in self.amplitudes.iter_mut().zip(&self.modes[e * self.rank..]) {
            *amplitude += mode[0] * force[0] + mode[1] * force[1] + mode[2] * force[2];
        }
    }
}
