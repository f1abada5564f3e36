//! Numerical compliance of joints, by which the pressures between rigid bodies are defined.
//!
//! Two rigid bodies have three relative motions, so that more than three tractions between them are undetermined, and W is
//! singular. A compliance far below the structure's own one distributes them as stiff springs would.

use crate::coupled::base::PlacedBase;
use crate::linalg::CompressedMatrix;

/// Compliance of an element of a joint, relative to the compliance of the structure there.
///
/// Under its own weight a body penetrates by this fraction of its fall in a step.
const JOINT_COMPLIANCE_RATIO: f64 = 1e-10;
/// The same ratio in a static state.
///
/// A body without ground stands on the fictitious springs of the static state there, whose compliance is far above that of a
/// structure. With a ratio of 1e-10 the thrust of a portal with joints is wrong by 2e-4, with 1e-13 by 4e-8.
pub(crate) const STATIC_JOINT_COMPLIANCE_RATIO: f64 = 1e-13;
/// Time step whose compliance joints have in all shorter steps, s.
///
/// A body falls by 0.5 mm in this time. Penetrations of 5e-14 m are far above the rounding of displacements, so that the
/// distribution of tractions has three digits or more.
const MIN_REFERENCE_TIME_STEP: f64 = 1e-2;

/// Compliance of joints, relative to that of the structure in a step.
///
/// `time_step`: length of the step, s.
pub(crate) fn step_compliance_ratio(time_step: f64) -> f64 {
    let reference = f64::max(MIN_REFERENCE_TIME_STEP / time_step, 1.0);
    JOINT_COMPLIANCE_RATIO * reference * reference
}

/// The ground's compliance for all elements, with the numerical compliance of joints on its diagonal.
///
/// `solve` overwrites many right-hand sides with responses of the structure; `dofs` is their length. The compliance of a
/// joint is `ratio` times that of the structure.
pub(crate) fn with_joint_compliance(
    solve: impl FnOnce(&mut [f64]),
    base: &PlacedBase,
    ground_compliance: &CompressedMatrix,
    dofs: usize,
    ratio: f64,
) -> CompressedMatrix {
    let layout = base.layout();
    let is_joint = |i: &usize| layout.component_and_element(*i)[1] >= base.elements().len();
    let indices: Vec<usize> = (0..layout.len()).filter(is_joint).collect();
    let mut responses = vec![0.0; indices.len() * dofs];
    let mut unit_traction = vec![0.0; layout.len()];
    for (&i, force) in indices.iter().zip(responses.chunks_exact_mut(dofs.max(1))) {
        unit_traction[i] = 1.0;
        base.add_forces(1.0, &unit_traction, force);
        unit_traction[i] = 0.0;
    }
    solve(&mut responses);
    let mut matrix = ground_compliance.filled(layout.len());
    for (&i, response) in indices.iter().zip(responses.chunks_exact(dofs.max(1))) {
        let compliance = base.component_mean(i, response).abs();
        matrix[i * (layout.len() + 1)] += ratio * compliance;
    }
    CompressedMatrix::new(matrix, layout.len())
}
