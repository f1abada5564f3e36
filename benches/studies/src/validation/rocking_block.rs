//! Housner's rocking block with its impacts, and the quarter period on the half-plane.

use std::f64::consts::PI;

use basemat::bem::{ElasticGround, Grading, Ground, SpringGround, Strip};
use basemat::interface::Coulomb;
use basemat::motion::STANDARD_GRAVITY;
use basemat::structure::{Base, RigidBlock, Structure, Triplets};
use basemat::{Simulation, Soil};
use plotters::prelude::SeriesLabelPosition;

use super::outcome::{ValidationCase, ValidationCheck, ValidationOutcome, milli_curve, worse};
use crate::AnyError;
use crate::figure::{CURVE_BLUE, CURVE_RED, Figure, FigurePanel};
use basemat_problems::rocking::{Rocker, crossings, quarter_period};
use basemat_problems::series::{RelativeError, nearest_integer};

pub(crate) const VALIDATION_CASE: ValidationCase = ValidationCase {
    name: "rocking_block",
    title: "Rocking block",
    reference: "Housner's block, integrated apart; quarter period in closed form",
    settings: "two stiff elements, Δt = 0.02 ms, means of 16 runs; half-plane, 16 and 32 cosine-graded, Δt = 2.5 ms",
    run,
};

/// Half width, half height (m), density (kg/m³).
const B: f64 = 0.5;
const H: f64 = 2.0;
const MASS_DENSITY: f64 = 2500.0;
/// Duration of the push (s), and its largest moment over the moment that lifts the block.
const PUSH_DURATION: f64 = 0.5;
const PUSH_FACTOR: f64 = 1.6;
/// Number of runs whose errors are averaged, and relative difference of the push from run to run.
///
/// Each impact of stiff bodies multiplies rounding, so that errors of single runs differ by a factor of two.
const RUN_COUNT: usize = 16;
const PUSH_INCREMENT: f64 = 1e-10;
/// Number of impacts that are compared; later impacts follow each other ever faster, until the block stands.
const IMPACT_COUNT: usize = 8;
/// Interval of the samples, s.
const SAMPLE_INTERVAL: f64 = 0.01;

fn mass() -> f64 {
    4.0 * B * H * MASS_DENSITY
}

fn weight() -> f64 {
    mass() * STANDARD_GRAVITY
}

/// Moment of inertia about the middle of the base.
fn inertia() -> f64 {
    mass() * (B * B + H * H) / 3.0 + mass() * H * H
}

fn push(time: f64) -> f64 {
    if time < PUSH_DURATION {
        PUSH_FACTOR * weight() * B * (PI * time / PUSH_DURATION).sin()
    } else {
        0.0
    }
}

/// The block with its P–Δ effect under a push.
struct PushedBlock {
    block: RigidBlock,
    push_factor: f64,
}

impl PushedBlock {
    fn on_base(width: f64, push_factor: f64) -> Result<Self, AnyError> {
        let central = inertia() - mass() * H * H;
        let block = RigidBlock::from_mass(width, mass(), central, H)?;
        Ok(Self { block: block.with_p_delta(STANDARD_GRAVITY)?, push_factor })
    }
}

impl Structure for PushedBlock {
    fn dofs(&self) -> usize {
        self.block.dofs()
    }

    fn base(&self) -> Base {
        self.block.base()
    }

    fn mass(&self, matrix: &mut Triplets) -> basemat::Result<()> {
        self.block.mass(matrix)
    }

    fn stiffness(&self, matrix: &mut Triplets) -> basemat::Result<()> {
        self.block.stiffness(matrix)
    }

    fn load(&self, time: f64, load: &mut [f64]) -> basemat::Result<()> {
        load[RigidBlock::ROTATION_DOF] += self.push_factor * push(time);
        Ok(())
    }
}

/// Tilts at every step, the first at t = 0.
fn tilts(
    ground: impl Ground + 'static,
    structure: PushedBlock,
    time_step: f64,
    duration: f64,
) -> Result<Vec<f64>, AnyError> {
    let mut simulation = Simulation::builder(time_step)
        .structure(structure)
        .ground(ground)
        .interface(Coulomb::uplift_only())
        .build()?;
    let mut tilts = vec![0.0];
    let steps = nearest_integer(duration / time_step);
    let run = simulation.run(steps, |state| tilts.push(state.absolute_displacement()[2]))?;
    if run.energy_error > 1e-9 {
        return Err(format!("energy balance open by {:.1e}", run.energy_error).into());
    }
    Ok(tilts)
}

/// Housner's block on two elements, whose pressures act at their middles, ±b: the two corners.
///
/// The stiff bed is damped, so that a corner lands without rebound and the bed returns (c/k) within 0.05 ms.
fn on_corners(time_step: f64, duration: f64, factor: f64) -> Result<Vec<f64>, AnyError> {
    let stiffness = 4e12;
    let dashpot = 2e8;
    let bed = SpringGround::new(-2.0 * B..2.0 * B, 2, stiffness, 1e13)?
        .with_dashpots(dashpot, 0.0)?
        .with_theta(1.0)?;
    let stride = nearest_integer(SAMPLE_INTERVAL / time_step);
    let block = PushedBlock::on_base(4.0 * B, factor)?;
    Ok(tilts(bed, block, time_step, duration)?.into_iter().step_by(stride).collect())
}

/// Difference of time series relative to the reference, in the L2 norm.
fn relative(computed: &[f64], reference: &[f64]) -> f64 {
    let mut error = RelativeError::default();
    computed.iter().zip(reference).for_each(|(a, b)| error.add(*a, *b));
    error.relative()
}

struct QuarterRatios {
    rigid_base: f64,
    deformable_soil: f64,
}

/// Quarter period of free rocking on the half-plane over Housner's, and over the one on a half-plane without inertia.
fn quarter_ratios(speed: f64, elements: usize) -> Result<QuarterRatios, AnyError> {
    let poisson = 1.0 / 3.0;
    let time_step = 0.0025;
    let soil = Soil::from_wave_speeds(speed, 2.0 * speed, 2000.0)?;
    let strip = Strip::new(-B..B, elements, Grading::Cosine)?;
    let ground = ElasticGround::new(soil, strip)?;
    let edge = ground.elements()[0].length();
    let tilts = tilts(ground, PushedBlock::on_base(2.0 * B, 1.0)?, time_step, 1.5)?;
    let peak = (nearest_integer(PUSH_DURATION / time_step)..tilts.len() - 1)
        .find(|&k| tilts[k + 1] < tilts[k])
        .ok_or("the block does not turn back")?;
    let before = tilts[peak - 1];
    let tilt = tilts[peak];
    let after = tilts[peak + 1];
    let peak_step = peak as f64 + 0.5 * (before - after) / (before - 2.0 * tilt + after);
    let last_sample_before = (peak..tilts.len() - 1)
        .find(|&k| tilts[k + 1] < 0.0)
        .ok_or("the block does not come back")?;
    let crossing_step = last_sample_before as f64
        + tilts[last_sample_before] / (tilts[last_sample_before] - tilts[last_sample_before + 1]);
    let computed = (crossing_step - peak_step) * time_step;
    let rate = (weight() * H / (inertia() + mass() * B * B)).sqrt();
    let housner = (1.0 / (1.0 - tilt * H / B)).acosh() / rate;
    let lift_off = (1.0 - poisson) * weight() / (PI * soil.shear_modulus() * B);
    // Pressure on the last element acts at its middle, about which the block rotates.
    let slenderness = (B - 0.5 * edge) / H;
    let quarter_on_soil = quarter_period(tilt, lift_off, slenderness, rate);
    Ok(QuarterRatios {
        rigid_base: computed / housner,
        deformable_soil: computed / quarter_on_soil,
    })
}

/// Largest tilt between two times.
fn peak_tilt(tilts: &[f64], from: f64, to: f64) -> f64 {
    let part =
        &tilts[nearest_integer(from / SAMPLE_INTERVAL)..=nearest_integer(to / SAMPLE_INTERVAL)];
    part.iter().fold(0.0_f64, |largest, tilt| worse(largest, tilt.abs()))
}

/// Tilts of the runs whose errors are averaged.
fn runs(time_step: f64, duration: f64) -> Result<Vec<Vec<f64>>, AnyError> {
    let factors = (0..RUN_COUNT).map(|k| 1.0 + k as f64 * PUSH_INCREMENT);
    factors.map(|factor| on_corners(time_step, duration, factor)).collect()
}

fn run(short: bool) -> Result<ValidationOutcome, AnyError> {
    let duration = if short { 5.0 } else { 6.5 };
    let block = Rocker { half_width: B, mass: mass(), height: H, inertia: inertia() };
    let (reference, impacts) = block.tilts(push, SAMPLE_INTERVAL, duration);
    if impacts.len() <= IMPACT_COUNT {
        return Err("fewer impacts than are compared".into());
    }
    let mean = |sum: f64| sum / RUN_COUNT as f64;
    let mut tilt = 0.0;
    let mut time_error = 0.0;
    let mut peaks = 0.0;
    let fine = runs(2e-5, duration)?;
    for tilts in &fine {
        let times = crossings(tilts, SAMPLE_INTERVAL);
        if times.len() < IMPACT_COUNT {
            return Err("fewer impacts than are compared".into());
        }
        tilt += relative(tilts, &reference);
        let differences = times.iter().zip(&impacts[..IMPACT_COUNT]).map(|(a, b)| (a - b).abs());
        time_error += differences.fold(0.0, worse);
        let peak_errors = impacts[..=IMPACT_COUNT].windows(2).map(|pair| {
            let expected = peak_tilt(&reference, pair[0], pair[1]);
            (peak_tilt(tilts, pair[0], pair[1]) / expected - 1.0).abs()
        });
        peaks += peak_errors.fold(0.0, worse);
    }
    let mut checks = vec![
        ValidationCheck::below("two corners: tilt, relative L2", mean(tilt), 2e-2),
        ValidationCheck::below("two corners: times of 8 impacts, s", mean(time_error), 6e-3),
        ValidationCheck::below(
            "two corners: 8 amplitudes between impacts, relative",
            mean(peaks),
            8e-3,
        ),
    ];
    // The error of the step is large, because an impact lasts a fraction of 0.1 ms.
    for (step, name, limit) in [(1e-4, "0.1", 4.5e-2), (5e-4, "0.5", 0.12)] {
        let runs = runs(step, duration)?;
        let error = runs.iter().map(|tilts| relative(tilts, &reference)).sum();
        let name = format!("two corners, Δt = {name} ms: tilt, relative L2");
        checks.push(ValidationCheck::below(name, mean(error), limit));
    }
    let list = [
        (100.0, 16, 1.8e-2, 5.5e-3),
        (200.0, 16, 7.7e-3, 5e-3),
        (400.0, 16, 6.5e-3, 2.1e-3),
        (400.0, 32, 2.1e-3, 1.5e-3),
        (800.0, 16, 6.5e-3, 8e-4),
    ];
    let list = if short { &list[2..3] } else { &list[..] };
    let mut over_housner = Vec::new();
    let mut over_deformable = Vec::new();
    for &(speed, elements, housner, yielding) in list {
        let ratios = quarter_ratios(speed, elements)?;
        let scene = format!("c_S = {speed} m/s, {elements} elements: quarter period");
        // Rocking on soil is slower than on a rigid base.
        checks.push(ValidationCheck::within(
            format!("{scene} over Housner's"),
            ratios.rigid_base,
            1.0..=1.0 + housner,
        ));
        let name = format!("{scene} against yielding soil");
        checks.push(ValidationCheck::below(name, (ratios.deformable_soil - 1.0).abs(), yielding));
        if elements == 16 {
            over_housner.push((speed, 100.0 * (ratios.rigid_base - 1.0)));
            over_deformable.push((speed, 100.0 * (ratios.deformable_soil - 1.0)));
        }
    }
    let left = FigurePanel::new("time, s", "tilt, mrad")
        .reference(
            "Housner 1963, integrated apart",
            CURVE_RED,
            milli_curve(SAMPLE_INTERVAL, &reference),
        )
        .line(
            "basemat, two corners on a stiff bed",
            CURVE_BLUE,
            milli_curve(SAMPLE_INTERVAL, &fine[0]),
        );
    let right = FigurePanel::new("c_S of the soil, m/s", "quarter period too long by, %")
        .legend(SeriesLabelPosition::UpperRight)
        .room(0.15, 0.15)
        .crosses("against Housner's rigid base", CURVE_RED, over_housner)
        .circles("against soil that yields without inertia", CURVE_BLUE, over_deformable);
    let title = "Block 1 m × 4 m, pushed for half a second, then free: tilt (left); 16 elements on the half-plane (right)";
    Ok(ValidationOutcome { checks, figure: Figure::new(title, 2, vec![left, right]) })
}
