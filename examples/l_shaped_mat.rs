//! An L-shaped mat given by matrices that uplifts and slides: a record along x, motion in all directions.
//!
//! ```text
//! cargo run --release --example l_shaped_mat
//! ```
//!
//! Two rigid wings of 24 × 8 m and 8 × 12 m, 18 m high, stand on one mat on soil of 250 m/s. The mass matrix
//! is written by hand, as another program would provide it; the base has two faces. Writes a picture of the
//! contact to `target`.

use basemat::motion::Triaxial;
use basemat::plot::contact_plan;
use basemat::prelude::*;
use basemat::structure::{BaseNode, MatrixModel};

/// Ends of each wing along x and y, m; height, m; density, kg/m³.
const WINGS: [[[f64; 2]; 2]; 2] = [[[0.0, 24.0], [0.0, 8.0]], [[0.0, 8.0], [8.0, 20.0]]];
const HEIGHT: f64 = 18.0;
const DENSITY: f64 = 350.0;
/// Point of the degrees of freedom u_x, u_y, u_z, r_x, r_y, r_z: the middle of the bounding box.
const CENTER: [f64; 2] = [12.0, 10.0];

/// Adds the mass of a cuboid. Its centre moves by u + r × (x, y, z), and it rotates about its centre.
fn add_wing(mass: &mut Triplets, [along, across]: [[f64; 2]; 2]) {
    let [length, width] = [along, across].map(|[low, high]| high - low);
    let m = DENSITY * length * width * HEIGHT;
    let [x, y] = [0, 1].map(|k| 0.5 * ([along, across][k][0] + [along, across][k][1]) - CENTER[k]);
    let z = 0.5 * HEIGHT;
    mass.add_outer([(0, 1.0), (4, z), (5, -y)], m);
    mass.add_outer([(1, 1.0), (5, x), (3, -z)], m);
    mass.add_outer([(2, 1.0), (3, y), (4, -x)], m);
    for (axis, [a, b]) in [[width, HEIGHT], [length, HEIGHT], [length, width]].iter().enumerate() {
        mass.add(3 + axis, 3 + axis, m * (a * a + b * b) / 12.0);
    }
}

fn main() -> basemat::Result<()> {
    let mut mass = Triplets::new(6);
    let mut faces = Vec::new();
    for wing in WINGS {
        add_wing(&mut mass, wing);
        let [[left, right], [front, back]] = wing;
        let corners = [[left, front], [right, front], [right, back], [left, back]];
        let from_center = corners.map(|[x, y]| [x - CENTER[0], y - CENTER[1]]);
        faces.push(BaseNode::rigid_face(&from_center, CENTER, [0, 1, 2, 3, 4, 5]));
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
        .expected_steps(1000)
        .build()?;
    let mut series = Recorder::new().contact(1).start(&simulation)?;
    let run = simulation.run(1000, |state| series.record(state))?;

    println!("                                along x    along y");
    let row = |name: &str, factor: f64, pair: [Quantity; 2]| {
        let [x, y] = pair.map(|quantity| factor * run.whole.extremes(quantity).magnitude());
        println!("{name:<28} {x:>10.2} {y:>10.2}");
    };
    row("base shear, MN", 1e-6, [Quantity::BaseShear, Quantity::ShearAcross]);
    row("overturning moment, MN·m", 1e-6, [Quantity::BaseMoment, Quantity::MomentAcross]);
    row("rotation that way, mrad", 1e3, [Quantity::BaseRotation, Quantity::RotationAcross]);
    row("mean slip, mm", 1e3, [Quantity::MeanSlip, Quantity::MeanSlipAcross]);
    let whole = &run.whole;
    println!("\ntorque {:.1} MN·m", 1e-6 * whole.torque.magnitude());
    println!("twist at the end {:.3} mrad", 1e3 * series.series(Quantity::Twist)[1000]);
    let (area, time) = (whole.uplifted_area.highest.value, whole.uplifted_area.highest.time);
    println!("uplifted area {area:.0} m² at {time:.2} s");
    if let Some((own, peak)) = run.largest_pressure() {
        let [x, y, _] = own.element.center();
        println!("largest pressure {:.0} kPa at ({x:.1}, {y:.1})", 1e-3 * peak.value);
    }
    contact_plan("L-shaped mat", &series, time)?.save("target/l_shaped_mat.svg")?;
    println!("energy error {:.0e}", run.energy_error);
    assert!(run.energy_error < 1e-9);
    Ok(())
}
