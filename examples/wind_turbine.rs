//! The octagonal mat of a wind turbine under the extreme operating gust.
//!
//! ```text
//! cargo run --release --example wind_turbine
//! ```
//!
//! The hub is 92 m above an octagonal mat 20 m wide. The gust is the "Mexican hat" of IEC 61400-1. The thrust
//! coefficient of the rotor is constant, as if its control did not yet react. In normal operation, practice allows no
//! gap under the mat (IEC 61400-6); under extreme loads, at least half of the mat must be in contact. In steady wind
//! the whole mat is in contact; the gust opens more than a third of it. A bonded mat is computed for comparison. The
//! matrices of the structure are written by hand: the mass of a `RigidBody`, and a hub that moves along x and y on a
//! cantilever.

use std::f64::consts::{PI, TAU};

use basemat::coupled::Load;
use basemat::prelude::*;
use basemat::structure::{MatrixModel, RigidBody};

/// Width of the octagon between parallel sides, m.
const OCTAGON_WIDTH: f64 = 20.0;
/// Height of mat and fill, m.
const MAT_HEIGHT: f64 = 3.0;
/// Height of the hub above the base, m.
const HUB_HEIGHT: f64 = 92.0;
/// Mean density of concrete and fill, kg/m³.
const MAT_DENSITY: f64 = 2200.0;
/// Mass of rotor, nacelle and upper half of the tower, kg.
const TOWER_TOP_MASS: f64 = 280.0e3;
/// Mass of the lower half of the tower, kg.
const TOWER_FOOT_MASS: f64 = 150.0e3;
/// Frequency on a fixed base, Hz.
const FIXED_BASE_FREQUENCY: f64 = 0.33;
/// Damping ratio of the tower, aerodynamic and structural.
const TOWER_DAMPING: f64 = 0.04;
/// Diameter of the rotor, m.
const ROTOR_DIAMETER: f64 = 112.0;
/// Thrust coefficient of the rotor.
const THRUST_COEFFICIENT: f64 = 0.8;
/// Density of air, kg/m³.
const AIR_DENSITY: f64 = 1.225;
/// Mean wind at the hub, m/s.
const MEAN_WIND: f64 = 12.0;
/// Start of the gust, s.
const GUST_START: f64 = 2.0;
/// Duration of the gust, s.
const GUST_DURATION: f64 = 10.5;
/// Number of steps of 0.01 s.
const STEP_COUNT: usize = 1500;

/// Wind at the hub (m/s) over time (s): the extreme operating gust for turbulence of class A and the scale Λ₁ = 42 m.
fn wind(time: f64) -> f64 {
    let standard_deviation = 0.16 * (0.75 * MEAN_WIND + 5.6);
    let gust_magnitude = 3.3 * standard_deviation / (1.0 + 0.1 * ROTOR_DIAMETER / 42.0);
    let gust_fraction = (time - GUST_START).clamp(0.0, GUST_DURATION) / GUST_DURATION;
    MEAN_WIND
        - 0.37
            * gust_magnitude
            * (3.0 * PI * gust_fraction).sin()
            * (1.0 - (TAU * gust_fraction).cos())
}

/// Thrust on the rotor (N) over time (s).
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
    let tilting_inertia = plate_inertia + mat_mass * MAT_HEIGHT * MAT_HEIGHT / 12.0;
    let inertia =
        [[tilting_inertia, 0.0, 0.0], [0.0, tilting_inertia, 0.0], [0.0, 0.0, 2.0 * plate_inertia]];
    let body = RigidBody::from_mass(outline, mat_mass, inertia, [0.0, 0.0, 0.5 * MAT_HEIGHT])?;

    let mut mass = Triplets::new(8);
    let mut stiffness = Triplets::new(8);
    let mut damping = Triplets::new(8);
    body.mass(&mut mass)?;
    // Height of the middle of the tower's lower half.
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

/// Response of the turbine at one instant, with the static state.
#[derive(Clone, Copy)]
struct Response {
    /// Overturning moment on the mat, N·m.
    moment: f64,
    /// Tilt of the mat, rad.
    tilt: f64,
    /// Displacement of the hub, m.
    hub: f64,
    /// Open part of the mat's area.
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

/// Prints moment, tilt, displacement of the hub and uplift, in steady wind and at the largest tilt in the gust.
fn blow(name: &str, law: impl InterfaceLaw + 'static) -> basemat::Result<()> {
    let turbine = turbine()?;
    let soil = Soil::from_shear_wave_speed(160.0, 0.4, 1900.0)?;
    let mut simulation = Simulation::builder(0.01)
        .ground(ElasticGround::under(soil, &turbine, 12)?)
        .structure(turbine)
        .interface(law)
        .load(Load::new(6, thrust))
        .expected_steps(STEP_COUNT)
        .build()?;
    let static_displacement = simulation.static_displacement().to_vec();
    let steady_response = Response::new(simulation.state(), &static_displacement);
    let mut gust_response = steady_response;
    let run = simulation.run(STEP_COUNT, |state| {
        let response = Response::new(state, &static_displacement);
        if response.tilt > gust_response.tilt {
            gust_response = response;
        }
    })?;
    assert!(run.energy_error < 1e-9);
    for (wind, Response { moment, tilt, hub, uplifted_fraction }) in
        [("steady", steady_response), ("gust", gust_response)]
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
