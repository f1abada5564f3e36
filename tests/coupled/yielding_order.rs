//! GOAL: bonded columns that yield are of second order in the time step, on a fixed base and on ground that radiates.
//! SCENE: a chain of yielding springs; clay (Iwan's model) of `Quad8` in simple shear, bonded to a half-plane.
//! REFERENCE: runs with a far shorter step.
//!
//! Corners of the law excite vibrations of all frequencies. The order is therefore that of the scheme once the step resolves
//! the fastest vibration of the column; with longer steps single corners determine the errors.

use std::any::Any;
use std::f64::consts::PI;

use basemat::Simulation;
use basemat::Soil;
use basemat::bem::{ElasticGround, SpringGround};
use basemat::coupled::{Probe, State};
use basemat::fem::{Direction, Iwan, Mesh, SharedMaterial};
use basemat::interface::Bonded;
use basemat::motion::FreeFieldFn;
use basemat::structure::FemModel;

use basemat_problems::yielding_springs::{Masses, WithYieldingSprings, spring_column};

/// Number of runs, each with half the time step of the one before.
const RUN_COUNT: usize = 5;

/// Shaking at 1.5 Hz that grows until `growth_time`, with this amplitude of the acceleration, m/s².
///
/// The growth is a quarter of a sine to the power `growth_exponent`.
fn shaking(amplitude: f64, growth_time: f64, growth_exponent: i32) -> FreeFieldFn {
    let omega = 3.0 * PI;
    FreeFieldFn::new(move |_, time| {
        let growth = (0.5 * PI * (time / growth_time).min(1.0)).sin().powi(growth_exponent);
        [-amplitude / (omega * omega) * growth * (omega * time).sin(), 0.0]
    })
}

/// Displacement and velocity of the top at the ends of `count` long steps, each of `stride` steps.
fn top_motion(
    simulation: &mut Simulation,
    top: usize,
    stride: usize,
    count: usize,
) -> Vec<[f64; 2]> {
    let mut motion = Vec::with_capacity(count);
    let observe = |state: &State| {
        if state.step.is_multiple_of(stride) {
            motion.push([state.absolute_displacement()[top], state.probes[0]]);
        }
    };
    let run = simulation.run(count * stride, observe).unwrap();
    assert!(run.energy_error < 1e-9, "{:e}", run.energy_error);
    assert!(run.energy_balance.hysteresis > 0.0);
    motion
}

/// Slopes of the lines of best fit through log₂ of the errors: displacement and velocity, each in two norms over time.
///
/// The norms are the root of the mean square and the largest value. `motion` has the motion by the number of halvings.
fn slopes(motion: impl Fn(usize) -> Vec<[f64; 2]>, reference_halvings: usize) -> [[f64; 2]; 2] {
    let reference = motion(reference_halvings);
    let mut errors = Vec::with_capacity(RUN_COUNT);
    for halvings in 0..RUN_COUNT {
        let motion = motion(halvings);
        errors.push([0, 1].map(|k| {
            let differences: Vec<f64> =
                motion.iter().zip(&reference).map(|(a, b)| (a[k] - b[k]).abs()).collect();
            let square_sum: f64 = differences.iter().map(|d| d * d).sum();
            let max_magnitude = differences.iter().fold(0.0_f64, |max, d| max.max(*d));
            [(square_sum / differences.len() as f64).sqrt(), max_magnitude]
        }));
    }
    println!("errors {errors:?}");
    let log_error_slope = |k: usize, norm: usize| {
        let terms = (-2..=2).zip(&errors).map(|(x, e)| -f64::from(x) * e[k][norm].log2());
        terms.sum::<f64>() / 10.0
    };
    let slopes = [
        [log_error_slope(0, 0), log_error_slope(0, 1)],
        [log_error_slope(1, 0), log_error_slope(1, 1)],
    ];
    println!("slopes {slopes:.2?}");
    slopes
}

/// Four cells in a chain on a fixed base, from Δt = 5 ms: displacements.
#[test]
fn chains_on_a_fixed_base_converge() {
    let motion = |halvings: usize| {
        let stride = 1 << halvings;
        let ground = SpringGround::new(-2.0..2.0, 4, 2e9, 2e9).unwrap();
        let builder = Simulation::builder(0.005 / stride as f64).ground(ground).interface(Bonded);
        let builder = builder.structure(spring_column(4)).motion(shaking(3.0, 6.0, 2));
        let builder = builder.probe(Probe::velocity("top", [(6, 1.0)])).on_fixed_base();
        let mut simulation = builder.build().unwrap();
        let motion = top_motion(&mut simulation, 6, stride, 400);
        let structure: &dyn Any = simulation.structure();
        let column = structure.downcast_ref::<WithYieldingSprings<Masses>>().unwrap();
        assert!(column.largest_plastic_deformation() > 1e-5);
        motion
    };
    let displacement = slopes(motion, 7)[0];
    assert!(displacement.iter().all(|slope| *slope > 1.5), "{displacement:?}");
}

/// Column of clay of three `Quad8`, 6 m high, with both sides tied, and its degree of freedom at the top.
fn clay_column() -> (FemModel, usize) {
    let clay = Iwan::hyperbolic(40e6, 40e3, 0.2, 0.4, 1900.0).unwrap();
    let clay = SharedMaterial::from(clay);
    let mesh = Mesh::quad8_block(&[-1.0, 1.0], &[0.0, 2.0, 4.0, 6.0], |_, _| clay.clone()).unwrap();
    let mut sides = Vec::new();
    for level in 0..=6 {
        let y = f64::from(level);
        sides.push([-1.0, 1.0].map(|x| mesh.node_at(x, y).unwrap()));
    }
    let top = mesh.node_at(-1.0, 6.0).unwrap();
    let mut model = FemModel::on_base(mesh).unwrap();
    for [left, right] in sides {
        model = model.with_tied_nodes(left, &[right]).unwrap();
    }
    let top = model.dof(top, Direction::X).unwrap();
    (model, top)
}

/// The clay on a half-plane into which it radiates, from Δt = 1 ms to 0.0625 ms: displacements and velocities.
///
/// The strain of the clay keeps its direction. Where directions turn, the radial return of the stresses is of first order.
#[test]
fn clay_on_a_half_plane_converges() {
    let motion = |halvings: usize| {
        let stride = 1 << halvings;
        let (model, top) = clay_column();
        let soil = Soil::from_shear_wave_speed(250.0, 0.33, 1900.0).unwrap();
        let ground = ElasticGround::under(soil, &model, 4).unwrap();
        let builder = Simulation::builder(1e-3 / stride as f64).ground(ground).interface(Bonded);
        let builder = builder.structure(model).gravity(0.0).motion(shaking(4.0, 0.8, 4));
        let builder = builder.probe(Probe::velocity("top", [(top, 1.0)]));
        top_motion(&mut builder.build().unwrap(), top, stride, 1000)
    };
    let slopes = slopes(motion, 6);
    assert!(slopes.iter().flatten().all(|slope| *slope > 1.7), "{slopes:?}");
}
