//! Blocks over the wavenumbers of a lattice: a convolution in time for each wavenumber and kind of coefficient.

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

/// Unused numbers at the end of each row, without which equal columns of all rows would map to one cache set.
const ROW_PADDING: usize = 4;

/// Blocks over wavenumbers: the present leaf, all levels, inputs and outputs so far.
///
/// A leaf is a block of [`LEAF_STEPS`] steps; effects within it are summed directly. A level computes the effect of
/// blocks of one size on the steps after them.
///
/// Within a leaf, a step's contact vector over B wavenumbers is stored as two slices of B for each component: real
/// and imaginary parts.
pub(super) struct WaveBlocks {
    grid: ElementGrid,
    /// Last delay d (lag d + 1) at which any coupling is not zero; `usize::MAX` if it never ends.
    coupling_reach: usize,
    leaf: Arc<LeafCoefficients>,
    levels: Vec<Arc<WaveLevel>>,
    planner: ComplexPlanner,
    /// B rows of `stride` for each component: inputs before the present leaf, then the outputs computed so far.
    rows: Vec<Complex<f64>>,
    stride: usize,
    ring: Ring,
    /// Number of steps for which rows and levels suffice.
    capacity: usize,
    /// Last lag that is not neglected; `None` to neglect no lag.
    last_lag: Option<usize>,
    /// Inputs of the present leaf.
    inputs: Vec<f64>,
    /// Effect of all earlier leaves on the outputs of the present leaf.
    earlier_effects: Vec<f64>,
    /// Scratch: the output of a step over the wavenumbers.
    sum: Vec<f64>,
    /// Blocks that are being transformed, and scratch of the transforms.
    blocks: Vec<Complex<f64>>,
    scratch: Vec<Complex<f64>>,
}

impl WaveBlocks {
    /// Creates empty blocks of elements on a lattice.
    pub(super) fn new(grid: ElementGrid, weights: &dyn ConvolutionWeights) -> Result<Self> {
        let input_width = values_per_step(&grid);
        Ok(Self {
            coupling_reach: grid.last_coupling_lag(weights)?.saturating_sub(1),
            grid,
            leaf: Arc::default(),
            levels: Vec::new(),
            planner: ComplexPlanner::new(),
            rows: Vec::new(),
            stride: 0,
            ring: Ring::ALL_STEPS,
            capacity: 0,
            last_lag: None,
            inputs: vec![0.0; LEAF_STEPS * input_width],
            earlier_effects: vec![0.0; LEAF_STEPS * input_width],
            sum: vec![0.0; input_width],
            blocks: Vec::new(),
            scratch: Vec::new(),
        })
    }

    /// Whether blocks of `block_size` have spectra of the coupling.
    ///
    /// The sizes up to the first one that covers the reach of the coupling have them.
    fn has_coupling_spectra(&self, block_size: usize) -> bool {
        self.coupling_reach > 0
            && (block_size == LEAF_STEPS || block_size / 2 < self.coupling_reach)
    }

    /// Computes the levels of these indices, and the coefficients of a leaf unless they exist.
    fn compute_levels(
        &mut self,
        weights: &dyn ConvolutionWeights,
        level_indices: Range<usize>,
        leaf: &mut Option<Arc<LeafCoefficients>>,
        reporter: &mut ProgressReporter,
    ) -> Result<Vec<Arc<WaveLevel>>> {
        let waves = self.grid.waves();
        let mut levels = Vec::with_capacity(level_indices.len());
        for level_index in level_indices {
            let block_size = LEAF_STEPS << level_index;
            let has_coupling = self.has_coupling_spectra(block_size);
            let kinds = (0..self.grid.kinds()).map(|kind| kind != COUPLING_KIND || has_coupling);
            levels.push(WaveLevel::new(block_size, waves, kinds, &mut self.planner));
        }
        let leaf_coefficients =
            self.fill_spectra(weights, &mut levels, leaf.is_none(), reporter)?;
        leaf.get_or_insert(Arc::new(leaf_coefficients));
        Ok(levels.into_iter().map(Arc::new).collect())
    }

    /// Fills the spectra of `levels`, and returns the coefficients of a leaf if `with_leaf`.
    fn fill_spectra(
        &mut self,
        weights: &dyn ConvolutionWeights,
        levels: &mut [WaveLevel],
        with_leaf: bool,
        reporter: &mut ProgressReporter,
    ) -> Result<LeafCoefficients> {
        let wave_count = self.grid.waves().with_spectra;
        let kind_count = self.grid.kinds();
        let leaf_steps = if with_leaf { LEAF_STEPS } else { 0 };
        // The coefficients of a kind are stored in the memory of its largest spectra until these are computed.
        let largest_level_indices: Vec<_> = (0..kind_count)
            .map(|kind| levels.iter().rposition(|level| level.has_spectra(kind)))
            .collect();
        // Number of lags whose coefficients of a kind are needed.
        let needed_lags = |kind: usize| {
            let level = largest_level_indices[kind].and_then(|level_index| levels.get(level_index));
            level.map_or(leaf_steps, |level| 2 * level.block_size)
        };
        let lag_count = needed_lags(0);
        let coupled_lags = needed_lags(COUPLING_KIND).min(self.coupling_reach.saturating_add(1));
        let mut leaf_tables = vec![vec![0.0; leaf_steps * wave_count]; kind_count];
        let computed_lags = lag_count.min(self.last_lag.unwrap_or(lag_count));
        self.grid.coefficients(weights, computed_lags, coupled_lags, |kind, d, values| {
            if kind == 0 && d.is_multiple_of(LEAF_STEPS) {
                reporter.reach(SPECTRA_PROGRESS_PARTS / 2 * d / computed_lags)?;
            }
            if d < leaf_steps {
                leaf_tables[kind][d * wave_count..(d + 1) * wave_count].copy_from_slice(values);
            }
            if let Some(level) =
                largest_level_indices[kind].and_then(|level_index| levels.get_mut(level_index))
            {
                level.store_coefficients(kind, d, values);
            }
            Ok(())
        })?;
        let mut planner = RealPlanner::new();
        let half_parts = SPECTRA_PROGRESS_PARTS / 2;
        let mut samples = vec![0.0; lag_count];
        let mut buffer = vec![0.0; lag_count];
        for (kind, largest_level_index) in largest_level_indices.into_iter().enumerate() {
            let Some(largest_level_index) = largest_level_index else { continue };
            for wave in 0..wave_count {
                reporter.reach(
                    half_parts
                        + half_parts * (kind * wave_count + wave) / (kind_count * wave_count),
                )?;
                levels[largest_level_index].stored_coefficients(kind, wave, &mut samples);
                for level in levels.iter_mut().filter(|level| level.has_spectra(kind)) {
                    let buffer = &mut buffer[..2 * level.block_size];
                    buffer.copy_from_slice(&samples[..2 * level.block_size]);
                    level.transform(kind, wave, buffer, &mut planner, &mut self.scratch);
                }
            }
        }
        Ok(leaf_tables)
    }

    /// Copies the leaf that ends before `step` to the rows, adds its effect, and begins the next leaf.
    fn finish_leaf(&mut self, step: usize) {
        let wave_count = self.grid.waves().count;
        let ring = self.ring;
        let input_width = values_per_step(&self.grid);
        let input_range = ring.input_range(step, LEAF_STEPS);
        let stale_range = ring.stale_range(step);
        for (row, values) in self.rows.chunks_exact_mut(self.stride).enumerate() {
            if let Some(stale_range) = &stale_range {
                values[stale_range.clone()].fill(Complex::default());
            }
            let real_index = 2 * wave_count * (row / wave_count) + row % wave_count;
            let inputs = self.inputs.chunks_exact(input_width);
            for (value, input) in values[input_range.clone()].iter_mut().zip(inputs) {
                *value = Complex::new(input[real_index], input[real_index + wave_count]);
            }
        }
        let level_index = ring.level_index(step, self.levels.len());
        let components = if self.levels[level_index].has_spectra(COUPLING_KIND) {
            Components::All
        } else {
            Components::Even
        };
        let Self { levels, rows, blocks, scratch, stride, .. } = self;
        levels[level_index].apply(rows, *stride, ring, step, components, blocks, scratch);
        if components == Components::Even
            && let Some(level) = levels.iter().rfind(|level| level.has_spectra(COUPLING_KIND))
        {
            level.apply(rows, *stride, ring, step, Components::Coupling, blocks, scratch);
        }
        let start = ring.column(step);
        for (row, values) in self.rows.chunks_exact(self.stride).enumerate() {
            let real_index = 2 * wave_count * (row / wave_count) + row % wave_count;
            let outputs = self.earlier_effects.chunks_exact_mut(input_width);
            for (value, output) in values[start..start + LEAF_STEPS].iter().zip(outputs) {
                output[real_index] = value.re;
                output[real_index + wave_count] = value.im;
            }
        }
    }

    /// Lengthens all rows to `stride`, with their values.
    fn widen(&mut self, stride: usize) {
        self.rows = widened(&self.rows, values_per_step(&self.grid) / 2, self.stride, stride);
        self.stride = stride;
    }

    /// Sets the smallest `level_count` levels and a leaf's coefficients, and allocates scratch for their blocks.
    ///
    /// Both are read from the store of the weights, or computed if the store does not contain them.
    fn set_levels(
        &mut self,
        weights: &dyn ConvolutionWeights,
        level_count: usize,
        reporter: &mut ProgressReporter,
    ) -> Result<()> {
        // The weights are prepared before the spectra are locked: threads of the weights must not wait for the lock.
        let lags = LEAF_STEPS << level_count;
        weights.prepare(lags.min(self.last_lag.unwrap_or(lags)), &mut unobserved)?;
        // If late lags are neglected, the spectra do not include all lags, and the store is not used.
        let spectra = weights.spectra().filter(|_| self.last_lag.is_none());
        let spectra = spectra.filter(|spectra| spectra.belong_to(weights.classes().elements()));
        let shared_levels =
            spectra.map(SharedSpectra::tables::<Levels<WaveLevel, LeafCoefficients>>);
        let mut shared_levels = shared_levels.as_deref().map(lock);
        let leaf = (self.capacity > 0).then(|| Arc::clone(&self.leaf));
        let mut private_store = Levels { levels: self.levels.clone(), leaf };
        let store = shared_levels.as_deref_mut().unwrap_or(&mut private_store);
        let smallest_levels = store.smallest(level_count, |level_indices, leaf| {
            self.compute_levels(weights, level_indices, leaf, reporter)
        })?;
        self.levels = smallest_levels.levels;
        self.leaf = smallest_levels.leaf.unwrap_or_default();
        let zero = Complex::default();
        if let Some(level) = self.levels.last() {
            // Components with coupling are all transformed before they are multiplied.
            let coupled_level = self.levels.iter().rfind(|level| level.has_spectra(COUPLING_KIND));
            let coupled_length =
                coupled_level.map_or(0, |coupled| 2 * self.grid.components() * coupled.block_size);
            let length = self.blocks.len().max(coupled_length).max(2 * level.block_size);
            self.blocks.resize(length, zero);
            self.scratch.resize(self.scratch.len().max(level.scratch_length()), zero);
        }
        Ok(())
    }
}

impl HistoryBlocks for WaveBlocks {
    fn capacity(&self) -> usize {
        self.capacity
    }

    fn stored_value_count(&self) -> usize {
        let leaf: usize = self.leaf.iter().map(Vec::len).sum();
        leaf + self.levels.iter().map(|level| level.stored_value_count()).sum::<usize>()
            + 2 * (self.rows.len() + self.blocks.len() + self.scratch.len())
            + self.inputs.len()
            + self.earlier_effects.len()
            + self.sum.len()
            + self.grid.stored_value_count()
    }

    fn extend_capacity(
        &mut self,
        weights: &dyn ConvolutionWeights,
        steps: usize,
        reporter: &mut ProgressReporter,
    ) -> Result<()> {
        if steps <= self.capacity && self.capacity > 0 {
            return Ok(());
        }
        let leaf_count = steps.div_ceil(LEAF_STEPS).max(1);
        let padded_leaf_count = leaf_count.next_power_of_two();
        // The first request allocates only the leaves that it needs; later requests double the memory.
        let capacity = LEAF_STEPS * if self.capacity == 0 { leaf_count } else { padded_leaf_count };
        let level_count = padded_leaf_count.ilog2() as usize;
        self.set_levels(weights, level_count, reporter)?;
        if capacity > LEAF_STEPS {
            self.widen(capacity + ROW_PADDING);
        }
        self.capacity = capacity;
        Ok(())
    }

    fn limit_history(
        &mut self,
        weights: &dyn ConvolutionWeights,
        last_delay: usize,
        reporter: &mut ProgressReporter,
    ) -> Result<()> {
        // The coefficients of the lags after `last_delay` are neglected.
        self.last_lag = Some(last_delay);
        self.set_levels(weights, (last_delay / LEAF_STEPS).ilog2() as usize + 1, reporter)?;
        self.widen(2 * last_delay + ROW_PADDING);
        self.ring = Ring(2 * last_delay);
        self.capacity = usize::MAX;
        Ok(())
    }

    fn add_effects(&mut self, step: usize) {
        if step.is_multiple_of(LEAF_STEPS) {
            self.finish_leaf(step);
        }
    }

    fn write_traction(&mut self, step: usize, traction: &[f64]) {
        let wave_count = self.grid.waves().count;
        let input_width = values_per_step(&self.grid);
        let input = &mut self.inputs[step % LEAF_STEPS * input_width..][..input_width];
        let components = traction.chunks_exact(traction.len() / self.grid.components());
        for (component, (values, complex_values)) in
            components.zip(input.chunks_exact_mut(2 * wave_count)).enumerate()
        {
            let (re, im) = complex_values.split_at_mut(wave_count);
            self.grid.forward(component, values, re, im);
        }
    }

    fn values_per_step(&self) -> usize {
        values_per_step(&self.grid)
    }

    fn input(&self, step: usize, effects_end: usize, values: &mut Vec<f64>) {
        let wave_count = self.grid.waves().count;
        let input_width = self.values_per_step();
        if step >= effects_end - effects_end % LEAF_STEPS {
            let start = step % LEAF_STEPS * input_width;
            values.extend_from_slice(&self.inputs[start..start + input_width]);
        } else {
            let column = self.ring.column(step);
            for component in 0..self.grid.components() {
                let rows = component * wave_count..(component + 1) * wave_count;
                values.extend(rows.clone().map(|row| self.rows[row * self.stride + column].re));
                values.extend(rows.map(|row| self.rows[row * self.stride + column].im));
            }
        }
    }

    fn write_input(&mut self, step: usize, input: &[f64]) {
        self.inputs[step % LEAF_STEPS * input.len()..][..input.len()].copy_from_slice(input);
    }

    fn clear(&mut self) {
        self.rows.fill(Complex::default());
        self.inputs.fill(0.0);
        self.earlier_effects.fill(0.0);
    }

    fn read_displacement(&mut self, step: usize, displacement: &mut [f64]) {
        let waves = self.grid.waves();
        let input_width = values_per_step(&self.grid);
        let components = self.grid.components();
        let leaf_step = step % LEAF_STEPS;
        self.sum.copy_from_slice(
            &self.earlier_effects[leaf_step * input_width..(leaf_step + 1) * input_width],
        );
        let sum = &mut self.sum[..];
        let inputs = &self.inputs[..leaf_step * input_width];
        if let [normal, tangential, coupling] = &self.leaf[..] {
            let coefficients = [&normal[..], tangential, coupling];
            let reach = self.coupling_reach;
            vectorized(StripLeaf { sum, inputs, coefficients, waves: waves.count, reach });
        } else {
            vectorized(PlanLeaf { sum, inputs, coefficients: &self.leaf, waves });
        }
        let values = displacement.chunks_exact_mut(displacement.len() / components);
        for (component, (values, component_sum)) in
            values.zip(self.sum.chunks_exact(2 * waves.count)).enumerate()
        {
            let (re, im) = component_sum.split_at(waves.count);
            self.grid.inverse(component, re, im, values);
        }
    }
}

/// Length of a step's contact vector over the wavenumbers of a lattice.
fn values_per_step(grid: &ElementGrid) -> usize {
    2 * grid.components() * grid.waves().count
}

#[cfg(test)]
mod tests;
