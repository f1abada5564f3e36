//! Drifts of a storey building in plan whose walls stand at one end.
//!
//! ```text
//! cargo run --release --example eccentric_building
//! ```
//!
//! Four floors of 20 × 12 m on a mat are shaken across their long side. A stiff staircase moves the centre of
//! stiffness 5 m to the left, so the right end drifts most. The mat twists on the soil, which reduces that
//! drift. A bonded mat is compared with one that may uplift and slide.

use basemat::motion::Triaxial;
use basemat::prelude::*;
use basemat::structure::{ModalDamping, PlanStorey, RigidBody, StoreyBuilding};

/// Length of the floors along x and their width along y, m.
const FLOOR_SIDES: [f64; 2] = [20.0, 12.0];
/// Time step, s.
const TIME_STEP: f64 = 0.005;
const STEP_COUNT: usize = 2400;

/// The building with its walls at the distance `eccentricity` (m) from the middle.
fn building(eccentricity: f64) -> basemat::Result<StoreyBuilding> {
    let mat = RigidBody::cuboid([FLOOR_SIDES[0], FLOOR_SIDES[1], 1.0], 2500.0)?;
    let storey = PlanStorey::new(3.2, 240.0e3, FLOOR_SIDES, [4.0e8, 3.0e8, 1.5e10]);
    StoreyBuilding::new(mat, &[PlanStorey { stiffness_center: [eccentricity, 0.0], ..storey }; 4])
}

/// Runs the building; the probes are the transverse drifts of the lowest storey at both ends of the floor.
fn shake(eccentricity: f64, law: impl InterfaceLaw + 'static) -> basemat::Result<Run> {
    let building = building(eccentricity)?;
    // A drift at a point has the components x, y and twist; y is transverse.
    let left_drift = building.drift_at(0, [-0.5 * FLOOR_SIDES[0], 0.0])?[1].clone();
    let right_drift = building.drift_at(0, [0.5 * FLOOR_SIDES[0], 0.0])?[1].clone();
    let soil = Soil::from_shear_wave_speed(200.0, 1.0 / 3.0, 1900.0)?;
    let ground = ElasticGround::under(soil, &building, 6)?;
    let record = el_centro_1940();
    let mut simulation = Simulation::builder(TIME_STEP)
        .structure(ModalDamping::new(&[0.05])?.on_fixed_base(building)?)
        .ground(ground)
        .interface(law)
        .motion(Triaxial { y: Some(record), ..Triaxial::default() })
        .probe(Probe::displacement("left", left_drift))
        .probe(Probe::displacement("right", right_drift))
        .expected_steps(STEP_COUNT)
        .build()?;
    let run = simulation.run(STEP_COUNT, |_| {})?;
    assert!(run.energy_error < 1e-9);
    Ok(run)
}

fn main() -> basemat::Result<()> {
    let damped_structure = ModalDamping::new(&[0.05])?.on_fixed_base(building(-5.0)?)?;
    let modes = damped_structure.frequencies();
    println!("fixed base: {:.2}, {:.2}, {:.2} Hz\n", modes[0], modes[1], modes[2]);

    println!("walls     contact    drift left   right, mm   torque, MN·m   uplifted, m²");
    for (walls, eccentricity) in [("middle", 0.0), ("left end", -5.0)] {
        let bonded = shake(eccentricity, Bonded)?;
        let free = shake(eccentricity, Coulomb::new(0.6)?)?;
        for (contact, run) in [("bonded", bonded), ("friction", free)] {
            let left = 1e3 * run.probe("left")?.magnitude();
            let right = 1e3 * run.probe("right")?.magnitude();
            let torque = 1e-6 * run.whole.torque.magnitude();
            let area = run.whole.uplifted_area.highest.value;
            println!(
                "{walls:<9} {contact:<8} {left:>12.2} {right:>11.2} {torque:>14.2} {area:>14.1}"
            );
        }
    }
    Ok(())
}
