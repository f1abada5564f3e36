//! Out-of-balance forces of a static state, and the joint that moves most if no static state is found.

use crate::coupled::base::PlacedBase;
use crate::coupled::model::assembled::Assembled;
use crate::coupled::statics::convergence::RelativeForceNorm;
use crate::coupled::statics::static_state::StaticState;
use crate::error::Result;
use crate::geometry::resultant;
use crate::linalg::{SparseMatrix, dot};
use crate::structure::{Structure, nonlinear_state};

/// Rounding error of a displacement, in units of its last digit.
const DISPLACEMENT_ROUNDING_FACTOR: f64 = 8.0;

/// Unbalanced resultant force, relative to the load.
///
/// K does not resist translations. The tractions alone must balance the resultants of the load.
pub(super) fn imbalance(assembled: &Assembled, load: &[f64], traction: &[f64]) -> f64 {
    let mut residual = load.to_vec();
    assembled.base.add_forces(-1.0, traction, &mut residual);
    let mut max_resultant = 0.0_f64;
    let mut scale = 0.0_f64;
    for vector in &assembled.influence.whole_vectors(load.len()) {
        max_resultant = max_resultant.max(dot(vector, &residual).abs());
        scale = scale.max(vector.iter().zip(load).map(|(r, f)| (r * f).abs()).sum());
    }
    max_resultant / scale.max(f64::MIN_POSITIVE)
}

/// Unbalanced force: load − K u − f(u) − BᵀAτ.
pub(super) fn unbalanced_force(
    assembled: &Assembled,
    structure: &dyn Structure,
    load: &[f64],
    state: &StaticState,
) -> Result<Vec<f64>> {
    let mut residual = load.to_vec();
    assembled.stiffness.multiply_add(-1.0, &state.displacement, &mut residual);
    assembled.base.add_forces(-1.0, &state.traction, &mut residual);
    let force = nonlinear_state(structure, &state.displacement)?.0;
    residual.iter_mut().zip(&force).for_each(|(r, f)| *r -= f);
    Ok(residual)
}

/// Force due to rounding of the displacement, in the norm of the forces.
///
/// `matrices`: linear stiffness and tangent, whose sum resists the displacement.
pub(super) fn force_rounding(
    relative_norm: &RelativeForceNorm,
    matrices: [&SparseMatrix; 2],
    displacement: &[f64],
) -> f64 {
    let mut force = vec![0.0; displacement.len()];
    for matrix in matrices {
        for (i, j, stiffness) in matrix.entries() {
            force[i] += (stiffness * displacement[j]).abs();
        }
    }
    DISPLACEMENT_ROUNDING_FACTOR * f64::EPSILON * relative_norm.of(&force)
}

/// Joint and its element whose sides move most against each other in a displacement increment.
///
/// `None` without joints, for an empty `increment`, and if an element on the ground moves more.
pub(super) fn joint_element_that_moves_most(
    base: &PlacedBase,
    increment: &[f64],
) -> Option<[usize; 2]> {
    if base.joints().is_empty() || increment.is_empty() {
        return None;
    }
    let layout = base.layout();
    let mut means = vec![0.0; layout.len()];
    base.means(increment, &mut means);
    let relative_displacement = |element: usize| {
        let components = 0..layout.components();
        components.fold(0.0, |sum, k| resultant(sum, means[layout.index_of(k, element)]))
    };
    let elements = 0..layout.elements();
    let element =
        elements.max_by(|a, b| relative_displacement(*a).total_cmp(&relative_displacement(*b)))?;
    let mut joints = base.joints().iter().enumerate();
    let (joint_index, joint) = joints.find(|(_, joint)| joint.elements.contains(&element))?;
    Some([joint_index, element - joint.elements.start])
}
