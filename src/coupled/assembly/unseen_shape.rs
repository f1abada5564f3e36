//! The softest shape of a base with zero mean displacement on every element.
//!
//! Symbols: see `flexible_base.rs`.

use std::cell::RefCell;
use std::ops::Range;

use crate::coupled::base::PlacedBase;
use crate::coupled::model::assembled::Assembled;
use crate::coupled::statics::compliance::Compliance;
use crate::geometry::ContactElement;
use crate::linalg::{CompressedMatrix, DenseFactor, SparseMatrix, dot, transposed_multiply_add};
use crate::structure::{BaseNode, Triplets};

const FIXED_MEANS_STIFFNESS_NAME: &str = "stiffness matrix with its contact elements held";
/// Stiffness of springs that hold element means, relative to the soil.
const MEAN_SPRING_FACTOR: f64 = 1e4;
/// Largest number of power iterations for ρ, and the change at which they end.
const MAX_POWER_ITERATIONS: usize = 20;
const POWER_ITERATION_TOLERANCE: f64 = 0.01;

/// Static compliance of the soil under elements, and the structure's compliance on them.
pub(super) type OnSoil<'a> = (&'a CompressedMatrix, &'a RefCell<Option<Compliance>>);

/// The softest shape of a base with zero mean displacement on every element.
pub(super) struct UnseenShape {
    /// ρ.
    pub(super) ratio: f64,
    /// Number of the face with the largest part in the shape.
    pub(super) face: usize,
}

/// Faces of the foundations, each with the number and the nodes of its foundation and its elements.
///
/// A foundation without walls is one face.
pub(super) fn faces(base: &PlacedBase) -> impl Iterator<Item = (usize, &[BaseNode], Range<usize>)> {
    base.foundations().enumerate().flat_map(|(foundation, (nodes, under))| {
        let faces = ContactElement::faces(base.elements()).in_order().into_iter();
        let parts = faces.map(move |face| face.start.max(under.start)..face.end.min(under.end));
        parts.filter(|part| !part.is_empty()).map(move |part| (foundation, nodes, part))
    })
}

impl UnseenShape {
    /// The shape with the smallest ρ on elements of this static compliance; `halves`: as for [`moduli`].
    ///
    /// `None` if there is no such shape.
    pub(super) fn softest(
        assembled: &Assembled,
        base: &PlacedBase,
        (soil, shared): OnSoil<'_>,
        halves: Option<&(PlacedBase, CompressedMatrix)>,
    ) -> Option<Self> {
        let n = assembled.dofs();
        let layout = base.layout();
        let moduli = moduli(base, soil, halves);
        let mut springs = Triplets::new(n);
        for (point, rows) in base.deviations() {
            for (component, row) in rows.iter().enumerate() {
                let modulus = moduli[layout.place(component, point.element)];
                springs.add_outer(row, modulus * point.area);
            }
        }
        let springs = SparseMatrix::new(FIXED_MEANS_STIFFNESS_NAME, &springs).ok()?;
        let compliance = shared.borrow();
        let Compliance { floating, columns, delassus } = compliance.as_ref()?;
        let mut means = spring_supported_means(&moduli, delassus, soil)?;
        let mut traction = vec![0.0; layout.len()];
        // Power iteration from a vector of mixed signs and sizes; the quotient is some per cent above the smallest.
        let mut shape: Vec<f64> = (0..n).map(|i| (1.0 + i as f64).sin() + 0.5).collect();
        let mut ratio = f64::INFINITY;
        for _ in 0..MAX_POWER_ITERATIONS {
            let mut force = vec![0.0; n];
            springs.multiply_add(1.0, &shape, &mut force);
            let norm = dot(&shape, &force).sqrt();
            if !(norm.is_finite() && norm > 0.0) {
                return None;
            }
            for f in &mut force {
                *f /= norm;
            }
            shape.copy_from_slice(&force);
            floating.factor.solve_many(&mut shape);
            base.means(&shape, &mut traction);
            for (value, modulus) in traction.iter_mut().zip(&moduli) {
                *value *= MEAN_SPRING_FACTOR * modulus;
            }
            means.solve(&mut traction);
            transposed_multiply_add(columns, -1.0, &traction, &mut shape);
            let before = std::mem::replace(&mut ratio, 1.0 / springs.form(&shape, &shape).sqrt());
            if (before / ratio - 1.0).abs() < POWER_ITERATION_TOLERANCE {
                break;
            }
        }
        if !ratio.is_finite() {
            return None;
        }
        Some(Self { ratio, face: most_deformed_face(base, &moduli, &shape) })
    }
}

/// Number of the face of a base whose deviations from its means have the largest energy in a shape.
fn most_deformed_face(base: &PlacedBase, moduli: &[f64], shape: &[f64]) -> usize {
    let mut energies = vec![0.0; faces(base).count()];
    for (point, rows) in base.deviations() {
        let face = faces(base).position(|(.., elements)| elements.contains(&point.element));
        for (component, row) in rows.iter().enumerate() {
            let value: f64 = row.iter().map(|&(dof, weight)| weight * shape[dof]).sum();
            let modulus = moduli[base.layout().place(component, point.element)];
            energies[face.unwrap_or(0)] += modulus * point.area * value * value;
        }
    }
    let largest = energies.iter().enumerate().max_by(|one, other| one.1.total_cmp(other.1));
    largest.map_or(0, |(face, _)| face)
}

/// Factors of 1 + MEAN_SPRING_FACTOR · modulus · D, which yields tractions of springs on element means from free means.
///
/// D is the structure's part of the Delassus operator; each mean is multiplied by MEAN_SPRING_FACTOR · modulus.
fn spring_supported_means(moduli: &[f64], delassus: &[f64], soil: &[f64]) -> Option<DenseFactor> {
    let size = moduli.len();
    let mut matrix = Vec::with_capacity(size * size);
    for k in 0..size * size {
        let entry = MEAN_SPRING_FACTOR * moduli[k / size] * (delassus[k] - soil[k]);
        matrix.push(if k.is_multiple_of(size + 1) { 1.0 + entry } else { entry });
    }
    let mut factor = DenseFactor::with_capacity(size);
    factor.factor(&matrix, size).then_some(factor)
}

/// Stiffness of the soil under each element in each component, Pa/m.
///
/// For tractions that change sign from an element to its neighbour, as for waves twice as long as the elements. Where a
/// face has one element, the sign changes between its `halves`: a base on shorter elements, and their compliance.
fn moduli(
    base: &PlacedBase,
    soil: &[f64],
    halves: Option<&(PlacedBase, CompressedMatrix)>,
) -> Vec<f64> {
    let layout = base.layout();
    let faces: Vec<_> = faces(base).map(|(.., elements)| elements).collect();
    let mut moduli = Vec::with_capacity(layout.len());
    for i in 0..layout.len() {
        let [component, e] = layout.origin(i);
        let face = faces.iter().position(|elements| elements.contains(&e));
        let on_face = face.map_or(e..e + 1, |face| faces[face].clone());
        let neighbours = [e.checked_sub(1), Some(e + 1)].into_iter().flatten();
        let mut compliance = neighbours
            .filter(|other| on_face.contains(other))
            .map(|other| alternating(base, soil, component, [e, other]))
            .fold(soil[i * layout.len() + i], f64::min);
        if let (1, Some((base, soil)), Some(face)) = (on_face.len(), halves, face) {
            let halves = self::faces(base).nth(face).map_or(0..1, |(.., elements)| elements);
            let others = (halves.start + 1..halves.end)
                .map(|other| alternating(base, soil, component, [halves.start, other]));
            compliance = others.fold(compliance, f64::min);
        }
        moduli.push(if compliance > 0.0 { compliance.recip() } else { 0.0 });
    }
    moduli
}

/// Compliance of the soil for equal and opposite tractions on two elements, m/Pa.
fn alternating(base: &PlacedBase, soil: &[f64], component: usize, elements: [usize; 2]) -> f64 {
    let order = base.layout().len();
    let row = |element: usize| &soil[base.layout().place(component, element) * order..][..order];
    let i = base.layout().place(component, elements[0]);
    let j = base.layout().place(component, elements[1]);
    0.5 * (row(elements[0])[i] + row(elements[1])[j] - row(elements[0])[j] - row(elements[1])[i])
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::linalg::magnitude;
    use basemat_testkit::random::Random;

    /// REFERENCE: the matrix with the springs that hold means, (K + Σ MEAN_SPRING_FACTOR · modulus · area · b bᵀ) x = f.
    #[test]
    fn spring_supported_means_are_those_of_the_matrix_with_springs() {
        let mut random = Random(7);
        let n = 9;
        let size = 3;
        let root: Vec<f64> = (0..n * n).map(|_| random.within(-1.0, 1.0)).collect();
        let product = |i: usize, j: usize| (0..n).map(|k| root[i * n + k] * root[j * n + k]).sum();
        let stiffness: Vec<f64> = (0..n * n).map(|k| product(k / n, k % n)).collect();
        let rows: Vec<f64> = (0..size * n).map(|_| random.within(-1.0, 1.0)).collect();
        let soil: Vec<f64> = (0..size * size).map(|_| random.within(0.0, 1.0)).collect();
        let moduli = [0.3, 0.0, 2e-3];
        let areas = [1.0, 0.5, 2.0];
        let force: Vec<f64> = (0..n).map(|_| random.within(-1.0, 1.0)).collect();
        let mut with_springs = stiffness.clone();
        for (k, entry) in with_springs.iter_mut().enumerate() {
            *entry += (0..size)
                .map(|i| {
                    let product = rows[i * n + k / n] * rows[i * n + k % n];
                    MEAN_SPRING_FACTOR * moduli[i] * areas[i] * product
                })
                .sum::<f64>();
        }
        let mut direct = DenseFactor::with_capacity(n);
        let mut expected = force.clone();
        assert!(direct.factor(&with_springs, n));
        direct.solve(&mut expected);

        assert!(direct.factor(&stiffness, n));
        let mean = |x: &[f64], i: usize| dot(&rows[i * n..(i + 1) * n], x);
        let mut columns = Vec::new();
        let mut delassus = soil.clone();
        for j in 0..size {
            let mut column: Vec<f64> = rows[j * n..][..n].iter().map(|b| areas[j] * b).collect();
            direct.solve(&mut column);
            (0..size).for_each(|i| delassus[i * size + j] += mean(&column, i));
            columns.extend(column);
        }
        let mut found = force;
        direct.solve(&mut found);
        let mut traction: Vec<f64> =
            (0..size).map(|i| MEAN_SPRING_FACTOR * moduli[i] * mean(&found, i)).collect();
        spring_supported_means(&moduli, &delassus, &soil).unwrap().solve(&mut traction);
        transposed_multiply_add(&columns, -1.0, &traction, &mut found);
        assert!(
            found.iter().zip(&expected).all(|(a, b)| (a - b).abs() < 1e-8 * magnitude(&expected))
        );
    }
}
