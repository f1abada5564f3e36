//! Stretching and twisting of a straight bar.

use super::bending::add_outer;
use crate::fem::element::MassKind;
use crate::linalg::gauss;

/// Matrix of the displacement along, or the rotation about, the bar at both ends.
pub(super) type BarMatrix = [[f64; 2]; 2];

/// Stiffness matrix of a bar that resists the difference of its ends.
pub(super) fn stiffness(stiffness: f64) -> BarMatrix {
    [[stiffness, -stiffness], [-stiffness, stiffness]]
}

/// Mass matrix of a bar whose displacement varies linearly.
///
/// `mass`: kg, or kg m² for rotations.
pub(super) fn mass(kind: MassKind, mass: f64) -> BarMatrix {
    if kind == MassKind::Lumped {
        return [[0.5 * mass, 0.0], [0.0, 0.5 * mass]];
    }
    let mut matrix = [[0.0; 2]; 2];
    for (place, weight) in gauss::rule(4).points_on_unit_interval() {
        add_outer(mass * weight, &[1.0 - place, place], &mut matrix);
    }
    matrix
}
