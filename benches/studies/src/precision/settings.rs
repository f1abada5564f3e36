//! Numerical settings of a scene: mesh, time step, history, time scheme.

use basemat::bem::{ElasticGround, Grading, Strip};
use basemat::coupled::{Midpoint, Newmark, SimulationBuilder, Theta};
use basemat::history::{HistoryMethod, HistoryOptions};
use basemat::{Result, Soil};

/// Method by which the past is summed.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Past {
    pub(crate) name: &'static str,
    kind: HistoryMethod,
    /// Of the coefficients, where they are approximate.
    tolerance: Option<f64>,
}

/// Convolutions that are compared. A new kind of [`HistoryMethod`] is one more line.
pub(crate) const HISTORIES: [Past; 5] = [
    Past { name: "transforms", kind: HistoryMethod::RelaxedFft, tolerance: None },
    Past { name: "direct", kind: HistoryMethod::Direct, tolerance: None },
    Past { name: "exponentials 1e-10", kind: HistoryMethod::Exponentials, tolerance: Some(1e-10) },
    Past { name: "exponentials 1e-6", kind: HistoryMethod::Exponentials, tolerance: Some(1e-6) },
    Past { name: "exponentials 1e-3", kind: HistoryMethod::Exponentials, tolerance: Some(1e-3) },
];

/// A time scheme of the structure. A new one is one more variant and its arms below.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Scheme {
    Midpoint,
    Theta(f64),
    /// γ and β.
    Newmark(f64, f64),
}

/// Schemes tried in addition to the midpoint rule: the damped rule, and the two common members of
/// Newmark's family.
pub(crate) const SCHEMES: [Scheme; 3] =
    [Scheme::Theta(0.55), Scheme::Newmark(0.5, 0.25), Scheme::Newmark(0.6, 0.3025)];

impl Scheme {
    pub(crate) fn name(self) -> String {
        match self {
            Self::Midpoint => "midpoint".into(),
            Self::Theta(theta) => format!("θ = {theta}"),
            Self::Newmark(gamma, beta) => format!("Newmark {gamma}, {beta}"),
        }
    }

    pub(crate) fn give(self, builder: SimulationBuilder) -> Result<SimulationBuilder> {
        Ok(match self {
            Self::Midpoint => builder.scheme(Midpoint),
            Self::Theta(theta) => builder.scheme(Theta::new(theta)?),
            Self::Newmark(gamma, beta) => builder.scheme(Newmark::new(gamma, beta)?),
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
    pub(crate) history: Past,
    pub(crate) scheme: Scheme,
}

impl Settings {
    /// With the default history and scheme.
    pub(crate) fn new(elements: usize, grading: Grading, time_step: f64) -> Self {
        let (history, scheme) = (HISTORIES[0], Scheme::Midpoint);
        Self { elements, grading, time_step, history, scheme }
    }

    pub(crate) fn grading_name(&self) -> &'static str {
        match self.grading {
            Grading::Uniform => "uniform",
            Grading::Cosine => "cosine",
            _ => "other",
        }
    }

    /// Half-plane under a base between −`half` and `half`.
    pub(crate) fn ground(&self, soil: Soil, half: f64) -> Result<ElasticGround> {
        let strip = Strip::new(-half..half, self.elements, self.grading)?;
        let options =
            HistoryOptions { tolerance: self.history.tolerance, ..self.history.kind.into() };
        ElasticGround::new(soil, strip)?.with_history(options)
    }
}
