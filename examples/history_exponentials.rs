//! Accuracy, passivity, time and memory of the history by exponentials.
//!
//! `cargo run --release --example history_exponentials -- [elements] [steps] [steps compared]`

use std::error::Error;
use std::sync::Arc;
use std::time::Instant;

use basemat::Soil;
use basemat::bem::{PatchKernel, Strip};
use basemat::history::{ConvolutionHistory, DirectHistory, ExponentialHistory, LagKernel};

fn traction(step: usize, traction: &mut [f64]) {
    for (i, value) in traction.iter_mut().enumerate() {
        *value = f64::from(u16::try_from((step * 7919 + i * 104_729) % 1009).unwrap_or(0));
    }
}

fn main() -> Result<(), Box<dyn Error>> {
    let mut arguments = std::env::args().skip(1);
    let mut argument = |default: usize| arguments.next().map_or(Ok(default), |text| text.parse());
    let (count, steps, compared) = (argument(10)?, argument(100_000)?, argument(1_000)?);
    // 1.5 ft elements, steps of half an element over the pressure wave speed.
    let soil = Soil::new(1803.8 * 198.12_f64.powi(2), 1.0 / 3.0, 1803.8)?;
    let half = 0.2286 * count as f64;
    let elements = Strip::uniform(-half..half, count)?.elements();
    let kernel: Arc<dyn LagKernel> = Arc::new(PatchKernel::new(soil, elements, 0.2286 / 396.24)?);
    println!("{count} elements, {steps} steps");
    println!(
        "{:>9} {:>10} {:>7} {:>6} {:>9} {:>10} {:>8} {:>9} {:>8} {:>12}",
        "tolerance",
        "error",
        "window",
        "poles",
        "functions",
        "passivity",
        "setup s",
        "µs/step",
        "kB",
        "error, march"
    );
    for exponent in [-3, -4, -5, -6, -7, -8, -9, -10, -11, -12] {
        let begin = Instant::now();
        let tolerance = 10.0_f64.powi(exponent);
        let mut history = match ExponentialHistory::new(Arc::clone(&kernel), tolerance) {
            Ok(history) => history,
            Err(error) => {
                println!("{tolerance:>9.0e} {error}");
                continue;
            }
        };
        let setup = begin.elapsed().as_secs_f64();
        let mut direct = DirectHistory::new(Arc::clone(&kernel));
        let size = 2 * count;
        let [mut found, mut wanted, mut input] = [(); 3].map(|()| vec![0.0; size]);
        let (mut error, mut largest) = (0.0_f64, 0.0_f64);
        for step in 0..compared {
            history.evaluate(&mut found)?;
            direct.evaluate(&mut wanted)?;
            for (a, b) in found.iter().zip(&wanted) {
                error = error.max((a - b).abs());
                largest = largest.max(b.abs());
            }
            traction(step, &mut input);
            history.push(&input);
            direct.push(&input);
        }
        let begin = Instant::now();
        for step in 0..steps {
            history.evaluate(&mut found)?;
            traction(step, &mut input);
            history.push(&input);
        }
        println!(
            "{tolerance:>9.0e} {:>10.1e} {:>7} {:>6} {:>9} {:>10.4} {setup:>8.3} {:>9.2} {:>8.0} \
             {:>12.1e}",
            history.error_bound(),
            history.window(),
            history.poles(),
            history.functions(),
            history.passivity_margin(),
            1e6 * begin.elapsed().as_secs_f64() / steps as f64,
            history.memory() as f64 / 1e3,
            error / largest,
        );
    }
    Ok(())
}
