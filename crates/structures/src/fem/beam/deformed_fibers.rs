//! A beam of fibres at displacements of its nodes, in the plane and in space.
//!
//! | symbol | meaning |
//! |---|---|
//! | R | rows of the B basic deformations: v = R u for the D degrees of freedom |
//! | r | row of the twist, if the beam has torsion |
//! | q, k | basic forces, and their derivatives with respect to v |

use super::local_matrices::AxialForce;
use crate::error::{Result, same_length};
use crate::fem::element_matrix::add_matrix;
use crate::fem::fiber::{BasicBeam, BasicState, StepEnd};
use crate::fem::inelastic_force::{BeamSectionState, InelasticForce};
use crate::fem::internal_energy::InternalEnergy;
use crate::fem::small_matrix::{add_congruent, add_outer, product};
use crate::fem::vector::add_scaled;
use crate::linalg::dot;

/// Elastic torsion beside the fibres.
pub(super) struct Torsion<const D: usize> {
    /// Rotation of the second end about the beam relative to the first, by a unit of each degree of freedom.
    pub(super) row: [f64; D],
    /// G J/L, N m.
    pub(super) stiffness: f64,
}

/// Length of a beam, and its basic deformations by a unit of each degree of freedom.
pub(super) struct BasicRows<const B: usize, const D: usize> {
    /// Length, m.
    pub(super) length: f64,
    /// Elongation, then rotations of both ends relative to the chord.
    pub(super) rows: [[f64; D]; B],
    /// `None` in the plane.
    pub(super) torsion: Option<Torsion<D>>,
}

impl<const B: usize, const D: usize> BasicRows<B, D> {
    /// Basic deformations v by displacements of the nodes.
    fn deformations(&self, displacement: &[f64]) -> [f64; B] {
        self.rows.map(|row| dot(&row, displacement))
    }

    /// Adds Rᵀ k R, and the torsion, to a row-major `matrix`.
    pub(super) fn add_stiffness(&self, stiffness: &[[f64; B]; B], matrix: &mut [f64]) {
        let mut sum = [[0.0; D]; D];
        add_congruent(1.0, &self.rows, stiffness, &mut sum);
        if let Some(torsion) = &self.torsion {
            add_outer(torsion.stiffness, &torsion.row, &mut sum);
        }
        add_matrix(matrix, &sum);
    }
}

/// State of a basic beam at basic deformations and internal variables, with the stresses of its fibres.
type Evaluate<'a, const N: usize, const B: usize> =
    fn(&BasicBeam<'a, N, B>, &[f64; B], &[f64], &mut [f64]) -> Result<BasicState<N, B>>;

/// Beam element of fibres: its sections, and its rows between two nodes.
pub(super) trait FiberElement<const N: usize, const B: usize, const D: usize>:
    InelasticForce
{
    /// Stretching and bending of the beam without its rigid motions.
    fn basic_beam(&self, length: f64) -> BasicBeam<'_, N, B>;

    /// Length and rows; an error for nodes between which the beam cannot be.
    fn basic_rows(&self, coordinates: &[[f64; 3]]) -> Result<BasicRows<B, D>>;

    /// State at displacements of the nodes.
    ///
    /// `stresses` becomes the stresses of the fibres of an element by displacements, unless it is empty.
    fn deformed(
        &self,
        coordinates: &[[f64; 3]],
        displacement: &[f64],
        variables: &[f64],
        stresses: &mut [f64],
    ) -> Result<DeformedFiberBeam<'_, N, B, D>> {
        self.evaluated(coordinates, displacement, variables, stresses, BasicBeam::state)
    }

    /// As [`deformed`](FiberElement::deformed), without forces and tangent in an element by displacements.
    fn strained(
        &self,
        coordinates: &[[f64; 3]],
        displacement: &[f64],
        variables: &[f64],
    ) -> Result<DeformedFiberBeam<'_, N, B, D>> {
        self.evaluated(coordinates, displacement, variables, &mut [], BasicBeam::deformed_state)
    }

    /// State by one of the methods of the basic beam.
    fn evaluated<'a>(
        &'a self,
        coordinates: &[[f64; 3]],
        displacement: &[f64],
        variables: &[f64],
        stresses: &mut [f64],
        evaluate: Evaluate<'a, N, B>,
    ) -> Result<DeformedFiberBeam<'a, N, B, D>> {
        same_length("coordinates of a beam", coordinates.len(), 2)?;
        same_length("displacement of a beam", displacement.len(), D)?;
        same_length("internal variables of a beam", variables.len(), self.variable_count())?;
        let rows = self.basic_rows(coordinates)?;
        let beam = self.basic_beam(rows.length);
        let v = rows.deformations(displacement);
        let state = evaluate(&beam, &v, variables, stresses)?;
        let twist = rows.torsion.as_ref().map_or(0.0, |torsion| dot(&torsion.row, displacement));
        Ok(DeformedFiberBeam { beam, rows, v, state, twist })
    }

    /// Axial force of small strains at the displacement of a static state.
    ///
    /// `end_difference`: compression at the first end less that at the second, N. `None` for a beam that cannot be there.
    fn static_axial_force(
        &self,
        coordinates: &[[f64; 3]],
        displacement: &[f64],
        end_difference: f64,
    ) -> Option<AxialForce> {
        let rows = self.basic_rows(coordinates).ok()?;
        if displacement.len() != D {
            return None;
        }
        let stiffness = self.basic_beam(rows.length).elastic_stiffness()?;
        let compression = -product(&stiffness, &rows.deformations(displacement))[0];
        Some(AxialForce { compression, end_difference, is_prescribed: false })
    }
}

/// A beam in a deformed state.
pub(super) struct DeformedFiberBeam<'a, const N: usize, const B: usize, const D: usize> {
    beam: BasicBeam<'a, N, B>,
    rows: BasicRows<B, D>,
    /// Basic deformations.
    v: [f64; B],
    state: BasicState<N, B>,
    /// Rotation of the second end about the beam relative to the first, rad; zero without torsion.
    twist: f64,
}

impl<const N: usize, const B: usize, const D: usize> DeformedFiberBeam<'_, N, B, D> {
    /// G J/L, N m; zero without torsion.
    fn torsional_stiffness(&self) -> f64 {
        self.rows.torsion.as_ref().map_or(0.0, |torsion| torsion.stiffness)
    }

    /// Torque, N m.
    fn torque(&self) -> f64 {
        self.torsional_stiffness() * self.twist
    }

    /// Adds the nodal forces to `force`.
    pub(super) fn add_force(&self, force: &mut [f64]) {
        let torque = self.torque();
        let bending = self.rows.rows.iter().zip(self.state.forces);
        let torsion = self.rows.torsion.iter().map(|torsion| (&torsion.row, torque));
        for (row, basic_force) in bending.chain(torsion) {
            for (nodal_force, entry) in force.iter_mut().zip(row) {
                *nodal_force += basic_force * entry;
            }
        }
    }

    /// Adds the tangent to a row-major `matrix`.
    pub(super) fn add_tangent(&self, matrix: &mut [f64]) {
        self.rows.add_stiffness(&self.state.stiffness, matrix);
    }

    /// Energy, J.
    pub(super) fn energy(&self, variables: &[f64]) -> Result<InternalEnergy> {
        let mut energy = self.beam.energy(&self.state, variables)?;
        energy.stored += 0.5 * self.torsional_stiffness() * self.twist * self.twist;
        Ok(energy)
    }

    /// Remainder of a step that begins in this state, and energy at its end, J.
    ///
    /// `stresses`: as for [`BasicBeam::end_step`].
    pub(super) fn end_step(
        &self,
        midstep: &Self,
        end: &Self,
        variables: &[f64],
        stresses: &mut [f64],
    ) -> Result<(f64, InternalEnergy)> {
        let increment = std::array::from_fn(|i| end.v[i] - self.v[i]);
        let states = [&self.state, &midstep.state, &end.state];
        let StepEnd { remainder, mut energy } =
            self.beam.end_step(states, &increment, variables, stresses)?;
        energy.stored += 0.5 * end.torsional_stiffness() * end.twist * end.twist;
        // Work of the torque at mid-step less that of the mean torque, which the torsion stores.
        let mean_twist = 0.5 * (self.twist + end.twist);
        let torque_difference = self.torsional_stiffness() * (midstep.twist - mean_twist);
        Ok((remainder + torque_difference * (end.twist - self.twist), energy))
    }

    /// States of the sections between two nodes.
    pub(super) fn sections(
        &self,
        ends: [[f64; 3]; 2],
        variables: &[f64],
    ) -> Result<Vec<BeamSectionState>> {
        let along = add_scaled(ends[1], -1.0, ends[0]);
        let length = self.rows.length;
        let end_forces = &self.state.forces;
        let sections = self.beam.section_states(&self.state, variables)?.into_iter();
        let states = sections.map(|section| BeamSectionState {
            position: add_scaled(ends[0], section.point.position, along),
            length: section.point.weight * length,
            axial_strain: section.deformations[0],
            curvature: section.deformations[1],
            curvature_about_y: component_in_space(&section.deformations, 2),
            twist_rate: self.twist / length,
            axial_force: section.forces[0],
            moment: section.forces[1],
            moment_about_y: component_in_space(&section.forces, 2),
            torque: self.torque(),
            shear: -(end_forces[1] + end_forces[2]) / length,
            shear_along_z: (component_in_space(end_forces, 3) + component_in_space(end_forces, 4))
                / length,
            fibers: section.fibers,
        });
        Ok(states.collect())
    }

    /// Overwrites `variables` by those after a step that ended in this state.
    ///
    /// `stresses`: stresses of the fibres after [`end_step`](DeformedFiberBeam::end_step); empty if they are not stored.
    pub(super) fn commit(&self, stresses: &[f64], variables: &mut [f64]) {
        self.beam.commit(&self.state, &self.v, stresses, variables);
    }
}

/// Component of a list that is longer in space; zero in the plane.
fn component_in_space(values: &[f64], index: usize) -> f64 {
    values.get(index).copied().unwrap_or(0.0)
}

/// Implements [`InelasticForce`] for a [`FiberElement`].
macro_rules! fiber_element_force {
    ($beam:ident) => {
        impl InelasticForce for $beam {
            fn has_shared_evaluation(&self) -> bool {
                true
            }

            fn variable_count(&self) -> usize {
                self.basic_beam(1.0).variable_count()
            }

            fn initialize(&self, _coordinates: &[[f64; 3]], variables: &mut [f64]) -> Result<()> {
                let quantity = "internal variables of a beam";
                same_length(quantity, variables.len(), self.variable_count())?;
                self.basic_beam(1.0).initialize(variables);
                Ok(())
            }

            fn force(
                &self,
                coordinates: &[[f64; 3]],
                displacement: &[f64],
                variables: &[f64],
                force: &mut [f64],
            ) -> Result<()> {
                self.deformed(coordinates, displacement, variables, &mut [])?.add_force(force);
                Ok(())
            }

            fn tangent(
                &self,
                coordinates: &[[f64; 3]],
                displacement: &[f64],
                variables: &[f64],
                matrix: &mut [f64],
            ) -> Result<()> {
                self.deformed(coordinates, displacement, variables, &mut [])?.add_tangent(matrix);
                Ok(())
            }

            fn stress_count(&self) -> usize {
                self.basic_beam(1.0).fiber_count()
            }

            fn force_and_tangent(
                &self,
                coordinates: &[[f64; 3]],
                displacement: &[f64],
                variables: &[f64],
                force: &mut [f64],
                matrix: &mut [f64],
            ) -> Result<()> {
                let values = [force, matrix, &mut []];
                self.force_tangent_and_stresses(coordinates, displacement, variables, values)
            }

            fn force_tangent_and_stresses(
                &self,
                coordinates: &[[f64; 3]],
                displacement: &[f64],
                variables: &[f64],
                [force, matrix, stresses]: [&mut [f64]; 3],
            ) -> Result<()> {
                let deformed = self.deformed(coordinates, displacement, variables, stresses)?;
                deformed.add_force(force);
                deformed.add_tangent(matrix);
                Ok(())
            }

            fn energy(
                &self,
                coordinates: &[[f64; 3]],
                displacement: &[f64],
                variables: &[f64],
            ) -> Result<InternalEnergy> {
                self.strained(coordinates, displacement, variables)?.energy(variables)
            }

            fn remainder(
                &self,
                coordinates: &[[f64; 3]],
                displacements: [&[f64]; 3],
                variables: &[f64],
            ) -> Result<f64> {
                let mut stresses = vec![0.0; self.stress_count()];
                self.deformed(coordinates, displacements[1], variables, &mut stresses)?;
                let end = self.end_step(coordinates, displacements, variables, &mut stresses);
                end.map(|(remainder, _)| remainder)
            }

            fn end_step(
                &self,
                coordinates: &[[f64; 3]],
                displacements: [&[f64]; 3],
                variables: &[f64],
                stresses: &mut [f64],
            ) -> Result<(f64, InternalEnergy)> {
                let start = self.strained(coordinates, displacements[0], variables)?;
                let midstep = self.strained(coordinates, displacements[1], variables)?;
                let end = self.strained(coordinates, displacements[2], variables)?;
                start.end_step(&midstep, &end, variables, stresses)
            }

            fn sections(
                &self,
                coordinates: &[[f64; 3]],
                displacement: &[f64],
                variables: &[f64],
            ) -> Result<Vec<BeamSectionState>> {
                let deformed = self.deformed(coordinates, displacement, variables, &mut [])?;
                deformed.sections([coordinates[0], coordinates[1]], variables)
            }

            fn commit(
                &self,
                coordinates: &[[f64; 3]],
                displacement: &[f64],
                variables: &mut [f64],
            ) {
                self.commit_stresses(coordinates, displacement, &[], variables);
            }

            /// Changes nothing in a state that a beam by forces cannot have.
            fn commit_stresses(
                &self,
                coordinates: &[[f64; 3]],
                displacement: &[f64],
                stresses: &[f64],
                variables: &mut [f64],
            ) {
                if let Ok(deformed) = self.strained(coordinates, displacement, variables) {
                    deformed.commit(stresses, variables);
                }
            }
        }
    };
}
pub(super) use fiber_element_force;
