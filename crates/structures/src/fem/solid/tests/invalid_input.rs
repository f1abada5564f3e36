//! GOAL: for input that no soil has, errors name the quantity, its value and its place; nothing panics.

use super::{
    DruckerPrager, Iwan, SolidMaterial, associated_sand, elastic, hyperbolic_clay,
    variables_at_rest,
};
use crate::error::{Error, Result};

/// Asserts that a result is an error whose text contains `part`.
#[track_caller]
fn assert_error_text<T: std::fmt::Debug>(result: Result<T>, part: &str) {
    let text = result.unwrap_err().to_string();
    assert!(text.contains(part), "'{text}' does not contain '{part}'");
}

#[test]
fn backbones_that_no_soil_has_are_errors() {
    let bad_points: &[(&[[f64; 2]], &str)] = &[
        (&[], "points of the backbone has length 0"),
        (&[[0.0, 1.0e3]], "point 1 of the backbone: shear strain is 0"),
        (&[[-1e-3, 1.0e3]], "point 1 of the backbone: shear strain is -0.001"),
        (&[[f64::NAN, 1.0e3]], "point 1 of the backbone: shear strain is NaN"),
        (&[[f64::INFINITY, 1.0e3]], "point 1 of the backbone: shear strain is inf"),
        (&[[1e-3, 0.0]], "point 1 of the backbone: shear stress (Pa) is 0"),
        (&[[1e-3, -1.0]], "point 1 of the backbone: shear stress (Pa) is -1"),
        (&[[1e-3, f64::NAN]], "point 1 of the backbone: shear stress (Pa) is NaN"),
        (&[[1e-3, f64::INFINITY]], "point 1 of the backbone: shear stress (Pa) is inf"),
        (&[[1e-3, 1.0e3], [1e-3, 1.1e3]], "point 2 of the backbone: shear strain is 0.001"),
        (&[[1e-3, 1.0e3], [2e-3, 0.9e3]], "point 2 of the backbone: shear stress (Pa) is 900"),
        (&[[1e-3, 1.0e3], [2e-3, 2.1e3]], "point 2 of the backbone: slope up to the point"),
        (
            &[[1e-3, 1.0e3], [2e-3, 1.5e3], [3e-3, 1.7e3], [4e-3, 2.0e3]],
            "point 4 of the backbone: slope up to the point (Pa) is 300000",
        ),
        (&[[1e-308, 1.0e3]], "point 1 of the backbone: slope up to the point (Pa) is inf"),
    ];
    for (points, part) in bad_points {
        assert_error_text(Iwan::new(points, 0.3, 0.0), part);
    }
    let points = [[1e-3, 1.0e3]];
    for poisson in [-1.0, 0.5, f64::NAN, 2.0] {
        assert_error_text(Iwan::new(&points, poisson, 0.0), "Poisson's ratio of the soil");
    }
    for density in [-1.0, f64::NAN, f64::INFINITY] {
        assert_error_text(Iwan::new(&points, 0.3, density), "density of the soil");
    }
    assert!(matches!(Iwan::new(&[], 0.3, 0.0), Err(Error::Size { found: 0, needed: 1, .. })));
}

#[test]
fn hyperbolic_backbones_that_no_soil_has_are_errors() {
    for invalid_value in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        assert_error_text(
            Iwan::hyperbolic(invalid_value, 1.0e3, 0.1, 0.3, 0.0),
            "shear modulus of the soil",
        );
        assert_error_text(
            Iwan::hyperbolic(1.0e6, invalid_value, 0.1, 0.3, 0.0),
            "shear strength of the soil",
        );
    }
    for limit_strain in [4.9e-3, 0.0, -1.0, f64::NAN, f64::INFINITY] {
        let clay = Iwan::hyperbolic(1.0e6, 1.0e3, limit_strain, 0.3, 0.0);
        assert_error_text(clay, "strain at which the soil has its strength");
    }
    assert!(Iwan::hyperbolic(1e-300, 1e300, 0.1, 0.3, 0.0).is_err());
    assert!(Iwan::hyperbolic(1e300, 1e-300, 0.1, 0.3, 0.0).is_err());
}

#[test]
fn cones_that_no_soil_has_are_errors() {
    let material = elastic(2.0e7, 4.0e7);
    let bad_cones = [
        (-1.0, 0.5, 0.1, "cohesion of the soil is -1"),
        (f64::NAN, 0.5, 0.1, "cohesion of the soil is NaN"),
        (f64::INFINITY, 0.5, 0.1, "cohesion of the soil is inf"),
        (0.0, std::f64::consts::FRAC_PI_2, 0.1, "friction angle of the soil (rad)"),
        (0.0, 32.0, 0.0, "friction angle of the soil (rad) is 32"),
        (0.0, -0.1, 0.0, "friction angle of the soil (rad) is -0.1"),
        (0.0, f64::NAN, 0.0, "friction angle of the soil (rad) is NaN"),
        (0.0, 0.5, 0.6, "dilation angle of the soil (rad) is 0.6"),
        (0.0, 0.5, -0.1, "dilation angle of the soil (rad) is -0.1"),
        (0.0, 0.5, f64::NAN, "dilation angle of the soil (rad) is NaN"),
        (0.0, 0.0, 0.0, "cohesion of the soil is 0, but must be above zero for a soil without"),
    ];
    for (cohesion, friction_angle, dilation_angle, part) in bad_cones {
        let sand = DruckerPrager::new(material, cohesion, friction_angle, dilation_angle);
        assert_error_text(sand, part);
    }
}

#[test]
fn initial_stresses_outside_of_the_yield_surface_are_errors() {
    let sand = associated_sand();
    let mut variables = vec![0.5; sand.variable_count()];
    for (initial_stress, part) in [
        ([-1.0e4, -9.0e4, -1.0e4, 0.0], "is 46188, but must be at most the shear strength"),
        (
            [1.0e4, 1.0e4, 1.0e4, 0.0],
            "soil with a strength √J₂ of 0 Pa at a mean stress of 10000 Pa",
        ),
        (
            [f64::NAN, 0.0, 0.0, 0.0],
            "initial stress of Drucker-Prager's law is not finite: entry 0",
        ),
    ] {
        assert_error_text(sand.initialize(initial_stress, &mut variables), part);
    }
    let clay = hyperbolic_clay();
    let mut clay_variables = vec![0.5; clay.variable_count()];
    for (initial_stress, part) in [
        (
            [0.0, 0.0, 0.0, 41.0e3],
            "soil with a strength of 40000 Pa: shear stress √J₂ of the initial",
        ),
        ([0.0, 0.0, 0.0, f64::INFINITY], "initial stress of Iwan's model is not finite: entry 3"),
    ] {
        assert_error_text(clay.initialize(initial_stress, &mut clay_variables), part);
    }
    // Input that returns an error does not change the variables.
    assert!(variables.iter().chain(&clay_variables).all(|&value| value == 0.5));
    // Jaky's K₀ = 1 − sin φ without cohesion: inside the cone at 30°, outside at 40°.
    for (degrees, is_inside) in [(30.0_f64, true), (40.0, false)] {
        let angle = degrees.to_radians();
        let sand = DruckerPrager::new(elastic(2.0e7, 4.0e7), 0.0, angle, 0.0).unwrap();
        let lateral = -1.0e5 * (1.0 - angle.sin());
        let initialized = sand.initialize([lateral, -1.0e5, lateral, 0.0], &mut variables);
        assert_eq!(initialized.is_ok(), is_inside, "{degrees}: {initialized:?}");
    }
}

/// Strains that are not finite, and lists of a wrong length, are errors and do not change the variables.
#[test]
fn strains_that_are_not_finite_change_nothing() {
    let clay = hyperbolic_clay();
    let sand = associated_sand();
    for material in [&clay as &dyn SolidMaterial, &sand] {
        let mut variables = variables_at_rest(material, [0.0; 4]);
        material.commit([1e-3, 0.0, 0.0, 2e-3], &mut variables);
        let committed = variables.clone();
        for invalid_strain in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY, 1e305, 1e152] {
            for entry in 0..4 {
                let mut strain = [1e-3, 0.0, 0.0, 2e-3];
                strain[entry] = invalid_strain;
                assert!(material.stress(strain, &variables).is_err(), "{material:?}, {strain:?}");
                assert!(material.energy(strain, &variables).is_err());
                assert!(material.tangent(strain, &variables).is_err());
                material.commit(strain, &mut variables);
                assert_eq!(variables, committed, "{material:?}: {invalid_strain}");
                let _ = material.state(strain, &variables);
            }
        }
        let mut short_list = vec![0.0; 2];
        assert!(matches!(
            material.stress([0.0; 4], &short_list),
            Err(Error::Size { found: 2, .. })
        ));
        assert!(material.initialize([0.0; 4], &mut short_list).is_err());
        assert!(material.tangent([0.0; 4], &short_list).is_err());
        assert!(material.energy([0.0; 4], &short_list).is_err());
        material.commit([1e-3; 4], &mut short_list);
        assert_eq!(short_list, [0.0; 2]);
        assert_eq!(material.state([1e-3; 4], &short_list), super::super::SolidState::default());
    }
}
