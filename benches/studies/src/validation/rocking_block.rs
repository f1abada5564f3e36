//! A rocking block: Housner's with its impacts, and the quarter period on the half-plane.

use std::f64::consts::PI;

use basemat::bem::{ElasticGround, Grading, Ground, SpringGround, Strip};
use basemat::interface::Coulomb;
use basemat::motion::STANDARD_GRAVITY;
use basemat::structure::{Base, RigidBlock, Structure, Triplets};
use basemat::{Simulation, Soil};
use plotters::prelude::SeriesLabelPosition;

use super::outcome::{Case, Check, Outcome, worse};
use crate::AnyError;
use crate::figure::{BLUE, Figure, Panel, RED};
use basemat_problems::rocking::{Rocker, crossings, quarter_period};
use basemat_problems::series::{Error, whole};

pub(crate) const CASE: Case = Case {
    name: "rocking_block",
    title: "Rocking block",
    reference: "Housner's block, integrated apart; quarter period in closed form",
    settings: "two stiff elements, Δt = 0.02 ms, means of 16 runs; half-plane, 16 and 32 cosine-graded, Δt = 2.5 ms",
    run,
};

/// Half width, half height (m), density (kg/m³).
const B: f64 = 0.5;
const H: f64 = 2.0;
const DENSITY: f64 = 2500.0;
/// The block is pushed for this long (s), with `PUSH` times the moment that lifts it at most.
const PUSHED: f64 = 0.5;
const PUSH: f64 = 1.6;
/// Runs whose errors are averaged, with pushes that differ by `BUMP` of themselves from run to run: each impact of stiff
/// bodies multiplies rounding, so that one run's errors are a draw, twice as large in one as in another.
const PUSHES: usize = 16;
const BUMP: f64 = 1e-10;
/// Impacts that are compared: later ones follow each other ever faster, until the block stands.
const IMPACTS: usize = 8;
/// Samples of histories, s.
const SAMPLE: f64 = 0.01;

fn mass() -> f64 {
    4.0 * B * H * DENSITY
}

fn weight() -> f64 {
    mass() * STANDARD_GRAVITY
}

/// About the middle of the base.
fn inertia() -> f64 {
    mass() * (B * B + H * H) / 3.0 + mass() * H * H
}

fn push(time: f64) -> f64 {
    if time < PUSHED { PUSH * weight() * B * (PI * time / PUSHED).sin() } else { 0.0 }
}

/// The block with its P–Δ effect and a factor of the push, on a base of its own width.
struct Pushed(RigidBlock, f64);

impl Pushed {
    fn on_base(width: f64, factor: f64) -> Result<Self, AnyError> {
        let central = inertia() - mass() * H * H;
        let block = RigidBlock::from_mass(width, mass(), central, H)?;
        Ok(Self(block.with_p_delta(STANDARD_GRAVITY)?, factor))
    }
}

impl Structure for Pushed {
    fn dofs(&self) -> usize {
        self.0.dofs()
    }

    fn base(&self) -> Base {
        self.0.base()
    }

    fn mass(&self, matrix: &mut Triplets) -> basemat::Result<()> {
        self.0.mass(matrix)
    }

    fn stiffness(&self, matrix: &mut Triplets) -> basemat::Result<()> {
        self.0.stiffness(matrix)
    }

    fn load(&self, time: f64, load: &mut [f64]) -> basemat::Result<()> {
        load[RigidBlock::ROTATION] += self.1 * push(time);
        Ok(())
    }
}

/// Tilts every step, the first at t = 0.
fn tilts(
    ground: impl Ground + 'static,
    structure: Pushed,
    time_step: f64,
    duration: f64,
) -> Result<Vec<f64>, AnyError> {
    let mut simulation = Simulation::builder(time_step)
        .structure(structure)
        .ground(ground)
        .interface(Coulomb::uplift_only())
        .build()?;
    let mut tilts = vec![0.0];
    let steps = whole(duration / time_step);
    let run = simulation.run(steps, |state| tilts.push(state.absolute_displacement()[2]))?;
    if run.energy_error > 1e-9 {
        return Err(format!("energy balance open by {:.1e}", run.energy_error).into());
    }
    Ok(tilts)
}

/// Housner on two elements, whose pressures act at their middles, ±b: the two corners. The bed is
/// stiff, and damped enough that a corner lands without rebound and the bed is back (c/k) within
/// 0.05 ms.
fn corners(time_step: f64, duration: f64, factor: f64) -> Result<Vec<f64>, AnyError> {
    let (stiffness, dashpot) = (4e12, 2e8);
    let bed = SpringGround::new(-2.0 * B..2.0 * B, 2, stiffness, 1e13)?
        .with_dashpots(dashpot, 0.0)?
        .with_theta(1.0)?;
    let every = whole(SAMPLE / time_step);
    let block = Pushed::on_base(4.0 * B, factor)?;
    Ok(tilts(bed, block, time_step, duration)?.into_iter().step_by(every).collect())
}

/// Difference of histories, relative to the wanted one in the L2 norm.
fn relative(found: &[f64], wanted: &[f64]) -> f64 {
    let mut error = Error::default();
    found.iter().zip(wanted).for_each(|(a, b)| error.add(*a, *b));
    error.relative()
}

/// Quarter period of free rocking on the half-plane over Housner's, and over that on a
/// half-plane without inertia.
fn quarter(speed: f64, elements: usize) -> Result<[f64; 2], AnyError> {
    let (poisson, time_step) = (1.0 / 3.0, 0.0025);
    let soil = Soil::from_wave_speeds(speed, 2.0 * speed, 2000.0)?;
    let strip = Strip::new(-B..B, elements, Grading::Cosine)?;
    let ground = ElasticGround::new(soil, strip)?;
    let edge = ground.elements()[0].length();
    let tilts = tilts(ground, Pushed::on_base(2.0 * B, 1.0)?, time_step, 1.5)?;
    let peak = (whole(PUSHED / time_step)..tilts.len() - 1)
        .find(|&k| tilts[k + 1] < tilts[k])
        .ok_or("the block does not turn back")?;
    let [before, tilt, after] = [tilts[peak - 1], tilts[peak], tilts[peak + 1]];
    let turned = peak as f64 + 0.5 * (before - after) / (before - 2.0 * tilt + after);
    let upright = (peak..tilts.len() - 1)
        .find(|&k| tilts[k + 1] < 0.0)
        .ok_or("the block does not come back")?;
    let crossed = upright as f64 + tilts[upright] / (tilts[upright] - tilts[upright + 1]);
    let found = (crossed - turned) * time_step;
    let rate = (weight() * H / (inertia() + mass() * B * B)).sqrt();
    let housner = (1.0 / (1.0 - tilt * H / B)).acosh() / rate;
    let lift_off = (1.0 - poisson) * weight() / (PI * soil.shear_modulus() * B);
    // Pressure on the last element acts at its middle: the block turns about that point.
    let slenderness = (B - 0.5 * edge) / H;
    let yielding = quarter_period(tilt, lift_off, slenderness, rate);
    Ok([found / housner, found / yielding])
}

fn run(short: bool) -> Result<Outcome, AnyError> {
    let duration = if short { 5.0 } else { 6.5 };
    let block = Rocker { half_width: B, mass: mass(), height: H, inertia: inertia() };
    let (wanted, impacts) = block.tilts(push, SAMPLE, duration);
    let peak = |tilts: &[f64], from: f64, to: f64| {
        let part = &tilts[whole(from / SAMPLE)..=whole(to / SAMPLE)];
        part.iter().fold(0.0_f64, |most, tilt| worse(most, tilt.abs()))
    };
    if impacts.len() <= IMPACTS {
        return Err("fewer impacts than are compared".into());
    }
    let runs = |time_step: f64| -> Result<Vec<_>, AnyError> {
        let factors = (0..PUSHES).map(|k| 1.0 + k as f64 * BUMP);
        factors.map(|factor| corners(time_step, duration, factor)).collect()
    };
    let mean = |sum: f64| sum / PUSHES as f64;
    let (mut tilt, mut off, mut peaks) = (0.0, 0.0, 0.0);
    let fine = runs(2e-5)?;
    for found in &fine {
        let times = crossings(found, SAMPLE);
        if times.len() < IMPACTS {
            return Err("fewer impacts than are compared".into());
        }
        tilt += relative(found, &wanted);
        let apart = times.iter().zip(&impacts[..IMPACTS]).map(|(a, b)| (a - b).abs());
        off += apart.fold(0.0, worse);
        let between = impacts[..=IMPACTS].windows(2).map(|pair| {
            let [a, b] = [found, &wanted].map(|tilts| peak(tilts, pair[0], pair[1]));
            (a / b - 1.0).abs()
        });
        peaks += between.fold(0.0, worse);
    }
    let mut checks = vec![
        Check::below("two corners: tilt, relative L2", mean(tilt), 2e-2),
        Check::below("two corners: times of 8 impacts, s", mean(off), 6e-3),
        Check::below("two corners: 8 amplitudes between impacts, relative", mean(peaks), 8e-3),
    ];
    // The step's share: an impact lasts a fraction of 0.1 ms.
    for (step, name, limit) in [(1e-4, "0.1", 4.5e-2), (5e-4, "0.5", 0.12)] {
        let error = runs(step)?.iter().map(|found| relative(found, &wanted)).sum();
        let name = format!("two corners, Δt = {name} ms: tilt, relative L2");
        checks.push(Check::below(name, mean(error), limit));
    }
    let list = [
        (100.0, 16, 1.8e-2, 5.5e-3),
        (200.0, 16, 7.7e-3, 5e-3),
        (400.0, 16, 6.5e-3, 2.1e-3),
        (400.0, 32, 2.1e-3, 1.5e-3),
        (800.0, 16, 6.5e-3, 8e-4),
    ];
    let list = if short { &list[2..3] } else { &list[..] };
    let (mut over_housner, mut over_yielding) = (Vec::new(), Vec::new());
    for &(speed, elements, housner, yielding) in list {
        let [rigid, soft] = quarter(speed, elements)?;
        let scene = format!("c_S = {speed} m/s, {elements} elements: quarter period");
        // Slower than on a rigid base, never faster.
        checks.push(Check::within(format!("{scene} over Housner's"), rigid, 1.0..=1.0 + housner));
        let name = format!("{scene} against yielding soil");
        checks.push(Check::below(name, (soft - 1.0).abs(), yielding));
        if elements == 16 {
            over_housner.push((speed, 100.0 * (rigid - 1.0)));
            over_yielding.push((speed, 100.0 * (soft - 1.0)));
        }
    }
    let points = |tilts: &[f64]| {
        let each = tilts.iter().enumerate();
        each.map(|(k, tilt)| (k as f64 * SAMPLE, 1e3 * tilt)).collect::<Vec<_>>()
    };
    let left = Panel::new("time, s", "tilt, mrad")
        .reference("Housner 1963, integrated apart", RED, points(&wanted))
        .line("basemat, two corners on a stiff bed", BLUE, points(&fine[0]));
    let right = Panel::new("c_S of the soil, m/s", "quarter period too long by, %")
        .legend(SeriesLabelPosition::UpperRight)
        .room(0.15, 0.15)
        .crosses("against Housner's rigid base", RED, over_housner)
        .circles("against soil that yields without inertia", BLUE, over_yielding);
    let title = "Block 1 m × 4 m, pushed for half a second, then free: tilt (left); 16 elements on the half-plane (right)";
    Ok(Outcome { checks, figure: Figure::new(title, 2, vec![left, right]) })
}
