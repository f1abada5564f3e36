//! Convolutions and coefficients by themselves.

use std::sync::Arc;
use std::time::Instant;

use basemat::bem::PatchKernel;
use basemat::history::{
    ConvolutionHistory, ConvolutionWeights, DirectHistory, ExponentialHistory, RelaxedFftHistory,
};
use basemat::{Result, unobserved};

use super::report::timed;
use basemat_problems::headline::{soil, strip, time_step};

fn patch(count: usize) -> Result<Arc<dyn ConvolutionWeights>> {
    Ok(Arc::new(PatchKernel::new(soil()?, strip(count)?.elements(), time_step())?))
}

/// Seconds of a march, and of its slowest step.
fn march(history: &mut dyn ConvolutionHistory, size: usize, steps: usize) -> Result<[f64; 2]> {
    let (mut displacement, mut traction) = (vec![0.0; size], vec![0.0; size]);
    let mut slowest = 0.0_f64;
    let (done, seconds) = timed(|| {
        for step in 0..steps {
            let begin = Instant::now();
            history.evaluate(&mut displacement)?;
            crate::history::traction(step, &mut traction);
            history.push(&traction);
            slowest = slowest.max(begin.elapsed().as_secs_f64());
        }
        Ok(())
    });
    done.map(|()| [seconds, slowest])
}

/// Seconds of the direct sum over `steps` steps.
pub(crate) fn direct(count: usize, steps: usize) -> Result<f64> {
    let mut direct = DirectHistory::new(patch(count)?);
    direct.prepare(steps, &mut unobserved)?;
    let [seconds, _] = march(&mut direct, 2 * count, steps)?;
    Ok(seconds)
}

/// Transforms of all past steps.
pub(crate) fn relaxed(
    kernel: Arc<dyn ConvolutionWeights>,
    steps: usize,
) -> Result<Box<dyn ConvolutionHistory>> {
    let mut history = RelaxedFftHistory::new(kernel);
    history.prepare(steps, &mut unobserved)?;
    Ok(Box::new(history))
}

/// A window and exponentials with an error at rounding.
pub(crate) fn bounded(
    kernel: Arc<dyn ConvolutionWeights>,
    _steps: usize,
) -> Result<Box<dyn ConvolutionHistory>> {
    Ok(Box::new(ExponentialHistory::new(kernel, 1e-12)?))
}

/// Makes a history for so many steps.
pub(crate) type Make =
    fn(Arc<dyn ConvolutionWeights>, usize) -> Result<Box<dyn ConvolutionHistory>>;

/// Setup, march and slowest step of a history, s: the least of `repeats`.
pub(crate) fn alone(make: Make, count: usize, steps: usize, repeats: usize) -> Result<[f64; 3]> {
    let mut least = [f64::INFINITY; 3];
    for _ in 0..repeats {
        // Of one kernel, only the first would make spectra.
        let kernel = patch(count)?;
        let (history, setup) = timed(|| make(kernel, steps));
        let [total, slowest] = march(&mut *history?, 2 * count, steps)?;
        for (least, found) in least.iter_mut().zip([setup, total, slowest]) {
            *least = least.min(found);
        }
    }
    Ok(least)
}

/// Seconds for all coefficients of a patch over `lags`.
pub(crate) fn coefficients(count: usize, lags: usize) -> Result<f64> {
    let kernel = patch(count)?;
    let mut values = [(); 3].map(|()| vec![0.0; lags]);
    let [normal, tangential, coupling] = &mut values;
    let (done, seconds) = timed(|| {
        (0..kernel.classes().count()).try_for_each(|class| {
            kernel.coefficients(class, 1, &mut [normal, tangential, coupling])
        })
    });
    done.map(|()| seconds)
}

/// Time per step over the number of steps, and the exponent of growth of the whole: the slope of
/// the least squares in logarithms.
pub(crate) struct Growth {
    /// Steps, seconds of all, slowest step.
    pub(crate) points: Vec<(usize, f64, f64)>,
    pub(crate) exponent: f64,
}

/// The growth of a history's marching time from 10³ steps to `longest`.
pub(crate) fn growth(make: Make, longest: usize) -> Result<Growth> {
    let mut points = Vec::new();
    for steps in [1_000, 3_000, 10_000, 30_000, 100_000, 300_000, 1_000_000] {
        if steps <= longest {
            let [_, total, slowest] = alone(make, 10, steps, (300_000 / steps).clamp(3, 100))?;
            points.push((steps, total, slowest));
        }
    }
    let exponent = exponent(&points);
    Ok(Growth { points, exponent })
}

/// Slope of the least squares in logarithms of seconds over steps.
pub(crate) fn exponent(points: &[(usize, f64, f64)]) -> f64 {
    let logarithms: Vec<_> =
        points.iter().map(|&(steps, total, _)| [(steps as f64).ln(), total.ln()]).collect();
    let count = logarithms.len() as f64;
    let mean = |k: usize| logarithms.iter().map(|p| p[k]).sum::<f64>() / count;
    let (x, y) = (mean(0), mean(1));
    logarithms.iter().map(|p| (p[0] - x) * (p[1] - y)).sum::<f64>()
        / logarithms.iter().map(|p| (p[0] - x).powi(2)).sum::<f64>()
}
