//! GOAL: stresses, tangents and energies of both laws along paths. REFERENCE: tables of two other programs
//! (`tests/data/yielding`): one for plane strain without an initial stress, one with strain normal to the plane and
//! with an initial stress.

use basemat_testkit::{ReferenceTable, table};

use super::{SolidMaterial, max_abs, table_clays, table_sands, variables_at_rest};
use crate::fem::internal_energy::InternalEnergy;
use crate::fem::solid::drucker_prager::APEX_TANGENT_FRACTION;

/// Allowed error over the largest entry of its quantity in the row.
const TABLE_TOLERANCE: f64 = 1e-9;

/// Rows of a table of strain paths, in groups of columns.
struct PathRows {
    /// Material, path and step of each row.
    row_labels: Vec<[f64; 3]>,
    strains: Vec<[f64; 4]>,
    stresses: Vec<[f64; 4]>,
    tangents: Vec<[f64; 16]>,
}

impl PathRows {
    fn of(table: &ReferenceTable) -> Self {
        let tangent_columns: Vec<String> =
            (0..16).map(|entry| format!("c{}{}", entry / 4, entry % 4)).collect();
        Self {
            row_labels: table.rows(["material", "path", "step"]),
            strains: table.rows(["e_xx", "e_yy", "e_zz", "g_xy"]),
            stresses: table.rows(["s_xx", "s_yy", "s_zz", "s_xy"]),
            tangents: table.rows(std::array::from_fn(|entry| tangent_columns[entry].as_str())),
        }
    }
}

/// Asserts that a list equals that of the table, up to a tolerance relative to the table's largest entry in the row.
#[track_caller]
fn assert_row(row_label: [f64; 3], quantity: &str, computed: &[f64], expected: &[f64]) {
    let tolerance = TABLE_TOLERANCE * max_abs(expected);
    for (value, reference) in computed.iter().zip(expected) {
        let error = (value - reference).abs();
        assert!(error <= tolerance, "{quantity} in {row_label:?}: {computed:?}, not {expected:?}");
    }
}

/// Columns of a table beside those of strain, stress and tangent.
struct PathExtras {
    initial_stresses: Option<Vec<[f64; 4]>>,
    stored: Option<Vec<f64>>,
    dissipated_energies: Option<Vec<f64>>,
}

impl PathExtras {
    fn of(table: &ReferenceTable, file: &str) -> Self {
        let is_general = file.contains("general");
        let has_stored_energy = is_general || file.contains("iwan");
        Self {
            initial_stresses: is_general.then(|| table.rows(["i_xx", "i_yy", "i_zz", "i_xy"])),
            stored: has_stored_energy.then(|| table.column("stored")),
            dissipated_energies: is_general.then(|| table.column("dissipated")),
        }
    }

    /// Variables at the start of a path, whose stress at rest must be the initial stress.
    fn variables_at_start(&self, index: usize, material: &dyn SolidMaterial) -> Vec<f64> {
        let initial_stress =
            self.initial_stresses.as_ref().map_or([0.0; 4], |stresses| stresses[index]);
        let variables = variables_at_rest(material, initial_stress);
        let stress_at_rest = material.stress([0.0; 4], &variables).unwrap();
        for i in 0..4 {
            let error = (stress_at_rest[i] - initial_stress[i]).abs();
            assert!(error <= 1e-12 * max_abs(&initial_stress), "{stress_at_rest:?}");
        }
        variables
    }

    fn assert_energies(&self, row_label: [f64; 3], index: usize, energy: InternalEnergy) {
        if let Some(stored) = &self.stored {
            assert_row(row_label, "stored energy", &[energy.stored], &[stored[index]]);
        }
        if let Some(dissipated_energies) = &self.dissipated_energies {
            // Where a soil dissipates nothing, the value is the rounding of the stored energy.
            let scale = dissipated_energies[index].abs().max(1e-3 * energy.stored.abs());
            let error = (energy.dissipated - dissipated_energies[index]).abs();
            assert!(error <= TABLE_TOLERANCE * scale, "{row_label:?}: {energy:?}");
        }
    }
}

/// Compares all rows, and returns the number of rows at the tip of a cone.
fn compare<M: SolidMaterial>(file: &str, materials: &[M]) -> usize {
    let table = table(file);
    let rows = PathRows::of(&table);
    let extras = PathExtras::of(&table, file);
    let mut apex_count = 0;
    let mut variables = Vec::new();
    for (index, &row_label) in rows.row_labels.iter().enumerate() {
        let material_entry =
            materials.iter().enumerate().find(|(number, _)| *number as f64 == row_label[0]);
        let material = material_entry.unwrap().1;
        let strain = rows.strains[index];
        if row_label[2] == 0.0 {
            variables = extras.variables_at_start(index, material);
        }
        let stress = material.stress(strain, &variables).unwrap();
        assert_row(row_label, "stress", &stress, &rows.stresses[index]);
        if max_abs(&rows.tangents[index]) == 0.0 {
            apex_count += 1;
            assert_tangent_at_tip(material, strain, &variables);
        } else {
            let tangent = material.tangent(strain, &variables).unwrap();
            assert_row(row_label, "tangent", tangent.as_flattened(), &rows.tangents[index]);
        }
        let energy = material.energy(strain, &variables).unwrap();
        extras.assert_energies(row_label, index, energy);

        // Committed variables give the same stress and energies.
        material.commit(strain, &mut variables);
        let committed_energy = material.energy(strain, &variables).unwrap();
        let committed_stress = material.stress(strain, &variables).unwrap();
        assert_row(row_label, "committed stress", &committed_stress, &rows.stresses[index]);
        let energy_change = [
            committed_energy.stored - energy.stored,
            committed_energy.dissipated - energy.dissipated,
        ];
        assert!(max_abs(&energy_change) <= 1e-10 * (energy.stored.abs() + energy.dissipated));
    }
    apex_count
}

/// Asserts that the tangent at the tip is the small fraction of the elasticity.
///
/// The table has zeros there.
fn assert_tangent_at_tip(material: &dyn SolidMaterial, strain: [f64; 4], variables: &[f64]) {
    let elasticity = material.elasticity();
    let tangent = material.tangent(strain, variables).unwrap();
    for (entry, elastic_entry) in tangent.as_flattened().iter().zip(elasticity.as_flattened()) {
        let error = (entry - APEX_TANGENT_FRACTION * elastic_entry).abs();
        assert!(error <= 1e-3 * TABLE_TOLERANCE * elasticity[0][0], "{tangent:?}");
    }
}

#[test]
fn iwan_follows_the_table() {
    assert_eq!(compare("yielding/iwan_paths.csv", &table_clays()), 0);
}

#[test]
fn iwan_follows_paths_across_the_plane_and_from_an_initial_stress() {
    assert_eq!(compare("yielding/iwan_general_paths.csv", &table_clays()), 0);
}

#[test]
fn drucker_prager_follows_the_table() {
    assert!(compare("yielding/drucker_prager_paths.csv", &table_sands()) > 5);
}

#[test]
fn drucker_prager_follows_paths_across_the_plane_and_from_an_initial_stress() {
    assert!(compare("yielding/drucker_prager_general_paths.csv", &table_sands()) > 5);
}
