//! Checks of laws at a point: tables of other programs, Masing's rules, tangents by differences.

use basemat::Result;
use basemat::fem::{Iwan, SharedMaterial, SolidMaterial};
use basemat_problems::random::Random;
use basemat_problems::yielding_column::clay as column_clay;
use basemat_problems::yielding_paths::{
    PathDifferences, masing_difference, path_differences, table_clays, table_sands,
};

use super::check::{Check, Limit};

/// Limit of differences from tables, and of rounding beside closed forms.
const TABLE_LIMIT: f64 = 1e-9;
const MASING_LIMIT: f64 = 1e-10;
/// Limit of differences between a tangent and differences of forces.
pub(super) const TANGENT_LIMIT: f64 = 1e-6;
/// Amplitudes of cycles, relative to the strain at the strength.
const CYCLE_AMPLITUDES: [f64; 3] = [0.02, 0.3, 1.7];
/// Step of the differences relative to the size of the strains.
const DIFFERENCE_STEP: f64 = 1e-5;
/// Random histories of each law.
const HISTORY_COUNT: usize = 200;

pub(super) fn checks() -> Result<Vec<Check>> {
    let clays = table_clays()?;
    let sands = table_sands()?;
    let program = "an independent program";
    let other_program = "a program with ε_zz ≠ 0 and initial stress";
    let tables = [
        ("Iwan", path_differences("iwan_paths.csv", &clays)?, program),
        ("Drucker–Prager", path_differences("drucker_prager_paths.csv", &sands)?, program),
        ("Iwan", path_differences("iwan_general_paths.csv", &clays)?, other_program),
        (
            "Drucker–Prager",
            path_differences("drucker_prager_general_paths.csv", &sands)?,
            other_program,
        ),
    ];
    let mut checks: Vec<Check> = tables
        .into_iter()
        .map(|(law, differences, reference)| table_check(law, &differences, reference))
        .collect();
    let all_clays: Vec<Iwan> = clays.iter().cloned().chain([column_clay()]).collect();
    let mut difference = 0.0_f64;
    for clay in &all_clays {
        difference = difference.max(masing_difference(clay, &CYCLE_AMPLITUDES)?);
    }
    let name = "cyclic simple shear of Iwan's model, relative to the strength";
    checks.push(Check::new(
        name,
        "Masing's rules on the backbone",
        difference,
        Limit::AtMost(MASING_LIMIT),
    ));
    let mut laws: Vec<SharedMaterial> = all_clays.into_iter().map(Into::into).collect();
    laws.extend(sands.into_iter().map(SharedMaterial::from));
    let mut comparison = TangentComparison::default();
    for law in &laws {
        compare_tangents(law.law(), &mut comparison)?;
    }
    let check = Check::new(
        "tangents of all laws",
        "central differences of stresses",
        comparison.difference,
        Limit::AtMost(TANGENT_LIMIT),
    );
    checks.push(check.with_remark(format!("{} strains", comparison.compared_count)));
    Ok(checks)
}

fn table_check(law: &str, differences: &PathDifferences, reference: &'static str) -> Check {
    let PathDifferences { path_count, row_count, .. } = differences;
    let name = format!("{law}: stress, tangent and stored energy on {path_count} paths");
    let limit = Limit::AtMost(TABLE_LIMIT);
    Check::new(name, reference, differences.largest(), limit)
        .with_remark(format!("{row_count} strains"))
}

/// Largest difference of tangents, and the number of compared ones.
#[derive(Debug, Default)]
struct TangentComparison {
    difference: f64,
    compared_count: usize,
}

/// Tangent by central differences.
fn difference_tangent(
    law: &dyn SolidMaterial,
    strain: [f64; 4],
    step: f64,
    variables: &[f64],
) -> Result<[[f64; 4]; 4]> {
    let mut tangent = [[0.0; 4]; 4];
    for column in 0..4 {
        let mut low_strain = strain;
        let mut high_strain = strain;
        low_strain[column] -= step;
        high_strain[column] += step;
        let low_stress = law.stress(low_strain, variables)?;
        let high_stress = law.stress(high_strain, variables)?;
        for row in 0..4 {
            tangent[row][column] = (high_stress[row] - low_stress[row]) / (2.0 * step);
        }
    }
    Ok(tangent)
}

/// Largest difference of two matrices.
fn matrix_difference(one: &[[f64; 4]; 4], other: &[[f64; 4]; 4]) -> f64 {
    let pairs = one.as_flattened().iter().zip(other.as_flattened());
    pairs.fold(0.0, |max: f64, (a, b)| max.max((a - b).abs()))
}

/// Compares tangents after random histories, away from kinks and from tips of cones.
fn compare_tangents(law: &dyn SolidMaterial, comparison: &mut TangentComparison) -> Result<()> {
    let mut random = Random(31);
    let scale = law.elasticity()[0][0];
    for _ in 0..HISTORY_COUNT {
        let mut variables = vec![0.0; law.variable_count()];
        law.initialize([0.0; 4], &mut variables)?;
        let size = random.log_within(1e-4, 2e-2);
        let mut strain = [0.0; 4];
        for _ in 0..3 {
            law.commit(strain, &mut variables);
            strain = std::array::from_fn(|_| random.within(-size, size));
        }
        let step = DIFFERENCE_STEP * size;
        let coarse = difference_tangent(law, strain, step, &variables)?;
        let fine = difference_tangent(law, strain, 0.5 * step, &variables)?;
        // At a kink the differences of two steps are not the same. At a tip they are zero, and the law adds a small
        // part of its elasticity.
        let is_smooth = matrix_difference(&coarse, &fine) < 0.3 * TANGENT_LIMIT * scale;
        if is_smooth && coarse.as_flattened().iter().any(|entry| *entry != 0.0) {
            let difference = matrix_difference(&law.tangent(strain, &variables)?, &coarse) / scale;
            comparison.difference = comparison.difference.max(difference);
            comparison.compared_count += 1;
        }
    }
    Ok(())
}
