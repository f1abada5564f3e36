//! An L-shaped mat, defined by matrices, that uplifts and slides.
//!
//! ```text
//! cargo run --release --example l_shaped_mat
//! ```
//!
//! Two rigid wings of 24 × 8 m and 8 × 12 m, 18 m high, stand on one mat on soil of 250 m/s. The mass matrix
//! is written by hand, as another program would provide it; the base has two faces. A record along x causes motion in
//! all directions. Writes a picture of the
//! contact to `target`.

use basemat::motion::Triaxial;
use basemat::plot::contact_plan;
use basemat::prelude::*;
use basemat::structure::{BaseNode, MatrixModel};

/// Ends of each wing along x and y, m.
const WING_ENDS: [[[f64; 2]; 2]; 2] = [[[0.0, 24.0], [0.0, 8.0]], [[0.0, 8.0], [8.0, 20.0]]];
/// Height of both wings, m.
const BUILDING_HEIGHT: f64 = 18.0;
/// Mean density, kg/m³.
const MASS_DENSITY: f64 = 350.0;
/// Point of the degrees of freedom u_x, u_y, u_z, r_x, r_y, r_z: the middle of the bounding box.
const MAT_CENTER: [f64; 2] = [12.0, 10.0];
/// Number of steps of 0.01 s.
const STEP_COUNT: usize = 1000;

/// Adds the mass of a cuboid. Its centre moves by u + r × (x, y, z), and it rotates about its centre.
fn add_wing(mass: &mut Triplets, along_x: [f64; 2], along_y: [f64; 2]) {
    let length = along_x[1] - along_x[0];
    let width = along_y[1] - along_y[0];
    let m = MASS_DENSITY * length * width * BUILDING_HEIGHT;
    let x = 0.5 * (along_x[0] + along_x[1]) - MAT_CENTER[0];
    let y = 0.5 * (along_y[0] + along_y[1]) - MAT_CENTER[1];
    let z = 0.5 * BUILDING_HEIGHT;
    mass.add_outer([(0, 1.0), (4, z), (5, -y)], m);
    mass.add_outer([(1, 1.0), (5, x), (3, -z)], m);
    mass.add_outer([(2, 1.0), (3, y), (4, -x)], m);
    for (axis, [a, b]) in [[width, BUILDING_HEIGHT], [length, BUILDING_HEIGHT], [length, width]]
        .iter()
        .enumerate()
    {
        mass.add(3 + axis, 3 + axis, m * (a * a + b * b) / 12.0);
    }
}

fn main() -> basemat::Result<()> {
    let mut mass = Triplets::new(6);
    let mut faces = Vec::new();
    for [along_x @ [left, right], along_y @ [front, back]] in WING_ENDS {
        add_wing(&mut mass, along_x, along_y);
        let corners = [[left, front], [right, front], [right, back], [left, back]];
        let from_center = corners.map(|[x, y]| [x - MAT_CENTER[0], y - MAT_CENTER[1]]);
        faces.push(BaseNode::rigid_face(&from_center, MAT_CENTER, [0, 1, 2, 3, 4, 5]));
    }
    // A rigid body has no stiffness.
    let body = MatrixModel::new(mass, Triplets::new(6), Base::Faces(faces))?;

    let soil = Soil::from_shear_wave_speed(250.0, 1.0 / 3.0, 1900.0)?;
    let ground = ElasticGround::under(soil, &body, 10)?;
    let record = el_centro_1940();
    let mut simulation = Simulation::builder(0.01)
        .structure(body)
        .ground(ground)
        .interface(Coulomb::new(0.5)?)
        .motion(Triaxial { x: Some(record.scaled(1.5)?), ..Triaxial::default() })
        .expected_steps(STEP_COUNT)
        .build()?;
    let mut series = Recorder::new().contact(1).start(&simulation)?;
    let run = simulation.run(STEP_COUNT, |state| series.record(state))?;

    println!("                                along x    along y");
    for (name, factor, along_x, along_y) in [
        ("base shear, MN", 1e-6, Quantity::BaseShear, Quantity::ShearAcross),
        ("overturning moment, MN·m", 1e-6, Quantity::BaseMoment, Quantity::MomentAcross),
        ("rotation that way, mrad", 1e3, Quantity::BaseRotation, Quantity::RotationAcross),
        ("mean slip, mm", 1e3, Quantity::MeanSlip, Quantity::MeanSlipAcross),
    ] {
        let x = factor * run.whole.extremes(along_x).magnitude();
        let y = factor * run.whole.extremes(along_y).magnitude();
        println!("{name:<28} {x:>10.2} {y:>10.2}");
    }
    let whole = &run.whole;
    println!("\ntorque {:.1} MN·m", 1e-6 * whole.torque.magnitude());
    println!("twist at the end {:.3} mrad", 1e3 * series.series(Quantity::Twist)[STEP_COUNT]);
    let uplift = whole.uplifted_area.highest;
    println!("uplifted area {:.0} m² at {:.2} s", uplift.value, uplift.time);
    if let Some((pressed, peak)) = run.largest_pressure() {
        let center = pressed.element.center();
        println!(
            "largest pressure {:.0} kPa at ({:.1}, {:.1})",
            1e-3 * peak.value,
            center[0],
            center[1]
        );
    }
    contact_plan("L-shaped mat", &series, uplift.time)?.save("target/l_shaped_mat.svg")?;
    println!("energy error {:.0e}", run.energy_error);
    assert!(run.energy_error < 1e-9);
    Ok(())
}
