//! Blocks over pairs of elements of any lengths and places.

use std::sync::Arc;

use realfft::RealFftPlanner;

use super::blocks::{Blocks, PARTS};
use super::coefficients::{Coefficients, Scatter};
use super::level::{Block, Components, Level, Work};
use super::ring::{LEAF, Ring, widened};
use super::tables::{Class, Tables};
use super::wave_level::Levels;
use crate::error::{Result, Watch, unobserved};
use crate::geometry::COMPONENTS_IN_PLANE;
use crate::history::convolution_weights::{ConvolutionWeights, all_kinds};
use crate::history::shared_spectra::{SharedSpectra, lock};
use crate::linalg::vectorized;

/// Longest coupling, steps, that is summed directly. Up to here times hardly depend on it; for a longer coupling blocks
/// are faster.
const DIRECT_COUPLING: usize = 64;

/// Rows begin at different places of a page; otherwise equal places of all rows fall into one cache set.
const PAGE_OF_NUMBERS: usize = 512;
const LINE_OF_NUMBERS: usize = 8;

/// Blocks over pairs of elements: the current leaf, all levels, inputs and outputs so far.
pub(super) struct Pairs {
    coefficients: Coefficients,
    /// Blocks of each size, from the smallest on.
    levels: Vec<Arc<Level>>,
    planner: RealFftPlanner<f64>,
    work: Work,
    /// 2Q rows of `stride`: inputs before the present step, outputs as far as known from there on.
    rows: Vec<f64>,
    stride: usize,
    ring: Ring,
    /// Number of steps for which there are rows and levels: the leaf times a power of two.
    capacity: usize,
}

impl Pairs {
    /// Makes empty blocks of `kernel`.
    pub(super) fn new(kernel: &dyn ConvolutionWeights) -> Result<Self> {
        Self::with_coupling(kernel, DIRECT_COUPLING)
    }

    /// Makes empty blocks for rows whose places are used again: no coupling beyond a leaf is summed directly.
    pub(super) fn bounded(kernel: &dyn ConvolutionWeights) -> Result<Self> {
        Self::with_coupling(kernel, 0)
    }

    fn with_coupling(kernel: &dyn ConvolutionWeights, direct: usize) -> Result<Self> {
        Ok(Self {
            coefficients: Coefficients::new(kernel, direct)?,
            levels: Vec::new(),
            planner: RealFftPlanner::new(),
            work: Work::default(),
            rows: Vec::new(),
            stride: 0,
            ring: Ring::ENDLESS,
            capacity: 0,
        })
    }

    /// Number of elements, Q.
    fn elements(&self) -> usize {
        self.coefficients.classes.elements().len()
    }

    /// Whether blocks of `size` have spectra of the coupling: up to the first size that covers its reach.
    fn couples(&self, size: usize) -> bool {
        let coefficients = &self.coefficients;
        coefficients.couples_far && (size == LEAF || size / 2 < coefficients.coupling_reach)
    }

    /// Makes the levels from `first` to the one before `end`, and the coefficients of a leaf unless they are there.
    ///
    /// The kernel is evaluated once for all of them.
    fn make(
        &mut self,
        kernel: &dyn ConvolutionWeights,
        [first, end]: [usize; 2],
        near: &mut Option<Arc<Tables>>,
        watch: &mut Watch,
    ) -> Result<Vec<Arc<Level>>> {
        let (count, classes) = (self.elements(), self.coefficients.classes.count());
        let all = self.coefficients.classes.kinds();
        let mut levels = Vec::new();
        for number in first..end {
            let couples = self.couples(LEAF << number);
            let kinds = if couples { all } else { COMPONENTS_IN_PLANE };
            let level = Level::new(LEAF << number, classes, kinds, &mut self.planner);
            self.work.grow(&level, if couples { 2 * count } else { count });
            levels.push((level, kinds));
        }
        let mut tables = near.is_none().then(Tables::default);
        let far = if levels.is_empty() { 0 } else { LEAF << end };
        let length = if tables.is_some() { far.max(self.coefficients.length()) } else { far };
        if length > 0 {
            let mut values: Class =
                std::array::from_fn(|kind| vec![0.0; if kind < all { length } else { 0 }]);
            for class in 0..classes {
                watch.reach(PARTS * class / classes)?;
                // The first weight is the step compliance, which does not belong to the history.
                let kinds = values.iter_mut().take(all);
                let mut slices: Vec<_> = kinds.map(|kind| &mut kind[1..]).collect();
                all_kinds(kernel, class, 2, &mut slices)?;
                if let Some(tables) = &mut tables {
                    self.coefficients.add_class(&values, tables);
                }
                for (level, kinds) in &mut levels {
                    level.add_class(&values, *kinds, &mut self.work);
                }
            }
        }
        if let Some(tables) = tables {
            *near = Some(Arc::new(tables));
        }
        Ok(levels.into_iter().map(|(level, _)| Arc::new(level)).collect())
    }

    /// Takes the `wanted` smallest levels and a leaf's coefficients from the kernel's store, or makes them.
    ///
    /// Allocates scratch for their blocks.
    fn take_levels(
        &mut self,
        kernel: &dyn ConvolutionWeights,
        wanted: usize,
        lags: usize,
        watch: &mut Watch,
    ) -> Result<()> {
        let count = self.elements();
        // The kernel is prepared before the spectra are locked: it may work on several threads, which must not wait.
        kernel.prepare(lags.max(self.coefficients.length()), &mut unobserved)?;
        let spectra = kernel.spectra().filter(|s| s.are_of(kernel.classes().elements()));
        let shared = spectra.map(SharedSpectra::tables::<Levels<Level, Tables>>);
        let mut shared = shared.as_deref().map(lock);
        let near = (self.capacity > 0).then(|| Arc::clone(&self.coefficients.near));
        let mut own = Levels { levels: self.levels.clone(), near };
        let store = shared.as_deref_mut().unwrap_or(&mut own);
        (self.levels, self.coefficients.near) =
            store.take(wanted, |range, near| self.make(kernel, range, near, watch))?;
        for number in 0..wanted {
            let level = &self.levels[number];
            let components = if self.couples(level.size) { 2 * count } else { count };
            self.work.grow(level, components);
        }
        Ok(())
    }
}

impl Blocks for Pairs {
    fn capacity(&self) -> usize {
        self.capacity
    }

    fn numbers(&self) -> usize {
        self.rows.capacity()
            + self.coefficients.near.iter().flatten().map(Vec::len).sum::<usize>()
            + self.levels.iter().map(|level| level.numbers()).sum::<usize>()
            + self.work.numbers()
    }

    fn grow(
        &mut self,
        kernel: &dyn ConvolutionWeights,
        steps: usize,
        watch: &mut Watch,
    ) -> Result<()> {
        let capacity = steps.div_ceil(LEAF).next_power_of_two() * LEAF;
        if capacity <= self.capacity {
            return Ok(());
        }
        let count = self.elements();
        let wanted = (capacity / LEAF).ilog2() as usize;
        self.take_levels(kernel, wanted, capacity, watch)?;
        // Only a coupling that is summed directly has outputs beyond the capacity.
        let needed = capacity + self.coefficients.coupling_direct;
        let stride = needed.next_multiple_of(PAGE_OF_NUMBERS) + LINE_OF_NUMBERS;
        self.rows = widened(&self.rows, 2 * count, [self.stride, stride]);
        (self.stride, self.capacity) = (stride, capacity);
        Ok(())
    }

    fn bound(
        &mut self,
        kernel: &dyn ConvolutionWeights,
        reach: usize,
        watch: &mut Watch,
    ) -> Result<()> {
        self.take_levels(kernel, (reach / LEAF).ilog2() as usize + 1, 2 * reach, watch)?;
        self.ring = Ring(2 * reach);
        self.stride = (2 * reach).next_multiple_of(PAGE_OF_NUMBERS) + LINE_OF_NUMBERS;
        self.rows = vec![0.0; 2 * self.elements() * self.stride];
        self.capacity = usize::MAX;
        Ok(())
    }

    fn work_in(&mut self, now: usize) {
        let Some(last) = now.checked_sub(1) else { return };
        let coefficients = &self.coefficients;
        let ahead = LEAF - 1 - last % LEAF;
        let coupled = if coefficients.couples_far { ahead } else { coefficients.coupling_direct };
        let (ring, rows, stride) = (self.ring, &mut self.rows[..], self.stride);
        vectorized(Scatter { coefficients, rows, stride, now: ring.place(last), ahead, coupled });
        if !now.is_multiple_of(LEAF) {
            return;
        }
        if let Some(stale) = ring.stale(now) {
            let rows = self.rows.chunks_exact_mut(self.stride);
            rows.for_each(|row| row[stale.clone()].fill(0.0));
        }
        let number = ring.level(now, self.levels.len());
        let Some(level) = self.levels.get(number) else { return };
        let couples = self.couples(level.size);
        let far = self.levels.iter().rfind(|level| self.couples(level.size));
        let (rows, stride) = (&mut self.rows[..], self.stride);
        let mut block = Block { rows, stride, ring, now, classes: &coefficients.classes };
        level.apply(
            &mut block,
            if couples { Components::All } else { Components::Even },
            &mut self.work,
        );
        if let Some(level) = far.filter(|_| !couples) {
            level.apply(&mut block, Components::Coupling, &mut self.work);
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

    fn input(&self, step: usize, _worked_in: usize, values: &mut Vec<f64>) {
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
