//! Laws of solids that yield along the strain paths of other programs, beside their stresses, tangents and energies.
//!
//! Tables and their programs: `tests/data/yielding/README.md`.

use basemat::Result;
use basemat::fem::{DruckerPrager, Iwan, Material, SolidMaterial};

use crate::dense::largest;
use crate::{ReferenceTable, table};

/// Material with shear modulus G and bulk modulus K, without density.
fn elastic(shear_modulus: f64, bulk_modulus: f64) -> Result<Material> {
    let young_modulus = 9.0 * bulk_modulus * shear_modulus / (3.0 * bulk_modulus + shear_modulus);
    Material::new(young_modulus, poisson(shear_modulus, bulk_modulus), 0.0)
}

/// Poisson's ratio of shear modulus G and bulk modulus K.
fn poisson(shear_modulus: f64, bulk_modulus: f64) -> f64 {
    (3.0 * bulk_modulus - 2.0 * shear_modulus) / (2.0 * (3.0 * bulk_modulus + shear_modulus))
}

/// Clays of the tables, by the number of their material.
pub fn table_clays() -> Result<Vec<Iwan>> {
    let rows = table("yielding/iwan_materials.csv").rows(["material", "G", "K", "gamma", "tau"]);
    [0.0, 1.0]
        .into_iter()
        .map(|material| {
            let rows: Vec<_> = rows.iter().filter(|row| row[0] == material).collect();
            let points: Vec<_> = rows.iter().map(|row| [row[3], row[4]]).collect();
            Iwan::new(&points, poisson(rows[0][1], rows[0][2]), 1900.0)
        })
        .collect()
}

/// Sands of the tables, by the number of their material.
pub fn table_sands() -> Result<Vec<DruckerPrager>> {
    table("yielding/drucker_prager_materials.csv")
        .rows(["G", "K", "c", "phi", "psi"])
        .into_iter()
        .map(|[g, k, cohesion, phi, psi]| {
            DruckerPrager::new(elastic(g, k)?, cohesion, phi.to_radians(), psi.to_radians())
        })
        .collect()
}

/// Largest differences from a table, relative to the largest entry of the row's kind.
#[derive(Debug, Clone, Copy, Default)]
pub struct PathDifferences {
    pub path_count: usize,
    pub row_count: usize,
    pub stress: f64,
    /// Rows at the tip of a cone, whose tangent is zero in the table, are left out.
    pub tangent: f64,
    pub stored_energy: f64,
}

impl PathDifferences {
    /// Largest difference of any kind.
    pub fn largest(&self) -> f64 {
        self.stress.max(self.tangent).max(self.stored_energy)
    }
}

/// Difference of two lists relative to the largest entry of the second; not a number where a value is not one.
fn relative_difference(values: &[f64], reference: &[f64]) -> f64 {
    let scale = largest(reference);
    values.iter().zip(reference).fold(0.0, |max: f64, (value, expected)| {
        let difference = (value - expected).abs() / scale;
        if difference.is_nan() || difference > max { difference } else { max }
    })
}

/// Stored energy of each row; none for a table without it.
fn stored_energies(table: &ReferenceTable, file: &str) -> Option<Vec<f64>> {
    (file.contains("iwan") || file.contains("general")).then(|| table.column("stored"))
}

/// Follows all paths of a table of the folder `yielding` by its materials.
///
/// A file whose name contains `general` has initial stresses.
pub fn path_differences<M: SolidMaterial>(file: &str, materials: &[M]) -> Result<PathDifferences> {
    let table = table(&format!("yielding/{file}"));
    let places = table.rows(["material", "path", "step"]);
    let strains = table.rows(["e_xx", "e_yy", "e_zz", "g_xy"]);
    let stresses = table.rows(["s_xx", "s_yy", "s_zz", "s_xy"]);
    let tangent_columns: Vec<String> =
        (0..16).map(|entry| format!("c{}{}", entry / 4, entry % 4)).collect();
    let tangents: Vec<[f64; 16]> =
        table.rows(std::array::from_fn(|entry| tangent_columns[entry].as_str()));
    let initial_stresses =
        file.contains("general").then(|| table.rows(["i_xx", "i_yy", "i_zz", "i_xy"]));
    let stored = stored_energies(&table, file);
    let mut differences = PathDifferences { row_count: places.len(), ..Default::default() };
    let mut variables = Vec::new();
    for (index, &[material_number, _, step]) in places.iter().enumerate() {
        let numbered = materials.iter().zip(0..).find(|(_, k)| f64::from(*k) == material_number);
        let material = numbered.expect("the table names a material of the list").0;
        if step == 0.0 {
            let initial_stress = initial_stresses.as_ref().map_or([0.0; 4], |list| list[index]);
            variables = vec![0.0; material.variable_count()];
            material.initialize(initial_stress, &mut variables)?;
            differences.path_count += 1;
        }
        let strain = strains[index];
        let stress = relative_difference(&material.stress(strain, &variables)?, &stresses[index]);
        differences.stress = differences.stress.max(stress);
        if largest(&tangents[index]) > 0.0 {
            let tangent = material.tangent(strain, &variables)?;
            let tangent = relative_difference(tangent.as_flattened(), &tangents[index]);
            differences.tangent = differences.tangent.max(tangent);
        }
        if let Some(stored) = &stored {
            let energy = material.energy(strain, &variables)?.stored;
            let energy = relative_difference(&[energy], &[stored[index]]);
            differences.stored_energy = differences.stored_energy.max(energy);
        }
        material.commit(strain, &mut variables);
    }
    Ok(differences)
}

/// Backbone of points, linear between them, for strains of both signs.
fn backbone(points: &[[f64; 2]], strain: f64) -> f64 {
    let mut previous_point = [0.0; 2];
    for &point in points {
        if strain.abs() <= point[0] {
            let fraction = (strain.abs() - previous_point[0]) / (point[0] - previous_point[0]);
            let stress = previous_point[1] + fraction * (point[1] - previous_point[1]);
            return stress.copysign(strain);
        }
        previous_point = point;
    }
    previous_point[1].copysign(strain)
}

/// Largest difference of simple shear from Masing's rules on the backbone, relative to the strength.
///
/// One cycle of each amplitude (relative to the strain at the strength), with a second loop inside of it.
pub fn masing_difference(clay: &Iwan, amplitudes: &[f64]) -> Result<f64> {
    let limit = clay.points().last().map_or(0.0, |point| point[0]);
    let mut difference = 0.0_f64;
    for amplitude in amplitudes.iter().map(|ratio| ratio * limit) {
        let mut variables = vec![0.0; clay.variable_count()];
        clay.initialize([0.0; 4], &mut variables)?;
        let mut origin = [0.0; 2];
        for (turn, ratio) in [1.0, -1.0, 0.5, -0.25, 0.5].into_iter().enumerate() {
            let factor = if turn == 0 { 1.0 } else { 2.0 };
            let mut shear = origin[1];
            let end = ratio * amplitude;
            for step in 1..=23 {
                let strain = origin[0] + (end - origin[0]) * f64::from(step) / 23.0;
                let plane_strain = [0.0, 0.0, 0.0, strain];
                shear = clay.stress(plane_strain, &variables)?[3];
                let branch = factor * backbone(clay.points(), (strain - origin[0]) / factor);
                difference = difference.max((shear - origin[1] - branch).abs() / clay.strength());
                clay.commit(plane_strain, &mut variables);
            }
            origin = [end, shear];
        }
    }
    Ok(difference)
}
