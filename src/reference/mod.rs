//! Closed-form solutions from the literature, to check computations.
//!
//! Each type is one published solution, with its source. Rotations and moments are positive
//! counter-clockwise, x to the right, y up; loads are per metre of thickness, in SI units.

mod line_load;
mod rigid_strip;
mod rocking_block;
mod settlement;
mod sliding_block;
mod sliding_estimate;
mod sliding_history;
mod strip;
mod uplift_law;
mod welded_rectangle;
mod winkler_strip;

pub use line_load::{
    flamant_horizontal_displacement, flamant_radial_stress, flamant_relative_settlement,
    kelvin_relative_displacement,
};
pub use rigid_strip::RigidStrip;
pub use rocking_block::RockingBlock;
pub use settlement::{hertz_plate_settlement, loaded_rectangle_settlement};
pub use sliding_block::SlidingBlock;
pub use sliding_estimate::SlidingEstimate;
pub use sliding_history::{SlidingEvent, SlidingHistory};
pub use strip::{NoTensionStrip, StripContact};
pub use uplift_law::UpliftLaw;
pub use welded_rectangle::pais_kausel_impedances;
pub use winkler_strip::WinklerStrip;
