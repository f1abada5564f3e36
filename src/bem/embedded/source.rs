//! Soil around a trench as a source of convolution weights.

use std::path::PathBuf;
use std::sync::Arc;

use super::pairs::{TRENCH_KINDS, TrenchPairs, trench_classes};
use super::sampling::QuadratureDomain;
use super::soil::TrenchSoil;
use crate::bem::WeightsSource;
use crate::bem::layered::{Quadrature, QuadratureWeights, Stages, self_pair_classes};
use crate::error::{Result, positive, same_length};
use crate::geometry::ContactElement;
use crate::history::ConvolutionWeights;
use crate::linalg::Complex;

/// Relative accuracy of the compliances from which weights are computed.
const WEIGHT_TOLERANCE: f64 = 1e-8;
/// Degree of the finite elements.
const ELEMENT_DEGREE: usize = 4;
/// Degree of the finite elements for short time steps.
///
/// These excite waves that are shorter than the contact elements.
const SHORT_STEP_DEGREE: usize = 8;
/// Longest of the short time steps, in b/c: half of the width over the lowest shear wave speed.
const MAX_SHORT_STEP_RATIO: f64 = 0.03;

/// Soil around a trench, with the method of its convolution weights.
#[derive(Debug, Clone)]
pub(super) struct TrenchSource {
    pub(super) soil: TrenchSoil,
    /// Runge–Kutta stages; `None`: those of [`Stages::for_profile`].
    pub(super) stages: Option<Stages>,
    /// File of the convolution weights, if any.
    pub(super) file: Option<PathBuf>,
}

impl TrenchSource {
    /// Runge–Kutta stages for steps of `time_step` seconds.
    pub(super) fn stages(&self, time_step: f64) -> Stages {
        self.stages.unwrap_or_else(|| Stages::for_profile(self.soil.profile(), time_step))
    }

    /// Convolution weights for steps of `time_step` seconds, not yet computed.
    pub(super) fn weights(
        &self,
        time_step: f64,
    ) -> Result<QuadratureWeights<TrenchPairs, TRENCH_KINDS>> {
        positive("time step", time_step)?;
        self.soil.check_causal()?;
        let elements = self.soil.elements();
        let classes = trench_classes(elements.elements())?;
        let speeds = self.soil.soils().map(|soil| soil.shear_wave_speed());
        let min_speed = speeds.fold(f64::INFINITY, f64::min);
        let max_short_travel = MAX_SHORT_STEP_RATIO * elements.trench().half_width();
        let is_short_step = min_speed * time_step <= max_short_travel;
        let degree = if is_short_step { SHORT_STEP_DEGREE } else { ELEMENT_DEGREE };
        let stages = self.stages(time_step);
        let mut pairs = TrenchPairs::new(self.soil.clone(), degree);
        // Without damping, layers have resonances on the axis, which too many samples would have to resolve.
        if !self.soil.has_undamped_layers(Complex::new(0.0, 1.0 / time_step))? {
            pairs = pairs.interpolated_in(QuadratureDomain { stages, time_step });
        }
        let profile = self.soil.profile().clone();
        let self_pairs = self_pair_classes(&classes);
        let tolerance = WEIGHT_TOLERANCE;
        let quadrature = Quadrature::over(profile, pairs, self_pairs, stages, time_step, tolerance);
        let element_ends = [elements.base_ends(), elements.wall_ends()].concat();
        Ok(QuadratureWeights::new(quadrature, classes, None, element_ends, self.file.clone()))
    }
}

impl WeightsSource for TrenchSource {
    fn kernel(
        &self,
        _elements: &[ContactElement],
        time_step: f64,
    ) -> Result<Arc<dyn ConvolutionWeights>> {
        Ok(Arc::new(self.weights(time_step)?))
    }

    fn static_compliance(&self, _elements: &[ContactElement], matrix: &mut [f64]) -> Result<()> {
        let classes = trench_classes(self.soil.elements().elements())?;
        same_length("static compliance", matrix.len(), classes.layout().matrix_len())?;
        let compliances = self.soil.static_compliances()?;
        let mut values = vec![[Complex::default(); TRENCH_KINDS]; classes.count()];
        let pairs = TrenchPairs::new(self.soil.clone(), ELEMENT_DEGREE);
        pairs.fill_classes(&compliances, &mut values);
        classes.scatter(matrix, |_, pair| values[pair.class].map(|value| pair.scale * value.re));
        Ok(())
    }

    fn shear_wave_speed(&self) -> Option<f64> {
        self.soil.profile().surface().map(|soil| soil.shear_wave_speed())
    }

    fn identity(&self) -> Option<Vec<f64>> {
        let stage_count = self.stages.map_or(0.0, |stages| stages.count() as f64);
        // A ground with a file does not share its convolution weights with a ground without a file.
        let path_bytes = self.file.as_ref().map(|file| file.as_os_str().as_encoded_bytes());
        let path_length = path_bytes.map_or(-1.0, |bytes| bytes.len() as f64);
        let mut identity = vec![stage_count, path_length];
        identity.extend(path_bytes.unwrap_or_default().iter().map(|byte| f64::from(*byte)));
        identity.extend(self.soil.identity()?);
        Some(identity)
    }
}

#[cfg(test)]
mod tests;
