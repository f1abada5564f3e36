//! The octagonal mat of a wind turbine under the extreme operating gust.
//!
//! ```text
//! cargo run --release --example wind_turbine
//! ```
//!
//! The hub stands at 92 m on an octagon 20 m wide. The gust is the "Mexican hat" of IEC 61400-1. The rotor
//! keeps its thrust coefficient, as before the control acts. In normal operation, practice allows no gap
//! under the mat (IEC 61400-6). Under extreme loads, it requires contact of at least half of the mat. Steady
//! wind leaves the mat closed; the gust opens more than a third of it. A bonded mat is computed beside it. Structure matrices are written by
//! hand: the mass of a `RigidBody`, and a hub that moves along x and y on a cantilever.

use std::f64::consts::{PI, TAU};

use basemat::coupled::Load;
use basemat::prelude::*;
use basemat::structure::{MatrixModel, RigidBody};

/// Width of the octagon across flats, height of mat and fill, height of the hub, m.
const OCTAGON_WIDTH: f64 = 20.0;
const MAT_HEIGHT: f64 = 3.0;
const HUB_HEIGHT: f64 = 92.0;
/// Mean density of concrete and fill, kg/m³; rotor, nacelle and upper half of the tower, lower half, kg.
const MAT_DENSITY: f64 = 2200.0;
const TOWER_TOP_MASS: f64 = 280.0e3;
const TOWER_FOOT_MASS: f64 = 150.0e3;
/// Frequency on a fixed base, Hz; aerodynamic and structural damping ratio.
const FIXED_BASE_FREQUENCY: f64 = 0.33;
const TOWER_DAMPING: f64 = 0.04;
/// Diameter of the rotor, m; its thrust coefficient; density of air, kg/m³; wind at the hub, m/s.
const ROTOR_DIAMETER: f64 = 112.0;
const THRUST_COEFFICIENT: f64 = 0.8;
const AIR_DENSITY: f64 = 1.225;
const MEAN_WIND: f64 = 12.0;
/// Start and duration of the gust, s.
const GUST_START: f64 = 2.0;
const GUST_DURATION: f64 = 10.5;

/// Wind at the hub, m/s: class A, Λ₁ = 42 m.
fn wind(time: f64) -> f64 {
    let deviation = 0.16 * (0.75 * MEAN_WIND + 5.6);
    let gust = 3.3 * deviation / (1.0 + 0.1 * ROTOR_DIAMETER / 42.0);
    let t = (time - GUST_START).clamp(0.0, GUST_DURATION) / GUST_DURATION;
    MEAN_WIND - 0.37 * gust * (3.0 * PI * t).sin() * (1.0 - (TAU * t).cos())
}

fn thrust(time: f64) -> f64 {
    0.5 * AIR_DENSITY
        * THRUST_COEFFICIENT
        * 0.25
        * PI
        * ROTOR_DIAMETER
        * ROTOR_DIAMETER
        * wind(time).powi(2)
}

/// The mat with the lower half of the tower, and the hub on a massless cantilever.
fn turbine() -> basemat::Result<MatrixModel> {
    let side = OCTAGON_WIDTH * (PI / 8.0).tan();
    let corners = (0..8).map(|k| (f64::from(k) + 0.5) * PI / 4.0);
    let corner_radius = 0.5 * OCTAGON_WIDTH / (PI / 8.0).cos();
    let outline = corners
        .map(|angle| [corner_radius * angle.cos(), corner_radius * angle.sin()])
        .collect();
    let mat_mass = MAT_DENSITY * 2.0 * OCTAGON_WIDTH * side * MAT_HEIGHT;
    // Moments of inertia about the mat's centre, for tilting and twisting.
    let plate_inertia = mat_mass * (OCTAGON_WIDTH * OCTAGON_WIDTH / 16.0 + side * side / 48.0);
    let tilting = plate_inertia + mat_mass * MAT_HEIGHT * MAT_HEIGHT / 12.0;
    let inertia = [[tilting, 0.0, 0.0], [0.0, tilting, 0.0], [0.0, 0.0, 2.0 * plate_inertia]];
    let body = RigidBody::from_mass(outline, mat_mass, inertia, [0.0, 0.0, 0.5 * MAT_HEIGHT])?;

    let mut mass = Triplets::new(8);
    let mut stiffness = Triplets::new(8);
    let mut damping = Triplets::new(8);
    body.mass(&mut mass)?;
    // The middle of the lower half of the tower.
    let foot_height = 0.25 * HUB_HEIGHT;
    mass.add_outer([(0, 1.0), (4, foot_height)], TOWER_FOOT_MASS);
    mass.add_outer([(1, 1.0), (3, -foot_height)], TOWER_FOOT_MASS);
    mass.add(2, 2, TOWER_FOOT_MASS + TOWER_TOP_MASS);
    let omega = TAU * FIXED_BASE_FREQUENCY;
    // Bending of the tower is the hub's displacement minus the rigid motion with the mat, u + r × (0, 0, h).
    for bending in [[(6, 1.0), (0, -1.0), (4, -HUB_HEIGHT)], [(7, 1.0), (1, -1.0), (3, HUB_HEIGHT)]]
    {
        mass.add(bending[0].0, bending[0].0, TOWER_TOP_MASS);
        stiffness.add_outer(bending, TOWER_TOP_MASS * omega * omega);
        damping.add_outer(bending, 2.0 * TOWER_DAMPING * TOWER_TOP_MASS * omega);
    }
    MatrixModel::new(mass, stiffness, body.base())?.with_damping(damping)
}

/// Response of the turbine at one instant.
#[derive(Clone, Copy)]
struct Response {
    /// Overturning moment on the mat, N·m.
    moment: f64,
    /// Tilt of the mat, rad.
    tilt: f64,
    /// Displacement of the hub, m.
    hub: f64,
    uplifted_fraction: f64,
}

impl Response {
    fn new(state: &State, static_displacement: &[f64]) -> Self {
        Self {
            moment: state.base_moment.abs(),
            tilt: static_displacement[4] + state.displacement()[4],
            hub: static_displacement[6] + state.displacement()[6],
            uplifted_fraction: state.uplifted_fraction,
        }
    }
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
    let static_displacement = simulation.static_displacement().to_vec();
    let steady = Response::new(simulation.state(), &static_displacement);
    let mut gust = steady;
    let run = simulation.run(1500, |state| {
        let response = Response::new(state, &static_displacement);
        if response.tilt > gust.tilt {
            gust = response;
        }
    })?;
    assert!(run.energy_error < 1e-9);
    for (wind, Response { moment, tilt, hub, uplifted_fraction }) in
        [("steady", steady), ("gust", gust)]
    {
        println!(
            "{name:<8} {wind:<7} {:>11.1} {:>11.2} {hub:>8.3} {:>15.1} {:>9.0}",
            1e-6 * moment,
            1e3 * tilt,
            1e-9 * moment / tilt,
            100.0 * uplifted_fraction
        );
    }
    Ok(())
}

fn main() -> basemat::Result<()> {
    println!("contact  wind    moment, MN·m  tilt, mrad   hub, m  secant, GN·m/rad   open, %");
    blow("bonded", Bonded)?;
    blow("lifts", Coulomb::new(0.6)?)
}
