//! Blocks over pairs of elements of any lengths and places.

use std::ops::Range;
use std::sync::Arc;

use basemat_fourier::RealPlanner;

use super::blocks::{HistoryBlocks, SPECTRA_PROGRESS_PARTS};
use super::coefficients::{ClassCoefficients, Coefficients, Scatter, ShortLagTables};
use super::level::{BlockRows, Components, PairLevel, TransformScratch};
use super::ring::{LEAF_STEPS, Ring, widened};
use super::wave_level::Levels;
use crate::error::{ProgressReporter, Result, unobserved};
use crate::geometry::COMPONENTS_IN_PLANE;
use crate::history::convolution_weights::ConvolutionWeights;
use crate::history::shared_spectra::{SharedSpectra, lock};
use crate::linalg::vectorized;

/// Longest coupling that is summed directly, steps: for a longer coupling blocks are faster.
///
/// Up to this length the time of a step depends little on the choice.
const MAX_DIRECT_COUPLING: usize = 64;

/// Numbers in a memory page; rows of whole pages would map equal columns of all rows to one cache set.
const NUMBERS_PER_PAGE: usize = 512;
/// Numbers in a cache line; a row is longer than whole pages by this number.
const NUMBERS_PER_CACHE_LINE: usize = 8;

/// Blocks over pairs of elements: the current leaf, all levels, inputs and outputs so far.
pub(super) struct PairBlocks {
    coefficients: Coefficients,
    /// Blocks of each size, from the smallest on.
    levels: Vec<Arc<PairLevel>>,
    planner: RealPlanner,
    scratch: TransformScratch,
    /// 2Q rows of `stride`: inputs before the present step, then the outputs computed so far.
    rows: Vec<f64>,
    stride: usize,
    ring: Ring,
    /// Number of steps for which there are rows and levels: the leaf times a power of two.
    capacity: usize,
}

impl PairBlocks {
    /// Creates empty blocks of `weights`.
    pub(super) fn new(weights: &dyn ConvolutionWeights) -> Result<Self> {
        Self::with_coupling(weights, MAX_DIRECT_COUPLING)
    }

    /// Creates empty blocks for any number of steps, in rows whose columns are used again.
    ///
    /// Beyond a leaf no coupling is summed directly.
    pub(super) fn bounded(weights: &dyn ConvolutionWeights) -> Result<Self> {
        Self::with_coupling(weights, 0)
    }

    fn with_coupling(weights: &dyn ConvolutionWeights, max_direct: usize) -> Result<Self> {
        Ok(Self {
            coefficients: Coefficients::new(weights, max_direct)?,
            levels: Vec::new(),
            planner: RealPlanner::new(),
            scratch: TransformScratch::default(),
            rows: Vec::new(),
            stride: 0,
            ring: Ring::ALL_STEPS,
            capacity: 0,
        })
    }

    /// Number of elements, Q.
    fn element_count(&self) -> usize {
        self.coefficients.classes.elements().len()
    }

    /// Whether blocks of `block_size` have spectra of the coupling.
    ///
    /// The sizes up to the first one that covers the reach of the coupling have them.
    fn has_coupling_spectra(&self, block_size: usize) -> bool {
        let coefficients = &self.coefficients;
        coefficients.blocks_have_coupling
            && (block_size == LEAF_STEPS || block_size / 2 < coefficients.coupling_reach)
    }

    /// Computes the levels of these indices, and the short lags unless they exist.
    ///
    /// The weights are evaluated once for all levels.
    fn compute_levels(
        &mut self,
        weights: &dyn ConvolutionWeights,
        level_indices: Range<usize>,
        short_lags: &mut Option<Arc<ShortLagTables>>,
        reporter: &mut ProgressReporter,
    ) -> Result<Vec<Arc<PairLevel>>> {
        let element_count = self.element_count();
        let class_count = self.coefficients.classes.count();
        let kind_count = self.coefficients.classes.kinds();
        let mut levels = Vec::new();
        let level_end = level_indices.end;
        for level_index in level_indices {
            let has_coupling = self.has_coupling_spectra(LEAF_STEPS << level_index);
            let level_kinds = if has_coupling { kind_count } else { COMPONENTS_IN_PLANE };
            let level = PairLevel::new(
                LEAF_STEPS << level_index,
                class_count,
                level_kinds,
                &mut self.planner,
            );
            self.scratch
                .grow(&level, if has_coupling { 2 * element_count } else { element_count });
            levels.push((level, level_kinds));
        }
        let mut tables = short_lags.is_none().then(ShortLagTables::default);
        let spectra_delays = if levels.is_empty() { 0 } else { LEAF_STEPS << level_end };
        let delay_count = if tables.is_some() {
            spectra_delays.max(self.coefficients.length())
        } else {
            spectra_delays
        };
        if delay_count > 0 {
            let mut values: ClassCoefficients = std::array::from_fn(|kind| {
                vec![0.0; if kind < kind_count { delay_count } else { 0 }]
            });
            for class in 0..class_count {
                reporter.reach(SPECTRA_PROGRESS_PARTS * class / class_count)?;
                // The first weight is the step compliance, which does not belong to the history.
                let series = values.iter_mut().take(kind_count);
                let mut slices: Vec<_> = series.map(|series| &mut series[1..]).collect();
                weights.coefficients(class, 2, &mut slices)?;
                if let Some(tables) = &mut tables {
                    self.coefficients.add_class(&values, tables);
                }
                for (level, level_kinds) in &mut levels {
                    level.add_class(&values, *level_kinds, &mut self.scratch);
                }
            }
        }
        if let Some(tables) = tables {
            *short_lags = Some(Arc::new(tables));
        }
        Ok(levels.into_iter().map(|(level, _)| Arc::new(level)).collect())
    }

    /// Sets the smallest `level_count` levels and the short lags, and allocates scratch for their blocks.
    ///
    /// Both are read from the store of the weights, or computed if the store does not contain them.
    fn set_levels(
        &mut self,
        weights: &dyn ConvolutionWeights,
        level_count: usize,
        lags: usize,
        reporter: &mut ProgressReporter,
    ) -> Result<()> {
        let element_count = self.element_count();
        // The weights are prepared before the spectra are locked: threads of the weights must not wait for the lock.
        weights.prepare(lags.max(self.coefficients.length()), &mut unobserved)?;
        let spectra = weights.spectra().filter(|s| s.belong_to(weights.classes().elements()));
        let shared_levels = spectra.map(SharedSpectra::tables::<Levels<PairLevel, ShortLagTables>>);
        let mut shared_levels = shared_levels.as_deref().map(lock);
        let short_lags = (self.capacity > 0).then(|| Arc::clone(&self.coefficients.short_lags));
        let mut private_store = Levels { levels: self.levels.clone(), leaf: short_lags };
        let store = shared_levels.as_deref_mut().unwrap_or(&mut private_store);
        let levels = store.smallest(level_count, |level_indices, short_lags| {
            self.compute_levels(weights, level_indices, short_lags, reporter)
        })?;
        self.levels = levels.levels;
        self.coefficients.short_lags = levels.leaf.unwrap_or_default();
        for level_index in 0..level_count {
            let level = &self.levels[level_index];
            let row_count = if self.has_coupling_spectra(level.block_size) {
                2 * element_count
            } else {
                element_count
            };
            self.scratch.grow(level, row_count);
        }
        Ok(())
    }
}

impl HistoryBlocks for PairBlocks {
    fn capacity(&self) -> usize {
        self.capacity
    }

    fn stored_value_count(&self) -> usize {
        self.rows.capacity()
            + self.coefficients.short_lags.iter().flatten().map(Vec::len).sum::<usize>()
            + self.levels.iter().map(|level| level.stored_value_count()).sum::<usize>()
            + self.scratch.stored_value_count()
    }

    fn extend_capacity(
        &mut self,
        weights: &dyn ConvolutionWeights,
        steps: usize,
        reporter: &mut ProgressReporter,
    ) -> Result<()> {
        let capacity = steps.div_ceil(LEAF_STEPS).next_power_of_two() * LEAF_STEPS;
        if capacity <= self.capacity {
            return Ok(());
        }
        let element_count = self.element_count();
        let level_count = (capacity / LEAF_STEPS).ilog2() as usize;
        self.set_levels(weights, level_count, capacity, reporter)?;
        // Only a coupling that is summed directly has outputs beyond the capacity.
        let column_count = capacity + self.coefficients.direct_coupling_reach;
        let stride = column_count.next_multiple_of(NUMBERS_PER_PAGE) + NUMBERS_PER_CACHE_LINE;
        self.rows = widened(&self.rows, 2 * element_count, self.stride, stride);
        self.stride = stride;
        self.capacity = capacity;
        Ok(())
    }

    fn limit_history(
        &mut self,
        weights: &dyn ConvolutionWeights,
        last_delay: usize,
        reporter: &mut ProgressReporter,
    ) -> Result<()> {
        self.set_levels(
            weights,
            (last_delay / LEAF_STEPS).ilog2() as usize + 1,
            2 * last_delay,
            reporter,
        )?;
        self.ring = Ring(2 * last_delay);
        self.stride = (2 * last_delay).next_multiple_of(NUMBERS_PER_PAGE) + NUMBERS_PER_CACHE_LINE;
        self.rows = vec![0.0; 2 * self.element_count() * self.stride];
        self.capacity = usize::MAX;
        Ok(())
    }

    fn add_effects(&mut self, step: usize) {
        let Some(last) = step.checked_sub(1) else { return };
        let coefficients = &self.coefficients;
        let leaf_outputs = LEAF_STEPS - 1 - last % LEAF_STEPS;
        let coupled_outputs = if coefficients.blocks_have_coupling {
            leaf_outputs
        } else {
            coefficients.direct_coupling_reach
        };
        let ring = self.ring;
        let rows = &mut self.rows[..];
        let stride = self.stride;
        vectorized(Scatter {
            coefficients,
            rows,
            stride,
            column: ring.column(last),
            output_count: leaf_outputs,
            coupled_output_count: coupled_outputs,
        });
        if !step.is_multiple_of(LEAF_STEPS) {
            return;
        }
        if let Some(stale_range) = ring.stale_range(step) {
            let rows = self.rows.chunks_exact_mut(self.stride);
            rows.for_each(|row| row[stale_range.clone()].fill(0.0));
        }
        let level_index = ring.level_index(step, self.levels.len());
        let Some(level) = self.levels.get(level_index) else { return };
        let has_coupling = self.has_coupling_spectra(level.block_size);
        let coupled_level =
            self.levels.iter().rfind(|level| self.has_coupling_spectra(level.block_size));
        let rows = &mut self.rows[..];
        let mut block = BlockRows { rows, stride, ring, step, classes: &coefficients.classes };
        let components = if has_coupling { Components::All } else { Components::Even };
        level.apply(&mut block, components, &mut self.scratch);
        if let Some(level) = coupled_level.filter(|_| !has_coupling) {
            level.apply(&mut block, Components::Coupling, &mut self.scratch);
        }
    }

    fn write_traction(&mut self, step: usize, traction: &[f64]) {
        let column = self.ring.column(step);
        for (row, value) in self.rows.chunks_exact_mut(self.stride).zip(traction) {
            row[column] = *value;
        }
    }

    fn values_per_step(&self) -> usize {
        2 * self.element_count()
    }

    fn input(&self, step: usize, _effects_end: usize, values: &mut Vec<f64>) {
        values.extend(self.rows.chunks_exact(self.stride).map(|row| row[step]));
    }

    fn write_input(&mut self, step: usize, input: &[f64]) {
        self.write_traction(step, input);
    }

    fn clear(&mut self) {
        self.rows.fill(0.0);
    }

    fn read_displacement(&mut self, step: usize, displacement: &mut [f64]) {
        let column = self.ring.column(step);
        for (value, row) in displacement.iter_mut().zip(self.rows.chunks_exact(self.stride)) {
            *value = row[column];
        }
    }
}
