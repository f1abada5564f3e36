//! Overhang of cells under a flexible mat.
//!
//! Constant pressures on cells cannot rise at the edge as the pressure under a stiff mat does. Cells that extend beyond
//! the outline make up for it. Near its edge a mat is stiff over a distance of (D/G)^(1/3), so that the overhang depends
//! on this distance relative to a cell:
//!
//! | symbol | meaning |
//! |---|---|
//! | D | bending stiffness of the mat, N·m |
//! | G, ν | shear modulus and Poisson's ratio of the soil at the surface |
//! | h | side of a cell, m |
//! | x | (D/(G h³))^(1/3) |
//! | d | overhang in cells, 0.105 x²/(1 + x²) in steps of 0.015 |
//! | R | radius of a disc of the mat's area, m |
//!
//! D follows from the structure's stiffness matrix. Waves of load p with the wavenumber k bend a mat on springs
//! s = G k/(1 − ν), the stiffness of the soil for these waves, by p/(D k⁴ + s). Degrees of freedom far from the base are
//! restrained.

use super::outline::RIGID_MAT_OVERHANG;
use crate::linalg::{SparseFactor, SparseMatrix, dot};
use crate::soil::Soil;
use crate::structure::{BaseNode, DofCombination, Triplets};

/// Number of different overhangs above zero.
///
/// Grounds under mats of similar stiffness then share their convolution weights, and a very stiff mat has the cells of a
/// rigid one.
const OVERHANG_STEP_COUNT: f64 = 7.0;
/// Number of layers of elements above the base whose degrees of freedom are free. A mat of more layers is stiff.
const FREE_ELEMENT_LAYERS: usize = 6;
/// Ratio of D to the stiffness against waves on a mat of a few wavelengths with free edges; it is 1 to 3.
const FREE_EDGE_FACTOR: f64 = 1.5;
/// Stiffness added to each degree of freedom, relative to the largest entry, for a structure with a mechanism.
const RESTRAINT_FACTOR: f64 = 1e-13;
/// Name of the structure's stiffness matrix in errors.
pub(super) const STIFFNESS_MATRIX_NAME: &str = "stiffness matrix";

/// Stiffness of a flexible mat near its edge.
#[derive(Clone, Copy)]
pub(super) struct EdgeStiffness {
    /// Overhang of the outer cells, as a fraction of a cell.
    pub(super) overhang: f64,
    /// D/(G R³).
    pub(super) rigidity: f64,
}

/// Overhang and rigidity of the flexible mat of these faces on cells with sides of `side` (m).
pub(super) fn edge_stiffness(
    stiffness: &SparseMatrix,
    faces: &[(&[BaseNode], f64)],
    soil: &Soil,
    side: f64,
) -> EdgeStiffness {
    let corners = MatCorners::of(faces);
    let wavenumber = std::f64::consts::FRAC_PI_2 / side.max(corners.spacing);
    let springs = soil.shear_modulus() * wavenumber / (1.0 - soil.poisson());
    let ratio = FREE_EDGE_FACTOR * corners.stiffness_ratio(stiffness, springs, wavenumber);
    let x_cubed = ratio / ((1.0 - soil.poisson()) * (wavenumber * side).powi(3));
    let x_squared = x_cubed.powf(2.0 / 3.0);
    let fraction = if x_squared.is_finite() { x_squared / (1.0 + x_squared) } else { 1.0 };
    let rounded = (OVERHANG_STEP_COUNT * fraction).round() / OVERHANG_STEP_COUNT;
    let area: f64 = faces.iter().map(|(_, area)| area).sum();
    let rigidity = x_cubed * (side / (area / std::f64::consts::PI).sqrt()).powi(3);
    EdgeStiffness { overhang: RIGID_MAT_OVERHANG * rounded, rigidity: rigidity.min(f64::MAX) }
}

/// Mean side (m) of the faces of a mat, from corners and area of each; two triangles count as one face.
pub(super) fn mean_side(faces: &[(&[BaseNode], f64)]) -> f64 {
    let face_count: f64 = faces.iter().map(|(corners, _)| 0.5 * (corners.len() as f64 - 2.0)).sum();
    let area: f64 = faces.iter().map(|(_, area)| area).sum();
    (area / face_count).sqrt()
}

/// Corners of the faces of a mat.
struct MatCorners<'a> {
    /// Each corner with its part of the area, m².
    corners: Vec<(&'a BaseNode, f64)>,
    /// Mean side of a face, m.
    spacing: f64,
}

impl<'a> MatCorners<'a> {
    /// `faces`: corners and area of each.
    fn of(faces: &[(&'a [BaseNode], f64)]) -> Self {
        let mut all_corners = vec![];
        for &(corners, area) in faces {
            for corner in corners {
                all_corners.push((corner, area / corners.len() as f64));
            }
        }
        Self { corners: all_corners, spacing: mean_side(faces) }
    }

    /// Stiffness of the mat relative to `springs` (Pa/m) for waves of load along x and along y.
    ///
    /// Zero for a singular or indefinite matrix: the build returns an error for the structure.
    fn stiffness_ratio(&self, matrix: &SparseMatrix, springs: f64, wavenumber: f64) -> f64 {
        let free_dofs = self.number_free_dofs(matrix);
        let order = free_dofs.iter().flatten().count();
        let mut triplets = Triplets::new(order);
        let mut largest = 0.0_f64;
        for (row, column, value) in matrix.entries() {
            if let Some((row, column)) = free_dofs[row].zip(free_dofs[column]) {
                largest = largest.max(value.abs());
                triplets.add(row, column, value);
            }
        }
        for (corner, area) in &self.corners {
            for row in corner.rows() {
                triplets.add_outer(free_terms(row, &free_dofs), springs * area);
            }
        }
        for dof in 0..order {
            triplets.add(dof, dof, RESTRAINT_FACTOR * largest);
        }
        let Ok(mut factor) = SparseFactor::new(STIFFNESS_MATRIX_NAME, &triplets) else {
            return 0.0;
        };
        let mut compliance = 0.0;
        let mut spring_compliance = 0.0;
        for axis in 0..2 {
            for phase in [0.0, std::f64::consts::FRAC_PI_2] {
                let wave = self.load_wave(axis, wavenumber, phase);
                let mut force = vec![0.0; order];
                for ((corner, area), pressure) in self.corners.iter().zip(&wave) {
                    for (dof, weight) in free_terms(&corner.vertical, &free_dofs) {
                        force[dof] += weight * area * pressure;
                    }
                    spring_compliance += area * pressure * pressure / springs;
                }
                let mut displacement = force.clone();
                factor.solve(&mut displacement);
                compliance += dot(&force, &displacement);
            }
        }
        if compliance > 0.0 { (spring_compliance / compliance - 1.0).max(0.0) } else { 0.0 }
    }

    /// Number of each free degree of freedom, near the base; `None` for restrained ones.
    fn number_free_dofs(&self, matrix: &SparseMatrix) -> Vec<Option<usize>> {
        let mut is_free = vec![false; matrix.order()];
        for dof in self.corners.iter().flat_map(|(corner, _)| corner.dofs()) {
            is_free[dof] = true;
        }
        for _ in 0..FREE_ELEMENT_LAYERS {
            let inner = is_free.clone();
            for (row, column, value) in matrix.entries() {
                if value != 0.0 && inner[row] {
                    is_free[column] = true;
                }
            }
        }
        let mut numbers = vec![None; is_free.len()];
        let mut count = 0;
        for (dof, number) in numbers.iter_mut().enumerate() {
            if is_free[dof] {
                *number = Some(count);
                count += 1;
            }
        }
        numbers
    }

    /// Pressure at each corner: a wave along an axis without its best linear fit.
    fn load_wave(&self, axis: usize, wavenumber: f64, phase: f64) -> Vec<f64> {
        let middle = [0, 1].map(|k| {
            let mut moment = 0.0;
            let mut total = 0.0;
            for (corner, area) in &self.corners {
                moment += area * corner.place()[k];
                total += area;
            }
            moment / total
        });
        let mut basis = [vec![], vec![], vec![]];
        let mut wave = vec![];
        for (corner, _) in &self.corners {
            let arms = [0, 1].map(|k| corner.place()[k] - middle[k]);
            basis[0].push(1.0);
            basis[1].push(arms[0]);
            basis[2].push(arms[1]);
            wave.push((wavenumber * arms[axis] + phase).cos());
        }
        for n in 1..basis.len() {
            let (previous, rest) = basis.split_at_mut(n);
            self.make_orthogonal(&mut rest[0], previous);
        }
        self.make_orthogonal(&mut wave, &basis);
        wave
    }

    /// Subtracts the projections on `basis`, with the area as weight (Gram–Schmidt).
    fn make_orthogonal(&self, vector: &mut [f64], basis: &[Vec<f64>]) {
        for direction in basis {
            let factor =
                self.area_product(direction, vector) / self.area_product(direction, direction);
            for (value, component) in vector.iter_mut().zip(direction) {
                *value -= factor * component;
            }
        }
    }

    /// Integral of a product over the mat.
    fn area_product(&self, one: &[f64], other: &[f64]) -> f64 {
        let terms = self.corners.iter().zip(one).zip(other);
        terms.map(|(((_, area), one), other)| area * one * other).sum()
    }
}

/// Terms of a combination in free degrees of freedom, by their numbers.
fn free_terms(combination: &DofCombination, free_dofs: &[Option<usize>]) -> Vec<(usize, f64)> {
    combination
        .iter()
        .filter_map(|&(dof, weight)| Some((free_dofs[dof]?, weight)))
        .collect()
}
