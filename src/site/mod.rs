//! Site response: waves from the base of a layered ground to its surface.
//!
//! [`SoilColumn`] takes vertically travelling waves up and down, [`InclinedWave`] makes a free field of SV
//! and P waves that come at an angle. A [`SiteMotion`] says what its samples cannot hold.

mod inclined;
mod sampled;
mod slowness;
mod soil_column;
mod transform;

pub use inclined::{InclinedControl, InclinedWave};
pub use soil_column::{ControlPoint, SoilColumn, VerticalWave};
pub use transform::SiteMotion;
