//! Step coefficients of a layered ground by Runge–Kutta convolution quadrature.
//!
//! The mobility Y(s) = s F(s) is discretised with the traction held constant over all stages of a step
//! and the stage velocities averaged with the weights b,
//!
//! (1−z) Ĝ(z) = Δt bᵀ Y(Δ(z)/Δt) 1 = Σ wⱼ λⱼ F(λⱼ/Δt),   Ĝ(z) = Σ Gⁿ zⁿ⁻¹
//!
//! so that the work of the tractions, Σ τⁿ·(sⁿ − sⁿ⁻¹), is never negative if Herm Y ≥ 0 for Re s > 0
//! (Banjai & Lubich 2019): for every time step, mesh, profile and passive damping law. Coefficients come by fast
//! Fourier transform from a circle |z| = r of L points, rᴸ = ε: aliases are ε, and errors of F grow
//! by r⁻ⁿ (Lubich 1988).
//!
//! Lags N+1 … 2N always come from L = 4N, N a power of two: the bits of a lag depend on nothing else.

use std::sync::Mutex;

use realfft::RealFftPlanner;
use realfft::num_complex::Complex64;

use super::runge_kutta::{Stages, on_circle};
use super::wavenumber::{Wavenumbers, Workspace};
use crate::error::{Error, Result};
use crate::history::KINDS;
use crate::linalg::Complex;
use crate::soil::SoilProfile;

/// Lags of the first block.
pub(crate) const FIRST: usize = 128;
/// Blocks that there can be: lags up to 2³¹.
pub(crate) const BLOCKS: usize = 25;
/// Points of the circle per N of lags N+1 … 2N; 2N of the first block.
const POINTS_PER_LAG: usize = 4;

/// Coefficients of neighbouring lags, all classes.
#[derive(Debug)]
pub(crate) struct Block {
    /// Per class: zz, xx, zx, lag by lag.
    pub(crate) values: Vec<[Vec<f64>; KINDS]>,
}

impl Block {
    /// Number of the block that holds lag `lag` ≥ 1, and the lag's place in it.
    pub(crate) fn place(lag: usize) -> (usize, usize) {
        let index = lag - 1;
        if index < FIRST {
            return (0, index);
        }
        let block = (index / FIRST).ilog2() as usize + 1;
        (block, index - (FIRST << (block - 1)))
    }

    /// Number of lags in block `number`.
    pub(crate) fn lags(number: usize) -> usize {
        FIRST << number.saturating_sub(1)
    }

    /// The last lag in block `number`.
    pub(crate) fn last(number: usize) -> usize {
        FIRST << number
    }

    /// Coefficients of one class from `place` to the block's end.
    pub(crate) fn from(&self, class: usize, place: usize) -> [&[f64]; KINDS] {
        self.values[class].each_ref().map(|values| &values[place..])
    }
}

/// Circle |z| = r on which a block is transformed.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Circle {
    /// Points of all of it.
    length: usize,
    /// ln r.
    pub(crate) logarithm: f64,
}

impl Circle {
    /// That of block `number` for a relative accuracy of F.
    pub(crate) fn new(number: usize, tolerance: f64) -> Self {
        let length = POINTS_PER_LAG * Block::lags(number) / if number == 0 { 2 } else { 1 };
        // Aliases ε and noise tol·ε^(−1/2) at the last lag are then about equal.
        Self { length, logarithm: 2.0 / 3.0 * tolerance.ln() / length as f64 }
    }

    /// Points of the upper half, both ends included.
    pub(crate) fn points(self) -> usize {
        self.length / 2 + 1
    }

    /// Angle of a point, radians.
    pub(crate) fn angle(self, point: usize) -> f64 {
        std::f64::consts::TAU / self.length as f64 * point as f64
    }
}

/// All that coefficients depend on.
#[derive(Debug)]
pub(crate) struct Quadrature {
    pub(crate) profile: SoilProfile,
    pub(crate) integrals: Wavenumbers,
    pub(crate) classes: usize,
    pub(crate) stages: Stages,
    pub(crate) time_step: f64,
    /// Relative accuracy of F.
    pub(crate) tolerance: f64,
}

impl Quadrature {
    /// Σ wⱼ λⱼ F(λⱼ/Δt) = (1−z) Ĝ(z) for all classes (zz, xx, zx), at z given by ln |z| and its angle.
    pub(crate) fn mobility(
        &self,
        [logarithm, angle]: [f64; 2],
        work: &mut Workspace,
        scratch: &mut [[Complex; KINDS]],
        sums: &mut [[Complex; KINDS]],
    ) -> Result<()> {
        sums.fill([Complex::default(); KINDS]);
        let [z, rest] = on_circle(logarithm, angle);
        for node in self.stages.nodes(z, rest) {
            let s = node.lambda.scale(1.0 / self.time_step);
            self.integrals.compliance(&self.profile, s, work, scratch)?;
            for (sum, value) in sums.iter_mut().zip(scratch.iter()) {
                for (sum, value) in sum.iter_mut().zip(value) {
                    *sum += node.weight * *value;
                }
            }
        }
        Ok(())
    }

    /// The coefficients of block `number`, computed on `threads` threads.
    pub(crate) fn block(&self, number: usize, threads: usize) -> Result<Block> {
        let lags = Block::lags(number);
        let first = if number == 0 { 0 } else { lags };
        let circle = Circle::new(number, self.tolerance);
        let Circle { length, logarithm } = circle;
        let spectra = self.spectra(circle, threads)?;
        let transform = RealFftPlanner::<f64>::new().plan_fft_inverse(length);
        let mut input = transform.make_input_vec();
        let (mut output, mut scratch) = (transform.make_output_vec(), transform.make_scratch_vec());
        let mut values = Vec::with_capacity(self.classes);
        for class in 0..self.classes {
            let mut components = [const { Vec::new() }; KINDS];
            for (component, list) in components.iter_mut().enumerate() {
                for (point, input) in input.iter_mut().enumerate() {
                    let value = spectra[point * self.classes + class][component];
                    // The transform has the other sign, and the ends of the circle are real.
                    let ends = point == 0 || 2 * point == length;
                    *input = Complex64::new(value.re, if ends { 0.0 } else { -value.im });
                }
                transform.process_with_scratch(&mut input, &mut output, &mut scratch).map_err(
                    |_| Error::Singular { matrix: "spectrum of step coefficients", order: length },
                )?;
                let scaled = |(n, value): (usize, &f64)| {
                    value * (-logarithm * (first + n) as f64).exp() / length as f64
                };
                list.extend(output[first..first + lags].iter().enumerate().map(scaled));
            }
            values.push(components);
        }
        Ok(Block { values })
    }

    /// Ĝ on the upper half of a circle, point by point and class by class.
    fn spectra(&self, circle: Circle, threads: usize) -> Result<Vec<[Complex; KINDS]>> {
        let (count, logarithm) = (circle.points(), circle.logarithm);
        let mut spectra: Vec<[Complex; KINDS]> = vec![];
        spectra.try_reserve_exact(count * self.classes).map_err(|_| Error::Input {
            quantity: "number of lags of a layered ground",
            value: count as f64,
            needed: "few enough for the memory of the machine",
        })?;
        spectra.resize(count * self.classes, [Complex::default(); KINDS]);
        let queue = Mutex::new(spectra.chunks_mut(self.classes).enumerate());
        let work = || {
            let mut work = Workspace::default();
            let mut scratch = vec![[Complex::default(); KINDS]; self.classes];
            loop {
                // A thread that panicked leaves a queue that is still good.
                let next = queue.lock().unwrap_or_else(std::sync::PoisonError::into_inner).next();
                let Some((point, sums)) = next else { return Ok(()) };
                let angle = circle.angle(point);
                self.mobility([logarithm, angle], &mut work, &mut scratch, sums)
                    .map_err(|error| (point, error))?;
                let over = on_circle(logarithm, angle)[1].inverse();
                for value in sums.iter_mut().flatten() {
                    *value = *value * over;
                }
            }
        };
        // Threads of their own and not a pool: a pool's worker that waits takes up other work, which
        // may wait for these very coefficients.
        let mut failed: Vec<(usize, Error)> = std::thread::scope(|scope| {
            let others: Vec<_> = (1..threads).map(|_| scope.spawn(work)).collect();
            let own = work().err();
            let joined = others.into_iter().map(|thread| match thread.join() {
                Ok(outcome) => outcome.err(),
                // A law of the user's may panic: not in silence.
                Err(panic) => std::panic::resume_unwind(panic),
            });
            let others = joined.collect::<Vec<_>>().into_iter().flatten();
            own.into_iter().chain(others).collect()
        });
        failed.sort_by_key(|(point, _)| *point);
        failed.into_iter().next().map_or(Ok(()), |(_, error)| Err(error))?;
        Ok(spectra)
    }
}
