//! Structures given by their matrices: files, checks, and reduction.

mod damping;
mod market;
mod model;
mod reduction;
mod ride;
mod semi_definite;
