//! Files of other programs: meshes of Gmsh, matrices of Matrix Market, grids for ParaView.
//!
//! The module [`motion`](crate::motion) reads records of ground motion, without this feature.
//!
//! | program or format | here |
//! |---|---|
//! | Gmsh, `.msh` 4.1 and 2.2, text and binary | [`GmshMesh`] in the plane, [`GmshSpaceMesh`] in space |
//! | Matrix Market, `.mtx` | [`Triplets::read_matrix_market`](crate::structure::Triplets::read_matrix_market), `from_matrix_market`, `write_matrix_market`, `to_matrix_market` |
//! | ParaView, `.pvd` and `.vtu` | [`paraview`] |

mod gmsh;
pub mod paraview;

pub use gmsh::{GmshMesh, GmshPart, GmshSpaceMesh};
