//! Checks of elements: tangents by differences of nodal forces.

use basemat::Result;
use basemat::fem::{
    Element, InelasticForce, Quad4, Quad8, Quad8Integration, QuadFormulation, SharedMaterial,
};
use basemat_problems::DISTORTED_QUAD_NODES;
use basemat_problems::random::Random;
use basemat_problems::yielding_column::clay as column_clay;
use basemat_problems::yielding_paths::{table_clays, table_sands};

use super::check::{Check, Limit};
use super::laws::TANGENT_LIMIT;

/// Random histories of each element.
const HISTORY_COUNT: usize = 40;
/// Largest displacement of a history, m, before the mean compression.
const DISPLACEMENT_SIZE: f64 = 4e-3;
/// Mean compressive strain of a history in each direction.
const MEAN_COMPRESSIVE_STRAIN: f64 = 2e-3;
/// Step of the differences relative to the displacements.
const DIFFERENCE_STEP: f64 = 1e-5;

/// An element, and the number of its nodes.
struct PlacedQuad {
    element: Box<dyn Element>,
    node_count: usize,
}

fn quads(material: &SharedMaterial) -> [PlacedQuad; 3] {
    let reduced_quad = Quad8::new([0, 1, 2, 3, 4, 5, 6, 7], material.clone());
    let full_quad = reduced_quad.clone().with_integration(Quad8Integration::Full);
    let four_node_quad =
        Quad4::new([0, 1, 2, 3], material.clone(), QuadFormulation::MeanDilatation);
    [
        PlacedQuad { element: Box::new(reduced_quad), node_count: 8 },
        PlacedQuad { element: Box::new(full_quad), node_count: 8 },
        PlacedQuad { element: Box::new(four_node_quad), node_count: 4 },
    ]
}

/// Largest difference of tangents relative to the largest entry of the stiffness, and the number of compared columns.
#[derive(Debug, Default)]
struct ColumnComparison {
    difference: f64,
    compared_count: usize,
}

/// Whether a stress has no deviator but a mean: the tip of a cone.
fn is_at_tip([xx, yy, zz, xy]: [f64; 4]) -> bool {
    let mean = (xx + yy + zz) / 3.0;
    let deviator = [xx - mean, yy - mean, zz - mean, xy];
    deviator.iter().all(|part| part.abs() < 1e-9 * mean.abs())
}

/// Nodal forces with one displacement changed.
fn changed_force(
    law: &dyn InelasticForce,
    coordinates: &[[f64; 3]],
    displacement: &[f64],
    variables: &[f64],
    change: (usize, f64),
) -> Result<Vec<f64>> {
    let mut changed = displacement.to_vec();
    changed[change.0] += change.1;
    let mut force = vec![0.0; displacement.len()];
    law.force(coordinates, &changed, variables, &mut force)?;
    Ok(force)
}

/// Compares the tangent after a random history, column by column, away from kinks and from the tips of cones.
fn compare_tangent(
    quad: &PlacedQuad,
    random: &mut Random,
    comparison: &mut ColumnComparison,
) -> Result<()> {
    let coordinates = &DISTORTED_QUAD_NODES[..quad.node_count];
    let order = quad.element.order();
    let Some(law) = quad.element.inelastic() else { return Ok(()) };
    let mut variables = vec![0.0; law.variable_count()];
    law.initialize(coordinates, &mut variables)?;
    let mut displacement = vec![0.0; order];
    for _ in 0..3 {
        law.commit(coordinates, &displacement, &mut variables);
        for (dof, value) in displacement.iter_mut().enumerate() {
            *value = random.within(-DISPLACEMENT_SIZE, DISPLACEMENT_SIZE);
            // Compression, so that few points of sand are at the tip of the cone.
            *value -= MEAN_COMPRESSIVE_STRAIN * coordinates[dof / 2][dof % 2];
        }
    }
    // At the tip the tangent has a small part of the elasticity, which the force does not have.
    let points = law.points(coordinates, &displacement, &variables)?;
    if points.iter().any(|point| is_at_tip(point.stress)) {
        return Ok(());
    }
    let mut tangent = vec![0.0; order * order];
    law.tangent(coordinates, &displacement, &variables, &mut tangent)?;
    let mut stiffness = vec![0.0; order * order];
    quad.element.stiffness(coordinates, &mut stiffness);
    let scale = stiffness.iter().fold(0.0, |max: f64, entry| max.max(entry.abs()));
    let step = DIFFERENCE_STEP * DISPLACEMENT_SIZE;
    for column in 0..order {
        let force = |change: f64| {
            changed_force(law, coordinates, &displacement, &variables, (column, change))
        };
        let ends = [force(-step)?, force(-0.5 * step)?, force(0.5 * step)?, force(step)?];
        let mut max_difference = 0.0_f64;
        let mut is_smooth = true;
        for row in 0..order {
            let coarse = (ends[3][row] - ends[0][row]) / (2.0 * step);
            let fine = (ends[2][row] - ends[1][row]) / step;
            // At a kink the differences of two steps are not the same.
            is_smooth &= (coarse - fine).abs() < 0.3 * TANGENT_LIMIT * scale;
            max_difference =
                max_difference.max((tangent[row * order + column] - coarse).abs() / scale);
        }
        if is_smooth {
            comparison.difference = comparison.difference.max(max_difference);
            comparison.compared_count += 1;
        }
    }
    Ok(())
}

pub(super) fn checks() -> Result<Vec<Check>> {
    let mut materials: Vec<SharedMaterial> = vec![column_clay().into()];
    materials.extend(table_clays()?.into_iter().map(SharedMaterial::from));
    materials.extend(table_sands()?.into_iter().map(SharedMaterial::from));
    let mut random = Random(32);
    let mut comparison = ColumnComparison::default();
    for quad in materials.iter().flat_map(quads) {
        for _ in 0..HISTORY_COUNT {
            compare_tangent(&quad, &mut random, &mut comparison)?;
        }
    }
    let check = Check::new(
        "tangents of `Quad8` (reduced, full) and `Quad4` of all laws",
        "central differences of nodal forces",
        comparison.difference,
        Limit::AtMost(TANGENT_LIMIT),
    );
    Ok(vec![check.with_remark(format!("{} columns", comparison.compared_count))])
}
