//! Resultants of a section of fibres.

use super::UniaxialResponse;

/// Resultants of a section and their derivatives with respect to its N deformations.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(in crate::fem) struct SectionResponse<const N: usize> {
    /// Axial force (N) and bending moments (N m), conjugate to the deformations.
    pub(in crate::fem) forces: [f64; N],
    /// Tangent, symmetric.
    pub(in crate::fem) tangent: [[f64; N]; N],
}

impl<const N: usize> SectionResponse<N> {
    /// Response of a section without fibres.
    pub(super) fn zero() -> Self {
        Self { forces: [0.0; N], tangent: [[0.0; N]; N] }
    }

    /// Adds a fibre; of the tangent only the upper triangle.
    #[inline]
    pub(super) fn add_fiber(&mut self, area: f64, row: &[f64; N], fiber: &UniaxialResponse) {
        let force = area * fiber.stress;
        let stiffness = area * fiber.tangent;
        for i in 0..N {
            self.forces[i] += force * row[i];
            let row_stiffness = stiffness * row[i];
            for j in i..N {
                self.tangent[i][j] += row_stiffness * row[j];
            }
        }
    }

    /// Copies the upper triangle of the tangent to the lower one.
    pub(super) fn complete_tangent(&mut self) {
        for i in 1..N {
            for j in 0..i {
                self.tangent[i][j] = self.tangent[j][i];
            }
        }
    }
}
