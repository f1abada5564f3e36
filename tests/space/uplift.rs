//! Blocks that lift off and slide in all directions on elastic ground.

use std::f64::consts::{FRAC_1_SQRT_2, PI};

use basemat::bem::layered::Stages;
use basemat::bem::plan::Plan;
use basemat::bem::{ContactElement, ElasticGround, SharedKernels};
use basemat::coupled::{Load, Warning};
use basemat::history::{HistoryMethod, HistoryOptions};
use basemat::interface::{Coulomb, Mode};
use basemat::motion::{FreeField, STANDARD_GRAVITY, Triaxial};
use basemat::results::Quantity;
use basemat::soil::SoilProfile;
use basemat::structure::RigidBody;
use basemat::{Simulation, Soil};

const GRAVITY: f64 = 1e-3;

/// Ricker's wavelet (1 − 2u) e^−u, u = (π f (t − t₀))².
fn ricker(frequency: f64, middle: f64, time: f64) -> f64 {
    let u = (PI * frequency * (time - middle)).powi(2);
    (1.0 - 2.0 * u) * (-u).exp()
}

/// Amplitude of a wavelet whose acceleration is so many g.
fn amplitude(share: f64, frequency: f64) -> f64 {
    share * GRAVITY / (6.0 * (PI * frequency).powi(2))
}

/// The table's motion. It begins with a jump, since the surface is at rest at t = 0.
struct Shake;

impl FreeField for Shake {
    fn displacement(&self, _: f64, _: f64) -> [f64; 2] {
        unreachable!("a ground in plan asks for three directions")
    }

    fn displacement_at(&self, _: [f64; 2], time: f64) -> [f64; 3] {
        if time == 0.0 {
            return [0.0; 3];
        }
        let x = amplitude(1.5, 0.06) * ricker(0.06, 14.0, time);
        let y = amplitude(1.05 / 0.8_f64.powi(2), 0.06) * ricker(0.048, 17.0, time);
        let down = amplitude(0.45 / 1.7_f64.powi(2), 0.06) * ricker(0.102, 13.0, time);
        // The table's y points towards the reader, its z down.
        [x, -y, -down]
    }
}

/// Ricker's wavelet along a direction (x, y).
struct Along([f64; 2]);

impl FreeField for Along {
    fn displacement(&self, _: f64, _: f64) -> [f64; 2] {
        unreachable!("a ground in plan asks for three directions")
    }

    fn displacement_at(&self, _: [f64; 2], time: f64) -> [f64; 3] {
        let motion = amplitude(1.8, 0.06) * ricker(0.06, 14.0, time);
        [self.0[0] * motion, self.0[1] * motion, 0.0]
    }
}

/// A block of 2 × 2 × 4 on a homogeneous half-space.
fn block(cells: usize, motion: impl FreeField + 'static) -> Simulation {
    let body = RigidBody::cuboid([2.0, 2.0, 4.0], 1.0).unwrap();
    let soil = Soil::new(1.0, 1.0 / 3.0, 1.0).unwrap();
    let ground = ElasticGround::under(soil, &body, cells).unwrap().with_stages(Stages::Two);
    Simulation::builder(0.1)
        .structure(body)
        .ground(ground)
        .interface(Coulomb::new(0.5).unwrap())
        .motion(motion)
        .gravity(GRAVITY)
        .expected_steps(300)
        .build()
        .unwrap()
}

/// `uplift_biaxial.csv`, written by another program: down, x, y, rotations, open part, work on the soil, friction work.
#[test]
fn a_block_that_lifts_and_slides_follows_the_table() {
    let table = include_str!("../data/plan/uplift_biaxial.csv");
    let numbers = |line: &str| line.split(',').map(|number| number.parse().unwrap()).collect();
    let rows: Vec<Vec<f64>> = table.lines().skip(1).map(numbers).collect();
    assert_eq!(rows.len(), 300);
    for (cells, gates) in
        [(16, [1e-5; 9]), (8, [2e-2, 1e-2, 1e-2, 1e-2, 1e-2, 2e-2, 3e-2, 1e-2, 1e-2])]
    {
        let mut simulation = block(cells, Shake);
        let elements = simulation.ground().elements().iter();
        let areas: Vec<f64> = elements.map(ContactElement::area).collect();
        assert!((areas.iter().sum::<f64>() - 4.0).abs() < 1e-12, "the mat's own area");
        let (mut errors, mut sizes) = ([0.0; 9], [0.0; 9]);
        let (mut row, mut iterations) = (rows.iter(), 0);
        let (mut worst, mut least, mut friction) = (0.0_f64, 0.0_f64, 0.0);
        let mut before = simulation.state().contact.clone();
        let run = simulation.run(300, |state| {
            let u = state.absolute_displacement();
            let energy = &state.energy_balance;
            for ((own, last), area) in state.contact.iter().zip(&before).zip(&areas) {
                let along = own.shear * (own.slip - last.slip);
                let work = area * (along + own.shear_across * (own.slip_across - last.slip_across));
                friction += work;
                least = least.min(work);
            }
            before.copy_from_slice(&state.contact);
            let open = state.modes.iter().filter(|mode| **mode == Mode::Open).count();
            let open = open as f64 / areas.len() as f64;
            assert!((open - state.uplifted_fraction).abs() < 0.05);
            let found = [-u[2], u[0], -u[1], u[3], -u[4], -u[5], open, energy.soil, friction];
            let wanted = &row.next().unwrap()[1..];
            for k in 0..9 {
                errors[k] += (found[k] - wanted[k]).powi(2);
                sizes[k] += wanted[k].powi(2);
            }
            iterations += state.trials;
            worst = worst.max(energy.residual());
        });
        let run = run.unwrap();
        let errors: [f64; 9] = std::array::from_fn(|k| f64::sqrt(errors[k] / sizes[k]));
        println!("{cells}: {errors:?}, {iterations} iterations, {:?}", run.fallbacks);
        assert!(worst < 1e-9, "{worst:e}");
        assert!(least > -1e-10 * friction, "{least:e} of {friction:e}");
        for (error, gate) in errors.iter().zip(gates) {
            assert!(*error < gate, "{cells}: {errors:?}");
        }
    }
}

/// A square scene shaken along a diagonal, and along the other.
#[test]
fn diagonals_are_alike() {
    let march = |direction: [f64; 2]| {
        let mut simulation = block(8, Along(direction));
        let mut all: Vec<[f64; 6]> = Vec::new();
        let run = simulation.run(300, |state| {
            all.push(state.absolute_displacement().try_into().unwrap());
        });
        assert!(run.unwrap().energy_error < 1e-9);
        all
    };
    let one = march([FRAC_1_SQRT_2; 2]);
    let other = march([-FRAC_1_SQRT_2, FRAC_1_SQRT_2]);
    let along = march([1.0, 0.0]);
    let largest = |all: &[[f64; 6]], k: usize| all.iter().fold(0.0_f64, |m, u| m.max(u[k].abs()));
    let size = largest(&along, 0);
    assert!(largest(&along, 4) > 0.1 * size, "it rocks");
    for (u, v) in one.iter().zip(&other) {
        let turned = [-u[1], u[0], u[2], -u[4], u[3], u[5]];
        for (a, b) in turned.iter().zip(v) {
            assert!((a - b).abs() < 1e-10 * size, "{turned:?} {v:?}");
        }
        // The diagonal is an axis of symmetry.
        assert!((u[0] - u[1]).abs() < 1e-10 * size && (u[3] + u[4]).abs() < 1e-10 * size);
    }
    for (k, name) in [(1, "y"), (3, "roll"), (5, "twist")] {
        let across = largest(&along, k);
        assert!(across < 1e-12 * size, "{name}: {across:e} of {size:e}");
    }
}

/// Sines along x, y and upwards that never end.
struct Sines;

impl FreeField for Sines {
    fn displacement(&self, _: f64, _: f64) -> [f64; 2] {
        unreachable!("a ground in plan asks for three directions")
    }

    fn displacement_at(&self, _: [f64; 2], time: f64) -> [f64; 3] {
        let sine = |share: f64, frequency: f64, phase: f64| {
            let angle = 2.0 * PI * frequency * time;
            share * GRAVITY / (2.0 * PI * frequency).powi(2) * ((angle + phase).sin() - phase.sin())
        };
        [sine(1.2, 0.06, 0.3), sine(-0.9, 0.047, 1.1), sine(0.4, 0.09, 0.7)]
    }
}

/// Three steps, three masses, four coefficients of friction: W from well conditioned to hardly so.
#[test]
fn hard_steps_are_solved() {
    let kernels = SharedKernels::default();
    let (mut all, mut endless) = ((0, 0), 0);
    for crossed in [0.4, 1.9, 7.8] {
        for mass in [16.0, 1.0, 0.2] {
            for friction in [0.3, 1.0, 3.0, f64::INFINITY] {
                let body = RigidBody::cuboid([2.0, 2.0, 4.0], mass / 16.0).unwrap();
                let soil = Soil::new(1.0, 1.0 / 3.0, 1.0).unwrap();
                let ground = ElasticGround::under(soil, &body, 8).unwrap();
                let mut simulation = Simulation::builder(crossed * 2.0 / (8.0 - 0.21))
                    .structure(body)
                    .ground(ground.with_stages(Stages::Two).with_shared_kernels(&kernels))
                    .interface(Coulomb::new(friction).unwrap())
                    .motion(Sines)
                    .gravity(GRAVITY)
                    .expected_steps(120)
                    .build()
                    .unwrap();
                let run = simulation.run(120, |_| {}).unwrap();
                println!(
                    "{crossed} {mass} {friction}: {:.1} iterations, {:?}, energy {:.1e}, open {:.2}, slip {:.1e}",
                    run.trials as f64 / 120.0,
                    run.fallbacks,
                    run.energy_error,
                    run.whole.uplifted_fraction.magnitude(),
                    run.whole.largest_slip.magnitude(),
                );
                assert!(run.energy_error < 1e-9, "{}", run.energy_error);
                let less = |warning: &Warning| matches!(warning, Warning::LessFriction { .. });
                assert!(!run.warnings.iter().any(less), "{:?}", run.warnings);
                if friction == f64::INFINITY {
                    endless += run.trials;
                } else {
                    all = (all.0 + run.trials, all.1 + run.steps);
                }
            }
        }
    }
    println!("{all:?}, {endless}");
    assert!(all.0 < 40 * all.1 && endless < 100 * all.1, "{all:?} {endless}");
}

/// W by blocks: saved where elements lift and slide, and resumed in another simulation.
#[test]
fn many_cells_resume_to_the_last_bit() {
    let mut whole = block(12, Sines);
    let (mut open, mut slide) = (0, 0);
    whole.run(15, |_| {}).unwrap();
    let saved = whole.checkpoint().unwrap();
    let mut states = Vec::new();
    let run = whole.run(15, |state| states.push(state.clone())).unwrap();
    let mut resumed = block(12, Sines);
    resumed.resume(&saved).unwrap();
    for wanted in &states {
        assert!(resumed.step().unwrap() == wanted);
        open += wanted.modes.iter().filter(|mode| **mode == Mode::Open).count();
        slide += wanted.modes.iter().filter(|mode| mode.is_slip()).count();
    }
    assert!(run.energy_error < 1e-12, "{}", run.energy_error);
    assert!(open > 100 && slide > 100, "{open} {slide}");
}

/// Memory that ends changes the soil's work by less than the energy balance says it may.
#[test]
fn what_memory_forgets_is_in_the_energy_balance() {
    let march = |options: HistoryOptions| {
        let body = RigidBody::cuboid([2.0, 2.0, 4.0], 1.0).unwrap();
        let soil = Soil::new(1.0, 1.0 / 3.0, 1.0).unwrap();
        let ground = ElasticGround::under(soil, &body, 4).unwrap();
        let mut simulation = Simulation::builder(0.2)
            .structure(body)
            .ground(ground.with_history(options).unwrap())
            .interface(Coulomb::new(0.5).unwrap())
            .motion(Sines)
            .gravity(GRAVITY)
            .expected_steps(700)
            .build()
            .unwrap();
        let run = simulation.run(700, |_| {}).unwrap();
        assert!(run.energy_error < 1e-9 && run.whole.uplifted_fraction.magnitude() > 0.1);
        run.energy_balance
    };
    let coarse = HistoryOptions { tolerance: Some(1e-4), ..HistoryOptions::default() };
    let [whole, ended] = [HistoryMethod::RelaxedFft.into(), coarse].map(march);
    let (apart, bound) = ((whole.soil - ended.soil).abs(), ended.soil_error_bound);
    println!("{apart:e} of {bound:e}, {}", whole.soil);
    assert_eq!(whole.soil_error_bound, 0.0);
    assert!(0.0 < apart && apart < bound && bound < 0.5 * whole.soil, "{apart:e} {bound:e}");
}

/// GOAL: weight stands upright, P–Δ or not, and not on the verge of a fall on a corner, which is an equilibrium too.
/// SCENE: slender cylinder on concrete over soil, where only the rim bears, from soft to stiff concrete.
/// REFERENCE: the same without P–Δ, which does nothing as long as nothing turns.
#[test]
fn what_leans_is_placed_upright() {
    let soil = Soil::from_shear_wave_speed(250.0, 1.0 / 3.0, 1900.0).unwrap();
    for modulus in [1e9, 4e9, 12.5e9] {
        let concrete = Soil::new(modulus, 0.2, 2400.0).unwrap();
        let [upright, leaning] = [0.0, STANDARD_GRAVITY].map(|gravity| {
            let profile = SoilProfile::on_half_plane(soil).with_layer(concrete, 0.9).unwrap();
            let body = RigidBody::cylinder(1.7, 5.6, 3200.0).unwrap();
            Simulation::builder(1e-3)
                .structure(body.with_p_delta(gravity).unwrap())
                .ground(
                    ElasticGround::in_plan(profile, Plan::disc([0.0; 2], 1.7, 8).unwrap()).unwrap(),
                )
                .interface(Coulomb::new(0.3).unwrap())
                .motion(Triaxial::default())
                .expected_steps(2)
                .build()
                .unwrap()
        });
        let weight = upright.state().normal_force;
        let pairs = upright.state().contact.iter().zip(&leaning.state().contact);
        for (a, b) in pairs {
            assert!((a.pressure - b.pressure).abs() < 1e-7 * weight, "{a:?} {b:?}");
            assert!((a.gap - b.gap).abs() < 1e-9, "{a:?} {b:?}");
        }
        let turned = &leaning.static_displacement()[3..5];
        assert!(turned.iter().all(|angle| angle.abs() < 1e-9), "{turned:?}");
    }
}

/// A tall block that is pushed over, along x or along y, stands on its last row of 8, at 6.79/7 cells from the middle.
#[test]
fn blocks_stand_on_their_outermost_cells() {
    let soil = Soil::from_shear_wave_speed(200.0, 0.3, 1900.0).unwrap();
    let tip = |axis: usize, cells: usize| {
        let body = RigidBody::cuboid([6.0, 6.0, 12.0], 2000.0).unwrap();
        let row = body.displacement_at([0.0, 0.0, 12.0])[axis].clone();
        let ground = ElasticGround::under(soil, &body, cells).unwrap();
        let push = 0.28 * 9.80665 * body.total_mass();
        let mut simulation = Simulation::builder(0.01)
            .structure(body)
            .ground(ground)
            .interface(Coulomb::new(0.9).unwrap())
            .load(Load::new(row, move |time| push * (2.0 * time).min(1.0)))
            .build()
            .unwrap();
        simulation.run(100, |_| {}).unwrap()
    };
    for axis in 0..2 {
        let run = tip(axis, 8);
        let [own, other] = [Quantity::OverturningSafety, Quantity::OverturningSafetyAcross]
            .map(|quantity| run.whole.peak(quantity).value);
        let [own, other] = if axis == 0 { [own, other] } else { [other, own] };
        assert!((own - (8.0 - 0.21) / 7.0).abs() < 1e-6 && other > 1e3, "{axis}: {own} {other}");
        assert!(
            run.to_string().contains("0.90 of the half width from the middle of the base at most"),
            "{run}"
        );
        assert_eq!((run.whole.ends, run.whole.depth), ([-3.0, 3.0], [-3.0, 3.0]));
    }
    assert!(!tip(0, 16).to_string().contains("16 elements"));
}
