//! Local matrices of a straight beam: stretching, twisting, bending in one plane.

use crate::fem::element::MassKind;
use crate::fem::small_matrix::add_outer;
use crate::linalg::gauss;

/// Number of Gauss points along a beam, exact for products of two cubics.
const GAUSS_POINT_COUNT: usize = 4;
/// Divisor of m L² for the lumped rotary inertia of an end.
///
/// It gives translations and rotations the ratio of the consistent diagonal (Hinton, Rock & Zienkiewicz 1976).
const LUMPED_INERTIA_DIVISOR: f64 = 78.0;

/// Axial compression of a beam in the static state, for its P–Δ effect.
///
/// It varies linearly along the beam because of the beam's weight.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(super) struct AxialForce {
    /// Mean compression over the length, N (negative for tension).
    pub(super) compression: f64,
    /// Compression at the first end less the compression at the second end, N.
    pub(super) end_difference: f64,
    /// Whether the user prescribed the force; the static state then does not change this force.
    pub(super) is_prescribed: bool,
}

impl AxialForce {
    /// Constant force that the user prescribed, N.
    pub(super) fn prescribed(compression: f64) -> Self {
        Self { compression, end_difference: 0.0, is_prescribed: true }
    }

    /// Whether there is no P–Δ effect.
    pub(super) fn is_zero(&self) -> bool {
        self.compression == 0.0 && self.end_difference == 0.0
    }

    /// Compression at s = x/L, N.
    pub(super) fn at(&self, s: f64) -> f64 {
        self.compression + self.end_difference * (0.5 - s)
    }
}

/// Matrix of the axial displacements, or the rotations about the bar, at both ends.
pub(super) type BarMatrix = [[f64; 2]; 2];

/// Stiffness matrix of a bar that resists the difference of its end displacements or rotations.
pub(super) fn bar_stiffness(stiffness: f64) -> BarMatrix {
    [[stiffness, -stiffness], [-stiffness, stiffness]]
}

/// Mass matrix of a bar whose displacement varies linearly.
///
/// `mass`: kg, or rotary inertia in kg m².
pub(super) fn bar_mass(kind: MassKind, mass: f64) -> BarMatrix {
    if kind == MassKind::Lumped {
        return [[0.5 * mass, 0.0], [0.0, 0.5 * mass]];
    }
    let mut matrix = [[0.0; 2]; 2];
    for (s, weight) in gauss::rule(GAUSS_POINT_COUNT).points_on_unit_interval() {
        add_outer(mass * weight, &[1.0 - s, s], &mut matrix);
    }
    matrix
}

/// Matrix of the deflection and rotation at the first end, then at the second end.
///
/// A positive rotation turns the axis towards positive deflections.
pub(super) type BendingMatrix = [[f64; 4]; 4];

/// Bending and shear of a straight beam in one plane.
///
/// Its matrices are the parts of the beam's matrices for deflections and rotations in this plane.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Bending {
    /// Flexural rigidity E I, N m².
    pub(super) flexural_rigidity: f64,
    /// Shear stiffness G A_s, N; `None` without shear deformation.
    pub(super) shear_stiffness: Option<f64>,
    /// Rotary inertia ρ I of the section per length, kg m.
    pub(super) section_inertia: f64,
    /// Whether the mass includes the rotary inertia of the section.
    ///
    /// The lumped mass has half of it at each end.
    pub(super) has_rotary_inertia: bool,
}

impl Bending {
    /// Ratio of shear to bending flexibility, `Φ = 12 EI/(G A_s L²)`.
    fn shear_ratio(&self, length: f64) -> f64 {
        self.shear_stiffness
            .map_or(0.0, |k| 12.0 * self.flexural_rigidity / (k * length * length))
    }

    /// Stiffness matrix of a beam of this `length` (m).
    pub(super) fn stiffness(&self, length: f64) -> BendingMatrix {
        let shear_ratio = self.shear_ratio(length);
        let k = self.flexural_rigidity / (length.powi(3) * (1.0 + shear_ratio));
        let shear = 12.0 * k;
        let coupling = 6.0 * k * length;
        let near_end = (4.0 + shear_ratio) * k * length * length;
        let far_end = (2.0 - shear_ratio) * k * length * length;
        [
            [shear, coupling, -shear, coupling],
            [coupling, near_end, -coupling, far_end],
            [-shear, -coupling, shear, -coupling],
            [coupling, far_end, -coupling, near_end],
        ]
    }

    /// Geometric stiffness matrix of an axial force in a beam of this `length` (m).
    pub(super) fn geometric_stiffness(&self, force: &AxialForce, length: f64) -> BendingMatrix {
        let shear_ratio = self.shear_ratio(length);
        let mut matrix = [[0.0; 4]; 4];
        for (s, weight) in gauss::rule(GAUSS_POINT_COUNT).points_on_unit_interval() {
            let slopes = slope(shear_ratio, length, s);
            add_outer(-force.at(s) * length * weight, &slopes, &mut matrix);
        }
        matrix
    }

    /// Mass matrix of a beam with this `mass` (kg) and `length` (m).
    ///
    /// The lumped matrix has the rotary inertia m L²/78 and half of the rotary inertia of the sections at each end.
    pub(super) fn mass(&self, kind: MassKind, mass: f64, length: f64) -> BendingMatrix {
        let mut matrix = [[0.0; 4]; 4];
        if kind == MassKind::Lumped {
            let half_section_inertia =
                if self.has_rotary_inertia { 0.5 * self.section_inertia * length } else { 0.0 };
            let rotary_inertia =
                mass * length * length / LUMPED_INERTIA_DIVISOR + half_section_inertia;
            for (i, value) in
                [0.5 * mass, rotary_inertia, 0.5 * mass, rotary_inertia].into_iter().enumerate()
            {
                matrix[i][i] = value;
            }
            return matrix;
        }
        let shear_ratio = self.shear_ratio(length);
        for (s, weight) in gauss::rule(GAUSS_POINT_COUNT).points_on_unit_interval() {
            add_outer(mass * weight, &deflection(shear_ratio, length, s), &mut matrix);
            if self.has_rotary_inertia {
                let section_rotation = rotation(shear_ratio, length, s);
                add_outer(self.section_inertia * length * weight, &section_rotation, &mut matrix);
            }
        }
        matrix
    }
}

/// Deflections at s = x/L due to unit deflections and rotations of the ends; t = 1 − s.
fn deflection(shear_ratio: f64, length: f64, s: f64) -> [f64; 4] {
    let t = 1.0 - s;
    let scale = 1.0 / (1.0 + shear_ratio);
    [
        scale * t * (1.0 + s - 2.0 * s * s + shear_ratio),
        scale * length * s * t * (t + 0.5 * shear_ratio),
        scale * s * (1.0 + t - 2.0 * t * t + shear_ratio),
        -(scale * length * t * s * (s + 0.5 * shear_ratio)),
    ]
}

/// Slopes of these deflections at s = x/L; t = 1 − s.
fn slope(shear_ratio: f64, length: f64, s: f64) -> [f64; 4] {
    let t = 1.0 - s;
    let scale = 1.0 / (length * (1.0 + shear_ratio));
    [
        scale * (t * (1.0 - 4.0 * s) - (1.0 + s - 2.0 * s * s + shear_ratio)),
        scale * length * ((t - s) * (t + 0.5 * shear_ratio) - s * t),
        -(scale * (s * (1.0 - 4.0 * t) - (1.0 + t - 2.0 * t * t + shear_ratio))),
        scale * length * ((s - t) * (s + 0.5 * shear_ratio) - t * s),
    ]
}

/// Rotations of the section at s = x/L; t = 1 − s.
///
/// They are the slopes less the shear strains (Friedman & Kosmatka 1993).
fn rotation(shear_ratio: f64, length: f64, s: f64) -> [f64; 4] {
    let t = 1.0 - s;
    let scale = 1.0 / (1.0 + shear_ratio);
    let deflection_term = 6.0 * scale * s * t / length;
    [
        -deflection_term,
        scale * t * (t - 2.0 * s + shear_ratio),
        deflection_term,
        scale * s * (s - 2.0 * t + shear_ratio),
    ]
}

/// Copies a `block` to the rows and columns `dofs` of a matrix.
pub(super) fn copy_block<const N: usize, const M: usize>(
    block: &[[f64; N]; N],
    dofs: [usize; N],
    matrix: &mut [[f64; M]; M],
) {
    for (row, row_dof) in block.iter().zip(dofs) {
        for (value, column_dof) in row.iter().zip(dofs) {
            matrix[row_dof][column_dof] = *value;
        }
    }
}
