//! Finite elements: solids, shells, beams, trusses, masses, springs, and elements of your own.
//!
//! A [`Mesh`] has nodes and [`Element`]s; a [`FemModel`](crate::structure::FemModel) is the structure of a mesh.
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

pub use basemat_structures::fem::*;

#[cfg(feature = "io")]
pub(crate) use basemat_structures::internal::first_coincident_points;
