//! A soil column that yields, beside its equivalent-linear approximation.
//!
//! ```text
//! cargo run --release --example yielding_column
//! ```
//!
//! Twenty metres of soft clay stand on rigid rock, which moves with El Centro. The clay has a hyperbolic backbone: a stiffness
//! at small strains and a strength. Finite elements with Iwan's model follow its stress–strain loops step by step. The
//! equivalent-linear method takes one secant stiffness and one damping ratio of the whole motion from the same
//! backbone. Strong shaking shows the difference: the strength bounds the stress of the clay, but not that of the linear
//! column. Writes loops to `target/yielding_column.svg`.

use basemat::fem::{Direction, Iwan, Mesh, SharedMaterial};
use basemat::prelude::*;
use basemat::site::{ControlPoint, EquivalentLinearOptions, SoilColumn, VerticalWave};
use basemat::soil::{SoilProfile, StrainCurves};
use basemat::{Result, plot, unobserved};

const COLUMN_HEIGHT: f64 = 20.0;
const ROW_COUNT: usize = 20;
const TIME_STEP: f64 = 0.005;
/// Shear modulus of small strains and strength, Pa.
const SHEAR_MODULUS: f64 = 45.6e6;
const SHEAR_STRENGTH: f64 = 40.0e3;
const POISSON_RATIO: f64 = 0.45;
/// kg/m³.
const CLAY_DENSITY: f64 = 1900.0;
/// Damping ratio of the linear column at small strains.
const SMALL_STRAIN_DAMPING: f64 = 0.005;

/// The column of finite elements, with both sides tied as in a soil of infinite width.
fn column(clay: &Iwan) -> Result<FemModel> {
    let mut y_lines = Vec::new();
    for row in 0..=ROW_COUNT {
        y_lines.push(COLUMN_HEIGHT * (row as f64 / ROW_COUNT as f64 - 1.0));
    }
    let clay = SharedMaterial::from(clay.clone());
    let mesh = Mesh::quad8_block(&[0.0, 1.0], &y_lines, |_, _| clay.clone())?;
    let mut sides = Vec::new();
    for level in 0..=2 * ROW_COUNT {
        let y = COLUMN_HEIGHT * (level as f64 / (2 * ROW_COUNT) as f64 - 1.0);
        sides.push([mesh.node_at(0.0, y)?, mesh.node_at(1.0, y)?]);
    }
    let mut column = FemModel::on_base(mesh)?;
    for [left, right] in sides {
        column = column.with_tied_nodes(left, &[right])?;
    }
    Ok(column)
}

fn main() -> Result<()> {
    let limit_strain = 200.0 * SHEAR_STRENGTH / SHEAR_MODULUS;
    let clay =
        Iwan::hyperbolic(SHEAR_MODULUS, SHEAR_STRENGTH, limit_strain, POISSON_RATIO, CLAY_DENSITY)?;
    let curves = StrainCurves::masing(clay.points(), SMALL_STRAIN_DAMPING)?;
    let soil = Soil::new(SHEAR_MODULUS, POISSON_RATIO, CLAY_DENSITY)?;
    let mut profile = SoilProfile::on_rigid_bedrock();
    for _ in 0..ROW_COUNT {
        profile = profile.with_layer(soil, COLUMN_HEIGHT / ROW_COUNT as f64)?;
    }
    let linear_column = SoilColumn::new(profile, VerticalWave::Shear)?;
    let mut options = EquivalentLinearOptions::of_magnitude(6.9);
    options.control = ControlPoint::Within;

    println!(
        "El Centro ×   surface, m/s²: linear   yielding   stress at the base, kPa: linear   yielding"
    );
    let mut loops = Vec::new();
    for factor in [0.1, 0.3, 1.0] {
        let rock = el_centro_1940().scaled(factor)?.resampled(TIME_STEP)?;
        let layer_curves = vec![curves.clone(); ROW_COUNT];
        let linear =
            linear_column.equivalent_linear(&rock, &layer_curves, &options, &mut unobserved)?;
        let lowest = &linear.layers[ROW_COUNT - 1];
        let linear_stress = lowest.shear_modulus * lowest.largest_strain;

        let model = column(&clay)?;
        let top = model.row(model.mesh().node_at(0.0, 0.0)?, Direction::X)?;
        let mut simulation = Simulation::builder(TIME_STEP)
            .ground(SpringGround::under(&model, 2, 1.0e12, 1.0e12)?)
            .structure(model)
            .interface(Bonded)
            // The column starts without stress.
            .gravity(0.0)
            .motion(rock.clone())
            .on_fixed_base()
            .probe(Probe::acceleration("surface", top))
            .build()?;
        let mut path = Vec::new();
        let mut surface_peak = 0.0_f64;
        for _ in 0..simulation.steps_for(rock.duration()) {
            surface_peak = surface_peak.max(simulation.step()?.probes[0].abs());
            let structure: &dyn std::any::Any = simulation.structure();
            let model: &FemModel = structure.downcast_ref().expect("the structure is a FemModel");
            let point = &model.solid_points(0)?[0];
            path.push([point.strain[3], point.stress[3]]);
        }
        let stress_peak = path.iter().fold(0.0_f64, |peak, [_, stress]| peak.max(stress.abs()));
        println!(
            "{factor:9.1}{:25.2}{surface_peak:11.2}{:33.1}{:11.1}",
            linear.peak_accelerations[0],
            1e-3 * linear_stress,
            1e-3 * stress_peak
        );
        assert!(stress_peak <= 1.0001 * SHEAR_STRENGTH);
        assert!(simulation.state().energy_balance.residual() < 1e-9);
        loops.push((format!("El Centro × {factor}"), path));
    }
    loops.reverse();
    let paths: Vec<_> = loops.iter().map(|(name, path)| (&name[..], &path[..])).collect();
    plot::stress_strain("Lowest metre of the column", &paths)?.save("target/yielding_column.svg")
}
