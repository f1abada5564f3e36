//! GOAL: the fixed-base run, T̃/T and the damping of the soil–structure system follow mechanics.
//! SCENE: shear buildings on springs and dashpots and on the half-plane, fixed and free.
//! REFERENCE: exact response to a piecewise linear acceleration (Nigam and Jennings), springs in series, roots of the
//! characteristic equation.

use std::f64::consts::TAU;

use basemat::analyses::interaction;
use basemat::bem::{ElasticGround, SpringGround};
use basemat::coupled::{Probe, SimulationBuilder, Warning};
use basemat::interface::{Bonded, Coulomb};
use basemat::motion::{Record, el_centro_1940};
use basemat::results::{Quantity, Recorder};
use basemat::structure::{RigidBlock, ShearBuilding, Storey};
use basemat::{Complex, Error, Result, Simulation, Soil};

pub(super) const BASE_WIDTH: f64 = 8.0;
const FLOOR_MASS: f64 = 80.0e3;
const FLOOR_HEIGHT: f64 = 9.0;

/// Stiffness of columns that carry the floor with this period on a fixed base.
fn column_stiffness(period: f64) -> f64 {
    FLOOR_MASS * (TAU / period).powi(2)
}

/// A mass on columns, of this period and damping on a fixed base.
///
/// `mass_ratio`: mass of the floor over the mass of the base.
fn oscillator(period: f64, ratio: f64, mass_ratio: f64) -> ShearBuilding {
    let storey = Storey::new(FLOOR_HEIGHT, FLOOR_MASS, column_stiffness(period));
    let base_mass = FLOOR_MASS / mass_ratio;
    let base_inertia = base_mass * BASE_WIDTH * BASE_WIDTH / 12.0;
    let building = ShearBuilding::new(BASE_WIDTH, base_mass, base_inertia, &[storey]).unwrap();
    building.with_stiffness_damping(ratio).unwrap()
}

fn largest_absolute(values: &[f64]) -> f64 {
    values.iter().fold(0.0_f64, |largest, value| largest.max(value.abs()))
}

pub(super) fn half_plane(building: ShearBuilding, step: f64, record: &Record) -> SimulationBuilder {
    let soil = Soil::new(80.0e6, 0.33, 1900.0).unwrap();
    Simulation::builder(step)
        .ground(ElasticGround::under(soil, &building, 8).unwrap())
        .structure(building)
        .interface(Coulomb::new(0.5).unwrap())
        .motion(record.clone())
}

/// Exact displacements of an oscillator at the samples of a record that is linear between them.
///
/// They solve ü + 2ζω u̇ + ω² u = −a(t) over each interval (N. C. Nigam and P. C. Jennings, 1969).
fn exact_displacements(record: &Record, period: f64, ratio: f64) -> Vec<f64> {
    let w = TAU / period;
    let dt = record.time_step();
    let wd = w * (1.0 - ratio * ratio).sqrt();
    let mut u = 0.0;
    let mut v = 0.0;
    let mut displacements = vec![0.0];
    for pair in record.accelerations().windows(2) {
        // Particular solution c + s t of the straight line between two samples.
        let slope = (pair[1] - pair[0]) / dt;
        let s = -slope / (w * w);
        let c = (-pair[0] - 2.0 * ratio * w * s) / (w * w);
        let a = u - c;
        let b = (v - s + ratio * w * (u - c)) / wd;
        let decay = (-ratio * w * dt).exp();
        let cos = (wd * dt).cos();
        let sin = (wd * dt).sin();
        u = decay * (a * cos + b * sin) + c + s * dt;
        v = decay * ((b * wd - ratio * w * a) * cos - (a * wd + ratio * w * b) * sin) + s;
        displacements.push(u);
    }
    displacements
}

/// Largest error of the drift on a fixed base, in this many steps per sample of the record.
fn drift_error(record: &Record, period: f64, ratio: f64, steps_per_sample: u32) -> f64 {
    let expected = exact_displacements(record, period, ratio);
    let max_magnitude = largest_absolute(&expected);
    let building = oscillator(period, ratio, 4.0);
    let probe = Probe::displacement("drift", building.drift(0).unwrap());
    let time_step = record.time_step() / f64::from(steps_per_sample);
    let builder = half_plane(building, time_step, record);
    let mut simulation = builder.probe(probe).on_fixed_base().build().unwrap();
    let recorder = Recorder::new().every(steps_per_sample as usize);
    let mut series = recorder.start(&simulation).unwrap();
    let steps = (expected.len() - 1) * steps_per_sample as usize;
    let run = simulation.run(steps, |state| series.record(state)).unwrap();
    assert!(run.energy_error < 1e-9 && run.whole.uplifted_fraction.highest.value == 0.0);
    assert!(run.whole.base_rotation.magnitude() < 1e-6 * max_magnitude / BASE_WIDTH);
    let pairs = series.probe("drift").unwrap().iter().zip(&expected);
    let errors: Vec<f64> = pairs.map(|(computed, expected)| computed - expected).collect();
    largest_absolute(&errors) / max_magnitude
}

/// Errors fall to a quarter with half the step, as by the midpoint rule.
#[test]
fn an_oscillator_on_a_fixed_base_moves_as_by_nigam_and_jennings() {
    let record = el_centro_1940().trimmed(0.0, 8.0).unwrap();
    for (period, ratio) in [(0.5, 0.05), (1.2, 0.02)] {
        let coarse = drift_error(&record, period, ratio, 2);
        let fine = drift_error(&record, period, ratio, 4);
        println!("T {period} s: {coarse:.2e}, {fine:.2e}");
        assert!(fine < 4e-3 && (2.8..5.5).contains(&(coarse / fine)), "{coarse:e} {fine:e}");
    }
}

/// Stiffness of the springs below the base, Pa/m.
const VERTICAL_BEDDING: f64 = 3.0e7;
const HORIZONTAL_BEDDING: f64 = 1.5e7;
const SPRING_COUNT: usize = 16;

/// Stiffness of the springs along the base.
fn sway_stiffness() -> f64 {
    HORIZONTAL_BEDDING * BASE_WIDTH
}

/// Stiffness of the springs about the middle of the base.
fn rocking_stiffness() -> f64 {
    let count = SPRING_COUNT as f64;
    VERTICAL_BEDDING * BASE_WIDTH.powi(3) / 12.0 * (1.0 - (count * count).recip())
}

/// (T̃/T)² of a mass on columns and springs in series.
fn period_ratio_squared(period: f64) -> f64 {
    let stiffness = column_stiffness(period);
    1.0 + stiffness / sway_stiffness() + stiffness * FLOOR_HEIGHT.powi(2) / rocking_stiffness()
}

fn on_springs(period: f64, ratio: f64, dashpots: [f64; 2]) -> Result<SimulationBuilder> {
    let building = oscillator(period, ratio, 1e5);
    let ground =
        SpringGround::under(&building, SPRING_COUNT, VERTICAL_BEDDING, HORIZONTAL_BEDDING)?;
    Ok(Simulation::builder(0.01)
        .ground(ground.with_dashpots(dashpots[0], dashpots[1])?)
        .structure(building)
        .interface(Coulomb::new(0.5)?)
        .motion(el_centro_1940()))
}

/// T̃/T = √(1 + k/k_x + k h²/k_θ) of a mass on springs in series.
#[test]
fn periods_on_springs_are_those_of_springs_in_series() {
    for period in [0.3, 0.6, 1.5] {
        let result = interaction(3.0, || on_springs(period, 0.0, [0.0; 2])).unwrap();
        let expected = period_ratio_squared(period).sqrt();
        let mode = result.modes[0];
        println!(
            "T {period} s: {:.6} for {expected:.6}, damping {:e}",
            mode.period_ratio(),
            mode.damping
        );
        assert!((mode.fixed_period / period - 1.0).abs() < 1e-5, "{mode:?}");
        assert!((mode.period_ratio() / expected - 1.0).abs() < 2e-4, "{mode:?}");
        assert!(mode.damping.abs() < 1e-4 && mode.fixed_damping == 0.0, "{mode:?}");
    }
}

/// Largest displacement of an undamped oscillator of this period.
fn peak_displacement(record: &Record, period: f64) -> f64 {
    largest_absolute(&exact_displacements(record, period, 0.0))
}

/// Ratios of base shear are those of two oscillators of the periods T̃ and T; the moment is h times the shear.
#[test]
fn forces_over_fixed_base_forces_are_those_of_two_oscillators() {
    let duration = 6.0;
    let record = el_centro_1940().trimmed(0.0, duration).unwrap();
    for period in [0.6, 1.0] {
        let result =
            interaction(duration, || Ok(on_springs(period, 0.0, [0.0; 2])?.interface(Bonded)))
                .unwrap();
        let softening = period_ratio_squared(period);
        let expected = peak_displacement(&record, period * softening.sqrt())
            / (softening * peak_displacement(&record, period));
        let shear = result.ratio(Quantity::BaseShear);
        let moment = result.ratio(Quantity::BaseMoment);
        println!("T {period} s: shear {shear:.4}, moment {moment:.4} for {expected:.4}");
        assert!((shear / expected - 1.0).abs() < 0.02 && (moment / expected - 1.0).abs() < 0.02);
        for run in [&result.on_ground, &result.on_fixed_base] {
            let shear = run.whole.base_shear.magnitude();
            let moment = run.whole.base_moment.magnitude();
            assert!((moment / (FLOOR_HEIGHT * shear) - 1.0).abs() < 1e-3, "{moment} {shear}");
        }
    }
}

/// Columns, sway and rocking of the base as springs with dashpots in series.
struct DampedSprings {
    columns: [f64; 2],
    sway: [f64; 2],
    rocking: [f64; 2],
}

impl DampedSprings {
    /// m s² + 1/(1/k + 1/(k_x + s c_x) + h²/(k_θ + s c_θ)), k with the damping of the columns.
    fn characteristic(&self, s: Complex) -> Complex {
        let impedance = |[stiffness, damping]: [f64; 2]| Complex::new(stiffness, 0.0) + s * damping;
        let flexibility = impedance(self.columns).inverse()
            + impedance(self.sway).inverse()
            + impedance(self.rocking).inverse() * FLOOR_HEIGHT.powi(2);
        s * s * FLOOR_MASS + flexibility.inverse()
    }

    /// Root by Newton's method near an estimate, with the slope by a difference.
    fn root(&self, estimate: Complex) -> Complex {
        let mut root = estimate;
        for _ in 0..50 {
            let difference = root * 1e-6;
            let slope = (self.characteristic(root + difference)
                - self.characteristic(root - difference))
                / (difference * 2.0);
            root = root - self.characteristic(root) / slope;
        }
        root
    }
}

/// Period and damping on dashpots are those of the root of the characteristic equation.
#[test]
fn damping_on_dashpots_is_that_of_the_characteristic_equation() {
    let dashpots = [6.0e5, 4.0e5];
    for (period, ratio) in [(0.4, 0.05), (0.8, 0.02)] {
        let stiffness = column_stiffness(period);
        let springs = DampedSprings {
            columns: [stiffness, 2.0 * ratio * stiffness * period / TAU],
            sway: [sway_stiffness(), dashpots[1] * BASE_WIDTH],
            rocking: [rocking_stiffness(), rocking_stiffness() / VERTICAL_BEDDING * dashpots[0]],
        };
        let root = springs.root(Complex::new(-0.05, 1.0) * (0.7 * TAU / period));
        let expected_period = TAU / root.abs();
        let expected_damping = -root.re / root.abs();
        let result = interaction(3.0, || on_springs(period, ratio, dashpots)).unwrap();
        let mode = result.modes[0];
        println!("{expected_period} {expected_damping} for {mode:?}");
        assert!((mode.fixed_damping - ratio).abs() < 1e-6 * ratio.max(0.1), "{mode:?}");
        assert!((mode.period / expected_period - 1.0).abs() < 2e-3, "{mode:?}");
        assert!((mode.damping - expected_damping).abs() < 2e-3, "{mode:?}");
        let foundation_damping = mode.damping - ratio / mode.period_ratio().powi(2);
        assert!((mode.foundation_damping() - foundation_damping).abs() < 1e-6);
        assert!(result.ratio(Quantity::BaseShear) > 0.0);
        assert!(result.to_string().contains("T̃/T = "));
    }
}

#[test]
fn interaction_does_not_change_the_run_and_names_errors() {
    let record = el_centro_1940();
    let scene = || Ok(half_plane(oscillator(0.5, 0.05, 4.0), 0.01, &record));
    let result = interaction(2.0, scene).unwrap();
    let run = scene().unwrap().build().unwrap().run(200, |_| {}).unwrap();
    assert_eq!(result.on_ground.whole, run.whole);
    // Tension is expected on a fixed base.
    let on_fixed_base = &result.on_fixed_base;
    for warning in &on_fixed_base.warnings {
        assert!(!matches!(warning, Warning::Tension { .. }), "{on_fixed_base}");
    }
    assert!(matches!(result.probe_ratio("roof"), Err(Error::Name { .. })));
    assert!(interaction(f64::NAN, scene).is_err());
}

fn block_on_springs() -> Result<SimulationBuilder> {
    let block = RigidBlock::new(4.0, 6.0, 2000.0)?;
    Ok(Simulation::builder(0.01)
        .ground(SpringGround::under(&block, 8, 2e7, 1e7)?)
        .structure(block)
        .interface(Coulomb::new(0.4)?)
        .motion(el_centro_1940()))
}

/// A rigid block has no mode; on a fixed base its shear is m a.
#[test]
fn a_rigid_block_has_no_mode() {
    let result = interaction(2.0, block_on_springs).unwrap();
    assert!(result.modes.is_empty() && result.to_string().contains("rigid on its base"));
    let peak = largest_absolute(&el_centro_1940().accelerations()[..100]);
    let shear_ratio = result.on_fixed_base.whole.base_shear.magnitude() / (peak * 48.0e3);
    assert!((0.9..1.15).contains(&shear_ratio), "{shear_ratio}");
}
