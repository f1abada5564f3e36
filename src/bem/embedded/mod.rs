//! Foundations below the surface, in the plane: soil around a trench.
//!
//! | file | content |
//! |---|---|
//! | trench | the trench and its contact elements |
//! | grid | lines of the mesh around the trench |
//! | polynomials, forms, element | functions and matrices of finite elements |
//! | stack, column | elements one below the other; matrices of a column |
//! | mesh, cliques | degrees of freedom of the mesh; their elimination, matrix by matrix |
//! | compliance | compliances F(s) of the faces; stretched elements below the near field |
//! | soil, free_field | the soil; vertical waves at the faces |
//! | rational, sampling | compliances between samples; choice of the samples |
//! | pairs, source | classes and compliances of pairs of elements; convolution weights |
//! | ground, earth_pressure | the ground of a simulation; pressure at rest |
//! | impedance | a rigid body in the trench |
//! | near_field, box_lines | finite elements that fill the trench around a foundation; lines of their mesh |

mod box_lines;
mod cliques;
mod column;
mod compliance;
mod earth_pressure;
mod element;
mod forms;
mod free_field;
mod grid;
mod ground;
mod impedance;
mod mesh;
mod near_field;
mod pairs;
mod polynomials;
mod rational;
mod sampling;
mod soil;
mod source;
mod stack;
mod trench;

pub use ground::TrenchGround;
pub use impedance::KinematicMotion;
pub use near_field::NearField;
pub use trench::{Trench, TrenchElements};
