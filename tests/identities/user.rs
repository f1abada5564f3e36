//! Parts as a user writes them: they delegate the methods of a trait, and hide the library's types.

use basemat::Result;
use basemat::bem::{self, GroundDescription};
use basemat::fem::{
    self, Direction, ElementFace, InelasticForce, MassKind, SharedMaterial, SolidMaterial,
};
use basemat::interface::{ContactScene, ContactState, InterfaceLaw, Mode, PreviousContact};
use basemat::structure::{self, InternalEnergy, NonlinearForce, Triplets};
use basemat_problems::{ground_from, law_from, needed_from};

/// A structure with the matrices of another one.
pub(crate) struct UserStructure(pub(crate) Box<dyn structure::Structure>);

impl structure::Structure for UserStructure {
    needed_from!(0);

    fn damping(&self, matrix: &mut Triplets) -> Result<()> {
        self.0.damping(matrix)
    }

    fn nonlinear(&self) -> Option<&dyn NonlinearForce> {
        self.0.nonlinear()
    }

    fn nonlinear_mut(&mut self) -> Option<&mut dyn NonlinearForce> {
        self.0.nonlinear_mut()
    }
}

/// A ground with the compliances of another one.
pub(crate) struct UserGround(pub(crate) Box<dyn bem::Ground>);

impl bem::Ground for UserGround {
    ground_from!(0);

    fn finer_compliance(&self) -> Result<Option<Vec<f64>>> {
        self.0.finer_compliance()
    }

    /// Pressure at rest of the soil around walls.
    fn description(&self) -> GroundDescription {
        self.0.description()
    }
}

/// A law with the conditions of another one.
pub(crate) struct UserLaw(pub(crate) Box<dyn InterfaceLaw>);

impl InterfaceLaw for UserLaw {
    law_from!(0);

    fn compliance(&self, mode: Mode, start: &PreviousContact) -> [f64; 2] {
        self.0.compliance(mode, start)
    }

    fn state_variables(&self) -> usize {
        self.0.state_variables()
    }

    fn initial_state_variables(&self, start: &PreviousContact, variables: &mut [f64]) {
        self.0.initial_state_variables(start, variables);
    }

    fn commit(
        &self,
        start: &PreviousContact,
        end: &ContactState,
        mode: Mode,
        variables: &mut [f64],
    ) {
        self.0.commit(start, end, mode, variables);
    }

    fn bond_overload(&self, start: &PreviousContact, trial: &ContactState) -> Option<f64> {
        self.0.bond_overload(start, trial)
    }

    fn frictionless(&self) -> Box<dyn InterfaceLaw> {
        self.0.frictionless()
    }

    fn friction_coefficient(&self) -> Option<f64> {
        self.0.friction_coefficient()
    }

    fn check(&self, scene: &ContactScene) -> Result<()> {
        self.0.check(scene)
    }
}

/// An element with the matrices of another one.
pub(crate) struct UserElement(pub(crate) Box<dyn fem::Element>);

impl fem::Element for UserElement {
    fn nodes(&self) -> &[usize] {
        self.0.nodes()
    }

    fn directions(&self) -> &[Direction] {
        self.0.directions()
    }

    fn stiffness(&self, coordinates: &[[f64; 3]], matrix: &mut [f64]) {
        self.0.stiffness(coordinates, matrix);
    }

    fn geometric_stiffness(&self, coordinates: &[[f64; 3]], matrix: &mut [f64]) {
        self.0.geometric_stiffness(coordinates, matrix);
    }

    fn in_static_state(
        &self,
        coordinates: &[[f64; 3]],
        displacement: &[f64],
        gravity: f64,
    ) -> Option<Box<dyn fem::Element>> {
        let element = self.0.in_static_state(coordinates, displacement, gravity)?;
        Some(Box::new(Self(element)))
    }

    fn compression(&self) -> Option<f64> {
        self.0.compression()
    }

    fn mass(&self, coordinates: &[[f64; 3]], kind: MassKind, matrix: &mut [f64]) {
        self.0.mass(coordinates, kind, matrix);
    }

    fn damping(&self, coordinates: &[[f64; 3]], matrix: &mut [f64]) {
        self.0.damping(coordinates, matrix);
    }

    fn faces(&self) -> Vec<ElementFace> {
        self.0.faces()
    }

    fn is_plane(&self) -> bool {
        self.0.is_plane()
    }

    fn inelastic(&self) -> Option<&dyn InelasticForce> {
        self.0.inelastic()
    }

    fn has_stiffness_damping(&self) -> bool {
        self.0.has_stiffness_damping()
    }
}

/// A material with the stresses of another one, and the remainder by its definition.
#[derive(Debug)]
pub(crate) struct UserMaterial(pub(crate) SharedMaterial);

impl SolidMaterial for UserMaterial {
    fn density(&self) -> f64 {
        self.0.law().density()
    }

    fn elasticity(&self) -> [[f64; 4]; 4] {
        self.0.law().elasticity()
    }

    fn variable_count(&self) -> usize {
        self.0.law().variable_count()
    }

    fn initialize(&self, initial_stress: [f64; 4], variables: &mut [f64]) -> Result<()> {
        self.0.law().initialize(initial_stress, variables)
    }

    fn stress(&self, strain: [f64; 4], variables: &[f64]) -> Result<[f64; 4]> {
        self.0.law().stress(strain, variables)
    }

    fn tangent(&self, strain: [f64; 4], variables: &[f64]) -> Result<[[f64; 4]; 4]> {
        self.0.law().tangent(strain, variables)
    }

    fn has_symmetric_tangent(&self) -> bool {
        self.0.law().has_symmetric_tangent()
    }

    fn energy(&self, strain: [f64; 4], variables: &[f64]) -> Result<InternalEnergy> {
        self.0.law().energy(strain, variables)
    }

    fn commit(&self, strain: [f64; 4], variables: &mut [f64]) {
        self.0.law().commit(strain, variables);
    }
}
