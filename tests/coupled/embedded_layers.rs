//! GOAL: bodies in a trench in layers follow waves of the layers.
//! SCENE: a rigid block welded in a trench that ends in a layer on stiffer soil, under a pulse of shear waves.
//! REFERENCE: Fourier synthesis from impedances and kinematic motions, which use no free field in time.

use std::f64::consts::TAU;

use basemat::bem::embedded::{Trench, TrenchElements, TrenchGround};
use basemat::interface::Bonded;
use basemat::motion::Record;
use basemat::site::TrenchMotion;
use basemat::soil::SoilProfile;
use basemat::structure::{RigidBlock, WithWalls};
use basemat::{Complex, Simulation, Soil, unobserved};

use basemat_problems::profiles::gmb;

const BLOCK_HEIGHT: f64 = 3.0;
const BLOCK_MASS: f64 = 2.0 * BLOCK_HEIGHT;
/// Rate of the pulse (1 − 2x²) exp(−x²), x = rate (t − middle).
const PULSE_RATE: f64 = 0.36;
/// Time of the middle of the pulse.
const PULSE_MIDDLE: f64 = 15.0;

fn profile() -> SoilProfile {
    let rock = Soil::from_shear_wave_speed(2.0, 0.3, 1.2).unwrap();
    SoilProfile::on_half_plane(rock)
        .with_bedrock_damping(gmb(1))
        .with_layer(Soil::new(1.0, 1.0 / 3.0, 1.0).unwrap(), 0.7)
        .unwrap()
        .with_damping(gmb(1))
        .with_layer(Soil::new(1.8, 0.3, 1.1).unwrap(), 1.3)
        .unwrap()
        .with_damping(gmb(1))
}

fn elements() -> TrenchElements {
    Trench::new(-1.0..1.0, 1.0).unwrap().elements(4, 3).unwrap()
}

fn ground() -> TrenchGround {
    TrenchGround::new(profile(), elements()).unwrap()
}

/// Period of the Fourier series, and the distance of the pulse from its repetition.
const SERIES_PERIOD: f64 = 90.0;
/// Number of terms, up to the highest frequency that the contact elements resolve.
const SERIES_TERMS: i32 = 31;

/// Amplitudes of the horizontal motion of the base and of its rotation at a circular frequency.
struct BaseAmplitudes {
    circular_frequency: f64,
    amplitudes: [Complex; 2],
}

/// Dynamic stiffness of a body with this mass on a spring.
fn dynamic_stiffness(stiffness: Complex, mass: f64, circular_frequency: f64) -> Complex {
    stiffness - Complex::real(circular_frequency * circular_frequency * mass)
}

/// Amplitudes of the block's motion under the pulse, by impedances and kinematic motions.
fn base_amplitudes() -> Vec<BaseAmplitudes> {
    let frequencies: Vec<f64> = (1..=SERIES_TERMS).map(|k| f64::from(k) / SERIES_PERIOD).collect();
    let impedances = ground().impedances(&frequencies, &mut unobserved).unwrap();
    let inputs = ground().kinematic_motions(&frequencies, &mut unobserved).unwrap();
    let arm = 0.5 * BLOCK_HEIGHT;
    let inertia = BLOCK_MASS * (4.0 + BLOCK_HEIGHT * BLOCK_HEIGHT) / 12.0 + BLOCK_MASS * arm * arm;
    let mut list = vec![];
    for (impedance, input) in impedances.iter().zip(&inputs) {
        let omega = TAU * impedance.frequency;
        let force = impedance.horizontal * input.horizontal + impedance.coupling * input.rotation;
        let moment = impedance.coupling * input.horizontal + impedance.rocking * input.rotation;
        let horizontal = dynamic_stiffness(impedance.horizontal, BLOCK_MASS, omega);
        let coupling = dynamic_stiffness(impedance.coupling, BLOCK_MASS * arm, omega);
        let rocking = dynamic_stiffness(impedance.rocking, inertia, omega);
        let determinant = horizontal * rocking - coupling * coupling;
        let sway = (rocking * force - coupling * moment) / determinant;
        let rotation = (horizontal * moment - coupling * force) / determinant;
        let spectrum = std::f64::consts::PI.sqrt() / PULSE_RATE
            * 0.5
            * (omega / PULSE_RATE).powi(2)
            * (-(0.5 * omega / PULSE_RATE).powi(2)).exp();
        let amplitudes = [sway * spectrum, rotation * spectrum];
        list.push(BaseAmplitudes { circular_frequency: omega, amplitudes });
    }
    list
}

/// Horizontal motion of the base and rotation (positive: the right end moves down) at the first multiples of `step`.
fn synthesis(step: f64, count: usize) -> Vec<[f64; 2]> {
    let list = base_amplitudes();
    let mut motions = vec![];
    for n in 1..=count {
        let time = step * n as f64 - PULSE_MIDDLE;
        let mut sum = [0.0; 2];
        for BaseAmplitudes { circular_frequency, amplitudes } in &list {
            let phase_factor = Complex::new(0.0, circular_frequency * time).exp();
            for (sum, amplitude) in sum.iter_mut().zip(amplitudes) {
                *sum += 2.0 / SERIES_PERIOD * (*amplitude * phase_factor).re;
            }
        }
        motions.push(sum);
    }
    motions
}

/// Largest errors of motion and rotation over their largest values.
fn errors(step: f64, count: usize, motion: &TrenchMotion) -> [f64; 2] {
    let reference = synthesis(step, count);
    let mut simulation = Simulation::builder(step)
        .structure(WithWalls::new(RigidBlock::new(2.0, BLOCK_HEIGHT, 1.0).unwrap(), 1.0).unwrap())
        .ground(ground())
        .interface(Bonded)
        .motion(motion.clone())
        .expected_steps(count)
        .build()
        .unwrap();
    let mut difference = [0.0_f64; 2];
    let mut max_values = [0.0_f64; 2];
    for expected in &reference {
        let state = simulation.step().unwrap();
        // The state's rotation raises the right end.
        let computed = [state.absolute_displacement()[0], -state.base_rotation];
        for k in 0..2 {
            difference[k] = difference[k].max((computed[k] - expected[k]).abs());
            max_values[k] = max_values[k].max(expected[k].abs());
        }
    }
    let energy = simulation.state().energy_balance;
    assert!(energy.residual() < 1e-9 && energy.soil > 0.0, "{energy:?}");
    [0, 1].map(|k| difference[k] / max_values[k])
}

#[test]
fn a_welded_block_in_layers_follows_its_fourier_synthesis_with_second_order() {
    let record = Record::from_fn(0.03, 60.0, |time: f64| {
        let square = (PULSE_RATE * (time - PULSE_MIDDLE)).powi(2);
        PULSE_RATE * PULSE_RATE * (-6.0 + square * (24.0 - 8.0 * square)) * (-square).exp()
    });
    let motion = TrenchMotion::new(&ground(), record.unwrap(), &mut unobserved).unwrap();
    let coarse = errors(0.3, 140, &motion);
    let fine = errors(0.15, 280, &motion);
    println!("{coarse:?} {fine:?}");
    for k in 0..2 {
        // Frequencies that the elements do not resolve are left out of the reference.
        assert!(coarse[k] < 0.02 && coarse[k] / fine[k] > 3.2, "{coarse:?} {fine:?}");
    }
}
