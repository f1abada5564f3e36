//! Compliances of pairs of elements around a trench.

use super::soil::TrenchSoil;
use crate::bem::layered::{Compliance, Compliances, surface_outlook};
use crate::error::Result;
use crate::history::TRENCH_KINDS;
use crate::linalg::{Complex, ComplexBlock};
use crate::soil::SoilProfile;

/// Compliances of the classes of [`PairClasses::around_trench`](crate::history::PairClasses::around_trench).
#[derive(Debug)]
pub(super) struct TrenchPairs {
    soil: TrenchSoil,
    /// Degree of the finite elements, the same at all Laplace variables.
    degree: usize,
    /// Length of the shortest element, and of the outline, m.
    lengths: [f64; 2],
}

impl TrenchPairs {
    pub(super) fn new(soil: TrenchSoil, degree: usize) -> Self {
        let elements = soil.elements().elements();
        let lengths = || elements.iter().map(crate::geometry::ContactElement::length);
        let lengths = [lengths().fold(f64::INFINITY, f64::min), lengths().sum()];
        Self { soil, degree, lengths }
    }

    /// Rows of the normal and the tangential component of an element of the right half, counted from the axis along the
    /// outline, in the compliances of a half, and the signs of their displacements.
    fn rows(&self, element: usize) -> [(usize, f64); 2] {
        let elements = self.soil.elements();
        let (base, wall) = (elements.base().len() - 1, elements.wall().len() - 1);
        if element < base {
            return [(2 * element + 1, 1.0), (2 * element, 1.0)];
        }
        // Elements of the wall are counted from the surface down there; their tangent leads up.
        let row = 2 * (2 * base + wall - 1 - element);
        [(row, 1.0), (row + 1, -1.0)]
    }

    /// Overwrites `values`, one per class, with the compliances for the halves of fields.
    pub(super) fn read(
        &self,
        [symmetric, antisymmetric]: [&ComplexBlock; 2],
        values: &mut [[Complex; TRENCH_KINDS]],
    ) {
        let (same, across) = values.split_at_mut(values.len() / 2);
        let mut pairs = same.iter_mut().zip(across);
        for i in 0..symmetric.rows() / 2 {
            let to = self.rows(i);
            for (j, (same, across)) in (0..=i).zip(&mut pairs) {
                let from = self.rows(j);
                for (kind, [a, b]) in [[0, 0], [1, 1], [0, 1], [1, 0]].into_iter().enumerate() {
                    let ((row, sign), (column, turn)) = (to[a], from[b]);
                    let parts = [symmetric, antisymmetric].map(|half| half[(row, column)]);
                    let half = 0.5 * sign * turn;
                    // A mirror changes the sign of tangential components.
                    let mirror = if b == 0 { half } else { -half };
                    let [sum, difference] =
                        [(parts[0] + parts[1]) * half, (parts[0] - parts[1]) * mirror];
                    same[kind] = Complex::new(sum.re, sum.im);
                    across[kind] = Complex::new(difference.re, difference.im);
                }
            }
        }
    }
}

impl Compliances<TRENCH_KINDS> for TrenchPairs {
    type Workspace = Compliance;

    const GATE_POINTS: usize = 12;

    fn compliance(
        &self,
        _profile: &SoilProfile,
        s: Complex,
        _work: &mut Self::Workspace,
        values: &mut [[Complex; TRENCH_KINDS]],
    ) -> Result<()> {
        let halves = match self.soil.mesh_of_degree(s, self.degree)? {
            (_, Some(known)) => known,
            (mesh, None) => self.soil.compliances(s, &mesh)?,
        };
        self.read([&halves.symmetric, &halves.antisymmetric], values);
        Ok(())
    }

    fn outlook(
        &self,
        profile: &SoilProfile,
        s: Complex,
        work: &mut Self::Workspace,
        values: &mut Vec<Complex>,
    ) -> Result<()> {
        work.set(profile, s)?;
        surface_outlook(profile, work, self.lengths, values);
        Ok(())
    }
}
