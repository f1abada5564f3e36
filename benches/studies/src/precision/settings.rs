//! Numerical settings of a scene: mesh, time step, history, time scheme.

use basemat::bem::{ElasticGround, Grading, Strip};
use basemat::coupled::{Midpoint, Newmark, SimulationBuilder, Theta};
use basemat::history::{HistoryMethod, HistoryOptions};
use basemat::{Result, Soil};

/// Method of the convolution history.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct HistorySetting {
    pub(crate) name: &'static str,
    method: HistoryMethod,
    /// Tolerance of approximate convolution weights.
    tolerance: Option<f64>,
}

/// History methods that are compared.
pub(crate) const HISTORY_METHODS: [HistorySetting; 5] = [
    HistorySetting { name: "transforms", method: HistoryMethod::RelaxedFft, tolerance: None },
    HistorySetting { name: "direct", method: HistoryMethod::Direct, tolerance: None },
    HistorySetting {
        name: "exponentials 1e-10",
        method: HistoryMethod::Exponentials,
        tolerance: Some(1e-10),
    },
    HistorySetting {
        name: "exponentials 1e-6",
        method: HistoryMethod::Exponentials,
        tolerance: Some(1e-6),
    },
    HistorySetting {
        name: "exponentials 1e-3",
        method: HistoryMethod::Exponentials,
        tolerance: Some(1e-3),
    },
];

/// A time scheme of the structure.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum SchemeSetting {
    Midpoint,
    Theta(f64),
    /// γ and β.
    Newmark(f64, f64),
}

/// Schemes tried in addition to the midpoint rule: the damped rule, and the two common members of
/// Newmark's family.
pub(crate) const OTHER_SCHEMES: [SchemeSetting; 3] = [
    SchemeSetting::Theta(0.55),
    SchemeSetting::Newmark(0.5, 0.25),
    SchemeSetting::Newmark(0.6, 0.3025),
];

impl SchemeSetting {
    pub(crate) fn name(self) -> String {
        match self {
            Self::Midpoint => "midpoint".into(),
            Self::Theta(theta) => format!("θ = {theta}"),
            Self::Newmark(gamma, beta) => format!("Newmark {gamma}, {beta}"),
        }
    }

    pub(crate) fn add_to(self, builder: SimulationBuilder) -> Result<SimulationBuilder> {
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
    /// Time step, s.
    pub(crate) time_step: f64,
    pub(crate) history: HistorySetting,
    pub(crate) scheme: SchemeSetting,
}

impl Settings {
    /// With the default history and scheme.
    pub(crate) fn new(elements: usize, grading: Grading, time_step: f64) -> Self {
        let history = HISTORY_METHODS[0];
        let scheme = SchemeSetting::Midpoint;
        Self { elements, grading, time_step, history, scheme }
    }

    pub(crate) fn grading_name(&self) -> &'static str {
        match self.grading {
            Grading::Uniform => "uniform",
            Grading::Cosine => "cosine",
            _ => "other",
        }
    }

    /// Half-plane under a base between −`half_width` and `half_width`.
    pub(crate) fn ground(&self, soil: Soil, half_width: f64) -> Result<ElasticGround> {
        let strip = Strip::new(-half_width..half_width, self.elements, self.grading)?;
        let options =
            HistoryOptions { tolerance: self.history.tolerance, ..self.history.method.into() };
        ElasticGround::new(soil, strip)?.with_history(options)
    }
}
