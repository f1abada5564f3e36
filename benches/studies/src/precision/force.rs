//! Time series of the base shear, and their errors.

use basemat_problems::series::{TabledSeries, nearest_integer};
use basemat_problems::table;

/// Short steps in an interval of a table.
const INTERVAL_PARTS: usize = 32;

/// A force that is constant in each of many short steps, the mean force of the step.
///
/// It comes from a run, or from a table of instantaneous values.
#[derive(Debug, Clone)]
pub(crate) struct ForceSeries {
    step: f64,
    means: Vec<f64>,
    /// ∫ force dt at the ends of the steps, from 0.
    impulse: Vec<f64>,
}

/// Errors of a run.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Errors {
    /// Error of the peak, relative to the peak.
    pub(crate) peak: f64,
    /// Root of the summed squared errors over the time series, relative to that of the reference.
    pub(crate) series: f64,
}

impl ForceSeries {
    /// Means over steps of `step` seconds.
    pub(crate) fn new(step: f64, means: Vec<f64>) -> Self {
        let mut impulse = Vec::with_capacity(means.len() + 1);
        let mut sum = 0.0;
        impulse.push(sum);
        for mean in &means {
            sum += step * mean;
            impulse.push(sum);
        }
        Self { step, means, impulse }
    }

    /// A column of a reference table from t = 0 on: cubics through the values, averaged over short steps.
    pub(crate) fn from_table(file: &str, column: &str) -> Self {
        let series = TabledSeries::new(&table(file), column);
        let step = series.step() / INTERVAL_PARTS as f64;
        let count = INTERVAL_PARTS * nearest_integer(series.duration() / series.step());
        let means = (1..=count).map(|k| series.mean(k as f64 * step, step));
        Self::new(step, means.collect())
    }

    /// Time at the end, s.
    pub(crate) fn duration(&self) -> f64 {
        self.step * self.means.len() as f64
    }

    /// Largest magnitude.
    pub(crate) fn peak(&self) -> f64 {
        self.means.iter().fold(0.0, |peak, force| peak.max(force.abs()))
    }

    /// ∫ force dt from 0 to `time`.
    fn impulse_at(&self, time: f64) -> f64 {
        let position = (time / self.step).clamp(0.0, self.means.len() as f64);
        #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "not negative")]
        let index = (position as usize).min(self.means.len() - 1);
        self.impulse[index] + (position - index as f64) * self.step * self.means[index]
    }

    /// Errors against a reference with shorter steps.
    ///
    /// Time series are compared as means over the steps of this series, peaks as largest magnitudes.
    pub(crate) fn errors(&self, reference: &Self) -> Errors {
        let mut square = 0.0;
        let mut norm = 0.0;
        for (k, computed) in self.means.iter().enumerate() {
            let begin = k as f64 * self.step;
            let end = (k + 1) as f64 * self.step;
            // A step that ends after the reference is not compared.
            if end > reference.duration() * (1.0 + 1e-9) {
                break;
            }
            let expected = (reference.impulse_at(end) - reference.impulse_at(begin)) / self.step;
            square += (computed - expected).powi(2);
            norm += expected * expected;
        }
        let peak = reference.peak();
        Errors { peak: (self.peak() - peak).abs() / peak, series: (square / norm).sqrt() }
    }
}
