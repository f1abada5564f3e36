//! Meshes from Gmsh.

mod cell;
mod fields;
mod kind;
mod merge;
mod parse;
mod plane;
mod raw;
mod space;
mod version2;
mod version4;

pub use plane::GmshMesh;
pub use space::{GmshPart, GmshSpaceMesh};
