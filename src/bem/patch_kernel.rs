//! Convolution weights of the half-plane for a patch of elements.

use super::InfluenceKernel;
use crate::error::Result;
use crate::geometry::ContactElement;
use crate::history::{ConvolutionWeights, LateWeights, PairClasses, SharedSpectra, by_kind};
use crate::soil::Soil;

/// [`ConvolutionWeights`] of the half-plane for a patch of surface elements, in closed form.
///
/// The coupling of a pair of elements ends when the Rayleigh wave has crossed both.
#[derive(Debug, Clone)]
pub struct PatchKernel {
    /// Influence coefficients of single pairs.
    pub(super) kernel: InfluenceKernel,
    classes: PairClasses,
    spectra: SharedSpectra,
}

impl PatchKernel {
    /// Weights for `elements` (left to right, not overlapping) and steps of `time_step` seconds.
    ///
    /// # Errors
    /// [`Error::Input`](crate::Error::Input) for a time step that is not positive; as for [`PairClasses::new`].
    pub fn new(soil: Soil, elements: Vec<ContactElement>, time_step: f64) -> Result<Self> {
        let classes = PairClasses::new(elements)?;
        let kernel = InfluenceKernel::new(soil, time_step)?;
        Ok(Self { kernel, classes, spectra: SharedSpectra::default() })
    }
}

impl ConvolutionWeights for PatchKernel {
    fn classes(&self) -> &PairClasses {
        &self.classes
    }

    fn coefficients(
        &self,
        class: usize,
        first_lag: usize,
        values: &mut [&mut [f64]],
    ) -> Result<()> {
        let components = by_kind(values)?;
        let [source, receiver] = self.classes.representative(class)?;
        let pair = self.kernel.pair(receiver, source)?;
        pair.fill(first_lag, components)?;
        let receiver_length = receiver.length();
        for value in components.iter_mut().flat_map(|component| component.iter_mut()) {
            *value *= receiver_length;
        }
        Ok(())
    }

    fn last_coupling_lag(&self, class: usize) -> Result<Option<usize>> {
        let [source, receiver] = self.classes.representative(class)?;
        Ok(Some(self.kernel.pair(receiver, source)?.coupling_end() - 1))
    }

    fn late_weights(&self) -> Option<&dyn LateWeights> {
        Some(self)
    }

    fn spectra(&self) -> Option<&SharedSpectra> {
        Some(&self.spectra)
    }
}
