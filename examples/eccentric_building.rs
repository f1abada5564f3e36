//! A storey building in plan whose walls stand at one end: drifts of both ends, bonded and with uplift and sliding.
//!
//! ```text
//! cargo run --release --example eccentric_building
//! ```
//!
//! Four floors of 20 × 12 m on a mat are shaken across their long side. A stiff staircase moves the centre of
//! stiffness 5 m to the left, so the right end drifts most. The mat twists on the soil, which reduces that
//! drift.

use basemat::motion::Triaxial;
use basemat::prelude::*;
use basemat::structure::{ModalDamping, PlanStorey, RigidBody, StoreyBuilding};

const SIDES: [f64; 2] = [20.0, 12.0];
const STEP: f64 = 0.005;

/// The building with its walls at the distance `eccentricity` (m) from the middle.
fn building(eccentricity: f64) -> basemat::Result<StoreyBuilding> {
    let mat = RigidBody::cuboid([SIDES[0], SIDES[1], 1.0], 2500.0)?;
    let storey = PlanStorey::new(3.2, 240.0e3, SIDES, [4.0e8, 3.0e8, 1.5e10]);
    StoreyBuilding::new(mat, &[PlanStorey { stiffness_center: [eccentricity, 0.0], ..storey }; 4])
}

/// Largest transverse drifts of the lowest storey at its left and right end (mm), and the run.
fn shake(eccentricity: f64, law: impl InterfaceLaw + 'static) -> basemat::Result<([f64; 2], Run)> {
    let own = building(eccentricity)?;
    let [left, right] = [-0.5, 0.5].map(|part| own.drift_at(0, [part * SIDES[0], 0.0]));
    let ([_, left, _], [_, right, _]) = (left?, right?);
    let soil = Soil::from_shear_wave_speed(200.0, 1.0 / 3.0, 1900.0)?;
    let ground = ElasticGround::under(soil, &own, 6)?;
    let record = el_centro_1940();
    let mut simulation = Simulation::builder(STEP)
        .structure(ModalDamping::new(&[0.05])?.on_fixed_base(own)?)
        .ground(ground)
        .interface(law)
        .motion(Triaxial { y: Some(record), ..Triaxial::default() })
        .probe(Probe::displacement("left", left))
        .probe(Probe::displacement("right", right))
        .expected_steps(2400)
        .build()?;
    let run = simulation.run(2400, |_| {})?;
    assert!(run.energy_error < 1e-9);
    let drift = |name: &str| run.probe(name).map(|own| 1e3 * own.magnitude());
    Ok(([drift("left")?, drift("right")?], run))
}

fn main() -> basemat::Result<()> {
    let modes = ModalDamping::new(&[0.05])?.on_fixed_base(building(-5.0)?)?;
    let [first, second, third] = [0, 1, 2].map(|k| modes.frequencies()[k]);
    println!("fixed base: {first:.2}, {second:.2}, {third:.2} Hz\n");

    println!("walls     contact    drift left   right, mm   torque, MN·m   uplifted, m²");
    for (walls, eccentricity) in [("middle", 0.0), ("left end", -5.0)] {
        for bonded in [true, false] {
            let (contact, ([left, right], run)) = if bonded {
                ("bonded", shake(eccentricity, Bonded)?)
            } else {
                ("friction", shake(eccentricity, Coulomb::new(0.6)?)?)
            };
            let torque = 1e-6 * run.whole.torque.magnitude();
            let area = run.whole.uplifted_area.highest.value;
            println!(
                "{walls:<9} {contact:<8} {left:>12.2} {right:>11.2} {torque:>14.2} {area:>14.1}"
            );
        }
    }
    Ok(())
}
