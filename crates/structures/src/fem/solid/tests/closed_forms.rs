//! GOAL: limit states of both laws.
//! REFERENCE: closed forms.

use super::{
    DruckerPrager, Iwan, SolidMaterial, elastic, hyperbolic_clay, max_abs, variables_at_rest,
};
use crate::fem::material::Material;

/// Strains `material` in equal steps up to `last_factor` times `direction`, and returns the last strain.
fn strain_along(
    material: &dyn SolidMaterial,
    direction: [f64; 4],
    last_factor: f64,
    variables: &mut [f64],
) -> [f64; 4] {
    let mut strain = [0.0; 4];
    for step in 1..=400 {
        strain = direction.map(|component| component * last_factor * f64::from(step) / 400.0);
        material.commit(strain, variables);
    }
    strain
}

/// With ψ = φ the limit state in plane strain is Mohr–Coulomb's: (σ_1 − σ_3)/2 = c cos φ − sin φ (σ_1 + σ_3)/2.
#[test]
fn the_cone_matches_mohr_coulomb_in_plane_strain() {
    for (angle, cohesion) in [(0.3_f64, 10.0e3), (0.6, 0.0), (0.0, 25.0e3)] {
        let sand = DruckerPrager::new(elastic(2.0e7, 4.0e7), cohesion, angle, angle).unwrap();
        let mut variables = variables_at_rest(&sand, [-1.0e5, -1.0e5, -1.0e5, 0.0]);
        // Strains of flow under compression along y.
        let direction = [0.5 * (1.0 + angle.sin()), -0.5 * (1.0 - angle.sin()), 0.0, 0.0];
        let strain = strain_along(&sand, direction, 0.2, &mut variables);
        let [xx, yy, ..] = sand.stress(strain, &variables).unwrap();
        let strength = cohesion * angle.cos() - 0.5 * angle.sin() * (xx + yy);
        assert!((0.5 * (xx - yy) - strength).abs() < 1e-6 * strength, "{xx}, {yy}: {strength}");
        let state = sand.state(strain, &variables);
        assert!((state.mobilised_strength - 1.0).abs() < 1e-9, "{state:?}");
    }
}

/// Without friction the law is von Mises': simple shear ends at the cohesion, and no tension reaches a tip.
#[test]
fn without_friction_the_cohesion_is_the_strength() {
    let cohesion = 30.0e3;
    let soil = DruckerPrager::new(elastic(2.0e7, 3.0e8), cohesion, 0.0, 0.0).unwrap();
    assert!(soil.has_symmetric_tangent());
    let mut variables = variables_at_rest(&soil, [0.0; 4]);
    let strain = strain_along(&soil, [0.1, 0.1, 0.1, 1.0], 0.05, &mut variables);
    let stress = soil.stress(strain, &variables).unwrap();
    let mean_stress = 3.0e8 * 0.015;
    for (value, expected) in stress.iter().zip([mean_stress, mean_stress, mean_stress, cohesion]) {
        assert!((value - expected).abs() < 1e-8 * mean_stress, "{stress:?}");
    }
    let plastic_strain = soil.state(strain, &variables).plastic_strain;
    assert!((plastic_strain - (0.05 - cohesion / 2.0e7)).abs() < 1e-12);
    let dissipated_energy = soil.energy(strain, &variables).unwrap().dissipated;
    assert!((dissipated_energy - cohesion * plastic_strain).abs() < 1e-9 * dissipated_energy);
}

/// Equal tension in all directions ends at the tip, where σ = c cot φ. The dissipated energy is the work of this stress
/// on the plastic change of volume.
#[test]
fn dilation_ends_at_the_tip() {
    let cohesion = 5.0e3;
    let bulk_modulus = 4.0e7;
    for (friction_angle, dilation_angle) in [(0.5_f64, 0.5), (0.5, 0.1), (0.5, 0.0)] {
        let material = elastic(2.0e7, bulk_modulus);
        let sand = DruckerPrager::new(material, cohesion, friction_angle, dilation_angle).unwrap();
        let mut variables = variables_at_rest(&sand, [-2.0e4, -2.0e4, -2.0e4, 0.0]);
        let strain = [0.01, 0.01, 0.01, 1e-5];
        let tip = cohesion / friction_angle.tan();
        for _ in 0..2 {
            let stress = sand.stress(strain, &variables).unwrap();
            for (value, expected) in stress.iter().zip([tip, tip, tip, 0.0]) {
                assert!((value - expected).abs() < 1e-9 * tip, "{stress:?}");
            }
            assert_eq!(sand.state(strain, &variables).mobilised_strength, 1.0);
            let plastic_volume = 0.03 - (tip + 2.0e4) / bulk_modulus;
            let dissipated_energy = sand.energy(strain, &variables).unwrap().dissipated;
            assert!((dissipated_energy - tip * plastic_volume).abs() < 1e-9 * dissipated_energy);
            sand.commit(strain, &mut variables);
        }
        // Compression away from the tip is elastic.
        let unloaded_strain = [0.0099, 0.0099, 0.0099, 1e-5];
        let stress = sand.stress(unloaded_strain, &variables).unwrap();
        assert!((stress[0] - (tip - bulk_modulus * 3e-4)).abs() < 1e-6, "{stress:?}");
        assert_eq!(sand.tangent(unloaded_strain, &variables).unwrap(), sand.elasticity());
    }
}

/// Simple shear from an initial shear stress ends at the same strength as from zero.
#[test]
fn an_initial_stress_does_not_change_the_strength() {
    let clay = hyperbolic_clay();
    for shear_level in [0.01, 0.5, 0.999] {
        let shear = shear_level * clay.strength();
        let initial_stress = [-1.0e5, -1.0e5, -1.0e5, shear];
        let mut variables = variables_at_rest(&clay, initial_stress);
        let state = clay.state([0.0; 4], &variables);
        assert!((state.mobilised_strength - shear_level).abs() < 1e-12);
        assert!(state.plastic_strain < 1e-15);
        // Shear in the direction of the initial stress follows the backbone from this stress on.
        let strain = strain_along(&clay, [0.0, 0.0, 0.0, 1.0], 0.2, &mut variables);
        let stress = clay.stress(strain, &variables).unwrap();
        assert!((stress[3] - clay.strength()).abs() < 1e-9 * clay.strength());
        assert!((stress[0] + 1.0e5).abs() < 1e-6);
    }
    // σ_v(1 − K₀) = √3 τ_n is the largest difference at rest.
    let difference = 3.0_f64.sqrt() * clay.strength();
    let mut variables = vec![0.0; clay.variable_count()];
    let largest_initial_stress = [-1.0e5, -1.0e5 - difference, -1.0e5, 0.0];
    clay.initialize(largest_initial_stress, &mut variables).unwrap();
    let excessive_initial_stress = [-1.0e5, -1.0e5 - 1.001 * difference, -1.0e5, 0.0];
    let text = clay.initialize(excessive_initial_stress, &mut variables).unwrap_err().to_string();
    assert_eq!(
        text,
        "soil with a strength of 40000 Pa: shear stress √J₂ of the initial stress (Pa) is 40040, but must be at most \
         this strength"
    );
}

/// Points on a straight part of the backbone have no component.
#[test]
fn points_on_a_straight_line_have_no_component() {
    let points = [[1e-3, 1.0e4], [2e-3, 2.0e4], [3e-3, 3.0e4], [0.01, 5.0e4], [0.02, 5.0e4]];
    let clay = Iwan::new(&points, 0.3, 0.0).unwrap();
    let bent_clay = Iwan::new(&[points[2], points[3]], 0.3, 0.0).unwrap();
    assert_eq!(clay.variable_count(), bent_clay.variable_count());
    assert_eq!(clay.points(), points);
    let variables = variables_at_rest(&clay, [0.0; 4]);
    for shear_strain in [1e-3, 7e-3, 0.05] {
        let strain = [0.3 * shear_strain, 0.0, 0.0, shear_strain];
        let stress = clay.stress(strain, &variables).unwrap();
        let bent_stress = bent_clay.stress(strain, &variables).unwrap();
        let difference: [f64; 4] = std::array::from_fn(|i| stress[i] - bent_stress[i]);
        assert!(max_abs(&difference) < 1e-9 * clay.strength());
    }
}

/// The hyperbolic backbone passes through its formula's points.
#[test]
fn the_hyperbolic_backbone_has_its_formula() {
    let clay = hyperbolic_clay();
    let [first_point, .., last_point] = clay.points() else { panic!("points") };
    assert_eq!(clay.points().len(), 12);
    let reference_strain: f64 = 40.0e3 / 45.6e6;
    assert!((first_point[0] / (0.02 * reference_strain) - 1.0).abs() < 1e-15);
    assert!((first_point[1] / (0.02 * 40.0e3) - 1.0).abs() < 1e-15);
    assert_eq!(*last_point, [200.0 * 40.0e3 / 45.6e6, 40.0e3]);
    let ratio = 10_000.0_f64.powf(1.0 / 11.0);
    for (index, point) in clay.points().iter().enumerate().skip(1) {
        let strain = first_point[0] * ratio.powi(i32::try_from(index).unwrap());
        let stress = 45.6e6 * strain
            / (1.0 + strain / reference_strain * (1.0 - reference_strain / last_point[0]));
        assert!((point[0] / strain - 1.0).abs() < 1e-13 && (point[1] / stress - 1.0).abs() < 1e-13);
    }
    assert!((clay.bulk_modulus() / (45.6e6 * 2.98 / 0.06) - 1.0).abs() < 1e-13);
    assert!((clay.shear_modulus() / 45.6e6 - 1.0).abs() < 1e-15);
    // The smallest limit strain is accepted for any modulus and strength.
    for (shear_modulus, strength) in [(1.0, 1.0), (3.3e9, 7.7), (2.0e4, 1.0e6)] {
        Iwan::hyperbolic(shear_modulus, strength, 5.0001 * strength / shear_modulus, 0.2, 0.0)
            .unwrap();
    }
}

/// Elastic parts are those of the linear material.
#[test]
fn elasticity_is_that_of_the_linear_material() {
    let material = Material::new(5.0e7, 0.31, 1700.0).unwrap();
    let sand = DruckerPrager::new(material, 0.0, 0.5, 0.2).unwrap();
    assert_eq!(sand.density(), 1700.0);
    assert!(!sand.has_symmetric_tangent());
    let expected = SolidMaterial::elasticity(&material);
    for (entry, expected_entry) in
        sand.elasticity().as_flattened().iter().zip(expected.as_flattened())
    {
        assert!((entry - expected_entry).abs() <= 1e-14 * expected[0][0]);
    }
}
