//! Site response: waves from the base of a layered ground to its surface.
//!
//! [`SoilColumn`] computes vertical waves up and down, and strain-compatible properties
//! ([`SoilColumn::equivalent_linear`]). [`InclinedWave`] computes a free field from SV, P and SH waves at an angle. A
//! [`SiteMotion`] contains the samples of a motion and the magnitudes of the parts that they do not contain.

#[cfg(feature = "embedded")]
mod below_surface;
mod equivalent_linear;
mod inclined;
mod iteration;
mod oblique;
mod part_progress;
mod sampled;
mod site_motion;
mod slowness;
mod soil_column;
mod transform;
#[cfg(feature = "embedded")]
mod trench_motion;
#[cfg(feature = "embedded")]
mod trench_waves;
mod vertical;

pub use equivalent_linear::{EquivalentLinear, LayerResponse};
pub use inclined::InclinedWave;
pub use iteration::{ComplexModulus, EquivalentLinearOptions};
pub use oblique::InclinedControl;
pub use site_motion::SiteMotion;
pub use soil_column::SoilColumn;
#[cfg(feature = "embedded")]
pub use trench_motion::TrenchMotion;
pub use vertical::{ControlPoint, VerticalWave};

use std::fmt;

/// Warning that a site's response exceeds the assumptions of its method.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub enum SiteWarning {
    /// Strain above 5·10⁻³: one modulus for the whole motion becomes a poor approximation.
    LargeStrain {
        /// Layer, from 1 at the surface.
        layer: usize,
        /// Largest strain of the layer.
        strain: f64,
    },
    /// Effective strain beyond the end of the layer's curves; their last value was used.
    Extrapolated {
        /// Layer, from 1 at the surface.
        layer: usize,
        /// Effective strain of the layer.
        strain: f64,
        /// Largest strain of its curves.
        largest: f64,
    },
    /// Properties that are not strain-compatible after the last iteration.
    NotConverged {
        /// Estimated largest relative change by all further iterations.
        change: f64,
        /// Number of iterations.
        iterations: usize,
    },
    /// Motion of the surface outside the record's time above 1 % of its peak.
    ///
    /// The remedy is quiet time before and after the record ([`Record::padded`](crate::motion::Record::padded)), or more
    /// damping of the site.
    CutOff {
        /// Largest acceleration cut off, relative to the peak.
        share: f64,
    },
    /// Most of a motion's energy is at frequencies that the site amplifies more than a hundredfold.
    ///
    /// Deconvolution through soft, damped soil amplifies noise in this way ([`SiteMotion::warning`]).
    Amplified {
        /// Lowest of these frequencies, Hz.
        frequency: f64,
    },
}

impl SiteWarning {
    /// Largest shear strain for which one modulus during the whole motion is a good approximation.
    pub(crate) const STRAIN_LIMIT: f64 = 5e-3;
}

impl fmt::Display for SiteWarning {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match *self {
            Self::LargeStrain { layer, strain } => write!(
                f,
                "layer {layer} strains by {:.2} %, beyond {} %: equivalent-linear response is doubtful",
                100.0 * strain,
                100.0 * Self::STRAIN_LIMIT
            ),
            Self::Extrapolated { layer, strain, largest } => write!(
                f,
                "effective strain of layer {layer}, {:.2} %, is beyond its curves, which end at {:.2} %",
                100.0 * strain,
                100.0 * largest
            ),
            Self::NotConverged { change, iterations } => write!(
                f,
                "properties are {:.2} % from strain-compatible ones after {iterations} iterations",
                100.0 * change
            ),
            Self::CutOff { share } => write!(
                f,
                "motion of the surface outside the record's time, {:.1} % of its peak, is cut off: add quiet time \
                 to the record (padded)",
                100.0 * share
            ),
            Self::Amplified { frequency } => write!(
                f,
                "the site amplifies most of this motion more than a hundredfold, from {frequency:.1} Hz on: remove higher \
                 frequencies from the input motion (low_pass), or reduce damping or depth of the soil"
            ),
        }
    }
}
