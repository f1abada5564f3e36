//! History by Fourier transforms of blocks: exact to rounding, O(log² N) per step.

mod blocks;
mod coefficients;
mod element_grid;
mod leaf;
mod level;
mod memory;
mod pairs;
mod plan_spectra;
mod ring;
mod tables;
mod wave_level;
mod wave_numbers;
mod waves;

use std::sync::Arc;

use self::element_grid::{ElementGrid, WAVES_FROM};
pub(crate) use self::memory::bytes_of_blocks;
use self::memory::most_steps;
use self::pairs::Pairs;
use self::waves::Waves;
use super::convolution::{ConvolutionHistory, check_inputs};
use super::convolution_weights::ConvolutionWeights;
use super::last_lag::LastLag;
use crate::error::{
    CheckpointError, Error, MemoryError, Observer, Progress, Result, Watch, memory_limit,
    same_length, unobserved,
};
pub(crate) use crate::history::relaxed_fft::blocks::Blocks;
use crate::history::relaxed_fft::blocks::PARTS;
pub(crate) use crate::history::relaxed_fft::ring::LEAF;

/// Number of lags of one class whose spectra take as long as one sample of layered ground.
const SPECTRA: usize = 8192;

/// Relaxed blocked convolution: equal to [`DirectHistory`](super::DirectHistory) within rounding.
///
/// The number of steps need not be known in advance.
///
/// Time is divided into leaves of 32 steps. Within a leaf, the effects of inputs on outputs are summed directly. After
/// i steps, i a multiple of the leaf, let b be the leaf times the largest power of two with which b divides i. The
/// effect of the last b inputs on the next b outputs is one convolution of length 2b, computed by transforms (Hairer,
/// Lubich & Schlichte 1985, SIAM J. Sci. Stat. Comput. 6, 532–541). Every pair of input and output is in exactly one
/// leaf or block, so the result is complete and exact.
///
/// Each component is transformed once per block. Products are summed over the sources in the frequency domain, with one
/// spectrum per pair *class*: on a uniform patch Q offsets instead of Q² pairs. The coupling of normal and tangential
/// components ends when the Rayleigh wave has crossed the patch. A coupling of few steps is summed directly; a longer
/// one by blocks that cover its length.
///
/// From 8 equal elements on a lattice (a uniform strip, or several of one pitch) on, each step is also transformed
/// along the surface, zero-padded. Every wavenumber is then a separate convolution in time, without products over
/// pairs.
///
/// # Cost
///
/// Q elements, N steps, C classes (Q on a uniform strip, about Q²/4 on a graded one), and
/// log₂(N/32) sizes of blocks:
///
/// | | direct sum | relaxed transforms | with wavenumbers |
/// |---|---|---|---|
/// | multiply–adds per step | 2Q² · N/2 on average | 2Q² · 16 in the leaf; per size 4Q² for products and about 5Q log₂ 2b for transforms | 8Q · 16 in the leaf; per size 8Q for products and about 10Q log₂ 2b for transforms |
/// | coefficients, bytes | 16 C N | 32 C M, M the power of two at or above N | 32 Q M |
/// | tractions, bytes | 16 Q N | 16 Q M | 32 Q M |
/// | scratch, bytes | none | 8 (Q + 2) M | 32 M |
///
/// The cost of steps differs: the step that completes a block of b computes the whole block, 4Q transforms of length
/// 2b.
///
/// All histories of one kernel share its [spectra](ConvolutionWeights::spectra), if it stores them: the first history
/// that needs them makes them, on any thread.
///
/// Memory is allocated by [`prepare`](ConvolutionHistory::prepare). If more steps follow, it doubles, as far as
/// [`memory_limit`](crate::memory_limit) allows. Results may differ in the last digits between processors, as the
/// transforms use the widest instructions found at run time.
pub struct RelaxedFftHistory {
    kernel: Arc<dyn ConvolutionWeights>,
    /// Blocks; `None` until they are needed.
    blocks: Option<Box<dyn Blocks>>,
    /// Whether to transform along the surface; `None` to do so where it is faster.
    along_surface: Option<bool>,
    steps: usize,
    /// Whether the effect of the last input still has to be added.
    pending: bool,
    /// Scratch for tractions of which entries are missing.
    padded: Vec<f64>,
    /// Error because of which inputs could not be accepted.
    failed: Option<Error>,
    /// Memory allowed, bytes.
    memory: f64,
    /// Fraction of the coefficients' sum that may be left out.
    forgotten: Option<f64>,
    /// Last lag that counts, once known.
    end: Option<LastLag>,
    /// Largest traction so far, Pa; kept only if late lags may be left out.
    largest: f64,
}

short_debug! {
    RelaxedFftHistory; self; elements: self.kernel.classes().elements().len(), steps: self.steps
}

impl RelaxedFftHistory {
    /// Makes an empty history of `kernel`.
    pub fn new(kernel: Arc<dyn ConvolutionWeights>) -> Self {
        let padded = vec![0.0; kernel.classes().layout().len()];
        Self {
            kernel,
            blocks: None,
            along_surface: None,
            steps: 0,
            pending: false,
            padded,
            failed: None,
            memory: memory_limit() as f64,
            forgotten: None,
            end: None,
            largest: 0.0,
        }
    }

    /// Sets whether to transform along the surface, where elements are equal and on a lattice.
    ///
    /// By default this is done where it was measured to be faster. Call this before the first step.
    #[must_use]
    pub fn with_surface_transform(mut self, wanted: bool) -> Self {
        self.along_surface = Some(wanted);
        self
    }

    /// Limits the memory to `bytes`; steps that need more return [`Error::Memory`].
    pub(super) fn within(mut self, bytes: usize) -> Self {
        self.memory = self.memory.min(bytes as f64);
        self
    }

    /// Drops late lags in plan whose coefficients' sum is at most `tolerance` of the total.
    pub(super) fn forgetting(mut self, tolerance: f64) -> Self {
        self.forgotten = Some(tolerance);
        self
    }

    /// First input that is still stored after `steps` steps, if lags after `last` are dropped.
    ///
    /// Blocks need all inputs from this one on.
    fn first_kept(last: Option<usize>, steps: usize) -> usize {
        last.map_or(0, |last| (steps / last).saturating_sub(1) * last)
    }

    /// Number of lags that blocks for `steps` steps need, a power of two.
    ///
    /// If late lags may be left out, at most as many as fit into memory.
    ///
    /// # Errors
    /// [`Error::Memory`] for steps that need more memory than allowed.
    fn lags(&self, steps: usize) -> Result<usize> {
        let lags = steps.checked_next_power_of_two().unwrap_or(usize::MAX).max(1);
        let known = self.end.map_or(lags, |end| lags.min(2 * end.lag));
        let most = most_steps(&*self.kernel, self.memory)?;
        if known <= most || self.forgotten.is_some() && most > 0 {
            return Ok(known.min(most));
        }
        Err(self.too_many(steps)?)
    }

    /// Error for a number of steps that need too much memory.
    fn too_many(&self, steps: usize) -> Result<Error> {
        Ok(Error::Memory(MemoryError {
            quantity: "steps of the convolution history",
            asked: steps as f64,
            needed: bytes_of_blocks(&*self.kernel, steps)?,
            limit: self.memory,
            remedy: "take fewer steps or larger elements, or allow more with \
                     `HistoryOptions::memory`: a checkpoint can go on there",
        }))
    }

    /// Makes blocks ready for at least `steps` steps, and returns them.
    fn grow(&mut self, steps: usize, watch: &mut Watch) -> Result<&mut dyn Blocks> {
        if steps > self.blocks.as_ref().map_or(0, |blocks| blocks.capacity()) && self.end.is_none()
        {
            let lags = self.lags(steps)?;
            if let Some(tolerance) = self.forgotten {
                self.end = LastLag::find(&*self.kernel, tolerance, lags, &mut unobserved)?;
            }
            if self.end.is_none() && lags < steps {
                return Err(self.too_many(steps)?);
            }
        }
        let kernel = &*self.kernel;
        let blocks: Box<dyn Blocks> = if let Some(blocks) = self.blocks.take() {
            blocks
        } else {
            let classes = kernel.classes();
            let wanted = self.along_surface.unwrap_or(classes.elements().len() >= WAVES_FROM);
            match ElementGrid::from_pairs(classes).filter(|_| wanted || classes.plan().is_some()) {
                Some(lattice) => Box::new(Waves::new(lattice, kernel)?),
                None => Box::new(Pairs::new(kernel)?),
            }
        };
        let blocks = self.blocks.insert(blocks);
        let capacity = blocks.capacity();
        if capacity < steps {
            let mut inputs = Vec::new();
            let worked_in = self.steps - usize::from(self.pending);
            if !capacity.is_power_of_two() {
                (0..self.steps).for_each(|step| blocks.input(step, worked_in, &mut inputs));
            }
            match self.end {
                Some(LastLag { lag, .. }) => blocks.bound(kernel, lag, watch)?,
                None => blocks.grow(kernel, steps, watch)?,
            }
            if !inputs.is_empty() {
                blocks.clear();
                march(&mut **blocks, 0, &inputs);
                if !self.pending {
                    blocks.work_in(self.steps);
                }
            }
        }
        Ok(&mut **blocks)
    }

    /// Adds the effect of the last input, so that the next output is complete.
    fn settle(&mut self) -> Result<&mut dyn Blocks> {
        let (now, pending) = (self.steps, self.pending);
        self.grow(now.saturating_add(1), &mut Watch::nobody())?;
        self.pending = false;
        let blocks = self.grow(0, &mut Watch::nobody())?;
        if pending {
            blocks.work_in(now);
        }
        Ok(blocks)
    }
}

impl ConvolutionHistory for RelaxedFftHistory {
    fn steps(&self) -> usize {
        self.steps
    }

    /// Computes weights and spectra; the observer sees both.
    fn prepare(&mut self, steps: usize, observer: &mut Observer<'_>) -> Result<()> {
        let (kernel, lags) = (Arc::clone(&self.kernel), self.lags(steps)?);
        let spectra = lags.saturating_mul(kernel.classes().count()) / SPECTRA + 1;
        let mut whole = Progress { task: "convolution weights", done: 0, total: spectra };
        let mut part = |Progress { done, total, task }: Progress| {
            whole = Progress { task, done, total: total + spectra };
            observer(whole)
        };
        let weights = match self.forgotten.filter(|_| self.end.is_none()) {
            // In plan, up to the last lag that counts.
            Some(tolerance) => {
                LastLag::find(&*kernel, tolerance, lags, &mut part).map(|end| self.end = end)
            }
            None => kernel.prepare(lags, &mut part),
        };
        let done = whole.total - spectra;
        let outcome = weights.and_then(|()| {
            let mut part = |part: Progress| {
                whole.done = done + spectra * part.done / PARTS;
                observer(whole)
            };
            let mut watch = Watch::new("spectra", PARTS, &mut part);
            self.grow(steps, &mut watch)?;
            watch.reach(PARTS)
        });
        outcome.map_err(|error| match error {
            Error::Stopped(_) => Error::Stopped(whole),
            other => other,
        })
    }

    fn evaluate(&mut self, displacement: &mut [f64]) -> Result<()> {
        let size = self.kernel.classes().layout().len();
        same_length("displacement of the history", displacement.len(), size)?;
        if let Some(error) = &self.failed {
            return Err(error.clone());
        }
        let now = self.steps;
        self.settle()?.read(now, displacement);
        Ok(())
    }

    /// Bound of the change in a step of the displacement that the dropped lags would add.
    fn increment_error_bound(&self) -> f64 {
        let ended = self.end.filter(|end| self.steps > end.lag);
        ended.map_or(0.0, |end| end.change * self.largest)
    }

    fn memory(&self) -> usize {
        self.blocks.as_ref().map_or(0, |blocks| blocks.numbers()) * size_of::<f64>()
    }

    fn push(&mut self, traction: &[f64]) {
        if self.failed.is_none() {
            let now = self.steps;
            let mut padded = std::mem::take(&mut self.padded);
            let given = traction.len().min(padded.len());
            padded[..given].copy_from_slice(&traction[..given]);
            padded[given..].fill(0.0);
            if self.forgotten.is_some() {
                self.largest = padded.iter().fold(self.largest, |most, x| most.max(x.abs()));
            }
            match self.settle() {
                Ok(blocks) => {
                    blocks.write(now, &padded);
                    self.pending = true;
                }
                Err(error) => self.failed = Some(error),
            }
            self.padded = padded;
        }
        self.steps += 1;
    }

    /// Returns all inputs that still count, step by step; `restore` computes their effects again.
    fn save(&self) -> Result<Vec<f64>> {
        if let Some(error) = &self.failed {
            return Err(error.clone());
        }
        let mut values = Vec::new();
        if let Some(blocks) = &self.blocks {
            let worked_in = self.steps - usize::from(self.pending);
            let first = Self::first_kept(self.end.map(|end| end.lag), self.steps);
            (first..self.steps).for_each(|step| blocks.input(step, worked_in, &mut values));
        }
        if self.forgotten.is_some() {
            values.extend([self.largest, self.end.map_or(0.0, |end| end.lag as f64)]);
        }
        Ok(values)
    }

    fn restore(&mut self, steps: usize, values: &[f64]) -> Result<()> {
        // The inputs are checked before memory is allocated: a damaged number of steps may need any amount.
        let width = self.grow(1, &mut Watch::nobody())?.width();
        let corrupt = || CheckpointError::Corrupt { quantity: "memory of the history" };
        let (values, largest, last) = match (self.forgotten, values) {
            (None, values) => (values, 0.0, None),
            (Some(_), [values @ .., largest, last]) => {
                let known = (0..usize::BITS - 1).map(|power| 1_usize << power);
                let found = known.into_iter().find(|lag| *lag as f64 == *last);
                (values, *largest, found)
            }
            _ => return Err(corrupt().into()),
        };
        let first = Self::first_kept(last, steps);
        check_inputs(steps - first, width, values)?;
        self.grow(steps, &mut Watch::nobody())?;
        // In either history the last lag may not be known yet.
        let own = self.end.map(|end| end.lag);
        let own_first = Self::first_kept(own, steps);
        if own.zip(last).is_some_and(|(own, last)| own != last) || own_first < first {
            return Err(corrupt().into());
        }
        let blocks = self.grow(0, &mut Watch::nobody())?;
        blocks.clear();
        march(blocks, own_first, &values[(own_first - first) * width..]);
        self.largest = largest;
        (self.steps, self.pending, self.failed) = (steps, steps > 0, None);
        Ok(())
    }
}

/// Makes empty blocks for any number of steps, of a kernel without coefficients after lag `reach`.
///
/// `reach` is a leaf times a power of two.
pub(super) fn bounded(kernel: &dyn ConvolutionWeights, reach: usize) -> Result<Box<dyn Blocks>> {
    let classes = kernel.classes();
    let lattice =
        ElementGrid::from_pairs(classes).filter(|_| classes.elements().len() >= WAVES_FROM);
    let mut blocks: Box<dyn Blocks> = match lattice {
        Some(lattice) => Box::new(Waves::new(lattice, kernel)?),
        None => Box::new(Pairs::bounded(kernel)?),
    };
    blocks.bound(kernel, reach, &mut Watch::nobody())?;
    Ok(blocks)
}

/// Repeats the steps from `first` on with `inputs`, with no inputs before them.
///
/// The effect of the last input is still to be added.
fn march(blocks: &mut dyn Blocks, first: usize, inputs: &[f64]) {
    for (ahead, input) in inputs.chunks_exact(blocks.width()).enumerate() {
        let now = first + ahead;
        if ahead > 0 {
            blocks.work_in(now);
        }
        blocks.write_input(now, input);
    }
}
