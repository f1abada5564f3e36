//! Joints: contact between two lines of nodes of a structure.

mod checkpoint;
mod free_cap;
mod halves;
mod in_ground;
mod portal;
mod pounding;
mod refused;
mod slab;
mod stacked;
