//! Deformations of a hinge by displacements of its two nodes, and its nodal forces.
//!
//! | symbol | meaning |
//! |---|---|
//! | u, d | displacements of the element's degrees of freedom; D deformations d = R u |
//! | q | forces conjugate to the deformations; nodal forces Rᵀ q |

use std::fmt::Debug;

use crate::error::{Result, all_finite, require, same_length};
use crate::fem::hinge_state::HingeState;
use crate::fem::inelastic_force::InelasticForce;
use crate::fem::internal_energy::InternalEnergy;
use crate::fem::vector::{add_scaled, distance, dot, norm};
use crate::geometry::Direction;

/// Largest distance of the two nodes of a hinge without a rigid arm, relative to the largest coordinate.
///
/// Rounding of coordinates is far below it.
const MAX_NODE_DISTANCE_RATIO: f64 = 1e-9;

/// Largest number of degrees of freedom of a hinge.
const MAX_ORDER: usize = 12;

/// Weights of the degrees of freedom in each deformation, of which the first are in use.
type Rows<const D: usize> = [[f64; MAX_ORDER]; D];

/// Forces and derivatives of a law.
pub(super) struct HingeResponse<const D: usize> {
    /// Forces conjugate to the deformations.
    pub(super) forces: [f64; D],
    /// Derivatives of the forces with respect to the deformations.
    pub(super) tangent: [[f64; D]; D],
}

/// Forces of a hinge by its D deformations and the variables committed at the end of the last step.
pub(super) trait HingeLaw<const D: usize>: Debug + Send + Sync {
    fn variable_count(&self) -> usize;

    fn initialize(&self, variables: &mut [f64]);

    /// Stiffness of small deformations, which do not couple.
    fn stiffness(&self) -> [f64; D];

    /// Whether each deformation can yield.
    fn yields(&self) -> [bool; D];

    fn response(&self, deformation: &[f64; D], variables: &[f64]) -> Result<HingeResponse<D>>;

    fn energy(&self, deformation: &[f64; D], variables: &[f64]) -> Result<InternalEnergy>;

    /// Work of the forces at mid-step that is neither stored nor dissipated.
    ///
    /// `deformations` are those at the start, at mid-step and at the end.
    fn remainder(&self, deformations: &[[f64; D]; 3], variables: &[f64]) -> Result<f64>;

    fn commit(&self, deformation: &[f64; D], variables: &mut [f64]);
}

/// Axes of a hinge and its law.
#[derive(Debug, Clone)]
pub(super) struct HingeForce<L, const D: usize> {
    pub(super) law: L,
    /// Unit vectors along the member and at right angles to it.
    pub(super) axes: [[f64; 3]; 3],
    /// Axis and kind of each deformation.
    pub(super) deformations: [HingeDeformation; D],
    /// Directions of the degrees of freedom at a node.
    pub(super) directions: &'static [Direction],
    /// Whether the first node may lie away from the hinge.
    pub(super) has_rigid_arm: bool,
}

/// A relative motion of the two nodes.
#[derive(Debug, Clone, Copy)]
pub(super) enum HingeDeformation {
    /// Displacement along an axis of the hinge.
    Displacement(usize),
    /// Rotation about an axis of the hinge.
    Rotation(usize),
}

impl<L: HingeLaw<D>, const D: usize> HingeForce<L, D> {
    /// Returns an error unless the nodes coincide, or a rigid arm connects them.
    pub(super) fn check(&self, coordinates: &[[f64; 3]]) -> Result<()> {
        same_length("nodes of a hinge", coordinates.len(), 2)?;
        let node_distance = distance(coordinates[0], coordinates[1]);
        let largest_coordinate =
            coordinates.as_flattened().iter().fold(0.0_f64, |max, x| max.max(x.abs()));
        let coincide = node_distance <= MAX_NODE_DISTANCE_RATIO * largest_coordinate;
        let needed = "zero, unless the hinge has a rigid arm (with_rigid_arm)";
        require(
            "distance of the nodes of a hinge (m)",
            node_distance,
            coincide || self.has_rigid_arm,
            needed,
        )
        .map(drop)
    }

    /// Number of degrees of freedom.
    fn order(&self) -> usize {
        2 * self.directions.len()
    }

    /// Rows of R.
    fn rows(&self, coordinates: &[[f64; 3]]) -> Result<Rows<D>> {
        same_length("coordinates of a hinge", coordinates.len(), 2)?;
        // A vector from the first node to the hinge, which lies at the second node.
        let arm = add_scaled(coordinates[1], -1.0, coordinates[0]);
        let direction_count = self.directions.len();
        let mut rows = [[0.0; MAX_ORDER]; D];
        for (row, deformation) in rows.iter_mut().zip(self.deformations) {
            for (index, motion) in self.directions.iter().enumerate() {
                row[index] = -self.weight(deformation, *motion, arm);
                row[direction_count + index] = self.weight(deformation, *motion, [0.0; 3]);
            }
        }
        Ok(rows)
    }

    /// Component of a deformation by a unit motion of a node from which an `arm` leads to the hinge.
    fn weight(&self, deformation: HingeDeformation, motion: Direction, arm: [f64; 3]) -> f64 {
        // The rotation of a mesh in the plane is about z.
        let motion = if motion == Direction::Rotation { Direction::RotationZ } else { motion };
        match deformation {
            HingeDeformation::Displacement(axis) => {
                let displacement =
                    TRANSLATION_DIRECTIONS.map(|part| part.in_rigid_motion(motion, arm));
                dot(self.axes[axis], displacement)
            }
            HingeDeformation::Rotation(axis) => {
                let rotation = ROTATION_DIRECTIONS.map(|part| part.in_rigid_motion(motion, arm));
                dot(self.axes[axis], rotation)
            }
        }
    }

    /// Deformations by the displacements of the nodes.
    fn deformation(&self, rows: &Rows<D>, displacement: &[f64]) -> Result<[f64; D]> {
        same_length("displacement of a hinge", displacement.len(), self.order())?;
        let deformation =
            rows.each_ref().map(|row| row.iter().zip(displacement).map(|(a, u)| a * u).sum());
        all_finite("deformation of a hinge", &deformation)?;
        Ok(deformation)
    }

    /// Returns an error for another number of internal variables.
    fn check_variables(&self, variables: &[f64]) -> Result<()> {
        same_length("internal variables of a hinge", variables.len(), self.law.variable_count())
    }

    /// Rows, and the deformations by the displacements of the nodes.
    fn deformed(
        &self,
        coordinates: &[[f64; 3]],
        displacement: &[f64],
        variables: &[f64],
    ) -> Result<DeformedHinge<D>> {
        self.check_variables(variables)?;
        let rows = self.rows(coordinates)?;
        let deformation = self.deformation(&rows, displacement)?;
        Ok(DeformedHinge { rows, deformation })
    }

    /// Adds the stiffness of small deformations to a row-major `matrix`.
    pub(super) fn add_stiffness(&self, coordinates: &[[f64; 3]], matrix: &mut [f64]) {
        let Ok(rows) = self.rows(coordinates) else { return };
        let stiffness = self.law.stiffness();
        let mut diagonal = [[0.0; D]; D];
        for (index, value) in stiffness.into_iter().enumerate() {
            diagonal[index][index] = value;
        }
        self.add_congruent(&rows, &diagonal, matrix);
    }

    /// Adds Rᵀ k R to a row-major `matrix`.
    fn add_congruent(&self, rows: &Rows<D>, k: &[[f64; D]; D], matrix: &mut [f64]) {
        let order = self.order();
        for (row, k_row) in rows.iter().zip(k) {
            for (column, value) in rows.iter().zip(k_row).filter(|(_, value)| **value != 0.0) {
                for i in 0..order {
                    for j in 0..order {
                        matrix[i * order + j] += value * row[i] * column[j];
                    }
                }
            }
        }
    }
}

/// A hinge at displacements of its nodes.
struct DeformedHinge<const D: usize> {
    rows: Rows<D>,
    deformation: [f64; D],
}

/// Displacements in space.
const TRANSLATION_DIRECTIONS: [Direction; 3] = [Direction::X, Direction::Y, Direction::Z];
/// Rotations in space.
const ROTATION_DIRECTIONS: [Direction; 3] =
    [Direction::RotationX, Direction::RotationY, Direction::RotationZ];

impl<L: HingeLaw<D>, const D: usize> InelasticForce for HingeForce<L, D> {
    fn variable_count(&self) -> usize {
        self.law.variable_count()
    }

    fn initialize(&self, _coordinates: &[[f64; 3]], variables: &mut [f64]) -> Result<()> {
        self.check_variables(variables)?;
        self.law.initialize(variables);
        Ok(())
    }

    fn force(
        &self,
        coordinates: &[[f64; 3]],
        displacement: &[f64],
        variables: &[f64],
        force: &mut [f64],
    ) -> Result<()> {
        let hinge = self.deformed(coordinates, displacement, variables)?;
        let response = self.law.response(&hinge.deformation, variables)?;
        all_finite("forces of a hinge", &response.forces)?;
        for (row, value) in hinge.rows.iter().zip(response.forces) {
            for (nodal_force, weight) in force.iter_mut().zip(row) {
                *nodal_force += weight * value;
            }
        }
        Ok(())
    }

    fn tangent(
        &self,
        coordinates: &[[f64; 3]],
        displacement: &[f64],
        variables: &[f64],
        matrix: &mut [f64],
    ) -> Result<()> {
        same_length("tangent of a hinge", matrix.len(), self.order() * self.order())?;
        let hinge = self.deformed(coordinates, displacement, variables)?;
        let response = self.law.response(&hinge.deformation, variables)?;
        self.add_congruent(&hinge.rows, &response.tangent, matrix);
        Ok(())
    }

    fn energy(
        &self,
        coordinates: &[[f64; 3]],
        displacement: &[f64],
        variables: &[f64],
    ) -> Result<InternalEnergy> {
        let hinge = self.deformed(coordinates, displacement, variables)?;
        self.law.energy(&hinge.deformation, variables)
    }

    fn remainder(
        &self,
        coordinates: &[[f64; 3]],
        displacements: [&[f64]; 3],
        variables: &[f64],
    ) -> Result<f64> {
        let start = self.deformed(coordinates, displacements[0], variables)?;
        let midstep = self.deformation(&start.rows, displacements[1])?;
        let end = self.deformation(&start.rows, displacements[2])?;
        self.law.remainder(&[start.deformation, midstep, end], variables)
    }

    fn yielding_deformations(&self, coordinates: &[[f64; 3]]) -> Vec<Vec<f64>> {
        let Ok(rows) = self.rows(coordinates) else { return Vec::new() };
        let can_yield = rows.into_iter().zip(self.law.yields());
        let rows = can_yield.filter(|(_, yields)| *yields);
        rows.map(|(row, _)| row[..self.order()].to_vec()).collect()
    }

    fn hinge(
        &self,
        coordinates: &[[f64; 3]],
        displacement: &[f64],
        variables: &[f64],
    ) -> Result<Option<HingeState>> {
        let hinge = self.deformed(coordinates, displacement, variables)?;
        let response = self.law.response(&hinge.deformation, variables)?;
        let stiffness = self.law.stiffness();
        let mut state =
            HingeState { position: coordinates[1], axes: self.axes, ..HingeState::default() };
        for (index, kind) in self.deformations.iter().enumerate() {
            let deformation = hinge.deformation[index];
            let force = response.forces[index];
            let plastic = deformation - force / stiffness[index];
            match *kind {
                HingeDeformation::Displacement(axis) => {
                    state.displacement[axis] = deformation;
                    state.force[axis] = force;
                    state.plastic_displacement[axis] = plastic;
                }
                HingeDeformation::Rotation(axis) => {
                    state.rotation[axis] = deformation;
                    state.moment[axis] = force;
                    state.plastic_rotation[axis] = plastic;
                }
            }
        }
        Ok(Some(state))
    }

    /// Changes nothing in a state that the hinge cannot have.
    fn commit(&self, coordinates: &[[f64; 3]], displacement: &[f64], variables: &mut [f64]) {
        if let Ok(hinge) = self.deformed(coordinates, displacement, variables) {
            self.law.commit(&hinge.deformation, variables);
        }
    }
}

/// Unit vector along a vector that is finite and not zero.
///
/// # Errors
/// [`Error::NotFinite`](crate::Error::NotFinite) and [`Error::Input`](crate::Error::Input).
pub(super) fn unit_axis(axis: [f64; 3]) -> Result<[f64; 3]> {
    all_finite("axis of a hinge", &axis)?;
    let length = norm(axis);
    let needed = "finite and above zero";
    require("length of the axis of a hinge", length, length.is_finite() && length > 0.0, needed)?;
    Ok(axis.map(|component| component / length))
}
