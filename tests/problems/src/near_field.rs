//! A box of elastic soil around a foundation, and the same foundations on the half-plane.

use std::sync::LazyLock;

use basemat::bem::embedded::{NearField, TrenchGround};
use basemat::bem::{ElasticGround, SharedKernels, Strip};
use basemat::coupled::{Probe, SimulationBuilder};
use basemat::fem::{Direction, Material, Mesh, SharedMaterial};
use basemat::interface::Bonded;
use basemat::motion::{Record, VerticalIncidence};
use basemat::site::TrenchMotion;
use basemat::structure::FemModel;
use basemat::{Result, Simulation, Soil, unobserved};

use crate::soil_box::SoilBox;

/// Half width of the foundations, m.
pub const HALF_WIDTH: f64 = 6.0;
const BLOCK_HEIGHT: f64 = 8.0;
pub const TIME_STEP: f64 = 0.01;
pub const STEP_COUNT: usize = 160;

pub fn soil() -> Soil {
    Soil::from_shear_wave_speed(200.0, 1.0 / 3.0, 1900.0).unwrap()
}

/// Box of half width 12 m and depth 6 m, with six elements under the foundation.
pub fn near_field() -> NearField {
    NearField::new(soil(), HALF_WIDTH).unwrap()
}

/// Convolution weights that tests with the same box share.
static KERNELS: LazyLock<SharedKernels> = LazyLock::new(SharedKernels::default);

/// The soil around the box.
pub fn box_ground() -> TrenchGround {
    near_field().ground().unwrap().with_shared_kernels(&KERNELS)
}

/// Ricker's wavelet of acceleration, with a peak in m/s² and a frequency of 2 Hz.
pub fn ricker(peak: f64) -> Record {
    Record::from_fn(0.005, TIME_STEP * STEP_COUNT as f64, |time| {
        let square = (std::f64::consts::PI * 2.0 * (time - 0.7)).powi(2);
        peak * (1.0 - 2.0 * square) * (-square).exp()
    })
    .unwrap()
}

/// The box in its ground, under vertical waves.
pub fn on_box(record: Record) -> Result<SimulationBuilder> {
    let ground = box_ground();
    let motion = TrenchMotion::new(&ground, VerticalIncidence::from(record), &mut unobserved)?;
    Ok(Simulation::builder(TIME_STEP).ground(ground).motion(motion))
}

/// The half-plane under vertical waves.
pub fn on_half_plane(record: Record) -> Result<SimulationBuilder> {
    let ground = ElasticGround::new(soil(), Strip::graded(-HALF_WIDTH..HALF_WIDTH, 32)?)?;
    Ok(Simulation::builder(TIME_STEP).ground(ground).motion(VerticalIncidence::from(record)))
}

/// Values of all probes after each step, by probe.
pub fn probe_series(builder: SimulationBuilder) -> Result<Vec<Vec<f64>>> {
    let mut simulation = builder.expected_steps(STEP_COUNT).build()?;
    let mut series = vec![Vec::new(); simulation.probes().len()];
    for _ in 0..STEP_COUNT {
        for (values, value) in series.iter_mut().zip(&simulation.step()?.probes) {
            values.push(*value);
        }
    }
    assert!(simulation.state().energy_balance.residual() < 1e-9);
    Ok(series)
}

/// Largest difference of two lists, relative to the largest entry of the second one.
pub fn relative_difference(computed: &[f64], expected: &[f64]) -> f64 {
    let mut max_magnitude = 0.0_f64;
    let mut difference = 0.0_f64;
    for (computed, expected) in computed.iter().zip(expected) {
        max_magnitude = max_magnitude.max(expected.abs());
        difference = difference.max((computed - expected).abs());
    }
    difference / max_magnitude
}

/// The bonded model with probes: top of the block to the right, and a lower corner upwards.
fn with_welded_block(builder: SimulationBuilder, model: FemModel) -> Result<SimulationBuilder> {
    let top = model.row(model.mesh().node_at(0.0, BLOCK_HEIGHT)?, Direction::X)?;
    let corner = model.row(model.mesh().node_at(HALF_WIDTH, 0.0)?, Direction::Y)?;
    Ok(builder
        .structure(model)
        .interface(Bonded)
        .probe(Probe::absolute_displacement("top", top))
        .probe(Probe::absolute_displacement("corner", corner)))
}

/// Differences of a block on the box from the block on the half-plane, relative to its largest motion.
///
/// Motion of the top to the right, and of a lower corner upwards, of a welded block of concrete.
pub fn welded_block_differences() -> Result<[f64; 2]> {
    let concrete = SharedMaterial::from(Material::new(20.0e9, 0.2, 2000.0)?);
    let heights = [0.0, 2.0, 4.0, 6.0, BLOCK_HEIGHT];
    let mesh = near_field().mesh()?;
    let nodes = near_field().foundation_nodes(&mesh)?;
    let lines: Vec<f64> = nodes.iter().step_by(2).map(|node| mesh.nodes()[*node][0]).collect();
    let boxed = SoilBox { mesh }.with_block(&lines, &heights, &concrete)?.model();
    let computed = probe_series(with_welded_block(on_box(ricker(1.0))?, boxed)?)?;

    // Equal elements, so that the reference has another mesh of the block as well.
    let equal: Vec<f64> = (0..=16).map(|k| HALF_WIDTH * (f64::from(k) / 8.0 - 1.0)).collect();
    let block = Mesh::quad8_block(&equal, &heights, |_, _| concrete.clone())?;
    let model = FemModel::on_base(block)?;
    let expected = probe_series(with_welded_block(on_half_plane(ricker(1.0))?, model)?)?;

    Ok([0, 1].map(|probe| relative_difference(&computed[probe], &expected[probe])))
}
