//! El Centro on a containment that may uplift and slide.
//!
//! It is the problem of Patel & Spyrakos, "Uplifting-sliding response of flexible structures to seismic loads".
//!
//! ```text
//! cargo run --release --example containment
//! ```
//!
//! The five runs are those of the paper's Table 1: bonded, uplift only, friction 0.4, 0.3 and 0.2. The example prints a
//! table, and writes time series as CSV and pictures to `target/containment`. The paper's figure with the dimensions
//! was not available to us. Contact length and height are therefore calibrated on the first two rows of Table 1, and
//! the density of the soil is assumed.

use std::path::Path;

use basemat::Result;
use basemat::fem::{Direction, Layer, Material, Mesh, QuadFormulation};
use basemat::plot;
use basemat::prelude::*;

/// The paper's unit of length, m.
const FOOT_IN_METRES: f64 = 0.3048;
/// The paper's unit of stress, Pa.
const POUND_PER_SQUARE_FOOT: f64 = 47.880_258_980_335_84;
/// The paper's unit of density, kg/m³.
const SLUG_PER_CUBIC_FOOT: f64 = 515.378_818_393_229_5;
/// The paper's unit of force per width, N/m.
const POUND_PER_FOOT: f64 = 14.593_902_937_206_364;

/// Length of the contact with the ground, ft.
const CONTACT_LENGTH: f64 = 34.0;
/// Height, ft.
const CONTAINMENT_HEIGHT: f64 = 80.0;
/// Number of elements along the base.
const BASE_ELEMENTS: usize = 10;
/// Number of layers of rectangles.
const ELEMENT_LAYERS: usize = 13;

/// Cases of Table 1: name, friction coefficient (`None`: bonded), and the paper's peak base shear, lb/ft.
const PAPER_CASES: [(&str, Option<f64>, f64); 5] = [
    ("bonded", None, 28_970.0),
    ("uplift only", Some(f64::INFINITY), 20_130.0),
    ("friction 0.4", Some(0.4), 10_233.0),
    ("friction 0.3", Some(0.3), 6_415.0),
    ("friction 0.2", Some(0.2), 5_958.0),
];

/// Half the contact length, m.
const HALF_CONTACT_LENGTH: f64 = 0.5 * CONTACT_LENGTH * FOOT_IN_METRES;

/// Height of a layer of rectangles, m.
const LAYER_HEIGHT: f64 = CONTAINMENT_HEIGHT * FOOT_IN_METRES / ELEMENT_LAYERS as f64;

/// Material from Young's modulus (lb/ft²) and density (slug/ft³).
fn material(young_modulus: f64, density: f64) -> Result<Material> {
    Material::new(young_modulus * POUND_PER_SQUARE_FOOT, 1.0 / 3.0, density * SLUG_PER_CUBIC_FOOT)
}

/// Rows of rectangles without incompatible modes, as in the paper.
fn rectangles(height: f64, rows: usize, material: Material) -> Layer {
    Layer { formulation: QuadFormulation::Full, ..Layer::new(height, rows, material) }
}

/// Finite elements: the lowest layer is the basemat, the twelve above it the containment.
fn structure() -> Result<FemModel> {
    let foundation = rectangles(LAYER_HEIGHT, 1, material(106_560_369.0, 3.043_48)?);
    let superstructure_height = (ELEMENT_LAYERS - 1) as f64 * LAYER_HEIGHT;
    let superstructure =
        rectangles(superstructure_height, ELEMENT_LAYERS - 1, material(106_577_648.0, 0.590_06)?);
    let layers = [foundation, superstructure];
    FemModel::on_base(Mesh::layered_block(
        -HALF_CONTACT_LENGTH..HALF_CONTACT_LENGTH,
        BASE_ELEMENTS,
        &layers,
    )?)
}

/// Runs the whole record; returns the run and its time series.
fn shake(friction: Option<f64>) -> Result<(Run, TimeSeries)> {
    let model = structure()?;
    // Displacement of a corner of the roof, and force of the superstructure on the foundation.
    let corner =
        model.mesh().node_at(-HALF_CONTACT_LENGTH, ELEMENT_LAYERS as f64 * LAYER_HEIGHT)?;
    let roof_x = Probe::absolute_displacement("roof x", model.row(corner, Direction::X)?);
    let roof_y = Probe::absolute_displacement("roof y", model.row(corner, Direction::Y)?);
    let shear = Probe::section("base shear", &model.section(LAYER_HEIGHT, 0.0)?.shear);

    let soil = Soil::from_wave_speeds(
        650.0 * FOOT_IN_METRES,
        1300.0 * FOOT_IN_METRES,
        3.5 * SLUG_PER_CUBIC_FOOT,
    )?;
    // A pressure wave crosses half an element in a step.
    let builder = Simulation::builder(0.5 * (CONTACT_LENGTH / BASE_ELEMENTS as f64) / 1300.0)
        .structure(model)
        .ground(ElasticGround::new(
            soil,
            Strip::uniform(-HALF_CONTACT_LENGTH..HALF_CONTACT_LENGTH, BASE_ELEMENTS)?,
        )?)
        .motion(el_centro_1940())
        .probes([roof_x, roof_y, shear]);
    let mut simulation = match friction {
        None => builder.interface(Bonded),
        Some(friction) => builder.interface(Coulomb::new(friction)?),
    }
    .build()?;
    let steps = simulation.steps_for(el_centro_1940().duration());
    // Gaps, slips and tractions of the elements at every 24th step, for the picture of modes.
    let mut time_series = Recorder::new().contact(24).start(&simulation)?;
    let run = simulation.run(steps, |state| time_series.record(state))?;
    Ok((run, time_series))
}

fn main() -> Result<()> {
    let output_folder = Path::new("target/containment");
    // Runs are independent: with the feature `rayon`, they run in parallel on all processors.
    let runs = Sweep::new(PAPER_CASES.len()).collect(|case| shake(PAPER_CASES[case.index].1));
    let runs: Vec<_> = runs.into_iter().collect::<std::result::Result<_, _>>()?;
    println!(
        "{:<14}{:>7}{:>17}{:>9}{:>8}{:>10}{:>11}{:>9}{:>8}",
        "case", "lb/ft", "ratio (paper)", "uplift", "slip", "residual", "roof", "balance", "run"
    );
    let bonded_shear = runs[0].0.probe("base shear")?.magnitude();
    for ((name, _, paper_shear), (run, time_series)) in PAPER_CASES.iter().zip(&runs) {
        let shear = run.probe("base shear")?.magnitude();
        println!(
            "{name:<14}{:>7.0}{:>9.3} ({:.3}){:>7.0} %{:>5.1} mm{:>7.2} mm{:>8.1} mm{:>9.0e}{:>6.2} s",
            shear / POUND_PER_FOOT,
            shear / bonded_shear,
            paper_shear / PAPER_CASES[0].2,
            100.0 * run.whole.uplifted_fraction.largest().value,
            1e3 * run.whole.mean_slip.magnitude(),
            1e3 * run.whole.residual_slip,
            1e3 * run.probe("roof x")?.magnitude(),
            run.energy_error,
            run.wall.as_secs_f64()
        );
        let name = name.replace([' ', '.'], "_");
        time_series.csv().save(output_folder.join(format!("{name}.csv")))?;
        plot::mode_map("Contact modes", time_series)?
            .save(output_folder.join(format!("modes_{name}.svg")))?;
    }
    let curves: Vec<_> =
        PAPER_CASES.iter().zip(&runs).map(|(case, (_, series))| (case.0, series)).collect();
    for probe in ["base shear", "roof x", "roof y"] {
        let file = output_folder.join(format!("{}.svg", probe.replace(' ', "_")));
        plot::probe_time_series("El Centro on a containment", &curves, probe)?.save(file)?;
    }
    println!(
        "\nratio: over the bonded shear, in the paper's Table 1; files in {}",
        output_folder.display()
    );
    Ok(())
}
