//! A moment–rotation law beside stiff displacements.

use std::sync::Arc;

use super::hinge_force::{HingeLaw, HingeResponse};
use crate::error::Result;
use crate::fem::fiber::UniaxialMaterial;
use crate::fem::internal_energy::InternalEnergy;

/// Index of the rotation among the deformations; the others are displacements.
const ROTATION_INDEX: usize = 2;

/// Two displacements of one stiffness, and a rotation by a law.
#[derive(Debug, Clone)]
pub(super) struct MomentLaw {
    /// Stiffness of both displacements, N/m.
    pub(super) displacement_stiffness: f64,
    /// Moment (N m) in place of the stress, rotation (rad) in place of the strain.
    pub(super) moment_law: Arc<dyn UniaxialMaterial>,
}

/// The variables are those of the moment–rotation law.
impl HingeLaw<3> for MomentLaw {
    fn variable_count(&self) -> usize {
        self.moment_law.variable_count()
    }

    fn initialize(&self, variables: &mut [f64]) {
        self.moment_law.initialize(variables);
    }

    fn stiffness(&self) -> [f64; 3] {
        [self.displacement_stiffness, self.displacement_stiffness, self.moment_law.modulus()]
    }

    fn yields(&self) -> [bool; 3] {
        [false, false, true]
    }

    fn response(&self, deformation: &[f64; 3], variables: &[f64]) -> Result<HingeResponse<3>> {
        let moment = self.moment_law.response(deformation[ROTATION_INDEX], variables)?;
        let k = self.displacement_stiffness;
        Ok(HingeResponse {
            forces: [k * deformation[0], k * deformation[1], moment.stress],
            tangent: [[k, 0.0, 0.0], [0.0, k, 0.0], [0.0, 0.0, moment.tangent]],
        })
    }

    fn energy(&self, deformation: &[f64; 3], variables: &[f64]) -> Result<InternalEnergy> {
        let bending = self.moment_law.energy(deformation[ROTATION_INDEX], variables)?;
        let squared_displacement: f64 = deformation[..ROTATION_INDEX].iter().map(|d| d * d).sum();
        let stored = bending.stored + 0.5 * self.displacement_stiffness * squared_displacement;
        Ok(InternalEnergy { stored, ..bending })
    }

    /// That of the law, and ½ k Δd (2 d_m − d_0 − d_1) of the displacements.
    fn remainder(&self, deformations: &[[f64; 3]; 3], variables: &[f64]) -> Result<f64> {
        let rotations = deformations.map(|deformation| deformation[ROTATION_INDEX]);
        let start = &deformations[0];
        let midstep = &deformations[1];
        let end = &deformations[2];
        let displacements: f64 = (0..ROTATION_INDEX)
            .map(|i| (end[i] - start[i]) * (2.0 * midstep[i] - start[i] - end[i]))
            .sum();
        let bending = self.moment_law.remainder(rotations, variables)?;
        Ok(bending + 0.5 * self.displacement_stiffness * displacements)
    }

    fn commit(&self, deformation: &[f64; 3], variables: &mut [f64]) {
        self.moment_law.commit(deformation[ROTATION_INDEX], variables);
    }
}
