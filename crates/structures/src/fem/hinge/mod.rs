//! Concentrated hinges between two nodes at one place: moments that yield, alone or with axial forces.
//!
//! | part | files |
//! |---|---|
//! | deformations by displacements of the nodes, and nodal forces | `hinge_force.rs` |
//! | laws of the forces | `moment_law.rs`, `plastic_law.rs`; `bilinear_moment.rs`: a moment–rotation law |
//! | convex sets of forces, and the closest points of them | `convex_set.rs`; `ellipse.rs`, `polygon.rs`, `parabola.rs` |
//! | elements | `moment_hinge.rs`; `interaction_hinge.rs` with `axial_moment_surface.rs`; `space_hinge.rs` |

mod axial_moment_surface;
mod bilinear_moment;
mod convex_set;
mod ellipse;
mod hinge_force;
mod interaction_hinge;
mod moment_hinge;
mod moment_law;
mod parabola;
mod plastic_law;
mod polygon;
mod space_hinge;
#[cfg(test)]
mod tests;

pub use axial_moment_surface::AxialMomentSurface;
pub use bilinear_moment::BilinearMoment;
pub use interaction_hinge::InteractionHinge;
pub use moment_hinge::Hinge;
pub use space_hinge::SpaceHinge;
