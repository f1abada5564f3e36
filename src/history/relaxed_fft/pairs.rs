//! Blocks over pairs of elements of any lengths and places.

use std::ops::Range;
use std::sync::Arc;

use basemat_fourier::RealPlanner;

use super::blocks::{HistoryBlocks, SPECTRA_PROGRESS_PARTS};
use super::coefficients::{Coefficients, Scatter};
use super::level::{BlockRows, Components, PairLevel, TransformScratch};
use super::ring::{LEAF_STEPS, Ring, widened};
use super::tables::{ClassCoefficients, ShortLagTables};
use super::wave_level::Levels;
use crate::error::{ProgressReporter, Result, unobserved};
use crate::geometry::COMPONENTS_IN_PLANE;
use crate::history::convolution_weights::ConvolutionWeights;
use crate::history::shared_spectra::{SharedSpectra, lock};
use crate::linalg::vectorized;

/// Longest coupling that is summed directly, steps; for a longer coupling blocks are faster.
///
/// Up to this length the time of a step depends little on the choice.
const MAX_DIRECT_COUPLING: usize = 64;

/// Numbers in a memory page.
///
/// Rows of whole pages would map equal places of all rows to one cache set.
const NUMBERS_PER_PAGE: usize = 512;
/// Numbers in a cache line: rows are longer than whole pages by this.
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
    /// Makes empty blocks of `kernel`.
    pub(super) fn new(kernel: &dyn ConvolutionWeights) -> Result<Self> {
        Self::with_coupling(kernel, MAX_DIRECT_COUPLING)
    }

    /// Makes empty blocks for rows whose places are reused.
    ///
    /// No coupling beyond a leaf is summed directly.
    pub(super) fn bounded(kernel: &dyn ConvolutionWeights) -> Result<Self> {
        Self::with_coupling(kernel, 0)
    }

    fn with_coupling(kernel: &dyn ConvolutionWeights, max_direct: usize) -> Result<Self> {
        Ok(Self {
            coefficients: Coefficients::new(kernel, max_direct)?,
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
    fn elements(&self) -> usize {
        self.coefficients.classes.elements().len()
    }

    /// Whether blocks of `size` have spectra of the coupling.
    ///
    /// They do up to the first size that covers its reach.
    fn couples(&self, size: usize) -> bool {
        let coefficients = &self.coefficients;
        coefficients.couples_far && (size == LEAF_STEPS || size / 2 < coefficients.coupling_reach)
    }

    /// Makes the levels of these numbers, and the short lags unless they are there.
    ///
    /// The kernel is evaluated once for all of them.
    fn make_levels(
        &mut self,
        kernel: &dyn ConvolutionWeights,
        numbers: Range<usize>,
        short_lags: &mut Option<Arc<ShortLagTables>>,
        watch: &mut ProgressReporter,
    ) -> Result<Vec<Arc<PairLevel>>> {
        let count = self.elements();
        let classes = self.coefficients.classes.count();
        let kind_count = self.coefficients.classes.kinds();
        let mut levels = Vec::new();
        let end = numbers.end;
        for number in numbers {
            let couples = self.couples(LEAF_STEPS << number);
            let kinds = if couples { kind_count } else { COMPONENTS_IN_PLANE };
            let level = PairLevel::new(LEAF_STEPS << number, classes, kinds, &mut self.planner);
            self.scratch.grow(&level, if couples { 2 * count } else { count });
            levels.push((level, kinds));
        }
        let mut tables = short_lags.is_none().then(ShortLagTables::default);
        let max_delay = if levels.is_empty() { 0 } else { LEAF_STEPS << end };
        let length =
            if tables.is_some() { max_delay.max(self.coefficients.length()) } else { max_delay };
        if length > 0 {
            let mut values: ClassCoefficients =
                std::array::from_fn(|kind| vec![0.0; if kind < kind_count { length } else { 0 }]);
            for class in 0..classes {
                watch.reach(SPECTRA_PROGRESS_PARTS * class / classes)?;
                // The first weight is the step compliance, which does not belong to the history.
                let series = values.iter_mut().take(kind_count);
                let mut slices: Vec<_> = series.map(|series| &mut series[1..]).collect();
                kernel.coefficients(class, 2, &mut slices)?;
                if let Some(tables) = &mut tables {
                    self.coefficients.add_class(&values, tables);
                }
                for (level, kinds) in &mut levels {
                    level.add_class(&values, *kinds, &mut self.scratch);
                }
            }
        }
        if let Some(tables) = tables {
            *short_lags = Some(Arc::new(tables));
        }
        Ok(levels.into_iter().map(|(level, _)| Arc::new(level)).collect())
    }

    /// Takes the smallest `level_count` levels and the short lags from the kernel's store, or makes them.
    ///
    /// Allocates scratch for their blocks.
    fn take_levels(
        &mut self,
        kernel: &dyn ConvolutionWeights,
        level_count: usize,
        lags: usize,
        watch: &mut ProgressReporter,
    ) -> Result<()> {
        let count = self.elements();
        // The kernel is prepared before the spectra are locked: its threads must not wait for the lock.
        kernel.prepare(lags.max(self.coefficients.length()), &mut unobserved)?;
        let spectra = kernel.spectra().filter(|s| s.are_of(kernel.classes().elements()));
        let shared = spectra.map(SharedSpectra::tables::<Levels<PairLevel, ShortLagTables>>);
        let mut shared = shared.as_deref().map(lock);
        let short_lags = (self.capacity > 0).then(|| Arc::clone(&self.coefficients.short_lags));
        let mut private_store = Levels { levels: self.levels.clone(), leaf: short_lags };
        let store = shared.as_deref_mut().unwrap_or(&mut private_store);
        let found = store.smallest(level_count, |numbers, short_lags| {
            self.make_levels(kernel, numbers, short_lags, watch)
        })?;
        self.levels = found.levels;
        self.coefficients.short_lags = found.leaf.unwrap_or_default();
        for number in 0..level_count {
            let level = &self.levels[number];
            let components = if self.couples(level.size) { 2 * count } else { count };
            self.scratch.grow(level, components);
        }
        Ok(())
    }
}

impl HistoryBlocks for PairBlocks {
    fn capacity(&self) -> usize {
        self.capacity
    }

    fn numbers(&self) -> usize {
        self.rows.capacity()
            + self.coefficients.short_lags.iter().flatten().map(Vec::len).sum::<usize>()
            + self.levels.iter().map(|level| level.numbers()).sum::<usize>()
            + self.scratch.numbers()
    }

    fn grow(
        &mut self,
        kernel: &dyn ConvolutionWeights,
        steps: usize,
        watch: &mut ProgressReporter,
    ) -> Result<()> {
        let capacity = steps.div_ceil(LEAF_STEPS).next_power_of_two() * LEAF_STEPS;
        if capacity <= self.capacity {
            return Ok(());
        }
        let count = self.elements();
        let level_count = (capacity / LEAF_STEPS).ilog2() as usize;
        self.take_levels(kernel, level_count, capacity, watch)?;
        // Only a coupling that is summed directly has outputs beyond the capacity.
        let needed = capacity + self.coefficients.coupling_direct;
        let stride = needed.next_multiple_of(NUMBERS_PER_PAGE) + NUMBERS_PER_CACHE_LINE;
        self.rows = widened(&self.rows, 2 * count, self.stride, stride);
        self.stride = stride;
        self.capacity = capacity;
        Ok(())
    }

    fn bound(
        &mut self,
        kernel: &dyn ConvolutionWeights,
        last_delay: usize,
        watch: &mut ProgressReporter,
    ) -> Result<()> {
        self.take_levels(
            kernel,
            (last_delay / LEAF_STEPS).ilog2() as usize + 1,
            2 * last_delay,
            watch,
        )?;
        self.ring = Ring(2 * last_delay);
        self.stride = (2 * last_delay).next_multiple_of(NUMBERS_PER_PAGE) + NUMBERS_PER_CACHE_LINE;
        self.rows = vec![0.0; 2 * self.elements() * self.stride];
        self.capacity = usize::MAX;
        Ok(())
    }

    fn add_effects(&mut self, now: usize) {
        let Some(last) = now.checked_sub(1) else { return };
        let coefficients = &self.coefficients;
        let ahead = LEAF_STEPS - 1 - last % LEAF_STEPS;
        let coupled = if coefficients.couples_far { ahead } else { coefficients.coupling_direct };
        let ring = self.ring;
        let rows = &mut self.rows[..];
        let stride = self.stride;
        vectorized(Scatter { coefficients, rows, stride, now: ring.place(last), ahead, coupled });
        if !now.is_multiple_of(LEAF_STEPS) {
            return;
        }
        if let Some(stale) = ring.stale(now) {
            let rows = self.rows.chunks_exact_mut(self.stride);
            rows.for_each(|row| row[stale.clone()].fill(0.0));
        }
        let number = ring.level(now, self.levels.len());
        let Some(level) = self.levels.get(number) else { return };
        let couples = self.couples(level.size);
        let coupled_level = self.levels.iter().rfind(|level| self.couples(level.size));
        let rows = &mut self.rows[..];
        let mut block = BlockRows { rows, stride, ring, now, classes: &coefficients.classes };
        let part = if couples { Components::All } else { Components::Even };
        level.apply(&mut block, part, &mut self.scratch);
        if let Some(level) = coupled_level.filter(|_| !couples) {
            level.apply(&mut block, Components::Coupling, &mut self.scratch);
        }
    }

    fn write(&mut self, now: usize, traction: &[f64]) {
        let place = self.ring.place(now);
        for (row, value) in self.rows.chunks_exact_mut(self.stride).zip(traction) {
            row[place] = *value;
        }
    }

    fn width(&self) -> usize {
        2 * self.elements()
    }

    fn input(&self, step: usize, _effects_end: usize, values: &mut Vec<f64>) {
        values.extend(self.rows.chunks_exact(self.stride).map(|row| row[step]));
    }

    fn write_input(&mut self, now: usize, input: &[f64]) {
        self.write(now, input);
    }

    fn clear(&mut self) {
        self.rows.fill(0.0);
    }

    fn read(&mut self, now: usize, displacement: &mut [f64]) {
        let place = self.ring.place(now);
        for (value, row) in displacement.iter_mut().zip(self.rows.chunks_exact(self.stride)) {
            *value = row[place];
        }
    }
}
