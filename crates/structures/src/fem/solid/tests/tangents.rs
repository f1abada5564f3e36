//! GOAL: the tangent is the derivative of the stress, and at small strains that of the virgin material. SCENE: random
//! strains after random histories, with and without an initial stress, away from kinks. REFERENCE: central differences.

use basemat_testkit::random::Random;

use super::{
    SolidMaterial, associated_sand, hyperbolic_clay, random_strain, table_clays, table_sands,
    variables_at_rest,
};
use crate::fem::solid::drucker_prager::APEX_TANGENT_FRACTION;

/// Step of the differences, relative to the size of the strains.
const DIFFERENCE_STEP: f64 = 1e-5;
/// Allowed error, relative to the largest entry of the elasticity.
const DIFFERENCE_TOLERANCE: f64 = 1e-6;

/// Tangent by central differences.
fn difference_tangent(
    material: &dyn SolidMaterial,
    strain: [f64; 4],
    step: f64,
    variables: &[f64],
) -> [[f64; 4]; 4] {
    let mut tangent = [[0.0; 4]; 4];
    for j in 0..4 {
        let mut low_strain = strain;
        let mut high_strain = strain;
        low_strain[j] -= step;
        high_strain[j] += step;
        let low_stress = material.stress(low_strain, variables).unwrap();
        let high_stress = material.stress(high_strain, variables).unwrap();
        for i in 0..4 {
            tangent[i][j] = (high_stress[i] - low_stress[i]) / (2.0 * step);
        }
    }
    tangent
}

/// Compares the tangent at a strain with differences.
///
/// `None` at a kink, else whether the strain is at a tip.
fn compare_at(
    material: &dyn SolidMaterial,
    strain: [f64; 4],
    step: f64,
    variables: &[f64],
) -> Option<bool> {
    let elasticity = material.elasticity();
    let tolerance = DIFFERENCE_TOLERANCE * elasticity[0][0];
    let differences = difference_tangent(material, strain, step, variables);
    // At a kink the differences depend on the step.
    let finer_differences = difference_tangent(material, strain, 0.5 * step, variables);
    for (fine, coarse) in finer_differences.as_flattened().iter().zip(differences.as_flattened()) {
        if (fine - coarse).abs() > 0.3 * tolerance {
            return None;
        }
    }
    let is_apex = differences.as_flattened().iter().all(|&entry| entry == 0.0);
    let fraction = if is_apex { APEX_TANGENT_FRACTION } else { 0.0 };
    let tangent = material.tangent(strain, variables).unwrap();
    for i in 0..4 {
        for j in 0..4 {
            let expected = differences[i][j] + fraction * elasticity[i][j];
            let error = (tangent[i][j] - expected).abs();
            assert!(error <= tolerance, "{material:?}, {strain:?}: {tangent:?}, {differences:?}");
            let asymmetry = (tangent[i][j] - tangent[j][i]).abs();
            let is_symmetric = asymmetry <= 1e-12 * elasticity[0][0];
            assert!(is_symmetric || !material.has_symmetric_tangent(), "{tangent:?}");
        }
    }
    Some(is_apex)
}

/// Compares tangents of random paths.
///
/// Returns the number of strains away from kinks, and of those at a tip.
fn compare(material: &dyn SolidMaterial, initial_stress: [f64; 4], seed: u64) -> [usize; 2] {
    let mut random = Random(seed);
    let mut compared_count = 0;
    let mut apex_count = 0;
    for _ in 0..100 {
        let mut variables = variables_at_rest(material, initial_stress);
        let strain_size = random.log_within(1e-4, 2e-2);
        for _ in 0..5 {
            let strain = random_strain(&mut random, strain_size);
            let step = DIFFERENCE_STEP * strain_size;
            if let Some(is_apex) = compare_at(material, strain, step, &variables) {
                compared_count += 1;
                apex_count += usize::from(is_apex);
            }
            material.commit(strain, &mut variables);
        }
    }
    [compared_count, apex_count]
}

#[test]
fn tangents_of_iwans_model_are_derivatives() {
    let mut clays = table_clays();
    clays.push(hyperbolic_clay());
    for (seed, clay) in clays.iter().enumerate() {
        let shear = 0.4 * clay.strength();
        for initial_stress in [[0.0; 4], [-1.0e5 + shear, -1.0e5, -1.2e5, 0.5 * shear]] {
            let compared_count = compare(clay, initial_stress, seed as u64)[0];
            assert!(compared_count > 400, "{compared_count}");
        }
    }
}

#[test]
fn tangents_of_drucker_pragers_law_are_derivatives() {
    let mut sands = table_sands();
    sands.push(associated_sand());
    let mut apex_count = 0;
    for (seed, sand) in sands.iter().enumerate() {
        assert_eq!(sand.has_symmetric_tangent(), sand.friction_angle() == sand.dilation_angle());
        for initial_stress in [[0.0; 4], [-1.0e5, -0.8e5, -1.1e5, 0.5e4]] {
            let [compared_count, count] = compare(sand, initial_stress, seed as u64);
            assert!(compared_count > 400, "{compared_count}");
            apex_count += count;
        }
    }
    assert!(apex_count > 100, "{apex_count}");
}

/// The virgin material has the elasticity of small strains.
#[test]
fn small_strains_are_elastic() {
    let clay = hyperbolic_clay();
    let sand = associated_sand();
    for material in [&clay as &dyn SolidMaterial, &sand] {
        let variables = variables_at_rest(material, [0.0; 4]);
        let tangent = material.tangent([1e-9; 4], &variables).unwrap();
        for (entry, expected) in
            tangent.as_flattened().iter().zip(material.elasticity().as_flattened())
        {
            assert!((entry - expected).abs() <= 1e-12 * material.elasticity()[0][0]);
        }
    }
}
