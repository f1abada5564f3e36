//! The slip by a response spectrum, compared with slips of a block under twenty motions.

use basemat::bem::{ElasticGround, Grading, Strip};
use basemat::interface::Coulomb;
use basemat::motion::{Record, STANDARD_GRAVITY, VerticalIncidence};
use basemat::reference::{SlidingBlock, SlidingEstimate};
use basemat::structure::RigidBlock;
use basemat::{Simulation, Soil, unobserved};
use plotters::prelude::SeriesLabelPosition;

use super::outcome::{ValidationCase, ValidationCheck, ValidationOutcome};
use crate::AnyError;
use crate::artificial_motion::artificial_motion;
use crate::figure::{CURVE_BLUE, CURVE_GRAY, CURVE_GREEN, CURVE_ORANGE, Figure, FigurePanel};
use crate::fragility::motions;
use basemat_problems::series::nearest_integer;

pub(crate) const VALIDATION_CASE: ValidationCase = ValidationCase {
    name: "sliding_estimate",
    title: "Slip from a spectrum (ASCE 43-05, appendix A)",
    reference: "equations A-1 to A-3 of the standard; on rigid ground the block is solved exactly",
    settings: "block 10 m × 3 m, friction 0.15, 8 cosine-graded elements, Δt = 5 ms; El Centro, three near-fault pulses, 16 artificial motions (seeds 1 to 16)",
    run,
};

const FRICTION_COEFFICIENT: f64 = 0.15;
const TIME_STEP: f64 = 0.005;
/// Peak ground accelerations over the acceleration that starts slip.
const PEAK_LEVELS: [f64; 3] = [1.5, 2.5, 5.0];
/// Limits of the median and the smallest ratio, and of the fraction of ratios below one, at each level.
const MEDIAN_LIMITS: [[f64; 2]; 3] = [[5.0, 40.0], [2.0, 8.0], [1.2, 4.0]];
const SMALLEST_RATIOS: [f64; 3] = [1.5, 0.9, 0.6];
const UNSAFE_PARTS: [f64; 3] = [0.0, 0.1, 0.4];
/// The level of the table by motions, and of runs with vertical motion.
const SHOWN_LEVEL: usize = 1;
/// Largest vertical over largest horizontal acceleration.
const VERTICAL_RATIO: f64 = 2.0 / 3.0;
/// Wave speeds of the soils, m/s.
const STIFF_SOIL_SPEED: f64 = 800.0;
const SOFT_SOIL_SPEED: f64 = 150.0;

/// Horizontal motions and vertical motions of other frequencies, all with a peak of 1 m/s².
fn ensemble(short: bool) -> Result<Vec<(String, Record, Record)>, AnyError> {
    let mut list = Vec::new();
    let fragility_motions = motions::list(TIME_STEP, false)?;
    // One motion of each shape, because stretched motions have the same ratio on rigid ground.
    for number in [1, 3, 10, 17] {
        let (name, record) = &fragility_motions[number];
        list.push((name.clone(), record.scaled_to_peak(1.0)?));
    }
    for seed in 1..=16 {
        let frequency = [1.5, 2.5, 4.0][usize::try_from(seed)? % 3];
        let name = format!("artificial, ground of {frequency} Hz, seed {seed}");
        list.push((name, artificial_motion(frequency, seed)?));
    }
    let numbered = list.into_iter().zip(101..).step_by(if short { 5 } else { 1 });
    numbered
        .map(|((name, horizontal), seed)| Ok((name, horizontal, artificial_motion(5.0, seed)?)))
        .collect()
}

/// Estimate of the slip, m; zero if the spectrum gives none.
fn estimate(record: &Record, vertical: f64) -> Result<f64, AnyError> {
    let periods: Vec<f64> = (0..=200).map(|k| 0.02 * 600_f64.powf(f64::from(k) / 200.0)).collect();
    let spectrum = record.response_spectrum(&periods, 0.1, &mut unobserved)?;
    let estimate = SlidingEstimate::new(FRICTION_COEFFICIENT, vertical, STANDARD_GRAVITY)?;
    Ok(estimate.slip(&spectrum)?.unwrap_or(0.0))
}

/// Largest slip on rigid ground, m.
fn on_rigid_ground(record: &Record) -> Result<f64, AnyError> {
    let slide = SlidingBlock::new(FRICTION_COEFFICIENT, STANDARD_GRAVITY)?.slide(record);
    Ok(slide.maximum().max(-slide.minimum()))
}

/// Largest slip on soil of this wave speed, m.
fn on_soil(speed: f64, horizontal: &Record, vertical: Option<Record>) -> Result<f64, AnyError> {
    let soil = Soil::from_wave_speeds(speed, 2.0 * speed, 2000.0)?;
    let strip = Strip::new(-5.0..5.0, 8, Grading::Cosine)?;
    let mut simulation = Simulation::builder(TIME_STEP)
        .structure(RigidBlock::new(10.0, 3.0, 2000.0)?)
        .ground(ElasticGround::new(soil, strip)?)
        .interface(Coulomb::new(FRICTION_COEFFICIENT)?)
        .motion(VerticalIncidence { horizontal: Some(horizontal.clone()), vertical })
        .build()?;
    let mut max_magnitude = 0.0_f64;
    let steps = nearest_integer((horizontal.duration() + 2.0) / TIME_STEP);
    let run =
        simulation.run(steps, |state| max_magnitude = max_magnitude.max(state.mean_slip.abs()))?;
    if run.energy_error > 1e-9 {
        return Err(format!("energy balance open by {:.1e}", run.energy_error).into());
    }
    Ok(max_magnitude)
}

/// Estimates and slips of one ground at one level, in the order of the motions.
struct EstimateGroup {
    name: &'static str,
    level: usize,
    /// Estimate and slip, m.
    points: Vec<[f64; 2]>,
}

impl EstimateGroup {
    fn ratios(&self) -> Vec<f64> {
        self.points.iter().map(|[estimate, slip]| estimate / slip).collect()
    }

    /// Checks of the median, smallest and largest ratio, and of the part of estimates below the slip.
    fn checks(&self) -> Vec<ValidationCheck> {
        let mut ratios = self.ratios();
        ratios.sort_by(f64::total_cmp);
        let count = ratios.len();
        let median = ratios[nearest_integer(0.5 * (count - 1) as f64)];
        let name = format!("{}, peak {} μg", self.name, PEAK_LEVELS[self.level]);
        let limits = MEDIAN_LIMITS[self.level];
        let below = ratios.iter().filter(|ratio| **ratio < 1.0).count();
        vec![
            ValidationCheck::within(
                format!("{name}: median of estimate over slip"),
                median,
                limits[0]..=limits[1],
            ),
            ValidationCheck::within(
                format!("{name}: least"),
                ratios[0],
                SMALLEST_RATIOS[self.level]..=20.0,
            ),
            ValidationCheck::within(
                format!("{name}: greatest"),
                ratios[count - 1],
                limits[0]..=100.0,
            ),
            ValidationCheck::below(
                format!("{name}: part of estimates below the slip"),
                below as f64 / count as f64,
                UNSAFE_PARTS[self.level],
            ),
        ]
    }

    fn millimetres(&self) -> Vec<(f64, f64)> {
        let visible_points = self.points.iter().filter(|point| point[0] > 1e-4 && point[1] > 1e-4);
        visible_points.map(|[estimate, slip]| (1e3 * estimate, 1e3 * slip)).collect()
    }
}

/// Slips over estimates on one ground.
fn panel(groups: &[EstimateGroup], name: &str) -> FigurePanel {
    let mut panel =
        FigurePanel::new("estimate of ASCE 43-05, mm", &format!("largest slip, mm ({name})"))
            .double_logarithmic()
            .legend(SeriesLabelPosition::UpperLeft)
            .dashed("equal", CURVE_GRAY, vec![(1.0, 1.0), (2000.0, 2000.0)]);
    let shown = groups.iter().filter(|group| group.name == name);
    for (group, color) in shown.zip([CURVE_GREEN, CURVE_BLUE, CURVE_ORANGE]) {
        let label = format!("peak {} μg", PEAK_LEVELS[group.level]);
        panel = panel.circles(&label, color, group.millimetres());
    }
    panel
}

fn run(short: bool) -> Result<ValidationOutcome, AnyError> {
    let motions = ensemble(short)?;
    let mut groups = Vec::new();
    for (level, factor) in PEAK_LEVELS.into_iter().enumerate() {
        let peak = factor * FRICTION_COEFFICIENT * STANDARD_GRAVITY;
        let mut rigid_points = Vec::new();
        let mut stiff_points = Vec::new();
        let mut soft_points = Vec::new();
        let mut points_of_both = Vec::new();
        for (_, horizontal, vertical) in &motions {
            let horizontal = horizontal.scaled_to_peak(peak)?;
            let estimated = estimate(&horizontal, 0.0)?;
            rigid_points.push([estimated, on_rigid_ground(&horizontal)?]);
            stiff_points.push([estimated, on_soil(STIFF_SOIL_SPEED, &horizontal, None)?]);
            soft_points.push([estimated, on_soil(SOFT_SOIL_SPEED, &horizontal, None)?]);
            if level == SHOWN_LEVEL {
                let vertical = vertical.scaled_to_peak(VERTICAL_RATIO * peak)?;
                let estimated = estimate(&horizontal, VERTICAL_RATIO * peak)?;
                points_of_both
                    .push([estimated, on_soil(STIFF_SOIL_SPEED, &horizontal, Some(vertical))?]);
            }
        }
        groups.push(EstimateGroup { name: "rigid ground", level, points: rigid_points });
        groups.push(EstimateGroup { name: "soil of 800 m/s", level, points: stiff_points });
        groups.push(EstimateGroup { name: "soil of 150 m/s", level, points: soft_points });
        if level == SHOWN_LEVEL {
            groups.push(EstimateGroup {
                name: "800 m/s, vertical too",
                level,
                points: points_of_both,
            });
        }
    }
    let mut checks: Vec<ValidationCheck> = groups.iter().flat_map(EstimateGroup::checks).collect();
    for group in groups.iter().filter(|group| group.level == SHOWN_LEVEL) {
        for ((motion, ..), ratio) in motions.iter().zip(group.ratios()) {
            let name = format!("{}, peak {} μg: {motion}", group.name, PEAK_LEVELS[SHOWN_LEVEL]);
            checks.push(ValidationCheck::within(name, ratio, 0.6..=100.0));
        }
    }
    let panels = vec![panel(&groups, "rigid ground"), panel(&groups, "soil of 150 m/s")];
    let title = "Slip of a block of 10 m × 3 m on friction 0.15 under twenty motions";
    Ok(ValidationOutcome { checks, figure: Figure::new(title, 2, panels) })
}
