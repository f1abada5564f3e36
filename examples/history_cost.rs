//! Time, accuracy and memory of the convolution histories over the number of steps.
//!
//! `cargo run --release --example history_cost -- [elements] [largest number of steps]`

use std::error::Error;
use std::sync::Arc;
use std::time::Instant;

use basemat::Soil;
use basemat::bem::{PatchKernel, Strip};
use basemat::history::{ConvolutionHistory, DirectHistory, LagKernel, RelaxedFftHistory};

/// The direct sum is not marched further than this.
const LONGEST_DIRECT: usize = 10_000;

/// Seconds of a whole march and of its slowest step.
fn march(
    history: &mut dyn ConvolutionHistory,
    size: usize,
    steps: usize,
) -> Result<([f64; 2], Vec<f64>), basemat::Error> {
    let (mut displacement, mut traction) = (vec![0.0; size], vec![0.0; size]);
    let mut kept = Vec::new();
    let (begin, mut slowest) = (Instant::now(), 0.0_f64);
    for step in 0..steps {
        let begin = Instant::now();
        history.evaluate(&mut displacement)?;
        for (i, value) in traction.iter_mut().enumerate() {
            *value = f64::from(u16::try_from((step * 7919 + i * 104_729) % 1009).unwrap_or(0));
        }
        history.push(&traction);
        slowest = slowest.max(begin.elapsed().as_secs_f64());
        if steps <= LONGEST_DIRECT {
            kept.extend_from_slice(&displacement);
        }
    }
    Ok(([begin.elapsed().as_secs_f64(), slowest], kept))
}

fn main() -> Result<(), Box<dyn Error>> {
    let mut arguments = std::env::args().skip(1);
    let mut argument = |default: usize| arguments.next().map_or(Ok(default), |text| text.parse());
    let (count, longest) = (argument(10)?, argument(1_000_000)?);
    // 1.5 ft elements, steps of half an element over the pressure wave speed.
    let soil = Soil::new(70.8e6, 1.0 / 3.0, 1804.0)?;
    let half = 0.2286 * count as f64;
    let elements = Strip::uniform(-half..half, count)?.elements();
    let kernel: Arc<dyn LagKernel> = Arc::new(PatchKernel::new(soil, elements, 0.577e-3)?);
    println!("{count} elements");
    println!("    steps   setup s   march s  µs/step  slowest ms      MB  direct s   ratio  error");
    for steps in [100, 300, 1_000, 3_000, 10_000, 30_000, 54_000, 100_000, 300_000, 1_000_000] {
        if steps > longest {
            break;
        }
        let begin = Instant::now();
        let mut relaxed = RelaxedFftHistory::new(Arc::clone(&kernel));
        relaxed.reserve(steps)?;
        let setup = begin.elapsed().as_secs_f64();
        let ([total, slowest], found) = march(&mut relaxed, 2 * count, steps)?;
        print!(
            "{steps:9} {setup:9.4} {total:9.4} {:8.2} {:11.3} {:7.1}",
            1e6 * total / steps as f64,
            1e3 * slowest,
            relaxed.memory() as f64 / 1e6,
        );
        if steps <= LONGEST_DIRECT {
            let mut direct = DirectHistory::new(Arc::clone(&kernel));
            direct.reserve(steps)?;
            let ([other, _], wanted) = march(&mut direct, 2 * count, steps)?;
            let largest = wanted.iter().fold(0.0_f64, |m, x| m.max(x.abs()));
            let error = wanted.iter().zip(&found).fold(0.0_f64, |m, (a, b)| m.max((a - b).abs()));
            print!(" {other:9.4} {:7.1} {:.1e}", other / total, error / largest);
        }
        println!();
    }
    Ok(())
}
