//! Selection of results to keep of a run.

/// Selection of results of a run to keep beyond its [`Run`](super::Run): time series of scalars and probes at every
/// step, unless set otherwise.
///
/// See the [module](super) for an example.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(default, deny_unknown_fields))]
pub struct Recorder {
    pub(super) every: usize,
    pub(super) contact: Option<usize>,
    pub(super) motion: Option<usize>,
}

impl Default for Recorder {
    fn default() -> Self {
        Self { every: 1, contact: None, motion: None }
    }
}

impl Recorder {
    /// Recorder of scalars and probes at every step.
    pub fn new() -> Self {
        Self::default()
    }

    /// Keeps scalars and probes of every `steps`th step only; floor spectra are then not possible.
    #[must_use]
    pub fn every(self, steps: usize) -> Self {
        Self { every: steps, ..self }
    }

    /// Keeps the base at every `steps`th step: 49 bytes per element and frame.
    #[must_use]
    pub fn contact(self, steps: usize) -> Self {
        Self { contact: Some(steps), ..self }
    }

    /// Keeps displacement and velocity of the structure at every `steps`th step: 16 bytes per
    /// degree of freedom and frame.
    #[must_use]
    pub fn motion(self, steps: usize) -> Self {
        Self { motion: Some(steps), ..self }
    }
}
