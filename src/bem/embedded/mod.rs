//! Foundations below the surface, in the plane: impedances and kinematic motion of a rigid body in a trench.
//!
//! | file | content |
//! |---|---|
//! | trench | the trench and its contact elements |
//! | grid | lines of the mesh around it |
//! | polynomials, stack, bottom | finite elements; a column of them; stretched elements below |
//! | compliance | compliances F(s) of the faces |
//! | ground, free_field | the soil; vertical waves at the faces |
//! | impedance, motion | a rigid body in the trench |

mod bottom;
mod compliance;
mod free_field;
mod grid;
mod ground;
mod impedance;
mod motion;
mod polynomials;
mod stack;
mod trench;

pub use ground::TrenchGround;
pub use motion::KinematicMotion;
pub use trench::{Trench, TrenchElements};
