//! Elastic or viscoelastic soil as a source of convolution weights.

use std::path::PathBuf;
use std::sync::Arc;

use super::layered::{Stages, StripWeights, static_compliance};
use super::plan::{self, LatticeKernel, Plan};
use super::{PatchKernel, StaticKernel, WeightsSource};
use crate::error::Result;
use crate::geometry::ContactElement;
use crate::history::ConvolutionWeights;
use crate::soil::{Bedrock, SoilProfile};

/// Relative tolerance of the wavenumber integrals by default.
const DEFAULT_INTEGRAL_TOLERANCE: f64 = 1e-10;

/// Soil profile, with the accuracy of its convolution weights.
#[derive(Debug, Clone)]
pub(super) struct ElasticSource {
    pub(super) profile: SoilProfile,
    /// Cells under mats; `None` for strips.
    pub(super) plan: Option<Plan>,
    /// Runge–Kutta stages set by the user; `None` for the automatic choice.
    pub(super) stages: Option<Stages>,
    /// Relative tolerance of the wavenumber integrals.
    pub(super) tolerance: f64,
    /// File of convolution weights.
    pub(super) file: Option<PathBuf>,
}

impl ElasticSource {
    /// Source of `profile` under strips, or under the cells of a plan, with default accuracy.
    pub(super) fn new(profile: SoilProfile, plan: Option<Plan>) -> Result<Self> {
        profile.check()?;
        Ok(Self { profile, plan, stages: None, tolerance: DEFAULT_INTEGRAL_TOLERANCE, file: None })
    }

    /// Runge–Kutta stages for steps of `time_step` seconds; `None` for the closed form.
    pub(super) fn stages(&self, time_step: f64) -> Option<Stages> {
        let has_closed_form =
            self.plan.is_none() && self.stages.is_none() && self.profile.is_elastic_half_plane();
        if has_closed_form {
            return None;
        }
        Some(self.stages.unwrap_or_else(|| Stages::for_profile(&self.profile, time_step)))
    }

    /// Convolution weights of cells in plan.
    pub(super) fn plan_weights(&self, plan: &Plan, time_step: f64) -> Result<LatticeKernel> {
        let stages = self.stages(time_step).unwrap_or_default();
        let profile = self.profile.clone();
        let file = self.file.clone();
        LatticeKernel::in_plan(profile, plan, stages, time_step, self.tolerance, file)
    }

    /// Convolution weights of strips by convolution quadrature.
    pub(super) fn strip_weights(
        &self,
        elements: &[ContactElement],
        time_step: f64,
        stages: Stages,
    ) -> Result<StripWeights> {
        let profile = self.profile.clone();
        let file = self.file.clone();
        StripWeights::under_strips(profile, elements, stages, time_step, self.tolerance, file)
    }
}

impl WeightsSource for ElasticSource {
    fn kernel(
        &self,
        elements: &[ContactElement],
        time_step: f64,
    ) -> Result<Arc<dyn ConvolutionWeights>> {
        if let Some(plan) = &self.plan {
            return Ok(Arc::new(self.plan_weights(plan, time_step)?));
        }
        match (self.stages(time_step), self.profile.bedrock()) {
            (None, Bedrock::HalfPlane { soil, .. }) => {
                Ok(Arc::new(PatchKernel::new(*soil, elements.to_vec(), time_step)?))
            }
            (stages, _) => {
                Ok(Arc::new(self.strip_weights(elements, time_step, stages.unwrap_or_default())?))
            }
        }
    }

    fn static_compliance(&self, elements: &[ContactElement], matrix: &mut [f64]) -> Result<()> {
        if let Some(plan) = &self.plan {
            return plan::static_compliance(&self.profile, plan, self.tolerance, matrix);
        }
        match self.profile.bedrock() {
            Bedrock::HalfPlane { soil, .. } if self.profile.is_elastic_half_plane() => {
                StaticKernel::under(*soil, elements)?.compliance(elements, matrix)
            }
            _ => static_compliance(&self.profile, elements, matrix),
        }
    }

    fn shear_wave_speed(&self) -> Option<f64> {
        self.profile.surface().map(|soil| soil.shear_wave_speed())
    }

    fn identity(&self) -> Option<Vec<f64>> {
        let stage_count = self.stages.map_or(0.0, |stages| stages.count() as f64);
        let mut numbers = vec![stage_count, self.tolerance];
        // Grounds with different files, or without a file, have different kernels.
        let path_bytes = self.file.as_ref().map(|path| path.as_os_str().as_encoded_bytes());
        numbers.push(path_bytes.map_or(-1.0, |bytes| bytes.len() as f64));
        numbers.extend(path_bytes.unwrap_or_default().iter().map(|byte| f64::from(*byte)));
        numbers.extend(self.plan.iter().flat_map(Plan::identity));
        numbers.extend(self.profile.identity()?);
        Some(numbers)
    }
}
