//! GOAL: the fixed-base run, T̃/T and the damping of the soil–structure system follow mechanics. SCENE: shear buildings
//! and a flexible base on springs and dashpots and on the half-plane, held and free. REFERENCE: exact response to a
//! piecewise linear acceleration (Nigam and Jennings), Runge–Kutta's method on the held storeys, springs in series,
//! roots of the characteristic equation.

use std::f64::consts::TAU;

use basemat::analyses::interaction;
use basemat::bem::{ElasticGround, SpringGround};
use basemat::coupled::{Coordinates, Probe, SimulationBuilder, Warning};
use basemat::interface::{Bonded, Coulomb};
use basemat::motion::{Record, el_centro_1940};
use basemat::results::{Quantity, Recorder};
use basemat::structure::{
    Base, BaseNode, DofCombination, RigidBlock, ShearBuilding, Storey, Structure, Triplets,
};
use basemat::{Complex, Error, Result, Simulation, Soil};

const WIDTH: f64 = 8.0;
const MASS: f64 = 80.0e3;
const HEIGHT: f64 = 9.0;

/// A mass on columns, of this period and damping on a fixed base, with a base as heavy as that over `light`.
fn oscillator(period: f64, ratio: f64, light: f64) -> ShearBuilding {
    let stiffness = MASS * (TAU / period).powi(2);
    let storey = Storey::new(HEIGHT, MASS, stiffness);
    let base = MASS / light;
    let building = ShearBuilding::new(WIDTH, base, base * WIDTH * WIDTH / 12.0, &[storey]).unwrap();
    building.with_stiffness_damping(ratio).unwrap()
}

fn half_plane(building: ShearBuilding, step: f64, record: &Record) -> SimulationBuilder {
    let soil = Soil::new(80.0e6, 0.33, 1900.0).unwrap();
    Simulation::builder(step)
        .ground(ElasticGround::under(soil, &building, 8).unwrap())
        .structure(building)
        .interface(Coulomb::new(0.5).unwrap())
        .motion(record.clone())
}

/// Displacements of an oscillator under the record, linear between its samples, at each of these samples: the exact
/// solution of ü + 2ζω u̇ + ω² u = −a(t) over each interval (N. C. Nigam and P. C. Jennings, 1969).
fn exact(record: &Record, period: f64, ratio: f64) -> Vec<f64> {
    let (w, dt) = (TAU / period, record.time_step());
    let wd = w * (1.0 - ratio * ratio).sqrt();
    let (mut u, mut v, mut found) = (0.0, 0.0, vec![0.0]);
    for pair in record.accelerations().windows(2) {
        // Particular solution c + s t of the straight line between two samples.
        let slope = (pair[1] - pair[0]) / dt;
        let s = -slope / (w * w);
        let c = (-pair[0] - 2.0 * ratio * w * s) / (w * w);
        let (a, b) = (u - c, (v - s + ratio * w * (u - c)) / wd);
        let (decay, cos, sin) = ((-ratio * w * dt).exp(), (wd * dt).cos(), (wd * dt).sin());
        u = decay * (a * cos + b * sin) + c + s * dt;
        v = decay * ((b * wd - ratio * w * a) * cos - (a * wd + ratio * w * b) * sin) + s;
        found.push(u);
    }
    found
}

/// Errors fall to a quarter with half the step, as in the midpoint rule.
#[test]
fn a_held_oscillator_is_nigams_and_jennings() {
    let record = el_centro_1940().trimmed(0.0, 8.0).unwrap();
    for (period, ratio) in [(0.5, 0.05), (1.2, 0.02)] {
        let known = exact(&record, period, ratio);
        let largest = known.iter().fold(0.0_f64, |most, x| most.max(x.abs()));
        let error = |parts: u32| {
            let building = oscillator(period, ratio, 4.0);
            let drift = building.drift(0).unwrap();
            let probe = Probe::displacement("drift", drift);
            let builder = half_plane(building, record.time_step() / f64::from(parts), &record);
            let mut simulation = builder.probe(probe).on_fixed_base().build().unwrap();
            let mut series = Recorder::new().every(parts as usize).start(&simulation).unwrap();
            let steps = (known.len() - 1) * parts as usize;
            let run = simulation.run(steps, |state| series.record(state)).unwrap();
            assert!(run.energy_error < 1e-9 && run.whole.uplifted_fraction.highest.value == 0.0);
            assert!(run.whole.base_rotation.magnitude() < 1e-6 * largest / WIDTH);
            let pairs = series.probe("drift").unwrap().iter().zip(&known);
            pairs.fold(0.0_f64, |most, (found, known)| most.max((found - known).abs())) / largest
        };
        let [coarse, fine] = [error(2), error(4)];
        println!("T {period} s: {coarse:.2e}, {fine:.2e}");
        assert!(fine < 4e-3 && (2.8..5.5).contains(&(coarse / fine)), "{coarse:e} {fine:e}");
    }
}

/// Drifts and base shear of four held storeys with dashpots.
#[test]
fn a_held_building_is_that_of_runge_and_kutta() {
    const STOREYS: usize = 4;
    let record = el_centro_1940().trimmed(0.0, 6.0).unwrap();
    let masses = [30.0e3, 28.0e3, 25.0e3, 20.0e3];
    let springs = [60.0e6, 50.0e6, 45.0e6, 30.0e6];
    let storeys: Vec<_> = (0..STOREYS)
        .map(|k| Storey { damping: 4e-3 * springs[k], ..Storey::new(3.0, masses[k], springs[k]) })
        .collect();
    // Floors relative to the base, and their velocities.
    let rate = |state: &[f64; 2 * STOREYS], ground: f64| {
        let mut out = [0.0; 2 * STOREYS];
        let force = |k: usize| {
            let below = |from: usize| if k == 0 { 0.0 } else { state[from + k - 1] };
            springs[k] * (state[k] - below(0) + 4e-3 * (state[STOREYS + k] - below(STOREYS)))
        };
        for k in 0..STOREYS {
            let above = if k + 1 < STOREYS { force(k + 1) } else { 0.0 };
            out[k] = state[STOREYS + k];
            out[STOREYS + k] = (above - force(k)) / masses[k] - ground;
        }
        out
    };
    let (mut state, mut drift, mut shear) = ([0.0; 2 * STOREYS], 0.0_f64, 0.0_f64);
    let parts = 40;
    let step = record.time_step() / f64::from(parts);
    for n in 0..300 * parts {
        let time = f64::from(n) * step;
        let ground = |t: f64| record.at(t).acceleration;
        let moved = |by: &[f64; 2 * STOREYS], h: f64| std::array::from_fn(|k| state[k] + h * by[k]);
        let k1 = rate(&state, ground(time));
        let k2 = rate(&moved(&k1, 0.5 * step), ground(time + 0.5 * step));
        let k3 = rate(&moved(&k2, 0.5 * step), ground(time + 0.5 * step));
        let k4 = rate(&moved(&k3, step), ground(time + step));
        state = std::array::from_fn(|k| {
            state[k] + step / 6.0 * (k1[k] + 2.0 * k2[k] + 2.0 * k3[k] + k4[k])
        });
        drift = drift.max((state[3] - state[2]).abs());
        shear = shear.max((springs[0] * (state[0] + 4e-3 * state[STOREYS])).abs());
    }
    let building = ShearBuilding::new(WIDTH, 1.0, 1e3, &storeys).unwrap();
    let probe = Probe::displacement("drift", building.drift(3).unwrap());
    let builder = half_plane(building, 0.0025, &record).probe(probe).on_fixed_base();
    let mut simulation = builder.build().unwrap();
    let run = simulation.run(2400, |_| {}).unwrap();
    let found = [run.probe("drift").unwrap().magnitude(), run.whole.base_shear.magnitude()];
    println!("{found:?} for {drift} {shear}");
    assert!((found[0] / drift - 1.0).abs() < 4e-3 && (found[1] / shear - 1.0).abs() < 4e-3);
}

/// Springs of the bed per metre of thickness: along the base, and about its middle for `count` elements.
const BED: [f64; 2] = [3.0e7, 1.5e7];
const COUNT: usize = 16;

fn bed() -> [f64; 2] {
    let count = COUNT as f64;
    [BED[1] * WIDTH, BED[0] * WIDTH.powi(3) / 12.0 * (1.0 - (count * count).recip())]
}

fn on_springs(period: f64, ratio: f64, dashpots: [f64; 2]) -> Result<SimulationBuilder> {
    let building = oscillator(period, ratio, 1e5);
    let ground = SpringGround::under(&building, COUNT, BED[0], BED[1])?;
    Ok(Simulation::builder(0.01)
        .ground(ground.with_dashpots(dashpots[0], dashpots[1])?)
        .structure(building)
        .interface(Coulomb::new(0.5)?)
        .motion(el_centro_1940()))
}

/// T̃/T = √(1 + k/k_x + k h²/k_θ) of a mass on springs in series.
#[test]
fn periods_on_springs_are_those_of_springs_in_series() {
    let [along, turning] = bed();
    for period in [0.3, 0.6, 1.5] {
        let found = interaction(3.0, || on_springs(period, 0.0, [0.0; 2])).unwrap();
        let stiffness = MASS * (TAU / period).powi(2);
        let known = (1.0 + stiffness / along + stiffness * HEIGHT.powi(2) / turning).sqrt();
        let mode = found.modes[0];
        println!(
            "T {period} s: {:.6} for {known:.6}, damping {:e}",
            mode.period_ratio(),
            mode.damping
        );
        assert!((mode.fixed_period / period - 1.0).abs() < 1e-5, "{mode:?}");
        assert!((mode.period_ratio() / known - 1.0).abs() < 2e-4, "{mode:?}");
        assert!(mode.damping.abs() < 1e-4 && mode.fixed_damping == 0.0, "{mode:?}");
    }
}

/// Base shears are two oscillators', of the periods T̃ and T; the moment of a mass is h times its shear.
#[test]
fn forces_over_fixed_base_forces_are_those_of_two_oscillators() {
    let ([along, turning], duration) = (bed(), 6.0);
    let record = el_centro_1940().trimmed(0.0, duration).unwrap();
    for period in [0.6, 1.0] {
        let scene = || Ok(on_springs(period, 0.0, [0.0; 2])?.interface(Bonded));
        let found = interaction(duration, scene).unwrap();
        let stiffness = MASS * (TAU / period).powi(2);
        let softened = 1.0 + stiffness / along + stiffness * HEIGHT.powi(2) / turning;
        let peak = |period: f64| {
            exact(&record, period, 0.0).iter().fold(0.0_f64, |most, x| most.max(x.abs()))
        };
        let known = peak(period * softened.sqrt()) / (softened * peak(period));
        let [shear, moment] =
            [Quantity::BaseShear, Quantity::BaseMoment].map(|own| found.ratio(own));
        println!("T {period} s: shear {shear:.4}, moment {moment:.4} for {known:.4}");
        assert!((shear / known - 1.0).abs() < 0.02 && (moment / known - 1.0).abs() < 0.02);
        for run in [&found.on_ground, &found.on_fixed_base] {
            let [shear, moment] = [&run.whole.base_shear, &run.whole.base_moment]
                .map(basemat::results::Extremes::magnitude);
            assert!((moment / (HEIGHT * shear) - 1.0).abs() < 1e-3, "{moment} {shear}");
        }
    }
}

/// Root of m s² + 1/(1/k + 1/(k_x + s c_x) + h²/(k_θ + s c_θ)) = 0, k with the damping of the columns.
#[test]
fn damping_on_dashpots_is_that_of_the_characteristic_equation() {
    let ([along, turning], dashpots) = (bed(), [6.0e5, 4.0e5]);
    let by_area = [dashpots[1] * WIDTH, turning / BED[0] * dashpots[0]];
    for (period, ratio) in [(0.4, 0.05), (0.8, 0.02)] {
        let stiffness = MASS * (TAU / period).powi(2);
        let columns = 2.0 * ratio * stiffness * period / TAU;
        let value = |s: Complex| {
            let spring = |k: f64, c: f64| Complex::new(k, 0.0) + s * c;
            let flexibility = spring(stiffness, columns).inverse()
                + spring(along, by_area[0]).inverse()
                + spring(turning, by_area[1]).inverse() * HEIGHT.powi(2);
            s * s * MASS + flexibility.inverse()
        };
        // Newton's method from the fixed base, its slope by a difference.
        let mut root = Complex::new(-0.05, 1.0) * (0.7 * TAU / period);
        for _ in 0..50 {
            let difference = root * 1e-6;
            let slope = (value(root + difference) - value(root - difference)) / (difference * 2.0);
            root = root - value(root) / slope;
        }
        let known = [TAU / root.abs(), -root.re / root.abs()];
        let found = interaction(3.0, || on_springs(period, ratio, dashpots)).unwrap();
        let mode = found.modes[0];
        println!("{known:?} for {mode:?}");
        assert!((mode.fixed_damping - ratio).abs() < 1e-6 * ratio.max(0.1), "{mode:?}");
        assert!((mode.period / known[0] - 1.0).abs() < 2e-3, "{mode:?}");
        assert!((mode.damping - known[1]).abs() < 2e-3, "{mode:?}");
        let lengthened = mode.period_ratio();
        let foundation = mode.damping - ratio / lengthened.powi(2);
        assert!((mode.foundation_damping() - foundation).abs() < 1e-6);
        assert!(found.ratio(Quantity::BaseShear) > 0.0 && found.to_string().contains("T̃/T = "));
    }
}

/// The run on the ground is that without this call, a rigid block has no mode, and faults are named.
#[test]
fn interaction_keeps_the_run_and_names_faults() {
    let record = el_centro_1940();
    let scene = || Ok(half_plane(oscillator(0.5, 0.05, 4.0), 0.01, &record));
    let found = interaction(2.0, scene).unwrap();
    let mut alone = scene().unwrap().build().unwrap();
    let run = alone.run(200, |_| {}).unwrap();
    assert_eq!(found.on_ground.whole, run.whole);
    // It is meant to be pulled.
    let pulled = |own: &Warning| matches!(own, Warning::Tension { .. });
    assert!(!found.on_fixed_base.warnings.iter().any(pulled), "{}", found.on_fixed_base);
    assert!(matches!(found.probe_ratio("roof"), Err(Error::Name { .. })));
    assert!(interaction(f64::NAN, scene).is_err());

    let block = || {
        let block = RigidBlock::new(4.0, 6.0, 2000.0)?;
        Ok(Simulation::builder(0.01)
            .ground(SpringGround::under(&block, 8, 2e7, 1e7)?)
            .structure(block)
            .interface(Coulomb::new(0.4)?)
            .motion(record.clone()))
    };
    let found = interaction(2.0, block).unwrap();
    assert!(found.modes.is_empty() && found.to_string().contains("rigid on its base"));
    // m a, to the last sample.
    let peak = record.accelerations()[..100].iter().fold(0.0_f64, |most, x| most.max(x.abs()));
    let shear = found.on_fixed_base.whole.base_shear.magnitude() / (peak * 48.0e3);
    assert!((0.9..1.15).contains(&shear), "{shear}");
}

/// A mass on the middle one of three base nodes, between which the base is soft.
struct SoftBase;

impl Structure for SoftBase {
    fn dofs(&self) -> usize {
        8
    }

    fn base(&self) -> Base {
        [0, 1, 2].map(|k| BaseNode::free(2.0 * k as f64, 2 * k, 2 * k + 1)).into()
    }

    fn mass(&self, matrix: &mut Triplets) -> Result<()> {
        (0..6).for_each(|dof| matrix.add(dof, dof, 100.0));
        (6..8).for_each(|dof| matrix.add(dof, dof, 50.0e3));
        Ok(())
    }

    fn stiffness(&self, matrix: &mut Triplets) -> Result<()> {
        for dof in 0..4 {
            matrix.add_spring(dof, dof + 2, 1.0e6);
        }
        matrix.add_spring(2, 6, 20.0e6);
        matrix.add_spring(3, 7, 200.0e6);
        Ok(())
    }
}

/// Two elements do not see the middle of the base move; it is held nevertheless.
#[test]
fn a_soft_base_is_held_at_every_node() {
    let bottom = Probe::displacement("bottom", DofCombination::from(2));
    let middle = Probe::displacement("middle", DofCombination::from(3) - DofCombination::from(1));
    let mut simulation = Simulation::builder(0.005)
        .ground(SpringGround::under(&SoftBase, 2, 2e7, 1e7).unwrap())
        .structure(SoftBase)
        .interface(Bonded)
        .motion(el_centro_1940())
        .coordinates(Coordinates::Physical)
        .probes([bottom, middle, Probe::displacement("top", 6)])
        .on_fixed_base()
        .build()
        .unwrap();
    let weight = simulation.static_displacement();
    assert!((weight[3] - weight[1]).abs() < 1e-3 * 50.0e3 * 9.81 / 2.0e6, "{weight:?}");
    let run = simulation.run(1000, |_| {}).unwrap();
    let top = run.probe("top").unwrap().magnitude();
    assert!(top > 1e-3);
    for name in ["bottom", "middle"] {
        let moved = run.probe(name).unwrap().magnitude();
        assert!(moved < 1e-4 * top, "{name} moves by {moved:e} of {top:e}");
    }
}
