//! A building on a raft that lifts and slides; its mesh was made by Gmsh.
//!
//! ```text
//! cargo run --release --example raft_from_gmsh
//! ```
//!
//! `examples/data/raft_building.py` writes the mesh with Gmsh's module for Python. The elements of raft, floors, core
//! and columns are groups with these names in the mesh; thicknesses, sections and materials are defined in this
//! example. The core stands at one end of the building, so an earthquake along y turns the building, and the far corner
//! of the roof moves most.

use basemat::fem::{BeamSection, Direction, Material};
use basemat::io::{GmshPart, GmshSpaceMesh};
use basemat::motion::Triaxial;
use basemat::prelude::*;

const GMSH_FILE: &[u8] = include_bytes!("data/raft_building.msh");
/// Time step, s.
const TIME_STEP: f64 = 0.01;
const STEP_COUNT: usize = 1000;

/// The building, and the node at the far corner of its roof.
fn building() -> basemat::Result<(FemModel, usize)> {
    let concrete = Material::new(30.0e9, 0.2, 2500.0)?;
    // Floors 25 cm thick; their density includes 300 kg/m² of finishes and live load.
    let floor = Material::new(30.0e9, 0.2, 2500.0 + 300.0 / 0.25)?;
    // Columns of 50 cm × 50 cm; the torsion constant of a square of side a is 0.1406 a⁴.
    let column_side = 0.5_f64;
    let second_moment = column_side.powi(4) / 12.0;
    let column = BeamSection::new(
        column_side * column_side,
        [second_moment; 2],
        0.1406 * column_side.powi(4),
    )?;

    let gmsh = GmshSpaceMesh::from_reader("raft_building.msh", GMSH_FILE)?;
    let mesh = gmsh.mesh(&[
        ("raft", GmshPart::Shell(concrete, 0.9)),
        ("floors", GmshPart::Shell(floor, 0.25)),
        ("core", GmshPart::Shell(concrete, 0.3)),
        ("columns", GmshPart::Beam(concrete, column, [1.0, 0.0, 0.0])),
    ])?;
    let roof_corner = gmsh.cells(0, "roof corner")?[0][0];
    let model = FemModel::on_faces(mesh, &gmsh.cells(2, "raft")?)?;
    let damping = RayleighDamping::from_ratios([1.5, 15.0], [0.05, 0.05])?;
    Ok((model.with_rayleigh(damping), roof_corner))
}

fn main() -> basemat::Result<()> {
    let (model, roof_corner) = building()?;
    let mut mass = Triplets::new(model.dofs());
    model.mass(&mut mass)?;
    let vertical_motion = model.rigid_motion(Direction::Z, [0.0; 3]);
    let total_mass: f64 = mass
        .entries()
        .iter()
        .map(|&(i, j, m)| vertical_motion[i] * m * vertical_motion[j])
        .sum();
    println!("{} degrees of freedom, {:.0} t", model.dofs(), 1e-3 * total_mass);

    let soil = Soil::from_shear_wave_speed(250.0, 1.0 / 3.0, 1900.0)?;
    println!();
    println!(
        "               base shear/weight   uplifted, %   slip, mm   roof corner, mm   energy error"
    );
    let laws: [(&str, Box<dyn InterfaceLaw>); 2] =
        [("bonded", Box::new(Bonded)), ("opens, slides", Box::new(Coulomb::new(0.4)?))];
    for (name, law) in laws {
        let run = Simulation::builder(TIME_STEP)
            .ground(ElasticGround::under(soil, &model, 8)?)
            .structure(model.clone())
            .interface(law)
            .motion(Triaxial { y: Some(el_centro_1940()), ..Triaxial::default() })
            .probe(Probe::displacement("corner", model.row(roof_corner, Direction::Y)?))
            .expected_steps(STEP_COUNT)
            .build()?
            .run(STEP_COUNT, |_| {})?;
        println!(
            "{name:<14} {:>17.2} {:>13.1} {:>10.1} {:>17.1} {:>14.1e}",
            run.shear_coefficient().unwrap_or(0.0),
            100.0 * run.whole.uplifted_fraction.magnitude(),
            1e3 * run.whole.mean_slip.magnitude(),
            1e3 * run.probe("corner")?.magnitude(),
            run.energy_error,
        );
        for warning in &run.warnings {
            println!("  {warning}");
        }
        assert!(run.energy_error < 1e-9);
    }
    Ok(())
}
