//! Tests of the laws of solids against tables of other programs, closed forms and differences.

mod closed_forms;
mod energy;
mod invalid_input;
mod masing;
mod tables;
mod tangents;

use basemat_testkit::random::Random;
use basemat_testkit::table;

use super::{DruckerPrager, Iwan, SolidMaterial};
use crate::fem::material::Material;

/// Material with shear modulus G and bulk modulus K, without density.
fn elastic(shear_modulus: f64, bulk_modulus: f64) -> Material {
    let young_modulus = 9.0 * bulk_modulus * shear_modulus / (3.0 * bulk_modulus + shear_modulus);
    Material::new(young_modulus, poisson(shear_modulus, bulk_modulus), 0.0).unwrap()
}

/// Poisson's ratio of shear modulus G and bulk modulus K.
fn poisson(shear_modulus: f64, bulk_modulus: f64) -> f64 {
    (3.0 * bulk_modulus - 2.0 * shear_modulus) / (2.0 * (3.0 * bulk_modulus + shear_modulus))
}

/// Materials of `iwan_materials.csv`.
fn table_clays() -> Vec<Iwan> {
    let rows = table("yielding/iwan_materials.csv").rows(["material", "G", "K", "gamma", "tau"]);
    [0.0, 1.0]
        .map(|material| {
            let rows: Vec<_> = rows.iter().filter(|row| row[0] == material).collect();
            let points: Vec<_> = rows.iter().map(|row| [row[3], row[4]]).collect();
            Iwan::new(&points, poisson(rows[0][1], rows[0][2]), 1900.0).unwrap()
        })
        .into()
}

/// Materials of `drucker_prager_materials.csv`: ψ < φ, ψ = φ, ψ = 0, φ = 0.
fn table_sands() -> Vec<DruckerPrager> {
    table("yielding/drucker_prager_materials.csv")
        .rows(["G", "K", "c", "phi", "psi"])
        .into_iter()
        .map(|[g, k, cohesion, phi, psi]| {
            DruckerPrager::new(elastic(g, k), cohesion, phi.to_radians(), psi.to_radians()).unwrap()
        })
        .collect()
}

/// Clay with the twelve components of a hyperbolic backbone.
fn hyperbolic_clay() -> Iwan {
    Iwan::hyperbolic(45.6e6, 40.0e3, 200.0 * 40.0e3 / 45.6e6, 0.49, 1900.0).unwrap()
}

/// Sand with cohesion and ψ = φ.
fn associated_sand() -> DruckerPrager {
    let angle = 30.0_f64.to_radians();
    DruckerPrager::new(elastic(20.0e6, 40.0e6), 2.0e3, angle, angle).unwrap()
}

/// Variables of a point under an initial stress.
fn variables_at_rest(material: &dyn SolidMaterial, initial_stress: [f64; 4]) -> Vec<f64> {
    let mut variables = vec![f64::NAN; material.variable_count()];
    material.initialize(initial_stress, &mut variables).unwrap();
    variables
}

/// Strain with random components, within ± `size`.
fn random_strain(random: &mut Random, size: f64) -> [f64; 4] {
    std::array::from_fn(|_| random.within(-size, size))
}

/// Largest absolute value of a list.
fn max_abs(values: &[f64]) -> f64 {
    values.iter().fold(0.0, |max, value| value.abs().max(max))
}
