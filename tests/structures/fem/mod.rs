//! GOAL: finite elements and built-in structures.
//! SCENE: single elements, patches, beams, frames, blocks and shear buildings.
//! REFERENCE: closed forms, statics, and elements from outside the crate.

mod beam_ends;
mod beams;
mod bending;
mod by_hand;
mod damping;
mod detached;
mod errors;
mod frames;
mod in_space;
mod line_loads;
mod merging;
mod meshes;
mod modal_damping;
mod opensees_fibers;

mod p_delta;
mod p_delta_in_space;
mod p_delta_links;
mod patch;
mod quad8;
mod rigid_block;
mod rigid_motion;
mod section;
mod shear_building;
mod shells;
mod space_section;
mod user_element;
mod yielding_layers;
mod yielding_strip;
