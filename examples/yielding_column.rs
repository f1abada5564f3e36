//! A soil column that yields, compared with its equivalent-linear approximation.
//!
//! ```text
//! cargo run --release --example yielding_column
//! ```
//!
//! Twenty metres of soft clay stand on rigid rock, which moves with El Centro. The clay has a hyperbolic backbone,
//! defined by the stiffness at small strains and the strength. Finite elements with Iwan's model follow its
//! stress–strain loops step by step. The equivalent-linear method uses one secant stiffness and one damping ratio for
//! the whole motion, from the same backbone. They differ under strong shaking: the strength limits the stress of the
//! finite elements, but not the stress of the linear column. The example writes stress–strain loops to
//! `target/yielding_column.svg`.

use basemat::fem::{Direction, Iwan, Mesh, SharedMaterial};
use basemat::prelude::*;
use basemat::site::{ControlPoint, EquivalentLinearOptions, SoilColumn, VerticalWave};
use basemat::soil::{SoilProfile, StrainCurves};
use basemat::{Result, plot, unobserved};

/// Height of the column, m.
const COLUMN_HEIGHT: f64 = 20.0;
/// Number of rows of elements, and of layers of the linear column.
const ROW_COUNT: usize = 20;
/// Time step, s.
const TIME_STEP: f64 = 0.005;
/// Shear modulus of the clay at small strains, Pa.
const SHEAR_MODULUS: f64 = 45.6e6;
/// Shear strength of the clay, Pa.
const SHEAR_STRENGTH: f64 = 40.0e3;
const POISSON_RATIO: f64 = 0.45;
/// Density of the clay, kg/m³.
const CLAY_DENSITY: f64 = 1900.0;
/// Damping ratio of the linear column at small strains.
const SMALL_STRAIN_DAMPING: f64 = 0.005;

/// The column of finite elements; nodes at the same level of both sides move together, as in soil of infinite width.
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
    // The backbone is approximated up to 200 times the reference strain.
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
        let rock_motion = el_centro_1940().scaled(factor)?.resampled(TIME_STEP)?;
        let layer_curves = vec![curves.clone(); ROW_COUNT];
        let equivalent_linear = linear_column.equivalent_linear(
            &rock_motion,
            &layer_curves,
            &options,
            &mut unobserved,
        )?;
        let lowest_layer = &equivalent_linear.layers[ROW_COUNT - 1];
        let linear_stress = lowest_layer.shear_modulus * lowest_layer.largest_strain;

        let model = column(&clay)?;
        let top = model.row(model.mesh().node_at(0.0, 0.0)?, Direction::X)?;
        let mut simulation = Simulation::builder(TIME_STEP)
            .ground(SpringGround::under(&model, 2, 1.0e12, 1.0e12)?)
            .structure(model)
            .interface(Bonded)
            // The column starts without stress.
            .gravity(0.0)
            .motion(rock_motion.clone())
            .on_fixed_base()
            .probe(Probe::acceleration("surface", top))
            .build()?;
        let mut stress_path = Vec::new();
        let mut surface_peak = 0.0_f64;
        for _ in 0..simulation.steps_for(rock_motion.duration()) {
            surface_peak = surface_peak.max(simulation.step()?.probes[0].abs());
            let structure: &dyn std::any::Any = simulation.structure();
            let model: &FemModel = structure.downcast_ref().expect("the structure is a FemModel");
            let stress_point = &model.solid_points(0)?[0];
            stress_path.push([stress_point.strain[3], stress_point.stress[3]]);
        }
        let stress_peak =
            stress_path.iter().fold(0.0_f64, |peak, [_, stress]| peak.max(stress.abs()));
        println!(
            "{factor:9.1}{:25.2}{surface_peak:11.2}{:33.1}{:11.1}",
            equivalent_linear.peak_accelerations[0],
            1e-3 * linear_stress,
            1e-3 * stress_peak
        );
        assert!(stress_peak <= 1.0001 * SHEAR_STRENGTH);
        assert!(simulation.state().energy_balance.residual() < 1e-9);
        loops.push((format!("El Centro × {factor}"), stress_path));
    }
    loops.reverse();
    let paths: Vec<_> =
        loops.iter().map(|(name, stress_path)| (&name[..], &stress_path[..])).collect();
    plot::stress_strain("Lowest metre of the column", &paths)?.save("target/yielding_column.svg")
}
