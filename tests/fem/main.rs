//! Finite elements and built-in structures against closed forms, statics and outside elements.

mod beams;
mod bending;
mod by_hand;
#[path = "../support/curvature.rs"]
mod curvature;
mod damping;
mod dense;
mod detached;
mod errors;
mod frames;
mod meshes;
mod modal_damping;
mod own_element;
mod p_delta;
mod patch;
mod quad8;
mod rigid_block;
mod rigid_motion;
mod section;
mod shear_building;
