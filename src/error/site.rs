//! Errors of site response.

use super::Error;

/// Reasons why a soil profile makes no sense, or cannot be iterated to strain-compatible properties.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum SiteError {
    /// A quantity of one layer out of its range.
    #[error("{quantity} of layer {layer} is {value}, but must be {needed}")]
    Layer {
        /// Layer, from 1 at the surface.
        layer: usize,
        /// Name of the quantity.
        quantity: &'static str,
        /// The value that was given.
        value: f64,
        /// Requirement.
        needed: &'static str,
    },
    /// A number of curves that is not that of the layers.
    #[error("{curves} strain curves were given for {layers} layers: each layer needs its own")]
    Curves {
        /// Strain curves that were given.
        curves: usize,
        /// Layers of the profile.
        layers: usize,
    },
    /// A column of pressure waves.
    #[error("strain curves are those of shear: the column must be one of shear waves")]
    PressureWaves,
}

impl SiteError {
    /// An error of one quantity with its layer, counted from 0.
    pub(crate) fn of_layer(index: usize, error: Error) -> Error {
        match error {
            Error::Input { quantity, value, needed } => {
                Self::Layer { layer: index + 1, quantity, value, needed }.into()
            }
            other => other,
        }
    }
}
