//! Selection of the results that a run keeps.

/// Selects results to keep beyond a [`Run`](super::Run).
///
/// Default: time series of scalars and probes at every step.
///
/// See the [module](super) for an example.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(default, deny_unknown_fields))]
pub struct Recorder {
    pub(super) every: usize,
    pub(super) contact: Option<usize>,
    pub(super) motion: Option<usize>,
    pub(super) foundations: bool,
}

impl Default for Recorder {
    fn default() -> Self {
        Self { every: 1, contact: None, motion: None, foundations: false }
    }
}

impl Recorder {
    /// Recorder of scalars and probes at every step.
    pub fn new() -> Self {
        Self::default()
    }

    /// Keeps scalars and probes only at every `steps`th step; floor spectra are then impossible.
    #[must_use]
    pub fn every(self, steps: usize) -> Self {
        Self { every: steps, ..self }
    }

    /// Keeps contact frames of base and joints at every `steps`th step: 49 bytes per element and frame.
    #[must_use]
    pub fn contact(self, steps: usize) -> Self {
        Self { contact: Some(steps), ..self }
    }

    /// Keeps motion frames of the structure at every `steps`th step.
    ///
    /// Displacement and velocity take 16 bytes per degree of freedom and frame.
    #[must_use]
    pub fn motion(self, steps: usize) -> Self {
        Self { motion: Some(steps), ..self }
    }

    /// Keeps scalars of each foundation too.
    ///
    /// This is needed if there are several foundations or a moment center is set; otherwise the scalars of the whole
    /// base are those of the foundation. They are kept at the steps of the other scalars. Each foundation takes as much
    /// memory as the whole base. See [`TimeSeries::foundation_series`](super::TimeSeries::foundation_series).
    #[must_use]
    pub fn foundations(self) -> Self {
        Self { foundations: true, ..self }
    }
}
