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

const HEIGHT: f64 = 3.0;
const MASS: f64 = 2.0 * HEIGHT;
/// Rate and middle of the pulse (1 − 2x²) exp(−x²).
const RATE: f64 = 0.36;
const MIDDLE: f64 = 15.0;

fn profile() -> SoilProfile {
    let layer = |thickness: f64, profile: SoilProfile, soil: Soil| {
        profile.with_layer(soil, thickness).unwrap().with_damping(gmb(1))
    };
    let rock = Soil::from_shear_wave_speed(2.0, 0.3, 1.2).unwrap();
    let base = SoilProfile::on_half_plane(rock).with_bedrock_damping(gmb(1));
    let upper = layer(0.7, base, Soil::new(1.0, 1.0 / 3.0, 1.0).unwrap());
    layer(1.3, upper, Soil::new(1.8, 0.3, 1.1).unwrap())
}

fn elements() -> TrenchElements {
    Trench::new(-1.0..1.0, 1.0).unwrap().elements(4, 3).unwrap()
}

fn ground() -> TrenchGround {
    TrenchGround::new(profile(), elements()).unwrap()
}

/// Horizontal motion of the base and rotation (positive: the right end moves down) at the first multiples of `step`.
fn synthesis(step: f64, count: usize) -> Vec<[f64; 2]> {
    const PERIOD: f64 = 90.0;
    // The highest frequency that the contact elements resolve.
    const COUNT: i32 = 31;
    let frequencies: Vec<f64> = (1..=COUNT).map(|k| f64::from(k) / PERIOD).collect();
    let impedances = ground().impedances(&frequencies, &mut unobserved).unwrap();
    let inputs = ground().kinematic_motions(&frequencies, &mut unobserved).unwrap();
    let arm = 0.5 * HEIGHT;
    let inertia = MASS * (4.0 + HEIGHT * HEIGHT) / 12.0 + MASS * arm * arm;
    let mut found = vec![];
    for (stiffness, input) in impedances.iter().zip(&inputs) {
        let omega = TAU * stiffness.frequency;
        let [hh, hr, rr] = [stiffness.horizontal, stiffness.coupling, stiffness.rocking];
        let force = hh * input.horizontal + hr * input.rotation;
        let moment = hr * input.horizontal + rr * input.rotation;
        let dynamic =
            |stiffness: Complex, mass: f64| stiffness - Complex::real(omega * omega * mass);
        let [a, b, d] = [dynamic(hh, MASS), dynamic(hr, MASS * arm), dynamic(rr, inertia)];
        let determinant = a * d - b * b;
        let moved = (d * force - b * moment) / determinant;
        let turned = (a * moment - b * force) / determinant;
        let spectrum = std::f64::consts::PI.sqrt() / RATE
            * 0.5
            * (omega / RATE).powi(2)
            * (-(0.5 * omega / RATE).powi(2)).exp();
        found.push((omega, [moved * spectrum, turned * spectrum]));
    }
    (1..=count)
        .map(|n| {
            let time = step * n as f64 - MIDDLE;
            let mut sum = [0.0; 2];
            for (omega, amplitudes) in &found {
                let turned = Complex::new(0.0, omega * time).exp();
                for (sum, amplitude) in sum.iter_mut().zip(amplitudes) {
                    *sum += 2.0 / PERIOD * (*amplitude * turned).re;
                }
            }
            sum
        })
        .collect()
}

/// Largest errors of motion and rotation over their largest values, and the residual of the energy.
fn errors(step: f64, count: usize, motion: &TrenchMotion) -> [f64; 2] {
    let wanted = synthesis(step, count);
    let mut simulation = Simulation::builder(step)
        .structure(WithWalls::new(RigidBlock::new(2.0, HEIGHT, 1.0).unwrap(), 1.0).unwrap())
        .ground(ground())
        .interface(Bonded)
        .motion(motion.clone())
        .expected_steps(count)
        .build()
        .unwrap();
    let [mut apart, mut largest] = [[0.0_f64; 2]; 2];
    for wanted in &wanted {
        let state = simulation.step().unwrap();
        // The state's rotation raises the right end.
        let found = [state.absolute_displacement()[0], -state.base_rotation];
        for k in 0..2 {
            apart[k] = apart[k].max((found[k] - wanted[k]).abs());
            largest[k] = largest[k].max(wanted[k].abs());
        }
    }
    let energy = simulation.state().energy_balance;
    assert!(energy.residual() < 1e-9 && energy.soil > 0.0, "{energy:?}");
    [0, 1].map(|k| apart[k] / largest[k])
}

#[test]
fn a_welded_block_in_layers_follows_its_fourier_synthesis_with_second_order() {
    let second = |time: f64| {
        let square = (RATE * (time - MIDDLE)).powi(2);
        RATE * RATE * (-6.0 + square * (24.0 - 8.0 * square)) * (-square).exp()
    };
    let record = Record::from_fn(0.03, 60.0, second).unwrap();
    let motion = TrenchMotion::new(&ground(), record, &mut unobserved).unwrap();
    let [coarse, fine] =
        [(0.3, 140), (0.15, 280)].map(|(step, count)| errors(step, count, &motion));
    println!("{coarse:?} {fine:?}");
    for k in 0..2 {
        // Frequencies that the elements do not resolve are left out of the reference.
        assert!(coarse[k] < 0.02 && coarse[k] / fine[k] > 3.2, "{coarse:?} {fine:?}");
    }
}
