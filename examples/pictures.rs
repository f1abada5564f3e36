//! All pictures of a run, and its files for ParaView.
//!
//! ```text
//! cargo run --release --features png --example pictures
//! ```
//!
//! A flexible tower on soil under El Centro, with a bonded base and with a base that may uplift and slide.

use std::path::Path;

use basemat::bem::Grading;
use basemat::fem::{Direction, Layer, Material, Mesh};
use basemat::io::paraview;
use basemat::plot::{self, Svg};
use basemat::prelude::*;
use basemat::results::{DeformedShape, log_spaced};
use basemat::{Result, unobserved};

const STEPS: usize = 2400;
const FRICTION: f64 = 0.3;

fn shake(law: impl InterfaceLaw + 'static) -> Result<(Run, TimeSeries, DeformedShape)> {
    let material = Material::new(1.0e9, 0.2, 800.0)?;
    let mesh = Mesh::layered_block(-4.0..4.0, 8, &[Layer::new(20.0, 16, material)])?;
    let damping = RayleighDamping::from_ratios([1.5, 15.0], [0.05; 2])?;
    let tower = FemModel::on_base(mesh)?.with_rayleigh(damping);
    let roof = tower.row(tower.mesh().node_at(0.0, 20.0)?, Direction::X)?;
    // The simulation takes ownership of the structure, so its shape is copied for the pictures.
    let shape = DeformedShape::of_model(&tower);
    let soil = Soil::from_shear_wave_speed(250.0, 0.33, 1900.0)?;
    let mut simulation = Simulation::builder(5.0e-3)
        // Two equal contact elements under each element of the mesh.
        .ground(ElasticGround::new(soil, Strip::under(&tower, 16, Grading::Uniform)?)?)
        .structure(tower)
        .interface(law)
        .motion(el_centro_1940())
        .probe(Probe::acceleration("roof", roof))
        // The bonded base has no friction of its own; its factor of safety uses this coefficient.
        .safety_friction([FRICTION])
        .build()?;
    // Base and structure at every sixth step, for pictures in time.
    let mut time_series = Recorder::new().contact(6).motion(6).start(&simulation)?;
    let run = simulation.run(STEPS, |state| time_series.record(state))?;
    Ok((run, time_series, shape))
}

fn main() -> Result<()> {
    let out = Path::new("target/pictures");
    // SVG for the web and for paper, PNG for programs that do not read SVG.
    let save = |name: &str, picture: Svg| {
        picture.save(out.join(format!("{name}.svg")))?;
        picture.save_png(out.join(format!("{name}.png")), 2.0)
    };
    let (bonded_run, bonded, _) = shake(Bonded)?;
    let (free_run, free, shape) = shake(Coulomb::new(FRICTION)?)?;
    let runs = [("bonded", &bonded), ("uplift and slip", &free)];

    for (name, quantity) in [
        ("base_shear", Quantity::BaseShear),
        ("base_moment", Quantity::BaseMoment),
        ("uplift", Quantity::UpliftedFraction),
        ("mean_slip", Quantity::MeanSlip),
        ("safety_sliding", Quantity::SlidingSafety),
        ("safety_overturning", Quantity::OverturningSafety),
    ] {
        save(name, plot::time_series("Tower under El Centro 1940", &runs, quantity)?)?;
    }
    save("roof", plot::probe_time_series("Roof acceleration", &runs, "roof")?)?;
    save("modes", plot::mode_map("Contact modes", &free)?)?;
    save("pressure", plot::pressure_envelope("Pressure under the base", &free_run)?)?;
    save("energy", plot::energy("Energy", &free)?)?;

    let periods = log_spaced(0.05, 2.0, 100)?;
    let ground = el_centro_1940().response_spectrum(&periods, 0.05, &mut unobserved)?;
    let roofs = [&bonded, &free].map(|run| run.floor_spectrum("roof", &periods, 0.05));
    let [held, loose] = roofs;
    let spectra =
        [("free field", &ground[..]), ("roof, bonded", &held?), ("roof, uplift and slip", &loose?)];
    save("spectra", plot::spectra("Floor response spectra, 5 % damping", &spectra)?)?;

    let rotation = free_run.whole.base_rotation;
    let times = [rotation.lowest.time, rotation.highest.time];
    save("shapes", plot::deformed_shapes("Largest rotations", &shape, &free, &times, 50.0)?)?;
    // Browsers play the animation.
    plot::animation("Tower", &shape, &free, 50.0, 2.0)?.save(out.join("tower_moving.svg"))?;
    let grids = paraview::write_series(out.join("vtk"), "tower", &shape, &free)?;

    println!("{free_run}");
    let mut comparison = Comparison::default();
    comparison.extend([("bonded", bonded_run), ("uplift and slip", free_run)]);
    println!("\n{comparison}\n\npictures and {grids} grids in {}", out.display());
    Ok(())
}
