//! Compliances of pairs of elements around a trench.

use super::classes::TRENCH_KINDS;
use super::compliance::HalfCompliances;
use super::soil::TrenchSoil;
use crate::bem::layered::{Compliances, LayeredCompliance, append_surface_surrogate};
use crate::error::Result;
use crate::linalg::Complex;
use crate::soil::SoilProfile;

/// Compliances of the classes of [`trench_classes`](super::classes::trench_classes).
#[derive(Debug)]
pub(super) struct TrenchPairs {
    soil: TrenchSoil,
    /// Degree of the finite elements, the same at all Laplace variables.
    degree: usize,
    /// Length of the shortest element, and of the outline, m.
    lengths: [f64; 2],
}

impl TrenchPairs {
    /// Pairs of the elements around a trench.
    pub(super) fn new(soil: TrenchSoil, degree: usize) -> Self {
        let elements = soil.elements().elements();
        let lengths = elements.iter().map(crate::geometry::ContactElement::length);
        let shortest = lengths.clone().fold(f64::INFINITY, f64::min);
        Self { soil, degree, lengths: [shortest, lengths.sum()] }
    }

    /// Rows of the normal and the tangential component of an element in the compliances of a half.
    ///
    /// Each with the sign of its displacement. Elements of the right half are counted from the axis along the outline.
    fn rows(&self, element: usize) -> [(usize, f64); 2] {
        let elements = self.soil.elements();
        let base = elements.base().len() - 1;
        let wall = elements.wall().len() - 1;
        if element < base {
            return [(2 * element + 1, 1.0), (2 * element, 1.0)];
        }
        // Elements of the wall are counted from the surface down there; their tangent leads up.
        let row = 2 * (2 * base + wall - 1 - element);
        [(row, 1.0), (row + 1, -1.0)]
    }

    /// Overwrites `values`, one per class, with the compliances for the halves of fields.
    pub(super) fn fill_classes(
        &self,
        compliances: &HalfCompliances,
        values: &mut [[Complex; TRENCH_KINDS]],
    ) {
        let HalfCompliances { symmetric, antisymmetric } = compliances;
        // Pairs on one side of the axis, then pairs across it.
        let class_count = values.len() / 2;
        let mut class = 0;
        for i in 0..symmetric.rows() / 2 {
            let receiver = self.rows(i);
            for j in 0..=i {
                let source = self.rows(j);
                for (kind, [a, b]) in [[0, 0], [1, 1], [0, 1], [1, 0]].into_iter().enumerate() {
                    let (row, receiver_sign) = receiver[a];
                    let (column, source_sign) = source[b];
                    let even = symmetric[(row, column)];
                    let odd = antisymmetric[(row, column)];
                    let factor = 0.5 * receiver_sign * source_sign;
                    // A mirror changes the sign of tangential components.
                    let mirrored_factor = if b == 0 { factor } else { -factor };
                    let same_side = (even + odd) * factor;
                    let across = (even - odd) * mirrored_factor;
                    values[class][kind] = Complex::new(same_side.re, same_side.im);
                    values[class_count + class][kind] = Complex::new(across.re, across.im);
                }
                class += 1;
            }
        }
    }
}

impl Compliances<TRENCH_KINDS> for TrenchPairs {
    type Workspace = LayeredCompliance;

    const PASSIVITY_POINTS: usize = 12;

    fn compliance(
        &self,
        _profile: &SoilProfile,
        s: Complex,
        _work: &mut Self::Workspace,
        values: &mut [[Complex; TRENCH_KINDS]],
    ) -> Result<()> {
        let found = self.soil.mesh_of_degree(s, self.degree)?;
        let compliances = match found.compliances {
            Some(compliances) => compliances,
            None => self.soil.compliances(s, &found.mesh)?,
        };
        self.fill_classes(&compliances, values);
        Ok(())
    }

    fn append_surrogate(
        &self,
        profile: &SoilProfile,
        s: Complex,
        work: &mut Self::Workspace,
        values: &mut Vec<Complex>,
    ) -> Result<()> {
        work.set(profile, s)?;
        append_surface_surrogate(profile, work, self.lengths, values);
        Ok(())
    }
}
