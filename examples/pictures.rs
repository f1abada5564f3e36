//! All pictures of a run, and its files for ParaView.
//!
//! ```text
//! cargo run --release --features png --example pictures
//! ```
//!
//! A flexible tower on soil is shaken by El Centro, with a bonded base and with a base that may uplift and slide.

use std::any::Any;
use std::path::Path;

use basemat::bem::Grading;
use basemat::fem::{Direction, Iwan, Layer, Material, Mesh};
use basemat::io::paraview;
use basemat::plot::{self, Svg};
use basemat::prelude::*;
use basemat::results::{DeformedShape, log_spaced};
use basemat::{Result, unobserved};

const STEP_COUNT: usize = 2400;
const FRICTION_COEFFICIENT: f64 = 0.3;
const PICTURE_FOLDER: &str = "target/pictures";

/// A run of the tower, its time series, and the shape of its mesh for pictures.
struct PictureData {
    run: Run,
    series: TimeSeries,
    shape: DeformedShape,
}

fn shake(law: impl InterfaceLaw + 'static) -> Result<PictureData> {
    let material = Material::new(1.0e9, 0.2, 800.0)?;
    let mesh = Mesh::layered_block(-4.0..4.0, 8, &[Layer::new(20.0, 16, material)])?;
    let damping = RayleighDamping::from_ratios([1.5, 15.0], [0.05; 2])?;
    let tower = FemModel::on_base(mesh)?.with_rayleigh(damping);
    let roof = tower.row(tower.mesh().node_at(0.0, 20.0)?, Direction::X)?;
    // The simulation takes ownership of the structure, so its shape is copied for the pictures.
    let shape = DeformedShape::of_model(&tower);
    let soil = Soil::from_shear_wave_speed(250.0, 0.33, 1900.0)?;
    let mut simulation = Simulation::builder(5.0e-3)
        // 16 contact elements of equal length: two under each element of the mesh.
        .ground(ElasticGround::new(soil, Strip::under(&tower, 16, Grading::Uniform)?)?)
        .structure(tower)
        .interface(law)
        .motion(el_centro_1940())
        .probe(Probe::acceleration("roof", roof))
        // A bonded base has no friction coefficient; its factor of safety uses this one.
        .safety_friction([FRICTION_COEFFICIENT])
        .build()?;
    // Contact and structure are kept at every sixth step, for pictures over time.
    let mut series = Recorder::new().contact(6).motion(6).start(&simulation)?;
    let run = simulation.run(STEP_COUNT, |state| series.record(state))?;
    Ok(PictureData { run, series, shape })
}

/// Runs a bonded block of clay, and writes its plastic strains for ParaView while it runs.
fn shake_clay(folder: &Path) -> Result<()> {
    let clay = Iwan::hyperbolic(20.0e6, 40.0e3, 0.4, 0.45, 1800.0)?;
    let x_lines = [-3.0, -1.5, 0.0, 1.5, 3.0];
    let block = Mesh::quad8_block(&x_lines, &[0.0, 1.0, 2.0, 3.0], |_, _| clay.clone())?;
    let model = FemModel::on_base(block)?;
    let soil = Soil::from_shear_wave_speed(250.0, 0.33, 1900.0)?;
    let mut simulation = Simulation::builder(5.0e-3)
        .ground(ElasticGround::under(soil, &model, 8)?)
        .structure(model)
        .interface(Bonded)
        .motion(el_centro_1940())
        .build()?;
    let mut series = paraview::SolidSeries::new(folder, "clay")?;
    for step in 1..=600 {
        simulation.step()?;
        if step % 60 == 0 {
            let structure: &dyn Any = simulation.structure();
            let model: &FemModel = structure.downcast_ref().expect("the structure is a FemModel");
            series.write(simulation.state().time, model, simulation.state().displacement())?;
        }
    }
    Ok(())
}

/// Saves a picture as SVG, and as PNG with twice the resolution for programs that do not read SVG.
fn save(name: &str, picture: &Svg) -> Result<()> {
    let folder = Path::new(PICTURE_FOLDER);
    picture.save(folder.join(format!("{name}.svg")))?;
    picture.save_png(folder.join(format!("{name}.png")), 2.0)
}

fn main() -> Result<()> {
    let bonded = shake(Bonded)?;
    let contact = shake(Coulomb::new(FRICTION_COEFFICIENT)?)?;
    let series = [("bonded", &bonded.series), ("uplift and slip", &contact.series)];

    for (name, quantity) in [
        ("base_shear", Quantity::BaseShear),
        ("base_moment", Quantity::BaseMoment),
        ("uplift", Quantity::UpliftedFraction),
        ("mean_slip", Quantity::MeanSlip),
        ("safety_sliding", Quantity::SlidingSafety),
        ("safety_overturning", Quantity::OverturningSafety),
    ] {
        save(name, &plot::time_series("Tower under El Centro 1940", &series, quantity)?)?;
    }
    save("roof", &plot::probe_time_series("Roof acceleration", &series, "roof")?)?;
    let rocking =
        [("bonded", bonded.series.rocking(0)?), ("uplift and slip", contact.series.rocking(0)?)];
    save("moment_rotation", &plot::moment_rotation("Rocking of the base", &rocking, &[])?)?;
    save("settlement_rotation", &plot::settlement_rotation("Rocking of the base", &rocking, &[])?)?;
    save("modes", &plot::mode_map("Contact modes", &contact.series)?)?;
    save("pressure", &plot::pressure_envelope("Pressure under the base", &contact.run)?)?;
    save("energy", &plot::energy("Energy", &contact.series)?)?;

    let periods = log_spaced(0.05, 2.0, 100)?;
    let free_field = el_centro_1940().response_spectrum(&periods, 0.05, &mut unobserved)?;
    let bonded_roof = bonded.series.floor_spectrum("roof", &periods, 0.05)?;
    let contact_roof = contact.series.floor_spectrum("roof", &periods, 0.05)?;
    let spectra = [
        ("free field", &free_field[..]),
        ("roof, bonded", &bonded_roof),
        ("roof, uplift and slip", &contact_roof),
    ];
    save("spectra", &plot::spectra("Floor response spectra, 5 % damping", &spectra)?)?;

    let base_rotation = contact.run.whole.base_rotation;
    let times = [base_rotation.lowest.time, base_rotation.highest.time];
    save(
        "shapes",
        &plot::deformed_shapes("Largest rotations", &contact.shape, &contact.series, &times, 50.0)?,
    )?;
    // Browsers play the animation.
    let folder = Path::new(PICTURE_FOLDER);
    plot::animation("Tower", &contact.shape, &contact.series, 50.0, 2.0)?
        .save(folder.join("tower_moving.svg"))?;
    let grids =
        paraview::write_series(folder.join("vtk"), "tower", &contact.shape, &contact.series)?;

    shake_clay(&folder.join("vtk"))?;

    println!("{}", contact.run);
    let mut comparison = Comparison::default();
    comparison.extend([("bonded", bonded.run), ("uplift and slip", contact.run)]);
    println!("\n{comparison}\n\npictures and {grids} grids in {}", folder.display());
    Ok(())
}
