//! Overhang of cells under a flexible mat.
//!
//! The pressure under a stiff mat rises towards the edge, but the pressure on a cell is constant. Cells that extend beyond
//! the outline compensate for this error. Near its edge a mat is stiff over a distance of (D/G)^(1/3), so that the
//! overhang depends on the ratio x of this distance to the side of a cell:
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
//! D follows from the structure's stiffness matrix, with degrees of freedom far from the base restrained. For loads p that
//! vary as waves with the wavenumber k, the soil acts as springs s = G k/(1 − ν) (Pa/m). The displacement of the mat on
//! these springs is p/(D k⁴ + s).

use super::outline::RIGID_MAT_OVERHANG;
use crate::linalg::{SparseFactor, SparseMatrix, dot};
use crate::soil::Soil;
use crate::structure::{BaseNode, DofCombination, Triplets};

/// Number of overhangs above zero to which the overhang is rounded.
///
/// Grounds under mats of similar stiffness then share their convolution weights, and a very stiff mat has the cells of a
/// rigid one.
const OVERHANG_STEP_COUNT: f64 = 7.0;
/// Number of layers of elements above the base with free degrees of freedom.
///
/// The others are restrained, so that a mat of more layers has a large stiffness.
const FREE_ELEMENT_LAYERS: usize = 6;
/// Ratio of D to the stiffness against waves on a mat with free edges.
///
/// The ratio is between 1 and 3 for mats of a few wavelengths.
const FREE_EDGE_FACTOR: f64 = 1.5;
/// Stiffness added to each degree of freedom, relative to the largest entry, so that the matrix is not singular.
const RESTRAINT_FACTOR: f64 = 1e-13;
/// Name of the structure's stiffness matrix in errors.
pub(super) const STIFFNESS_MATRIX_NAME: &str = "stiffness matrix";

/// Overhang and rigidity of a flexible mat, which determine its cells.
#[derive(Clone, Copy)]
pub(super) struct EdgeStiffness {
    /// Overhang of the outer cells, as a fraction of a cell.
    pub(super) overhang: f64,
    /// Relative rigidity D/(G R³).
    pub(super) rigidity: f64,
}

/// Overhang and rigidity of a flexible mat on cells with sides of `side` (m).
///
/// `faces`: corners and area of each face of the mat.
pub(super) fn edge_stiffness(
    stiffness: &SparseMatrix,
    faces: &[(&[BaseNode], f64)],
    soil: &Soil,
    side: f64,
) -> EdgeStiffness {
    let corners = MatCorners::of(faces);
    let wavenumber = std::f64::consts::FRAC_PI_2 / side.max(corners.spacing);
    let spring_stiffness = soil.shear_modulus() * wavenumber / (1.0 - soil.poisson());
    let stiffness_ratio =
        FREE_EDGE_FACTOR * corners.stiffness_ratio(stiffness, spring_stiffness, wavenumber);
    let x_cubed = stiffness_ratio / ((1.0 - soil.poisson()) * (wavenumber * side).powi(3));
    let x_squared = x_cubed.powf(2.0 / 3.0);
    let fraction = if x_squared.is_finite() { x_squared / (1.0 + x_squared) } else { 1.0 };
    let rounded_fraction = (OVERHANG_STEP_COUNT * fraction).round() / OVERHANG_STEP_COUNT;
    let area: f64 = faces.iter().map(|(_, area)| area).sum();
    let rigidity = x_cubed * (side / (area / std::f64::consts::PI).sqrt()).powi(3);
    EdgeStiffness {
        overhang: RIGID_MAT_OVERHANG * rounded_fraction,
        rigidity: rigidity.min(f64::MAX),
    }
}

/// Mean side of the faces of a mat, m; two triangles count as one face.
///
/// `faces`: corners and area of each face.
pub(super) fn mean_side(faces: &[(&[BaseNode], f64)]) -> f64 {
    let face_count: f64 = faces.iter().map(|(corners, _)| 0.5 * (corners.len() as f64 - 2.0)).sum();
    let area: f64 = faces.iter().map(|(_, area)| area).sum();
    (area / face_count).sqrt()
}

/// Corners of the faces of a mat.
struct MatCorners<'a> {
    /// Corners of all faces, each with its tributary area, m².
    corners: Vec<(&'a BaseNode, f64)>,
    /// Mean side of a face, m.
    spacing: f64,
}

impl<'a> MatCorners<'a> {
    /// Corners of `faces`, a list of the corners and the area of each face.
    fn of(faces: &[(&'a [BaseNode], f64)]) -> Self {
        let mut all_corners = vec![];
        for &(corners, area) in faces {
            for corner in corners {
                all_corners.push((corner, area / corners.len() as f64));
            }
        }
        Self { corners: all_corners, spacing: mean_side(faces) }
    }

    /// Stiffness of the mat relative to the soil's, for loads that vary as waves along x and along y.
    ///
    /// `spring_stiffness`: stiffness of the soil for these waves, Pa/m. The ratio is zero for a singular or indefinite
    /// matrix, because the build returns an error for the structure.
    fn stiffness_ratio(
        &self,
        matrix: &SparseMatrix,
        spring_stiffness: f64,
        wavenumber: f64,
    ) -> f64 {
        let free_dofs = self.free_dof_indices(matrix);
        let order = free_dofs.iter().flatten().count();
        let mut triplets = Triplets::new(order);
        let mut max_entry = 0.0_f64;
        for (row, column, value) in matrix.entries() {
            if let Some((free_row, free_column)) = free_dofs[row].zip(free_dofs[column]) {
                max_entry = max_entry.max(value.abs());
                triplets.add(free_row, free_column, value);
            }
        }
        for (corner, area) in &self.corners {
            for combination in corner.rows() {
                triplets.add_outer(free_terms(combination, &free_dofs), spring_stiffness * area);
            }
        }
        for dof in 0..order {
            triplets.add(dof, dof, RESTRAINT_FACTOR * max_entry);
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
                    spring_compliance += area * pressure * pressure / spring_stiffness;
                }
                let mut displacement = force.clone();
                factor.solve(&mut displacement);
                compliance += dot(&force, &displacement);
            }
        }
        if compliance > 0.0 { (spring_compliance / compliance - 1.0).max(0.0) } else { 0.0 }
    }

    /// Index of each free degree of freedom among the free ones, all near the base; `None` for restrained ones.
    fn free_dof_indices(&self, matrix: &SparseMatrix) -> Vec<Option<usize>> {
        let mut is_free = vec![false; matrix.order()];
        for dof in self.corners.iter().flat_map(|(corner, _)| corner.dofs()) {
            is_free[dof] = true;
        }
        for _ in 0..FREE_ELEMENT_LAYERS {
            let was_free = is_free.clone();
            for (row, column, value) in matrix.entries() {
                if value != 0.0 && was_free[row] {
                    is_free[column] = true;
                }
            }
        }
        let mut free_dofs = vec![None; is_free.len()];
        let mut free_count = 0;
        for (dof, free_dof) in free_dofs.iter_mut().enumerate() {
            if is_free[dof] {
                *free_dof = Some(free_count);
                free_count += 1;
            }
        }
        free_dofs
    }

    /// Pressures at the corners: a wave along an axis minus its best linear fit.
    fn load_wave(&self, axis: usize, wavenumber: f64, phase: f64) -> Vec<f64> {
        let middle = [0, 1].map(|k| {
            let mut moment = 0.0;
            let mut total_area = 0.0;
            for (corner, area) in &self.corners {
                moment += area * corner.place()[k];
                total_area += area;
            }
            moment / total_area
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
            let (orthogonal, remaining) = basis.split_at_mut(n);
            self.make_orthogonal(&mut remaining[0], orthogonal);
        }
        self.make_orthogonal(&mut wave, &basis);
        wave
    }

    /// Subtracts the projections of a vector on `basis`, weighted by area (Gram–Schmidt).
    fn make_orthogonal(&self, vector: &mut [f64], basis: &[Vec<f64>]) {
        for direction in basis {
            let factor =
                self.area_product(direction, vector) / self.area_product(direction, direction);
            for (value, component) in vector.iter_mut().zip(direction) {
                *value -= factor * component;
            }
        }
    }

    /// Integral over the mat of the product of two functions f and g, from their values at the corners.
    fn area_product(&self, f: &[f64], g: &[f64]) -> f64 {
        let terms = self.corners.iter().zip(f).zip(g);
        terms.map(|(((_, area), f), g)| area * f * g).sum()
    }
}

/// Terms of a combination of degrees of freedom that are free, with their indices among the free ones.
fn free_terms(combination: &DofCombination, free_dofs: &[Option<usize>]) -> Vec<(usize, f64)> {
    combination
        .iter()
        .filter_map(|&(dof, weight)| Some((free_dofs[dof]?, weight)))
        .collect()
}
