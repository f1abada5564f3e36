//! A shallow footing that rocks on sand and settles.
//!
//! ```text
//! cargo run --release --example rocking_footing
//! ```
//!
//! A wall stands on a footing of 5 × 2 m in sand. The bearing pressure of the sand follows from its friction angle, and
//! is the upper limit of the pressure under each cell. The sand under a cell settles in every cycle of load. As the
//! footing rocks, the force on the soil moves to an edge. When the pressure at the edge has reached the bearing
//! pressure, the moment has reached its capacity. Stronger shaking then hardly increases the moment; instead the
//! footing tilts more and settles more.

use basemat::interface::CyclicYielding;
use basemat::motion::Triaxial;
use basemat::prelude::*;
use basemat::soil::{ShallowFooting, SoilStrength};
use basemat::structure::RigidBody;

/// Sides of the footing along x and y, m.
const FOOTING_SIDES: [f64; 2] = [5.0, 2.0];
/// Depth of the footing, m.
const FOOTING_DEPTH: f64 = 0.5;
/// Density of the sand, kg/m³.
const SAND_DENSITY: f64 = 1700.0;
/// Settlement under half of the bearing pressure, m.
const REFERENCE_SETTLEMENT: f64 = 5.0e-3;
/// Range of pressure in which the sand stays elastic, relative to the bearing pressure.
const ELASTIC_RANGE: f64 = 0.1;
/// Mass of wall and footing, kg.
const WALL_MASS: f64 = 150.0e3;
/// Height of the centre of mass above the base, m.
const WALL_CENTER_HEIGHT: f64 = 4.0;

/// The wall with its footing, as one rigid body.
fn wall() -> basemat::Result<RigidBody> {
    let [x, y] = FOOTING_SIDES.map(|side| 0.5 * side);
    let outline = vec![[-x, -y], [x, -y], [x, y], [-x, y]];
    // Moments of inertia of a wall twice as high as the centre, 4 m long and 0.5 m thick.
    let cuboid_inertia = |a: f64, b: f64| WALL_MASS * (a * a + b * b) / 12.0;
    let height = 2.0 * WALL_CENTER_HEIGHT;
    let inertia = [
        [cuboid_inertia(0.5, height), 0.0, 0.0],
        [0.0, cuboid_inertia(4.0, height), 0.0],
        [0.0, 0.0, cuboid_inertia(4.0, 0.5)],
    ];
    RigidBody::from_mass(outline, WALL_MASS, inertia, [0.0, 0.0, WALL_CENTER_HEIGHT])
}

fn main() -> basemat::Result<()> {
    let sand = SoilStrength::new(30.0_f64.to_radians())?;
    let unit_weight = SAND_DENSITY * STANDARD_GRAVITY;
    let footing =
        ShallowFooting::rectangle(FOOTING_SIDES)?.with_surcharge(FOOTING_DEPTH * unit_weight)?;
    let bearing_pressure = footing.drained_pressure(&sand, unit_weight)?;
    let sand_law = CyclicYielding::new(bearing_pressure, REFERENCE_SETTLEMENT, 0.6)?
        .with_elastic_range(ELASTIC_RANGE)?
        .with_depth_gradient(footing.pressure_growth(&sand, unit_weight)?)?;
    let weight = WALL_MASS * STANDARD_GRAVITY;
    let capacity = footing.rocking_capacity(weight, bearing_pressure)?;
    println!(
        "bearing pressure {:.0} kPa, {:.1} times the mean pressure; moment capacity {:.2} MN·m\n",
        1e-3 * bearing_pressure,
        1.0 / capacity.contact_ratio,
        1e-6 * capacity.moments[0]
    );

    println!(
        "El Centro ×   moment, MN·m   of capacity   open, %   rotation left, mrad   settled, mm"
    );
    for factor in [0.4, 0.8, 1.2] {
        let soil = Soil::from_shear_wave_speed(180.0, 0.3, SAND_DENSITY)?;
        let wall = wall()?;
        let mut simulation = Simulation::builder(0.005)
            .ground(ElasticGround::under(soil, &wall, 6)?)
            .structure(wall)
            .interface(sand_law)
            .motion(Triaxial { x: Some(el_centro_1940().scaled(factor)?), ..Triaxial::default() })
            .build()?;
        let steps = simulation.steps_for(20.0);
        let run = simulation.run(steps, |_| {})?;
        let moment = run.whole.base_moment.magnitude();
        let state = simulation.state();
        println!(
            "{factor:9.1}{:16.2}{:14.2}{:11.0}{:17.2}{:18.2}",
            1e-6 * moment,
            moment / capacity.moments[0],
            1e2 * run.whole.uplifted_fraction.magnitude(),
            1e3 * state.base_rotation,
            1e3 * run.whole.residual_settlement,
        );
        assert!(run.energy_error < 1e-9);
        // Vertical accelerations of the rocking wall change the force on the soil, and thereby the moment capacity.
        assert!(moment < 1.25 * capacity.moments[0]);
    }
    Ok(())
}
