//! Site response: waves from the base of a layered ground to its surface.
//!
//! [`SoilColumn`] takes vertically travelling waves up and down and finds strain-compatible properties
//! ([`SoilColumn::equivalent_linear`]), [`InclinedWave`] makes a free field of SV,
//! P and SH waves that come at an angle. A [`SiteMotion`] says what its samples cannot hold.

mod equivalent_linear;
mod inclined;
mod sampled;
mod site_warning;
mod slowness;
mod soil_column;
mod transform;

pub use equivalent_linear::{EquivalentLinear, EquivalentLinearOptions, LayerResponse};
pub use inclined::{InclinedControl, InclinedWave};
pub use site_warning::SiteWarning;
pub use soil_column::{ControlPoint, SoilColumn, VerticalWave};
pub use transform::SiteMotion;
