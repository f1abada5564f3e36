//! Forces of elements with internal variables.

use super::hinge_state::HingeState;
use super::internal_energy::InternalEnergy;
use super::solid::SolidState;
use crate::error::Result;

/// Force of an element with internal variables, such as plastic strains.
///
/// An [`Element`](super::Element) returns it by [`Element::inelastic`](super::Element::inelastic), and a
/// [`FemModel`](crate::structure::FemModel) with such an element has a
/// [`NonlinearForce`](crate::structure::NonlinearForce). The model stores the internal variables of all elements, and
/// passes each element its own. `coordinates` holds [x, y, z] (m) of the element's nodes, and `displacement` its
/// degrees of freedom (m, rad) in the order of its matrices.
///
/// `variables` are those **committed** at the end of the last step. Force, tangent and energy belong to the straight
/// path from the committed displacement to `displacement`; only [`commit`](InelasticForce::commit) changes variables.
pub trait InelasticForce: Send + Sync {
    /// Number of the element's internal variables.
    fn variable_count(&self) -> usize;

    /// Overwrites `variables` by those of the undeformed element.
    ///
    /// # Errors
    /// Any, for a state at rest that the element cannot have.
    fn initialize(&self, coordinates: &[[f64; 3]], variables: &mut [f64]) -> Result<()>;

    /// Adds the nodal forces (N, in the plane per metre) to `force`.
    ///
    /// # Errors
    /// Any: the step ends with it, and nothing of the step is committed.
    fn force(
        &self,
        coordinates: &[[f64; 3]],
        displacement: &[f64],
        variables: &[f64],
        force: &mut [f64],
    ) -> Result<()>;

    /// Adds the tangent ∂force/∂displacement, row by row, to `matrix`.
    ///
    /// # Errors
    /// As for [`force`](InelasticForce::force).
    fn tangent(
        &self,
        coordinates: &[[f64; 3]],
        displacement: &[f64],
        variables: &[f64],
        matrix: &mut [f64],
    ) -> Result<()>;

    /// Whether [`force_and_tangent`](InelasticForce::force_and_tangent) takes little longer than the force. Default: no.
    ///
    /// A model then computes the tangent with each force, and stores it for an iteration that needs it.
    fn has_shared_evaluation(&self) -> bool {
        false
    }

    /// Adds force and tangent at one displacement. Default: one after the other.
    ///
    /// # Errors
    /// As for [`force`](InelasticForce::force).
    fn force_and_tangent(
        &self,
        coordinates: &[[f64; 3]],
        displacement: &[f64],
        variables: &[f64],
        force: &mut [f64],
        matrix: &mut [f64],
    ) -> Result<()> {
        self.force(coordinates, displacement, variables, force)?;
        self.tangent(coordinates, displacement, variables, matrix)
    }

    /// Number of stresses that a model stores between evaluations of a step. Default: none.
    #[doc(hidden)]
    fn stress_count(&self) -> usize {
        0
    }

    /// As [`force_and_tangent`](InelasticForce::force_and_tangent), with a list of stresses for the end of the step.
    #[doc(hidden)]
    fn force_tangent_and_stresses(
        &self,
        coordinates: &[[f64; 3]],
        displacement: &[f64],
        variables: &[f64],
        [force, matrix, _stresses]: [&mut [f64]; 3],
    ) -> Result<()> {
        self.force_and_tangent(coordinates, displacement, variables, force, matrix)
    }

    /// Whether the tangent is symmetric at every displacement. Default: yes.
    fn has_symmetric_tangent(&self) -> bool {
        true
    }

    /// Stored energy, and energy dissipated since the undeformed state, J (in the plane per metre).
    ///
    /// # Errors
    /// As for [`force`](InelasticForce::force).
    fn energy(
        &self,
        coordinates: &[[f64; 3]],
        displacement: &[f64],
        variables: &[f64],
    ) -> Result<InternalEnergy>;

    /// Work of the force inside a step that is neither stored nor dissipated, J.
    ///
    /// In the plane it is per metre.
    ///
    /// It is f(`midstep`)·(`end` − `start`) less the changes of [`energy`](InelasticForce::energy) from `start`, the
    /// committed displacement, to `end`; `displacements` are start, midstep and end. Compute it from a separate formula
    /// where there is one: the energy balance of a run then checks force and energies.
    ///
    /// # Errors
    /// As for [`force`](InelasticForce::force).
    fn remainder(
        &self,
        coordinates: &[[f64; 3]],
        displacements: [&[f64]; 3],
        variables: &[f64],
    ) -> Result<f64>;

    /// Remainder of a step, and energies at its end, as the two methods. Default: one after the other.
    ///
    /// `stresses`: stresses at mid-step from
    /// [`force_tangent_and_stresses`](InelasticForce::force_tangent_and_stresses). They become the stresses for
    /// [`commit_stresses`](InelasticForce::commit_stresses).
    ///
    /// # Errors
    /// As for [`force`](InelasticForce::force).
    #[doc(hidden)]
    fn end_step(
        &self,
        coordinates: &[[f64; 3]],
        displacements: [&[f64]; 3],
        variables: &[f64],
        _stresses: &mut [f64],
    ) -> Result<(f64, InternalEnergy)> {
        let energy = self.energy(coordinates, displacements[2], variables)?;
        Ok((self.remainder(coordinates, displacements, variables)?, energy))
    }

    /// Rows of the deformations that can yield: weights of the element's degrees of freedom. Default: none.
    ///
    /// A model returns an error if its links and ties do not let one of them change. Such an element would be rigid there.
    fn yielding_deformations(&self, _coordinates: &[[f64; 3]]) -> Vec<Vec<f64>> {
        Vec::new()
    }

    /// Overwrites `variables` by those after a step that ended with `displacement`.
    fn commit(&self, coordinates: &[[f64; 3]], displacement: &[f64], variables: &mut [f64]);

    /// As [`commit`](InelasticForce::commit), with the stresses of [`end_step`](InelasticForce::end_step).
    #[doc(hidden)]
    fn commit_stresses(
        &self,
        coordinates: &[[f64; 3]],
        displacement: &[f64],
        _stresses: &[f64],
        variables: &mut [f64],
    ) {
        self.commit(coordinates, displacement, variables);
    }

    /// States of the integration points, for results and pictures. Default: none.
    ///
    /// # Errors
    /// As for [`force`](InelasticForce::force).
    fn points(
        &self,
        _coordinates: &[[f64; 3]],
        _displacement: &[f64],
        _variables: &[f64],
    ) -> Result<Vec<SolidPoint>> {
        Ok(Vec::new())
    }

    /// States of the sections of a beam of fibres, for results. Default: none.
    ///
    /// # Errors
    /// As for [`force`](InelasticForce::force).
    fn sections(
        &self,
        _coordinates: &[[f64; 3]],
        _displacement: &[f64],
        _variables: &[f64],
    ) -> Result<Vec<BeamSectionState>> {
        Ok(Vec::new())
    }

    /// State of a hinge, for results. Default: `None`, for other elements.
    ///
    /// # Errors
    /// As for [`force`](InelasticForce::force).
    fn hinge(
        &self,
        _coordinates: &[[f64; 3]],
        _displacement: &[f64],
        _variables: &[f64],
    ) -> Result<Option<HingeState>> {
        Ok(None)
    }
}

/// Method that returns states in an element from coordinates, displacement and internal variables.
pub(crate) type ReadStates<T> =
    fn(&dyn InelasticForce, &[[f64; 3]], &[f64], &[f64]) -> Result<Vec<T>>;

/// [`InelasticForce::points`] as a [`ReadStates`].
pub(crate) fn read_points(
    force: &dyn InelasticForce,
    coordinates: &[[f64; 3]],
    displacement: &[f64],
    variables: &[f64],
) -> Result<Vec<SolidPoint>> {
    force.points(coordinates, displacement, variables)
}

/// [`InelasticForce::sections`] as a [`ReadStates`].
pub(crate) fn read_sections(
    force: &dyn InelasticForce,
    coordinates: &[[f64; 3]],
    displacement: &[f64],
    variables: &[f64],
) -> Result<Vec<BeamSectionState>> {
    force.sections(coordinates, displacement, variables)
}

/// [`InelasticForce::hinge`] as a [`ReadStates`], with one state or none.
pub(crate) fn read_hinge(
    force: &dyn InelasticForce,
    coordinates: &[[f64; 3]],
    displacement: &[f64],
    variables: &[f64],
) -> Result<Vec<HingeState>> {
    let state = force.hinge(coordinates, displacement, variables)?;
    Ok(Vec::from_iter(state))
}

/// State of a section of a beam of fibres.
///
/// Directions are the axes of the beam: x from the first to the second node, y and z in the section. In the plane y is to the
/// left of x, and what concerns bending along z and torsion is zero. Moments and curvatures follow the right-hand rule.
/// Shear forces and torque are those of equilibrium along the beam, without the P–Δ effect; they act from the side of
/// the second node.
#[derive(Debug, Clone, PartialEq, Default)]
#[non_exhaustive]
pub struct BeamSectionState {
    /// Position [x, y, z] on the undeformed line between the nodes, m.
    pub position: [f64; 3],
    /// Part of the length of the beam for which the section stands, m.
    pub length: f64,
    /// Strain of the line between the nodes; elongation is positive.
    pub axial_strain: f64,
    /// Curvature about z, 1/m; it is positive where it stretches the fibres at negative y.
    pub curvature: f64,
    /// Curvature about y, 1/m; it is positive where it stretches the fibres at positive z.
    pub curvature_about_y: f64,
    /// Change of the rotation about x along the beam, rad/m.
    pub twist_rate: f64,
    /// Axial force, N; tension is positive.
    pub axial_force: f64,
    /// Bending moment about z, N m, positive with the curvature.
    pub moment: f64,
    /// Bending moment about y, N m, positive with the curvature about y.
    pub moment_about_y: f64,
    /// Torque about x, N m, positive with the twist rate.
    pub torque: f64,
    /// Shear force along y, N.
    pub shear: f64,
    /// Shear force along z, N.
    pub shear_along_z: f64,
    /// Fibres in the order of the section.
    pub fibers: Vec<FiberState>,
}

/// Strain and stress of a fibre.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct FiberState {
    /// Coordinates [y, z] in the section, m.
    pub position: [f64; 2],
    /// Area, m².
    pub area: f64,
    /// Strain; tension is positive.
    pub strain: f64,
    /// Stress, Pa; tension is positive.
    pub stress: f64,
}

impl FiberState {
    /// State of a fibre at [y, z], m, with an area, m².
    pub fn new(position: [f64; 2], area: f64, strain: f64, stress: f64) -> Self {
        Self { position, area, strain, stress }
    }
}

/// State of a solid at an integration point of an element.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct SolidPoint {
    /// Position [x, y] in the undeformed mesh, m.
    pub position: [f64; 2],
    /// Area of the integration point, m².
    pub area: f64,
    /// Strains `[xx, yy, zz, xy]`, with the engineering shear strain.
    pub strain: [f64; 4],
    /// Stresses `[xx, yy, zz, xy]`, Pa; tension is positive.
    pub stress: [f64; 4],
    /// Plastic strain and mobilised strength.
    pub state: SolidState,
}

impl SolidPoint {
    /// State at a position, m, that stands for an area, m².
    pub fn new(
        position: [f64; 2],
        area: f64,
        strain: [f64; 4],
        stress: [f64; 4],
        state: SolidState,
    ) -> Self {
        Self { position, area, strain, stress, state }
    }
}
