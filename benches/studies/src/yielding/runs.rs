//! Checks of runs: a soil column, energies of random scenes, and errors by the time step.

use basemat::Result;
use basemat_problems::yielding_blocks::{YieldingScene, random_scene};
use basemat_problems::yielding_column::{clay, response};
use basemat_problems::yielding_convergence::step_errors;

use super::check::{Check, Limit};
use super::run_counts::{RunCounts, larger};

const COLUMN_ROWS: usize = 40;
const COLUMN_TIME_STEP: f64 = 0.005;
const TOP_LIMIT: f64 = 0.01;
const STRESS_LIMIT: f64 = 0.03;
/// Rows of the column, and time steps (s), of remainders.
const REMAINDER_ROWS: usize = 10;
const REMAINDER_TIME_STEPS: [f64; 3] = [0.02, 0.01, 0.005];
/// Smallest ratio of remainders of one time step and of half of it; 4 for second order.
const REMAINDER_RATIO_LIMIT: f64 = 3.0;
const SCENE_COUNT: u64 = 500;
const SHORT_SCENE_COUNT: u64 = 60;
const BALANCE_LIMIT: f64 = 1e-9;
/// Largest decrease of a sum that never falls, relative to the largest energy.
const DECREASE_LIMIT: f64 = 1e-12;
/// Largest fraction of random scenes whose build may return an error.
const REFUSED_LIMIT: f64 = 0.05;
const SLOPE_LIMIT: f64 = 1.5;

pub(super) fn checks(is_short: bool) -> Result<Vec<Check>> {
    let mut checks = column_checks()?;
    checks.extend(scene_checks(if is_short { SHORT_SCENE_COUNT } else { SCENE_COUNT }));
    checks.push(slope_check()?);
    Ok(checks)
}

/// The column beside its table, and its remainders by the time step.
fn column_checks() -> Result<Vec<Check>> {
    let soil = clay().into();
    let column = response(COLUMN_ROWS, COLUMN_TIME_STEP, &soil)?;
    let [top, stress] = column.table_differences(COLUMN_TIME_STEP)?;
    let program = "40 two-node cells, Newmark, Δt 0.5 ms; both below 10 Hz";
    let name = "column of 20 m of clay, 40 `Quad8`, Δt 5 ms";
    let mut ratios = Vec::new();
    for time_step in REMAINDER_TIME_STEPS {
        let column = response(REMAINDER_ROWS, time_step, &soil)?;
        ratios.push(column.midstep_remainder / column.hysteresis);
    }
    let smallest_ratio =
        ratios.windows(2).map(|pair| pair[0] / pair[1]).fold(f64::INFINITY, f64::min);
    let remark =
        format!("{:.1e}, {:.1e}, {:.1e} at Δt 20, 10, 5 ms", ratios[0], ratios[1], ratios[2]);
    Ok(vec![
        Check::new(
            format!("{name}: displacement of the top"),
            program,
            top,
            Limit::AtMost(TOP_LIMIT),
        ),
        Check::new(
            format!("{name}: stress at the base"),
            program,
            stress,
            Limit::AtMost(STRESS_LIMIT),
        ),
        Check::new(
            format!("{name}: residual of the energy balance"),
            "zero",
            column.energy_error,
            Limit::AtMost(BALANCE_LIMIT),
        ),
        Check::new(
            "remainder over dissipation of this column, 10 elements: smallest ratio on halving Δt",
            "4: second order",
            smallest_ratio,
            Limit::AtLeast(REMAINDER_RATIO_LIMIT),
        )
        .with_remark(remark),
    ])
}

/// Counts and largest errors of random scenes.
#[derive(Debug, Default)]
struct RandomBlockCounts {
    runs: RunCounts,
    associated: usize,
    /// Largest decreases of dissipation and of the remainder (ψ = φ) in a step, relative to the largest energy.
    dissipation_decrease: f64,
    remainder_decrease: f64,
}

impl RandomBlockCounts {
    fn add(&mut self, scene: YieldingScene) {
        let YieldingScene { simulation, is_associated, text } = scene;
        if let Some(energies) = self.runs.energies(simulation, &text) {
            self.dissipation_decrease =
                larger(self.dissipation_decrease, -energies.min_dissipation);
            if is_associated {
                self.associated += 1;
                self.remainder_decrease = larger(self.remainder_decrease, -energies.min_remainder);
            }
        }
    }
}

/// Energies of random blocks that yield, lift off and slide.
fn scene_checks(scene_count: u64) -> Vec<Check> {
    let mut counts = RandomBlockCounts::default();
    for seed in 0..scene_count {
        counts.add(random_scene(seed));
    }
    let RunCounts { refused, failed, yielded, changed, residual } = counts.runs;
    let associated = counts.associated;
    let name = format!("{scene_count} random blocks that yield, lift off and slide");
    vec![
        Check::new(
            format!("{name}: residual of the energy balance"),
            "remainder from its formula",
            residual,
            Limit::AtMost(BALANCE_LIMIT),
        )
        .with_remark(format!("{yielded} yield")),
        Check::new(
            format!("{name}: decrease of the dissipation in a step"),
            "never",
            counts.dissipation_decrease,
            Limit::AtMost(DECREASE_LIMIT),
        ),
        Check::new(
            format!("{name}: decrease of the remainder in a step, Iwan or ψ = φ"),
            "never",
            counts.remainder_decrease,
            Limit::AtMost(DECREASE_LIMIT),
        )
        .with_remark(format!("{associated} blocks")),
        Check::new(
            format!("{name}: runs that fail, or differ after resuming"),
            "none",
            (failed + changed) as f64,
            Limit::AtMost(0.0),
        ),
        Check::new(
            format!("{name}: part that is refused at build"),
            "weight within the strength, static search converges",
            refused as f64 / scene_count as f64,
            Limit::AtMost(REFUSED_LIMIT),
        )
        .with_remark(format!("{refused} blocks")),
    ]
}

/// Errors of a chain of yielding springs by the time step.
fn slope_check() -> Result<Check> {
    let result = step_errors()?;
    let errors: Vec<String> = result.errors.iter().map(|error| format!("{error:.1e}")).collect();
    let check = Check::new(
        "halving Δt four times from 5 ms, chain of yielding springs: slope of the fit",
        "run with Δt 0.04 ms",
        result.slope,
        Limit::AtLeast(SLOPE_LIMIT),
    );
    Ok(check.with_remark(format!("errors {} m", errors.join(", "))))
}
