//! A beam of fibres in space at displacements of its nodes.

use super::SpaceFiberBeam;
use crate::error::{Error, Result, same_length};
use crate::fem::beam::basic_rows::{BASIC_COUNT, BasicRows, DOF_COUNT, Torsion};
use crate::fem::fiber::{BasicBeam, BasicState};
use crate::fem::inelastic_force::InelasticForce;
use crate::linalg::dot;

/// State of a basic beam at basic deformations and internal variables.
type Evaluate<'a> = fn(
    &BasicBeam<'a, 3, BASIC_COUNT>,
    &[f64; BASIC_COUNT],
    &[f64],
) -> Result<BasicState<3, BASIC_COUNT>>;

/// A beam in a deformed state.
pub(super) struct DeformedSpaceBeam<'a> {
    pub(super) beam: BasicBeam<'a, 3, BASIC_COUNT>,
    pub(super) rows: BasicRows,
    /// Elongation, and rotations relative to the chord.
    pub(super) v: [f64; BASIC_COUNT],
    pub(super) state: BasicState<3, BASIC_COUNT>,
    pub(super) torsion: Torsion,
}

impl DeformedSpaceBeam<'_> {
    /// Adds the nodal forces to `force`.
    pub(super) fn add_force(&self, force: &mut [f64]) {
        let bending = self.rows.bending.iter().zip(self.state.forces);
        let torque = self.torsion.torque();
        for (row, basic_force) in bending.chain([(&self.rows.twist, torque)]) {
            for (nodal_force, entry) in force.iter_mut().zip(row) {
                *nodal_force += basic_force * entry;
            }
        }
    }

    /// Adds the tangent to a row-major `matrix`.
    pub(super) fn add_tangent(&self, matrix: &mut [f64]) {
        let torsional_stiffness = self.torsion.stiffness;
        self.rows.add_stiffness(&self.state.stiffness, torsional_stiffness, matrix);
    }
}

impl SpaceFiberBeam {
    /// State at displacements of the nodes, with the beam and its basic deformations.
    pub(super) fn deformed(
        &self,
        coordinates: &[[f64; 3]],
        displacement: &[f64],
        variables: &[f64],
    ) -> Result<DeformedSpaceBeam<'_>> {
        self.evaluated(coordinates, displacement, variables, BasicBeam::state)
    }

    /// As [`deformed`](SpaceFiberBeam::deformed), without forces and tangent in an element by displacements.
    pub(super) fn strained(
        &self,
        coordinates: &[[f64; 3]],
        displacement: &[f64],
        variables: &[f64],
    ) -> Result<DeformedSpaceBeam<'_>> {
        self.evaluated(coordinates, displacement, variables, BasicBeam::deformed_state)
    }

    /// State by one of the methods of the basic beam.
    fn evaluated<'a>(
        &'a self,
        coordinates: &[[f64; 3]],
        displacement: &[f64],
        variables: &[f64],
        evaluate: Evaluate<'a>,
    ) -> Result<DeformedSpaceBeam<'a>> {
        same_length("coordinates of a beam", coordinates.len(), 2)?;
        same_length("displacement of a beam", displacement.len(), DOF_COUNT)?;
        same_length("internal variables of a beam", variables.len(), self.variable_count())?;
        let needed = "two nodes at a distance, and an orientation that is not along the beam";
        let axes = self
            .axes(coordinates)
            .ok_or(Error::Scene { quantity: "beam of fibres in space", needed })?;
        let rows = BasicRows::new(&axes);
        let beam = self.basic_beam(axes.length);
        let v = rows.bending.map(|row| dot(&row, displacement));
        let state = evaluate(&beam, &v, variables)?;
        let twist = dot(&rows.twist, displacement);
        let torsion = Torsion { stiffness: self.torsional_stiffness / axes.length, twist };
        Ok(DeformedSpaceBeam { beam, rows, v, state, torsion })
    }
}
