//! The slip that a response spectrum promises, beside the slips of a block under twenty motions.

use basemat::bem::{ElasticGround, Grading, Strip};
use basemat::interface::Coulomb;
use basemat::motion::{Record, STANDARD_GRAVITY, VerticalIncidence};
use basemat::reference::{SlidingBlock, SlidingEstimate};
use basemat::structure::RigidBlock;
use basemat::{Simulation, Soil, unobserved};
use plotters::prelude::SeriesLabelPosition;

use super::outcome::{Case, Check, Outcome};
use crate::AnyError;
use crate::artificial_motion::artificial_motion;
use crate::figure::{BLUE, Figure, GRAY, GREEN, ORANGE, Panel};
use crate::fragility::motions;
use basemat_problems::series::whole;

pub(crate) const CASE: Case = Case {
    name: "sliding_estimate",
    title: "Slip from a spectrum (ASCE 43-05, appendix A)",
    reference: "equations A-1 to A-3 of the standard; on rigid ground the block is solved exactly",
    settings: "block 10 m × 3 m, friction 0.15, 8 cosine-graded elements, Δt = 5 ms; El Centro, three near-fault pulses, 16 artificial motions (seeds 1 to 16)",
    run,
};

const FRICTION: f64 = 0.15;
const STEP: f64 = 0.005;
/// Peaks of the ground's acceleration over that which starts slip.
const LEVELS: [f64; 3] = [1.5, 2.5, 5.0];
/// Limits of the median and the least ratio, and of the part of ratios below one, at each level.
const MEDIANS: [[f64; 2]; 3] = [[5.0, 40.0], [2.0, 8.0], [1.2, 4.0]];
const LEAST: [f64; 3] = [1.5, 0.9, 0.6];
const UNSAFE: [f64; 3] = [0.0, 0.1, 0.4];
/// The level of the table by motions, and of runs with vertical motion.
const SHOWN: usize = 1;
/// Largest vertical over largest horizontal acceleration.
const VERTICAL: f64 = 2.0 / 3.0;
/// Wave speeds of the soils, m/s.
const STIFF: f64 = 800.0;
const SOFT: f64 = 150.0;

/// Motions and, with a frequency of their own, vertical motions, all with a peak of 1 m/s².
fn ensemble(short: bool) -> Result<Vec<(String, Record, Record)>, AnyError> {
    let mut list = Vec::new();
    let known = motions::list(STEP, false)?;
    // A motion of another length has the same ratio on rigid ground: one of each shape.
    for number in [1, 3, 10, 17] {
        let (name, record) = &known[number];
        list.push((name.clone(), record.scaled_to_peak(1.0)?));
    }
    for seed in 1..=16 {
        let frequency = [1.5, 2.5, 4.0][usize::try_from(seed)? % 3];
        let name = format!("artificial, ground of {frequency} Hz, seed {seed}");
        list.push((name, artificial_motion(frequency, seed)?));
    }
    let numbered = list.into_iter().zip(101..).step_by(if short { 5 } else { 1 });
    numbered.map(|((name, own), seed)| Ok((name, own, artificial_motion(5.0, seed)?))).collect()
}

/// Estimate of the slip, m; zero where the spectrum promises none.
fn estimate(record: &Record, vertical: f64) -> Result<f64, AnyError> {
    let periods: Vec<f64> = (0..=200).map(|k| 0.02 * 600_f64.powf(f64::from(k) / 200.0)).collect();
    let spectrum = record.response_spectrum(&periods, 0.1, &mut unobserved)?;
    let estimate = SlidingEstimate::new(FRICTION, vertical, STANDARD_GRAVITY)?;
    Ok(estimate.slip(&spectrum)?.unwrap_or(0.0))
}

/// Largest slip on rigid ground, m.
fn on_rigid_ground(record: &Record) -> Result<f64, AnyError> {
    let history = SlidingBlock::new(FRICTION, STANDARD_GRAVITY)?.slide(record);
    Ok(history.maximum().max(-history.minimum()))
}

/// Largest slip on soil of this wave speed, m.
fn on_soil(speed: f64, horizontal: &Record, vertical: Option<Record>) -> Result<f64, AnyError> {
    let soil = Soil::from_wave_speeds(speed, 2.0 * speed, 2000.0)?;
    let strip = Strip::new(-5.0..5.0, 8, Grading::Cosine)?;
    let mut simulation = Simulation::builder(STEP)
        .structure(RigidBlock::new(10.0, 3.0, 2000.0)?)
        .ground(ElasticGround::new(soil, strip)?)
        .interface(Coulomb::new(FRICTION)?)
        .motion(VerticalIncidence { horizontal: Some(horizontal.clone()), vertical })
        .build()?;
    let mut largest = 0.0_f64;
    let steps = whole((horizontal.duration() + 2.0) / STEP);
    let run = simulation.run(steps, |state| largest = largest.max(state.mean_slip.abs()))?;
    if run.energy_error > 1e-9 {
        return Err(format!("energy balance open by {:.1e}", run.energy_error).into());
    }
    Ok(largest)
}

/// Estimates and slips of one ground at one level, in the order of the motions.
struct Group {
    name: &'static str,
    level: usize,
    /// Estimate and slip, m.
    points: Vec<[f64; 2]>,
}

impl Group {
    fn ratios(&self) -> Vec<f64> {
        self.points.iter().map(|[estimate, slip]| estimate / slip).collect()
    }

    /// Median, least and greatest ratio, and the part of estimates below the slip.
    fn checks(&self) -> Vec<Check> {
        let mut ratios = self.ratios();
        ratios.sort_by(f64::total_cmp);
        let place = |part: f64| ratios[whole(part * (ratios.len() - 1) as f64)];
        let name = |what: &str| format!("{}, peak {} μg: {what}", self.name, LEVELS[self.level]);
        let [low, high] = MEDIANS[self.level];
        let below = ratios.iter().filter(|ratio| **ratio < 1.0).count();
        vec![
            Check::within(name("median of estimate over slip"), place(0.5), low..=high),
            Check::within(name("least"), place(0.0), LEAST[self.level]..=20.0),
            Check::within(name("greatest"), place(1.0), low..=100.0),
            Check::below(
                name("part of estimates below the slip"),
                below as f64 / ratios.len() as f64,
                UNSAFE[self.level],
            ),
        ]
    }

    fn millimetres(&self) -> Vec<(f64, f64)> {
        let seen = self.points.iter().filter(|point| point[0] > 1e-4 && point[1] > 1e-4);
        seen.map(|[estimate, slip]| (1e3 * estimate, 1e3 * slip)).collect()
    }
}

fn run(short: bool) -> Result<Outcome, AnyError> {
    let motions = ensemble(short)?;
    let mut groups = Vec::new();
    for (level, factor) in LEVELS.into_iter().enumerate() {
        let peak = factor * FRICTION * STANDARD_GRAVITY;
        let [mut rigid, mut stiff, mut soft, mut both] = [const { Vec::new() }; 4];
        for (_, horizontal, vertical) in &motions {
            let horizontal = horizontal.scaled_to_peak(peak)?;
            let expected = estimate(&horizontal, 0.0)?;
            rigid.push([expected, on_rigid_ground(&horizontal)?]);
            stiff.push([expected, on_soil(STIFF, &horizontal, None)?]);
            soft.push([expected, on_soil(SOFT, &horizontal, None)?]);
            if level == SHOWN {
                let vertical = vertical.scaled_to_peak(VERTICAL * peak)?;
                let expected = estimate(&horizontal, VERTICAL * peak)?;
                both.push([expected, on_soil(STIFF, &horizontal, Some(vertical))?]);
            }
        }
        groups.push(Group { name: "rigid ground", level, points: rigid });
        groups.push(Group { name: "soil of 800 m/s", level, points: stiff });
        groups.push(Group { name: "soil of 150 m/s", level, points: soft });
        if level == SHOWN {
            groups.push(Group { name: "800 m/s, vertical too", level, points: both });
        }
    }
    let mut checks: Vec<Check> = groups.iter().flat_map(Group::checks).collect();
    for group in groups.iter().filter(|group| group.level == SHOWN) {
        for ((motion, ..), ratio) in motions.iter().zip(group.ratios()) {
            let name = format!("{}, peak {} μg: {motion}", group.name, LEVELS[SHOWN]);
            checks.push(Check::within(name, ratio, 0.6..=100.0));
        }
    }
    let panel = |name: &str| {
        let mut panel =
            Panel::new("estimate of ASCE 43-05, mm", &format!("largest slip, mm ({name})"))
                .double_logarithmic()
                .legend(SeriesLabelPosition::UpperLeft)
                .dashed("equal", GRAY, vec![(1.0, 1.0), (2000.0, 2000.0)]);
        let own = groups.iter().filter(|group| group.name == name);
        for (group, color) in own.zip([GREEN, BLUE, ORANGE]) {
            let label = format!("peak {} μg", LEVELS[group.level]);
            panel = panel.circles(&label, color, group.millimetres());
        }
        panel
    };
    let panels = vec![panel("rigid ground"), panel("soil of 150 m/s")];
    let title = "Slip of a block of 10 m × 3 m on friction 0.15 under twenty motions";
    Ok(Outcome { checks, figure: Figure::new(title, 2, panels) })
}
