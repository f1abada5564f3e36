//! What to keep of a run.

/// What to keep of a run: the scalar histories and the probes at every step, unless told otherwise.
///
/// See the [module](super) for an example.
#[derive(Debug, Clone, PartialEq)]
pub struct Recorder {
    /// One for all elements, one each, or none.
    pub(super) friction: Vec<f64>,
    pub(super) every: usize,
    pub(super) contact: Option<usize>,
    pub(super) motion: Option<usize>,
}

impl Default for Recorder {
    fn default() -> Self {
        Self { friction: Vec::new(), every: 1, contact: None, motion: None }
    }
}

impl Recorder {
    /// Scalars and probes at every step.
    pub fn new() -> Self {
        Self::default()
    }

    /// Another friction coefficient for the factor of safety against sliding than that of the
    /// interface laws ([`InterfaceLaw::friction_coefficient`](crate::interface::InterfaceLaw::friction_coefficient)): for a
    /// bonded base, say, which has none.
    #[must_use]
    pub fn friction(self, coefficient: f64) -> Self {
        Self { friction: vec![coefficient], ..self }
    }

    /// The same for each element, from left to right.
    #[must_use]
    pub fn frictions(self, coefficients: Vec<f64>) -> Self {
        Self { friction: coefficients, ..self }
    }

    /// Keeps scalars and probes of every `steps`th step only. Peaks stay those of all steps; floor
    /// spectra can no longer be had.
    #[must_use]
    pub fn every(self, steps: usize) -> Self {
        Self { every: steps, ..self }
    }

    /// Keeps the base at every `steps`th step: 33 bytes per element and frame.
    #[must_use]
    pub fn contact(self, steps: usize) -> Self {
        Self { contact: Some(steps), ..self }
    }

    /// Keeps displacement and velocity of the structure at every `steps`th step: 16 bytes per
    /// unknown and frame.
    #[must_use]
    pub fn motion(self, steps: usize) -> Self {
        Self { motion: Some(steps), ..self }
    }
}
