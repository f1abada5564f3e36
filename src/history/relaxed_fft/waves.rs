//! Blocks over the wavenumbers of a lattice: a convolution in time for each wavenumber and kind.

use std::ops::Range;
use std::sync::Arc;

use basemat_fourier::ComplexPlanner;
use basemat_fourier::RealPlanner;
use basemat_fourier::num_complex::Complex;

use super::blocks::{HistoryBlocks, SPECTRA_PROGRESS_PARTS};
use super::element_grid::ElementGrid;
use super::leaf::{PlanLeaf, StripLeaf};
use super::level::Components;
use super::ring::{LEAF_STEPS, Ring, widened};
use super::wave_level::{LeafCoefficients, Levels, WaveLevel};
use crate::error::{ProgressReporter, Result, unobserved};
use crate::history::convolution_weights::ConvolutionWeights;
use crate::history::pair_classes::COUPLING_KIND;
use crate::history::shared_spectra::{SharedSpectra, lock};
use crate::linalg::vectorized;

/// Unused numbers at the end of each row.
///
/// Without them equal places of all rows would fall into one cache set.
const ROW_PADDING: usize = 4;

/// Blocks over wavenumbers: the current leaf, all levels, inputs and outputs so far.
///
/// Within a leaf, a step's contact vector over B wavenumbers is stored as two slices of B for each component: real
/// and imaginary parts.
pub(super) struct WaveBlocks {
    lattice: ElementGrid,
    /// Last d at which any coupling is not zero; the largest number if it never ends.
    reach: usize,
    leaf: Arc<LeafCoefficients>,
    levels: Vec<Arc<WaveLevel>>,
    planner: ComplexPlanner,
    /// B rows of `stride` for each component: inputs before the present leaf, then the outputs computed so far.
    rows: Vec<Complex<f64>>,
    stride: usize,
    ring: Ring,
    capacity: usize,
    /// Last lag that is not neglected; `None` to neglect no lag.
    last_lag: Option<usize>,
    /// Inputs of this leaf.
    inputs: Vec<f64>,
    /// Effect of all earlier leaves on the outputs of this leaf.
    earlier_effects: Vec<f64>,
    sum: Vec<f64>,
    /// Blocks that are being transformed, and scratch of the transforms.
    blocks: Vec<Complex<f64>>,
    scratch: Vec<Complex<f64>>,
}

impl WaveBlocks {
    /// Makes empty blocks of elements on `lattice`.
    pub(super) fn new(lattice: ElementGrid, kernel: &dyn ConvolutionWeights) -> Result<Self> {
        let size = width(&lattice);
        Ok(Self {
            reach: lattice.last_coupling_lag(kernel)?.saturating_sub(1),
            lattice,
            leaf: Arc::default(),
            levels: Vec::new(),
            planner: ComplexPlanner::new(),
            rows: Vec::new(),
            stride: 0,
            ring: Ring::ALL_STEPS,
            capacity: 0,
            last_lag: None,
            inputs: vec![0.0; LEAF_STEPS * size],
            earlier_effects: vec![0.0; LEAF_STEPS * size],
            sum: vec![0.0; size],
            blocks: Vec::new(),
            scratch: Vec::new(),
        })
    }

    /// Whether blocks of `size` have spectra of the coupling.
    ///
    /// They do up to the first size that covers its reach.
    fn couples(&self, size: usize) -> bool {
        self.reach > 0 && (size == LEAF_STEPS || size / 2 < self.reach)
    }

    /// Makes the levels of these numbers, and the coefficients of a leaf unless they are there.
    fn make_levels(
        &mut self,
        kernel: &dyn ConvolutionWeights,
        numbers: Range<usize>,
        leaf: &mut Option<Arc<LeafCoefficients>>,
        watch: &mut ProgressReporter,
    ) -> Result<Vec<Arc<WaveLevel>>> {
        let waves = self.lattice.waves();
        let mut levels = Vec::with_capacity(numbers.len());
        for number in numbers {
            let size = LEAF_STEPS << number;
            let couples = self.couples(size);
            let kinds = (0..self.lattice.kinds()).map(|kind| kind != COUPLING_KIND || couples);
            levels.push(WaveLevel::new(size, waves, kinds, &mut self.planner));
        }
        let computed = self.fill_spectra(kernel, &mut levels, leaf.is_none(), watch)?;
        leaf.get_or_insert(Arc::new(computed));
        Ok(levels.into_iter().map(Arc::new).collect())
    }

    /// Fills the spectra of `levels`, and returns the coefficients of a leaf if `with_leaf`.
    fn fill_spectra(
        &mut self,
        kernel: &dyn ConvolutionWeights,
        levels: &mut [WaveLevel],
        with_leaf: bool,
        watch: &mut ProgressReporter,
    ) -> Result<LeafCoefficients> {
        let waves = self.lattice.waves().with_spectra;
        let kinds = self.lattice.kinds();
        let leaf_steps = if with_leaf { LEAF_STEPS } else { 0 };
        // The coefficients of a kind are stored in the memory of its largest spectra until these are computed.
        let largest: Vec<_> =
            (0..kinds).map(|kind| levels.iter().rposition(|level| level.has(kind))).collect();
        let lags_of = |kind: usize| {
            let level = largest[kind].and_then(|number| levels.get(number));
            level.map_or(leaf_steps, |level| 2 * level.size)
        };
        let lags = lags_of(0);
        let coupled = lags_of(COUPLING_KIND).min(self.reach.saturating_add(1));
        let mut table = vec![vec![0.0; leaf_steps * waves]; kinds];
        let computed_lags = lags.min(self.last_lag.unwrap_or(lags));
        self.lattice.coefficients(kernel, computed_lags, coupled, |kind, d, values| {
            if kind == 0 && d.is_multiple_of(LEAF_STEPS) {
                watch.reach(SPECTRA_PROGRESS_PARTS / 2 * d / computed_lags)?;
            }
            if d < leaf_steps {
                table[kind][d * waves..(d + 1) * waves].copy_from_slice(values);
            }
            if let Some(level) = largest[kind].and_then(|number| levels.get_mut(number)) {
                level.store_coefficients(kind, d, values);
            }
            Ok(())
        })?;
        let mut planner = RealPlanner::new();
        let half = SPECTRA_PROGRESS_PARTS / 2;
        let mut time = vec![0.0; lags];
        let mut real = vec![0.0; lags];
        for (kind, largest) in largest.into_iter().enumerate() {
            let Some(largest) = largest else { continue };
            for wave in 0..waves {
                watch.reach(half + half * (kind * waves + wave) / (kinds * waves))?;
                levels[largest].stored_coefficients(kind, wave, &mut time);
                for level in levels.iter_mut().filter(|level| level.has(kind)) {
                    let real = &mut real[..2 * level.size];
                    real.copy_from_slice(&time[..2 * level.size]);
                    level.transform(kind, wave, real, &mut planner, &mut self.scratch);
                }
            }
        }
        Ok(table)
    }

    /// Moves the leaf that ends before `now` to the rows, adds its effect, and begins the next leaf.
    fn finish_leaf(&mut self, now: usize) {
        let waves = self.lattice.waves().count;
        let ring = self.ring;
        let size = width(&self.lattice);
        let before = ring.before(now, LEAF_STEPS);
        let stale = ring.stale(now);
        for (row, values) in self.rows.chunks_exact_mut(self.stride).enumerate() {
            if let Some(stale) = &stale {
                values[stale.clone()].fill(Complex::default());
            }
            let re = 2 * waves * (row / waves) + row % waves;
            let inputs = self.inputs.chunks_exact(size);
            for (value, input) in values[before.clone()].iter_mut().zip(inputs) {
                *value = Complex::new(input[re], input[re + waves]);
            }
        }
        let number = ring.level(now, self.levels.len());
        let part = if self.levels[number].has(COUPLING_KIND) {
            Components::All
        } else {
            Components::Even
        };
        let Self { levels, rows, blocks, scratch, stride, .. } = self;
        levels[number].apply(rows, *stride, ring, now, part, blocks, scratch);
        if part == Components::Even
            && let Some(level) = levels.iter().rfind(|level| level.has(COUPLING_KIND))
        {
            level.apply(rows, *stride, ring, now, Components::Coupling, blocks, scratch);
        }
        let begin = ring.place(now);
        for (row, values) in self.rows.chunks_exact(self.stride).enumerate() {
            let re = 2 * waves * (row / waves) + row % waves;
            let outputs = self.earlier_effects.chunks_exact_mut(size);
            for (value, output) in values[begin..begin + LEAF_STEPS].iter().zip(outputs) {
                output[re] = value.re;
                output[re + waves] = value.im;
            }
        }
    }

    /// Lengthens all rows to `stride`, with their values.
    fn widen(&mut self, stride: usize) {
        self.rows = widened(&self.rows, width(&self.lattice) / 2, self.stride, stride);
        self.stride = stride;
    }

    /// Takes the smallest `level_count` levels and a leaf's coefficients from the kernel's store, or makes them.
    ///
    /// Allocates scratch for their blocks.
    fn take_levels(
        &mut self,
        kernel: &dyn ConvolutionWeights,
        level_count: usize,
        watch: &mut ProgressReporter,
    ) -> Result<()> {
        // The kernel is prepared before the spectra are locked: its threads must not wait for the lock.
        let lags = LEAF_STEPS << level_count;
        kernel.prepare(lags.min(self.last_lag.unwrap_or(lags)), &mut unobserved)?;
        // If late lags are neglected, the spectra do not include all lags, and the store is not used.
        let spectra = kernel.spectra().filter(|_| self.last_lag.is_none());
        let spectra = spectra.filter(|s| s.are_of(kernel.classes().elements()));
        let shared = spectra.map(SharedSpectra::tables::<Levels<WaveLevel, LeafCoefficients>>);
        let mut shared = shared.as_deref().map(lock);
        let leaf = (self.capacity > 0).then(|| Arc::clone(&self.leaf));
        let mut private_store = Levels { levels: self.levels.clone(), leaf };
        let store = shared.as_deref_mut().unwrap_or(&mut private_store);
        let found = store.smallest(level_count, |numbers, leaf| {
            self.make_levels(kernel, numbers, leaf, watch)
        })?;
        self.levels = found.levels;
        self.leaf = found.leaf.unwrap_or_default();
        let zero = Complex::default();
        if let Some(level) = self.levels.last() {
            // Components with coupling are all transformed before they are multiplied.
            let coupled_length = self.levels.iter().rfind(|level| level.has(COUPLING_KIND));
            let coupled_length =
                coupled_length.map_or(0, |l| 2 * self.lattice.components() * l.size);
            let length = self.blocks.len().max(coupled_length).max(2 * level.size);
            self.blocks.resize(length, zero);
            self.scratch.resize(self.scratch.len().max(level.scratch()), zero);
        }
        Ok(())
    }
}

impl HistoryBlocks for WaveBlocks {
    fn capacity(&self) -> usize {
        self.capacity
    }

    fn numbers(&self) -> usize {
        let leaf: usize = self.leaf.iter().map(Vec::len).sum();
        leaf + self.levels.iter().map(|level| level.numbers()).sum::<usize>()
            + 2 * (self.rows.len() + self.blocks.len() + self.scratch.len())
            + self.inputs.len()
            + self.earlier_effects.len()
            + self.sum.len()
            + self.lattice.numbers()
    }

    fn grow(
        &mut self,
        kernel: &dyn ConvolutionWeights,
        steps: usize,
        watch: &mut ProgressReporter,
    ) -> Result<()> {
        if steps <= self.capacity && self.capacity > 0 {
            return Ok(());
        }
        let leaves = steps.div_ceil(LEAF_STEPS).max(1);
        let largest = leaves.next_power_of_two();
        // The first request is met exactly; later ones double the memory.
        let capacity = LEAF_STEPS * if self.capacity == 0 { leaves } else { largest };
        let level_count = largest.ilog2() as usize;
        self.take_levels(kernel, level_count, watch)?;
        if capacity > LEAF_STEPS {
            self.widen(capacity + ROW_PADDING);
        }
        self.capacity = capacity;
        Ok(())
    }

    fn bound(
        &mut self,
        kernel: &dyn ConvolutionWeights,
        reach: usize,
        watch: &mut ProgressReporter,
    ) -> Result<()> {
        self.last_lag = Some(reach);
        self.take_levels(kernel, (reach / LEAF_STEPS).ilog2() as usize + 1, watch)?;
        self.widen(2 * reach + ROW_PADDING);
        self.ring = Ring(2 * reach);
        self.capacity = usize::MAX;
        Ok(())
    }

    fn add_effects(&mut self, now: usize) {
        if now.is_multiple_of(LEAF_STEPS) {
            self.finish_leaf(now);
        }
    }

    fn write(&mut self, now: usize, traction: &[f64]) {
        let waves = self.lattice.waves().count;
        let size = width(&self.lattice);
        let input = &mut self.inputs[now % LEAF_STEPS * size..][..size];
        let components = traction.chunks_exact(traction.len() / self.lattice.components());
        for (component, (values, part)) in
            components.zip(input.chunks_exact_mut(2 * waves)).enumerate()
        {
            let (re, im) = part.split_at_mut(waves);
            self.lattice.forward(component, values, re, im);
        }
    }

    fn width(&self) -> usize {
        width(&self.lattice)
    }

    fn input(&self, step: usize, effects_end: usize, values: &mut Vec<f64>) {
        let waves = self.lattice.waves().count;
        let size = self.width();
        if step >= effects_end - effects_end % LEAF_STEPS {
            let begin = step % LEAF_STEPS * size;
            values.extend_from_slice(&self.inputs[begin..begin + size]);
        } else {
            let place = self.ring.place(step);
            for component in 0..self.lattice.components() {
                let rows = component * waves..(component + 1) * waves;
                values.extend(rows.clone().map(|row| self.rows[row * self.stride + place].re));
                values.extend(rows.map(|row| self.rows[row * self.stride + place].im));
            }
        }
    }

    fn write_input(&mut self, now: usize, input: &[f64]) {
        self.inputs[now % LEAF_STEPS * input.len()..][..input.len()].copy_from_slice(input);
    }

    fn clear(&mut self) {
        self.rows.fill(Complex::default());
        self.inputs.fill(0.0);
        self.earlier_effects.fill(0.0);
    }

    fn read(&mut self, now: usize, displacement: &mut [f64]) {
        let waves = self.lattice.waves();
        let size = width(&self.lattice);
        let components = self.lattice.components();
        let place = now % LEAF_STEPS;
        self.sum.copy_from_slice(&self.earlier_effects[place * size..(place + 1) * size]);
        let sum = &mut self.sum[..];
        let inputs = &self.inputs[..place * size];
        if let [normal, tangential, coupling] = &self.leaf[..] {
            let coefficients = [&normal[..], tangential, coupling];
            let reach = self.reach;
            vectorized(StripLeaf { sum, inputs, coefficients, waves: waves.count, reach });
        } else {
            vectorized(PlanLeaf { sum, inputs, coefficients: &self.leaf, waves });
        }
        let values = displacement.chunks_exact_mut(displacement.len() / components);
        for (component, (values, sum)) in
            values.zip(self.sum.chunks_exact(2 * waves.count)).enumerate()
        {
            let (re, im) = sum.split_at(waves.count);
            self.lattice.inverse(component, re, im, values);
        }
    }
}

/// Length of a step's contact vector over the wavenumbers of a lattice.
fn width(lattice: &ElementGrid) -> usize {
    2 * lattice.components() * lattice.waves().count
}

#[cfg(test)]
mod tests;
