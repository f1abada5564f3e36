//! W by blocks of elements: their motion by the soil, and by the few modes in which the structure moves.
//!
//! On a lattice most blocks are equal, so that all of them stay in the processor's cache.

#![allow(clippy::inline_always, reason = "to be compiled for the instructions of its caller")]

use std::collections::HashMap;

use crate::linalg::{Simd, WithSimd, vectorized};

/// Largest number of modes.
const RANK: usize = 24;
/// Diagonal that the modes leave out, relative to the largest of W: rounding.
const ROUNDING: f64 = 1e-14;
/// Elements are near each other if the force that one adds to the other is above this fraction of its own.
const NEAR: f64 = 3e-3;
/// Largest numbers of different blocks and of near links, relative to all.
const DIFFERENT: f64 = 0.25;
const MOST_NEAR: f64 = 0.3;

/// Motion of an element by a unit force along each direction on another element; the last number is zero.
type Block = [[f64; 4]; 3];
/// L of an element, for each direction.
type Modes = [[f64; RANK]; 3];

/// An element that another one moves, and the block by which it does.
#[derive(Debug, Clone, Copy)]
struct Link {
    element: usize,
    block: usize,
}

/// W = G + L Lᵀ: soil and structure.
pub(super) struct Blocks {
    /// Links of one element after the other, the strongest first.
    links: Vec<Link>,
    /// Force that each link adds, relative to the force that causes it.
    strengths: Vec<f64>,
    /// First link of each element, and the end.
    starts: Vec<usize>,
    /// End of the near links of each element.
    near: Vec<usize>,
    /// Different blocks.
    kinds: Vec<Block>,
    modes: Vec<Modes>,
    rank: usize,
    /// Motions by the soil; amplitudes Lᵀ r of the modes.
    motions: Vec<[f64; 4]>,
    amplitudes: [f64; RANK],
}

impl Blocks {
    /// Blocks of the row-major `w` with the part `soil(row, column)`, for reciprocals `rho` of the diagonal.
    ///
    /// `None` if few blocks are equal, many elements are near each other, or the rest of W has too many modes.
    pub(super) fn new(
        w: &[f64],
        rho: &[[f64; 2]],
        soil: impl Fn(usize, usize) -> f64,
    ) -> Option<Self> {
        let count = rho.len();
        let mut all = Self {
            links: Vec::with_capacity(count * count),
            strengths: Vec::with_capacity(count * count),
            starts: vec![0],
            near: Vec::with_capacity(count),
            kinds: vec![],
            modes: vec![[[0.0; RANK]; 3]; count],
            rank: 0,
            motions: vec![[0.0; 4]; count],
            amplitudes: [0.0; RANK],
        };
        all.find_links(rho, &soil)?;
        all.find_modes(w, &soil)?;
        Some(all)
    }

    fn find_links(&mut self, rho: &[[f64; 2]], soil: impl Fn(usize, usize) -> f64) -> Option<()> {
        let count = rho.len();
        let mut known = HashMap::new();
        let mut links: Vec<(f64, Link)> = Vec::with_capacity(count);
        for e in 0..count {
            links.clear();
            for (element, [normal, tangential]) in rho.iter().enumerate() {
                let mut block = Block::default();
                for (c, column) in block.iter_mut().enumerate() {
                    for (r, value) in column.iter_mut().take(3).enumerate() {
                        *value = soil(r * count + element, c * count + e);
                    }
                }
                if block == Block::default() {
                    continue;
                }
                let strength = block.iter().fold(0.0_f64, |most, [n, x, y, _]| {
                    most.max(normal * n.abs()).max(tangential * x.abs().max(y.abs()))
                });
                let kinds = &mut self.kinds;
                let number =
                    *known.entry(block.map(|c| c.map(f64::to_bits))).or_insert_with(|| {
                        kinds.push(block);
                        kinds.len() - 1
                    });
                links.push((strength, Link { element, block: number }));
            }
            if self.kinds.len() as f64 > DIFFERENT * (count * count) as f64 {
                return None;
            }
            links.sort_by(|a, b| b.0.total_cmp(&a.0));
            let near = links.partition_point(|(strength, _)| *strength > NEAR);
            self.near.push(self.links.len() + near);
            self.links.extend(links.iter().map(|(_, link)| *link));
            self.strengths.extend(links.iter().map(|(strength, _)| *strength));
            self.starts.push(self.links.len());
        }
        let near: usize = self.near.iter().zip(&self.starts).map(|(end, start)| end - start).sum();
        (near as f64 <= MOST_NEAR * self.links.len() as f64).then_some(())
    }

    /// Pivoted Cholesky factors L of W without the soil.
    fn find_modes(&mut self, w: &[f64], soil: impl Fn(usize, usize) -> f64) -> Option<()> {
        let count = self.modes.len();
        let size = 3 * count;
        let own = |i: usize| w[i * (size + 1)];
        let mut rest: Vec<f64> = (0..size).map(|i| own(i) - soil(i, i)).collect();
        let least = (0..size).map(|i| ROUNDING * own(i)).fold(0.0, f64::max);
        loop {
            let pivot = (0..size).max_by(|a, b| rest[*a].total_cmp(&rest[*b]))?;
            if rest[pivot] <= least {
                // A rest that is not positive has no such factors.
                return rest.iter().all(|rest| *rest >= -10.0 * least).then_some(());
            }
            if self.rank == RANK {
                return None;
            }
            let (k, root) = (self.rank, rest[pivot].sqrt());
            let chosen = self.modes[pivot % count][pivot / count];
            for (i, rest) in rest.iter_mut().enumerate() {
                let own = &mut self.modes[i % count][i / count];
                let known: f64 = own.iter().zip(&chosen).take(k).map(|(a, b)| a * b).sum();
                own[k] = (w[i * size + pivot] - soil(i, pivot) - known) / root;
                *rest -= own[k] * own[k];
            }
            rest[pivot] = 0.0;
            self.rank += 1;
        }
    }

    /// Sets the motions to q, without forces.
    pub(super) fn rest(&mut self, q: &[f64]) {
        let count = self.motions.len();
        for (e, motion) in self.motions.iter_mut().enumerate() {
            *motion = [q[e], q[count + e], q[2 * count + e], 0.0];
        }
        self.amplitudes.fill(0.0);
    }

    /// Adds the motion of all elements by a force on one element.
    pub(super) fn push(&mut self, e: usize, force: [f64; 3]) {
        self.push_near(e, force);
        self.push_links(self.near[e], self.starts[e + 1], force);
    }

    /// Adds the motion of near elements, and of all by the structure, by a force on one element.
    pub(super) fn push_near(&mut self, e: usize, force: [f64; 3]) {
        self.push_links(self.starts[e], self.near[e], force);
        for (modes, force) in self.modes[e].iter().zip(force) {
            let amplitudes = self.amplitudes.iter_mut().zip(modes).take(self.rank);
            amplitudes.for_each(|(amplitude, mode)| *amplitude += mode * force);
        }
    }

    /// Adds the motion of other elements by the soil, where it adds forces above `least`, N; returns whether any were.
    pub(super) fn push_far(&mut self, e: usize, force: [f64; 3], least: f64) -> bool {
        let largest = force.iter().fold(0.0_f64, |most, force| most.max(force.abs()));
        if largest == 0.0 {
            return false;
        }
        let begin = self.near[e];
        let strengths = &self.strengths[begin..self.starts[e + 1]];
        let reached = strengths.partition_point(|strength| strength * largest > least);
        self.push_links(begin, begin + reached, force);
        reached > 0
    }

    fn push_links(&mut self, begin: usize, end: usize, force: [f64; 3]) {
        let Self { links, kinds, motions, .. } = self;
        vectorized(Push { links: &links[begin..end], blocks: kinds, force, motions });
    }

    /// Motion of an element.
    pub(super) fn motion(&self, e: usize) -> [f64; 3] {
        std::array::from_fn(|i| {
            let modes = self.modes[e][i].iter().zip(&self.amplitudes).take(self.rank);
            self.motions[e][i] + modes.map(|(mode, amplitude)| mode * amplitude).sum::<f64>()
        })
    }
}

/// Motions of the links' elements by a force.
struct Push<'a> {
    links: &'a [Link],
    blocks: &'a [Block],
    force: [f64; 3],
    motions: &'a mut [[f64; 4]],
}

impl WithSimd for Push<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        let Self { links, blocks, force, motions } = self;
        let [p, x, y] = force.map(|force| simd.splat_f64s(force));
        for link in links {
            let columns = &blocks[link.block];
            let [a, b, c] = [0, 1, 2].map(|k| S::as_simd_f64s(&columns[k]));
            let (sums, tail) = S::as_mut_simd_f64s(&mut motions[link.element]);
            for (sum, (a, (b, c))) in sums.iter_mut().zip(a.0.iter().zip(b.0.iter().zip(c.0))) {
                let first = simd.mul_add_e_f64s(*a, p, *sum);
                *sum = simd.mul_add_e_f64s(*c, y, simd.mul_add_e_f64s(*b, x, first));
            }
            for (sum, (a, (b, c))) in tail.iter_mut().zip(a.1.iter().zip(b.1.iter().zip(c.1))) {
                *sum += a * force[0] + b * force[1] + c * force[2];
            }
        }
    }
}

#[cfg(test)]
mod tests;
