//! Foundations below the surface, in the plane: soil around a trench.
//!
//! | file | content |
//! |---|---|
//! | trench | the trench and its contact elements |
//! | grid | lines of the mesh around the trench |
//! | polynomials, stack, column | functions of finite elements; their order in a column; matrices of a column |
//! | compliance | compliances F(s) of the faces; stretched elements below the near field |
//! | soil, free_field | the soil; vertical waves at the faces |
//! | pairs, source | classes and compliances of pairs of elements; convolution weights |
//! | ground, earth_pressure | the ground of a simulation; pressure at rest |
//! | impedance | a rigid body in the trench |

mod column;
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
