//! W by blocks of elements: their motion by the soil, and by the few modes in which the structure moves.
//!
//! On a lattice most blocks are equal, so that all of them stay in the processor's cache.

#![allow(clippy::inline_always, reason = "to be compiled for the instructions of its caller")]

use std::collections::HashMap;

use crate::linalg::{Simd, WithSimd, largest, vectorized};

/// Largest number of modes.
const RANK: usize = 24;
/// Diagonal that the modes leave out, relative to the largest of W: rounding.
const ROUNDING: f64 = 1e-14;
/// Elements are near each other if the force that one adds to the other is above this fraction of its own.
const NEAR: f64 = 3e-3;
/// Force that a product leaves out, relative to the largest.
const FINEST: f64 = 1e-16;
/// Largest numbers of different blocks and of near links, relative to all.
const DIFFERENT: f64 = 0.25;
const MOST_NEAR: f64 = 0.3;

/// Motion of an element by a unit force along each direction on another element; the last number is zero.
type Block = [[f64; 4]; 3];
/// L of an element, for each mode; the last number is zero.
type Modes = [[f64; 4]; RANK];

/// An element that another one moves, and the block by which it does.
#[derive(Debug, Clone, Copy)]
struct Link {
    element: u32,
    block: u32,
}

/// W = G + L Lᵀ: soil and structure.
pub(super) struct Blocks {
    /// Links of one element after the other, the strongest first.
    links: Vec<Link>,
    /// Force that each link adds, relative to the force that causes it.
    strengths: Vec<f32>,
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
    /// Forces of the last product with W, and the product: motions and amplitudes.
    known: (Vec<f64>, Vec<[f64; 4]>, [f64; RANK]),
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
            modes: vec![[[0.0; 4]; RANK]; count],
            rank: 0,
            motions: vec![[0.0; 4]; count],
            amplitudes: [0.0; RANK],
            known: (vec![f64::NAN; 3 * count], vec![[0.0; 4]; count], [0.0; RANK]),
        };
        all.find_links(rho, &soil)?;
        all.find_modes(w, &soil)?;
        Some(all)
    }

    #[allow(
        clippy::cast_possible_truncation,
        reason = "counts of elements; strengths need few digits"
    )]
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
                        kinds.len() as u32 - 1
                    });
                links.push((strength, Link { element: element as u32, block: number }));
            }
            if self.kinds.len() as f64 > DIFFERENT * (count * count) as f64 {
                return None;
            }
            links.sort_by(|a, b| b.0.total_cmp(&a.0));
            let near = links.partition_point(|(strength, _)| *strength > NEAR);
            self.near.push(self.links.len() + near);
            self.links.extend(links.iter().map(|(_, link)| *link));
            self.strengths.extend(links.iter().map(|(strength, _)| *strength as f32));
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
            let chosen = self.modes[pivot % count].map(|mode| mode[pivot / count]);
            for (i, rest) in rest.iter_mut().enumerate() {
                let (own, direction) = (&mut self.modes[i % count], i / count);
                let pairs = own.iter().zip(&chosen).take(k);
                let known: f64 = pairs.map(|(a, b)| a[direction] * b).sum();
                own[k][direction] = (w[i * size + pivot] - soil(i, pivot) - known) / root;
                *rest -= own[k][direction] * own[k][direction];
            }
            rest[pivot] = 0.0;
            self.rank += 1;
        }
    }

    /// Sets the motions to W r.
    pub(super) fn respond(&mut self, forces: &[f64]) {
        if self.known.0 == forces {
            self.motions.copy_from_slice(&self.known.1);
            self.amplitudes = self.known.2;
            return;
        }
        vectorized(Respond { blocks: self, forces });
        self.known.0.copy_from_slice(forces);
        self.known.1.copy_from_slice(&self.motions);
        self.known.2 = self.amplitudes;
    }

    /// Adds the motion of near elements, and of all by the structure, by a force on one element.
    #[inline(always)]
    pub(super) fn push_near<S: Simd>(&mut self, simd: S, e: usize, force: [f64; 3]) {
        let Self { links, kinds, motions, .. } = self;
        for link in &links[self.starts[e]..self.near[e]] {
            add(simd, &kinds[link.block as usize], force, &mut motions[link.element as usize]);
        }
        let amplitudes = self.amplitudes[..self.rank].iter_mut();
        for (amplitude, [p, x, y, _]) in amplitudes.zip(&self.modes[e]) {
            *amplitude += p * force[0] + x * force[1] + y * force[2];
        }
    }

    /// Adds the motion of other elements by the soil, where it adds forces above `least`, N; returns whether any were.
    #[inline(always)]
    pub(super) fn push_far<S: Simd>(
        &mut self,
        simd: S,
        e: usize,
        force: [f64; 3],
        least: f64,
    ) -> bool {
        let Self { links, strengths, kinds, motions, .. } = self;
        let far = self.near[e]..self.starts[e + 1];
        #[allow(clippy::cast_possible_truncation, reason = "a bound, infinite beyond f32")]
        let weakest = (least / largest(&force)) as f32;
        let mut reached = false;
        for (link, strength) in links[far.clone()].iter().zip(&strengths[far]) {
            if *strength <= weakest {
                break;
            }
            add(simd, &kinds[link.block as usize], force, &mut motions[link.element as usize]);
            reached = true;
        }
        reached
    }

    /// Motion of an element.
    #[inline(always)]
    pub(super) fn motion<S: Simd>(&self, simd: S, e: usize) -> [f64; 3] {
        let mut motion = self.motions[e];
        let (sums, tail) = S::as_mut_simd_f64s(&mut motion);
        for (amplitude, mode) in self.amplitudes[..self.rank].iter().zip(&self.modes[e]) {
            let (wide, modes) = (simd.splat_f64s(*amplitude), S::as_simd_f64s(mode));
            for (sum, mode) in sums.iter_mut().zip(modes.0) {
                *sum = simd.mul_add_e_f64s(*mode, wide, *sum);
            }
            tail.iter_mut().zip(modes.1).for_each(|(sum, mode)| *sum += mode * amplitude);
        }
        [motion[0], motion[1], motion[2]]
    }
}

/// Motions of all elements by all forces.
struct Respond<'a> {
    blocks: &'a mut Blocks,
    forces: &'a [f64],
}

impl WithSimd for Respond<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        let Self { blocks, forces } = self;
        blocks.motions.fill([0.0; 4]);
        blocks.amplitudes.fill(0.0);
        let (count, least) = (blocks.motions.len(), FINEST * largest(forces));
        for e in 0..count {
            let force = [e, count + e, 2 * count + e].map(|i| forces[i]);
            blocks.push_near(simd, e, force);
            blocks.push_far(simd, e, force, least);
        }
    }
}

/// Adds the motion by a force.
#[inline(always)]
fn add<S: Simd>(simd: S, block: &Block, force: [f64; 3], motion: &mut [f64; 4]) {
    let [p, x, y] = force.map(|force| simd.splat_f64s(force));
    let [a, b, c] = [0, 1, 2].map(|k| S::as_simd_f64s(&block[k]));
    let (sums, tail) = S::as_mut_simd_f64s(motion);
    for (sum, (a, (b, c))) in sums.iter_mut().zip(a.0.iter().zip(b.0.iter().zip(c.0))) {
        let first = simd.mul_add_e_f64s(*a, p, *sum);
        *sum = simd.mul_add_e_f64s(*c, y, simd.mul_add_e_f64s(*b, x, first));
    }
    for (sum, (a, (b, c))) in tail.iter_mut().zip(a.1.iter().zip(b.1.iter().zip(c.1))) {
        *sum += a * force[0] + b * force[1] + c * force[2];
    }
}

#[cfg(test)]
mod tests;
