//! Meshes from Gmsh.

mod cell;
mod fields;
mod kind;
mod merge;
mod parse;
mod part;
mod plane;
mod raw;
mod space;
mod version2;
mod version4;

pub use part::GmshPart;
pub use plane::GmshMesh;
pub use space::GmshSpaceMesh;
