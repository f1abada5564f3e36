//! Finite elements: solids, shells, beams, trusses, masses, springs, and elements of your own.
//!
//! A [`Mesh`] has nodes and [`Element`]s; a [`FemModel`](crate::structure::FemModel) is the structure of a mesh.

mod assembly;
mod beam;
mod block;
pub(crate) mod coincident;
mod duplicate;
mod element;
mod element_matrix;
mod element_nodes;
mod fiber;
mod force_rotation;
mod grid;
#[cfg(test)]
pub(crate) mod hardening;
mod hex8;
mod hinge;
mod hinge_state;
mod inelastic_force;
pub(crate) mod internal_energy;
mod layer;
mod line;
mod lumped_mass;
mod material;
mod mean_dilatation;
mod merge;
mod mesh;
mod mesh_at_rest;
mod numbering;
mod quad4;
mod quad8;
mod quad_force;
mod shell;
mod small_matrix;
mod solid;
mod spring;
mod stress_at_rest;
mod truss;
mod vector;

#[doc(inline)]
pub use crate::geometry::Direction;
pub(crate) use assembly::{MatrixKind, assemble, set_static_state};
pub(crate) use beam::EndFrame;
pub use beam::{Beam, BeamSection, FiberBeam, SpaceBeam, SpaceFiberBeam};
pub use element::{Element, ElementFace, MassKind};
pub use fiber::{
    BeamFormulation, BeamQuadrature, BilinearSteel, Concrete, FiberSection, MenegottoPinto,
    UniaxialMaterial, UniaxialResponse,
};
pub use grid::Grid;
pub use hex8::Hex8;
pub use hinge::{AxialMomentSurface, BilinearMoment, Hinge, InteractionHinge, SpaceHinge};
pub use hinge_state::HingeState;
pub use inelastic_force::{BeamSectionState, FiberState, InelasticForce, SolidPoint};
pub(crate) use inelastic_force::{ReadStates, read_hinge, read_points, read_sections};
pub use layer::Layer;
pub use lumped_mass::LumpedMass;
pub use material::Material;
pub use merge::MergedNodes;
pub use mesh::Mesh;
pub(crate) use numbering::Numbering;
pub use quad4::{Quad4, QuadFormulation};
pub use quad8::{Quad8, Quad8Integration};
pub use shell::{Shell, ShellResultants};
pub use solid::{DruckerPrager, Iwan, SharedMaterial, SolidMaterial, SolidState, StrainPath};
pub use spring::{Dashpot, Spring};
pub use stress_at_rest::StressAtRest;
pub use truss::Truss;
