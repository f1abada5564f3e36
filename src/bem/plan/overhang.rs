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
//! The structure's stiffness matrix contains D. Waves of load p with the wavenumber k bend a mat on springs s = G k/(1 − ν),
//! the stiffness of the soil for these waves, by p/(D k⁴ + s). Degrees of freedom far from the base are held.

use super::outline::OVERHANG;
use crate::linalg::{SparseFactor, SparseMatrix, dot};
use crate::soil::Soil;
use crate::structure::{BaseNode, DofCombination, Triplets};

/// Number of different overhangs above zero.
///
/// Grounds under mats of similar stiffness then share their convolution weights, and a very stiff mat has the cells of a
/// rigid one.
const STEPS: f64 = 7.0;
/// Elements from the base to the first degrees of freedom that are held. A mat of more layers is stiff.
const RINGS: usize = 6;
/// Ratio of D to the stiffness that waves on a mat of a few wavelengths show, free edges included: 1 to 3.
const EDGES: f64 = 1.5;
/// Stiffness added to each degree of freedom, relative to the largest entry, for a structure with a mechanism.
const HELD: f64 = 1e-13;
pub(super) const NAME: &str = "stiffness matrix";

/// Overhang under the flexible mat of these faces on cells with sides of `side` (m), as a fraction of a cell, and D/(G R³).
pub(super) fn overhang(
    stiffness: &SparseMatrix,
    faces: &[(&[BaseNode], f64)],
    soil: &Soil,
    side: f64,
) -> [f64; 2] {
    let points = Points::of(faces);
    let wavenumber = std::f64::consts::FRAC_PI_2 / side.max(points.spacing);
    let springs = soil.shear_modulus() * wavenumber / (1.0 - soil.poisson());
    let ratio = EDGES * points.stiffness(stiffness, springs, wavenumber);
    let cubed = ratio / ((1.0 - soil.poisson()) * (wavenumber * side).powi(3));
    let squared = cubed.powf(2.0 / 3.0);
    let part = if squared.is_finite() { squared / (1.0 + squared) } else { 1.0 };
    let area: f64 = faces.iter().map(|(_, area)| area).sum();
    let rigidity = cubed * (side / (area / std::f64::consts::PI).sqrt()).powi(3);
    [OVERHANG * ((STEPS * part).round() / STEPS), rigidity.min(f64::MAX)]
}

/// Mean side (m) of the faces of a mat, from corners and area of each; two triangles count as one face.
pub(super) fn mean_side(faces: &[(&[BaseNode], f64)]) -> f64 {
    let pieces: f64 = faces.iter().map(|(own, _)| 0.5 * (own.len() as f64 - 2.0)).sum();
    let area: f64 = faces.iter().map(|(_, area)| area).sum();
    (area / pieces).sqrt()
}

/// Corners of the faces of a mat.
struct Points<'a> {
    /// Each corner with its part of the area, m².
    corners: Vec<(&'a BaseNode, f64)>,
    /// Mean side of a face, m.
    spacing: f64,
}

impl<'a> Points<'a> {
    /// `faces`: corners and area of each.
    fn of(faces: &[(&'a [BaseNode], f64)]) -> Self {
        let corners = faces.iter().flat_map(|&(corners, area)| {
            let own = area / corners.len() as f64;
            corners.iter().map(move |corner| (corner, own))
        });
        Self { corners: corners.collect(), spacing: mean_side(faces) }
    }

    /// Stiffness of the mat relative to `springs` (Pa/m) for waves of load along x and along y.
    ///
    /// Zero for a singular or indefinite matrix: the build returns an error for the structure.
    fn stiffness(&self, matrix: &SparseMatrix, springs: f64, wavenumber: f64) -> f64 {
        let number = self.near(matrix);
        let order = number.iter().flatten().count();
        let mut near = Triplets::new(order);
        let mut largest = 0.0_f64;
        for (row, column, value) in matrix.entries() {
            if let Some((row, column)) = number[row].zip(number[column]) {
                largest = largest.max(value.abs());
                near.add(row, column, value);
            }
        }
        let own = |row: &DofCombination| -> Vec<(usize, f64)> {
            row.iter().filter_map(|&(dof, weight)| Some((number[dof]?, weight))).collect()
        };
        for (corner, area) in &self.corners {
            corner.rows().into_iter().for_each(|row| near.add_outer(own(row), springs * area));
        }
        (0..order).for_each(|dof| near.add(dof, dof, HELD * largest));
        let Ok(mut factor) = SparseFactor::new(NAME, &near) else { return 0.0 };
        let mut compliance = 0.0;
        let mut whole = 0.0;
        for axis in 0..2 {
            for phase in [0.0, std::f64::consts::FRAC_PI_2] {
                let waves = self.waves(axis, wavenumber, phase);
                let mut force = vec![0.0; order];
                for ((corner, area), value) in self.corners.iter().zip(&waves) {
                    for (dof, weight) in own(&corner.vertical) {
                        force[dof] += weight * area * value;
                    }
                    whole += area * value * value / springs;
                }
                let mut displacement = force.clone();
                factor.solve(&mut displacement);
                compliance += dot(&force, &displacement);
            }
        }
        if compliance > 0.0 { (whole / compliance - 1.0).max(0.0) } else { 0.0 }
    }

    /// Number of each degree of freedom near the base; `None` for the others.
    fn near(&self, matrix: &SparseMatrix) -> Vec<Option<usize>> {
        let mut is_near = vec![false; matrix.order()];
        for dof in self.corners.iter().flat_map(|(corner, _)| corner.dofs()) {
            is_near[dof] = true;
        }
        for _ in 0..RINGS {
            let inner = is_near.clone();
            for (row, column, value) in matrix.entries() {
                if value != 0.0 && inner[row] {
                    is_near[column] = true;
                }
            }
        }
        let mut count = 0;
        let next = |is_near: bool| {
            count += usize::from(is_near);
            is_near.then(|| count - 1)
        };
        is_near.into_iter().map(next).collect()
    }

    /// Pressure at each corner: a wave along an axis without its best linear fit.
    fn waves(&self, axis: usize, wavenumber: f64, phase: f64) -> Vec<f64> {
        let mut basis: Vec<Vec<f64>> = vec![];
        let product = |one: &[f64], other: &[f64]| -> f64 {
            let terms = self.corners.iter().zip(one).zip(other);
            terms.map(|(((_, area), one), other)| area * one * other).sum()
        };
        let of = |value: &dyn Fn(&BaseNode) -> f64| -> Vec<f64> {
            self.corners.iter().map(|(corner, _)| value(corner)).collect()
        };
        let middle = [0, 1].map(|k| {
            let sum = self.corners.iter().fold([0.0; 2], |sum, (corner, area)| {
                [sum[0] + area * corner.place()[k], sum[1] + area]
            });
            sum[0] / sum[1]
        });
        let place = |k: usize| move |corner: &BaseNode| corner.place()[k] - middle[k];
        for mut column in [
            of(&|_| 1.0),
            of(&place(0)),
            of(&place(1)),
            of(&|corner| (wavenumber * place(axis)(corner) + phase).cos()),
        ] {
            for known in &basis {
                let part = product(known, &column) / product(known, known);
                column.iter_mut().zip(known).for_each(|(x, known)| *x -= part * known);
            }
            basis.push(column);
        }
        basis.pop().unwrap_or_default()
    }
}
