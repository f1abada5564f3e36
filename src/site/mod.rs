//! Site response: waves from the base of a layered ground to its surface.
//!
//! [`Column`] takes vertically travelling waves up and down, [`InclinedWave`] makes a free field of SV
//! and P waves that come at an angle. A [`SiteMotion`] says what its samples cannot hold.

mod column;
mod inclined;
mod sampled;
mod slowness;
mod transform;

pub use column::{Column, ControlPoint, VerticalWave};
pub use inclined::{InclinedControl, InclinedWave};
pub use transform::SiteMotion;
