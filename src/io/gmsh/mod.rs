//! Meshes from Gmsh.

mod cell;
mod kind;
mod parse;
mod part;
mod plane;
mod space;

pub use part::GmshPart;
pub use plane::GmshMesh;
pub use space::GmshSpaceMesh;
