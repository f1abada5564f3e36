//! A machine with a rotating unbalance on a block foundation: steady vibration against the
//! frequency domain, then a run-up through resonance with uplift.
//!
//! ```text
//! cargo run --release --example machine_foundation
//! ```
//!
//! The unbalance m e rotates at the top of the block and pulls outwards with m e ω². For a bonded block, the
//! amplitude follows from (K(ω) − ω² M) u = F with the impedances K of the ground. At high speed the machine
//! lifts the block, and the frequency domain no longer applies.

use std::f64::consts::TAU;

use basemat::bem::layered::{StripContact, StripImpedance};
use basemat::coupled::{Load, SimulationBuilder};
use basemat::prelude::*;
use basemat::{Complex, Result, unobserved};

const WIDTH: f64 = 6.0;
const HEIGHT: f64 = 2.0;
/// Unbalance m e, kg m per metre.
const UNBALANCE: f64 = 14.0;
const TIME_STEP: f64 = 1.0e-3;

fn foundation() -> Result<RigidBlock> {
    RigidBlock::new(WIDTH, HEIGHT, 2400.0)
}

fn ground() -> Result<ElasticGround> {
    let soil = Soil::from_shear_wave_speed(180.0, 0.33, 1900.0)?;
    ElasticGround::new(soil, Strip::graded(-0.5 * WIDTH..0.5 * WIDTH, 16)?)
}

/// The block under an unbalance at the angle `turned(t)` (rad) and the speed `speed(t)` (rad/s).
fn machine(
    turned: impl Fn(f64) -> f64 + Clone + Send + 'static,
    speed: impl Fn(f64) -> f64 + Clone + Send + 'static,
) -> Result<SimulationBuilder> {
    let (block, again, fast) = (foundation()?, turned.clone(), speed.clone());
    let (right, up) = (block.horizontal_at(HEIGHT), block.vertical_at(0.0));
    Ok(Simulation::builder(TIME_STEP)
        .ground(ground()?)
        .load(Load::new(right.clone(), move |t| UNBALANCE * speed(t).powi(2) * turned(t).cos()))
        .load(Load::new(up, move |t| UNBALANCE * fast(t).powi(2) * again(t).sin()))
        .probe(Probe::displacement("top", right))
        .structure(block))
}

/// Amplitude of the top at a steady `frequency` (Hz), in the time domain: the last ten turns of a run.
fn marched(frequency: f64) -> Result<f64> {
    let omega = TAU * frequency;
    // The force grows for ten turns, and the vibration becomes steady in thirty.
    let up = move |t: f64| omega * (0.1 * frequency * t).min(1.0).sqrt();
    let mut simulation = machine(move |t| omega * t, up)?.interface(Bonded).build()?;
    let steps = |turns: f64| simulation.steps_for(turns / frequency);
    let (first, rest) = (steps(40.0), steps(10.0));
    simulation.run(first, |_| {})?;
    let (mut cosine, mut sine, mut mean) = (0.0, 0.0, 0.0);
    let mut series = Vec::with_capacity(rest);
    simulation.run(rest, |state| series.push((state.time, state.probes[0])))?;
    for (_, u) in &series {
        mean += u / rest as f64;
    }
    for (time, u) in &series {
        cosine += 2.0 * (u - mean) * (omega * time).cos() / rest as f64;
        sine += 2.0 * (u - mean) * (omega * time).sin() / rest as f64;
    }
    Ok(cosine.hypot(sine))
}

/// The same amplitude by (K(ω) − ω² M) u = F.
///
/// u holds the horizontal displacement of the base and its rotation to the right.
fn in_frequency_domain(impedance: &StripImpedance) -> Result<f64> {
    let block = foundation()?;
    let square = (TAU * impedance.frequency).powi(2);
    let inertia = |mass: f64| Complex::real(square * mass);
    let (mass, height) = (block.total_mass(), 0.5 * HEIGHT);
    let sway = impedance.horizontal - inertia(mass);
    let coupling = impedance.coupling - inertia(mass * height);
    let rocking = impedance.rocking - inertia(block.base_inertia());
    // Displacement and rotation under the force at the top, by Cramer's rule.
    let force = UNBALANCE * square;
    let determinant = sway * rocking - coupling * coupling;
    let top = rocking - coupling * (2.0 * HEIGHT) + sway * (HEIGHT * HEIGHT);
    Ok((top * force * determinant.inverse()).abs())
}

/// Runs the machine up from 2 to 25 Hz in 12 s.
fn run_up(law: impl InterfaceLaw + 'static) -> Result<Run> {
    let (from, rate) = (TAU * 2.0, TAU * 23.0 / 12.0);
    let builder = machine(move |t| from * t + 0.5 * rate * t * t, move |t| from + rate * t)?;
    let mut simulation = builder.interface(law).build()?;
    simulation.run(simulation.steps_for(12.0), |_| {})
}

fn main() -> Result<()> {
    let frequencies = [4.0, 6.0, 8.0, 10.0, 12.0, 16.0, 20.0, 25.0];
    println!("Top of the block, mm, bonded\n\n  Hz   marched   frequency domain   difference");
    for impedance in ground()?.impedances(&frequencies, StripContact::Bonded, &mut unobserved)? {
        let (hertz, wanted) = (impedance.frequency, in_frequency_domain(&impedance)?);
        let found = marched(hertz)?;
        let error = found / wanted - 1.0;
        println!("{hertz:4}{:10.4}{:19.4}{:11.2} %", 1e3 * found, 1e3 * wanted, 1e2 * error);
        assert!(error.abs() < 0.02);
    }
    println!(
        "\nRun-up from 2 to 25 Hz in 12 s\n\n              top, mm   open, %   slip, mm   energy balance"
    );
    for (name, run) in [("bonded", run_up(Bonded)?), ("friction 0.5", run_up(Coulomb::new(0.5)?)?)]
    {
        println!(
            "{name:<14}{:7.3}{:10.0}{:11.3}{:9.0e}",
            1e3 * run.probes[0].extremes.magnitude(),
            1e2 * run.whole.uplifted_fraction.largest().value,
            1e3 * run.whole.largest_slip.magnitude(),
            run.energy_error
        );
    }
    Ok(())
}
