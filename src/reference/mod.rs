//! Closed forms from the literature, for checks of computations.
//!
//! Each type is one published solution, with its source. Rotations and moments are positive
//! counter-clockwise, x to the right, y up; loads are per metre of thickness, in SI units.

mod line_load;
mod rocking_block;
mod sliding_block;
mod strip;

pub use line_load::{
    flamant_horizontal_displacement, flamant_radial_stress, flamant_relative_settlement,
    kelvin_relative_displacement,
};
pub use rocking_block::RockingBlock;
pub use sliding_block::{SlidingBlock, SlidingEvent, SlidingHistory};
pub use strip::{NoTensionStrip, RigidStrip, StripContact, WinklerStrip};
