//! Bending of a straight beam in one plane.

use super::axial_force::AxialForce;
use crate::fem::element::MassKind;
use crate::linalg::gauss;

/// Matrix of the deflection and rotation at the first end, then at the second end.
///
/// Rotations are positive from the axis towards the positive deflection.
pub(super) type EndMatrix = [[f64; 4]; 4];

/// Bending and shear of a straight beam in one plane.
///
/// It gives the parts of the beam's matrices across its axis.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Bending {
    /// E I, N m².
    pub(super) stiffness: f64,
    /// G times the shear area, N; `None` without shear deformation.
    pub(super) shear_stiffness: Option<f64>,
    /// ρ I, kg m.
    pub(super) section_inertia: f64,
    pub(super) has_rotary_inertia: bool,
}

impl Bending {
    /// `Φ = 12 EI/(G A_s L²)`, the ratio of shear to bending flexibility.
    fn shear_ratio(&self, length: f64) -> f64 {
        self.shear_stiffness.map_or(0.0, |k| 12.0 * self.stiffness / (k * length * length))
    }

    /// Stiffness of a beam of this length (m).
    pub(super) fn stiffness(&self, length: f64) -> EndMatrix {
        let ratio = self.shear_ratio(length);
        let k = self.stiffness / (length.powi(3) * (1.0 + ratio));
        let shear = 12.0 * k;
        let coupling = 6.0 * k * length;
        let near_end = (4.0 + ratio) * k * length * length;
        let far_end = (2.0 - ratio) * k * length * length;
        [
            [shear, coupling, -shear, coupling],
            [coupling, near_end, -coupling, far_end],
            [-shear, -coupling, shear, -coupling],
            [coupling, far_end, -coupling, near_end],
        ]
    }

    /// Geometric stiffness of an axial force.
    pub(super) fn geometric_stiffness(&self, force: &AxialForce, length: f64) -> EndMatrix {
        let ratio = self.shear_ratio(length);
        let mut matrix = [[0.0; 4]; 4];
        for (place, weight) in gauss::rule(4).points_on_unit_interval() {
            let slope = slope(ratio, length, place);
            add_outer(-force.at(place) * length * weight, &slope, &mut matrix);
        }
        matrix
    }

    /// Mass matrix of a beam with this `mass` (kg).
    ///
    /// The lumped matrix has the rotary inertia m L²/78, which keeps the ratio of the consistent diagonal (Hinton,
    /// Rock & Zienkiewicz, 1976), and half of the rotary inertia of the sections.
    pub(super) fn mass(&self, kind: MassKind, mass: f64, length: f64) -> EndMatrix {
        let mut matrix = [[0.0; 4]; 4];
        if kind == MassKind::Lumped {
            let half_inertia =
                if self.has_rotary_inertia { 0.5 * self.section_inertia * length } else { 0.0 };
            let rotary = mass * length * length / 78.0 + half_inertia;
            for (i, value) in [0.5 * mass, rotary, 0.5 * mass, rotary].into_iter().enumerate() {
                matrix[i][i] = value;
            }
            return matrix;
        }
        let ratio = self.shear_ratio(length);
        // Four points: exact for products of two cubics.
        for (place, weight) in gauss::rule(4).points_on_unit_interval() {
            add_outer(mass * weight, &deflection(ratio, length, place), &mut matrix);
            if self.has_rotary_inertia {
                let turned = rotation(ratio, length, place);
                add_outer(self.section_inertia * length * weight, &turned, &mut matrix);
            }
        }
        matrix
    }
}

/// Deflection across the beam at s = x/L due to unit end displacements and rotations.
fn deflection(ratio: f64, length: f64, s: f64) -> [f64; 4] {
    let t = 1.0 - s;
    let scale = 1.0 / (1.0 + ratio);
    [
        scale * t * (1.0 + s - 2.0 * s * s + ratio),
        scale * length * s * t * (t + 0.5 * ratio),
        scale * s * (1.0 + t - 2.0 * t * t + ratio),
        -(scale * length * t * s * (s + 0.5 * ratio)),
    ]
}

/// Slope of the deflection along the beam, 1/m.
fn slope(ratio: f64, length: f64, s: f64) -> [f64; 4] {
    let t = 1.0 - s;
    let scale = 1.0 / (length * (1.0 + ratio));
    [
        scale * (t * (1.0 - 4.0 * s) - (1.0 + s - 2.0 * s * s + ratio)),
        scale * length * ((t - s) * (t + 0.5 * ratio) - s * t),
        -(scale * (s * (1.0 - 4.0 * t) - (1.0 + t - 2.0 * t * t + ratio))),
        scale * length * ((s - t) * (s + 0.5 * ratio) - t * s),
    ]
}

/// Rotation of the section, rad: the slope without the shear strain (Friedman & Kosmatka 1993).
fn rotation(ratio: f64, length: f64, s: f64) -> [f64; 4] {
    let t = 1.0 - s;
    let scale = 1.0 / (1.0 + ratio);
    let side = 6.0 * scale * s * t / length;
    [-side, scale * t * (t - 2.0 * s + ratio), side, scale * s * (s - 2.0 * t + ratio)]
}

/// Adds factor · l lᵀ.
pub(super) fn add_outer<const N: usize>(factor: f64, row: &[f64; N], matrix: &mut [[f64; N]; N]) {
    for (entries, a) in matrix.iter_mut().zip(row) {
        for (entry, b) in entries.iter_mut().zip(row) {
            *entry += factor * a * b;
        }
    }
}

/// Copies a block into the rows and columns `places` of a matrix.
pub(super) fn put<const N: usize, const M: usize>(
    block: &[[f64; N]; N],
    places: [usize; N],
    matrix: &mut [[f64; M]; M],
) {
    for (row, place) in block.iter().zip(places) {
        for (value, column) in row.iter().zip(places) {
            matrix[place][column] = *value;
        }
    }
}
