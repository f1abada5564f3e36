//! Finite elements: solids, shells, beams, trusses, masses, springs, and your own.
//!
//! A [`Mesh`] is a list of nodes and of [`Element`]s; [`crate::structure::FemModel`] makes a structure of it.
//! In the plane all quantities are per metre of thickness, x points to the right, y up, and rotations are
//! counter-clockwise. In space ([`Mesh::in_space`]) x points to the right, y away and z up, and rotations follow the
//! right-hand rule.
//!
//! ```
//! use basemat::fem::{Layer, Material, Mesh};
//!
//! let concrete = Material::new(30.0e9, 0.2, 2400.0)?;
//! let mesh = Mesh::layered_block(-5.0..5.0, 4, &[Layer::new(2.0, 1, concrete)])?;
//! assert_eq!(mesh.nodes().len(), 10);
//! assert_eq!(mesh.nodes()[0], [-5.0, 0.0, 0.0]);
//! # Ok::<(), basemat::Error>(())
//! ```

mod assembly;
mod beam;
mod coincident;
mod condensation;
mod duplicate;
mod element;
mod element_face;
mod force_rotation;
mod grid;
mod hex8;
mod layer;
mod line;
mod lumped_mass;
mod material;
mod merge;
mod mesh;
mod numbering;
mod quad4;
mod quad8;
mod shell;
mod spring;
mod truss;
mod vector;

#[doc(inline)]
pub use crate::geometry::Direction;
#[doc(hidden)]
pub use assembly::{MatrixKind, assemble, set_static_state};
#[doc(hidden)]
pub use beam::EndFrame;
pub use beam::{Beam, BeamSection, SpaceBeam};
#[doc(hidden)]
pub use coincident::first_at_place;
pub use element::{Element, MassKind};
pub use element_face::ElementFace;
pub use grid::Grid;
pub use hex8::Hex8;
pub use layer::Layer;
pub use lumped_mass::LumpedMass;
pub use material::Material;
pub use merge::MergedNodes;
pub use mesh::Mesh;
#[doc(hidden)]
pub use numbering::Numbering;
pub use quad4::{Quad4, QuadFormulation};
pub use quad8::{Quad8, Quad8Integration};
pub use shell::{Shell, ShellResultants};
pub use spring::{Dashpot, Spring};
pub use truss::Truss;
