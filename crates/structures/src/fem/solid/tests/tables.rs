//! GOAL: stresses, tangents and energies of both laws along paths.
//! REFERENCE: tables of two other programs (`tests/data/yielding`): one for plane strain without an initial stress, one
//! with strain across the plane and with an initial stress.

use basemat_testkit::{ReferenceTable, table};

use super::{SolidMaterial, max_abs, table_clays, table_sands, variables_at_rest};
use crate::fem::solid::drucker_prager::APEX_TANGENT_FRACTION;

/// Allowed error over the largest entry of its kind in the row.
const TABLE_TOLERANCE: f64 = 1e-9;

/// Rows of a table in groups of columns.
struct Rows {
    /// Material, path and step.
    places: Vec<[f64; 3]>,
    strains: Vec<[f64; 4]>,
    stresses: Vec<[f64; 4]>,
    tangents: Vec<[f64; 16]>,
}

impl Rows {
    fn of(table: &ReferenceTable) -> Self {
        let tangent_columns: Vec<String> =
            (0..16).map(|entry| format!("c{}{}", entry / 4, entry % 4)).collect();
        Self {
            places: table.rows(["material", "path", "step"]),
            strains: table.rows(["e_xx", "e_yy", "e_zz", "g_xy"]),
            stresses: table.rows(["s_xx", "s_yy", "s_zz", "s_xy"]),
            tangents: table.rows(std::array::from_fn(|entry| tangent_columns[entry].as_str())),
        }
    }
}

/// Asserts that a list equals that of the table, relative to the table's largest entry.
#[track_caller]
fn assert_row(place: [f64; 3], kind: &str, computed: &[f64], expected: &[f64]) {
    let tolerance = TABLE_TOLERANCE * max_abs(expected);
    for (value, reference) in computed.iter().zip(expected) {
        let error = (value - reference).abs();
        assert!(error <= tolerance, "{kind} in {place:?}: {computed:?}, not {expected:?}");
    }
}

/// Compares all rows, and returns the number of rows at the tip of a cone.
fn compare<M: SolidMaterial>(file: &str, materials: &[M]) -> usize {
    let table = table(file);
    let rows = Rows::of(&table);
    let has_initial_stress = file.contains("general");
    let initial_stresses = has_initial_stress.then(|| table.rows(["i_xx", "i_yy", "i_zz", "i_xy"]));
    let has_stored_energy = has_initial_stress || file.contains("iwan");
    let stored = has_stored_energy.then(|| table.column("stored"));
    let dissipated = has_initial_stress.then(|| table.column("dissipated"));
    let mut apex_count = 0;
    let mut variables = Vec::new();
    for (index, &place) in rows.places.iter().enumerate() {
        let material = &materials[place[0] as usize];
        let strain = rows.strains[index];
        if place[2] == 0.0 {
            let initial_stress =
                initial_stresses.as_ref().map_or([0.0; 4], |stresses| stresses[index]);
            variables = variables_at_rest(material, initial_stress);
            let stress_at_rest = material.stress([0.0; 4], &variables).unwrap();
            let scale = max_abs(&initial_stress);
            for i in 0..4 {
                assert!(
                    (stress_at_rest[i] - initial_stress[i]).abs() <= 1e-12 * scale,
                    "{place:?}"
                );
            }
        }
        let stress = material.stress(strain, &variables).unwrap();
        assert_row(place, "stress", &stress, &rows.stresses[index]);

        let mut tangent = material.tangent(strain, &variables).unwrap();
        let is_apex = max_abs(&rows.tangents[index]) == 0.0;
        if is_apex {
            // The table has zeros. The law's small part of the elasticity, and nothing else, comes on top.
            apex_count += 1;
            let elasticity = material.elasticity();
            for i in 0..4 {
                for j in 0..4 {
                    tangent[i][j] -= APEX_TANGENT_FRACTION * elasticity[i][j];
                }
            }
            assert!(max_abs(tangent.as_flattened()) <= TABLE_TOLERANCE * elasticity[0][0]);
        } else {
            assert_row(place, "tangent", tangent.as_flattened(), &rows.tangents[index]);
        }

        let energy = material.energy(strain, &variables).unwrap();
        if let Some(stored) = &stored {
            assert_row(place, "stored energy", &[energy.stored], &[stored[index]]);
        }
        if let Some(dissipated) = &dissipated {
            // A material without cohesion and with ψ = φ would dissipate nothing; here it is rounding at most.
            let allowed_error =
                TABLE_TOLERANCE * dissipated[index].abs().max(1e-3 * energy.stored.abs());
            let error = (energy.dissipated - dissipated[index]).abs();
            assert!(error <= allowed_error, "{place:?}: {energy:?}, not {}", dissipated[index]);
        }
        material.commit(strain, &mut variables);
        let committed_energy = material.energy(strain, &variables).unwrap();
        let committed_stress = material.stress(strain, &variables).unwrap();
        assert_row(place, "committed stress", &committed_stress, &rows.stresses[index]);
        let energy_change = [
            committed_energy.stored - energy.stored,
            committed_energy.dissipated - energy.dissipated,
        ];
        assert!(max_abs(&energy_change) <= 1e-10 * (energy.stored.abs() + energy.dissipated));
    }
    apex_count
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
