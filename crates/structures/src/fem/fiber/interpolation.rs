//! Deformations and forces of sections along a beam.

/// Interpolations along a beam with N deformations of a section and B basic deformations.
#[derive(Debug)]
pub(in crate::fem) struct Interpolation<const N: usize, const B: usize> {
    /// a(x) times the length, at x/L.
    pub(in crate::fem) deformations: fn(f64) -> [[f64; B]; N],
    /// b(x) at x/L.
    pub(in crate::fem) forces: fn(f64) -> [[f64; B]; N],
}

/// Bending in one plane: axial strain and curvature.
pub(in crate::fem) const PLANE_BENDING: Interpolation<2, 3> = Interpolation {
    deformations: |s| [[1.0, 0.0, 0.0], [0.0, 6.0 * s - 4.0, 6.0 * s - 2.0]],
    forces: |s| [[1.0, 0.0, 0.0], [0.0, s - 1.0, s]],
};

/// Bending in two planes: axial strain, curvatures about z and about y.
///
/// Basic deformations: elongation, rotations of both ends about z, then about y. Torsion is elastic and not coupled with
/// them, so that beams add it.
pub(in crate::fem) const SPACE_BENDING: Interpolation<3, 5> = Interpolation {
    deformations: |s| {
        let near = 6.0 * s - 4.0;
        let far = 6.0 * s - 2.0;
        [[1.0, 0.0, 0.0, 0.0, 0.0], [0.0, near, far, 0.0, 0.0], [0.0, 0.0, 0.0, near, far]]
    },
    forces: |s| {
        [[1.0, 0.0, 0.0, 0.0, 0.0], [0.0, s - 1.0, s, 0.0, 0.0], [0.0, 0.0, 0.0, s - 1.0, s]]
    },
};
