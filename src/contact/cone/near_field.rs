//! W of elements on a lattice, as blocks between near elements, a far field, and modes of the structure.
//!
//! | symbol | meaning |
//! |---|---|
//! | W = G + L Lᵀ | compliance of the contact elements, m/N |
//! | G | compliance of the soil, with the elements' elastic layers on its diagonal |
//! | L | displacements of the elements in the structure's few modes |
//!
//! The table of [`problem`](super::problem) explains r, r₀, ρ and y.
//!
//! Two elements are near each other if a force on one moves the other much ([`NEAR_FORCE_RATIO`]). Up to eight elements
//! that are not near each other form a group. A sweep projects the forces of a group together, one element in each
//! lane, and updates the displacements of the elements near them. After several sweeps a product by Fourier transforms
//! over the lattice updates the displacements of all others: the far-field correction.

#![allow(clippy::inline_always, reason = "to be compiled for the instructions of its caller")]

use std::collections::HashMap;

use super::group::{Group, GroupValues, LANE_COUNT, read, write};
use super::low_rank::{MAX_COMPLIANCE_MODES, compliance_modes};
use crate::geometry::offset;
use crate::linalg::{LatticeProduct, LatticeScratch, Simd, WithSimd, vectorized};

/// Smallest coupling of two elements that are near each other.
///
/// A unit force on one changes the trial force r − ρ y of the other by more than this.
const NEAR_FORCE_RATIO: f64 = 3e-3;
/// Largest number of near links, relative to all pairs of elements.
const MAX_NEAR_FRACTION: f64 = 0.3;
/// Number of near links, relative to all pairs, above which factors of W solve in less time than sweeps.
const FACTORED_NEAR_FRACTION: f64 = 0.05;
/// Largest number of elements for which factors of W fit into caches.
const MAX_FACTORED_ELEMENTS: usize = 600;

/// Displacements of an element due to unit forces on a near one, without those by the structure.
///
/// One row for each direction of the force; the fourth number of a row is zero.
type LinkBlock = [[f64; 4]; 3];

/// An element near another one, and the block of G between them.
#[derive(Debug, Clone, Copy)]
struct Link {
    element: u32,
    block_index: u32,
}

/// Links between near elements.
struct Links {
    /// Links of all elements, one element after the other.
    pairs: Vec<Link>,
    /// Index of the first link of each element, and the number of links.
    starts: Vec<usize>,
    /// Distinct blocks; links of equal offset use the same one.
    blocks: Vec<LinkBlock>,
}

/// W = G + L Lᵀ, split into near and far field, and the data of sweeps.
pub(super) struct NearFieldBlocks {
    /// Elements of each group; the number of all elements marks a free lane.
    pub(super) groups: Vec<[usize; LANE_COUNT]>,
    /// Data of the elements of each group in sweeps.
    pub(super) group_data: Vec<Group>,
    /// r − r₀ at the last far-field correction, N.
    pub(super) applied_change: Vec<f64>,
    /// Blocks of G between near elements.
    near: Links,
    /// G without the near links; `None` if it is zero.
    far: Option<LatticeProduct>,
    scratch: LatticeScratch,
    /// L of the elements of each group: for each mode, its three components.
    modes: Vec<[GroupValues; 3]>,
    mode_count: usize,
    /// Displacements of each element due to the soil, padded to four numbers.
    ///
    /// One more entry belongs to free lanes.
    displacements: Vec<[f64; 4]>,
    /// Modal amplitudes Lᵀ (r − r₀).
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
    /// Splits the row-major `w`, whose diagonal has the reciprocals `rho`, normal and tangential.
    ///
    /// `cells`: column and row of each element on the lattice. `soil(row, column)`: entry of the soil's compliance.
    /// `layer(row)`: compliance of an element's elastic layer. `None` if soil blocks of equal offset differ, too many
    /// elements are near each other, or the structure has too many modes.
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
        if near.pairs.len() as f64 > MAX_NEAR_FRACTION * (count * count) as f64 {
            return None;
        }
        let far = far_field(cells, is_near, block)?;
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
            && self.near.pairs.len() as f64 > FACTORED_NEAR_FRACTION * (count * count) as f64
    }

    /// Sets the displacements and the modal amplitudes to those due to `forces`, N.
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

    /// Adds the soil's displacements due to forces on elements that are not near.
    pub(super) fn add_far_displacements(&mut self, forces: &[f64]) {
        let Self { far, scratch, displacements, .. } = self;
        let Some(far) = far else { return };
        far.multiply(forces, scratch, |component, e, displacement| {
            displacements[e][component] += displacement;
        });
    }

    /// Adds the displacements due to forces on a group.
    ///
    /// The soil moves only near elements here; the structure moves all, through its modal amplitudes.
    #[inline(always)]
    pub(super) fn add_group_forces<S: Simd>(
        &mut self,
        simd: S,
        g: usize,
        forces: &[GroupValues; 3],
    ) {
        let Self { near, displacements, .. } = self;
        let [normal, along_x, along_y] = forces;
        for (lane, e) in self.groups[g].into_iter().enumerate() {
            let force = [normal[lane], along_x[lane], along_y[lane]];
            if force == [0.0; 3] {
                continue;
            }
            for link in near.of(e) {
                let block = &near.blocks[link.block_index as usize];
                add_displacement(simd, block, force, &mut displacements[link.element as usize]);
            }
        }
        let modes = &self.modes[g * self.mode_count..][..self.mode_count];
        for (amplitude, [mode_normal, mode_x, mode_y]) in self.amplitudes.iter_mut().zip(modes) {
            let mut sums = simd.splat_f64s(0.0);
            for register in 0..LANE_COUNT / S::F64_LANES {
                let mode_normal = read::<S>(mode_normal, register);
                let mode_x = read::<S>(mode_x, register);
                let mode_y = read::<S>(mode_y, register);
                sums = simd.mul_add_e_f64s(mode_normal, read::<S>(normal, register), sums);
                sums = simd.mul_add_e_f64s(mode_x, read::<S>(along_x, register), sums);
                sums = simd.mul_add_e_f64s(mode_y, read::<S>(along_y, register), sums);
            }
            *amplitude += simd.reduce_sum_f64s(sums);
        }
    }

    /// Displacements of the elements of a group.
    #[inline(always)]
    pub(super) fn displacement<S: Simd>(&self, simd: S, g: usize) -> [GroupValues; 3] {
        let mut displacement = [[0.0; LANE_COUNT]; 3];
        for (lane, e) in self.groups[g].into_iter().enumerate() {
            let soil_displacement = &self.displacements[e];
            for k in 0..3 {
                displacement[k][lane] = soil_displacement[k];
            }
        }
        let modes = &self.modes[g * self.mode_count..][..self.mode_count];
        for register in 0..LANE_COUNT / S::F64_LANES {
            let mut sums = [simd.splat_f64s(0.0); 3];
            for (amplitude, mode) in self.amplitudes.iter().zip(modes) {
                let amplitude = simd.splat_f64s(*amplitude);
                for k in 0..3 {
                    let values = read::<S>(&mode[k], register);
                    sums[k] = simd.mul_add_e_f64s(values, amplitude, sums[k]);
                }
            }
            for k in 0..3 {
                let sum = simd.add_f64s(read::<S>(&displacement[k], register), sums[k]);
                write::<S>(&mut displacement[k], register, sum);
            }
        }
        displacement
    }
}

/// G without the near links, or `None` if blocks of equal offset differ.
///
/// The inner option is `None` if G without the near links is zero.
#[allow(clippy::option_option, reason = "the outer option says whether G is a lattice product")]
fn far_field(
    cells: &[[usize; 2]],
    is_near: impl Fn(usize, usize) -> bool,
    block: impl Fn(usize, usize) -> [[f64; 3]; 3],
) -> Option<Option<LatticeProduct>> {
    let far_block = |receiver: usize, source: usize| {
        if is_near(receiver, source) { [[0.0; 3]; 3] } else { block(receiver, source) }
    };
    let mut pairs = (0..cells.len()).flat_map(|e| (0..cells.len()).map(move |other| (e, other)));
    if pairs.all(|(receiver, source)| far_block(receiver, source) == [[0.0; 3]; 3]) {
        return Some(None);
    }
    LatticeProduct::new(cells, &vec![1.0; cells.len()], far_block).map(Some)
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
        let mut near = Self { pairs: vec![], starts: vec![0], blocks: vec![] };
        // Index of the block for each offset; at offset zero also for each compliance of an element's layer.
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
                    .or_insert(u32::try_from(near.blocks.len()).ok()?);
                if block_index as usize == near.blocks.len() {
                    let columns = [0, 1, 2].map(|c| [block[0][c], block[1][c], block[2][c], 0.0]);
                    near.blocks.push(columns);
                }
                near.pairs.push(Link { element: u32::try_from(receiver).ok()?, block_index });
            }
            near.starts.push(near.pairs.len());
        }
        Some(near)
    }

    /// Links from the element `e` to the elements near it, itself included.
    #[inline(always)]
    fn of(&self, e: usize) -> &[Link] {
        &self.pairs[self.starts[e]..self.starts[e + 1]]
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

/// Product with W without the far field: adds the displacements and modal amplitudes due to `forces`.
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

/// Components of a contact vector on the elements of a group.
///
/// The vector has one component of all elements after the other. Free lanes have zeros.
#[inline(always)]
fn group_lanes(group: &[usize; LANE_COUNT], vector: &[f64]) -> [GroupValues; 3] {
    let count = vector.len() / 3;
    [0, 1, 2].map(|k| group.map(|e| if e < count { vector[k * count + e] } else { 0.0 }))
}

/// Adds the displacement due to a force on a near element.
#[inline(always)]
fn add_displacement<S: Simd>(
    simd: S,
    block: &LinkBlock,
    force: [f64; 3],
    displacement: &mut [f64; 4],
) {
    let (sums, tail) = S::as_mut_simd_f64s(displacement);
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
