//! Advice on many bonded scenes, drawn at random: how often it is met, and what it wastes.

use std::f64::consts::{PI, TAU};
use std::path::Path;

use basemat::Soil;
use basemat::bem::Grading;
use basemat::coupled::{Advice, Outline, advise};
use basemat::interface::Bonded;
use basemat::motion::{FrequencyContent, Record, el_centro_1940};
use basemat::structure::{RigidBlock, ShearBuilding, Storey};
use basemat_problems::random::Random;
use indicatif::ProgressBar;

use super::force::Errors;
use super::report::ADVICE_COLUMNS;
use super::scene::Scene;
use super::settings::{Past, Settings};
use crate::AnyError;

const SCENES: u64 = 170;

/// Tolerances of a scene, by turns; the second one's settings, twice finer, are the reference of both.
const TOLERANCES: [[f64; 2]; 3] = [[0.1, 0.01], [0.03, 0.003], [0.01, 0.002]];

/// Half the width of the base, m.
const HALF: f64 = 5.0;

/// A scene of the sweep.
struct Drawn {
    label: String,
    soil: Soil,
    /// Over half the width.
    slenderness: f64,
    /// kg/m³ of the outline.
    density: f64,
    /// Frequency on a fixed base (Hz) and damping ratio.
    sway: Option<[f64; 2]>,
    record: Record,
    tolerances: [f64; 2],
}

impl Drawn {
    fn new(number: u64) -> basemat::Result<Self> {
        let mut draw = Random(number);
        let scale =
            |draw: &mut Random, low: f64, high: f64| low * (high / low).powf(draw.within(0.0, 1.0));
        #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "an index")]
        let poisson = [0.0, 0.15, 0.25, 0.33, 0.4, 0.45][(6.0 * draw.within(0.0, 1.0)) as usize];
        let speed = scale(&mut draw, 100.0, 500.0);
        let soil = Soil::new(1900.0 * speed * speed, poisson, 1900.0)?;
        let slenderness = scale(&mut draw, 1.0, 6.0);
        let density = scale(&mut draw, 200.0, 2500.0);
        let sways = draw.within(0.0, 1.0) < 0.5;
        let sway = [scale(&mut draw, 0.5, 6.0), draw.within(0.0, 0.05)];
        let (motion, record) = match number % 3 {
            0 => ("El Centro", el_centro(8.0)?),
            1 => {
                let sigma = scale(&mut draw, 0.08, 0.4);
                ("Ricker", ricker(sigma)?)
            }
            _ => {
                let period = scale(&mut draw, 0.6, 3.0);
                let cycles = draw.within(1.2, 3.0);
                ("near fault", near_fault(period, cycles, draw.within(0.0, TAU))?)
            }
        };
        let scene = Self {
            label: String::new(),
            soil,
            slenderness,
            density,
            sway: sways.then_some(sway),
            record,
            tolerances: TOLERANCES[(number / 3 % 3) as usize],
        };
        let sway =
            scene.sway.map_or("rigid".into(), |[f, d]| format!("{f:.2} Hz {:.1} %", 100.0 * d));
        let label = format!(
            "{number:3} ν {poisson} c_S {speed:.0} h/b {slenderness:.2} {density:.0} kg/m³ {sway} {motion}"
        );
        Ok(Self { label, ..scene })
    }

    fn mass(&self) -> f64 {
        2.0 * HALF * HALF * self.slenderness * self.density
    }

    fn outline(&self) -> basemat::Result<Outline> {
        let outline = Outline::new(2.0 * HALF, self.slenderness * HALF, self.mass())?;
        match self.sway {
            None => Ok(outline),
            Some([frequency, ratio]) => outline.with_frequency(frequency, ratio),
        }
    }

    fn scene(&self) -> Scene {
        let (mass, height) = (self.mass(), self.slenderness * HALF);
        let (sway, density, record) = (self.sway, self.density, self.record.clone());
        Scene {
            name: "advice",
            soil: self.soil,
            width: 2.0 * HALF,
            duration: self.record.duration(),
            parts: Box::new(move |builder| {
                let builder = builder.gravity(0.0).interface(Bonded).motion(record.clone());
                Ok(match sway {
                    None => builder.structure(RigidBlock::new(2.0 * HALF, height, density)?),
                    Some([frequency, ratio]) => {
                        // 70 % of the mass at 70 % of the height, the rest what a block has.
                        let (swaying, arm) = (0.7 * mass, 0.7 * height);
                        let block = mass * (HALF * HALF + height * height) / 3.0;
                        let rotary =
                            0.5 * (block - swaying * arm * arm).max(mass * HALF * HALF / 3.0);
                        let natural = TAU * frequency;
                        let storey = Storey {
                            height: arm,
                            mass: swaying,
                            rotary_inertia: rotary,
                            stiffness: swaying * natural * natural,
                            damping: 2.0 * ratio * swaying * natural,
                        };
                        let building =
                            ShearBuilding::new(2.0 * HALF, 0.3 * mass, rotary, &[storey])?;
                        builder.structure(building)
                    }
                })
            }),
        }
    }
}

pub(crate) fn el_centro(seconds: f64) -> basemat::Result<Record> {
    let record = el_centro_1940();
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a small number")]
    let samples = (seconds / record.time_step()).round() as usize + 1;
    Record::new(record.time_step(), record.accelerations()[..samples].to_vec())
}

/// Second derivative of a Ricker pulse of displacement, and rest as long again.
fn ricker(sigma: f64) -> basemat::Result<Record> {
    let step = 0.02 * sigma;
    let pulse = |k: i32| {
        let q = (0.02 * f64::from(k) - 5.0).powi(2);
        (-8.0 * q * q + 24.0 * q - 6.0) * (-q).exp()
    };
    Record::new(step, (0..=800).map(pulse).collect())
}

/// Velocity pulse ½ (1 + cos(2πt/γT)) cos(2πt/T + φ), |t| ≤ γT/2, of G. P. Mavroeidis and A. S.
/// Papageorgiou, Bull. Seism. Soc. Am. 93 (2003), 1099–1131; and rest as long again.
pub(crate) fn near_fault(period: f64, cycles: f64, phase: f64) -> basemat::Result<Record> {
    let step = 0.005 * period;
    let half = 0.5 * cycles * period;
    let velocity = |time: f64| {
        let t = time - half;
        if t.abs() > half {
            return 0.0;
        }
        0.5 * (1.0 + (PI * t / half).cos()) * (TAU * t / period + phase).cos()
    };
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a small number")]
    let samples = (4.0 * half / step) as usize;
    // Means over a sample either way, which add up to a velocity that ends at zero.
    let acceleration =
        |k: usize| (velocity((k as f64 + 0.5) * step) - velocity((k as f64 - 0.5) * step)) / step;
    Record::new(step, (0..=samples).map(acceleration).collect())
}

/// A proposal, what came of it, and the settings that would have done.
struct Outcome {
    advice: Advice,
    errors: Errors,
    seconds: f64,
    /// Processor time of these over that of the proposal.
    least: f64,
}

impl Outcome {
    fn ratio(&self) -> f64 {
        self.errors.history.max(self.errors.peak) / self.advice.tolerance
    }
}

impl Drawn {
    fn outcomes(&self) -> Result<Vec<Outcome>, AnyError> {
        let (scene, outline) = (self.scene(), self.outline()?);
        let content = FrequencyContent::of(&self.record)?;
        let advised: Vec<Advice> = self
            .tolerances
            .iter()
            .map(|&tolerance| advise(self.soil, &outline, &content, tolerance))
            .collect::<Result<_, _>>()?;
        let Some(strict) = advised.last().copied() else { return Ok(Vec::new()) };
        let run = |elements: usize, time_step: f64| {
            let settings = Settings::new(elements, Grading::Cosine, time_step);
            scene.run(&Settings { history: Past::of(strict.history), ..settings })
        };
        let fine = 0.5 * strict.time_step;
        let reference = run(2 * strict.elements, fine)?.force;
        let mut outcomes = Vec::new();
        for advice in advised {
            let found = run(advice.elements, advice.time_step)?;
            // Errors fall with the square: what the reference lacks is known.
            let share = (advice.time_step / fine).powi(2);
            let Errors { peak, history } = found.force.errors(&reference);
            let [peak, history] = [peak, history].map(|error| error * share / (share - 1.0));
            let errors = Errors { peak, history };
            // By the same law, settings that just meet the tolerance.
            let factor = (history.max(peak) / advice.tolerance).sqrt();
            #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "small")]
            let elements = ((advice.elements as f64 * factor).ceil() as usize).max(4);
            let least = run(elements, advice.time_step / factor)?.seconds / found.seconds;
            outcomes.push(Outcome { advice, errors, seconds: found.seconds, least });
        }
        Ok(outcomes)
    }
}

/// Runs it, and writes a row for each tolerance.
pub(crate) fn run(out: &Path, short: bool) -> Result<(), AnyError> {
    let mut writer = csv::Writer::from_path(out.join("advice_sweep.csv"))?;
    writer.write_record(ADVICE_COLUMNS.iter().chain(&["least_processor_s"]))?;
    let scenes = if short { 12 } else { SCENES };
    let bar = ProgressBar::new(scenes);
    let (mut ratios, mut excess) = (Vec::new(), Vec::new());
    for number in 0..scenes {
        let drawn = Drawn::new(number)?;
        for outcome in drawn.outcomes()? {
            let (a, e) = (&outcome.advice, &outcome.errors);
            let mut row = vec![
                drawn.label.clone(),
                a.tolerance.to_string(),
                a.elements.to_string(),
                format!("{:.2e}", a.time_step),
            ];
            let numbers = [a.mesh_error, a.step_error, a.peak_error, e.history, e.peak];
            let times = [outcome.seconds, outcome.seconds * outcome.least];
            row.extend(numbers.into_iter().chain(times).map(|x| format!("{x:.3e}")));
            writer.write_record(row)?;
            ratios.push(outcome.ratio());
            // Shorter runs are mostly overhead.
            if outcome.seconds > 0.02 {
                excess.push(outcome.least.recip());
            }
        }
        bar.inc(1);
    }
    writer.flush()?;
    bar.finish_and_clear();
    let above = |limit: f64| ratios.iter().filter(|&&ratio| ratio > limit).count();
    println!(
        "{} runs of {scenes} scenes: {} above the tolerance, {} above twice of it; larger error over the \
         tolerance at 5, 50, 95 and 100 %: {:.2?}; processor time over that of the least settings that do, \
         at 5, 50, 95 and 100 % of {} runs over 20 ms: {:.2?}",
        ratios.len(),
        above(1.0),
        above(2.0),
        quantiles(&mut ratios.clone()),
        excess.len(),
        quantiles(&mut excess),
    );
    Ok(())
}

fn quantiles(values: &mut [f64]) -> [f64; 4] {
    values.sort_by(f64::total_cmp);
    let last = values.len().saturating_sub(1);
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "an index")]
    [0.05, 0.5, 0.95, 1.0]
        .map(|share| values.get((share * last as f64) as usize).copied().unwrap_or(f64::NAN))
}
