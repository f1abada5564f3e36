//! Blocks of inputs and outputs: when each is due, what is kept for it, and how it grows.

use std::ops::Range;
use std::sync::Arc;

use super::level::Rows;
use super::level::{Level, Near, Part, Work};
use super::spectra::SharedSpectra;
use crate::error::Result;
use crate::history::convolution_weights::ConvolutionWeights;

/// Steps that are summed directly before the smallest block is transformed. Measured with 10 and
/// 14 elements: 16 takes as long, 64 a fifth longer by pairs; by wavenumbers it hardly matters.
pub(crate) const LEAF: usize = 32;

/// How a patch is taken apart in space: into pairs of elements, or into wavenumbers.
pub(super) trait Space: Send {
    /// What blocks have to know of it.
    fn extent(&self) -> Extent;

    /// A level of blocks without spectra yet.
    fn level(&mut self, size: usize, couples: bool) -> Level;

    /// Fills the spectra of `levels`, and returns the coefficients of a leaf if they are `wanted`: all of
    /// one evaluation of the kernel.
    fn fill(
        &mut self,
        kernel: &dyn ConvolutionWeights,
        levels: &mut [Level],
        wanted: bool,
    ) -> Result<Near>;

    /// Overwrites the numbers in which an input is kept; missing tractions count as zero.
    fn input(&mut self, traction: &[f64], input: &mut [f64]);

    /// Overwrites the traction of which [`Space::input`] made `input`.
    fn traction(&mut self, input: &[f64], traction: &mut [f64]);

    /// Works the `input` of step `last` in, as far as no block does.
    fn work_in(&mut self, _near: &Near, _rows: &mut Rows, _last: usize, _input: &[f64]) {}

    /// Takes up a leaf that begins with step `now`, when all blocks that end there were worked in.
    fn begin(&mut self, _rows: &Rows, _now: usize) {}

    /// Overwrites `out` with the displacement of step `now`, after the `inputs` of its leaf so far.
    fn output(&mut self, near: &Near, rows: &Rows, now: usize, inputs: &[f64], out: &mut [f64]);

    /// Real numbers held.
    fn numbers(&self) -> usize {
        0
    }
}

/// What blocks have to know of a [`Space`].
#[derive(Clone, Copy)]
pub(super) struct Extent {
    /// Whether it is one of wavenumbers.
    pub(super) along_surface: bool,
    /// Numbers in which the input of a step is kept.
    pub(super) width: usize,
    /// Numbers of each component of it.
    pub(super) parts: usize,
    /// Coefficients of each series that a leaf takes.
    pub(super) lags: usize,
    /// Steps after it that an input reaches without blocks, if that is further than its leaf.
    pub(super) ahead: usize,
    /// Last d at which a coupling for blocks is not zero; the largest number if it never ends.
    pub(super) reach: usize,
}

/// Inputs and outputs so far, and how blocks of one give blocks of the other.
pub(crate) struct Blocks {
    space: Box<dyn Space>,
    extent: Extent,
    /// Steps that are summed directly.
    leaf: usize,
    levels: Vec<Arc<Level>>,
    /// Coefficients of a leaf.
    near: Arc<Near>,
    /// Levels of a kernel that keeps none.
    own: SharedSpectra,
    rows: Rows,
    /// Steps for which there are rows and levels. Where it is no power of two, the outputs of the
    /// last blocks end with it, and are missing when it grows.
    capacity: usize,
    /// Steps whose inputs were worked in.
    done: usize,
    /// Inputs of this leaf, step by step: in the rows it still has outputs.
    inputs: Vec<f64>,
    /// One input that is read back.
    kept: Vec<f64>,
    work: Work,
}

impl Blocks {
    /// Without room for any step. Places are used again after `period` steps, and these are then the most
    /// to make ready for: no coefficient may be other than zero beyond d = `period` / 2.
    pub(super) fn new(space: Box<dyn Space>, leaf: usize, period: usize) -> Self {
        let extent = space.extent();
        Self {
            space,
            extent,
            leaf,
            levels: Vec::new(),
            near: Arc::default(),
            own: SharedSpectra::default(),
            rows: Rows::new([extent.width, extent.parts], period),
            capacity: 0,
            done: 0,
            inputs: vec![0.0; leaf * extent.width],
            kept: Vec::new(),
            work: Work::default(),
        }
    }

    /// Makes ready for at least `steps` steps, and returns whether outputs are missing thereafter. All
    /// stays as it was on an error.
    pub(super) fn grow(&mut self, kernel: &dyn ConvolutionWeights, steps: usize) -> Result<bool> {
        if steps <= self.capacity && self.capacity > 0 {
            return Ok(false);
        }
        let leaves = steps.div_ceil(self.leaf).max(1);
        let largest = leaves.next_power_of_two();
        self.take_levels(kernel, largest.ilog2())?;
        // The first request is met exactly; later ones double the memory.
        let capacity = self.leaf * if self.capacity == 0 { leaves } else { largest };
        self.rows.lengthen(capacity + self.extent.ahead);
        let complete = self.capacity == 0 || self.capacity.is_power_of_two();
        self.capacity = capacity;
        Ok(!complete)
    }

    /// The `wanted` smallest levels and the coefficients of a leaf, from the kernel's store as far as
    /// they are there, with scratch for their blocks.
    fn take_levels(&mut self, kernel: &dyn ConvolutionWeights, wanted: u32) -> Result<()> {
        let Self { space, extent, leaf, own, work, .. } = self;
        // Before the spectra are locked: a kernel may work on several threads, which must not wait.
        kernel.prepare(extent.lags.max(*leaf << wanted))?;
        let elements = kernel.classes().elements();
        let shared = kernel.spectra().filter(|shared| *leaf == LEAF && shared.are_of(elements));
        let mut store = shared.unwrap_or(own).levels(extent.along_surface);
        let couples = |size| extent.reach > 0 && (size == *leaf || size / 2 < extent.reach);
        let mut more: Vec<_> = (store.levels.len()..wanted as usize)
            .map(|number| *leaf << number)
            .map(|size| space.level(size, couples(size)))
            .collect();
        let near = space.fill(kernel, &mut more, store.near.is_none())?;
        self.near = Arc::clone(store.near.get_or_insert_with(|| Arc::new(near)));
        store.levels.extend(more.into_iter().map(Arc::new));
        self.levels = store.levels[..wanted as usize].to_vec();
        self.levels.iter().for_each(|level| level.convolution.reserve(level, work));
        Ok(())
    }

    /// Real numbers held.
    pub(crate) fn numbers(&self) -> usize {
        self.near.iter().map(Vec::len).sum::<usize>()
            + self.levels.iter().map(|level| level.numbers()).sum::<usize>()
            + self.rows.values.len()
            + self.inputs.len()
            + self.space.numbers()
            + self.work.numbers()
    }

    /// Works the input of step `now` − 1 in, so that the output of `now` is complete.
    pub(crate) fn work_in(&mut self, now: usize) {
        if now <= self.done {
            return;
        }
        let last = self.slot(now - 1);
        let Self { space, rows, work, levels, inputs, .. } = self;
        space.work_in(&self.near, rows, now - 1, &inputs[last]);
        self.done = now;
        if !now.is_multiple_of(self.leaf) {
            return;
        }
        rows.renew(now);
        rows.write(now - self.leaf, inputs);
        let number = (now / self.leaf).trailing_zeros() as usize;
        if let Some(level) = levels.get(number).or(levels.last()) {
            let couples = level.has(2);
            let part = if couples { Part::All } else { Part::Even };
            level.convolution.apply(level, rows, now, part, work);
            if let Some(level) = levels.iter().rfind(|level| !couples && level.has(2)) {
                level.convolution.apply(level, rows, now, Part::Coupling, work);
            }
        }
        space.begin(rows, now);
    }

    /// Where the input of a step of this leaf is.
    fn slot(&self, step: usize) -> Range<usize> {
        let (slot, width) = (step % self.leaf, self.extent.width);
        slot * width..(slot + 1) * width
    }

    /// Accepts the input of step `now`.
    pub(crate) fn write(&mut self, now: usize, traction: &[f64]) {
        let slot = self.slot(now);
        self.space.input(traction, &mut self.inputs[slot]);
    }

    /// Overwrites `displacement` with the output of step `now`.
    pub(crate) fn read(&mut self, now: usize, displacement: &mut [f64]) {
        let inputs = &self.inputs[..self.slot(now).start];
        self.space.output(&self.near, &self.rows, now, inputs, displacement);
    }

    /// Forgets all inputs and outputs.
    pub(crate) fn clear(&mut self) {
        self.rows.values.fill(0.0);
        self.space.begin(&self.rows, 0);
        self.done = 0;
    }

    /// Numbers in which the input of a step is kept.
    pub(super) fn width(&self) -> usize {
        self.extent.width
    }

    /// What is kept of the inputs of the first `steps` steps.
    pub(super) fn inputs(&self, steps: usize) -> Vec<f64> {
        let mut values = Vec::with_capacity(steps * self.extent.width);
        (0..steps).for_each(|step| self.input(step, &mut values));
        values
    }

    /// Appends what is kept of the input of `step`.
    fn input(&self, step: usize, values: &mut Vec<f64>) {
        if step < self.done - self.done % self.leaf {
            values.extend(self.rows.step(step));
        } else {
            values.extend_from_slice(&self.inputs[self.slot(step)]);
        }
    }

    /// Overwrites `traction` with that of `step`.
    pub(super) fn traction(&mut self, step: usize, traction: &mut [f64]) {
        let mut kept = std::mem::take(&mut self.kept);
        kept.clear();
        self.input(step, &mut kept);
        self.space.traction(&kept, traction);
        self.kept = kept;
    }

    /// Goes through all steps again, from nothing to where the last of `inputs` is not yet worked in.
    pub(super) fn march(&mut self, inputs: &[f64]) {
        self.clear();
        for (now, input) in inputs.chunks_exact(self.extent.width).enumerate() {
            self.work_in(now);
            let slot = self.slot(now);
            self.inputs[slot].copy_from_slice(input);
        }
    }
}
