//! Checks of frames of fibres: energies of random ones.

use basemat_problems::fiber_frames::{FrameLaw, RandomFrame, random_frame};

use super::check::{Check, Limit};
use super::run_counts::{RunCounts, larger};

const FRAME_COUNT: u64 = 100;
const SHORT_FRAME_COUNT: u64 = 10;
const BALANCE_LIMIT: f64 = 1e-9;
/// Largest decrease of the dissipation of bilinear steel, relative to the largest energy.
const DECREASE_LIMIT: f64 = 1e-12;
/// Largest decrease of the dissipation of other laws, whose stored energy assumes a straight unloading line.
const CURVED_DECREASE_LIMIT: f64 = 1e-2;

/// Counts and largest errors of random frames.
#[derive(Debug, Default)]
struct RandomFrameCounts {
    runs: RunCounts,
    /// Largest decreases of the dissipation in a step, of bilinear steel and of other laws.
    decrease: f64,
    curved_decrease: f64,
}

impl RandomFrameCounts {
    fn add(&mut self, frame: RandomFrame) {
        let RandomFrame { simulation, law, text } = frame;
        if let Some(energies) = self.runs.energies(simulation, &text) {
            let decrease = if law == FrameLaw::Bilinear {
                &mut self.decrease
            } else {
                &mut self.curved_decrease
            };
            *decrease = larger(*decrease, -energies.min_dissipation);
        }
    }
}

/// Energies of random frames that yield, lift off and slide.
pub(super) fn checks(is_short: bool) -> Vec<Check> {
    let frame_count = if is_short { SHORT_FRAME_COUNT } else { FRAME_COUNT };
    let mut counts = RandomFrameCounts::default();
    for seed in 0..frame_count {
        counts.add(random_frame(seed));
    }
    let RunCounts { refused, failed, yielded, changed, residual } = counts.runs;
    let name = format!("{frame_count} random frames of fibres that yield, lift off and slide");
    vec![
        Check::new(
            format!("{name}: residual of the energy balance"),
            "remainder by fibres, or of the whole element",
            residual,
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
