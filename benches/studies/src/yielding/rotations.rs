//! Strip without tension on clay that yields: moment capacity, and slow cycles of rotation.

use std::fmt::Write;

use basemat::Result;
use basemat_problems::strip_rotation::{
    HALF_WIDTH, REFERENCE_MOMENTS, REFERENCE_STEPS, ROTATION_STEP, RotatedStrip, StripState,
};
use plotters::prelude::SeriesLabelPosition;

use super::check::{Check, Limit};
use crate::figure::{CURVE_BLUE, CURVE_GREEN, CURVE_RED, Figure, FigurePanel};

/// Largest relative difference from a moment of the reference, from 0.02 rad on.
const MAX_MOMENT_DIFFERENCE: f64 = 0.05;
/// Moments at 0.06 rad over the capacity of the effective width on the finer mesh.
const CAPACITY_RATIO_LIMITS: [f64; 2] = [0.92, 1.03];
/// Safety factors of slow cycles.
const CYCLE_SAFETY_FACTORS: [f64; 5] = [1.5, 2.0, 3.0, 5.0, 10.0];
/// Elements under half of the strip in slow cycles.
const CYCLE_HALF_ELEMENTS: usize = 4;
/// Amplitude of slow cycles, rad.
const CYCLE_AMPLITUDE: f64 = 0.02;
const CYCLE_COUNT: usize = 4;
/// Steps of a quarter of a cycle.
const QUARTER_STEPS: usize = 20;
/// Smallest moment of the last cycle over that of the first one, at the largest rotation.
const MIN_MOMENT_RATIO: f64 = 0.98;

/// Checks of moments, of slow cycles, and the picture of these cycles.
pub(super) fn checks(is_short: bool) -> Result<(Vec<Check>, Figure)> {
    let mut checks = Vec::new();
    for half_elements in if is_short { vec![4] } else { vec![4, 8] } {
        checks.extend(moment_checks(half_elements)?);
    }
    let mut cycles = Vec::new();
    for safety_factor in CYCLE_SAFETY_FACTORS {
        let strip = RotatedStrip { half_elements: CYCLE_HALF_ELEMENTS, safety_factor };
        cycles.push(SlowCycles { strip, states: strip.turn(&rotations())? });
    }
    println!("{}", table(&cycles));
    checks.extend(cycle_checks(&cycles));
    Ok((checks, picture(&cycles)))
}

/// Checks of the moments of the reference strips on a mesh with this number of elements under half of the strip.
fn moment_checks(half_elements: usize) -> Result<Vec<Check>> {
    let mut largest_difference = 0.0_f64;
    let mut last_moments = Vec::new();
    for (strip, expected) in REFERENCE_MOMENTS {
        if strip.half_elements != half_elements {
            continue;
        }
        let moments = strip.relative_moments()?;
        for ((steps, moment), reference) in REFERENCE_STEPS.iter().zip(moments).zip(expected) {
            let rotation = *steps as f64 * ROTATION_STEP;
            let difference = moment / reference - 1.0;
            println!(
                "strip, {half_elements} elements, F = {}, {rotation} rad: {moment:.3}, reference {reference}, {difference:.3}",
                strip.safety_factor
            );
            if *steps > REFERENCE_STEPS[0] {
                largest_difference = largest_difference.max(difference.abs());
            }
        }
        last_moments.push(moments[3]);
    }
    let name =
        format!("rotated strip without tension on clay, {half_elements} elements under its half");
    let texts: Vec<String> = last_moments.iter().map(|moment| format!("{moment:.3}")).collect();
    let remark =
        format!("{} of the capacity of the effective width at F = 2, 3, 5", texts.join(", "));
    let reference =
        "an independent program, same mesh, contact at nodes: moments at 0.02, 0.04, 0.06 rad";
    let mut checks = vec![
        Check::new(&name, reference, largest_difference, Limit::AtMost(MAX_MOMENT_DIFFERENCE))
            .with_remark(remark),
    ];
    if half_elements > CYCLE_HALF_ELEMENTS {
        let reference = "(N B/2)(1 − N/N_u) at 0.06 rad";
        let min_moment = last_moments.iter().copied().fold(f64::INFINITY, f64::min);
        let max_moment = last_moments.iter().copied().fold(0.0, f64::max);
        let lower_limit = Limit::AtLeast(CAPACITY_RATIO_LIMITS[0]);
        let upper_limit = Limit::AtMost(CAPACITY_RATIO_LIMITS[1]);
        checks.push(Check::new(format!("{name}: smallest"), reference, min_moment, lower_limit));
        checks.push(Check::new(format!("{name}: largest"), reference, max_moment, upper_limit));
    }
    Ok(checks)
}

/// Rotations of slow cycles, linear between the amplitudes, rad.
fn rotations() -> Vec<f64> {
    let steps = 1..=4 * QUARTER_STEPS * CYCLE_COUNT;
    steps
        .map(|step| {
            let quarters = (step % (4 * QUARTER_STEPS)) as f64 / QUARTER_STEPS as f64;
            let fraction = if quarters <= 1.0 {
                quarters
            } else if quarters <= 3.0 {
                2.0 - quarters
            } else {
                quarters - 4.0
            };
            CYCLE_AMPLITUDE * fraction
        })
        .collect()
}

/// A strip, and its states in slow cycles.
struct SlowCycles {
    strip: RotatedStrip,
    states: Vec<StripState>,
}

impl SlowCycles {
    /// State after this number of quarters of a cycle.
    fn state_after(&self, quarters: usize) -> StripState {
        self.states[quarters * QUARTER_STEPS - 1]
    }

    /// Mean magnitude of the moments at both largest rotations of a cycle, over the capacity of the effective width.
    fn peak_moment(&self, cycle: usize) -> f64 {
        let moments = [1, 3].map(|quarter| self.state_after(4 * cycle + quarter).moment.abs());
        0.5 * (moments[0] + moments[1]) / self.strip.moment_capacity()
    }

    /// Settlement of a cycle over the width of the strip.
    fn settlement(&self, cycle: usize) -> f64 {
        let end = self.state_after(4 * cycle + 4).settlement;
        // The settlement of the first cycle is measured from its first largest rotation.
        let start = self.state_after((4 * cycle).max(1)).settlement;
        (end - start) / (2.0 * HALF_WIDTH)
    }
}

/// Settlements and moments of slow cycles.
fn table(cycles: &[SlowCycles]) -> String {
    let mut text = String::from(
        "|F|settlement of cycle 2, of the last cycle, over B|moment of the first, of the last cycle, over (N B/2)(1 − N/N_u)|fraction in contact at the largest rotation|\n\
         |---|---|---|---|\n",
    );
    for run in cycles {
        // Writing to a string does not fail.
        let _ = writeln!(
            text,
            "|{}|{:.5}, {:.5}|{:.3}, {:.3}|{:.2}|",
            run.strip.safety_factor,
            run.settlement(1),
            run.settlement(CYCLE_COUNT - 1),
            run.peak_moment(0),
            run.peak_moment(CYCLE_COUNT - 1),
            run.state_after(4 * CYCLE_COUNT - 3).closed_fraction,
        );
    }
    text
}

/// The settlement of a cycle grows as F falls, and the moment does not degrade.
fn cycle_checks(cycles: &[SlowCycles]) -> Vec<Check> {
    let name =
        format!("slow cycles of rotation, ±{CYCLE_AMPLITUDE} rad, F = {CYCLE_SAFETY_FACTORS:?}");
    let last_cycle = CYCLE_COUNT - 1;
    let settlements: Vec<f64> = cycles.iter().map(|run| run.settlement(last_cycle)).collect();
    let settlement_ratios = settlements.windows(2).map(|pair| pair[0] / pair[1]);
    let moment_ratios = cycles.iter().map(|run| run.peak_moment(last_cycle) / run.peak_moment(0));
    vec![
        Check::new(
            format!(
                "{name}: smallest ratio of settlements of the last cycle from one F to the next"
            ),
            "grows as F falls",
            settlement_ratios.fold(f64::INFINITY, f64::min),
            Limit::AtLeast(1.0),
        ),
        Check::new(
            format!("{name}: smallest moment of the last cycle over that of the first"),
            "does not degrade",
            moment_ratios.fold(f64::INFINITY, f64::min),
            Limit::AtLeast(MIN_MOMENT_RATIO),
        ),
    ]
}

/// Moment and settlement over rotation.
fn picture(cycles: &[SlowCycles]) -> Figure {
    let mut moments = FigurePanel::new("rotation, mrad", "moment over (N B/2)(1 − N/N_u)")
        .legend(SeriesLabelPosition::UpperLeft)
        .room(0.05, 0.3);
    let mut settlements = FigurePanel::new("rotation, mrad", "−settlement/B")
        .legend(SeriesLabelPosition::LowerLeft)
        .room(0.3, 0.05);
    let colors = [(1, CURVE_RED), (3, CURVE_BLUE), (4, CURVE_GREEN)];
    for (run, color) in colors.map(|(k, color)| (&cycles[k], color)) {
        let name = format!("F = {}", run.strip.safety_factor);
        let capacity = run.strip.moment_capacity();
        let states = run.states.iter();
        let moment = states.clone().map(|s| (1e3 * s.rotation, s.moment / capacity)).collect();
        let settlement = states.map(|s| (1e3 * s.rotation, -s.settlement / (2.0 * HALF_WIDTH)));
        moments = moments.line(&name, color, moment);
        settlements = settlements.line(&name, color, settlement.collect());
    }
    let title = "Strip without tension on clay that yields, slow cycles of rotation";
    Figure::new(title, 2, vec![moments, settlements])
}
