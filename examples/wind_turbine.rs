//! The octagonal mat of a wind turbine under the extreme operating gust: bonded, and free to lift.
//!
//! ```text
//! cargo run --release --example wind_turbine
//! ```
//!
//! The hub stands at 92 m on an octagon 20 m wide. The gust is the "Mexican hat" of IEC 61400-1. The rotor
//! keeps its thrust coefficient, as before the control acts. In normal operation, practice allows no gap
//! under the mat (IEC 61400-6). Under extreme loads, it requires contact of at least half of the mat. Steady
//! wind leaves the mat closed; the gust opens more than a third of it. Structure matrices are written by
//! hand: the mass of a `RigidBody`, and a hub that moves along x and y on a cantilever.

use std::f64::consts::{PI, TAU};

use basemat::coupled::Load;
use basemat::prelude::*;
use basemat::structure::{MatrixModel, RigidBody};

/// Width of the octagon across flats, height of mat and fill, height of the hub, m.
const WIDTH: f64 = 20.0;
const DEPTH: f64 = 3.0;
const HUB: f64 = 92.0;
/// Mean density of concrete and fill, kg/m³; rotor, nacelle and upper half of the tower, lower half, kg.
const DENSITY: f64 = 2200.0;
const TOP: f64 = 280.0e3;
const FOOT: f64 = 150.0e3;
/// Frequency on a fixed base, Hz; aerodynamic and structural damping ratio.
const FREQUENCY: f64 = 0.33;
const DAMPING: f64 = 0.04;
/// Diameter of the rotor, m; its thrust coefficient; density of air, kg/m³; wind at the hub, m/s.
const ROTOR: f64 = 112.0;
const THRUST: f64 = 0.8;
const AIR: f64 = 1.225;
const WIND: f64 = 12.0;
/// Start and duration of the gust, s.
const START: f64 = 2.0;
const GUST: f64 = 10.5;

/// Wind at the hub, m/s: class A, Λ₁ = 42 m.
fn wind(time: f64) -> f64 {
    let deviation = 0.16 * (0.75 * WIND + 5.6);
    let gust = 3.3 * deviation / (1.0 + 0.1 * ROTOR / 42.0);
    let t = (time - START).clamp(0.0, GUST) / GUST;
    WIND - 0.37 * gust * (3.0 * PI * t).sin() * (1.0 - (TAU * t).cos())
}

fn thrust(time: f64) -> f64 {
    0.5 * AIR * THRUST * 0.25 * PI * ROTOR * ROTOR * wind(time).powi(2)
}

/// The mat with the lower half of the tower, and the hub on a massless cantilever.
fn turbine() -> basemat::Result<MatrixModel> {
    let side = WIDTH * (PI / 8.0).tan();
    let corners = (0..8).map(|k| (f64::from(k) + 0.5) * PI / 4.0);
    let reach = 0.5 * WIDTH / (PI / 8.0).cos();
    let outline = corners.map(|angle| [reach * angle.cos(), reach * angle.sin()]).collect();
    let mat = DENSITY * 2.0 * WIDTH * side * DEPTH;
    // Moments of inertia about the mat's centre, for tilting and twisting.
    let flat = mat * (WIDTH * WIDTH / 16.0 + side * side / 48.0);
    let steep = flat + mat * DEPTH * DEPTH / 12.0;
    let inertia = [[steep, 0.0, 0.0], [0.0, steep, 0.0], [0.0, 0.0, 2.0 * flat]];
    let body = RigidBody::from_mass(outline, mat, inertia, [0.0, 0.0, 0.5 * DEPTH])?;

    let [mut mass, mut stiffness, mut damping] = [(); 3].map(|()| Triplets::new(8));
    body.mass(&mut mass)?;
    let quarter = 0.25 * HUB;
    mass.add_outer([(0, 1.0), (4, quarter)], FOOT);
    mass.add_outer([(1, 1.0), (3, -quarter)], FOOT);
    mass.add(2, 2, FOOT + TOP);
    let omega = TAU * FREQUENCY;
    // Bending of the tower is the hub's displacement less the part carried along by the mat, u + r × (0, 0,
    // HUB).
    for bending in [[(6, 1.0), (0, -1.0), (4, -HUB)], [(7, 1.0), (1, -1.0), (3, HUB)]] {
        mass.add(bending[0].0, bending[0].0, TOP);
        stiffness.add_outer(bending, TOP * omega * omega);
        damping.add_outer(bending, 2.0 * DAMPING * TOP * omega);
    }
    MatrixModel::new(mass, stiffness, body.base())?.with_damping(damping)
}

/// Prints moment, tilt and uplift of the mat in steady wind and at the largest tilt in the gust.
fn blow(name: &str, law: impl InterfaceLaw + 'static) -> basemat::Result<()> {
    let turbine = turbine()?;
    let soil = Soil::from_shear_wave_speed(160.0, 0.4, 1900.0)?;
    let mut simulation = Simulation::builder(0.01)
        .ground(ElasticGround::under(soil, &turbine, 12)?)
        .structure(turbine)
        .interface(law)
        .load(Load::new(6, thrust))
        .expected_steps(1500)
        .build()?;
    let settled = simulation.static_displacement().to_vec();
    let of = |state: &State| {
        let [tilt, hub] = [4, 6].map(|dof| settled[dof] + state.displacement()[dof]);
        let moment = state.base_moment.abs();
        [1e-6 * moment, 1e3 * tilt, hub, 1e-9 * moment / tilt, 100.0 * state.uplifted_fraction]
    };
    let steady = of(simulation.state());
    let mut gust = steady;
    let run = simulation.run(1500, |state| {
        if of(state)[1] > gust[1] {
            gust = of(state);
        }
    })?;
    assert!(run.energy_error < 1e-9);
    for (wind, [moment, tilt, hub, secant, open]) in [("steady", steady), ("gust", gust)] {
        println!(
            "{name:<8} {wind:<7} {moment:>11.1} {tilt:>11.2} {hub:>8.3} {secant:>15.1} {open:>9.0}"
        );
    }
    Ok(())
}

fn main() -> basemat::Result<()> {
    println!("contact  wind    moment, MN·m  tilt, mrad   hub, m  secant, GN·m/rad   open, %");
    blow("bonded", Bonded)?;
    blow("lifts", Coulomb::new(0.6)?)
}
