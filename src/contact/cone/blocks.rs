//! W by blocks of elements on a lattice: their motion by the soil, and by the few modes in which the structure moves.
//!
//! Elements are near each other if one moves the other much. Eight elements that are not near each other form a group.
//! A sweep solves them together, one in each lane, and moves the elements near them. All others are moved by transforms
//! along the surface, after several sweeps.

#![allow(clippy::inline_always, reason = "to be compiled for the instructions of its caller")]

use std::collections::HashMap;

use super::group::{LANE_COUNT, Lane, read, write};
use super::modes::{MAX_MODE_COUNT, find_modes};
use crate::geometry::offset;
use crate::linalg::{LatticeProduct, LatticeScratch, Simd, WithSimd, vectorized};

/// Elements are near each other if the force that one adds to the other is above this fraction of its own.
const NEAR_FORCE_RATIO: f64 = 3e-3;
/// Largest number of elements near one, relative to all.
const MAX_NEAR_FRACTION: f64 = 0.3;
/// Number of elements near one, relative to all, above which factors of W solve in less time than sweeps.
const FACTORED_NEAR_FRACTION: f64 = 0.05;
/// Largest number of elements for which factors of W fit into caches.
const MAX_FACTORED_ELEMENTS: usize = 600;

/// Motion of an element by a unit force along each direction on another element; the last number is zero.
type LinkBlock = [[f64; 4]; 3];

/// An element that another one moves, and the block by which it does.
#[derive(Debug, Clone, Copy)]
struct Link {
    element: u32,
    block: u32,
}

/// NearFieldProduct elements of all elements, one after the other.
struct Links {
    all: Vec<Link>,
    /// First link of each element, and the end.
    starts: Vec<usize>,
    kinds: Vec<LinkBlock>,
}

/// W = G + L Lᵀ: soil and structure.
pub(super) struct NearFieldBlocks {
    /// Elements of each group; the number of all elements marks a free place.
    pub(super) groups: Vec<[usize; LANE_COUNT]>,
    near: Links,
    /// G without the near links; `None` if it is zero.
    far: Option<LatticeProduct>,
    scratch: LatticeScratch,
    /// L of each group, mode by mode: three directions.
    modes: Vec<[Lane; 3]>,
    rank: usize,
    /// Displacements due to the soil, padded by one dummy entry; modal amplitudes Lᵀ r.
    motions: Vec<[f64; 4]>,
    amplitudes: [f64; MAX_MODE_COUNT],
    last_product: Product,
}

/// Forces of the last product with W, and the product.
struct Product {
    forces: Vec<f64>,
    motions: Vec<[f64; 4]>,
    amplitudes: [f64; MAX_MODE_COUNT],
}

impl NearFieldBlocks {
    /// Blocks of the row-major `w` with the part `soil(row, column)`, for reciprocals `rho` of the diagonal.
    ///
    /// `cells`: column and row of each element. `layer(row)`: part of the diagonal that is neither soil nor structure.
    /// `None` if blocks of equal offset differ, many elements are near each other, or the rest of W has too many modes.
    pub(super) fn new(
        w: &[f64],
        rho: &[[f64; 2]],
        cells: &[[usize; 2]],
        soil: impl Fn(usize, usize) -> f64,
        layer: impl Fn(usize) -> f64,
    ) -> Option<Self> {
        let count = rho.len();
        let block = |receiver: usize, source: usize| {
            [0, 1, 2].map(|r| [0, 1, 2].map(|c| soil(r * count + receiver, c * count + source)))
        };
        let max_normal = rho.iter().map(|rho| rho[0]).fold(0.0, f64::max);
        let max_tangential = rho.iter().map(|rho| rho[1]).fold(0.0, f64::max);
        let scales = [max_normal, max_tangential, max_tangential];
        let is_near = |receiver: usize, source: usize| {
            let mut rows = block(receiver, source).into_iter().zip(scales);
            receiver == source
                || rows.any(|(row, rho)| row.iter().any(|g| rho * g.abs() > NEAR_FORCE_RATIO))
        };
        let near = Links::new(cells, is_near, block, &layer)?;
        if near.all.len() as f64 > MAX_NEAR_FRACTION * (count * count) as f64 {
            return None;
        }
        let far = far(cells, is_near, block)?;
        let modes = find_modes(w, 3 * count, &soil, &layer)?;
        let groups = near.groups();
        let mut modes_of_groups = Vec::with_capacity(groups.len() * modes.len());
        for group in &groups {
            modes_of_groups.extend(modes.iter().map(|mode| lanes_of(group, mode)));
        }
        Some(Self {
            modes: modes_of_groups,
            rank: modes.len(),
            groups,
            near,
            scratch: far.as_ref().map(LatticeProduct::scratch).unwrap_or_default(),
            far,
            motions: vec![[0.0; 4]; count + 1],
            amplitudes: [0.0; MAX_MODE_COUNT],
            last_product: Product {
                forces: vec![f64::NAN; 3 * count],
                motions: vec![[0.0; 4]; count + 1],
                amplitudes: [0.0; MAX_MODE_COUNT],
            },
        })
    }

    /// Whether factors of W solve in less time than sweeps, for elements that all stick.
    pub(super) fn is_factored(&self) -> bool {
        let count = self.near.starts.len() - 1;
        count <= MAX_FACTORED_ELEMENTS
            && self.near.all.len() as f64 > FACTORED_NEAR_FRACTION * (count * count) as f64
    }

    /// Sets the motions to W r.
    pub(super) fn update_motions(&mut self, forces: &[f64]) {
        if self.last_product.forces == forces {
            self.motions.copy_from_slice(&self.last_product.motions);
            self.amplitudes = self.last_product.amplitudes;
            return;
        }
        self.motions.fill([0.0; 4]);
        self.amplitudes.fill(0.0);
        vectorized(NearFieldProduct { blocks: self, forces });
        self.move_far(forces);
        self.last_product.forces.copy_from_slice(forces);
        self.last_product.motions.copy_from_slice(&self.motions);
        self.last_product.amplitudes = self.amplitudes;
    }

    /// Adds the motions of elements by forces on others that are not near.
    pub(super) fn move_far(&mut self, forces: &[f64]) {
        let Self { far, scratch, motions, .. } = self;
        let Some(far) = far else { return };
        far.multiply(forces, scratch, |component, e, motion| motions[e][component] += motion);
    }

    /// Adds the motion of near elements, and of all by the structure, by forces on the elements of a group.
    #[inline(always)]
    pub(super) fn push<S: Simd>(&mut self, simd: S, g: usize, forces: &[Lane; 3]) {
        let Self { near, motions, .. } = self;
        let [p, x, y] = forces;
        for (lane, e) in self.groups[g].into_iter().enumerate() {
            let force = [p[lane], x[lane], y[lane]];
            if force == [0.0; 3] {
                continue;
            }
            for link in near.of(e) {
                let block = &near.kinds[link.block as usize];
                add(simd, block, force, &mut motions[link.element as usize]);
            }
        }
        let modes = &self.modes[g * self.rank..][..self.rank];
        for (amplitude, [a, b, c]) in self.amplitudes.iter_mut().zip(modes) {
            let mut sums = simd.splat_f64s(0.0);
            for part in 0..LANE_COUNT / S::F64_LANES {
                sums = simd.mul_add_e_f64s(read::<S>(a, part), read::<S>(p, part), sums);
                sums = simd.mul_add_e_f64s(read::<S>(b, part), read::<S>(x, part), sums);
                sums = simd.mul_add_e_f64s(read::<S>(c, part), read::<S>(y, part), sums);
            }
            *amplitude += simd.reduce_sum_f64s(sums);
        }
    }

    /// Motions of the elements of a group.
    #[inline(always)]
    pub(super) fn motion<S: Simd>(&self, simd: S, g: usize) -> [Lane; 3] {
        let mut motion = [[0.0; LANE_COUNT]; 3];
        for (lane, e) in self.groups[g].into_iter().enumerate() {
            let by_soil = &self.motions[e];
            for k in 0..3 {
                motion[k][lane] = by_soil[k];
            }
        }
        let modes = &self.modes[g * self.rank..][..self.rank];
        for part in 0..LANE_COUNT / S::F64_LANES {
            let mut sums = [simd.splat_f64s(0.0); 3];
            for (amplitude, mode) in self.amplitudes.iter().zip(modes) {
                let amplitude = simd.splat_f64s(*amplitude);
                for k in 0..3 {
                    sums[k] = simd.mul_add_e_f64s(read::<S>(&mode[k], part), amplitude, sums[k]);
                }
            }
            for k in 0..3 {
                let sum = simd.add_f64s(read::<S>(&motion[k], part), sums[k]);
                write::<S>(&mut motion[k], part, sum);
            }
        }
        motion
    }
}

/// G without the near links, within `Some` unless it is zero; `None` if blocks of equal offset differ.
#[allow(clippy::option_option, reason = "the outer one is a failure")]
fn far(
    cells: &[[usize; 2]],
    is_near: impl Fn(usize, usize) -> bool,
    block: impl Fn(usize, usize) -> [[f64; 3]; 3],
) -> Option<Option<LatticeProduct>> {
    let far = |receiver: usize, source: usize| {
        if is_near(receiver, source) { [[0.0; 3]; 3] } else { block(receiver, source) }
    };
    let mut pairs = (0..cells.len()).flat_map(|e| (0..cells.len()).map(move |other| (e, other)));
    if pairs.all(|(receiver, source)| far(receiver, source) == [[0.0; 3]; 3]) {
        return Some(None);
    }
    LatticeProduct::new(cells, &vec![1.0; cells.len()], far).map(Some)
}

impl Links {
    /// Links between near elements; `None` if there are too many to be counted.
    fn new(
        cells: &[[usize; 2]],
        is_near: impl Fn(usize, usize) -> bool,
        block: impl Fn(usize, usize) -> [[f64; 3]; 3],
        layer: impl Fn(usize) -> f64,
    ) -> Option<Self> {
        let count = cells.len();
        let mut links = Self { all: vec![], starts: vec![0], kinds: vec![] };
        // Number of the block for each offset, and for each layer of an element on itself.
        let mut known = HashMap::new();
        for source in 0..count {
            for receiver in (0..count).filter(|receiver| is_near(*receiver, source)) {
                let mut block = block(receiver, source);
                let mut layers = [0; 3];
                if receiver == source {
                    for (k, bits) in layers.iter_mut().enumerate() {
                        let layer = layer(k * count + source);
                        block[k][k] += layer;
                        *bits = layer.to_bits();
                    }
                }
                let number = *known
                    .entry((offset(cells[receiver], cells[source]), layers))
                    .or_insert(u32::try_from(links.kinds.len()).ok()?);
                if number as usize == links.kinds.len() {
                    let columns = [0, 1, 2].map(|c| [block[0][c], block[1][c], block[2][c], 0.0]);
                    links.kinds.push(columns);
                }
                links.all.push(Link { element: u32::try_from(receiver).ok()?, block: number });
            }
            links.starts.push(links.all.len());
        }
        Some(links)
    }

    /// Links of one element.
    #[inline(always)]
    fn of(&self, e: usize) -> &[Link] {
        &self.all[self.starts[e]..self.starts[e + 1]]
    }

    /// Whether the element `other` is near the element `e`.
    fn are_near(&self, e: usize, other: usize) -> bool {
        self.of(e).iter().any(|link| link.element as usize == other)
    }

    /// Groups of elements that are not near each other, in the order of their first elements.
    fn groups(&self) -> Vec<[usize; LANE_COUNT]> {
        let count = self.starts.len() - 1;
        let mut groups: Vec<[usize; LANE_COUNT]> = vec![];
        for e in 0..count {
            let fitting = groups.iter_mut().find(|group| {
                group[LANE_COUNT - 1] == count
                    && !group.iter().any(|other| self.are_near(e, *other))
            });
            if let Some(group) = fitting {
                if let Some(free) = group.iter_mut().find(|element| **element == count) {
                    *free = e;
                }
            } else {
                let mut group = [count; LANE_COUNT];
                group[0] = e;
                groups.push(group);
            }
        }
        groups
    }
}

/// Motions of all elements by forces on near ones, and by the structure.
struct NearFieldProduct<'a> {
    blocks: &'a mut NearFieldBlocks,
    forces: &'a [f64],
}

impl WithSimd for NearFieldProduct<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        let Self { blocks, forces } = self;
        for g in 0..blocks.groups.len() {
            let force = lanes_of(&blocks.groups[g], forces);
            blocks.push(simd, g, &force);
        }
    }
}

/// Values of a contact vector on the elements of a group, one in each lane; zero in free lanes.
#[inline(always)]
fn lanes_of(group: &[usize; LANE_COUNT], vector: &[f64]) -> [Lane; 3] {
    let count = vector.len() / 3;
    [0, 1, 2].map(|k| group.map(|e| if e < count { vector[k * count + e] } else { 0.0 }))
}

/// Adds the motion by a force.
#[inline(always)]
fn add<S: Simd>(simd: S, block: &LinkBlock, force: [f64; 3], motion: &mut [f64; 4]) {
    let (sums, tail) = S::as_mut_simd_f64s(motion);
    for (k, force) in force.into_iter().enumerate() {
        let (column, rest) = S::as_simd_f64s(&block[k]);
        let wide = simd.splat_f64s(force);
        for (sum, value) in sums.iter_mut().zip(column) {
            *sum = simd.mul_add_e_f64s(*value, wide, *sum);
        }
        tail.iter_mut().zip(rest).for_each(|(sum, value)| *sum += value * force);
    }
}

#[cfg(test)]
mod tests;
