//! Convolution weights by quadrature, in blocks of lags that are computed when first needed.

use std::ops::Range;
use std::path::PathBuf;

use super::block_file::LagBlock;
use super::block_store::{BlockStore, copy_lags, last_block};
use super::coefficients::{Quadrature, Samples};
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
    /// Elements whose passivity is checked, if not all.
    sample: Option<PairClasses>,
    /// Numbers that distinguish the mesh from others.
    mesh: Vec<f64>,
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
        let mesh = elements.iter().flat_map(|element| [element.left(), element.right()]).collect();
        Ok(Self::new(quadrature, classes, None, mesh, file))
    }
}

impl<I: Compliances<KINDS>, const KINDS: usize> QuadratureWeights<I, KINDS> {
    /// Weights of `classes`, not yet computed; passivity is checked on the elements of `sample`, or on all for `None`.
    pub(in crate::bem) fn new(
        quadrature: Quadrature<I, KINDS>,
        classes: PairClasses,
        sample: Option<PairClasses>,
        mesh: Vec<f64>,
        file: Option<PathBuf>,
    ) -> Self {
        let blocks = BlockStore::new(classes.count(), KINDS, file);
        let spectra = SharedSpectra::default();
        Self { quadrature, classes, sample, mesh, blocks, spectra }
    }

    /// Block `number`; computed now if it is not stored.
    fn block(
        &self,
        number: usize,
        watch: &mut ProgressReporter,
        expected: Range<usize>,
    ) -> Result<&LagBlock> {
        self.blocks.block(number, watch, |watch| {
            self.quadrature.block(number, thread_count(), Samples::new(watch, expected))
        })
    }

    /// Checks passivity once, and returns the fingerprint of the weights.
    pub(in crate::bem) fn check_passivity(&self, watch: &mut ProgressReporter) -> Result<u64> {
        self.blocks.fingerprint(watch, |watch| {
            self.quadrature.integrals.make_ready(watch)?;
            let checked = self.sample.as_ref().unwrap_or(&self.classes);
            passivity::check(&self.quadrature, checked, &self.mesh, watch)
        })
    }

    /// Returns an error unless the blocks up to the last of `missing` fit into memory.
    fn check_memory(&self, missing: &Range<usize>) -> Result<()> {
        if missing.is_empty() {
            return Ok(());
        }
        let lags = LagBlock::last_lag(missing.end - 1) as f64;
        Ok(memory::check("lags of a layered ground", lags, self.quadrature.memory(missing.end))?)
    }

    /// Computes the blocks of lags up to `lags`.
    fn compute(&self, lags: usize, observer: &mut Observer<'_>) -> Result<()> {
        let last = last_block(lags.max(1))?;
        let missing = self.blocks.missing(0..last + 1);
        self.check_memory(&missing)?;
        // Upper limits: with panels of the contour, a long block needs far fewer samples.
        let mut sample_counts = vec![0; last + 1];
        for number in missing {
            sample_counts[number] = self.quadrature.max_samples(number);
        }
        let total = I::PASSIVITY_POINTS + sample_counts.iter().sum::<usize>();
        let mut watch =
            ProgressReporter::new("convolution weights of layered ground", total, observer);
        let fingerprint = self.check_passivity(&mut watch)?;
        let is_complete = self.blocks.missing(0..last + 1).is_empty();
        let mut done = I::PASSIVITY_POINTS;
        watch.reach(done)?;
        for (number, count) in sample_counts.into_iter().enumerate() {
            self.block(number, &mut watch, done..done + count)?;
            done += count;
        }
        watch.reach(done)?;
        if is_complete { Ok(()) } else { self.blocks.write(fingerprint) }
    }
}

impl<I: Compliances<KINDS>, const KINDS: usize> ConvolutionWeights for QuadratureWeights<I, KINDS> {
    fn classes(&self) -> &PairClasses {
        &self.classes
    }

    fn prepare(&self, lags: usize, observer: &mut Observer<'_>) -> Result<()> {
        self.compute(lags, observer)
    }

    fn coefficients(
        &self,
        class: usize,
        first_lag: usize,
        values: &mut [&mut [f64]],
    ) -> Result<()> {
        let values: &mut [_; KINDS] = by_kind(values)?;
        in_bounds("class of element pairs", class, self.classes.count())?;
        copy_lags(class, first_lag, values, |number| {
            if !self.blocks.has(number) {
                self.check_memory(&(number..number + 1))?;
                self.check_passivity(&mut ProgressReporter::unobserved())?;
            }
            self.block(number, &mut ProgressReporter::unobserved(), 0..0)
        })
    }

    fn late_error(&self) -> f64 {
        I::LATE_ERROR_FACTOR * self.quadrature.tolerance.powf(2.0 / 3.0)
    }

    fn spectra(&self) -> Option<&SharedSpectra> {
        Some(&self.spectra)
    }
}
