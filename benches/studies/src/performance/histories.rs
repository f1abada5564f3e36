//! Times of convolutions and of their weights.

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

/// Times of a history, s.
pub(crate) struct HistoryCost {
    pub(crate) setup: f64,
    pub(crate) march: f64,
    pub(crate) slowest_step: f64,
}

/// Marches a prepared history.
fn march(history: &mut dyn ConvolutionHistory, size: usize, steps: usize) -> Result<HistoryCost> {
    let mut displacement = vec![0.0; size];
    let mut traction = vec![0.0; size];
    let mut slowest_step = 0.0_f64;
    let timed_march = timed(|| {
        for step in 0..steps {
            let start_time = Instant::now();
            history.evaluate(&mut displacement)?;
            crate::history::traction(step, &mut traction);
            history.push(&traction);
            slowest_step = slowest_step.max(start_time.elapsed().as_secs_f64());
        }
        Ok(())
    });
    let march = timed_march.seconds;
    timed_march.result.map(|()| HistoryCost { setup: 0.0, march, slowest_step })
}

/// Seconds of the direct sum over `steps` steps.
pub(crate) fn direct(count: usize, steps: usize) -> Result<f64> {
    let mut direct_history = DirectHistory::new(patch(count)?);
    direct_history.prepare(steps, &mut unobserved)?;
    Ok(march(&mut direct_history, 2 * count, steps)?.march)
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

/// Prepares a history for this number of steps.
pub(crate) type PrepareHistory =
    fn(Arc<dyn ConvolutionWeights>, usize) -> Result<Box<dyn ConvolutionHistory>>;

/// Smallest times of a history in `repeats` marches.
pub(crate) fn history_cost(
    prepare: PrepareHistory,
    count: usize,
    steps: usize,
    repeats: usize,
) -> Result<HistoryCost> {
    let infinite = f64::INFINITY;
    let mut best_cost = HistoryCost { setup: infinite, march: infinite, slowest_step: infinite };
    for _ in 0..repeats {
        // A new kernel each time, because a kernel stores its spectra.
        let kernel = patch(count)?;
        let history = timed(|| prepare(kernel, steps));
        let cost = march(&mut *history.result?, 2 * count, steps)?;
        best_cost.setup = best_cost.setup.min(history.seconds);
        best_cost.march = best_cost.march.min(cost.march);
        best_cost.slowest_step = best_cost.slowest_step.min(cost.slowest_step);
    }
    Ok(best_cost)
}

/// Seconds for all coefficients of a patch over `lags`.
pub(crate) fn coefficients(count: usize, lags: usize) -> Result<f64> {
    let kernel = patch(count)?;
    let mut normal = vec![0.0; lags];
    let mut tangential = vec![0.0; lags];
    let mut coupling = vec![0.0; lags];
    let evaluation = timed(|| {
        (0..kernel.classes().count()).try_for_each(|class| {
            kernel.coefficients(class, 1, &mut [&mut normal, &mut tangential, &mut coupling])
        })
    });
    evaluation.result.map(|()| evaluation.seconds)
}

/// Times over the number of steps, and the exponent of their growth.
///
/// The exponent is the slope of least squares in logarithms.
pub(crate) struct Growth {
    pub(crate) points: Vec<GrowthPoint>,
    pub(crate) exponent: f64,
}

/// Times (s) of a march of `steps` steps.
pub(crate) struct GrowthPoint {
    pub(crate) steps: usize,
    pub(crate) march: f64,
    pub(crate) slowest_step: f64,
}

/// The growth of a history's marching time from 10³ steps to `longest`.
pub(crate) fn growth(prepare: PrepareHistory, max_steps: usize) -> Result<Growth> {
    let mut points = Vec::new();
    for steps in [1_000, 3_000, 10_000, 30_000, 100_000, 300_000, 1_000_000] {
        if steps <= max_steps {
            let repeats = (300_000 / steps).clamp(3, 100);
            let HistoryCost { march, slowest_step, .. } =
                history_cost(prepare, 10, steps, repeats)?;
            points.push(GrowthPoint { steps, march, slowest_step });
        }
    }
    let exponent = exponent(&points);
    Ok(Growth { points, exponent })
}

/// Slope of seconds over steps in logarithms, by least squares.
pub(crate) fn exponent(points: &[GrowthPoint]) -> f64 {
    let logarithms: Vec<_> =
        points.iter().map(|point| [(point.steps as f64).ln(), point.march.ln()]).collect();
    let count = logarithms.len() as f64;
    let x = logarithms.iter().map(|point| point[0]).sum::<f64>() / count;
    let y = logarithms.iter().map(|point| point[1]).sum::<f64>() / count;
    logarithms.iter().map(|point| (point[0] - x) * (point[1] - y)).sum::<f64>()
        / logarithms.iter().map(|point| (point[0] - x).powi(2)).sum::<f64>()
}
