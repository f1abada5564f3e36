//! Delassus operators for the tests of the mode search.

use std::sync::Arc;

use crate::bem::{ElasticGround, Ground, Strip};
use crate::coupled::model::Model;
use crate::coupled::model::assembled::Assembled;
use crate::coupled::model::operators::{Operators, StiffnessFactorization};
use crate::coupled::{Midpoint, TimeScheme};
use crate::fem::{Layer, Material, Mesh};
use crate::geometry::Patch;
use crate::linalg::CompressedMatrix;
use crate::linalg::matrix::SparseMatrix;
use crate::soil::Soil;
use crate::structure::{FemModel, RigidBlock, Structure};
use basemat_testkit::random::Random;

/// W of elements on a half-plane, under a rigid block or finite elements.
pub(super) fn scene_delassus(count: usize, random: &mut Random) -> Vec<f64> {
    let soil = Soil::new(1e8, random.pick(&[0.0, 0.2, 1.0 / 3.0, 0.45, 0.4999]), 2000.0).unwrap();
    let is_graded = random.chance(0.5);
    let strip = if is_graded { Strip::graded } else { Strip::uniform };
    let mut ground = ElasticGround::new(soil, strip(-2.0..2.0, count).unwrap()).unwrap();
    // Elements that a pressure wave crosses in a time step.
    let crossed_elements = random.log_within(0.05, 20.0);
    let time_step = crossed_elements * 4.0 / count as f64 / soil.pressure_wave_speed();
    ground.prepare(time_step, None, &mut crate::unobserved).unwrap();
    let mut step_compliance = vec![0.0; 4 * count * count];
    ground.step_compliance(&mut step_compliance).unwrap();
    let structure: Box<dyn Structure> = if random.chance(0.5) {
        Box::new(RigidBlock::new(4.0, 8.0, 2000.0).unwrap())
    } else {
        let material = Material::new(random.log_within(1e8, 3e10), 0.2, 2400.0).unwrap();
        let layers = [Layer::new(8.0, 4, material)];
        let mesh = Mesh::layered_block(-2.0..2.0, count, &layers).unwrap();
        Box::new(FemModel::on_base(mesh).unwrap())
    };
    let (assembled, _) =
        Assembled::new(structure.as_ref(), &Patch::new(ground.elements().to_vec()).unwrap())
            .unwrap();
    let model = Model::new(&assembled);
    let tangent = SparseMatrix::default();
    let coefficients = Midpoint.coefficients(time_step);
    let factor = StiffnessFactorization::in_dofs(&model, &coefficients, &tangent).unwrap();
    let step_compliance = Arc::new(CompressedMatrix::new(step_compliance, 2 * count));
    let operators = Operators::new(
        &model,
        &assembled.base,
        &step_compliance,
        StiffnessFactorization::Sparse(factor),
        tangent,
    )
    .unwrap();
    operators.delassus.to_vec()
}

/// A random W with A W symmetric and positive definite, with any condition number and coupling.
pub(super) fn random_delassus(count: usize, random: &mut Random) -> Vec<f64> {
    let size = 2 * count;
    let root: Vec<f64> = (0..size * size).map(|_| random.within(-1.0, 1.0)).collect();
    let lengths: Vec<f64> = (0..count).map(|_| random.log_within(0.1, 1.0)).collect();
    let shift = random.log_within(1e-3, 1.0);
    let mut matrix = vec![0.0; size * size];
    for i in 0..size {
        for j in 0..size {
            let product: f64 = (0..size).map(|k| root[i * size + k] * root[j * size + k]).sum();
            let diagonal = if i == j { shift } else { 0.0 };
            matrix[i * size + j] = (product + diagonal) / lengths[i % count];
        }
    }
    matrix
}
