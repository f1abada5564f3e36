//! Convolution weights by quadrature, in blocks of lags that are computed at their first use.

use std::ops::Range;
use std::path::PathBuf;

use super::block_file::LagBlock;
use super::block_store::{BlockStore, block_index, copy_weights};
use super::coefficients::{Quadrature, SampleProgress};
use super::passivity;
use super::runge_kutta::Stages;
use super::threads::thread_count;
use super::wavenumber::{Compliances, Wavenumbers};
use crate::error::{Observer, ProgressReporter, Result, in_bounds, memory, positive};
use crate::geometry::ContactElement;
use crate::history::{ConvolutionWeights, PairClasses, STRIP_KINDS, SharedSpectra, by_kind};
use crate::soil::SoilProfile;

/// [`ConvolutionWeights`] by Runge–Kutta convolution quadrature, under strips or in plan.
#[derive(Debug)]
pub(in crate::bem) struct QuadratureWeights<I, const KINDS: usize> {
    pub(in crate::bem) quadrature: Quadrature<I, KINDS>,
    pub(in crate::bem) classes: PairClasses,
    /// Pairs of the elements whose passivity is checked; `None` for all elements.
    checked_classes: Option<PairClasses>,
    /// Numbers that identify the mesh.
    mesh_numbers: Vec<f64>,
    blocks: BlockStore,
    spectra: SharedSpectra,
}

/// Weights of a layered ground under strips.
pub(in crate::bem) type StripWeights = QuadratureWeights<Wavenumbers, STRIP_KINDS>;

impl StripWeights {
    /// Weights of `profile` under `elements` for a time step (s) and a relative tolerance.
    ///
    /// # Errors
    /// [`Error::Input`](crate::Error::Input) for an invalid time step,
    /// [`SoilError::NotCausal`](crate::soil::SoilError::NotCausal) for damping that is defined only in the
    /// frequency domain; as for [`PairClasses::new`].
    pub(in crate::bem) fn under_strips(
        profile: SoilProfile,
        elements: &[ContactElement],
        stages: Stages,
        time_step: f64,
        tolerance: f64,
        file: Option<PathBuf>,
    ) -> Result<Self> {
        positive("time step", time_step)?;
        profile.check()?;
        profile.check_causal()?;
        let classes = PairClasses::new(elements.to_vec())?;
        let quadrature = Quadrature::new(profile, &classes, stages, time_step, tolerance);
        let mesh_numbers =
            elements.iter().flat_map(|element| [element.left(), element.right()]).collect();
        Ok(Self::new(quadrature, classes, None, mesh_numbers, file))
    }
}

impl<I: Compliances<KINDS>, const KINDS: usize> QuadratureWeights<I, KINDS> {
    /// Weights of `classes`, not yet computed.
    ///
    /// Passivity is checked on the elements of `checked_classes`, or on all for `None`.
    pub(in crate::bem) fn new(
        quadrature: Quadrature<I, KINDS>,
        classes: PairClasses,
        checked_classes: Option<PairClasses>,
        mesh_numbers: Vec<f64>,
        file: Option<PathBuf>,
    ) -> Self {
        let blocks = BlockStore::new(classes.count(), KINDS, file);
        let spectra = SharedSpectra::default();
        Self { quadrature, classes, checked_classes, mesh_numbers, blocks, spectra }
    }

    /// Stored or newly computed block.
    ///
    /// `expected_range`: expected numbers of samples at the start of this block and at its end.
    fn block(
        &self,
        index: usize,
        progress: &mut ProgressReporter,
        expected_range: Range<usize>,
    ) -> Result<&LagBlock> {
        self.blocks.block(index, progress, |progress| {
            let sample_progress = SampleProgress::new(progress, expected_range);
            self.quadrature.block(index, thread_count(), sample_progress)
        })
    }

    /// Checks passivity once, and returns the fingerprint of the weights.
    pub(in crate::bem) fn check_passivity(&self, progress: &mut ProgressReporter) -> Result<u64> {
        self.blocks.fingerprint(progress, |progress| {
            self.quadrature.integrals.make_ready(progress)?;
            let checked_classes = self.checked_classes.as_ref().unwrap_or(&self.classes);
            passivity::check(&self.quadrature, checked_classes, &self.mesh_numbers, progress)
        })
    }

    /// Error unless the blocks up to the last of `missing_blocks` fit into memory.
    fn check_memory(&self, missing_blocks: &Range<usize>) -> Result<()> {
        if missing_blocks.is_empty() {
            return Ok(());
        }
        let last_lag = LagBlock::last_lag(missing_blocks.end - 1) as f64;
        let memory_bytes = self.quadrature.memory_bytes(missing_blocks.end);
        Ok(memory::check("lags of a layered ground", last_lag, memory_bytes)?)
    }

    /// Computes the missing blocks up to `last_lag`.
    fn compute(&self, last_lag: usize, observer: &mut Observer<'_>) -> Result<()> {
        let last_index = block_index(last_lag.max(1))?;
        let missing_blocks = self.blocks.missing_blocks(0..last_index + 1);
        self.check_memory(&missing_blocks)?;
        // The numbers are upper limits: with panels of the circle, a long block needs far fewer samples.
        let mut sample_counts = vec![0; last_index + 1];
        for index in missing_blocks {
            sample_counts[index] = self.quadrature.max_samples(index);
        }
        let total_count = I::PASSIVITY_POINTS + sample_counts.iter().sum::<usize>();
        let mut progress =
            ProgressReporter::new("convolution weights of layered ground", total_count, observer);
        let fingerprint = self.check_passivity(&mut progress)?;
        let is_complete = self.blocks.missing_blocks(0..last_index + 1).is_empty();
        let mut completed_count = I::PASSIVITY_POINTS;
        progress.reach(completed_count)?;
        for (index, sample_count) in sample_counts.into_iter().enumerate() {
            let expected_range = completed_count..completed_count + sample_count;
            self.block(index, &mut progress, expected_range)?;
            completed_count += sample_count;
        }
        progress.reach(completed_count)?;
        if is_complete { Ok(()) } else { self.blocks.write(fingerprint) }
    }
}

impl<I: Compliances<KINDS>, const KINDS: usize> ConvolutionWeights for QuadratureWeights<I, KINDS> {
    fn classes(&self) -> &PairClasses {
        &self.classes
    }

    fn prepare(&self, last_lag: usize, observer: &mut Observer<'_>) -> Result<()> {
        self.compute(last_lag, observer)
    }

    fn coefficients(
        &self,
        class: usize,
        first_lag: usize,
        values: &mut [&mut [f64]],
    ) -> Result<()> {
        let components: &mut [_; KINDS] = by_kind(values)?;
        in_bounds("class of element pairs", class, self.classes.count())?;
        copy_weights(class, first_lag, components, |index| {
            if !self.blocks.has_block(index) {
                self.check_memory(&(index..index + 1))?;
                self.check_passivity(&mut ProgressReporter::unobserved())?;
            }
            self.block(index, &mut ProgressReporter::unobserved(), 0..0)
        })
    }

    fn late_error(&self) -> f64 {
        I::LATE_ERROR_FACTOR * self.quadrature.tolerance.powf(2.0 / 3.0)
    }

    fn spectra(&self) -> Option<&SharedSpectra> {
        Some(&self.spectra)
    }
}
