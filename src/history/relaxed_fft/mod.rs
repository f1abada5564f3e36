//! The history by transforms of blocks: exact to rounding, O(log² N) per step.

mod coefficients;
mod level;

use std::sync::Arc;

use realfft::RealFftPlanner;

use self::coefficients::{Class, Coefficients};
use self::level::{Block, Level, Part, Work};
use super::ConvolutionHistory;
use super::source::CoefficientSource;
use crate::bem::PatchKernel;
use crate::error::{Error, Result, same_length};

/// Steps that are summed directly before the smallest block is transformed. With 10 elements, 32
/// takes about as long, 128 a quarter longer in long runs.
const LEAF: usize = 64;

/// A coupling that reaches no further ahead than this is summed directly. Times hardly depend on
/// it up to here; further on blocks are faster.
const DIRECT_COUPLING: usize = 64;

/// Longest hint that is followed at once; beyond, memory grows as steps come in.
const LONGEST_HINT: usize = 1 << 22;

/// Relaxed blocked convolution: equal to [`DirectHistory`](super::DirectHistory) to rounding, for
/// any number of steps not known in advance.
///
/// Time is cut into leaves of 64 steps. Within a leaf, pairs of input and output are summed as
/// they are. After i steps, i a multiple of the leaf, let b be the leaf times the largest power of
/// two with which b divides i: what the last b inputs give at the next b outputs is one
/// convolution of length 2b, done by transforms (Hairer, Lubich & Schlichte 1985, SIAM J. Sci.
/// Stat. Comput. 6, 532–541). Every pair of input and output is in exactly one such block, so
/// nothing is left out and nothing approximated.
///
/// Each component is transformed once per block; products are summed over the sources in the
/// frequency domain, with one spectrum per pair *class*: on a uniform patch Q offsets instead of
/// Q² pairs. The coupling of normal and tangential components ends when the Rayleigh wave has
/// crossed the patch: it is summed directly where that takes few steps, and otherwise by blocks no
/// larger than its reach.
///
/// # Cost
///
/// Q elements, N steps, C classes (Q on a uniform strip, about Q²/4 on a graded one), and
/// log₂(N/64) sizes of blocks:
///
/// | | direct sum | relaxed transforms |
/// |---|---|---|
/// | multiply–adds per step | 2Q² · N/2 on average | 2Q² · 32 in the leaf; per size 4Q² for products and about 5Q log₂ 2b for transforms |
/// | coefficients, bytes | 16 C N | 32 C M, M the power of two at or above N |
/// | tractions, bytes | 16 Q N | 16 Q M |
/// | scratch, bytes | none | 8 (Q + 2) M |
///
/// Steps are of unequal cost: the one that completes a block of b pays for all of it, 4Q
/// transforms of length 2b.
///
/// Memory grows by doubling when steps go on past [`reserve`](ConvolutionHistory::reserve); within
/// it nothing is allocated. Results may differ in the last digits between processors, as the
/// transforms use the widest instructions found at run time.
pub struct RelaxedFftHistory {
    source: Arc<dyn CoefficientSource>,
    coefficients: Option<Coefficients>,
    levels: Vec<Level>,
    planner: RealFftPlanner<f64>,
    work: Work,
    /// 2Q rows of `stride`: inputs before `steps`, outputs as far as known from there on.
    rows: Vec<f64>,
    stride: usize,
    /// Steps for which there are rows and levels: the leaf times a power of two.
    capacity: usize,
    steps: usize,
    /// Whether the last input still has to be worked in.
    pending: bool,
    /// Why inputs could not be accepted.
    failed: Option<Error>,
}

impl RelaxedFftHistory {
    /// History of `kernel`, empty.
    pub fn new(kernel: Arc<PatchKernel>) -> Self {
        Self::of(kernel)
    }

    /// History of any coefficients, empty.
    pub(crate) fn of(source: Arc<dyn CoefficientSource>) -> Self {
        Self {
            source,
            coefficients: None,
            levels: Vec::new(),
            planner: RealFftPlanner::new(),
            work: Work::default(),
            rows: Vec::new(),
            stride: 0,
            capacity: 0,
            steps: 0,
            pending: false,
            failed: None,
        }
    }

    /// Bytes held in coefficients, tractions and scratch.
    pub fn memory(&self) -> usize {
        let numbers = self.rows.capacity()
            + self.coefficients.as_ref().map_or(0, Coefficients::numbers)
            + self.levels.iter().map(Level::numbers).sum::<usize>()
            + self.work.numbers();
        numbers * size_of::<f64>()
    }

    /// Makes ready for at least `steps` steps. Nothing is changed on an error.
    fn grow(&mut self, steps: usize) -> Result<()> {
        let capacity = steps.div_ceil(LEAF).next_power_of_two() * LEAF;
        if capacity <= self.capacity {
            return Ok(());
        }
        let coefficients = match self.coefficients.take() {
            Some(coefficients) => coefficients,
            None => Coefficients::new(&*self.source, LEAF, DIRECT_COUPLING)?,
        };
        let coefficients = self.coefficients.insert(coefficients);
        let count = coefficients.scales.len();
        let from = self.levels.len();
        let mut levels = Vec::new();
        let mut size = LEAF << from;
        while size < capacity {
            let mut level = Level::new(size, &mut self.planner);
            let couples = couples(coefficients, size);
            level.reserve(coefficients.classes, couples);
            self.work.grow(&level, if couples { 2 * count } else { count });
            levels.push((level, couples));
            size *= 2;
        }
        if !levels.is_empty() {
            let mut values = Class::new(capacity);
            for class in 0..coefficients.classes {
                values.fill(&*self.source, class)?;
                let values = [&values.normal[..], &values.tangential, &values.coupling];
                for (level, couples) in &mut levels {
                    level.add_class(values, *couples, &mut self.work);
                }
            }
        }
        // Inputs reach past the end of the capacity only by a coupling that is summed directly.
        let stride = capacity + coefficients.coupling_direct;
        let mut rows = vec![0.0; 2 * count * stride];
        if self.stride > 0 {
            for (new, old) in rows.chunks_exact_mut(stride).zip(self.rows.chunks_exact(self.stride))
            {
                new[..self.stride].copy_from_slice(old);
            }
        }
        self.levels.extend(levels.into_iter().map(|(level, _)| level));
        (self.rows, self.stride, self.capacity) = (rows, stride, capacity);
        Ok(())
    }

    /// Works the last input in, so that the next output is complete.
    fn settle(&mut self) -> Result<()> {
        if self.steps >= self.capacity {
            self.grow(self.steps + 1)?;
        }
        let Some(coefficients) = self.coefficients.as_ref().filter(|_| self.pending) else {
            return Ok(());
        };
        let (now, last) = (self.steps, self.steps - 1);
        let ahead = LEAF - 1 - last % LEAF;
        let coupled = if coefficients.couples_far() { ahead } else { coefficients.coupling_direct };
        coefficients.scatter(&mut self.rows, self.stride, last, ahead, coupled);
        if now.is_multiple_of(LEAF) {
            let number = (now / LEAF).trailing_zeros() as usize;
            let (rows, stride) = (&mut self.rows[..], self.stride);
            let mut block = Block { rows, stride, now, coefficients };
            let level = &self.levels[number];
            if couples(coefficients, level.size) {
                level.apply(&mut block, Part::All, &mut self.work);
            } else {
                level.apply(&mut block, Part::Normal, &mut self.work);
                level.apply(&mut block, Part::Tangential, &mut self.work);
                let far = |level: &&Level| couples(coefficients, level.size);
                if let Some(level) = self.levels.iter().rfind(far) {
                    level.apply(&mut block, Part::Coupling, &mut self.work);
                }
            }
        }
        self.pending = false;
        Ok(())
    }
}

/// Whether blocks of `size` have spectra of the coupling: up to the first that covers its reach.
fn couples(coefficients: &Coefficients, size: usize) -> bool {
    coefficients.couples_far() && (size == LEAF || size / 2 < coefficients.coupling_reach)
}

impl ConvolutionHistory for RelaxedFftHistory {
    fn steps(&self) -> usize {
        self.steps
    }

    fn reserve(&mut self, steps: usize) -> Result<()> {
        self.grow(steps.min(self.steps.saturating_add(LONGEST_HINT)))
    }

    fn evaluate(&mut self, displacement: &mut [f64]) -> Result<()> {
        let count = self.source.elements().len();
        same_length("displacement of the history", displacement.len(), 2 * count)?;
        if let Some(error) = &self.failed {
            return Err(error.clone());
        }
        self.settle()?;
        for (value, row) in displacement.iter_mut().zip(self.rows.chunks_exact(self.stride)) {
            *value = row[self.steps];
        }
        Ok(())
    }

    fn push(&mut self, traction: &[f64]) {
        let settled = if self.failed.is_none() { self.settle() } else { Ok(()) };
        match settled {
            Ok(()) if self.failed.is_none() => {
                for (i, row) in self.rows.chunks_exact_mut(self.stride).enumerate() {
                    row[self.steps] = traction.get(i).copied().unwrap_or(0.0);
                }
                self.pending = true;
            }
            Ok(()) => {}
            Err(error) => self.failed = Some(error),
        }
        self.steps += 1;
    }

    /// All tractions, step by step: what they give to coming steps is worked out again.
    fn checkpoint(&self) -> Result<Vec<f64>> {
        if let Some(error) = &self.failed {
            return Err(error.clone());
        }
        let rows = || self.rows.chunks_exact(self.stride.max(1));
        Ok((0..self.steps).flat_map(|m| rows().map(move |row| row[m])).collect())
    }

    fn restore(&mut self, steps: usize, values: &[f64]) -> Result<()> {
        let size = 2 * self.kernel.elements().len();
        super::check_inputs(steps, size, values)?;
        self.grow(steps)?;
        self.rows.fill(0.0);
        (self.steps, self.pending, self.failed) = (0, false, None);
        values.chunks_exact(size).for_each(|traction| self.push(traction));
        Ok(())
    }
}
