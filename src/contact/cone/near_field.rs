//! W of elements on a lattice, by blocks.
//!
//! Displacements are the sum of those due to the soil and those in the structure's few modes.
//!
//! Two elements are near each other if a force on one moves the other much. Eight elements that are not near each other
//! form a group. A sweep projects the forces of a group together, one element in each lane, and updates the
//! displacements of the elements near them. Transforms along the surface update all others after several sweeps.

#![allow(clippy::inline_always, reason = "to be compiled for the instructions of its caller")]

use std::collections::HashMap;

use super::group::{Group, LANE_COUNT, Lane, read, write};
use super::low_rank::{MAX_COMPLIANCE_MODES, compliance_modes};
use crate::geometry::offset;
use crate::linalg::{LatticeProduct, LatticeScratch, Simd, WithSimd, vectorized};

/// Smallest coupling of two elements that are near each other.
///
/// A unit force on one changes the trial force r − ρ y of the other by more than this.
const NEAR_FORCE_RATIO: f64 = 3e-3;
/// Largest number of near links, relative to all pairs of elements.
const MAX_NEAR_FRACTION: f64 = 0.3;
/// Number of near links, relative to all pairs, above which factors are faster.
///
/// Factors of W then solve in less time than sweeps.
const FACTORED_NEAR_FRACTION: f64 = 0.05;
/// Largest number of elements for which factors of W fit into caches.
const MAX_FACTORED_ELEMENTS: usize = 600;

/// Displacement of an element due to unit forces on another one.
///
/// One row for each direction of the force; the fourth number of a row is zero.
type LinkBlock = [[f64; 4]; 3];

/// An element near another one, and the block of W between them.
#[derive(Debug, Clone, Copy)]
struct Link {
    element: u32,
    block_index: u32,
}

/// Links between near elements.
struct Links {
    /// Links of all elements, one element after the other.
    all: Vec<Link>,
    /// First link of each element, and the end.
    starts: Vec<usize>,
    /// The blocks that differ.
    blocks: Vec<LinkBlock>,
}

/// W = G + L Lᵀ: soil and structure, and the data of sweeps.
pub(super) struct NearFieldBlocks {
    /// Elements of each group; the number of all elements marks a free lane.
    pub(super) groups: Vec<[usize; LANE_COUNT]>,
    /// Data of the elements of each group in sweeps.
    pub(super) group_data: Vec<Group>,
    /// Changes of force at the last far-field correction, N.
    pub(super) applied_change: Vec<f64>,
    near: Links,
    /// G without the near links; `None` if it is zero.
    far: Option<LatticeProduct>,
    scratch: LatticeScratch,
    /// L of each group, mode by mode: three directions.
    modes: Vec<[Lane; 3]>,
    mode_count: usize,
    /// Displacements of each element due to the soil, padded to four numbers.
    ///
    /// One more entry belongs to free lanes.
    displacements: Vec<[f64; 4]>,
    /// Modal amplitudes Lᵀ r.
    amplitudes: [f64; MAX_COMPLIANCE_MODES],
    last_product: StoredProduct,
}

/// Forces of the last product with W, and the product.
struct StoredProduct {
    forces: Vec<f64>,
    displacements: Vec<[f64; 4]>,
    amplitudes: [f64; MAX_COMPLIANCE_MODES],
}

impl NearFieldBlocks {
    /// Blocks of the row-major `w` with the part `soil(row, column)`, for reciprocals `rho` of the diagonal.
    ///
    /// `cells`: column and row of each element. `layer(row)`: part of the diagonal that is neither soil nor structure.
    /// `None` if blocks of equal offset differ, many elements are near each other, or the structure has too many modes.
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
        let max_normal_rho = rho.iter().map(|rho| rho[0]).fold(0.0, f64::max);
        let max_tangential_rho = rho.iter().map(|rho| rho[1]).fold(0.0, f64::max);
        let row_scales = [max_normal_rho, max_tangential_rho, max_tangential_rho];
        let is_near = |receiver: usize, source: usize| {
            let mut rows = block(receiver, source).into_iter().zip(row_scales);
            receiver == source
                || rows.any(|(row, rho)| row.iter().any(|g| rho * g.abs() > NEAR_FORCE_RATIO))
        };
        let near = Links::new(cells, is_near, block, &layer)?;
        if near.all.len() as f64 > MAX_NEAR_FRACTION * (count * count) as f64 {
            return None;
        }
        let far = far(cells, is_near, block)?;
        let modes = compliance_modes(w, 3 * count, &soil, &layer)?;
        let groups = near.groups();
        let mut group_modes = Vec::with_capacity(groups.len() * modes.len());
        for group in &groups {
            group_modes.extend(modes.iter().map(|mode| group_lanes(group, mode)));
        }
        Some(Self {
            modes: group_modes,
            mode_count: modes.len(),
            group_data: vec![Group::default(); groups.len()],
            applied_change: vec![0.0; 3 * count],
            groups,
            near,
            scratch: far.as_ref().map(LatticeProduct::scratch).unwrap_or_default(),
            far,
            displacements: vec![[0.0; 4]; count + 1],
            amplitudes: [0.0; MAX_COMPLIANCE_MODES],
            last_product: StoredProduct {
                forces: vec![f64::NAN; 3 * count],
                displacements: vec![[0.0; 4]; count + 1],
                amplitudes: [0.0; MAX_COMPLIANCE_MODES],
            },
        })
    }

    /// Whether factors of W solve in less time than sweeps, for elements that all stick.
    pub(super) fn prefers_factors(&self) -> bool {
        let count = self.near.starts.len() - 1;
        count <= MAX_FACTORED_ELEMENTS
            && self.near.all.len() as f64 > FACTORED_NEAR_FRACTION * (count * count) as f64
    }

    /// Sets the displacements to W r.
    pub(super) fn update_displacements(&mut self, forces: &[f64]) {
        if self.last_product.forces == forces {
            self.displacements.copy_from_slice(&self.last_product.displacements);
            self.amplitudes = self.last_product.amplitudes;
            return;
        }
        self.displacements.fill([0.0; 4]);
        self.amplitudes.fill(0.0);
        vectorized(NearFieldProduct { blocks: self, forces });
        self.add_far_displacements(forces);
        self.last_product.forces.copy_from_slice(forces);
        self.last_product.displacements.copy_from_slice(&self.displacements);
        self.last_product.amplitudes = self.amplitudes;
    }

    /// Adds the displacements due to forces on elements that are not near.
    pub(super) fn add_far_displacements(&mut self, forces: &[f64]) {
        let Self { far, scratch, displacements, .. } = self;
        let Some(far) = far else { return };
        far.multiply(forces, scratch, |component, e, displacement| {
            displacements[e][component] += displacement;
        });
    }

    /// Adds the displacements due to forces on a group.
    ///
    /// The soil moves near elements; the structure moves all.
    #[inline(always)]
    pub(super) fn add_group_forces<S: Simd>(&mut self, simd: S, g: usize, forces: &[Lane; 3]) {
        let Self { near, displacements, .. } = self;
        let [p, x, y] = forces;
        for (lane, e) in self.groups[g].into_iter().enumerate() {
            let force = [p[lane], x[lane], y[lane]];
            if force == [0.0; 3] {
                continue;
            }
            for link in near.of(e) {
                let block = &near.blocks[link.block_index as usize];
                add_displacement(simd, block, force, &mut displacements[link.element as usize]);
            }
        }
        let modes = &self.modes[g * self.mode_count..][..self.mode_count];
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

    /// Displacements of the elements of a group.
    #[inline(always)]
    pub(super) fn displacement<S: Simd>(&self, simd: S, g: usize) -> [Lane; 3] {
        let mut displacement = [[0.0; LANE_COUNT]; 3];
        for (lane, e) in self.groups[g].into_iter().enumerate() {
            let soil_displacement = &self.displacements[e];
            for k in 0..3 {
                displacement[k][lane] = soil_displacement[k];
            }
        }
        let modes = &self.modes[g * self.mode_count..][..self.mode_count];
        for part in 0..LANE_COUNT / S::F64_LANES {
            let mut sums = [simd.splat_f64s(0.0); 3];
            for (amplitude, mode) in self.amplitudes.iter().zip(modes) {
                let amplitude = simd.splat_f64s(*amplitude);
                for k in 0..3 {
                    sums[k] = simd.mul_add_e_f64s(read::<S>(&mode[k], part), amplitude, sums[k]);
                }
            }
            for k in 0..3 {
                let sum = simd.add_f64s(read::<S>(&displacement[k], part), sums[k]);
                write::<S>(&mut displacement[k], part, sum);
            }
        }
        displacement
    }
}

/// G without the near links, or `None` if blocks of equal offset differ.
///
/// The inner option is `None` if G without the near links is zero.
#[allow(clippy::option_option, reason = "the outer option says whether G is a lattice product")]
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
    /// Links between near elements; `None` if their number exceeds 32 bits.
    fn new(
        cells: &[[usize; 2]],
        is_near: impl Fn(usize, usize) -> bool,
        block: impl Fn(usize, usize) -> [[f64; 3]; 3],
        layer: impl Fn(usize) -> f64,
    ) -> Option<Self> {
        let count = cells.len();
        let mut links = Self { all: vec![], starts: vec![0], blocks: vec![] };
        // Index of the block for each offset, and for each layer of an element on itself.
        let mut block_indices = HashMap::new();
        for source in 0..count {
            for receiver in (0..count).filter(|receiver| is_near(*receiver, source)) {
                let mut block = block(receiver, source);
                let mut layer_bits = [0; 3];
                if receiver == source {
                    for (k, bits) in layer_bits.iter_mut().enumerate() {
                        let layer = layer(k * count + source);
                        block[k][k] += layer;
                        *bits = layer.to_bits();
                    }
                }
                let block_index = *block_indices
                    .entry((offset(cells[receiver], cells[source]), layer_bits))
                    .or_insert(u32::try_from(links.blocks.len()).ok()?);
                if block_index as usize == links.blocks.len() {
                    let columns = [0, 1, 2].map(|c| [block[0][c], block[1][c], block[2][c], 0.0]);
                    links.blocks.push(columns);
                }
                links.all.push(Link { element: u32::try_from(receiver).ok()?, block_index });
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
            let free_group = groups.iter_mut().find(|group| {
                group[LANE_COUNT - 1] == count
                    && !group.iter().any(|other| self.are_near(e, *other))
            });
            if let Some(group) = free_group {
                if let Some(free_lane) = group.iter_mut().find(|element| **element == count) {
                    *free_lane = e;
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

/// Adds displacements of all elements due to forces on near ones, and due to the structure.
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
            let group_forces = group_lanes(&blocks.groups[g], forces);
            blocks.add_group_forces(simd, g, &group_forces);
        }
    }
}

/// Values of a contact vector on the elements of a group.
///
/// One in each lane; zero in free lanes.
#[inline(always)]
fn group_lanes(group: &[usize; LANE_COUNT], vector: &[f64]) -> [Lane; 3] {
    let count = vector.len() / 3;
    [0, 1, 2].map(|k| group.map(|e| if e < count { vector[k * count + e] } else { 0.0 }))
}

/// Adds the displacement due to a force on a near element.
#[inline(always)]
fn add_displacement<S: Simd>(simd: S, block: &LinkBlock, force: [f64; 3], y: &mut [f64; 4]) {
    let (sums, tail) = S::as_mut_simd_f64s(y);
    for (k, force) in force.into_iter().enumerate() {
        let (column, rest) = S::as_simd_f64s(&block[k]);
        let splatted = simd.splat_f64s(force);
        for (sum, value) in sums.iter_mut().zip(column) {
            *sum = simd.mul_add_e_f64s(*value, splatted, *sum);
        }
        tail.iter_mut().zip(rest).for_each(|(sum, value)| *sum += value * force);
    }
}

#[cfg(test)]
mod tests;
