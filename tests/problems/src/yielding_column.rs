//! A soil column that yields under vertically propagating shear waves, on a rigid base.
//!
//! The reference is a program of two-node cells with lumped mass: `tests/data/yielding/column_iwan.csv`.

use std::f64::consts::{PI, TAU};

use basemat::bem::SpringGround;
use basemat::fem::{Direction, Iwan, Mesh, SharedMaterial};
use basemat::interface::Bonded;
use basemat::motion::Record;
use basemat::structure::FemModel;
use basemat::{Result, Simulation};

use crate::table;

/// Height and width of the column, m.
const COLUMN_HEIGHT: f64 = 20.0;
const COLUMN_WIDTH: f64 = 1.0;
/// Shear modulus, Pa, and strength, Pa, of the clay, and its strain at the strength over `SHEAR_STRENGTH / SHEAR_MODULUS`.
const SHEAR_MODULUS: f64 = 45.6e6;
const SHEAR_STRENGTH: f64 = 40.0e3;
const LIMIT_STRAIN_RATIO: f64 = 200.0;
/// Density, kg/m³. Poisson's ratio has no effect on shear waves.
const CLAY_DENSITY: f64 = 1900.0;
const POISSON_RATIO: f64 = 0.3;
/// Duration of the motion, s.
const MOTION_DURATION: f64 = 8.0;

/// Clay of the column.
pub fn clay() -> Iwan {
    let limit_strain = LIMIT_STRAIN_RATIO * SHEAR_STRENGTH / SHEAR_MODULUS;
    Iwan::hyperbolic(SHEAR_MODULUS, SHEAR_STRENGTH, limit_strain, POISSON_RATIO, CLAY_DENSITY)
        .unwrap()
}

/// Acceleration of the base, m/s².
pub fn base_acceleration(time: f64) -> f64 {
    3.0 * (TAU * 1.5 * time).sin() * (PI * (time / 6.0).min(1.0)).sin().powi(2)
}

/// Column of `row_count` elements with tied sides.
pub fn tied_column(row_count: usize, material: &SharedMaterial) -> Result<FemModel> {
    let y_lines: Vec<f64> =
        (0..=row_count).map(|row| COLUMN_HEIGHT * row as f64 / row_count as f64).collect();
    let mesh = Mesh::quad8_block(&[0.0, COLUMN_WIDTH], &y_lines, |_, _| material.clone())?;
    let mut pairs = Vec::new();
    for level in 0..=2 * row_count {
        let height = 0.5 * COLUMN_HEIGHT * level as f64 / row_count as f64;
        pairs.push([mesh.node_at(0.0, height)?, mesh.node_at(COLUMN_WIDTH, height)?]);
    }
    let mut column = FemModel::on_base(mesh)?;
    for [left, right] in pairs {
        column = column.with_tied_nodes(left, &[right])?;
    }
    Ok(column)
}

/// The column on a rigid base that moves with [`base_acceleration`].
pub fn scene(row_count: usize, time_step: f64, material: &SharedMaterial) -> Result<Simulation> {
    let column = tied_column(row_count, material)?;
    Simulation::builder(time_step)
        .ground(SpringGround::under(&column, 2, 1.0e12, 1.0e12)?)
        .structure(column)
        .interface(Bonded)
        .gravity(0.0)
        .motion(Record::from_fn(time_step, MOTION_DURATION, base_acceleration)?)
        .on_fixed_base()
        .build()
}

/// Displacement of the top relative to the base, and mean shear stress of the lowest element, step by step.
#[derive(Debug, Clone, Default)]
pub struct ColumnResponse {
    /// Displacement of the top relative to the base, m.
    pub top_displacement: Vec<f64>,
    /// Mean shear stress of the lowest element, Pa.
    pub base_stress: Vec<f64>,
    /// Shear strain and stress of a point of the lowest element.
    pub stress_path: Vec<[f64; 2]>,
    /// Largest residual of the energy balance.
    pub energy_error: f64,
    /// Dissipation of the soil, and the mid-step remainder, at the end, J/m.
    pub hysteresis: f64,
    pub midstep_remainder: f64,
}

/// Runs the column for the whole motion.
pub fn response(
    row_count: usize,
    time_step: f64,
    material: &SharedMaterial,
) -> Result<ColumnResponse> {
    let mut simulation = scene(row_count, time_step, material)?;
    let model = tied_column(row_count, material)?;
    let top = model.row(model.mesh().node_at(0.0, COLUMN_HEIGHT)?, Direction::X)?;
    let foot = model.row(model.mesh().node_at(0.0, 0.0)?, Direction::X)?;
    let mut response = ColumnResponse::default();
    let step_count = simulation.steps_for(MOTION_DURATION);
    for _ in 0..step_count {
        let state = simulation.step()?;
        let displacement = state.displacement();
        let top_displacement = top.value(displacement) - foot.value(displacement);
        response.top_displacement.push(top_displacement);
        let energy_balance = state.energy_balance;
        response.energy_error = response.energy_error.max(energy_balance.residual());
        response.hysteresis = energy_balance.hysteresis;
        response.midstep_remainder = energy_balance.midstep_remainder;
        let structure: &dyn std::any::Any = simulation.structure();
        let points = structure.downcast_ref::<FemModel>().unwrap().solid_points(0)?;
        let mean_stress =
            points.iter().map(|point| point.stress[3]).sum::<f64>() / points.len() as f64;
        response.base_stress.push(mean_stress);
        response.stress_path.push([points[0].strain[3], points[0].stress[3]]);
    }
    Ok(response)
}

/// Corner frequency, Hz, of the filter on both sides: kinks of the law excite frequencies that the meshes do not resolve.
const CORNER_FREQUENCY: f64 = 10.0;
/// Time step of the table, s.
const TABLE_TIME_STEP: f64 = 0.01;

/// A series that has passed the filter.
fn filtered(time_step: f64, values: &[f64]) -> Result<Vec<f64>> {
    let low = Record::new(time_step, values.to_vec())?.low_pass(CORNER_FREQUENCY, 4)?;
    let pad_length = (low.len() - values.len()) / 2;
    Ok(low.accelerations()[pad_length..pad_length + values.len()].to_vec())
}

/// Largest difference of a filtered series from a filtered column of the table, relative to its largest value.
fn table_difference(column: &str, time_step: f64, values: &[f64]) -> Result<f64> {
    let reference = table("yielding/column_iwan.csv").column(column);
    let reference = filtered(TABLE_TIME_STEP, &reference)?;
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a small ratio")]
    let stride = (TABLE_TIME_STEP / time_step).round() as usize;
    let values = filtered(time_step, values)?;
    let sampled_values: Vec<f64> = values.into_iter().skip(stride - 1).step_by(stride).collect();
    assert_eq!(sampled_values.len(), reference.len(), "steps of the run and of the table");
    let max_magnitude = reference.iter().fold(0.0_f64, |max, value| max.max(value.abs()));
    let pairs = sampled_values.iter().zip(&reference);
    Ok(pairs.fold(0.0_f64, |max, (a, b)| max.max((a - b).abs())) / max_magnitude)
}

impl ColumnResponse {
    /// Largest differences of the displacement of the top and of the stress at the base from the table, below 10 Hz.
    ///
    /// They are relative to the largest value of the table. The time step of the run is one of the table's over a whole
    /// number.
    pub fn table_differences(&self, time_step: f64) -> Result<[f64; 2]> {
        Ok([
            table_difference("top_relative_displacement", time_step, &self.top_displacement)?,
            table_difference("base_shear_stress", time_step, &self.base_stress)?,
        ])
    }
}
