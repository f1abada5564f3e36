//! Convolution histories by themselves: time, accuracy and memory over the number of steps, and of the history by
//! exponentials over its tolerance.
//!
//! ```text
//! cargo study history-cost
//! cargo study history-exponentials
//! ```

use std::sync::Arc;
use std::time::Instant;

use basemat::bem::{PatchKernel, Strip};
use basemat::history::{
    ConvolutionHistory, ConvolutionWeights, DirectHistory, ExponentialHistory, RelaxedFftHistory,
};
use basemat::{Result, Soil, unobserved};

use crate::AnyError;

/// Time, accuracy and memory of the convolution histories over the number of steps.
#[derive(Debug, clap::Args)]
pub(crate) struct CostOptions {
    /// Elements of the strip.
    #[arg(default_value_t = 10)]
    elements: usize,
    /// Largest number of steps.
    #[arg(default_value_t = 1_000_000)]
    longest: usize,
}

/// Accuracy, passivity, time and memory of the history by exponentials over its tolerance.
#[derive(Debug, clap::Args)]
pub(crate) struct ExponentialsOptions {
    /// Elements of the strip.
    #[arg(default_value_t = 10)]
    elements: usize,
    /// Steps that are timed.
    #[arg(default_value_t = 100_000)]
    steps: usize,
    /// Steps that are compared with the direct sum.
    #[arg(default_value_t = 1_000)]
    compared: usize,
}

/// Largest number of steps of the direct sum.
const LONGEST_DIRECT: usize = 10_000;

/// 1.5 ft elements, steps of half an element over the pressure wave speed.
fn patch(count: usize) -> Result<Arc<dyn ConvolutionWeights>> {
    let soil = Soil::from_wave_speeds(198.12, 396.24, 1803.8)?;
    let half_width = 0.2286 * count as f64;
    let elements = Strip::uniform(-half_width..half_width, count)?.elements();
    Ok(Arc::new(PatchKernel::new(soil, elements, 0.2286 / 396.24)?))
}

/// Tractions of a step, with a long period.
pub(crate) fn traction(step: usize, traction: &mut [f64]) {
    for (i, value) in traction.iter_mut().enumerate() {
        *value = ((step * 7919 + i * 104_729) % 1009) as f64;
    }
}

/// Wall times of a march, s.
struct MarchTime {
    total: f64,
    slowest_step: f64,
}

/// Marches a history; `observe` receives the displacements of every step.
fn march(
    history: &mut dyn ConvolutionHistory,
    size: usize,
    steps: usize,
    mut observe: impl FnMut(&[f64]),
) -> Result<MarchTime> {
    let mut displacement = vec![0.0; size];
    let mut input = vec![0.0; size];
    let start_time = Instant::now();
    let mut slowest_step = 0.0_f64;
    for step in 0..steps {
        let start_time = Instant::now();
        history.evaluate(&mut displacement)?;
        traction(step, &mut input);
        history.push(&input);
        slowest_step = slowest_step.max(start_time.elapsed().as_secs_f64());
        observe(&displacement);
    }
    Ok(MarchTime { total: start_time.elapsed().as_secs_f64(), slowest_step })
}

/// Largest difference from the displacements of the direct sum, relative to the largest of these, and the time of the sum.
struct DirectComparison {
    error: f64,
    seconds: f64,
}

fn compare_with_direct_sum(
    kernel: Arc<dyn ConvolutionWeights>,
    size: usize,
    computed: &[f64],
) -> Result<DirectComparison> {
    let steps = computed.len() / size;
    let mut direct_history = DirectHistory::new(kernel);
    direct_history.prepare(steps, &mut unobserved)?;
    let mut difference = 0.0_f64;
    let mut max_magnitude = 0.0_f64;
    let mut computed_steps = computed.chunks_exact(size);
    let time = march(&mut direct_history, size, steps, |reference| {
        for (a, b) in computed_steps.next().unwrap_or_default().iter().zip(reference) {
            difference = difference.max((a - b).abs());
            max_magnitude = max_magnitude.max(b.abs());
        }
    })?;
    Ok(DirectComparison { error: difference / max_magnitude, seconds: time.total })
}

/// The table over the number of steps.
pub(crate) fn cost(options: &CostOptions) -> std::result::Result<(), AnyError> {
    let CostOptions { elements, longest } = *options;
    let kernel = patch(elements)?;
    let size = 2 * elements;
    println!("{elements} elements");
    println!("    steps   setup s   march s  µs/step  slowest ms      MB  direct s   ratio  error");
    let step_counts = [100, 300, 1_000, 3_000, 10_000, 30_000, 54_000, 100_000, 300_000, 1_000_000];
    for steps in step_counts.into_iter().take_while(|steps| *steps <= longest) {
        let start_time = Instant::now();
        let mut relaxed_history = RelaxedFftHistory::new(Arc::clone(&kernel));
        relaxed_history.prepare(steps, &mut unobserved)?;
        let setup = start_time.elapsed().as_secs_f64();
        let is_compared = steps <= LONGEST_DIRECT;
        let mut computed = Vec::with_capacity(if is_compared { steps * size } else { 0 });
        let time = march(&mut relaxed_history, size, steps, |displacement| {
            if is_compared {
                computed.extend_from_slice(displacement);
            }
        })?;
        print!(
            "{steps:9} {setup:9.4} {:9.4} {:8.2} {:11.3} {:7.1}",
            time.total,
            1e6 * time.total / steps as f64,
            1e3 * time.slowest_step,
            relaxed_history.memory() as f64 / 1e6,
        );
        if is_compared {
            let direct_comparison = compare_with_direct_sum(Arc::clone(&kernel), size, &computed)?;
            let ratio = direct_comparison.seconds / time.total;
            print!(
                " {:9.4} {ratio:7.1} {:.1e}",
                direct_comparison.seconds, direct_comparison.error
            );
        }
        println!();
    }
    Ok(())
}

/// The table over the tolerance.
pub(crate) fn exponentials(options: &ExponentialsOptions) -> std::result::Result<(), AnyError> {
    let ExponentialsOptions { elements, steps, compared } = *options;
    let kernel = patch(elements)?;
    let size = 2 * elements;
    println!("{elements} elements, {steps} steps");
    println!(
        "tolerance      error  window  poles functions  passivity  setup s   µs/step       kB error, march"
    );
    for exponent in 3..=12 {
        let start_time = Instant::now();
        let tolerance = 10.0_f64.powi(-exponent);
        let mut history = match ExponentialHistory::new(Arc::clone(&kernel), tolerance) {
            Ok(history) => history,
            Err(error) => {
                println!("{tolerance:>9.0e} {error}");
                continue;
            }
        };
        let setup = start_time.elapsed().as_secs_f64();
        let mut computed = Vec::with_capacity(compared * size);
        march(&mut history, size, compared, |displacement| {
            computed.extend_from_slice(displacement);
        })?;
        let error = compare_with_direct_sum(Arc::clone(&kernel), size, &computed)?.error;
        let time = march(&mut history, size, steps, |_| ())?;
        println!(
            "{tolerance:>9.0e} {:>10.1e} {:>7} {:>6} {:>9} {:>10.4} {setup:>8.3} {:>9.2} {:>8.0} {error:>12.1e}",
            history.fit().error_bound,
            history.fit().window,
            history.fit().poles,
            history.fit().functions,
            history.fit().passivity_margin,
            1e6 * time.total / steps as f64,
            history.memory() as f64 / 1e3,
        );
    }
    Ok(())
}
