//! GOAL: structures given by their matrices, and their reduction.
//! SCENE: a meshed tower as matrices.
//! REFERENCE: the model that the matrices came from.

mod damping;
mod model;
mod reduction;
mod semi_definite;
mod supports;
mod triplets;
mod yielding_elements;
