//! How a scene is computed: mesh, time step, history, time scheme.

use basemat::bem::{Grading, HalfPlaneGround, History, Strip};
use basemat::coupled::{Midpoint, SimulationBuilder, Theta};
use basemat::{Result, Soil};

/// Histories that are compared, with their names. A new kind of [`History`] is one more line.
pub(crate) const HISTORIES: [(&str, History); 2] =
    [("transforms", History::RelaxedFft), ("direct", History::Direct)];

/// A time scheme of the structure. A new one is one more variant and its arms below.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Scheme {
    Midpoint,
    Theta(f64),
}

impl Scheme {
    pub(crate) fn name(self) -> String {
        match self {
            Self::Midpoint => "midpoint".into(),
            Self::Theta(theta) => format!("θ = {theta}"),
        }
    }

    pub(crate) fn give(self, builder: SimulationBuilder) -> Result<SimulationBuilder> {
        Ok(match self {
            Self::Midpoint => builder.scheme(Midpoint),
            Self::Theta(theta) => builder.scheme(Theta::new(theta)?),
        })
    }
}

/// One point of a sweep.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Settings {
    pub(crate) elements: usize,
    pub(crate) grading: Grading,
    /// s.
    pub(crate) time_step: f64,
    pub(crate) history: History,
    pub(crate) scheme: Scheme,
}

impl Settings {
    /// With the default history and scheme.
    pub(crate) fn new(elements: usize, grading: Grading, time_step: f64) -> Self {
        let (history, scheme) = (HISTORIES[0].1, Scheme::Midpoint);
        Self { elements, grading, time_step, history, scheme }
    }

    pub(crate) fn grading_name(&self) -> &'static str {
        match self.grading {
            Grading::Uniform => "uniform",
            Grading::Cosine => "cosine",
            _ => "other",
        }
    }

    pub(crate) fn history_name(&self) -> &'static str {
        HISTORIES.iter().find(|(_, kind)| *kind == self.history).map_or("other", |(name, _)| name)
    }

    /// Half-plane under a base between −`half` and `half`.
    pub(crate) fn ground(&self, soil: Soil, half: f64) -> Result<HalfPlaneGround> {
        let strip = Strip::new(-half..half, self.elements, self.grading)?;
        Ok(HalfPlaneGround::new(soil, &[strip])?.with_history_kind(self.history))
    }
}
