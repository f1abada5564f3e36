//! Checks of frames of fibres: energies of random ones.

use basemat_problems::fiber_frames::{FrameLaw, RandomFrame, random_frame};
use basemat_problems::yielding_blocks::block_energies;

use super::check::{Check, Limit};

const FRAME_COUNT: u64 = 100;
const SHORT_FRAME_COUNT: u64 = 10;
const BALANCE_LIMIT: f64 = 1e-9;
/// Largest decrease of the dissipation of bilinear steel, relative to the largest energy.
const DECREASE_LIMIT: f64 = 1e-12;
/// The same of other laws, whose stored energy is that of a straight unloading line.
const CURVED_DECREASE_LIMIT: f64 = 1e-2;

/// Counts and largest errors of random frames.
#[derive(Debug, Default)]
struct RandomFrameCounts {
    refused: usize,
    failed: usize,
    yielded: usize,
    /// Runs whose second half is not the same after resuming.
    changed: usize,
    residual: f64,
    /// Largest decreases of the dissipation in a step, of bilinear steel and of other laws.
    decrease: f64,
    curved_decrease: f64,
}

impl RandomFrameCounts {
    fn add(&mut self, frame: RandomFrame) {
        let RandomFrame { simulation, law, text } = frame;
        let mut simulation = match simulation {
            Ok(simulation) => simulation,
            Err(error) => {
                println!("refused: {text}: {error}");
                self.refused += 1;
                return;
            }
        };
        match block_energies(&mut simulation) {
            Ok(energies) => {
                self.residual = larger(self.residual, energies.residual);
                let decrease = if law == FrameLaw::Bilinear {
                    &mut self.decrease
                } else {
                    &mut self.curved_decrease
                };
                *decrease = larger(*decrease, -energies.min_dissipation);
                self.yielded += usize::from(energies.yields);
                self.changed += usize::from(!energies.resumes);
            }
            Err(error) => {
                println!("failed: {text}: {error}");
                self.failed += 1;
            }
        }
    }
}

/// The larger of two numbers, or NaN if the second one is NaN.
fn larger(one: f64, other: f64) -> f64 {
    if other.is_nan() || other > one { other } else { one }
}

/// Energies of random frames that yield, lift off and slide.
pub(super) fn checks(is_short: bool) -> Vec<Check> {
    let frame_count = if is_short { SHORT_FRAME_COUNT } else { FRAME_COUNT };
    let mut counts = RandomFrameCounts::default();
    for seed in 0..frame_count {
        counts.add(random_frame(seed));
    }
    let RandomFrameCounts { refused, failed, yielded, changed, .. } = counts;
    let name = format!("{frame_count} random frames of fibres that yield, lift off and slide");
    vec![
        Check::new(
            format!("{name}: residual of the energy balance"),
            "remainder by fibres, or of the whole element",
            counts.residual,
            Limit::AtMost(BALANCE_LIMIT),
        )
        .with_remark(format!("{yielded} yield")),
        Check::new(
            format!("{name}: decrease of the dissipation in a step, bilinear steel"),
            "never",
            counts.decrease,
            Limit::AtMost(DECREASE_LIMIT),
        ),
        Check::new(
            format!("{name}: the same, Menegotto–Pinto and concrete"),
            "stored energy of a straight unloading line",
            counts.curved_decrease,
            Limit::AtMost(CURVED_DECREASE_LIMIT),
        ),
        Check::new(
            format!("{name}: runs that differ after resuming"),
            "none",
            changed as f64,
            Limit::AtMost(0.0),
        )
        .with_remark(format!("{refused} refused at build, {failed} end with a typed error")),
    ]
}
