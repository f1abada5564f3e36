//! Blocks over the wavenumbers of a lattice: one convolution in time for each wavenumber and kind, without pairs of
//! elements.

use std::sync::Arc;

use realfft::RealFftPlanner;
use realfft::num_complex::Complex;
use rustfft::FftPlanner;

use super::blocks::{Blocks, PARTS};
use super::element_grid::ElementGrid;
use super::leaf::{PlanLeaf, StripLeaf};
use super::level::Components;
use super::ring::{LEAF, Ring, widened};
use super::wave_level::{COUPLING, Levels, Near, WaveLevel};
use crate::error::{Result, Watch, unobserved};
use crate::history::convolution_weights::ConvolutionWeights;
use crate::history::shared_spectra::{SharedSpectra, lock};
use crate::linalg::vectorized;

/// Numbers left free between the ends of rows, so that equal places of all rows do not fall into one cache set.
const PADDING: usize = 4;

/// Blocks over wavenumbers: the current leaf, all levels, inputs and outputs so far.
///
/// Within a leaf, a step's contact vector over B wavenumbers is held as two slices of B for each component: real and
/// imaginary parts.
pub(super) struct Waves {
    lattice: ElementGrid,
    /// Last d at which any coupling is not zero; the largest number if it never ends.
    reach: usize,
    near: Arc<Near>,
    levels: Vec<Arc<WaveLevel>>,
    planner: FftPlanner<f64>,
    /// B rows of `stride` for each component: inputs before the present leaf, then outputs as far as known.
    rows: Vec<Complex<f64>>,
    stride: usize,
    ring: Ring,
    capacity: usize,
    /// Last lag that counts, if later lags are dropped.
    end: Option<usize>,
    /// Inputs of this leaf, and in `far` the effect of all earlier leaves on its outputs.
    inputs: Vec<f64>,
    far: Vec<f64>,
    sum: Vec<f64>,
    /// Blocks that are being transformed, and scratch of the transforms.
    blocks: Vec<Complex<f64>>,
    scratch: Vec<Complex<f64>>,
}

impl Waves {
    /// Makes empty blocks of elements on `lattice`.
    pub(super) fn new(lattice: ElementGrid, kernel: &dyn ConvolutionWeights) -> Result<Self> {
        let size = width(&lattice);
        Ok(Self {
            reach: lattice.last_coupling_lag(kernel)?.saturating_sub(1),
            lattice,
            near: Arc::default(),
            levels: Vec::new(),
            planner: FftPlanner::new(),
            rows: Vec::new(),
            stride: 0,
            ring: Ring::ENDLESS,
            capacity: 0,
            end: None,
            inputs: vec![0.0; LEAF * size],
            far: vec![0.0; LEAF * size],
            sum: vec![0.0; size],
            blocks: Vec::new(),
            scratch: Vec::new(),
        })
    }

    /// Whether blocks of `size` have spectra of the coupling: up to the first size that covers its reach.
    fn couples(&self, size: usize) -> bool {
        self.reach > 0 && (size == LEAF || size / 2 < self.reach)
    }

    /// Makes the levels from `first` to the one before `end`, and the coefficients of a leaf unless they are there.
    fn make(
        &mut self,
        kernel: &dyn ConvolutionWeights,
        [first, end]: [usize; 2],
        near: &mut Option<Arc<Near>>,
        watch: &mut Watch,
    ) -> Result<Vec<Arc<WaveLevel>>> {
        let (waves, kinds) = (self.lattice.waves(), self.lattice.kinds());
        let mut levels: Vec<_> = (first..end)
            .map(|number| {
                let size = LEAF << number;
                let couples = self.couples(size);
                let kinds = (0..kinds).map(|kind| kind != COUPLING || couples);
                WaveLevel::new(size, waves, kinds, &mut self.planner)
            })
            .collect();
        let own = self.fill(kernel, &mut levels, near.is_none(), watch)?;
        near.get_or_insert(Arc::new(own));
        Ok(levels.into_iter().map(Arc::new).collect())
    }

    /// Fills the spectra of `levels`, and returns the coefficients of a leaf if they are `wanted`.
    fn fill(
        &mut self,
        kernel: &dyn ConvolutionWeights,
        levels: &mut [WaveLevel],
        wanted: bool,
        watch: &mut Watch,
    ) -> Result<Near> {
        let (waves, kinds) = (self.lattice.waves().own, self.lattice.kinds());
        let near = wanted.then_some(LEAF);
        // Coefficients wait in the place of the largest spectra that are made of them.
        let largest: Vec<_> =
            (0..kinds).map(|kind| levels.iter().rposition(|level| level.has(kind))).collect();
        let lags = |kind: usize| {
            let level = largest[kind].and_then(|number| levels.get(number));
            level.map_or(near.unwrap_or(0), |level| 2 * level.size)
        };
        let (lags, coupled) = (lags(0), lags(COUPLING).min(self.reach.saturating_add(1)));
        let mut table = vec![vec![0.0; near.unwrap_or(0) * waves]; kinds];
        let kept = lags.min(self.end.unwrap_or(lags));
        self.lattice.coefficients(kernel, kept, coupled, |kind, d, values| {
            if kind == 0 && d.is_multiple_of(LEAF) {
                watch.reach(PARTS / 2 * d / kept)?;
            }
            if near.is_some_and(|leaf| d < leaf) {
                table[kind][d * waves..(d + 1) * waves].copy_from_slice(values);
            }
            if let Some(level) = largest[kind].and_then(|number| levels.get_mut(number)) {
                level.keep(kind, d, values);
            }
            Ok(())
        })?;
        let mut planner = RealFftPlanner::new();
        let (mut time, mut real) = (vec![0.0; lags], vec![0.0; lags]);
        for (kind, largest) in largest.into_iter().enumerate() {
            let Some(from) = largest else { continue };
            for wave in 0..waves {
                watch.reach(PARTS / 2 + PARTS / 2 * (kind * waves + wave) / (kinds * waves))?;
                levels[from].kept(kind, wave, &mut time);
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
    fn turn(&mut self, now: usize) {
        let (waves, ring) = (self.lattice.waves().all, self.ring);
        let size = width(&self.lattice);
        let before = ring.before(now, LEAF);
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
        let part =
            if self.levels[number].has(COUPLING) { Components::All } else { Components::Even };
        let Self { levels, rows, blocks, scratch, stride, .. } = self;
        levels[number].apply(rows, *stride, (ring, now), part, blocks, scratch);
        if part == Components::Even
            && let Some(level) = levels.iter().rfind(|level| level.has(COUPLING))
        {
            level.apply(rows, *stride, (ring, now), Components::Coupling, blocks, scratch);
        }
        let begin = ring.place(now);
        for (row, values) in self.rows.chunks_exact(self.stride).enumerate() {
            let re = 2 * waves * (row / waves) + row % waves;
            let far = self.far.chunks_exact_mut(size);
            for (value, far) in values[begin..begin + LEAF].iter().zip(far) {
                (far[re], far[re + waves]) = (value.re, value.im);
            }
        }
    }

    /// Lengthens all rows to `stride`; their values are kept.
    fn widen(&mut self, stride: usize) {
        self.rows = widened(&self.rows, width(&self.lattice) / 2, [self.stride, stride]);
        self.stride = stride;
    }

    /// Takes the `wanted` smallest levels and a leaf's coefficients from the kernel's store, or makes them.
    ///
    /// Allocates scratch for their blocks.
    fn take_levels(
        &mut self,
        kernel: &dyn ConvolutionWeights,
        wanted: usize,
        watch: &mut Watch,
    ) -> Result<()> {
        // The kernel is prepared before the spectra are locked: it may work on several threads, which must not wait.
        let lags = LEAF << wanted;
        kernel.prepare(lags.min(self.end.unwrap_or(lags)), &mut unobserved)?;
        // If late lags are dropped, the spectra do not include all lags, and the store is not used.
        let spectra = kernel.spectra().filter(|_| self.end.is_none());
        let spectra = spectra.filter(|s| s.are_of(kernel.classes().elements()));
        let shared = spectra.map(SharedSpectra::tables::<Levels<WaveLevel, Near>>);
        let mut shared = shared.as_deref().map(lock);
        let near = (self.capacity > 0).then(|| Arc::clone(&self.near));
        let mut own = Levels { levels: self.levels.clone(), near };
        let store = shared.as_deref_mut().unwrap_or(&mut own);
        (self.levels, self.near) =
            store.take(wanted, |range, near| self.make(kernel, range, near, watch))?;
        let zero = Complex::default();
        if let Some(level) = self.levels.last() {
            // Components with coupling are all transformed before they are multiplied.
            let coupled = self.levels.iter().rfind(|level| level.has(COUPLING));
            let coupled = coupled.map_or(0, |l| 2 * self.lattice.components() * l.size);
            let length = self.blocks.len().max(coupled).max(2 * level.size);
            self.blocks.resize(length, zero);
            self.scratch.resize(self.scratch.len().max(level.scratch()), zero);
        }
        Ok(())
    }
}

impl Blocks for Waves {
    fn capacity(&self) -> usize {
        self.capacity
    }

    fn numbers(&self) -> usize {
        let near: usize = self.near.iter().map(Vec::len).sum();
        near + self.levels.iter().map(|level| level.numbers()).sum::<usize>()
            + 2 * (self.rows.len() + self.blocks.len() + self.scratch.len())
            + self.inputs.len()
            + self.far.len()
            + self.sum.len()
            + self.lattice.numbers()
    }

    fn grow(
        &mut self,
        kernel: &dyn ConvolutionWeights,
        steps: usize,
        watch: &mut Watch,
    ) -> Result<()> {
        if steps <= self.capacity && self.capacity > 0 {
            return Ok(());
        }
        let leaves = steps.div_ceil(LEAF).max(1);
        let largest = leaves.next_power_of_two();
        // The first request is met exactly; later ones double the memory.
        let capacity = LEAF * if self.capacity == 0 { leaves } else { largest };
        let wanted = largest.ilog2() as usize;
        self.take_levels(kernel, wanted, watch)?;
        if capacity > LEAF {
            self.widen(capacity + PADDING);
        }
        self.capacity = capacity;
        Ok(())
    }

    fn bound(
        &mut self,
        kernel: &dyn ConvolutionWeights,
        reach: usize,
        watch: &mut Watch,
    ) -> Result<()> {
        self.end = Some(reach);
        self.take_levels(kernel, (reach / LEAF).ilog2() as usize + 1, watch)?;
        self.widen(2 * reach + PADDING);
        (self.ring, self.capacity) = (Ring(2 * reach), usize::MAX);
        Ok(())
    }

    fn work_in(&mut self, now: usize) {
        if now.is_multiple_of(LEAF) {
            self.turn(now);
        }
    }

    fn write(&mut self, now: usize, traction: &[f64]) {
        let (waves, size) = (self.lattice.waves().all, width(&self.lattice));
        let input = &mut self.inputs[now % LEAF * size..][..size];
        let components = traction.chunks_exact(traction.len() / self.lattice.components());
        for (component, (values, part)) in
            components.zip(input.chunks_exact_mut(2 * waves)).enumerate()
        {
            self.lattice.forward(component, values, part.split_at_mut(waves).into());
        }
    }

    fn width(&self) -> usize {
        width(&self.lattice)
    }

    fn input(&self, step: usize, worked_in: usize, values: &mut Vec<f64>) {
        let (waves, size) = (self.lattice.waves().all, self.width());
        if step >= worked_in - worked_in % LEAF {
            let begin = step % LEAF * size;
            values.extend_from_slice(&self.inputs[begin..begin + size]);
        } else {
            let place = self.ring.place(step);
            let row = |row: usize| self.rows[row * self.stride + place];
            for component in 0..self.lattice.components() {
                let of = component * waves..(component + 1) * waves;
                values.extend(of.clone().map(|k| row(k).re));
                values.extend(of.map(|k| row(k).im));
            }
        }
    }

    fn write_input(&mut self, now: usize, input: &[f64]) {
        self.inputs[now % LEAF * input.len()..][..input.len()].copy_from_slice(input);
    }

    fn clear(&mut self) {
        self.rows.fill(Complex::default());
        self.inputs.fill(0.0);
        self.far.fill(0.0);
    }

    fn read(&mut self, now: usize, displacement: &mut [f64]) {
        let (waves, size) = (self.lattice.waves(), width(&self.lattice));
        let components = self.lattice.components();
        let place = now % LEAF;
        self.sum.copy_from_slice(&self.far[place * size..(place + 1) * size]);
        let (sum, inputs) = (&mut self.sum[..], &self.inputs[..place * size]);
        if let [normal, tangential, coupling] = &self.near[..] {
            let near = [&normal[..], tangential, coupling];
            vectorized(StripLeaf { sum, inputs, near, waves: waves.all, reach: self.reach });
        } else {
            vectorized(PlanLeaf { sum, inputs, near: &self.near, waves });
        }
        let values = displacement.chunks_exact_mut(displacement.len() / components);
        for (component, (values, sum)) in
            values.zip(self.sum.chunks_exact(2 * waves.all)).enumerate()
        {
            self.lattice.inverse(component, sum.split_at(waves.all).into(), values);
        }
    }
}

/// Length of a step's contact vector over the wavenumbers of a lattice.
fn width(lattice: &ElementGrid) -> usize {
    2 * lattice.components() * lattice.waves().all
}

#[cfg(test)]
mod tests;
