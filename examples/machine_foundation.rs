//! A machine with a rotating unbalance on a block foundation.
//!
//! ```text
//! cargo run --release --example machine_foundation
//! ```
//!
//! The unbalance m e rotates at the top of the block and causes a force of m e ω² in its direction. For a bonded block,
//! the amplitude of steady vibration follows from (K(ω) − ω² M) u = F with the impedances K of the ground. Runs in the
//! time domain are compared with this amplitude. In a run-up through resonance, the machine lifts the block at high
//! speed, and a computation in the frequency domain no longer applies.

use std::f64::consts::TAU;

use basemat::bem::layered::{StripContact, StripImpedance};
use basemat::coupled::{Load, SimulationBuilder};
use basemat::prelude::*;
use basemat::{Complex, Result, unobserved};

/// Width of the block, m.
const BLOCK_WIDTH: f64 = 6.0;
/// Height of the block, m.
const BLOCK_HEIGHT: f64 = 2.0;
/// Unbalance m e per metre of thickness, kg·m/m.
const UNBALANCE_MOMENT: f64 = 14.0;
/// Time step, s.
const TIME_STEP: f64 = 1.0e-3;

fn foundation() -> Result<RigidBlock> {
    RigidBlock::new(BLOCK_WIDTH, BLOCK_HEIGHT, 2400.0)
}

fn ground() -> Result<ElasticGround> {
    let soil = Soil::from_shear_wave_speed(180.0, 0.33, 1900.0)?;
    ElasticGround::new(soil, Strip::graded(-0.5 * BLOCK_WIDTH..0.5 * BLOCK_WIDTH, 16)?)
}

/// Angle (rad) and speed (rad/s) of the unbalance at one instant.
struct Rotation {
    angle: f64,
    speed: f64,
}

/// Builder of a simulation of the block under an unbalance; `rotation` is a function of time (s).
fn machine(
    rotation: impl Fn(f64) -> Rotation + Clone + Send + 'static,
) -> Result<SimulationBuilder> {
    let block = foundation()?;
    let top = block.horizontal_at(BLOCK_HEIGHT);
    let unbalance = rotation.clone();
    let horizontal = Load::new(top.clone(), move |t| {
        let Rotation { angle, speed } = unbalance(t);
        UNBALANCE_MOMENT * speed.powi(2) * angle.cos()
    });
    let vertical = Load::new(block.vertical_at(0.0), move |t| {
        let Rotation { angle, speed } = rotation(t);
        UNBALANCE_MOMENT * speed.powi(2) * angle.sin()
    });
    Ok(Simulation::builder(TIME_STEP)
        .ground(ground()?)
        .load(horizontal)
        .load(vertical)
        .probe(Probe::displacement("top", top))
        .structure(block))
}

/// Amplitude (m) of the top at a steady `frequency` (Hz), from the last ten turns of a run in the time domain.
fn time_domain_amplitude(frequency: f64) -> Result<f64> {
    let omega = TAU * frequency;
    // The force grows during ten turns of the machine. During the next thirty turns the vibration becomes steady.
    let builder = machine(move |t| Rotation {
        angle: omega * t,
        speed: omega * (0.1 * frequency * t).min(1.0).sqrt(),
    })?;
    let mut simulation = builder.interface(Bonded).build()?;
    simulation.run(simulation.steps_for(40.0 / frequency), |_| {})?;
    let steps = simulation.steps_for(10.0 / frequency);
    let mut series = Vec::with_capacity(steps);
    simulation.run(steps, |state| series.push((state.time, state.probes[0])))?;
    let mut mean = 0.0;
    for (_, displacement) in &series {
        mean += displacement / steps as f64;
    }
    let mut cosine = 0.0;
    let mut sine = 0.0;
    for (time, displacement) in &series {
        cosine += 2.0 * (displacement - mean) * (omega * time).cos() / steps as f64;
        sine += 2.0 * (displacement - mean) * (omega * time).sin() / steps as f64;
    }
    Ok(cosine.hypot(sine))
}

/// Amplitude of the top by (K(ω) − ω² M) u = F, at the frequency of `impedance`.
///
/// The components of u are the horizontal displacement of the base and its rotation to the right.
fn frequency_domain_amplitude(impedance: &StripImpedance) -> Result<f64> {
    let block = foundation()?;
    let omega_squared = (TAU * impedance.frequency).powi(2);
    let mass = block.total_mass();
    let center_height = 0.5 * BLOCK_HEIGHT;
    let sway = impedance.horizontal - Complex::real(omega_squared * mass);
    let coupling = impedance.coupling - Complex::real(omega_squared * (mass * center_height));
    let rocking = impedance.rocking - Complex::real(omega_squared * block.base_inertia());
    // Displacement and rotation under the force at the top, by Cramer's rule.
    let force = UNBALANCE_MOMENT * omega_squared;
    let determinant = sway * rocking - coupling * coupling;
    let top = rocking - coupling * (2.0 * BLOCK_HEIGHT) + sway * (BLOCK_HEIGHT * BLOCK_HEIGHT);
    Ok((top * force * determinant.inverse()).abs())
}

/// Runs the machine up from 2 to 25 Hz in 12 s.
fn run_up(law: impl InterfaceLaw + 'static) -> Result<Run> {
    let first_speed = TAU * 2.0;
    let speed_rate = TAU * 23.0 / 12.0;
    let builder = machine(move |t| Rotation {
        angle: first_speed * t + 0.5 * speed_rate * t * t,
        speed: first_speed + speed_rate * t,
    })?;
    let mut simulation = builder.interface(law).build()?;
    simulation.run(simulation.steps_for(12.0), |_| {})
}

fn main() -> Result<()> {
    let frequencies = [4.0, 6.0, 8.0, 10.0, 12.0, 16.0, 20.0, 25.0];
    println!("Top of the block, mm, bonded\n\n  Hz   time domain   frequency domain   difference");
    // 2 % is the limit for errors of the time step and of the elements.
    for impedance in ground()?.impedances(&frequencies, StripContact::Bonded, &mut unobserved)? {
        let frequency = impedance.frequency;
        let reference = frequency_domain_amplitude(&impedance)?;
        let time_domain = time_domain_amplitude(frequency)?;
        let error = time_domain / reference - 1.0;
        println!(
            "{frequency:4}{:14.4}{:19.4}{:11.2} %",
            1e3 * time_domain,
            1e3 * reference,
            1e2 * error
        );
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
