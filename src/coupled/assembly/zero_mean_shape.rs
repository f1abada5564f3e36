//! Softest shape of a base with zero mean displacement on every element.
//!
//! Symbols: see `flexible_base.rs`.

use std::ops::Range;

use super::at_rest::StaticGround;
use crate::coupled::base::PlacedBase;
use crate::coupled::model::assembled::Assembled;
use crate::coupled::parts::Parts;
use crate::coupled::statics::compliance::Compliance;
use crate::geometry::ContactElement;
use crate::linalg::{CompressedMatrix, DenseFactor, SparseMatrix, dot, transposed_multiply_add};
use crate::structure::{BaseNode, Triplets};

/// Largest order of the compliance of a base that is refined.
///
/// It limits time and memory of the check.
const MAX_REFINED_ORDER: usize = 3600;
/// Name in errors of the stiffness with springs for deviations from element means.
const FIXED_MEANS_STIFFNESS_NAME: &str = "stiffness matrix with fixed contact elements";
/// Stiffness of the springs that fix element means, relative to the soil.
const MEAN_SPRING_FACTOR: f64 = 1e4;
/// Largest number of power iterations for ρ.
const MAX_POWER_ITERATIONS: usize = 20;
/// Relative change of ρ at which the power iteration ends: an estimate is sufficient.
const POWER_ITERATION_TOLERANCE: f64 = 0.01;

/// Softest shape of a base with zero mean displacement on every element.
pub(super) struct ZeroMeanShape {
    /// Ratio ρ of the stiffnesses of structure and soil.
    pub(super) stiffness_ratio: f64,
    /// Number of the face with the largest deformation.
    pub(super) face: usize,
}

/// Faces of the foundations.
///
/// Each has the number and the nodes of its foundation, and the elements of the face.
///
/// A foundation without walls is one face.
pub(super) fn faces(base: &PlacedBase) -> impl Iterator<Item = (usize, &[BaseNode], Range<usize>)> {
    base.foundations().enumerate().flat_map(|(foundation, (nodes, elements))| {
        let faces = ContactElement::faces(base.elements()).in_order().into_iter();
        let ranges =
            faces.map(move |face| face.start.max(elements.start)..face.end.min(elements.end));
        ranges.filter(|range| !range.is_empty()).map(move |range| (foundation, nodes, range))
    })
}

/// A base on twice the elements, four times in plan.
pub(super) struct RefinedBase {
    pub(super) base: PlacedBase,
    /// Static compliance of the ground on its elements.
    pub(super) ground_compliance: CompressedMatrix,
}

impl RefinedBase {
    /// Refines the elements of a base.
    ///
    /// `None` if the compliance is unknown, or too large for a check.
    pub(super) fn new(parts: &Parts, base: &PlacedBase) -> Option<Self> {
        let patch = base.elements();
        if patch[0].parts().count() * patch.layout().len() > MAX_REFINED_ORDER {
            return None;
        }
        let refined_patch = patch.refined().ok()?;
        let mut compliance = parts.ground.finer_compliance().ok()??;
        if compliance.len() != refined_patch.layout().matrix_len() {
            return None;
        }
        refined_patch.refer_inside(&mut compliance);
        let base = PlacedBase::of(parts.structure.as_ref(), &refined_patch, &parts.joints).ok()?;
        Some(Self {
            ground_compliance: CompressedMatrix::dense(base.spread_ground_matrix(compliance)),
            base,
        })
    }
}

impl ZeroMeanShape {
    /// The shape with the smallest ρ on a ground.
    ///
    /// `None` if there is no such shape.
    ///
    /// `halves`: see [`soil_moduli`].
    pub(super) fn softest(
        assembled: &Assembled,
        base: &PlacedBase,
        ground: StaticGround<'_>,
        halves: Option<&RefinedBase>,
    ) -> Option<Self> {
        let dofs = assembled.dofs();
        let layout = base.layout();
        let moduli = soil_moduli(base, ground.compliance, halves);
        let mut deviation_springs = Triplets::new(dofs);
        for (point, rows) in base.deviations() {
            for (component, row) in rows.iter().enumerate() {
                let modulus = moduli[layout.index_of(component, point.element)];
                deviation_springs.add_outer(row, modulus * point.area);
            }
        }
        let deviation_stiffness =
            SparseMatrix::new(FIXED_MEANS_STIFFNESS_NAME, &deviation_springs).ok()?;
        let compliance = ground.shared_compliance.borrow();
        let Compliance { factor, traction_responses, delassus, .. } = compliance.as_ref()?;
        let mut spring_matrix = factored_spring_matrix(&moduli, delassus, ground.compliance)?;
        let mut traction = vec![0.0; layout.len()];
        // The initial vector has entries of mixed signs and magnitudes. The iteration ends some per cent above the
        // smallest ratio.
        let mut shape: Vec<f64> = (0..dofs).map(|i| (1.0 + i as f64).sin() + 0.5).collect();
        let mut stiffness_ratio = f64::INFINITY;
        for _ in 0..MAX_POWER_ITERATIONS {
            let mut force = vec![0.0; dofs];
            deviation_stiffness.multiply_add(1.0, &shape, &mut force);
            let norm = dot(&shape, &force).sqrt();
            if !(norm.is_finite() && norm > 0.0) {
                return None;
            }
            for f in &mut force {
                *f /= norm;
            }
            shape.copy_from_slice(&force);
            factor.factor.solve_many(&mut shape);
            base.means(&shape, &mut traction);
            for (value, modulus) in traction.iter_mut().zip(&moduli) {
                *value *= MEAN_SPRING_FACTOR * modulus;
            }
            spring_matrix.solve(&mut traction);
            transposed_multiply_add(traction_responses, -1.0, &traction, &mut shape);
            let next_ratio = 1.0 / deviation_stiffness.form(&shape, &shape).sqrt();
            let previous_ratio = std::mem::replace(&mut stiffness_ratio, next_ratio);
            if (previous_ratio / stiffness_ratio - 1.0).abs() < POWER_ITERATION_TOLERANCE {
                break;
            }
        }
        if !stiffness_ratio.is_finite() {
            return None;
        }
        Some(Self { stiffness_ratio, face: most_deformed_face(base, &moduli, &shape) })
    }
}

/// Number of the face with the largest energy of deviations from element means.
fn most_deformed_face(base: &PlacedBase, moduli: &[f64], shape: &[f64]) -> usize {
    let mut energies = vec![0.0; faces(base).count()];
    for (point, rows) in base.deviations() {
        let face = faces(base).position(|(.., elements)| elements.contains(&point.element));
        for (component, row) in rows.iter().enumerate() {
            let value: f64 = row.iter().map(|&(dof, weight)| weight * shape[dof]).sum();
            let modulus = moduli[base.layout().index_of(component, point.element)];
            energies[face.unwrap_or(0)] += modulus * point.area * value * value;
        }
    }
    let largest_energy = energies.iter().enumerate().max_by(|a, b| a.1.total_cmp(b.1));
    largest_energy.map_or(0, |(face, _)| face)
}

/// Factored matrix of springs that fix the element means.
///
/// It is 1 + MEAN_SPRING_FACTOR · modulus · D, with the structure's part D of the Delassus operator.
///
/// The right-hand sides are the element means without springs, times MEAN_SPRING_FACTOR · modulus. The solutions are
/// the tractions of springs that fix the element means.
fn factored_spring_matrix(
    moduli: &[f64],
    delassus: &[f64],
    ground_compliance: &[f64],
) -> Option<DenseFactor> {
    let order = moduli.len();
    let mut matrix = Vec::with_capacity(order * order);
    for k in 0..order * order {
        let entry = MEAN_SPRING_FACTOR * moduli[k / order] * (delassus[k] - ground_compliance[k]);
        matrix.push(if k.is_multiple_of(order + 1) { 1.0 + entry } else { entry });
    }
    let mut factor = DenseFactor::with_capacity(order);
    factor.factor(&matrix, order).then_some(factor)
}

/// Stiffness of the soil under each element in each component, Pa/m.
///
/// It is the stiffness for tractions that change sign from an element to its neighbour, as waves of twice the elements'
/// length do. On a face with one element the sign changes between the `halves` of this element.
fn soil_moduli(
    base: &PlacedBase,
    ground_compliance: &[f64],
    halves: Option<&RefinedBase>,
) -> Vec<f64> {
    let layout = base.layout();
    let faces: Vec<_> = faces(base).map(|(.., elements)| elements).collect();
    let mut moduli = Vec::with_capacity(layout.len());
    for i in 0..layout.len() {
        let [component, e] = layout.component_and_element(i);
        let face = faces.iter().position(|elements| elements.contains(&e));
        let face_elements = face.map_or(e..e + 1, |face| faces[face].clone());
        let neighbours = [e.checked_sub(1), Some(e + 1)].into_iter().flatten();
        let mut compliance = neighbours
            .filter(|neighbour| face_elements.contains(neighbour))
            .map(|neighbour| {
                alternating_compliance(base, ground_compliance, component, [e, neighbour])
            })
            .fold(ground_compliance[i * layout.len() + i], f64::min);
        if let (1, Some(refined), Some(face)) = (face_elements.len(), halves, face) {
            let RefinedBase { base, ground_compliance } = refined;
            let refined_elements =
                self::faces(base).nth(face).map_or(0..1, |(.., elements)| elements);
            let first_half = refined_elements.start;
            for other_half in first_half + 1..refined_elements.end {
                let pair = [first_half, other_half];
                let value = alternating_compliance(base, ground_compliance, component, pair);
                compliance = f64::min(compliance, value);
            }
        }
        moduli.push(if compliance > 0.0 { compliance.recip() } else { 0.0 });
    }
    moduli
}

/// Compliance of the soil for equal and opposite tractions on two elements, m/Pa.
fn alternating_compliance(
    base: &PlacedBase,
    ground_compliance: &[f64],
    component: usize,
    elements: [usize; 2],
) -> f64 {
    let order = base.layout().len();
    let row = |element: usize| {
        &ground_compliance[base.layout().index_of(component, element) * order..][..order]
    };
    let i = base.layout().index_of(component, elements[0]);
    let j = base.layout().index_of(component, elements[1]);
    0.5 * (row(elements[0])[i] + row(elements[1])[j] - row(elements[0])[j] - row(elements[1])[i])
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::linalg::magnitude_sum;
    use basemat_testkit::random::Random;

    /// REFERENCE: the matrix with the springs that fix the means.
    ///
    /// (K + Σ MEAN_SPRING_FACTOR · modulus · area · b bᵀ) x = f.
    #[test]
    fn spring_tractions_are_those_of_the_matrix_with_springs() {
        let mut random = Random(7);
        let n = 9;
        let mean_count = 3;
        let root: Vec<f64> = (0..n * n).map(|_| random.within(-1.0, 1.0)).collect();
        let product = |i: usize, j: usize| (0..n).map(|k| root[i * n + k] * root[j * n + k]).sum();
        let stiffness: Vec<f64> = (0..n * n).map(|k| product(k / n, k % n)).collect();
        let rows: Vec<f64> = (0..mean_count * n).map(|_| random.within(-1.0, 1.0)).collect();
        let soil: Vec<f64> =
            (0..mean_count * mean_count).map(|_| random.within(0.0, 1.0)).collect();
        let moduli = [0.3, 0.0, 2e-3];
        let areas = [1.0, 0.5, 2.0];
        let force: Vec<f64> = (0..n).map(|_| random.within(-1.0, 1.0)).collect();
        let mut with_springs = stiffness.clone();
        for (k, entry) in with_springs.iter_mut().enumerate() {
            *entry += (0..mean_count)
                .map(|i| {
                    let product = rows[i * n + k / n] * rows[i * n + k % n];
                    MEAN_SPRING_FACTOR * moduli[i] * areas[i] * product
                })
                .sum::<f64>();
        }
        let mut direct_factor = DenseFactor::with_capacity(n);
        let mut expected = force.clone();
        assert!(direct_factor.factor(&with_springs, n));
        direct_factor.solve(&mut expected);

        assert!(direct_factor.factor(&stiffness, n));
        let mean = |x: &[f64], i: usize| dot(&rows[i * n..(i + 1) * n], x);
        let mut traction_responses = Vec::new();
        let mut delassus = soil.clone();
        for j in 0..mean_count {
            let mut column: Vec<f64> = rows[j * n..][..n].iter().map(|b| areas[j] * b).collect();
            direct_factor.solve(&mut column);
            (0..mean_count).for_each(|i| delassus[i * mean_count + j] += mean(&column, i));
            traction_responses.extend(column);
        }
        let mut computed = force;
        direct_factor.solve(&mut computed);
        let mut traction: Vec<f64> = (0..mean_count)
            .map(|i| MEAN_SPRING_FACTOR * moduli[i] * mean(&computed, i))
            .collect();
        factored_spring_matrix(&moduli, &delassus, &soil).unwrap().solve(&mut traction);
        transposed_multiply_add(&traction_responses, -1.0, &traction, &mut computed);
        assert!(
            computed
                .iter()
                .zip(&expected)
                .all(|(a, b)| (a - b).abs() < 1e-8 * magnitude_sum(&expected))
        );
    }
}
