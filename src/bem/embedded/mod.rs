//! Foundations below the surface, in the plane: soil around a trench.
//!
//! | file | content |
//! |---|---|
//! | trench | the trench and its contact elements |
//! | grid | lines of the mesh around it |
//! | polynomials, stack, bottom | finite elements; a column of them; stretched elements below |
//! | compliance | compliances F(s) of the faces |
//! | soil, free_field | the soil; vertical waves at the faces |
//! | pairs, source | compliances of pairs of elements; convolution weights |
//! | ground, earth_pressure | the ground of a simulation; pressure at rest |
//! | impedance | a rigid body in the trench |

mod classes;
mod compliance;
mod earth_pressure;
mod free_field;
mod grid;
mod ground;
mod impedance;
mod pairs;
mod polynomials;
mod soil;
mod source;
mod stack;
mod trench;

pub use ground::TrenchGround;
pub use impedance::KinematicMotion;
pub use trench::{Trench, TrenchElements};
